// SPDX-License-Identifier: Apache-2.0
#include "properties/generators/meshes.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {

corpus::Scene mesh_scene(const Mesh& mesh, int width, int height) {
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (const Vertex& v : mesh.vertices) draw.vertices.push_back(scene_vertex(v));
  for (const Indices& t : mesh.triangles) draw.triangles.push_back({t, std::nullopt});
  return scene;
}

}  // namespace surefill::properties
