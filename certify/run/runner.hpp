// SPDX-License-Identifier: Apache-2.0
//
// Runs checks on threads, reduces what they find, and collects the results. What is found does not depend on the number
// of threads: sums are over all cases, and of several findings the one of the smallest case number is kept.
#ifndef SUREFILL_CERTIFY_RUNNER_HPP
#define SUREFILL_CERTIFY_RUNNER_HPP

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "certify/run/checks.hpp"
#include "certify/run/evidence.hpp"

namespace surefill::certify {

// One of `count` parts of a run: of every check the cases whose number is `index` - 1 modulo `count`.
struct Shard {
  std::uint64_t index = 1, count = 1;
};

struct CheckResult {
  std::string name, rule, claim, unit, group;
  bool exhaustive = false;
  std::uint64_t cases = 0;    // there are, in all shards
  std::uint64_t due = 0;      // of them, in this shard
  std::uint64_t done = 0;     // of these, skipped ones included
  std::uint64_t resume = 0;   // of these, the first ones that are surely done and in the sums: where a run goes on
  std::uint64_t skipped = 0;  // not applicable: nothing of them is owed, or the engine has no such mode
  std::uint64_t failed = 0;   // cases with a difference
  std::uint64_t samples = 0;  // judged
  std::uint64_t open = 0;     // looked at and not judged, since the model leaves them open (R1)
  std::uint64_t differences = 0;
  double seconds = 0;
  Deviations deviations;
  std::string finding;  // the first difference as it was found, in words
  std::uint64_t case_number = 0;
  std::string scene_text;  // the reduced scene (or that of the finding, while the check is not complete)
  std::string shown;       // the first difference in that scene, in words
  std::string scene;       // path of the reduced scene; empty if there is none
  std::string replay;      // the command that shows it
  Evidence evidence;       // of that scene
  Evidence found;          // of the case as it was found, where values differ at more samples there

  bool complete() const { return done == due; }
  bool passed() const { return complete() && failed == 0; }
  // Passed, and there was something to look at (R16).
  bool checked() const { return passed() && done > skipped && samples > 0; }
  bool not_applicable() const { return passed() && !checked(); }
};

struct RunOptions {
  int jobs = 1;
  std::string output_directory = ".";
  Shard shard;
};

// Prepares all checks first (throws SceneError, MeshError), then runs them in order. `finished` gets each result as
// soon as it is there. `saved` gets all results now and then, such that a run that is given them as `before` goes on
// from there; `before` is empty or has a result for each check, by name. Ends early, with incomplete results for the
// rest, when interrupted(), and where a check says that the run is stopped. Throws FileError where a reduced scene
// cannot be written.
std::vector<CheckResult> run_checks(const Settings& settings, std::vector<Check>& checks, const RunOptions& options,
                                    const std::function<void(const CheckResult&)>& finished,
                                    std::span<const CheckResult> before = {},
                                    const std::function<void(std::span<const CheckResult>)>& saved = {});

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RUNNER_HPP
