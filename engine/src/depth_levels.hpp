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
#include "float_environment.hpp"
#include "overlap.hpp"
#include "surefill/occlusion.hpp"

namespace surefill {

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
inline float rounded_quotient(float a, float w) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::clamp(a / w, -kLargest, kLargest);
}

// Which pixels a rectangle has: those whose centre lies in it (O2), or whose half-open square meets it (O5).
enum class Pixels { with_centre, met };

// The pixels of the target that the closed rectangle has. The ends are exact where it matters: see question_of.
inline PixelBox pixels_of(Reach x, Reach y, Pixels which, PixelBox target) {
  if (which == Pixels::met) x.low = std::floor(x.low), y.low = std::floor(y.low);
  const double offset = which == Pixels::met ? 0 : 0.5;
  clip_to_reach(x, offset, offset, &target.x0, &target.x1);
  clip_to_reach(y, offset, offset, &target.y0, &target.y1);
  return target;
}

// The quotients are rounded to double, and compared with pixel centres and corners exactly nevertheless: X and c W are
// numbers of 24 and 39 bits, so if X / W differs from the place c, it does by more than 2^-40 of c.
inline Question question_of(const OcclusionBox& box, float sign, Pixels which, PixelBox target) {
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
  return {pixels_of(x, y, which, target), nearest};
}

inline Question question_of(const OcclusionRectangle& r, float sign, Pixels which, PixelBox target) {
  if (!(r.x0 <= r.x1 && r.y0 <= r.y1)) return {};
  return {pixels_of({r.x0, r.x1}, {r.y0, r.y1}, which, target), sign * r.nearest_depth};
}

inline bool legal(const OcclusionBox& box) {
  return std::all_of(std::begin(box.corners), std::end(box.corners), [](const Vertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  });
}

inline bool legal(const OcclusionRectangle& r) {
  return !std::isnan(r.x0) && !std::isnan(r.y0) && !std::isnan(r.x1) && !std::isnan(r.y1) &&
         !std::isnan(r.nearest_depth);
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
  [[gnu::noinline]] static Status answer_all(const DepthLevels* state, std::span<const Box> boxes, Occlusion* answers,
                                             Pixels which, bool equal) {
    if (!std::all_of(boxes.begin(), boxes.end(), [](const Box& box) { return legal(box); })) return Status::query_boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      answers[i] = state == nullptr
                       ? Occlusion::outside
                       : state->answer(question_of(boxes[i], state->sign(), which, state->target()), equal);
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
