// SPDX-License-Identifier: Apache-2.0
//
// Surefill's engine behind the adapter header, and the ways in which a plugin can go wrong, by the arguments that it is
// opened with: the tests of certify. Without arguments it is the right rasterizer, with every feature and the profile
// exact.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "certify/adapter.h"
#include "surefill/surefill.hpp"

namespace {

using namespace surefill;

struct Instance {
  std::string fault, error;
  std::uint64_t draws = 0;
};

std::string open_error;

// Faults that show on some scenes only, so that there is something to reduce.
bool has_steep_edge(const surefill_adapter_scene& scene) {
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& draw = scene.draws[d];
    for (std::uint32_t i = 0; i < 3 * draw.triangle_count; ++i) {
      const float* v = draw.pixel + 4 * std::size_t{draw.indices[i]};
      if (v[0] > 4 * v[3] && v[3] > 0) return true;
    }
  }
  return false;
}

Draw draw_of(const surefill_adapter_draw& from, const std::vector<AttributeArray>& attributes) {
  Draw draw;
  draw.vertices = {reinterpret_cast<const Vertex*>(from.pixel), from.vertex_count};
  draw.indices = {from.indices, std::size_t{3} * from.triangle_count};
  draw.identifiers = {from.identifiers, from.triangle_count};
  draw.attributes = attributes;
  draw.fill_rule = static_cast<FillRule>(from.fill_rule);
  draw.front_face = static_cast<FrontFace>(from.front_face);
  draw.cull = static_cast<Cull>(from.cull);
  draw.depth_mode = static_cast<DepthMode>(from.depth_mode);
  draw.depth_write = from.depth_write != 0;
  draw.conservative = static_cast<Conservative>(from.conservative);
  if (from.has_scissor) draw.scissor = Scissor{from.scissor[0], from.scissor[1], from.scissor[2], from.scissor[3]};
  if (from.has_grid) {
    draw.grid = Grid{static_cast<int>(from.grid_bits), static_cast<int>(from.grid_offset_x),
                     static_cast<int>(from.grid_offset_y), static_cast<GridRounding>(from.grid_rounding)};
  }
  return draw;
}

// The fault on this scene, before anything is drawn.
int fault_before(Instance& instance, const surefill_adapter_scene& scene, const surefill_adapter_image& image,
                 std::size_t total) {
  const std::string& fault = instance.fault;
  if (fault == "crash") {
    volatile std::size_t nowhere = 16;
    *reinterpret_cast<volatile int*>(std::size_t{nowhere}) = 1;
  }
  if (fault == "abort") std::abort();
  if (fault == "exit") std::exit(3);
  if (fault == "hang") {
    for (;;) ::sleep(1);
  }
  if (fault == "fail") {
    instance.error = "out of coffee";
    return SUREFILL_ADAPTER_FAILED;
  }
  if (fault == "overrun" && image.count) image.count[total] = 1;
  if (fault == "underrun" && image.count) image.count[-1] = 1;
  if (fault == "scribble" && scene.draw_count > 0) const_cast<float*>(scene.draws[0].pixel)[0] = 1;
  return SUREFILL_ADAPTER_OK;
}

int draw(void* handle, const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  auto& instance = *static_cast<Instance*>(handle);
  std::vector<std::vector<AttributeArray>> attributes(scene->draw_count);
  std::vector<Draw> draws;
  std::vector<AttributeTarget> attribute_targets;
  const std::size_t total = std::size_t{scene->width} * scene->height * scene->samples;
  for (std::uint32_t d = 0; d < scene->draw_count; ++d) {
    const surefill_adapter_draw& from = scene->draws[d];
    for (std::uint32_t k = 0; k < scene->attribute_count; ++k) {
      const surefill_adapter_attribute& a = from.attributes[k];
      attributes[d].push_back({{a.values, std::size_t{a.components} * from.vertex_count},
                               a.components,
                               a.components,
                               static_cast<Interpolation>(a.interpolation)});
      if (d == 0 && image->attributes) {
        attribute_targets.push_back({{image->attributes[k], a.components * total}, a.components});
      }
    }
    draws.push_back(draw_of(from, attributes[d]));
  }
  const bool shows = has_steep_edge(*scene);
  if (shows) {
    if (const int status = fault_before(instance, *scene, *image, total)) return status;
  }
  Target target;
  target.width = static_cast<int>(scene->width);
  target.height = static_cast<int>(scene->height);
  target.samples = static_cast<int>(scene->samples);
  target.depth_test = static_cast<DepthTest>(scene->depth_test);
  target.attribute_location = static_cast<AttributeLocation>(scene->attribute_location);
  if (image->count) target.count = {image->count, total};
  if (image->index) target.index = {image->index, total};
  if (image->depth && instance.fault != "unwritten") target.depth = {image->depth, total};
  if (image->barycentrics) target.barycentrics = {image->barycentrics, 3 * total};
  if (scene->initial_depth) target.initial_depth = {scene->initial_depth, total};
  target.attributes = attribute_targets;
  if (instance.fault == "chatter") std::puts("drawing");
  const Status status = render(target, draws);
  if (instance.fault == "nan" && shows && image->depth) image->depth[0] = std::numeric_limits<float>::quiet_NaN();
  if (instance.fault == "forgetful" && image->count && ++instance.draws % 7 == 0) image->count[0] += 1;
  if (status == Status::ok) return SUREFILL_ADAPTER_OK;
  instance.error = status_text(status);
  return SUREFILL_ADAPTER_FAILED;
}

int open_adapter(const char* arguments, surefill_adapter_info* info, void** handle) {
  const std::string fault = arguments;
  if (fault == "no-open") {
    open_error = "no device";
    return SUREFILL_ADAPTER_FAILED;
  }
  if (fault == "not-here") {
    open_error = "no such device on this machine";
    return SUREFILL_ADAPTER_UNSUPPORTED;
  }
  if (fault == "exit-on-open") std::exit(5);
  std::snprintf(info->name, sizeof info->name, "%s", fault == "no-name" ? "" : "surefill");
  std::snprintf(info->version, sizeof info->version, "%s", SUREFILL_VERSION);
  info->outputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                  SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;
  if (fault == "no-count") info->outputs &= ~static_cast<std::uint32_t>(SUREFILL_ADAPTER_COUNT);
  if (fault == "bad-outputs") info->outputs = 1u << 20;
  info->features = (1u << 19) - 1;
  info->model.kind = SUREFILL_ADAPTER_MODEL_EXACT;
  if (fault == "wrong-model") {
    info->model.kind = SUREFILL_ADAPTER_MODEL_GRID;
    info->model.grid_bits = 8;
  }
  info->model.profile = SUREFILL_ADAPTER_PROFILE_EXACT;
  if (fault == "reports-vulkan" || fault == "reports-opengl") {
    info->model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
    info->model.grid_bits = 8;
    info->model.profile = fault == "reports-vulkan" ? SUREFILL_ADAPTER_PROFILE_VULKAN : SUREFILL_ADAPTER_PROFILE_OPENGL;
  }
  *handle = new Instance{fault, "", 0};
  return SUREFILL_ADAPTER_OK;
}

void close_adapter(void* handle) {
  delete static_cast<Instance*>(handle);
}

const char* error_text(void* handle) {
  return handle ? static_cast<Instance*>(handle)->error.c_str() : open_error.c_str();
}

}  // namespace

extern "C" const surefill_adapter_api* surefill_adapter_entry(std::uint32_t version) {
  static constexpr surefill_adapter_api kApi{SUREFILL_ADAPTER_VERSION, open_adapter, draw, close_adapter, error_text};
  return version == SUREFILL_ADAPTER_VERSION ? &kApi : nullptr;
}
