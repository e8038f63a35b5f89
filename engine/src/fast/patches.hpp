// SPDX-License-Identifier: Apache-2.0
//
// What a safe occlusion buffer draws: patches, which are O4's occluders, and how they come to the vector code.
#ifndef SUREFILL_SRC_FAST_PATCHES_HPP
#define SUREFILL_SRC_FAST_PATCHES_HPP

#include <cstddef>
#include <cstdint>

#include "facts.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

// A vertex as it is seen. Position and depth are those of the quotients if it lies in front of the eye.
struct SeenVertex {
  double x, y;
  float farthest;  // Z/W as a key that grows with distance, rounded up
  std::uint32_t flags;

  static constexpr std::uint32_t kFinite = 1, kInFront = 2;
  static constexpr std::uint32_t kUnitDepth = 4;  // in front, and 0 <= Z/W <= 1
};

// A mesh in this view.
struct MeshView {
  const Vertex* vertices;
  const std::uint32_t* indices;
  const SeenVertex* seen;
  DepthMode mode;
};

// Faces that inner edges link, and the rim edges that they have.
struct Patch {
  std::uint32_t view;
  std::size_t face_begin, face_end, rim_begin, rim_end;
  // The squares that it may fill: those that lie within its extent and do not touch its ends, as it meets all squares
  // around one that it fills. Nothing else of it has to be drawn.
  PixelBox box;
  float nearest;  // it gives no square a smaller key
};

struct RimEdge {
  std::uint32_t from, to;  // vertices
};

// A call.
struct PatchFrame {
  const MeshView* views;
  const Patch* patches;
  std::size_t patch_count;     // in any order, best with the nearest first
  const std::uint32_t* faces;  // triangles
  const RimEdge* rims;
  float sign;    // 1, or -1 for GREATER
  int width;     // of the buffer
  float* depth;  // the buffer: z, not keys
};

// Working memory of one thread: keys of a band of rows, -infinity between patches, and which columns a row has.
struct PatchScratch {
  float* keys;
  std::int32_t *first, *last;  // of each row: columns with keys, last included
};

// What a box asks (O2, O5): is a pixel of `pixels` farther than the key `nearest`?
struct BoxQuestion {
  PixelBox pixels;
  float nearest;
};

// Which pixels a rectangle has: those whose centre lies in it (O2), or whose half-open square meets it (O5).
enum class RectanglePixels { with_centre, met };

struct PatchKernels {
  // Draws the part of all patches that lies in rows [begin, end).
  void (*draw)(const PatchFrame& frame, int begin, int end, const PatchScratch& scratch);
  // Are so many numbers all finite?
  bool (*finite)(const float* numbers, std::size_t count);
  // The questions of so many boxes of eight finite corners, asked of a target of that size.
  void (*ask)(const Vertex* corners, std::size_t boxes, float sign, RectanglePixels which, PixelBox target,
              BoxQuestion* questions);
  // largest[i]: of scale times a block's floats, 8 x 8 from from[8 i] on; `rows` may be fewer, and so the last one's columns.
  void (*largest_of_blocks)(const float* from, std::size_t stride, int rows, int columns, float scale, float* largest);
};

// Those of this machine's instruction set.
const PatchKernels& patch_kernels();

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_PATCHES_HPP
