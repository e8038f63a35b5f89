// SPDX-License-Identifier: Apache-2.0
#include "properties/generators/generators.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "properties/generators/near_zero.hpp"

namespace surefill::properties {

std::uint64_t Random::bits() {
  // SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
  std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

std::uint32_t Random::below(std::uint32_t n) {
  return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32);
}

int Random::between(int first, int last) {
  const std::int64_t range = std::int64_t{last} - first + 1;  // below 2^32, or the whole of int
  const std::uint32_t step =
      range > 0xFFFFFFFF ? static_cast<std::uint32_t>(bits()) : below(static_cast<std::uint32_t>(range));
  return static_cast<int>(first + std::int64_t{step});
}

double Random::unit() {
  return static_cast<double>(bits() >> 11) * 0x1p-53;
}

namespace {

using Triangle = std::array<Vertex, 3>;
constexpr float kMax = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Numbers.

double in(Random& r, double low, double high) {
  return low + (high - low) * r.unit();
}
float sign(Random& r) {
  return r.one_in(2) ? -1.0f : 1.0f;
}
float power_of_two(Random& r, int low, int high) {
  return std::ldexp(1.0f, r.between(low, high));
}

// Any finite float32, all exponents alike.
float any_finite(Random& r) {
  const auto mantissa_and_sign = static_cast<std::uint32_t>(r.bits()) & 0x807FFFFFu;
  return std::bit_cast<float>(mantissa_and_sign | (r.below(255) << 23));
}

float nudged(Random& r, float value) {
  const float towards = r.one_in(2) ? kInfinity : -kInfinity;
  for (int steps = r.one_in(3) ? 2 : 1; steps > 0; --steps) value = std::nextafter(value, towards);
  return std::isfinite(value) ? value : kMax;
}

// The order in which function arguments and operands are evaluated is the compiler's choice: an expression draws one
// random number, or draws them in braces (left to right), so that a case is the same everywhere.

// Points and vertices. A coordinate of a lattice of 1/q pixel, on the target or up to `margin` pixels off it.
float lattice(Random& r, int size, int q, int margin = 3) {
  return static_cast<float>(r.between(-margin * q, (size + margin) * q)) / static_cast<float>(q);
}

struct Point {
  float x, y;
};

Point lattice_point(Random& r, int width, int height, int q) {
  return {lattice(r, width, q), lattice(r, height, q)};
}

Point sample(Random& r, int width, int height) {
  return {static_cast<float>(r.between(0, width - 1)) + 0.5f, static_cast<float>(r.between(0, height - 1)) + 0.5f};
}

// The vertex that projects to the point, up to the rounding of X and Y.
struct RealPoint {
  double x, y;
};
Vertex at(RealPoint p, double w = 1) {
  return {static_cast<float>(p.x * w), static_cast<float>(p.y * w), 0, static_cast<float>(w)};
}
Vertex at(Point p, float w = 1) {
  return {p.x * w, p.y * w, 0, w};
}

Vertex scaled(const Vertex& v, float s) {
  return {v.x * s, v.y * s, v.z * s, v.w * s};
}

// Any order and, sometimes, each vertex scaled by its own power of two: exact, and the same triangle (T4).
Triangle shuffled(Random& r, Triangle t) {
  std::swap(t[0], t[r.below(3)]);
  std::swap(t[1], t[1 + r.below(2)]);
  if (r.one_in(3))
    for (Vertex& v : t) v = scaled(v, power_of_two(r, -12, 12));
  return t;
}

// Depth of every kind, where a category does not aim at depth itself.
Triangle with_depths(Random& r, Triangle t) {
  const std::uint32_t kind = r.below(9);
  const double shared = r.unit();
  for (Vertex& v : t) {
    const double w = v.w;
    double z = 0;
    switch (kind) {
      case 0:
        z = 0;
        break;
      case 1:
        z = w / 2;
        break;  // constant, and the same for many triangles
      case 2:
        z = w * (r.one_in(2) ? 1 : 0);
        break;  // on the clip boundaries
      case 3:
        z = w * r.unit();
        break;
      case 4:
        z = w * in(r, -0.5, 1.5);
        break;  // through both clip boundaries
      case 5:
        z = w * r.between(-2, 10) / 8;
        break;
      case 6:
        z = w * shared;
        break;  // nearly constant: rounding of Z alone
      case 7:
        z = in(r, -2, 2);
        break;
      default:
        z = any_finite(r);
        break;
    }
    if (!(std::abs(z) <= static_cast<double>(kMax))) z = 0;
    v.z = static_cast<float>(z);
  }
  return t;
}

Triangle finished(Random& r, const Triangle& t) {
  return with_depths(r, shuffled(r, t));
}

Triangle on_lattice(Random& r, int width, int height, int q) {
  Triangle t;
  for (Vertex& v : t) v = at(lattice_point(r, width, height, q));
  return finished(r, t);
}

Triangle ordinary_points(Random& r, int width, int height) {
  Triangle t;
  for (Vertex& v : t) v = at(RealPoint{in(r, -3, width + 3), in(r, -3, height + 3)});
  return t;
}

// An edge through the sample s in the direction of whole pixels (dx, dy), which so runs through many samples; the third
// vertex anywhere. An end lies on a sample where a factor is whole.
Triangle edge_through(Random& r, int width, int height, int dx, int dy) {
  const Point s = sample(r, width, height);
  const float unit = r.one_in(2) ? 1.0f : 0.25f;
  const float back = static_cast<float>(r.between(0, 16)) * unit, ahead = static_cast<float>(r.between(1, 16)) * unit;
  const auto fx = static_cast<float>(dx), fy = static_cast<float>(dy);
  return {at(Point{s.x - back * fx, s.y - back * fy}), at(Point{s.x + ahead * fx, s.y + ahead * fy}),
          at(lattice_point(r, width, height, 4))};
}

Triangle edge_through_samples(Random& r, int width, int height) {
  int dx = 0, dy = 0;
  while (dx == 0 && dy == 0) {
    dx = r.between(-5, 5);
    dy = r.between(-5, 5);
  }
  return edge_through(r, width, height, dx, dy);
}

Triangle vertex_on_sample(Random& r, int width, int height) {
  Triangle t = ordinary_points(r, width, height);
  for (int n = r.between(1, 3), i = 0; i < n; ++i) t[static_cast<std::size_t>(i)] = at(sample(r, width, height));
  return t;
}

// Long and `thickness` pixels thick, through a sample or beside it.
Triangle sliver(Random& r, int width, int height, double thickness) {
  const double length = in(r, 4, 2.0 * (width + height)), u = in(r, -1, 1), v = in(r, -1, 1);
  const double norm = std::sqrt(u * u + v * v) + 1e-9, dx = u / norm, dy = v / norm;
  const Point s = sample(r, width, height);
  const double x = s.x + in(r, -1, 1) * thickness, y = s.y + in(r, -1, 1) * thickness;
  const double along = in(r, -1, 1) * length;
  return {at(RealPoint{x - dx * length, y - dy * length}), at(RealPoint{x + dx * length, y + dy * length}),
          at(RealPoint{x + dx * along - dy * thickness, y + dy * along + dx * thickness})};
}

// Points around the target with W of the signs given: +1, -1, 0 a vertex. A vertex with W = 0 lies at infinity.
Triangle with_w_signs(Random& r, int width, int height, std::array<int, 3> signs) {
  Triangle t;
  const bool exact = r.one_in(2);
  for (std::size_t i = 0; i < 3; ++i) {
    if (exact) {
      const float w = static_cast<float>(signs[i]) * power_of_two(r, -2, 2);
      const Point p = r.one_in(3) ? sample(r, width, height) : lattice_point(r, width, height, 2);
      t[i] = at(p, w == 0 ? 1 : w);
      t[i].w = w;
    } else {
      const double w = signs[i] * in(r, 0.1, 4), scale = signs[i] == 0 ? sign(r) : w;
      t[i] = at(RealPoint{in(r, -width, 2 * width), in(r, -height, 2 * height)}, scale);
      t[i].w = static_cast<float>(w);
    }
    if (signs[i] == 0 && r.one_in(3)) t[i].x = t[i].x - std::floor(t[i].x) - 0.5f;  // directions of every angle
    if (signs[i] == 0 && r.one_in(8)) t[i].y = 0;
    if (signs[i] == 0 && r.one_in(8)) t[i].x = 0;
  }
  return finished(r, t);
}

// Small integer vectors: their combinations are exact.
Vertex small_integer(Random& r, int size) {
  const int bound = r.one_in(2) ? 4 : 2 * size + 4;
  return {static_cast<float>(r.between(-bound, bound)), static_cast<float>(r.between(-bound, bound)), 0,
          static_cast<float>(r.between(-2, 3))};
}

// The categories, in the order of the table below.

Triangle lattice_1(Random& r, int w, int h) {
  return on_lattice(r, w, h, 1);
}
Triangle lattice_2(Random& r, int w, int h) {
  return on_lattice(r, w, h, 2);
}
Triangle lattice_16(Random& r, int w, int h) {
  return on_lattice(r, w, h, 16);
}
Triangle lattice_256(Random& r, int w, int h) {
  return on_lattice(r, w, h, 256);
}
Triangle on_sample(Random& r, int w, int h) {
  return finished(r, vertex_on_sample(r, w, h));
}
Triangle horizontal(Random& r, int w, int h) {
  return finished(r, edge_through(r, w, h, 1, 0));
}
Triangle vertical(Random& r, int w, int h) {
  return finished(r, edge_through(r, w, h, 0, 1));
}
Triangle diagonal(Random& r, int w, int h) {
  return finished(r, edge_through(r, w, h, 1, r.one_in(2) ? 1 : -1));
}
Triangle any_direction(Random& r, int w, int h) {
  return finished(r, edge_through_samples(r, w, h));
}

Triangle near_collinear(Random& r, int w, int h) {
  const Point s = sample(r, w, h);
  const auto dx = static_cast<float>(r.between(-7, 7)), dy = static_cast<float>(r.between(-7, 7));
  Triangle t;
  for (Vertex& v : t) {
    const float k = static_cast<float>(r.between(-64, 64)) / 16.0f;
    v = at(Point{s.x + k * dx, s.y + k * dy});
    if (r.one_in(2)) v.x = nudged(r, v.x);
    if (r.one_in(2)) v.y = nudged(r, v.y);
  }
  return finished(r, t);
}

Triangle one_ulp_off(Random& r, int w, int h) {
  Triangle t = r.one_in(2) ? edge_through_samples(r, w, h) : vertex_on_sample(r, w, h);
  for (int n = r.between(1, 3); n > 0; --n) {
    Vertex& v = t[r.below(3)];
    float& component = r.one_in(3) ? v.w : r.one_in(2) ? v.x : v.y;
    component = nudged(r, component);
  }
  return finished(r, t);
}

Triangle sliver_1(Random& r, int w, int h) {
  return finished(r, sliver(r, w, h, 1));
}
Triangle sliver_thin(Random& r, int w, int h) {
  return finished(r, sliver(r, w, h, 1e-3));
}

Triangle sub_pixel(Random& r, int w, int h) {
  const Point s = sample(r, w, h);
  const double size = std::ldexp(1.0, -r.between(0, 20));
  Triangle t;
  for (Vertex& v : t) v = at(RealPoint{s.x + in(r, -1, 1) * size, s.y + in(r, -1, 1) * size});
  if (r.one_in(4)) t[r.below(3)] = at(s);
  return finished(r, t);
}

// Coordinates up to the largest float32: products reach 2^256, determinants 2^384.
Triangle huge(Random& r, int w, int h) {
  Triangle t = ordinary_points(r, w, h);
  const bool all = r.one_in(2);
  for (Vertex& v : t) {
    if (!all && r.one_in(2)) continue;
    const float s = power_of_two(r, 60, 127);
    const float ends[] = {kMax, -kMax, s, -s};
    v.x = r.one_in(3) ? ends[r.below(4)] : static_cast<float>(in(r, -1, 1)) * s;
    v.y = r.one_in(3) ? ends[r.below(4)] : static_cast<float>(in(r, -1, 1)) * s;
    if (r.one_in(2)) v.w = std::min(s, kMax) * static_cast<float>(in(r, -1, 1));
  }
  return finished(r, t);
}

Triangle scaled_down(Random& r, int w, int h, int low, int high) {
  Triangle t = r.one_in(2) ? edge_through_samples(r, w, h) : ordinary_points(r, w, h);
  t = finished(r, t);
  for (Vertex& v : t) v = scaled(v, power_of_two(r, low, high));
  return t;
}
Triangle tiny(Random& r, int w, int h) {
  return scaled_down(r, w, h, -120, -60);
}
Triangle subnormal(Random& r, int w, int h) {
  return scaled_down(r, w, h, -147, -126);
}

Triangle w_negative_one(Random& r, int w, int h) {
  return with_w_signs(r, w, h, {-1, 1, 1});
}
Triangle w_negative_two(Random& r, int w, int h) {
  return with_w_signs(r, w, h, {-1, -1, 1});
}
Triangle behind(Random& r, int w, int h) {
  return with_w_signs(r, w, h, {-1, -1, -1});
}
Triangle w_zero_one(Random& r, int w, int h) {
  return with_w_signs(r, w, h, {0, 1, r.one_in(3) ? -1 : 1});
}
Triangle w_zero_two(Random& r, int w, int h) {
  return with_w_signs(r, w, h, {0, 0, r.one_in(8) ? 0 : 1});
}

Triangle w_tiny(Random& r, int w, int h) {
  Triangle t = with_w_signs(r, w, h, {r.one_in(2) ? 1 : -1, 1, 1});
  for (int n = r.between(1, 2), i = 0; i < n; ++i) {
    const float size = power_of_two(r, -149, -20);
    t[static_cast<std::size_t>(i)].w = sign(r) * size;
  }
  return t;
}

Triangle mixed_exponents(Random& r, int w, int h) {
  Triangle t = with_w_signs(r, w, h, {r.one_in(3) ? -1 : 1, 1, 1});
  for (Vertex& v : t) v = scaled(v, power_of_two(r, -100, 100));
  return t;
}

Triangle equal_vertices(Random& r, int w, int h) {
  Triangle t = on_lattice(r, w, h, 2);
  t[1] = t[0];
  if (r.one_in(4)) t[2] = scaled(t[0], r.one_in(2) ? 2.0f : -1.0f);
  return shuffled(r, t);
}

Triangle collinear(Random& r, int w, int h) {
  Triangle t = {small_integer(r, w), small_integer(r, h), {}};
  const auto i = static_cast<float>(r.between(-4, 4)), j = static_cast<float>(r.between(-4, 4));
  t[2] = {i * t[0].x + j * t[1].x, i * t[0].y + j * t[1].y, 0, i * t[0].w + j * t[1].w};
  return finished(r, t);
}

Triangle small_integers(Random& r, int w, int h) {
  return finished(r, {small_integer(r, w), small_integer(r, h), small_integer(r, w)});
}

Triangle near_tie(Random& r, int w, int h) {
  return finished(r, nearly_tied_triangle(r, w, h));
}
Triangle near_degenerate(Random& r, int, int) {
  return finished(r, nearly_degenerate_triangle(r));
}
Triangle near_degenerate_tied(Random& r, int w, int h) {
  return finished(r, nearly_degenerate_tied_triangle(r, w, h));
}

Triangle not_finite(Random& r, int w, int h) {
  Triangle t = finished(r, ordinary_points(r, w, h));
  Vertex& v = t[r.below(3)];
  float* const components[] = {&v.x, &v.y, &v.z, &v.w};
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity};
  *components[r.below(4)] = values[r.below(3)];
  return t;
}

Triangle far_off_screen(Random& r, int w, int h) {
  Triangle t;
  for (Vertex& v : t) {
    const double reach = std::ldexp(1.0, r.between(20, 31));
    RealPoint p{in(r, -reach, reach), in(r, -reach, reach)};
    if (r.one_in(2)) p = {std::floor(p.x) + 0.5, std::floor(p.y) + 0.5};
    v = at(p);
  }
  if (r.one_in(3)) t[0] = at(sample(r, w, h));
  return finished(r, t);
}

Triangle ordinary(Random& r, int w, int h) {
  return finished(r, ordinary_points(r, w, h));
}

Triangle perspective(Random& r, int w, int h) {
  Triangle t;
  const double near = in(r, 0.5, 2);
  for (Vertex& v : t) {
    const double depth = near + in(r, 0, 8);
    v = at(RealPoint{in(r, -3, w + 3), in(r, -3, h + 3)}, depth);
  }
  return with_depths(r, t);
}

// Depth on purpose. A right triangle with legs of a power of two has D = 2^k, so that quotients end and halfway cases
// occur.
Triangle power_of_two_legs(Random& r, int w, int h) {
  const Point s = sample(r, w, h);
  const float leg = power_of_two(r, 1, 5);
  const float x = s.x - (r.one_in(2) ? 0.5f : leg / 4), y = s.y - (r.one_in(2) ? 0.5f : leg / 4);
  return {at(Point{x, y}), at(Point{x + leg, y}), at(Point{x, y + leg})};
}

Triangle depth_tie(Random& r, int w, int h) {
  Triangle t = r.one_in(2) ? power_of_two_legs(r, w, h) : vertex_on_sample(r, w, h);
  const float z = static_cast<float>(r.between(0, 2)) / 2.0f;
  for (Vertex& v : t) v.z = z * v.w;
  if (r.one_in(3)) t[r.below(3)].z = nudged(r, z);
  return t;
}

Triangle depth_boundary(Random& r, int w, int h) {
  Triangle t = power_of_two_legs(r, w, h);
  const float values[] = {0, 1, -1, 2, 0.5f, 1.5f, -0.5f, -0.0f};
  for (Vertex& v : t) v.z = values[r.below(8)];
  if (r.one_in(2)) {
    Vertex& v = t[r.below(3)];
    v.z = nudged(r, v.z);
  }
  if (r.one_in(3))
    for (Vertex& v : t) v = scaled(v, power_of_two(r, -8, 8));
  return t;
}

Triangle depth_halfway(Random& r, int w, int h) {
  Triangle t = power_of_two_legs(r, w, h);
  const int exponent = r.one_in(4) ? -r.between(120, 148) : -r.between(0, 6);
  for (Vertex& v : t) v.z = std::ldexp(1.0f + static_cast<float>(r.below(1u << 23)) * 0x1p-23f, exponent);
  return t;
}

Triangle depth_cancellation(Random& r, int w, int h) {
  Triangle t = r.one_in(2) ? power_of_two_legs(r, w, h) : ordinary_points(r, w, h);
  const float large = power_of_two(r, 0, 100);
  t[0].z = large * static_cast<float>(in(r, 1, 2));
  t[1].z = -t[0].z;
  t[2].z = r.one_in(2) ? 0.0f : static_cast<float>(in(r, -1, 1));
  if (r.one_in(2)) t[1].z = nudged(r, t[1].z);
  return shuffled(r, t);
}

Triangle depth_extreme(Random& r, int w, int h) {
  Triangle t = r.one_in(2) ? power_of_two_legs(r, w, h) : perspective(r, w, h);
  const float values[] = {kMax, -kMax, 0x1p-149f, -0x1p-149f, 0x1p-126f, 0, 0x1.fffffep-127f, 0x1p127f};
  for (Vertex& v : t) v.z = r.one_in(3) ? any_finite(r) : values[r.below(8)];
  if (r.one_in(2))
    for (Vertex& v : t) v.w *= power_of_two(r, -60, 3);
  return t;
}

Triangle any_bits(Random& r, int, int) {
  Triangle t;
  for (Vertex& v : t) v = {any_finite(r), any_finite(r), any_finite(r), any_finite(r)};
  return t;
}

constexpr Category kCategories[] = {
    {"lattice-1", "vertices at whole pixels", lattice_1},
    {"lattice-1/2", "vertices at half pixels, many on samples", lattice_2},
    {"lattice-1/16", "vertices at multiples of 1/16 pixel", lattice_16},
    {"lattice-1/256", "vertices at multiples of 1/256 pixel", lattice_256},
    {"vertex-on-sample", "one to three vertices exactly on samples", on_sample},
    {"edge-horizontal", "a horizontal edge through samples", horizontal},
    {"edge-vertical", "a vertical edge through samples", vertical},
    {"edge-diagonal", "an edge at 45 degrees through samples", diagonal},
    {"edge-through-samples", "an edge of rational direction through samples", any_direction},
    {"near-collinear", "vertices on a line through a sample, moved by an ulp or two", near_collinear},
    {"one-ulp-off", "vertices or edges on samples, a component moved by an ulp or two", one_ulp_off},
    {"sliver", "long triangles one pixel thick", sliver_1},
    {"sliver-thin", "long triangles a thousandth of a pixel thick", sliver_thin},
    {"sub-pixel", "triangles down to 2^-20 pixels around a sample", sub_pixel},
    {"huge", "coordinates up to the largest float32", huge},
    {"tiny", "vectors of 2^-60 to 2^-120", tiny},
    {"subnormal", "subnormal components", subnormal},
    {"w-negative-one", "one vertex behind the eye", w_negative_one},
    {"w-negative-two", "two vertices behind the eye", w_negative_two},
    {"behind", "all vertices behind the eye: covers nothing", behind},
    {"w-zero-one", "one vertex at infinity", w_zero_one},
    {"w-zero-two", "two vertices at infinity", w_zero_two},
    {"w-tiny", "W next to zero, of either sign", w_tiny},
    {"mixed-exponents", "each vertex scaled by its own power of two", mixed_exponents},
    {"equal-vertices", "two or three vertices alike: D = 0", equal_vertices},
    {"collinear", "a vertex that is a combination of the others: D = 0", collinear},
    {"small-integers", "integer vectors in front of, through and behind the eye", small_integers},
    {"near-tie", "an edge function of a few units between terms of up to 2^70", near_tie},
    {"near-degenerate", "D of a few units between terms of 2^66", near_degenerate},
    {"near-degenerate-tied", "D of a few units, an edge exactly through a sample", near_degenerate_tied},
    {"not-finite", "a NaN or an infinity in a vertex: dropped", not_finite},
    {"far-off-screen", "vertices 2^20 to 2^31 pixels away", far_off_screen},
    {"ordinary", "random triangles on the screen", ordinary},
    {"perspective", "random triangles with W from 0.5 to 10", perspective},
    {"depth-tie", "equal depths, or an ulp apart", depth_tie},
    {"depth-boundary", "depths on 0 and 1, exactly and an ulp off", depth_boundary},
    {"depth-halfway", "depths halfway between two float32", depth_halfway},
    {"depth-cancellation", "depths that cancel", depth_cancellation},
    {"depth-extreme", "depths beyond range and below the smallest subnormal", depth_extreme},
    {"any-bits", "any finite bit patterns", any_bits},
};

}  // namespace

std::span<const Category> categories() {
  return kCategories;
}

}  // namespace surefill::properties
