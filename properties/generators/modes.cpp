// SPDX-License-Identifier: Apache-2.0
//
// Scenes in the modes that a frame may have beyond the plain one: origin, sample places, layers, winding, numbers of
// triangles, the four depth tests, bias, and the four conservative modes with their index.
#include <algorithm>

#include "properties/generators/scene_parts.hpp"

namespace surefill::properties {
namespace {

using corpus::Scene;
using corpus::SceneDraw;

template <typename Value, std::size_t Count>
Value one_of(Random& random, const Value (&values)[Count]) {
  return values[random.below(Count)];
}

}  // namespace

void set_origin(Scene& scene, Random& random) {
  if (random.one_in(2)) {
    scene.origin = {random.between(-4, 8), random.between(-4, 8)};
    return;
  }
  scene.origin = {one_of(random, {kMaxOrigin, -kMaxOrigin, 70000, -16384, 4095, 1 << 20}),
                  one_of(random, {kMaxOrigin, -kMaxOrigin, -70001, 16384, 0, 3})};
  const auto shifted = [](int side, int by) {
    return static_cast<int>(
        std::clamp<std::int64_t>(std::int64_t{side} + by, -(std::int64_t{1} << 31), (std::int64_t{1} << 31) - 1));
  };
  for (SceneDraw& draw : scene.draws) {
    if (draw.viewport) continue;
    for (corpus::SceneVertex& v : draw.vertices) {
      v.x += static_cast<float>(scene.origin.x) * v.w;
      v.y += static_cast<float>(scene.origin.y) * v.w;
    }
    if (draw.scissor) {
      const Scissor s = *draw.scissor;
      draw.scissor = {shifted(s.x0, scene.origin.x), shifted(s.y0, scene.origin.y), shifted(s.x1, scene.origin.x),
                      shifted(s.y1, scene.origin.y)};
    }
  }
}

void set_locations(Scene& scene, Random& random) {
  for (int n = 0; n < scene.samples; ++n) {
    scene.sample_locations.push_back({random.between(0, 15), random.between(0, 15)});
    if (n > 0 && random.one_in(4)) scene.sample_locations.back() = scene.sample_locations.front();
  }
}

namespace {

// The first draw conservative, with a degenerate triangle among its own.
void set_conservative(Scene& scene, Random& random) {
  SceneDraw& draw = scene.draws[0];
  draw.conservative = Conservative::over;
  draw.depth_mode = DepthMode::none;
  draw.grid.reset();
  scene.initial_depth.clear();
  if (!draw.triangles.empty() && random.one_in(2)) {
    std::array<std::uint32_t, 3>& corners =
        draw.triangles[random.below(static_cast<std::uint32_t>(draw.triangles.size()))].vertices;
    corners[2] = corners[random.below(2)];
    if (random.one_in(4)) corners[1] = corners[0];
  }
}

}  // namespace

Scene modes_scene(const Category& category, std::uint64_t seed, int max_size, int max_triangles) {
  Scene scene = mixed_scene(category, seed, max_size, max_triangles);
  Random random(seed * 0x9E3779B97F4A7C15u + 0x21);
  if (seed % 3 == 2 && scene.samples == 1) set_conservative(scene, random);
  const bool conservative = std::any_of(scene.draws.begin(), scene.draws.end(),
                                        [](const SceneDraw& draw) { return draw.conservative != Conservative::none; });
  // Any of them, or one alone.
  enum Mode : std::uint32_t { kOrigin, kLocations, kLayers, kDepthTest, kMore, kBias, kModes };
  const std::uint32_t alone = random.below(2 * kModes);
  const auto has = [&](Mode mode, std::uint32_t n) { return alone < kModes ? mode == alone : random.one_in(n); };
  if (has(kOrigin, 2)) set_origin(scene, random);
  if (!conservative && has(kLocations, 2)) set_locations(scene, random);
  if (!conservative && has(kLayers, 2)) {
    scene.layers = one_of(random, {2, 3, 5, kMaxLayers});
    for (SceneDraw& draw : scene.draws) draw.depth_write = true;
  }
  if (has(kDepthTest, 1)) scene.depth_test = static_cast<DepthTest>(random.below(4));
  if (has(kMore, 1)) scene.more = {random.one_in(2), random.one_in(2), random.one_in(2)};
  for (SceneDraw& draw : scene.draws) {
    if (has(kBias, 3)) {
      const float constants[] = {0, 0.25f, -1, 0x1p-24f, 0x1p-149f, 3e38f, static_cast<float>(random.unit())};
      const float slopes[] = {0, 1, -2, 0.5f, 1e-3f, -3e38f, static_cast<float>(random.unit())};
      draw.depth_bias = DepthBias{one_of(random, constants), one_of(random, slopes)};
    }
    if (draw.conservative != Conservative::none) draw.conservative = static_cast<Conservative>(1 + random.below(4));
    if (!draw.grid && random.one_in(4)) draw.fill_rule = static_cast<FillRule>(random.below(10));
  }
  return scene;
}

}  // namespace surefill::properties
