// SPDX-License-Identifier: Apache-2.0
//
// C5 of docs/semantics.md, the fill rules closed and open: both oracles against images worked out by hand, against
// integers, and against each other.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "oracle/oracle.hpp"

namespace surefill {
namespace {

constexpr FillRule kEightRules[] = {FillRule::top_left,     FillRule::top_right,      FillRule::bottom_left,
                                    FillRule::bottom_right, FillRule::southwards,     FillRule::southwards_west,
                                    FillRule::northwards,   FillRule::northwards_west};
using Render = void (*)(const Target&, std::span<const Draw>, int);
constexpr Render kOracles[] = {oracle::render, oracle::clipped::render};
constexpr const char* kOracleNames[] = {"the first oracle", "the second oracle"};

// An image with every output and two attributes, perspective and noperspective, of which each vertex has a value.
struct Image {
  Target target;
  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, barycentrics, values[2];
  std::array<AttributeTarget, 2> attribute_targets;

  Image(int width, int height, int samples, bool count_only = false) {
    const auto total =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(samples);
    target.width = width, target.height = height, target.samples = samples;
    count.assign(total, 99);
    target.count = count;
    if (count_only) return;
    index.assign(total, 99), depth.assign(total, 99), barycentrics.assign(3 * total, 99);
    for (std::size_t k = 0; k < 2; ++k) {
      values[k].assign(total, 99);
      attribute_targets[k].values = values[k];
    }
    target.index = index, target.depth = depth, target.barycentrics = barycentrics;
    target.attributes = attribute_targets;
  }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
};

// Triangles of three vertices each, in order.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<float> values;
  std::array<AttributeArray, 2> arrays;
  Draw state;

  explicit Mesh(std::vector<Vertex> v, std::vector<float> u = {}) : vertices(std::move(v)), values(std::move(u)) {
    for (std::uint32_t i = 0; i < vertices.size(); ++i) indices.push_back(i);
    values.resize(vertices.size());
    arrays[0].values = arrays[1].values = values;
    arrays[1].interpolation = Interpolation::noperspective;
  }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;
  Draw draw(FillRule rule) const {
    Draw result = state;
    result.vertices = vertices, result.indices = indices, result.attributes = arrays;
    result.fill_rule = rule;
    return result;
  }
};

std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> result;
  for (const float value : values) result.push_back(std::bit_cast<std::uint32_t>(value));
  return result;
}

// Rows of counts, '/' between them and '.' for 0.
std::string counts(const Mesh& mesh, FillRule rule, Render render, int width, int height, int samples = 1) {
  Image image(width, height, samples, true);
  const Draw draw = mesh.draw(rule);
  render(image.target, {&draw, 1}, 1);
  std::string text;
  for (std::size_t i = 0; i < image.count.size(); ++i) {
    if (i > 0 && i % static_cast<std::size_t>(width * samples) == 0) text += '/';
    text += image.count[i] == 0 ? '.' : static_cast<char>('0' + image.count[i]);
  }
  return text;
}

TEST(ClosedOpen, ByHand) {
  const Vertex a{0.5f, 0.5f, 0, 1}, b{7, 1, 0, 2},
      c{0.5f, 3.5f, 0, 1};  // (0, 0), (3, 0), (0, 3) of the lattice of samples
  // The eye lies behind the third vertex's plane: the region under (1.5, 0.5), (3.5, 0.5) that widens downwards, its
  // sides through (0.5, 2.5) and (4.5, 2.5).
  const Vertex d{1.5f, 0.5f, 0, 1}, e{3.5f, 0.5f, 0, 1}, f{-2.5f, 1.5f, 0, -1};
  const Vertex minus_a{-0.5f, -0.5f, 0, -1}, minus_b{-7, -1, 0, -2}, minus_c{-0.5f, -3.5f, 0, -1};
  for (const Render oracle : kOracles) {
    for (const bool turned : {false, true}) {
      Mesh mesh(turned ? std::vector{c, b, a} : std::vector{a, b, c});
      EXPECT_EQ(counts(mesh, FillRule::closed, oracle, 4, 4), "1111/111./11../1...");
      EXPECT_EQ(counts(mesh, FillRule::open, oracle, 4, 4), "..../.1../..../....");
      mesh.state.cull = turned ? Cull::front : Cull::back;  // not this one
      EXPECT_EQ(counts(mesh, FillRule::closed, oracle, 4, 4), "1111/111./11../1...");
      mesh.state.cull = turned ? Cull::back : Cull::front;
      EXPECT_EQ(counts(mesh, FillRule::closed, oracle, 4, 4), "..../..../..../....");
      const Mesh behind(turned ? std::vector{f, e, d} : std::vector{d, e, f});
      EXPECT_EQ(counts(behind, FillRule::closed, oracle, 5, 3), ".111./.111./11111");
      EXPECT_EQ(counts(behind, FillRule::open, oracle, 5, 3), "...../.111./.111.");
    }
    for (const FillRule rule : {FillRule::closed, FillRule::open}) {
      EXPECT_EQ(counts(Mesh({minus_a, minus_b, minus_c}), rule, oracle, 4, 4), "..../..../..../....");
      EXPECT_EQ(counts(Mesh({a, a, c}), rule, oracle, 4, 4), "..../..../..../....");  // D = 0
      EXPECT_EQ(counts(Mesh({a, b, {3.5f, 0.5f, 0, 1}}), rule, oracle, 4, 4), "..../..../..../....");
    }
    // Two halves of a square: closed, the diagonal belongs to both, and open, to neither.
    const Vertex g{2.5f, 0.5f, 0, 1}, h{2.5f, 2.5f, 0, 1}, i{0.5f, 2.5f, 0, 1};
    const Mesh square({a, g, h, a, h, i});
    EXPECT_EQ(counts(square, FillRule::closed, oracle, 4, 4), "211./121./112./....");
    EXPECT_EQ(counts(square, FillRule::open, oracle, 4, 4), "..../..../..../....");
  }
}

// M1 with the rule in C3's place: of the pixel's samples (0.75, 0.75) and (0.25, 0.25) and its centre the triangle's
// left side x = 0.5 meets the centre.
TEST(ClosedOpen, Centroid) {
  const Mesh mesh({{0.5f, -4, 0, 1}, {10, 0.5f, 0, 1}, {0.5f, 6, 0, 1}}, {0.5f, 10, 0.5f});  // the attribute is x
  for (const Render oracle : kOracles) {
    for (const FillRule rule : {FillRule::closed, FillRule::open}) {
      Image image(1, 1, 2);
      image.target.attribute_location = AttributeLocation::centroid;
      const Draw draw = mesh.draw(rule);
      oracle(image.target, {&draw, 1}, 1);
      EXPECT_EQ(image.count, (std::vector<std::uint32_t>{1, 0}));
      EXPECT_EQ(image.values[0][0], rule == FillRule::closed ? 0.5f : 0.75f);
      EXPECT_EQ(image.values[1][0], image.values[0][0]);
    }
  }
}

// Exhaustive over the 12^3 triangles of a lattice of 4 x 3 samples, each in its own square of 4 x 4 pixels: integers
// tell what C5 covers, and the eight rules lie between open and closed.
TEST(ClosedOpen, LatticeOfSamples) {
  constexpr int kSide = 4, kPoints = kSide * (kSide - 1), kAcross = 42, kWidth = kSide * kAcross;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> closed(kWidth * kWidth), open(kWidth * kWidth);
  for (int t = 0; t < kPoints * kPoints * kPoints; ++t) {
    const int left = t % kAcross * kSide, top = t / kAcross * kSide;
    const std::array<int, 3> corner = {t % kPoints, t / kPoints % kPoints, t / kPoints / kPoints};
    std::array<int, 3> x{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = corner[i] % kSide, y[i] = corner[i] / kSide;
      const float w = static_cast<float>(1 << i);  // of no consequence (T4)
      vertices.push_back(
          {w * (static_cast<float>(left + x[i]) + 0.5f), w * (static_cast<float>(top + y[i]) + 0.5f), 0, w});
    }
    const int area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    for (int py = 0; py < kSide; ++py) {
      for (int px = 0; px < kSide; ++px) {
        bool no_negative = area != 0, all_positive = area != 0;
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t j = (i + 1) % 3;
          const int side = area * ((x[j] - x[i]) * (py - y[i]) - (y[j] - y[i]) * (px - x[i]));
          no_negative = no_negative && side >= 0, all_positive = all_positive && side > 0;
        }
        const auto place = static_cast<std::size_t>((top + py) * kWidth + left + px);
        closed[place] = no_negative, open[place] = all_positive;
      }
    }
  }
  const Mesh mesh(std::move(vertices));
  for (std::size_t n = 0; n < 2; ++n) {
    const auto drawn = [&](FillRule rule) {
      Image image(kWidth, kWidth, 1, true);
      const Draw draw = mesh.draw(rule);
      kOracles[n](image.target, {&draw, 1}, 1);
      return image.count;
    };
    EXPECT_EQ(drawn(FillRule::closed), closed) << kOracleNames[n];
    EXPECT_EQ(drawn(FillRule::open), open) << kOracleNames[n];
    for (const FillRule rule : kEightRules) {
      const std::vector<std::uint32_t> count = drawn(rule);
      for (std::size_t s = 0; s < count.size(); ++s) {
        ASSERT_TRUE(open[s] <= count[s] && count[s] <= closed[s]) << kOracleNames[n] << " sample " << s;
      }
    }
  }
}

// Sampled: 400 frames, seed 5. Vertices on every side of the eye, sides and corners on samples, every sample pattern:
// the oracles agree in every bit of every output.
TEST(ClosedOpen, OraclesAgree) {
  std::mt19937 random(5);
  const auto below = [&random](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  int differ = 0;  // samples that closed covers and open does not
  for (int frame = 0; frame < 400; ++frame) {
    constexpr float kW[] = {1, 1, 2, 0.5f, -1, -2, 0};
    const int samples = 1 << below(5), unit = below(2) == 0 ? 2 : 16;  // corners on half pixels, or on sixteenths
    std::vector<Vertex> vertices;
    std::vector<float> values;
    for (int v = 0; v < 18; ++v) {
      const float w = kW[below(7)], scale = w == 0 ? 1 : w;
      const float x = static_cast<float>(below(8 * unit) - unit) / static_cast<float>(unit),
                  y = static_cast<float>(below(7 * unit) - unit) / static_cast<float>(unit);
      vertices.push_back({scale * x, scale * y, static_cast<float>(below(9)) / 8, w});
      values.push_back(static_cast<float>(below(100)));
    }
    Mesh mesh(std::move(vertices), std::move(values));
    mesh.state.cull = static_cast<Cull>(below(3));
    mesh.state.depth_mode = static_cast<DepthMode>(below(3));
    const auto location = static_cast<AttributeLocation>(below(2));
    std::array<std::vector<std::uint32_t>, 2> first_counts;
    for (const FillRule rule : {FillRule::closed, FillRule::open}) {
      Image first(6, 5, samples), second(6, 5, samples);
      const Draw draw = mesh.draw(rule);
      for (Image* image : {&first, &second}) image->target.attribute_location = location;
      oracle::render(first.target, {&draw, 1}, 1);
      oracle::clipped::render(second.target, {&draw, 1}, 1);
      ASSERT_EQ(first.count, second.count) << "frame " << frame;
      ASSERT_EQ(first.index, second.index) << "frame " << frame;
      ASSERT_EQ(bits(first.depth), bits(second.depth)) << "frame " << frame;
      ASSERT_EQ(bits(first.barycentrics), bits(second.barycentrics)) << "frame " << frame;
      for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_EQ(bits(first.values[k]), bits(second.values[k])) << "frame " << frame;
      }
      first_counts[rule == FillRule::open ? 1 : 0] = first.count;
    }
    for (std::size_t s = 0; s < first_counts[0].size(); ++s) {
      ASSERT_LE(first_counts[1][s], first_counts[0][s]);
      differ += first_counts[1][s] < first_counts[0][s] ? 1 : 0;
    }
  }
  EXPECT_GT(differ, 500);
}

}  // namespace
}  // namespace surefill
