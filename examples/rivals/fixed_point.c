/* SPDX-License-Identifier: Apache-2.0
 *
 * A small rasterizer in C behind the adapter: fixed point of 8 bits, 64-bit edge functions, coverage counts only. It
 * does not say what its model is; certify finds out.
 *
 * Build and try:
 *     cc -shared -fPIC -I. -o fixed_point.so examples/rivals/fixed_point.c -lm
 *     surefill certify --plugin ./fixed_point.so
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "certify/adapter.h"

enum { kBits = 8, kOne = 1 << kBits };
static const double kFarthest = 1 << 14; /* pixels */

typedef struct {
  int64_t x, y; /* 8 fraction bits */
} Corner;

static int64_t edge(Corner p, Corner q, Corner s) {
  return (q.x - p.x) * (s.y - p.y) - (q.y - p.y) * (s.x - p.x);
}

/* The top-left rule: an edge that goes up, or level to the right, owns the samples on it. */
static int owns(Corner p, Corner q) {
  return p.y > q.y || (p.y == q.y && q.x > p.x);
}

static int inside(const Corner c[3], Corner s) {
  for (int i = 0; i < 3; ++i) {
    const Corner p = c[i], q = c[(i + 1) % 3];
    const int64_t e = edge(p, q, s);
    if (e < 0 || (e == 0 && !owns(p, q))) return 0;
  }
  return 1;
}

/* 0 if the vertex is too far off the screen for this rasterizer. */
static int project(const float* v, Corner* corner) {
  const double x = (double)v[0] / v[3], y = (double)v[1] / v[3];
  if (!(fabs(x) < kFarthest) || !(fabs(y) < kFarthest)) return 0;
  corner->x = (int64_t)floor(x * (double)kOne + 0.5);
  corner->y = (int64_t)floor(y * (double)kOne + 0.5);
  return 1;
}

static int64_t clamped(int64_t value, int64_t high) {
  return value < 0 ? 0 : value > high ? high : value;
}

static void draw_triangle(const Corner c[3], const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  int64_t x0 = c[0].x, x1 = c[0].x, y0 = c[0].y, y1 = c[0].y;
  for (int i = 1; i < 3; ++i) {
    x0 = c[i].x < x0 ? c[i].x : x0;
    x1 = c[i].x > x1 ? c[i].x : x1;
    y0 = c[i].y < y0 ? c[i].y : y0;
    y1 = c[i].y > y1 ? c[i].y : y1;
  }
  const int64_t right = clamped(x1 / kOne + 1, scene->width), bottom = clamped(y1 / kOne + 1, scene->height);
  for (int64_t y = clamped(y0 / kOne - 1, scene->height); y < bottom; ++y) {
    for (int64_t x = clamped(x0 / kOne - 1, scene->width); x < right; ++x) {
      const Corner sample = {x * kOne + kOne / 2, y * kOne + kOne / 2};
      const size_t at = (size_t)(y * scene->width + x);
      if (!inside(c, sample)) continue;
      ++image->count[at];
    }
  }
}

static int draw(void* instance, const surefill_adapter_scene* scene, const surefill_adapter_image* image) {
  (void)instance;
  const size_t total = (size_t)scene->width * scene->height;
  memset(image->count, 0, total * sizeof *image->count);
  for (uint32_t d = 0; d < scene->draw_count; ++d) {
    const surefill_adapter_draw* from = &scene->draws[d];
    for (uint32_t t = 0; t < from->triangle_count; ++t) {
      Corner c[3];
      for (int i = 0; i < 3; ++i) {
        if (!project(from->pixel + 4 * (size_t)from->indices[3 * t + (uint32_t)i], &c[i])) {
          return SUREFILL_ADAPTER_UNSUPPORTED;
        }
      }
      const int64_t area = edge(c[0], c[1], c[2]);
      if (area == 0) continue;
      if (area < 0) {
        const Corner swapped = c[1];
        c[1] = c[2];
        c[2] = swapped;
      }
      draw_triangle(c, scene, image);
    }
  }
  return SUREFILL_ADAPTER_OK;
}

static int open_adapter(const char* arguments, surefill_adapter_info* info, void** instance) {
  (void)arguments;
  *instance = NULL;
  snprintf(info->name, sizeof info->name, "fixed point in C");
  snprintf(info->version, sizeof info->version, "1");
  info->outputs = SUREFILL_ADAPTER_COUNT;
  info->model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
  info->model.profile = SUREFILL_ADAPTER_PROFILE_VULKAN;
  return SUREFILL_ADAPTER_OK;
}

static void close_adapter(void* instance) {
  (void)instance;
}

static const char* error_text(void* instance) {
  (void)instance;
  return "vertices farther than 16384 pixels away";
}

const surefill_adapter_api* surefill_adapter_entry(uint32_t version) {
  static const surefill_adapter_api api = {SUREFILL_ADAPTER_VERSION, open_adapter, draw, close_adapter, error_text};
  return version == SUREFILL_ADAPTER_VERSION ? &api : NULL;
}
