// SPDX-License-Identifier: Apache-2.0
//
// Questions about values: of depth, barycentrics and attributes at samples, how do they come of those at the corners?
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "certify/judge/questions.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;
using Three = std::array<double, 3>;

constexpr int kSize = 16;

template <typename... Values>
std::string text(const char* form, Values... values) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), form, values...);
  return buffer.data();
}

// A triangle and a place in it: the weights of its corners there, on the screen.
struct At {
  std::array<std::array<double, 2>, 3> corners{};
  Three w{}, z{};  // z is Z/W
  double x = 0, y = 0;

  Three weights(double dx = 0, double dy = 0) const {
    Three e{};
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &p = corners[(i + 1) % 3], &q = corners[(i + 2) % 3];
      e[i] = (q[0] - p[0]) * (y + dy - p[1]) - (q[1] - p[1]) * (x + dx - p[0]);
      sum += e[i];
    }
    return {e[0] / sum, e[1] / sum, e[2] / sum};
  }
};

// Weights of what is at the corners, as one way to interpolate has them.
struct Way {
  const char* text;
  Three (*weights)(const At& at);
};

Three divided(const At& at, Three l) {
  const double sum = l[0] / at.w[0] + l[1] / at.w[1] + l[2] / at.w[2];
  return {l[0] / at.w[0] / sum, l[1] / at.w[1] / sum, l[2] / at.w[2] / sum};
}
Three turned(Three l, std::size_t a, std::size_t b, std::size_t c) {
  return {l[a], l[b], l[c]};
}

enum Kind : std::size_t { kScreen, kPerspective, kFlat };

constexpr Way kWays[] = {
    {"interpolated on the screen, without perspective", [](const At& at) { return at.weights(); }},
    {"interpolated with perspective", [](const At& at) { return divided(at, at.weights()); }},
    {"those of vertex 0, the first one, and not interpolated",
     [](const At&) {
       return Three{1, 0, 0};
     }},
    {"those of vertex 1, and not interpolated",
     [](const At&) {
       return Three{0, 1, 0};
     }},
    {"those of vertex 2, the last one, and not interpolated",
     [](const At&) {
       return Three{0, 0, 1};
     }},
    {"the mean of the three vertices', and not interpolated",
     [](const At&) {
       return Three{1 / 3.0, 1 / 3.0, 1 / 3.0};
     }},
    {"those of other vertices: 1 and 2 are exchanged",
     [](const At& at) { return turned(divided(at, at.weights()), 0, 2, 1); }},
    {"those of other vertices: 0 and 1 are exchanged",
     [](const At& at) { return turned(divided(at, at.weights()), 1, 0, 2); }},
    {"those of other vertices: 0 and 2 are exchanged",
     [](const At& at) { return turned(divided(at, at.weights()), 2, 1, 0); }},
    {"those of other vertices, one further: in the order 1, 2, 0",
     [](const At& at) { return turned(divided(at, at.weights()), 2, 0, 1); }},
    {"those of other vertices, one further: in the order 2, 0, 1",
     [](const At& at) { return turned(divided(at, at.weights()), 1, 2, 0); }},
    {"those of other vertices: 1 and 2 are exchanged", [](const At& at) { return turned(at.weights(), 0, 2, 1); }},
    {"those of other vertices: 0 and 1 are exchanged", [](const At& at) { return turned(at.weights(), 1, 0, 2); }},
    {"those of other vertices: 0 and 2 are exchanged", [](const At& at) { return turned(at.weights(), 2, 1, 0); }},
    {"those of other vertices, one further: in the order 1, 2, 0",
     [](const At& at) { return turned(at.weights(), 2, 0, 1); }},
    {"those of other vertices, one further: in the order 2, 0, 1",
     [](const At& at) { return turned(at.weights(), 1, 2, 0); }},
    {"divided by W, and not multiplied by it again: the division at the end is missing",
     [](const At& at) {
       const Three l = at.weights();
       return Three{l[0] / at.w[0], l[1] / at.w[1], l[2] / at.w[2]};
     }},
    {"multiplied by W where they should be divided by it",
     [](const At& at) {
       const Three l = at.weights();
       const double sum = l[0] * at.w[0] + l[1] * at.w[1] + l[2] * at.w[2];
       return Three{l[0] * at.w[0] / sum, l[1] * at.w[1] / sum, l[2] * at.w[2] / sum};
     }},
    {"divided by W twice", [](const At& at) { return divided(at, divided(at, at.weights())); }},
    {"0",
     [](const At&) {
       return Three{0, 0, 0};
     }},
};

// The same ways at another place: where values are taken.
struct Place {
  double x, y;
  const char* text;
};
constexpr Place kPlaces[] = {{-0.5, -0.5, "at the upper left corner of the pixel, not at its centre"},
                             {0.5, 0.5, "at the lower right corner of the pixel, not at its centre"},
                             {0.5, -0.5, "at the upper right corner of the pixel, not at its centre"},
                             {-0.5, 0.5, "at the lower left corner of the pixel, not at its centre"},
                             {-0.5, 0, "half a pixel to the left of the sample"},
                             {0.5, 0, "half a pixel to the right of the sample"},
                             {0, -0.5, "half a pixel above the sample"},
                             {0, 0.5, "half a pixel below the sample"},
                             {-1, 0, "a pixel to the left of the sample"},
                             {1, 0, "a pixel to the right of the sample"},
                             {0, -1, "a pixel above the sample"},
                             {0, 1, "a pixel below the sample"}};

// One value at one sample.
struct Seen {
  At at;
  Three values{};  // at the corners
  double got = 0;
  bool last_row = false;
};

bool close(double a, double b, double size) {
  return std::abs(a - b) <= 0x1p-9 * std::max(1.0, size);
}

double mixed(const Three& weights, const Three& values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

template <typename Of>
bool all_are(const std::vector<Seen>& seen, const Of& of) {
  std::size_t good = 0;
  for (const Seen& s : seen) {
    const double size = std::max({std::abs(s.values[0]), std::abs(s.values[1]), std::abs(s.values[2])});
    const double wanted = of(s);
    good += std::isfinite(wanted) && close(wanted, s.got, size);
  }
  // Rounding may put a few beside what is about the value.
  return seen.size() >= 24 && 50 * good >= 49 * seen.size();
}

Three right_weights(const At& at, Kind kind) {
  return kind == kScreen ? at.weights() : kind == kPerspective ? divided(at, at.weights()) : Three{1, 0, 0};
}

// How all of them come about; empty if it is right, "?" if it is not and nobody knows.
std::string way_of(const std::vector<Seen>& seen, Kind kind) {
  if (seen.size() < 24) return "";
  if (all_are(seen, [kind](const Seen& s) { return mixed(right_weights(s.at, kind), s.values); })) return "";
  for (const Way& way : kWays) {
    if (all_are(seen, [&way](const Seen& s) { return mixed(way.weights(s.at), s.values); })) return way.text;
  }
  for (const Place& place : kPlaces) {
    const auto there = [&](const Seen& s) {
      At at = s.at;
      at.x += place.x, at.y += place.y;
      return mixed(right_weights(at, kind), s.values);
    };
    if (kind != kFlat && all_are(seen, there)) return std::string("taken ") + place.text;
  }
  const auto right = [kind](const Seen& s) { return mixed(right_weights(s.at, kind), s.values); };
  if (all_are(seen, [&](const Seen& s) { return std::clamp(right(s), 0.0, 1.0); })) return "clamped to 0 to 1";
  if (all_are(seen, [&](const Seen& s) { return std::clamp(right(s), -1.0, 1.0); })) return "clamped to -1 to 1";
  if (all_are(seen, [&](const Seen& s) { return std::max(right(s), 0.0); })) return "0 where they should be negative";
  if (all_are(seen, [&](const Seen& s) { return std::abs(right(s)); })) return "without their sign";
  if (all_are(seen, [&](const Seen& s) { return -right(s); })) return "of the wrong sign";
  if (all_are(seen, [&](const Seen& s) { return 1 - right(s); })) return "1 less what they should be";
  return "?";
}

struct Asked {
  std::vector<Scene> scenes;
  std::vector<Wrong> shown;
};

double unit(Random& random, double low, double high) {
  return low + (high - low) * random.unit();
}

// Triangles on the target, with two attributes of three components, of one kind, and a depth.
std::vector<Wrong> shown_of(const Questions& questions, Interpolation kind, bool perspective, bool attributes) {
  Random random(0xA77 + static_cast<std::uint64_t>(kind) + (perspective ? 16 : 0));
  std::vector<Wrong> all;
  for (int n = 0; n < 10; ++n) {
    Scene scene;
    scene.width = scene.height = kSize;
    if (attributes) scene.attributes = {{"a", 3, kind}, {"b", 3, kind}};
    SceneDraw& draw = scene.draws.emplace_back();
    std::array<SceneVertex, 3> c{};
    double turn = 0;
    do {
      for (SceneVertex& v : c) {
        const double w = perspective ? std::ldexp(1.0, random.below(3)) : 1;
        v = corner(std::nearbyint(8 * unit(random, 0, kSize)) / 8, std::nearbyint(8 * unit(random, 0, kSize)) / 8,
                   std::nearbyint(1024 * unit(random, 0.1, 0.9)) / 1024, w);
      }
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
      if (take(shown, v, s, one)) seen.push_back(one);
    }
  }
  return seen;
}

std::string said(const char* what, const std::string& way, const char* otherwise) {
  if (way.empty()) return "";
  return way == "?" ? std::string(otherwise) : std::string(what) + " are " + way;
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
  for (const int bits : {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}) {
    for (const double steps : {std::ldexp(1.0, bits) - 1, std::ldexp(1.0, bits)}) {
      bool good = true;
      for (const auto& [z, got] : seen) {
        good = good && std::abs(got - z) <= 1.001 / steps && std::abs(got * steps - std::nearbyint(got * steps)) < 1e-3;
      }
      if (good) return "depth comes in steps of " + std::to_string(bits) + " bits";
    }
  }
  return "";
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
    if (slope == 0) return text("depth is %.4g throughout, whatever it should be", constant);
    return map;
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
  const auto one_over_w = [](const Seen& s) {
    return 1 / mixed(s.at.weights(), {1 / s.at.w[0], 1 / s.at.w[1], 1 / s.at.w[2]});
  };
  if (is(one_over_w)) return "depth is W, and not Z/W";
  if (is([&](const Seen& s) { return 1 / one_over_w(s); })) return "depth is 1/W, and not Z/W";
  if (is([&](const Seen& s) { return mixed(s.at.weights(), s.at.w); }))
    return "depth is W, interpolated on the screen, and not Z/W";
  const std::string other = way_of(deep, kScreen);
  return said("with perspective (W that differs) depths", other, "with perspective (W that differs) depths are wrong");
}

// --- barycentrics

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
    return said("barycentrics", way, "barycentrics are wrong");
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
  return "";
}

}  // namespace

std::string how_values_come(const Questions& questions) {
  const std::string depth = about_depth(questions), weights = about_barycentrics(questions),
                    attributes = about_attributes(questions);
  if (!depth.empty()) return depth;
  if (!attributes.empty()) return attributes;
  return weights;
}

}  // namespace surefill::judge
