// SPDX-License-Identifier: Apache-2.0
//
// The certificate, for people and as JSON.
#ifndef SUREFILL_CERTIFY_REPORT_HPP
#define SUREFILL_CERTIFY_REPORT_HPP

#include <cstdint>
#include <span>
#include <string>

#include "certify/runner.hpp"

namespace surefill::certify {

// What the certificate is about.
struct Facts {
  std::string version, commit, compiler, flags, cpu, instruction_set, level;
  std::uint64_t seed = 0;
  int jobs = 1;
  double seconds = 0;
  bool interrupted = false;
};

// Everything but level, seed, jobs, seconds, interrupted.
Facts build_facts();

// "surefill 0.1.0 (commit)".
std::string version_line();

// The line of one check, with a second one for what was found.
std::string check_line(const CheckResult& result, std::uint64_t seed);

enum class Verdict { certified, not_certified, incomplete };

Verdict verdict_of(std::span<const CheckResult> results, const Facts& facts);

// The block after the lines: the verdict, what it means and what not, the facts.
std::string verdict_block(std::span<const CheckResult> results, const Facts& facts);

// The same as JSON, with a final newline.
std::string certificate_json(std::span<const CheckResult> results, const Facts& facts);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_HPP
