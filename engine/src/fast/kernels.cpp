// SPDX-License-Identifier: Apache-2.0
//
// The vector code, compiled once for each instruction set; the best one that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/kernels.cpp"
#include "hwy/foreach_target.h"
// The vector code includes Highway only after the loop above.
#include <bit>
#include <cstring>

#include "build_check.hpp"
#include "exact/exact_draw.hpp"
#include "exact/grid.hpp"
#include "fast/batch.hpp"
#include "fast/tile.hpp"
#include "hwy/base.h"
#include "hwy/cache_control.h"
// Where the instruction set is chosen at run time, few machines lack AVX2: the code for those is kept small. All that the
// sets share is included before, so that it is not.
#undef SUREFILL_KEEP_SMALL
#if HWY_ARCH_X86 && defined(__OPTIMIZE__) && !defined(__clang__) && !defined(HWY_COMPILE_ONLY_SCALAR)
#define SUREFILL_KEEP_SMALL (HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SCALAR)
#else
#define SUREFILL_KEEP_SMALL 0
#endif
#if SUREFILL_KEEP_SMALL
#pragma GCC push_options
#pragma GCC optimize("Os")
#endif
#include "fast/draw_tile-inl.hpp"
#include "fast/records-inl.hpp"
#include "fast/shade-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {

// As is_exact_build: compilers contract intrinsics, too.
template <typename T>
HWY_NOINLINE bool Holds() {
  const hn::ScalableTag<T> d;
  ContractionProbe<T> p;
  // Lane by lane: of one number in all lanes a compiler may work out the product as a scalar, and contract nothing.
  const auto lanes = [d](const volatile T& number) {
    HWY_ALIGN T values[hn::MaxLanes(d)];
    for (T& value : values) value = number;
    return hn::Load(d, values);
  };
  const auto x0 = lanes(p.x), x1 = lanes(p.x), x2 = lanes(p.x), x3 = lanes(p.x);
  const auto square = lanes(p.square), minus_square = hn::Neg(lanes(p.square));
  const auto one = lanes(p.one), small = lanes(p.small);
  const auto subtracted = hn::Sub(hn::Mul(x0, x0), square);  // all are 0 as they are written
  const auto negated = hn::Sub(square, hn::Mul(x1, x1));
  const auto added = hn::Add(hn::Mul(x2, x2), minus_square);
  const auto of_products = hn::Sub(hn::Mul(x3, x3), hn::Mul(one, square));
  const auto reordered = hn::Sub(hn::Add(one, small), one);
  const auto zero = hn::Zero(d);
  return hn::AllTrue(d, hn::And(hn::And(hn::And(hn::Eq(subtracted, zero), hn::Eq(negated, zero)),
                                        hn::And(hn::Eq(added, zero), hn::Eq(of_products, zero))),
                                hn::Eq(reordered, zero)));
}

bool IsExact() {
  static const bool exact = Holds<float>() && Holds<double>();
  return exact;
}

const Kernels* ThisTarget() {
  static const Kernels kernels{SetUp, DrawTiles, Shade, hwy::TargetName(HWY_TARGET), IsExact};
  return &kernels;
}

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#if SUREFILL_KEEP_SMALL
#pragma GCC pop_options
#endif

#if HWY_ONCE
namespace surefill::fast {

HWY_EXPORT(ThisTarget);

const Kernels& kernels() {
  return *HWY_DYNAMIC_DISPATCH(ThisTarget)();
}

}  // namespace surefill::fast
#endif
