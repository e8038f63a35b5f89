// SPDX-License-Identifier: Apache-2.0
//
// Points and lines (M7, I6, I7 of docs/semantics.md, and what other rules say of them): both oracles against images
// worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oracle/tests/modes_image.hpp"

namespace surefill::modes {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Asked = Image::Asked;

Mesh lines(const std::vector<Vertex>& vertices, std::optional<float> width = {},
           const std::vector<float>& values = {}) {
  Mesh mesh(vertices, values);
  mesh.state.primitive = Primitive::lines;
  mesh.state.width = width;
  return mesh;
}
Mesh points(const std::vector<Vertex>& vertices, std::optional<float> size = {},
            const std::vector<float>& values = {}) {
  Mesh mesh = lines(vertices, size, values);
  mesh.state.primitive = Primitive::points;
  return mesh;
}
Mesh with(Mesh mesh, FillRule rule) {
  mesh.state.fill_rule = rule;
  return mesh;
}
// On the screen at (x, y), with depth z.
Vertex seen(float x, float y, float w, float z = 0) {
  return {x * w, y * w, z * w, w};
}

class Lines : public testing::TestWithParam<Oracle> {
 protected:
  Image draw(const Asked& asked, const std::vector<Mesh>& meshes) const {
    return render(GetParam().render, asked, meshes);
  }
  std::string counts(const Asked& asked, const Mesh& mesh) const {
    return picture(draw(asked, {mesh}).count, asked.width * asked.samples);
  }
  // Of barycentrics, the three at a sample.
  static std::vector<float> barycentrics(const Image& image, std::size_t sample) {
    std::vector<float> b;
    for (std::size_t i = 0; i < 3; ++i) b.push_back(std::bit_cast<float>(image.barycentrics[3 * sample + i]));
    return b;
  }
  static float depth(const Image& image, std::size_t sample) { return std::bit_cast<float>(image.depth[sample]); }
  // Perspective, noperspective, flat.
  static std::vector<float> values(const Image& image, std::size_t sample) {
    std::vector<float> v;
    for (const auto& attribute : image.attributes) v.push_back(std::bit_cast<float>(attribute[sample]));
    return v;
  }
};
INSTANTIATE_TEST_SUITE_P(Oracles, Lines, testing::ValuesIn(kOracles),
                         [](const auto& test) { return test.index == 0 ? "First" : "Second"; });

using Floats = std::vector<float>;

// The square of a point on a pixel corner has four samples at its corners. Moved by +e in x, 1.5 is inside and 2.5 is
// not.
TEST_P(Lines, PointOnACorner) {
  const struct {
    FillRule rule;
    int x, y;
  } cases[] = {{FillRule::top_left, 1, 1},     {FillRule::top_right, 2, 1},      {FillRule::bottom_left, 1, 2},
               {FillRule::bottom_right, 2, 2}, {FillRule::southwards, 1, 1},     {FillRule::southwards_west, 2, 1},
               {FillRule::northwards, 1, 2},   {FillRule::northwards_west, 2, 2}};
  for (const auto& [rule, x, y] : cases) {
    std::string expected = "..../..../..../....";
    expected[static_cast<std::size_t>(5 * y + x)] = '1';
    EXPECT_EQ(counts({.width = 4, .height = 4}, with(points({seen(2, 2, 3)}), rule)), expected)
        << static_cast<int>(rule);
  }
}

TEST_P(Lines, PointSizes) {
  const Asked asked{.width = 5, .height = 3};
  EXPECT_EQ(counts(asked, points({flat(2.5f, 1.5f)})), "...../..1../.....");
  EXPECT_EQ(counts(asked, points({flat(2.25f, 1.25f)}, 0.5f)), "...../...../.....") << "2.5 + e is out";
  EXPECT_EQ(counts(asked, points({flat(2.75f, 1.75f)}, 0.5f)), "...../..1../.....") << "2.5 + e is in";
  EXPECT_EQ(counts(asked, points({flat(2.5f, 1.5f)}, 0x1p-149f)), "...../..1../.....")
      << "a step is less than any size";
  EXPECT_EQ(counts(asked, points({flat(2.5f, 1.5f)}, 3)), ".111./.111./.111.");
  EXPECT_EQ(counts(asked, points({flat(2.5f, 1.5f)}, 2)), ".11../.11../.....") << "both borders meet samples";
  EXPECT_EQ(counts(asked, points({flat(-900, 700)}, 0x1p127f)), "11111/11111/11111");
  EXPECT_EQ(counts(asked, points({flat(2.5f, 1.5f), flat(2.5f, 1.5f), {2.5f, 1.5f, 0, 0}, {-2.5f, -1.5f, 0, -1}})),
            "...../..2../.....")
      << "W <= 0 draws nothing";
}

// I6, and I4's +0.
TEST_P(Lines, PointValues) {
  Mesh mesh = points({seen(1, 1, 4, 0.75f), seen(3, 1, 2, -2)}, 2, {5, -0.0f});
  Image image = draw({.width = 4, .height = 2}, {mesh});
  for (const std::size_t s : {0u, 1u, 4u, 5u}) {
    EXPECT_EQ(depth(image, s), 0.75f);
    EXPECT_EQ(barycentrics(image, s), (Floats{1, 0, 0}));
    EXPECT_EQ(values(image, s), (Floats{5, 5, 5}));
  }
  EXPECT_EQ(depth(image, 2), -2);
  for (const auto& attribute : image.attributes) EXPECT_EQ(attribute[2], 0u) << "not -0";
  mesh.state.depth_mode = DepthMode::clip;
  EXPECT_EQ(counts({.width = 4, .height = 2}, mesh), "11../11..");
  mesh.state.depth_mode = DepthMode::clamp;
  EXPECT_EQ(depth(draw({.width = 4, .height = 2}, {mesh}), 2), 0);
  // Several samples: those in the square; everywhere the vertex's values.
  mesh = points({seen(0.5f, 0.5f, 2, 0.5f)}, 0.5f, {7});  // 1/4 to 3/4: of 4 samples none, of 8 (9, 5) and (7, 11)
  EXPECT_EQ(counts({.width = 1, .samples = 4}, mesh), "....");
  image = draw({.width = 1, .samples = 8}, {mesh});
  EXPECT_EQ(picture(image.count, 8), "11......");
  EXPECT_EQ(values(image, 1), (Floats{7, 7, 7}));
  EXPECT_EQ(depth(image, 1), 0.5f);
  EXPECT_EQ(barycentrics(image, 1), (Floats{1, 0, 0}));
}

// The diamond of the first sample is left, that of the last one is not.
TEST_P(Lines, FromCentreToCentre) {
  for (int rule = 0; rule < 8; ++rule) {
    const auto fill = static_cast<FillRule>(rule);
    EXPECT_EQ(counts({.width = 5}, with(lines({flat(0.5f, 0.5f), flat(3.5f, 0.5f)}), fill)), "111..") << rule;
    EXPECT_EQ(counts({.width = 5}, with(lines({flat(3.5f, 0.5f), flat(0.5f, 0.5f)}), fill)), ".111.") << rule;
    EXPECT_EQ(counts({.width = 1, .height = 4}, with(lines({flat(0.5f, 0.5f), flat(0.5f, 3.5f)}), fill)), "1/1/1/.");
    EXPECT_EQ(counts({.width = 4, .height = 4}, with(lines({seen(0.5f, 0.5f, 2), flat(3.5f, 3.5f)}), fill)),
              "1.../.1../..1./....");
    EXPECT_EQ(counts({.width = 4, .height = 4}, with(lines({flat(3.5f, 0.5f), seen(0.5f, 3.5f, 4)}), fill)),
              "...1/..1./.1../....");
  }
}

// At y = 7/8 the diamond of pixel i is open between i + 3/8 and i + 5/8, moved by the step in x.
TEST_P(Lines, DiamondExit) {
  const auto row = [&](float from, float to, FillRule rule) {
    return counts({.width = 5}, with(lines({flat(from, 0.875f), flat(to, 0.875f)}), rule));
  };
  const FillRule right = FillRule::top_left, left = FillRule::top_right;
  EXPECT_EQ(row(0.5f, 3, right), "111..") << "starts in it";
  EXPECT_EQ(row(0.75f, 3, right), ".11..") << "starts behind it";
  EXPECT_EQ(row(0.625f, 3, right), "111..") << "5/8 is less than 5/8 + e";
  EXPECT_EQ(row(0.625f, 3, left), ".11..");
  EXPECT_EQ(row(0, 3.5f, right), "111..") << "ends in it";
  EXPECT_EQ(row(0, 3.25f, right), "111..") << "ends before it";
  EXPECT_EQ(row(0, 3.375f, right), "111..") << "ends before it";
  EXPECT_EQ(row(0, 3.375f, left), "111..") << "ends in it";
  EXPECT_EQ(row(0, 3.75f, right), "1111.") << "leaves it";
  EXPECT_EQ(row(0, 3.625f, right), "111..") << "5/8 is less than 5/8 + e";
  EXPECT_EQ(row(0, 3.625f, left), "1111.");
  EXPECT_EQ(row(0.5f, 0.5625f, right), ".....") << "within it";
  EXPECT_EQ(row(0.25f, 0.875f, right), "1....") << "through it";
  EXPECT_EQ(row(0.875f, 0.25f, right), "1....");
  EXPECT_EQ(row(0.4375f, 0.25f, right), "1....") << "out of it";
  EXPECT_EQ(row(0.25f, 0.4375f, right), ".....") << "into it";
}

// Between two rows, y = 1, a line passes the corners of diamonds: those of the row to which C3 moves the samples away
// from the line do not meet it. +y moves row 0 (its corners to 1 + e) over it.
TEST_P(Lines, BetweenRows) {
  const auto image = [&](FillRule rule) {
    return counts({.width = 4, .height = 2}, with(lines({flat(0, 1), flat(4, 1)}), rule));
  };
  EXPECT_EQ(image(FillRule::top_left), "1111/....");
  EXPECT_EQ(image(FillRule::top_right), "1111/....");
  EXPECT_EQ(image(FillRule::bottom_left), "..../1111");
  EXPECT_EQ(image(FillRule::southwards_west), "1111/....");
  EXPECT_EQ(image(FillRule::northwards), "..../1111");
  // x = 1, in a column.
  EXPECT_EQ(counts({.width = 2, .height = 2}, with(lines({flat(1, 0), flat(1, 2)}), FillRule::top_left)), "1./1.");
  EXPECT_EQ(counts({.width = 2, .height = 2}, with(lines({flat(1, 0), flat(1, 2)}), FillRule::top_right)), ".1/.1");
  EXPECT_EQ(counts({.width = 2, .height = 2}, with(lines({flat(1, 2), flat(1, 0)}), FillRule::southwards)), "1./1.");
  // y = x + 1/2 goes along sides of diamonds: below them is y > x + 1/2. With +x the diamonds move away from it, above.
  EXPECT_EQ(counts({.width = 4, .height = 4}, with(lines({flat(0, 0.5f), flat(3, 3.5f)}), FillRule::top_left)),
            "..../1.../.1../....")
      << "and it ends in the last one";
  EXPECT_EQ(counts({.width = 4, .height = 4}, with(lines({flat(0, 0.5f), flat(3, 3.5f)}), FillRule::southwards)),
            "1.../.1../..1./....");
}

TEST_P(Lines, ZeroLength) {
  const Asked asked{.width = 4, .height = 2};
  for (const std::optional<float> width : {std::optional<float>(), std::optional<float>(3)}) {
    EXPECT_EQ(counts(asked, lines({flat(1.5f, 0.5f), flat(1.5f, 0.5f)}, width)), "..../....");
    EXPECT_EQ(counts(asked, lines({flat(1.5f, 0.5f), seen(1.5f, 0.5f, 3)}, width)), "..../....");
    EXPECT_EQ(counts(asked, lines({flat(1.5f, 0.5f), {0, 0, 1, 0}}, width)), "..../....") << "the eye itself";
    EXPECT_EQ(counts(asked, lines({flat(1.5f, 0.5f), seen(1.5f, 0.5f, -2)}, width)), "..../....") << "through the eye";
    EXPECT_EQ(counts(asked, lines({seen(1.5f, 0.5f, -2), flat(1.5f, 0.5f)}, width)), "..../....");
    EXPECT_EQ(counts(asked, lines({seen(0.5f, 0.5f, -1), seen(3.5f, 0.5f, -2)}, width)), "..../....") << "both behind";
    EXPECT_EQ(counts(asked, lines({{1, 0, 0, 0}, seen(3.5f, 0.5f, -2)}, width)), "..../....");
    EXPECT_EQ(counts(asked, lines({{1, 0, 0, 0}, {-1, 0, 0, 0}}, width)), "..../....");
    EXPECT_EQ(counts(asked, lines({{1, 0, 0, 0}, {0, 1, 0, -0.0f}}, width)), "..../....");
  }
}

// A ray starts at the end with W > 0 and runs where the other one pulls: away from where that would project to.
TEST_P(Lines, Rays) {
  const Asked asked{.width = 5};
  const Vertex here = flat(2.5f, 0.5f), behind = seen(4.5f, 0.5f, -1), left{-1, 0, 0, 0};
  EXPECT_EQ(counts(asked, lines({here, behind})), "111..") << "to -x, and out of the first diamond";
  EXPECT_EQ(counts(asked, lines({behind, here})), "11...") << "from -x, and into the last diamond";
  EXPECT_EQ(counts(asked, lines({here, left})), "111..");
  EXPECT_EQ(counts(asked, lines({left, here})), "11...");
  EXPECT_EQ(counts(asked, lines({here, seen(0.5f, 0.5f, -1)})), "..111") << "to +x";
  EXPECT_EQ(counts(asked, lines({here, left}, 1)), "11...") << "2.5 + e is not on it";
  EXPECT_EQ(counts(asked, lines({left, here}, 1)), "11...");
  EXPECT_EQ(counts(asked, lines({here, seen(0.5f, 0.5f, -1)}, 1)), "..111");
  const Vertex down{0, 2, 0, 0};
  EXPECT_EQ(counts({.width = 1, .height = 4}, lines({flat(0.5f, 1.5f), down})), "./1/1/1");
  EXPECT_EQ(counts({.width = 1, .height = 4}, lines({down, flat(0.5f, 1.5f)})), "././1/1");
}

// |dx| = |dy|: x is the major axis. From (1, 1) to (3, 3) at x = 1.5 the width 2 reaches from 0.5 to 2.5; top_left moves
// x before y, and so the line along with it to 0.5 + e ... 2.5 + e.
TEST_P(Lines, WideDiagonal) {
  const Asked asked{.width = 4, .height = 4};
  const Mesh line = lines({flat(1, 1), flat(3, 3)}, 1), wide = lines({flat(1, 1), flat(3, 3)}, 2);
  EXPECT_EQ(counts(asked, line), "..../.1../..1./....");
  EXPECT_EQ(counts(asked, with(wide, FillRule::top_left)), "..../.1../.11./..1.");
  EXPECT_EQ(counts(asked, with(wide, FillRule::top_right)), ".1../.11./..1./....");
  EXPECT_EQ(counts(asked, with(wide, FillRule::southwards)), ".1../.11./..1./....");
  // Of a line that is steeper by little, rows are filled: y is the major axis.
  const Mesh steep = lines({flat(1, 1), flat(2.9375f, 3)}, 2.5f);
  EXPECT_EQ(counts(asked, steep), "..../111./.111/....");
  EXPECT_EQ(counts(asked, lines({flat(1, 1), flat(3, 2.9375f)}, 2.5f)), ".1../.11./.11./..1.");
  // Ends on samples: what lies on an end is moved past it, or before.
  EXPECT_EQ(counts(asked, with(lines({flat(0.5f, 0.5f), flat(2.5f, 2.5f)}, 1), FillRule::top_left)),
            "1.../.1../..../....");
  EXPECT_EQ(counts(asked, with(lines({flat(0.5f, 0.5f), flat(2.5f, 2.5f)}, 1), FillRule::top_right)),
            "..../.1../..1./....");
  EXPECT_EQ(counts(asked, with(lines({flat(2.5f, 2.5f), flat(0.5f, 0.5f)}, 1), FillRule::top_right)),
            "..../.1../..1./....");
}

TEST_P(Lines, Widths) {
  const Asked asked{.width = 4, .height = 3};
  const auto row = [&](float y, float width) { return counts(asked, lines({flat(0, y), flat(2, y)}, width)); };
  EXPECT_EQ(row(1.5f, 1), "..../11../....");
  EXPECT_EQ(row(1, 1), "11../..../....") << "0.5 + e^2 is above 0.5";
  EXPECT_EQ(row(1.5f, 2), "11../11../....");
  EXPECT_EQ(row(1.5f, 0x1p-20f), "..../11../....");
  EXPECT_EQ(row(1.5f, 0x1p-149f), "..../11../....") << "a step is less than any width";
  EXPECT_EQ(row(1.625f, 0.25f), "..../11../....") << "1.5 + e^2 is in it";
  EXPECT_EQ(row(1.375f, 0.25f), "..../..../....") << "1.5 + e^2 is not in it";
  EXPECT_EQ(row(-1000, 0x1p20f), "11../11../11..");
  EXPECT_EQ(row(-1000, std::numeric_limits<float>::max()), "11../11../11..");
}

// m_0 = (0, 1/2, 1), m_1 = 3 (4, 1/2, 1). At x = 3/2: k_1 12 = 3/2, k_1 = 1/8, k_0 = 1 - 3/8 = 5/8; b = (5, 1)/6.
// u = 0, 6: perspective 1, noperspective 3 * 6/8 = 9/4. Z = 1/2, 3: 5/16 + 3/8.
TEST_P(Lines, Perspective) {
  for (const bool transposed : {false, true}) {
    for (const std::optional<float> width : {std::optional<float>(), std::optional<float>(1)}) {
      std::vector<Vertex> v = {{0, 0.5f, 0.5f, 1}, {12, 1.5f, 3, 3}};
      if (transposed) {
        for (Vertex& vertex : v) std::swap(vertex.x, vertex.y);
      }
      Asked asked{.width = 3};
      if (transposed) std::swap(asked.width, asked.height);
      Image image = draw(asked, {lines(v, width, {0, 6})});
      EXPECT_EQ(indices(image.index), "000");
      EXPECT_EQ(depth(image, 1), 0.6875f);
      EXPECT_EQ(barycentrics(image, 1), (Floats{5.0f / 6, 1.0f / 6, 0}));
      EXPECT_EQ(values(image, 1), (Floats{1, 2.25f, 0}));
      std::swap(v[0], v[1]);
      image = draw(asked, {lines(v, width, {6, 0})});
      EXPECT_EQ(depth(image, 1), 0.6875f);
      EXPECT_EQ(barycentrics(image, 1), (Floats{1.0f / 6, 5.0f / 6, 0}));
      EXPECT_EQ(values(image, 1), (Floats{1, 2.25f, 6}));
    }
  }
}

// m_0 = (1/2, 1/2, 1), and m_1 = (8, 0, -1) pulls in the direction (17/2, 1/2). At x = 5/2: k_0/2 + 8 k_1 = 5/2, k_0 -
// k_1 = 1: k_1 = 4/17, k_0 = 21/17; b = (21, 4)/25. z = (Z_0 21 + Z_1 4)/17 = (21 + 30)/17 for Z = 1, 15/2. u = 1, 26:
// perspective 1 + 4 = 5; noperspective (21 - 4 * 26)/17.
TEST_P(Lines, PerspectiveOfARay) {
  const Image image = draw({.width = 4}, {lines({{0.5f, 0.5f, 1, 1}, {8, 0, 7.5f, -1}}, {}, {1, 26})});
  EXPECT_EQ(indices(image.index), "0000");
  EXPECT_EQ(depth(image, 2), 3);
  EXPECT_EQ(barycentrics(image, 2), (Floats{21.0f / 25, 4.0f / 25, 0}));
  EXPECT_EQ(values(image, 2), (Floats{5, -83.0f / 17, 1}));
}

// Depth is that of the line at the sample's own coordinate along the major axis, wherever it lies across.
TEST_P(Lines, AcrossTheMajorAxis) {
  const Mesh line = lines({flat(0, 1, 0), flat(4, 2, 4)}, 4, {0, 4});
  const Image image = draw({.width = 4, .height = 3}, {line});
  EXPECT_EQ(picture(image.count, 4), "1111/1111/1111");
  for (std::size_t s = 0; s < 12; ++s) {
    EXPECT_EQ(depth(image, s), static_cast<float>(s % 4) + 0.5f);
    EXPECT_EQ(values(image, s)[0], static_cast<float>(s % 4) + 0.5f);
  }
  // |dx| = |dy|: x.
  const Image diagonal = draw({.width = 4, .height = 4}, {lines({flat(0, 0, 0), flat(4, 4, 4)}, 5)});
  EXPECT_EQ(depth(diagonal, 4), 0.5f) << "pixel (0, 1)";
  EXPECT_EQ(depth(diagonal, 1), 1.5f) << "pixel (1, 0)";
}

// A thin line that starts in a diamond beyond its centre has there the values of its end.
TEST_P(Lines, NearestEnd) {
  const Image image = draw({.width = 3}, {lines({flat(0.75f, 0.5f, 0.25f), flat(2.75f, 0.5f, 1)}, {}, {2, 3})});
  EXPECT_EQ(indices(image.index), "00.");
  EXPECT_EQ(depth(image, 0), 0.25f);
  EXPECT_EQ(barycentrics(image, 0), (Floats{1, 0, 0}));
  EXPECT_EQ(values(image, 0), (Floats{2, 2, 2}));
  EXPECT_EQ(depth(image, 1), 0.25f + 0.75f * 0.375f);
  // And so has a ray: k_1 would be negative, and k_0 too.
  const Image ray = draw({.width = 3}, {lines({flat(0.75f, 0.5f, 0.25f), {-0.625f, -0.5f, 9, -1}}, {}, {2, 3})});
  EXPECT_EQ(indices(ray.index), "000");
  EXPECT_EQ(depth(ray, 0), 0.25f);
  EXPECT_EQ(barycentrics(ray, 0), (Floats{1, 0, 0}));
}

// Several samples. From x = 3/4 to 13/4 in a row; samples of 4 have x = 3/8, 7/8, 1/8, 5/8. Pixel 0 has sample 1, and
// its centre lies before the start; pixel 3 has sample 2, and its centre lies past the end.
TEST_P(Lines, CentreAndCentroid) {
  const Mesh line = lines({flat(0.75f, 0.5f, 0.75f), flat(3.25f, 0.5f, 3.25f)}, 1, {0.75f, 3.25f});
  Asked asked{.width = 4, .samples = 4};
  Image image = draw(asked, {line});
  EXPECT_EQ(picture(image.count, 16), ".1..11111111..1.");
  EXPECT_EQ(depth(image, 1), 0.875f) << "depth is the sample's own";
  EXPECT_EQ(depth(image, 14), 3.125f);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(depth(image, 4 + n), (Floats{1.375f, 1.875f, 1.125f, 1.625f})[n]);
    EXPECT_EQ(values(image, 4 + n), (Floats{1.5f, 1.5f, 0.75f}));
  }
  EXPECT_EQ(values(image, 1), (Floats{0.75f, 0.75f, 0.75f})) << "the nearest end";
  EXPECT_EQ(barycentrics(image, 1), (Floats{1, 0, 0}));
  EXPECT_EQ(values(image, 14), (Floats{3.25f, 3.25f, 0.75f}));
  EXPECT_EQ(barycentrics(image, 14), (Floats{0, 1, 0}));
  asked.attribute_location = AttributeLocation::centroid;
  image = draw(asked, {line});
  EXPECT_EQ(values(image, 5), (Floats{1.5f, 1.5f, 0.75f}));
  EXPECT_EQ(values(image, 1), (Floats{0.875f, 0.875f, 0.75f}));
  EXPECT_EQ(values(image, 14), (Floats{3.125f, 3.125f, 0.75f}));
  // 1/8 wide, at y = 5/8: it covers no centre, and of the samples of pixel 1 those of y = 5/8, number 2.
  const Mesh narrow = lines({flat(0.75f, 0.625f, 0), flat(3.25f, 0.625f, 0)}, 0.125f, {0.75f, 3.25f});
  image = draw(asked, {narrow});
  EXPECT_EQ(picture(image.count, 16), "......1...1...1.");
  EXPECT_EQ(values(image, 6), (Floats{1.125f, 1.125f, 0.75f}));
  asked.attribute_location = AttributeLocation::centre;
  image = draw(asked, {narrow});
  EXPECT_EQ(values(image, 6), (Floats{1.5f, 1.5f, 0.75f})) << "the centre's q serves, covered or not";
}

// A ray from m_1 = (13/4, 1/2), away from where m_0 projects to: to -x. The centre of pixel 3, x = 7/2, lies past its end, and
// past m_0 too: k_0, k_1 of the line that has no end would be negative.
TEST_P(Lines, CentrePastBothEnds) {
  const Image image =
      draw({.width = 4, .samples = 4}, {lines({seen(3.375f, 0.5f, -1, 9), seen(3.25f, 0.5f, 2, 0.5f)}, 1, {5, 7})});
  EXPECT_EQ(picture(image.count, 16), "111111111111..1.");
  EXPECT_EQ(values(image, 14), (Floats{7, 7, 5}));
  EXPECT_EQ(barycentrics(image, 14), (Floats{0, 1, 0}));
}

// S7: one sample at an own place is that place, for the diamond and all else.
TEST_P(Lines, OwnPlaces) {
  Asked asked{.width = 4, .places = {{0, 0}}};
  Image image = draw(asked, {lines({flat(0, 0, 0), flat(3, 0, 3)}, {}, {0, 3})});
  EXPECT_EQ(indices(image.index), "000.");
  EXPECT_EQ(depth(image, 1), 1);
  EXPECT_EQ(values(image, 2), (Floats{2, 2, 0}));
  EXPECT_EQ(counts(asked, lines({flat(0, 0.5f), flat(3, 0.5f)})), "111.")
      << "+y moves the corner of the diamond over it";
  EXPECT_EQ(counts(asked, with(lines({flat(0, 0.5f), flat(3, 0.5f)}), FillRule::bottom_left)), "....");
  EXPECT_EQ(counts(asked, points({flat(1.25f, 0.25f)})), ".1..");
  EXPECT_EQ(counts(asked, lines({flat(0.5f, 0.5f), flat(2.5f, 0.5f)}, 1.25f)), ".11.");
  asked.places = {{4, 4}};
  image = draw(asked, {points({flat(1.25f, 0.25f, 0.5f)}, {}, {3})});
  EXPECT_EQ(indices(image.index), ".0..");
  // Two samples at one place.
  Asked two{.width = 3, .samples = 2, .places = {{8, 8}, {8, 8}}};
  EXPECT_EQ(counts(two, lines({flat(1, 0.5f), flat(3, 0.5f)}, 1)), "..1111");
}

TEST_P(Lines, Origin) {
  for (const int x : {0, 7, -5000, kMaxOrigin, -kMaxOrigin}) {
    for (const int y : {0, -3, kMaxOrigin}) {
      Asked asked{.width = 5, .height = 2, .origin = {x, y}};
      const auto at = [&](float dx, float dy) {
        return flat(static_cast<float>(x) + dx, static_cast<float>(y) + dy, dx);
      };
      const Image image = draw(asked, {lines({at(0.5f, 0.5f), at(3.5f, 0.5f)}), points({at(4.5f, 1.5f)})});
      EXPECT_EQ(picture(image.count, 5), "111../....1");
      EXPECT_EQ(depth(image, 1), 1.5f);
      Mesh wide = lines({at(0, 1), at(5, 1)}, 3);
      wide.state.scissor = Scissor{x + 1, y, x + 3, y + 5};
      EXPECT_EQ(counts(asked, wide), ".11../.11..");
    }
  }
}

// Nothing is culled, and winding adds 0.
TEST_P(Lines, NoFacing) {
  Mesh triangle({flat(0, 0, 1), flat(8, 0, 1), flat(0, 8, 1)});
  for (const Cull cull : {Cull::none, Cull::front, Cull::back}) {
    for (const FrontFace front : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
      Mesh line = lines({flat(0, 0.5f), flat(3.25f, 0.5f)}), point = points({flat(1.5f, 0.5f)});
      line.state.cull = point.state.cull = cull;
      line.state.front_face = point.state.front_face = front;
      const Image image = draw({.width = 4}, {line, triangle, point});
      EXPECT_EQ(picture(image.count, 4), "2321");
      EXPECT_EQ(picture(image.winding, 4), "1111");
      EXPECT_EQ(image.covered, (std::vector<std::vector<std::uint64_t>>{{3}, {4}, {1}}));
      EXPECT_EQ(image.visible, (std::vector<std::vector<std::uint64_t>>{{3}, {1}, {0}})) << "depth 0 comes first";
    }
  }
}

// V1 to V5, M5: as triangles. Lines along a row.
TEST_P(Lines, Visibility) {
  const auto row = [](std::vector<float> depths) {
    std::vector<Vertex> v;
    for (const float z : depths) v.insert(v.end(), {flat(-1, 0.5f, z), flat(9, 0.5f, z)});
    return lines(v);
  };
  Asked asked{.width = 1};
  const auto seen_index = [&](const Asked& a, const std::vector<Mesh>& meshes) {
    return indices(draw(a, meshes).index);
  };
  EXPECT_EQ(seen_index(asked, {row({0.5f, 0.25f, 0.25f, 0.75f})}), "1");
  asked.depth_test = DepthTest::greater_equal;
  EXPECT_EQ(seen_index(asked, {row({0.5f, 0.75f, 0.75f, 0.25f})}), "2");
  asked.layers = 5;
  EXPECT_EQ(seen_index(asked, {row({0.5f, 0.75f, 0.75f, 0.25f})}), "2103.");
  asked = {.width = 1, .initial_depth = {0.5f}};
  EXPECT_EQ(seen_index(asked, {row({0.5f})}), ".");
  EXPECT_EQ(seen_index(asked, {row({0.5f, 0.25f})}), "1");
  Mesh unwritten = row({0.25f, 0.125f, 0.75f});
  unwritten.state.depth_write = false;
  const Image image = draw(asked, {unwritten});
  EXPECT_EQ(indices(image.index), "1") << "the last that passes";
  EXPECT_EQ(depth(image, 0), 0.5f);
  Mesh named = row({0.5f, 0.5f});
  named.identifiers = {9, 4};
  EXPECT_EQ(seen_index({.width = 1}, {named}), "4");
  // I5, tested at each sample.
  Mesh slope = lines({flat(0, 0.5f, -1), flat(8, 0.5f, 7)});  // z = x - 1 at x = 0.5, 1.5, 2.5, 3.5
  slope.state.depth_mode = DepthMode::clip;
  EXPECT_EQ(seen_index({.width = 4}, {slope}), ".0..");
  EXPECT_EQ(picture(draw({.width = 4}, {slope}).count, 4), ".1..");
  slope.state.depth_mode = DepthMode::clamp;
  const Image clamped = draw({.width = 4}, {slope});
  EXPECT_EQ(indices(clamped.index), "0000");
  EXPECT_EQ(depth(clamped, 0), 0);
  EXPECT_EQ(depth(clamped, 1), 0.5f);
  EXPECT_EQ(depth(clamped, 2), 1);
}

// B1: an end or an attribute that is not finite drops its line, and that alone. What a line does not have, it does not
// read.
TEST_P(Lines, NotFinite) {
  const Asked asked{.width = 4};
  const std::vector<Vertex> v = {flat(0, 0.5f), flat(2.25f, 0.5f), flat(2.25f, 0.5f), flat(4.25f, 0.5f),
                                 flat(9, 0.5f, kNaN)};
  Mesh strip = lines(v, {}, {1, 1, 1, 1, 1});
  strip.indices = {0, 1, 2, 3};
  EXPECT_EQ(counts(asked, strip), "1111");
  for (const std::size_t vertex : {0u, 1u}) {
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
      Mesh mesh = strip;
      mesh.values[vertex] = bad;
      EXPECT_EQ(counts(asked, mesh), "..11");
      for (float Vertex::*component : {&Vertex::x, &Vertex::y, &Vertex::z, &Vertex::w}) {
        mesh = strip;
        mesh.vertices[vertex].*component = bad;
        EXPECT_EQ(counts(asked, mesh), "..11");
      }
    }
  }
  Mesh point = points(v, {}, {1, 1, 1, 1, 1});
  point.indices = {1, 4, 0};
  point.vertices[1].x = 1.5f, point.vertices[0].x = 2.5f;
  EXPECT_EQ(counts(asked, point), ".11.");
}

// In a frame with a conservative draw M4c's index is of lines, too.
TEST_P(Lines, BesideConservative) {
  Mesh triangle({flat(1, 0), flat(2, 0), flat(1, 1)});
  triangle.state.conservative = Conservative::over;  // touches the pixels 0 to 2
  triangle.state.first_index = 5;
  Mesh line = lines({flat(0, 0.5f), flat(2.25f, 0.5f)}), point = points({flat(3.5f, 0.5f)});
  line.state.first_index = 3, point.state.first_index = 8;
  const Image image = draw({.width = 5}, {triangle, line, point});
  EXPECT_EQ(picture(image.count, 5), "2211.");
  EXPECT_EQ(indices(image.index), "3358.");
}

}  // namespace
}  // namespace surefill::modes
