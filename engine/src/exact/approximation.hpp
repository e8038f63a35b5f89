// SPDX-License-Identifier: Apache-2.0
//
// Doubles with a bound of their error, and the float32 that is stored of a quotient (I4): by such bounds if they can tell,
// else by exact arithmetic.
#ifndef SUREFILL_SRC_APPROXIMATION_HPP
#define SUREFILL_SRC_APPROXIMATION_HPP

#include <cmath>
#include <limits>

#include "edge.hpp"
#include "exact.hpp"

namespace surefill {

// A double and a bound of its distance from the real number it stands for.
struct Approximation {
  double value, error;
};

// n / m. For real N, M: N/M - n/m = ((N - n) - (n/m)(M - m)) / M. Infinite error where M may be 0. The factor covers
// the rounding of the bound.
inline Approximation quotient(Approximation n, Approximation m) {
  const double smallest = std::fabs(m.value) - m.error;
  if (!(smallest > 0)) return {0, std::numeric_limits<double>::infinity()};
  const double q = n.value / m.value;
  return {q, ((n.error + std::fabs(q) * m.error) / smallest + std::fabs(q) * 0x1p-52) * (1 + 0x1p-20)};
}

// The float32 of I4: by the filter if it can tell, else by `exact`.
template <typename Exact>
float rounded(Approximation q, Exact exact, Rungs* rungs = nullptr) {
  float result;
  if (round_interval(q.value - q.error, q.value + q.error, &result)) {
    count(rungs, &Rungs::values_by_filter);
    return result;
  }
  count(rungs, &Rungs::values_by_expansion);
  return exact();
}

// A float32 as I4 stores it: -0 becomes +0.
inline float stored(float value) {
  return value + 0.0f;
}

}  // namespace surefill

#endif  // SUREFILL_SRC_APPROXIMATION_HPP
