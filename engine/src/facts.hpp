// SPDX-License-Identifier: Apache-2.0
//
// What a target and a draw mean, each fact once, for both paths: regions, samples, outputs, indices, strides, culling,
// finiteness. No arithmetic that decides coverage or values: the paths share none.
#ifndef SUREFILL_SRC_FACTS_HPP
#define SUREFILL_SRC_FACTS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "surefill/surefill.hpp"

namespace surefill {

// Half-open rectangle of pixels.
struct PixelBox {
  int x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool contains(int x, int y) const { return x0 <= x && x < x1 && y0 <= y && y < y1; }
};

// A place in space, in pixels: a multiple of 1/16, at most kMaxOrigin + kMaxTargetSize in magnitude, exact in double.
struct SamplePosition {
  double x, y;
};

// ---- of a target
// Which results somebody asks for, in terms of work.
struct Wanted {
  bool shading;     // barycentrics or attributes
  bool visibility;  // the triangle that is seen: its index, or shading
  bool depth;       // depth, or what needs it
};

inline Wanted wanted_outputs(const Target& target) {
  Wanted wanted{!target.barycentrics.empty(), false, false};
  for (const AttributeTarget& attribute : target.attributes) wanted.shading |= !attribute.values.empty();
  wanted.visibility = wanted.shading || !target.index.empty();
  wanted.depth = wanted.visibility || !target.depth.empty();
  return wanted;
}

// Where sample n of a pixel lies, from the pixel's corner (S4, S7).
inline SamplePosition sample_offset(const Target& target, int n) {
  const SampleLocation location = target.sample_locations.empty()
                                      ? sample_location(target.samples, n)
                                      : target.sample_locations[static_cast<std::size_t>(n)];
  return {location.x / 16.0, location.y / 16.0};
}

// And where that is in pixel (x, y) of space.
inline SamplePosition place_of_sample(const Target& target, int x, int y, int n) {
  const SamplePosition offset = sample_offset(target, n);
  return {x + offset.x, y + offset.y};
}

// The element of a buffer that sample n of pixel (x, y) has.
inline std::size_t sample_index(const Target& target, int x, int y, std::size_t n) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(x)) *
             static_cast<std::size_t>(target.samples) +
         n;
}

// Is the larger depth nearer (V1)? And is the later one of equal depths seen (V5)?
inline bool is_reversed(DepthTest test) {
  return test == DepthTest::greater || test == DepthTest::greater_equal;
}
inline bool takes_equal(DepthTest test) {
  return test >= DepthTest::less_equal;
}

// The depth of an empty sample without initial depth (V1).
inline float empty_depth(DepthTest test) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return is_reversed(test) ? -kInfinity : kInfinity;
}

// Floats from one sample to the next.
inline std::size_t stride_of(const AttributeTarget& image) {
  return image.stride != 0 ? image.stride : image.components;
}

// ---- of a draw
// The vertices of each of its primitives; of what is no enumerator, 1.
inline std::size_t corners_of(const DrawState& draw) {
  return draw.primitive == Primitive::triangles ? 3 : draw.primitive == Primitive::lines ? 2 : 1;
}

// The number of its primitives, whatever they are.
inline std::size_t triangles_of(const Draw& draw) {
  return draw.indices.size() / corners_of(draw);
}

inline bool has_triangles(const DrawState& draw) {
  return draw.primitive == Primitive::triangles;
}

// Target and scissor (M3), in pixels of space (S6).
inline PixelBox region_of(const Target& target, const Draw& draw) {
  PixelBox region{target.origin.x, target.origin.y, target.origin.x + target.width, target.origin.y + target.height};
  if (draw.scissor) {
    region = {std::max(region.x0, draw.scissor->x0), std::max(region.y0, draw.scissor->y0),
              std::min(region.x1, draw.scissor->x1), std::min(region.y1, draw.scissor->y1)};
    if (region.empty()) region = {};
  }
  return region;
}

// Floats from one vertex to the next.
inline std::size_t stride_of(const AttributeArray& attribute) {
  return attribute.stride != 0 ? attribute.stride : attribute.components;
}

// Is it the front that faces so? `facing` has the sign of D (F1) or, under Grid, that of a sample (G1); D = 0 is
// back-facing (M4b).
inline bool faces_front(const DrawState& draw, int facing) {
  return facing != 0 && (facing > 0) == (draw.front_face == FrontFace::clockwise);
}

// Does culling leave out what faces so (F2)?
inline bool culls(const DrawState& draw, int facing) {
  return draw.cull == (faces_front(draw, facing) ? Cull::front : Cull::back);
}

// ---- of a triangle, by its position in the draw
inline std::uint32_t vertex_index(const Draw& draw, std::uint32_t position, std::size_t corner) {
  return draw.indices[corners_of(draw) * position + corner];
}

inline const Vertex& vertex_of(const Draw& draw, std::uint32_t position, std::size_t corner) {
  return draw.vertices[vertex_index(draw, position, corner)];
}

// What the index output has for it (V2).
inline std::uint32_t index_of(const Draw& draw, std::uint32_t position) {
  return draw.identifiers.empty() ? draw.first_index + position : draw.identifiers[position];
}

inline bool is_finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

// B1, of the attributes alone: every component, whatever is asked for.
inline bool attributes_are_finite(const Draw& draw, std::uint32_t position) {
  for (const AttributeArray& attribute : draw.attributes) {
    for (std::size_t corner = 0; corner < corners_of(draw); ++corner) {
      const float* values = &attribute.values[vertex_index(draw, position, corner) * stride_of(attribute)];
      for (std::uint32_t c = 0; c < attribute.components; ++c) {
        if (!std::isfinite(values[c])) return false;
      }
    }
  }
  return true;
}

// B1: if not, the triangle is dropped.
inline bool is_finite(const Draw& draw, std::uint32_t position) {
  for (std::size_t corner = 0; corner < corners_of(draw); ++corner) {
    if (!is_finite(vertex_of(draw, position, corner))) return false;
  }
  return attributes_are_finite(draw, position);
}

}  // namespace surefill

#endif  // SUREFILL_SRC_FACTS_HPP
