// SPDX-License-Identifier: Apache-2.0
//
// Questions about W: triangles in perspective, and with vertices behind the eye.
#include <cmath>

#include "certify/judge/guesses.hpp"

namespace surefill::judge {

namespace {

using corpus::Scene;
using corpus::SceneVertex;
using drawings::at;
using drawings::divided;
using drawings::Drawing;
using drawings::paint;
using drawings::paint_fan;
using drawings::Point;
using drawings::Polygon;
using drawings::Triangle;
using guesses::cut;
using guesses::Guess;
using guesses::guessed;
using guesses::how_many;
using guesses::New;
using guesses::Shown;
using guesses::shown_of;
using guesses::unless;

constexpr double kEye = 1e-5;
Polygon cut_at_eye(const Triangle& t, New made = New::right) {
  return cut(
      {t[0], t[1], t[2]}, [](const Point& p) { return p.w - kEye; }, made);
}

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

}  // namespace

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
    const double w = kW[static_cast<std::size_t>(random.below(6))];
    return random_corner(random, {0, 16}, {0, 16}, 0.5, w);
  });
  return guessed(questions, all, kPerspective, wrong);
}

}  // namespace surefill::judge
