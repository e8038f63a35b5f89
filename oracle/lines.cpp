// SPDX-License-Identifier: Apache-2.0
#include "oracle/lines.hpp"

#include <algorithm>

namespace surefill::oracle {

namespace {

// A width as numerator 2^exponent.
struct Width {
  explicit Width(float width) : exponent(odd_exponent(width)), numerator(scaled_integer(width, exponent)) {}
  int exponent;
  Integer numerator;
};

// f times the width, and g, both times the power of two that makes the width an integer.
Integer scaled_by(const Width& width, const Integer& f) {
  Integer result = f * width.numerator;
  if (width.exponent > 0) result <<= static_cast<mp_bitcnt_t>(width.exponent);
  return result;
}
Integer unscaled(const Width& width, const Integer& g) {
  Integer result = g;
  if (width.exponent < 0) result <<= static_cast<mp_bitcnt_t>(-width.exponent);
  return result;
}

// Is it negative at the four corners, and so on all of the rectangle?
bool negative_on(const Affine& f, const Rect& rect) {
  for (int n = 0; n < 4; ++n) {
    if (f.at(rect.corner(n)) >= 0) return false;
  }
  return true;
}

// f along an axis: the function factor (coordinate) + constant.
Affine along(bool x, const Integer& factor, const Integer& constant) {
  return x ? Affine{factor, 0, constant} : Affine{0, factor, constant};
}

}  // namespace

int Affine::sign(Point p, const Step& step) const {
  const int here = sgn(at(p)), along_x = sgn(a) * step.x, along_y = sgn(b) * step.y;
  if (here != 0) return here;
  const int first = step.x_first ? along_x : along_y, second = step.x_first ? along_y : along_x;
  if (first != 0) return first;
  return second != 0 ? second : sgn(c);
}

// |16 W px - 16 X| < 8 s W for px in 1/16 pixels, the same in y.
Square::Square(const IntegerVertex& vertex, float side, FillRule rule) : vertex_(vertex), step_(step_of(rule)) {
  const Width width(side);
  const Integer half = scaled_by(width, 8 * vertex.w), w = unscaled(width, vertex.w);
  for (const bool x : {true, false}) {
    const Integer centre = 16 * unscaled(width, x ? vertex.x : vertex.y);
    sides_[x ? 0 : 2] = along(x, w, half - centre);
    sides_[x ? 1 : 3] = along(x, -w, half + centre);
  }
}

bool Square::covers(Point p) const {
  return std::ranges::all_of(sides_, [&](const Affine& side) { return side.sign(p, step_) > 0; });
}

bool Square::misses(const Rect& rect) const {
  return std::ranges::any_of(sides_, [&](const Affine& side) { return negative_on(side, rect); });
}

std::optional<Line> Line::make(const IntegerVertex& m0, const IntegerVertex& m1, std::optional<float> width,
                               FillRule rule) {
  const Integer a = m0.y * m1.w - m0.w * m1.y, b = m0.w * m1.x - m0.x * m1.w, c = m0.x * m1.y - m0.y * m1.x;
  if ((m0.w <= 0 && m1.w <= 0) || (a == 0 && b == 0)) return std::nullopt;
  Line line;
  line.m_ = {m0, m1};
  line.step_ = step_of(rule);
  line.thin_ = !width;

  const bool x_major = abs(b) >= abs(a);
  const Width strip(width.value_or(1));
  const Integer half = scaled_by(strip, 8 * (x_major ? abs(b) : abs(a)));
  const Affine distance{unscaled(strip, a), unscaled(strip, b), 16 * unscaled(strip, c)};
  line.sides_ = {Affine{distance.a, distance.b, half + distance.c}, {-distance.a, -distance.b, half - distance.c}};

  const int forwards = x_major ? sgn(b) : -sgn(a);
  for (std::size_t i = 0; i < 2; ++i) {
    const IntegerVertex& m = line.m_[i];
    const Integer &major = x_major ? m.x : m.y, &minor = x_major ? m.y : m.x;
    line.past_[i] = along(x_major, forwards * m.w, -forwards * 16 * major);
    for (const int side : {0, 1}) {
      const int beside = side == 0 ? -1 : 1;
      const Affine other = along(!x_major, beside * m.w, -beside * 16 * minor);
      Affine& sum = line.past_and_beside_[i][static_cast<std::size_t>(side)];
      sum = {line.past_[i].a + other.a, line.past_[i].b + other.b, line.past_[i].c + other.c};
    }
  }
  return line;
}

// The diamond |x - px'| + |y - py'| < 1/2. A line through it leaves it at one of the two sides that lie ahead of p' along
// the major axis: where u (x - px') + |y - py'| = 1/2, if x is that axis and u the sign of the direction along it. (If
// |dx| = |dy| one of the two is parallel to the line, which never reaches it.) The vertex lies before the exit if this
// is less than 1/2 at it, past it if it is more: 16 W times, -past - beside against 8 W. The line as a whole meets the
// diamond if |L(p')| < max(|a|, |b|) / 2.
bool Line::starts_before_exit(Point p) const {
  if (m_[0].w <= 0) return true;
  return std::ranges::all_of(past_and_beside_[0], [&](Affine f) {
    f.c += 8 * m_[0].w;
    return f.sign(p, step_) > 0;
  });
}

bool Line::ends_past_exit(Point p) const {
  if (m_[1].w <= 0) return true;
  return std::ranges::any_of(past_and_beside_[1], [&](Affine f) {
    f.c += 8 * m_[1].w;
    return f.sign(p, step_) < 0;
  });
}

bool Line::covers(Point p) const {
  for (const Affine& side : sides_) {
    if (side.sign(p, step_) < 0) return false;
  }
  if (thin_) return starts_before_exit(p) && ends_past_exit(p);
  return (m_[0].w <= 0 || past_[0].sign(p, step_) > 0) && (m_[1].w <= 0 || past_[1].sign(p, step_) < 0);
}

bool Line::misses(const Rect& rect) const {
  for (const Affine& side : sides_) {
    if (negative_on(side, rect)) return true;
  }
  const int reach = thin_ ? 8 : 0;  // a diamond's
  for (std::size_t i = 0; i < 2; ++i) {
    if (m_[i].w <= 0) continue;
    Affine inside = past_[i];
    if (i == 1) inside = {-inside.a, -inside.b, -inside.c};
    inside.c += reach * m_[i].w;
    if (negative_on(inside, rect)) return true;
  }
  return false;
}

// k_0 T_0 + k_1 T_1 = t and k_0 W_0 + k_1 W_1 = 1, for the major coordinate T, by Cramer's rule: k_1 is how far p is past
// vertex 0, k_0 how far vertex 1 is past p, over |T_1 W_0 - T_0 W_1|. Where k_1 < 0, p is before the vertex 0, if S ends
// there; where k_0 < 0 past the vertex 1.
void Line::weights_at(Point p, Integer& w0, Integer& w1) const {
  w0 = -past_[1].at(p);
  w1 = past_[0].at(p);
  if (m_[0].w > 0 && w1 < 0) {
    w0 = 1, w1 = 0;
  } else if (m_[1].w > 0 && w0 < 0) {
    w0 = 0, w1 = 1;
  }
}

}  // namespace surefill::oracle
