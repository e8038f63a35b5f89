// SPDX-License-Identifier: Apache-2.0
//
// Frames of over 8 million pixels with counts and visibility are drawn in two halves, so that working memory stays
// below 8 bytes a pixel and 36 MiB. The seam is not seen: not in the image, nor in the counters.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#if !defined(SUREFILL_REFERENCE_ONLY)

namespace surefill::properties {
namespace {

// Ten bands of tiles; the halves meet at y = 320.
constexpr int kWidth = 16384, kHeight = 640, kSeam = 320;

// Triangles of every size around the seam and a few elsewhere, some with vertices behind the eye, in draws of each
// kind.
corpus::Scene seam_scene(std::uint64_t seed) {
  Random random(seed);
  corpus::Scene scene;
  scene.width = kWidth, scene.height = kHeight;
  const auto sixteenths = [&](int low, int high) {
    return static_cast<float>(random.between(16 * low, 16 * high)) / 16;
  };
  for (int kind = 0; kind < 4; ++kind) {
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    if (kind == 1) draw.grid = Grid{};
    if (kind == 2) draw.depth_mode = DepthMode::clip;
    if (kind == 3) draw.cull = Cull::back;
    for (std::uint32_t t = 0; t < 300; ++t) {
      constexpr int kSizes[] = {2, 8, 20, 60, 100, 300};
      const int size = kSizes[t % 6], spread = t % 5 == 0 ? kSeam : size;
      const float x = sixteenths(0, t % 2 == 0 ? 2000 : kWidth), y = sixteenths(kSeam - spread, kSeam + spread);
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

TEST(LargeCanvas, TheSeamIsNotSeen) {
  const corpus::Scene scene = seam_scene(1);
  const corpus::Outputs outputs{.barycentrics = false, .attributes = false};
  Statistics reference, halves, whole;
  // Without counts there are no halves.
  corpus::Frame no_counts(scene, {.count = false, .barycentrics = false, .attributes = false});
  ASSERT_EQ(render(no_counts.target(), no_counts.draws(), &whole), Status::ok);
  corpus::Frame expected(scene, outputs);
  ASSERT_EQ(render(expected.target(), expected.draws(), &reference, {.path = Path::reference}), Status::ok);
  ASSERT_STREQ(reference.path, "reference");
  for (const int threads : {1, 2, 7}) {
    corpus::Frame frame(scene, outputs);
    ASSERT_EQ(render(frame.target(), frame.draws(), &halves, {.threads = threads}), Status::ok);
    ASSERT_STRNE(halves.path, "reference");
    const Comparison result = compare(scene, expected.image(), frame.image());
    EXPECT_EQ(result.differences, 0u) << threads << " threads: " << describe(result.first.front(), 1);
    const auto counters = [](const Statistics& s) {
      return std::array{s.triangles,  s.dropped, s.degenerate, s.culled, s.outside,
                        s.rasterized, s.small,   s.medium,     s.large,  s.clipped};
    };
    EXPECT_EQ(counters(halves), counters(whole)) << threads << " threads";
  }
  for (const std::uint64_t some : {whole.culled, whole.outside, whole.small, whole.medium, whole.large, whole.clipped})
    EXPECT_GT(some, 0u);
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

TEST(LargeCanvas, WorkingMemoryIsBounded) {
  const corpus::Scene scene = seam_scene(2);
  corpus::Frame frame(scene, {.barycentrics = false, .attributes = false});
  Meter meter;
  meter.before = Meter::in_use();
  if (meter.before < std::size_t{12} * kWidth * kHeight)
    GTEST_SKIP() << "another allocator, which mallinfo2 cannot see";
  ASSERT_EQ(render(frame.target(), frame.draws(), nullptr, {.executor = {Meter::run, &meter}}), Status::ok);
  constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  EXPECT_LE(meter.most, 8 * kPixels + (std::size_t{36} << 20));
  EXPECT_GE(meter.most, 6 * kPixels) << "not measured";
}

#endif

}  // namespace
}  // namespace surefill::properties

#endif
