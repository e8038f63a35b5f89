// SPDX-License-Identifier: Apache-2.0
//
// The engine's occlusion buffers are those of both oracles: depth of safe buffers (O4), and the answers of both buffers
// (O3, O5, O6), on hostile frames.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "oracle/occlusion.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/occluders.hpp"

namespace surefill::properties {
namespace {

#ifdef SUREFILL_CASES_SHARE
constexpr int kShare = SUREFILL_CASES_SHARE;
#else
constexpr int kShare = 1;
#endif

bool is_long() {
  return std::getenv("SUREFILL_SAFE_SCENES") != nullptr;
}
int asked(int scenes) {
  const char* number = std::getenv("SUREFILL_SAFE_SCENES");
  return number != nullptr ? std::atoi(number) : (scenes + kShare - 1) / kShare;
}

struct Tally {
  std::uint64_t scenes = 0, squares = 0, filled = 0, answers = 0, hidden = 0;
  void report(const char* what) const {
    if (!is_long()) return;
    std::cout << what << ": sampled, " << scenes << " scenes, " << squares << " squares, " << filled
              << " of them filled, " << answers << " answers, " << hidden << " of them hidden: 0 differences"
              << std::endl;
  }
};

// Boxes and rectangles on a lattice, near the depth of a square.
void random_queries(Random& r, const corpus::Scene& scene, std::span<const float> depth,
                    std::vector<OcclusionBox>& boxes, std::vector<OcclusionRectangle>& rectangles) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int n = 0; n < 16; ++n) {
    const int q = 1 << r.between(0, 4), reach = r.one_in(2) ? q : 4 * q;
    const int x = r.between(-2 * q, (scene.width + 1) * q), y = r.between(-2 * q, (scene.height + 1) * q);
    const float z = depth[r.below(static_cast<std::uint32_t>(depth.size()))], d = std::isfinite(z) ? z : 0.5f;
    const auto unit = 1 / static_cast<float>(q);
    const auto x0 = static_cast<float>(x) * unit, y0 = static_cast<float>(y) * unit;
    float x1 = x0 + static_cast<float>(r.between(-1, reach)) * unit,
          y1 = y0 + static_cast<float>(r.between(-1, reach)) * unit;
    if (r.one_in(6)) x1 = std::nextafter(x1, -kInfinity);
    if (r.one_in(6)) y1 = r.one_in(2) ? kInfinity : std::nextafter(y1, -kInfinity);
    float nearest = z;
    if (r.one_in(2)) nearest = std::nextafter(z, r.one_in(2) ? kInfinity : -kInfinity);
    rectangles.push_back({x0, y0, x1, y1, nearest});
    OcclusionBox& box = boxes.emplace_back();
    const bool behind = r.one_in(10), thirds = r.one_in(4);
    for (Vertex& v : box.corners) {
      const float w = thirds ? 3.0f : static_cast<float>(1 << r.between(0, 2));
      const float px = x0 + static_cast<float>(r.between(0, reach)) * unit;
      const float py = y0 + static_cast<float>(r.between(0, reach)) * unit;
      v = {px * w, py * w, d * w, w};
      if (r.one_in(4)) v.z += static_cast<float>(r.between(-8, 8)) / 16;
      if (!std::isfinite(v.z)) v.z = d;
      if (behind && r.one_in(2)) v.w = r.one_in(3) ? 0 : -w;
    }
  }
}

template <typename Buffer, typename Queries>
void compare_answers(Buffer& buffer, const Target& target, std::span<const float> depth, bool safe,
                     const Queries& queries, Tally& tally) {
  for (const bool equal : {false, true}) {
    buffer.equal_is_visible(equal);
    std::vector<Occlusion> answers(queries.size());
    ASSERT_EQ(buffer.query(queries, answers), Status::ok);
    for (std::size_t n = 0; n < queries.size(); ++n) {
      const oracle::OcclusionRule rule{.safe = safe, .equal_is_visible = equal};
      ASSERT_EQ(answers[n], oracle::answer(target, depth, queries[n], rule)) << n;
      ASSERT_EQ(answers[n], oracle::clipped::answer(target, depth, queries[n], rule)) << n;
      ++tally.answers;
      tally.hidden += answers[n] == Occlusion::hidden;
    }
  }
}

void compare_depth(std::span<const float> expected, std::span<const float> actual, const char* who) {
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t s = 0; s < expected.size(); ++s) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(expected[s]), std::bit_cast<std::uint32_t>(actual[s]))
        << who << ", square " << s << ": " << expected[s] << ' ' << actual[s];
  }
}

// One scene: prepared with positions of its own, drawn in one call or in one a draw, with options.
void compare_scene(const corpus::Scene& scene, std::uint64_t seed, bool second, Tally& tally) {
  SCOPED_TRACE(corpus::write_scene(scene));
  const corpus::Frame frame(scene, {.count = false, .index = false, .barycentrics = false});
  Target target;
  target.width = scene.width, target.height = scene.height, target.depth_test = scene.depth_test;
  const auto lists = positions_of(scene, seed);
  const std::vector<oracle::Positions> positions(lists.begin(), lists.end());
  const std::vector<float> expected = oracle::safe_depth(target, frame.draws(), positions);
  if (second) compare_depth(expected, oracle::clipped::safe_depth(target, frame.draws(), positions), "the oracles");

  Random r(seed);
  SafeOcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(scene.width, scene.height, scene.depth_test), Status::ok);
  const std::uint32_t stride = r.one_in(2) ? 3 : 5;
  std::vector<OccluderMesh> meshes(lists.size());
  std::vector<Occluder> occluders(lists.size());
  for (std::size_t n = 0; n < lists.size(); ++n) {
    std::vector<float> numbers;
    for (const auto& position : lists[n]) {
      numbers.insert(numbers.end(), position.begin(), position.end());
      numbers.resize(numbers.size() + stride - 3, 7.0f);
    }
    const Draw& draw = frame.draws()[n];
    ASSERT_EQ(meshes[n].prepare(numbers, draw.indices, stride), Status::ok);
    occluders[n].state() = draw.state();
    occluders[n].mesh = &meshes[n], occluders[n].vertices = draw.vertices;
  }
  Options options;
  options.threads = r.between(1, 3);
  if (r.one_in(3)) options.path = Path::reference;
  if (r.one_in(2)) {
    ASSERT_EQ(buffer.draw(occluders, options), Status::ok);
  } else {
    for (const Occluder& occluder : occluders) ASSERT_EQ(buffer.draw({&occluder, 1}, options), Status::ok);
  }
  compare_depth(expected, buffer.depth(), "the engine");
  if (testing::Test::HasFatalFailure()) return;
  ++tally.scenes;
  tally.squares += expected.size();
  for (const float z : expected) tally.filled += std::isfinite(z);

  std::vector<OcclusionBox> boxes;
  std::vector<OcclusionRectangle> rectangles;
  random_queries(r, scene, expected, boxes, rectangles);
  compare_answers(buffer, target, expected, true, std::span<const OcclusionBox>(boxes), tally);
  compare_answers(buffer, target, expected, true, std::span<const OcclusionRectangle>(rectangles), tally);
  OcclusionBuffer exact;
  ASSERT_EQ(exact.resize(scene.width, scene.height, scene.depth_test), Status::ok);
  ASSERT_EQ(exact.draw(frame.draws()), Status::ok);
  compare_answers(exact, target, exact.depth(), false, std::span<const OcclusionBox>(boxes), tally);
  compare_answers(exact, target, exact.depth(), false, std::span<const OcclusionRectangle>(rectangles), tally);
}

TEST(EngineSafe, SmallBuffers) {
  Tally tally;
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < asked(60); ++n) {
      const auto seed = 1'000'000 + static_cast<std::uint64_t>(n);
      compare_scene(occluder_scene(category, seed, 1 + n % 17, 1 + n / 17 % 11, 2 + n % 40), seed, n % 4 == 0, tally);
      if (HasFatalFailure()) return;
    }
  }
  tally.report("small buffers");
  EXPECT_GT(tally.filled * 8, tally.squares);
  EXPECT_GT(tally.hidden * 20, tally.answers);
}

TEST(EngineSafe, LargerBuffers) {
  Tally tally;
  constexpr std::array kSizes = {std::array{40, 22}, std::array{64, 64}, std::array{160, 90}, std::array{67, 131}};
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < (asked(16) + 3) / 4; ++n) {
      const auto seed = 2'000'000 + static_cast<std::uint64_t>(n);
      const auto [width, height] = kSizes[static_cast<std::size_t>(n) % 4];
      compare_scene(occluder_scene(category, seed, width, height, 16 << n % 5), seed, is_long() && n % 4 == 0, tally);
      if (HasFatalFailure()) return;
    }
  }
  tally.report("larger buffers");
}

}  // namespace
}  // namespace surefill::properties
