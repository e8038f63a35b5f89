// SPDX-License-Identifier: Apache-2.0
//
// Polygons with holes and crossings, burned into pixels without triangulating them: each contour is drawn as a fan from its
// first corner, and the winding tells how often the contours run around a pixel's centre [M9].
#include <cstdio>
#include <span>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 56, kHeight = 24;

using Contour = std::vector<surefill::Vertex>;  // closed; any direction

// The winding number of the contours around each pixel's centre; empty if the call is refused.
std::vector<std::int32_t> burn(std::span<const Contour> contours) {
  std::vector<surefill::Vertex> corners;
  std::vector<std::uint32_t> indices;
  for (const Contour& contour : contours) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    corners.insert(corners.end(), contour.begin(), contour.end());
    for (auto i = first + 1; i + 1 < corners.size(); ++i) indices.insert(indices.end(), {first, i, i + 1});
  }
  std::vector<std::int32_t> winding(std::size_t{kWidth} * kHeight);
  surefill::Target target;
  target.width = kWidth, target.height = kHeight, target.winding = winding;
  surefill::Draw draw;
  draw.vertices = corners, draw.indices = indices;
  if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
    std::fprintf(stderr, "polygon: %s\n", surefill::status_text(status));
    return {};
  }
  return winding;
}

// Prints the pixels inside, and returns how many there are.
int show(const char* name, const std::vector<std::int32_t>& winding, bool even_odd) {
  int inside = 0;
  std::printf("%s, %s\n", name, even_odd ? "even-odd" : "nonzero");
  for (std::size_t i = 0; i < winding.size(); ++i) {
    const bool in = even_odd ? winding[i] % 2 != 0 : winding[i] != 0;
    inside += in ? 1 : 0;
    std::putchar(in ? '#' : '.');
    if (i % kWidth == kWidth - 1) std::putchar('\n');
  }
  std::printf("%d pixels\n", inside);
  return inside;
}

}  // namespace

int main() {
  // A lake with an island, which runs the other way round: a hole by either rule. And a star that crosses itself.
  const Contour shore = {{3, 4, 0, 1}, {15, 1, 0, 1}, {25, 6, 0, 1}, {24, 19, 0, 1}, {11, 22.5f, 0, 1}, {2, 14, 0, 1}};
  const Contour island = {{9, 9, 0, 1}, {8, 14, 0, 1}, {15, 16, 0, 1}, {19, 11, 0, 1}, {13, 7, 0, 1}};
  const Contour star = {{41, 1, 0, 1}, {47.5f, 22, 0, 1}, {30, 9, 0, 1}, {53, 9, 0, 1}, {34.5f, 22, 0, 1}};
  const Contour contours[] = {shore, island, star};
  const std::vector<std::int32_t> winding = burn(contours);
  if (winding.empty()) return 1;
  const int nonzero = show("a lake with an island, and a star", winding, false);
  const int even_odd = show("a lake with an island, and a star", winding, true);
  return nonzero > even_odd && even_odd > 0 ? 0 : 1;  // they differ in the star's middle
}
