// SPDX-License-Identifier: Apache-2.0
//
// The first oracle: each strip of rows is drawn on its own, primitive by primitive, by the rules of docs/semantics.md as
// they stand.
#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "oracle/conservative.hpp"
#include "oracle/layers.hpp"
#include "oracle/oracle.hpp"
#include "oracle/triangle.hpp"

namespace surefill::oracle {

namespace {

// M10: strips add to the numbers of the same primitive at the same time.
void add_to(std::uint64_t& number, std::uint64_t summand) {
  std::atomic_ref(number).fetch_add(summand, std::memory_order_relaxed);
}

// What a frame asks for.
struct Wanted {
  bool lowest_index = false;  // M4c
  bool values = false;        // barycentrics or attributes
  bool visibility = false;    // who is seen, or how near that is
  bool counts = false;        // which samples are covered

  Wanted(const Target& target, std::span<const Draw> draws) {
    bool conservative = false, visible = false, covered = false;
    for (const Draw& draw : draws) {
      conservative |= draw.conservative != Conservative::none;
      visible |= !draw.visible.empty();
      covered |= !draw.covered.empty();
    }
    lowest_index = conservative && !target.index.empty();
    values = !target.barycentrics.empty();
    for (const AttributeTarget& attribute : target.attributes) values |= !attribute.values.empty();
    visibility = !conservative && (values || visible || !target.index.empty() || !target.depth.empty());
    counts = lowest_index || covered || !target.count.empty() || !target.winding.empty();
  }
};

// Rows [y0, y1) of the image.
class Strip {
 public:
  Strip(const Target& target, std::span<const Draw> draws, int y0, int y1)
      : target_(target),
        draws_(draws),
        wanted_(target, draws),
        pattern_(target),
        rows_{target.origin.x, target.origin.y + y0, target.origin.x + target.width, target.origin.y + y1},
        total_(total_of(target, target.height)),
        first_(total_of(target, y0)),
        size_(total_of(target, y1 - y0)),
        layers_(target.depth_test, target.layers, wanted_.visibility ? size_ : 0, initial_depth()) {
    clear();
  }

  void render() {
    if (!wanted_.counts && !wanted_.visibility) return;
    for (std::uint32_t number = 0; number < draws_.size(); ++number) {
      const Draw& draw = draws_[number];
      for (std::size_t t = 0; t < primitives_of(draw); ++t) {
        if (is_finite(draw, t)) render_primitive(number, t);
      }
    }
    if (wanted_.visibility) resolve();
  }

 private:
  static std::size_t total_of(const Target& target, int rows) {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(target.width) *
           static_cast<std::size_t>(target.samples);
  }
  std::span<const float> initial_depth() const {
    if (!wanted_.visibility || target_.initial_depth.empty()) return {};
    return target_.initial_depth.subspan(first_, size_);
  }

  void clear() {
    if (!target_.count.empty()) std::ranges::fill(target_.count.subspan(first_, size_), 0u);
    if (!target_.winding.empty()) std::ranges::fill(target_.winding.subspan(first_, size_), 0);
    if (wanted_.lowest_index) std::ranges::fill(target_.index.subspan(first_, size_), kNoTriangle);
    for (std::size_t n = 0; n < static_cast<std::size_t>(target_.layers); ++n) {
      clear(target_.barycentrics, n, 3, 3);
      for (const AttributeTarget& image : target_.attributes)
        clear(image.values, n, image.components, attribute_step(image));
    }
  }

  void clear(std::span<float> values, std::size_t layer, std::size_t components, std::size_t step) {
    if (values.empty()) return;
    const std::size_t begin = layer * total_ + first_;
    for (std::size_t s = begin; s < begin + size_; ++s) std::ranges::fill(values.subspan(s * step, components), 0.0f);
  }

  // The place of a sample in this strip.
  std::size_t place(int x, int y, int n) const {
    const std::size_t pixel = static_cast<std::size_t>(y - rows_.y0) * static_cast<std::size_t>(target_.width);
    return (pixel + static_cast<std::size_t>(x - rows_.x0)) * static_cast<std::size_t>(target_.samples) +
           static_cast<std::size_t>(n);
  }

  void render_primitive(std::uint32_t number, std::size_t t) {
    const Draw& draw = draws_[number];
    const Shape shape(target_.origin, draw, t);
    const int det = shape.cone() ? shape.cone()->sign_of_det() : 0;
    if (shape.cone()) {
      if (det == 0 && draw.conservative != Conservative::touched) return;  // C1, M4b
      if (is_culled(draw, det)) return;
    }
    Rect rect = intersect(rows_, shape.bounds(rows_));
    if (draw.scissor) rect = intersect(rect, {draw.scissor->x0, draw.scissor->y0, draw.scissor->x1, draw.scissor->y1});
    if (rect.empty()) return;

    covered_ = 0;
    std::optional<Depth> depth;  // made for the first fragment that needs it
    const auto fragment = [&](int x, int y, int n, int sign) {
      if (wanted_.visibility || draw.depth_mode == DepthMode::clip) {
        if (!depth) depth.emplace(depth_of(draw, t, shape));
        if (!render_depth(number, t, *depth, x, y, n)) return;
      }
      if (wanted_.counts) count(draw, t, place(x, y, n), is_front(draw, sign));
    };
    if (draw.conservative != Conservative::none) {
      visit_conservative(*shape.cone(), rect, draw.conservative,
                         [&](int x, int y) { count(draw, t, place(x, y, 0), is_front(draw, det)); });
    } else if (shape.cone()) {
      visit_covered(*shape.cone(), rect, pattern_, kAllEdges, [&](int x, int y, int n) { fragment(x, y, n, det); });
    } else if (shape.line()) {
      visit_covered(*shape.line(), rect, pattern_, [&](int x, int y, int n) { fragment(x, y, n, 0); });
    } else if (shape.square()) {
      visit_covered(*shape.square(), rect, pattern_, [&](int x, int y, int n) { fragment(x, y, n, 0); });
    } else {
      visit_snapped(draw, *shape.snapped(), rect, fragment);
    }
    if (!draw.covered.empty()) add_to(draw.covered[t], covered_);
  }

  // G1: the samples where the signed covers of the fan do not add up to 0, without those culled by that sign.
  template <typename Visit>
  void visit_snapped(const Draw& draw, const SnappedPolygon& polygon, const Rect& rect, const Visit& visit) {
    const std::size_t width = static_cast<std::size_t>(rect.x1 - rect.x0),
                      samples = static_cast<std::size_t>(target_.samples);
    winding_.assign(width * static_cast<std::size_t>(rect.y1 - rect.y0) * samples, 0);
    for (const Cone& triangle : polygon.fan()) {
      visit_covered(triangle, rect, pattern_, kAllEdges, [&](int x, int y, int n) {
        const std::size_t pixel = static_cast<std::size_t>(y - rect.y0) * width + static_cast<std::size_t>(x - rect.x0);
        winding_[pixel * samples + static_cast<std::size_t>(n)] += triangle.sign_of_det();
      });
    }
    std::size_t next = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        for (int n = 0; n < target_.samples; ++n, ++next) {
          if (winding_[next] != 0 && !is_culled(draw, winding_[next])) visit(x, y, n, winding_[next]);
        }
      }
    }
  }

  // I5: false if the fragment is clipped; else it may be seen.
  bool render_depth(std::uint32_t number, std::size_t t, const Depth& depth, int x, int y, int n) {
    const Draw& draw = draws_[number];
    const Point p = pattern_.at(n, x, y);
    if (!wanted_.visibility) return depth.keeps(p, draw.depth_mode);
    const std::optional<float> z = depth.at(p, draw.depth_mode);
    if (!z) return false;
    layers_.add(place(x, y, n), {number, static_cast<std::uint32_t>(t), index_of(draw, t), *z}, draw.depth_write);
    return true;
  }

  // M2, M9, M10, M4c
  void count(const Draw& draw, std::size_t t, std::size_t s, bool front) {
    ++covered_;
    if (!target_.count.empty()) ++target_.count[first_ + s];
    if (!target_.winding.empty() && draw.primitive == Primitive::triangles) {
      std::int32_t& winding = target_.winding[first_ + s];
      winding = static_cast<std::int32_t>(static_cast<std::uint32_t>(winding) + (front ? 1u : ~0u));
    }
    if (wanted_.lowest_index) {
      std::uint32_t& lowest = target_.index[first_ + s];
      lowest = std::min(lowest, index_of(draw, t));
    }
  }

  void resolve() {
    for (std::size_t s = 0; s < size_; ++s) {
      const Fragment& visible = layers_.fragment(0, s);
      if (visible.exists() && !draws_[visible.draw].visible.empty()) {
        add_to(draws_[visible.draw].visible[visible.triangle], 1);
      }
    }
    for (std::size_t n = 0; n < static_cast<std::size_t>(target_.layers); ++n) {
      const std::size_t start = n * total_ + first_;
      for (std::size_t s = 0; s < size_; ++s) {
        if (!target_.depth.empty()) target_.depth[start + s] = layers_.depth(n, s);
        if (!target_.index.empty()) target_.index[start + s] = layers_.fragment(n, s).index;
      }
      if (wanted_.values) store_values(n);
    }
  }

  void store_values(std::size_t layer) {
    for (int y = rows_.y0; y < rows_.y1; ++y) {
      for (int x = rows_.x0; x < rows_.x1; ++x) {
        for (int n = 0; n < target_.samples; ++n) store_value(layer, x, y, n);
      }
    }
  }

  void store_value(std::size_t layer, int x, int y, int n) {
    const std::size_t s = place(x, y, n), start = layer * total_ + first_;
    const Fragment& visible = layers_.fragment(layer, s);
    if (!visible.exists()) return;
    for (int m = 0; m < n; ++m) {
      const std::size_t other = place(x, y, m);
      const Fragment& seen = layers_.fragment(layer, other);
      if (seen.draw != visible.draw || seen.triangle != visible.triangle) continue;
      copy_values(start + other, start + s);  // M1: once per pixel
      return;
    }
    std::unique_ptr<Visible>& values = visible_[std::uint64_t{visible.draw} << 32 | visible.triangle];
    if (!values) values = std::make_unique<Visible>(target_, draws_[visible.draw], visible.triangle);
    values->store(x, y, start + s);
  }

  void copy_values(std::size_t from, std::size_t to) {
    const auto copy = [&](std::span<float> values, std::size_t components, std::size_t step) {
      if (values.empty()) return;
      std::ranges::copy(values.subspan(from * step, components), values.subspan(to * step).begin());
    };
    copy(target_.barycentrics, 3, 3);
    for (const AttributeTarget& image : target_.attributes) copy(image.values, image.components, attribute_step(image));
  }

  const Target& target_;
  std::span<const Draw> draws_;
  Wanted wanted_;
  Pattern pattern_;
  Rect rows_;                         // in space
  std::size_t total_, first_, size_;  // samples: of the target, before the strip, of the strip
  Layers layers_;
  std::uint64_t covered_ = 0;  // samples of the strip at which the primitive that is drawn is counted
  std::vector<int> winding_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Visible>> visible_;
};

}  // namespace

void render(const Target& target, std::span<const Draw> draws, int threads) {
  for (const Draw& draw : draws) {
    std::ranges::fill(draw.covered, 0u);
    std::ranges::fill(draw.visible, 0u);
  }
  // Strips of at most about four million samples; with several threads, some for each.
  const std::int64_t row = std::int64_t{target.width} * target.samples * target.layers;
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
