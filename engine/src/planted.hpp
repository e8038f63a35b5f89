// SPDX-License-Identifier: Apache-2.0
//
// Faults planted on purpose, to measure how soon the fuzzers find each (mutation/time_to_find.py). They exist only in a
// build with SUREFILL_PLANTED, where SUREFILL_PLANT=NAME in the environment wakes one. Without it every
// SUREFILL_PLANT(name) is the constant false, and the compiler leaves nothing of it.
#ifndef SUREFILL_SRC_PLANTED_HPP
#define SUREFILL_SRC_PLANTED_HPP

#if defined(SUREFILL_PLANTED)

#include <cstdlib>
#include <string_view>

namespace surefill {

inline bool is_planted(std::string_view name) {
  static const std::string_view active = [] {
    const char* const text = std::getenv("SUREFILL_PLANT");
    return std::string_view(text != nullptr ? text : "");
  }();
  return name == active;
}

}  // namespace surefill

#define SUREFILL_PLANT(name)                                   \
  ([] {                                                        \
    static const bool planted = ::surefill::is_planted(#name); \
    return planted;                                            \
  }())

#else

#define SUREFILL_PLANT(name) false

#endif

#endif  // SUREFILL_SRC_PLANTED_HPP
