// SPDX-License-Identifier: Apache-2.0
//
// Tiles into the caller's buffers: counts, depth and index.
#ifndef SUREFILL_SRC_FAST_STORE_HPP
#define SUREFILL_SRC_FAST_STORE_HPP

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "fast/tile.hpp"

namespace surefill::fast {

class Store {
 public:
  Store(const FrameJob& frame, const TileRow& tiles)
      : frame_(frame),
        target_(*frame.target),
        tiles_(tiles),
        samples_(static_cast<std::size_t>(frame.target->samples)) {}

  void run() {
    const int y0 = tiles_.row * kTileSize, y1 = std::min(y0 + kTileSize, target_.height);
    for (int column = tiles_.begin; column < tiles_.end; ++column) {
      x_ = column * kTileSize;
      columns_ = static_cast<std::size_t>(std::min(kTileSize, target_.width - x_));
      for (int y = y0; y < y1; ++y) {
        at_ = frame_.sample_index(x_, y);
        if (!tiles_.is_open(column)) {
          empty();
          continue;
        }
        offset_ = tiles_.offset(x_, y);
        if (!target_.count.empty()) count();
        if (!target_.depth.empty()) depth();
        if (!target_.index.empty()) index();
      }
    }
  }

 private:
  // A row of a tile that nothing was drawn to.
  void empty() const {
    const float far = empty_depth(target_.depth_test);
    const bool initial = !target_.initial_depth.empty();
    if (samples_ == 1) {
      if (!target_.count.empty()) std::fill_n(&target_.count[at_], columns_, 0u);
      if (!target_.index.empty()) std::fill_n(&target_.index[at_], columns_, kNoTriangle);
      if (!target_.depth.empty() && !initial) std::fill_n(&target_.depth[at_], columns_, far);
      if (!target_.depth.empty() && initial)
        std::memmove(&target_.depth[at_], &target_.initial_depth[at_], columns_ * sizeof(float));
      return;
    }
    for (std::size_t at = at_; at < at_ + columns_ * samples_; at += samples_) {
      if (!target_.count.empty()) target_.count[at] = 0;
      if (!target_.index.empty()) target_.index[at] = kNoTriangle;
      if (!target_.depth.empty()) target_.depth[at] = initial ? target_.initial_depth[at] : far;
    }
  }

  // Writes a row of a tile to `out`: value(v, at) of each sample's v, at the index `at`. Four columns are neighbours.
  template <typename T, typename Value>
  void row(const T* tile, std::span<T> out, const Value& value) const {
    const T* from = tile + offset_;
    std::size_t at = at_;
    const auto four = [&](auto n) {
      if (samples_ == 1) {
        T values[4];
        for (std::size_t i = 0; i < n; ++i) values[i] = value(from[i], at + i);
        std::memcpy(&out[at], values, n * sizeof(T));
      } else {
        for (std::size_t i = 0; i < n; ++i) out[at + i * samples_] = value(from[i], at + i * samples_);
      }
    };
    std::size_t left = columns_;
    for (std::size_t cell = 0; left >= 4; left -= 4, ++cell) {
      from = tile + offset_ + (cell >> 2) * kAreaSamples + (cell & 3) * kCellSamples;
      four(std::integral_constant<std::size_t, 4>());
      at += 4 * samples_;
    }
    if (left == 0) return;
    const std::size_t cell = columns_ / 4;
    from = tile + offset_ + (cell >> 2) * kAreaSamples + (cell & 3) * kCellSamples;
    four(left);
  }

  void count() const {
    row(tiles_.count, target_.count, [](std::uint32_t v, std::size_t) { return v; });
  }

  void depth() const {
    const bool greater = frame_.greater();
    if (!target_.initial_depth.empty()) {
      row(tiles_.depth, target_.depth, [&](float v, std::size_t at) {  // what no fragment has beaten keeps its bits
        const float before = target_.initial_depth[at];
        return v == kept_depth(target_, before) ? before : greater ? 0.0f - v : v;
      });
    } else if (greater) {
      row(tiles_.depth, target_.depth, [](float v, std::size_t) { return 0.0f - v; });
    } else {
      row(tiles_.depth, target_.depth, [](float v, std::size_t) { return v; });
    }
  }

  void index() {
    const Draw& first = *frame_.draws[0].draw;
    if (frame_.draws.size() == 1 && first.identifiers.empty()) {
      row(tiles_.winner, target_.index,
          [begin = first.first_index](std::uint32_t v, std::size_t) { return v + (v == kNoTriangle ? 0 : begin); });
      return;
    }
    row(tiles_.winner, target_.index, [this](std::uint32_t v, std::size_t) {
      if (v == kNoTriangle) return kNoTriangle;
      draw_ = frame_.draw_of(v, draw_);
      const DrawJob& job = frame_.draws[draw_];
      return index_of(*job.draw, v - job.first_ordinal);
    });
  }

  const FrameJob& frame_;
  const Target& target_;
  const TileRow& tiles_;
  const std::size_t samples_;  // of a pixel
  int x_ = 0;                  // of the tile at hand
  std::size_t columns_ = 0;
  std::size_t at_ = 0, offset_ = 0;  // where the row at hand begins: in the buffers, in the tiles
  std::size_t draw_ = 0;             // that was seen last
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_STORE_HPP
