// SPDX-License-Identifier: Apache-2.0
//
// Which memory a call writes, and whether that overlaps what it reads (B2).
#ifndef SUREFILL_SRC_OVERLAP_HPP
#define SUREFILL_SRC_OVERLAP_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "facts.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill {

struct Bytes {
  std::uint64_t begin = 0, end = 0;  // in 64 bits: memory may end where the addresses do

  Bytes() = default;
  Bytes(const void* data, std::uint64_t size) : begin(reinterpret_cast<std::uintptr_t>(data)), end(begin + size) {}
  template <typename T>
  explicit Bytes(std::span<T> s) : Bytes(s.data(), s.size() * std::uint64_t{sizeof(T)}) {}
  // Of one object, which may be null.
  template <typename T>
  static Bytes of(const T* object) {
    return {object, object == nullptr ? 0 : sizeof(T)};
  }

  bool empty() const { return begin == end; }
  // Do they share a byte? Empty ones share none.
  bool overlaps(const Bytes& other) const {
    return begin < end && other.begin < other.end && begin < other.end && other.begin < end;
  }
};

// The memory that a call writes.
class Outputs {
 public:
  // False if it overlaps what was there before.
  bool add(const Bytes& bytes) {
    if (touched_by(bytes)) return false;
    bytes_[count_++] = bytes;
    return true;
  }

  // All buffers of a target; false if they overlap. A list of attributes that is null or too long is not read.
  bool add_buffers(const Target& target) {
    bool apart = add(Bytes(target.count)) && add(Bytes(target.index)) && add(Bytes(target.depth)) &&
                 add(Bytes(target.barycentrics)) && add(Bytes(target.winding));
    if (target.attributes.data() == nullptr || target.attributes.size() > kMaxAttributes) return apart;
    const std::size_t buffers = count_;
    for (const AttributeTarget& image : target.attributes) {
      const Bytes bytes(image.values);
      apart = apart && !touches(bytes, 0, buffers) && !numbers_touch(bytes);
      for (std::size_t k = 0; apart && k < count_ - buffers; ++k)
        apart = !bytes_[buffers + k].overlaps(bytes) || lie_side_by_side(target.attributes[k], image);
      if (!apart) return false;
      bytes_[count_++] = bytes;
    }
    return apart;
  }

  // The numbers of the draws' triangles (M10), where one asks for them. The list stays where it is.
  void add_numbers(std::span<const Draw> draws) {
    for (const Draw& draw : draws) {
      if (!draw.covered.empty() || !draw.visible.empty()) draws_ = draws;
    }
  }
  bool has_numbers() const { return !draws_.empty(); }

  bool touched_by(const Bytes& bytes) const { return touches(bytes, 0, count_) || numbers_touch(bytes); }

  // Do the numbers of a draw's triangles lie on these bytes?
  bool numbers_touch(const Bytes& bytes) const {
    return std::any_of(draws_.begin(), draws_.end(), [&](const Draw& draw) {
      return Bytes(draw.covered).overlaps(bytes) || Bytes(draw.visible).overlaps(bytes);
    });
  }

 private:
  bool touches(const Bytes& bytes, std::size_t begin, std::size_t end) const {
    return std::any_of(bytes_ + begin, bytes_ + end, [&](const Bytes& output) { return output.overlaps(bytes); });
  }

  // Two images whose memory overlaps: does each keep to its own components of every sample? By the distance of their
  // first ones, modulo the stride that both have.
  static bool lie_side_by_side(const AttributeTarget& a, const AttributeTarget& b) {
    const std::uint64_t stride = stride_of(a) * std::uint64_t{sizeof(float)};
    if (stride_of(a) != stride_of(b) || stride == 0) return false;
    const std::uint64_t from = Bytes(a.values).begin % stride, to = Bytes(b.values).begin % stride;
    const std::uint64_t distance = (to + stride - from) % stride;
    return a.components * sizeof(float) <= distance && distance + b.components * sizeof(float) <= stride;
  }

  static constexpr std::size_t kMost = 7 + kMaxAttributes;  // five buffers, the attributes, statistics, diagnostics
  Bytes bytes_[kMost];
  std::size_t count_ = 0;
  std::span<const Draw> draws_;  // those with numbers, or none
};

}  // namespace surefill

#endif  // SUREFILL_SRC_OVERLAP_HPP
