// SPDX-License-Identifier: Apache-2.0
//
// One triangle, engine == oracle, bit for bit, at samples that the input chooses (one_triangle.hpp).
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "fuzz/one_triangle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  const std::span<const std::uint8_t> bytes(data, size);
  const OneTriangle triangle = decode_one(bytes, false);
  note_scene([&] { return scene_of(triangle); });
  check_one_triangle("triangle", triangle, bytes.subspan(std::min(size, kTriangleBytes)));
  return 0;
}

SUREFILL_FUZZ_MUTATORS(triangle)
