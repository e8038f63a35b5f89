// SPDX-License-Identifier: Apache-2.0
//
// Where no known fault draws what the rival draws: what all that is wrong has in common, in plain sentences.
#ifndef SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP
#define SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP

#include <span>
#include <string>
#include <vector>

#include "certify/judge/naming.hpp"
#include "certify/judge/which.hpp"

namespace surefill::judge {

// What is looked at, the most telling first: how what came follows from what should have come (the picture stands
// elsewhere, indices are 1 too large, depth is 2 z - 1); where it is (in the last row, in each eighth column); what it
// needs (with the scissor taken away it is gone); which triangles and which scenes it is about (those under half a pixel,
// targets over so many pixels); how far from edges it goes. Nothing is said of fewer than three scenes, nor of what is not
// so in nine of ten. `fine` are scenes that are drawn right.
std::vector<std::string> symptoms(std::span<const Wrong> wrong, std::span<const corpus::Scene> fine,
                                  const Trials& trials);

// Of each part that most of the wrong scenes have, the scenes that are drawn right once it is taken away: what draws them wrong
// is another fault (drop_refuted).
std::vector<std::vector<corpus::Scene>> right_without(std::span<const Wrong> wrong, const Trials& trials);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP
