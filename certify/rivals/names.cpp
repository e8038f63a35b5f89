// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/names.hpp"

#include <fmt/format.h>

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
    for (const zoo::Specimen& specimen : zoo::specimens()) {
      all.push_back({specimen.name, specimen.fault, specimen.seen_in, specimen.render});
    }
    return all;
  }();
  return faults;
}

std::vector<judge::Wrong> wrong_scenes(const RivalSubject& subject, std::span<const Scene> found, std::size_t most) {
  adapters::Rival& rival = *subject.rival;
  std::vector<judge::Wrong> wrong;
  const auto look_at = [&](const Scene& original) {
    const Scene scene = adapters::scene_under_model(original, rival.info());
    try {
      if (judge_scene(scene, subject).differences == 0) return;
      const corpus::Outputs outputs = outputs_with(rival, scene);
      corpus::Frame right(scene, outputs), actual(scene, outputs);
      if (validate(right.target(), right.draws()) != Status::ok) return;
      rival.draw(actual.target(), actual.draws());
      oracle::render(right.target(), right.draws());
      wrong.push_back({scene, std::move(right.image()), std::move(actual.image())});
    } catch (const std::exception&) {
      // What it does not draw shows no picture.
    }
  };
  for (const Scene& scene : found) {
    if (wrong.size() < most) look_at(scene);
  }
  for (std::size_t n = 0; n < kTries && wrong.size() < most && !rival.given_up(); ++n) {
    if (n >= kTries / 4 && wrong.empty() && found.empty()) break;
    look_at(random_rival_scene(subject, n, case_seed(1, "naming", n)));
  }
  return wrong;
}

std::vector<judge::Name> name_rival(const RivalSubject& subject, std::span<const Scene> found) {
  if (subject.rival->info().model.kind == SUREFILL_ADAPTER_MODEL_UNKNOWN) return {};
  const std::vector<judge::Wrong> wrong = wrong_scenes(subject, found, kScenes);
  if (wrong.empty()) return {};
  return judge::name_fault(known_faults(), wrong, !subject.strict);
}

std::string name_text(const judge::Name& name) {
  std::string text = fmt::format("{} (explains {:.0f} % of it; the zoo's {}", name.fault->sentence,
                                 100 * name.agreement, name.fault->name);
  if (!name.fault->origin.empty()) text += ", seen in " + name.fault->origin;
  return text + ")";
}

}  // namespace surefill::certify
