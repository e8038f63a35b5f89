// SPDX-License-Identifier: Apache-2.0
//
// The viewport map (S3) by rationals, as the page writes it.
#include <cmath>
#include <limits>

#include "oracle/exact.hpp"
#include "oracle/oracle.hpp"

namespace surefill::oracle {

namespace {

using Rational = mpq_class;

Rational rational(float value) {
  return Rational(static_cast<double>(value));  // exact
}

float rounded(const Rational& value) {
  return nearest_ieee(value.get_num(), value.get_den());
}

}  // namespace

void to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) {
  const StandardFloats standard_floats;
  const Rational x0 = rational(viewport.x), y0 = rational(viewport.y);
  const Rational half_width = rational(viewport.width) / 2, half_height = rational(viewport.height) / 2;
  const Rational n = rational(viewport.near_depth), f = rational(viewport.far_depth);
  const int s = viewport.clip_y == ClipY::up ? -1 : 1;
  const bool unit = viewport.clip_depth == ClipDepth::zero_to_one;
  const Rational z_scale = unit ? Rational(f - n) : Rational((f - n) / 2);
  const Rational z_offset = unit ? n : Rational((f + n) / 2);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const ClipVertex& v = vertices[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) {
      constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
      out[i] = {kNaN, kNaN, kNaN, kNaN};
      continue;
    }
    const Rational w = rational(v.w);
    out[i] = {rounded(rational(v.x) * half_width + w * (x0 + half_width)),
              rounded(s * rational(v.y) * half_height + w * (y0 + half_height)),
              rounded(rational(v.z) * z_scale + w * z_offset), rounded(w)};
  }
}

}  // namespace surefill::oracle
