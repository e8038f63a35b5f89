// SPDX-License-Identifier: Apache-2.0
//
// The working memory of a call.
#ifndef SUREFILL_SRC_FAST_MEMORY_HPP
#define SUREFILL_SRC_FAST_MEMORY_HPP

#include <cstdlib>
#include <memory>
#include <new>

#include "fast/tile.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

namespace surefill::fast {

// Memory without exceptions, on cache lines; large pieces on large pages, where the system has them.
template <typename T>
class Buffer {
 public:
  // At least so many elements, of any value. False if there is no memory.
  bool reserve(std::size_t size) {
    if (size <= size_) return true;
    constexpr std::size_t kLargePage = std::size_t{1} << 21;
    const std::size_t bytes = size * sizeof(T);
    const std::size_t alignment = bytes >= kLargePage ? kLargePage : 128;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    size_ = 0;
    data_.reset();
    data_.reset(static_cast<T*>(allocate(alignment, rounded)));
    if (data_ == nullptr) return false;
#if defined(__linux__)
    if (alignment == kLargePage) madvise(data_.get(), rounded, MADV_HUGEPAGE);
#endif
    size_ = size;
    return true;
  }
  T* data() const {
    return data_.get();
  }
  T& operator[](std::size_t i) const {
    return data_[i];
  }

 private:
#if defined(_WIN32)  // whose C library has no aligned_alloc
  static void* allocate(std::size_t alignment, std::size_t size) {
    return _aligned_malloc(size, alignment);
  }
  struct Free {
    void operator()(T* data) const { _aligned_free(data); }
  };
#else
  static void* allocate(std::size_t alignment, std::size_t size) {
    return std::aligned_alloc(alignment, size);
  }
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
#endif
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0;
};

struct Memory {
  // The triangles of a chunk, and their lists.
  Buffer<Record> records;
  Buffer<std::uint32_t> begin;
  Buffer<std::uint16_t> items;
  Buffer<Scratch> scratch;  // of each thread
  // Tiles: all of the frame, or a row for each thread.
  Buffer<float> depth, far;
  Buffer<std::uint32_t> winner, count;
  Buffer<std::uint8_t> opened;
};

// A call's memory: that of a context, where it goes back, or its own.
class BorrowedMemory {
 public:
  explicit BorrowedMemory(Context* context) : context_(context) {
    if (context != nullptr) memory_.reset(static_cast<Memory*>(context->memory_.exchange(nullptr)));
    if (memory_ == nullptr) memory_.reset(new (std::nothrow) Memory);
  }
  // What a context that ends still holds.
  explicit BorrowedMemory(Context& last) : memory_(static_cast<Memory*>(last.memory_.exchange(nullptr))) {}
  ~BorrowedMemory() {
    if (context_ == nullptr) return;
    memory_.reset(
        static_cast<Memory*>(context_->memory_.exchange(memory_.release())));  // another call's, if it has some
  }
  BorrowedMemory(const BorrowedMemory&) = delete;
  BorrowedMemory& operator=(const BorrowedMemory&) = delete;

  Memory* get() const { return memory_.get(); }  // null if there is none

 private:
  Context* context_ = nullptr;
  std::unique_ptr<Memory> memory_;
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_MEMORY_HPP
