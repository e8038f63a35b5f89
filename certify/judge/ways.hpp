// SPDX-License-Identifier: Apache-2.0
//
// How values at samples come of those at the corners of their triangle: the ways that are known.
#ifndef SUREFILL_CERTIFY_JUDGE_WAYS_HPP
#define SUREFILL_CERTIFY_JUDGE_WAYS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace surefill::judge {

using Three = std::array<double, 3>;

// A triangle and a place in it: the weights of its corners there, on the screen.
struct At {
  std::array<std::array<double, 2>, 3> corners{};
  Three w{}, z{};  // z is Z/W
  double x = 0, y = 0;

  Three weights(double dx = 0, double dy = 0) const {
    Three e{};
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &p = corners[(i + 1) % 3], &q = corners[(i + 2) % 3];
      e[i] = (q[0] - p[0]) * (y + dy - p[1]) - (q[1] - p[1]) * (x + dx - p[0]);
      sum += e[i];
    }
    return {e[0] / sum, e[1] / sum, e[2] / sum};
  }
};

inline Three divided(const At& at, Three l) {
  const double sum = l[0] / at.w[0] + l[1] / at.w[1] + l[2] / at.w[2];
  return {l[0] / at.w[0] / sum, l[1] / at.w[1] / sum, l[2] / at.w[2] / sum};
}

enum Kind : std::size_t { kScreen, kPerspective, kFlat };

// One value at one sample.
struct Seen {
  At at;
  Three values{};  // at the corners
  double got = 0;
  double first_x = 0, last_x = 0;  // where the row begins and ends, as far as it is covered
};

inline bool close(double a, double b, double size) {
  return std::abs(a - b) <= 0x1p-9 * std::max(1.0, size);
}

inline double mixed(const Three& weights, const Three& values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

// Is what came everywhere what `of` makes of it? Rounding may put a few beside what is about the value.
bool all_come(const std::vector<Seen>& seen, double (*of)(const void* context, const Seen& s), const void* context);

template <typename Of>
bool all_are(const std::vector<Seen>& seen, const Of& of) {
  return all_come(
      seen,
      [](const void* context, const Seen& s) { return static_cast<double>((*static_cast<const Of*>(context))(s)); },
      &of);
}

inline Three right_weights(const At& at, Kind kind) {
  return kind == kScreen ? at.weights() : kind == kPerspective ? divided(at, at.weights()) : Three{1, 0, 0};
}

// How all of them come about; empty if it is right, "?" if it is not and nobody knows. With "in back faces alone" and the like.
std::string way_of(const std::vector<Seen>& seen, Kind kind);
// Without it.
std::string way_of_all(const std::vector<Seen>& seen, Kind kind);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_WAYS_HPP
