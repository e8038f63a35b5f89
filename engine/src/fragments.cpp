// SPDX-License-Identifier: Apache-2.0
#include "fragments.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>

namespace surefill {

bool Layers::allocate(const Target& target, bool named) {
  total_ = sample_total(target), layers_ = static_cast<std::size_t>(target.layers);
  depth_ = target.depth.data();
  if (target.depth.empty()) {
    own_depth_.reset(new (std::nothrow) float[size()]);
    depth_ = own_depth_.get();
  }
  if (depth_ == nullptr) return false;
  if (named) {
    draw_.reset(new (std::nothrow) std::uint32_t[size()]);
    position_.reset(new (std::nothrow) std::uint32_t[size()]);
    if (draw_ == nullptr || position_ == nullptr) return false;
    std::fill(draw_.get(), draw_.get() + size(), kNoDraw);
  }
  for (float* layer = depth_; layer < depth_ + size(); layer += total_) {
    if (target.initial_depth.empty()) {
      std::fill(layer, layer + total_, empty_depth(target.depth_test));
    } else if (target.initial_depth.data() != layer) {
      std::memcpy(layer, target.initial_depth.data(), total_ * sizeof(float));
    }
  }
  return true;
}

void Layers::insert(std::size_t place, std::uint32_t draw, std::uint32_t position, float z) {
  for (std::size_t to = place % total_ + (layers_ - 1) * total_; to > place; to -= total_) {
    if (draw_ != nullptr) put(to, draw_[to - total_], position_[to - total_]);
    depth_[to] = depth_[to - total_];
  }
  replace(place, draw, position, z);
}

bool DrawFragments::counts(Fragment& f) {
  if (draw_.conservative != Conservative::none) {
    return triangle_.draws_square(target_.origin.x + f.x, target_.origin.y + f.y, &rungs_);
  }
  const SamplePosition p = place_of(f);
  if (!triangle_.draws(p, shift_, &rungs_)) return false;
  if (layers_ == nullptr && draw_.depth_mode != DepthMode::clip) return true;
  return triangle_.depth(p, &f.z, &rungs_);
}

bool DrawFragments::counts_of_covered(Fragment& f) {
  if (draw_.conservative == Conservative::overlap) return counts(f);
  return layers_ == nullptr || triangle_.depth(place_of(f), &f.z, &rungs_);
}

void DrawFragments::take_all(const Fragment& f) {
  const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
  if (!target_.count.empty()) ++target_.count[s];
  if (!draw_.covered.empty()) {  // the triangle may be met on other threads too
    std::atomic_ref(draw_.covered[f.position]).fetch_add(1, std::memory_order_relaxed);
  }
  if (!target_.winding.empty() && has_triangles(draw_)) {  // M9, modulo 2^32
    const std::uint32_t one = triangle_.is_front(place_of(f), shift_, &rungs_) ? 1u : 0xFFFFFFFFu;
    target_.winding[s] = static_cast<std::int32_t>(static_cast<std::uint32_t>(target_.winding[s]) + one);
  }
  if (layers_ != nullptr) {
    see(f, s);
  } else if (!target_.index.empty()) {  // M4c: kNoTriangle is larger than any index
    target_.index[s] = std::min(target_.index[s], index_of(draw_, f.position));
  }
}

void DrawFragments::see(const Fragment& f, std::size_t s) {
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
bool DrawFragments::passes(float z, std::size_t place) const {
  const float there = layers_->depth(place);
  return (is_reversed(target_.depth_test) ? z > there : z < there) || (z == there && takes_equal(target_.depth_test));
}

// Does the fragment come before what is there (V1 to V5)? Of equal depths in one draw indices decide, and of equal
// indices positions, in whose order fragments come.
bool DrawFragments::precedes(const Fragment& f, std::size_t place) const {
  if (f.z != layers_->depth(place) || layers_->draw(place) != number_) return passes(f.z, place);
  const std::uint32_t index = index_of(draw_, f.position);
  return takes_equal(target_.depth_test) ? index >= index_at(place) : index < index_at(place);
}

void DrawFragments::shade(std::uint32_t position, int x, int y, std::size_t place) {
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
      float u[3] = {};
      for (std::size_t i = 0; i < corners_of(draw_); ++i)
        u[i] = in.values[vertex_index(draw_, position, i) * stride_of(in) + c];
      out.values[place * stride_of(out) + c] = triangle_.attribute(p, u, in.interpolation, &rungs_);
    }
  }
}

namespace {

// The empty image (V1), without depth.
void clear(const Target& target) {
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::fill(target.winding.begin(), target.winding.end(), 0);
  std::fill(target.index.begin(), target.index.end(), kNoTriangle);
  std::fill(target.barycentrics.begin(), target.barycentrics.end(), 0.0f);
  for (const AttributeTarget& attribute : target.attributes) {
    const std::size_t samples = static_cast<std::size_t>(target.layers) * sample_total(target);
    for (std::size_t s = 0; s < samples && !attribute.values.empty(); ++s)
      std::fill_n(&attribute.values[s * stride_of(attribute)], attribute.components, 0.0f);
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
      out.values[to * stride_of(out) + c] = out.values[from * stride_of(out) + c];
    }
  }
}

}  // namespace

FragmentFrame::FragmentFrame(const Target& target, std::span<const Draw> draws)
    : target_(target), draws_(draws), wanted_(wanted_outputs(target)) {
  bool conservative = false;
  for (const Draw& draw : draws) {
    conservative = conservative || draw.conservative != Conservative::none;
    visible_ = visible_ || !draw.visible.empty();
  }
  seen_ = !conservative && (wanted_.depth || visible_);  // M4c's index is of nobody that is seen
}

bool FragmentFrame::begin() {
  if (seen_ && !layers_.allocate(target_, wanted_.visibility || visible_)) return false;
  clear(target_);
  for (const Draw& draw : draws_) {
    std::fill(draw.covered.begin(), draw.covered.end(), 0u);
    std::fill(draw.visible.begin(), draw.visible.end(), 0u);
  }
  return true;
}

void FragmentFrame::finish(Rungs& rungs) {
  if (!seen_ || !(wanted_.visibility || visible_)) return;
  for (std::size_t d = 0; d < draws_.size(); ++d) show(static_cast<std::uint32_t>(d), rungs);
}

// What one draw shows, once all are drawn.
void FragmentFrame::show(std::uint32_t number, Rungs& rungs) {
  const Draw& draw = draws_[number];
  const auto samples = static_cast<std::size_t>(target_.samples), width = static_cast<std::size_t>(target_.width);
  DrawFragments fragments(target_, draw, number, nullptr, rungs);
  for (std::size_t place = 0; place < layers_.size(); ++place) {
    if (layers_.draw(place) != number) continue;
    const std::uint32_t position = layers_.position(place);
    if (place < layers_.total() && !draw.visible.empty()) ++draw.visible[position];
    if (!target_.index.empty()) target_.index[place] = index_of(draw, position);
    if (!wanted_.shading) continue;
    const std::size_t s = place % layers_.total();
    if (s % samples != 0 && layers_.draw(place - 1) == number && layers_.position(place - 1) == position) {
      copy_shading(target_, place - 1, place);
    } else {
      fragments.shade(position, static_cast<int>(s / samples % width), static_cast<int>(s / samples / width), place);
    }
  }
}

}  // namespace surefill
