// SPDX-License-Identifier: Apache-2.0
#include "certify/run/judge.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "oracle/oracle.hpp"

namespace surefill::certify {

namespace {

corpus::Scene one_triangle() {
  corpus::Scene scene;
  scene.width = scene.height = 4;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices = {{0, 0, 0, 1, {}}, {4, 0, 0, 1, {}}, {0, 4, 0, 1, {}}};
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  return scene;
}

bool draws(const properties::Renderer& renderer, const corpus::Scene& scene) {
  corpus::Frame frame(scene, properties::outputs_of(scene));
  return renderer(frame.target(), frame.draws()) == Status::ok;
}

bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

void judge_viewport(const corpus::SceneDraw& draw, std::size_t number, std::size_t keep,
                    properties::Comparison& result) {
  std::vector<ClipVertex> clip;
  for (const corpus::SceneVertex& vertex : draw.vertices) clip.push_back({vertex.x, vertex.y, vertex.z, vertex.w});
  std::vector<Vertex> expected(clip.size()), actual(clip.size());
  const Status status = to_pixel(*draw.viewport, clip, actual);
  if (status != Status::ok) {
    ++result.differences;
    result.first.push_back({"status", 0, 0, 0, 0, "ok", status_text(status)});
    return;
  }
  oracle::to_pixel(*draw.viewport, clip, expected);
  for (std::size_t i = 0; i < clip.size(); ++i) {
    const std::array<float, 4> wanted{expected[i].x, expected[i].y, expected[i].z, expected[i].w};
    const std::array<float, 4> got{actual[i].x, actual[i].y, actual[i].z, actual[i].w};
    for (std::size_t k = 0; k < 4; ++k) {
      ++result.values;
      if (same(wanted[k], got[k])) continue;
      ++result.differences;
      if (result.first.size() < keep) {
        result.first.push_back({"vertex", static_cast<int>(i), static_cast<int>(number), 0, static_cast<int>(k),
                                fmt::format("{:a} ({:.9g})", wanted[k], wanted[k]),
                                fmt::format("{:a} ({:.9g})", got[k], got[k])});
      }
    }
  }
}

}  // namespace

Support probe_support(const properties::Renderer& renderer) {
  Support support;
  corpus::Scene scene = one_triangle();
  scene.samples = 4;
  support.samples = draws(renderer, scene);
  scene = one_triangle();
  scene.draws[0].grid = Grid{};
  support.grid = draws(renderer, scene);
  scene = one_triangle();
  scene.draws[0].conservative = Conservative::over;
  support.conservative = draws(renderer, scene);
  return support;
}

bool supported(const corpus::Scene& scene, const Support& support) {
  if (scene.samples > 1 && !support.samples) return false;
  for (const corpus::SceneDraw& draw : scene.draws) {
    if (draw.grid && !support.grid) return false;
    if (draw.conservative != Conservative::none && !support.conservative) return false;
  }
  return true;
}

properties::Comparison judge(const corpus::Scene& scene, const properties::Renderer& expected,
                             const properties::Renderer& actual, std::size_t keep) {
  properties::Comparison vertices;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    if (scene.draws[d].viewport) judge_viewport(scene.draws[d], d, keep, vertices);
  }
  properties::Comparison image = properties::compare(scene, expected, actual, {}, keep);
  image.values += vertices.values;
  image.differences += vertices.differences;
  image.first.insert(image.first.begin(), vertices.first.begin(), vertices.first.end());
  return image;
}

bool valid(const corpus::Scene& scene) {
  try {
    const corpus::Frame frame(scene, properties::outputs_of(scene));
    return validate(frame.target(), frame.draws()) == Status::ok;
  } catch (const corpus::SceneError&) {
    return false;
  }
}

std::string describe_finding(const properties::Difference& difference, int samples) {
  if (difference.output != "vertex") return properties::describe(difference, samples);
  return fmt::format("{} of vertex {} of draw {} after the viewport (S3): expected {}, got {}",
                     "XYZW"[difference.component], difference.x, difference.y, difference.expected, difference.actual);
}

std::string kind_of_finding(const std::string& finding) {
  std::string kind = finding.substr(0, finding.find(" at pixel"));
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

}  // namespace surefill::certify
