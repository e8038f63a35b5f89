// SPDX-License-Identifier: Apache-2.0
//
// Depth, barycentrics and attributes of one triangle (I1 to I5, I8, G2): ratios of integers, rounded once.
#ifndef SUREFILL_ORACLE_VALUES_HPP
#define SUREFILL_ORACLE_VALUES_HPP

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "oracle/coverage.hpp"
#include "oracle/exact.hpp"
#include "oracle/grid.hpp"
#include "oracle/lines.hpp"

namespace surefill::oracle {

// The edge functions in integers. The vertices are taken times one power of two 2^k, and p times 16, so that
// E_i(p) 2^(2k) 16 and |D| 2^(3k) are integers; signs are those of E_i / D where D != 0.
class Edges {
 public:
  explicit Edges(const std::array<IntegerVertex, 3>& vertices);

  const IntegerVertex& vertex(std::size_t i) const { return m_[i]; }
  int sign_of_det() const { return det_sign_; }
  const Integer& det() const { return det_; }         // |D|
  const Integer& det16() const { return det16_; }     // 16 |D|: what E_i(p) X_i + ... divide by
  void at(Point p, std::array<Integer, 3>& e) const;  // the three E_i(p)

  // The affine function sum u_i E_i(p), u in any unit.
  struct Plane {
    Integer a, b, c;
    void at(Point p, Integer& value) const;
  };
  Plane weighted_sum(const Integer& u0, const Integer& u1, const Integer& u2) const;

 private:
  std::array<IntegerVertex, 3> m_;
  std::array<Plane, 3> edge_;
  int det_sign_;
  Integer det_, det16_;
};

// Depth of a triangle that the grid does not touch (`clipped` is null), or of one that was clipped to these corners
// (G2), biased if there is a bias (I8); or of a line or a point (I6, I7).
class Depth {
 public:
  Depth(const Edges& edges, const std::vector<IntegerVertex>* clipped, const std::optional<DepthBias>& bias);
  explicit Depth(const Line& line);  // which outlives it
  explicit Depth(const Square& square);

  // The stored depth at p, or nothing where I5 clips it. Precondition: without a grid, D != 0.
  std::optional<float> at(Point p, DepthMode mode) const;
  // Does I5 keep the fragment at p?
  bool keeps(Point p, DepthMode mode) const;

 private:
  void real(Point p, Integer& n, Integer& d) const;  // z(p), without bias

  Edges::Plane plane_;
  Integer denominator_;
  bool constant_ = false;  // D = 0: the smallest corner; a point's
  bool clamped_ = false;   // to the corners
  Ratio smallest_, largest_;
  std::optional<Ratio> bias_;  // c + s m
  const Line* line_ = nullptr;
};

// The weights at one place: vertex i weighs w_i / sum w. on_vertex_0: vertex 0 stands in (G2).
struct Weights {
  std::array<Integer, 3> w;
  bool on_vertex_0 = false;
};

// The E_i at p, with a grid those of the wrong sign as 0.
void weights_at(const Edges& edges, Point p, bool grid, Weights& weights);

// I3 at these weights. Precondition: their sum is positive, or vertex 0 stands in.
void barycentrics(const Weights& weights, std::span<float, 3> out);

// One component of an attribute (I2, I7). `own_sum`: in noperspective D is the sum of W_i times the weights, as it is with a
// grid and of lines.
class Component {
 public:
  Component(const Edges& edges, const std::array<float, 3>& values, Interpolation interpolation, bool own_sum);
  // Precondition: as barycentrics.
  float at(const Weights& weights) const;

 private:
  std::array<Integer, 3> u_;        // the vertex values times 2^shift_; noperspective: times W_i as well
  std::array<Integer, 3> divisor_;  // noperspective with its own sum: W_i
  Integer det16_;
  mp_bitcnt_t shift_ = 0;
  float first_;
  Interpolation interpolation_;
  bool own_sum_;
};

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_VALUES_HPP
