// SPDX-License-Identifier: Apache-2.0
//
// Occlusion queries (O1 to O3): a depth buffer and, above it, levels of blocks, each 8 x 8 of the level below, that
// know their farthest depth. Inside, depth is a key that grows with distance: z, or -z for DepthTest::greater.
#include "surefill/occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "build_check.hpp"
#include "exact/bounds.hpp"
#include "float_environment.hpp"
#include "overlap.hpp"

namespace surefill {
namespace {

constexpr float kFarthest = std::numeric_limits<float>::infinity();
constexpr int kFanoutLog2 = 3;   // a block is 8 x 8 of the level below
constexpr int kLevels = 5;       // level k has blocks of 8^k pixels; 8^5 > kMaxTargetSize
constexpr int kSpanAtStart = 4;  // a query starts at the level where its rectangle spans about so many blocks

// What a query asks: is a pixel of `pixels` farther than `nearest`? (O2)
struct Question {
  PixelBox pixels{0, 0, 0, 0};
  float nearest = 0;
};

// a / w as I4 rounds it; w > 0.
float rounded_quotient(float a, float w) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::clamp(a / w, -kLargest, kLargest);
}

// The pixels of the target whose centre lies in the closed rectangle. The ends are exact where it matters: see
// question_of.
PixelBox pixels_within(Reach x, Reach y, PixelBox target) {
  clip_to_reach(x, 0.5, 0.5, &target.x0, &target.x1);
  clip_to_reach(y, 0.5, 0.5, &target.y0, &target.y1);
  return target;
}

// The quotients are rounded to double, and compared with pixel centres exactly nevertheless: X and c W are numbers of
// 24 and 39 bits, so if X / W differs from the centre c, it does by more than 2^-40 of c.
Question question_of(const OcclusionBox& box, float sign, PixelBox target) {
  Reach x{HUGE_VAL, -HUGE_VAL}, y = x;
  float nearest = kFarthest;
  int in_front = 0;
  for (const Vertex& v : box.corners) {
    if (!(v.w > 0)) continue;
    ++in_front;
    const double px = static_cast<double>(v.x) / v.w, py = static_cast<double>(v.y) / v.w;
    x = {std::min(x.low, px), std::max(x.high, px)};
    y = {std::min(y.low, py), std::max(y.high, py)};
    nearest = std::min(nearest, rounded_quotient(sign * v.z, v.w));
  }
  if (in_front == 0) return {};
  if (in_front < 8) return {target, -kFarthest};
  return {pixels_within(x, y, target), nearest};
}

Question question_of(const OcclusionRectangle& r, float sign, PixelBox target) {
  if (!(r.x0 <= r.x1 && r.y0 <= r.y1)) return {};
  return {pixels_within({r.x0, r.x1}, {r.y0, r.y1}, target), sign * r.nearest_depth};
}

bool legal(const OcclusionBox& box) {
  return std::all_of(std::begin(box.corners), std::end(box.corners), [](const Vertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  });
}

bool legal(const OcclusionRectangle& r) {
  return !std::isnan(r.x0) && !std::isnan(r.y0) && !std::isnan(r.x1) && !std::isnan(r.y1) &&
         !std::isnan(r.nearest_depth);
}

}  // namespace

struct OcclusionBuffer::State {
  struct Level {
    int width = 0, height = 0;
    float* farthest = nullptr;  // a key
  };

  int width = 0, height = 0;
  DepthTest test = DepthTest::less;
  std::unique_ptr<float[]> memory;  // depth, then the levels
  std::size_t size = 0;             // of the memory
  Level levels[kLevels + 1];        // level 0 is depth itself

  float sign() const { return test == DepthTest::less ? 1.0f : -1.0f; }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  PixelBox target() const { return {0, 0, width, height}; }

  static std::unique_ptr<State> make(int width, int height, DepthTest test) {
    std::unique_ptr<State> state(new (std::nothrow) State);
    if (state == nullptr) return nullptr;
    state->width = width, state->height = height, state->test = test;
    std::size_t offset[kLevels + 1], total = 0;
    int w = width, h = height;
    for (int k = 0; k <= kLevels; ++k) {
      state->levels[k] = {w, h, nullptr};
      offset[k] = total;
      total += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
      w = ((w - 1) >> kFanoutLog2) + 1, h = ((h - 1) >> kFanoutLog2) + 1;
    }
    state->memory.reset(new (std::nothrow) float[total]);
    state->size = total;
    if (state->memory == nullptr) return nullptr;
    for (int k = 0; k <= kLevels; ++k) state->levels[k].farthest = state->memory.get() + offset[k];
    state->clear();
    return state;
  }

  void clear() {
    std::fill_n(levels[0].farthest, pixels(), sign() * kFarthest);
    for (int k = 1; k <= kLevels; ++k) {
      const Level& level = levels[k];
      std::fill_n(level.farthest, static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height),
                  kFarthest);
    }
  }

  // Each block's farthest key, from the level below: over the rows of a block first, column by column, which compilers
  // make vector code of; then over its columns. Not inlined: it needs the engine's floating-point state.
  [[gnu::noinline]] void build() {
    constexpr int kFanout = 1 << kFanoutLog2, kColumns = 16 * kFanout;
    for (int k = 1; k <= kLevels; ++k) {
      const Level &below = levels[k - 1], &level = levels[k];
      const float scale = k == 1 ? sign() : 1.0f;
      for (int y = 0; y < level.height; ++y) {
        float* to = level.farthest + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width);
        const int first_row = y * kFanout, last_row = std::min(first_row + kFanout, below.height);
        for (int x = 0; x < below.width; x += kColumns) {
          const int columns = std::min(kColumns, below.width - x);
          float farthest[kColumns];
          std::fill_n(farthest, kColumns, -kFarthest);
          for (int row = first_row; row < last_row; ++row) {
            const float* from =
                below.farthest + static_cast<std::size_t>(row) * static_cast<std::size_t>(below.width) + x;
            for (int i = 0; i < columns; ++i) farthest[i] = std::max(farthest[i], scale * from[i]);
          }
          for (int i = 0; i < columns; i += kFanout) {
            to[(x + i) >> kFanoutLog2] = *std::max_element(farthest + i, farthest + i + kFanout);
          }
        }
      }
    }
  }

  // The key of a block, or of a pixel (level 0).
  float key(int k, int x, int y) const {
    const Level& level = levels[k];
    const float value = level.farthest[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                                       static_cast<std::size_t>(x)];
    return k == 0 ? sign() * value : value;
  }

  // Is a pixel of `box`, which is not empty and lies in the target, farther than `nearest`, or as far if `equal` (O6)?
  bool sees(int k, const PixelBox& box, float nearest, bool equal) const {
    const int shift = k * kFanoutLog2;
    for (int by = box.y0 >> shift; by <= (box.y1 - 1) >> shift; ++by) {
      for (int bx = box.x0 >> shift; bx <= (box.x1 - 1) >> shift; ++bx) {
        const float farthest = key(k, bx, by);
        if (equal ? !(nearest <= farthest) : !(nearest < farthest)) continue;
        if (k == 0) return true;
        const PixelBox block{bx << shift, by << shift, std::min((bx + 1) << shift, width),
                             std::min((by + 1) << shift, height)};
        const PixelBox part{std::max(box.x0, block.x0), std::max(box.y0, block.y0), std::min(box.x1, block.x1),
                            std::min(box.y1, block.y1)};
        const bool whole = part.x0 == block.x0 && part.y0 == block.y0 && part.x1 == block.x1 && part.y1 == block.y1;
        if (whole || sees(k - 1, part, nearest, equal)) return true;
      }
    }
    return false;
  }

  Occlusion answer(const Question& question, bool equal) const {
    const PixelBox& box = question.pixels;
    if (box.empty()) return Occlusion::outside;
    int k = 0;
    while (k < kLevels && std::max(box.x1 - box.x0, box.y1 - box.y0) >> (k * kFanoutLog2) > kSpanAtStart) ++k;
    return sees(k, box, question.nearest, equal) ? Occlusion::visible : Occlusion::hidden;
  }

  // Not inlined: it needs the engine's floating-point state.
  template <typename Box>
  [[gnu::noinline]] static Status answer_all(const State* state, std::span<const Box> boxes, Occlusion* answers,
                                             bool equal) {
    if (!std::all_of(boxes.begin(), boxes.end(), [](const Box& box) { return legal(box); })) return Status::query_boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      answers[i] = state == nullptr ? Occlusion::outside
                                    : state->answer(question_of(boxes[i], state->sign(), state->target()), equal);
    }
    return Status::ok;
  }

  template <typename Box>
  static Status query(const State* state, std::span<const Box> boxes, std::span<Occlusion> answers, bool equal) {
    if (!is_exact_build()) return Status::bad_build;
    if (boxes.data() == nullptr && !boxes.empty()) return Status::query_boxes;
    if (answers.size() != boxes.size() || (answers.data() == nullptr && !answers.empty())) return Status::query_answers;
    const Bytes written(answers);
    if (written.overlaps(Bytes(boxes)) ||
        (state != nullptr && written.overlaps(Bytes(std::span(state->memory.get(), state->size))))) {
      return Status::target_overlap;
    }
    const FloatEnvironment environment;
    return answer_all(state, boxes, answers.data(), equal);
  }
};

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
  if (!is_exact_build()) return Status::bad_build;
  Target target;
  target.width = width, target.height = height, target.depth_test = depth_test;
  if (const Status status = validate(target, {}); status != Status::ok) return status;
  if (takes_equal(depth_test)) return Status::target_depth_test;  // V5
  std::unique_ptr<State> state = State::make(width, height, depth_test);
  if (state == nullptr) return Status::out_of_memory;
  delete std::exchange(state_, state.release());
  return Status::ok;
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
  return State::query(state_, boxes, answers, equal_is_visible_);
}

Status OcclusionBuffer::query(std::span<const OcclusionRectangle> rectangles,
                              std::span<Occlusion> answers) const noexcept {
  return State::query(state_, rectangles, answers, equal_is_visible_);
}

int OcclusionBuffer::width() const noexcept {
  return state_ == nullptr ? 0 : state_->width;
}

int OcclusionBuffer::height() const noexcept {
  return state_ == nullptr ? 0 : state_->height;
}

std::span<const float> OcclusionBuffer::depth() const noexcept {
  if (state_ == nullptr) return {};
  return {state_->levels[0].farthest, state_->pixels()};
}

}  // namespace surefill
