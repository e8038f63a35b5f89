// SPDX-License-Identifier: Apache-2.0
//
// Sample patterns, conservative rasterization and Grid, held against the plain mode.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

constexpr int kPatterns[] = {2, 4, 8, 16};

corpus::Scene make_samples(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 6;
  corpus::Scene scene = pixel_scene(n, limits);
  scene.samples = kPatterns[n / categories().size() % 4];
  if (scene.initial_depth.size() > 1) scene.initial_depth = {scene.initial_depth[0]};
  return scene;
}

corpus::Scene make_one(std::uint64_t n) {
  corpus::Scene scene = pixel_scene(n, {9, 1, false, false, false, false, false});
  scene.draws[0].fill_rule = static_cast<FillRule>(n / categories().size() % 8);
  return scene;
}

// S4: sample n is the centre of an image of its own, whose vertices are moved the other way.
TrialResult decide_shift(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto moved = [&](const Vertex& v, int n) {
    const SampleLocation at = sample_location(scene.samples, n);
    return moved_exactly(v, (8 - at.x) / 16.0, (8 - at.y) / 16.0);
  };
  const corpus::Scene many = changed_exactly(without_attributes(without_places(scene)), [&](const Vertex& v) {
                               bool exact = finite(v);
                               for (int n = 0; n < scene.samples && exact; ++n) exact = moved(v, n).has_value();
                               return exact ? std::optional(v) : std::nullopt;
                             }).first;
  corpus::Outputs outputs = outputs_of(many);
  outputs.barycentrics = false;
  const auto all = trial.draw(many, outputs);
  if (!all) return trial.verdict();
  const auto samples = static_cast<std::size_t>(scene.samples);
  for (int n = 0; n < scene.samples; ++n) {
    corpus::Scene one = changed_exactly(many, [&](const Vertex& v) { return moved(v, n); }).second;
    one.samples = 1;
    const auto image = trial.draw(one, outputs);
    if (!image) return trial.verdict();
    const std::string label = "sample " + std::to_string(n) + " of " + std::to_string(scene.samples) + ": ";
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const std::size_t e = element(*image, x, y), a = e * samples + static_cast<std::size_t>(n);
        trial.looked_at(1);
        trial.expect_count(label + "count", x, y, image->count[e], all->count[a]);
        if (!outputs.depth) continue;
        trial.expect_index(label + "index", x, y, image->index[e], all->index[a]);
        trial.expect_bits(label + "depth", x, y, image->depth[e], all->depth[a]);
      }
  }
  return trial.verdict();
}

// M1: where a triangle covers the pixel's centre, every sample of it there has the attributes of the centre.
TrialResult decide_at_centre(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (std::size_t d = 0; d < scene.draws.size(); ++d)
    for (std::size_t t = 0; t < scene.draws[d].triangles.size(); ++t) {
      corpus::Scene many = with_one_triangle(without_places(scene), d, t);
      many.initial_depth.clear();
      corpus::Scene centre = many;
      centre.samples = 1;
      corpus::Outputs outputs = outputs_of(many);
      outputs.index = outputs.depth = false;
      const auto at_centre = trial.draw(centre, outputs);
      for (const AttributeLocation location : {AttributeLocation::centre, AttributeLocation::centroid}) {
        many.attribute_location = location;
        const auto image = trial.draw(many, outputs);
        if (!image || !at_centre || image->barycentrics.empty()) return trial.verdict();
        const auto samples = static_cast<std::size_t>(many.samples);
        for (int y = 0; y < scene.height; ++y)
          for (int x = 0; x < scene.width; ++x) {
            const std::size_t e = element(*at_centre, x, y);
            if (at_centre->count[e] == 0) continue;
            for (std::size_t s = e * samples; s < (e + 1) * samples; ++s) {
              if (image->count[s] == 0) continue;
              trial.looked_at(1);
              for (std::size_t i = 0; i < 3; ++i)
                trial.expect_bits("barycentrics at a covered centre", x, y, at_centre->barycentrics[3 * e + i],
                                  image->barycentrics[3 * s + i]);
              for (std::size_t k = 0; k < scene.attributes.size(); ++k)
                for (std::size_t c = 0, n = scene.attributes[k].components; c < n; ++c)
                  trial.expect_bits("attribute at a covered centre", x, y, at_centre->attributes[k][n * e + c],
                                    image->attributes[k][n * s + c]);
            }
          }
      }
    }
  return trial.verdict();
}

// One triangle in a conservative mode, or in none.
corpus::Scene conservative_scene(const corpus::Scene& scene, const std::array<Vertex, 3>& triangle, FillRule rule,
                                 Conservative mode) {
  corpus::Scene one = triangle_scene(scene.width, scene.height, triangle);
  one.draws[0].fill_rule = rule;
  one.draws[0].conservative = mode;
  return one;
}

// M4: inner within covered within over. A covered sample of any pattern is a point of T; of eight samples, none lies on
// the border of its pixel, so all of them are covered where the closed square lies in T.
TrialResult decide_contains(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (const corpus::SceneDraw& draw : scene.draws)
    for (const corpus::SceneTriangle& t : draw.triangles) {
      const std::array<Vertex, 3> triangle = triangle_of(draw, t);
      const auto mode = [&](Conservative m) { return conservative_scene(scene, triangle, draw.fill_rule, m); };
      corpus::Scene plain = mode(Conservative::none), eight = plain;
      eight.samples = 8;
      const auto over = trial.draw(mode(Conservative::over), kCountOnly);
      const auto inner = trial.draw(mode(Conservative::inner), kCountOnly);
      const auto covered = trial.draw(plain, kCountOnly), many = trial.draw(eight, kCountOnly);
      if (!over || !inner || !covered || !many) return trial.verdict();
      trial.looked_at(covered->count.size());
      for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) {
          const std::size_t e = element(*covered, x, y);
          const auto first = many->count.begin() + static_cast<std::ptrdiff_t>(8 * e);
          const bool any = covered->count[e] != 0 || std::any_of(first, first + 8, [](auto c) { return c != 0; });
          const bool all = covered->count[e] != 0 && std::all_of(first, first + 8, [](auto c) { return c != 0; });
          if (any) trial.expect_count("count of over where a sample is covered", x, y, 1, over->count[e]);
          if (!all) trial.expect_count("count of inner where a sample is not covered", x, y, 0, inner->count[e]);
        }
    }
  return trial.verdict();
}

// M4: T is the union of its pieces.
TrialResult decide_conservative_split(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  Random random = random_of(scene);
  for (const corpus::SceneDraw& draw : scene.draws)
    for (const corpus::SceneTriangle& t : draw.triangles) {
      const std::array<Vertex, 3> whole = triangle_of(draw, t);
      const std::vector<std::array<Vertex, 3>> pieces = pieces_of(whole, random);
      for (const Conservative mode : {Conservative::over, Conservative::inner}) {
        const auto expected = trial.draw(conservative_scene(scene, whole, draw.fill_rule, mode), kCountOnly);
        if (!expected) return trial.verdict();
        std::vector<std::uint32_t> sum(expected->count.size());
        for (const auto& piece : pieces) {
          const auto image = trial.draw(conservative_scene(scene, piece, draw.fill_rule, mode), kCountOnly);
          if (!image) return trial.verdict();
          for (std::size_t s = 0; s < sum.size(); ++s) sum[s] |= image->count[s];
        }
        trial.looked_at(sum.size());
        for (int y = 0; y < scene.height; ++y)
          for (int x = 0; x < scene.width; ++x) {
            const std::size_t e = element(*expected, x, y);
            if (mode == Conservative::over) trial.expect_count("over, by pieces", x, y, expected->count[e], sum[e]);
            if (mode == Conservative::inner && sum[e] != 0)
              trial.expect_count("inner where a piece is inner", x, y, 1, expected->count[e]);
          }
      }
    }
  return trial.verdict();
}

// Positions that lie on a grid of any offset; W is a power of two.
corpus::Scene make_on_lattice(std::uint64_t n) {
  Random random(n ^ 0x6121D);
  SceneLimits limits;
  limits.max_size = 9;
  corpus::Scene scene = pixel_scene(n, limits);
  const Grid grid{random.between(0, 12), random.between(0, 15), random.between(0, 15),
                  static_cast<GridRounding>(random.below(3))};
  const double offsets[] = {std::ldexp(grid.offset_x, -grid.bits - 4), std::ldexp(grid.offset_y, -grid.bits - 4)};
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.grid = grid;
    draw.scissor.reset();
    for (corpus::SceneVertex& v : draw.vertices) {
      const int exponent = random.one_in(2) ? 0 : random.between(-9, 9);
      const auto position = [&](int size, double offset) {
        const int steps = random.between(-(3 << grid.bits), (size + 3) << grid.bits);
        const double half = random.one_in(3) ? std::ldexp(std::round(std::ldexp(steps, 1 - grid.bits)), grid.bits - 1)
                                             : steps;  // half pixels: ties with samples where the offset is 0
        return static_cast<float>(std::ldexp(offset + std::ldexp(half, -grid.bits), exponent));
      };
      v.x = position(scene.width, offsets[0]);
      v.y = position(scene.height, offsets[1]);
      v.w = std::ldexp(1.0f, exponent);
    }
  }
  return scene;
}

// Is the position on the draw's grid, so that snapping leaves it alone? W > 0 is a power of two.
bool on_grid(const corpus::SceneVertex& v, const Grid& grid) {
  int exponent = 0;
  if (!finite(vertex_of(v)) || !(v.w > 0) || std::frexp(v.w, &exponent) != 0.5f) return false;
  const auto whole = [&](float value, int offset) {
    const double position = std::ldexp(static_cast<double>(value), 1 - exponent);
    const double k = std::ldexp(position, grid.bits + 4) - offset;  // exact for positions of up to 40 bits
    return std::abs(position) < 0x1p13 && k / 16 == std::floor(k / 16);
  };
  return whole(v.x, grid.offset_x) && whole(v.y, grid.offset_y);
}

// G1: snapping moves nothing that lies on the grid.
TrialResult decide_on_lattice(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene snapped = scene;
  for (corpus::SceneDraw& draw : snapped.draws) {
    draw.culling_box.reset();
    if (draw.grid)
      std::erase_if(draw.triangles, [&](const corpus::SceneTriangle& t) {
        return !std::all_of(t.vertices.begin(), t.vertices.end(),
                            [&](std::uint32_t i) { return on_grid(draw.vertices[i], *draw.grid); });
      });
  }
  corpus::Scene plain = snapped;
  for (corpus::SceneDraw& draw : plain.draws) draw.grid.reset();
  const corpus::Outputs outputs = outputs_of(scene);
  const auto expected = trial.draw(plain, outputs), actual = trial.draw(snapped, outputs);
  if (expected && actual) trial.expect_same("with a grid that holds all positions", scene, *expected, *actual);
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"samples-shifted", "S4", "each sample of a pattern is a single sample of the triangles moved", false, true, 0,
     make_samples, decide_shift},
    {"attributes-at-centre", "M1", "where the pixel's centre is covered, all samples have its attributes", false, true,
     0, make_samples, decide_at_centre},
    {"conservative-contains", "M4", "over contains covered contains inner, at every sample of the pixel", false, true,
     0, make_one, decide_contains},
    {"conservative-split", "M4", "over of a triangle is over of its pieces; inner of a piece is inner of the whole",
     false, true, 0, make_one, decide_conservative_split},
    {"grid-on-lattice", "G1, G2", "a grid that all positions lie on changes nothing", false, true, 0, make_on_lattice,
     decide_on_lattice},
};

}  // namespace

std::span<const Property> mode_properties() {
  return kProperties;
}

}  // namespace surefill::properties
