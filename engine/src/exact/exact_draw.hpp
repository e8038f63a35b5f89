// SPDX-License-Identifier: Apache-2.0
//
// What the vector code cannot tell, by the scalar arithmetic of Triangle and SnappedTriangle. Compiled once, and not
// for each instruction set; it keeps the triangle that was asked about last.
#ifndef SUREFILL_SRC_EXACT_DRAW_HPP
#define SUREFILL_SRC_EXACT_DRAW_HPP

#include <cstdint>

#include "grid.hpp"
#include "surefill/surefill.hpp"
#include "triangle.hpp"

namespace surefill::fast {

// The sign of D of a triangle (C1).
int orientation(const Draw& draw, std::uint32_t position, Statistics& statistics);

class ExactDraw {
 public:
  // The triangle at a position in the draw. Everything below is about it.
  void use(const Draw& draw, std::uint32_t position);

  bool covers(SamplePosition p, TieShift shift, Statistics& statistics) const;  // C2, C3; G1
  bool counts_square(int x, int y, Statistics& statistics) const;               // M4
  bool depth(SamplePosition p, float* stored, Statistics& statistics);          // I1, I5; G2
  bool has_values(SamplePosition p) const;                                      // M1
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Statistics& statistics);
  SnappedTriangle& snapped() { return snapped_; }  // under Grid only

 private:
  const Draw* draw_ = nullptr;
  std::uint32_t position_ = 0;
  Triangle triangle_;        // without Grid
  SnappedTriangle snapped_;  // and with Grid
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_EXACT_DRAW_HPP
