// SPDX-License-Identifier: Apache-2.0
//
// The second oracle's occlusion: faces and rims are clipped to the neighbourhood of the target, projected, and cut into
// strips of pixels; depth is taken where rays through the corners of squares meet planes. Space is moved by the target's
// origin (S6), exactly, so that pixel (0, 0) is the target's first.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "oracle/clipped_plane.hpp"
#include "oracle/clipped_polygon.hpp"
#include "oracle/occlusion.hpp"

namespace surefill::oracle::clipped {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Real depth as it counts: greater tests turn it round, so that less is nearer.
struct Sense {
  int sign;
  explicit Sense(const Target& target) : sign(target.depth_test == DepthTest::greater ? -1 : 1) {}
};

std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

// O4's rounding: among the finite floats around z the least that is not below, else +inf; never -0.
float rounded_up(const Rational& z) {
  const float near = nearest_float(z);
  if (exact(near) >= z) return near;
  if (bits_of(near) == 0) return std::bit_cast<float>(1u);
  // Of a positive float the next larger one has the next bits, and past the last one it is +inf; of a negative one the
  // bits before.
  const float next = std::bit_cast<float>(bits_of(near) >> 31 ? bits_of(near) - 1 : bits_of(near) + 1);
  return bits_of(next) == 0x80000000u ? 0.0f : next;
}

float rounded_for(const Sense& sense, const Rational& z) {
  const float up = rounded_up(sense.sign * z);
  return sense.sign > 0 || bits_of(up) == 0 ? up : std::bit_cast<float>(bits_of(up) ^ 0x80000000u);
}

struct Triangle {
  std::array<std::uint32_t, 3> corners{};  // numbers of vertices
  std::array<Vector, 3> m;
  std::array<Rational, 3> z;
  std::vector<Point> polygon;  // what is seen of it near the target
  int orientation = 0;         // sign of D
  std::size_t occluder = 0;
  bool has_occluder = false;
};

// Numbers of equal value: a NaN equals nothing.
bool equal(float a, float b) {
  const std::uint32_t x = bits_of(a) & 0x7FFFFFFFu, y = bits_of(b) & 0x7FFFFFFFu;
  if (x > 0x7F800000u || y > 0x7F800000u) return false;
  return bits_of(a) == bits_of(b) || (x == 0 && y == 0);
}

bool is_finite(const Draw& draw, const std::array<std::uint32_t, 3>& corners) {
  const auto finite = [](float value) { return (bits_of(value) & 0x7F800000u) != 0x7F800000u; };
  for (const std::uint32_t corner : corners) {
    const Vertex& v = draw.vertices[corner];
    if (!finite(v.x) || !finite(v.y) || !finite(v.z) || !finite(v.w)) return false;
    for (const AttributeArray& array : draw.attributes) {
      const std::size_t stride = array.stride == 0 ? array.components : array.stride;
      for (std::size_t c = 0; c < array.components; ++c) {
        if (!finite(array.values[corner * stride + c])) return false;
      }
    }
  }
  return true;
}

// A polygon, or an edge as one of two corners, clipped to one pixel more than the target on each side, and projected. The
// eye is not in it.
std::vector<Point> seen(std::vector<Corner> corners, const Target& target) {
  corners = clip_to_box(std::move(corners), -1, target.width + 1, -1, target.height + 1);
  std::vector<Point> points;
  for (const Corner& corner : corners) points.push_back({corner.x / corner.w, corner.y / corner.w});
  return points;
}

Corner corner_of(const Vector& m) {
  return {m.x, m.y, 0, m.w};
}

// Calls visit(x, y) for the closed pixel squares that a closed convex polygon meets: of each strip of squares what lies
// in it reaches from a first to a last one.
template <typename Visit>
void visit_met(const std::vector<Point>& polygon, const Target& target, const Visit& visit) {
  for (int y = 0; y < target.height; ++y) {
    const auto extent = x_extent(polygon, y, y + 1);
    if (!extent) continue;
    const Rational first = ceil(extent->first) - 1, last = floor(extent->second);
    for (int x = 0; x < target.width; ++x) {
      if (first <= x && x <= last) visit(x, y);
    }
  }
}

// Calls visit(x, y) for the pixels whose centres the fill rule gives the triangle.
template <typename Visit>
void visit_centres(const Triangle& triangle, FillRule rule, const Target& target, const Visit& visit) {
  const Shift shift = shift_of(rule);
  const bool along_x = shift.x_dominates;
  const Outline outline(triangle.polygon, shift);
  const int lines = along_x ? target.height : target.width, length = along_x ? target.width : target.height;
  for (int line = 0; line < lines && !triangle.polygon.empty(); ++line) {
    const std::vector<Crossing> crossings =
        rule == FillRule::closed ? chord_crossings(triangle.polygon, true, triangle.orientation, line, 8, 8, length)
                                 : outline.crossings(line, 8, 8, length);
    for (int pixel = 0; pixel < length; ++pixel) {
      if (winding(crossings, pixel) == 0) continue;
      if (along_x) {
        visit(pixel, line);
      } else {
        visit(line, pixel);
      }
    }
  }
}

// One draw.
class Occluders {
 public:
  Occluders(const Target& target, const Draw& draw, Positions positions)
      : target_(target), draw_(draw), positions_(positions), sense_(target) {
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) add(t);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!triangles_[t].has_occluder) link(t);
    }
  }

  void draw(std::vector<float>& depth) const {
    for (std::size_t n = 0; n < count_; ++n) draw(n, depth);
  }

 private:
  void add(std::size_t t) {
    const std::array<std::uint32_t, 3> corners = {draw_.indices[3 * t], draw_.indices[3 * t + 1],
                                                  draw_.indices[3 * t + 2]};
    if (!is_finite(draw_, corners)) return;
    Triangle triangle;
    triangle.corners = corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& v = draw_.vertices[corners[i]];
      const Rational w = exact(v.w);
      triangle.m[i] = {exact(v.x) - target_.origin.x * w, exact(v.y) - target_.origin.y * w, w};
      triangle.z[i] = exact(v.z);
    }
    const auto& m = triangle.m;
    triangle.orientation = sgn(dot(m[0], cross(m[1], m[2])));
    if (triangle.orientation == 0) return;
    const bool front = draw_.front_face == FrontFace::clockwise ? triangle.orientation > 0 : triangle.orientation < 0;
    if (draw_.cull == (front ? Cull::front : Cull::back)) return;
    triangle.polygon = seen({corner_of(m[0]), corner_of(m[1]), corner_of(m[2])}, target_);
    triangles_.push_back(std::move(triangle));
  }

  // Are two vertices one?
  bool one(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    if (positions_.empty()) {
      const Vertex &v = draw_.vertices[a], &u = draw_.vertices[b];
      return equal(v.x, u.x) && equal(v.y, u.y) && equal(v.w, u.w);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!equal(positions_[a][k], positions_[b][k])) return false;
    }
    return true;
  }

  // The triangles of the same side as t that have the edge from `from` to `to` in this direction.
  std::vector<std::size_t> having(std::size_t t, std::uint32_t from, std::uint32_t to) const {
    std::vector<std::size_t> result;
    for (std::size_t n = 0; n < triangles_.size(); ++n) {
      if (triangles_[n].orientation != triangles_[t].orientation) continue;
      const auto& corners = triangles_[n].corners;
      for (std::size_t i = 0; i < 3; ++i) {
        if (one(corners[i], from) && one(corners[(i + 1) % 3], to)) result.push_back(n);
      }
    }
    return result;
  }

  // Gives the triangle, and all that chains link with it, a new occluder, and that its rims.
  void link(std::size_t t) {
    std::vector<std::size_t> waiting = {t};
    triangles_[t].has_occluder = true;
    rims_.emplace_back();
    while (!waiting.empty()) {
      const std::size_t next = waiting.back();
      waiting.pop_back();
      triangles_[next].occluder = count_;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = triangles_[next].corners[i], to = triangles_[next].corners[(i + 1) % 3];
        const std::vector<std::size_t> there = having(next, from, to), back = having(next, to, from);
        if (there.size() != back.size()) {
          const auto& m = triangles_[next].m;
          rims_.back().push_back(seen({corner_of(m[i]), corner_of(m[(i + 1) % 3])}, target_));
          continue;
        }
        for (const auto* side : {&there, &back}) {
          for (const std::size_t n : *side) {
            if (triangles_[n].has_occluder) continue;
            triangles_[n].has_occluder = true;
            waiting.push_back(n);
          }
        }
      }
    }
    ++count_;
  }

  void draw(std::size_t occluder, std::vector<float>& depth) const {
    std::vector<char> covered(depth.size()), rim(depth.size()), clipped(depth.size());
    std::vector<std::optional<Rational>> farthest(depth.size());
    const auto place = [this](int x, int y) {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + static_cast<std::size_t>(x);
    };
    for (const std::vector<Point>& edge : rims_[occluder]) {
      visit_met(edge, target_, [&](int x, int y) { rim[place(x, y)] = 1; });
    }
    for (const Triangle& triangle : triangles_) {
      if (triangle.occluder != occluder) continue;
      visit_centres(triangle, draw_.fill_rule, target_, [&](int x, int y) { covered[place(x, y)] = 1; });
    }
    for (const Triangle& triangle : triangles_) {
      if (triangle.occluder != occluder) continue;
      const TrianglePlane plane(triangle.m);
      visit_met(triangle.polygon, target_, [&](int x, int y) {
        const std::size_t s = place(x, y);
        if (rim[s] || !covered[s]) return;
        const auto [low, high] = range(triangle, plane, x, y);
        if (draw_.depth_mode == DepthMode::clip && (low < 0 || high > 1)) clipped[s] = 1;
        const Rational& far = sense_.sign > 0 ? high : low;
        if (!farthest[s] || (sense_.sign > 0 ? far > *farthest[s] : far < *farthest[s])) farthest[s] = far;
      });
    }
    for (std::size_t s = 0; s < depth.size(); ++s) {
      if (rim[s] || !covered[s] || clipped[s]) continue;
      Rational z = farthest[s].value();
      if (draw_.depth_mode == DepthMode::clamp) z = std::clamp(z, Rational(0), Rational(1));
      const float stored = rounded_for(sense_, z);
      if (sense_.sign > 0 ? stored < depth[s] : stored > depth[s]) depth[s] = stored;
    }
  }

  std::pair<Rational, Rational> range(const Triangle& triangle, const TrianglePlane& plane, int x, int y) const {
    std::optional<Rational> low, high;
    for (const int i : {0, 1}) {
      for (const int j : {0, 1}) {
        const Rational z = plane.depth_anywhere({x + i, y + j, 1}, triangle.z);
        if (!low || z < *low) low = z;
        if (!high || z > *high) high = z;
      }
    }
    if (std::ranges::all_of(triangle.m, [](const Vector& m) { return sgn(m.w) > 0; })) {
      std::array<Rational, 3> z;
      for (std::size_t i = 0; i < 3; ++i) z[i] = triangle.z[i] / triangle.m[i].w;
      low = std::max(*low, *std::ranges::min_element(z));
      high = std::min(*high, *std::ranges::max_element(z));
    }
    return {*low, *high};
  }

  const Target& target_;
  const Draw& draw_;
  Positions positions_;
  Sense sense_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::vector<Point>>> rims_;  // of each occluder
  std::size_t count_ = 0;
};

// --- Queries

// Which of the pixel places 0 .. count - 1 of a dimension, the first of which is `begin` in space, lie in R or R'.
std::vector<char> places(const Rational& low, const Rational& high, int begin, int count, bool squares) {
  std::vector<char> result;
  for (int n = 0; n < count; ++n) {
    const Rational first = begin + n, centre = first + Rational(1, 2);
    result.push_back(low > high ? 0 : squares ? low < first + 1 && high >= first : low <= centre && centre <= high);
  }
  return result;
}

Occlusion answer(const Target& target, std::span<const float> depth, const std::vector<char>& columns,
                 const std::vector<char>& rows, std::optional<float> d, OcclusionRule rule) {
  bool any = false, all = true;
  for (std::size_t s = 0; s < depth.size(); ++s) {
    const auto width = static_cast<std::size_t>(target.width);
    if (!rows[s / width] || !columns[s % width]) continue;
    any = true;
    // d is a number or an infinity, and so is depth: floats compare as these.
    const bool farther = d && (target.depth_test == DepthTest::greater ? *d < depth[s] : *d > depth[s]);
    all = all && (farther || (d && *d == depth[s] && !rule.equal_is_visible));
  }
  if (!any) return Occlusion::outside;
  return all ? Occlusion::hidden : Occlusion::visible;
}

}  // namespace

std::vector<float> safe_depth(const Target& target, std::span<const Draw> occluders,
                              std::span<const Positions> positions) {
  std::vector<float> depth(static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height),
                           Sense(target).sign > 0 ? kInfinity : -kInfinity);
  for (std::size_t n = 0; n < occluders.size(); ++n) {
    Occluders(target, occluders[n], positions.empty() ? Positions{} : positions[n]).draw(depth);
  }
  return depth;
}

Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionBox& box, OcclusionRule rule) {
  const auto in_front = std::ranges::count_if(box.corners, [](const Vertex& v) { return exact(v.w) > 0; });
  if (in_front == 0) return Occlusion::outside;
  const auto width = static_cast<std::size_t>(target.width), height = static_cast<std::size_t>(target.height);
  if (in_front < 8) {
    return answer(target, depth, std::vector<char>(width, 1), std::vector<char>(height, 1), std::nullopt, rule);
  }
  std::array<Rational, 8> x, y;
  std::array<float, 8> z{};
  for (std::size_t k = 0; k < 8; ++k) {
    const Vertex& v = box.corners[k];
    x[k] = exact(v.x) / exact(v.w), y[k] = exact(v.y) / exact(v.w), z[k] = nearest_float(exact(v.z) / exact(v.w));
  }
  const auto [left, right] = std::ranges::minmax_element(x);
  const auto [top, bottom] = std::ranges::minmax_element(y);
  const auto [smallest, largest] = std::ranges::minmax_element(z);
  const float d = target.depth_test == DepthTest::greater ? *largest : *smallest;
  return answer(target, depth, places(*left, *right, target.origin.x, target.width, rule.safe),
                places(*top, *bottom, target.origin.y, target.height, rule.safe), d, rule);
}

Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                 OcclusionRule rule) {
  // No pixel lies beyond 2^24.
  const auto side = [](float value) -> Rational {
    if (std::isinf(value)) return value > 0 ? 1 << 24 : -(1 << 24);
    return exact(value);
  };
  const Rational x0 = side(rectangle.x0), x1 = side(rectangle.x1), y0 = side(rectangle.y0), y1 = side(rectangle.y1);
  return answer(target, depth, places(x0, x1, target.origin.x, target.width, rule.safe),
                places(y0, y1, target.origin.y, target.height, rule.safe), rectangle.nearest_depth, rule);
}

}  // namespace surefill::oracle::clipped
