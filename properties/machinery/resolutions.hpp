// SPDX-License-Identifier: Apache-2.0
//
// T7 of docs/semantics.md as a check: what a safe buffer calls hidden is drawn after the occluders in larger targets that
// show the same view, and must not be seen.
#ifndef SUREFILL_PROPERTIES_RESOLUTIONS_HPP
#define SUREFILL_PROPERTIES_RESOLUTIONS_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/occlusion.hpp"

namespace surefill::properties {

// A safe buffer under test: its squares' depth, row by row, and its answers. Size, origin and depth test are the scene's.
struct SafeBuffer {
  std::vector<float> depth;
  std::function<Occlusion(const OcclusionBox& box, bool equal_is_visible)> box;
  std::function<Occlusion(const OcclusionRectangle& rectangle, bool equal_is_visible)> rectangle;
};
// Draws the occluders, a scene of occluder_scene, into one.
using SafeBufferMaker = std::function<SafeBuffer(const corpus::Scene& occluders)>;

SafeBufferMaker oracle_safe_buffer();          // oracle::safe_depth, oracle::answer
SafeBufferMaker clipped_oracle_safe_buffer();  // those of the second oracle
// SafeOcclusionBuffer, whose meshes are prepared with X, Y, W as positions; drawn with these options.
SafeBufferMaker engine_safe_buffer(const Options& options = {});

// A target that shows a buffer's view: a vertex (X, Y, Z, W) of the buffer is (a X + b W, c Y + e W, Z, W) there.
struct View {
  double a = 1, b = 0, c = 1, e = 0;  // dyadic, a few bits each; a, c > 0
  int width = 1, height = 1, samples = 1;
  Origin origin;
  std::vector<SampleLocation> locations;  // empty: the standard ones
};

// The vertex as the view has it, or nothing if float32 does not have it. What is not finite stays what it is.
std::optional<Vertex> seen_in(const View& view, const Vertex& vertex);

// Views of all kinds that T7 speaks of: the whole at a power of two, at two of them, at odd factors; tiles as large as
// 2^12 times, around places where it matters. `size` is the most that a target has each way, in pixels.
View random_view(Random& random, const corpus::Scene& occluders, std::span<const float> depth, int size);

// Triangles that lie in a box, or in a rectangle beyond its depth, which the buffer calls hidden.
struct Hidden {
  std::vector<std::array<Vertex, 3>> triangles;
  bool equal_is_visible = false;  // asked for by O6
};

// What this buffer hides: each square of finite depth at this depth, rectangles of all sizes and boxes in perspective as
// near as they may be. With `equal_is_visible`, all of it by O6.
std::vector<Hidden> hidden_things(Random& random, const corpus::Scene& occluders, const SafeBuffer& buffer,
                                  bool equal_is_visible, int things);

// What was seen in a trial.
struct Sightings {
  std::uint64_t things = 0, views = 0, samples = 0;
  std::uint64_t unfit = 0;    // views that float32 does not have exactly
  std::uint64_t covered = 0;  // samples that something hidden covers, counted in every 16th view
};

// Draws occluders and then what is hidden as the view has it, with fill rules and states from `random`. The first sample
// at which something hidden is seen, in words, with the scene; or nothing.
std::optional<std::string> sight(Random& random, const corpus::Scene& occluders, const View& view,
                                 std::span<const Hidden> hidden, const Renderer& renderer, Sightings& sightings);

// How much a trial is.
struct Effort {
  int things = 20;  // rectangles and boxes beside the squares
  int views = 16;
  int size = 96;  // of a target, in pixels each way, at most
  Renderer renderer = engine_renderer();
};

// All of it: a buffer of these occluders, what it hides, views of that. A violation of T7 in words, or nothing.
std::optional<std::string> violation(const corpus::Scene& occluders, const SafeBufferMaker& maker, std::uint64_t seed,
                                     const Effort& effort, Sightings& sightings);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_RESOLUTIONS_HPP
