// SPDX-License-Identifier: Apache-2.0
//
// Edge functions of a homogeneous triangle (semantics.md, section 2; Olano and Greer 1997) and the ladder that finds
// their exact signs: double with an error bound, double proved exact by its residuals, expansions.
#ifndef SUREFILL_SRC_EDGE_HPP
#define SUREFILL_SRC_EDGE_HPP

#include <cmath>

#include "../facts.hpp"
#include "exact.hpp"
#include "surefill/diagnostics.hpp"

namespace surefill {

// Counts a decision, where somebody asks.
inline void count(Rungs* rungs, std::uint64_t Rungs::*rung) {
  if (rungs != nullptr) ++(rungs->*rung);
}

// Relative to the sum of absolute terms, the rounding error of a x + b y + c is below 8 units of 2^-53: one for a
// coefficient (its products are exact), one for the product, two for the sums, and as much again for the sum of
// absolute terms itself.
constexpr double kEdgeErrorBound = 0x1p-50;

constexpr int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// r = p - q without rounding error, for r computed as p - q?
inline bool difference_is_exact(double p, double q) {
  return two_sum(p, -q).error == 0;
}

// E(p) = a x + b y + c for the edge from vertex j to vertex k. Each coefficient is a difference of two exact products,
// rounded once: its sign, and whether it is 0, are exact.
struct EdgeFunction {
  double a, b, c;
  bool exact;  // all three coefficients without rounding error
  Vertex from, to;

  EdgeFunction() = default;
  EdgeFunction(const Vertex& j, const Vertex& k) : from(j), to(k) {
    const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
    a = jy * kw - jw * ky;
    b = jw * kx - jx * kw;
    c = jx * ky - jy * kx;
    exact = difference_is_exact(jy * kw, jw * ky) && difference_is_exact(jw * kx, jx * kw) &&
            difference_is_exact(jx * ky, jy * kx);
  }

  // E at p in double, and a bound of its absolute error.
  double value(SamplePosition p, double* error_bound) const {
    *error_bound = kEdgeErrorBound * ((std::fabs(a * p.x) + std::fabs(b * p.y)) + std::fabs(c));
    return (a * p.x + b * p.y) + c;
  }

  // E at p, exactly. Four products of 48 bits times 27 bits, and two of 48 bits.
  Expansion<10> exact_value(SamplePosition p) const {
    const double jx = from.x, jy = from.y, jw = from.w, kx = to.x, ky = to.y, kw = to.w;
    Expansion<10> sum;
    sum.add_product(jy * kw, p.x);
    sum.add_product(-(jw * ky), p.x);
    sum.add_product(jw * kx, p.y);
    sum.add_product(-(jx * kw), p.y);
    sum.add(jx * ky);
    sum.add(-(jy * kx));
    return sum;
  }

  // The sign of E at p, 0 for a real tie.
  int sign(SamplePosition p, Rungs* rungs = nullptr) const {
    double bound;
    const double estimate = value(p, &bound);
    if (std::fabs(estimate) > bound) {
      count(rungs, &Rungs::signs_by_filter);
      return sign_of(estimate);
    }
    if (exact) {
      const DoublePair ax = two_product(a, p.x), by = two_product(b, p.y);
      const DoublePair ab = two_sum(ax.value, by.value), abc = two_sum(ab.value, c);
      if (ax.error == 0 && by.error == 0 && ab.error == 0 && abc.error == 0) {
        count(rungs, &Rungs::signs_by_residual);
        return sign_of(abc.value);
      }
    }
    count(rungs, &Rungs::signs_by_expansion);
    return exact_value(p).sign();
  }
};

// What a fill rule does with a sample on an edge: where it moves it (C3), or which side has all of them (C5).
struct TieShift {
  int x, y;  // +1 or -1
  bool y_dominates;
  int all = 0;  // +1: every sample on an edge is covered; -1: none is; 0: the sample moves
};

// Is it one of C3's rules, and not of C5's?
inline bool moves_samples(FillRule rule) {
  return rule <= FillRule::northwards_west;
}

inline TieShift tie_shift(FillRule rule) {
  switch (rule) {
    case FillRule::top_left:
      return {+1, +1, false};
    case FillRule::top_right:
      return {-1, +1, false};
    case FillRule::bottom_left:
      return {+1, -1, false};
    case FillRule::bottom_right:
      return {-1, -1, false};
    case FillRule::southwards:
      return {+1, +1, true};
    case FillRule::southwards_west:
      return {-1, +1, true};
    case FillRule::northwards:
      return {+1, -1, true};
    case FillRule::northwards_west:
      return {-1, -1, true};
    case FillRule::closed:
      return {+1, +1, false, +1};
    case FillRule::open:
      return {+1, +1, false, -1};
  }
  return {+1, +1, false};
}

// The sign that an edge function takes where it is 0 (C3). a and b are not both 0 there.
inline int tie_sign(double a, double b, TieShift shift) {
  const int along_x = sign_of(a) * shift.x, along_y = sign_of(b) * shift.y;
  if (shift.y_dominates) return along_y != 0 ? along_y : along_x;
  return along_x != 0 ? along_x : along_y;
}

// The same for a triangle whose D has the sign `determinant`, under any rule (C3, C5).
inline int tie_sign(const EdgeFunction& edge, TieShift shift, int determinant) {
  return shift.all != 0 ? shift.all * determinant : tie_sign(edge.a, edge.b, shift);
}

// det(m0, m1, m2), exactly.
inline Expansion<12> exact_determinant(const Vertex& v0, const Vertex& v1, const Vertex& v2) {
  Expansion<12> sum;
  const auto add = [&sum](double x, double y, double z) { sum.add_product(x * y, z); };
  add(v1.y, v2.w, v0.x), add(-v1.w, v2.y, v0.x);
  add(v1.w, v2.x, v0.y), add(-v1.x, v2.w, v0.y);
  add(v1.x, v2.y, v0.w), add(-v1.y, v2.x, v0.w);
  return sum;
}

// The sign of D = det(m0, m1, m2). `edge0` is the edge from v1 to v2: D is its value at m0, with the same error bound.
inline int determinant_sign(const EdgeFunction& edge0, const Vertex& v0, Rungs* rungs = nullptr) {
  const double ax = edge0.a * v0.x, by = edge0.b * v0.y, cw = edge0.c * v0.w;
  const double estimate = (ax + by) + cw;
  if (std::fabs(estimate) > kEdgeErrorBound * ((std::fabs(ax) + std::fabs(by)) + std::fabs(cw))) {
    count(rungs, &Rungs::signs_by_filter);
    return sign_of(estimate);
  }
  count(rungs, &Rungs::signs_by_expansion);
  return exact_determinant(v0, edge0.from, edge0.to).sign();
}

}  // namespace surefill

#endif  // SUREFILL_SRC_EDGE_HPP
