// SPDX-License-Identifier: Apache-2.0
//
// Runs the suite against mutants of the engine:  schemata SECONDS NUMBER...
// A line for each: NUMBER killed|survived BY. Each runs in a process of its own and stops at its first kill.
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "certify/run/checks.hpp"
#include "engine/tests/path_cases.hpp"
#include "mutant.hpp"
#if defined(SUREFILL_REFERENCE_ONLY)
#include "engine/tests/internal_bounds.hpp"
#include "engine/tests/statistics_in_rationals.hpp"
#else
#include "engine/tests/batch_bounds.hpp"
#endif

namespace surefill {
namespace {

// Each kind of frame that aims at the fast path, and the corpus. What the reference path makes of them, which has no
// mutants here, is known beforehand for the first ones.
[[maybe_unused]] void add_path_checks(const certify::Settings& settings, std::vector<certify::Check>& checks) {
  using properties::PathResult, properties::PathScene;
  const auto add = [&](const std::string& name, std::uint64_t known, std::function<PathScene(std::uint64_t)> make) {
    certify::Check& check = checks.emplace_back(certify::make_check("paths-" + name, "", "its test"));
    auto results = std::make_shared<std::vector<PathResult>>();
    const auto reference = [make](std::uint64_t n) {
      return properties::draw_path(make(n), {.path = Path::reference});
    };
    check.prepare = [=] {
      for (std::uint64_t n = 0; n < known; ++n) results->push_back(reference(n));
      return known;
    };
    check.run = [=](std::uint64_t n) {
      certify::CaseResult result;
      const PathResult expected = n < results->size() ? (*results)[n] : reference(n);
      result.differences = properties::broken_path(make(n), expected).empty() ? 0 : 1;
      return result;
    };
  };
  for (const properties::PathCases& cases : properties::all_path_cases()) add(cases.name, 4 * cases.tested, cases.make);
  auto scenes = std::make_shared<std::vector<corpus::Scene>>();
  for (const std::string& path : corpus::list_corpus(settings.corpus + "/cases")) {
    scenes->push_back(corpus::read_scene_file(path));
    for (const corpus::SceneDraw& draw : scenes->back().draws) {
      if (draw.primitive != Primitive::triangles) {  // have no rasterizer
        scenes->pop_back();
        break;
      }
    }
  }
  add("corpus", scenes->size(), [scenes](std::uint64_t n) {
    const corpus::Scene& scene = (*scenes)[n % scenes->size()];
    return PathScene{scene, properties::outputs_of(scene), 1 + static_cast<int>(n % 2)};
  });
  checks.back().exhaustive = true;
}

// Every check of the command at its quick level but those that draw whole meshes, which take seconds a case; and what
// has tests of its own: the engine's inner promises, and the fast path.
std::vector<certify::Check> suite(const certify::Settings& settings) {
  std::vector<certify::Check> checks = certify::list_checks(settings);
  std::erase_if(checks, [](const certify::Check& check) { return check.name.rfind("mesh-", 0) == 0; });
#if defined(SUREFILL_REFERENCE_ONLY)
  using Bounds = properties::InternalBounds;
  certify::Check& streams = checks.emplace_back(certify::make_check("streams", "", "its test"));
  streams.prepare = [] { return std::uint64_t{1} << 32; };
  streams.run = [](std::uint64_t number) {
    certify::CaseResult result;
    properties::PathScene scene = properties::all_path_cases()[0].make(number);
    scene.streams = scene.outputs.count = true;
    result.differences = properties::draw_path(scene, {}).counts_agree ? 0 : 1;
    return result;
  };
  certify::Check& cases = checks.emplace_back(certify::make_check("paths-small", "", "its test"));
  cases.prepare = [] { return std::uint64_t{1} << 32; };
  cases.run = [](std::uint64_t number) {
    certify::CaseResult result;
    const properties::PathScene scene = properties::all_path_cases()[0].make(number);
    result.differences =
        properties::compare(scene.scene, properties::engine_renderer(), properties::oracle_renderer(), scene.outputs)
            .differences;
    return result;
  };
  certify::Check& statistics = checks.emplace_back(certify::make_check("statistics", "M11", "its test"));
  statistics.prepare = [] { return std::uint64_t{1} << 32; };
  statistics.run = [](std::uint64_t number) {
    certify::CaseResult result;
    const properties::PathScene scene = properties::all_path_cases()[0].make(number);
    const corpus::Frame frame(scene.scene, scene.outputs);
    Statistics actual;
    const bool drawn = render(frame.target(), frame.draws(), &actual) == Status::ok;
    result.differences = drawn && actual == properties::statistics_in_rationals(frame.draws()) ? 0 : 1;
    return result;
  };
#else
  using Bounds = properties::BatchBounds;
  add_path_checks(settings, checks);
#endif
  certify::Check& bounds = checks.emplace_back(certify::make_check("paths-bounds", "", "its test"));
  bounds.prepare = [] { return std::uint64_t{1} << 32; };
  bounds.run = [](std::uint64_t number) {
    certify::CaseResult result;
    result.differences = Bounds(number).broken().empty() ? 0 : 1;
    return result;
  };
  return checks;
}

// About the golden part of `cases`, and prime to it: so many steps on at a time, modulo `cases`, come by all of them.
std::uint64_t step_through(std::uint64_t cases) {
  auto step = static_cast<std::uint64_t>(0.618 * static_cast<double>(cases)) + 1;
  while (std::gcd(step, cases) != 1) ++step;
  return step;
}

// Which share of the time a check gets: most of it those that aim at what is mutated.
double weight(const certify::Check& check) {
  if (check.name == "paths-bounds") return 6;  // an image hardly shows what it shows
  return check.name.rfind("paths-", 0) == 0 ? 1 : 0.05;
}

// Seconds of processor time: a busy machine gives no mutant a shorter life.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A case that never ends ends the process: one that computes after 10 s, one that waits after two minutes.
void limit_case() {
  const itimerval limit{{0, 0}, {10, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
  alarm(120);
}

// In the child: the name of the check that kills the mutant, or nothing after so many seconds. Whichever has had the
// least of its share takes a turn of a hundredth of a second, or one case; sampled cases go on, and those of a list
// come well mixed, again and again.
std::string first_kill(const std::vector<certify::Check>& checks, const std::vector<std::uint64_t>& cases,
                       double seconds) {
  const double start = processor_seconds();
  std::vector<std::uint64_t> next(checks.size());
  std::vector<double> had;  // over its weight; who has more begins
  for (const certify::Check& check : checks) had.push_back(0.01 / weight(check));
  for (double now = start; now - start < seconds;) {
    const auto i = static_cast<std::size_t>(std::min_element(had.begin(), had.end()) - had.begin());
    const double turn = now;
    do {
      limit_case();
      const std::uint64_t n = next[i]++;
      const std::uint64_t number = checks[i].exhaustive ? n % cases[i] * step_through(cases[i]) % cases[i] : n;
      if (checks[i].run(number).differences != 0) return checks[i].name;
      now = processor_seconds();
    } while (now - turn < 0.01 && now - start < seconds);
    had[i] += (now - turn) / weight(checks[i]);
  }
  return {};
}

void run(const std::vector<certify::Check>& checks, const std::vector<std::uint64_t>& cases, unsigned number,
         double seconds) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(2);
  const pid_t child = fork();
  if (child == 0) {
#if defined(SUREFILL_REFERENCE_ONLY)  // else a sanitizer needs the address space, and limits memory itself
    const rlimit memory{rlim_t{3} << 30, rlim_t{3} << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    mutant::number = number;
    const std::string by = first_kill(checks, cases, seconds);
    (void)!write(ends[1], by.data(), by.size());
    _exit(by.empty() ? 0 : 1);
  }
  close(ends[1]);
  char text[128] = {};
  const ssize_t length = read(ends[0], text, sizeof text - 1);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  const bool survived = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  const char* by = survived                                                                              ? "-"
                   : length > 0                                                                          ? text
                   : WIFSIGNALED(status) && (WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGPROF) ? "hang"
                                                                                                         : "crash";
  std::printf("%u %s %s\n", number, survived ? "survived" : "killed", by);
  std::fflush(stdout);
}

}  // namespace
}  // namespace surefill

extern "C" const char* __asan_default_options() {
  return "detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=2000";
}

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: schemata SECONDS NUMBER...\n", stderr);
    return 2;
  }
  surefill::certify::Settings settings;
  settings.corpus = SUREFILL_CORPUS;
  settings.engine = surefill::properties::engine_renderer();
  settings.support = surefill::certify::probe_support(settings.engine);
  const std::vector<surefill::certify::Check> checks = surefill::suite(settings);
  std::vector<std::uint64_t> cases;
  for (const surefill::certify::Check& check : checks) cases.push_back(check.prepare());
  for (int i = 2; i < argc; ++i)
    surefill::run(checks, cases, static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)), std::atof(argv[1]));
}
