// SPDX-License-Identifier: Apache-2.0
//
// Lines, pixel by pixel along their major axis: of a column (or a row) the few samples near the line are looked at, and
// only those that a double cannot tell about are asked exactly. Bands of rows keep what is written in a cache, and are
// divided among threads.
#ifndef SUREFILL_SRC_LINES_HPP
#define SUREFILL_SRC_LINES_HPP

#include "fragments.hpp"
#include "surefill/surefill.hpp"

namespace surefill {

// As reference::draw, of a draw of lines, with the threads of the options.
void draw_lines(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers,
                const Options& options) noexcept;

}  // namespace surefill

#endif  // SUREFILL_SRC_LINES_HPP
