// SPDX-License-Identifier: Apache-2.0
#include "certify/report/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace surefill::certify {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 2;

Json json_of(const Deviations& deviations) {
  Json json;
  const auto add = [&json](const char* name, const Deviation& deviation) {
    if (deviation.ulp > 0) json[name] = {{"ulp", deviation.ulp}, {"granted", deviation.granted}};
  };
  add("depth", deviations.depth);
  add("barycentrics", deviations.barycentrics);
  add("attributes", deviations.attributes);
  return json;
}

Deviations deviations_of(const Json& json) {
  Deviations deviations;
  const auto get = [&json](const char* name, Deviation& deviation) {
    if (!json.contains(name)) return;
    deviation.ulp = json[name].value("ulp", 0.0);
    deviation.granted = json[name].value("granted", 0.0);
  };
  get("depth", deviations.depth);
  get("barycentrics", deviations.barycentrics);
  get("attributes", deviations.attributes);
  return deviations;
}

Json json_of(const CheckResult& result) {
  Json check;
  check["name"] = result.name;
  if (!result.group.empty()) check["group"] = result.group;
  check["rule"] = result.rule;
  check["claim"] = result.claim;
  check["exhaustive"] = result.exhaustive;
  check["unit"] = result.unit;
  check["cases"] = result.cases;
  check["due"] = result.due;
  check["done"] = result.done;
  check["resume"] = result.resume;
  check["skipped"] = result.skipped;
  check["failed"] = result.failed;
  check["samples"] = result.samples;
  check["differences"] = result.differences;
  check["seconds"] = result.seconds;
  if (const Json deviations = json_of(result.deviations); !deviations.empty()) check["largest_errors"] = deviations;
  if (result.failed == 0) return check;
  check["finding"] = result.finding;
  check["case"] = result.case_number;
  if (!result.shown.empty()) check["shown"] = result.shown;
  if (!result.scene.empty()) check["scene"] = result.scene;
  if (!result.replay.empty()) check["replay"] = result.replay;
  if (!result.scene_text.empty()) check["scene_text"] = result.scene_text;
  const Evidence& evidence = result.evidence;
  if (evidence.width > 0) {
    check["evidence"] = {{"x0", evidence.x0},
                         {"y0", evidence.y0},
                         {"width", evidence.width},
                         {"height", evidence.height},
                         {"samples", evidence.samples},
                         {"what", evidence.what},
                         {"expected", evidence.expected},
                         {"actual", evidence.actual},
                         {"differs", evidence.differs}};
  }
  return check;
}

CheckResult result_of(const Json& check) {
  CheckResult result;
  result.name = check.at("name");
  result.group = check.value("group", "");
  result.rule = check.at("rule");
  result.claim = check.at("claim");
  result.exhaustive = check.at("exhaustive");
  result.unit = check.at("unit");
  result.cases = check.at("cases");
  result.due = check.at("due");
  result.done = check.at("done");
  result.resume = check.at("resume");
  result.skipped = check.at("skipped");
  result.failed = check.at("failed");
  result.samples = check.at("samples");
  result.differences = check.at("differences");
  result.seconds = check.at("seconds");
  if (check.contains("largest_errors")) result.deviations = deviations_of(check["largest_errors"]);
  result.finding = check.value("finding", "");
  result.case_number = check.value("case", std::uint64_t{0});
  result.shown = check.value("shown", "");
  result.scene = check.value("scene", "");
  result.replay = check.value("replay", "");
  result.scene_text = check.value("scene_text", "");
  if (check.contains("evidence")) {
    const Json& from = check["evidence"];
    Evidence& evidence = result.evidence;
    evidence.x0 = from.at("x0");
    evidence.y0 = from.at("y0");
    evidence.width = from.at("width");
    evidence.height = from.at("height");
    evidence.samples = from.at("samples");
    evidence.what = from.at("what");
    evidence.expected = from.at("expected").get<std::vector<std::uint32_t>>();
    evidence.actual = from.at("actual").get<std::vector<std::uint32_t>>();
    evidence.differs = from.at("differs").get<std::vector<std::uint8_t>>();
    const bool sizes = evidence.width >= 0 && evidence.height >= 0 && evidence.width <= kEvidenceSize &&
                       evidence.height <= kEvidenceSize && evidence.samples >= 1 && evidence.samples <= 16;
    const auto total = static_cast<std::size_t>(sizes ? evidence.width * evidence.height * evidence.samples : 0);
    if (!sizes || evidence.expected.size() != total || evidence.differs.size() != total ||
        (!evidence.actual.empty() && evidence.actual.size() != total)) {
      throw CertificateError("evidence of another size than it says");
    }
  }
  if (result.due > result.cases || result.done > result.due || result.resume > result.done) {
    throw CertificateError("check " + result.name + " has done more cases than there are");
  }
  return result;
}

}  // namespace

std::string certificate_json(const Certificate& certificate) {
  const Facts& facts = certificate.facts;
  Json json;
  json["format"] = "surefill-certificate";
  json["format_version"] = kFormatVersion;
  json["verdict"] = verdict_name(verdict_of(certificate.results, facts));
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
  if (facts.shard.count > 1) json["shard"] = {{"index", facts.shard.index}, {"count", facts.shard.count}};
  if (facts.of_rival()) {
    json["rival"] = {{"name", facts.rival},
                     {"version", facts.rival_version},
                     {"declared_model", facts.declared_model},
                     {"inferred_model", facts.inferred_model},
                     {"model", facts.model},
                     {"problems", facts.problems}};
    for (const auto& [group, part] : groups_of(certificate.results)) {
      json["verdicts"][group] = verdict_name(verdict_of(part, facts));
    }
  }
  json["means"] = meaning(facts);
  json["limits"] = limits(facts);
  json["checks"] = Json::array();
  for (const CheckResult& result : certificate.results) json["checks"].push_back(json_of(result));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Certificate read_certificate(const std::string& text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object() || json.value("format", "") != "surefill-certificate") {
      throw CertificateError("no certificate of surefill");
    }
    if (json.at("format_version") != kFormatVersion) throw CertificateError("a certificate of another version");
    Certificate certificate;
    Facts& facts = certificate.facts;
    facts.interrupted = json.at("interrupted");
    facts.version = json.at("version");
    facts.commit = json.at("commit");
    facts.compiler = json.at("compiler");
    facts.flags = json.at("flags");
    facts.cpu = json.at("cpu");
    facts.instruction_set = json.at("instruction_set");
    facts.level = json.at("level");
    facts.seed = json.at("seed");
    facts.jobs = json.at("jobs");
    facts.seconds = json.at("seconds");
    if (json.contains("shard")) {
      facts.shard = {json["shard"].at("index"), json["shard"].at("count")};
      if (facts.shard.index < 1 || facts.shard.index > facts.shard.count) throw CertificateError("an impossible shard");
    }
    if (json.contains("rival")) {
      const Json& rival = json["rival"];
      facts.rival = rival.at("name");
      facts.rival_version = rival.at("version");
      facts.declared_model = rival.at("declared_model");
      facts.inferred_model = rival.at("inferred_model");
      facts.model = rival.at("model");
      facts.problems = rival.at("problems").get<std::vector<std::string>>();
    }
    for (const Json& check : json.at("checks")) certificate.results.push_back(result_of(check));
    return certificate;
  } catch (const CertificateError& error) {
    throw CertificateError(file + ": " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw CertificateError(file + ": not a certificate: " + error.what());
  }
}

Certificate read_certificate_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw CertificateError(path + ": cannot be read");
  return read_certificate(text.str(), path);
}

std::string why_not_one_run(const Certificate& a, const Certificate& b) {
  const Facts &f = a.facts, &g = b.facts;
  if (f.version != g.version || f.commit != g.commit) return "another version of surefill";
  if (f.compiler != g.compiler || f.flags != g.flags) return "another build of surefill";
  if (f.level != g.level) return "another level";
  if (f.seed != g.seed) return "another seed";
  if (f.rival != g.rival || f.rival_version != g.rival_version) return "another rasterizer";
  if (f.model != g.model) return "another model of the rasterizer";
  if (f.shard.count != g.shard.count) return "another number of shards";
  if (a.results.size() != b.results.size()) return "another number of checks";
  for (std::size_t n = 0; n < a.results.size(); ++n) {
    if (a.results[n].name != b.results[n].name) return "other checks";
    if (a.results[n].cases != b.results[n].cases) return "another number of cases of " + a.results[n].name;
  }
  return "";
}

Certificate merge(std::span<const Certificate> shards, std::span<const std::string> names) {
  const std::uint64_t count = shards[0].facts.shard.count;
  for (std::size_t n = 0; n < shards.size(); ++n) {
    const std::string why = why_not_one_run(shards[0], shards[n]);
    if (!why.empty()) {
      throw CertificateError(fmt::format("{} does not belong to {}: it is of {}", names[n], names[0], why));
    }
  }
  std::vector<std::uint64_t> order;
  for (std::size_t n = 0; n < shards.size(); ++n) {
    const std::uint64_t index = shards[n].facts.shard.index;
    if (std::find(order.begin(), order.end(), index) != order.end()) {
      throw CertificateError(fmt::format("{}: shard {} of {} is there twice", names[n], index, count));
    }
    order.push_back(index);
  }
  for (std::uint64_t index = 1; index <= count; ++index) {
    if (std::find(order.begin(), order.end(), index) == order.end()) {
      throw CertificateError(fmt::format("shard {} of {} is missing", index, count));
    }
  }
  Certificate whole = shards[0];
  whole.facts.shard = {};
  for (std::size_t n = 1; n < shards.size(); ++n) {
    whole.facts.seconds += shards[n].facts.seconds;
    whole.facts.interrupted = whole.facts.interrupted || shards[n].facts.interrupted;
    if (whole.facts.cpu.find(shards[n].facts.cpu) == std::string::npos) whole.facts.cpu += "; " + shards[n].facts.cpu;
    for (std::size_t c = 0; c < whole.results.size(); ++c) {
      CheckResult& to = whole.results[c];
      const CheckResult& from = shards[n].results[c];
      const bool first = from.failed > 0 && (to.failed == 0 || from.case_number < to.case_number);
      CheckResult sum = first ? from : to;
      sum.due = to.due + from.due;
      sum.done = to.done + from.done;
      sum.skipped = to.skipped + from.skipped;
      sum.failed = to.failed + from.failed;
      sum.samples = to.samples + from.samples;
      sum.differences = to.differences + from.differences;
      sum.seconds = to.seconds + from.seconds;
      sum.deviations = to.deviations;
      sum.deviations.take(from.deviations);
      sum.resume = sum.complete() ? sum.done : 0;
      to = std::move(sum);
    }
  }
  return whole;
}

}  // namespace surefill::certify
