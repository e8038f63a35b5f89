// SPDX-License-Identifier: Apache-2.0
//
// What becomes of covered samples: counted, depth by filter, depth test, who is seen. What the vector arithmetic cannot
// tell goes to the scalar Triangle, sample by sample.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FRAGMENT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FRAGMENT_INL_HPP
#undef SUREFILL_SRC_FRAGMENT_INL_HPP
#else
#define SUREFILL_SRC_FRAGMENT_INL_HPP
#endif

#include "cell-inl.hpp"
#include "exact/exact_draw.hpp"
#include "planted.hpp"
#include "setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// kWinner and kCount only with a canvas that has them; kWinner implies kDepth.
template <bool kDepth, bool kWinner, bool kCount>
class FragmentWriter {
 public:
  FragmentWriter(const DrawJob& job, const Canvas& canvas, const BandSet& bands, Statistics& statistics)
      : job_(job), draw_(*job.draw), canvas_(canvas), statistics_(statistics) {
    if (canvas.masks != nullptr) marked_ = canvas.marked + static_cast<std::size_t>(bands.thread) * canvas.blocks();

    // Else what lies beyond the target is drawn where nobody looks.
    if (draw_.scissor || canvas.masks != nullptr) {
      const PixelBox& r = job.region;
      looks_at_lanes_ = ((r.x0 | r.y0) & 3) != 0 || (r.x1 & 3) != 0 || (r.y1 & 3) != 0;
    }
    // Moved outwards, two edges meet beyond the triangle's corner.
    looks_at_lanes_ = looks_at_lanes_ || draw_.conservative == Conservative::over;
    with_identifiers = kWinner && !draw_.identifiers.empty();
    snaps_ = kDepth && draw_.grid.has_value();
    ordered_ = with_identifiers || !draw_.depth_write;
    near_ = job.greater ? -1.0f : 0.0f, far_ = job.greater ? 0.0f : 1.0f;
    clamps = draw_.depth_mode == DepthMode::clamp;
  }

  // Is one of the lanes drawn in another way than most?
  bool AnySpecial(const Batch& batch, std::uint32_t lanes) const {
    if (looks_at_lanes_) return true;
    return kDepth && (kCount || ordered_ || snaps_ || ((batch.slow_depth | batch.clip) & lanes) != 0);
  }

  // Does the triangle in a lane of the batch cover the sample (x, y)? Exactly.
  HWY_NOINLINE bool Covers(const Batch& batch, std::uint32_t lane, int x, int y) {
    const PixelBox& r = job_.region;
    if (x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1) return false;
    if (draw_.grid) return SnappedCovers(*draw_.grid, batch, lane, Position(x, y), job_.shift);
    exact_.use(draw_, batch.position(lane));
    return draw_.conservative == Conservative::none ? exact_.covers(Position(x, y), job_.shift, statistics_)
                                                    : exact_.counts_square(x, y, statistics_);
  }

  // A covered sample that is drawn by exact arithmetic alone.
  HWY_NOINLINE void SlowFragment(std::uint32_t position, int x, int y) {
    const std::size_t offset = canvas_.offset_of(x, y);
    float z = 0;
    if (kDepth) {
      exact_.use(draw_, position);
      if (!exact_.depth(Position(x, y), &z, statistics_)) return;
      if (job_.greater) z = 0.0f - z;
    }
    if (kCount) CountOne(offset);
    if (kDepth && Passes(position, z, offset)) Store(position, z, offset);
  }

  // A covered sample whose depth is known, of a triangle that is not special.
  HWY_INLINE void Fragment(std::uint32_t position, float z, std::size_t offset) {
    if (Passes(position, z, offset)) Store(position, z, offset);
  }

  // The clipped triangle at `position`. Grid only.
  SnappedTriangle& Snapped(std::uint32_t position) {
    exact_.use(draw_, position);
    return exact_.snapped();
  }

  // Covered lanes at `at` whose depth lies between low and high, of a triangle whose ordinal is larger than that of any
  // drawn there before. Returns those of which more must be known. kSkip: leave early where nothing is seen, which pays
  // where that is likely.
  template <bool kSkip>
  HWY_INLINE hn::Mask<CellFloat> Fragments(hn::Mask<CellFloat> lanes, hn::Vec<CellFloat> low, hn::Vec<CellFloat> high,
                                           hn::Vec<CellUint> ordinal, std::size_t at) const {
    const CellFloat df;
    float* const depth = canvas_.depth + at;
    const auto before = hn::Load(df, depth);
    const auto seen = hn::And(lanes, hn::Lt(low, before));
    if (kSkip && hn::AllFalse(df, seen)) return seen;
    const auto known = hn::And(seen, hn::Eq(low, high));
    hn::Store(hn::IfThenElse(known, low, before), df, depth);
    if constexpr (kWinner) {
      const CellUint du;
      hn::BlendedStore(ordinal, hn::RebindMask(du, known), du, canvas_.winner + at);
    }
    return hn::AndNot(known, seen);
  }

  // Any covered lanes i ... of a cell, of a triangle in a lane of the batch, drawn at once. Its depth may not be known,
  // or clipped, or clamped; fragments may count; more than depth may say who is seen.
  HWY_NOINLINE void SpecialFragments(const Batch& batch, std::uint32_t lane, hn::Mask<CellInt> covered,
                                     hn::Vec<CellFloat> low, hn::Vec<CellFloat> high, int cell_x, int cell_y,
                                     std::size_t offset, std::size_t i) {
    [[maybe_unused]] const CellInt d;
    const CellFloat df;
    const std::uint32_t position = batch.position(lane);
    if (looks_at_lanes_) covered = hn::And(covered, LanesInBox(batch, lane, cell_x, cell_y, i));
    if constexpr (!kDepth) {
      Count(covered, offset + i);
      return;
    }
    if ((batch.slow_depth >> lane & 1) != 0) {
      SlowLanes(position, Bits(d, covered) << i, cell_x, cell_y);
      return;
    }
    auto lanes = hn::RebindMask(df, covered);
    if (snaps_) {
      const auto least = hn::Set(df, batch.z_least[lane]), most = hn::Set(df, batch.z_most[lane]);
      low = hn::Min(hn::Max(low, least), most);
      high = hn::Min(hn::Max(high, least), most);
    }
    if ((batch.clip >> lane & 1) != 0) {
      const auto least = hn::Set(df, near_), most = hn::Set(df, far_);
      if (clamps) {
        low = hn::Min(hn::Max(low, least), most);
        high = hn::Min(hn::Max(high, least), most);
      } else {
        const auto out = hn::Or(hn::Lt(high, least), hn::Gt(low, most));
        const auto in = hn::And(hn::Gt(low, least), hn::Lt(high, most));
        lanes = hn::AndNot(out, lanes);
        SlowLanes(position, Bits(df, hn::AndNot(in, lanes)) << i, cell_x, cell_y);
        lanes = hn::And(lanes, in);
      }
    }
    if (!kCount && !ordered_) lanes = hn::And(lanes, hn::Lt(low, hn::Load(df, canvas_.depth + offset + i)));
    const auto unknown = hn::AndNot(hn::Eq(low, high), lanes);
    SlowLanes(position, Bits(df, unknown) << i, cell_x, cell_y);
    lanes = hn::AndNot(unknown, lanes);
    if constexpr (kCount) Count(hn::RebindMask(d, lanes), offset + i);
    if (!ordered_) {
      Fragments<false>(lanes, low, low, hn::Set(CellUint(), Ordinal(position)), offset + i);
      return;
    }
    alignas(64) float depths[kCellLanes];
    hn::Store(low, df, depths);
    for (std::uint32_t bits = Bits(df, lanes); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(__builtin_ctz(bits));
      if (Passes(position, depths[k], offset + i + k)) Store(position, depths[k], offset + i + k);
    }
  }

  std::uint32_t Ordinal(std::uint32_t position) const { return job_.first_ordinal + position; }

  void SlowLanes(std::uint32_t position, std::uint32_t bits, int cell_x, int cell_y) {
    for (; bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits);
      SlowFragment(position, cell_x + (k & 3), cell_y + (k >> 2));
    }
  }

  HWY_INLINE void Count(hn::Mask<CellInt> covered, std::size_t at) {
    const CellInt d;
    const CellUint du;
    if (HWY_UNLIKELY(canvas_.masks != nullptr)) {
      Mark(Bits(d, covered), at);
      return;
    }
    const auto one = hn::BitCast(du, hn::VecFromMask(d, covered));  // -1 where covered
    hn::Store(hn::Sub(hn::Load(du, canvas_.count + at), one), du, canvas_.count + at);
  }
  void CountOne(std::size_t at) {
    if (canvas_.masks != nullptr) {
      Mark(1, at);
    } else {
      ++canvas_.count[at];
    }
  }
  void Mark(std::uint64_t lanes, std::size_t at) {
    if (lanes == 0) return;
    std::uint64_t& mask = canvas_.masks[at >> 6];
    if (mask == 0) marked_[marked_size_++] = static_cast<std::uint32_t>(at >> 6);
    mask |= lanes << (at & 63);
  }

  HWY_INLINE hn::Mask<CellInt> LanesInBox(const Batch& batch, std::uint32_t lane, int cell_x, int cell_y,
                                          std::size_t i) const {
    const CellInt d;
    const auto x = hn::Add(hn::Set(d, cell_x), hn::Load(d, kColumn + i));
    const auto y = hn::Add(hn::Set(d, cell_y), hn::Load(d, kRow + i));
    const auto is_in = [d](hn::Vec<CellInt> v, std::int32_t first, std::int32_t last) {
      return hn::And(hn::Lt(hn::Set(d, first - 1), v), hn::Lt(v, hn::Set(d, last + 1)));
    };
    return hn::And(is_in(x, batch.first_x[lane], batch.last_x[lane]),
                   is_in(y, batch.first_y[lane], batch.last_y[lane]));
  }

  // Hands the blocks that the triangle has marked to the visitor.
  void Emit(std::uint32_t position) {
    constexpr std::size_t kAtOnce = 64;
    CoverageBlock blocks[kAtOnce];
    std::size_t n = 0;
    const auto columns = static_cast<std::uint32_t>(canvas_.blocks_x());
    for (std::size_t i = 0; i < marked_size_; ++i) {
      const std::uint32_t block = marked_[i];
      blocks[n++] = {job_.number,
                     position,
                     static_cast<int>(block % columns) * 8,
                     static_cast<int>(block / columns) * 8,
                     job_.sample_number,
                     RowByRow(canvas_.masks[block])};
      canvas_.masks[block] = 0;
      if (n == kAtOnce || i + 1 == marked_size_) {
        canvas_.visitor->visit(canvas_.visitor->context, {blocks, n});
        n = 0;
      }
    }
    marked_size_ = 0;
  }

  bool with_identifiers = false, clamps = false;

 private:
  SamplePosition Position(int x, int y) const { return {x + job_.sample.x, y + job_.sample.y}; }

  void Store(std::uint32_t position, float z, std::size_t offset) {
    if (kWinner) canvas_.winner[offset] = Ordinal(position);
    if (draw_.depth_write) canvas_.depth[offset] = z;
  }

  // V1, V3 and M5: nearer, or as near as a triangle of this draw with a larger identifier; with depth write off,
  // nearer, and among the triangles of this draw the largest identifier. Uncertain samples come late: order is no help.
  bool Passes(std::uint32_t position, float z, std::size_t offset) const {
    const float stored = canvas_.depth[offset];
    if (!kWinner) return z < stored;
    const std::uint32_t winner = canvas_.winner[offset], other = winner - job_.first_ordinal;
    const bool of_this_draw = winner != kNoTriangle && winner >= job_.first_ordinal;
    if (!draw_.depth_write) return z < stored && (!of_this_draw || !Before(position, other));
    if (z < stored) return true;
    return z == stored && of_this_draw && Before(position, other);
  }
  // Is the triangle's identifier the smaller one?
  bool Before(std::uint32_t position, std::uint32_t other) const {
    if (SUREFILL_PLANT(merge_order)) return position < other;
    return with_identifiers ? draw_.identifiers[position] < draw_.identifiers[other] : position < other;
  }

  // The samples of a block as the canvas has them, cell by cell, in rows of eight.
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

  const DrawJob& job_;
  const Draw& draw_;
  const Canvas canvas_;
  Statistics& statistics_;
  bool snaps_ = false, ordered_ = false, looks_at_lanes_ = false;
  float near_ = 0, far_ = 1;
  std::uint32_t* marked_ = nullptr;  // blocks whose mask is not 0
  std::size_t marked_size_ = 0;
  ExactDraw exact_;
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FRAGMENT_INL_HPP
