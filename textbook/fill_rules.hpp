// SPDX-License-Identifier: Apache-2.0
//
// Who owns a sample on an edge: the formulations of the textbooks, each by its own means, to be held against C3.
// For triangles with all W > 0 unless said otherwise.
//
// Sources: Direct3D 11 functional specification, 3.4.1.1 (top-left rule); M. McCool et al., 2001 (shadowed edges); W.
// R. Franklin, PNPOLY, 1970 (counting crossings).
#ifndef SUREFILL_TEXTBOOK_FILL_RULES_HPP
#define SUREFILL_TEXTBOOK_FILL_RULES_HPP

#include <array>

#include "textbook/traversal.hpp"

namespace surefill::textbook {

// Sign of p/pw - q/qw for positive pw, qw.
inline int compare(float p, float pw, float q, float qw) {
  const double left = static_cast<double>(p) * qw, right = static_cast<double>(q) * pw;  // exact: 48 bits
  return left > right ? 1 : left < right ? -1 : 0;
}

// Direct3D's words, for the edge from j to k of a triangle that is clockwise on the screen: a left edge goes up, a top
// edge is horizontal and goes to the right.
inline bool is_top_left_edge(const Vertex& j, const Vertex& k) {
  const int up = compare(j.y, j.w, k.y, k.w);
  return up > 0 || (up == 0 && compare(k.x, k.w, j.x, j.w) > 0);
}

// Covered by the top-left rule as its text has it: inside all edges; on an edge, it must be a top or left one.
inline bool covers_top_left(const Triangle& triangle, SamplePosition p) {
  for (int i = 0; i < 3; ++i) {
    const EdgeFunction& e = triangle.edge(i);
    const bool clockwise = triangle.determinant() > 0;
    const int sign = e.sign(p) * triangle.determinant();
    if (sign < 0) return false;
    if (sign == 0 && !(clockwise ? is_top_left_edge(e.from, e.to) : is_top_left_edge(e.to, e.from))) return false;
  }
  return true;
}

// Shadowed edges: a parallel light falls on the triangle along (dx, dy); an edge that the light enters by is lit and
// owns its samples, one that it leaves by lies in shadow. An edge along the light counts as under a light turned by 90
// degrees clockwise. Any direction of small integers other than (0, 0) gives a rule under which neighbours share
// nothing and lose nothing; (1, 0) is top_left and (0, 1) is southwards_west. Any W.
struct Light {
  int dx, dy;
};

inline bool is_lit(const EdgeFunction& e, int determinant_sign, Light light) {
  const auto along = [&e](int dx, int dy) {
    const double jx = e.from.x, jy = e.from.y, jw = e.from.w, kx = e.to.x, ky = e.to.y, kw = e.to.w;
    Expansion<8> sum;  // a dx + b dy
    sum.add_product(jy * kw, dx);
    sum.add_product(-(jw * ky), dx);
    sum.add_product(jw * kx, dy);
    sum.add_product(-(jx * kw), dy);
    return sum.sign();
  };
  const int sign = along(light.dx, light.dy);
  return (sign != 0 ? sign : along(-light.dy, light.dx)) * determinant_sign > 0;
}

inline bool covers_by_light(const Triangle& triangle, SamplePosition p, Light light) {
  for (int i = 0; i < 3; ++i) {
    const int sign = triangle.edge(i).sign(p) * triangle.determinant();
    if (sign < 0 || (sign == 0 && !is_lit(triangle.edge(i), triangle.determinant(), light))) return false;
  }
  return true;
}

// One direction for vertices: count the edges that a ray from the sample crosses, and take the vertices that the ray
// runs through as lying to one side of it. Odd: covered. `downwards`: the ray goes down, and vertices right below the
// sample count as to the west of it, so a sample on a vertex belongs to the triangle south and then east of it (C3's
// southwards). Otherwise the ray goes to the right, vertices beside the sample count as north of it: the top-left rule.
inline bool covers_by_crossings(const std::array<Vertex, 3>& v, SamplePosition p, bool downwards) {
  const auto px = static_cast<float>(p.x), py = static_cast<float>(p.y);  // exact: at most 18 bits
  bool odd = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex &j = v[i], &k = v[(i + 1) % 3];
    const int side_j = downwards ? compare(j.x, j.w, px, 1) : compare(j.y, j.w, py, 1);
    const int side_k = downwards ? compare(k.x, k.w, px, 1) : compare(k.y, k.w, py, 1);
    if ((side_j > 0) == (side_k > 0)) continue;
    // The ray crosses if the sample lies strictly before the edge: E = a px + b py + c, seen along the ray.
    const EdgeFunction e(j, k);
    const int before = e.sign(p) * (downwards ? sign_of(e.b) : sign_of(e.a));
    if (before < 0) odd = !odd;
  }
  return odd;
}

// The grid of samples moved, so that no sample meets an edge and no rule is needed: for vertices at multiples of
// 2^-bits in [-2^15, 2^15], W = 1, and samples at such multiples. There E_i is a multiple of u^2, a_i and b_i of u =
// 2^-bits, and both are below 2^17. A step of (s, s t) with s = u^2 2^-18 and t = u 2^-18 changes E_i by less than u^2,
// and b_i s t is less than u s: C3's infinitely small step, made finite. Exact in double for bits <= 2 and samples
// below 2^10.
inline SamplePosition moved_sample(SamplePosition p, int bits) {
  const double s = std::ldexp(1.0, -(2 * bits + 18)), t = std::ldexp(1.0, -(bits + 18));
  return {p.x + s, p.y + s * t};
}

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_FILL_RULES_HPP
