// SPDX-License-Identifier: Apache-2.0
//
// One triangle set up for exact evaluation at samples: coverage (C2, C3), depth (I1, I5), attributes (I2, I3), each by
// a filter in double and, where that cannot tell, by expansions.
#ifndef SUREFILL_SRC_TRIANGLE_HPP
#define SUREFILL_SRC_TRIANGLE_HPP

#include <algorithm>
#include <cmath>
#include <limits>

#include "approximation.hpp"
#include "edge.hpp"
#include "exact.hpp"

namespace surefill {

// w0 e0 + w1 e1 + w2 e2 for exact weights. Three products and two sums: below 3 units of 2^-53 of the sum of absolute
// terms; the bound has 8, which covers the rounding of the bound itself.
inline Approximation weighted_sum(const double (&w)[3], const Approximation (&e)[3]) {
  const double t0 = w[0] * e[0].value, t1 = w[1] * e[1].value, t2 = w[2] * e[2].value;
  const double magnitude = (std::fabs(t0) + std::fabs(t1)) + std::fabs(t2);
  const double inherited = (std::fabs(w[0]) * e[0].error + std::fabs(w[1]) * e[1].error) + std::fabs(w[2]) * e[2].error;
  return {(t0 + t1) + t2, inherited + 0x1p-50 * magnitude};
}

class Triangle {
 public:
  using EdgeSet = unsigned;  // bit i: edge i
  // False if D = 0 (C1). Vertices are finite (B1).
  bool set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, Rungs* rungs = nullptr) {
    vertex_[0] = v0, vertex_[1] = v1, vertex_[2] = v2;
    for (int i = 0; i < 3; ++i) edge_[i] = EdgeFunction(vertex_[(i + 1) % 3], vertex_[(i + 2) % 3]);
    determinant_sign_ = determinant_sign(edge_[0], v0, rungs);
    determinant_known_ = false;
    return determinant_sign_ != 0;
  }

  // The sign of D (F1).
  int determinant() const { return determinant_sign_; }

  const Vertex& vertex(int i) const { return vertex_[i]; }
  const EdgeFunction& edge(int i) const { return edge_[i]; }  // from vertex i + 1 to vertex i + 2, modulo 3

  // C2, C3 and C5.
  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    for (const EdgeFunction& edge : edge_) {
      int sign = edge.sign(p, rungs);
      if (sign == 0) sign = tie_sign(edge, shift, determinant_sign_);
      if (sign != determinant_sign_) return false;
    }
    return true;
  }

  // Depth at p, with the bias of I8, as I4 stores it; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs = nullptr) {
    const DepthMode mode = state.depth_mode;
    const Approximation q = approximate_depth(p);
    if (mode == DepthMode::clip) {
      const double low = q.value - q.error, high = q.value + q.error;
      if (high < 0 || low > 1) {
        count(rungs, &Rungs::values_by_filter);
        return false;
      }
      if (!(low > 0 && high < 1) && !inside_unit_range(exact_depth_numerator(p), rungs)) return false;
    }
    *stored = state.depth_bias ? biased_depth(p, *state.depth_bias, rungs) : rounded_depth(p, q, rungs);
    if (mode == DepthMode::clamp) *stored = *stored < 0 ? 0.0f : *stored > 1 ? 1.0f : *stored;  // rounding is monotonic
    return true;
  }

  // The depth at p (I1), whether or not the triangle covers p, as I4 rounds it. D is not 0.
  float rounded_depth(SamplePosition p, Rungs* rungs = nullptr) {
    return rounded_depth(p, approximate_depth(p), rungs);
  }

  // The same with a bias (I8).
  float biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs = nullptr) {
    const auto exact = [&] {
      Expansion<108> numerator(exact_depth_numerator(p));
      numerator.add_scaled(exact_determinant_value(), bias.constant);
      numerator.add_scaled(exact_slope_numerator(), bias.slope);
      return round_quotient(numerator, exact_determinant_value());
    };
    return rounded(with_bias(approximate_depth(p), bias), exact, rungs);
  }

  // z + c + s m (I8) for an approximation of z. D is not 0. The factor covers the rounding of sums and bounds.
  Approximation with_bias(Approximation z, const DepthBias& bias) {
    const Approximation m = approximate_slope();
    const double c = bias.constant, s = bias.slope, term = s * m.value;
    const double magnitude = (std::fabs(z.value) + std::fabs(c)) + std::fabs(term);
    return {(z.value + c) + term, (z.error + std::fabs(s) * m.error) * (1 + 0x1p-20) + 0x1p-50 * magnitude};
  }

  // I8's m times D, exactly: D is not 0.
  Expansion<12> exact_slope_numerator() const {
    Expansion<12> along_x, along_y;
    for (int i = 0; i < 3; ++i) {
      const double z = vertex_[i].z;
      const Vertex &j = edge_[i].from, &k = edge_[i].to;
      along_x.add_product(static_cast<double>(j.y) * k.w, z);
      along_x.add_product(-(static_cast<double>(j.w) * k.y), z);
      along_y.add_product(static_cast<double>(j.w) * k.x, z);
      along_y.add_product(-(static_cast<double>(j.x) * k.w), z);
    }
    for (Expansion<12>* slope : {&along_x, &along_y}) {
      if (slope->sign() * determinant_sign_ < 0) slope->negate();
    }
    Expansion<24> difference(along_x);
    difference.add_scaled(along_y, -1);
    return difference.sign() * determinant_sign_ > 0 ? along_x : along_y;
  }

  // z(p) (I1), and a bound of its error. D is not 0.
  Approximation approximate_depth(SamplePosition p) {
    Approximation e[3];
    evaluate_edges(p, e);
    return quotient(weighted_sum({vertex_[0].z, vertex_[1].z, vertex_[2].z}, e), approximate_determinant());
  }

  // The sign of z(p) - bound, exactly, for a bound of 0 or 1. D is not 0.
  int compare_depth(SamplePosition p, double bound, Rungs* rungs = nullptr) {
    const Approximation q = approximate_depth(p);
    const bool above = q.value - q.error > bound, below = q.value + q.error < bound;  // rounding is monotonic
    if (above || below) {
      count(rungs, &Rungs::values_by_filter);
      return above ? 1 : -1;
    }
    count(rungs, &Rungs::values_by_expansion);
    return minus_multiple_of_determinant(exact_depth_numerator(p), bound).sign() * determinant_sign_;
  }

  // Z_0 E_0 + Z_1 E_1 + Z_2 E_2 at p, exactly: the depth there is this over D. p may also be a corner of the guard
  // band of G1: no bound is involved.
  Expansion<60> exact_depth_numerator(SamplePosition p) const {
    return exact_weighted_sum({vertex_[0].z, vertex_[1].z, vertex_[2].z}, p);
  }

  // D itself.
  const Expansion<12>& exact_determinant_value() {
    know_determinant();
    return determinant_;
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
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) {
    if (interpolation == Interpolation::flat) return value_of_vertex_0(u);
    if (interpolation == Interpolation::perspective) {
      return weighted_mean({u[0], u[1], u[2]}, {1, 1, 1}, p, kAllEdges, rungs);
    }
    const double w[3] = {static_cast<double>(u[0]) * vertex_[0].w, static_cast<double>(u[1]) * vertex_[1].w,
                         static_cast<double>(u[2]) * vertex_[2].w};  // 48 bits, exact
    Approximation e[3];
    evaluate_edges(p, e);
    const Approximation q = quotient(weighted_sum(w, e), approximate_determinant());
    return rounded(
        q, [&] { return round_quotient(exact_weighted_sum(w, p), determinant_); }, rungs);
  }

  // The edges whose E_i counts at p under Grid (G2): it has the sign of D and is not 0. None if D = 0.
  EdgeSet right_edges(SamplePosition p, Rungs* rungs = nullptr) const {
    EdgeSet set = 0;
    for (int i = 0; i < 3; ++i) {
      if (determinant_sign_ != 0 && edge_[i].sign(p, rungs) == determinant_sign_) set |= 1u << i;
    }
    return set;
  }

  // An attribute at p as G2 has it: from the E_i that count, and the value of vertex 0 where their sum is 0.
  float attribute_of_right_edges(SamplePosition p, const float (&u)[3], Interpolation interpolation,
                                 Rungs* rungs = nullptr) const {
    const EdgeSet set = right_edges(p, rungs);
    if (interpolation == Interpolation::flat || set == 0) return value_of_vertex_0(u);
    if (interpolation == Interpolation::perspective) {
      return weighted_mean({u[0], u[1], u[2]}, {1, 1, 1}, p, set, rungs);
    }
    const double w[3] = {vertex_[0].w, vertex_[1].w, vertex_[2].w};
    if (weighted_sum_is_zero(w, p, set)) return value_of_vertex_0(u);
    return weighted_mean({u[0] * w[0], u[1] * w[1], u[2] * w[2]}, w, p, set, rungs);  // 48 bits, exact
  }

 private:
  static constexpr EdgeSet kAllEdges = 7;

  static float value_of_vertex_0(const float (&u)[3]) { return stored(u[0]); }

  // The E_i at p; 0 for edges outside the set.
  void evaluate_edges(SamplePosition p, Approximation (&e)[3], EdgeSet set = kAllEdges) const {
    for (int i = 0; i < 3; ++i) {
      e[i] = {0, 0};
      if ((set >> i & 1u) != 0) e[i].value = edge_[i].value(p, &e[i].error);
    }
  }

  Expansion<60> exact_weighted_sum(const double (&w)[3], SamplePosition p, EdgeSet set = kAllEdges) const {
    Expansion<60> sum;
    for (int i = 0; i < 3; ++i) {
      if ((set >> i & 1u) != 0) sum.add_scaled(edge_[i].exact_value(p), w[i]);
    }
    return sum;
  }

  bool weighted_sum_is_zero(const double (&w)[3], SamplePosition p, EdgeSet set) const {
    Approximation e[3];
    evaluate_edges(p, e, set);
    const Approximation sum = weighted_sum(w, e);
    return !(std::fabs(sum.value) > sum.error) && exact_weighted_sum(w, p, set).sign() == 0;
  }

  // The sum of numerator[i] E_i over that of denominator[i] E_i, as I4 stores it. The latter is not 0.
  float weighted_mean(const double (&numerator)[3], const double (&denominator)[3], SamplePosition p, EdgeSet set,
                      Rungs* rungs = nullptr) const {
    Approximation e[3];
    evaluate_edges(p, e, set);
    const Approximation q = quotient(weighted_sum(numerator, e), weighted_sum(denominator, e));
    const auto exact = [&] {
      return round_quotient(exact_weighted_sum(numerator, p, set), exact_weighted_sum(denominator, p, set));
    };
    return rounded(q, exact, rungs);
  }

  Approximation approximate_determinant() {
    know_determinant();
    return {determinant_estimate_, std::fabs(determinant_estimate_) * 0x1p-50};
  }

  // I8's m: the larger one of two is as near to the truth as they are.
  Approximation approximate_slope() {
    Approximation a[3], b[3];
    for (int i = 0; i < 3; ++i) {  // rounded once
      a[i] = {edge_[i].a, std::fabs(edge_[i].a) * 0x1p-52};
      b[i] = {edge_[i].b, std::fabs(edge_[i].b) * 0x1p-52};
    }
    const double z[3] = {vertex_[0].z, vertex_[1].z, vertex_[2].z};
    const Approximation x = quotient(weighted_sum(z, a), approximate_determinant());
    const Approximation y = quotient(weighted_sum(z, b), approximate_determinant());
    return {std::max(std::fabs(x.value), std::fabs(y.value)), std::max(x.error, y.error)};
  }

  float rounded_depth(SamplePosition p, Approximation q, Rungs* rungs = nullptr) {
    return rounded(
        q, [&] { return round_quotient(exact_depth_numerator(p), exact_determinant_value()); }, rungs);
  }

  // D itself is needed for values only; once per triangle.
  void know_determinant() {
    if (determinant_known_) return;
    determinant_ = exact_determinant(vertex_[0], vertex_[1], vertex_[2]);
    determinant_estimate_ = determinant_.estimate();
    determinant_known_ = true;
  }

  // 0 <= numerator / D <= 1, exactly (I5).
  bool inside_unit_range(const Expansion<60>& numerator, Rungs* rungs = nullptr) const {
    count(rungs, &Rungs::values_by_expansion);
    if (numerator.sign() * determinant_sign_ < 0) return false;
    return minus_multiple_of_determinant(numerator, 1).sign() * determinant_sign_ <= 0;
  }

  // numerator - bound D for a bound of 0 or 1.
  Expansion<72> minus_multiple_of_determinant(const Expansion<60>& numerator, double bound) const {
    Expansion<72> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    for (int i = 0; i < determinant_.size(); ++i) rest.add(-bound * determinant_.term(i));
    return rest;
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
