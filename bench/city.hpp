// SPDX-License-Identifier: Apache-2.0
//
// What occlusion culling is measured on: a city of boxes, its objects, and views from its streets; deterministic.
#ifndef SUREFILL_BENCH_CITY_HPP
#define SUREFILL_BENCH_CITY_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::bench {

using Point = std::array<float, 3>;  // metres; y is up

struct Bounds {
  Point low, high;
};

// What hides, and what may be hidden.
struct City {
  std::vector<Point> positions;
  std::vector<std::uint32_t> indices;  // front faces are counter-clockwise
  std::vector<Bounds> objects;
  float extent;  // the streets lie within [0, extent]^2
};

// So many triangles of houses, twelve each, in blocks of four that touch, with streets between them; objects of 0.5 to 4
// metres stand in the streets, a tenth of them on the roofs' height.
City make_city(std::size_t triangles, std::size_t objects);

// Row vectors: clip = (x, y, z, 1) matrix. Depth is reversed and has no far plane: z is the near distance, w the distance.
using Matrix = std::array<float, 16>;

// A view from a street, 1.7 m high, 60 degrees vertically, 16 : 9.
Matrix street_view(const City& city, int number);

ClipVertex transformed(const Matrix& matrix, const Point& point);

}  // namespace surefill::bench

#endif  // SUREFILL_BENCH_CITY_HPP
