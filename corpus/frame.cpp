// SPDX-License-Identifier: Apache-2.0
//
// From a scene to the arguments of surefill::render, and the buffers of its image.
#include <algorithm>

#include "corpus/outputs.hpp"
#include "corpus/scene.hpp"

namespace surefill::corpus {

// What the spans of one Draw point into.
struct Frame::DrawStorage {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices, identifiers;
  std::vector<float> values;  // of all attributes, interleaved: `stride` floats a vertex
  std::vector<AttributeArray> attributes;
};

namespace {

std::vector<Vertex> pixel_vertices(const SceneDraw& draw) {
  std::vector<Vertex> vertices(draw.vertices.size());
  if (!draw.viewport) {
    std::transform(draw.vertices.begin(), draw.vertices.end(), vertices.begin(), [](const SceneVertex& v) {
      return Vertex{v.x, v.y, v.z, v.w};
    });
    return vertices;
  }
  std::vector<ClipVertex> clip(draw.vertices.size());
  std::transform(draw.vertices.begin(), draw.vertices.end(), clip.begin(), [](const SceneVertex& v) {
    return ClipVertex{v.x, v.y, v.z, v.w};
  });
  const Status status = to_pixel(*draw.viewport, clip, vertices);
  if (status != Status::ok) throw SceneError(std::string("scene: ") + status_text(status));
  return vertices;
}

std::vector<float> interleaved_values(const SceneDraw& draw, std::size_t stride) {
  std::vector<float> values;
  values.reserve(draw.vertices.size() * stride);
  for (const SceneVertex& vertex : draw.vertices) {
    if (vertex.attributes.size() != stride) throw SceneError("scene: a vertex lacks attribute values, or has too many");
    values.insert(values.end(), vertex.attributes.begin(), vertex.attributes.end());
  }
  return values;
}

}  // namespace

Frame::Frame(const Scene& scene, const Outputs& outputs) : initial_depth_(scene.initial_depth) {
  std::uint32_t stride = 0;
  for (const SceneAttribute& attribute : scene.attributes) stride += attribute.components;

  storage_.reserve(scene.draws.size());
  draws_.reserve(scene.draws.size());
  std::size_t triangles_before = 0;
  for (const SceneDraw& from : scene.draws) {
    DrawStorage& storage = storage_.emplace_back();
    storage.vertices = pixel_vertices(from);
    for (const SceneTriangle& triangle : from.triangles) {
      for (std::size_t i = 0; i < corners_of(from.primitive); ++i) storage.indices.push_back(triangle.vertices[i]);
      if (triangle.identifier) storage.identifiers.push_back(*triangle.identifier);
    }
    if (!storage.identifiers.empty() && storage.identifiers.size() != from.triangles.size()) {
      throw SceneError("scene: identifiers on some triangles of a draw only");
    }
    storage.values = interleaved_values(from, stride);
    std::size_t offset = 0;
    for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
      const SceneAttribute& attribute = scene.attributes[k];
      const std::span<const float> values = storage.values;
      const auto own = k < from.interpolations.size() ? from.interpolations[k] : std::nullopt;
      storage.attributes.push_back({values.subspan(std::min(offset, values.size())), attribute.components, stride,
                                    own.value_or(attribute.interpolation)});
      offset += attribute.components;
    }

    Draw& draw = draws_.emplace_back();
    draw.vertices = storage.vertices;
    draw.indices = storage.indices;
    draw.identifiers = storage.identifiers;
    draw.first_index = from.first_index.value_or(static_cast<std::uint32_t>(triangles_before));
    draw.attributes = storage.attributes;
    draw.state() = from.state();
    triangles_before += from.triangles.size();
  }

  target_.width = image_.width = scene.width;
  target_.height = image_.height = scene.height;
  target_.samples = image_.samples = scene.samples;
  target_.depth_test = scene.depth_test;
  target_.attribute_location = scene.attribute_location;
  target_.origin = scene.origin;
  sample_locations_ = scene.sample_locations;
  target_.sample_locations = sample_locations_;
  target_.layers = image_.layers = scene.layers;

  // A size outside S5 has no samples here; render and validate then name it.
  const std::size_t total = sample_total(target_);
  if (initial_depth_.size() == 1) initial_depth_.assign(total, scene.initial_depth[0]);
  target_.initial_depth = initial_depth_;

  const bool conservative = is_conservative(scene);
  const std::size_t in_layers = total * static_cast<std::size_t>(std::clamp(scene.layers, 1, kMaxLayers));
  for_each_output([&](const auto& output) {
    if (!(outputs.*output.asked) || !output.has(scene, conservative)) return;
    (image_.*output.image).resize(output.elements * (output.layered ? in_layers : total));
    target_.*output.target = image_.*output.image;
  });
  if (outputs.numbers && scene.more.numbers) {
    for (Draw& draw : draws_) {
      const std::size_t primitives = draw.indices.size() / corners_of(draw.primitive);
      draw.covered = image_.covered.emplace_back(primitives);
      if (!conservative) draw.visible = image_.visible.emplace_back(primitives);
    }
  }
  if (!outputs.attributes || conservative) return;
  image_.attributes.reserve(scene.attributes.size());
  for (const SceneAttribute& attribute : scene.attributes) {
    std::vector<float>& values = image_.attributes.emplace_back(attribute.components * in_layers);
    attribute_targets_.push_back({values, attribute.components});
  }
  target_.attributes = attribute_targets_;
}

Frame::~Frame() = default;

}  // namespace surefill::corpus
