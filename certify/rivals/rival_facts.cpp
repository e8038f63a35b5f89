// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/rival_facts.hpp"

#include <algorithm>

#include "certify/judge/lines.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/line_checks.hpp"
#include "certify/rivals/names.hpp"
#include "certify/rivals/rival_checks.hpp"

namespace surefill::certify {

namespace {

// What the faults that were found are called.
std::vector<std::string> names_of(const RivalSubject& subject, std::span<const CheckResult> results) {
  std::vector<corpus::Scene> scenes;
  for (const CheckResult& result : results) {
    if (result.failed == 0 || result.scene_text.empty()) continue;
    corpus::Scene scene = corpus::read_scene(result.scene_text);
    // What is wrong with lines and points the model says; who is like it is known of triangles.
    const bool triangles = std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
      return draw.primitive == Primitive::triangles;
    });
    if (triangles) scenes.push_back(std::move(scene));
  }
  const bool failed = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.failed > 0; });
  // Of one whose model nobody knows little is owed: what is odd about it is said all the same, as notes.
  if (subject.rival->given_up()) return explain_deaths(subject);
  if (!failed && subject.terms.known) return {};
  return explain_rival(subject, scenes);
}

}  // namespace

void add_rival_facts(const RivalSubject& subject, const surefill_adapter_model& declared, Facts& facts) {
  const adapters::Rival& rival = *subject.rival;
  facts.rival = rival.info().name;
  facts.rival_version = rival.info().version;
  facts.declared_model = rival.stated()     ? judge::describe(*rival.stated())
                         : subject.declared ? adapters::describe_model(declared)
                                            : "none";
  const judge::Inference& found = subject.inference.judged;
  facts.inferred_model = subject.inference.fits ? adapters::describe_model(subject.inference.model)
                         : found.known          ? judge::describe(found.model)
                         : found.shape.empty()  ? "none fits"
                                                : "no samples that fit: " + found.shape;
  const bool section_6 = rival.info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN;
  facts.model = section_6             ? adapters::describe_model(rival.info().model)
                : subject.terms.known ? judge::describe(subject.terms.model)
                                      : "unknown";
  if (found.known) facts.departures = judge::departures(found.model);
  if (found.known) {
    for (const std::string& sentence : judge::describe_lines(found.model, primitives_of(rival))) {
      facts.departures.push_back(sentence);
    }
  }
  facts.departures.insert(facts.departures.begin(), subject.conventions.begin(), subject.conventions.end());
  if (!found.shape.empty() && found.known) facts.departures.insert(facts.departures.begin(), found.shape);
  facts.open = found.open;
  facts.turns = judge::turns_text(found.turns);
  facts.problems = subject.inference.problems;
  facts.problems.insert(facts.problems.end(), found.line_problems.begin(), found.line_problems.end());
}

Certificate unmet(Facts facts, const adapters::Rival& rival) {
  facts.rival = rival.info().name;
  facts.rival_version = rival.info().version;
  facts.declared_model = facts.inferred_model = facts.model = "unknown";
  CheckResult result;
  result.name = "probing";
  result.rule = "C2";
  result.claim = "it draws a few triangles in front of the eye";
  result.group = kInvariants;
  result.unit = "probes";
  result.exhaustive = true;
  result.cases = facts.shard.count;  // one a shard
  result.due = result.done = result.resume = result.failed = result.differences = 1;
  result.case_number = facts.shard.index - 1;
  result.finding = rival.why_given_up();
  return {facts, {result}};
}

void add_outcome(const RivalSubject& subject, std::span<const CheckResult> results, Facts& facts) {
  const bool complete =
      std::all_of(results.begin(), results.end(), [](const CheckResult& result) { return result.complete(); });
  if (!complete && subject.rival->given_up()) facts.stopped = subject.rival->why_given_up();
  if (!facts.interrupted) {
    const bool failed =
        std::any_of(results.begin(), results.end(), [](const CheckResult& result) { return result.failed > 0; });
    std::vector<std::string>& sentences = failed ? facts.names : facts.departures;
    for (const std::string& name : names_of(subject, results)) sentences.push_back(name);
  }
  std::string names;
  for (const std::string& name : not_challenged(subject)) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) facts.open.push_back("claimed, and not challenged by any case that was judged: " + names);
}

}  // namespace surefill::certify
