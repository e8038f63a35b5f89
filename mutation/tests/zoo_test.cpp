// SPDX-License-Identifier: Apache-2.0
//
// The zoo's own rules. That every specimen is killed is shown by `surefill-zoo`, which ./dev test runs.
#include "mutation/zoo/zoo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
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
    TrialResult verdict;
    while (n < 500 && verdict.differences == 0)
      verdict = property.decide(sampled_case(property, n++), specimen->render);
    EXPECT_NE(verdict.differences, 0u) << name << " survives 500 cases of " << property.name;
    EXPECT_FALSE(verdict.finding.empty()) << name;
  }
}

// Their faults are of three indices a primitive: to read a line so would read past its list.
TEST(Zoo, SpecimensOfTrianglesDrawLinesAndPointsRight) {
  const Property& property = *property_named("equality-lines");
  const std::size_t of_triangles = zoo::specimens().size() - zoo::line_specimens().size();
  std::size_t drawn = 0;
  for (std::uint64_t n = 0; n < 12; ++n) {
    const corpus::Scene scene = sampled_case(property, n);
    const auto is_of_lines = [](const corpus::SceneDraw& draw) { return draw.primitive != Primitive::triangles; };
    if (std::none_of(scene.draws.begin(), scene.draws.end(), is_of_lines)) continue;
    for (const zoo::Specimen& specimen : zoo::specimens().first(of_triangles)) {
      const TrialResult verdict = property.decide(scene, specimen.render);
      EXPECT_EQ(verdict.differences, 0u) << specimen.name << ", case " << n << ": " << verdict.finding;
    }
    ++drawn;
  }
  EXPECT_GE(drawn, 8u);
}

// The first number of `finding` after `word`; none where no number stands there.
std::optional<long> number_after(const std::string& finding, const std::string& word) {
  const std::size_t at = finding.find(word);
  if (at == std::string::npos) return std::nullopt;
  const char* begin = finding.c_str() + at + word.size();
  char* end = nullptr;
  const long value = std::strtol(begin, &end, 10);
  // "at most 1" in the picture is 1; a decimal or a hexfloat is of another output.
  if (end == begin || *end == '.' || *end == 'x') return std::nullopt;
  return value;
}

// What a finding says of a pixel is what its picture shows there: for each property that has pictures of its own, on a
// finding of every specimen that it kills early.
TEST(Zoo, PicturesShowWhatFindingsSay) {
  std::set<std::string_view> shown, properties;
  for (const Property& property : all_properties()) {
    if (property.needs_oracle || !property.simplifies) continue;
    if (property.name == std::string_view("numbers-add-up")) continue;  // sums of a whole frame are of no pixel
    properties.insert(property.name);
    for (const zoo::Specimen& specimen : zoo::specimens()) {
      // What these draw depends on the frame before.
      if (std::string_view(specimen.name) == "race" || std::string_view(specimen.name) == "state-left-over") continue;
      const std::uint64_t cases = property.name == std::string_view(specimen.named_by) ? 400 : 6;
      for (std::uint64_t n = 0; n < affordable_cases(property, cases); ++n) {
        const corpus::Scene scene = sampled_case(property, n);
        const TrialResult verdict = property.decide(scene, specimen.render);
        if (verdict.differences == 0) continue;
        const std::string& said = verdict.finding;
        const std::size_t pixel = said.find(" at pixel (");
        if (pixel == std::string::npos) continue;  // another status than ok
        SCOPED_TRACE(std::string(property.name) + ", " + specimen.name + ", case " + std::to_string(n) + ": " + said);
        const auto exhibit = exhibit_of(property, scene, specimen.render);
        ASSERT_TRUE(exhibit);
        const auto samples = static_cast<std::size_t>(exhibit->samples);
        const std::size_t total =
            static_cast<std::size_t>(exhibit->width) * static_cast<std::size_t>(exhibit->height) * samples;
        ASSERT_TRUE(exhibit->expected.size() == total && exhibit->actual.size() == total &&
                    exhibit->differs.size() == total);
        const auto x = static_cast<std::size_t>(number_after(said, " at pixel (").value_or(0));
        const auto y = static_cast<std::size_t>(number_after(said.substr(pixel + 11), ", ").value_or(0));
        const std::size_t first = (y * static_cast<std::size_t>(exhibit->width) + x) * samples;
        ASSERT_LT(first, total);
        const std::size_t at_most = said.find("expected at most ");
        const auto expected = number_after(said, at_most == std::string::npos ? "expected " : "expected at most ");
        const auto actual = number_after(said, "got ");
        bool marked = false, as_said = false;
        for (std::size_t s = first; s < first + samples; ++s) {
          marked = marked || exhibit->differs[s] != 0;
          as_said = as_said || (expected == exhibit->expected[s] && actual == exhibit->actual[s]);
        }
        EXPECT_TRUE(marked);
        EXPECT_TRUE(as_said || exhibit->output != "count");
        shown.insert(property.name);
        break;
      }
    }
  }
  EXPECT_EQ(shown, properties);
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
