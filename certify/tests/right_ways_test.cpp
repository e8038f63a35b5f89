// SPDX-License-Identifier: Apache-2.0
//
// Right ways that were once called wrong, each as the judge sees it, and beside each one what is still wrong.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "certify/judge/images.hpp"
#include "certify/judge/inference.hpp"
#include "certify/judge/questions.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/model.hpp"

namespace surefill::judge {
namespace {

using corpus::Image;
using corpus::Scene;

Terms known_terms() {
  Terms terms;
  terms.known = true;
  return terms;
}

// What the judge says of a picture that is made from one where everything that may be covered is.
std::string said_of(const Scene& scene, const Terms& terms, const corpus::Outputs& outputs,
                    const std::function<void(Image&)>& change) {
  corpus::Frame frame(scene, outputs);
  Image image = frame.image();
  const Frame seen{scene.width, scene.height, scene.samples, scene.depth_test, false, frame.draws()};
  image.count = counts_under(adapters::oracle_expected(), terms, seen).most;
  change(image);
  if (!outputs.count) image.count.clear();
  return judge_image(adapters::oracle_expected(), terms, seen, image, {}, {}).finding;
}

Scene alone(int width, int height, const std::array<corpus::SceneVertex, 3>& triangle) {
  Scene scene = empty_scene(width, height);
  add_triangle(scene.draws[0], triangle);
  return scene;
}

// A depth beyond 0 to 1 is what the buffer makes of it, whose format may not hold it.
TEST(RightWays, DepthBeyondTheFormat) {
  Terms terms = known_terms();
  terms.model.format = oracle::DepthFormat::unorm16;
  terms.model.later_wins = true, terms.model.clear = 1;
  const auto kept = [&terms](float z, float as) {
    const Scene scene = alone(1, 1, {corner(-1, -1, z), corner(3, -1, z), corner(-1, 3, z)});
    return said_of(scene, terms, {true, true, true, false, false},
                   [as](Image& image) { image.index = {0}, image.depth = {as}; });
  };
  EXPECT_EQ(kept(2, 1), "");
  EXPECT_EQ(kept(-1, 0), "");
  EXPECT_EQ(kept(0.5f, 0.5f), "");
  EXPECT_NE(kept(0.5f, 0.75f), "");
  terms.model.format = oracle::DepthFormat::float32;
  EXPECT_EQ(kept(2, 1), "");
  // Of 32 bits.
  const double fixed = std::floor(8.8e-10 * 0xFFFFFFFF) / 0xFFFFFFFF;
  EXPECT_EQ(kept(8.8e-10f, static_cast<float>(fixed)), "");
}

// G2 has the attributes of a sample beside the triangle with each weight of the wrong sign counted as 0.
TEST(RightWays, WeightsBesideASnappedTriangle) {
  Scene scene = alone(1, 3, {corner(10, 1), corner(12, 1), corner(-5, 4)});
  scene.draws[0].grid = Grid{1, 0, 2, GridRounding::truncate};
  Terms terms = known_terms();
  terms.draws_own_grid = true;
  const auto weights = [&](const std::array<float, 3>& b) {
    return said_of(scene, terms, {true, true, false, true, false}, [&b](Image& image) {
      ASSERT_EQ(image.count[2], 1u);
      image.index = {kNoTriangle, kNoTriangle, 0};
      for (std::size_t s = 0; s < 2; ++s) {
        if (image.count[s] == 1) image.count[s] = 0;
      }
      std::copy(b.begin(), b.end(), image.barycentrics.begin() + 6);
    });
  };
  EXPECT_EQ(weights({0.75f, 0, 0.25f}).find("barycentric"), std::string::npos) << weights({0.75f, 0, 0.25f});
  EXPECT_NE(weights({-5, 1, 5}).find("barycentric"), std::string::npos);
}

// Whose counts are of what is seen, and is cleared to 0 for GREATER, sees nothing at 0.
TEST(RightWays, WhatTheClearValueHidesIsNotCounted) {
  Terms terms = known_terms();
  terms.counts_seen = true, terms.model.clear = 1;
  const auto counted = [&terms](float z, std::uint32_t count) {
    Scene scene = alone(1, 1, {corner(-1, -1, z), corner(3, -1, z), corner(-1, 3, z)});
    scene.depth_test = DepthTest::greater;
    return said_of(scene, terms, {true, false, false, false, false}, [count](Image& image) { image.count = {count}; });
  };
  EXPECT_EQ(counted(0, 0), "");
  EXPECT_EQ(counted(-1, 0), "");
  EXPECT_EQ(counted(2, 1), "");
  EXPECT_NE(counted(0.5f, 0), "");
}

// Which places of a corner the division leaves open says how small a triangle may be.
TEST(RightWays, SmallAreasUnderRoundings) {
  oracle::Model model;
  for (oracle::AxisModel* axis : {&model.x, &model.y}) {
    axis->bits = 4, axis->rounding = oracle::Rounding::nearest_up, axis->divided_blur = 1.0 / 256;
  }
  const std::array<Vertex, 3> triangle{
      {{0.75f, 0.5f, 0, 1.375f}, {0.6875f, 0.75f, 0, 1.375f}, {0.5625f, 0.4375f, 0, 1.375f}}};
  const auto answer = [&](double least) {
    model.least_area = least;
    return oracle::cover(model, 1, 1, 1, triangle)[0];
  };
  EXPECT_EQ(answer(0), oracle::Cover::yes);
  EXPECT_EQ(answer(0.0193), oracle::Cover::open);
  // And one that is turned by the grid.
  model.turned = oracle::Turned::as_grid;
  for (oracle::AxisModel* axis : {&model.x, &model.y}) axis->divided_blur = 0;
  const std::array<Vertex, 3> turned{{{0.46875f, 0.40625f, 0, 1}, {0.53125f, 0.40625f, 0, 1}, {0.5f, 0.40f, 0, 1}}};
  for (const double least : {0.0, 0.02}) {
    model.least_area = least;
    const oracle::Cover at = oracle::cover(model, 1, 1, 1, turned)[0];
    EXPECT_TRUE(least == 0 || at != oracle::Cover::yes);
  }
}

// A clipper in float32 at W = 1e-7 moves what it cuts by more than a pixel, and the values there.
TEST(RightWays, NewVerticesAreRounded) {
  oracle::Model model;
  const std::array<Vertex, 3> far{{{0x1p-23f, 0, 0, 0}, {1, -1, 0, 0}, {2.5f, 1, 0, 1}}};
  EXPECT_EQ(oracle::cover(model, 3, 1, 1, far)[2], oracle::Cover::no);
  model.least_w = 1e-7;
  EXPECT_EQ(oracle::cover(model, 3, 1, 1, far)[2], oracle::Cover::open);
  model.least_w = 1.0 / 64;
  const std::array<Vertex, 3> near{{{-8, 2, 0, 1}, {8, 2, 0, 1}, {0, 6, 0, -1}}};
  EXPECT_EQ(oracle::cover(model, 3, 3, 1, near)[1], oracle::Cover::no);

  Terms terms = known_terms();
  terms.model.least_w = 0.1;
  const Scene flat =
      alone(1, 1, {corner(0, 0.5, 0.40796, 1024), corner(0, 2, 0.40796, 4), corner(16, 0, 0.40796, 0.0625)});
  const auto kept = [&](float z) {
    return said_of(flat, terms, {true, true, true, false, false},
                   [z](Image& image) { image.index = {0}, image.depth = {z}; });
  };
  EXPECT_EQ(kept(0.40803f), "");
  EXPECT_NE(kept(0.5f), "");
}

// A clipper's pieces of a triangle may lie one over the other where roundings of its new vertices are large, and not else.
TEST(RightWays, PiecesOfWhatIsCut) {
  const Scene scene = alone(3, 3, {corner(0x1p-23f, 0, 0, 0), corner(1, -1, 0, 0), corner(2.5f, 1, 0, 1)});
  Terms terms = known_terms();
  const auto counted = [&](double least_w, std::uint32_t count) {
    terms.model.least_w = least_w;
    return said_of(scene, terms, {true, false, false, false, false}, [count](Image& image) {
      for (std::uint32_t& c : image.count) c = c == 0 ? 0 : count;
    });
  };
  EXPECT_EQ(counted(1e-7, 1), "");
  EXPECT_EQ(counted(1e-7, 8), "");
  EXPECT_NE(counted(1e-7, 9), "");
  EXPECT_EQ(counted(1.0 / 64, 1), "");
  EXPECT_NE(counted(1.0 / 64, 2), "");
}

// Positions are rounded to whole pixels; the samples are in their middles, or at their corners.
class WholePixels : public Rival {
 public:
  WholePixels(double place, bool wrong) : place_(place), wrong_(wrong) {}
  corpus::Outputs outputs() const override { return {true, false, false, false, false}; }
  double position_step() const override { return 0; }
  Image draw(const Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Frame frame(scene, wanted);
    Image& image = frame.image();
    for (const corpus::SceneDraw& draw : scene.draws) {
      for (const corpus::SceneTriangle& triangle : draw.triangles) {
        std::array<std::array<double, 2>, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) {
          const corpus::SceneVertex& v = draw.vertices[triangle.vertices[i]];
          if (!(v.w > 0)) throw Declined("behind the eye");
          p[i] = {std::floor(double{v.x} / v.w + 0.5), std::floor(double{v.y} / v.w + 0.5)};
        }
        cover(p, scene.width, scene.height, image.count);
      }
    }
    return std::move(image);
  }

 private:
  void cover(std::array<std::array<double, 2>, 3> p, int width, int height, std::vector<std::uint32_t>& count) const {
    const auto turn = [](const auto& a, const auto& b, double x, double y) {
      return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    };
    const double area = turn(p[0], p[1], p[2][0], p[2][1]);
    if (area == 0) return;
    if (area < 0) std::swap(p[1], p[2]);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const auto &a = p[i], &b = p[(i + 1) % 3];
          const double e = turn(a, b, x + place_, y + place_);
          const bool owned = b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
          inside = inside && (e > 0 || (e == 0 && owned != wrong_));
        }
        if (inside) ++count[static_cast<std::size_t>(y * width + x)];
      }
    }
  }

  double place_;
  bool wrong_;
};

TEST(RightWays, WhatIsStatedOfWholePixelsIsConfirmed) {
  for (const double place : {0.0, 0.5}) {
    Model stated;
    for (oracle::AxisModel* axis : {&stated.x, &stated.y}) {
      axis->bits = 0, axis->rounding = oracle::Rounding::nearest_up, axis->place = place;
    }
    for (const bool wrong : {false, true}) {
      WholePixels rival(place, wrong);
      const Inference found = infer(rival, adapters::oracle_expected(), stated);
      EXPECT_EQ(found.known && differences(stated, found.model).empty(), !wrong) << place << describe(found.model);
    }
  }
}

// It may as well be that nothing is known of it: then nothing is said.
TEST(RightWays, NotesSayWhatIsKnown) {
  const auto notes = [](const Model& model) {
    std::string text;
    for (const std::string& sentence : departures(model)) text += sentence + "\n";
    return text;
  };
  Model model;
  model.clear = 1, model.clipped = {-INFINITY, 1.0};
  EXPECT_EQ(notes(model), "depth is cleared to 1, so nothing there or beyond is seen\n");
  model.later_wins = true;
  EXPECT_EQ(notes(model).find("nothing beyond is seen"), notes(model).find("nothing"));
}

}  // namespace
}  // namespace surefill::judge
