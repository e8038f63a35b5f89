// SPDX-License-Identifier: Apache-2.0
//
// Hard cases on purpose: deterministic functions of a seed, so that a case is named by (generator, seed) for ever.
#ifndef SUREFILL_PROPERTIES_GENERATORS_HPP
#define SUREFILL_PROPERTIES_GENERATORS_HPP

#include <cstdint>
#include <span>

#include "corpus/scene.hpp"

namespace surefill::properties {

// A small fast generator of random numbers (SplitMix64), the same sequence everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  std::uint32_t below(std::uint32_t n);  // 0 .. n - 1; n > 0
  int between(int first, int last);      // first .. last, both included
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  double unit();  // [0, 1), 53 bits

 private:
  std::uint64_t state_;
};

// What a generated triangle aims at.
struct Category {
  const char*
      name;  // "vertex-on-sample", "near-collinear", "one-ulp-off", "sliver", "huge", "subnormal", "w-negative", ...
  const char* aims;  // one sentence
  // Vertices of one triangle for a target of this size.
  std::array<Vertex, 3> (*triangle)(Random& random, int width, int height);
};

// All categories; certify reports each by name.
std::span<const Category> categories();

// What a generated scene may use beyond geometry.
struct SceneLimits {
  int max_size = 16;  // of the target, each way
  int max_triangles = 4;
  bool state = true;  // culling, depth modes, scissor, fill rules, several draws, identifiers, initial depth
  bool attributes = true;
  bool samples = false;  // multisampling
  bool grid = false;
  bool conservative = false;
};

// A scene of triangles of this category (others mixed in where a scene has several).
corpus::Scene random_scene(const Category& category, std::uint64_t seed, const SceneLimits& limits = {});
// The same, in every mode as the seed has it: several samples a pixel, Grid, conservative frames.
corpus::Scene mixed_scene(const Category& category, std::uint64_t seed, int max_size, int max_triangles);

// The same with an origin, sample places, layers, outputs and the modes that go with them (S6, S7, M4a to M4c, M9, M10,
// V4, V5, I8, C5): each pair of them meets.
corpus::Scene modes_scene(const Category& category, std::uint64_t seed, int max_size, int max_triangles);

// What a generated line aims at; a point is its first end.
struct LineCategory {
  const char* name;  // "line-diagonal", "line-one-behind", ...
  const char* aims;  // one sentence
  // The two ends for a target of this size.
  std::array<Vertex, 2> (*line)(Random& random, int width, int height);
};
std::span<const LineCategory> line_categories();

// A scene of lines and points of this category, others mixed in, with every mode that they may have (M7): widths, samples
// and their places, layers, origin, depth tests, attributes. `category` is one of line_categories().
corpus::Scene lines_scene(const LineCategory& category, std::uint64_t seed, int max_size, int max_primitives);

// Attributes of triangles all over each other, several to a row of pixels: arrays of every size, values of every
// amount. Some are thin ones along rows, far from the screen's origin, with W of all sizes: edges have errors, each its
// own.
corpus::Scene attribute_scene(Random& random);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_GENERATORS_HPP
