// SPDX-License-Identifier: Apache-2.0
//
// A scene with draws, attributes and state, engine == oracle, bit for bit: every vertex after its viewport, every
// output of every sample. Any answer of the engine but ok is a finding.
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "oracle/oracle.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::fuzz {
namespace {

// The viewport map of a draw (S3), engine == oracle.
void check_viewport(const corpus::SceneDraw& draw, std::span<const Vertex> actual, const corpus::Scene& scene) {
  std::vector<ClipVertex> clip;
  for (const corpus::SceneVertex& v : draw.vertices) clip.push_back({v.x, v.y, v.z, v.w});
  std::vector<Vertex> expected(clip.size());
  oracle::to_pixel(*draw.viewport, clip, expected);
  const auto same = [](float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Vertex &e = expected[i], &a = actual[i];
    if (!same(e.x, a.x) || !same(e.y, a.y) || !same(e.z, a.z) || !same(e.w, a.w)) {
      report_finding("scene", "to_pixel differs from the oracle's at vertex " + std::to_string(i),
                     corpus::write_scene(scene));
    }
  }
}

void check(const corpus::Scene& scene) {
  const auto fail = [&scene](const std::string& relation) {
    report_finding("scene", relation, corpus::write_scene(scene));
  };
  const corpus::Outputs outputs = properties::outputs_of(scene);
  corpus::Frame actual(scene, outputs);
  const Status status = render(actual.target(), actual.draws());
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    if (scene.draws[d].viewport) check_viewport(scene.draws[d], actual.draws()[d].vertices, scene);
  }
  if (status != Status::ok) fail(std::string("the engine refuses a valid scene: ") + status_text(status));
  corpus::Frame expected(scene, outputs);
  oracle::render(expected.target(), expected.draws());
  const properties::Comparison comparison = properties::compare(scene, expected.image(), actual.image(), 1);
  if (comparison.differences != 0) fail(properties::describe(comparison.first.at(0), scene.samples));
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const surefill::corpus::Scene scene = surefill::fuzz::decode_scene({data, size});
  surefill::fuzz::note_scene([&] { return scene; });
  surefill::fuzz::check(scene);
  return 0;
}

SUREFILL_FUZZ_MUTATORS(scene)
