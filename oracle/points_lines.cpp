// SPDX-License-Identifier: Apache-2.0
#include "oracle/points_lines.hpp"

#include <gmpxx.h>

#include <array>
#include <optional>

namespace surefill::oracle {

namespace {

// r[0] + r[1] e + r[2] e^2 for an infinitely small e > 0: ordered like a dictionary.
struct Near {
  std::array<mpq_class, 3> r;
};

Near operator*(const mpq_class& f, const Near& a) {
  Near product;
  for (std::size_t i = 0; i < 3; ++i) product.r[i] = f * a.r[i];
  return product;
}
Near real(const mpq_class& value) {
  return {{value, mpq_class(0), mpq_class(0)}};
}
Near operator-(const Near& a, const Near& b) {
  Near difference;
  for (std::size_t i = 0; i < 3; ++i) difference.r[i] = a.r[i] - b.r[i];
  return difference;
}
bool operator<(const Near& a, const Near& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.r[i] != b.r[i]) return a.r[i] < b.r[i];
  }
  return false;
}

// The perturbed sample of C3.
struct Sample {
  Near x, y;
};
Sample perturbed(double x, double y, FillRule rule) {
  const bool y_first = rule >= FillRule::southwards;
  const int n = static_cast<int>(rule) % 4;
  // x dominant: top_left (+, +), top_right (-, +), bottom_left (+, -), bottom_right (-, -); y dominant: southwards (+,
  // +), southwards_west (-, +), northwards (+, -), northwards_west (-, -).
  const int sx = n % 2 == 0 ? 1 : -1, sy = n / 2 == 0 ? 1 : -1;
  Sample p{real(mpq_class(x)), real(mpq_class(y))};
  p.x.r[y_first ? 2 : 1] = sx;
  p.y.r[y_first ? 1 : 2] = sy;
  return p;
}

// The part of the line in front of the eye: the points from + t (dx, dy) for t in [0, 1], or without bound where an end
// is not in front.
struct Segment {
  mpq_class x, y, dx, dy;
  std::optional<mpq_class> first, last;
};

std::optional<Segment> visible_part(const Vertex& v0, const Vertex& v1) {
  const mpq_class x0(v0.x), y0(v0.y), w0(v0.w), x1(v1.x), y1(v1.y), w1(v1.w);
  if (w0 <= 0 && w1 <= 0) return std::nullopt;
  Segment s;
  if (w0 > 0 && w1 > 0) {
    s = {x0 / w0, y0 / w0, x1 / w1 - x0 / w0, y1 / w1 - y0 / w0, mpq_class(0), mpq_class(1)};
  } else if (w0 > 0) {  // m0 + t m1 moves along X1 - X0 W1 / W0
    s = {x0 / w0, y0 / w0, x1 - x0 * w1 / w0, y1 - y0 * w1 / w0, mpq_class(0), std::nullopt};
  } else {  // and from m1 back to m0
    s = {x1 / w1, y1 / w1, x1 * w0 / w1 - x0, y1 * w0 / w1 - y0, std::nullopt, mpq_class(0)};
  }
  if (s.dx == 0 && s.dy == 0) return std::nullopt;
  return s;
}

}  // namespace

bool point_covers(const Vertex& v, float size, double x, double y, FillRule rule) {
  if (!(v.w > 0)) return false;
  const Sample p = perturbed(x, y, rule);
  const mpq_class cx = mpq_class(v.x) / mpq_class(v.w), cy = mpq_class(v.y) / mpq_class(v.w),
                  half = mpq_class(size) / 2;
  const auto within = [&half](const Near& q, const mpq_class& centre) {
    return real(centre - half) < q && q < real(centre + half);
  };
  return within(p.x, cx) && within(p.y, cy);
}

bool line_covers(const Vertex& v0, const Vertex& v1, double x, double y, FillRule rule) {
  const std::optional<Segment> s = visible_part(v0, v1);
  if (!s) return false;
  const Sample p = perturbed(x, y, rule);
  // The open interval of t in the diamond: sx (x(t) - px) + sy (y(t) - py) < 1/2 for all four signs.
  std::optional<Near> low, high;
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      const mpq_class slope = sx * s->dx + sy * s->dy;
      const Near room = real(mpq_class(1, 2)) - mpq_class(sx) * (real(s->x) - p.x) - mpq_class(sy) * (real(s->y) - p.y);
      if (slope == 0) {
        if (!(real(mpq_class(0)) < room)) return false;
        continue;
      }
      const mpq_class inverse = 1 / slope;
      const Near bound = inverse * room;
      if (slope > 0 && (!high || bound < *high)) high = bound;
      if (slope < 0 && (!low || *low < bound)) low = bound;
    }
  }
  if (!(*low < *high)) return false;
  if (s->first && !(real(*s->first) < *high)) return false;  // starts behind it
  return !s->last || *high < real(*s->last);                 // leaves it before the end
}

bool wide_line_covers(const Vertex& v0, const Vertex& v1, float width, double x, double y, FillRule rule) {
  const std::optional<Segment> s = visible_part(v0, v1);
  if (!s) return false;
  const Sample p = perturbed(x, y, rule);
  const bool x_major = abs(s->dx) >= abs(s->dy);
  const mpq_class &along = x_major ? s->dx : s->dy, &across = x_major ? s->dy : s->dx;
  const mpq_class inverse = 1 / along, half = mpq_class(width) / 2;
  const Near t = inverse * (x_major ? p.x - real(s->x) : p.y - real(s->y));
  if (s->first && !(real(*s->first) < t)) return false;
  if (s->last && !(t < real(*s->last))) return false;
  const Near distance = x_major ? p.y - real(s->y) - across * t : p.x - real(s->x) - across * t;
  return real(-half) < distance && distance < real(half);
}

}  // namespace surefill::oracle
