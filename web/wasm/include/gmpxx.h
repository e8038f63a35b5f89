// SPDX-License-Identifier: Apache-2.0
//
// As much of GMP's C++ interface as section 11's part of the oracle uses, over Boost's integers: GMP itself is not there for
// WebAssembly.
#ifndef SUREFILL_WEB_GMPXX_H
#define SUREFILL_WEB_GMPXX_H

#include <boost/multiprecision/cpp_int.hpp>
#include <compare>

using mpz_class =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

class mpq_class {
 public:
  using Value =
      boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

  mpq_class() = default;
  mpq_class(int value) : value_(value) {}
  mpq_class(long value) : value_(value) {}
  mpq_class(double value) : value_(value) {}
  mpq_class(const mpz_class& value) : value_(value) {}
  mpq_class(int numerator, int denominator) : value_(numerator, denominator) {}
  explicit mpq_class(const Value& value) : value_(value) {}

  void canonicalize() {}  // it always is
  double get_d() const { return value_.convert_to<double>(); }
  const Value& value() const { return value_; }
  mpz_class get_num() const { return boost::multiprecision::numerator(value_); }
  mpz_class get_den() const { return boost::multiprecision::denominator(value_); }

  mpq_class& operator+=(const mpq_class& b) { return value_ += b.value_, *this; }
  mpq_class& operator-=(const mpq_class& b) { return value_ -= b.value_, *this; }
  mpq_class& operator*=(const mpq_class& b) { return value_ *= b.value_, *this; }
  mpq_class& operator/=(const mpq_class& b) { return value_ /= b.value_, *this; }
  friend mpq_class operator+(mpq_class a, const mpq_class& b) { return a += b; }
  friend mpq_class operator-(mpq_class a, const mpq_class& b) { return a -= b; }
  friend mpq_class operator*(mpq_class a, const mpq_class& b) { return a *= b; }
  friend mpq_class operator/(mpq_class a, const mpq_class& b) { return a /= b; }
  friend mpq_class operator-(const mpq_class& a) { return mpq_class(Value(-a.value_)); }
  friend bool operator==(const mpq_class& a, const mpq_class& b) { return a.value_ == b.value_; }
  friend auto operator<=>(const mpq_class& a, const mpq_class& b) { return a.value_.compare(b.value_) <=> 0; }
  friend int cmp(const mpq_class& a, const mpq_class& b) { return a.value_.compare(b.value_); }
  friend int sgn(const mpq_class& a) { return a.value_.sign(); }
  friend mpq_class abs(const mpq_class& a) { return sgn(a) < 0 ? -a : a; }

 private:
  Value value_;
};

#endif  // SUREFILL_WEB_GMPXX_H
