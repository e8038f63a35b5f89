// SPDX-License-Identifier: Apache-2.0
//
// What a rasterizer does beside coverage: what it culls and clips always, the W that it takes, how it keeps depth.
#ifndef SUREFILL_CERTIFY_JUDGE_FACTS_HPP
#define SUREFILL_CERTIFY_JUDGE_FACTS_HPP

#include "certify/judge/inference.hpp"

namespace surefill::judge {

// By large triangles in front of the eye, each drawn alone. Into result.model; what is declined, into result.open.
// Throws Failure.
void infer_facts(Rival& rival, Inference& result);

// The model with the other's facts.
Model with_facts(Model model, const Model& facts);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_FACTS_HPP
