// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/drawings.hpp"

#include <algorithm>
#include <cmath>

namespace surefill::judge::drawings {

namespace {

// Is (x, y) in the triangle, or too near an edge to say?
int cover(const Triangle& t, double x, double y) {
  std::array<double, 3> e{};
  double det = 0;
  bool front = true, open = false;
  for (const Point& p : t) front = front && p.w > 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = t[(i + 1) % 3], &q = t[(i + 2) % 3];
    const double a = p.y * q.w - p.w * q.y, b = p.w * q.x - p.x * q.w, c = p.x * q.y - p.y * q.x;
    e[i] = a * x + b * y + c;
    det += e[i] * t[i].w;
    const double length = std::hypot(a, b);
    if (length == 0 || std::abs(e[i]) >= (front ? 1.0 / 16 : 0.25) * length) continue;
    if (front) {
      const double px = p.x / p.w, py = p.y / p.w, dx = q.x / q.w - px, dy = q.y / q.w - py, far = std::hypot(dx, dy);
      const double along = ((x - px) * dx + (y - py) * dy) / far;
      if (!(along > -1.0 / 16 && along < far + 1.0 / 16)) continue;
    }
    open = true;
  }
  if (open) return kOpen;
  return det != 0 && e[0] / det > 0 && e[1] / det > 0 && e[2] / det > 0 ? 1 : 0;
}

}  // namespace

void paint(Drawing& to, const Triangle& t) {
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      to.counts[static_cast<std::size_t>(y * to.width + x)] += cover(t, x + to.place_x, y + to.place_y);
    }
  }
}

void paint_fan(Drawing& to, const Polygon& polygon, std::size_t most) {
  for (std::size_t i = 1; i + 1 < std::min(polygon.size(), most); ++i)
    paint(to, {polygon[0], polygon[i], polygon[i + 1]});
}

std::array<double, 4> box_of(const Triangle& t) {
  std::array<double, 4> box{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const Point& p : t) {
    const double x = divided(p.x, p), y = divided(p.y, p);
    box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
  }
  return box;
}

void scan_lines(const Triangle& t, Drawing& to, int how) {
  Triangle v = t;
  for (Point& p : v) p = at(divided(p.x, p), divided(p.y, p));
  std::sort(v.begin(), v.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
  const auto row = [&to](double y) { return std::ceil(y - to.place_y); };
  const double first = row(v[0].y), middle = row(v[1].y), last = row(v[2].y);
  for (double y = std::max(first, 0.0); y < std::min<double>(last, to.height); ++y) {
    const double centre = y + to.place_y;
    const auto x_of = [&](const Point& p, const Point& q, bool bare) {
      const double slope = (q.x - p.x) / (q.y - p.y), x = how == 4 && p == v[1] ? std::round(p.x) : p.x;
      return x + slope * (bare ? y - row(p.y) : centre - p.y);
    };
    const double a = x_of(v[0], v[2], how == 0), b = y < middle ? x_of(v[0], v[1], how < 2) : x_of(v[1], v[2], how < 2);
    const double low = std::min(a, b), high = std::max(a, b);
    double begin = std::ceil(low - to.place_x), end = std::ceil(high - to.place_x);
    if (how == 2) begin = std::floor(low), end = std::ceil(high);
    if (how == 3 && end - begin == 1) continue;
    if (how == 5) end = std::floor(high) + 1;
    for (double x = std::max(begin, 0.0); x < std::min<double>(end, to.width); ++x) {
      to.counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x)] += 1;
    }
    for (const double edge : {low, high}) {
      for (double x = std::floor(edge) - 1; x <= std::floor(edge) + 1; ++x) {
        const double turn = how == 2 || how == 5 ? 0 : to.place_x;
        if (x < 0 || x >= to.width || std::abs(x + turn - edge) > 1.0 / 16) continue;
        to.counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x)] =
            kOpen;
      }
    }
  }
}

void unrejected_blocks(const Triangle& t, Drawing& to, int n) {
  const double turn = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
  const auto box = box_of(t);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      double least = INFINITY;  // of the edges, how far inside of it the block reaches
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &p = t[i], &q = t[(i + 1) % 3];
        double most = -INFINITY;
        for (const int corner : {0, 1, 2, 3}) {
          const double cx = x / n * n + corner % 2 * (n - 1) + to.place_x,
                       cy = y / n * n + corner / 2 * (n - 1) + to.place_y;
          most = std::max(most, ((q.x - p.x) * (cy - p.y) - (q.y - p.y) * (cx - p.x)) * (turn < 0 ? -1 : 1) /
                                    std::hypot(q.x - p.x, q.y - p.y));
        }
        least = std::min(least, most);
      }
      const int x0 = x / n * n, y0 = y / n * n;
      const bool reached = x0 <= std::floor(box[2]) && x0 + n > box[0] && y0 <= std::floor(box[3]) && y0 + n > box[1];
      to.counts[static_cast<std::size_t>(y * to.width + x)] += std::abs(least) < 1.0 / 16 ? kOpen
                                                               : least > 0 && reached     ? 1
                                                                                          : 0;
    }
  }
}

void until_an_empty_row(const Triangle& t, Drawing& to, bool from_the_box) {
  paint(to, t);
  const auto box = box_of(t);
  bool begun = from_the_box, lost = false, unsure = false;
  for (int y = std::max(0, static_cast<int>(std::floor(box[1]))); y < to.height; ++y) {
    const auto begin = to.counts.begin() + static_cast<std::ptrdiff_t>(y) * to.width, end = begin + to.width;
    const bool covered = std::find(begin, end, 1) != end,
               open = std::any_of(begin, end, [](int n) { return n >= kOpen; });
    for (auto count = begin; count != end; ++count) *count = lost ? 0 : unsure && *count == 1 ? kOpen : *count;
    lost = lost || (begun && !covered && !open);
    unsure = unsure || (!covered && open);
    begun = begun || covered;
  }
}

namespace {

constexpr double kMargin = 1.0 / 16;

// How far inside of each edge a place is, of a triangle in front of the eye.
std::array<double, 3> inside_of(const Triangle& t, double x, double y) {
  const double turn = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
  std::array<double, 3> distance{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = t[i], &q = t[(i + 1) % 3];
    distance[i] =
        ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)) * (turn < 0 ? -1 : 1) / std::hypot(q.x - p.x, q.y - p.y);
  }
  return distance;
}

}  // namespace

void by_corners(const Triangle& t, Drawing& to, int n, const Taken& how) {
  paint(to, t);
  const bool centres = how.extent == Extent::centres;
  const double low_x = centres ? to.place_x : 0, low_y = centres ? to.place_y : 0,
               size = how.extent == Extent::block ? n : n - 1;
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const double left = x / n * n + low_x, top = y / n * n + low_y;
      std::array<std::array<double, 3>, 4>
          inside{};  // of the corners: upper left, upper right, lower left, lower right
      for (std::size_t c = 0; c < 4; ++c) {
        inside[c] = inside_of(t, left + (c % 2 == 0 ? 0 : size), top + (c / 2 == 0 ? 0 : size));
      }
      double least = INFINITY;
      for (std::size_t i = 0; i < 3; ++i) {
        const bool grows_right = inside[1][i] > inside[0][i], grows_down = inside[2][i] > inside[0][i];
        // The corner that tells: the one that is inside most where blocks are rejected, or least where they are accepted.
        const std::size_t one = (how.corners == Corners::by_a ? grows_right : grows_down) == how.accepts ? 0 : 3;
        double edge = how.accepts ? INFINITY : -INFINITY;
        for (std::size_t c = 0; c < 4; ++c) {
          const bool counts = how.corners == Corners::all       ? true
                              : how.corners == Corners::falling ? c % 3 == 0
                              : how.corners == Corners::rising  ? c % 3 != 0
                                                                : c == one;
          if (counts) edge = how.accepts ? std::min(edge, inside[c][i]) : std::max(edge, inside[c][i]);
        }
        least = std::min(least, edge);
      }
      int& count = to.counts[static_cast<std::size_t>(y * to.width + x)];
      const int becomes = how.accepts ? 1 : 0;
      if (how.accepts ? least > kMargin : least < -kMargin) count = becomes;
      if (std::abs(least) <= kMargin && count != becomes) count = kOpen;
    }
  }
}

void forgotten_edges(const Triangle& t, Drawing& to, int n) {
  enum { tested, unsure, forgotten };
  std::array<int, 3> state{tested, tested, tested};
  const auto box = box_of(t);
  const auto first = [n](double low) { return std::max(0, static_cast<int>(std::floor(low / n)) * n); };
  for (int ty = first(box[1]); ty < to.height && ty <= box[3]; ty += n) {
    for (int tx = first(box[0]); tx < to.width && tx <= box[2]; tx += n) {
      std::array<double, 3> most{-INFINITY, -INFINITY, -INFINITY}, least{INFINITY, INFINITY, INFINITY};
      for (const int c : {0, 1, 2, 3}) {
        const auto inside = inside_of(t, tx + c % 2 * n, ty + c / 2 * n);
        for (std::size_t i = 0; i < 3; ++i)
          most[i] = std::max(most[i], inside[i]), least[i] = std::min(least[i], inside[i]);
      }
      bool reached = true;
      for (std::size_t i = 0; i < 3; ++i) {
        reached = reached && most[i] > 0;
        if (least[i] > 1) state[i] = forgotten;
        if (least[i] > -1 && state[i] == tested) state[i] = unsure;  // pixel centres may be looked at, or corners
      }
      for (int y = ty; reached && y < std::min(ty + n, to.height); ++y) {
        for (int x = tx; x < std::min(tx + n, to.width); ++x) {
          const auto inside = inside_of(t, x + to.place_x, y + to.place_y);
          // A tile may be drawn whole, or up to the triangle's box.
          bool covered = true, open = x + 1 < box[0] || x > box[2] || y + 1 < box[1] || y > box[3];
          for (std::size_t i = 0; i < 3; ++i) {
            if (state[i] == forgotten) continue;
            open = open || std::abs(inside[i]) < kMargin || (state[i] == unsure && inside[i] < 0);
            covered = covered && inside[i] > 0;
          }
          to.counts[static_cast<std::size_t>(y * to.width + x)] += open ? kOpen : covered ? 1 : 0;
        }
      }
    }
  }
}

void twice_in_the_middle(const Triangle& t, Drawing& to) {
  paint(to, t);
  std::array<double, 3> y{t[0].y, t[1].y, t[2].y};
  std::sort(y.begin(), y.end());
  // Where they differ, it may be the row that the vertex is in, or the first one below it.
  const double in = std::floor(y[1]), below = std::floor(y[1] + 0.5);
  for (const double row : {in, below}) {
    for (int x = 0; row >= 0 && row < to.height && x < to.width; ++x) {
      int& count = to.counts[static_cast<std::size_t>(row * to.width + x)];
      if (count == 1) count = in == below && y[0] < y[1] && y[1] < y[2] ? 2 : kOpen;
    }
  }
}

void ended_as_rows_above(const Triangle& t, Drawing& to, int n, bool by_centres) {
  paint(to, t);
  const double first = std::floor(box_of(t)[0] + (by_centres ? 0.5 : 0));
  enum { no, yes, unsure };
  for (int y0 = 0; y0 < to.height; y0 += n) {
    for (int x0 = 0; x0 < to.width; x0 += n) {
      int begun = no;
      for (int y = y0; y < std::min(y0 + n, to.height); ++y) {
        int ended = no;
        for (int x = std::max(x0, static_cast<int>(first)); x < std::min(x0 + n, to.width); ++x) {
          int& count = to.counts[static_cast<std::size_t>(y * to.width + x)];
          if (count == 0 && begun != no && ended != yes) ended = begun;
          if (count >= kOpen && begun != no && ended == no) ended = unsure;
          if (count == 1 && ended == no) begun = yes;
          if (count != 0 && begun == no) begun = unsure;
          if (ended != no && count != 0) count = ended == yes ? 0 : kOpen;
        }
      }
    }
  }
}

void masks_of_32_bits(const Triangle& t, Drawing& to, bool all) {
  paint(to, t);
  const std::vector<int> was = to.counts;
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const auto at = [&](int i, int j) { return was[static_cast<std::size_t>(j * to.width + i)]; };
      bool whole = true;
      for (int j = y / 8 * 8; j < std::min(y / 8 * 8 + 8, to.height); ++j) {
        for (int i = x / 8 * 8; i < std::min(x / 8 * 8 + 8, to.width); ++i) whole = whole && at(i, j) != 0;
      }
      int& count = to.counts[static_cast<std::size_t>(y * to.width + x)];
      if (whole && !all) continue;
      if (y % 8 >= 4) count = 0;
      if (y % 8 < 4) count = at(x, y) == 1 ? 1 : y + 4 >= to.height ? kOpen : std::max(at(x, y), at(x, y + 4));
    }
  }
}

}  // namespace surefill::judge::drawings
