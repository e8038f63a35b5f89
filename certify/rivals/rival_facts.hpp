// SPDX-License-Identifier: Apache-2.0
//
// What a certificate says of a rival beside its checks.
#ifndef SUREFILL_CERTIFY_RIVAL_FACTS_HPP
#define SUREFILL_CERTIFY_RIVAL_FACTS_HPP

#include <span>

#include "certify/report/certificate.hpp"
#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// Before the checks: who it is, its models and conventions. `declared`: its model as it was before probing.
void add_rival_facts(const RivalSubject& subject, const surefill_adapter_model& declared, Facts& facts);

// A rival that draws nothing is a finding by itself, and the only one.
Certificate unmet(Facts facts, const adapters::Rival& rival);

// After them: why they ended early, what is wrong with it (asking it, so not where the run was interrupted), which of
// its claims no case challenged.
void add_outcome(const RivalSubject& subject, std::span<const CheckResult> results, Facts& facts);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_FACTS_HPP
