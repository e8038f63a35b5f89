// SPDX-License-Identifier: Apache-2.0
//
// One triangle under Grid (section 6), engine == oracle, bit for bit, at samples that the input chooses
// (one_triangle.hpp): every number of bits, offset and rounding, the guard band, and the values of G2.
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "fuzz/one_triangle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  const std::span<const std::uint8_t> bytes(data, size);
  const OneTriangle triangle = decode_one(bytes, true);
  note_scene([&] { return scene_of(triangle); });
  check_one_triangle("grid", triangle, bytes.subspan(std::min(size, kGridTriangleBytes)));
  return 0;
}

SUREFILL_FUZZ_MUTATORS(grid_triangle)
