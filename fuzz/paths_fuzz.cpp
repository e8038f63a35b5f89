// SPDX-License-Identifier: Apache-2.0
//
// The fast path, on the instruction set and the number of threads that the input chooses, == the reference path: every
// output that is asked for, bit for bit, in every mode, the statistics that speak of triangles, and the stream of
// coverage; on threads of its own or of an executor. Targets reach over several tiles.
#include <hwy/highway.h>

#include <algorithm>
#include <cfenv>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <vector>

#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/diagnostics.hpp"

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

auto key(const CoverageBlock& b) {
  return std::make_tuple(b.sample, b.y, b.x, b.draw, b.triangle, b.mask, b.full());
}

// All blocks of a coverage stream, sorted: with several threads, rows of tiles come in any order.
std::vector<CoverageBlock> stream_of(const corpus::Scene& scene, std::span<const Draw> draws, const Options& options) {
  struct Sink {
    std::mutex mutex;
    std::vector<CoverageBlock> blocks;
  } sink;
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    Sink& to = *static_cast<Sink*>(context);
    const std::lock_guard lock(to.mutex);
    to.blocks.insert(to.blocks.end(), blocks.begin(), blocks.end());
  };
  Target target;
  target.width = scene.width, target.height = scene.height, target.samples = scene.samples;
  target.origin = scene.origin, target.sample_locations = scene.sample_locations;
  std::vector<Draw> alone(draws.begin(), draws.end());  // a stream has no numbers of triangles
  for (Draw& draw : alone) draw.covered = draw.visible = {};
  if (visit_coverage(target, alone, {visit, &sink}, nullptr, options) != Status::ok)
    report_finding("paths", "visit_coverage refuses a valid scene", corpus::write_scene(scene));
  std::sort(sink.blocks.begin(), sink.blocks.end(),
            [](const CoverageBlock& a, const CoverageBlock& b) { return key(a) < key(b); });
  return std::move(sink.blocks);
}

// The caller's threads: the last item first, on a thread that rounds upwards.
void run_backwards(void*, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
  std::thread([=] {
    std::fesetround(FE_UPWARD);
    for (std::size_t item = items; item-- > 0;) task(argument, item);
  }).join();
}

void check(const corpus::Scene& scene, std::uint32_t how, std::uint32_t outputs_byte) {
  constexpr int kThreads[] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 3, 8};
  constexpr std::uint32_t kWithStream = 7, kWithExecutor = 6;
  use_instruction_set(how & 15u);
  const std::uint32_t more = outputs_byte >> 5;
  Options fast{.threads = kThreads[how >> 4 & 15u]};
  if (more == kWithExecutor) fast.executor.run = run_backwards;
  const Options slow{.path = Path::reference};
  const bool shading = (outputs_byte >> 3 & 3u) == 3;
  corpus::Outputs outputs{(outputs_byte & 1u) == 0, (outputs_byte & 2u) == 0, (outputs_byte & 4u) == 0, shading,
                          shading};
  if (const corpus::Outputs allowed = properties::outputs_of(scene); !allowed.depth) outputs = allowed;
  corpus::Frame expected(scene, outputs), actual(scene, outputs);
  Statistics of_expected, of_actual;
  Diagnostics slow_diagnostics, fast_diagnostics;
  const auto fail = [&](const std::string& relation) {
    report_finding("paths",
                   std::string(fast_diagnostics.path) + ", " + std::to_string(fast.threads) + " threads: " + relation,
                   corpus::write_scene(scene));
  };
  const auto with = [](Options options, Diagnostics& diagnostics) {
    options.diagnostics = &diagnostics;
    return options;
  };
  if (render(expected.target(), expected.draws(), &of_expected, with(slow, slow_diagnostics)) != Status::ok ||
      render(actual.target(), actual.draws(), &of_actual, with(fast, fast_diagnostics)) != Status::ok) {
    fail("the engine refuses a valid scene");
  }
  if (std::string_view(fast_diagnostics.path) == slow_diagnostics.path) fail("the path under test did not run");
  const properties::Comparison comparison = properties::compare(scene, expected.image(), actual.image(), 1);
  if (comparison.differences != 0) fail(properties::describe(comparison.first.at(0), scene.samples));
  if (of_expected != of_actual) fail("the statistics of the triangles differ");
  if (more == kWithStream) {
    const std::vector<CoverageBlock> a = stream_of(scene, expected.draws(), slow),
                                     b = stream_of(scene, actual.draws(), fast);
    const auto same = [](const CoverageBlock& p, const CoverageBlock& q) { return key(p) == key(q); };
    if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) fail("the streams of coverage differ");
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
