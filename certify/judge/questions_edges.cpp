// SPDX-License-Identifier: Apache-2.0
//
// Questions about samples that lie on edges, or all but on them: of edges that two triangles share, and of those that are
// level only once their ends are rounded to the grid.
#include <array>
#include <cmath>

#include "certify/judge/questions.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

using corpus::Scene;
using corpus::SceneVertex;

std::string about_shared_edges(const Questions& questions) {
  constexpr int kSize = 32, kScenes = 240;
  Random random(0x5A2ED);
  int all = 0, twice = 0, never = 0;
  for (int n = 0; n < kScenes; ++n) {
    // The edge goes through the sample exactly, along a vector of twelve binary places: float32 has each of its ends, and
    // clip space, too, but not all products of them.
    const int px = 8 + static_cast<int>(random.below(16)), py = 8 + static_cast<int>(random.below(16));
    const auto part = [&random] { return (static_cast<double>(random.below(16384)) - 8192) / 4096; };
    const double x = px + questions.model.x.place, y = py + questions.model.y.place, dx = part(), dy = part();
    if (std::max(std::abs(dx), std::abs(dy)) < 1) continue;
    const double before = 2 + static_cast<double>(random.below(5)), after = 2 + static_cast<double>(random.below(5));
    const SceneVertex a = corner(x - before * dx, y - before * dy), b = corner(x + after * dx, y + after * dy);
    Scene scene = empty_scene(kSize, kSize);
    add_triangle(scene.draws[0], {a, b, corner(x - 4 * dy, y + 4 * dx)}, questions.model.culled);
    add_triangle(scene.draws[0], {b, a, corner(x + 4 * dy, y - 4 * dx)}, questions.model.culled);
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) return "";
    const std::uint32_t count = image->count[static_cast<std::size_t>(py * kSize + px)];
    ++all, twice += count > 1, never += count == 0;
  }
  // By a rule that gives an edge to both, or to neither, all are.
  if (twice + never == 0 || twice == all || never == all) return "";
  return text(
      "of samples on an edge that two triangles share %.1f %% are drawn twice and "
      "%.1f %% never: an edge is rounded another way for each of the two",
      100.0 * twice / all, 100.0 * never / all);
}

// How far beyond an upright edge a triangle of some width reaches: by halves.
double reach_of(const Questions& questions, double width) {
  constexpr int kSize = 32;
  const double place = 20 + questions.model.x.place;  // of the sample
  double low = 0, high = 8;
  for (int step = 0; step < 22; ++step) {
    const double middle = std::nearbyint((low + high) / 2 * 65536) / 65536;
    Scene scene = empty_scene(kSize, kSize);
    add_triangle(scene.draws[0],
                 {corner(place - middle, -200), corner(place - middle, 232), corner(place - middle - width, 16)},
                 questions.model.culled);
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) return 0;
    (is_covered(*image, 16 * kSize + 20) ? low : high) = middle;
  }
  return low;
}

// Does a triangle reach further, the larger it is?
std::string about_growth(const Questions& questions) {
  const double small = reach_of(questions, 64), large = reach_of(questions, 512), largest = reach_of(questions, 2048);
  if (!(largest > 1.0 / 64 && largest < 7) || std::abs(largest - 4 * large) > largest / 4 || 8 * small > largest)
    return "";
  return text(
      "triangles reach further than they are, the further the larger they are: by %.2g of their height over an "
      "edge, as where barycentrics may be negative by that much",
      largest / 2048);
}

std::string about_snapped_edges(const Questions& questions) {
  const oracle::AxisModel& axis = questions.model.y;
  if (axis.bits < 4 || axis.bits > 12 || axis.grid_offset != 0 || axis.rounding > oracle::Rounding::nearest_away)
    return "";
  const double y = 5 + axis.place, least = std::ldexp(1.0, -axis.bits - 3);
  int differ = 0;
  for (const double apex : {6.25, -4.75}) {
    std::array<std::array<std::uint32_t, 5>, 3> counts{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = least * (static_cast<double>(k) - 1);
      Scene scene = empty_scene(16, 16);
      add_triangle(scene.draws[0], {corner(2.25, y + off), corner(12.25, y - off), corner(7.25, y + apex)},
                   questions.model.culled);
      const auto image = questions.rival(scene);
      if (!image || image->count.empty()) return "";
      for (std::size_t i = 0; i < 5; ++i) counts[k][i] = image->count[5 * 16 + 5 + i];
    }
    differ += counts[0] != counts[1] || counts[2] != counts[1];
  }
  if (differ == 0) return "";
  return "an edge that is level only once its ends are rounded to the grid is not taken for level: who owns the "
         "samples "
         "on it is decided by positions before they are rounded";
}

}  // namespace surefill::judge
