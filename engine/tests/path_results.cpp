// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/tests/path_cases.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {
namespace {

// How many draws have culling boxes behind the eye.
std::uint64_t draws_behind(const corpus::Scene& scene) {
  const auto behind = [](const Vertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v.w <= 0 && std::isfinite(v.w);
  };
  const auto count = std::count_if(scene.draws.begin(), scene.draws.end(), [&](const corpus::SceneDraw& draw) {
    return draw.culling_box && std::all_of(draw.culling_box->begin(), draw.culling_box->end(), behind);
  });
  return static_cast<std::uint64_t>(count);
}

// Whether Grid clips each triangle: all reach behind the eye.
bool all_clipped(const corpus::Scene& scene) {
  return std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
    return draw.grid && std::all_of(draw.triangles.begin(), draw.triangles.end(), [&](const auto& triangle) {
             return std::any_of(std::begin(triangle.vertices), std::end(triangle.vertices),
                                [&](std::uint32_t v) { return draw.vertices[v].w <= 0; });
           });
  });
}

// With several samples the fast path's numbers are those of sample 0, and other modes have other boxes.
std::string broken_diagnostics(const PathResult& fast, const PathResult& reference, const corpus::Scene& scene) {
  const bool plain = scene.samples == 1 && std::all_of(scene.draws.begin(), scene.draws.end(), [](const auto& draw) {
                       return !draw.grid && draw.conservative == Conservative::none;
                     });
  const Diagnostics& d = fast.diagnostics;
  if ((*d.path == '\0') != (*reference.diagnostics.path == '\0')) return "who drew it";
  if (std::string_view(d.path) == "reference") return "";  // which neither skips draws nor sorts triangles by size
  if (d.skipped_draws < draws_behind(scene)) return "skipped draws";
  if (all_clipped(scene) &&
      (d.clipped > fast.statistics.rasterized || d.clipped + d.outside < fast.statistics.rasterized))
    return "clipped";
  if (!plain || d.skipped_draws != 0) return "";
  if (d.small + d.medium + d.large > fast.statistics.rasterized) return "the sum of the sizes";
  if (d.small + d.medium + d.large + d.outside < fast.statistics.rasterized) return "what is drawn, or outside";
  return "";
}

// While it lives no thread starts: a stack would be larger than all memory that has addresses.
class NoThreads {
 public:
#if defined(__GLIBC__)
  NoThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t none = before_;
    pthread_attr_setstacksize(&none, std::size_t{1} << 60);
    pthread_setattr_default_np(&none);
  }
  ~NoThreads() {
    pthread_setattr_default_np(&before_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t before_;
#endif
};

bool same(const Diagnostics& a, const Diagnostics& b) {
  const Rungs &p = a.rungs, &q = b.rungs;
  return a.outside == b.outside && a.small == b.small && a.medium == b.medium && a.large == b.large &&
         a.clipped == b.clipped && p.signs_by_filter == q.signs_by_filter &&
         p.signs_by_residual == q.signs_by_residual && p.signs_by_expansion == q.signs_by_expansion &&
         p.values_by_filter == q.values_by_filter && p.values_by_expansion == q.values_by_expansion;
}

}  // namespace

PathResult draw_path(const PathScene& of, const Options& with) {
  corpus::Frame frame(of.scene, of.outputs);
  corpus::Image& image = frame.image();
  const auto for_each = [&](const auto& visit) {
    for (auto* words : {&image.count, &image.index})
      for (std::uint32_t& word : *words) visit(word);
    for (auto* values : {&image.depth, &image.barycentrics})
      for (float& value : *values) visit(value);
    for (auto& values : image.attributes)
      for (float& value : values) visit(value);
  };
  for_each([](auto& value) { value = std::bit_cast<std::decay_t<decltype(value)>>(0x4DEADBEFu); });
  Target target = frame.target();
  if (of.in_place && !target.depth.empty() && !target.initial_depth.empty()) {
    std::copy(target.initial_depth.begin(), target.initial_depth.end(), target.depth.begin());
    target.initial_depth = target.depth;
  }
  Options options = with;
  // Where one attribute is all that a vertex has, its stride need not be said.
  std::vector<Draw> draws(frame.draws().begin(), frame.draws().end());
  std::vector<std::vector<AttributeArray>> attributes;
  for (Draw& draw : draws) {
    auto& arrays = attributes.emplace_back(draw.attributes.begin(), draw.attributes.end());
    const std::size_t turn = of.interpolations ? attributes.size() : 0;
    for (AttributeArray& array : arrays) {
      if (array.stride == array.components) array.stride = 0;
      array.interpolation = static_cast<Interpolation>((static_cast<std::size_t>(array.interpolation) + turn) % 3);
    }
    draw.attributes = arrays;
  }
  std::vector<AttributeTarget> wanted(target.attributes.begin(), target.attributes.end());
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if ((of.wanted >> k & 1) == 0) wanted[k].values = {};
  while (!wanted.empty() && wanted.back().values.empty()) wanted.pop_back();  // a draw may have more
  target.attributes = wanted;
  PathResult result;
  if (of.executor) {
    options.executor.run = [](void* handed_out, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
      *static_cast<std::size_t*>(handed_out) += items;
      while (items-- > 0) task(argument, items);
    };
    options.executor.context = &result.handed_out;
  }
  const std::unique_ptr<NoThreads> alone(of.alone ? new NoThreads : nullptr);
  options.diagnostics = &result.diagnostics;
  result.hash = static_cast<std::uint64_t>(render(target, draws, &result.statistics, options));
  for_each([&](auto& value) {
    result.hash = (result.hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15u;
    result.hash ^= result.hash >> 29;
  });
  if (!of.streams) return result;
  // In any order: a sum over the blocks, and counts.
  struct Sink {
    std::mutex mutex;
    std::uint64_t sum = 0;
    std::vector<std::uint32_t> counts;
    int width, height, samples;
  } sink;
  sink.width = target.width, sink.height = target.height, sink.samples = target.samples;
  sink.counts.resize(sample_total(target));
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    Sink& to = *static_cast<Sink*>(context);
    const std::lock_guard lock(to.mutex);
    for (const CoverageBlock& b : blocks) {
      std::uint64_t key = b.mask;
      for (const auto part : {b.draw, b.triangle, static_cast<std::uint32_t>(b.x), static_cast<std::uint32_t>(b.y),
                              static_cast<std::uint32_t>(b.sample)})
        key = (key ^ key >> 31 ^ part) * 0x9E3779B97F4A7C15u;
      to.sum += key ^ key >> 29;
      for (int bit = 0; bit < 64; ++bit) {
        if ((b.mask >> bit & 1) == 0) continue;
        const int x = b.x + bit % 8, y = b.y + bit / 8;
        const bool within = x >= 0 && x < to.width && y >= 0 && y < to.height && b.sample < to.samples;
        if (within) ++to.counts[static_cast<std::size_t>((y * to.width + x) * to.samples + b.sample)];
        if (!within) ++to.counts[0];  // what cannot be
      }
      if (b.mask == 0) ++to.counts[0];
    }
  };
  Statistics statistics;
  Target size;
  size.width = target.width, size.height = target.height, size.samples = target.samples;
  options.diagnostics = nullptr;
  const Status status = visit_coverage(size, draws, {visit, &sink}, &statistics, options);
  result.stream = sink.sum + static_cast<std::uint64_t>(status);
  if (status == Status::ok && !image.count.empty())
    result.counts_agree = sink.counts == image.count && statistics == result.statistics;
  return result;
}

std::string broken_path(const PathScene& of, const PathResult& reference) {
  const PathResult fast = draw_path(of, {.threads = of.threads});
  if (fast.hash != reference.hash) return "the image";
  // A half, where the canvas has two, has several bands then.
  const bool by_threads = std::string_view(fast.diagnostics.path) != "reference";
  if (by_threads && of.executor && of.scene.height > 128 && fast.handed_out == 0) return "the executor is not asked";
  if (fast.stream != reference.stream || !fast.counts_agree) return "streamed coverage";
  if (fast.statistics != reference.statistics) return "statistics";
  if (std::string broken = broken_diagnostics(fast, reference, of.scene); !broken.empty())
    return "diagnostics: " + broken;
  if (of.threads == 3) {
    const PathResult alone = draw_path(of, {.threads = 1});
    if (alone.hash != reference.hash) return "the image on one thread";
    // Of draws that a culling box skips, the first thread's numbers are told.
    const bool skips = fast.diagnostics.skipped_draws + alone.diagnostics.skipped_draws != 0;
    if (!skips && !same(fast.diagnostics, alone.diagnostics)) return "diagnostics on one thread and on several";
  }
  return "";
}

}  // namespace surefill::properties
