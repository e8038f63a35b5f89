// SPDX-License-Identifier: Apache-2.0
//
// The way back: from the adapter's scene and image to the arguments of a renderer with the interface of
// surefill::render, for plugins that wrap one.
#ifndef SUREFILL_CERTIFY_ADAPTERS_PLUGIN_FRAME_HPP
#define SUREFILL_CERTIFY_ADAPTERS_PLUGIN_FRAME_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "certify/adapter.h"
#include "certify/rivals/draw_words.hpp"
#include "surefill/surefill.hpp"

namespace surefill::adapters {

// Every feature of the adapter, as bits.
inline constexpr std::uint32_t kAllFeatures = (1u << 19) - 1;

// Target and draws point into the scene, the image and this object. What the adapter has one form for is given in those
// that the interface has: consecutive identifiers as a first index, one attribute with stride 0 and several
// interleaved, and the vertices of small draws as their culling box.
class PluginFrame {
 public:
  PluginFrame(const surefill_adapter_scene& scene, const surefill_adapter_image& image) : storage_(scene.draw_count) {
    const std::size_t total = std::size_t{scene.width} * scene.height * scene.samples;
    target_.width = static_cast<int>(scene.width);
    target_.height = static_cast<int>(scene.height);
    target_.samples = static_cast<int>(scene.samples);
    target_.depth_test = static_cast<DepthTest>(scene.depth_test);
    target_.attribute_location = static_cast<AttributeLocation>(scene.attribute_location);
    if (image.count) target_.count = {image.count, total};
    if (image.index) target_.index = {image.index, total};
    if (image.depth) target_.depth = {image.depth, total};
    if (image.barycentrics) target_.barycentrics = {image.barycentrics, 3 * total};
    if (scene.initial_depth) target_.initial_depth = {scene.initial_depth, total};
    for (std::uint32_t k = 0; k < scene.attribute_count && image.attributes && scene.draw_count > 0; ++k) {
      const std::uint32_t components = scene.draws[0].attributes[k].components;
      attribute_targets_.push_back({{image.attributes[k], components * total}, components});
    }
    target_.attributes = attribute_targets_;
    for (std::uint32_t d = 0; d < scene.draw_count; ++d) add(scene.draws[d], scene.attribute_count, storage_[d]);
  }
  PluginFrame(const PluginFrame&) = delete;
  PluginFrame& operator=(const PluginFrame&) = delete;

  Target& target() { return target_; }
  std::vector<Draw>& draws() { return draws_; }

 private:
  struct Storage {
    std::vector<float> values;
    std::vector<AttributeArray> attributes;
  };

  void add(const surefill_adapter_draw& from, std::uint32_t attribute_count, Storage& storage) {
    Draw& draw = draws_.emplace_back();
    draw.vertices = {reinterpret_cast<const Vertex*>(from.pixel), from.vertex_count};
    draw.indices = {from.indices, std::size_t{3} * from.triangle_count};
    const std::span<const std::uint32_t> identifiers(from.identifiers, from.triangle_count);
    const auto not_next = [](std::uint32_t a, std::uint32_t b) { return b != a + 1 || b == 0; };
    if (std::adjacent_find(identifiers.begin(), identifiers.end(), not_next) != identifiers.end()) {
      draw.identifiers = identifiers;
    } else if (!identifiers.empty()) {
      draw.first_index = identifiers[0];
    }
    std::uint32_t stride = 0;
    for (std::uint32_t k = 0; k < attribute_count; ++k) stride += from.attributes[k].components;
    for (std::size_t v = 0; v < from.vertex_count; ++v)
      for (std::uint32_t k = 0; k < attribute_count; ++k) {
        const surefill_adapter_attribute& a = from.attributes[k];
        storage.values.insert(storage.values.end(), a.values + v * a.components, a.values + (v + 1) * a.components);
      }
    std::size_t offset = 0;
    for (std::uint32_t k = 0; k < attribute_count; ++k) {
      const surefill_adapter_attribute& a = from.attributes[k];
      const std::span<const float> values = storage.values;
      storage.attributes.push_back({values.subspan(std::min(offset, values.size())), a.components,
                                    attribute_count == 1 ? 0 : stride, static_cast<Interpolation>(a.interpolation)});
      offset += a.components;
    }
    draw.attributes = storage.attributes;
    set_state(from, draw.state());
    if (!draw.vertices.empty() && draw.vertices.size() <= 8) {
      std::array<Vertex, 8> box{};  // its hull is that of the vertices
      for (std::size_t i = 0; i < 8; ++i) box[i] = draw.vertices[i % draw.vertices.size()];
      draw.culling_box = box;
    }
  }

  std::vector<Storage> storage_;
  std::vector<AttributeTarget> attribute_targets_;
  std::vector<Draw> draws_;
  Target target_;
};

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_PLUGIN_FRAME_HPP
