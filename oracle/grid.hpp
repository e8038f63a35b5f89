// SPDX-License-Identifier: Apache-2.0
//
// The fixed-point grid (section 6 of docs/semantics.md): exact clipping to the guard band, exact snapping, and the
// winding number of the snapped polygon as the sum of the signed covers of a fan of its first corner.
#ifndef SUREFILL_ORACLE_GRID_HPP
#define SUREFILL_ORACLE_GRID_HPP

#include <array>
#include <vector>

#include "oracle/coverage.hpp"
#include "oracle/exact.hpp"

namespace surefill::oracle {

// A vertex times a power of two: integers. Positive multiples are the same point for all that is done with it.
struct IntegerVertex {
  Integer x, y, z, w;
};

// The three vertices times one common power of two.
std::array<IntegerVertex, 3> integer_vertices(const std::array<Vertex, 3>& vertices);

// G1: does the hull of the three (X, Y, W) contain the origin?
bool hull_contains_eye(const std::array<IntegerVertex, 3>& vertices);

// G1: what is left of the triangle in the guard band of a target with this origin (S6), in its order; W > 0. Empty for a
// triangle whose hull contains the eye.
std::vector<IntegerVertex> clip_to_guard_band(const std::array<IntegerVertex, 3>& vertices, const Origin& origin);

// A triangle as the grid leaves it.
class SnappedPolygon {
 public:
  SnappedPolygon(const std::vector<IntegerVertex>& clipped, const Grid& grid, FillRule rule);

  const std::vector<Cone>& fan() const { return fan_; }  // empty: nothing is covered
  int winding(Point p) const;                            // N(p)
  Rect bounds(const Rect& target) const;                 // no pixel of it outside has a sample with N != 0

 private:
  std::vector<Cone> fan_;
  Rect bounds_{0, 0, 0, 0};
};

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_GRID_HPP
