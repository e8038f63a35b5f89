// SPDX-License-Identifier: Apache-2.0
#include "statistics.hpp"

#include "exact/exact_draw.hpp"
#include "facts.hpp"

namespace surefill {

Statistics statistics_of(std::span<const Draw> draws) noexcept {
  Statistics sum;
  for (const Draw& draw : draws) {
    for (std::size_t t = 0; t < triangles_of(draw); ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      if (!is_finite(draw, position)) {
        ++sum.dropped;
        continue;
      }
      const int sign = has_triangles(draw) ? orientation(draw, position) : 0;
      if (!has_triangles(draw)) {
        ++(ExactDraw().use(draw, position) ? sum.rasterized : sum.degenerate);
      } else if (sign == 0 && is_degenerate(draw, position)) {
        ++sum.degenerate;
      } else if (!draw.grid && culls(draw, sign)) {
        ++sum.culled;
      } else {
        ++sum.rasterized;
      }
    }
  }
  return sum;
}

}  // namespace surefill
