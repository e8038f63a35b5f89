// SPDX-License-Identifier: Apache-2.0
//
// Conservative rasterization (M4, M4a, M4b): whether the closed square of a pixel meets, shares an area with, or lies in
// the closed set T of all real points where no E_i / D is negative. Needs no arithmetic beyond the signs of the E_i at
// the square's corners, but for degenerate triangles.
#ifndef SUREFILL_SRC_CONSERVATIVE_HPP
#define SUREFILL_SRC_CONSERVATIVE_HPP

#include <algorithm>
#include <utility>

#include "triangle.hpp"

namespace surefill {

// The closed square of pixel (x, y) against a triangle with D != 0.
class PixelSquare {
 public:
  PixelSquare(const Triangle& triangle, int x, int y, Rungs* rungs = nullptr) : triangle_(triangle), x_(x), y_(y) {
    const double left = x, right = x + 1, top = y, bottom = y + 1;
    const SamplePosition corner[4] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < 4; ++c) {
        sign_[i][c] = triangle.edge(i).sign(corner[c], rungs) * triangle.determinant();
      }
    }
  }

  // Inner: T is convex, so its corners decide.
  bool inside() const {
    for (const auto& of_edge : sign_) {
      for (const int sign : of_edge) {
        if (sign < 0) return false;
      }
    }
    return true;
  }

  // Overlap, where some W_i > 0. Helly's theorem again, for the open square and the open half-planes {E_i / D > 0}, which
  // have a common point: near a vertex in front of the eye.
  bool overlapped() const { return pair_overlaps(0, 1) && pair_overlaps(1, 2) && pair_overlaps(2, 0); }

  // Over, where some W_i > 0; where none is, T is empty, and otherwise it is not (a vertex in front of the eye projects
  // into it). Helly's theorem in the plane: the square and the half-planes H_i = {E_i / D >= 0} have a common point if
  // any three of these four convex sets have one. The three half-planes do.
  bool touched() const { return pair_meets(0, 1) && pair_meets(1, 2) && pair_meets(2, 0); }

 private:
  // Do H_i, H_j and the square meet, j = i + 1 modulo 3? Two half-planes that meet do so in an unbounded set, so if
  // they meet the square, they do on one of its sides. If no corner lies in both, that means: one end of the side lies
  // in H_i alone, the other in H_j alone, and the point between them where E_i = 0 lies in H_j.
  bool pair_meets(int i, int j) const {
    for (int c = 0; c < 4; ++c) {
      if (sign_[i][c] >= 0 && sign_[j][c] >= 0) return true;
    }
    for (int side = 0; side < 4; ++side) {
      if (crossing_is_inside(i, side)) return true;
    }
    return false;
  }

  // Do the interiors of H_i, H_j and the square have a common point, j = i + 1 modulo 3? The wedge of both half-planes is
  // open and unbounded, so if it meets the open square, it meets its border too, and there whole stretches of a side;
  // and where it meets the border, it meets the square. Along a side E_i and E_j are linear: if no corner lies in both
  // interiors, one end of the side lies in one of them and the other end in the other. At a corner where E_i = 0 and E_j
  // > 0 next to one with E_i > 0, the stretch begins at once; otherwise it ends where E_i = 0, and E_j must be positive
  // there.
  bool pair_overlaps(int i, int j) const {
    for (int c = 0; c < 4; ++c) {
      if (sign_[i][c] > 0 && sign_[j][c] > 0) return true;
    }
    for (int side = 0; side < 4; ++side) {
      const int p = side, q = (side + 1) % 4;
      for (const auto& [here, next] : {std::pair(p, q), std::pair(q, p)}) {
        if (sign_[i][here] == 0 && sign_[j][here] > 0 && sign_[i][next] > 0) return true;
        if (sign_[j][here] == 0 && sign_[i][here] > 0 && sign_[j][next] > 0) return true;
      }
      if (crossing_side(i, side) > 0) return true;
    }
    return false;
  }

  // Does line i cross the side from corner p to corner q between them, at a point of H_j, j = i + 1 and k = i + 2?
  //
  // The point is |E_i(q)| p + |E_i(p)| q. E_i has opposite signs at p and q, so the value of E_j there is the sign of
  // E_i(p) times E_i(p) E_j(q) - E_i(q) E_j(p), up to a positive factor. That difference is D m_k . (p x q), because
  // (m_j x m_k) x (m_k x m_i) = D m_k. So E_j / D has the sign of E_i(p) m_k . (p x q).
  bool crossing_is_inside(int i, int side) const { return crosses(i, side) && crossing_side(i, side) >= 0; }

  bool crosses(int i, int side) const { return sign_[i][side] * sign_[i][(side + 1) % 4] < 0; }

  // The sign of E_j / D where line i crosses the side; 0 too if it does not.
  int crossing_side(int i, int side) const {
    return crosses(i, side) ? sign_[i][side] * triangle_.determinant() * vertex_side((i + 2) % 3, side) : 0;
  }

  // The sign of m_k . (p x q) for the corners p and q of a side: W_k times the distance of vertex k from the side's
  // line, inwards. Both sides of each comparison are exact: 24 bits, and 24 by 23 bits.
  int vertex_side(int k, int side) const {
    const Vertex& v = triangle_.vertex(k);
    const double x = v.x, y = v.y, w = v.w;
    switch (side) {
      case 0:
        return sign_of_difference(y, y_ * w);
      case 1:
        return sign_of_difference((x_ + 1) * w, x);
      case 2:
        return sign_of_difference((y_ + 1) * w, y);
      default:
        return sign_of_difference(x, x_ * w);
    }
  }

  static int sign_of_difference(double a, double b) { return a > b ? 1 : a < b ? -1 : 0; }

  const Triangle& triangle_;
  double x_, y_;
  int sign_[3][4];  // of E_i / D at the corners: top left, top right, bottom right, bottom left
};

// M4b for D = 0: does the S (M7) of an edge of the triangle, a single point too, meet the closed square of pixel (x, y)?
//
// A point l_0 m_0 + l_1 m_1 in front of the eye lies in the square if none of the four linear functions X - x W, (x + 1)
// W - X, Y - y W, (y + 1) W - Y is negative there; the first two sum to W. The l >= 0 for which that is so are a cone,
// whose extreme rays are among those of the two vertices and those where one function is 0. W is linear, so if it is
// positive anywhere in the cone, it is on an extreme ray.
inline bool degenerate_touches(const Triangle& triangle, int x, int y) {
  constexpr int kSides = 4;
  const auto sides_at = [&](const Vertex& v, Expansion<2>(&value)[kSides]) {
    const double left = x, top = y, vx = v.x, vy = v.y, w = v.w;  // the products have 24 and 23 bits
    value[0].add(vx), value[0].add(-(left * w));
    value[1].add((left + 1) * w), value[1].add(-vx);
    value[2].add(vy), value[2].add(-(top * w));
    value[3].add((top + 1) * w), value[3].add(-vy);
  };
  for (int edge = 0; edge < 3; ++edge) {
    Expansion<2> at_from[kSides], at_to[kSides];
    sides_at(triangle.edge(edge).from, at_from), sides_at(triangle.edge(edge).to, at_to);
    // Is l_0 from + l_1 to a point of the square?
    const auto inside = [&](const Expansion<2>& l0, const Expansion<2>& l1) {
      int least = 1, across = -1;
      for (int side = 0; side < kSides; ++side) {
        Expansion<16> sum;
        sum.add_product_of(at_from[side], l0), sum.add_product_of(at_to[side], l1);
        least = std::min(least, sum.sign());
        if (side < 2) across = std::max(across, sum.sign());
      }
      return least >= 0 && across > 0;
    };
    Expansion<2> zero, one;
    one.add(1);
    if (inside(one, zero) || inside(zero, one)) return true;
    for (int side = 0; side < kSides; ++side) {
      Expansion<2> l0 = at_to[side], l1 = at_from[side];
      if (l0.sign() * l1.sign() >= 0) continue;
      (l0.sign() < 0 ? l0 : l1).negate();
      if (inside(l0, l1)) return true;
    }
  }
  return false;
}

}  // namespace surefill

#endif  // SUREFILL_SRC_CONSERVATIVE_HPP
