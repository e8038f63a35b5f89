// SPDX-License-Identifier: Apache-2.0
//
// A triangle that is set up, as the tiles draw it: made once, read by every tile that it meets.
#ifndef SUREFILL_SRC_FAST_RECORD_HPP
#define SUREFILL_SRC_FAST_RECORD_HPP

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "exact/bounds.hpp"
#include "exact/edge.hpp"
#include "fast/levels.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

// Edge functions become integers: scaled by a power of two that brings max(|a|, |b|) to 2^exponent or more, below twice
// that. All steps stay exact: 15 * 2 * 2^25 and 63 * 2 * 2^23 are below 2^30.
constexpr int kSmallExponent = 24, kTileExponent = 22;
constexpr double kEdgeLimit = 0x1p30;  // beyond it, no step within 64 samples changes the sign
// Bounds of the total rounding in units: half a unit for each coefficient times the steps (15 and 63 each way), half
// for the start, and at most 0.26 for the double arithmetic before (docs/precision.md).
constexpr std::int32_t kSmallBound = 16, kTileBound = 64;
// The largest amount that decides a tie of integer edges and no other sign: their values are multiples of it.
constexpr double kTieStep = 0x1p-12;

// Edge functions are positive inside, whatever the sign of D. Depth is kept so that smaller is nearer: negated for
// DepthTest::greater.
struct alignas(128) Record {
  enum Flag : std::uint32_t {
    kSmall = 1,          // the box lies within 4 x 4 cells
    kSlowDepth = 2,      // no error bound of depth is known
    kClip = 4,           // depth is clipped, and may lie outside 0..1 somewhere
    kThin = 8,           // holds hardly a whole cell: a hint, by which nothing changes but speed
    kInteger = 16,       // of a large triangle: its edges are exact in units of the scale
    kTieIsLost = 32,     // and 64, 128: with kInteger, edge 0, 1, 2 does not own the samples on it
    kBorder = 256,       // cells may reach beyond the box to samples that must not be drawn
    kByWinding = 512,    // a polygon that Grid has clipped and that turns both ways: sample by sample
    kFirstOfFan = 1024,  // times 1..5: which triangle of a clipped polygon's fan this is
    kTiny = 8192,        // of a small one: the box lies within 4 x 4 samples, and `cover` is known
  };

  union {
    // About the first cell of the box. Edges are scaled and rounded to integers: steps in x and y and, less the bound
    // of their rounding, the value at the cell's first sample. A sample is inside if all three values are >= 0, outside
    // if one is below -doubt; in between, exact arithmetic tells. doubt is twice the bound, and 0 where the integers
    // are exact and ties are already decided. Depth has a high and a low part, of which the high ones add up exactly;
    // low_error bounds the error of a sum (docs/precision.md). cover: the samples of the first cell that are covered and,
    // 16 bits higher, of the one below it; then of the two to the right.
    struct {
      std::int32_t a[3], b[3], e[3], doubt;
      float high, high_x, high_y, low, low_x, low_y, low_error;
      std::uint32_t cover[2], unused;
    } small;
    // Edges in double, scaled for a tile's integers: a x + b y + c. Depth about the first sample of the box's first
    // block, its steps, and a bound of the error at any sample of the box.
    struct {
      double a[3], b[3], c[3];
      double z, z_x, z_y, z_error;
    } large;
  };
  float z_least, z_most;         // depth is clamped to this range: infinite, but under Grid and depth clamping
  std::uint32_t position;        // in the draw
  std::uint16_t x0, y0, x1, y1;  // samples that can be covered, both ends included
  std::uint16_t flags;

  bool has(std::uint32_t flag) const { return (flags & flag) != 0; }
  int fan_triangle() const { return flags / kFirstOfFan & 7; }  // 0: not of a fan
  // The first sample of the plane of a large triangle.
  int origin_x() const { return x0 & ~(kBlockSize - 1); }
  int origin_y() const { return y0 & ~(kBlockSize - 1); }
};
static_assert(sizeof(Record) == 128 && sizeof(Record::small) == 80);

// The edges of a large triangle in integers, from the sample (x, y) on, the first of a tile; as in Record::small.
struct TileEdges {
  std::int32_t a[3], b[3], e[3], doubt;

  TileEdges(const Record& r, double x, double y) {
    const bool integer = r.has(Record::kInteger);
    const std::int32_t bound = integer || !kExactCoverage ? 0 : kTileBound;
    doubt = 2 * bound;
    for (std::uint32_t k = 0; k < 3; ++k) {
      double start = (r.large.a[k] * x + r.large.b[k] * y) + r.large.c[k];
      start = std::clamp(start, -kEdgeLimit, kEdgeLimit);
      if (integer) start = std::floor(start - (r.has(Record::kTieIsLost << k) ? kTieStep : 0));
      a[k] = nearest(r.large.a[k]), b[k] = nearest(r.large.b[k]), e[k] = nearest(start) - bound;
    }
  }

 private:
  // For |v| < 2^31: the sum with 1.5 * 2^52 has it in its low bits.
  static std::int32_t nearest(double v) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(v + 0x1.8p52)));
  }
};

// A draw, as all stages need it.
struct DrawJob {
  const Draw* draw;
  std::uint32_t first_ordinal;  // ordinal of the draw's triangle 0: its position, counted over all draws
  PixelBox region;              // target and scissor, in pixels of the target
  SamplePosition sample;        // of the target's pixel (0, 0), in space
  TieShift shift;
  bool depth;            // is depth kept?
  bool greater;          // is it kept negated?
  bool streams;          // no sample beyond the region may be touched
  std::uint32_t number;  // in the list of draws
  int sample_number;     // within a pixel
  Origin origin = {};    // of the target

  // The pixels of space that a box of the target's is, and the other way round.
  PixelBox in_space(const PixelBox& box) const {
    return {box.x0 + origin.x, box.y0 + origin.y, box.x1 + origin.x, box.y1 + origin.y};
  }
  PixelBox in_target(const PixelBox& box) const {
    return {box.x0 - origin.x, box.y0 - origin.y, box.x1 - origin.x, box.y1 - origin.y};
  }
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_RECORD_HPP
