// SPDX-License-Identifier: Apache-2.0
//
// Exact signs without CGAL, which there is not for WebAssembly: so there are no theorems over Delaunay meshes, hulls and mesh files in
// the page, which leaves out the checks that would ask for them (page.cpp).
#include "properties/generators/meshes.hpp"

#include <gmpxx.h>

#include <cmath>
#include <stdexcept>

#include "oracle/coverage.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill {

namespace oracle {

namespace {

template <typename Number>
Number determinant(const Position& m0, const Position& m1, const Position& m2) {
  const auto minor = [](double a, double b, double c, double d) {
    return Number(a) * Number(d) - Number(b) * Number(c);
  };
  return Number(m0.x) * minor(m1.y, m1.w, m2.y, m2.w) - Number(m0.y) * minor(m1.x, m1.w, m2.x, m2.w) +
         Number(m0.w) * minor(m1.x, m1.y, m2.x, m2.y);
}

}  // namespace

int sign_of_determinant(const Position& m0, const Position& m1, const Position& m2) {
  // Five roundings on the way of each of the six products, none of which is larger than `size`; no product is subnormal.
  const auto most = [](const Position& m) { return std::max({std::abs(m.x), std::abs(m.y), std::abs(m.w)}); };
  const double size = most(m0) * most(m1) * most(m2);
  if (size > 0x1p-900 && std::isfinite(size)) {
    const double value = determinant<double>(m0, m1, m2);
    if (std::abs(value) > 0x1p-45 * size) return value > 0 ? 1 : -1;
  }
  return sgn(determinant<mpq_class>(m0, m1, m2));
}

}  // namespace oracle

namespace properties {

int facing(const std::array<Vertex, 3>& t) {
  const auto position = [](const Vertex& v) { return oracle::Position{v.x, v.y, v.w}; };
  for (const Vertex& v : t) {
    if (!finite(v)) return 0;
  }
  return oracle::sign_of_determinant(position(t[0]), position(t[1]), position(t[2]));
}

namespace {

[[noreturn]] void refuse() {
  throw std::runtime_error("the page has no such meshes");
}

}  // namespace

std::vector<Indices> delaunay(std::span<const std::array<float, 2>>) {
  refuse();
}

std::vector<Indices> convex_hull(std::span<const std::array<float, 3>>) {
  refuse();
}

Mesh load_mesh(const char*) {
  refuse();
}

}  // namespace properties

}  // namespace surefill
