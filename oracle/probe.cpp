// SPDX-License-Identifier: Apache-2.0
//
// The first oracle for one primitive, sample by sample.
#include <optional>

#include "oracle/oracle.hpp"
#include "oracle/triangle.hpp"

namespace surefill::oracle {

struct Probe::State {
  const Target& target;
  const Draw& draw;
  std::size_t triangle;
  Pattern pattern;
  Rect reach;                     // empty if it is dropped or culled as a whole
  std::optional<Shape> shape;     // unless it is dropped
  std::optional<Depth> depth;     // made when first needed
  std::optional<Visible> values;  // as well

  const Depth& known_depth() {
    if (!depth) depth.emplace(depth_of(draw, triangle, *shape));
    return *depth;
  }
  int space_x(int x) const { return target.origin.x + x; }
  int space_y(int y) const { return target.origin.y + y; }
  Point sample(int x, int y, int n) const { return pattern.at(n, space_x(x), space_y(y)); }
};

Probe::Probe(const Target& target, const Draw& draw, std::size_t triangle)
    : state_(new State{target, draw, triangle, Pattern(target), {0, 0, 0, 0}, {}, {}, {}}) {
  if (!is_finite(draw, triangle)) return;
  const Shape& shape = state_->shape.emplace(target.origin, draw, triangle);
  if (shape.cone() && (shape.cone()->sign_of_det() == 0 || is_culled(draw, shape.cone()->sign_of_det()))) return;
  state_->reach = shape.bounds(pixels_of(target));
  if (!draw.scissor) return;
  const Scissor& scissor = *draw.scissor;
  state_->reach = intersect(state_->reach, {scissor.x0, scissor.y0, scissor.x1, scissor.y1});
}

Probe::~Probe() = default;

bool Probe::covers(int x, int y, int n) {
  const Rect& reach = state_->reach;
  const int space_x = state_->space_x(x), space_y = state_->space_y(y);
  if (space_x < reach.x0 || space_x >= reach.x1 || space_y < reach.y0 || space_y >= reach.y1) return false;
  const Point p = state_->sample(x, y, n);
  if (const std::optional<SnappedPolygon>& snapped = state_->shape->snapped()) {
    const int winding = snapped->winding(p);
    if (winding == 0 || is_culled(state_->draw, winding)) return false;
  } else if (!state_->shape->covers(p)) {
    return false;
  }
  return state_->draw.depth_mode != DepthMode::clip || state_->known_depth().keeps(p, DepthMode::clip);
}

float Probe::depth(int x, int y, int n) {
  return *state_->known_depth().at(state_->sample(x, y, n), state_->draw.depth_mode);
}

void Probe::store_values(int x, int y, std::size_t place) {
  if (!state_->values) state_->values.emplace(state_->target, state_->draw, state_->triangle);
  state_->values->store(state_->space_x(x), state_->space_y(y), place);
}

}  // namespace surefill::oracle
