// SPDX-License-Identifier: Apache-2.0
#include "lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exact/edge.hpp"
#include "facts.hpp"
#include "fast/team.hpp"

namespace surefill {
namespace {

// One line in use, of the samples with one number: the pixels that it covers, column by column (row by row where y is the
// major axis).
template <bool kXMajor>
class Columns {
 public:
  Columns(const Line& line, const PixelBox& box, SamplePosition offset, TieShift shift)
      : line_(line), offset_(offset), shift_(shift), half_(line.half_width()) {
    const EdgeFunction& e = line.edge();
    t0_ = kXMajor ? box.x0 : box.y0, t1_ = kXMajor ? box.x1 : box.y1;
    m0_ = kXMajor ? box.y0 : box.x0, m1_ = kXMajor ? box.y1 : box.x1;
    t_offset_ = kXMajor ? offset.x : offset.y, m_offset_ = kXMajor ? offset.y : offset.x;
    slope_ = kXMajor ? -e.a / e.b : -e.b / e.a, start_ = kXMajor ? -e.c / e.b : -e.c / e.a;
    // The minor coordinate slope t + start is off by five roundings of 2^-53; what is compared with it, by as much.
    const double farthest = std::max(std::fabs(t0_ + t_offset_), std::fabs(t1_ + t_offset_));
    error_ = 0x1p-48 * ((std::fabs(slope_ * farthest) + std::fabs(start_)) + half_);
    narrow();
  }

  // sink(x, y, along, between_ends) for each pixel that is covered: the sample's major coordinate, and whether the line is
  // known to have a point there.
  template <typename Sink>
  void for_each(const Sink& sink) const {
    // Within a pixel of an end each sample is asked: of a thin line coverage is no matter of the column alone.
    const Reach reach = line_.reach_of_ends();
    const int first = static_cast<int>(std::clamp<double>(std::floor(reach.low - t_offset_) + 2, t0_, t1_));
    const int last = static_cast<int>(std::clamp<double>(std::ceil(reach.high - t_offset_) - 1, first, t1_));
    for (int t = t0_; t < first; ++t) column(t, false, sink);
    if (half_ == 0.5) {
      pixels(first, last, sink);
    } else {
      for (int t = first; t < last; ++t) column(t, true, sink);
    }
    for (int t = last; t < t1_; ++t) column(t, false, sink);
  }

 private:
  // Leaves out columns in which the line is more than a pixel away from the box.
  void narrow() {
    if (slope_ == 0 || !(error_ < 0.5)) return;
    const double from = (m0_ - half_ - 2 - start_) / slope_, to = (m1_ + half_ + 2 - start_) / slope_;
    t0_ = static_cast<int>(std::clamp<double>(std::floor(std::min(from, to)) - 1, t0_, t1_));
    t1_ = static_cast<int>(std::clamp<double>(std::ceil(std::max(from, to)) + 1, t0_, t1_));
  }

  // The columns of a line that is one pixel wide: but for a sample right on its border, each has one pixel.
  template <typename Sink>
  void pixels(int first, int last, const Sink& sink) const {
    const double slope = slope_, start = start_, certain = 0.5 - error_, t_offset = t_offset_;
    const double least = m0_ + m_offset_, most = m1_ - 1 + m_offset_;
    const int m0 = m0_;
    for (int t = first; t < last; ++t) {
      const double along = t + t_offset, centre = slope * along + start;
      if (centre >= least && centre <= most) {
        const int steps = static_cast<int>(centre - least + 0.5);
        if (std::fabs((centre - least) - steps) < certain) {
          const int m = m0 + steps;
          sink(kXMajor ? t : m, kXMajor ? m : t, along, true);
          continue;
        }
      }
      column(t, true, sink);
    }
  }

  template <typename Sink>
  [[gnu::noinline]] void column(int t, bool between_ends, const Sink& sink) const {
    const double along = t + t_offset_, centre = slope_ * along + start_;
    // Beyond the box nothing is covered; within it all numbers are those of pixels.
    const double low = std::max(centre - half_ - error_ - m_offset_, static_cast<double>(m0_));
    const double high = std::min(centre + half_ + error_ - m_offset_, static_cast<double>(m1_ - 1));
    if (!(low <= high)) return;
    const int last = static_cast<int>(std::floor(high));
    for (int m = static_cast<int>(std::ceil(low)); m <= last; ++m) {
      const int x = kXMajor ? t : m, y = kXMajor ? m : t;
      const bool certain = between_ends && std::fabs((m + m_offset_) - centre) < half_ - error_;
      if (certain || line_.covers({x + offset_.x, y + offset_.y}, shift_)) sink(x, y, along, between_ends);
    }
  }

  const Line& line_;
  SamplePosition offset_;
  TieShift shift_;
  int t0_, t1_, m0_, m1_;  // of the box, along the major and the minor axis
  double t_offset_, m_offset_, half_, slope_, start_, error_;
};

// The depth of samples of one line that are no further out than its ends, in double where that tells.
class DepthOfLine {
 public:
  DepthOfLine(const Line& line, DepthMode mode) : line_(line), mode_(mode), along_(line.depth_along()) {
    if (mode == DepthMode::none) least_ = -kLargestFloat, most_ = kLargestFloat;
  }
  // As Line::depth.
  bool at(double t, SamplePosition p, bool between_ends, float* to) const {
    const double moved = along_.slope * t, z = moved + along_.start, error = along_.error + 0x1p-50 * std::fabs(moved);
    const double low = z - error, high = z + error;
    *to = static_cast<float>(low) + 0.0f;  // -0 becomes +0
    if (between_ends && low > least_ && high < most_ && *to == static_cast<float>(high)) return true;
    return line_.depth(p, mode_, to);
  }

 private:
  const Line& line_;
  DepthMode mode_;
  Line::DepthAlong along_;
  double least_ = 0, most_ = 1;  // no clipping or clamping in between
};

// The line in use.
template <bool kXMajor>
void draw_line(const Target& target, const Draw& draw, const PixelBox& region, std::uint32_t position, bool needs_depth,
               DrawFragments& fragments) {
  const Line& line = fragments.triangle().line();
  const DepthOfLine depth(line, draw.depth_mode);
  const Origin origin = target.origin;
  for (int n = 0; n < target.samples; ++n) {
    const SamplePosition offset = sample_offset(target, n);
    const PixelBox box = line.box(region, std::min(offset.x, offset.y), std::max(offset.x, offset.y));
    const Columns<kXMajor> columns(line, box, offset, tie_shift(draw.fill_rule));
    columns.for_each([=, &fragments](int x, int y, double along, bool between_ends) {
      Fragment fragment{position, x - origin.x, y - origin.y, n};
      const SamplePosition place{x + offset.x, y + offset.y};
      if (!needs_depth || depth.at(along, place, between_ends, &fragment.z)) fragments.take(fragment);
    });
  }
}

// Lines of a draw, chunk by chunk: first the rows of the target that each reaches, then the bands, each by one thread.
class LineDrawer {
 public:
  LineDrawer(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers)
      : target_(target), draw_(draw), number_(number), layers_(layers), region_(region_of(target, draw)) {
    rows_of_band_ = std::clamp((1 << 17) / (target.width * target.samples), 8, 64);
    needs_depth_ = layers != nullptr || draw.depth_mode == DepthMode::clip;
  }

  void run(fast::Team& team) {
    const std::size_t lines = triangles_of(draw_);
    const auto bands = static_cast<std::size_t>((region_.y1 - region_.y0 + rows_of_band_ - 1) / rows_of_band_);
    for (begin_ = 0; begin_ < lines && bands > 0; begin_ += kChunk) {
      size_ = std::min(kChunk, lines - begin_);
      team.run(kChunk / kPiece, [this](std::size_t piece) { find_rows(piece * kPiece); });
      team.run(bands, [this](std::size_t band) { draw_band(static_cast<int>(band)); });
    }
  }

 private:
  static constexpr std::size_t kChunk = 4096, kPiece = 512;
  struct Rows {
    int first, last;  // half-open
  };

  void find_rows(std::size_t first) {
    ExactDraw lines(target_.origin);
    for (std::size_t i = first; i < std::min(first + kPiece, size_); ++i) {
      const auto position = static_cast<std::uint32_t>(begin_ + i);
      rows_[i] = {std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};  // none
      if (!is_finite(draw_, position) || !lines.use(draw_, position)) continue;
      const PixelBox box = lines.box(region_, 0, 1);
      if (!box.empty()) rows_[i] = {box.y0, box.y1};
    }
  }

  void draw_band(int number) {
    const int y = region_.y0 + number * rows_of_band_;
    const PixelBox band{region_.x0, y, region_.x1, std::min(y + rows_of_band_, region_.y1)};
    Rungs rungs;  // those of lines are not told
    DrawFragments fragments(target_, draw_, number_, layers_, rungs);
    for (std::size_t i = 0; i < size_; ++i) {
      if (rows_[i].first >= band.y1 || rows_[i].last <= band.y0) continue;
      const auto position = static_cast<std::uint32_t>(begin_ + i);
      fragments.triangle().use(draw_, position);
      if (fragments.triangle().line().x_major()) {
        draw_line<true>(target_, draw_, band, position, needs_depth_, fragments);
      } else {
        draw_line<false>(target_, draw_, band, position, needs_depth_, fragments);
      }
    }
  }

  const Target& target_;
  const Draw& draw_;
  std::uint32_t number_;
  Layers* layers_;
  PixelBox region_;
  int rows_of_band_;
  bool needs_depth_;
  std::size_t begin_ = 0, size_ = 0;  // of the chunk
  std::array<Rows, kChunk> rows_;
};

}  // namespace

void draw_lines(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers,
                const Options& options) noexcept {
  LineDrawer drawer(target, draw, number, layers);
  fast::Team team(options.threads, options.executor);
  drawer.run(team);
}

}  // namespace surefill
