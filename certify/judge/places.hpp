// SPDX-License-Identifier: Apache-2.0
//
// Where the sample is in its pixel: slanted edges that pass close to it, each of which leaves one side of a line.
#ifndef SUREFILL_CERTIFY_JUDGE_PLACES_HPP
#define SUREFILL_CERTIFY_JUDGE_PLACES_HPP

#include <vector>

#include "certify/judge/axes.hpp"

namespace surefill::judge {

// A triangle that was drawn alone, with what came of it.
struct Probe {
  corpus::Scene scene;
  corpus::Image image;
};

// A convex region of places.
struct Region {
  std::vector<std::array<double, 2>> corners;

  bool empty() const { return corners.empty(); }
  double low(std::size_t axis) const;
  double high(std::size_t axis) const;
  // What is left of it where a x + b y + c >= 0.
  void clip(double a, double b, double c);
};

// Narrows the rectangle of both fits down. All vertices are on the target, above 1, each in the middle of what goes where
// it goes; the probes are added to `probes`. Where edges are not kept exactly the blur of both fits grows until they
// agree. Empty, if they don't. Throws Failure, Declined.
Region find_places(Rival& rival, Cull culled, AxisFit& x, AxisFit& y, std::vector<Probe>& probes);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_PLACES_HPP
