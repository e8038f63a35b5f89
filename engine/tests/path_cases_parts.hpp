// SPDX-License-Identifier: Apache-2.0
//
// What the generators of path_cases.cpp and path_cases_depth.cpp share.
#ifndef SUREFILL_PROPERTIES_PATH_CASES_PARTS_HPP
#define SUREFILL_PROPERTIES_PATH_CASES_PARTS_HPP

#include <cstdint>

#include "corpus/scene.hpp"
#include "engine/tests/path_cases.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::properties {

// Some of the outputs that a scene can have.
corpus::Outputs random_outputs(const corpus::Scene& scene, Random& random);
int random_threads(Random& random);
// State that a frame may have: samples, scissors, culling, depth modes, identifiers ...
void add_state(corpus::Scene& scene, Random& random);
void append(corpus::SceneDraw& draw, const Vertex (&vertices)[3]);

// Cases in which depth decides: path_cases_depth.cpp.
PathScene layers_case(std::uint64_t number);
PathScene cusps_case(std::uint64_t number);
PathScene flat_case(std::uint64_t number);
PathScene steep_case(std::uint64_t number);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_PATH_CASES_PARTS_HPP
