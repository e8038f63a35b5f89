// SPDX-License-Identifier: Apache-2.0
#ifndef SUREFILL_SRC_STATISTICS_HPP
#define SUREFILL_SRC_STATISTICS_HPP

#include <span>

#include "surefill/surefill.hpp"

namespace surefill {

// M11: of draws that validate() has accepted, with the floating-point state already set. No path has a part in it.
Statistics statistics_of(std::span<const Draw> draws) noexcept;

}  // namespace surefill

#endif  // SUREFILL_SRC_STATISTICS_HPP
