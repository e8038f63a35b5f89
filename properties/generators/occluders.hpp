// SPDX-License-Identifier: Apache-2.0
//
// Hostile occluders for safe buffers (O4 to T7 of docs/semantics.md): meshes whose rims touch corners of pixels, and whose
// edges nearly match.
#ifndef SUREFILL_PROPERTIES_OCCLUDERS_HPP
#define SUREFILL_PROPERTIES_OCCLUDERS_HPP

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/generators/meshes.hpp"

namespace surefill::properties {

// What a generated mesh of occluders aims at.
struct OccluderCategory {
  const char* name;  // "sheet", "city", ...
  const char* aims;  // one sentence
  // A mesh for a buffer of this size, of at most about `faces` faces.
  Mesh (*mesh)(Random& random, int width, int height, int faces);
};
std::span<const OccluderCategory> occluder_categories();

// Draws of a buffer of this size, as O4 takes them: meshes of this category, others mixed in, most of them damaged by
// holes, T-junctions, split and moved vertices, faces that are doubled, turned, dropped or degenerate. The depth test is
// less or greater. Outputs: index and depth.
corpus::Scene occluder_scene(const OccluderCategory& category, std::uint64_t seed, int width, int height,
                             int max_faces);

// Positions of its vertices, as O4 has them, one list for each draw: mostly X, Y and W; some of equal X, Y, W are not one.
std::vector<std::vector<std::array<float, 3>>> positions_of(const corpus::Scene& scene, std::uint64_t seed);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_OCCLUDERS_HPP
