// SPDX-License-Identifier: Apache-2.0
#include "tiles.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <thread>

#include "bin.hpp"
#include "float_environment.hpp"
#include "triangle.hpp"

namespace surefill::fast {
namespace {

// A chunk: as many triangles as are sorted into bins at once.
constexpr std::uint32_t kChunkTriangles = 1u << 20;
constexpr std::size_t kChunkEntries = std::size_t{1} << 22;  // when a chunk has more, it ends with the slice
constexpr std::uint32_t kSliceTriangles = 1u << 14;          // at most; classified by one thread in one go

// Runs work(item, worker) for item = 0 .. items - 1 on up to `threads` threads, this one among them.
template <typename Work>
void parallel_for(int threads, std::size_t items, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&](int worker) {
    const FloatEnvironment environment;
    for (std::size_t item = next++; item < items; item = next++) work(item, worker);
  };

  std::thread others[kMaxThreads];
  const int wanted =
      static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(std::min(threads, kMaxThreads)), items));
  int started = 1;
  for (; started < wanted; ++started) {
    try {
      others[started] = std::thread(loop, started);
    } catch (...) {
      break;  // the threads that there are do the work
    }
  }
  loop(0);
  for (int i = 1; i < started; ++i) others[i].join();
}

struct alignas(64) AlignedBlock {
  std::byte bytes[64];
};

// Memory without exceptions, on cache lines.
template <typename T>
class Buffer {
 public:
  bool allocate(std::size_t size) {
    blocks_.reset(new (std::nothrow) AlignedBlock[size * sizeof(T) / 64 + 1]);
    return blocks_ != nullptr;
  }
  T* data() { return reinterpret_cast<T*>(blocks_.get()); }
  T& operator[](std::size_t i) { return data()[i]; }

 private:
  std::unique_ptr<AlignedBlock[]> blocks_;
};

// Bins that a triangle touches, both ends included; last_x < first_x if it is not drawn.
struct BinRange {
  std::uint8_t first_x, first_y, last_x, last_y;
};

// A run of triangles of one draw within a chunk.
struct Segment {
  std::size_t draw;
  std::uint32_t begin;         // position in the draw
  std::uint32_t first_number;  // number in the chunk
};

class Renderer {
 public:
  Renderer(const Target& target, std::span<const Draw> draws, int threads)
      : target_(target), draws_(draws), threads_(std::max(1, threads)), kernels_(kernels()) {
    for (const AttributeTarget& attribute : target.attributes) attributes_ |= !attribute.values.empty();
    shading_ = attributes_ || !target.barycentrics.empty();
    visibility_ = shading_ || !target.index.empty() || !target.depth.empty();
    for (const Draw& draw : draws) {
      triangles_ += draw.indices.size() / 3;
      visibility_ |= draw.depth_mode == DepthMode::clip;  // its counts depend on depth
    }
    bins_x_ = (target.width + kBinSize - 1) / kBinSize;
    bins_y_ = (target.height + kBinSize - 1) / kBinSize;
    greater_ = target.depth_test == DepthTest::greater;
  }

  Status render(Statistics& statistics) {
    const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
    const std::size_t chunk = std::min<std::size_t>(triangles_, kChunkTriangles);
    worker_statistics_.reset(new (std::nothrow) Statistics[static_cast<std::size_t>(threads_)]());
    segments_.reset(new (std::nothrow) Segment[draws_.size() + 1]);
    ordinals_.reset(new (std::nothrow) std::uint32_t[draws_.size() + 1]);
    bool ok = ranges_.allocate(chunk) && bin_begin_.allocate(bins + 1) && bin_next_.allocate(bins + 1) &&
              worker_statistics_ != nullptr && segments_ != nullptr && ordinals_ != nullptr;
    const std::size_t workers = static_cast<std::size_t>(threads_);
    if (ok && visibility_) {
      ok = depth_.allocate(workers * kBinSamples) && winner_.allocate(workers * kBinSamples) &&
           far_.allocate(workers * kBinBlocks);
    }
    if (ok && !target_.count.empty()) ok = count_.allocate(workers * kBinSamples);
    if (!ok) return Status::out_of_memory;
    std::uint32_t ordinal = 0;
    for (std::size_t i = 0; i < draws_.size(); ++i) {
      ordinals_[i] = ordinal;
      ordinal += static_cast<std::uint32_t>(draws_[i].indices.size() / 3);
    }
    ordinals_[draws_.size()] = kNoTriangle;

    bool first = true;
    std::size_t draw = 0;
    std::uint32_t position = 0;
    do {
      if (!take_chunk(draw, position)) return Status::out_of_memory;
      const bool last = draw == draws_.size();
      if (!last && first && visibility_) {  // the image has to be kept between chunks
        if (!kept_depth_.allocate(bins * kBinSamples) || !kept_winner_.allocate(bins * kBinSamples))
          return Status::out_of_memory;
        kept_ = true;
      }
      parallel_for(threads_, bins,
                   [&](std::size_t bin, int worker) { draw_bin(bin, static_cast<std::size_t>(worker), first, last); });
      first = false;
      if (last) break;
    } while (true);
    for (std::size_t i = 0; i < workers; ++i) add(statistics, worker_statistics_[i]);
    statistics.path = kernels_.name;
    return Status::ok;
  }

 private:
  static void add(Statistics& sum, const Statistics& part) {
    sum.triangles += part.triangles;
    sum.dropped += part.dropped;
    sum.degenerate += part.degenerate;
    sum.culled += part.culled;
    sum.outside += part.outside;
    sum.rasterized += part.rasterized;
    sum.signs_by_filter += part.signs_by_filter;
    sum.signs_by_residual += part.signs_by_residual;
    sum.signs_by_expansion += part.signs_by_expansion;
    sum.values_by_filter += part.values_by_filter;
    sum.values_by_expansion += part.values_by_expansion;
  }

  PixelBox limits_of(const Draw& draw) const {
    PixelBox limits{0, 0, target_.width, target_.height};
    if (draw.scissor) {
      limits = {std::max(limits.x0, draw.scissor->x0), std::max(limits.y0, draw.scissor->y0),
                std::min(limits.x1, draw.scissor->x1), std::min(limits.y1, draw.scissor->y1)};
    }
    return limits;
  }

  // Phase one for the triangles from (draw, position) on, until a chunk is full; moves (draw, position) behind it. Then
  // entries_ holds the chunk's triangles sorted by bin, in order within a bin: those of bin b are [bin_begin_[b],
  // bin_begin_[b + 1]).
  bool take_chunk(std::size_t& draw, std::uint32_t& position) {
    const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
    // A slice for each thread can add at most kChunkEntries, however large its triangles are.
    const auto per_thread = static_cast<std::uint32_t>(std::max<std::size_t>(
        kBatch, std::min<std::size_t>(kSliceTriangles, kChunkEntries / bins / static_cast<std::size_t>(threads_))));
    segment_count_ = 0;
    std::uint32_t number = 0;
    std::size_t entries = 0;
    while (draw < draws_.size() && number < kChunkTriangles && entries < kChunkEntries) {
      const auto triangles = static_cast<std::uint32_t>(draws_[draw].indices.size() / 3);
      const std::uint32_t slice =
          std::min({triangles - position, kChunkTriangles - number, per_thread * static_cast<std::uint32_t>(threads_)});
      if (segment_count_ == 0 || segments_[segment_count_ - 1].draw != draw) {
        segments_[segment_count_++] = {draw, position, number};
      }
      const std::uint32_t slices = (slice + per_thread - 1) / per_thread;
      const std::size_t d = draw;
      parallel_for(threads_, slices, [&](std::size_t s, int worker) {
        const auto begin = static_cast<std::uint32_t>(s) * per_thread;
        find_bins(draws_[d], position + begin, number + begin, std::min(per_thread, slice - begin),
                  worker_statistics_[static_cast<std::size_t>(worker)]);
      });
      for (std::uint32_t i = number; i < number + slice; ++i) {
        const BinRange& r = ranges_[i];
        if (r.first_x <= r.last_x)
          entries +=
              static_cast<std::size_t>(r.last_x - r.first_x + 1) * static_cast<std::size_t>(r.last_y - r.first_y + 1);
      }
      number += slice, position += slice;
      if (position == triangles) ++draw, position = 0;
    }
    segments_[segment_count_] = {draws_.size(), 0, number};

    std::fill(bin_begin_.data(), bin_begin_.data() + bins + 1, 0u);
    for_each_entry(number, [&](std::size_t bin, std::uint32_t, bool) { ++bin_begin_[bin + 1]; });
    for (std::size_t bin = 0; bin < bins; ++bin) bin_begin_[bin + 1] += bin_begin_[bin];
    if (entries > entry_capacity_) {
      entry_capacity_ = entries;
      if (!entries_.allocate(entries)) return false;
    }
    std::copy(bin_begin_.data(), bin_begin_.data() + bins, bin_next_.data());
    for_each_entry(number, [&](std::size_t bin, std::uint32_t n, bool home) {
      entries_[bin_next_[bin]++] = {n & 0x7FFFFFFFu, home};
    });
    return true;
  }

  template <typename Visit>
  void for_each_entry(std::uint32_t count, const Visit& visit) {
    for (std::uint32_t n = 0; n < count; ++n) {
      const BinRange r = ranges_[n];
      if (r.first_x > r.last_x) continue;
      for (std::size_t y = r.first_y; y <= r.last_y; ++y) {
        for (std::size_t x = r.first_x; x <= r.last_x; ++x)
          visit(y * static_cast<std::size_t>(bins_x_) + x, n, x == r.first_x && y == r.first_y);
      }
    }
  }

  void find_bins(const Draw& draw, std::uint32_t begin, std::uint32_t number, std::uint32_t count,
                 Statistics& statistics) {
    const PixelBox limits = limits_of(draw);
    const bool check_attributes = !draw.attributes.empty();
    for (std::uint32_t i = 0; i < count; i += kBatch) {
      PixelBox boxes[kBatch];
      const std::uint32_t lanes = std::min(kBatch, count - i);
      kernels_.find_boxes(draw, check_attributes, begin + i, lanes, limits, boxes, statistics);
      for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        const PixelBox& box = boxes[lane];
        BinRange& range = ranges_[number + i + lane];
        if (box.empty()) {
          range = {1, 1, 0, 0};
        } else {
          range = {static_cast<std::uint8_t>(box.x0 >> kBinLog2), static_cast<std::uint8_t>(box.y0 >> kBinLog2),
                   static_cast<std::uint8_t>((box.x1 - 1) >> kBinLog2),
                   static_cast<std::uint8_t>((box.y1 - 1) >> kBinLog2)};
        }
      }
    }
  }

  void draw_bin(std::size_t bin, std::size_t worker, bool first, bool last) {
    const int bin_x = static_cast<int>(bin % static_cast<std::size_t>(bins_x_)) * kBinSize;
    const int bin_y = static_cast<int>(bin / static_cast<std::size_t>(bins_x_)) * kBinSize;
    const PixelBox area{bin_x, bin_y, std::min(bin_x + kBinSize, target_.width),
                        std::min(bin_y + kBinSize, target_.height)};
    BinBuffers buffers;
    if (visibility_) {
      buffers.depth = kept_ ? kept_depth_.data() + bin * kBinSamples : depth_.data() + worker * kBinSamples;
      buffers.winner = kept_ ? kept_winner_.data() + bin * kBinSamples : winner_.data() + worker * kBinSamples;
      buffers.block_far = far_.data() + worker * kBinBlocks;
      if (first) load_depth(buffers, area);
      std::fill(buffers.block_far, buffers.block_far + kBinBlocks, std::numeric_limits<float>::infinity());
    }
    if (!target_.count.empty()) {
      buffers.count = count_.data() + worker * kBinSamples;
      std::fill(buffers.count, buffers.count + kBinSamples, 0u);
    }

    const BinEntry* entry = entries_.data() + bin_begin_[bin];
    const BinEntry* const end = entries_.data() + bin_begin_[bin + 1];
    for (std::size_t s = 0; s < segment_count_ && entry != end; ++s) {
      const Segment& segment = segments_[s];
      const std::uint32_t next = segments_[s + 1].first_number;
      const BinEntry* const stop = std::partition_point(entry, end, [next](BinEntry e) { return e.number < next; });
      const Draw& draw = draws_[segment.draw];
      const PixelBox limits = limits_of(draw);
      BinJob job;
      job.draw = &draw;
      job.chunk_begin = segment.begin - segment.first_number;  // modulo 2^32: the sum with a number is right
      job.first_ordinal = ordinals_[segment.draw];
      job.entries = {entry, stop};
      job.buffers = buffers;
      job.bin_x = bin_x, job.bin_y = bin_y;
      job.region = {std::max(area.x0, limits.x0), std::max(area.y0, limits.y0), std::min(area.x1, limits.x1),
                    std::min(area.y1, limits.y1)};
      job.greater = greater_;
      if (!job.region.empty() && entry != stop) kernels_.rasterize(job, worker_statistics_[worker]);
      entry = stop;
    }
    if (!target_.count.empty()) store_count(buffers, area, first);
    if (visibility_ && last) store_visibility(buffers, area, worker_statistics_[worker]);
  }

  std::size_t sample(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + static_cast<std::size_t>(x);
  }

  // Depth is kept so that smaller wins; what nothing beats is -inf.
  void load_depth(const BinBuffers& buffers, const PixelBox& area) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::fill(buffers.winner, buffers.winner + kBinSamples, kNoTriangle);
    const bool whole = area.x1 - area.x0 == kBinSize && area.y1 - area.y0 == kBinSize;
    std::fill(buffers.depth, buffers.depth + kBinSamples, whole ? kInfinity : -kInfinity);
    if (whole && target_.initial_depth.empty()) return;
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) {
        float z = kInfinity;
        if (!target_.initial_depth.empty()) {
          z = target_.initial_depth[sample(x, y)];
          z = std::isnan(z) ? -kInfinity : greater_ ? -z : z;
        }
        buffers.depth[bin_offset(x - area.x0, y - area.y0)] = z;
      }
    }
  }

  void store_count(const BinBuffers& buffers, const PixelBox& area, bool first) const {
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) {
        const std::uint32_t count = buffers.count[bin_offset(x - area.x0, y - area.y0)];
        target_.count[sample(x, y)] = first ? count : target_.count[sample(x, y)] + count;
      }
    }
  }

  void store_visibility(const BinBuffers& buffers, const PixelBox& area, Statistics& statistics) const {
    const float empty_depth =
        greater_ ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::infinity();
    Triangle triangle;
    std::uint32_t set_up = kNoTriangle;
    std::size_t draw = 0;
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t s = sample(x, y), offset = bin_offset(x - area.x0, y - area.y0);
        const std::uint32_t winner = buffers.winner[offset];
        if (winner == kNoTriangle) {
          if (!target_.depth.empty())
            target_.depth[s] = target_.initial_depth.empty() ? empty_depth : target_.initial_depth[s];
          if (!target_.index.empty()) target_.index[s] = kNoTriangle;
          if (shading_) clear_shading(s);
          continue;
        }
        if (!target_.depth.empty()) target_.depth[s] = greater_ ? 0.0f - buffers.depth[offset] : buffers.depth[offset];
        while (winner < ordinals_[draw]) --draw;
        while (winner >= ordinals_[draw + 1]) ++draw;
        const std::uint32_t position = winner - ordinals_[draw];
        const Draw& d = draws_[draw];
        if (!target_.index.empty())
          target_.index[s] = d.identifiers.empty() ? d.first_index + position : d.identifiers[position];
        if (!shading_) continue;
        if (winner != set_up) {
          const auto corner = [&](std::size_t i) { return d.vertices[d.indices[std::size_t{3} * position + i]]; };
          Statistics unused;
          triangle.set_up(corner(0), corner(1), corner(2), unused);
          set_up = winner;
        }
        shade(triangle, d, position, {x + 0.5, y + 0.5}, s, statistics);
      }
    }
  }

  void clear_shading(std::size_t s) const {
    for (std::size_t i = 0; i < 3 && !target_.barycentrics.empty(); ++i) target_.barycentrics[3 * s + i] = 0;
    for (const AttributeTarget& out : target_.attributes) {
      for (std::size_t c = 0; c < out.components && !out.values.empty(); ++c) out.values[s * out.components + c] = 0;
    }
  }

  void shade(Triangle& triangle, const Draw& draw, std::uint32_t position, SamplePosition p, std::size_t s,
             Statistics& statistics) const {
    if (!target_.barycentrics.empty()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
        target_.barycentrics[3 * s + i] = triangle.attribute(p, unit, Interpolation::perspective, statistics);
      }
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (out.values.empty()) continue;
      const AttributeArray& in = draw.attributes[k];
      const std::size_t stride = in.stride != 0 ? in.stride : in.components;
      for (std::size_t c = 0; c < out.components; ++c) {
        float u[3];
        for (std::size_t i = 0; i < 3; ++i) u[i] = in.values[draw.indices[std::size_t{3} * position + i] * stride + c];
        out.values[s * out.components + c] = triangle.attribute(p, u, in.interpolation, statistics);
      }
    }
  }

  const Target& target_;
  std::span<const Draw> draws_;
  int threads_;
  const Kernels& kernels_;
  bool attributes_ = false, shading_ = false, visibility_ = false, greater_ = false, kept_ = false;
  std::size_t triangles_ = 0;
  int bins_x_ = 0, bins_y_ = 0;

  std::unique_ptr<Statistics[]> worker_statistics_;
  std::unique_ptr<std::uint32_t[]> ordinals_;  // of each draw's first triangle
  std::unique_ptr<Segment[]> segments_;
  std::size_t segment_count_ = 0;
  Buffer<BinRange> ranges_;
  Buffer<std::uint32_t> bin_begin_, bin_next_;
  Buffer<BinEntry> entries_;
  std::size_t entry_capacity_ = 0;
  Buffer<float> depth_, far_, kept_depth_;
  Buffer<std::uint32_t> winner_, count_, kept_winner_;
};

}  // namespace

bool supports(const Target& target, std::span<const Draw> draws) {
  if (target.samples != 1) return false;
  std::size_t triangles = 0;
  for (const Draw& draw : draws) {
    if (!draw.depth_write || draw.grid || draw.conservative != Conservative::none) return false;
    triangles += draw.indices.size() / 3;
    if (triangles >= kNoTriangle) return false;
  }
  return true;
}

Status render(const Target& target, std::span<const Draw> draws, int threads, Statistics& statistics) noexcept {
  return Renderer(target, draws, threads).render(statistics);
}

}  // namespace surefill::fast
