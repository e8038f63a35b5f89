// SPDX-License-Identifier: Apache-2.0
#include "oracle/tests/safe_by_the_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "oracle/clipped_polygon.hpp"

namespace surefill::oracle {

namespace {

using clipped::exact;
using clipped::Rational;
using clipped::Vector;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Face {
  std::array<std::uint32_t, 3> corners{};
  std::array<Vector, 3> m;
  std::array<Rational, 3> z;
  int sign = 0;                 // of D
  bool dropped = false;         // it has no depth
  std::array<bool, 3> inner{};  // the edges from corner i on
  std::size_t occluder = 0;
};

struct Range {
  Rational low, high;
};

class ByThePage {
 public:
  ByThePage(const Target& target, const Draw& draw, Positions positions, Wrong wrong)
      : target_(target), draw_(draw), positions_(positions), wrong_(wrong) {
    for (std::size_t t = 0; t < draw.indices.size() / 3; ++t) add_face(t);
    for (Face& face : faces_) {
      for (std::size_t i = 0; i < 3; ++i) face.inner[i] = is_inner(face, i);
    }
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].occluder == 0) link(f, ++occluders_);
    }
  }

  void lower(std::vector<float>& depth) const {
    for (std::size_t s = 0; s < depth.size(); ++s) {
      const auto width = static_cast<std::size_t>(target_.width);
      const int x = target_.origin.x + static_cast<int>(s % width), y = target_.origin.y + static_cast<int>(s / width);
      for (std::size_t n = 1; n <= occluders_; ++n) {
        const std::optional<Rational> z = depth_of(n, x, y);
        if (!z) continue;
        const bool upwards = greater() == (wrong_ == Wrong::rounded_nearer);
        const float stored = rounded(*z, upwards);
        depth[s] = greater() ? std::max(depth[s], stored) : std::min(depth[s], stored);
      }
    }
  }

 private:
  bool greater() const { return target_.depth_test == DepthTest::greater; }

  static float rounded(const Rational& z, bool upwards) {
    float result = clipped::nearest_float(z);
    if (upwards && exact(result) < z) result = std::nextafter(result, kInfinity);
    if (!upwards && exact(result) > z) result = std::nextafter(result, -kInfinity);
    return result == 0 ? 0.0f : result;
  }

  // --- "faces are the triangles with D != 0 that are neither dropped nor culled"
  void add_face(std::size_t t) {
    Face face;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = face.corners[i] = draw_.indices[3 * t + i];
      const Vertex& v = draw_.vertices[corner];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.w)) return;
      face.m[i] = {exact(v.x), exact(v.y), exact(v.w)};
      if (std::isfinite(v.z)) {
        face.z[i] = exact(v.z);
      } else {
        face.dropped = true;
      }
    }
    if (face.dropped && wrong_ != Wrong::dropped_faces) return;
    face.sign = sgn(dot(face.m[0], cross(face.m[1], face.m[2])));
    if (face.sign == 0) {
      if (!face.dropped) degenerate_.push_back(face);
      return;
    }
    const bool front = draw_.front_face == FrontFace::clockwise ? face.sign > 0 : face.sign < 0;
    if (draw_.cull == (front ? Cull::front : Cull::back) && wrong_ != Wrong::culled_faces) return;
    faces_.push_back(face);
  }

  // --- "two vertices are one if their positions are equal by value"
  bool one(std::uint32_t a, std::uint32_t b) const {
    const Vertex &v = draw_.vertices[a], &u = draw_.vertices[b];
    if (wrong_ == Wrong::nearly_equal_ends) {
      return std::abs(v.x - u.x) < 0x1p-16f && std::abs(v.y - u.y) < 0x1p-16f && std::abs(v.w - u.w) < 0x1p-16f;
    }
    if (wrong_ == Wrong::edges_without_w) return v.x == u.x && v.y == u.y;
    if (a == b) return true;
    if (positions_.empty()) return v.x == u.x && v.y == u.y && v.w == u.w;
    return positions_[a][0] == positions_[b][0] && positions_[a][1] == positions_[b][1] &&
           positions_[a][2] == positions_[b][2];
  }

  // How many faces of this side have the edge in this direction; `which` gets their numbers.
  int having(int sign, std::uint32_t from, std::uint32_t to, std::vector<std::size_t>* which = nullptr) const {
    int number = 0;
    const auto count = [&](const Face& face) {
      int own = 0;
      for (std::size_t i = 0; i < 3; ++i) own += one(face.corners[i], from) && one(face.corners[(i + 1) % 3], to);
      return own;
    };
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].sign != sign && wrong_ != Wrong::edges_of_both_sides) continue;
      const int own = count(faces_[f]);
      number += own;
      if (own > 0 && which != nullptr && faces_[f].sign == sign) which->push_back(f);
    }
    if (wrong_ == Wrong::degenerate_faces) {
      for (const Face& face : degenerate_) number += count(face);
    }
    return number;
  }

  // --- "inner if among the faces of that side as many have it in one direction as in the other"
  bool is_inner(const Face& face, std::size_t i) const {
    const std::uint32_t from = face.corners[i], to = face.corners[(i + 1) % 3];
    const int there = having(face.sign, from, to), back = having(face.sign, to, from);
    return wrong_ == Wrong::edges_in_pairs ? there + back > 1 : there == back;
  }

  // --- "if a chain of faces links them, each sharing an inner edge with the next"
  void link(std::size_t f, std::size_t occluder) {
    std::vector<std::size_t> waiting = {f};
    while (!waiting.empty()) {
      Face& face = faces_[waiting.back()];
      waiting.pop_back();
      if (face.occluder != 0) continue;
      face.occluder = occluder;
      if (wrong_ == Wrong::faces_alone) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!face.inner[i]) continue;
        having(face.sign, face.corners[i], face.corners[(i + 1) % 3], &waiting);
        having(face.sign, face.corners[(i + 1) % 3], face.corners[i], &waiting);
      }
    }
  }

  // --- "Q does not meet S of any of its rim edges". S is the points of (1 - t) from + t to, 0 <= t <= 1, with W > 0.
  // That lies in Q if four functions of t are not negative; with W = 0 it would be X = Y = W = 0.
  static bool edge_meets(Vector from, Vector to, int x, int y, Wrong wrong) {
    const auto in_square = [x, y](const Vector& m) {
      return sgn(m.w) > 0 && x * m.w <= m.x && m.x <= (x + 1) * m.w && y * m.w <= m.y && m.y <= (y + 1) * m.w;
    };
    if (wrong == Wrong::rim_ends) return in_square(from) || in_square(to);
    if (wrong == Wrong::no_rays && (sgn(from.w) <= 0 || sgn(to.w) <= 0)) return false;
    if (wrong == Wrong::ends_projected) {
      for (Vector* m : {&from, &to}) {
        if (sgn(m->w) != 0) *m = {m->x / m->w, m->y / m->w, 1};
      }
    }
    const auto heights = [x, y](const Vector& m) -> std::array<Rational, 4> {
      return {m.x - x * m.w, (x + 1) * m.w - m.x, m.y - y * m.w, (y + 1) * m.w - m.y};
    };
    const std::array<Rational, 4> a = heights(from), b = heights(to);
    Rational first = 0, last = 1;
    for (std::size_t n = 0; n < 4; ++n) {
      if (a[n] < 0 && b[n] < 0) return false;
      if (a[n] >= 0 && b[n] >= 0) continue;
      const Rational root = a[n] / (a[n] - b[n]);
      if (a[n] < 0) {
        first = std::max(first, root);
      } else {
        last = std::min(last, root);
      }
    }
    if (first > last) return false;
    if (wrong != Wrong::rims_inside) return true;
    const Rational t = (first + last) / 2;  // if it is not inside, nothing of S is
    for (std::size_t n = 0; n < 4; ++n) {
      if ((1 - t) * a[n] + t * b[n] <= 0) return false;
    }
    return true;
  }

  // --- C2, C3, C5: the sign of each E_i / D
  bool covers(const Face& face, const Rational& x, const Rational& y, FillRule rule) const {
    const clipped::Shift shift = clipped::shift_of(rule);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector e = cross(face.m[(i + 1) % 3], face.m[(i + 2) % 3]);
      int sign = face.sign * sgn(e.x * x + e.y * y + e.w);
      if (sign == 0 && rule == FillRule::closed) continue;
      const int along_x = face.sign * sgn(e.x) * shift.x, along_y = face.sign * sgn(e.y) * shift.y;
      if (sign == 0) sign = shift.x_dominates ? along_x : along_y;
      if (sign == 0) sign = shift.x_dominates ? along_y : along_x;
      if (sign <= 0) return false;
    }
    return true;
  }

  bool covers_centre(const Face& face, int x, int y) const {
    return covers(face, x + Rational(1, 2), y + Rational(1, 2), draw_.fill_rule);
  }

  // --- "whose T meets Q": its border does, or Q lies in it
  bool meets(const Face& face, int x, int y) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (edge_meets(face.m[i], face.m[(i + 1) % 3], x, y, Wrong::nothing)) return true;
    }
    return covers(face, x + Rational(1, 2), y + Rational(1, 2), FillRule::closed);
  }

  // --- I1
  static Rational plane(const Face& face, const Rational& x, const Rational& y) {
    Rational sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector e = cross(face.m[(i + 1) % 3], face.m[(i + 2) % 3]);
      sum += face.z[i] * (e.x * x + e.y * y + e.w);
    }
    return sum / dot(face.m[0], cross(face.m[1], face.m[2]));
  }

  // --- "The range of a face on Q"
  Range range(const Face& face, int x, int y) const {
    if (wrong_ == Wrong::depth_at_centre || wrong_ == Wrong::depth_at_corner) {
      const Rational half = wrong_ == Wrong::depth_at_centre ? Rational(1, 2) : Rational(0);
      const Rational z = plane(face, x + half, y + half);
      return {z, z};
    }
    const std::array<Rational, 4> z = {plane(face, x, y), plane(face, x + 1, y), plane(face, x, y + 1),
                                       plane(face, x + 1, y + 1)};
    Range result{*std::ranges::min_element(z), *std::ranges::max_element(z)};
    bool in_front = true;
    std::vector<Rational> vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      in_front = in_front && sgn(face.m[i].w) > 0;
      if (sgn(face.m[i].w) != 0) vertices.push_back(face.z[i] / face.m[i].w);
    }
    if (!in_front && wrong_ != Wrong::cut_behind) return result;
    if (wrong_ == Wrong::cut_to_mean) {
      const Rational mean = (vertices[0] + vertices[1] + vertices[2]) / 3;
      vertices = {mean};
      (greater() ? result.low : result.high) = mean;
      return result;
    }
    if (vertices.empty()) return result;
    result.low = std::max(result.low, *std::ranges::min_element(vertices));
    result.high = std::min(result.high, *std::ranges::max_element(vertices));
    return result;
  }

  // --- z_o(Q), where the occluder fills Q
  std::optional<Rational> depth_of(std::size_t occluder, int x, int y) const {
    bool covered = false;
    for (const Face& face : faces_) covered = covered || (face.occluder == occluder && covers_centre(face, x, y));
    if (!covered) return std::nullopt;
    for (const Face& face : faces_) {
      if (face.occluder != occluder || wrong_ == Wrong::no_rims) continue;
      if (wrong_ == Wrong::rims_of_one_face && !covers_centre(face, x, y)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!face.inner[i] && edge_meets(face.m[i], face.m[(i + 1) % 3], x, y, wrong_)) return std::nullopt;
      }
    }
    std::optional<Rational> farthest;
    for (const Face& face : faces_) {
      if (face.occluder != occluder || face.dropped || !meets(face, x, y)) continue;
      const bool over_centre = covers_centre(face, x, y);
      const Range r = range(face, x, y);
      const bool asked = wrong_ != Wrong::not_clipped && (wrong_ != Wrong::clipped_by_one_face || over_centre);
      if (draw_.depth_mode == DepthMode::clip && asked && (r.low < 0 || r.high > 1)) return std::nullopt;
      if (wrong_ == Wrong::covering_faces && !over_centre) continue;
      const Rational& end = greater() == (wrong_ == Wrong::nearest_end) ? r.high : r.low;
      if (!farthest || (greater() ? end < *farthest : end > *farthest)) farthest = end;
    }
    if (!farthest) return std::nullopt;  // all are dropped
    if (draw_.depth_mode == DepthMode::clamp && wrong_ != Wrong::not_clamped) {
      farthest = std::clamp(*farthest, Rational(0), Rational(1));
    }
    return farthest;
  }

  const Target& target_;
  const Draw& draw_;
  Positions positions_;
  Wrong wrong_;
  std::vector<Face> faces_, degenerate_;
  std::size_t occluders_ = 0;
};

// O5 of an extent that may be endless.
Occlusion answer(const Target& target, std::span<const float> depth,
                 const std::array<std::optional<Rational>, 4>& sides, std::optional<float> d, OcclusionRule rule,
                 Wrong wrong) {
  const bool greater = target.depth_test == DepthTest::greater;
  const auto reaches = [&](const std::optional<Rational>& low, const std::optional<Rational>& high, int pixel) {
    const Rational first = pixel, middle = pixel + Rational(1, 2), end = pixel + 1;
    if (low && high && *low > *high) return false;
    if (!rule.safe || wrong == Wrong::reach_of_centres) return (!low || *low <= middle) && (!high || middle <= *high);
    return (!low || *low < end) && (!high || (wrong == Wrong::reach_without_end ? first < *high : first <= *high));
  };
  bool any = false, hidden = true;
  for (int y = 0; y < target.height; ++y) {
    for (int x = 0; x < target.width; ++x) {
      if (!reaches(sides[0], sides[1], target.origin.x + x) || !reaches(sides[2], sides[3], target.origin.y + y))
        continue;
      any = true;
      const float z = depth[static_cast<std::size_t>(y * target.width + x)];
      const bool equal = rule.equal_is_visible && wrong != Wrong::equal_is_hidden;
      const bool here = d && (greater ? (equal ? *d < z : *d <= z) : (equal ? *d > z : *d >= z));
      hidden = hidden && here;
    }
  }
  return !any ? Occlusion::outside : hidden ? Occlusion::hidden : Occlusion::visible;
}

}  // namespace

const char* name_of(Wrong wrong) {
  static constexpr const char* kNames[] = {"nothing",          "no_rims",           "rims_inside",
                                           "rim_ends",         "no_rays",           "ends_projected",
                                           "rims_of_one_face", "edges_in_pairs",    "edges_of_both_sides",
                                           "edges_without_w",  "nearly_equal_ends", "degenerate_faces",
                                           "culled_faces",     "dropped_faces",     "faces_alone",
                                           "covering_faces",   "depth_at_centre",   "depth_at_corner",
                                           "nearest_end",      "cut_behind",        "cut_to_mean",
                                           "rounded_nearer",   "not_clipped",       "clipped_by_one_face",
                                           "not_clamped",      "reach_of_centres",  "reach_without_end",
                                           "farthest_d",       "behind_left_out",   "equal_is_hidden"};
  static_assert(std::size(kNames) == static_cast<std::size_t>(Wrong::last));
  return kNames[static_cast<std::size_t>(wrong)];
}

std::vector<float> safe_depth_by_the_page(const Target& target, std::span<const Draw> occluders,
                                          std::span<const Positions> positions, Wrong wrong) {
  std::vector<float> depth(static_cast<std::size_t>(target.width * target.height),
                           target.depth_test == DepthTest::greater ? -kInfinity : kInfinity);
  for (std::size_t n = 0; n < occluders.size(); ++n) {
    ByThePage(target, occluders[n], positions.empty() ? Positions{} : positions[n], wrong).lower(depth);
  }
  return depth;
}

Occlusion answer_by_the_page(const Target& target, std::span<const float> depth, const OcclusionBox& box,
                             OcclusionRule rule, Wrong wrong) {
  std::vector<Rational> x, y, z;
  for (const Vertex& v : box.corners) {
    if (!(v.w > 0)) continue;
    x.push_back(exact(v.x) / exact(v.w)), y.push_back(exact(v.y) / exact(v.w)), z.push_back(exact(v.z) / exact(v.w));
  }
  if (x.empty()) return Occlusion::outside;
  if (x.size() < 8 && wrong != Wrong::behind_left_out) return answer(target, depth, {}, std::nullopt, rule, wrong);
  const bool largest = (target.depth_test == DepthTest::greater) != (wrong == Wrong::farthest_d);
  const float d = clipped::nearest_float(largest ? *std::ranges::max_element(z) : *std::ranges::min_element(z));
  return answer(target, depth,
                {*std::ranges::min_element(x), *std::ranges::max_element(x), *std::ranges::min_element(y),
                 *std::ranges::max_element(y)},
                d, rule, wrong);
}

Occlusion answer_by_the_page(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                             OcclusionRule rule, Wrong wrong) {
  // No pixel lies beyond 2^24.
  const auto side = [](float value) -> std::optional<Rational> {
    if (std::isinf(value)) return Rational(value > 0 ? 1 << 24 : -(1 << 24));
    return exact(value);
  };
  return answer(target, depth, {side(rectangle.x0), side(rectangle.x1), side(rectangle.y0), side(rectangle.y1)},
                rectangle.nearest_depth, rule, wrong);
}

}  // namespace surefill::oracle
