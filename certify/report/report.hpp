// SPDX-License-Identifier: Apache-2.0
//
// The certificate, for people; certificate.hpp has it as JSON.
#ifndef SUREFILL_CERTIFY_REPORT_HPP
#define SUREFILL_CERTIFY_REPORT_HPP

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "certify/run/runner.hpp"

namespace surefill::certify {

// What the certificate is about.
struct Facts {
  std::string version, commit, compiler, flags, cpu, instruction_set, level;
  std::uint64_t seed = 0;
  int jobs = 1;
  double seconds = 0;
  bool interrupted = false;
  std::string stopped;  // why the run ended before its end; empty: it did not
  Shard shard;
  // Of a rival; empty where it is the engine that is certified.
  std::string rival, rival_version, declared_model, inferred_model, model;
  std::vector<std::string> departures;  // what a newcomer would not expect of the model, a sentence each
  std::vector<std::string> names;       // what is wrong with it, the best explanation first
  std::vector<std::string> open;        // what could not be found out, and why
  std::string turns;                    // the table of turns, for people
  std::vector<std::string> problems;    // what no model explains

  bool of_rival() const { return !rival.empty(); }
};

// The processor's name, as the system has it.
std::string cpu_model();

// Version, commit, compiler, flags, cpu, instruction_set.
Facts build_facts();

// "surefill 0.2.0 (commit)".
std::string version_line();

// The line of one check, with a second one for what was found.
std::string check_line(const CheckResult& result, std::uint64_t seed);

enum class Verdict { certified, not_certified, incomplete };

Verdict verdict_of(std::span<const CheckResult> results, const Facts& facts);

// The block after the lines: the verdict, what it means and what not, the facts.
std::string verdict_block(std::span<const CheckResult> results, const Facts& facts);

// What the certificate claims if there are no differences, and what it does not.
std::string meaning(const Facts& facts);
std::vector<std::string> limits(const Facts& facts);
const char* verdict_name(Verdict verdict);

// A text without the ends of its lines.
std::vector<std::string> lines_of(const std::string& text);

// "1,234,567".
std::string grouped(std::uint64_t number);

// "depth 3 ULP, 0.02 of what is granted; ..."; empty where there are none.
std::string deviations_text(const Deviations& deviations);

// The verdicts of the groups, in order: group and its results. One group without a name where there are none.
std::vector<std::pair<std::string, std::vector<CheckResult>>> groups_of(std::span<const CheckResult> results);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_HPP
