// SPDX-License-Identifier: Apache-2.0
//
// Of rivals that read clip space: the viewports that programs have.
#ifndef SUREFILL_CERTIFY_ADAPTERS_VIEWPORTS_HPP
#define SUREFILL_CERTIFY_ADAPTERS_VIEWPORTS_HPP

#include <cstdint>
#include <string>

#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// A few triangles on the corners of a lattice over a viewport inside the target, of any size: no position is rounded.
corpus::Scene viewport_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);

// Is all wrong because the y of viewports is counted from the bottom row?
bool turns_viewports(const RivalSubject& subject);

// Which viewports it is that are wrong where large ones are right: "under viewports of an odd width"; empty if that is not so.
std::string which_viewports(const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_ADAPTERS_VIEWPORTS_HPP
