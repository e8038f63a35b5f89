// SPDX-License-Identifier: Apache-2.0
//
// The pictures of the page of a certificate, as SVG: what a finding looks like, and where edges turn.
#ifndef SUREFILL_CERTIFY_REPORT_PICTURES_HPP
#define SUREFILL_CERTIFY_REPORT_PICTURES_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "certify/run/evidence.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

struct Point {
  double x, y;
};

// A triangle on the screen: as it was given, and where a grid moves its vertices; empty without one.
struct Outline {
  std::vector<Point> given, snapped;
};
// Of all triangles; none if the scene is no scene.
std::vector<Outline> outlines(const std::string& scene_text);

// Pixels [x0, x1) x [y0, y1).
struct View {
  int x0, y0, x1, y1;
};
// Those around the samples that differ.
View zoomed(const Evidence& evidence);

// Words at a pixel, in place of its count.
struct Label {
  int x = 0, y = 0;
  std::string text;  // empty: none
};

// The samples of a view, by how many triangles cover them, under the outlines; with rings where they differ, if `marks`.
std::string picture(const Evidence& evidence, const std::vector<std::uint32_t>& counts, const View& view,
                    const std::vector<Outline>& triangles, const std::string& caption, bool marks,
                    const Label& label = {});

// The first sample that differs, and the edge beside it, as large as it takes to tell them apart; empty where no edge
// is near.
std::string inset(const Evidence& evidence, const std::vector<Outline>& triangles);

// The table of turns as a picture; empty if the text is none.
std::string turns_picture(const std::string& turns);

// A text within HTML.
std::string escaped(const std::string& text);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_PICTURES_HPP
