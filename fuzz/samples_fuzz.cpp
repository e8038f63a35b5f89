// SPDX-License-Identifier: Apache-2.0
//
// Sample patterns (S4, M1): scenes of 2, 4, 8 or 16 samples a pixel. Engine == oracle, bit for bit, at every sample;
// and without an oracle: samples of one pixel that see one triangle have the same barycentrics.
#include <bit>
#include <string>

#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "oracle/oracle.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::fuzz {
namespace {

void check_once_per_pixel(const corpus::Scene& scene, const corpus::Image& image) {
  if (scene.draws.size() != 1) return;
  for (const corpus::SceneTriangle& triangle : scene.draws[0].triangles) {
    if (triangle.identifier) return;  // two triangles may have one index
  }
  const auto samples = static_cast<std::size_t>(image.samples);
  for (std::size_t s = 0; s < image.index.size(); ++s) {
    const std::size_t first = s - s % samples;
    for (std::size_t other = first; other < s; ++other) {
      if (image.index[other] != image.index[s]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::bit_cast<std::uint32_t>(image.barycentrics[3 * other + i]) !=
            std::bit_cast<std::uint32_t>(image.barycentrics[3 * s + i])) {
          report_finding("samples", "M1: two samples of a pixel have different weights of one triangle",
                         corpus::write_scene(scene));
        }
      }
    }
  }
}

void check(const corpus::Scene& scene) {
  corpus::Frame actual(scene), expected(scene);
  if (const Status status = render(actual.target(), actual.draws()); status != Status::ok) {
    report_finding("samples", std::string("the engine refuses a valid scene: ") + status_text(status),
                   corpus::write_scene(scene));
  }
  check_once_per_pixel(scene, actual.image());
  oracle::render(expected.target(), expected.draws());
  const properties::Comparison comparison = properties::compare(scene, expected.image(), actual.image(), 1);
  if (comparison.differences != 0) {
    report_finding("samples", properties::describe(comparison.first.at(0), scene.samples), corpus::write_scene(scene));
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const surefill::corpus::Scene scene = surefill::fuzz::decode_samples({data, size});
  surefill::fuzz::note_scene([&] { return scene; });
  surefill::fuzz::check(scene);
  return 0;
}

SUREFILL_FUZZ_MUTATORS(samples)
