// SPDX-License-Identifier: Apache-2.0
#include "properties/machinery/reduce.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {
namespace {

using corpus::Scene;

// A scene that uses everything which reduction can take away.
Scene rich_scene(std::uint64_t seed) {
  SceneLimits limits;
  limits.max_size = 12;
  limits.max_triangles = 6;
  limits.samples = limits.grid = limits.conservative = true;
  const auto all = categories();
  return random_scene(all[seed % all.size()], seed, limits);
}

bool is_valid(const Scene& scene) {
  const corpus::Frame frame(scene, outputs_of(scene));
  return validate(frame.target(), frame.draws()) == Status::ok;
}

std::size_t triangles_of(const Scene& scene) {
  std::size_t count = 0;
  for (const auto& draw : scene.draws) count += draw.triangles.size();
  return count;
}

TEST(SimplerScenes, AreOtherScenesThatCanBeWrittenAndDrawn) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = rich_scene(seed);
    ASSERT_TRUE(is_valid(scene));
    for (const Scene& simpler : simpler_scenes(scene)) {
      ASSERT_FALSE(corpus::equal(scene, simpler)) << corpus::write_scene(scene);
      ASSERT_TRUE(is_valid(simpler)) << corpus::write_scene(simpler);
      const Scene again = corpus::read_scene(corpus::write_scene(simpler));
      ASSERT_TRUE(corpus::equal(again, simpler)) << corpus::write_scene(simpler);
    }
  }
}

// Whatever is taken, the chain ends: at the empty scene, if everything fails.
TEST(Reduce, EndsAtNothingWhereEverythingFails) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene least = reduce(rich_scene(seed), [](const Scene&) { return true; });
    EXPECT_TRUE(simpler_scenes(least).empty()) << corpus::write_scene(least);
    EXPECT_EQ(triangles_of(least), 0u);
    EXPECT_EQ(least.width, 1);
    EXPECT_EQ(least.height, 1);
    EXPECT_EQ(least.samples, 1);
  }
}

// Chains of arbitrary choices end, too: no cycle is possible.
TEST(Reduce, EndsWhateverIsChosen) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Scene scene = rich_scene(seed);
    for (int steps = 0;; ++steps) {
      ASSERT_LT(steps, 20000);
      std::vector<Scene> simpler = simpler_scenes(scene);
      if (simpler.empty()) break;
      // The last candidates are the most timid ones.
      const auto tail = std::min<std::size_t>(simpler.size(), 8);
      scene = simpler[simpler.size() - 1 - random.below(static_cast<std::uint32_t>(tail))];
    }
  }
}

TEST(Reduce, KeepsTheOneTriangleThatMatters) {
  Scene scene;
  scene.width = 40;
  scene.height = 30;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.cull = Cull::back;
  draw.depth_mode = DepthMode::clip;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(i % 40), y = static_cast<float>(i / 40 % 30);
    draw.vertices.push_back({x, y, 0.25f, 1, {}});
    draw.vertices.push_back({x + 1.75f, y, 0.25f, 1, {}});
    draw.vertices.push_back({x, y + 1.75f, 0.25f, 1, {}});
    draw.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, std::nullopt});
  }
  draw.vertices[3 * 1234].z = 0.7109375f;
  // Fails as long as something stands at that depth: one vertex is to blame.
  std::size_t asked = 0;
  const auto fails = [&asked](const Scene& simpler) {
    ++asked;
    for (const auto& d : simpler.draws) {
      for (const auto& triangle : d.triangles) {
        for (const std::uint32_t v : triangle.vertices) {
          if (d.vertices[v].z == 0.7109375f) return true;
        }
      }
    }
    return false;
  };
  ASSERT_TRUE(fails(scene));
  const Scene least = reduce(scene, fails);
  ASSERT_EQ(triangles_of(least), 1u);
  EXPECT_EQ(least.draws[0].vertices.size(), 3u);
  EXPECT_EQ(least.draws[0].cull, Cull::none);
  EXPECT_EQ(least.draws[0].depth_mode, DepthMode::none);
  EXPECT_EQ(least.width * least.height, 1);
  EXPECT_LT(asked, 2000u);  // not one by one
  for (const auto& vertex : least.draws[0].vertices) {
    for (const float number : {vertex.x, vertex.y, vertex.w}) EXPECT_EQ(number, 0);
  }
}

// A rasterizer with the fill rule turned around is found on a shared edge, and by one triangle.
TEST(Reduce, MakesAFillRuleFaultReadable) {
  const Renderer wrong = [](const Target& target, std::span<const Draw> draws) {
    std::vector<Draw> turned(draws.begin(), draws.end());
    for (Draw& draw : turned) draw.fill_rule = FillRule::bottom_right;
    return surefill::render(target, turned);
  };
  const auto all = categories();
  const auto category =
      std::find_if(all.begin(), all.end(), [](const Category& c) { return std::string(c.name) == "vertex-on-sample"; });
  ASSERT_NE(category, all.end());
  const auto fails = [&wrong](const Scene& simpler) {
    return compare(simpler, oracle_renderer(), wrong, {}, 0).differences > 0;
  };
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene = random_scene(*category, seed);
    if (!fails(scene)) continue;
    ++found;
    const Scene least = reduce(scene, fails);
    EXPECT_TRUE(fails(least));
    EXPECT_LE(triangles_of(least), 1u) << corpus::write_scene(least);
    EXPECT_LE(least.width * least.height, 4) << corpus::write_scene(least);
  }
  EXPECT_GT(found, 10);
}

TEST(Reduce, StopsInTime) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = rich_scene(7);
  const Scene least = reduce(scene, [](const Scene&) { return true; }, {std::chrono::milliseconds(0)});
  EXPECT_TRUE(corpus::equal(scene, least));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(Compare, SeesEveryOutput) {
  Scene scene;
  scene.width = 2;
  scene.attributes.push_back({"colour", 2, Interpolation::perspective});
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices = {{0, 0, 0.5f, 1, {1, 2}}, {4, 0, 0.5f, 1, {3, 4}}, {0, 4, 0.5f, 1, {5, 6}}};
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  const auto spoiled = [](int output) {
    return Renderer([output](const Target& target, std::span<const Draw> draws) {
      const Status status = surefill::render(target, draws);
      if (output == 0) target.count[1] += 1;
      if (output == 1) target.index[1] = 9;
      if (output == 2) target.depth[1] = 0;
      if (output == 3) target.barycentrics[4] += 1;
      if (output == 4) target.attributes[0].values[3] = -target.attributes[0].values[3];
      return output == 5 ? Status::out_of_memory : status;
    });
  };
  EXPECT_EQ(compare(scene, oracle_renderer(), engine_renderer()).differences, 0u);
  const std::set<std::string> outputs{"count", "index", "depth", "barycentrics", "colour", "status"};
  std::set<std::string> seen;
  for (int output = 0; output < 6; ++output) {
    const Comparison comparison = compare(scene, oracle_renderer(), spoiled(output));
    EXPECT_EQ(comparison.differences, 1u) << output;
    ASSERT_EQ(comparison.first.size(), 1u) << output;
    seen.insert(comparison.first[0].output);
    EXPECT_EQ(comparison.first[0].x, output < 5 ? 1 : 0);
  }
  EXPECT_EQ(seen, outputs);
}

}  // namespace
}  // namespace surefill::properties
