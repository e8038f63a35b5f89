// SPDX-License-Identifier: Apache-2.0
//
// The fast path: triangles are sorted into bins of the screen, bins are drawn by vector code, in parallel.
#ifndef SUREFILL_SRC_TILES_HPP
#define SUREFILL_SRC_TILES_HPP

#include <span>

#include "surefill/surefill.hpp"

namespace surefill::fast {

// Does the fast path draw frames like this one? If not, the reference path has to.
bool supports(const Target& target, std::span<const Draw> draws);

// As reference::render, on `threads` threads. Working memory: 48 MiB, 0.3 MiB a thread, and 8 bytes a sample if the
// frame has more triangles than fit at once.
Status render(const Target& target, std::span<const Draw> draws, int threads, Statistics& statistics) noexcept;

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_TILES_HPP
