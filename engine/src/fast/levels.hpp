// SPDX-License-Identifier: Apache-2.0
//
// The sizes of the fast path. Every other number is derived from these.
//
//   cell   4 x 4 samples    one vector of 16 lanes, 64 bytes of depth
//   block  8 x 8 samples    4 cells; the grain of hierarchical z and of streamed coverage
//   area   16 x 16 samples  16 cells; the reach of a small triangle's integers
//   tile   64 x 64 samples  16 areas; the reach of a large triangle's integers, and what is drawn at once
//   row    a row of tiles   what one thread draws, shades and stores
#ifndef SUREFILL_SRC_FAST_LEVELS_HPP
#define SUREFILL_SRC_FAST_LEVELS_HPP

#include <cstddef>
#include <cstdint>

namespace surefill::fast {

constexpr int kCellLog2 = 2, kBlockLog2 = 3, kAreaLog2 = 4, kTileLog2 = 6;
constexpr int kCellSize = 1 << kCellLog2, kBlockSize = 1 << kBlockLog2, kAreaSize = 1 << kAreaLog2;
constexpr int kTileSize = 1 << kTileLog2;
constexpr std::size_t kCellSamples = 16, kAreaSamples = 256, kTileSamples = 4096, kTileBlocks = 64;

// Triangles are set up eight at a time, and drawn a chunk at a time. A chunk is so many pieces, each set up by one
// thread: so many records and so many pairs of a record and a tile at most.
constexpr std::uint32_t kBatch = 8;
constexpr std::uint32_t kPieceRecords = 4096;
constexpr std::uint32_t kPiecePairs = 1 << 17;
constexpr std::size_t kPieces = 16;

// The benchmark builds the engine a second time without its filters, to say what exactness costs: coverage by rounded
// integers alone, depth in float32.
#if defined(SUREFILL_INEXACT_COVERAGE)
constexpr bool kExactCoverage = false;
#else
constexpr bool kExactCoverage = true;
#endif
#if defined(SUREFILL_INEXACT_DEPTH)
constexpr bool kExactDepth = false;
#else
constexpr bool kExactDepth = true;
#endif

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_LEVELS_HPP
