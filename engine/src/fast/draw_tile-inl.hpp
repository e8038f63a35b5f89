// SPDX-License-Identifier: Apache-2.0
//
// Records into a tile: coverage by int32 edge functions with deferred uncertainty, depth in two float32 parts,
// hierarchical z.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#undef SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#else
#define SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#endif

#include "fast/cells-inl.hpp"
#include "fast/hierarchical_z-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// A large triangle at the tile at hand.
struct TilePlane {
  double z, fall,
      rise;  // depth at the tile's first sample, and its largest change to less and to more in one step each way
  std::int32_t most[3], least[3];  // of edges: the largest and smallest change within a cell; most: and the doubt
  std::int32_t doubt;
  bool holds_tile;  // all edges hold the tile whole
};

// kWinner implies kDepth. The tiles have what is asked for.
template <bool kDepth, bool kWinner, bool kCount>
class TileDrawer : public HierarchicalZ {
 public:
  using HierarchicalZ::HierarchicalZ;

  // Draws what the pieces have for each tile of the row.
  void Run(std::span<const Piece> pieces, std::uint32_t* list) {
    for (int column = tiles_.begin; column < tiles_.end; ++column) {
      const auto tile = static_cast<std::size_t>(tiles_.row * frame_.grid.columns + column);
      bool selected = false;
      for (std::size_t first = 0; first < pieces.size();) {
        const DrawJob& job = *pieces[first].job;
        std::size_t end = first, size = 0;
        for (; end < pieces.size() && pieces[end].job == &job; ++end)
          size = Append(pieces[end], static_cast<std::uint32_t>(end - first), tile, list, size);
        records_ = pieces[first].records;
        first = end;
        if (size == 0) continue;
        if (!selected) Begin(column);
        selected = true;
        SelectDraw(job);
        Draw(list, size);
      }
      if (selected) End(column);
    }
  }

 private:
  static constexpr std::size_t kAhead = 12;  // so many records are asked for ahead of need
  static constexpr std::size_t kSlots = 8;   // small triangles that are drawn together

  // The records that a piece has for the tile, as numbers from those of the first piece on.
  static HWY_INLINE std::size_t Append(const Piece& piece, std::uint32_t n, std::size_t tile, std::uint32_t* list,
                                       std::size_t size) {
    const std::uint32_t before = n * kPieceRecords;
    for (std::uint32_t i = piece.begin[tile]; i < piece.begin[tile + 1]; ++i) list[size++] = before + piece.items[i];
    return size;
  }

  void Begin(int column) {
    const bool fresh = SelectTile(column);
    next_is_open_ = column + 1 < tiles_.end && tiles_.is_open(column + 1);
    if (kDepth) fresh ? ForgetFar() : UpdateFar();
  }
  void End(int column) {
    if (kDepth) tiles_.far[column - tiles_.begin] = tile_far_;
    if (kCount) AddWholeAreas();
  }

  HWY_INLINE void Ask(std::uint32_t n) const {
    const char* const record = reinterpret_cast<const char*>(records_ + n);
    hwy::Prefetch(record), hwy::Prefetch(record + 64);
  }
  // The next tile is likely needed next, and follows in memory: a part of it, for the second cache.
  HWY_INLINE void AskNextTile(std::size_t part) const {
    if (!next_is_open_ || part >= 64) return;
    for (std::size_t line = 4 * part; line < 4 * part + 4; ++line) {
      if (kDepth) AskLater(depth_ + kTileSamples + 16 * line);
      if (kWinner) AskLater(winner_ + kTileSamples + 16 * line);
      if (kCount) AskLater(count_ + kTileSamples + 16 * line);
    }
  }
  static HWY_INLINE void AskLater(const void* p) {
#if HWY_COMPILER_MSVC
    hwy::Prefetch(static_cast<const char*>(p));
#else
    __builtin_prefetch(p, 0, 2);
#endif
  }

  // Draws records of one draw in their order.
  void Draw(std::uint32_t* list, std::size_t size) {
    constexpr std::uint32_t kSpecial = Record::kSlowDepth | Record::kByWinding;
    const bool streams = frame_.visitor != nullptr, all_special = streams || ordered_;
    const DepthMode mode = job_->draw->depth_mode;
    ranged_ = kDepth && (mode == DepthMode::clamp || job_->draw->grid.has_value());
    hides_ = kDepth && !kCount;
    for (std::size_t i = 0; i < kAhead; ++i) list[size + i] = list[size - 1];
    for (std::size_t i = 0; i < kAhead; ++i) Ask(list[i]);
    for (std::size_t i = 0; i < size; ++i) {
      Ask(list[i + kAhead]);
      AskNextTile(i);
      const Record& r = records_[list[i]];
      if (HWY_LIKELY(!all_special && !r.has(kSpecial))) {
        if (!r.has(Record::kSmall)) {
          if (hides_ && IsHiddenHere(r)) continue;
          DrawSmall();
          r.has(Record::kThin) ? Large<true>(r, false) : Large<false>(r, false);
          continue;
        }
        // In the order of the list in each cell, so that of equal depths the first stays; depth alone does not tell. What
        // a tiny triangle covers is within its box.
        if (HWY_LIKELY(!r.has(Record::kClip))) {
          if (r.has(Record::kTiny) && !(kWinner && IsNoted(r))) {
            DrawTiny(r);
            continue;
          }
          if (HWY_LIKELY(!r.has(Record::kBorder))) {
            AddSmall(r, kDepth);
            if (slots_ == kSlots) DrawSmall();
            continue;
          }
        }
      }
      DrawSmall();
      Special(r);
      if (streams && (i + 1 == size || records_[list[i + 1]].position != r.position)) Emit(r.position);
    }
    DrawSmall();
  }

  // A triangle that is not drawn as most are.
  HWY_NOINLINE void Special(const Record& r) {
    if (r.has(Record::kByWinding)) return DrawByWinding(r);
    if (!r.has(Record::kSmall)) return Large<false>(r, true);
    AddSmall(r, NeedsDepth(r));
    DrawSpecialCells<true>(partly_);
    ForgetSmall();
  }
  static bool NeedsDepth(const Record& r) {
    return (kDepth || r.has(Record::kClip)) && !r.has(Record::kSlowDepth);
  }

  // ---- small: within 4 x 4 cells. Noted in a slot, and drawn with others
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
    record_[slots_++] = &r;
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
  HWY_INLINE void StoreDepthSteps(std::size_t at, const CellVectors<hn::Vec<CellFloat>>& high,
                                  const CellVectors<hn::Vec<CellFloat>>& low, float error) {
    const CellFloat df;
    for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
      hn::Store(high.of[n], df, high_step_ + at + n * kCellLanes);
      hn::Store(hn::Sub(low.of[n], hn::Set(df, error)), df, least_step_ + at + n * kCellLanes);
      hn::Store(hn::Add(low.of[n], hn::Set(df, error)), df, most_step_ + at + n * kCellLanes);
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

  // ---- tiny: within 4 x 4 samples, whose coverage is known: drawn at once
  HWY_INLINE void DrawTiny(const Record& r) {
    const int column = ((r.x0 & ~3) - tile_x_) >> kCellLog2, row = ((r.y0 & ~3) - tile_y_) >> kCellLog2;
    const auto some = [](std::uint32_t samples) { return static_cast<std::uint32_t>(samples != 0); };
    const std::uint32_t left = r.small.cover[0], right = r.small.cover[1];
    std::uint32_t cells =
        some(left & 0xFFFF) | some(right & 0xFFFF) << 1 | some(left >> 16) << 2 | some(right >> 16) << 3;
    for (; cells != 0; cells &= cells - 1) {
      const int n = std::countr_zero(cells), x = column + (n & 1), y = row + (n >> 1);
      const std::uint32_t covered = r.small.cover[n & 1] >> (n & 2) * 8 & 0xFFFF;
      if (HWY_UNLIKELY(((x | y) & ~15) != 0)) continue;  // of another tile
      DrawTinyCell(r, covered, kCellOffsets.column[x + 4] + kCellOffsets.row[y + 4], kColumnFloat + (n & 1) * 16,
                   kRowFloat + (n >> 1) * 16);
    }
  }
  HWY_INLINE void DrawTinyCell(const Record& r, std::uint32_t samples, std::size_t cell, const float* columns,
                               const float* rows) {
    const CellInt d;
    const CellUint du;
    const CellFloat df;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      if (kCellLanes < 16 && (samples >> i & ((1u << kCellLanes) - 1)) == 0) continue;
      const auto covered = hn::Ne(hn::And(hn::Set(du, samples), hn::Load(du, kSampleBit + i)), hn::Zero(du));
      if constexpr (kCount) CountLanes(hn::RebindMask(d, covered), cell + i);
      if constexpr (kDepth) {
        const auto x = hn::Load(df, columns + i), y = hn::Load(df, rows + i);
        const auto along = [&](float by_x, float by_y) {
          return hn::Add(hn::Mul(hn::Set(df, by_x), x), hn::Mul(hn::Set(df, by_y), y));
        };
        const auto sum = hn::Add(hn::Set(df, r.small.high), along(r.small.high_x, r.small.high_y));
        const auto rest = along(r.small.low_x, r.small.low_y), error = hn::Set(df, r.small.low_error);
        const auto start = hn::Set(df, r.small.low);
        auto low = kExactDepth ? hn::Add(sum, hn::Add(start, hn::Sub(rest, error))) : sum;
        auto high = kExactDepth ? hn::Add(sum, hn::Add(start, hn::Add(rest, error))) : sum;
        if (ranged_) Clamp(r, low, high);
        const auto unknown = Fragment(hn::RebindMask(df, covered), low, high, hn::Set(du, Ordinal(r)), cell + i);
        if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) ExactLanes(r, Bits(df, unknown), cell + i, true);
      }
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
    ranged_ ? DrawCells<true, true>() : DrawCells<true, false>();
    ForgetSmall();
  }

  // ---- large: the areas of the tile that the box meets and no edge excludes
  // Of a record whose depth is known.
  HWY_INLINE bool IsHiddenHere(const Record& r) const {
    const double z = DepthAtTile(r) - r.large.z_error;
    const double fall = std::min(0.0, r.large.z_x) + std::min(0.0, r.large.z_y);
    return IsHidden(z + (kTileSize - 1) * fall, r.z_most, tile_far_);
  }
  // At the first sample.
  HWY_INLINE double DepthAtTile(const Record& r) const {
    return r.large.z + (r.large.z_x * (tile_x_ - r.origin_x()) + r.large.z_y * (tile_y_ - r.origin_y()));
  }
  template <bool kThin>
  HWY_NOINLINE void Large(const Record& r, bool special) {
    const bool depth = NeedsDepth(r), hides = hides_ && depth;
    TilePlane plane;
    plane.z = DepthAtTile(r);
    plane.fall = std::min(0.0, r.large.z_x) + std::min(0.0, r.large.z_y);
    plane.rise = std::max(0.0, r.large.z_x) + std::max(0.0, r.large.z_y);
    constexpr double kReach = kTileSize - 1;
    Clip clip = Clip::in;
    if (HWY_UNLIKELY(r.has(Record::kClip)) && !special) clip = ClipOf(r, plane, plane.z, kReach);
    if (clip == Clip::out) return;
    const std::uint64_t visible = !kThin && hides ? VisibleBlocks(r, plane.z, plane.fall) : ~std::uint64_t{0};
    if (visible == 0) return;
    std::uint32_t possible = SetUpAreas(r, plane);
    if (possible == 0) return;
    const std::uint32_t columns = BitRange((r.x0 - tile_x_) >> kCellLog2, (r.x1 - tile_x_) >> kCellLog2);
    const std::uint32_t rows = BitRange((r.y0 - tile_y_) >> kCellLog2, (r.y1 - tile_y_) >> kCellLog2);
    // Of those, the ones that it holds whole, where that matters.
    const bool border = r.has(Record::kBorder);
    const std::uint32_t inner_columns =
        border ? BitRange((r.x0 - tile_x_ + 3) >> 2, ((r.x1 - tile_x_ + 1) >> 2) - 1) : 0xFFFF;
    const std::uint32_t inner_rows =
        border ? BitRange((r.y0 - tile_y_ + 3) >> 2, ((r.y1 - tile_y_ + 1) >> 2) - 1) : 0xFFFF;
    if (kCount && !kDepth && plane.holds_tile && (columns & rows & inner_columns & inner_rows) == 0xFFFF &&
        clip == Clip::in && !special) {
      ++whole_tile_;
      return;
    }
    if (depth) SetUpDepth(r, plane);
    std::uint64_t whole = 0;  // blocks, of which `far` may become less
    for (; possible != 0; possible &= possible - 1) {
      const auto n = static_cast<std::uint32_t>(std::countr_zero(possible));
      const std::uint32_t visible_cells = kThin ? 0xFFFF : kCellsOfBlocks[visible >> 4 * n & 15];
      if (!kThin && visible_cells == 0) continue;
      std::uint32_t full = 0;
      std::uint32_t cells = SetUpCells<kThin>(plane, n, special || border || clip == Clip::some, full);
      cells &= CellsOfArea(n, columns, rows);
      if (!kThin && hides) {
        cells &= visible_cells;
        whole |= WholeBlocks(cells & full) << 4 * n;
      }
      if (cells == 0) continue;
      if (depth) PlaceDepth(n);
      Clip of_area = Clip::in;
      if (HWY_UNLIKELY(clip == Clip::some)) {
        const int area_x = static_cast<int>(n & 3) * kAreaSize, area_y = static_cast<int>(n >> 2) * kAreaSize;
        const double z = plane.z + (r.large.z_x * area_x + r.large.z_y * area_y);
        of_area = ClipOf(r, plane, z, kAreaSize - 1);
      }
      if (of_area == Clip::out) continue;
      if (HWY_UNLIKELY(special || of_area == Clip::some)) {
        doubtful_.Append(n, cells);
        continue;
      }
      if (HWY_UNLIKELY(border)) {
        const std::uint32_t inner = CellsOfArea(n, inner_columns, inner_rows);
        doubtful_.Append(n, cells & ~inner);
        cells &= inner;
      }
      if (kCount && !kDepth && (cells & full) == 0xFFFF) {
        ++whole_areas_[n];
        continue;
      }
      partly_.Append(n, cells & ~full);
      if (!kThin) wholly_.Append(n, cells & full);
    }
    record_[0] = &r, small_doubt_ = plane.doubt;
    ranged_ ? DrawListed<kThin, true>(r) : DrawListed<kThin, false>(r);
    if (HWY_UNLIKELY(doubtful_.size != 0)) DrawSpecialCells<false>(doubtful_);
    small_doubt_ = 0;
    if (whole == 0) return;
    for (; whole != 0; whole &= whole - 1) UpdateBlockFar(static_cast<std::size_t>(std::countr_zero(whole)));
    UpdateTileFar();
  }
  // The cells of area n that lie in columns and rows of the tile's cells.
  static HWY_INLINE std::uint32_t CellsOfArea(std::uint32_t n, std::uint32_t columns, std::uint32_t rows) {
    return (columns >> (n & 3) * 4 & 15) * 0x1111u & kCellsOfRows[rows >> (n >> 2) * 4 & 15];
  }
  template <bool kThin, bool kRanged>
  HWY_INLINE void DrawListed(const Record& r) {
    if (partly_.size != 0) DrawCells<false, kRanged>();
    if (!kThin && wholly_.size != 0) DrawWholeCells<kRanged>(r);
  }

  // Whether depth within `reach` samples from where it is z lies in 0..1, outside it, or neither surely.
  enum class Clip { in, out, some };
  Clip ClipOf(const Record& r, const TilePlane& plane, double z, double reach) const {
    const double least = r.z_least, most = r.z_most;
    const double low = std::clamp(z + reach * plane.fall - r.large.z_error, least, most);
    const double high = std::clamp(z + reach * plane.rise + r.large.z_error, least, most);
    if (high < near_ || low > far_) return Clip::out;
    return low > near_ && high < far_ ? Clip::in : Clip::some;
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
    const std::uint32_t columns = BitRange((r.x0 - tile_x_) >> kAreaLog2, std::min((r.x1 - tile_x_) >> kAreaLog2, 3));
    const std::uint32_t rows = BitRange((r.y0 - tile_y_) >> kAreaLog2, std::min((r.y1 - tile_y_) >> kAreaLog2, 3));
    return ~outside & ((columns & 15) * 0x1111u) & kCellsOfRows[rows & 15];
  }

  // The edges at the cells of area n. Returns the cells that are not outside an edge, and in `full` those within all.
  template <bool kThin>
  HWY_INLINE std::uint32_t SetUpCells(const TilePlane& plane, std::size_t n, bool special, std::uint32_t& full) {
    const CellInt d;
    if (!kThin && plane.holds_tile && !special) return full = 0xFFFF;
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

  // ---- cells
  // The least of the three edge values in lanes i ... of a cell.
  HWY_INLINE hn::Vec<CellInt> LeastEdge(std::size_t item, std::size_t steps) const {
    const CellInt d;
    const auto e0 = hn::Add(hn::Set(d, edge_[0][item]), hn::Load(d, edge_step_[0] + steps));
    const auto e1 = hn::Add(hn::Set(d, edge_[1][item]), hn::Load(d, edge_step_[1] + steps));
    const auto e2 = hn::Add(hn::Set(d, edge_[2][item]), hn::Load(d, edge_step_[2] + steps));
    return hn::Min(hn::Min(e0, e1), e2);
  }
  // Depth lies between `low` and `high`.
  HWY_INLINE void DepthOf(std::size_t item, std::size_t steps, hn::Vec<CellFloat>& low,
                          hn::Vec<CellFloat>& high) const {
    const CellFloat df;
    const auto sum = hn::Add(hn::Set(df, high_[item]), hn::Load(df, high_step_ + steps));
    low = high = sum;
    if (!kExactDepth) return;
    const auto rest = hn::Set(df, low_[item]);
    low = hn::Add(sum, hn::Add(rest, hn::Load(df, least_step_ + steps)));
    high = hn::Add(sum, hn::Add(rest, hn::Load(df, most_step_ + steps)));
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

  // Covered lanes from an offset on. Returns those of which more must be known. Load, select, store: processors do
  // masked stores slowly.
  HWY_INLINE hn::Mask<CellFloat> Fragment(hn::Mask<CellFloat> lanes, hn::Vec<CellFloat> low, hn::Vec<CellFloat> high,
                                          hn::Vec<CellUint> ordinal, std::size_t offset) const {
    const CellFloat df;
    const CellUint du;
    float* const depth = depth_ + offset;
    const auto before = hn::Load(df, depth);
    const auto seen = hn::And(lanes, hn::Lt(low, before));
    const auto known = hn::And(seen, hn::Eq(low, high));
    hn::Store(hn::IfThenElse(known, low, before), df, depth);
    if constexpr (kWinner) {
      std::uint32_t* const winner = winner_ + offset;
      hn::Store(hn::IfThenElse(hn::RebindMask(du, known), ordinal, hn::Load(du, winner)), du, winner);
    }
    return hn::AndNot(known, seen);
  }
  // Draws the cells that an edge may cut: the lanes that are surely inside, and in the end those within doubt of an
  // edge. kSmall: of all small triangles that were noted.
  template <bool kSmall, bool kRanged>
  HWY_NOINLINE void DrawCells() {
    const CellInt d;
    const CellUint du;
    const CellFloat df;
    auto closest = hn::Zero(du);  // the largest value below 0, as it is the largest without a sign
    auto ordinal = hn::Set(du, Ordinal(*record_[0]));
    for (std::size_t n = 0; n < partly_.size; ++n) {
      const std::size_t item = partly_.items[n], steps = kSmall ? item & 0xF0 : 0, offset = OffsetOf<kSmall>(item);
      if (kSmall && kWinner) ordinal = hn::Set(du, Ordinal(RecordOf<kSmall>(item)));
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto value = LeastEdge(item, steps + i);
        closest = hn::Max(closest, hn::BitCast(du, value));
        const auto covered = hn::Not(hn::Lt(value, hn::Zero(d)));
        if constexpr (kCount) CountLanes(covered, offset + i);
        if constexpr (kDepth) {
          hn::Vec<CellFloat> low, high;
          DepthOf(item, steps + i, low, high);
          if (kRanged) Clamp(RecordOf<kSmall>(item), low, high);
          const auto unknown = Fragment(hn::RebindMask(df, covered), low, high, ordinal, offset + i);
          if (HWY_UNLIKELY(!hn::AllFalse(df, unknown)))
            ExactLanes(RecordOf<kSmall>(item), Bits(df, unknown), offset + i, true);
        }
      }
    }
    if (kExactCoverage && HWY_UNLIKELY(!hn::AllFalse(du, IsDoubtful(closest, small_doubt_)))) Settle<kSmall>();
    partly_.size = 0;
  }

  // Draws the cells that all edges hold whole.
  template <bool kRanged>
  HWY_NOINLINE void DrawWholeCells(const Record& r) {
    const CellUint du;
    const CellFloat df;
    const auto all = hn::Eq(hn::Zero(df), hn::Zero(df));
    const auto ordinal = hn::Set(du, Ordinal(r));
    for (std::size_t n = 0; n < wholly_.size; ++n) {
      const std::size_t item = wholly_.items[n], offset = item * kCellSamples;
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        if constexpr (kCount) CountLanes(hn::RebindMask(CellInt(), all), offset + i);
        if constexpr (kDepth) {
          hn::Vec<CellFloat> low, high;
          DepthOf(item, i, low, high);
          if (kRanged) Clamp(r, low, high);
          if (hn::AllFalse(df, hn::Lt(low, hn::Load(df, depth_ + offset + i)))) continue;
          const auto unknown = Fragment(all, low, high, ordinal, offset + i);
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
        const auto value = hn::BitCast(du, LeastEdge(item, (kSmall ? item & 0xF0 : 0) + i));
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
        const auto value = LeastEdge(item, steps + i);
        auto low = hn::Zero(CellFloat()), high = low;
        if (NeedsDepth(r)) DepthOf(item, steps + i, low, high);
        SpecialLanes(r, hn::Not(hn::Lt(value, hn::Zero(d))), low, high, offset + i);
        if (!kExactCoverage) continue;
        const std::uint32_t bits = Bits(du, IsDoubtful(hn::BitCast(du, value), DoubtOf<kSmall>(item)));
        if (HWY_UNLIKELY(bits != 0)) SettleLanes(r, bits, offset + i);
      }
    }
    list.size = 0;
  }

  // ---- counts of the tile and of areas that triangles cover whole
  void AddWholeAreas() {
    const CellUint du;
    for (std::size_t n = 0; n < 16; ++n) {
      const std::uint32_t more = whole_tile_ + whole_areas_[n];
      std::uint32_t* const count = count_ + n * kAreaSamples;
      for (std::size_t i = 0; more != 0 && i < kAreaSamples; i += kCellLanes)
        hn::Store(hn::Add(hn::Load(du, count + i), hn::Set(du, more)), du, count + i);
      whole_areas_[n] = 0;
    }
    whole_tile_ = 0;
  }

  const Record* records_ = nullptr;  // of the first piece at hand
  bool next_is_open_ = false;
  bool ranged_ = false;  // depths are clamped to the records' ranges
  bool hides_ = false;   // what lies behind the tile's depth may be left out
  std::size_t slots_ = 0;
  std::int32_t small_doubt_ = 0;  // the largest of those noted: at worst, doubts are looked into that are none
  const Record* record_[kSlots];
  std::uint32_t noted_[24] = {};  // of each row of cells from -4 on, the columns from -4 on of cells that are noted
  CellList partly_, wholly_, doubtful_;  // doubtful: drawn as special ones
  std::uint32_t whole_tile_ = 0, whole_areas_[16] = {};

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
  // Of a large triangle: steps to the cells of an area, and values at the areas' first samples.
  alignas(64) std::int32_t cell_step_[3][16], area_edge_[3][16];
  alignas(64) float cell_high_[16], cell_low_[16], area_high_[16], area_low_[16];
};

void DrawTiles(const FrameJob& frame, std::span<const Piece> pieces, const TileRow& tiles, Scratch& scratch,
               Rungs& rungs) {
  std::uint32_t* const list = scratch.pairs;
  if (tiles.depth == nullptr) {
    if (tiles.count != nullptr || frame.visitor != nullptr)
      TileDrawer<false, false, true>(frame, tiles, rungs).Run(pieces, list);
  } else if (tiles.count != nullptr) {
    TileDrawer<true, true, true>(frame, tiles, rungs).Run(pieces, list);
  } else if (tiles.winner != nullptr) {
    TileDrawer<true, true, false>(frame, tiles, rungs).Run(pieces, list);
  } else {
    TileDrawer<true, false, false>(frame, tiles, rungs).Run(pieces, list);
  }
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
