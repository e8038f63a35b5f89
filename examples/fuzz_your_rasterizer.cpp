// SPDX-License-Identifier: Apache-2.0
//
// Fuzz your rasterizer against the exact answer: call it in draw(), build with -DSUREFILL_FUZZ=ON and run
// (docs/fuzzing.md). The mutators come with it: they put vertices on samples, edges through samples and triangles
// behind the eye.
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "properties/machinery/compare.hpp"

namespace {

// Yours. Draws triangle 0 of draw 0 with its state; target.count[y * target.width + x] becomes 1 where it covers.
surefill::Status draw(const surefill::Target& target, std::span<const surefill::Draw> draws) {
  return surefill::render(target, draws);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill;
  corpus::Scene scene = fuzz::decode_triangle({data, size});
  scene.samples = 1;  // here goes what yours does not do, or an early return for it
  corpus::Outputs compared;
  compared.index = compared.depth = compared.barycentrics = compared.attributes = false;
  const properties::Comparison comparison =
      properties::compare(scene, properties::oracle_renderer(), draw, compared, 1);
  if (comparison.differences != 0) {
    fuzz::report_finding("your_rasterizer", properties::describe(comparison.first.at(0), 1),
                         corpus::write_scene(scene));
  }
  return 0;
}

SUREFILL_FUZZ_MUTATORS(triangle)
