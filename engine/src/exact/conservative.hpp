// SPDX-License-Identifier: Apache-2.0
//
// Conservative rasterization (M4): whether the closed square of a pixel meets, or lies in, the closed set T of all real
// points where no E_i / D is negative. Needs no arithmetic beyond the signs of the E_i at the square's corners.
#ifndef SUREFILL_SRC_CONSERVATIVE_HPP
#define SUREFILL_SRC_CONSERVATIVE_HPP

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

  // Does line i cross the side from corner p to corner q between them, at a point of H_j, j = i + 1 and k = i + 2?
  //
  // The point is |E_i(q)| p + |E_i(p)| q. E_i has opposite signs at p and q, so the value of E_j there is the sign of
  // E_i(p) times E_i(p) E_j(q) - E_i(q) E_j(p), up to a positive factor. That difference is D m_k . (p x q), because
  // (m_j x m_k) x (m_k x m_i) = D m_k. So E_j / D has the sign of E_i(p) m_k . (p x q).
  bool crossing_is_inside(int i, int side) const {
    const int at_p = sign_[i][side], at_q = sign_[i][(side + 1) % 4];
    return at_p * at_q < 0 && at_p * triangle_.determinant() * vertex_side((i + 2) % 3, side) >= 0;
  }

  // The sign of m_k . (p x q) for the corners p and q of a side: W_k times the distance of vertex k from the side's
  // line, inwards. Both sides of each comparison are exact: 24 bits, and 24 by 15 bits.
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

}  // namespace surefill

#endif  // SUREFILL_SRC_CONSERVATIVE_HPP
