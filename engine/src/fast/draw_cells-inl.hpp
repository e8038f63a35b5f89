// SPDX-License-Identifier: Apache-2.0
//
// Cells of triangles that are set up within a tile: coverage by int32 edge functions with deferred uncertainty, depth in
// two float32 parts. SmallTriangles and LargeTriangles fill the lists and the values at the cells.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_DRAW_CELLS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_DRAW_CELLS_INL_HPP
#undef SUREFILL_SRC_FAST_DRAW_CELLS_INL_HPP
#else
#define SUREFILL_SRC_FAST_DRAW_CELLS_INL_HPP
#endif

#include "fast/hierarchical_z-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// What is kept of each sample. kWinner implies kDepth. The tiles have what is asked for.
template <bool kDepth, bool kWinner, bool kCount>
class CellDrawer : public HierarchicalZ {
 public:
  using HierarchicalZ::HierarchicalZ;

 protected:
  static constexpr std::size_t kSlots = 8;  // small triangles that are drawn together

  static bool NeedsDepth(const Record& r) { return (kDepth || r.has(Record::kClip)) && !r.has(Record::kSlowDepth); }
  // The values at a cell's first sample, in all lanes.
  struct CellStart {
    hn::Vec<CellInt> edge[3];
    hn::Vec<CellFloat> high, low;
  };
  HWY_INLINE CellStart StartOf(std::size_t item) const {
    const CellInt d;
    const CellFloat df;
    return {{hn::Set(d, edge_[0][item]), hn::Set(d, edge_[1][item]), hn::Set(d, edge_[2][item])},
            hn::Set(df, high_[item]),
            hn::Set(df, low_[item])};
  }
  // The least of the three edge values in some lanes of a cell.
  HWY_INLINE hn::Vec<CellInt> LeastEdge(const CellStart& cell, std::size_t steps) const {
    const CellInt d;
    const auto e0 = hn::Add(cell.edge[0], hn::Load(d, edge_step_[0] + steps));
    const auto e1 = hn::Add(cell.edge[1], hn::Load(d, edge_step_[1] + steps));
    const auto e2 = hn::Add(cell.edge[2], hn::Load(d, edge_step_[2] + steps));
    return hn::Min(hn::Min(e0, e1), e2);
  }
  // Depth lies between `low` and `high`.
  HWY_INLINE void DepthOf(const CellStart& cell, std::size_t steps, hn::Vec<CellFloat>& low,
                          hn::Vec<CellFloat>& high) const {
    const CellFloat df;
    const auto sum = hn::Add(cell.high, hn::Load(df, high_step_ + steps));
    low = high = sum;
    if (!kExactDepth) return;
    low = hn::Add(sum, hn::Add(cell.low, hn::Load(df, least_step_ + steps)));
    high = hn::Add(sum, hn::Add(cell.low, hn::Load(df, most_step_ + steps)));
  }
  static HWY_INLINE void Clamp(const Record& r, hn::Vec<CellFloat>& low, hn::Vec<CellFloat>& high) {
    const CellFloat df;
    const auto least = hn::Set(df, r.z_least), most = hn::Set(df, r.z_most);
    low = hn::Min(hn::Max(low, least), most), high = hn::Min(hn::Max(high, least), most);
  }
  template <bool kSmall>
  HWY_INLINE std::size_t OffsetOf(std::size_t item) const {
    return kSmall ? offset_[item] : item * kCellSamples;
  }
  template <bool kSmall>
  HWY_INLINE const Record& RecordOf(std::size_t item) const {
    return *record_[kSmall ? item >> 4 : 0];
  }

  // Lanes that are covered and, by `low`, nearer than `before`, which is there. Returns those of which
  // more must be known. Load, select, store: processors do masked stores slowly.
  HWY_INLINE hn::Mask<CellFloat> Fragment(hn::Mask<CellFloat> seen, hn::Vec<CellFloat> before, hn::Vec<CellFloat> low,
                                          hn::Vec<CellFloat> high, hn::Vec<CellFloat> ordinal, float* depth,
                                          std::uint32_t* winner, std::size_t offset) const {
    const CellFloat df;
    const auto known = hn::And(seen, hn::Eq(low, high));
    hn::Store(hn::IfThenElse(known, low, before), df, depth + offset);
    if constexpr (kWinner) {  // as floats, which are selected as depth is
      const CellUint du;
      const auto other = hn::BitCast(df, hn::Load(du, winner + offset));
      hn::Store(hn::BitCast(du, hn::IfThenElse(known, ordinal, other)), du, winner + offset);
    }
    return hn::AndNot(known, seen);
  }
  static HWY_INLINE hn::Vec<CellFloat> OrdinalLanes(std::uint32_t ordinal) {
    return hn::BitCast(CellFloat(), hn::Set(CellUint(), ordinal));
  }
  // Draws the cells that an edge may cut: the lanes that are surely inside, and in the end those within doubt of an
  // edge. kSmall: of all small triangles that were noted.
  template <bool kSmall, bool kRanged>
  HWY_NOINLINE void DrawCells() {
    const CellInt d;
    const CellUint du;
    const CellFloat df;
    auto closest = hn::Zero(du);  // the largest value below 0, as it is the largest without a sign
    auto ordinal = OrdinalLanes(Ordinal(*record_[0]));
    float* const depth = depth_;
    std::uint32_t* const winner = winner_;
    const std::size_t size = partly_.size;
    std::size_t late = 0;
    for (std::size_t n = 0; n < size; ++n) {
      const std::size_t item = partly_.items[n], steps = kSmall ? item & 0xF0 : 0, offset = OffsetOf<kSmall>(item);
      if (kSmall && kWinner) ordinal = OrdinalLanes(ordinal_[item >> 4]);
      const CellStart cell = StartOf(item);
      hn::Mask<CellFloat> seen[kCellVectors];
      hn::Vec<CellFloat> before[kCellVectors], low[kCellVectors], high[kCellVectors];
      HWY_DEFAULT_UNROLL
      for (std::size_t i = 0; i < kCellVectors; ++i) {
        const std::size_t at = offset + i * kCellLanes, step = steps + i * kCellLanes;
        const auto value = LeastEdge(cell, step);
        closest = hn::Max(closest, hn::BitCast(du, value));
        if constexpr (kCount) CountLanes(hn::Gt(value, hn::Set(d, -1)), at);
        if constexpr (kDepth) {
          DepthOf(cell, step, low[i], high[i]);
          if (kRanged) Clamp(RecordOf<kSmall>(item), low[i], high[i]);
          before[i] = hn::Load(df, depth + at);
          seen[i] = NotNegative(value, hn::Lt(low[i], before[i]));
        }
      }
      if constexpr (kDepth) {
        if (kWinner && !kSmall && SomeOf(seen) == 0) continue;
        HWY_DEFAULT_UNROLL
        for (std::size_t i = 0; i < kCellVectors; ++i)
          seen[i] = Fragment(seen[i], before[i], low[i], high[i], ordinal, depth, winner, offset + i * kCellLanes);
        if (HWY_LIKELY(SomeOf(seen) == 0)) continue;
        std::uint32_t lanes = 0;
        for (std::size_t i = 0; i < kCellVectors; ++i) lanes |= Bits(df, seen[i]) << (i * kCellLanes);
        late_[late++] = {partly_.items[n], static_cast<std::uint16_t>(lanes)};
      }
    }
    if (late != 0) SettleDepths<kSmall>(late);
    if (kExactCoverage && HWY_UNLIKELY(!hn::AllFalse(du, IsDoubtful(closest, small_doubt_)))) Settle<kSmall>();
    partly_.size = 0;
  }

  // Lanes of a cell that are set in one of its vectors.
  static HWY_INLINE std::uint32_t SomeOf(const hn::Mask<CellFloat> (&lanes)[kCellVectors]) {
    auto some = lanes[0];
    for (std::size_t i = 1; i < kCellVectors; ++i) some = hn::Or(some, lanes[i]);
    return Bits(CellFloat(), some);
  }
  // The lanes that were noted, whose depth must be known better.
  template <bool kSmall>
  HWY_NOINLINE void SettleDepths(std::size_t size) {
    for (std::size_t n = 0; n < size; ++n)
      ExactLanes(RecordOf<kSmall>(late_[n].item), late_[n].lanes, OffsetOf<kSmall>(late_[n].item), true);
  }

  // Draws the cells that all edges hold whole.
  template <bool kRanged>
  HWY_NOINLINE void DrawWholeCells(const Record& r) {
    const CellFloat df;
    const auto all = hn::Eq(hn::Zero(df), hn::Zero(df));
    const auto ordinal = OrdinalLanes(Ordinal(r));
    for (std::size_t n = 0; n < wholly_.size; ++n) {
      const std::size_t item = wholly_.items[n], offset = item * kCellSamples;
      const CellStart cell = StartOf(item);
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        if constexpr (kCount) CountLanes(hn::RebindMask(CellInt(), all), offset + i);
        if constexpr (kDepth) {
          hn::Vec<CellFloat> low, high;
          DepthOf(cell, i, low, high);
          if (kRanged) Clamp(r, low, high);
          const auto before = hn::Load(df, depth_ + offset + i);
          const auto seen = hn::Lt(low, before);
          if (hn::AllFalse(df, seen)) continue;
          const auto unknown = Fragment(seen, before, low, high, ordinal, depth_, winner_, offset + i);
          if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) ExactLanes(r, Bits(df, unknown), offset + i, true);
        }
      }
    }
    wholly_.size = 0;
  }

  // -doubt <= value < 0, as numbers without a sign.
  static HWY_INLINE hn::Mask<CellUint> IsDoubtful(hn::Vec<CellUint> value, std::int32_t doubt) {
    const CellUint du;
    return hn::Gt(value, hn::Set(du, ~static_cast<std::uint32_t>(doubt)));
  }
  // Of a slot's triangle, or of the large one.
  template <bool kSmall>
  HWY_INLINE std::int32_t DoubtOf(std::size_t item) const {
    return kSmall ? RecordOf<kSmall>(item).small.doubt : small_doubt_;
  }
  // The listed cells' lanes that are within doubt of an edge.
  template <bool kSmall>
  HWY_NOINLINE void Settle() {
    const CellUint du;
    for (std::size_t n = 0; n < partly_.size; ++n) {
      const std::size_t item = partly_.items[n];
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto value = hn::BitCast(du, LeastEdge(StartOf(item), (kSmall ? item & 0xF0 : 0) + i));
        const std::uint32_t bits = Bits(du, IsDoubtful(value, DoubtOf<kSmall>(item)));
        if (bits != 0) SettleLanes(RecordOf<kSmall>(item), bits, OffsetOf<kSmall>(item) + i);
      }
    }
  }

  // Cells that are not drawn as most are.
  template <bool kSmall>
  HWY_NOINLINE void DrawSpecialCells(CellList& list) {
    const CellInt d;
    const CellUint du;
    for (std::size_t n = 0; n < list.size; ++n) {
      const std::size_t item = list.items[n], steps = kSmall ? item & 0xF0 : 0, offset = OffsetOf<kSmall>(item);
      const Record& r = RecordOf<kSmall>(item);
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto value = LeastEdge(StartOf(item), steps + i);
        auto low = hn::Zero(CellFloat()), high = low;
        if (NeedsDepth(r)) DepthOf(StartOf(item), steps + i, low, high);
        SpecialLanes(r, hn::Not(hn::Lt(value, hn::Zero(d))), low, high, offset + i);
        if (!kExactCoverage) continue;
        const std::uint32_t bits = Bits(du, IsDoubtful(hn::BitCast(du, value), DoubtOf<kSmall>(item)));
        if (HWY_UNLIKELY(bits != 0)) SettleLanes(r, bits, offset + i);
      }
    }
    list.size = 0;
  }

  HWY_INLINE void StoreDepthSteps(std::size_t at, const CellVectors<hn::Vec<CellFloat>>& high,
                                  const CellVectors<hn::Vec<CellFloat>>& low, float error) {
    const CellFloat df;
    for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
      hn::Store(high.of[n], df, high_step_ + at + n * kCellLanes);
      hn::Store(hn::Sub(low.of[n], hn::Set(df, error)), df, least_step_ + at + n * kCellLanes);
      hn::Store(hn::Add(low.of[n], hn::Set(df, error)), df, most_step_ + at + n * kCellLanes);
    }
  }

  bool ranged_ = false;  // depths are clamped to the records' ranges
  // Of small triangles the largest of those noted: at worst, doubts are looked into that are none.
  std::int32_t small_doubt_ = 0;
  const Record* record_[kSlots];  // of each slot; of a large triangle, the first
  std::uint32_t ordinal_[kSlots];
  CellList partly_, wholly_;
  struct Late {
    std::uint8_t item;
    std::uint16_t lanes;
  };
  Late late_[256];

  // Slot by slot of small triangles, or area by area of a large one; of that, edge_step_ and the other steps have but
  // the first slot. Steps lead from the first sample of a cell to its others; the rest is at the cells' first samples.
  //
  // Depth has two parts. High parts are multiples of one quantum, so few of them that their sums are exact; low parts
  // are what is left, here less and plus the bound of the whole error. So depth lies between high + least and high +
  // most, and if both are rounded to the same float32, that is the stored depth (docs/precision.md).
  alignas(64) std::int32_t edge_step_[3][kSlots * 16];
  alignas(64) float high_step_[kSlots * 16], least_step_[kSlots * 16], most_step_[kSlots * 16];
  alignas(64) std::int32_t edge_[3][256];
  alignas(64) float high_[256], low_[256];
  alignas(64) std::uint32_t offset_[kSlots * 16];  // of small triangles' cells, in the tile
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_DRAW_CELLS_INL_HPP
