// SPDX-License-Identifier: Apache-2.0
//
// How fast the engine draws the workloads, beside llvmpipe, the memory limit, itself without exactness, itself on other
// instruction sets. Options are Google Benchmark's; compare ratios within one run. `./dev bench` runs it on one thread
// and on two, and bench/table.py makes the table.
//
// Names: workload/output/who, such as W1/depth/surefill. With SUREFILL_BENCH_THREADS=2 in the environment, and
// LP_NUM_THREADS for llvmpipe, both have two threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/inexact.hpp"
#include "bench/llvmpipe.hpp"
#include "bench/occlusion.hpp"
#include "bench/workloads.hpp"
#include "hwy/targets.h"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::bench {
namespace {

enum class Output { count, depth, visibility, attributes };
// Depth is clipped, as every renderer has it, except in `unclipped` and `over`, which is conservative: counts alone.
enum class Mode { plain, unclipped, grid, over };
constexpr std::size_t kSamples = std::size_t{kWidth} * kHeight;

int threads() {
  const char* const text = std::getenv("SUREFILL_BENCH_THREADS");
  return text != nullptr ? std::atoi(text) : 1;
}

// The workload that was asked for last: benchmarks of one follow each other, and memory holds one of the large ones.
const Workload& workload(const std::string& name) {
  static Workload held;
  if (held.name == name) return held;
  const std::size_t slash = name.find('/');
  const std::string placement = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (name[0] == 'W') {
    held = make_workload(name[1] - '0', placement == "snapped"   ? Placement::snapped
                                        : placement == "aligned" ? Placement::aligned
                                                                 : Placement::free);
  } else if (name[0] == 's' && name[1] == 'p') {
    held = make_spot(std::atoi(placement.c_str()));
  } else if (name[0] == 'l') {
    held = make_lines(std::strtoull(placement.c_str(), nullptr, 10));
  } else if (name[0] == 'p') {
    held = make_points(std::strtoull(placement.c_str(), nullptr, 10));
  } else if (name[0] == 'k') {
    held = make_knot(std::strtoull(placement.c_str(), nullptr, 10));
  } else {
    held = make_small_triangles(std::strtoull(placement.c_str(), nullptr, 10));
  }
  held.name = name;
  return held;
}

// Four floats a vertex.
std::vector<float> values_of(const Workload& work) {
  std::vector<float> values(4 * work.vertices.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 2654435761u % 1021) / 1021;
  return values;
}

void count_triangles(benchmark::State& state, const Workload& work) {
  state.counters["triangles"] = static_cast<double>(work.indices.size() / 3);
}

// What is drawn, and the buffers for it.
struct Frame {
  Frame(const Workload& work, Output output, Mode mode)
      : count(output == Output::count ? kSamples : 0),
        index(output >= Output::visibility ? kSamples : 0),
        depth(output >= Output::depth ? kSamples : 0),
        shaded(output == Output::attributes ? 4 * kSamples : 0),
        attribute_target{shaded, 4} {
    target.width = kWidth, target.height = kHeight;
    target.count = count, target.index = index, target.depth = depth;
    triangles.vertices = work.vertices, triangles.indices = work.indices, triangles.primitive = work.primitive;
    if (mode == Mode::plain || mode == Mode::grid) triangles.depth_mode = DepthMode::clip;
    if (mode == Mode::grid) triangles.grid = Grid{};
    if (mode == Mode::over) triangles.conservative = Conservative::over;
    if (output != Output::attributes) return;
    values = values_of(work);
    attribute.values = values, attribute.components = 4;
    triangles.attributes = {&attribute, 1}, target.attributes = {&attribute_target, 1};
  }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, shaded, values;
  Target target;
  Draw triangles;

 private:
  AttributeTarget attribute_target;
  AttributeArray attribute;
};

void surefill_draws(benchmark::State& state, const std::string& name, Output output, Options options,
                    Mode mode = Mode::plain) {
  const Workload& work = workload(name);
  Frame frame(work, output, mode);
  for (auto _ : state) {
    const Status status = render(frame.target, {&frame.triangles, 1}, nullptr, options);
    if (status != Status::ok) return state.SkipWithError(status_text(status));
  }
  count_triangles(state, work);
}

void inexact_draws(benchmark::State& state, const std::string& name, decltype(&surefill_bench_inexact_coverage) draw) {
  const Workload& work = workload(name);
  std::vector<float> depth(kSamples);
  for (auto _ : state) {
    if (!draw(kWidth, kHeight, &work.vertices[0].x, work.vertices.size(), work.indices.data(), work.indices.size(),
              depth.data())) {
      return state.SkipWithError("it could not draw");
    }
  }
  count_triangles(state, work);
}

void llvmpipe_draws(benchmark::State& state, const std::string& name, bool color) {
  static std::string why;
  static const std::unique_ptr<Llvmpipe> rival = Llvmpipe::open(&why);
  if (rival == nullptr) return state.SkipWithError(why.c_str());
  const Workload& work = workload(name);
  rival->load(work, color ? values_of(work) : std::vector<float>());
  rival->draw(color);  // shaders are compiled at the first draw
  for (auto _ : state) rival->draw(color);
  state.SetLabel(rival->name());
  count_triangles(state, work);
}

// On one of Highway's targets; 0: on the best.
void force_target(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// The same on one of Highway's targets.
void target_draws(benchmark::State& state, const std::string& name, Output output, const Options& options,
                  std::int64_t target) {
  if ((hwy::SupportedTargets() & target) == 0) return state.SkipWithError("this machine has it not");
  force_target(target);
  surefill_draws(state, name, output, options);
  force_target(0);
}

// The least that any z-buffer has to do for one full-screen layer.
void memory_limit(benchmark::State& state) {
  std::vector<float> depth(kSamples, 1.0f), layer(kSamples, 0.5f);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kSamples; ++i) depth[i] = std::min(depth[i], layer[i]);
    benchmark::DoNotOptimize(depth.data());
    benchmark::ClobberMemory();
  }
}

// The least that a call has to do: to write its output once.
void memory_written(benchmark::State& state) {
  std::vector<float> depth(kSamples);
  for (auto _ : state) {
    std::fill(depth.begin(), depth.end(), 1.0f);
    benchmark::DoNotOptimize(depth.data());
    benchmark::ClobberMemory();
  }
}

// Draws so many times and nothing else, for tools that count instructions and that sample; prints the fastest and the
// middle in milliseconds of this thread. Returns the exit status.
int draw_only(const std::string& name, int times, const std::string& output, const std::string& target) {
  static const std::map<std::string, std::pair<Output, Mode>> kOutputs = {
      {"depth", {Output::depth, Mode::plain}},
      {"unclipped", {Output::depth, Mode::unclipped}},
      {"visibility", {Output::visibility, Mode::plain}},
      {"attributes", {Output::attributes, Mode::plain}},
      {"count", {Output::count, Mode::plain}},
      {"conservative", {Output::count, Mode::over}},
      {"grid", {Output::depth, Mode::grid}}};
  const auto found = kOutputs.find(output);
  if (found == kOutputs.end() || times < 1 || (target != "" && target != "AVX2")) return 2;
  if (target == "AVX2") force_target(HWY_AVX2);
  const Workload& work = workload(name);
  Frame frame(work, found->second.first, found->second.second);
  static Context context;
  const Options options{.threads = threads(), .context = &context};
  std::vector<double> milliseconds;
  for (int n = 0; n < times; ++n) {
    const std::clock_t begin = std::clock();
    if (render(frame.target, {&frame.triangles, 1}, nullptr, options) != Status::ok) return 1;
    milliseconds.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  std::printf("%.2f %.2f\n", milliseconds.front(), milliseconds[milliseconds.size() / 2]);
  return 0;
}

// The largest amount of memory that this process has had since the last reset, in MiB; 0 where the system tells nobody.
double peak_memory(bool reset) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::string line;
  for (std::ifstream file("/proc/self/status"); std::getline(file, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

// What a call takes, beside what the header allows, with counts, depth and visibility of a square of so many pixels each
// way, or of the screen if that is 0. Returns the exit status.
int measure_memory(const std::string& name, int size, int call_threads) {
  const Workload& work = workload(name);
  Target target;
  target.width = size > 0 ? size : kWidth, target.height = size > 0 ? size : kHeight;
  const std::size_t samples = static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height);
  std::vector<std::uint32_t> count(samples), index(samples);
  std::vector<float> depth(samples);
  target.count = count, target.index = index, target.depth = depth;
  std::vector<Vertex> vertices = work.vertices;  // as large as the target
  for (Vertex& v : vertices)
    v.x *= static_cast<float>(target.width) / kWidth, v.y *= static_cast<float>(target.height) / kHeight;
  Draw draw;
  draw.vertices = vertices, draw.indices = work.indices, draw.depth_mode = DepthMode::clip;
  const double before = peak_memory(true);
  if (render(target, {&draw, 1}, nullptr, {.threads = call_threads}) != Status::ok) return 1;
  const double taken = peak_memory(false) - before;
  const double allowed = 12 * static_cast<double>(samples) / (1 << 20) + 32 + call_threads;
  std::printf("%s, %d x %d, %d threads: %.1f MiB taken, %.1f allowed\n", name.c_str(), target.width, target.height,
              call_threads, taken, allowed);
  return taken <= allowed ? 0 : 1;
}

template <typename Run>
void add(const std::string& name, const Run& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->UseRealTime();
}

// A workload or mesh, drawn by both.
void add_both(const std::string& name, const Options& options) {
  using State = benchmark::State;
  const auto with = [&](Output output) { return [=](State& state) { surefill_draws(state, name, output, options); }; };
  const auto on_avx2 = [&](Output output) {
    return [=](State& state) { target_draws(state, name, output, options, HWY_AVX2); };
  };
  add(name + "/count/surefill", with(Output::count));
  add(name + "/depth/surefill", with(Output::depth));
  add(name + "/visibility/surefill", with(Output::visibility));
  add(name + "/attributes/surefill", with(Output::attributes));
  add(name + "/depth/llvmpipe", [=](State& state) { llvmpipe_draws(state, name, false); });
  add(name + "/attributes/llvmpipe", [=](State& state) { llvmpipe_draws(state, name, true); });
  if (options.threads != 1) return;
  add(name + "/depth/unclipped",
      [=](State& state) { surefill_draws(state, name, Output::depth, options, Mode::unclipped); });
  add(name + "/depth/alone", [=](State& state) { surefill_draws(state, name, Output::depth, {}); });
  if ((hwy::SupportedTargets() & (HWY_AVX3 | HWY_AVX3_DL)) == 0) return;  // else it is the row above
  add(name + "/depth/AVX2", on_avx2(Output::depth));
  add(name + "/visibility/AVX2", on_avx2(Output::visibility));
  add(name + "/attributes/AVX2", on_avx2(Output::attributes));
}

void add_all() {
  using State = benchmark::State;
  // Calls share a context, as those of llvmpipe do.
  static Context context;
  const Options options{.threads = threads(), .context = &context};
  const bool one = options.threads == 1;
  for (int number = 1; number <= kWorkloads; ++number) {
    const std::string free = "W" + std::to_string(number);
    add_both(free, options);
    if (!one) continue;
    for (const std::string& name : {free, free + "/snapped", free + "/aligned"}) {
      if (name != free)
        add(name + "/depth/surefill", [=](State& state) { surefill_draws(state, name, Output::depth, options); });
      add(name + "/depth/inexact-coverage",
          [=](State& state) { inexact_draws(state, name, surefill_bench_inexact_coverage); });
    }
    add(free + "/depth/grid", [=](State& state) { surefill_draws(state, free, Output::depth, options, Mode::grid); });
    add(free + "/count/conservative",
        [=](State& state) { surefill_draws(state, free, Output::count, options, Mode::over); });
    add(free + "/depth/inexact-depth", [=](State& state) { inexact_draws(state, free, surefill_bench_inexact_depth); });
  }
  for (const char* const triangles : {"50000", "1000000"}) add_both(std::string("knot/") + triangles, options);
  for (const char* const name : {"lines/100000", "points/1000000"}) {
    add(std::string(name) + "/depth/surefill",
        [=](State& state) { surefill_draws(state, name, Output::depth, options); });
    add(std::string(name) + "/depth/llvmpipe", [=](State& state) { llvmpipe_draws(state, name, false); });
  }
  add_occlusion(options.threads);
  if (!one) return;
  for (const char* const height : {"135", "270", "540", "1080"}) {
    const std::string name = std::string("spot/") + height;
    add(name + "/depth/surefill", [=](State& state) { surefill_draws(state, name, Output::depth, options); });
    add(name + "/attributes/surefill", [=](State& state) { surefill_draws(state, name, Output::attributes, options); });
    add(name + "/depth/llvmpipe", [=](State& state) { llvmpipe_draws(state, name, false); });
    add(name + "/attributes/llvmpipe", [=](State& state) { llvmpipe_draws(state, name, true); });
  }
  for (const char* const size : {"1000", "10000", "100000", "1000000", "10000000"}) {
    const std::string name = std::string("small/") + size;
    add(name + "/depth/surefill", [=](State& state) { surefill_draws(state, name, Output::depth, options); });
    add(name + "/depth/alone", [=](State& state) { surefill_draws(state, name, Output::depth, {}); });
  }
  add("memory/depth/limit", memory_limit);
  add("memory/depth/written", memory_written);
}

// What the numbers are of.
void add_context() {
  std::string processor = "unknown", line;
  for (std::ifstream file("/proc/cpuinfo"); std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) processor = line.substr(line.find(':') + 2);
  }
  benchmark::AddCustomContext("processor", processor);
  Diagnostics diagnostics;
  std::uint32_t count;
  Target target;
  target.width = target.height = 1, target.count = {&count, 1};
  if (render(target, {}, nullptr, {.diagnostics = &diagnostics}) == Status::ok)
    benchmark::AddCustomContext("instruction_set", diagnostics.path);
}

}  // namespace
}  // namespace surefill::bench

// surefill_bench --draw NAME TIMES [OUTPUT [AVX2]]: see draw_only. --memory NAME SIZE THREADS: see measure_memory. --hidden:
// see measure_hidden.
int main(int argc, char** argv) {
  if (argc >= 4 && argc <= 6 && std::string(argv[1]) == "--draw")
    return surefill::bench::draw_only(argv[2], std::atoi(argv[3]), argc > 4 ? argv[4] : "depth",
                                      argc > 5 ? argv[5] : "");
  if (argc == 5 && std::string(argv[1]) == "--memory")
    return surefill::bench::measure_memory(argv[2], std::atoi(argv[3]), std::atoi(argv[4]));
  if (argc == 2 && std::string(argv[1]) == "--hidden") return surefill::bench::measure_hidden();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  surefill::bench::add_context();
  surefill::bench::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
