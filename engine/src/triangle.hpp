// SPDX-License-Identifier: Apache-2.0
//
// One triangle set up for exact evaluation at samples: coverage (C2, C3), depth (I1, I5), attributes (I2, I3), each by
// a filter in double and, where that cannot tell, by expansions.
#ifndef SUREFILL_SRC_TRIANGLE_HPP
#define SUREFILL_SRC_TRIANGLE_HPP

#include <cmath>
#include <limits>

#include "edge.hpp"
#include "exact.hpp"

namespace surefill {

// A double and a bound of its distance from the real number it stands for.
struct Approximation {
  double value, error;
};

// w0 e0 + w1 e1 + w2 e2 for exact weights. Three products and two sums: below 3 units of 2^-53 of the sum of absolute
// terms; the bound has 8, which covers the rounding of the bound itself.
inline Approximation weighted_sum(const double (&w)[3], const Approximation (&e)[3]) {
  const double t0 = w[0] * e[0].value, t1 = w[1] * e[1].value, t2 = w[2] * e[2].value;
  const double magnitude = (std::fabs(t0) + std::fabs(t1)) + std::fabs(t2);
  const double inherited = (std::fabs(w[0]) * e[0].error + std::fabs(w[1]) * e[1].error) + std::fabs(w[2]) * e[2].error;
  return {(t0 + t1) + t2, inherited + 0x1p-50 * magnitude};
}

// n / m. For real N, M: N/M - n/m = ((N - n) - (n/m)(M - m)) / M. Infinite error where M may be 0. The factor covers
// the rounding of the bound.
inline Approximation quotient(Approximation n, Approximation m) {
  const double smallest = std::fabs(m.value) - m.error;
  if (!(smallest > 0)) return {0, std::numeric_limits<double>::infinity()};
  const double q = n.value / m.value;
  return {q, ((n.error + std::fabs(q) * m.error) / smallest + std::fabs(q) * 0x1p-52) * (1 + 0x1p-20)};
}

class Triangle {
 public:
  // False if D = 0 (C1). Vertices are finite (B1).
  bool set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, Statistics& statistics) {
    vertex_[0] = v0, vertex_[1] = v1, vertex_[2] = v2;
    for (int i = 0; i < 3; ++i) edge_[i] = EdgeFunction(vertex_[(i + 1) % 3], vertex_[(i + 2) % 3]);
    determinant_sign_ = determinant_sign(edge_[0], v0, statistics);
    determinant_known_ = false;
    return determinant_sign_ != 0;
  }

  // The sign of D (F1).
  int determinant() const { return determinant_sign_; }

  // C2 and C3.
  bool covers(SamplePosition p, TieShift shift, Statistics& statistics) const {
    for (const EdgeFunction& edge : edge_) {
      int sign = edge.sign(p, statistics);
      if (sign == 0) sign = tie_sign(edge, shift);
      if (sign != determinant_sign_) return false;
    }
    return true;
  }

  // Depth at p as I4 stores it; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, DepthMode mode, float* stored, Statistics& statistics) {
    const double z[3] = {vertex_[0].z, vertex_[1].z, vertex_[2].z};
    Approximation e[3];
    evaluate_edges(p, e);
    know_determinant();
    const Approximation d{determinant_estimate_, std::fabs(determinant_estimate_) * 0x1p-50};
    const Approximation q = quotient(weighted_sum(z, e), d);
    if (mode == DepthMode::clip) {
      const double low = q.value - q.error, high = q.value + q.error;
      if (high < 0 || low > 1) {
        ++statistics.values_by_filter;
        return false;
      }
      if (!(low > 0 && high < 1) && !inside_unit_range(exact_weighted_sum(z, p), statistics)) return false;
    }
    *stored = rounded(
        q, [&] { return round_quotient(exact_weighted_sum(z, p), determinant_); }, statistics);
    if (mode == DepthMode::clamp) *stored = *stored < 0 ? 0.0f : *stored > 1 ? 1.0f : *stored;  // rounding is monotonic
    return true;
  }

  // Is the sum of the E_i of D's sign at p? (M1: then p is seen in the triangle's plane in front of the eye.)
  bool plane_in_front(SamplePosition p) const {
    Approximation e[3];
    evaluate_edges(p, e);
    const Approximation sum = weighted_sum({1, 1, 1}, e);
    if (std::fabs(sum.value) > sum.error) return sign_of(sum.value) == determinant_sign_;
    return exact_weighted_sum({1, 1, 1}, p).sign() == determinant_sign_;
  }

  // An attribute at p as I4 stores it, from its values at the three vertices. For perspective, the sum of the E_i is
  // not 0 at p: it is not at a covered sample, nor where plane_in_front().
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Statistics& statistics) {
    if (interpolation == Interpolation::flat) return u[0] + 0.0f;
    Approximation e[3];
    evaluate_edges(p, e);
    if (interpolation == Interpolation::perspective) {
      const double w[3] = {u[0], u[1], u[2]};
      const Approximation q = quotient(weighted_sum(w, e), weighted_sum({1, 1, 1}, e));
      const auto exact = [&] { return round_quotient(exact_weighted_sum(w, p), exact_weighted_sum({1, 1, 1}, p)); };
      return rounded(q, exact, statistics);
    }
    know_determinant();
    const double w[3] = {static_cast<double>(u[0]) * vertex_[0].w, static_cast<double>(u[1]) * vertex_[1].w,
                         static_cast<double>(u[2]) * vertex_[2].w};  // 48 bits, exact
    const Approximation d{determinant_estimate_, std::fabs(determinant_estimate_) * 0x1p-50};
    const Approximation q = quotient(weighted_sum(w, e), d);
    return rounded(
        q, [&] { return round_quotient(exact_weighted_sum(w, p), determinant_); }, statistics);
  }

 private:
  void evaluate_edges(SamplePosition p, Approximation (&e)[3]) const {
    for (int i = 0; i < 3; ++i) e[i].value = edge_[i].value(p, &e[i].error);
  }

  Expansion<60> exact_weighted_sum(const double (&w)[3], SamplePosition p) const {
    Expansion<60> sum;
    for (int i = 0; i < 3; ++i) sum.add_scaled(edge_[i].exact_value(p), w[i]);
    return sum;
  }

  // D itself is needed for values only; once per triangle.
  void know_determinant() {
    if (determinant_known_) return;
    determinant_ = exact_determinant(vertex_[0], vertex_[1], vertex_[2]);
    determinant_estimate_ = determinant_.estimate();
    determinant_known_ = true;
  }

  // 0 <= numerator / D <= 1, exactly (I5).
  bool inside_unit_range(const Expansion<60>& numerator, Statistics& statistics) const {
    ++statistics.values_by_expansion;
    if (numerator.sign() * determinant_sign_ < 0) return false;
    Expansion<72> above_one;
    for (int i = 0; i < numerator.size(); ++i) above_one.add(numerator.term(i));
    for (int i = 0; i < determinant_.size(); ++i) above_one.add(-determinant_.term(i));
    return above_one.sign() * determinant_sign_ <= 0;
  }

  // The float32 of I4: by the filter if it can tell, else by `exact`.
  template <typename Exact>
  static float rounded(Approximation q, Exact exact, Statistics& statistics) {
    float result;
    if (round_interval(q.value - q.error, q.value + q.error, &result)) {
      ++statistics.values_by_filter;
      return result;
    }
    ++statistics.values_by_expansion;
    return exact();
  }

  Vertex vertex_[3];
  EdgeFunction edge_[3];  // edge i lies opposite vertex i
  int determinant_sign_ = 0;
  bool determinant_known_ = false;
  double determinant_estimate_ = 0;
  Expansion<12> determinant_;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_TRIANGLE_HPP
