// SPDX-License-Identifier: Apache-2.0
//
// T1 for one triangle: it and its pieces, cut at points whose float32 components are exact, cover the same.
#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {

std::optional<Vertex> combined_exactly(const std::array<Vertex, 3>& t, const std::array<int, 3>& weights) {
  Vertex result{};
  for (float Vertex::*const component : {&Vertex::x, &Vertex::y, &Vertex::z, &Vertex::w}) {
    double terms[3];
    for (std::size_t i = 0; i < 3; ++i) terms[i] = static_cast<double>(t[i].*component) * weights[i];
    const auto first = exact_sum(terms[0], terms[1]);
    const auto all = first ? exact_float_sum(*first, terms[2]) : std::nullopt;
    if (!all) return std::nullopt;
    result.*component = *all;
  }
  return result;
}

std::vector<std::array<Vertex, 3>> pieces_of(const std::array<Vertex, 3>& t, Random& random) {
  for (int attempt = 0; attempt < 4; ++attempt) {
    std::array<int, 3> weights{};
    for (int& weight : weights) weight = random.between(0, attempt < 2 ? 2 : 1);
    if ((weights[0] != 0) + (weights[1] != 0) + (weights[2] != 0) < 2) continue;
    const std::optional<Vertex> middle = combined_exactly(t, weights);
    if (!middle) continue;
    std::vector<std::array<Vertex, 3>> pieces;
    for (std::size_t i = 0; i < 3; ++i) {
      if (weights[i] == 0) continue;
      pieces.push_back(t);
      pieces.back()[i] = *middle;
    }
    return pieces;
  }
  return {t};
}

Random random_of(const corpus::Scene& scene) {
  std::uint64_t seed = static_cast<std::uint64_t>(scene.width * 64 + scene.height);
  for (const corpus::SceneDraw& draw : scene.draws) seed = seed * 31 + draw.triangles.size() + 7 * draw.vertices.size();
  if (!scene.draws.empty() && !scene.draws[0].vertices.empty()) {
    const float x = scene.draws[0].vertices[0].x;
    seed ^= std::uint64_t{std::bit_cast<std::uint32_t>(x)} << 20;
  }
  return Random(seed);
}

namespace {

corpus::Scene make(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.attributes = false;
  limits.state = n / categories().size() % 2 == 1;
  return pixel_scene(n, limits);
}

// Pieces keep the facing of the whole and, Z being cut like X and Y, its depth.
TrialResult decide(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const corpus::Scene whole = without_attributes(scene);
  corpus::Scene split = whole;
  Random random = random_of(scene);
  for (corpus::SceneDraw& draw : split.draws) {
    const corpus::SceneDraw old = draw;
    draw.first_index.reset();
    draw.vertices.clear();
    draw.triangles.clear();
    for (const corpus::SceneTriangle& triangle : old.triangles)
      for (const auto& piece : pieces_of(triangle_of(old, triangle), random)) {
        const auto first = static_cast<std::uint32_t>(draw.vertices.size());
        for (const Vertex& v : piece) draw.vertices.push_back(scene_vertex(v));
        draw.triangles.push_back({{first, first + 1, first + 2}, std::nullopt});
      }
  }
  corpus::Outputs outputs = outputs_of(scene);
  outputs.index = outputs.barycentrics = outputs.attributes = false;
  const auto before = trial.draw(whole, outputs), after = trial.draw(split, outputs);
  if (before && after) trial.expect_same("with triangles cut into pieces", whole, *before, *after);
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"split", "T1, C2, I1", "a triangle and its pieces, cut at an exact point, have the same counts and depths", false,
     true, 0, make, decide},
};

}  // namespace

std::span<const Property> split_properties() {
  return kProperties;
}

}  // namespace surefill::properties
