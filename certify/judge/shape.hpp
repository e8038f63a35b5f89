// SPDX-License-Identifier: Apache-2.0
//
// A primitive as its values see it: a triangle's plane (R11), a line (R23), a point.
#ifndef SUREFILL_CERTIFY_JUDGE_SHAPE_HPP
#define SUREFILL_CERTIFY_JUDGE_SHAPE_HPP

#include <optional>

#include "certify/judge/plane.hpp"
#include "corpus/scene.hpp"

namespace surefill::judge {

class Shape {
 public:
  // Primitive t of the draw.
  Shape(const Draw& draw, std::size_t t) : primitive_(draw.primitive), width_(draw.width.value_or(1)) {
    const std::size_t corners = corpus::corners_of(primitive_);
    for (std::size_t i = 0; i < 3; ++i) {
      indices_[i] = draw.indices[corners * t + std::min(i, corners - 1)];
      vertices_[i] = draw.vertices[indices_[i]];
    }
    if (primitive_ == Primitive::triangles) edges_.emplace(vertices_);
  }

  Primitive primitive() const { return primitive_; }
  // Of a line the last one twice, of a point three times.
  const std::array<std::uint32_t, 3>& indices() const { return indices_; }
  const std::array<Vertex, 3>& vertices() const { return vertices_; }
  float width() const { return width_; }

  bool in_front() const {
    return std::all_of(vertices_.begin(), vertices_.end(), [](const Vertex& v) { return v.w > 0; });
  }

  // values_around and terms_around, of the sum of above_i over that of below_i.
  Values values(const std::array<double, 3>& above, const std::array<double, 3>& below, double x, double y,
                const std::array<double, 2>& distance) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (edges_ && not_its_own(x, y, distance)) return {{-kInfinity, kInfinity}, 0};
    if (edges_) return values_around(*edges_, above, below, x, y, distance);
    return along(above, below, x, y, distance).values;
  }
  double terms(const std::array<double, 3>& above, const std::array<double, 3>& below, double x, double y,
               const std::array<double, 2>& distance) const {
    if (edges_) return terms_around(*edges_, above, below, x, y, distance);
    return along(above, below, x, y, distance).terms;
  }

 private:
  // R11: some have vertex 0's values there (G2), since the triangle itself covers nothing, but what a cut and the grid make of it may.
  bool not_its_own(double x, double y, const std::array<double, 2>& distance) const {
    if (in_front()) return false;
    if (edges_->is_thin()) return true;
    for (std::size_t i = 0; i < 3; ++i) {
      bool somewhere = false;
      for (const double dx : {-distance[0], distance[0]}) {
        for (const double dy : {-distance[1], distance[1]}) {
          somewhere = somewhere || edges_->at(i, x + dx, y + dy) * edges_->d < 0;
        }
      }
      if (!somewhere) return false;
    }
    return true;
  }

  struct Along {
    Values values;
    double terms;
  };

  // R23: at all places of the line, or its continuation, from t - reach to t + reach, t being that of the sample.
  Along along(const std::array<double, 3>& above, const std::array<double, 3>& below, double x, double y,
              const std::array<double, 2>& distance) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Along anything{{{-kInfinity, kInfinity}, 0}, 0};
    if (!in_front()) return anything;
    std::array<double, 2> w{vertices_[0].w, vertices_[1].w};
    double t = 0, reach = 0;
    if (primitive_ == Primitive::lines) {
      const double x0 = vertices_[0].x / w[0], y0 = vertices_[0].y / w[0], dx = vertices_[1].x / w[1] - x0,
                   dy = vertices_[1].y / w[1] - y0;
      const bool x_major = std::abs(dx) >= std::abs(dy);
      const double length = x_major ? dx : dy;
      if (length == 0) return anything;
      t = (x_major ? x - x0 : y - y0) / length;
      reach = (width_ / 2.0 + 2 + std::max(distance[0], distance[1])) / std::abs(length);
    }
    Along result{{{kInfinity, -kInfinity}, 0}, 0};
    int sign = 0;
    for (const double at : {t - reach, t, t + reach}) {
      const std::array<double, 2> k{(1 - at) / w[0], at / w[1]};
      const double numerator = above[0] * k[0] + above[1] * k[1], denominator = below[0] * k[0] + below[1] * k[1];
      const int now = denominator > 0 ? 1 : denominator < 0 ? -1 : 0;
      if (now == 0 || now * sign < 0) return anything;
      sign = now;
      const double value = numerator / denominator;
      if (at == t) result.values.value = value;
      result.values.range.low = std::min(result.values.range.low, value);
      result.values.range.high = std::max(result.values.range.high, value);
      const double sum = std::abs(above[0] * k[0]) + std::abs(above[1] * k[1]);
      result.terms = std::max(result.terms, sum / std::abs(denominator));
    }
    return result;
  }

  Primitive primitive_;
  float width_;
  std::array<std::uint32_t, 3> indices_{};
  std::array<Vertex, 3> vertices_{};
  std::optional<Edges> edges_;
};

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_SHAPE_HPP
