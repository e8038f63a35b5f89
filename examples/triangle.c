/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface: a quad of two triangles, the second reaching behind the eye, with depth and a colour. */
#include <stdio.h>

#include "surefill/surefill.h"

enum { kWidth = 48, kHeight = 16, kPixels = kWidth * kHeight };

int main(void) {
  /* Clip space, y up: a floor below the eye that runs from behind it (w < 0) to the horizon. */
  const surefill_vertex clip[4] = {{-4, -1, -1.5f, -1}, {4, -1, -1.5f, -1}, {4, -1, 8.5f, 9}, {-4, -1, 8.5f, 9}};
  const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  const float shade[4] = {0, 0, 1, 1};
  surefill_vertex vertices[4];
  uint32_t count[kPixels], index[kPixels];
  float depth[kPixels], shade_image[kPixels];
  surefill_status status;
  int x, y;

  surefill_viewport viewport = {0};
  viewport.width = kWidth;
  viewport.height = kHeight;
  viewport.far_depth = 1;
  status = surefill_to_pixel(&viewport, clip, 4, vertices);
  if (status == SUREFILL_OK) {
    surefill_attribute_array shade_array = {0};
    surefill_attribute_target shade_target = {0};
    surefill_draw draw = {0};
    surefill_target target = {0};
    surefill_statistics statistics = {0};

    shade_array.values = shade;
    shade_array.value_count = 4;
    shade_array.components = 1;
    draw.struct_size = sizeof draw;
    draw.vertices = vertices;
    draw.vertex_count = 4;
    draw.indices = indices;
    draw.index_count = 6;
    draw.attributes = &shade_array;
    draw.attribute_count = 1;

    shade_target.values = shade_image;
    shade_target.value_count = kPixels;
    shade_target.components = 1;
    target.struct_size = sizeof target;
    target.width = kWidth;
    target.height = kHeight;
    target.samples = 1;
    target.count = count;
    target.count_count = kPixels;
    target.index = index;
    target.index_count = kPixels;
    target.depth = depth;
    target.depth_count = kPixels;
    target.attributes = &shade_target;
    target.attribute_count = 1;

    statistics.struct_size = sizeof statistics;
    status = surefill_render(&target, &draw, 1, NULL, &statistics);
    if (status == SUREFILL_OK) {
      for (y = 0; y < kHeight; ++y) {
        for (x = 0; x < kWidth; ++x) {
          const int i = y * kWidth + x;
          putchar(index[i] == SUREFILL_NO_TRIANGLE ? '.' : "0123456789"[(int)(shade_image[i] * 9.999f)]);
        }
        putchar('\n');
      }
      printf("%d triangles rasterized; bottom row: depth %.9g, triangle %u, %u cover\n", (int)statistics.rasterized,
             (double)depth[kPixels - 1], (unsigned)index[kPixels - 1], (unsigned)count[kPixels - 1]);
    }
  }
  if (status != SUREFILL_OK) {
    fprintf(stderr, "triangle: %s\n", surefill_status_text(status));
    return 1;
  }
  return 0;
}
