// SPDX-License-Identifier: Apache-2.0
//
// The named checks of `surefill certify`: what each claims, and how it decides one case.
#ifndef SUREFILL_CERTIFY_CHECKS_HPP
#define SUREFILL_CERTIFY_CHECKS_HPP

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "certify/judge/images.hpp"
#include "certify/run/judge.hpp"
#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::certify {

enum class Level { quick, standard, thorough };

inline const char* level_name(Level level) {
  return level == Level::quick ? "quick" : level == Level::standard ? "standard" : "thorough";
}

struct Settings {
  Level level = Level::quick;
  std::uint64_t seed = 1;
  std::string corpus;  // folder of cases/ and meshes/
  properties::Renderer engine;
  Support support;  // of the engine
};

using judge::Deviation;
using judge::Deviations;

struct CaseResult {
  std::uint64_t samples = 0;  // judged
  std::uint64_t open = 0;     // not, since the model leaves them open (R1)
  std::uint64_t differences = 0;
  bool skipped = false;                        // not applicable: nothing of it is owed, or a mode is lacking
  Deviations deviations;                       // of a rival whose profile is not exact
  std::string finding;                         // one line, where it differs
  std::optional<corpus::Scene> scene;          // that shows it, where there is one
  std::optional<properties::Exhibit> exhibit;  // its picture, where the two images of the scene are none
};

// A check is a number of cases, each a function of its number and the seed alone, so they may run in any order and at
// once.
struct Check {
  std::string name, rule, claim;
  std::string unit = "cases";
  // Reads what the check needs and says how many cases there are. Throws SceneError, MeshError. Called once, before
  // `run`.
  std::function<std::uint64_t()> prepare;
  bool exhaustive = false;  // the cases are all there are; else they are drawn by the seed
  double cost = 1e-4;       // seconds a case, roughly: for estimates of the time left only
  std::function<CaseResult(std::uint64_t number)> run;
  // The scene that a case looks at, as it is; empty where cases are none.
  std::function<corpus::Scene(std::uint64_t number)> scene_of;
  // Does a simpler scene show a difference of this kind, too? Empty: a finding is kept as it is.
  std::function<bool(const corpus::Scene&)> still_fails;
  std::string replay_option;  // that `surefill replay` needs to show the difference
  std::string group;          // the verdict that it belongs to, where there are several
  // The first difference on a scene in words; empty: as `judge` has it.
  std::function<std::string(const corpus::Scene&)> describe;
  // Not empty: the run ends here, and this is why. Asked after each case.
  std::function<std::string()> stopped;
  // The picture that a finding on a scene has; empty, or none: the two images of that scene.
  std::function<std::optional<properties::Exhibit>(const corpus::Scene&)> exhibit;
  // Who is held against whom, for pictures of a finding.
  properties::Renderer expected, actual;
};

// A check that still needs its cases.
Check make_check(const std::string& name, const std::string& rule, const std::string& claim);

// All of them, in the order in which they run. `settings` must outlive them.
std::vector<Check> list_checks(const Settings& settings);

// The seed of a case: a function of the run's seed, the name of the check and the number, so that the cases of a check
// do not depend on which others run.
std::uint64_t case_seed(std::uint64_t seed, std::string_view check, std::uint64_t number);

// The parts of the list that have their own files.
void add_mesh_checks(const Settings& settings, std::vector<Check>& checks);
void add_contract_checks(const Settings& settings, std::vector<Check>& checks);
void add_argument_check(const Settings& settings, std::vector<Check>& checks);

// One of three by level.
template <typename Value>
Value by_level(Level level, Value quick, Value standard, Value thorough) {
  return level == Level::quick ? quick : level == Level::standard ? standard : thorough;
}

// The outcome of a case that compares two renderers on a scene.
CaseResult compare_case(const corpus::Scene& scene, const properties::Renderer& expected,
                        const properties::Renderer& actual);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_CHECKS_HPP
