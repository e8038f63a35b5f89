// SPDX-License-Identifier: Apache-2.0
//
// Occlusion queries about one image (O1 to O3).
#include "surefill/occlusion.hpp"

#include <utility>

#include "depth_levels.hpp"
#include "float_environment.hpp"

namespace surefill {

struct OcclusionBuffer::State : DepthLevels {};

OcclusionBuffer::~OcclusionBuffer() {
  delete state_;
}

OcclusionBuffer::OcclusionBuffer(OcclusionBuffer&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)), equal_is_visible_(other.equal_is_visible_) {}

OcclusionBuffer& OcclusionBuffer::operator=(OcclusionBuffer&& other) noexcept {
  std::swap(state_, other.state_);
  std::swap(equal_is_visible_, other.equal_is_visible_);
  return *this;
}

Status OcclusionBuffer::resize(int width, int height, DepthTest depth_test) noexcept {
  return State::resize(state_, width, height, depth_test);
}

void OcclusionBuffer::clear() noexcept {
  if (state_ != nullptr) state_->clear();
}

Status OcclusionBuffer::draw(std::span<const Draw> occluders, Statistics* statistics, const Options& options) noexcept {
  if (state_ == nullptr) return Status::target_size;
  Target target;
  target.width = state_->width, target.height = state_->height, target.depth_test = state_->test;
  target.depth = {state_->levels[0].farthest, state_->pixels()};
  target.initial_depth = target.depth;
  const Status status = render(target, occluders, statistics, options);
  if (status == Status::out_of_memory) state_->clear();
  if (status == Status::ok) {
    const FloatEnvironment environment;
    state_->build();
  }
  return status;
}

Status OcclusionBuffer::query(std::span<const OcclusionBox> boxes, std::span<Occlusion> answers) const noexcept {
  return State::query(state_, boxes, answers, Pixels::with_centre, equal_is_visible_);
}

Status OcclusionBuffer::query(std::span<const OcclusionRectangle> rectangles,
                              std::span<Occlusion> answers) const noexcept {
  return State::query(state_, rectangles, answers, Pixels::with_centre, equal_is_visible_);
}

int OcclusionBuffer::width() const noexcept {
  return state_ == nullptr ? 0 : state_->width;
}

int OcclusionBuffer::height() const noexcept {
  return state_ == nullptr ? 0 : state_->height;
}

std::span<const float> OcclusionBuffer::depth() const noexcept {
  return State::depth(state_);
}

}  // namespace surefill
