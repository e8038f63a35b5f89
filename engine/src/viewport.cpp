// SPDX-License-Identifier: Apache-2.0
//
// The viewport map (S3): sums of at most four products of two float32, exact in double, rounded once.
#include <cmath>
#include <limits>

#include "build_check.hpp"
#include "exact/exact.hpp"
#include "float_environment.hpp"
#include "overlap.hpp"
#include "surefill/surefill.hpp"

namespace surefill {
namespace {

using Sum = Expansion<4>;

// The float32 nearest to the sum as IEEE 754 has it: beyond range infinity, too small a zero of its sign, exactly 0 is
// +0.
float round_sum(const Sum& sum) {
  const double estimate = sum.estimate();
  const double error = std::fabs(estimate) * 0x1p-50;
  const float low = static_cast<float>(estimate - error), high = static_cast<float>(estimate + error);
  if (low == high) return low;
  return nearest_of_neighbours(low, high, [&](double midpoint) {
    Expansion<5> rest;
    for (int i = 0; i < sum.size(); ++i) rest.add(sum.term(i));
    rest.add(-midpoint);
    return rest.sign();
  });
}

// Adds a * b for float32 values, one of them perhaps halved: at most 48 bits, exact.
void add(Sum& sum, double a, double b) {
  sum.add(a * b);
}

Vertex map(const Viewport& viewport, const ClipVertex& v) {
  if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w))) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  const double half_width = viewport.width / 2.0, half_height = viewport.height / 2.0;
  const double near_depth = viewport.near_depth, far_depth = viewport.far_depth;
  const double y_sign = viewport.clip_y == ClipY::up ? -1 : 1;
  Sum x, y, z;
  add(x, v.x, half_width);
  add(x, v.w, viewport.x);
  add(x, v.w, half_width);
  add(y, v.y, y_sign * half_height);
  add(y, v.w, viewport.y);
  add(y, v.w, half_height);
  if (viewport.clip_depth == ClipDepth::zero_to_one) {
    add(z, v.z, far_depth);
    add(z, -v.z, near_depth);
    add(z, v.w, near_depth);
  } else {
    add(z, v.z, far_depth / 2);
    add(z, -v.z, near_depth / 2);
    add(z, v.w, far_depth / 2);
    add(z, v.w, near_depth / 2);
  }
  return {round_sum(x), round_sum(y), round_sum(z), v.w + 0.0f};
}

// Not inlined: it needs the engine's floating-point state.
[[gnu::noinline]] bool is_finite(const Viewport& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.width) && std::isfinite(v.height) &&
         std::isfinite(v.near_depth) && std::isfinite(v.far_depth);
}

// Nor this.
[[gnu::noinline]] void map_all(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) {
  for (std::size_t i = 0; i < vertices.size(); ++i) out[i] = map(viewport, vertices[i]);
}

}  // namespace

Status to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  const FloatEnvironment environment;
  if (!is_finite(viewport)) return Status::viewport;
  if (viewport.clip_depth > ClipDepth::minus_one_to_one || viewport.clip_y > ClipY::down) return Status::viewport;
  if (vertices.size() != out.size() || (vertices.data() == nullptr && !vertices.empty()) ||
      (out.data() == nullptr && !out.empty()) || Bytes(out).overlaps(Bytes(vertices)) ||
      Bytes(out).overlaps(Bytes::of(&viewport))) {
    return Status::to_pixel_vertices;
  }
  map_all(viewport, vertices, out);
  return Status::ok;
}

}  // namespace surefill
