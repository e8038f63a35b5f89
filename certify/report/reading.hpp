// SPDX-License-Identifier: Apache-2.0
//
// Reads texts of a known form again: Reading(" at pixel (3, 4)").text(" at pixel (").number(x).text(", ").number(y).
#ifndef SUREFILL_CERTIFY_REPORT_READING_HPP
#define SUREFILL_CERTIFY_REPORT_READING_HPP

#include <charconv>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "corpus/float_text.hpp"

namespace surefill::certify {

class Reading {
 public:
  explicit Reading(std::string_view rest) : rest_(rest) {}

  Reading& text(std::string_view expected) {
    fits_ = fits_ && rest_.starts_with(expected);
    if (fits_) rest_.remove_prefix(expected.size());
    return *this;
  }

  // What does not fit leaves `value` as it is.
  template <typename Number>
  Reading& number(Number& value) {
    if (!fits_) return *this;
    const char *begin = rest_.data(), *end = begin + rest_.size();
    std::from_chars_result read{};
    if constexpr (std::is_floating_point_v<Number>) {
      if (rest_.starts_with('+')) ++begin;
      read = corpus::float_from_chars(begin, end, value);
    } else {
      read = std::from_chars(begin, end, value);
    }
    fits_ = read.ec == std::errc{};
    if (fits_) rest_.remove_prefix(static_cast<std::size_t>(read.ptr - rest_.data()));
    return *this;
  }

  bool fits() const { return fits_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  bool fits_ = true;
};

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_READING_HPP
