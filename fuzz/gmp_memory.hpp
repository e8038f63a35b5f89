// SPDX-License-Identifier: Apache-2.0
//
// GMP's memory from free lists: the oracle's integers live for microseconds, and under the address sanitizer malloc
// costs more than the arithmetic. For programs in which one thread at a time uses GMP.
#ifndef SUREFILL_FUZZ_GMP_MEMORY_HPP
#define SUREFILL_FUZZ_GMP_MEMORY_HPP

#include <gmp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace surefill::fuzz {

class GmpMemory {
 public:
  // Once, before the first call of GMP.
  static void use() { mp_set_memory_functions(allocate, reallocate, release); }

 private:
  static constexpr std::size_t kClasses = 12;  // of 32 bytes << n; larger blocks are malloc's
  struct Free {
    Free* next;
  };

  static std::size_t class_of(std::size_t size) {
    return static_cast<std::size_t>(std::bit_width((std::max<std::size_t>(size, 1) - 1) >> 5));
  }

  static void* allocate(std::size_t size) {
    const std::size_t n = class_of(size);
    if (n < kClasses && free_[n] != nullptr) {
      Free* const block = free_[n];
      free_[n] = block->next;
      return block;
    }
    void* const block = std::malloc(n < kClasses ? std::size_t{32} << n : size);
    if (block == nullptr) std::abort();  // GMP has no other way
    return block;
  }

  static void release(void* block, std::size_t size) {
    const std::size_t n = class_of(size);
    if (n >= kClasses) return std::free(block);
    free_[n] = new (block) Free{free_[n]};
  }

  static void* reallocate(void* block, std::size_t old_size, std::size_t new_size) {
    if (class_of(old_size) == class_of(new_size) && class_of(new_size) < kClasses) return block;
    void* const moved = allocate(new_size);
    std::memcpy(moved, block, std::min(old_size, new_size));
    release(block, old_size);
    return moved;
  }

  static inline std::array<Free*, kClasses> free_{};
};

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_GMP_MEMORY_HPP
