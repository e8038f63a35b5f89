// SPDX-License-Identifier: Apache-2.0
//
// T1 on meshes of triangles from 1 to 500 pixels, small ones beside large ones, in perspective and not: of plugins and of
// programs.
#ifndef SUREFILL_CERTIFY_TILINGS_CHECK_HPP
#define SUREFILL_CERTIFY_TILINGS_CHECK_HPP

#include "certify/rivals/rival_cases.hpp"
#include "certify/run/checks.hpp"

namespace surefill::certify {

// A sample that the rival does not cover once, in the midst of the scene's triangles where its model takes it, in words; empty
// if there is none.
std::string crack_in(const RivalSubject& subject, const corpus::Scene& scene);

// Fills in the check. Subject must outlive it.
void make_tilings_check(const Settings& settings, const RivalSubject& subject, Check& check);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_TILINGS_CHECK_HPP
