// SPDX-License-Identifier: Apache-2.0
//
// Exact numbers of the first oracle: GMP integers, ratios of them, and the one place where a real number is rounded.
#ifndef SUREFILL_ORACLE_EXACT_HPP
#define SUREFILL_ORACLE_EXACT_HPP

#include <gmpxx.h>

#include <cfenv>
#include <span>

namespace surefill::oracle {

using Integer = mpz_class;

// Round to nearest, with subnormals: CGAL and the conversions from float rely on it. Restores the caller's mode.
class StandardFloats {
 public:
  StandardFloats() {
    std::fegetenv(&caller_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~StandardFloats() { std::fesetenv(&caller_); }
  StandardFloats(const StandardFloats&) = delete;
  StandardFloats& operator=(const StandardFloats&) = delete;

 private:
  std::fenv_t caller_{};
};

// The real number n / d. d > 0.
struct Ratio {
  Integer n = 0, d = 1;
};

// Is a < b? Both denominators are positive.
bool less(const Ratio& a, const Ratio& b);

// A finite float is m 2^e with integers m, e. The smallest such e with m odd; 0 for a zero.
int odd_exponent(float value);

// The smallest odd_exponent of the nonzero values, and 0 if there are none: the scale at which all are integers.
int common_exponent(std::span<const float> values);

// value 2^-exponent, exactly. Precondition: exponent <= odd_exponent(value), or value is 0.
Integer scaled_integer(float value, int exponent);

// I4: the finite float32 nearest to n / d, ties to even, subnormals kept; beyond range the largest finite value of that
// sign; what rounds to zero is +0. Precondition: d > 0.
float nearest_finite(const Integer& n, const Integer& d);

// S3: n / d rounded as IEEE 754 does it: beyond range an infinity; 0 is +0, and what rounds to zero without being zero
// is a zero of its sign. Precondition: d > 0.
float nearest_ieee(const Integer& n, const Integer& d);

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_EXACT_HPP
