// SPDX-License-Identifier: Apache-2.0
//
// What set-up is made of: triangles in lanes, ranges of pixels, edge functions in double and their scales.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_EDGES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_EDGES_INL_HPP
#undef SUREFILL_SRC_FAST_EDGES_INL_HPP
#else
#define SUREFILL_SRC_FAST_EDGES_INL_HPP
#endif

#include <cstring>

#include "exact/exact_draw.hpp"
#include "fast/tile.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
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
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  (void)d;
  return static_cast<std::uint32_t>(mask.raw);
#elif HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return static_cast<std::uint32_t>(hn::detail::BitsFromMask(mask)) & ((1u << hn::Lanes(d)) - 1);
#else
  std::uint8_t bytes[8] = {};  // of 16 lanes at most, in any order of bytes
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0] | std::uint32_t{bytes[1]} << 8;
#endif
}

// A vertex of as many triangles as D has lanes; or four components of an attribute there.
template <class D>
struct VertexLanes {
  hn::Vec<D> x, y, z, w;
};

// The vertices of a batch: of lane l, those that indices[3 l ...] name.
struct BatchVertices {
  const Vertex* vertices;
  const std::uint32_t* indices;

  const Vertex& of(std::size_t lane, std::size_t k) const { return vertices[indices[3 * lane + k]]; }
};

// Four floats of each lane, from where `of(lane)` points.
template <class D, class Of>
HWY_INLINE VertexLanes<D> LoadFours(D d, const Of& of) {
  VertexLanes<D> v;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) >= 4) {
    const hn::Repartition<double, D> d64;
    const auto row = [&](std::size_t l) {
      const hn::CappedTag<float, 4> d4;
      const auto low = hn::LoadU(d4, of(l));
      if constexpr (hn::MaxLanes(D()) == 8) {
        return hn::Combine(d, hn::LoadU(d4, of(l + 4)), low);
      } else {
        return low;
      }
    };
    const auto r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    const auto xy01 = hn::BitCast(d64, hn::InterleaveLower(d, r0, r1));
    const auto xy23 = hn::BitCast(d64, hn::InterleaveLower(d, r2, r3));
    const auto zw01 = hn::BitCast(d64, hn::InterleaveUpper(d, r0, r1));
    const auto zw23 = hn::BitCast(d64, hn::InterleaveUpper(d, r2, r3));
    v.x = hn::BitCast(d, hn::InterleaveLower(d64, xy01, xy23));
    v.y = hn::BitCast(d, hn::InterleaveUpper(d64, xy01, xy23));
    v.z = hn::BitCast(d, hn::InterleaveLower(d64, zw01, zw23));
    v.w = hn::BitCast(d, hn::InterleaveUpper(d64, zw01, zw23));
    return v;
  }
#endif
  alignas(16) float lanes[4 * hn::MaxLanes(D())];
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) std::memcpy(lanes + 4 * l, of(l), 4 * sizeof(float));
  hn::LoadInterleaved4(d, lanes, v.x, v.y, v.z, v.w);
  return v;
}

// Vertex k of lanes lane ...
template <class D>
HWY_INLINE VertexLanes<D> LoadVertex(D d, const BatchVertices& vertices, std::size_t lane, std::size_t k) {
  return LoadFours(d, [&](std::size_t l) { return &vertices.of(lane + l, k).x; });
}

// What a triangle of which all W > 0 reaches along one axis, as in reach() but in float32: division and subtraction are
// monotonic and the sample coordinates i + offset are float32 values, so again no margin is needed. first, last:
// pixels, clamped to [begin, end); the box is empty if last < first.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PixelRange(D d, const V (&c)[3], const V (&w)[3], double offset, int begin, int end,
                           std::int32_t* first, std::int32_t* last) {
  const hn::RebindToSigned<D> di;
  const V q0 = hn::Div(c[0], w[0]), q1 = hn::Div(c[1], w[1]), q2 = hn::Div(c[2], w[2]);
  const V shift = hn::Set(d, static_cast<float>(offset));
  const V low = hn::Sub(hn::Min(hn::Min(q0, q1), q2), shift);
  const V high = hn::Sub(hn::Max(hn::Max(q0, q1), q2), shift);
  const V least = hn::Set(d, static_cast<float>(begin)), most = hn::Set(d, static_cast<float>(end));
  const V one = hn::Set(d, 1.0f);
  const V f = hn::Ceil(hn::Min(hn::Max(low, least), most));
  const V l = hn::Floor(hn::Max(hn::Min(high, hn::Sub(most, one)), hn::Sub(least, one)));
  // Integers of at most 15 bits: the sum with 1.5 * 2^23 has them in its low bits.
  const V magic = hn::Set(d, 0x1.8p23f);
  const auto bits = hn::BitCast(di, magic);
  hn::Store(hn::Sub(hn::BitCast(di, hn::Add(f, magic)), bits), di, first);
  hn::Store(hn::Sub(hn::BitCast(di, hn::Add(l, magic)), bits), di, last);
}

// v to the nearest integer, for |v| <= 2^31: the sum with 1.5 * 2^52 has it in its low bits.
HWY_INLINE hn::Vec<IntTag> RoundToInt(Double v) {
  const hn::RebindToUnsigned<DoubleTag> du;
  const hn::RebindToUnsigned<IntTag> du32;
  return hn::BitCast(IntTag(), hn::TruncateTo(du32, hn::BitCast(du, hn::Add(v, hn::Set(DoubleTag(), 0x1.8p52)))));
}

// The pixels of [begin, end) in a range of integers, both ends included; last < first if there are none.
HWY_INLINE void StoreRange(Double low, Double high, int begin, int end, std::int32_t* first, std::int32_t* last) {
  const DoubleTag d;
  const Double least = hn::Set(d, begin), most = hn::Set(d, end), one = hn::Set(d, 1.0);
  hn::Store(RoundToInt(hn::Min(hn::Max(low, least), most)), IntTag(), first);
  hn::Store(RoundToInt(hn::Max(hn::Min(high, hn::Sub(most, one)), hn::Sub(least, one))), IntTag(), last);
}

// The same in double: the pixels of the target with a sample at `offset` in reach or, for `squares`, whose closed squares
// the triangle touches along one axis (M4), exactly, for W > 0: a quotient of float32 numbers that is not an integer n
// lies farther from n than its rounding to double can carry it (docs/precision.md). `offset` is then the first square's.
HWY_NOINLINE void DoubleRange(const float (&c)[3][kBatch], const float (&w)[3][kBatch], std::size_t lane, bool squares,
                              double offset, int begin, int end, std::int32_t* first, std::int32_t* last) {
  const DoubleTag d;
  const FloatTag df;
  const auto quotient = [&](std::size_t k) {
    return hn::Div(hn::PromoteTo(d, hn::Load(df, c[k] + lane)), hn::PromoteTo(d, hn::Load(df, w[k] + lane)));
  };
  const Double q0 = quotient(0), q1 = quotient(1), q2 = quotient(2), shift = hn::Set(d, offset);
  const Double low = hn::Min(hn::Min(q0, q1), q2), high = hn::Max(hn::Max(q0, q1), q2);
  if (squares) {
    StoreRange(hn::Sub(hn::Ceil(low), hn::Set(d, offset + 1)), hn::Sub(hn::Floor(high), shift), begin, end, first,
               last);
  } else {
    StoreRange(hn::Ceil(hn::Sub(low, shift)), hn::Floor(hn::Sub(high, shift)), begin, end, first, last);
  }
}

// Are the attributes of all vertices of a batch finite? As integers without their signs, infinity and NaN are larger
// than all other floats.
HWY_INLINE bool AttributesFinite(const Draw& draw, const std::uint32_t* indices) {
  const hn::CappedTag<std::uint32_t, 4> d;
  constexpr std::uint32_t kMagnitude = 0x7FFFFFFF, kInfinity = 0x7F800000;
  auto largest = hn::Zero(d);
  std::uint32_t largest_of_fewer = 0;
  for (const AttributeArray& attribute : draw.attributes) {
    const std::size_t stride = stride_of(attribute);
    for (std::size_t n = 0; n < 3 * kBatch; ++n) {
      const float* const values = &attribute.values[indices[n] * stride];
      if (attribute.components == 4) {
        for (std::size_t c = 0; c < 4; c += hn::Lanes(d)) {
          const auto bits = hn::BitCast(d, hn::LoadU(hn::RebindToFloat<decltype(d)>(), values + c));
          largest = hn::Max(largest, hn::And(bits, hn::Set(d, kMagnitude)));
        }
      } else {
        for (std::uint32_t c = 0; c < attribute.components; ++c) {
          std::uint32_t bits;
          std::memcpy(&bits, values + c, sizeof bits);
          largest_of_fewer = std::max(largest_of_fewer, bits & kMagnitude);
        }
      }
    }
  }
  return hn::AllTrue(d, hn::Lt(largest, hn::Set(d, kInfinity))) && largest_of_fewer < kInfinity;
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

// p - q == r without rounding error, lane by lane, for r computed as p - q.
HWY_INLINE hn::Mask<DoubleTag> DifferenceIsExact(Double p, Double q, Double r) {
  return hn::And(hn::Eq(hn::Sub(p, r), q), hn::Eq(hn::Add(r, q), p));
}

// The signs of D in the uncertain lanes, exactly; `degenerate` gets the lanes where it is 0.
HWY_NOINLINE hn::Mask<DoubleTag> ExactSigns(const Draw& draw, const std::uint32_t* positions, std::uint32_t uncertain,
                                            hn::Mask<DoubleTag> negative, std::uint32_t& degenerate, Rungs& rungs) {
  const DoubleTag dd;
  alignas(64) double signs[kBatch];
  hn::Store(hn::IfThenElse(negative, hn::Set(dd, -1.0), hn::Set(dd, 1.0)), dd, signs);
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(uncertain));
    const int sign = orientation(draw, positions[lane], &rungs);
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

// Edge functions about the first sample (px, py) of each lane's origin, and bounds of the errors of e.
struct Edges {
  Double a[3], b[3], c[3], e[3], error[3];
};

HWY_INLINE void HomogeneousEdges(const Double (&x)[3], const Double (&y)[3], const Double (&w)[3], Double px, Double py,
                                 Edges& edges) {
  const Double bound = hn::Set(DoubleTag(), kEdgeErrorBound);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    edges.a[i] = hn::Sub(hn::Mul(y[j], w[k]), hn::Mul(w[j], y[k]));
    edges.b[i] = hn::Sub(hn::Mul(w[j], x[k]), hn::Mul(x[j], w[k]));
    edges.c[i] = hn::Sub(hn::Mul(x[j], y[k]), hn::Mul(y[j], x[k]));
    const Double ax = hn::Mul(edges.a[i], px), by = hn::Mul(edges.b[i], py);
    edges.e[i] = hn::Add(hn::Add(ax, by), edges.c[i]);
    edges.error[i] = hn::Mul(bound, hn::Add(hn::Add(hn::Abs(ax), hn::Abs(by)), hn::Abs(edges.c[i])));
  }
}

// D = sum W_i E_i, taken at the origin, where little cancels, and a bound of its error.
HWY_INLINE void Determinant(const Double (&w)[3], const Edges& edges, Double& det, Double& error) {
  const DoubleTag dd;
  det = error = hn::Zero(dd);
  for (std::size_t i = 0; i < 3; ++i) {
    const Double we = hn::Mul(w[i], edges.e[i]);
    det = hn::Add(det, we);
    error = hn::Add(
        error, hn::Add(hn::Mul(hn::Abs(w[i]), edges.error[i]), hn::Mul(hn::Set(dd, kEdgeErrorBound), hn::Abs(we))));
  }
}

// What the sums of low parts may be wrong by, in units of 2^-24 quantum: within an area of 16 x 16 samples, and within
// a tile (docs/precision.md).
constexpr double kSmallParts = 56, kTileParts = 256;

// Splits values up to `largest` in amount in two: a multiple of a quantum, 2^-22 times the power of two at or below
// `largest`, so that float32 sums of high parts are exact; and what is left. Error: what the arithmetic in low parts
// adds to an error, and enough that the sum may be rounded to float32.
template <class D>
class Splitter {
 public:
  using V = hn::Vec<D>;
  using Part = hn::Vec<hn::Rebind<float, D>>;

  HWY_INLINE explicit Splitter(V largest) {
    const hn::RebindToUnsigned<D> du;
    largest = hn::Max(largest, hn::Set(D(), 0x1p-100));
    power_ = hn::BitCast(D(), hn::And(hn::BitCast(du, largest), hn::Set(du, 0x7FF0000000000000u)));
    magic_ = hn::Mul(power_, hn::Set(D(), 0x1.8p30));
  }
  HWY_INLINE void Split(V v, Part& high, Part& low) const {
    const hn::Rebind<float, D> df;
    const V whole = hn::Sub(hn::Add(v, magic_), magic_);
    high = hn::Add(hn::DemoteTo(df, whole), hn::Zero(df));  // no -0: then no sum of parts is -0
    low = hn::DemoteTo(df, hn::Sub(v, whole));
  }
  HWY_INLINE V Error(V error, double units) const {
    const V sum = hn::Add(error, hn::Mul(power_, hn::Set(D(), units * 0x1p-46)));
    return hn::Add(hn::Mul(sum, hn::Set(D(), 1 + 0x1p-20)), hn::Set(D(), 0x1p-146));
  }

 private:
  V power_, magic_;
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_EDGES_INL_HPP
