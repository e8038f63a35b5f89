// SPDX-License-Identifier: Apache-2.0
//
// T3, T4, T5 and V2: what must not change, or must add up, when vertices change sign, scale or place.
#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

corpus::Scene make_one(std::uint64_t n) {
  return pixel_scene(n, {16, 1, false, false, false, false, false});
}

corpus::Scene make_frame(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 6;
  return pixel_scene(n, limits);
}

Vertex negated(const Vertex& v) {
  return {-v.x, -v.y, -v.z, -v.w};
}

// T3. Also D = 0: then none of the eight covers anything.
TrialResult decide_octants(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (const corpus::SceneDraw& draw : scene.draws)
    for (const corpus::SceneTriangle& triangle : draw.triangles) {
      const std::array<Vertex, 3> t = triangle_of(draw, triangle);
      if (!std::all_of(t.begin(), t.end(), finite)) continue;
      corpus::Scene octants = triangle_scene(scene.width, scene.height, t);
      corpus::SceneDraw& all = octants.draws[0];
      all.fill_rule = draw.fill_rule;
      for (std::uint32_t i = 0; i < 3; ++i) all.vertices.push_back(scene_vertex(negated(t[i])));
      all.triangles.clear();
      for (std::uint32_t signs = 0; signs < 8; ++signs)
        all.triangles.push_back({{(signs & 1u) * 3, (signs >> 1 & 1u) * 3 + 1, (signs >> 2) * 3 + 2}, std::nullopt});
      const auto image = trial.draw(octants, kCountOnly);
      if (!image) return trial.verdict();
      const std::uint32_t expected = facing(t) == 0 ? 0 : 1;
      for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x)
          trial.expect_count("count of the eight octants", x, y, expected, image->count[element(*image, x, y)]);
      trial.looked_at(image->count.size());
    }
  return trial.verdict();
}

TrialResult decide_negation(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (std::size_t d = 0; d < scene.draws.size(); ++d)
    for (std::size_t t = 0; t < scene.draws[d].triangles.size(); ++t) {
      corpus::Scene one = with_one_triangle(scene, d, t);
      one.draws[0].cull = Cull::none;
      corpus::Scene opposite = one;
      for (corpus::SceneVertex& v : opposite.draws[0].vertices) v = {-v.x, -v.y, -v.z, -v.w, v.attributes};
      const auto before = trial.draw(one, kCountOnly), after = trial.draw(opposite, kCountOnly);
      if (!before || !after) return trial.verdict();
      for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x)
          if (before->count[element(*before, x, y)] != 0)
            trial.expect_count("count of the negated triangle", x, y, 0, after->count[element(*after, x, y)]);
      trial.looked_at(before->count.size());
    }
  return trial.verdict();
}

// T4. Every corner of every triangle gets its own scale, wherever that is exact. Perspective weights change, the rest
// does not: W_i E_i / D keeps its value.
TrialResult decide_scale(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene changed = scene;
  Random random(scene.draws.size());
  for (corpus::SceneDraw& draw : changed.draws) {
    const std::vector<corpus::SceneVertex> shared = std::move(draw.vertices);
    draw.vertices.clear();
    for (corpus::SceneTriangle& triangle : draw.triangles)
      for (std::uint32_t& corner : triangle.vertices) {
        corpus::SceneVertex vertex = shared[corner];
        if (const auto v = scaled_exactly(vertex_of(vertex), random.between(-40, 40))) {
          vertex.x = v->x, vertex.y = v->y, vertex.z = v->z, vertex.w = v->w;
        }
        corner = static_cast<std::uint32_t>(draw.vertices.size());
        draw.vertices.push_back(std::move(vertex));
      }
  }
  corpus::Outputs outputs = outputs_of(scene);
  outputs.barycentrics = false;
  const auto before = trial.draw(scene, outputs), after = trial.draw(changed, outputs);
  if (!before || !after) return trial.verdict();
  Correspondence correspondence;
  correspondence.attribute = [](const corpus::SceneAttribute& a) {
    return a.interpolation != Interpolation::perspective;
  };
  trial.expect_same("after scaling each vertex by a power of two", scene, *before, *after, correspondence);
  return trial.verdict();
}

// T5: (v1, v2, v0), and (v0, v2, v1) with the other front face.
TrialResult decide_order(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene shifted = scene, swapped = scene;
  for (corpus::SceneDraw& draw : shifted.draws)
    for (corpus::SceneTriangle& t : draw.triangles)
      std::rotate(t.vertices.begin(), t.vertices.begin() + 1, t.vertices.end());
  for (corpus::SceneDraw& draw : swapped.draws) {
    for (corpus::SceneTriangle& t : draw.triangles) std::swap(t.vertices[1], t.vertices[2]);
    draw.front_face = draw.front_face == FrontFace::clockwise ? FrontFace::counter_clockwise : FrontFace::clockwise;
  }
  const corpus::Outputs outputs = outputs_of(scene);
  const auto before = trial.draw(scene, outputs), shift = trial.draw(shifted, outputs),
             swap = trial.draw(swapped, outputs);
  if (!before || !shift || !swap) return trial.verdict();
  Correspondence after_shift;
  after_shift.barycentrics = {2, 0, 1};
  after_shift.attribute = [](const corpus::SceneAttribute& a) { return a.interpolation != Interpolation::flat; };
  trial.expect_same("after a cyclic shift", scene, *before, *shift, after_shift);
  Correspondence after_swap;
  after_swap.barycentrics = {0, 2, 1};
  trial.expect_same("after a swap of two vertices", scene, *before, *swap, after_swap);
  return trial.verdict();
}

// V2. Triangles without identifiers get those that they have by position.
TrialResult decide_identifiers(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene reversed = scene;
  std::uint32_t before_this_draw = 0;
  for (corpus::SceneDraw& draw : reversed.draws) {
    std::set<std::uint32_t> different;
    std::uint32_t position = draw.first_index.value_or(before_this_draw);
    before_this_draw += static_cast<std::uint32_t>(draw.triangles.size());
    for (corpus::SceneTriangle& t : draw.triangles) {
      if (!t.identifier) t.identifier = position;
      ++position;
      different.insert(*t.identifier);
    }
    draw.first_index.reset();
    if (different.size() != draw.triangles.size()) return trial.verdict();  // identifiers are unique: a precondition
    std::reverse(draw.triangles.begin(), draw.triangles.end());
  }
  corpus::Scene rotated = reversed;
  for (corpus::SceneDraw& draw : rotated.draws)
    if (!draw.triangles.empty()) std::rotate(draw.triangles.begin(), draw.triangles.begin() + 1, draw.triangles.end());
  const corpus::Outputs outputs = outputs_of(scene);
  const auto expected = trial.draw(scene, outputs), one = trial.draw(reversed, outputs),
             two = trial.draw(rotated, outputs);
  if (!expected || !one || !two) return trial.verdict();
  trial.expect_same("with identifiers, in reverse order", scene, *expected, *one);
  trial.expect_same("with identifiers, in another order", scene, *expected, *two);
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"octants", "T3", "exactly one of the triangles (+-v0, +-v1, +-v2) covers each sample", false, true, 0, make_one,
     decide_octants},
    {"negation", "T4", "negating all three vertices covers nothing that was covered", false, true, 0, make_one,
     decide_negation},
    {"scale", "T4", "scaling each vertex by its own power of two changes neither coverage nor depth", false, true, 0,
     make_frame, decide_scale},
    {"order", "T5", "a cyclic shift changes nothing but names, a swap the facing", false, true, 0, make_frame,
     decide_order},
    {"identifiers", "V2", "with identifiers, any order of the triangles gives the same image", false, true, 0,
     make_frame, decide_identifiers},
};

}  // namespace

std::span<const Property> symmetry_properties() {
  return kProperties;
}

}  // namespace surefill::properties
