// SPDX-License-Identifier: Apache-2.0
//
// Sizes and identifiers at their limits: sample_total is 0 exactly where validate refuses size or samples, and no index
// that is asked for can be kNoTriangle (B5), in C++ and in C.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace surefill {
namespace {

TEST(SampleTotal, IsZeroExactlyWhereSizeOrSamplesAreRefused) {
  const int sizes[] = {-2147483647 - 1, -16384, -1, 0, 1, 2, 3, 255, 16383, 16384, 16385, 65536, 2147483647};
  for (const int width : sizes) {
    for (const int height : sizes) {
      for (int samples = -2; samples <= 40; ++samples) {
        Target target;
        target.width = width, target.height = height, target.samples = samples;
        const Status status = validate(target, {});
        const bool refused = status == Status::target_size || status == Status::target_samples;
        ASSERT_TRUE(refused || status == Status::ok);
        const auto size_ok = [](int size) { return size >= 1 && size <= 16384; };
        const int n = samples;
        ASSERT_EQ(refused, !size_ok(width) || !size_ok(height) || (n != 1 && n != 2 && n != 4 && n != 8 && n != 16));
        const auto total =
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(samples);
        ASSERT_EQ(sample_total(target), refused ? 0 : total) << width << " x " << height << ", " << samples;
        surefill_target c{};
        c.struct_size = sizeof c, c.width = width, c.height = height, c.samples = samples;
        ASSERT_EQ(surefill_validate(&c, nullptr, 0), static_cast<surefill_status>(status));
        ASSERT_EQ(surefill_sample_total(&c), refused ? 0 : total);
      }
    }
  }
  EXPECT_EQ(surefill_sample_total(nullptr), 0u);
}

// One triangle that covers all, `triangles` times.
struct Frame {
  Vertex vertices[3] = {{-9, -9, 0, 1}, {90, -9, 0, 1}, {-9, 90, 0, 1}};
  std::vector<std::uint32_t> indices, identifiers;
  Draw draw;

  explicit Frame(std::size_t triangles) {
    for (std::size_t t = 0; t < triangles; ++t) indices.insert(indices.end(), {0, 1, 2});
    draw.vertices = vertices, draw.indices = indices;
  }
};

// What every call says of the draws, whatever outputs are asked for; all must agree.
Status status_of(std::span<const Draw> draws) {
  Target target;
  target.width = target.height = 2;
  const Status expected = validate(target, draws);
  constexpr std::uint32_t kBefore = 77777;
  std::uint32_t count[4] = {kBefore}, index[4] = {kBefore};
  bool any = false;
  for (const Draw& draw : draws) any |= !draw.indices.empty();
  for (const Path path : {Path::automatic, Path::reference}) {
    target.count = count, target.index = {};
    EXPECT_EQ(render(target, draws, nullptr, {.path = path}), expected);
    EXPECT_EQ(count[0] == kBefore, expected != Status::ok);
    target.count = {}, target.index = index;
    EXPECT_EQ(render(target, draws, nullptr, {.path = path}), expected);
    EXPECT_EQ(index[0] == kBefore, expected != Status::ok);
    EXPECT_EQ(index[0] == kNoTriangle, expected == Status::ok && !any);
    const auto visit = [](void*, std::span<const CoverageBlock>) {};
    Target size;
    size.width = size.height = 2;
    EXPECT_EQ(visit_coverage(size, draws, {visit, nullptr}, nullptr, {.path = path}), expected);
    OcclusionBuffer buffer;
    EXPECT_EQ(buffer.resize(2, 2), Status::ok);
    EXPECT_EQ(buffer.draw(draws, nullptr, {.path = path}), expected);
  }
  std::vector<surefill_draw> c_draws(draws.size());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    c_draws[d] = {};
    c_draws[d].struct_size = sizeof c_draws[d];
    c_draws[d].vertices = reinterpret_cast<const surefill_vertex*>(draws[d].vertices.data());
    c_draws[d].vertex_count = draws[d].vertices.size();
    c_draws[d].indices = draws[d].indices.data(), c_draws[d].index_count = draws[d].indices.size();
    c_draws[d].identifiers = draws[d].identifiers.data();
    c_draws[d].identifier_count = draws[d].identifiers.size();
    c_draws[d].first_index = draws[d].first_index;
  }
  surefill_target c{};
  c.struct_size = sizeof c, c.width = c.height = 2, c.samples = 1;
  EXPECT_EQ(surefill_validate(&c, c_draws.data(), draws.size()), static_cast<surefill_status>(expected));
  EXPECT_EQ(surefill_render(&c, c_draws.data(), draws.size(), nullptr, nullptr),
            static_cast<surefill_status>(expected));
  return expected;
}

// At any place among indices that are good.
TEST(Indices, NameVertices) {
  for (const std::uint32_t wrong :
       {3u, 4u, 0x7FFFFFFFu, 0x80000000u, 0x80000002u, 0x80000003u, 0xFFFFFFFEu, 0xFFFFFFFFu}) {
    for (std::size_t at = 0; at < 3 * 7; ++at) {
      Frame frame(7);
      EXPECT_EQ(status_of({&frame.draw, 1}), Status::ok);
      frame.indices[at] = wrong;
      EXPECT_EQ(status_of({&frame.draw, 1}), Status::draw_index_out_of_range) << wrong << " at " << at;
    }
  }
}

TEST(NoTriangle, IsNoIdentifier) {
  // Long enough that vector code has whole vectors and a rest.
  for (const std::size_t triangles : {1u, 2u, 7u, 40u}) {
    for (std::size_t bad = 0; bad <= triangles; ++bad) {
      Frame frame(triangles);
      frame.identifiers.assign(triangles, kNoTriangle - 1);
      if (bad < triangles) frame.identifiers[bad] = kNoTriangle;
      frame.draw.identifiers = frame.identifiers;
      EXPECT_EQ(status_of({&frame.draw, 1}), bad < triangles ? Status::draw_identifiers : Status::ok) << bad;
    }
  }
}

TEST(NoTriangle, IsNotReachedByAFirstIndex) {
  for (const std::uint32_t triangles : {0u, 1u, 2u, 9u}) {
    for (std::uint32_t below = 0; below < 12; ++below) {
      Frame frame(triangles);
      frame.draw.first_index = kNoTriangle - below;  // the last index is kNoTriangle - below + triangles - 1
      const Status expected = triangles > below ? Status::draw_first_index : Status::ok;
      EXPECT_EQ(status_of({&frame.draw, 1}), expected) << triangles << " triangles from kNoTriangle - " << below;
      const Draw draws[] = {frame.draw, frame.draw};  // each counts from its own
      EXPECT_EQ(status_of(draws), expected);
    }
  }
  // Where there are identifiers, the first index says nothing.
  Frame frame(2);
  frame.identifiers = {0, 1};
  frame.draw.identifiers = frame.identifiers, frame.draw.first_index = kNoTriangle;
  EXPECT_EQ(status_of({&frame.draw, 1}), Status::ok);
}

}  // namespace
}  // namespace surefill
