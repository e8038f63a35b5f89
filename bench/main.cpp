// SPDX-License-Identifier: Apache-2.0
//
// How fast the engine draws the workloads: count, depth, visibility (depth and index) and visibility with barycentrics,
// by the fast path on one and two threads, and by the reference path on the workloads that it can finish in a second or
// so; and the memory limit: one linear read-compare-write of a depth buffer of the same size. Options are Google
// Benchmark's; compare ratios within one run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bench/workloads.hpp"
#include "surefill/surefill.hpp"

namespace surefill::bench {
namespace {

enum class Output { count, depth, visibility, barycentrics };

// Made once, when first needed.
const Workload& workload(int number, Placement placement) {
  static std::map<std::pair<int, Placement>, Workload> made;
  const auto [at, is_new] = made.try_emplace({number, placement});
  if (is_new) at->second = make_workload(number, placement);
  return at->second;
}

void draw(benchmark::State& state, int number, Placement placement, Output output, Options options) {
  const Workload& work = workload(number, placement);
  const std::size_t samples = std::size_t{kWidth} * kHeight;
  std::vector<std::uint32_t> count(output == Output::count ? samples : 0);
  std::vector<std::uint32_t> index(output >= Output::visibility ? samples : 0);
  std::vector<float> depth(output >= Output::depth ? samples : 0);
  std::vector<float> barycentrics(output == Output::barycentrics ? 3 * samples : 0);
  Target target;
  target.width = kWidth, target.height = kHeight;
  target.count = count, target.index = index, target.depth = depth, target.barycentrics = barycentrics;
  Draw triangles;
  triangles.vertices = work.vertices, triangles.indices = work.indices;
  for (auto _ : state) {
    const Status status = render(target, {&triangles, 1}, nullptr, options);
    if (status != Status::ok) return state.SkipWithError(status_text(status));
  }
  state.counters["Mtri/s"] = benchmark::Counter(static_cast<double>(work.indices.size() / 3) * 1e-6,
                                                benchmark::Counter::kIsIterationInvariantRate);
}

// The least that any z-buffer has to do for one full-screen layer.
void memory_limit(benchmark::State& state) {
  const std::size_t samples = std::size_t{kWidth} * kHeight;
  std::vector<float> depth(samples, 1.0f), layer(samples, 0.5f);
  for (auto _ : state) {
    for (std::size_t i = 0; i < samples; ++i) depth[i] = std::min(depth[i], layer[i]);
    benchmark::DoNotOptimize(depth.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(3 * samples * sizeof(float)));
}

void add(const std::string& name, int number, Placement placement, Output output, Options options) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { draw(state, number, placement, output, options); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

}  // namespace
}  // namespace surefill::bench

int main(int argc, char** argv) {
  using namespace surefill;
  using namespace surefill::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const char* const placements[] = {"", "/snapped", "/aligned"};
  const char* const outputs[] = {"count", "depth", "visibility", "barycentrics"};
  for (int placement = 0; placement < 3; ++placement) {
    for (int number = 1; number <= kWorkloads; ++number) {
      const std::string name = "W" + std::to_string(number) + placements[placement] + "/";
      for (int output = 0; output < (placement == 0 ? 4 : 2); ++output) {
        for (const int threads : {1, 2}) {
          add(name + outputs[output] + "/threads:" + std::to_string(threads), number, static_cast<Placement>(placement),
              static_cast<Output>(output), {.threads = threads});
        }
      }
    }
  }
  for (const int number : {1, 2, 4}) {
    add("W" + std::to_string(number) + "/visibility/reference", number, Placement::free, Output::visibility,
        {.path = Path::reference});
  }
  benchmark::RegisterBenchmark("memory limit/depth layer", memory_limit)->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
