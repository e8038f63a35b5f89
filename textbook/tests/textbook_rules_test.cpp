// SPDX-License-Identifier: Apache-2.0
//
// Fill rules as the textbooks state them, held against C3: where they agree, and where they do not.
#include <set>

#include "textbook/fill_rules.hpp"
#include "textbook/tests/textbook_check.hpp"

namespace surefill::properties {
namespace {

using namespace textbook;

template <class Covers>
std::string against_oracle(TriangleCase c, FillRule rule, const char* name, const Covers& covers) {
  c.rule = rule;
  Triangle triangle;
  if (!c.all_finite() || !triangle.set_up(c.vertices[0], c.vertices[1], c.vertices[2])) return "";
  const std::vector<std::uint32_t> expected = c.counts();
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      if (covers(triangle, SamplePosition{x + 0.5, y + 0.5}) != (expected[place(c, x, y)] != 0)) return name + c.text();
    }
  }
  return "";
}

std::string decide_in_front(const TriangleCase& c, std::atomic<std::uint64_t>& cases) {
  if (!c.all_finite() || !c.in_front()) return "";
  ++cases;
  std::string found = against_oracle(c, FillRule::top_left, "top-left as its text has it",
                                     [](const Triangle& t, SamplePosition p) { return covers_top_left(t, p); });
  if (!found.empty()) return found;
  found = against_oracle(c, FillRule::top_left, "crossings of a ray to the right",
                         [&c](const Triangle&, SamplePosition p) { return covers_by_crossings(c.vertices, p, false); });
  if (!found.empty()) return found;
  return against_oracle(c, FillRule::southwards, "crossings of a ray downwards",
                        [&c](const Triangle&, SamplePosition p) { return covers_by_crossings(c.vertices, p, true); });
}

TEST(TextbookFillRules, TheTextOfDirect3DAndCrossingsAreC3InFrontOfTheEye) {
  std::atomic<std::uint64_t> compared{0};
  for_each_case(textbook_scenes(30'000),
                [&compared](std::uint64_t n) { return decide_in_front(random_triangle(n, false), compared); });
  EXPECT_GT(compared, textbook_scenes(30'000) / 30);
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 16, false);
  const auto decide = [&](std::uint64_t n) { return decide_in_front(cases[n], compared); };
  for_each_case(cases.size(), decide, Cases::corpus);
}

std::string decide_light(const TriangleCase& c, std::uint64_t direction) {
  struct Pair {
    Light light;
    FillRule rule;
  };
  constexpr Pair kPairs[] = {{{1, 0}, FillRule::top_left},
                             {{0, 1}, FillRule::southwards_west},
                             {{-1, 0}, FillRule::bottom_right},
                             {{0, -1}, FillRule::northwards}};
  const Pair& pair = kPairs[direction % 4];
  return against_oracle(c, pair.rule, "light along an axis",
                        [&pair](const Triangle& t, SamplePosition p) { return covers_by_light(t, p, pair.light); });
}

TEST(TextbookFillRules, LightAlongAnAxisIsC3) {
  for_each_case(textbook_scenes(30'000),
                [](std::uint64_t n) { return decide_light(random_triangle(n, false), n / 64); });
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 16, false);
  const auto decide = [&](std::uint64_t n) { return decide_light(cases[n / 4], n); };
  for_each_case(4 * cases.size(), decide, Cases::corpus);
}

// A fan around a sample tiles its outline: every rule gives each sample inside once. The vertex in the middle lies on a
// sample, and so do the corners of the outline.
TEST(TextbookFillRules, EveryLightPartitionsAFan) {
  std::atomic<std::uint64_t> other_rule{0};
  for_each_case(textbook_scenes(30'000), [&other_rule](std::uint64_t n) -> std::string {
    Random random(n);
    const auto at = [](int x, int y) {
      return Vertex{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 1};
    };
    const Light light{random.between(-5, 5), random.between(-5, 5)};
    if (light.dx == 0 && light.dy == 0) return "";
    const Vertex middle = at(random.between(1, 8), random.between(1, 8));
    std::vector<Vertex> rim;  // clockwise around the square of samples 0 .. 9, its corners among them
    for (int k = 0; k < 36; ++k) {
      const int side = k / 9, step = k % 9;
      if (step != 0 && !random.one_in(3)) continue;
      rim.push_back(side == 0 ? at(step, 0) : side == 1 ? at(9, step) : side == 2 ? at(9 - step, 9) : at(0, 9 - step));
    }
    for (int y = 1; y < 9; ++y) {
      for (int x = 1; x < 9; ++x) {
        int covers = 0;
        std::set<std::uint32_t> owners, by_rule;
        for (std::size_t k = 0; k < rim.size(); ++k) {
          Triangle triangle;
          if (!triangle.set_up(middle, rim[k], rim[(k + 1) % rim.size()])) continue;
          const SamplePosition p{x + 0.5, y + 0.5};
          if (covers_by_light(triangle, p, light)) ++covers, owners.insert(static_cast<std::uint32_t>(k));
          if (triangle.covers(p, tie_shift(FillRule::top_left))) by_rule.insert(static_cast<std::uint32_t>(k));
        }
        if (covers != 1) return "sample covered " + std::to_string(covers) + " times";
        if (owners != by_rule) ++other_rule;
      }
    }
    return "";
  });
  EXPECT_GT(other_rule, 0u) << "no light is seen to differ from the top-left rule";
}

// Vertices at multiples of 1, 1/2 or 1/4, half of them on samples: the moved grid needs no rule and is the top-left
// rule.
TEST(TextbookFillRules, AMovedSampleGridIsTopLeft) {
  std::atomic<std::uint64_t> ties{0};
  for_each_case(textbook_scenes(30'000), [&ties](std::uint64_t n) -> std::string {
    Random random(n);
    TriangleCase c;
    const int bits = random.between(1, 2);
    c.width = random.between(1, 12), c.height = random.between(1, 12);
    for (Vertex& v : c.vertices) {
      v = {std::ldexp(static_cast<float>(random.between(-8, 64)), -bits),
           std::ldexp(static_cast<float>(random.between(-8, 64)), -bits), 0, 1};
    }
    return against_oracle(c, FillRule::top_left, "moved samples", [&](const Triangle& t, SamplePosition p) {
      bool covered = true;
      for (int i = 0; i < 3; ++i) {
        const int sign = t.edge(i).sign(moved_sample(p, bits));
        if (sign == 0) ADD_FAILURE() << "a moved sample lies on an edge";
        if (t.edge(i).sign(p) == 0) ++ties;
        covered = covered && sign == t.determinant();
      }
      return covered;
    });
  });
  EXPECT_GT(ties, textbook_scenes(30'000) / 30);
}

// The eight rules agree wherever no edge runs through a sample, and any two differ somewhere.
TEST(TextbookFillRules, AgreeOffTheEdgesAndDifferOnThem) {
  bool differ[8][8] = {};
  for (std::uint64_t n = 0; n < 4'000; ++n) {
    TriangleCase c = random_triangle(n, false);
    Triangle triangle;
    if (!c.all_finite() || !triangle.set_up(c.vertices[0], c.vertices[1], c.vertices[2])) continue;
    for (int y = 0; y < c.height; ++y) {
      for (int x = 0; x < c.width; ++x) {
        const SamplePosition p{x + 0.5, y + 0.5};
        bool covered[8], tie = false;
        for (int r = 0; r < 8; ++r) covered[r] = triangle.covers(p, tie_shift(static_cast<FillRule>(r)));
        for (int i = 0; i < 3; ++i) tie = tie || triangle.edge(i).sign(p) == 0;
        for (int r = 0; r < 8; ++r) {
          for (int q = 0; q < 8; ++q) differ[r][q] = differ[r][q] || covered[r] != covered[q];
          EXPECT_TRUE(tie || covered[r] == covered[0]);
        }
      }
    }
  }
  for (int r = 0; r < 8; ++r) {
    for (int q = 0; q < r; ++q) EXPECT_TRUE(differ[r][q]) << r << ", " << q;
  }
}

}  // namespace
}  // namespace surefill::properties
