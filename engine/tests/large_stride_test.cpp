// SPDX-License-Identifier: Apache-2.0
//
// Attribute values that lie more than 2^32 floats from the first one are found, on both paths.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "surefill/surefill.hpp"

#if defined(__linux__)
#include <sys/mman.h>

namespace surefill::properties {
namespace {

TEST(LargeStride, ValuesBeyond32BitsAreFound) {
  constexpr std::uint32_t kStride = std::uint32_t{1} << 31;
  constexpr std::size_t kFloats = 2 * std::size_t{kStride} + 1;  // of 16 GiB, three pages are touched
  void* const memory = mmap(nullptr, kFloats * sizeof(float), PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) GTEST_SKIP() << "the system does not give 16 GiB of addresses";
  auto* const values = static_cast<float*>(memory);
  values[0] = 1, values[kStride] = 2, values[2 * std::size_t{kStride}] = 4;
  const Vertex vertices[3] = {{0, 0, 0, 1}, {8, 0, 0, 1}, {0, 8, 0, 1}};
  const std::uint32_t indices[3] = {0, 1, 2};
  const AttributeArray attributes[1] = {{{values, kFloats}, 1, kStride, Interpolation::perspective}};
  Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.attributes = attributes;
  for (const Path path : {Path::automatic, Path::reference}) {
    float out[64] = {};
    const AttributeTarget targets[1] = {{out, 1}};
    Target target;
    target.width = target.height = 8, target.attributes = targets;
    ASSERT_EQ(render(target, {&draw, 1}, nullptr, {.path = path}), Status::ok);
    // At (1.5, 2.5): 1 + 1.5 / 8 + 3 * 2.5 / 8.
    EXPECT_EQ(out[2 * 8 + 1], 2.125f);
  }
  munmap(memory, kFloats * sizeof(float));
}

}  // namespace
}  // namespace surefill::properties

#endif
