// SPDX-License-Identifier: Apache-2.0
//
// The random scenes that corpus/hashes.txt has lines for.
#ifndef SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP
#define SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP

#include <cstdint>
#include <string>

#include "properties/generators/generators.hpp"

namespace surefill::properties {

// visit(name, scene) for three scenes of several tiles from each category; one of them has several samples a pixel.
template <typename Visit>
void for_each_hashed_scene(Visit&& visit) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SceneLimits limits;
      limits.max_size = 180, limits.max_triangles = 12;
      limits.samples = seed == 1;
      visit(std::string("random/") + category.name + "/" + std::to_string(seed), random_scene(category, seed, limits));
    }
  }
}

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP
