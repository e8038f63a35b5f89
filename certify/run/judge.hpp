// SPDX-License-Identifier: Apache-2.0
//
// The rasterizer under test held against the oracle on one scene.
#ifndef SUREFILL_CERTIFY_JUDGE_HPP
#define SUREFILL_CERTIFY_JUDGE_HPP

#include <string>

#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::certify {

// Which modes of the semantics a rasterizer has; found by drawing a triangle in each.
struct Support {
  bool samples = false, grid = false, conservative = false;
};
Support probe_support(const properties::Renderer& renderer);

// Does the rasterizer have every mode of this scene?
bool supported(const corpus::Scene& scene, const Support& support);

// The vertices that pass a viewport (S3: surefill::to_pixel against the oracle's), then the image, output by output. In
// a difference of output "vertex", x is the number of the vertex, y that of the draw, component 0..3 is X, Y, Z, W.
properties::Comparison judge(const corpus::Scene& scene, const properties::Renderer& expected,
                             const properties::Renderer& actual, std::size_t keep = 1);

// Is the scene one that a rasterizer has to draw (surefill::validate)?
bool valid(const corpus::Scene& scene);

// properties::describe, and "vertex" as well.
std::string describe_finding(const properties::Difference& difference, int samples);

// What a finding is about, without its numbers: "count", "depth of an empty sample", or why there is no image.
std::string kind_of_finding(const std::string& finding);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_JUDGE_HPP
