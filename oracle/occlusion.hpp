// SPDX-License-Identifier: Apache-2.0
//
// Occlusion (O2 to O6 of docs/semantics.md) in exact arithmetic: the depth of a safe buffer's squares, and the answers to
// queries of both buffers.
#ifndef SUREFILL_ORACLE_OCCLUSION_HPP
#define SUREFILL_ORACLE_OCCLUSION_HPP

#include <array>
#include <span>
#include <vector>

#include "surefill/occlusion.hpp"

namespace surefill::oracle {

// The positions of a draw's vertices, by which O4 tells which of them are one; none: X, Y and W are the position.
using Positions = std::span<const std::array<float, 3>>;

// O4: z(Q) of each pixel square of the target, row by row. Of the target width, height, origin and depth test (less or
// greater) are looked at. The draws are such as O4 does not refuse, and valid; there are positions for each of them, or
// none at all. May throw bad_alloc.
std::vector<float> safe_depth(const Target& target, std::span<const Draw> occluders,
                              std::span<const Positions> positions = {});

// How a query is answered.
struct OcclusionRule {
  bool safe = false;              // O5, of squares; else O3, of samples
  bool equal_is_visible = false;  // O6
};

// The answer of a buffer with this depth, row by row, to a query [O2, O3, O5, O6]. Of the target the same is looked at.
Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionBox& box, OcclusionRule rule);
Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                 OcclusionRule rule);

}  // namespace surefill::oracle

namespace surefill::oracle::clipped {

// The same by the second oracle's geometry: polygons and edges are clipped and cut into strips of pixels. Shares no code
// with the first one.
std::vector<float> safe_depth(const Target& target, std::span<const Draw> occluders,
                              std::span<const Positions> positions = {});
Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionBox& box, OcclusionRule rule);
Occlusion answer(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                 OcclusionRule rule);

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_OCCLUSION_HPP
