// SPDX-License-Identifier: Apache-2.0
//
// The one translation unit of properties/ that includes CGAL's meshes: 20 s and 1.3 GB to compile.
#include "properties/generators/meshes.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/convex_hull_3.h>
#include <tiny_obj_loader.h>

#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "corpus/folder.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PlanePoint = Kernel::Point_2;
using SpacePoint = Kernel::Point_3;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

SpacePoint vector_end(const Vertex& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.w)};
}

}  // namespace

int facing(const std::array<Vertex, 3>& t) {
  for (const Vertex& v : t)
    if (!finite(v)) return 0;
  return static_cast<int>(CGAL::orientation(SpacePoint(0, 0, 0), vector_end(t[0]), vector_end(t[1]), vector_end(t[2])));
}

std::vector<Indices> delaunay(std::span<const std::array<float, 2>> points) {
  std::vector<std::pair<PlanePoint, std::uint32_t>> numbered;
  for (const auto& p : points)
    numbered.emplace_back(PlanePoint(static_cast<double>(p[0]), static_cast<double>(p[1])),
                          static_cast<std::uint32_t>(numbered.size()));
  const Triangulation triangulation(numbered.begin(), numbered.end());
  std::vector<Indices> triangles;
  for (const auto face : triangulation.finite_face_handles())
    triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return triangles;
}

std::vector<Indices> convex_hull(std::span<const std::array<float, 3>> points) {
  std::vector<SpacePoint> corners;
  std::map<SpacePoint, std::uint32_t> numbers;
  for (const auto& p : points) {
    corners.emplace_back(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
    numbers.emplace(corners.back(), static_cast<std::uint32_t>(corners.size() - 1));
  }
  CGAL::Surface_mesh<SpacePoint> hull;
  bool solid = false;
  for (std::size_t i = 3; i < corners.size() && !solid; ++i)
    for (std::size_t j = 2; j < i && !solid; ++j)
      for (std::size_t k = 1; k < j && !solid; ++k)
        solid = !CGAL::coplanar(corners[0], corners[i], corners[j], corners[k]);
  if (!solid) return {};
  CGAL::convex_hull_3(corners.begin(), corners.end(), hull);
  std::vector<Indices> triangles;
  for (const auto face : hull.faces()) {
    std::vector<std::uint32_t> around;
    for (const auto vertex : hull.vertices_around_face(hull.halfedge(face)))
      around.push_back(numbers.at(hull.point(vertex)));
    for (std::size_t i = 2; i < around.size(); ++i) triangles.push_back({around[0], around[i - 1], around[i]});
  }
  return triangles;
}

Mesh load_mesh(const char* name) {
  const std::string path = corpus::corpus_folder(SUREFILL_CORPUS) + "/meshes/" + name;
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  if (!reader.ParseFromFile(path, config)) throw std::runtime_error(path + ": " + reader.Error());
  Mesh mesh;
  const std::vector<tinyobj::real_t>& positions = reader.GetAttrib().vertices;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    mesh.vertices.push_back({static_cast<float>(positions[i]), static_cast<float>(positions[i + 1]),
                             static_cast<float>(positions[i + 2]), 1});
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3)
      mesh.triangles.push_back({static_cast<std::uint32_t>(shape.mesh.indices[i].vertex_index),
                                static_cast<std::uint32_t>(shape.mesh.indices[i + 1].vertex_index),
                                static_cast<std::uint32_t>(shape.mesh.indices[i + 2].vertex_index)});
  return mesh;
}

}  // namespace surefill::properties
