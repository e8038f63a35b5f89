// SPDX-License-Identifier: Apache-2.0
//
// What the second oracle knows of a triangle at a sample beside coverage: I1, I2 and G2 of docs/semantics.md.
#ifndef SUREFILL_ORACLE_CLIPPED_PLANE_HPP
#define SUREFILL_ORACLE_CLIPPED_PLANE_HPP

#include <array>
#include <optional>

#include "oracle/clipped_polygon.hpp"

namespace surefill::oracle::clipped {

// The weights of the three vertex values in an attribute: they add up to 1.
using Weights = std::array<Rational, 3>;

inline Rational combine(const Weights& weights, const std::array<Rational, 3>& values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

// A triangle's plane in (X, Y, W), not through the eye: what the ray through a sample sees there.
//
// The ray t p, p = (px, py, 1), meets the plane of m0, m1, m2 where n . t p = n . m0 for its normal n. There
// t p = m0 + s (m1 - m0) + r (m2 - m0), and with l = (1 - s - r, s, r) also t p = sum l_i m_i. The basis (m_i) gives
// p = sum (E_i / D) m_i, so l_i = t E_i / D, and sum l_i = 1 makes t = D / sum E_i: the weights l of the plane's affine
// combination are I2's E_i / sum E_i, Z / t is I1's depth, and l_i W_i / t is the noperspective W_i E_i / D.
class TrianglePlane {
 public:
  explicit TrianglePlane(const std::array<Vector, 3>& m) : origin_(m[0]), w_{m[0].w, m[1].w, m[2].w} {
    const Vector u = m[1] - m[0];
    const Vector v = m[2] - m[0];
    normal_ = cross(u, v);
    offset_ = dot(normal_, origin_);
    square_ = dot(normal_, normal_);
    s_axis_ = cross(v, normal_);
    r_axis_ = cross(normal_, u);
    depth_scale_ = offset_ * square_;
  }

  // l_i = weights[i] / sum. Kept apart, for sums and products of dyadic numbers are cheap, and of other rationals not.
  struct Hit {
    Weights weights;
    Rational sum;
  };
  // Where the plane is in front of the eye (t > 0); M1's "sum E_i has the sign of D".
  std::optional<Hit> hit(const Vector& p) const {
    const Rational slope = dot(normal_, p);
    if (sgn(slope) * sgn(offset_) <= 0) return std::nullopt;
    return hit_of(p, slope);
  }
  Weights perspective(const Hit& hit) const {
    return {hit.weights[0] / hit.sum, hit.weights[1] / hit.sum, hit.weights[2] / hit.sum};
  }
  Weights noperspective(const Hit& hit) const {
    Weights result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = hit.weights[i] * w_[i] / depth_scale_;
    return result;
  }
  // (sum l_i Z_i) / t, where sum l_i Z_i is the sum of weights[i] Z_i over slope square.
  Rational depth(const Hit& hit, const std::array<Rational, 3>& z) const {
    return combine(hit.weights, z) / depth_scale_;
  }
  // The same where the plane is not seen, too: nothing is divided by t.
  Rational depth_anywhere(const Vector& p, const std::array<Rational, 3>& z) const {
    return depth(hit_of(p, dot(normal_, p)), z);
  }

 private:
  Hit hit_of(const Vector& p, const Rational& slope) const {
    // t = offset / slope, and slope (t p - m0) is:
    const Vector d{offset_ * p.x - slope * origin_.x, offset_ * p.y - slope * origin_.y,
                   offset_ * p.w - slope * origin_.w};
    // The axes over `square` are the dual basis of (u, v) in the plane: their products with u, v are 1 and 0.
    const Rational s = dot(s_axis_, d);
    const Rational r = dot(r_axis_, d);
    const Rational sum = slope * square_;
    return Hit{{sum - s - r, s, r}, sum};
  }

  Vector origin_, normal_, s_axis_, r_axis_;
  Rational offset_, square_, depth_scale_;
  std::array<Rational, 3> w_;
};

// The coordinates of p in the basis (m0, m1, m2), E_i / D of the page, for section 6, where a sample may lie outside
// its triangle and even where the plane is not seen. By Gauss-Jordan elimination. No value where D = 0.
class Basis {
 public:
  explicit Basis(const std::array<Vector, 3>& m);

  bool regular() const { return regular_; }
  Weights coordinates(const Vector& p) const { return {dot(inverse_[0], p), dot(inverse_[1], p), dot(inverse_[2], p)}; }

 private:
  std::array<Vector, 3> inverse_;
  bool regular_ = false;
};

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_CLIPPED_PLANE_HPP
