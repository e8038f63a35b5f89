// SPDX-License-Identifier: Apache-2.0
//
// The vector code, compiled once for each instruction set; the best one that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/kernels.cpp"
#include "hwy/foreach_target.h"
// The vector code includes Highway only after the loop above.
#include "fast/draw_tile-inl.hpp"
#include "fast/records-inl.hpp"
#include "fast/shade-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {

const Kernels* ThisTarget() {
  static const Kernels kernels{SetUp, DrawTiles, Shade, hwy::TargetName(HWY_TARGET)};
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
