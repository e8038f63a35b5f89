// SPDX-License-Identifier: Apache-2.0
//
// Sizes beyond 32 bits, on machines whose std::size_t has no more: arguments whose sizes would wrap around to those of the
// buffers are refused (B2), and what fits is accepted. Exit 0: all as it should be; 1: not.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

using namespace surefill;

int failures = 0;

void expect(bool right, const char* what) {
  if (right) return;
  ++failures;
  std::printf("wrong: %s\n", what);
}

constexpr std::uint64_t kLargestSize = std::numeric_limits<std::size_t>::max();

Target of_size(int width, int height, int samples) {
  Target target;
  target.width = width, target.height = height, target.samples = samples;
  return target;
}

void largest_target() {
  Target target = of_size(kMaxTargetSize, kMaxTargetSize, 16);  // 2^32 samples
  expect(sample_total(target) == std::min(kLargestSize, std::uint64_t{1} << 32), "the total of the largest target");
  expect(validate(target, {}) == Status::ok, "the largest target without a buffer");
  std::array<std::uint32_t, 16> words{};
  target.count = words;
  expect(validate(target, {}) == Status::target_count, "counts of the largest target");
}

// 3 * 11044 * 16204 * 8 is 2^32 + 128: the weights of that target would wrap around to 128 floats.
void wrapped_outputs() {
  constexpr int kWidth = 11044, kHeight = 16204, kSamples = 8;
  std::vector<float> values(128);
  Target target = of_size(kWidth, kHeight, kSamples);
  constexpr std::uint64_t kFloats = std::uint64_t{3} * kWidth * kHeight * kSamples;
  static_assert(kFloats == (std::uint64_t{1} << 32) + 128);
  const std::span<float> few(values.data(), static_cast<std::uint32_t>(kFloats));
  target.barycentrics = few;
  expect(validate(target, {}) == Status::target_barycentrics, "barycentrics whose size wraps around");
  target.barycentrics = {};
  const std::array<AttributeTarget, 1> attributes = {{{few, 3}}};
  target.attributes = attributes;
  expect(validate(target, {}) == Status::target_attributes, "an attribute image whose size wraps around");
}

// With three vertices, (3 - 1) * 2^31 + 1 floats would wrap around to one.
void wrapped_strides() {
  const std::array<Vertex, 3> vertices = {{{0, 0, 0, 1}, {8, 0, 0, 1}, {0, 8, 0, 1}}};
  const std::array<std::uint32_t, 3> indices = {0, 1, 2};
  const std::array<float, 4> values{};
  std::array<AttributeArray, 1> arrays;
  arrays[0].values = values, arrays[0].components = 1, arrays[0].stride = 0x80000000u;
  Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.attributes = arrays;
  Target target = of_size(8, 8, 1);
  expect(validate(target, {&draw, 1}) == Status::draw_attributes, "a stride with which a size wraps around");
  arrays[0].stride = 1;
  expect(validate(target, {&draw, 1}) == Status::ok, "a stride that fits");
}

}  // namespace

int main() {
  largest_target();
  wrapped_outputs();
  wrapped_strides();
  std::printf("sizes of %d bits: %s\n", static_cast<int>(8 * sizeof(std::size_t)), failures == 0 ? "right" : "WRONG");
  return failures == 0 ? 0 : 1;
}
