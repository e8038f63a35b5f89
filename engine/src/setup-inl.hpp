// SPDX-License-Identifier: Apache-2.0
//
// Batches of triangles: facing and boxes (phase one), edge functions as scaled integers and depth planes (phase two).
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_SETUP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_SETUP_INL_HPP
#undef SUREFILL_SRC_SETUP_INL_HPP
#else
#define SUREFILL_SRC_SETUP_INL_HPP
#endif

#include <cstring>

#include "bin.hpp"
#include "hwy/highway.h"
#include "planted.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Doubles, and floats and integers of as many lanes; a batch is kBatch / Lanes of them.
using DoubleTag = hn::CappedTag<double, kBatch>;
using FloatTag = hn::Rebind<float, DoubleTag>;
using IntTag = hn::Rebind<std::int32_t, DoubleTag>;
using Double = hn::Vec<DoubleTag>;
using Float = hn::Vec<FloatTag>;

// The vertices of a batch, vertex k of triangle l at [k][4 l].
struct BatchVertices {
  alignas(64) float v[3][4 * kBatch];

  void Load(const Draw& draw, std::uint32_t lane, std::uint32_t triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::memcpy(&v[k][4 * lane], &draw.vertices[draw.indices[std::size_t{3} * triangle + k]], sizeof(Vertex));
    }
  }
  Vertex Get(std::size_t k, std::uint32_t lane) const {
    return {v[k][4 * lane], v[k][4 * lane + 1], v[k][4 * lane + 2], v[k][4 * lane + 3]};
  }
};

// The low Lanes bits: which lanes are set.
template <class D, class M>
HWY_INLINE std::uint32_t Bits(D d, M mask) {
#if HWY_TARGET == HWY_AVX3
  (void)d;
  return static_cast<std::uint32_t>(mask.raw);
#elif HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return static_cast<std::uint32_t>(hn::detail::BitsFromMask(mask)) & ((1u << hn::Lanes(d)) - 1);
#else
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
#endif
}

// What a triangle of which all W > 0 reaches along one axis, as in reach() but in float32: division and subtraction are
// monotonic and the sample coordinates i + 1/2 are float32 values, so again no margin is needed. first, last: pixels,
// clamped to [begin, end); the box is empty if last < first.
HWY_INLINE void PixelRange(Float c0, Float c1, Float c2, Float w0, Float w1, Float w2, int begin, int end,
                           std::int32_t* first, std::int32_t* last) {
  const FloatTag d;
  const IntTag di;
  const Float q0 = hn::Div(c0, w0), q1 = hn::Div(c1, w1), q2 = hn::Div(c2, w2);
  const Float low = hn::Sub(hn::Min(hn::Min(q0, q1), q2), hn::Set(d, 0.5f));
  const Float high = hn::Sub(hn::Max(hn::Max(q0, q1), q2), hn::Set(d, 0.5f));
  const Float least = hn::Set(d, static_cast<float>(begin)), most = hn::Set(d, static_cast<float>(end));
  const Float f = hn::Ceil(hn::Min(hn::Max(low, least), most));
  const Float l = hn::Floor(hn::Max(hn::Min(high, hn::Sub(most, hn::Set(d, 1.0f))), hn::Sub(least, hn::Set(d, 1.0f))));
  hn::Store(hn::ConvertTo(di, f), di, first);
  hn::Store(hn::ConvertTo(di, l), di, last);
}

// Lanes of a batch that have the same state: one set of coordinates in double.
struct Corner {
  Float x, y, z, w;
};
HWY_INLINE Corner LoadCorner(const BatchVertices& vertices, std::size_t k, std::size_t lane) {
  const FloatTag d;
  Corner corner;
  hn::LoadInterleaved4(d, &vertices.v[k][4 * lane], corner.x, corner.y, corner.z, corner.w);
  return corner;
}

// Lanes where a W is not positive.
HWY_INLINE hn::Mask<FloatTag> MixedLanes(const Corner (&v)[3]) {
  const Float zero = hn::Zero(FloatTag());
  return hn::Not(hn::And(hn::And(hn::Gt(v[0].w, zero), hn::Gt(v[1].w, zero)), hn::Gt(v[2].w, zero)));
}

// Boxes of the lanes, in pixels: [x0, x1) x [y0, y1).
struct BatchBoxes {
  alignas(64) std::int32_t first_x[kBatch], last_x[kBatch], first_y[kBatch], last_y[kBatch];

  void Compute(const Corner (&v)[3], hn::Mask<FloatTag> mixed, std::size_t lane, const PixelBox& limits) {
    const FloatTag d;
    const Float one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    Float x[3], y[3], w[3];
    for (std::size_t k = 0; k < 3; ++k) {  // a division that is harmless, where the result is not used
      x[k] = hn::IfThenElse(mixed, zero, v[k].x);
      y[k] = hn::IfThenElse(mixed, zero, v[k].y);
      w[k] = hn::IfThenElse(mixed, one, v[k].w);
    }
    PixelRange(x[0], x[1], x[2], w[0], w[1], w[2], limits.x0, limits.x1, first_x + lane, last_x + lane);
    PixelRange(y[0], y[1], y[2], w[0], w[1], w[2], limits.y0, limits.y1, first_y + lane, last_y + lane);
  }
  PixelBox Get(std::size_t lane) const { return {first_x[lane], first_y[lane], last_x[lane] + 1, last_y[lane] + 1}; }
};

HWY_INLINE PixelBox MixedBox(const BatchVertices& vertices, std::uint32_t lane, const PixelBox& limits) {
  return screen_box(vertices.Get(0, lane), vertices.Get(1, lane), vertices.Get(2, lane), limits, 0.5, 0.5);
}

bool AttributesFinite(const Draw& draw, std::uint32_t triangle) {
  for (const AttributeArray& attribute : draw.attributes) {
    const std::size_t stride = attribute.stride != 0 ? attribute.stride : attribute.components;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* values = &attribute.values[draw.indices[std::size_t{3} * triangle + k] * stride];
      for (std::uint32_t c = 0; c < attribute.components; ++c) {
        if (!std::isfinite(values[c])) return false;
      }
    }
  }
  return true;
}

// Boxes of the triangles [first, first + count), count <= kBatch; empty if the triangle is dropped or reaches no
// sample.
void FindBoxes(const Draw& draw, bool check_attributes, std::uint32_t first, std::uint32_t count,
               const PixelBox& limits, PixelBox* out, Statistics& statistics) {
  const FloatTag df;
  BatchVertices vertices;
  for (std::uint32_t lane = 0; lane < kBatch; ++lane) vertices.Load(draw, lane, first + (lane < count ? lane : 0));
  BatchBoxes boxes;
  std::uint32_t finite = 0, mixed = 0;
  for (std::uint32_t lane = 0; lane < kBatch; lane += static_cast<std::uint32_t>(hn::Lanes(df))) {
    const Corner v[3] = {LoadCorner(vertices, 0, lane), LoadCorner(vertices, 1, lane), LoadCorner(vertices, 2, lane)};
    const auto largest = hn::Set(df, std::numeric_limits<float>::max());
    auto finite_lanes = hn::Le(hn::Abs(v[0].x), largest);
    for (const Corner& corner : v) {
      for (const Float c : {corner.x, corner.y, corner.z, corner.w}) {
        finite_lanes = hn::And(finite_lanes, hn::Le(hn::Abs(c), largest));
      }
    }
    const auto mixed_lanes = MixedLanes(v);
    boxes.Compute(v, hn::Or(mixed_lanes, hn::Not(finite_lanes)), lane, limits);
    finite |= Bits(df, finite_lanes) << lane;
    mixed |= Bits(df, mixed_lanes) << lane;
  }
  statistics.triangles += count;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    out[lane] = {0, 0, 0, 0};
    if (!limits.empty()) {  // else the boxes may lie anywhere, up to the ends of int
      out[lane] = (mixed >> lane & 1) != 0 ? MixedBox(vertices, lane, limits) : boxes.Get(lane);
    }
    if ((finite >> lane & 1) == 0 || (check_attributes && !AttributesFinite(draw, first + lane))) {
      ++statistics.dropped;
      out[lane] = {0, 0, 0, 0};
    } else if (out[lane].empty()) {
      ++statistics.outside;
    }
  }
}

// Phase two: triangles of a batch, ready for their cells. All quantities are those of the triangle with D > 0: edges of
// a triangle with D < 0 are negated.
struct Batch {
  BatchVertices vertices;
  BatchBoxes boxes;
  alignas(64) double a[3][kBatch], b[3][kBatch], c[3][kBatch];
  // Small triangles, whose box lies within 4 x 4 cells: scaled so that max(|a|, |b|) is in [2^24, 2^25), and rounded,
  // with the value at the centre of the box's first cell's first sample.
  alignas(64) std::int32_t small_a[3][kBatch], small_b[3][kBatch], small_e[3][kBatch];
  // Depth at that sample, its steps, and a bound of the error at any sample of the box; smaller is nearer (negated for
  // greater).
  alignas(64) double z[kBatch], z_x[kBatch], z_y[kBatch], z_error[kBatch];
  std::uint32_t live, small, slow_depth, clip, negative, degenerate;

  // The first sample of the first cell.
  int OriginX(std::size_t lane) const { return boxes.first_x[lane] & ~3; }
  int OriginY(std::size_t lane) const { return boxes.first_y[lane] & ~3; }
};

// A power of two that brings max(|a|, |b|) into [2^exponent, 2^(exponent + 1)). Where both are 0 (a constant edge, c !=
// 0), one that makes c huge.
HWY_INLINE Double Scale(Double a, Double b, int exponent) {
  const DoubleTag d;
  const hn::RebindToUnsigned<DoubleTag> du;
  const Double largest = hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Set(d, 0x1p-400));
  const auto field = hn::And(hn::BitCast(du, largest), hn::Set(du, 0x7FF0000000000000u));
  return hn::BitCast(d, hn::Sub(hn::Set(du, static_cast<std::uint64_t>(2046 + exponent) << 52), field));
}

HWY_INLINE hn::Vec<IntTag> RoundToInt(Double v) {
  return hn::DemoteTo(IntTag(), hn::Round(v));
}

constexpr double kEdgeLimit = 0x1p30;  // beyond it, no step within 64 samples changes the sign
constexpr int kSmallExponent = 24;     // 15 * 2 * 2^25 < 2^30
constexpr int kTileExponent = 22;      // 63 * 2 * 2^23 < 2^30
// Bounds of the total rounding in units: half a unit for each coefficient times the steps (15 and 63 each way), half
// for the start, and less than 2^-8 for the double arithmetic before (docs/precision.md).
constexpr std::int32_t kSmallBound = 16, kTileBound = 64;

// The signs of D in the uncertain lanes, exactly; degenerate lanes are noted in batch.degenerate.
HWY_NOINLINE hn::Mask<DoubleTag> ExactSigns(Batch& batch, std::uint32_t first_lane, std::uint32_t uncertain,
                                            hn::Mask<DoubleTag> negative, Statistics& statistics) {
  const DoubleTag dd;
  alignas(64) double signs[kBatch];
  hn::Store(hn::IfThenElse(negative, hn::Set(dd, -1.0), hn::Set(dd, 1.0)), dd, signs);
  for (uncertain &= batch.live; uncertain != 0; uncertain &= uncertain - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(uncertain));
    const EdgeFunction edge(batch.vertices.Get(1, lane), batch.vertices.Get(2, lane));
    const int sign = determinant_sign(edge, batch.vertices.Get(0, lane), statistics);
    signs[lane - first_lane] = sign < 0 ? -1 : 1;
    if (sign == 0) batch.degenerate |= 1u << lane;
  }
  return hn::Lt(hn::Load(dd, signs), hn::Zero(dd));
}

// Takes degenerate and culled lanes out of batch.live (C1, F2). Each triangle is counted in its home bin, the one its
// box begins in.
HWY_INLINE void CullAndCount(const BinJob& job, const BinEntry* entries, std::uint32_t count, Batch& batch,
                             Statistics& statistics) {
  const std::uint32_t all = (1u << count) - 1;
  const Draw& draw = *job.draw;
  std::uint32_t culled = 0;
  if (draw.cull != Cull::none) {
    const std::uint32_t front = draw.front_face == FrontFace::clockwise ? ~batch.negative : batch.negative;
    culled = (draw.cull == Cull::front ? front : ~front) & all & ~batch.degenerate;
  }
  std::uint32_t home = 0;
  for (std::uint32_t lane = 0; lane < count; ++lane) home |= static_cast<std::uint32_t>(entries[lane].home) << lane;
  const auto ones = [home](std::uint32_t lanes) {
    return static_cast<std::uint64_t>(__builtin_popcount(lanes & home));
  };
  statistics.degenerate += ones(batch.degenerate);
  statistics.culled += ones(culled);
  statistics.rasterized += ones(all & ~batch.degenerate & ~culled);
  batch.live &= ~(batch.degenerate | culled);
}

// Sets up `count` entries. Lanes whose box in the region is empty are not live.
HWY_NOINLINE void SetUp(const BinJob& job, const BinEntry* entries, std::uint32_t count, bool depth, Batch& batch,
                        Statistics& statistics) {
  const DoubleTag dd;
  const FloatTag df;
  const IntTag di;
  const Draw& draw = *job.draw;
  for (std::uint32_t lane = 0; lane < kBatch; ++lane) {
    const std::uint32_t from = SUREFILL_PLANT(batch_lane) && lane == 5 ? 4 : lane;
    batch.vertices.Load(draw, lane, job.chunk_begin + entries[lane < count ? from : 0].number);
  }
  batch.live = (1u << count) - 1;
  batch.small = batch.slow_depth = batch.clip = batch.negative = batch.degenerate = 0;

  for (std::uint32_t lane = 0; lane < kBatch; lane += static_cast<std::uint32_t>(hn::Lanes(dd))) {
    const Corner v[3] = {LoadCorner(batch.vertices, 0, lane), LoadCorner(batch.vertices, 1, lane),
                         LoadCorner(batch.vertices, 2, lane)};
    const auto zero = hn::Zero(df);
    const auto mixed_lanes =
        hn::Not(hn::And(hn::And(hn::Gt(v[0].w, zero), hn::Gt(v[1].w, zero)), hn::Gt(v[2].w, zero)));
    batch.boxes.Compute(v, mixed_lanes, lane, job.region);
    for (std::uint32_t m = Bits(df, mixed_lanes); m != 0; m &= m - 1) {
      const auto l = lane + static_cast<std::uint32_t>(__builtin_ctz(m));
      const PixelBox box = MixedBox(batch.vertices, l, job.region);
      batch.boxes.first_x[l] = box.x0, batch.boxes.last_x[l] = box.x1 - 1;
      batch.boxes.first_y[l] = box.y0, batch.boxes.last_y[l] = box.y1 - 1;
    }
    const auto first_x = hn::Load(di, batch.boxes.first_x + lane), last_x = hn::Load(di, batch.boxes.last_x + lane);
    const auto first_y = hn::Load(di, batch.boxes.first_y + lane), last_y = hn::Load(di, batch.boxes.last_y + lane);
    const auto origin_x = hn::AndNot(hn::Set(di, 3), first_x), origin_y = hn::AndNot(hn::Set(di, 3), first_y);
    const auto reach_x = hn::Sub(last_x, origin_x), reach_y = hn::Sub(last_y, origin_y);
    const auto empty = hn::Or(hn::Lt(last_x, first_x), hn::Lt(last_y, first_y));
    const auto is_small = hn::Lt(hn::Max(reach_x, reach_y), hn::Set(di, 16));
    batch.live &= ~(Bits(di, empty) << lane);
    batch.small |= Bits(di, is_small) << lane;

    // Edge functions at the origin, and D = sum W_i E_i taken there, where little cancels.
    const Double half = hn::Set(dd, 0.5), bound = hn::Set(dd, kEdgeErrorBound);
    const Double px = hn::Add(hn::PromoteTo(dd, origin_x), half), py = hn::Add(hn::PromoteTo(dd, origin_y), half);
    Double x[3], y[3], w[3], a[3], b[3], c[3], e[3], error[3], det = hn::Zero(dd), det_error = det;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = hn::PromoteTo(dd, v[k].x);
      y[k] = hn::PromoteTo(dd, v[k].y);
      w[k] = hn::PromoteTo(dd, v[k].w);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      a[i] = hn::Sub(hn::Mul(y[j], w[k]), hn::Mul(w[j], y[k]));
      b[i] = hn::Sub(hn::Mul(w[j], x[k]), hn::Mul(x[j], w[k]));
      c[i] = hn::Sub(hn::Mul(x[j], y[k]), hn::Mul(y[j], x[k]));
      const Double ax = hn::Mul(a[i], px), by = hn::Mul(b[i], py);
      e[i] = hn::Add(hn::Add(ax, by), c[i]);
      error[i] = hn::Mul(bound, hn::Add(hn::Add(hn::Abs(ax), hn::Abs(by)), hn::Abs(c[i])));
      const Double we = hn::Mul(w[i], e[i]);
      det = hn::Add(det, we);
      det_error = hn::Add(det_error, hn::Add(hn::Mul(hn::Abs(w[i]), error[i]), hn::Mul(bound, hn::Abs(we))));
    }

    // The sign of D: by its bound, else lane by lane. Edges of a triangle with D < 0 are negated, and so is det.
    auto negative = hn::Lt(det, hn::Zero(dd));
    const std::uint32_t uncertain = Bits(dd, hn::Not(hn::Gt(hn::Abs(det), det_error))) << lane;
    if (HWY_UNLIKELY((uncertain & batch.live) != 0))
      negative = ExactSigns(batch, lane, uncertain, negative, statistics);
    batch.negative |= Bits(dd, negative) << lane;
    const Double d_sign = hn::IfThenElse(negative, hn::Set(dd, -1.0), hn::Set(dd, 1.0));
    det = hn::Mul(det, d_sign);
    const Double limit = hn::Set(dd, kEdgeLimit);
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = hn::Mul(a[i], d_sign);
      b[i] = hn::Mul(b[i], d_sign);
      e[i] = hn::Mul(e[i], d_sign);
      const Double s = Scale(a[i], b[i], kSmallExponent);
      hn::Store(RoundToInt(hn::Mul(a[i], s)), di, batch.small_a[i] + lane);
      hn::Store(RoundToInt(hn::Mul(b[i], s)), di, batch.small_b[i] + lane);
      hn::Store(RoundToInt(hn::Max(hn::Min(hn::Mul(e[i], s), limit), hn::Neg(limit))), di, batch.small_e[i] + lane);
      hn::Store(a[i], dd, batch.a[i] + lane);
      hn::Store(b[i], dd, batch.b[i] + lane);
      hn::Store(hn::Mul(c[i], d_sign), dd, batch.c[i] + lane);
    }
    if (!depth) continue;

    // The depth plane about the origin: z = sum Z_i E_i / D.
    Double z = hn::Zero(dd), zx = z, zy = z, z_error = z, zx_size = z, zy_size = z;
    for (std::size_t i = 0; i < 3; ++i) {
      const Double depth_i = hn::PromoteTo(dd, v[i].z), ze = hn::Mul(depth_i, e[i]);
      const Double za = hn::Mul(depth_i, a[i]), zb = hn::Mul(depth_i, b[i]);
      z = hn::Add(z, ze);
      zx = hn::Add(zx, za);
      zy = hn::Add(zy, zb);
      z_error = hn::Add(z_error, hn::Add(hn::Mul(hn::Abs(depth_i), error[i]), hn::Mul(bound, hn::Abs(ze))));
      zx_size = hn::Add(zx_size, hn::Abs(za));
      zy_size = hn::Add(zy_size, hn::Abs(zb));
    }
    const Double smallest = hn::Sub(det, det_error);  // D is at least this; if it is not positive, nothing is known
    const Double inverse = hn::Div(hn::Set(dd, 1.0), det);
    z = hn::Mul(z, inverse);
    zx = hn::Mul(zx, inverse);
    zy = hn::Mul(zy, inverse);
    const Double rx = hn::PromoteTo(dd, reach_x), ry = hn::PromoteTo(dd, reach_y);
    // |z_real - z| at any sample of the box: numerators, determinant, and the rounding of the evaluation itself.
    const Double size = hn::Add(hn::Abs(z), hn::Add(hn::Mul(hn::Abs(zx), rx), hn::Mul(hn::Abs(zy), ry)));
    const Double steps = hn::Mul(bound, hn::Add(hn::Mul(zx_size, rx), hn::Mul(zy_size, ry)));
    const Double numerators = hn::Add(hn::Add(z_error, steps), hn::Mul(size, det_error));
    const Double total = hn::Mul(hn::Add(hn::Div(numerators, smallest), hn::Mul(bound, size)),
                                 hn::Set(dd, SUREFILL_PLANT(depth_bound) ? 0x1p-8 : 1 + 0x1p-20));
    const auto known = hn::And(hn::Gt(smallest, hn::Zero(dd)), hn::Lt(hn::Add(size, total), hn::Set(dd, 1e38)));
    batch.slow_depth |= Bits(dd, hn::Not(known)) << lane;
    const Double direction = hn::Set(dd, job.greater ? -1.0 : 1.0);
    hn::Store(hn::Mul(z, direction), dd, batch.z + lane);
    hn::Store(hn::Mul(zx, direction), dd, batch.z_x + lane);
    hn::Store(hn::Mul(zy, direction), dd, batch.z_y + lane);
    hn::Store(total, dd, batch.z_error + lane);
    // All W > 0 and 0 <= Z <= W at every vertex: then 0 <= z <= 1 wherever the triangle covers, and there is nothing to
    // clip or clamp.
    auto inside = hn::Not(mixed_lanes);
    for (const Corner& corner : v)
      inside = hn::And(inside, hn::And(hn::Ge(corner.z, zero), hn::Le(corner.z, corner.w)));
    batch.clip |= Bits(df, hn::Not(inside)) << lane;
  }
  CullAndCount(job, entries, count, batch, statistics);
  batch.small &= batch.live;
  if (draw.depth_mode == DepthMode::none) batch.clip = 0;
}

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_SETUP_INL_HPP
