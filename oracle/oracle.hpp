// SPDX-License-Identifier: Apache-2.0
//
// The exact image, by CGAL and GMP: slow and obviously right. Shares no arithmetic with the engine; of the engine it
// uses the public types alone. Everything of docs/semantics.md is covered: every fill rule, Grid with every rounding and
// offset, sample patterns, conservative rasterization, scissor, depth modes and tests, several draws.
#ifndef SUREFILL_ORACLE_ORACLE_HPP
#define SUREFILL_ORACLE_ORACLE_HPP

#include <span>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// The oracle. Arguments as for surefill::render, and valid (surefill::validate(target, draws) == Status::ok);
// culling boxes are ignored (M6). Works on `threads` threads; the image does not depend on their number. May throw bad_alloc.
void render(const Target& target, std::span<const Draw> draws, int threads = 1);

// The viewport map (S3) by exact rationals. Arguments as for surefill::to_pixel, and valid.
void to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out);

}  // namespace surefill::oracle

namespace surefill::oracle::clipped {

// The second oracle: the same image by another route, and by other formulas. Each triangle is clipped to W > 0 exactly and
// projected, and the perturbed sample (C3) is located in the polygon; depth and attributes come from the ray through the
// sample and the triangle's plane in (X, Y, W) space. Shares no code with the first oracle. Same contract.
void render(const Target& target, std::span<const Draw> draws, int threads = 1);

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_ORACLE_HPP
