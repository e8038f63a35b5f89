// SPDX-License-Identifier: Apache-2.0
//
// Triangles that are hard for the records of the fast path (batch_bounds.hpp), each kind for one of its bounds.
#ifndef SUREFILL_ENGINE_TESTS_BATCH_TRIANGLES_HPP
#define SUREFILL_ENGINE_TESTS_BATCH_TRIANGLES_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "properties/generators/generators.hpp"

namespace surefill::properties {

// Whole numbers and powers of two far below them, or far above: products of which some are exact, edges that miss
// samples by next to nothing; zeros of both signs, and sometimes an infinity.
inline std::array<Vertex, 3> uneven_triangle(Random& random) {
  const int finest = random.one_in(2) ? 34 : 100;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const bool infinities = random.one_in(16);
  const auto number = [&](int low, int high) {
    const float few = static_cast<float>(random.between(-3, 3));
    if (infinities && random.one_in(6)) return few < 0 ? -infinity : infinity;
    if (!random.one_in(3)) return static_cast<float>(random.between(low, high));
    return std::ldexp(few, random.one_in(12) ? random.between(12, 30) : -random.between(10, finest));
  };
  std::array<Vertex, 3> made;
  for (Vertex& v : made) {
    v = {number(-2, 14), number(-2, 14), number(0, 3), random.one_in(3) ? number(1, 3) : 1.0f};
    if (random.one_in(16)) v.w = random.one_in(2) ? 0.0f : -0.0f;
  }
  return made;
}

// With next to no area: two corners on a line through samples, the third far away in the line's direction; of any
// depth. No double, or just a double, tells the sign of D.
inline std::array<Vertex, 3> flat_triangle(Random& random, int size) {
  const auto any_depth = [&] {
    return std::ldexp(static_cast<float>(2 * random.unit() - 1), random.one_in(2) ? random.between(60, 126) : 0);
  };
  const float x = static_cast<float>(random.between(0, size - 1)) + 0.5f,
              y = static_cast<float>(random.between(0, size - 1)) + 0.5f;
  const auto dx = static_cast<float>(random.between(-3, 3)), dy = static_cast<float>(random.between(-3, 3));
  const auto back = static_cast<float>(-random.between(0, 300)), ahead = static_cast<float>(random.between(1, 300));
  const float far = static_cast<float>(2 * random.unit() - 1) * std::ldexp(1.0f, -random.between(40, 60));
  return {{{x + back * dx, y + back * dy, any_depth(), 1},
           {x + ahead * dx, y + ahead * dy, any_depth(), 1},
           {dx, dy, any_depth() * far, far}}};
}

// From beside the target's first sample down to the right, a few pixels wide: near the first sample its edges' terms
// are small, and the errors of their steps are what counts at the last.
inline std::array<Vertex, 3> diagonal_triangle(Random& random) {
  const double far_x = random.between(4000, 30000), far_y = random.between(4000, 30000);
  const auto near = [&] { return 2 * random.unit() - 1; };
  const double corners[3][2] = {{near(), near()}, {far_x, far_y}, {far_x + 20 * near(), far_y + 20 * near()}};
  std::array<Vertex, 3> made;
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = std::ldexp(1 + random.unit(), random.between(-12, 12));
    made[k] = {static_cast<float>(corners[k][0] * w), static_cast<float>(corners[k][1] * w),
               static_cast<float>(near() * w), static_cast<float>(w)};
  }
  return made;
}

// Around (x, y), where its depth passes 0: far from the origin of the screen, the errors of E_i are all there is.
inline std::array<Vertex, 3> crossing_triangle(Random& random, int x, int y) {
  const double slope_x = random.unit() - 0.5, slope_y = random.unit() - 0.5;
  const int reach = 1 << random.between(1, 10);
  std::array<Vertex, 3> made;
  for (Vertex& v : made) {
    const double w = random.one_in(2) ? 1 : 1 + random.unit();
    const double dx = (2 * random.unit() - 1) * reach, dy = (2 * random.unit() - 1) * reach;
    v = {static_cast<float>((x + dx) * w), static_cast<float>((y + dy) * w), 0, static_cast<float>(w)};
    v.z = static_cast<float>((v.x / static_cast<double>(v.w) - x) * slope_x * v.w +
                             (v.y / static_cast<double>(v.w) - y) * slope_y * v.w);
  }
  return made;
}

// Snapped to the grid, its corners are as near to one line as they can be, and far apart: P, Q and P + (u, v), where
// (Q - P) x (u, v) is 1, or 0, grid step each way.
inline std::array<Vertex, 3> thin_triangle(Random& random, const Grid& grid) {
  const double steps = 1 << grid.bits;
  const auto any = [&] { return std::round((2 * random.unit() - 1) * (kMaxTargetSize - 1) * steps); };
  double x = any(), y = any(), to_x = any(), to_y = any();
  if (random.one_in(2)) {  // from the first sample of its box, near which it passes, down to the right
    std::tie(x, to_x) = std::minmax({std::fabs(x), std::fabs(to_x)});
    std::tie(y, to_y) = std::minmax({std::fabs(y), std::fabs(to_y)});
  }
  const double dx = to_x - x, dy = to_y - y;
  auto r0 = static_cast<std::int64_t>(dx), r1 = static_cast<std::int64_t>(dy);
  double v0 = 1, v1 = 0, u0 = 0, u1 = 1;  // Euclid: r = dx v + dy u, so that dx v0 + dy u0 divides both
  while (r1 != 0) {
    const std::int64_t q = r0 / r1;
    std::tie(r0, r1) = std::pair(r1, r0 - q * r1);
    std::tie(v0, v1) = std::pair(v1, v0 - static_cast<double>(q) * v1);
    std::tie(u0, u1) = std::pair(u1, u0 - static_cast<double>(q) * u1);
  }
  double u = -u0, v = v0;
  if (u * dx + v * dy < 0) u += dx, v += dy;
  if (random.one_in(4)) u = dx, v = dy;
  const double corner[3][2] = {{x, y}, {x + dx, y + dy}, {x + u, y + v}};
  std::array<Vertex, 3> made;
  for (std::size_t k = 0; k < 3; ++k) {
    // A W with which float32 numbers come near enough, mostly.
    const double at_x = (corner[k][0] + grid.offset_x / 16.0) / steps,
                 at_y = (corner[k][1] + grid.offset_y / 16.0) / steps;
    const auto error = [&](double at, float w) {
      return std::fabs(static_cast<double>(static_cast<float>(at * w)) / w - at) * steps;
    };
    float w = 1;
    for (int tries = 0; tries < 300 && std::max(error(at_x, w), error(at_y, w)) > 0.4; ++tries)
      w = static_cast<float>(1 + random.unit());
    made[k] = {static_cast<float>(at_x * w), static_cast<float>(at_y * w), w / 2, w};
  }
  if (random.one_in(2)) std::swap(made[0], made[1]);
  return made;
}

}  // namespace surefill::properties

#endif  // SUREFILL_ENGINE_TESTS_BATCH_TRIANGLES_HPP
