// SPDX-License-Identifier: Apache-2.0
//
// Specimens that draw lines and points wrongly: at their joints, ends and borders, and in what they interpolate.
#include <cstdint>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// `change` alters each draw of lines.
template <class Change>
Status with_lines(const Target& target, Draws draws, const Change& change) {
  return with_state(target, draws, [&](Draw& draw) {
    if (draw.primitive == Primitive::lines) change(draw);
  });
}

// `change` alters the vertices of draws of lines or points, where they are in front of the eye.
template <class Change>
Status with_ends(const Target& target, Draws draws, const Change& change) {
  std::vector<std::vector<Vertex>> vertices(draws.size());
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    if (draws[d].primitive == Primitive::triangles) continue;
    for (const Vertex& v : draws[d].vertices) vertices[d].push_back(v.w > 0 ? change(v) : v);
    changed[d].vertices = vertices[d];
  }
  return right(target, changed);
}

constexpr Specimen kSpecimens[] = {
    {"line-end-too-many", "the last pixel of a thin line is drawn, so joints are hit twice",
     "OpenGL's diamond exit left out", "equality-lines",
     [](const Target& t, Draws d) {
       std::vector<Draw> changed;
       std::vector<std::vector<std::uint32_t>> ends(d.size());
       for (std::size_t i = 0; i < d.size(); ++i) {
         changed.push_back(d[i]);
         if (d[i].primitive != Primitive::lines || d[i].width || !d[i].identifiers.empty()) continue;
         if (!d[i].covered.empty() || !d[i].visible.empty()) continue;
         for (std::size_t k = 1; k < d[i].indices.size(); k += 2) ends[i].push_back(d[i].indices[k]);
         Draw points = d[i];
         points.primitive = Primitive::points, points.indices = ends[i];
         changed.push_back(points);
       }
       return right(t, changed);
     }},
    {"line-snapped-to-pixels", "ends go to the centres of pixels, as Bresenham's algorithm has whole numbers", "",
     "equality-lines",
     [](const Target& t, Draws d) {
       return with_ends(t, d, [](Vertex v) {
         v.x = (std::floor(v.x / v.w) + 0.5f) * v.w, v.y = (std::floor(v.y / v.w) + 0.5f) * v.w;
         return v;
       });
     }},
    {"line-thin-is-wide", "a thin line is one of width 1", "", "equality-lines",
     [](const Target& t, Draws d) {
       return with_lines(t, d, [](Draw& draw) { draw.width = draw.width.value_or(1.0f); });
     }},
    {"line-width-across", "a wide line's width is measured across it and not along an axis, so steep ones have gaps",
     "", "equality-lines",
     [](const Target& t, Draws d) {
       return with_lines(t, d, [](Draw& draw) {
         if (draw.width) draw.width = *draw.width * 0.70710678f;
       });
     }},
    {"line-width-one", "every line has one pixel", "", "equality-lines",
     [](const Target& t, Draws d) {
       return with_lines(t, d, [](Draw& draw) {
         if (draw.width) draw.width = 1.0f;
       });
     }},
    {"line-backwards", "lines run from their second vertex to their first", "", "equality-lines",
     [](const Target& t, Draws d) {
       std::vector<Draw> changed(d.begin(), d.end());
       std::vector<std::vector<std::uint32_t>> indices(d.size());
       for (std::size_t i = 0; i < d.size(); ++i) {
         if (d[i].primitive != Primitive::lines) continue;
         for (std::size_t k = 0; k + 1 < d[i].indices.size(); k += 2)
           indices[i].insert(indices[i].end(), {d[i].indices[k + 1], d[i].indices[k]});
         changed[i].indices = indices[i];
       }
       return right(t, changed);
     }},
    {"line-behind-dropped", "a line with an end behind the eye is not drawn", "", "equality-lines",
     [](const Target& t, Draws d) {
       std::vector<Draw> changed(d.begin(), d.end());
       std::vector<std::vector<std::uint32_t>> indices(d.size());
       for (std::size_t i = 0; i < d.size(); ++i) {
         if (d[i].primitive != Primitive::lines) continue;
         for (std::size_t k = 0; k + 1 < d[i].indices.size(); k += 2) {
           const std::uint32_t a = d[i].indices[k], b = d[i].indices[k + 1];
           const bool behind = !(d[i].vertices[a].w > 0 && d[i].vertices[b].w > 0);
           indices[i].insert(indices[i].end(), {a, behind ? a : b});
         }
         changed[i].indices = indices[i];
       }
       return right(t, changed);
     }},
    {"line-perspective-ignored", "attributes of lines are affine on the screen", "", "equality-lines",
     [](const Target& t, Draws d) {
       std::vector<Draw> changed(d.begin(), d.end());
       std::vector<std::vector<AttributeArray>> arrays(d.size());
       for (std::size_t i = 0; i < d.size(); ++i) {
         if (d[i].primitive != Primitive::lines) continue;
         arrays[i].assign(d[i].attributes.begin(), d[i].attributes.end());
         for (AttributeArray& a : arrays[i])
           if (a.interpolation == Interpolation::perspective) a.interpolation = Interpolation::noperspective;
         changed[i].attributes = arrays[i];
       }
       return right(t, changed);
     }},
    {"point-size-one", "every point has one pixel", "", "equality-lines",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.primitive == Primitive::points) draw.width.reset();
       });
     }},
    {"point-from-its-corner", "a point's vertex is the corner of its square and not its middle", "", "equality-lines",
     [](const Target& t, Draws d) {
       std::vector<std::vector<Vertex>> vertices(d.size());
       std::vector<Draw> changed(d.begin(), d.end());
       for (std::size_t i = 0; i < d.size(); ++i) {
         if (d[i].primitive != Primitive::points) continue;
         const float half = d[i].width.value_or(1.0f) / 2;
         for (Vertex v : d[i].vertices) {
           v.x += half * v.w, v.y += half * v.w;
           vertices[i].push_back(v);
         }
         changed[i].vertices = vertices[i];
       }
       return right(t, changed);
     }},
};

}  // namespace

std::span<const Specimen> line_specimens() {
  return kSpecimens;
}

}  // namespace surefill::zoo
