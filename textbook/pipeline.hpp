// SPDX-License-Identifier: Apache-2.0
//
// The traditional pipeline: whole objects and back faces culled, polygons clipped to the view volume (or a guard band)
// before the division by W, and screen-space rasterization of what is left. Formulas over a type of number: in exact
// rationals the image is that of the engine, which never clips; in float it differs along what was cut.
//
// Sources: I. Sutherland and G. Hodgman, Reentrant Polygon Clipping, 1974; J. Blinn and M. Newell, Clipping Using
// Homogeneous Coordinates, 1978.
#ifndef SUREFILL_TEXTBOOK_PIPELINE_HPP
#define SUREFILL_TEXTBOOK_PIPELINE_HPP

#include <array>
#include <span>
#include <vector>

#include "engine/src/exact/edge.hpp"

namespace surefill::textbook {

// a X + b Y + c Z + d W >= 0
template <class Number>
struct ClipPlane {
  Number a, b, c, d;
};

template <class Number>
struct ClipCorner {
  Number x, y, z, w;
  bool cut = false;  // the side from here to the next corner was made by clipping; it owns the samples on it
};

template <class Number>
using Polygon = std::vector<ClipCorner<Number>>;

template <class Number>
Number height(const ClipPlane<Number>& plane, const ClipCorner<Number>& p) {
  return plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d * p.w;
}

// Sutherland and Hodgman, for one plane.
template <class Number>
Polygon<Number> clip(const Polygon<Number>& polygon, const ClipPlane<Number>& plane) {
  Polygon<Number> kept;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const ClipCorner<Number>&p = polygon[n], &q = polygon[(n + 1) % polygon.size()];
    const Number hp = height(plane, p), hq = height(plane, q);
    if (hp >= 0) {
      kept.push_back(p);
      if (hp == 0 && hq < 0) kept.back().cut = true;
    }
    if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) {
      const Number t = hp / (hp - hq);
      ClipCorner<Number> cut = p;
      cut.x += t * (q.x - p.x);
      cut.y += t * (q.y - p.y);
      cut.z += t * (q.z - p.z);
      cut.w += t * (q.w - p.w);
      cut.cut = hp > 0 || p.cut;
      kept.push_back(cut);
    }
  }
  return kept;
}

// The sides of the target moved out by `margin` pixels, and the near and far planes.
template <class Number>
std::vector<ClipPlane<Number>> side_planes(int width, int height, int margin) {
  return {{Number(1), Number(0), Number(0), Number(margin)},
          {Number(-1), Number(0), Number(0), Number(width + margin)},
          {Number(0), Number(1), Number(0), Number(margin)},
          {Number(0), Number(-1), Number(0), Number(height + margin)}};
}
template <class Number>
std::vector<ClipPlane<Number>> depth_planes() {
  return {{Number(0), Number(0), Number(1), Number(0)}, {Number(0), Number(0), Number(-1), Number(1)}};
}

template <class Number>
Polygon<Number> polygon_of(const std::array<Vertex, 3>& v) {
  Polygon<Number> polygon;
  for (const Vertex& m : v) polygon.push_back({Number(m.x), Number(m.y), Number(m.z), Number(m.w)});
  return polygon;
}

// Frustum culling: are all corners of an object's box outside one plane?
template <class Number>
bool outside(std::span<const ClipCorner<Number>> box, std::span<const ClipPlane<Number>> planes) {
  for (const ClipPlane<Number>& plane : planes) {
    bool all = true;
    for (const ClipCorner<Number>& corner : box) all = all && height(plane, corner) < 0;
    if (all) return true;
  }
  return false;
}

inline constexpr int kGuardMargin = 64;  // pixels; a real guard band is as wide as the rasterizer's integers allow

enum class ClipTo { view_volume, guard_band };

// What is left of a triangle. A guard band costs clipping only for triangles that leave it; the rest of the view
// volume's sides is the scissor's work. Every W of the result is positive unless D = 0.
template <class Number>
Polygon<Number> clipped(const std::array<Vertex, 3>& v, int width, int height_in_pixels, ClipTo to, bool depth) {
  Polygon<Number> polygon = polygon_of<Number>(v);
  if (depth) {
    for (const ClipPlane<Number>& plane : depth_planes<Number>()) polygon = clip(polygon, plane);
  }
  const int margin = to == ClipTo::guard_band ? kGuardMargin : 0;
  for (const ClipPlane<Number>& plane : side_planes<Number>(width, height_in_pixels, margin)) {
    bool all_inside = true;
    for (const ClipCorner<Number>& corner : polygon) all_inside = all_inside && height(plane, corner) >= 0;
    if (!all_inside) polygon = clip(polygon, plane);
  }
  return polygon;
}

// A convex polygon on the screen, after the division: its sides as edge functions a x + b y + c.
template <class Number>
class ScreenPolygon {
 public:
  struct Side {
    Number x, y;  // where it begins
    Number a, b, c;
    bool cut;
  };

  explicit ScreenPolygon(const Polygon<Number>& polygon) {
    for (const ClipCorner<Number>& corner : polygon) {
      sides_.push_back({corner.x / corner.w, corner.y / corner.w, Number(0), Number(0), Number(0), corner.cut});
    }
    Number area(0);
    for (std::size_t n = 0; n < sides_.size(); ++n) {
      Side& j = sides_[n];
      const Side& k = sides_[(n + 1) % sides_.size()];
      j.a = j.y - k.y;
      j.b = k.x - j.x;
      j.c = j.x * k.y - k.x * j.y;
      area += j.c;
    }
    facing_ = area > 0 ? 1 : area < 0 ? -1 : 0;
  }

  // The sign of the area: back-face and degenerate culling.
  int facing() const { return facing_; }
  const std::vector<Side>& sides() const { return sides_; }

  // The closed polygon.
  bool contains(const Number& px, const Number& py) const {
    for (const Side& side : sides_) {
      const Number e = side.a * px + side.b * py + side.c;
      if (facing_ > 0 ? e < 0 : e > 0) return false;
    }
    return facing_ != 0;
  }

  // Ties on sides of the triangle by C3; sides made by clipping own their samples, so that what I5 keeps is kept. (But
  // for samples on an edge with z exactly 0 or 1: the edge that decides may be what was clipped away.)
  bool covers(const Number& px, const Number& py, TieShift shift) const {
    if (facing_ == 0) return false;
    for (const Side& side : sides_) {
      const Number e = side.a * px + side.b * py + side.c;
      const int sign = e > 0 ? facing_ : e < 0 ? -facing_ : 0;
      if (sign < 0) return false;
      if (sign > 0 || side.cut) continue;
      const int along_x = (side.a > 0) - (side.a < 0), along_y = (side.b > 0) - (side.b < 0);
      if (tie_sign(along_x, along_y, shift) * facing_ < 0) return false;  // 0: a side of no length
    }
    return true;
  }

 private:
  std::vector<Side> sides_;
  int facing_ = 0;
};

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_PIPELINE_HPP
