// SPDX-License-Identifier: Apache-2.0
//
// Models of others (section 11 of docs/semantics.md): the exact model and those of section 6 against the oracle, every
// choice against pictures worked out by hand, and openness against the choices that it stands for.
#include "oracle/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "oracle/oracle.hpp"
#include "oracle/positions.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::oracle {
namespace {

using properties::Random;
using Triangle = std::array<Vertex, 3>;

Triangle flat(float x0, float y0, float x1, float y1, float x2, float y2) {
  return {{{x0, y0, 0, 1}, {x1, y1, 0, 1}, {x2, y2, 0, 1}}};
}

// A row of answers a line: '.' not covered, '#' covered, 'o' open.
std::string picture(const Model& model, int width, int height, const Triangle& triangle) {
  std::string text;
  for (const Cover answer : cover(model, width, height, 1, triangle)) {
    text += answer == Cover::no ? '.' : answer == Cover::yes ? '#' : 'o';
    if ((text.size() + 1) % static_cast<std::size_t>(width + 1) == 0) text += '/';
  }
  return text;
}

std::vector<std::uint32_t> exact(const Triangle& triangle, int width, int height, int samples, FillRule rule,
                                 const std::optional<Grid>& grid) {
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  Draw draw;
  draw.vertices = triangle;
  draw.indices = indices;
  draw.fill_rule = rule;
  draw.grid = grid;
  std::vector<std::uint32_t> count(static_cast<std::size_t>(width * height * samples));
  Target target;
  target.width = width, target.height = height, target.samples = samples;
  target.count = count;
  oracle::render(target, std::span<const Draw>(&draw, 1), 1);
  return count;
}

// Triangles that pass samples closely or exactly, W a power of two or any.
Triangle hard_triangle(Random& random, int size) {
  Triangle triangle{};
  const int bits = random.between(0, 2) == 0 ? 1 : random.between(1, 12);
  for (Vertex& v : triangle) {
    const float w =
        random.one_in(3) ? static_cast<float>(0.5 + 4 * random.unit()) : std::ldexp(1.0f, random.between(-9, 9));
    const auto coordinate = [&] {
      return std::ldexp(static_cast<float>(random.between(-(2 << bits), (size + 2) << bits)), -bits);
    };
    const float x = coordinate(), y = coordinate();
    v = {x * w, y * w, w / 2, w};
  }
  return triangle;
}

TEST(Model, ExactOneIsTheOracle) {
  Random random(1);
  std::uint64_t samples = 0;
  for (int n = 0; n < 3000; ++n) {
    const Triangle triangle = hard_triangle(random, 6);
    const auto rule = static_cast<FillRule>(random.below(10));
    const int pattern = n % 5 == 0 ? 4 : 1;
    Model model;
    model.front = model.back = owners_of(rule);
    const std::vector<Cover> answers = cover(model, 6, 6, pattern, triangle);
    const std::vector<std::uint32_t> expected = exact(triangle, 6, 6, pattern, rule, std::nullopt);
    for (std::size_t s = 0; s < answers.size(); ++s) {
      ASSERT_EQ(answers[s], expected[s] != 0 ? Cover::yes : Cover::no) << "case " << n << " sample " << s;
    }
    samples += answers.size();
  }
  EXPECT_GT(samples, 100000u);
}

TEST(Model, GridsAreTheOracles) {
  Random random(2);
  for (int n = 0; n < 3000; ++n) {
    const Triangle triangle = hard_triangle(random, 6);
    const auto rule = static_cast<FillRule>(random.below(8));
    const int bits = random.between(1, 12);
    const Grid grid{bits, random.between(0, 15), random.between(0, 15), static_cast<GridRounding>(random.below(3))};
    Model model;
    model.front = model.back = owners_of(rule);
    model.turned = Turned::as_grid;
    model.x.bits = model.y.bits = bits;
    model.x.rounding = model.y.rounding = grid.rounding == GridRounding::nearest_even ? Rounding::nearest_even
                                          : grid.rounding == GridRounding::nearest_up ? Rounding::nearest_up
                                                                                      : Rounding::truncate;
    model.x.grid_offset = std::ldexp(grid.offset_x, -bits - 4);
    model.y.grid_offset = std::ldexp(grid.offset_y, -bits - 4);
    const std::vector<Cover> answers = cover(model, 6, 6, 1, triangle);
    const std::vector<std::uint32_t> expected = exact(triangle, 6, 6, 1, rule, grid);
    for (std::size_t s = 0; s < answers.size(); ++s) {
      ASSERT_EQ(answers[s], expected[s] != 0 ? Cover::yes : Cover::no) << "case " << n << " sample " << s;
    }
  }
}

// What is not open is so for every choice: blurred by r, whatever lies within r of it, snapped or not, agrees.
TEST(Model, BlurIsOpenOnlyWhereChoicesDiffer) {
  Random random(3);
  std::uint64_t open = 0, judged = 0;
  for (int n = 0; n < 2000; ++n) {
    const Triangle triangle = hard_triangle(random, 6);
    Model sharp, blurred;
    sharp.x.bits = sharp.y.bits = blurred.x.bits = blurred.y.bits = n % 3 == 0 ? -1 : random.between(1, 8);
    sharp.turned = Turned::as_grid;
    blurred.x.blur = blurred.y.blur = 0x1p-6;
    const std::vector<Cover> allowed = cover(blurred, 6, 6, 1, triangle);
    for (int choice = 0; choice < 4; ++choice) {
      Triangle moved = triangle;
      for (Vertex& v : moved) {
        v.x += v.w * static_cast<float>(random.unit() - 0.5) * 0x1p-6f;
        v.y += v.w * static_cast<float>(random.unit() - 0.5) * 0x1p-6f;
      }
      const std::vector<Cover> answers = cover(sharp, 6, 6, 1, moved);
      for (std::size_t s = 0; s < answers.size(); ++s) {
        ++(allowed[s] == Cover::open ? open : judged);
        if (allowed[s] != Cover::open) {
          ASSERT_EQ(answers[s], allowed[s]) << "case " << n << " sample " << s;
        }
      }
    }
  }
  EXPECT_GT(open, 1000u);
  EXPECT_GT(judged, 20 * open);
}

TEST(Model, ChoicesByHand) {
  const Triangle half = flat(0.5f, 0.5f, 2.5f, 0.5f, 0.5f, 2.5f);  // all three edges pass samples
  Model model;
  EXPECT_EQ(picture(model, 3, 3, half), "##./#../.../");
  model.front = owners_of(FillRule::closed);
  EXPECT_EQ(picture(model, 3, 3, half), "###/##./#../");
  model.front = owners_of(FillRule::open);
  EXPECT_EQ(picture(model, 3, 3, half), ".../.../.../");
  model.front.open = bit(Side::bottom_right);
  model.front.owned = 0xFF;
  EXPECT_EQ(picture(model, 3, 3, half), "##o/#o./o../");
  model.vertices = AtVertices::covered;
  EXPECT_EQ(picture(model, 3, 3, half), "###/#o./#../");
  model = {};
  model.back = owners_of(FillRule::bottom_right);
  EXPECT_EQ(picture(model, 3, 3, {half[0], half[2], half[1]}), ".../.#./.../");  // a back face

  // The sample at the pixel's corner, and to its right.
  model = {};
  model.x.place = model.y.place = 0;
  EXPECT_EQ(picture(model, 4, 2, flat(0, 0, 2, 0, 0, 2)), "##../#.../");
  model.x.place = 0.75;
  EXPECT_EQ(picture(model, 4, 2, flat(0, 0, 2.5f, 0, 0, 2.5f)), "##../#.../");
  // A viewport of 8 pixels less one: 4 goes to 3.5, whose sample the left edge owns. Moved by 1/4 it does not.
  model = {};
  model.x.lacks = 1;
  EXPECT_EQ(picture(model, 8, 1, flat(4, -2, 12, -2, 4, 20)), "...#####/");
  model.x.moved = 0.25;
  EXPECT_EQ(picture(model, 8, 1, flat(4, -2, 12, -2, 4, 20)), "....####/");
  // Whole pixels by floor, ceiling and towards zero: an edge at -0.5 and one at 2.5.
  const Triangle wide = flat(-0.5f, -9, -0.5f, 9, 2.5f, 0);
  model = {};
  model.x.bits = 0;
  model.x.rounding = Rounding::floor;
  EXPECT_EQ(picture(model, 3, 1, wide), "##./");
  model.x.rounding = Rounding::ceiling;
  EXPECT_EQ(picture(model, 3, 1, wide), "###/");
  // Culled always, and left out for its W.
  model = {};
  model.culled = Cull::front;
  EXPECT_EQ(picture(model, 3, 3, half), ".../.../.../");
  model.culled = Cull::back;
  EXPECT_EQ(picture(model, 3, 3, half), "##./#../.../");
  model.least_w = 2;
  EXPECT_EQ(picture(model, 3, 3, half), "ooo/oo./o../");
  // Behind the eye only what is far from every edge is certain.
  model = {};
  const Triangle behind{{{-8, -8, 0, 1}, {40, -8, 0, 1}, {0, 80, 0, -1}}};
  const std::string answers = picture(model, 2, 2, behind);
  EXPECT_NE(answers.find('#'), std::string::npos) << answers;
}

// R8: what is in a line covers nothing, unless the model says that it is drawn; then who knows what.
TEST(Model, TrianglesInALineAreOpenWhereTheyAreDrawn) {
  const std::array<Vertex, 3> flat{{{0.5f, 0.5f, 0, 1}, {2.5f, 2.5f, 0, 1}, {1.5f, 1.5f, 0, 1}}};
  Model model;
  const std::vector<Cover> none = cover(model, 4, 4, 1, flat);
  EXPECT_EQ(std::count(none.begin(), none.end(), Cover::no), 16);
  model.draws_flat = true;
  const std::vector<Cover> line = cover(model, 4, 4, 1, flat);
  for (int s = 0; s < 16; ++s)
    EXPECT_EQ(line[static_cast<std::size_t>(s)], s == 0 || s == 5 || s == 10 ? Cover::open : Cover::no);
}

// R8: on a grid, who compares what came with an area that is next to nothing has that rounded; in double this one is
// positive, and negative as a real number.
TEST(Model, ThinTrianglesAreOpenOnAGrid) {
  const std::array<Vertex, 3> thin{{{-0x1.0f899p+8f, 0x1.32b9p+4f, 0, 0x1.32914p+8f},
                                    {0x1.1ffbfp+7f, -0x1.74a44p+7f, 0, 0x1.4421p+6f},
                                    {-0x1.2b472cp+9f, 0x1.fd3dap+6f, 0, 0x1.1713fcp+9f}}};
  Model model;
  model.x.bits = model.y.bits = 2;
  model.x.rounding = model.y.rounding = Rounding::floor;
  model.x.place = model.y.place = -0.5;
  EXPECT_EQ(cover(model, 1, 1, 1, thin)[0], Cover::open);
  model.turned = Turned::as_grid;  // D decides nothing
  EXPECT_EQ(cover(model, 1, 1, 1, thin)[0], Cover::yes);
}

// Pieces of a clipped triangle may turn where they are snapped: who culls by what came of them is right, too.
TEST(Model, ClippedTrianglesThatAreCulledAreOpenNearTheirEdges) {
  Model model;
  model.x.bits = model.y.bits = 8, model.culled = Cull::back;
  // D < 0 by less than 2^-20 of its terms.
  const std::array<Vertex, 3> thin{{{0x1.8fc8p-5F, -0x1.e53ap-2F, 0, -0x1.53p-8F},
                                    {0x1.d2cp-18F, -0x1.168p-16F, 0, 0x1.378p-17F},
                                    {-0x1.8ec8p-18F, 0x1.e55ap-15F, 0, 0x1.63p-21F}}};
  EXPECT_EQ(cover(model, 1, 1, 1, thin)[0], Cover::open);
  // Half of the plane, seen from behind: clear within, open at its border, and clear beside it.
  const std::array<Vertex, 3> wide{{{4, 0, 0, 1}, {4, 8, 0, 1}, {4, 4, 0, -1}}};
  const std::vector<Cover> answers = cover(model, 8, 8, 1, wide);
  std::size_t open = 0;
  for (const Cover answer : answers) {
    EXPECT_NE(answer, Cover::yes);
    open += answer == Cover::open;
  }
  EXPECT_LT(open, answers.size() / 2);
  model.culled = Cull::none;
  const std::vector<Cover> drawn = cover(model, 8, 8, 1, wide);
  EXPECT_GT(std::count(drawn.begin(), drawn.end(), Cover::yes), 0);
  EXPECT_EQ(static_cast<std::size_t>(std::count(drawn.begin(), drawn.end(), Cover::open)), open);
}

TEST(Model, RoundingsDifferAtTiesOnly) {
  // An edge at 0.5 of a grid of whole pixels, and at -0.5 off the screen: seen through a slanted edge's other end.
  const auto covers = [](Rounding rounding, float edge) {
    Model model;
    model.x.bits = 0;
    model.x.rounding = rounding;
    model.x.place = 0;  // the sample of pixel k is at k
    std::string row = picture(model, 4, 1, flat(edge, -9, edge, 9, 8, 0));
    return row.find('#');
  };
  EXPECT_EQ(covers(Rounding::nearest_even, 1.5f), 2u);
  EXPECT_EQ(covers(Rounding::nearest_even, 0.5f), 0u);
  EXPECT_EQ(covers(Rounding::nearest_up, 0.5f), 1u);
  EXPECT_EQ(covers(Rounding::nearest_down, 1.5f), 1u);
  EXPECT_EQ(covers(Rounding::nearest_away, 0.5f), 1u);
  EXPECT_EQ(covers(Rounding::floor, 1.75f), 1u);
  EXPECT_EQ(covers(Rounding::ceiling, 1.25f), 2u);
  EXPECT_EQ(covers(Rounding::truncate, 1.75f), 1u);
}

// R5 in rational numbers, from the page: o + k 2^-b.
Rational snapped_rationally(const Rational& position, const AxisModel& axis) {
  const Rational offset(axis.grid_offset), step(std::ldexp(1.0, -axis.bits)), value((position - offset) / step);
  const Rational half(1, 2), down = floor_of(value), up = -floor_of(-value);
  const auto nearest = [&](const Rational& at_tie) {
    return value - down == half ? at_tie : Rational(floor_of(value + half));
  };
  const Rational towards = value < 0 ? up : down, away = value < 0 ? down : up;
  const Rational even = floor_of(down / 2) * 2 == down ? down : up;
  const Rational k = axis.rounding == Rounding::nearest_even   ? nearest(even)
                     : axis.rounding == Rounding::nearest_up   ? nearest(up)
                     : axis.rounding == Rounding::nearest_down ? nearest(down)
                     : axis.rounding == Rounding::nearest_away ? nearest(away)
                     : axis.rounding == Rounding::truncate     ? towards
                     : axis.rounding == Rounding::floor        ? down
                                                               : up;
  return offset + k * step;
}

TEST(Model, PositionsAreThoseOfRationalNumbers) {
  Random random(0x905);
  for (int n = 0; n < 40000; ++n) {
    AxisModel axis;
    axis.bits = random.between(0, 10);
    axis.rounding = static_cast<Rounding>(random.between(0, 6));
    axis.grid_offset = random.between(0, 1) * std::ldexp(random.between(0, 15), -axis.bits - 4);
    axis.lacks = random.between(0, 3) == 0 ? 1 : 0;
    axis.moved = random.between(0, 2) * 0.125;
    axis.blur = random.between(0, 2) * 0x1p-16;
    const int length = random.between(3, 40);
    // Every third one is a tie, or beside it.
    const auto w = static_cast<float>(random.between(1, 4095)) / 64;
    const double tie = std::ldexp(random.between(-4000, 4000), -axis.bits - 1) + axis.grid_offset;
    const auto x = static_cast<float>((n % 3 == 0 ? tie : random.between(-9999, 9999) / 97.0) * w);
    Interval got;
    ASSERT_TRUE(place_vertex(axis, length, x, w, got));
    const bool divided = w != std::exp2(std::round(std::log2(w)));
    const Rational blur(divided ? std::max(axis.blur, axis.divided_blur) : axis.blur);
    const Rational q = Rational(x) / Rational(w) * (length - Rational(axis.lacks)) / length + Rational(axis.moved);
    EXPECT_EQ(end_of(got, 0), snapped_rationally(q - blur, axis)) << n;
    EXPECT_EQ(end_of(got, 1), snapped_rationally(q + blur, axis)) << n;
    EXPECT_EQ(got.is_point(), end_of(got, 0) == end_of(got, 1)) << n;
  }
}

// R9: what may be cut is open within d = 1/16 of its edges, and as before where it is not cut.
TEST(Model, WhatMayBeCutIsOpenNearItsEdges) {
  // The edge from the upper right to the lower left passes the samples of a diagonal; the depth is Z.
  const auto steep = [](float near, float far) { return Triangle{{{0, 0, near, 1}, {4, 0, far, 1}, {0, 4, far, 1}}}; };
  Model model;
  EXPECT_EQ(picture(model, 4, 4, steep(-1, 2)), "###./##../#.../..../") << "nothing clips depth";
  model.clipped = {0, 1};
  EXPECT_EQ(picture(model, 4, 4, steep(0, 1)), "###./##../#.../..../") << "at the limits is not beyond them";
  EXPECT_EQ(picture(model, 4, 4, steep(0.5f, 0.5f)), "###./##../#.../..../");
  const std::string cut = "###o/##o./#o../o.../";
  EXPECT_EQ(picture(model, 4, 4, steep(-1, 0.5f)), cut);
  EXPECT_EQ(picture(model, 4, 4, steep(0.5f, 2)), cut);
  EXPECT_EQ(picture(model, 4, 4, steep(0.5f, 0x1.fffffep-1f)), cut) << "within roundings of a limit";
  model.clipped = {-INFINITY, 1};
  EXPECT_EQ(picture(model, 4, 4, steep(-1, 0.5f)), "###./##../#.../..../") << "no near plane";
  // A band of two pixels beyond the target.
  model = {};
  model.band = 2;
  EXPECT_EQ(picture(model, 4, 4, flat(-2, 6, -2, -2, 6, -2)), "###./##../#.../..../");
  EXPECT_EQ(picture(model, 4, 4, flat(-3, 7, -3, -3, 7, -3)), cut);
  // Below the least W it may be left out as a whole.
  model = {};
  model.least_w = 2;
  EXPECT_EQ(picture(model, 4, 4, steep(0, 0)), "oooo/ooo./oo../o.../");
  // Small ones are left out, so what is left of one that is cut may be.
  model = {};
  model.clipped = {0, 1};
  model.least_area = 0.25;
  EXPECT_EQ(picture(model, 4, 4, steep(-1, 0.5f)), "oooo/ooo./oo../o.../");
  // Vertices of depths that are far apart.
  model.least_area = 0;
  EXPECT_EQ(picture(model, 2, 2, {{{0, 0, -1, 1}, {512 * 4, 0, 0, 512}, {0, 4, 0, 1}}}), "oo/oo/");
}

// R8: of less than so many square pixels.
TEST(Model, SmallTrianglesMayBeLeftOut) {
  Model model;
  const std::array<Vertex, 3> half{
      {{0.25f, 0.25f, 0, 1}, {1.25f, 0.25f, 0, 1}, {0.25f, 1.25f, 0, 1}}};  // of half a pixel
  const auto at = [&](double least) {
    model.least_area = least;
    return cover(model, 1, 1, 1, half)[0];
  };
  EXPECT_EQ(at(0.49), Cover::yes);
  EXPECT_EQ(at(0.51), Cover::open);
}

TEST(Model, ARuleIsWatertightIfBothFacingsGoByIt) {
  for (int rule = 0; rule < 8; ++rule) {
    Model model;
    model.front = model.back = owners_of(static_cast<FillRule>(rule));
    EXPECT_EQ(watertight_rule(model), static_cast<FillRule>(rule));
    model.back = owners_of(FillRule::closed);
    EXPECT_EQ(watertight_rule(model), std::nullopt);
  }
}

}  // namespace
}  // namespace surefill::oracle
