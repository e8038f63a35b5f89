// SPDX-License-Identifier: Apache-2.0
//
// What is asked where something is wrong: small frames, each about one thing, whose answers away from edges are the same
// under every model. What comes is measured, and said: "the scissor [x0, x1) x [y0, y1) is taken for [x0, x1 + 1) x ...".
#ifndef SUREFILL_CERTIFY_JUDGE_QUESTIONS_HPP
#define SUREFILL_CERTIFY_JUDGE_QUESTIONS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "certify/judge/naming.hpp"
#include "certify/judge/probes.hpp"

namespace surefill::judge {

// Whom to ask, and who knows.
struct Questions {
  std::function<std::optional<corpus::Image>(const corpus::Scene&)> rival;  // none where it does not draw
  std::function<std::optional<corpus::Image>(const corpus::Scene&)> right;
  Model model;        // as far as it is known: places of samples, what is culled, clipped, cleared to always
  bool slow = false;  // frames of thousands of triangles are left out
};

// What both answer to one scene, as far as it is no matter of a model: samples within a margin of an edge, and values that
// are about the right ones, are set right.
std::optional<Wrong> answer(const Questions& questions, const corpus::Scene& scene);

// The scene as a rasterizer has it whose samples are at the centre: what its model moves is moved here.
corpus::Scene moved(corpus::Scene scene, const judge::Model& model);

bool differs(const Wrong& shown);

// What the answers say.
struct Answers {
  std::vector<std::string> sentences;  // the most telling first
  // Plain triangles that are wrong and right: a few large ones in front of the eye. Where half of them and more are wrong
  // nothing else was asked; nor is anything of a model that moves positions by more than 1/16 pixel.
  std::vector<Wrong> wrong;
  std::vector<corpus::Scene> fine;
};

Answers ask(const Questions& questions, std::span<const Fault> faults);

// --- of the questions themselves

inline bool alike(float a, float b) {
  if (a == b || (a != a && b != b)) return true;
  if (!std::isfinite(a) || !std::isfinite(b)) return false;
  const double size = std::max({1.0, std::abs(double{a}), std::abs(double{b})});
  return std::abs(double{a} - b) <= 0x1p-9 * size;
}

// Of values at the corners of triangles, how those at samples come about, if not as they should; empty if nobody knows.
std::string how_values_come(const Questions& questions);

// The bits of values that are about right; empty where they have those of float32, about.
std::string about_bits(const Questions& questions);

// Each empty where all is right, or nothing is said.
std::string about_ways_of_filling(const Questions& questions);
std::string about_reach(const Questions& questions);
std::string about_perspective(const Questions& questions);
std::string about_eye(const Questions& questions);
std::string about_blocks(const Questions& questions);
std::string about_triangles_before(const Questions& questions);
std::string about_vertex_cache(const Questions& questions);
std::string about_ends_of_rows(const Questions& questions);
std::string about_strides(const Questions& questions);
std::string about_precision(const Questions& questions);
std::string about_slopes(const Questions& questions);
std::string about_pattern(const Questions& questions);
std::string about_boxes(const Questions& questions);
std::string about_many(const Questions& questions);
std::string about_index(const Questions& questions);
std::string about_indices(const Questions& questions);
std::string about_counts(const Questions& questions);
std::string about_hidden_counts(const Questions& questions);
std::string about_shared_edges(const Questions& questions);
std::string about_growth(const Questions& questions);
std::string about_snapped_edges(const Questions& questions);
std::string about_vertices(const Questions& questions);
std::string about_sizes(const Questions& questions);
std::string about_far(const Questions& questions);
std::string about_small(const Questions& questions);
std::string about_tiny(const Questions& questions);
std::string about_values_of_cut(const Questions& questions);
std::string about_arrays(const Questions& questions);
std::string about_orders(const Questions& questions);
std::string about_behind(const Questions& questions, std::span<const Fault> faults);
std::string about_not_numbers(const Questions& questions);
std::string about_scissor(const Questions& questions);
std::string about_culling(const Questions& questions);
std::string about_depth_modes(const Questions& questions);
std::string about_samples(const Questions& questions);
std::string about_nothing_seen(const Questions& questions);
std::string about_visibility(const Questions& questions);
std::string about_seen(const Questions& questions);
std::string about_depth_write(const Questions& questions);
std::string about_left_before(const Questions& questions);

// A vertex that comes to lie at (x, y), of depth z.
inline corpus::SceneVertex corner(double x, double y, double z = 0.5, double w = 1) {
  return {static_cast<float>(x * w), static_cast<float>(y * w), static_cast<float>(z * w), static_cast<float>(w), {}};
}

double eighth(Random& random, double low, double high);  // a multiple of 1/8
// Such a vertex in a rectangle, of multiples of 1/8. Y is drawn first, whoever compiles it: as the two arguments of one
// call they would be drawn in an order that is the compiler's to choose.
using Interval = std::array<double, 2>;
inline corpus::SceneVertex random_corner(Random& random, const Interval& xs, const Interval& ys, double z = 0.5,
                                         double w = 1) {
  const double y = eighth(random, ys[0], ys[1]), x = eighth(random, xs[0], xs[1]);
  return corner(x, y, z, w);
}
corpus::Scene empty_scene(int width, int height);  // with one draw
// A triangle of some size on a target.
std::array<corpus::SceneVertex, 3> plain_corners(Random& random, int width, int height);

// A triangle of its own vertices is added to the draw, turned over if its facing is never drawn.
void add_triangle(corpus::SceneDraw& draw, const std::array<corpus::SceneVertex, 3>& corners, Cull culled = Cull::none);

// Over the whole target, and a target's size beyond it.
std::array<corpus::SceneVertex, 3> over_all(int width, int height, double z = 0.5);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_QUESTIONS_HPP
