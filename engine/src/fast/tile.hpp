// SPDX-License-Identifier: Apache-2.0
//
// The image while it is drawn: tile by tile, in a tile area by area, in an area cell by cell, in a cell row by row.
#ifndef SUREFILL_SRC_FAST_TILE_HPP
#define SUREFILL_SRC_FAST_TILE_HPP

#include <cmath>
#include <limits>
#include <span>

#include "fast/lists.hpp"

namespace surefill::fast {

// Where sample (x, y) of a tile lies.
constexpr std::size_t offset_in_tile(int x, int y) {
  const int area = (y >> kAreaLog2) * 4 + (x >> kAreaLog2), cell = (y >> kCellLog2 & 3) * 4 + (x >> kCellLog2 & 3);
  return static_cast<std::size_t>(area * 256 + cell * 16 + (y & 3) * 4 + (x & 3));
}
constexpr int column_of(std::size_t offset) {
  return static_cast<int>((offset >> 8 & 3) * 16 + (offset >> 4 & 3) * 4 + (offset & 3));
}
constexpr int row_of(std::size_t offset) {
  return static_cast<int>((offset >> 10 & 3) * 16 + (offset >> 6 & 3) * 4 + (offset >> 2 & 3));
}

// A row of tiles, or some of its neighbours: columns [begin, end) of row `row`. One sample of every pixel. Depth is
// kept so that smaller wins: negated for DepthTest::greater; beyond the target it is -inf, which nothing beats. The
// winner is the ordinal of the triangle that is seen, or kNoTriangle.
struct TileRow {
  int row = 0, begin = 0, end = 0;
  float* depth = nullptr;           // of the first tile; null if neither depth nor visibility is wanted
  std::uint32_t* winner = nullptr;  // null if visibility is not wanted
  std::uint32_t* count = nullptr;   // null if counts are not wanted
  // Of each tile: no depth in it is larger; and whether it holds values yet. One that nothing was drawn to is but this
  // flag. It gets the empty image's values, or the initial depth's, when it is opened.
  float* far = nullptr;
  std::uint8_t* opened = nullptr;

  std::size_t tile(int column) const { return static_cast<std::size_t>(column - begin) * kTileSamples; }
  // Of sample (x, y) of the image.
  std::size_t offset(int x, int y) const {
    return tile(x >> kTileLog2) + offset_in_tile(x & (kTileSize - 1), y & (kTileSize - 1));
  }
  bool is_open(int column) const { return opened[column - begin] != 0; }
};

// A frame, as its tiles need it.
struct FrameJob {
  const Target* target;
  std::span<const DrawJob> draws;
  TileGrid grid;
  const CoverageVisitor* visitor;  // or null
  std::size_t sample_number;       // within a pixel

  std::size_t sample_index(int x, int y) const { return surefill::sample_index(*target, x, y, sample_number); }
  bool greater() const { return target->depth_test == DepthTest::greater; }
  // The draw that a triangle belongs to; `guess` is one nearby.
  std::size_t draw_of(std::uint32_t ordinal, std::size_t guess) const {
    while (ordinal < draws[guess].first_ordinal) --guess;
    while (guess + 1 < draws.size() && ordinal >= draws[guess + 1].first_ordinal) ++guess;
    return guess;
  }
};

// Depth as tiles keep it. What nothing beats is -inf.
inline float kept_depth(const Target& target, float z) {
  if (std::isnan(z)) return -std::numeric_limits<float>::infinity();
  return target.depth_test == DepthTest::greater ? -z : z;
}

// Working memory of one thread.
struct Scratch {
  std::uint32_t pairs[kPiecePairs];
};
// While tiles are drawn it holds a tile's records, and those that are asked for ahead of need.
static_assert(kPiecePairs >= kPieces * kPieceRecords + 64);

// The vector code for one instruction set.
struct Kernels {
  // Sets up the triangles of a piece, as far as its lists have room.
  void (*set_up)(const TileGrid& grid, Piece& piece, Scratch& scratch, Diagnostics& diagnostics);
  // Draws what the pieces have for a row of tiles.
  void (*draw_tiles)(const FrameJob& frame, std::span<const Piece> pieces, const TileRow& tiles, Scratch& scratch,
                     Rungs& rungs);
  // Writes barycentrics and attributes of a row of tiles.
  void (*shade)(const FrameJob& frame, const TileRow& tiles, Rungs& rungs);
  const char* name;
  // Is this code compiled as it has to be (build_check.hpp)?
  bool (*is_exact)();
};

// For the best instruction set that this machine has (or that a test has chosen with hwy::SetSupportedTargetsForTest).
const Kernels& kernels();

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_TILE_HPP
