// SPDX-License-Identifier: Apache-2.0
//
// A point of a draw: the square of samples that it covers (M7), and its values (I6).
#ifndef SUREFILL_SRC_POINT_HPP
#define SUREFILL_SRC_POINT_HPP

#include <cmath>

#include "approximation.hpp"
#include "bounds.hpp"
#include "edge.hpp"

namespace surefill {

class Point {
 public:
  // False if it covers nothing. The vertex is finite; the size is finite and above 0.
  bool set_up(const Vertex& v, float size) {
    vertex_ = v;
    half_ = 0.5 * static_cast<double>(size) * v.w;  // of the side, times W: 48 bits, exact
    return v.w > 0;
  }

  bool covers(SamplePosition p, TieShift shift) const {
    return covers(p.x, vertex_.x, shift.x) && covers(p.y, vertex_.y, shift.y);
  }

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const {
    clip_to_reach(reach_of(vertex_.x), least_offset, largest_offset, &limits.x0, &limits.x1);
    clip_to_reach(reach_of(vertex_.y), least_offset, largest_offset, &limits.y0, &limits.y1);
    return limits;
  }

  // Depth as it is stored; false if depth clipping removes the fragments (I5).
  bool depth(DepthMode mode, float* to) const {
    const double z = vertex_.z, w = vertex_.w;
    if (mode == DepthMode::clip && (z < 0 || z > w)) return false;
    const double q = z / w;
    *to = rounded({q, std::fabs(q) * 0x1p-52}, [&] {
      Expansion<1> numerator, denominator;
      numerator.add(z), denominator.add(w);
      return round_quotient(numerator, denominator);
    });
    if (mode == DepthMode::clamp) *to = *to < 0 ? 0.0f : *to > 1 ? 1.0f : *to;  // rounding is monotonic
    return true;
  }

 private:
  // |p' - c/W| < s/2 along one axis, on which a sample is moved by `step`. p W is exact: 27 and 24 bits.
  bool covers(double p, double c, int step) const {
    return sign(p * vertex_.w, -c, -half_, step) < 0 && sign(p * vertex_.w, -c, half_, step) > 0;
  }

  // Of a + b + c, where a moves by an infinitely small part of `step`.
  static int sign(double a, double b, double c, int step) {
    const double sum = (a + b) + c;
    if (std::fabs(sum) > 0x1p-51 * ((std::fabs(a) + std::fabs(b)) + std::fabs(c))) return sign_of(sum);
    Expansion<3> exact;
    exact.add(a), exact.add(b), exact.add(c);
    return exact.sign() != 0 ? exact.sign() : step;
  }

  // A little more than what it covers along an axis.
  Reach reach_of(double c) const {
    const double centre = c / vertex_.w, half = half_ / vertex_.w;
    const double margin = half + 0x1p-50 * (std::fabs(centre) + half);
    return {centre - margin, centre + margin};
  }

  Vertex vertex_;
  double half_ = 0;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_POINT_HPP
