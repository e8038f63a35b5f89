// SPDX-License-Identifier: Apache-2.0
#include "reference.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

#include "exact/exact_draw.hpp"

namespace surefill::reference {
namespace {

// A sample that M2 counts: the triangle, by its position in the draw, the pixel of the target, the number of the sample
// and, where somebody looks at depth, what is stored of it.
struct Fragment {
  std::uint32_t position;
  int x, y, n;
  float z;
};

// Who is seen at the samples of a frame, layer by layer (V4). Element n total + s is layer n of sample s. An empty place
// has no draw; its depth is the initial one (V1).
class Layers {
 public:
  static constexpr std::uint32_t kNoDraw = 0xFFFFFFFFu;

  // False where memory is lacking. `depth` is the caller's buffer, or null.
  bool allocate(const Target& target) {
    total_ = sample_total(target), layers_ = static_cast<std::size_t>(target.layers);
    depth_ = target.depth.data();
    if (target.depth.empty()) {
      own_depth_.reset(new (std::nothrow) float[size()]);
      depth_ = own_depth_.get();
    }
    draw_.reset(new (std::nothrow) std::uint32_t[size()]);
    position_.reset(new (std::nothrow) std::uint32_t[size()]);
    if (depth_ == nullptr || draw_ == nullptr || position_ == nullptr) return false;
    std::fill(draw_.get(), draw_.get() + size(), kNoDraw);
    for (float* layer = depth_; layer < depth_ + size(); layer += total_) {
      if (target.initial_depth.empty()) {
        std::fill(layer, layer + total_, empty_depth(target.depth_test));
      } else if (target.initial_depth.data() != layer) {
        std::memcpy(layer, target.initial_depth.data(), total_ * sizeof(float));
      }
    }
    return true;
  }

  std::size_t size() const { return layers_ * total_; }
  std::size_t total() const { return total_; }
  float depth(std::size_t place) const { return depth_[place]; }
  std::uint32_t draw(std::size_t place) const { return draw_[place]; }
  std::uint32_t position(std::size_t place) const { return position_[place]; }

  void put(std::size_t place, std::uint32_t draw, std::uint32_t position) {
    draw_[place] = draw, position_[place] = position;
  }
  // Puts a fragment into a place; what was there, and behind it, moves one layer back.
  void insert(std::size_t place, std::uint32_t draw, std::uint32_t position, float z) {
    for (std::size_t to = place % total_ + (layers_ - 1) * total_; to > place; to -= total_) {
      put(to, draw_[to - total_], position_[to - total_]);
      depth_[to] = depth_[to - total_];
    }
    put(place, draw, position);
    depth_[place] = z;
  }

 private:
  std::size_t total_ = 0, layers_ = 1;
  float* depth_ = nullptr;
  std::unique_ptr<float[]> own_depth_;
  std::unique_ptr<std::uint32_t[]> draw_, position_;
};

// One draw of a frame.
class DrawRenderer {
 public:
  // `layers` is null if no depth is looked at.
  DrawRenderer(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs)
      : target_(target),
        draw_(draw),
        number_(number),
        layers_(layers),
        rungs_(rungs),
        shift_(tie_shift(draw.fill_rule)),
        triangle_(target.origin) {
    for (int n = 0; n < target.samples; ++n) {
      const SamplePosition offset = sample_offset(target, n);
      least_ = std::min({least_, offset.x, offset.y}), largest_ = std::max({largest_, offset.x, offset.y});
    }
  }

  // Who covers, and who is seen. Without anybody being seen an index is M4c's.
  void rasterize() {
    std::fill(draw_.covered.begin(), draw_.covered.end(), 0u);
    const bool smallest = layers_ == nullptr && !target_.index.empty();
    traverse(0, target_.samples, [&](const Fragment& f) {
      const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
      if (!target_.count.empty()) ++target_.count[s];
      if (!draw_.covered.empty()) ++draw_.covered[f.position];
      if (!target_.winding.empty()) add_winding(f, s);
      if (smallest) {  // kNoTriangle is larger than any
        target_.index[s] = std::min(target_.index[s], index_of(draw_, f.position));
      }
      if (layers_ != nullptr) see(f, s);
    });
  }

  // The covered samples of number n, triangle by triangle, block by block.
  void visit(int n, const CoverageVisitor& visitor) {
    CoverageBlock block{number_, 0, 0, 0, n, 0};
    const auto flush = [&] {
      if (block.mask != 0) visitor.visit(visitor.context, {&block, 1});
      block.mask = 0;
    };
    traverse(n, n + 1, [&](const Fragment& f) {
      if (f.position != block.triangle || (f.x & ~7) != block.x || (f.y & ~7) != block.y) {
        flush();
        block.triangle = f.position, block.x = f.x & ~7, block.y = f.y & ~7;
      }
      block.mask |= std::uint64_t{1} << (8 * (f.y & 7) + (f.x & 7));
    });
    flush();
  }

  // Writes barycentrics and attributes of a triangle of this draw, seen in pixel (x, y) of the target, to a place of the
  // outputs.
  void shade(std::uint32_t position, int x, int y, std::size_t place) {
    triangle_.use(draw_, position, &rungs_);
    const SamplePosition p = triangle_.place_of_attributes(target_, target_.origin.x + x, target_.origin.y + y, shift_);
    if (!target_.barycentrics.empty()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
        target_.barycentrics[3 * place + i] = triangle_.attribute(p, unit, Interpolation::perspective, &rungs_);
      }
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (out.values.empty()) continue;
      const AttributeArray& in = draw_.attributes[k];
      for (std::size_t c = 0; c < out.components; ++c) {
        float u[3];
        for (std::size_t i = 0; i < 3; ++i) u[i] = in.values[vertex_index(draw_, position, i) * stride_of(in) + c];
        out.values[place * out.components + c] = triangle_.attribute(p, u, in.interpolation, &rungs_);
      }
    }
  }

 private:
  // Calls sink(Fragment) for each sample of numbers [first, last) that M2 counts: triangle by triangle, and of each by
  // blocks of 8 x 8 pixels, which begin at the target's corner (M8).
  template <typename Sink>
  void traverse(int first, int last, const Sink& sink) {
    const PixelBox region = region_of(target_, draw_);
    const Origin& o = target_.origin;
    for (std::size_t t = 0; t < triangles_of(draw_); ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      if (region.empty() || !is_finite(draw_, position) || !triangle_.use(draw_, position, &rungs_)) continue;
      // Under Grid facing is a matter of the sample (G1).
      if (!draw_.grid && culls(draw_, triangle_.triangle().determinant())) continue;
      PixelBox box = triangle_.box(region, least_, largest_);
      if (box.empty()) continue;
      box = {box.x0 - o.x, box.y0 - o.y, box.x1 - o.x, box.y1 - o.y};
      for (int by = box.y0 & ~7; by < box.y1; by += 8) {
        for (int bx = box.x0 & ~7; bx < box.x1; bx += 8) {
          for (int y = std::max(by, box.y0); y < std::min(by + 8, box.y1); ++y) {
            for (int x = std::max(bx, box.x0); x < std::min(bx + 8, box.x1); ++x) {
              for (int n = first; n < last; ++n) {
                Fragment fragment{position, x, y, n, 0};
                if (counts(fragment)) sink(fragment);
              }
            }
          }
        }
      }
    }
  }

  SamplePosition place_of(const Fragment& f) const {
    return place_of_sample(target_, target_.origin.x + f.x, target_.origin.y + f.y, f.n);
  }

  // M2: covered, not culled, and not removed by depth clipping. Finds out the depth, where it is looked at.
  bool counts(Fragment& f) {
    if (draw_.conservative != Conservative::none) {
      return triangle_.draws_square(target_.origin.x + f.x, target_.origin.y + f.y, &rungs_);
    }
    const SamplePosition p = place_of(f);
    if (!triangle_.draws(p, shift_, &rungs_)) return false;
    if (layers_ == nullptr && draw_.depth_mode != DepthMode::clip) return true;
    return triangle_.depth(p, &f.z, &rungs_);
  }

  // M9, modulo 2^32.
  void add_winding(const Fragment& f, std::size_t s) {
    const std::uint32_t one = triangle_.is_front(place_of(f), shift_, &rungs_) ? 1u : 0xFFFFFFFFu;
    target_.winding[s] = static_cast<std::int32_t>(static_cast<std::uint32_t>(target_.winding[s]) + one);
  }

  void see(const Fragment& f, std::size_t s) {
    if (!draw_.depth_write) {  // M5: one layer, whose depth stays
      if (passes(f.z, s) && (layers_->draw(s) != number_ || index_at(s) <= index_of(draw_, f.position))) {
        layers_->put(s, number_, f.position);
      }
      return;
    }
    for (std::size_t place = s; place < layers_->size(); place += layers_->total()) {
      if (!precedes(f, place)) continue;
      layers_->insert(place, number_, f.position, f.z);
      return;
    }
  }

  // The depth test (V1, V5).
  bool passes(float z, std::size_t place) const {
    const float there = layers_->depth(place);
    return (is_reversed(target_.depth_test) ? z > there : z < there) || (z == there && takes_equal(target_.depth_test));
  }

  // Does the fragment come before what is there (V1 to V5)? Of equal depths in one draw indices decide, and of equal
  // indices positions, in whose order fragments come.
  bool precedes(const Fragment& f, std::size_t place) const {
    if (f.z != layers_->depth(place) || layers_->draw(place) != number_) return passes(f.z, place);
    const std::uint32_t index = index_of(draw_, f.position);
    return takes_equal(target_.depth_test) ? index >= index_at(place) : index < index_at(place);
  }

  // Of a place that has a triangle of this draw.
  std::uint32_t index_at(std::size_t place) const { return index_of(draw_, layers_->position(place)); }

  const Target& target_;
  const Draw& draw_;
  std::uint32_t number_;  // of the draw in the frame
  Layers* layers_;
  Rungs& rungs_;
  TieShift shift_;
  double least_ = 1, largest_ = 0;  // of the coordinates of a pixel's samples
  ExactDraw triangle_;
};

// The empty image (V1), without depth.
void clear(const Target& target) {
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::fill(target.winding.begin(), target.winding.end(), 0);
  std::fill(target.index.begin(), target.index.end(), kNoTriangle);
  std::fill(target.barycentrics.begin(), target.barycentrics.end(), 0.0f);
  for (const AttributeTarget& attribute : target.attributes) {
    std::fill(attribute.values.begin(), attribute.values.end(), 0.0f);
  }
}

// Attributes are evaluated once per pixel (M1).
void copy_shading(const Target& target, std::size_t from, std::size_t to) {
  if (!target.barycentrics.empty()) {
    for (std::size_t i = 0; i < 3; ++i) target.barycentrics[3 * to + i] = target.barycentrics[3 * from + i];
  }
  for (const AttributeTarget& out : target.attributes) {
    if (out.values.empty()) continue;
    for (std::size_t c = 0; c < out.components; ++c) {
      out.values[to * out.components + c] = out.values[from * out.components + c];
    }
  }
}

// What one draw shows, once all draws are drawn: numbers of its triangles (M10), index, barycentrics and attributes.
void show(const Target& target, const Draw& draw, std::uint32_t number, const Layers& layers, Rungs& rungs) {
  const Wanted wanted = wanted_outputs(target);
  const auto samples = static_cast<std::size_t>(target.samples), width = static_cast<std::size_t>(target.width);
  DrawRenderer renderer(target, draw, number, nullptr, rungs);
  std::fill(draw.visible.begin(), draw.visible.end(), 0u);
  for (std::size_t place = 0; place < layers.size(); ++place) {
    if (layers.draw(place) != number) continue;
    const std::uint32_t position = layers.position(place);
    if (place < layers.total() && !draw.visible.empty()) ++draw.visible[position];
    if (!target.index.empty()) target.index[place] = index_of(draw, position);
    if (!wanted.shading) continue;
    const std::size_t s = place % layers.total();
    if (s % samples != 0 && layers.draw(place - 1) == number && layers.position(place - 1) == position) {
      copy_shading(target, place - 1, place);
    } else {
      renderer.shade(position, static_cast<int>(s / samples % width), static_cast<int>(s / samples / width), place);
    }
  }
}

}  // namespace

Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept {
  const auto any = [&](auto what) { return std::any_of(draws.begin(), draws.end(), what); };
  const bool conservative = any([](const Draw& draw) { return draw.conservative != Conservative::none; });
  const bool visible = any([](const Draw& draw) { return !draw.visible.empty(); });
  const Wanted wanted = wanted_outputs(target);
  const bool seen = !conservative && (wanted.depth || visible);  // M4c has an index without anything being seen
  Layers layers;
  if (seen && !layers.allocate(target)) return Status::out_of_memory;
  clear(target);
  for (std::size_t d = 0; d < draws.size(); ++d) {
    DrawRenderer(target, draws[d], static_cast<std::uint32_t>(d), seen ? &layers : nullptr, rungs).rasterize();
  }
  for (std::size_t d = 0; seen && (wanted.visibility || visible) && d < draws.size(); ++d) {
    show(target, draws[d], static_cast<std::uint32_t>(d), layers, rungs);
  }
  return Status::ok;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept {
  for (int n = 0; n < target.samples; ++n) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      DrawRenderer(target, draws[d], static_cast<std::uint32_t>(d), nullptr, rungs).visit(n, visitor);
    }
  }
  return Status::ok;
}

}  // namespace surefill::reference
