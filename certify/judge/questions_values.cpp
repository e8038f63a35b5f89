// SPDX-License-Identifier: Apache-2.0
//
// Questions about values: of depth, barycentrics and attributes at samples, how do they come of those at the corners?
#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/questions.hpp"
#include "certify/judge/room.hpp"
#include "certify/judge/text.hpp"
#include "certify/judge/ways.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

constexpr int kSize = 16;

double unit(Random& random, double low, double high) {
  return low + (high - low) * random.unit();
}

// Triangles on the target, with two attributes of three components, of one kind or two, and a depth.
std::vector<Wrong> shown_of(const Questions& questions, Interpolation kind, bool perspective, bool attributes,
                            std::optional<Interpolation> second = std::nullopt) {
  Random random(0xA77 + static_cast<std::uint64_t>(kind) + (perspective ? 16 : 0));
  std::vector<Wrong> all;
  for (int n = 0; n < 14; ++n) {
    Scene scene;
    scene.width = scene.height = kSize;
    if (attributes) scene.attributes = {{"a", 3, kind}, {"b", 3, second.value_or(kind)}};
    SceneDraw& draw = scene.draws.emplace_back();
    std::array<SceneVertex, 3> c{};
    double turn = 0;
    do {
      for (SceneVertex& v : c) {
        const double w = perspective ? std::ldexp(1.0, random.below(3)) : 1;
        const double z = std::nearbyint(1024 * unit(random, 0.1, 0.9)) / 1024;
        v = random_corner(random, {0, kSize}, {0, kSize}, z, w);
      }
      // The last ones have a level edge, or an upright one.
      const SceneVertex& from = c[static_cast<std::size_t>(n % 3)];
      SceneVertex& to = c[static_cast<std::size_t>((n + 1) % 3)];
      if (n == 10 || n == 12) to.y = from.y / from.w * to.w;
      if (n == 11 || n == 13) to.x = from.x / from.w * to.w;
      const auto x = [&c](std::size_t i) { return double{c[i].x} / c[i].w; };
      const auto y = [&c](std::size_t i) { return double{c[i].y} / c[i].w; };
      turn = (x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0));
    } while (std::abs(turn) < kSize * kSize / 3.0 || (perspective && c[0].w == c[1].w && c[1].w == c[2].w));
    for (SceneVertex& v : c) {
      for (int k = 0; k < 6 && attributes; ++k)
        v.attributes.push_back(static_cast<float>(std::nearbyint(64 * unit(random, -2, 2)) / 64));
    }
    add_triangle(draw, c, questions.model.culled);
    if (auto shown = answer(questions, scene)) all.push_back(std::move(*shown));
  }
  return all;
}

// What was seen of one value: `take` gives the three at the corners and the one that came.
template <typename Take>
std::vector<Seen> seen_of(const Questions& questions, const std::vector<Wrong>& all, const Take& take) {
  std::vector<Seen> seen;
  for (const Wrong& shown : all) {
    const SceneDraw& draw = shown.scene.draws[0];
    At at;
    std::array<const SceneVertex*, 3> v{};
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = &draw.vertices[draw.triangles[0].vertices[i]];
      at.corners[i] = {double{v[i]->x} / v[i]->w, double{v[i]->y} / v[i]->w};
      at.w[i] = v[i]->w;
      at.z[i] = double{v[i]->z} / v[i]->w;
    }
    for (std::size_t s = 0; s < shown.right.count.size(); ++s) {
      if (shown.right.count[s] != 1 || shown.rival.count[s] != 1) continue;
      at.x = static_cast<double>(s % kSize) + questions.model.x.place;
      at.y = static_cast<double>(s / kSize) + questions.model.y.place;
      const Three l = at.weights();
      if (std::min({l[0], l[1], l[2]}) < 0.02) continue;
      Seen one;
      one.at = at;
      std::size_t first = s;
      while (first % kSize != 0 && shown.rival.count[first - 1] != 0) --first;
      one.first_x = static_cast<double>(first % kSize) + questions.model.x.place;
      std::size_t last = s;
      while ((last + 1) % kSize != 0 && shown.rival.count[last + 1] != 0) ++last;
      one.last_x = static_cast<double>(last % kSize) + questions.model.x.place;
      if (take(shown, v, s, one)) seen.push_back(one);
    }
  }
  return seen;
}

std::string said(const char* what, const std::string& way, const char* otherwise) {
  if (way.empty()) return "";
  return way == "?" ? std::string(otherwise) : std::string(what) + " are " + way;
}

// --- how precisely

bool has_bits(double value, int bits) {
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(value, &exponent), bits);
  return mantissa == std::nearbyint(mantissa);
}
bool close_to_bits(double right, double got, int bits) {
  return std::abs(got - right) <= std::ldexp(std::abs(right), 1 - bits);
}
std::string small_float(int bits) {
  return "floating point of " + std::to_string(bits) + " bits" +
         (bits == 11  ? " (half precision)"
          : bits == 8 ? " (bfloat16)"
                      : "");
}

// What is about right, and is not: of right values and those that came.
std::string kept_in(const std::vector<std::array<double, 2>>& seen) {
  const auto every = [&seen](const auto& of) {
    return seen.size() >= 24 &&
           std::all_of(seen.begin(), seen.end(), [&of](const auto& pair) { return of(pair[0], pair[1]); });
  };
  if (every([](double z, double got) { return std::abs(got - z) <= 0x1p-17 * std::max(1.0, std::abs(z)); })) return "";
  for (int bits = 4; bits <= 16; ++bits) {
    for (const double steps : {std::ldexp(1.0, bits) - 1, std::ldexp(1.0, bits)}) {
      if (every([steps](double z, double got) {
            return std::abs(got - z) <= 1.51 / steps && std::abs(got * steps - std::nearbyint(got * steps)) < 1e-3;
          })) {
        return " come in steps of " + std::to_string(bits) + " bits";
      }
    }
    if (every([bits](double z, double got) { return has_bits(got, bits) && close_to_bits(z, got, bits); }))
      return " are rounded to " + small_float(bits);
  }
  return "";
}

// --- depth

// Depths of a whole triangle, as they come: in which steps?
std::string depth_steps(const Questions& questions) {
  std::vector<std::array<double, 2>> seen;
  for (int n = 0; n < 40; ++n) {
    const double z = 0.03 + 0.94 * std::fmod(n * 0.6180339887498949, 1.0);
    Scene scene = empty_scene(8, 8);
    add_triangle(scene.draws[0], {corner(1.125, 1.25, z), corner(6.5, 2.125, z), corner(2.25, 6.625, z)},
                 questions.model.culled);
    const auto image = questions.rival(scene);
    if (!image || image->depth.empty()) return "";
    seen.push_back({static_cast<double>(static_cast<float>(z)), image->depth[3 * 8 + 3]});
  }
  const auto every = [&seen](const auto& of) {
    return std::all_of(seen.begin(), seen.end(), [&of](const auto& pair) { return of(pair[0], pair[1]); });
  };
  if (every([](double, double got) { return std::isnan(got); }))
    return "depth is NaN in triangles that are equally deep everywhere, as of 0 / 0";
  if (every([](double, double got) { return std::isinf(got); }))
    return "depth is never written: it stays as it was cleared";
  const double more = seen[0][1] - seen[0][0];
  if (std::abs(more) > 0x1p-16 && every([more](double z, double got) { return std::abs(got - z - more) < 0x1p-21; })) {
    return text("depth is z %+.6g, z being what it should be: a constant is added to it, as by a bias", more);
  }
  for (const int bits : {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}) {
    for (const double steps : {std::ldexp(1.0, bits) - 1, std::ldexp(1.0, bits)}) {
      bool good = true;
      for (const auto& [z, got] : seen) {
        good = good && std::abs(got - z) <= 1.001 / steps && std::abs(got * steps - std::nearbyint(got * steps)) < 1e-3;
      }
      if (good) return "depth comes in steps of " + std::to_string(bits) + " bits";
    }
  }
  for (int bits = 4; bits <= 16; ++bits) {
    if (every([bits](double z, double got) { return has_bits(got, bits) && close_to_bits(z, got, bits); })) {
      return "depth is rounded to " + small_float(bits);
    }
  }
  return "";
}

// A part of the slope is added.
std::string depth_slope(const std::vector<Seen>& seen) {
  const auto z = [](const Seen& s) { return mixed(s.at.weights(), s.values); };
  struct Slope {
    const char* text;
    double (*of)(double dx, double dy);
  };
  constexpr Slope kSlopes[] = {
      {"max(|dz/dx|, |dz/dy|)", [](double dx, double dy) { return std::max(dx, dy); }},
      {"|dz/dx| + |dz/dy|", [](double dx, double dy) { return dx + dy; }},
      {"the length of (dz/dx, dz/dy)", [](double dx, double dy) { return std::hypot(dx, dy); }}};
  for (const Slope& slope : kSlopes) {
    const auto steep = [&](const Seen& s) {
      return slope.of(std::abs(mixed(s.at.weights(1, 0), s.values) - z(s)),
                      std::abs(mixed(s.at.weights(0, 1), s.values) - z(s)));
    };
    double above = 0, below = 0;
    for (const Seen& s : seen) above += (s.got - z(s)) * steep(s), below += steep(s) * steep(s);
    const double factor = std::nearbyint(64 * above / below) / 64;
    if (factor == 0 || !all_are(seen, [&](const Seen& s) { return z(s) + factor * steep(s); })) continue;
    return text("depth is z %+.4g times %s, a pixel, z being what it should be: its slope is added to it, as by a bias",
                factor, slope.text);
  }
  return "";
}

// What is right where a row begins, and further off the longer it goes on.
std::string depth_drift(const std::vector<Seen>& seen) {
  std::array<double, 2> most{}, along{};
  for (const Seen& s : seen) {
    const double error = std::abs(s.got - mixed(s.at.weights(), s.values)), x = s.at.x - s.first_x;
    const std::size_t far = x >= 8 ? 1 : 0;
    if ((x <= 1 || far == 1) && error >= most[far]) most[far] = error, along[far] = x;
  }
  if (!(most[1] > 4 * most[0]) || !(most[1] < 0x1p-4)) return "";
  return text("depths drift along a row, by up to %.2g over %.0f pixels: their slope has too few bits", most[1],
              along[1]);
}

std::string about_depth(const Questions& questions) {
  if (std::string steps = depth_steps(questions); !steps.empty()) return steps;
  const auto depths = [&](bool perspective) {
    return seen_of(questions, shown_of(questions, Interpolation::perspective, perspective, false),
                   [](const Wrong& shown, const auto& v, std::size_t s, Seen& one) {
                     if (shown.rival.depth.empty()) return false;
                     one.values = one.at.z;
                     (void)v;
                     one.got = shown.rival.depth[s];
                     return true;
                   });
  };
  const std::vector<Seen> flat = depths(false), deep = depths(true);
  if (flat.size() < 24) return "";
  const auto one_over_w = [](const Seen& s) {
    return 1 / mixed(s.at.weights(), {1 / s.at.w[0], 1 / s.at.w[1], 1 / s.at.w[2]});
  };
  // A straight line of what it should be.
  double low = INFINITY, high = -INFINITY, low_got = 0, high_got = 0;
  for (const Seen& s : flat) {
    const double z = mixed(s.at.weights(), s.values);
    if (z < low) low = z, low_got = s.got;
    if (z > high) high = z, high_got = s.got;
  }
  const std::string way = way_of(flat, kScreen);
  for (const double steps : {2.0, 64.0, 1000.0}) {
    if (way.empty()) break;
    const double slope = std::nearbyint(steps * (high_got - low_got) / (high - low)) / steps;
    const double constant = std::nearbyint(steps * (low_got - slope * low)) / steps;
    if ((slope == 1 && constant == 0) ||
        !all_are(flat, [&](const Seen& s) { return slope * mixed(s.at.weights(), s.values) + constant; })) {
      continue;
    }
    const std::string map = text("depth is %.4g z %+.4g, z being what it should be", slope, constant);
    if (slope == 2 && constant == -1) return map + ": it is taken from 0 to 1 to -1 to 1";
    if (slope == 0.5 && constant == 0.5) return map + ": it is mapped from -1 to 1 to 0 to 1, which it was already";
    if (slope == -1 && constant == 1) return map + ": near and far are exchanged";
    if (slope == 0 && deep.size() >= 24 && all_are(deep, one_over_w)) return "depth is W, and not Z/W";
    if (slope == 0 && deep.size() >= 24 && all_are(deep, [&](const Seen& s) { return 1 / one_over_w(s); }))
      return "depth is 1/W, and not Z/W";
    if (slope == 0) return text("depth is %.4g throughout, whatever it should be", constant);
    return map;
  }
  if (way == "?") {
    if (std::string slopes = depth_slope(flat); !slopes.empty()) return slopes;
    if (std::string drift = depth_drift(flat); !drift.empty()) return drift;
  }
  if (!way.empty()) return said("depths", way, "depths inside of plain triangles are wrong");
  if (deep.size() < 24) return "";
  const auto is = [&deep](const auto& of) { return all_are(deep, of); };
  if (is([](const Seen& s) { return mixed(s.at.weights(), s.values); })) return "";
  if (is([](const Seen& s) { return mixed(divided(s.at, s.at.weights()), s.values); })) {
    return "depth is interpolated with perspective, where Z/W is affine on the screen: it is divided by W twice";
  }
  const auto by_w = [](const Seen& s, double power) {
    Three v{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = s.values[i] * std::pow(s.at.w[i], power);
    return v;
  };
  if (is([&](const Seen& s) { return mixed(s.at.weights(), by_w(s, 1)); })) return "depth is Z, and not divided by W";
  if (is([&](const Seen& s) { return mixed(divided(s.at, s.at.weights()), by_w(s, 1)); })) {
    return "depth is Z interpolated with perspective, and not Z/W";
  }
  if (is([&](const Seen& s) { return mixed(s.at.weights(), by_w(s, -1)); })) return "depth is divided by W twice";
  if (is(one_over_w)) return "depth is W, and not Z/W";
  if (is([&](const Seen& s) { return 1 / one_over_w(s); })) return "depth is 1/W, and not Z/W";
  if (is([&](const Seen& s) { return mixed(s.at.weights(), s.at.w); }))
    return "depth is W, interpolated on the screen, and not Z/W";
  const std::string other = way_of(deep, kScreen);
  return said("with perspective (W that differs) depths", other, "with perspective (W that differs) depths are wrong");
}

// --- barycentrics

bool about_right(const std::vector<Seen>& seen, Kind kind) {
  return std::all_of(seen.begin(), seen.end(), [kind](const Seen& s) {
    return std::abs(s.got - mixed(right_weights(s.at, kind), s.values)) < 0x1p-5;
  });
}

// One of the three is another one.
std::string one_barycentric(const std::vector<Seen>& all) {
  std::array<std::vector<Seen>, 3> seen;
  for (const Seen& s : all) seen[s.values[0] == 1 ? 0 : s.values[1] == 1 ? 1 : 2].push_back(s);
  std::size_t bad = 0, which = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!way_of(seen[i], kPerspective).empty()) ++bad, which = i;
  }
  if (bad != 1) return "barycentrics are wrong";
  const std::string name = "barycentric b" + std::to_string(which);
  for (std::size_t j = 0; j < 3; ++j) {
    if (j == which || !all_are(seen[which], [j](const Seen& s) { return 1 - divided(s.at, s.at.weights())[j]; })) {
      continue;
    }
    return name + " is 1 - b" + std::to_string(j) + ": the third one is not taken off";
  }
  if (all_are(seen[which], [](const Seen&) { return 0; })) return name + " is 0, the others are right";
  const std::string way = way_of(seen[which], kPerspective);
  return name + (way == "?" ? " is wrong, the others are right" : " is " + way + ", the others are right");
}

std::string about_barycentrics(const Questions& questions) {
  for (const bool perspective : {false, true}) {
    std::vector<Seen> seen;
    const std::vector<Wrong> all = shown_of(questions, Interpolation::perspective, perspective, false);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::vector<Seen> part =
          seen_of(questions, all, [i](const Wrong& shown, const auto& v, std::size_t s, Seen& one) {
            (void)v;
            if (shown.rival.barycentrics.empty()) return false;
            one.values[i] = 1;
            one.got = shown.rival.barycentrics[3 * s + i];
            return true;
          });
      seen.insert(seen.end(), part.begin(), part.end());
    }
    const std::string way = way_of(seen, kPerspective);
    if (way.empty()) continue;
    if (way != "?") return said("barycentrics", way, "");
    if (about_right(seen, kPerspective)) continue;  // how precise they are is another question
    return one_barycentric(seen);
  }
  return "";
}

// --- attributes

struct Channel {
  std::size_t array, component;
};

std::vector<Seen> attributes_of(const Questions& questions, const std::vector<Wrong>& all, Channel given, Channel got) {
  return seen_of(questions, all, [&](const Wrong& shown, const auto& v, std::size_t s, Seen& one) {
    if (shown.rival.attributes.size() < 2 || shown.rival.attributes[got.array].empty()) return false;
    for (std::size_t i = 0; i < 3; ++i) one.values[i] = v[i]->attributes[3 * given.array + given.component];
    one.got = shown.rival.attributes[got.array][3 * s + got.component];
    return true;
  });
}

// Arrays of one to four components, alone: are their values read as far apart as they are? Behind the triangle's vertices there
// are others.
std::string about_components(const Questions& questions, Interpolation kind) {
  unsigned wrong = 0, bad = 0;  // the last that is wrong, and how many are
  for (unsigned n = 1; n <= 4; ++n) {
    Scene scene = empty_scene(8, 8);
    scene.attributes = {{"a", n, kind}};
    SceneDraw& draw = scene.draws[0];
    for (const double x : {0, -9, -10, -11})
      add_triangle(draw, {corner(x + 1.125, 1.25), corner(x + 6.5, 2.125), corner(x + 2.25, 6.625)},
                   questions.model.culled);
    // The values of vertex v, where each begins `stride` after the one before it: the largest first, whatever n.
    const auto give = [&](unsigned stride) {
      for (unsigned v = 0; v < draw.vertices.size(); ++v) {
        draw.vertices[v].attributes.clear();
        for (unsigned k = 0; k < n; ++k)
          draw.vertices[v].attributes.push_back(static_cast<float>((46 + 4 * (stride * v + k)) % 47) / 8);
      }
    };
    give(n);
    const auto image = questions.rival(scene);
    if (!image || image->attributes.empty() || image->attributes[0].size() != 64 * n) return "";
    for (unsigned stride = n, tried = 0; tried < 4; ++tried, stride = stride % 4 + 1) {
      give(stride);
      const auto as = questions.right(scene);
      unsigned good = 0, far = 0;
      for (const unsigned s : {2u * 8 + 3, 3u * 8 + 3, 4u * 8 + 2, 2u * 8 + 5}) {
        for (std::size_t i = n * s; as && i < n * (s + 1); ++i) {
          const float got = image->attributes[0][i], due = as->attributes[0][i];
          good += alike(got, due), far += !(std::abs(got - due) < 0.125f);
        }
      }
      if (good == 4 * n && tried == 0) break;
      if (good == 4 * n) {
        return text(" of %u components are read as if they had %u: vertices are as far apart as that", n, stride);
      }
      if (tried != 0) continue;
      if (2 * far < 4 * n) return "";  // some are wrong, or all a little: that is another question
      wrong = n, ++bad;
    }
  }
  return bad == 1 ? text(" of %u components are wrong, those of other numbers are right", wrong) : "";
}

std::string about_attributes_of(const Questions& questions, Interpolation kind, bool perspective) {
  const std::vector<Wrong> all = shown_of(questions, kind, perspective, true);
  const Kind wanted = kind == Interpolation::flat            ? kFlat
                      : kind == Interpolation::noperspective ? kScreen
                                                             : kPerspective;
  const char* name = kind == Interpolation::flat            ? "flat attributes"
                     : kind == Interpolation::noperspective ? "noperspective attributes"
                                                            : "attributes";
  std::vector<Seen> every;
  std::array<std::string, 6> ways;
  for (std::size_t c = 0; c < 6; ++c) {
    const std::vector<Seen> seen = attributes_of(questions, all, {c / 3, c % 3}, {c / 3, c % 3});
    if (seen.size() < 24) return "";
    ways[c] = way_of(seen, wanted);
    every.insert(every.end(), seen.begin(), seen.end());
  }
  if (std::all_of(ways.begin(), ways.end(), [](const std::string& way) { return way.empty(); })) return "";
  // All alike, which two numbers that happen to be so do not upset.
  const std::string way = way_of(every, wanted);
  if (way != "?" && !way.empty()) return said(name, way, "");
  // Does each come from another component?
  std::array<std::size_t, 6> from{};
  bool found = true;
  for (std::size_t c = 0; c < 6 && found; ++c) {
    found = false;
    for (std::size_t other = 0; other < 6 && !found; ++other) {
      if (!way_of(attributes_of(questions, all, {other / 3, other % 3}, {c / 3, c % 3}), wanted).empty()) continue;
      from[c] = other;
      found = true;
    }
  }
  if (found) {
    bool arrays = true, first = true;
    for (std::size_t c = 0; c < 6; ++c) arrays = arrays && from[c] == (c + 3) % 6, first = first && from[c] == c % 3;
    if (arrays) return std::string(name) + " are exchanged: one array's values come for the other's";
    if (first) return std::string("of several ") + name + " each is the first one";
    std::string order;
    for (std::size_t c = 0; c < 3; ++c) order += (c == 0 ? "" : ", ") + std::to_string(from[c]);
    if (from[3] == from[0] + 3 && from[4] == from[1] + 3 && from[5] == from[2] + 3) {
      return "components of " + std::string(name) + " come in another order: " + order;
    }
    return std::string(name) + " come from other arrays or components";
  }
  std::size_t bad = 0, which = 0;
  for (std::size_t c = 0; c < 6; ++c) {
    if (ways[c].empty()) continue;
    ++bad;
    which = c;
  }
  if (bad == 1) {
    const std::string what =
        text("component %d of array %d of ", static_cast<int>(which % 3), static_cast<int>(which / 3)) + name;
    return what + (ways[which] == "?" ? " is wrong, the others are right" : " is " + ways[which]);
  }
  if (ways[0].empty() && ways[1].empty() && ways[2].empty())
    return std::string("of several ") + name + " only the first is right";
  if (kAsksAll) {
    if (std::string components = about_components(questions, kind); !components.empty()) return name + components;
  }
  return std::string(name) + " inside of plain triangles are wrong";
}

std::string about_attributes(const Questions& questions) {
  for (const bool perspective : {false, true}) {
    for (const Interpolation kind : {Interpolation::perspective, Interpolation::noperspective, Interpolation::flat}) {
      std::string sentence = about_attributes_of(questions, kind, perspective);
      if (sentence.empty()) continue;
      if (perspective) sentence = "with perspective (W that differs) " + sentence;
      return sentence;
    }
  }
  // Arrays of two kinds in one frame.
  constexpr std::array<std::pair<Interpolation, Kind>, 3> kKinds{{{Interpolation::perspective, kPerspective},
                                                                  {Interpolation::noperspective, kScreen},
                                                                  {Interpolation::flat, kFlat}}};
  for (const auto& [first, first_kind] : kKinds) {
    for (const auto& [second, second_kind] : kKinds) {
      if (first == second) continue;
      const std::vector<Wrong> all = shown_of(questions, first, true, true, second);
      const std::vector<Seen> one = attributes_of(questions, all, {0, 0}, {0, 0}),
                              other = attributes_of(questions, all, {1, 0}, {1, 0});
      const bool good = way_of_all(one, first_kind).empty(), other_good = way_of_all(other, second_kind).empty();
      if (good && !other_good && way_of_all(other, first_kind).empty())
        return "of attributes of several kinds (perspective, noperspective, flat) all are interpolated as the first "
               "one is";
      if (!good && other_good && way_of_all(one, second_kind).empty())
        return "of attributes of several kinds (perspective, noperspective, flat) all are interpolated as the last one "
               "is";
    }
  }
  return "";
}

// Values of a few triangles as they come, and what they should be: depths, barycentrics, attributes.
struct Precise {
  std::array<std::vector<std::array<double, 2>>, 3> seen;
  std::array<bool, 4> right{true, true, true, true};  // of the attribute's components
  double fourth = 0;
};

Precise precise_values(const Questions& questions, bool perspective) {
  Random random(0x94EC);
  Precise result;
  for (int n = 0; n < 8; ++n) {
    Scene scene = empty_scene(kSize, kSize);
    scene.attributes = {{"a", 4, Interpolation::perspective}};
    std::array<SceneVertex, 3> c = plain_corners(random, kSize, kSize);
    At at;
    std::array<Three, 4> values{};
    for (std::size_t i = 0; i < 3; ++i) {
      at.corners[i] = {c[i].x, c[i].y};
      at.w[i] = perspective ? 1 + 2 * random.below(4) : 1;
      at.z[i] = std::nearbyint(1024 * unit(random, 0.1, 0.9)) / 1024;
      c[i] = corner(c[i].x, c[i].y, at.z[i], at.w[i]);
      for (std::size_t k = 0; k < 4; ++k) {
        c[i].attributes.push_back(static_cast<float>(unit(random, 0.1, 0.9)));
        values[k][i] = c[i].attributes.back();
      }
    }
    add_triangle(scene.draws[0], c, questions.model.culled);
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) continue;
    for (std::size_t s = 0; s < image->count.size(); ++s) {
      at.x = static_cast<double>(s % kSize) + questions.model.x.place;
      at.y = static_cast<double>(s / kSize) + questions.model.y.place;
      const Three l = at.weights(), b = divided(at, l);
      if (image->count[s] != 1 || std::min({l[0], l[1], l[2]}) < 0.02) continue;
      if (!image->depth.empty()) result.seen[0].push_back({mixed(l, at.z), image->depth[s]});
      const std::uint32_t turned = scene.draws[0].triangles[0].vertices[1] == 1 ? 0 : 1;
      if (!image->barycentrics.empty() && !turned) result.seen[1].push_back({b[0], image->barycentrics[3 * s]});
      if (image->attributes.empty() || image->attributes[0].empty()) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const double wanted = mixed(b, values[k]), got = image->attributes[0][4 * s + k];
        if (k < 3) result.seen[2].push_back({wanted, got});
        result.right[k] = result.right[k] && close(wanted, got, 1);
        if (k == 3) result.fourth = got;
      }
    }
  }
  return result;
}

// Two draws side by side, of two kinds: is all interpolated as one of them says?
std::string about_kinds_of_draws(const Questions& questions) {
  constexpr std::size_t kLeft = 3 * 8 + 1, kRight = 3 * 8 + 6;
  constexpr std::array kKinds{Interpolation::perspective, Interpolation::noperspective, Interpolation::flat};
  int all = 0, as_first = 0, as_last = 0;
  for (const Interpolation first : kKinds) {
    for (const Interpolation last : kKinds) {
      Scene scene = empty_scene(8, 8);
      scene.attributes = {{"a", 1, Interpolation::perspective}};
      scene.draws.emplace_back();
      for (const std::size_t d : {0u, 1u}) {
        std::array<SceneVertex, 3> c{corner(4, -20, 0.5, 1), corner(4, 28, 0.5, 4), corner(d == 0 ? -20 : 28, 4)};
        for (std::size_t i = 0; i < 3; ++i) c[i].attributes = {static_cast<float>(8 * i)};
        add_triangle(scene.draws[d], c, questions.model.culled);
      }
      // What the rival or the right one has on the left and on the right, where draws say so.
      const auto values = [&scene](const auto& of, Interpolation left, Interpolation right) {
        scene.draws[0].interpolations = {left}, scene.draws[1].interpolations = {right};
        const std::optional<Image> image = of(scene);
        const bool has = image && !image->attributes.empty() && image->attributes[0].size() == 64;
        return has ? std::array{image->attributes[0][kLeft], image->attributes[0][kRight]} : std::array{NAN, NAN};
      };
      const auto got = values(questions.rival, first, last), wanted = values(questions.right, first, last),
                 firsts = values(questions.right, first, first), lasts = values(questions.right, last, last);
      const auto is = [](const auto& a, const auto& b) {
        return std::abs(a[0] - b[0]) < 1.0 / 16 && std::abs(a[1] - b[1]) < 1.0 / 16;
      };
      if (std::isnan(got[0]) || is(wanted, firsts) || is(wanted, lasts)) continue;
      ++all;
      as_first += is(got, firsts);
      as_last += is(got, lasts);
    }
  }
  if (all < 2 || (as_first < all && as_last < all)) return "";
  return std::string("of several draws each one's attributes are interpolated as the ") +
         (as_first == all ? "first" : "last") + " draw says";
}

}  // namespace

std::string about_bits(const Questions& questions) {
  constexpr std::array<const char*, 3> kNames{"depths", "barycentrics", "attributes"};
  const Precise flat = precise_values(questions, false), deep = precise_values(questions, true);
  if (flat.right[0] && flat.right[1] && flat.right[2] && !flat.right[3]) {
    return text("the fourth component of attributes is wrong, the others are right: it comes as %.4g", flat.fourth);
  }
  for (const std::size_t k : {2u, 1u, 0u}) {
    if (const std::string kept = kept_in(flat.seen[k]); !kept.empty()) return kNames[k] + kept;
  }
  const auto error = [](const std::vector<std::array<double, 2>>& seen) {
    double most = 0;
    for (const auto& [right, got] : seen) most = std::max(most, std::abs(got - right));
    return most;
  };
  for (const std::size_t k : {2u, 1u, 0u}) {
    const double most = error(deep.seen[k]);
    if (const double off = error(flat.seen[k]); off > 0x1p-15 && off < 0x1p-6) {
      return kNames[k] +
             text(" are up to %.2g beside what they should be: something that they come of has about %d bits", off,
                  -std::ilogb(off));
    }
    if (!(error(flat.seen[k]) < 0x1p-18) || !(most > 0x1p-15 && most < 0x1p-6)) continue;
    return std::string("with perspective (W that differs) ") + kNames[k] +
           text(" are up to %.2g beside what they should be: 1/W, or W from it, has about %d bits", most,
                -std::ilogb(most));
  }
  return "";
}

std::string how_values_come(const Questions& questions) {
  const std::string depth = about_depth(questions), weights = about_barycentrics(questions),
                    attributes = about_attributes(questions);
  if (!depth.empty()) return depth;
  if (attributes.ends_with("clamped to 0 to 1")) {
    const std::string precision = about_bits(questions);
    return attributes + (precision.empty() ? "" : "; " + precision);
  }
  if (!attributes.empty()) return attributes;
  return weights.empty() ? about_kinds_of_draws(questions) : weights;
}

}  // namespace surefill::judge
