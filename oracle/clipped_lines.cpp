// SPDX-License-Identifier: Apache-2.0
#include "oracle/clipped_lines.hpp"

#include <algorithm>

namespace surefill::oracle::clipped {

namespace {

Point seen(const Vector& m) {
  return {m.x / m.w, m.y / m.w};
}

// The convex hull, turning from +x to +y (Andrew's monotone chain).
std::vector<Point> hull(std::vector<Point> points) {
  std::ranges::sort(points, [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Point> chain;
  const auto add = [&chain](const Point& p, std::size_t keep) {
    while (chain.size() > keep) {
      const Point &a = chain[chain.size() - 2], &b = chain.back();
      const Rational turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
      if (sgn(turn) > 0) break;
      chain.pop_back();
    }
    chain.push_back(p);
  };
  for (const Point& p : points) add(p, 1);
  const std::size_t lower = chain.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  chain.pop_back();
  return chain;
}

// A polygon cut to one pixel around the target: no sample is on the lines of the cut.
std::vector<Point> cut(const std::vector<Point>& polygon, int width, int height) {
  std::vector<Corner> corners;
  for (const Point& p : polygon) corners.push_back({p.x, p.y, 0, 1});
  std::vector<Point> result;
  for (const Corner& corner : clip_to_box(std::move(corners), -1, width + 1, -1, height + 1)) {
    result.push_back({corner.x / corner.w, corner.y / corner.w});
  }
  return result;
}

// The corners of the diamond around a point: |x - px| + |y - py| <= 1/2.
void add_diamond(std::vector<Point>& points, const Point& p) {
  const Rational half(1, 2);
  points.push_back({p.x - half, p.y});
  points.push_back({p.x + half, p.y});
  points.push_back({p.x, p.y - half});
  points.push_back({p.x, p.y + half});
}

}  // namespace

Area point_area(const Vector& m, const Rational& side, int width, int height) {
  if (sgn(m.w) <= 0) return {};
  const Point p = seen(m);
  const Rational half = side / 2;
  const std::vector<Point> square = {
      {p.x - half, p.y - half}, {p.x + half, p.y - half}, {p.x + half, p.y + half}, {p.x - half, p.y + half}};
  return {cut(square, width, height), {}};
}

std::optional<SeenLine> SeenLine::make(const Vector& m0, const Vector& m1) {
  if (sgn(m0.w) <= 0 && sgn(m1.w) <= 0) return std::nullopt;
  Point direction;
  if (sgn(m0.w) > 0 && sgn(m1.w) > 0) {
    const Point from = seen(m0), to = seen(m1);
    direction = {to.x - from.x, to.y - from.y};
  } else {
    // Where the line passes W = 0 is where its ray goes to.
    const Rational a = abs(m1.w), b = abs(m0.w);
    direction = {a * m0.x + b * m1.x, a * m0.y + b * m1.y};
  }
  if (sgn(direction.x) == 0 && sgn(direction.y) == 0) return std::nullopt;
  SeenLine line;
  line.m_ = {m0, m1};
  line.x_major_ = abs(direction.x) >= abs(direction.y);
  return line;
}

Vector SeenLine::at(const Rational& share) const {
  const Rational rest = 1 - share;
  return {rest * m_[0].x + share * m_[1].x, rest * m_[0].y + share * m_[1].y, rest * m_[0].w + share * m_[1].w};
}

// The shares at which low <= T / W <= high for the major coordinate T. Between T - low W >= 0 and high W - T >= 0 is
// (high - low) W >= 0, and W = 0 would leave T = 0: the ray would go along the other axis, or the eye lie on the line.
std::optional<std::pair<Rational, Rational>> SeenLine::shares_between(const Rational& low, const Rational& high) const {
  Rational first = 0, last = 1;
  for (const bool lower : {true, false}) {
    std::array<Rational, 2> height;
    for (std::size_t i = 0; i < 2; ++i) {
      height[i] = lower ? Rational(major(m_[i]) - low * m_[i].w) : Rational(high * m_[i].w - major(m_[i]));
    }
    if (sgn(height[0]) < 0 && sgn(height[1]) < 0) return std::nullopt;
    if (sgn(height[0]) >= 0 && sgn(height[1]) >= 0) continue;
    const Rational root = height[0] / (height[0] - height[1]);
    if (sgn(height[0]) < 0) {
      first = std::max(first, root);
    } else {
      last = std::min(last, root);
    }
  }
  if (first > last) return std::nullopt;
  return std::pair{first, last};
}

// Of width w: the perturbed sample lies between the ends of S and less than w/2 beside it: in S, thickened on both sides
// along the minor axis. Thin: S meets the diamond around it exactly if it lies in a diamond around a point of S, and
// these fill the hull of the diamonds around the ends of S; S ends in its diamond exactly if it lies in that around the
// end. No perturbed sample lies on a side. What of S is a pixel and more off the target along the major axis is out of
// reach.
Area SeenLine::area(const std::optional<Rational>& line_width, int width, int height) const {
  const auto shares = shares_between(-1, (x_major_ ? width : height) + 1);
  if (!shares) return {};
  std::vector<Point> points, end;
  for (const Rational& share : {shares->first, shares->second}) {
    const Point p = seen(at(share));
    if (line_width) {
      const Rational half = *line_width / 2;
      const Rational x = x_major_ ? Rational(0) : half, y = x_major_ ? half : Rational(0);
      points.push_back({p.x - x, p.y - y});
      points.push_back({p.x + x, p.y + y});
    } else {
      add_diamond(points, p);
    }
  }
  if (!line_width && sgn(m_[1].w) > 0 && shares->second == 1) add_diamond(end, seen(m_[1]));
  return {cut(hull(std::move(points)), width, height), end.empty() ? end : cut(hull(std::move(end)), width, height)};
}

// The plane of the eye and all places with the major coordinate of p, T = t W, cuts the line where the distances of its
// ends are in proportion; or it does not, or behind the eye, and then it is the end of S that is nearest along that axis.
SeenLine::Place SeenLine::place(const Vector& p) const {
  const Rational t = major(p) / p.w;
  std::array<Rational, 2> off;
  for (std::size_t i = 0; i < 2; ++i) off[i] = major(m_[i]) - t * m_[i].w;
  if (sgn(off[0]) * sgn(off[1]) <= 0) {
    const Rational share = off[0] / (off[0] - off[1]);  // not both 0: the line does not lie in the plane
    const Rational w = at(share).w;
    if (sgn(w) > 0) return {share, w};
  }
  bool second = sgn(m_[0].w) <= 0;
  if (sgn(m_[0].w) > 0 && sgn(m_[1].w) > 0) {
    second = abs(off[1] / m_[1].w) < abs(off[0] / m_[0].w);
  }
  return second ? Place{1, m_[1].w} : Place{0, m_[0].w};
}

}  // namespace surefill::oracle::clipped
