// SPDX-License-Identifier: Apache-2.0
//
// What of occluders does not depend on the view (O4): vertices at one place, and which triangles have which edge.
#ifndef SUREFILL_SRC_OCCLUDER_MESH_HPP
#define SUREFILL_SRC_OCCLUDER_MESH_HPP

#include <cstddef>
#include <cstdint>
#include <memory>

#include "surefill/occlusion.hpp"

namespace surefill {

// A triangle's side as an edge has it: which of them, and whether it runs against the first one of that edge.
class HalfEdge {
 public:
  HalfEdge() = default;
  HalfEdge(std::uint32_t triangle, std::uint32_t corner, bool against)
      : bits_(triangle << 3 | corner << 1 | static_cast<std::uint32_t>(against)) {}

  std::uint32_t triangle() const { return bits_ >> 3; }
  std::uint32_t corner() const { return bits_ >> 1 & 3; }  // it runs from this corner to the next one
  int direction() const { return (bits_ & 1) != 0 ? -1 : 1; }

 private:
  std::uint32_t bits_;
};

inline constexpr std::size_t kMaxMeshTriangles = std::size_t{1} << 29;  // what a HalfEdge can name

// What hangs together by edges, whichever way its triangles face: no occluder reaches beyond it. Parts are apart in each of
// the mesh's lists but that of places; a vertex may belong to several.
struct MeshPart {
  std::uint32_t triangle_begin, triangle_end;
  std::uint32_t edge_begin, edge_end;
  std::uint32_t vertex_begin, vertex_end;  // in part_vertices
};

struct MeshTopology {
  std::size_t vertices = 0, triangles = 0;
  std::unique_ptr<std::uint32_t[]> indices;  // of the triangles, part by part
  std::size_t parts = 0;
  std::unique_ptr<MeshPart[]> part;
  std::unique_ptr<std::uint32_t[]> part_vertices;  // each vertex of a part once
  // Places with several vertices: those of place p are members[place_begin[p]] up to place_begin[p + 1].
  std::size_t places = 0;
  std::unique_ptr<std::uint32_t[]> place_begin, members;
  // Edges: the same with half-edges. Those without length are none. A triangle that has an edge twice is degenerate in
  // each view.
  std::size_t edges = 0;
  std::unique_ptr<std::uint32_t[]> edge_begin;
  std::unique_ptr<HalfEdge[]> half_edges;
};

struct OccluderMesh::State : MeshTopology {};

}  // namespace surefill

#endif  // SUREFILL_SRC_OCCLUDER_MESH_HPP
