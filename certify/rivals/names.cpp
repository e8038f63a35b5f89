// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/names.hpp"

#include <fmt/format.h>

#include <optional>

#include "certify/judge/symptoms.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "mutation/zoo/zoo.hpp"
#include "oracle/oracle.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;

constexpr std::size_t kScenes = 24, kTries = 1200;

}  // namespace

std::span<const judge::Fault> known_faults() {
  static const std::vector<judge::Fault> faults = [] {
    std::vector<judge::Fault> all;
    for (const zoo::Specimen& specimen : zoo::rival_specimens()) {
      all.push_back({specimen.name, specimen.fault, specimen.seen_in, specimen.render});
    }
    for (const zoo::Specimen& likeness : zoo::likenesses()) all.push_back({"", likeness.fault, "", likeness.render});
    return all;
  }();
  return faults;
}

namespace {

// Both images of a scene that is under the rival's model; none where either says that it is no frame.
std::optional<judge::Wrong> both(const RivalSubject& subject, const Scene& scene) {
  adapters::Rival& rival = *subject.rival;
  try {
    const corpus::Outputs outputs = outputs_with(rival, scene);
    corpus::Frame right(scene, outputs), actual(scene, outputs);
    if (validate(right.target(), right.draws()) != Status::ok) return std::nullopt;
    rival.draw(actual.target(), actual.draws());
    oracle::render(right.target(), right.draws());
    return judge::Wrong{scene, std::move(right.image()), std::move(actual.image())};
  } catch (const std::exception&) {
    return std::nullopt;  // what it does not draw shows no picture
  }
}

}  // namespace

std::vector<judge::Wrong> wrong_scenes(const RivalSubject& subject, std::span<const Scene> found, std::size_t most,
                                       std::vector<Scene>& fine) {
  adapters::Rival& rival = *subject.rival;
  std::vector<judge::Wrong> wrong;
  const auto look_at = [&](const Scene& original) {
    const Scene scene = adapters::scene_under_model(original, rival.info());
    try {
      const CaseResult result = judge_scene(scene, subject);
      if (result.differences == 0) {
        if (result.samples > 0 && fine.size() < most) fine.push_back(scene);
        return;
      }
    } catch (const std::exception&) {
      return;
    }
    if (std::optional<judge::Wrong> shown = both(subject, scene)) wrong.push_back(std::move(*shown));
  };
  for (const Scene& scene : found) {
    if (wrong.size() < most) look_at(scene);
  }
  for (std::size_t n = 0; n < kTries && (wrong.size() < most || n < 2 * most) && !rival.given_up(); ++n) {
    if (n >= kTries / 4 && wrong.empty() && found.empty()) break;
    look_at(random_rival_scene(subject, n, case_seed(1, "naming", n)));
  }
  return wrong;
}

std::vector<std::string> sentences_of(std::span<const judge::Name> names, std::span<const judge::Wrong> wrong,
                                      std::span<const Scene> fine, const judge::Trials& trials) {
  constexpr double kSure = 0.9;
  constexpr std::size_t kMost = 3;
  std::vector<std::string> sentences;
  // The best name, and those that explain as much.
  const auto add_names = [&] {
    for (const judge::Name& name : names) {
      if (name.agreement < names.front().agreement || sentences.size() == kMost) break;
      sentences.push_back(name_text(name));
    }
  };
  const bool sure = !names.empty() && names.front().agreement >= kSure;
  if (sure) add_names();
  for (const std::string& sentence : judge::symptoms(wrong, fine, trials)) {
    if (sentences.size() < kMost) sentences.push_back(sentence);
  }
  if (!sure) add_names();
  return sentences;
}

std::vector<std::string> explain_rival(const RivalSubject& subject, std::span<const Scene> found) {
  if (subject.rival->info().model.kind == SUREFILL_ADAPTER_MODEL_UNKNOWN) return {};
  std::vector<Scene> fine;
  const std::vector<judge::Wrong> wrong = wrong_scenes(subject, found, kScenes, fine);
  if (wrong.empty()) return {};
  const judge::Trials trials{[&subject](const Scene& scene) {
                               try {
                                 return !subject.rival->given_up() && judge_scene(scene, subject).differences > 0;
                               } catch (const std::exception&) {
                                 return false;
                               }
                             },
                             [&subject](const Scene& scene) { return both(subject, scene); }};
  return sentences_of(judge::name_fault(known_faults(), wrong, !subject.strict), wrong, fine, trials);
}

std::string name_text(const judge::Name& name) {
  std::string text = fmt::format("{} (explains {:.0f} % of it", name.fault->sentence, 100 * name.agreement);
  if (!name.fault->name.empty()) text += "; the zoo's " + name.fault->name;
  if (!name.fault->origin.empty()) text += ", seen in " + name.fault->origin;
  return text + ")";
}

}  // namespace surefill::certify
