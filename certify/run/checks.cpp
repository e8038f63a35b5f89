// SPDX-License-Identifier: Apache-2.0
#include "certify/run/checks.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;
using properties::Renderer;

// What differs between two renderers goes on differing.
std::function<bool(const Scene&)> still_differs(const Renderer& expected, const Renderer& actual) {
  return [expected, actual](const Scene& scene) {
    return valid(scene) && judge(scene, expected, actual, 0).differences > 0;
  };
}

CaseResult skipped_case() {
  CaseResult result;
  result.skipped = true;
  return result;
}

void add_corpus_checks(const Settings& settings, std::vector<Check>& checks) {
  const auto scenes = std::make_shared<std::vector<std::pair<std::string, Scene>>>();
  const auto prepare = [&settings, scenes] {
    if (scenes->empty()) {
      for (const std::string& path : corpus::list_corpus(settings.corpus + "/cases")) {
        scenes->emplace_back(path, corpus::read_scene_file(path));
      }
    }
    return std::uint64_t{scenes->size()};
  };
  const auto case_of = [scenes](std::uint64_t number, const Renderer& expected, const Renderer& actual) {
    const auto& [path, scene] = (*scenes)[number];
    CaseResult result = compare_case(scene, expected, actual);
    if (result.differences > 0) result.finding = path.substr(path.rfind('/') + 1) + ": " + result.finding;
    return result;
  };

  Check engine = make_check("corpus", "all rules", "engine = oracle on every scene of the corpus");
  engine.unit = "scenes";
  engine.prepare = prepare;
  engine.exhaustive = true;
  engine.cost = 2e-4;
  engine.run = [&settings, scenes, case_of](std::uint64_t number) {
    if (!supported((*scenes)[number].second, settings.support)) return skipped_case();
    return case_of(number, properties::oracle_renderer(), settings.engine);
  };
  engine.still_fails = still_differs(properties::oracle_renderer(), settings.engine);
  engine.scene_of = [scenes](std::uint64_t number) { return (*scenes)[number].second; };
  checks.push_back(std::move(engine));

  Check second = make_check("corpus-second-oracle", "all rules",
                            "oracle = second oracle, which goes another way, on every scene of the corpus");
  second.unit = "scenes";
  second.prepare = prepare;
  second.exhaustive = true;
  second.cost = 4e-4;
  second.run = [scenes, case_of](std::uint64_t number) {
    return case_of(number, properties::oracle_renderer(), properties::clipped_oracle_renderer());
  };
  second.still_fails = still_differs(properties::oracle_renderer(), properties::clipped_oracle_renderer());
  second.scene_of = [scenes](std::uint64_t number) { return (*scenes)[number].second; };
  second.replay_option = "--second-oracle";
  checks.push_back(std::move(second));
}

void add_random_checks(const Settings& settings, std::vector<Check>& checks) {
  for (const properties::Category& category : properties::categories()) {
    Check check = make_check(std::string("random-") + category.name, "C, F, I, V",
                             std::string("engine = oracle, all outputs: ") + category.aims);
    check.unit = "scenes";
    const std::uint64_t cases = by_level<std::uint64_t>(settings.level, 1000, 15000, 500000);
    check.prepare = [cases] { return cases; };
    check.cost = 3e-4;
    check.scene_of = [&settings, &category, name = check.name](std::uint64_t number) {
      properties::SceneLimits limits;
      limits.samples = settings.support.samples;
      limits.grid = settings.support.grid;
      limits.conservative = settings.support.conservative;
      return properties::random_scene(category, case_seed(settings.seed, name, number), limits);
    };
    check.run = [&settings, scene_of = check.scene_of](std::uint64_t number) {
      const Scene scene = scene_of(number);
      if (!supported(scene, settings.support)) return skipped_case();
      return compare_case(scene, properties::oracle_renderer(), settings.engine);
    };
    check.still_fails = still_differs(properties::oracle_renderer(), settings.engine);
    checks.push_back(std::move(check));
  }

  Check check = make_check(
      "random-second-oracle", "all rules",
      "oracle = second oracle, over all categories and modes (samples, grid, conservative, depth, fill rules)");
  check.unit = "scenes";
  const std::uint64_t cases = by_level<std::uint64_t>(settings.level, 3000, 60000, 2000000);
  check.prepare = [cases] { return cases; };
  check.cost = 1.8e-3;
  check.scene_of = [&settings, name = check.name](std::uint64_t number) {
    properties::SceneLimits limits;
    limits.samples = limits.grid = limits.conservative = true;
    const auto categories = properties::categories();
    return properties::random_scene(categories[number % categories.size()], case_seed(settings.seed, name, number),
                                    limits);
  };
  check.run = [scene_of = check.scene_of](std::uint64_t number) {
    return compare_case(scene_of(number), properties::oracle_renderer(), properties::clipped_oracle_renderer());
  };
  check.still_fails = still_differs(properties::oracle_renderer(), properties::clipped_oracle_renderer());
  check.replay_option = "--second-oracle";
  checks.push_back(std::move(check));
}

void add_property_checks(const Settings& settings, std::vector<Check>& checks) {
  for (const properties::Property& property : properties::all_properties()) {
    Check check = make_check(property.name, property.rule, property.claim);
    check.cost = 2e-4;
    const std::uint64_t sampled = by_level<std::uint64_t>(settings.level, 800, 12000, 400000);
    // Small worlds are walked through whole where the level has the time.
    const std::uint64_t affordable = by_level<std::uint64_t>(settings.level, 20000, 2000000, ~std::uint64_t{0});
    check.exhaustive = property.exhaustive > 0 && property.exhaustive <= affordable;
    const std::uint64_t cases = check.exhaustive ? property.exhaustive : property.exhaustive > 0 ? affordable : sampled;
    check.prepare = [cases] { return cases; };
    check.scene_of = [&settings, &property, exhaustive = check.exhaustive](std::uint64_t number) {
      std::uint64_t seed = number;
      if (!exhaustive) seed = case_seed(settings.seed, property.name, number);
      if (!exhaustive && property.exhaustive > 0) seed %= property.exhaustive;
      return property.make(seed);
    };
    check.run = [&settings, &property, scene_of = check.scene_of](std::uint64_t number) {
      Scene scene = scene_of(number);
      if (!supported(scene, settings.support)) return skipped_case();
      properties::TrialResult verdict = property.decide(scene, settings.engine);
      CaseResult result;
      result.samples = verdict.samples;
      result.differences = verdict.differences;
      if (verdict.differences > 0) {
        result.finding = std::move(verdict.finding);
        result.scene = std::move(scene);
      }
      return result;
    };
    if (property.simplifies) {
      check.still_fails = [&settings, &property](const Scene& scene) {
        return valid(scene) && property.decide(scene, settings.engine).differences > 0;
      };
      check.describe = [&settings, &property](const Scene& scene) {
        return valid(scene) ? property.decide(scene, settings.engine).finding : std::string();
      };
      check.exhibit = [&settings, &property](const Scene& scene) {
        return properties::exhibit_of(property, scene, settings.engine);
      };
    } else {
      check.still_fails = still_differs(properties::oracle_renderer(), settings.engine);
    }
    checks.push_back(std::move(check));
  }
}

}  // namespace

std::uint64_t case_seed(std::uint64_t seed, std::string_view check, std::uint64_t number) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a of the name
  for (const char c : check) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  properties::Random random(seed ^ hash);
  properties::Random mixed(random.bits() + number);
  return mixed.bits();
}

Check make_check(const std::string& name, const std::string& rule, const std::string& claim) {
  Check check;
  check.name = name;
  check.rule = rule;
  check.claim = claim;
  return check;
}

CaseResult compare_case(const Scene& scene, const Renderer& expected, const Renderer& actual) {
  const properties::Comparison comparison = judge(scene, expected, actual);
  CaseResult result;
  result.samples = comparison.samples;
  result.differences = comparison.differences;
  if (comparison.differences > 0) {
    if (!comparison.first.empty()) result.finding = describe_finding(comparison.first.front(), scene.samples);
    result.scene = scene;
  }
  return result;
}

std::vector<Check> list_checks(const Settings& settings) {
  std::vector<Check> checks;
  add_corpus_checks(settings, checks);
  add_mesh_checks(settings, checks);
  add_random_checks(settings, checks);
  add_property_checks(settings, checks);
  add_contract_checks(settings, checks);
  for (Check& check : checks) {
    check.expected = properties::oracle_renderer();
    check.actual = check.replay_option == "--second-oracle" ? properties::clipped_oracle_renderer() : settings.engine;
  }
  return checks;
}

}  // namespace surefill::certify
