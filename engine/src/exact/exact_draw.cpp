// SPDX-License-Identifier: Apache-2.0
#include "exact_draw.hpp"

#include "conservative.hpp"

namespace surefill {

int orientation(const Draw& draw, std::uint32_t position, Rungs* rungs) {
  const EdgeFunction edge(vertex_of(draw, position, 1), vertex_of(draw, position, 2));
  return determinant_sign(edge, vertex_of(draw, position, 0), rungs);
}

bool is_degenerate(const Draw& draw, std::uint32_t position) {
  if (!draw.grid) return draw.conservative != Conservative::touched;  // M4b
  Triangle triangle;
  triangle.set_up(vertex_of(draw, position, 0), vertex_of(draw, position, 1), vertex_of(draw, position, 2));
  return hull_contains_eye(triangle);
}

bool ExactDraw::use(const Draw& draw, std::uint32_t position, Rungs* rungs) {
  if (draw_ == &draw && position_ == position) return covers_something_;
  draw_ = &draw, position_ = position;
  if (!has_triangles(draw)) {
    const Vertex& v = vertex_of(draw, position, 0);
    covers_something_ = is_line() ? line_.set_up(v, vertex_of(draw, position, 1), draw.width)
                                  : point_.set_up(v, draw.width.value_or(1.0f));
    return covers_something_;
  }
  const Vertex &v0 = vertex_of(draw, position, 0), &v1 = vertex_of(draw, position, 1),
               &v2 = vertex_of(draw, position, 2);
  covers_something_ = draw.grid ? snapped_.set_up(v0, v1, v2, *draw.grid, rungs, origin_)
                                : triangle_.set_up(v0, v1, v2, rungs) || draw.conservative == Conservative::touched;
  return covers_something_;
}

PixelBox ExactDraw::box(const PixelBox& limits, double least_offset, double largest_offset) const {
  if (!has_triangles(*draw_)) {
    return is_line() ? line_.box(limits, least_offset, largest_offset)
                     : point_.box(limits, least_offset, largest_offset);
  }
  if (draw_->grid) return snapped_.box(limits, least_offset, largest_offset);
  const bool squares = draw_->conservative != Conservative::none;
  return screen_box(triangle_.vertex(0), triangle_.vertex(1), triangle_.vertex(2), limits, squares ? 0 : least_offset,
                    squares ? 1 : largest_offset);
}

bool ExactDraw::draws_square(int x, int y, Rungs* rungs) const {
  if (triangle_.determinant() == 0) return degenerate_touches(triangle_, x, y);
  const PixelSquare square(triangle_, x, y, rungs);
  switch (draw_->conservative) {
    case Conservative::inner:
      return square.inside();
    case Conservative::overlap:
      return square.overlapped();
    default:
      return square.touched();
  }
}

bool ExactDraw::depth(SamplePosition p, float* stored, Rungs* rungs) {
  if (!has_triangles(*draw_)) {
    return is_line() ? line_.depth(p, draw_->depth_mode, stored, rungs) : point_.depth(draw_->depth_mode, stored);
  }
  return draw_->grid ? snapped_.depth(p, *draw_, stored, rungs) : triangle_.depth(p, *draw_, stored, rungs);
}

bool ExactDraw::has_values(SamplePosition p) const {
  if (!has_triangles(*draw_)) return true;  // I6, I7: everywhere
  return draw_->grid ? snapped_.has_weights(p) : triangle_.plane_in_front(p);
}

SamplePosition ExactDraw::place_of_attributes(const Target& target, int x, int y, TieShift shift) const {
  const SamplePosition centre{x + 0.5, y + 0.5};
  if (target.samples == 1) return place_of_sample(target, x, y, 0);
  if (target.attribute_location == AttributeLocation::centre && has_values(centre)) return centre;
  if (covers(centre, shift)) return centre;
  for (int n = 0; n < target.samples; ++n) {
    const SamplePosition p = place_of_sample(target, x, y, n);
    if (covers(p, shift)) return p;
  }
  return centre;  // not reached: the triangle is seen at a sample of this pixel
}

float ExactDraw::attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs) {
  if (!has_triangles(*draw_)) return is_line() ? line_.attribute(p, u, interpolation, rungs) : surefill::stored(u[0]);
  return draw_->grid ? snapped_.attribute(p, u, interpolation, rungs) : triangle_.attribute(p, u, interpolation, rungs);
}

}  // namespace surefill
