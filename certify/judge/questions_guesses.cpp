// SPDX-License-Identifier: Apache-2.0
//
// What becomes of a triangle on its way to its samples, guessed: each guess draws the triangles that were asked for, in
// double and by geometry alone, and is said if it draws every one of them as the rival does, the right ones, too.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "certify/judge/drawings.hpp"
#include "certify/judge/questions.hpp"

namespace surefill::judge {

namespace {

using corpus::Scene;
using corpus::SceneVertex;
using drawings::at;
using drawings::box_of;
using drawings::divided;
using drawings::Drawing;
using drawings::kOpen;
using drawings::paint;
using drawings::paint_fan;
using drawings::Point;
using drawings::Polygon;
using drawings::scan_lines;
using drawings::Triangle;
using drawings::unrejected_blocks;
using drawings::until_an_empty_row;

// --- the guesses

struct Guess {
  const char* text;  // with %d for the number
  void (*draw)(const Triangle& t, Drawing& to, int number);
  std::array<int, 3> numbers{0, 0, 1};  // first, last, step: of a negative step, twice as much each time
};

template <class Change>
void changed(Triangle t, Drawing& to, const Change& change) {
  for (Point& p : t) {
    if (p.w > 0) p = at(p.x / p.w, p.y / p.w);
    change(p);
  }
  paint(to, t);
}

// Is it so of any, of all vertices?
template <class Is>
int how_many(const Triangle& t, const Is& is) {
  return static_cast<int>(std::count_if(t.begin(), t.end(), is));
}

// Sutherland and Hodgman at one plane, with what is done to a new vertex.
enum class New { right, at_other_part, half_way, same_twice, lost };
template <class Distance>
Polygon cut(const Polygon& polygon, const Distance& distance, New made = New::right) {
  Polygon result;
  std::optional<Point> first;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = distance(p), b = distance(q);
    if (a >= 0) result.push_back(p);
    if ((a >= 0) == (b >= 0)) continue;
    double part = a / (a - b);
    if (made == New::at_other_part) part = 1 - part;
    if (made == New::half_way) part = 0.5;
    Point next = p + part * (q + -1.0 * p);
    if (made == New::same_twice && first) next = *first;
    first = next;
    if (made != New::lost || a >= 0) result.push_back(next);
  }
  return result;
}

constexpr double kEye = 1e-5;
Polygon cut_at_eye(const Triangle& t, New made = New::right) {
  return cut(
      {t[0], t[1], t[2]}, [](const Point& p) { return p.w - kEye; }, made);
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

template <class Keep>
void masked(const Triangle& t, Drawing& to, const Keep& keep) {
  paint(to, t);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      int& count = to.counts[static_cast<std::size_t>(y * to.width + x)];
      if (count < kOpen && !keep(x, y)) count = 0;
    }
  }
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

template <class Dropped>
void unless(const Triangle& t, Drawing& to, const Dropped& dropped) {
  if (!dropped()) paint(to, t);
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

// --- of triangles with vertices behind the eye

int behind(const Triangle& t) {
  return how_many(t, [](const Point& p) { return p.w <= 0; });
}

constexpr Guess kBehind[] = {
    {"triangles with a vertex behind the eye (W <= 0) are rejected by X/W and Y/W, as if all of them were in front: "
     "some that "
     "are seen are lost",
     [](const Triangle& t, Drawing& to, int) {
       const double width = to.width, height = to.height;
       unless(t, to, [&] {
         return how_many(t, [](const Point& p) { return divided(p.x, p) < 0; }) == 3 ||
                how_many(t, [](const Point& p) { return divided(p.y, p) < 0; }) == 3 ||
                how_many(t, [width](const Point& p) { return divided(p.x, p) > width; }) == 3 ||
                how_many(t, [height](const Point& p) { return divided(p.y, p) > height; }) == 3;
       });
     }},
    {"a triangle with a vertex behind the eye (W <= 0) is not drawn at all",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return behind(t) > 0; }); }},
    {"a triangle with one vertex behind the eye (W <= 0) is not drawn at all; those with two are",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return behind(t) == 1; }); }},
    {"a triangle with two vertices behind the eye (W <= 0) is not drawn at all; those with one are",
     [](const Triangle& t, Drawing& to, int) { unless(t, to, [&] { return behind(t) == 2; }); }},
    {"vertices behind the eye are divided by W as if it were positive: the triangle through all three projected points "
     "is drawn, "
     "a mirror image, as nothing is cut at the eye's plane",
     [](const Triangle& t, Drawing& to, int) {
       paint(to, {at(t[0].x / t[0].w, t[0].y / t[0].w), at(t[1].x / t[1].w, t[1].y / t[1].w),
                  at(t[2].x / t[2].w, t[2].y / t[2].w)});
     }},
    {"W is taken without its sign: vertices behind the eye are divided by |W|",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = std::abs(p.w);
       paint(to, other);
     }},
    {"W below 1/%d is taken for 1/%d: vertices behind the eye are moved before it, instead of triangles being cut "
     "there",
     [](const Triangle& t, Drawing& to, int n) {
       Triangle other = t;
       for (Point& p : other) p.w = std::max(p.w, 1.0 / n);
       paint(to, other);
     },
     {1, 1 << 20, -1}},
    {"where a triangle is cut at the eye's plane and four corners are left only one of the polygon's two triangles is "
     "drawn",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_eye(t), 3); }},
    {"where a triangle is cut at the eye's plane and four corners are left only one of the polygon's two triangles is "
     "drawn: the "
     "first one is lost",
     [](const Triangle& t, Drawing& to, int) {
       const Polygon p = cut_at_eye(t);
       if (p.size() == 4)
         paint(to, {p[0], p[2], p[3]});
       else
         paint_fan(to, p);
     }},
    {"the polygon of four corners that cutting at the eye's plane leaves is drawn as a strip, not a fan: its triangles "
     "overlap",
     [](const Triangle& t, Drawing& to, int) {
       const Polygon p = cut_at_eye(t);
       for (std::size_t i = 0; i + 2 < p.size(); ++i) paint(to, {p[i], p[i + 1], p[i + 2]});
     }},
    {"of the polygon of four corners that cutting at the eye's plane leaves the last triangle is drawn twice",
     [](const Triangle& t, Drawing& to, int) {
       const Polygon p = cut_at_eye(t);
       paint_fan(to, p);
       if (p.size() == 4) paint(to, {p[0], p[2], p[3]});
     }},
    {"where a triangle is cut at the eye's plane new vertices are in the wrong place: at 1 - t in place of t (its ends "
     "exchanged)",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_eye(t, New::at_other_part)); }},
    {"where a triangle is cut at the eye's plane new vertices lie half-way between the old ones",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_eye(t, New::half_way)); }},
    {"where a triangle is cut at the eye's plane both new vertices are the same one",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_eye(t, New::same_twice)); }},
    {"where a triangle is cut at the eye's plane only one new vertex of two is made: a corner is lost",
     [](const Triangle& t, Drawing& to, int) { paint_fan(to, cut_at_eye(t, New::lost)); }},
    {"where W is not positive vertices are not divided by it: W is taken for 1",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = p.w > 0 ? p.w : 1;
       paint(to, other);
     }},
    {"cutting at the eye's plane cuts at W = 1/%d: what is nearer is lost",
     [](const Triangle& t, Drawing& to, int n) {
       paint_fan(to, cut({t[0], t[1], t[2]}, [n](const Point& p) { return p.w - 1.0 / n; }));
     },
     {1, 64, -1}},
};

// --- of triangles in perspective, in front of the eye

constexpr Guess kPerspective[] = {
    {"vertices are not divided by W: X and Y are taken for positions",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = 1;
       paint(to, other);
     }},
    {"all vertices are divided by the W of the first one",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = t[0].w;
       paint(to, other);
     }},
    {"a W below 1 is taken for 1",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = std::max(p.w, 1.0);
       paint(to, other);
     }},
    {"W is rounded down to a whole number",
     [](const Triangle& t, Drawing& to, int) {
       Triangle other = t;
       for (Point& p : other) p.w = std::max(std::floor(p.w), 1.0);
       paint(to, other);
     }},
    {"nothing of a W below 1 is drawn: triangles are cut there",
     [](const Triangle& t, Drawing& to, int) {
       paint_fan(to, cut({t[0], t[1], t[2]}, [](const Point& p) { return p.w - 1; }));
     }},
    {"a triangle with a vertex of W below 1 is not drawn",
     [](const Triangle& t, Drawing& to, int) {
       unless(t, to, [&] { return how_many(t, [](const Point& p) { return p.w < 1; }) > 0; });
     }},
};

// --- asking

struct Shown {
  Triangle triangle;
  int width, height;
  std::vector<std::uint32_t> counts;
};

std::optional<Shown> show(const Questions& questions, const Scene& scene) {
  const auto image = questions.rival(scene);
  if (!image || image->count.empty()) return std::nullopt;
  Shown shown{{}, scene.width, scene.height, image->count};
  for (std::size_t i = 0; i < 3; ++i) {
    const SceneVertex& v = scene.draws[0].vertices[scene.draws[0].triangles[0].vertices[i]];
    shown.triangle[i] = {double{v.x}, double{v.y}, double{v.w}};
  }
  return shown;
}

template <class Draw>
bool explains(const Questions& questions, const Shown& shown, const Draw& draw) {
  Drawing drawing{shown.width, shown.height, questions.model.x.place, questions.model.y.place,
                  std::vector<int>(shown.counts.size(), 0)};
  draw(shown.triangle, drawing);
  for (std::size_t s = 0; s < shown.counts.size(); ++s) {
    const int n = drawing.counts[s];
    if (n < kOpen && n != static_cast<int>(shown.counts[s])) return false;
  }
  return true;
}

std::string guessed(const Questions& questions, std::span<const Shown> all, std::span<const Guess> guesses,
                    std::size_t& wrong) {
  std::vector<const Shown*> bad, good;
  for (const Shown& shown : all) {
    const bool right = explains(questions, shown, [](const Triangle& t, Drawing& to) { paint(to, t); });
    (right ? good : bad).push_back(&shown);
  }
  wrong = bad.size();
  if (bad.size() < 3) return "";
  bad.insert(bad.end(), good.begin(), good.end());  // the wrong ones tell sooner
  for (const Guess& guess : guesses) {
    const auto [first, last, step] = guess.numbers;
    for (int n = first; n <= last; n += step < 0 ? n : step) {
      const bool fits = std::ranges::all_of(bad, [&](const Shown* shown) {
        return explains(questions, *shown, [&](const Triangle& t, Drawing& to) { guess.draw(t, to, n); });
      });
      if (!fits) continue;
      std::array<char, 256> buffer{};
      std::snprintf(buffer.data(), buffer.size(), guess.text, n, n);
      return buffer.data();
    }
  }
  return "";
}

// A triangle of which some of the target is covered, and some is not.
bool is_seen(const std::array<SceneVertex, 3>& c, int width, int height) {
  Drawing drawing{width, height, 0.5, 0.5, std::vector<int>(static_cast<std::size_t>(width * height), 0)};
  Triangle t{};
  for (std::size_t i = 0; i < 3; ++i) t[i] = {double{c[i].x}, double{c[i].y}, double{c[i].w}};
  paint(drawing, t);
  const auto covered = std::ranges::count(drawing.counts, 1);
  return covered >= 12 && covered <= width * height - 12;
}

template <class Corner>
std::vector<Shown> shown_of(const Questions& questions, std::uint64_t seed, int scenes, int width, int height,
                            const Corner& corner_of) {
  Random random(seed);
  std::vector<Shown> all;
  for (int n = 0; n < scenes; ++n) {
    Scene scene = empty_scene(width, height);
    std::array<SceneVertex, 3> c{};
    int tries = 0;
    do {
      for (int i = 0; i < 3; ++i) c[static_cast<std::size_t>(i)] = corner_of(random, n, i);
    } while (!is_seen(c, width, height) && ++tries < 300);
    if (tries == 300) continue;
    add_triangle(scene.draws[0], c, questions.model.culled);
    if (auto shown = show(questions, scene)) all.push_back(std::move(*shown));
  }
  return all;
}

}  // namespace

std::string about_ways_of_filling(const Questions& questions) {
  std::size_t wrong = 0;
  // Some on a target of many tiles, and small ones.
  std::vector<Shown> all = shown_of(questions, 0x9A55, 8, 24, 14, [](Random& random, int, int) {
    return corner(eighth(random, 0, 24), eighth(random, 0, 14));
  });
  for (Shown& shown : shown_of(questions, 0x9A56, 8, 150, 140, [](Random&random, int, int) {
         return corner(eighth(random, 0, 150), eighth(random, 0, 140));
       })) {
    all.push_back(std::move(shown));
  }
  for (Shown& shown : shown_of(questions, 0x9A57, 12, 70, 60, [](Random&random, int, int i) {
         return corner(eighth(random, 0, 70), i == 2 ? eighth(random, 50, 60) : eighth(random, 4, 7));
       })) {
    all.push_back(std::move(shown));
  }
  return guessed(questions, all, kPlain, wrong);
}

std::string about_reach(const Questions& questions) {
  std::size_t wrong = 0;
  const std::vector<Shown> all = shown_of(questions, 0x2EAC4, 48, 24, 16, [](Random& random, int n, int i) {
    // One, two or three vertices beyond the target, every second time far.
    const double far = n % 2 == 0 ? 30 : std::exp2(5 + 9 * random.unit());
    if (i > n / 2 % 3) return corner(eighth(random, 0, 24), eighth(random, 0, 16));
    return corner(eighth(random, -far, 24 + far), eighth(random, -far, 16 + far));
  });
  return guessed(questions, all, kReach, wrong);
}

std::string about_eye(const Questions& questions) {
  std::size_t wrong = 0;
  const std::vector<Shown> all = shown_of(questions, 0xE1E, 32, 16, 16, [](Random& random, int n, int i) {
    const double x = eighth(random, -8, 24), y = eighth(random, -8, 24);
    if (i == n / 2 % 3 || (n % 2 == 1 && i == (n / 2 + 1) % 3)) {
      SceneVertex v = corner(x, y, 0.5, -std::nearbyint((0.5 + random.unit()) * 16) / 16);
      // Where it is of itself, not its mirror image.
      v.x = static_cast<float>(eighth(random, -24, 40)), v.y = static_cast<float>(eighth(random, -24, 40));
      return v;
    }
    return corner(x, y, 0.5, n % 4 < 2 ? 1 : 2);
  });
  if (std::string found = guessed(questions, all, kBehind, wrong); !found.empty()) return found;
  Scene scene = empty_scene(16, 16);
  add_triangle(scene.draws[0], {corner(1.125, 1.25), corner(14.5, 2.125), corner(2.25, 14.625)});
  const auto inside = [&questions](const Scene& of) {
    const auto image = questions.rival(of);
    return image && !image->count.empty() ? static_cast<int>(image->count[4 * 16 + 4]) : -1;
  };
  if (questions.model.culled != Cull::none || inside(scene) != 1) return "";
  Scene mirrored = scene;
  for (SceneVertex& v : mirrored.draws[0].vertices) v.x = -v.x, v.y = -v.y, v.z = -v.z, v.w = -1;
  if (inside(mirrored) == 1)
    return "a triangle wholly behind the eye (all W < 0) is drawn, as its mirror image in front of it";
  // From the left border to infinity on the right.
  scene.draws[0].vertices[1] = {8, 1, 0.5, 0, {}};
  scene.draws[0].vertices[2] = corner(1.25, 14.5);
  if (inside(scene) == 0 && wrong == 0) return "a triangle with a vertex at infinity (W = 0) is not drawn";
  return "";
}

std::string about_perspective(const Questions& questions) {
  std::size_t wrong = 0;
  const std::vector<Shown> all = shown_of(questions, 0x3E25, 24, 16, 16, [](Random& random, int, int) {
    constexpr std::array<double, 6> kW{0.25, 0.5, 0.75, 1, 1.5, 4};
    return corner(eighth(random, 0, 16), eighth(random, 0, 16), 0.5, kW[static_cast<std::size_t>(random.below(6))]);
  });
  return guessed(questions, all, kPerspective, wrong);
}

}  // namespace surefill::judge
