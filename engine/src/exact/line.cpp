// SPDX-License-Identifier: Apache-2.0
#include "line.hpp"

#include <limits>

namespace surefill {

bool Line::set_up(const Vertex& v0, const Vertex& v1, std::optional<float> width) {
  edge_ = EdgeFunction(v0, v1);
  thin_ = !width.has_value();
  half_ = 0.5 * static_cast<double>(width.value_or(1.0f));
  if ((edge_.a == 0 && edge_.b == 0) || !(v0.w > 0 || v1.w > 0)) return false;
  x_major_ = along_x();
  slope_ = x_major_ ? edge_.b : edge_.a;
  forward_ = x_major_ ? sign_of(edge_.b) : -sign_of(edge_.a);  // S runs along (b, -a)
  end_[0] = {x_major_ ? v0.x : v0.y, v0.w, v0.z}, end_[1] = {x_major_ ? v1.x : v1.y, v1.w, v1.z};
  return true;
}

bool Line::covers(SamplePosition p, TieShift shift, Rungs* rungs) const {
  if (side(p, +1, shift, rungs) < 0 || side(p, -1, shift, rungs) > 0) return false;
  if (!thin_) return within_ends(p, shift);
  return !ends_in_diamond(1, p, shift) && (ends_in_diamond(0, p, shift) || within_ends(p, shift));
}

PixelBox Line::box(PixelBox limits, double least_offset, double largest_offset) const {
  const Vertex &v0 = edge_.from, &v1 = edge_.to;
  const double w[3] = {v0.w, v1.w, v1.w};
  clip_to_reach(widened(reach({v0.x, v1.x, v1.x}, w)), least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach(widened(reach({v0.y, v1.y, v1.y}, w)), least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

bool Line::depth(SamplePosition p, DepthMode mode, float* to, Rungs* rungs) const {
  const Mix mix = mix_at(p, end_[0].z, end_[1].z);
  const Approximation q = quotient(mix.sum(), mix.determinant());
  if (mode == DepthMode::clip) {
    const double low = q.value - q.error, high = q.value + q.error;
    if (high < 0 || low > 1) return false;
    if (!(low > 0 && high < 1) && !inside_unit_range(mix)) return false;
  }
  *to = rounded(
      q, [&] { return round_quotient(mix.exact_sum(), mix.exact_determinant()); }, rungs);
  if (mode == DepthMode::clamp) *to = *to < 0 ? 0.0f : *to > 1 ? 1.0f : *to;  // rounding is monotonic
  return true;
}

float Line::attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs) const {
  if (interpolation == Interpolation::flat) return stored(u[0]);
  if (interpolation == Interpolation::perspective) {
    const Mix mix = mix_at(p, u[0], u[1]);
    return rounded(
        quotient(mix.sum(), mix.weights()), [&] { return round_quotient(mix.exact_sum(), mix.exact_weights()); },
        rungs);
  }
  const Mix mix = mix_at(p, static_cast<double>(u[0]) * end_[0].w, static_cast<double>(u[1]) * end_[1].w);  // 48 bits
  return rounded(
      quotient(mix.sum(), mix.determinant()), [&] { return round_quotient(mix.exact_sum(), mix.exact_determinant()); },
      rungs);
}

bool Line::along_x() const {
  const double a = std::fabs(edge_.a), b = std::fabs(edge_.b);
  if (a != b || edge_.exact) return b >= a;
  const double sa = sign_of(edge_.a), sb = sign_of(edge_.b);
  const double jx = edge_.from.x, jy = edge_.from.y, jw = edge_.from.w;
  const double kx = edge_.to.x, ky = edge_.to.y, kw = edge_.to.w;
  Expansion<4> difference;
  difference.add(sb * (jw * kx)), difference.add(-sb * (jx * kw));
  difference.add(-sa * (jy * kw)), difference.add(sa * (jw * ky));
  return difference.sign() >= 0;
}

int Line::side(SamplePosition p, int s, TieShift shift, Rungs* rungs) const {
  double bound;
  const double value = edge_.value(p, &bound), half = s * std::fabs(slope_) * half_;
  const double estimate = value + half;
  if (std::fabs(estimate) > (bound + 0x1p-50 * std::fabs(half)) * (1 + 0x1p-20) + 0x1p-52 * std::fabs(value)) {
    count(rungs, &Rungs::signs_by_filter);
    return sign_of(estimate);
  }
  count(rungs, &Rungs::signs_by_expansion);
  Expansion<14> exact(edge_.exact_value(p));
  const double factor = s * sign_of(slope_) * half_;
  const double jx = edge_.from.x, jy = edge_.from.y, jw = edge_.from.w;
  const double kx = edge_.to.x, ky = edge_.to.y, kw = edge_.to.w;
  exact.add_product(x_major_ ? jw * kx : jy * kw, factor);
  exact.add_product(x_major_ ? -(jx * kw) : -(jw * ky), factor);
  return exact.sign() != 0 ? exact.sign() : tie_sign(edge_.a, edge_.b, shift);
}

bool Line::ends_in_diamond(int i, SamplePosition p, TieShift shift) const {
  const Vertex& v = i == 0 ? edge_.from : edge_.to;
  if (!(v.w > 0)) return false;
  const double w = v.w, half = 0.5 * w;
  const double u = std::fabs(v.x - p.x * w) + std::fabs(v.y - p.y * w);  // three roundings; the products are exact
  if (std::fabs(u - half) > 0x1p-50 * (u + half)) return u < half;
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      Expansion<5> exact;
      exact.add(sx * static_cast<double>(v.x)), exact.add(-sx * (p.x * w));
      exact.add(sy * static_cast<double>(v.y)), exact.add(-sy * (p.y * w));
      exact.add(-half);
      const int moved = shift.y_dominates ? -sy * shift.y : -sx * shift.x;
      if ((exact.sign() != 0 ? exact.sign() : moved) > 0) return false;
    }
  }
  return true;
}

Reach Line::widened(Reach r) const {
  const double low = r.low - half_, high = r.high + half_;
  return {low - 0x1p-50 * (std::fabs(low) + half_), high + 0x1p-50 * (std::fabs(high) + half_)};
}

Line::Mix Line::mix_at(SamplePosition p, double v0, double v1) const {
  const double t = along(p), tw0 = t * end_[0].w, tw1 = t * end_[1].w;  // exact: 27 and 24 bits
  // The determinant t_0 W_1 - t_1 W_0 has the sign of -forward, n_0 = t W_1 - t_1, n_1 = t_0 - t W_0.
  const int n0 = sign_of(tw1 - end_[1].t), n1 = sign_of(end_[0].t - tw0);
  if (end_[0].w > 0 && n1 * forward_ > 0) return {{1, 0}, {0, 0}, {end_[0].w, 0}, {v0, v1}};
  if (end_[1].w > 0 && n0 * forward_ > 0) return {{0, 1}, {0, 0}, {end_[1].w, 0}, {v0, v1}};
  return {{tw1, end_[0].t}, {end_[1].t, tw0}, {end_[0].t * end_[1].w, end_[1].t * end_[0].w}, {v0, v1}};
}

bool Line::inside_unit_range(const Mix& mix) {
  const Expansion<8> sum = mix.exact_sum();
  const Expansion<2> determinant = mix.exact_determinant();
  if (sum.sign() * determinant.sign() < 0) return false;
  Expansion<10> rest(sum);
  rest.add(-determinant.term(0));
  if (determinant.size() > 1) rest.add(-determinant.term(1));
  return rest.sign() * determinant.sign() <= 0;
}

Line::DepthAlong Line::depth_along() const {
  const double t0 = end_[0].t, w0 = end_[0].w, z0 = end_[0].z, t1 = end_[1].t, w1 = end_[1].w, z1 = end_[1].z;
  const double determinant = t0 * w1 - t1 * w0;  // each difference is of exact products
  const double start = (t0 * z1 - t1 * z0) / determinant;
  return {(w1 * z0 - w0 * z1) / determinant, start, 0x1p-50 * std::fabs(start)};
}

Reach Line::reach_of_ends() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto place = [](const End& end, double without) { return end.w > 0 ? end.t / end.w : without; };
  if (forward_ > 0) return {place(end_[0], -kInfinity), place(end_[1], kInfinity)};
  return {place(end_[1], -kInfinity), place(end_[0], kInfinity)};
}

}  // namespace surefill
