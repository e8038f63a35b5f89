// SPDX-License-Identifier: Apache-2.0
//
// The exact image, by CGAL and GMP: slow and obviously right. Shares no arithmetic with the engine; of the engine it
// uses the public types alone. Sections 1 to 8 of docs/semantics.md are covered: all of a target and of a draw that
// surefill.hpp has.
#ifndef SUREFILL_ORACLE_ORACLE_HPP
#define SUREFILL_ORACLE_ORACLE_HPP

#include <cstddef>
#include <memory>
#include <span>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// The oracle. Arguments as for surefill::render, and valid, as the page has it; culling boxes are ignored (M6). Works on
// `threads` threads; the image does not depend on their number. May throw bad_alloc.
void render(const Target& target, std::span<const Draw> draws, int threads = 1);

// One primitive of a frame, sample by sample: what it would leave in an empty image of its own, without the rest of that
// image. For callers that look at few samples, such as fuzzers. Arguments as for render, and valid; no conservative
// draw. A target of several layers is looked at as if it had one. The target and the draw must outlive it. Works in round-to-nearest with subnormals (the caller's affair here).
class Probe {
 public:
  Probe(const Target& target, const Draw& draw, std::size_t triangle);
  ~Probe();
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  // Is there a fragment at sample n of the target's pixel (x, y)? [B1, C2, C3, F2, I5, M2, M3, G1]
  bool covers(int x, int y, int n);
  // Its depth as stored. Precondition: covers(x, y, n).
  float depth(int x, int y, int n);
  // Writes the pixel's barycentrics and attributes [M1] as sample `place` of the target's buffers. Precondition: covers
  // one sample of the pixel.
  void store_values(int x, int y, std::size_t place);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The viewport map (S3) by exact rationals. Arguments as for surefill::to_pixel, and valid.
void to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out);

}  // namespace surefill::oracle

namespace surefill::oracle::clipped {

// The second oracle: the same image by another route, and by other formulas. Each triangle is clipped to W > 0 exactly
// and projected, and the perturbed sample (C3) is located in the polygon; depth and attributes come from the ray
// through the sample and the triangle's plane in (X, Y, W) space. Shares no code with the first oracle. Same contract.
void render(const Target& target, std::span<const Draw> draws, int threads = 1);

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_ORACLE_HPP
