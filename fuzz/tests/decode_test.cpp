// SPDX-License-Identifier: Apache-2.0
//
// The decoders are total, and their encoders are their inverses; the mutator makes the coincidences that it promises.
#include "fuzz/decode.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>

#include "fuzz/mutate.hpp"
#include "properties/generators/generators.hpp"

// The mutator falls back on this one, which libFuzzer has.
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  if (size == 0 && max_size > 0) data[size++] = 0;
  if (size > 0) ++data[0];
  return size;
}

namespace surefill::fuzz {
namespace {

using corpus::Scene;
using properties::Random;

struct Form {
  const char* name;
  Scene (*decode)(std::span<const std::uint8_t>);
  std::optional<Bytes> (*encode)(const Scene&);
};

// For GoogleTest, which prints the bytes otherwise.
[[maybe_unused]] void PrintTo(const Form& form, std::ostream* out) {
  *out << form.name;
}

class Decode : public testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Forms, Decode,
                         testing::Values(Form{"triangle", decode_triangle, encode_triangle},
                                         Form{"grid", decode_grid_triangle, encode_grid_triangle},
                                         Form{"scene", decode_scene, encode_scene},
                                         Form{"samples", decode_samples, encode_samples},
                                         Form{"paths", decode_paths, encode_paths}),
                         [](const auto& form) { return std::string(form.param.name); });

Bytes random_bytes(Random& random) {
  Bytes bytes(random.below(700));
  // Small bytes keep the counts small and the floats subnormal; large ones make NaNs and infinities.
  const std::uint32_t range = random.one_in(2) ? 256 : 8;
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(range));
  for (std::uint32_t n = random.below(8); n > 0 && !bytes.empty(); --n) {
    bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = random.one_in(2) ? 0xFF : 0x7F;
  }
  return bytes;
}

TEST_P(Decode, EveryInputMeansAValidSceneThatItsFormEncodes) {
  Random random(1);
  for (int n = 0; n < 5000; ++n) {
    const Bytes bytes = random_bytes(random);
    const Scene scene = GetParam().decode(bytes);
    const corpus::Frame frame(scene);
    ASSERT_EQ(validate(frame.target(), frame.draws()), Status::ok) << corpus::write_scene(scene);
    const std::optional<Bytes> encoded = GetParam().encode(scene);
    ASSERT_TRUE(encoded) << corpus::write_scene(scene);
    const Scene again = GetParam().decode(*encoded);
    ASSERT_TRUE(corpus::equal(again, scene)) << corpus::write_scene(scene);
    ASSERT_EQ(GetParam().encode(again), encoded) << corpus::write_scene(scene);
  }
}

TEST_P(Decode, EverySceneCanBeWrittenAndRead) {
  Random random(2);
  for (int n = 0; n < 2000; ++n) {
    const Scene scene = GetParam().decode(random_bytes(random));
    const std::string text = corpus::write_scene(scene);
    ASSERT_TRUE(corpus::equal(corpus::read_scene(text), scene)) << text;
  }
}

TEST_P(Decode, MissingBytesAreZero) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    Bytes bytes = random_bytes(random);
    const Scene scene = GetParam().decode(bytes);
    bytes.resize(bytes.size() + 4096);
    EXPECT_TRUE(corpus::equal(GetParam().decode(bytes), scene));
  }
}

// What the fast path draws: all samples a pixel, on large targets as far as they stay quick, and depth write off.
TEST(DecodePaths, DrawsEveryNumberOfSamplesAndDepthWriteOff) {
  Random random(7);
  int several_on_a_large_side = 0, without_write = 0;
  std::map<int, int> of_samples;
  for (int n = 0; n < 2000; ++n) {
    const Scene scene = decode_paths(random_bytes(random));
    ++of_samples[scene.samples];
    several_on_a_large_side += scene.samples > 1 && std::max(scene.width, scene.height) > 64;
    for (const corpus::SceneDraw& draw : scene.draws) without_write += !draw.depth_write;
    ASSERT_LE(scene.width * scene.height * scene.samples, kMostPathSamples);
  }
  for (const int samples : {1, 2, 4, 8, 16}) EXPECT_GT(of_samples[samples], 40) << samples;
  EXPECT_GT(several_on_a_large_side, 40);
  EXPECT_GT(without_write, 40);
}

// The meaning of stored inputs: whoever changes it loses every corpus, and changes this test.
TEST(DecodeTriangle, TheFormIsStable) {
  Bytes bytes(kTriangleBytes);
  const auto put = [&bytes](std::size_t at, float value) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[at + i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(value) >> (8 * i));
    }
  };
  for (std::size_t i = 0; i < 12; ++i) put(4 * i, static_cast<float>(i) + 0.5f);
  for (std::size_t i = 0; i < 3; ++i) put(54 + 4 * i, -static_cast<float>(i));
  bytes[48] = 0x24;  // 5 x 3 pixels
  bytes[49] = 2 | 8 | 16 | 1 << 5;
  bytes[50] = 2, bytes[51] = 1, bytes[52] = 2, bytes[53] = 1;
  EXPECT_EQ(corpus::write_scene(decode_triangle(bytes)), corpus::write_scene(corpus::read_scene(R"(surefill-scene 1
target 5 3
samples 4
depth-test greater
attribute-location centroid
attribute a0 1 noperspective
draw
fill-rule bottom-left
front-face counter-clockwise
cull back
depth-mode clip
vertex 0.5 1.5 2.5 3.5 -0
vertex 4.5 5.5 6.5 7.5 -1
vertex 8.5 9.5 10.5 11.5 -2
triangle 0 1 2
end
)")));
}

// One scene with everything that the form has a place for.
const char* const kEverything = R"(surefill-scene 1
target 3 2
depth-test greater-equal
origin -4194304 7
sample-locations 15 0
outputs winding numbers conservative-index
attribute-location centroid
initial-depth 0x1p-1 0 -0 inf nan 2
attribute a0 2 noperspective
attribute a1 1 flat
draw
viewport 0 0 16 16 0 1 minus-one-to-one y-down
fill-rule northwards-west
front-face counter-clockwise
cull front
depth-mode clamp
depth-write off
scissor -3 0 126 2147483647
grid 4 15 3 nearest-up
depth-bias -0 0x1p-149
first-index 4294967290
vertex 0 0 0 1 1 2 3
vertex 1 0 0 -1 0x1p-149 nan -inf
vertex 0 1 0x1.fffffep+127 0 1 2 3
triangle 0 1 2
triangle 2 2 0
end
draw
culling-box 0 0 0 1 4 0 0 1 0 4 0 1 0 0 0 1 4 0 0 1 0 4 0 1 0 0 0 1 4 0 0 1
vertex 0 0 0 1 0 0 0
vertex 4 0 0 1 0 0 0
vertex 0 4 0 1 0 0 0
triangle 0 1 2 id 7
triangle 2 1 0 id 4294967294
end
draw
end
)";

TEST(DecodeScene, EverythingOfTheFormatHasAPlace) {
  const Scene scene = corpus::read_scene(kEverything);
  const std::optional<Bytes> bytes = encode_scene(scene);
  ASSERT_TRUE(bytes);
  const Scene again = decode_scene(*bytes);
  EXPECT_TRUE(corpus::equal(again, scene)) << corpus::write_scene(again);
  Scene conservative;
  conservative.draws.emplace_back().conservative = Conservative::inner;
  ASSERT_TRUE(encode_scene(conservative));
  EXPECT_TRUE(corpus::equal(decode_scene(*encode_scene(conservative)), conservative));
  Scene layered;
  layered.layers = kMaxLayers;
  layered.draws.emplace_back();
  ASSERT_TRUE(encode_scene(layered));
  EXPECT_TRUE(corpus::equal(decode_scene(*encode_scene(layered)), layered));
}

TEST(DecodeScene, WhatDoesNotFitIsRefused) {
  const Scene scene = corpus::read_scene(kEverything);
  const auto refused = [&scene](const auto& change) {
    Scene other = scene;
    change(other);
    return !encode_scene(other).has_value();
  };
  EXPECT_FALSE(refused([](Scene&) {}));
  EXPECT_TRUE(refused([](Scene& s) { s.width = 17; }));
  EXPECT_TRUE(refused([](Scene& s) { s.samples = 16, s.width = 5; }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws[0].scissor->x0 = 127; }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws[1].culling_box->at(7).z = 1; }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws[1].vertices.resize(kMaxVertices + 1); }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws[1].triangles.resize(kMaxTriangles + 1); }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws.resize(kMaxDraws + 1); }));
  EXPECT_TRUE(refused([](Scene& s) { s.draws.clear(); }));
}

TEST(DecodeScene, TrianglesOfASceneAreSeeds) {
  const Scene scene = corpus::read_scene(kEverything);
  const std::vector<Scene> singles = single_triangles(scene);
  ASSERT_EQ(singles.size(), 4u);
  for (const Scene& single : singles) {
    const bool grid = single.draws[0].grid.has_value();
    const std::optional<Bytes> bytes = grid ? encode_grid_triangle(single) : encode_triangle(single);
    ASSERT_TRUE(bytes);
    EXPECT_TRUE(corpus::equal(grid ? decode_grid_triangle(*bytes) : decode_triangle(*bytes), single));
  }
  EXPECT_EQ(singles[0].draws[0].vertices[1].x, 0.0f);  // 1 * 8 - 1 * (0 + 8): S3
  EXPECT_FALSE(encode_triangle(scene));
  Scene elsewhere = singles[1];
  elsewhere.origin.x = 1;
  EXPECT_FALSE(encode_triangle(elsewhere));
}

TEST(Mutate, KeepsScenesInTheirForm) {
  Random random(4);
  for (int n = 0; n < 20000; ++n) {
    Scene triangle = decode_triangle(random_bytes(random)), scene = decode_scene(random_bytes(random));
    mutate(triangle, random);
    mutate(scene, random);
    ASSERT_TRUE(encode_triangle(triangle)) << corpus::write_scene(triangle);
    ASSERT_TRUE(encode_scene(scene)) << corpus::write_scene(scene);
  }
}

TEST(Mutate, IsAFunctionOfItsSeedAndKeepsToTheSize) {
  Random random(5);
  for (unsigned seed = 0; seed < 2000; ++seed) {
    Bytes first = random_bytes(random);
    const std::size_t size = first.size(), max_size = size + random.below(64);
    first.resize(max_size + 1, 0xA5);
    Bytes second = first;
    const std::size_t one = mutate_bytes(scene_form, first.data(), size, max_size, seed);
    const std::size_t two = mutate_bytes(scene_form, second.data(), size, max_size, seed);
    ASSERT_EQ(one, two);
    ASSERT_LE(one, max_size);
    ASSERT_EQ(first.back(), 0xA5);
    ASSERT_EQ(first, second);
  }
}

// Sum of the edge function's six products at the sample, exact in double for the small numbers that are counted here.
bool edge_on_a_sample(const Scene& scene) {
  const auto& v = scene.draws[0].vertices;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &j = v[(i + 1) % 3], &k = v[(i + 2) % 3];
    const auto d = [](float value) { return static_cast<double>(value); };
    const double a = d(j.y) * d(k.w) - d(j.w) * d(k.y), b = d(j.w) * d(k.x) - d(j.x) * d(k.w),
                 c = d(j.x) * d(k.y) - d(j.y) * d(k.x);
    if (!(std::fabs(a) < 0x1p20 && std::fabs(b) < 0x1p20 && std::fabs(c) < 0x1p20) || (a == 0 && b == 0)) continue;
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        if (a * (x + 0.5) + b * (y + 0.5) + c == 0) return true;
      }
    }
  }
  return false;
}

TEST(Mutate, PutsEdgesThroughSamples) {
  Random random(6);
  Scene plain = decode_triangle({});
  plain.width = plain.height = 16;
  for (auto& vertex : plain.draws[0].vertices) {  // no edge of such a triangle passes through a sample by chance
    vertex.x = static_cast<float>(random.unit() * 16), vertex.y = static_cast<float>(random.unit() * 16), vertex.w = 1;
  }
  ASSERT_FALSE(edge_on_a_sample(plain));
  int hits = 0;
  for (int n = 0; n < 1000; ++n) {
    Scene scene = plain;
    mutate(scene, random);
    hits += edge_on_a_sample(scene);
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace surefill::fuzz
