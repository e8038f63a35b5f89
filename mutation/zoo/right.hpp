// SPDX-License-Identifier: Apache-2.0
//
// Right rasterizers of every kind that docs/semantics.md knows as a model (section 11): whoever accuses one of them is
// wrong. They share nothing with the oracle: three small code bases, in integers, in float32 and in double.
#ifndef SUREFILL_MUTATION_ZOO_RIGHT_HPP
#define SUREFILL_MUTATION_ZOO_RIGHT_HPP

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "certify/adapter.h"

namespace surefill::zoo {

// A choice for each of these; kChoices has how many there are.
enum Choice : std::size_t {
  kCode,       // integers, float32, double
  kPlace,      // of the sample: the middle, the corner, (1/4, 3/4), 7/12
  kBits,       // of the grid: none, 8, 4, 2
  kOtherBits,  // of y: the same, 6
  kRounding,   // nearest-up, nearest-even, nearest-away, floor, truncate, ceiling
  kOwners,     // top-left, bottom-right, southwards, closed, open, both of level edges, by facing, by order
  kBlur,       // none, through a float32 above 128
  kViewport,   // exact, a pixel less, moved by a quarter
  kFormat,     // of depth: float32, double, 24 bits, 16 bits
  kClip,       // to depth 0 to 1: no, always, always by cutting triangles, where a draw asks by cutting triangles
  kRange,      // of clip depth: 0 to 1, -1 to 1
  kClear,      // to infinity, to 1
  kTest,       // LESS, LEQUAL
  kNear,       // W: any, above 1/64
  kFacing,     // culled always: none, back, front
  kSlivers,    // turned ones: drawn, left out, all small ones left out
  kBorder,     // triangles are cut: nowhere, a pixel beyond the target's borders, 40 pixels beyond
  kNumberOfChoices
};
inline constexpr std::array<int, kNumberOfChoices> kChoices{3, 4, 4, 2, 6, 8, 2, 3, 4, 4, 2, 2, 2, 2, 3, 3, 3};
using Choices = std::array<int, kNumberOfChoices>;

// So many of them that each pair of choices is in one; "right-17" is the 17th.
const std::vector<Choices>& right_rasterizers();
std::string right_name(std::size_t number);
std::string right_text(const Choices& choices);  // the choices in words

// Whether it clips depth where a draw asks (SUREFILL_ADAPTER_DEPTH_CLIP).
inline bool clips_where_asked(const Choices& choices) {
  return choices[kClip] == 3;
}

// Pixels beyond the target's borders from which on triangles are cut. With a viewport of another size only far away: the border
// then is at another place, too.
inline double cuts_beyond(const Choices& choices) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  return choices[kBorder] == 0 ? kNowhere : choices[kBorder] == 1 && choices[kViewport] != 1 ? 1 : 40;
}

// The scene is plain (adapter.h), but for depth clipping. False: not for this one.
bool draw_right(const Choices& choices, const surefill_adapter_scene& scene, const surefill_adapter_image& image);

}  // namespace surefill::zoo

#endif  // SUREFILL_MUTATION_ZOO_RIGHT_HPP
