// SPDX-License-Identifier: Apache-2.0
//
// What probing is made of: random numbers that are the same everywhere, R5 in double, and edges that are moved past a
// sample until it is known to the last bit where they stop covering it.
#ifndef SUREFILL_CERTIFY_JUDGE_PROBES_HPP
#define SUREFILL_CERTIFY_JUDGE_PROBES_HPP

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "certify/judge/rival.hpp"

namespace surefill::judge {

// splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  double unit() { return std::ldexp(static_cast<double>(bits() >> 11), -53); }

 private:
  std::uint64_t state_;
};

// A scene of one draw, W = 1, at depth z.
struct Point {
  float x, y;
};
using FlatTriangle = std::array<Point, 3>;
corpus::Scene flat_scene(int width, int height, const std::vector<FlatTriangle>& triangles, float z = 0.5f);

// Is the sample of element s covered, by whichever output there is?
bool is_covered(const corpus::Image& image, std::size_t s);

// The outputs that say what is covered.
corpus::Outputs covering(const Rival& rival);

// The nearest position that the rival can be given: Rival::position_step.
float on_step(double value, double step);

// The triangle, turned over if it is of the facing that is culled.
FlatTriangle seen(FlatTriangle triangle, Cull culled);

// The triangle with x for y.
FlatTriangle transposed(FlatTriangle triangle);

// R5: where a position q comes to lie.
double snapped(double position, const oracle::AxisModel& axis);

// R3 and R5: where a vertex at this distance comes to lie on a target of so many pixels.
inline double placed(double source, const oracle::AxisModel& axis, int length) {
  return snapped(source * (length - axis.lacks) / length + axis.moved, axis);
}

// A triangle that depends on one number, and a pixel. From one end of the way to the other, a right rasterizer goes from
// covering its sample to not covering it, once.
struct Slider {
  std::function<FlatTriangle(float)> triangle;
  int x = 0, y = 0;
  double covered_end = 0, uncovered_end = 0;

  bool found = false;                // it does so
  float covered = 0, uncovered = 0;  // neighbours, if the step is 0
  double spread = 0;                 // of answers elsewhere that contradict this
};

// All at once, each in a part of the target of its own. Throws Failure, Declined.
void slide(Rival& rival, int width, int height, Cull culled, std::vector<Slider>& sliders);

// The same answers once more, before and behind the turn: into `spread`.
void slide_again(Rival& rival, int width, int height, Cull culled, std::vector<Slider>& sliders);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_PROBES_HPP
