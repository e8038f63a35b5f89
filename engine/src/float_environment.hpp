// SPDX-License-Identifier: Apache-2.0
//
// The floating-point state that the engine's proofs assume (B4): round to nearest, ties to even, subnormals kept on
// input and output. Set on entry of every public call, restored on exit together with the caller's exception flags.
#ifndef SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP
#define SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP

#include <cfenv>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace surefill {

#if defined(__SSE2__)

// MXCSR: all exceptions masked (0x1F80), rounding control nearest, FTZ and DAZ off.
class FloatEnvironment {
 public:
  FloatEnvironment() : saved_(_mm_getcsr()) { _mm_setcsr(0x1F80u); }
  ~FloatEnvironment() { _mm_setcsr(saved_); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  unsigned saved_;
};

#elif defined(__aarch64__)

// FPCR 0: round to nearest, flush-to-zero off, no traps.
class FloatEnvironment {
 public:
  FloatEnvironment() {
    asm volatile("mrs %0, fpcr" : "=r"(saved_control_));
    asm volatile("mrs %0, fpsr" : "=r"(saved_status_));
    asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{0}));
  }
  ~FloatEnvironment() {
    asm volatile("msr fpcr, %0" : : "r"(saved_control_));
    asm volatile("msr fpsr, %0" : : "r"(saved_status_));
  }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  std::uint64_t saved_control_ = 0, saved_status_ = 0;
};

#else

// Elsewhere standard C++ has to do: it knows the rounding mode, and FE_DFL_ENV has subnormals.
class FloatEnvironment {
 public:
  FloatEnvironment() {
    std::feholdexcept(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatEnvironment() { std::fesetenv(&saved_); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  std::fenv_t saved_;
};

#endif

}  // namespace surefill

#endif  // SUREFILL_SRC_FLOAT_ENVIRONMENT_HPP
