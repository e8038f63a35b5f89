// SPDX-License-Identifier: Apache-2.0
//
// The table of turns: on each axis and side, at samples near and far, where does an edge stop covering the sample? It
// shows at a glance a shift of half a pixel, floor, a viewport that is too small, both sides owning an edge, blur.
#ifndef SUREFILL_CERTIFY_JUDGE_TURNS_HPP
#define SUREFILL_CERTIFY_JUDGE_TURNS_HPP

#include <string>
#include <vector>

#include "certify/judge/probes.hpp"

namespace surefill::judge {

// One edge, upright (axis 0) or level (axis 1), that is moved past the sample of one pixel: a near edge is the left or
// upper one of its triangle, a far one the right or lower one.
struct Turn {
  int axis = 0;
  bool far = false;
  int pixel = 0;                     // along the axis
  bool found = false;                // it covers the sample at one end of the way and not at the other
  float covered = 0, uncovered = 0;  // the edge's positions on both sides of the turn, neighbours if the step is 0
  double spread = 0;                 // answers beyond the turn that contradict it lie up to so many pixels from it

  // Where it turns, from the pixel's centre.
  double at() const { return (static_cast<double>(covered) + uncovered) / 2 - pixel - 0.5; }
};

inline constexpr int kTurnLength = 16;  // of the target, along the axis

// All vertices lie on the target, and no triangle is of the facing that is `culled`. Throws Failure, Declined.
std::vector<Turn> measure_turns(Rival& rival, Cull culled);

// The same at all pixels that the table leaves out, on one axis.
std::vector<Turn> measure_more_turns(Rival& rival, Cull culled, int axis);

// A line for each axis and side, for people.
std::string turns_text(const std::vector<Turn>& turns);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_TURNS_HPP
