// SPDX-License-Identifier: Apache-2.0
//
// Statistics are those of M11, counted here in rationals, and depend on nothing but the draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "corpus/scene.hpp"
#include "oracle/clipped_polygon.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

namespace surefill::properties {
namespace {

bool is_finite(const Draw& draw, std::uint32_t vertex) {
  const Vertex& v = draw.vertices[vertex];
  bool finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  for (const AttributeArray& attribute : draw.attributes) {
    const std::uint32_t stride = attribute.stride == 0 ? attribute.components : attribute.stride;
    for (std::uint32_t c = 0; c < attribute.components; ++c)
      finite = finite && std::isfinite(attribute.values[std::size_t{vertex} * stride + c]);
  }
  return finite;
}

Statistics in_rationals(std::span<const Draw> draws) {
  Statistics sum;
  for (const Draw& draw : draws) {
    for (std::size_t t = 0; t < draw.indices.size(); t += 3) {
      const auto corners = draw.indices.subspan(t, 3);
      if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return is_finite(draw, v); })) {
        ++sum.dropped;
        continue;
      }
      std::array<oracle::clipped::Vector, 3> m;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vertex& v = draw.vertices[corners[k]];
        m[k] = {oracle::clipped::exact(v.x), oracle::clipped::exact(v.y), oracle::clipped::exact(v.w)};
      }
      const int sign = sgn(oracle::clipped::dot(m[0], oracle::clipped::cross(m[1], m[2])));
      const bool front = (sign > 0) == (draw.front_face == FrontFace::clockwise);
      if (sign == 0 && (!draw.grid || oracle::clipped::contains_eye(m))) {
        ++sum.degenerate;
      } else if (!draw.grid && draw.cull == (front ? Cull::front : Cull::back)) {
        ++sum.culled;
      } else {
        ++sum.rasterized;
      }
    }
  }
  return sum;
}

TEST(Statistics, AreThoseOfM11) {
  Statistics all;
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const corpus::Scene scene = mixed_scene(category, seed, 24, 6);
      corpus::Frame frame(scene, outputs_of(scene));
      const Statistics expected = in_rationals(frame.draws());
      for (const Options& options : {Options{}, Options{.threads = 3}, Options{.path = Path::reference}}) {
        Statistics actual;
        ASSERT_EQ(render(frame.target(), frame.draws(), &actual, options), Status::ok);
        ASSERT_EQ(actual, expected) << category.name << ", seed " << seed << '\n' << corpus::write_scene(scene);
      }
      all.dropped += expected.dropped, all.degenerate += expected.degenerate;
      all.culled += expected.culled, all.rasterized += expected.rasterized;
    }
  }
  for (const std::uint64_t some : {all.dropped, all.degenerate, all.culled, all.rasterized}) EXPECT_GT(some, 100u);
}

// Neither the target's size, samples and outputs nor scissor, depth mode and culling box have a part in them.
TEST(Statistics, TellOfTheDrawsAlone) {
  for (const Category& category : categories()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      corpus::Scene scene = mixed_scene(category, seed, 24, 6);
      corpus::Frame frame(scene, outputs_of(scene));
      Statistics expected, actual;
      ASSERT_EQ(render(frame.target(), frame.draws(), &expected), Status::ok);
      std::vector<Draw> draws(frame.draws().begin(), frame.draws().end());
      for (Draw& draw : draws) {
        draw.scissor = Scissor{3, 4, 5, 6};
        draw.depth_mode = draw.conservative == Conservative::none ? DepthMode::clip : DepthMode::none;
        draw.culling_box.emplace().fill({-1, -1, 0, 1});  // it may lie about where triangles are: counted they are
      }
      Target other;
      other.width = 7, other.height = 3;
      ASSERT_EQ(render(other, draws, &actual), Status::ok);
      EXPECT_EQ(actual, expected) << category.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace surefill::properties
