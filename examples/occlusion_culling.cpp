// SPDX-License-Identifier: Apache-2.0
//
// Occlusion culling as game engines do it: draw the big things into a depth buffer, ask of every object's box whether
// it could be seen, and draw only those. Then the proof: with all objects drawn, none of the hidden ones owns a pixel.
#include <cstdio>
#include <vector>

#include "surefill/occlusion.hpp"

namespace {

constexpr int kWidth = 320, kHeight = 180;

// World to pixel-homogeneous: a camera in the origin that looks along +z, 160 pixels a unit at distance 1; depth is
// reversed: 1 / z, larger is nearer. All numbers are small multiples of powers of two, so nothing is rounded.
surefill::Vertex project(float x, float y, float z) {
  return {x * 160 + z * (kWidth / 2), y * 160 + z * (kHeight / 2), 1, z};
}

struct Box {
  float x0, y0, z0, x1, y1, z1;
};

surefill::OcclusionBox corners_of(const Box& b) {
  surefill::OcclusionBox corners;
  for (int i = 0; i < 8; ++i) {
    corners.corners[i] = project((i & 1) != 0 ? b.x1 : b.x0, (i & 2) != 0 ? b.y1 : b.y0, (i & 4) != 0 ? b.z1 : b.z0);
  }
  return corners;
}

// Twelve triangles over the corners above.
constexpr std::uint32_t kFaces[36] = {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 2, 6, 4,
                                      1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6};

struct Mesh {
  std::vector<surefill::Vertex> vertices;
  std::vector<std::uint32_t> indices;

  void add(const Box& box) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const surefill::Vertex& v : corners_of(box).corners) vertices.push_back(v);
    for (const std::uint32_t i : kFaces) indices.push_back(first + i);
  }
  surefill::Draw draw() const {
    surefill::Draw d;
    d.vertices = vertices, d.indices = indices;
    return d;
  }
};

int fail(surefill::Status status) {
  std::fprintf(stderr, "occlusion_culling: %s\n", surefill::status_text(status));
  return 1;
}

}  // namespace

int main() {
  // A street: houses on both sides hide a field of crates; some crates stand in the street, and some behind the eye.
  Mesh houses;
  for (int i = 0; i < 6; ++i) {
    const auto z = static_cast<float>(2 + 3 * i);
    houses.add({-5, -2, z, -1, 1, z + 2.5f});
    houses.add({1, -2, z, 5, 1, z + 2.5f});
  }
  std::vector<Box> crates;
  for (int z = -4; z < 40; z += 2) {
    for (int x = -40; x <= 40; ++x) {
      const auto fx = static_cast<float>(x) / 2, fz = static_cast<float>(z) / 2;
      crates.push_back({fx, 0.5f, fz, fx + 0.25f, 0.75f, fz + 0.25f});
    }
  }

  surefill::OcclusionBuffer buffer;
  if (const auto status = buffer.resize(kWidth, kHeight, surefill::DepthTest::greater);
      status != surefill::Status::ok) {
    return fail(status);
  }
  const surefill::Draw occluders = houses.draw();
  if (const auto status = buffer.draw({&occluders, 1}); status != surefill::Status::ok) return fail(status);

  std::vector<surefill::OcclusionBox> boxes;
  for (const Box& crate : crates) boxes.push_back(corners_of(crate));
  std::vector<surefill::Occlusion> answers(boxes.size());
  if (const auto status = buffer.query(boxes, answers); status != surefill::Status::ok) return fail(status);

  // Everything, houses first, so that triangle 12 i belongs to box i.
  Mesh all = houses;
  for (const Box& crate : crates) all.add(crate);
  std::vector<std::uint32_t> index(std::size_t{kWidth} * kHeight);
  surefill::Target target;
  target.width = kWidth, target.height = kHeight, target.index = index;
  target.depth_test = surefill::DepthTest::greater;
  const surefill::Draw everything = all.draw();
  if (const auto status = surefill::render(target, {&everything, 1}); status != surefill::Status::ok)
    return fail(status);

  int counts[3] = {}, wrong = 0;
  for (const surefill::Occlusion answer : answers) ++counts[static_cast<int>(answer)];
  for (const std::uint32_t triangle : index) {
    if (triangle == surefill::kNoTriangle || triangle < houses.indices.size() / 3) continue;
    if (answers[triangle / 12 - houses.indices.size() / 36] != surefill::Occlusion::visible) ++wrong;
  }
  std::printf("%zu crates: %d outside, %d hidden, %d may be seen\n", crates.size(), counts[0], counts[1], counts[2]);
  std::printf("pixels of crates that were called hidden or outside: %d\n", wrong);
  return wrong == 0 ? 0 : 1;
}
