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

#include "canvas.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
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
alignas(64) constexpr double kColumnDouble[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr double kRowDouble[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

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

// Cells to be drawn: slot * 16 + number of the cell in the slot's area. Without a branch for each cell: how many there
// are is what a processor cannot guess.
struct CellList {
  std::uint8_t items[256 + 16];
  std::size_t size = 0;

  void Append(std::size_t slot, std::uint32_t cells) {
    const std::uint32_t low = cells & 0xFF, high = cells >> 8;
    const std::uint64_t base = slot * 16 * 0x0101010101010101u;
    const std::uint64_t first = kBitPositions.of[low] + base;
    const std::uint64_t second = kBitPositions.of[high] + base + 0x0808080808080808u;
    const std::size_t begin = size, middle = begin + static_cast<std::size_t>(__builtin_popcount(low));
    size = middle + static_cast<std::size_t>(__builtin_popcount(high));
    std::memcpy(items + begin, &first, 8);
    std::memcpy(items + middle, &second, 8);
  }
};

// Sixteen depths of a cell: base + lanes, rounded to float32. -0 becomes +0.
HWY_INLINE hn::Vec<CellFloat> RoundDepths(double base, const double* lanes) {
  const CellFloat df;
  const CellDouble dd;
  const hn::Rebind<float, CellDouble> dh;
  const auto start = hn::Set(dd, base);
#if HWY_TARGET == HWY_SCALAR
  const auto rounded = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes)));
#else
  const auto low = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes)));
  const auto high = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes + hn::Lanes(dd))));
  const auto rounded = hn::Combine(df, high, low);
#endif
  return hn::Add(rounded, hn::Zero(df));
}

// A triangle, as its cells need it. Small triangles of a batch have one each, all others use the first.
struct Slot {
  alignas(64) std::int32_t step[3][16];  // edge functions: from the first sample of a cell to its others
  alignas(64) double z_step[16];         // depth: the same
  alignas(64) float z_step_float[16];    // only where depth is not exact
  double z, z_x, z_y, z_error;
  int origin_x, origin_y;  // where depth is z
  std::int32_t a[3], b[3];
  std::int32_t most[3], least[3];  // largest and smallest change of an edge function within a cell; most: and `doubt`
  std::int32_t doubt;              // as in Batch
  std::uint32_t lane;              // of the batch
  std::uint32_t position;          // in the draw
  float z_least, z_most;           // of a snapped triangle; else z_most is infinite
  int first_x, last_x, first_y, last_y;  // only where lanes are looked at: samples that the triangle can cover
  bool slow_depth, clip;
  bool special;  // not drawn as most are

  double DepthAt(int x, int y) const { return z + (z_x * (x - origin_x) + z_y * (y - origin_y)); }
};
// An area of 16 x 16 samples: of a small triangle, or a sixteenth of a tile.
struct Area {
  alignas(64) std::int32_t edge[3][16];  // at the first sample of each cell
  alignas(64) double z[16];              // the same
  int x, y;                              // the first sample
  std::size_t offset;                    // of the first sample
  const std::uint32_t* cell_offset;      // and from there to each cell

  int CellX(std::size_t cell) const { return x + static_cast<int>(cell & 3) * 4; }
  int CellY(std::size_t cell) const { return y + static_cast<int>(cell >> 2) * 4; }
};

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_CELL_INL_HPP
