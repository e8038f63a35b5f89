// SPDX-License-Identifier: Apache-2.0
//
// What surrounds the image: coverage streamed to a visitor equals the counts of M2, the caller's executor and culling
// boxes (M6) change nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

#if defined(SUREFILL_TBB)
#include "surefill/tbb.hpp"
#endif

namespace surefill::properties {
namespace {

// All blocks of a stream, in the order in which they came.
struct Stream {
  std::vector<CoverageBlock> blocks;
  Statistics statistics;
};

Target size(int width, int height, int samples) {
  Target target;
  target.width = width, target.height = height, target.samples = samples;
  return target;
}

Stream stream_of(const corpus::Scene& scene, const Options& options) {
  corpus::Frame frame(scene, {.index = false, .depth = false, .barycentrics = false, .attributes = false});
  Stream stream;
  std::mutex mutex;
  struct Sink {
    Stream* stream;
    std::mutex* mutex;
  } sink{&stream, &mutex};
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    const Sink& to = *static_cast<Sink*>(context);
    const std::lock_guard lock(*to.mutex);
    to.stream->blocks.insert(to.stream->blocks.end(), blocks.begin(), blocks.end());
  };
  EXPECT_EQ(visit_coverage(size(scene.width, scene.height, scene.samples), frame.draws(), {visit, &sink},
                           &stream.statistics, options),
            Status::ok);
  return stream;
}

std::vector<std::uint32_t> counts_of(const corpus::Scene& scene, const Stream& stream) {
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(scene.width * scene.height * scene.samples));
  for (const CoverageBlock& block : stream.blocks) {
    for (int bit = 0; bit < 64; ++bit) {
      if ((block.mask >> bit & 1) == 0) continue;
      const int x = block.x + bit % 8, y = block.y + bit / 8;
      EXPECT_TRUE(x < scene.width && y < scene.height) << "beyond the target";
      if (x >= scene.width || y >= scene.height) return {};
      ++counts[static_cast<std::size_t>((y * scene.width + x) * scene.samples + block.sample)];
    }
  }
  return counts;
}

auto key(const CoverageBlock& b) {
  return std::make_tuple(b.sample, b.y, b.x, b.draw, b.triangle, b.mask);
}

// Within a tile of 64 x 64 pixels and a sample number, in the order of draws and triangles.
bool is_ordered(const Stream& stream) {
  std::map<std::tuple<int, int, int>, std::tuple<std::uint32_t, std::uint32_t>> last;
  for (const CoverageBlock& b : stream.blocks) {
    auto& before = last[{b.sample, b.x / 64, b.y / 64}];
    const std::tuple here{b.draw, b.triangle};
    if (here < before) return false;
    before = here;
  }
  return true;
}

void check_stream(const corpus::Scene& scene, const std::string& what) {
  corpus::Frame frame(scene, {.index = false, .depth = false, .barycentrics = false, .attributes = false});
  ASSERT_EQ(render(frame.target(), frame.draws(), nullptr, {.path = Path::reference}), Status::ok);
  Stream reference = stream_of(scene, {.path = Path::reference});
  ASSERT_EQ(counts_of(scene, reference), frame.image().count) << what << '\n' << corpus::write_scene(scene);
  std::sort(reference.blocks.begin(), reference.blocks.end(),
            [](const auto& a, const auto& b) { return key(a) < key(b); });
  for (const int threads : {1, 2, 3}) {
    Stream stream = stream_of(scene, {.threads = threads});
    ASSERT_TRUE(is_ordered(stream)) << what << ", threads " << threads << '\n' << corpus::write_scene(scene);
    std::sort(stream.blocks.begin(), stream.blocks.end(), [](const auto& a, const auto& b) { return key(a) < key(b); });
    ASSERT_TRUE(std::equal(stream.blocks.begin(), stream.blocks.end(), reference.blocks.begin(), reference.blocks.end(),
                           [](const auto& a, const auto& b) { return key(a) == key(b); }))
        << what << ", threads " << threads << '\n'
        << corpus::write_scene(scene);
  }
}

TEST(Streaming, EqualsTheCountsInEveryCategory) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 60; ++seed)
      check_stream(mixed_scene(category, seed, 16, 4), std::string(category.name) + ", seed " + std::to_string(seed));
    for (std::uint64_t seed = 0; seed < 6; ++seed)
      check_stream(mixed_scene(category, seed, 200, 8), std::string(category.name) + ", seed " + std::to_string(seed));
  }
}

TEST(Streaming, AFullBlockIsSaidToBeOne) {
  const Vertex vertices[] = {{-100, -100, 0, 1}, {300, -100, 0, 1}, {-100, 300, 0, 1}};
  const std::uint32_t indices[] = {0, 1, 2};
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  int full = 0, all = 0;
  struct Sink {
    int *full, *all;
  } sink{&full, &all};
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    const Sink& to = *static_cast<Sink*>(context);
    for (const CoverageBlock& block : blocks) *to.full += block.full(), ++*to.all;
  };
  EXPECT_EQ(visit_coverage(size(60, 16, 1), {&draw, 1}, {visit, &sink}), Status::ok);
  EXPECT_EQ(all, 16);
  EXPECT_EQ(full, 14);  // the last column of blocks has four of its eight columns of pixels
}

TEST(Streaming, ArgumentsAreChecked) {
  const auto visit = [](void*, std::span<const CoverageBlock>) {};
  const CoverageVisitor visitor{visit, nullptr};
  EXPECT_EQ(visit_coverage(size(0, 16, 1), {}, visitor), Status::target_size);
  EXPECT_EQ(visit_coverage(size(16, 16, 3), {}, visitor), Status::target_samples);
  EXPECT_EQ(visit_coverage(size(16, 16, 1), {}, {}), Status::visitor);
  std::vector<float> values(3 * 256);
  std::vector<std::uint32_t> words(256);
  const AttributeTarget attribute{std::span(values).first(256), 1};
  for (int output = 0; output < 5; ++output) {
    Target target = size(16, 16, 1);
    if (output == 0) target.count = words;
    if (output == 1) target.index = words;
    if (output == 2) target.depth = std::span(values).first(256);
    if (output == 3) target.barycentrics = values;
    if (output == 4) target.attributes = {&attribute, 1};
    EXPECT_EQ(visit_coverage(target, {}, visitor), Status::target_outputs) << output;
  }
  EXPECT_EQ(visit_coverage(size(16, 16, 1), {}, visitor, nullptr, {.threads = 0}), Status::options_threads);
  Draw draw;
  draw.indices = {static_cast<const std::uint32_t*>(nullptr), 3};
  EXPECT_EQ(visit_coverage(size(16, 16, 1), {&draw, 1}, visitor), Status::draw_indices);
}

// Runs the items backwards, on threads of its own that begin with another rounding mode.
void run_backwards(void* context, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
  *static_cast<std::size_t*>(context) += items;
  std::thread([&] {
    std::fesetround(FE_UPWARD);
    for (std::size_t item = items; item-- > 0;) task(argument, item);
  }).join();
}

void expect_nothing_changes(const Options& options) {
  const Renderer with_executor = [&](const Target& target, std::span<const Draw> draws) {
    return render(target, draws, nullptr, options);
  };
  const Renderer reference = [](const Target& target, std::span<const Draw> draws) {
    return render(target, draws, nullptr, {.path = Path::reference});
  };
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const corpus::Scene scene = mixed_scene(category, seed, 200, 6);
      const Comparison result = compare(scene, reference, with_executor);
      ASSERT_EQ(result.differences, 0u) << category.name << ", seed " << seed << '\n' << corpus::write_scene(scene);
    }
  }
}

TEST(Executor, ChangesNothing) {
  std::size_t items = 0;
  expect_nothing_changes({.threads = 3, .executor = {run_backwards, &items}});
#if !defined(SUREFILL_REFERENCE_ONLY)
  EXPECT_GT(items, 1000u) << "the executor was not asked";
#endif
}

#if defined(SUREFILL_TBB)
TEST(Executor, MayBeOneTbb) {
  expect_nothing_changes({.threads = 3, .executor = tbb_executor()});
}
#endif

// Eight corners whose hull is that of the draw's vertices; for more than eight vertices none.
std::optional<std::array<Vertex, 8>> own_corners(const corpus::SceneDraw& draw) {
  std::vector<Vertex> used;
  for (const corpus::SceneTriangle& t : draw.triangles) {
    for (const std::uint32_t v : t.vertices) {
      const corpus::SceneVertex& vertex = draw.vertices[v];
      used.push_back({vertex.x, vertex.y, vertex.z, vertex.w});
    }
  }
  if (used.empty() || used.size() > 8 || draw.viewport) return std::nullopt;  // the box is in pixels
  std::array<Vertex, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = used[i % used.size()];
  return corners;
}

TEST(CullingBoxes, SkipDrawsAndChangeNothing) {
  [[maybe_unused]] std::uint64_t skipped = 0;
  const Renderer reference = [](const Target& target, std::span<const Draw> draws) {
    return render(target, draws, nullptr, {.path = Path::reference});
  };
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
      corpus::Scene scene = mixed_scene(category, seed, seed % 6 == 0 ? 150 : 16, 6);
      for (corpus::SceneDraw& draw : scene.draws) draw.culling_box = own_corners(draw);
      // Most often an occluder before the draws; else everything in front, or clipped.
      if (seed % 4 != 0 && !scene.draws.empty()) {
        corpus::SceneDraw wall = scene.draws[0];
        wall = {};
        const float far = seed % 8 < 4 ? -1.0f : 0.25f, size = 1000;
        wall.vertices = {{-size, -size, far, 1, {}}, {4 * size, -size, far, 1, {}}, {-size, 4 * size, far, 1, {}}};
        for (corpus::SceneVertex& v : wall.vertices)
          v.attributes = scene.draws[0].vertices.empty() ? v.attributes : scene.draws[0].vertices[0].attributes;
        wall.triangles = {{{0, 1, 2}, {}}};
        if (!scene.draws[0].vertices.empty()) scene.draws.insert(scene.draws.begin(), wall);
      }
      const Renderer boxed = [&](const Target& target, std::span<const Draw> draws) {
        Diagnostics diagnostics;
        const Status status =
            render(target, draws, nullptr, {.threads = 1 + static_cast<int>(seed % 2), .diagnostics = &diagnostics});
        skipped += diagnostics.skipped_draws;
        return status;
      };
      for (const bool with_count : {true, false}) {
        corpus::Outputs outputs = outputs_of(scene);
        if (outputs.depth) outputs.count = with_count;
        const Comparison result = compare(scene, reference, boxed, outputs);
        ASSERT_EQ(result.differences, 0u)
            << category.name << ", seed " << seed << ": " << describe(result.first.front(), scene.samples) << '\n'
            << corpus::write_scene(scene);
      }
    }
  }
#if !defined(SUREFILL_REFERENCE_ONLY)
  EXPECT_GT(skipped, 500u) << "boxes were not looked at";
#endif
}

#if !defined(SUREFILL_REFERENCE_ONLY)
TEST(CullingBoxes, TellWhatIsHidden) {
  const Vertex vertices[] = {{-100, -100, 0.5f, 1}, {300, -100, 0.5f, 1}, {-100, 300, 0.5f, 1},
                             {10, 10, 1.2f, 2},     {90, 10, 1.2f, 2},    {10, 90, 1.2f, 2}};
  const std::uint32_t indices[] = {0, 1, 2, 3, 4, 5};
  Draw draws[2];
  draws[0].vertices = draws[1].vertices = vertices;
  draws[0].indices = std::span(indices, 3), draws[1].indices = std::span(indices + 3, 3);
  std::array<Vertex, 8>& box = draws[1].culling_box.emplace();
  for (std::size_t i = 0; i < 8; ++i) box[i] = vertices[3 + i % 3];
  std::vector<float> depth(100 * 100);
  Target target;
  target.width = target.height = 100, target.depth = depth;
  for (const auto& [test, mode, z, skipped] : {std::tuple{DepthTest::less, DepthMode::none, 1.2f, 1u},
                                               {DepthTest::less, DepthMode::none, 0.8f, 0u},
                                               {DepthTest::greater, DepthMode::none, 1.2f, 0u},
                                               {DepthTest::greater, DepthMode::none, 0.8f, 1u},
                                               {DepthTest::less, DepthMode::clip, 0.8f, 0u},
                                               {DepthTest::less, DepthMode::clip, -0.1f, 1u},
                                               {DepthTest::less, DepthMode::clip, 2.5f, 1u}}) {
    target.depth_test = test;
    draws[1].depth_mode = mode;
    for (Vertex& corner : box) corner.z = z;
    Diagnostics diagnostics;
    ASSERT_EQ(render(target, draws, nullptr, {.diagnostics = &diagnostics}), Status::ok);
    EXPECT_EQ(diagnostics.skipped_draws, skipped) << z;
  }
}
#endif

}  // namespace
}  // namespace surefill::properties
