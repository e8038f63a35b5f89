// SPDX-License-Identifier: Apache-2.0
//
// Classes of triangles and samples: who owns those on edges and at vertices, what is too small to be drawn.
#ifndef SUREFILL_CERTIFY_JUDGE_OWNERS_HPP
#define SUREFILL_CERTIFY_JUDGE_OWNERS_HPP

#include "certify/judge/inference.hpp"

namespace surefill::judge {

// Edges of every side through a sample, of both facings, from each vertex on; and vertices on it. Into result.model.
// Throws Failure, Declined.
void infer_owners(Rival& rival, Inference& result);

// R8: small triangles around a sample, down to a step of the grid: what is the smallest that is drawn?
void infer_small(Rival& rival, Inference& result);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_OWNERS_HPP
