// SPDX-License-Identifier: Apache-2.0
//
// Eight triangles of a draw become a batch: boxes, facing, edge functions as scaled integers, depth planes.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_SETUP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_SETUP_INL_HPP
#undef SUREFILL_SRC_SETUP_INL_HPP
#else
#define SUREFILL_SRC_SETUP_INL_HPP
#endif

#include "edges-inl.hpp"
#include "grid-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// The samples of the region that the triangles in lanes lane ... can cover. Grid: of the snapped corners.
HWY_INLINE void SetUpBoxes(const DrawJob& job, const BatchVertices& vertices, const Corner (&v)[3],
                           hn::Mask<FloatTag> front, std::uint32_t all, std::uint32_t lane, Batch& batch) {
  const FloatTag df;
  const PixelBox& region = job.region;
  std::int32_t *const first_x = batch.first_x + lane, *const last_x = batch.last_x + lane;
  std::int32_t *const first_y = batch.first_y + lane, *const last_y = batch.last_y + lane;
  if (HWY_UNLIKELY(job.draw->grid.has_value())) {
    SnappedRange(batch.corner_x, lane, job.sample.x, region.x0, region.x1, first_x, last_x);
    SnappedRange(batch.corner_y, lane, job.sample.y, region.y0, region.y1, first_y, last_y);
    return;
  }
  Float bx[3], by[3], bw[3];
  for (std::size_t k = 0; k < 3; ++k) {  // a division that is harmless, where the result is not used
    bx[k] = v[k].x, by[k] = v[k].y;
    bw[k] = hn::IfThenElse(front, v[k].w, hn::Set(df, 1.0f));
  }
  const bool over = job.draw->conservative == Conservative::over;
  if (HWY_UNLIKELY(over)) {
    TouchedRange(bx[0], bx[1], bx[2], bw[0], bw[1], bw[2], region.x0, region.x1, first_x, last_x);
    TouchedRange(by[0], by[1], by[2], bw[0], bw[1], bw[2], region.y0, region.y1, first_y, last_y);
  } else {
    PixelRange(bx[0], bx[1], bx[2], bw[0], bw[1], bw[2], job.sample.x, region.x0, region.x1, first_x, last_x);
    PixelRange(by[0], by[1], by[2], bw[0], bw[1], bw[2], job.sample.y, region.y0, region.y1, first_y, last_y);
  }
  std::uint32_t mixed = Bits(df, hn::Not(front)) & (all >> lane);
  for (; HWY_UNLIKELY(mixed != 0); mixed &= mixed - 1) {
    const auto l = lane + static_cast<std::uint32_t>(__builtin_ctz(mixed));
    const Vertex &v0 = vertices.of(l, 0), &v1 = vertices.of(l, 1), &v2 = vertices.of(l, 2);
    const bool numbers = AllFinite(v0) && AllFinite(v1) && AllFinite(v2);
    const PixelBox box = !numbers ? region
                                  : screen_box(v0, v1, v2, region, over ? 0 : std::min(job.sample.x, job.sample.y),
                                               over ? 1 : std::max(job.sample.x, job.sample.y));
    batch.first_x[l] = box.x0, batch.last_x[l] = box.x1 - 1;
    batch.first_y[l] = box.y0, batch.last_y[l] = box.y1 - 1;
  }
}

// The edges of lanes lane ... as integers, scaled so that all steps stay exact; positive inside. Conservative: each
// edge moved by half a pixel each way, outwards (over) or inwards (inner), so that the pixel's centre tells of its
// square. For over, the square must also meet the box, which is exact (docs/precision.md).
HWY_INLINE void StoreEdges(const DrawJob& job, Edges& edges, hn::Vec<IntTag> cell_span, hn::Mask<DoubleTag> integer,
                           const Double (&scale)[3], std::uint32_t all, std::uint32_t lane, Batch& batch) {
  const DoubleTag dd;
  const IntTag di;
  const TieShift shift = job.shift;
  const Conservative conservative = job.draw->conservative;
  const auto is_small = hn::Lt(cell_span, hn::Set(di, 16));
  const auto small_bound = hn::Set(di, SUREFILL_PLANT(small_bound) ? 2 : kSmallBound);
  const auto rounded_bound =
      kExactCoverage ? hn::IfThenElse(is_small, small_bound, hn::Set(di, kTileBound)) : hn::Zero(di);
  const bool any_integer = !hn::AllFalse(dd, integer);
  const auto edge_bound = HWY_UNLIKELY(any_integer)
                              ? hn::DemoteTo(di, hn::IfThenZeroElse(integer, hn::PromoteTo(dd, rounded_bound)))
                              : rounded_bound;
  if (HWY_UNLIKELY(conservative != Conservative::none)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Double half = hn::Mul(hn::Add(hn::Abs(edges.a[i]), hn::Abs(edges.b[i])),
                                  hn::Set(dd, conservative == Conservative::over ? 0.5 : -0.5));
      edges.e[i] = hn::Add(edges.e[i], half);
      edges.c[i] = hn::Add(edges.c[i], half);
    }
  }
  const auto doubt = hn::Add(edge_bound, edge_bound);
  hn::Store(doubt, di, batch.doubt + lane);
  const Double limit = hn::Set(dd, kEdgeLimit);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto step_x = RoundToInt(hn::Mul(edges.a[i], scale[i])), step_y = RoundToInt(hn::Mul(edges.b[i], scale[i]));
    hn::Store(step_x, di, batch.a[i] + lane);
    hn::Store(step_y, di, batch.b[i] + lane);
    const auto none = hn::Zero(di), most = hn::Add(hn::Max(step_x, none), hn::Max(step_y, none));
    hn::Store(hn::Add(hn::Add(most, hn::Add(most, most)), doubt), di, batch.most[i] + lane);
    const Double start = hn::Max(hn::Min(hn::Mul(edges.e[i], scale[i]), limit), hn::Neg(limit));
    auto value = hn::Sub(RoundToInt(start), edge_bound);
    if (HWY_UNLIKELY(any_integer)) {
      // Inside if E > 0, or E = 0 and the tie goes to this triangle: floor(E) >= 0, with a little taken off if it
      // does not.
      const Double along_x = hn::Mul(edges.a[i], hn::Set(dd, shift.x)),
                   along_y = hn::Mul(edges.b[i], hn::Set(dd, shift.y));
      const Double decides = shift.y_dominates ? along_y : along_x,
                   else_decides = shift.y_dominates ? along_x : along_y;
      auto inside = hn::Or(hn::Gt(decides, hn::Zero(dd)),
                           hn::And(hn::Eq(decides, hn::Zero(dd)), hn::Gt(else_decides, hn::Zero(dd))));
      if (conservative != Conservative::none) inside = hn::Eq(decides, decides);  // T and the squares are closed
      const Double floor = hn::Floor(hn::Add(start, hn::IfThenZeroElse(inside, hn::Set(dd, -kTieStep))));
      value = hn::DemoteTo(di, hn::IfThenElse(integer, floor, hn::PromoteTo(dd, value)));
    }
    hn::Store(value, di, batch.e[i] + lane);
  }
  if ((~batch.small & all) >> lane != 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      hn::Store(edges.a[i], dd, batch.edge_a[i] + lane);
      hn::Store(edges.b[i], dd, batch.edge_b[i] + lane);
      hn::Store(edges.c[i], dd, batch.edge_c[i] + lane);
    }
  }
}

// The depth planes of lanes lane ... about the origin: z = sum Z_i E_i / D. z_magnitude stands for each |Z_i| in the
// bounds.
HWY_INLINE void StoreDepth(const DrawJob& job, const Corner (&v)[3], const Edges& edges, Double det, Double det_error,
                           Double z_magnitude, Double columns, Double rows, std::uint32_t lane, Batch& batch) {
  const DoubleTag dd;
  const FloatTag df;
  const Double bound = hn::Set(dd, kEdgeErrorBound);
  Double z = hn::Zero(dd), zx = z, zy = z, edge_error = z, x_size = z, y_size = z;
  for (std::size_t i = 0; i < 3; ++i) {
    const Double depth_i = hn::PromoteTo(dd, v[i].z);
    z = hn::Add(z, hn::Mul(depth_i, edges.e[i]));
    zx = hn::Add(zx, hn::Mul(depth_i, edges.a[i]));
    zy = hn::Add(zy, hn::Mul(depth_i, edges.b[i]));
    edge_error = hn::Add(edge_error, edges.error[i]);
    x_size = hn::Add(x_size, hn::Abs(edges.a[i]));
    y_size = hn::Add(y_size, hn::Abs(edges.b[i]));
  }
  const Double smallest = hn::Sub(hn::Abs(det), det_error);  // |D| is at least this; not positive: nothing is known
  const Double inverse = hn::Div(hn::Set(dd, 1.0), det);
  z = hn::Mul(z, inverse);
  zx = hn::Mul(zx, inverse);
  zy = hn::Mul(zy, inverse);
  // |z_real - z| at any sample of the box: numerators, determinant, and the rounding of the evaluation itself. An
  // edge's error is at least `bound` times its value: twice that error bounds a product with it.
  const Double size = hn::Add(hn::Abs(z), hn::Add(hn::Mul(hn::Abs(zx), columns), hn::Mul(hn::Abs(zy), rows)));
  const Double steps = hn::Mul(bound, hn::Add(hn::Mul(x_size, columns), hn::Mul(y_size, rows)));
  const Double numerators =
      hn::Add(hn::Mul(z_magnitude, hn::Add(hn::Add(edge_error, edge_error), steps)), hn::Mul(size, det_error));
  // The first sample of an area may lie 63 samples before the origin, on the way to which sums can be larger.
  const Double slopes = hn::Add(hn::Abs(zx), hn::Abs(zy)), way = hn::Mul(hn::Set(dd, 63.0), slopes);
  const Double evaluation = hn::Mul(hn::Set(dd, 2 * kEdgeErrorBound), hn::Add(size, way));
  const Double total = hn::Mul(hn::Add(hn::Div(numerators, smallest), evaluation),
                               hn::Set(dd, SUREFILL_PLANT(depth_bound) ? 0x1p-8 : 1 + 0x1p-20));
  const auto known =
      hn::And(hn::Gt(smallest, hn::Zero(dd)), hn::Lt(hn::Add(hn::Add(size, way), total), hn::Set(dd, 1e37)));
  batch.slow_depth |= Bits(dd, hn::Not(known)) << lane;
  const Double direction = hn::Set(dd, job.greater ? -0.0 : 0.0);
  z = hn::Xor(z, direction), zx = hn::Xor(zx, direction), zy = hn::Xor(zy, direction);
  hn::Store(z, dd, batch.z + lane);
  hn::Store(zx, dd, batch.z_x + lane);
  hn::Store(zy, dd, batch.z_y + lane);
  hn::Store(total, dd, batch.z_error + lane);
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
  hn::Store(hn::DemoteTo(df, hn::IfThenZeroElse(zero, splitter.Error(total))), df, batch.low_error + lane);
}

// Lanes that SetUp counts.
struct FoundLanes {
  std::uint32_t counted = 0, finite = 0, reached = 0, degenerate = 0, culled = 0, drawn = 0;
};

// Which of some lanes have boxes that meet a band of the set, and of which it is the first band. Without a branch for
// each: whose a triangle is cannot be guessed.
struct OwnedLanes {
  std::uint32_t any = 0, first = 0;

  OwnedLanes(const BandSet& bands, const Batch& batch, std::uint32_t lane, std::uint32_t lanes) {
    for (std::uint32_t l = 0; l < lanes; ++l) {
      const auto begin = static_cast<std::uint32_t>(batch.first_y[lane + l]) >> kTileLog2,
                 end = static_cast<std::uint32_t>(batch.last_y[lane + l]) >> kTileLog2;
      const auto owns = [&bands](std::uint32_t band) {
        return static_cast<std::uint32_t>(bands.owned[band >> 6 & 3] >> (band & 63)) & 1;
      };
      first |= owns(begin) << l;
      any |= (owns(begin) | owns(end) | static_cast<std::uint32_t>(end - begin > 1)) << l;
    }
  }
};

// Everything in a batch but its position in the draw and, under Grid, its corners. `all`: the lanes to be set up.
HWY_NOINLINE FoundLanes Build(const DrawJob& job, const BandSet& bands, const BatchVertices& vertices,
                              std::uint32_t all, Batch& batch, Statistics& statistics) {
  const DoubleTag dd;
  const hn::RebindToUnsigned<DoubleTag> du;
  const FloatTag df;
  const IntTag di;
  const Draw& draw = *job.draw;
  const bool grid = draw.grid.has_value();
  FoundLanes found;
  batch.small = batch.tiny = batch.medium = batch.slow_depth = batch.clip = batch.negative = 0;
  // Each triangle is counted by the set that owns its first band; where boxes do not tell, or draws are skipped by some
  // sets, by the first set.
  const bool by_band = !bands.all && !grid && !draw.culling_box;

  constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));
  for (std::uint32_t lane = 0; lane < kBatch; lane += kLanes) {
    const Corner v[3] = {LoadCorner(df, vertices, lane, 0), LoadCorner(df, vertices, lane, 1),
                         LoadCorner(df, vertices, lane, 2)};
    const Float zero = hn::Zero(df);
    const auto front = hn::And(hn::And(hn::Gt(v[0].w, zero), hn::Gt(v[1].w, zero)), hn::Gt(v[2].w, zero));
    SetUpBoxes(job, vertices, v, front, all, lane, batch);
    const auto first_x = hn::Load(di, batch.first_x + lane), last_x = hn::Load(di, batch.last_x + lane);
    const auto first_y = hn::Load(di, batch.first_y + lane), last_y = hn::Load(di, batch.last_y + lane);
    const auto empty = hn::Or(hn::Lt(last_x, first_x), hn::Lt(last_y, first_y));
    const std::uint32_t group = (all >> lane) & ((1u << kLanes) - 1);
    std::uint32_t here = ~Bits(di, empty) & group, counted = bands.first ? group : 0;
    if (by_band) {
      const OwnedLanes owned(bands, batch, lane, kLanes);
      counted = (bands.first ? group & ~here : 0) | (here & owned.first);
      here &= owned.any;
    }
    found.counted |= counted << lane;
    found.reached |= here << lane;
    if (here == 0) {
      for (std::uint32_t rest = by_band ? counted : group; rest != 0; rest &= rest - 1) {
        const std::uint32_t l = lane + static_cast<std::uint32_t>(__builtin_ctz(rest));
        const bool finite =
            AllFinite(vertices.of(l, 0)) && AllFinite(vertices.of(l, 1)) && AllFinite(vertices.of(l, 2));
        found.finite |= static_cast<std::uint32_t>(finite) << l;
      }
      continue;
    }

    // Classes, and where each lane's origin is.
    const auto three = hn::Set(di, 3), seven = hn::Set(di, 7);
    const auto cell_span =
        hn::Max(hn::Sub(last_x, hn::AndNot(three, first_x)), hn::Sub(last_y, hn::AndNot(three, first_y)));
    const auto block_span =
        hn::Max(hn::Sub(last_x, hn::AndNot(seven, first_x)), hn::Sub(last_y, hn::AndNot(seven, first_y)));
    const auto is_small = hn::Lt(cell_span, hn::Set(di, 16));
    batch.small |= Bits(di, is_small) << lane;
    const auto span = hn::Max(hn::Sub(last_x, first_x), hn::Sub(last_y, first_y));
    batch.tiny |= Bits(di, hn::Lt(span, hn::Set(di, 2))) << lane;
    batch.medium |= Bits(di, hn::Lt(block_span, hn::Set(di, kTileSize))) << lane;
    const auto low_bits = hn::IfThenElse(is_small, three, seven);
    const auto origin_x = hn::AndNot(low_bits, first_x), origin_y = hn::AndNot(low_bits, first_y);

    const Double px = hn::Add(hn::PromoteTo(dd, origin_x), hn::Set(dd, job.sample.x));
    const Double py = hn::Add(hn::PromoteTo(dd, origin_y), hn::Set(dd, job.sample.y));
    Double x[3], y[3], w[3], det, det_error;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = hn::PromoteTo(dd, v[k].x);
      y[k] = hn::PromoteTo(dd, v[k].y);
      w[k] = hn::PromoteTo(dd, v[k].w);
    }
    Edges edges;
    HomogeneousEdges(x, y, w, px, py, edges);
    Determinant(w, edges, det, det_error);

    // NaN and infinity (B1): of X, Y and W they reach every coefficient that they enter, and so det, which no finite
    // input can overflow.
    Double z_magnitude = hn::Zero(dd);
    for (const Corner& corner : v) z_magnitude = hn::Add(z_magnitude, hn::Abs(hn::PromoteTo(dd, corner.z)));
    const std::uint32_t finite_lanes =
        Bits(dd, hn::Lt(hn::Add(hn::Abs(det), z_magnitude), hn::Set(dd, std::numeric_limits<double>::infinity())));
    found.finite |= finite_lanes << lane;
    if (HWY_UNLIKELY(grid)) {
      for (std::size_t k = 0; k < 3; ++k) w[k] = hn::Set(dd, 1.0);
      SnappedEdges(batch, lane, px, py, edges);
      Determinant(w, edges, det, det_error);
    }

    // The sign of D: by its bound, else lane by lane. Edges of a triangle with D < 0 are negated, and so is det.
    auto is_negative = hn::Lt(det, hn::Zero(dd));
    const std::uint32_t uncertain = Bits(dd, hn::Not(hn::Gt(hn::Abs(det), det_error))) & here & finite_lanes;
    if (HWY_UNLIKELY(uncertain != 0)) {
      std::uint32_t flat = 0;
      is_negative = grid ? SnappedSigns(*draw.grid, batch, lane, uncertain, is_negative, flat)
                         : ExactSigns(draw, batch.first + lane, uncertain, counted, is_negative, flat, statistics);
      found.degenerate |= flat << lane;
    }
    batch.negative |= Bits(dd, is_negative) << lane;
    const Double d_sign = hn::IfThenElse(is_negative, hn::Set(dd, -0.0), hn::Zero(dd));
    Double scale[3];
    const auto exponent =
        hn::Add(hn::Set(du, static_cast<std::uint64_t>(2046 + kTileExponent) << 52),
                hn::IfThenElseZero(hn::RebindMask(du, hn::Lt(hn::PromoteTo(dd, cell_span), hn::Set(dd, 16.0))),
                                   hn::Set(du, static_cast<std::uint64_t>(kSmallExponent - kTileExponent) << 52)));
    for (std::size_t i = 0; i < 3; ++i) scale[i] = Scale(edges.a[i], edges.b[i], exponent);
    hn::Mask<DoubleTag> integer = hn::Lt(det, det);
    if (kExactCoverage) {
      const Double as = hn::Mul(edges.a[0], scale[0]);
      if (grid) {
        integer = SnappedIntegers(*draw.grid, edges, scale);
      } else if ((Bits(dd, hn::Eq(hn::Round(as), as)) & here) != 0) {
        integer = IntegerEdges(x, y, w, edges.a, edges.b, edges.c, scale);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      edges.a[i] = hn::Xor(edges.a[i], d_sign);
      edges.b[i] = hn::Xor(edges.b[i], d_sign);
      edges.c[i] = hn::Xor(edges.c[i], d_sign);
      edges.e[i] = hn::Xor(edges.e[i], d_sign);
    }
    const Double columns = hn::PromoteTo(dd, hn::Sub(last_x, origin_x)),
                 rows = hn::PromoteTo(dd, hn::Sub(last_y, origin_y));
    if (HWY_UNLIKELY(grid && job.depth)) {  // of the triangle as it was
      Edges unsnapped;
      for (std::size_t k = 0; k < 3; ++k) w[k] = hn::PromoteTo(dd, v[k].w);
      HomogeneousEdges(x, y, w, px, py, unsnapped);
      Double unsnapped_det, unsnapped_error;
      Determinant(w, unsnapped, unsnapped_det, unsnapped_error);
      StoreDepth(job, v, unsnapped, unsnapped_det, unsnapped_error, z_magnitude, columns, rows, lane, batch);
      if (batch.step != 0) StoreDepthRange(job, v, lane, batch);
    } else if (job.depth) {
      StoreDepth(job, v, edges, hn::Xor(det, d_sign), det_error, z_magnitude, columns, rows, lane, batch);
    }
    StoreEdges(job, edges, cell_span, integer, scale, all & found.reached, lane, batch);
    // All W > 0 and 0 <= Z <= W at every vertex: then 0 <= z <= 1 wherever the triangle covers, and there is nothing to
    // clip or clamp.
    if (!job.depth || draw.depth_mode == DepthMode::none) continue;
    auto inside = front;
    for (const Corner& corner : v)
      inside = hn::And(inside, hn::And(hn::Ge(corner.z, zero), hn::Le(corner.z, corner.w)));
    batch.clip |= Bits(df, hn::Not(inside)) << lane;
  }

  found.finite &= all;
  found.reached &= found.finite;
  if (draw.cull != Cull::none) {
    const std::uint32_t front = draw.front_face == FrontFace::clockwise ? ~batch.negative : batch.negative;
    found.culled = (draw.cull == Cull::front ? front : ~front) & found.reached & ~found.degenerate;
  }
  batch.live = found.drawn = found.reached & ~found.degenerate & ~found.culled;
  if (!bands.all && !by_band) batch.live &= OwnedLanes(bands, batch, 0, kBatch).any;
  return found;
}

// The fan of a clipped triangle's polygon, as a batch. False if its triangles do not all have one sign.
HWY_NOINLINE bool SetUpFan(const DrawJob& job, std::uint32_t position, SnappedTriangle& snapped, Batch& batch) {
  const Draw& draw = *job.draw;
  std::uint32_t indices[3 * kBatch];
  for (std::size_t i = 0; i < 3 * kBatch; ++i) indices[i] = draw.indices[std::size_t{3} * position + i % 3];
  const BatchVertices vertices{draw.vertices.data(), indices};
  const int lanes = snapped.corners() - 2;
  batch.live = 0;
  if (lanes < 1) return true;
  for (std::size_t lane = 0; lane < kBatch; ++lane) {
    const int n = std::min(static_cast<int>(lane), lanes - 1);
    const int corners[3] = {0, n + 1, n + 2};
    for (std::size_t k = 0; k < 3; ++k) {
      const SamplePosition corner = snapped.corner(corners[k]);
      batch.corner_x[k][lane] = corner.x, batch.corner_y[k][lane] = corner.y;
    }
    if (!job.depth) continue;
    const DepthRange& range = snapped.depth_range();
    batch.z_least[lane] = job.greater ? 0.0f - range.high : range.low;
    batch.z_most[lane] = job.greater ? 0.0f - range.low : range.high;
  }
  batch.first = position, batch.step = 0, batch.clipped = 0;
  Statistics unused;
  const FoundLanes found = Build(job, BandSet(), vertices, (1u << lanes) - 1, batch, unused);
  // Those that reach no sample do not matter, nor do those without area.
  const std::uint32_t some = found.reached & ~found.degenerate;
  return (some & batch.negative) == 0 || (some & ~batch.negative) == 0;
}

// Sets up the triangles [first, first + count) of the draw.
void SetUp(const DrawJob& job, const BandSet& bands, std::uint32_t first, std::uint32_t count, Batch& batch,
           Statistics& statistics) {
  const Draw& draw = *job.draw;
  const std::uint32_t all = (1u << count) - 1;
  BatchVertices vertices{draw.vertices.data(), &draw.indices[std::size_t{3} * first]};
  std::uint32_t indices[3 * kBatch];
  if (HWY_UNLIKELY(count < kBatch || SUREFILL_PLANT(batch_lane))) {
    for (std::uint32_t lane = 0; lane < kBatch; ++lane) {
      const std::uint32_t of = SUREFILL_PLANT(batch_lane) && lane == 5 ? 4 : lane;
      std::memcpy(indices + 3 * lane, vertices.indices + 3 * (of < count ? of : 0), 3 * sizeof(std::uint32_t));
    }
    vertices.indices = indices;
  }
  batch.first = first, batch.step = 1;
  Statistics not_counted;
  Statistics& of_grid = bands.first ? statistics : not_counted;
  batch.clipped = HWY_UNLIKELY(draw.grid.has_value()) ? Snap(*draw.grid, vertices, batch, of_grid) & all : 0;
  FoundLanes found = Build(job, bands, vertices, all, batch, statistics);
  if (HWY_UNLIKELY(!AttributesFinite(draw, vertices.indices))) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      if (!AttributesFinite(draw, first + lane)) found.finite &= ~(1u << lane);
    }
    found.reached &= found.finite;
    found.degenerate &= found.finite;
    found.culled &= found.finite;
    found.drawn &= found.finite;
    batch.live &= found.finite;
  }
  if (HWY_UNLIKELY(draw.grid.has_value())) {  // facing and emptiness are matters of the sample (G1)
    found.degenerate = found.culled = 0;
    batch.clipped &= found.finite;
    found.reached |= FindClipped(job, found.degenerate, batch, of_grid);
  }
  const std::uint32_t counted = found.counted;
  const auto ones = [counted](std::uint32_t lanes) {
    return static_cast<std::uint64_t>(__builtin_popcount(lanes & counted));
  };
  statistics.triangles += ones(all);
  statistics.dropped += ones(~found.finite);
  statistics.outside += ones(found.finite & ~found.reached & ~found.degenerate);
  statistics.degenerate += ones(found.degenerate);
  statistics.culled += ones(found.culled);
  statistics.rasterized += ones(found.reached & ~found.degenerate & ~found.culled);
  statistics.small += ones(found.drawn & batch.small);
  statistics.medium += ones(found.drawn & batch.medium & ~batch.small);
  statistics.large += ones(found.drawn & ~batch.medium & ~batch.small);
  statistics.clipped += ones(batch.clipped);
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_SETUP_INL_HPP
