// SPDX-License-Identifier: Apache-2.0
#include "oracle/coverage.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
namespace surefill::oracle {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Sign of u v - s t: a determinant of order 3 with (0, 0, 1) as its third column.
int sign_of_cross(double u, double s, double t, double v) {
  return sign_of_determinant({u, t, 0}, {s, v, 0}, {0, 0, 1});
}

}  // namespace

Rect intersect(const Rect& a, const Rect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Rect pixels_of(const Target& target) {
  const Origin& origin = target.origin;
  return {origin.x, origin.y, origin.x + target.width, origin.y + target.height};
}

Pattern::Pattern(const Target& target) : samples_(target.samples) {
  for (int n = 0; n < samples_; ++n) {
    const std::size_t place = static_cast<std::size_t>(n);
    places_[place] = target.sample_locations.empty()
                         ? sample_point(samples_, n, 0, 0)
                         : Point{target.sample_locations[place].x, target.sample_locations[place].y};
  }
}

int sign_of_determinant(const Position& m0, const Position& m1, const Position& m2) {
  const Kernel::Point_3 eye(0, 0, 0);
  return CGAL::orientation(eye, Kernel::Point_3(m0.x, m0.y, m0.w), Kernel::Point_3(m1.x, m1.y, m1.w),
                           Kernel::Point_3(m2.x, m2.y, m2.w));
}

Cone::Cone(const std::array<Position, 3>& positions, FillRule rule)
    : m_(positions), tie_{}, det_(sign_of_determinant(m_[0], m_[1], m_[2])) {
  if (rule == FillRule::closed || rule == FillRule::open) {
    tie_.fill(rule == FillRule::closed ? 1 : -1);
    return;
  }
  const Step step = step_of(rule);
  for (std::size_t i = 0; i < 3; ++i) {
    const Position &j = m_[(i + 1) % 3], &k = m_[(i + 2) % 3];
    const int along_x = det_ * step.x * sign_of_cross(j.y, j.w, k.y, k.w);  // a_i = Yj Wk - Wj Yk
    const int along_y = det_ * step.y * sign_of_cross(j.w, j.x, k.w, k.x);  // b_i = Wj Xk - Xj Wk
    const int first = step.x_first ? along_x : along_y;
    tie_[i] = first != 0 ? first : (step.x_first ? along_y : along_x);
  }
}

int Cone::sign(int edge, Point p) const {
  const std::size_t i = static_cast<std::size_t>(edge);
  return det_ * sign_of_determinant(m_[(i + 1) % 3], m_[(i + 2) % 3], {p.x / double{kUnits}, p.y / double{kUnits}, 1});
}

int Cone::owning_sign(int edge, Point p) const {
  const int at_p = sign(edge, p);
  return at_p != 0 ? at_p : tie_[static_cast<std::size_t>(edge)];
}

bool Cone::covers(Point p) const {
  return det_ != 0 && owning_sign(0, p) > 0 && owning_sign(1, p) > 0 && owning_sign(2, p) > 0;
}

Rect Cone::bounds(const Rect& target) const {
  if (m_[0].w <= 0 || m_[1].w <= 0 || m_[2].w <= 0) return target;
  // The hull of the projected vertices. Within the target a quotient in double is off by far less than a pixel, and two
  // pixels of margin hold M4's touching squares too; beyond it the clamp loses nothing.
  const auto pixel = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(value, low - 4.0, high + 4.0));
  };
  const auto [left, right] = std::minmax({m_[0].x / m_[0].w, m_[1].x / m_[1].w, m_[2].x / m_[2].w});
  const auto [top, bottom] = std::minmax({m_[0].y / m_[0].w, m_[1].y / m_[1].w, m_[2].y / m_[2].w});
  return intersect(
      target, {pixel(std::floor(left), target.x0, target.x1) - 2, pixel(std::floor(top), target.y0, target.y1) - 2,
               pixel(std::ceil(right), target.x0, target.x1) + 2, pixel(std::ceil(bottom), target.y0, target.y1) + 2});
}

}  // namespace surefill::oracle
