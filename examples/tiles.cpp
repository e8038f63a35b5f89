// SPDX-License-Identifier: Apache-2.0
//
// A picture that is larger than any target, piece by piece: 60,000 x 40,000 pixels of an OBJ file. The vertices are those of
// the whole picture; a tile's origin says which part of it the tile is [S6]. Tiles that overlap agree where they do, to the
// bit [T9], which is checked along the seams. All tiles take minutes: a few are drawn, where the outline passes.
//
//     tiles MESH.obj
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 60000, kHeight = 40000;  // of the picture
constexpr int kTile = 512, kShared = 64;        // a tile, and what it shares with its neighbour

struct Tile {
  std::vector<std::uint32_t> index = std::vector<std::uint32_t>(std::size_t{kTile} * kTile);
  std::vector<float> depth = std::vector<float>(std::size_t{kTile} * kTile);
};

int fail(const char* text) {
  std::fprintf(stderr, "tiles: %s\n", text);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fail("usage: tiles MESH.obj");
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(argv[1])) return fail("cannot read the mesh");
  const std::vector<float>& positions = reader.GetAttrib().vertices;
  std::vector<std::uint32_t> indices;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      indices.push_back(static_cast<std::uint32_t>(corner.vertex_index));
    }
  }

  // A camera on the z axis, 4 in front of the mesh.
  std::vector<surefill::ClipVertex> clip;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    const float w = 4 - positions[i + 2];
    clip.push_back({positions[i] * 2.5f * kHeight / kWidth, positions[i + 1] * 2.5f, w - 2, w});
  }
  surefill::Viewport viewport;
  viewport.width = kWidth, viewport.height = kHeight;
  std::vector<surefill::Vertex> vertices(clip.size());
  if (const auto status = surefill::to_pixel(viewport, clip, vertices); status != surefill::Status::ok) {
    return fail(surefill::status_text(status));
  }
  surefill::Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.front_face = surefill::FrontFace::counter_clockwise;
  draw.cull = surefill::Cull::back;

  // A row of tiles across the picture's middle, each ending where its neighbour has begun already.
  constexpr int kTiles = 6, kStep = kTile - kShared, kLeft = 23000, kTop = 20000;
  std::vector<Tile> tiles(kTiles);
  long long covered = 0, compared = 0, differ = 0;
  for (int t = 0; t < kTiles; ++t) {
    Tile& tile = tiles[static_cast<std::size_t>(t)];
    surefill::Target target;
    target.width = target.height = kTile;
    target.origin = {kLeft + t * kStep, kTop};
    target.index = tile.index, target.depth = tile.depth;
    if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
      return fail(surefill::status_text(status));
    }
    covered += std::count_if(tile.index.begin(), tile.index.end(), [](auto i) { return i != surefill::kNoTriangle; });
    for (int y = 0; t > 0 && y < kTile; ++y) {
      const Tile& left = tiles[static_cast<std::size_t>(t) - 1];
      const auto row = static_cast<std::size_t>(y) * kTile;
      for (std::size_t x = 0; x < kShared; ++x, ++compared) {
        const bool same = left.index[row + kStep + x] == tile.index[row + x] &&
                          std::memcmp(&left.depth[row + kStep + x], &tile.depth[row + x], sizeof(float)) == 0;
        differ += same ? 0 : 1;
      }
    }
  }
  std::printf("%d tiles of %d x %d within %d x %d pixels: %lld pixels show the mesh\n", kTiles, kTile, kTile, kWidth,
              kHeight, covered);
  std::printf("along the seams %lld pixels were drawn twice: %lld differ\n", compared, differ);
  return covered > 0 && differ == 0 ? 0 : 1;
}
