// SPDX-License-Identifier: Apache-2.0
//
// What the records of the fast path promise those who draw them: boxes that hold all that is covered, lists of all
// tiles in which something is, integer edges that are right where they are sure and exact where they can be, depth
// planes within their error bounds. Checked by exact arithmetic, apart from any image: an image shows a bound that is
// too small at one sample in millions, and one that is too large not at all.
#ifndef SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP
#define SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/tests/batch_triangles.hpp"
#include "exact/grid.hpp"
#include "exact/triangle.hpp"
#include "fast/frame.hpp"
#include "fast/tile.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::properties {

class BatchBounds {
 public:
  explicit BatchBounds(std::uint64_t number) : random_(number) {}

  // What does not hold in this case; empty if all does.
  std::string broken() {
    const auto all = categories();
    const Category& category = all[random_.below(static_cast<std::uint32_t>(all.size()))];
    constexpr int kSizes[] = {4, 16, 20, 60, 200, 1000, kMaxTargetSize};
    int size = kSizes[random_.below(7)];
    const std::uint32_t count = 1 + random_.below(fast::kBatch);
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    const bool uneven = random_.one_in(4);
    if (random_.one_in(2))
      draw_.grid = Grid{random_.between(0, 12), random_.between(0, 15), random_.between(0, 15),
                        static_cast<GridRounding>(random_.below(3))};
    const bool thin = draw_.grid && !random_.one_in(4), crossing = !thin && random_.one_in(6);
    const bool flat = !thin && random_.one_in(8), diagonal = !thin && random_.one_in(4);
    const int x = random_.between(0, kMaxTargetSize - 4), y = random_.between(0, kMaxTargetSize - 4);
    if (thin) draw_.grid->bits = random_.between(10, 12);
    if ((thin && random_.one_in(2)) || diagonal) size = kMaxTargetSize;
    for (std::uint32_t t = 0; t < count; ++t) {
      for (const Vertex& v : thin       ? thin_triangle(random_, *draw_.grid)
                             : crossing ? crossing_triangle(random_, x, y)
                             : flat     ? flat_triangle(random_, size)
                             : diagonal ? diagonal_triangle(random_)
                             : uneven   ? uneven_triangle(random_)
                                        : category.triangle(random_, size, size)) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.push_back(v);
      }
    }
    if (random_.one_in(24)) {  // one number infinite, of whatever signs the others are
      const auto number = [&] {
        Vertex& v = vertices[random_.below(static_cast<std::uint32_t>(vertices.size()))];
        float* const numbers[] = {&v.x, &v.y, &v.z, &v.w};
        return numbers[random_.below(4)];
      };
      for (std::uint32_t n = 0; n < 6 * count; ++n) {
        float* const turned = number();
        *turned = -*turned;
      }
      *number() = random_.one_in(2) ? kInfinity : -kInfinity;
    }
    if (random_.one_in(8)) {  // on the border of the guard band
      Vertex& v = vertices[random_.below(static_cast<std::uint32_t>(vertices.size()))];
      (random_.one_in(2) ? v.x : v.y) = static_cast<float>(random_.one_in(2) ? kGuardBand : -kGuardBand) * v.w;
    }
    draw_.vertices = vertices, draw_.indices = indices;
    draw_.fill_rule = static_cast<FillRule>(random_.below(8));
    draw_.depth_mode = static_cast<DepthMode>(random_.below(3));
    draw_.cull = random_.one_in(3) ? static_cast<Cull>(random_.below(3)) : Cull::none;
    const int samples = uneven ? 16 : 1 << random_.below(5);
    // The last four of sixteen lie on the pixel's left or upper border, or near it.
    const SampleLocation location =
        sample_location(samples, uneven ? random_.between(12, 15) : random_.between(0, samples - 1));
    PixelBox region{0, 0, size, size};
    if (random_.one_in(3)) region = {size / 4, size / 5, size - size / 3, size - size / 7};
    if (crossing) region = {x, y, x + random_.between(1, 3), y + random_.between(1, 3)};
    job_ = {
        &draw_, 0, region, {location.x / 16.0, location.y / 16.0}, tie_shift(draw_.fill_rule), true, random_.one_in(3),
        false,  0, 0};
    tiles_.columns = tiles_.rows = (size + fast::kTileSize - 1) / fast::kTileSize;
    if (crossing) tiles_.columns = tiles_.rows = kMaxTargetSize / fast::kTileSize;
    Diagnostics diagnostics;
    set_up(0, count, diagnostics, [this](const fast::Record& r, const std::vector<std::uint32_t>& listed) {
      record_[r.position] = r, is_drawn_[r.position] = true, listed_[r.position] = listed;
    });
    // Those that are tiny and cover nothing have no record.
    const std::uint64_t counted = diagnostics.small + diagnostics.medium + diagnostics.large;
    if (counted < drawn() || counted - diagnostics.small > drawn() || counted > count)
      return "the diagnostics count lanes";
    for (std::uint32_t lane = 0; lane < count; ++lane) check(lane);
    expect(diagnostics.clipped == clipped_, "the diagnostics count what Grid clips");
    if (count > 1 && random_.one_in(8)) in_two(count, diagnostics);
    if (random_.one_in(256)) counts_all_triangles();
    if (clips_) return broken_;
    const Rungs& rungs = diagnostics.rungs;
    expect(rungs.signs_by_filter + rungs.signs_by_expansion <= unsure_,
           "the sign of D is looked up only where doubles may not tell it");
    if (!draw_.grid) return broken_;
    for (std::uint32_t lane = count; lane < fast::kBatch; ++lane) near_a_turn(0);  // the other lanes are like the first
    expect(rungs.values_by_filter + rungs.values_by_expansion <= turns_,
           "grid positions are looked up only where doubles may not tell them");
    return broken_;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  void expect(bool holds, const char* what) {
    if (!holds && broken_.empty()) broken_ = what;
  }

  // Sets up triangles, and visits each record and the tiles in which it is listed; where lists are full, in several
  // steps.
  template <typename Visit>
  void set_up(std::uint32_t first, std::uint32_t count, Diagnostics& diagnostics, const Visit& visit) {
    static fast::Scratch scratch;
    static std::vector<std::uint16_t> items(fast::kPiecePairs);
    alignas(128) static fast::Record records[6 * fast::kBatch];  // a clipped triangle becomes up to five
    std::vector<std::uint32_t> begin(tiles_.tiles() + 2), tiles_of_record;
    fast::Piece piece{&job_, first, first + count, records, 0, begin.data(), items.data()};
    for (int steps = 0; piece.next < piece.end; ++steps) {
      // What a record does not set must not be looked at.
      std::fill_n(reinterpret_cast<unsigned char*>(records), sizeof records, static_cast<unsigned char>(0x7E));
      fast::kernels().set_up(tiles_, piece, scratch, diagnostics);
      expect(steps <= 8, "each step sets up a triangle");
      if (!broken_.empty()) return;
      for (std::uint32_t n = 0; n < piece.size; ++n) {
        tiles_of_record.clear();
        for (std::size_t tile = 0; tile < tiles_.tiles(); ++tile) {
          for (std::uint32_t i = begin[tile]; i < begin[tile + 1]; ++i)
            if (items[i] == n) tiles_of_record.push_back(static_cast<std::uint32_t>(tile));
        }
        if (records[n].fan_triangle() == 0 && !records[n].has(fast::Record::kByWinding))
          visit(records[n], tiles_of_record);
      }
    }
  }
  std::uint64_t drawn() const {
    return static_cast<std::uint64_t>(std::count(is_drawn_.begin(), is_drawn_.end(), true));
  }
  bool is_listed(std::uint32_t lane, int x, int y) const {
    const auto tile = static_cast<std::uint32_t>((y >> fast::kTileLog2) * tiles_.columns + (x >> fast::kTileLog2));
    return std::count(listed_[lane].begin(), listed_[lane].end(), tile) == 1;
  }

  // Ordinals are below kNoTriangle, over all draws: one triangle more, and the fast path cannot draw the frame.
  void counts_all_triangles() {
    constexpr std::size_t kEach = std::size_t{1} << 20;
    static const std::vector<std::uint32_t> indices(3 * kEach);
    std::vector<Draw> draws(kNoTriangle / kEach + 1);
    for (Draw& draw : draws) draw.indices = indices;
    Draw& last = draws[random_.below(static_cast<std::uint32_t>(draws.size()))];
    last.indices = std::span(indices).first(3 * (kEach - 2));
    expect(fast::supports({}, draws), "the fast path draws so many triangles");
    last.indices = std::span(indices).first(3 * (kEach - 1));
    expect(!fast::supports({}, draws), "the fast path draws no more triangles");
  }
  SamplePosition at(int x, int y) const { return {x + job_.sample.x, y + job_.sample.y}; }

  template <class Terms>
  static mpq_class sum_of(const Terms& expansion) {
    mpq_class sum;
    for (int i = 0; i < expansion.size(); ++i) sum += expansion.term(i);
    return sum;
  }

  void check(std::uint32_t lane) {
    const Vertex* v[3] = {&draw_.vertices[3 * lane], &draw_.vertices[3 * lane + 1], &draw_.vertices[3 * lane + 2]};
    bool finite = true;
    for (const Vertex* vertex : v) {
      finite = finite && std::isfinite(vertex->x) && std::isfinite(vertex->y) && std::isfinite(vertex->z) &&
               std::isfinite(vertex->w);
    }
    if (draw_.grid) return check_snapped(lane, v, finite);
    const bool drawn = finite && triangle_.set_up(*v[0], *v[1], *v[2]);
    if (finite && !determinant_is_clear(lane)) ++unsure_;
    const bool front = drawn && (triangle_.determinant() > 0) == (draw_.front_face == FrontFace::clockwise);
    const bool culled = draw_.cull == Cull::front ? front : draw_.cull == Cull::back && !front;
    const bool live = is_drawn_[lane];
    expect(!live || (drawn && !culled), "what is live is a triangle that is not culled");
    if (!drawn || culled) return;
    const PixelBox exact_box = screen_box(*v[0], *v[1], *v[2], job_.region, std::min(job_.sample.x, job_.sample.y),
                                          std::max(job_.sample.x, job_.sample.y));
    if (!live) {
      for (int n = 0; n < 12 && !exact_box.empty(); ++n) {
        const int x = random_.between(exact_box.x0, exact_box.x1 - 1),
                  y = random_.between(exact_box.y0, exact_box.y1 - 1);
        expect(!triangle_.covers(at(x, y), job_.shift), "what is not live covers nothing");
      }
      return;
    }
    take_box(lane);
    expect(x0_ >= job_.region.x0 && x1_ < job_.region.x1 && y0_ >= job_.region.y0 && y1_ < job_.region.y1 &&
               x0_ <= x1_ && y0_ <= y1_,
           "the box lies in the region");
    if (!broken_.empty()) return;
    box(v, exact_box);
    for (std::size_t i = 0; i < 3; ++i) {
      const EdgeFunction& edge = triangle_.edge(static_cast<int>(i));
      line_[i] = {edge.a, edge.b, edge.c, edge.exact};
    }
    sign_ = triangle_.determinant();
    what_is_set_up(lane, v);
  }

  // Set up in two pieces, the triangles become the same records and count together as in one.
  void in_two(std::uint32_t count, const Diagnostics& alone) {
    const std::uint32_t middle = 1 + random_.below(count - 1);
    Diagnostics sum;
    const auto same_as_alone = [this](const fast::Record& r, const std::vector<std::uint32_t>& listed) {
      const fast::Record& other = record_[r.position];
      bool same = is_drawn_[r.position] && r.flags == other.flags && r.x0 == other.x0 && r.x1 == other.x1 &&
                  r.y0 == other.y0 && r.y1 == other.y1 && listed == listed_[r.position];
      for (std::size_t k = 0; k < 3 && r.has(fast::Record::kSmall); ++k)
        same = same && r.small.e[k] == other.small.e[k];
      expect(same, "a piece's records do not depend on where it begins");
    };
    set_up(0, middle, sum, same_as_alone), set_up(middle, count - middle, sum, same_as_alone);
    expect(sum.outside == alone.outside && sum.small == alone.small && sum.medium == alone.medium &&
               sum.large == alone.large && sum.clipped == alone.clipped &&
               sum.rungs.signs_by_filter == alone.rungs.signs_by_filter &&
               sum.rungs.signs_by_expansion == alone.rungs.signs_by_expansion,
           "pieces count together as one");
  }

  // The same under Grid, for the triangle on the grid.
  void check_snapped(std::uint32_t lane, const Vertex* const (&v)[3], bool finite) {
    bool whole = finite;
    for (const Vertex* vertex : v) {
      const double limit = kGuardBand * static_cast<double>(vertex->w);
      whole = whole && vertex->w > 0 && std::fabs(vertex->x) <= limit && std::fabs(vertex->y) <= limit;
    }
    near_a_turn(lane);
    const bool some = finite && snapped_.set_up(*v[0], *v[1], *v[2], *draw_.grid);
    const double least = std::min(job_.sample.x, job_.sample.y), most = std::max(job_.sample.x, job_.sample.y);
    const bool clipped = finite && !whole;
    clips_ = clips_ || clipped;
    if (clipped && some && !snapped_.box(job_.region, least, most).empty()) ++clipped_;
    expect(whole || !is_drawn_[lane], "what is not within the guard band is not drawn as it is");
    if (!whole) return;

    const int units_per_pixel = 16 << draw_.grid->bits;
    std::int64_t x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const SamplePosition corner = snapped_.corner(static_cast<int>(k));
      corner_[k] = corner;
      x[k] = static_cast<std::int64_t>(corner.x * units_per_pixel);
      y[k] = static_cast<std::int64_t>(corner.y * units_per_pixel);
    }
    const auto samples = [](double a, double b, double c, double offset, int begin, int end, int* first, int* last) {
      *first = static_cast<int>(std::clamp<double>(std::ceil(std::min({a, b, c}) - offset), begin, end));
      *last = static_cast<int>(std::clamp<double>(std::floor(std::max({a, b, c}) - offset), begin - 1, end - 1));
    };
    const PixelBox& region = job_.region;
    samples(corner_[0].x, corner_[1].x, corner_[2].x, job_.sample.x, region.x0, region.x1, &x0_, &x1_);
    samples(corner_[0].y, corner_[1].y, corner_[2].y, job_.sample.y, region.y0, region.y1, &y0_, &y1_);
    const int box[4] = {x0_, x1_, y0_, y1_};
    const bool reached = x0_ <= x1_ && y0_ <= y1_;
    const std::int64_t left = (x[1] - x[0]) * (y[2] - y[0]), right = (y[1] - y[0]) * (x[2] - x[0]);
    sign_ = left > right ? 1 : left < right ? -1 : 0;
    const bool culled = draw_.cull == Cull::front ? sign_ > 0 : draw_.cull == Cull::back && sign_ < 0;
    const bool live = is_drawn_[lane], may_cover = reached && sign_ != 0 && !culled;
    for (std::size_t i = 0; i < 3; ++i) {
      const SamplePosition &j = corner_[(i + 1) % 3], &k = corner_[(i + 2) % 3];
      line_[i] = {j.y - k.y, k.x - j.x, -((j.y - k.y) * j.x + (k.x - j.x) * j.y), true};
    }
    expect(!live || may_cover, "what is live reaches samples, has an area and is not culled");
    if (!live && may_cover) {
      for_some_samples([&](int x_, int y_) { expect(!is_inside(x_, y_), "what is not live covers nothing"); });
      expect(x1_ - x0_ < 4 && y1_ - y0_ < 4, "what covers nothing and is looked at sample by sample is tiny");
    }
    if (!live || !broken_.empty()) return;
    take_box(lane);
    expect(x0_ == box[0] && x1_ == box[1] && y0_ == box[2] && y1_ == box[3], "the box is that of the corners");
    triangle_.set_up(*v[0], *v[1], *v[2]);  // its depth is that of the triangle as it was
    what_is_set_up(lane, v);
  }

  // What depth is clamped to: under Grid the corners' range, with depth clamping 0..1.
  void range(const fast::Record& r, const Vertex* const (&v)[3]) {
    float low = -kInfinity, high = kInfinity;
    if (draw_.grid) {
      float z[3];
      for (std::size_t k = 0; k < 3; ++k)
        z[k] = std::clamp(v[k]->z / v[k]->w, -std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
      low = std::min({z[0], z[1], z[2]}), high = std::max({z[0], z[1], z[2]});
    }
    if (draw_.depth_mode == DepthMode::clamp) low = std::clamp(low, 0.0f, 1.0f), high = std::clamp(high, 0.0f, 1.0f);
    expect(r.z_least == (job_.greater ? -high : low) && r.z_most == (job_.greater ? -low : high),
           "the range of depth is that of the corners, and 0..1");
    for (const float end : {r.z_least, r.z_most})
      expect(end != 0 || !std::signbit(end), "the range of depth has no -0");
  }

  // Counts the coordinates of corners of which doubles alone may not be able to round one to the grid.
  void near_a_turn(std::uint32_t lane) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vertex& v = draw_.vertices[3 * lane + k];
      const auto is_near = [&](float c, int offset) {
        const double t = static_cast<double>(c) / v.w * (1 << draw_.grid->bits) - offset / 16.0;
        const double turn = draw_.grid->rounding == GridRounding::truncate ? t : t + 0.5;
        return !(std::fabs(turn - std::rint(turn)) > 0x1p-20);
      };
      if (is_near(v.x, draw_.grid->offset_x) || is_near(v.y, draw_.grid->offset_y)) turns_ += 2;
    }
  }

  // D is far larger than any error of D = sum W_i E_i in double.
  bool determinant_is_clear(std::uint32_t lane) {
    const double x = is_drawn_[lane] ? record_[lane].x0 + 1 : job_.region.x1,
                 y = is_drawn_[lane] ? record_[lane].y0 + 1 : job_.region.y1;
    double terms = 0;
    for (int i = 0; i < 3; ++i) {
      const EdgeFunction& edge = triangle_.edge(i);
      terms += (std::fabs(edge.a * x) + std::fabs(edge.b * y) + std::fabs(edge.c)) * std::fabs(triangle_.vertex(i).w);
    }
    return std::fabs(triangle_.exact_determinant_value().estimate()) > 0x1p-47 * terms;
  }

  void take_box(std::uint32_t lane) {
    const fast::Record& r = record_[lane];
    x0_ = r.x0, x1_ = r.x1, y0_ = r.y0, y1_ = r.y1;
    const int low = r.has(fast::Record::kSmall) ? 3 : 7;
    origin_x_ = x0_ & ~low, origin_y_ = y0_ & ~low;
  }

  void what_is_set_up(std::uint32_t lane, const Vertex* const (&v)[3]) {
    const fast::Record& r = record_[lane];
    const bool small = r.has(fast::Record::kSmall);
    expect(small == (x1_ - (x0_ & ~3) < 16 && y1_ - (y0_ & ~3) < 16), "`small` is 4 x 4 cells");
    if (small) {
      Integers integers{{}, {}, {}, r.small.doubt, origin_x_, origin_y_, x0_, x1_, y0_, y1_};
      for (std::size_t i = 0; i < 3; ++i)
        integers.a[i] = r.small.a[i], integers.b[i] = r.small.b[i], integers.e[i] = r.small.e[i];
      edges(integers, 16);
    } else {
      scaled_edges(r);
      // In some tile of the box.
      const int tile_x = random_.between(x0_ >> 6, x1_ >> 6) * 64, tile_y = random_.between(y0_ >> 6, y1_ >> 6) * 64;
      const fast::TileEdges of(r, tile_x + job_.sample.x, tile_y + job_.sample.y);
      Integers integers{{},
                        {},
                        {},
                        of.doubt,
                        tile_x,
                        tile_y,
                        std::max(x0_, tile_x),
                        std::min(x1_, tile_x + 63),
                        std::max(y0_, tile_y),
                        std::min(y1_, tile_y + 63)};
      for (std::size_t i = 0; i < 3; ++i) integers.a[i] = of.a[i], integers.b[i] = of.b[i], integers.e[i] = of.e[i];
      edges(integers, 64);
    }
    doubt(small ? r.small.doubt : r.has(fast::Record::kInteger) ? 0 : 2 * 64, small ? 24 : 22, small ? 16 : 64);
    for_some_samples([&](int x, int y) {
      if (is_inside(x, y))
        expect(is_listed(lane, x, y), "a tile in which something is covered has the triangle in its list");
    });
    if (r.has(fast::Record::kTiny)) cover(r);
    range(r, v);
    depth(lane, v);
  }

  // A tiny triangle's masks are what it covers, and nothing in cells that its box does not meet.
  void cover(const fast::Record& r) {
    expect(r.has(fast::Record::kSmall) && x1_ - x0_ < 4 && y1_ - y0_ < 4, "`tiny` is 4 x 4 samples");
    for (int y = origin_y_; y < origin_y_ + 8; ++y) {
      for (int x = origin_x_; x < origin_x_ + 8; ++x) {
        const std::uint32_t cells = r.small.cover[(x - origin_x_) >> 2];
        const bool covered = (cells >> (16 * ((y - origin_y_) >> 2) + 4 * (y & 3) + (x & 3)) & 1) != 0;
        const bool in_box = x >= x0_ && x <= x1_ && y >= y0_ && y <= y1_;
        expect(covered == (in_box && is_inside(x, y)), "the samples that a tiny triangle covers are known");
      }
    }
  }

  // It holds every sample that is covered; and no more than what float32 quotients add, and one sample offset for both
  // axes where a vertex lies behind the eye.
  void box(const Vertex* const (&v)[3], const PixelBox& wide) {
    const double w[3] = {v[0]->w, v[1]->w, v[2]->w};
    PixelBox least = job_.region;
    clip_to_reach(reach({v[0]->x, v[1]->x, v[2]->x}, w), job_.sample.x, job_.sample.x, &least.x0, &least.x1);
    clip_to_reach(reach({v[0]->y, v[1]->y, v[2]->y}, w), job_.sample.y, job_.sample.y, &least.y0, &least.y1);
    if (!least.empty())
      expect(x0_ <= least.x0 && x1_ >= least.x1 - 1 && y0_ <= least.y0 && y1_ >= least.y1 - 1,
             "the box holds the triangle");
    expect(x0_ >= wide.x0 - 1 && x1_ <= wide.x1 && y0_ >= wide.y0 - 1 && y1_ <= wide.y1,
           "the box is no larger than need be");
    // Where float32 arithmetic is exact, not at all.
    bool exact = !least.empty();
    for (const Vertex* vertex : v) {
      const auto few_bits = [](float c) { return std::fabs(c) < 0x1p13f && c * 256 == std::rint(c * 256); };
      exact = exact && vertex->w == 1 && few_bits(vertex->x) && few_bits(vertex->y);
    }
    if (exact)
      expect(x0_ == least.x0 && x1_ == least.x1 - 1 && y0_ == least.y0 && y1_ == least.y1 - 1,
             "the box is the smallest");
  }

  template <typename Visit>
  void for_some_samples(const Visit& visit) {
    visit(x0_, y0_), visit(x1_, y0_), visit(x0_, y1_), visit(x1_, y1_);
    for (int n = 0; n < 6; ++n) visit(random_.between(x0_, x1_), random_.between(y0_, y1_));
  }

  bool is_inside(std::size_t i, int x, int y) {
    const int sign = edge_sign(i, at(x, y));
    return (sign != 0 ? sign : tie_sign(line_[i].a, line_[i].b, job_.shift)) == sign_;
  }

  bool is_inside(int x, int y) { return is_inside(0, x, y) && is_inside(1, x, y) && is_inside(2, x, y); }

  // Edges in integers about an origin, for the samples of a box.
  struct Integers {
    std::int64_t a[3], b[3], e[3], doubt;
    int origin_x, origin_y, x0, x1, y0, y1;
  };

  // Of an edge in integers, v >= 0 says inside and v < -doubt says outside.
  void edges(const Integers& of, int reach) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t a = of.a[i], b = of.b[i], e = of.e[i];
      const Line& edge = line_[i];
      const auto value = [&](int x, int y) { return e + a * (x - of.origin_x) + b * (y - of.origin_y); };
      const int steps = reach - 1;
      const std::int64_t far = steps * (std::abs(a) + std::abs(b)) + std::abs(e) + 2 * of.doubt;
      expect(far < std::numeric_limits<std::int32_t>::max(), "integer edges do not overflow");
      expect(edge.a == 0 || std::fabs(edge.a) < std::fabs(edge.b) || std::abs(a) >= 1 << 21,
             "steps in x have their bits");
      expect(edge.b == 0 || std::fabs(edge.b) < std::fabs(edge.a) || std::abs(b) >= 1 << 21,
             "steps in y have their bits");
      const auto judge = [&](int x, int y) {
        const std::int64_t at_sample = value(x, y);
        if (at_sample >= 0) expect(is_inside(i, x, y), "what is surely inside is");
        if (at_sample < -of.doubt) expect(!is_inside(i, x, y), "what is surely outside is");
      };
      judge(of.x0, of.y0), judge(of.x1, of.y0), judge(of.x0, of.y1), judge(of.x1, of.y1);
      // Anywhere, and where the edge crosses a row or a column: as near as samples come to it.
      for (int n = 0; n < 6; ++n) {
        const int x = random_.between(of.x0, of.x1), y = random_.between(of.y0, of.y1);
        judge(x, y);
        if (b != 0) {
          const std::int64_t crossing = of.origin_y - (e + a * (x - of.origin_x)) / b;
          for (std::int64_t near = crossing - 1; near <= crossing + 1; ++near)
            if (near >= of.y0 && near <= of.y1) judge(x, static_cast<int>(near));
        }
        if (a != 0) {
          const std::int64_t crossing = of.origin_x - (e + b * (y - of.origin_y)) / a;
          for (std::int64_t near = crossing - 1; near <= crossing + 1; ++near)
            if (near >= of.x0 && near <= of.x1) judge(static_cast<int>(near), y);
        }
      }
    }
  }

  // Of E_i, exactly.
  int edge_sign(std::size_t i, SamplePosition p) {
    if (!draw_.grid) return triangle_.edge(static_cast<int>(i)).sign(p);
    const int units_per_pixel = 16 << draw_.grid->bits;
    const auto units = [&](double pixels) { return static_cast<std::int64_t>(pixels * units_per_pixel); };
    const SamplePosition& j = corner_[(i + 1) % 3];
    const std::int64_t left = units(line_[i].a) * units(p.x - j.x), right = units(line_[i].b) * units(j.y - p.y);
    return left > right ? 1 : left < right ? -1 : 0;
  }

  // Twice the bound of rounding. There is none exactly if all edges are integers in units of the scale: a and b, and c
  // in 2^-10 of them; under Grid, where corners are integers anyway, if the scale has bits for the smallest value
  // (grid-inl.hpp).
  void doubt(std::int64_t actual, int exponent, int bound) {
    bool none = true;
    for (const Line& line : line_) {
      const double largest = std::max({std::fabs(line.a), std::fabs(line.b), 0x1p-400});
      const double scale = std::ldexp(1, exponent - std::ilogb(largest));
      const double c = line.c * (scale * 0x1p10);
      const auto whole = [](double value) { return value == std::rint(value); };
      if (draw_.grid) {
        none = none && scale * std::ldexp(16, -2 * (draw_.grid->bits + 4)) >= 0x1p-12;
      } else {
        none =
            none && line.exact && whole(line.a * scale) && whole(line.b * scale) && whole(c) && std::fabs(c) < 0x1p52;
      }
    }
    expect(actual == (none ? 0 : 2 * bound), "edges are without doubt where they can be");
  }

  // In double, with D's sign, times a power of two; their rounding is what a tile's bound allows for.
  void scaled_edges(const fast::Record& r) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Line& line = line_[i];
      const auto near = [](double actual, double exact, double terms) {
        return std::fabs(actual - exact) <= terms * 0x1p-51;
      };
      // In W = 1 the first two are exact.
      double j[3], k[3];
      const std::size_t from = (i + 1) % 3, to = (i + 2) % 3;
      if (draw_.grid) {
        j[0] = corner_[from].x, j[1] = corner_[from].y, j[2] = 1, k[0] = corner_[to].x, k[1] = corner_[to].y, k[2] = 1;
      } else {
        const Vertex &v = triangle_.vertex(static_cast<int>(from)), &w = triangle_.vertex(static_cast<int>(to));
        j[0] = v.x, j[1] = v.y, j[2] = v.w, k[0] = w.x, k[1] = w.y, k[2] = w.w;
      }
      const auto terms = [&](std::size_t p, std::size_t q) { return std::fabs(j[p] * k[q]) + std::fabs(j[q] * k[p]); };
      const double c_terms = draw_.grid ? 2 * (std::fabs(line.a * j[0]) + std::fabs(line.b * j[1])) : terms(0, 1);
      const double scale = std::ldexp(1, 22 - std::ilogb(std::max({std::fabs(line.a), std::fabs(line.b), 0x1p-400})));
      expect(near(r.large.a[i] / scale, sign_ * line.a, terms(1, 2)) &&
                 near(r.large.b[i] / scale, sign_ * line.b, terms(2, 0)) &&
                 near(r.large.c[i] / scale, sign_ * line.c, c_terms),
             "scaled edges are the triangle's");
    }
  }

  // The bound of a depth's error holds wherever a triangle may cover: between the depths of its vertices, if all are in
  // front and it is drawn where it covers centres.
  bool is_bounded(const mpq_class& depth) const {
    mpq_class most = 0;
    for (int i = 0; i < 3; ++i) {
      const Vertex& v = triangle_.vertex(i);
      if (v.w <= 0 || draw_.grid || draw_.conservative != Conservative::none) return true;
      most = std::max<mpq_class>(most, abs(mpq_class(v.z)) / mpq_class(v.w));
    }
    return abs(depth) <= most;
  }

  // As cells put it together: high parts are exact, and depth lies between the sums with the two low parts.
  void depth_in_parts(const fast::Record& r, const mpq_class& determinant) {
    const float error = r.small.low_error;
    const auto step = [&](int x, int y, float along_x, float along_y) {
      return along_x * static_cast<float>(x) + along_y * static_cast<float>(y);
    };
    const auto judge = [&](int x, int y) {
      const int dx = x - origin_x_, dy = y - origin_y_, cx = dx >> 2, cy = dy >> 2;
      const auto sum = [&](float start, float along_x, float along_y, float offset) {
        return (start + 4 * step(cx, cy, along_x, along_y)) + (step(dx & 3, dy & 3, along_x, along_y) + offset);
      };
      const float high = sum(r.small.high, r.small.high_x, r.small.high_y, 0);
      const mpq_class exact = mpq_class(r.small.high) + mpq_class(r.small.high_x) * dx + mpq_class(r.small.high_y) * dy;
      expect(exact == mpq_class(high), "sums of high parts are exact");
      const float least = sum(r.small.low, r.small.low_x, r.small.low_y, -error),
                  most = sum(r.small.low, r.small.low_x, r.small.low_y, error);
      mpq_class real = sum_of(triangle_.exact_depth_numerator(at(x, y))) / determinant;
      if (job_.greater) real = -real;
      expect(!is_bounded(real) ||
                 (mpq_class(high) + mpq_class(least) <= real && real <= mpq_class(high) + mpq_class(most)),
             "depth lies between its parts' sums");
    };
    for_some_samples(judge);
  }

  void depth(std::uint32_t lane, const Vertex* const (&v)[3]) {
    bool within = true;
    for (const Vertex* vertex : v) within = within && vertex->w > 0 && vertex->z >= 0 && vertex->z <= vertex->w;
    const fast::Record& r = record_[lane];
    const bool small = r.has(fast::Record::kSmall);
    expect(r.has(fast::Record::kClip) == (draw_.depth_mode == DepthMode::clip && !within),
           "`clip` is what may be clipped");
    const mpq_class determinant = sum_of(triangle_.exact_determinant_value());
    double size = 0, terms = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const EdgeFunction& edge = triangle_.edge(static_cast<int>(i));
      const double x = x1_ + 1.0, y = y1_ + 1.0;
      terms += (std::fabs(edge.a) * x + std::fabs(edge.b) * y + std::fabs(edge.c)) * std::fabs(v[i]->w);
      size += std::fabs(static_cast<double>(v[i]->z));
    }
    const double d = std::fabs(determinant.get_d()), least = std::min({v[0]->w, v[1]->w, v[2]->w});
    const bool well_shaped = least > 0 && terms < 0x1p20 * d;  // and in front of the eye
    if (r.has(fast::Record::kSlowDepth)) {
      expect(!well_shaped || size / least * (terms / d) > 1e30, "depth is known where it can be");
      return;
    }
    expect(determinant != 0, "without D, no depth is known");
    if (!broken_.empty()) return;
    const double z = small ? r.small.high + static_cast<double>(r.small.low) : r.large.z;
    const double zx = small ? r.small.high_x + static_cast<double>(r.small.low_x) : r.large.z_x;
    const double zy = small ? r.small.high_y + static_cast<double>(r.small.low_y) : r.large.z_y;
    const double error = small ? static_cast<double>(r.small.low_error) : r.large.z_error;
    expect(error >= 0, "there is an error bound of depth");
    expect(std::fabs(z) + error < 1e37, "what is known of depth has a float32");
    if (!broken_.empty()) return;
    for_some_samples([&](int x, int y) {
      mpq_class real = sum_of(triangle_.exact_depth_numerator(at(x, y))) / determinant;
      if (job_.greater) real = -real;
      const double value = z + (zx * (x - origin_x_) + zy * (y - origin_y_));
      expect(!is_bounded(real) || abs(real - value) <= error, "the error bound of depth holds");
    });
    if (small) depth_in_parts(r, determinant);
    if (well_shaped) {
      const double slope = (std::fabs(zx) + std::fabs(zy)) * (64 + (x1_ - x0_) + (y1_ - y0_)) + std::fabs(z);
      const double parts = small ? 0x1p-40 * (std::fabs(z) + 18 * (std::fabs(zx) + std::fabs(zy))) + 0x1p-140 : 0;
      expect(error <= 1.001 * 0x1p-46 * (size / least + slope) * (terms / d) + parts,
             "the error bound of depth is no wider than need be");
    }
  }

  Random random_;
  Draw draw_;
  fast::DrawJob job_{};
  fast::TileGrid tiles_;
  // Of each triangle: its record, if it has one, and the tiles that list it.
  std::array<fast::Record, fast::kBatch> record_{};
  std::array<bool, fast::kBatch> is_drawn_{};
  std::array<std::vector<std::uint32_t>, fast::kBatch> listed_;
  Triangle triangle_;
  SnappedTriangle snapped_;
  SamplePosition corner_[3] = {};  // of the snapped triangle
  // E_i of what is drawn, in double; exact: without rounding errors.
  struct Line {
    double a, b, c;
    bool exact;
  };
  Line line_[3] = {};
  int sign_ = 0;                          // of D
  std::uint64_t clipped_ = 0;             // triangles
  std::uint64_t unsure_ = 0, turns_ = 0;  // signs and positions that may have to be looked up
  bool clips_ = false;
  int x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, origin_x_ = 0, origin_y_ = 0;
  std::string broken_;
};

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP
