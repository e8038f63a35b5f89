// SPDX-License-Identifier: Apache-2.0
#include "occluder.hpp"

#include "conservative.hpp"

namespace surefill {
namespace {

SamplePosition corner_of(int x, int y, int corner) {
  return {x + static_cast<double>(corner & 1), y + static_cast<double>(corner >> 1)};
}

}  // namespace

SeenEdge::SeenEdge(const Vertex& from, const Vertex& to) : edge_(from, to) {
  const auto place = [this](const Vertex& v) {
    extent_.add(static_cast<double>(v.x) / v.w, static_cast<double>(v.y) / v.w);
  };
  if (from.w > 0) place(from);
  if (to.w > 0) place(to);
  if (from.w > 0 && to.w > 0) return;
  if (!(from.w > 0 || to.w > 0)) return;  // nothing is seen
  // From the end in front of the eye S runs along (b, -a), or against it if that is `to`; the signs are exact.
  const double sign = from.w > 0 ? 1 : -1;
  const auto extend = [](double direction, double* low, double* high) {
    if (direction < 0) *low = -HUGE_VAL;
    if (direction > 0) *high = HUGE_VAL;
  };
  extend(sign * edge_.b, &extent_.x0, &extent_.x1);
  extend(-sign * edge_.a, &extent_.y0, &extent_.y1);
}

// Two convex polygons, of which one may be a segment or a ray, are apart only if a line along a side of one of them is
// between them.
bool SeenEdge::meets(int x, int y) const {
  if (!extent_.meets(x, y)) return false;
  int least = 1, largest = -1;
  for (int corner = 0; corner < 4; ++corner) {
    const int sign = edge_.sign(corner_of(x, y, corner));
    least = std::min(least, sign), largest = std::max(largest, sign);
  }
  return least <= 0 && largest >= 0;
}

ExactOccluder::ExactOccluder(const Vertex& v0, const Vertex& v1, const Vertex& v2, float sign) : sign_(sign) {
  triangle_.set_up(v0, v1, v2);
  in_front_ = v0.w > 0 && v1.w > 0 && v2.w > 0;
  some_in_front_ = v0.w > 0 || v1.w > 0 || v2.w > 0;
}

bool ExactOccluder::meets(int x, int y) const {
  return some_in_front_ && PixelSquare(triangle_, x, y).touched();
}

float ExactOccluder::farthest(int x, int y) {
  float farthest = -HUGE_VALF;
  for (int corner = 0; corner < 4; ++corner) farthest = std::max(farthest, key(corner_of(x, y, corner)));
  if (!in_front_) return farthest;
  float most = -HUGE_VALF;
  for (int i = 0; i < 3; ++i) {
    const Vertex& v = triangle_.vertex(i);
    most = std::max(most, rounded_up_quotient(sign_ * v.z, v.w));
  }
  return std::min(farthest, most);
}

bool ExactOccluder::within_unit_range(int x, int y) {
  return !passes(x, y, 0, -1) && !passes(x, y, 1, 1);
}

// The range is the hull of depths at the corners, cut to that of the vertices: both have to have one.
bool ExactOccluder::passes(int x, int y, double bound, int side) {
  bool corner_does = false, vertex_does = !in_front_;
  for (int corner = 0; corner < 4; ++corner) {
    corner_does = corner_does || triangle_.compare_depth(corner_of(x, y, corner), bound) == side;
  }
  for (int i = 0; i < 3; ++i) {
    const Vertex& v = triangle_.vertex(i);
    const double limit = bound * static_cast<double>(v.w), z = v.z;
    vertex_does = vertex_does || (side > 0 ? z > limit : z < limit);
  }
  return corner_does && vertex_does;
}

float ExactOccluder::key(SamplePosition p) {
  const Approximation q = triangle_.approximate_depth(p);
  const float low = rounded_up(sign_ * q.value - q.error), high = rounded_up(sign_ * q.value + q.error);
  if (low == high) return low;
  Expansion<60> numerator = triangle_.exact_depth_numerator(p);
  if (sign_ < 0) numerator.negate();
  return round_up_quotient(numerator, triangle_.exact_determinant_value());
}

}  // namespace surefill
