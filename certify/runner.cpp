// SPDX-License-Identifier: Apache-2.0
#include "certify/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "certify/files.hpp"
#include "certify/progress.hpp"
#include "properties/reduce.hpp"

namespace surefill::certify {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kReductionTime{20};  // for one finding

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The sums over the cases so far, and the finding of the smallest case number.
struct Tally {
  std::uint64_t done = 0, skipped = 0, failed = 0, samples = 0, differences = 0;
  std::uint64_t number = ~std::uint64_t{0};
  CaseResult finding;

  void add(std::uint64_t case_number, CaseResult&& result) {
    ++done;
    if (result.skipped) ++skipped;
    samples += result.samples;
    differences += result.differences;
    if (result.differences == 0) return;
    ++failed;
    if (case_number >= number) return;
    number = case_number;
    finding = std::move(result);
  }

  void add(Tally&& other) {
    done += other.done;
    skipped += other.skipped;
    failed += other.failed;
    samples += other.samples;
    differences += other.differences;
    if (other.number >= number) return;
    number = other.number;
    finding = std::move(other.finding);
  }
};

CaseResult guarded(const Check& check, std::uint64_t number) {
  try {
    return check.run(number);
  } catch (const std::exception& error) {
    CaseResult result;
    result.differences = 1;
    result.finding = fmt::format("the case ended with an exception: {}", error.what());
    return result;
  }
}

// All cases of a check, taken in chunks by `jobs` threads. `watch` is called ten times a second with the cases done.
Tally run_cases(const Check& check, std::uint64_t cases, int jobs, const std::function<void(std::uint64_t)>& watch) {
  const std::uint64_t threads = std::clamp<std::uint64_t>(cases, 1, static_cast<std::uint64_t>(jobs));
  const std::uint64_t chunk = std::clamp<std::uint64_t>(cases / (threads * 64), 1, 1024);
  std::atomic<std::uint64_t> next = 0, done = 0;
  std::mutex mutex;
  std::condition_variable ended;
  std::uint64_t running = threads;
  Tally total;
  const auto work = [&] {
    Tally own;
    while (!interrupted()) {
      const std::uint64_t begin = next.fetch_add(chunk);
      if (begin >= cases) break;
      for (std::uint64_t number = begin; number < std::min(begin + chunk, cases) && !interrupted(); ++number) {
        own.add(number, guarded(check, number));
        done.fetch_add(1, std::memory_order_relaxed);
      }
    }
    const std::lock_guard lock(mutex);
    total.add(std::move(own));
    --running;
    ended.notify_one();
  };
  std::vector<std::jthread> pool;
  for (std::uint64_t i = 0; i < threads; ++i) pool.emplace_back(work);
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, std::chrono::milliseconds(100), [&running] { return running == 0; })) watch(done);
  lock.unlock();
  pool.clear();
  return total;
}

std::string stem_of(const std::string& name) {
  std::string stem = name;
  std::replace(stem.begin(), stem.end(), '/', '_');
  return stem;
}

// A path as a shell takes it.
std::string shell_word(const std::string& path) {
  const bool plain =
      path.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=@%,") ==
      std::string::npos;
  if (plain && !path.empty()) return path.front() == '-' ? "./" + path : path;
  std::string result = "'";
  for (const char c : path) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::size_t triangles_of(const corpus::Scene& scene) {
  std::size_t triangles = 0;
  for (const corpus::SceneDraw& draw : scene.draws) triangles += draw.triangles.size();
  return triangles;
}

// Reduces the scene of a finding, writes it, and fills in where it is.
void keep_finding(const Settings& settings, const Check& check, const Tally& tally, const std::string& directory,
                  CheckResult& result) {
  result.finding = tally.finding.finding;
  result.case_number = tally.number;
  if (!tally.finding.scene) return;
  const corpus::Scene& original = *tally.finding.scene;
  corpus::Scene scene = original;
  const bool reducible = check.still_fails && check.still_fails(scene);
  if (reducible) {
    const auto still_fails = [&check](const corpus::Scene& simpler) {
      return !interrupted() && check.still_fails(simpler);
    };
    scene = properties::reduce(std::move(scene), still_fails, {kReductionTime});
  }
  std::string comment = fmt::format("{} ({}): {}\n{}\n", check.name, check.rule, check.claim, result.finding);
  comment += fmt::format("Found by surefill {}, seed {}, case {} of {}; ", SUREFILL_VERSION, settings.seed,
                         tally.number, result.cases);
  comment += reducible ? fmt::format("reduced from {} to {} triangles.", triangles_of(original), triangles_of(scene))
                       : std::string("as it was found.");
  const properties::Renderer second = properties::clipped_oracle_renderer();
  const bool oracles = check.replay_option == "--second-oracle";
  if (valid(scene)) {
    const properties::Comparison now =
        judge(scene, properties::oracle_renderer(), oracles ? second : settings.engine, 1);
    if (!now.first.empty()) comment += "\nIn this scene: " + describe_finding(now.first.front(), scene.samples);
  }
  scene.comment = comment;
  result.scene = reserve_path(directory, stem_of(check.name), ".scene");
  try {
    corpus::write_scene_file(scene, result.scene);
  } catch (...) {
    std::error_code error;
    std::filesystem::remove(result.scene, error);
    throw;
  }
  result.replay =
      "surefill replay " + (check.replay_option.empty() ? "" : check.replay_option + " ") + shell_word(result.scene);
}

}  // namespace

std::vector<CheckResult> run_checks(const Settings& settings, std::vector<Check>& checks, const RunOptions& options,
                                    const std::function<void(const CheckResult&)>& finished) {
  std::vector<CheckResult> results;
  double total_cost = 0, cost = 0;
  for (Check& check : checks) {
    CheckResult& result = results.emplace_back();
    result.name = check.name;
    result.rule = check.rule;
    result.claim = check.claim;
    result.unit = check.unit;
    result.exhaustive = check.exhaustive;
    result.cases = check.prepare();
    total_cost += check.cost * static_cast<double>(result.cases);
  }
  Progress progress;
  for (std::size_t i = 0; i < checks.size() && !interrupted(); ++i) {
    CheckResult& result = results[i];
    const Clock::time_point start = Clock::now();
    const Tally tally = run_cases(checks[i], result.cases, options.jobs, [&](std::uint64_t done) {
      progress.show(fmt::format("{} ({} of {} checks)", result.name, i + 1, checks.size()),
                    cost + checks[i].cost * static_cast<double>(done), total_cost);
    });
    cost += checks[i].cost * static_cast<double>(result.cases);
    result.done = tally.done;
    result.skipped = tally.skipped;
    result.failed = tally.failed;
    result.samples = tally.samples;
    result.differences = tally.differences;
    if (tally.failed > 0) {
      progress.show(fmt::format("{}: reducing what was found", result.name), cost, total_cost);
      keep_finding(settings, checks[i], tally, options.output_directory, result);
    }
    result.seconds = seconds_since(start);
    progress.clear();
    finished(result);
  }
  return results;
}

}  // namespace surefill::certify
