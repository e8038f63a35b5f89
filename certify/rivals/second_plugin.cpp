// SPDX-License-Identifier: Apache-2.0
//
// Surefill's engine behind version 2 of the adapter, and the ways in which its structs can be of another size or wrong,
// by the arguments that it is opened with: the tests of certify. Without arguments it is the right rasterizer, with
// every feature, and states that it is exact.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "certify/adapter2.h"
#include "certify/rivals/plugin_frame.hpp"
#include "surefill/surefill.hpp"

namespace {

using namespace surefill;

struct Instance {
  std::string fault, error;
};

std::string open_error;

// The scene in the structs of version 1, which the engine's half of the tests reads.
struct FirstVersion {
  std::vector<surefill_adapter_draw> draws;
  std::vector<std::vector<surefill_adapter_attribute>> attributes;
  surefill_adapter_scene scene{};

  explicit FirstVersion(const surefill_adapter2_scene& from) : draws(from.draw_count), attributes(from.draw_count) {
    for (std::uint32_t d = 0; d < from.draw_count; ++d) {
      const surefill_adapter2_draw& draw = *from.draws[d];
      for (std::uint32_t k = 0; k < from.attribute_count; ++k) {
        const surefill_adapter2_attribute& a = *draw.attributes[k];
        attributes[d].push_back({a.values, a.components, a.interpolation});
      }
      draws[d].vertex_count = draw.vertex_count;
      draws[d].triangle_count = draw.primitive_count;
      draws[d].pixel = draw.pixel;
      draws[d].indices = draw.indices;
      draws[d].identifiers = draw.identifiers;
      draws[d].attributes = attributes[d].data();
      draws[d].fill_rule = draw.fill_rule;
      draws[d].front_face = draw.front_face;
      draws[d].cull = draw.cull;
      draws[d].depth_mode = draw.depth_mode;
      draws[d].depth_write = draw.depth_write;
      draws[d].conservative = draw.conservative;
      draws[d].has_scissor = draw.has_scissor;
      std::memcpy(draws[d].scissor, draw.scissor, sizeof draw.scissor);
      draws[d].has_grid = draw.has_grid;
      draws[d].grid_bits = draw.grid_bits;
      draws[d].grid_rounding = draw.grid_rounding;
      draws[d].grid_offset_x = draw.grid_offset_x;
      draws[d].grid_offset_y = draw.grid_offset_y;
    }
    scene.width = from.width;
    scene.height = from.height;
    scene.samples = from.samples;
    scene.depth_test = from.depth_test;
    scene.attribute_location = from.attribute_location;
    scene.attribute_count = from.attribute_count;
    scene.draw_count = from.draw_count;
    scene.draws = draws.data();
    scene.initial_depth = from.initial_depth;
  }
};

int draw(void* handle, const surefill_adapter2_scene* scene, const surefill_adapter2_image* image) {
  auto& instance = *static_cast<Instance*>(handle);
  bool sizes = scene->size == sizeof *scene && image->size == sizeof *image;
  for (std::uint32_t d = 0; d < scene->draw_count; ++d) {
    sizes = sizes && scene->draws[d]->size == sizeof *scene->draws[d];
    for (std::uint32_t k = 0; k < scene->attribute_count; ++k) {
      sizes = sizes && scene->draws[d]->attributes[k]->size == sizeof(surefill_adapter2_attribute);
    }
  }
  if (!sizes) {
    instance.error = "a struct that does not begin with its size";
    return SUREFILL_ADAPTER_FAILED;
  }
  const FirstVersion first(*scene);
  const surefill_adapter_image image1{image->count, image->index, image->depth, image->barycentrics, image->attributes};
  adapters::PluginFrame frame(first.scene, image1);
  for (std::uint32_t d = 0; d < scene->draw_count; ++d) {
    const surefill_adapter2_draw& from = *scene->draws[d];
    Draw& to = frame.draws()[d];
    to.primitive = static_cast<Primitive>(from.primitive);
    to.indices = {from.indices, (3 - std::size_t{from.primitive}) * from.primitive_count};
    if (from.width > 0) to.width = from.width;
    // What is wrong on purpose.
    if (instance.fault == "lines-thin" && to.primitive == Primitive::lines && to.width) to.width = 1.0f;
    if (instance.fault == "points-wide" && to.primitive == Primitive::points) to.width = to.width.value_or(1) + 1;
  }
  const Status status = render(frame.target(), frame.draws());
  if (status == Status::ok) return SUREFILL_ADAPTER_OK;
  instance.error = status_text(status);
  return SUREFILL_ADAPTER_FAILED;
}

// What a plugin of a later header would leave behind the members that are known here.
void say_more(void* known, std::size_t size, std::uint32_t what) {
  std::memcpy(static_cast<char*>(known) + size, &what, sizeof what);
  const auto theirs = static_cast<std::uint32_t>(size + 64);
  std::memcpy(known, &theirs, sizeof theirs);
}

int open_adapter(const char* arguments, surefill_adapter2_info* info, void** handle) {
  const std::string fault = arguments;
  if (fault == "no-open") {
    open_error = "no device";
    return SUREFILL_ADAPTER_FAILED;
  }
  if (info->size < sizeof *info || info->outputs != 0) {
    open_error = "there is no room, or what is there is not zero";
    return SUREFILL_ADAPTER_FAILED;
  }
  info->size = sizeof *info;
  std::snprintf(info->name, sizeof info->name, "surefill 2");
  std::snprintf(info->version, sizeof info->version, "%s", SUREFILL_VERSION);
  info->outputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                  SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;
  info->features = adapters::kAllFeatures | SUREFILL_ADAPTER2_CLOSED_AND_OPEN | SUREFILL_ADAPTER2_WIDTHS;
  info->primitives = 1 << SUREFILL_ADAPTER2_TRIANGLES | 1 << SUREFILL_ADAPTER2_LINES | 1 << SUREFILL_ADAPTER2_POINTS;
  info->max_width = 1 << 14;
  // Cut before the limits: they are not said, whatever lies there.
  if (fault == "short-info") info->size = offsetof(surefill_adapter2_info, max_width);
  if (fault == "short-info") info->max_width = 1;
  if (fault == "long-info") say_more(info, sizeof *info, 0);
  if (fault == "longer-info") say_more(info, sizeof *info, 1);
  if (fault == "bad-output") info->outputs |= std::uint64_t{1} << 40;
  if (fault == "bad-feature") info->features |= std::uint64_t{1} << 40;
  if (fault == "bad-primitive") info->primitives = 1 << 5;
  if (fault == "tiny-info") info->size = 3;
  *handle = new Instance{fault, ""};
  return SUREFILL_ADAPTER_OK;
}

int model(void* handle, surefill_adapter2_model* model) {
  auto& instance = *static_cast<Instance*>(handle);
  if (instance.fault == "no-model") return SUREFILL_ADAPTER_UNSUPPORTED;
  if (instance.fault == "model-fails") {
    instance.error = "out of tea";
    return SUREFILL_ADAPTER_FAILED;
  }
  model->size = sizeof *model;
  if (instance.fault == "wrong-model") model->x.grid_bits = model->y.grid_bits = 4;
  // Cut before the limits of W: a model without them has their defaults.
  if (instance.fault == "short-model") model->size = offsetof(surefill_adapter2_model, least_w);
  if (instance.fault == "short-model") model->most_w = -1;
  if (instance.fault == "long-model") say_more(model, sizeof *model, 0);
  if (instance.fault == "longer-model") say_more(model, sizeof *model, 1);
  if (instance.fault == "bad-model") model->x.rounding = 9;
  return SUREFILL_ADAPTER_OK;
}

void close_adapter(void* handle) {
  delete static_cast<Instance*>(handle);
}

const char* error_text(void* handle) {
  return handle ? static_cast<Instance*>(handle)->error.c_str() : open_error.c_str();
}

}  // namespace

extern "C" const surefill_adapter2_api* surefill_adapter2_entry() {
  static constexpr surefill_adapter2_api kApi{
      sizeof(surefill_adapter2_api), SUREFILL_ADAPTER2_VERSION, open_adapter, draw, close_adapter, error_text, model};
  return &kApi;
}
