// SPDX-License-Identifier: Apache-2.0
//
// One image in several ways: cropped, split into draws, moved, mirrored. Every changed float32 is exact, or the
// triangle is left out on both sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

corpus::Scene make_frame(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 6;
  return pixel_scene(n, limits);
}

// M3, on a rectangle inside of the target.
TrialResult decide_scissor(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene whole = scene, cut = scene, empty = scene;
  const Scissor scissor{scene.width / 3, scene.height / 4, std::max(1, 2 * scene.width / 3),
                        scene.height - scene.height / 4};
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    whole.draws[d].scissor.reset();
    cut.draws[d].scissor = scissor;
    empty.draws[d].triangles.clear();
  }
  const corpus::Outputs outputs = outputs_of(scene);
  const auto all = trial.draw(whole, outputs), some = trial.draw(cut, outputs), none = trial.draw(empty, outputs);
  if (!all || !some || !none) return trial.verdict();
  trial.expect_parts("the scissor", scene, scissor, *all, *none, *some);
  return trial.verdict();
}

// F2, M2.
TrialResult decide_facing(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene both = scene;
  for (corpus::SceneDraw& draw : both.draws) draw.cull = Cull::none;
  const auto all = trial.draw(both, kCountOnly);
  const auto one = trial.draw_facings(scene);
  if (!all || !one) return trial.verdict();
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(*all, x, y);
      trial.expect_count("count of front plus back", x, y, all->count[e], one->front.count[e] + one->back.count[e]);
    }
  trial.looked_at(all->count.size());
  return trial.verdict();
}

// V3: in index order, a draw and its two halves as draws of their own give one image.
TrialResult decide_split(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene halves = scene;
  halves.draws.clear();
  std::uint32_t before = 0;
  for (const corpus::SceneDraw& draw : scene.draws) {
    corpus::SceneDraw first = draw;
    if (!first.triangles.empty() && first.triangles[0].identifier)
      std::sort(first.triangles.begin(), first.triangles.end(),
                [](const auto& a, const auto& b) { return *a.identifier < *b.identifier; });
    else
      first.first_index = draw.first_index.value_or(before);
    const auto same = [](const auto& a, const auto& b) { return a.identifier && a.identifier == b.identifier; };
    if (std::adjacent_find(first.triangles.begin(), first.triangles.end(), same) != first.triangles.end())
      return trial.verdict();  // identifiers are unique: a precondition
    before += static_cast<std::uint32_t>(draw.triangles.size());
    corpus::SceneDraw second = first;
    const auto half = static_cast<std::ptrdiff_t>(draw.triangles.size() / 2);
    first.triangles.erase(first.triangles.begin() + half, first.triangles.end());
    second.triangles.erase(second.triangles.begin(), second.triangles.begin() + half);
    if (second.first_index) *second.first_index += static_cast<std::uint32_t>(half);
    halves.draws.push_back(std::move(first));
    halves.draws.push_back(std::move(second));
  }
  const corpus::Outputs outputs = outputs_of(scene);
  const auto whole = trial.draw(scene, outputs), split = trial.draw(halves, outputs);
  if (whole && split) trial.expect_same("with each draw split in two", scene, *whole, *split);
  return trial.verdict();
}

// Compares the scene with its changed form, whose pixel for (x, y) is `pixel`.
template <class Pixel>
void compare_changed(Trial& trial, const char* what, const std::pair<corpus::Scene, corpus::Scene>& scenes,
                     const Pixel& pixel) {
  const corpus::Outputs outputs = outputs_of(scenes.first);
  const auto before = trial.draw(scenes.first, outputs), after = trial.draw(scenes.second, outputs);
  Correspondence correspondence;
  correspondence.pixel = pixel;
  if (before && after) trial.expect_same(what, scenes.first, *before, *after, correspondence);
}

// The same geometry on a larger target, and moved by whole pixels on it.
TrialResult decide_translation(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  constexpr std::array<int, 2> kShifts[] = {{0, 0}, {1, 0}, {3, 5}, {64, 2}};
  for (const std::array<int, 2>& shift : kShifts) {
    const int dx = shift[0], dy = shift[1];
    auto scenes = changed_exactly(without_places(scene), [&](const Vertex& v) { return moved_exactly(v, dx, dy); });
    scenes.second.width += dx + 2;
    scenes.second.height += dy + 1;
    compare_changed(trial, "moved by whole pixels on a larger target", scenes, [&](int x, int y) {
      return std::array<int, 2>{x + dx, y + dy};
    });
  }
  return trial.verdict();
}

void flip_facing(corpus::Scene& scene) {
  for (corpus::SceneDraw& draw : scene.draws)
    draw.front_face = draw.front_face == FrontFace::clockwise ? FrontFace::counter_clockwise : FrontFace::clockwise;
}

// C3: the mirrored triangle under the mirrored rule. X := width W - X.
TrialResult decide_mirror(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const int width = scene.width;
  auto scenes = changed_exactly(without_places(scene), [&](const Vertex& v) {
    return moved_exactly({-v.x, v.y, v.z, v.w}, width, 0);
  });
  flip_facing(scenes.second);
  for (corpus::SceneDraw& draw : scenes.second.draws)
    draw.fill_rule = static_cast<FillRule>(static_cast<unsigned>(draw.fill_rule) ^ 1u);  // the x shift's sign
  compare_changed(trial, "mirrored", scenes, [&](int x, int y) { return std::array<int, 2>{width - 1 - x, y}; });
  return trial.verdict();
}

// C3: x and y exchanged, in vertices and in the rule. Always exact.
TrialResult decide_transpose(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  constexpr FillRule kTransposed[] = {FillRule::southwards,      FillRule::northwards,  FillRule::southwards_west,
                                      FillRule::northwards_west, FillRule::top_left,    FillRule::bottom_left,
                                      FillRule::top_right,       FillRule::bottom_right};
  auto scenes = changed_exactly(without_places(scene), [](const Vertex& v) {
    return std::optional<Vertex>({v.y, v.x, v.z, v.w});
  });
  std::swap(scenes.second.width, scenes.second.height);
  flip_facing(scenes.second);
  for (corpus::SceneDraw& draw : scenes.second.draws)
    draw.fill_rule = kTransposed[static_cast<std::size_t>(draw.fill_rule)];
  compare_changed(trial, "with x and y exchanged", scenes, [](int x, int y) { return std::array<int, 2>{y, x}; });
  return trial.verdict();
}

// M6: a box around the vertices, at W = 1.
TrialResult decide_culling_box(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene open = scene;
  for (corpus::SceneDraw& draw : open.draws) {
    draw.culling_box.reset();
    for (corpus::SceneVertex& v : draw.vertices) v.w = 1;
  }
  corpus::Scene boxed = open;
  for (corpus::SceneDraw& draw : boxed.draws) {
    std::optional<std::array<Vertex, 2>> ends;
    for (const corpus::SceneVertex& v : draw.vertices) {
      if (!finite(vertex_of(v))) continue;
      if (!ends) ends = {{vertex_of(v), vertex_of(v)}};
      auto& [low, high] = *ends;
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z), 1};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z), 1};
    }
    if (!ends) continue;
    draw.culling_box.emplace();
    for (unsigned i = 0; i < 8; ++i)
      (*draw.culling_box)[i] = {(*ends)[i & 1u].x, (*ends)[i >> 1 & 1u].y, (*ends)[i >> 2].z, 1};
  }
  const corpus::Outputs outputs = outputs_of(scene);
  const auto without = trial.draw(open, outputs), with = trial.draw(boxed, outputs);
  if (without && with) trial.expect_same("with a culling box", scene, *without, *with);
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"scissor", "M3", "a scissored image is the whole one inside, and empty outside", false, true, 0, make_frame,
     decide_scissor},
    {"front-and-back", "F2", "front faces and back faces add up to all", false, true, 0, make_frame, decide_facing},
    {"several-draws", "V3", "a draw and its two halves give one image", false, true, 0, make_frame, decide_split},
    {"translation", "C3, C4", "moved by whole pixels, on a target of another size, the image moves", false, true, 0,
     make_frame, decide_translation},
    {"mirror", "C3", "mirrored in x under the mirrored rule, the image is mirrored", false, true, 0, make_frame,
     decide_mirror},
    {"transpose", "C3", "with x and y exchanged, in the rule, too, the image is transposed", false, true, 0, make_frame,
     decide_transpose},
    {"culling-box", "M6", "a culling box around the draw changes nothing", false, true, 0, make_frame,
     decide_culling_box},
};

}  // namespace

std::span<const Property> frame_properties() {
  return kProperties;
}

}  // namespace surefill::properties
