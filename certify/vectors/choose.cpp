// SPDX-License-Identifier: Apache-2.0
//
// Which candidates become tests.
#include <algorithm>
#include <stdexcept>

#include "certify/vectors/vectors.hpp"
#include "oracle/oracle.hpp"

namespace surefill::vectors {
namespace {

struct Reason {
  std::string_view specimen, why;
};
// What a file has of a frame is values in order; the rest is the caller's and the program's.
constexpr Reason kNotShown[] = {
    {"stride-ignored", "files hold values in order, and no strides"},
    {"stride-zero", "files hold values in order, and no strides"},
    {"covered-is-visible", "files have outputs of samples; these are numbers of triangles"},
    {"visible-of-all-layers", "files have outputs of samples; these are numbers of triangles"},
};

Status second_oracle(const Target& target, std::span<const Draw> draws) {
  oracle::clipped::render(target, draws);
  return Status::ok;
}

// One subject's choice. A fault that has not been shown by so many candidates of properties that do not name it is tried
// no more.
class Choice {
 public:
  static constexpr std::uint64_t kPatience = 160;

  Choice(const Subject& subject, int number, Faults& effects) : number_(number), effects_(effects) {
    file_.subject = subject;
  }

  // False: no more of this property's cases.
  bool take(const Candidate& candidate, const std::string& property, bool deep) {
    if (deep && !names_one_alive(property)) return false;
    Shown& shown = shown_[mode_of(candidate.rules)];
    std::optional<Test> test = test_of(file_.subject, candidate);
    if (!test) return true;
    for (const zoo::Specimen& specimen : zoo::specimens()) {
      if (!why_not_shown(specimen.name).empty()) continue;
      const bool named = property == specimen.named_by;
      std::uint64_t& tried = shown.tried[specimen.name];
      if (shown.faults.contains(specimen.name) ||
          !(deep ? named && !shown_anywhere(specimen) : named || tried < kPatience))
        continue;
      ++tried;
      if (wrong_by(*test, specimen.render)) test->flags.insert(specimen.name);
    }
    const bool names = std::any_of(test->rules.begin(), test->rules.end(),
                                   [&](const std::string& rule) { return !rules_.contains(rule); });
    if (test->flags.empty() && !names) return true;
    rules_.insert(test->rules.begin(), test->rules.end());
    shown.faults.insert(test->flags.begin(), test->flags.end());
    if (file_.subject.model == Model::exact && wrong_by(*test, second_oracle))
      throw std::runtime_error("vectors: the oracles differ in " + file_.subject.name + ": " + test->comment);
    file_.tests.push_back(std::move(*test));
    return true;
  }

  File finish() {
    int id = number_ * 1000;
    for (Test& test : file_.tests) {
      test.id = ++id;
      for (const zoo::Specimen& specimen : zoo::specimens()) {
        if (!why_not_shown(specimen.name).empty()) continue;
        const std::optional<Effects> effects = wrong_by(test, specimen.render);
        if (!effects) continue;
        test.kills.insert(specimen.name);
        effects_[specimen.name].take(*effects);
      }
    }
    return std::move(file_);
  }

 private:
  // In one mode: the faults that are shown, and how often one was tried.
  struct Shown {
    std::set<std::string> faults;
    std::map<std::string, std::uint64_t> tried;
  };

  // Of those rules that are the subject's modes; of two of a kind neither counts.
  std::string mode_of(const std::set<std::string>& rules) const {
    std::string mode;
    for (const std::string& kind : file_.subject.modes) {
      std::string found;
      int number = 0;
      for (const std::string& rule : rules)
        if (rule.starts_with(kind)) found = rule, ++number;
      mode += number == 1 ? found + ";" : number > 1 ? kind + "several;" : "";
    }
    return mode;
  }

  bool shown_anywhere(const zoo::Specimen& specimen) const {
    return std::any_of(shown_.begin(), shown_.end(),
                       [&](const auto& mode) { return mode.second.faults.contains(specimen.name); });
  }

  bool names_one_alive(const std::string& property) const {
    const auto all = zoo::specimens();
    return std::any_of(all.begin(), all.end(), [&](const zoo::Specimen& specimen) {
      return property == specimen.named_by && why_not_shown(specimen.name).empty() && !shown_anywhere(specimen);
    });
  }

  int number_;
  Faults& effects_;
  File file_;
  std::map<std::string, Shown> shown_;  // by mode
  std::set<std::string> rules_;
};

}  // namespace

std::string_view why_not_shown(std::string_view specimen) {
  for (const Reason& reason : kNotShown)
    if (reason.specimen == specimen) return reason.why;
  return {};
}

File choose(const Subject& subject, int number, const std::string& corpus, Faults& effects) {
  Choice choice(subject, number, effects);
  for_each_candidate(subject, corpus, [&](const Candidate& candidate, const std::string& property, bool deep) {
    return choice.take(candidate, property, deep);
  });
  return choice.finish();
}

File smoke_of(std::span<const File> files, std::size_t bytes) {
  File smoke;
  smoke.subject.name = "smoke", smoke.subject.title = "a few tests of each file, for a first look";
  smoke.subject.model = Model::exact;
  struct One {
    const Test* test;
    std::size_t size;
    bool used = false;
  };
  std::vector<One> all;
  for (const File& file : files)
    for (const Test& test : file.tests) all.push_back({&test, json_of(test).size()});
  std::set<std::string> shown;
  std::size_t used = 0;
  const auto gain = [&](const One& one) {
    return static_cast<std::size_t>(std::count_if(one.test->kills.begin(), one.test->kills.end(),
                                                  [&](const std::string& name) { return !shown.contains(name); }));
  };
  const auto use = [&](One& one) {
    one.used = true, used += one.size;
    shown.insert(one.test->kills.begin(), one.test->kills.end());
    smoke.tests.push_back(*one.test);
  };
  // The cheapest test of each file, then the most faults a byte.
  for (const File& file : files) {
    One* cheapest = nullptr;
    for (One& one : all)
      if (&one.test[0] >= file.tests.data() && one.test < file.tests.data() + file.tests.size() &&
          !one.test->kills.empty() && (cheapest == nullptr || one.size < cheapest->size))
        cheapest = &one;
    if (cheapest != nullptr) use(*cheapest);
  }
  for (;;) {
    One* best = nullptr;
    for (One& one : all) {
      if (one.used || gain(one) == 0 || used + one.size > bytes) continue;
      if (best == nullptr || gain(one) * best->size > gain(*best) * one.size) best = &one;
    }
    if (best == nullptr) break;
    use(*best);
  }
  std::sort(smoke.tests.begin(), smoke.tests.end(), [](const Test& a, const Test& b) { return a.id < b.id; });
  return smoke;
}

}  // namespace surefill::vectors
