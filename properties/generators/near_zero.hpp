// SPDX-License-Identifier: Apache-2.0
//
// Triangles whose determinants nearly vanish: integers of a few units left of terms as large as float32 allows, where
// any rounding of an intermediate result changes a sign. Found by solving n . v = t in integers and reducing the
// solution.
#ifndef SUREFILL_PROPERTIES_NEAR_ZERO_HPP
#define SUREFILL_PROPERTIES_NEAR_ZERO_HPP

#include <array>

#include "properties/generators/generators.hpp"

namespace surefill::properties {

// An edge function of at most four units (or exactly 0) at a sample of the target.
std::array<Vertex, 3> nearly_tied_triangle(Random& random, int width, int height);

// |D| of at most three units, of terms of 2^66.
std::array<Vertex, 3> nearly_degenerate_triangle(Random& random);

// |D| of at most two units of its greatest common divisor, and an edge exactly through a sample.
std::array<Vertex, 3> nearly_degenerate_tied_triangle(Random& random, int width, int height);

// On a grid, which is changed to one of few bits that rounds to nearest: the edge between the first two vertices leaves
// the guard band so near to the middle of two grid positions that a double's rounding goes to the wrong one, and a
// sample, the centre of a pixel, lies between the two edges that these make. If none is found, a nearly tied triangle.
std::array<Vertex, 3> nearly_halfway_cut_triangle(Random& random, Grid& grid, int width, int height);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_NEAR_ZERO_HPP
