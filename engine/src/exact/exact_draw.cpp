// SPDX-License-Identifier: Apache-2.0
#include "exact_draw.hpp"

#include "conservative.hpp"

namespace surefill::fast {
namespace {

const Vertex& vertex(const Draw& draw, std::uint32_t position, std::size_t k) {
  return draw.vertices[draw.indices[std::size_t{3} * position + k]];
}

}  // namespace

int orientation(const Draw& draw, std::uint32_t position, Statistics& statistics) {
  const EdgeFunction edge(vertex(draw, position, 1), vertex(draw, position, 2));
  return determinant_sign(edge, vertex(draw, position, 0), statistics);
}

void ExactDraw::use(const Draw& draw, std::uint32_t position) {
  if (draw_ == &draw && position_ == position) return;
  draw_ = &draw, position_ = position;
  const Vertex &v0 = vertex(draw, position, 0), &v1 = vertex(draw, position, 1), &v2 = vertex(draw, position, 2);
  Statistics unused;
  if (draw.grid) {
    snapped_.set_up(v0, v1, v2, *draw.grid, unused);
  } else {
    triangle_.set_up(v0, v1, v2, unused);
  }
}

bool ExactDraw::covers(SamplePosition p, TieShift shift, Statistics& statistics) const {
  return draw_->grid ? snapped_.winding(p, shift) != 0 : triangle_.covers(p, shift, statistics);
}

bool ExactDraw::counts_square(int x, int y, Statistics& statistics) const {
  const PixelSquare square(triangle_, x, y, statistics);
  return draw_->conservative == Conservative::over ? square.touched() : square.inside();
}

bool ExactDraw::depth(SamplePosition p, float* stored, Statistics& statistics) {
  return draw_->grid ? snapped_.depth(p, draw_->depth_mode, stored, statistics)
                     : triangle_.depth(p, draw_->depth_mode, stored, statistics);
}

bool ExactDraw::has_values(SamplePosition p) const {
  Statistics unused;
  return draw_->grid ? snapped_.has_weights(p, unused) : triangle_.plane_in_front(p);
}

float ExactDraw::attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Statistics& statistics) {
  return draw_->grid ? snapped_.attribute(p, u, interpolation, statistics)
                     : triangle_.attribute(p, u, interpolation, statistics);
}

}  // namespace surefill::fast
