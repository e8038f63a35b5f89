// SPDX-License-Identifier: Apache-2.0
//
// T1 as every rasterizer owes it, whatever it snaps to: a large mesh in perspective, without T-junctions, each triangle
// several pixels high. Needs no oracle and no model.
#ifndef SUREFILL_CERTIFY_PERSPECTIVE_CHECK_HPP
#define SUREFILL_CERTIFY_PERSPECTIVE_CHECK_HPP

#include "certify/rivals/rival.hpp"
#include "certify/run/checks.hpp"

namespace surefill::certify {

// Fills in all but the name, the rule and what is common to checks of rivals.
void make_perspective_check(const Settings& settings, adapters::Rival& rival, Check& check);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_PERSPECTIVE_CHECK_HPP
