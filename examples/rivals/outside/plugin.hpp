// SPDX-License-Identifier: Apache-2.0
//
// What the adapters of this folder share: a plugin with counts alone, of a rasterizer that draws one triangle, on the screen, into
// an image of its own. An adapter defines NAME, VERSION and draw_alone, and ends with SUREFILL_PLUGIN.
#ifndef SUREFILL_EXAMPLES_RIVALS_OUTSIDE_PLUGIN_HPP
#define SUREFILL_EXAMPLES_RIVALS_OUTSIDE_PLUGIN_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "certify/adapter.h"

namespace outside {

struct Corner {
  double x, y;  // pixels, y down
};

// Adds 1 to each element of `count` whose pixel is covered.
using DrawAlone = void (*)(const Corner corners[3], int width, int height, std::uint32_t* count);

inline bool on_screen(const Corner& c, int width, int height) {
  return c.x >= 0 && c.y >= 0 && c.x <= width && c.y <= height;
}

inline int draw(const surefill_adapter_scene& scene, const surefill_adapter_image& image, DrawAlone draw_alone,
                bool takes_the_rest) {
  const int width = static_cast<int>(scene.width), height = static_cast<int>(scene.height);
  std::fill_n(image.count, std::size_t{scene.width} * scene.height, 0u);
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& of = scene.draws[d];
    for (std::uint32_t t = 0; t < of.triangle_count; ++t) {
      Corner corners[3];
      for (int i = 0; i < 3; ++i) {
        const float* v = of.pixel + 4 * std::size_t{of.indices[3 * t + static_cast<std::uint32_t>(i)]};
        corners[i] = {static_cast<double>(v[0]) / v[3], static_cast<double>(v[1]) / v[3]};
        if (!takes_the_rest && !on_screen(corners[i], width, height)) return SUREFILL_ADAPTER_UNSUPPORTED;
        if (!(std::abs(corners[i].x) < 16384 && std::abs(corners[i].y) < 16384)) return SUREFILL_ADAPTER_UNSUPPORTED;
      }
      draw_alone(corners, width, height, image.count);
    }
  }
  return SUREFILL_ADAPTER_OK;
}

}  // namespace outside

#define SUREFILL_PLUGIN(NAME, VERSION, DRAW_ALONE, TAKES_THE_REST)                            \
  extern "C" const surefill_adapter_api* surefill_adapter_entry(std::uint32_t version) {      \
    static const surefill_adapter_api api{                                                    \
        SUREFILL_ADAPTER_VERSION,                                                             \
        [](const char*, surefill_adapter_info* info, void** instance) {                       \
          std::snprintf(info->name, sizeof info->name, "%s", NAME);                           \
          std::snprintf(info->version, sizeof info->version, "%s", VERSION);                  \
          info->outputs = SUREFILL_ADAPTER_COUNT;                                             \
          info->model.profile = SUREFILL_ADAPTER_PROFILE_OPENGL;                              \
          *instance = info;                                                                   \
          return static_cast<int>(SUREFILL_ADAPTER_OK);                                       \
        },                                                                                    \
        [](void*, const surefill_adapter_scene* scene, const surefill_adapter_image* image) { \
          return outside::draw(*scene, *image, DRAW_ALONE, TAKES_THE_REST);                   \
        },                                                                                    \
        [](void*) {}, [](void*) { return "a vertex beside the screen"; }};                    \
    return version == SUREFILL_ADAPTER_VERSION ? &api : nullptr;                              \
  }

#endif  // SUREFILL_EXAMPLES_RIVALS_OUTSIDE_PLUGIN_HPP
