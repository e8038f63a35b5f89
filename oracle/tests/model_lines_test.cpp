// SPDX-License-Identifier: Apache-2.0
//
// Lines and points under models of others (R17 to R21 of docs/semantics.md): the exact model against the oracle, every
// shape against pictures worked out by hand, and openness against the choices that it stands for.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "oracle/model.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::oracle {
namespace {

using properties::Random;
using Ends = std::array<Vertex, 2>;

Ends flat(float x0, float y0, float x1, float y1) {
  return {{{x0, y0, 0, 1}, {x1, y1, 0, 1}}};
}

std::string picture(const std::vector<Cover>& answers, int width) {
  std::string text;
  for (const Cover answer : answers) {
    text += answer == Cover::no ? '.' : answer == Cover::yes ? '#' : 'o';
    if ((text.size() + 1) % static_cast<std::size_t>(width + 1) == 0) text += '/';
  }
  return text;
}

std::vector<std::uint32_t> exact(const Ends& ends, Primitive primitive, std::optional<float> line_width, FillRule rule,
                                 int size) {
  const std::array<std::uint32_t, 2> indices{0, 1};
  Draw draw;
  draw.vertices = ends;
  draw.primitive = primitive;
  draw.indices = std::span<const std::uint32_t>(indices).first(primitive == Primitive::lines ? 2 : 1);
  draw.width = line_width;
  draw.fill_rule = rule;
  std::vector<std::uint32_t> count(static_cast<std::size_t>(size * size));
  Target target;
  target.width = target.height = size;
  target.count = count;
  oracle::render(target, std::span<const Draw>(&draw, 1), 1);
  return count;
}

// On lattices of samples and diamonds, or anywhere; W a power of two or any.
Ends hard_line(Random& random, int size) {
  Ends ends{};
  const int bits = random.between(0, 2) == 0 ? 1 : random.between(1, 12);
  for (Vertex& v : ends) {
    const float w =
        random.one_in(3) ? static_cast<float>(0.5 + 4 * random.unit()) : std::ldexp(1.0f, random.between(-9, 9));
    const auto coordinate = [&] {
      return std::ldexp(static_cast<float>(random.between(-(2 << bits), (size + 2) << bits)), -bits);
    };
    const float x = coordinate(), y = coordinate();
    v = {x * w, y * w, w / 2, w};
  }
  return ends;
}

TEST(ModelLines, ExactOneIsTheOracle) {
  Random random(1);
  std::uint64_t covered = 0;
  for (int n = 0; n < 3000; ++n) {
    const Ends ends = hard_line(random, 6);
    const auto rule = static_cast<FillRule>(random.below(8));
    std::optional<float> line_width;
    if (n % 2 == 0) line_width = static_cast<float>(random.between(1, 20)) / 4;
    Model model;
    model.lines.outline.ties = model.points.outline.ties = rule;
    for (const Primitive primitive : {Primitive::lines, Primitive::points}) {
      const std::vector<Cover> answers = primitive == Primitive::lines
                                             ? cover_line(model, 6, 6, ends, line_width)
                                             : cover_point(model, 6, 6, ends[0], line_width.value_or(1));
      const std::vector<std::uint32_t> expected = exact(ends, primitive, line_width, rule, 6);
      for (std::size_t s = 0; s < answers.size(); ++s) {
        ASSERT_EQ(answers[s], expected[s] != 0 ? Cover::yes : Cover::no)
            << "case " << n << " sample " << s << " of " << static_cast<int>(primitive);
        covered += expected[s];
      }
    }
  }
  EXPECT_GT(covered, 10000u);
}

// What is not open is so for every choice.
TEST(ModelLines, BlurIsOpenOnlyWhereChoicesDiffer) {
  Random random(2);
  std::uint64_t open = 0, judged = 0;
  for (int n = 0; n < 1500; ++n) {
    Ends ends = hard_line(random, 6);
    for (Vertex& v : ends) v = {v.x / v.w, v.y / v.w, 0, 1};
    Model sharp;
    sharp.lines.thin = sharp.lines.wide = static_cast<LineShape>(n % 3);
    sharp.lines.left_out = static_cast<LeftOut>(random.below(4));
    sharp.lines.whole_pixels = random.one_in(4);
    sharp.lines.outline.ties.reset();
    Model blurred = sharp;
    blurred.lines.blur = blurred.points.blur = 0x1p-6;
    std::optional<float> line_width;
    if (random.one_in(2)) line_width = static_cast<float>(random.between(1, 20)) / 4;
    const std::vector<Cover> allowed = cover_line(blurred, 6, 6, ends, line_width),
                             points = cover_point(blurred, 6, 6, ends[0], line_width.value_or(1));
    for (int choice = 0; choice < 4; ++choice) {
      Ends moved = ends;
      for (Vertex& v : moved) {
        v.x += static_cast<float>(random.unit() - 0.5) * 0x1p-5f;
        v.y += static_cast<float>(random.unit() - 0.5) * 0x1p-5f;
      }
      const auto compare = [&](const std::vector<Cover>& wide, const std::vector<Cover>& one) {
        for (std::size_t s = 0; s < one.size(); ++s) {
          ++(wide[s] == Cover::open ? open : judged);
          if (wide[s] == Cover::open || one[s] == Cover::open) continue;
          ASSERT_EQ(one[s], wide[s]) << "case " << n << " sample " << s;
        }
      };
      compare(allowed, cover_line(sharp, 6, 6, moved, line_width));
      compare(points, cover_point(sharp, 6, 6, moved[0], line_width.value_or(1)));
    }
  }
  EXPECT_GT(open, 1000u);
  EXPECT_GT(judged, 10 * open);
}

TEST(ModelLines, ShapesByHand) {
  const Ends level = flat(0.5f, 1.5f, 3.5f, 1.5f);  // from sample to sample
  Model model;
  const auto line = [&](const Ends& ends, std::optional<float> width, int size = 5) {
    return picture(cover_line(model, size, 3, ends, width), size);
  };
  EXPECT_EQ(line(level, std::nullopt), "...../###../...../");
  model.lines.left_out = LeftOut::first;
  EXPECT_EQ(line(level, std::nullopt), "...../.###./...../");
  model.lines.left_out = LeftOut::none;
  EXPECT_EQ(line(level, std::nullopt), "...../####./...../");
  model.lines.left_out = LeftOut::both;
  EXPECT_EQ(line(level, std::nullopt), "...../.##../...../");
  model = {};
  model.lines.thin = LineShape::tolerant;
  EXPECT_EQ(line(level, std::nullopt, 6), "ooooo./ooooo./ooooo./");
  // Ends in the pixels of the same samples.
  model = {};
  model.lines.whole_pixels = true;
  EXPECT_EQ(line(flat(0.9f, 1.1f, 3.1f, 1.9f), std::nullopt), "...../###../...../");
  model.lines.outline.ties.reset();
  EXPECT_EQ(line(flat(0.5f, 0.5f, 2.5f, 1.5f), std::nullopt),
            "#o.../.o.../...../");  // half a pixel down after one step
  // Columns of three pixels; of two, half a pixel further up.
  model = {};
  model.lines.wide = LineShape::diamond;
  EXPECT_EQ(line(level, 3.0f), "###../###../###../");
  EXPECT_EQ(line(flat(0.5f, 1.75f, 3.5f, 1.75f), 2.0f), "...../###../###../");
  EXPECT_EQ(line(flat(0.5f, 1.25f, 3.5f, 1.25f), 1.7f), "###../###../...../");
  EXPECT_EQ(line(flat(0.5f, 1.25f, 3.5f, 1.25f), 0.2f), "...../###../...../");
  EXPECT_EQ(line(flat(0.5f, 1.25f, 3.5f, 1.25f), 1.5f), "ooo../###../...../");  // one or two
  // M7's, and a rectangle, whose ends slant.
  model = {};
  const Ends slanted = flat(1.3f, 0.5f, 3.7f, 2.9f);
  EXPECT_EQ(line(slanted, 1.25f), ".#.../..#../...#./");
  model.lines.wide = LineShape::rectangle;
  EXPECT_EQ(line(slanted, 1.25f), ".#.../.##../..##./");
  // Widths.
  model = {};
  model.lines.outline.most_width = 1;
  EXPECT_EQ(line(flat(0.25f, 1.5f, 3.25f, 1.5f), 3.0f), "...../###../...../");
  model.lines.outline.most_width = 8;
  model.lines.outline.width_within = 0.25;
  EXPECT_EQ(line(flat(0.25f, 1.5f, 3.25f, 1.5f), 2.0f), "ooo../###../ooo../");
  model = {};
  model.lines.outline.border = 0.125;
  EXPECT_EQ(line(flat(0.5f, 1.5f, 3.25f, 1.5f), 1.0f), "...../o##../...../");
}

// R18: what a wide line of another rule may cover, about its ends and by either axis.
TEST(ModelLines, TolerantOfAWidth) {
  Model model;
  model.lines.wide = LineShape::tolerant;
  const auto line = [&](const Ends& ends, float width, int size) {
    return picture(cover_line(model, size, size, ends, width), size);
  };
  // Within one diamond, so that M7 covers nothing: the column and the row of three pixels about it, and a pixel around them.
  EXPECT_EQ(line(flat(2.6f, 2.5f, 2.9f, 2.5f), 3.0f, 6), ".ooo../ooooo./ooooo./ooooo./.ooo../....../");
  EXPECT_EQ(line(flat(2.6f, 2.5f, 2.9f, 2.5f), 1.0f, 6), "....../.ooo../.ooo../.ooo../....../....../");
  // |dx| and |dy| differ by 1.9 pixels, and by 2.1: rows of 15 pixels are open, too, and not.
  const auto row = [&](float y) { return line(flat(10.5f, 4.5f, 16.5f, y), 15.0f, 24).substr(6 * 25, 24); };
  EXPECT_EQ(row(8.6f).find('o'), 3u) << row(8.6f);
  EXPECT_EQ(row(8.4f).find('o'), 9u) << row(8.4f);
}

TEST(ModelLines, WhatIsBehindIsOpenNearby) {
  Model model;
  const Ends ray{{{2, 8, 0, 1}, {10, 0, 0, -0.001f}}};  // to the right and up
  const std::string answers = picture(cover_line(model, 16, 16, ray, std::nullopt), 16);
  EXPECT_EQ(answers.find('#'), std::string::npos) << answers;
  EXPECT_NE(answers.find('o'), std::string::npos) << answers;
  EXPECT_GT(std::count(answers.begin(), answers.end(), '.'), 100) << answers;
  model.lines.thin = LineShape::unknown;
  const std::string unknown = picture(cover_line(model, 16, 16, flat(8, 8, 9, 8), std::nullopt), 16);
  EXPECT_EQ(std::count(unknown.begin(), unknown.end(), 'o'), 42) << unknown;
}

TEST(ModelLines, PointsByHand) {
  Model model;
  const auto point = [&](float x, float y, float size) {
    return picture(cover_point(model, 5, 3, {x, y, 0, 1}, size), 5);
  };
  EXPECT_EQ(point(2.5f, 1.5f, 1), "...../..#../...../");
  EXPECT_EQ(point(2.5f, 1.5f, 3), ".###./.###./.###./");
  EXPECT_EQ(point(2, 1.5f, 1), "...../.#.../...../");  // between two: the left one, by top_left
  model.points.outline.ties.reset();
  EXPECT_EQ(point(2, 1.5f, 1), "...../.oo../...../");
  model.points.outline.border = 0.25;
  EXPECT_EQ(point(2.5f, 1.5f, 2), ".ooo./.o#o./.ooo./");
  model = {};
  EXPECT_EQ(point(-0.25f, 1.5f, 2), "#..../#..../...../");
  model.points.clipped_whole = true;
  EXPECT_NE(point(-0.25f, 1.5f, 2).find('o'), std::string::npos);
  model.points.known = false;
  EXPECT_EQ(picture(cover_point(model, 9, 1, {4.5f, 0.5f, 0, 1}, 1), 9), "..ooooo../");
}

}  // namespace
}  // namespace surefill::oracle
