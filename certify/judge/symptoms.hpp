// SPDX-License-Identifier: Apache-2.0
//
// Where no known fault draws what the rival draws: what all that is wrong has in common, in plain sentences.
#ifndef SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP
#define SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "certify/judge/naming.hpp"

namespace surefill::judge {

// Three things are looked at, the most telling first. How what came follows from what should have come: the picture
// stands elsewhere or upside down, indices are 1 too large, depth is 2 z - 1. Where it is: in the last row, in each
// eighth column. What it needs: with the scissor taken away it is gone. `still_wrong` says whether a scene is wrong, too;
// it is asked some hundreds of times. Nothing is said of fewer than three scenes, nor of what is not so in nine of ten.
std::vector<std::string> symptoms(std::span<const Wrong> wrong,
                                  const std::function<bool(const corpus::Scene&)>& still_wrong);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_SYMPTOMS_HPP
