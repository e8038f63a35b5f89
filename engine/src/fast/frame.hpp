// SPDX-License-Identifier: Apache-2.0
//
// The fast path: a chunk of triangles is set up and listed by tiles, then each tile draws its list.
#ifndef SUREFILL_SRC_FAST_FRAME_HPP
#define SUREFILL_SRC_FAST_FRAME_HPP

#include <span>

#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

// Does the fast path draw frames like this one? If not, others have to.
bool supports(const Target& target, std::span<const Draw> draws);
// And does it stream their coverage, but for M4a and M4b, and for lines and points?
bool streams(const Target& target, std::span<const Draw> draws);

// As reference::render. Working memory: 4 bytes a pixel for depth, 4 for visibility, 4 for counts, as far as they are
// asked for, with the target's sides rounded up to multiples of 64; 16 MiB for the triangles of a chunk and their
// lists; 0.6 MiB a thread. Where all triangles are one chunk, a row of tiles a thread takes the place of the pixels.
Status render(const Target& target, std::span<const Draw> draws, const Options& options,
              Diagnostics& diagnostics) noexcept;

// As reference::visit_coverage.
Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      const Options& options, Diagnostics& diagnostics) noexcept;

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_FRAME_HPP
