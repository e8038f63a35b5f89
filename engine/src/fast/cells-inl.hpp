// SPDX-License-Identifier: Apache-2.0
//
// The lanes of a cell, lists of cells, sets of cells.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_CELLS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_CELLS_INL_HPP
#undef SUREFILL_SRC_FAST_CELLS_INL_HPP
#else
#define SUREFILL_SRC_FAST_CELLS_INL_HPP
#endif

#include <cstring>

#include "fast/tile.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// The 16 samples of a cell, in as many vectors as it takes.
using CellInt = hn::CappedTag<std::int32_t, 16>;
using CellUint = hn::RebindToUnsigned<CellInt>;
using CellFloat = hn::RebindToFloat<CellInt>;
constexpr std::size_t kCellLanes = hn::MaxLanes(CellInt()), kCellVectors = 16 / kCellLanes;

// Sample k of a cell is (k & 3, k >> 2); so is cell k of an area, and area k of a tile.
alignas(64) constexpr std::int32_t kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr std::int32_t kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
// The same as floats; then of the next cell to the right, or below.
alignas(64) constexpr float kColumnFloat[32] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3,
                                                4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7};
alignas(64) constexpr float kRowFloat[32] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3,
                                             4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7};
alignas(64) constexpr std::uint32_t kSampleBit[16] = {1,     2,     4,     8,     0x10,   0x20,   0x40,   0x80,
                                                      0x100, 0x200, 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000};

// The lanes of a mask in which a value is not negative, for what looks at sign bits alone where a mask is a vector: IfThenElse
// of floats and Bits.
HWY_INLINE hn::Mask<CellFloat> NotNegative(hn::Vec<CellInt> value, hn::Mask<CellFloat> mask) {
#if HWY_ARCH_X86 && (HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4)
  const CellFloat d;
  return hn::MaskFromVec(hn::AndNot(hn::BitCast(d, value), hn::VecFromMask(d, mask)));
#else
  return hn::AndNot(hn::RebindMask(CellFloat(), hn::Lt(value, hn::Zero(CellInt()))), mask);
#endif
}

// The positions of the set bits of a byte, in order in memory, and zeros.
struct BitPositions {
  std::uint64_t of[256];
  static constexpr unsigned shift_of(unsigned n) { return 8 * (std::endian::native == std::endian::big ? 7 - n : n); }
  constexpr BitPositions() : of() {
    for (unsigned byte = 0; byte < 256; ++byte) {
      unsigned n = 0;
      for (unsigned bit = 0; bit < 8; ++bit) {
        if ((byte >> bit & 1) != 0) of[byte] |= std::uint64_t{bit} << shift_of(n++);
      }
    }
  }
};
constexpr BitPositions kBitPositions;

// Cells to be drawn: slot * 16 + number of the cell in it. Without a branch for each cell: how many there are is what a
// processor cannot guess.
struct CellList {
  std::uint8_t items[256 + 16] = {};
  std::size_t size = 0;

  void Append(std::size_t slot, std::uint32_t cells) {
    const std::uint32_t low = cells & 0xFF, high = cells >> 8;
    const std::uint64_t base = slot * 16 * 0x0101010101010101u;
    const std::uint64_t first = kBitPositions.of[low] + base;
    const std::uint64_t second = kBitPositions.of[high] + base + 0x0808080808080808u;
    const std::size_t begin = size, middle = begin + static_cast<std::size_t>(std::popcount(low));
    size = middle + static_cast<std::size_t>(std::popcount(high));
    std::memcpy(items + begin, &first, 8);
    std::memcpy(items + middle, &second, 8);
  }
};

// Where the cells of a column and of a row begin in a tile, with room for a small triangle's before and after.
struct CellOffsets {
  std::uint32_t column[24], row[24];
  constexpr CellOffsets() : column(), row() {
    for (int i = 0; i < 16; ++i) {
      column[i + 4] = static_cast<std::uint32_t>(offset_in_tile(4 * i, 0));
      row[i + 4] = static_cast<std::uint32_t>(offset_in_tile(0, 4 * i));
    }
  }
};
constexpr CellOffsets kCellOffsets;

// The cells of some blocks of an area, and of some rows.
constexpr std::uint16_t kCellsOfBlocks[16] = {0x0000, 0x0033, 0x00CC, 0x00FF, 0x3300, 0x3333, 0x33CC, 0x33FF,
                                              0xCC00, 0xCC33, 0xCCCC, 0xCCFF, 0xFF00, 0xFF33, 0xFFCC, 0xFFFF};
constexpr std::uint16_t kCellsOfRows[16] = {0x0000, 0x000F, 0x00F0, 0x00FF, 0x0F00, 0x0F0F, 0x0FF0, 0x0FFF,
                                            0xF000, 0xF00F, 0xF0F0, 0xF0FF, 0xFF00, 0xFF0F, 0xFFF0, 0xFFFF};

// Bits first .. last of sixteen; the range is cut to 0..15.
inline std::uint32_t BitRange(int first, int last) {
  return (0xFFFFu << std::max(first, 0)) & (0xFFFFu >> std::max(15 - last, 0));
}

// 0, v, 2 v, 3 v in the columns of a cell and u more in each row, in as many vectors as a cell takes.
template <class V>
struct CellVectors {
  V of[16 / kCellLanes];
};
HWY_INLINE CellVectors<hn::Vec<CellInt>> StepsOf(std::int32_t x, std::int32_t y) {
  const CellInt d;
  CellVectors<hn::Vec<CellInt>> steps;
  const auto column = hn::Mul(hn::Set(d, x), hn::Load(d, kColumn));
  for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
    const auto along_x = kCellLanes >= 4 ? column : hn::Mul(hn::Set(d, x), hn::Load(d, kColumn + n * kCellLanes));
    steps.of[n] = hn::Add(along_x, hn::Mul(hn::Set(d, y), hn::Load(d, kRow + n * kCellLanes)));
  }
  return steps;
}
HWY_INLINE CellVectors<hn::Vec<CellFloat>> StepsOf(float x, float y) {
  const CellFloat d;
  CellVectors<hn::Vec<CellFloat>> steps;
  for (std::size_t n = 0; n < 16 / kCellLanes; ++n) {
    steps.of[n] = hn::Add(hn::Mul(hn::Set(d, x), hn::Load(d, kColumnFloat + n * kCellLanes)),
                          hn::Mul(hn::Set(d, y), hn::Load(d, kRowFloat + n * kCellLanes)));
  }
  return steps;
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_CELLS_INL_HPP
