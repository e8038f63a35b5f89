// SPDX-License-Identifier: Apache-2.0
#include "oracle/clipped_plane.hpp"

#include <utility>

namespace surefill::oracle::clipped {

Basis::Basis(const std::array<Vector, 3>& m) {
  std::array<std::array<Rational, 6>, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    rows[0][i] = m[i].x;
    rows[1][i] = m[i].y;
    rows[2][i] = m[i].w;
    rows[i][3 + i] = 1;
  }
  for (std::size_t column = 0; column < 3; ++column) {
    std::size_t pivot = column;
    while (pivot < 3 && sgn(rows[pivot][column]) == 0) ++pivot;
    if (pivot == 3) return;
    std::swap(rows[pivot], rows[column]);
    const Rational scale = rows[column][column];
    for (Rational& value : rows[column]) value /= scale;
    for (std::size_t row = 0; row < 3; ++row) {
      if (row == column) continue;
      const Rational factor = rows[row][column];
      for (std::size_t k = 0; k < 6; ++k) rows[row][k] -= factor * rows[column][k];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) inverse_[i] = {rows[i][3], rows[i][4], rows[i][5]};
  regular_ = true;
}

}  // namespace surefill::oracle::clipped
