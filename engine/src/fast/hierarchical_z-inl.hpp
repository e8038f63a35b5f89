// SPDX-License-Identifier: Apache-2.0
//
// Hierarchical z: how far the tile at hand and its blocks reach, so that what lies behind is left out. It stands on the
// same two rules as is_hidden (culling.hpp).
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

// The columns and rows of blocks in a row of areas, area by area.
alignas(64) constexpr float kBlockColumn[16] = {0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7};
alignas(64) constexpr float kBlockRow[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

class HierarchicalZ : public Fragments {
 public:
  using Fragments::Fragments;

 protected:
  // What depth there is in a tile that is selected.
  void UpdateFar() {
    for (std::size_t block = 0; block < kTileBlocks; ++block) UpdateBlockFar(block);
    UpdateTileFar();
  }
  // The same of a tile that is all infinitely far.
  void ForgetFar() {
    tile_far_ = std::numeric_limits<float>::infinity();
    std::fill_n(block_far_, kTileBlocks, tile_far_);
  }
  // Block b of area n has the number 4 n + b: four cells.
  HWY_INLINE void UpdateBlockFar(std::size_t block) {
    const CellFloat df;
    const float* const depth = depth_ + (block >> 2) * kAreaSamples + (block >> 1 & 1) * 128 + (block & 1) * 32;
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

  // Which blocks of the tile may hold something farther than a large triangle. z: its depth at the tile's first sample;
  // fall: its largest change to less in one step each way. kFloatBlocks bounds what float32 adds to the error, in units
  // of the plane's size and of the error itself (docs/precision.md).
  HWY_INLINE std::uint64_t VisibleBlocks(const Record& r, double z, double fall) const {
    const CellFloat d;
    constexpr double kFloatBlocks = 0x1p-20, kSubnormal = 0x1p-120;
    const double size = std::fabs(z) + kTileSize * (std::fabs(r.large.z_x) + std::fabs(r.large.z_y));
    const double error = r.large.z_error + (kFloatBlocks * (size + r.large.z_error) + kSubnormal);
    const double least = z + (kBlockSize - 1) * fall - error;
    const float start = static_cast<float>(least), x = static_cast<float>(kBlockSize * r.large.z_x),
                y = static_cast<float>(kBlockSize * r.large.z_y);
    const auto most = hn::Set(d, r.z_most);
    std::uint64_t visible = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      const auto steps = hn::Add(hn::Mul(hn::Set(d, x), hn::Load(d, kBlockColumn + i)),
                                 hn::Mul(hn::Set(d, y), hn::Load(d, kBlockRow + i)));
      for (std::size_t row = 0; row < 4; ++row) {  // of areas
        const auto nearest = hn::Min(hn::Add(hn::Set(d, start + static_cast<float>(2 * row) * y), steps), most);
        const auto far = hn::Load(d, block_far_ + 16 * row + i);
        const auto hidden = with_identifiers_ ? hn::Gt(nearest, far) : hn::Ge(nearest, far);
        visible |= static_cast<std::uint64_t>(Bits(d, hn::Not(hidden))) << (16 * row + i);
      }
    }
    return visible;
  }
  // The blocks of an area that a set of cells has whole.
  static HWY_INLINE std::uint64_t WholeBlocks(std::uint32_t cells) {
    cells &= cells >> 1, cells &= cells >> 4;  // of each, its first cell
    return (cells & 1) | (cells >> 1 & 2) | (cells >> 6 & 4) | (cells >> 7 & 8);
  }

  float tile_far_ = 0;
  alignas(64) float block_far_[kTileBlocks];  // area by area: no depth in the block is larger
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_HIERARCHICAL_Z_INL_HPP
