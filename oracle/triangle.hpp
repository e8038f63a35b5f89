// SPDX-License-Identifier: Apache-2.0
//
// One primitive of a draw, triangle, line or point: what it is, which samples it covers, and what is stored of it where it
// is seen.
#ifndef SUREFILL_ORACLE_TRIANGLE_HPP
#define SUREFILL_ORACLE_TRIANGLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "oracle/coverage.hpp"
#include "oracle/grid.hpp"
#include "oracle/lines.hpp"
#include "oracle/values.hpp"

namespace surefill::oracle {

// How many primitives a draw has.
std::size_t primitives_of(const Draw& draw);

// V2: the index of primitive t.
std::uint32_t index_of(const Draw& draw, std::size_t t);

// Floats from one sample of an attribute image to the next.
std::size_t attribute_step(const AttributeTarget& image);

// B1: every position and every attribute of the primitive is finite.
bool is_finite(const Draw& draw, std::size_t t);

// F1: is a triangle, or with a grid a sample of it, of this sign of D or N front-facing? 0 is not (M4b).
bool is_front(const Draw& draw, int sign);
// F2: does culling leave it out?
bool is_culled(const Draw& draw, int sign);

// The set of samples that a primitive covers, before culling.
class Shape {
 public:
  Shape(const Origin& origin, const Draw& draw, std::size_t t);

  bool covers(Point p) const;
  // The pixels of `target` outside of which nothing is covered; they may be more than need be.
  Rect bounds(const Rect& target) const;
  const std::optional<Cone>& cone() const { return cone_; }
  const std::optional<SnappedPolygon>& snapped() const { return snapped_; }
  const std::vector<IntegerVertex>* clipped() const { return snapped_ ? &clipped_ : nullptr; }
  // Of lines and points, if they may cover anything.
  const std::optional<Line>& line() const { return line_; }
  const std::optional<Square>& square() const { return square_; }

 private:
  std::optional<Cone> cone_;  // without a grid
  std::vector<IntegerVertex> clipped_;
  std::optional<SnappedPolygon> snapped_;  // with a grid
  std::optional<Line> line_;
  std::optional<Square> square_;
};

// The depth of primitive t, of this shape, which outlives it (I1, I6, I7, I8, G2). Precondition: a line or a point has one.
Depth depth_of(const Draw& draw, std::size_t t, const Shape& shape);

// What is stored of a visible primitive beside index and depth. The target and the draw outlive it.
class Visible {
 public:
  Visible(const Target& target, const Draw& draw, std::size_t t);

  // Stores barycentrics and attributes of the pixel (x, y) of space at `sample`, its place in the buffers.
  void store(int x, int y, std::size_t sample);

 private:
  void find_weights(int x, int y);
  void find_line_weights(int x, int y);

  const Target& target_;
  Pattern pattern_;
  bool grid_;
  Shape shape_;
  Edges edges_;
  std::vector<Component> components_;
  Weights weights_;
};

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_TRIANGLE_HPP
