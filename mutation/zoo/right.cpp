// SPDX-License-Identifier: Apache-2.0
#include "mutation/zoo/right.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

namespace surefill::zoo {

namespace {

// --- the pairwise array

using Pair = std::pair<std::pair<std::size_t, int>, std::pair<std::size_t, int>>;

// Greedy: each row takes, choice by choice, what covers most pairs that are left.
std::vector<Choices> pairwise() {
  std::set<Pair> left;
  for (std::size_t a = 0; a < kNumberOfChoices; ++a) {
    for (std::size_t b = a + 1; b < kNumberOfChoices; ++b) {
      for (int i = 0; i < kChoices[a]; ++i) {
        for (int j = 0; j < kChoices[b]; ++j) left.insert({{a, i}, {b, j}});
      }
    }
  }
  const auto covers = [&left](const Choices& row, std::size_t column, int value, std::size_t known) {
    int pairs = 0;
    for (std::size_t other = 0; other < kNumberOfChoices; ++other) {
      if (other == column || (other > column ? other >= known : false)) continue;
      if (row[other] < 0) continue;
      const std::pair<std::size_t, int> p{column, value}, q{other, row[other]};
      if (left.count(column < other ? Pair{p, q} : Pair{q, p}) != 0) ++pairs;
    }
    return pairs;
  };
  std::vector<Choices> rows;
  while (!left.empty() || rows.size() < 64) {
    Choices row;
    row.fill(-1);
    // Begin with a pair that is left, and go on from the column after it, all around.
    std::size_t first = 0;
    if (!left.empty()) {
      const Pair pair = *left.begin();
      row[pair.first.first] = pair.first.second;
      row[pair.second.first] = pair.second.second;
      first = pair.second.first;
    }
    for (std::size_t n = 0; n < kNumberOfChoices; ++n) {
      const std::size_t column = (first + n) % kNumberOfChoices;
      if (row[column] >= 0) continue;
      int best = 0, most = -1;
      for (int k = 0; k < kChoices[column]; ++k) {
        const int value = (k + static_cast<int>(rows.size() + column)) % kChoices[column];
        const int pairs = covers(row, column, value, kNumberOfChoices);
        if (pairs > most) best = value, most = pairs;
      }
      row[column] = best;
    }
    for (std::size_t a = 0; a < kNumberOfChoices; ++a) {
      for (std::size_t b = a + 1; b < kNumberOfChoices; ++b) left.erase({{a, row[a]}, {b, row[b]}});
    }
    rows.push_back(row);
  }
  return rows;
}

// --- projection

// R5's rounding, in a number of the code base.
template <typename Number>
Number rounded(Number value, int rounding) {
  const Number half = Number(1) / 2;
  switch (rounding) {
    case 0:
      return std::floor(value + half);
    case 1:
      return std::nearbyint(value);
    case 2:
      return value < 0 ? -std::floor(-value + half) : std::floor(value + half);
    case 3:
      return std::floor(value);
    case 4:
      return std::trunc(value);
    default:
      return std::ceil(value);
  }
}

constexpr std::array<int, 4> kGridBits{-1, 8, 4, 2};
constexpr double kFarthest = 1 << 14;

// A position on one axis, in pixels. In integers without a grid it is one of 16 bits.
template <typename Number>
double projected(const Choices& choices, int axis, double numerator, double w, int length) {
  Number q = static_cast<Number>(numerator) / static_cast<Number>(w);
  if (choices[kViewport] == 1) q = q * static_cast<Number>(length - 1) / static_cast<Number>(length);
  if (choices[kViewport] == 2) q += Number(1) / 4;
  if (choices[kBlur] == 1) q = static_cast<Number>(static_cast<float>(q + Number(128)) - 128.0f);
  int bits = axis == 1 && choices[kOtherBits] == 1 ? 6 : kGridBits[static_cast<std::size_t>(choices[kBits])];
  if (bits < 0 && choices[kCode] == 0) bits = 16;
  if (bits < 0) return static_cast<double>(q);
  const auto scale = static_cast<Number>(1 << bits);
  return static_cast<double>(rounded(q * scale, choices[kRounding]) / scale);
}

double position(const Choices& choices, int axis, double numerator, double w, int length) {
  return choices[kCode] == 1 ? projected<float>(choices, axis, numerator, w, length)
                             : projected<double>(choices, axis, numerator, w, length);
}

// --- cutting

// Pixel-homogeneous, W > 0.
struct Vertex {
  double x, y, z, w;
  int edge;  // the triangle's edge that goes on from here, or kCutEdge
};
constexpr int kCutEdge = 3;

// The part of the polygon where `inside` is not negative. New vertices are rounded as the code base has it.
template <typename Number, typename Inside>
std::vector<Vertex> cut(const std::vector<Vertex>& polygon, const Inside& inside) {
  std::vector<Vertex> part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const auto da = static_cast<Number>(inside(a)), db = static_cast<Number>(inside(b));
    if (da >= 0) part.push_back(a);
    if ((da < 0) == (db < 0)) continue;
    // From the smaller one: the other one may be larger by far, and then little of this one would be left.
    const auto size = [](const Vertex& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.w)}); };
    const bool from_a = size(a) <= size(b);
    const Vertex &from = from_a ? a : b, &to = from_a ? b : a;
    const Number t = std::abs(from_a ? da : db) / std::abs(da - db);
    const auto between = [t](double p, double q) {
      return static_cast<double>(static_cast<Number>(p) + t * (static_cast<Number>(q) - static_cast<Number>(p)));
    };
    part.push_back({between(from.x, to.x), between(from.y, to.y), between(from.z, to.z), between(from.w, to.w),
                    da >= 0 ? kCutEdge : a.edge});
  }
  return part;
}

template <typename Number>
std::vector<Vertex> cut_polygon(const Choices& choices, const std::array<Vertex, 3>& triangle, int width, int height,
                                bool depth) {
  std::vector<Vertex> polygon(triangle.begin(), triangle.end());
  const auto keep = [&polygon](const auto& inside) { polygon = cut<Number>(polygon, inside); };
  if (depth) {
    keep([](const Vertex& v) { return v.z; });
    keep([](const Vertex& v) { return v.w - v.z; });
  }
  if (choices[kBorder] == 0) return polygon;
  const double beyond = cuts_beyond(choices);
  keep([=](const Vertex& v) { return v.x + beyond * v.w; });
  keep([=](const Vertex& v) { return (width + beyond) * v.w - v.x; });
  keep([=](const Vertex& v) { return v.y + beyond * v.w; });
  keep([=](const Vertex& v) { return (height + beyond) * v.w - v.y; });
  return polygon;
}

// --- edges

struct Corner {
  double x, y;
};

// Positions are float32, or have 16 bits and less than 15 before them, or are doubles that no sample lies on: in long
// double the sign is right. The code base in integers has units of 1/(12 65536) pixel, which sevens of twelfths are, too.
int side_of(const Choices& choices, const Corner& p, const Corner& q, const Corner& s) {
  if (choices[kCode] == 0) {
    constexpr double kUnits = 12.0 * 65536;
    const auto whole = [](double v) { return static_cast<__int128>(std::llround(v * kUnits)); };
    const __int128 e =
        (whole(q.x) - whole(p.x)) * (whole(s.y) - whole(p.y)) - (whole(q.y) - whole(p.y)) * (whole(s.x) - whole(p.x));
    return e > 0 ? 1 : e < 0 ? -1 : 0;
  }
  // From the same end whichever triangle asks, so that neighbours round alike.
  const bool turn = std::pair(q.x, q.y) < std::pair(p.x, p.y);
  const Corner &a = turn ? q : p, &b = turn ? p : q;
  const long double ax = a.x, ay = a.y;
  const long double e = (b.x - ax) * (s.y - ay) - (b.y - ay) * (s.x - ax);
  const int sign = e > 0 ? 1 : e < 0 ? -1 : 0;
  return turn ? -sign : sign;
}

// Which way the polygon turns, and how much.
int turn_of(const Choices& choices, const std::vector<Corner>& c, double& twice_area) {
  if (c.size() == 3) {
    twice_area = std::abs((c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x));
    return side_of(choices, c[0], c[1], c[2]);
  }
  double sum = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Corner &p = c[i], &q = c[(i + 1) % c.size()];
    sum += (p.x - c[0].x) * (q.y - c[0].y) - (p.y - c[0].y) * (q.x - c[0].x);
  }
  twice_area = std::abs(sum);
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

// Does the edge from p to q, the inside to its right, own the samples on it?
bool owns(const Choices& choices, const Corner& p, const Corner& q, bool front, int edge) {
  const double dx = q.x - p.x, dy = q.y - p.y;
  const bool top_left = dy < 0 || (dy == 0 && dx > 0);
  switch (choices[kOwners]) {
    case 0:
      return top_left;
    case 1:
      return !top_left;
    case 2:
      return dx > 0 || (dx == 0 && dy < 0);  // southwards: the top ones, and the left of upright ones
    case 3:
      return true;
    case 4:
      return false;
    case 5:
      return top_left || dy == 0;
    case 6:
      return front == top_left;
    default:
      return edge == 0;
  }
}

// Does the polygon, the inside to the right of its edges, cover the sample? It is a fan of triangles; what lies between two
// of them is inside. Those that snapping has turned over are left out.
bool covers(const Choices& choices, const std::vector<Corner>& c, const std::vector<int>& edges, bool front,
            const Corner& s) {
  for (std::size_t n = 1; n + 1 < c.size(); ++n) {
    const std::array<std::size_t, 3> corner{0, n, n + 1};
    if (side_of(choices, c[0], c[n], c[n + 1]) <= 0) continue;
    bool inside = true;
    for (std::size_t i = 0; i < 3 && inside; ++i) {
      const std::size_t from = corner[i], to = corner[(i + 1) % 3];
      const int side = side_of(choices, c[from], c[to], s);
      const bool between = to != (from + 1) % c.size();
      inside = side > 0 || (side == 0 && (between || owns(choices, c[from], c[to], front, edges[from])));
    }
    if (inside) return true;
  }
  return false;
}

double stored(const Choices& choices, double z) {
  if (choices[kRange] == 1) z = (static_cast<float>(2 * z - 1) + 1.0f) * 0.5f;
  switch (choices[kFormat]) {
    case 0:
      return static_cast<float>(z);
    case 1:
      return z;
    case 2:
      return std::floor(z * 16777215.0 + 0.5) / 16777215.0;
    default:
      return std::floor(z * 65535.0 + 0.5) / 65535.0;
  }
}

struct Plane {
  double x, y, one;
};

Plane plane_of(const std::array<std::array<double, 3>, 3>& v) {
  const double bx = v[1][0] - v[0][0], by = v[1][1] - v[0][1], bz = v[1][2] - v[0][2], cx = v[2][0] - v[0][0],
               cy = v[2][1] - v[0][1], cz = v[2][2] - v[0][2], det = bx * cy - by * cx;
  if (det == 0) return {0, 0, v[0][2]};
  const Plane plane{(bz * cy - by * cz) / det, (bx * cz - bz * cx) / det, 0};
  return {plane.x, plane.y, v[0][2] - plane.x * v[0][0] - plane.y * v[0][1]};
}

// Barycentrics and attributes at the sample: weights in the numbers of the code base, each rounded as it comes.
template <typename Number>
void interpolate(const surefill_adapter_draw& draw, std::uint32_t t, std::uint32_t attributes,
                 const std::array<std::array<double, 3>, 3>& seen, const Corner& s, const surefill_adapter_image& image,
                 std::size_t at) {
  std::array<Number, 3> affine{}, perspective{};
  const std::uint32_t* indices = draw.indices + 3 * std::size_t{t};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &p = seen[(i + 1) % 3], &q = seen[(i + 2) % 3];
    affine[i] = static_cast<Number>((q[0] - p[0]) * (s.y - p[1]) - (q[1] - p[1]) * (s.x - p[0]));
    perspective[i] = affine[i] / static_cast<Number>(draw.pixel[4 * std::size_t{indices[i]} + 3]);
  }
  const auto mean = [](const std::array<Number, 3>& weights, const std::array<Number, 3>& u) {
    const Number sum = weights[0] + weights[1] + weights[2];
    if (sum == 0) return static_cast<float>(u[0]);
    return static_cast<float>((weights[0] * u[0] + weights[1] * u[1] + weights[2] * u[2]) / sum);
  };
  for (std::size_t i = 0; i < 3 && image.barycentrics; ++i) {
    std::array<Number, 3> unit{};
    unit[i] = 1;
    image.barycentrics[3 * at + i] = mean(perspective, unit);
  }
  for (std::uint32_t k = 0; k < attributes && image.attributes; ++k) {
    const surefill_adapter_attribute& attribute = draw.attributes[k];
    if (!image.attributes[k]) continue;
    for (std::uint32_t c = 0; c < attribute.components; ++c) {
      std::array<Number, 3> u{};
      for (std::size_t i = 0; i < 3; ++i) u[i] = attribute.values[attribute.components * std::size_t{indices[i]} + c];
      image.attributes[k][attribute.components * at + c] =
          attribute.interpolation == SUREFILL_ADAPTER_CONSTANT ? static_cast<float>(u[0])
          : attribute.interpolation == SUREFILL_ADAPTER_AFFINE ? mean(affine, u)
                                                               : mean(perspective, u);
    }
  }
}

constexpr std::array<std::array<double, 2>, 4> kPlaces{{{0.5, 0.5}, {0, 0}, {0.25, 0.75}, {7.0 / 12, 7.0 / 12}}};

}  // namespace

const std::vector<Choices>& right_rasterizers() {
  static const std::vector<Choices> all = pairwise();
  return all;
}

std::string right_name(std::size_t number) {
  return "right-" + std::to_string(number);
}

std::string right_text(const Choices& c) {
  const auto word = [&c](Choice choice, std::initializer_list<const char*> words) {
    return std::string(words.begin()[c[choice]]);
  };
  return word(kCode, {"integers", "float32", "double"}) + ", samples at " +
         word(kPlace, {"(1/2, 1/2)", "(0, 0)", "(1/4, 3/4)", "(7/12, 7/12)"}) + ", grid " +
         word(kBits, {"none", "8", "4", "2"}) + word(kOtherBits, {"", " and 6 in y"}) + " " +
         word(kRounding, {"nearest-up", "nearest-even", "nearest-away", "floor", "truncate", "ceiling"}) + ", " +
         word(kOwners, {"top-left", "bottom-right", "southwards", "closed", "open", "both own level edges", "by facing",
                        "by order"}) +
         word(kBlur, {"", ", blurred"}) + word(kViewport, {"", ", viewport a pixel less", ", moved by 1/4"}) +
         ", depth " + word(kFormat, {"float32", "double", "24 bits", "16 bits"}) +
         word(kClip, {"", ", clipped", ", clipped by cutting", ", cut where asked"}) +
         word(kRange, {"", ", from -1 to 1"}) + word(kClear, {"", ", cleared to 1"}) +
         word(kTest, {", less", ", lequal"}) + word(kNear, {"", ", W above 1/64"}) +
         word(kFacing, {"", ", culls back", ", culls front"}) +
         word(kSlivers, {"", ", leaves out turned ones", ", leaves out small ones"}) +
         (c[kBorder] == 0 ? "" : ", cuts " + std::to_string(static_cast<int>(cuts_beyond(c))) + " pixels beyond");
}

bool draw_right(const Choices& choices, const surefill_adapter_scene& scene, const surefill_adapter_image& image) {
  const int width = static_cast<int>(scene.width), height = static_cast<int>(scene.height);
  const std::size_t total = std::size_t{scene.width} * scene.height;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> buffer(total, choices[kClear] == 1 ? 1 : kInfinity);
  if (image.count) std::fill_n(image.count, total, 0u);
  if (image.index) std::fill_n(image.index, total, SUREFILL_ADAPTER_EMPTY);
  if (image.depth) std::fill_n(image.depth, total, std::numeric_limits<float>::infinity());
  if (image.barycentrics) std::fill_n(image.barycentrics, 3 * total, 0.0f);
  for (std::uint32_t k = 0; k < scene.attribute_count && image.attributes; ++k) {
    if (image.attributes[k]) std::fill_n(image.attributes[k], scene.draws[0].attributes[k].components * total, 0.0f);
  }
  const auto& place = kPlaces[static_cast<std::size_t>(choices[kPlace])];
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& draw = scene.draws[d];
    for (std::uint32_t t = 0; t < draw.triangle_count; ++t) {
      std::array<Vertex, 3> given{};
      std::array<std::array<double, 3>, 3> v{};
      bool behind = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const float* p = draw.pixel + 4 * std::size_t{draw.indices[3 * t + i]};
        given[i] = {p[0], p[1], p[2], p[3], static_cast<int>(i)};
        v[i] = {static_cast<double>(p[0]) / p[3], static_cast<double>(p[1]) / p[3], static_cast<double>(p[2]) / p[3]};
        if (!(std::abs(v[i][0]) < kFarthest) || !(std::abs(v[i][1]) < kFarthest)) return false;
        behind = behind || (choices[kNear] == 1 && p[3] < 1.0f / 64);
      }
      if (behind) continue;
      const bool clips = choices[kClip] == 1 || choices[kClip] == 2 || draw.depth_mode == SUREFILL_ADAPTER_CLIP_DEPTH;
      const bool cuts = clips && choices[kClip] != 1;
      const std::vector<Vertex> polygon = choices[kCode] == 1
                                              ? cut_polygon<float>(choices, given, width, height, cuts)
                                              : cut_polygon<double>(choices, given, width, height, cuts);
      if (polygon.size() < 3) continue;
      std::vector<Corner> c;
      std::vector<int> edges;
      double twice_area = 0;
      for (const Vertex& p : polygon) {
        c.push_back({position(choices, 0, p.x, p.w, width), position(choices, 1, p.y, p.w, height)});
        edges.push_back(p.edge);
      }
      const double before = (v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[1][1] - v[0][1]) * (v[2][0] - v[0][0]);
      const int turn = turn_of(choices, c, twice_area);
      if (turn == 0) continue;
      if (choices[kSlivers] == 1 && turn * before < 0) continue;
      if (choices[kSlivers] == 2 && twice_area < 1.0 / 64) continue;
      const bool front = turn > 0;
      if (choices[kFacing] != 0 && front == (choices[kFacing] == 2)) continue;
      if (!front) {
        std::reverse(c.begin() + 1, c.end());
        std::reverse(edges.begin(), edges.end());
      }
      // Depth is that of the triangle as it is seen: moved with the viewport.
      std::array<std::array<double, 3>, 3> seen = v;
      for (auto& corner : seen) {
        if (choices[kViewport] == 1) corner[0] *= (width - 1.0) / width, corner[1] *= (height - 1.0) / height;
        if (choices[kViewport] == 2) corner[0] += 0.25, corner[1] += 0.25;
      }
      const Plane plane = plane_of(seen);
      const auto pixel = [](double at, int length) { return static_cast<int>(std::clamp(at, 0.0, 1.0 * length)); };
      const auto [left, right] =
          std::minmax_element(c.begin(), c.end(), [](const Corner& a, const Corner& b) { return a.x < b.x; });
      const auto [top, bottom] =
          std::minmax_element(c.begin(), c.end(), [](const Corner& a, const Corner& b) { return a.y < b.y; });
      for (int y = pixel(top->y - 1, height); y < pixel(bottom->y + 2, height); ++y) {
        for (int x = pixel(left->x - 1, width); x < pixel(right->x + 2, width); ++x) {
          const Corner s{x + place[0], y + place[1]};
          const bool inside = covers(choices, c, edges, front, s);
          if (!inside) continue;
          const double z = plane.x * s.x + plane.y * s.y + plane.one;
          if (clips && (z < 0 || z > 1)) continue;
          const auto at = static_cast<std::size_t>(y) * scene.width + static_cast<std::size_t>(x);
          if (image.count) ++image.count[at];
          const double depth = stored(choices, z);
          if (choices[kTest] == 0 ? !(depth < buffer[at]) : !(depth <= buffer[at])) continue;
          buffer[at] = depth;
          if (image.index) image.index[at] = draw.identifiers[t];
          if (image.depth) image.depth[at] = static_cast<float>(depth);
          if (choices[kCode] == 1) {
            interpolate<float>(draw, t, scene.attribute_count, seen, s, image, at);
          } else {
            interpolate<double>(draw, t, scene.attribute_count, seen, s, image, at);
          }
        }
      }
    }
  }
  return true;
}

}  // namespace surefill::zoo
