// SPDX-License-Identifier: Apache-2.0
//
// What becomes of samples that are not drawn as most are: whose coverage or depth the fast arithmetic cannot tell, that
// are clipped or streamed, that more than depth decides. A cell at a time, or a sample at a time by exact arithmetic.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_FRAGMENTS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_FRAGMENTS_INL_HPP
#undef SUREFILL_SRC_FAST_FRAGMENTS_INL_HPP
#else
#define SUREFILL_SRC_FAST_FRAGMENTS_INL_HPP
#endif

#include "fast/cells-inl.hpp"
#include "fast/edges-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// The tile at hand, and the draw.
class Fragments {
 public:
  Fragments(const FrameJob& frame, const TileRow& tiles, Rungs& rungs) : frame_(frame), tiles_(tiles), rungs_(rungs) {
    near_ = frame.greater() ? -1.0f : 0.0f, far_ = frame.greater() ? 0.0f : 1.0f;
  }

 protected:
  // The tile in a column of the row; it gets values, if it has none. Is it all infinitely far?
  bool SelectTile(int column) {
    tile_x_ = column * kTileSize, tile_y_ = tiles_.row * kTileSize;
    const std::size_t offset = tiles_.tile(column);
    depth_ = tiles_.depth != nullptr ? tiles_.depth + offset : nullptr;
    winner_ = tiles_.winner != nullptr ? tiles_.winner + offset : nullptr;
    count_ = tiles_.count != nullptr ? tiles_.count + offset : nullptr;
    std::uint8_t& opened = tiles_.opened[column - tiles_.begin];
    if (opened != 0) return false;
    opened = 1;
    return Open();
  }

  void SelectDraw(const DrawJob& job) {
    job_ = &job;
    const Draw& draw = *job.draw;
    with_identifiers_ = tiles_.winner != nullptr && !draw.identifiers.empty();
    ordered_ = with_identifiers_ || (tiles_.winner != nullptr && !draw.depth_write);
  }

  std::uint32_t Ordinal(const Record& r) const { return job_->first_ordinal + r.position; }

  // ---- sample by sample
  // Does the triangle cover the sample at an offset of the tile? Exactly.
  HWY_NOINLINE bool Covers(const Record& r, std::size_t offset) {
    const int x = tile_x_ + column_of(offset), y = tile_y_ + row_of(offset);
    if (!job_->region.contains(x, y)) return false;
    const Draw& draw = *job_->draw;
    exact_.use(draw, r.position);
    if (draw.conservative != Conservative::none)
      return exact_.draws_square(x + job_->origin.x, y + job_->origin.y, &rungs_);
    if (r.fan_triangle() != 0) return exact_.snapped().fan_covers(r.fan_triangle(), Position(x, y), job_->shift);
    return exact_.draws(Position(x, y), job_->shift, &rungs_);
  }

  // The depth of a large record's sample, as it is kept, if its plane in double tells: a tile's parts are coarser. Not
  // 0, whose sign it does not tell.
  bool DepthByPlane(const Record& r, std::size_t offset, float& depth) {
    if (r.has(Record::kSmall | Record::kSlowDepth | Record::kClip | Record::kByWinding)) return false;
    const double z = r.large.z + (r.large.z_x * (tile_x_ + column_of(offset) - r.origin_x()) +
                                  r.large.z_y * (tile_y_ + row_of(offset) - r.origin_y()));
    const auto rounded = [&](double v) { return std::clamp(static_cast<float>(v), r.z_least, r.z_most); };
    depth = rounded(z - r.large.z_error);
    if (depth != rounded(z + r.large.z_error) || depth == 0) return false;
    ++rungs_.values_by_filter;
    return true;
  }

  // Draws a covered sample. `counted`: it is in the counts already.
  HWY_NOINLINE void ExactFragment(const Record& r, std::size_t offset, bool counted) {
    float z = 0;
    const bool needed = depth_ != nullptr || r.has(Record::kClip | Record::kByWinding);
    if (needed && !DepthByPlane(r, offset, z)) {
      exact_.use(*job_->draw, r.position);
      if (!exact_.depth(Position(tile_x_ + column_of(offset), tile_y_ + row_of(offset)), &z, &rungs_)) return;
      if (job_->greater) z = 0.0f - z;
    }
    if (!counted) Count(1, offset);
    if (depth_ != nullptr && Passes(r.position, z, offset)) Store(r.position, z, offset);
  }

  // The lanes `bits` from an offset on: covered ones, and those that may be.
  void ExactLanes(const Record& r, std::uint32_t bits, std::size_t offset, bool counted) {
    for (; bits != 0; bits &= bits - 1)
      ExactFragment(r, offset + static_cast<std::size_t>(std::countr_zero(bits)), counted);
  }
  HWY_NOINLINE void SettleLanes(const Record& r, std::uint32_t bits, std::size_t offset) {
    for (; bits != 0; bits &= bits - 1) {
      const std::size_t at = offset + static_cast<std::size_t>(std::countr_zero(bits));
      if (Covers(r, at)) ExactFragment(r, at, false);
    }
  }

  // A polygon that Grid has clipped and that turns both ways: its winding number decides.
  HWY_NOINLINE void DrawByWinding(const Record& r) {
    const int x1 = std::min<int>(r.x1 - tile_x_, kTileSize - 1), y1 = std::min<int>(r.y1 - tile_y_, kTileSize - 1);
    for (int y = std::max(r.y0 - tile_y_, 0); y <= y1; ++y) {
      for (int x = std::max(r.x0 - tile_x_, 0); x <= x1; ++x) {
        exact_.use(*job_->draw, r.position);
        if (exact_.draws(Position(tile_x_ + x, tile_y_ + y), job_->shift))
          ExactFragment(r, offset_in_tile(x, y), false);
      }
    }
  }

  // ---- cell by cell
  // Draws covered lanes from an offset on, of depth between low and high. Depth may not be known, or clipped, or
  // clamped; more than depth may say who is seen.
  HWY_NOINLINE void SpecialLanes(const Record& r, hn::Mask<CellInt> covered, hn::Vec<CellFloat> low,
                                 hn::Vec<CellFloat> high, std::size_t offset) {
    const CellInt d;
    const CellFloat df;
    if (r.has(Record::kBorder)) covered = hn::And(covered, LanesInBox(r, offset));
    const bool clips = r.has(Record::kClip);
    if (depth_ == nullptr && !clips) {
      CountLanes(covered, offset);
      return;
    }
    if (r.has(Record::kSlowDepth)) {
      ExactLanes(r, Bits(d, covered), offset, false);
      return;
    }
    auto lanes = hn::RebindMask(df, covered);
    const auto least = hn::Set(df, r.z_least), most = hn::Set(df, r.z_most);
    low = hn::Min(hn::Max(low, least), most), high = hn::Min(hn::Max(high, least), most);
    if (clips) {
      const auto near = hn::Set(df, near_), far = hn::Set(df, far_);
      const auto out = hn::Or(hn::Lt(high, near), hn::Gt(low, far));
      const auto in = hn::And(hn::Gt(low, near), hn::Lt(high, far));
      lanes = hn::AndNot(out, lanes);
      ExactLanes(r, Bits(df, hn::AndNot(in, lanes)), offset, false);
      lanes = hn::And(lanes, in);
    }
    CountLanes(hn::RebindMask(d, lanes), offset);
    if (depth_ == nullptr) return;
    const auto before = hn::Load(df, depth_ + offset);
    lanes = hn::And(lanes, ordered_ ? hn::Le(low, before) : hn::Lt(low, before));
    const auto unknown = hn::AndNot(hn::Eq(low, high), lanes);
    lanes = hn::AndNot(unknown, lanes);
    if (HWY_UNLIKELY(ordered_)) {
      alignas(64) float depths[kCellLanes];
      hn::Store(low, df, depths);
      for (std::uint32_t bits = Bits(df, lanes); bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(bits));
        if (Passes(r.position, depths[k], offset + k)) Store(r.position, depths[k], offset + k);
      }
    } else {
      const CellUint du;
      hn::Store(hn::IfThenElse(lanes, low, before), df, depth_ + offset);
      if (winner_ != nullptr) {
        const auto winner = hn::Load(du, winner_ + offset);
        hn::Store(hn::IfThenElse(hn::RebindMask(du, lanes), hn::Set(du, Ordinal(r)), winner), du, winner_ + offset);
      }
    }
    ExactLanes(r, Bits(df, unknown), offset, true);
  }
  HWY_INLINE void CountLanes(hn::Mask<CellInt> covered, std::size_t offset) {
    const CellInt d;
    const CellUint du;
    if (HWY_UNLIKELY(count_ == nullptr)) return Count(Bits(d, covered), offset);
    const auto one = hn::BitCast(du, hn::VecFromMask(d, covered));  // -1 where covered
    hn::Store(hn::Sub(hn::Load(du, count_ + offset), one), du, count_ + offset);
  }

  // ---- streamed coverage
  // Hands the blocks that the triangle has marked to the visitor.
  HWY_NOINLINE void Emit(std::uint32_t position) {
    CoverageBlock blocks[kTileBlocks];
    std::size_t n = 0;
    for (; marked_ != 0; marked_ &= marked_ - 1) {
      const auto block = static_cast<std::size_t>(std::countr_zero(marked_));
      blocks[n++] = {job_->number,
                     position,
                     tile_x_ + static_cast<int>(block & 7) * kBlockSize,
                     tile_y_ + static_cast<int>(block >> 3) * kBlockSize,
                     job_->sample_number,
                     RowByRow(masks_[block])};
      masks_[block] = 0;
    }
    if (n != 0) frame_.visitor->visit(frame_.visitor->context, {blocks, n});
  }

  const FrameJob& frame_;
  const TileRow& tiles_;
  Rungs& rungs_;
  const DrawJob* job_ = nullptr;
  int tile_x_ = 0, tile_y_ = 0;  // the tile's first sample
  float* depth_ = nullptr;
  std::uint32_t *winner_ = nullptr, *count_ = nullptr;
  float near_, far_;  // depth is clipped to
  bool with_identifiers_ = false;
  bool ordered_ = false;  // more than depth and the order of triangles says who is seen
  ExactDraw exact_;

 private:
  SamplePosition Position(int x, int y) const { return {x + job_->sample.x, y + job_->sample.y}; }

  // The empty image, in the tile at hand. Is all of it infinitely far?
  HWY_NOINLINE bool Open() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (count_ != nullptr) std::fill_n(count_, kTileSamples, 0u);
    if (winner_ != nullptr) std::fill_n(winner_, kTileSamples, kNoTriangle);
    if (depth_ == nullptr) return true;
    std::fill_n(depth_, kTileSamples, kInfinity);
    const Target& target = *frame_.target;
    const bool initial = !target.initial_depth.empty();
    const int columns = target.width - tile_x_, rows = target.height - tile_y_;
    if (!initial && columns >= kTileSize && rows >= kTileSize) return true;
    for (int y = 0; y < kTileSize; y += kCellSize) {
      for (int x = 0; x < kTileSize; x += kCellSize) {
        float* const cell = depth_ + offset_in_tile(x, y);
        if (x >= columns || y >= rows) {
          std::fill_n(cell, kCellSamples, -kInfinity);
        } else if (initial || x + kCellSize > columns || y + kCellSize > rows) {
          OpenCell(cell, x, y);
        }
      }
    }
    return false;
  }

  // The cell from (x, y) of the tile on, where it has initial depth or the target ends within it.
  void OpenCell(float* cell, int x, int y) const {
    const Target& target = *frame_.target;
    for (int k = 0; k < static_cast<int>(kCellSamples); ++k) {
      const int px = tile_x_ + x + (k & 3), py = tile_y_ + y + (k >> 2);
      if (px >= target.width || py >= target.height) {
        cell[k] = -std::numeric_limits<float>::infinity();
      } else if (!target.initial_depth.empty()) {
        cell[k] = kept_depth(target, target.initial_depth[frame_.sample_index(px, py)]);
      }
    }
  }

  // Lanes from an offset on that lie in the box of a record.
  hn::Mask<CellInt> LanesInBox(const Record& r, std::size_t offset) const {
    const CellInt d;
    const std::size_t cell = offset & ~std::size_t{15}, lane = offset & 15;
    const auto x = hn::Add(hn::Set(d, tile_x_ + column_of(cell)), hn::Load(d, kColumn + lane));
    const auto y = hn::Add(hn::Set(d, tile_y_ + row_of(cell)), hn::Load(d, kRow + lane));
    const auto is_in = [d](hn::Vec<CellInt> v, std::int32_t first, std::int32_t last) {
      return hn::And(hn::Lt(hn::Set(d, first - 1), v), hn::Lt(v, hn::Set(d, last + 1)));
    };
    return hn::And(is_in(x, r.x0, r.x1), is_in(y, r.y0, r.y1));
  }

  void Count(std::uint32_t bits, std::size_t offset) {
    if (frame_.visitor != nullptr) {
      if (bits == 0) return;
      const auto block = static_cast<std::size_t>((row_of(offset) >> 3) * 8 + (column_of(offset) >> 3));
      const std::size_t cell = (offset >> 4 & 1) + (offset >> 5 & 2);
      marked_ |= std::uint64_t{1} << block;
      masks_[block] |= static_cast<std::uint64_t>(bits) << (16 * cell + (offset & 15));
      return;
    }
    if (count_ == nullptr) return;
    for (; bits != 0; bits &= bits - 1) ++count_[offset + static_cast<std::size_t>(std::countr_zero(bits))];
  }

  void Store(std::uint32_t position, float z, std::size_t offset) {
    if (winner_ != nullptr) winner_[offset] = job_->first_ordinal + position;
    if (job_->draw->depth_write) depth_[offset] = z;
  }

  // V1, V3 and M5: nearer, or as near as a triangle of this draw with a larger identifier; with depth write off,
  // nearer, and among the triangles of this draw the largest identifier. Uncertain samples come late: order is no help.
  bool Passes(std::uint32_t position, float z, std::size_t offset) const {
    const float stored = depth_[offset];
    if (winner_ == nullptr) return z < stored;
    const std::uint32_t winner = winner_[offset], other = winner - job_->first_ordinal;
    const bool of_this_draw = winner != kNoTriangle && winner >= job_->first_ordinal;
    if (!job_->draw->depth_write) return z < stored && (!of_this_draw || !Before(position, other));
    if (z < stored) return true;
    return z == stored && of_this_draw && Before(position, other);
  }
  // Is the triangle's identifier the smaller one?
  bool Before(std::uint32_t position, std::uint32_t other) const {
    const Draw& draw = *job_->draw;
    return with_identifiers_ ? draw.identifiers[position] < draw.identifiers[other] : position < other;
  }

  // The samples of a block, cell by cell, in rows of eight.
  static std::uint64_t RowByRow(std::uint64_t cells) {
    // The rows of two cells, of four bits each, become bytes; one goes to the low halves, the other to the high ones.
    const auto spread = [](std::uint64_t v) {
      v = (v | v << 8) & 0x00FF00FF;
      return (v | v << 4) & 0x0F0F0F0F;
    };
    const std::uint64_t upper = spread(cells & 0xFFFF) | spread(cells >> 16 & 0xFFFF) << 4;
    const std::uint64_t lower = spread(cells >> 32 & 0xFFFF) | spread(cells >> 48) << 4;
    return upper | lower << 32;
  }

  std::uint64_t masks_[kTileBlocks] = {};  // of the triangle at hand
  std::uint64_t marked_ = 0;               // blocks whose mask is not 0
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_FRAGMENTS_INL_HPP
