// SPDX-License-Identifier: Apache-2.0
//
// Triangles whose boxes have at most 2 x 2 samples, those of fine meshes: a triangle a lane, the four samples one after
// the other.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_TINY_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_TINY_INL_HPP
#undef SUREFILL_SRC_TINY_INL_HPP
#else
#define SUREFILL_SRC_TINY_INL_HPP
#endif

#include "fragment-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// What is known of the samples of tiny lanes. Bit 8 n + lane: of sample n of the box, which is (n & 1, n >> 1).
struct TinySamples {
  std::uint32_t covered = 0, doubtful = 0;  // neither: outside
  std::uint32_t unknown = 0;                // the depth is not known
  alignas(32) float depth[4 * kBatch];

  template <bool kDepth>
  HWY_NOINLINE void Evaluate(const Batch& batch);
};

template <bool kDepth>
HWY_NOINLINE void TinySamples::Evaluate(const Batch& batch) {
  const IntTag di;
  const DoubleTag dd;
  const FloatTag df;
  constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));
  for (std::uint32_t lane = 0; lane < kBatch; lane += kLanes) {
    const auto zero = hn::Zero(di), three = hn::Set(di, 3);
    const auto x = hn::Load(di, batch.first_x + lane), y = hn::Load(di, batch.first_y + lane);
    const auto column = hn::And(x, three), row = hn::And(y, three);  // in the origin's cell
    const auto two_columns = hn::Gt(hn::Load(di, batch.last_x + lane), x);
    const auto two_rows = hn::Gt(hn::Load(di, batch.last_y + lane), y);
    const auto doubt = hn::Load(di, batch.doubt + lane);
    hn::Vec<IntTag> e[3], a[3], b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = hn::Load(di, batch.a[k] + lane), b[k] = hn::Load(di, batch.b[k] + lane);
      e[k] = hn::Add(hn::Load(di, batch.e[k] + lane), hn::Add(hn::Mul(a[k], column), hn::Mul(b[k], row)));
    }
    Double z = hn::Zero(dd), z_x = z, z_y = z, error = z;
    if (kDepth) {
      z_x = hn::Load(dd, batch.z_x + lane), z_y = hn::Load(dd, batch.z_y + lane);
      z = hn::Add(hn::Load(dd, batch.z + lane), hn::Add(hn::Mul(z_x, hn::PromoteTo(dd, column)),  //
                                                        hn::Mul(z_y, hn::PromoteTo(dd, row))));
      if (kExactDepth) error = hn::Load(dd, batch.z_error + lane);
    }
    for (std::uint32_t n = 0; n < 4; ++n) {
      hn::Vec<IntTag> least;
      for (std::size_t k = 0; k < 3; ++k) {
        auto value = e[k];
        if ((n & 1) != 0) value = hn::Add(value, a[k]);
        if ((n & 2) != 0) value = hn::Add(value, b[k]);
        least = k == 0 ? value : hn::Min(least, value);
      }
      auto in = hn::Eq(x, x);
      if ((n & 1) != 0) in = two_columns;
      if ((n & 2) != 0) in = hn::And(in, two_rows);
      const std::uint32_t shift = 8 * n + lane;
      const auto negative = hn::Lt(least, zero);
      covered |= Bits(di, hn::AndNot(negative, in)) << shift;
      if (kExactCoverage)
        doubtful |= Bits(di, hn::AndNot(hn::Lt(hn::Add(least, doubt), zero), hn::And(in, negative))) << shift;
      if (kDepth) {
        auto value = z;
        if ((n & 1) != 0) value = hn::Add(value, z_x);
        if ((n & 2) != 0) value = hn::Add(value, z_y);
        const auto low = hn::DemoteTo(df, hn::Sub(value, error)), high = hn::DemoteTo(df, hn::Add(value, error));
        hn::Store(hn::Add(low, hn::Zero(df)), df, depth + shift);  // no -0
        unknown |= Bits(df, hn::Not(hn::Eq(low, high))) << shift;
      }
    }
  }
}

// Draws some tiny lanes of a batch, none of them special. Triangles with larger ordinals may have been drawn before.
template <bool kDepth, bool kWinner, bool kCount>
void DrawTiny(const Batch& batch, std::uint32_t lanes, const Canvas& canvas, const BandSet& bands,
              FragmentWriter<kDepth, kWinner, kCount>& writer) {
  TinySamples samples;
  samples.Evaluate<kDepth>(batch);
  lanes *= 0x01010101;  // at each sample
  for (std::uint32_t rest = (samples.covered | samples.doubtful) & lanes; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(rest)), lane = i & 7;
    const int x = batch.first_x[lane] + static_cast<int>(i >> 3 & 1),
              y = batch.first_y[lane] + static_cast<int>(i >> 4);
    if (!bands.owns(y >> kTileLog2)) continue;
    const std::uint32_t position = batch.position(lane);
    if (HWY_UNLIKELY(((samples.doubtful | samples.unknown) >> i & 1) != 0)) {
      if ((samples.covered >> i & 1) != 0 || writer.Covers(batch, lane, x, y)) writer.SlowFragment(position, x, y);
    } else if (kDepth) {
      writer.Fragment(position, samples.depth[i], canvas.offset_of(x, y));
    } else {
      writer.CountOne(canvas.offset_of(x, y));
    }
  }
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_TINY_INL_HPP
