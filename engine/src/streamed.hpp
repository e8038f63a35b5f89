// SPDX-License-Identifier: Apache-2.0
//
// Frames whose coverage is the fast path's and whose fragments are the reference path's: those that ask for layers,
// winding, numbers of triangles, a bias, LEQUAL, GEQUAL, overlapped or touched pixels, or the index of conservative draws.
// Lines and points come in between, as the order of draws has it.
#ifndef SUREFILL_SRC_STREAMED_HPP
#define SUREFILL_SRC_STREAMED_HPP

#include <span>

#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::streamed {

// Can the fast path stream the coverage of the triangles of such a frame?
bool supports(const Target& target, std::span<const Draw> draws);

// As reference::render, with the threads and the memory of the options.
Status render(const Target& target, std::span<const Draw> draws, const Options& options,
              Diagnostics& diagnostics) noexcept;

}  // namespace surefill::streamed

#endif  // SUREFILL_SRC_STREAMED_HPP
