// SPDX-License-Identifier: Apache-2.0
#include "fast/frame.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <new>

#include "fast/culling.hpp"
#include "fast/memory.hpp"
#include "fast/store.hpp"
#include "fast/team.hpp"

namespace surefill::fast {
namespace {

// Pieces are no smaller, where threads share what few triangles there are.
constexpr std::uint32_t kSmallestPiece = 256;

// What a part of the work found out. Triangles are set up anew for each sample; they are counted with the first.
void add(Diagnostics& sum, const Diagnostics& part) {
  sum.outside += part.outside;
  sum.small += part.small;
  sum.medium += part.medium;
  sum.large += part.large;
  sum.clipped += part.clipped;
  sum.skipped_draws += part.skipped_draws;
}
void add(Rungs& sum, const Rungs& part) {
  sum.signs_by_filter += part.signs_by_filter;
  sum.signs_by_residual += part.signs_by_residual;
  sum.signs_by_expansion += part.signs_by_expansion;
  sum.values_by_filter += part.values_by_filter;
  sum.values_by_expansion += part.values_by_expansion;
}

class Frame {
 public:
  // The visitor may be null.
  Frame(const Target& target, std::span<const Draw> draws, const CoverageVisitor* visitor, const Options& options)
      : target_(target),
        draws_(draws),
        threads_(options.threads),
        team_(options.threads, options.executor),
        borrowed_(options.context) {
    const Wanted wanted = wanted_outputs(target);
    shading_ = wanted.shading, visibility_ = wanted.visibility, depth_ = wanted.depth;
    for (const Draw& draw : draws) {
      if (!draw.depth_write && depth_) visibility_ = true;  // depth alone does not say what is empty
      triangles_ += triangles_of(draw);
    }
    counts_ = !target.count.empty() || visitor != nullptr;
    if (depth_ && counts_) visibility_ = true;
    frame_.target = &target, frame_.visitor = visitor;
    frame_.grid.columns = (target.width + kTileSize - 1) >> kTileLog2;
    frame_.grid.rows = (target.height + kTileSize - 1) >> kTileLog2;
    // Strips of a row of tiles, if there are too few rows for all threads.
    const int strips = threads_ == 1 ? 1 : (4 * threads_ + frame_.grid.rows - 1) / frame_.grid.rows;
    strip_ = std::max(1, frame_.grid.columns / strips);
  }

  Status render(Diagnostics& diagnostics) {
    if (!kernels_.is_exact()) return Status::bad_build;
    if (!allocate()) return Status::out_of_memory;
    for (int n = 0; n < target_.samples; ++n) {
      frame_.sample_number = static_cast<std::size_t>(n);
      sample_ = sample_offset(target_, n);
      for (std::size_t draw = 0; draw < draws_.size(); ++draw) jobs_[draw] = job_of(draw);
      frame_.draws = {jobs_.get(), draws_.size()};
      if (!render_sample()) return Status::out_of_memory;
      for (std::size_t i = 0; n == 0 && i < parts(); ++i) add(diagnostics, diagnostics_[i]);
    }
    for (std::size_t i = 0; i < parts(); ++i) add(diagnostics.rungs, diagnostics_[i].rungs);
    diagnostics.path = kernels_.name;
    return Status::ok;
  }

 private:
  std::size_t parts() const { return static_cast<std::size_t>(threads_); }

  bool allocate() {
    // So that what is there is enough for all threads, but no piece too small to be worth it.
    const std::size_t share = triangles_ / (4 * parts());
    const std::size_t least = std::max<std::size_t>(kSmallestPiece, (triangles_ + kPieces - 1) / kPieces);
    piece_triangles_ = kPieceRecords;
    if (threads_ > 1) {
      piece_triangles_ = static_cast<std::uint32_t>(std::clamp<std::size_t>(
          (std::max(share, least) + kBatch - 1) / kBatch * kBatch, kSmallestPiece, kPieceRecords));
    }
    std::size_t pieces = 0;
    for (const Draw& draw : draws_) pieces += (triangles_of(draw) + piece_triangles_ - 1) / piece_triangles_;
    pieces = std::min(pieces, kPieces);
    const std::size_t begins = frame_.grid.tiles() + 2;
    jobs_.reset(new (std::nothrow) DrawJob[draws_.size()]);
    diagnostics_.reset(new (std::nothrow) Diagnostics[parts()]());
    const bool ok = memory_ != nullptr && jobs_ != nullptr && diagnostics_ != nullptr &&
                    memory_->records.reserve(pieces * kPieceRecords) && memory_->begin.reserve(pieces * begins) &&
                    memory_->items.reserve(pieces * kPiecePairs) && memory_->scratch.reserve(parts());
    for (std::size_t i = 0; ok && i < pieces; ++i) {
      pieces_[i].records = &memory_->records[i * kPieceRecords];
      pieces_[i].begin = &memory_->begin[i * begins];
      pieces_[i].items = &memory_->items[i * kPiecePairs];
    }
    return ok;
  }

  DrawJob job_of(std::size_t draw) const {
    const std::uint32_t ordinal =
        draw == 0 ? 0 : jobs_[draw - 1].first_ordinal + static_cast<std::uint32_t>(triangles_of(draws_[draw - 1]));
    const Origin& o = target_.origin;
    PixelBox region = region_of(target_, draws_[draw]);
    if (!region.empty()) region = {region.x0 - o.x, region.y0 - o.y, region.x1 - o.x, region.y1 - o.y};
    return {&draws_[draw],
            ordinal,
            region,
            {o.x + sample_.x, o.y + sample_.y},
            tie_shift(draws_[draw].fill_rule),
            depth_,
            target_.depth_test == DepthTest::greater,
            frame_.visitor != nullptr,
            static_cast<std::uint32_t>(draw),
            static_cast<int>(frame_.sample_number),
            o};
  }

  // ---- the stages, for one sample of every pixel
  // False if there is no memory.
  bool render_sample() {
    next_draw_ = 0, next_triangle_ = 0;
    stored_ = whole_ = cleared_ = false;
    while (const std::size_t pieces = take_pieces()) {
      for (std::size_t first = 0; first < pieces;) {
        set_up(first, pieces);
        // A piece whose lists are full is drawn, and then set up again for the rest.
        std::size_t end = first;
        while (end < pieces && pieces_[end].next == pieces_[end].end) ++end;
        const bool full = end < pieces;
        stored_ = !full && next_draw_ == draws_.size();
        if (!draw({pieces_ + first, end + (full ? 1 : 0) - first})) return false;
        if (full) is_set_up_[end] = false;
        first = end;
      }
    }
    if (stored_) return true;
    stored_ = true;
    return draw({});
  }

  // The next triangles, as pieces; none if all are drawn.
  std::size_t take_pieces() {
    std::size_t size = 0;
    for (; next_draw_ < draws_.size() && size < kPieces;) {
      const auto triangles = static_cast<std::uint32_t>(triangles_of(draws_[next_draw_]));
      if (next_triangle_ == 0 && draws_[next_draw_].culling_box) {
        if (depth_ && !counts_ && size != 0) break;  // what is hidden is known when all before is drawn
        if (skips(jobs_[next_draw_])) {
          ++diagnostics_[0].skipped_draws, ++next_draw_;
          continue;
        }
      }
      if (next_triangle_ < triangles) {
        Piece& piece = pieces_[size];
        piece.job = &jobs_[next_draw_];
        piece.next = next_triangle_;
        piece.end = next_triangle_ =
            triangles - next_triangle_ > piece_triangles_ ? next_triangle_ + piece_triangles_ : triangles;
        is_set_up_[size++] = false;
      }
      if (next_triangle_ == triangles) ++next_draw_, next_triangle_ = 0;
    }
    return size;
  }

  bool skips(const DrawJob& job) const {
    const auto& box = *job.draw->culling_box;
    if (is_outside(box, *job.draw, job.in_space(job.region))) return true;
    if (!depth_ || counts_ || !whole_) return false;
    return is_hidden(box, job, [this](int column, int row) { return tiles_of(row, column, column + 1); });
  }

  // Pieces [first, end), as far as they are not set up yet, by whoever is free.
  void set_up(std::size_t first, std::size_t end) {
    run(end - first, [&](std::size_t i, std::size_t part) {
      if (is_set_up_[first + i]) return;
      is_set_up_[first + i] = true;
      kernels_.set_up(frame_.grid, pieces_[first + i], memory_->scratch[part], diagnostics_[part]);
    });
  }

  // Tiles draw what the pieces have for them, a strip at a time; after the last pieces strips are shaded and stored.
  bool draw(std::span<const Piece> pieces) {
    const bool once = stored_ && !whole_;  // a strip is drawn only once: then a thread has memory for one
    whole_ = whole_ || !once;
    if (!reserve_tiles(once ? static_cast<std::size_t>(threads_ * strip_) : frame_.grid.tiles())) return false;
    const int columns = frame_.grid.columns, strips = (columns + strip_ - 1) / strip_;
    run(static_cast<std::size_t>(frame_.grid.rows * strips), [&](std::size_t i, std::size_t part) {
      const int row = static_cast<int>(i) / strips, begin = static_cast<int>(i) % strips * strip_;
      const int end = std::min(begin + strip_, columns);
      const TileRow tiles =
          once ? tiles_at(part * static_cast<std::size_t>(strip_), row, begin, end) : tiles_of(row, begin, end);
      if (!cleared_) std::fill_n(tiles.opened, end - begin, std::uint8_t{0});
      kernels_.draw_tiles(frame_, pieces, tiles, memory_->scratch[part], diagnostics_[part].rungs);
      if (!stored_) return;
      if (shading_) kernels_.shade(frame_, tiles, diagnostics_[part].rungs);
      Store(frame_, tiles).run();
    });
    cleared_ = true;
    return true;
  }

  // work(i, part) for i = 0 .. items - 1; `part` is one of as many as there are threads, and busy with one i at a time.
  template <typename Work>
  void run(std::size_t items, const Work& work) {
    std::atomic<std::size_t> next{0};
    team_.run(std::min(items, parts()), [&](std::size_t part) {
      for (std::size_t i = next++; i < items; i = next++) work(i, part);
    });
  }

  // ---- tiles
  bool reserve_tiles(std::size_t tiles) {
    const std::size_t samples = tiles * kTileSamples;
    return memory_->far.reserve(tiles) && memory_->opened.reserve(tiles) &&
           (!depth_ || memory_->depth.reserve(samples)) && (!visibility_ || memory_->winner.reserve(samples)) &&
           (target_.count.empty() || memory_->count.reserve(samples));
  }
  TileRow tiles_at(std::size_t first, int row, int begin, int end) const {
    const std::size_t sample = first * kTileSamples;
    return {row,
            begin,
            end,
            depth_ ? memory_->depth.data() + sample : nullptr,
            visibility_ ? memory_->winner.data() + sample : nullptr,
            target_.count.empty() ? nullptr : memory_->count.data() + sample,
            memory_->far.data() + first,
            memory_->opened.data() + first};
  }
  TileRow tiles_of(int row, int begin, int end) const {
    return tiles_at(static_cast<std::size_t>(row * frame_.grid.columns + begin), row, begin, end);
  }

  const Target& target_;
  std::span<const Draw> draws_;
  const int threads_;
  Team team_;
  const Kernels& kernels_ = kernels();
  // What is kept of each sample: depth, who is seen, counts; and whether barycentrics or attributes are asked for.
  bool depth_ = false, visibility_ = false, counts_ = false, shading_ = false;
  FrameJob frame_{};
  SamplePosition sample_{0.5, 0.5};
  std::size_t triangles_ = 0;
  std::uint32_t piece_triangles_ = kPieceRecords;
  int strip_ = 1;  // columns of tiles that are drawn by one

  std::size_t next_draw_ = 0;  // what is not yet in a piece
  std::uint32_t next_triangle_ = 0;
  Piece pieces_[kPieces];
  bool is_set_up_[kPieces] = {};
  bool stored_ = false;   // the image is, or will be with what is drawn now
  bool whole_ = false;    // there is memory for all tiles
  bool cleared_ = false;  // and what `opened` says is true

  const BorrowedMemory borrowed_;
  Memory* const memory_ = borrowed_.get();
  std::unique_ptr<DrawJob[]> jobs_;
  std::unique_ptr<Diagnostics[]> diagnostics_;  // of each part
};

}  // namespace

bool streams(const Target& target, std::span<const Draw> draws) {
  std::uint64_t triangles = 0;
  bool grid = false;
  for (const Draw& draw : draws) {
    triangles += std::min<std::uint64_t>(triangles_of(draw), kNoTriangle);
    grid = grid || draw.grid.has_value();
  }
  return triangles < kNoTriangle && !(grid && target.origin != Origin{});
}

bool supports(const Target& target, std::span<const Draw> draws) {
  const auto plain = [&](const Draw& draw) {
    const bool squares = draw.conservative != Conservative::none;
    return has_triangles(draw) && !draw.depth_bias && draw.covered.empty() && draw.visible.empty() &&
           draw.conservative <= Conservative::inner && !(squares && !target.index.empty());
  };
  return streams(target, draws) && target.layers == 1 && target.winding.empty() && !takes_equal(target.depth_test) &&
         std::all_of(draws.begin(), draws.end(), plain);
}

Status render(const Target& target, std::span<const Draw> draws, const Options& options,
              Diagnostics& diagnostics) noexcept {
  return Frame(target, draws, nullptr, options).render(diagnostics);
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      const Options& options, Diagnostics& diagnostics) noexcept {
  return Frame(target, draws, &visitor, options).render(diagnostics);
}

}  // namespace surefill::fast
