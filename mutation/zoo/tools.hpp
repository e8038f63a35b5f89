// SPDX-License-Identifier: Apache-2.0
//
// What specimens are made of: a right rasterizer (the oracle, so that the zoo does not depend on the engine), and ways
// to give it a fault.
#ifndef SUREFILL_PROPERTIES_ZOO_TOOLS_HPP
#define SUREFILL_PROPERTIES_ZOO_TOOLS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "mutation/zoo/zoo.hpp"
#include "oracle/oracle.hpp"

namespace surefill::zoo {

// The image without a fault.
inline Status right(const Target& target, Draws draws) {
  const Status status = validate(target, draws);
  if (status == Status::ok) oracle::render(target, draws);
  return status;
}

// kList, whose faults are in how triangles are drawn: a frame with a draw of anything else, which has other numbers of
// indices a primitive, each draws without its fault.
template <const auto& kList>
constexpr auto of_triangles() {
  auto guarded = std::to_array(kList);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((guarded[I].render =
          [](const Target& target, Draws draws) {
            const bool triangles = std::all_of(draws.begin(), draws.end(),
                                               [](const Draw& draw) { return draw.primitive == Primitive::triangles; });
            return triangles ? kList[I].render(target, draws) : right(target, draws);
          }),
     ...);
  }
  (std::make_index_sequence<std::size(kList)>());
  return guarded;
}

using Corners = std::array<Vertex, 3>;

inline Corners corners(const Draw& draw, std::size_t t) {
  return {draw.vertices[draw.indices[3 * t]], draw.vertices[draw.indices[3 * t + 1]],
          draw.vertices[draw.indices[3 * t + 2]]};
}

// `change` alters each draw's state.
template <class Change>
Status with_state(const Target& target, Draws draws, const Change& change) {
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (Draw& draw : changed) change(draw);
  return right(target, changed);
}

// `change` alters each vertex.
template <class Change>
Status with_vertices(const Target& target, Draws draws, const Change& change) {
  std::vector<std::vector<Vertex>> vertices(draws.size());
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    for (const Vertex& v : draws[d].vertices) vertices[d].push_back(change(v));
    changed[d].vertices = vertices[d];
  }
  return right(target, changed);
}

// Triangle t of a draw as a draw of its own, with the index that it had.
inline Draw one_triangle(const Draw& draw, std::size_t t) {
  Draw one = draw;
  one.indices = draw.indices.subspan(3 * t, 3);
  one.first_index = draw.first_index + static_cast<std::uint32_t>(t);
  if (!draw.identifiers.empty()) one.identifiers = draw.identifiers.subspan(t, 1);
  if (!draw.covered.empty()) one.covered = draw.covered.subspan(t, 1);
  if (!draw.visible.empty()) one.visible = draw.visible.subspan(t, 1);
  return one;
}

// Lines and points stay together.
inline std::vector<Draw> one_by_one(Draws draws) {
  std::vector<Draw> single;
  for (const Draw& draw : draws) {
    if (draw.primitive != Primitive::triangles) {
      single.push_back(draw);
      continue;
    }
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) single.push_back(one_triangle(draw, t));
  }
  return single;
}

// Drops the triangles of which `dropped(draw, t)` is true; the others keep their index.
template <class Predicate>
Status without(const Target& target, Draws draws, const Predicate& dropped) {
  std::vector<std::vector<std::uint32_t>> indices(draws.size()), identifiers(draws.size());
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Draw& draw = draws[d];
    if (draw.primitive != Primitive::triangles) continue;
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
      if (dropped(draw, t)) continue;
      indices[d].insert(indices[d].end(), {draw.indices[3 * t], draw.indices[3 * t + 1], draw.indices[3 * t + 2]});
      identifiers[d].push_back(draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t)
                                                        : draw.identifiers[t]);
    }
    changed[d].indices = indices[d];
    changed[d].identifiers = identifiers[d];
    changed[d].covered = changed[d].visible = {};  // the numbers that are left are not those of the positions
  }
  return right(target, changed);
}

// The same, by the triangle's corners.
template <class Predicate>
Status without_corners(const Target& target, Draws draws, const Predicate& dropped) {
  return without(target, draws, [&](const Draw& draw, std::size_t t) { return dropped(corners(draw, t)); });
}

using Counts = std::vector<std::uint32_t>;

// The counts of one draw, without a fault.
inline Counts right_counts(const Target& target, const Draw& draw) {
  Counts counts(sample_total(target));
  Target only_count;
  only_count.width = target.width;
  only_count.height = target.height;
  only_count.samples = target.samples;
  only_count.origin = target.origin;
  only_count.sample_locations = target.sample_locations;
  only_count.count = counts;
  Draw alone = draw;
  alone.covered = alone.visible = {};
  (void)right(only_count, {&alone, 1});
  return counts;
}

// Counts as `count_one(target, draw of one triangle)` says, triangle by triangle; the other outputs are right.
template <class CountOne>
Status with_counts(const Target& target, Draws draws, const CountOne& count_one) {
  const Status status = right(target, draws);
  if (status != Status::ok || target.count.empty()) return status;
  std::fill(target.count.begin(), target.count.end(), 0u);
  for (const Draw& draw : one_by_one(draws)) {
    const Counts counts = count_one(target, draw);
    for (std::size_t s = 0; s < counts.size(); ++s) target.count[s] += counts[s];
  }
  return Status::ok;
}

// Counts that `keep(x, y)` lets stand.
template <class Keep>
void mask(const Target& target, Counts& counts, const Keep& keep) {
  const auto samples = static_cast<std::size_t>(target.samples);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    const auto pixel = static_cast<int>(s / samples);
    if (!keep(pixel % target.width, pixel / target.width)) counts[s] = 0;
  }
}

// The rule with the sign of its x shift, of its y shift or of both turned round.
constexpr unsigned kMirrorX = 1, kMirrorY = 2, kOpposite = 3;
inline FillRule turned(FillRule rule, unsigned signs) {
  if (rule > FillRule::northwards_west) return rule;  // C5's move nothing
  return static_cast<FillRule>(static_cast<unsigned>(rule) ^ signs);
}

// The largest and smallest projected x and y; W > 0.
struct Box {
  float x0, y0, x1, y1;
};
inline Box box_of(const Corners& t) {
  const auto x = [&](std::size_t i) { return t[i].x / t[i].w; };
  const auto y = [&](std::size_t i) { return t[i].y / t[i].w; };
  return {std::min({x(0), x(1), x(2)}), std::min({y(0), y(1), y(2)}), std::max({x(0), x(1), x(2)}),
          std::max({y(0), y(1), y(2)})};
}
inline bool in_front(const Corners& t) {
  return t[0].w > 0 && t[1].w > 0 && t[2].w > 0;
}

// det(m_0, m_1, m_2) as a float32 program computes it.
inline float float_determinant(const Corners& t) {
  const auto minor = [&](const Vertex& a, const Vertex& b) { return a.x * b.y - a.y * b.x; };
  return t[0].w * minor(t[1], t[2]) + t[1].w * minor(t[2], t[0]) + t[2].w * minor(t[0], t[1]);
}

}  // namespace surefill::zoo

#endif  // SUREFILL_PROPERTIES_ZOO_TOOLS_HPP
