/* SPDX-License-Identifier: Apache-2.0 */
/* Wrong calls through the C interface: each returns the status that names the argument, and writes nothing. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "surefill/surefill.h"

enum { kPixels = 12 };

/* A correct call with every buffer; a case spoils one thing of it. */
typedef struct Call {
  surefill_vertex vertices[3];
  uint32_t indices[3], identifiers[1];
  float values[6];
  surefill_attribute_array array;
  surefill_draw draws[2];
  surefill_grid grid;
  uint32_t count[kPixels], index[kPixels];
  float depth[kPixels], barycentrics[3 * kPixels], colour[2 * kPixels], initial[kPixels];
  surefill_attribute_target attribute;
  surefill_target target;
  surefill_options options;
  surefill_statistics statistics;
  size_t draw_count;
  int null_target, null_draws;
} Call;

static void make(Call* c) {
  static const surefill_vertex kVertices[3] = {{0, 0, 0.5f, 1}, {4, 0, 0.5f, 1}, {0, 4, 0.5f, 1}};
  int i;
  memset(c, 0, sizeof *c);
  memcpy(c->vertices, kVertices, sizeof kVertices);
  for (i = 0; i < 3; ++i) c->indices[i] = (uint32_t)i;
  for (i = 0; i < kPixels; ++i) c->initial[i] = 1;
  c->array.values = c->values, c->array.value_count = 6, c->array.components = 2;
  c->grid.bits = 8;
  for (i = 0; i < 2; ++i) {
    surefill_draw* draw = &c->draws[i];
    draw->struct_size = sizeof *draw;
    draw->vertices = c->vertices, draw->vertex_count = 3;
    draw->indices = c->indices, draw->index_count = 3;
    draw->identifiers = c->identifiers, draw->identifier_count = 1;
    draw->attributes = &c->array, draw->attribute_count = 1;
    draw->grid = &c->grid;
  }
  c->draw_count = 2;
  c->attribute.values = c->colour, c->attribute.value_count = 2 * kPixels, c->attribute.components = 2;
  c->target.struct_size = sizeof c->target;
  c->target.width = 4, c->target.height = 3, c->target.samples = 1;
  c->target.count = c->count, c->target.count_count = kPixels;
  c->target.index = c->index, c->target.index_count = kPixels;
  c->target.depth = c->depth, c->target.depth_count = kPixels;
  c->target.barycentrics = c->barycentrics, c->target.barycentrics_count = 3 * kPixels;
  c->target.attributes = &c->attribute, c->target.attribute_count = 1;
  c->target.initial_depth = c->initial, c->target.initial_depth_count = kPixels;
  c->options.struct_size = sizeof c->options;
  c->statistics.struct_size = sizeof c->statistics;
  c->statistics.triangles = 77;
}

static surefill_status render(Call* c) {
  return surefill_render(c->null_target ? NULL : &c->target, c->null_draws ? NULL : c->draws, c->draw_count,
                         &c->options, &c->statistics);
}

static surefill_status validate(Call* c) {
  return surefill_validate(c->null_target ? NULL : &c->target, c->null_draws ? NULL : c->draws, c->draw_count);
}

/* What surefill_validate does not see. */
static int of_options(surefill_status status) {
  return status == SUREFILL_OPTIONS_STRUCT_SIZE || status == SUREFILL_STATISTICS_STRUCT_SIZE ||
         status == SUREFILL_OPTIONS_THREADS || status == SUREFILL_OPTIONS_PATH;
}

static void null_target(Call* c) {
  c->null_target = 1;
}
static void null_draws(Call* c) {
  c->null_draws = 1;
}
static void short_target(Call* c) {
  c->target.struct_size = 8;
}
static void long_target(Call* c) {
  c->target.struct_size += 8;
}
static void no_draw_size(Call* c) {
  c->draws[0].struct_size = 0;
}
static void mixed_draw_sizes(Call* c) {
  c->draws[1].struct_size -= 8;
}
static void options_size(Call* c) {
  c->options.struct_size = 1000;
}
static void statistics_size(Call* c) {
  c->statistics.struct_size = 8;
}
static void negative_width(Call* c) {
  c->target.width = -4;
}
static void no_height(Call* c) {
  c->target.height = 0;
}
static void too_wide(Call* c) {
  c->target.width = SUREFILL_MAX_TARGET_SIZE + 1;
}
static void three_samples(Call* c) {
  c->target.samples = 3;
}
static void no_samples(Call* c) {
  c->target.samples = 0;
}
static void short_count(Call* c) {
  c->target.count_count = kPixels - 1;
}
static void null_index(Call* c) {
  c->target.index = NULL;
}
static void long_depth(Call* c) {
  c->target.depth_count = kPixels + 1;
}
static void two_weights(Call* c) {
  c->target.barycentrics_count = 2 * kPixels;
}
static void short_initial(Call* c) {
  c->target.initial_depth_count = 1;
}
static void overlap(Call* c) {
  c->target.index = c->count;
}
static void output_is_input(Call* c) {
  c->draws[1].vertex_count = 3, c->target.depth = (float*)c->vertices;
}
static void output_is_draws(Call* c) {
  c->target.count = (uint32_t*)(void*)c->draws;
}
static void output_is_arrays(Call* c) {
  c->target.depth = (float*)(void*)&c->array;
}
static void output_is_attribute_list(Call* c) {
  c->target.index = (uint32_t*)(void*)&c->attribute;
}
static void output_is_target(Call* c) {
  c->target.index = (uint32_t*)(void*)&c->target;
}
static void output_is_statistics(Call* c) {
  c->target.depth = (float*)(void*)&c->statistics;
}
static void output_is_first_strided_input(Call* c) {
  c->draws[0].vertices = (const surefill_vertex*)(const void*)c->barycentrics, c->draws[0].vertex_stride = 20;
  c->draws[1].vertex_stride = 16;
}
static void depth_test(Call* c) {
  c->target.depth_test = SUREFILL_GREATER_EQUAL + 1;
}
static void far_depth_test(Call* c) {
  c->target.depth_test = 256;
} /* 0 in its lowest byte */
static void location(Call* c) {
  c->target.attribute_location = 9;
}
static void five_components(Call* c) {
  c->attribute.components = 5;
}
static void null_attribute_list(Call* c) {
  c->target.attributes = NULL;
}
static void many_attributes(Call* c) {
  c->target.attribute_count = 17;
}
static void null_vertices(Call* c) {
  c->draws[1].vertices = NULL;
}
static void small_vertex_stride(Call* c) {
  c->draws[1].vertex_stride = 12;
}
static void odd_vertex_stride(Call* c) {
  c->draws[1].vertex_stride = 18;
}
static void negative_vertex_stride(Call* c) {
  c->draws[1].vertex_stride = (size_t)-16;
}
static void huge_vertex_stride(Call* c) {
  c->draws[1].vertex_stride = (size_t)-1 / 4 + 1;
}
static void strided_null_vertices(Call* c) {
  c->draws[1].vertices = NULL, c->draws[1].vertex_stride = 32;
}
static void null_attribute_list_and_stride(Call* c) {
  c->target.attributes = NULL, c->draws[1].vertex_stride = 32, c->draws[1].vertex_count = 1;
}
static void output_is_strided_input(Call* c) {
  c->draws[1].vertices = (const surefill_vertex*)c->barycentrics, c->draws[1].vertex_stride = 20;
}
static void null_indices(Call* c) {
  c->draws[1].indices = NULL;
}
static void four_indices(Call* c) {
  c->draws[1].index_count = 4;
}
static void out_of_range(Call* c) {
  c->draws[1].vertex_count = 2;
}
static void negative_index(Call* c) {
  c->indices[1] = (uint32_t)-1;
}
static void two_identifiers(Call* c) {
  c->draws[0].identifier_count = 2;
}
static void no_triangle(Call* c) {
  c->identifiers[0] = SUREFILL_NO_TRIANGLE;
}
static void first_index(Call* c) {
  c->draws[1].identifier_count = 0, c->draws[1].first_index = 0xFFFFFFFFu;
}
static void no_arrays(Call* c) {
  c->draws[1].attribute_count = 0;
}
static void null_arrays(Call* c) {
  c->draws[1].attributes = NULL;
}
static void short_array(Call* c) {
  c->array.value_count = 5;
}
static void small_stride(Call* c) {
  c->array.stride = 1;
}
static void interpolation(Call* c) {
  c->array.interpolation = 256;
}
static void fill_rule(Call* c) {
  c->draws[1].fill_rule = 8;
}
static void front_face(Call* c) {
  c->draws[1].front_face = 2;
}
static void cull(Call* c) {
  c->draws[1].cull = 3;
}
static void depth_mode(Call* c) {
  c->draws[1].depth_mode = 3;
}
static void conservative(Call* c) {
  c->draws[1].conservative = SUREFILL_CONSERVATIVE_OVER;
}
static void grid_bits(Call* c) {
  c->grid.bits = 13;
}
static void grid_rounding(Call* c) {
  c->grid.rounding = 3;
}
static void negative_threads(Call* c) {
  c->options.threads = -1;
}
static void many_threads(Call* c) {
  c->options.threads = SUREFILL_MAX_THREADS + 1;
}
static void path(Call* c) {
  c->options.path = 7;
}

#define CASE(function, status) \
  { #function, function, status }
static const struct {
  const char* name;
  void (*spoil)(Call*);
  surefill_status expected;
} kCases[] = {
    CASE(null_target, SUREFILL_NULL_TARGET),
    CASE(null_draws, SUREFILL_DRAWS),
    CASE(short_target, SUREFILL_TARGET_STRUCT_SIZE),
    CASE(long_target, SUREFILL_TARGET_STRUCT_SIZE),
    CASE(no_draw_size, SUREFILL_DRAW_STRUCT_SIZE),
    CASE(mixed_draw_sizes, SUREFILL_DRAW_STRUCT_SIZE),
    CASE(options_size, SUREFILL_OPTIONS_STRUCT_SIZE),
    CASE(statistics_size, SUREFILL_STATISTICS_STRUCT_SIZE),
    CASE(negative_width, SUREFILL_TARGET_SIZE),
    CASE(no_height, SUREFILL_TARGET_SIZE),
    CASE(too_wide, SUREFILL_TARGET_SIZE),
    CASE(three_samples, SUREFILL_TARGET_SAMPLES),
    CASE(no_samples, SUREFILL_TARGET_SAMPLES),
    CASE(short_count, SUREFILL_TARGET_COUNT),
    CASE(null_index, SUREFILL_TARGET_INDEX),
    CASE(long_depth, SUREFILL_TARGET_DEPTH),
    CASE(two_weights, SUREFILL_TARGET_BARYCENTRICS),
    CASE(short_initial, SUREFILL_TARGET_INITIAL_DEPTH),
    CASE(overlap, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_input, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_draws, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_arrays, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_attribute_list, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_target, SUREFILL_TARGET_OVERLAP),
    CASE(output_is_first_strided_input, SUREFILL_TARGET_OVERLAP),
    CASE(depth_test, SUREFILL_TARGET_DEPTH_TEST),
    CASE(far_depth_test, SUREFILL_TARGET_DEPTH_TEST),
    CASE(location, SUREFILL_TARGET_ATTRIBUTE_LOCATION),
    CASE(five_components, SUREFILL_TARGET_ATTRIBUTES),
    CASE(null_attribute_list, SUREFILL_TARGET_ATTRIBUTES),
    CASE(null_attribute_list_and_stride, SUREFILL_TARGET_ATTRIBUTES),
    CASE(many_attributes, SUREFILL_TARGET_ATTRIBUTES),
    CASE(null_vertices, SUREFILL_DRAW_VERTICES),
    CASE(small_vertex_stride, SUREFILL_DRAW_VERTEX_STRIDE),
    CASE(odd_vertex_stride, SUREFILL_DRAW_VERTEX_STRIDE),
    CASE(negative_vertex_stride, SUREFILL_DRAW_VERTEX_STRIDE),
    CASE(huge_vertex_stride, SUREFILL_DRAW_VERTEX_STRIDE),
    CASE(strided_null_vertices, SUREFILL_DRAW_VERTICES),
    CASE(output_is_strided_input, SUREFILL_TARGET_OVERLAP),
    CASE(null_indices, SUREFILL_DRAW_INDICES),
    CASE(four_indices, SUREFILL_DRAW_INDICES),
    CASE(out_of_range, SUREFILL_DRAW_INDEX_OUT_OF_RANGE),
    CASE(negative_index, SUREFILL_DRAW_INDEX_OUT_OF_RANGE),
    CASE(two_identifiers, SUREFILL_DRAW_IDENTIFIERS),
    CASE(no_triangle, SUREFILL_DRAW_IDENTIFIERS),
    CASE(first_index, SUREFILL_DRAW_FIRST_INDEX),
    CASE(no_arrays, SUREFILL_DRAW_ATTRIBUTES),
    CASE(null_arrays, SUREFILL_DRAW_ATTRIBUTES),
    CASE(short_array, SUREFILL_DRAW_ATTRIBUTES),
    CASE(small_stride, SUREFILL_DRAW_ATTRIBUTES),
    CASE(interpolation, SUREFILL_DRAW_ATTRIBUTE_INTERPOLATION),
    CASE(fill_rule, SUREFILL_DRAW_FILL_RULE),
    CASE(front_face, SUREFILL_DRAW_FRONT_FACE),
    CASE(cull, SUREFILL_DRAW_CULL),
    CASE(depth_mode, SUREFILL_DRAW_DEPTH_MODE),
    CASE(conservative, SUREFILL_DRAW_CONSERVATIVE),
    CASE(grid_bits, SUREFILL_DRAW_GRID),
    CASE(grid_rounding, SUREFILL_DRAW_GRID),
    CASE(negative_threads, SUREFILL_OPTIONS_THREADS),
    CASE(many_threads, SUREFILL_OPTIONS_THREADS),
    CASE(path, SUREFILL_OPTIONS_PATH),
};

static int failures = 0;

static void check(const char* name, int good) {
  if (good) return;
  ++failures;
  fprintf(stderr, "wrong_calls: %s\n", name);
}

static void check_render(void) {
  static Call call, before;
  size_t i;
  for (i = 0; i < sizeof kCases / sizeof kCases[0]; ++i) {
    make(&call);
    kCases[i].spoil(&call);
    memcpy(&before, &call, sizeof call);
    check(kCases[i].name, render(&call) == kCases[i].expected);
    check(kCases[i].name, of_options(kCases[i].expected) || validate(&call) == kCases[i].expected);
    check(kCases[i].name, memcmp(&before, &call, sizeof call) == 0);
    check(kCases[i].name, strcmp(surefill_status_text(kCases[i].expected), "unknown status") != 0);
  }
  make(&call);
  output_is_statistics(&call); /* which surefill_validate does not see */
  memcpy(&before, &call, sizeof call);
  check("output_is_statistics", validate(&call) == SUREFILL_OK);
  check("output_is_statistics", render(&call) == SUREFILL_TARGET_OVERLAP && memcmp(&before, &call, sizeof call) == 0);
  make(&call);
  check("the correct call", render(&call) == SUREFILL_OK);
  check("its statistics", call.statistics.triangles == 2 && call.statistics.rasterized == 2);
  make(&call);
  call.vertices[0].x = (float)NAN; /* no error: the triangle is dropped and counted [B1] */
  check("a NaN", render(&call) == SUREFILL_OK && call.statistics.dropped == 2 && call.index[0] == SUREFILL_NO_TRIANGLE);
}

/* Vertices among other data, and a struct without the member for it: the image is that of the correct call. */
static void check_vertex_stride(void) {
  static Call call, expected;
  struct {
    surefill_vertex position;
    float normal[3];
  } interleaved[3];
  size_t older[2 * offsetof(surefill_draw, vertex_stride) / sizeof(size_t)];
  const size_t older_size = offsetof(surefill_draw, vertex_stride);
  size_t i;
  make(&expected);
  check("dense", render(&expected) == SUREFILL_OK);
  memset(interleaved, 0xFF, sizeof interleaved); /* NaNs between the vertices */
  make(&call);
  for (i = 0; i < 3; ++i) interleaved[i].position = call.vertices[i];
  for (i = 0; i < 2; ++i) {
    call.draws[i].vertices = &interleaved[0].position, call.draws[i].vertex_stride = sizeof interleaved[0];
  }
  check("validate with a stride", surefill_validate(&call.target, call.draws, 2) == SUREFILL_OK);
  check("stride", render(&call) == SUREFILL_OK);
  check("image with a stride", memcmp(call.count, expected.count, sizeof call.count) == 0 &&
                                   memcmp(call.depth, expected.depth, sizeof call.depth) == 0 &&
                                   memcmp(call.barycentrics, expected.barycentrics, sizeof call.barycentrics) == 0);
  check("statistics with a stride", call.statistics.rasterized == 2 && call.statistics.dropped == 0);
  for (i = 0; i < 2; ++i) call.draws[i].vertex_stride = sizeof(surefill_vertex);
  for (i = 0; i < 2; ++i) call.draws[i].vertices = call.vertices;
  check("stride 16", render(&call) == SUREFILL_OK && memcmp(call.depth, expected.depth, sizeof call.depth) == 0);
  make(&call);
  for (i = 0; i < 2; ++i) {
    call.draws[i].struct_size = older_size, call.draws[i].vertex_stride = 12;
    memcpy((char*)older + i * older_size, &call.draws[i], older_size);
  }
  check("shorter struct", surefill_render(&call.target, (const surefill_draw*)older, 2, NULL, NULL) == SUREFILL_OK &&
                              memcmp(call.depth, expected.depth, sizeof call.depth) == 0);
}

static void check_to_pixel(void) {
  surefill_viewport viewport = {0, 0, 4, 3, 0, 1, 0, 0};
  surefill_vertex in[2] = {{0, 0, 0, 1}, {1, 1, 1, 1}}, out[2] = {{7, 7, 7, 7}, {7, 7, 7, 7}};
  check("null viewport", surefill_to_pixel(NULL, in, 2, out) == SUREFILL_NULL_VIEWPORT);
  check("null clip vertices", surefill_to_pixel(&viewport, NULL, 2, out) == SUREFILL_TO_PIXEL_VERTICES);
  check("null out", surefill_to_pixel(&viewport, in, 2, NULL) == SUREFILL_TO_PIXEL_VERTICES);
  check("in place", surefill_to_pixel(&viewport, in, 2, in) == SUREFILL_TO_PIXEL_VERTICES);
  viewport.clip_y_down = 256;
  check("clip y", surefill_to_pixel(&viewport, in, 2, out) == SUREFILL_VIEWPORT);
  viewport.clip_y_down = 0, viewport.height = (float)INFINITY;
  check("infinite viewport", surefill_to_pixel(&viewport, in, 2, out) == SUREFILL_VIEWPORT);
  check("nothing mapped", out[0].x == 7 && out[1].w == 7 && in[1].x == 1);
}

/* A triangle in front of the box, its vertices 32 bytes apart. */
static void check_strided_occluder(surefill_occlusion* occlusion, const surefill_box* box) {
  static const surefill_vertex kVertices[5] = {
      {-9, -9, 0, 1}, {0, 0, (float)NAN, 0}, {99, -9, 0, 1}, {0, 0, (float)NAN, 0}, {-9, 99, 0, 1}};
  static const uint32_t kIndices[3] = {0, 1, 2};
  surefill_draw draw;
  uint8_t answer = 77;
  memset(&draw, 0, sizeof draw);
  draw.struct_size = sizeof draw;
  draw.vertices = kVertices, draw.vertex_count = 3, draw.vertex_stride = 8;
  draw.indices = kIndices, draw.index_count = 3;
  check("stride of an occluder",
        surefill_occlusion_draw(occlusion, &draw, 1, NULL, NULL) == SUREFILL_DRAW_VERTEX_STRIDE);
  check("no occluder",
        surefill_occlusion_query_boxes(occlusion, box, 1, &answer) == SUREFILL_OK && answer == SUREFILL_VISIBLE);
  draw.vertex_stride = 2 * sizeof(surefill_vertex);
  check("strided occluder", surefill_occlusion_draw(occlusion, &draw, 1, NULL, NULL) == SUREFILL_OK);
  check("hidden by it",
        surefill_occlusion_query_boxes(occlusion, box, 1, &answer) == SUREFILL_OK && answer == SUREFILL_HIDDEN);
}

static void check_occlusion(void) {
  surefill_occlusion* occlusion = NULL;
  surefill_box boxes[2];
  surefill_rectangle rectangle = {0, 0, 4, 4, 0};
  uint8_t answers[2] = {77, 77};
  size_t i;
  for (i = 0; i < 16; ++i) {
    const surefill_vertex corner = {(float)(i & 1), (float)(i & 2), 0.5f, 1};
    boxes[i / 8].corners[i % 8] = corner;
  }
  check("no place", surefill_occlusion_create(4, 4, SUREFILL_LESS, NULL) == SUREFILL_NULL_OCCLUSION);
  check("no size", surefill_occlusion_create(0, 4, SUREFILL_LESS, &occlusion) == SUREFILL_TARGET_SIZE);
  check("large", surefill_occlusion_create(4, 99999, SUREFILL_LESS, &occlusion) == SUREFILL_TARGET_SIZE);
  check("test", surefill_occlusion_create(4, 4, 256, &occlusion) == SUREFILL_TARGET_DEPTH_TEST);
  check("nothing made", occlusion == NULL && surefill_occlusion_depth(NULL) == NULL);
  surefill_occlusion_clear(NULL);
  surefill_occlusion_destroy(NULL);
  check("null draw", surefill_occlusion_draw(NULL, NULL, 0, NULL, NULL) == SUREFILL_NULL_OCCLUSION);
  check("null query", surefill_occlusion_query_boxes(NULL, boxes, 2, answers) == SUREFILL_NULL_OCCLUSION);
  check("made", surefill_occlusion_create(4, 4, SUREFILL_LESS, &occlusion) == SUREFILL_OK);
  check("null draws", surefill_occlusion_draw(occlusion, NULL, 1, NULL, NULL) == SUREFILL_DRAWS);
  check("null boxes", surefill_occlusion_query_boxes(occlusion, NULL, 2, answers) == SUREFILL_QUERY_BOXES);
  check("null answers", surefill_occlusion_query_boxes(occlusion, boxes, 2, NULL) == SUREFILL_QUERY_ANSWERS);
  boxes[1].corners[3].w = (float)NAN;
  check("NaN corner", surefill_occlusion_query_boxes(occlusion, boxes, 2, answers) == SUREFILL_QUERY_BOXES);
  rectangle.nearest_depth = (float)NAN;
  check("NaN depth", surefill_occlusion_query_rectangles(occlusion, &rectangle, 1, answers) == SUREFILL_QUERY_BOXES);
  check("nothing answered", answers[0] == 77 && answers[1] == 77);
  check("one box", surefill_occlusion_query_boxes(occlusion, boxes, 1, answers) == SUREFILL_OK);
  check("its answer", answers[0] == SUREFILL_VISIBLE && answers[1] == 77);
  check_strided_occluder(occlusion, boxes);
  surefill_occlusion_destroy(occlusion);
}

int main(void) {
  check_render();
  check_vertex_stride();
  check_to_pixel();
  check_occlusion();
  check("unknown status", strcmp(surefill_status_text((surefill_status)1023), "unknown status") == 0);
  if (failures == 0) printf("wrong calls through C: each names its argument and writes nothing\n");
  return failures == 0 ? 0 : 1;
}
