// SPDX-License-Identifier: Apache-2.0
#include "build_check.hpp"

#include "float_environment.hpp"

namespace surefill {
namespace {

// The forms that compilers contract or reorder. Not inlined: it needs the engine's floating-point state.
template <typename T>
[[gnu::noinline]] bool holds() {
  ContractionProbe<T> p;
  const T x0 = p.x, x1 = p.x, x2 = p.x, x3 = p.x, square = p.square, one = p.one, small = p.small;
  const T subtracted = x0 * x0 - square;  // all are 0 as they are written
  const T negated = square - x1 * x1;
  const T added = x2 * x2 + -square;
  const T of_products = x3 * x3 - one * square;
  const T reordered = (one + small) - one;
  return subtracted == 0 && negated == 0 && added == 0 && of_products == 0 && reordered == 0;
}

}  // namespace

bool is_exact_build() {
  static const bool exact = [] {
    const FloatEnvironment environment;
    return holds<float>() && holds<double>();
  }();
  return exact;
}

}  // namespace surefill
