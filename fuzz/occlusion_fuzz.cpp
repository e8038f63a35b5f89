// SPDX-License-Identifier: Apache-2.0
//
// The draws of a scene as occluders of a safe occlusion buffer, engine == oracle, bit for bit: the depth of every square
// (O4), and the answers to boxes and rectangles made of the scene's vertices (O5, O6).
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "properties/machinery/resolutions.hpp"

namespace surefill::fuzz {
namespace {

// The scene without what O4 refuses.
corpus::Scene occluders_of(corpus::Scene scene) {
  const bool greater = scene.depth_test == DepthTest::greater || scene.depth_test == DepthTest::greater_equal;
  scene.depth_test = greater ? DepthTest::greater : DepthTest::less;
  scene.samples = 1, scene.layers = 1, scene.origin = {};
  scene.sample_locations.clear(), scene.initial_depth.clear(), scene.attributes.clear();
  for (corpus::SceneDraw& draw : scene.draws) {
    DrawState plain;
    plain.fill_rule = draw.fill_rule > FillRule::closed ? FillRule::top_left : draw.fill_rule;
    plain.front_face = draw.front_face, plain.cull = draw.cull, plain.depth_mode = draw.depth_mode;
    draw.state() = plain;
    for (corpus::SceneVertex& vertex : draw.vertices) vertex.attributes.clear();
  }
  return scene;
}

// Boxes of eight finite vertices in turn, of all draws; a rectangle about the first two vertices of each.
struct Queries {
  std::vector<OcclusionBox> boxes;
  std::vector<OcclusionRectangle> rectangles;
};
Queries queries_of(const corpus::Scene& scene) {
  std::vector<Vertex> vertices;
  for (const corpus::SceneDraw& draw : scene.draws) {
    for (const corpus::SceneVertex& v : draw.vertices) {
      if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w))
        vertices.push_back({v.x, v.y, v.z, v.w});
    }
  }
  Queries queries;
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    const auto at = [&](std::size_t k) { return vertices[(n + k) % vertices.size()]; };
    OcclusionBox& box = queries.boxes.emplace_back();
    for (std::size_t k = 0; k < 8; ++k) box.corners[k] = at(k);
    const Vertex a = at(0), b = at(1);
    queries.rectangles.push_back({std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y), a.z});
  }
  return queries;
}

void check(const corpus::Scene& scene) {
  const auto fail = [&scene](const std::string& relation) {
    report_finding("occlusion", relation, corpus::write_scene(scene));
  };
  const properties::SafeBuffer expected = properties::oracle_safe_buffer()(scene);
  const Queries queries = queries_of(scene);
  for (const Path path : {Path::automatic, Path::reference}) {
    Options options;
    options.path = path, options.threads = 1 + scene.height % 3;
    const properties::SafeBuffer actual = properties::engine_safe_buffer(options)(scene);
    if (actual.depth.size() != expected.depth.size()) fail("the engine refuses valid occluders");
    for (std::size_t s = 0; s < expected.depth.size(); ++s) {
      if (std::bit_cast<std::uint32_t>(actual.depth[s]) != std::bit_cast<std::uint32_t>(expected.depth[s]))
        fail("depth of square " + std::to_string(s) + " differs from the oracle's");
    }
    for (const bool equal : {false, true}) {
      for (const OcclusionBox& box : queries.boxes)
        if (actual.box(box, equal) != expected.box(box, equal)) fail("the answer to a box differs from the oracle's");
      for (const OcclusionRectangle& rectangle : queries.rectangles) {
        if (actual.rectangle(rectangle, equal) != expected.rectangle(rectangle, equal))
          fail("the answer to a rectangle differs from the oracle's");
      }
    }
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const surefill::corpus::Scene scene = surefill::fuzz::occluders_of(surefill::fuzz::decode_scene({data, size}));
  surefill::fuzz::note_scene([&] { return scene; });
  surefill::fuzz::check(scene);
  return 0;
}

SUREFILL_FUZZ_MUTATORS(scene)
