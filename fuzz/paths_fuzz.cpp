// SPDX-License-Identifier: Apache-2.0
//
// The fast path, on the instruction set and the number of threads that the input chooses, == the reference path: every
// output that is asked for, bit for bit, and the statistics that speak of triangles and covered samples. Targets reach
// over several tiles and bins.
#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "properties/compare.hpp"

namespace surefill::fuzz {
namespace {

// The instruction sets of this machine, one bit each.
std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> sets;
  const auto all = static_cast<std::uint64_t>(hwy::SupportedTargets() & HWY_TARGETS);
  for (std::uint64_t rest = all; rest != 0; rest &= rest - 1) sets.push_back(static_cast<std::int64_t>(rest & -rest));
  return sets;
}

void use_instruction_set(std::size_t number) {
  static const std::vector<std::int64_t> sets = instruction_sets();
  hwy::SetSupportedTargetsForTest(sets[number % sets.size()]);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

void check(const corpus::Scene& scene, std::uint32_t how, std::uint32_t outputs_byte) {
  constexpr int kThreads[] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 3, 8};
  use_instruction_set(how & 15u);
  const Options fast{kThreads[how >> 4 & 15u], Path::automatic}, slow{1, Path::reference};
  const bool shading = (outputs_byte >> 3 & 3u) == 3;
  const corpus::Outputs outputs{(outputs_byte & 1u) == 0, (outputs_byte & 2u) == 0, (outputs_byte & 4u) == 0, shading,
                                shading};
  corpus::Frame expected(scene, outputs), actual(scene, outputs);
  Statistics of_expected, of_actual;
  const auto fail = [&](const std::string& relation) {
    report_finding("paths", std::string(of_actual.path) + ", " + std::to_string(fast.threads) + " threads: " + relation,
                   corpus::write_scene(scene));
  };
  if (render(expected.target(), expected.draws(), &of_expected, slow) != Status::ok ||
      render(actual.target(), actual.draws(), &of_actual, fast) != Status::ok) {
    fail("the engine refuses a valid scene");
  }
  const properties::Comparison comparison = properties::compare(scene, expected.image(), actual.image(), 1);
  if (comparison.differences != 0) fail(properties::describe(comparison.first.at(0), scene.samples));
  if (of_expected.triangles != of_actual.triangles || of_expected.dropped != of_actual.dropped) {
    fail("the statistics of the triangles differ");
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  const surefill::corpus::Scene scene = decode_paths({data, size});
  note_scene([&] { return scene; });
  check(scene, size > 1 ? data[1] : 0, size > 2 ? data[2] : 0);
  return 0;
}

SUREFILL_FUZZ_MUTATORS(paths)
