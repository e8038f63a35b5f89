// SPDX-License-Identifier: Apache-2.0
//
// What block-inl.hpp draws with: the lanes of a cell, lists of cells, a triangle as its cells need it.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_CELL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_CELL_INL_HPP
#undef SUREFILL_SRC_CELL_INL_HPP
#else
#define SUREFILL_SRC_CELL_INL_HPP
#endif

#include <cstring>

#include "edges-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// The 16 samples of a cell, in as many vectors as it takes.
using CellInt = hn::CappedTag<std::int32_t, 16>;
using CellUint = hn::RebindToUnsigned<CellInt>;
using CellFloat = hn::RebindToFloat<CellInt>;
#if HWY_TARGET == HWY_SCALAR
using CellDouble = hn::CappedTag<double, 1>;
#else
using CellDouble = hn::Repartition<double, CellInt>;
#endif
constexpr std::size_t kCellLanes = hn::MaxLanes(CellInt());

// Sample k of a cell is (k & 3, k >> 2); so is cell k of an area of 16 x 16 samples, and area k of a tile.
alignas(64) constexpr std::int32_t kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr std::int32_t kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
alignas(64) constexpr float kColumnFloat[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr float kRowFloat[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

// Bits of the columns [first, last] and rows [first, last] of a 4 x 4 arrangement; the ranges are cut to 0..3.
inline std::uint32_t Mask4x4(int column0, int column1, int row0, int row1) {
  column0 = std::max(column0, 0), row0 = std::max(row0, 0), column1 = std::min(column1, 3), row1 = std::min(row1, 3);
  if (column0 > column1 || row0 > row1) return 0;
  const std::uint32_t columns = ((0xFu >> (3 - (column1 - column0))) << column0) * 0x1111u;
  const std::uint32_t rows = (0xFFFFu >> (4 * (3 - (row1 - row0)))) << (4 * row0);
  return columns & rows;
}

// The positions of the set bits of a byte, in order, and zeros.
struct BitPositions {
  std::uint64_t of[256];
  constexpr BitPositions() : of() {
    for (unsigned byte = 0; byte < 256; ++byte) {
      unsigned n = 0;
      for (unsigned bit = 0; bit < 8; ++bit) {
        if ((byte >> bit & 1) != 0) of[byte] |= std::uint64_t{bit} << (8 * n++);
      }
    }
  }
};
constexpr BitPositions kBitPositions;

// Cells to be drawn: area * 16 + number of the cell in the area. Without a branch for each cell: how many there are is
// what a processor cannot guess.
struct CellList {
  std::uint8_t items[256 + 16] = {};
  std::size_t size = 0;

  void Append(std::size_t area, std::uint32_t cells) {
    const std::uint32_t low = cells & 0xFF, high = cells >> 8;
    const std::uint64_t base = area * 16 * 0x0101010101010101u;
    const std::uint64_t first = kBitPositions.of[low] + base;
    const std::uint64_t second = kBitPositions.of[high] + base + 0x0808080808080808u;
    const std::size_t begin = size, middle = begin + static_cast<std::size_t>(__builtin_popcount(low));
    size = middle + static_cast<std::size_t>(__builtin_popcount(high));
    std::memcpy(items + begin, &first, 8);
    std::memcpy(items + middle, &second, 8);
  }
};

// Steps from the first sample of a cell to its others, 16 to a slot. Small triangles of a batch have a slot each, all
// others use the first.
//
// Depth has two parts. High parts are multiples of one quantum, so few of them that their sums are exact; low parts are
// what is left, here less and plus the bound of the whole error. So depth lies between high + low_least and high +
// low_most, and if both are rounded to the same float32, that is the stored depth (docs/precision.md).
struct Steps {
  alignas(64) std::int32_t edge[3][kBatch * 16];
  alignas(64) float high[kBatch * 16], low_least[kBatch * 16], low_most[kBatch * 16];
};

// Areas of 16 x 16 samples: of small triangles, each at the place of its slot, or the sixteen of a tile. At the first
// sample of each cell:
struct Areas {
  alignas(64) std::int32_t edge[3][256];
  alignas(64) float high[256], low[256];
  alignas(64) std::uint32_t offset[256];  // in the canvas
  int x[16], y[16];                       // first sample of the area

  int CellX(std::size_t item) const { return x[item >> 4] + static_cast<int>(item & 3) * 4; }
  int CellY(std::size_t item) const { return y[item >> 4] + static_cast<int>(item >> 2 & 3) * 4; }
};

// A triangle that is drawn tile by tile.
struct Plane {
  std::int32_t a[3], b[3];         // edge functions: steps of one sample
  std::int32_t most[3], least[3];  // their largest and smallest change within a cell; most: and `doubt`
  std::int32_t doubt;              // as in Batch
  std::uint32_t lane;              // of the batch
  double z, z_x, z_y, z_error;     // depth at the origin, its steps, its error
  int origin_x, origin_y;
  float z_most;  // no depth is larger: infinite, but under Grid
  bool hides;    // may what lies behind the canvas's depth be left out?

  double DepthAt(int x, int y) const { return z + (z_x * (x - origin_x) + z_y * (y - origin_y)); }
};

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_CELL_INL_HPP
