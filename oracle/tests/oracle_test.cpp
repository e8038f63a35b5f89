// SPDX-License-Identifier: Apache-2.0
//
// The first oracle against images worked out by hand, rule by rule of docs/semantics.md.
#include "oracle/oracle.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace surefill {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kTiny = std::numeric_limits<float>::denorm_min();
constexpr float kUlp = std::numeric_limits<float>::epsilon();  // of 1

using Rows = std::vector<std::string>;

// Triangles of three vertices each, in order, and the state they are drawn with.
struct TestDraw {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices, identifiers;
  std::vector<std::vector<float>> values;
  std::vector<AttributeArray> attributes;
  Draw state;

  TestDraw(std::initializer_list<Vertex> v) : vertices(v), indices(v.size()) {
    std::iota(indices.begin(), indices.end(), 0u);
  }
  void attribute(std::vector<float> v, Interpolation interpolation = Interpolation::perspective) {
    values.push_back(std::move(v));
    attributes.push_back({{}, 1, 0, interpolation});
  }
  Draw draw() {
    for (std::size_t k = 0; k < values.size(); ++k) attributes[k].values = values[k];
    Draw result = state;
    result.vertices = vertices, result.indices = indices, result.identifiers = identifiers;
    result.attributes = attributes;
    return result;
  }
};

struct Picture {
  Target target;
  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, barycentrics, attribute, initial;
  AttributeTarget attribute_target;

  Picture(int width, int height, int samples = 1, bool with_attribute = false) {
    const std::size_t total = static_cast<std::size_t>(width * height * samples);
    count.assign(total, 77), index.assign(total, 77), depth.assign(total, kNaN), barycentrics.assign(3 * total, kNaN);
    target.width = width, target.height = height, target.samples = samples;
    target.count = count, target.index = index, target.depth = depth, target.barycentrics = barycentrics;
    if (!with_attribute) return;
    attribute.assign(total, kNaN);
    attribute_target = {attribute, 1};
    target.attributes = std::span(&attribute_target, 1);
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  void count_only() { target.index = {}, target.depth = {}, target.barycentrics = {}; }
  void start_from(std::vector<float> values) {
    initial = std::move(values);
    target.initial_depth = initial;
  }
  void render(std::vector<Draw> draws, int threads = 1) { oracle::render(target, draws, threads); }
  void render(TestDraw& batch) { render({batch.draw()}); }

  // The counts, a row of pixels each: '.' for 0.
  Rows rows() const {
    Rows result;
    for (int y = 0; y < target.height; ++y) {
      std::string row;
      for (int n = 0; n < target.width * target.samples; ++n) {
        const std::uint32_t c = count[static_cast<std::size_t>(y * target.width * target.samples + n)];
        row += c == 0 ? '.' : static_cast<char>('0' + c);
      }
      result.push_back(row);
    }
    return result;
  }
};

Rows counts(TestDraw& batch, int width, int height) {
  Picture picture(width, height);
  picture.count_only();
  picture.render(batch);
  return picture.rows();
}

Vertex scaled(Vertex v, float factor) {
  return {v.x * factor, v.y * factor, v.z * factor, v.w * factor};
}

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

// Covers every sample of small targets; depth and everything else is affine in x alone: f(0) = a, f(8) = b.
TestDraw ramp(float a, float b) {
  return {{-8, -8, 2 * a - b, 1}, {24, -8, 3 * b - 2 * a, 1}, {-8, 24, 2 * a - b, 1}};
}

// The whole target at this depth.
TestDraw flat_triangle(float z) {
  return {{-64, -64, z, 1}, {256, -64, z, 1}, {-64, 256, z, 1}};
}

TEST(Oracle, TiesOfAllFillRules) {
  // C3: the upper half of the square of the samples (0, 0) .. (2, 2), which lie on its border and diagonal.
  const Rows expected[] = {{"11.", ".1.", "..."}, {".11", "..1", "..."}, {"...", ".1.", "..."}, {"...", "..1", "..."},
                           {".1.", "...", "..."}, {".11", "..1", "..."}, {"...", ".1.", "..."}, {"...", ".11", "..1"}};
  for (int rule = 0; rule < 8; ++rule) {
    SCOPED_TRACE(rule);
    const Vertex a{0.5f, 0.5f, 0, 1}, b{2.5f, 0.5f, 0, 1}, c{2.5f, 2.5f, 0, 1}, d{0.5f, 2.5f, 0, 1};
    const Rows& rows = expected[rule];
    TestDraw front{a, b, c}, back{a, c, b}, scales{scaled(a, 0.25f), scaled(b, 1024), scaled(c, 0x1p-140f)},
        square{a, b, c, a, c, d};
    TestDraw behind{scaled(a, -1), scaled(b, -1), scaled(c, -1)};
    for (TestDraw* batch : {&front, &back, &scales, &square, &behind})
      batch->state.fill_rule = static_cast<FillRule>(rule);
    EXPECT_EQ(counts(front, 3, 3), rows);
    EXPECT_EQ(counts(back, 3, 3), rows);
    EXPECT_EQ(counts(scales, 3, 3), rows);
    EXPECT_EQ(counts(behind, 3, 3), (Rows{"...", "...", "..."}));
    const std::string x = rule % 2 == 0 ? "11." : ".11", none = "...";
    const bool south = rule == 0 || rule == 1 || rule == 4 || rule == 5;
    EXPECT_EQ(counts(square, 3, 3), south ? (Rows{x, x, none}) : (Rows{none, x, x}));  // T1
  }
}

TEST(Oracle, VertexBehindTheEyeOrAtInfinity) {
  TestDraw behind{{1, 0, 0, 1}, {3, 0, 0, 1}, {-2, 2, 0, -1}};  // seen: y >= 0, 1 - y/2 <= x <= 3 + y/2
  EXPECT_EQ(counts(behind, 4, 3), (Rows{".11.", "1111", "1111"}));
  TestDraw infinite{{1, 1, 0, 1}, {3, 1, 0, 1}, {0, 1, 0, 0}};  // seen: y >= 1, 1 <= x <= 3
  EXPECT_EQ(counts(infinite, 4, 3), (Rows{"....", ".11.", ".11."}));
}

TEST(Oracle, Octants) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> number(-6, 6);
  for (int round = 0; round < 300; ++round) {
    Vertex v[3];
    for (Vertex& a : v)
      a = {static_cast<float>(number(random)), static_cast<float>(number(random)), 0,
           static_cast<float>(number(random))};
    const float det = v[0].x * (v[1].y * v[2].w - v[1].w * v[2].y) + v[0].y * (v[1].w * v[2].x - v[1].x * v[2].w) +
                      v[0].w * (v[1].x * v[2].y - v[1].y * v[2].x);
    if (det == 0) continue;
    TestDraw batch{};
    for (int octant = 0; octant < 8; ++octant) {
      for (int i = 0; i < 3; ++i) batch.vertices.push_back(scaled(v[i], (octant >> i & 1) != 0 ? -1.0f : 1.0f));
    }
    batch.indices.resize(24);
    std::iota(batch.indices.begin(), batch.indices.end(), 0u);
    batch.state.fill_rule = static_cast<FillRule>(round % 8);
    EXPECT_EQ(counts(batch, 7, 6), Rows(6, "1111111"));
  }
}

TEST(Oracle, CoverageIsItsDefinition) {
  // C1 to C3 as written, in 64-bit integers, sample by sample.
  static constexpr int kStep[8][3] = {{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1},
                                      {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}};
  std::mt19937 random(2);
  std::uniform_int_distribution<int> position(-8, 40), weight(-2, 2);
  for (int round = 0; round < 1000; ++round) {
    std::int64_t m[3][3];
    TestDraw batch{};
    for (auto& v : m) {
      v[2] = weight(random), v[0] = position(random), v[1] = position(random);
      batch.vertices.push_back(
          {static_cast<float>(v[0]) * 0.5f, static_cast<float>(v[1]) * 0.5f, 0, static_cast<float>(v[2])});
    }
    batch.indices = {0, 1, 2};
    const int rule = round % 8;
    batch.state.fill_rule = static_cast<FillRule>(rule);
    Rows expected(20, std::string(20, '.'));
    std::int64_t e[3][3], det = 0;
    for (int i = 0; i < 3; ++i) {
      const auto &j = m[(i + 1) % 3], &k = m[(i + 2) % 3];
      e[i][0] = j[1] * k[2] - j[2] * k[1], e[i][1] = j[2] * k[0] - j[0] * k[2], e[i][2] = j[0] * k[1] - j[1] * k[0];
      det = e[i][0] * m[i][0] + e[i][1] * m[i][1] + e[i][2] * m[i][2];
    }
    for (std::size_t y = 0; y < 20; ++y) {
      for (std::size_t x = 0; x < 20; ++x) {
        bool covered = det != 0;
        for (const auto& edge : e) {
          std::int64_t value = edge[0] * static_cast<int>(2 * x + 1) + edge[1] * static_cast<int>(2 * y + 1) + edge[2];
          const std::int64_t dx = edge[0] * kStep[rule][0], dy = edge[1] * kStep[rule][1];
          if (value == 0) value = kStep[rule][2] == 1 ? (dx != 0 ? dx : dy) : (dy != 0 ? dy : dx);
          covered = covered && (value > 0) == (det > 0) && value != 0;
        }
        if (covered) expected[y][x] = '1';
      }
    }
    EXPECT_EQ(counts(batch, 20, 20), expected) << round;
  }
}

TEST(Oracle, DegenerateAndDropped) {
  const Vertex a{0, 0, 0, 1}, b{8, 0, 0, 1}, c{0, 8, 0, 1};
  TestDraw line{a, b, {4, 0, 0, 1}, a, a, c, {0, 0, 0, 0}, b, c};
  EXPECT_EQ(counts(line, 2, 2), (Rows{"..", ".."}));  // C1
  for (const float bad : {kNaN, kInfinity, -kInfinity}) {
    TestDraw positions{a, b, {0, 8, bad, 1}, a, b, {0, 8, 0, bad}, a, b, {bad, 8, 0, 1}, a, {8, bad, 0, 1}, c, a, b, c};
    EXPECT_EQ(counts(positions, 2, 2), (Rows{"11", "11"}));  // B1, also in Z
    TestDraw attributes{a, b, c, a, b, c};
    attributes.attribute({0, bad, 0, 0, 0, 0});
    EXPECT_EQ(counts(attributes, 2, 2), (Rows{"11", "11"}));  // in an array that is not asked for
  }
}

TEST(Oracle, CullingAndFacing) {
  const Vertex a{0, 0, 0, 1}, b{8, 0, 0, 1}, c{0, 8, 0, 1};
  for (const bool reversed : {false, true}) {
    for (const FrontFace face : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
      for (const Cull cull : {Cull::none, Cull::front, Cull::back}) {
        TestDraw batch = reversed ? TestDraw{a, c, b} : TestDraw{a, b, c};  // D > 0 if not reversed
        batch.state.front_face = face, batch.state.cull = cull;
        const bool front = reversed == (face == FrontFace::counter_clockwise);
        const bool drawn = cull == Cull::none || cull == (front ? Cull::back : Cull::front);
        EXPECT_EQ(counts(batch, 1, 1), Rows{drawn ? "1" : "."});
      }
    }
  }
}

TEST(Oracle, DepthIsRoundedOnce) {
  const auto depths = [](TestDraw batch, DepthMode mode = DepthMode::none) {
    Picture picture(4, 1);
    batch.state.depth_mode = mode;
    picture.render(batch);
    return picture.depth;
  };
  using Depths = std::vector<float>;
  EXPECT_EQ(depths(ramp(1, 1 + 8 * kUlp)), (Depths{1, 1 + 2 * kUlp, 1 + 2 * kUlp, 1 + 4 * kUlp}));  // ties to even
  EXPECT_EQ(depths(ramp(0, 8 * kTiny)), (Depths{0, 2 * kTiny, 2 * kTiny, 4 * kTiny}));
  const Depths negative = depths(ramp(0, -8 * kTiny));
  EXPECT_EQ(negative, (Depths{0, -2 * kTiny, -2 * kTiny, -4 * kTiny}));
  EXPECT_EQ(bits(negative[0]), 0u);  // +0
  EXPECT_EQ(bits(depths(flat_triangle(-0.0f))[0]), 0u);
  for (const float sign : {1.0f, -1.0f}) {  // beyond range
    TestDraw far{{-8, -8, sign * kLargest, 0.5f}, {32, -8, sign * kLargest, 0.5f}, {-8, 32, sign * kLargest, 0.5f}};
    EXPECT_EQ(depths(far)[0], sign * kLargest);
  }
  // A quotient that is no dyadic number.
  EXPECT_EQ(depths({{-8, -8, 1, 3}, {24, -8, 1, 3}, {-8, 24, 1, 3}})[0], 1.0f / 3.0f);
}

TEST(Oracle, DepthClipAndClampAreExact) {
  const auto clip = [](TestDraw batch, int width = 4) {
    batch.state.depth_mode = DepthMode::clip;
    const Rows alone = counts(batch, width, 1);
    Picture picture(width, 1);
    picture.render(batch);
    EXPECT_EQ(picture.rows(), alone);  // the same with and without depth asked for
    return alone[0];
  };
  EXPECT_EQ(clip(ramp(-0.5f, 7.5f)), "11..");              // z = 0, 1, 2, 3
  EXPECT_EQ(clip(ramp(1.5f, -6.5f)), "11..");              // z = 1, 0, -1, -2
  EXPECT_EQ(clip(ramp(1 - kUlp, 1 + kUlp * 15)), "1...");  // 1, 1 + 2 ulp, ...
  EXPECT_EQ(clip(ramp(1, 1 + kUlp)), "....");              // 1 + ulp / 16 rounds to 1, and is beyond
  EXPECT_EQ(clip(ramp(0, -kTiny)), "....");                // rounds to 0, and is before
  TestDraw clamped = ramp(-1.5f, 6.5f);                    // z = -1, 0, 1, 2
  clamped.state.depth_mode = DepthMode::clamp;
  Picture picture(4, 1);
  picture.render(clamped);
  EXPECT_EQ(picture.rows(), Rows{"1111"});
  EXPECT_EQ(picture.depth, (std::vector<float>{0, 0, 1, 1}));
}

TEST(Oracle, VisibilityIsLexicographic) {
  const auto winner = [](std::vector<std::array<float, 2>> ramps, std::vector<std::uint32_t> identifiers,
                         DepthTest test) {
    TestDraw all{};
    for (const auto& [a, b] : ramps) {
      const TestDraw one = ramp(a, b);
      all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
    }
    all.indices.resize(all.vertices.size());
    std::iota(all.indices.begin(), all.indices.end(), 0u);
    all.identifiers = std::move(identifiers);
    all.state.first_index = 100;
    Picture picture(1, 1);
    picture.target.depth_test = test;
    picture.render(all);
    return picture.index[0];
  };
  EXPECT_EQ(winner({{1, 1}, {0, 0}, {2, 2}}, {}, DepthTest::less), 101u);
  EXPECT_EQ(winner({{1, 1}, {0, 0}, {2, 2}}, {}, DepthTest::greater), 102u);
  EXPECT_EQ(winner({{1, 1}, {1, 1}}, {}, DepthTest::less), 100u);
  EXPECT_EQ(winner({{1, 1}, {1, 1}}, {9, 4}, DepthTest::less), 4u);
  EXPECT_EQ(winner({{1, 1}, {1, 1}}, {9, 4}, DepthTest::greater), 4u);
  EXPECT_EQ(winner({{1, 1}, {1, 1}}, {4, 9}, DepthTest::greater), 4u);
  EXPECT_EQ(winner({{1, 1 + kUlp}, {1, 1}}, {}, DepthTest::less), 100u);  // the stored depths are equal
  EXPECT_EQ(winner({{0, -kTiny}, {0, kTiny}}, {5, 3}, DepthTest::less), 3u);
}

TEST(Oracle, InitialDepthIsBeatenStrictly) {
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    Picture picture(7, 1);
    picture.target.depth_test = test;
    const std::vector<float> initial = {kNaN, 0.5f, 0.25f, 1, kInfinity, -kInfinity, -0.0f};
    picture.start_from(initial);
    TestDraw batch = flat_triangle(0.5f);
    batch.state.first_index = 3;
    picture.render(batch);
    for (std::size_t n = 0; n < 7; ++n) {
      const bool visible = test == DepthTest::less ? 0.5f < initial[n] : 0.5f > initial[n];
      EXPECT_EQ(picture.index[n], visible ? 3u : kNoTriangle) << n;
      EXPECT_EQ(bits(picture.depth[n]), bits(visible ? 0.5f : initial[n])) << n;
      EXPECT_EQ(picture.barycentrics[3 * n] != 0, visible) << n;
      EXPECT_EQ(picture.count[n], 1u);
    }
  }
  Picture zero(1, 1);  // +0 does not beat -0
  zero.start_from({-0.0f});
  TestDraw batch = flat_triangle(0);
  zero.render(batch);
  EXPECT_EQ(zero.index[0], kNoTriangle);
  EXPECT_EQ(bits(zero.depth[0]), bits(-0.0f));
  Picture empty(1, 1);
  empty.target.depth_test = DepthTest::greater;
  empty.render({});
  EXPECT_EQ(empty.depth[0], -kInfinity);
  EXPECT_EQ(empty.index[0], kNoTriangle);
  EXPECT_EQ(empty.count[0], 0u);
  EXPECT_EQ(bits(empty.barycentrics[2]), 0u);
}

TEST(Oracle, DepthWriteOffAndSeveralDraws) {
  TestDraw three = flat_triangle(0.25f), behind = flat_triangle(0.75f), level = flat_triangle(0.5f);
  for (TestDraw* other : {&behind, &level})
    three.vertices.insert(three.vertices.end(), other->vertices.begin(), other->vertices.end());
  three.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  three.state.depth_write = false;
  const auto image = [](std::vector<Draw> draws, std::vector<float> initial) {
    Picture picture(1, 1);
    picture.start_from(std::move(initial));
    picture.render(std::move(draws));
    return std::pair(picture.index[0], picture.depth[0]);
  };
  using Result = std::pair<std::uint32_t, float>;
  EXPECT_EQ(image({three.draw()}, {}), Result(2, kInfinity));     // the last of all
  EXPECT_EQ(image({three.draw()}, {0.5f}), Result(0, 0.5f));      // only 0.25 passes
  EXPECT_EQ(image({three.draw()}, {0.625f}), Result(2, 0.625f));  // 0.25 and 0.5 pass
  three.identifiers = {7, 9, 8};
  EXPECT_EQ(image({three.draw()}, {}), Result(9, kInfinity));  // index order, not position
  EXPECT_EQ(image({three.draw()}, {0.625f}), Result(8, 0.625f));
  level.state.first_index = 20;
  EXPECT_EQ(image({three.draw(), level.draw()}, {}), Result(20, 0.5f));
  EXPECT_EQ(image({level.draw(), three.draw()}, {}), Result(7, 0.5f));  // tested against what the first draw left
  TestDraw again = flat_triangle(0.5f);
  again.state.first_index = 30;
  EXPECT_EQ(image({level.draw(), again.draw()}, {}), Result(20, 0.5f));  // V3: strictly
  Picture picture(1, 1);
  picture.render({level.draw(), again.draw(), three.draw()});
  EXPECT_EQ(picture.count[0], 5u);
}

TEST(Oracle, BarycentricsAndAttributes) {
  // Projected (0, 0), (8, 0), (0, 8) with W = 1, 2, 4: at (1/2, 1/2) the weights are 56, 2 and 1 of 59.
  const auto drawn = [](Interpolation interpolation, std::vector<float> values) {
    TestDraw batch{{0, 0, 0, 1}, {16, 0, 2, 2}, {0, 32, 8, 4}};
    batch.attribute(std::move(values), interpolation);
    Picture picture(1, 1, 1, true);
    picture.render(batch);
    EXPECT_EQ(picture.barycentrics, (std::vector<float>{56.0f / 59.0f, 2.0f / 59.0f, 1.0f / 59.0f}));
    EXPECT_EQ(picture.depth[0], 3.0f / 16.0f);
    return picture.attribute[0];
  };
  EXPECT_EQ(drawn(Interpolation::perspective, {0, 59, 118}), 4);
  EXPECT_EQ(drawn(Interpolation::perspective, {kLargest, kLargest, kLargest}), kLargest);
  EXPECT_EQ(drawn(Interpolation::perspective, {kTiny, kTiny, kTiny}), kTiny);
  EXPECT_EQ(drawn(Interpolation::noperspective, {0, 1, 2}), 3.0f / 16.0f);
  EXPECT_EQ(drawn(Interpolation::noperspective, {0.1f, 0.1f, 0.1f}), 0.1f);
  EXPECT_EQ(drawn(Interpolation::flat, {5, 1, 2}), 5);
  for (const Interpolation interpolation :
       {Interpolation::perspective, Interpolation::noperspective, Interpolation::flat}) {
    EXPECT_EQ(bits(drawn(interpolation, {-0.0f, -0.0f, -0.0f})), 0u);
  }
}

TEST(Oracle, NoperspectiveBeyondRangeIsTheLargest) {
  // One vertex behind the eye: affine values grow without bound.
  TestDraw batch{{0, 0, 0, 1}, {8, 0, 0, 1}, {0, 8, 0, -1}};
  batch.attribute({0, 0, -kLargest}, Interpolation::noperspective);
  Picture picture(1, 20, 1, true);
  picture.render(batch);
  // v2 projects to (0, -8), so the value is largest * y / 8 where y >= 0 is seen.
  EXPECT_EQ(picture.attribute[0], kLargest / 16);
  EXPECT_EQ(picture.attribute[19], kLargest);
}

TEST(Oracle, ScissorAndCullingBox) {
  TestDraw batch = flat_triangle(0);
  batch.state.scissor = Scissor{1, -5, 3, 2};
  EXPECT_EQ(counts(batch, 4, 3), (Rows{".11.", ".11.", "...."}));
  batch.state.culling_box.emplace();  // all corners alike: a broken promise, and ignored
  EXPECT_EQ(counts(batch, 4, 3), (Rows{".11.", ".11.", "...."}));
  batch.state.scissor = Scissor{3, 0, 1, 2};
  EXPECT_EQ(counts(batch, 4, 3), (Rows{"....", "....", "...."}));
}

TEST(Oracle, SamplePatterns) {
  struct Location {
    float x, y;
  };
  const std::vector<Location> patterns[] = {{{8, 8}},
                                            {{12, 12}, {4, 4}},
                                            {{6, 2}, {14, 6}, {2, 10}, {10, 14}},
                                            {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}},
                                            {{9, 9},
                                             {7, 5},
                                             {5, 10},
                                             {12, 7},
                                             {3, 6},
                                             {10, 13},
                                             {13, 11},
                                             {11, 3},
                                             {6, 14},
                                             {8, 1},
                                             {4, 2},
                                             {2, 12},
                                             {0, 8},
                                             {15, 4},
                                             {14, 15},
                                             {1, 0}}};
  for (const auto& pattern : patterns) {
    TestDraw along_x{{-8, -8, -128, 1}, {24, -8, 384, 1}, {-8, 24, -128, 1}};  // z = 16 x
    TestDraw along_y{{-8, -8, -128, 1}, {24, -8, -128, 1}, {-8, 24, 384, 1}};  // z = 16 y
    Picture x(2, 1, static_cast<int>(pattern.size())), y(1, 2, static_cast<int>(pattern.size()));
    x.render(along_x);
    y.render(along_y);
    for (std::size_t n = 0; n < pattern.size(); ++n) {
      EXPECT_EQ(x.depth[n], pattern[n].x);
      EXPECT_EQ(x.depth[pattern.size() + n], 16 + pattern[n].x);
      EXPECT_EQ(y.depth[n], pattern[n].y);
      EXPECT_EQ(y.depth[pattern.size() + n], 16 + pattern[n].y);
    }
  }
}

TEST(Oracle, AttributesOncePerPixel) {
  const auto drawn = [](TestDraw batch, AttributeLocation location, const char* covered) {
    Picture picture(1, 1, 4, true);
    picture.target.attribute_location = location;
    picture.render(batch);
    EXPECT_EQ(picture.rows(), Rows{covered});
    float value = kNaN;
    for (std::size_t n = 0; n < 4; ++n) {
      if (picture.count[n] == 0) {
        EXPECT_EQ(bits(picture.attribute[n]), 0u);
      } else {
        EXPECT_TRUE(std::isnan(value) || value == picture.attribute[n]);
        value = picture.attribute[n];
      }
    }
    return value;
  };
  // Right-angled at (x, y), towards the left and down; the attribute is 16 x.
  const auto corner = [](float x, float y) {
    TestDraw batch{{x, y, 0, 1}, {x, y + 64, 0, 1}, {x - 64, y, 0, 1}};
    batch.attribute({16 * x, 16 * x, 16 * (x - 64)});
    return batch;
  };
  EXPECT_EQ(drawn(corner(0.40625f, -1), AttributeLocation::centre, "1.1."), 8);
  EXPECT_EQ(drawn(corner(0.40625f, -1), AttributeLocation::centroid, "1.1."), 6);
  EXPECT_EQ(drawn(corner(0.40625f, 0.5f), AttributeLocation::centroid, "..1."), 2);
  EXPECT_EQ(drawn(corner(0.75f, -1), AttributeLocation::centroid, "1.11"), 8);
  EXPECT_EQ(drawn(corner(0.5f, -1), AttributeLocation::centroid, "1.1."), 6);  // the centre's tie is lost
  // By coverage alone: samples of smaller number may be hidden.
  {
    TestDraw near{{-64, -64, -1, 1}, {64, -64, -1, 1}, {0.375f, 0.25f, -1, 1}};  // covers sample 0 only
    TestDraw far = corner(0.40625f, -1);
    far.vertices.insert(far.vertices.end(), near.vertices.begin(), near.vertices.end());
    far.indices = {0, 1, 2, 3, 4, 5};
    far.values[0].resize(6, 100.0f);
    Picture picture(1, 1, 4, true);
    picture.target.attribute_location = AttributeLocation::centroid;
    picture.render(far);
    EXPECT_EQ(picture.rows(), Rows{"2.1."});
    EXPECT_EQ(picture.attribute, (std::vector<float>{100, 0, 6, 0}));
  }
  // 1/w = 7/16 - x is negative at the centre, so it can't serve; w at sample 0 is 16.
  TestDraw horizon{{13, -32, 0, 32}, {13, 64, 0, 32}, {-0.5625f, 0.5f, 0, 1}};
  horizon.attribute({32, 32, 1});
  EXPECT_EQ(drawn(horizon, AttributeLocation::centre, "1.1."), 16);
  EXPECT_EQ(drawn(horizon, AttributeLocation::centroid, "1.1."), 16);
}

TEST(Oracle, ConservativeOverAndInner) {
  const auto drawn = [](TestDraw batch, Conservative mode, int width, int height) {
    batch.state.conservative = mode;
    return counts(batch, width, height);
  };
  const TestDraw inside{{1.25f, 1.25f, 0, 1}, {1.75f, 1.25f, 0, 1}, {1.25f, 1.75f, 0, 1}};  // within one pixel
  EXPECT_EQ(drawn(inside, Conservative::over, 3, 3), (Rows{"...", ".1.", "..."}));
  EXPECT_EQ(drawn(inside, Conservative::inner, 3, 3), (Rows{"...", "...", "..."}));
  // A tip that points at pixel (2, 2), whose square no single edge excludes.
  const TestDraw tip{{0, 0.125f, 0, 1}, {0.125f, 0, 0, 1}, {1.875f, 1.875f, 0, 1}};
  EXPECT_EQ(drawn(tip, Conservative::over, 4, 4), (Rows{"11..", "11..", "....", "...."}));
  const TestDraw touching{
      {0, 0.125f, 0, 1}, {0.125f, 0, 0, 1}, {2, 2, 0, 1}};  // closed squares that share one point with T
  EXPECT_EQ(drawn(touching, Conservative::over, 4, 4), (Rows{"11..", "111.", ".11.", "...."}));
  // The needle crosses squares without a corner of either inside the other.
  const TestDraw needle{{-1, 1.5f, 0, 1}, {5, 1.375f, 0, 1}, {5, 1.625f, 0, 1}};
  EXPECT_EQ(drawn(needle, Conservative::over, 4, 3), (Rows{"....", "1111", "...."}));
  const TestDraw square{{1, 1, 0, 1}, {5, 1, 0, 1}, {1, 5, 0, 1}};
  EXPECT_EQ(drawn(square, Conservative::inner, 5, 5), (Rows{".....", ".111.", ".11..", ".1...", "....."}));
  EXPECT_EQ(drawn(square, Conservative::over, 6, 6),
            (Rows{"111111", "111111", "11111.", "1111..", "111...", "11...."}));
  // Seen: y >= 0, 2 - y/2 <= x <= 4 + y/2, a vertex behind the eye.
  const TestDraw behind{{2, 0, 0, 1}, {4, 0, 0, 1}, {-3, 2, 0, -1}};
  EXPECT_EQ(drawn(behind, Conservative::over, 6, 3), (Rows{".1111.", "111111", "111111"}));
  EXPECT_EQ(drawn(behind, Conservative::inner, 6, 3), (Rows{"..11..", "..11..", ".1111."}));
  // Seen: 2 <= x <= 4, y >= 1, a vertex at infinity.
  const TestDraw infinite{{2, 1, 0, 1}, {4, 1, 0, 1}, {0, 1, 0, 0}};
  EXPECT_EQ(drawn(infinite, Conservative::over, 6, 3), (Rows{".1111.", ".1111.", ".1111."}));
  EXPECT_EQ(drawn(infinite, Conservative::inner, 6, 3), (Rows{"......", "..11..", "..11.."}));
  const TestDraw line{{0, 0, 0, 1}, {2, 2, 0, 1}, {4, 4, 0, 1}};
  EXPECT_EQ(drawn(line, Conservative::over, 2, 2), (Rows{"..", ".."}));  // D = 0
}

TestDraw snapped(TestDraw batch, int grid_bits, GridRounding rounding, int offset_x = 0) {
  batch.state.grid = Grid{grid_bits, offset_x, 0, rounding};
  return batch;
}

TEST(Oracle, GridRoundings) {
  // The quadrilateral left <= x <= right, from far above to far below, on whole pixels.
  const auto drawn = [](float left, float right, GridRounding rounding, int offset_x = 0) {
    const Vertex a{left, -10, 0, 1}, b{right, -10, 0, 1}, c{right, 10, 0, 1}, d{left, 10, 0, 1};
    TestDraw batch = snapped({a, b, c, a, c, d}, 0, rounding, offset_x);
    return counts(batch, 6, 1)[0];
  };
  EXPECT_EQ(drawn(1.5f, 4.5f, GridRounding::nearest_even), "..11..");
  EXPECT_EQ(drawn(1.5f, 4.5f, GridRounding::nearest_up), "..111.");
  EXPECT_EQ(drawn(1.5f, 4.5f, GridRounding::truncate), ".111..");
  EXPECT_EQ(drawn(0.5f, 3.5f, GridRounding::nearest_even), "1111..");
  EXPECT_EQ(drawn(0.5f, 3.5f, GridRounding::nearest_up), ".111..");
  EXPECT_EQ(drawn(-0.5f, 0.75f, GridRounding::nearest_even), "1.....");
  EXPECT_EQ(drawn(-1.5f, -0.5f, GridRounding::nearest_up), "......");
  EXPECT_EQ(drawn(-0.875f, 0.875f, GridRounding::truncate), "......");  // both to 0
  EXPECT_EQ(drawn(1, 4.5f, GridRounding::nearest_even, 8), "1111..");   // offset 1/2: 1 goes to 0.5, and owns it
  EXPECT_EQ(drawn(1, 4.5f, GridRounding::nearest_up, 8), ".111..");
  EXPECT_EQ(drawn(1.25f, 4.5f, GridRounding::truncate, 8), "1111..");
  EXPECT_EQ(drawn(0.0f, 4.5f, GridRounding::truncate, 8), "1111..");  // towards zero: k = 0, so 1/2
  // One ulp beside a tie.
  EXPECT_EQ(drawn(1.5f, std::nextafter(4.5f, 5.0f), GridRounding::nearest_even), "..111.");
}

TEST(Oracle, GridOfDegenerateTriangles) {
  // Collinear, but (3, 1.5) goes to (3, 2): N = -1 at two samples.
  TestDraw batch = snapped({{0, 0, 0.75f, 1}, {3, 1.5f, 0.5f, 1}, {6, 3, 0.25f, 1}}, 0, GridRounding::nearest_even);
  batch.attribute({5, 6, 7});
  Picture picture(6, 3, 1, true);
  picture.render(batch);
  EXPECT_EQ(picture.rows(), (Rows{"......", "..1...", "....1."}));
  EXPECT_EQ(picture.depth[8], 0.25f);  // the smallest Z/W of the corners
  EXPECT_EQ(picture.attribute[8], 5);  // vertex 0
  EXPECT_EQ(picture.barycentrics[24], 1);
  EXPECT_EQ(picture.barycentrics[25], 0);
  batch.state.cull = Cull::back;
  EXPECT_EQ(counts(batch, 6, 3), (Rows{"......", "......", "......"}));
  batch.state.cull = Cull::front;
  EXPECT_EQ(counts(batch, 6, 3), (Rows{"......", "..1...", "....1."}));
  // G1: hulls that contain the eye: on a side, at a vertex, and inside.
  TestDraw eye = snapped({{1, 1, 0, 1},
                          {-2, -2, 0, -2},
                          {5, 1, 0, 1},
                          {0, 0, 0, 0},
                          {5, 1, 0, 1},
                          {1, 5, 0, 1},
                          {1, 1, 0, 1},
                          {3, 1, 0, 1},
                          {-4, -2, 0, -2}},
                         0, GridRounding::nearest_even);
  EXPECT_EQ(counts(eye, 6, 3), (Rows{"......", "......", "......"}));
}

TEST(Oracle, GridClampsDepthAndWeights) {
  // Offset 1/2 on whole pixels: x = 0.625 goes to 0.5, so a sample outside the unsnapped triangle is covered.
  TestDraw batch =
      snapped({{0.625f, -8, 0.5f, 1}, {8.5f, -8, 1, 1}, {0.625f, 32, 0.5f, 1}}, 0, GridRounding::nearest_even, 8);
  batch.attribute({3, 100, 3});
  Picture picture(2, 1, 1, true);
  picture.render(batch);
  EXPECT_EQ(picture.rows(), Rows{"11"});
  EXPECT_EQ(picture.depth[0], 0.5f);   // I1 gives less than 0.5 there
  EXPECT_EQ(picture.attribute[0], 3);  // the weight of vertex 1 is negative, and counts as 0
  EXPECT_EQ(picture.barycentrics[1], 0);
  EXPECT_GT(picture.depth[1], 0.5f);
}

TEST(Oracle, GridGuardBand) {
  // The edge y = 2.5 + x / 16385 is cut where x is -16385 and 16385, at y = 1.5 and 3.5, and only then snapped.
  const Vertex a{-32770, 0.5f, 0, 1}, b{32770, 4.5f, 0, 1}, c{0, 1000, 0, 1};
  TestDraw even = snapped({a, b, c}, 0, GridRounding::nearest_even),
           truncate = snapped({a, b, c}, 0, GridRounding::truncate);
  EXPECT_EQ(counts(even, 2, 5), (Rows{"..", "..", "..", "11", "11"}));      // from y = 3 at x = 0
  EXPECT_EQ(counts(truncate, 2, 5), (Rows{"..", "..", "11", "11", "11"}));  // from y = 2
  TestDraw behind = snapped({{1, 0, 0, 1}, {3, 0, 0, 1}, {-2, 2, 0, -1}}, 8, GridRounding::nearest_even);
  EXPECT_EQ(counts(behind, 4, 3), (Rows{".11.", "1111", "1111"}));
  TestDraw infinite = snapped({{1, 1, 0, 1}, {3, 1, 0, 1}, {0, 1, 0, 0}}, 8, GridRounding::nearest_even);
  EXPECT_EQ(counts(infinite, 4, 3), (Rows{"....", ".11.", ".11."}));
}

TEST(Oracle, ViewportMap) {
  const auto map = [](const Viewport& viewport, ClipVertex v) {
    Vertex out{};
    oracle::to_pixel(viewport, std::span(&v, 1), std::span(&out, 1));
    return std::array{out.x, out.y, out.z, out.w};
  };
  using Four = std::array<float, 4>;
  Viewport viewport{10, 20, 8, 4, 0.25f, 0.75f};
  EXPECT_EQ(map(viewport, {1, 1, 0.5f, 2}), (Four{1 * 4 + 2 * 14, -1 * 2 + 2 * 22, 0.5f * 0.5f + 2 * 0.25f, 2}));
  viewport.clip_y = ClipY::down, viewport.clip_depth = ClipDepth::minus_one_to_one;
  EXPECT_EQ(map(viewport, {1, 1, 0.5f, 2}), (Four{32, 46, 0.5f * 0.25f + 2 * 0.5f, 2}));
  viewport = {0, 0, 2, 2, 0, 1};                                          // X = x + w
  EXPECT_EQ(map(viewport, {1, 0, 0, kUlp / 2})[0], 1);                    // a tie, to even
  EXPECT_EQ(map(viewport, {1 + kUlp, 0, 0, kUlp / 2})[0], 1 + 2 * kUlp);  // a tie, to even
  EXPECT_EQ(map(viewport, {1, 0, 0, kUlp})[0], 1 + kUlp);
  EXPECT_EQ(map(viewport, {kLargest, 0, 0, 0x1p103f})[0], kInfinity);  // half a unit beyond the largest
  EXPECT_EQ(map(viewport, {kLargest, 0, 0, 0x1.fffffep102f})[0], kLargest);
  EXPECT_EQ(map(viewport, {-kLargest, 0, 0, -kLargest})[0], -kInfinity);
  EXPECT_EQ(bits(map(viewport, {-0.0f, -0.0f, -0.0f, -0.0f})[0]), 0u);
  EXPECT_EQ(bits(map(viewport, {-0.0f, -0.0f, -0.0f, -0.0f})[3]), 0u);
  viewport.width = 1;                                                 // X = (x + w) / 2
  EXPECT_EQ(bits(map(viewport, {-kTiny, 0, 0, 0})[0]), bits(-0.0f));  // not zero, and too small
  EXPECT_EQ(map(viewport, {3 * kTiny, 0, 0, 0})[0], 2 * kTiny);
  for (const float bad : {kNaN, kInfinity}) {
    for (const float value : map(viewport, {0, 0, bad, 1})) EXPECT_TRUE(std::isnan(value));
  }
}

TEST(Oracle, ThreadsChangeNothing) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> number(-100, 100);
  TestDraw batch{};
  for (std::uint32_t n = 0; n < 60; ++n) {
    const auto next = [&] { return static_cast<float>(number(random)); };
    batch.vertices.push_back({next(), next(), next(), next() / 16});
    batch.indices.push_back(n);
  }
  for (const bool grid : {false, true}) {
    if (grid) batch.state.grid = Grid{};
    Picture one(37, 29, 4), many(37, 29, 4);
    one.render({batch.draw()}, 1);
    many.render({batch.draw()}, 5);
    EXPECT_EQ(one.count, many.count);
    EXPECT_EQ(one.index, many.index);
    EXPECT_EQ(one.depth, many.depth);
    EXPECT_EQ(one.barycentrics, many.barycentrics);
  }
}

TEST(Oracle, CallersRoundingModeChangesNothing) {
  TestDraw batch{{0.1f, 0.1f, 0.3f, 0.7f}, {9.3f, 0.2f, 0.9f, 1.1f}, {-0.3f, -8.7f, 0.1f, -0.9f}};
  Picture expected(8, 8);
  expected.render(batch);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    Picture picture(8, 8);
    std::fesetround(mode);
    picture.render(batch);
    EXPECT_EQ(std::fegetround(), mode);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(picture.count, expected.count);
    EXPECT_EQ(picture.depth, expected.depth);
    EXPECT_EQ(picture.barycentrics, expected.barycentrics);
  }
}

}  // namespace
}  // namespace surefill
