// SPDX-License-Identifier: Apache-2.0
#include "occluder_mesh.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <new>
#include <numeric>
#include <utility>

#include "build_check.hpp"

namespace surefill {
namespace {

// A position as bits that are equal where its numbers are (-0 and 0 are one, a NaN is nobody's equal).
struct Place {
  std::uint32_t x, y, z;
  bool operator==(const Place&) const = default;

  std::size_t hash() const {
    std::uint64_t h = (std::uint64_t{x} << 32 | y) * 0x9E3779B97F4A7C15u;
    h = (h ^ h >> 29 ^ z) * 0xBF58476D1CE4E5B9u;
    return static_cast<std::size_t>(h ^ h >> 32);
  }
};

constexpr std::uint32_t kSignBit = 1u << 31, kInfinityBits = 0x7F800000u;

std::uint32_t number_bits(float number) {
  const auto bits = std::bit_cast<std::uint32_t>(number);
  return bits == kSignBit ? 0 : bits;
}

bool is_nan(std::uint32_t bits) {
  return (bits & ~kSignBit) > kInfinityBits;
}

template <typename T>
std::unique_ptr<T[]> make_array(std::size_t size) {
  return std::unique_ptr<T[]>(new (std::nothrow) T[std::max<std::size_t>(size, 1)]);
}

class Preparation {
 public:
  Preparation(std::span<const float> positions, std::span<const std::uint32_t> indices, std::size_t stride,
              std::size_t vertices, MeshTopology* to)
      : positions_(positions), indices_(indices), stride_(stride), vertices_(vertices), state_(to) {}

  // False if there is no memory.
  bool run() {
    state_->vertices = vertices_, state_->triangles = indices_.size() / 3;
    return find_first_of_place() && list_places() && list_sides() && find_parts() && list_triangles() && list_edges();
  }

 private:
  Place place_of(std::size_t v) const {
    const float* p = positions_.data() + v * stride_;
    return {number_bits(p[0]), number_bits(p[1]), number_bits(p[2])};
  }

  // first_[v]: the first vertex at v's place. By a table of vertices, of which at least half is empty.
  bool find_first_of_place() {
    constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();
    const std::size_t size = std::bit_ceil(2 * vertices_ + 1);
    const std::unique_ptr<std::uint32_t[]> table = make_array<std::uint32_t>(size);
    first_ = make_array<std::uint32_t>(vertices_);
    if (table == nullptr || first_ == nullptr) return false;
    std::fill_n(table.get(), size, kEmpty);
    for (std::size_t v = 0; v < vertices_; ++v) {
      const auto number = static_cast<std::uint32_t>(v);
      first_[v] = number;
      const Place place = place_of(v);
      if (is_nan(place.x) || is_nan(place.y) || is_nan(place.z)) continue;
      std::size_t slot = place.hash() & (size - 1);
      while (table[slot] != kEmpty && place_of(table[slot]) != place) slot = (slot + 1) & (size - 1);
      if (table[slot] == kEmpty) table[slot] = number;
      first_[v] = table[slot];
    }
    return true;
  }

  bool list_places() {
    const auto count = make_array<std::uint32_t>(vertices_), next = make_array<std::uint32_t>(vertices_);
    if (count == nullptr || next == nullptr) return false;
    std::fill_n(count.get(), vertices_, 0);
    for (std::size_t v = 0; v < vertices_; ++v) ++count[first_[v]];
    std::size_t places = 0, members = 0;
    for (std::size_t v = 0; v < vertices_; ++v) {
      if (count[v] > 1) ++places, members += count[v];
    }
    state_->places = places;
    state_->place_begin = make_array<std::uint32_t>(places + 1);
    state_->members = make_array<std::uint32_t>(members);
    if (state_->place_begin == nullptr || state_->members == nullptr) return false;
    std::uint32_t begin = 0, place = 0;
    for (std::size_t v = 0; v < vertices_; ++v) {
      const std::uint32_t first = first_[v];
      if (count[first] < 2) continue;
      if (first == v) {
        state_->place_begin[place++] = next[v] = begin;
        begin += count[v];
      }
      state_->members[next[first]++] = static_cast<std::uint32_t>(v);
    }
    state_->place_begin[place] = begin;
    return true;
  }

  struct Side {
    std::uint64_t edge;  // its two places, the smaller one first
    HalfEdge half;
  };

  // All sides of triangles, those of an edge one after another.
  bool list_sides() {
    sides_ = make_array<Side>(3 * state_->triangles);
    if (sides_ == nullptr) return false;
    for (std::size_t t = 0; t < state_->triangles; ++t) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t from = first_[indices_[3 * t + corner]], to = first_[indices_[3 * t + (corner + 1) % 3]];
        if (from == to) continue;
        sides_[side_count_++] = {std::uint64_t{std::min(from, to)} << 32 | std::max(from, to),
                                 HalfEdge(static_cast<std::uint32_t>(t), corner, from > to)};
      }
    }
    std::sort(sides_.get(), sides_.get() + side_count_, [](const Side& a, const Side& b) {
      return a.edge != b.edge ? a.edge < b.edge : a.half.triangle() < b.half.triangle();
    });
    return true;
  }

  bool begins_edge(std::size_t side) const { return side == 0 || sides_[side].edge != sides_[side - 1].edge; }

  std::uint32_t root_of(std::uint32_t triangle) const {
    while (part_[triangle] != triangle) triangle = part_[triangle] = part_[part_[triangle]];
    return triangle;
  }

  // part_[t]: the number of t's part. A part's first triangle has the smallest number, so it is met first.
  bool find_parts() {
    part_ = make_array<std::uint32_t>(state_->triangles);
    if (part_ == nullptr) return false;
    std::iota(part_.get(), part_.get() + state_->triangles, 0u);
    for (std::size_t i = 0; i < side_count_; ++i) {
      if (begins_edge(i)) continue;
      const std::uint32_t a = root_of(sides_[i - 1].half.triangle()), b = root_of(sides_[i].half.triangle());
      part_[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t t = 0; t < state_->triangles; ++t) part_[t] = root_of(t);
    std::uint32_t parts = 0;
    for (std::uint32_t t = 0; t < state_->triangles; ++t) part_[t] = part_[t] == t ? parts++ : part_[part_[t]];
    state_->parts = parts;
    state_->part = make_array<MeshPart>(parts);
    if (state_->part == nullptr) return false;
    std::fill_n(state_->part.get(), parts, MeshPart{});
    return true;
  }

  // The triangles, part by part, and the vertices of each part.
  bool list_triangles() {
    MeshPart* const parts = state_->part.get();
    const auto last_part = make_array<std::uint32_t>(vertices_);  // that has the vertex
    state_->indices = make_array<std::uint32_t>(indices_.size());
    state_->part_vertices = make_array<std::uint32_t>(indices_.size());
    moved_ = make_array<std::uint32_t>(state_->triangles);
    if (last_part == nullptr || state_->indices == nullptr || state_->part_vertices == nullptr || moved_ == nullptr)
      return false;
    for (std::size_t t = 0; t < state_->triangles; ++t) ++parts[part_[t]].triangle_end;
    std::uint32_t begin = 0;
    for (std::size_t p = 0; p < state_->parts; ++p) {
      parts[p].triangle_begin = begin;
      begin += std::exchange(parts[p].triangle_end, begin);
    }
    for (std::uint32_t t = 0; t < state_->triangles; ++t) {
      const std::uint32_t to = moved_[t] = parts[part_[t]].triangle_end++;
      std::copy_n(indices_.data() + std::size_t{3} * t, 3, state_->indices.get() + std::size_t{3} * to);
    }
    std::fill_n(last_part.get(), vertices_, std::numeric_limits<std::uint32_t>::max());
    std::uint32_t size = 0;
    for (std::uint32_t p = 0; p < state_->parts; ++p) {
      parts[p].vertex_begin = size;
      for (std::size_t i = std::size_t{3} * parts[p].triangle_begin; i < std::size_t{3} * parts[p].triangle_end; ++i) {
        const std::uint32_t v = state_->indices[i];
        if (std::exchange(last_part[v], p) != p) state_->part_vertices[size++] = v;
      }
      parts[p].vertex_end = size;
    }
    return true;
  }

  // The edges, part by part.
  bool list_edges() {
    MeshPart* const parts = state_->part.get();
    state_->half_edges = make_array<HalfEdge>(side_count_);
    state_->edge_begin = make_array<std::uint32_t>(side_count_ + 1);
    const auto next_half = make_array<std::uint32_t>(state_->parts);
    if (state_->half_edges == nullptr || state_->edge_begin == nullptr || next_half == nullptr) return false;
    std::fill_n(next_half.get(), state_->parts, 0);
    for (std::size_t i = 0; i < side_count_; ++i) {
      const std::uint32_t p = part_[sides_[i].half.triangle()];
      ++next_half[p];
      if (begins_edge(i)) ++parts[p].edge_end;
    }
    std::uint32_t edges = 0, halves = 0;
    for (std::size_t p = 0; p < state_->parts; ++p) {
      parts[p].edge_begin = edges;
      edges += std::exchange(parts[p].edge_end, edges);
      halves += std::exchange(next_half[p], halves);
    }
    for (std::size_t i = 0; i < side_count_; ++i) {
      const HalfEdge half = sides_[i].half;
      const std::uint32_t p = part_[half.triangle()];
      if (begins_edge(i)) state_->edge_begin[parts[p].edge_end++] = next_half[p];
      state_->half_edges[next_half[p]++] = HalfEdge(moved_[half.triangle()], half.corner(), half.direction() < 0);
    }
    state_->edge_begin[edges] = static_cast<std::uint32_t>(side_count_);
    state_->edges = edges;
    return true;
  }

  std::span<const float> positions_;
  std::span<const std::uint32_t> indices_;
  std::size_t stride_, vertices_;
  std::unique_ptr<std::uint32_t[]> first_;  // the first vertex at a vertex's place
  std::unique_ptr<Side[]> sides_;
  std::size_t side_count_ = 0;
  std::unique_ptr<std::uint32_t[]> part_, moved_;  // a triangle's part, and its number in the list
  MeshTopology* state_;
};

}  // namespace

OccluderMesh::~OccluderMesh() {
  delete state_;
}

OccluderMesh::OccluderMesh(OccluderMesh&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}

OccluderMesh& OccluderMesh::operator=(OccluderMesh&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status OccluderMesh::prepare(std::span<const float> positions, std::span<const std::uint32_t> indices,
                             std::uint32_t stride) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  const bool null = positions.data() == nullptr && !positions.empty();
  if (null || stride < 3 || (positions.size() % stride != 0 && positions.size() % stride < 3))
    return Status::occluder_positions;
  const std::size_t vertices = positions.size() / stride + (positions.size() % stride != 0);
  if (vertices > std::numeric_limits<std::uint32_t>::max()) return Status::occluder_positions;
  if ((indices.data() == nullptr && !indices.empty()) || indices.size() % 3 != 0 ||
      indices.size() / 3 >= kMaxMeshTriangles) {
    return Status::draw_indices;
  }
  for (const std::uint32_t index : indices) {
    if (index >= vertices) return Status::draw_index_out_of_range;
  }
  std::unique_ptr<State> state(new (std::nothrow) State);
  if (state == nullptr || !Preparation(positions, indices, stride, vertices, state.get()).run())
    return Status::out_of_memory;
  delete std::exchange(state_, state.release());
  return Status::ok;
}

std::size_t OccluderMesh::vertices() const noexcept {
  return state_ == nullptr ? 0 : state_->vertices;
}

std::size_t OccluderMesh::triangles() const noexcept {
  return state_ == nullptr ? 0 : state_->triangles;
}

}  // namespace surefill
