// SPDX-License-Identifier: Apache-2.0
//
// A rival's image of a scene held against the exact one under the rival's model: coverage by ==, values by == under the
// profile exact and by the error that is granted under the others.
#ifndef SUREFILL_CERTIFY_PROFILE_HPP
#define SUREFILL_CERTIFY_PROFILE_HPP

#include <memory>

#include "certify/rivals/rival.hpp"
#include "certify/run/checks.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

// What the profiles grant. The standards name a precision of positions and none of values, so this is a reading of
// them: a value may be any that its triangle has within `position` pixels of the sample each way, widened by
// kGrantedRoundings roundings of the largest of the vertices' values (for the chain of float32 operations that finds
// it).
inline constexpr int kGrantedRoundings = 64;
double granted_position(std::uint32_t profile);  // d3d11: 2^-8; vulkan, opengl: 2^-4

// Coverage is judged with zero tolerance under a model that is known. Where vertices lie behind the eye or beyond
// the guard band of section 6 and the profile is not exact, how primitives are clipped is the standard's to leave open,
// and without a model so is everything near an edge: there, samples are judged that lie 1/16 pixel and more from every
// edge (certain_only).
struct RivalJudgement {
  bool certain_only = false;
  bool values = true;
  bool coverage = true;
};

// Is any vertex behind the eye, beyond the guard band, or not a number?
bool leaves_open(std::span<const Draw> draws);

// Is what the rival snaps beyond doubt? A rasterizer does not snap the exact quotient X/W but one that it has rounded
// before, so to be held to an exact model W must be a power of two; or, under a Grid, X/W and Y/W are below 2^10 and
// lie kClearSteps grid steps and more from where the rounding to the grid turns.
inline constexpr double kClearSteps = 0x1p-4;
bool projects_clearly(std::span<const Draw> draws);

// Components and attributes other than 0 whose magnitude is outside 2^-32 .. 2^32: no standard says what becomes of
// them, so only a rasterizer of the profile exact is held to them.
bool out_of_range(std::span<const Draw> draws);

// The triangles of a scene as exact geometry.
class Tiling {
 public:
  explicit Tiling(const corpus::Scene& scene);
  ~Tiling();
  // Is everything 1/16 pixel around the point covered once, beyond doubt? Then so is the point by whoever snaps
  // neighbours alike.
  bool around(double x, double y) const;

 private:
  struct Triangles;
  std::unique_ptr<Triangles> triangles_;
};

// Draws the scene with both. Skipped, a difference, or neither; with the largest errors of values.
CaseResult compare_rival(const corpus::Scene& scene, adapters::Rival& rival, const RivalJudgement& judgement = {});

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_PROFILE_HPP
