// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/recheck.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "certify/judge/words.hpp"
#include "certify/report/certificate.hpp"
#include "certify/rivals/rival_cases.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/run/checks.hpp"
#include "certify/run/judge.hpp"
#include "certify/run/progress.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;

enum class Fate { still, changed, gone };
constexpr std::array<const char*, 3> kWords = {"still", "changed", "gone"};

struct Answer {
  Fate fate = Fate::gone;
  std::string now;  // what is found; of "changed" maybe why nothing is judged
};

// The findings that the names choose; every name must choose one.
std::vector<CheckResult> findings_of(const Certificate& certificate, const RecheckOptions& options) {
  std::vector<CheckResult> findings;
  std::string all;
  for (const CheckResult& result : certificate.results) {
    if (result.failed == 0) continue;
    findings.push_back(result);
    all += (all.empty() ? "" : ", ") + result.name;
  }
  const auto matches = [](const std::string& name, const CheckResult& result) {
    return fnmatch(name.c_str(), result.name.c_str(), 0) == 0;
  };
  for (const std::string& name : options.names) {
    const auto chosen = [&](const CheckResult& result) { return matches(name, result); };
    if (std::any_of(findings.begin(), findings.end(), chosen)) continue;
    const bool passed = std::any_of(certificate.results.begin(), certificate.results.end(), chosen);
    throw UsageError(fmt::format("{}: {} {}; {}", options.certificate, passed ? "nothing was found by" : "no check",
                                 name, all.empty() ? "it has no findings" : "its findings: " + all));
  }
  std::erase_if(findings, [&](const CheckResult& result) {
    return !options.names.empty() && std::none_of(options.names.begin(), options.names.end(),
                                                  [&](const std::string& name) { return matches(name, result); });
  });
  return findings;
}

// The rival that a certificate is about. A driver of this machine is started as the certificate says; what else a file
// names is not: it may be anybody's.
RivalChoice rival_of(const Certificate& certificate, const std::string& file) {
  RivalChoice said;
  if (!certificate.facts.of_rival()) return said;
  for (const CheckResult& result : certificate.results) {
    if (said.chosen() || result.replay.empty()) continue;
    const std::vector<std::string> words = words_of(result.replay);
    for (std::size_t n = 0; n + 1 < words.size(); ++n) {
      if (words[n] == "--adapter") said.adapter = words[n + 1];
      if (words[n] == "--plugin") said.plugin = words[n + 1];
      if (words[n] == "--command") said.command = words[n + 1];
      if (words[n] == "--plugin-arguments") said.arguments = words[n + 1];
    }
  }
  if (said.adapter == "opengl" || said.adapter == "vulkan") return said;
  const std::string how =
      said.adapter.empty() && said.chosen() ? said.as_options() : "--adapter, --plugin or --command";
  throw UsageError(fmt::format("{}: it is of {}; no program is started because a file names it, so say which: {}", file,
                               certificate.facts.rival, how));
}

// What runs the cases again: the checks of a run like the certificate's, on who is judged now.
class Bench {
 public:
  Bench(const Certificate& certificate, const RivalChoice& choice, std::string corpus) {
    settings_.level = level_named(certificate.facts.level);
    settings_.seed = certificate.facts.seed;
    settings_.engine = properties::engine_renderer();
    settings_.corpus = std::move(corpus);
    same_suite_ = certificate.facts.version == build_facts().version;
    if (choice.chosen()) {
      rival_ = start_rival(choice);
      subject_ = meet_rival(*rival_);
      subject_.slow = !choice.command.empty();
      if (!rival_->given_up()) checks_ = list_rival_checks(settings_, subject_);
    } else {
      settings_.support = probe_support(settings_.engine);
      checks_ = list_checks(settings_);
    }
  }

  std::string head(const Facts& was) const {
    const Facts here = build_facts();
    std::string text = rival_ ? fmt::format("{} {}: {}\n", rival_->info().name, rival_->info().version, model())
                              : fmt::format("the engine of {}\n", version_line());
    if (rival_ && was.of_rival() && !rival_->given_up() && was.model != model()) {
      text += fmt::format("  its model was: {}\n", was.model);
    }
    const std::string before = fmt::format("{} {}", was.rival, was.rival_version);
    if (rival_ && before != fmt::format("{} {}", rival_->info().name, rival_->info().version)) {
      text +=
          was.of_rival() ? fmt::format("  the certificate is of {}\n", before) : "  the certificate is of the engine\n";
    }
    if (was.commit != here.commit || was.version != here.version) {
      text += fmt::format("  the certificate was made by surefill {} ({})\n", was.version, was.commit);
    }
    return text;
  }

  Answer recheck(const CheckResult& was) {
    if (rival_ && rival_->given_up()) return answer(was.finding, true, rival_->why_given_up());
    const auto found =
        std::find_if(checks_.begin(), checks_.end(), [&](const Check& check) { return check.name == was.name; });
    Check* const check = found == checks_.end() ? nullptr : &*found;
    if (was.scene_text.empty()) {
      if (was.name == "probing") return {};  // what was judged before it drew a triangle
      if (check == nullptr) return {Fate::changed, "not judged: there is no such check of who is judged now"};
      return case_again(was, *check);
    }
    const Scene scene = corpus::read_scene(was.scene_text, was.name);
    const Answer of_scene = scene_again(was, check, scene);
    // What the reduced scene shows no more, the case that it comes from may.
    if (of_scene.fate != Fate::gone || check == nullptr || !same_suite_) return of_scene;
    return case_again(was, *check);
  }

 private:
  static Answer answer(const std::string& before, bool differs, const std::string& now) {
    if (!differs) return {};
    return {before.empty() || before == now ? Fate::still : Fate::changed, now};
  }

  std::string model() const {
    if (rival_->given_up()) return rival_->why_given_up();
    if (rival_->info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN) {
      return adapters::describe_model(rival_->info().model);
    }
    return subject_.terms.known ? judge::describe(subject_.terms.model) : "unknown";
  }

  // The case of the same number.
  Answer case_again(const CheckResult& was, Check& check) {
    if (!same_suite_) return {Fate::changed, "not judged: another version of the suite has other cases"};
    if (check.prepare && check.prepare() != was.cases) {
      return {Fate::changed, "not judged: there are other cases than there were"};
    }
    const CaseResult now = check.run(was.case_number);
    if (now.skipped) return {Fate::changed, "not judged: of this case nothing is owed, or a feature is lacking"};
    return answer(was.finding, now.differences > 0, now.finding);
  }

  Answer scene_again(const CheckResult& was, const Check* check, const Scene& scene) const {
    const std::string now = words_in(check, scene);
    const bool differs = check != nullptr && check->still_fails ? check->still_fails(scene) : !now.empty();
    if (differs) return answer(was.shown, true, now.empty() ? was.shown : now);
    if (rival_ && judge_scene(scene, subject_).skipped) {
      return {Fate::changed, "not judged: of this scene nothing is owed, or a feature is lacking"};
    }
    return {};
  }

  // The first difference in a scene, as the check has it; where there is no such check, of the images.
  std::string words_in(const Check* check, const Scene& scene) const {
    if (check != nullptr && check->describe) return check->describe(scene);
    if (rival_) return judge_scene(scene, subject_).finding;
    if (!valid(scene)) return "";
    const bool oracles = check != nullptr && check->replay_option == "--second-oracle";
    const properties::Comparison now =
        judge(scene, properties::oracle_renderer(), oracles ? properties::clipped_oracle_renderer() : settings_.engine);
    return now.first.empty() ? "" : describe_finding(now.first.front(), scene.samples);
  }

  Settings settings_;
  std::unique_ptr<adapters::Rival> rival_;  // none: the engine
  RivalSubject subject_;
  std::vector<Check> checks_;
  bool same_suite_ = false;  // cases have the numbers that they had
};

std::string line_of(const CheckResult& was, const Answer& answer) {
  const std::string before = was.shown.empty() ? was.finding : was.shown;
  std::string line = fmt::format("{:<8} {}: {}\n", kWords[static_cast<std::size_t>(answer.fate)], was.name, before);
  if (answer.fate == Fate::changed) line += fmt::format("         now: {}\n", answer.now);
  return line;
}

}  // namespace

void add_recheck_options(CLI::App& app, RecheckOptions& options) {
  app.add_option("JSON", options.certificate, "The certificate, as `surefill certify --json` writes it")->required();
  app.add_option("NAMES", options.names, "Checks, with * and ? (all that found something)");
  add_rival_options(app, options.rival);
  app.add_option("--corpus", options.corpus, "Folder of cases/ and meshes/");
}

int run_recheck(const RecheckOptions& options, const std::function<std::string()>& find_corpus) {
  const Certificate certificate = read_certificate_file(options.certificate);
  const std::vector<CheckResult> findings = findings_of(certificate, options);
  if (findings.empty()) {
    print(fmt::format("{}: it has no findings\n", options.certificate));
    return kGood;
  }
  const RivalChoice choice = options.rival.chosen() ? options.rival : rival_of(certificate, options.certificate);
  catch_interrupts();
  Progress progress;
  progress.show("recheck: meeting who is judged", 0, static_cast<double>(findings.size()));
  Bench bench(certificate, choice, options.corpus.empty() ? find_corpus() : options.corpus);
  progress.clear();
  print(bench.head(certificate.facts));
  std::array<std::size_t, 3> fates{};
  for (std::size_t n = 0; n < findings.size(); ++n) {
    progress.show("recheck: " + findings[n].name, static_cast<double>(n), static_cast<double>(findings.size()));
    const Answer answer = bench.recheck(findings[n]);
    progress.clear();
    if (interrupted()) return kInterrupted;
    print(line_of(findings[n], answer));
    ++fates[static_cast<std::size_t>(answer.fate)];
  }
  print(fmt::format("{} finding{}: {} still there, {} changed, {} gone\n", findings.size(),
                    findings.size() == 1 ? "" : "s", fates[0], fates[1], fates[2]));
  return fates[2] == findings.size() ? kGood : kBad;
}

}  // namespace surefill::certify
