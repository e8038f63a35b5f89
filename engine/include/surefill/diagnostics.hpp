// SPDX-License-Identifier: Apache-2.0
//
// How a frame came about: who drew it, and how often each rung of exact arithmetic was needed. For tests, and for people
// who look for what takes time. Nothing of it is defined by docs/semantics.md: it depends on the machine's instruction
// set, the number of threads and the version. What a frame's triangles were is Statistics (surefill.hpp).
#ifndef SUREFILL_DIAGNOSTICS_HPP
#define SUREFILL_DIAGNOSTICS_HPP

#include <cstdint>

namespace surefill {

// Decisions by the rung of the ladder that settled them (docs/design.md).
struct Rungs {
  // Signs of edge functions and of D; on the fast path, of edge functions only where its integers were uncertain.
  std::uint64_t signs_by_filter = 0;     // double arithmetic with an error bound
  std::uint64_t signs_by_residual = 0;   // double arithmetic proved exact, real ties among them
  std::uint64_t signs_by_expansion = 0;  // exact expansions
  // Depths, weights, attributes and clip decisions; depths of the fast path only where it was uncertain.
  std::uint64_t values_by_filter = 0;
  std::uint64_t values_by_expansion = 0;
};

// Asked for by Options::diagnostics; written where the call's status is ok. All but the rungs and the path are the fast
// path's, of sample 0 of each pixel, and of the triangles that no skipped draw holds.
struct Diagnostics {
  std::uint64_t outside = 0;  // triangles of which no sample of the target lies in the screen box
  // Triangles that are drawn, by the box of samples that can be covered: within 4 x 4 cells of 4 x 4 samples, within
  // 8 x 8 blocks of 8 x 8, larger; and those that Grid clips.
  std::uint64_t small = 0, medium = 0, large = 0, clipped = 0;
  std::uint64_t skipped_draws = 0;  // by a culling box [M6]; with several threads, as far as the first one's rows tell
  Rungs rungs;
  const char* path = "";  // what drew the frame: "reference", or the fast path's instruction set; a string constant
};

}  // namespace surefill

#endif  // SUREFILL_DIAGNOSTICS_HPP
