// SPDX-License-Identifier: Apache-2.0
#include "patches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/edge.hpp"
#include "exact/occluder.hpp"
#include "facts.hpp"

namespace surefill {
namespace {

using fast::MeshView;
using fast::Patch;
using fast::RimEdge;
using fast::SeenVertex;

constexpr std::uint32_t kNoPatch = std::numeric_limits<std::uint32_t>::max();  // of what is no face
constexpr std::size_t kNotDrawn = std::numeric_limits<std::size_t>::max();

bool same_place_on_screen(const Vertex& a, const Vertex& b) {
  return a.x == b.x && a.y == b.y && a.w == b.w;
}

// The sign of D. As determinant_sign, without an EdgeFunction, which knows more than is needed here.
int facing_of(const Vertex& v0, const Vertex& v1, const Vertex& v2) {
  const double x0 = v0.x, y0 = v0.y, w0 = v0.w, x1 = v1.x, y1 = v1.y, w1 = v1.w, x2 = v2.x, y2 = v2.y, w2 = v2.w;
  const double ax = (y1 * w2 - w1 * y2) * x0, by = (w1 * x2 - x1 * w2) * y0, cw = (x1 * y2 - y1 * x2) * w0;
  const double estimate = (ax + by) + cw;
  if (std::fabs(estimate) > kEdgeErrorBound * ((std::fabs(ax) + std::fabs(by)) + std::fabs(cw)))
    return sign_of(estimate);
  return exact_determinant(v0, v1, v2).sign();
}

// The squares of a target that lie within an extent and touch none of its ends.
PixelBox squares_within(const Extent& extent, int width, int height) {
  const auto first = [](double low, int size) {
    return static_cast<int>(std::clamp(std::floor(low) + 1, 0.0, static_cast<double>(size)));
  };
  const auto last = [](double high, int size) {
    return static_cast<int>(std::clamp(std::ceil(high) - 1, 0.0, static_cast<double>(size)));
  };
  return {first(extent.x0, width), first(extent.y0, height), last(extent.x1, width), last(extent.y1, height)};
}

}  // namespace

bool places_agree(const MeshTopology& mesh, std::span<const Vertex> vertices) {
  for (std::size_t place = 0; place < mesh.places; ++place) {
    const Vertex* first = nullptr;
    for (std::size_t m = mesh.place_begin[place]; m < mesh.place_begin[place + 1]; ++m) {
      const Vertex& vertex = vertices[mesh.members[m]];
      if (!is_finite(vertex)) continue;
      if (first == nullptr) first = &vertex;
      if (!same_place_on_screen(*first, vertex)) return false;
    }
  }
  return true;
}

bool PatchList::reserve(const MeshTopology& mesh, const Occluder& occluder) {
  // The most that there can be.
  return seen_.reserve(vertices_ + occluder.vertices.size()) && face_list_.reserve(faces_ + mesh.triangles) &&
         view_list_.reserve(views_ + 1) && first_vertex_.reserve(views_ + 1) && sides_.reserve(mesh.triangles) &&
         parent_.reserve(mesh.triangles) && patch_of_.reserve(mesh.triangles) && found_.reserve(mesh.triangles) &&
         half_rims_.reserve(3 * mesh.triangles) && patch_list_.reserve(patches_ + mesh.triangles) &&
         rim_list_.reserve(rims_ + 3 * mesh.triangles) && codes_.reserve(occluder.vertices.size());
}

bool PatchList::add(const MeshTopology& mesh, const Occluder& occluder, int width, int height, float sign) {
  if (!reserve(mesh, occluder)) return false;
  sign_ = sign;
  view_list_[views_] = {occluder.vertices.data(), mesh.indices.get(), nullptr, occluder.depth_mode};
  first_vertex_[views_] = vertices_;
  find_codes(occluder.vertices, width, height);
  for (std::size_t p = 0; p < mesh.parts; ++p) {
    const MeshPart& part = mesh.part[p];
    if (is_off(mesh, part) || !see(mesh, part, occluder.vertices, width, height)) continue;
    find_sides(mesh, part, occluder);
    link(mesh, part);
    list_patches(mesh, part, width, height);
  }
  vertices_ += occluder.vertices.size();
  ++views_;
  return true;
}

// If all vertices of a part lie on the outer side of one of the target's sides, or have W <= 0, nothing of it is on the target,
// as what is seen of it is a sum of them. A vertex that is not finite is one of no face: it lies beyond every side.
void PatchList::find_codes(std::span<const Vertex> vertices, int width, int height) {
  const double right = width, bottom = height;  // W times that is exact: 24 and 15 bits
  std::uint8_t* const codes = codes_.data();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vertex& v = vertices[i];
    const double x = v.x, y = v.y, w = v.w;
    const int code =
        (w <= 0 ? 1 : 0) | (x < 0 ? 2 : 0) | (y < 0 ? 4 : 0) | (x > right * w ? 8 : 0) | (y > bottom * w ? 16 : 0);
    const float any = v.x * 0 + v.y * 0 + v.z * 0 + v.w * 0;  // a NaN if one of them is not finite
    codes[i] = static_cast<std::uint8_t>(any == 0 ? code : 31);
  }
}

bool PatchList::is_off(const MeshTopology& mesh, const MeshPart& part) const {
  unsigned common = 31;
  for (std::size_t i = part.vertex_begin; i < part.vertex_end; ++i) common &= codes_[mesh.part_vertices[i]];
  return common != 0;
}

// False if no patch of the part can fill a square.
bool PatchList::see(const MeshTopology& mesh, const MeshPart& part, std::span<const Vertex> vertices, int width,
                    int height) {
  Extent extent;
  bool everywhere = false;
  for (std::size_t i = part.vertex_begin; i < part.vertex_end; ++i) {
    const Vertex& v = vertices[mesh.part_vertices[i]];
    SeenVertex& s = seen_[vertices_ + mesh.part_vertices[i]];
    s.flags = is_finite(v) ? SeenVertex::kFinite : 0;
    if (s.flags == 0) continue;
    if (!(v.w > 0)) {
      everywhere = true;
      continue;
    }
    s.flags |= SeenVertex::kInFront | (v.z >= 0 && v.z <= v.w ? SeenVertex::kUnitDepth : 0);
    s.x = static_cast<double>(v.x) / v.w, s.y = static_cast<double>(v.y) / v.w;
    s.farthest = rounded_up_quotient(sign_ * v.z, v.w);
    extent.add(s.x, s.y);
  }
  return everywhere || !squares_within(extent, width, height).empty();
}

void PatchList::find_sides(const MeshTopology& mesh, const MeshPart& part, const Occluder& occluder) {
  const SeenVertex* const seen = seen_.data() + vertices_;
  const Vertex* const vertices = occluder.vertices.data();
  const std::uint32_t* index = mesh.indices.get() + std::size_t{3} * part.triangle_begin;
  const int front = occluder.front_face == FrontFace::clockwise ? 1 : -1;
  const Side of_front = occluder.cull == Cull::front ? 0 : 1, of_back = occluder.cull == Cull::back ? 0 : 2;
  for (std::size_t t = part.triangle_begin; t < part.triangle_end; ++t, index += 3) {
    Side side = 0;
    if ((seen[index[0]].flags & seen[index[1]].flags & seen[index[2]].flags & SeenVertex::kFinite) != 0) {
      const int facing = facing_of(vertices[index[0]], vertices[index[1]], vertices[index[2]]) * front;
      side = facing == 0 ? 0 : facing > 0 ? of_front : of_back;
    }
    sides_[t] = side;
    parent_[t] = static_cast<std::uint32_t>(t);
  }
}

std::uint32_t PatchList::root_of(std::uint32_t triangle) {
  while (parent_[triangle] != triangle) {
    parent_[triangle] = parent_[parent_[triangle]];
    triangle = parent_[triangle];
  }
  return triangle;
}

void PatchList::join(std::uint32_t a, std::uint32_t b) {
  a = root_of(a), b = root_of(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

void PatchList::link(const MeshTopology& mesh, const MeshPart& part) {
  half_rim_count_ = 0;
  for (std::size_t e = part.edge_begin; e < part.edge_end; ++e) {
    const std::size_t begin = mesh.edge_begin[e], end = mesh.edge_begin[e + 1];
    if (end - begin != 2) {
      link_many(mesh, begin, end);
      continue;
    }
    const HalfEdge h0 = mesh.half_edges[begin], h1 = mesh.half_edges[begin + 1];
    const Side s0 = sides_[h0.triangle()], s1 = sides_[h1.triangle()];
    if (s0 == s1 && h0.direction() != h1.direction()) {
      if (s0 != 0) join(h0.triangle(), h1.triangle());
      continue;
    }
    if (s0 != 0) half_rims_[half_rim_count_++] = h0;
    if (s1 != 0) half_rims_[half_rim_count_++] = h1;
  }
}

void PatchList::link_many(const MeshTopology& mesh, std::size_t begin, std::size_t end) {
  const HalfEdge* const half = mesh.half_edges.get();
  for (Side side = 1; side <= 2; ++side) {
    std::int64_t balance = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (sides_[half[i].triangle()] == side) balance += half[i].direction();
    }
    std::uint32_t first = kNoPatch;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t triangle = half[i].triangle();
      if (sides_[triangle] != side) continue;
      if (balance != 0) {
        half_rims_[half_rim_count_++] = half[i];
      } else if (first == kNoPatch) {
        first = triangle;
      } else {
        join(first, triangle);
      }
    }
  }
}

// A patch's first face, its root, has the smallest number, so it is met before the others.
std::size_t PatchList::number_patches(const MeshTopology& mesh, const MeshPart& part) {
  const SeenVertex* const seen = seen_.data() + vertices_;
  const std::uint32_t* index = mesh.indices.get() + std::size_t{3} * part.triangle_begin;
  std::size_t count = 0;
  for (std::size_t t = part.triangle_begin; t < part.triangle_end; ++t, index += 3) {
    patch_of_[t] = kNoPatch;
    if (sides_[t] == 0) continue;
    const std::uint32_t root = root_of(static_cast<std::uint32_t>(t));
    if (root == t) {
      found_[count] = {};
      patch_of_[t] = static_cast<std::uint32_t>(count++);
    }
    const std::uint32_t number = patch_of_[t] = patch_of_[root];
    Found& patch = found_[number];
    ++patch.faces;
    int in_front = 0;
    for (int k = 0; k < 3; ++k) in_front += (seen[index[k]].flags & SeenVertex::kInFront) != 0;
    if (in_front == 3) {
      for (int k = 0; k < 3; ++k) {
        const SeenVertex& vertex = seen[index[k]];
        patch.extent.add(vertex.x, vertex.y);
        patch.nearest = std::min(patch.nearest, vertex.farthest);
      }
    } else if (in_front > 0) {
      patch.nearest = -HUGE_VALF;
      patch.extent.add(-HUGE_VAL, -HUGE_VAL), patch.extent.add(HUGE_VAL, HUGE_VAL);
    }
  }
  return count;
}

void PatchList::list_patches(const MeshTopology& mesh, const MeshPart& part, int width, int height) {
  const std::size_t count = number_patches(mesh, part);
  for (std::size_t i = 0; i < half_rim_count_; ++i) ++found_[patch_of_[half_rims_[i].triangle()]].rims;
  // Those that can fill a square, with room for their faces and rims.
  for (std::size_t i = 0; i < count; ++i) {
    Found& found = found_[i];
    const PixelBox box = squares_within(found.extent, width, height);
    found.number = kNotDrawn;
    if (box.empty()) continue;
    found.number = patches_;
    patch_list_[patches_++] = {static_cast<std::uint32_t>(views_), faces_, faces_, rims_, rims_, box, found.nearest};
    faces_ += found.faces, rims_ += found.rims;
  }
  for (std::size_t t = part.triangle_begin; t < part.triangle_end; ++t) {
    if (patch_of_[t] == kNoPatch || found_[patch_of_[t]].number == kNotDrawn) continue;
    face_list_[patch_list_[found_[patch_of_[t]].number].face_end++] = static_cast<std::uint32_t>(t);
  }
  for (std::size_t i = 0; i < half_rim_count_; ++i) {
    const HalfEdge half = half_rims_[i];
    const Found& found = found_[patch_of_[half.triangle()]];
    if (found.number == kNotDrawn) continue;
    const std::uint32_t* const index = mesh.indices.get() + std::size_t{3} * half.triangle();
    rim_list_[patch_list_[found.number].rim_end++] = {index[half.corner()], index[(half.corner() + 1) % 3]};
  }
}

// What is near is drawn first, as it hides what is far; the image does not depend on it.
fast::PatchFrame PatchList::frame() {
  std::sort(patch_list_.data(), patch_list_.data() + patches_,
            [](const Patch& a, const Patch& b) { return a.nearest < b.nearest; });
  for (std::size_t v = 0; v < views_; ++v) view_list_[v].seen = seen_.data() + first_vertex_[v];
  fast::PatchFrame frame{};
  frame.views = view_list_.data(), frame.patches = patch_list_.data(), frame.patch_count = patches_;
  frame.faces = face_list_.data(), frame.rims = rim_list_.data();
  return frame;
}

}  // namespace surefill
