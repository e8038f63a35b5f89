// SPDX-License-Identifier: Apache-2.0
#include "certify/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "certify/build_info.hpp"
#include "surefill/surefill.hpp"

namespace surefill::certify {

namespace {

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, 1, ',');
  }
  return digits;
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

constexpr const char* kMeans =
    "every value compared equals the exact one, bit for bit: no tolerance, no sample left out";
constexpr const char* kLimits[] = {
    "sampled checks speak for the cases drawn, not for all; exhaustive ones for all of the N named",
    "the oracle, a second oracle by another route and the engine share the reading of docs/semantics.md",
    "what was checked is this build on this machine; speed was not",
};

const char* name_of(Verdict verdict) {
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

std::string how_many(const CheckResult& result, std::uint64_t seed) {
  if (result.exhaustive) return fmt::format("exhaustive over {} {}", grouped(result.cases), result.unit);
  return fmt::format("sampled {} {}, seed {}", grouped(result.cases), result.unit, seed);
}

// The path that draws a frame here, as the engine names it.
std::string engine_path() {
  std::uint32_t count = 0;
  Target target;
  target.width = target.height = 1;
  target.count = {&count, 1};
  Statistics statistics;
  return render(target, {}, &statistics) == Status::ok ? statistics.path : "unknown";
}

}  // namespace

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
  const char* mark = result.failed > 0 ? "FAIL" : !result.complete() ? "part" : result.checked() ? "ok" : "skip";
  std::string line =
      fmt::format("{:<4}  {}: {} [{}]\n      {}", mark, result.name, result.claim, result.rule, how_many(result, seed));
  if (!result.complete()) line += fmt::format(" ({} done)", grouped(result.done));
  if (result.skipped > 0) line += fmt::format(" ({} skipped: modes the engine lacks)", grouped(result.skipped));
  line += fmt::format("; {} samples, {} differences, {:.1f} s\n", grouped(result.samples), grouped(result.differences),
                      result.seconds);
  if (result.failed == 0) return line;
  line += fmt::format("      {} of {} {} differ. First, case {}: {}\n", grouped(result.failed), grouped(result.cases),
                      result.unit, result.case_number, result.finding);
  if (!result.replay.empty()) line += fmt::format("      {}\n", result.replay);
  return line;
}

Verdict verdict_of(std::span<const CheckResult> results, const Facts& facts) {
  const bool failed = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.failed > 0; });
  if (failed) return Verdict::not_certified;
  const bool complete = std::all_of(results.begin(), results.end(), [](const auto& r) { return r.complete(); });
  if (facts.interrupted || !complete) return Verdict::incomplete;
  const bool any = std::any_of(results.begin(), results.end(), [](const auto& r) { return r.checked(); });
  return any ? Verdict::certified : Verdict::not_certified;
}

std::string verdict_block(std::span<const CheckResult> results, const Facts& facts) {
  std::uint64_t samples = 0, differences = 0, skipped = 0;
  std::size_t failed = 0, complete = 0;
  for (const CheckResult& result : results) {
    samples += result.samples;
    differences += result.differences;
    skipped += result.skipped;
    if (result.failed > 0) ++failed;
    if (result.complete()) ++complete;
  }
  const Verdict verdict = verdict_of(results, facts);
  std::string block = "\n";
  switch (verdict) {
    case Verdict::certified:
      block += fmt::format("CERTIFIED: {} checks, {} samples compared, 0 differences, {:.1f} s\n", results.size(),
                           grouped(samples), facts.seconds);
      break;
    case Verdict::not_certified:
      block +=
          fmt::format("NOT CERTIFIED: {} of {} checks found a difference ({} differences in {} samples), {:.1f} s\n",
                      failed, results.size(), grouped(differences), grouped(samples), facts.seconds);
      break;
    case Verdict::incomplete:
      block += fmt::format("INCOMPLETE: interrupted; {} of {} checks are complete, without a difference, {:.1f} s\n",
                           complete, results.size(), facts.seconds);
      break;
  }
  if (facts.interrupted && verdict == Verdict::not_certified) {
    block += fmt::format("  interrupted: {} of {} checks are complete\n", complete, results.size());
  }
  if (skipped > 0) {
    block +=
        fmt::format("  {} cases were skipped: they need modes that this engine does not have yet\n", grouped(skipped));
  }
  block += fmt::format("  means     {}\n", kMeans);
  for (const char* limit : kLimits) block += fmt::format("  but       {}\n", limit);
  block += fmt::format("  version   {}, commit {}\n", facts.version, facts.commit);
  block += fmt::format("  compiler  {}\n  flags     {}\n", facts.compiler, facts.flags);
  block += fmt::format("  machine   {}; engine path: {}\n", facts.cpu, facts.instruction_set);
  block += fmt::format("  run       level {}, seed {}, {} threads\n", facts.level, facts.seed, facts.jobs);
  return block;
}

std::string certificate_json(std::span<const CheckResult> results, const Facts& facts) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["format"] = "surefill-certificate";
  json["format_version"] = 1;
  json["verdict"] = name_of(verdict_of(results, facts));
  json["interrupted"] = facts.interrupted;
  json["version"] = facts.version;
  json["commit"] = facts.commit;
  json["compiler"] = facts.compiler;
  json["flags"] = facts.flags;
  json["cpu"] = facts.cpu;
  json["instruction_set"] = facts.instruction_set;
  json["level"] = facts.level;
  json["seed"] = facts.seed;
  json["jobs"] = facts.jobs;
  json["seconds"] = facts.seconds;
  json["means"] = kMeans;
  json["limits"] = kLimits;
  json["checks"] = Json::array();
  for (const CheckResult& result : results) {
    Json check;
    check["name"] = result.name;
    check["rule"] = result.rule;
    check["claim"] = result.claim;
    check["exhaustive"] = result.exhaustive;
    check["unit"] = result.unit;
    check["cases"] = result.cases;
    check["done"] = result.done;
    check["skipped"] = result.skipped;
    check["failed"] = result.failed;
    check["samples"] = result.samples;
    check["differences"] = result.differences;
    check["seconds"] = result.seconds;
    if (result.failed > 0) {
      check["finding"] = result.finding;
      check["case"] = result.case_number;
      if (!result.scene.empty()) check["scene"] = result.scene;
      if (!result.replay.empty()) check["replay"] = result.replay;
    }
    json["checks"].push_back(std::move(check));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace surefill::certify
