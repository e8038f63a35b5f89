// SPDX-License-Identifier: Apache-2.0
//
// Runs the suite against mutants of the engine:  schemata SECONDS NUMBER...
// A line for each: NUMBER killed|survived BY. Each runs in a process of its own and stops at its first kill.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "mutant.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators.hpp"
#include "properties/properties.hpp"

namespace surefill {
namespace {

using properties::Property;

// S3, which no property sees, since scenes are mapped to pixels before they are drawn.
bool viewport_differs(std::uint64_t n) {
  properties::Random random(n);
  const auto number = [&] {
    const float small = static_cast<float>(random.between(-64, 64)) / 16;
    return random.one_in(3) ? std::bit_cast<float>(static_cast<std::uint32_t>(random.bits())) : small;
  };
  Viewport viewport{};
  for (float* f :
       {&viewport.x, &viewport.y, &viewport.width, &viewport.height, &viewport.near_depth, &viewport.far_depth})
    do *f = number();
    while (!(*f - *f == 0));
  viewport.clip_depth = static_cast<ClipDepth>(random.below(2));
  viewport.clip_y = static_cast<ClipY>(random.below(2));
  const ClipVertex vertex{number(), number(), number(), number()};
  Vertex expected{}, actual{};
  oracle::to_pixel(viewport, {&vertex, 1}, {&expected, 1});
  if (to_pixel(viewport, {&vertex, 1}, {&actual, 1}) != Status::ok) return true;
  const float pairs[][2] = {
      {expected.x, actual.x}, {expected.y, actual.y}, {expected.z, actual.z}, {expected.w, actual.w}};
  for (const auto& [e, a] : pairs)
    if (std::bit_cast<std::uint32_t>(e) != std::bit_cast<std::uint32_t>(a) && (e == e || a == a)) return true;
  return false;
}

// In the child: the name of what kills the mutant, or nothing after so many seconds.
std::string first_kill(double seconds) {
  const auto start = std::chrono::steady_clock::now();
  const properties::Renderer engine = properties::engine_renderer();
  for (std::uint64_t round = 0;; ++round) {
    for (const Property& property : properties::all_properties()) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds) return {};
      // Costly properties, less often.
      const std::uint64_t every = 50 / properties::affordable_cases(property, 50);
      if (round % every != every - 1) continue;
      alarm(10);  // a case that never ends ends the process
      if (property.decide(properties::sampled_case(property, round), engine).differences != 0) return property.name;
    }
    for (std::uint64_t n = 0; n < 20; ++n)
      if (viewport_differs(20 * round + n)) return "viewport";
  }
}

void run(unsigned number, double seconds) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(2);
  const pid_t child = fork();
  if (child == 0) {
    const rlimit memory{rlim_t{3} << 30, rlim_t{3} << 30};
    setrlimit(RLIMIT_AS, &memory);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    mutant::number = number;
    const std::string by = first_kill(seconds);
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
  for (int i = 2; i < argc; ++i)
    surefill::run(static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)), std::atof(argv[1]));
}
