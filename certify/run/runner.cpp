// SPDX-License-Identifier: Apache-2.0
#include "certify/run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "certify/run/files.hpp"
#include "certify/run/judge.hpp"
#include "certify/run/progress.hpp"
#include "properties/machinery/reduce.hpp"

namespace surefill::certify {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kReductionTime{20};  // for one finding
constexpr std::chrono::seconds kSaveInterval{5};    // of the state of a run that can be resumed
// Estimated seconds of work after which all threads wait for each other once, so that a run can go on from there.
constexpr double kBlockSeconds = 2;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The sums over the cases so far, and the finding of the smallest case number.
struct Tally {
  std::uint64_t done = 0, skipped = 0, failed = 0, samples = 0, open = 0, differences = 0;
  Deviations deviations;
  std::uint64_t number = ~std::uint64_t{0};
  CaseResult finding;

  void add(std::uint64_t case_number, CaseResult&& result) {
    ++done;
    if (result.skipped) ++skipped;
    samples += result.samples;
    open += result.open;
    differences += result.differences;
    deviations.take(result.deviations);
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
    open += other.open;
    differences += other.differences;
    deviations.take(other.deviations);
    if (other.number >= number) return;
    number = other.number;
    finding = std::move(other.finding);
  }
};

bool is_stopped(const Check& check) {
  return check.stopped && !check.stopped().empty();
}

CaseResult guarded(const Check& check, std::uint64_t number) {
  try {
    CaseResult result = check.run(number);
    if (result.differences > 0 && result.finding.empty()) result.finding = "what differs has no words";
    return result;
  } catch (const std::exception& error) {
    CaseResult result;
    result.differences = 1;
    result.finding = fmt::format("the case ended with an exception: {}", error.what());
    return result;
  }
}

// The cases first .. last - 1 of a check's cases in this shard, taken in chunks by `jobs` threads. `watch` is called
// ten times a second with the cases done.
Tally run_cases(const Check& check, std::uint64_t first, std::uint64_t last, const RunOptions& options,
                const std::function<void(std::uint64_t)>& watch) {
  const std::uint64_t cases = last - first;
  const std::uint64_t threads = std::clamp<std::uint64_t>(cases, 1, static_cast<std::uint64_t>(options.jobs));
  const std::uint64_t chunk = std::clamp<std::uint64_t>(cases / (threads * 64), 1, 1024);
  std::atomic<std::uint64_t> next = first, done = 0;
  std::mutex mutex;
  std::condition_variable ended;
  std::uint64_t running = threads;
  Tally total;
  const auto work = [&] {
    Tally own;
    const auto goes_on = [&check] { return !interrupted() && !is_stopped(check); };
    while (goes_on()) {
      const std::uint64_t begin = next.fetch_add(chunk);
      if (begin >= last) break;
      for (std::uint64_t n = begin; n < std::min(begin + chunk, last) && goes_on(); ++n) {
        const std::uint64_t number = n * options.shard.count + options.shard.index - 1;
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

std::size_t triangles_of(const corpus::Scene& scene) {
  std::size_t triangles = 0;
  for (const corpus::SceneDraw& draw : scene.draws) triangles += draw.triangles.size();
  return triangles;
}

std::string difference_in(const Settings& settings, const Check& check, const corpus::Scene& scene) {
  if (check.describe) return check.describe(scene);
  if (!valid(scene)) return "";
  const bool oracles = check.replay_option == "--second-oracle";
  const properties::Comparison now =
      judge(scene, properties::oracle_renderer(), oracles ? properties::clipped_oracle_renderer() : settings.engine, 1);
  return now.first.empty() ? "" : describe_finding(now.first.front(), scene.samples);
}

// The picture that the finding itself has, or else the two images of the scene. `in_scene`: these differ.
Evidence evidence_in(const Check& check, const corpus::Scene& scene, bool* in_scene) {
  Evidence evidence = gather_evidence(scene, check.expected, check.actual);
  *in_scene = !evidence.what.empty() || evidence.actual.empty();
  const std::optional<properties::Exhibit> exhibit = check.exhibit ? check.exhibit(scene) : std::nullopt;
  return exhibit ? evidence_of(*exhibit) : evidence;
}

// Reduces the scene of a finding, writes it, and fills in where it is.
void keep_finding(const Settings& settings, const Check& check, const std::string& directory, CheckResult& result) {
  if (result.scene_text.empty()) return;
  const corpus::Scene original = corpus::read_scene(result.scene_text, check.name);
  corpus::Scene scene = original;
  const bool reducible = check.still_fails && check.still_fails(scene);
  if (reducible) {
    // What is smaller and shows another fault is no smaller scene of this one.
    const std::string kind = check.group.empty() ? "" : kind_of_finding(difference_in(settings, check, scene));
    const auto still_fails = [&settings, &check, &kind](const corpus::Scene& simpler) {
      if (interrupted() || !check.still_fails(simpler)) return false;
      return kind.empty() || kind_of_finding(difference_in(settings, check, simpler)) == kind;
    };
    scene = properties::reduce(std::move(scene), still_fails, {kReductionTime});
  }
  std::string comment = fmt::format("{} ({}): {}\n{}\n", check.name, check.rule, check.claim, result.finding);
  comment += fmt::format("Found by surefill {}, seed {}, case {} of {}; ", SUREFILL_VERSION, settings.seed,
                         result.case_number, result.cases);
  comment += reducible ? fmt::format("reduced from {} to {} triangles.", triangles_of(original), triangles_of(scene))
                       : std::string("as it was found.");
  result.shown = difference_in(settings, check, scene);
  if (!result.shown.empty()) comment += "\nIn this scene: " + result.shown;
  bool in_scene = true;  // the two images of the scene differ
  if (valid(scene)) {
    result.evidence = evidence_in(check, scene, &in_scene);
    if (!result.evidence.values.empty() && valid(original)) {
      bool unused = false;
      Evidence found = evidence_in(check, original, &unused);
      if (found.values.size() > result.evidence.values.size()) result.found = std::move(found);
    }
  }
  scene.comment = comment;
  result.scene_text = corpus::write_scene(scene);
  result.scene = reserve_path(directory, stem_of(check.name), ".scene");
  try {
    corpus::write_scene_file(scene, result.scene);
  } catch (...) {
    (void)std::remove(result.scene.c_str());
    throw;
  }
  const std::string options = check.replay_option.empty() ? "" : check.replay_option + " ";
  // Where a claim relates several scenes, both answers to this one may be equal: then the check itself shows it.
  result.replay = in_scene ? "surefill replay " + options + shell_word(result.scene)
                           : fmt::format("surefill certify {}--only {} --level {} --seed {}", options,
                                         shell_word(check.name), level_name(settings.level), settings.seed);
}

void add_tally(Tally&& tally, CheckResult& result) {
  result.done += tally.done;
  result.skipped += tally.skipped;
  result.samples += tally.samples;
  result.open += tally.open;
  result.differences += tally.differences;
  result.deviations.take(tally.deviations);
  const bool first = tally.failed > 0 && (result.failed == 0 || tally.number < result.case_number);
  result.failed += tally.failed;
  if (!first) return;
  result.case_number = tally.number;
  result.finding = tally.finding.finding;
  result.scene_text = tally.finding.scene ? corpus::write_scene(*tally.finding.scene) : "";
}

}  // namespace

std::vector<CheckResult> run_checks(const Settings& settings, std::vector<Check>& checks, const RunOptions& options,
                                    const std::function<void(const CheckResult&)>& finished,
                                    std::span<const CheckResult> before,
                                    const std::function<void(std::span<const CheckResult>)>& saved) {
  std::vector<CheckResult> results;
  double total_cost = 0, cost = 0;
  for (Check& check : checks) {
    CheckResult result;
    const std::uint64_t cases = check.prepare();
    const auto earlier =
        std::find_if(before.begin(), before.end(), [&](const auto& r) { return r.name == check.name; });
    if (earlier != before.end()) result = *earlier;
    result.name = check.name;
    result.rule = check.rule;
    result.claim = check.claim;
    result.unit = check.unit;
    result.group = check.group;
    result.exhaustive = check.exhaustive;
    result.cases = cases;
    result.due = (cases + options.shard.count - options.shard.index) / options.shard.count;
    total_cost += check.cost * static_cast<double>(result.due);
    results.push_back(std::move(result));
  }
  Progress progress;
  Clock::time_point last_save = Clock::now();
  const auto save = [&](bool at_once) {
    if (!saved || (!at_once && Clock::now() - last_save < kSaveInterval)) return;
    saved(results);
    last_save = Clock::now();
  };
  for (std::size_t i = 0; i < checks.size() && !interrupted(); ++i) {
    CheckResult& result = results[i];
    const Check& check = checks[i];
    const double spent = result.seconds;
    const Clock::time_point start = Clock::now();
    const auto block =
        static_cast<std::uint64_t>(kBlockSeconds / check.cost) * static_cast<std::uint64_t>(options.jobs) + 1;
    bool stopped = false;
    while (result.resume < result.due && !interrupted() && !stopped) {
      const std::uint64_t end = std::min(result.due, result.resume + block);
      Tally tally = run_cases(check, result.resume, end, options, [&](std::uint64_t done) {
        progress.show(fmt::format("{} ({} of {} checks)", result.name, i + 1, checks.size()),
                      cost + check.cost * static_cast<double>(result.resume + done), total_cost);
      });
      result.seconds = spent + seconds_since(start);
      stopped = is_stopped(check);
      if (result.resume + tally.done < end) {
        save(true);  // without the block that was not finished
        add_tally(std::move(tally), result);
        break;
      }
      add_tally(std::move(tally), result);
      result.resume = end;
      save(interrupted());
    }
    cost += check.cost * static_cast<double>(result.due);
    if (result.failed > 0 && result.scene.empty()) {
      progress.show(fmt::format("{}: reducing what was found", result.name), cost, total_cost);
      keep_finding(settings, check, options.output_directory, result);
    }
    result.seconds = spent + seconds_since(start);
    progress.clear();
    if (result.complete()) save(true);
    finished(result);
    if (stopped) break;
  }
  return results;
}

}  // namespace surefill::certify
