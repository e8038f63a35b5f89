// SPDX-License-Identifier: Apache-2.0
//
// UV coverage of a light map. A baker needs for every texel the triangle that owns it, without holes or double owners
// along shared edges, and the texels that bilinear filtering reads beyond the chart's rim, or else seams show:
//     owned      the texel's centre lies in a triangle [C2, C3]: bake here
//     border     not owned, but a triangle touches the texel's square [M4, over]: bake it from the triangle that the
//                index of the conservative frame names [M4c], at the place of it that is nearest to the centre
//     overlap    owned more than once: two charts lie on each other, a fault of the unwrapping
#include <array>
#include <cstdio>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kSize = 64;  // texels each way
constexpr std::size_t kTexels = std::size_t{kSize} * kSize;

struct Charts {
  std::vector<surefill::Vertex> vertices;  // UV times the size of the map, W = 1
  std::vector<std::uint32_t> indices;

  std::uint32_t add(float u, float v) {
    vertices.push_back({u * kSize, v * kSize, 0, 1});
    return static_cast<std::uint32_t>(vertices.size()) - 1;
  }

  // A disc of thin triangles around a centre, over a rim that is no multiple of a texel.
  void add_disc(float u, float v, float radius) {
    constexpr float kRim[][2] = {{1, 0},        {0.8f, 0.6f},    {0.6f, 0.8f},   {0, 1},         {-0.28f, 0.96f},
                                 {-0.6f, 0.8f}, {-0.96f, 0.28f}, {-0.8f, -0.6f}, {0.1f, -0.99f}, {0.6f, -0.8f}};
    constexpr std::uint32_t kCorners = std::size(kRim);
    const std::uint32_t centre = add(u, v);
    for (const auto& p : kRim) add(u + radius * p[0], v + radius * p[1]);
    for (std::uint32_t i = 0; i < kCorners; ++i) {
      indices.insert(indices.end(), {centre, centre + 1 + i, centre + 1 + (i + 1) % kCorners});
    }
  }
};

// The counts and, where `index` is asked for, a triangle of each texel that is counted.
std::vector<std::uint32_t> coverage(const Charts& charts, surefill::Conservative conservative,
                                    std::vector<std::uint32_t>* index = nullptr) {
  std::vector<std::uint32_t> count(kTexels);
  surefill::Target target;
  target.width = target.height = kSize, target.count = count;
  if (index != nullptr) {
    index->resize(kTexels);
    target.index = *index;
  }
  surefill::Draw draw;
  draw.vertices = charts.vertices, draw.indices = charts.indices, draw.conservative = conservative;
  if (const auto status = surefill::render(target, {&draw, 1}); status != surefill::Status::ok) {
    std::fprintf(stderr, "light_map: %s\n", surefill::status_text(status));
    return {};
  }
  return count;
}

struct Report {
  int owned = 0, border = 0, overlap = 0;
  int orphans = 0;  // border texels without a triangle to bake from
};

Report report(const char* name, const Charts& charts) {
  const std::vector<std::uint32_t> owners = coverage(charts, surefill::Conservative::none);
  std::vector<std::uint32_t> owner;
  const std::vector<std::uint32_t> touched = coverage(charts, surefill::Conservative::over, &owner);
  Report r;
  if (owners.empty() || touched.empty()) return r;
  for (std::size_t t = 0; t < kTexels; ++t) {
    r.owned += owners[t] == 1;
    r.overlap += owners[t] > 1;
    const bool border = owners[t] == 0 && touched[t] > 0;
    r.border += border;
    r.orphans += border && owner[t] >= charts.indices.size() / 3;
  }
  std::printf("%s: %d texels owned, %d on the border, %d of these without an owner, %d overlaps\n", name, r.owned,
              r.border, r.orphans, r.overlap);
  for (int y = 0; y < kSize; y += 2) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t t = static_cast<std::size_t>(y * kSize + x);
      std::putchar(owners[t] > 1 ? '!' : owners[t] == 1 ? '#' : touched[t] > 0 ? '+' : '.');
    }
    std::putchar('\n');
  }
  return r;
}

}  // namespace

int main() {
  Charts good;
  good.add_disc(0.27f, 0.27f, 0.23f);
  good.add_disc(0.7f, 0.7f, 0.25f);
  Charts bad = good;
  bad.add_disc(0.5f, 0.45f, 0.15f);
  const Report of_good = report("good charts", good), of_bad = report("overlapping charts", bad);
  return of_good.owned > 0 && of_good.orphans == 0 && of_good.overlap == 0 && of_bad.overlap > 0 ? 0 : 1;
}
