// SPDX-License-Identifier: Apache-2.0
//
// The checks of somebody else's rasterizer, under two verdicts: invariants, which every rasterizer owes, and the exact
// model, which is equality with the oracle under the model that it follows.
#ifndef SUREFILL_CERTIFY_RIVAL_CHECKS_HPP
#define SUREFILL_CERTIFY_RIVAL_CHECKS_HPP

#include <string>
#include <vector>

#include "certify/rivals/model.hpp"
#include "certify/rivals/rival.hpp"
#include "certify/run/checks.hpp"

namespace surefill::certify {

inline constexpr const char* kInvariants = "invariants";
inline constexpr const char* kExactModel = "exact model";

// What the checks need to know of the rival. Its model is set: what it declares, else what was inferred.
struct RivalSubject {
  adapters::Rival* rival = nullptr;
  adapters::Inference inference;
  bool declared = false;            // it says what its model is
  std::uint32_t reported_bits = 0;  // of subpixel precision, where it declares no model; 0: none
  bool slow = false;                // a program over pipes: fewer cases
  std::string replay_option;        // how `surefill replay` is told of it
};

// Probes, and sets the model.
RivalSubject meet_rival(adapters::Rival& rival);

// In the order in which they run. Settings and subject must outlive them.
std::vector<Check> list_rival_checks(const Settings& settings, const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_CHECKS_HPP
