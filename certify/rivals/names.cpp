// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "certify/judge/facts.hpp"
#include "certify/judge/images.hpp"
#include "certify/judge/symptoms.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/rivals/viewports.hpp"
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

// Values that are not the oracle's to the bit are alike within this, as a part of 1 or of their size.
constexpr double kWithin = 0x1p-9;

double within_of(const RivalSubject& subject) {
  return subject.strict ? 0 : kWithin;
}

// What the judge has nothing against is set right, so that what is left is wrong.
void set_right(const RivalSubject& subject, const corpus::Frame& frame, judge::Wrong& shown) {
  const Target& target = frame.target();
  const judge::Judgement judgement =
      judge::judge_image(adapters::oracle_expected(), subject.terms,
                         {target.width, target.height, target.samples, target.depth_test, !target.initial_depth.empty(),
                          frame.draws(), target.initial_depth},
                         shown.rival, {}, shown.scene.attributes);
  const std::size_t total = judgement.differs.size();
  const auto copy = [total](const auto& from, auto& to, std::size_t s) {
    if (from.empty() || from.size() != to.size()) return;
    const std::size_t n = from.size() / total;
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(n * s), n, to.begin() + static_cast<std::ptrdiff_t>(n * s));
  };
  const auto copy_alike = [total](const std::vector<float>& from, std::vector<float>& to, std::size_t s) {
    if (from.empty() || from.size() != to.size()) return;
    const std::size_t n = from.size() / total;
    for (std::size_t i = n * s; i < n * (s + 1); ++i) to[i] = judge::alike(from[i], to[i]) ? from[i] : to[i];
  };
  shown.open.assign(total, 0);
  for (std::size_t s = 0; s < total; ++s) {
    if (judgement.differs[s]) {
      copy_alike(shown.right.depth, shown.rival.depth, s);
      copy_alike(shown.right.barycentrics, shown.rival.barycentrics, s);
      for (std::size_t k = 0; k < std::min(shown.right.attributes.size(), shown.rival.attributes.size()); ++k) {
        copy_alike(shown.right.attributes[k], shown.rival.attributes[k], s);
      }
      continue;
    }
    shown.open[s] = judgement.unknown[s];
    copy(shown.right.count, shown.rival.count, s);
    copy(shown.right.index, shown.rival.index, s);
    copy(shown.right.depth, shown.rival.depth, s);
    copy(shown.right.barycentrics, shown.rival.barycentrics, s);
    for (std::size_t k = 0; k < std::min(shown.right.attributes.size(), shown.rival.attributes.size()); ++k) {
      copy(shown.right.attributes[k], shown.rival.attributes[k], s);
    }
  }
}

// Both images of a scene that is under the rival's model; none where either says that it is no frame.
std::optional<judge::Wrong> both(const RivalSubject& subject, const Scene& scene) {
  adapters::Rival& rival = *subject.rival;
  try {
    const corpus::Outputs outputs = outputs_with(rival, scene);
    corpus::Frame right(scene, outputs), actual(scene, outputs);
    if (validate(right.target(), right.draws()) != Status::ok) return std::nullopt;
    rival.draw(actual.target(), actual.draws());
    oracle::render(right.target(), right.draws());
    judge::Wrong shown{scene, std::move(right.image()), actual.image()};
    if (!subject.strict) set_right(subject, actual, shown);
    return shown;
  } catch (const std::exception&) {
    return std::nullopt;  // what it does not draw shows no picture
  }
}

// Small frames that were asked for, as the rival drew them.
struct Asked {
  Scene scene;
  corpus::Image rival;
};

// The frame under the rival's model, as `render` draws it.
std::optional<corpus::Image> under_model(const RivalSubject& subject, const Scene& scene,
                                         const std::function<Status(const Target&, std::span<const Draw>)>& render) {
  const Scene under = adapters::scene_under_model(scene, subject.rival->info());
  corpus::Frame frame(under, outputs_with(*subject.rival, scene));
  if (validate(frame.target(), frame.draws()) != Status::ok) return std::nullopt;
  if (render(frame.target(), frame.draws()) != Status::ok) return std::nullopt;
  return std::move(frame.image());
}

// Whoever asks must be gone before the subject is.
judge::Questions questions_of(const RivalSubject& subject, std::vector<Asked>& asked) {
  judge::Questions questions;
  questions.slow = subject.slow;
  questions.model = subject.terms.model;
  if (!subject.terms.known) {
    questions.model = judge::with_facts(judge::Model{}, subject.terms.model);
    questions.model.x.lacks = subject.terms.model.x.lacks, questions.model.y.lacks = subject.terms.model.y.lacks;
  }
  questions.rival = [&subject, &asked](const Scene& scene) -> std::optional<corpus::Image> {
    adapters::Rival& rival = *subject.rival;
    const adapters::Rival::Uncounted uncounted(rival);
    if (rival.given_up() || !rival.is_reducible()) return std::nullopt;
    try {
      corpus::Frame frame(scene, outputs_with(rival, scene));
      if (validate(frame.target(), frame.draws()) != Status::ok) return std::nullopt;
      rival.draw(frame.target(), frame.draws());
      if (scene.width * scene.height * scene.samples <= 1024 && asked.size() < 2000)
        asked.push_back({scene, frame.image()});
      return std::move(frame.image());
    } catch (const std::exception&) {
      return std::nullopt;
    }
  };
  questions.right = [&subject, model = questions.model](const Scene& scene) -> std::optional<corpus::Image> {
    return under_model(subject, judge::moved(scene, model), [](const Target& target, std::span<const Draw> draws) {
      oracle::render(target, draws);
      return Status::ok;
    });
  };
  return questions;
}

// Takes away the names of faults that would show in a frame which came right: one of `fine`, or one that was asked for.
void drop_contradicted(std::vector<judge::Name>& names, const RivalSubject& subject, judge::Questions questions,
                       std::span<const Asked> asked, std::span<const Scene> fine) {
  if (questions.model.x.place != 0.5 || questions.model.y.place != 0.5) return;
  const auto drop = [&](const Scene& scene) {
    std::erase_if(names, [&](const judge::Name& name) {
      questions.rival = [&](const Scene& s) { return under_model(subject, s, name.fault->render); };
      const std::optional<judge::Wrong> theirs = judge::answer(questions, scene);
      return theirs && judge::differs(*theirs);
    });
  };
  for (const Scene& scene : fine) drop(scene);
  for (const Asked& one : asked) {
    if (names.empty()) return;
    questions.rival = [&one](const Scene&) { return std::optional(one.rival); };
    const std::optional<judge::Wrong> shown = judge::answer(questions, one.scene);
    if (shown && !judge::differs(*shown)) drop(one.scene);
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
  // The best name, and another one that explains as much: beside that there is room for what all of it has in common.
  const auto add_names = [&] {
    const std::size_t most = std::min(kMost, sentences.size() + 2);
    for (const judge::Name& name : names) {
      if (name.agreement < names.front().agreement || sentences.size() == most) break;
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

// Where the first triangle and the last one are lost alike, frames of one triangle are, and that says neither.
void drop_opposites(std::vector<judge::Name>& names) {
  constexpr std::array<const char*, 2> kEnds{"the first triangle of a draw is lost",
                                             "the last triangle of a draw is lost"};
  const auto at = [&names](const char* which) {
    return std::ranges::find_if(names, [which](const judge::Name& name) { return name.fault->sentence == which; });
  };
  const auto first = at(kEnds[0]), last = at(kEnds[1]);
  if (first == names.end() || last == names.end() || std::abs(first->agreement - last->agreement) > 0.01) return;
  std::erase_if(names, [&](const judge::Name& name) { return std::ranges::count(kEnds, name.fault->sentence) > 0; });
}

std::vector<std::string> explain_rival(const RivalSubject& subject, std::span<const Scene> found) {
  constexpr std::size_t kMost = 3;
  const std::string which = which_viewports(subject);
  if (const bool turned = which.empty() && turns_viewports(subject); turned || !which.empty()) {
    std::vector<std::string> sentences = subject.conventions;
    sentences.push_back(
        turned ? "the y of a viewport is counted from the bottom row: with height - y - its height for y all is right"
               : "it is only wrong under " + which);
    return sentences;
  }
  const adapters::Rival::WideViewports wide(*subject.rival);
  std::vector<Asked> asked;
  const judge::Questions questions = questions_of(subject, asked);
  const judge::Answers answers = judge::ask(questions, known_faults());
  std::vector<Scene> fine = answers.fine;
  std::vector<judge::Wrong> wrong = answers.wrong;
  judge::Trials trials{[&questions](const Scene& scene) {
                         const std::optional<judge::Wrong> shown = judge::answer(questions, scene);
                         return shown && judge::differs(*shown);
                       },
                       [&questions](const Scene& scene) { return judge::answer(questions, scene); }, kWithin};
  if (subject.rival->info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN) {
    fine.clear();
    wrong = wrong_scenes(subject, found, kScenes, fine);
    trials = {[&subject](const Scene& scene) {
                try {
                  return !subject.rival->given_up() && judge_scene(scene, subject).differences > 0;
                } catch (const std::exception&) {
                  return false;
                }
              },
              [&subject](const Scene& scene) { return both(subject, scene); }, within_of(subject)};
  }
  std::vector<std::string> sentences = subject.conventions;
  sentences.insert(sentences.end(), answers.sentences.begin(), answers.sentences.end());
  if (!wrong.empty()) {
    std::vector<judge::Name> names = judge::name_fault(known_faults(), wrong, trials.within);
    judge::drop_refuted(names, fine, kWithin);
    drop_opposites(names);
    // Of who draws nothing in simple frames, what draws some of it says little.
    if (std::ranges::any_of(subject.inference.problems,
                            [](const std::string& s) { return s.ends_with("cover nothing"); }))
      std::erase_if(names, [](const judge::Name& name) { return name.agreement < 0.9; });
    if (!names.empty()) {
      for (const std::vector<Scene>& right : judge::right_without(wrong, trials)) {
        judge::drop_refuted(names, right, kWithin);
      }
    }
    // Where the answers say what it is, a fault that draws some of it says less.
    if (!answers.sentences.empty()) {
      std::erase_if(names, [](const judge::Name& name) { return name.agreement < 0.9; });
      drop_contradicted(names, subject, questions, asked, fine);
      for (const judge::Name& name : names) {
        if (name.agreement < names.front().agreement) continue;
        const auto said = std::ranges::find(sentences, name.fault->sentence);
        said == sentences.end() ? sentences.push_back(name_text(name)) : void(*said = name_text(name));
      }
    } else {
      for (const std::string& sentence : sentences_of(names, wrong, fine, trials)) sentences.push_back(sentence);
    }
  }
  if (sentences.size() > kMost) sentences.resize(kMost);
  return sentences;
}

std::vector<std::string> explain_deaths(const RivalSubject& subject) {
  const adapters::Rival::Uncounted uncounted(*subject.rival);
  const auto dies = [&subject](int width, int height) {
    Scene scene = judge::empty_scene(width, height);
    judge::add_triangle(scene.draws[0], judge::over_all(width, height), subject.terms.model.culled);
    try {
      corpus::Frame frame(scene, outputs_with(*subject.rival, scene));
      subject.rival->draw(frame.target(), frame.draws());
    } catch (const adapters::RivalFailure&) {
      return true;
    } catch (const std::exception&) {
    }
    return false;
  };
  for (const bool upright : {false, true}) {
    std::vector<int> fine, fatal;
    for (const int length : {64, 96, 16, 24, 20, 22, 21, 23, 17}) {
      (upright ? dies(16, length) : dies(length, 16)) ? fatal.push_back(length) : fine.push_back(length);
    }
    for (const int n : {2, 4, 8, 16, 32}) {
      const auto multiple = [n](int length) { return length % n == 0; };
      if (fatal.empty() || !std::ranges::all_of(fine, multiple) || std::ranges::any_of(fatal, multiple)) continue;
      return {
          fmt::format("it dies on targets whose {} is no multiple of {}: {} are drawn in groups of {}, and what of the "
                      "last group lies beyond the image is written there",
                      upright ? "height" : "width", n, upright ? "rows" : "pixels", n)};
    }
  }
  return {};
}

std::string name_text(const judge::Name& name) {
  std::string text = fmt::format("{} (explains {:.0f} % of it", name.fault->sentence, 100 * name.agreement);
  if (!name.fault->name.empty()) text += "; the zoo's " + name.fault->name;
  if (!name.fault->origin.empty()) text += ", seen in " + name.fault->origin;
  return text + ")";
}

}  // namespace surefill::certify
