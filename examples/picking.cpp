// SPDX-License-Identifier: Apache-2.0
//
// Object picking: which object is under the mouse? Only that one pixel is drawn (scissor), and the answer is the one
// that the picture shows, to the last pixel of every silhouette.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 64, kHeight = 32;

struct Object {
  const char* name;
  std::vector<surefill::Vertex> vertices;  // a convex polygon, drawn as a fan
};

// All objects in one draw; object i owns the triangles [first[i], first[i + 1]).
struct Scene {
  std::vector<surefill::Vertex> vertices;
  std::vector<std::uint32_t> indices, first{0};

  explicit Scene(const std::vector<Object>& objects) {
    for (const Object& object : objects) {
      const auto base = static_cast<std::uint32_t>(vertices.size());
      vertices.insert(vertices.end(), object.vertices.begin(), object.vertices.end());
      for (std::uint32_t i = 2; i < object.vertices.size(); ++i) {
        indices.insert(indices.end(), {base, base + i - 1, base + i});
      }
      first.push_back(static_cast<std::uint32_t>(indices.size() / 3));
    }
  }

  // Draws the pixels of `area` and returns the visible triangle of each pixel of the target.
  std::vector<std::uint32_t> visible(const surefill::Scissor& area) const {
    std::vector<std::uint32_t> index(std::size_t{kWidth} * kHeight);
    surefill::Target target;
    target.width = kWidth, target.height = kHeight, target.index = index;
    surefill::Draw draw;
    draw.vertices = vertices, draw.indices = indices, draw.scissor = area;
    if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
      std::fprintf(stderr, "picking: %s\n", surefill::status_text(status));
    }
    return index;
  }

  // The number of the object under pixel (x, y), or -1.
  int pick(int x, int y) const {
    return object_of(visible({x, y, x + 1, y + 1})[static_cast<std::size_t>(y * kWidth + x)]);
  }

  int object_of(std::uint32_t triangle) const {
    if (triangle == surefill::kNoTriangle) return -1;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), triangle) - first.begin()) - 1;
  }
};

}  // namespace

int main() {
  const std::vector<Object> objects{
      {"floor", {{0, 20, 9, 1}, {64, 20, 9, 1}, {64, 32, 1, 1}, {0, 32, 1, 1}}},
      {"house", {{8, 10, 5, 1}, {20, 3, 5, 1}, {32, 10, 5, 1}, {32, 26, 5, 1}, {8, 26, 5, 1}}},
      {"door", {{16, 16, 4, 1}, {22, 16, 4, 1}, {22, 26, 4, 1}, {16, 26, 4, 1}}},
      {"tree", {{48, 1, 3, 1}, {58, 24, 3, 1}, {38, 24, 3, 1}}},
  };
  const Scene scene(objects);

  constexpr int kClicks[][2] = {{1, 1}, {20, 12}, {19, 20}, {48, 10}, {47, 1}, {60, 30}, {31, 21}};
  for (const auto& [x, y] : kClicks) {
    const int object = scene.pick(x, y);
    std::printf("(%2d, %2d) %s\n", x, y, object < 0 ? "nothing" : objects[static_cast<std::size_t>(object)].name);
  }

  // Picking pixel by pixel gives the picture.
  const std::vector<std::uint32_t> picture = scene.visible({0, 0, kWidth, kHeight});
  int different = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int seen = scene.object_of(picture[static_cast<std::size_t>(y * kWidth + x)]);
      different += scene.pick(x, y) != seen;
      if (y % 2 == 0) std::putchar(seen < 0 ? '.' : objects[static_cast<std::size_t>(seen)].name[0]);
    }
    if (y % 2 == 0) std::putchar('\n');
  }
  std::printf("pixels where picking differs from the picture: %d\n", different);
  return different == 0 ? 0 : 1;
}
