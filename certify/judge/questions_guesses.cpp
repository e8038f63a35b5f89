// SPDX-License-Identifier: Apache-2.0
//
// Questions about plain triangles on the target, and about those that reach beyond it: what becomes of them is guessed.
#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/guesses.hpp"

namespace surefill::judge {

namespace {

using drawings::at;
using drawings::box_of;
using drawings::Corners;
using drawings::divided;
using drawings::Drawing;
using drawings::ended_as_rows_above;
using drawings::Extent;
using drawings::forgotten_edges;
using drawings::kOpen;
using drawings::masks_of_32_bits;
using drawings::paint;
using drawings::paint_fan;
using drawings::Point;
using drawings::Polygon;
using drawings::scan_lines;
using drawings::Triangle;
using drawings::twice_in_the_middle;
using drawings::unrejected_blocks;
using drawings::until_an_empty_row;
using guesses::cut;
using guesses::Guess;
using guesses::guessed;
using guesses::how_many;
using guesses::masked;
using guesses::New;
using guesses::Shown;
using guesses::shown_of;
using guesses::unless;

// --- the guesses

template <class Change>
void changed(Triangle t, Drawing& to, const Change& change) {
  for (Point& p : t) {
    if (p.w > 0) p = at(p.x / p.w, p.y / p.w);
    change(p);
  }
  paint(to, t);
}

Polygon cut_at_target(const Triangle& t, const Drawing& to, New made) {
  Polygon p{t[0], t[1], t[2]};
  const double width = to.width, height = to.height;
  p = cut(
      p, [](const Point& v) { return v.x; }, made);
  p = cut(
      p, [width](const Point& v) { return width * v.w - v.x; }, made);
  p = cut(
      p, [](const Point& v) { return v.y; }, made);
  return cut(
      p, [height](const Point& v) { return height * v.w - v.y; }, made);
}

// Blocks of so many pixels, of which `counts` says how many samples are covered, and how many open.
template <class Count>
void blocks(const Triangle& t, Drawing& to, int wide, int high, const Count& count) {
  paint(to, t);
  for (int y0 = 0; y0 < to.height; y0 += high) {
    for (int x0 = 0; x0 < to.width; x0 += wide) {
      int covered = 0, open = 0, all = 0;
      for (int y = y0; y < std::min(y0 + high, to.height); ++y) {
        for (int x = x0; x < std::min(x0 + wide, to.width); ++x) {
          const int n = to.counts[static_cast<std::size_t>(y * to.width + x)];
          covered += n == 1, open += n >= kOpen, ++all;
        }
      }
      const int all_become = count(covered, open, all);  // -1: as they are
      if (all_become < 0) continue;
      for (int y = y0; y < std::min(y0 + high, to.height); ++y) {
        for (int x = x0; x < std::min(x0 + wide, to.width); ++x) {
          to.counts[static_cast<std::size_t>(y * to.width + x)] = all_become;
        }
      }
    }
  }
}

// Tiles of so many pixels, of which the one that the box's end is in is left out; 0: none is in that axis.
void without_last_tiles(const Triangle& t, Drawing& to, int wide, int high) {
  const auto box = box_of(t);
  const auto end = [](double last, int n) { return n == 0 ? INFINITY : n * std::floor(last / n); };
  masked(t, to, [&](int x, int y) { return x < end(box[2], wide) && y < end(box[3], high); });
}

template <bool kAccepts, Corners kCorners, Extent kExtent>
void by_corners(const Triangle& t, Drawing& to, int n) {
  drawings::by_corners(t, to, n, {kAccepts, kCorners, kExtent});
}

// Of the box's last pixels, those that are the first of a block.
void ended_before_blocks(const Triangle& t, Drawing& to, int n) {
  const auto box = box_of(t);
  const int last_x = static_cast<int>(std::floor(box[2])), last_y = static_cast<int>(std::floor(box[3]));
  masked(t, to, [=](int x, int y) { return !(x == last_x && last_x % n == 0) && !(y == last_y && last_y % n == 0); });
}

Triangle by_height(Triangle t) {
  std::sort(t.begin(), t.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
  return t;
}

// Of the middle vertex, how far right of the edge between the upper and the lower one.
double middle_side(const Triangle& t) {
  const auto [low, middle, high] = by_height(t);
  return middle.x - low.x - (high.x - low.x) * (middle.y - low.y) / (high.y - low.y);
}

void half(const Triangle& t, Drawing& to, bool lower) {
  const double y = by_height(t)[1].y;
  paint(to, t);
  for (std::size_t i = 0; i < to.counts.size(); ++i) {
    const double beyond = static_cast<double>(i / static_cast<std::size_t>(to.width)) + to.place_y - y;
    if (std::abs(beyond) < 1.0 / 16)
      to.counts[i] = kOpen;
    else if (to.counts[i] < kOpen && (beyond > 0) != lower)
      to.counts[i] = 0;
  }
}

// --- of plain triangles on the target

constexpr Guess kPlain[] = {
    {"scan lines begin at a vertex's x and not at the first row's centre: the prestep is missing, by which edges go on "
     "from "
     "the vertex to that row",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 0); }},
    {"the two short edges of a triangle begin at their vertex's x and not at the first row's centre: their prestep is "
     "missing",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 1); }},
    {"each row of a triangle is drawn from the pixel that its left edge is in to the one that its right edge is in: "
     "spans "
     "are rounded outwards, not by pixel centres",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 2); }},
    {"rows in which a triangle has one pixel only are lost: spans of one pixel are taken for empty",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 3); }},
    {"the middle vertex of a triangle, where its scan lines are split, goes to a whole x",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 4); }},
    {"each row of a triangle is drawn up to the pixel that its right edge is in, covered or not: the span's end is "
     "rounded up",
     [](const Triangle& t, Drawing& to, int) { scan_lines(t, to, 5); }},
    {"pixels are drawn in groups of %d along a row, whole where one of them is covered: the mask of single lanes is "
     "missing",
     [](const Triangle& t, Drawing& to, int n) {
       blocks(t, to, n, 1, [](int covered, int open, int) { return covered > 0 ? 1 : open > 0 ? kOpen : 0; });
     },
     {2, 16, -1}},
    {"blocks of %d x %d pixels are drawn whole where a triangle touches them: what is not wholly outside is taken for "
     "inside",
     [](const Triangle& t, Drawing& to, int n) {
       blocks(t, to, n, n, [](int covered, int open, int) { return covered > 0 ? 1 : open > 0 ? kOpen : -1; });
     },
     {2, 16, -1}},
    {"blocks of %d x %d pixels that no edge has wholly outside are drawn whole: what is not rejected is taken for "
     "inside",
     unrejected_blocks,
     {2, 16, -1}},
    {"of a triangle only the blocks of %d x %d pixels that lie wholly inside are drawn: those that its edges pass are "
     "lost",
     [](const Triangle& t, Drawing& to, int n) {
       blocks(t, to, n, n, [](int covered, int open, int all) {
         return covered == all ? 1 : covered + open == all ? kOpen : 0;
       });
     },
     {2, 16, -1}},
    {"blocks of %d x %d pixels that lie wholly inside a triangle are lost: only those that its edges pass are drawn",
     [](const Triangle& t, Drawing& to, int n) {
       blocks(t, to, n, n, [](int covered, int open, int all) {
         return covered == all ? 0 : covered + open == all ? kOpen : -1;
       });
     },
     {4, 128, -1}},
    {"triangles whose middle vertex, by y, lies right of the long edge are not drawn",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return middle_side(t) > 0; }); }},
    {"triangles whose middle vertex, by y, lies left of the long edge are not drawn",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return middle_side(t) < 0; }); }},
    {"of a triangle only the part below its middle vertex is drawn",
     [](const Triangle& t, Drawing& to, int) { half(t, to, true); }},
    {"of a triangle only the part above its middle vertex is drawn",
     [](const Triangle& t, Drawing& to, int) { half(t, to, false); }},
    {"of a triangle's box only a multiple of %d columns is drawn: the columns that are left over on its right are lost "
     "(a loop "
     "over groups without its rest)",
     [](const Triangle& t, Drawing& to, int n) {
       const auto box = box_of(t);
       const double begin = std::max(std::floor(box[0]), 0.0), end = std::min<double>(std::floor(box[2]) + 1, to.width);
       masked(t, to, [&](int x, int) { return x < begin + n * std::floor((end - begin) / n); });
     },
     {2, 16, -1}},
    {"of a triangle's box only a multiple of %d rows is drawn: the rows that are left over at its lower end are lost",
     [](const Triangle& t, Drawing& to, int n) {
       const auto box = box_of(t);
       const double begin = std::max(std::floor(box[1]), 0.0),
                    end = std::min<double>(std::floor(box[3]) + 1, to.height);
       masked(t, to, [&](int, int y) { return y < begin + n * std::floor((end - begin) / n); });
     },
     {2, 16, -1}},
    {"a triangle is drawn in those tiles of %d x %d pixels alone in which it has a vertex",
     [](const Triangle& t, Drawing& to, int n) {
       masked(t, to, [&](int x, int y) {
         return how_many(t, [&](const Point& p) {
                  return std::floor(divided(p.x, p) / n) == x / n && std::floor(divided(p.y, p) / n) == y / n;
                }) > 0;
       });
     },
     {4, 128, -1}},
    {"the last tiles of %d x %d pixels that a triangle's box reaches are lost, on its right and at its lower end: the "
     "last tile is taken for the first one beyond",
     [](const Triangle& t, Drawing& to, int n) { without_last_tiles(t, to, n, n); },
     {4, 128, -1}},
    {"the last column of tiles that a triangle's box reaches, of %d pixels, is lost: the last tile is taken for the "
     "first one beyond",
     [](const Triangle& t, Drawing& to, int n) { without_last_tiles(t, to, n, 0); },
     {4, 128, -1}},
    {"the last row of tiles that a triangle's box reaches, of %d pixels, is lost: the last tile is taken for the first "
     "one beyond",
     [](const Triangle& t, Drawing& to, int n) { without_last_tiles(t, to, 0, n); },
     {4, 128, -1}},
    {"a triangle ends at the first row of its box in which it has no sample: what is below is lost, of slivers above "
     "all",
     [](const Triangle& t, Drawing& to, int) { until_an_empty_row(t, to, true); }},
    {"a triangle ends at its first row without a sample after one that has some: slivers are cut off there",
     [](const Triangle& t, Drawing& to, int) { until_an_empty_row(t, to, false); }},
    {"blocks of %d x %d pixels are taken for covered whole if their upper left and lower right corners are inside of "
     "each edge: the two others are not looked at",
     by_corners<true, Corners::falling, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole if their upper left and lower right corners are inside of "
     "each edge: the two others are not looked at",
     by_corners<true, Corners::falling, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole if their upper right and lower left corners are inside of "
     "each edge: the two others are not looked at",
     by_corners<true, Corners::rising, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole if their upper right and lower left corners are inside of "
     "each edge: the two others are not looked at",
     by_corners<true, Corners::rising, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected if their upper left and lower right corners are outside of an edge: the "
     "two others are not looked at",
     by_corners<false, Corners::falling, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected if their upper left and lower right corners are outside of an edge: the "
     "two others are not looked at",
     by_corners<false, Corners::falling, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected if their upper right and lower left corners are outside of an edge: the "
     "two others are not looked at",
     by_corners<false, Corners::rising, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected if their upper right and lower left corners are outside of an edge: the "
     "two others are not looked at",
     by_corners<false, Corners::rising, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole by corners that leave out their last column and row",
     by_corners<true, Corners::all, Extent::a_pixel_less>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected by corners that leave out their last column and row: what a triangle "
     "covers there alone is lost",
     by_corners<false, Corners::all, Extent::a_pixel_less>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole by the wrong corner of an edge a x + b y + c: it is chosen "
     "by the sign of a for both axes",
     by_corners<true, Corners::by_a, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole by the wrong corner of an edge a x + b y + c: it is chosen "
     "by the sign of a for both axes",
     by_corners<true, Corners::by_a, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole by the wrong corner of an edge a x + b y + c: it is chosen "
     "by the sign of b for both axes",
     by_corners<true, Corners::by_b, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are taken for covered whole by the wrong corner of an edge a x + b y + c: it is chosen "
     "by the sign of b for both axes",
     by_corners<true, Corners::by_b, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected by the wrong corner of an edge a x + b y + c: it is chosen by the sign of "
     "a for both axes",
     by_corners<false, Corners::by_a, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected by the wrong corner of an edge a x + b y + c: it is chosen by the sign of "
     "a for both axes",
     by_corners<false, Corners::by_a, Extent::block>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected by the wrong corner of an edge a x + b y + c: it is chosen by the sign of "
     "b for both axes",
     by_corners<false, Corners::by_b, Extent::centres>,
     {4, 64, -1}},
    {"blocks of %d x %d pixels are rejected by the wrong corner of an edge a x + b y + c: it is chosen by the sign of "
     "b for both axes",
     by_corners<false, Corners::by_b, Extent::block>,
     {4, 64, -1}},
    {"in tiles of %d x %d pixels an edge that had one tile wholly inside is not tested in those after it: what a tile "
     "says is kept for the triangle",
     forgotten_edges,
     {4, 128, -1}},
    {"the row that a triangle's middle vertex is in is drawn twice: by the upper part and by the lower one",
     [](const Triangle& t, Drawing& to, int) { twice_in_the_middle(t, to); }},
    {"the last column and row that a triangle's box reaches are lost where a block of %d x %d pixels begins with them: "
     "the loop over blocks ends too early",
     [](const Triangle& t, Drawing& to, int n) { ended_before_blocks(t, to, n); },
     {2, 32, -1}},
    {"in blocks of %d x %d pixels a row ends before it begins where a row above it has ended: the flag that says "
     "inside is not reset in each row",
     [](const Triangle& t, Drawing& to, int n) { ended_as_rows_above(t, to, n, true); },
     {4, 32, -1}},
    {"in blocks of %d x %d pixels a row ends before it begins where a row above it has ended: the flag that says "
     "inside is not reset in each row",
     [](const Triangle& t, Drawing& to, int n) { ended_as_rows_above(t, to, n, false); },
     {4, 32, -1}},
    {"a row of a triangle ends before it begins where a row above it has ended: the flag that says inside is not reset "
     "in each row",
     [](const Triangle& t, Drawing& to, int n) { ended_as_rows_above(t, to, n, false); },
     {1 << 14, 1 << 14, 1}},
    {"in blocks of 8 x 8 pixels the lower four rows are lost, and show in the upper four: a mask of 64 bits is made in "
     "32",
     [](const Triangle& t, Drawing& to, int) { masks_of_32_bits(t, to, false); }},
    {"in blocks of 8 x 8 pixels the lower four rows are lost, and show in the upper four: a mask of 64 bits is made in "
     "32",
     [](const Triangle& t, Drawing& to, int) { masks_of_32_bits(t, to, true); }},
    {"rows of a triangle beyond the target's width are lost: y is limited by the width in place of the height",
     [](const Triangle& t, Drawing& to, int) { masked(t, to, [&to](int, int y) { return y < to.width; }); }},
    {"columns of a triangle beyond the target's height are lost: x is limited by the height in place of the width",
     [](const Triangle& t, Drawing& to, int) { masked(t, to, [&to](int x, int) { return x < to.height; }); }},
    {"a triangle is cut at the target's height in x and at its width in y: the two are exchanged",
     [](const Triangle& t, Drawing& to, int) {
       masked(t, to, [&to](int x, int y) { return x < to.height && y < to.width; });
     }},
    {"only the rows between the first two vertices of a triangle are drawn: its box lacks the third vertex",
     [](const Triangle& t, Drawing& to, int) {
       const auto [low, high] = std::minmax({divided(t[0].y, t[0]), divided(t[1].y, t[1])});
       masked(t, to, [&](int, int y) { return y >= std::floor(low) && y <= std::floor(high); });
     }},
};

// --- of triangles that reach beyond the target

constexpr int kX = 1, kY = 2, kLow = 4, kHigh = 8, kLast = 16;
void clamped(const Triangle& t, Drawing& to, int how, double beyond) {
  changed(t, to, [&](Point& p) {
    const double less = how & kLast ? 1 : 0;
    if (how & kX && how & kLow) p.x = std::max(p.x, -beyond);
    if (how & kX && how & kHigh) p.x = std::min(p.x, to.width - less + beyond);
    if (how & kY && how & kLow) p.y = std::max(p.y, -beyond);
    if (how & kY && how & kHigh) p.y = std::min(p.y, to.height - less + beyond);
  });
}

// The box's first whole pixels come to lie at the target's.
void begun_beyond(const Triangle& t, Drawing& to, int axes) {
  const auto box = box_of(t);
  Triangle other = t;
  for (Point& p : other) {
    if (axes & kX) p.x -= std::min(0.0, std::floor(box[0])) * p.w;
    if (axes & kY) p.y -= std::min(0.0, std::floor(box[1])) * p.w;
  }
  masked(other, to, [&](int x, int y) { return x <= box[2] && y <= box[3]; });
}

// How many of the vertices are beyond each border.
std::array<int, 4> beyond(const Triangle& t, const Drawing& to) {
  return {how_many(t, [](const Point& p) { return p.x < 0; }), how_many(t, [](const Point& p) { return p.y < 0; }),
          how_many(t, [&to](const Point& p) { return p.x > to.width * p.w; }),
          how_many(t, [&to](const Point& p) { return p.y > to.height * p.w; })};
}
int outside(const Triangle& t, const Drawing& to) {
  return how_many(
      t, [&to](const Point& p) { return p.x < 0 || p.y < 0 || p.x > to.width * p.w || p.y > to.height * p.w; });
}

constexpr Guess kReach[] = {
    {"vertices beyond the target are clamped to its border: they move, and edges with them, instead of triangles being "
     "cut",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kY | kLow | kHigh, 0); }},
    {"vertices beyond the target are clamped to its first and last pixel, 0 to width - 1 and 0 to height - 1: they "
     "move, and "
     "edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kY | kLow | kHigh | kLast, 0); }},
    {"the x of vertices beyond the target is clamped to its border: they move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kLow | kHigh, 0); }},
    {"the y of vertices beyond the target is clamped to its border: they move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kY | kLow | kHigh, 0); }},
    {"negative positions are clamped to 0: vertices left of and above the target move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kY | kLow, 0); }},
    {"a negative x is clamped to 0: vertices left of the target move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kLow, 0); }},
    {"a negative y is clamped to 0: vertices above the target move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kY | kLow, 0); }},
    {"vertices beyond the right and the lower border are clamped to it: they move, and edges with them",
     [](const Triangle& t, Drawing& to, int) { clamped(t, to, kX | kY | kHigh, 0); }},
    {"vertices farther than %d pixels beyond the target are clamped to there: they move, and edges with them",
     [](const Triangle& t, Drawing& to, int n) { clamped(t, to, kX | kY | kLow | kHigh, n); },
     {1, 16384, -1}},
    {"positions are clamped to -%d to %d pixels (a guard band): vertices move, and edges with them",
     [](const Triangle& t, Drawing& to, int n) {
       changed(t, to, [n](Point& p) { p = at(std::clamp<double>(p.x, -n, n), std::clamp<double>(p.y, -n, n)); });
     },
     {16, 16384, -1}},
    {"positions wrap beyond -%d to %d pixels: they are kept in too few bits",
     [](const Triangle& t, Drawing& to, int n) {
       changed(t, to, [n](Point& p) {
         const auto wrap = [n](double v) { return v - 2.0 * n * std::floor(v / (2.0 * n) + 0.5); };
         p = at(wrap(p.x), wrap(p.y));
       });
     },
     {16, 16384, -1}},
    {"edges begin at the corner of a triangle's box, and pixels at that of its box within the target: triangles that "
     "reach beyond the left or the upper border are moved",
     [](const Triangle& t, Drawing& to, int) { begun_beyond(t, to, kX | kY); }},
    {"edges begin at the left end of a triangle's box, and pixels at that of its box within the target: triangles that "
     "reach beyond the left border are moved",
     [](const Triangle& t, Drawing& to, int) { begun_beyond(t, to, kX); }},
    {"edges begin at the upper end of a triangle's box, and pixels at that of its box within the target: triangles "
     "that reach beyond the upper border are moved",
     [](const Triangle& t, Drawing& to, int) { begun_beyond(t, to, kY); }},
    {"a triangle with a vertex beyond the target is not drawn",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return outside(t, to) > 0; }); }},
    {"a triangle with two vertices beyond the target is not drawn",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return outside(t, to) > 1; }); }},
    {"a triangle without a vertex on the target is not drawn: it is rejected though its vertices lie beyond different "
     "borders",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return outside(t, to) == 3; }); }},
    {"a triangle with two vertices beyond one border is not drawn: rejecting asks for two vertices, not for all three",
     [](const Triangle& t, Drawing& to, int) {
       unless(t, to, [&] { return std::ranges::any_of(beyond(t, to), [](int n) { return n > 1; }); });
     }},
    {"a triangle with two vertices left of the target is not drawn: rejecting asks for two vertices, not for all three",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return beyond(t, to)[0] > 1; }); }},
    {"a triangle with a vertex left of the target is not drawn",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return beyond(t, to)[0] > 0; }); }},
    {"a triangle with a vertex left of or above the target (a negative position) is not drawn",
     [](const Triangle& t, Drawing& to, int) {
       unless(t, to, [&] { return beyond(t, to)[0] + beyond(t, to)[1] > 0; });
     }},
    {"a triangle with a vertex beyond the right or the lower border is not drawn",
     [](const Triangle& t, Drawing& to, int) {
       unless(t, to, [&] { return beyond(t, to)[2] + beyond(t, to)[3] > 0; });
     }},
    {"a triangle whose box has its middle beyond the target is not drawn",
     [](const Triangle& t, Drawing& to, int) {
       unless(t, to, [&] {
         const auto b = box_of(t);
         const double x = b[0] + b[2], y = b[1] + b[3];
         return x < 0 || y < 0 || x > 2 * to.width || y > 2 * to.height;
       });
     }},
    {"a triangle whose first vertex is beyond the target is not drawn: rejecting looks at that vertex alone",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] {
                                                 return outside({t[0], t[0], t[0]}, to) > 0;
                                               }); }},
    {"a triangle with a vertex farther than %d pixels beyond the target is not drawn",
     [](const Triangle& t, Drawing& to, int n) {
       unless(t, to, [&] {
         const auto b = box_of(t);
         return b[0] < -n || b[1] < -n || b[2] > to.width + n || b[3] > to.height + n;
       });
     },
     {1, 16384, -1}},
    {"a triangle that is more than %d pixels wide or high is not drawn",
     [](const Triangle& t, Drawing& to, int n) {
       unless(t, to, [&] {
         const auto b = box_of(t);
         return b[2] - b[0] > n || b[3] - b[1] > n;
       });
     },
     {16, 16384, -1}},
    {"of a triangle only the first %d columns and rows of its box are drawn: sizes stop there",
     [](const Triangle& t, Drawing& to, int n) {
       const auto b = box_of(t);
       masked(t, to, [&](int x, int y) { return x < std::floor(b[0]) + n && y < std::floor(b[1]) + n; });
     },
     {32, 8192, -1}},
    {"the width of a triangle's box is taken modulo %d: it is kept in too few bits",
     [](const Triangle& t, Drawing& to, int n) {
       const auto b = box_of(t);
       const double width = std::floor(b[2]) + 1 - std::floor(b[0]);
       masked(t, to, [&](int x, int) { return x < std::floor(b[0]) + width - n * std::floor(width / n); });
     },
     {32, 8192, -1}},
    {"of the polygon that is left where a triangle is cut at the target's borders only the first %d corners are drawn",
     [](const Triangle& t, Drawing& to, int n) {
       paint_fan(to, cut_at_target(t, to, New::right), static_cast<std::size_t>(n));
     },
     {3, 6, 1}},
    {"where a triangle is cut at the target's borders one new vertex of two is lost: a corner is cut off",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_target(t, to, New::lost)); }},
    {"where a triangle is cut at the target's borders both new vertices are the same one",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_target(t, to, New::same_twice)); }},
    {"where a triangle is cut at the target's borders new vertices are in the wrong place: at 1 - t in place of t",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_target(t, to, New::at_other_part)); }},
    {"where a triangle is cut at the target's borders new vertices lie half-way between the old ones",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_target(t, to, New::half_way)); }},
};

}  // namespace

std::string about_ways_of_filling(const Questions& questions) {
  std::size_t wrong = 0;
  std::vector<Shown> all;
  const auto add = [&all](std::vector<Shown> more) {
    for (Shown& shown : more) all.push_back(std::move(shown));
  };
  // On a wide target and a high one, on one of many tiles, and slivers.
  add(shown_of(questions, 0x9A55, 8, 24, 14, [](Random& random, int, int) {
    return random_corner(random, {0, 24}, {0, 14});
  }));
  add(shown_of(questions, 0x9A58, 8, 14, 24, [](Random& random, int, int) {
    return random_corner(random, {0, 14}, {0, 24});
  }));
  add(shown_of(questions, 0x9A56, 8, 150, 140, [](Random& random, int, int) {
    return random_corner(random, {0, 150}, {0, 140});
  }));
  add(shown_of(questions, 0x9A57, 12, 70, 60, [](Random& random, int, int i) {
    return random_corner(random, {0, 70}, i == 2 ? Interval{50, 60} : Interval{4, 7});
  }));
  return guessed(questions, all, kPlain, wrong);
}

std::string about_reach(const Questions& questions) {
  std::size_t wrong = 0;
  const std::vector<Shown> all = shown_of(questions, 0x2EAC4, 48, 24, 16, [](Random& random, int n, int i) {
    // One, two or three vertices beyond the target, every second time far.
    const double far = n % 2 == 0 ? 30 : std::exp2(5 + 9 * random.unit());
    if (i > n / 2 % 3) return random_corner(random, {0, 24}, {0, 16});
    return random_corner(random, {-far, 24 + far}, {-far, 16 + far});
  });
  return guessed(questions, all, kReach, wrong);
}

}  // namespace surefill::judge
