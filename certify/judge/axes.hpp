// SPDX-License-Identifier: Apache-2.0
//
// What one axis does to positions, found without knowing the other: how large the viewport is, on which grid positions
// come to lie, how well that is kept.
#ifndef SUREFILL_CERTIFY_JUDGE_AXES_HPP
#define SUREFILL_CERTIFY_JUDGE_AXES_HPP

#include <optional>
#include <string>
#include <vector>

#include "certify/judge/turns.hpp"

namespace surefill::judge {

// A position exactly between two steps of the grid, and where it goes.
struct Tie {
  double at = 0;
  bool up = false;
};

// An axis as its turns and its steps show it. All positions are those after R3's viewport, t being 0. With a grid the
// *middle* of a position is that of all positions that go where it goes: what they are in truth moves with the sample,
// and nobody can see it.
struct AxisFit {
  std::string why;  // it could not be found out; else empty
  double lacks = 0;
  double blur = 0;
  int bits = -1;              // of the grid; -1: none
  double boundary = 0;        // of the grid: positions part at boundary + k 2^-bits
  double low = 0, high = 0;   // the sample's place lies here, in terms of middles
  std::vector<Tie> ties;      // where blur is 0
  std::vector<Slider> steps;  // of which it was found, their moving end being the first corner

  // The middle of all positions that go where this one goes.
  double middle(double position) const;
};

// From the turns of this axis. An edge with one end fixed stops covering a sample where the other end takes a step of
// the grid: if all such places lie on a lattice, that is the grid. `other` is what is known of the other axis.
AxisFit fit_axis(Rival& rival, Cull culled, int axis, const std::vector<Turn>& turns, const std::vector<Turn>& others,
                 bool* offscreen);

// One way to say it in R5's words, with where the sample is in these terms: its place is in [fit.low, fit.high] +
// shift. `oddity` is how far from what is usual.
struct Reading {
  oracle::AxisModel axis;
  double shift = 0;
  int oddity = 0;
};

// All of them: they are alike wherever positions are above 1, and differ in which way negative ones go, if in anything.
std::vector<Reading> readings_of(const AxisFit& fit);

// The usual place in [low, high], if there is one: 1/2, 0, 1, quarters, sixteenths; and how usual it is.
std::optional<double> usual_place(double low, double high, int* oddity);

// By how many pixels the edges of `fit.steps` turn elsewhere than exact positions would have them turn, the sample being
// at this place, in terms of middles: an axis without a grid shows in this how it rounds.
double rounding_of(const AxisFit& fit, const AxisFit& other, int axis, double place, double other_place);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_AXES_HPP
