// SPDX-License-Identifier: Apache-2.0
//
// Every route of the textbook to an attribute, taken in rationals, ends in the oracle's value; the clipping pipeline,
// in rationals, draws the image of the pipeline that never clips.
#include <gmpxx.h>

#include "oracle/exact.hpp"
#include "textbook/interpolation.hpp"
#include "textbook/pipeline.hpp"
#include "textbook/tests/textbook_check.hpp"

namespace surefill::properties {
namespace {

using namespace textbook;

float rounded(const mpq_class& value) {
  return oracle::nearest_finite(value.get_num(), value.get_den());
}

// A value at a vertex: zero, one, a small number or one of any exponent.
float any_value(Random& random) {
  switch (random.below(4)) {
    case 0:
      return static_cast<float>(random.below(2));
    case 1:
      return static_cast<float>(random.between(-16, 16)) / 4;
    default:
      return static_cast<float>(std::ldexp(random.unit() - 0.5, random.between(-20, 20)));
  }
}

// A few of the samples; one sample a pixel.
std::string decide_routes(const TriangleCase& c, std::uint64_t seed, std::atomic<std::uint64_t>& values) {
  if (!c.all_finite()) return "";
  Random random(seed);
  const std::array<float, 3> u{any_value(random), any_value(random), any_value(random)};
  Target target = c.target();
  std::vector<float> image(sample_total(target));
  std::vector<std::uint32_t> index(image.size());
  const AttributeTarget attribute{image, 1};
  target.attributes = {&attribute, 1};
  target.index = index;
  Draw draw = c.draw();
  const AttributeArray array{u, 1, 0, Interpolation::perspective};
  draw.attributes = {&array, 1};
  oracle::render(target, {&draw, 1});

  const bool divides = c.vertices[0].w != 0 && c.vertices[1].w != 0 && c.vertices[2].w != 0;
  const Interpolator<mpq_class> exact(c.vertices);
  const std::array<mpq_class, 3> values_at_vertices{mpq_class(u[0]), mpq_class(u[1]), mpq_class(u[2])};
  const Lattice lattice{c.width, c.height};
  int looked_at = 0;
  for (std::size_t s = random.below(4); s < image.size() && looked_at < 6; s += 1 + random.below(5)) {
    if (index[s] == kNoTriangle) continue;
    ++looked_at;
    const int x = static_cast<int>(s) % c.width, y = static_cast<int>(s) / c.width;
    for (const Route route : kRoutes) {
      if (!divides && (route == Route::areas || route == Route::planes)) continue;
      const float value = rounded(exact.value(route, values_at_vertices, lattice, x, y));
      ++values;
      if (value != image[s]) {
        return std::string(name_of(route)) + ": " + text(value) + ", not " + text(image[s]) + " at pixel " +
               std::to_string(x) + ", " + std::to_string(y) + c.text();
      }
    }
  }
  return "";
}

TEST(TextbookInterpolation, AllRoutesEndInTheOraclesValue) {
  std::atomic<std::uint64_t> values{0};
  for_each_case(textbook_scenes(20'000),
                [&values](std::uint64_t n) { return decide_routes(random_triangle(n, false), n, values); });
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 12, false);
  const auto decide = [&](std::uint64_t n) { return decide_routes(cases[n], n, values); };
  for_each_case(cases.size(), decide, Cases::corpus);
  EXPECT_GT(values, textbook_scenes(20'000) / 20);
}

// w affine within a tile: exact at the three corners it is taken from, and everywhere if all W are equal.
TEST(TextbookInterpolation, AffineWIsExactWhereWIsConstant) {
  const std::array<Vertex, 3> flat{Vertex{0, 0, 0, 2}, {64, 0, 0, 2}, {0, 64, 0, 2}},
      steep{Vertex{0, 0, 0, 1}, {320, 0, 0, 10}, {0, 32, 0, 1}};
  const std::array<mpq_class, 3> u{mpq_class(0), mpq_class(1), mpq_class(2)};
  const Interpolator<mpq_class> constant(flat), sloped(steep);
  const Lattice lattice{32, 32};
  for (int size : {4, 8, 16}) {
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        const mpq_class px(x + 0.5), py(y + 0.5), left(x / size * size), top(y / size * size), side(size);
        EXPECT_TRUE(constant.with_affine_w(u, px, py, left, top, side) ==
                    constant.value(Route::matrix, u, lattice, x, y));
      }
    }
    const mpq_class left(16), top(0), side(size), right = left + side;
    const mpq_class at_right = sloped.with_affine_w(u, right, top, left, top, side);
    const Lattice corners{32, 32, {0, 0}};
    EXPECT_TRUE(at_right == sloped.value(Route::matrix, u, corners, 16 + size, 0));
    EXPECT_FALSE(sloped.with_affine_w(u, left + side / 2, top, left, top, side) ==
                 sloped.value(Route::matrix, u, corners, 16 + size / 2, 0));
  }
}

// On an edge, and z is exactly 0 or 1: the edge that decides the tie may be what clipping has removed, and a triangle
// that touches the plane with an edge has no area left. I5 keeps such samples by C3; a clipped polygon does not know.
bool in_a_corner(const TriangleCase& c, SamplePosition p) {
  Triangle triangle;
  triangle.set_up(c.vertices[0], c.vertices[1], c.vertices[2]);
  if (triangle.compare_depth(p, 0) != 0 && triangle.compare_depth(p, 1) != 0) return false;
  for (int i = 0; i < 3; ++i) {
    if (triangle.edge(i).sign(p) == 0) return true;
  }
  return false;
}

std::string decide_clipping(const TriangleCase& c, std::atomic<std::uint64_t>& corners) {
  if (!c.all_finite()) return "";
  for (const bool depth : {false, true}) {
    const std::vector<std::uint32_t> expected = c.counts(Conservative::none, depth ? DepthMode::clip : DepthMode::none);
    for (const ClipTo to : {ClipTo::view_volume, ClipTo::guard_band}) {
      const Polygon<mpq_class> polygon = clipped<mpq_class>(c.vertices, c.width, c.height, to, depth);
      const int d = facing(c.vertices);
      for (const ClipCorner<mpq_class>& corner : polygon) {
        if (d != 0 && corner.w <= 0) return "W <= 0 after clipping" + c.text();
      }
      if (d == 0) {
        if (std::any_of(expected.begin(), expected.end(), [](std::uint32_t k) { return k != 0; }))
          return "D = 0 covers";
        continue;
      }
      const ScreenPolygon<mpq_class> screen(polygon);
      if (screen.facing() * d < 0) return "facing" + c.text();
      for (int y = 0; y < c.height; ++y) {
        for (int x = 0; x < c.width; ++x) {
          const bool covered = screen.covers(mpq_class(x + 0.5), mpq_class(y + 0.5), tie_shift(c.rule));
          if (covered == (expected[place(c, x, y)] != 0)) continue;
          if (depth && in_a_corner(c, {x + 0.5, y + 0.5})) {
            ++corners;
          } else {
            return "clipping to " + std::string(to == ClipTo::view_volume ? "the view volume" : "the guard band") +
                   (depth ? " with depth" : "") + " at pixel " + std::to_string(x) + ", " + std::to_string(y) +
                   c.text();
          }
        }
      }
    }
  }
  return "";
}

TEST(TextbookPipeline, ClippedInRationalsIsTheImageWithoutClipping) {
  std::atomic<std::uint64_t> corners{0};
  for_each_case(textbook_scenes(6'000),
                [&corners](std::uint64_t n) { return decide_clipping(random_triangle(n, false, 8), corners); });
  const std::vector<TriangleCase> cases = corpus_triangles(1 << 10, false);
  const auto decide = [&](std::uint64_t n) { return decide_clipping(cases[n], corners); };
  for_each_case(cases.size(), decide, Cases::corpus);
  RecordProperty("on_an_edge_and_on_a_depth_plane", static_cast<int>(corners));
}

// An object whose box is outside the frustum draws nothing: in float the test is only taken where it is certain.
TEST(TextbookPipeline, FrustumCullingDropsNothingThatIsSeen) {
  std::atomic<std::uint64_t> culled{0};
  for_each_case(textbook_scenes(20'000), [&culled](std::uint64_t n) -> std::string {
    const TriangleCase c = random_triangle(n, false);
    if (!c.all_finite()) return "";
    const Polygon<mpq_class> corners = polygon_of<mpq_class>(c.vertices);
    std::vector<ClipPlane<mpq_class>> planes = side_planes<mpq_class>(c.width, c.height, 0);
    for (const ClipPlane<mpq_class>& plane : depth_planes<mpq_class>()) planes.push_back(plane);
    if (!outside<mpq_class>(corners, planes)) return "";
    ++culled;
    const std::vector<std::uint32_t> counts = c.counts(Conservative::none, DepthMode::clip);
    return std::any_of(counts.begin(), counts.end(), [](std::uint32_t k) { return k != 0; })
               ? "culled, but seen" + c.text()
               : "";
  });
  EXPECT_GT(culled, textbook_scenes(20'000) / 200);
}

// In float the cut points are rounded: the clipped image differs. That it does is part of what docs/textbook.md says.
TEST(TextbookPipeline, ClippedInFloatIsAnotherImage) {
  std::uint64_t samples = 0, differences = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    TriangleCase c;
    Random random(n);
    c.width = c.height = 64;
    for (Vertex& v : c.vertices) {
      const auto w = static_cast<float>(random.between(1, 3));
      v = {(static_cast<float>(random.between(-200, 200)) + 0.5f) * w,
           (static_cast<float>(random.between(-200, 200)) + 0.5f) * w, 0.5f * w, w};
    }
    const std::vector<std::uint32_t> expected = c.counts();
    const ScreenPolygon<float> screen(clipped<float>(c.vertices, c.width, c.height, ClipTo::view_volume, false));
    for (int y = 0; y < c.height; ++y) {
      for (int x = 0; x < c.width; ++x) {
        ++samples;
        const bool covered =
            screen.covers(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, tie_shift(c.rule));
        if (covered != (expected[place(c, x, y)] != 0)) ++differences;
      }
    }
  }
  RecordProperty("samples", static_cast<int>(samples));
  RecordProperty("differences", static_cast<int>(differences));
  EXPECT_GT(differences, 0u);
  EXPECT_LT(differences * 1000, samples);
}

}  // namespace
}  // namespace surefill::properties
