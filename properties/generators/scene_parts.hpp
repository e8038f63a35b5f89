// SPDX-License-Identifier: Apache-2.0
//
// What generated scenes have beside their geometry, drawn from the same random numbers.
#ifndef SUREFILL_PROPERTIES_SCENE_PARTS_HPP
#define SUREFILL_PROPERTIES_SCENE_PARTS_HPP

#include "properties/generators/generators.hpp"

namespace surefill::properties {

// Up to three attributes with values for all vertices; rarely one that is not finite.
void add_attributes(corpus::Scene& scene, Random& random);
// Unique within the scene, in any order, from anywhere in the range.
void add_identifiers(corpus::Scene& scene, Random& random);
// One value, or one for each sample: call it when size and samples stand.
void add_initial_depth(corpus::Scene& scene, Random& random);
Scissor random_scissor(const corpus::Scene& scene, Random& random);
// Vertices and scissors go along with a far origin, rounded; a near one stays under what is drawn, so that it is cut.
void set_origin(corpus::Scene& scene, Random& random);
// A place for each sample of a pixel, some of them equal.
void set_locations(corpus::Scene& scene, Random& random);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_SCENE_PARTS_HPP
