/* SPDX-License-Identifier: Apache-2.0
 *
 * A small rasterizer in C behind version 2 of the adapter. It samples pixels at their upper left corner, takes positions down to
 * 1/16 pixel, and draws what lies on edges on both sides; it says so, and is held to that.
 *
 * Build and try:
 *     cc -shared -fPIC -I. -o stated_model.so examples/rivals/stated_model.c -lm
 *     surefill certify --plugin ./stated_model.so
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "certify/adapter2.h"

enum { kOne = 16 }; /* a pixel in steps of the grid */
static const double kFarthest = 1 << 14;

typedef struct {
  int64_t x, y;
} Corner;

static int64_t edge(Corner p, Corner q, Corner s) {
  return (q.x - p.x) * (s.y - p.y) - (q.y - p.y) * (s.x - p.x);
}

static int inside(const Corner c[3], Corner s) {
  return edge(c[0], c[1], s) >= 0 && edge(c[1], c[2], s) >= 0 && edge(c[2], c[0], s) >= 0;
}

static int draw_triangle(const surefill_adapter2_draw* draw, const uint32_t* three,
                         const surefill_adapter2_scene* scene, uint32_t* count) {
  Corner c[3];
  for (int i = 0; i < 3; ++i) {
    const float* v = draw->pixel + 4 * (size_t)three[i];
    const double x = (double)v[0] / v[3], y = (double)v[1] / v[3];
    if (!(fabs(x) < kFarthest) || !(fabs(y) < kFarthest)) return 0;
    c[i].x = (int64_t)floor(x * (double)kOne);
    c[i].y = (int64_t)floor(y * (double)kOne);
  }
  const int64_t area = edge(c[0], c[1], c[2]);
  if (area == 0) return 1;
  if (area < 0) {
    const Corner swapped = c[1];
    c[1] = c[2];
    c[2] = swapped;
  }
  for (uint32_t y = 0; y < scene->height; ++y)
    for (uint32_t x = 0; x < scene->width; ++x) {
      const Corner s = {(int64_t)x * kOne, (int64_t)y * kOne};
      if (inside(c, s)) ++count[(size_t)y * scene->width + x];
    }
  return 1;
}

static int draw(void* instance, const surefill_adapter2_scene* scene, const surefill_adapter2_image* image) {
  (void)instance;
  memset(image->count, 0, (size_t)scene->width * scene->height * sizeof *image->count);
  for (uint32_t d = 0; d < scene->draw_count; ++d) {
    const surefill_adapter2_draw* of = scene->draws[d];
    for (uint32_t t = 0; t < of->primitive_count; ++t)
      if (!draw_triangle(of, of->indices + 3 * (size_t)t, scene, image->count)) return SUREFILL_ADAPTER_UNSUPPORTED;
  }
  return SUREFILL_ADAPTER_OK;
}

static int open_adapter(const char* arguments, surefill_adapter2_info* info, void** instance) {
  (void)arguments;
  info->size = sizeof *info;
  snprintf(info->name, sizeof info->name, "stated model in C");
  snprintf(info->version, sizeof info->version, "1");
  info->outputs = SUREFILL_ADAPTER_COUNT;
  info->profile = SUREFILL_ADAPTER_PROFILE_OPENGL; /* of values: there are none */
  *instance = info;                                /* anything but null */
  return SUREFILL_ADAPTER_OK;
}

static int model(void* instance, surefill_adapter2_model* model) {
  (void)instance;
  model->size = sizeof *model;
  model->x.place = model->y.place = 0;
  model->x.grid_bits = model->y.grid_bits = 4;
  model->x.rounding = model->y.rounding = SUREFILL_ADAPTER2_ROUND_FLOOR;
  model->front_owned = model->back_owned = 0xFF; /* all sides */
  model->turned = SUREFILL_ADAPTER2_TURNED_AS_GRID;
  return SUREFILL_ADAPTER_OK;
}

static void close_adapter(void* instance) {
  (void)instance;
}

static const char* error_text(void* instance) {
  (void)instance;
  return "a vertex further than 2^14 pixels away";
}

const surefill_adapter2_api* surefill_adapter2_entry(void) {
  static const surefill_adapter2_api api = {
      sizeof(surefill_adapter2_api), SUREFILL_ADAPTER2_VERSION, open_adapter, draw, close_adapter, error_text, model};
  return &api;
}
