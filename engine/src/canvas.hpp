// SPDX-License-Identifier: Apache-2.0
//
// The fast path's image and its triangles, as its two halves share them: tiles.cpp (who draws what, and when) and
// kernels.cpp (the vector code).
//
//   cell   4 x 4 samples    one vector of 16 lanes, 64 bytes of depth
//   block  8 x 8 samples    4 cells; the grain of hierarchical z
//   tile   64 x 64 samples  8 x 8 blocks; the reach of int32 edge functions with one scale
//   band   a row of tiles   what one thread owns while it draws
#ifndef SUREFILL_SRC_CANVAS_HPP
#define SUREFILL_SRC_CANVAS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "exact/bounds.hpp"
#include "exact/edge.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

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

constexpr int kCellLog2 = 2, kBlockLog2 = 3, kTileLog2 = 6;
constexpr int kTileSize = 1 << kTileLog2;

// One sample of every pixel, in whole tiles: block by block from left to right and from the top down, in a block cell
// by cell, in a cell row by row. Depth is kept so that smaller wins: negated for DepthTest::greater; beyond the target
// it is -inf, which nothing beats. The winner is the ordinal of the triangle that is seen: its position, counted over
// all draws.
//
// Depth, winner and count may hold but some bands at a time: then `row` has offsets, modulo 2^32, from their beginning.
struct Canvas {
  float* depth = nullptr;           // null if neither depth nor visibility is wanted; and then the next three are, too
  float* block_far = nullptr;       // no depth in the block is larger
  float* tile_far = nullptr;        // no depth in the tile is larger
  std::uint32_t* winner = nullptr;  // null if visibility is not wanted. Meaningful where the depth was written
  std::uint32_t* count = nullptr;   // null if counts are not wanted
  // A tile that nothing has been drawn to is but a flag, and its samples have no values: touch() gives it the empty
  // image's, or the initial depth's. A tile is touched before a sample of it is looked at.
  std::uint8_t* untouched = nullptr;
  void (*touch)(const void* renderer, std::size_t tile) = nullptr;
  const void* renderer = nullptr;
  // For a visitor, instead of counts: 64 bits a block, the samples of the triangle at hand; and for each thread room
  // for the list of blocks that have some.
  std::uint64_t* masks = nullptr;
  std::uint32_t* marked = nullptr;
  const CoverageVisitor* visitor = nullptr;
  // Offsets of the first sample of a cell: the sum of that of its column and that of its row.
  const std::uint32_t *column = nullptr, *row = nullptr;
  int tiles_x = 0, tiles_y = 0;

  int blocks_x() const { return tiles_x << (kTileLog2 - kBlockLog2); }
  std::size_t blocks() const { return static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y) * 64; }
  std::size_t samples() const { return blocks() * 64; }
  std::size_t block_of(int x, int y) const {
    return static_cast<std::size_t>(y >> kBlockLog2) * static_cast<std::size_t>(blocks_x()) +
           static_cast<std::size_t>(x >> kBlockLog2);
  }
  std::size_t tile_of(int x, int y) const {
    return static_cast<std::size_t>(y >> kTileLog2) * static_cast<std::size_t>(tiles_x) +
           static_cast<std::size_t>(x >> kTileLog2);
  }
  // Of tile_far: eight tiles are read at once, all of them in one band.
  std::size_t far_of(int x, int y) const { return tile_of(x, y) + static_cast<std::size_t>(y >> kTileLog2) * 8; }
  // Of the sample (x, y) of the first blocks, without the tables.
  std::size_t offset_in_blocks(int x, int y) const {
    return block_of(x, y) * 64 + static_cast<std::size_t>(((y >> kCellLog2) & 1) * 32 + ((x >> kCellLog2) & 1) * 16);
  }
  // Of the sample (x, y).
  std::size_t offset_of(int x, int y) const {
    return column[x >> kCellLog2] + row[y >> kCellLog2] + static_cast<std::uint32_t>((y & 3) * 4 + (x & 3));
  }
};

constexpr std::uint32_t kBatch = 8;  // triangles that are set up together

// Triangles of a draw, ready to be drawn. A triangle with D < 0 has its edges negated.
struct alignas(64) Batch {
  // Edge functions, scaled and rounded to integers: steps in x and y and, less the bound of their rounding, the value
  // at the first sample of the origin. A sample is inside if all three values are >= 0, outside if one is below
  // -doubt; in between, exact arithmetic tells. doubt is twice the bound, and 0 where the integers are exact and a tie
  // is already decided. Only of small and medium lanes.
  std::int32_t a[3][kBatch], b[3][kBatch], e[3][kBatch], doubt[kBatch];
  std::int32_t most[3][kBatch];  // the largest change of an edge function within a cell, and doubt
  // Samples that the triangle can cover, both ends included.
  std::int32_t first_x[kBatch], last_x[kBatch], first_y[kBatch], last_y[kBatch];
  // Depth at the origin's first sample, its steps, and a bound of the error at any sample of the box. Smaller is
  // nearer: negated for DepthTest::greater.
  alignas(64) double z[kBatch], z_x[kBatch], z_y[kBatch], z_error[kBatch];
  // Of small lanes the same in high and low parts, with the error bound of a value that is put together from them.
  alignas(32) float high[kBatch], high_x[kBatch], high_y[kBatch], low[kBatch], low_x[kBatch], low_y[kBatch];
  alignas(32) float low_error[kBatch];
  alignas(64) double edge_a[3][kBatch], edge_b[3][kBatch], edge_c[3][kBatch];  // unscaled; of lanes that are not small

  // Grid only: the snapped corners in pixels, and the range that depth is clamped to.
  alignas(64) double corner_x[3][kBatch], corner_y[3][kBatch];
  float z_least[kBatch], z_most[kBatch];

  // Sets of lanes.
  std::uint32_t live;        // to be drawn
  std::uint32_t small;       // box within 4 x 4 cells; the origin is the box's first cell
  std::uint32_t tiny;        // small, and the box has at most 2 x 2 samples
  std::uint32_t medium;      // box within 8 x 8 blocks; the origin is the box's first block, as it is for all others
  std::uint32_t slow_depth;  // no error bound of depth is known
  std::uint32_t clip;        // depth may lie outside 0..1 somewhere
  std::uint32_t negative;    // D < 0
  std::uint32_t clipped;     // not live: Grid clips the triangle, and its fan becomes a batch of its own
  std::uint32_t first;       // position in the draw of lane 0
  std::uint32_t step;        // from a lane's position to the next one's: 1, or 0 in a fan

  std::uint32_t position(std::uint32_t lane) const { return first + step * lane; }
  int origin_x(std::size_t lane) const { return first_x[lane] & ((small >> lane & 1) != 0 ? ~3 : ~7); }
  int origin_y(std::size_t lane) const { return first_y[lane] & ((small >> lane & 1) != 0 ? ~3 : ~7); }
};

// A draw, as both phases need it.
struct DrawJob {
  const Draw* draw;
  std::uint32_t first_ordinal;  // ordinal of the draw's triangle 0
  PixelBox region;              // target and scissor
  SamplePosition sample;        // within a pixel
  TieShift shift;
  bool depth;  // is depth needed?
  bool greater;
  std::uint32_t number;  // in the list of draws
  int sample_number;     // within a pixel
};

// What is seen, for barycentrics and attributes.
struct ShadeJob {
  const Target* target;
  std::span<const DrawJob> jobs;  // of each draw
  std::size_t sample_number;      // within a pixel
};

// The bands that one thread draws of those at hand, which begin at `begin` and end before `end`: of runs of neighbours,
// every `sets`-th. Long runs are cut by few triangles, many are shared out evenly.
struct BandSet {
  std::uint64_t owned[kMaxTargetSize / kTileSize / 64 + 1] = {};  // the last is for rows beyond
  bool all = true;
  int thread = 0;
  bool first = true;  // of all sets: it counts triangles where bands do not tell which set shall

  BandSet() = default;  // all
  BandSet(int set, int sets, int begin, int end, int bands)
      : all(sets == 1 && end - begin == bands), thread(set), first(set == 0 && begin == 0) {
    const int run = std::max(1, (end - begin) / (4 * sets));
    for (int band = begin; band < end; ++band) {
      if ((band - begin) / run % sets == set) owned[band >> 6] |= std::uint64_t{1} << (band & 63);
    }
  }
  bool owns(int band) const { return all || (owned[band >> 6] >> (band & 63) & 1) != 0; }
};

// The vector code for one instruction set.
struct Kernels {
  // Sets up the triangles [first, first + count) of a draw, count <= kBatch, as far as they reach bands of a set;
  // counts each for one of the sets.
  void (*set_up)(const DrawJob& job, const BandSet& bands, std::uint32_t first, std::uint32_t count, Batch& batch,
                 Statistics& statistics);
  // Draws batches of one draw, in order.
  void (*rasterize)(const DrawJob& job, std::span<const Batch> batches, const Canvas& canvas, const BandSet& bands,
                    Statistics& statistics);
  // Writes barycentrics and attributes of the rows [y0, y1).
  void (*shade)(const ShadeJob& job, const Canvas& canvas, int y0, int y1, Statistics& statistics);
  const char* name;
};

// For the best instruction set that this machine has (or that a test has chosen with hwy::SetSupportedTargetsForTest).
const Kernels& kernels();

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_CANVAS_HPP
