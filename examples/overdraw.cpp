// SPDX-License-Identifier: Apache-2.0
//
// An exact overdraw map: how many triangles cover each pixel, whether seen or not; what a renderer without occlusion
// culling would shade. The count needs no depth test and does not depend on the order of drawing [M2].
#include <algorithm>
#include <cstdio>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 96, kHeight = 54;

}  // namespace

int main() {
  // Leaves of a bush: overlapping triangles, of which back faces are culled in a second pass.
  std::vector<surefill::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::uint32_t state = 7;
  const auto next = [&](int range) {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(static_cast<int>(state >> 16) % range);
  };
  for (std::uint32_t leaf = 0; leaf < 60; ++leaf) {
    const float x = 24 + next(48), y = 12 + next(30);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      vertices.push_back({x + next(24) - 12, y + next(24) - 12, 0, 1});
      indices.push_back(3 * leaf + corner);
    }
  }

  std::vector<std::uint32_t> count(std::size_t{kWidth} * kHeight);
  surefill::Target target;
  target.width = kWidth, target.height = kHeight, target.count = count;
  surefill::Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  for (const surefill::Cull cull : {surefill::Cull::back, surefill::Cull::none}) {
    draw.cull = cull;
    if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
      std::fprintf(stderr, "overdraw: %s\n", surefill::status_text(status));
      return 1;
    }
    std::size_t shaded = 0, covered = 0;
    for (const std::uint32_t n : count) shaded += n, covered += n > 0;
    std::printf("%s: %zu pixels covered, %zu shaded, overdraw %.3f, at most %u\n",
                cull == surefill::Cull::back ? "front faces" : "both faces", covered, shaded,
                static_cast<double>(shaded) / static_cast<double>(covered),
                *std::max_element(count.begin(), count.end()));
  }
  for (std::size_t y = 0; y < kHeight; y += 2) {
    for (std::size_t x = 0; x < kWidth; ++x) {
      const std::uint32_t n = count[y * kWidth + x];
      std::putchar(n == 0 ? '.' : n < 10 ? static_cast<char>('0' + n) : '*');
    }
    std::putchar('\n');
  }
  return 0;
}
