// SPDX-License-Identifier: Apache-2.0
//
// Does a triangle meet a tile? Two answers of the textbooks over the same exact signs, and what they cost. The tile is
// a closed rectangle of whole pixels, T the closed set of points where no E_i / D is negative (M4).
//
// Sources: the corner test, Pineda 1988 and T. Akenine-Moeller and T. Aila, Conservative and Tiled Rasterization Using
// a Modified Triangle Setup, 2005; the three tests, M. McCool et al., 2001.
#ifndef SUREFILL_TEXTBOOK_TILE_TEST_HPP
#define SUREFILL_TEXTBOOK_TILE_TEST_HPP

#include "textbook/traversal.hpp"

namespace surefill::textbook {

struct TileTestCost {
  std::uint64_t edge_evaluations = 0;
  std::uint64_t vertex_comparisons = 0;  // of a vertex with a side of the tile: one product
};

class TileTest {
 public:
  // `triangle` is set up, with D != 0.
  TileTest(const Triangle& triangle, const PixelBox& tile) : triangle_(triangle), tile_(tile) {}

  const TileTestCost& cost() const { return cost_; }

  // Corners against edges. reject: all corners are outside one edge, so T and the tile do not meet; they may not meet
  // even so (a tile near a sharp corner). accept: the tile lies in T.
  TileClass by_corners() {
    bool all_inside = true;
    for (int i = 0; i < 3; ++i) {
      const EdgeFunction& e = triangle_.edge(i);
      const bool right = sign_of(e.a) * triangle_.determinant() > 0, down = sign_of(e.b) * triangle_.determinant() > 0;
      if (corner_sign(i, right, down) < 0) return TileClass::reject;
      all_inside = all_inside && corner_sign(i, !right, !down) >= 0;
    }
    return all_inside ? TileClass::accept : TileClass::partial;
  }

  // The three tests of triangle and rectangle: T and the tile meet exactly if a vertex lies in the tile, or a corner in
  // T, or an edge crosses a side. (If they meet, one holds the other, or their boundaries meet.)
  TileClass by_three_tests() {
    int corners_inside = 0;
    for (int c = 0; c < 4; ++c) corners_inside += corner_in_triangle(c % 2 != 0, c / 2 != 0) ? 1 : 0;
    if (corners_inside == 4) return TileClass::accept;
    if (corners_inside > 0) return TileClass::partial;
    for (int i = 0; i < 3; ++i) {
      if (vertex_in_tile(i)) return TileClass::partial;
    }
    for (int i = 0; i < 3; ++i) {
      for (int side = 0; side < 4; ++side) {
        if (edge_crosses_side(i, side)) return TileClass::partial;
      }
    }
    return TileClass::reject;
  }

 private:
  // The sign of E_i / D at a corner.
  int corner_sign(int i, bool right, bool down) {
    ++cost_.edge_evaluations;
    const SamplePosition p{static_cast<double>(right ? tile_.x1 : tile_.x0),
                           static_cast<double>(down ? tile_.y1 : tile_.y0)};
    return triangle_.edge(i).sign(p) * triangle_.determinant();
  }

  bool corner_in_triangle(bool right, bool down) {
    return corner_sign(0, right, down) >= 0 && corner_sign(1, right, down) >= 0 && corner_sign(2, right, down) >= 0;
  }

  bool vertex_in_tile(int i) {
    if (!(triangle_.vertex(i).w > 0)) return false;
    for (int side = 0; side < 4; ++side) {
      if (vertex_side(i, side) < 0) return false;
    }
    return true;
  }

  // The sign of m_i . (p x q) for the corners p and q of a side, clockwise from the top: W_i times the distance of
  // vertex i from the side's line, inwards. The products have 24 + 15 bits.
  int vertex_side(int i, int side) {
    ++cost_.vertex_comparisons;
    const Vertex& v = triangle_.vertex(i);
    const double x = v.x, y = v.y, w = v.w;
    switch (side) {
      case 0:
        return y > tile_.y0 * w ? 1 : y < tile_.y0 * w ? -1 : 0;
      case 1:
        return x < tile_.x1 * w ? 1 : x > tile_.x1 * w ? -1 : 0;
      case 2:
        return y < tile_.y1 * w ? 1 : y > tile_.y1 * w ? -1 : 0;
      default:
        return x > tile_.x0 * w ? 1 : x < tile_.x0 * w ? -1 : 0;
    }
  }

  // Two segments: the ends p and q of the side lie on different sides of edge i, and the crossing, |E_i(q)| p +
  // |E_i(p)| q, is a point of T. Because (m_j x m_k) x (m_k x m_i) = D m_k, E_j / D has the sign of E_i(p) m_k . (p x
  // q) there, and E_k / D that of -E_i(p) m_j . (p x q): with W > 0, the ends of the edge lie on different sides of the
  // side.
  bool edge_crosses_side(int i, int side) {
    const int at_p = corner_sign(i, side == 1 || side == 2, side >= 2);
    if (at_p == 0) return false;  // the crossing is a corner, and no corner lies in T
    const int at_q = corner_sign(i, side == 0 || side == 1, side == 1 || side == 2);
    if (at_p * at_q >= 0) return false;
    // at_p has the sign of E_i / D: one more factor D.
    const int d = triangle_.determinant();
    return at_p * d * vertex_side((i + 2) % 3, side) >= 0 && at_p * d * vertex_side((i + 1) % 3, side) <= 0;
  }

  const Triangle& triangle_;
  PixelBox tile_;
  TileTestCost cost_;
};

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_TILE_TEST_HPP
