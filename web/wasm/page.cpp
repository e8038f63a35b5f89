// SPDX-License-Identifier: Apache-2.0
#include "web/wasm/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "certify/report/report_files.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/rivals/rival_facts.hpp"
#include "certify/run/files.hpp"
#include "certify/run/progress.hpp"
#include "certify/run/runner.hpp"
#include "web/wasm/files.hpp"

namespace surefill::certify {

namespace {

using Json = nlohmann::ordered_json;  // the certificate's

void tell(SurefillTold kind, const std::string& text) {
  surefill_tell(kind, text.data(), text.size());
}

// How the same GPU is judged by the command.
constexpr const char* kReplayOption = "--command 'node web/serve.mjs'";

std::chrono::milliseconds limit_of(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds));
}

// Theorems over meshes that the page has not (meshes.cpp).
constexpr std::string_view kMeshes[] = {"partition-delaunay", "partition-adjacent", "grid-partition",
                                        "grid-degree",        "degree-hull",        "degree-spot"};

// Names with *, as the command's --only has them.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*') return !name.empty() && pattern[0] == name[0] && matches(pattern.substr(1), name.substr(1));
  for (std::size_t skip = 0; skip <= name.size(); ++skip) {
    if (matches(pattern.substr(1), name.substr(skip))) return true;
  }
  return false;
}

// Of names with commas between; all where there are none.
std::vector<Check> selected(std::vector<Check> checks, std::string_view patterns) {
  std::erase_if(checks, [patterns](const Check& check) {
    if (std::find(std::begin(kMeshes), std::end(kMeshes), check.name) != std::end(kMeshes)) return true;
    bool matched = patterns.empty();
    for (std::string_view rest = patterns; !rest.empty() && !matched;) {
      const std::string_view pattern = rest.substr(0, rest.find(','));
      matched = matches(pattern, check.name);
      rest.remove_prefix(std::min(pattern.size() + 1, rest.size()));
    }
    return !matched;
  });
  return checks;
}

// Each case tells how far the work is. Checks take as long as `cost` says, roughly.
void report_progress(std::vector<Check>& checks) {
  double total = 0;
  for (Check& check : checks) total += check.cost * static_cast<double>(check.prepare());
  double before = 0;
  for (std::size_t n = 0; n < checks.size(); ++n) {
    Check& check = checks[n];
    check.run = [run = check.run, n, before, total, cost = check.cost, all = checks.size()](std::uint64_t number) {
      CaseResult result = run(number);
      surefill_progress(n, all, (before + cost * static_cast<double>(number + 1)) / total);
      return result;
    };
    before += check.cost * static_cast<double>(check.prepare());
  }
}

void finish(const Certificate& certificate) {
  tell(kToldLine, verdict_block(certificate.results, certificate.facts));
  tell(kToldCertificate, certificate_json(certificate));
  tell(kToldReport, html_report(certificate));
}

RivalSubject meet(adapters::Rival& rival) {
  RivalSubject subject = meet_rival(rival);
  subject.slow = true;
  subject.replay_option = kReplayOption;
  return subject;
}

// Who it is, and its model.
Facts facts_of(const adapters::Rival& rival, const RivalSubject& subject) {
  Facts facts;
  add_rival_facts(subject, rival.info().model, facts);
  return facts;
}

void certify(Level level, std::uint64_t seed, double seconds, const char* patterns, const char* machine) {
  const auto start = std::chrono::steady_clock::now();
  Settings settings;
  settings.level = level;
  settings.seed = seed;
  settings.corpus = "corpus";
  settings.engine = properties::engine_renderer();
  Facts facts = build_facts();
  facts.cpu = machine;
  facts.level = level_name(settings.level);
  facts.seed = settings.seed;

  adapters::Rival rival({{"GPU"}, "", limit_of(seconds)});
  const surefill_adapter_model declared = rival.info().model;
  const RivalSubject subject = meet(rival);
  if (rival.given_up()) {
    const Certificate certificate = unmet(facts, rival);
    tell(kToldLine, check_line(certificate.results[0], settings.seed));
    return finish(certificate);
  }
  add_rival_facts(subject, declared, facts);
  tell(kToldLine, fmt::format("{} {}: probing finds {}\n", facts.rival, facts.rival_version, facts.inferred_model));
  std::vector<Check> checks = selected(list_rival_checks(settings, subject), patterns);
  report_progress(checks);
  Certificate certificate;
  certificate.results = run_checks(settings, checks, {1, ".", {}}, [&settings](const CheckResult& result) {
    tell(kToldLine, check_line(result, settings.seed));
  });
  facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  facts.interrupted = interrupted();
  add_outcome(subject, certificate.results, facts);
  certificate.facts = facts;
  finish(certificate);
}

void judge_one(double seconds, const char* text) {
  const corpus::Scene scene = corpus::read_scene(text, "the scene");
  adapters::Rival rival({{"GPU"}, "", limit_of(seconds)});
  const RivalSubject subject = meet(rival);
  const CaseResult result = judge_scene(scene, subject);
  const corpus::Scene under = adapters::scene_under_model(scene, rival.info());
  const Evidence evidence = gather_evidence(under, adapters::model_renderer(rival), adapters::rival_renderer(rival));
  if (evidence.width > 0) tell(kToldReport, scene_pictures(evidence, corpus::write_scene(under), rival.info().name));
  tell(kToldVerdict, Json{{"rival", rival.info().name},
                          {"model", facts_of(rival, subject).inferred_model},
                          {"applies", !result.skipped},
                          {"samples", result.samples},
                          {"open", result.open},
                          {"differences", result.differences},
                          {"finding", result.finding}}
                         .dump());
}

template <typename Work>
void guarded(const Work& work) {
  try {
    work();
  } catch (const adapters::RivalUnopened& reason) {
    tell(kToldUnopened, reason.what());
  } catch (const corpus::SceneError& reason) {
    tell(kToldUnopened, reason.what());
  } catch (const std::exception& error) {
    tell(kToldError, error.what());
  }
}

}  // namespace

}  // namespace surefill::certify

extern "C" {

void surefill_add_file(const char* path, std::size_t path_size, const char* text, std::size_t size) {
  surefill::web::add_file({path, path_size}, {text, size});
}

void surefill_certify(std::uint32_t level, std::uint32_t seed_low, std::uint32_t seed_high, double seconds,
                      const char* checks, const char* machine) {
  surefill::certify::guarded([=] {
    surefill::certify::certify(static_cast<surefill::certify::Level>(level), std::uint64_t{seed_high} << 32 | seed_low,
                               seconds, checks, machine);
  });
}

void surefill_judge_scene(double seconds, const char* scene) {
  surefill::certify::guarded([=] { surefill::certify::judge_one(seconds, scene); });
}

}  // extern "C"
