// SPDX-License-Identifier: Apache-2.0
//
// std::from_chars of floats, also for standard libraries that have none (libc++ before version 20). There the
// C library reads them, which the program has left in the locale "C".
#ifndef SUREFILL_CORPUS_FLOAT_TEXT_HPP
#define SUREFILL_CORPUS_FLOAT_TEXT_HPP

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace surefill::corpus {

#if defined(__cpp_lib_to_chars)

template <typename Float>
std::from_chars_result float_from_chars(const char* begin, const char* end, Float& value,
                                        std::chars_format format = std::chars_format::general) {
  return std::from_chars(begin, end, value, format);
}

#else

template <typename Float>
std::from_chars_result float_from_chars(const char* begin, const char* end, Float& value,
                                        std::chars_format format = std::chars_format::general) {
  const bool hex = format == std::chars_format::hex;
  std::string_view digits(begin, static_cast<std::size_t>(end - begin));
  digits = digits.substr(0, digits.find_first_not_of(hex ? "0123456789abcdefABCDEF.pP+-" : "0123456789.eE+-"));
  if (digits.empty() || digits[0] == '+') return {begin, std::errc::invalid_argument};
  const std::string text = (hex ? "0x" : "") + std::string(digits);
  char* last = nullptr;
  Float result = 0;
  if constexpr (std::is_same_v<Float, float>) {
    result = std::strtof(text.c_str(), &last);
  } else {
    result = std::strtod(text.c_str(), &last);
  }
  const auto length = last - text.c_str() - (hex ? 2 : 0);
  if (length <= 0) return {begin, std::errc::invalid_argument};
  digits = digits.substr(0, static_cast<std::size_t>(length));
  const std::string_view significand = digits.substr(0, digits.find_first_of(hex ? "pP" : "eE"));
  const bool is_zero = significand.find_first_not_of("-0.") == significand.npos;
  if (std::isinf(result) || (result == 0 && !is_zero)) return {begin + length, std::errc::result_out_of_range};
  value = result;
  return {begin + length, std::errc{}};
}

#endif

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_FLOAT_TEXT_HPP
