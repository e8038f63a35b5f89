// SPDX-License-Identifier: Apache-2.0
//
// The depth map of an OBJ file, and which of its triangles are seen.
//
//     depth_map MESH.obj [PICTURE.pgm]
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 640, kHeight = 480;

using Point = std::array<double, 3>;

// A camera on the z axis that looks along -z at a ball around `centre`; clip depth 0..1, y up.
std::vector<surefill::ClipVertex> project(const std::vector<float>& positions, const Point& centre, double radius) {
  constexpr double kFocal = 2.5;  // 1 / tan(half the field of view)
  const double distance = 3 * radius, near = distance - radius, far = distance + radius;
  std::vector<surefill::ClipVertex> clip;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    const double x = positions[i] - centre[0], y = positions[i + 1] - centre[1];
    const double w = distance - (positions[i + 2] - centre[2]);
    clip.push_back({static_cast<float>(x * kFocal * kHeight / kWidth), static_cast<float>(y * kFocal),
                    static_cast<float>((w - near) * far / (far - near)), static_cast<float>(w)});
  }
  return clip;
}

bool write_pgm(const char* path, const std::vector<float>& depth) {
  std::ofstream out(path, std::ios::binary);
  out << "P5\n" << kWidth << ' ' << kHeight << "\n255\n";
  for (const float z : depth) out.put(static_cast<char>(std::isfinite(z) ? std::lround((1 - z) * 255) : 0));
  return out.flush().good();
}

int fail(const char* text) {
  std::fprintf(stderr, "depth_map: %s\n", text);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fail("usage: depth_map MESH.obj [PICTURE.pgm]");
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(argv[1])) return fail("cannot read the mesh");
  const std::vector<float>& positions = reader.GetAttrib().vertices;
  std::vector<std::uint32_t> indices;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      indices.push_back(static_cast<std::uint32_t>(corner.vertex_index));
    }
  }

  Point low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30}, centre;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], static_cast<double>(positions[i]));
    high[i % 3] = std::max(high[i % 3], static_cast<double>(positions[i]));
  }
  double radius_squared = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    centre[c] = (low[c] + high[c]) / 2;
    radius_squared += (high[c] - low[c]) * (high[c] - low[c]) / 4;
  }
  const std::vector<surefill::ClipVertex> clip = project(positions, centre, std::sqrt(radius_squared));

  surefill::Viewport viewport;
  viewport.width = kWidth, viewport.height = kHeight;
  std::vector<surefill::Vertex> vertices(clip.size());
  if (const auto status = surefill::to_pixel(viewport, clip, vertices); status != surefill::Status::ok) {
    return fail(surefill::status_text(status));
  }

  std::vector<float> depth(std::size_t{kWidth} * kHeight);
  std::vector<std::uint32_t> index(depth.size());
  surefill::Target target;
  target.width = kWidth, target.height = kHeight, target.depth = depth, target.index = index;
  surefill::Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  draw.depth_mode = surefill::DepthMode::clip;
  if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
    return fail(surefill::status_text(status));
  }

  std::vector<bool> seen(indices.size() / 3);
  float nearest = 1, farthest = 0;
  std::size_t covered = 0;
  for (std::size_t s = 0; s < index.size(); ++s) {
    if (index[s] == surefill::kNoTriangle) continue;
    seen[index[s]] = true, ++covered;
    nearest = std::min(nearest, depth[s]), farthest = std::max(farthest, depth[s]);
  }
  std::printf("%zu triangles, %td of them seen, on %zu pixels\n", seen.size(),
              std::count(seen.begin(), seen.end(), true), covered);
  std::printf("depth from %.9g to %.9g\n", static_cast<double>(nearest), static_cast<double>(farthest));
  if (argc > 2 && !write_pgm(argv[2], depth)) return fail("cannot write the picture");
  return 0;
}
