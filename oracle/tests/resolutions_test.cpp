// SPDX-License-Identifier: Apache-2.0
//
// T7: what a safe buffer hides changes nothing at any resolution. Of the engine's buffers and the oracles'; that the clauses
// of O4 to O6 are needed; and of views that T7 does not speak of.
#include "properties/machinery/resolutions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "oracle/tests/safe_by_the_page.hpp"
#include "properties/generators/occluders.hpp"

namespace surefill::properties {
namespace {

using oracle::Wrong;

#ifdef SUREFILL_CASES_SHARE
constexpr int kShare = SUREFILL_CASES_SHARE;
#else
constexpr int kShare = 1;
#endif

// How many scenes of each category; the long run is asked for by name, and says what it did.
bool is_long() {
  return std::getenv("SUREFILL_SAFE_SCENES") != nullptr;
}
int asked(int scenes) {
  const char* number = std::getenv("SUREFILL_SAFE_SCENES");
  return number != nullptr ? std::atoi(number) : (scenes + kShare - 1) / kShare;
}
void report(const char* what, int scenes, int first_seed, const Sightings& seen) {
  if (!is_long()) return;
  std::cout << what << ": sampled, " << scenes << " scenes, seeds " << first_seed
            << " .. of each category: " << seen.things << " hidden things in " << seen.views << " views, "
            << seen.samples << " samples, one in 16 views has " << seen.covered << " covered; " << seen.unfit
            << " views were unfit; 0 violations" << std::endl;
}

// A buffer by the page with one clause wrong.
SafeBufferMaker wrong_buffer(Wrong wrong) {
  return [wrong](const corpus::Scene& occluders) {
    const corpus::Frame frame(occluders, {.count = false, .index = false, .depth = false, .barycentrics = false});
    Target target;
    target.width = occluders.width, target.height = occluders.height;
    target.origin = occluders.origin, target.depth_test = occluders.depth_test;
    SafeBuffer buffer;
    buffer.depth = oracle::safe_depth_by_the_page(target, frame.draws(), {}, wrong);
    buffer.box = [=, depth = buffer.depth](const OcclusionBox& box, bool equal) {
      return oracle::answer_by_the_page(target, depth, box, {.safe = true, .equal_is_visible = equal}, wrong);
    };
    buffer.rectangle = [=, depth = buffer.depth](const OcclusionRectangle& rectangle, bool equal) {
      return oracle::answer_by_the_page(target, depth, rectangle, {.safe = true, .equal_is_visible = equal}, wrong);
    };
    return buffer;
  };
}

// Case n of a category: sizes from 1 x 1 to 9 x 7.
corpus::Scene small_case(const OccluderCategory& category, std::uint64_t n) {
  const int k = static_cast<int>(n % 1000);
  return occluder_scene(category, n, 1 + k % 9, 1 + k / 9 % 7, 2 + k % 16);
}

TEST(Resolutions, SmallBuffers) {
  Sightings seen;
  const Effort effort;
  int scenes = 0;
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < asked(60); ++n, ++scenes) {
      const auto seed = static_cast<std::uint64_t>(n);
      const SafeBufferMaker maker = n % 4 == 0 ? oracle_safe_buffer() : engine_safe_buffer();
      const auto found = violation(small_case(category, seed), maker, seed, effort, seen);
      ASSERT_FALSE(found) << category.name << ' ' << n << ": " << *found;
    }
  }
  report("small buffers", scenes, 0, seen);
  RecordProperty("views", std::to_string(seen.views));
  EXPECT_GT(seen.covered * 8, seen.samples / 16);
  EXPECT_GT(seen.views, seen.unfit);
}

// Of the oracles alone: their buffers, their pictures.
TEST(Resolutions, Oracles) {
  Sightings seen;
  int scenes = 0;
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < asked(6); ++n, ++scenes) {
      const auto seed = 300'000 + static_cast<std::uint64_t>(n);
      const bool first = n % 2 == 0;
      const Effort effort{
          .things = 10, .views = 4, .size = 24, .renderer = first ? oracle_renderer() : clipped_oracle_renderer()};
      const auto found = violation(small_case(category, seed),
                                   first ? oracle_safe_buffer() : clipped_oracle_safe_buffer(), seed, effort, seen);
      ASSERT_FALSE(found) << category.name << ' ' << n << ": " << *found;
    }
  }
  report("oracles alone", scenes, 300'000, seen);
}

TEST(Resolutions, LargerBuffers) {
  Sightings seen;
  const Effort effort{.things = 60, .views = 24, .size = 640};
  int scenes = 0;
  constexpr std::array kSizes = {std::array{7, 5}, std::array{40, 22}, std::array{160, 90}};
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < (asked(12) + 3) / 4; ++n, ++scenes) {
      const auto seed = 500'000 + static_cast<std::uint64_t>(n);
      const auto [width, height] = kSizes[is_long() ? static_cast<std::size_t>(n) % 3 : n % 3 == 2 ? 1 : 0];
      const corpus::Scene scene = occluder_scene(category, seed, width, height, 16 << n % 5);
      Options options;
      options.threads = 1 + n % 2;
      const auto found = violation(scene, engine_safe_buffer(options), seed, effort, seen);
      ASSERT_FALSE(found) << category.name << ' ' << n << ": " << *found;
    }
  }
  report("larger buffers", scenes, 500'000, seen);
}

// S3: a viewport of 2^k times the size gives 2^k times X and Y, and so a view that T7 speaks of. A picture of 1920 x 1080,
// and buffers of 240 x 135 down to 15 x 8.4375.
TEST(Resolutions, Viewports) {
  Sightings seen;
  int scenes = 0;
  for (const OccluderCategory& category : occluder_categories()) {
    for (int n = 0; n < (asked(8) + 3) / 4; ++n, ++scenes) {
      const auto seed = 700'000 + static_cast<std::uint64_t>(n);
      const int k =
          3 + static_cast<int>((seed + static_cast<std::uint64_t>(&category - occluder_categories().data())) % 5);
      const float small = std::ldexp(1.0f, -k);
      Viewport viewport{.x = n % 2 == 0 ? 0.0f : 24.0f, .y = n % 2 == 0 ? 0.0f : -8.0f, .width = 1920, .height = 1080};
      Viewport of_buffer = viewport;
      of_buffer.x *= small, of_buffer.y *= small, of_buffer.width *= small, of_buffer.height *= small;
      corpus::Scene occluders = occluder_scene(category, seed, 2, 2, 32);
      View view;
      view.a = view.c = std::ldexp(1.0, k);
      view.width = 1920, view.height = 1080;
      for (corpus::SceneDraw& draw : occluders.draws) {
        for (corpus::SceneVertex& v : draw.vertices) {
          const ClipVertex clip{v.x - v.w, v.w - v.y, v.z, v.w};
          Vertex in_buffer{}, in_picture{};
          ASSERT_EQ(to_pixel(of_buffer, {&clip, 1}, {&in_buffer, 1}), Status::ok);
          ASSERT_EQ(to_pixel(viewport, {&clip, 1}, {&in_picture, 1}), Status::ok);
          v = {in_buffer.x, in_buffer.y, in_buffer.z, in_buffer.w, {}};
          const std::optional<Vertex> expected = seen_in(view, in_buffer);
          const std::array numbers = {in_buffer.x, in_buffer.y, in_picture.x, in_picture.y};
          const bool underflow =
              std::ranges::any_of(numbers, [](float number) { return std::fpclassify(number) == FP_SUBNORMAL; });
          if (expected && std::isfinite(expected->x) && std::isfinite(expected->y) && !underflow) {
            EXPECT_EQ(in_picture.x, expected->x);
            EXPECT_EQ(in_picture.y, expected->y);
          }
        }
      }
      occluders.width = static_cast<int>(std::ceil(of_buffer.width));
      occluders.height = static_cast<int>(std::ceil(of_buffer.height));
      Random r(seed);
      const SafeBuffer buffer = engine_safe_buffer()(occluders);
      const std::vector<Hidden> hidden = hidden_things(r, occluders, buffer, false, 40);
      seen.things += hidden.size();
      const auto found = sight(r, occluders, view, hidden, engine_renderer(), seen);
      ASSERT_FALSE(found) << category.name << ' ' << n << ": " << *found;
    }
  }
  report("viewports", scenes, 700'000, seen);
  EXPECT_GT(seen.views * 2, static_cast<std::uint64_t>(scenes));
}

// Where T7 does not speak: a triangle before a box at 160 x 90, and at f times that, all by S3. At how many samples the box
// is seen. The triangle's vertices lie far outside of the picture; of W = 1 or of 2^-10, as where a wall passes the eye.
int seen_at_factor(int f, float w) {
  const auto viewport = [](int factor) {
    return Viewport{.width = 160 * static_cast<float>(factor), .height = 90 * static_cast<float>(factor)};
  };
  const std::vector<ClipVertex> occluder = {{-8860.189453125f * w, 15562.4619140625f * w, 0.5f * w, w},
                                            {10788.3056640625f * w, -18950.775390625f * w, 0.5f * w, w},
                                            {-20000 * w, -20000 * w, 0.5f * w, w}};
  const float x0 = 0.5f / 80, x1 = 0.99f / 80, y0 = -35.01f / 45, y1 = -35.5f / 45;
  const std::vector<ClipVertex> box = {{x0, y0, 0.75f, 1}, {x1, y0, 0.75f, 1}, {x1, y1, 0.75f, 1}, {x0, y1, 0.75f, 1}};
  const std::vector<std::uint32_t> triangle = {0, 1, 2}, quad = {0, 1, 2, 0, 2, 3};
  std::vector<Vertex> occluder_vertices(3), box_vertices(4);

  EXPECT_EQ(to_pixel(viewport(1), occluder, occluder_vertices), Status::ok);
  EXPECT_EQ(to_pixel(viewport(1), box, box_vertices), Status::ok);
  std::vector<float> positions;
  for (const ClipVertex& v : occluder) positions.insert(positions.end(), {v.x, v.y, v.w});
  OccluderMesh mesh;
  EXPECT_EQ(mesh.prepare(positions, triangle), Status::ok);
  Occluder drawn;
  drawn.mesh = &mesh, drawn.vertices = occluder_vertices;
  SafeOcclusionBuffer buffer;
  EXPECT_EQ(buffer.resize(160, 90), Status::ok);
  EXPECT_EQ(buffer.draw({&drawn, 1}), Status::ok);
  OcclusionBox asked{};
  for (std::size_t k = 0; k < 8; ++k) asked.corners[k] = box_vertices[k % 4];
  Occlusion answer = Occlusion::visible;
  EXPECT_EQ(buffer.query({&asked, 1}, {&answer, 1}), Status::ok);
  EXPECT_EQ(answer, Occlusion::hidden);

  EXPECT_EQ(to_pixel(viewport(f), occluder, occluder_vertices), Status::ok);
  EXPECT_EQ(to_pixel(viewport(f), box, box_vertices), Status::ok);
  std::array<Draw, 2> draws;
  draws[0].vertices = occluder_vertices, draws[0].indices = triangle;
  draws[1].vertices = box_vertices, draws[1].indices = quad;
  std::vector<std::uint32_t> index(static_cast<std::size_t>(160 * f * 90 * f));
  Target target;
  target.width = 160 * f, target.height = 90 * f, target.index = index;
  draws[1].first_index = 1;
  EXPECT_EQ(render(target, draws), Status::ok);
  int seen = 0;
  for (std::size_t s = 0; s < index.size(); ++s) {
    if (index[s] == 0 || index[s] == kNoTriangle) continue;
    ++seen;
    EXPECT_EQ(s % static_cast<std::size_t>(target.width), 971u);
    EXPECT_EQ(s / static_cast<std::size_t>(target.width), 960u);
  }
  return seen;
}

TEST(Resolutions, AnotherFactor) {
  for (const float w : {1.0f, 0x1p-10f}) {
    EXPECT_EQ(seen_at_factor(8, w), 0);
    EXPECT_EQ(seen_at_factor(12, w), 1);
    EXPECT_EQ(seen_at_factor(16, w), 0);
  }
}

// --- Each clause is needed

// Does T7 find the wrong clause in this case?
bool is_found(Wrong wrong, const OccluderCategory& category, std::uint64_t n) {
  Sightings seen;
  return violation(small_case(category, n), wrong_buffer(wrong), n, {}, seen).has_value();
}

struct Found {
  Wrong wrong;
  const char* category;
  std::uint64_t n;
};
// Where the search below found them first.
constexpr Found kFound[] = {
    {Wrong::no_rims, "sheet", 1},
    {Wrong::rims_inside, "sheet", 1},
    {Wrong::rim_ends, "nearly", 1},
    {Wrong::no_rays, "fan", 8},
    {Wrong::ends_projected, "fan", 8},
    {Wrong::rims_of_one_face, "triangulation", 10},
    {Wrong::edges_in_pairs, "soup", 4},
    {Wrong::edges_of_both_sides, "hull", 2},
    {Wrong::edges_without_w, "city", 25},
    {Wrong::nearly_equal_ends, "soup", 5},
    {Wrong::degenerate_faces, "city", 8},
    {Wrong::culled_faces, "soup", 2},
    {Wrong::dropped_faces, "city", 22},
    {Wrong::faces_alone, "hull", 3},
    {Wrong::covering_faces, "hull", 3},
    {Wrong::depth_at_centre, "hull", 2},
    {Wrong::depth_at_corner, "hull", 2},
    {Wrong::nearest_end, "hull", 2},
    {Wrong::cut_behind, "fan", 6},
    {Wrong::cut_to_mean, "hull", 2},
    {Wrong::rounded_nearer, "hull", 3},
    {Wrong::not_clipped, "soup", 18},
    {Wrong::clipped_by_one_face, "fan", 95},
    {Wrong::not_clamped, "fan", 7},
    {Wrong::reach_of_centres, "hull", 7},
    {Wrong::reach_without_end, "nearly", 135},
    {Wrong::farthest_d, "hull", 3},
    {Wrong::behind_left_out, "hull", 3},
    {Wrong::equal_is_hidden, "nearly", 13},
};

TEST(Resolutions, EachClauseIsNeeded) {
  for (const auto& [wrong, name, n] : kFound) {
    for (const OccluderCategory& category : occluder_categories()) {
      if (std::string(name) != category.name) continue;
      EXPECT_TRUE(is_found(wrong, category, n)) << name_of(wrong);
      EXPECT_FALSE(is_found(Wrong::nothing, category, n)) << name_of(wrong);
    }
  }
  EXPECT_EQ(std::size(kFound), static_cast<std::size_t>(Wrong::last) - 1);
}

// SUREFILL_SAFE_FAULTS=N looks for the cases anew, in N scenes of each category, and prints them.
TEST(Resolutions, SearchForFaults) {
  const char* number = std::getenv("SUREFILL_SAFE_FAULTS");
  if (number == nullptr) GTEST_SKIP() << "SUREFILL_SAFE_FAULTS is not set";
  const std::uint64_t count = std::strtoull(number, nullptr, 10);
  for (int w = 1; w < static_cast<int>(Wrong::last); ++w) {
    const auto wrong = static_cast<Wrong>(w);
    const OccluderCategory* at = nullptr;
    std::uint64_t n = 0;
    while (n < count && at == nullptr) {
      for (const OccluderCategory& category : occluder_categories()) {
        if (at == nullptr && is_found(wrong, category, n)) at = &category;
      }
      n += at == nullptr;
    }
    EXPECT_NE(at, nullptr) << name_of(wrong);
    if (at != nullptr)
      std::cout << "    {Wrong::" << name_of(wrong) << ", \"" << at->name << "\", " << n << "}," << std::endl;
  }
}

}  // namespace
}  // namespace surefill::properties
