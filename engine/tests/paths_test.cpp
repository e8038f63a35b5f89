// SPDX-License-Identifier: Apache-2.0
//
// The paths through the engine: every instruction set that this machine has, by name, on one and two threads, gives the
// image of the scalar reference path, bit for bit; and each test proves that the path it names is the one that ran.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

#if !defined(SUREFILL_REFERENCE_ONLY)
#include "hwy/targets.h"
#endif

namespace surefill::properties {
namespace {

// Draws on a path, and notes its name.
Renderer on_path(Options options, std::string* path) {
  return [options, path](const Target& target, std::span<const Draw> draws) {
    Diagnostics diagnostics;
    Options with = options;
    with.diagnostics = &diagnostics;
    const Status status = render(target, draws, nullptr, with);
    *path = diagnostics.path;
    return status;
  };
}

TEST(Paths, TheReferencePathRunsWhenAskedFor) {
  std::string path;
  const corpus::Scene scene = random_scene(categories().front(), 1);
  corpus::Frame frame(scene, outputs_of(scene));
  EXPECT_EQ(on_path({.path = Path::reference}, &path)(frame.target(), frame.draws()), Status::ok);
  EXPECT_EQ(path, "reference");
}

TEST(Paths, OptionsAreChecked) {
  const corpus::Scene scene = random_scene(categories().front(), 1);
  corpus::Frame frame(scene, outputs_of(scene));
  for (const int threads : {0, -1, kMaxThreads + 1}) {
    EXPECT_EQ(render(frame.target(), frame.draws(), nullptr, {.threads = threads}), Status::options_threads);
  }
  EXPECT_EQ(render(frame.target(), frame.draws(), nullptr, {.path = static_cast<Path>(2)}), Status::options_path);
}

#if !defined(SUREFILL_REFERENCE_ONLY)

class OnTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    hwy::SetSupportedTargetsForTest(GetParam());
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  void TearDown() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

void compare_paths(std::int64_t target, int size, int triangles, std::uint64_t scenes) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < scenes; ++seed) {
      const corpus::Scene scene = mixed_scene(category, seed, size, triangles);
      std::string reference, fast;
      const Options two_threads{.threads = 1 + static_cast<int>(seed & 1)};
      const Comparison result =
          compare(scene, on_path({.path = Path::reference}, &reference), on_path(two_threads, &fast));
      ASSERT_EQ(reference, "reference");
      ASSERT_EQ(fast, hwy::TargetName(target)) << "the path under test did not run";
      ASSERT_EQ(result.differences, 0u) << category.name << ", seed " << seed << ": "
                                        << describe(result.first.front(), scene.samples) << '\n'
                                        << corpus::write_scene(scene);
    }
  }
}

TEST_P(OnTarget, SmallTargetsEqualTheReference) {
  compare_paths(GetParam(), 16, 4, 200);
}
TEST_P(OnTarget, SeveralTilesEqualTheReference) {
  compare_paths(GetParam(), 150, 8, 12);
}
TEST_P(OnTarget, SeveralBandsEqualTheReference) {
  compare_paths(GetParam(), 400, 12, 2);
}

// M4 where a vertex is behind the eye: thin corners of T, at all angles, in all classes of size.
TEST_P(OnTarget, ConservativeBehindTheEyeEqualsTheReference) {
  Random random(11);
  for (int n = 0; n < 4000; ++n) {
    corpus::Scene scene;
    scene.width = scene.height = n % 8 == 0 ? 150 : n % 2 == 0 ? 60 : 16;
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    draw.conservative = n % 4 == 3 ? Conservative::inner : Conservative::over;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto pixel = [&](int size) {
        return static_cast<float>(random.below(16 * static_cast<std::uint32_t>(size))) / 16;
      };
      const float w = (k < 1 + static_cast<std::uint32_t>(n % 2) ? 1.0f : -1.0f) * (0.25f + pixel(2));
      draw.vertices.push_back({pixel(scene.width) * w, pixel(scene.height) * w, 0.5f, w, {}});
    }
    draw.triangles.push_back({{0, 1, 2}, {}});
    std::string reference, fast;
    const Comparison result =
        compare(scene, on_path({.path = Path::reference}, &reference), on_path({}, &fast), outputs_of(scene));
    ASSERT_EQ(result.differences, 0u) << describe(result.first.front(), 1) << '\n' << corpus::write_scene(scene);
  }
}

// What this machine has and this compiler was given (HWY_TARGETS).
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> all;
  for (std::int64_t bits = hwy::SupportedTargets() & HWY_TARGETS; bits != 0; bits &= bits - 1)
    all.push_back(bits & -bits);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Paths, OnTarget, testing::ValuesIn(targets()),
                         [](const auto& name) { return std::string(hwy::TargetName(name.param)); });

// Everything that may happen to a triangle on its way is reached, as the engine's own counters say, and gives the
// reference path's image: each class of size in each lane of a batch, clipped triangles, each rung of the ladder.
class Reach : public OnTarget {
 protected:
  // Draws on both paths, expects one image, and returns the fast path's counters.
  Diagnostics draw(const corpus::Scene& scene) {
    Diagnostics diagnostics;
    std::string reference;
    const Renderer fast = [&](const Target& target, std::span<const Draw> draws) {
      return render(target, draws, nullptr, {.diagnostics = &diagnostics});
    };
    const Comparison result = compare(scene, on_path({.path = Path::reference}, &reference), fast, outputs_of(scene));
    EXPECT_EQ(result.differences, 0u) << corpus::write_scene(scene);
    EXPECT_STREQ(diagnostics.path, hwy::TargetName(GetParam()));
    return diagnostics;
  }
  static corpus::Scene empty_scene(int size) {
    corpus::Scene scene;
    scene.width = scene.height = size;
    scene.draws.emplace_back();
    return scene;
  }
  static void add(corpus::SceneDraw& draw, float x, float y, float size, float w = 1) {
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    draw.vertices.push_back({x, y, 0.25f, 1, {}});
    draw.vertices.push_back({x + size, y + size / 4, 0.5f, 1, {}});
    draw.vertices.push_back({(x + size / 3) * w, (y + size) * w, 0.75f, w, {}});
    draw.triangles.push_back({{first, first + 1, first + 2}, {}});
  }
};

TEST_P(Reach, EveryClassInEveryLane) {
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    for (const float size : {1.5f, 3.0f, 7.0f, 13.0f, 40.0f, 55.0f, 90.0f, 190.0f}) {
      corpus::Scene scene = empty_scene(200);
      // The lanes before are empty: behind the eye, or beyond the target.
      for (std::uint32_t n = 0; n < lane; ++n) add(scene.draws[0], 300, 300, 10);
      add(scene.draws[0], 1.3f, 1.7f, size);
      const Diagnostics s = draw(scene);
      const std::uint64_t small = size<14, medium = size> 14 && size<60, large = size> 60;
      EXPECT_EQ(s.outside, lane) << lane << ' ' << size;
      EXPECT_EQ(s.small, small) << lane << ' ' << size;
      EXPECT_EQ(s.medium, medium) << lane << ' ' << size;
      EXPECT_EQ(s.large, large) << lane << ' ' << size;
    }
  }
}

TEST_P(Reach, ClippedTrianglesInEveryLane) {
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    for (const float w : {-1.0f, 0.0f, 1e-6f}) {
      corpus::Scene scene = empty_scene(100);
      scene.draws[0].grid = Grid{};
      for (std::uint32_t n = 0; n < lane; ++n) add(scene.draws[0], 300, 300, 10);
      add(scene.draws[0], 20, 30, 50, w);
      if (w >= 0) scene.draws[0].vertices.back().x = scene.draws[0].vertices.back().y = 30;
      const Diagnostics s = draw(scene);
      EXPECT_EQ(s.clipped, 1u) << lane << ' ' << w;
      EXPECT_EQ(s.small + s.medium + s.large, 0u) << lane << ' ' << w;
    }
  }
}

TEST_P(Reach, EveryRungOfTheLadder) {
  Rungs sum;
  std::uint64_t outside = 0;
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Diagnostics d = draw(mixed_scene(category, seed, 40, 6));
      const Rungs& s = d.rungs;
      sum.signs_by_filter += s.signs_by_filter;
      sum.signs_by_residual += s.signs_by_residual;
      sum.signs_by_expansion += s.signs_by_expansion;
      sum.values_by_filter += s.values_by_filter;
      sum.values_by_expansion += s.values_by_expansion;
      outside += d.outside;
    }
  }
  for (const std::uint64_t reached : {sum.signs_by_filter, sum.signs_by_residual, sum.signs_by_expansion,
                                      sum.values_by_filter, sum.values_by_expansion, outside}) {
    EXPECT_GT(reached, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Reach, testing::ValuesIn(targets()),
                         [](const auto& name) { return std::string(hwy::TargetName(name.param)); });

// More triangles than one chunk takes, in several draws: the image is kept between chunks.
TEST(Paths, ChunksKeepTheImage) {
  corpus::Scene scene;
  scene.width = 300, scene.height = 200;
  Random random(5);
  for (int d = 0; d < 3; ++d) {
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    for (std::uint32_t t = 0; t < 400000; ++t) {
      const float x = static_cast<float>(random.below(300 * 16)) / 16,
                  y = static_cast<float>(random.below(200 * 16)) / 16;
      for (std::uint32_t k = 0; k < 3; ++k) {
        draw.vertices.push_back({x + static_cast<float>(random.below(48)) / 16,
                                 y + static_cast<float>(random.below(48)) / 16,
                                 static_cast<float>(random.below(1000)),
                                 1,
                                 {}});
      }
      draw.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, {}});
    }
  }
  std::string reference, fast;
  const Comparison result =
      compare(scene, on_path({.path = Path::reference}, &reference), on_path({.threads = 2}, &fast));
  EXPECT_NE(fast, "reference");
  EXPECT_EQ(result.differences, 0u);
}

#endif

}  // namespace
}  // namespace surefill::properties
