// SPDX-License-Identifier: Apache-2.0
//
// Points and lines of the first oracle (M7, I6, I7 of docs/semantics.md): signs of affine functions of the perturbed
// sample, in integers.
#ifndef SUREFILL_ORACLE_LINES_HPP
#define SUREFILL_ORACLE_LINES_HPP

#include <array>
#include <optional>

#include "oracle/coverage.hpp"
#include "oracle/grid.hpp"

namespace surefill::oracle {

// An affine function of places in units of 1/16 pixel, with integers.
struct Affine {
  Integer a, b, c;  // a x + b y + c
  Integer at(Point p) const { return a * p.x + b * p.y + c; }
  // Its sign at p as C3 moves it. 0 only for the constant 0.
  int sign(Point p, const Step& step) const;
};

// A point of M7: the samples of an open square. Positions are multiples of the vertex, W > 0.
class Square {
 public:
  Square(const IntegerVertex& vertex, float side, FillRule rule);

  bool covers(Point p) const;
  // Is none of the samples in these pixels covered? May be false where none is.
  bool misses(const Rect& rect) const;
  const IntegerVertex& vertex() const { return vertex_; }

 private:
  IntegerVertex vertex_;
  Step step_;
  std::array<Affine, 4> sides_;  // all are positive inside
};

// A line of M7 that is no single point and not empty. It lies on L = 0, L = det(m_0, m_1, p) = a x + b y + c, and S has
// the direction (b, -a): X_1 W_0 - X_0 W_1 = b, and the same in y is -a; if a W is not positive, the ray of S runs to
// where the other one pulls, which is this direction times a positive number.
class Line {
 public:
  // Nothing if S is one point or empty. No width: thin.
  static std::optional<Line> make(const IntegerVertex& m0, const IntegerVertex& m1, std::optional<float> width,
                                  FillRule rule);

  bool covers(Point p) const;
  bool misses(const Rect& rect) const;  // as Square::misses
  // I7: k_0 and k_1 at the q of p, both times one positive number.
  void weights_at(Point p, Integer& w0, Integer& w1) const;
  const IntegerVertex& vertex(std::size_t i) const { return m_[i]; }

 private:
  Line() = default;
  bool starts_before_exit(Point p) const;
  bool ends_past_exit(Point p) const;

  std::array<IntegerVertex, 2> m_;
  Step step_{};
  bool thin_ = false;
  std::array<Affine, 2> sides_;  // of the strip |L| < max(|a|, |b|) w / 2, w = 1 if thin: both are positive inside
  // How far p is past vertex i in the direction of S along the major axis, times 16 W_i.
  std::array<Affine, 2> past_;
  // The same, and how far it is on either side along the other axis.
  std::array<std::array<Affine, 2>, 2> past_and_beside_;
};

// Calls visit(x, y, n) for the samples in `rect` that a square or a line covers.
template <typename Shape, typename Visit>
void visit_covered(const Shape& shape, const Rect& rect, const Pattern& pattern, const Visit& visit) {
  constexpr int kLeafPixels = 16;
  if (rect.empty() || shape.misses(rect)) return;
  if ((rect.x1 - rect.x0) * (rect.y1 - rect.y0) > kLeafPixels) {
    for (const Rect& quarter : quarters(rect)) visit_covered(shape, quarter, pattern, visit);
    return;
  }
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      for (int n = 0; n < pattern.samples(); ++n) {
        if (shape.covers(pattern.at(n, x, y))) visit(x, y, n);
      }
    }
  }
}

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_LINES_HPP
