// SPDX-License-Identifier: Apache-2.0
//
// Surefill: an exact triangle rasterizer.
//
//     #include <surefill/surefill.hpp>
//     #include <vector>
//
//     std::vector<surefill::Vertex> vertices = {{2, 1, 0.5f, 1}, {38, 5, 0.25f, 1}, {4, 14, 0.75f, 1}};  // X, Y, Z, W
//     std::vector<std::uint32_t> indices = {0, 1, 2}, seen(40 * 16);
//     surefill::Target target{.width = 40, .height = 16};
//     target.index = seen;
//     surefill::Draw draw;
//     draw.vertices = vertices, draw.indices = indices;
//     const surefill::Status status = surefill::render(target, {&draw, 1});
//     if (status != surefill::Status::ok) std::puts(surefill::status_text(status));
//     // seen[40 * y + x] is the triangle at pixel (x, y), or kNoTriangle.
//
// Every output bit is defined by docs/semantics.md, which is installed as share/doc/surefill/semantics.md; the letters in
// brackets below (S2, C3, I4, ...) are its rules.
//
// Space      Pixels: x to the right, y down; pixel (i, j) is [i, i+1) x [j, j+1) [S1]. A vertex (X, Y, Z, W) is
//            pixel-homogeneous: where W > 0 it projects to pixel position (X/W, Y/W) and depth Z/W [S2]. Any sign of
//            W, any magnitude. There is no clipping: a triangle may reach behind the eye. `to_pixel` makes such
//            vertices from clip space [S3].
// Depth      Any real number; smaller is nearer unless DepthTest::greater is asked for. Stored as the nearest float32.
// Exactness  Coverage is decided on the given float32 values as real numbers [C4]; depth, barycentrics and attributes
//            are the real value, rounded once [I4]. The same bits on every machine, compiler and thread count,
//            whatever floating-point modes the caller has set; they and the exception flags are the caller's again
//            afterwards, and while a visitor or an executor runs [B4].
// Primitives Triangles, lines or points, one kind a draw [M7, I6, I7]. What is said of triangles below holds for lines and
//            points too, where nothing else is said.
// Limits     Targets of 1..16384 pixels each way [S5], 2^32 - 2 triangles a draw, kMaxAttributes attribute arrays of at
//            most kMaxComponents floats.
// Errors     Nothing throws, prints or aborts. A Status names the argument at fault; then nothing was written [B2].
//            A triangle with a NaN or an infinity is dropped and counted, and changes nothing else [B1].
// Threads    Calls share no state: any number may run at once on different targets. A call starts threads of its own
//            only if Options asks for them, and they end with it; or it uses the caller's.
// Memory     A call allocates what it needs and frees it, or leaves it to a Context: at most 12 bytes a sample, 32 MiB
//            and 1 MiB a thread, however many triangles there are; on the reference path, and where scalar code
//            does a part (see Path), up to 12 bytes a sample and layer more. When
//            that cannot be had, the status is out_of_memory.
#ifndef SUREFILL_SUREFILL_HPP
#define SUREFILL_SUREFILL_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "surefill/export.h"
#include "surefill/version.hpp"

namespace surefill {

enum class Status : std::uint32_t;
struct Target;
struct Draw;
struct Statistics;
struct Options;
struct Diagnostics;  // surefill/diagnostics.hpp

// Draws a frame: the draws in order, each onto the image of those before it [V3]. Nothing is written unless the status
// is ok, or out_of_memory (then the buffers asked for hold unspecified values). `statistics` may be null; what it gets
// takes a pass of its own over the triangles, on the calling thread.
SUREFILL_API Status render(const Target& target, std::span<const Draw> draws,
                           Statistics* statistics = nullptr) noexcept;
// The same with threads, working memory, a path and diagnostics as Options has them.
SUREFILL_API Status render(const Target& target, std::span<const Draw> draws, Statistics* statistics,
                           const Options& options) noexcept;

inline constexpr int kMaxTargetSize = 16384;               // pixels, each way
inline constexpr int kMaxOrigin = 1 << 22;                 // pixels, each way and sign
inline constexpr int kMaxLayers = 16;                      // of a frame [V4]
inline constexpr std::size_t kMaxAttributes = 16;          // attribute arrays of a draw
inline constexpr std::uint32_t kMaxComponents = 4;         // floats of one attribute
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;  // the index of an empty sample [V1]

// What a call returns: ok, or the first argument found to be wrong. `status_text` gives a sentence.
enum class Status : std::uint32_t {
  ok = 0,
  out_of_memory,
  target_size,                // width or height outside 1..kMaxTargetSize
  target_samples,             // samples not 1, 2, 4, 8 or 16
  target_count,               // count is neither empty nor of sample_total(target) elements
  target_index,               // index is neither empty nor of layers * sample_total(target) elements
  target_depth,               // depth: the same
  target_barycentrics,        // barycentrics: neither empty nor 3 * layers * sample_total(target) elements
  target_attributes,          // an attribute target: components outside 1..4, too many, the wrong buffer size or stride
  target_initial_depth,       // initial_depth is neither empty nor of sample_total(target) elements
  target_overlap,             // an output, statistics and answers among them, overlaps another or what the call reads:
                              // only initial_depth and depth may be the same buffer, and attribute images of one
                              // stride may lie in one another, component beside component
  target_depth_test,          // not an enumerator of DepthTest
  target_attribute_location,  // not an enumerator of AttributeLocation
  draws,                      // the list of draws is null but not empty
  draw_vertices,              // a null vertex buffer that is not empty, or more than 2^32 - 1 vertices
  draw_indices,             // a null index buffer, a size that is no multiple of 3 (lines: of 2), or more than 2^32 - 2
                            // triangles
  draw_index_out_of_range,  // an index that names no vertex
  draw_identifiers,         // neither empty nor one for each triangle, or one is kNoTriangle [B5]
  draw_first_index,         // first_index + triangles exceeds 2^32 - 1: a triangle's index reaches kNoTriangle [B5]
  draw_attributes,          // fewer arrays than the target asks for, other components, or too short an array
  draw_attribute_interpolation,  // not an enumerator of Interpolation
  draw_fill_rule,           // not an enumerator of FillRule, or closed or open with a Grid [C5], lines or points [M7]
  draw_front_face,          // not an enumerator of FrontFace
  draw_cull,                // not an enumerator of Cull
  draw_depth_mode,          // not an enumerator of DepthMode
  draw_conservative,        // not an enumerator of Conservative, or in a frame that asks for more than count and
                            // index, or with several samples, a depth mode or a Grid [M4], or
                            // lines or points
  draw_grid,                // bits outside 0..12, an offset outside 0..15, or not an enumerator of GridRounding;
                            // or with lines or points
  viewport,                 // a viewport number that is not finite
  options_threads,          // a number of threads outside 1..kMaxThreads
  options_path,             // not an enumerator of Path
  query_boxes,              // of an occlusion query: null but not empty, or a number that is not finite
  query_answers,            // null but not empty, or not one for each box
  visitor,                  // of visit_coverage: its function is null
  bad_build,                // the library was compiled with options that break exact arithmetic (docs/library.md)
  to_pixel_vertices,        // of to_pixel: vertices or out are null but not empty, of two sizes, or overlap
  target_outputs,           // of visit_coverage: the target asks for an output, or for layers
  target_origin,            // |x| or |y| above kMaxOrigin
  target_sample_locations,  // neither empty nor one for each sample, a place outside 0..15, or with a conservative draw
  target_layers,            // outside 1..kMaxLayers, or above 1 with depth write off or a conservative draw [V4]
  target_winding,           // winding is neither empty nor of sample_total(target) elements
  draw_depth_bias,          // a number that is not finite, or with lines or points [I8]
  draw_covered,             // neither empty nor one for each triangle
  draw_visible,             // visible: the same, or with a conservative draw [M10]
  draw_primitive,           // not an enumerator of Primitive
  draw_width,               // not finite, not above 0, or none for lines of a target with several samples [M7]
  draw_scissor,             // of a safe occlusion buffer: a scissor [O4]
  draw_depth_write,         // of the same: depth write off
  occluder_positions,       // null but not empty, a stride under 3, an incomplete last one, or over 2^32 - 1
  occluder_mesh,            // null
  occluder_vertices,        // two at one place of the mesh differ in X, Y or W [O4]
};

// An English sentence for a status, without a full stop; never null. For an unknown value, "unknown status".
SUREFILL_API const char* status_text(Status status) noexcept;

// A pixel-homogeneous vertex [S2]. In an array: 16 bytes a vertex, no padding.
struct Vertex {
  float x, y, z, w;
  // Equality of numbers: -0 equals 0, a NaN equals nothing.
  bool operator==(const Vertex&) const = default;
};

// A vertex in clip space, before the viewport [S3].
struct ClipVertex {
  float x, y, z, w;
};

enum class ClipDepth : std::uint8_t { zero_to_one, minus_one_to_one };  // Direct3D and Vulkan; OpenGL
enum class ClipY : std::uint8_t { up, down };                           // Direct3D and OpenGL; Vulkan

// The rectangle of the target, in pixels, and the depth range that clip space is mapped to [S3]. Any finite values.
struct Viewport {
  float x = 0, y = 0, width = 1, height = 1, near_depth = 0, far_depth = 1;
  ClipDepth clip_depth = ClipDepth::zero_to_one;
  ClipY clip_y = ClipY::up;
};

// The viewport map [S3]: each component is the exact real value, rounded once to float32 as IEEE 754 does it (nearest,
// ties to even, beyond range infinity). Equal inputs give bitwise equal outputs, so shared vertices stay shared.
// `vertices` and `out` have the same size, and `out` overlaps neither them nor the viewport; else, or if a viewport
// number is not finite, the status says so and nothing is written.
SUREFILL_API Status to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices,
                             std::span<Vertex> out) noexcept;

// What a draw consists of: of so many vertices each, 3, 2 or 1. Strips are the caller's indices. Lines and points have no
// facing: nothing culls them, and they add 0 to winding.
enum class Primitive : std::uint8_t { triangles, lines, points };

// Which side owns a sample that lies exactly on an edge [C3]: the sample is moved by an infinitely small step. The
// first four move it in x first and in y only to settle ties along a horizontal edge; the next four in y first. The
// last two move nothing: every side owns it, or none [C5], but not with a Grid.
enum class FillRule : std::uint8_t {
  top_left,         // +x, then +y: Direct3D, Vulkan
  top_right,        // -x, then +y
  bottom_left,      // +x, then -y: OpenGL with y up
  bottom_right,     // -x, then -y
  southwards,       // +y, then +x
  southwards_west,  // +y, then -x
  northwards,       // -y, then +x
  northwards_west,  // -y, then -x
  closed,           // the border is covered
  open,             // the border is not covered
};

enum class FrontFace : std::uint8_t { clockwise, counter_clockwise };  // as seen on the screen; clockwise: D > 0 [F1]
enum class Cull : std::uint8_t { none, front, back };                  // which facing is not drawn [F2]
// greater: reversed z [V1]. With the other two the later one of equal depths is seen [V5].
enum class DepthTest : std::uint8_t { less, greater, less_equal, greater_equal };
enum class DepthMode : std::uint8_t { none, clip, clamp };                     // what happens outside 0 <= z <= 1 [I5]
enum class Interpolation : std::uint8_t { perspective, noperspective, flat };  // flat: the value of vertex 0 [I2]
enum class AttributeLocation : std::uint8_t { centre, centroid };              // of a pixel with several samples [M1]
// Which pixels a triangle counts at, by its border: those it meets, those that lie in it [M4], those it shares an area
// with [M4a], those it meets though it be degenerate [M4b].
enum class Conservative : std::uint8_t { none, over, inner, overlap, touched };
enum class GridRounding : std::uint8_t { nearest_even, nearest_up, truncate };  // of a position to the grid

// Half-open pixel rectangle [x0, x1) x [y0, y1); any values, empty where x0 >= x1 or y0 >= y1 [M3].
struct Scissor {
  int x0, y0, x1, y1;
  // Equality, member by member.
  bool operator==(const Scissor&) const = default;
};

// Positions are snapped to offset + k 2^-bits pixels before coverage, as GPUs do [section 6].
struct Grid {
  int bits = 8;                    // 0..12
  int offset_x = 0, offset_y = 0;  // 0..15, in units of 2^-(bits + 4) pixels
  GridRounding rounding = GridRounding::nearest_even;
  // Equality, member by member.
  bool operator==(const Grid&) const = default;
};

// Depth is z + constant + slope m, a real number rounded once; m is the larger of |dz/dx| and |dz/dy|, a pixel [I8]. Finite.
struct DepthBias {
  float constant = 0, slope = 0;
  // Equality of numbers: -0 equals 0, a NaN equals nothing.
  bool operator==(const DepthBias&) const = default;
};

// One attribute of every vertex of a draw. The value of component c at vertex v is values[v * stride + c].
struct AttributeArray {
  std::span<const float> values;
  std::uint32_t components = 1;  // 1..kMaxComponents
  std::uint32_t stride = 0;      // floats from one vertex to the next; 0 means `components`
  Interpolation interpolation = Interpolation::perspective;
};

// How a draw is drawn; `==` compares as numbers do.
struct DrawState {
  FillRule fill_rule = FillRule::top_left;
  FrontFace front_face = FrontFace::clockwise;
  Cull cull = Cull::none;
  DepthMode depth_mode = DepthMode::none;
  bool depth_write = true;  // false: M5
  Conservative conservative = Conservative::none;
  std::optional<Scissor> scissor;
  std::optional<Grid> grid;
  std::optional<std::array<Vertex, 8>> culling_box;  // corners whose hull contains the draw: the caller's promise [M6]
  std::optional<DepthBias> depth_bias;               // no part in conservative draws
  Primitive primitive = Primitive::triangles;
  // Of lines, or the side of a point's square, in pixels: finite, above 0. Without one points have 1 pixel, and lines are
  // thin: they cover the samples whose diamond they leave [M7].
  std::optional<float> width;

  // Equality of numbers: -0 equals 0, a NaN equals nothing.
  bool operator==(const DrawState&) const = default;
  // The state alone, of whatever has it as a base: `draw.state() = other.state()` copies it.
  DrawState& state() { return *this; }
  // The same, to read.
  const DrawState& state() const { return *this; }
};

// Triangles and how they are drawn. Triangle t has the vertices indices[3t], indices[3t + 1], indices[3t + 2]; line t has
// indices[2t] and indices[2t + 1], point t has indices[t].
struct Draw : DrawState {
  std::span<const Vertex> vertices;
  std::span<const std::uint32_t> indices;
  std::span<const std::uint32_t> identifiers;  // one a triangle, unique; or empty: first_index + t [V2]
  std::uint32_t first_index = 0;
  std::span<const AttributeArray> attributes;  // array k feeds target attribute k; more arrays only take part in B1
  // Outputs [M10], one number a triangle by position, written whole; empty: not asked for.
  std::span<std::uint64_t> covered;  // at how many samples of the frame it is counted [M2]
  std::span<std::uint64_t> visible;  // at how many it is the visible one when all draws are drawn, in layer 0
};

// An attribute image. The value of component c at sample s is values[s * stride + c]; what lies between is left as it is.
struct AttributeTarget {
  std::span<float> values;  // of layers * sample_total(target) samples: components * that, with a stride at least
                            // (that - 1) * stride + components; or empty: not asked for
  std::uint32_t components = 1;
  std::uint32_t stride = 0;  // floats from one sample to the next; 0 means `components`
};

// A place within a pixel, from its top left corner, in 1/16 pixel.
struct SampleLocation {
  int x, y;
  // Equality, member by member.
  bool operator==(const SampleLocation&) const = default;
};

// The pixel of space that is a target's pixel (0, 0) [S6]. Vertices, scissors, boxes and grids are in space.
struct Origin {
  int x = 0, y = 0;
  // Equality, member by member.
  bool operator==(const Origin&) const = default;
};

// Where the image goes. An empty span is an output that is not asked for. Sample n of pixel (x, y) is element
// (y * width + x) * samples + n of every buffer; in layer l of those that have layers, it is that and l * sample_total.
// Each buffer asked for is overwritten whole; a sample without a visible
// triangle holds index kNoTriangle, depth +inf (-inf for greater) or the initial depth, barycentrics and attributes +0
// [V1].
struct Target {
  int width = 0, height = 0;                    // pixels
  int samples = 1;                              // a pixel: 1, 2, 4, 8 or 16, at the standard locations [S4]
  std::span<std::uint32_t> count;               // triangles that cover the sample [M2]
  std::span<std::uint32_t> index;               // the visible triangle [V1, V2]
  std::span<float> depth;                       // its depth [I1]
  std::span<float> barycentrics;                // its perspective-correct weights b0, b1, b2: 3 floats a sample [I3]
  std::span<const AttributeTarget> attributes;  // its attributes [I2]
  std::span<const float> initial_depth;         // a fragment must beat it strictly [V1]; may be the depth buffer itself
  DepthTest depth_test = DepthTest::less;
  AttributeLocation attribute_location = AttributeLocation::centre;
  Origin origin;                                     // at most kMaxOrigin each way
  std::span<const SampleLocation> sample_locations;  // one for each sample, 0..15; empty: the standard ones [S7]
  int layers = 1;                                    // of index, depth, barycentrics, attributes: 1..kMaxLayers [V4]
  std::span<std::int32_t> winding;                   // front-facing triangles minus back-facing ones that cover [M9]
};

// What the triangles of a call's draws were: each counts once, as the first that fits [M11]. It tells of the draws
// alone: neither the target nor the options have a part in it.
struct Statistics {
  std::uint64_t dropped = 0;     // a NaN or an infinity [B1]
  std::uint64_t degenerate = 0;  // D = 0 [C1, G1]
  std::uint64_t culled = 0;      // by facing [F2]
  std::uint64_t rasterized = 0;  // the rest, whether they cover a sample or none

  // All triangles of the call.
  std::uint64_t triangles() const { return dropped + degenerate + culled + rasterized; }
  // Equality, member by member.
  bool operator==(const Statistics&) const = default;
};

// Who draws. Both paths give the same image.
enum class Path : std::uint8_t {
  automatic,  // the fast path; for layers, winding, numbers of triangles, a bias, LEQUAL, GEQUAL, overlap, touched and the
  // index of conservative draws, and in frames with lines or points, it finds who covers, and exact scalar code does the
  // rest; the reference path where a target with an origin has a draw with a Grid, for visit_coverage of lines or points,
  // and for 2^32 - 1 triangles and more in all draws together
  reference,  // the scalar reference path, on one thread
};

inline constexpr int kMaxThreads = 256;  // of one call

// The caller's own threads. run(context, items, task, argument) calls task(argument, i) once for each i in [0, items),
// on any threads and in any order, and returns when all have returned; no task waits for another. For oneTBB there is
// surefill/tbb.hpp.
struct Executor {
  void (*run)(void* context, std::size_t items, void (*task)(void* argument, std::size_t item),
              void* argument) = nullptr;
  void* context = nullptr;
};

namespace fast {
class BorrowedMemory;
}

// Working memory that outlives calls: what one has allocated, the next ones with the same context use again, and do not
// ask the system for; that pays the more, the smaller a frame is. It holds as much as the largest call has needed and
// frees it when it ends, after all calls that use it. Several calls at a time may share one: all but one of them then
// have memory of their own.
class Context {
 public:
  SUREFILL_API Context() noexcept;
  SUREFILL_API ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  friend class fast::BorrowedMemory;
  std::atomic<void*> memory_{nullptr};
};

// How a frame is drawn. The image does not depend on it.
struct Options {
  int threads = 1;  // 1..kMaxThreads: into so many parts work is divided; if fewer can be started, fewer do the work
  Path path = Path::automatic;
  Executor executor = {};      // whose threads work if `run` is not null; else the call starts threads - 1 of its own
  Context* context = nullptr;  // where working memory comes from and stays, or null
  Diagnostics* diagnostics = nullptr;  // how the frame came about (surefill/diagnostics.hpp), or null
};

// The samples of an 8 x 8 block of pixels that a triangle covers.
struct CoverageBlock {
  std::uint32_t draw, triangle;  // positions: in the list of draws, in the draw
  int x, y;                      // the block's first pixel: multiples of 8
  int sample;                    // of each pixel
  std::uint64_t mask;            // bit 8 j + i: pixel (x + i, y + j). Not 0

  // Are all 64 samples covered?
  bool full() const { return mask == ~std::uint64_t{0}; }
};

// Receives blocks: visit(context, blocks). All blocks of one call belong to one triangle and sample.
struct CoverageVisitor {
  void (*visit)(void* context, std::span<const CoverageBlock> blocks) = nullptr;
  void* context = nullptr;
};

// The number of samples of a target: width * height * samples. 0 where the status is target_size or target_samples, and
// only there.
SUREFILL_API std::size_t sample_total(const Target& target) noexcept;

// Streams coverage instead of storing an image: `visitor` receives, for each sample number, draw and triangle, the
// blocks with samples that the triangle covers, as M2 counts them: dropped and culled triangles, scissor and depth clip
// are taken into account, the depth test is not. The target gives size and samples, and asks for no output. Within a
// tile of 64 x 64 pixels the triangles of a sample number come in order and one at a time; with several threads, those
// of other tiles come at once. The visitor returns normally. Memory: 32 MiB and 1 MiB a thread.
SUREFILL_API Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                                   Statistics* statistics = nullptr, const Options& options = {}) noexcept;

// Checks the arguments of render as render does, and draws nothing.
SUREFILL_API Status validate(const Target& target, std::span<const Draw> draws) noexcept;

// The offset of sample n of a pixel [S4]. 0 <= n < samples, else that of sample 0.
SUREFILL_API SampleLocation sample_location(int samples, int n) noexcept;

}  // namespace surefill

#endif  // SUREFILL_SUREFILL_HPP
