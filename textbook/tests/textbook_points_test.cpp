// SPDX-License-Identifier: Apache-2.0
//
// Points and lines of the textbook cover what M7 says, and connected strips hit each column once.
#include "oracle/points_lines.hpp"
#include "textbook/points_lines.hpp"
#include "textbook/tests/textbook_check.hpp"

namespace surefill::properties {
namespace {

float any_size(Random& random) {
  return random.one_in(2) ? static_cast<float>(random.between(1, 24)) / 4
                          : static_cast<float>(std::ldexp(random.unit() + 1e-9, random.between(-30, 4)));
}

struct Hits {
  std::atomic<std::uint64_t> points{0}, lines{0}, wide{0};
};

// The first vertex as a point, the first edge as lines.
std::string decide_points(const TriangleCase& c, float size, Hits& hits) {
  if (!c.all_finite()) return "";
  const Vertex &v0 = c.vertices[0], &v1 = c.vertices[1];
  const textbook::Line line(v0, v1, c.rule);
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      const SamplePosition p{x + 0.5, y + 0.5};
      const bool point = oracle::point_covers(v0, size, p.x, p.y, c.rule),
                 thin = oracle::line_covers(v0, v1, p.x, p.y, c.rule),
                 broad = oracle::wide_line_covers(v0, v1, size, p.x, p.y, c.rule);
      const char* wrong = textbook::point_covers(v0, size, p, c.rule) != point ? "point"
                          : line.exits_diamond(p) != thin                      ? "line"
                          : line.covers_wide(size, p) != broad                 ? "wide line"
                                                                               : nullptr;
      if (wrong != nullptr) {
        return wrong + (" at pixel " + std::to_string(x) + ", " + std::to_string(y)) + ", size " + text(size) +
               c.text();
      }
      hits.points += point ? 1u : 0u, hits.lines += thin ? 1u : 0u, hits.wide += broad ? 1u : 0u;
    }
  }
  return "";
}

TEST(TextbookPoints, CoverWhatTheOracleSays) {
  Hits hits;
  for_each_case(textbook_scenes(1'000), [&hits](std::uint64_t n) {
    TriangleCase c = random_triangle(n, false, 8);
    Random random(n);
    // Half of the ends lie on samples or corners of diamonds.
    for (Vertex& v : c.vertices) {
      if (random.one_in(2)) {
        const auto w = static_cast<float>(random.one_in(8) ? -1 : random.between(1, 3));
        v = {static_cast<float>(random.between(-2, 2 * c.width + 2)) / 2 * w,
             static_cast<float>(random.between(-2, 2 * c.height + 2)) / 2 * w, 0, w};
      }
    }
    return decide_points(c, any_size(random), hits);
  });
  EXPECT_GT(hits.points, textbook_scenes(1'000));
  EXPECT_GT(hits.lines, textbook_scenes(1'000));
  EXPECT_GT(hits.wide, textbook_scenes(1'000));
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 10, false);
  const auto decide = [&](std::uint64_t n) { return decide_points(cases[n], static_cast<float>(1 + n % 4), hits); };
  for_each_case(cases.size(), decide, Cases::corpus);
}

// A strip that goes in one direction, never steeper than 45 degrees to it (and, where that is y, always flatter, since
// at 45 degrees x is the major axis): every column, or row, between its ends is hit once, by thin lines and by lines of
// width 1.
TEST(TextbookLines, AConnectedStripHitsEachColumnOrRowOnce) {
  enum Heading { kRight, kLeft, kDown, kUp };
  for_each_case(textbook_scenes(1'000), [](std::uint64_t n) -> std::string {
    Random random(n);
    const auto rule = static_cast<FillRule>(random.below(8));
    const auto heading = static_cast<Heading>(random.below(4));
    const auto at = [heading](double along, double across) {
      const double forwards = heading == kRight || heading == kDown ? along : 12 - along;
      return heading == kRight || heading == kLeft ? SamplePosition{forwards, across}
                                                   : SamplePosition{across, forwards};
    };
    const int units = random.one_in(2) ? 2 : 16;  // of a pixel: halves lie on samples and on corners of diamonds
    int along = random.between(-units, units), across = 6 * units + random.between(-units, units);
    const double first = static_cast<double>(along) / units;
    double last = first, low = 100, high = -100;
    std::vector<Vertex> strip;
    while (along < 12 * units) {
      last = static_cast<double>(along) / units;
      const double aside = static_cast<double>(across) / units;
      low = std::min(low, aside), high = std::max(high, aside);
      const SamplePosition p = at(last, aside);
      const auto w = static_cast<float>(1 << random.between(0, 2));
      strip.push_back({static_cast<float>(p.x) * w, static_cast<float>(p.y) * w, 0, w});
      const int step = random.between(1, 3 * units), most = heading == kDown || heading == kUp ? step - 1 : step;
      along += step, across += random.between(-most, most);
    }
    std::vector<textbook::Line> lines;
    for (std::size_t k = 0; k + 1 < strip.size(); ++k) lines.emplace_back(strip[k], strip[k + 1], rule);
    for (int i = 0; i < 12; ++i) {
      if (i - 0.5 <= first || i + 1.5 >= last) continue;
      int thin = 0, wide = 0;
      for (double j = std::floor(low) - 2; j <= high + 2; ++j) {
        for (const textbook::Line& line : lines) {
          if (line.exits_diamond(at(i + 0.5, j + 0.5))) ++thin;
          if (line.covers_wide(1, at(i + 0.5, j + 0.5))) ++wide;
        }
      }
      if (thin != 1 || wide != 1) {
        return "heading " + std::to_string(heading) + ", step " + std::to_string(i) + ": " + std::to_string(thin) +
               " hits by thin lines, " + std::to_string(wide) + " by lines of width 1";
      }
    }
    return "";
  });
}

// Points at the samples of a lattice, as large as its step: they tile, each sample once, whatever the rule.
TEST(TextbookPoints, SquaresSideBySideTile) {
  for (int r = 0; r < 8; ++r) {
    for (int y = 2; y < 6; ++y) {
      for (int x = 2; x < 6; ++x) {
        int covers = 0;
        for (int j = -4; j <= 12; j += 3) {
          for (int i = -4; i <= 12; i += 3) {
            const Vertex v{static_cast<float>(i), static_cast<float>(j), 0, 1};
            if (textbook::point_covers(v, 3, {x + 0.5, y + 0.5}, static_cast<FillRule>(r))) ++covers;
          }
        }
        EXPECT_EQ(covers, 1) << "rule " << r << " at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace surefill::properties
