// SPDX-License-Identifier: Apache-2.0
//
// The sizes of the fast path, and what its two halves (tiles.cpp: who goes where; kernels.cpp: the vector code) share.
//
//   cell   4 x 4 samples   one vector of 16 lanes, 64 bytes of depth
//   block  8 x 8 samples   4 cells; the grain of hierarchical z
//   tile   64 x 64 samples the reach of int32 edge functions with one scale
//   bin    128 x 128       2 x 2 tiles; depth and winner of a bin stay in L2 while its triangles are drawn
#ifndef SUREFILL_SRC_BIN_HPP
#define SUREFILL_SRC_BIN_HPP

#include <cstdint>
#include <span>

#include "bounds.hpp"
#include "edge.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

constexpr int kCellLog2 = 2, kBlockLog2 = 3, kTileLog2 = 6, kBinLog2 = 7;
constexpr int kBinSize = 1 << kBinLog2;
constexpr int kBlocksAcross = kBinSize >> kBlockLog2;
constexpr std::size_t kBinSamples = std::size_t{kBinSize} * kBinSize;
constexpr std::size_t kBinBlocks = std::size_t{kBlocksAcross} * kBlocksAcross;

// Where sample (x, y) of a bin lies in the bin's buffers: block by block, in a block cell by cell, in a cell row by
// row.
constexpr std::size_t bin_offset(int x, int y) {
  const int block = (y >> kBlockLog2) * kBlocksAcross + (x >> kBlockLog2);
  const int cell = ((y >> kCellLog2) & 1) * 2 + ((x >> kCellLog2) & 1);
  return static_cast<std::size_t>(block * 64 + cell * 16 + (y & 3) * 4 + (x & 3));
}

// The buffers of one bin, kBinSamples each (kBinBlocks for block_far). Depth is kept so that smaller wins: negated for
// DepthTest::greater. The winner is the ordinal of the triangle that is seen: its position, counted over all draws.
struct BinBuffers {
  float* depth = nullptr;           // null if visibility is not wanted, and then winner and block_far are, too
  std::uint32_t* winner = nullptr;  //
  std::uint32_t* count = nullptr;   // null if counts are not wanted
  float* block_far = nullptr;       // no depth in the block is larger
};

// A triangle in a bin: its number within the chunk, and whether this is the bin that its box begins in.
struct BinEntry {
  std::uint32_t number : 31;
  std::uint32_t home : 1;
};

// Triangles of one draw to be drawn into one bin.
struct BinJob {
  const Draw* draw;
  std::uint32_t chunk_begin;    // position of the chunk's triangle 0 in the draw
  std::uint32_t first_ordinal;  // ordinal of the draw's triangle 0
  std::span<const BinEntry> entries;
  BinBuffers buffers;
  int bin_x, bin_y;  // the bin's first sample
  PixelBox region;   // bin, target and scissor, in target coordinates
  bool greater;
};

constexpr std::uint32_t kBatch = 8;  // triangles that are set up together

// The vector code for one instruction set.
struct Kernels {
  // Phase one: boxes of the triangles [first, first + count) of a draw, count <= kBatch; empty if there is nothing to
  // draw.
  void (*find_boxes)(const Draw& draw, bool check_attributes, std::uint32_t first, std::uint32_t count,
                     const PixelBox& limits, PixelBox* out, Statistics& statistics);
  // Phase two: all triangles of a bin.
  void (*rasterize)(const BinJob& job, Statistics& statistics);
  const char* name;
};

// For the best instruction set that this machine has (or that a test has chosen with hwy::SetSupportedTargetsForTest).
const Kernels& kernels();

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_BIN_HPP
