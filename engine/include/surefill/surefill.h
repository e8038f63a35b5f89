/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Surefill for C: an exact triangle rasterizer. The same engine as surefill.hpp; docs/semantics.md defines every bit of
 * the output, and the letters in brackets (S2, C3, I4, ...) are its rules. C99; any language that calls C can use it.
 *
 * Space      Pixels: x to the right, y down; pixel (i, j) is [i, i+1) x [j, j+1) [S1]. A vertex (X, Y, Z, W) is
 *            pixel-homogeneous: where W > 0 it projects to pixel position (X/W, Y/W) and depth Z/W [S2].
 *            surefill_to_pixel makes such vertices from clip space [S3].
 * Structs    A struct that may grow begins with struct_size: set it to the sizeof, and all else to 0 but for what you
 *            need: 0 is the default of every member, if not said otherwise. A library that knows more members takes 0
 *            for those that the caller does not know; one that knows fewer refuses a struct that is longer than its
 *            own with a status that names it.
 * Buffers    The caller's, never kept, dense where no stride is given, each with its number of elements: an output of
 *            0 elements is not asked for. Pointers to 0 elements may be null.
 * Errors     A status names the first argument found to be wrong; then nothing was written [B2]. No call throws, prints
 *            or aborts. NULL is allowed only where it is said.
 * Threads    Calls share no state: any number may run at once on different buffers.
 */
#ifndef SUREFILL_SUREFILL_H
#define SUREFILL_SUREFILL_H

#include <stddef.h>
#include <stdint.h>

#include "surefill/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Empty samples hold this index [V1]. */
#define SUREFILL_NO_TRIANGLE 0xFFFFFFFFu
/* Pixels of a target, each way [S5]. */
#define SUREFILL_MAX_TARGET_SIZE 16384
/* Attribute arrays of a draw. */
#define SUREFILL_MAX_ATTRIBUTES 16
/* Floats of one attribute. */
#define SUREFILL_MAX_COMPONENTS 4
/* Threads of a call. */
#define SUREFILL_MAX_THREADS 256
#define SUREFILL_MAX_ORIGIN 4194304 /* pixels, each way and sign */
#define SUREFILL_MAX_LAYERS 16      /* of a frame [V4] */

/* What a call returns: the argument at fault. Numbers are never reused. */
typedef enum surefill_status {
  SUREFILL_OK = 0,
  SUREFILL_OUT_OF_MEMORY,        /* outputs asked for hold unspecified values */
  SUREFILL_TARGET_SIZE,          /* width or height outside 1..SUREFILL_MAX_TARGET_SIZE */
  SUREFILL_TARGET_SAMPLES,       /* samples not 1, 2, 4, 8 or 16 */
  SUREFILL_TARGET_COUNT,         /* count: neither 0 elements nor surefill_sample_total */
  SUREFILL_TARGET_INDEX,         /* index: the same */
  SUREFILL_TARGET_DEPTH,         /* depth: the same */
  SUREFILL_TARGET_BARYCENTRICS,  /* barycentrics: neither 0 elements nor 3 * surefill_sample_total */
  SUREFILL_TARGET_ATTRIBUTES,    /* components outside 1..4, more than 16, null, or the wrong size or stride */
  SUREFILL_TARGET_INITIAL_DEPTH, /* initial_depth: neither 0 elements nor surefill_sample_total */
  SUREFILL_TARGET_OVERLAP,       /* an output, statistics and answers too, overlaps another or what the call reads; only
                                    initial_depth and depth may be the same, and attribute images of one stride may lie
                                    in one another, component beside component */
  SUREFILL_TARGET_DEPTH_TEST,    /* not a surefill_depth_test */
  SUREFILL_TARGET_ATTRIBUTE_LOCATION,    /* not a surefill_attribute_location */
  SUREFILL_DRAWS,                        /* draws is null, and draw_count is not 0 */
  SUREFILL_DRAW_VERTICES,                /* vertices null or more than 2^32 - 1 */
  SUREFILL_DRAW_INDICES,                 /* indices null, no multiple of 3 (lines: of 2), or over 2^32 - 2 triangles */
  SUREFILL_DRAW_INDEX_OUT_OF_RANGE,      /* an index that names no vertex */
  SUREFILL_DRAW_IDENTIFIERS,             /* neither 0 nor one for each triangle, or one is SUREFILL_NO_TRIANGLE [B5] */
  SUREFILL_DRAW_FIRST_INDEX,             /* first_index + triangles exceeds 2^32 - 1 [B5] */
  SUREFILL_DRAW_ATTRIBUTES,              /* fewer arrays than the target asks for, other components, or too short */
  SUREFILL_DRAW_ATTRIBUTE_INTERPOLATION, /* not a surefill_interpolation */
  SUREFILL_DRAW_FILL_RULE,               /* not a surefill_fill_rule, or closed or open with a grid or lines */
  SUREFILL_DRAW_FRONT_FACE,              /* not a surefill_front_face */
  SUREFILL_DRAW_CULL,                    /* not a surefill_cull */
  SUREFILL_DRAW_DEPTH_MODE,              /* not a surefill_depth_mode */
  SUREFILL_DRAW_CONSERVATIVE,            /* not a surefill_conservative, with too much asked for [M4], or of lines */
  SUREFILL_DRAW_GRID,                    /* bits outside 0..12, an offset outside 0..15, no rounding, or of lines */
  SUREFILL_VIEWPORT,                     /* a viewport number that is not finite, or not an enumerator */
  SUREFILL_OPTIONS_THREADS,              /* threads outside 1..SUREFILL_MAX_THREADS (and not 0, which means 1) */
  SUREFILL_OPTIONS_PATH,                 /* not a surefill_path */
  SUREFILL_QUERY_BOXES,                  /* boxes or rectangles null, or with a number that is not finite */
  SUREFILL_QUERY_ANSWERS,                /* answers null, or not one for each box */
  SUREFILL_VISITOR,                      /* of surefill_visit_coverage: the visitor is NULL */
  SUREFILL_BAD_BUILD = 33, /* the library was compiled with options that break exact arithmetic (docs/library.md) */
  SUREFILL_TO_PIXEL_VERTICES = 34,  /* of to_pixel: vertices or results null, or they overlap */
  SUREFILL_TARGET_OUTPUTS = 35,     /* of surefill_visit_coverage: the target asks for an output, or for layers */
  SUREFILL_TARGET_ORIGIN,           /* origin_x or origin_y above SUREFILL_MAX_ORIGIN in magnitude */
  SUREFILL_TARGET_SAMPLE_LOCATIONS, /* neither 0 nor one a sample, a place outside 0..15, or with a conservative draw */
  SUREFILL_TARGET_LAYERS,   /* above SUREFILL_MAX_LAYERS, or above 1 with depth write off or a conservative draw [V4] */
  SUREFILL_TARGET_WINDING,  /* neither 0 nor one a sample */
  SUREFILL_DRAW_DEPTH_BIAS, /* a number that is not finite, or of lines or points */
  SUREFILL_DRAW_COVERED,    /* neither 0 nor one a triangle */
  SUREFILL_DRAW_VISIBLE,    /* the same, or with a conservative draw [M10] */
  SUREFILL_DRAW_PRIMITIVE,  /* not a surefill_primitive */
  SUREFILL_DRAW_WIDTH,      /* not finite, below 0, or 0 for lines of a target with several samples [M7] */
  SUREFILL_DRAW_SCISSOR,    /* of a safe occlusion buffer: a scissor [O4] */
  SUREFILL_DRAW_DEPTH_WRITE,   /* of the same: depth write off */
  SUREFILL_OCCLUDER_POSITIONS, /* null, over 2^32 - 1, or a stride under 12 or no multiple of 4 */
  SUREFILL_OCCLUDER_MESH,      /* the mesh, or the place for a new one, is null */
  SUREFILL_OCCLUDER_VERTICES,  /* two at one place of the mesh differ in X, Y or W [O4] */
  /* Of this interface alone. */
  SUREFILL_NULL_TARGET = 1000,     /* target is null */
  SUREFILL_NULL_VIEWPORT,          /* viewport is null */
  SUREFILL_NULL_OCCLUSION,         /* the occlusion buffer, or the place for a new one, is null */
  SUREFILL_TARGET_STRUCT_SIZE,     /* target->struct_size is no struct size this version knows */
  SUREFILL_DRAW_STRUCT_SIZE,       /* draws[i].struct_size: the same, or draws of several sizes in one list */
  SUREFILL_OPTIONS_STRUCT_SIZE,    /* options->struct_size: the same */
  SUREFILL_STATISTICS_STRUCT_SIZE, /* statistics->struct_size: the same */
  SUREFILL_DRAW_VERTEX_STRIDE      /* vertex_stride: under 16, no multiple of 4, or the array exceeds memory */
} surefill_status;

/* Which side owns a sample that lies exactly on an edge [C3]. */
typedef enum surefill_fill_rule {
  SUREFILL_TOP_LEFT = 0, /* Direct3D, Vulkan */
  SUREFILL_TOP_RIGHT,
  SUREFILL_BOTTOM_LEFT, /* OpenGL with y up */
  SUREFILL_BOTTOM_RIGHT,
  SUREFILL_SOUTHWARDS,
  SUREFILL_SOUTHWARDS_WEST,
  SUREFILL_NORTHWARDS,
  SUREFILL_NORTHWARDS_WEST,
  SUREFILL_CLOSED, /* every such sample is covered [C5]; not with a grid */
  SUREFILL_OPEN    /* none is [C5]; not with a grid */
} surefill_fill_rule;

/* What a draw consists of: of so many vertices each, 3, 2 or 1. What is said of triangles holds for lines and points too,
 * where nothing else is said. They have no facing: nothing culls them, and they add 0 to winding. */
typedef enum surefill_primitive { SUREFILL_TRIANGLES = 0, SUREFILL_LINES, SUREFILL_POINTS } surefill_primitive;
/* Which facing is the front, as seen on the screen [F1]. */
typedef enum surefill_front_face { SUREFILL_CLOCKWISE = 0, SUREFILL_COUNTER_CLOCKWISE } surefill_front_face;
/* Which facing is not drawn [F2]. */
typedef enum surefill_cull { SUREFILL_CULL_NONE = 0, SUREFILL_CULL_FRONT, SUREFILL_CULL_BACK } surefill_cull;
/* Which depth is nearer: the smaller, or with reversed z the greater [V1]. With the last two the later one of equal
 * depths is seen [V5]. */
typedef enum surefill_depth_test {
  SUREFILL_LESS = 0,
  SUREFILL_GREATER,
  SUREFILL_LESS_EQUAL,
  SUREFILL_GREATER_EQUAL
} surefill_depth_test;
/* What happens outside 0 <= z <= 1 [I5]. */
typedef enum surefill_depth_mode {
  SUREFILL_DEPTH_NONE = 0, /* nothing: any depth is kept */
  SUREFILL_DEPTH_CLIP,     /* the fragment is dropped */
  SUREFILL_DEPTH_CLAMP     /* z is clamped */
} surefill_depth_mode;
/* How an attribute varies over a triangle [I2]. */
typedef enum surefill_interpolation {
  SUREFILL_PERSPECTIVE = 0,
  SUREFILL_NOPERSPECTIVE, /* affine on the screen */
  SUREFILL_FLAT           /* the value of vertex 0 */
} surefill_interpolation;
/* Where in a pixel of several samples attributes are taken [M1]. */
typedef enum surefill_attribute_location { SUREFILL_CENTRE = 0, SUREFILL_CENTROID } surefill_attribute_location;
/* Whole pixels instead of samples: those that the triangle meets, or those that lie in it [M4], those that share an area
 * with it [M4a], those that it meets though it be degenerate [M4b]. */
typedef enum surefill_conservative {
  SUREFILL_CONSERVATIVE_NONE = 0,
  SUREFILL_CONSERVATIVE_OVER,
  SUREFILL_CONSERVATIVE_INNER,
  SUREFILL_CONSERVATIVE_OVERLAP,
  SUREFILL_CONSERVATIVE_TOUCHED
} surefill_conservative;
/* How positions go to the grid [section 6]. */
typedef enum surefill_grid_rounding {
  SUREFILL_NEAREST_EVEN = 0,
  SUREFILL_NEAREST_UP,
  SUREFILL_TRUNCATE
} surefill_grid_rounding;
/* Who draws; both give the same image. */
typedef enum surefill_path { SUREFILL_PATH_AUTOMATIC = 0, SUREFILL_PATH_REFERENCE } surefill_path;
/* The answer to an occlusion query [O3, O5]. */
typedef enum surefill_answer {
  SUREFILL_OUTSIDE = 0, /* reaches no sample of the target; of a safe buffer: not even its area */
  SUREFILL_HIDDEN,      /* would change no sample */
  SUREFILL_VISIBLE      /* may be seen */
} surefill_answer;

/* A pixel-homogeneous vertex [S2], or one in clip space where a function says so. 16 bytes. */
typedef struct surefill_vertex {
  float x, y, z, w;
} surefill_vertex;

/* The rectangle of the target, in pixels, and the depth range that clip space is mapped to [S3]. All are set by the
 * caller; finite. */
typedef struct surefill_viewport {
  float x, y, width, height, near_depth, far_depth;
  uint32_t clip_depth_minus_one; /* 0: clip depth is 0..1 (Direct3D, Vulkan); 1: -1..1 (OpenGL) */
  uint32_t clip_y_down;          /* 0: y up in clip space; 1: y down (Vulkan) */
} surefill_viewport;

/* Half-open pixel rectangle [x0, x1) x [y0, y1); any values [M3]. */
typedef struct surefill_scissor {
  int32_t x0, y0, x1, y1;
} surefill_scissor;

/* Positions are snapped to offset + k 2^-bits pixels before coverage, as GPUs do [section 6]. */
typedef struct surefill_grid {
  int32_t bits;               /* 0..12; GPUs have 8 */
  int32_t offset_x, offset_y; /* 0..15, in units of 2^-(bits + 4) pixels */
  uint32_t rounding;          /* surefill_grid_rounding */
} surefill_grid;

/* Depth is z + constant + slope m, rounded once; m is the larger of |dz/dx| and |dz/dy|, a pixel [I8]. Finite. */
typedef struct surefill_depth_bias {
  float constant, slope;
} surefill_depth_bias;

/* A place within a pixel, from its top left corner, in 1/16 pixel: 0..15. */
typedef struct surefill_place {
  int32_t x, y;
} surefill_place;

/* One attribute of every vertex of a draw. Component c of vertex v is values[v * stride + c]. */
typedef struct surefill_attribute_array {
  const float* values;
  size_t value_count;     /* floats: at least (vertices - 1) * stride + components */
  uint32_t components;    /* 1..SUREFILL_MAX_COMPONENTS; must be set */
  uint32_t stride;        /* floats from one vertex to the next; 0 means `components` */
  uint32_t interpolation; /* surefill_interpolation */
} surefill_attribute_array;

/* Triangles and how they are drawn. Triangle t has the vertices indices[3t], indices[3t + 1], indices[3t + 2]; line t has
 * indices[2t] and indices[2t + 1], point t has indices[t]. */
typedef struct surefill_draw {
  size_t struct_size;              /* sizeof(surefill_draw); the same in all draws of a list */
  const surefill_vertex* vertices; /* the first; the next is vertex_stride bytes further on */
  size_t vertex_count;
  const uint32_t* indices;
  size_t index_count;          /* three a triangle, two a line, one a point */
  const uint32_t* identifiers; /* one a triangle, unique; or none: first_index + t [V2] */
  size_t identifier_count;
  const surefill_attribute_array* attributes; /* array k feeds target attribute k; more only take part in B1 */
  size_t attribute_count;
  uint32_t first_index;
  uint32_t fill_rule;                 /* surefill_fill_rule */
  uint32_t front_face;                /* surefill_front_face */
  uint32_t cull;                      /* surefill_cull */
  uint32_t depth_mode;                /* surefill_depth_mode */
  uint32_t conservative;              /* surefill_conservative */
  uint32_t depth_write_off;           /* not 0: the depth image is read only [M5] */
  const surefill_scissor* scissor;    /* NULL: none */
  const surefill_grid* grid;          /* NULL: none, positions are exact */
  const surefill_vertex* culling_box; /* NULL, or 8 corners whose hull contains the draw: the caller's promise [M6] */
  size_t vertex_stride; /* bytes, at least 16, a multiple of 4; 0 means 16: dense. Other strides cost a copy. */
  const surefill_depth_bias* depth_bias; /* NULL: none */
  uint64_t* covered;                     /* one a triangle: at how many samples of the frame it is counted [M10] */
  size_t covered_count;
  uint64_t* visible; /* one a triangle: at how many it is the visible one, in layer 0, when all is drawn [M10] */
  size_t visible_count;
  uint32_t primitive; /* surefill_primitive */
  float width;        /* pixels: of lines, or the side of a point's square; 0: points of 1 pixel, and thin lines [M7] */
} surefill_draw;

/* An attribute image. Component c of sample s is values[s * stride + c]; what lies between is left as it is. */
typedef struct surefill_attribute_target {
  float* values;
  size_t value_count;  /* floats, of layers * surefill_sample_total samples: components * that, with a stride at least
                          (that - 1) * stride + components; or 0: not asked for */
  uint32_t components; /* 1..SUREFILL_MAX_COMPONENTS; must be set */
  uint32_t stride;     /* floats from one sample to the next; 0 means `components` */
} surefill_attribute_target;

/* Where the image goes. Sample n of pixel (x, y) is element (y * width + x) * samples + n of every buffer; in layer l of
 * those that have layers (index, depth, barycentrics, attributes), it is that and l * surefill_sample_total. Each buffer
 * asked for is overwritten whole; a sample without a visible triangle holds index SUREFILL_NO_TRIANGLE, depth +inf
 * (-inf for SUREFILL_GREATER) or the initial depth, barycentrics and attributes +0 [V1]. */
typedef struct surefill_target {
  size_t struct_size;    /* sizeof(surefill_target) */
  int32_t width, height; /* pixels; must be set */
  int32_t samples;       /* a pixel: 1, 2, 4, 8 or 16, at the standard locations [S4]; must be set */
  uint32_t depth_test;   /* surefill_depth_test */
  uint32_t* count;       /* triangles that cover the sample [M2] */
  size_t count_count;
  uint32_t* index; /* the visible triangle [V1, V2] */
  size_t index_count;
  float* depth; /* its depth [I1] */
  size_t depth_count;
  float* barycentrics; /* its perspective-correct weights: 3 floats a sample [I3] */
  size_t barycentrics_count;
  const surefill_attribute_target* attributes; /* its attributes [I2] */
  size_t attribute_count;
  const float* initial_depth; /* a fragment must beat it strictly [V1]; may be the depth buffer itself */
  size_t initial_depth_count;
  uint32_t attribute_location; /* surefill_attribute_location */
  uint32_t layers;             /* 1..SUREFILL_MAX_LAYERS; 0 means 1 [V4] */
  int32_t origin_x, origin_y; /* the pixel of space that is pixel (0, 0) [S6]; up to SUREFILL_MAX_ORIGIN in magnitude */
  const surefill_place* sample_locations; /* one a sample; or NULL: the standard ones [S7] */
  size_t sample_location_count;
  int32_t* winding; /* front-facing triangles minus back-facing ones that cover the sample [M9] */
  size_t winding_count;
} surefill_target;

/* Working memory that outlives calls: what one has allocated, the next ones with the same context use again. Several
 * calls at a time may share one: all but one of them then have memory of their own. */
typedef struct surefill_context surefill_context;
/* An empty context; NULL if there is no memory. */
SUREFILL_API surefill_context* surefill_context_create(void);
/* Frees the context and its memory, while no call uses it. NULL does nothing. */
SUREFILL_API void surefill_context_destroy(surefill_context* context);

/* The caller's own threads: run(context, items, task, argument) calls task(argument, i) once for each i below items, on
 * any threads and in any order, and returns when all have returned; no task waits for another. */
typedef void (*surefill_executor)(void* context, size_t items, void (*task)(void* argument, size_t item),
                                  void* argument);

/* How a frame is drawn. */
typedef struct surefill_options {
  size_t struct_size;         /* sizeof(surefill_options) */
  int32_t threads;            /* 1..SUREFILL_MAX_THREADS; 0 means 1 */
  uint32_t path;              /* surefill_path */
  surefill_context* context;  /* where working memory comes from and stays, or NULL */
  surefill_executor executor; /* whose threads work; or NULL: the call starts threads - 1 of its own */
  void* executor_context;
} surefill_options;

/* The samples of an 8 x 8 block of pixels that a triangle covers. */
typedef struct surefill_block {
  uint32_t draw, triangle; /* positions: in the list of draws, in the draw */
  int32_t x, y;            /* the block's first pixel: multiples of 8 from the target's corner */
  int32_t sample;          /* of each pixel */
  uint64_t mask;           /* bit 8 j + i: pixel (x + i, y + j). Not 0 */
} surefill_block;

/* Receives blocks; all of one call belong to one triangle and sample. Returns normally. */
typedef void (*surefill_visitor)(void* context, const surefill_block* blocks, size_t count);

/* What the triangles of a call were; each counts once, as the first that fits [M11]. */
typedef struct surefill_statistics {
  size_t struct_size; /* sizeof(surefill_statistics), set by the caller */
  uint64_t triangles;
  uint64_t dropped;    /* a NaN or an infinity [B1] */
  uint64_t degenerate; /* D = 0 [C1] */
  uint64_t culled;     /* by facing [F2] */
  uint64_t outside;    /* 0 since 0.2: such triangles are among those rasterized */
  uint64_t rasterized; /* the rest, whether they cover a sample or none */
  const char* path;    /* what drew the frame: "reference", or an instruction set; a string constant */
} surefill_statistics;

/* A depth buffer of occluders that can be asked whether boxes are hidden: semantics.md, section 9. */
typedef struct surefill_occlusion surefill_occlusion;

/* Pixel-homogeneous corners, in any order; the box is their hull. Finite. [O2] */
typedef struct surefill_box {
  surefill_vertex corners[8];
} surefill_box;

/* A closed rectangle in pixels and the nearest depth of what is in it. No NaN. [O2] */
typedef struct surefill_rectangle {
  float x0, y0, x1, y1, nearest_depth;
} surefill_rectangle;

/* Triangles that hide, prepared once for all views and safe buffers: which vertices lie at one place, and which triangles
 * share an edge there. [O4] */
typedef struct surefill_occluder_mesh surefill_occluder_mesh;

/* The depth that occluders have at least, in each pixel's whole square, at whatever resolution they are drawn: a small
 * buffer that is right about every larger picture. [O4, T7] */
typedef struct surefill_safe_occlusion surefill_safe_occlusion;

/* The library's version, "major.minor.patch" (semver.org). Never NULL. */
SUREFILL_API const char* surefill_version(void);

/* An English sentence for a status, without a full stop. Never NULL; for an unknown value, "unknown status". */
SUREFILL_API const char* surefill_status_text(surefill_status status);

/* The viewport map [S3]: `count` vertices of clip space to `out`, pixel-homogeneous. Each component is the exact real
 * value, rounded once to float32. Errors: NULL_VIEWPORT, VIEWPORT, TO_PIXEL_VERTICES (NULL with count > 0, or `out`
 * overlaps what is read), BAD_BUILD. */
SUREFILL_API surefill_status surefill_to_pixel(const surefill_viewport* viewport, const surefill_vertex* vertices,
                                               size_t count, surefill_vertex* out);

/* The number of samples of a target: width * height * samples; 0 where surefill_validate says NULL_TARGET, TARGET_SIZE
 * or TARGET_SAMPLES, and only there. */
SUREFILL_API size_t surefill_sample_total(const surefill_target* target);

/* The offset of sample n of a pixel from its top left corner, in 1/16 pixel [S4]. 0 <= n < samples, else that of
 * sample 0. x or y may be NULL. */
SUREFILL_API void surefill_sample_location(int32_t samples, int32_t n, int32_t* x, int32_t* y);

/* Checks the arguments of surefill_render as it does, and draws nothing. Errors: all of TARGET_*, DRAWS, DRAW_*,
 * NULL_TARGET, *_STRUCT_SIZE, OUT_OF_MEMORY. */
SUREFILL_API surefill_status surefill_validate(const surefill_target* target, const surefill_draw* draws,
                                               size_t draw_count);

/* Draws a frame: the draws in order, each onto the image of those before it [V3]. options and statistics may be NULL.
 * Errors: those of surefill_validate, OPTIONS_*, BAD_BUILD. */
SUREFILL_API surefill_status surefill_render(const surefill_target* target, const surefill_draw* draws,
                                             size_t draw_count, const surefill_options* options,
                                             surefill_statistics* statistics);

/* Streams coverage instead of storing an image: for each sample number, draw and triangle, the blocks with samples that
 * the triangle covers, as the count has them [M2]. The target gives size, samples, origin and sample locations, and asks
 * for no output. Within a tile of 64 x 64 pixels the triangles of a sample number come in order and one at a time; with
 * several threads, those of other tiles come at once. Errors: those of surefill_render, TARGET_OUTPUTS, VISITOR. */
SUREFILL_API surefill_status surefill_visit_coverage(const surefill_target* target, const surefill_draw* draws,
                                                     size_t draw_count, surefill_visitor visitor, void* context,
                                                     const surefill_options* options, surefill_statistics* statistics);

/* Makes an occlusion buffer of width x height pixels, empty, into *occlusion. depth_test: LESS or GREATER. Errors:
 * NULL_OCCLUSION, TARGET_SIZE, TARGET_DEPTH_TEST, OUT_OF_MEMORY, BAD_BUILD. */
SUREFILL_API surefill_status surefill_occlusion_create(int32_t width, int32_t height, uint32_t depth_test,
                                                       surefill_occlusion** occlusion);

/* Frees it. NULL is allowed. */
SUREFILL_API void surefill_occlusion_destroy(surefill_occlusion* occlusion);

/* Forgets the occluders: every box that reaches a sample is visible. NULL is allowed. */
SUREFILL_API void surefill_occlusion_clear(surefill_occlusion* occlusion);

/* Draws occluders onto those before. Each call goes over the whole buffer once, so give many draws to one call. Errors:
 * NULL_OCCLUSION and those of surefill_render; after OUT_OF_MEMORY the buffer is clear. No other call may use the same
 * buffer meanwhile. */
SUREFILL_API surefill_status surefill_occlusion_draw(surefill_occlusion* occlusion, const surefill_draw* draws,
                                                     size_t draw_count, const surefill_options* options,
                                                     surefill_statistics* statistics);

/* answers[i] becomes the surefill_answer for the i-th of `count` boxes. Never "hidden" for what would change a sample
 * of an image of this size [T6]. Errors: NULL_OCCLUSION, QUERY_BOXES, QUERY_ANSWERS, TARGET_OVERLAP. Any number of
 * queries may run at once. */
SUREFILL_API surefill_status surefill_occlusion_query_boxes(const surefill_occlusion* occlusion,
                                                            const surefill_box* boxes, size_t count, uint8_t* answers);

/* The same for screen rectangles with a nearest depth. */
SUREFILL_API surefill_status surefill_occlusion_query_rectangles(const surefill_occlusion* occlusion,
                                                                 const surefill_rectangle* rectangles, size_t count,
                                                                 uint8_t* answers);

/* The stored depth of pixel (x, y) at [y * width + x]; NULL for NULL. Valid until the buffer is destroyed. */
SUREFILL_API const float* surefill_occlusion_depth(const surefill_occlusion* occlusion);

/* Whether equal depth hides [O6]: 0, as at first, it does; else a box is hidden only if its nearest depth is farther than all
 * of the stored depths, and so no occluder alone hides a box that holds it, though its face be parallel to the screen.
 * Who draws only what is not hidden wants that of objects that are occluders, too. NULL is allowed. */
SUREFILL_API void surefill_occlusion_set_equal_is_visible(surefill_occlusion* occlusion, int32_t value);

/* Prepares triangles into *mesh: vertex v is three floats at positions + v * position_stride bytes (at least 12, a multiple
 * of 4; 0 means 12), in any space of the model; triangle t has the vertices indices[3t], indices[3t + 1], indices[3t + 2].
 * Only the equality of positions matters; a T-junction hides nothing along it. Nothing of the arguments is kept. Errors:
 * OCCLUDER_MESH, OCCLUDER_POSITIONS, DRAW_INDICES, DRAW_INDEX_OUT_OF_RANGE, OUT_OF_MEMORY, BAD_BUILD. */
SUREFILL_API surefill_status surefill_occluder_mesh_create(const float* positions, size_t vertex_count,
                                                           size_t position_stride, const uint32_t* indices,
                                                           size_t index_count, surefill_occluder_mesh** mesh);

/* Frees it, while no call uses it. NULL is allowed. */
SUREFILL_API void surefill_occluder_mesh_destroy(surefill_occluder_mesh* mesh);

/* As surefill_occlusion_create. Make it a power of two smaller than the picture: what a safe buffer calls hidden changes no
 * sample of any larger picture of the same view [T7]. */
SUREFILL_API surefill_status surefill_safe_occlusion_create(int32_t width, int32_t height, uint32_t depth_test,
                                                            surefill_safe_occlusion** occlusion);

/* Frees it. NULL is allowed. */
SUREFILL_API void surefill_safe_occlusion_destroy(surefill_safe_occlusion* occlusion);

/* Forgets the occluders: every box that reaches the target is visible. NULL is allowed. */
SUREFILL_API void surefill_safe_occlusion_clear(surefill_safe_occlusion* occlusion);

/* Draws occluders onto those before: meshes[i] with the vertices of draws[i], projected, one for each that was prepared. Those
 * at one place have the same x, y, w. Fill rule, front face, culling and depth mode are as the picture's; a culling box is
 * ignored; indices, identifiers, attributes, covered, visible, scissor, grid, bias, conservative modes, depth write off, lines
 * and points are refused by their statuses. Other errors: NULL_OCCLUSION, OCCLUDER_MESH, OCCLUDER_VERTICES, and as
 * surefill_render's; after OUT_OF_MEMORY the buffer is clear. Of the options threads and executor count. No other call may
 * use the same buffer meanwhile. */
SUREFILL_API surefill_status surefill_safe_occlusion_draw(surefill_safe_occlusion* occlusion,
                                                          const surefill_occluder_mesh* const* meshes,
                                                          const surefill_draw* draws, size_t draw_count,
                                                          const surefill_options* options);

/* As surefill_occlusion_query_boxes, but a box is of every larger picture [O5]: never "hidden" for what would change a sample
 * of one. */
SUREFILL_API surefill_status surefill_safe_occlusion_query_boxes(const surefill_safe_occlusion* occlusion,
                                                                 const surefill_box* boxes, size_t count,
                                                                 uint8_t* answers);

/* The same for screen rectangles with a nearest depth. */
SUREFILL_API surefill_status surefill_safe_occlusion_query_rectangles(const surefill_safe_occlusion* occlusion,
                                                                      const surefill_rectangle* rectangles,
                                                                      size_t count, uint8_t* answers);

/* The depth z of pixel (x, y) [O4] at [y * width + x]; NULL for NULL. Valid until the buffer is destroyed. */
SUREFILL_API const float* surefill_safe_occlusion_depth(const surefill_safe_occlusion* occlusion);

/* As surefill_occlusion_set_equal_is_visible. */
SUREFILL_API void surefill_safe_occlusion_set_equal_is_visible(surefill_safe_occlusion* occlusion, int32_t value);

#ifdef __cplusplus
}
#endif

#endif /* SUREFILL_SUREFILL_H */
