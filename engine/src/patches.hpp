// SPDX-License-Identifier: Apache-2.0
//
// Finds the patches of occluders in a view: O4's faces, rim edges, and what inner edges link.
#ifndef SUREFILL_SRC_PATCHES_HPP
#define SUREFILL_SRC_PATCHES_HPP

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

#include "exact/occluder.hpp"
#include "fast/patches.hpp"
#include "occluder_mesh.hpp"
#include "surefill/occlusion.hpp"

namespace surefill {

// Memory that grows, without exceptions; what is new in it has any value.
template <typename T>
class Growing {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  // Room for so many elements. False if there is no memory; then nothing has changed.
  bool reserve(std::size_t size) {
    if (size <= capacity_) return true;
    const std::size_t more = size + size / 2;
    void* const memory = ::operator new(more * sizeof(T), std::nothrow);
    if (memory == nullptr) return false;
    if (capacity_ != 0) std::memcpy(memory, data_.get(), capacity_ * sizeof(T));
    data_.reset(static_cast<T*>(memory));
    capacity_ = more;
    return true;
  }
  std::size_t capacity() const { return capacity_; }
  T* data() const { return data_.get(); }
  T& operator[](std::size_t i) const { return data_[i]; }

 private:
  struct Free {
    void operator()(T* data) const { ::operator delete(data); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t capacity_ = 0;
};

// Do vertices at one place of the mesh have equal X, Y, W, where they are finite? (O4)
bool places_agree(const MeshTopology& mesh, std::span<const Vertex> vertices);

// The patches of one call, and the memory for it.
class PatchList {
 public:
  // Starts a call.
  void clear() { vertices_ = faces_ = rims_ = patches_ = views_ = 0; }
  // Adds those of an occluder for a buffer of that size; `sign` is 1, or -1 for GREATER. False if there is no memory.
  bool add(const MeshTopology& mesh, const Occluder& occluder, int width, int height, float sign);
  // What the vector code needs; valid until the next call of another function.
  fast::PatchFrame frame();

 private:
  using Side = std::uint8_t;  // of a face: 1 front, 2 back; 0 for what is no face

  struct Found {
    Extent extent;
    float nearest = HUGE_VALF;
    std::size_t faces = 0, rims = 0;
    std::size_t number = 0;  // in patch_list_
  };

  bool reserve(const MeshTopology& mesh, const Occluder& occluder);
  void find_codes(std::span<const Vertex> vertices, int width, int height);
  // Steps of one part, in this order.
  bool is_off(const MeshTopology& mesh, const MeshPart& part) const;
  bool see(const MeshTopology& mesh, const MeshPart& part, std::span<const Vertex> vertices, int width, int height);
  void find_sides(const MeshTopology& mesh, const MeshPart& part, const Occluder& occluder);
  void link(const MeshTopology& mesh, const MeshPart& part);
  void link_many(const MeshTopology& mesh, std::size_t begin, std::size_t end);
  std::size_t number_patches(const MeshTopology& mesh, const MeshPart& part);
  void list_patches(const MeshTopology& mesh, const MeshPart& part, int width, int height);
  std::uint32_t root_of(std::uint32_t triangle);
  void join(std::uint32_t a, std::uint32_t b);

  // Of all occluders.
  Growing<fast::SeenVertex> seen_;
  Growing<std::uint32_t> face_list_;
  Growing<fast::RimEdge> rim_list_;
  Growing<fast::Patch> patch_list_;
  Growing<fast::MeshView> view_list_;
  Growing<std::size_t> first_vertex_;  // of a view, in seen_
  std::size_t vertices_ = 0, faces_ = 0, rims_ = 0, patches_ = 0, views_ = 0;

  // Of one. Of triangles what their part has is used, and then its next one's.
  Growing<std::uint8_t> codes_;  // of vertices: sides of the target beyond which they lie
  float sign_ = 1;
  Growing<Side> sides_;
  Growing<std::uint32_t> parent_;    // of a face, towards the first one of its patch
  Growing<std::uint32_t> patch_of_;  // of a face, in found_
  Growing<Found> found_;
  Growing<HalfEdge> half_rims_;
  std::size_t half_rim_count_ = 0;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_PATCHES_HPP
