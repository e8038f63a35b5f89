// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/layers.hpp"

#include <cmath>
#include <vector>

#include "certify/judge/questions.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;
using corpus::SceneDraw;
using Corners = std::array<corpus::SceneVertex, 3>;

constexpr int kLevels = 15;  // of depth, 1/16 apart

// Over all of the target, to one side of its middle, or a part of it.
Corners layer_corners(judge::Random& random, int width, int height) {
  constexpr double kBeyond = 2;
  const int kind = random.below(8);
  if (kind == 0) return judge::plain_corners(random, width, height);
  const double sign = kind < 5 || kind % 2 == 0 ? 1 : -1;
  double x = sign > 0 ? -kBeyond : width + kBeyond, y = sign > 0 ? -kBeyond : height + kBeyond;
  if (kind >= 5) (random.below(2) == 0 ? x : y) = random.below(2) == 0 ? width / 2.0 : height / 2.0;
  return {judge::corner(x, y), judge::corner(x + sign * 4 * width, y), judge::corner(x, y + sign * 4 * height)};
}

}  // namespace

Scene layers_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  const surefill_adapter_info& info = subject.rival->info();
  const auto takes = [&info](int feature) { return (info.features & static_cast<std::uint32_t>(feature)) != 0; };
  judge::Random random(seed);
  const int width = random.between(9, 40), height = random.between(9, 40);  // in this order, whoever compiles it
  Scene scene = judge::empty_scene(width, height);
  scene.draws.clear();
  if (number % 4 == 3 && takes(SUREFILL_ADAPTER_SAMPLES)) scene.samples = 4;
  if (number % 2 == 1 && takes(SUREFILL_ADAPTER_DEPTH_GREATER)) scene.depth_test = DepthTest::greater;
  std::vector<int> levels;
  for (int n = 1; n <= kLevels; ++n) levels.insert(levels.begin() + random.below(n), n);
  const auto next_level = [&levels] {
    const int level = levels.back();
    levels.pop_back();
    return level / 16.0;
  };
  const int before = takes(SUREFILL_ADAPTER_INITIAL_DEPTH) ? random.below(3) : 0;
  if (before == 1) scene.initial_depth = {static_cast<float>(next_level())};
  if (before == 2) {
    const std::array<double, 3> depths{next_level(), next_level(), next_level()};
    for (int s = scene.width * scene.height * scene.samples; s > 0; --s) {
      scene.initial_depth.push_back(static_cast<float>(depths[static_cast<std::size_t>(random.below(3))]));
    }
  }
  std::vector<Interpolation> kinds{Interpolation::perspective};
  if (takes(SUREFILL_ADAPTER_NOPERSPECTIVE)) kinds.push_back(Interpolation::noperspective);
  if (takes(SUREFILL_ADAPTER_FLAT)) kinds.push_back(Interpolation::flat);
  const bool attributes = (info.outputs & SUREFILL_ADAPTER_ATTRIBUTES) != 0;
  if (attributes) scene.attributes = {{"a", 1, Interpolation::perspective}};
  for (int d = takes(SUREFILL_ADAPTER_DRAWS) ? random.between(2, 6) : 1; d > 0 && !levels.empty(); --d) {
    SceneDraw& draw = scene.draws.emplace_back();
    draw.depth_write = !takes(SUREFILL_ADAPTER_DEPTH_READ_ONLY) || random.below(3) > 0;
    if (attributes)
      draw.interpolations = {kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))]};
    for (int t = random.between(1, 4); t > 0 && !levels.empty(); --t) {
      Corners corners = layer_corners(random, scene.width, scene.height);
      const double level = next_level();
      const int most = random.below(2) == 0 ? 0 : 2;  // of W, a power of two
      for (corpus::SceneVertex& v : corners) {
        const double z = level + random.between(-2, 2) / 128.0;
        v = judge::corner(v.x, v.y, z, std::ldexp(1, random.between(-most, most)));
        if (attributes) v.attributes = {static_cast<float>(random.between(-32, 32) / 8.0)};
      }
      if (random.below(2) == 0) std::swap(corners[1], corners[2]);
      judge::add_triangle(draw, corners, subject.terms.model.culled);
    }
  }
  return scene;
}

CaseResult layers_case(const Scene& scene, const RivalSubject& subject) {
  const auto after = [&](bool near) {
    const CaseResult before = guarded_case(scene, [&] {
      draw_flat_frame(scene, subject, near);
      return CaseResult{};
    });
    return before.differences > 0 ? before : judge_scene(scene, subject);
  };
  CaseResult result = after(true);
  if (result.differences > 0 && after(false).differences == 0) {
    result.finding = "after a frame with a near triangle over all of it: " + result.finding;
  }
  return result;
}

}  // namespace surefill::certify
