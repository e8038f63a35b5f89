// SPDX-License-Identifier: Apache-2.0
//
// Lines and points under a model: R17 to R21. A shape is a few functions of the two ends, seen from the sample, each of
// which is linear in every coordinate: so its sign at the corners of the boxes of R17 says what holds for every choice.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "oracle/coverage.hpp"
#include "oracle/exact.hpp"
#include "oracle/model.hpp"
#include "oracle/positions.hpp"

namespace surefill::oracle {

namespace {

// What is known of a sentence: that it holds, that it does not, or neither.
enum class Truth : std::uint8_t { no, yes, open };
Truth both(Truth a, Truth b) {
  if (a == Truth::no || b == Truth::no) return Truth::no;
  return a == Truth::yes && b == Truth::yes ? Truth::yes : Truth::open;
}
Truth negated(Truth a) {
  return a == Truth::open ? a : a == Truth::yes ? Truth::no : Truth::yes;
}
Truth either(Truth a, Truth b) {
  return negated(both(negated(a), negated(b)));
}
Cover cover_of(Truth t) {
  return t == Truth::yes ? Cover::yes : t == Truth::no ? Cover::no : Cover::open;
}

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

Interval whole_pixel(const Interval& q, double place) {
  Interval result;
  const Rational low = floor_of(end_of(q, 0));
  Rational high = floor_of(end_of(q, 1));
  if (sgn(end_of(q, 1)) < 0 && high != end_of(q, 1)) high += 1;  // by truncation
  result.low = low + Rational(place), result.high = high + Rational(place);
  result.near_low = result.low.get_d(), result.near_high = result.high.get_d();
  result.point = result.low == result.high;
  return result;
}

// Ends a and b seen from a sample, u along the major axis in the direction of the line and v along the other one.
template <typename Number>
struct Seen {
  Number au, av, bu, bv;
  Number cross() const { return Number(au * bv - av * bu); }
};

// A function of these, and how it changes as C3 moves the sample along u and v: c_u and c_v times the step.
struct Coefficients {
  Rational u, v;
};

struct Widths {
  double low, high;
};
Widths widths_of(const Outline& outline, double width) {
  const auto clamped = [&outline](double w) { return std::clamp(w, outline.least_width, outline.most_width); };
  const double w = clamped(width);
  return {std::max(0.0, w - outline.width_within), w + outline.width_within};
}

// One line with its major axis and direction, for all choices.
class Directed {
 public:
  // Direction 1 or -1 along the axis.
  Directed(const std::array<std::array<Interval, 2>, 2>& ends, const Model& model, bool x_major, int direction)
      : ends_(ends), model_(model), x_major_(x_major), direction_(direction) {
    const std::optional<FillRule>& ties = model.lines.outline.ties;
    if (!ties) return;
    const Step step = step_of(*ties);
    const int along = x_major ? step.x : step.y, beside = x_major ? step.y : step.x;
    step_ = Step{direction * along, beside, step.x_first == x_major};
  }

  // M7's thin line of the ends, moved by `beside` along the minor axis.
  Truth diamond(int px, int py, double beside) const {
    const View view = view_from(px, py, beside);
    Truth strip = Truth::yes;
    for (const int side : {-1, 1}) {
      strip = both(strip, positive(
                              view,
                              [side](const auto& e) {
                                using N = std::remove_cvref_t<decltype(e.au)>;
                                return N(e.bu - e.au + 2 * side * e.cross());
                              },
                              [side](const Seen<Rational>& e) {
                                return Coefficients{-2 * side * (e.bv - e.av), 2 * side * (e.bu - e.au)};
                              }));
    }
    if (strip == Truth::no) return strip;
    return both(strip, both(before_exit(view, false), negated(before_exit(view, true))));
  }

  // Lies end b, or a, in the sample's diamond?
  Truth end_inside(int px, int py, double beside, bool last) const {
    const View view = view_from(px, py, beside);
    Truth inside = Truth::yes;
    for (const int su : {-1, 1}) inside = both(inside, on_side(view, last, su));
    return inside;
  }

  // M7's line of a width.
  Truth parallelogram(int px, int py, const Widths& widths) const {
    const View view = view_from(px, py, 0);
    const double border = model_.lines.outline.border;
    Truth inside = Truth::yes;
    for (const int side : {-1, 1}) {
      const auto within = [&](double w) {
        return positive(
            view,
            [side, w](const auto& e) {
              using N = std::remove_cvref_t<decltype(e.au)>;
              return N(N(w) * (e.bu - e.au) + 2 * side * e.cross());
            },
            [side](const Seen<Rational>& e) {
              return Coefficients{-2 * side * (e.bv - e.av), 2 * side * (e.bu - e.au)};
            },
            1 + w);
      };
      const double low = widths.low - 4 * border, high = widths.high + 4 * border;
      inside = both(inside, low == high ? within(low) : between(low > 0 ? within(low) : Truth::no, within(high)));
    }
    const auto past = [&](bool last, double more) {
      return positive(
          view,
          [last, more](const auto& e) {
            using N = std::remove_cvref_t<decltype(e.au)>;
            return N((last ? e.bu : N(-e.au)) + N(more));
          },
          [last](const Seen<Rational>&) {
            return Coefficients{last ? -1 : 1, 0};
          });
    };
    for (const bool last : {false, true}) {
      inside = both(inside, border == 0 ? past(last, 0) : between(past(last, -border), past(last, border)));
    }
    return inside;
  }

 private:
  // Corners of the boxes, seen from a sample: [end][u or v][which].
  struct View {
    int px, py;
    double beside;
    std::array<std::array<std::array<long double, 2>, 2>, 2> near;
    bool point = true;
    long double certain = 0;
  };

  // What holds if the stricter of two sentences does, and not if the weaker one does not.
  static Truth between(Truth strict, Truth weak) {
    return strict == Truth::yes ? Truth::yes : weak == Truth::no ? Truth::no : Truth::open;
  }

  View view_from(int px, int py, double beside) const {
    View view{px, py, beside, {}, true, 0};
    long double size = 1;
    for (std::size_t end = 0; end < 2; ++end) {
      for (const bool along : {true, false}) {
        for (unsigned which = 0; which < 2; ++which) {
          long double& value = view.near[end][along ? 0 : 1][which];
          value = corner<long double>(view, end, along, which);
          size = std::max(size, std::abs(value));
        }
        const std::size_t axis = axis_of(along);
        view.point = view.point && ends_[end][axis].is_point() && axis_model(axis).place_within == 0;
      }
    }
    view.certain = 0x1p-46L * size * size;
    return view;
  }

  std::size_t axis_of(bool along) const { return along == x_major_ ? 0 : 1; }
  const AxisModel& axis_model(std::size_t axis) const { return axis == 0 ? model_.x : model_.y; }

  template <typename Number>
  Number corner(const View& view, std::size_t end, bool along, unsigned which) const {
    const std::size_t axis = axis_of(along);
    const bool turned = along && direction_ < 0;
    const unsigned from = turned ? 1 - which : which;
    const AxisModel& m = axis_model(axis);
    const double aside = from == 0 ? -m.place_within : m.place_within;
    Number value;
    if constexpr (std::is_same_v<Number, Rational>) {
      value = end_of(ends_[end][axis], from);
    } else {
      value = near_end(ends_[end][axis], from);
    }
    value -= axis == 0 ? view.px : view.py;
    value -= m.place;
    value += aside;
    if (turned) value = -value;
    if (!along) value += view.beside;
    return value;
  }

  // `scale`: what values are multiplied by, 1 or more.
  template <typename Of, typename Change>
  Truth positive(const View& view, const Of& of, const Change& change, double scale = 1) const {
    bool all = true, none = true;
    for (unsigned n = 0; n < (view.point ? 1u : 16u); ++n) {
      const auto& near = view.near;
      const long double about =
          of(Seen<long double>{near[0][0][n & 1], near[0][1][n >> 1 & 1], near[1][0][n >> 2 & 1], near[1][1][n >> 3]});
      int sign = about > 0 ? 1 : -1;
      if (!(std::abs(about) > view.certain * scale)) {
        const Seen<Rational> seen{corner<Rational>(view, 0, true, n & 1), corner<Rational>(view, 0, false, n >> 1 & 1),
                                  corner<Rational>(view, 1, true, n >> 2 & 1),
                                  corner<Rational>(view, 1, false, n >> 3)};
        sign = sgn(of(seen));
        if (sign == 0 && view.point && step_) {
          const Coefficients c = change(seen);
          const int u = sgn(c.u) * step_->x, v = sgn(c.v) * step_->y;
          const int first = step_->x_first ? u : v, second = step_->x_first ? v : u;
          sign = first != 0 ? first : second;
        }
      }
      all = all && sign > 0;
      none = none && sign < 0;
    }
    return all ? Truth::yes : none ? Truth::no : Truth::open;
  }

  // |v| + s u < 1/2 of an end: on this side of the two sides of the diamond that face s.
  Truth on_side(const View& view, bool last, int s) const {
    Truth inside = Truth::yes;
    for (const int side : {-1, 1}) {
      inside = both(inside, positive(
                                view,
                                [last, s, side](const auto& e) {
                                  using N = std::remove_cvref_t<decltype(e.au)>;
                                  const N &u = last ? e.bu : e.au, &v = last ? e.bv : e.av;
                                  return N(1 - 2 * s * u - 2 * side * v);
                                },
                                [s, side](const Seen<Rational>&) {
                                  return Coefficients{2 * s, 2 * side};
                                }));
    }
    return inside;
  }
  Truth before_exit(const View& view, bool last) const { return on_side(view, last, 1); }

  const std::array<std::array<Interval, 2>, 2>& ends_;  // [end][axis]
  const Model& model_;
  bool x_major_;
  int direction_;
  std::optional<Step> step_;  // x being u
};

// R17 where a vertex is not in front, or too far: how near does S come?
class NearLine {
 public:
  NearLine(const Model& model, int width, int height, const Vertex& a, const Vertex& b, double reach) : a_(a), b_(b) {
    const auto step = [](const AxisModel& axis) {
      return axis.place_within + 2 * std::max(axis.blur, axis.divided_blur) +
             (axis.bits < 0 ? 0 : std::ldexp(1.0, -axis.bits));
    };
    const double d = 1.0 / 16 + std::max(step(model.x), step(model.y));
    stretch_ = {width / (width - model.x.lacks), height / (height - model.y.lacks)};
    moved_ = {model.x.moved, model.y.moved};
    place_ = {model.x.place, model.y.place};
    reach_ = (reach + 2 + d) * std::max(stretch_[0], stretch_[1]) * (1 + 0x1p-20);
  }
  // (1 - t) a + t b is within reach, for some t of 0 to 1: four affine functions of t that are not negative.
  bool at(int px, int py) const {
    const long double x = (px + place_[0] - moved_[0]) * stretch_[0], y = (py + place_[1] - moved_[1]) * stretch_[1];
    long double low = 0, high = 1;
    for (int n = 0; n < 4; ++n) {
      const auto f = [&](const Vertex& v) {
        const long double beside = n < 2 ? v.x - x * v.w : v.y - y * v.w;
        return reach_ * static_cast<long double>(v.w) + (n % 2 == 0 ? beside : -beside);
      };
      const long double f0 = f(a_), f1 = f(b_);
      if (f0 < 0 && f1 < 0) return false;
      if (f0 < 0) low = std::max(low, f0 / (f0 - f1));
      if (f1 < 0) high = std::min(high, f0 / (f0 - f1));
    }
    return low <= high + 0x1p-50L;
  }

 private:
  Vertex a_, b_;
  std::array<double, 2> stretch_{}, moved_{}, place_{};
  long double reach_ = 0;
};

class LineAnswers {
 public:
  LineAnswers(const Model& model, int width, int height, const std::array<Vertex, 2>& ends,
              const std::optional<float>& line_width)
      : model_(model), width_(line_width.value_or(1)), widths_(widths_of(model.lines.outline, width_)) {
    shape_ = line_width ? model.lines.wide : model.lines.thin;
    if (!line_width) widths_ = {1, 1};
    bool placed = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vertex& v = ends[i];
      placed = placed && v.w > 0 && in_range_of_w(model, v) && !cut_by_depth(model, v) &&
               place_vertex(model.x, width, v.x, v.w, ends_[i][0], model.lines.blur) &&
               place_vertex(model.y, height, v.y, v.w, ends_[i][1], model.lines.blur) &&
               in_band_of(model, ends_[i][0], width) && in_band_of(model, ends_[i][1], height);
    }
    if (!placed || shape_ == LineShape::unknown) {
      near_.emplace(model, width, height, ends[0], ends[1], widths_.high / 2);
      return;
    }
    for (auto& end : ends_) {
      if (!model.lines.whole_pixels || shape_ != LineShape::diamond) break;
      end[0] = whole_pixel(end[0], model.x.place);
      end[1] = whole_pixel(end[1], model.y.place);
    }
    if (shape_ == LineShape::diamond && model.lines.left_out == LeftOut::first) std::swap(ends_[0], ends_[1]);
    aim();
  }

  // Where nothing is covered or open outside of it.
  std::array<double, 4> reach() const {
    if (near_) return {-INFINITY, -INFINITY, INFINITY, INFINITY};
    const auto low = [&](std::size_t axis) { return std::min(ends_[0][axis].near_low, ends_[1][axis].near_low); };
    const auto high = [&](std::size_t axis) { return std::max(ends_[0][axis].near_high, ends_[1][axis].near_high); };
    const double more = widths_.high + 4;
    return {low(0) - more, low(1) - more, high(0) + more, high(1) + more};
  }

  bool tolerant() const { return !near_ && shape_ == LineShape::tolerant; }

  Cover at(int px, int py) const {
    if (near_) return near_->at(px, py) ? Cover::open : Cover::no;
    if (shape_ == LineShape::rectangle) return rectangle(px, py);
    std::optional<Cover> answer;
    for (const Directed& line : lines_) {
      Cover one = Cover::no;
      if (shape_ == LineShape::parallelogram) {
        one = cover_of(line.parallelogram(px, py, widths_));
      } else {
        one = rows(line, px, py);
      }
      if (answer && *answer != one) return Cover::open;
      answer = one;
    }
    if (short_ && (answer == Cover::yes || in_reach(px, py))) return Cover::open;
    return answer.value_or(Cover::no);
  }

  // Tolerant: does an end lie in this pixel, or in one that its row or column of so many pixels comes from?
  bool has_end(int px, int py) const {
    const double beside = std::floor(std::max(1.0, std::floor(widths_.high + 0.5)) / 2);
    const auto in = [](const Interval& q, double from, double more) {
      return q.near_high >= from - more && q.near_low <= from + 1 + more;
    };
    return std::any_of(ends_.begin(), ends_.end(), [&](const auto& end) {
      const double x = px + model_.x.place - 0.5, y = py + model_.y.place - 0.5;
      return (in(end[0], x, 0) && in(end[1], y, beside)) || (in(end[0], x, beside) && in(end[1], y, 0));
    });
  }

 private:
  // The major axis and the direction, as far as they are known.
  void aim() {
    std::array<double, 2> low{}, high{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Rational least = end_of(ends_[1][axis], 0) - end_of(ends_[0][axis], 1),
                     most = end_of(ends_[1][axis], 1) - end_of(ends_[0][axis], 0);
      if (sgn(least) == 0 && sgn(most) == 0) continue;
      low[axis] = least.get_d(), high[axis] = most.get_d();
    }
    const auto least_size = [&](std::size_t a) { return low[a] > 0 ? low[a] : high[a] < 0 ? -high[a] : 0; };
    const auto most_size = [&](std::size_t a) { return std::max(-low[a], high[a]); };
    short_ = false;
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t other = 1 - axis;
      if (most_size(axis) == 0) continue;
      const bool points = is_point();
      const int compared = points ? compare_lengths() : 0;
      // R18: ends of tolerant ones may lie elsewhere, and the other axis be the major one.
      const bool either = shape_ == LineShape::tolerant && most_size(axis) + 2 >= least_size(other);
      const bool may = either   ? true
                       : points ? (axis == 0 ? compared >= 0 : compared < 0)
                                : most_size(axis) * (1 + 0x1p-40) >= least_size(other);
      if (!may) continue;
      if (low[axis] <= 0 && high[axis] >= 0) {
        short_ = true;  // it may turn either way
        continue;
      }
      lines_.emplace_back(ends_, model_, axis == 0, low[axis] > 0 ? 1 : -1);
    }
  }

  bool is_point() const {
    return ends_[0][0].is_point() && ends_[0][1].is_point() && ends_[1][0].is_point() && ends_[1][1].is_point();
  }
  // |dx| against |dy|, of points.
  int compare_lengths() const {
    const Rational dx = end_of(ends_[1][0], 0) - end_of(ends_[0][0], 0),
                   dy = end_of(ends_[1][1], 0) - end_of(ends_[0][1], 0);
    return cmp(Rational(abs(dx)), Rational(abs(dy)));
  }

  bool in_reach(int px, int py) const {
    const std::array<double, 4> box = reach();
    return px + 1 > box[0] && py + 1 > box[1] && px < box[2] && py < box[3];
  }

  // A diamond of n rows, n being the whole number next to the width.
  Cover rows(const Directed& line, int px, int py) const {
    std::optional<Cover> answer;
    const double low = std::max(1.0, std::ceil(widths_.low - 0.5)),
                 high = std::max(1.0, std::floor(widths_.high + 0.5));
    for (double n = low; n <= high; ++n) {
      Truth covered = Truth::no;
      for (double k = 0; k < n && covered != Truth::yes; ++k) {
        const double beside = k - (n - 1) / 2;
        Truth one = line.diamond(px, py, beside);
        if (model_.lines.left_out == LeftOut::none) one = either(one, line.end_inside(px, py, beside, true));
        if (model_.lines.left_out == LeftOut::both) one = both(one, negated(line.end_inside(px, py, beside, false)));
        covered = either(covered, one);
      }
      const Cover one = cover_of(covered);
      if (answer && *answer != one) return Cover::open;
      answer = one;
    }
    return *answer;
  }

  // Across and along the line in long double: what is not certain by that, or lies on a border, is open.
  Cover rectangle(int px, int py) const {
    long double u[2][2], moved = model_.lines.outline.border;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Interval& q = ends_[i][axis];
        const AxisModel& m = axis == 0 ? model_.x : model_.y;
        u[i][axis] = (static_cast<long double>(q.near_low) + q.near_high) / 2 - (axis == 0 ? px : py) - m.place;
        moved = std::max<long double>(moved, (static_cast<long double>(q.near_high) - q.near_low) / 2 + m.place_within +
                                                 model_.lines.outline.border);
      }
    }
    const long double dx = u[1][0] - u[0][0], dy = u[1][1] - u[0][1], length = std::hypot(dx, dy);
    const long double r = moved * 1.5L + 0x1p-40L, half = widths_.high / 2;
    if (length == 0 && is_point()) return Cover::no;
    if (length <= 16 * r) return std::hypot(u[0][0], u[0][1]) <= 2 * half + 64 * r + 1 ? Cover::open : Cover::no;
    const long double across = std::abs(u[0][0] * u[1][1] - u[0][1] * u[1][0]) / length;
    const long double along = -(u[0][0] * dx + u[0][1] * dy) / length;
    // Ends that are r away turn the line by this much at most, to be generous.
    const long double turn = 4 * r / length, beyond = std::max({0.0L, -along, along - length});
    const long double e_across = r * (1 + 2 * beyond / length) + across * turn * turn,
                      e_along = r + (across + r) * turn;
    if (across > half + e_across || along < -e_along || along > length + e_along) return Cover::no;
    const bool inside =
        across < static_cast<long double>(widths_.low) / 2 - e_across && along > e_along && along < length - e_along;
    return inside ? Cover::yes : Cover::open;
  }

  const Model& model_;
  double width_;
  Widths widths_;
  LineShape shape_;
  std::array<std::array<Interval, 2>, 2> ends_;  // [end][axis]
  std::vector<Directed> lines_;                  // all that it may be
  bool short_ = false;
  std::optional<NearLine> near_;
};

// The pixels of the target between two places.
struct Pixels {
  int x0, y0, x1, y1;
};
Pixels pixels_within(const std::array<double, 4>& box, int width, int height) {
  const auto pixel = [](double at, int length) {
    return static_cast<int>(std::floor(std::clamp(at, 0.0, static_cast<double>(length))));
  };
  return {pixel(box[0], width), pixel(box[1], height), pixel(box[2] + 1, width), pixel(box[3] + 1, height)};
}

}  // namespace

std::vector<Cover> cover_line(const Model& model, int width, int height, const std::array<Vertex, 2>& ends,
                              std::optional<float> line_width) {
  const StandardFloats standard;
  std::vector<Cover> answers(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Cover::no);
  if (!finite(ends[0]) || !finite(ends[1])) return answers;
  const LineAnswers line(model, width, height, ends, line_width);
  const Pixels in = pixels_within(line.reach(), width, height);
  const auto at = [&](int x, int y) -> Cover& {
    return answers[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  if (!line.tolerant()) {
    for (int y = in.y0; y < in.y1; ++y) {
      for (int x = in.x0; x < in.x1; ++x) at(x, y) = line.at(x, y);
    }
    return answers;
  }
  for (int y = in.y0 - 1; y <= in.y1; ++y) {
    for (int x = in.x0 - 1; x <= in.x1; ++x) {
      if (line.at(x, y) == Cover::no && !line.has_end(x, y)) continue;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) at(i, j) = Cover::open;
      }
    }
  }
  return answers;
}

std::vector<Cover> cover_point(const Model& model, int width, int height, const Vertex& vertex, float size) {
  const StandardFloats standard;
  std::vector<Cover> answers(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Cover::no);
  if (!finite(vertex) || !(vertex.w > 0)) return answers;
  const Outline& outline = model.points.outline;
  const Widths sizes = widths_of(outline, size);
  std::array<Interval, 2> at;
  const bool placed = vertex.w >= model.least_w && vertex.w <= model.most_w &&
                      place_vertex(model.x, width, vertex.x, vertex.w, at[0], model.points.blur) &&
                      place_vertex(model.y, height, vertex.y, vertex.w, at[1], model.points.blur);
  const double x = static_cast<double>(vertex.x) / vertex.w, y = static_cast<double>(vertex.y) / vertex.w;
  const bool beside = !(x >= 0 && y >= 0 && x <= width && y <= height);
  const NearLine near(model, width, height, vertex, vertex, sizes.high / 2);
  const std::optional<Step> step = outline.ties ? std::optional(step_of(*outline.ties)) : std::nullopt;
  // |q - s| < size / 2 on one axis.
  const auto along = [&](std::size_t axis, int pixel) {
    const AxisModel& m = axis == 0 ? model.x : model.y;
    const Rational sample = Rational(pixel) + Rational(m.place);
    const Rational low = end_of(at[axis], 0) - sample - Rational(m.place_within) - Rational(outline.border),
                   high = end_of(at[axis], 1) - sample + Rational(m.place_within) + Rational(outline.border);
    Truth inside = Truth::yes;
    for (const int side : {-1, 1}) {
      // The least and the largest of size / 2 + side (q - s).
      const Rational least = Rational(sizes.low) / 2 + side * (side > 0 ? low : high),
                     most = Rational(sizes.high) / 2 + side * (side > 0 ? high : low);
      Truth one = sgn(least) > 0 ? Truth::yes : sgn(most) < 0 ? Truth::no : Truth::open;
      if (least == most && sgn(least) == 0 && step) {
        one = -side * (axis == 0 ? step->x : step->y) > 0 ? Truth::yes : Truth::no;
      }
      inside = both(inside, one);
    }
    return inside;
  };
  const double reach = sizes.high + 6;
  const Pixels in = placed ? pixels_within({at[0].near_low - reach, at[1].near_low - reach, at[0].near_high + reach,
                                            at[1].near_high + reach},
                                           width, height)
                           : Pixels{0, 0, width, height};
  for (int j = in.y0; j < in.y1; ++j) {
    for (int i = in.x0; i < in.x1; ++i) {
      Cover& answer =
          answers[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
      if (!placed || (beside && model.points.clipped_whole) || !model.points.known) {
        answer = near.at(i, j) ? Cover::open : Cover::no;
      } else {
        answer = cover_of(both(along(0, i), along(1, j)));
      }
    }
  }
  return answers;
}

}  // namespace surefill::oracle
