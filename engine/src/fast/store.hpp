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

  // A row of cells at a time, one output after the other: what is read stays in the first cache, and a processor holds
  // few pages that it writes to.
  void run() {
    const int y0 = tiles_.row * kTileSize, y1 = std::min(y0 + kTileSize, target_.height);
    for (int y = y0; y < y1; y += kCellSize) {
      const int end = std::min(y + kCellSize, y1);
      if (!target_.count.empty()) each_row(y, end, [this](bool open) { open ? count() : fill(target_.count, 0u); });
      if (!target_.depth.empty()) each_row(y, end, [this](bool open) { open ? depth() : empty_depths(); });
      if (!target_.index.empty())
        each_row(y, end, [this](bool open) { open ? index() : fill(target_.index, kNoTriangle); });
    }
  }

 private:
  // write(open) for each tile's part of the rows [begin, end): where something was drawn, and where not.
  template <typename Write>
  void each_row(int begin, int end, const Write& write) {
    for (int column = tiles_.begin; column < tiles_.end; ++column) {
      for (int y = begin; y < end; ++y) {
        const int x = column * kTileSize;
        columns_ = static_cast<std::size_t>(std::min(kTileSize, target_.width - x));
        at_ = frame_.sample_index(x, y), offset_ = tiles_.offset(x, y);
        write(tiles_.is_open(column));
      }
    }
  }

  template <typename T>
  void fill(std::span<T> out, T value) const {
    if (samples_ == 1) {
      std::fill_n(&out[at_], columns_, value);
      return;
    }
    for (std::size_t n = 0; n < columns_; ++n) out[at_ + n * samples_] = value;
  }
  void empty_depths() const {
    const auto& initial = target_.initial_depth;
    if (initial.empty()) {
      fill(target_.depth, empty_depth(target_.depth_test));
    } else if (samples_ == 1) {
      std::memmove(&target_.depth[at_], &initial[at_], columns_ * sizeof(float));
    } else {
      for (std::size_t at = at_; at < at_ + columns_ * samples_; at += samples_) target_.depth[at] = initial[at];
    }
  }

  // Writes a row of a tile to `out`: value(v, at) of each sample's v, at the index `at`. Four columns are neighbours.
  template <typename T, typename Value>
  void row(const T* tile, std::span<T> out, const Value& value) const {
    samples_ == 1 ? row_of<T, 1>(tile, out.data(), value) : row_of<T, 0>(tile, out.data(), value);
  }
  // kSamples: of a pixel, 0 if that is not known before.
  template <typename T, std::size_t kSamples, typename Value>
  void row_of(const T* tile, T* out, const Value& value) const {
    const std::size_t samples = kSamples != 0 ? kSamples : samples_, columns = columns_, begin = at_;
    const T* const from = tile + offset_;
    const auto four = [=](std::size_t cell, auto n) {
      T values[4] = {};
      const std::size_t at = begin + 4 * cell * samples;
      std::memcpy(values, from + (cell >> 2) * kAreaSamples + (cell & 3) * kCellSamples, n * sizeof(T));
      for (std::size_t i = 0; i < n; ++i) values[i] = value(values[i], at + i * samples);
      if (kSamples == 1) {
        std::memcpy(&out[at], values, n * sizeof(T));
      } else {
        for (std::size_t i = 0; i < n; ++i) out[at + i * samples] = values[i];
      }
    };
    for (std::size_t cell = 0; cell < columns / 4; ++cell) four(cell, std::integral_constant<std::size_t, 4>());
    if (columns % 4 != 0) four(columns / 4, columns % 4);
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
  const std::size_t samples_;        // of a pixel
  std::size_t columns_ = 0;          // of the tile at hand
  std::size_t at_ = 0, offset_ = 0;  // where the row at hand begins: in the buffers, in the tiles
  std::size_t draw_ = 0;             // that was seen last
};

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_STORE_HPP
