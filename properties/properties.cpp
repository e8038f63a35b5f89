// SPDX-License-Identifier: Apache-2.0
#include "properties/properties.hpp"

#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "properties/check.hpp"

namespace surefill::properties {

std::optional<corpus::Image> Check::draw(const corpus::Scene& scene, const corpus::Outputs& outputs) {
  corpus::Frame frame(scene, outputs);
  const Status status = renderer_(frame.target(), frame.draws());
  if (status != Status::ok) {
    differs("the renderer returned \"" + std::string(status_text(status)) + "\"");
    return std::nullopt;
  }
  return std::move(frame.image());
}

void Check::differs(const std::string& finding) {
  if (verdict_.differences++ == 0) verdict_.finding = finding;
}

void Check::differs(std::string_view what, int x, int y, const std::string& expected, const std::string& actual) {
  if (verdict_.differences != 0) {
    ++verdict_.differences;
    return;
  }
  differs(std::string(what) + " at pixel (" + std::to_string(x) + ", " + std::to_string(y) + "): expected " + expected +
          ", got " + actual);
}

void Check::expect_count(std::string_view what, int x, int y, std::uint32_t expected, std::uint32_t actual) {
  if (expected != actual) differs(what, x, y, std::to_string(expected), std::to_string(actual));
}

void Check::expect_bits(std::string_view what, int x, int y, float expected, float actual) {
  if (std::bit_cast<std::uint32_t>(expected) != std::bit_cast<std::uint32_t>(actual))
    differs(what, x, y, text(expected), text(actual));
}

void Check::expect_same(std::string_view what, const corpus::Scene& scene, const corpus::Image& expected,
                        const corpus::Image& actual, const Correspondence& correspondence) {
  const auto samples = static_cast<std::size_t>(expected.samples);
  std::string named(what);
  named += ": ";
  const auto label = [&](std::string_view output) { return named + std::string(output); };
  for (int y = 0; y < expected.height; ++y)
    for (int x = 0; x < expected.width; ++x) {
      if (correspondence.where && !correspondence.where(x, y)) continue;
      const std::array<int, 2> there = correspondence.pixel ? correspondence.pixel(x, y) : std::array<int, 2>{x, y};
      for (std::size_t n = 0; n < samples; ++n) {
        const std::size_t e = element(expected, x, y) * samples + n;
        const std::size_t a = element(actual, there[0], there[1]) * samples + n;
        looked_at(1);
        if (!expected.count.empty() && expected.count[e] != actual.count[a])
          expect_count(label("count"), x, y, expected.count[e], actual.count[a]);
        if (!expected.index.empty() && expected.index[e] != actual.index[a])
          expect_count(label("index"), x, y, expected.index[e], actual.index[a]);
        const auto bits = [&](std::string_view output, float wanted, float got) {
          if (std::bit_cast<std::uint32_t>(wanted) != std::bit_cast<std::uint32_t>(got))
            expect_bits(label(output), x, y, wanted, got);
        };
        if (!expected.depth.empty()) bits("depth", expected.depth[e], actual.depth[a]);
        if (!expected.barycentrics.empty())
          for (std::size_t i = 0; i < 3; ++i)
            bits("barycentrics", expected.barycentrics[3 * e + i],
                 actual.barycentrics[3 * a + correspondence.barycentrics[i]]);
        for (std::size_t k = 0; k < expected.attributes.size(); ++k) {
          if (correspondence.attribute && !correspondence.attribute(scene.attributes[k])) continue;
          const std::size_t components = scene.attributes[k].components;
          for (std::size_t c = 0; c < components && !expected.attributes[k].empty(); ++c)
            bits(scene.attributes[k].name, expected.attributes[k][components * e + c],
                 actual.attributes[k][components * a + c]);
        }
      }
    }
}

std::string text(float value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%a (%.9g)", static_cast<double>(value), static_cast<double>(value));
  return buffer;
}

corpus::SceneVertex scene_vertex(const Vertex& vertex) {
  return {vertex.x, vertex.y, vertex.z, vertex.w, {}};
}

Vertex vertex_of(const corpus::SceneVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z, vertex.w};
}

corpus::Scene triangle_scene(int width, int height, const std::array<Vertex, 3>& vertices) {
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices.reserve(3);
  for (const Vertex& v : vertices) draw.vertices.push_back(scene_vertex(v));
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  return scene;
}

corpus::Scene with_one_triangle(const corpus::Scene& scene, std::size_t draw, std::size_t triangle) {
  corpus::Scene one = scene;
  one.draws = {scene.draws[draw]};
  one.draws[0].triangles = {scene.draws[draw].triangles[triangle]};
  return one;
}

const Category& category_of_case(std::uint64_t n) {
  return categories()[n % categories().size()];
}

corpus::Scene pixel_scene(std::uint64_t n, const SceneLimits& limits) {
  corpus::Scene scene = random_scene(category_of_case(n), n / categories().size(), limits);
  for (corpus::SceneDraw& draw : scene.draws) draw.viewport.reset();
  return scene;
}

std::array<Vertex, 3> triangle_of(const corpus::SceneDraw& draw, const corpus::SceneTriangle& triangle) {
  return {vertex_of(draw.vertices[triangle.vertices[0]]), vertex_of(draw.vertices[triangle.vertices[1]]),
          vertex_of(draw.vertices[triangle.vertices[2]])};
}

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

std::optional<Vertex> scaled_exactly(const Vertex& vertex, int exponent) {
  bool exact = finite(vertex);
  const auto scale = [&](float value) {
    const float result = std::ldexp(value, exponent);
    exact = exact && std::isfinite(result) && std::ldexp(result, -exponent) == value;
    return result;
  };
  const Vertex result = {scale(vertex.x), scale(vertex.y), scale(vertex.z), scale(vertex.w)};
  if (!exact) return std::nullopt;
  return result;
}

std::span<const Property> all_properties() {
  static const std::vector<Property> all = [] {
    std::vector<Property> joined;
    for (const std::span<const Property> list :
         {equality_properties(), partition_properties(), degree_properties(), symmetry_properties(), value_properties(),
          frame_properties(), small_world_properties()})
      joined.insert(joined.end(), list.begin(), list.end());
    return joined;
  }();
  return all;
}

}  // namespace surefill::properties
