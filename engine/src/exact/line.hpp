// SPDX-License-Identifier: Apache-2.0
//
// A line of a draw: the samples that it covers, wide or thin (M7), and its values there (I7). S is what is seen of it: a
// segment or a ray, from its vertex 0 towards its vertex 1. Along the major axis t it has one point a coordinate.
#ifndef SUREFILL_SRC_LINE_HPP
#define SUREFILL_SRC_LINE_HPP

#include <cmath>
#include <optional>

#include "approximation.hpp"
#include "bounds.hpp"
#include "edge.hpp"

namespace surefill {

class Line {
 public:
  // False if it covers nothing: S is empty, or one point. Vertices are finite, the width too and above 0; without one the
  // line is thin.
  bool set_up(const Vertex& v0, const Vertex& v1, std::optional<float> width) {
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

  // z(t) = slope t + start for the depth (I7) between the ends, off by less than error + 2^-50 |slope t|.
  struct DepthAlong {
    double slope, start, error;
  };
  DepthAlong depth_along() const {
    const double t0 = end_[0].t, w0 = end_[0].w, z0 = end_[0].z, t1 = end_[1].t, w1 = end_[1].w, z1 = end_[1].z;
    const double determinant = t0 * w1 - t1 * w0;  // each difference is of exact products
    const double start = (t0 * z1 - t1 * z0) / determinant;
    return {(w1 * z0 - w0 * z1) / determinant, start, 0x1p-50 * std::fabs(start)};
  }

  bool x_major() const { return x_major_; }
  double half_width() const { return half_; }
  const EdgeFunction& edge() const { return edge_; }

  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const {
    if (side(p, +1, shift, rungs) < 0 || side(p, -1, shift, rungs) > 0) return false;
    if (!thin_) return within_ends(p, shift);
    return !ends_in_diamond(1, p, shift) && (ends_in_diamond(0, p, shift) || within_ends(p, shift));
  }

  // Has S a point with the major coordinate of the moved sample?
  bool within_ends(SamplePosition p, TieShift shift) const {
    const double t = along(p);
    const int step = x_major_ ? shift.x : shift.y;
    for (int i = 0; i < 2; ++i) {
      if (!(end_[i].w > 0)) continue;
      const int after = t * end_[i].w == end_[i].t  ? step
                        : t * end_[i].w > end_[i].t ? 1
                                                    : -1;  // exact: 27 and 24 bits
      if (after * forward_ != (i == 0 ? 1 : -1)) return false;
    }
    return true;
  }

  // From which to which major coordinate S reaches, to within a rounding; without an end, infinitely far.
  Reach reach_of_ends() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto place = [](const End& end, double without) { return end.w > 0 ? end.t / end.w : without; };
    if (forward_ > 0) return {place(end_[0], -kInfinity), place(end_[1], kInfinity)};
    return {place(end_[1], -kInfinity), place(end_[0], kInfinity)};
  }

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const {
    const Vertex &v0 = edge_.from, &v1 = edge_.to;
    const double w[3] = {v0.w, v1.w, v1.w};
    clip_to_reach(widened(reach({v0.x, v1.x, v1.x}, w)), least_offset, largest_offset, &limits.x0, &limits.x1);
    clip_to_reach(widened(reach({v0.y, v1.y, v1.y}, w)), least_offset, largest_offset, &limits.y0, &limits.y1);
    return limits;
  }

  // Depth as it is stored; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, DepthMode mode, float* to, Rungs* rungs = nullptr) const {
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

  // An attribute at p as I4 stores it, from its values at the two vertices.
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) const {
    if (interpolation == Interpolation::flat) return stored(u[0]);
    if (interpolation == Interpolation::perspective) {
      const Mix mix = mix_at(p, u[0], u[1]);
      return rounded(
          quotient(mix.sum(), mix.weights()), [&] { return round_quotient(mix.exact_sum(), mix.exact_weights()); },
          rungs);
    }
    const Mix mix = mix_at(p, static_cast<double>(u[0]) * end_[0].w, static_cast<double>(u[1]) * end_[1].w);  // 48 bits
    return rounded(
        quotient(mix.sum(), mix.determinant()),
        [&] { return round_quotient(mix.exact_sum(), mix.exact_determinant()); }, rungs);
  }

 private:
  struct End {
    double t, w, z;  // the major coordinate times W
  };

  // n_0 v_0 + n_1 v_1 for I7's k_i = n_i / determinant: n_0 = a_0 - b_0 and n_1 = a_1 - b_1, of doubles. One of the
  // n_i may be 0, and none has another sign than the determinant d_0 - d_1.
  struct Mix {
    double a[2], b[2], d[2], v[2];

    Approximation sum() const {
      const double s0 = (a[0] - b[0]) * v[0], s1 = (a[1] - b[1]) * v[1];
      return {s0 + s1, 0x1p-50 * (std::fabs(s0) + std::fabs(s1))};
    }
    Approximation weights() const {
      const double sum = (a[0] - b[0]) + (a[1] - b[1]);
      return {sum, 0x1p-51 * std::fabs(sum)};
    }
    Approximation determinant() const {
      const double difference = d[0] - d[1];
      return {difference, 0x1p-52 * std::fabs(difference)};
    }
    Expansion<8> exact_sum() const {
      Expansion<8> sum;
      for (int i = 0; i < 2; ++i) sum.add_product(a[i], v[i]), sum.add_product(-b[i], v[i]);
      return sum;
    }
    Expansion<4> exact_weights() const {
      Expansion<4> sum;
      for (int i = 0; i < 2; ++i) sum.add(a[i]), sum.add(-b[i]);
      return sum;
    }
    Expansion<2> exact_determinant() const {
      Expansion<2> difference;
      difference.add(d[0]), difference.add(-d[1]);
      return difference;
    }
  };

  double along(SamplePosition p) const { return x_major_ ? p.x : p.y; }

  // |dx| >= |dy| of S's direction (b, -a)? Rounding is monotonic, so only equal numbers have to be looked at.
  bool along_x() const {
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

  // The sign of E + s |m| w/2 at the moved sample, m the coefficient of the minor coordinate: the line is wider than its
  // distance from the sample where it is not s's opposite, for both s.
  int side(SamplePosition p, int s, TieShift shift, Rungs* rungs) const {
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

  // Does S have an end at vertex i that lies in the open diamond around the moved sample?
  bool ends_in_diamond(int i, SamplePosition p, TieShift shift) const {
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

  Reach widened(Reach r) const {
    const double low = r.low - half_, high = r.high + half_;
    return {low - 0x1p-50 * (std::fabs(low) + half_), high + 0x1p-50 * (std::fabs(high) + half_)};
  }

  // I7 at p for values v_0 and v_1: at the point of S that has p's major coordinate, or at the nearest end.
  Mix mix_at(SamplePosition p, double v0, double v1) const {
    const double t = along(p), tw0 = t * end_[0].w, tw1 = t * end_[1].w;  // exact: 27 and 24 bits
    // The determinant t_0 W_1 - t_1 W_0 has the sign of -forward, n_0 = t W_1 - t_1, n_1 = t_0 - t W_0.
    const int n0 = sign_of(tw1 - end_[1].t), n1 = sign_of(end_[0].t - tw0);
    if (end_[0].w > 0 && n1 * forward_ > 0) return {{1, 0}, {0, 0}, {end_[0].w, 0}, {v0, v1}};
    if (end_[1].w > 0 && n0 * forward_ > 0) return {{0, 1}, {0, 0}, {end_[1].w, 0}, {v0, v1}};
    return {{tw1, end_[0].t}, {end_[1].t, tw0}, {end_[0].t * end_[1].w, end_[1].t * end_[0].w}, {v0, v1}};
  }

  // 0 <= sum / determinant <= 1, exactly.
  static bool inside_unit_range(const Mix& mix) {
    const Expansion<8> sum = mix.exact_sum();
    const Expansion<2> determinant = mix.exact_determinant();
    if (sum.sign() * determinant.sign() < 0) return false;
    Expansion<10> rest(sum);
    rest.add(-determinant.term(0));
    if (determinant.size() > 1) rest.add(-determinant.term(1));
    return rest.sign() * determinant.sign() <= 0;
  }

  EdgeFunction edge_;
  bool thin_ = false, x_major_ = true;
  int forward_ = 1;    // does t grow along S?
  double half_ = 0.5;  // of the width
  double slope_ = 0;   // the edge's coefficient of the minor coordinate
  End end_[2] = {};
};

}  // namespace surefill

#endif  // SUREFILL_SRC_LINE_HPP
