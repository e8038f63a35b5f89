// SPDX-License-Identifier: Apache-2.0
#include "oracle/values.hpp"

#include <algorithm>

namespace surefill::oracle {

namespace {

// I4's zero.
float stored(float value) {
  return value == 0 ? 0.0f : value;
}

// sum += a k
void add_product(Integer& sum, const Integer& a, long k) {
  if (k >= 0) {
    mpz_addmul_ui(sum.get_mpz_t(), a.get_mpz_t(), static_cast<unsigned long>(k));
  } else {
    mpz_submul_ui(sum.get_mpz_t(), a.get_mpz_t(), static_cast<unsigned long>(-k));
  }
}

// I8: c + s m, where m = steepest / det, or 0 if D = 0.
Ratio bias_of(const DepthBias& bias, const Integer& steepest, const Integer& det) {
  const std::array numbers = {bias.constant, bias.slope};
  const int exponent = std::min(common_exponent(numbers), 0);
  Ratio result{scaled_integer(bias.constant, exponent), 1};
  if (det != 0) result = {result.n * det + scaled_integer(bias.slope, exponent) * steepest, det};
  result.d <<= static_cast<mp_bitcnt_t>(-exponent);
  return result;
}

}  // namespace

void Edges::Plane::at(Point p, Integer& value) const {
  value = c;
  add_product(value, a, p.x);
  add_product(value, b, p.y);
}

Edges::Edges(const std::array<IntegerVertex, 3>& vertices) : m_(vertices) {
  for (std::size_t i = 0; i < 3; ++i) {
    const IntegerVertex &j = m_[(i + 1) % 3], &k = m_[(i + 2) % 3];
    edge_[i] = {j.y * k.w - j.w * k.y, j.w * k.x - j.x * k.w, j.x * k.y - j.y * k.x};
  }
  det_ = edge_[0].a * m_[0].x + edge_[0].b * m_[0].y + edge_[0].c * m_[0].w;
  det_sign_ = sgn(det_);
  det_ = abs(det_);
  det16_ = det_ * kUnits;
  for (Plane& edge : edge_) edge = {edge.a * det_sign_, edge.b * det_sign_, edge.c * det_sign_ * kUnits};
}

void Edges::at(Point p, std::array<Integer, 3>& e) const {
  for (std::size_t i = 0; i < 3; ++i) edge_[i].at(p, e[i]);
}

Edges::Plane Edges::weighted_sum(const Integer& u0, const Integer& u1, const Integer& u2) const {
  return {u0 * edge_[0].a + u1 * edge_[1].a + u2 * edge_[2].a, u0 * edge_[0].b + u1 * edge_[1].b + u2 * edge_[2].b,
          u0 * edge_[0].c + u1 * edge_[1].c + u2 * edge_[2].c};
}

Depth::Depth(const Edges& edges, const std::vector<IntegerVertex>* clipped, const std::optional<DepthBias>& bias)
    : plane_(edges.weighted_sum(edges.vertex(0).z, edges.vertex(1).z, edges.vertex(2).z)),
      denominator_(edges.det16()),
      constant_(edges.sign_of_det() == 0),
      clamped_(clipped != nullptr) {
  if (bias) {
    // The plane is one of 1/16 pixels, over 16 |D|: its slope in pixels is a / |D|.
    const Integer along_x = abs(plane_.a), along_y = abs(plane_.b);
    bias_ = bias_of(*bias, std::max(along_x, along_y), edges.det());
  }
  if (clipped == nullptr || clipped->empty()) return;
  smallest_ = largest_ = {clipped->front().z, clipped->front().w};
  for (const IntegerVertex& corner : *clipped) {
    const Ratio z{corner.z, corner.w};
    if (less(z, smallest_)) smallest_ = z;
    if (less(largest_, z)) largest_ = z;
  }
}

Depth::Depth(const Line& line) : line_(&line) {}

Depth::Depth(const Square& square)
    : constant_(true), smallest_{square.vertex().z, square.vertex().w}, largest_(smallest_) {}

void Depth::real(Point p, Integer& n, Integer& d) const {
  if (line_ != nullptr) {
    thread_local Integer w0, w1;
    line_->weights_at(p, w0, w1);
    n = w0 * line_->vertex(0).z + w1 * line_->vertex(1).z;
    d = w0 * line_->vertex(0).w + w1 * line_->vertex(1).w;
    return;
  }
  if (constant_) {
    n = smallest_.n, d = smallest_.d;
    return;
  }
  plane_.at(p, n);
  d = denominator_;
  if (!clamped_) return;
  if (n * smallest_.d < smallest_.n * d) n = smallest_.n, d = smallest_.d;
  if (n * largest_.d > largest_.n * d) n = largest_.n, d = largest_.d;
}

std::optional<float> Depth::at(Point p, DepthMode mode) const {
  thread_local Integer n, d;
  real(p, n, d);
  if (mode == DepthMode::clip && (n < 0 || n > d)) return std::nullopt;
  if (bias_) {
    n = n * bias_->d + bias_->n * d;
    d *= bias_->d;
  }
  if (mode == DepthMode::clamp && n < 0) n = 0;
  if (mode == DepthMode::clamp && n > d) n = d;
  return nearest_finite(n, d);
}

bool Depth::keeps(Point p, DepthMode mode) const {
  if (mode != DepthMode::clip) return true;
  thread_local Integer n, d;
  real(p, n, d);
  return n >= 0 && n <= d;
}

void weights_at(const Edges& edges, Point p, bool grid, Weights& weights) {
  edges.at(p, weights.w);
  weights.on_vertex_0 = false;
  if (!grid) return;
  for (Integer& w : weights.w) {
    if (w < 0) w = 0;
  }
  weights.on_vertex_0 = edges.sign_of_det() == 0 || (weights.w[0] == 0 && weights.w[1] == 0 && weights.w[2] == 0);
}

void barycentrics(const Weights& weights, std::span<float, 3> out) {
  if (weights.on_vertex_0) {
    out[0] = 1, out[1] = 0, out[2] = 0;
    return;
  }
  thread_local Integer sum;
  sum = weights.w[0] + weights.w[1] + weights.w[2];
  for (std::size_t i = 0; i < 3; ++i) out[i] = nearest_finite(weights.w[i], sum);
}

Component::Component(const Edges& edges, const std::array<float, 3>& values, Interpolation interpolation, bool own_sum)
    : first_(stored(values[0])), interpolation_(interpolation), own_sum_(own_sum) {
  if (interpolation == Interpolation::flat) return;
  const int exponent = std::min(common_exponent(values), 0);
  shift_ = static_cast<mp_bitcnt_t>(-exponent);
  for (std::size_t i = 0; i < 3; ++i) {
    u_[i] = scaled_integer(values[i], exponent);
    if (interpolation != Interpolation::noperspective) continue;
    u_[i] *= edges.vertex(i).w;
    divisor_[i] = edges.vertex(i).w;
  }
  det16_ = edges.det16();
}

float Component::at(const Weights& weights) const {
  if (weights.on_vertex_0 || interpolation_ == Interpolation::flat) return first_;
  thread_local Integer n, d;
  const std::array<Integer, 3>& w = weights.w;
  n = u_[0] * w[0] + u_[1] * w[1] + u_[2] * w[2];
  if (interpolation_ == Interpolation::perspective) {
    d = w[0] + w[1] + w[2];
  } else if (!own_sum_) {
    d = det16_;
  } else {
    d = divisor_[0] * w[0] + divisor_[1] * w[1] + divisor_[2] * w[2];
    if (d == 0) return first_;
    if (d < 0) n = -n, d = -d;
  }
  d <<= shift_;
  return nearest_finite(n, d);
}

}  // namespace surefill::oracle
