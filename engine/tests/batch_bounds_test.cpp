// SPDX-License-Identifier: Apache-2.0
//
// Sampled, 25,000 cases for each instruction set, seeds 0 to 24,999.
#if !defined(SUREFILL_REFERENCE_ONLY)

#include "engine/tests/batch_bounds.hpp"

#include <gtest/gtest.h>

#include "hwy/targets.h"

namespace surefill::properties {
namespace {

#ifdef SUREFILL_CASES_SHARE
constexpr std::uint64_t kCasesShare = SUREFILL_CASES_SHARE;
#else
constexpr std::uint64_t kCasesShare = 1;
#endif

TEST(BatchBounds, Hold) {
  for (std::int64_t bits = hwy::SupportedTargets() & HWY_TARGETS; bits != 0; bits &= bits - 1) {
    const std::int64_t target = bits & -bits;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::uint64_t n = 0; n < 25000 / kCasesShare; ++n) {
      const std::string broken = BatchBounds(n).broken();
      EXPECT_EQ(broken, "") << hwy::TargetName(target) << ", case " << n;
      if (!broken.empty()) break;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

}  // namespace
}  // namespace surefill::properties

#endif
