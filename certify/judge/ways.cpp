// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/ways.hpp"

#include <iterator>

#include "certify/judge/room.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

// Weights of what is at the corners, as one way to interpolate has them.
struct Way {
  const char* text;
  Three (*weights)(const At& at);
};

Three turned(Three l, std::size_t a, std::size_t b, std::size_t c) {
  return {l[a], l[b], l[c]};
}

// The corners' places in the order of their y, and values that were left behind.
Three by_height(const At& at, const Three& l) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&at](std::size_t a, std::size_t b) { return at.corners[a][1] < at.corners[b][1]; });
  return {l[order[0]], l[order[1]], l[order[2]]};
}

// The values of the two that are alike in an axis are exchanged.
Three alike_exchanged(const At& at, std::size_t axis, Three l) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (at.corners[i][axis] != at.corners[(i + 1) % 3][axis]) continue;
    std::swap(l[i], l[(i + 1) % 3]);
    break;
  }
  return l;
}

constexpr const char* kUnsorted =
    "those of other vertices: positions are sorted by y, and what belongs to the vertices is not sorted with them";

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
    {kUnsorted, [](const At& at) { return by_height(at, at.weights()); }},
    {kUnsorted, [](const At& at) { return by_height(at, divided(at, at.weights())); }},
    {"those of other vertices: in triangles with a level edge its two are exchanged",
     [](const At& at) { return alike_exchanged(at, 1, divided(at, at.weights())); }},
    {"those of other vertices: in triangles with a level edge its two are exchanged",
     [](const At& at) { return alike_exchanged(at, 1, at.weights()); }},
    {"those of other vertices: in triangles with an upright edge its two are exchanged",
     [](const At& at) { return alike_exchanged(at, 0, divided(at, at.weights())); }},
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

// Values that are right, of other values at the corners.
struct Change {
  const char* text;
  double (*of)(double value);
};
constexpr Change kAtVertices[] = {{"clamped to 0 to 1", [](double v) { return std::clamp(v, 0.0, 1.0); }},
                                  {"clamped to -1 to 1", [](double v) { return std::clamp(v, -1.0, 1.0); }},
                                  {"0 where they are negative", [](double v) { return std::max(v, 0.0); }},
                                  {"without their sign", [](double v) { return std::abs(v); }}};

// Values that are taken once for several pixels; the largest first.
struct Block {
  int width, height;
};
constexpr Block kBlocks[] = {{16, 16}, {8, 8}, {16, 1}, {4, 4}, {8, 1}, {2, 2}, {4, 1}, {2, 1}, {1, 2}};

// Those whose place lies in the triangle.
template <class Where>
std::vector<Seen> inside_at(const std::vector<Seen>& seen, const Where& place) {
  std::vector<Seen> inside;
  std::copy_if(seen.begin(), seen.end(), std::back_inserter(inside), [&](const Seen& s) {
    At at = s.at;
    at.x = place(s)[0], at.y = place(s)[1];
    const Three l = at.weights();
    return std::min({l[0], l[1], l[2]}) > 0.01;
  });
  return inside;
}

std::string block_way(const std::vector<Seen>& seen, Kind kind) {
  const auto at_place = [kind](const Seen& s, double x, double y) {
    At at = s.at;
    at.x = x, at.y = y;
    return mixed(right_weights(at, kind), s.values);
  };
  if (all_are(seen, [&](const Seen& s) { return at_place(s, s.first_x, s.at.y); }))
    return "taken once for each row of a triangle, at its first pixel";
  for (const int n : {2, 4, 8, 16, 32}) {
    for (const bool aligned : {false, true}) {
      const auto begin_of = [&](const Seen& s) {
        const double from = aligned ? s.at.x - std::floor(s.at.x) : s.first_x;
        return from + n * std::floor((s.at.x - from) / n);
      };
      // The last pixels of a row may be one piece of their own.
      std::vector<Seen> whole;
      bool between = false;
      for (const Seen& s : seen) {
        if (begin_of(s) + n <= s.last_x) whole.push_back(s), between = between || begin_of(s) != s.at.x;
      }
      const auto chord = [&](const Seen& s) {
        const double x = begin_of(s), low = at_place(s, x, s.at.y), high = at_place(s, x + n, s.at.y);
        return low + (high - low) * (s.at.x - x) / n;
      };
      if (between && all_are(whole, chord) &&
          !all_are(whole, [&](const Seen& s) { return at_place(s, s.at.x, s.at.y); }))
        return text("right at every %d-th pixel of a row, and go evenly from one to the next in between", n);
    }
  }
  // Between the first and the last covered pixel of a row, or of its part in a block.
  for (const int n : {4, 8, 1 << 14}) {
    const auto ends = [n](const Seen& s) {
      const double begin = s.at.x - std::fmod(std::floor(s.at.x), n);
      return std::array{std::max(begin, s.first_x), std::min(begin + n - 1, s.last_x)};
    };
    const auto span = [&](const Seen& s) {
      const auto [low, high] = ends(s);
      const double a = at_place(s, low, s.at.y), b = at_place(s, high, s.at.y);
      return high > low ? a + (b - a) * (s.at.x - low) / (high - low) : a;
    };
    if (!all_are(seen, span)) continue;
    return n > 16 ? "right at the first and the last pixel of each row of a triangle, and go evenly in between"
                  : text(
                        "right at the first and the last pixel of each row of a triangle in a block of %d pixels, and "
                        "go evenly in between",
                        n);
  }
  for (const Block& block : kBlocks) {
    const auto first = [](double at, int size) { return at - std::fmod(std::floor(at), size); };
    const auto size = text("%d x %d pixels", block.width, block.height);
    const auto begin = [&](const Seen& s) {
      return std::array{first(s.at.x, block.width), first(s.at.y, block.height)};
    };
    const auto middle = [&](const Seen& s) {
      return std::array{std::floor(begin(s)[0]) + block.width / 2.0, std::floor(begin(s)[1]) + block.height / 2.0};
    };
    for (const bool at_corner : {true, false}) {
      const auto where = [&](const Seen& s) { return at_corner ? begin(s) : middle(s); };
      const auto there = [&](const Seen& s) { return at_place(s, where(s)[0], where(s)[1]); };
      // Beyond its edges a triangle may have any values.
      if (!all_are(inside_at(seen, where), there)) continue;
      return "taken once for each block of " + size + (at_corner ? ", at its upper left one" : ", at its middle") +
             (all_are(seen, there) ? "" : ", as far as that lies in the triangle");
    }
    const auto carried = [&](const Seen& s) {
      const auto [x, y] = begin(s);
      const double v = at_place(s, x, y);
      return v + (at_place(s, x + 1, y) - v) * (s.at.x - x) + (at_place(s, x, y + 1) - v) * (s.at.y - y);
    };
    if (block.width * block.height > 2 && all_are(seen, carried))
      return "right at the first pixel of each block of " + size + ", and carried on from there in even steps";
  }
  if (!kAsksAll) return "";
  // Wherever it is taken: the same for all that a triangle has of a block.
  for (const Block& block : kBlocks) {
    const auto place = [&block](const Seen& s) {
      return std::array{std::floor(s.at.x / block.width), std::floor(s.at.y / block.height)};
    };
    std::size_t pairs = 0, alike = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t k = i + 1; k < seen.size() && seen[k].at.corners == seen[i].at.corners; ++k) {
        const auto right = [&](std::size_t n) { return at_place(seen[n], seen[n].at.x, seen[n].at.y); };
        if (place(seen[k]) != place(seen[i]) || seen[k].values != seen[i].values || close(right(i), right(k), 8))
          continue;
        ++pairs, alike += close(seen[i].got, seen[k].got, 1);
      }
    }
    if (pairs < 100 || 50 * alike < 49 * pairs) continue;
    if (block.height == 16) break;  // all of the target: that is another question
    return text("the same in all pixels that a triangle has of a block of %d x %d: taken once for all of them",
                block.width, block.height);
  }
  return "";
}

// What tells triangles apart of which some are right.
struct Some {
  const char* text;
  bool (*has)(const At& at);
};
double turn_of(const At& at) {
  const auto& c = at.corners;
  return (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[1][1] - c[0][1]) * (c[2][0] - c[0][0]);
}
bool two_are_alike(const Three& v) {
  return v[0] == v[1] || v[1] == v[2] || v[0] == v[2];
}
constexpr Some kSome[] = {
    {"where vertices 0 and 1 have the same W", [](const At& at) { return at.w[0] == at.w[1]; }},
    {"where vertices 1 and 2 have the same W", [](const At& at) { return at.w[1] == at.w[2]; }},
    {"where vertices 0 and 2 have the same W", [](const At& at) { return at.w[0] == at.w[2]; }},
    {"where two vertices have the same W", [](const At& at) { return two_are_alike(at.w); }},
    {"in triangles with a level edge (two vertices of one Y)",
     [](const At& at) {
       return two_are_alike({at.corners[0][1], at.corners[1][1], at.corners[2][1]});
     }},
    {"in triangles with an upright edge (two vertices of one X)",
     [](const At& at) {
       return two_are_alike({at.corners[0][0], at.corners[1][0], at.corners[2][0]});
     }},
    {"in back faces (counter-clockwise on the screen)", [](const At& at) { return turn_of(at) < 0; }},
    {"in front faces (clockwise on the screen)", [](const At& at) { return turn_of(at) > 0; }}};

}  // namespace

bool all_come(const std::vector<Seen>& seen, double (*of)(const void* context, const Seen& s), const void* context) {
  std::size_t good = 0;
  for (const Seen& s : seen) {
    const double size = std::max({std::abs(s.values[0]), std::abs(s.values[1]), std::abs(s.values[2])});
    const double wanted = of(context, s);
    good += std::isfinite(wanted) && close(wanted, s.got, size);
  }
  return seen.size() >= 24 && 50 * good >= 49 * seen.size();
}

std::string way_of(const std::vector<Seen>& seen, Kind kind) {
  std::string way = way_of_all(seen, kind);
  if (way != "?") return way;
  for (const Some& some : kSome) {
    std::vector<Seen> those, others;
    for (const Seen& s : seen) (some.has(s.at) ? those : others).push_back(s);
    if (those.size() < 24 || others.size() < 24 || !way_of_all(others, kind).empty()) continue;
    if (std::ranges::all_of(those, [&](const Seen& s) { return s.at.corners == those[0].at.corners; })) continue;
    way = way_of_all(those, kind);
    // What nobody knows is said of them if nearly all are wrong.
    const auto right = std::count_if(those.begin(), those.end(), [kind](const Seen& s) {
      return close(mixed(right_weights(s.at, kind), s.values), s.got, 1);
    });
    if (way == "?" && 4 * static_cast<std::size_t>(right) > those.size()) continue;
    return (way == "?" ? "wrong" : way) + ", " + some.text + " alone: elsewhere they are right";
  }
  return way;
}

std::string way_of_all(const std::vector<Seen>& seen, Kind kind) {
  if (seen.size() < 24) return "";
  if (all_are(seen, [kind](const Seen& s) { return mixed(right_weights(s.at, kind), s.values); })) return "";
  for (const Way& way : kWays) {
    if (all_are(seen, [&way](const Seen& s) { return mixed(way.weights(s.at), s.values); })) return way.text;
  }
  for (const Place& place : kPlaces) {
    const auto where = [&place](const Seen& s) { return std::array{s.at.x + place.x, s.at.y + place.y}; };
    const auto there = [&](const Seen& s) {
      At at = s.at;
      at.x = where(s)[0], at.y = where(s)[1];
      return mixed(right_weights(at, kind), s.values);
    };
    // Beyond its edges a triangle may have any values.
    if (kind != kFlat && all_are(inside_at(seen, where), there)) return std::string("taken ") + place.text;
  }
  const auto right = [kind](const Seen& s) { return mixed(right_weights(s.at, kind), s.values); };
  if (all_are(seen, [&](const Seen& s) { return std::clamp(right(s), 0.0, 1.0); })) return "clamped to 0 to 1";
  if (all_are(seen, [&](const Seen& s) { return std::clamp(right(s), -1.0, 1.0); })) return "clamped to -1 to 1";
  if (all_are(seen, [&](const Seen& s) { return std::max(right(s), 0.0); })) return "0 where they should be negative";
  if (all_are(seen, [&](const Seen& s) { return std::abs(right(s)); })) return "without their sign";
  if (all_are(seen, [&](const Seen& s) { return -right(s); })) return "of the wrong sign";
  if (all_are(seen, [&](const Seen& s) { return 1 - right(s); })) return "1 less what they should be";
  if (all_are(seen, [&](const Seen& s) { return std::trunc(right(s)); })) return "cut to whole numbers";
  if (all_are(seen, [&](const Seen& s) { return std::nearbyint(right(s)); })) return "rounded to whole numbers";
  for (const Change& change : kAtVertices) {
    const auto changed = [&](const Seen& s) {
      return mixed(right_weights(s.at, kind), {change.of(s.values[0]), change.of(s.values[1]), change.of(s.values[2])});
    };
    if (all_are(seen, changed)) return std::string(change.text) + " at the vertices, before they are interpolated";
  }
  if (kind == kFlat) return "?";
  if (all_are(seen, [](const Seen& s) { return std::min({s.values[0], s.values[1], s.values[2]}); }))
    return "the smallest of the three vertices', and not interpolated";
  if (all_are(seen, [](const Seen& s) { return std::max({s.values[0], s.values[1], s.values[2]}); }))
    return "the largest of the three vertices', and not interpolated";
  const std::string block = block_way(seen, kind);
  return block.empty() ? "?" : block;
}

}  // namespace surefill::judge
