// SPDX-License-Identifier: Apache-2.0
#include "oracle/layers.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace surefill::oracle {

namespace {

bool smaller_is_nearer(DepthTest test) {
  return test == DepthTest::less || test == DepthTest::less_equal;
}

// V5: an equal depth passes, and of equal ones the later is seen.
bool later_wins(DepthTest test) {
  return test == DepthTest::less_equal || test == DepthTest::greater_equal;
}

// The order of a draw's triangles (V2).
std::pair<std::uint32_t, std::uint32_t> in_draw(const Fragment& f) {
  return {f.index, f.triangle};
}

}  // namespace

Layers::Layers(DepthTest test, int layers, std::size_t samples, std::span<const float> initial)
    : test_(test), layers_(static_cast<std::size_t>(layers)), held_(samples * layers_) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  initial_.assign(initial.begin(), initial.end());
  if (initial.empty()) initial_.assign(samples, smaller_is_nearer(test) ? kInfinity : -kInfinity);
  if (layers == 1) stored_ = std::move(initial_);
}

// V1, V5: -0 and +0 are equal, and a limit of NaN is beaten by none.
bool Layers::passes(float depth, float limit) const {
  if (later_wins(test_) && depth == limit) return true;
  return smaller_is_nearer(test_) ? depth < limit : depth > limit;
}

// V4's order.
bool Layers::precedes(const Fragment& a, const Fragment& b) const {
  if (a.depth != b.depth) return smaller_is_nearer(test_) ? a.depth < b.depth : a.depth > b.depth;
  const std::tuple of_a(a.draw, in_draw(a)), of_b(b.draw, in_draw(b));
  return later_wins(test_) ? of_a > of_b : of_a < of_b;
}

void Layers::add(std::size_t sample, const Fragment& fragment, bool depth_write) {
  if (layers_ == 1) return add_to_image(sample, fragment, depth_write);
  if (!passes(fragment.depth, initial_[sample])) return;
  Fragment next = fragment;  // pushes down one after another of those that it precedes
  for (std::size_t n = 0; n < layers_; ++n) {
    Fragment& held = held_[sample * layers_ + n];
    if (!held.exists() || precedes(next, held)) std::swap(next, held);
    if (!next.exists()) return;
  }
}

// V1 to V3, M5, and V5's ties.
void Layers::add_to_image(std::size_t sample, const Fragment& fragment, bool depth_write) {
  Fragment& visible = held_[sample];
  float& stored = stored_[sample];
  bool wins = false;
  if (visible.draw != fragment.draw) {
    wins = passes(fragment.depth, stored);
  } else if (depth_write) {
    wins = precedes(fragment, visible);
  } else {
    wins = passes(fragment.depth, stored) && in_draw(fragment) > in_draw(visible);
  }
  if (!wins) return;
  visible = fragment;
  if (depth_write) stored = fragment.depth;
}

float Layers::depth(std::size_t n, std::size_t sample) const {
  if (layers_ == 1) return stored_[sample];
  const Fragment& held = fragment(n, sample);
  return held.exists() ? held.depth : initial_[sample];
}

}  // namespace surefill::oracle
