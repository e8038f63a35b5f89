// SPDX-License-Identifier: Apache-2.0
//
// Which samples a triangle covers (section 2 of docs/semantics.md): exact signs of edge functions, and a subdivision of
// the target that is exact too, because edge functions are affine in the screen.
#ifndef SUREFILL_ORACLE_COVERAGE_HPP
#define SUREFILL_ORACLE_COVERAGE_HPP

#include <array>
#include <cstdint>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// A point of space in units of 1/16 pixel: every sample and every corner of a pixel is one (S4, S6, S7).
struct Point {
  std::int32_t x, y;
};
inline constexpr int kUnits = 16;

// Half-open rectangle of pixels of space (S6).
struct Rect {
  int x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  // Corner n = 0..3 of the closed rectangle.
  Point corner(int n) const { return {(n % 2 == 0 ? x0 : x1) * kUnits, (n / 2 == 0 ? y0 : y1) * kUnits}; }
};

Rect intersect(const Rect& a, const Rect& b);

// The pixels of a target in space.
Rect pixels_of(const Target& target);

// Sample n of pixel (x, y), for the standard pattern of `samples` a pixel (S4).
Point sample_point(int samples, int n, int x, int y);

// The pixel centre.
Point centre(int x, int y);

// C3: the infinitely small step of a fill rule. C5's two take no step, and have that of top_left here.
struct Step {
  int x, y;
  bool x_first;
};
Step step_of(FillRule rule);

// Where a frame has its samples in each pixel: its own places (S7), or the standard ones.
class Pattern {
 public:
  explicit Pattern(const Target& target);

  int samples() const { return samples_; }
  // Sample n of the pixel (x, y) of space.
  Point at(int n, int x, int y) const {
    const Point& place = places_[static_cast<std::size_t>(n)];
    return {x * kUnits + place.x, y * kUnits + place.y};
  }

 private:
  int samples_;
  std::array<Point, 16> places_{};
};

// (X, Y, W): a position as S2 has it, without depth. As double, so that snapped positions (at most 40 bits) fit too.
struct Position {
  double x, y, w;
};

// Sign of det(m0, m1, m2), exactly.
int sign_of_determinant(const Position& m0, const Position& m1, const Position& m2);

// Three positions and a fill rule. Where D != 0, all signs below are those of E_i / D.
class Cone {
 public:
  Cone(const std::array<Position, 3>& positions, FillRule rule);

  const std::array<Position, 3>& positions() const { return m_; }
  int sign_of_det() const { return det_; }  // of D
  int sign(int edge, Point p) const;        // of E_edge / D at p: -1, 0, 1
  // Where E_edge is not 0 at p its sign; else what the fill rule makes of it: the sign at p moved by C3's step, or
  // C5's +1 (closed), -1 (open). 0 only if D = 0 or E_edge vanishes everywhere.
  int owning_sign(int edge, Point p) const;
  bool covers(Point p) const;  // C1, C2, C3, C5

  // The pixels of `target` outside of which nothing is covered, nor met by M4; they may be more than need be.
  Rect bounds(const Rect& target) const;

 private:
  std::array<Position, 3> m_;
  std::array<int, 3> tie_;  // what counts as the sign of E_i / D where it is 0
  int det_;
};

// The edges, as a set of bits, that a rectangle still has to be tested against.
inline constexpr unsigned kAllEdges = 7;

// Calls visit(x, y, n) for the samples in `rect` that the cone covers. `undecided` are the edges not known to be
// positive on all of rect. The corners of a rectangle decide for all of it, as E_i is affine.
template <typename Visit>
void visit_covered(const Cone& cone, const Rect& rect, const Pattern& pattern, unsigned undecided, const Visit& visit);

// --- templates

// What the corners of a closed rectangle say. outside: one E_i / D is negative on all of it; else `undecided` loses the
// edges whose E_i / D is positive on all of it.
inline bool outside(const Cone& cone, const Rect& rect, unsigned& undecided) {
  for (int edge = 0; edge < 3; ++edge) {
    if ((undecided >> edge & 1u) == 0) continue;
    int positive = 0, negative = 0;
    for (int n = 0; n < 4 && (positive == n || negative == n); ++n) {
      const int sign = cone.sign(edge, rect.corner(n));
      if (sign > 0) ++positive;
      if (sign < 0) ++negative;
    }
    if (negative == 4) return true;
    if (positive == 4) undecided &= ~(1u << edge);
  }
  return false;
}

// The quarters of a rectangle; a side of one pixel is not divided, and leaves some of them empty.
inline std::array<Rect, 4> quarters(const Rect& r) {
  const int x = r.x0 + (r.x1 - r.x0 + 1) / 2, y = r.y0 + (r.y1 - r.y0 + 1) / 2;
  return {Rect{r.x0, r.y0, x, y}, Rect{x, r.y0, r.x1, y}, Rect{r.x0, y, x, r.y1}, Rect{x, y, r.x1, r.y1}};
}

template <typename Visit>
void visit_covered(const Cone& cone, const Rect& rect, const Pattern& pattern, unsigned undecided, const Visit& visit) {
  constexpr int kLeafPixels = 16;  // small enough that its samples are tested one by one
  if (rect.empty() || cone.sign_of_det() == 0) return;
  if (outside(cone, rect, undecided)) return;
  if (undecided != 0 && (rect.x1 - rect.x0) * (rect.y1 - rect.y0) > kLeafPixels) {
    for (const Rect& quarter : quarters(rect)) visit_covered(cone, quarter, pattern, undecided, visit);
    return;
  }
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      for (int n = 0; n < pattern.samples(); ++n) {
        bool covered = true;
        for (int edge = 0; covered && edge < 3; ++edge) {
          covered = (undecided >> edge & 1u) == 0 || cone.owning_sign(edge, pattern.at(n, x, y)) > 0;
        }
        if (covered) visit(x, y, n);
      }
    }
  }
}

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_COVERAGE_HPP
