// SPDX-License-Identifier: Apache-2.0
//
// The records of a tile, in their order.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#undef SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#else
#define SUREFILL_SRC_FAST_DRAW_TILE_INL_HPP
#endif

#include "fast/draw_large-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

template <bool kDepth, bool kWinner, bool kCount>
class TileDrawer : public LargeTriangles<kDepth, kWinner, kCount> {
  using Base = LargeTriangles<kDepth, kWinner, kCount>;
  using Base::tiles_, Base::frame_, Base::job_, Base::depth_, Base::winner_, Base::count_, Base::ordered_,
      Base::tile_far_, Base::SelectTile, Base::SelectDraw, Base::UpdateFar, Base::ForgetFar, Base::Emit,
      Base::DrawByWinding, Base::NeedsDepth, Base::partly_, Base::ranged_, Base::hides_, Base::slots_, Base::kSlots,
      Base::AddSmall, Base::DrawSmall, Base::DrawTiny, Base::IsNoted, Base::ForgetSmall, Base::IsHiddenHere,
      Base::DrawLarge, Base::AddWholeAreas;

 public:
  using Base::Base;

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
          DrawLarge(r, false);
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
    if (!r.has(Record::kSmall)) return DrawLarge(r, true);
    AddSmall(r, NeedsDepth(r));
    Base::template DrawSpecialCells<true>(partly_);
    ForgetSmall();
  }

  const Record* records_ = nullptr;  // of the first piece at hand
  bool next_is_open_ = false;
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
