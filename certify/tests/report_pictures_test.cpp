// SPDX-License-Identifier: Apache-2.0
//
// The pictures of a certificate's page: what has to be seen in them is there.
#include "certify/report/report_pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "certify/report/report_values.hpp"

namespace surefill::certify {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++number;
  return number;
}

// Its upright edge passes 1.5/256 pixel to the right of the sample, and on the grid of 8 bits 2/256.
constexpr const char* kScene = R"(surefill-scene 1
target 2 1
draw
  %s
  vertex 0x1.03p-1 -4 0 1
  vertex 0x1.03p-1 8 0 1
  vertex -9 2 0 1
  triangle 0 1 2
end
)";

std::string scene_with(const std::string& line) {
  std::string text = kScene;
  return text.replace(text.find("%s"), 2, line);
}

Evidence of_two_pixels() {
  Evidence evidence;
  evidence.width = 2;
  evidence.height = 1;
  evidence.expected = {1, 0};
  evidence.actual = {0, 0};
  evidence.differs = {1, 0};
  evidence.what = "count";
  return evidence;
}

TEST(ReportPictures, AGridMovesOutlines) {
  const auto plain = outlines(scene_with("fill-rule top-left"));
  ASSERT_EQ(plain.size(), 1u);
  EXPECT_TRUE(plain[0].snapped.empty());
  const auto snapped = outlines(scene_with("grid 8 0 0 nearest-even"));
  ASSERT_EQ(snapped.size(), 1u);
  ASSERT_EQ(snapped[0].snapped.size(), 3u);
  EXPECT_EQ(snapped[0].snapped[0].x, 0.5078125) << "129.5 steps are 130: to the even one";
  EXPECT_EQ(snapped[0].given[0].x, 0x1.03p-1);
  EXPECT_TRUE(outlines("no scene").empty());
}

TEST(ReportPictures, TheInsetIsAsLargeAsTheDifference) {
  const std::string plain = inset(of_two_pixels(), outlines(scene_with("fill-rule top-left")));
  EXPECT_TRUE(has(plain, "lies 0.00586 pixels from an edge; this is 0.0293 pixels wide")) << plain;
  EXPECT_FALSE(has(plain, "dashed"));
  const std::string grid = inset(of_two_pixels(), outlines(scene_with("grid 8 0 0 nearest-even")));
  EXPECT_TRUE(has(grid, "this is 0.0391 pixels wide (dashed: before the grid)")) << grid;
  EXPECT_EQ(count(grid, "stroke-dasharray"), 1u) << "one edge of three is within";
  Evidence none = of_two_pixels();
  none.differs = {0, 1};
  EXPECT_EQ(inset(none, outlines(scene_with("grid 8 0 0 nearest-even"))), "") << "no edge is near";
}

TEST(ReportPictures, SamplesHaveACrossAndANumber) {
  const Evidence evidence = of_two_pixels();
  const std::string svg = picture(evidence, evidence.actual, {0, 0, 2, 1}, {}, "Got", true);
  EXPECT_EQ(count(svg, "<path "), 2u);
  EXPECT_EQ(count(svg, "</text>"), 2u);
  EXPECT_EQ(count(svg, "#d01f1f"), 1u) << "one ring";
}

TEST(ReportPictures, NumbersHaveTheDigitsThatTellThemApart) {
  const auto pair = [](const char* expected, const char* actual) {
    const Pair both = told_apart(expected, actual);
    return both.expected + " | " + both.actual;
  };
  EXPECT_EQ(pair("0.5", "0.25"), "0.5 | 0.25");
  EXPECT_EQ(pair("0.333333343", "0.333333373"), "0.3333333 | 0.3333334");
  EXPECT_EQ(pair("0.25 to 0.75", "0.125"), "0.25 | 0.125");
  EXPECT_EQ(pair("0.25 to 0.75", "0.875"), "0.75 | 0.875");
  EXPECT_EQ(pair("0.123456789", "nan"), "0.1235 | nan");
  EXPECT_EQ(pair("none", "3"), "none | 3");
  EXPECT_EQ(readable("0x1p-1 (0.5) to 0x1p+0 (1)"), "0.5 to 1");
}

TEST(ReportPictures, AllWrongValuesAreShown) {
  Evidence evidence;
  evidence.width = 20;
  evidence.height = 1;
  evidence.expected.assign(20, 1);
  evidence.actual = evidence.expected;
  evidence.differs.assign(20, 0);
  evidence.what = "values";
  for (const std::size_t s : {1u, 2u, 4u}) {
    evidence.differs[s] = 1;
    evidence.values.push_back({s, "depth", "0.5", s == 4 ? "nan" : "0.50390625", s == 4 ? HUGE_VAL : 0x1p-8});
  }
  const View view = zoomed(evidence);
  const std::string few = values_html(evidence, view);
  EXPECT_EQ(count(few, ">0.504</text>"), 2u) << few;
  EXPECT_EQ(count(few, ">nan</text>"), 1u);
  EXPECT_EQ(count(few, "+0.00391"), 2u) << "two of the three are so far off, at the scale of the difference";
  EXPECT_FALSE(has(few, "How far off")) << "all have room as numbers";
  EXPECT_TRUE(has(few, "3 wrong values as numbers"));
  evidence.differs[19] = 1;
  evidence.values.push_back({19, "b <0>", "1", "0.875", 0.125});
  const std::string many = values_html(evidence, view);
  EXPECT_TRUE(has(many, "How far off") && has(many, "0.125") && has(many, "no number")) << many;
  EXPECT_TRUE(has(many, "depth and b &lt;0&gt;"));
  EXPECT_EQ(values_html(of_two_pixels(), view), "");
}

TEST(ReportPictures, OpenCountsAreQuestions) {
  Evidence evidence = of_two_pixels();
  evidence.expected[1] = properties::Exhibit::kOpenCount;
  EXPECT_EQ(count(picture(evidence, evidence.expected, {0, 0, 2, 1}, {}, "Expected", false), ">?</text>"), 1u);
}

TEST(ReportPictures, TurnsAreDots) {
  const std::string svg = turns_picture(
      "left edge  turns at  0: +0.49999994 px  1: +0.5 px\n"
      "right edge turns at  0: not at all (mixed over 0.375 px)  1: -0.5 px (mixed over 1e-08 px)  4: -0.5 px\n"
      "upper edge turns at  0: not at all\n");
  EXPECT_EQ(count(svg, "<circle"), 4u) << svg;
  EXPECT_TRUE(has(svg, ">+0.5<") && has(svg, ">-0.5<")) << svg;
  EXPECT_EQ(count(svg, "not at all"), 1u);
  EXPECT_EQ(turns_picture("nothing of the kind"), "");
}

}  // namespace
}  // namespace surefill::certify
