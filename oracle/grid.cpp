// SPDX-License-Identifier: Apache-2.0
#include "oracle/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surefill::oracle {

namespace {

constexpr int kGuardBand = (1 << 14) + 1;  // g of G1, pixels
constexpr unsigned kOffsetBits = 4;        // offsets are in units of 2^-(bits + 4) pixels

struct Cross {
  Integer x, y, w;
};

Cross cross(const IntegerVertex& a, const IntegerVertex& b) {
  return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

Integer dot(const Cross& a, const Cross& b) {
  return a.x * b.x + a.y * b.y + a.w * b.w;
}

bool is_zero(const Cross& a) {
  return a.x == 0 && a.y == 0 && a.w == 0;
}

// The part of a convex polygon where height >= 0, a linear function of (X, Y, W). Cut points are exact, so each is the
// one point of its edge where the height is 0, whichever way the edge is walked.
template <typename Height>
std::vector<IntegerVertex> clip(const std::vector<IntegerVertex>& polygon, const Height& height) {
  std::vector<IntegerVertex> kept;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const IntegerVertex& p = polygon[n];
    const IntegerVertex& q = polygon[(n + 1) % polygon.size()];
    const Integer hp = height(p), hq = height(q);
    if (hp >= 0) kept.push_back(p);
    if (sgn(hp) * sgn(hq) < 0) {
      const Integer a = abs(hq), b = abs(hp);
      kept.push_back({a * p.x + b * q.x, a * p.y + b * q.y, a * p.z + b * q.z, a * p.w + b * q.w});
    }
  }
  return kept;
}

Integer floor_divide(const Integer& n, const Integer& d) {
  Integer quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
  return quotient;
}

// n / d rounded to an integer. d > 0.
Integer round_quotient(const Integer& n, const Integer& d, GridRounding rounding) {
  Integer result;
  switch (rounding) {
    case GridRounding::truncate:
      mpz_tdiv_q(result.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
      break;
    case GridRounding::nearest_up:  // floor(n / d + 1/2)
      result = floor_divide(2 * n + d, 2 * d);
      break;
    case GridRounding::nearest_even:
      result = floor_divide(2 * n + d, 2 * d);
      if (2 * n + d == 2 * d * result && mpz_odd_p(result.get_mpz_t()) != 0)
        result -= 1;  // a tie, rounded to the odd one
      break;
  }
  return result;
}

// The snapped coordinate of n / d, in units of 2^-(bits + 4) pixels.
double snap(const Integer& n, const Integer& d, unsigned bits, int offset, GridRounding rounding) {
  // (n / d - offset 2^-(bits + 4)) 2^bits = (16 2^bits n - offset d) / (16 d)
  const Integer k = round_quotient((n << (bits + kOffsetBits)) - offset * d, d << kOffsetBits, rounding);
  const Integer snapped = offset + (k << kOffsetBits);
  return snapped.get_d();  // exact: at most 40 bits
}

}  // namespace

std::array<IntegerVertex, 3> integer_vertices(const std::array<Vertex, 3>& vertices) {
  std::array<float, 12> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = vertices[i];
    std::copy_n(std::array{v.x, v.y, v.z, v.w}.begin(), 4, numbers.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  const int exponent = common_exponent(numbers);
  std::array<IntegerVertex, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = vertices[i];
    result[i] = {scaled_integer(v.x, exponent), scaled_integer(v.y, exponent), scaled_integer(v.z, exponent),
                 scaled_integer(v.w, exponent)};
  }
  return result;
}

bool hull_contains_eye(const std::array<IntegerVertex, 3>& m) {
  const std::array<Cross, 3> normal = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
  // On a side, or at a vertex: the two ends are opposite, or one of them is the eye.
  for (std::size_t i = 0; i < 3; ++i) {
    const IntegerVertex &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
    if (is_zero(normal[i]) && a.x * b.x + a.y * b.y + a.w * b.w <= 0) return true;
  }
  // Inside: the three lie in a plane through the eye, and turn around it in one sense.
  const Integer det = m[0].x * normal[0].x + m[0].y * normal[0].y + m[0].w * normal[0].w;
  return det == 0 && dot(normal[0], normal[1]) > 0 && dot(normal[1], normal[2]) > 0 && dot(normal[2], normal[0]) > 0;
}

std::vector<IntegerVertex> clip_to_guard_band(const std::array<IntegerVertex, 3>& m, const Origin& origin) {
  if (hull_contains_eye(m)) return {};
  std::vector<IntegerVertex> polygon(m.begin(), m.end());
  // |X - ox W| <= g W, |Y - oy W| <= g W
  polygon = clip(polygon, [&](const IntegerVertex& v) -> Integer { return (origin.x + kGuardBand) * v.w - v.x; });
  polygon = clip(polygon, [&](const IntegerVertex& v) -> Integer { return v.x - (origin.x - kGuardBand) * v.w; });
  polygon = clip(polygon, [&](const IntegerVertex& v) -> Integer { return (origin.y + kGuardBand) * v.w - v.y; });
  polygon = clip(polygon, [&](const IntegerVertex& v) -> Integer { return v.y - (origin.y - kGuardBand) * v.w; });
  return polygon;
}

SnappedPolygon::SnappedPolygon(const std::vector<IntegerVertex>& clipped, const Grid& grid, FillRule rule) {
  const unsigned bits = static_cast<unsigned>(grid.bits);
  const double unit = std::ldexp(1.0, -static_cast<int>(bits + kOffsetBits));
  std::vector<Position> corners;
  corners.reserve(clipped.size());
  for (const IntegerVertex& v : clipped) {
    corners.push_back({snap(v.x, v.w, bits, grid.offset_x, grid.rounding) * unit,
                       snap(v.y, v.w, bits, grid.offset_y, grid.rounding) * unit, 1});
  }
  if (corners.size() < 3) return;
  for (std::size_t n = 1; n + 1 < corners.size(); ++n) {
    const Cone triangle({corners[0], corners[n], corners[n + 1]}, rule);
    if (triangle.sign_of_det() != 0) fan_.push_back(triangle);
  }
  const auto by_x = [](const Position& a, const Position& b) { return a.x < b.x; };
  const auto by_y = [](const Position& a, const Position& b) { return a.y < b.y; };
  const auto [left, right] = std::minmax_element(corners.begin(), corners.end(), by_x);
  const auto [top, bottom] = std::minmax_element(corners.begin(), corners.end(), by_y);
  // A sample on the boundary may be covered, and lies in a pixel that begins there: hence the + 1.
  bounds_ = {static_cast<int>(std::floor(left->x)), static_cast<int>(std::floor(top->y)),
             static_cast<int>(std::floor(right->x)) + 1, static_cast<int>(std::floor(bottom->y)) + 1};
}

int SnappedPolygon::winding(Point p) const {
  int sum = 0;
  for (const Cone& triangle : fan_) {
    if (triangle.covers(p)) sum += triangle.sign_of_det();
  }
  return sum;
}

Rect SnappedPolygon::bounds(const Rect& target) const {
  return fan_.empty() ? Rect{0, 0, 0, 0} : intersect(bounds_, target);
}

}  // namespace surefill::oracle
