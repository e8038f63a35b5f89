// SPDX-License-Identifier: Apache-2.0
//
// What wrong images have in common, in a sentence: of faults that are made here, and whose sentence is known.
#include "certify/judge/symptoms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "certify/judge/probes.hpp"
#include "oracle/oracle.hpp"

namespace surefill::judge {
namespace {

using corpus::Scene;
using Fault = std::function<void(Scene& scene)>;          // what it makes of a scene
using After = std::function<void(corpus::Image& image)>;  // and of an image

corpus::Image right_image(const Scene& scene) {
  corpus::Frame frame(scene, {true, true, true, false, false});
  oracle::render(frame.target(), frame.draws());
  return std::move(frame.image());
}

// The first sentence about 40 scenes of one to three triangles of very different sizes.
std::string said_of(const Fault& before, const After& after) {
  const auto both = [&](const Scene& scene) -> std::optional<Wrong> {
    Scene changed = scene;
    if (before) before(changed);
    Wrong shown{scene, right_image(scene), right_image(changed)};
    if (after) after(shown.rival);
    return shown;
  };
  const auto differ = [](const Wrong& w) {
    return w.right.count != w.rival.count || w.right.index != w.rival.index || w.right.depth != w.rival.depth;
  };
  const Trials trials{[&](const Scene& scene) { return differ(*both(scene)); }, both};
  Random random(7);
  std::vector<Wrong> wrong;
  std::vector<Scene> fine;
  for (int n = 0; n < 40; ++n) {
    std::vector<FlatTriangle> triangles;
    for (int t = 0; t <= n % 3; ++t) {
      const double size = n % 2 == 0 ? 14 : 2.5, x = 16 * random.unit(), y = 16 * random.unit();
      FlatTriangle triangle{};
      for (Point& p : triangle) {
        p = {static_cast<float>(x + size * (random.unit() - 0.5)),
             static_cast<float>(y + size * (random.unit() - 0.5))};
      }
      triangles.push_back(triangle);
    }
    const Scene scene = flat_scene(16, 16, triangles, static_cast<float>(0.125 + 0.02 * n));
    const Wrong shown = *both(scene);
    if (differ(shown)) {
      wrong.push_back(shown);
    } else {
      fine.push_back(scene);
    }
  }
  const std::vector<std::string> sentences = symptoms(wrong, fine, trials);
  return sentences.empty() ? "" : sentences.front();
}

Fault without(const std::function<bool(const corpus::SceneDraw&, const corpus::SceneTriangle&)>& lost) {
  return [lost](Scene& scene) {
    corpus::SceneDraw& draw = scene.draws[0];
    std::erase_if(draw.triangles, [&](const corpus::SceneTriangle& t) { return lost(draw, t); });
  };
}

double twice_area(const corpus::SceneDraw& draw, const corpus::SceneTriangle& t) {
  const auto &a = draw.vertices[t.vertices[0]], &b = draw.vertices[t.vertices[1]], &c = draw.vertices[t.vertices[2]];
  return (double{b.x} - a.x) * (double{c.y} - a.y) - (double{b.y} - a.y) * (double{c.x} - a.x);
}

TEST(Symptoms, AreSaid) {
  const auto of_images = [](const auto& change) { return said_of(nullptr, change); };
  EXPECT_EQ(said_of(nullptr, nullptr), "");
  const std::string small =
      said_of(without([](const auto& draw, const auto& t) { return std::abs(twice_area(draw, t)) < 8; }), nullptr);
  EXPECT_NE(small.find("are not drawn"), std::string::npos) << small;
  EXPECT_NE(small.find("less than"), std::string::npos) << small;
  const std::string back =
      said_of(without([](const auto& draw, const auto& t) { return twice_area(draw, t) < 0; }), nullptr);
  EXPECT_NE(back.find("face away"), std::string::npos) << back;
  EXPECT_EQ(of_images([](corpus::Image& image) {
              for (std::uint32_t& n : image.count) n *= 2;
            }),
            "every count is twice what it should be");
  EXPECT_EQ(of_images([](corpus::Image& image) { std::fill(image.count.begin(), image.count.end(), 0u); }),
            "nothing is drawn at all");
  EXPECT_EQ(of_images([](corpus::Image& image) {
              for (std::uint32_t& n : image.index) n = n == kNoTriangle ? n : n + 1;
            }),
            "every index is 1 too large");
  EXPECT_NE(of_images([](corpus::Image& image) {
              for (std::size_t s = 0; s < image.count.size(); ++s) image.count[s] = s % 16 == 15 ? 0 : image.count[s];
            }).find("last column"),
            std::string::npos);
  const std::string depth = of_images([](corpus::Image& image) {
    for (float& z : image.depth) z = 2 * z - 1;
  });
  EXPECT_EQ(depth, "depth is 2 z -1, z being what it should be");
}

// What a scene needs is found by taking parts away: where there is nothing to take, nothing is.
TEST(Symptoms, AFirstDrawMayHaveNoTriangles) {
  std::vector<Wrong> wrong;
  for (int n = 0; n < 12; ++n) {
    const FlatTriangle triangle = {Point{1, 1}, Point{14, static_cast<float>(n)}, Point{3, 15}};
    Wrong& shown = wrong.emplace_back();
    shown.scene = flat_scene(16, 16, {triangle}, 0.5F);
    shown.scene.draws.insert(shown.scene.draws.begin(), corpus::SceneDraw{});
    shown.right.width = shown.right.height = shown.rival.width = shown.rival.height = 16;
    shown.right.count.assign(256, 1), shown.rival.count = shown.right.count;
    shown.rival.count[static_cast<std::size_t>(17 * n + 3)] = 0,
                                                        shown.rival.count[static_cast<std::size_t>(11 * n)] = 3;
  }
  std::size_t tried = 0;
  const auto still_wrong = [&tried](const Scene& scene) {
    tried += scene.draws.size() == 1 && scene.draws[0].triangles.empty();
    return true;
  };
  (void)symptoms(wrong, {}, {still_wrong, [](const Scene&) { return std::nullopt; }});
  EXPECT_EQ(tried, wrong.size());
}

// Depths that differ by roundings alone are not what is wrong.
TEST(Symptoms, RoundingsOfDepthSayNothing) {
  std::vector<Wrong> wrong;
  for (int n = 0; n < 12; ++n) {
    Wrong& shown = wrong.emplace_back();
    shown.scene = flat_scene(16, 16, {{Point{1, 1}, Point{14, static_cast<float>(n)}, Point{3, 15}}}, 0.3F);
    shown.right = shown.rival = right_image(shown.scene);
    for (std::uint32_t& index : shown.rival.index) index = index == kNoTriangle ? index : index + 7;
    for (float& z : shown.rival.depth) z = std::isinf(z) ? z : std::nextafter(z, 0.0F);
  }
  const Trials trials{[](const Scene&) { return true; }, [&](const Scene&) { return std::optional(wrong[0]); },
                      0x1p-16};
  for (const std::string& sentence : symptoms(wrong, {}, trials)) {
    EXPECT_EQ(sentence.find("depth"), std::string::npos) << sentence;
  }
}

// What the rival does not draw is not right, so nothing is said to be needed by that.
TEST(Symptoms, WhatIsNotDrawnIsNotRight) {
  for (const bool draws : {true, false}) {
    std::vector<Wrong> wrong;
    for (int n = 0; n < 12; ++n) {
      Wrong& shown = wrong.emplace_back();
      shown.scene = flat_scene(16, 16, {{Point{1, 1}, Point{14, static_cast<float>(n)}, Point{3, 15}}}, 0.5F);
      shown.scene.draws[0].grid = Grid{};
      shown.right.width = shown.right.height = shown.rival.width = shown.rival.height = 16;
      shown.right.samples = shown.rival.samples = 1;
      shown.right.count.assign(256, 1), shown.rival.count = shown.right.count;
      shown.rival.count[static_cast<std::size_t>(17 * n + 3)] = 0;
      shown.rival.count[static_cast<std::size_t>(11 * n)] = 3;
    }
    const auto needed = symptoms(wrong, {},
                                 {[](const Scene& scene) { return scene.draws[0].grid.has_value(); },
                                  [&](const Scene&) { return draws ? std::optional(wrong[0]) : std::nullopt; }});
    const bool said = !needed.empty() && needed.front() == "it is only wrong with the draw's grid";
    EXPECT_EQ(said, draws);
  }
}

}  // namespace
}  // namespace surefill::judge
