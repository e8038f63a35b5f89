// SPDX-License-Identifier: Apache-2.0
//
// What values a triangle has around a sample (R11).
#ifndef SUREFILL_CERTIFY_JUDGE_PLANE_HPP
#define SUREFILL_CERTIFY_JUDGE_PLANE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "oracle/edges.hpp"
#include "surefill/surefill.hpp"

namespace surefill::judge {

using oracle::Edges;
using oracle::kRoundings;

struct Range {
  double low, high;
};

// The value (sum above_i E_i) / (sum below_i E_i) at the sample, and so far from it each way, x and y; and there with each E_i
// of the wrong sign counted as 0, as G2 has it of a sample that is covered beside the triangle.
struct Values {
  Range range;
  double value;
};
inline Values values_around(const Edges& edges, const std::array<double, 3>& above, const std::array<double, 3>& below,
                            double x, double y, const std::array<double, 2>& distance) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Values result{{kInfinity, -kInfinity}, 0};
  long double sign = 0;
  for (const double dx : {-distance[0], 0.0, distance[0]}) {
    for (const double dy : {-distance[1], 0.0, distance[1]}) {
      long double numerator = 0, denominator = 0, above_inside = 0, below_inside = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const long double e = edges.at(i, x + dx, y + dy);
        numerator += above[i] * e;
        denominator += below[i] * e;
        if ((e > 0) != (edges.d > 0)) continue;
        above_inside += above[i] * e;
        below_inside += below[i] * e;
      }
      // A pole between the places: nothing is granted, since anything is.
      if (denominator == 0 || sign * denominator < 0) return {{-kInfinity, kInfinity}, 0};
      sign = denominator;
      const auto value = static_cast<double>(numerator / denominator);
      if (dx == 0 && dy == 0) result.value = value;
      result.range.low = std::min(result.range.low, value);
      result.range.high = std::max(result.range.high, value);
      if (below_inside == 0) continue;
      const auto inside = static_cast<double>(above_inside / below_inside);
      result.range.low = std::min(result.range.low, inside);
      result.range.high = std::max(result.range.high, inside);
    }
  }
  return result;
}

// The largest sum of what is added up for a value, signs aside, at the sample and so far from it: beside a triangle a value
// is a difference of large numbers, and rounded as such.
inline double terms_around(const Edges& edges, const std::array<double, 3>& above, const std::array<double, 3>& below,
                           double x, double y, const std::array<double, 2>& distance) {
  double largest = 0;
  for (const double dx : {-distance[0], 0.0, distance[0]}) {
    for (const double dy : {-distance[1], 0.0, distance[1]}) {
      long double sum = 0, denominator = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const long double e = edges.at(i, x + dx, y + dy);
        sum += std::abs(above[i] * e);
        denominator += below[i] * e;
      }
      if (denominator != 0) largest = std::max(largest, static_cast<double>(sum / std::abs(denominator)));
    }
  }
  return largest;
}

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_PLANE_HPP
