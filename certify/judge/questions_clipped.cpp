// SPDX-License-Identifier: Apache-2.0
//
// Questions about the values of triangles that are cut: behind the eye, beyond the target, where depth is clipped. Plain
// triangles have the right ones, or nobody asks this. And about arrays of attributes that are not of one size.
#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/drawings.hpp"
#include "certify/judge/questions.hpp"
#include "certify/judge/room.hpp"
#include "certify/judge/text.hpp"
#include "certify/judge/ways.hpp"

namespace surefill::judge {

namespace {

using corpus::Scene;
using corpus::SceneVertex;

constexpr int kSize = 16;

enum class Where { behind, beyond, clipped };
struct Place {
  const char* text;
  const char* plane;
  Where where;
};
constexpr Place kPlaces[] = {
    {"that reach beyond the target", "the target's borders", Where::beyond},  // as those behind the eye do, too
    {"with a vertex behind the eye (W <= 0)", "the eye's plane", Where::behind},
    {"that reach beyond depths 0 to 1, with depth clipping,", "depth 0 and 1", Where::clipped}};

// A triangle in such a place, of which the middle of the target shows some.
std::array<SceneVertex, 3> corners_in(Random& random, Where where, int number) {
  std::array<SceneVertex, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double w = std::ldexp(1.0, random.below(3)), z = std::nearbyint(64 * (0.1 + 0.8 * random.unit())) / 64;
    c[i] = random_corner(random, {-4, kSize + 4}, {-4, kSize + 4}, z, w);
    const bool chosen = i == static_cast<std::size_t>(number % 3) ||
                        (number % 2 == 1 && i == static_cast<std::size_t>((number + 1) % 3));
    if (!chosen) continue;
    if (where == Where::behind) {
      c[i].x = static_cast<float>(eighth(random, -24, 40)), c[i].y = static_cast<float>(eighth(random, -24, 40));
      c[i].w = static_cast<float>(-std::nearbyint((0.5 + random.unit()) * 16) / 16), c[i].z = c[i].w / 2;
    } else if (where == Where::beyond) {
      c[i] = random_corner(random, {-60, kSize + 60}, {-60, kSize + 60}, z, w);
    } else {
      c[i].z = static_cast<float>((number % 4 < 2 ? -0.75 : 1.75) * w);
    }
  }
  return c;
}

// Of all outputs, the samples that have one, and those whose value is another one.
struct Told {
  int samples = 0, wrong = 0;
  bool is_wrong() const { return samples >= 40 && 8 * wrong > samples; }
};

void tell(Told& told, const std::vector<float>& right, const std::vector<float>& got, std::size_t s, std::size_t n) {
  if (right.empty() || right.size() != got.size()) return;
  bool good = true;
  for (std::size_t i = n * s; i < n * (s + 1); ++i) good = good && alike(right[i], got[i]);
  ++told.samples, told.wrong += !good;
}

// What new vertices have of the old ones, as one cut after another makes them. `a` and `b` are weights of the three corners.
struct Cutting {
  const char* text;
  Three (*made)(const Three& inside, const Three& outside, double part);
};
Three between(const Three& a, const Three& b, double part) {
  Three result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] + part * (b[i] - a[i]);
  return result;
}
constexpr Cutting kCuttings[] = {
    {"those of the old vertex inside", [](const Three& inside, const Three&, double) { return inside; }},
    {"those of the old vertex outside", [](const Three&, const Three& outside, double) { return outside; }},
    {"taken at 1 - t in place of t",
     [](const Three& inside, const Three& outside, double part) { return between(outside, inside, part); }},
    {"half-way between those of the old ones",
     [](const Three& inside, const Three& outside, double) { return between(inside, outside, 0.5); }},
    {"0", [](const Three&, const Three&, double) {
       return Three{0, 0, 0};
     }}};

struct Made {
  drawings::Point at;
  double z;
  Three has;
};

// The weights of the three corners at (x, y), as the cut polygon's fan has them; none where that is not certain.
std::optional<Three> weights_at(const std::array<SceneVertex, 3>& c, Where where, const Cutting& cutting, double x,
                                double y) {
  std::vector<Made> polygon;
  for (std::size_t i = 0; i < 3; ++i) {
    Three own{0, 0, 0};
    own[i] = 1;
    polygon.push_back({{c[i].x, c[i].y, c[i].w}, c[i].z, own});
  }
  const auto cut = [&](const auto& distance) {
    std::vector<Made> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Made &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double a = distance(p), b = distance(q);
      if (a >= 0) result.push_back(p);
      if ((a >= 0) == (b >= 0)) continue;
      const Made &in = a >= 0 ? p : q, &out = a >= 0 ? q : p;
      const double part = distance(in) / (distance(in) - distance(out));
      result.push_back(
          {in.at + part * (out.at + -1.0 * in.at), in.z + part * (out.z - in.z), cutting.made(in.has, out.has, part)});
    }
    polygon = result;
  };
  if (where == Where::behind) cut([](const Made& m) { return m.at.w - 1e-5; });
  if (where == Where::clipped) {
    cut([](const Made& m) { return m.z; });
    cut([](const Made& m) { return m.at.w - m.z; });
  }
  if (where == Where::beyond) {
    cut([](const Made& m) { return m.at.x; });
    cut([](const Made& m) { return kSize * m.at.w - m.at.x; });
    cut([](const Made& m) { return m.at.y; });
    cut([](const Made& m) { return kSize * m.at.w - m.at.y; });
  }
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const std::array<const Made*, 3> t{&polygon[0], &polygon[i], &polygon[i + 1]};
    Three e{};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const drawings::Point &p = t[(k + 1) % 3]->at, &q = t[(k + 2) % 3]->at;
      e[k] = (p.y * q.w - p.w * q.y) * x + (p.w * q.x - p.x * q.w) * y + (p.x * q.y - p.y * q.x);
      sum += e[k];
    }
    if (std::min({e[0] / sum, e[1] / sum, e[2] / sum}) < 0) continue;
    Three weights{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) weights[j] += e[k] / sum * t[k]->has[j];
    }
    return weights;
  }
  return std::nullopt;
}

std::string about_place(const Questions& questions, const Place& place) {
  constexpr std::array<const char*, 3> kKinds{"attributes", "noperspective attributes", "flat attributes"};
  Random random(0xC117 + static_cast<std::uint64_t>(place.where));
  Told depth, weights;
  std::array<Told, 3> attributes;
  std::vector<std::size_t> good(std::size(kCuttings), 0);
  std::size_t all = 0;
  for (int n = 0; n < 24; ++n) {
    Scene scene = empty_scene(kSize, kSize);
    // No two kinds in one frame: not everybody draws that.
    const auto kind = static_cast<std::size_t>(n / 2 % 3);
    constexpr std::array<Interpolation, 3> kInterpolations{Interpolation::perspective, Interpolation::noperspective,
                                                           Interpolation::flat};
    scene.attributes = {{"a", 1, kInterpolations[kind]}};
    std::array<SceneVertex, 3> c = corners_in(random, place.where, n);
    Three values{};
    for (std::size_t i = 0; i < 3; ++i) {
      values[i] = std::nearbyint(64 * (4 * random.unit() - 2)) / 64;
      c[i].attributes = {static_cast<float>(values[i])};
    }
    if (place.where == Where::clipped) scene.draws[0].depth_mode = DepthMode::clip;
    add_triangle(scene.draws[0], c, questions.model.culled);
    const bool turned = scene.draws[0].triangles[0].vertices[1] != 1;
    auto shown = answer(questions, scene);
    if (!shown && kind == 1) continue;
    if (!shown) {
      scene.attributes.clear();
      for (SceneVertex& v : scene.draws[0].vertices) v.attributes.clear();
      shown = answer(questions, scene);
    }
    if (!shown || shown->right.count != shown->rival.count) return "";  // that is a question of its own
    for (std::size_t s = 0; s < shown->right.count.size(); ++s) {
      if (shown->right.count[s] != 1 || shown->open[s]) continue;
      tell(depth, shown->right.depth, shown->rival.depth, s, 1);
      tell(weights, shown->right.barycentrics, shown->rival.barycentrics, s, 3);
      if (shown->right.attributes.empty() || shown->rival.attributes.empty()) continue;
      tell(attributes[kind], shown->right.attributes[0], shown->rival.attributes[0], s, 1);
      if (kind != 0 || turned || shown->rival.attributes[0].empty()) continue;
      ++all;
      for (std::size_t k = 0; k < std::size(kCuttings); ++k) {
        const auto l =
            weights_at(c, place.where, kCuttings[k], static_cast<double>(s % kSize) + questions.model.x.place,
                       static_cast<double>(s / kSize) + questions.model.y.place);
        good[k] += l && close(mixed(*l, values), shown->rival.attributes[0][s], 2);
      }
    }
  }
  for (std::size_t k = 0; k < std::size(kCuttings) && attributes[0].is_wrong(); ++k) {
    if (20 * good[k] < 19 * all) continue;
    return std::string("where a triangle is cut at ") + place.plane + " the attributes of new vertices are " +
           kCuttings[k].text;
  }
  std::string which;
  for (std::size_t kind = 0; kind < 3; ++kind) {
    if (attributes[kind].is_wrong()) which += (which.empty() ? "" : ", ") + std::string(kKinds[kind]);
  }
  if (depth.is_wrong()) which += (which.empty() ? "" : ", ") + std::string("depths");
  if (weights.is_wrong()) which += (which.empty() ? "" : ", ") + std::string("barycentrics");
  if (which.empty()) return "";
  return "of triangles " + std::string(place.text) + " " + which +
         " are wrong, and of others right: where they are cut new vertices get wrong ones" +
         (attributes[2].is_wrong() && !attributes[0].is_wrong() ? ", as if one of them came first" : "");
}

// Values of triangles that begin left of and above the target, or a scissor: the place that they are of, by values that are
// the place. What is cut off there must be stepped over.
std::string about_begun_beyond(const Questions& questions) {
  // What is cut off: columns of the row, columns and rows of the triangle's box.
  constexpr std::array<const char*, 3> kForms{
      "left of the target or its scissor %s are those of another place: what of a row is cut off there is not stepped "
      "over",
      "left of the target or its scissor %s are those of another place: columns that are cut off there are not stepped "
      "over",
      "above the target or its scissor %s are those of another place: rows that are cut off there are not stepped "
      "over"};
  constexpr std::array<const char*, 3> kValues{"attributes", "depths", "attributes and depths"};
  Random random(0xBE60);
  struct Off {
    std::array<double, 3> cut;  // as kForms
    std::array<double, 2> by;   // in x and y
    std::array<bool, 2> known{true, true};
  };
  std::array<std::vector<Off>, 2> all;  // of attributes, of depths
  for (int n = 0; n < 16; ++n) {
    Scene scene = empty_scene(kSize, kSize);
    scene.attributes = {{"a", 2, Interpolation::perspective}};
    const int from = n % 2 == 0 ? 0 : 5;
    if (from != 0) scene.draws[0].scissor = Scissor{from, from, kSize, kSize};
    std::array<SceneVertex, 3> c{random_corner(random, {-24, -4}, {2, 14})};
    c[1] = random_corner(random, {8, 20}, {-20, 2}), c[2] = random_corner(random, {4, 20}, {10, 28});
    for (SceneVertex& v : c) {
      v.x += static_cast<float>(from), v.y += static_cast<float>(from);
      v.attributes = {v.x, v.y};
      v.z = ((n % 4 < 2 ? v.x : v.y) + 64) / 128;
    }
    add_triangle(scene.draws[0], c, questions.model.culled);
    auto shown = answer(questions, scene);
    if (!shown && from != 0) continue;
    if (!shown) {
      scene.attributes.clear();
      for (SceneVertex& v : scene.draws[0].vertices) v.attributes.clear();
      shown = answer(questions, scene);
    }
    if (!shown || shown->right.count != shown->rival.count) return "";
    for (int s = 0; s < kSize * kSize; ++s) {
      const auto at = static_cast<std::size_t>(s);
      if (shown->right.count[at] != 1 || shown->open[at] != 0) continue;
      const double x = s % kSize + questions.model.x.place, y = s / kSize + questions.model.y.place;
      double left = x;
      for (std::size_t i = 0; i < 3; ++i) {
        const SceneVertex &p = c[i], &q = c[(i + 1) % 3];
        if ((p.y < y) != (q.y < y)) left = std::min(left, p.x + (y - p.y) / (double{q.y} - p.y) * (double{q.x} - p.x));
      }
      const auto cut = [from](double begin) { return std::max(0.0, from - std::floor(begin)); };
      Off off{{cut(left), cut(std::min({c[0].x, c[1].x, c[2].x})), cut(std::min({c[0].y, c[1].y, c[2].y}))}, {}};
      if (!shown->rival.attributes.empty() && !shown->rival.attributes[0].empty()) {
        off.by = {shown->rival.attributes[0][2 * at] - x, shown->rival.attributes[0][2 * at + 1] - y};
        all[0].push_back(off);
      }
      if (shown->rival.depth.empty()) continue;
      const double place = 128 * double{shown->rival.depth[at]} - 64;
      off.by = {place - x, place - y}, off.known = {n % 4 < 2, n % 4 >= 2};
      all[1].push_back(off);
    }
  }
  for (std::size_t form = 0; form < kForms.size(); ++form) {
    std::size_t which = 0;
    for (const std::size_t k : {0u, 1u}) {
      std::size_t good = 0, far = 0;
      for (const Off& off : all[k]) {
        bool fits = true;
        for (const std::size_t axis : {0u, 1u}) {
          const double cut = axis == form / 2 ? off.cut[form] : 0;
          fits = fits && (!off.known[axis] || std::abs(off.by[axis] + cut) < (cut > 0 ? 1.01 : 0.01));
          far += off.known[axis] && cut >= 3;
        }
        good += fits;
      }
      if (far >= 40 && 50 * good >= 49 * all[k].size()) which += k + 1;
    }
    if (which != 0) return "of triangles that begin " + text(kForms[form], kValues[which - 1]);
  }
  return "";
}

}  // namespace

std::string about_values_of_cut(const Questions& questions) {
  if (kAsksAll) {
    if (std::string sentence = about_begun_beyond(questions); !sentence.empty()) return sentence;
  }
  for (const Place& place : kPlaces) {
    if (std::string sentence = about_place(questions, place); !sentence.empty()) return sentence;
  }
  return "";
}

// Arrays of other numbers of components than each other: the value of each component tells which one it is.
std::string about_arrays(const Questions& questions) {
  const std::vector<std::vector<int>> kSizes{{2, 3}, {3, 1}, {1, 2}, {2, 2, 2, 2, 2, 2}};
  for (const std::vector<int>& sizes : kSizes) {
    Scene scene = empty_scene(8, 8);
    std::size_t total = 0;
    for (const int size : sizes) {
      scene.attributes.push_back({"a" + std::to_string(scene.attributes.size()), static_cast<std::uint32_t>(size),
                                  Interpolation::perspective});
      total += static_cast<std::size_t>(size);
    }
    std::array<SceneVertex, 3> c{corner(1.125, 1.25), corner(6.5, 2.125), corner(2.25, 6.625)};
    for (SceneVertex& v : c) {
      for (std::size_t k = 0; k < total; ++k) v.attributes.push_back(static_cast<float>(k + 1) / 16);
    }
    add_triangle(scene.draws[0], c, questions.model.culled);
    const auto image = questions.rival(scene);
    constexpr std::size_t kInside = 3 * 8 + 3;
    if (!image || image->count.empty() || image->count[kInside] != 1) continue;
    std::size_t place = 0;
    const bool alike_sizes = std::ranges::all_of(sizes, [&sizes](int size) { return size == sizes[0]; });
    const std::string such = alike_sizes ? "of " + std::to_string(sizes.size()) + " arrays of attributes "
                                         : "where arrays of attributes have different numbers of components (here " +
                                               std::to_string(sizes[0]) + " and " + std::to_string(sizes[1]) + ") ";
    for (std::size_t a = 0; a < sizes.size() && a < image->attributes.size(); ++a) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(sizes[a]); ++k, ++place) {
        if (image->attributes[a].empty()) continue;
        const double got = 16.0 * image->attributes[a][kInside * static_cast<std::size_t>(sizes[a]) + k] - 1;
        if (std::abs(got - static_cast<double>(place)) < 0.05) continue;
        if (alike_sizes) return such + "only the first " + std::to_string(a) + " are right";
        const bool is_one =
            std::abs(got - std::nearbyint(got)) < 0.05 && got > -0.5 && got < static_cast<double>(total);
        return such + "values come from other places" +
               (is_one ? ": component " + std::to_string(k) + " of array " + std::to_string(a) + " is number " +
                             std::to_string(static_cast<int>(std::nearbyint(got))) + " of a vertex, not number " +
                             std::to_string(place)
                       : std::string(", some of other vertices")) +
               ": an offset or a stride is that of arrays of one size";
      }
    }
  }
  return "";
}

}  // namespace surefill::judge
