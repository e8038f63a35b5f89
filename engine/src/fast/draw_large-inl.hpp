// SPDX-License-Identifier: Apache-2.0
//
// Large triangles: which areas, blocks and cells of the tile they meet, hold or hide behind.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_DRAW_LARGE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_DRAW_LARGE_INL_HPP
#undef SUREFILL_SRC_FAST_DRAW_LARGE_INL_HPP
#else
#define SUREFILL_SRC_FAST_DRAW_LARGE_INL_HPP
#endif

#include "fast/draw_small-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// A large triangle at the tile at hand.
struct TilePlane {
  double z;                        // depth at the tile's first sample
  std::int32_t most[3], least[3];  // of edges: the largest and smallest change within a cell; most: and the doubt
  std::int32_t doubt;
  bool holds_tile;  // all edges hold the tile whole
};

// Columns and rows of the tile's cells that a record's box meets; and those that it holds whole, where that matters.
struct TileBox {
  std::uint32_t columns, rows, inner_columns = 0xFFFF, inner_rows = 0xFFFF;

  TileBox(const Record& r, int tile_x, int tile_y) {
    const int x0 = r.x0 - tile_x, x1 = r.x1 - tile_x, y0 = r.y0 - tile_y, y1 = r.y1 - tile_y;
    columns = BitRange(x0 >> kCellLog2, x1 >> kCellLog2), rows = BitRange(y0 >> kCellLog2, y1 >> kCellLog2);
    if (!r.has(Record::kBorder)) return;
    inner_columns = BitRange((x0 + 3) >> kCellLog2, ((x1 + 1) >> kCellLog2) - 1);
    inner_rows = BitRange((y0 + 3) >> kCellLog2, ((y1 + 1) >> kCellLog2) - 1);
  }
  bool holds_tile() const { return (columns & rows & inner_columns & inner_rows) == 0xFFFF; }
  // The areas that the box meets.
  std::uint32_t areas() const {
    const std::uint32_t x = some_of_four(columns);
    return ((x | x >> 3 | x >> 6 | x >> 9) & 15) * 0x1111 & some_of_four(rows) * 15;
  }
  // Of area n.
  std::uint32_t cells(std::uint32_t n) const { return cells_of(n, columns, rows); }
  std::uint32_t inner_cells(std::uint32_t n) const { return cells_of(n, inner_columns, inner_rows); }

 private:
  static std::uint32_t some_of_four(std::uint32_t cells) {
    cells |= cells >> 1;
    return (cells | cells >> 2) & 0x1111;
  }
  static std::uint32_t cells_of(std::uint32_t n, std::uint32_t columns, std::uint32_t rows) {
    return (columns >> (n & 3) * 4 & 15) * 0x1111u & kCellsOfRows[rows >> (n >> 2) * 4 & 15];
  }
};

template <bool kDepth, bool kWinner, bool kCount>
class LargeTriangles : public SmallTriangles<kDepth, kWinner, kCount> {
 protected:
  using Base = SmallTriangles<kDepth, kWinner, kCount>;
  using Base::Base;
  using Base::tile_x_, Base::tile_y_, Base::job_, Base::near_, Base::far_, Base::count_, Base::IsHidden,
      Base::VisibleBlocks, Base::WholeBlocks, Base::UpdateBlockFar, Base::UpdateTileFar, Base::tile_far_,
      Base::NeedsDepth, Base::partly_, Base::wholly_, Base::small_doubt_, Base::record_, Base::ranged_, Base::edge_,
      Base::edge_step_, Base::high_, Base::low_, Base::high_step_, Base::least_step_, Base::most_step_,
      Base::StoreDepthSteps;

  // Whether all of a record, of which depth is known, lies behind what the tile holds.
  HWY_INLINE bool IsHiddenHere(const Record& r) const {
    const double z = DepthAtTile(r) - r.large.z_error;
    return IsHidden(z + (kTileSize - 1) * FallOf(r), r.z_most, tile_far_);
  }
  // The largest changes of depth to less and to more in one step each way.
  static HWY_INLINE double FallOf(const Record& r) { return std::min(0.0, r.large.z_x) + std::min(0.0, r.large.z_y); }
  static HWY_INLINE double RiseOf(const Record& r) { return std::max(0.0, r.large.z_x) + std::max(0.0, r.large.z_y); }
  // At the first sample.
  HWY_INLINE double DepthAtTile(const Record& r) const {
    return r.large.z + (r.large.z_x * (tile_x_ - r.origin_x()) + r.large.z_y * (tile_y_ - r.origin_y()));
  }
  void DrawLarge(const Record& r, bool special) {
    r.has(Record::kThin) && !special ? Large<true>(r, false) : Large<false>(r, special);
  }
  template <bool kThin>
  HWY_NOINLINE void Large(const Record& r, bool special) {
    const bool depth = NeedsDepth(r), hides = hides_ && depth;
    TilePlane plane;
    plane.z = DepthAtTile(r);
    constexpr double kReach = kTileSize - 1;
    Clip clip = Clip::in;
    if (HWY_UNLIKELY(r.has(Record::kClip)) && !special) clip = ClipOf(r, plane.z, kReach);
    if (clip == Clip::out) return;
    const std::uint64_t visible = !kThin && hides ? VisibleBlocks(r, plane.z, FallOf(r)) : ~std::uint64_t{0};
    if (visible == 0) return;
    const TileBox box(r, tile_x_, tile_y_);
    std::uint32_t possible = SetUpAreas(r, plane) & box.areas();
    if (possible == 0) return;
    if (kCount && !kDepth && plane.holds_tile && box.holds_tile() && clip == Clip::in && !special) {
      ++whole_tile_;
      return;
    }
    if (depth) SetUpDepth(r, plane);
    const bool borders = special || r.has(Record::kBorder) || clip == Clip::some;
    std::uint64_t whole = 0;  // blocks, of which `far` may become less
    for (; possible != 0; possible &= possible - 1) {
      const auto n = static_cast<std::uint32_t>(std::countr_zero(possible));
      const std::uint32_t visible_cells = kThin ? 0xFFFF : kCellsOfBlocks[visible >> 4 * n & 15];
      if (!kThin && visible_cells == 0) continue;
      std::uint32_t full = 0;
      std::uint32_t cells = SetUpCells<kThin>(plane, n, borders, full);
      cells &= box.cells(n) & visible_cells;
      if (!kThin && hides) whole |= WholeBlocks(cells & full) << 4 * n;
      if (cells == 0) continue;
      if (depth) PlaceDepth(n);
      const Clip of_area = HWY_UNLIKELY(clip == Clip::some) ? ClipOfArea(r, plane, n) : Clip::in;
      if (of_area == Clip::out) continue;
      std::uint32_t inner = 0xFFFF;
      if (HWY_UNLIKELY(borders)) inner = special || of_area == Clip::some ? 0 : box.inner_cells(n);
      ListCells<kThin>(n, cells, full, inner);
    }
    record_[0] = &r, small_doubt_ = plane.doubt;
    ranged_ ? DrawListed<kThin, true>(r) : DrawListed<kThin, false>(r);
    if (HWY_UNLIKELY(doubtful_.size != 0)) Base::template DrawSpecialCells<false>(doubtful_);
    small_doubt_ = 0;
    if (whole == 0) return;
    for (; whole != 0; whole &= whole - 1) UpdateBlockFar(static_cast<std::size_t>(std::countr_zero(whole)));
    UpdateTileFar();
  }
  // Lists cells of area n, of which all edges hold those in `full`. Those that are not in `inner` are special.
  template <bool kThin>
  HWY_INLINE void ListCells(std::uint32_t n, std::uint32_t cells, std::uint32_t full, std::uint32_t inner) {
    if (HWY_UNLIKELY(inner != 0xFFFF)) {
      doubtful_.Append(n, cells & ~inner);
      cells &= inner;
    }
    if (kCount && !kDepth && (cells & full) == 0xFFFF) {
      ++whole_areas_[n];
      return;
    }
    partly_.Append(n, cells & ~full);
    if (!kThin) wholly_.Append(n, cells & full);
  }
  template <bool kThin, bool kRanged>
  HWY_INLINE void DrawListed(const Record& r) {
    if (partly_.size != 0) Base::template DrawCells<false, kRanged>();
    if (!kThin && wholly_.size != 0) Base::template DrawWholeCells<kRanged>(r);
  }

  // Whether depth within `reach` samples from where it is z lies in 0..1, outside it, or neither surely.
  enum class Clip { in, out, some };
  Clip ClipOf(const Record& r, double z, double reach) const {
    const double least = r.z_least, most = r.z_most;
    const double low = std::clamp(z + reach * FallOf(r) - r.large.z_error, least, most);
    const double high = std::clamp(z + reach * RiseOf(r) + r.large.z_error, least, most);
    if (high < near_ || low > far_) return Clip::out;
    return low > near_ && high < far_ ? Clip::in : Clip::some;
  }

  Clip ClipOfArea(const Record& r, const TilePlane& plane, std::uint32_t n) const {
    const int area_x = static_cast<int>(n & 3) * kAreaSize, area_y = static_cast<int>(n >> 2) * kAreaSize;
    return ClipOf(r, plane.z + (r.large.z_x * area_x + r.large.z_y * area_y), kAreaSize - 1);
  }

  // The edges at the tile and at its areas. Returns the areas that may be reached.
  HWY_INLINE std::uint32_t SetUpAreas(const Record& r, TilePlane& plane) {
    const CellInt d;
    const TileEdges edges(r, tile_x_ + job_->sample.x, tile_y_ + job_->sample.y);
    plane.doubt = edges.doubt;
    plane.holds_tile = true;
    hn::Vec<CellInt> lanes[16 / kCellLanes];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t x = edges.a[k], y = edges.b[k];
      plane.most[k] = 3 * (std::max(x, 0) + std::max(y, 0)) + plane.doubt;
      plane.least[k] = 3 * (std::min(x, 0) + std::min(y, 0));
      plane.holds_tile = plane.holds_tile && edges.e[k] + 21 * plane.least[k] >= 0;
      const auto steps = StepsOf(x, y);
      const auto start = hn::Set(d, edges.e[k]), most = hn::Set(d, 5 * plane.most[k]);
      for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
        const auto value = hn::Add(start, hn::ShiftLeft<4>(steps.of[n])), largest = hn::Add(value, most);
        hn::Store(steps.of[n], d, edge_step_[k] + n * kCellLanes);
        hn::Store(hn::ShiftLeft<2>(steps.of[n]), d, cell_step_[k] + n * kCellLanes);
        hn::Store(value, d, area_edge_[k] + n * kCellLanes);
        lanes[n] = k == 0 ? largest : hn::Or(lanes[n], largest);  // negative if one is
      }
    }
    std::uint32_t outside = 0;
    for (std::size_t n = 0; n < 16 / kCellLanes; ++n)
      outside |= Bits(d, hn::Lt(lanes[n], hn::Zero(d))) << (n * kCellLanes);
    return ~outside & 0xFFFF;
  }

  // The edges at the cells of area n. Returns those not known to be outside (a hint: time alone hangs on it), `full`: inside.
  template <bool kThin>
  HWY_INLINE std::uint32_t SetUpCells(const TilePlane& plane, std::size_t n, bool borders, std::uint32_t& full) {
    const CellInt d;
    if (!kThin && plane.holds_tile && !borders) return full = 0xFFFF;
    std::uint32_t outside = 0, cut = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      auto outside_lanes = hn::Zero(d), cut_lanes = outside_lanes;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, area_edge_[k][n]), hn::Load(d, cell_step_[k] + i));
        hn::Store(value, d, edge_[k] + n * 16 + i);
        outside_lanes = hn::Or(outside_lanes, hn::Add(value, hn::Set(d, plane.most[k])));  // negative if one is
        if (!kThin) cut_lanes = hn::Or(cut_lanes, hn::Add(value, hn::Set(d, plane.least[k])));
      }
      outside |= Bits(d, hn::Lt(outside_lanes, hn::Zero(d))) << i;
      if (!kThin) cut |= Bits(d, hn::Lt(cut_lanes, hn::Zero(d))) << i;
    }
    if (!kThin) full = ~cut & 0xFFFF;
    return ~outside & 0xFFFF;
  }

  // Depth in parts, about the tile's first sample.
  HWY_INLINE void SetUpDepth(const Record& r, const TilePlane& plane) {
    using One = hn::CappedTag<double, 1>;
    const CellFloat df;
    const double slopes = std::fabs(r.large.z_x) + std::fabs(r.large.z_y);
    const Splitter<One> splitter(hn::Set(One(), std::fabs(plane.z) + (kTileSize - 1) * slopes));
    const auto split = [&](double v, float& high, float& low) {
      typename Splitter<One>::Part h, l;
      splitter.Split(hn::Set(One(), v), h, l);
      high = hn::GetLane(h), low = hn::GetLane(l);
    };
    float high, low, high_x, low_x, high_y, low_y;
    split(plane.z, high, low), split(r.large.z_x, high_x, low_x), split(r.large.z_y, high_y, low_y);
    const bool zero = r.large.z_error == 0;  // then depth is 0 everywhere (StoreDepth)
    const double error = hn::GetLane(splitter.Error(hn::Set(One(), r.large.z_error), kTileParts));
    const auto highs = StepsOf(high_x, high_y), lows = StepsOf(low_x, low_y);
    StoreDepthSteps(0, highs, lows, zero ? 0.0f : static_cast<float>(error));
    const auto four = hn::Set(df, 4.0f), sixteen = hn::Set(df, 16.0f);
    for (std::size_t n = 0, i = 0; n < 16 / kCellLanes; ++n, i += kCellLanes) {
      hn::Store(hn::Mul(highs.of[n], four), df, cell_high_ + i);
      hn::Store(hn::Mul(lows.of[n], four), df, cell_low_ + i);
      hn::Store(hn::Add(hn::Set(df, high), hn::Mul(highs.of[n], sixteen)), df, area_high_ + i);
      hn::Store(hn::Add(hn::Set(df, low), hn::Mul(lows.of[n], sixteen)), df, area_low_ + i);
    }
  }
  // At the cells of area n.
  HWY_INLINE void PlaceDepth(std::size_t n) {
    const CellFloat df;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      hn::Store(hn::Add(hn::Set(df, area_high_[n]), hn::Load(df, cell_high_ + i)), df, high_ + n * 16 + i);
      hn::Store(hn::Add(hn::Set(df, area_low_[n]), hn::Load(df, cell_low_ + i)), df, low_ + n * 16 + i);
    }
  }

  // ---- counts of the tile and of areas that triangles cover whole
  void AddWholeAreas() {
    const CellUint du;
    for (std::size_t n = 0; n < 16; ++n) {
      const std::uint32_t more = whole_tile_ + whole_areas_[n];
      if (more == 0) continue;  // and where nothing is counted there is no buffer
      std::uint32_t* const count = count_ + n * kAreaSamples;
      for (std::size_t i = 0; i < kAreaSamples; i += kCellLanes)
        hn::Store(hn::Add(hn::Load(du, count + i), hn::Set(du, more)), du, count + i);
      whole_areas_[n] = 0;
    }
    whole_tile_ = 0;
  }

  bool hides_ = false;  // what lies behind the tile's depth may be left out

 private:
  CellList doubtful_;  // cells that are drawn as special ones
  std::uint32_t whole_tile_ = 0, whole_areas_[16] = {};
  // Of a large triangle: steps to the cells of an area, and values at the areas' first samples.
  alignas(64) std::int32_t cell_step_[3][16], area_edge_[3][16];
  alignas(64) float cell_high_[16], cell_low_[16], area_high_[16], area_low_[16];
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_DRAW_LARGE_INL_HPP
