// SPDX-License-Identifier: Apache-2.0
//
// Runs the suite against mutants of the engine:  schemata SECONDS NUMBER...
// A line for each: NUMBER killed|survived BY. Each runs in a process of its own and stops at its first kill.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "certify/checks.hpp"
#include "mutant.hpp"
#include "properties/internal_bounds.hpp"

namespace surefill {
namespace {

// Every check of the command at its quick level but those that draw whole meshes, which take seconds a case; and the
// test of the engine's inner promises.
std::vector<certify::Check> suite(const certify::Settings& settings) {
  std::vector<certify::Check> checks = certify::list_checks(settings);
  std::erase_if(checks, [](const certify::Check& check) { return check.name.rfind("mesh-", 0) == 0; });
  certify::Check& bounds = checks.emplace_back(certify::make_check("internal-bounds", "", "its test"));
  bounds.prepare = [] { return std::uint64_t{1} << 32; };
  bounds.run = [](std::uint64_t number) {
    certify::CaseResult result;
    result.differences = properties::InternalBounds(number).broken().empty() ? 0 : 1;
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

// In the child: the name of the check that kills the mutant, or nothing after so many seconds. The checks take turns, a
// hundredth of a second or one case at a time; sampled cases go on, and those of a list come well mixed, again and
// again.
std::string first_kill(const std::vector<certify::Check>& checks, const std::vector<std::uint64_t>& cases,
                       double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Clock::time_point start = Clock::now();
  std::vector<std::uint64_t> next(checks.size());
  for (;;) {
    for (std::size_t i = 0; i < checks.size(); ++i) {
      const Clock::time_point turn = Clock::now();
      do {
        if (since(start) > seconds) return {};
        alarm(10);  // a case that never ends ends the process
        const std::uint64_t n = next[i]++;
        const std::uint64_t number = checks[i].exhaustive ? n % cases[i] * step_through(cases[i]) % cases[i] : n;
        if (checks[i].run(number).differences != 0) return checks[i].name;
      } while (since(turn) < 0.01);
    }
  }
}

void run(const std::vector<certify::Check>& checks, const std::vector<std::uint64_t>& cases, unsigned number,
         double seconds) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(2);
  const pid_t child = fork();
  if (child == 0) {
    const rlimit memory{rlim_t{3} << 30, rlim_t{3} << 30};
    setrlimit(RLIMIT_AS, &memory);
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
  const char* by = survived                                             ? "-"
                   : length > 0                                         ? text
                   : WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM ? "hang"
                                                                        : "crash";
  std::printf("%u %s %s\n", number, survived ? "survived" : "killed", by);
  std::fflush(stdout);
}

}  // namespace
}  // namespace surefill

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
