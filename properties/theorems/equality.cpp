// SPDX-License-Identifier: Apache-2.0
//
// The image equals the exact one, output by output and as a whole.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "oracle/oracle.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

constexpr SceneLimits kPlain{16, 4, false, false, false, false, false};

corpus::Scene random_case(std::uint64_t n, const SceneLimits& limits) {
  return random_scene(category_of_case(n), n / categories().size(), limits);
}

corpus::Scene make_coverage(std::uint64_t n) {
  corpus::Scene scene = random_case(n, kPlain);
  for (corpus::SceneDraw& draw : scene.draws) draw.fill_rule = static_cast<FillRule>((n / categories().size()) % 8);
  return scene;
}

corpus::Scene make_closed_open(std::uint64_t n) {
  corpus::Scene scene = random_case(n, kPlain);
  for (corpus::SceneDraw& draw : scene.draws)
    draw.fill_rule = (n / categories().size()) % 2 == 0 ? FillRule::closed : FillRule::open;
  return scene;
}

corpus::Scene make_depth(std::uint64_t n) {
  constexpr DepthMode kModes[] = {DepthMode::none, DepthMode::clip, DepthMode::clamp};
  corpus::Scene scene = random_case(n, kPlain);
  for (corpus::SceneDraw& draw : scene.draws) draw.depth_mode = kModes[(n / categories().size()) % 3];
  return scene;
}

// Long and narrow, up to the largest target, where sample positions need all their bits.
corpus::Scene make_wide(std::uint64_t n) {
  Random random(n);
  const Category& category = category_of_case(n);
  const int exponent = random.between(4, 14);
  const int length = std::min(kMaxTargetSize, (1 << exponent) + static_cast<int>(random.below(1u << exponent)));
  const int breadth = random.between(1, std::max(1, 4096 / length));
  corpus::Scene scene = random.one_in(2) ? triangle_scene(length, breadth, category.triangle(random, length, breadth))
                                         : triangle_scene(breadth, length, category.triangle(random, breadth, length));
  scene.draws[0].fill_rule = static_cast<FillRule>(random.below(8));
  return scene;
}

corpus::Scene make_values(std::uint64_t n) {
  SceneLimits limits = kPlain;
  limits.max_size = 8;
  limits.attributes = true;
  return random_case(n, limits);
}

corpus::Scene make_scene(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 6;
  return random_case(n, limits);
}

// Frames with all their state in one mode each: sample patterns, Grid, conservative.
corpus::Scene make_mode(std::uint64_t n, bool samples, bool grid, bool conservative) {
  SceneLimits limits;
  limits.max_size = 6;
  limits.samples = samples;
  limits.grid = grid;
  limits.conservative = conservative;
  for (std::uint64_t round = 0;; ++round) {  // the next scene that uses the mode: half of them, or a third
    corpus::Scene scene = random_scene(category_of_case(n), n / categories().size() + (round << 40), limits);
    const auto uses = [&](const corpus::SceneDraw& draw) {
      return (grid && draw.grid) || (conservative && draw.conservative != Conservative::none);
    };
    if ((samples && scene.samples > 1) || std::any_of(scene.draws.begin(), scene.draws.end(), uses)) return scene;
  }
}

corpus::Scene make_samples(std::uint64_t n) {
  return make_mode(n, true, false, false);
}

// Where the guard band cuts: long targets, corners around and beyond their far end, coarse grids.
corpus::Scene make_far_grid(std::uint64_t n) {
  Random random(n ^ 0x6A2D);
  const bool high = random.one_in(2);
  const auto far = [&random] {
    const int reach = 1 << random.between(2, 20);
    return static_cast<float>(kMaxTargetSize + random.between(-reach, reach));
  };
  std::array<Vertex, 3> triangle{};
  for (Vertex& v : triangle) {
    const float along = random.one_in(4) ? static_cast<float>(random.between(-100, kMaxTargetSize)) : far();
    const float across = random.one_in(2) ? far() : static_cast<float>(random.between(-4000, 4000)) / 16;
    v = {high ? across : along, high ? along : across, static_cast<float>(random.between(0, 8)) / 8, 1};
    if (random.one_in(8)) {
      v.w = static_cast<float>(random.between(-2, 0));
    } else if (random.one_in(2)) {  // coordinates of all bits: cut points are rounded on the way
      const float w = 0.5f + static_cast<float>(random.unit());
      v = {v.x * w, v.y * w, v.z * w, w};
    }
  }
  const int breadth = random.between(1, 3);
  corpus::Scene scene =
      high ? triangle_scene(breadth, kMaxTargetSize, triangle) : triangle_scene(kMaxTargetSize, breadth, triangle);
  scene.draws[0].grid = Grid{random.between(0, 4), random.between(0, 15), random.between(0, 15),
                             static_cast<GridRounding>(random.below(3))};
  // The far end alone, where the cuts show.
  scene.draws[0].scissor = high ? Scissor{0, kMaxTargetSize - 64, breadth, kMaxTargetSize}
                                : Scissor{kMaxTargetSize - 64, 0, kMaxTargetSize, breadth};
  return scene;
}

corpus::Scene make_grid(std::uint64_t n) {
  if (n % 16 == 15) return make_far_grid(n / 16);
  return make_mode(n, n % 4 == 3, true, false);
}
corpus::Scene make_conservative(std::uint64_t n) {
  return make_mode(n, false, false, true);
}

corpus::Scene make_modes(std::uint64_t n) {
  return modes_scene(category_of_case(n), n / categories().size(), 7, 5);
}

corpus::Scene make_lines(std::uint64_t n) {
  const std::span<const LineCategory> categories = line_categories();
  return lines_scene(categories[n % categories.size()], n / categories.size(), 9, 6);
}

// The exact image. The last one is kept, since many renderers may be held against it in turn.
const corpus::Image& exact_image(const corpus::Scene& scene, const corpus::Outputs& outputs) {
  struct Last {
    corpus::Scene scene;
    std::array<bool, 7> outputs;
    corpus::Image image;
  };
  thread_local std::optional<Last> last;
  const std::array<bool, 7> asked{outputs.count,      outputs.index,   outputs.depth,  outputs.barycentrics,
                                  outputs.attributes, outputs.winding, outputs.numbers};
  if (!last || last->outputs != asked || !corpus::equal(last->scene, scene)) {
    corpus::Frame frame(scene, outputs);
    oracle::render(frame.target(), frame.draws());
    last = {scene, asked, std::move(frame.image())};
  }
  return last->image;
}

TrialResult decide_with(const corpus::Scene& scene, const Renderer& renderer, const corpus::Outputs& outputs) {
  Trial trial(renderer);
  const auto actual = trial.draw(scene, outputs);
  if (!actual) return trial.verdict();
  const Comparison comparison = compare(scene, exact_image(scene, outputs), *actual, 1);
  TrialResult verdict{comparison.samples, comparison.differences, {}};
  if (!comparison.first.empty()) verdict.finding = describe(comparison.first[0], scene.samples);
  return verdict;
}

TrialResult decide_coverage(const corpus::Scene& scene, const Renderer& renderer) {
  return decide_with(scene, renderer, kCountOnly);
}
TrialResult decide_depth(const corpus::Scene& scene, const Renderer& renderer) {
  return decide_with(scene, renderer, {true, true, true, false, false});
}
TrialResult decide_all(const corpus::Scene& scene, const Renderer& renderer) {
  return decide_with(scene, renderer, outputs_of(scene));
}

constexpr Property kProperties[] = {
    {"equality-coverage", "C1-C4", "every coverage count is the oracle's, under every fill rule", true, true, 0,
     make_coverage, decide_coverage},
    {"equality-closed-open", "C5", "every coverage count is the oracle's, under the fill rules closed and open", true,
     true, 0, make_closed_open, decide_coverage},
    {"equality-wide", "S5, C1-C4", "on targets up to 16384 pixels wide or high, counts and depths are the oracle's",
     true, true, 0, make_wide, decide_depth},
    {"equality-depth", "I1, I4, I5, V1", "counts, indices and depths are the oracle's, bit for bit", true, true, 0,
     make_depth, decide_depth},
    {"equality-attributes", "I2-I4", "barycentrics and attributes are the oracle's, bit for bit", true, true, 0,
     make_values, decide_all},
    {"equality-scene", "F, V, B1, M", "whole frames with all their state are the oracle's, bit for bit", true, true, 0,
     make_scene, decide_all, true},
    {"equality-samples", "S4, M1", "frames of 2 to 16 samples a pixel are the oracle's, bit for bit", true, true, 0,
     make_samples, decide_all, true},
    {"equality-grid", "G1, G2", "frames snapped to a grid are the oracle's, bit for bit", true, true, 0, make_grid,
     decide_all, true},
    {"equality-modes", "S6, S7, V4, V5, I8, M4a-M4c, M9, M10",
     "frames with an origin, sample places, layers, bias, further depth tests and outputs are the oracle's, bit for "
     "bit",
     true, true, 0, make_modes, decide_all},
    {"equality-lines", "M7, I6, I7", "frames of lines and points, thin and wide, are the oracle's, bit for bit", true,
     true, 0, make_lines, decide_all},
    {"equality-conservative", "M4", "counts of conservative draws are the oracle's", true, true, 0, make_conservative,
     decide_all},
};

}  // namespace

std::span<const Property> equality_properties() {
  return kProperties;
}

}  // namespace surefill::properties
