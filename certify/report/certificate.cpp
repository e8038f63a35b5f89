// SPDX-License-Identifier: Apache-2.0
#include "certify/report/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

namespace surefill::certify {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 4;
constexpr std::uint64_t kMostShards = 100000;
// Of anything that is counted: sums over all shards stay below 2^64.
constexpr std::uint64_t kMostCounted = std::uint64_t{1} << 46;

// FNV-1a of the members but "checksum" itself: it notices what was edited by hand or damaged on the way, and is no
// signature.
std::string checksum_of(Json json) {
  json.erase("checksum");
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  }
  return fmt::format("{:016x}", hash);
}

// The parts of a certificate are this many levels deep at most: a file of a million brackets is refused early.
constexpr int kDeepest = 8;

Json parse_certificate(const std::string& text) {
  return Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw CertificateError("not a certificate: it is nested too deeply");
    return true;
  });
}

// Members of the type that is written, which json's own conversions do not insist on: they make -5 a large number.
std::uint64_t count_of(const Json& json, const char* key, std::uint64_t most = kMostCounted) {
  const Json& value = json.at(key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
    throw CertificateError(fmt::format("\"{}\" is no number from 0 to {}", key, most));
  }
  return value.get<std::uint64_t>();
}

double duration_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  if (!value.is_number() || !(value.get<double>() >= 0)) {
    throw CertificateError(fmt::format("\"{}\" is no time", key));
  }
  return value.get<double>();
}

template <typename Value>
std::vector<Value> numbers_of(const Json& json, const char* key, std::uint64_t most) {
  std::vector<Value> values;
  for (const Json& value : json.at(key)) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
      throw CertificateError(fmt::format("\"{}\" holds what is no number from 0 to {}", key, most));
    }
    values.push_back(static_cast<Value>(value.get<std::uint64_t>()));
  }
  return values;
}

// JSON has no infinities.
Json json_of(double value) {
  return std::isfinite(value) ? Json(value) : Json("infinite");
}

double number_or_infinite(const Json& value, const char* key) {
  if (value == "infinite") return HUGE_VAL;
  if (!value.is_number() || !(value.get<double>() >= 0)) {
    throw CertificateError(fmt::format("\"{}\" is no error", key));
  }
  return value.get<double>();
}

double error_of(const Json& json, const char* key) {
  return number_or_infinite(json.at(key), key);
}

Json json_of(const Deviations& deviations) {
  Json json;
  const auto add = [&json](const char* name, const Deviation& deviation) {
    if (deviation.ulp > 0) json[name] = {{"ulp", json_of(deviation.ulp)}, {"granted", json_of(deviation.granted)}};
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
    deviation.ulp = error_of(json[name], "ulp");
    deviation.granted = error_of(json[name], "granted");
  };
  get("depth", deviations.depth);
  get("barycentrics", deviations.barycentrics);
  get("attributes", deviations.attributes);
  return deviations;
}

Json json_of(const Evidence& evidence) {
  Json json{{"x0", evidence.x0},
            {"y0", evidence.y0},
            {"width", evidence.width},
            {"height", evidence.height},
            {"samples", evidence.samples},
            {"what", evidence.what},
            {"expected", evidence.expected},
            {"actual", evidence.actual},
            {"differs", evidence.differs}};
  for (const properties::Exhibit::Value& v : evidence.values) {
    json["values"].push_back({v.sample, v.output, v.expected, v.actual, json_of(v.error)});
  }
  return json;
}

Evidence evidence_of(const Json& from) {
  Evidence evidence;
  const auto size_of = [&from](const char* key) {
    return static_cast<int>(count_of(from, key, std::numeric_limits<int>::max()));
  };
  evidence.x0 = size_of("x0");
  evidence.y0 = size_of("y0");
  evidence.width = size_of("width");
  evidence.height = size_of("height");
  evidence.samples = size_of("samples");
  evidence.what = from.at("what");
  evidence.expected = numbers_of<std::uint32_t>(from, "expected", 0xFFFFFFFFu);
  evidence.actual = numbers_of<std::uint32_t>(from, "actual", 0xFFFFFFFFu);
  evidence.differs = numbers_of<std::uint8_t>(from, "differs", 1);
  const bool sizes = evidence.width <= kEvidenceSize && evidence.height <= kEvidenceSize && evidence.samples >= 1 &&
                     evidence.samples <= 16;
  const auto total = static_cast<std::size_t>(sizes ? evidence.width * evidence.height * evidence.samples : 0);
  if (!sizes || evidence.expected.size() != total || evidence.differs.size() != total ||
      (!evidence.actual.empty() && evidence.actual.size() != total)) {
    throw CertificateError("evidence of another size than it says");
  }
  for (const Json& value : from.value("values", Json::array())) {
    const Json& sample = value.at(0);
    if (!sample.is_number_unsigned() || sample.get<std::uint64_t>() >= total) {
      throw CertificateError("a value that is no sample's of the evidence");
    }
    evidence.values.push_back({sample.get<std::size_t>(), value.at(1).get<std::string>(),
                               value.at(2).get<std::string>(), value.at(3).get<std::string>(),
                               number_or_infinite(value.at(4), "values")});
  }
  return evidence;
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
  check["open"] = result.open;
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
  if (result.evidence.width > 0) check["evidence"] = json_of(result.evidence);
  if (result.found.width > 0) check["evidence_as_found"] = json_of(result.found);
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
  result.cases = count_of(check, "cases");
  result.due = count_of(check, "due");
  result.done = count_of(check, "done");
  result.resume = count_of(check, "resume");
  result.skipped = count_of(check, "skipped");
  result.failed = count_of(check, "failed");
  result.samples = count_of(check, "samples");
  result.open = count_of(check, "open");
  result.differences = count_of(check, "differences");
  result.seconds = duration_of(check, "seconds");
  if (check.contains("largest_errors")) result.deviations = deviations_of(check["largest_errors"]);
  result.finding = check.value("finding", "");
  if (check.contains("case")) result.case_number = count_of(check, "case");
  result.shown = check.value("shown", "");
  result.scene = check.value("scene", "");
  result.replay = check.value("replay", "");
  result.scene_text = check.value("scene_text", "");
  if (check.contains("evidence")) result.evidence = evidence_of(check["evidence"]);
  if (check.contains("evidence_as_found")) result.found = evidence_of(check["evidence_as_found"]);
  return result;
}

// What holds of the counts of every check, however it ended.
void check_counts(const CheckResult& result, const Shard& shard) {
  const auto refuse = [&result](const char* what) { throw CertificateError("check " + result.name + ": " + what); };
  if (result.due > result.cases || result.done > result.due || result.resume > result.done) {
    refuse("it has done more cases than there are");
  }
  if (result.due != (result.cases + shard.count - shard.index) / shard.count) {
    refuse("other cases are due than its shard has");
  }
  if (result.skipped > result.done || result.failed > result.done - result.skipped) {
    refuse("more cases were skipped or failed than were done");
  }
  if ((result.failed == 0) != (result.differences == 0) || result.differences < result.failed) {
    refuse("its differences do not fit the cases that failed");
  }
  if ((result.failed == 0) != result.finding.empty()) refuse("its finding does not fit the cases that failed");
  if (result.failed > 0 && result.case_number >= result.cases) refuse("its finding is of a case that there is not");
}

// What holds of a certificate as a whole.
void check_consistent(const Json& json, const Certificate& certificate) {
  std::set<std::string> names;
  for (const CheckResult& result : certificate.results) {
    check_counts(result, certificate.facts.shard);
    if (!names.insert(result.name).second) throw CertificateError("check " + result.name + " is there twice");
  }
  const std::string verdict = verdict_name(verdict_of(certificate.results, certificate.facts));
  if (json.at("verdict") != verdict) {
    throw CertificateError(fmt::format("its verdict is {}, its checks say {}", json["verdict"].dump(), verdict));
  }
}

}  // namespace

std::string certificate_json(const Certificate& certificate) {
  const Facts& facts = certificate.facts;
  Json json;
  json["format"] = "surefill-certificate";
  json["format_version"] = kFormatVersion;
  json["verdict"] = verdict_name(verdict_of(certificate.results, facts));
  json["interrupted"] = facts.interrupted;
  if (!facts.stopped.empty()) json["stopped"] = facts.stopped;
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
                     {"departures", facts.departures},
                     {"names", facts.names},
                     {"open", facts.open},
                     {"turns", facts.turns},
                     {"problems", facts.problems}};
    for (const auto& [group, part] : groups_of(certificate.results)) {
      json["verdicts"][group] = verdict_name(verdict_of(part, facts));
    }
  }
  json["means"] = meaning(facts);
  json["limits"] = limits(facts);
  json["checks"] = Json::array();
  for (const CheckResult& result : certificate.results) json["checks"].push_back(json_of(result));
  json["checksum"] = checksum_of(json);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string with_checksum(const std::string& text) {
  try {
    Json json = parse_certificate(text);
    if (!json.is_object()) return text;
    json["checksum"] = checksum_of(json);
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  } catch (const CertificateError&) {
    return text;
  } catch (const nlohmann::json::exception&) {
    return text;
  }
}

Certificate read_certificate(const std::string& text, const std::string& file) {
  try {
    const Json json = parse_certificate(text);
    if (!json.is_object() || json.value("format", "") != "surefill-certificate") {
      throw CertificateError("no certificate of surefill");
    }
    if (json.at("format_version") != kFormatVersion) {
      throw CertificateError(fmt::format("a certificate of another version: {}, where {} is read",
                                         json["format_version"].dump(), kFormatVersion));
    }
    if (json.at("checksum") != checksum_of(json)) {
      throw CertificateError("its checksum is not that of its content: it was edited or damaged");
    }
    Certificate certificate;
    Facts& facts = certificate.facts;
    facts.interrupted = json.at("interrupted");
    facts.stopped = json.value("stopped", "");
    facts.version = json.at("version");
    facts.commit = json.at("commit");
    facts.compiler = json.at("compiler");
    facts.flags = json.at("flags");
    facts.cpu = json.at("cpu");
    facts.instruction_set = json.at("instruction_set");
    facts.level = json.at("level");
    facts.seed = count_of(json, "seed", ~std::uint64_t{0});
    facts.jobs = static_cast<int>(count_of(json, "jobs", 4096));
    facts.seconds = duration_of(json, "seconds");
    if (json.contains("shard")) {
      facts.shard = {count_of(json["shard"], "index", kMostShards), count_of(json["shard"], "count", kMostShards)};
      if (facts.shard.index < 1 || facts.shard.index > facts.shard.count) throw CertificateError("an impossible shard");
    }
    if (json.contains("rival")) {
      const Json& rival = json["rival"];
      facts.rival = rival.at("name");
      facts.rival_version = rival.at("version");
      facts.declared_model = rival.at("declared_model");
      facts.inferred_model = rival.at("inferred_model");
      facts.model = rival.at("model");
      facts.departures = rival.at("departures").get<std::vector<std::string>>();
      facts.names = rival.at("names").get<std::vector<std::string>>();
      facts.open = rival.at("open").get<std::vector<std::string>>();
      facts.turns = rival.at("turns");
      facts.problems = rival.at("problems").get<std::vector<std::string>>();
    }
    for (const Json& check : json.at("checks")) certificate.results.push_back(result_of(check));
    check_consistent(json, certificate);
    return certificate;
  } catch (const CertificateError& error) {
    throw CertificateError(file + ": " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw CertificateError(file + ": not a certificate: " + error.what());
  }
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
    if (whole.facts.stopped.empty()) whole.facts.stopped = shards[n].facts.stopped;
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
      sum.open = to.open + from.open;
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
