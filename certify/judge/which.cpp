// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/which.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <numeric>
#include <vector>

#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

constexpr std::size_t kLeast = 3;  // of either kind, or nothing is said

// A number between the two that people write: whole, or of one or two digits.
double round_between(double low, double high) {
  for (const double unit : {100.0, 10.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.01, 0.001, 0.0001}) {
    for (const double value : {std::ceil(low / unit) * unit, std::floor(high / unit) * unit}) {
      if (value > low && value <= high && value != 0) return value;
    }
  }
  return high;
}

// --- a property that tells wrong ones from right ones

template <typename Thing>
struct Property {
  const char* more;                  // "that are more than %.4g pixels wide"; with "%" the number
  const char* less;                  // null: of no interest
  double (*of)(const Thing& thing);  // NaN: it has none
};

template <typename Thing>
struct Yes {
  const char* text;
  bool (*has)(const Thing& thing);
};

// Nineteen of twenty on either side.
template <typename Thing, typename Has>
bool tells_apart(std::span<const Thing> wrong, std::span<const Thing> right, const Has& has) {
  const auto with = static_cast<std::size_t>(std::count_if(wrong.begin(), wrong.end(), has));
  const auto other = static_cast<std::size_t>(std::count_if(right.begin(), right.end(), has));
  return 20 * with >= 19 * wrong.size() && 20 * other <= right.size();
}

template <typename Thing>
std::string difference(std::span<const Thing> wrong, std::span<const Thing> right, std::span<const Yes<Thing>> yes,
                       std::span<const Property<Thing>> properties) {
  if (wrong.size() < kLeast || right.size() < kLeast) return "";
  for (const Yes<Thing>& one : yes) {
    if (tells_apart(wrong, right, one.has)) return one.text;
  }
  // Of numbers, the one with the widest gap.
  std::string best;
  double widest = 1;
  for (const Property<Thing>& property : properties) {
    std::vector<double> a, b;
    for (const Thing& thing : wrong) a.push_back(property.of(thing));
    for (const Thing& thing : right) b.push_back(property.of(thing));
    const auto unknown = [](double value) { return std::isnan(value); };
    if (std::any_of(a.begin(), a.end(), unknown)) continue;
    std::erase_if(b, unknown);
    if (b.size() < kLeast) continue;
    const auto [least_wrong, most_wrong] = std::minmax_element(a.begin(), a.end());
    const auto [least_right, most_right] = std::minmax_element(b.begin(), b.end());
    const auto consider = [&](double low, double high, const char* form) {
      if (!form || !(low < high)) return;
      const double gap = low > 0 ? high / low : 2;
      if (gap < widest) return;
      widest = gap;
      best = text(form, round_between(low, high));
    };
    consider(*most_wrong, *least_right, property.less);
    consider(*most_right, *least_wrong, property.more);
  }
  return best;
}

// --- triangles

struct Triangle {
  std::array<SceneVertex, 3> v{};
  int width = 0, height = 0;
  std::uint64_t right = 0, rival = 0;  // counts
  bool lacks = false, more = false;    // samples that it should have, and others
  // Of the rows and columns that it has: is all that is wrong in the first, the last? None, where it has one only.
  std::array<std::optional<bool>, 4> in_row_or_column;
};

bool in_front(const Triangle& t) {
  return std::all_of(t.v.begin(), t.v.end(), [](const SceneVertex& v) { return v.w > 0; });
}
std::array<double, 3> xs(const Triangle& t) {
  return {double{t.v[0].x} / t.v[0].w, double{t.v[1].x} / t.v[1].w, double{t.v[2].x} / t.v[2].w};
}
std::array<double, 3> ys(const Triangle& t) {
  return {double{t.v[0].y} / t.v[0].w, double{t.v[1].y} / t.v[1].w, double{t.v[2].y} / t.v[2].w};
}
std::array<double, 3> zs(const Triangle& t) {
  return {double{t.v[0].z} / t.v[0].w, double{t.v[1].z} / t.v[1].w, double{t.v[2].z} / t.v[2].w};
}
double extent(const std::array<double, 3>& a) {
  const auto [low, high] = std::minmax({a[0], a[1], a[2]});
  return high - low;
}
double turn(const Triangle& t) {
  const auto x = xs(t), y = ys(t);
  return (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
}
template <typename Of>
double if_in_front(const Triangle& t, const Of& of) {
  return in_front(t) ? of() : std::nan("");
}
bool any(const std::array<double, 3>& a, double low, double high) {
  return std::any_of(a.begin(), a.end(), [&](double value) { return value < low || value > high; });
}

std::size_t behind(const Triangle& t) {
  return static_cast<std::size_t>(std::count_if(t.v.begin(), t.v.end(), [](const SceneVertex& v) { return v.w <= 0; }));
}

constexpr Yes<Triangle> kTrianglesWith[] = {
    {"with one vertex behind the eye (W <= 0), not those with two,", [](const Triangle& t) { return behind(t) == 1; }},
    {"with two vertices behind the eye (W <= 0), not those with one,",
     [](const Triangle& t) { return behind(t) == 2; }},
    {"with a vertex behind the eye (W <= 0)", [](const Triangle& t) { return !in_front(t); }},
    {"that face away (back faces, counter-clockwise)", [](const Triangle& t) { return in_front(t) && turn(t) < 0; }},
    {"that face the eye (front faces, clockwise)", [](const Triangle& t) { return in_front(t) && turn(t) > 0; }},
    {"that reach beyond the left border of the target",
     [](const Triangle& t) { return in_front(t) && any(xs(t), 0, INFINITY); }},
    {"that reach beyond the upper border of the target",
     [](const Triangle& t) { return in_front(t) && any(ys(t), 0, INFINITY); }},
    {"that reach beyond the right border of the target",
     [](const Triangle& t) { return in_front(t) && any(xs(t), -INFINITY, t.width); }},
    {"that reach beyond the lower border of the target",
     [](const Triangle& t) { return in_front(t) && any(ys(t), -INFINITY, t.height); }},
    {"that reach beyond the target",
     [](const Triangle& t) { return !in_front(t) || any(xs(t), 0, t.width) || any(ys(t), 0, t.height); }},
    {"with a depth beyond 0 to 1", [](const Triangle& t) { return in_front(t) && any(zs(t), 0, 1); }},
    {"with a depth below 0", [](const Triangle& t) { return in_front(t) && any(zs(t), 0, INFINITY); }},
    {"with a depth above 1", [](const Triangle& t) { return in_front(t) && any(zs(t), -INFINITY, 1); }},
    {"whose vertices differ in W (perspective)",
     [](const Triangle& t) { return t.v[0].w != t.v[1].w || t.v[0].w != t.v[2].w; }},
    {"whose vertices all have one W (no perspective)",
     [](const Triangle& t) { return t.v[0].w == t.v[1].w && t.v[0].w == t.v[2].w; }},
    {"whose vertices have a W other than 1",
     [](const Triangle& t) { return t.v[0].w != 1 || t.v[1].w != 1 || t.v[2].w != 1; }},
    {"with a level upper edge",
     [](const Triangle& t) {
       const auto y = ys(t);
       const double top = std::min({y[0], y[1], y[2]});
       return in_front(t) && std::count(y.begin(), y.end(), top) == 2;
     }},
    {"with a level lower edge",
     [](const Triangle& t) {
       const auto y = ys(t);
       const double bottom = std::max({y[0], y[1], y[2]});
       return in_front(t) && std::count(y.begin(), y.end(), bottom) == 2;
     }},
    {"with a level edge",
     [](const Triangle& t) {
       const auto y = ys(t);
       return in_front(t) && (y[0] == y[1] || y[1] == y[2] || y[0] == y[2]);
     }},
    {"with an upright edge",
     [](const Triangle& t) {
       const auto x = xs(t);
       return in_front(t) && (x[0] == x[1] || x[1] == x[2] || x[0] == x[2]);
     }},
};

constexpr Property<Triangle> kTriangleNumbers[] = {
    {"that are more than %.4g pixels high", "that are less than %.4g pixels high (thin or small ones)",
     [](const Triangle& t) { return if_in_front(t, [&t] { return extent(ys(t)); }); }},
    {"that are more than %.4g pixels wide", "that are less than %.4g pixels wide (thin or small ones)",
     [](const Triangle& t) { return if_in_front(t, [&t] { return extent(xs(t)); }); }},
    {"that are larger than %.4g pixels (wide or high)", "that are smaller than %.4g pixels (wide and high)",
     [](const Triangle& t) { return if_in_front(t, [&t] { return std::max(extent(xs(t)), extent(ys(t))); }); }},
    {"whose box is more than %.4g pixels wide and high", "that are thinner than %.4g pixels",
     [](const Triangle& t) { return if_in_front(t, [&t] { return std::min(extent(xs(t)), extent(ys(t))); }); }},
    {"with an area of more than %.4g square pixels (large ones)",
     "with an area of less than %.4g square pixels (small ones)",
     [](const Triangle& t) { return if_in_front(t, [&t] { return std::abs(turn(t)) / 2; }); }},
    {"that reach farther than %.4g pixels from the origin", nullptr,
     [](const Triangle& t) {
       return if_in_front(t, [&t] {
         double most = 0;
         for (const auto& a : {xs(t), ys(t)}) {
           for (const double value : a) most = std::max(most, std::abs(value));
         }
         return most;
       });
     }},
    {"with a W above %.4g", nullptr,
     [](const Triangle& t) {
       return double{std::max({t.v[0].w, t.v[1].w, t.v[2].w})};
     }},
    {nullptr, "with a W below %.4g",
     [](const Triangle& t) {
       return if_in_front(t, [&t] { return double{std::min({t.v[0].w, t.v[1].w, t.v[2].w})}; });
     }},
};

Scene alone(const Scene& scene, std::size_t d, std::size_t t) {
  Scene one = scene;
  one.draws = {scene.draws[d]};
  one.draws[0].triangles = {scene.draws[d].triangles[t]};
  return one;
}

// Up to `most` triangles of the scene, each with the scene that it is alone in.
template <typename Take>
void each_alone(const Scene& scene, std::size_t most, const Take& take) {
  std::vector<std::array<std::size_t, 2>> all;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    if (scene.draws[d].viewport) continue;
    for (std::size_t t = 0; t < scene.draws[d].triangles.size(); ++t) all.push_back({d, t});
  }
  const std::size_t step = std::max<std::size_t>(1, all.size() / most);
  for (std::size_t i = 0; i < all.size(); i += step) {
    const SceneDraw& draw = scene.draws[all[i][0]];
    Triangle triangle;
    triangle.width = scene.width;
    triangle.height = scene.height;
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.v[k] = draw.vertices[draw.triangles[all[i][1]].vertices[k]];
      const SceneVertex& v = triangle.v[k];
      finite = finite && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
    }
    if (finite) take(triangle, alone(scene, all[i][0], all[i][1]));
  }
}

bool take_counts(const Image& right, const Image& rival, Triangle& triangle) {
  if (right.count.size() != rival.count.size() || right.samples != 1) return right.count.size() == rival.count.size();
  std::array<int, 4> all{INT_MAX, INT_MIN, INT_MAX, INT_MIN}, wrong = all;  // first and last row, first and last column
  for (std::size_t s = 0; s < right.count.size(); ++s) {
    triangle.right += right.count[s];
    triangle.rival += rival.count[s];
    triangle.lacks = triangle.lacks || rival.count[s] < right.count[s];
    triangle.more = triangle.more || rival.count[s] > right.count[s];
    const int x = static_cast<int>(s) % right.width, y = static_cast<int>(s) / right.width;
    const auto widen = [x, y](std::array<int, 4>& box) {
      box = {std::min(box[0], y), std::max(box[1], y), std::min(box[2], x), std::max(box[3], x)};
    };
    if (right.count[s] != 0 || rival.count[s] != 0) widen(all);
    if (right.count[s] != rival.count[s]) widen(wrong);
  }
  for (std::size_t i = 0; i < 4 && wrong[0] <= wrong[1]; ++i) {
    const std::size_t first = i / 2 * 2;
    if (all[first] == all[first + 1]) continue;
    triangle.in_row_or_column[i] = wrong[first] == all[i] && wrong[first + 1] == all[i];
  }
  return true;
}

// All that is wrong lies in the first or last row or column that the triangle has.
std::string where_in_triangles(std::span<const Triangle> wrong) {
  constexpr std::array<const char*, 4> kNames{"first row", "last row", "first column", "last column"};
  for (std::size_t i = 0; i < 4; ++i) {
    std::size_t known = 0, inside = 0;
    for (const Triangle& t : wrong) {
      known += t.in_row_or_column[i].has_value();
      inside += t.in_row_or_column[i].value_or(false);
    }
    if (known < kLeast || 20 * inside < 19 * known) continue;
    return std::string(" in the ") + kNames[i] + " that a triangle reaches (the border of its box)";
  }
  return "";
}

std::string what_becomes(std::span<const Triangle> wrong) {
  const auto all = [&wrong](const auto& is) { return std::all_of(wrong.begin(), wrong.end(), is); };
  if (all([](const Triangle& t) { return t.rival == 0 && t.right > 0; })) return "are not drawn";
  if (all([](const Triangle& t) { return t.right == 0 && t.rival > 0; })) return "are drawn where they cover nothing";
  if (all([](const Triangle& t) { return t.lacks && !t.more; })) return "lack samples";
  if (all([](const Triangle& t) { return t.more && !t.lacks; })) return "cover samples that they should not";
  if (all([](const Triangle& t) { return !t.more && !t.lacks; })) return "have wrong values";
  return "are wrong";
}

// --- scenes

std::size_t triangles_of(const Scene& scene) {
  return std::accumulate(scene.draws.begin(), scene.draws.end(), std::size_t{0},
                         [](std::size_t n, const SceneDraw& draw) { return n + draw.triangles.size(); });
}

constexpr Yes<const Scene*> kScenesWith[] = {
    {"targets of an odd width", [](const Scene* const& s) { return s->width % 2 == 1; }},
    {"targets of an odd height", [](const Scene* const& s) { return s->height % 2 == 1; }},
    {"targets whose width is no multiple of 4", [](const Scene* const& s) { return s->width % 4 != 0; }},
    {"targets whose height is no multiple of 4", [](const Scene* const& s) { return s->height % 4 != 0; }},
    {"targets whose width is no multiple of 8", [](const Scene* const& s) { return s->width % 8 != 0; }},
    {"targets whose height is no multiple of 8", [](const Scene* const& s) { return s->height % 8 != 0; }},
    {"targets that are wider than high", [](const Scene* const& s) { return s->width > s->height; }},
    {"targets that are higher than wide", [](const Scene* const& s) { return s->width < s->height; }},
    {"targets that are not square", [](const Scene* const& s) { return s->width != s->height; }},
};

constexpr Property<const Scene*> kSceneNumbers[] = {
    {"targets of %.4g pixels and more", "targets under %.4g pixels",
     [](const Scene* const& s) { return double(s->width) * s->height; }},
    {"targets %.4g pixels wide and more", "targets under %.4g pixels wide",
     [](const Scene* const& s) { return double(s->width); }},
    {"targets %.4g pixels high and more", "targets under %.4g pixels high",
     [](const Scene* const& s) { return double(s->height); }},
    {"frames of %.4g triangles and more", nullptr, [](const Scene* const& s) { return double(triangles_of(*s)); }},
    {"frames of %.4g draws and more", nullptr, [](const Scene* const& s) { return double(s->draws.size()); }},
};

}  // namespace

std::string which_triangles(std::span<const Wrong> wrong, std::span<const Scene> fine, const Trials& trials) {
  constexpr std::size_t kOfScene = 6, kWrong = 60, kRight = 120;
  std::vector<Triangle> bad, good;
  std::size_t scenes = 0, shown = 0;
  const auto look = [&](const Scene& scene) {
    bool found = false;
    each_alone(scene, kOfScene, [&](Triangle triangle, const Scene& one) {
      if (bad.size() >= kWrong && good.size() >= kRight) return;
      const bool is_wrong = trials.still_wrong(one);
      if (is_wrong ? bad.size() >= kWrong : good.size() >= kRight) return;
      const std::optional<Wrong> images = trials.draw(one);
      if (!images || !take_counts(images->right, images->rival, triangle)) return;
      // What covers nothing either way tells nothing.
      if (triangle.right == 0 && triangle.rival == 0) return;
      (is_wrong ? bad : good).push_back(triangle);
      found = found || is_wrong;
    });
    return found;
  };
  for (const Wrong& one : wrong) {
    ++scenes;
    shown += look(one.scene);
  }
  // If it takes several triangles, no single one is to blame.
  if (3 * shown < 2 * scenes) return "";
  for (const Scene& scene : fine) look(scene);
  const std::string which = difference<Triangle>(bad, good, kTrianglesWith, kTriangleNumbers);
  if (!which.empty()) return "triangles " + which + " " + what_becomes(bad) + ", and no others";
  const std::string where = where_in_triangles(bad);
  return where.empty() ? "" : "triangles " + what_becomes(bad) + where;
}

std::string which_scenes(std::span<const Wrong> wrong, std::span<const Scene> fine) {
  std::vector<const Scene*> bad, good;
  for (const Wrong& one : wrong) bad.push_back(&one.scene);
  for (const Scene& scene : fine) good.push_back(&scene);
  const std::string which = difference<const Scene*>(bad, good, kScenesWith, kSceneNumbers);
  if (which.empty()) return "";
  const bool nothing = std::all_of(wrong.begin(), wrong.end(), [](const Wrong& w) {
    return std::all_of(w.rival.count.begin(), w.rival.count.end(), [](std::uint32_t n) { return n == 0; });
  });
  return nothing ? "nothing at all is drawn on " + which : which + " are wrong, and no others";
}

std::string how_near_edges(std::span<const Wrong> wrong) {
  double farthest = 0;
  std::size_t scenes = 0, samples = 0;
  for (const Wrong& one : wrong) {
    if (one.right.samples != 1 || one.right.count.size() != one.rival.count.size()) continue;
    bool counted = false;
    for (std::size_t s = 0; s < one.right.count.size(); ++s) {
      if (one.right.count[s] == one.rival.count[s]) continue;
      const auto width = static_cast<std::size_t>(one.scene.width);
      const double x = static_cast<double>(s % width) + 0.5 + one.scene.origin.x;
      const double y = static_cast<double>(s / width) + 0.5 + one.scene.origin.y;
      double nearest = INFINITY;
      for (const SceneDraw& draw : one.scene.draws) {
        if (draw.viewport) return "";
        for (const corpus::SceneTriangle& t : draw.triangles) {
          for (std::size_t i = 0; i < 3; ++i) {
            const SceneVertex &p = draw.vertices[t.vertices[i]], &q = draw.vertices[t.vertices[(i + 1) % 3]];
            const double a = double{p.y} * q.w - double{p.w} * q.y, b = double{p.w} * q.x - double{p.x} * q.w;
            const double c = double{p.x} * q.y - double{p.y} * q.x, length = std::hypot(a, b);
            if (length > 0 && std::isfinite(c)) nearest = std::min(nearest, std::abs(a * x + b * y + c) / length);
          }
        }
      }
      farthest = std::max(farthest, nearest);
      ++samples;
      counted = true;
    }
    scenes += counted;
  }
  if (scenes < kLeast || samples == 0 || !(farthest < 1.0 / 16)) return "";
  if (farthest < 0x1p-36)
    return "samples are wrong only where an edge passes exactly through them: ties, by the fill rule";
  const int k = -static_cast<int>(std::ceil(std::log2(farthest)));
  return "samples are wrong only within 2^-" + std::to_string(k) + " pixels of an edge (" +
         text("%.2g", std::ldexp(1, -k)) + " px): edges are not precise enough, as by rounding";
}

}  // namespace surefill::judge
