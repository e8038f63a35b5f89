// SPDX-License-Identifier: Apache-2.0
//
// One triangle, engine (its reference path) == oracle, at samples that the input chooses: coverage at 16 of them,
// depth, index, barycentrics and attribute at up to four. Exact values cost a thousand times more than exact signs, and
// a fuzzer lives on speed.
#ifndef SUREFILL_FUZZ_ONE_TRIANGLE_HPP
#define SUREFILL_FUZZ_ONE_TRIANGLE_HPP

#include <cstdint>
#include <span>

#include "fuzz/decode.hpp"

namespace surefill::fuzz {

// `tail`, the bytes after the triangle:
//   0  where the window of values begins: at the covered sample of this number; 255: every value of every sample
//   1  the first of eight samples, and
//   2  how many samples the next one is away, which is 2 n + 1
// Eight more samples are those that lie nearest to an edge: there the engine has something to decide.
// Reports a finding under the name of the target.
void check_one_triangle(const char* target, const OneTriangle& triangle, std::span<const std::uint8_t> tail);

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_ONE_TRIANGLE_HPP
