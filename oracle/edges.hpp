// SPDX-License-Identifier: Apache-2.0
//
// The three edge functions of section 2 in long double, with bounds of their errors: for who wants to be sure, and leaves
// open what is not.
#ifndef SUREFILL_ORACLE_EDGES_HPP
#define SUREFILL_ORACLE_EDGES_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// Relative error of an edge function in long double, which is a double at least, with room to spare: 2^9 roundings.
static_assert(std::numeric_limits<long double>::digits >= 53);
inline constexpr long double kRoundings = std::numeric_limits<long double>::digits >= 64 ? 0x1p-55L : 0x1p-44L;

struct Edges {
  std::array<std::array<long double, 3>, 3> e{}, magnitude{};
  long double d = 0, d_magnitude = 0;

  explicit Edges(const std::array<Vertex, 3>& v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &p = v[(i + 1) % 3], &q = v[(i + 2) % 3];
      const std::array<long double, 3> m{p.x, p.y, p.w}, n{q.x, q.y, q.w};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t j = (c + 1) % 3, k = (c + 2) % 3;
        e[i][c] = m[j] * n[k] - m[k] * n[j];
        magnitude[i][c] = std::abs(m[j] * n[k]) + std::abs(m[k] * n[j]);
      }
    }
    const std::array<long double, 3> m{v[0].x, v[0].y, v[0].w};
    for (std::size_t c = 0; c < 3; ++c) {
      d += m[c] * e[0][c];
      d_magnitude += std::abs(m[c]) * magnitude[0][c];
    }
  }
  // R8, R9: D is 0, or nearly so.
  bool is_thin() const { return std::abs(d) <= 0x1p-20L * d_magnitude; }
  long double at(std::size_t i, double x, double y) const { return e[i][0] * x + e[i][1] * y + e[i][2]; }
  long double error(std::size_t i, double x, double y) const {
    return kRoundings * (magnitude[i][0] * std::abs(x) + magnitude[i][1] * std::abs(y) + magnitude[i][2]);
  }
};

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_EDGES_HPP
