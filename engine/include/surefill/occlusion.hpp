// SPDX-License-Identifier: Apache-2.0
//
// Occlusion culling: draw what hides, then ask of boxes whether anything in them could be seen. Two buffers:
//
// SafeOcclusionBuffer is small, and right about every larger picture of the same view: what it calls hidden changes no
//            sample of any of them, whatever their size, samples and sample places [T7]. Make it a power of two smaller
//            than the picture: for 1920 x 1080, 480 x 270, or 240 x 135.
// OcclusionBuffer is right about the image of its own size with one sample a pixel [T6], hides a little more, and costs
//            what drawing the picture's depth costs.
//
// Both are never wrong, and exact: docs/semantics.md, section 9, says for each box what the answer is [O3, O5].
//
// The trap: an object that is an occluder, too, is hidden by its own face where that face is parallel to the screen, or
//            seen edge-on, as then nothing of it is nearer than its own depth. Who draws only what is not hidden loses it.
//            With equal_is_visible(true) equal depths hide nothing, and no occluder alone hides a box that holds it [O6];
//            else draw the occluders themselves without asking.
//
// Cost       A depth buffer and, per block of 8 x 8, 64 x 64, ... pixels, its farthest depth; a query looks at a few
//            blocks and at the pixels along the rectangle's rim.
// Errors     As everywhere: nothing throws; a Status names the argument at fault, and then nothing was written.
// Threads    Any number may query one buffer at once, while none changes it; and draw one mesh.
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
  outside,  // reaches no sample of the target; of a safe buffer: not even its area
  hidden,   // would change no sample
  visible,  // may be seen
};

// The depth of the occluders in one image, and what is asked of it.
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

  // Whether equal depth hides [O6]: if true, a box is hidden only if its nearest depth is farther than all of the stored
  // depths. False at first; resize and clear leave it as it is.
  void equal_is_visible(bool value) noexcept { equal_is_visible_ = value; }
  bool equal_is_visible() const noexcept { return equal_is_visible_; }  // whether it is so

  int width() const noexcept;   // pixels
  int height() const noexcept;  // pixels

  // The stored depth of pixel (x, y) at [y * width + x]; +inf (-inf for greater) where nothing hides. Valid until the
  // next resize.
  std::span<const float> depth() const noexcept;

 private:
  struct State;
  State* state_ = nullptr;
  bool equal_is_visible_ = false;
};

// Triangles that hide, prepared once for all views and safe buffers: which vertices lie at one place, and which triangles
// share an edge there [O4]. A triangle that shares no edge hides little: its border is a rim, and no pixel on a rim is
// hidden by it. So give meshes as they are modelled, whole; vertices that are split (for normals, say) are found by
// their position, but a T-junction is a rim.
class SUREFILL_API OccluderMesh {
 public:
  OccluderMesh() noexcept = default;  // without triangles
  ~OccluderMesh();
  OccluderMesh(OccluderMesh&& other) noexcept;             // leaves a mesh without triangles behind
  OccluderMesh& operator=(OccluderMesh&& other) noexcept;  // swaps

  // Vertex v is at positions[v * stride] and the two floats after it; triangle t has the vertices indices[3t],
  // indices[3t + 1], indices[3t + 2]. Positions may be in any space of the model: only their equality matters (-0 equals
  // 0, a NaN equals nothing). Nothing of the arguments is kept. occluder_positions: null but not empty, a stride under 3,
  // an incomplete position at the end, or 2^32 vertices and more. draw_indices, draw_index_out_of_range, out_of_memory:
  // as in render; then the mesh is as it was. 2^29 triangles and more are refused.
  Status prepare(std::span<const float> positions, std::span<const std::uint32_t> indices,
                 std::uint32_t stride = 3) noexcept;

  std::size_t vertices() const noexcept;   // how many were prepared
  std::size_t triangles() const noexcept;  // the same

 private:
  friend class SafeOcclusionBuffer;
  struct State;
  State* state_ = nullptr;
};

// A mesh in one view. Of its state, fill rule, front face, culling and depth mode count; a culling box is ignored, and all
// else is refused [O4]. Choose them as they are when the picture is drawn.
struct Occluder : DrawState {
  const OccluderMesh* mesh = nullptr;
  // One for each of the mesh, projected. Those at one place have the same X, Y, W, as they have if all are projected by
  // one function, which is also the way to a picture without cracks; if not, the status is occluder_vertices.
  std::span<const Vertex> vertices;
};

// The depth that occluders have at least, in each pixel's whole square, at whatever resolution they are drawn.
class SUREFILL_API SafeOcclusionBuffer {
 public:
  SafeOcclusionBuffer() noexcept = default;  // of 0 x 0 pixels: every box is outside
  ~SafeOcclusionBuffer();
  SafeOcclusionBuffer(SafeOcclusionBuffer&& other) noexcept;             // leaves 0 x 0 pixels behind
  SafeOcclusionBuffer& operator=(SafeOcclusionBuffer&& other) noexcept;  // swaps

  // As OcclusionBuffer::resize.
  Status resize(int width, int height, DepthTest depth_test = DepthTest::less) noexcept;

  // Forgets the occluders: every box that reaches the target is visible.
  void clear() noexcept;

  // Draws occluders onto those before. Errors: target_size (no size yet), draws (null but not empty), occluder_mesh (null),
  // draw_vertices (null but not empty, or not one for each of the mesh), occluder_vertices, and what is refused of a state:
  // draw_primitive, draw_fill_rule (open, too), draw_front_face, draw_cull, draw_depth_mode, draw_depth_write, draw_grid,
  // draw_scissor, draw_conservative, draw_depth_bias; options_threads, options_path; target_overlap, if a list or vertices
  // lie in the buffer's memory. After out_of_memory the buffer is clear. It keeps its working memory from call to call,
  // so of the options threads, executor and path count. Each call goes over the whole buffer once, so give many occluders
  // to one call.
  Status draw(std::span<const Occluder> occluders, const Options& options = {}) noexcept;

  // As OcclusionBuffer's, but a box is of every larger picture [O5].
  Status query(std::span<const OcclusionBox> boxes, std::span<Occlusion> answers) const noexcept;
  // The same for screen rectangles.
  Status query(std::span<const OcclusionRectangle> rectangles, std::span<Occlusion> answers) const noexcept;

  // As OcclusionBuffer's [O6].
  void equal_is_visible(bool value) noexcept { equal_is_visible_ = value; }
  bool equal_is_visible() const noexcept { return equal_is_visible_; }  // whether it is so

  int width() const noexcept;   // pixels
  int height() const noexcept;  // pixels

  // The depth z of pixel (x, y) at [y * width + x] [O4]; +inf (-inf for greater) where nothing hides. Valid until the
  // next resize.
  std::span<const float> depth() const noexcept;

 private:
  struct State;
  State* state_ = nullptr;
  bool equal_is_visible_ = false;
};

}  // namespace surefill

#endif  // SUREFILL_OCCLUSION_HPP
