// SPDX-License-Identifier: Apache-2.0
//
// Occlusion culling: draw what hides, then ask of boxes whether anything in them could be seen.
//
// The answer is conservative and never wrong: where it is not `visible`, drawing what is in the box would change no
// sample of this image [T6]. It is also exact: docs/semantics.md, section 9, says for each box what the answer is [O3].
// It holds for images of the buffer's size with one sample a pixel, so draw the occluders at the size of the picture.
//
// Cost       One depth buffer and, per block of 8 x 8, 64 x 64, ... pixels, its farthest depth; a query looks at a few
//            blocks and at the pixels along the rectangle's rim.
// Errors     As everywhere: nothing throws; a Status names the argument at fault, and then nothing was written.
// Threads    Any number may query one buffer at once, while none changes it.
#ifndef SUREFILL_OCCLUSION_HPP
#define SUREFILL_OCCLUSION_HPP

#include "surefill/surefill.hpp"

namespace surefill {

// Pixel-homogeneous corners, in any order; the box is their hull [O2]. Any sign of W; all numbers finite.
struct OcclusionBox {
  Vertex corners[8];
};

// A closed rectangle in pixels, [x0, x1] x [y0, y1], and the nearest depth of what is in it [O2]. No NaN. Empty if
// x0 > x1 or y0 > y1.
struct OcclusionRectangle {
  float x0, y0, x1, y1;
  float nearest_depth;
};

// The answer to a query [O3].
enum class Occlusion : std::uint8_t {
  outside,  // reaches no sample of the target
  hidden,   // would change no sample
  visible,  // may be seen
};

// The depth of the occluders, and what is asked of it.
class SUREFILL_API OcclusionBuffer {
 public:
  OcclusionBuffer() noexcept = default;  // of 0 x 0 pixels: every box is outside
  ~OcclusionBuffer();
  OcclusionBuffer(OcclusionBuffer&& other) noexcept;             // leaves 0 x 0 pixels behind
  OcclusionBuffer& operator=(OcclusionBuffer&& other) noexcept;  // swaps

  // Gives the buffer a size in pixels [S5] and the sense of depth, less or greater, and clears it. target_size, target_depth_test or
  // out_of_memory: the buffer is as it was. Memory: 4.1 bytes a pixel.
  Status resize(int width, int height, DepthTest depth_test = DepthTest::less) noexcept;

  // Forgets the occluders: every box that reaches a sample is visible.
  void clear() noexcept;

  // Draws occluders onto those before [V3]; the arguments are render's, and so are its errors. Each call goes over the
  // whole buffer once, so give many draws to one call. After out_of_memory the buffer is clear.
  Status draw(std::span<const Draw> occluders, Statistics* statistics = nullptr, const Options& options = {}) noexcept;

  // answers[i] is the answer for the i-th box. query_boxes: null but not empty, or a number that is not finite (in a
  // rectangle: a NaN). query_answers: not one for each box. target_overlap: answers overlap the boxes, or depth().
  // Allocates nothing.
  Status query(std::span<const OcclusionBox> boxes, std::span<Occlusion> answers) const noexcept;
  // The same for screen rectangles.
  Status query(std::span<const OcclusionRectangle> rectangles, std::span<Occlusion> answers) const noexcept;

  int width() const noexcept;   // pixels
  int height() const noexcept;  // pixels

  // The stored depth of pixel (x, y) at [y * width + x]; +inf (-inf for greater) where nothing hides. Valid until the
  // next resize.
  std::span<const float> depth() const noexcept;

 private:
  struct State;
  State* state_ = nullptr;
};

}  // namespace surefill

#endif  // SUREFILL_OCCLUSION_HPP
