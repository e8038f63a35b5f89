// SPDX-License-Identifier: Apache-2.0
//
// Points and lines (M7): which samples they cover, by exact signs alone. Vertices are finite. Nothing is divided, so
// lines that reach behind the eye need no clipping.
//
// Sources: OpenGL 4.6, 14.4 and 14.5 (square points, diamond exit, wide lines along the minor axis).
#ifndef SUREFILL_TEXTBOOK_POINTS_LINES_HPP
#define SUREFILL_TEXTBOOK_POINTS_LINES_HPP

#include "engine/src/exact/edge.hpp"

namespace surefill::textbook {

// The sign of x - c / w at the perturbed sample, for one axis; w > 0. `shift` is the fill rule's along that axis.
inline int side_of(double x, float c, float w, double offset, int shift) {
  Expansion<6> difference;  // (x - offset) w - c
  difference.add_product(x, w);
  difference.add_product(-offset, w);
  difference.add(-static_cast<double>(c));
  return difference.sign() != 0 ? difference.sign() : shift;
}

// A square of this size around the vertex.
inline bool point_covers(const Vertex& v, float size, SamplePosition p, FillRule rule) {
  if (!(v.w > 0)) return false;
  const TieShift shift = tie_shift(rule);
  const double half = size / 2.0;
  return side_of(p.x, v.x, v.w, -half, shift.x) > 0 && side_of(p.x, v.x, v.w, half, shift.x) < 0 &&
         side_of(p.y, v.y, v.w, -half, shift.y) > 0 && side_of(p.y, v.y, v.w, half, shift.y) < 0;
}

class Line {
 public:
  Line(const Vertex& from, const Vertex& to, FillRule rule)
      : v0_(from), v1_(to), edge_(from, to), shift_(tie_shift(rule)) {}

  // One pixel wide: the line enters or starts in the open diamond |x - px| + |y - py| < 1/2 of the perturbed sample,
  // and leaves it.
  bool exits_diamond(SamplePosition p) const {
    if (!is_visible() || !crosses_diamond(p)) return false;
    // The chord in the diamond lies ahead of an end that is outside if the distance to a side that is violated there
    // falls along the line.
    if (v1_.w > 0) {
      const int towards = chord_from(v1_, p);
      if (towards >= 0) return false;  // ends in the diamond, or before it
    }
    return !(v0_.w > 0) || chord_from(v0_, p) >= 0;
  }

  // A parallelogram: `width` along the minor axis, cut off along it at the ends.
  bool covers_wide(float width, SamplePosition p) const {
    if (!is_visible()) return false;
    const bool x_major = direction_sign(1, 1) * direction_sign(1, -1) >= 0;
    const double half = width / 2.0;
    const int above = moved_sign(p, x_major ? 0 : half, x_major ? half : 0),
              below = moved_sign(p, x_major ? 0 : -half, x_major ? -half : 0);
    if (above == below) return false;
    const int along = x_major ? direction_sign(1, 0) : direction_sign(0, 1);
    if (v0_.w > 0 && end_side(v0_, p, x_major) != along) return false;
    return !(v1_.w > 0) || end_side(v1_, p, x_major) == -along;
  }

 private:
  // Two different points of the screen, one of them in front of the eye.
  bool is_visible() const { return (v0_.w > 0 || v1_.w > 0) && (edge_.a != 0 || edge_.b != 0); }

  // The sign of sx dx + sy dy, where the screen direction of the line is that of (dx, dy) = (X1 W0 - X0 W1, Y1 W0 - Y0
  // W1).
  int direction_sign(int sx, int sy) const {
    const double x0 = v0_.x, y0 = v0_.y, w0 = v0_.w, x1 = v1_.x, y1 = v1_.y, w1 = v1_.w;
    Expansion<8> sum;
    sum.add_product(x1 * w0, sx);
    sum.add_product(-(x0 * w1), sx);
    sum.add_product(y1 * w0, sy);
    sum.add_product(-(y0 * w1), sy);
    return sum.sign();
  }

  // The sign of E at p + (dx, dy), perturbed.
  int moved_sign(SamplePosition p, double dx, double dy) const {
    const double jx = v0_.x, jy = v0_.y, jw = v0_.w, kx = v1_.x, ky = v1_.y, kw = v1_.w;
    Expansion<18> sum;
    const Expansion<10> at_p = edge_.exact_value(p);
    for (int i = 0; i < at_p.size(); ++i) sum.add(at_p.term(i));
    sum.add_product(jy * kw, dx);
    sum.add_product(-(jw * ky), dx);
    sum.add_product(jw * kx, dy);
    sum.add_product(-(jx * kw), dy);
    return sum.sign() != 0 ? sum.sign() : tie_sign(edge_.a, edge_.b, shift_);
  }

  // Does the infinite line meet the open diamond: do its corners lie on both sides?
  bool crosses_diamond(SamplePosition p) const {
    const int right = moved_sign(p, 0.5, 0), left = moved_sign(p, -0.5, 0), below = moved_sign(p, 0, 0.5),
              above = moved_sign(p, 0, -0.5);
    return right != left || below != above || right != below;
  }

  // Where the chord lies as seen from the end v (W > 0): 0 if v is in the diamond, +1 ahead along the line, -1 behind.
  int chord_from(const Vertex& v, SamplePosition p) const {
    for (int sx = -1; sx <= 1; sx += 2) {
      for (int sy = -1; sy <= 1; sy += 2) {
        // A side of the diamond: sx (x - px) + sy (y - py) < 1/2, times W.
        Expansion<8> beyond;
        beyond.add(sx * static_cast<double>(v.x));
        beyond.add(sy * static_cast<double>(v.y));
        beyond.add_product(-sx * p.x, v.w);
        beyond.add_product(-sy * p.y, v.w);
        beyond.add(-0.5 * static_cast<double>(v.w));
        const int step = shift_.y_dominates ? sy * shift_.y : sx * shift_.x;  // the sample moves that way
        const int sign = beyond.sign() != 0 ? beyond.sign() : -step;
        if (sign > 0) return -direction_sign(sx, sy);
      }
    }
    return 0;
  }

  // The perturbed sample against the end v along the major axis.
  int end_side(const Vertex& v, SamplePosition p, bool x_major) const {
    return x_major ? side_of(p.x, v.x, v.w, 0, shift_.x) : side_of(p.y, v.y, v.w, 0, shift_.y);
  }

  Vertex v0_, v1_;
  EdgeFunction edge_;
  TieShift shift_;
};

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_POINTS_LINES_HPP
