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

#include <cstring>

#include "canvas.hpp"
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

// The three vertices of as many triangles as FloatTag has lanes.
struct Corner {
  Float x, y, z, w;
};

// vertices[l]: the vertex of lane l, four floats.
template <class D>
HWY_INLINE Corner LoadCorner(D d, const Vertex* const* vertices) {
  Corner corner;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) >= 4) {
    const hn::Repartition<double, D> d64;
    const auto row = [&](std::size_t l) {
      const hn::CappedTag<float, 4> d4;
      const auto low = hn::LoadU(d4, &vertices[l]->x);
      if constexpr (hn::MaxLanes(D()) == 8) {
        return hn::Combine(d, hn::LoadU(d4, &vertices[l + 4]->x), low);
      } else {
        return low;
      }
    };
    const auto r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    const auto xy01 = hn::BitCast(d64, hn::InterleaveLower(d, r0, r1));
    const auto xy23 = hn::BitCast(d64, hn::InterleaveLower(d, r2, r3));
    const auto zw01 = hn::BitCast(d64, hn::InterleaveUpper(d, r0, r1));
    const auto zw23 = hn::BitCast(d64, hn::InterleaveUpper(d, r2, r3));
    corner.x = hn::BitCast(d, hn::InterleaveLower(d64, xy01, xy23));
    corner.y = hn::BitCast(d, hn::InterleaveUpper(d64, xy01, xy23));
    corner.z = hn::BitCast(d, hn::InterleaveLower(d64, zw01, zw23));
    corner.w = hn::BitCast(d, hn::InterleaveUpper(d64, zw01, zw23));
    return corner;
  }
#endif
  alignas(16) float lanes[4 * hn::MaxLanes(D())];
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) std::memcpy(lanes + 4 * l, vertices[l], sizeof(Vertex));
  hn::LoadInterleaved4(d, lanes, corner.x, corner.y, corner.z, corner.w);
  return corner;
}

// What a triangle of which all W > 0 reaches along one axis, as in reach() but in float32: division and subtraction are
// monotonic and the sample coordinates i + offset are float32 values, so again no margin is needed. first, last:
// pixels, clamped to [begin, end); the box is empty if last < first.
HWY_INLINE void PixelRange(Float c0, Float c1, Float c2, Float w0, Float w1, Float w2, double offset, int begin,
                           int end, std::int32_t* first, std::int32_t* last) {
  const FloatTag d;
  const IntTag di;
  const Float q0 = hn::Div(c0, w0), q1 = hn::Div(c1, w1), q2 = hn::Div(c2, w2);
  const Float shift = hn::Set(d, static_cast<float>(offset));
  const Float low = hn::Sub(hn::Min(hn::Min(q0, q1), q2), shift);
  const Float high = hn::Sub(hn::Max(hn::Max(q0, q1), q2), shift);
  const Float least = hn::Set(d, static_cast<float>(begin)), most = hn::Set(d, static_cast<float>(end));
  const Float f = hn::Ceil(hn::Min(hn::Max(low, least), most));
  const Float l = hn::Floor(hn::Max(hn::Min(high, hn::Sub(most, hn::Set(d, 1.0f))), hn::Sub(least, hn::Set(d, 1.0f))));
  // Integers of at most 15 bits: the sum with 1.5 * 2^23 has them in its low bits.
  const Float magic = hn::Set(d, 0x1.8p23f);
  const auto bits = hn::BitCast(di, magic);
  hn::Store(hn::Sub(hn::BitCast(di, hn::Add(f, magic)), bits), di, first);
  hn::Store(hn::Sub(hn::BitCast(di, hn::Add(l, magic)), bits), di, last);
}

// Vertex k of a triangle of the draw.
inline const Vertex& VertexOf(const Draw& draw, std::uint32_t triangle, std::size_t k) {
  return draw.vertices[draw.indices[std::size_t{3} * triangle + k]];
}

inline bool AllFinite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

HWY_INLINE bool AttributesFinite(const Draw& draw, std::uint32_t triangle) {
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

// A power of two that brings max(|a|, |b|) into [2^exponent, 2^(exponent + 1)). Where both are 0 (a constant edge, c !=
// 0), one that makes c huge. exponent: added to 2046, in the exponent's place.
HWY_INLINE Double Scale(Double a, Double b, hn::Vec<hn::RebindToUnsigned<DoubleTag>> exponent) {
  const DoubleTag d;
  const hn::RebindToUnsigned<DoubleTag> du;
  const Double largest = hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Set(d, 0x1p-400));
  const auto field = hn::And(hn::BitCast(du, largest), hn::Set(du, 0x7FF0000000000000u));
  return hn::BitCast(d, hn::Sub(exponent, field));
}

// v to the nearest integer, for |v| <= 2^31: the sum with 1.5 * 2^52 has it in its low bits.
HWY_INLINE hn::Vec<IntTag> RoundToInt(Double v) {
  const hn::RebindToUnsigned<DoubleTag> du;
  const hn::RebindToUnsigned<IntTag> du32;
  return hn::BitCast(IntTag(), hn::TruncateTo(du32, hn::BitCast(du, hn::Add(v, hn::Set(DoubleTag(), 0x1.8p52)))));
}

constexpr double kEdgeLimit = 0x1p30;  // beyond it, no step within 64 samples changes the sign
constexpr int kSmallExponent = 24;     // 15 * 2 * 2^25 < 2^30
constexpr int kTileExponent = 22;      // 63 * 2 * 2^23 < 2^30
// Bounds of the total rounding in units: half a unit for each coefficient times the steps (15 and 63 each way), half
// for the start, and less than 2^-8 for the double arithmetic before (docs/precision.md).
constexpr std::int32_t kSmallBound = 16, kTileBound = 64;

// p - q == r without rounding error, lane by lane, for r computed as p - q.
HWY_INLINE hn::Mask<DoubleTag> DifferenceIsExact(Double p, Double q, Double r) {
  return hn::And(hn::Eq(hn::Sub(p, r), q), hn::Eq(hn::Add(r, q), p));
}

// The signs of D in the uncertain lanes, exactly; `degenerate` gets the lanes where it is 0.
HWY_NOINLINE hn::Mask<DoubleTag> ExactSigns(const Draw& draw, std::uint32_t first, std::uint32_t uncertain,
                                            hn::Mask<DoubleTag> negative, std::uint32_t& degenerate,
                                            Statistics& statistics) {
  const DoubleTag dd;
  alignas(64) double signs[kBatch];
  hn::Store(hn::IfThenElse(negative, hn::Set(dd, -1.0), hn::Set(dd, 1.0)), dd, signs);
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(uncertain));
    const EdgeFunction edge(VertexOf(draw, first + lane, 1), VertexOf(draw, first + lane, 2));
    const int sign = determinant_sign(edge, VertexOf(draw, first + lane, 0), statistics);
    signs[lane] = sign < 0 ? -1 : 1;
    if (sign == 0) degenerate |= 1u << lane;
  }
  return hn::Lt(hn::Load(dd, signs), hn::Zero(dd));
}

// Lanes whose integer edges are exact: every coefficient without rounding error, a and b integers after scaling, c a
// multiple of 2^-10. Their values at samples are then multiples of 2^-10 below 2^42: without rounding error in double.
HWY_NOINLINE hn::Mask<DoubleTag> IntegerEdges(const Double (&x)[3], const Double (&y)[3], const Double (&w)[3],
                                              const Double (&a)[3], const Double (&b)[3], const Double (&c)[3],
                                              const Double (&scale)[3]) {
  const DoubleTag dd;
  auto exact = hn::Eq(hn::Zero(dd), hn::Zero(dd));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    exact = hn::And(exact, DifferenceIsExact(hn::Mul(y[j], w[k]), hn::Mul(w[j], y[k]), a[i]));
    exact = hn::And(exact, DifferenceIsExact(hn::Mul(w[j], x[k]), hn::Mul(x[j], w[k]), b[i]));
    exact = hn::And(exact, DifferenceIsExact(hn::Mul(x[j], y[k]), hn::Mul(y[j], x[k]), c[i]));
    const Double as = hn::Mul(a[i], scale[i]), bs = hn::Mul(b[i], scale[i]);
    const Double cs = hn::Mul(c[i], hn::Mul(scale[i], hn::Set(dd, 0x1p10)));
    exact = hn::And(exact, hn::And(hn::Eq(hn::Round(as), as), hn::Eq(hn::Round(bs), bs)));
    exact = hn::And(exact, hn::And(hn::Eq(hn::Round(cs), cs), hn::Lt(hn::Abs(cs), hn::Set(dd, 0x1p52))));
  }
  return exact;
}

// Sets up the triangles [first, first + count) of the draw.
void SetUp(const DrawJob& job, std::uint32_t first, std::uint32_t count, Batch& batch, Statistics& statistics) {
  const DoubleTag dd;
  const hn::RebindToUnsigned<DoubleTag> du;
  const FloatTag df;
  const IntTag di;
  const Draw& draw = *job.draw;
  const std::uint32_t all = (1u << count) - 1;
  const Vertex* vertices[3][kBatch];
  for (std::uint32_t lane = 0; lane < kBatch; ++lane) {
    const std::uint32_t from = SUREFILL_PLANT(batch_lane) && lane == 5 ? 4 : lane;
    for (std::size_t k = 0; k < 3; ++k) vertices[k][lane] = &VertexOf(draw, first + (lane < count ? from : 0), k);
  }
  std::uint32_t finite = 0, reached = 0, negative = 0, degenerate = 0;
  batch.first = first;
  batch.small = batch.medium = batch.slow_depth = batch.clip = 0;
  const TieShift shift = job.shift;

  constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));
  for (std::uint32_t lane = 0; lane < kBatch; lane += kLanes) {
    const Corner v[3] = {LoadCorner(df, vertices[0] + lane), LoadCorner(df, vertices[1] + lane),
                         LoadCorner(df, vertices[2] + lane)};
    const Float zero = hn::Zero(df);
    const auto front = hn::And(hn::And(hn::Gt(v[0].w, zero), hn::Gt(v[1].w, zero)), hn::Gt(v[2].w, zero));

    // Boxes.
    const PixelBox& region = job.region;
    Float bx[3], by[3], bw[3];
    for (std::size_t k = 0; k < 3; ++k) {  // a division that is harmless, where the result is not used
      bx[k] = v[k].x, by[k] = v[k].y;
      bw[k] = hn::IfThenElse(front, v[k].w, hn::Set(df, 1.0f));
    }
    PixelRange(bx[0], bx[1], bx[2], bw[0], bw[1], bw[2], job.sample.x, region.x0, region.x1, batch.first_x + lane,
               batch.last_x + lane);
    PixelRange(by[0], by[1], by[2], bw[0], bw[1], bw[2], job.sample.y, region.y0, region.y1, batch.first_y + lane,
               batch.last_y + lane);
    std::uint32_t mixed = Bits(df, hn::Not(front)) & (all >> lane);
    if (HWY_UNLIKELY(mixed != 0)) {
      for (; mixed != 0; mixed &= mixed - 1) {
        const auto l = lane + static_cast<std::uint32_t>(__builtin_ctz(mixed));
        const Vertex &v0 = *vertices[0][l], &v1 = *vertices[1][l], &v2 = *vertices[2][l];
        const bool numbers = AllFinite(v0) && AllFinite(v1) && AllFinite(v2);
        const PixelBox box = !numbers ? region
                                      : screen_box(v0, v1, v2, region, std::min(job.sample.x, job.sample.y),
                                                   std::max(job.sample.x, job.sample.y));
        batch.first_x[l] = box.x0, batch.last_x[l] = box.x1 - 1;
        batch.first_y[l] = box.y0, batch.last_y[l] = box.y1 - 1;
      }
    }
    const auto first_x = hn::Load(di, batch.first_x + lane), last_x = hn::Load(di, batch.last_x + lane);
    const auto first_y = hn::Load(di, batch.first_y + lane), last_y = hn::Load(di, batch.last_y + lane);
    const auto empty = hn::Or(hn::Lt(last_x, first_x), hn::Lt(last_y, first_y));
    const std::uint32_t here = ~Bits(di, empty) & (all >> lane) & ((1u << kLanes) - 1);
    reached |= here << lane;
    if (here == 0) {
      for (std::uint32_t l = lane; l < lane + kLanes; ++l)
        finite |= static_cast<std::uint32_t>(AllFinite(*vertices[0][l]) && AllFinite(*vertices[1][l]) &&
                                             AllFinite(*vertices[2][l]))
                  << l;
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
    batch.medium |= Bits(di, hn::Lt(block_span, hn::Set(di, kTileSize))) << lane;
    const auto low_bits = hn::IfThenElse(is_small, three, seven);
    const auto origin_x = hn::AndNot(low_bits, first_x), origin_y = hn::AndNot(low_bits, first_y);

    // Edge functions at the origin, and D = sum W_i E_i taken there, where little cancels.
    const Double bound = hn::Set(dd, kEdgeErrorBound);
    const Double px = hn::Add(hn::PromoteTo(dd, origin_x), hn::Set(dd, job.sample.x));
    const Double py = hn::Add(hn::PromoteTo(dd, origin_y), hn::Set(dd, job.sample.y));
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
      const Double ax = hn::Mul(a[i], px), by_ = hn::Mul(b[i], py);
      e[i] = hn::Add(hn::Add(ax, by_), c[i]);
      error[i] = hn::Mul(bound, hn::Add(hn::Add(hn::Abs(ax), hn::Abs(by_)), hn::Abs(c[i])));
      const Double we = hn::Mul(w[i], e[i]);
      det = hn::Add(det, we);
      det_error = hn::Add(det_error, hn::Add(hn::Mul(hn::Abs(w[i]), error[i]), hn::Mul(bound, hn::Abs(we))));
    }

    // NaN and infinity (B1): of X, Y and W they reach every coefficient that they enter, and so det, which no finite
    // input can overflow.
    Double z_magnitude = hn::Zero(dd);
    for (const Corner& corner : v) z_magnitude = hn::Add(z_magnitude, hn::Abs(hn::PromoteTo(dd, corner.z)));
    const std::uint32_t finite_lanes =
        Bits(dd, hn::Lt(hn::Add(hn::Abs(det), z_magnitude), hn::Set(dd, std::numeric_limits<double>::infinity())));
    finite |= finite_lanes << lane;

    // The sign of D: by its bound, else lane by lane. Edges of a triangle with D < 0 are negated, and so is det.
    auto is_negative = hn::Lt(det, hn::Zero(dd));
    const std::uint32_t uncertain = Bits(dd, hn::Not(hn::Gt(hn::Abs(det), det_error))) & here & finite_lanes;
    if (HWY_UNLIKELY(uncertain != 0)) {
      std::uint32_t flat = 0;
      is_negative = ExactSigns(draw, first + lane, uncertain, is_negative, flat, statistics);
      degenerate |= flat << lane;
    }
    negative |= Bits(dd, is_negative) << lane;
    const Double d_sign = hn::IfThenElse(is_negative, hn::Set(dd, -0.0), hn::Zero(dd));
    det = hn::Xor(det, d_sign);
    Double scale[3];
    const auto exponent =
        hn::Add(hn::Set(du, static_cast<std::uint64_t>(2046 + kTileExponent) << 52),
                hn::IfThenElseZero(hn::RebindMask(du, hn::Lt(hn::PromoteTo(dd, cell_span), hn::Set(dd, 16.0))),
                                   hn::Set(du, static_cast<std::uint64_t>(kSmallExponent - kTileExponent) << 52)));
    for (std::size_t i = 0; i < 3; ++i) scale[i] = Scale(a[i], b[i], exponent);
    hn::Mask<DoubleTag> integer = hn::Lt(det, det);
    if (kExactCoverage) {
      const Double as = hn::Mul(a[0], scale[0]);
      if ((Bits(dd, hn::Eq(hn::Round(as), as)) & (reached >> lane)) != 0)
        integer = IntegerEdges(x, y, w, a, b, c, scale);
    }
    const auto small_bound = hn::Set(di, SUREFILL_PLANT(small_bound) ? 2 : kSmallBound);
    const auto rounded_bound =
        kExactCoverage ? hn::IfThenElse(is_small, small_bound, hn::Set(di, kTileBound)) : hn::Zero(di);
    const bool any_integer = !hn::AllFalse(dd, integer);
    const auto edge_bound = HWY_UNLIKELY(any_integer)
                                ? hn::DemoteTo(di, hn::IfThenZeroElse(integer, hn::PromoteTo(dd, rounded_bound)))
                                : rounded_bound;
    hn::Store(edge_bound, di, batch.bound + lane);
    const Double limit = hn::Set(dd, kEdgeLimit);
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = hn::Xor(a[i], d_sign);
      b[i] = hn::Xor(b[i], d_sign);
      c[i] = hn::Xor(c[i], d_sign);
      e[i] = hn::Xor(e[i], d_sign);
      const auto step_x = RoundToInt(hn::Mul(a[i], scale[i])), step_y = RoundToInt(hn::Mul(b[i], scale[i]));
      hn::Store(step_x, di, batch.a[i] + lane);
      hn::Store(step_y, di, batch.b[i] + lane);
      const auto none = hn::Zero(di), most = hn::Add(hn::Max(step_x, none), hn::Max(step_y, none));
      hn::Store(hn::Add(hn::Add(most, hn::Add(most, most)), hn::Add(edge_bound, edge_bound)), di, batch.most[i] + lane);
      const Double start = hn::Max(hn::Min(hn::Mul(e[i], scale[i]), limit), hn::Neg(limit));
      auto value = hn::Sub(RoundToInt(start), edge_bound);
      if (HWY_UNLIKELY(any_integer)) {
        // Inside if E > 0, or E = 0 and the tie goes to this triangle: floor(E) >= 0, with a little taken off if it
        // does not.
        const Double along_x = hn::Mul(a[i], hn::Set(dd, shift.x)), along_y = hn::Mul(b[i], hn::Set(dd, shift.y));
        const Double decides = shift.y_dominates ? along_y : along_x,
                     else_decides = shift.y_dominates ? along_x : along_y;
        const auto inside = hn::Or(hn::Gt(decides, hn::Zero(dd)),
                                   hn::And(hn::Eq(decides, hn::Zero(dd)), hn::Gt(else_decides, hn::Zero(dd))));
        const Double floor = hn::Floor(hn::Add(start, hn::IfThenZeroElse(inside, hn::Set(dd, -0x1p-12))));
        value = hn::DemoteTo(di, hn::IfThenElse(integer, floor, hn::PromoteTo(dd, value)));
      }
      hn::Store(value, di, batch.e[i] + lane);
    }
    if ((reached & ~batch.small) >> lane != 0) {
      for (std::size_t i = 0; i < 3; ++i) {
        hn::Store(a[i], dd, batch.edge_a[i] + lane);
        hn::Store(b[i], dd, batch.edge_b[i] + lane);
        hn::Store(c[i], dd, batch.edge_c[i] + lane);
      }
    }
    if (!job.depth) continue;

    // The depth plane about the origin: z = sum Z_i E_i / D. z_magnitude stands for each |Z_i| in the bounds.
    Double z = hn::Zero(dd), zx = z, zy = z, edge_error = z, x_size = z, y_size = z;
    for (std::size_t i = 0; i < 3; ++i) {
      const Double depth_i = hn::PromoteTo(dd, v[i].z);
      z = hn::Add(z, hn::Mul(depth_i, e[i]));
      zx = hn::Add(zx, hn::Mul(depth_i, a[i]));
      zy = hn::Add(zy, hn::Mul(depth_i, b[i]));
      edge_error = hn::Add(edge_error, error[i]);
      x_size = hn::Add(x_size, hn::Abs(a[i]));
      y_size = hn::Add(y_size, hn::Abs(b[i]));
    }
    const Double smallest = hn::Sub(det, det_error);  // D is at least this; if it is not positive, nothing is known
    const Double inverse = hn::Div(hn::Set(dd, 1.0), det);
    z = hn::Mul(z, inverse);
    zx = hn::Mul(zx, inverse);
    zy = hn::Mul(zy, inverse);
    const Double rx = hn::PromoteTo(dd, hn::Sub(last_x, origin_x)), ry = hn::PromoteTo(dd, hn::Sub(last_y, origin_y));
    // |z_real - z| at any sample of the box: numerators, determinant, and the rounding of the evaluation itself. An
    // edge's error is at least `bound` times its value: twice that error bounds a product with it.
    const Double size = hn::Add(hn::Abs(z), hn::Add(hn::Mul(hn::Abs(zx), rx), hn::Mul(hn::Abs(zy), ry)));
    const Double steps = hn::Mul(bound, hn::Add(hn::Mul(x_size, rx), hn::Mul(y_size, ry)));
    const Double numerators =
        hn::Add(hn::Mul(z_magnitude, hn::Add(hn::Add(edge_error, edge_error), steps)), hn::Mul(size, det_error));
    // The first sample of an area may lie 63 samples before the origin, on the way to which sums can be larger.
    const Double way = hn::Mul(hn::Set(dd, 63.0), hn::Add(hn::Abs(zx), hn::Abs(zy)));
    const Double evaluation = hn::Mul(hn::Set(dd, 2 * kEdgeErrorBound), hn::Add(size, way));
    const Double total = hn::Mul(hn::Add(hn::Div(numerators, smallest), evaluation),
                                 hn::Set(dd, SUREFILL_PLANT(depth_bound) ? 0x1p-8 : 1 + 0x1p-20));
    const auto known = hn::And(hn::Gt(smallest, hn::Zero(dd)), hn::Lt(hn::Add(size, total), hn::Set(dd, 1e38)));
    batch.slow_depth |= Bits(dd, hn::Not(known)) << lane;
    const Double direction = hn::Set(dd, job.greater ? -0.0 : 0.0);
    hn::Store(hn::Xor(z, direction), dd, batch.z + lane);
    hn::Store(hn::Xor(zx, direction), dd, batch.z_x + lane);
    hn::Store(hn::Xor(zy, direction), dd, batch.z_y + lane);
    hn::Store(total, dd, batch.z_error + lane);
    // All W > 0 and 0 <= Z <= W at every vertex: then 0 <= z <= 1 wherever the triangle covers, and there is nothing to
    // clip or clamp.
    if (draw.depth_mode == DepthMode::none) continue;
    auto inside = front;
    for (const Corner& corner : v)
      inside = hn::And(inside, hn::And(hn::Ge(corner.z, zero), hn::Le(corner.z, corner.w)));
    batch.clip |= Bits(df, hn::Not(inside)) << lane;
  }

  if (HWY_UNLIKELY(!draw.attributes.empty())) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      if (!AttributesFinite(draw, first + lane)) finite &= ~(1u << lane);
    }
  }
  finite &= all;
  reached &= job.region.empty() ? 0 : finite;
  degenerate &= reached;
  std::uint32_t culled = 0;
  if (draw.cull != Cull::none) {
    const std::uint32_t front = draw.front_face == FrontFace::clockwise ? ~negative : negative;
    culled = (draw.cull == Cull::front ? front : ~front) & reached & ~degenerate;
  }
  batch.live = reached & ~degenerate & ~culled;
  const auto ones = [](std::uint32_t lanes) { return static_cast<std::uint64_t>(__builtin_popcount(lanes)); };
  statistics.triangles += count;
  statistics.dropped += count - ones(finite);
  statistics.outside += ones(finite & ~reached);
  statistics.degenerate += ones(degenerate);
  statistics.culled += ones(culled);
  statistics.rasterized += ones(batch.live);
}

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_SETUP_INL_HPP
