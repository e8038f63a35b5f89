/* SPDX-License-Identifier: Apache-2.0
 *
 * Version 2 of the adapter (docs/adapters.md): what version 1 has (adapter.h: space, buffers, rules and threads are as there),
 * in structs that can grow, with the whole language of models. A plugin exports `surefill_adapter2_entry`; one that exports the
 * entry of version 1, too, is asked by this one.
 *
 * Sizes      Every struct that is passed begins with its size in bytes, as whoever filled it knows it.
 *            What you are given: read no member beyond `size` (SUREFILL_ADAPTER2_HAS). None that is added later differs from its
 *            default in a scene unless you claimed the feature that goes with it, so what you know is enough.
 *            What you fill: `size` is the room that there is, and then the size that you know. What lies beyond yours is left as
 *            it came. Where you know more than certify does, all of that must be 0, or you are not judged.
 * Bits       Outputs and features are 64 bits. Those of version 1 have their places.
 */
#ifndef SUREFILL_ADAPTER2_H
#define SUREFILL_ADAPTER2_H

#include <stddef.h>

#include "adapter.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SUREFILL_ADAPTER2_VERSION 2u

/* Is the member within what was filled? */
#define SUREFILL_ADAPTER2_HAS(type, pointer, member) \
  ((pointer)->size >= offsetof(type, member) + sizeof(((const type*)0)->member))

/* Features beside those of version 1: bits 19 and 20. The fill rules of draws may be CLOSED and OPEN, too (C3); draws of lines
 * and points may have a width (M7). */
#define SUREFILL_ADAPTER2_CLOSED_AND_OPEN (UINT64_C(1) << 19)
#define SUREFILL_ADAPTER2_WIDTHS (UINT64_C(1) << 20)
enum { SUREFILL_ADAPTER2_CLOSED = 8, SUREFILL_ADAPTER2_OPEN = 9 }; /* after the eight of version 1 */

/* Primitives (M7). `info.primitives` has a bit 1 << KIND for each; triangles are always asked for, lines and points where they are
 * claimed. A primitive has 3, 2 or 1 indices. */
enum { SUREFILL_ADAPTER2_TRIANGLES = 0, SUREFILL_ADAPTER2_LINES = 1, SUREFILL_ADAPTER2_POINTS = 2 };

/* Filled in by open; comes zeroed but for its size. Strings as in version 1. A limit of 0 is none. */
typedef struct surefill_adapter2_info {
  uint32_t size;
  uint32_t form; /* SUREFILL_ADAPTER_FORM_PIXEL or FORM_CLIP */
  char name[64];
  char version[64];
  uint64_t outputs;       /* SUREFILL_ADAPTER_COUNT, ... */
  uint64_t features;      /* SUREFILL_ADAPTER_BEHIND, ... */
  uint32_t primitives;    /* 0 is triangles, too */
  uint32_t profile;       /* SUREFILL_ADAPTER_PROFILE_VULKAN, ...; 0 is EXACT, compared with == */
  uint32_t rows;          /* SUREFILL_ADAPTER_Y_DOWN, ... */
  uint32_t clip_depth;    /* SUREFILL_ADAPTER_ZERO_TO_ONE, ... */
  uint32_t reported_bits; /* of subpixel precision, that it reports; 0: none */
  uint32_t max_width, max_height;
  uint32_t max_vertices, max_primitives; /* of a draw */
  uint32_t max_attributes, max_components;
  uint32_t unused;
} surefill_adapter2_info;

/* Section 11 of docs/semantics.md in numbers. Lengths are pixels. */
enum {
  SUREFILL_ADAPTER2_ROUND_NEAREST_EVEN = 0,
  SUREFILL_ADAPTER2_ROUND_NEAREST_UP = 1,
  SUREFILL_ADAPTER2_ROUND_NEAREST_DOWN = 2,
  SUREFILL_ADAPTER2_ROUND_NEAREST_AWAY = 3,
  SUREFILL_ADAPTER2_ROUND_TRUNCATE = 4,
  SUREFILL_ADAPTER2_ROUND_FLOOR = 5,
  SUREFILL_ADAPTER2_ROUND_CEILING = 6
};

typedef struct surefill_adapter2_axis {
  double place, place_within; /* of the sample in its pixel, 1/2 being its centre, and how well that is known (R2):
                                  2^-16 at best, if it is no multiple of that */
  double lacks, moved;        /* of the viewport (R3) */
  double blur,
      divided_blur;   /* how far a position may be from where it should be, and where W is no power of two (R4) */
  double grid_offset; /* R5 */
  int32_t grid_bits;  /* -1: no grid */
  uint32_t rounding;
} surefill_adapter2_axis;

/* The sides of a triangle that an edge can be on, as bits (R6): who owns the samples on it. */
enum {
  SUREFILL_ADAPTER2_LEFT = 1 << 0,
  SUREFILL_ADAPTER2_RIGHT = 1 << 1,
  SUREFILL_ADAPTER2_TOP = 1 << 2,
  SUREFILL_ADAPTER2_BOTTOM = 1 << 3,
  SUREFILL_ADAPTER2_TOP_LEFT = 1 << 4,
  SUREFILL_ADAPTER2_TOP_RIGHT = 1 << 5,
  SUREFILL_ADAPTER2_BOTTOM_LEFT = 1 << 6,
  SUREFILL_ADAPTER2_BOTTOM_RIGHT = 1 << 7
};

enum {
  SUREFILL_ADAPTER2_VERTICES_AS_EDGES = 0,
  SUREFILL_ADAPTER2_VERTICES_COVERED = 1,
  SUREFILL_ADAPTER2_VERTICES_NOT_COVERED = 2,
  SUREFILL_ADAPTER2_VERTICES_OPEN = 3
};
enum { SUREFILL_ADAPTER2_TURNED_OPEN = 0, SUREFILL_ADAPTER2_TURNED_AS_GRID = 1, SUREFILL_ADAPTER2_TURNED_NOTHING = 2 };
enum {
  SUREFILL_ADAPTER2_DEPTH_FLOAT32 = 0,
  SUREFILL_ADAPTER2_DEPTH_FLOAT64 = 1,
  SUREFILL_ADAPTER2_DEPTH_UNORM24 = 2,
  SUREFILL_ADAPTER2_DEPTH_UNORM16 = 3
};

/* Lines and points: R17 to R21. */
enum {
  SUREFILL_ADAPTER2_LINE_DIAMOND = 0,
  SUREFILL_ADAPTER2_LINE_PARALLELOGRAM = 1,
  SUREFILL_ADAPTER2_LINE_RECTANGLE = 2,
  SUREFILL_ADAPTER2_LINE_TOLERANT = 3,
  SUREFILL_ADAPTER2_LINE_UNKNOWN = 4
};
enum {
  SUREFILL_ADAPTER2_LEFT_OUT_LAST = 0,
  SUREFILL_ADAPTER2_LEFT_OUT_FIRST = 1,
  SUREFILL_ADAPTER2_LEFT_OUT_NONE = 2,
  SUREFILL_ADAPTER2_LEFT_OUT_BOTH = 3
};
enum { SUREFILL_ADAPTER2_TIES_OPEN = 8 }; /* after the eight fill rules of version 1 */

typedef struct surefill_adapter2_outline {
  uint32_t ties; /* SUREFILL_ADAPTER_TOP_LEFT, ..., or SUREFILL_ADAPTER2_TIES_OPEN (R20) */
  uint32_t unused;
  double blur;                    /* R17 */
  double border;                  /* R20, and so on */
  double least_width, most_width; /* 0, infinity */
  double width_within;
} surefill_adapter2_outline;

typedef struct surefill_adapter2_model {
  uint32_t size;
  uint32_t front_owned, front_open; /* sides that own their samples, and those of which it is not said (R6) */
  uint32_t back_owned, back_open;
  uint32_t vertices;
  uint32_t turned; /* triangles that snapping turns over (R8) */
  uint32_t culled; /* SUREFILL_ADAPTER_CULL_FRONT, CULL_BACK: always (R10) */
  surefill_adapter2_axis x, y;
  double least_area;      /* R8: in square pixels; smaller triangles may be left out */
  double least_w, most_w; /* R9 */
  double clip_near, clip_far;
  double clear;          /* of the depth buffer (R12) */
  double distance;       /* p of R11 */
  uint32_t clips;        /* 1: depth is always clipped to clip_near, clip_far (R10) */
  uint32_t depth_format; /* R11 */
  uint32_t minus_one_to_one;
  uint32_t later_wins;             /* of equal depths: LEQUAL, GEQUAL (R12) */
  uint32_t thin_lines, wide_lines; /* SUREFILL_ADAPTER2_LINE_DIAMOND and _PARALLELOGRAM, ... (R18) */
  uint32_t left_out;               /* SUREFILL_ADAPTER2_LEFT_OUT_LAST, ... (R19) */
  uint32_t whole_pixels;           /* of ends (R17) */
  surefill_adapter2_outline lines, points;
  uint32_t points_unknown, points_clipped_whole; /* R21 */
} surefill_adapter2_model;

typedef struct surefill_adapter2_attribute {
  uint32_t size;
  uint32_t components, interpolation;
  uint32_t unused;
  const float* values;
} surefill_adapter2_attribute;

/* As in version 1; primitive t has the indices [n t], [n t + 1], ..., n being 3, 2 or 1. */
typedef struct surefill_adapter2_draw {
  uint32_t size;
  uint32_t primitive; /* SUREFILL_ADAPTER2_TRIANGLES, ... */
  uint32_t vertex_count, primitive_count;
  const float* pixel;
  const float* clip;
  const uint32_t* indices;
  const uint32_t* identifiers;
  const surefill_adapter2_attribute* const* attributes;
  uint32_t clip_is_exact;
  float viewport_x, viewport_y, viewport_width, viewport_height, viewport_near, viewport_far;
  uint32_t viewport_depth_range;
  uint32_t fill_rule, front_face, cull, depth_mode, depth_write, conservative;
  uint32_t has_scissor;
  int32_t scissor[4];
  uint32_t has_grid;
  uint32_t grid_bits, grid_rounding, grid_offset_x, grid_offset_y;
  float width; /* of lines, or the side of points; 0: none */
  uint32_t unused;
} surefill_adapter2_draw;

/* Draws and attributes are behind pointers, since an array of what can grow has no fixed step. */
typedef struct surefill_adapter2_scene {
  uint32_t size;
  uint32_t width, height, samples;
  uint32_t depth_test, attribute_location;
  uint32_t attribute_count, draw_count;
  const surefill_adapter2_draw* const* draws;
  const float* initial_depth;
} surefill_adapter2_scene;

typedef struct surefill_adapter2_image {
  uint32_t size;
  uint32_t unused;
  uint32_t* count;
  uint32_t* index;
  float* depth;
  float* barycentrics;
  float* const* attributes;
} surefill_adapter2_image;

typedef struct surefill_adapter2_api {
  uint32_t size;
  uint32_t version; /* SUREFILL_ADAPTER2_VERSION */
  int (*open)(const char* arguments, surefill_adapter2_info* info, void** instance);
  int (*draw)(void* instance, const surefill_adapter2_scene* scene, const surefill_adapter2_image* image);
  void (*close)(void* instance);
  const char* (*error_text)(void* instance);
  /* States the model, once, after open: fills in what differs from the defaults of section 11, which it comes with.
   * Null, or SUREFILL_ADAPTER_UNSUPPORTED: certify finds out. */
  int (*model)(void* instance, surefill_adapter2_model* model);
} surefill_adapter2_api;

const surefill_adapter2_api* surefill_adapter2_entry(void);

#ifdef __cplusplus
}
#endif

#endif /* SUREFILL_ADAPTER2_H */
