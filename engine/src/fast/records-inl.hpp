// SPDX-License-Identifier: Apache-2.0
//
// A piece of a draw becomes records, and each tile's list of them.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_RECORDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_RECORDS_INL_HPP
#undef SUREFILL_SRC_FAST_RECORDS_INL_HPP
#else
#define SUREFILL_SRC_FAST_RECORDS_INL_HPP
#endif

#include <cstddef>
#include <cstring>

#include "fast/set_up-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// Writes the records of a piece, and for each the tiles that it meets.
class PieceWriter {
 public:
  PieceWriter(const TileGrid& grid, Piece& piece, Scratch& scratch)
      : grid_(grid), piece_(piece), job_(*piece.job), pairs_(scratch.pairs) {
    std::fill_n(piece.begin, grid.tiles() + 2, 0u);
    has_border_ = job_.draw->conservative == Conservative::over || job_.draw->scissor || job_.streams;
    if (!job_.draw->scissor && !job_.streams) return;  // what lies beyond the target is drawn where nobody looks
    const PixelBox& r = job_.region;
    if ((r.x0 & 3) != 0) border_x0_ = r.x0;
    if ((r.y0 & 3) != 0) border_y0_ = r.y0;
    if ((r.x1 & 3) != 0) border_x1_ = r.x1 - 1;
    if ((r.y1 & 3) != 0) border_y1_ = r.y1 - 1;
  }

  // Before lanes of a batch are added: the words of small ones, four together of each lane.
  HWY_INLINE void Take(const Batch& batch) {
    const hn::CappedTag<std::uint32_t, kBatch> d;
    const auto* from =
        reinterpret_cast<const std::uint32_t*>(reinterpret_cast<const char*>(&batch) + offsetof(Batch, a));
    for (std::size_t n = 0; n < 5; ++n, from += 4 * kBatch) {
      for (std::uint32_t lane = 0; lane < kBatch; lane += kWide) {
        const auto word = [&](std::size_t k) { return hn::Load(d, from + k * kBatch + lane); };
        hn::StoreInterleaved4(word(0), word(1), word(2), word(3), d, words_[n][lane]);
      }
    }
  }
  // Adds a lane of the batch that was taken. False if there is no room.
  HWY_INLINE bool Add(const Batch& batch, std::uint32_t lane, std::uint32_t fan_triangle) {
    if (HWY_UNLIKELY(records_ == kPieceRecords)) return false;
    Record& r = piece_.records[records_];
    const bool small = (batch.small >> lane & 1) != 0;
    FillBox(r, batch.first_x[lane], batch.first_y[lane], batch.last_x[lane], batch.last_y[lane]);
    r.position = batch.position[lane];
    r.z_least = batch.z_least[lane], r.z_most = batch.z_most[lane];
    const std::uint32_t slow = batch.slow_depth & (job_.depth ? ~0u : batch.clip);
    std::uint32_t flags = fan_triangle * Record::kFirstOfFan;
    if (((slow | batch.clip) >> lane & 1) != 0)
      flags |= (slow >> lane & 1) * Record::kSlowDepth | (batch.clip >> lane & 1) * Record::kClip;
    if (has_border_ && TouchesBorder(r)) flags |= Record::kBorder;
    if (small) {
      FillSmall(r, lane);
      flags |= Record::kSmall | (batch.tiny >> lane & 1) * Record::kTiny;
    } else {
      FillLarge(r, batch, lane);
      flags |= (batch.thin >> lane & 1) * Record::kThin;
      if ((batch.integer >> lane & 1) != 0) {
        flags |= Record::kInteger;
        for (std::uint32_t i = 0; i < 3; ++i) flags |= (batch.tie_lost[i] >> lane & 1) * Record::kTieIsLost << i;
      }
    }
    r.flags = static_cast<std::uint16_t>(flags);
    if (!(small ? ListBox(r) : ListEdges(r))) return false;
    ++records_;
    return true;
  }

  // Adds a clipped triangle as one record, to be drawn sample by sample.
  bool AddByWinding(std::uint32_t position, const PixelBox& box) {
    if (records_ == kPieceRecords) return false;
    Record& r = piece_.records[records_];
    FillBox(r, box.x0, box.y0, box.x1 - 1, box.y1 - 1);
    r.position = position;
    r.flags = Record::kByWinding;
    if (!ListBox(r)) return false;
    ++records_;
    return true;
  }

  struct Mark {
    std::uint32_t records;
    std::size_t pairs;
  };
  Mark Now() const { return {records_, size_}; }
  // Takes away what was added since.
  void GoBack(const Mark& mark) {
    records_ = mark.records;
    while (size_ > mark.pairs) --piece_.begin[(pairs_[--size_] >> 16) + 2];
  }
  bool IsEmpty() const { return records_ == 0; }

  void Finish() {
    piece_.size = records_;
    sort_pairs(grid_, pairs_, size_, piece_);
  }

 private:
  static HWY_INLINE void FillBox(Record& r, int x0, int y0, int x1, int y1) {
    r.x0 = static_cast<std::uint16_t>(x0), r.y0 = static_cast<std::uint16_t>(y0);
    r.x1 = static_cast<std::uint16_t>(x1), r.y1 = static_cast<std::uint16_t>(y1);
  }
  HWY_INLINE void FillSmall(Record& r, std::uint32_t lane) const {
    for (std::size_t n = 0; n < 5; ++n)
      std::memcpy(reinterpret_cast<char*>(&r.small) + 16 * n, words_[n][lane], sizeof words_[n][lane]);
  }
  static HWY_INLINE void FillLarge(Record& r, const Batch& batch, std::uint32_t lane) {
    for (std::size_t k = 0; k < 3; ++k) {
      r.large.a[k] = batch.scaled_a[k][lane], r.large.b[k] = batch.scaled_b[k][lane];
      r.large.c[k] = batch.scaled_c[k][lane];
    }
    r.large.z = batch.plane[lane], r.large.z_x = batch.plane_x[lane], r.large.z_y = batch.plane_y[lane];
    r.large.z_error = batch.plane_error[lane];
  }

  // The box ends where the region does, and that is within a cell; over needs the box itself (docs/precision.md).
  HWY_NOINLINE bool TouchesBorder(const Record& r) const {
    return r.x0 == border_x0_ || r.y0 == border_y0_ || r.x1 == border_x1_ || r.y1 == border_y1_ ||
           job_.draw->conservative == Conservative::over;
  }

  HWY_INLINE void Pair(int tile_x, int tile_y) {
    const auto tile = static_cast<std::size_t>(tile_y * grid_.columns + tile_x);
    ++piece_.begin[tile + 2];
    pairs_[size_++] = pair_of(tile, records_);
  }

  // In all tiles of the box.
  HWY_INLINE bool ListBox(const Record& r) {
    const int tx0 = r.x0 >> kTileLog2, tx1 = r.x1 >> kTileLog2, ty0 = r.y0 >> kTileLog2, ty1 = r.y1 >> kTileLog2;
    if (HWY_LIKELY(((tx0 ^ tx1) | (ty0 ^ ty1)) == 0 && size_ < kPiecePairs)) {
      Pair(tx0, ty0);
      return true;
    }
    const auto tiles = static_cast<std::size_t>((tx1 - tx0 + 1) * (ty1 - ty0 + 1));
    if (size_ + tiles > kPiecePairs) return false;
    for (int ty = ty0; ty <= ty1; ++ty) {
      for (int tx = tx0; tx <= tx1; ++tx) Pair(tx, ty);
    }
    return true;
  }

  // In the tiles of the box that no edge excludes. 1: far more than the error of an edge here.
  HWY_NOINLINE bool ListEdges(const Record& r) {
    const DoubleTag d;
    const int tx0 = r.x0 >> kTileLog2, ty0 = r.y0 >> kTileLog2;
    const int tx1 = r.x1 >> kTileLog2, ty1 = r.y1 >> kTileLog2;
    Double a[3], least[3];
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = hn::Set(d, r.large.a[k]);
      least[k] = hn::Set(d, -((kTileSize - 1) * (std::max(r.large.a[k], 0.0) + std::max(r.large.b[k], 0.0)) + 1));
    }
    const Double steps = hn::Load(d, kTileSteps);
    for (int ty = ty0; ty <= ty1; ++ty) {
      if (HWY_UNLIKELY(size_ + static_cast<std::size_t>(tx1 - tx0) + kGroup > kPiecePairs)) return false;
      const double y = ty * kTileSize + job_.sample.y;
      for (int tx = tx0; tx <= tx1; tx += static_cast<int>(kGroup)) {
        const Double x = hn::Add(hn::Set(d, tx * kTileSize + job_.sample.x), steps);
        auto outside = hn::Lt(x, x);  // none
        for (std::size_t k = 0; k < 3; ++k) {
          const Double e = hn::Add(hn::Mul(a[k], x), hn::Set(d, r.large.b[k] * y + r.large.c[k]));
          outside = hn::Or(outside, hn::Lt(e, least[k]));
        }
        std::uint32_t possible = ~Bits(d, outside) & kGroupLanes;
        if (tx1 - tx + 1 < static_cast<int>(kGroup)) possible &= (1u << (tx1 - tx + 1)) - 1;
        for (; possible != 0; possible &= possible - 1) Pair(tx + std::countr_zero(possible), ty);
      }
    }
    return true;
  }
  alignas(64) static constexpr double kTileSteps[8] = {0, 64, 128, 192, 256, 320, 384, 448};

  const TileGrid grid_;
  Piece& piece_;
  const DrawJob& job_;
  std::uint32_t* const pairs_;
  std::uint32_t records_ = 0;
  std::size_t size_ = 0;  // of pairs_
  bool has_border_ = false;
  alignas(64) std::uint32_t words_[5][kBatch][4];
  int border_x0_ = -1, border_y0_ = -1, border_x1_ = -1, border_y1_ = -1;  // where cells reach beyond the region
};

// Adds the fan of a clipped triangle or, where that turns both ways or takes too much room, the triangle itself.
HWY_NOINLINE bool AddClipped(const DrawJob& job, std::uint32_t position, PieceWriter& writer, Rungs& rungs) {
  SnappedTriangle snapped;
  const auto vertex = [&](std::size_t k) { return vertex_of(*job.draw, position, k); };
  snapped.set_up(vertex(0), vertex(1), vertex(2), *job.draw->grid);
  Batch fan;
  bool turns;
  std::uint32_t lanes = SetUpFan(job, position, snapped, fan, turns, rungs);
  const auto before = writer.Now();
  bool fits = !turns;
  if (lanes != 0) writer.Take(fan);
  for (; fits && lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
    fits = writer.Add(fan, lane, lane + 1);
  }
  if (fits) return true;
  writer.GoBack(before);
  if (!turns && !writer.IsEmpty()) return false;
  const double least = std::min(job.sample.x, job.sample.y), most = std::max(job.sample.x, job.sample.y);
  return writer.AddByWinding(position, snapped.box(job.region, least, most));
}

// Counts lanes of a batch, by what becomes of them.
HWY_INLINE void CountLanes(const Batch& batch, std::uint32_t lanes, std::uint32_t drawn, Diagnostics& diagnostics) {
  const auto ones = [lanes](std::uint32_t set) { return static_cast<std::uint64_t>(std::popcount(set & lanes)); };
  diagnostics.outside += ones(batch.finite & ~(batch.reached | batch.clipped));
  diagnostics.small += ones(drawn & batch.small);
  diagnostics.medium += ones(drawn & batch.medium & ~batch.small);
  diagnostics.large += ones(drawn & ~batch.medium & ~batch.small);
  diagnostics.clipped += ones(batch.clipped);
}

// Sets up the triangles of a piece, as far as its lists have room.
void SetUp(const TileGrid& grid, Piece& piece, Scratch& scratch, Diagnostics& diagnostics) {
  const DrawJob& job = *piece.job;
  PieceWriter writer(grid, piece, scratch);
  Batch batch;
  for (bool fits = true; fits && piece.next < piece.end;) {
    const std::uint32_t first = piece.next, count = std::min(kBatch, piece.end - first);
    const std::uint32_t drawn = SetUpBatch(job, first, count, batch, diagnostics.rungs);
    if (HWY_UNLIKELY(batch.clipped != 0)) FindClipped(job, batch, diagnostics.rungs);
    std::uint32_t done = count;
    if (batch.small != 0) writer.Take(batch);
    for (std::uint32_t lanes = (drawn & ~batch.empty) | batch.clipped; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const bool clipped = HWY_UNLIKELY((batch.clipped >> lane & 1) != 0);
      const auto before = writer.Now();
      fits = clipped ? AddClipped(job, first + lane, writer, diagnostics.rungs) : writer.Add(batch, lane, 0);
      if (clipped) writer.Take(batch);
      if (fits) continue;
      writer.GoBack(before);
      done = lane;
      break;
    }
    CountLanes(batch, (1u << done) - 1, drawn, diagnostics);
    piece.next += done;
  }
  writer.Finish();
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_RECORDS_INL_HPP
