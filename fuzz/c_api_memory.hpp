// SPDX-License-Identifier: Apache-2.0
//
// What the fuzz target of the C interface builds its calls of: memory with a twin, numbers that are sometimes wild,
// struct sizes that are sometimes wrong.
#ifndef SUREFILL_FUZZ_C_API_MEMORY_HPP
#define SUREFILL_FUZZ_C_API_MEMORY_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "surefill/surefill.h"

namespace surefill::fuzz {

inline constexpr std::size_t kSizeMax = std::numeric_limits<std::size_t>::max();
// Bytes up to and with the last member that the first version had: no struct is shorter.
inline constexpr std::size_t kLeastTarget = offsetof(surefill_target, attribute_location) + sizeof(std::uint32_t);
inline constexpr std::size_t kLeastDraw = offsetof(surefill_draw, culling_box) + sizeof(void*);
inline constexpr std::size_t kLeastOptions = offsetof(surefill_options, path) + sizeof(std::uint32_t);
inline constexpr std::size_t kLeastStatistics = offsetof(surefill_statistics, path) + sizeof(void*);

[[noreturn]] inline void fail(const std::string& relation) {
  report_finding("c_api", relation);
}

inline std::string text(surefill_status status) {
  return std::string("\"") + surefill_status_text(status) + "\"";
}

// What the C interface makes of an enumerator: one that does not fit in a byte is as wrong as 255.
template <typename Enum>
Enum to_enum(std::uint32_t value) {
  return static_cast<Enum>(value > 255 ? 255 : value);
}

// Memory of exactly the size that the call is told, so that the address sanitizer sees the first byte past it.
struct Memory {
  std::unique_ptr<std::byte[]> bytes, twin;
  std::size_t size = 0;
  bool output = false;
  std::vector<std::byte> before;
};

class CallMemory {
 protected:
  explicit CallMemory(std::span<const std::uint8_t> bytes) : in_(bytes) {}

  bool one_in(std::uint32_t n) { return in_.below(n) == n - 1; }  // false when the bytes have run out

  std::uint32_t enumerator(std::uint32_t count) {
    constexpr std::uint32_t kWild[] = {255, 256, 0x80000000u, 0xFFFFFFFFu};
    return one_in(64) ? kWild[in_.below(4)] : one_in(64) ? count : in_.below(count);
  }

  int size() {
    constexpr int kWild[] = {0, -1, std::numeric_limits<int>::min(), std::numeric_limits<int>::max(), 16385};
    return one_in(64) ? kWild[in_.below(5)] : 1 + static_cast<int>(in_.below(9));
  }

  float real() { return one_in(8) ? in_.real() : static_cast<float>(in_.byte()) / 16 - 2; }

  // New memory of `size` bytes.
  std::byte* allocate(std::size_t size, bool output) {
    Memory& m = memory_.emplace_back();
    m.size = size;
    m.output = output;
    m.bytes.reset(new std::byte[size]);
    m.twin.reset(new std::byte[size]);
    std::memset(m.bytes.get(), 0x3F, size);
    return m.bytes.get();
  }

  // A struct, or what fits of it, in memory of its own.
  template <typename Struct>
  Struct* place(const Struct& value, std::size_t size) {
    std::byte* at = allocate(size, false);
    std::memcpy(at, &value, std::min(size, sizeof value));
    return reinterpret_cast<Struct*>(at);
  }

  // A buffer of `bytes` bytes: mostly its own, sometimes a part of one that is there already, or null.
  template <typename T>
  T* buffer(std::size_t bytes, bool output, bool* fresh) {
    *fresh = false;
    if (one_in(64)) return nullptr;
    if (!data_.empty() && one_in(32)) {
      Memory& other = memory_[data_[in_.below(static_cast<std::uint32_t>(std::min<std::size_t>(data_.size(), 256)))]];
      const std::size_t shift = 4 * in_.below(8);
      const bool aligned = reinterpret_cast<std::uintptr_t>(other.bytes.get() + shift) % alignof(T) == 0;
      if (aligned && shift <= other.size && other.size - shift >= bytes) {
        other.output = other.output || output;
        return reinterpret_cast<T*>(other.bytes.get() + shift);
      }
    }
    *fresh = true;
    data_.push_back(memory_.size());
    return reinterpret_cast<T*>(allocate(bytes, output));
  }

  // The number of elements that the call is told of a buffer that should hold `count`; `there` are there.
  std::size_t told(std::size_t count, std::size_t* there) {
    *there = count;
    if (!one_in(32)) return count;
    switch (in_.below(4)) {
      case 0:
        return *there = 0;
      case 1:
        return *there = count == 0 ? 0 : count - 1;
      case 2:
        return *there = count + 1;
      default:  // three times 2^32: wrong for every kind of buffer, before anything is read
        return std::size_t{3} << 32;
    }
  }

  template <typename T>
  void output(std::size_t count, T** pointer, std::size_t* pointer_count) {
    if (one_in(4)) return;
    bool fresh;
    std::size_t there;
    *pointer_count = told(count, &there);
    *pointer = buffer<T>(there * sizeof(T), true, &fresh);
  }

  // A struct size that is right, or wrong and then noted. What is placed in memory has allocated_size bytes.
  std::size_t struct_size(std::size_t least, std::size_t whole, surefill_status status,
                          std::vector<surefill_status>* wrong) {
    const std::size_t sizes[] = {0, 7, 8, least - 1, least, whole - 1, whole + 1, whole + 8, kSizeMax, whole / 2, 1};
    const std::size_t size = one_in(32) ? sizes[in_.below(std::size(sizes))] : one_in(8) ? least : whole;
    if (size < least || size > whole) wrong->push_back(status);
    return size;
  }
  static std::size_t allocated_size(std::size_t struct_size) {
    return std::clamp(struct_size, sizeof(std::size_t), sizeof(surefill_draw) + 64);
  }

  // Where the twin of the byte at p lies.
  template <typename T>
  T* twin(T* p) const {
    if (p == nullptr) return nullptr;
    const auto at = reinterpret_cast<std::uintptr_t>(p);
    for (const Memory& m : memory_) {
      const auto begin = reinterpret_cast<std::uintptr_t>(m.bytes.get());
      if (at >= begin && at < begin + std::max<std::size_t>(m.size, 1)) {
        return reinterpret_cast<T*>(m.twin.get() + (at - begin));
      }
    }
    // One past the end of some memory, of which 0 bytes are meant.
    for (const Memory& m : memory_) {
      if (at == reinterpret_cast<std::uintptr_t>(m.bytes.get() + m.size)) {
        return reinterpret_cast<T*>(m.twin.get() + m.size);
      }
    }
    fail("a pointer without a twin");
  }

  bool unchanged() const {
    return std::all_of(memory_.begin(), memory_.end(),
                       [](const Memory& m) { return std::equal(m.before.begin(), m.before.end(), m.bytes.get()); });
  }

  ByteReader in_;
  std::deque<Memory> memory_;
  std::vector<std::size_t> data_;  // numbers of the memory that holds buffers and no structs
};

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_C_API_MEMORY_HPP
