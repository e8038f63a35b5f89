// SPDX-License-Identifier: Apache-2.0
#include "oracle/conservative.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "oracle/exact.hpp"

namespace surefill::oracle {

namespace {

using Rational = mpq_class;

// A convex polygon of the screen in homogeneous integers, w > 0.
struct ScreenCorner {
  Integer x, y, w;
};

// The part of a convex polygon (a point and a segment are polygons too) where a x + b y + c w >= 0: exact, and not
// empty exactly if the intersection is not.
std::vector<ScreenCorner> clip(const std::vector<ScreenCorner>& polygon, const Integer& a, const Integer& b,
                               const Integer& c) {
  const auto height = [&](const ScreenCorner& p) -> Integer { return a * p.x + b * p.y + c * p.w; };
  std::vector<ScreenCorner> kept;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const ScreenCorner& p = polygon[n];
    const ScreenCorner& q = polygon[(n + 1) % polygon.size()];
    const Integer hp = height(p), hq = height(q);
    if (hp >= 0) kept.push_back(p);
    if (sgn(hp) * sgn(hq) < 0) {
      const Integer wp = abs(hq), wq = abs(hp);  // positive weights of p and q at which the height is 0
      kept.push_back({wp * p.x + wq * q.x, wp * p.y + wq * q.y, wp * p.w + wq * q.w});
    }
  }
  return kept;
}

// What T and the rectangle have in common, where D != 0: the rectangle, cut by the three edges.
std::vector<ScreenCorner> common_part(const Cone& cone, const Rect& square) {
  std::vector<ScreenCorner> polygon = {
      {square.x0, square.y0, 1}, {square.x1, square.y0, 1}, {square.x1, square.y1, 1}, {square.x0, square.y1, 1}};
  std::array<float, 9> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    numbers[3 * i] = static_cast<float>(cone.positions()[i].x);
    numbers[3 * i + 1] = static_cast<float>(cone.positions()[i].y);
    numbers[3 * i + 2] = static_cast<float>(cone.positions()[i].w);
  }
  const int exponent = common_exponent(numbers);
  std::array<Integer, 9> m;
  for (std::size_t n = 0; n < 9; ++n) m[n] = scaled_integer(numbers[n], exponent);
  const int det = cone.sign_of_det();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = 3 * ((i + 1) % 3), k = 3 * ((i + 2) % 3);
    const Integer a = m[j + 1] * m[k + 2] - m[j + 2] * m[k + 1];
    const Integer b = m[j + 2] * m[k] - m[j] * m[k + 2];
    const Integer c = m[j] * m[k + 1] - m[j + 1] * m[k];
    polygon = clip(polygon, a * det, b * det, c * det);
  }
  return polygon;
}

// Has the convex polygon an area? Then the triangles of a fan of its first corner have one.
bool has_area(const std::vector<ScreenCorner>& polygon) {
  for (std::size_t n = 2; n < polygon.size(); ++n) {
    const ScreenCorner &p = polygon[0], &q = polygon[n - 1], &r = polygon[n];
    const Integer twice = p.x * (q.y * r.w - q.w * r.y) + p.y * (q.w * r.x - q.x * r.w) + p.w * (q.x * r.y - q.y * r.x);
    if (twice != 0) return true;
  }
  return false;
}

bool lies_within(const Cone& cone, const Rect& square) {
  for (int edge = 0; edge < 3; ++edge) {
    for (int n = 0; n < 4; ++n) {
      if (cone.sign(edge, square.corner(n)) < 0) return false;
    }
  }
  return true;
}

// The t >= 0 at which low <= from + t step <= high: `first` and `last` are cut to them. False if there are none.
bool cut(const Rational& from, const Rational& step, int low, int high, Rational& first,
         std::optional<Rational>& last) {
  if (step == 0) return from >= low && from <= high;
  Rational enter = (low - from) / step, leave = (high - from) / step;
  if (step < 0) swap(enter, leave);
  if (first < enter) first = enter;
  if (!last || leave < *last) last = leave;
  return first <= *last;
}

}  // namespace

// S is a segment where both W > 0; where one of them is, it is the ray from that vertex, in the direction in which the
// other one pulls:
// (X_0 + t X_1) / (W_0 + t W_1) - X_0 / W_0 = t (X_1 W_0 - X_0 W_1) / (W_0 (W_0 + t W_1)), of all lengths.
bool edge_meets(const Position& m0, const Position& m1, const Rect& square) {
  if (m0.w <= 0 && m1.w <= 0) return false;
  if (m0.w <= 0) return edge_meets(m1, m0, square);
  const Rational x0(m0.x), y0(m0.y), w0(m0.w), x1(m1.x), y1(m1.y), w1(m1.w);
  const Rational x = x0 / w0, y = y0 / w0;
  Rational dx = x1 * w0 - x0 * w1, dy = y1 * w0 - y0 * w1, first = 0;
  std::optional<Rational> last;
  if (w1 > 0) {
    dx = x1 / w1 - x, dy = y1 / w1 - y;
    last = 1;
  }
  return cut(x, dx, square.x0, square.x1, first, last) && cut(y, dy, square.y0, square.y1, first, last);
}

bool meets(const Cone& cone, const Rect& square, Conservative mode) {
  const std::array<Position, 3>& m = cone.positions();
  if (cone.sign_of_det() == 0) {
    return mode == Conservative::touched &&
           (edge_meets(m[0], m[1], square) || edge_meets(m[1], m[2], square) || edge_meets(m[2], m[0], square));
  }
  switch (mode) {
    case Conservative::inner:
      return lies_within(cone, square);
    case Conservative::overlap:
      return has_area(common_part(cone, square));
    case Conservative::over:
    case Conservative::touched:
    case Conservative::none:
      break;
  }
  return !common_part(cone, square).empty();
}

}  // namespace surefill::oracle
