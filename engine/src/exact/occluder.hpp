// SPDX-License-Identifier: Apache-2.0
//
// What a safe occlusion buffer asks of occluders and closed pixel squares (O4), exactly: does what is seen of an edge meet
// a square, which depths has a triangle's plane on it. Depth is a key that grows with distance: z, or -z (GREATER).
#ifndef SUREFILL_SRC_EXACT_OCCLUDER_HPP
#define SUREFILL_SRC_EXACT_OCCLUDER_HPP

#include <algorithm>
#include <cmath>
#include <limits>

#include "edge.hpp"
#include "exact.hpp"
#include "triangle.hpp"

namespace surefill {

// An interval on each axis. Its ends are rounded quotients of float32, and nevertheless compare exactly with the corners of
// pixels: X and c W are numbers of 24 and 39 bits, so if X / W differs from c, it does by more than 2^-40 of c.
struct Extent {
  double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;

  void add(double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x);
    y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
  void add(const Extent& other) {
    x0 = std::min(x0, other.x0), x1 = std::max(x1, other.x1);
    y0 = std::min(y0, other.y0), y1 = std::max(y1, other.y1);
  }
  // Does it meet the closed square of pixel (x, y)?
  bool meets(int x, int y) const { return x0 <= x + 1 && x1 >= x && y0 <= y + 1 && y1 >= y; }
};

// The S (M7) of an edge: a segment, a ray, or nothing; also where it is one point.
class SeenEdge {
 public:
  SeenEdge(const Vertex& from, const Vertex& to);

  const Extent& extent() const { return extent_; }

  // Does it meet the closed square of pixel (x, y)?
  bool meets(int x, int y) const;

 private:
  EdgeFunction edge_;
  Extent extent_;
};

// The least float32 not below a double; -0 becomes +0, and beyond range it is +infinity.
inline float rounded_up(double value) {
  const float nearest = static_cast<float>(value);
  return (nearest < value ? std::nextafter(nearest, HUGE_VALF) : nearest) + 0.0f;
}

// The same of the quotient of two float32; w > 0. The product below is exact.
inline float rounded_up_quotient(float z, float w) {
  const float nearest = static_cast<float>(static_cast<double>(z) / w);
  const bool below = std::isinf(nearest) ? nearest < 0 : static_cast<double>(nearest) * w < z;
  return (below ? std::nextafter(nearest, HUGE_VALF) : nearest) + 0.0f;
}

// A triangle, D != 0, and the squares that it meets. Slow: it is asked where double arithmetic could not tell.
class ExactOccluder {
 public:
  // `sign` is 1, or -1 for GREATER.
  ExactOccluder(const Vertex& v0, const Vertex& v1, const Vertex& v2, float sign);

  // Does T meet the closed square (M4)?
  bool meets(int x, int y) const;

  // The largest key of the plane on the square, cut where all W > 0 to that of the vertices, as float32, rounded up.
  float farthest(int x, int y);

  // Do all depths of the range lie in [0, 1]? (O4, depth clipping)
  bool within_unit_range(int x, int y);

 private:
  // Does the range have a depth on that side of the bound?
  bool passes(int x, int y, double bound, int side);

  // The key at p, rounded up.
  float key(SamplePosition p);

  Triangle triangle_;
  float sign_;
  bool in_front_, some_in_front_;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_EXACT_OCCLUDER_HPP
