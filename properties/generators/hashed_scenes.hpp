// SPDX-License-Identifier: Apache-2.0
//
// The random scenes that corpus/hashes.txt has lines for.
#ifndef SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP
#define SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP

#include <cstdint>
#include <string>

#include "properties/generators/generators.hpp"

namespace surefill::properties {

// visit(name, scene) for three scenes of several tiles from each category, of which one has several samples a pixel, and
// for two in the further modes: origin, sample places, layers, depth tests, bias, outputs. And for two scenes of lines and
// points from each of their categories.
template <typename Visit>
void for_each_hashed_scene(Visit&& visit) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SceneLimits limits;
      limits.max_size = 180, limits.max_triangles = 12;
      limits.samples = seed == 1;
      visit(std::string("random/") + category.name + "/" + std::to_string(seed), random_scene(category, seed, limits));
    }
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      visit(std::string("modes/") + category.name + "/" + std::to_string(seed),
            modes_scene(category, 1000 + seed, 100, 8));
    }
  }
  for (const LineCategory& category : line_categories()) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      visit(std::string("lines/") + category.name + "/" + std::to_string(seed),
            lines_scene(category, 1000 + seed, 100, 8));
    }
  }
}

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_GENERATORS_HASHED_SCENES_HPP
