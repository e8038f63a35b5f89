// SPDX-License-Identifier: Apache-2.0
//
// Hierarchical z: how far the tile at hand and its blocks reach, so that what lies behind is left out.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP
#undef SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP
#else
#define SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP
#endif

#include "fast/fragments-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

class HierarchicalZ : public Fragments {
 public:
  using Fragments::Fragments;

 protected:
  // What depth there is in a tile that is selected.
  void UpdateFar() {
    for (std::size_t block = 0; block < kTileBlocks; ++block) UpdateBlockFar(block);
    UpdateTileFar();
  }
  // Block 8 y + x of the tile: four cells.
  HWY_INLINE void UpdateBlockFar(std::size_t block) {
    const CellFloat df;
    const float* const depth =
        depth_ + offset_in_tile(static_cast<int>(block & 7) * 8, static_cast<int>(block >> 3) * 8);
    auto far = hn::Load(df, depth);
    for (std::size_t n = 0; n < 4; ++n) {
      const std::size_t cell = (n & 1) * 16 + (n >> 1) * 64;
      for (std::size_t i = 0; i < kCellSamples; i += kCellLanes) far = hn::Max(far, hn::Load(df, depth + cell + i));
    }
    block_far_[block] = hn::GetLane(hn::MaxOfLanes(df, far));
  }
  HWY_INLINE void UpdateTileFar() {
    const CellFloat df;
    auto far = hn::Load(df, block_far_);
    for (std::size_t i = kCellLanes; i < kTileBlocks; i += kCellLanes) far = hn::Max(far, hn::Load(df, block_far_ + i));
    tile_far_ = hn::GetLane(hn::MaxOfLanes(df, far));
  }

  // Whether nothing of a triangle is seen where no depth is larger than `there`. Depths that are equal once they are
  // rounded may leave a smaller identifier in front.
  HWY_INLINE bool IsHidden(double nearest, float most, float there) const {
    nearest = std::min<double>(nearest, most);
    return with_identifiers_ ? static_cast<float>(nearest) > there : nearest >= there;
  }

  // Which of the four blocks of area n may hold something farther than the triangle: bit 0 the upper left one, then to
  // the right, then below. z: depth at the area's first sample; dips: to less than any in each block.
  HWY_INLINE std::uint32_t VisibleBlocks(double z, const double (&dips)[4], float most, std::uint32_t n) const {
    const float* const far = block_far_ + (n >> 2) * 16 + (n & 3) * 2;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    const hn::CappedTag<double, 4> d;
    const hn::CappedTag<float, 4> df;
    const hn::CappedTag<float, 2> row;
    const auto nearest = hn::Min(hn::Add(hn::Set(d, z), hn::LoadU(d, dips)), hn::Set(d, most));
    const auto there = hn::PromoteTo(d, hn::Combine(df, hn::LoadU(row, far + 8), hn::LoadU(row, far)));
    const auto hidden =
        with_identifiers_ ? hn::Gt(hn::PromoteTo(d, hn::DemoteTo(df, nearest)), there) : hn::Ge(nearest, there);
    return ~Bits(d, hidden) & 15;
#else
    std::uint32_t visible = 0;
    for (std::size_t i = 0; i < 4; ++i)
      visible |= static_cast<std::uint32_t>(!IsHidden(z + dips[i], most, far[(i >> 1) * 8 + (i & 1)])) << i;
    return visible;
#endif
  }

  float tile_far_ = 0;
  alignas(64) float block_far_[kTileBlocks];  // no depth in the block is larger
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP
