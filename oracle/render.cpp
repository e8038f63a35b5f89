// SPDX-License-Identifier: Apache-2.0
//
// The first oracle: each strip of rows is drawn on its own, triangle by triangle, by the rules of docs/semantics.md as
// they stand.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "oracle/coverage.hpp"
#include "oracle/grid.hpp"
#include "oracle/oracle.hpp"
#include "oracle/values.hpp"

namespace surefill::oracle {

namespace {

constexpr std::uint32_t kNoDraw = 0xFFFFFFFFu;

std::array<std::uint32_t, 3> corners_of(const Draw& draw, std::size_t t) {
  return {draw.indices[3 * t], draw.indices[3 * t + 1], draw.indices[3 * t + 2]};
}

std::array<Vertex, 3> vertices_of(const Draw& draw, std::size_t t) {
  const auto [a, b, c] = corners_of(draw, t);
  return {draw.vertices[a], draw.vertices[b], draw.vertices[c]};
}

float attribute_value(const AttributeArray& array, std::uint32_t vertex, std::uint32_t component) {
  const std::size_t stride = array.stride == 0 ? array.components : array.stride;
  return array.values[vertex * stride + component];
}

// V2
std::uint32_t index_of(const Draw& draw, std::size_t t) {
  return draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t) : draw.identifiers[t];
}

// B1: every position and every attribute of the triangle is finite.
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

// F1, F2: does culling drop a triangle, or with a grid a sample of it, of this sign of D or N?
bool is_culled(const Draw& draw, int sign) {
  const bool front = (sign > 0) == (draw.front_face == FrontFace::clockwise);
  return draw.cull == (front ? Cull::front : Cull::back);
}

// The set of samples that a triangle covers, before culling.
class Shape {
 public:
  Shape(const Draw& draw, std::size_t t) {
    const std::array<Vertex, 3> v = vertices_of(draw, t);
    if (draw.grid) {
      clipped_ = clip_to_guard_band(integer_vertices(v));
      snapped_.emplace(clipped_, *draw.grid, draw.fill_rule);
    } else {
      cone_.emplace(
          std::array<Position, 3>{Position{v[0].x, v[0].y, v[0].w}, {v[1].x, v[1].y, v[1].w}, {v[2].x, v[2].y, v[2].w}},
          draw.fill_rule);
    }
  }

  bool covers(Point p) const { return snapped_ ? snapped_->winding(p) != 0 : cone_->covers(p); }
  Rect bounds(int width, int height) const {
    return snapped_ ? snapped_->bounds(width, height) : cone_->bounds(width, height);
  }
  const std::optional<Cone>& cone() const { return cone_; }
  const std::optional<SnappedPolygon>& snapped() const { return snapped_; }
  const std::vector<IntegerVertex>* clipped() const { return snapped_ ? &clipped_ : nullptr; }

 private:
  std::optional<Cone> cone_;  // without a grid
  std::vector<IntegerVertex> clipped_;
  std::optional<SnappedPolygon> snapped_;  // with a grid
};

// What is stored of a visible triangle beside index and depth.
class Visible {
 public:
  Visible(const Target& target, const Draw& draw, std::size_t t)
      : target_(target), grid_(draw.grid.has_value()), shape_(draw, t), edges_(integer_vertices(vertices_of(draw, t))) {
    const auto corners = corners_of(draw, t);
    for (std::size_t k = 0; k < target.attributes.size(); ++k) {
      if (target.attributes[k].values.empty()) continue;
      const AttributeArray& array = draw.attributes[k];
      for (std::uint32_t c = 0; c < target.attributes[k].components; ++c) {
        const std::array<float, 3> values = {attribute_value(array, corners[0], c),
                                             attribute_value(array, corners[1], c),
                                             attribute_value(array, corners[2], c)};
        components_.emplace_back(edges_, values, array.interpolation, grid_);
      }
    }
  }

  // Stores barycentrics and attributes of pixel (x, y) at `sample`, its place in the buffers.
  void store(int x, int y, std::size_t sample) {
    find_weights(x, y);
    if (!target_.barycentrics.empty()) barycentrics(weights_, target_.barycentrics.subspan(3 * sample).first<3>());
    std::size_t next = 0;
    for (const AttributeTarget& attribute : target_.attributes) {
      if (attribute.values.empty()) continue;
      for (std::size_t c = 0; c < attribute.components; ++c) {
        attribute.values[sample * attribute.components + c] = components_[next++].at(weights_);
      }
    }
  }

 private:
  // M1, G2: the weights at the place of the pixel where attributes are evaluated. With one sample a pixel it is the
  // centre.
  void find_weights(int x, int y) {
    const Point middle = centre(x, y);
    weights_at(edges_, middle, grid_, weights_);
    if (target_.samples == 1 || (grid_ && edges_.sign_of_det() == 0)) return;
    if (target_.attribute_location == AttributeLocation::centre) {
      if (grid_ ? !weights_.on_vertex_0 : weights_.w[0] + weights_.w[1] + weights_.w[2] > 0) return;
    }
    if (shape_.covers(middle)) return;
    for (int n = 0; n < target_.samples; ++n) {
      const Point p = sample_point(target_.samples, n, x, y);
      if (!shape_.covers(p)) continue;
      weights_at(edges_, p, grid_, weights_);
      return;
    }
  }

  const Target& target_;
  bool grid_;
  Shape shape_;
  Edges edges_;
  std::vector<Component> components_;
  Weights weights_;
};

// Rows [y0, y1) of the image.
class Strip {
 public:
  Strip(const Target& target, std::span<const Draw> draws, int y0, int y1)
      : target_(target),
        draws_(draws),
        rows_{0, y0, target.width, y1},
        first_(static_cast<std::size_t>(y0) * static_cast<std::size_t>(target.width) *
               static_cast<std::size_t>(target.samples)),
        size_(static_cast<std::size_t>(y1 - y0) * static_cast<std::size_t>(target.width) *
              static_cast<std::size_t>(target.samples)) {
    values_asked_ = !target.barycentrics.empty();
    for (const AttributeTarget& attribute : target.attributes) values_asked_ |= !attribute.values.empty();
    visibility_asked_ = values_asked_ || !target.index.empty() || !target.depth.empty();
    clear();
  }

  void render() {
    for (std::uint32_t number = 0; number < draws_.size(); ++number) {
      const Draw& draw = draws_[number];
      for (std::size_t t = 0; t < draw.indices.size() / 3; ++t) {
        if (is_finite(draw, t)) render_triangle(number, t);
      }
    }
    resolve();
  }

 private:
  void clear() {
    const float farthest = target_.depth_test == DepthTest::less ? std::numeric_limits<float>::infinity()
                                                                 : -std::numeric_limits<float>::infinity();
    if (!target_.count.empty()) std::ranges::fill(target_.count.subspan(first_, size_), 0u);
    if (!target_.barycentrics.empty()) std::ranges::fill(target_.barycentrics.subspan(3 * first_, 3 * size_), 0.0f);
    for (const AttributeTarget& attribute : target_.attributes) {
      if (attribute.values.empty()) continue;
      std::ranges::fill(attribute.values.subspan(attribute.components * first_, attribute.components * size_), 0.0f);
    }
    if (!visibility_asked_) return;
    depth_.assign(size_, farthest);
    if (!target_.initial_depth.empty()) std::ranges::copy(target_.initial_depth.subspan(first_, size_), depth_.begin());
    owner_draw_.assign(size_, kNoDraw);
    owner_triangle_.assign(size_, 0);
  }

  // The place of a sample in this strip.
  std::size_t place(int x, int y, int n) const {
    const std::size_t pixel = static_cast<std::size_t>(y - rows_.y0) * static_cast<std::size_t>(target_.width);
    return (pixel + static_cast<std::size_t>(x)) * static_cast<std::size_t>(target_.samples) +
           static_cast<std::size_t>(n);
  }

  void render_triangle(std::uint32_t number, std::size_t t) {
    const Draw& draw = draws_[number];
    if (target_.count.empty() && !visibility_asked_) return;  // nothing is asked for
    const Shape shape(draw, t);
    if (shape.cone() && (shape.cone()->sign_of_det() == 0 || is_culled(draw, shape.cone()->sign_of_det()))) return;
    Rect rect = intersect(rows_, shape.bounds(target_.width, target_.height));
    if (draw.scissor) rect = intersect(rect, {draw.scissor->x0, draw.scissor->y0, draw.scissor->x1, draw.scissor->y1});
    if (rect.empty()) return;

    if (draw.conservative != Conservative::none) {
      visit_conservative(*shape.cone(), rect, draw.conservative == Conservative::inner, kAllEdges,
                         [&](int x, int y) { ++target_.count[first_ + place(x, y, 0)]; });
      return;
    }
    std::optional<Depth> depth;  // made for the first fragment that needs it
    const auto fragment = [&](int x, int y, int n) {
      if (!visibility_asked_ && draw.depth_mode != DepthMode::clip) {
        ++target_.count[first_ + place(x, y, n)];
        return;
      }
      if (!depth) depth.emplace(Edges(integer_vertices(vertices_of(draw, t))), shape.clipped());
      render_fragment(number, t, *depth, x, y, n);
    };
    if (shape.cone()) {
      visit_covered(*shape.cone(), rect, target_.samples, kAllEdges, fragment);
    } else {
      visit_snapped(draw, *shape.snapped(), rect, fragment);
    }
  }

  // G1: the samples where the signed covers of the fan do not add up to 0, without those culled by that sign.
  template <typename Visit>
  void visit_snapped(const Draw& draw, const SnappedPolygon& polygon, const Rect& rect, const Visit& visit) {
    const std::size_t width = static_cast<std::size_t>(rect.x1 - rect.x0),
                      samples = static_cast<std::size_t>(target_.samples);
    winding_.assign(width * static_cast<std::size_t>(rect.y1 - rect.y0) * samples, 0);
    for (const Cone& triangle : polygon.fan()) {
      visit_covered(triangle, rect, target_.samples, kAllEdges, [&](int x, int y, int n) {
        const std::size_t pixel = static_cast<std::size_t>(y - rect.y0) * width + static_cast<std::size_t>(x - rect.x0);
        winding_[pixel * samples + static_cast<std::size_t>(n)] += triangle.sign_of_det();
      });
    }
    std::size_t next = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        for (int n = 0; n < target_.samples; ++n, ++next) {
          if (winding_[next] != 0 && !is_culled(draw, winding_[next])) visit(x, y, n);
        }
      }
    }
  }

  // I5, M2, V1, V3, M5
  void render_fragment(std::uint32_t number, std::size_t t, const Depth& depth, int x, int y, int n) {
    const Draw& draw = draws_[number];
    const std::size_t s = place(x, y, n);
    const Point p = sample_point(target_.samples, n, x, y);
    if (!visibility_asked_) {
      if (depth.keeps(p, draw.depth_mode)) ++target_.count[first_ + s];
      return;
    }
    const std::optional<float> z = depth.at(p, draw.depth_mode);
    if (!z) return;
    if (!target_.count.empty()) ++target_.count[first_ + s];

    const bool nearer = target_.depth_test == DepthTest::less ? *z < depth_[s] : *z > depth_[s];
    const bool owned_by_this_draw = owner_draw_[s] == number;
    bool passes = nearer;
    if (owned_by_this_draw) {
      const auto own = std::pair(index_of(draw, t), t);
      const auto other = std::pair(index_of(draw, owner_triangle_[s]), std::size_t{owner_triangle_[s]});
      passes = draw.depth_write ? nearer || (*z == depth_[s] && own < other) : nearer && own > other;
    }
    if (!passes) return;
    owner_draw_[s] = number;
    owner_triangle_[s] = static_cast<std::uint32_t>(t);
    if (draw.depth_write) depth_[s] = *z;
  }

  void resolve() {
    if (!visibility_asked_) return;
    if (!target_.depth.empty()) std::ranges::copy(depth_, target_.depth.subspan(first_, size_).begin());
    if (!target_.index.empty()) {
      for (std::size_t s = 0; s < size_; ++s) {
        target_.index[first_ + s] =
            owner_draw_[s] == kNoDraw ? kNoTriangle : index_of(draws_[owner_draw_[s]], owner_triangle_[s]);
      }
    }
    if (!values_asked_) return;
    for (int y = rows_.y0; y < rows_.y1; ++y) {
      for (int x = 0; x < target_.width; ++x) {
        for (int n = 0; n < target_.samples; ++n) store_values(x, y, n);
      }
    }
  }

  void store_values(int x, int y, int n) {
    const std::size_t s = place(x, y, n);
    if (owner_draw_[s] == kNoDraw) return;
    for (int m = 0; m < n; ++m) {
      const std::size_t other = place(x, y, m);
      if (owner_draw_[other] != owner_draw_[s] || owner_triangle_[other] != owner_triangle_[s]) continue;
      copy_values(first_ + other, first_ + s);  // M1: once per pixel
      return;
    }
    std::unique_ptr<Visible>& visible = visible_[std::uint64_t{owner_draw_[s]} << 32 | owner_triangle_[s]];
    if (!visible) visible = std::make_unique<Visible>(target_, draws_[owner_draw_[s]], owner_triangle_[s]);
    visible->store(x, y, first_ + s);
  }

  void copy_values(std::size_t from, std::size_t to) {
    const auto copy = [&](std::span<float> values, std::size_t components) {
      if (values.empty()) return;
      std::ranges::copy(values.subspan(from * components, components), values.subspan(to * components).begin());
    };
    copy(target_.barycentrics, 3);
    for (const AttributeTarget& attribute : target_.attributes) copy(attribute.values, attribute.components);
  }

  const Target& target_;
  std::span<const Draw> draws_;
  Rect rows_;
  std::size_t first_, size_;  // of the strip's samples in the target
  bool values_asked_ = false, visibility_asked_ = false;
  std::vector<float> depth_;                                // as stored so far, or initial
  std::vector<std::uint32_t> owner_draw_, owner_triangle_;  // the visible triangle
  std::vector<int> winding_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Visible>> visible_;
};

}  // namespace

struct Probe::State {
  const Target& target;
  const Draw& draw;
  std::size_t triangle;
  Rect reach;                     // empty if the triangle is dropped or culled as a whole
  std::optional<Shape> shape;     // unless it is dropped
  std::optional<Depth> depth;     // made when first needed
  std::optional<Visible> values;  // as well

  const Depth& known_depth() {
    if (!depth) depth.emplace(Edges(integer_vertices(vertices_of(draw, triangle))), shape->clipped());
    return *depth;
  }
};

Probe::Probe(const Target& target, const Draw& draw, std::size_t triangle)
    : state_(new State{target, draw, triangle, {0, 0, 0, 0}, {}, {}, {}}) {
  if (!is_finite(draw, triangle)) return;
  const Shape& shape = state_->shape.emplace(draw, triangle);
  if (shape.cone() && (shape.cone()->sign_of_det() == 0 || is_culled(draw, shape.cone()->sign_of_det()))) return;
  state_->reach = shape.bounds(target.width, target.height);
  if (!draw.scissor) return;
  const Scissor& scissor = *draw.scissor;
  state_->reach = intersect(state_->reach, {scissor.x0, scissor.y0, scissor.x1, scissor.y1});
}

Probe::~Probe() = default;

bool Probe::covers(int x, int y, int n) {
  const Rect& reach = state_->reach;
  if (x < reach.x0 || x >= reach.x1 || y < reach.y0 || y >= reach.y1) return false;
  const Point p = sample_point(state_->target.samples, n, x, y);
  if (const std::optional<SnappedPolygon>& snapped = state_->shape->snapped()) {
    const int winding = snapped->winding(p);
    if (winding == 0 || is_culled(state_->draw, winding)) return false;
  } else if (!state_->shape->cone()->covers(p)) {
    return false;
  }
  return state_->draw.depth_mode != DepthMode::clip || state_->known_depth().keeps(p, DepthMode::clip);
}

float Probe::depth(int x, int y, int n) {
  return *state_->known_depth().at(sample_point(state_->target.samples, n, x, y), state_->draw.depth_mode);
}

void Probe::store_values(int x, int y, std::size_t place) {
  if (!state_->values) state_->values.emplace(state_->target, state_->draw, state_->triangle);
  state_->values->store(x, y, place);
}

void render(const Target& target, std::span<const Draw> draws, int threads) {
  // Strips of at most about four million samples; with several threads, some for each.
  const std::int64_t row = std::int64_t{target.width} * target.samples;
  std::int64_t rows = std::clamp<std::int64_t>((std::int64_t{1} << 22) / row, 1, target.height);
  if (threads > 1) rows = std::min<std::int64_t>(rows, (target.height + 4 * threads - 1) / (4 * threads));
  const int strip_rows = static_cast<int>(rows);
  const int strips = (target.height + strip_rows - 1) / strip_rows;

  std::atomic<int> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    const StandardFloats standard_floats;
    try {
      for (int strip = next++; strip < strips; strip = next++) {
        const int y0 = strip * strip_rows;
        Strip(target, draws, y0, std::min(y0 + strip_rows, target.height)).render();
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::jthread> others;
  for (int n = 1; n < threads && n < strips; ++n) others.emplace_back(work);
  work();
  others.clear();  // joins
  if (failure) std::rethrow_exception(failure);
}

}  // namespace surefill::oracle
