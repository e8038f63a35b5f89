// SPDX-License-Identifier: Apache-2.0
//
// Scenes as values.
#include "corpus/scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace surefill::corpus {
namespace {

// Equality of what is written: bit for bit, but all NaNs are alike.
bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) { return same(x, y); });
}

bool same(const SceneVertex& a, const SceneVertex& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w) && same(a.attributes, b.attributes);
}

bool same(const Vertex& a, const Vertex& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w);
}

bool same(const SceneTriangle& a, const SceneTriangle& b) {
  return a.vertices == b.vertices && a.identifier == b.identifier;
}

bool same(const SceneAttribute& a, const SceneAttribute& b) {
  return a.name == b.name && a.components == b.components && a.interpolation == b.interpolation;
}

bool same(const Viewport& a, const Viewport& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.width, b.width) && same(a.height, b.height) &&
         same(a.near_depth, b.near_depth) && same(a.far_depth, b.far_depth) && a.clip_depth == b.clip_depth &&
         a.clip_y == b.clip_y;
}

template <typename Range>
bool same_elements(const Range& a, const Range& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const std::optional<DepthBias>& a, const std::optional<DepthBias>& b) {
  return a.has_value() == b.has_value() && (!a || (same(a->constant, b->constant) && same(a->slope, b->slope)));
}

// The state with its floats by their bits.
bool same(const DrawState& a, const DrawState& b) {
  DrawState x = a, y = b;
  x.culling_box.reset(), y.culling_box.reset();
  x.depth_bias.reset(), y.depth_bias.reset();
  return x == y && same(a.depth_bias, b.depth_bias) && a.culling_box.has_value() == b.culling_box.has_value() &&
         (!a.culling_box || same_elements(*a.culling_box, *b.culling_box));
}

template <typename Value>
bool same_optional(const std::optional<Value>& a, const std::optional<Value>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

bool same(const SceneDraw& a, const SceneDraw& b) {
  return same_optional(a.viewport, b.viewport) && same_elements(a.vertices, b.vertices) &&
         same_elements(a.triangles, b.triangles) && a.first_index == b.first_index &&
         a.interpolations == b.interpolations && same(a.state(), b.state());
}

}  // namespace

bool equal(const Scene& a, const Scene& b) {
  return a.comment == b.comment && a.width == b.width && a.height == b.height && a.samples == b.samples &&
         a.depth_test == b.depth_test && a.attribute_location == b.attribute_location && a.origin == b.origin &&
         a.sample_locations == b.sample_locations && a.layers == b.layers && a.more == b.more &&
         same(a.initial_depth, b.initial_depth) && same_elements(a.attributes, b.attributes) &&
         std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(),
                    [](const SceneDraw& x, const SceneDraw& y) { return same(x, y); });
}

}  // namespace surefill::corpus
