// SPDX-License-Identifier: Apache-2.0
//
// Values that differ, on the page of a certificate: as numbers at their pixels, at the scale of their difference, and as a
// heat picture where there are more than have room.
#ifndef SUREFILL_CERTIFY_REPORT_VALUES_HPP
#define SUREFILL_CERTIFY_REPORT_VALUES_HPP

#include <string>

#include "certify/report/report_pictures.hpp"

namespace surefill::certify {

// "0x1.8p-1 (0.75)" as people read it, or a range of such.
std::string readable(const std::string& value);

// Two numbers with as many digits as it takes to tell them apart; what is no number, or a range, as it is.
struct Pair {
  std::string expected, actual;
};
Pair told_apart(const std::string& expected, const std::string& actual);

// Everything about the evidence's values, in HTML; empty if there are none.
std::string values_html(const Evidence& evidence, const View& view);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_VALUES_HPP
