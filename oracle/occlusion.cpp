// SPDX-License-Identifier: Apache-2.0
//
// The first oracle's occlusion: signs of edge functions at corners of squares, planes in integers, edges in a table.
#include "oracle/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "oracle/conservative.hpp"
#include "oracle/triangle.hpp"

namespace surefill::oracle {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool is_greater(const Target& target) {
  return target.depth_test == DepthTest::greater;
}

Ratio negated(const Ratio& z) {
  return {-z.n, z.d};
}
Ratio smaller(const Ratio& a, const Ratio& b) {
  return less(b, a) ? b : a;
}
Ratio larger(const Ratio& a, const Ratio& b) {
  return less(a, b) ? b : a;
}

// The real number that a finite float is.
Ratio ratio_of(float value) {
  const int exponent = std::min(odd_exponent(value), 0);
  Ratio result{scaled_integer(value, exponent), 1};
  result.d <<= static_cast<mp_bitcnt_t>(-exponent);
  return result;
}

// O4: the least float32 not below z; 0 is +0, and beyond range it is +inf.
float least_not_below(const Ratio& z) {
  float result = nearest_finite(z.n, z.d);
  if (less(ratio_of(result), z)) result = std::nextafter(result, kInfinity);
  return result == 0 ? 0.0f : result;
}

// The mirror image.
float greatest_not_above(const Ratio& z) {
  const float result = -least_not_below(negated(z));
  return result == 0 ? 0.0f : result;
}

// --- Faces and occluders

Position position_of(const Vertex& v) {
  return {v.x, v.y, v.w};
}

// For each vertex of a draw the first one that is one with it.
std::vector<std::size_t> firsts_of(const Draw& draw, Positions positions) {
  std::map<std::array<float, 3>, std::size_t> first;
  std::vector<std::size_t> result;
  for (std::size_t v = 0; v < draw.vertices.size(); ++v) {
    const Vertex& vertex = draw.vertices[v];
    std::array<float, 3> place = positions.empty() ? std::array{vertex.x, vertex.y, vertex.w} : positions[v];
    bool is_number = true;
    for (float& number : place) {
      is_number = is_number && !std::isnan(number);
      if (number == 0) number = 0;  // -0 is 0
    }
    result.push_back(is_number ? first.emplace(place, v).first->second : v);
  }
  return result;
}

struct Face {
  std::array<Vertex, 3> v;
  std::array<std::size_t, 3> first;  // of each vertex
  Cone cone;
};

// The faces of one side: those with a D of this sign.
std::vector<Face> faces_of(const Draw& draw, std::span<const std::size_t> firsts, int sign) {
  std::vector<Face> faces;
  if (is_culled(draw, sign)) return faces;
  for (std::size_t t = 0; t < primitives_of(draw); ++t) {
    if (!is_finite(draw, t)) continue;
    std::array<Vertex, 3> v{};
    std::array<std::size_t, 3> first{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = draw.indices[3 * t + i];
      v[i] = draw.vertices[corner], first[i] = firsts[corner];
    }
    const Cone cone({position_of(v[0]), position_of(v[1]), position_of(v[2])}, draw.fill_rule);
    if (cone.sign_of_det() == sign) faces.push_back({v, first, cone});
  }
  return faces;
}

// An edge in one of its directions: from the smaller number of a vertex to the larger.
using Edge = std::pair<std::size_t, std::size_t>;

struct EdgeUse {
  std::array<Position, 2> ends;
  int balance = 0;                 // faces that have it in this direction, minus those in the other
  std::vector<std::size_t> faces;  // all of them
};

std::map<Edge, EdgeUse> edges_of(const std::vector<Face>& faces) {
  std::map<Edge, EdgeUse> edges;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t from = faces[f].first[i], to = faces[f].first[(i + 1) % 3];
      EdgeUse& use = edges[std::minmax(from, to)];
      use.ends = {position_of(faces[f].v[i]), position_of(faces[f].v[(i + 1) % 3])};
      use.balance += from < to ? 1 : -1;
      use.faces.push_back(f);
    }
  }
  return edges;
}

struct Occluder {
  std::vector<const Face*> faces;
  std::vector<std::array<Position, 2>> rim;
};

std::vector<Occluder> occluders_of(const std::vector<Face>& faces) {
  const std::map<Edge, EdgeUse> edges = edges_of(faces);
  // Each face goes by the smallest number of those that a chain links it with.
  std::vector<std::size_t> number(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) number[f] = f;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [edge, use] : edges) {
      if (use.balance != 0) continue;
      std::size_t smallest = number[use.faces[0]];
      for (const std::size_t f : use.faces) smallest = std::min(smallest, number[f]);
      for (const std::size_t f : use.faces) {
        changed |= number[f] != smallest;
        number[f] = smallest;
      }
    }
  }
  std::map<std::size_t, Occluder> occluders;
  for (std::size_t f = 0; f < faces.size(); ++f) occluders[number[f]].faces.push_back(&faces[f]);
  for (const auto& [edge, use] : edges) {
    if (use.balance == 0) continue;
    std::vector<std::size_t> of;
    for (const std::size_t f : use.faces) of.push_back(number[f]);
    std::ranges::sort(of);
    of.erase(std::unique(of.begin(), of.end()), of.end());
    for (const std::size_t n : of) occluders[n].rim.push_back(use.ends);
  }
  std::vector<Occluder> result;
  for (auto& [n, occluder] : occluders) result.push_back(std::move(occluder));
  return result;
}

// --- Squares

struct Range {
  Ratio low, high;
};

// What a face may have as depth on a square that its T meets.
class Depths {
 public:
  explicit Depths(const std::array<Vertex, 3>& v) : Depths(Edges(integer_vertices(v))) {}

  Range range(const Rect& square) const {
    std::array<Ratio, 4> z;
    for (int n = 0; n < 4; ++n) {
      Ratio& corner = z[static_cast<std::size_t>(n)];
      plane_.at(square.corner(n), corner.n);
      corner.d = divisor_;
    }
    Range result{smaller(smaller(z[0], z[1]), smaller(z[2], z[3])), larger(larger(z[0], z[1]), larger(z[2], z[3]))};
    if (vertices_) {
      result.low = larger(result.low, vertices_->low);
      result.high = smaller(result.high, vertices_->high);
    }
    return result;
  }

 private:
  explicit Depths(const Edges& edges)
      : plane_(edges.weighted_sum(edges.vertex(0).z, edges.vertex(1).z, edges.vertex(2).z)), divisor_(edges.det16()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const IntegerVertex& m = edges.vertex(i);
      if (m.w <= 0) {
        vertices_.reset();
        return;
      }
      const Ratio z{m.z, m.w};
      vertices_ = i == 0 ? Range{z, z} : Range{smaller(vertices_->low, z), larger(vertices_->high, z)};
    }
  }

  Edges::Plane plane_;
  Integer divisor_;
  std::optional<Range> vertices_;  // if all W > 0
};

// What is known of a square and an occluder.
struct Square {
  bool centre = false, rim = false;
  std::optional<Range> range;  // of all its faces whose T meets the square: smallest to largest
};

// z_o of a square that an occluder fills, but for depth clipping; or nothing.
std::optional<float> depth_of(const Square& square, const Target& target, DepthMode mode) {
  if (!square.centre || square.rim) return std::nullopt;
  const Ratio zero{0, 1}, one{1, 1};
  const Range& all = square.range.value();
  if (mode == DepthMode::clip && (less(all.low, zero) || less(one, all.high))) return std::nullopt;
  Ratio z = is_greater(target) ? all.low : all.high;
  if (mode == DepthMode::clamp) z = smaller(larger(z, zero), one);
  return is_greater(target) ? greatest_not_above(z) : least_not_below(z);
}

void draw_occluder(const Target& target, DepthMode mode, const Occluder& occluder, std::vector<float>& depth) {
  const Rect all = pixels_of(target);
  std::vector<Square> squares(depth.size());
  const auto place = [&all](int x, int y) {
    return static_cast<std::size_t>(y - all.y0) * static_cast<std::size_t>(all.x1 - all.x0) +
           static_cast<std::size_t>(x - all.x0);
  };
  for (const auto& [from, to] : occluder.rim) {
    visit_edge(from, to, all, [&](int x, int y) { squares[place(x, y)].rim = true; });
  }
  Target plain;
  plain.width = target.width, plain.height = target.height, plain.origin = target.origin;
  const Pattern centres(plain);
  for (const Face* face : occluder.faces) {
    visit_covered(face->cone, face->cone.bounds(all), centres, kAllEdges,
                  [&](int x, int y, int) { squares[place(x, y)].centre = true; });
  }
  for (const Face* face : occluder.faces) {
    const Depths depths(face->v);
    visit_conservative(face->cone, face->cone.bounds(all), Conservative::over, [&](int x, int y) {
      Square& square = squares[place(x, y)];
      if (!square.centre || square.rim) return;  // nobody asks
      const Range range = depths.range({x, y, x + 1, y + 1});
      square.range =
          square.range ? Range{smaller(square.range->low, range.low), larger(square.range->high, range.high)} : range;
    });
  }
  for (std::size_t s = 0; s < squares.size(); ++s) {
    const std::optional<float> z = depth_of(squares[s], target, mode);
    if (z) depth[s] = is_greater(target) ? std::max(depth[s], *z) : std::min(depth[s], *z);
  }
}

// --- Queries

// The first and the last number of a closed interval of reals, in one dimension of the screen.
struct Extent {
  Ratio low, high;
};

Integer floor_of(const Ratio& z) {
  Integer result;
  mpz_fdiv_q(result.get_mpz_t(), z.n.get_mpz_t(), z.d.get_mpz_t());
  return result;
}

// The places of [first, last] among `count` from `begin` on that are reached, as half-open range from 0. O5: [i, i + 1)
// meets the extent; O2: i + 1/2 lies in it.
std::pair<std::size_t, std::size_t> reached(const Extent& extent, bool squares, int begin, int count) {
  Integer first, last;
  if (squares) {
    first = floor_of(extent.low), last = floor_of(extent.high);
  } else {
    // The smallest i >= low - 1/2 and the largest i <= high - 1/2.
    first = -floor_of({extent.low.d - 2 * extent.low.n, 2 * extent.low.d});
    last = floor_of({2 * extent.high.n - extent.high.d, 2 * extent.high.d});
  }
  if (less(extent.high, extent.low)) return {0, 0};
  first -= begin, last -= begin;
  const Integer end = std::clamp(Integer(last + 1), Integer(0), Integer(count));
  first = std::clamp(first, Integer(0), Integer(count));
  return {first.get_ui(), std::max(first, end).get_ui()};
}

// Is a box of this nearest depth hidden at a place of this depth?
bool is_hidden(const Target& target, float d, float depth, bool equal_is_visible) {
  if (d == depth) return !equal_is_visible;
  return is_greater(target) ? d < depth : d > depth;
}

// `d` is nothing if it is nearer than anything.
Occlusion answer(const Target& target, std::span<const float> depth, const Extent& x, const Extent& y,
                 std::optional<float> d, OcclusionRule rule) {
  const auto [x0, x1] = reached(x, rule.safe, target.origin.x, target.width);
  const auto [y0, y1] = reached(y, rule.safe, target.origin.y, target.height);
  if (x0 == x1 || y0 == y1) return Occlusion::outside;
  for (std::size_t row = y0; row < y1; ++row) {
    for (std::size_t column = x0; column < x1; ++column) {
      const float stored = depth[row * static_cast<std::size_t>(target.width) + column];
      if (!d || !is_hidden(target, *d, stored, rule.equal_is_visible)) return Occlusion::visible;
    }
  }
  return Occlusion::hidden;
}

// Of an infinite side of a rectangle, what no target reaches.
Ratio side_of(float value) {
  if (std::isinf(value)) return {value > 0 ? 1 << 30 : -(1 << 30), 1};
  return ratio_of(value);
}

}  // namespace

std::vector<float> safe_depth(const Target& target, std::span<const Draw> occluders,
                              std::span<const Positions> positions) {
  const StandardFloats standard;
  std::vector<float> depth(static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height),
                           is_greater(target) ? -kInfinity : kInfinity);
  for (std::size_t n = 0; n < occluders.size(); ++n) {
    const Draw& draw = occluders[n];
    const std::vector<std::size_t> firsts = firsts_of(draw, positions.empty() ? Positions{} : positions[n]);
    for (const int sign : {1, -1}) {
      const std::vector<Face> faces = faces_of(draw, firsts, sign);
      for (const Occluder& occluder : occluders_of(faces)) draw_occluder(target, draw.depth_mode, occluder, depth);
    }
  }
  return depth;
}

Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionBox& box, OcclusionRule rule) {
  const StandardFloats standard;
  std::vector<Ratio> x, y, z;
  for (const Vertex& v : box.corners) {
    if (v.w <= 0) continue;
    const IntegerVertex m = integer_vertices({v, v, v})[0];
    x.push_back({m.x, m.w}), y.push_back({m.y, m.w}), z.push_back({m.z, m.w});
  }
  if (z.empty()) return Occlusion::outside;
  const Ratio all = side_of(kInfinity);
  if (z.size() < 8) return answer(target, depth, {negated(all), all}, {negated(all), all}, std::nullopt, rule);
  const auto extent = [](const std::vector<Ratio>& values) {
    const auto [low, high] = std::ranges::minmax_element(values, less);
    return Extent{*low, *high};
  };
  const Extent depths = extent(z);
  const Ratio& nearest = is_greater(target) ? depths.high : depths.low;
  return answer(target, depth, extent(x), extent(y), nearest_finite(nearest.n, nearest.d), rule);
}

Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                 OcclusionRule rule) {
  const StandardFloats standard;
  return answer(target, depth, {side_of(rectangle.x0), side_of(rectangle.x1)},
                {side_of(rectangle.y0), side_of(rectangle.y1)}, rectangle.nearest_depth, rule);
}

}  // namespace surefill::oracle
