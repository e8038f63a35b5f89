// SPDX-License-Identifier: Apache-2.0
//
// Grid mode (semantics.md, section 6): a triangle clipped to the guard band and projected, its corners rounded once to
// the fixed-point grid, and everything that is then asked of it.
#ifndef SUREFILL_SRC_GRID_HPP
#define SUREFILL_SRC_GRID_HPP

#include <cstdint>

#include "bounds.hpp"
#include "triangle.hpp"

namespace surefill {

constexpr double kGuardBand = kMaxTargetSize + 1;  // g of G1: |X - ox W| <= g W and |Y - oy W| <= g W

// An estimate of a coordinate in units of the grid is a rounded value's neighbour only within this: |t| < 2^27, or, with
// an origin, 2^35.
inline double snap_error(bool with_origin = false) {
  return with_origin ? 0x1p-13 : 0x1p-21;
}

// c / w, which lies in [-g, g], rounded to the grid as G1 says: a position in pixels. w > 0.
double snapped_position(float c, float w, int offset, const Grid& grid, Rungs* rungs = nullptr);

// A corner of the clipped triangle: homogeneous coordinates, exact, W > 0 once all four planes have been applied. Sums
// of four products of a float32 or a 47-bit product of a float by a float32, so at most eight terms.
struct GuardCorner {
  Expansion<8> x, y, z, w;
  int guard_x = 0, guard_y = 0;  // not both 0: the corner (ox + guard_x g, oy + guard_y g) of the band itself; x, y, w
                                 // say so, z is not set, for there Z/W is I1
  int line = 0;  // which line leads to the next corner: 0..2 the triangle's edge i, 3 + p the guard plane p
};

// The part of a triangle within the guard band. Each of the four planes adds at most one corner.
struct GuardPolygon {
  GuardCorner corner[7];
  int corners = 0;
};

// The smallest and the largest Z/W among the corners of a polygon (G2): rounded as I4 says, and compared exactly.
struct DepthRange {
  float low, high;
  bool low_below_zero, high_below_zero, low_above_one, high_above_one;
};

// Does the hull of a triangle's vertices contain the eye, where D = 0 (G1)?
bool hull_contains_eye(const Triangle& triangle);

// An exact depth: Z/W of a corner, or I1. The denominator is not 0.
struct DepthFraction {
  Expansion<60> numerator;
  Expansion<12> denominator;
};

class SnappedTriangle {
 public:
  // False if the triangle's hull contains the eye (G1). Vertices are finite (B1). The grid is valid. Places are in space
  // whatever the origin (S6), which is where the guard band lies.
  bool set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, const Grid& grid, Rungs* rungs = nullptr,
              Origin origin = {});

  // The clipped polygon on the grid: positions in pixels, exact.
  int corners() const { return polygon_.corners; }
  SamplePosition corner(int n) const {
    return {static_cast<double>(point_[n].x) / units_per_pixel_ + origin_.x,
            static_cast<double>(point_[n].y) / units_per_pixel_ + origin_.y};
  }
  // What depth is clamped to (G2).
  const DepthRange& depth_range() {
    know_depth_range();
    return depth_range_;
  }

  // The part of `limits` with a sample in the box of the snapped polygon. Offsets as for screen_box.
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const;

  // N(p) of G1: -1, 0 or 1.
  int winding(SamplePosition p, TieShift shift) const { return winding(point_, polygon_.corners, p, shift); }
  // Does the triangle of corners 0, n and n + 1 cover p?
  bool fan_covers(int n, SamplePosition p, TieShift shift) const {
    const Point triangle[3] = {point_[0], point_[n], point_[n + 1]};
    return winding(triangle, 3, p, shift) != 0;
  }

  // Depth at p as G2, I8 and I4 have it; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs = nullptr);

  // Does an E_i count at p (G2)? If not, or if D = 0, the values at p are those of vertex 0.
  bool has_weights(SamplePosition p, Rungs* rungs = nullptr) const { return triangle_.right_edges(p, rungs) != 0; }

  // An attribute at p as G2 and I4 have it, from its values at the three vertices.
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) {
    return triangle_.attribute_of_right_edges(p, u, interpolation, rungs);
  }

 private:
  // In units of 2^-(bits + 4) pixels from the origin, in which grid positions and samples are integers. Below 2^30 +
  // 2^17 in magnitude.
  struct Point {
    std::int64_t x, y;
  };

  int winding(const Point* corner, int corners, SamplePosition p, TieShift shift) const;
  void know_depth_range();
  DepthFraction corner_depth(int n);
  float biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs);

  Triangle triangle_;  // unsnapped
  Origin origin_;
  GuardPolygon polygon_;
  Point point_[7];  // the corners of polygon_, snapped
  double units_per_pixel_ = 1;
  bool depth_range_known_ = false;
  DepthRange depth_range_{};
};

}  // namespace surefill

#endif  // SUREFILL_SRC_GRID_HPP
