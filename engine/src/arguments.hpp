// SPDX-License-Identifier: Apache-2.0
#ifndef SUREFILL_SRC_ARGUMENTS_HPP
#define SUREFILL_SRC_ARGUMENTS_HPP

#include <span>

#include "surefill/surefill.hpp"

namespace surefill {

// As validate, for a call that has options and may have statistics (else null): B2.
Status check_call(const Target& target, std::span<const Draw> draws, const Statistics* statistics,
                  const Options& options) noexcept;

}  // namespace surefill

#endif  // SUREFILL_SRC_ARGUMENTS_HPP
