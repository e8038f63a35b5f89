// SPDX-License-Identifier: Apache-2.0
//
// Models in plain sentences.
#ifndef SUREFILL_CERTIFY_JUDGE_WORDS_HPP
#define SUREFILL_CERTIFY_JUDGE_WORDS_HPP

#include <string>
#include <vector>

#include "certify/judge/turns.hpp"

namespace surefill::judge {

// "grid of 8 bits, nearest-up; fill rule top-left; depth of 24 bits, cleared to 1": one line.
std::string describe(const Model& model);

// What a newcomer would not expect of it, a sentence each: "samples are taken half a pixel to the left", "both sides own
// level edges", "of equal depths the later one comes". Empty for an exact model, or a grid, under one of C3's rules.
std::vector<std::string> departures(const Model& model);

// What coverage depends on, as far as it is not what `from` says: the same sentences, and "its grid has 8 bits, not 4".
std::vector<std::string> differences(const Model& from, const Model& to);

// What the turns show that no rasterizer may do; empty if there is nothing.
std::string turns_problem(const std::vector<Turn>& turns);

// `touching`: slanted triangles cover each pixel that they touch, and no other.
// Where near and far edges turn at different places on every side: "it covers every pixel that a triangle touches", "edges
// reach 1/64 pixel further than they are". Else empty.
std::string turns_shape(const std::vector<Turn>& turns, bool touching);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_WORDS_HPP
