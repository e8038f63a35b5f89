// SPDX-License-Identifier: Apache-2.0
//
// The floating-point state that the engine's proofs assume (B4): round to nearest, ties to even, subnormals kept on
// input and output, no traps. Set on entry of every public call, also for checks that look at floats; on exit the
// caller gets its own back, exception flags included.
#ifndef SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP
#define SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP

#include <atomic>
#include <cfenv>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "build_check.hpp"

namespace surefill {

// A thread's modes, traps and exception flags.
class FloatState {
 public:
#if defined(__SSE2__)

  static FloatState now() {
    return FloatState(_mm_getcsr());
  }
  static FloatState of_engine() {
    return FloatState(0x1F80);
  }
  void set() const {
    _mm_setcsr(control_);
  }
  unsigned flags() const {
    return control_ & 0x3F;
  }
  FloatState with_flags(unsigned flags) const {
    return FloatState(control_ | flags);
  }

 private:
  explicit FloatState(unsigned control) : control_(control) {}
  unsigned control_;  // MXCSR

#elif defined(__aarch64__)

  static FloatState now() {
    FloatState state;
    asm volatile("mrs %0, fpcr" : "=r"(state.control_));
    asm volatile("mrs %0, fpsr" : "=r"(state.status_));
    return state;
  }
  static FloatState of_engine() {
    return {};
  }
  void set() const {
    asm volatile("msr fpcr, %0" : : "r"(control_));
    asm volatile("msr fpsr, %0" : : "r"(status_));
  }
  unsigned flags() const {
    return static_cast<unsigned>(status_);
  }
  FloatState with_flags(unsigned flags) const {
    FloatState state = *this;
    state.status_ |= flags;
    return state;
  }

 private:
  std::uint64_t control_ = 0, status_ = 0;  // FPCR, FPSR

#else  // standard C++ has to do: it knows the rounding mode, and FE_DFL_ENV has subnormals

  static FloatState now() {
    FloatState state;
    std::fegetenv(&state.environment_);
    state.flags_ = static_cast<unsigned>(std::fetestexcept(FE_ALL_EXCEPT));
    return state;
  }
  static FloatState of_engine() {
    FloatState before = now(), state;
    std::fesetenv(FE_DFL_ENV);
    std::fegetenv(&state.environment_);
    before.set();
    return state;
  }
  void set() const {
    std::fesetenv(&environment_);
    std::feraiseexcept(static_cast<int>(flags_));
  }
  unsigned flags() const {
    return flags_;
  }
  FloatState with_flags(unsigned flags) const {
    FloatState state = *this;
    state.flags_ |= flags;
    return state;
  }

 private:
  std::fenv_t environment_{};
  unsigned flags_ = 0;

#endif
};

// The engine's state on this thread while it lives. Compilers know nothing of it and move arithmetic across: what
// needs the state is in a function that is not inlined.
class FloatEnvironment {
 public:
  FloatEnvironment() : before_(FloatState::now()) { FloatState::of_engine().set(); }
  ~FloatEnvironment() { before_.with_flags(raised_.load(std::memory_order_relaxed)).set(); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

  // Runs the caller's code in the state that was there before, on this thread or another one in the engine's state. The
  // flags that it raises are among those given back.
  template <typename Code>
  void leave_for(const Code& code) {
    before_.set();
    code();
    const unsigned flags = FloatState::now().flags();
    FloatState::of_engine().set();
    if ((flags & ~raised_.load(std::memory_order_relaxed)) != 0) raised_.fetch_or(flags, std::memory_order_relaxed);
  }

 private:
  const FloatState before_;
  std::atomic<unsigned> raised_{0};
};

}  // namespace surefill

#endif  // SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP
