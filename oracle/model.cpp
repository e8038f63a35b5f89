// SPDX-License-Identifier: Apache-2.0
#include "oracle/model.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/coverage.hpp"
#include "oracle/edges.hpp"
#include "oracle/exact.hpp"
#include "oracle/positions.hpp"

namespace surefill::oracle {

namespace {

constexpr double kUnclear = 1.0 / 16;  // R9
constexpr float kMostDepth = 0x1p8f;   // between vertices

struct Box {
  Interval x, y;
  bool is_point() const { return x.is_point() && y.is_point(); }
};

// R7's edge function: (q - p) x (s - p).
template <typename Number>
Number edge_function(const Number& px, const Number& py, const Number& qx, const Number& qy, const Number& sx,
                     const Number& sy) {
  return Number((qx - px) * (sy - py) - (qy - py) * (sx - px));
}

// The smallest and the largest value of a function that is linear in each coordinate, given at all corners.
struct Signs {
  bool positive = false, negative = false, zero = false;
  void add(int sign) { (sign > 0 ? positive : sign < 0 ? negative : zero) = true; }
  bool all_positive() const { return positive && !negative && !zero; }
  bool all_negative() const { return negative && !positive && !zero; }
  bool all_zero() const { return zero && !positive && !negative; }
};

// Sample n of pixel (x, y), which is rarely wanted as more than a double.
struct Sample {
  int pixel_x, pixel_y;
  Point moved;  // from the place, in 1/16 pixel: S4
  double place_x, place_y;
  double within_x, within_y;

  bool is_point() const { return within_x == 0 && within_y == 0; }
  double near_x() const { return pixel_x + moved.x / 16.0 + place_x; }
  double near_y() const { return pixel_y + moved.y / 16.0 + place_y; }
  // Corner n = 0..3 of the box that it lies in.
  double near_x(unsigned n) const { return near_x() + (n % 2 == 0 ? -within_x : within_x); }
  double near_y(unsigned n) const { return near_y() + (n / 2 == 0 ? -within_y : within_y); }
  Rational x(unsigned n) const { return exact(moved.x, pixel_x, place_x, n % 2 == 0 ? -within_x : within_x); }
  Rational y(unsigned n) const { return exact(moved.y, pixel_y, place_y, n / 2 == 0 ? -within_y : within_y); }

 private:
  static Rational exact(int sixteenths, int pixel, double place, double aside) {
    Rational part(sixteenths, kUnits);
    part.canonicalize();
    return part + pixel + Rational(place) + Rational(aside);
  }
};

// Beyond this distance from 0 the sign of an edge function in double is right: coordinates are below `size`.
double certain_above(double size) {
  return 0x1p-48 * (size + 1) * (size + 1);
}

Signs signs_of_edge(const Box& p, const Box& q, const Sample& s, double certain) {
  Signs signs;
  const unsigned corners = p.is_point() && q.is_point() ? 1 : 16, places = s.is_point() ? 1 : 4;
  for (unsigned place = 0; place < places; ++place) {
    for (unsigned n = 0; n < corners; ++n) {
      const double value = edge_function(near_end(p.x, n), near_end(p.y, n >> 1), near_end(q.x, n >> 2),
                                         near_end(q.y, n >> 3), s.near_x(place), s.near_y(place));
      if (std::abs(value) > certain) {
        signs.add(value > 0 ? 1 : -1);
      } else {
        signs.add(sgn(edge_function(end_of(p.x, n), end_of(p.y, n >> 1), end_of(q.x, n >> 2), end_of(q.y, n >> 3),
                                    s.x(place), s.y(place))));
      }
    }
  }
  return signs;
}

Signs signs_of_area(const std::array<Box, 3>& t) {
  Signs signs;
  double size = 0;
  for (const Box& box : t) {
    for (const Interval* axis : {&box.x, &box.y}) {
      size = std::max({size, std::abs(axis->near_low), std::abs(axis->near_high)});
    }
  }
  const double certain = certain_above(size);
  const bool points = t[0].is_point() && t[1].is_point() && t[2].is_point();
  for (unsigned n = 0; n < (points ? 1u : 64u); ++n) {
    const double value = edge_function(near_end(t[0].x, n), near_end(t[0].y, n >> 1), near_end(t[1].x, n >> 2),
                                       near_end(t[1].y, n >> 3), near_end(t[2].x, n >> 4), near_end(t[2].y, n >> 5));
    if (std::abs(value) > certain) {
      signs.add(value > 0 ? 1 : -1);
    } else {
      signs.add(sgn(edge_function(end_of(t[0].x, n), end_of(t[0].y, n >> 1), end_of(t[1].x, n >> 2),
                                  end_of(t[1].y, n >> 3), end_of(t[2].x, n >> 4), end_of(t[2].y, n >> 5))));
    }
  }
  return signs;
}

// The least area, twice, of a triangle with a corner in each box: the area is linear in each coordinate.
double least_area(const std::array<Box, 3>& t) {
  double least = INFINITY;
  for (unsigned n = 0; n < 64; ++n) {
    const double value = edge_function(near_end(t[0].x, n), near_end(t[0].y, n >> 1), near_end(t[1].x, n >> 2),
                                       near_end(t[1].y, n >> 3), near_end(t[2].x, n >> 4), near_end(t[2].y, n >> 5));
    least = std::min(least, std::abs(value));
  }
  return least;
}

// The side that the edge from p to q is on, the inside being where E > 0. Both are points.
Side side_of(const Box& p, const Box& q) {
  const int inside_x = sgn(Rational(end_of(p.y, 0) - end_of(q.y, 0)));
  const int inside_y = sgn(Rational(end_of(q.x, 0) - end_of(p.x, 0)));
  if (inside_y == 0) return inside_x > 0 ? Side::left : Side::right;
  if (inside_x == 0) return inside_y > 0 ? Side::top : Side::bottom;
  if (inside_y > 0) return inside_x > 0 ? Side::top_left : Side::top_right;
  return inside_x > 0 ? Side::bottom_left : Side::bottom_right;
}

bool all_finite(const std::array<Vertex, 3>& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [](const Vertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  });
}

int sign_of_d(const std::array<Vertex, 3>& t) {
  const auto position = [](const Vertex& v) { return Position{v.x, v.y, v.w}; };
  return sign_of_determinant(position(t[0]), position(t[1]), position(t[2]));
}

// What R7 to R10 make of a triangle before any sample is looked at.
struct Placed {
  enum class Kind { boxes, clipped, open, nothing } kind = Kind::boxes;
  std::array<Box, 3> boxes;  // of `boxes`, positive; of `open`; of `clipped` that is `near`
  bool near = false;         // all boxes are known
  bool whole = true;         // of `clipped`: its inside is drawn
  bool front = true;
  bool culled = false;  // of `clipped`, where it is clear
};

Placed place_triangle(const Model& model, int width, int height, const std::array<Vertex, 3>& t) {
  Placed placed;
  const int d = sign_of_d(t);
  placed.front = d > 0;
  const bool in_range = std::all_of(t.begin(), t.end(), [&](const Vertex& v) { return in_range_of_w(model, v); });
  bool near = std::all_of(t.begin(), t.end(), [](const Vertex& v) { return v.w > 0; });
  for (std::size_t i = 0; i < 3 && near; ++i) {
    near = place_vertex(model.x, width, t[i].x, t[i].w, placed.boxes[i].x) &&
           place_vertex(model.y, height, t[i].y, t[i].w, placed.boxes[i].y);
  }
  const bool culled = model.culled != Cull::none && (model.culled == Cull::front) == placed.front;
  placed.near = near;
  const bool in_band = std::all_of(placed.boxes.begin(), placed.boxes.end(), [&](const Box& b) {
    return in_band_of(model, b.x, width) && in_band_of(model, b.y, height);
  });
  if (!near || !in_range || !in_band ||
      std::any_of(t.begin(), t.end(), [&model](const Vertex& v) { return cut_by_depth(model, v); })) {
    placed.kind = Placed::Kind::clipped, placed.culled = culled;
    placed.whole = in_range && model.least_area == 0;
    return placed;
  }
  const Signs area = signs_of_area(placed.boxes);
  const bool kept = d == 0 ? area.all_zero() : d > 0 ? area.all_positive() : area.all_negative();
  // Who compares D with what came of it has D rounded, too.
  const Edges edges(t);
  const bool unsure = (model.x.bits >= 0 || model.y.bits >= 0) && edges.is_thin() &&
                      (model.culled != Cull::none || model.turned != Turned::as_grid);
  const bool points = std::all_of(placed.boxes.begin(), placed.boxes.end(), [](const Box& b) { return b.is_point(); });
  if (kept && d == 0) {
    placed.kind = model.draws_flat ? Placed::Kind::open : Placed::Kind::nothing;
  } else if (kept && unsure) {
    placed.kind = Placed::Kind::open;
  } else if (kept && culled) {
    placed.kind = Placed::Kind::nothing;
  } else if (kept) {
    placed.kind = Placed::Kind::boxes;
  } else if (model.culled == Cull::none && model.turned == Turned::as_grid && points) {
    placed.kind = !area.all_zero()   ? Placed::Kind::boxes
                  : model.draws_flat ? Placed::Kind::open
                                     : Placed::Kind::nothing;
    placed.front = area.all_positive();
  } else if (model.culled == Cull::none && model.turned == Turned::nothing && d != 0 &&
             (d > 0 ? !area.positive : !area.negative)) {
    placed.kind = Placed::Kind::nothing;
  } else {
    placed.kind = Placed::Kind::open;
  }
  if (placed.kind == Placed::Kind::boxes && model.least_area > 0 && least_area(placed.boxes) < 2 * model.least_area) {
    placed.kind = Placed::Kind::open;
  }
  if (placed.kind == Placed::Kind::boxes && !placed.front) std::swap(placed.boxes[1], placed.boxes[2]);
  return placed;
}

// R7 at one sample.
Cover answer_at(const Model& model, const Placed& placed, const Sample& sample, double certain) {
  const Owners& owners = placed.front ? model.front : model.back;
  if (model.vertices != AtVertices::as_edges) {
    const bool at_vertex = std::any_of(placed.boxes.begin(), placed.boxes.end(), [&sample](const Box& box) {
      return box.is_point() && sample.is_point() && end_of(box.x, 0) == sample.x(0) && end_of(box.y, 0) == sample.y(0);
    });
    if (at_vertex) {
      return model.vertices == AtVertices::covered       ? Cover::yes
             : model.vertices == AtVertices::not_covered ? Cover::no
                                                         : Cover::open;
    }
  }
  bool open = false;
  bool refused = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Box &p = placed.boxes[i], &q = placed.boxes[(i + 1) % 3];
    const Signs signs = signs_of_edge(p, q, sample, certain);
    if (signs.all_positive()) continue;
    if (signs.all_negative()) return Cover::no;
    if (!signs.all_zero() || !p.is_point() || !q.is_point() || !sample.is_point()) {
      open = true;
      continue;
    }
    const std::uint8_t side = bit(side_of(p, q));
    if (owners.open & side) {
      open = true;
    } else if (!(owners.owned & side)) {
      refused = true;
    }
  }
  if (refused) return Cover::no;
  return open ? Cover::open : Cover::yes;
}

// R9: near its edges all is open.
class ClippedTriangle {
 public:
  ClippedTriangle(const Model& model, int width, int height, const std::array<Vertex, 3>& t, const Placed& placed)
      : edges_(t), culled_(placed.culled), whole_(placed.whole) {
    const auto step = [](const AxisModel& axis) {
      return axis.place_within + 2 * std::max(axis.blur, axis.divided_blur) +
             (axis.bits < 0 ? 0 : std::ldexp(1.0, -axis.bits));
    };
    distance_ = kUnclear + std::max(step(model.x), step(model.y)) + lost_by_cutting(model, width, height, t);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const AxisModel& m = axis == 0 ? model.x : model.y;
      const double length = axis == 0 ? width : height;
      stretch_[axis] = length / (length - m.lacks);
      moved_[axis] = m.moved;
    }
    sign_ = sign_of_d(t);
    const auto [least, most] = std::minmax({t[0].w, t[1].w, t[2].w});
    unsure_ = edges_.is_thin() || (least > 0 && most > kMostDepth * least);
  }

  Cover at(double sx, double sy) const {
    if (unsure_) return Cover::open;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      bool positive = true, negative = true;
      for (unsigned n = 0; n < 4; ++n) {
        const double x = (sx + (n % 2 == 0 ? -distance_ : distance_) - moved_[0]) * stretch_[0];
        const double y = (sy + (n / 2 == 0 ? -distance_ : distance_) - moved_[1]) * stretch_[1];
        const long double value = static_cast<long double>(sign_) * edges_.at(i, x, y), error = edges_.error(i, x, y);
        positive = positive && value > error;
        negative = negative && value < -error;
      }
      if (negative) return Cover::no;
      inside = inside && positive;
    }
    return !inside || !(culled_ || whole_) ? Cover::open : culled_ ? Cover::no : Cover::yes;
  }
  double distance() const { return distance_; }

 private:
  Edges edges_;
  bool culled_, whole_;
  std::array<double, 2> stretch_{}, moved_{};
  double distance_ = 0;
  int sign_ = 0;
  bool unsure_ = false;
};

struct Corner {
  double x, y;
};

double turn(const Corner& a, const Corner& b, const Corner& c) {
  return edge_function(a.x, a.y, b.x, b.y, c.x, c.y);
}

// R8: the convex hull of the boxes, counter to E's sense or not; a hair is added around it.
std::vector<Corner> hull_of(const std::array<Box, 3>& boxes) {
  std::vector<Corner> points;
  for (const Box& box : boxes) {
    for (const double x : {box.x.near_low, box.x.near_high}) {
      for (const double y : {box.y.near_low, box.y.near_high}) points.push_back({x, y});
    }
  }
  std::sort(points.begin(), points.end(),
            [](const Corner& a, const Corner& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Corner> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Corner& p : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool in_hull(const std::vector<Corner>& hull, const Corner& s) {
  constexpr double kHair = 0x1p-30;
  if (hull.empty()) return false;
  double x0 = hull[0].x, x1 = x0, y0 = hull[0].y, y1 = y0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Corner &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const double length = std::abs(b.x - a.x) + std::abs(b.y - a.y);
    if (turn(a, b, s) < -kHair * (1 + length)) return false;
    x0 = std::min(x0, a.x), x1 = std::max(x1, a.x), y0 = std::min(y0, a.y), y1 = std::max(y1, a.y);
  }
  return s.x >= x0 - kHair && s.x <= x1 + kHair && s.y >= y0 - kHair && s.y <= y1 + kHair;
}

// For a sample that is not known to the point, the hull's box widened by how well it is.
bool near_hull(const std::vector<Corner>& hull, const Sample& sample) {
  const auto [left, right] = std::minmax_element(hull.begin(), hull.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(hull.begin(), hull.end(), [](auto& a, auto& b) { return a.y < b.y; });
  return sample.near_x() >= left->x - sample.within_x && sample.near_x() <= right->x + sample.within_x &&
         sample.near_y() >= top->y - sample.within_y && sample.near_y() <= bottom->y + sample.within_y;
}

// Do all vertices lie so far to one side of the target that nothing is covered or open? In double, with room to spare.
bool far_aside(const Model& model, int width, int height, const std::array<Vertex, 3>& t) {
  const auto aside = [&t](const AxisModel& axis, int length, float Vertex::*numerator) {
    const double more = 8 + 4 * std::max(axis.blur, axis.divided_blur) + axis.place_within + std::abs(axis.place);
    bool before = true, behind = true;
    for (const Vertex& v : t) {
      const double q = static_cast<double>(v.*numerator) / v.w * (length - axis.lacks) / length + axis.moved;
      before = before && q < -more;
      behind = behind && q > length + more;
    }
    return before || behind;
  };
  const bool near = std::all_of(t.begin(), t.end(), [](const Vertex& v) {
    const float band = static_cast<float>(kFarthest / 2) * v.w;
    return v.w > 0 && std::abs(v.x) < band && std::abs(v.y) < band;
  });
  return near && (aside(model.x, width, &Vertex::x) || aside(model.y, height, &Vertex::y));
}

}  // namespace

std::vector<Cover> cover(const Model& model, int width, int height, int samples,
                         const std::array<Vertex, 3>& triangle) {
  const StandardFloats standard;
  const auto pattern = static_cast<std::size_t>(samples);
  std::vector<Cover> answers(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * pattern, Cover::no);
  if (!all_finite(triangle) || far_aside(model, width, height, triangle)) return answers;
  const Placed placed = place_triangle(model, width, height, triangle);
  if (placed.kind == Placed::Kind::nothing) return answers;
  std::optional<ClippedTriangle> clipped;
  if (placed.kind == Placed::Kind::clipped) clipped.emplace(model, width, height, triangle, placed);
  // Only what lies in the box around all positions is looked at; of a triangle that has none, everything.
  double x0 = 0, y0 = 0, x1 = width, y1 = height, size = std::max(width, height);
  if (placed.kind != Placed::Kind::clipped || placed.near) {
    x0 = y0 = INFINITY, x1 = y1 = -INFINITY;
    for (const Box& box : placed.boxes) {
      x0 = std::min(x0, box.x.near_low), x1 = std::max(x1, box.x.near_high);
      y0 = std::min(y0, box.y.near_low), y1 = std::max(y1, box.y.near_high);
    }
    size = std::max({size, std::abs(x0), std::abs(x1), std::abs(y0), std::abs(y1)}) + 2;
    const double more = 2 + (clipped ? clipped->distance() : 0);
    x0 -= more, y0 -= more, x1 += more, y1 += more;
  }
  const auto pixel = [](double at, int length) {
    return static_cast<int>(std::floor(std::clamp(at, 0.0, static_cast<double>(length))));
  };
  const std::vector<Corner> hull = placed.kind == Placed::Kind::open ? hull_of(placed.boxes) : std::vector<Corner>();
  const double certain = certain_above(size);
  for (int y = pixel(y0, height); y < pixel(y1 + 1, height); ++y) {
    for (int x = pixel(x0, width); x < pixel(x1 + 1, width); ++x) {
      for (int n = 0; n < samples; ++n) {
        const Point location = sample_point(samples, n, 0, 0);
        const Point moved{location.x - kUnits / 2, location.y - kUnits / 2};
        const Sample sample{x, y, moved, model.x.place, model.y.place, model.x.place_within, model.y.place_within};
        Cover& answer =
            answers[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                        pattern +
                    static_cast<std::size_t>(n)];
        if (clipped) {
          answer = clipped->at(sample.near_x(), sample.near_y());
          continue;
        }
        if (placed.kind == Placed::Kind::open) {
          const bool in =
              in_hull(hull, {sample.near_x(), sample.near_y()}) || (!sample.is_point() && near_hull(hull, sample));
          answer = in ? Cover::open : Cover::no;
          continue;
        }
        answer = answer_at(model, placed, sample, certain);
      }
    }
  }
  return answers;
}

bool may_turn(const Model& model, int width, int height, const std::array<Vertex, 3>& triangle) {
  const StandardFloats standard;
  if (!all_finite(triangle)) return true;
  Model seen = model;
  seen.culled = Cull::none;
  seen.turned = Turned::open;
  const Placed placed = place_triangle(seen, width, height, triangle);
  return placed.kind == Placed::Kind::clipped || placed.kind == Placed::Kind::open;
}

}  // namespace surefill::oracle
