// SPDX-License-Identifier: Apache-2.0
//
// The scalar reference path: plain portable C++, one triangle and one sample at a time. It is what the fast path is
// held to.
#ifndef SUREFILL_SRC_REFERENCE_HPP
#define SUREFILL_SRC_REFERENCE_HPP

#include <span>

#include "fragments.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::reference {

// As surefill::render, for arguments that validate() has accepted, with the floating-point state already set. Returns
// ok or out_of_memory.
Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept;

// The fragments of one draw, onto what the draws before it have left.
void draw(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs) noexcept;

// As surefill::visit_coverage, in the same way. Returns ok.
Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept;

}  // namespace surefill::reference

#endif  // SUREFILL_SRC_REFERENCE_HPP
