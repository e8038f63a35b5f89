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
    const std::size_t size = draw.primitive == Primitive::triangles ? 3u : draw.primitive == Primitive::lines ? 2u : 1u;
    for (std::size_t t = 0; t < draw.indices.size(); t += size) {
      const auto corners = draw.indices.subspan(t, size);
      if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return vertex_is_finite(draw, v); })) {
        ++sum.dropped;
        continue;
      }
      std::array<oracle::clipped::Vector, 3> m;
      for (std::size_t k = 0; k < size; ++k) {
        const Vertex& v = draw.vertices[corners[k]];
        m[k] = {oracle::clipped::exact(v.x), oracle::clipped::exact(v.y), oracle::clipped::exact(v.w)};
      }
      if (size < 3) {
        // All that is in front of the eye lies at one place if X/W and Y/W are alike, whatever the signs of W.
        const oracle::clipped::Vector normal = oracle::clipped::cross(m[0], m[1]);
        const bool line =
            size == 2 && (sgn(m[0].w) > 0 || sgn(m[1].w) > 0) && (sgn(normal.x) != 0 || sgn(normal.y) != 0);
        ++(line || (size == 1 && sgn(m[0].w) > 0) ? sum.rasterized : sum.degenerate);
        continue;
      }
      const int sign = sgn(oracle::clipped::dot(m[0], oracle::clipped::cross(m[1], m[2])));
      const bool touched = draw.conservative == Conservative::touched;
      const bool front = sign != 0 && (sign > 0) == (draw.front_face == FrontFace::clockwise);
      if (sign == 0 && !touched && (!draw.grid || oracle::clipped::contains_eye(m))) {
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
