// SPDX-License-Identifier: Apache-2.0
//
// Runs checks on threads, reduces what they find, and collects the results. What is found does not depend on the number
// of threads: sums are over all cases, and of several findings the one of the smallest case number is kept.
#ifndef SUREFILL_CERTIFY_RUNNER_HPP
#define SUREFILL_CERTIFY_RUNNER_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "certify/checks.hpp"

namespace surefill::certify {

struct CheckResult {
  std::string name, rule, claim, unit;
  bool exhaustive = false;
  std::uint64_t cases = 0;    // there are
  std::uint64_t done = 0;     // of them, skipped ones included
  std::uint64_t skipped = 0;  // for modes that the engine does not have
  std::uint64_t failed = 0;   // cases with a difference
  std::uint64_t samples = 0;  // compared
  std::uint64_t differences = 0;
  double seconds = 0;
  std::string finding;  // the first difference of the reduced scene, in words
  std::uint64_t case_number = 0;
  std::string scene;   // path of the reduced scene; empty if there is none
  std::string replay;  // the command that shows it

  bool complete() const { return done == cases; }
  bool passed() const { return complete() && failed == 0; }
  // Passed, and there was something to look at.
  bool checked() const { return passed() && done > skipped; }
};

struct RunOptions {
  int jobs = 1;
  std::string output_directory = ".";
};

// Prepares all checks first (throws SceneError, MeshError), then runs them in order. `finished` gets each result as
// soon as it is there. Ends early, with incomplete results for the rest, when interrupted(). Throws FileError where a
// reduced scene cannot be written.
std::vector<CheckResult> run_checks(const Settings& settings, std::vector<Check>& checks, const RunOptions& options,
                                    const std::function<void(const CheckResult&)>& finished);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RUNNER_HPP
