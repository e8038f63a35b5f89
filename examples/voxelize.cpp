// SPDX-License-Identifier: Apache-2.0
//
// The voxels that a surface touches: all of them, and no others. A triangle touches a cube exactly if it does so in the
// three views along the axes, and its plane does not pass the cube by (separating axes: the views hold those of the cube's
// faces and of all pairs of edges). In a view the triangle may be seen edge on: it is a line then, or a point, and `touched`
// [M4b] has its pixels too, which a rasterizer that drops degenerate triangles loses.
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kSide = 24;  // voxels each way
constexpr std::size_t kVoxels = std::size_t{kSide} * kSide * kSide;

using Point = std::array<int, 3>;  // in eighths of a voxel
using Triangle = std::array<Point, 3>;

std::size_t voxel(int x, int y, int z) {
  return (static_cast<std::size_t>(z) * kSide + static_cast<std::size_t>(y)) * kSide + static_cast<std::size_t>(x);
}

// The pixels that the triangle touches in the view along an axis; columns are the axis after it, rows the one before it.
std::vector<std::uint32_t> view(const Triangle& triangle, std::size_t axis) {
  std::array<surefill::Vertex, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {static_cast<float>(triangle[i][(axis + 1) % 3]) / 8,
                  static_cast<float>(triangle[i][(axis + 2) % 3]) / 8, 0, 1};
  }
  constexpr std::array<std::uint32_t, 3> kIndices = {0, 1, 2};
  std::vector<std::uint32_t> touched(std::size_t{kSide} * kSide);
  surefill::Target target;
  target.width = target.height = kSide, target.count = touched;
  surefill::Draw draw;
  draw.vertices = corners, draw.indices = kIndices, draw.conservative = surefill::Conservative::touched;
  if (surefill::render(target, {&draw, 1}) != surefill::Status::ok) touched.clear();
  return touched;
}

// Does the plane of the triangle meet the closed voxel? All numbers are whole, in eighths.
bool plane_meets(const Triangle& t, int x, int y, int z) {
  std::array<std::int64_t, 3> u, v, n;
  for (std::size_t c = 0; c < 3; ++c) u[c] = t[1][c] - t[0][c], v[c] = t[2][c] - t[0][c];
  for (std::size_t c = 0; c < 3; ++c) {
    n[c] = u[(c + 1) % 3] * v[(c + 2) % 3] - u[(c + 2) % 3] * v[(c + 1) % 3];
  }
  const Point low = {8 * x, 8 * y, 8 * z};
  std::int64_t least = 0, most = 0;  // of n . (corner - t[0])
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t at = n[c] * (low[c] - t[0][c]), step = 8 * n[c];
    least += at + (step < 0 ? step : 0), most += at + (step > 0 ? step : 0);
  }
  return least <= 0 && 0 <= most;
}

bool voxelize(const std::vector<Triangle>& surface, std::vector<bool>& solid) {
  for (const Triangle& triangle : surface) {
    std::array<std::vector<std::uint32_t>, 3> views;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      views[axis] = view(triangle, axis);
      if (views[axis].empty()) return false;
    }
    const auto seen = [&](std::size_t axis, int column, int row) {
      return views[axis][static_cast<std::size_t>(row * kSide + column)] != 0;
    };
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          if (seen(0, y, z) && seen(1, z, x) && seen(2, x, y) && plane_meets(triangle, x, y, z)) {
            solid[voxel(x, y, z)] = true;
          }
        }
      }
    }
  }
  return true;
}

// How many voxels can be reached from the corner of the grid without passing one of the surface, from face to face.
int outside(std::vector<bool> solid) {
  std::vector<Point> open = {{0, 0, 0}};
  int reached = 0;
  while (!open.empty()) {
    const Point p = open.back();
    open.pop_back();
    bool in = true;
    for (const int c : p) in = in && c >= 0 && c < kSide;
    if (!in || solid[voxel(p[0], p[1], p[2])]) continue;
    solid[voxel(p[0], p[1], p[2])] = true, ++reached;
    for (std::size_t c = 0; c < 3; ++c) {
      for (const int step : {-1, 1}) {
        open.push_back(p);
        open.back()[c] += step;
      }
    }
  }
  return reached;
}

}  // namespace

int main() {
  // An octahedron whose corners are no voxel's, on a box without a lid: the walls are seen edge on in two views.
  const Point top = {94, 97, 163}, ring[] = {{150, 93, 101}, {97, 153, 99}, {35, 99, 103}, {91, 37, 98}};
  std::vector<Triangle> surface;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % 4];
    surface.push_back({top, a, b});
    const Point under_a = {a[0], a[1], 20}, under_b = {b[0], b[1], 20};
    surface.push_back({a, under_a, b});
    surface.push_back({b, under_a, under_b});
    surface.push_back({under_a, Point{94, 97, 20}, under_b});
  }
  std::vector<bool> solid(kVoxels, false);
  if (!voxelize(surface, solid)) return 1;
  int shell = 0;
  for (const bool one : solid) shell += one ? 1 : 0;
  const int reached = outside(solid), within = static_cast<int>(kVoxels) - shell - reached;
  std::printf("%zu triangles touch %d of %zu voxels; %d lie within\n", surface.size(), shell, kVoxels, within);
  for (const int z : {3, 10, 16}) {
    std::printf("layer %d\n", z);
    for (int y = 0; y < kSide; y += 2) {
      for (int x = 0; x < kSide; ++x) std::putchar(solid[voxel(x, y, z)] ? '#' : '.');
      std::putchar('\n');
    }
  }
  return within > 0 ? 0 : 1;  // the shell has no hole
}
