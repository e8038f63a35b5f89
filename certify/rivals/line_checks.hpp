// SPDX-License-Identifier: Apache-2.0
//
// The checks of lines and points of somebody else's rasterizer: R17 to R24.
#ifndef SUREFILL_CERTIFY_LINE_CHECKS_HPP
#define SUREFILL_CERTIFY_LINE_CHECKS_HPP

#include <cstdint>

#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// Does it draw lines, points? May these have a width?
judge::Rival::Primitives primitives_of(const adapters::Rival& rival);

// Random scenes of lines and points, with what this rival can draw; without lines, or without points, the other one.
corpus::Scene line_scene_for(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);

// One line in front of the eye, on the target. (1) to (3) of R22 are owed where `owes_line_rules`.
corpus::Scene lone_line_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);
bool owes_line_rules(const RivalSubject& subject, bool wide);
CaseResult line_rule_case(const corpus::Scene& scene, const RivalSubject& subject);

// Thin lines one after another that run one way. (4) of R22 is owed where `owes_strips`.
corpus::Scene strip_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);
bool owes_strips(const RivalSubject& subject);
CaseResult strip_case(const corpus::Scene& scene, const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_LINE_CHECKS_HPP
