// SPDX-License-Identifier: Apache-2.0
//
// M11, counted in rationals.
#ifndef SUREFILL_ENGINE_TESTS_STATISTICS_IN_RATIONALS_HPP
#define SUREFILL_ENGINE_TESTS_STATISTICS_IN_RATIONALS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "oracle/clipped_polygon.hpp"
#include "surefill/surefill.hpp"

namespace surefill::properties {

inline bool vertex_is_finite(const Draw& draw, std::uint32_t vertex) {
  const Vertex& v = draw.vertices[vertex];
  bool finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  for (const AttributeArray& attribute : draw.attributes) {
    const std::uint32_t stride = attribute.stride == 0 ? attribute.components : attribute.stride;
    for (std::uint32_t c = 0; c < attribute.components; ++c)
      finite = finite && std::isfinite(attribute.values[std::size_t{vertex} * stride + c]);
  }
  return finite;
}

inline Statistics statistics_in_rationals(std::span<const Draw> draws) {
  Statistics sum;
  for (const Draw& draw : draws) {
    for (std::size_t t = 0; t < draw.indices.size(); t += 3) {
      const auto corners = draw.indices.subspan(t, 3);
      if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return vertex_is_finite(draw, v); })) {
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

}  // namespace surefill::properties

#endif  // SUREFILL_ENGINE_TESTS_STATISTICS_IN_RATIONALS_HPP
