// SPDX-License-Identifier: Apache-2.0
//
// Exact arithmetic on doubles: sums and products that keep their rounding error, expansions (sums of doubles that do
// not overlap), and the one rounding from an exact quotient to float32. Source: J. R. Shewchuk, Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.
//
// Holds in round-to-nearest with subnormals and without contraction to FMA (B4; the build sets -ffp-contract=off).
// Range: all numbers here are sums of products of at most six float32 values or float32 midpoints and three sample
// coordinates: multiples of 2^-910 below 2^850, so nothing overflows, and no error term underflows.
#ifndef SUREFILL_SRC_EXACT_HPP
#define SUREFILL_SRC_EXACT_HPP

#include <cmath>
#include <cstddef>
#include <limits>

#include "../build_check.hpp"

namespace surefill {

struct DoublePair {
  double value, error;  // value + error is exact; value is value + error rounded to nearest
};

// a + b (Knuth; Shewchuk theorem 7).
inline DoublePair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_virtual = sum - a;
  const double a_virtual = sum - b_virtual;
  return {sum, (a - a_virtual) + (b - b_virtual)};
}

// a * b (Dekker, Veltkamp; Shewchuk theorems 17 and 18).
inline DoublePair two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double product = a * b;
  const double a_big = kSplitter * a, a_high = a_big - (a_big - a), a_low = a - a_high;
  const double b_big = kSplitter * b, b_high = b_big - (b_big - b), b_low = b - b_high;
  const double error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
  return {product, error};
}

// A real number as a sum of at most kCapacity doubles, smallest first, nonadjacent (Shewchuk theorem 10: growing by one
// double at a time keeps them so under ties to even). No term is 0, so the number is 0 exactly if there are no terms.
template <std::size_t kCapacity>
class Expansion {
 public:
  Expansion() = default;
  // The same number with room for more terms.
  template <std::size_t kOther>
  explicit Expansion(const Expansion<kOther>& other) : size_(other.size()) {
    static_assert(kOther <= kCapacity);
    for (int i = 0; i < size_; ++i) term_[i] = other.term(i);
  }

  // Adds one double. At most one term more.
  void add(double b) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const DoublePair sum = two_sum(b, term_[i]);
      if (sum.error != 0) term_[kept++] = sum.error;
      b = sum.value;
    }
    if (b != 0) term_[kept++] = b;
    size_ = kept;
  }

  // Adds a * b. At most two terms more.
  void add_product(double a, double b) {
    const DoublePair product = two_product(a, b);
    if (product.error != 0) add(product.error);
    add(product.value);
  }

  // Adds other * factor. At most twice as many terms more as `other` has.
  template <std::size_t kOther>
  void add_scaled(const Expansion<kOther>& other, double factor) {
    for (int i = 0; i < other.size(); ++i) add_product(other.term(i), factor);
  }

  // Adds a * b: at most twice as many terms more as the product of their numbers.
  template <std::size_t kA, std::size_t kB>
  void add_product_of(const Expansion<kA>& a, const Expansion<kB>& b) {
    for (int i = 0; i < b.size(); ++i) add_scaled(a, b.term(i));
  }

  // Changes the sign.
  void negate() {
    for (int i = 0; i < size_; ++i) term_[i] = -term_[i];
  }

  int sign() const { return size_ == 0 ? 0 : term_[size_ - 1] > 0 ? 1 : -1; }

  // The number, to a relative error below 2^-50: the terms are nonadjacent, so the largest is at least half of the sum.
  double estimate() const {
    double sum = 0;
    for (int i = 0; i < size_; ++i) sum += term_[i];
    return sum;
  }

  int size() const { return size_; }
  double term(int i) const { return term_[i]; }

 private:
  double term_[kCapacity];
  int size_ = 0;
};

// The float32 nearest to a real number that is known to lie between two neighbours low < high; `sign_at(m)` is the
// exact sign of number - m. An infinite neighbour stands for 2^128.
template <typename SignAtMidpoint>
float nearest_of_neighbours(float low, float high, SignAtMidpoint sign_at) {
  const double beyond = 0x1p128;
  const double low_value = std::isinf(low) ? -beyond : static_cast<double>(low);
  const double high_value = std::isinf(high) ? beyond : static_cast<double>(high);
  const double midpoint = low_value + (high_value - low_value) / 2;  // exact: 25 bits
  const int above = sign_at(midpoint);
  if (above != 0) return above > 0 ? high : low;
  return static_cast<float>(midpoint);  // ties to even, by the conversion itself
}

constexpr double kLargestFloat = std::numeric_limits<float>::max();

// Rounds as I4 says, if the interval [low, high] around the real number is narrow enough to tell: true, and `*rounded`
// is the finite float32 nearest to every number of the interval. An interval with a NaN tells nothing.
inline bool round_interval(double low, double high, float* rounded) {
  low = low < -kLargestFloat ? -kLargestFloat : low > kLargestFloat ? kLargestFloat : low;
  high = high < -kLargestFloat ? -kLargestFloat : high > kLargestFloat ? kLargestFloat : high;
  const float from_low = static_cast<float>(low);
  if (!(from_low == static_cast<float>(high))) return false;
  *rounded = from_low + 0.0f;  // -0 becomes +0
  return true;
}

// The float32 nearest to numerator / denominator as I4 says; denominator is not 0.
template <std::size_t kNumerator, std::size_t kDenominator>
float round_quotient(const Expansion<kNumerator>& numerator, const Expansion<kDenominator>& denominator) {
  const double quotient = numerator.estimate() / denominator.estimate();  // relative error below 2^-48
  const double error = std::fabs(quotient) * 0x1p-48;
  float rounded;
  if (round_interval(quotient - error, quotient + error, &rounded)) return rounded;
  // The interval is far narrower than the distance of floats: there is one midpoint in it, between these neighbours.
  const float low = static_cast<float>(quotient - error), high = static_cast<float>(quotient + error);
  const float nearest = nearest_of_neighbours(low, high, [&](double midpoint) {
    Expansion<kNumerator + 2 * kDenominator> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    rest.add_scaled(denominator, -midpoint);
    return rest.sign() * denominator.sign();
  });
  return nearest + 0.0f;
}

// The least float32 not below numerator / denominator; +0 for 0, +infinity beyond range. The denominator is not 0.
template <std::size_t kNumerator, std::size_t kDenominator>
float round_up_quotient(const Expansion<kNumerator>& numerator, const Expansion<kDenominator>& denominator) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Is the quotient above a float?
  const auto above = [&](float value) {
    if (std::isinf(value)) return value < 0;
    Expansion<kNumerator + 2 * kDenominator> rest;
    for (int i = 0; i < numerator.size(); ++i) rest.add(numerator.term(i));
    rest.add_scaled(denominator, -static_cast<double>(value));
    return rest.sign() * denominator.sign() > 0;
  };
  float rounded = static_cast<float>(numerator.estimate() / denominator.estimate());  // a neighbour at most off
  while (above(rounded)) rounded = std::nextafter(rounded, kInfinity);
  for (;;) {
    const float below = std::nextafter(rounded, -kInfinity);
    if (above(below)) return rounded + 0.0f;
    rounded = below;
  }
}

}  // namespace surefill

#endif  // SUREFILL_SRC_EXACT_HPP
