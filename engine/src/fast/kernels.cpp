// SPDX-License-Identifier: Apache-2.0
//
// The vector code, compiled once for each instruction set; the best one that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/kernels.cpp"
#include "hwy/foreach_target.h"
// The vector code includes Highway only after the loop above.
#include "build_check.hpp"
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
  const auto x0 = hn::Set(d, p.x), x1 = hn::Set(d, p.x), x2 = hn::Set(d, p.x), x3 = hn::Set(d, p.x);
  const auto square = hn::Set(d, p.square), minus_square = hn::Set(d, -p.square);
  const auto one = hn::Set(d, p.one), small = hn::Set(d, p.small);
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

#if HWY_ONCE
namespace surefill::fast {

HWY_EXPORT(ThisTarget);

const Kernels& kernels() {
  return *HWY_DYNAMIC_DISPATCH(ThisTarget)();
}

}  // namespace surefill::fast
#endif
