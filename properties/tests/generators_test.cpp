// SPDX-License-Identifier: Apache-2.0
//
// The generators: the same everywhere, legal, and as hard as they claim.
#include "properties/generators/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "properties/generators/near_zero.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

const Category& category(std::string_view name) {
  for (const Category& c : categories())
    if (name == c.name) return c;
  throw std::runtime_error("no category " + std::string(name));
}

TEST(Random, IsSplitMix64) {
  Random random(0);  // Vigna's reference implementation
  EXPECT_EQ(random.bits(), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(random.bits(), 0x6E789E6AA1B965F4u);
  EXPECT_EQ(random.bits(), 0x06C45D188009454Fu);
}

TEST(Random, ReachesBothEnds) {
  Random random(1);
  std::set<int> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.between(-2, 3));
  EXPECT_EQ(seen, (std::set<int>{-2, -1, 0, 1, 2, 3}));
  EXPECT_NO_THROW((void)random.between(-2147483647 - 1, 2147483646));
  for (int i = 0; i < 1000; ++i) {
    const double u = random.unit();
    ASSERT_TRUE(u >= 0 && u < 1);
  }
}

TEST(Categories, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const Category& c : categories()) EXPECT_TRUE(names.insert(c.name).second) << c.name;
  EXPECT_GE(names.size(), 30u);
}

TEST(Properties, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const Property& p : all_properties()) EXPECT_TRUE(names.insert(p.name).second) << p.name;
}

// Every scene passes the engine's checks and is read back as it was written.
void expect_legal(const corpus::Scene& scene) {
  corpus::Frame frame(scene, outputs_of(scene));
  ASSERT_EQ(validate(frame.target(), frame.draws()), Status::ok)
      << status_text(validate(frame.target(), frame.draws())) << "\n"
      << corpus::write_scene(scene);
  ASSERT_TRUE(corpus::equal(corpus::read_scene(corpus::write_scene(scene)), scene)) << corpus::write_scene(scene);
}

TEST(Scenes, AreLegal) {
  const SceneLimits limits[] = {{1, 1, true, true, true, true, true},
                                {16, 4, true, true, false, false, false},
                                {7, 9, true, true, true, true, true},
                                {5, 2, false, false, true, true, true}};
  for (const Category& c : categories())
    for (const SceneLimits& l : limits)
      for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const corpus::Scene scene = random_scene(c, seed, l);
        EXPECT_LE(std::max(scene.width, scene.height), l.max_size);
        expect_legal(scene);
      }
}

TEST(Cases, AreLegalAndTheSameEachTime) {
  for (const Property& property : all_properties())
    for (std::uint64_t n = 0; n < 40; ++n) {
      const corpus::Scene scene = property.make(n);
      expect_legal(scene);
      ASSERT_TRUE(corpus::equal(scene, property.make(n))) << property.name << " " << n;
    }
}

// The number may change with a generator, but never with compiler or machine.
TEST(Scenes, AreTheSameEverywhere) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const Category& c : categories())
    for (std::uint64_t seed = 0; seed < 50; ++seed)
      for (const char byte : corpus::write_scene(random_scene(c, seed, {9, 5, true, true, true, true, true})))
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3u;
  EXPECT_EQ(hash, 0x207FC77335718228u);
}

struct Share {
  int covering = 0, cases = 0;
};

Share covering(const Category& c) {
  Share share;
  const Renderer engine = engine_renderer();
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    Trial trial(engine);
    const auto image = trial.draw(triangle_scene(12, 9, c.triangle(random, 12, 9)), kCountOnly);
    share.covering += std::any_of(image->count.begin(), image->count.end(), [](std::uint32_t n) { return n != 0; });
    ++share.cases;
  }
  return share;
}

TEST(Categories, CoverSomethingOrNothingAsTheySay) {
  const std::set<std::string_view> nothing = {"behind", "equal-vertices", "collinear", "not-finite"};
  for (const Category& c : categories()) {
    const Share share = covering(c);
    if (nothing.contains(c.name)) {
      EXPECT_EQ(share.covering, 0) << c.name;
    } else if (std::string_view(c.name) != "near-degenerate") {  // a plane seen edge-on meets a sample by chance only
      EXPECT_GE(share.covering * 20, share.cases) << c.name << ": in " << share.covering << " of " << share.cases;
    }
  }
}

Vertex sample_at(int x, int y) {
  return {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 1};
}

// Edges of the triangle that run exactly through samples of the target.
int ties(const std::array<Vertex, 3>& t, int width, int height) {
  int found = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t i = 0; i < 3; ++i) found += facing({t[i], t[(i + 1) % 3], sample_at(x, y)}) == 0;
  return found;
}

TEST(Categories, RunThroughSamplesWhereTheySay) {
  for (const char* name : {"vertex-on-sample", "edge-horizontal", "edge-vertical", "edge-diagonal",
                           "edge-through-samples", "near-degenerate-tied"})
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      Random random(seed);
      ASSERT_GE(ties(category(name).triangle(random, 12, 9), 12, 9), 1) << name << " " << seed;
    }
}

// Double arithmetic, each operation rounded, gets these wrong: that is what they are for.
TEST(NearZero, DefeatsDouble) {
  int wrong_edges = 0, wrong_determinants = 0;
  const auto rounded_sign = [](const Vertex& a, const Vertex& b, const Vertex& c) {
    const double x = static_cast<double>(a.y) * b.w - static_cast<double>(a.w) * b.y;
    const double y = static_cast<double>(a.w) * b.x - static_cast<double>(a.x) * b.w;
    const double w = static_cast<double>(a.x) * b.y - static_cast<double>(a.y) * b.x;
    const double d = x * c.x + y * c.y + w * c.w;
    return (d > 0) - (d < 0);
  };
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const std::array<Vertex, 3> tied = nearly_tied_triangle(random, 12, 9);
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 12; ++x)
        wrong_edges += rounded_sign(tied[0], tied[1], sample_at(x, y)) != facing({tied[0], tied[1], sample_at(x, y)});
    const std::array<Vertex, 3> flat = nearly_degenerate_triangle(random);
    wrong_determinants += rounded_sign(flat[0], flat[1], flat[2]) != facing(flat);
  }
  EXPECT_GE(wrong_edges, 10);
  EXPECT_GE(wrong_determinants, 10);
}

}  // namespace
}  // namespace surefill::properties
