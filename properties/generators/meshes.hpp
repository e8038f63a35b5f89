// SPDX-License-Identifier: Apache-2.0
//
// Meshes for the theorems that speak of meshes, and the exact geometry (CGAL) behind them. Coordinates are taken as
// they are: a mesh tiles, or is convex, over the real numbers and not up to rounding.
#ifndef SUREFILL_PROPERTIES_MESHES_HPP
#define SUREFILL_PROPERTIES_MESHES_HPP

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "properties/generators/generators.hpp"

namespace surefill::properties {

using Indices = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<Indices> triangles;
};

// The Delaunay triangulation of points in the plane: it tiles their convex hull. Equal points count once.
std::vector<Indices> delaunay(std::span<const std::array<float, 2>> points);

// The boundary of the convex hull of points in space, consistently oriented. Empty if the points lie in a plane.
std::vector<Indices> convex_hull(std::span<const std::array<float, 3>> points);

// The triangles of an OBJ file of the corpus, with vertices shared by position: w = 1. Throws std::runtime_error.
Mesh load_mesh(const char* name);

// The mesh as one draw of a scene.
corpus::Scene mesh_scene(const Mesh& mesh, int width, int height);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_MESHES_HPP
