// SPDX-License-Identifier: Apache-2.0
//
// The checks of somebody else's rasterizer, under two verdicts: invariants, which hold whatever its model, and the
// model, which is what it does beside that.
#ifndef SUREFILL_CERTIFY_RIVAL_CHECKS_HPP
#define SUREFILL_CERTIFY_RIVAL_CHECKS_HPP

#include <string>
#include <vector>

#include "certify/rivals/rival_cases.hpp"
#include "certify/run/checks.hpp"

namespace surefill::certify {

inline constexpr const char* kInvariants = "invariants";
inline constexpr const char* kModel = "model";

// Random scene `number`, with what this rival can draw.
corpus::Scene random_rival_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);

// In the order in which they run. Settings and subject must outlive them.
std::vector<Check> list_rival_checks(const Settings& settings, const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_CHECKS_HPP
