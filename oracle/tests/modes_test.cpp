// SPDX-License-Identifier: Apache-2.0
//
// Origin, sample places, winding, numbers of a triangle, conservative modes, layers, depth tests and bias (S6, S7, M9,
// M10, M4a to M4c, V4, V5, I8 of docs/semantics.md): both oracles against images worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oracle/tests/modes_image.hpp"

namespace surefill::modes {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

using Asked = Image::Asked;
using Numbers = std::vector<std::uint64_t>;

class Modes : public testing::TestWithParam<Oracle> {
 protected:
  Image draw(const Asked& asked, const std::vector<Mesh>& meshes) const {
    return render(GetParam().render, asked, meshes);
  }
  std::string counts(const Asked& asked, const Mesh& mesh) const {
    return picture(draw(asked, {mesh}).count, asked.width * asked.samples);
  }
};
INSTANTIATE_TEST_SUITE_P(Oracles, Modes, testing::ValuesIn(kOracles),
                         [](const auto& test) { return test.index == 0 ? "First" : "Second"; });

// The corners (0, 0), (3, 0), (0, 3) of the lattice of samples, of a target with this origin: rows of 3, 2, 1 samples.
Mesh corner_triangle(float x, float y) {
  return Mesh({flat(x + 0.5f, y + 0.5f), flat(x + 3.5f, y + 0.5f), flat(x + 0.5f, y + 3.5f)});
}

// x0 <= x < x1, from above y = -100 to below y = 100.
Mesh strip(float x0, float x1) {
  return Mesh({flat(x0, -128), flat(x1, -128), flat(x0, 128), flat(x1, -128), flat(x1, 128), flat(x0, 128)});
}

// z at (0, 0), and its slopes: over all of small targets near the origin of space.
Mesh plane(float z, float dx, float dy) {
  return Mesh({flat(-64, -64, z - 64 * dx - 64 * dy), flat(256, -64, z + 256 * dx - 64 * dy),
               flat(-64, 256, z - 64 * dx + 256 * dy)});
}

// Triangles over one pixel with the given depths.
Mesh sheets(const std::vector<float>& depths) {
  std::vector<Vertex> v;
  for (const float z : depths) v.insert(v.end(), {flat(0, 0, z), flat(8, 0, z), flat(0, 8, z)});
  return Mesh(v);
}

TEST_P(Modes, OriginS6) {
  for (const int x : {0, 1000, -1000, kMaxOrigin, -kMaxOrigin, -3}) {
    for (const int y : {0, -2001, kMaxOrigin, -kMaxOrigin}) {
      const Mesh mesh = corner_triangle(static_cast<float>(x), static_cast<float>(y));
      Asked asked{.width = 4, .height = 4, .origin = {x, y}};
      // At 2^22 float32 has halves: the corners are what they are called.
      EXPECT_EQ(counts(asked, mesh), "111./11../1.../....");
      Mesh cut = mesh;
      cut.state.scissor = Scissor{x + 1, y, x + 9, y + 2};
      EXPECT_EQ(counts(asked, cut), ".11./.1../..../....");
      Mesh over = mesh;  // from x + 1/2 to x + 7/2: it meets the squares of x .. x + 3 in the first row
      over.state.conservative = Conservative::over;
      EXPECT_EQ(counts(asked, over), "1111/1111/111./11..");
      if (std::abs(x) == kMaxOrigin || std::abs(y) == kMaxOrigin) continue;
      asked.origin = {x + 1, y - 1};
      EXPECT_EQ(counts(asked, mesh), "..../11../1.../....");
    }
  }
}

// Whole pixels. 1.5 and 3.5 go to the even numbers 2 and 4, also where the target begins at 1; -1.5 and 0.75 go to -2
// and 1, -1 and 1, truncated (towards the zero of space) to -1 and 0.
TEST_P(Modes, GridOfSpaceS6) {
  const Asked at_1{.width = 4, .height = 1, .origin = {1, 0}}, at_minus_2{.width = 4, .height = 1, .origin = {-2, 0}};
  Mesh mesh = strip(1.5f, 3.5f);
  mesh.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  EXPECT_EQ(counts(at_1, mesh), ".11.");
  mesh = strip(-1.5f, 0.75f);
  mesh.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  EXPECT_EQ(counts(at_minus_2, mesh), "111.");
  mesh.state.grid->rounding = GridRounding::nearest_up;
  EXPECT_EQ(counts(at_minus_2, mesh), ".11.");
  mesh.state.grid->rounding = GridRounding::truncate;
  EXPECT_EQ(counts(at_minus_2, mesh), ".1..");
  // 9/16 + k: -1.5 goes to -23/16, 0.75 to 9/16; the samples -0.5 and 0.5 are in.
  mesh.state.grid = Grid{0, 9, 0, GridRounding::nearest_even};
  EXPECT_EQ(counts(at_minus_2, mesh), ".11.");
}

// The guard band goes with the target, 16385 pixels to each side of its corner. A band around 0 has no part of the first
// triangle. The second one has its upper side from (0, 0) to (262144, 2), at y = x / 2^17, and its lower side at 4 - x /
// 2^17; the corners are on the grid of whole pixels. For the target at x = 147456 it is cut at x = 131071 and 163841:
// the upper side at y = 0.99.. and 1.25.., which go to 1, the lower side at 3.00.. and 2.74.., to 3. Now y = 17/16 lies
// inside; where the side had been, at y = 1.125, it would not.
TEST_P(Modes, GuardBandS6) {
  Mesh mesh = corner_triangle(1048576, 0);
  mesh.state.grid = Grid{};
  EXPECT_EQ(counts({.width = 4, .height = 4, .origin = {1048576, 0}}, mesh), "111./11../1.../....");
  Mesh long_one({flat(0, 0), flat(262144, 2), flat(0, 4)});
  const Asked asked{.width = 2, .height = 4, .origin = {147456, 0}, .places = {{8, 1}}};
  EXPECT_EQ(counts(asked, long_one), "../../11/..");
  long_one.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  EXPECT_EQ(counts(asked, long_one), "../11/11/..");
}

TEST_P(Modes, OnePlaceS7) {
  // z = x / 8, the value is x; one sample at the corner of each pixel.
  Mesh mesh({flat(0, 0, 0), flat(4, 0, 0.5f), flat(0, 4, 0)}, {0, 4, 0});
  Asked asked{.width = 4, .height = 4, .places = {{0, 0}}};
  Image image = draw(asked, {mesh});
  EXPECT_EQ(picture(image.count, 4), "1111/111./11../1...");
  EXPECT_EQ(image.depth[6], bits({0.25f})[0]) << "pixel (2, 1)";
  EXPECT_EQ(image.attributes[0][6], bits({2})[0]);
  EXPECT_EQ(image.attributes[1][6], bits({2})[0]);
  EXPECT_EQ(image.barycentrics[3 * 6 + 1], bits({0.5f})[0]);
  // (15, 2): the pixel (2, 1) has x + y = 2 + 15/16 + 1 + 2/16 > 4: out, and (2, 0) is in, though its centre's
  // x + y = 3 and so less than at the place.
  asked.places = {{15, 2}};
  image = draw(asked, {mesh});
  EXPECT_EQ(picture(image.count, 4), "111./11../1.../....");
  EXPECT_EQ(image.attributes[0][2], bits({2.9375f})[0]);
  // The centre is not covered, and has no part, whatever the location of attributes.
  const Mesh left({flat(0.25f, -4), flat(0.25f, 8), flat(-8, 2)}, {0.25f, 0.25f, -8});
  for (const AttributeLocation location : {AttributeLocation::centre, AttributeLocation::centroid}) {
    image = draw({.attribute_location = location, .places = {{2, 3}}}, {left});
    EXPECT_EQ(image.attributes[0], bits({0.125f}));
    EXPECT_EQ(image.attributes[1], bits({0.125f}));
  }
}

// What is left of x = 1/2, with the value x and z = x / 8; own places of two samples, and M1's centre.
TEST_P(Modes, SeveralPlacesS7) {
  Mesh mesh({flat(0.5f, -4, 0.0625f), flat(0.5f, 8, 0.0625f), flat(-8, 2, -1)}, {0.5f, 0.5f, -8});
  Asked asked{.samples = 2, .places = {{12, 8}, {4, 8}}};
  Image image = draw(asked, {mesh});
  EXPECT_EQ(picture(image.count, 2), ".1");
  EXPECT_EQ(image.attributes[0], bits({0, 0.5f})) << "at the pixel centre";
  EXPECT_EQ(image.depth, bits({kInfinity, 0.03125f})) << "at the sample";
  asked.attribute_location = AttributeLocation::centroid;
  EXPECT_EQ(draw(asked, {mesh}).attributes[0], bits({0, 0.25f})) << "at sample 1";
  asked.places = {{2, 8}, {4, 8}};
  image = draw(asked, {mesh});
  EXPECT_EQ(picture(image.count, 2), "11");
  EXPECT_EQ(image.attributes[0], bits({0.125f, 0.125f})) << "at sample 0";
  EXPECT_EQ(image.depth, bits({0.015625f, 0.03125f}));
  asked.places = {{4, 8}, {4, 8}};
  image = draw(asked, {mesh});
  EXPECT_EQ(picture(image.count, 2), "11");
  EXPECT_EQ(image.attributes[0], bits({0.25f, 0.25f}));
}

TEST_P(Modes, WindingM9) {
  const Vertex a = flat(0, 0), b = flat(4, 0), c = flat(0, 4);
  const Vertex d = flat(0, 0), e = flat(2, 0), f = flat(0, 2);
  Mesh large({a, b, c}), small({d, f, e});  // front; back
  const Asked asked{.width = 4, .height = 4};
  EXPECT_EQ(picture(draw(asked, {large, small}).winding, 4), ".11./11../1.../....");
  EXPECT_EQ(picture(draw(asked, {small}).winding, 4), "-.../..../..../....");
  EXPECT_EQ(picture(draw(asked, {small, small}).winding, 4), "a.../..../..../....");
  EXPECT_EQ(picture(draw(asked, {small, large, small, small}).winding, 4), "a11./11../1.../....");
  small.state.front_face = FrontFace::counter_clockwise;  // each draw has its own
  EXPECT_EQ(picture(draw(asked, {large, small}).winding, 4), "211./11../1.../....");
  small.state.cull = Cull::front;
  EXPECT_EQ(picture(draw(asked, {large, small}).winding, 4), "111./11../1.../....");
  large.state.scissor = Scissor{0, 0, 9, 1};
  EXPECT_EQ(picture(draw(asked, {large}).winding, 4), "111./..../..../....");
  // z = x / 2: of what depth clips nothing counts, and what the test hides does: initial depth is nearer.
  Mesh steep({flat(0, 0, 0), flat(4, 0, 2), flat(0, 4, 0)});
  steep.state.depth_mode = DepthMode::clip;
  Asked hidden = asked;
  hidden.initial_depth.assign(16, -1);
  EXPECT_EQ(picture(draw(hidden, {steep, steep}).winding, 4), "22../22../2.../....");
  EXPECT_EQ(indices(draw(hidden, {steep}).index), "................");
}

// The facing of the grid: (0, 0), (1.5, 1.75), (3, 3.5) are in a line, and go to (0, 0), (2, 2), (3, 4), which turn
// from +x to +y. With the shift to -x this covers the samples (1/2, 1/2) and (3/2, 3/2).
TEST_P(Modes, WindingOfSnappedM9) {
  const Vertex a{0, 0, 3, 1}, b{1.5f, 1.75f, 1.5f, 1}, c{6, 7, 4, 2};
  for (const bool turned : {false, true}) {
    Mesh mesh(turned ? std::vector{c, b, a} : std::vector{a, b, c});
    mesh.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
    mesh.state.fill_rule = FillRule::top_right;
    EXPECT_EQ(picture(draw({.width = 4, .height = 4}, {mesh}).winding, 4),
              turned ? "-.../.-../..../...." : "1.../.1../..../....");
    mesh.state.cull = Cull::back;
    EXPECT_EQ(picture(draw({.width = 4, .height = 4}, {mesh}).winding, 4),
              turned ? "..../..../..../...." : "1.../.1../..../....");
  }
}

// A fan of each contour.
Mesh polygon(const std::vector<std::vector<Vertex>>& contours) {
  std::vector<Vertex> v;
  for (const std::vector<Vertex>& contour : contours) {
    for (std::size_t i = 1; i + 1 < contour.size(); ++i) v.insert(v.end(), {contour[0], contour[i], contour[i + 1]});
  }
  return Mesh(v);
}

TEST_P(Modes, PolygonsM9) {
  const std::vector<Vertex> outer = {flat(0, 0), flat(6, 0), flat(6, 6), flat(0, 6)};
  const std::vector<Vertex> hole = {flat(2, 2), flat(2, 4), flat(4, 4), flat(4, 2)};
  const std::vector<Vertex> same_way = {flat(4, 2), flat(4, 4), flat(2, 4), flat(2, 2)};
  const Asked asked{.width = 6, .height = 6};
  EXPECT_EQ(picture(draw(asked, {polygon({outer, hole})}).winding, 6), "111111/111111/11..11/11..11/111111/111111");
  // Nonzero fills what is 2 here, even-odd leaves it out.
  EXPECT_EQ(picture(draw(asked, {polygon({outer, same_way})}).winding, 6), "111111/111111/112211/112211/111111/111111");
  // A bow: down the diagonal, up the right side, down the other diagonal, so that its right part turns the other way.
  // The samples on the diagonals, (1/2, 1/2) and so on, go to what lies to their right.
  const std::vector<Vertex> bow = {flat(0, 0), flat(4, 4), flat(4, 0), flat(0, 4)};
  EXPECT_EQ(picture(draw({.width = 4, .height = 4}, {polygon({bow})}).winding, 4), "...-/1.--/1.--/...-");
  // An L, not convex: the fan of its first corner leaves it and comes back.
  const std::vector<Vertex> l = {flat(4, 0), flat(4, 4), flat(0, 4), flat(0, 2), flat(2, 2), flat(2, 0)};
  EXPECT_EQ(picture(draw({.width = 4, .height = 4}, {polygon({l})}).winding, 4), "..11/..11/1111/1111");
}

TEST_P(Modes, NumbersM10) {
  Mesh back = plane(0.5f, 0, 0), front({flat(0, 0, 0.25f), flat(4, 0, 0.25f), flat(0, 4, 0.25f)});
  back.vertices.insert(back.vertices.end(), {flat(kNaN, 0), flat(1, 0), flat(0, 1)});        // dropped
  back.vertices.insert(back.vertices.end(), {flat(0, 0, 1), flat(2, 0, 1), flat(0, 4, 1)});  // hidden
  back.indices = {3, 4, 5, 0, 1, 2, 6, 7, 8};
  const Asked asked{.width = 4, .height = 4};
  Image image = draw(asked, {back, front});
  EXPECT_EQ(image.covered[0], (Numbers{0, 16, 4}));  // (2, 0), (0, 4): rows of 2, 1, 1, 0: x < 2 - y / 2
  EXPECT_EQ(image.visible[0], (Numbers{0, 10, 0}));
  EXPECT_EQ(image.covered[1], (Numbers{6}));  // rows of 3, 2, 1, 0
  EXPECT_EQ(image.visible[1], (Numbers{6}));
  // Identifiers are not positions; a draw that overwrites all; scissor; layer 0 alone.
  back.identifiers = {7, 5, 6};
  Mesh last = plane(0, 0, 0);
  last.state.scissor = Scissor{0, 0, 2, 4};
  Asked layers = asked;
  layers.layers = 3;
  image = draw(layers, {back, front, last});
  EXPECT_EQ(image.covered[0], (Numbers{0, 16, 4}));
  EXPECT_EQ(image.visible[0], (Numbers{0, 7, 0})) << "the right half, but for (2, 0)";
  EXPECT_EQ(image.visible[1], (Numbers{1}));
  EXPECT_EQ(image.covered[2], (Numbers{8}));
  EXPECT_EQ(image.visible[2], (Numbers{8}));
  front.state.cull = Cull::front;
  EXPECT_EQ(draw(asked, {front}).covered[0], (Numbers{0}));
  // Samples, not pixels: left of x = 1/2 are 2 of 4, and 8 of 16 pixels' worth.
  EXPECT_EQ(draw({.width = 1, .height = 3, .samples = 4}, {strip(0, 0.5f)}).covered[0].size(), 2u);
  const Image four = draw({.width = 1, .height = 3, .samples = 4}, {strip(0, 0.5f)});
  EXPECT_EQ(four.covered[0][0] + four.covered[0][1], 6u);
  EXPECT_EQ(four.visible[0][0] + four.visible[0][1], 6u);
  // The visible one of a draw without depth write is M5's.
  Mesh off = sheets({0.25f, 0.5f});
  off.state.depth_write = false;
  image = draw({}, {off});
  EXPECT_EQ(image.covered[0], (Numbers{1, 1}));
  EXPECT_EQ(image.visible[0], (Numbers{0, 1}));
}

// Corners (1, 1), (3, 1), (1, 3): it touches squares above and to the left, and (2, 2) in the corner that they share.
TEST_P(Modes, OverlapM4a) {
  Mesh mesh({flat(1, 1), flat(3, 1), flat(1, 3)});
  const Asked asked{.width = 5, .height = 5};
  mesh.state.conservative = Conservative::overlap;
  EXPECT_EQ(counts(asked, mesh), "...../.11../.1.../...../.....");
  mesh.state.conservative = Conservative::over;
  EXPECT_EQ(counts(asked, mesh), "1111./1111./111../11.../.....");
  mesh.state.conservative = Conservative::inner;
  EXPECT_EQ(counts(asked, mesh), "...../.1.../...../...../.....");
  // The quadrant x >= 2, y >= 1, by directions; then half a pixel lower and further left.
  Mesh quadrant({{0, 1, 0, 0}, flat(2, 1), {1, 0, 0, 0}});
  quadrant.state.conservative = Conservative::overlap;
  EXPECT_EQ(counts({.width = 4, .height = 3}, quadrant), "..../..11/..11");
  quadrant.vertices[1] = flat(1.5f, 1.5f);
  EXPECT_EQ(counts({.width = 4, .height = 3}, quadrant), "..../.111/.111");
  // A needle from (0, 1/4) to (4, 1/4), and to (4, 17/64): it touches no sample, and shares area with row 0 alone.
  Mesh needle({flat(0, 0.25f), flat(4, 0.25f), flat(4, 0.265625f)});
  needle.state.conservative = Conservative::overlap;
  EXPECT_EQ(counts(asked, needle), "1111./...../...../...../.....");
  needle.vertices[2] = flat(2, 0.25f);  // D = 0
  EXPECT_EQ(counts(asked, needle), "...../...../...../...../.....");
  Mesh behind({{-1, -1, 0, -1}, {-3, -1, 0, -1}, {-1, -3, 0, -1}});
  behind.state.conservative = Conservative::overlap;
  EXPECT_EQ(counts(asked, behind), "...../...../...../...../.....");
}

TEST_P(Modes, TouchedM4b) {
  const Asked asked{.width = 4, .height = 3};
  const auto touched = [&](const std::vector<Vertex>& v) {
    Mesh mesh(v);
    mesh.state.conservative = Conservative::touched;
    return counts(asked, mesh);
  };
  const char* nothing = "..../..../....";
  const Vertex right{1, 0, 0, 0}, left{-1, 0, 0, 0}, down{0, 1, 0, 0}, up{0, -1, 0, 0}, eye{0, 0, 0, 0};
  const Vertex p = flat(1.5f, 1.5f), corner{4, 4, 0, 2};
  // Points: in a pixel, on the corner of four; the other vertices say nothing, or the same.
  EXPECT_EQ(touched({p, p, p}), "..../.1../....");
  EXPECT_EQ(touched({corner, flat(2, 2), corner}), "..../.11./.11.");
  EXPECT_EQ(touched({eye, p, eye}), "..../.1../....");
  EXPECT_EQ(touched({p, {-3, -3, 0, -2}, {-1.5f, -1.5f, 0, -1}}), "..../.1../....");
  // Segments: in a row; along the line y = 1 between rows; a diagonal through corners.
  EXPECT_EQ(touched({flat(2.5f, 0.5f), flat(0.5f, 0.5f), flat(1, 0.5f)}), "111./..../....");
  EXPECT_EQ(touched({flat(0.5f, 1), flat(1.5f, 1), flat(0.5f, 1)}), "11../11../....");
  EXPECT_EQ(touched({flat(0.5f, 0.5f), flat(2.5f, 2.5f), flat(1, 1)}), "11../111./.11.");
  EXPECT_EQ(touched({flat(0.5f, 0.25f), flat(2.5f, 0.75f), p}).size(), 14u);  // D != 0: no failure
  // Rays: to the right, with a direction once and twice; past the eye: from (1.5, 1.5) away from (0.5, 1.5).
  EXPECT_EQ(touched({p, right, p}), "..../.111/....");
  EXPECT_EQ(touched({right, right, p}), "..../.111/....");
  EXPECT_EQ(touched({p, {-0.5f, -1.5f, 0, -1}, p}), "..../.111/....");
  EXPECT_EQ(touched({p, {-1.5f, -0.5f, 0, -1}, p}), "..../.1../.1..") << "away from (1.5, 0.5)";
  EXPECT_EQ(touched({flat(3, 1), left, left}), "1111/1111/....") << "along the line y = 1, from x = 3";
  // Lines: both directions, and one through the eye: from (1.5, 0.5) up, away from (1.5, 2.5), and down.
  EXPECT_EQ(touched({up, p, down}), ".1../.1../.1..");
  EXPECT_EQ(touched({left, flat(0, 2), right}), "..../1111/1111");
  EXPECT_EQ(touched({flat(1.5f, 0.5f), {-1.5f, -2.5f, 0, -1}, down}), ".1../.1../.1..");
  // Nothing: at infinity or behind.
  EXPECT_EQ(touched({right, down, left}), nothing);
  EXPECT_EQ(touched({right, {-1, 0, 0, -1}, eye}), nothing);
  EXPECT_EQ(touched({eye, eye, eye}), nothing);
  EXPECT_EQ(touched({flat(9, 9), flat(-1, 9), flat(3, 9)}), nothing);
}

// Of D = 0 the facing is back, whichever face is front.
TEST_P(Modes, TouchedIsBackFacingM4b) {
  const Asked asked{.width = 3, .height = 1};
  for (const FrontFace face : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
    Mesh mesh({flat(0.5f, 0.5f), flat(1.5f, 0.5f), flat(1, 0.5f)});
    mesh.state.conservative = Conservative::touched;
    mesh.state.front_face = face;
    mesh.state.cull = Cull::front;
    EXPECT_EQ(counts(asked, mesh), "11.");
    mesh.state.scissor = Scissor{1, 0, 2, 1};
    EXPECT_EQ(counts(asked, mesh), ".1.");
    mesh.state.cull = Cull::back;
    EXPECT_EQ(counts(asked, mesh), "...");
    // D != 0: (0, 0), (1.5, 0), (0, 1.5) is clockwise.
    Mesh front({flat(0, 0), flat(1.5f, 0), flat(0, 1.5f)});
    front.state.conservative = Conservative::touched;
    front.state.front_face = face;
    front.state.cull = Cull::back;
    EXPECT_EQ(counts(asked, front), face == FrontFace::clockwise ? "11." : "...");
  }
}

TEST_P(Modes, LowestIndexM4c) {
  Mesh first = strip(0.5f, 2.5f), second = strip(1.25f, 1.5f), third = strip(2, 4);
  for (Mesh* mesh : {&first, &second}) mesh->state.conservative = Conservative::over;
  first.state.first_index = 4, second.state.first_index = 2, third.state.first_index = 6;
  third.state.depth_mode = DepthMode::clip;
  Asked asked{.width = 5, .height = 1};
  const std::vector<Mesh> draws = {first, second, third};
  Image image = draw(asked, draws);
  // Each strip is two halves, of indices 4 and 5, 2 and 3, 6 and 7, which meet in its middle: at x = 1.5, 1.37, 3. First:
  // 4 in pixels 0 and 1, 5 in 1 and 2. Second: both in 1. Third, by samples: 6 at 2.5, 7 at 3.5.
  EXPECT_EQ(picture(image.count, 5), "1421.");
  EXPECT_EQ(indices(image.index), "4257.");
  EXPECT_EQ(image.covered[0], (Numbers{2, 2}));
  EXPECT_EQ(image.covered[1], (Numbers{1, 1}));
  EXPECT_EQ(image.covered[2], (Numbers{1, 1}));
  EXPECT_EQ(draw(asked, {third, second, first}).index, image.index);
  asked.depth_test = DepthTest::greater;
  asked.initial_depth.assign(5, kInfinity);
  EXPECT_EQ(draw(asked, {second, third, first}).index, image.index);
  Mesh named = first;
  named.identifiers = {9, 1};
  EXPECT_EQ(indices(draw(asked, {named, second, third}).index), "9117.");
}

TEST_P(Modes, LayersV4) {
  const Mesh mesh = sheets({0.5f, 0.25f, 0.75f, 0.25f, 0.75f});
  const auto order = [&](DepthTest test, int layers, std::vector<float> initial = {}) {
    return indices(draw({.layers = layers, .depth_test = test, .initial_depth = std::move(initial)}, {mesh}).index);
  };
  EXPECT_EQ(order(DepthTest::less, 4), "1302");
  EXPECT_EQ(order(DepthTest::less, 7), "13024..");
  EXPECT_EQ(order(DepthTest::greater, 7), "24013..");
  EXPECT_EQ(order(DepthTest::less_equal, 7), "31042..");
  EXPECT_EQ(order(DepthTest::greater_equal, 7), "42031..");
  EXPECT_EQ(order(DepthTest::less, 3, {0.5f}), "13.");
  EXPECT_EQ(order(DepthTest::less_equal, 4, {0.5f}), "310.");
  EXPECT_EQ(order(DepthTest::greater, 3, {0.5f}), "24.");
  EXPECT_EQ(order(DepthTest::greater_equal, 4, {0.5f}), "420.");
  EXPECT_EQ(order(DepthTest::less_equal, 2, {kNaN}), "..");
  Image image = draw({.layers = 4, .initial_depth = {0.5f}}, {mesh});
  EXPECT_EQ(image.depth, bits({0.25f, 0.25f, 0.5f, 0.5f}));
  EXPECT_EQ(image.count, (std::vector<std::uint32_t>{5}));
  image = draw({.layers = 6, .depth_test = DepthTest::greater}, {mesh});
  EXPECT_EQ(image.depth, bits({0.75f, 0.75f, 0.5f, 0.25f, 0.25f, -kInfinity}));
  // Equal depths: the earlier draw before the smaller index, and this before the position.
  Mesh late = sheets({0.5f, 0.5f, 0.5f}), early = sheets({0.5f, 0.5f});
  late.identifiers = {3, 1, 2};
  early.state.first_index = 8;
  EXPECT_EQ(indices(draw({.layers = 6}, {early, late}).index), "89123.");
  EXPECT_EQ(indices(draw({.layers = 6, .depth_test = DepthTest::less_equal}, {early, late}).index), "32198.");
  // Where they are: layer n is n pictures further. The second pixel has one fragment, with its value.
  Mesh one({flat(0, 0, 0.5f), flat(8, 0, 0.5f), flat(0, 8, 0.5f)}, {4, 4, 4});
  Mesh two({flat(0, 0, 0.25f), flat(8, 0, 0.25f), flat(0, 8, 0.25f)}, {6, 6, 6});
  two.state.scissor = Scissor{0, 0, 1, 1};
  two.state.first_index = 1;
  image = draw({.width = 2, .layers = 2}, {one, two});
  EXPECT_EQ(indices(image.index), "100.");
  EXPECT_EQ(image.depth, bits({0.25f, 0.5f, 0.5f, kInfinity}));
  for (const auto& values : image.attributes) EXPECT_EQ(values, bits({6, 4, 4, 0}));
  EXPECT_EQ(image.barycentrics[11], 0u);
  EXPECT_EQ(image.visible[0], (Numbers{1}));
}

TEST_P(Modes, EqualDepthsV5) {
  Mesh mesh = sheets({0.5f, 0.25f, 0.75f, 0.25f, 0.75f});
  const auto seen = [&](DepthTest test, const std::vector<Mesh>& meshes, std::vector<float> initial = {}) {
    return indices(draw({.depth_test = test, .initial_depth = std::move(initial)}, meshes).index);
  };
  EXPECT_EQ(seen(DepthTest::less_equal, {mesh}), "3");
  EXPECT_EQ(seen(DepthTest::greater_equal, {mesh}), "4");
  EXPECT_EQ(seen(DepthTest::less_equal, {mesh}, {0.25f}), "3");
  EXPECT_EQ(seen(DepthTest::less, {mesh}, {0.25f}), ".");
  EXPECT_EQ(seen(DepthTest::greater_equal, {mesh}, {0.75f}), "4");
  EXPECT_EQ(seen(DepthTest::greater_equal, {mesh}, {0.8125f}), ".");
  EXPECT_EQ(seen(DepthTest::less_equal, {mesh}, {kNaN}), ".");
  EXPECT_EQ(seen(DepthTest::less_equal, {sheets({0})}, {-0.0f}), "0");
  EXPECT_EQ(draw({.depth_test = DepthTest::greater_equal}, {}).depth, bits({-kInfinity}));
  // The later draw, though its index be smaller; of a draw the largest index, of equal ones the last.
  Mesh later = sheets({0.25f});
  mesh.state.first_index = 4;
  EXPECT_EQ(seen(DepthTest::less_equal, {mesh, later}), "0");
  EXPECT_EQ(seen(DepthTest::less, {mesh, later}), "5");
  mesh.identifiers = {0, 6, 1, 5, 2};
  EXPECT_EQ(seen(DepthTest::less_equal, {mesh}), "6");
  Mesh twins({flat(0, 0), flat(8, 0), flat(0, 8), flat(8, 0), flat(0, 8), flat(0, 0)});
  twins.identifiers = {3, 3};  // b_0 at (1/2, 1/2) is 7/8 of the first, 1/16 of the second
  EXPECT_EQ(draw({.depth_test = DepthTest::less_equal}, {twins}).barycentrics[0], bits({0.0625f})[0]);
  EXPECT_EQ(draw({}, {twins}).barycentrics[0], bits({0.875f})[0]);
  // Depth write off: tested against what the draw found, equal ones pass, and the last in index order is seen.
  Mesh off = sheets({0.5f, 0.25f, 0.75f});
  off.state.depth_write = false;
  EXPECT_EQ(seen(DepthTest::less_equal, {off}, {0.5f}), "1");
  EXPECT_EQ(seen(DepthTest::less, {off}, {0.5f}), "1");
  EXPECT_EQ(seen(DepthTest::greater_equal, {off}, {0.5f}), "2");
  EXPECT_EQ(seen(DepthTest::less_equal, {off}, {0.25f}), "1");
  EXPECT_EQ(seen(DepthTest::less, {off}, {0.25f}), ".");
  EXPECT_EQ(seen(DepthTest::less_equal, {sheets({0.5f}), off, sheets({0.5f})}), "0");
}

TEST_P(Modes, BiasI8) {
  const auto depths = [&](const Mesh& mesh, float c, float s, DepthMode mode = DepthMode::none) {
    Mesh biased = mesh;
    biased.state.depth_bias = DepthBias{c, s};
    biased.state.depth_mode = mode;
    return draw({.width = 4}, {biased}).depth;
  };
  // z = x / 8: 1/16, 3/16, 5/16, 7/16, and m = 1/8.
  EXPECT_EQ(depths(plane(0, 0.125f, 0), 0.5f, 0), bits({0.5625f, 0.6875f, 0.8125f, 0.9375f}));
  EXPECT_EQ(depths(plane(0, 0.125f, 0), 0.5f, 2), bits({0.8125f, 0.9375f, 1.0625f, 1.1875f}));
  EXPECT_EQ(depths(plane(0, 0.125f, -0.5f), 0, -1), bits({-0.6875f, -0.5625f, -0.4375f, -0.3125f})) << "m = 1/2: dz/dy";
  EXPECT_EQ(depths(plane(0, -0.125f, 0.0625f), 0, 1), bits({0.09375f, -0.03125f, -0.15625f, -0.28125f}));
  // The same plane seen through vertices of W = 2, 1/2, and one behind the eye: (-64, 256) as (64, -256)/-1.
  Mesh scaled = plane(0, 0.125f, 0);
  scaled.vertices[0] = {-128, -128, -16, 2}, scaled.vertices[1] = {128, -32, 16, 0.5f};
  EXPECT_EQ(depths(scaled, 0.5f, 2), bits({0.8125f, 0.9375f, 1.0625f, 1.1875f}));
  // D < 0.
  std::swap(scaled.vertices[0], scaled.vertices[1]);
  EXPECT_EQ(depths(scaled, 0.5f, 2), bits({0.8125f, 0.9375f, 1.0625f, 1.1875f}));
  // Clip tests z, clamp what is stored: z = x / 2 is 1/4, 3/4, 5/4, 7/4, and m = 1/2.
  EXPECT_EQ(depths(plane(0, 0.5f, 0), -0.5f, 0, DepthMode::clip), bits({-0.25f, 0.25f, kInfinity, kInfinity}));
  EXPECT_EQ(depths(plane(0, 0.5f, 0), -0.5f, -0.5f, DepthMode::clamp), bits({0, 0, 0.5f, 1}));
  // One rounding: 1 + 2^-24 is half way from 1, which is even, to the next float; 2^-60 more goes beyond.
  EXPECT_EQ(depths(plane(1, 0, 0), 0x1p-24f, 0)[0], bits({1})[0]);
  const Mesh nearly_level({flat(-64, -64, 1), flat(256, -64, 1), flat(-64, 256, 1)});
  EXPECT_EQ(depths(nearly_level, 0x1p-24f, 1)[0], bits({1})[0]);
  EXPECT_EQ(depths(plane(0, 0.125f, 0), 0.9375f + 0x1p-24f, 0x1p-57f)[0], bits({1 + 0x1p-23f})[0]);
  EXPECT_EQ(depths(plane(0, 0.125f, 0), 0.9375f, 0)[0], bits({1})[0]);
  // Beyond range it is the largest float; the test compares what is stored.
  const float largest = std::numeric_limits<float>::max();
  EXPECT_EQ(depths(plane(1, 0, 0), largest, largest)[0], bits({largest})[0]);
  Mesh nearer = sheets({0.5f, 0.25f});
  Mesh pulled = sheets({0.5f});
  pulled.state.first_index = 2;
  pulled.state.depth_bias = DepthBias{-0.5f, 0};
  EXPECT_EQ(indices(draw({}, {nearer, pulled}).index), "2");
  nearer.state.depth_bias = DepthBias{-0.5f, 0};
  EXPECT_EQ(indices(draw({}, {nearer, pulled}).index), "1");
}

// Under Grid z(p) is clamped to the corners' depths before the bias is added, and m is of the plane before. With D = 0
// m is 0. These are the triangles of the second oracle's tests of G2: (0, 0), (4, 0), (0, 0.6) with z = 1/2 - x/16 -
// y/2.4, which at (1.5, 0.5) is less than 1/4; and three in a line, whose smallest depth is 3/2.
TEST_P(Modes, BiasOfSnappedI8) {
  Mesh mesh({flat(0, 0, 0.5f), flat(4, 0, 0.25f), flat(0, 0.625f, 0.25f)});
  mesh.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  mesh.state.depth_bias = DepthBias{2, 5};  // m = 0.25/0.625 = 2/5
  Image image = draw({.width = 4}, {mesh});
  EXPECT_EQ(picture(image.count, 4), "11..");
  // At (1.5, 0.5): z = 0.5 - 1.5/16 - 0.2 = 0.206.., so 1/4. At (0.5, 0.5): 0.5 - 0.03125 - 0.2 = 0.26875. Both + 4.
  EXPECT_EQ(image.depth[1], bits({4.25f})[0]);
  EXPECT_EQ(image.depth[0], bits({4.26875f})[0]);
  Mesh bent({{0, 0, 3, 1}, {1.5f, 1.75f, 1.5f, 1}, {6, 7, 4, 2}});
  bent.state.grid = Grid{0, 0, 0, GridRounding::nearest_even};
  bent.state.fill_rule = FillRule::top_right;
  bent.state.depth_bias = DepthBias{0.25f, 1024};
  EXPECT_EQ(draw({.width = 4, .height = 4}, {bent}).depth[5], bits({1.75f})[0]);
}

}  // namespace
}  // namespace surefill::modes
