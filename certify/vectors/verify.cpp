// SPDX-License-Identifier: Apache-2.0
//
// Results of somebody's rasterizer, held against the files.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "certify/vectors/vectors.hpp"

namespace surefill::vectors {
namespace {

using Json = nlohmann::json;
using Values = std::vector<std::uint32_t>;

std::uint32_t bits_of(const std::string& text) {
  return static_cast<std::uint32_t>(std::stoul(text, nullptr, 16));
}

// Alternately run and value; an interval's ends go apart.
void unroll(const Json& runs, Values& low, Values& high) {
  for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
    std::uint32_t first = 0, last = 0;
    if (runs[i + 1].is_string()) {
      const std::string text = runs[i + 1];
      first = last = bits_of(text.substr(0, 8));
      if (text.size() == 17) last = bits_of(text.substr(9));
    } else {
      first = last = static_cast<std::uint32_t>(runs[i + 1].get<std::int64_t>());
    }
    low.insert(low.end(), runs[i], first), high.insert(high.end(), runs[i], last);
  }
}

// The planes of one frame, in the order of the text.
void planes_of(const Json& expected, std::vector<std::string>& names, std::vector<Values>& low,
               std::vector<Values>& high) {
  const auto add = [&](const std::string& name, const Json& runs) {
    names.push_back(name);
    unroll(runs, low.emplace_back(), high.emplace_back());
  };
  if (expected.contains("count")) add("count", expected["count"]);
  if (expected.contains("open")) {
    Values open, same;
    unroll(expected["open"], open, same);
    for (std::size_t s = 0; s < open.size(); ++s) high.back()[s] += open[s];
  }
  for (const char* name : {"index", "depth"})
    if (expected.contains(name)) add(name, expected[name]);
  if (expected.contains("barycentrics"))
    for (std::size_t i = 0; i < 3; ++i) add("b" + std::to_string(i), expected["barycentrics"][i]);
  if (expected.contains("attributes"))
    for (std::size_t k = 0; k < expected["attributes"].size(); ++k)
      for (std::size_t c = 0; c < expected["attributes"][k].size(); ++c)
        add(fmt::format("a{}.{}", k, c), expected["attributes"][k][c]);
  if (expected.contains("winding")) add("winding", expected["winding"]);
}

bool is_whole(const std::string& plane) {
  return plane == "count" || plane == "index" || plane == "winding";
}

bool right(const std::string& plane, std::uint32_t value, std::uint32_t low, std::uint32_t high) {
  if (low == high) return value == low;
  if (is_whole(plane)) return low <= value && value <= high;
  const float v = std::bit_cast<float>(value);
  return std::bit_cast<float>(low) <= v && v <= std::bit_cast<float>(high);
}

std::string said(const std::string& plane, std::uint32_t value) {
  if (plane == "winding") return std::to_string(static_cast<std::int32_t>(value));
  return is_whole(plane) ? std::to_string(value) : fmt::format("{:08x} ({:.9g})", value, std::bit_cast<float>(value));
}

// Where the results of a frame have a plane.
Json::json_pointer pointer_to(const std::string& plane) {
  if (plane[0] == 'b') return Json::json_pointer("/barycentrics/" + plane.substr(1));
  const std::size_t point = plane.find('.');
  if (point == std::string::npos) return Json::json_pointer("/" + plane);
  return Json::json_pointer("/attributes/" + plane.substr(1, point - 1) + "/" + plane.substr(point + 1));
}

// The plane's runs as text; none where the frame has no such plane. Throws std::invalid_argument, which says what is
// wrong with them.
std::string runs_of(const Json& frame, const std::string& plane) {
  const Json::json_pointer pointer = pointer_to(plane);
  if (!frame.is_object()) throw std::invalid_argument("the frame is no object");
  if (!frame.contains(pointer)) return " 0";
  const Json& runs = frame[pointer];
  if (!runs.is_array() || runs.size() % 2 != 0)
    throw std::invalid_argument("no array of lengths and values, alternately");
  std::string words = fmt::format(" {}", runs.size() / 2);
  for (std::size_t i = 0; i < runs.size(); i += 2) {
    const Json& value = runs[i + 1];
    if (!runs[i].is_number_unsigned())
      throw std::invalid_argument(runs[i].dump().substr(0, 40) + " is no length of a run");
    if (is_whole(plane)) {
      if (!value.is_number_integer()) throw std::invalid_argument(value.dump().substr(0, 40) + " is no whole number");
      words += fmt::format(" {} {}", runs[i].dump(), value.dump());
    } else {
      const std::string bits = value.is_string() ? value.get<std::string>() : "";
      if (bits.size() != 8 || bits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::invalid_argument(value.dump().substr(0, 40) + " is not the bits of a float32, eight digits");
      words += fmt::format(" {} {}", runs[i].dump(), bits);
    }
  }
  return words;
}

// What is wrong with a line, or nothing. `words` are those after the id.
std::string fault_of(const Owed& owed, std::istringstream& words) {
  for (std::size_t f = 0; f < owed.low.size(); ++f) {
    for (std::size_t p = 0; p < owed.low[f].size(); ++p) {
      const std::string& name = owed.names[p];
      const Values &low = owed.low[f][p], &high = owed.high[f][p];
      const std::string where = owed.low.size() == 1 ? name : fmt::format("frame {}, {}", f, name);
      std::size_t runs = 0, at = 0;
      if (!(words >> runs)) return where + ": the line ends";
      for (std::size_t r = 0; r < runs; ++r) {
        std::size_t run = 0;
        std::string text;
        if (!(words >> run >> text)) return where + ": the line ends";
        std::uint32_t value = 0;
        try {
          std::size_t used = 0;
          const long long number = std::stoll(text, &used, is_whole(name) ? 10 : 16);
          if (used != text.size() || number > 0xFFFFFFFFll || number < (name == "winding" ? -0x80000000ll : 0))
            throw std::out_of_range(text);
          value = static_cast<std::uint32_t>(number);
        } catch (const std::logic_error&) {
          return where + ": not a number: " + text.substr(0, 40);
        }
        if (run > low.size() - at) return fmt::format("{}: more than {} samples", where, low.size());
        for (const std::size_t end = at + run; at < end; ++at) {
          if (right(name, value, low[at], high[at])) continue;
          return fmt::format("{} of sample {}: {}{}{} expected, got {}", where, at, said(name, low[at]),
                             low[at] == high[at] ? "" : " to ", low[at] == high[at] ? "" : said(name, high[at]),
                             said(name, value));
        }
      }
      if (at != low.size()) return fmt::format("{}: {} samples of {}", where, at, low.size());
    }
  }
  std::string more;
  return words >> more ? "the line goes on: " + more.substr(0, 40) : "";
}

// The faults whose tests are those that failed, or nearly: |both| / |either|, the best first.
std::string likely(std::span<const Owed> owed, const std::set<int>& answered, const std::set<int>& failed) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> seen;  // failed ones that show it, all that show it
  for (const Owed& test : owed) {
    if (!answered.contains(test.id)) continue;
    for (const std::string& fault : test.kills) seen[fault].first += failed.contains(test.id), ++seen[fault].second;
  }
  std::vector<std::pair<double, std::string>> ranks;
  for (const auto& [fault, n] : seen)
    if (n.first != 0)
      ranks.emplace_back(-static_cast<double>(n.first) / static_cast<double>(failed.size() + n.second - n.first),
                         fault);
  std::sort(ranks.begin(), ranks.end());
  std::string text;
  constexpr double kLeast = 0.2;  // below that, what failed is another fault than those that are known
  if (ranks.empty() || -ranks[0].first < kLeast) return text;
  for (std::size_t i = 0; i < ranks.size() && i < 3 && ranks[i].first <= 0.8 * ranks[0].first; ++i) {
    const auto& n = seen[ranks[i].second];
    text += fmt::format("{}{} ({} of {} that failed, {} of {} that show it)", i == 0 ? "" : ", ", ranks[i].second,
                        n.first, failed.size(), n.first, n.second);
  }
  return text;
}

Json read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  try {
    return Json::parse(file);
  } catch (const Json::exception& error) {
    throw std::runtime_error(path + ": no JSON: " + error.what());
  }
}

}  // namespace

std::vector<std::string> subjects_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  if (names.empty()) throw std::runtime_error(folder + ": no files of vectors");
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<Owed> read_owed(const std::string& folder, const std::string& subject) {
  const std::string path = folder + "/" + subject + ".json";
  const Json document = read_json(path);
  try {
    if (document.at("format") != "surefill-vectors" || document.at("version") != 1)
      throw std::runtime_error(path + ": no vectors of version 1");
    std::vector<Owed> all;
    for (const Json& test : document.at("tests")) {
      Owed& owed = all.emplace_back();
      owed.id = test.at("id"), owed.subject = subject, owed.kills = test.at("kills").get<std::set<std::string>>();
      for (const Json& frame : test.at("frames")) {
        owed.names.clear();
        planes_of(frame.at("expected"), owed.names, owed.low.emplace_back(), owed.high.emplace_back());
      }
    }
    return all;
  } catch (const Json::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

std::string lines_of_json(const std::string& text, const std::string& path, std::span<const Owed> owed) {
  std::map<std::int64_t, const Owed*> by_id;
  for (const Owed& test : owed) by_id[test.id] = &test;
  const auto refuse = [&path](const std::string& cause) { throw std::runtime_error(path + ": " + cause); };
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::exception& error) {
    refuse(std::string("no JSON: ") + error.what());
  }
  if (!document.is_object() || !document.contains("results") || !document["results"].is_array())
    refuse("no results: {\"results\": [{\"id\": ..., \"frames\": [...]}]} is expected");
  std::string lines;
  std::size_t number = 0;
  for (const Json& result : document["results"]) {
    const std::string where = fmt::format("result {}", ++number);
    if (!result.is_object() || !result.contains("id") || !result["id"].is_number_integer())
      refuse(where + ": no id, which is a whole number");
    const auto found = by_id.find(result["id"].get<std::int64_t>());
    if (found == by_id.end()) refuse(fmt::format("{}: {} is the number of no test", where, result["id"].dump()));
    const Owed* test = std::exchange(found->second, nullptr);
    if (test == nullptr) refuse(fmt::format("{}: test {} a second time", where, found->first));
    if (!result.contains("frames") || !result["frames"].is_array() || result["frames"].size() != test->low.size())
      refuse(fmt::format("{}, test {}: no array of frames, {} of them", where, test->id, test->low.size()));
    lines += std::to_string(test->id);
    for (std::size_t f = 0; f < test->low.size(); ++f) {
      for (const std::string& name : test->names) {
        try {
          lines += runs_of(result["frames"][f], name);
        } catch (const std::invalid_argument& error) {
          refuse(fmt::format("{}, test {}, frame {}, {}: {}", where, test->id, f, name, error.what()));
        }
      }
    }
    lines += '\n';
  }
  return lines;
}

Tables tables_of(const std::string& folder) {
  Tables tables;
  tables.files =
      "| file | what it is about | owed under | tests | faults that it shows | KB |\n|---|---|---|---:|---:|---:|\n";
  std::vector<std::string> names = subjects_in(folder);
  std::map<std::string, std::map<std::string, int>> shown;  // by file, fault: tests
  for (const std::string& name : names) {
    const Json document = read_json(folder + "/" + name + ".json");
    std::set<std::string> models;
    for (const Json& test : document.at("tests")) {
      models.insert(test.at("models").at(0));
      for (const std::string fault : test.at("kills")) ++shown[name][fault];
    }
    std::string owed;
    for (const std::string& model : models) owed += (owed.empty() ? "" : ", ") + model;
    tables.files +=
        fmt::format("| [{0}](../vectors/{0}.json) | {1} | {2} | {3} | {4} | {5} |\n", name,
                    document.at("title").get<std::string>(), owed, document.at("tests").size(), shown[name].size(),
                    (std::filesystem::file_size(folder + "/" + name + ".json") + 500) / 1000);
  }
  std::erase(names, "smoke");
  names.push_back("smoke");
  tables.matrix = "| fault |";
  std::string rule = "|---|";
  for (const std::string& name : names) tables.matrix += " " + name + " |", rule += "---:|";
  tables.matrix += "\n" + rule + "\n";
  tables.not_shown = "| fault | why no file shows it |\n|---|---|\n";
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    if (!why_not_shown(specimen.name).empty()) {
      tables.not_shown += fmt::format("| {} | {} |\n", specimen.name, why_not_shown(specimen.name));
      continue;
    }
    tables.matrix += fmt::format("| {} |", specimen.name);
    for (const std::string& name : names) {
      const int n = shown[name][specimen.name];
      tables.matrix += n == 0 ? " |" : fmt::format(" {} |", n);
    }
    tables.matrix += "\n";
  }
  return tables;
}

Verdict verify(std::span<const Owed> owed, std::string_view lines, const std::set<int>& smoke) {
  std::map<int, const Owed*> by_id;
  for (const Owed& test : owed) by_id[test.id] = &test;
  std::set<int> answered, failed;
  std::set<std::string> subjects;
  Verdict verdict;
  std::istringstream all{std::string(lines)};
  std::size_t number = 0, wrong = 0;
  for (std::string line; std::getline(all, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    int id = 0;
    if (!(words >> id) || !by_id.contains(id)) {
      verdict.text += fmt::format("line {}: begins with the number of no test\n", number), ++wrong;
      continue;
    }
    const Owed& test = *by_id[id];
    if (!answered.insert(id).second) {
      verdict.text += fmt::format("line {}: test {} a second time\n", number, id), ++wrong;
      continue;
    }
    subjects.insert(test.subject);
    const std::string fault = fault_of(test, words);
    if (fault.empty()) continue;
    failed.insert(id);
    if (failed.size() <= 20) verdict.text += fmt::format("{} test {}: {}\n", test.subject, id, fault);
  }
  if (failed.size() > 20) verdict.text += fmt::format("and {} more\n", failed.size() - 20);
  const bool smoke_alone = std::includes(smoke.begin(), smoke.end(), answered.begin(), answered.end());
  std::size_t missing = 0;
  for (const Owed& test : owed) {
    const bool asked = smoke_alone ? smoke.contains(test.id) : subjects.contains(test.subject);
    missing += asked && !answered.contains(test.id);
  }
  if (!failed.empty()) {
    const std::string names = likely(owed, answered, failed);
    if (!names.empty()) verdict.text += "likely: " + names + "\n";
  }
  verdict.passed = wrong == 0 && failed.empty() && missing == 0 && !answered.empty();
  verdict.text += fmt::format("{}: {} tests answered, {} right, {} wrong; {} of the same files without an answer\n",
                              verdict.passed ? "PASSED" : "FAILED", answered.size(), answered.size() - failed.size(),
                              failed.size(), missing);
  return verdict;
}

}  // namespace surefill::vectors
