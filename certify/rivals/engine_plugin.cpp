// SPDX-License-Identifier: Apache-2.0
//
// Surefill's engine behind the adapter header, and the ways in which a plugin can go wrong, by the arguments that it is
// opened with: the tests of certify. Without arguments it is the right rasterizer, with every feature and the profile
// exact.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "certify/adapter.h"
#include "certify/rivals/plugin_frame.hpp"
#include "surefill/surefill.hpp"

namespace {

using namespace surefill;

struct Instance {
  std::string fault, error = {};
  std::uint64_t draws = 0;
  float farthest = std::numeric_limits<float>::infinity();  // depth of the frame before
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

// The coarse depth buffer, of one cell, is that of the frame before, which nobody cleared.
void hide_by_the_frame_before(Instance& instance, const surefill_adapter_scene& scene,
                              const surefill_adapter_image& image, std::size_t total) {
  if (!image.index || !image.depth || scene.depth_test != SUREFILL_ADAPTER_LESS) return;
  const float farthest = *std::max_element(image.depth, image.depth + total);
  for (std::size_t s = 0; s < total; ++s) {
    if (!(image.depth[s] > instance.farthest)) continue;
    image.index[s] = kNoTriangle;
    image.depth[s] = std::numeric_limits<float>::infinity();
  }
  instance.farthest = farthest;
}

// What the frame is to a rasterizer that mixes up the states of its draws.
struct Mixed {
  Mixed(const surefill_adapter_scene& from, const std::string& fault)
      : scene(from), draws(from.draws, from.draws + from.draw_count) {
    for (surefill_adapter_draw& draw : draws) {
      std::vector<float>& pixel = pixels.emplace_back(draw.pixel, draw.pixel + std::size_t{4} * draw.vertex_count);
      auto& kinds = attributes.emplace_back(draw.attributes, draw.attributes + from.attribute_count);
      for (std::size_t k = 0; k < kinds.size() && fault == "layers-first-kinds"; ++k) {
        kinds[k].interpolation = from.draws[0].attributes[k].interpolation;
      }
      const float nearer = from.depth_test == SUREFILL_ADAPTER_LESS ? -2 : 2;
      for (std::size_t v = 0; v < pixel.size() && fault == "layers-untested" && !draw.depth_write; v += 4) {
        pixel[v + 2] += nearer * pixel[v + 3];
      }
      draw.pixel = pixel.data();
      draw.attributes = kinds.data();
    }
    scene.draws = draws.data();
  }

  surefill_adapter_scene scene;
  std::vector<surefill_adapter_draw> draws;
  std::vector<std::vector<float>> pixels;
  std::vector<std::vector<surefill_adapter_attribute>> attributes;
};

// The vertices of a draw by way of clip space; a rasterizer that has not read the header gets it wrong.
std::vector<Vertex> from_clip_space(const surefill_adapter_draw& from, const std::string& fault) {
  Viewport viewport;
  viewport.x = from.viewport_x;
  viewport.y = from.viewport_y;
  viewport.width = from.viewport_width;
  viewport.height = from.viewport_height;
  viewport.near_depth = from.viewport_near;
  viewport.far_depth = from.viewport_far;
  viewport.clip_depth = static_cast<ClipDepth>(from.viewport_depth_range);
  if (fault == "clip-not-moved") viewport.x = std::min(viewport.x, 0.0f);
  if (fault == "clip-even") viewport.width = 2 * std::floor(viewport.width / 2);
  if (fault == "clip-y-down") viewport.clip_y = ClipY::down;
  if (fault == "clip-depth-unmapped") viewport.clip_depth = ClipDepth::zero_to_one;
  std::vector<Vertex> vertices(from.vertex_count);
  (void)to_pixel(viewport, {reinterpret_cast<const ClipVertex*>(from.clip), from.vertex_count}, vertices);
  return vertices;
}

// Samples are the corners of pixels, and each second triangle has a fill rule of its own: meshes crack where a sample lies on
// an edge.
void crack_at_corners(adapters::PluginFrame& frame, std::vector<std::vector<std::uint32_t>>& indices) {
  static constexpr SampleLocation kCorner[] = {{0, 0}};
  frame.target().sample_locations = kCorner;
  std::vector<Draw> draws;
  for (const Draw& draw : frame.draws()) {
    for (const bool second : {false, true}) {
      std::vector<std::uint32_t>& of = indices.emplace_back();
      for (std::size_t i = 0; i < draw.indices.size(); ++i) {
        if ((i / 3 % 2 == 1) == second) of.push_back(draw.indices[i]);
      }
      Draw& part = draws.emplace_back(draw);
      part.indices = of;
      part.identifiers = {};
      part.fill_rule = second ? FillRule::bottom_right : FillRule::top_left;
    }
  }
  frame.draws() = draws;
}

int draw(void* handle, const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  auto& instance = *static_cast<Instance*>(handle);
  const std::size_t total = std::size_t{scene->width} * scene->height * scene->samples;
  const bool shows = has_steep_edge(*scene);
  if (shows) {
    if (const int status = fault_before(instance, *scene, *image, total)) return status;
  }
  const Mixed mixed(*scene, instance.fault);
  adapters::PluginFrame frame(mixed.scene, *image);
  std::vector<std::vector<Vertex>> mapped;
  for (std::uint32_t d = 0; d < scene->draw_count && instance.fault.rfind("clip", 0) == 0; ++d) {
    mapped.push_back(from_clip_space(scene->draws[d], instance.fault));
    frame.draws()[d].vertices = mapped.back();
    frame.draws()[d].culling_box.reset();
  }
  std::vector<std::vector<std::uint32_t>> indices;
  if (instance.fault == "corner-cracks") crack_at_corners(frame, indices);
  if (instance.fault == "unwritten") frame.target().depth = {};
  if (instance.fault == "chatter") std::puts("drawing");
  const Status status = render(frame.target(), frame.draws());
  if (instance.fault == "nan" && shows && image->depth) image->depth[0] = std::numeric_limits<float>::quiet_NaN();
  const bool hides = instance.fault == "left-over" || instance.fault == "layers-left-over";
  if (instance.fault == "layers-left-over" && !scene->initial_depth) instance.farthest = HUGE_VALF;
  if (hides) hide_by_the_frame_before(instance, *scene, *image, total);
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
  if (fault == "depth-alone") info->outputs = SUREFILL_ADAPTER_DEPTH;
  if (fault == "bad-outputs") info->outputs = 1u << 20;
  info->features = adapters::kAllFeatures;
  info->model.kind = SUREFILL_ADAPTER_MODEL_EXACT;
  if (fault.rfind("clip", 0) == 0) info->form = SUREFILL_ADAPTER_FORM_CLIP;
  if (fault == "clip-minus-one" || fault == "clip-depth-unmapped") {
    info->model.depth_range = SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
  }
  if (fault == "wrong-model") {
    info->model.kind = SUREFILL_ADAPTER_MODEL_GRID;
    info->model.grid_bits = 8;
  }
  info->model.profile = SUREFILL_ADAPTER_PROFILE_EXACT;
  if (fault == "corner-cracks") {
    info->outputs = SUREFILL_ADAPTER_COUNT;
    info->features = 0;
    info->model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
    info->model.profile = SUREFILL_ADAPTER_PROFILE_OPENGL;
  }
  if (fault == "reports-vulkan" || fault == "reports-opengl" || fault.rfind("layers", 0) == 0) {
    info->model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
    info->model.grid_bits = 8;
    info->model.profile = fault == "reports-vulkan" ? SUREFILL_ADAPTER_PROFILE_VULKAN : SUREFILL_ADAPTER_PROFILE_OPENGL;
  }
  *handle = new Instance{fault};
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
