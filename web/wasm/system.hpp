// SPDX-License-Identifier: Apache-2.0
//
// Included before every file. The C++ library of WebAssembly here is for a system without threads, and leaves out the classes
// that are about them: here they are, for one thread.
#ifndef SUREFILL_WEB_SYSTEM_HPP
#define SUREFILL_WEB_SYSTEM_HPP

#ifdef __cplusplus
#include <chrono>
#include <mutex>

_LIBCPP_BEGIN_NAMESPACE_STD

class mutex {
 public:
  void lock() {}
  void unlock() {}
};

template <typename Mutex>
class unique_lock {
 public:
  explicit unique_lock(Mutex&) {}
  ~unique_lock() {}
  void unlock() {}
};

// Nobody has to be waited for: what was started has ended.
class condition_variable {
 public:
  void notify_one() {}
  template <typename Lock, typename Duration, typename Predicate>
  bool wait_for(Lock&, const Duration&, const Predicate& holds) {
    return holds();
  }
};

class thread {
 public:
  thread() = default;
  template <typename Work>
  explicit thread(const Work& work) {
    work();
  }
};
using jthread = thread;

_LIBCPP_END_NAMESPACE_STD
#endif

#endif  // SUREFILL_WEB_SYSTEM_HPP
