// SPDX-License-Identifier: Apache-2.0
// The example of the README.
#include <cstdio>
#include <surefill/surefill.hpp>
#include <vector>

int main() {
  // X, Y, Z, W: where W > 0 the pixel position is (X/W, Y/W) and the depth Z/W. The last vertex is behind the eye.
  const std::vector<surefill::Vertex> vertices = {
      {2, 1, 0.5f, 1}, {38, 5, 0.25f, 1}, {4, 14, 0.75f, 1}, {-60, -20, 0, -1}};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 1, 2, 3};
  std::vector<std::uint32_t> seen(40 * 16);

  surefill::Target target;
  target.width = 40, target.height = 16;
  target.index = seen;
  surefill::Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  const surefill::Status status = surefill::render(target, {&draw, 1});
  if (status != surefill::Status::ok) return std::puts(surefill::status_text(status)), 1;

  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::putchar(seen[i] == surefill::kNoTriangle ? '.' : static_cast<char>('0' + seen[i]));
    if (i % 40 == 39) std::putchar('\n');
  }
}
