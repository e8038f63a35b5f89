// SPDX-License-Identifier: Apache-2.0
//
// Triangles drawn by geometry alone, in double: what is near an edge is left open. For guesses (questions_guesses.cpp).
#ifndef SUREFILL_CERTIFY_JUDGE_DRAWINGS_HPP
#define SUREFILL_CERTIFY_JUDGE_DRAWINGS_HPP

#include <array>
#include <vector>

namespace surefill::judge::drawings {

constexpr int kOpen = 1 << 20;

struct Point {
  double x, y, w;  // pixel-homogeneous (S2)
  bool operator==(const Point&) const = default;
};
using Triangle = std::array<Point, 3>;
using Polygon = std::vector<Point>;

struct Drawing {
  int width, height;
  double place_x, place_y;  // of the sample in its pixel
  std::vector<int> counts;  // a pixel each; kOpen and more: not said
};

inline Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.w + b.w};
}
inline Point operator*(double s, const Point& a) {
  return {s * a.x, s * a.y, s * a.w};
}
inline Point at(double x, double y) {
  return {x, y, 1};
}
inline double divided(double a, const Point& p) {
  return a / p.w;
}

// Counts go up by 1 in the triangle, and are open within 1/16 pixel of its edges, 1/4 where a vertex is behind the eye.
void paint(Drawing& to, const Triangle& t);
// The first corners of a polygon, as a fan.
void paint_fan(Drawing& to, const Polygon& polygon, std::size_t most = 99);

// The least x and y, and the largest ones.
std::array<double, 4> box_of(const Triangle& t);

// Scan lines between the edge from the upper to the lower vertex and the two others.
// How: 0 each edge begins at its vertex's x in its first row; 1 the two short ones alone; 2 spans reach from floor to
// ceiling; 3 spans of one pixel are lost; 4 the middle vertex goes to a whole x; 5 spans end with the pixel that they end
// in.
void scan_lines(const Triangle& t, Drawing& to, int how);

// Blocks of n x n pixels that no edge has wholly outside are drawn whole: what is far beyond a sharp vertex, too.
void unrejected_blocks(const Triangle& t, Drawing& to, int n);

// What is below a row without a sample is lost, of a triangle's box or of what it covers; where nobody can say whether a row has one, nobody can say what is below.
void until_an_empty_row(const Triangle& t, Drawing& to, bool from_the_box);

// Blocks of n x n pixels that an edge takes or leaves whole by some corners of theirs.
enum class Corners {
  falling,
  rising,
  all,
  by_a,
  by_b
};  // two opposite ones, all, or one, by the sign of an edge's a or b alone
enum class Extent {
  centres,
  block,
  a_pixel_less
};  // where corners are: at pixel centres, at the block's, a pixel too early
struct Taken {
  bool
      accepts;  // they are covered whole if no edge has a corner outside; or rejected if an edge has all of them outside
  Corners corners;
  Extent extent;
};
void by_corners(const Triangle& t, Drawing& to, int n, const Taken& how);

// Tiles of n x n pixels, one row after the other, and in each only those edges that have had no tile wholly inside before.
void forgotten_edges(const Triangle& t, Drawing& to, int n);

// The row that the middle vertex is in is drawn twice: by its upper part and its lower one.
void twice_in_the_middle(const Triangle& t, Drawing& to);

// In each block of n x n pixels a row ends at the first sample outside after one inside, of that row or of one above it, from
// the first pixel that the triangle's box touches or whose centre is in it.
void ended_as_rows_above(const Triangle& t, Drawing& to, int n, bool by_centres);

// Blocks of 8 x 8 pixels whose mask has 32 bits: what the lower four rows cover shows in the upper four. `all`: in blocks
// that are covered whole, too.
void masks_of_32_bits(const Triangle& t, Drawing& to, bool all);

}  // namespace surefill::judge::drawings

#endif  // SUREFILL_CERTIFY_JUDGE_DRAWINGS_HPP
