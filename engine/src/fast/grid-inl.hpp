// SPDX-License-Identifier: Apache-2.0
//
// Grid mode in lanes (semantics.md, section 6): positions rounded to the grid, edge functions of the snapped triangle.
// Triangles that the guard band cuts, or that reach behind the eye, become the fans of their clipped polygons.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_GRID_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_GRID_INL_HPP
#undef SUREFILL_SRC_FAST_GRID_INL_HPP
#else
#define SUREFILL_SRC_FAST_GRID_INL_HPP
#endif

#include "exact/grid.hpp"
#include "fast/batch.hpp"
#include "fast/edges-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// Rounds c / w to the grid: a position in pixels, exact. `unsure` gets the lanes in which the quotient is too close to
// where the rounding changes.
HWY_INLINE Double SnapLanes(Double c, Double w, int offset, const Grid& grid, hn::Mask<DoubleTag>& unsure) {
  const DoubleTag d;
  const double scale = 1 << grid.bits;
  const Double t = hn::Sub(hn::Mul(hn::Div(c, w), hn::Set(d, scale)), hn::Set(d, offset / 16.0));
  const bool truncates = grid.rounding == GridRounding::truncate;
  const Double shifted = truncates ? t : hn::Add(t, hn::Set(d, 0.5));
  const Double k = truncates ? hn::Trunc(t) : hn::Floor(shifted);
  unsure = hn::Or(unsure, hn::Lt(hn::Abs(hn::Sub(shifted, hn::Round(shifted))), hn::Set(d, snap_error())));
  return hn::Mul(hn::Add(hn::Mul(k, hn::Set(d, 16.0)), hn::Set(d, offset)), hn::Set(d, 1 / (16 * scale)));
}

// The corners of a batch on the grid. Returns the lanes that have none, because a vertex is not in front of the eye and
// within the guard band (or no number).
HWY_NOINLINE std::uint32_t Snap(const Grid& grid, Batch& batch, Rungs& rungs) {
  const DoubleTag dd;
  const FloatTag df;
  std::uint32_t others = 0;
  constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));
  for (std::uint32_t lane = 0; lane < kBatch; lane += kLanes) {
    Double x[3], y[3], w[3];
    auto whole = hn::Eq(hn::Zero(dd), hn::Zero(dd));
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = hn::PromoteTo(dd, hn::Load(df, batch.x[k] + lane)),
      y[k] = hn::PromoteTo(dd, hn::Load(df, batch.y[k] + lane));
      w[k] = hn::PromoteTo(dd, hn::Load(df, batch.w[k] + lane));
      const Double limit = hn::Mul(hn::Set(dd, kGuardBand), w[k]);  // 39 bits, exact
      whole = hn::And(whole, hn::And(hn::Gt(w[k], hn::Zero(dd)),
                                     hn::And(hn::Le(hn::Abs(x[k]), limit), hn::Le(hn::Abs(y[k]), limit))));
    }
    others |= Bits(dd, hn::Not(whole)) << lane;
    for (std::size_t k = 0; k < 3; ++k) {
      auto unsure = hn::Lt(hn::Zero(dd), hn::Zero(dd));
      const Double one = hn::Set(dd, 1.0), safe = hn::IfThenElse(whole, w[k], one);
      const Double at_x = SnapLanes(hn::IfThenElseZero(whole, x[k]), safe, grid.offset_x, grid, unsure);
      const Double at_y = SnapLanes(hn::IfThenElseZero(whole, y[k]), safe, grid.offset_y, grid, unsure);
      hn::Store(at_x, dd, batch.corner_x[k] + lane);
      hn::Store(at_y, dd, batch.corner_y[k] + lane);
      for (std::uint32_t rest = Bits(dd, hn::And(unsure, whole)); rest != 0; rest &= rest - 1) {
        const auto l = lane + static_cast<std::uint32_t>(std::countr_zero(rest));
        if ((batch.finite >> l & 1) == 0) continue;
        batch.corner_x[k][l] = snapped_position(batch.x[k][l], batch.w[k][l], grid.offset_x, grid, &rungs);
        batch.corner_y[k][l] = snapped_position(batch.y[k][l], batch.w[k][l], grid.offset_y, grid, &rungs);
      }
    }
  }
  for (std::uint32_t rest = others; rest != 0; rest &= rest - 1) {  // an empty box
    const auto l = static_cast<std::size_t>(std::countr_zero(rest));
    for (std::size_t k = 0; k < 3; ++k) batch.corner_x[k][l] = batch.corner_y[k][l] = -4 * kGuardBand;
  }
  return others;
}

// Samples of [begin, end) that lie between the corners along one axis.
HWY_INLINE void SnappedRange(const double (&corner)[3][kBatch], std::uint32_t lane, double offset, int begin, int end,
                             std::int32_t* first, std::int32_t* last) {
  const DoubleTag d;
  const Double c0 = hn::Load(d, corner[0] + lane), c1 = hn::Load(d, corner[1] + lane),
               c2 = hn::Load(d, corner[2] + lane);
  const Double shift = hn::Set(d, offset);
  StoreRange(hn::Ceil(hn::Sub(hn::Min(hn::Min(c0, c1), c2), shift)),
             hn::Floor(hn::Sub(hn::Max(hn::Max(c0, c1), c2), shift)), begin, end, first, last);
}

// E_i = a_i (px - x_j) + b_i (py - y_j), W being 1: the differences are exact.
HWY_INLINE void SnappedEdges(const Batch& batch, std::uint32_t lane, Double px, Double py, Edges& edges) {
  const DoubleTag d;
  const Double bound = hn::Set(d, kEdgeErrorBound);
  Double x[3], y[3];
  for (std::size_t k = 0; k < 3; ++k)
    x[k] = hn::Load(d, batch.corner_x[k] + lane), y[k] = hn::Load(d, batch.corner_y[k] + lane);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    edges.a[i] = hn::Sub(y[j], y[k]);
    edges.b[i] = hn::Sub(x[k], x[j]);
    edges.c[i] = hn::Neg(hn::Add(hn::Mul(edges.a[i], x[j]), hn::Mul(edges.b[i], y[j])));
    const Double along_x = hn::Mul(edges.a[i], hn::Sub(px, x[j])), along_y = hn::Mul(edges.b[i], hn::Sub(py, y[j]));
    edges.e[i] = hn::Add(along_x, along_y);
    edges.error[i] = hn::Mul(bound, hn::Add(hn::Abs(along_x), hn::Abs(along_y)));
  }
}

// Lanes whose integer edges are exact. Positions are multiples of u = 2^-(bits + 4) and so are samples, of which the
// differences of positions are even multiples of 16 u; so a value at a sample is a multiple of 16 u^2. It is exact in
// double below 2^52 of these, and scaled a multiple of kTieStep.
HWY_INLINE hn::Mask<DoubleTag> SnappedIntegers(const Grid& grid, const Edges& edges, const Double (&scale)[3]) {
  const DoubleTag d;
  const double unit = 16 * std::ldexp(1.0, -2 * (grid.bits + 4));
  auto exact = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (std::size_t i = 0; i < 3; ++i) {
    const Double as = hn::Mul(edges.a[i], scale[i]), bs = hn::Mul(edges.b[i], scale[i]);
    exact = hn::And(exact, hn::And(hn::Eq(hn::Round(as), as), hn::Eq(hn::Round(bs), bs)));
    // The error bound is 2^-50 of the sum of the terms' magnitudes.
    const Double size = hn::Mul(edges.error[i], hn::Set(d, 1 / kEdgeErrorBound));
    exact = hn::And(exact, hn::Lt(size, hn::Set(d, unit * 0x1p52)));
    exact = hn::And(exact, hn::Ge(scale[i], hn::Set(d, kTieStep / unit)));
  }
  return exact;
}

// a (p - x) + b (q - y) for differences of grid positions: its sign, exactly. In units of 2^-(bits + 4) pixels each
// factor is below 2^31 + 2^18 in magnitude and each product below 2^63; they are compared and not added.
HWY_INLINE int SignOfSum(double a, double p, double b, double q, double units) {
  const auto whole = [units](double v) { return static_cast<std::int64_t>(v * units); };
  const std::int64_t left = whole(a) * whole(p), right = -(whole(b) * whole(q));
  return left > right ? 1 : left < right ? -1 : 0;
}

// The orientation of the uncertain lanes, exactly; `flat` gets the lanes without area.
HWY_NOINLINE hn::Mask<DoubleTag> SnappedSigns(const Grid& grid, const Batch& batch, std::uint32_t lane,
                                              std::uint32_t uncertain, hn::Mask<DoubleTag> negative,
                                              std::uint32_t& flat) {
  const DoubleTag dd;
  alignas(64) double signs[kBatch];
  hn::Store(hn::IfThenElse(negative, hn::Set(dd, -1.0), hn::Set(dd, 1.0)), dd, signs);
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const auto n = static_cast<std::uint32_t>(std::countr_zero(uncertain));
    const auto x = [&](std::size_t k) { return batch.corner_x[k][lane + n]; };
    const auto y = [&](std::size_t k) { return batch.corner_y[k][lane + n]; };
    // E_0 at corner 0.
    const int sign = SignOfSum(y(1) - y(2), x(0) - x(1), x(2) - x(1), y(0) - y(1), 16 << grid.bits);
    signs[n] = sign < 0 ? -1 : 1;
    if (sign == 0) flat |= 1u << n;
  }
  return hn::Lt(hn::Load(dd, signs), hn::Zero(dd));
}

// The smallest and the largest Z/W of each triangle (G2), correctly rounded; negated for DepthTest::greater.
HWY_INLINE void SnappedDepthRange(const DrawJob& job, std::uint32_t lane, Batch& batch) {
  const FloatTag d;
  const Float most = hn::Set(d, std::numeric_limits<float>::max());
  Float low = most, high = hn::Neg(most);
  for (std::size_t k = 0; k < 3; ++k) {
    const Float z = hn::Div(hn::Load(d, batch.z[k] + lane), hn::Load(d, batch.w[k] + lane));
    low = hn::Min(low, hn::Max(z, hn::Neg(most)));
    high = hn::Max(high, hn::Min(z, most));
  }
  const Float zero = hn::Zero(d);
  hn::Store(hn::Add(job.greater ? hn::Neg(high) : low, zero), d, batch.z_least + lane);  // -0 becomes +0
  hn::Store(hn::Add(job.greater ? hn::Neg(low) : high, zero), d, batch.z_most + lane);
}

// Which of the clipped triangles reach a sample of the region: these stay in batch.clipped. `degenerate` gets those
// that hold the eye.
HWY_NOINLINE void FindClipped(const DrawJob& job, Batch& batch, Rungs& rungs) {
  SnappedTriangle snapped;
  for (std::uint32_t rest = batch.clipped; rest != 0; rest &= rest - 1) {
    const std::uint32_t lane = static_cast<std::uint32_t>(std::countr_zero(rest)), bit = rest & (0 - rest);
    const auto vertex = [&](std::size_t k) { return vertex_of(*job.draw, batch.position[lane], k); };
    const bool some = snapped.set_up(vertex(0), vertex(1), vertex(2), *job.draw->grid, &rungs);
    if (!some) batch.degenerate |= bit;
    const double least = std::min(job.sample.x, job.sample.y), most = std::max(job.sample.x, job.sample.y);
    if (!some || job.region.empty() || snapped.box(job.region, least, most).empty()) batch.clipped &= ~bit;
  }
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_GRID_INL_HPP
