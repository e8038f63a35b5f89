// SPDX-License-Identifier: Apache-2.0
//
// The engine built again without its exactness: the price is the ratio.
#ifndef SUREFILL_BENCH_INEXACT_HPP
#define SUREFILL_BENCH_INEXACT_HPP

#include <cstddef>
#include <cstdint>

// Draws triangles (4 floats a vertex) into a depth image; false if it could not.
extern "C" bool surefill_bench_inexact_coverage(int width, int height, const float* vertices, std::size_t vertex_count,
                                                const std::uint32_t* indices, std::size_t index_count, float* depth);
extern "C" bool surefill_bench_inexact_depth(int width, int height, const float* vertices, std::size_t vertex_count,
                                             const std::uint32_t* indices, std::size_t index_count, float* depth);

#endif  // SUREFILL_BENCH_INEXACT_HPP
