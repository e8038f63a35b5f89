// SPDX-License-Identifier: Apache-2.0
//
// Frames of several draws, one over the other: the check `layers`. Depth write off, initial depth, interpolation by draw.
#ifndef SUREFILL_CERTIFY_RIVALS_LAYERS_HPP
#define SUREFILL_CERTIFY_RIVALS_LAYERS_HPP

#include <cstdint>

#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// Large triangles whose depths lie 1/32 and more apart, of the features that the rival claims.
corpus::Scene layers_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed);

// After a frame with a near triangle over everything.
CaseResult layers_case(const corpus::Scene& scene, const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVALS_LAYERS_HPP
