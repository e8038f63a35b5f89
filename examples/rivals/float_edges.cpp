// SPDX-License-Identifier: Apache-2.0
//
// A rasterizer whose barycentrics are float32, as in the kernels of several differentiable renderers: cracks open along
// the diagonals of quads. `surefill certify --plugin` finds one by T1. Not an example to follow.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "certify/adapter.h"

namespace {

struct Point {
  float x, y;
};

// Twice the area, with the differences taken from p: the two triangles of an edge take them from different corners, and
// so find values that are not each other's negatives.
float cross(Point p, Point q, float x, float y) {
  return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
}

bool owns(Point p, Point q) {
  return p.y > q.y || (p.y == q.y && q.x > p.x);
}

void draw_triangle(Point a, Point b, Point c, const surefill_adapter_scene& scene,
                   const surefill_adapter_image& image) {
  float area = cross(a, b, c.x, c.y);
  if (area < 0) {
    std::swap(b, c);
    area = cross(a, b, c.x, c.y);
  }
  if (!(area > 0)) return;
  for (std::uint32_t y = 0; y < scene.height; ++y) {
    for (std::uint32_t x = 0; x < scene.width; ++x) {
      const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
      const float b1 = cross(c, a, px, py) / area, b2 = cross(a, b, px, py) / area, b0 = 1 - b1 - b2;
      const bool covered = (b0 > 0 || (b0 == 0 && owns(b, c))) && (b1 > 0 || (b1 == 0 && owns(c, a))) &&
                           (b2 > 0 || (b2 == 0 && owns(a, b)));
      if (!covered) continue;
      const std::size_t at = static_cast<std::size_t>(y) * scene.width + x;
      ++image.count[at];
    }
  }
}

int draw(void*, const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  const std::size_t total = std::size_t{scene->width} * scene->height;
  std::fill_n(image->count, total, 0u);
  for (std::uint32_t d = 0; d < scene->draw_count; ++d) {
    const surefill_adapter_draw& from = scene->draws[d];
    const auto corner = [&from](std::uint32_t index) {
      const float* v = from.pixel + 4 * std::size_t{index};
      return Point{v[0] / v[3], v[1] / v[3]};
    };
    for (std::uint32_t t = 0; t < from.triangle_count; ++t) {
      const std::uint32_t* index = from.indices + 3 * std::size_t{t};
      draw_triangle(corner(index[0]), corner(index[1]), corner(index[2]), *scene, *image);
    }
  }
  return SUREFILL_ADAPTER_OK;
}

int open_adapter(const char*, surefill_adapter_info* info, void**) {
  std::snprintf(info->name, sizeof info->name, "float32 edges");
  std::snprintf(info->version, sizeof info->version, "1");
  info->outputs = SUREFILL_ADAPTER_COUNT;
  info->model.kind = SUREFILL_ADAPTER_MODEL_EXACT;
  info->model.fill_rule = SUREFILL_ADAPTER_TOP_LEFT;
  info->model.profile = SUREFILL_ADAPTER_PROFILE_OPENGL;
  return SUREFILL_ADAPTER_OK;
}

void close_adapter(void*) {}

const char* error_text(void*) {
  return "no error";
}

}  // namespace

extern "C" const surefill_adapter_api* surefill_adapter_entry(std::uint32_t version) {
  static constexpr surefill_adapter_api kApi{SUREFILL_ADAPTER_VERSION, open_adapter, draw, close_adapter, error_text};
  return version == SUREFILL_ADAPTER_VERSION ? &kApi : nullptr;
}
