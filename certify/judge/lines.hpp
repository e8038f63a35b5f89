// SPDX-License-Identifier: Apache-2.0
//
// How a rasterizer draws lines and points: R17 to R21, found by drawing some hundreds of them, each alone, and asking
// which of the shapes explains every one.
#ifndef SUREFILL_CERTIFY_JUDGE_LINES_HPP
#define SUREFILL_CERTIFY_JUDGE_LINES_HPP

#include <optional>
#include <string>
#include <vector>

#include "certify/judge/inference.hpp"

namespace surefill::judge {

// The standards that say something of lines (R24).
enum class Standard : std::uint8_t { none, d3d11, vulkan, opengl };

// Fills in result.model.lines and .points, where the rival draws them and its positions are known. What a standard does not
// allow goes into result.line_problems; what is not found out, into result.open. `declared` is preferred among models that
// explain the probes. Throws Failure.
void infer_lines(Rival& rival, const Expected& expected, Standard standard, const std::optional<Model>& declared,
                 Inference& result);

// What a newcomer would not expect of lines and points, and how they are drawn, a sentence each.
std::vector<std::string> describe_lines(const Model& model, const Rival::Primitives& drawn);

// What is otherwise than `from` says; what is not known differs from nothing.
std::vector<std::string> line_differences(const Model& from, const Model& to, const Rival::Primitives& drawn);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_LINES_HPP
