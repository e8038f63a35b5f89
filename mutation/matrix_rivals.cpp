// SPDX-License-Identifier: Apache-2.0
#include "mutation/matrix_rivals.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <thread>

#include "certify/commands/certify_command.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/run/progress.hpp"
#include "mutation/zoo/names.hpp"
#include "mutation/zoo/right.hpp"
#include "mutation/zoo/zoo.hpp"

namespace surefill::mutation {
namespace {

using certify::interrupted;

struct Animal {
  std::string name;
  bool right;
};

std::vector<Animal> animals(const std::vector<std::string>& only) {
  std::vector<Animal> all = {{adapters::kExactName, true}, {adapters::kExactSecondName, true}};
  for (const adapters::GridRasterizer& grid : adapters::grid_rasterizers()) all.push_back({grid.name, true});
  for (std::size_t n = 0; n < zoo::right_rasterizers().size(); ++n) all.push_back({zoo::right_name(n), true});
  // The fill rules closed and open are no part of the adapter's version 1, which the zoo's plugin speaks.
  const auto shown = [](std::string_view name) { return name != "closed-as-top-left" && name != "open-as-closed"; };
  for (const zoo::Specimen& specimen : zoo::rival_specimens()) {
    if (shown(specimen.name)) all.push_back({specimen.name, false});
  }
  const auto matches = [](const std::string& pattern, const Animal& animal) {
    return fnmatch(pattern.c_str(), animal.name.c_str(), 0) == 0;
  };
  for (const std::string& pattern : only) {
    if (std::none_of(all.begin(), all.end(), [&](const Animal& animal) { return matches(pattern, animal); })) {
      throw certify::UsageError("--only " + pattern + ": the zoo has no rasterizer of this name");
    }
  }
  std::erase_if(all, [&](const Animal& animal) {
    return !only.empty() &&
           std::none_of(only.begin(), only.end(), [&](const auto& pattern) { return matches(pattern, animal); });
  });
  return all;
}

struct Outcome {
  std::string check, finding;  // empty: none
  std::uint64_t cases = 0, samples = 0;
};

// The checks of a level, in turns of a twentieth of a second, until one has a finding or all are through.
Outcome first_finding(const ZooRivalOptions& options, const Animal& animal) {
  certify::RivalChoice choice;
  choice.plugin = options.plugin;
  choice.arguments = (options.undeclared ? "undeclared-" : "") + animal.name;
  choice.time_limit = 120;  // most are exact arithmetic, slow on meshes
  Outcome outcome;
  const std::unique_ptr<adapters::Rival> rival = certify::start_rival(choice);
  const certify::RivalSubject subject = certify::meet_rival(*rival);
  std::vector<certify::Check> checks = certify::list_rival_checks(options.settings, subject);
  std::vector<std::uint64_t> cases, next(checks.size());
  for (certify::Check& check : checks) cases.push_back(check.prepare());
  for (bool left = true; left && !interrupted();) {
    left = false;
    for (std::size_t i = 0; i < checks.size(); ++i) {
      const auto turn = std::chrono::steady_clock::now();
      while (next[i] < cases[i] && std::chrono::steady_clock::now() - turn < std::chrono::milliseconds(50)) {
        const certify::CaseResult result = checks[i].run(next[i]++);
        ++outcome.cases;
        outcome.samples += result.samples;
        if (result.differences == 0) continue;
        outcome.check = checks[i].name;
        outcome.finding = result.finding;
        return outcome;
      }
      left = left || next[i] < cases[i];
    }
  }
  return outcome;
}

}  // namespace

bool zoo_rivals(const ZooRivalOptions& options, const std::function<void(const std::string&)>& print) {
  std::vector<Animal> all = animals(options.only);
  if (options.undeclared) std::erase_if(all, [](const Animal& animal) { return animal.right; });
  std::atomic<std::size_t> next{0};
  std::size_t right = 0, certified = 0, rejected = 0;
  std::string failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < all.size() && !interrupted(); i = next++) {
      Outcome outcome;
      try {
        outcome = first_finding(options, all[i]);
      } catch (const std::exception& error) {
        const std::lock_guard lock(mutex);
        failure = error.what();
        return;
      }
      if (interrupted()) return;
      const std::lock_guard lock(mutex);
      const bool good = outcome.check.empty() == all[i].right;
      if (all[i].right) ++right;
      if (good) ++(outcome.check.empty() ? certified : rejected);
      print(fmt::format("{}{:32} {} {:>7} cases{}\n", good ? "" : "FAILED  ", all[i].name,
                        outcome.check.empty() ? "CERTIFIED after    " : "NOT CERTIFIED after", outcome.cases,
                        outcome.check.empty() ? "" : fmt::format(", {}: {}", outcome.check, outcome.finding)));
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < options.jobs; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (!failure.empty()) throw certify::UsageError(failure);
  const std::size_t specimens = all.size() - right;
  print(fmt::format("{} of {} specimens not certified, {} of {} right rasterizers certified{}\n", rejected, specimens,
                    certified, right, interrupted() ? ": interrupted" : ""));
  return rejected + certified == all.size();
}

}  // namespace surefill::mutation
