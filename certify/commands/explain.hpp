// SPDX-License-Identifier: Apache-2.0
//
// surefill explain: pictures of how the techniques of the textbook (textbook) see a scene. docs/textbook.md
// walks through them.
#ifndef SUREFILL_CERTIFY_EXPLAIN_HPP
#define SUREFILL_CERTIFY_EXPLAIN_HPP

#include <array>
#include <string>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::certify {

struct ExplainOptions {
  std::string input, output, view = "traversal", strategy = "hierarchical";
  int tile = 16;
  int triangle = 0;  // the one that views of one triangle show
  bool compare = false, values = false, counts = false;
};

// The names of the views and of the traversals, for the usage.
std::vector<std::string> view_names();
std::vector<std::string> strategy_names();

// Draws what is asked for, or returns the table of counts. Throws std::runtime_error with one line.
std::string explain(const ExplainOptions& options);

// --- For the views

// The scene as its views need it: triangles in pixel space with their fill rules.
struct Explained {
  struct OneTriangle {
    std::array<Vertex, 3> vertices;
    FillRule rule;
  };
  int width = 1, height = 1, samples = 1;
  std::vector<OneTriangle> triangles;  // finite ones, D != 0
  std::size_t chosen = 0;
};

struct Panel;

// The outline of a triangle as far as it lies on the screen or near it; sides that own the samples on them are orange.
void draw_outline(const Panel& panel, const Explained::OneTriangle& triangle);

// Each gives a whole SVG file.
std::string traversal_view(const Explained& scene, const ExplainOptions& options);
std::string tile_test_view(const Explained& scene, int tile);
std::string fill_rule_view(const Explained& scene);
std::string snapping_view(const Explained& scene);
// `values`: the right value and the float one, as numbers, where they differ.
std::string interpolation_view(const Explained& scene, bool values);
std::string affine_w_view();
std::string clipping_view(const Explained& scene);
std::string painter_view(const Explained& scene);
std::string hierarchical_z_view(const Explained& scene);
std::string codec_view(const Explained& scene);
std::string line_view();
// Of a scene's lines and points; `chosen` is the one that is looked at closely.
std::string scene_line_view(const corpus::Scene& scene, const std::string& file, int chosen);

// Text: visited and covered samples, tiles tested and edge evaluations of each traversal, on triangles of several
// kinds.
std::string count_table();

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_EXPLAIN_HPP
