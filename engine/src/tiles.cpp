// SPDX-License-Identifier: Apache-2.0
#include "tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "canvas.hpp"
#include "culling.hpp"
#include "team.hpp"

namespace surefill::fast {
namespace {

// So many batches are set up and then drawn: they stay in the first caches.
constexpr std::size_t kChunkBatches = 16;

// Samples of a canvas, of 12 bytes each, that is not drawn in halves. The mutants' suite, whose frames are small, has
// it otherwise.
#if defined(SUREFILL_LARGEST_WHOLE)
constexpr std::size_t kLargestWhole = SUREFILL_LARGEST_WHOLE;
#else
constexpr std::size_t kLargestWhole = std::size_t{1} << 23;
#endif

// Memory without exceptions, on cache lines; large pieces on large pages, where the system has them: triangles are
// drawn all over the image.
template <typename T>
class Buffer {
 public:
  bool allocate(std::size_t size) {
    constexpr std::size_t kLargePage = std::size_t{1} << 21;
    const std::size_t bytes = size * sizeof(T);
    const std::size_t alignment = bytes >= kLargePage ? kLargePage : 64;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    data_.reset(static_cast<T*>(std::aligned_alloc(alignment, rounded)));
#if defined(__linux__)
    if (data_ != nullptr && alignment == kLargePage) madvise(data_.get(), rounded, MADV_HUGEPAGE);
#endif
    return data_ != nullptr;
  }
  T* data() {
    return data_.get();
  }
  T& operator[](std::size_t i) {
    return data_[i];
  }

 private:
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  std::unique_ptr<T[], Free> data_;
};

class Renderer {
 public:
  // The visitor may be null.
  Renderer(const Target& target, std::span<const Draw> draws, const CoverageVisitor* visitor, const Options& options)
      : target_(target),
        draws_(draws),
        visitor_(visitor),
        threads_(std::min(options.threads, (target.height + kTileSize - 1) >> kTileLog2)),  // a band is drawn by one
        team_(threads_, options.executor) {
    for (const AttributeTarget& attribute : target.attributes) attributes_ |= !attribute.values.empty();
    shading_ = attributes_ || !target.barycentrics.empty();
    visibility_ = shading_ || !target.index.empty();
    depth_ = visibility_ || !target.depth.empty();
    for (const Draw& draw : draws) {
      // Its counts depend on depth; or depth alone does not say what is empty.
      if (draw.depth_mode == DepthMode::clip || (!draw.depth_write && depth_)) visibility_ = depth_ = true;
    }
    counts_ = !target.count.empty() || visitor != nullptr;
    if (depth_ && counts_) visibility_ = true;
    greater_ = target.depth_test == DepthTest::greater;
    canvas_.tiles_x = (target.width + kTileSize - 1) >> kTileLog2;
    canvas_.tiles_y = (target.height + kTileSize - 1) >> kTileLog2;
    // Half a canvas with all three buffers is smaller than a whole one with two.
    const bool halves =
        visibility_ && !target.count.empty() && target.samples == 1 && canvas_.samples() > kLargestWhole;
    strip_ = halves ? (canvas_.tiles_y + 1) / 2 : canvas_.tiles_y;
  }

  Status render(Statistics& statistics) {
    if (!allocate()) return Status::out_of_memory;
    for (int n = 0; n < target_.samples; ++n) {
      const SampleLocation location = sample_location(target_.samples, n);
      sample_number_ = static_cast<std::size_t>(n);
      sample_ = {location.x / 16.0, location.y / 16.0};
      for (std::size_t draw = 0; draw < draws_.size(); ++draw) jobs_[draw] = job_of(draw);
      for (int begin = 0; begin < canvas_.tiles_y; begin += strip_)
        render_strip(begin, std::min(begin + strip_, canvas_.tiles_y));
      if (n == 0) {
        for (std::size_t i = 0; i < slots(); ++i) add_triangles(statistics, statistics_[i]);
      }
    }
    for (std::size_t i = 0; i < slots(); ++i) add_rungs(statistics, statistics_[i]);
    statistics.path = kernels_.name;
    return Status::ok;
  }

 private:
  bool allocate() {
    const std::size_t blocks = canvas_.blocks();
    const std::size_t samples = static_cast<std::size_t>(canvas_.tiles_x) * static_cast<std::size_t>(strip_) * 64 * 64;
    // A region of 8 x 8 blocks may begin at the last one.
    const std::size_t beyond = 8 * static_cast<std::size_t>(canvas_.blocks_x()) + 16;
    jobs_.reset(new (std::nothrow) DrawJob[draws_.size()]);
    statistics_.reset(new (std::nothrow) Statistics[slots()]());
    bool ok = jobs_ != nullptr && statistics_ != nullptr &&
              batches_.allocate(kChunkBatches * static_cast<std::size_t>(threads_));
    if (ok && depth_) {
      ok = depth_buffer_.allocate(samples) && block_far_.allocate(blocks + beyond) &&
           tile_far_.allocate(canvas_.far_of(0, kTileSize * canvas_.tiles_y));
    }
    ok = ok && column_.allocate(2 * static_cast<std::size_t>(canvas_.blocks_x())) &&
         row_.allocate(16 * static_cast<std::size_t>(canvas_.tiles_y));
    if (ok && visibility_) ok = winner_.allocate(samples);
    if (ok && !target_.count.empty()) ok = count_.allocate(samples);
    if (ok && visitor_ != nullptr)
      ok = masks_.allocate(blocks) && marked_.allocate(blocks * static_cast<std::size_t>(threads_));
    ok = ok && untouched_.allocate(blocks / 64);
    if (!ok) return false;
    if (visitor_ != nullptr) std::fill(masks_.data(), masks_.data() + blocks, std::uint64_t{0});
    canvas_.masks = masks_.data(), canvas_.marked = marked_.data(), canvas_.visitor = visitor_;
    canvas_.untouched = untouched_.data(), canvas_.renderer = this;
    canvas_.touch = [](const void* renderer, std::size_t tile) { static_cast<const Renderer*>(renderer)->touch(tile); };
    canvas_.depth = depth_buffer_.data(), canvas_.block_far = block_far_.data(), canvas_.tile_far = tile_far_.data();
    canvas_.winner = winner_.data(), canvas_.count = count_.data();
    for (int c = 0; c < 2 * canvas_.blocks_x(); ++c)
      column_[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>((c >> 1) * 64 + (c & 1) * 16);
    canvas_.column = column_.data(), canvas_.row = row_.data();
    if (depth_) std::fill(canvas_.block_far + blocks, canvas_.block_far + blocks + beyond, 0.0f);
    return true;
  }

  // The bands [begin, end), a thread's share at a time.
  void render_strip(int begin, int end) {
    for (int r = 0; r < 16 * canvas_.tiles_y; ++r) {
      row_[static_cast<std::size_t>(r)] =
          static_cast<std::uint32_t>(((r >> 1) - 8 * begin) * canvas_.blocks_x() * 64 + (r & 1) * 32);
    }
    const auto bands = static_cast<std::size_t>(end - begin);
    team_.run(bands, [&](std::size_t band) { clear(begin + static_cast<int>(band)); });
    team_.run(static_cast<std::size_t>(threads_), [&](std::size_t set) {
      draw_bands(BandSet(static_cast<int>(set), threads_, begin, end, canvas_.tiles_y));
    });
    team_.run(bands, [&](std::size_t band) { store(begin + static_cast<int>(band)); });
  }

  std::size_t slots() const { return static_cast<std::size_t>(std::max(threads_, canvas_.tiles_y)); }

  static void add_triangles(Statistics& sum, const Statistics& part) {
    sum.triangles += part.triangles;
    sum.dropped += part.dropped;
    sum.degenerate += part.degenerate;
    sum.culled += part.culled;
    sum.outside += part.outside;
    sum.rasterized += part.rasterized;
    sum.small += part.small;
    sum.medium += part.medium;
    sum.large += part.large;
    sum.clipped += part.clipped;
    sum.skipped_draws += part.skipped_draws;
  }
  static void add_rungs(Statistics& sum, const Statistics& part) {
    sum.signs_by_filter += part.signs_by_filter;
    sum.signs_by_residual += part.signs_by_residual;
    sum.signs_by_expansion += part.signs_by_expansion;
    sum.values_by_filter += part.values_by_filter;
    sum.values_by_expansion += part.values_by_expansion;
  }

  // ---- triangles
  DrawJob job_of(std::size_t draw) const {
    PixelBox region{0, 0, target_.width, target_.height};
    if (const auto& scissor = draws_[draw].scissor) {
      region = {std::max(region.x0, scissor->x0), std::max(region.y0, scissor->y0), std::min(region.x1, scissor->x1),
                std::min(region.y1, scissor->y1)};
      if (region.empty()) region = {};
    }
    const std::uint32_t ordinal =
        draw == 0 ? 0 : jobs_[draw - 1].first_ordinal + static_cast<std::uint32_t>(draws_[draw - 1].indices.size() / 3);
    return {&draws_[draw],
            ordinal,
            region,
            sample_,
            tie_shift(draws_[draw].fill_rule),
            depth_,
            greater_,
            static_cast<std::uint32_t>(draw),
            static_cast<int>(sample_number_)};
  }

  // All triangles into the bands of one set. Each thread sets up those it needs for itself: that costs less than
  // passing what is set up from one core's cache to another's.
  void draw_bands(const BandSet& bands) {
    const auto piece = static_cast<std::size_t>(bands.thread);
    Statistics counted;  // its own: threads write to it all the time
    Batch* const batches = &batches_[piece * kChunkBatches];
    for (std::size_t d = 0; d < draws_.size(); ++d) {
      const auto triangles = static_cast<std::uint32_t>(draws_[d].indices.size() / 3);
      if (skips(jobs_[d], bands)) {
        if (!bands.first) continue;
        ++counted.skipped_draws;
        counted.triangles += triangles;
        counted.outside += triangles;
        continue;
      }
      for (std::uint32_t first = 0; first < triangles;) {
        std::size_t n = 0;
        for (; n < kChunkBatches && first < triangles; ++n) {
          const std::uint32_t count = std::min(kBatch, triangles - first);
          kernels_.set_up(jobs_[d], bands, first, count, batches[n], counted);
          first += count;
        }
        kernels_.rasterize(jobs_[d], {batches, n}, canvas_, bands, counted);
      }
    }
    add_triangles(statistics_[piece], counted);
    add_rungs(statistics_[piece], counted);
  }

  bool skips(const DrawJob& job, const BandSet& bands) const {
    const auto& box = job.draw->culling_box;
    if (!box) return false;
    return is_outside(*box, *job.draw, job.region) || (depth_ && !counts_ && is_hidden(*box, job, canvas_, bands));
  }

  // ---- the canvas, a band at a time
  std::size_t sample_index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(target_.samples) +
           sample_number_;
  }

  // Depth is kept so that smaller wins; what nothing beats is -inf.
  float kept_depth(float z) const {
    return std::isnan(z) ? -std::numeric_limits<float>::infinity() : greater_ ? -z : z;
  }

  void clear(int band) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::size_t tiles = static_cast<std::size_t>(canvas_.tiles_x);
    const std::size_t begin = static_cast<std::size_t>(band) * tiles, end = begin + tiles;
    std::fill(canvas_.untouched + begin, canvas_.untouched + end, std::uint8_t{1});
    if (!depth_) return;
    std::fill(canvas_.block_far + begin * 64, canvas_.block_far + end * 64, kInfinity);
    const int y = band * kTileSize;
    std::fill(canvas_.tile_far + canvas_.far_of(0, y), canvas_.tile_far + canvas_.far_of(0, y + kTileSize), kInfinity);
  }

  // The empty image, in one tile.
  void touch(std::size_t tile) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    canvas_.untouched[tile] = 0;
    const auto tiles_x = static_cast<std::size_t>(canvas_.tiles_x);
    const int x0 = static_cast<int>(tile % tiles_x) * kTileSize, y0 = static_cast<int>(tile / tiles_x) * kTileSize;
    for (int y = y0; y < y0 + kTileSize; y += 8) {  // a row of blocks
      const std::size_t begin = canvas_.offset_of(x0, y), end = begin + 8 * kTileSize;
      if (canvas_.count != nullptr) std::fill(canvas_.count + begin, canvas_.count + end, 0u);
      if (canvas_.winner != nullptr) std::fill(canvas_.winner + begin, canvas_.winner + end, kNoTriangle);
      if (depth_) std::fill(canvas_.depth + begin, canvas_.depth + end, kInfinity);
    }
    const bool initial = !target_.initial_depth.empty();
    if (!depth_ || (!initial && x0 + kTileSize <= target_.width && y0 + kTileSize <= target_.height)) return;
    for (int y = y0; y < y0 + kTileSize; ++y) {
      for (int x = x0; x < x0 + kTileSize; ++x) {
        float& depth = canvas_.depth[canvas_.offset_of(x, y)];
        if (x >= target_.width || y >= target_.height) {
          depth = -kInfinity;
        } else if (initial) {
          depth = kept_depth(target_.initial_depth[sample_index(x, y)]);
        }
      }
    }
  }

  void store(int band) {
    const int y1 = std::min((band + 1) * kTileSize, target_.height);
    for (int x = 0; x < target_.width; x += kTileSize) {
      const std::size_t tile = canvas_.tile_of(x, band * kTileSize);
      const Columns columns{x, std::min(x + kTileSize, target_.width)};
      for (int y = band * kTileSize; y < y1; ++y) {
        if (canvas_.untouched[tile] != 0) {
          store_empty(y, columns);
          continue;
        }
        if (!target_.count.empty()) store_count(y, columns);
        if (!target_.depth.empty()) store_depth(y, columns);
        if (!target_.index.empty()) store_index(y, columns);
      }
    }
    if (!shading_) return;
    const ShadeJob job{&target_, {jobs_.get(), draws_.size()}, sample_number_};
    kernels_.shade(job, canvas_, band * kTileSize, y1, statistics_[static_cast<std::size_t>(band)]);
  }

  struct Columns {
    int begin, end;
  };

  void store_empty(int y, Columns columns) const {
    const auto samples = static_cast<std::size_t>(target_.samples);
    const std::size_t begin = sample_index(columns.begin, y);
    const auto n = static_cast<std::size_t>(columns.end - columns.begin);
    const float far = (greater_ ? -1 : 1) * std::numeric_limits<float>::infinity();
    const bool initial = !target_.initial_depth.empty();
    if (samples == 1) {
      if (!target_.count.empty()) std::fill_n(&target_.count[begin], n, 0u);
      if (!target_.index.empty()) std::fill_n(&target_.index[begin], n, kNoTriangle);
      if (!target_.depth.empty() && !initial) std::fill_n(&target_.depth[begin], n, far);
      if (!target_.depth.empty() && initial)
        std::memmove(&target_.depth[begin], &target_.initial_depth[begin], n * sizeof(float));
      return;
    }
    for (std::size_t at = begin; at < begin + n * samples; at += samples) {
      if (!target_.count.empty()) target_.count[at] = 0;
      if (!target_.index.empty()) target_.index[at] = kNoTriangle;
      if (!target_.depth.empty()) target_.depth[at] = initial ? target_.initial_depth[at] : far;
    }
  }

  // visit(offset, index, n) for the row's samples, four columns at a time: n of them lie at `offset` of the canvas.
  template <typename Visit>
  void for_each_four(int y, Columns columns, const Visit& visit) const {
    for (int x = columns.begin; x < columns.end; x += 4)
      visit(canvas_.offset_of(x, y), sample_index(x, y), static_cast<std::size_t>(std::min(4, columns.end - x)));
  }

  void store_count(int y, Columns columns) const {
    const auto samples = static_cast<std::size_t>(target_.samples);
    for_each_four(y, columns, [&](std::size_t offset, std::size_t at, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) target_.count[at + i * samples] = canvas_.count[offset + i];
    });
  }

  void store_depth(int y, Columns columns) const {
    const auto samples = static_cast<std::size_t>(target_.samples);
    const bool initial = !target_.initial_depth.empty();
    for_each_four(y, columns, [&](std::size_t offset, std::size_t at, std::size_t n) {
      const float* const depth = canvas_.depth + offset;
      float* const out = &target_.depth[at];
      if (initial) {
        for (std::size_t i = 0; i < n; ++i) {  // what no fragment has beaten keeps its bits
          const float before = target_.initial_depth[at + i * samples];
          out[i * samples] = depth[i] == kept_depth(before) ? before : greater_ ? 0.0f - depth[i] : depth[i];
        }
      } else if (n == 4 && samples == 1 && !greater_) {
        std::memcpy(out, depth, 4 * sizeof(float));
      } else {
        for (std::size_t i = 0; i < n; ++i) out[i * samples] = greater_ ? 0.0f - depth[i] : depth[i];
      }
    });
  }

  void store_index(int y, Columns columns) const {
    const auto samples = static_cast<std::size_t>(target_.samples);
    if (draws_.size() == 1 && draws_[0].identifiers.empty()) {
      const std::uint32_t first = draws_[0].first_index;
      for_each_four(y, columns, [&](std::size_t offset, std::size_t at, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) {
          const std::uint32_t winner = canvas_.winner[offset + i];
          target_.index[at + i * samples] = winner == kNoTriangle ? kNoTriangle : first + winner;
        }
      });
      return;
    }
    std::size_t draw = 0;
    for_each_four(y, columns, [&](std::size_t offset, std::size_t at, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t winner = canvas_.winner[offset + i];
        std::uint32_t index = kNoTriangle;
        if (winner != kNoTriangle) {
          draw = draw_of(winner, draw);
          const std::uint32_t position = winner - jobs_[draw].first_ordinal;
          index = draws_[draw].identifiers.empty() ? draws_[draw].first_index + position
                                                   : draws_[draw].identifiers[position];
        }
        target_.index[at + i * samples] = index;
      }
    });
  }

  // The draw that the triangle belongs to; `guess` is one nearby.
  std::size_t draw_of(std::uint32_t ordinal, std::size_t guess) const {
    while (ordinal < jobs_[guess].first_ordinal) --guess;
    while (guess + 1 < draws_.size() && ordinal >= jobs_[guess + 1].first_ordinal) ++guess;
    return guess;
  }

  const Target& target_;
  std::span<const Draw> draws_;
  const CoverageVisitor* visitor_;
  int threads_;
  int strip_ = 0;  // so many bands are drawn before the next ones
  Team team_;
  const Kernels& kernels_ = kernels();
  bool attributes_ = false, shading_ = false, visibility_ = false, depth_ = false, counts_ = false, greater_ = false;
  std::size_t sample_number_ = 0;
  SamplePosition sample_{0.5, 0.5};

  std::unique_ptr<Statistics[]> statistics_;  // of each thread, and of each band
  std::unique_ptr<DrawJob[]> jobs_;
  Buffer<Batch> batches_;
  Canvas canvas_;
  Buffer<float> depth_buffer_, block_far_, tile_far_;
  Buffer<std::uint32_t> winner_, count_, column_, row_, marked_;
  Buffer<std::uint64_t> masks_;
  Buffer<std::uint8_t> untouched_;
};

}  // namespace

bool supports(std::span<const Draw> draws) {
  std::size_t triangles = 0;
  for (const Draw& draw : draws) {
    triangles += draw.indices.size() / 3;
    if (triangles >= kNoTriangle) return false;
  }
  return true;
}

Status render(const Target& target, std::span<const Draw> draws, const Options& options,
              Statistics& statistics) noexcept {
  return Renderer(target, draws, nullptr, options).render(statistics);
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      const Options& options, Statistics& statistics) noexcept {
  return Renderer(target, draws, &visitor, options).render(statistics);
}

}  // namespace surefill::fast
