// SPDX-License-Identifier: Apache-2.0
#include "oracle/exact.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace surefill::oracle {

namespace {

constexpr int kPrecision = std::numeric_limits<float>::digits;               // 24 bits
constexpr long kMaxExponent = std::numeric_limits<float>::max_exponent - 1;  // 2^127 is a float, 2^128 is not
constexpr long kUnitExponent =
    std::numeric_limits<float>::min_exponent - kPrecision;  // subnormals: multiples of 2^-149

void shift_left(Integer& out, const Integer& value, long bits) {
  mpz_mul_2exp(out.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
}

// |n / d| rounded to a multiple of the float32 unit at its size, ties to even; infinity if that is 2^128 or more.
float nearest_magnitude(const Integer& n, const Integer& d) {
  thread_local Integer numerator, denominator, quotient, remainder;  // kept, so that they allocate once
  if (n == 0) return 0;
  // The exponent e of |n / d|: 2^e <= |n / d| < 2^(e + 1).
  long e = static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2)) - static_cast<long>(mpz_sizeinbase(d.get_mpz_t(), 2));
  shift_left(numerator, n, e < 0 ? -e : 0);
  shift_left(denominator, d, e > 0 ? e : 0);
  if (mpz_cmpabs(numerator.get_mpz_t(), denominator.get_mpz_t()) < 0) --e;
  if (e > kMaxExponent) return std::numeric_limits<float>::infinity();

  // |n / d| = (quotient + remainder / denominator) 2^unit, with a quotient below 2^24.
  const long unit = std::max(e - (kPrecision - 1), kUnitExponent);
  shift_left(numerator, n, unit < 0 ? -unit : 0);
  shift_left(denominator, d, unit > 0 ? unit : 0);
  mpz_abs(numerator.get_mpz_t(), numerator.get_mpz_t());
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  std::uint32_t q = static_cast<std::uint32_t>(mpz_get_ui(quotient.get_mpz_t()));
  shift_left(remainder, remainder, 1);
  const int half = mpz_cmp(remainder.get_mpz_t(), denominator.get_mpz_t());
  if (half > 0 || (half == 0 && q % 2 == 1)) ++q;
  return std::ldexp(static_cast<float>(q), static_cast<int>(unit));  // exact; 2^24 2^104 is infinity
}

}  // namespace

bool less(const Ratio& a, const Ratio& b) {
  return a.n * b.d < b.n * a.d;
}

int odd_exponent(float value) {
  if (value == 0) return 0;
  int exponent = 0;
  const float fraction = std::frexp(value, &exponent);
  std::int32_t mantissa = static_cast<std::int32_t>(std::ldexp(fraction, kPrecision));
  exponent -= kPrecision;
  for (; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  return exponent;
}

int common_exponent(std::span<const float> values) {
  bool found = false;
  int smallest = 0;
  for (const float value : values) {
    if (value == 0) continue;
    const int exponent = odd_exponent(value);
    if (!found || exponent < smallest) smallest = exponent;
    found = true;
  }
  return smallest;
}

Integer scaled_integer(float value, int exponent) {
  if (value == 0) return 0;
  const int own = odd_exponent(value);
  Integer result = static_cast<std::int32_t>(std::ldexp(static_cast<double>(value), -own));
  shift_left(result, result, own - exponent);
  return result;
}

float nearest_finite(const Integer& n, const Integer& d) {
  const float magnitude = std::min(nearest_magnitude(n, d), std::numeric_limits<float>::max());
  return n < 0 && magnitude != 0 ? -magnitude : magnitude;
}

float nearest_ieee(const Integer& n, const Integer& d) {
  const float magnitude = nearest_magnitude(n, d);
  return n < 0 ? -magnitude : magnitude;
}

}  // namespace surefill::oracle
