// SPDX-License-Identifier: Apache-2.0
#include "oracle/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace surefill::oracle {

namespace {

std::size_t corners_of(Primitive primitive) {
  switch (primitive) {
    case Primitive::triangles:
      break;
    case Primitive::lines:
      return 2;
    case Primitive::points:
      return 1;
  }
  return 3;
}

// Of a line or a point the last one stands for those that it has not.
std::array<std::uint32_t, 3> corners_of(const Draw& draw, std::size_t t) {
  const std::size_t corners = corners_of(draw.primitive);
  std::array<std::uint32_t, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = draw.indices[corners * t + std::min(i, corners - 1)];
  return result;
}

std::array<Vertex, 3> vertices_of(const Draw& draw, std::size_t t) {
  const auto [a, b, c] = corners_of(draw, t);
  return {draw.vertices[a], draw.vertices[b], draw.vertices[c]};
}

float attribute_value(const AttributeArray& array, std::uint32_t vertex, std::uint32_t component) {
  const std::size_t stride = array.stride == 0 ? array.components : array.stride;
  return array.values[vertex * stride + component];
}

}  // namespace

std::size_t primitives_of(const Draw& draw) {
  return draw.indices.size() / corners_of(draw.primitive);
}

std::uint32_t index_of(const Draw& draw, std::size_t t) {
  return draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t) : draw.identifiers[t];
}

std::size_t attribute_step(const AttributeTarget& image) {
  return image.stride == 0 ? image.components : image.stride;
}

bool is_finite(const Draw& draw, std::size_t t) {
  for (const std::uint32_t corner : corners_of(draw, t)) {
    const Vertex& v = draw.vertices[corner];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) return false;
    for (const AttributeArray& array : draw.attributes) {
      for (std::uint32_t c = 0; c < array.components; ++c) {
        if (!std::isfinite(attribute_value(array, corner, c))) return false;
      }
    }
  }
  return true;
}

bool is_front(const Draw& draw, int sign) {
  return draw.front_face == FrontFace::clockwise ? sign > 0 : sign < 0;
}

bool is_culled(const Draw& draw, int sign) {
  return draw.cull == (is_front(draw, sign) ? Cull::front : Cull::back);
}

Shape::Shape(const Origin& origin, const Draw& draw, std::size_t t) {
  const std::array<Vertex, 3> v = vertices_of(draw, t);
  if (draw.primitive == Primitive::lines) {
    const std::array<IntegerVertex, 3> m = integer_vertices(v);
    line_ = Line::make(m[0], m[1], draw.width, draw.fill_rule);
  } else if (draw.primitive == Primitive::points) {
    if (v[0].w > 0) square_.emplace(integer_vertices(v)[0], draw.width.value_or(1), draw.fill_rule);
  } else if (draw.grid) {
    clipped_ = clip_to_guard_band(integer_vertices(v), origin);
    snapped_.emplace(clipped_, *draw.grid, draw.fill_rule);
  } else {
    cone_.emplace(
        std::array<Position, 3>{Position{v[0].x, v[0].y, v[0].w}, {v[1].x, v[1].y, v[1].w}, {v[2].x, v[2].y, v[2].w}},
        draw.fill_rule);
  }
}

bool Shape::covers(Point p) const {
  if (snapped_) return snapped_->winding(p) != 0;
  if (cone_) return cone_->covers(p);
  if (line_) return line_->covers(p);
  return square_ && square_->covers(p);
}

Rect Shape::bounds(const Rect& target) const {
  if (snapped_) return snapped_->bounds(target);
  if (cone_) return cone_->bounds(target);
  return line_ || square_ ? target : Rect{0, 0, 0, 0};
}

Depth depth_of(const Draw& draw, std::size_t t, const Shape& shape) {
  if (shape.line()) return Depth(*shape.line());
  if (shape.square()) return Depth(*shape.square());
  return {Edges(integer_vertices(vertices_of(draw, t))), shape.clipped(), draw.depth_bias};
}

Visible::Visible(const Target& target, const Draw& draw, std::size_t t)
    : target_(target),
      pattern_(target),
      grid_(draw.grid.has_value()),
      shape_(target.origin, draw, t),
      edges_(integer_vertices(vertices_of(draw, t))) {
  const auto corners = corners_of(draw, t);
  for (std::size_t k = 0; k < target.attributes.size(); ++k) {
    if (target.attributes[k].values.empty()) continue;
    const AttributeArray& array = draw.attributes[k];
    for (std::uint32_t c = 0; c < target.attributes[k].components; ++c) {
      const std::array<float, 3> values = {attribute_value(array, corners[0], c), attribute_value(array, corners[1], c),
                                           attribute_value(array, corners[2], c)};
      components_.emplace_back(edges_, values, array.interpolation, grid_ || shape_.line());
    }
  }
}

void Visible::store(int x, int y, std::size_t sample) {
  find_weights(x, y);
  if (!target_.barycentrics.empty()) barycentrics(weights_, target_.barycentrics.subspan(3 * sample).first<3>());
  std::size_t next = 0;
  for (const AttributeTarget& attribute : target_.attributes) {
    if (attribute.values.empty()) continue;
    for (std::size_t c = 0; c < attribute.components; ++c) {
      attribute.values[sample * attribute_step(attribute) + c] = components_[next++].at(weights_);
    }
  }
}

// M1, S7, G2: the weights at the place of the pixel where attributes are evaluated. With one sample a pixel it is that
// sample.
void Visible::find_weights(int x, int y) {
  if (shape_.square()) {  // I6
    weights_.on_vertex_0 = true;
    return;
  }
  if (shape_.line()) return find_line_weights(x, y);
  if (pattern_.samples() == 1) return weights_at(edges_, pattern_.at(0, x, y), grid_, weights_);
  const Point middle = centre(x, y);
  weights_at(edges_, middle, grid_, weights_);
  if (grid_ && edges_.sign_of_det() == 0) return;
  if (target_.attribute_location == AttributeLocation::centre) {
    if (grid_ ? !weights_.on_vertex_0 : weights_.w[0] + weights_.w[1] + weights_.w[2] > 0) return;
  }
  if (shape_.covers(middle)) return;
  for (int n = 0; n < pattern_.samples(); ++n) {
    const Point p = pattern_.at(n, x, y);
    if (!shape_.covers(p)) continue;
    weights_at(edges_, p, grid_, weights_);
    return;
  }
}

// I7, M1, S7.
void Visible::find_line_weights(int x, int y) {
  Point place = centre(x, y);
  if (pattern_.samples() == 1) {
    place = pattern_.at(0, x, y);
  } else if (target_.attribute_location == AttributeLocation::centroid && !shape_.covers(place)) {
    int n = 0;
    while (!shape_.covers(pattern_.at(n, x, y))) ++n;
    place = pattern_.at(n, x, y);
  }
  shape_.line()->weights_at(place, weights_.w[0], weights_.w[1]);
}

}  // namespace surefill::oracle
