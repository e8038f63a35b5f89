// SPDX-License-Identifier: Apache-2.0
//
// Statistics are those of M11, counted here in rationals, and depend on nothing but the draws.
#include <gtest/gtest.h>

#include <vector>

#include "corpus/scene.hpp"
#include "engine/tests/statistics_in_rationals.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

namespace surefill::properties {
namespace {

TEST(Statistics, AreThoseOfM11) {
  Statistics all;
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const corpus::Scene scene = mixed_scene(category, seed, 24, 6);
      corpus::Frame frame(scene, outputs_of(scene));
      const Statistics expected = statistics_in_rationals(frame.draws());
      for (const Options& options : {Options{}, Options{.threads = 3}, Options{.path = Path::reference}}) {
        Statistics actual;
        ASSERT_EQ(render(frame.target(), frame.draws(), &actual, options), Status::ok);
        ASSERT_EQ(actual, expected) << category.name << ", seed " << seed << '\n' << corpus::write_scene(scene);
      }
      all.dropped += expected.dropped, all.degenerate += expected.degenerate;
      all.culled += expected.culled, all.rasterized += expected.rasterized;
    }
  }
  for (const std::uint64_t some : {all.dropped, all.degenerate, all.culled, all.rasterized}) EXPECT_GT(some, 100u);
}

// Points and lines among the draws.
TEST(Statistics, OfPointsAndLines) {
  Statistics all;
  for (const LineCategory& category : line_categories()) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const corpus::Scene scene = lines_scene(category, seed, 8, 6);
      corpus::Frame frame(scene);
      const Statistics expected = statistics_in_rationals(frame.draws());
      for (const Options& options : {Options{}, Options{.path = Path::reference}}) {
        Statistics actual;
        ASSERT_EQ(render(frame.target(), frame.draws(), &actual, options), Status::ok);
        ASSERT_EQ(actual, expected) << category.name << ", seed " << seed << '\n' << corpus::write_scene(scene);
      }
      all.dropped += expected.dropped, all.degenerate += expected.degenerate;
      all.culled += expected.culled, all.rasterized += expected.rasterized;
    }
  }
  for (const std::uint64_t some : {all.dropped, all.degenerate, all.culled, all.rasterized}) EXPECT_GT(some, 20u);
}

// Neither the target's size, samples and outputs nor scissor, depth mode and culling box have a part in them.
TEST(Statistics, TellOfTheDrawsAlone) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      corpus::Scene scene = mixed_scene(category, seed, 24, 6);
      corpus::Frame frame(scene, outputs_of(scene));
      Statistics expected, actual;
      ASSERT_EQ(render(frame.target(), frame.draws(), &expected), Status::ok);
      std::vector<Draw> draws(frame.draws().begin(), frame.draws().end());
      for (Draw& draw : draws) {
        draw.scissor = Scissor{3, 4, 5, 6};
        draw.depth_mode = draw.conservative == Conservative::none ? DepthMode::clip : DepthMode::none;
        draw.culling_box.emplace().fill({-1, -1, 0, 1});  // it may lie about where triangles are: counted they are
      }
      Target other;
      other.width = 7, other.height = 3;
      ASSERT_EQ(render(other, draws, &actual), Status::ok);
      EXPECT_EQ(actual, expected) << category.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace surefill::properties
