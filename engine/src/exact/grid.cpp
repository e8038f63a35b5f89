// SPDX-License-Identifier: Apache-2.0
#include "grid.hpp"

#include <algorithm>
#include <cmath>

namespace surefill {
namespace {

// The planes of the guard band: gW - X, gW + X, gW - Y, gW + Y, in the order in which they clip. Positive is inside.
constexpr int kPlanes = 4;
constexpr bool bounds_x(int plane) {
  return plane < 2;
}
constexpr double outwards(int plane) {
  return plane % 2 == 0 ? 1 : -1;
}

// Where the band ends at a plane, counted outwards: a whole number of 23 bits.
double limit_of(int plane, Origin origin) {
  return kGuardBand + outwards(plane) * (bounds_x(plane) ? origin.x : origin.y);
}

// A plane's function at a vertex of the triangle: 47 and 24 bits.
Expansion<2> plane_value(int plane, const Vertex& v, Origin origin) {
  Expansion<2> sum;
  sum.add(limit_of(plane, origin) * static_cast<double>(v.w));
  sum.add(-outwards(plane) * static_cast<double>(bounds_x(plane) ? v.x : v.y));
  return sum;
}

bool inside_guard_band(const Vertex& v, Origin origin) {
  for (int plane = 0; plane < kPlanes; ++plane) {
    const double coordinate = bounds_x(plane) ? v.x : v.y;
    if (!(outwards(plane) * coordinate <= limit_of(plane, origin) * static_cast<double>(v.w))) return false;
  }
  return true;
}

int plane_sign(int plane, const GuardCorner& corner, Origin origin) {
  Expansion<32> sum;
  sum.add_scaled(corner.w, limit_of(plane, origin));
  sum.add_scaled(bounds_x(plane) ? corner.x : corner.y, -outwards(plane));
  return sum.sign();
}

GuardCorner vertex_corner(const Vertex& v, int line) {
  GuardCorner corner;
  corner.x.add(v.x), corner.y.add(v.y), corner.z.add(v.z), corner.w.add(v.w);
  corner.line = line;
  return corner;
}

// Where a plane cuts the edge from a to b, from these end points alone: |f(b)| a + |f(a)| b, which is the same real
// point for either order. f(a) and f(b) have opposite signs.
GuardCorner edge_corner(int plane, const Vertex& a, const Vertex& b, Origin origin) {
  const Expansion<2> fa = plane_value(plane, a, origin), fb = plane_value(plane, b, origin);
  const auto mean = [&](double at_a, double at_b) {
    Expansion<8> sum;
    sum.add_scaled(fb, fb.sign() * at_a);
    sum.add_scaled(fa, fa.sign() * at_b);
    return sum;
  };
  GuardCorner corner;
  corner.x = mean(a.x, b.x), corner.y = mean(a.y, b.y), corner.z = mean(a.z, b.z), corner.w = mean(a.w, b.w);
  return corner;
}

// The sign of the sum of the E_i at the direction (0, 1, 0), which is b_0 + b_1 + b_2.
int sign_of_b_sum(const Triangle& triangle) {
  Expansion<6> sum;
  for (int i = 0; i < 3; ++i) {
    const EdgeFunction& edge = triangle.edge(i);
    const double jx = edge.from.x, jw = edge.from.w, kx = edge.to.x, kw = edge.to.w;
    sum.add(jw * kx);  // 48 bits, exact
    sum.add(-(jx * kw));
  }
  return sum.sign();
}

// Where two planes of the band meet in the triangle's interior; `first` clipped before `second`. D is not 0: a plane
// through the eye meets a guard plane in a line through the eye, and the part of that line within a hull without the
// eye lies on one side of every other guard plane.
//
// An X plane and a Y plane: both X planes have been applied by then, so W >= 0, and 0 only at the eye; the point is
// (ox +- g, oy +- g, 1) times a positive number.
//
// The two X planes: the point is (0, 1, 0) times l, where the weights l E_i / D of the vertices sum to 1, so l has the
// sign of D times that of the sum of the E_i at (0, 1, 0). It lies outside of a Y plane, and so is gone in the end.
GuardCorner band_corner(int first, int second, const Triangle& triangle, Origin origin) {
  GuardCorner corner;
  if (!bounds_x(second)) {
    corner.guard_x = outwards(first) > 0 ? 1 : -1;
    corner.guard_y = outwards(second) > 0 ? 1 : -1;
    corner.x.add(origin.x + kGuardBand * corner.guard_x), corner.y.add(origin.y + kGuardBand * corner.guard_y);
    corner.w.add(1);
  } else {
    corner.y.add(triangle.determinant() * sign_of_b_sum(triangle));
  }
  return corner;
}

// Where a plane cuts the line that leads from `corner` to the next one.
GuardCorner cut(const GuardCorner& corner, int plane, const Triangle& triangle, Origin origin) {
  if (corner.line >= 3) return band_corner(corner.line - 3, plane, triangle, origin);
  return edge_corner(plane, triangle.edge(corner.line).from, triangle.edge(corner.line).to, origin);
}

// Sutherland and Hodgman 1974, against one plane. A corner on the plane stays and is not cut again.
void clip(const GuardPolygon& in, int plane, const Triangle& triangle, Origin origin, GuardPolygon* out) {
  int sign[7];
  for (int n = 0; n < in.corners; ++n) sign[n] = plane_sign(plane, in.corner[n], origin);
  out->corners = 0;
  for (int n = 0; n < in.corners; ++n) {
    const GuardCorner& corner = in.corner[n];
    const int here = sign[n], next = sign[(n + 1) % in.corners];
    if (here >= 0) {
      GuardCorner& kept = out->corner[out->corners++] = corner;
      if (here == 0 && next < 0) kept.line = 3 + plane;
    }
    if (here * next < 0) {
      GuardCorner& added = out->corner[out->corners++] = cut(corner, plane, triangle, origin);
      added.line = here > 0 ? 3 + plane : corner.line;
    }
  }
}

// G1. The hull of the triangle does not contain the eye.
void clip_to_guard_band(const Triangle& triangle, Origin origin, GuardPolygon* polygon) {
  polygon->corners = 0;
  bool inside = true;
  for (int i = 0; i < 3; ++i) {  // the line from vertex i to vertex i + 1 is the edge opposite vertex i + 2
    polygon->corner[polygon->corners++] = vertex_corner(triangle.vertex(i), (i + 2) % 3);
    inside = inside && inside_guard_band(triangle.vertex(i), origin);
  }
  if (inside) return;
  GuardPolygon other;
  static_assert(kPlanes % 2 == 0, "the last result stands in *polygon");
  for (int plane = 0; plane < kPlanes; plane += 2) {
    clip(*polygon, plane, triangle, origin, &other);
    clip(other, plane + 1, triangle, origin, polygon);
  }
}

// k for t = (numerator / denominator - offset 2^-(bits + 4)) 2^bits, by its floor and by where t lies above it.
double round_to_integer(double floor_of_t, int above_floor, int above_half, GridRounding rounding) {
  const double up = floor_of_t + 1;
  switch (rounding) {
    case GridRounding::nearest_even:
      if (above_half != 0) return above_half > 0 ? up : floor_of_t;
      return std::fmod(floor_of_t, 2) == 0 ? floor_of_t : up;
    case GridRounding::nearest_up:
      return above_half >= 0 ? up : floor_of_t;
    case GridRounding::truncate:
      return floor_of_t < 0 && above_floor > 0 ? up : floor_of_t;
  }
  return floor_of_t;
}

// The grid position of a coordinate numerator / denominator, which lies within g of the origin, in units of 2^-(bits + 4)
// pixels from there; `offset` is in these units.
std::int64_t snap(const Expansion<8>& numerator, const Expansion<8>& denominator, int offset, const Grid& grid,
                  Rungs* rungs, int origin = 0) {
  const double scale = 1 << grid.bits;
  const auto compare = [&](double twice) {  // the sign of t - twice / 2; all factors are exact
    Expansion<32> rest;
    rest.add_scaled(numerator, 2 * scale);
    rest.add_scaled(denominator, -(twice + offset / 8.0));
    return rest.sign();
  };
  // The estimates, the division and the difference have relative errors below 2^-48 together.
  const double error = snap_error(origin != 0);
  const double estimate = numerator.estimate() / denominator.estimate() * scale - offset / 16.0;
  double floor_of_t = std::floor(estimate);
  const double fraction = estimate - floor_of_t;  // exact
  int above_floor = 1, above_half = fraction > 0.5 ? 1 : -1;
  if (fraction > error && fraction < 1 - error && std::fabs(fraction - 0.5) > error) {
    count(rungs, &Rungs::values_by_filter);
  } else {
    count(rungs, &Rungs::values_by_expansion);
    if (compare(2 * floor_of_t) < 0) {
      floor_of_t -= 1;
    } else if (compare(2 * floor_of_t + 2) >= 0) {
      floor_of_t += 1;
    }
    above_floor = compare(2 * floor_of_t);
    above_half = compare(2 * floor_of_t + 1);
  }
  const double k = round_to_integer(floor_of_t, above_floor, above_half, grid.rounding);
  return 16 * (static_cast<std::int64_t>(k) - std::int64_t{origin} * (1 << grid.bits)) + offset;
}

// Widens a range by z / w; an empty range has low > high. Rounding is monotonic, so the rounded ends are those of the
// exact range.
template <std::size_t kZ, std::size_t kW>
void widen(const Expansion<kZ>& z, const Expansion<kW>& w, DepthRange* range) {
  Expansion<kZ + kW> above_one;
  for (int i = 0; i < z.size(); ++i) above_one.add(z.term(i));
  for (int i = 0; i < w.size(); ++i) above_one.add(-w.term(i));
  const bool below_zero = z.sign() * w.sign()<0, is_above_one = above_one.sign() * w.sign()> 0;
  const float rounded = round_quotient(z, w);
  range->low = std::min(range->low, rounded);
  range->high = std::max(range->high, rounded);
  range->low_below_zero = range->low_below_zero || below_zero;
  range->high_below_zero = range->high_below_zero && below_zero;
  range->low_above_one = range->low_above_one && is_above_one;
  range->high_above_one = range->high_above_one || is_above_one;
}

// The sign of a - b.
int compare(const DepthFraction& a, const DepthFraction& b) {
  Expansion<1440> left;
  Expansion<2880> difference;
  left.add_product_of(b.numerator, a.denominator);
  difference.add_product_of(a.numerator, b.denominator);
  for (int i = 0; i < left.size(); ++i) difference.add(-left.term(i));
  return difference.sign() * a.denominator.sign() * b.denominator.sign();
}

}  // namespace

// If a product m_j x m_k is not 0, the three are multiples of one normal, and the weights l with l_0 m_0 + l_1 m_1 +
// l_2 m_2 = 0 are those multiples, up to a factor: the signs of any component of the products that is not 0 throughout
// tell. Else the three vectors are multiples of one direction (or 0), and the hull misses 0 exactly if they are
// positive multiples of one of them: if a coordinate has one sign, other than 0, in all three.
bool hull_contains_eye(const Triangle& triangle) {
  const EdgeFunction &e0 = triangle.edge(0), &e1 = triangle.edge(1), &e2 = triangle.edge(2);
  const double products[3][3] = {{e0.a, e1.a, e2.a}, {e0.b, e1.b, e2.b}, {e0.c, e1.c, e2.c}};
  for (const auto& l : products) {
    const auto [low, high] = std::minmax({l[0], l[1], l[2]});  // their signs are exact
    if (low != 0 || high != 0) return low >= 0 || high <= 0;
  }
  const Vertex &v0 = triangle.vertex(0), &v1 = triangle.vertex(1), &v2 = triangle.vertex(2);
  const auto one_sign = [](float a, float b, float c) {
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
  };
  return !one_sign(v0.x, v1.x, v2.x) && !one_sign(v0.y, v1.y, v2.y) && !one_sign(v0.w, v1.w, v2.w);
}

double snapped_position(float c, float w, int offset, const Grid& grid, Rungs* rungs) {
  Expansion<8> numerator, denominator;
  numerator.add(c), denominator.add(w);
  return static_cast<double>(snap(numerator, denominator, offset, grid, rungs)) / (16 << grid.bits);
}

bool SnappedTriangle::set_up(const Vertex& v0, const Vertex& v1, const Vertex& v2, const Grid& grid, Rungs* rungs,
                             Origin origin) {
  depth_range_known_ = false;
  origin_ = origin;
  if (!triangle_.set_up(v0, v1, v2, rungs) && hull_contains_eye(triangle_)) return false;
  clip_to_guard_band(triangle_, origin, &polygon_);
  for (int n = 0; n < polygon_.corners; ++n) {
    const GuardCorner& corner = polygon_.corner[n];
    point_[n] = {snap(corner.x, corner.w, grid.offset_x, grid, rungs, origin.x),
                 snap(corner.y, corner.w, grid.offset_y, grid, rungs, origin.y)};
  }
  units_per_pixel_ = 1 << (grid.bits + 4);
  return true;
}

PixelBox SnappedTriangle::box(PixelBox limits, double least_offset, double largest_offset) const {
  if (polygon_.corners == 0) return {0, 0, 0, 0};
  Point low = point_[0], high = point_[0];
  for (int n = 1; n < polygon_.corners; ++n) {
    low = {std::min(low.x, point_[n].x), std::min(low.y, point_[n].y)};
    high = {std::max(high.x, point_[n].x), std::max(high.y, point_[n].y)};
  }
  const auto pixels = [this](std::int64_t units) { return static_cast<double>(units) / units_per_pixel_; };  // exact
  const double ox = origin_.x, oy = origin_.y;
  clip_to_reach({pixels(low.x) + ox, pixels(high.x) + ox}, least_offset, largest_offset, &limits.x0, &limits.x1);
  clip_to_reach({pixels(low.y) + oy, pixels(high.y) + oy}, least_offset, largest_offset, &limits.y0, &limits.y1);
  return limits;
}

// Edges that cross the ray from the perturbed sample towards +x, with their direction. Differences of coordinates are
// below 2^31 + 2^18 in magnitude and their products below 2^63; these are compared and not subtracted.
int SnappedTriangle::winding(const Point* corner, int corners, SamplePosition p, TieShift shift) const {
  const auto px = static_cast<std::int64_t>((p.x - origin_.x) * units_per_pixel_);
  const auto py = static_cast<std::int64_t>((p.y - origin_.y) * units_per_pixel_);
  const auto beyond = [&](const Point& a) { return a.y > py || (a.y == py && shift.y < 0); };  // y above the sample's
  int sum = 0;
  for (int n = 0; n < corners; ++n) {
    const Point &from = corner[n], &to = corner[n + 1 < corners ? n + 1 : 0];
    if (beyond(from) == beyond(to)) continue;
    const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
    const std::int64_t left = dx * (py - from.y), right = dy * (px - from.x);  // E(p) = left - right; a = -dy, b = dx
    int sign = left > right ? 1 : left < right ? -1 : 0;
    if (sign == 0) sign = tie_sign(-static_cast<double>(dy), static_cast<double>(dx), shift);
    if (sign == (beyond(to) ? 1 : -1)) sum += sign;
  }
  return sum;
}

bool SnappedTriangle::depth(SamplePosition p, const DrawState& state, float* stored, Rungs* rungs) {
  const DepthMode mode = state.depth_mode;
  know_depth_range();
  const DepthRange& range = depth_range_;
  const bool flat = triangle_.determinant() == 0;
  if (mode == DepthMode::clip) {
    // z clamped to [low, high] is below 0 if high is, or if low and z are; and so for 1.
    if (range.high_below_zero || range.low_above_one) return false;
    if (flat && range.low_below_zero) return false;
    if (!flat && range.low_below_zero && triangle_.compare_depth(p, 0, rungs) < 0) return false;
    if (!flat && range.high_above_one && triangle_.compare_depth(p, 1, rungs) > 0) return false;
  }
  if (state.depth_bias) {
    *stored = biased_depth(p, *state.depth_bias, rungs);
  } else {
    *stored = flat ? range.low : std::clamp(triangle_.rounded_depth(p, rungs), range.low, range.high);
  }
  if (mode == DepthMode::clamp) *stored = std::clamp(*stored, 0.0f, 1.0f);  // rounding is monotonic
  return true;
}

void SnappedTriangle::know_depth_range() {
  if (depth_range_known_) return;
  depth_range_known_ = true;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  depth_range_ = {kInfinity, -kInfinity, false, true, true, false};
  for (int n = 0; n < polygon_.corners; ++n) {
    const DepthFraction z = corner_depth(n);
    widen(z.numerator, z.denominator, &depth_range_);
  }
}

// Z/W of corner n of the polygon.
DepthFraction SnappedTriangle::corner_depth(int n) {
  const GuardCorner& corner = polygon_.corner[n];
  if (corner.guard_x == 0) return {Expansion<60>(corner.z), Expansion<12>(corner.w)};
  const SamplePosition p{origin_.x + kGuardBand * corner.guard_x, origin_.y + kGuardBand * corner.guard_y};
  return {triangle_.exact_depth_numerator(p), triangle_.exact_determinant_value()};
}

// Depth with a bias (I8): the clamped z of G2, without rounding, and then c and s m, whose m is that of the unsnapped
// plane, and 0 where D is.
float SnappedTriangle::biased_depth(SamplePosition p, const DepthBias& bias, Rungs* rungs) {
  const bool flat = triangle_.determinant() == 0;
  DepthFraction low = corner_depth(0), high = low;
  for (int n = 1; n < polygon_.corners; ++n) {
    const DepthFraction z = corner_depth(n);
    if (compare(z, low) < 0) low = z;
    if (compare(z, high) > 0) high = z;
  }
  DepthFraction z = low;
  if (!flat) {
    z = {triangle_.exact_depth_numerator(p), triangle_.exact_determinant_value()};
    const int below = compare(z, low), above = compare(z, high);
    if (below >= 0 && above <= 0) return triangle_.biased_depth(p, bias, rungs);
    z = below < 0 ? low : high;
  }
  count(rungs, &Rungs::values_by_expansion);
  if (flat) {
    Expansion<84> numerator(z.numerator);
    numerator.add_scaled(z.denominator, bias.constant);
    return round_quotient(numerator, z.denominator);
  }
  // (z D + c w D + s m D w) / (w D), for z / w the fraction.
  const Expansion<12>& d = triangle_.exact_determinant_value();
  Expansion<288> denominator, slope;
  denominator.add_product_of(z.denominator, d);
  slope.add_product_of(z.denominator, triangle_.exact_slope_numerator());
  Expansion<1440 + 2 * 288 + 2 * 288> numerator;
  numerator.add_product_of(z.numerator, d);
  numerator.add_scaled(denominator, bias.constant);
  numerator.add_scaled(slope, bias.slope);
  return round_quotient(numerator, denominator);
}

}  // namespace surefill
