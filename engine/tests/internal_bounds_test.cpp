// SPDX-License-Identifier: Apache-2.0
//
// Sampled, 200,000 cases, seeds 0 to 199,999.
#include "engine/tests/internal_bounds.hpp"

#include <gtest/gtest.h>

namespace surefill::properties {
namespace {

TEST(InternalBounds, Hold) {
  for (std::uint64_t n = 0; n < 200000; ++n) ASSERT_EQ(InternalBounds(n).broken(), "") << "case " << n;
}

}  // namespace
}  // namespace surefill::properties
