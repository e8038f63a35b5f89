// SPDX-License-Identifier: Apache-2.0
#include "engine/tests/path_cases.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {
namespace {

#ifdef SUREFILL_CASES_SHARE
constexpr std::uint64_t kCasesShare = SUREFILL_CASES_SHARE;
#else
constexpr std::uint64_t kCasesShare = 1;
#endif

class PathCase : public testing::TestWithParam<PathCases> {};

TEST_P(PathCase, EqualsTheReference) {
  for (std::uint64_t number = 0; number < GetParam().tested / kCasesShare + 1; ++number) {
    const PathScene scene = GetParam().make(number);
    ASSERT_EQ(broken_path(scene, draw_path(scene, {.path = Path::reference})), "")
        << GetParam().name << ", case " << number << ", threads " << scene.threads << '\n'
        << corpus::write_scene(scene.scene);
  }
}

// Where identifiers are shared, too. Sampled, 4,000 cases, seeds 0 to 3,999.
TEST(PathCaseOfTheReference, EqualsTheOracle) {
  for (std::uint64_t number = 0; number < 4000 / kCasesShare; ++number) {
    const PathScene scene = all_path_cases()[0].make(number);
    const Comparison result = compare(scene.scene, engine_renderer(), oracle_renderer(), scene.outputs);
    ASSERT_EQ(result.differences, 0u) << "case " << number << '\n' << corpus::write_scene(scene.scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, PathCase, testing::ValuesIn(all_path_cases()),
                         [](const auto& cases) { return std::string(cases.param.name); });

}  // namespace
}  // namespace surefill::properties
