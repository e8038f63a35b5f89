// SPDX-License-Identifier: Apache-2.0
//
// The second oracle's geometry: exact rationals, convex clipping in homogeneous coordinates, and the winding number of
// a closed polygon around a perturbed sample (C3) by the crossings of a line of samples.
#ifndef SUREFILL_ORACLE_CLIPPED_POLYGON_HPP
#define SUREFILL_ORACLE_CLIPPED_POLYGON_HPP

#include <gmpxx.h>

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::oracle::clipped {

using Rational = mpq_class;

// The value of a finite float; its bits alone are looked at, so no floating-point mode can touch it.
Rational exact(float value);

// I4: the nearest finite float, ties to even, beyond range the largest; zero is +0. Found by comparing the rational
// with neighbouring floats.
float nearest_float(const Rational& value);

Rational floor(const Rational& value);
Rational ceil(const Rational& value);

// A vector of the space (X, Y, W), seen from the eye at its origin.
struct Vector {
  Rational x, y, w;
};
Vector operator-(const Vector& a, const Vector& b);
Vector cross(const Vector& a, const Vector& b);
Rational dot(const Vector& a, const Vector& b);

// A corner of a polygon in homogeneous coordinates. It stands for the ray from the eye through it: a positive multiple
// is the same corner.
struct Corner {
  Rational x, y, z, w;
};

struct Point {
  Rational x, y;
};

// The part of a convex polygon with x0 W <= X <= x1 W and y0 W <= Y <= y1 W, closed: it may be a segment or a point
// (with repeated corners), and is empty only if they do not meet. x0 < x1 and y0 < y1. If the polygon does not contain
// the eye, every corner of the result has W > 0: adding up gives (x1 - x0) W >= 0, and W = 0 leaves X = Y = 0.
std::vector<Corner> clip_to_box(std::vector<Corner> polygon, const Rational& x0, const Rational& x1, const Rational& y0,
                                const Rational& y1);

// Does the closed triangle, degenerate ones included, contain the eye?
bool contains_eye(const std::array<Vector, 3>& m);

// Smallest and largest x of the part of a closed convex polygon with y0 <= y <= y1; nothing where that part is empty.
// y0 == y1 asks for the chord.
std::optional<std::pair<Rational, Rational>> x_extent(std::span<const Point> polygon, const Rational& y0,
                                                      const Rational& y1);

// Section 6: the grid position nearest to `position`; `offset` is in units of 2^-(bits + 4).
Rational snap(const Rational& position, int bits, int offset, GridRounding rounding);

// C3: the signs of the two shifts, and which dominates. C5's rules shift nothing and have none: they get that of
// top_left.
struct Shift {
  int x, y;
  bool x_dominates;
};
Shift shift_of(FillRule rule);

// Where the winding number changes on a line of pixels: by `step` from pixel `first` on.
struct Crossing {
  int first, step;
};

// A closed polygon as the lines of samples cross it. Lines run along x where the shift in x dominates, else along y.
// Let the perturbed sample be (p + s e, l + s' e^2), `along` first. At height l + s' e^2 there is no corner: an edge
// from height g to height h crosses it iff g <= l < h or h <= l < g (for s' > 0; with the equality at the other end for
// s' < 0), level edges never. The crossing's position differs from that at height l by a multiple of e^2, so that it
// decides against p + s e as the position c at height l does against p, and where c = p the sign of s does.
class Outline {
 public:
  Outline() = default;
  Outline(std::span<const Point> corners, const Shift& shift);

  // Pixel lines [begin, end) outside which nothing is crossed; within [0, lines).
  std::pair<int, int> lines(int count) const;

  // Crossings of the samples (pixel + along/16, line + across/16), where `along` and `across` are in 0..15. `first` is
  // clamped to [0, length].
  std::vector<Crossing> crossings(int line, int across, int along, int length) const;

 private:
  struct Place {
    Rational along, across;
  };
  std::vector<Place> corners_;
  int along_shift_ = 1, across_shift_ = 1;
  int sign_ = 1;  // of the winding number: the transposed polygon turns the other way
};

// C5: the crossings of a convex polygon's chord on a line of samples along x, its ends included (closed) or not (open);
// the winding number between them is `orientation`, that of the polygon, which has an area. Arguments and clamping as
// in Outline::crossings.
std::vector<Crossing> chord_crossings(std::span<const Point> polygon, bool closed, int orientation, int line,
                                      int across, int along, int length);

// The winding number at a pixel: positive as D is (clockwise on the screen).
int winding(std::span<const Crossing> crossings, int pixel);

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_CLIPPED_POLYGON_HPP
