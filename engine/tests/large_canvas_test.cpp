// SPDX-License-Identifier: Apache-2.0
//
// Working memory is at most 12 bytes a pixel, 32 MiB and 1 MiB a thread, however many triangles there are; and frames
// of many chunks, and of few, are the reference path's, also where lists are full.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#if !defined(SUREFILL_REFERENCE_ONLY)

namespace surefill::properties {
namespace {

// Ten rows of tiles.
constexpr int kWidth = 16384, kHeight = 640, kSeam = 320;

// Triangles of every size around a border of tiles and a few elsewhere, some with vertices behind the eye, in draws of
// each kind. A chunk holds at most 16 draws.
corpus::Scene large_scene(std::uint64_t seed, int draws, int width = kWidth) {
  Random random(seed);
  corpus::Scene scene;
  scene.width = width, scene.height = kHeight;
  const auto sixteenths = [&](int low, int high) {
    return static_cast<float>(random.between(16 * low, 16 * high)) / 16;
  };
  for (int n = 0; n < draws; ++n) {
    const int kind = n % 4;
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    if (kind == 1) draw.grid = Grid{};
    if (kind == 2) draw.depth_mode = DepthMode::clip;
    if (kind == 3) draw.cull = Cull::back;
    for (std::uint32_t t = 0; t < 300; ++t) {
      constexpr int kSizes[] = {2, 8, 20, 60, 100, 300};
      const int size = kSizes[t % 6], spread = t % 5 == 0 ? kSeam : size;
      const float x = sixteenths(0, t % 2 == 0 ? 2000 : width), y = sixteenths(kSeam - spread, kSeam + spread);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const float w = t % 100 == 7 && k == 0 ? -0.25f : static_cast<float>(random.between(1, 4));
        draw.vertices.push_back(
            {(x + sixteenths(-size, size)) * w, (y + sixteenths(-size, size)) * w, sixteenths(-1, 2) * w, w, {}});
      }
      draw.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, {}});
    }
  }
  return scene;
}

void expect_the_reference(const corpus::Scene& scene, Statistics* statistics, Diagnostics* one_thread) {
  const corpus::Outputs outputs{.barycentrics = false, .attributes = false};
  Diagnostics reference;
  corpus::Frame expected(scene, outputs);
  ASSERT_EQ(
      render(expected.target(), expected.draws(), statistics, {.path = Path::reference, .diagnostics = &reference}),
      Status::ok);
  ASSERT_STREQ(reference.path, "reference");
  for (const int threads : {1, 2, 7}) {
    Statistics here;
    Diagnostics diagnostics;
    corpus::Frame frame(scene, outputs);
    ASSERT_EQ(render(frame.target(), frame.draws(), &here, {.threads = threads, .diagnostics = &diagnostics}),
              Status::ok);
    ASSERT_STRNE(diagnostics.path, "reference");
    EXPECT_EQ(here, *statistics);
    const Comparison result = compare(scene, expected.image(), frame.image());
    EXPECT_EQ(result.differences, 0u) << threads << " threads: " << describe(result.first.front(), 1);
    const auto counters = [](const Diagnostics& d) {
      return std::array{d.outside, d.small, d.medium, d.large, d.clipped};
    };
    if (threads == 1) *one_thread = diagnostics;
    EXPECT_EQ(counters(diagnostics), counters(*one_thread)) << threads << " threads";
  }
}

TEST(LargeCanvas, FewChunksAndManyEqualTheReference) {
  for (const int draws : {4, 20}) {
    Statistics s;
    Diagnostics d;
    expect_the_reference(large_scene(1, draws, 2100), &s, &d);
    for (const std::uint64_t some : {s.culled, s.rasterized, d.outside, d.clipped}) EXPECT_GT(some, 0u);
  }
}

// Triangles that each meet thousands of tiles, so that a piece's lists are full before all of it is set up; Grid clips
// some of them to fans. In draws that are small enough to fit they give the same image.
TEST(LargeCanvas, FullListsChangeNothing) {
  constexpr std::uint32_t kTriangles = 60, kFew = 12;
  for (const bool grid : {false, true}) {
    Random random(3);
    corpus::Scene full, parts;
    full.width = parts.width = kWidth, full.height = parts.height = kHeight;
    corpus::SceneDraw& draw = full.draws.emplace_back();
    if (grid) draw.grid = Grid{};
    for (std::uint32_t t = 0; t < kTriangles; ++t) {
      const auto edge = [&](int reach) { return static_cast<float>(random.between(-16 * reach, 16 * reach)) / 16; };
      const float w = t % 10 == 9 ? -0.5f : 1.0f, z = static_cast<float>(random.between(0, 9));
      const corpus::SceneVertex triangle[3] = {{-4000 + edge(900), -500 + edge(400), z, 1, {}},
                                               {30000 + edge(900), -500 + edge(400), z, 1, {}},
                                               {(8000 + edge(4000)) * w, 1500 * w, z * w, w, {}}};
      if (t % kFew == 0) {
        parts.draws.emplace_back().grid = draw.grid;
        parts.draws.back().first_index = t;
      }
      for (corpus::SceneDraw* const to : {&draw, &parts.draws.back()}) {
        const auto first = static_cast<std::uint32_t>(to->vertices.size());
        to->vertices.insert(to->vertices.end(), triangle, triangle + 3);
        to->triangles.push_back({{first, first + 1, first + 2}, {}});
      }
    }
    const corpus::Outputs outputs{.barycentrics = false, .attributes = false};
    corpus::Frame expected(parts, outputs), actual(full, outputs);
    Diagnostics d;
    ASSERT_EQ(render(expected.target(), expected.draws()), Status::ok);
    ASSERT_EQ(render(actual.target(), actual.draws(), nullptr, {.diagnostics = &d}), Status::ok);
    const Comparison result = compare(full, expected.image(), actual.image());
    EXPECT_EQ(result.differences, 0u) << describe(result.first.front(), 1);
    EXPECT_EQ(d.clipped != 0, grid);
  }
}

#if defined(__GLIBC__)

// What the process has got from malloc, measured whenever the call at hand gives work to its executor.
struct Meter {
  std::size_t before = 0, most = 0;

  static std::size_t in_use() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  }
  static void run(void* context, std::size_t items, void (*task)(void* argument, std::size_t item), void* argument) {
    Meter& meter = *static_cast<Meter*>(context);
    for (std::size_t item = 0; item < items; ++item) {
      task(argument, item);
      meter.most = std::max(meter.most, in_use() - meter.before);
    }
  }
};

// The most that a call of `threads` threads has at a time.
std::size_t most_memory(const corpus::Scene& scene, int threads) {
  corpus::Frame frame(scene, {.barycentrics = false, .attributes = false});
  Meter meter;
  meter.before = Meter::in_use();
  EXPECT_EQ(render(frame.target(), frame.draws(), nullptr, {.threads = threads, .executor = {Meter::run, &meter}}),
            Status::ok);
  return meter.most;
}

TEST(LargeCanvas, WorkingMemoryIsBounded) {
  constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight, kMiB = std::size_t{1} << 20;
  {
    const std::vector<std::uint32_t> some(kPixels);
    if (Meter::in_use() < 4 * kPixels) GTEST_SKIP() << "another allocator, which mallinfo2 cannot see";
  }
  for (const int threads : {1, 3}) {
    const auto of_threads = static_cast<std::size_t>(threads) * kMiB;
    const std::size_t many = most_memory(large_scene(2, 20), threads), few = most_memory(large_scene(2, 4), threads);
    EXPECT_LE(many, 12 * kPixels + 32 * kMiB + of_threads);
    EXPECT_GE(many, 12 * kPixels) << "not measured";
    EXPECT_LE(few, 12 * kPixels / 2) << "frames of one chunk need a row of tiles a thread";
  }
}

#endif

}  // namespace
}  // namespace surefill::properties

#endif
