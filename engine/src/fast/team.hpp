// SPDX-License-Identifier: Apache-2.0
//
// The threads of one call: they start with it, wait between its phases and end with it; or the caller's.
#ifndef SUREFILL_SRC_FAST_TEAM_HPP
#define SUREFILL_SRC_FAST_TEAM_HPP

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

#include "float_environment.hpp"
#include "hwy/cache_control.h"
#include "surefill/surefill.hpp"

namespace surefill::fast {

class Team {
 public:
  // If fewer threads can be started, fewer do the work.
  Team(int threads, const Executor& executor) : executor_(executor) {
    if (executor_.run != nullptr) return;
    for (; others_ < std::min(threads, kMaxThreads) - 1; ++others_) {
      try {
        threads_[others_] = std::thread([this] { serve(); });
      } catch (...) {
        break;
      }
    }
  }
  ~Team() {
    call_ = nullptr;
    if (others_ > 0) release();
    for (int i = 0; i < others_; ++i) threads_[i].join();
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  // work(item) for item = 0 .. items - 1, in any order, on all threads, this one among them.
  template <typename Work>
  void run(std::size_t items, const Work& work) {
    if (executor_.run != nullptr) {
      const auto task = [](void* argument, std::size_t item) {
        const FloatEnvironment environment;
        call(*static_cast<const Work*>(argument), item);
      };
      executor_.run(executor_.context, items, task, const_cast<Work*>(&work));
      return;
    }
    if (others_ == 0 || items < 2) {
      for (std::size_t item = 0; item < items; ++item) work(item);
      return;
    }
    call_ = [](const void* data, std::size_t item) { call(*static_cast<const Work*>(data), item); };
    data_ = &work;
    items_ = items;
    next_.store(0, std::memory_order_relaxed);
    busy_.store(others_, std::memory_order_relaxed);
    release();
    take_items();
    for (int busy = busy_.load(std::memory_order_acquire); busy != 0; busy = busy_.load(std::memory_order_acquire)) {
      if (!spin([&] { return busy_.load(std::memory_order_acquire) == 0; })) busy_.wait(busy);
    }
  }

 private:
  // Not inlined: it runs after the floating-point state is set.
  template <typename Work>
  [[gnu::noinline]] static void call(const Work& work, std::size_t item) {
    work(item);
  }

  void release() {
    phase_.fetch_add(1, std::memory_order_release);
    phase_.notify_all();
  }

  void serve() {
    const FloatEnvironment environment;
    for (std::uint32_t phase = 0;; ++phase) {
      const auto changed = [&] { return phase_.load(std::memory_order_acquire) != phase; };
      if (!spin(changed)) phase_.wait(phase, std::memory_order_acquire);
      if (call_ == nullptr) return;
      take_items();
      if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
    }
  }

  void take_items() {
    for (std::size_t item = next_++; item < items_; item = next_++) call_(data_, item);
  }

  // Phases follow each other within microseconds: a short wait is not worth a system call.
  template <typename Done>
  static bool spin(const Done& done) {
    for (int i = 0; i < 300; ++i) {
      if (done()) return true;
      hwy::Pause();
    }
    return false;
  }

  const Executor executor_;
  std::thread threads_[kMaxThreads];
  int others_ = 0;
  void (*call_)(const void*, std::size_t) = nullptr;
  const void* data_ = nullptr;
  std::size_t items_ = 0;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::uint32_t> phase_{0};
  std::atomic<int> busy_{0};
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_TEAM_HPP
