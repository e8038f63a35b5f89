// SPDX-License-Identifier: Apache-2.0
//
// Two images of one scene, compared with ==: bit for bit, no tolerance.
#ifndef SUREFILL_PROPERTIES_COMPARE_HPP
#define SUREFILL_PROPERTIES_COMPARE_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::properties {

// A rasterizer under test: draws a valid frame into the target's buffers. Not ok is a finding, too.
using Renderer = std::function<Status(const Target&, std::span<const Draw>)>;

Renderer engine_renderer();          // surefill::render
Renderer oracle_renderer();          // oracle::render
Renderer clipped_oracle_renderer();  // oracle::clipped::render

// One value that differs. `output` is "count", "index", "depth", "barycentrics" or the attribute's name.
struct Difference {
  std::string output;
  int x = 0, y = 0, sample = 0, component = 0;
  std::string expected, actual;  // hexfloat and decimal, or an integer
};

struct Comparison {
  std::uint64_t samples = 0;      // samples compared (each in all outputs that both images have)
  std::uint64_t values = 0;       // values compared
  std::uint64_t differences = 0;  // values that differ
  std::vector<Difference> first;  // the first few of them, at most `keep`
};

// Images of the same size and outputs. All NaNs are alike; -0 and +0 differ.
Comparison compare(const corpus::Scene& scene, const corpus::Image& expected, const corpus::Image& actual,
                   std::size_t keep = 16);

// Draws the scene with both and compares. A renderer that returns another status than ok counts as one difference, with
// the status in `first`. Outputs that the scene's modes exclude (M4) are left out.
Comparison compare(const corpus::Scene& scene, const Renderer& expected, const Renderer& actual,
                   const corpus::Outputs& outputs = {}, std::size_t keep = 16);

// The outputs that this scene can have: all, or count alone where a draw is conservative (M4).
corpus::Outputs outputs_of(const corpus::Scene& scene);

// One line for people: "depth at pixel (3, 4): expected 0x1p-1 (0.5), got ..."
std::string describe(const Difference& difference, int samples);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_COMPARE_HPP
