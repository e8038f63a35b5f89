// SPDX-License-Identifier: Apache-2.0
//
// A primitive of a draw, as its mode has it: what it covers, and the values there, by the scalar arithmetic of Triangle,
// SnappedTriangle, Line and Point. All that the reference path draws with, and what the vector code asks where it cannot tell.
// Compiled once, and not for each instruction set; it keeps the one that was asked about last.
#ifndef SUREFILL_SRC_EXACT_DRAW_HPP
#define SUREFILL_SRC_EXACT_DRAW_HPP

#include <cstdint>

#include "../facts.hpp"
#include "grid.hpp"
#include "line.hpp"
#include "point.hpp"
#include "triangle.hpp"

namespace surefill {

// The sign of D of a triangle (C1).
int orientation(const Draw& draw, std::uint32_t position, Rungs* rungs = nullptr);

// Does the triangle, whose D is 0, cover nothing? Under Grid it does not always (G1), and where it is asked for the
// pixels that it touches (M4b).
bool is_degenerate(const Draw& draw, std::uint32_t position);

class ExactDraw {
 public:
  // Pixels and places are those of space; the origin is the target's (S6), which Grid alone looks at.
  explicit ExactDraw(Origin origin = {}) : origin_(origin) {}

  // The primitive at a position in the draw, whose vertices are finite (B1). False if it covers nothing: a triangle by C1
  // (but for M4b) or, under Grid, by G1, a line or a point by M7. Everything below is about it.
  bool use(const Draw& draw, std::uint32_t position, Rungs* rungs = nullptr);

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(const PixelBox& limits, double least_offset, double largest_offset) const;

  // Coverage as attributes have it, without culling: C2, C3, C5; under Grid G1, N != 0.
  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const { return facing(p, shift, rungs) != 0; }
  // Coverage as M2 counts it, but for scissor and depth clip: covered, and not culled (F2).
  bool draws(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    const int side = facing(p, shift, rungs);
    return side != 0 && !(has_triangles(*draw_) && culls(*draw_, side));
  }
  bool draws_square(int x, int y, Rungs* rungs = nullptr) const;  // M4, M4a, M4b
  // Is it a triangle that is culled whole (F2)? Under Grid that is a matter of the sample (G1).
  bool is_culled() const { return has_triangles(*draw_) && !draw_->grid && culls(*draw_, triangle_.determinant()); }
  // Does the triangle face front there, where it draws (F1; under Grid G1)?
  bool is_front(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    return faces_front(*draw_, facing(p, shift, rungs));
  }

  // Depth as it is stored; false if depth clipping removes the fragment: I1, I5; under Grid G2.
  bool depth(SamplePosition p, float* stored, Rungs* rungs = nullptr);
  // Is there a value at p, covered or not (M1)?
  bool has_values(SamplePosition p) const;
  // Where the attributes of pixel (x, y) are taken, in which the triangle is seen (M1).
  SamplePosition place_of_attributes(const Target& target, int x, int y, TieShift shift) const;
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr);

  const Line& line() const { return line_; }              // of a draw of lines
  const Triangle& triangle() const { return triangle_; }  // without Grid only
  SnappedTriangle& snapped() { return snapped_; }         // under Grid only

 private:
  // 0 if it does not cover p; else the sign of D or, under Grid, of N(p); of a line or a point 1.
  int facing(SamplePosition p, TieShift shift, Rungs* rungs) const {
    if (!has_triangles(*draw_)) return is_line() ? line_.covers(p, shift, rungs) : point_.covers(p, shift);
    if (draw_->grid) return snapped_.winding(p, shift);
    return triangle_.covers(p, shift, rungs) ? triangle_.determinant() : 0;
  }

  bool is_line() const { return draw_->primitive == Primitive::lines; }

  Origin origin_;
  const Draw* draw_ = nullptr;
  std::uint32_t position_ = 0;
  bool covers_something_ = false;
  Triangle triangle_;        // without Grid
  SnappedTriangle snapped_;  // and with Grid
  Line line_;
  Point point_;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_EXACT_DRAW_HPP
