// SPDX-License-Identifier: Apache-2.0
#include "certify/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "certify/build_info.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::certify {

namespace {

constexpr const char* kMeans =
    "every value compared equals the exact one, bit for bit: no tolerance, no sample left out";
constexpr const char* kRivalMeans =
    "model: what it does, declared or found by probing, and coverage exactly as that says, with no tolerance; "
    "invariants: what is owed beside that, and values within what the profile grants (profile exact: equal bit for "
    "bit)";
constexpr const char* kRivalLimits[] = {
    "sampled checks speak for the cases drawn, not for all; exhaustive ones for all of the N named",
    "what needs a feature that it does not claim, or that it says it does not take, is not owed",
    "samples that the model leaves open (R1) are counted and not judged",
    "unless the profile is exact: behind the eye and beyond the guard band, 1/16 pixel around edges is left open",
    "unless the profile is exact: numbers beyond 2^32 or below 2^-32 are not judged",
    "unless the profile is exact: where W is no power of two, positions within 1/16 grid step of where the rounding "
    "turns "
    "are open",
    "where clip space is taken, no vertex is rounded on the way: its clip and pixel forms are both exact in float32",
};
constexpr const char* kLimits[] = {
    "sampled checks speak for the cases drawn, not for all; exhaustive ones for all of the N named",
    "the oracle, a second oracle by another route and the engine share the reading of docs/semantics.md",
    "what was checked is this build on this machine; speed was not",
};

std::string how_many(const CheckResult& result, std::uint64_t seed) {
  if (result.due < result.cases) {
    return fmt::format("{} of {} {} ({}), seed {}", grouped(result.due), grouped(result.cases), result.unit,
                       result.exhaustive ? "all there are" : "sampled", seed);
  }
  if (result.exhaustive) return fmt::format("exhaustive over {} {}", grouped(result.cases), result.unit);
  return fmt::format("sampled {} {}, seed {}", grouped(result.cases), result.unit, seed);
}

// The path that draws a frame here, as the engine names it.
std::string engine_path() {
  std::uint32_t count = 0;
  Target target;
  target.width = target.height = 1;
  target.count = {&count, 1};
  Diagnostics diagnostics;
  return render(target, {}, nullptr, {.diagnostics = &diagnostics}) == Status::ok ? diagnostics.path : "unknown";
}

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, 1, ',');
  }
  return digits;
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::certified:
      return "certified";
    case Verdict::not_certified:
      return "not certified";
    case Verdict::incomplete:
      return "incomplete";
  }
  return "unknown";
}

std::string meaning(const Facts& facts) {
  return facts.of_rival() ? kRivalMeans : kMeans;
}

std::vector<std::string> limits(const Facts& facts) {
  if (facts.of_rival()) return {std::begin(kRivalLimits), std::end(kRivalLimits)};
  return {std::begin(kLimits), std::end(kLimits)};
}

std::string deviations_text(const Deviations& deviations) {
  std::string text;
  const auto add = [&text](const char* name, const Deviation& deviation) {
    if (deviation.ulp == 0) return;
    text += fmt::format("{}{} {:.6g} ULP, {:.3g} of what is granted", text.empty() ? "" : "; ", name, deviation.ulp,
                        deviation.granted);
  };
  add("depth", deviations.depth);
  add("barycentrics", deviations.barycentrics);
  add("attributes", deviations.attributes);
  return text;
}

std::vector<std::pair<std::string, std::vector<CheckResult>>> groups_of(std::span<const CheckResult> results) {
  std::vector<std::pair<std::string, std::vector<CheckResult>>> groups;
  for (const CheckResult& result : results) {
    if (groups.empty() || groups.back().first != result.group) groups.push_back({result.group, {}});
    groups.back().second.push_back(result);
  }
  return groups;
}

Facts build_facts() {
  Facts facts;
  facts.version = SUREFILL_VERSION;
  facts.commit = kBuildCommit;
  facts.compiler = kBuildCompiler;
  facts.flags = kBuildFlags;
  facts.cpu = cpu_model();
  facts.instruction_set = engine_path();
  return facts;
}

std::string version_line() {
  return fmt::format("surefill {} ({})", SUREFILL_VERSION, kBuildCommit);
}

std::string check_line(const CheckResult& result, std::uint64_t seed) {
  const char* mark = result.failed > 0 ? "FAIL" : !result.complete() ? "part" : result.checked() ? "ok" : "n/a";
  std::string line =
      fmt::format("{:<4}  {}: {} [{}]\n      {}", mark, result.name, result.claim, result.rule, how_many(result, seed));
  if (!result.complete()) line += fmt::format(" ({} done)", grouped(result.done));
  if (result.skipped > 0) {
    line += fmt::format(" ({} {})", result.skipped == result.done ? "none" : grouped(result.skipped),
                        result.group.empty()            ? "skipped: modes the engine lacks"
                        : result.skipped == result.done ? "applicable: not owed, or it lacks a feature"
                                                        : "not applicable");
  }
  line += fmt::format("; {} samples{}, {} differences, {:.1f} s\n", grouped(result.samples),
                      result.open > 0 ? fmt::format(" judged, {} open", grouped(result.open)) : "",
                      grouped(result.differences), result.seconds);
  const std::string deviations = deviations_text(result.deviations);
  if (!deviations.empty()) line += fmt::format("      largest errors: {}\n", deviations);
  if (result.failed == 0) return line;
  line += fmt::format("      {} of {} {} differ. First, case {}: {}\n", grouped(result.failed), grouped(result.cases),
                      result.unit, result.case_number, result.finding);
  if (!result.shown.empty() && result.shown != result.finding) {
    line += fmt::format("      reduced: {}\n", result.shown);
  }
  if (!result.replay.empty()) line += fmt::format("      {}\n", result.replay);
  return line;
}

Verdict verdict_of(std::span<const CheckResult> results, const Facts& facts) {
  const bool failed =
      std::any_of(results.begin(), results.end(), [](const auto& r) { return r.failed > 0 || r.differences > 0; });
  if (failed || !facts.stopped.empty()) return Verdict::not_certified;
  const bool complete = std::all_of(results.begin(), results.end(), [](const auto& r) { return r.complete(); });
  if (facts.interrupted || !complete) return Verdict::incomplete;
  const bool any = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.checked(); });
  return any ? Verdict::certified : Verdict::not_certified;
}

std::string verdict_block(std::span<const CheckResult> results, const Facts& facts) {
  std::uint64_t samples = 0, differences = 0, skipped = 0;
  std::size_t failed = 0, complete = 0, not_applicable = 0;
  for (const CheckResult& result : results) {
    samples += result.samples;
    differences += result.differences;
    skipped += result.skipped;
    if (result.failed > 0) ++failed;
    if (result.complete()) ++complete;
    if (result.not_applicable()) ++not_applicable;
  }
  const std::string judged = not_applicable == 0
                                 ? fmt::format("{} checks", results.size())
                                 : fmt::format("{} of {} checks judged, {} not applicable", complete - not_applicable,
                                               results.size(), not_applicable);
  const Verdict verdict = verdict_of(results, facts);
  std::string block = "\n";
  switch (verdict) {
    case Verdict::certified:
      block +=
          fmt::format("CERTIFIED: {}; {} samples, 0 differences, {:.1f} s\n", judged, grouped(samples), facts.seconds);
      break;
    case Verdict::not_certified:
      block +=
          failed == 0
              ? fmt::format("NOT CERTIFIED: nothing could be judged: {}; {:.1f} s\n", judged, facts.seconds)
              : fmt::format(
                    "NOT CERTIFIED: {} of {} checks found a difference ({} differences in {} samples); {}; {:.1f} s\n",
                    failed, results.size(), grouped(differences), grouped(samples), judged, facts.seconds);
      break;
    case Verdict::incomplete:
      block += fmt::format("INCOMPLETE: interrupted; {} of {} checks are complete, without a difference, {:.1f} s\n",
                           complete, results.size(), facts.seconds);
      break;
  }
  if (!facts.stopped.empty()) {
    block += fmt::format("  stopped   {}; {} of {} checks are complete\n", facts.stopped, complete, results.size());
  }
  if (facts.interrupted && verdict == Verdict::not_certified) {
    block += fmt::format("  interrupted: {} of {} checks are complete\n", complete, results.size());
  }
  for (std::size_t n = 0; n < facts.names.size(); ++n) {
    block += fmt::format("  {}    {}\n", n == 0 ? "likely" : "or    ", facts.names[n]);
  }
  if (facts.of_rival()) {
    for (const auto& [group, part] : groups_of(results)) {
      const std::string of = group == "model" ? fmt::format(" ({})", facts.model) : "";
      const std::size_t bad = static_cast<std::size_t>(
          std::count_if(part.begin(), part.end(), [](const CheckResult& r) { return r.failed > 0; }));
      const Verdict here = verdict_of(part, facts);
      block += fmt::format("  verdict   {}{}: {}\n", group, of,
                           here == Verdict::certified    ? "hold on all cases"
                           : here == Verdict::incomplete ? "incomplete"
                           : bad == 0                    ? "nothing was owed"
                                      : fmt::format("violated in {} of {} checks", bad, part.size()));
    }
    block += fmt::format("  rival     {} {}\n", facts.rival, facts.rival_version);
    block +=
        fmt::format("  model     declared: {}; found by probing: {}\n", facts.declared_model, facts.inferred_model);
    for (const std::string& problem : facts.problems) block += fmt::format("            {}\n", problem);
    for (const std::string& sentence : facts.departures) block += fmt::format("  note      {}\n", sentence);
    for (const std::string& what : facts.open) block += fmt::format("  unknown   {}\n", what);
    const bool none_fits = facts.inferred_model.starts_with("no");  // "none fits", "no samples that fit"
    if (none_fits && facts.model == "unknown") {
      block +=
          "  unknown   whether it covers what it should: only what holds under every model was judged, which is "
          "little\n";
    }
    if (none_fits || !facts.departures.empty() || !facts.problems.empty()) {
      for (const std::string& line : lines_of(facts.turns)) block += fmt::format("  turns     {}\n", line);
    }
  }
  if (skipped > 0) {
    block += fmt::format("  {} cases were not applicable: {}\n", grouped(skipped),
                         facts.of_rival() ? "they are not owed under its model, or need features that it lacks"
                                          : "they need modes that this engine does not have yet");
  }
  block += fmt::format("  means     {}\n", meaning(facts));
  for (const std::string& limit : limits(facts)) block += fmt::format("  but       {}\n", limit);
  block += fmt::format("  version   {}, commit {}\n", facts.version, facts.commit);
  block += fmt::format("  compiler  {}\n  flags     {}\n", facts.compiler, facts.flags);
  block += fmt::format("  machine   {}", facts.cpu);
  block += facts.of_rival() ? "\n" : fmt::format("; engine path: {}\n", facts.instruction_set);
  block += fmt::format("  run       level {}, seed {}, {} threads", facts.level, facts.seed, facts.jobs);
  if (facts.shard.count > 1) block += fmt::format(", shard {}/{} alone", facts.shard.index, facts.shard.count);
  block += "\n";
  return block;
}

}  // namespace surefill::certify
