// SPDX-License-Identifier: Apache-2.0
//
// A box of pixels that holds every sample a triangle can cover. Vertices are divided by W only where W > 0; a vertex at
// or behind the eye either proves that it does not reach past a bound, or the box ends at the target's edge there (J.
// Blinn, Calculating Screen Coverage, 1996).
#ifndef SUREFILL_SRC_BOUNDS_HPP
#define SUREFILL_SRC_BOUNDS_HPP

#include <algorithm>
#include <cmath>
#include <limits>

#include "../facts.hpp"

namespace surefill {

// An interval of real numbers: what a triangle reaches along one axis in front of the eye.
struct Reach {
  double low, high;
};

// Along one axis: `c` is X (or Y) of the three vertices. Not all W are <= 0.
//
// A visible point is a sum of l_i m_i with l_i >= 0 and W > 0. If c_i - high W_i <= 0 for every vertex, the same holds
// for the sum, so c / W <= high. For W_i > 0 that is c_i / W_i <= high. Rounding the quotient is monotonic and sample
// coordinates are doubles, so no margin is needed while all W > 0; with another vertex in play the bounds move outwards
// by one ulp.
inline Reach reach(const double (&c)[3], const double (&w)[3]) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Reach r{kInfinity, -kInfinity};
  bool all_in_front = true;
  for (int i = 0; i < 3; ++i) {
    if (w[i] > 0) {
      r.low = std::min(r.low, c[i] / w[i]);
      r.high = std::max(r.high, c[i] / w[i]);
    } else {
      all_in_front = false;
    }
  }
  if (all_in_front) return r;
  r.low = std::nextafter(r.low, -kInfinity);
  r.high = std::nextafter(r.high, kInfinity);
  for (int i = 0; i < 3; ++i) {
    if (w[i] > 0) continue;
    // high W_i and low W_i with their rounding error taken to the unsafe side; 0 is exact.
    const double at_high = r.high * w[i], at_low = r.low * w[i];
    if (!(c[i] <= at_high - std::fabs(at_high) * 0x1p-52)) r.high = kInfinity;
    if (!(c[i] >= at_low + std::fabs(at_low) * 0x1p-52)) r.low = -kInfinity;
  }
  return r;
}

// Pixels i of [first, last) with a sample coordinate i + offset in the reach, offset between the two given ones.
inline void clip_to_reach(Reach r, double least_offset, double largest_offset, int* first, int* last) {
  const double lowest = std::ceil(r.low - largest_offset), highest = std::floor(r.high - least_offset);
  *first = static_cast<int>(std::clamp(lowest, static_cast<double>(*first), static_cast<double>(*last)));
  *last = static_cast<int>(std::clamp(highest + 1, static_cast<double>(*first), static_cast<double>(*last)));
}

// The part of `limits` that the triangle can reach. Sample offsets within a pixel lie in [least_offset,
// largest_offset].
inline PixelBox screen_box(const Vertex& v0, const Vertex& v1, const Vertex& v2, PixelBox limits, double least_offset,
                           double largest_offset) {
  const double w[3] = {v0.w, v1.w, v2.w};
  if (!(w[0] > 0 || w[1] > 0 || w[2] > 0)) return {0, 0, 0, 0};
  clip_to_reach(reach({v0.x, v1.x, v2.x}, w), least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach(reach({v0.y, v1.y, v2.y}, w), least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

}  // namespace surefill

#endif  // SUREFILL_SRC_BOUNDS_HPP
