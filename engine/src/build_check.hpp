// SPDX-License-Identifier: Apache-2.0
//
// What the engine asks of its compiler: each operation on floats and doubles rounded once, to its own type, in the
// order in which it is written. What options tell is checked here. Contraction to fused operations is told by no macro:
// the build switches it off, and where sources were copied into another build, the first call finds out by trying.
#ifndef SUREFILL_SRC_BUILD_CHECK_HPP
#define SUREFILL_SRC_BUILD_CHECK_HPP

#include <cfloat>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error \
    "Surefill's images would be wrong: compile its sources without -ffast-math, -Ofast and their parts (add -fno-fast-math; programs that use the library may keep them)"
#endif

// 16 says so of _Float16 alone, which the engine does not use.
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error \
    "Surefill's images would be wrong: float and double must be computed in their own precision (FLT_EVAL_METHOD 0), on x86 with -msse2 -mfpmath=sse"
#endif

namespace surefill {

// Does scalar arithmetic hold what is asked for? Vector code has its own check, for each instruction set.
bool is_exact_build();

// Numbers that show contraction: x^2 is 1 + 2 s + s^2, rounded 1 + 2 s, as s^2 is half a last place or less. Volatile,
// so that the compiler works out nothing.
template <typename T>
struct ContractionProbe {
  static constexpr T kStep = sizeof(T) == 8 ? T(0x1p-27) : T(0x1p-12);
  volatile T x = 1 + kStep, square = 1 + 2 * kStep, one = 1, small = kStep * kStep / 4;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_BUILD_CHECK_HPP
