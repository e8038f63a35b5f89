// SPDX-License-Identifier: Apache-2.0
//
// Which triangles are drawn wrongly, and in which scenes, where others are right: the one property that tells them apart.
#ifndef SUREFILL_CERTIFY_JUDGE_WHICH_HPP
#define SUREFILL_CERTIFY_JUDGE_WHICH_HPP

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "certify/judge/naming.hpp"

namespace surefill::judge {

// What can be tried.
struct Trials {
  std::function<bool(const corpus::Scene&)> still_wrong;           // is this scene drawn wrongly, too?
  std::function<std::optional<Wrong>(const corpus::Scene&)> draw;  // its two images; none where either is not drawn
  double within = 0;                                               // values are alike: name_fault
};

// "triangles that are less than 0.5 pixels high are not drawn"; empty if nothing tells them apart. Triangles of wrong and
// of fine scenes are drawn alone.
std::string which_triangles(std::span<const Wrong> wrong, std::span<const corpus::Scene> fine, const Trials& trials);

// "only targets wider than 64 pixels are wrong"; empty if nothing tells them apart.
std::string which_scenes(std::span<const Wrong> wrong, std::span<const corpus::Scene> fine);

// "samples are wrong only where an edge passes through them", or within some 2^-k pixels; empty if they are farther away.
std::string how_near_edges(std::span<const Wrong> wrong);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_WHICH_HPP
