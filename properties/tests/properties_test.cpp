// SPDX-License-Identifier: Apache-2.0
//
// Every property of the registry, run against the engine: sampled ones through RapidCheck, exhaustive ones over all
// their cases. The seed is fixed unless RC_PARAMS says otherwise (RC_PARAMS="seed=7 max_success=1000" makes ten times
// as many).
#include "properties/machinery/properties.hpp"

#include <gtest/gtest.h>
// After gtest.
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "properties/machinery/reduce.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {

// A scene that RapidCheck shrinks by the steps of reduction.
struct Case {
  corpus::Scene scene;
};

void showValue(const Case& shown, std::ostream& out) {
  out << '\n' << corpus::write_scene(shown.scene);
}

namespace {

// Before RapidCheck reads it, once, at its first use.
const bool kSeedFixed = setenv("RC_PARAMS", "seed=20", 0) == 0;

// Of the cases below, one in so many is run.
#ifdef SUREFILL_CASES_SHARE
constexpr int kCasesShare = SUREFILL_CASES_SHARE;
#else
constexpr int kCasesShare = 1;
#endif

rc::Gen<std::uint64_t> any_number() {
  return rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>());
}

template <class Make>
rc::Gen<Case> scenes(const Make& make, bool simplifies) {
  rc::Gen<Case> made = rc::gen::map(rc::gen::noShrink(any_number()), [make](std::uint64_t n) { return Case{make(n)}; });
  if (!simplifies) return made;
  return rc::gen::shrink(std::move(made), [](const Case& failing) {
    std::vector<Case> simpler;
    for (corpus::Scene& scene : simpler_scenes(failing.scene)) simpler.push_back({std::move(scene)});
    return rc::seq::fromContainer(std::move(simpler));
  });
}

std::string report(const std::string& name, const std::string& claim, const TrialResult& verdict,
                   const corpus::Scene& scene) {
  std::ostringstream out;
  out << name << ": " << claim << "\n"
      << verdict.finding << " (" << verdict.differences << " differences in " << verdict.samples << " samples)\n"
      << "Save the scene as finding.scene and see both answers with: surefill replay finding.scene\n\n"
      << corpus::write_scene(scene);
  return out.str();
}

// Runs the generator under RapidCheck, for so many hundred cases (RC_PARAMS may multiply them).
template <class Decide>
void check_scenes(const rc::Gen<Case>& cases, int hundreds, const std::string& name, const std::string& claim,
                  const Decide& decide) {
  rc::detail::TestMetadata metadata;
  metadata.id = metadata.description = name;
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  params.maxSuccess = std::max(1, params.maxSuccess * hundreds / kCasesShare);
  const auto result = rc::detail::checkTestable(
      [&] {
        const Case drawn = *cases;
        const TrialResult verdict = decide(drawn.scene);
        if (verdict.differences != 0) RC_FAIL(report(name, claim, verdict, drawn.scene));
      },
      metadata, params);
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  FAIL() << message.str();
}

std::string test_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

class EngineHolds : public testing::TestWithParam<const Property*> {};

TEST_P(EngineHolds, InEveryCase) {
  const Property& property = *GetParam();
  const Renderer engine = engine_renderer();
  if (property.exhaustive == 0) {
    const std::string_view name = property.name;
    const int hundreds = name == "degree-spot" ? 3 : name == "equality-wide" ? 40 : 150;
    check_scenes(scenes(property.make, property.simplifies), hundreds, property.name, property.claim,
                 [&](const corpus::Scene& scene) { return property.decide(scene, engine); });
    return;
  }
  // Of the largest world a part; `surefill certify --level standard` walks through it whole.
  const std::uint64_t step = (property.exhaustive > 500000 ? 29u : 1u) * std::uint64_t{kCasesShare};
  for (std::uint64_t n = 0; n < property.exhaustive; n += step) {
    corpus::Scene scene = property.make(n);
    if (property.decide(scene, engine).differences == 0) continue;
    const auto fails = [&](const corpus::Scene& s) { return property.decide(s, engine).differences != 0; };
    if (property.simplifies) scene = reduce(std::move(scene), fails);
    FAIL() << "case " << n << "\n" << report(property.name, property.claim, property.decide(scene, engine), scene);
  }
}

std::vector<const Property*> pointers_to_all() {
  std::vector<const Property*> all;
  for (const Property& property : all_properties()) all.push_back(&property);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Properties, EngineHolds, testing::ValuesIn(pointers_to_all()),
                         [](const auto& tested) { return test_name(tested.param->name); });

// Two oracles that share no code, on everything that docs/semantics.md defines.
class OraclesAgree : public testing::TestWithParam<const Category*> {};

TEST_P(OraclesAgree, OnRandomScenes) {
  const Category& category = *GetParam();
  const auto make = [&category](std::uint64_t n) {
    SceneLimits limits;
    limits.max_size = n % 4 == 0 ? 12 : 6;
    limits.samples = limits.grid = limits.conservative = true;
    return random_scene(category, n, limits);
  };
  check_scenes(
      scenes(make, true), 5, category.name, "the oracle and the clipped oracle draw the same image",
      [](const corpus::Scene& scene) {
        const Comparison c = compare(scene, oracle_renderer(), clipped_oracle_renderer(), outputs_of(scene), 1);
        return TrialResult{c.samples, c.differences, c.first.empty() ? "" : describe(c.first[0], scene.samples)};
      });
}

std::vector<const Category*> pointers_to_categories() {
  std::vector<const Category*> all;
  for (const Category& category : categories()) all.push_back(&category);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Categories, OraclesAgree, testing::ValuesIn(pointers_to_categories()),
                         [](const auto& tested) { return test_name(tested.param->name); });

}  // namespace
}  // namespace surefill::properties
