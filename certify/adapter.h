/* SPDX-License-Identifier: Apache-2.0
 *
 * The adapter: how a rasterizer is put under test by `surefill certify`. Plain C99; nothing to link against.
 *
 * A rasterizer is tested through a shared library that exports `surefill_adapter_entry` (certify --plugin FILE.so), or
 * through a program that speaks the same words over stdin and stdout (certify --command "PROGRAM ARGS";
 * docs/adapters.md). Either runs in a process of its own, so whatever it does wrong is a finding and not an accident.
 *
 * Space      Pixels: x to the right, y down, pixel (i, j) is [i, i+1) x [j, j+1) (S1). Each vertex comes in two forms:
 *            pixel-homogeneous (X, Y, Z, W), which projects to pixel (X/W, Y/W) and depth Z/W where W > 0 (S2), and
 *            clip space (x, y, z, w) with a viewport (S3). Read the one that suits; say which in `info.form`.
 * Buffers    All belong to the caller and live during the call. Sample n of pixel (x, y) is element
 *            (y * width + x) * samples + n. A null pointer is an output that is not asked for. Every buffer asked for
 *            is written whole; what no triangle covers holds count 0, index SUREFILL_ADAPTER_EMPTY, depth +infinity
 *            (-infinity for the test GREATER), or the initial depth where there is one, and 0 elsewhere (V1).
 *            An array without elements may be null. Frames without draws and draws without triangles come, too.
 * Rules      docs/semantics.md; the letters in brackets are its rules.
 * Threads    Calls on one instance never overlap. Different instances may be used at once.
 * Versions   The layout below is version 1 and never changes; what is added gets another version.
 */
#ifndef SUREFILL_ADAPTER_H
#define SUREFILL_ADAPTER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SUREFILL_ADAPTER_VERSION 1u
#define SUREFILL_ADAPTER_EMPTY 0xFFFFFFFFu /* the index of a sample that no triangle covers */

/* Outputs, as bits. A rasterizer has at least one of COUNT, INDEX, DEPTH.
 * certify makes up what is missing where it can: a count from drawing each triangle alone. */
enum {
  SUREFILL_ADAPTER_COUNT = 1 << 0,        /* triangles that cover the sample, whatever their depth (M2) */
  SUREFILL_ADAPTER_INDEX = 1 << 1,        /* identifier of the visible triangle (V1) */
  SUREFILL_ADAPTER_DEPTH = 1 << 2,        /* its depth Z/W (I1) */
  SUREFILL_ADAPTER_BARYCENTRICS = 1 << 3, /* its perspective-correct weights of vertices 0, 1, 2 (I3) */
  SUREFILL_ADAPTER_ATTRIBUTES = 1 << 4    /* its interpolated attributes (I2) */
};

/* What it can draw beyond the plain scene, as bits.
 * The plain scene is one draw of triangles with W > 0, one sample a pixel, depth test LESS, no culling, no depth clipping,
 * perspective attributes, and the fill rule and the grid of the model.
 * Scenes that need more than the rasterizer has are not given to it, and are reported as skipped. */
enum {
  SUREFILL_ADAPTER_BEHIND = 1 << 0,          /* vertices with W <= 0 */
  SUREFILL_ADAPTER_DRAWS = 1 << 1,           /* several draws onto one image (V3) */
  SUREFILL_ADAPTER_SAMPLES = 1 << 2,         /* 2, 4, 8 and 16 samples a pixel at the standard places (S4), or those
                                                that are not declined */
  SUREFILL_ADAPTER_CULL = 1 << 3,            /* `cull` and `front_face` (F1, F2) */
  SUREFILL_ADAPTER_SCISSOR = 1 << 4,         /* `scissor` (M3) */
  SUREFILL_ADAPTER_DEPTH_CLIP = 1 << 5,      /* depth_mode clip (I5) */
  SUREFILL_ADAPTER_DEPTH_CLAMP = 1 << 6,     /* depth_mode clamp (I5) */
  SUREFILL_ADAPTER_DEPTH_GREATER = 1 << 7,   /* depth_test greater (V1) */
  SUREFILL_ADAPTER_DEPTH_READ_ONLY = 1 << 8, /* depth_write 0: the last that passes is visible, depth stays (M5) */
  SUREFILL_ADAPTER_INITIAL_DEPTH = 1 << 9,   /* `initial_depth` (V1) */
  SUREFILL_ADAPTER_IDENTIFIERS = 1 << 10,    /* identifiers in any order, each once in a draw: of its equal depths the
                                                smaller identifier is visible (V2) */
  SUREFILL_ADAPTER_NOPERSPECTIVE = 1 << 11,  /* attributes that are affine on the screen (I2) */
  SUREFILL_ADAPTER_FLAT = 1 << 12,           /* attributes of vertex 0 (I2) */
  SUREFILL_ADAPTER_CENTROID = 1 << 13,       /* attribute_location centroid (M1) */
  SUREFILL_ADAPTER_OVER = 1 << 14,           /* conservative, over (M4) */
  SUREFILL_ADAPTER_INNER = 1 << 15,          /* conservative, inner (M4) */
  SUREFILL_ADAPTER_FILL_RULES = 1 << 16,     /* takes the fill rule from each draw; else the model's is used (C3) */
  SUREFILL_ADAPTER_GRIDS = 1 << 17,          /* takes the grid from each draw; else the model's is used (section 6) */
  SUREFILL_ADAPTER_NON_FINITE = 1 << 18      /* drops triangles with a NaN or an infinity in a vertex or in any
                                                attribute, asked for or not (B1) */
};

enum { SUREFILL_ADAPTER_FORM_PIXEL = 0, SUREFILL_ADAPTER_FORM_CLIP = 1 };

/* Where samples and vertices are: what is claimed of coverage.
 * UNKNOWN: certify finds out by probing. */
enum {
  SUREFILL_ADAPTER_MODEL_UNKNOWN = 0,
  SUREFILL_ADAPTER_MODEL_EXACT = 1, /* no snapping (section 2) */
  SUREFILL_ADAPTER_MODEL_GRID = 2   /* vertices snapped to the grid below (section 6) */
};

enum { SUREFILL_ADAPTER_NEAREST_EVEN = 0, SUREFILL_ADAPTER_NEAREST_UP = 1, SUREFILL_ADAPTER_TRUNCATE = 2 };

/* The fill rules of C3: which way a sample on an edge is moved, x first in the first four, y first in the others. */
enum {
  SUREFILL_ADAPTER_TOP_LEFT = 0,
  SUREFILL_ADAPTER_TOP_RIGHT = 1,
  SUREFILL_ADAPTER_BOTTOM_LEFT = 2,
  SUREFILL_ADAPTER_BOTTOM_RIGHT = 3,
  SUREFILL_ADAPTER_SOUTHWARDS = 4,
  SUREFILL_ADAPTER_SOUTHWARDS_WEST = 5,
  SUREFILL_ADAPTER_NORTHWARDS = 6,
  SUREFILL_ADAPTER_NORTHWARDS_WEST = 7
};

/* How precise depth and attributes are meant to be.
 * EXACT, which a zeroed struct says: rounded once (I4), compared with ==.
 * The others grant the errors of their standard; the largest one seen is reported. */
enum {
  SUREFILL_ADAPTER_PROFILE_EXACT = 0,
  SUREFILL_ADAPTER_PROFILE_D3D11 = 1,
  SUREFILL_ADAPTER_PROFILE_VULKAN = 2,
  SUREFILL_ADAPTER_PROFILE_OPENGL = 3
};

/* Rows of the image and clip space.
 * UP: row 0 of the images it returns is the bottom one, and certify turns them round. */
enum { SUREFILL_ADAPTER_Y_DOWN = 0, SUREFILL_ADAPTER_Y_UP = 1, SUREFILL_ADAPTER_Y_UNKNOWN = 2 };

/* Clip space depth that becomes depth 0 to 1: of an adapter of form CLIP. Its viewports have this range. */
enum {
  SUREFILL_ADAPTER_ZERO_TO_ONE = 0,
  SUREFILL_ADAPTER_MINUS_ONE_TO_ONE = 1,
  SUREFILL_ADAPTER_DEPTH_RANGE_UNKNOWN = 2
};

typedef struct surefill_adapter_model {
  uint32_t kind;
  uint32_t grid_bits;     /* 0..12. Of a model UNKNOWN: the bits of subpixel precision that it reports, 0: none */
  uint32_t grid_rounding; /* SUREFILL_ADAPTER_NEAREST_EVEN, ... */
  uint32_t grid_offset_x; /* 0..15, in 2^-(bits + 4) pixels */
  uint32_t grid_offset_y;
  uint32_t fill_rule; /* of draws, where FILL_RULES is not among the features */
  uint32_t profile;
  uint32_t y;
  uint32_t depth_range;
} surefill_adapter_model;

/* Filled in by open. Strings are UTF-8, end with a 0 and are cut where they do not fit. A limit of 0 is none. */
typedef struct surefill_adapter_info {
  char name[64];
  char version[64];
  uint32_t outputs;
  uint32_t features;
  uint32_t form;
  surefill_adapter_model model;
  uint32_t max_width, max_height; /* pixels */
  uint32_t max_vertices;          /* of a draw */
  uint32_t max_triangles;         /* of a draw */
  uint32_t max_attributes;        /* arrays of a draw */
  uint32_t max_components;        /* of an attribute; never above 4 */
} surefill_adapter_info;

enum { SUREFILL_ADAPTER_PERSPECTIVE = 0, SUREFILL_ADAPTER_AFFINE = 1, SUREFILL_ADAPTER_CONSTANT = 2 };

typedef struct surefill_adapter_attribute {
  const float* values;    /* components floats a vertex */
  uint32_t components;    /* 1..4 */
  uint32_t interpolation; /* perspective, noperspective (AFFINE) or flat (CONSTANT); draws may differ */
} surefill_adapter_attribute;

enum { SUREFILL_ADAPTER_CLOCKWISE = 0, SUREFILL_ADAPTER_COUNTER_CLOCKWISE = 1 }; /* of front faces: F1 */
enum { SUREFILL_ADAPTER_CULL_NONE = 0, SUREFILL_ADAPTER_CULL_FRONT = 1, SUREFILL_ADAPTER_CULL_BACK = 2 };
enum { SUREFILL_ADAPTER_LESS = 0, SUREFILL_ADAPTER_GREATER = 1 };
enum { SUREFILL_ADAPTER_ANY_DEPTH = 0, SUREFILL_ADAPTER_CLIP_DEPTH = 1, SUREFILL_ADAPTER_CLAMP_DEPTH = 2 };
enum { SUREFILL_ADAPTER_AT_CENTRE = 0, SUREFILL_ADAPTER_AT_CENTROID = 1 };
enum {
  SUREFILL_ADAPTER_NOT_CONSERVATIVE = 0,
  SUREFILL_ADAPTER_CONSERVATIVE_OVER = 1,
  SUREFILL_ADAPTER_CONSERVATIVE_INNER = 2
};

/* Triangle t has the vertices indices[3 t], [3 t + 1], [3 t + 2], all below vertex_count, and the identifier
 * identifiers[t], which is what the index image shows. */
typedef struct surefill_adapter_draw {
  uint32_t vertex_count;
  uint32_t triangle_count;
  const float* pixel; /* 4 floats a vertex: X, Y, Z, W */
  const float* clip;  /* 4 floats a vertex: x, y, z, w, which the viewport maps to the pixel form */
  const uint32_t* indices;
  const uint32_t* identifiers;
  const surefill_adapter_attribute* attributes; /* scene.attribute_count of them */
  uint32_t clip_is_exact; /* 1: S3 maps `clip` to `pixel` bit for bit. 0: some vertex has no such clip form, and
                             who says FORM_CLIP is not given the scene */
  float viewport_x, viewport_y, viewport_width, viewport_height, viewport_near, viewport_far; /* clip y is up */
  uint32_t viewport_depth_range; /* SUREFILL_ADAPTER_ZERO_TO_ONE or MINUS_ONE_TO_ONE */
  uint32_t fill_rule;
  uint32_t front_face;
  uint32_t cull;
  uint32_t depth_mode;
  uint32_t depth_write; /* 0 or 1 */
  uint32_t conservative;
  uint32_t has_scissor;
  int32_t scissor[4]; /* x0, y0, x1, y1: half-open, in pixels from the top left */
  uint32_t has_grid;
  uint32_t grid_bits, grid_rounding, grid_offset_x, grid_offset_y;
} surefill_adapter_draw;

typedef struct surefill_adapter_scene {
  uint32_t width, height, samples;
  uint32_t depth_test;
  uint32_t attribute_location;
  uint32_t attribute_count;
  uint32_t draw_count;
  const surefill_adapter_draw* draws;
  const float* initial_depth; /* null, or one a sample */
} surefill_adapter_scene;

/* The places for the answer; null where not asked for.
 * attributes[k] takes draws[0].attributes[k].components floats a sample; the array itself is null, or has attribute_count
 * elements. */
typedef struct surefill_adapter_image {
  uint32_t* count;
  uint32_t* index;
  float* depth;
  float* barycentrics; /* 3 a sample */
  float* const* attributes;
} surefill_adapter_image;

/* What open and draw return.
 * UNSUPPORTED: this scene needs what the rasterizer lacks; it is skipped and not judged.
 * FAILED: it should have drawn it and could not, which is a finding; error_text says why. */
enum { SUREFILL_ADAPTER_OK = 0, SUREFILL_ADAPTER_UNSUPPORTED = 1, SUREFILL_ADAPTER_FAILED = 2 };

typedef struct surefill_adapter_api {
  uint32_t version; /* SUREFILL_ADAPTER_VERSION */
  /* Makes an instance and describes it. `info` comes zeroed. `arguments` is what follows --plugin-arguments, or "". */
  int (*open)(const char* arguments, surefill_adapter_info* info, void** instance);
  int (*draw)(void* instance, const surefill_adapter_scene* scene, const surefill_adapter_image* image);
  void (*close)(void* instance);
  /* One line on the last call that did not return OK; never null. `instance` is null after an open that failed. */
  const char* (*error_text)(void* instance);
} surefill_adapter_api;

/* The one symbol that a plugin exports. Returns null for versions that it does not know. */
const surefill_adapter_api* surefill_adapter_entry(uint32_t version);

#ifdef __cplusplus
}
#endif

#endif /* SUREFILL_ADAPTER_H */
