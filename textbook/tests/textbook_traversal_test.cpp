// SPDX-License-Identifier: Apache-2.0
//
// Every traversal of the textbook finds the oracle's samples, each once; tile tests are never wrong.
#include "textbook/tests/textbook_check.hpp"
#include "textbook/tile_test.hpp"
#include "textbook/traversal.hpp"

namespace surefill::properties {
namespace {

using namespace textbook;

// Collects what a traversal visits; notes visits to the left of the triangle, and second visits.
struct Seen {
  int width;
  std::vector<std::uint8_t> visits, covered;
  Asked* probe = nullptr;  // for questions that are not the traversal's
  std::string finding;

  Seen(const Lattice& lattice, Asked& asked) : width(lattice.width), probe(&asked) {
    visits.assign(static_cast<std::size_t>(lattice.width) * static_cast<std::size_t>(lattice.height), 0);
    covered = visits;
  }
  void sample(int x, int y, bool hit) {
    const std::size_t s = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    if (++visits[s] > 1) finding = "a sample is visited twice";
    covered[s] = hit;
    if (left_is_forbidden && probe->beyond(x, y, -1)) finding = "a sample to the left of the triangle is visited";
  }
  void tile(const PixelBox&, TileClass) {}
  bool left_is_forbidden = false;
};

std::string decide_traversals(const TriangleCase& c, bool every_sample, int tile_size) {
  Triangle triangle;
  const std::vector<std::uint32_t> expected = c.counts();
  if (!c.all_finite() || !triangle.set_up(c.vertices[0], c.vertices[1], c.vertices[2])) {
    return std::any_of(expected.begin(), expected.end(), [](std::uint32_t n) { return n != 0; }) ? "D = 0 covers" : "";
  }
  for (int n = 0; n < c.samples; ++n) {
    const SampleLocation location = sample_location(c.samples, n);
    const Lattice lattice{c.width, c.height, {location.x / 16.0, location.y / 16.0}};
    for (const Traversal traversal : kTraversals) {
      if (traversal == Traversal::every_sample && !every_sample) continue;
      Asked asked(triangle, c.rule, lattice), probe(triangle, c.rule, lattice);
      Seen seen(lattice, probe);
      seen.left_is_forbidden = traversal == Traversal::backtrack;
      traverse(traversal, asked, lattice, tile_size, seen);
      for (std::size_t s = 0; s < seen.covered.size() && seen.finding.empty(); ++s) {
        if (seen.covered[s] != expected[s * static_cast<std::size_t>(c.samples) + static_cast<std::size_t>(n)]) {
          seen.finding = "other samples than the oracle's";
        }
      }
      const auto sum = [](const std::vector<std::uint8_t>& v) {
        return static_cast<std::uint64_t>(std::count(v.begin(), v.end(), 1));
      };
      if (sum(seen.covered) != asked.counts().samples_covered || sum(seen.visits) != asked.counts().samples_visited) {
        seen.finding = "counts that are not those of the visits";
      }
      if (!seen.finding.empty()) return std::string(name_of(traversal)) + ": " + seen.finding + c.text();
    }
  }
  return "";
}

TEST(TextbookTraversal, FindsTheOraclesSamplesOnRandomScenes) {
  for_each_case(textbook_scenes(60'000),
                [](std::uint64_t n) { return decide_traversals(random_triangle(n), true, 4 << (n / 7 % 5)); });
}

TEST(TextbookTraversal, FindsTheOraclesSamplesOnTheCorpus) {
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 20);
  ASSERT_FALSE(cases.empty());
  RecordProperty("triangles", static_cast<int>(cases.size()));
  const auto decide = [&](std::uint64_t n) {
    const TriangleCase& c = cases[n];
    return decide_traversals(c, c.width * c.height <= 1 << 16, 4 << (n % 5));
  };
  for_each_case(cases.size(), decide, Cases::corpus);
}

// Long scan lines, large tiles, accepted tiles: what 16 x 16 targets do not reach.
TEST(TextbookTraversal, FindsTheOraclesSamplesOnLargerTargets) {
  for_each_case((textbook_scenes(60'000) + 299) / 300, [](std::uint64_t n) {
    TriangleCase c = random_triangle(n, false);
    Random random(n);
    c.width = random.between(100, 300), c.height = random.between(100, 300);
    c.vertices = category_of_case(n).triangle(random, c.width, c.height);
    return decide_traversals(c, true, 4 << (n % 5));
  });
}

// The tile [0, 2^k)^2 plus an offset, seen by the oracle as a pixel: X and Y divided by 2^k. Counts the tiles that the
// corners do not reject though nothing meets them.
std::string decide_tiles(const TriangleCase& c, int log2, std::atomic<std::uint64_t>& blind) {
  TriangleCase scaled = c;
  for (Vertex& v : scaled.vertices) {
    if (!finite(v)) return "";
    if ((v.x != 0 && std::fabs(v.x) < 0x1p-120f) || (v.y != 0 && std::fabs(v.y) < 0x1p-120f)) return "";
    v.x = std::ldexp(v.x, -log2), v.y = std::ldexp(v.y, -log2);
  }
  scaled.width = std::min((c.width >> log2) + 1, kMaxTargetSize);
  scaled.height = std::min((c.height >> log2) + 1, kMaxTargetSize);
  Triangle triangle;
  if (!triangle.set_up(c.vertices[0], c.vertices[1], c.vertices[2])) return "";
  const std::vector<std::uint32_t> touched = scaled.counts(Conservative::over),
                                   inside = scaled.counts(Conservative::inner);
  for (int y = 0; y < scaled.height; ++y) {
    for (int x = 0; x < scaled.width; ++x) {
      const std::size_t s = place(scaled, x, y);
      const PixelBox tile{x << log2, y << log2, (x + 1) << log2, (y + 1) << log2};
      const TileClass exact = inside[s] != 0    ? TileClass::accept
                              : touched[s] != 0 ? TileClass::partial
                                                : TileClass::reject;
      TileTest test(triangle, tile);
      const TileClass corners = test.by_corners(), three = test.by_three_tests();
      if (three != exact) return "three tests at tile " + std::to_string(x) + ", " + std::to_string(y) + c.text();
      if ((corners == TileClass::accept) != (exact == TileClass::accept)) return "corners accept" + c.text();
      if (corners == TileClass::reject && exact != TileClass::reject) return "corners reject" + c.text();
      if (corners != exact) ++blind;
    }
  }
  return "";
}

TEST(TextbookTiles, ThreeTestsAreExactAndCornersConservative) {
  std::atomic<std::uint64_t> blind{0};
  for_each_case(textbook_scenes(60'000), [&blind](std::uint64_t n) {
    return decide_tiles(random_triangle(n, false), static_cast<int>(n / 3 % 3), blind);
  });
  EXPECT_GT(blind, 0u) << "the corner test is no longer seen to be weaker";
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 16, false);
  const auto decide = [&](std::uint64_t n) { return decide_tiles(cases[n], static_cast<int>(n % 3), blind); };
  for_each_case(cases.size(), decide, Cases::corpus);
}

}  // namespace
}  // namespace surefill::properties
