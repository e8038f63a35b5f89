// SPDX-License-Identifier: Apache-2.0
//
// Frames in every mode against both oracles: origin (S6), sample places (S7), layers (V4), winding (M9), numbers of
// triangles (M10), the four depth tests (V5), bias (I8), overlap and touched pixels with their index (M4a to M4c).
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "corpus/outputs.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

#ifndef SUREFILL_CASES_SHARE
#define SUREFILL_CASES_SHARE 1
#endif

namespace surefill::properties {
namespace {

constexpr std::uint64_t kScenes = 200 / SUREFILL_CASES_SHARE;  // of each category

Renderer with(const Options& options) {
  return
      [options](const Target& target, std::span<const Draw> draws) { return render(target, draws, nullptr, options); };
}

void expect_equal(const Renderer& expected, const Renderer& actual, const std::string& who) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
      const corpus::Scene scene = modes_scene(category, seed, 9, 6);
      const Comparison result = compare(scene, expected, actual);
      ASSERT_EQ(result.differences, 0u) << who << ", " << category.name << ", seed " << seed << ": "
                                        << describe(result.first.front(), scene.samples) << '\n'
                                        << corpus::write_scene(scene);
    }
  }
}

TEST(Modes, TheReferencePathIsTheOracle) {
  expect_equal(oracle_renderer(), with({.path = Path::reference}), "reference path");
}

TEST(Modes, TheReferencePathIsTheSecondOracle) {
  expect_equal(clipped_oracle_renderer(), with({.path = Path::reference}), "reference path");
}

TEST(Modes, BothPathsAreOne) {
  expect_equal(with({.path = Path::reference}), with({}), "automatic");
  expect_equal(with({.path = Path::reference}), with({.threads = 2}), "two threads");
}

// T9: two halves of a picture agree with the whole, at a far origin too.
TEST(Modes, TilesAgree) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < kScenes / 2; ++seed) {
      corpus::Scene scene = modes_scene(category, seed, 12, 6);
      for (corpus::SceneDraw& draw : scene.draws) draw.grid.reset();  // whose guard band moves with the target
      scene.more.numbers = false;                                     // they speak of the frame
      if (scene.width < 2 || scene.initial_depth.size() > 1 || scene.origin.x == kMaxOrigin) continue;
      corpus::Scene right = scene;
      const int cut = scene.width / 2;
      right.width -= cut, right.origin.x += cut;
      corpus::Frame whole(scene, outputs_of(scene)), part(right, outputs_of(right));
      ASSERT_EQ(render(whole.target(), whole.draws()), Status::ok);
      ASSERT_EQ(render(part.target(), part.draws()), Status::ok);
      const auto at = [&](const corpus::Scene& of, int layer, int y, int x, int n) {
        return ((static_cast<std::size_t>(layer * of.height + y) * static_cast<std::size_t>(of.width)) +
                static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(of.samples) +
               static_cast<std::size_t>(n);
      };
      corpus::for_each_output([&](const auto& output) {
        const auto &all = whole.image().*output.image, &some = part.image().*output.image;
        for (int layer = 0; !all.empty() && layer < (output.layered ? scene.layers : 1); ++layer)
          for (int y = 0; y < scene.height; ++y)
            for (int x = 0; x < right.width; ++x)
              for (int n = 0; n < scene.samples; ++n)
                for (std::size_t e = 0; e < output.elements; ++e) {
                  const std::size_t i = at(scene, layer, y, x + cut, n) * output.elements + e;
                  const std::size_t j = at(right, layer, y, x, n) * output.elements + e;
                  // Initial depths may be NaNs.
                  ASSERT_TRUE(all[i] == some[j] || (all[i] != all[i] && some[j] != some[j]))
                      << output.name << " " << x << " " << y << '\n'
                      << corpus::write_scene(scene);
                }
      });
    }
  }
}

}  // namespace
}  // namespace surefill::properties
