// SPDX-License-Identifier: Apache-2.0
//
// The zoo's own rules. That every specimen is killed is shown by `surefill-zoo`, which ./dev test runs.
#include "mutation/zoo/zoo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "properties/machinery/properties.hpp"
#include "properties/machinery/reduce.hpp"

namespace surefill::properties {
namespace {

const Property* property_named(std::string_view name) {
  for (const Property& property : all_properties())
    if (name == property.name) return &property;
  return nullptr;
}

const zoo::Specimen* specimen_named(std::string_view name) {
  for (const zoo::Specimen& specimen : zoo::specimens())
    if (name == specimen.name) return &specimen;
  return nullptr;
}

TEST(Zoo, HasSpecimensOfDifferentNamesThatNameAProperty) {
  std::set<std::string_view> names;
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    EXPECT_TRUE(names.insert(specimen.name).second) << specimen.name;
    EXPECT_FALSE(std::string_view(specimen.fault).empty()) << specimen.name;
    EXPECT_NE(property_named(specimen.named_by), nullptr) << specimen.name << ": " << specimen.named_by;
  }
  EXPECT_GE(names.size(), 64u);
}

// The other way round from `surefill-zoo`: a few of each theme, killed at once.
TEST(Zoo, BlatantSpecimensDieEarly) {
  for (const char* name : {"edges-inclusive", "behind-dropped", "float-edges", "affine", "depth-one-ulp", "later-wins",
                           "samples-alike", "grid-ignored", "over-as-covered"}) {
    const zoo::Specimen* specimen = specimen_named(name);
    ASSERT_NE(specimen, nullptr) << name;
    const Property& property = *property_named(specimen->named_by);
    std::uint64_t n = 0;
    Verdict verdict;
    while (n < 500 && verdict.differences == 0)
      verdict = property.decide(sampled_case(property, n++), specimen->render);
    EXPECT_NE(verdict.differences, 0u) << name << " survives 500 cases of " << property.name;
    EXPECT_FALSE(verdict.finding.empty()) << name;
  }
}

TEST(Zoo, AFindingReducesToOneTriangle) {
  const Property& property = *property_named("equality-coverage");
  const zoo::Specimen& specimen = *specimen_named("nan-as-zero");
  const auto fails = [&](const corpus::Scene& scene) {
    return property.decide(scene, specimen.render).differences != 0;
  };
  std::uint64_t n = 0;
  while (n < 2000 && !fails(property.make(n))) ++n;
  ASSERT_LT(n, 2000u);
  const corpus::Scene reduced = reduce(property.make(n), fails);
  ASSERT_EQ(reduced.draws.size(), 1u);
  EXPECT_EQ(reduced.draws[0].triangles.size(), 1u) << corpus::write_scene(reduced);
}

}  // namespace
}  // namespace surefill::properties
