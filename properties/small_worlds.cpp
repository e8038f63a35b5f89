// SPDX-License-Identifier: Apache-2.0
//
// Every case there is of a small world. In them, ties, degenerate triangles and vertices on samples are the rule.
#include <array>
#include <cstdint>

#include "properties/check.hpp"

namespace surefill::properties {
namespace {

// The next digit of a number in base `base`, the lowest first.
std::uint32_t digit(std::uint64_t& number, std::uint64_t base) {
  const auto d = static_cast<std::uint32_t>(number % base);
  number /= base;
  return d;
}

Verdict decide_all(const corpus::Scene& scene, const Renderer& renderer) {
  const Comparison comparison = compare(scene, oracle_renderer(), renderer, {true, true, true, true, false}, 1);
  Verdict verdict{comparison.samples, comparison.differences, {}};
  if (!comparison.first.empty()) verdict.finding = describe(comparison.first[0], scene.samples);
  return verdict;
}

// (X, Y, W) over {-1, 0, 1, 2}^3: in front of, through and behind the eye. Depth is one small integer a vertex.
constexpr std::uint64_t kHomogeneous = 64 * 64 * 64;
corpus::Scene make_homogeneous(std::uint64_t number) {
  std::array<Vertex, 3> t{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = [&] { return static_cast<float>(digit(number, 4)) - 1; };
    t[i].x = component(), t[i].y = component(), t[i].w = component();
    t[i].z = static_cast<float>(i) - t[i].x;
  }
  return triangle_scene(4, 4, t);
}

// Vertices on a half-pixel lattice over 2 x 2 pixels, edge and corners included, under all eight fill rules.
constexpr std::uint64_t kHalfPixel = 25 * 25 * 25 * 8;
corpus::Scene make_half_pixel(std::uint64_t number) {
  const auto rule = static_cast<FillRule>(digit(number, 8));
  std::array<Vertex, 3> t{};
  for (Vertex& v : t) {
    v.x = static_cast<float>(digit(number, 5)) / 2;
    v.y = static_cast<float>(digit(number, 5)) / 2;
    v.w = 1;
    v.z = v.x / 2;
  }
  corpus::Scene scene = triangle_scene(2, 2, t);
  scene.draws[0].fill_rule = rule;
  return scene;
}

// X, Y over {-1, 0, 1, 3}, W over {0, 1, 2}: (1, 1, 2) and its like are samples. The signs are T3's.
constexpr std::uint64_t kOctants = 48 * 48 * 48;
corpus::Scene make_octants(std::uint64_t number) {
  constexpr float kValues[] = {-1, 0, 1, 3};
  std::array<Vertex, 3> t{};
  for (Vertex& v : t) {
    v.x = kValues[digit(number, 4)];
    v.y = kValues[digit(number, 4)];
    v.w = static_cast<float>(digit(number, 3));
  }
  return triangle_scene(2, 2, t);
}

Verdict decide_octants(const corpus::Scene& scene, const Renderer& renderer) {
  for (const Property& property : symmetry_properties())
    if (std::string_view(property.name) == "octants") return property.decide(scene, renderer);
  return {0, 1, "no property \"octants\""};
}

// Triangles a b c and c b d over a 4 x 4 half-pixel lattice around two by two samples.
constexpr std::uint64_t kSharedEdge = 16 * 16 * 16 * 16;
corpus::Scene make_shared_edge(std::uint64_t number) {
  corpus::Scene scene;
  scene.width = scene.height = 2;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (int i = 0; i < 4; ++i) {
    const auto coordinate = [&] { return static_cast<float>(digit(number, 4)) / 2; };
    const float x = coordinate(), y = coordinate();
    draw.vertices.push_back({x, y, 0, 1, {}});
  }
  draw.triangles = {{{0, 1, 2}, std::nullopt}, {{2, 1, 3}, std::nullopt}};
  return scene;
}

// Where a and d lie on opposite sides of the line b c, the triangles do not overlap: no sample is covered twice. Where
// b and c also lie on opposite sides of a d, they tile a convex quad, which its other diagonal cuts, too: same counts.
Verdict decide_shared_edge(const corpus::Scene& scene, const Renderer& renderer) {
  Check check(renderer);
  if (scene.draws.empty() || scene.draws[0].triangles.size() < 2) return check.verdict();
  const corpus::SceneDraw& draw = scene.draws[0];
  const auto& [first, second] = std::array{draw.triangles[0].vertices, draw.triangles[1].vertices};
  if (first[1] != second[1] || first[2] != second[0]) return check.verdict();  // no shared edge
  const std::uint32_t a = first[0], b = first[1], c = first[2], d = second[2];
  const auto side = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return facing(triangle_of(draw, {{i, j, k}, std::nullopt}));
  };
  if (side(b, c, a) * side(b, c, d) >= 0) return check.verdict();
  const auto image = check.draw(scene, kCountOnly);
  if (!image) return check.verdict();
  check.looked_at(image->count.size());
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x)
      if (image->count[element(*image, x, y)] > 1)
        check.expect_count("count of two triangles that share an edge", x, y, 1, image->count[element(*image, x, y)]);
  if (side(a, d, b) * side(a, d, c) >= 0) return check.verdict();
  corpus::Scene other = scene;
  other.draws[0].triangles[0].vertices = {b, d, a};
  other.draws[0].triangles[1].vertices = {a, d, c};
  if (const auto turned = check.draw(other, kCountOnly))
    check.expect_same("a quad cut along its other diagonal", scene, *image, *turned);
  return check.verdict();
}

constexpr Property kProperties[] = {
    {"small-world-homogeneous", "C1-C4", "every triangle over {-1, 0, 1, 2}^3 in (X, Y, W) is the oracle's on 4 x 4",
     true, true, kHomogeneous, make_homogeneous, decide_all},
    {"small-world-half-pixel", "C3",
     "every triangle on the half-pixel lattice of 2 x 2, under every fill rule, is the oracle's", true, true,
     kHalfPixel, make_half_pixel, decide_all},
    {"small-world-octants", "T3",
     "every sign pattern of every triple over {-1, 0, 1, 3}^2 x {0, 1, 2} covers 2 x 2 once", false, true, kOctants,
     make_octants, decide_octants},
    {"small-world-shared-edge", "T1",
     "every two triangles that share an edge on a half-pixel lattice neither overlap nor gape", false, true,
     kSharedEdge, make_shared_edge, decide_shared_edge},
};

}  // namespace

std::span<const Property> small_world_properties() {
  return kProperties;
}

}  // namespace surefill::properties
