// SPDX-License-Identifier: Apache-2.0
//
// Small triangles, within 4 x 4 cells, eight of them together; and tiny ones, within 4 x 4 samples, at once.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_DRAW_SMALL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_DRAW_SMALL_INL_HPP
#undef SUREFILL_SRC_FAST_DRAW_SMALL_INL_HPP
#else
#define SUREFILL_SRC_FAST_DRAW_SMALL_INL_HPP
#endif

#include "fast/draw_cells-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

template <bool kDepth, bool kWinner, bool kCount>
class SmallTriangles : public CellDrawer<kDepth, kWinner, kCount> {
 protected:
  using Base = CellDrawer<kDepth, kWinner, kCount>;
  using Base::Base;
  using Base::kSlots, Base::depth_, Base::winner_, Base::ordinal_, Base::tile_x_, Base::tile_y_, Base::Ordinal,
      Base::CountLanes, Base::ExactLanes, Base::partly_, Base::small_doubt_, Base::record_, Base::ranged_, Base::edge_,
      Base::edge_step_, Base::high_, Base::low_, Base::high_step_, Base::least_step_, Base::most_step_, Base::offset_,
      Base::Clamp, Base::Fragment, Base::StoreDepthSteps;

  // ---- small: noted in a slot, and drawn with others
  HWY_INLINE void AddSmall(const Record& r, bool depth) {
    const CellInt d;
    const std::size_t at = slots_ * 16;
    const int column = ((r.x0 & ~3) - tile_x_) >> kCellLog2, row = ((r.y0 & ~3) - tile_y_) >> kCellLog2;
    hn::Vec<CellInt> lanes[16 / kCellLanes];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto steps = StepsOf(r.small.a[k], r.small.b[k]);
      const auto start = hn::Set(d, r.small.e[k]);
      const auto most = hn::Set(d, 3 * (std::max(r.small.a[k], 0) + std::max(r.small.b[k], 0)) + r.small.doubt);
      for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
        const auto value = hn::Add(start, hn::ShiftLeft<2>(steps.of[n])), largest = hn::Add(value, most);
        hn::Store(steps.of[n], d, edge_step_[k] + at + n * kCellLanes);
        hn::Store(value, d, edge_[k] + at + n * kCellLanes);
        lanes[n] = k == 0 ? largest : hn::Or(lanes[n], largest);  // negative if one is
      }
    }
    std::uint32_t outside = 0;
    for (std::size_t n = 0; n < 16 / kCellLanes; ++n)
      outside |= Bits(d, hn::Lt(lanes[n], hn::Zero(d))) << (n * kCellLanes);
    if (depth) AddDepth(r, at);
    PlaceCells(column, row, at);
    const int last_column = ((r.x1 - tile_x_) >> kCellLog2) - column, last_row = ((r.y1 - tile_y_) >> kCellLog2) - row;
    const std::uint32_t columns = BitRange(-column, std::min(last_column, 15 - column)) & 15,
                        rows = BitRange(-row, std::min(last_row, 15 - row)) & 15;
    const std::uint32_t cells = ~outside & (columns * 0x1111u) & kCellsOfRows[rows];
    partly_.Append(slots_, cells);
    for (int n = 0; kWinner && n < 4; ++n) noted_[row + 4 + n] |= (cells >> (4 * n) & 15) << (column + 4);
    small_doubt_ = std::max(small_doubt_, r.small.doubt);
    ordinal_[slots_] = Ordinal(r), record_[slots_++] = &r;
  }
  HWY_INLINE void AddDepth(const Record& r, std::size_t at) {
    const CellFloat df;
    const auto high = StepsOf(r.small.high_x, r.small.high_y), low = StepsOf(r.small.low_x, r.small.low_y);
    StoreDepthSteps(at, high, low, r.small.low_error);
    const auto four = hn::Set(df, 4.0f);
    for (std::size_t n = 0, i = at; n < 16 / kCellLanes; ++n, i += kCellLanes) {
      hn::Store(hn::Add(hn::Set(df, r.small.high), hn::Mul(four, high.of[n])), df, high_ + i);
      hn::Store(hn::Add(hn::Set(df, r.small.low), hn::Mul(four, low.of[n])), df, low_ + i);
    }
  }
  // Where the 4 x 4 cells from a column and a row of cells on lie; of those outside the tile, anywhere.
  HWY_INLINE void PlaceCells(int column, int row, std::size_t at) {
    const hn::CappedTag<std::uint32_t, 4> d;
    for (std::size_t y = 0; y < 4; ++y) {
      const auto begin = hn::Set(d, kCellOffsets.row[static_cast<std::size_t>(row + 4) + y]);
      for (std::size_t x = 0; x < 4; x += hn::Lanes(d)) {
        const auto columns = hn::LoadU(d, kCellOffsets.column + static_cast<std::size_t>(column + 4) + x);
        hn::Store(hn::Add(begin, columns), d, offset_ + at + 4 * y + x);
      }
    }
  }

  // ---- tiny: what it covers is known, and it is drawn at once
  HWY_INLINE void DrawTiny(const Record& r) {
    const int column = ((r.x0 & ~3) - tile_x_) >> kCellLog2, row = ((r.y0 & ~3) - tile_y_) >> kCellLog2;
    // A vector's lanes at a time; a cell has 16 bits, the one below it the next, then those to the right.
    constexpr std::uint64_t kLanes = (std::uint64_t{1} << kCellLanes) - 1;
    std::uint64_t samples = r.small.cover[0] | std::uint64_t{r.small.cover[1]} << 32;
    while (samples != 0) {
      const int first = std::countr_zero(samples) & -static_cast<int>(kCellLanes);
      const auto lanes = static_cast<std::uint32_t>(samples >> first & kLanes);
      samples &= ~(kLanes << first);
      const int right = first >> 5, below = first >> 4 & 1, x = column + right, y = row + below, i = first & 15;
      if (HWY_UNLIKELY(((x | y) & ~15) != 0)) continue;  // of another tile
      DrawTinyLanes(r, lanes, kCellOffsets.column[x + 4] + kCellOffsets.row[y + 4] + static_cast<std::size_t>(i),
                    kColumnFloat + right * 16 + i, kRowFloat + below * 16 + i);
    }
  }
  HWY_INLINE void DrawTinyLanes(const Record& r, std::uint32_t lanes, std::size_t offset, const float* columns,
                                const float* rows) {
    const CellUint du;
    const CellFloat df;
    const auto bits = hn::Load(du, kSampleBit), covered = hn::And(hn::Set(du, lanes), bits);
    if constexpr (kCount) CountLanes(hn::RebindMask(CellInt(), hn::Eq(covered, bits)), offset);
    if constexpr (kDepth) {
      const auto x = hn::Load(df, columns), y = hn::Load(df, rows);
      const auto along = [&](float by_x, float by_y) {
        return hn::Add(hn::Mul(hn::Set(df, by_x), x), hn::Mul(hn::Set(df, by_y), y));
      };
      const auto sum = hn::Add(hn::Set(df, r.small.high), along(r.small.high_x, r.small.high_y));
      const auto rest = along(r.small.low_x, r.small.low_y), error = hn::Set(df, r.small.low_error);
      const auto start = hn::Set(df, r.small.low);
      auto low = kExactDepth ? hn::Add(sum, hn::Add(start, hn::Sub(rest, error))) : sum;
      auto high = kExactDepth ? hn::Add(sum, hn::Add(start, hn::Add(rest, error))) : sum;
      if (ranged_) Clamp(r, low, high);
      const auto before = hn::Load(df, depth_ + offset);
      const auto seen = hn::And(hn::RebindMask(df, hn::Eq(covered, bits)), hn::Lt(low, before));
      const auto unknown = Fragment(seen, before, low, high, Base::OrdinalLanes(Ordinal(r)), depth_, winner_, offset);
      if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) ExactLanes(r, Bits(df, unknown), offset, true);
    }
  }

  // Does a small triangle that is noted meet a cell of this tiny one?
  HWY_INLINE bool IsNoted(const Record& r) const {
    if (slots_ == 0) return false;
    const std::uint32_t columns = r.x0 >> kCellLog2 == r.x1 >> kCellLog2 ? 1 : 3;
    const int column = ((r.x0 & ~3) - tile_x_) >> kCellLog2;
    const int first = ((r.y0 & ~3) - tile_y_) >> kCellLog2, last = ((r.y1 & ~3) - tile_y_) >> kCellLog2;
    return ((noted_[first + 4] | noted_[last + 4]) >> (column + 4) & columns) != 0;
  }
  void ForgetSmall() {
    slots_ = 0, small_doubt_ = 0;
    if (kWinner) std::fill_n(noted_, 24, 0u);
  }

  HWY_INLINE void DrawSmall() {
    if (slots_ == 0) return;
    ranged_ ? Base::template DrawCells<true, true>() : Base::template DrawCells<true, false>();
    ForgetSmall();
  }

  std::size_t slots_ = 0;

 private:
  std::uint32_t noted_[24] = {};  // of each row of cells from -4 on, the columns from -4 on of cells that are noted
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_DRAW_SMALL_INL_HPP
