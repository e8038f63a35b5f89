// SPDX-License-Identifier: Apache-2.0
//
// Eight triangles of a draw become a batch: boxes, facing, edge functions as scaled integers, depth planes.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_SET_UP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_SET_UP_INL_HPP
#undef SUREFILL_SRC_FAST_SET_UP_INL_HPP
#else
#define SUREFILL_SRC_FAST_SET_UP_INL_HPP
#endif

#include "fast/edges-inl.hpp"
#include "fast/grid-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

constexpr auto kGroup = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));  // lanes that are set up together
constexpr auto kWide = static_cast<std::uint32_t>(hn::MaxLanes(hn::CappedTag<float, kBatch>()));  // floats at once
constexpr std::uint32_t kGroupLanes = (1u << kGroup) - 1;
// A triangle that is less high than so many pixels holds hardly a whole cell of 4 x 4 samples.
constexpr double kThinHeight = 2.9;

// The vertices of a batch, each of their numbers in its own array; which lanes are finite and in front of the eye.
HWY_NOINLINE void LoadVertices(const BatchVertices& vertices, Batch& batch) {
  const hn::CappedTag<float, kBatch> d;
  batch.finite = batch.front = 0;
  for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
    const auto zero = hn::Zero(d);
    auto sum = zero;
    auto front = hn::Eq(zero, zero);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = LoadVertex(d, vertices, lane, k);
      hn::Store(v.x, d, batch.x[k] + lane), hn::Store(v.y, d, batch.y[k] + lane);
      hn::Store(v.z, d, batch.z[k] + lane), hn::Store(v.w, d, batch.w[k] + lane);
      // 0 times a number is 0; times an infinity or a NaN it is a NaN, and so is the sum (B1).
      sum = hn::MulAdd(v.x, zero, hn::MulAdd(v.y, zero, hn::MulAdd(v.z, zero, hn::MulAdd(v.w, zero, sum))));
      front = hn::And(front, hn::Gt(v.w, zero));
    }
    batch.finite |= Bits(d, hn::Eq(sum, zero)) << lane;
    batch.front |= Bits(d, front) << lane;
  }
}

// The samples of the region that the triangles of `all` can cover.
HWY_NOINLINE void SetUpBoxes(const DrawJob& job, const BatchVertices& vertices, std::uint32_t all, Batch& batch) {
  const hn::CappedTag<float, kBatch> d;
  const hn::RebindToSigned<decltype(d)> di;
  const PixelBox& region = job.region;
  const bool over = job.draw->conservative == Conservative::over;
  batch.reached = 0;
  for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
    hn::Vec<decltype(d)> x[3], y[3], w[3];
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = hn::Load(d, batch.x[k] + lane), y[k] = hn::Load(d, batch.y[k] + lane);
      w[k] = hn::Load(d, batch.w[k] + lane);
      w[k] = hn::IfThenElse(hn::Gt(w[k], zero), w[k], one);  // harmless, where the result is not used
    }
    PixelRange(d, x, w, job.sample.x, region.x0, region.x1, batch.first_x + lane, batch.last_x + lane);
    PixelRange(d, y, w, job.sample.y, region.y0, region.y1, batch.first_y + lane, batch.last_y + lane);
  }
  const bool far = job.origin != Origin{};  // samples need not be float32 values
  for (std::uint32_t lane = 0; HWY_UNLIKELY(far || over) && lane < kBatch; lane += kGroup) {
    const double squares_x = job.origin.x, squares_y = job.origin.y;
    DoubleRange(batch.x, batch.w, lane, over, over ? squares_x : job.sample.x, region.x0, region.x1,
                batch.first_x + lane, batch.last_x + lane);
    DoubleRange(batch.y, batch.w, lane, over, over ? squares_y : job.sample.y, region.y0, region.y1,
                batch.first_y + lane, batch.last_y + lane);
  }
  const bool grid = job.draw->grid.has_value();
  for (std::uint32_t mixed = grid ? 0 : ~batch.front & batch.finite & all; HWY_UNLIKELY(mixed != 0);
       mixed &= mixed - 1) {
    const auto l = static_cast<std::uint32_t>(std::countr_zero(mixed));
    const double x = job.sample.x - job.origin.x, y = job.sample.y - job.origin.y;  // within a pixel
    const PixelBox box =
        job.in_target(screen_box(vertices.of(l, 0), vertices.of(l, 1), vertices.of(l, 2), job.in_space(region),
                                 over ? 0 : std::min(x, y), over ? 1 : std::max(x, y)));
    batch.first_x[l] = box.x0, batch.last_x[l] = box.x1 - 1;
    batch.first_y[l] = box.y0, batch.last_y[l] = box.y1 - 1;
  }
  for (std::uint32_t lane = 0; grid && lane < kBatch; lane += kGroup) {
    SnappedRange(batch.corner_x, lane, job.sample.x, region.x0, region.x1, batch.first_x + lane, batch.last_x + lane);
    SnappedRange(batch.corner_y, lane, job.sample.y, region.y0, region.y1, batch.first_y + lane, batch.last_y + lane);
  }
  for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
    const auto x0 = hn::Load(di, batch.first_x + lane), x1 = hn::Load(di, batch.last_x + lane);
    const auto y0 = hn::Load(di, batch.first_y + lane), y1 = hn::Load(di, batch.last_y + lane);
    batch.reached |= Bits(di, hn::Not(hn::Or(hn::Lt(x1, x0), hn::Lt(y1, y0)))) << lane;
  }
  batch.reached &= all & batch.finite;
}

// The group of lanes at hand.
struct Group {
  std::uint32_t lane;   // the first
  std::uint32_t lanes;  // those to be set up, from bit 0 on
  Double px, py;        // the first sample of the origin
  hn::Mask<DoubleTag> small;
  Double w[3];
  Edges edges;  // positive inside, once their sign is known
  Double det, det_error;
};

// The edges of a group as integers, scaled so that all steps stay exact. Conservative: each edge moved by half a pixel
// each way, outwards (over) or inwards (inner), so that the pixel's centre tells of its square. For over, the square
// must also meet the box, which is exact (docs/precision.md).
HWY_NOINLINE void StoreEdges(const DrawJob& job, Group& group, const Double (&scale)[3], hn::Mask<DoubleTag> integer,
                             Batch& batch) {
  const DoubleTag dd;
  const IntTag di;
  Edges& edges = group.edges;
  const std::uint32_t lane = group.lane, small = batch.small >> lane & kGroupLanes;
  const Conservative conservative = job.draw->conservative;
  if (HWY_UNLIKELY(conservative != Conservative::none)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Double half = hn::Mul(hn::Add(hn::Abs(edges.a[i]), hn::Abs(edges.b[i])),
                                  hn::Set(dd, conservative == Conservative::over ? 0.5 : -0.5));
      edges.e[i] = hn::Add(edges.e[i], half);
      edges.c[i] = hn::Add(edges.c[i], half);
    }
  }
  const bool any_integer = (Bits(dd, integer) & group.lanes) != 0;
  batch.integer |= any_integer ? Bits(dd, integer) << lane : 0;
  const Double bound = hn::IfThenZeroElse(integer, hn::Set(dd, kExactCoverage ? static_cast<double>(kSmallBound) : 0));
  hn::Store(hn::DemoteTo(di, hn::Add(bound, bound)), di, batch.doubt + lane);
  const Double limit = hn::Set(dd, kEdgeLimit);
  for (std::size_t i = 0; i < 3; ++i) {
    const Double a = hn::Mul(edges.a[i], scale[i]), b = hn::Mul(edges.b[i], scale[i]);
    auto lost = hn::Lt(a, a);
    if (HWY_UNLIKELY(any_integer)) {
      // Inside if E > 0, or E = 0 and the tie goes to this triangle: floor(E) >= 0, with a little taken off if it
      // does not.
      const Double along_x = hn::Mul(a, hn::Set(dd, job.shift.x)), along_y = hn::Mul(b, hn::Set(dd, job.shift.y));
      const Double decides = job.shift.y_dominates ? along_y : along_x,
                   other = job.shift.y_dominates ? along_x : along_y;
      const auto zero = hn::Zero(dd);
      lost = hn::Or(hn::Lt(decides, zero), hn::And(hn::Eq(decides, zero), hn::Le(other, zero)));
      // T and the squares are closed, and so are triangles under the rule closed; those under open have no border (C5).
      if (conservative != Conservative::none || job.shift.all > 0) lost = hn::Lt(a, a);
      if (conservative == Conservative::none && job.shift.all < 0) lost = hn::Eq(a, a);
      batch.tie_lost[i] |= (Bits(dd, lost) & batch.integer >> lane) << lane;
    }
    if ((small & group.lanes) != 0) {
      hn::Store(RoundToInt(a), di, batch.a[i] + lane);
      hn::Store(RoundToInt(b), di, batch.b[i] + lane);
      const Double start = hn::Max(hn::Min(hn::Mul(edges.e[i], scale[i]), limit), hn::Neg(limit));
      auto value = hn::Sub(hn::Round(start), bound);
      if (HWY_UNLIKELY(any_integer)) {
        const Double floor = hn::Floor(hn::Sub(start, hn::IfThenElseZero(lost, hn::Set(dd, kTieStep))));
        value = hn::IfThenElse(integer, floor, value);
      }
      hn::Store(RoundToInt(value), di, batch.e[i] + lane);
    }
    if ((~small & group.lanes) != 0) {
      hn::Store(a, dd, batch.scaled_a[i] + lane);
      hn::Store(b, dd, batch.scaled_b[i] + lane);
      hn::Store(hn::Mul(edges.c[i], scale[i]), dd, batch.scaled_c[i] + lane);
    }
  }
}

// The depth planes of a group about the origin: z = sum Z_i E_i / D.
HWY_NOINLINE void StoreDepth(const DrawJob& job, const Group& group, Batch& batch) {
  const DoubleTag dd;
  const FloatTag df;
  const IntTag di;
  const std::uint32_t lane = group.lane;
  const Edges& edges = group.edges;
  const auto span = [&](const std::int32_t* last, double sample, Double first) {
    return hn::Sub(hn::Add(hn::PromoteTo(dd, hn::Load(di, last + lane)), hn::Set(dd, sample)), first);
  };
  const Double columns = span(batch.last_x, job.sample.x, group.px), rows = span(batch.last_y, job.sample.y, group.py);
  Double z = hn::Zero(dd), zx = z, zy = z, edge_error = z, x_size = z, y_size = z, z_magnitude = z, z_most = z;
  for (std::size_t i = 0; i < 3; ++i) {
    const Double depth_i = hn::PromoteTo(dd, hn::Load(df, batch.z[i] + lane));
    z = hn::Add(z, hn::Mul(depth_i, edges.e[i]));
    zx = hn::Add(zx, hn::Mul(depth_i, edges.a[i]));
    zy = hn::Add(zy, hn::Mul(depth_i, edges.b[i]));
    edge_error = hn::Add(edge_error, edges.error[i]);
    x_size = hn::Add(x_size, hn::Abs(edges.a[i]));
    y_size = hn::Add(y_size, hn::Abs(edges.b[i]));
    z_magnitude = hn::Add(z_magnitude, hn::Abs(depth_i));  // in the bounds it stands for each |Z_i|
    z_most = hn::Max(z_most, hn::Abs(depth_i));
  }
  const Double bound = hn::Set(dd, kEdgeErrorBound);
  const Double smallest = hn::Sub(hn::Abs(group.det), group.det_error);  // |D| is at least this; else nothing is known
  const Double inverse = hn::Div(hn::Set(dd, job.greater ? -1.0 : 1.0), group.det);
  z = hn::Mul(z, inverse), zx = hn::Mul(zx, inverse), zy = hn::Mul(zy, inverse);
  // |z_real - z| at any sample of the box: numerators, determinant, and the rounding of the evaluation itself. An
  // edge's error is at least `bound` times its value: twice that error bounds a product with it.
  const Double size = hn::Add(hn::Abs(z), hn::Add(hn::Mul(hn::Abs(zx), columns), hn::Mul(hn::Abs(zy), rows)));
  const Double steps = hn::Mul(bound, hn::Add(hn::Mul(x_size, columns), hn::Mul(y_size, rows)));
  // The determinant's error counts for depth where the triangle covers: a mean of the vertices' if all are in front.
  Double covered = size;
  if (HWY_LIKELY(job.draw->conservative == Conservative::none && !job.draw->grid)) {
    const Double w = hn::Min(hn::Min(group.w[0], group.w[1]), group.w[2]);
    covered = hn::IfThenElse(hn::Gt(w, hn::Zero(dd)), hn::Min(hn::Div(z_most, w), size), size);
  }
  const Double numerators =
      hn::Add(hn::Mul(z_magnitude, hn::Add(hn::Add(edge_error, edge_error), steps)), hn::Mul(covered, group.det_error));
  // The first sample of a tile may lie 63 samples before the origin, on the way to which sums can be larger.
  const Double slopes = hn::Add(hn::Abs(zx), hn::Abs(zy)), way = hn::Mul(hn::Set(dd, 63.0), slopes);
  const Double evaluation = hn::Mul(hn::Set(dd, 2 * kEdgeErrorBound), hn::Add(size, way));
  const Double total = hn::Mul(hn::Add(hn::Div(numerators, smallest), evaluation), hn::Set(dd, 1 + 0x1p-20));
  const auto known =
      hn::And(hn::Gt(smallest, hn::Zero(dd)), hn::Lt(hn::Add(hn::Add(size, way), total), hn::Set(dd, 1e37)));
  batch.slow_depth |= Bits(dd, hn::Not(known)) << lane;
  hn::Store(z, dd, batch.plane + lane);
  hn::Store(zx, dd, batch.plane_x + lane);
  hn::Store(zy, dd, batch.plane_y + lane);
  hn::Store(total, dd, batch.plane_error + lane);
  // Small lanes: samples of cells that the box meets, up to 3 beyond it.
  const Double largest = hn::Add(size, hn::Mul(hn::Set(dd, 3.0), slopes));
  const Splitter<DoubleTag> splitter(largest);
  Float high, low;
  splitter.Split(z, high, low);
  hn::Store(high, df, batch.high + lane);
  hn::Store(low, df, batch.low + lane);
  splitter.Split(zx, high, low);
  hn::Store(high, df, batch.high_x + lane);
  hn::Store(low, df, batch.low_x + lane);
  splitter.Split(zy, high, low);
  hn::Store(high, df, batch.high_y + lane);
  hn::Store(low, df, batch.low_y + lane);
  const auto zero = hn::Eq(total, hn::Zero(dd));  // then size and way are 0: depth is 0 everywhere, without error
  const Double error = hn::IfThenZeroElse(zero, splitter.Error(total, kSmallParts));
  hn::Store(hn::DemoteTo(df, error), df, batch.low_error + lane);
}

// What depth is clamped to; a fan's batch has its range already.
HWY_INLINE void StoreDepthRange(const DrawJob& job, std::uint32_t lane, bool of_fan, Batch& batch) {
  const FloatTag d;
  const bool grid = job.draw->grid.has_value(), clamps = job.draw->depth_mode == DepthMode::clamp;
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  if (HWY_UNLIKELY(grid)) {
    if (!of_fan) SnappedDepthRange(job, lane, batch);
  } else {
    hn::Store(hn::Neg(infinity), d, batch.z_least + lane);
    hn::Store(infinity, d, batch.z_most + lane);
  }
  if (HWY_LIKELY(!clamps)) return;
  const auto near = hn::Set(d, job.greater ? -1.0f : 0.0f), far = hn::Set(d, job.greater ? 0.0f : 1.0f);
  for (float* const end : {batch.z_least + lane, batch.z_most + lane})
    hn::Store(hn::Min(hn::Max(hn::Load(d, end), near), far), d, end);
}

// Classes of a group by box, and the first sample about which its edges are set up.
HWY_INLINE void Classify(const DrawJob& job, Group& group, Batch& batch) {
  const DoubleTag dd;
  const IntTag di;
  const std::uint32_t lane = group.lane;
  const auto x0 = hn::Load(di, batch.first_x + lane), x1 = hn::Load(di, batch.last_x + lane);
  const auto y0 = hn::Load(di, batch.first_y + lane), y1 = hn::Load(di, batch.last_y + lane);
  const auto three = hn::Set(di, 3), seven = hn::Set(di, 7);
  const auto cells = hn::Max(hn::Sub(x1, hn::AndNot(three, x0)), hn::Sub(y1, hn::AndNot(three, y0)));
  const auto blocks = hn::Max(hn::Sub(x1, hn::AndNot(seven, x0)), hn::Sub(y1, hn::AndNot(seven, y0)));
  const auto small = hn::Lt(cells, hn::Set(di, kAreaSize));
  group.small = hn::Lt(hn::PromoteTo(dd, cells), hn::Set(dd, kAreaSize));
  batch.small |= Bits(di, small) << lane;
  batch.medium |= Bits(di, hn::Lt(blocks, hn::Set(di, kTileSize))) << lane;
  const auto low_bits = hn::IfThenElse(small, three, seven);
  group.px = hn::Add(hn::PromoteTo(dd, hn::AndNot(low_bits, x0)), hn::Set(dd, job.sample.x));
  group.py = hn::Add(hn::PromoteTo(dd, hn::AndNot(low_bits, y0)), hn::Set(dd, job.sample.y));
}

// X, Y and W of a group's vertices.
HWY_INLINE void Promote(const Batch& batch, std::uint32_t lane, Double (&x)[3], Double (&y)[3], Double (&w)[3]) {
  const DoubleTag dd;
  const FloatTag df;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = hn::PromoteTo(dd, hn::Load(df, batch.x[k] + lane));
    y[k] = hn::PromoteTo(dd, hn::Load(df, batch.y[k] + lane));
    w[k] = hn::PromoteTo(dd, hn::Load(df, batch.w[k] + lane));
  }
}

// Edge functions and D of a group: their signs, their integers.
HWY_NOINLINE void SetUpEdges(const DrawJob& job, Group& group, Batch& batch, Rungs& rungs) {
  const DoubleTag dd;
  const hn::RebindToUnsigned<DoubleTag> du;
  const std::uint32_t lane = group.lane;
  const bool grid = job.draw->grid.has_value();
  Double x[3], y[3], scale[3];
  Edges& edges = group.edges;
  Classify(job, group, batch);
  Promote(batch, lane, x, y, group.w);
  if (HWY_UNLIKELY(grid)) {
    for (Double& w : group.w) w = hn::Set(dd, 1.0);
    SnappedEdges(batch, lane, group.px, group.py, edges);
  } else {
    HomogeneousEdges(x, y, group.w, group.px, group.py, edges);
  }
  Determinant(group.w, edges, group.det, group.det_error);
  // The sign of D: by its bound, else lane by lane. Edges of a triangle with D < 0 are negated, and so is D.
  auto is_negative = hn::Lt(group.det, hn::Zero(dd));
  const std::uint32_t uncertain = Bits(dd, hn::Not(hn::Gt(hn::Abs(group.det), group.det_error))) & group.lanes;
  if (HWY_UNLIKELY(uncertain != 0)) {
    std::uint32_t flat = 0;
    is_negative = grid ? SnappedSigns(*job.draw->grid, batch, lane, uncertain, is_negative, flat)
                       : ExactSigns(*job.draw, batch.position + lane, uncertain, is_negative, flat, rungs);
    batch.degenerate |= flat << lane;
  }
  batch.negative |= Bits(dd, is_negative) << lane;
  constexpr auto kOne = std::uint64_t{1} << 52;
  const auto exponent = hn::Add(
      hn::Set(du, (2046 + kTileExponent) * kOne),
      hn::IfThenElseZero(hn::RebindMask(du, group.small), hn::Set(du, (kSmallExponent - kTileExponent) * kOne)));
  for (std::size_t i = 0; i < 3; ++i) scale[i] = Scale(edges.a[i], edges.b[i], exponent);
  auto integer = hn::Lt(group.px, group.px);
  if (kExactCoverage) {
    const Double as = hn::Mul(edges.a[0], scale[0]);
    if (grid) {
      integer = SnappedIntegers(*job.draw->grid, edges, scale);
    } else if ((Bits(dd, hn::Eq(hn::Round(as), as)) & group.lanes) != 0) {
      integer = IntegerEdges(x, y, group.w, edges.a, edges.b, edges.c, scale);
    }
  }
  const Double sign = hn::IfThenElse(is_negative, hn::Set(dd, -0.0), hn::Zero(dd));
  auto thin = hn::Lt(group.px, group.px);
  group.det = hn::Xor(group.det, sign);
  for (std::size_t i = 0; i < 3; ++i) {
    edges.a[i] = hn::Xor(edges.a[i], sign), edges.b[i] = hn::Xor(edges.b[i], sign);
    edges.c[i] = hn::Xor(edges.c[i], sign), edges.e[i] = hn::Xor(edges.e[i], sign);
    // The height over an edge, in pixels, is D / W / |(a, b)|.
    const Double length = hn::Mul(group.w[i], hn::Max(hn::Abs(edges.a[i]), hn::Abs(edges.b[i])));
    thin = hn::Or(thin, hn::Lt(group.det, hn::Mul(hn::Set(dd, kThinHeight), length)));
  }
  batch.thin |= Bits(dd, thin) << lane;
  StoreEdges(job, group, scale, integer, batch);
}

// The depth of a group. Under Grid it is that of the triangle as it was.
HWY_NOINLINE void SetUpDepth(const DrawJob& job, Group& group, bool of_fan, Batch& batch) {
  if (HWY_UNLIKELY(job.draw->grid.has_value())) {
    Double x[3], y[3];
    Promote(batch, group.lane, x, y, group.w);
    HomogeneousEdges(x, y, group.w, group.px, group.py, group.edges);
    Determinant(group.w, group.edges, group.det, group.det_error);
  }
  StoreDepth(job, group, batch);
  StoreDepthRange(job, group.lane, of_fan, batch);
}

// Which samples are covered in lanes whose box lies within 4 x 4 samples, unless one is within doubt of an edge.
HWY_NOINLINE void CoverTiny(Batch& batch) {
  const hn::CappedTag<std::int32_t, kBatch> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto three = hn::Set(du, 3);
  for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
    const auto x0 = hn::Load(d, batch.first_x + lane), x1 = hn::Load(d, batch.last_x + lane);
    const auto y0 = hn::Load(d, batch.first_y + lane), y1 = hn::Load(d, batch.last_y + lane);
    const auto columns = hn::Sub(x1, x0), rows = hn::Sub(y1, y0);
    const auto fits = hn::Lt(hn::Max(columns, rows), hn::Set(d, kCellSize));
    const std::uint32_t lanes = Bits(d, fits) & (batch.reached & batch.small) >> lane;
    if (lanes == 0) continue;
    const std::int32_t last_column = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(fits, columns)));
    const std::int32_t last_row = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(fits, rows)));
    const auto from_x = hn::And(hn::BitCast(du, x0), three), from_y = hn::And(hn::BitCast(du, y0), three);
    hn::Vec<decltype(d)> a[3], b[3], row[3];
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = hn::Load(d, batch.a[k] + lane), b[k] = hn::Load(d, batch.b[k] + lane);
      const auto start = hn::Add(hn::Mul(a[k], hn::BitCast(d, from_x)), hn::Mul(b[k], hn::BitCast(d, from_y)));
      row[k] = hn::Add(hn::Load(d, batch.e[k] + lane), start);
    }
    // A row of samples is a byte. Those that are covered, and those that are unless doubt says otherwise.
    const auto doubt = hn::Load(d, batch.doubt + lane);
    auto cover = hn::Zero(du), at_most = cover;
    for (std::int32_t y = 0; y <= last_row; ++y) {
      auto e0 = row[0], e1 = row[1], e2 = row[2];
      for (std::int32_t x = 0; x <= last_column; ++x) {
        const auto least = hn::Min(hn::Min(e0, e1), e2), bit = hn::Set(d, 1 << (8 * y + x));
        cover = hn::Or(cover, hn::BitCast(du, hn::AndNot(hn::ShiftRight<31>(least), bit)));
        at_most = hn::Or(at_most, hn::BitCast(du, hn::AndNot(hn::ShiftRight<31>(hn::Add(least, doubt)), bit)));
        e0 = hn::Add(e0, a[0]), e1 = hn::Add(e1, a[1]), e2 = hn::Add(e2, a[2]);
      }
      for (std::size_t k = 0; k < 3; ++k) row[k] = hn::Add(row[k], b[k]);
    }
    const auto one_row = hn::Sub(hn::Shl(hn::Set(du, 2), hn::And(hn::BitCast(du, columns), three)), hn::Set(du, 1));
    const auto beyond = hn::ShiftLeft<3>(hn::And(hn::Sub(three, hn::BitCast(du, rows)), three));
    const auto box = hn::And(hn::Mul(one_row, hn::Set(du, 0x01010101)), hn::Shr(hn::Set(du, ~0u), beyond));
    cover = hn::And(cover, box), at_most = hn::And(at_most, box);
    const std::uint32_t known = lanes & Bits(du, hn::Eq(cover, at_most));
    // Rows begin where they do in the cells, and become four bits each.
    cover = hn::Shl(cover, from_x);
    const auto pack = [&](hn::Vec<decltype(du)> bytes) HWY_ATTR {
      bytes = hn::And(bytes, hn::Set(du, 0x0F0F0F0F));
      bytes = hn::And(hn::Or(bytes, hn::ShiftRight<4>(bytes)), hn::Set(du, 0x00FF00FF));
      bytes = hn::And(hn::Or(bytes, hn::ShiftRight<8>(bytes)), hn::Set(du, 0xFFFF));
      return hn::Shl(bytes, hn::ShiftLeft<2>(from_y));
    };
    const auto left = pack(cover), right = pack(hn::ShiftRight<4>(cover));
    hn::Store(left, du, batch.cover[0] + lane);
    hn::Store(right, du, batch.cover[1] + lane);
    batch.tiny |= known << lane;
    batch.empty |= (known & Bits(du, hn::Eq(hn::Or(left, right), hn::Zero(du)))) << lane;
  }
}

// Edges and depth of the lanes that reach a sample.
HWY_NOINLINE void SetUpGroups(const DrawJob& job, bool of_fan, Batch& batch, Rungs& rungs) {
  const hn::CappedTag<float, kBatch> d;
  batch.small = batch.medium = batch.tiny = batch.empty = batch.thin = batch.slow_depth = batch.clip = batch.integer =
      0;
  batch.tie_lost[0] = batch.tie_lost[1] = batch.tie_lost[2] = batch.degenerate = batch.negative = 0;
  const DepthMode mode = job.draw->depth_mode;
  if (mode == DepthMode::clip) {
    // All W > 0 and 0 <= Z <= W at every vertex: then 0 <= z <= 1 wherever the triangle covers, and nothing is clipped.
    for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
      auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto z = hn::Load(d, batch.z[k] + lane);
        inside = hn::And(inside, hn::And(hn::Ge(z, hn::Zero(d)), hn::Le(z, hn::Load(d, batch.w[k] + lane))));
      }
      batch.clip |= Bits(d, inside) << lane;
    }
    batch.clip = ~(batch.clip & batch.front) & batch.reached;
  }
  const bool depth = job.depth || batch.clip != 0;
  Group group;
  for (group.lane = 0; group.lane < kBatch; group.lane += kGroup) {
    group.lanes = batch.reached >> group.lane & kGroupLanes;
    if (group.lanes == 0) continue;
    SetUpEdges(job, group, batch, rungs);
    if (depth) SetUpDepth(job, group, of_fan, batch);
  }
  if (batch.small != 0) CoverTiny(batch);
}

// Which lanes of a batch are drawn, once it is known which are degenerate: not culled.
std::uint32_t Drawn(const Draw& draw, const Batch& batch) {
  std::uint32_t drawn = batch.reached & ~batch.degenerate;
  const std::uint32_t front = draw.front_face == FrontFace::clockwise ? ~batch.negative : batch.negative;
  if (draw.cull != Cull::none) drawn &= draw.cull == Cull::front ? ~front : front;
  return drawn;
}

// Sets up the triangles [first, first + count) of the draw. Returns those that are drawn as they are.
std::uint32_t SetUpBatch(const DrawJob& job, std::uint32_t first, std::uint32_t count, Batch& batch, Rungs& rungs) {
  const Draw& draw = *job.draw;
  const std::uint32_t all = (1u << count) - 1;
  BatchVertices vertices{draw.vertices.data(), &draw.indices[std::size_t{3} * first]};
  std::uint32_t indices[3 * kBatch];
  for (std::uint32_t lane = 0; lane < kBatch; ++lane) batch.position[lane] = first + lane;
  if (HWY_UNLIKELY(count < kBatch)) {
    for (std::uint32_t lane = 0; lane < kBatch; ++lane) {
      std::memcpy(indices + 3 * lane, vertices.indices + 3 * (lane < count ? lane : 0), 3 * sizeof(std::uint32_t));
    }
    vertices.indices = indices;
  }
  LoadVertices(vertices, batch);
  batch.finite &= all;
  if (HWY_UNLIKELY(!AttributesFinite(draw, vertices.indices))) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      if (!attributes_are_finite(draw, first + lane)) batch.finite &= ~(1u << lane);
    }
  }
  batch.clipped = HWY_UNLIKELY(draw.grid.has_value()) ? Snap(*draw.grid, batch, rungs) & batch.finite : 0;
  SetUpBoxes(job, vertices, all, batch);
  SetUpGroups(job, false, batch, rungs);
  return Drawn(draw, batch);
}

// Where the polygon of a clipped triangle is a fan of triangles that all have one sign, sets them up, too; returns
// those that are drawn. False if they have not: then `turns` is set.
std::uint32_t SetUpFan(const DrawJob& job, std::uint32_t position, SnappedTriangle& snapped, Batch& fan, bool& turns,
                       Rungs& rungs) {
  const Draw& draw = *job.draw;
  std::uint32_t indices[3 * kBatch];
  for (std::size_t i = 0; i < 3 * kBatch; ++i) indices[i] = draw.indices[std::size_t{3} * position + i % 3];
  const BatchVertices vertices{draw.vertices.data(), indices};
  const int lanes = snapped.corners() - 2;
  turns = false;
  if (lanes < 1) return 0;
  LoadVertices(vertices, fan);
  for (std::size_t lane = 0; lane < kBatch; ++lane) {
    const int n = std::min(static_cast<int>(lane), lanes - 1);
    const int corners[3] = {0, n + 1, n + 2};
    fan.position[lane] = position;
    for (std::size_t k = 0; k < 3; ++k) {
      const SamplePosition corner = snapped.corner(corners[k]);
      fan.corner_x[k][lane] = corner.x, fan.corner_y[k][lane] = corner.y;
    }
    if (!job.depth && draw.depth_mode != DepthMode::clip) continue;
    const DepthRange& range = snapped.depth_range();
    fan.z_least[lane] = job.greater ? 0.0f - range.high : range.low;
    fan.z_most[lane] = job.greater ? 0.0f - range.low : range.high;
  }
  SetUpBoxes(job, vertices, (1u << lanes) - 1, fan);
  SetUpGroups(job, true, fan, rungs);
  // Those that reach no sample do not matter, nor do those without area.
  const std::uint32_t some = fan.reached & ~fan.degenerate;
  turns = (some & fan.negative) != 0 && (some & ~fan.negative) != 0;
  return Drawn(draw, fan) & ~fan.empty;
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_SET_UP_INL_HPP
