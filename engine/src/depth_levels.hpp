// SPDX-License-Identifier: Apache-2.0
//
// What both occlusion buffers are: a depth image and, above it, levels of blocks, each 8 x 8 of the level below, that
// know their farthest depth; and queries (O2, O3, O5, O6). Inside, depth is a key that grows with distance: z, or -z for
// DepthTest::greater.
#ifndef SUREFILL_SRC_DEPTH_LEVELS_HPP
#define SUREFILL_SRC_DEPTH_LEVELS_HPP

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "build_check.hpp"
#include "exact/bounds.hpp"
#include "fast/patches.hpp"
#include "float_environment.hpp"
#include "overlap.hpp"
#include "surefill/occlusion.hpp"

namespace surefill {

constexpr float kFarthest = std::numeric_limits<float>::infinity();
constexpr int kFanoutLog2 = 3;   // a block is 8 x 8 of the level below
constexpr int kLevels = 5;       // level k has blocks of 8^k pixels; 8^5 > kMaxTargetSize
constexpr int kSpanAtStart = 4;  // a query starts at the level where its rectangle spans about so many blocks

using Pixels = fast::RectanglePixels;
using Question = fast::BoxQuestion;

// The questions of boxes or rectangles.
inline void ask(std::span<const OcclusionBox> boxes, float sign, Pixels which, PixelBox target, Question* questions) {
  fast::patch_kernels().ask(boxes[0].corners, boxes.size(), sign, which, target, questions);
}

inline void ask(std::span<const OcclusionRectangle> rectangles, float sign, Pixels which, PixelBox target,
                Question* questions) {
  const double offset = which == Pixels::met ? 0 : 0.5;
  for (const OcclusionRectangle& r : rectangles) {
    Question& question = *questions++ = {{0, 0, 0, 0}, sign * r.nearest_depth};
    if (!(r.x0 <= r.x1 && r.y0 <= r.y1)) continue;
    Reach x{r.x0, r.x1}, y{r.y0, r.y1};
    if (which == Pixels::met) x.low = std::floor(x.low), y.low = std::floor(y.low);
    question.pixels = target;
    clip_to_reach(x, offset, offset, &question.pixels.x0, &question.pixels.x1);
    clip_to_reach(y, offset, offset, &question.pixels.y0, &question.pixels.y1);
  }
}

inline bool are_legal(std::span<const OcclusionBox> boxes) {
  return boxes.empty() ||
         fast::patch_kernels().finite(&boxes[0].corners[0].x, boxes.size() * (sizeof boxes[0] / sizeof(float)));
}

inline bool is_legal(const OcclusionRectangle& r) {
  return !std::isnan(r.x0) && !std::isnan(r.y0) && !std::isnan(r.x1) && !std::isnan(r.y1) &&
         !std::isnan(r.nearest_depth);
}

inline bool are_legal(std::span<const OcclusionRectangle> rectangles) {
  return std::all_of(rectangles.begin(), rectangles.end(), is_legal);
}

struct DepthLevels {
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

  // False if there is no memory.
  bool allocate(int pixels_wide, int pixels_high, DepthTest depth_test) {
    width = pixels_wide, height = pixels_high, test = depth_test;
    std::size_t offset[kLevels + 1], total = 0;
    int w = width, h = height;
    for (int k = 0; k <= kLevels; ++k) {
      levels[k] = {w, h, nullptr};
      offset[k] = total;
      total += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
      w = ((w - 1) >> kFanoutLog2) + 1, h = ((h - 1) >> kFanoutLog2) + 1;
    }
    memory.reset(new (std::nothrow) float[total]);
    size = total;
    if (memory == nullptr) return false;
    for (int k = 0; k <= kLevels; ++k) levels[k].farthest = memory.get() + offset[k];
    clear();
    return true;
  }

  void clear() {
    std::fill_n(levels[0].farthest, pixels(), sign() * kFarthest);
    for (int k = 1; k <= kLevels; ++k) {
      const Level& level = levels[k];
      std::fill_n(level.farthest, static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height),
                  kFarthest);
    }
  }

  // Each block's farthest key, from the level below.
  void build() {
    constexpr int kFanout = 1 << kFanoutLog2;
    const auto largest_of_blocks = fast::patch_kernels().largest_of_blocks;
    for (int k = 1; k <= kLevels; ++k) {
      const Level &below = levels[k - 1], &level = levels[k];
      const auto stride = static_cast<std::size_t>(below.width);
      for (int y = 0; y < level.height; ++y) {
        largest_of_blocks(below.farthest + static_cast<std::size_t>(y * kFanout) * stride, stride,
                          std::min(kFanout, below.height - y * kFanout), below.width, k == 1 ? sign() : 1.0f,
                          level.farthest + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width));
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
  [[gnu::noinline]] static Status answer_all(const DepthLevels* state, std::span<const Box> boxes, Occlusion* answers,
                                             Pixels which, bool equal) {
    if (!are_legal(boxes)) return Status::query_boxes;
    if (state == nullptr) {
      std::fill_n(answers, boxes.size(), Occlusion::outside);
      return Status::ok;
    }
    constexpr std::size_t kAtOnce = 64;
    Question questions[kAtOnce];
    for (std::size_t i = 0; i < boxes.size(); i += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, boxes.size() - i);
      ask(boxes.subspan(i, count), state->sign(), which, state->target(), questions);
      for (std::size_t n = 0; n < count; ++n) answers[i + n] = state->answer(questions[n], equal);
    }
    return Status::ok;
  }

  template <typename Box>
  static Status query(const DepthLevels* state, std::span<const Box> boxes, std::span<Occlusion> answers, Pixels which,
                      bool equal) {
    if (!is_exact_build()) return Status::bad_build;
    if (boxes.data() == nullptr && !boxes.empty()) return Status::query_boxes;
    if (answers.size() != boxes.size() || (answers.data() == nullptr && !answers.empty())) return Status::query_answers;
    const Bytes written(answers);
    if (written.overlaps(Bytes(boxes)) ||
        (state != nullptr && written.overlaps(Bytes(std::span(state->memory.get(), state->size))))) {
      return Status::target_overlap;
    }
    const FloatEnvironment environment;
    return answer_all(state, boxes, answers.data(), which, equal);
  }

  // Another size, in place of *state, which may be null and is kept where the status is not ok. `T` is DepthLevels with what
  // a buffer has beside it.
  template <typename T>
  static Status resize(T*& state, int width, int height, DepthTest test) {
    if (!is_exact_build()) return Status::bad_build;
    Target target;
    target.width = width, target.height = height, target.depth_test = test;
    if (const Status status = validate(target, {}); status != Status::ok) return status;
    if (takes_equal(test)) return Status::target_depth_test;  // V5
    std::unique_ptr<T> made(new (std::nothrow) T);
    if (made == nullptr || !made->allocate(width, height, test)) return Status::out_of_memory;
    delete std::exchange(state, made.release());
    return Status::ok;
  }

  static std::span<const float> depth(const DepthLevels* state) {
    if (state == nullptr) return {};
    return {state->levels[0].farthest, state->pixels()};
  }
};

}  // namespace surefill

#endif  // SUREFILL_SRC_DEPTH_LEVELS_HPP
