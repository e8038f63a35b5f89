// SPDX-License-Identifier: Apache-2.0
//
// Triangles on their way from vertices to records: a lane each, field by field.
#ifndef SUREFILL_SRC_FAST_BATCH_HPP
#define SUREFILL_SRC_FAST_BATCH_HPP

#include <cstddef>

#include "fast/record.hpp"

namespace surefill::fast {

struct alignas(64) Batch {
  // What comes in. A set of lanes has bit l for lane l.
  std::uint32_t position[kBatch];  // in the draw
  alignas(64) float x[3][kBatch], y[3][kBatch], z[3][kBatch], w[3][kBatch];
  alignas(64) double corner_x[3][kBatch], corner_y[3][kBatch];  // Grid only: the snapped corners in pixels

  // What the records get.
  alignas(64) std::int32_t first_x[kBatch], last_x[kBatch], first_y[kBatch], last_y[kBatch];
  // Of small lanes, in the order of Record::small, whose words they are, without gaps.
  alignas(64) std::int32_t a[3][kBatch];
  std::int32_t b[3][kBatch], e[3][kBatch], doubt[kBatch];
  float high[kBatch], high_x[kBatch], high_y[kBatch], low[kBatch], low_x[kBatch], low_y[kBatch], low_error[kBatch];
  std::uint32_t cover[2][kBatch], unused[kBatch];  // of tiny lanes
  alignas(64) float z_least[kBatch], z_most[kBatch];
  // Of lanes that are not small.
  alignas(64) double scaled_a[3][kBatch], scaled_b[3][kBatch], scaled_c[3][kBatch];
  alignas(64) double plane[kBatch], plane_x[kBatch], plane_y[kBatch], plane_error[kBatch];

  // Sets of lanes.
  std::uint32_t finite;      // all numbers are
  std::uint32_t front;       // all W > 0
  std::uint32_t reached;     // the box holds a sample
  std::uint32_t small;       // the box lies within 4 x 4 cells
  std::uint32_t medium;      // the box lies within 8 x 8 blocks
  std::uint32_t tiny;        // as in Record
  std::uint32_t empty;       // tiny, and no sample is covered
  std::uint32_t thin;        // as in Record
  std::uint32_t slow_depth;  // as in Record
  std::uint32_t clip;        // as in Record
  std::uint32_t integer;     // the edges are exact in units of the scale
  std::uint32_t tie_lost[3];
  std::uint32_t degenerate;  // D = 0
  std::uint32_t negative;    // D < 0
  std::uint32_t clipped;     // Grid clips the triangle, and it becomes a fan

  // The first samples about which edges and depth are set up.
  int origin_x(std::size_t lane) const { return first_x[lane] & ((small >> lane & 1) != 0 ? ~3 : ~7); }
  int origin_y(std::size_t lane) const { return first_y[lane] & ((small >> lane & 1) != 0 ? ~3 : ~7); }
};

static_assert(offsetof(Batch, unused) - offsetof(Batch, a) == 19 * kBatch * sizeof(std::uint32_t));

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_BATCH_HPP
