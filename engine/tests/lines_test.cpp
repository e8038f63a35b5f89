// SPDX-License-Identifier: Apache-2.0
//
// Lines and points (M7, I6, I7) against both oracles, in every mode that they may have, and the paths against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

#ifndef SUREFILL_CASES_SHARE
#define SUREFILL_CASES_SHARE 1
#endif

namespace surefill::properties {
namespace {

Renderer with(const Options& options) {
  return
      [options](const Target& target, std::span<const Draw> draws) { return render(target, draws, nullptr, options); };
}

void expect_equal(const Renderer& expected, const Renderer& actual, std::uint64_t scenes, int size) {
  std::uint64_t samples = 0;
  for (const LineCategory& category : line_categories()) {
    for (std::uint64_t seed = 0; seed < scenes / SUREFILL_CASES_SHARE; ++seed) {
      const corpus::Scene scene = lines_scene(category, seed, size, 8);
      const Comparison result = compare(scene, expected, actual);
      samples += result.samples;
      ASSERT_EQ(result.differences, 0u) << category.name << ", seed " << seed << ": "
                                        << describe(result.first.front(), scene.samples) << '\n'
                                        << corpus::write_scene(scene);
    }
  }
  EXPECT_GT(samples, 0u);
}

TEST(Lines, TheReferencePathIsTheOracle) {
  expect_equal(oracle_renderer(), with({.path = Path::reference}), 300, 9);
}

TEST(Lines, TheReferencePathIsTheSecondOracle) {
  expect_equal(clipped_oracle_renderer(), with({.path = Path::reference}), 300, 9);
}

TEST(Lines, BothPathsAreOne) {
  expect_equal(with({.path = Path::reference}), with({}), 600, 40);
  expect_equal(with({.path = Path::reference}), with({.threads = 3}), 200, 200);
}

// A line ends where the next one begins, so a strip covers each sample once where it turns by less than a right angle and
// the major axis stays.
TEST(Lines, AThinStripHitsEachSampleOnce) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::uint64_t state = seed;
    const auto next = [&state] {
      return static_cast<int>((state = state * 6364136223846793005u + 1442695040888963407u) >> 33);
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    float y = 16;
    for (std::uint32_t i = 0; i < 12; ++i) {
      vertices.push_back({static_cast<float>(i) * 2.75F - 0.5F, y, 0.5F, 1});
      y += static_cast<float>(next() % 353 - 176) / 64;  // a slope of less than 1
      if (i > 0) indices.insert(indices.end(), {i - 1, i});
    }
    std::vector<std::uint32_t> count(32 * 32);
    Target target;
    target.width = 32, target.height = 32;
    target.count = count;
    Draw draw;
    draw.vertices = vertices, draw.indices = indices, draw.primitive = Primitive::lines;
    ASSERT_EQ(render(target, {&draw, 1}), Status::ok);
    std::uint32_t total = 0;
    for (const std::uint32_t n : count) {
      ASSERT_LE(n, 1u) << "seed " << seed;
      total += n;
    }
    EXPECT_GE(total, 20u);
  }
}

TEST(Lines, PointsTileThePlane) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices, count(16 * 16);
  for (int i = 0; i < 8 * 8; ++i) {
    indices.push_back(static_cast<std::uint32_t>(i));
    vertices.push_back({static_cast<float>(2 * (i % 8)) + 0.5F, static_cast<float>(2 * (i / 8)) + 0.5F, 0, 1});
  }
  Target target;
  target.width = 16, target.height = 16;
  target.count = count;
  Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.primitive = Primitive::points, draw.width = 2.0F;
  for (int rule = 0; rule < 8; ++rule) {
    draw.fill_rule = static_cast<FillRule>(rule);
    ASSERT_EQ(render(target, {&draw, 1}), Status::ok);
    for (int y = 1; y < 14; ++y)
      for (int x = 1; x < 14; ++x) ASSERT_EQ(count[static_cast<std::size_t>(16 * y + x)], 1u) << rule;
  }
}

TEST(Lines, WhatTheyMayNotHaveIsRefused) {
  const std::vector<Vertex> vertices = {{1, 1, 0, 1}, {6, 3, 0, 1}};
  const std::vector<std::uint32_t> indices = {0, 1};
  std::vector<std::uint32_t> count(64 * 4);
  Target target;
  target.width = 8, target.height = 8;
  target.count = std::span(count).first(64);
  Draw line;
  line.vertices = vertices, line.indices = indices, line.primitive = Primitive::lines;
  const auto refusal = [&](const auto& change) {
    Draw draw = line;
    change(draw);
    return validate(target, {&draw, 1});
  };
  EXPECT_EQ(refusal([](Draw&) {}), Status::ok);
  EXPECT_EQ(refusal([](Draw& d) { d.primitive = static_cast<Primitive>(3); }), Status::draw_primitive);
  EXPECT_EQ(refusal([](Draw& d) { d.width = 0.0F; }), Status::draw_width);
  EXPECT_EQ(refusal([](Draw& d) { d.width = INFINITY; }), Status::draw_width);
  EXPECT_EQ(refusal([](Draw& d) { d.grid.emplace(); }), Status::draw_grid);
  EXPECT_EQ(refusal([](Draw& d) { d.fill_rule = FillRule::closed; }), Status::draw_fill_rule);
  EXPECT_EQ(refusal([](Draw& d) { d.conservative = Conservative::over; }), Status::draw_conservative);
  EXPECT_EQ(refusal([](Draw& d) { d.depth_bias.emplace(); }), Status::draw_depth_bias);
  EXPECT_EQ(refusal([&](Draw& d) { d.indices = std::span(indices).first(1); }), Status::draw_indices);
  EXPECT_EQ(refusal([](Draw& d) { d.primitive = Primitive::triangles; }), Status::draw_indices);
  target.samples = 4, target.count = count;
  EXPECT_EQ(refusal([](Draw&) {}), Status::draw_width);
  EXPECT_EQ(refusal([](Draw& d) { d.width = 1.0F; }), Status::ok);
}

TEST(Lines, StatisticsTellWhatCoversNothing) {
  const std::vector<Vertex> vertices = {{1, 1, 0, 1}, {2, 2, 0, 2}, {6, 3, 0, -1}, {5, 5, 0, 0}, {NAN, 0, 0, 1}};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 0, 2, 0, 4};
  std::vector<std::uint32_t> count(64);
  Target target;
  target.width = 8, target.height = 8;
  target.count = count;
  Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.primitive = Primitive::lines, draw.cull = Cull::front;
  Statistics statistics;
  ASSERT_EQ(render(target, {&draw, 1}, &statistics), Status::ok);
  EXPECT_EQ(statistics, (Statistics{.dropped = 1, .degenerate = 2, .culled = 0, .rasterized = 1}));
  draw.primitive = Primitive::points;
  ASSERT_EQ(render(target, {&draw, 1}, &statistics), Status::ok);
  EXPECT_EQ(statistics, (Statistics{.dropped = 1, .degenerate = 3, .culled = 0, .rasterized = 4}));
}

}  // namespace
}  // namespace surefill::properties
