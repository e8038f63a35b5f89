// SPDX-License-Identifier: Apache-2.0
//
// What OpenGL and Vulkan ask of lines, whichever way they are drawn: R22.
#ifndef SUREFILL_CERTIFY_JUDGE_LINE_RULES_HPP
#define SUREFILL_CERTIFY_JUDGE_LINE_RULES_HPP

#include <optional>
#include <string>

#include "certify/judge/rival.hpp"

namespace surefill::judge {

// A line that is drawn alone: no width is thin.
struct LoneLine {
  int width = 0, height = 0;  // of the target
  std::array<Vertex, 2> ends{};
  std::optional<float> line_width;
};

// Of a scene of one line, or nothing.
std::optional<LoneLine> lone_line(const corpus::Scene& scene);

struct RuleVerdict {
  bool judged = false;  // R22's conditions hold
  int rule = 0;         // the first that is broken, 1 to 3; 0: none
  std::string finding;  // in words
};

// `covered` says of each sample whether it is. The positions are the model's; how it draws lines has no part.
RuleVerdict judge_line(const Expected& expected, const Model& model, const LoneLine& line,
                       const std::vector<bool>& covered);

// (4): lines i of `ends` go from ends[i] to ends[i + 1], all of one major axis and one direction, as `strip_runs` says.
RuleVerdict judge_strip(const Expected& expected, const Model& model, int width, int height,
                        std::span<const Vertex> ends, std::span<const std::uint32_t> counts);
bool strip_runs(std::span<const Vertex> ends);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_LINE_RULES_HPP
