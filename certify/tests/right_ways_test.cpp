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
#include "certify/rivals/stated_model.hpp"

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

// A vertex that surely lies on the sample decides where vertices are overruled, whatever comes of the others.
TEST(RightWays, AVertexOnTheSampleDecides) {
  oracle::Model model;
  for (oracle::AxisModel* axis : {&model.x, &model.y}) axis->bits = 4, axis->divided_blur = 1.0 / 256;
  // The third vertex is a tie of the grid, and its W no power of two.
  const std::array<Vertex, 3> triangle{{{0, 1, 0, 1}, {8, 8, 0, 16}, {0x1.c8p-7f, 0, 0, 0x1.8p-6f}}};
  const auto answer = [&](oracle::AtVertices vertices) {
    model.vertices = vertices;
    return oracle::cover(model, 1, 1, 1, triangle)[0];
  };
  EXPECT_EQ(answer(oracle::AtVertices::covered), oracle::Cover::yes);
  EXPECT_EQ(answer(oracle::AtVertices::not_covered), oracle::Cover::no);
  EXPECT_EQ(answer(oracle::AtVertices::open), oracle::Cover::open);
}

// Ties on slanted edges go by a rounding where slopes are floating point, so nobody owes them who says nothing of them.
TEST(RightWays, SlopesDecideTiesOnAGrid) {
  Terms terms = known_terms();
  for (oracle::AxisModel* axis : {&terms.model.x, &terms.model.y}) axis->bits = 4;
  const auto said = [&terms](const std::array<corpus::SceneVertex, 3>& triangle, std::uint32_t count) {
    return said_of(alone(1, 1, triangle), terms, {true, false, false, false, false},
                   [count](Image& image) { image.count = {count}; });
  };
  const std::array<corpus::SceneVertex, 3> slanted{corner(-7, -12), corner(2, 3), corner(0, 0)},
      upright{corner(0.5, -12), corner(2, 3), corner(0.5, 3)};
  EXPECT_NE(said(slanted, 0) == "", said(slanted, 1) == "");
  terms.rounds_slanted = true;
  EXPECT_EQ(said(slanted, 0), "");
  EXPECT_EQ(said(slanted, 1), "");
  EXPECT_NE(said(upright, 0), "");
  // Without a grid, and with a rule that is none of C3's, all edges are such.
  terms.model.x.bits = terms.model.y.bits = -1;
  EXPECT_NE(said(upright, 0), "");
  terms.model.front = terms.model.back = oracle::owners_of(FillRule::closed);
  EXPECT_EQ(said(upright, 0), "");
  EXPECT_EQ(said(upright, 1), "");
}

// What the test GREATER makes of depth at its clear value, which nobody states, is open.
TEST(RightWays, WhatIsStoredAtTheClearValueMayBeSeen) {
  Terms terms = known_terms();
  terms.counts_seen = true, terms.model.clear = 1, terms.model.later_wins = true;
  terms.model.format = oracle::DepthFormat::unorm16;
  Scene scene = alone(1, 1, {corner(-1, -1, -0.25), corner(3, -1, -0.25), corner(-1, 3, -0.25)});
  scene.depth_test = DepthTest::greater;
  for (const std::uint32_t count : {0u, 1u}) {
    EXPECT_EQ(
        said_of(scene, terms, {true, false, false, false, false}, [count](Image& image) { image.count = {count}; }),
        "");
  }
}

// Positions are rounded to a grid, ties up; the samples are in the middles of pixels, or at their corners.
class OnGrid : public Rival {
 public:
  OnGrid(int bits, double place, bool wrong) : steps_(std::ldexp(1, bits)), place_(place), wrong_(wrong) {}
  // Fragments of other depths, and smaller triangles, are left out.
  double near = -INFINITY, far = INFINITY, least_area = 0;
  corpus::Outputs outputs() const override { return {true, false, false, false, false}; }
  double position_step() const override { return 0; }
  Image draw(const Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Frame frame(scene, wanted);
    Image& image = frame.image();
    for (const corpus::SceneDraw& draw : scene.draws) {
      for (const corpus::SceneTriangle& triangle : draw.triangles) {
        std::array<std::array<double, 2>, 3> p{};
        bool clipped = false;  // flat ones
        for (std::size_t i = 0; i < 3; ++i) {
          const corpus::SceneVertex& v = draw.vertices[triangle.vertices[i]];
          if (!(v.w > 0)) throw Declined("behind the eye");
          clipped = clipped || !(double{v.z} / v.w >= near && double{v.z} / v.w <= far);
          p[i] = {std::floor(double{v.x} / v.w * steps_ + 0.5) / steps_,
                  std::floor(double{v.y} / v.w * steps_ + 0.5) / steps_};
        }
        if (!clipped) cover(p, scene.width, scene.height, image.count);
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
    if (area == 0 || std::abs(area) < 2 * least_area) return;
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

  double steps_, place_;
  bool wrong_;
};

// What is stated may be what is drawn in other words than probing finds, or more than it sees.
TEST(RightWays, WhatIsStatedIsConfirmed) {
  struct Case {
    int bits;
    double place;                                    // drawn
    double stated, within = 0, moved = 0, blur = 0;  // stated
  };
  constexpr Case kCases[] = {{0, 0, 0},
                             {0, 0.5, 0.5},
                             {4, 0.40625, 0.40625},    // no vertex lies on a sample
                             {8, 0.25, 0.5, 0, 0.25},  // the picture is moved
                             {8, 0.25, 0.28125, 0, 0.03125},
                             {8, 0.3, 0.3, 0.001},
                             {8, 0.5, 0.5, 0, 0, 0.0001}};
  for (const Case& one : kCases) {
    Model stated;
    for (oracle::AxisModel* axis : {&stated.x, &stated.y}) {
      axis->bits = one.bits, axis->rounding = oracle::Rounding::nearest_up, axis->place = one.stated;
      axis->place_within = one.within, axis->moved = one.moved, axis->blur = one.blur;
    }
    for (const bool wrong : {false, true}) {
      // Who owns edges is stated wrongly; where that is not seen, the place is.
      const bool unseen = one.within > 0 || one.blur > 0;
      OnGrid rival(one.bits, one.place + (wrong && unseen ? 1.0 / 64 : 0), wrong && !unseen);
      const Inference found = infer(rival, adapters::oracle_expected(), stated);
      EXPECT_EQ(found.known && differences(stated, found.model).empty(), !wrong)
          << one.bits << " " << one.place << " " << wrong << " " << describe(found.model);
    }
  }
}

// Adding 0.3 to the number of a pixel rounds it.
TEST(RightWays, PlacesThatAreStatedMayBeRounded) {
  surefill_adapter2_model stated = adapters::default_model();
  Model model;
  stated.x.place = 0.3, stated.y.place = 0.25, stated.y.moved = 0.1;
  ASSERT_EQ(adapters::take_model(stated, model), "");
  EXPECT_EQ(model.x.place_within, 0x1p-16);
  EXPECT_EQ(model.y.place_within, 0);
  EXPECT_EQ(model.x.blur, 0);
  EXPECT_EQ(model.y.blur, 0x1p-16);
}

// On the coarsest grids edges turn at few places, and on the finest one nothing lies between a place and the next but few numbers.
TEST(RightWays, CoarseAndFineGridsAreFound) {
  for (const int bits : {0, 1, 14, 15, 16}) {
    for (const double place : {0.0, 0.5}) {
      OnGrid rival(bits, place, false);
      const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
      Model due;
      for (oracle::AxisModel* axis : {&due.x, &due.y}) {
        axis->bits = bits, axis->rounding = oracle::Rounding::nearest_up, axis->place = place;
      }
      // No vertex lies on a sample: who owns it is not seen, and nothing is said of it.
      if (bits == 0 && place == 0.5) due.front.open = due.back.open = 0xFF;
      EXPECT_TRUE(found.known && differences(due, found.model).empty() && !found.model.draws_flat &&
                  found.model.x.blur == 0)
          << bits << " " << place << ": " << describe(found.model) << found.model.draws_flat << found.model.x.blur
          << testing::PrintToString(differences(due, found.model));
    }
  }
}

// Planes of depth that are its own, and triangles that it leaves out as too small.
TEST(RightWays, LimitsAreFound) {
  for (const auto& [near, far] : {std::array{0.25, 0.75}, {0.0001, 1.0}, {-1.0, 1.0}, {-0.5, 1.5}, {0.0, 100.0}}) {
    OnGrid rival(8, 0.5, false);
    rival.near = near, rival.far = far;
    const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
    ASSERT_TRUE(found.known && found.model.clipped);
    EXPECT_NEAR((*found.model.clipped)[0], near, 1e-7);
    EXPECT_NEAR((*found.model.clipped)[1], far, 1e-5);
  }
  for (const double least : {1e-3, 1e-7, 1e-9}) {
    OnGrid rival(16, 0.5, false);
    rival.least_area = least;
    const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
    EXPECT_TRUE(found.known && found.model.least_area >= least && found.model.least_area < 8 * least) << least;
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
