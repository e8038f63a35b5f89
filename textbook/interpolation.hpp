// SPDX-License-Identifier: Apache-2.0
//
// Routes to a perspective-correct attribute (I2), each as its textbook has it. The routes are formulas over a type of
// number: in float they differ in the last bits and more; in rationals all give the real number that I2 names, and so
// one stored value (I4). Beside them, an approximation that was sold: w affine within a tile.
//
// Sources: P. Heckbert and H. Moreton, Interpolation for Polygon Texture Mapping and Shading, 1991 (s/w and 1/w); M.
// Olano and T. Greer, Triangle Scan Conversion using 2D Homogeneous Coordinates, 1997 (the matrix); T. Akenine-Moeller
// et al., Real-Time Rendering, 4th edition, section 23.1 (perspective barycentrics).
#ifndef SUREFILL_TEXTBOOK_INTERPOLATION_HPP
#define SUREFILL_TEXTBOOK_INTERPOLATION_HPP

#include <array>

#include "textbook/traversal.hpp"

namespace surefill::textbook {

enum class Route { areas, incremental, planes, matrix, perspective };
inline constexpr Route kRoutes[] = {Route::areas, Route::incremental, Route::planes, Route::matrix, Route::perspective};

constexpr const char* name_of(Route route) {
  constexpr const char* kNames[] = {"screen-space barycentrics from areas", "incremental barycentrics", "s/w and 1/w",
                                    "3 x 3 coefficient matrix", "perspective barycentrics"};
  return kNames[static_cast<int>(route)];
}

// a x + b y + c
template <class Number>
struct Affine {
  Number a, b, c;
  Number at(const Number& x, const Number& y) const { return a * x + b * y + c; }
};

// Number: float, double or exact rationals (gmpxx's mpq_class). Areas and planes divide by each W, so these are not 0;
// D != 0.
template <class Number>
class Interpolator {
 public:
  using Triple = std::array<Number, 3>;

  explicit Interpolator(const std::array<Vertex, 3>& v) {
    for (std::size_t i = 0; i < 3; ++i) {
      x_[i] = Number(v[i].x);
      y_[i] = Number(v[i].y);
      w_[i] = Number(v[i].w);
    }
  }

  // The attribute with these values at the vertices, at sample (x, y) of the lattice.
  Number value(Route route, const Triple& u, const Lattice& lattice, int x, int y) const {
    const SamplePosition p = lattice.at(x, y);
    const Number px(static_cast<Number>(p.x)), py(static_cast<Number>(p.y));
    switch (route) {
      case Route::areas:
        return by_areas(u, px, py);
      case Route::incremental:
        return by_steps(u, lattice, x, y);
      case Route::planes:
        return plane_over_w(u).at(px, py) / plane_over_w(ones()).at(px, py);
      case Route::matrix:
        return matrix_column(u).at(px, py) / matrix_column(ones()).at(px, py);
      default:
        return by_perspective_barycentrics(u, px, py);
    }
  }

  // u ~ (u/w)(p) times a w that is affine between the tile's corner (left, top) and the corners `size` pixels to the
  // right of it and below: no division a sample, and wrong.
  Number with_affine_w(const Triple& u, const Number& px, const Number& py, const Number& left, const Number& top,
                       const Number& size) const {
    const Affine<Number> over_w = plane_over_w(u), one_over_w = plane_over_w(ones());
    const Number corner = 1 / one_over_w.at(left, top);
    const Number right = 1 / one_over_w.at(left + size, top), below = 1 / one_over_w.at(left, top + size);
    const Number w = corner + (right - corner) * (px - left) / size + (below - corner) * (py - top) / size;
    return over_w.at(px, py) * w;
  }

  // (u/w)(x, y) through the three projected vertices, by its gradients.
  Affine<Number> plane_over_w(const Triple& u) const {
    Number sx[3], sy[3], f[3];
    for (std::size_t i = 0; i < 3; ++i) {
      sx[i] = x_[i] / w_[i];
      sy[i] = y_[i] / w_[i];
      f[i] = u[i] / w_[i];
    }
    const Number area = (sx[1] - sx[0]) * (sy[2] - sy[0]) - (sy[1] - sy[0]) * (sx[2] - sx[0]);
    const Number a = ((f[1] - f[0]) * (sy[2] - sy[0]) - (f[2] - f[0]) * (sy[1] - sy[0])) / area;
    const Number b = ((f[2] - f[0]) * (sx[1] - sx[0]) - (f[1] - f[0]) * (sx[2] - sx[0])) / area;
    const Number c = f[0] - a * sx[0] - b * sy[0];
    return {a, b, c};
  }

 private:
  static Triple ones() { return {Number(1), Number(1), Number(1)}; }

  // E_i as the textbooks step it.
  Affine<Number> edge(std::size_t i) const {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Number a = y_[j] * w_[k] - w_[j] * y_[k], b = w_[j] * x_[k] - x_[j] * w_[k],
                 c = x_[j] * y_[k] - y_[j] * x_[k];
    return {a, b, c};
  }

  // lambda_i = area(p, q_j, q_k) / area(q_0, q_1, q_2) of the projected vertices; then u_i / w_i and 1 / w_i by them.
  Number by_areas(const Triple& u, const Number& px, const Number& py) const {
    Number sx[3], sy[3];
    for (std::size_t i = 0; i < 3; ++i) {
      sx[i] = x_[i] / w_[i];
      sy[i] = y_[i] / w_[i];
    }
    const Number area = (sx[1] - sx[0]) * (sy[2] - sy[0]) - (sy[1] - sy[0]) * (sx[2] - sx[0]);
    Number numerator(0), denominator(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const Number lambda = ((sx[j] - px) * (sy[k] - py) - (sy[j] - py) * (sx[k] - px)) / area;
      numerator += lambda * (u[i] / w_[i]);
      denominator += lambda / w_[i];
    }
    return numerator / denominator;
  }

  // From sample (0, 0), down and then right, one addition a step.
  Number by_steps(const Triple& u, const Lattice& lattice, int x, int y) const {
    const SamplePosition start = lattice.at(0, 0);
    Number numerator(0), denominator(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Affine<Number> e = edge(i);
      Number value = e.at(static_cast<Number>(start.x), static_cast<Number>(start.y));
      for (int step = 0; step < y; ++step) value += e.b;
      for (int step = 0; step < x; ++step) value += e.a;
      numerator += u[i] * value;
      denominator += value;
    }
    return numerator / denominator;
  }

  // M^-1 u: the coefficients (A, B, C) with A X_i + B Y_i + C W_i = u_i, so that A x + B y + C is u/w.
  Affine<Number> matrix_column(const Triple& u) const {
    const Affine<Number> e0 = edge(0), e1 = edge(1), e2 = edge(2);
    const Number d = e0.a * x_[0] + e0.b * y_[0] + e0.c * w_[0];
    const Number a = (u[0] * e0.a + u[1] * e1.a + u[2] * e2.a) / d, b = (u[0] * e0.b + u[1] * e1.b + u[2] * e2.b) / d,
                 c = (u[0] * e0.c + u[1] * e1.c + u[2] * e2.c) / d;
    return {a, b, c};
  }

  // b_i = E_i / (E_0 + E_1 + E_2), and u_2 plus the differences: 2 products an attribute.
  Number by_perspective_barycentrics(const Triple& u, const Number& px, const Number& py) const {
    const Number e0 = edge(0).at(px, py), e1 = edge(1).at(px, py), e2 = edge(2).at(px, py);
    const Number one_over_sum = 1 / (e0 + e1 + e2);
    const Number b0 = e0 * one_over_sum, b1 = e1 * one_over_sum;
    return u[2] + b0 * (u[0] - u[2]) + b1 * (u[1] - u[2]);
  }

  std::array<Number, 3> x_, y_, w_;
};

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_INTERPOLATION_HPP
