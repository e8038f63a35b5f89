// SPDX-License-Identifier: Apache-2.0
//
// Images for people: what was drawn, as colours, as a PNG file.
#ifndef SUREFILL_CERTIFY_PICTURE_HPP
#define SUREFILL_CERTIFY_PICTURE_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::certify {

enum class Show { depth, index, barycentrics, normals, count, wireframe };

// In a scene made for Show::wireframe, the indices from which on they are those of edges.
inline constexpr std::uint32_t kFirstEdge = 0x80000000u;

// The scene with the edges of its triangles as thin lines; the triangles hide what is behind them. They are moved back by their
// slope, a pixel: a line's depth is that of a place of the edge at most half a pixel away (I7).
corpus::Scene with_edges(corpus::Scene scene);

std::optional<Show> show_by_name(const std::string& name);

// The outputs that a picture needs.
corpus::Outputs outputs_for(Show show);

// 3 bytes a pixel (sRGB), rows from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// Depth: near is bright, over the range of finite depths seen. Index: a colour for each triangle. Barycentrics: (b0,
// b1, b2) as (r, g, b). Normals: the first attribute, [-1, 1] as [0, 255]. Count: blue for 1 to white for the largest.
// What is empty has the colour of the background. Samples of a pixel are averaged.
Picture picture_of(const corpus::Image& image, Show show);

// A PNG of the picture, whole or not at all. Throws FileError.
void write_png(const Picture& picture, const std::string& path);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_PICTURE_HPP
