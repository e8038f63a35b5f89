// SPDX-License-Identifier: Apache-2.0
//
// The second oracle against images worked out by hand from docs/semantics.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "oracle/clipped_polygon.hpp"
#include "oracle/oracle.hpp"

namespace surefill {
namespace {

using oracle::clipped::exact;
using oracle::clipped::nearest_float;
using oracle::clipped::Rational;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr FillRule kRules[] = {FillRule::top_left,     FillRule::top_right,      FillRule::bottom_left,
                               FillRule::bottom_right, FillRule::southwards,     FillRule::southwards_west,
                               FillRule::northwards,   FillRule::northwards_west};

// A frame of one attribute of one component, drawn into every buffer.
struct Shot {
  explicit Shot(int w, int h, int s = 1) : width(w), height(h), samples(s) {}

  int width, height, samples;
  std::vector<float> initial_depth;
  DepthTest depth_test = DepthTest::less;
  AttributeLocation location = AttributeLocation::centre;
  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, barycentrics, attribute;

  Shot& render(std::span<const Draw> draws, bool count_only = false, int threads = 1) {
    const auto n = static_cast<std::size_t>(width * height * samples);
    count.assign(n, 99);
    Target target;
    target.width = width;
    target.height = height;
    target.samples = samples;
    target.count = count;
    AttributeTarget out;
    if (!count_only) {
      index.assign(n, 99);
      depth.assign(n, 99);
      barycentrics.assign(3 * n, 99);
      attribute.assign(n, 99);
      target.index = index;
      target.depth = depth;
      target.barycentrics = barycentrics;
      out.values = attribute;
      if (!draws.empty() && !draws[0].attributes.empty()) target.attributes = {&out, 1};
    }
    target.initial_depth = initial_depth;
    target.depth_test = depth_test;
    target.attribute_location = location;
    oracle::clipped::render(target, draws, threads);
    return *this;
  }

  // One digit a sample, rows divided by '/'; '.' for zero.
  std::string counts() const {
    std::string text;
    for (std::size_t i = 0; i < count.size(); ++i) {
      if (i > 0 && i % static_cast<std::size_t>(width * samples) == 0) text += '/';
      text += count[i] == 0 ? '.' : static_cast<char>('0' + count[i]);
    }
    return text;
  }
  std::string indices() const {
    std::string text;
    for (const std::uint32_t i : index) text += i == kNoTriangle ? '.' : static_cast<char>('0' + i);
    return text;
  }
};

// Owns what a draw points to; triangle t has the vertices 3t, 3t + 1, 3t + 2.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<float> values;  // one a vertex, or none
  std::vector<std::uint32_t> indices;
  AttributeArray array;

  explicit Mesh(std::vector<Vertex> v, std::vector<float> u = {}, Interpolation mode = Interpolation::perspective)
      : vertices(std::move(v)), values(std::move(u)) {
    for (std::uint32_t i = 0; i < vertices.size(); ++i) indices.push_back(i);
    array.values = values;
    array.interpolation = mode;
  }
  Draw draw() const {
    Draw result;
    result.vertices = vertices;
    result.indices = indices;
    if (!values.empty()) result.attributes = {&array, 1};
    return result;
  }
};

Vertex flat(float x, float y, float z = 0) {
  return {x, y, z, 1};
}
Vertex negated(const Vertex& v) {
  return {-v.x, -v.y, -v.z, -v.w};
}

std::string counts_of(const Draw& draw, int width, int height, int samples = 1) {
  return Shot(width, height, samples).render({&draw, 1}, true).counts();
}

// The corners (0, 0), (3, 0), (0, 3) of the lattice of samples: each rule has its own part of the border.
TEST(ClippedOracle, FillRulesC3) {
  const char* images[] = {
      "111./11../1.../....",  // +x, +y: left and upper side
      ".111/.11./.1../....",  // -x, +y: upper side and hypotenuse
      "..../11../1.../....",  // +x, -y: left side
      "..../.11./.1../....",  // -x, -y: hypotenuse
      "111./11../1.../....",  // +y, +x: left and upper side
      ".11./.1../..../....",  // +y, -x: upper side
      "..../111./11../1...",  // -y, +x: left side and hypotenuse
      "..../.11./.1../....",  // -y, -x: hypotenuse
  };
  const Vertex a = flat(0.5f, 0.5f), b = flat(3.5f, 0.5f), c = flat(0.5f, 3.5f);
  const Mesh clockwise({a, b, c});
  const Mesh counter({c, b, a});
  for (std::size_t i = 0; i < 8; ++i) {
    for (const Mesh* mesh : {&clockwise, &counter}) {
      Draw draw = mesh->draw();
      draw.fill_rule = kRules[i];
      EXPECT_EQ(counts_of(draw, 4, 4), images[i]) << i;
      draw.grid = Grid{};  // on the grid already
      EXPECT_EQ(counts_of(draw, 4, 4), images[i]) << i;
    }
  }
}

TEST(ClippedOracle, OctantsT3) {
  const Vertex v[] = {{1, 1, 0, 2}, {7, 1, 0, 2}, {1.5f, 3.5f, 0, 1}};
  for (const FillRule rule : kRules) {
    std::vector<Vertex> all;
    for (unsigned signs = 0; signs < 8; ++signs) {
      for (unsigned i = 0; i < 3; ++i) all.push_back((signs >> i & 1u) != 0 ? negated(v[i]) : v[i]);
    }
    const Mesh mesh(all);
    Draw draw = mesh.draw();
    draw.fill_rule = rule;
    EXPECT_EQ(counts_of(draw, 4, 4), "1111/1111/1111/1111");
  }
}

// W < 0 on one vertex: what is seen is the region beyond the side (2, 0)-(2, 4), away from (0, 2); unbounded.
TEST(ClippedOracle, BehindTheEyeC2) {
  const Mesh mesh({flat(2, 0), flat(2, 4), {0, -2, 0, -1}});
  EXPECT_EQ(counts_of(mesh.draw(), 4, 4), "..11/..11/..11/..11");
  const Mesh behind({{0, 0, 0, -1}, {-4, 0, 0, -1}, {0, -4, 0, -1}});
  EXPECT_EQ(counts_of(behind.draw(), 2, 1), "..");
  // W = 0: the direction (0, 1), (2, 1) and the direction (1, 0) span what is right of x = 2 and below y = 1.
  const Mesh quadrant({{0, 1, 0, 0}, flat(2, 1), {1, 0, 0, 0}});
  EXPECT_EQ(counts_of(quadrant.draw(), 4, 3), "..../..11/..11");
  const Mesh edge_on({{0, 1, 0, 0}, flat(2, 1), {4, 3, 0, 2}});  // (2, 1), (2, 1.5), (2, infinity)
  EXPECT_EQ(counts_of(edge_on.draw(), 4, 3), "..../..../....");
}

TEST(ClippedOracle, FacingAndCulling) {
  const Vertex a = flat(0, 0), b = flat(2, 0), c = flat(0, 2);
  const Mesh clockwise({a, b, c});
  const Mesh counter({a, c, b});
  for (const bool grid : {false, true}) {
    for (const FillRule rule : kRules) {
      for (const Cull cull : {Cull::none, Cull::front, Cull::back}) {
        for (const FrontFace front : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
          for (const Mesh* mesh : {&clockwise, &counter}) {
            Draw draw = mesh->draw();
            draw.fill_rule = rule;
            draw.cull = cull;
            draw.front_face = front;
            if (grid) draw.grid = Grid{};
            const bool is_front = (front == FrontFace::clockwise) == (mesh == &clockwise);
            const bool drawn = cull == Cull::none || (cull == Cull::back) == is_front;
            EXPECT_EQ(counts_of(draw, 1, 1), drawn ? "1" : ".");
          }
        }
      }
    }
  }
}

// Screen corners (0, 0), (4, 0), (0, 4) with W = 1, 2, 1. At (1.5, 1.5) the screen weights are 2/8, 3/8, 3/8 and
// E_i / D = weight / W: 4/16, 3/16, 6/16, of sum 13/16.
TEST(ClippedOracle, DepthAndAttributes) {
  const std::vector<Vertex> v = {{0, 0, 0.25f, 1}, {8, 0, 1, 2}, {0, 4, 0.5f, 1}};
  const std::vector<float> u = {1, 2, 5};
  const std::size_t pixel = 1 * 4 + 1;
  const float expected[] = {40.0f / 13, (2 * 1 + 3 * 2 + 3 * 5) / 8.0f, 1.0f};
  for (const Interpolation mode : {Interpolation::perspective, Interpolation::noperspective, Interpolation::flat}) {
    for (const bool grid : {false, true}) {
      const Mesh mesh(v, u, mode);
      Draw draw = mesh.draw();
      if (grid) draw.grid = Grid{};
      Shot shot(4, 4);
      shot.render({&draw, 1});
      EXPECT_EQ(shot.depth[pixel], 0.4375f);
      EXPECT_EQ(shot.barycentrics[3 * pixel], 4.0f / 13);
      EXPECT_EQ(shot.barycentrics[3 * pixel + 1], 3.0f / 13);
      EXPECT_EQ(shot.barycentrics[3 * pixel + 2], 6.0f / 13);
      EXPECT_EQ(shot.attribute[pixel], expected[static_cast<std::size_t>(mode)]);
      EXPECT_EQ(shot.counts(), "111./11../1.../....") << "the diagonal is left to the other side";
      EXPECT_EQ(shot.index[15], kNoTriangle);
      EXPECT_EQ(shot.depth[15], kInfinity);
      EXPECT_EQ(shot.barycentrics[3 * 15], 0.0f);
      EXPECT_EQ(shot.attribute[15], 0.0f);
    }
  }
}

TEST(ClippedOracle, RoundingI4) {
  const Rational ulp = exact(0x1p-23f), one = 1, half(1, 2), tiny = exact(0x1p-149f);
  EXPECT_EQ(nearest_float(one + ulp * half), 1.0f);                  // tie to even, down
  EXPECT_EQ(nearest_float(one + ulp * half + tiny), 0x1.000002p0f);  // above the tie
  EXPECT_EQ(nearest_float(one + ulp + ulp * half), 0x1.000004p0f);   // tie to even, up
  EXPECT_EQ(nearest_float(-(one + ulp + ulp * half)), -0x1.000004p0f);
  EXPECT_EQ(nearest_float(one - ulp / 4), 1.0f);  // tie at a change of exponent
  EXPECT_EQ(nearest_float(Rational(1, 3)), 0x1.555556p-2f);
  EXPECT_EQ(nearest_float(tiny * half + tiny * half * tiny), 0x1p-149f);
  EXPECT_EQ(nearest_float(tiny * half + tiny), 0x1p-148f);  // subnormal tie
  EXPECT_EQ(nearest_float(exact(0x1p-126f) - tiny * half), 0x1p-126f);
  for (const Rational& zero : {Rational(0), Rational(tiny * half), Rational(-tiny * half), Rational(-tiny / 3)}) {
    EXPECT_EQ(nearest_float(zero), 0.0f);
    EXPECT_FALSE(std::signbit(nearest_float(zero)));
  }
  EXPECT_EQ(nearest_float(exact(kLargest) * 2), kLargest);
  EXPECT_EQ(nearest_float(exact(kLargest) + 1), kLargest);
  EXPECT_EQ(nearest_float(-exact(kLargest) / tiny / tiny / tiny / tiny / tiny / tiny / tiny), -kLargest);
  for (const float value : {0x1p-149f, 0x1.fffffcp-127f, 0x1p-126f, 0.1f, 3.0f, kLargest}) {
    EXPECT_EQ(nearest_float(exact(value)), value);
    EXPECT_EQ(nearest_float(exact(-value)), -value);
  }
}

// z = x - 1 on a line of four pixels: -1/2, 1/2, 3/2, 5/2.
TEST(ClippedOracle, DepthModesI5) {
  const Mesh mesh({flat(0, 0, -1), flat(8, 0, 7), flat(0, 8, -1)});
  Draw draw = mesh.draw();
  Shot shot(4, 1);
  shot.render({&draw, 1});
  EXPECT_EQ(shot.depth, (std::vector<float>{-0.5f, 0.5f, 1.5f, 2.5f}));
  draw.depth_mode = DepthMode::clamp;
  EXPECT_EQ(shot.render({&draw, 1}).depth, (std::vector<float>{0, 0.5f, 1, 1}));
  draw.depth_mode = DepthMode::clip;
  EXPECT_EQ(shot.render({&draw, 1}).depth, (std::vector<float>{kInfinity, 0.5f, kInfinity, kInfinity}));
  EXPECT_EQ(shot.counts(), ".1..");
  EXPECT_EQ(counts_of(draw, 4, 1), ".1..");
  // Exactly 0 and 1 pass: z = x - 1/2.
  const Mesh ends({flat(0, 0, -0.5f), flat(8, 0, 7.5f), flat(0, 8, -0.5f)});
  Draw at_ends = ends.draw();
  at_ends.depth_mode = DepthMode::clip;
  EXPECT_EQ(counts_of(at_ends, 4, 1), "11..");
}

// Layers over one pixel with the given depths.
Mesh layers(const std::vector<float>& depths) {
  std::vector<Vertex> v;
  for (const float z : depths) v.insert(v.end(), {flat(0, 0, z), flat(4, 0, z), flat(0, 4, z)});
  return Mesh(v);
}

TEST(ClippedOracle, Visibility) {
  const Mesh mesh = layers({0.5f, 0.25f, 0.75f, 0.25f, 0.75f});
  Draw draw = mesh.draw();
  Shot less(1, 1), greater(1, 1);
  greater.depth_test = DepthTest::greater;
  EXPECT_EQ(less.render({&draw, 1}).indices(), "1");
  EXPECT_EQ(less.counts(), "5");
  EXPECT_EQ(greater.render({&draw, 1}).indices(), "2");
  EXPECT_EQ(greater.depth[0], 0.75f);
  draw.first_index = 3;
  EXPECT_EQ(less.render({&draw, 1}).indices(), "4");
  const std::uint32_t identifiers[] = {8, 7, 6, 5, 4};
  draw.identifiers = identifiers;
  EXPECT_EQ(less.render({&draw, 1}).indices(), "5");
  EXPECT_EQ(greater.render({&draw, 1}).indices(), "4");
  // Initial depth must be beaten strictly, and stays bit for bit.
  less.initial_depth = {0.25f};
  EXPECT_EQ(less.render({&draw, 1}).indices(), ".");
  EXPECT_EQ(less.depth[0], 0.25f);
  EXPECT_EQ(less.counts(), "5");
  less.initial_depth = {0.5f};
  EXPECT_EQ(less.render({&draw, 1}).indices(), "5");
  less.initial_depth = {std::numeric_limits<float>::quiet_NaN()};
  EXPECT_EQ(less.render({&draw, 1}).indices(), ".");
  EXPECT_TRUE(std::isnan(less.depth[0]));
  const Mesh zero = layers({0});
  const Draw zero_draw = zero.draw();
  less.initial_depth = {-0.0f};
  EXPECT_EQ(less.render({&zero_draw, 1}).indices(), ".");
  EXPECT_TRUE(std::signbit(less.depth[0]));
  EXPECT_EQ(greater.render({}).depth[0], -kInfinity);
}

TEST(ClippedOracle, DepthWriteOffM5) {
  const Mesh mesh = layers({0.25f, 0.5f, 0.75f});
  Draw draw = mesh.draw();
  draw.depth_write = false;
  Shot shot(1, 1);
  EXPECT_EQ(shot.render({&draw, 1}).indices(), "2");
  EXPECT_EQ(shot.depth[0], kInfinity);
  shot.initial_depth = {0.6f};
  EXPECT_EQ(shot.render({&draw, 1}).indices(), "1");
  EXPECT_EQ(shot.depth[0], 0.6f);
  const std::uint32_t identifiers[] = {5, 2, 9};
  draw.identifiers = identifiers;
  EXPECT_EQ(shot.render({&draw, 1}).indices(), "5");
  const std::uint32_t equal[] = {5, 5, 5};
  draw.identifiers = equal;
  EXPECT_EQ(shot.render({&draw, 1}).barycentrics[0], 1 - 0.25f);
}

TEST(ClippedOracle, SeveralDrawsV3) {
  const Mesh first = layers({0.5f, 0.5f});
  const Mesh second = layers({0.5f, 0.25f});
  Draw draws[] = {first.draw(), second.draw()};
  draws[1].first_index = 2;
  Shot shot(1, 1);
  EXPECT_EQ(shot.render(draws).indices(), "3");
  EXPECT_EQ(shot.counts(), "4");
  draws[1].indices = draws[1].indices.first(3);  // depth 1/2 again: no strict win, although the index could be smaller
  draws[0].first_index = 7;
  EXPECT_EQ(shot.render(draws).indices(), "7");
  draws[0].depth_write = false;  // then the first draw leaves no depth
  EXPECT_EQ(shot.render(draws).indices(), "2");
  EXPECT_EQ(shot.depth[0], 0.5f);
}

TEST(ClippedOracle, BadTrianglesB1) {
  for (const float bad : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    Mesh mesh = layers({0.5f, 0.5f});
    mesh.vertices[1].z = bad;
    EXPECT_EQ(counts_of(mesh.draw(), 1, 1), "1");
    Mesh with_values({flat(0, 0), flat(4, 0), flat(0, 4)}, {0, 0, bad});
    EXPECT_EQ(counts_of(with_values.draw(), 1, 1), ".") << "in an attribute that nobody asks for";
  }
}

TEST(ClippedOracle, ScissorM3) {
  const Mesh mesh({flat(0, 0), flat(9, 0), flat(0, 9)});
  for (const FillRule rule : kRules) {
    Draw draw = mesh.draw();
    draw.fill_rule = rule;
    draw.scissor = Scissor{1, -5, 3, 2};
    EXPECT_EQ(counts_of(draw, 4, 3), ".11./.11./....");
    draw.scissor = Scissor{2, 1, 2, 3};
    EXPECT_EQ(counts_of(draw, 4, 3), "..../..../....");
  }
}

// Left of x = 1/2: of the four samples (6, 2) (14, 6) (2, 10) (10, 14) the numbers 0 and 2; the centre lies on the
// edge.
TEST(ClippedOracle, SamplesM1) {
  const Mesh mesh({flat(0.5f, -4), flat(0.5f, 8), flat(-8, 2)}, {0.5f, 0.5f, -8});  // the value is x
  Draw draw = mesh.draw();
  Shot shot(1, 1, 4);
  EXPECT_EQ(shot.render({&draw, 1}).counts(), "1.1.");
  EXPECT_EQ(shot.attribute, (std::vector<float>{0.5f, 0, 0.5f, 0})) << "at the centre";
  shot.location = AttributeLocation::centroid;
  EXPECT_EQ(shot.render({&draw, 1}).attribute, (std::vector<float>{0.375f, 0, 0.375f, 0})) << "at sample 0";
  draw.fill_rule = FillRule::top_right;  // the centre is covered
  EXPECT_EQ(shot.render({&draw, 1}).attribute, (std::vector<float>{0.5f, 0, 0.5f, 0}));
  draw.scissor = Scissor{1, 0, 2, 1};
  EXPECT_EQ(shot.render({&draw, 1}).counts(), "....");
  const int offsets[5][2] = {{1, 0}, {2, 1}, {4, 2}, {8, 4}, {16, 8}};  // samples with x < 1/2: S4, counted by hand
  for (const auto& [samples, covered] : offsets) {
    const std::string counts = counts_of(mesh.draw(), 1, 1, samples);
    EXPECT_EQ(std::count(counts.begin(), counts.end(), '1'), covered) << samples;
  }
}

// Screen (1, 1), (3, 1), (1, 3).
TEST(ClippedOracle, ConservativeM4) {
  const Mesh mesh({flat(1, 1), flat(3, 1), flat(1, 3)});
  Draw draw = mesh.draw();
  draw.conservative = Conservative::over;  // touching counts: above in x 1..3, in y 2..3 up to x = 2, at y = 3 up to 1
  EXPECT_EQ(counts_of(draw, 5, 5), "1111./1111./111../11.../.....");
  draw.conservative = Conservative::inner;
  EXPECT_EQ(counts_of(draw, 5, 5), "...../.1.../...../...../.....");
  draw.cull = Cull::front;
  EXPECT_EQ(counts_of(draw, 5, 5), "...../...../...../...../.....");
  // The unbounded quadrant x >= 2, y >= 1.
  const Mesh quadrant({{0, 1, 0, 0}, flat(2, 1), {1, 0, 0, 0}});
  draw = quadrant.draw();
  draw.conservative = Conservative::over;
  EXPECT_EQ(counts_of(draw, 4, 3), ".111/.111/.111");
  draw.conservative = Conservative::inner;
  EXPECT_EQ(counts_of(draw, 4, 3), "..../..11/..11");
  draw.scissor = Scissor{0, 0, 3, 9};
  EXPECT_EQ(counts_of(draw, 4, 3), "..../..1./..1.");
}

// Whole pixels: x = 0.5 goes to 0 (even) or 1 (up) or 0 (truncated); 1.5 to 2, 2, 1; -0.5 to 0, 0, 0; -1.5 to -2, -1,
// -1.
TEST(ClippedOracle, GridG1) {
  const GridRounding roundings[] = {GridRounding::nearest_even, GridRounding::nearest_up, GridRounding::truncate};
  const auto strip = [](float x0, float x1) {
    return Mesh({flat(x0, 0), flat(x1, 0), flat(x0, 4), flat(x1, 0), flat(x1, 4), flat(x0, 4)});
  };
  const struct {
    float x0, x1;
    const char* images[3];
  } cases[] = {{0.5f, 2.5f, {"11..", ".11.", "11.."}},
               {1.5f, 3.5f, {"..11", "..11", ".11."}},
               {-1.5f, 0.75f, {"1...", "1...", "...."}}};
  for (const auto& [x0, x1, images] : cases) {
    const Mesh mesh = strip(x0, x1);
    for (std::size_t i = 0; i < 3; ++i) {
      Draw draw = mesh.draw();
      draw.grid = Grid{0, 0, 0, roundings[i]};
      EXPECT_EQ(counts_of(draw, 4, 1), images[i]) << x0 << ' ' << i;
    }
  }
  // offset 9/16: positions go to 9/16 + k: 1.5 -> 25/16 and 2.25 -> 41/16, so that the sample 1.5 is out, 2.5 in.
  const Mesh mesh = strip(1.5f, 2.25f);
  Draw draw = mesh.draw();
  draw.grid = Grid{0, 9, 0, GridRounding::nearest_even};
  EXPECT_EQ(counts_of(draw, 4, 1), "..1.");
}

// Triangles seen edge-on: the grid may make an area of them, G2 its values.
TEST(ClippedOracle, GridEdgeOnG2) {
  const Mesh mesh({{0, 0, 3, 1}, {1.5f, 1.5f, 1.5f, 1}, {6, 6, 4, 2}}, {7, 8, 9});  // (0, 0), (1.5, 1.5), (3, 3)
  Draw draw = mesh.draw();
  EXPECT_EQ(counts_of(draw, 4, 4), "..../..../..../....");
  draw.grid = Grid{0, 0, 0, GridRounding::nearest_even};  // (0, 0), (2, 2), (3, 3): still on the line
  EXPECT_EQ(counts_of(draw, 4, 4), "..../..../..../....");
  const Mesh bent({{0, 0, 3, 1}, {1.5f, 1.75f, 1.5f, 1}, {6, 7, 4, 2}}, {7, 8, 9});  // (0, 0), (1.5, 1.75), (3, 3.5)
  draw = bent.draw();
  EXPECT_EQ(counts_of(draw, 4, 4), "..../..../..../....");
  draw.grid = Grid{0, 0, 0, GridRounding::nearest_even};  // (0, 0), (2, 2), (3, 4): the samples (1.5, 1.5), (2.5, 2.5)
  Shot shot(4, 4);
  // The long side has x = 3/4 y, the short ones x = y and then x = 1 + y/2. On x = y the sample moves to +x: out; at
  // y = 2.5: [1.875, 2.25): none; y = 3.5: [2.625, 2.75): none. With -x: on x = y in.
  EXPECT_EQ(shot.render({&draw, 1}).counts(), "..../..../..../....");
  draw.fill_rule = FillRule::top_right;
  EXPECT_EQ(shot.render({&draw, 1}).counts(), "1.../.1../..../....");
  EXPECT_EQ(shot.depth[5], 1.5f) << "the nearest corner";
  EXPECT_EQ(shot.attribute[5], 7.0f);
  EXPECT_EQ(shot.barycentrics[15], 1.0f);
  draw.cull = Cull::back;  // (0, 0), (2, 2), (3, 4) turns from +x to +y: front
  EXPECT_EQ(counts_of(draw, 4, 4), "1.../.1../..../....");
  draw.cull = Cull::front;
  EXPECT_EQ(counts_of(draw, 4, 4), "..../..../..../....");
}

// A sample that snapping brings into the triangle: depth is clamped to the corners' range, weights to the inside.
TEST(ClippedOracle, GridOutsideG2) {
  // Corners (0, 0), (4, 0), (0, 0.4); bits 0: the last goes to (0, 0). With 0.6: (0, 1), and (0.5, 0.5) is in: on
  // screen 4 y < 4 - x holds, 0.5 < 1 - 0.125. The triangle itself: y/0.6f + x/4 = 0.83 + 0.125 < 1: in as well. (1.5,
  // 0.5): snapped 0.5 < 1 - 0.375 in; itself 0.83 + 0.375 > 1: out, E_0 of the wrong sign.
  const float y = 0.6f;
  const Mesh mesh({flat(0, 0, 0.5f), flat(4, 0, 0.25f), flat(0, y, 0.25f)}, {4, 8, 16});
  Draw draw = mesh.draw();
  EXPECT_EQ(counts_of(draw, 4, 1), "1...");
  draw.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  Shot shot(4, 1);
  EXPECT_EQ(shot.render({&draw, 1}).counts(), "11..");
  // At (1.5, 0.5): E_1 / D = 3/8, E_2 / D = 0.5 / y, E_0 counts as 0. z = 1/2 - (E_1 + E_2)/4D < 1/4 is clamped.
  EXPECT_EQ(shot.depth[1], 0.25f);
  const Rational e1(3, 8), e2 = Rational(1, 2) / exact(y);
  EXPECT_EQ(shot.attribute[1], nearest_float((8 * e1 + 16 * e2) / (e1 + e2)));
  EXPECT_EQ(shot.barycentrics[3], 0.0f);
  EXPECT_EQ(shot.barycentrics[4], nearest_float(e1 / (e1 + e2)));
}

// m0 = (15, 45, 10)/8, m1 = (-1, -3, -1), m2 = (0, 7/2, 7/4): D = 35/16, and at the centre (1.5, 3.5) E_0 = 0, E_1 =
// -105/32, E_2 = -5/8, so that all count as 0. The snapped polygon has there the side (0, 2)-(2, 4), with the inside at
// larger y: where the shift goes inside, the centre is covered and serves "as centroid", with the values of vertex 0.
TEST(ClippedOracle, GridCentreWithoutWeightsM1G2) {
  const Mesh mesh({{1.875f, 5.625f, 0, 1.25f}, {-1, -3, 0, -1}, {0, 3.5f, 0, 1.75f}});
  Draw draw = mesh.draw();
  draw.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  draw.fill_rule = FillRule::southwards;
  const std::size_t sample = (3 * 2 + 1) * 4 + 2;  // of pixel (1, 3)
  for (const AttributeLocation location : {AttributeLocation::centre, AttributeLocation::centroid}) {
    Shot shot(2, 5, 4);
    shot.location = location;
    shot.render({&draw, 1});
    EXPECT_EQ(shot.count[sample], 1u);
    EXPECT_EQ(shot.barycentrics[3 * sample], 1.0f);
    EXPECT_EQ(shot.barycentrics[3 * sample + 2], 0.0f);
  }
}

TEST(ClippedOracle, ThreadsDoNotMatter) {
  const Mesh mesh({{1, 1, 0, 2}, {70, -3, 2, 2}, {-1.5f, -30, 1, -1}, flat(3, 30, 1), flat(0, 0), flat(32, 9)},
                  {1, 2, 3, 4, 5, 6});
  for (const FillRule rule : kRules) {
    Draw draw = mesh.draw();
    draw.fill_rule = rule;
    Shot one(32, 31, 4), three(32, 31, 4);
    one.render({&draw, 1});
    three.render({&draw, 1}, false, 3);
    EXPECT_EQ(one.count, three.count);
    EXPECT_EQ(one.index, three.index);
    EXPECT_EQ(one.depth, three.depth);
    EXPECT_EQ(one.barycentrics, three.barycentrics);
    EXPECT_EQ(one.attribute, three.attribute);
  }
}

}  // namespace
}  // namespace surefill
