// SPDX-License-Identifier: Apache-2.0
//
// Batches of triangles into the blocks of the canvas: coverage by int32 edge functions with deferred uncertainty,
// hierarchical z.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_BLOCK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_BLOCK_INL_HPP
#undef SUREFILL_SRC_BLOCK_INL_HPP
#else
#define SUREFILL_SRC_BLOCK_INL_HPP
#endif

#include "cell-inl.hpp"
#include "hwy/cache_control.h"
#include "tiny-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// kWinner and kCount only with a canvas that has them; kWinner implies kDepth.
template <bool kDepth, bool kWinner, bool kCount>
class Rasterizer {
 public:
  Rasterizer(const DrawJob& job, const Canvas& canvas, const BandSet& bands, Statistics& statistics)
      : job_(job), canvas_(canvas), bands_(bands), writer_(job, canvas, bands, statistics) {
    for (int odd = 0; odd < 4; ++odd) {  // whether an area begins at an odd column of cells, and at an odd row
      for (int n = 0; n < 16; ++n) {
        const int x = (odd & 1) * 4 + (n & 3) * 4, y = (odd >> 1) * 4 + (n >> 2) * 4;
        cell_offsets_[odd][n] = static_cast<std::uint32_t>(canvas_.offset_in_blocks(x, y) -
                                                           canvas_.offset_in_blocks((odd & 1) * 4, (odd >> 1) * 4));
      }
    }
  }

  void Run(std::span<const Batch> batches) {
    for (std::size_t i = 0; i < batches.size(); ++i) {
      if (kDepth && i + 1 < batches.size()) Prefetch(batches[i + 1]);
      batch_ = &batches[i];
      if (HWY_UNLIKELY(batch_->clipped != 0 || canvas_.masks != nullptr)) {
        OneByOne();
      } else {
        Lanes(batch_->live);
      }
    }
  }

 private:
  // The triangles of some lanes: in order, but for those that can tell who comes first.
  HWY_NOINLINE void Lanes(std::uint32_t lanes) {
    special_ = writer_.AnySpecial(*batch_, batch_->live);
    const std::uint32_t tiny = special_ || (kDepth && kCount) ? 0 : batch_->tiny & lanes;
    lanes &= ~tiny;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
      if ((batch_->small >> lane & 1) != 0) {
        Touch(lane);
        Small(lane);
        continue;
      }
      DrawSmall();  // those before it
      if ((batch_->medium >> lane & 1) != 0) {
        Touch(lane);
        Medium(lane);
      } else {
        Large(lane);
      }
    }
    DrawSmall();
    if (tiny == 0) return;
    for (std::uint32_t rest = tiny; rest != 0; rest &= rest - 1) Touch(static_cast<std::uint32_t>(__builtin_ctz(rest)));
    DrawTiny(*batch_, tiny, canvas_, bands_, writer_);
  }

  // The same where some are clipped, or a visitor has to see each.
  HWY_NOINLINE void OneByOne() {
    for (std::uint32_t lanes = batch_->live | batch_->clipped; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
      if ((batch_->clipped >> lane & 1) != 0) {
        Clipped(batch_->position(lane));
      } else {
        Lanes(1u << lane);
      }
      if (kCount && canvas_.masks != nullptr) writer_.Emit(batch_->position(lane));
    }
  }

  // The tiles of the lane's box get values, if they have none.
  HWY_INLINE void Touch(std::uint32_t lane) const {
    const int x0 = batch_->first_x[lane], x1 = batch_->last_x[lane];
    const int y0 = batch_->first_y[lane], y1 = batch_->last_y[lane];
    if (((x0 ^ x1) | (y0 ^ y1)) >> kTileLog2 == 0) {
      TouchTile(canvas_.tile_of(x0, y0));
    } else {
      TouchBox(x0, x1, y0, y1);
    }
  }
  HWY_INLINE void TouchTile(std::size_t tile) const {
    if (HWY_UNLIKELY(canvas_.untouched[tile] != 0)) canvas_.touch(canvas_.renderer, tile);
  }
  HWY_NOINLINE void TouchBox(int x0, int x1, int y0, int y1) const {
    for (int ty = y0 >> kTileLog2; ty <= y1 >> kTileLog2; ++ty) {
      if (!bands_.owns(ty)) continue;
      for (int tx = x0 >> kTileLog2; tx <= x1 >> kTileLog2; ++tx)
        TouchTile(canvas_.tile_of(tx * kTileSize, ty * kTileSize));
    }
  }

  // A triangle that Grid clips: the fan of its polygon, or, where the fan has both signs, sample by sample.
  HWY_NOINLINE void Clipped(std::uint32_t position) {
    SnappedTriangle& snapped = writer_.Snapped(position);
    const Batch* const others = batch_;
    Batch fan;
    if (SetUpFan(job_, position, snapped, fan)) {
      if (!bands_.all) fan.live &= OwnedLanes(bands_, fan, 0, kBatch).any;
      batch_ = &fan;
      Lanes(fan.live);
      batch_ = others;
      return;
    }
    const double least = std::min(job_.sample.x, job_.sample.y), most = std::max(job_.sample.x, job_.sample.y);
    const PixelBox box = snapped.box(job_.region, least, most);
    for (int y = box.y0; y < box.y1; ++y) {
      if (!bands_.owns(y >> kTileLog2)) continue;
      for (int x = box.x0; x < box.x1; ++x) {
        const int facing = snapped.winding({x + job_.sample.x, y + job_.sample.y}, job_.shift);
        if (facing == 0 || Culls(facing)) continue;
        TouchTile(canvas_.tile_of(x, y));
        writer_.SlowFragment(position, x, y);
      }
    }
  }
  bool Culls(int facing) const {
    const bool front = (facing > 0) == (job_.draw->front_face == FrontFace::clockwise);
    return job_.draw->cull == (front ? Cull::front : Cull::back);
  }

  // Small triangles lie anywhere: their cells are asked for a batch ahead. (Inlined: g++ drops calls of functions that
  // only prefetch.)
  HWY_INLINE void Prefetch(const Batch& batch) const {
    for (std::uint32_t small = batch.live & batch.small; small != 0; small &= small - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(small));
      // The corners of the box: all its cells, if it is at most two cells wide and high.
      const int x[2] = {batch.first_x[lane], batch.last_x[lane]}, y[2] = {batch.first_y[lane], batch.last_y[lane]};
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t offset = canvas_.column[x[i & 1] >> kCellLog2] + canvas_.row[y[i >> 1] >> kCellLog2];
        hwy::Prefetch(canvas_.depth + offset);
        if (kWinner) hwy::Prefetch(canvas_.winner + offset);
      }
    }
  }

  // ---- within 4 x 4 cells: noted, and drawn with the rest of the batch
  HWY_INLINE void Small(std::uint32_t lane) {
    const CellInt d;
    const CellFloat df;
    const Batch& batch = *batch_;
    const std::size_t at = lane * 16;
    const int x = batch.first_x[lane] & ~3, y = batch.first_y[lane] & ~3;
    std::uint32_t outside = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      const auto column = hn::Load(d, kColumn + i), row = hn::Load(d, kRow + i);
      auto lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto step =
            hn::Add(hn::Mul(hn::Set(d, batch.a[k][lane]), column), hn::Mul(hn::Set(d, batch.b[k][lane]), row));
        const auto value = hn::Add(hn::Set(d, batch.e[k][lane]), hn::ShiftLeft<2>(step));
        hn::Store(step, d, steps_.edge[k] + at + i);
        hn::Store(value, d, areas_.edge[k] + at + i);
        lanes = hn::Or(lanes, hn::Add(value, hn::Set(d, batch.most[k][lane])));  // negative if one is
      }
      outside |= Bits(d, hn::Lt(lanes, hn::Zero(d))) << i;
      if (kDepth) {
        const auto high = LoadDepthSteps(lane, i, batch.high_x[lane], batch.high_y[lane], batch.low_x[lane],
                                         batch.low_y[lane], batch.low_error[lane]);
        const auto four = hn::Set(df, 4.0f);
        hn::Store(hn::Add(hn::Set(df, batch.high[lane]), hn::Mul(four, high.high)), df, areas_.high + at + i);
        hn::Store(hn::Add(hn::Set(df, batch.low[lane]), hn::Mul(four, high.low)), df, areas_.low + at + i);
      }
    }
    Place(lane, x, y);
    const int columns = (batch.last_x[lane] - x) >> 2, rows = (batch.last_y[lane] - y) >> 2;
    std::uint32_t cells = ~outside & ((0x2222u << columns) - 0x1111u) & ((0x10u << (4 * rows)) - 1);
    if (!bands_.all) cells &= OwnedRows(y, 4);
    partly_.Append(lane, cells);
    small_doubt_ = std::max(small_doubt_, batch.doubt[lane]);
  }

  // Steps of depth in lanes i ... of a slot's cells.
  struct DepthSteps {
    hn::Vec<CellFloat> high, low;
  };
  HWY_INLINE DepthSteps LoadDepthSteps(std::size_t slot, std::size_t i, float high_x, float high_y, float low_x,
                                       float low_y, float error) {
    const CellFloat df;
    const auto column = hn::Load(df, kColumnFloat + i), row = hn::Load(df, kRowFloat + i);
    const auto high = hn::Add(hn::Mul(hn::Set(df, high_x), column), hn::Mul(hn::Set(df, high_y), row));
    const auto low = hn::Add(hn::Mul(hn::Set(df, low_x), column), hn::Mul(hn::Set(df, low_y), row));
    const std::size_t at = slot * 16 + i;
    hn::Store(high, df, steps_.high + at);
    hn::Store(hn::Sub(low, hn::Set(df, error)), df, steps_.low_least + at);
    hn::Store(hn::Add(low, hn::Set(df, error)), df, steps_.low_most + at);
    return {high, low};
  }

  // Where the cells of area n lie, which begins at (x, y).
  HWY_INLINE void Place(std::size_t n, int x, int y) {
    const CellUint d;
    areas_.x[n] = x, areas_.y[n] = y;
    const std::uint32_t* const offsets = cell_offsets_[(x >> 2 & 1) + (y >> 1 & 2)];
    const auto first = hn::Set(d, static_cast<std::uint32_t>(canvas_.offset_of(x, y)));
    for (std::size_t i = 0; i < 16; i += kCellLanes)
      hn::Store(hn::Add(first, hn::Load(d, offsets + i)), d, areas_.offset + n * 16 + i);
  }

  HWY_INLINE void DrawSmall() {
    if (partly_.size == 0) return;
    DrawCells<true>(small_doubt_);
    small_doubt_ = 0;
  }

  // Of four rows of cells, or of areas, those that meet bands of this set.
  std::uint32_t OwnedRows(int y, int height) const {
    std::uint32_t owned = 0;
    for (int row = 0; row < 4; ++row) {
      const int first = y + height * row, last = first + height - 1;
      if (bands_.owns(first >> kTileLog2) || bands_.owns(last >> kTileLog2)) owned |= 0xFu << (4 * row);
    }
    return owned;
  }

  // What belongs to other threads is not even looked at: is the block there in a band of this set, and are all four of
  // the area?
  bool OwnsBlock(int x, int y) const { return bands_.owns(y >> kTileLog2) && x >> kTileLog2 < canvas_.tiles_x; }
  bool OwnsBlocks(int x, int y) const { return OwnsBlock(x + 8, y) && OwnsBlock(x + 8, y + 8); }

  // ---- within 8 x 8 blocks
  void Medium(std::uint32_t lane) {
    Plane plane;
    for (std::size_t k = 0; k < 3; ++k)
      plane.a[k] = batch_->a[k][lane], plane.b[k] = batch_->b[k][lane], plane.most[k] = batch_->most[k][lane];
    plane.doubt = batch_->doubt[lane];
    LoadPlane(plane, lane);
    const std::int32_t e[3] = {batch_->e[0][lane], batch_->e[1][lane], batch_->e[2][lane]};
    Tile(plane, e, batch_->first_x[lane] & ~7, batch_->first_y[lane] & ~7);
  }

  // What does not depend on the class.
  HWY_INLINE void LoadPlane(Plane& plane, std::uint32_t lane) {
    const Batch& batch = *batch_;
    const CellInt d;
    plane.lane = lane;
    for (std::size_t k = 0; k < 3; ++k) {
      plane.least[k] = 3 * (std::min(plane.a[k], 0) + std::min(plane.b[k], 0));
      const auto a = hn::Set(d, plane.a[k]), b = hn::Set(d, plane.b[k]);
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto step = hn::Add(hn::Mul(a, hn::Load(d, kColumn + i)), hn::Mul(b, hn::Load(d, kRow + i)));
        hn::Store(step, d, steps_.edge[k] + i);
        hn::Store(hn::ShiftLeft<2>(step), d, cell_step_[k] + i);
        hn::Store(hn::ShiftLeft<4>(step), d, area_step_[k] + i);
      }
    }
    plane.hides = false;
    if (!kDepth) return;
    plane.z = batch.z[lane], plane.z_x = batch.z_x[lane], plane.z_y = batch.z_y[lane];
    plane.z_error = batch.z_error[lane];
    plane.origin_x = batch.origin_x(lane), plane.origin_y = batch.origin_y(lane);
    plane.z_most = job_.draw->grid.has_value() ? batch.z_most[lane] : std::numeric_limits<float>::infinity();
    // Not where fragments count, or move.
    plane.hides = !kCount && (batch.slow_depth >> lane & 1) == 0 && !((batch.clip >> lane & 1) != 0 && writer_.clamps);
  }

  // ---- larger: tile by tile, with a scale for 64 samples
  void Large(std::uint32_t lane) {
    Plane plane;
    double a[3], b[3], c[3], most[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double ua = batch_->edge_a[i][lane], ub = batch_->edge_b[i][lane];
      const double scale =
          std::ldexp(1.0, kTileExponent - std::ilogb(std::max({std::fabs(ua), std::fabs(ub), 0x1p-400})));
      a[i] = ua * scale, b[i] = ub * scale, c[i] = batch_->edge_c[i][lane] * scale;
      plane.a[i] = static_cast<std::int32_t>(std::nearbyint(a[i]));
      plane.b[i] = static_cast<std::int32_t>(std::nearbyint(b[i]));
      most[i] = (kTileSize - 1) * (std::max(a[i], 0.0) + std::max(b[i], 0.0)) + 1;  // 1: far more than E's error here
    }
    constexpr std::int32_t kBound = kExactCoverage ? kTileBound : 0;
    plane.doubt = 2 * kBound;
    for (std::size_t k = 0; k < 3; ++k)
      plane.most[k] = 3 * (std::max(plane.a[k], 0) + std::max(plane.b[k], 0)) + plane.doubt;
    LoadPlane(plane, lane);
    const int first_x = batch_->first_x[lane] & ~(kTileSize - 1), first_y = batch_->first_y[lane] & ~(kTileSize - 1);
    const int last_x = batch_->last_x[lane] - (SUREFILL_PLANT(tile_border) ? 1 : 0), last_y = batch_->last_y[lane];
    const double dip = kDepth ? Dip(plane, kTileSize - 1) : 0;

    const DoubleTag d;
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(DoubleTag()));
    alignas(64) double e[3][kBatch];
    const auto columns = hn::Load(d, kTileSteps);
    for (int ty = first_y; ty <= last_y; ty += kTileSize) {
      if (!bands_.owns(ty >> kTileLog2)) continue;
      for (int tx = first_x; tx <= last_x; tx += kTileSize * kLanes) {
        const auto column = hn::Add(hn::Set(d, tx), columns);
        const auto x = hn::Add(column, hn::Set(d, job_.sample.x));
        const double y = ty + job_.sample.y;
        auto possible = hn::Le(column, hn::Set(d, last_x));
        for (std::size_t i = 0; i < 3; ++i) {
          const auto value = hn::Add(hn::Add(hn::Mul(hn::Set(d, a[i]), x), hn::Set(d, b[i] * y)), hn::Set(d, c[i]));
          hn::Store(value, d, e[i]);
          possible = hn::And(possible, hn::Ge(value, hn::Set(d, -most[i])));
        }
        if (plane.hides) {
          const hn::Rebind<float, DoubleTag> df;
          const auto dx = hn::Sub(column, hn::Set(d, plane.origin_x));
          const auto nearest = hn::Min(hn::Add(hn::Mul(hn::Set(d, plane.z_x), dx),
                                               hn::Set(d, plane.z_y * (ty - plane.origin_y) + (plane.z + dip))),
                                       hn::Set(d, plane.z_most));
          const auto far = hn::PromoteTo(d, hn::LoadU(df, canvas_.tile_far + canvas_.far_of(tx, ty)));
          possible = hn::AndNot(writer_.with_identifiers ? hn::Gt(hn::PromoteTo(d, hn::DemoteTo(df, nearest)), far)
                                                         : hn::Ge(nearest, far),
                                possible);
        }
        for (std::uint32_t tiles = Bits(d, possible); tiles != 0; tiles &= tiles - 1) {
          const auto n = static_cast<std::size_t>(__builtin_ctz(tiles));
          std::int32_t at[3];
          for (std::size_t i = 0; i < 3; ++i) {
            at[i] = static_cast<std::int32_t>(std::nearbyint(std::clamp(e[i][n], -kEdgeLimit, kEdgeLimit))) - kBound;
          }
          const int x0 = tx + static_cast<int>(n) * kTileSize;
          TouchTile(canvas_.tile_of(x0, ty));
          if (Tile(plane, at, x0, ty)) UpdateTileFar(x0, ty);
        }
      }
    }
  }
  alignas(64) static constexpr double kTileSteps[8] = {0, 64, 128, 192, 256, 320, 384, 448};

  // The 64 x 64 samples from (x, y) on, a multiple of 8, where the edges have the values e. True if block_far has
  // changed.
  bool Tile(const Plane& plane, const std::int32_t (&e)[3], int x, int y) {
    const CellInt d;
    const Batch& batch = *batch_;
    const int first_x = batch.first_x[plane.lane] - x, last_x = batch.last_x[plane.lane] - x;
    const int first_y = batch.first_y[plane.lane] - y, last_y = batch.last_y[plane.lane] - y;
    alignas(64) std::int32_t at[3][16];
    std::uint32_t outside = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      auto lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::Load(d, area_step_[k] + i));
        hn::Store(value, d, at[k] + i);
        lanes = hn::Or(lanes, hn::Add(value, hn::Set(d, 5 * plane.most[k])));
      }
      outside |= Bits(d, hn::Lt(lanes, hn::Zero(d))) << i;
    }
    std::uint32_t possible = ~outside & Mask4x4(first_x >> 4, last_x >> 4, first_y >> 4, last_y >> 4);
    if (!bands_.all) possible &= OwnedRows(y, 16);
    if (possible == 0) return false;
    const double dip = kDepth ? Dip(plane, SUREFILL_PLANT(hierarchical_z) ? 6 : 7) : 0;
    alignas(32)
        const double dips[4] = {dip, dip + 8 * plane.z_x, dip + 8 * plane.z_y, dip + 8 * (plane.z_x + plane.z_y)};
    const Splitter<OneDouble> splitter = SplitterOf(plane, x, y);
    if (kDepth) LoadDepthSteps(plane, splitter);
    std::size_t blocks = 0;
    std::uint32_t block_list[64];  // whole blocks: block_far may become less
    for (; possible != 0; possible &= possible - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(possible));
      const int area_x = static_cast<int>(n & 3) * 16, area_y = static_cast<int>(n >> 2) * 16;
      const std::int32_t start[3] = {at[0][n], at[1][n], at[2][n]};
      std::uint32_t full;
      std::uint32_t cells = SetUpArea(plane, start, n, &full);
      if (first_x >= area_x + 4 || last_x < area_x + 12 || first_y >= area_y + 4 || last_y < area_y + 12) {
        cells &=
            Mask4x4((first_x - area_x) >> 2, (last_x - area_x) >> 2, (first_y - area_y) >> 2, (last_y - area_y) >> 2);
      }
      if (!bands_.all) cells &= OwnedRows(y + area_y, 4);
      const double z = kDepth ? plane.DepthAt(x + area_x, y + area_y) : 0;
      if (plane.hides) {
        const std::size_t block = canvas_.block_of(x + area_x, y + area_y);
        const auto below = static_cast<std::size_t>(canvas_.blocks_x());
        const float* far = canvas_.block_far + block;
        float own[4];
        if (!bands_.all && !OwnsBlocks(x + area_x, y + area_y)) {
          for (int i = 0; i < 4; ++i) {
            const int right = x + area_x + 8 * (i & 1), down = y + area_y + 8 * (i >> 1);
            own[i] = OwnsBlock(right, down) ? canvas_.block_far[canvas_.block_of(right, down)] : 0;
          }
          far = own;
        }
        cells &= kCellsOfBlocks[VisibleBlocks(plane, z, dips, far, far == own ? 2 : below)];
        // Of each whole block, its first cell.
        std::uint32_t whole = cells & full;
        whole &= whole >> 1;
        whole &= (whole >> 4) & 0x0505;
        for (; whole != 0; whole &= whole - 1) {
          const auto cell = static_cast<std::size_t>(__builtin_ctz(whole));
          block_list[blocks++] = static_cast<std::uint32_t>(block + (cell >> 3) * below + (cell >> 1 & 1));
        }
      }
      if (cells == 0) continue;
      Place(n, x + area_x, y + area_y);
      if (kDepth) SetUpDepth(splitter, z, n);
      partly_.Append(n, cells & ~full);
      wholly_.Append(n, cells & full);
    }
    plane_lane_ = plane.lane, plane_doubt_ = plane.doubt;
    DrawCells<false>(plane.doubt);
    DrawWholeCells();
    for (std::size_t i = 0; i < blocks; ++i) UpdateBlockFar(block_list[i]);
    return blocks != 0;
  }

  // The edges at the cells of area n, where they start with the values e. Returns the cells that are not outside an
  // edge, and in `full` those that are within all.
  HWY_INLINE std::uint32_t SetUpArea(const Plane& plane, const std::int32_t (&e)[3], std::size_t n,
                                     std::uint32_t* full) {
    const CellInt d;
    std::uint32_t outside = 0, cut = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      auto outside_lanes = hn::Zero(d), cut_lanes = outside_lanes;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::Load(d, cell_step_[k] + i));
        hn::Store(value, d, areas_.edge[k] + n * 16 + i);
        outside_lanes = hn::Or(outside_lanes, hn::Add(value, hn::Set(d, plane.most[k])));  // negative if one is
        cut_lanes = hn::Or(cut_lanes, hn::Add(value, hn::Set(d, plane.least[k])));
      }
      outside |= Bits(d, hn::Lt(outside_lanes, hn::Zero(d))) << i;
      cut |= Bits(d, hn::Lt(cut_lanes, hn::Zero(d))) << i;
    }
    *full = ~cut & 0xFFFF;
    return ~outside & 0xFFFF;
  }

  // ---- depth in parts
  using OneDouble = hn::CappedTag<double, 1>;
  static HWY_INLINE Splitter<OneDouble> SplitterOf(const Plane& plane, int x, int y) {
    const double largest =
        kDepth ? std::fabs(plane.DepthAt(x, y)) + (kTileSize - 1) * (std::fabs(plane.z_x) + std::fabs(plane.z_y)) : 0;
    return Splitter<OneDouble>(hn::Set(OneDouble(), largest));
  }
  struct Parts {
    float high, low;
  };
  static HWY_INLINE Parts Split(const Splitter<OneDouble>& splitter, double v) {
    typename Splitter<OneDouble>::Part high, low;
    splitter.Split(hn::Set(OneDouble(), v), high, low);
    return {hn::GetLane(high), hn::GetLane(low)};
  }
  // Of a tile.
  HWY_INLINE void LoadDepthSteps(const Plane& plane, const Splitter<OneDouble>& splitter) {
    const CellFloat df;
    const Parts x = Split(splitter, plane.z_x), y = Split(splitter, plane.z_y);
    const double error = hn::GetLane(splitter.Error(hn::Set(OneDouble(), plane.z_error)));
    const bool zero = plane.z_error == 0;  // then depth is 0 everywhere (StoreDepth)
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      const auto step = LoadDepthSteps(0, i, x.high, y.high, x.low, y.low, zero ? 0.0f : static_cast<float>(error));
      hn::Store(hn::Mul(step.high, hn::Set(df, 4.0f)), df, cell_high_ + i);
      hn::Store(hn::Mul(step.low, hn::Set(df, 4.0f)), df, cell_low_ + i);
    }
  }
  // Of the cells of area n, where depth starts with z.
  HWY_INLINE void SetUpDepth(const Splitter<OneDouble>& splitter, double z, std::size_t n) {
    const CellFloat df;
    const Parts start = Split(splitter, z);
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      hn::Store(hn::Add(hn::Set(df, start.high), hn::Load(df, cell_high_ + i)), df, areas_.high + n * 16 + i);
      hn::Store(hn::Add(hn::Set(df, start.low), hn::Load(df, cell_low_ + i)), df, areas_.low + n * 16 + i);
    }
  }

  // Which of an area's four blocks may hold something farther than the triangle: bit 0 the upper left one, then to the
  // right, then below; depths that are equal once they are rounded may leave a smaller identifier in front. dips: from
  // the depth at the area's first sample to less than any in each block.
  HWY_INLINE std::uint32_t VisibleBlocks(const Plane& plane, double z, const double (&dips)[4], const float* far,
                                         std::size_t below) const {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    const hn::CappedTag<double, 4> d;
    const hn::CappedTag<float, 4> df;
    const hn::CappedTag<float, 2> row;
    const auto nearest = hn::Min(hn::Add(hn::Set(d, z), hn::Load(d, dips)), hn::Set(d, plane.z_most));
    const auto there = hn::PromoteTo(d, hn::Combine(df, hn::LoadU(row, far + below), hn::LoadU(row, far)));
    const auto hidden =
        writer_.with_identifiers ? hn::Gt(hn::PromoteTo(d, hn::DemoteTo(df, nearest)), there) : hn::Ge(nearest, there);
    return ~Bits(d, hidden) & 15;
#else
    std::uint32_t visible = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double nearest = std::min<double>(z + dips[i], plane.z_most), there = far[(i >> 1) * below + (i & 1)];
      visible |= static_cast<std::uint32_t>(
                     !(writer_.with_identifiers ? static_cast<float>(nearest) > there : nearest >= there))
                 << i;
    }
    return visible;
#endif
  }
  // The cells of a set of blocks.
  static constexpr std::uint16_t kCellsOfBlocks[16] = {0x0000, 0x0033, 0x00CC, 0x00FF, 0x3300, 0x3333, 0x33CC, 0x33FF,
                                                       0xCC00, 0xCC33, 0xCCCC, 0xCCFF, 0xFF00, 0xFF33, 0xFFCC, 0xFFFF};

  // ---- cells
  // The least of the three edge values in lanes i ... of a cell.
  HWY_INLINE hn::Vec<CellInt> LeastEdge(std::size_t item, std::size_t steps) const {
    const CellInt d;
    const auto e0 = hn::Add(hn::Set(d, areas_.edge[0][item]), hn::Load(d, steps_.edge[0] + steps));
    const auto e1 = hn::Add(hn::Set(d, areas_.edge[1][item]), hn::Load(d, steps_.edge[1] + steps));
    const auto e2 = hn::Add(hn::Set(d, areas_.edge[2][item]), hn::Load(d, steps_.edge[2] + steps));
    return hn::Min(hn::Min(e0, e1), e2);
  }
  // Depth lies between these two.
  HWY_INLINE hn::Vec<CellFloat> LeastDepth(std::size_t item, std::size_t steps) const {
    return DepthOf(item, steps, steps_.low_least);
  }
  HWY_INLINE hn::Vec<CellFloat> MostDepth(std::size_t item, std::size_t steps) const {
    return DepthOf(item, steps, steps_.low_most);
  }
  HWY_INLINE hn::Vec<CellFloat> DepthOf(std::size_t item, std::size_t steps, const float* low) const {
    const CellFloat df;
    if (!kDepth) return hn::Zero(df);
    const auto high = hn::Add(hn::Set(df, areas_.high[item]), hn::Load(df, steps_.high + steps));
    if (!kExactDepth) return high;
    return hn::Add(high, hn::Add(hn::Set(df, areas_.low[item]), hn::Load(df, low + steps)));
  }
  // Of the item's cell: the lane of the batch, and where its steps begin. kSmall: each area has its own slot.
  template <bool kSmall>
  HWY_INLINE std::uint32_t LaneOf(std::size_t item) const {
    return kSmall ? static_cast<std::uint32_t>(item >> 4) : plane_lane_;
  }

  template <bool kSmall>
  HWY_INLINE std::int32_t DoubtOf(std::uint32_t lane) const {
    return kSmall ? batch_->doubt[lane] : plane_doubt_;
  }

  // Draws the cells that an edge may cut: the lanes that are surely inside, and in the end those within `doubt` of an
  // edge. kSmall: of all small triangles that were noted.
  template <bool kSmall>
  HWY_NOINLINE void DrawCells(std::int32_t doubt) {
    if (HWY_UNLIKELY(special_)) {
      for (std::size_t n = 0; n < partly_.size; ++n) DrawSpecial<kSmall, false>(partly_.items[n]);
      partly_.size = 0;
      return;
    }
    const CellInt d;
    const CellUint du;
    const CellFloat df;
    auto closest = hn::Zero(du);  // the largest value below 0, as it is the largest without a sign
    for (std::size_t n = 0; n < partly_.size; ++n) {
      const std::size_t item = partly_.items[n], steps = kSmall ? item & 0xF0 : 0;
      const std::size_t offset = areas_.offset[item];
      const auto ordinal = hn::Set(du, writer_.Ordinal(batch_->position(LaneOf<kSmall>(item))));
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto value = LeastEdge(item, steps + i);
        closest = hn::Max(closest, hn::BitCast(du, value));
        const auto covered = hn::Not(hn::Lt(value, hn::Zero(d)));
        if constexpr (kDepth) {
          const auto unknown =
              writer_.template Fragments<false>(hn::RebindMask(df, covered), LeastDepth(item, steps + i),
                                                MostDepth(item, steps + i), ordinal, offset + i);
          if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) SlowLanes<kSmall>(item, Bits(df, unknown) << i);
        } else {
          writer_.Count(covered, offset + i);
        }
      }
    }
    if (kExactCoverage && HWY_UNLIKELY(!hn::AllFalse(du, IsDoubtful(closest, doubt)))) {
      for (std::size_t n = 0; n < partly_.size; ++n) {
        const std::size_t item = partly_.items[n];
        for (std::size_t i = 0; i < 16; i += kCellLanes)
          Settle<kSmall>(item, LeastEdge(item, (kSmall ? item & 0xF0 : 0) + i), i);
      }
    }
    partly_.size = 0;
  }

  // Draws the cells that all edges hold whole.
  HWY_NOINLINE void DrawWholeCells() {
    if (HWY_UNLIKELY(special_)) {
      for (std::size_t n = 0; n < wholly_.size; ++n) DrawSpecial<false, true>(wholly_.items[n]);
      wholly_.size = 0;
      return;
    }
    const CellUint du;
    const CellFloat df;
    const auto all = hn::Eq(hn::Zero(df), hn::Zero(df));
    const auto ordinal = hn::Set(du, writer_.Ordinal(batch_->position(plane_lane_)));
    for (std::size_t n = 0; n < wholly_.size; ++n) {
      const std::size_t item = wholly_.items[n], offset = areas_.offset[item];
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        if constexpr (kDepth) {
          const auto unknown =
              writer_.template Fragments<true>(all, LeastDepth(item, i), MostDepth(item, i), ordinal, offset + i);
          if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) SlowLanes<false>(item, Bits(df, unknown) << i);
        } else {
          writer_.Count(hn::RebindMask(CellInt(), all), offset + i);
        }
      }
    }
    wholly_.size = 0;
  }

  // -doubt <= value < 0, as numbers without a sign.
  static HWY_INLINE hn::Mask<CellUint> IsDoubtful(hn::Vec<CellUint> value, std::int32_t doubt) {
    const CellUint du;
    return hn::Gt(value, hn::Set(du, ~static_cast<std::uint32_t>(doubt)));
  }

  // Lanes i ... of a cell that are within the doubt of an edge; the least edge values are known.
  template <bool kSmall>
  HWY_INLINE void Settle(std::size_t item, hn::Vec<CellInt> value, std::size_t i) {
    const CellUint du;
    const std::uint32_t lane = LaneOf<kSmall>(item);
    const auto bits = Bits(du, IsDoubtful(hn::BitCast(du, value), DoubtOf<kSmall>(lane)));
    if (HWY_UNLIKELY(bits != 0)) SettleLanes(item, lane, bits << i);
  }
  HWY_NOINLINE void SettleLanes(std::size_t item, std::uint32_t lane, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits), x = areas_.CellX(item) + (k & 3), y = areas_.CellY(item) + (k >> 2);
      if (writer_.Covers(*batch_, lane, x, y)) writer_.SlowFragment(batch_->position(lane), x, y);
    }
  }
  // Covered lanes of a cell whose depth is not known.
  template <bool kSmall>
  HWY_NOINLINE void SlowLanes(std::size_t item, std::uint32_t bits) {
    writer_.SlowLanes(batch_->position(LaneOf<kSmall>(item)), bits, areas_.CellX(item), areas_.CellY(item));
  }

  // A cell that is not drawn as most are, at once.
  template <bool kSmall, bool kWhole>
  HWY_INLINE void DrawSpecial(std::size_t item) {
    const CellInt d;
    const std::size_t steps = kSmall ? item & 0xF0 : 0;
    const std::uint32_t lane = LaneOf<kSmall>(item);
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      const auto value = LeastEdge(item, steps + i);
      const auto covered = kWhole ? hn::Eq(value, value) : hn::Not(hn::Lt(value, hn::Zero(d)));
      writer_.SpecialFragments(*batch_, lane, covered, LeastDepth(item, steps + i), MostDepth(item, steps + i),
                               areas_.CellX(item), areas_.CellY(item), areas_.offset[item], i);
      if (kExactCoverage && !kWhole) Settle<kSmall>(item, value, i);
    }
  }

  // ---- hierarchical z
  // From the depth at a first sample to less than any within `reach` steps each way. z_error has room for the rounding
  // of this, too, and of what it is added to (docs/precision.md).
  static double Dip(const Plane& plane, double reach) {
    return std::min(0.0, reach * plane.z_x) + std::min(0.0, reach * plane.z_y) - plane.z_error;
  }

  HWY_INLINE void UpdateBlockFar(std::size_t block) {
    const CellFloat df;
    const float* const depth = canvas_.depth + block * 64;
    auto far = hn::Load(df, depth);
    for (std::size_t i = kCellLanes; i < 64; i += kCellLanes) far = hn::Max(far, hn::Load(df, depth + i));
    canvas_.block_far[block] = hn::GetLane(hn::MaxOfLanes(df, far));
  }

  void UpdateTileFar(int x, int y) {
    const hn::CappedTag<float, 8> df;
    const float* row = canvas_.block_far + canvas_.block_of(x, y);
    auto far = hn::Set(df, -std::numeric_limits<float>::infinity());
    for (int r = 0; r < 8; ++r, row += canvas_.blocks_x()) {
      for (std::size_t i = 0; i < 8; i += hn::Lanes(df)) far = hn::Max(far, hn::LoadU(df, row + i));
    }
    canvas_.tile_far[canvas_.far_of(x, y)] = hn::GetLane(hn::MaxOfLanes(df, far));
  }

  const DrawJob& job_;
  const Canvas canvas_;
  const BandSet& bands_;
  FragmentWriter<kDepth, kWinner, kCount> writer_;

  const Batch* batch_ = nullptr;
  bool special_ = false;          // some lanes are not drawn as most are
  std::uint32_t plane_lane_ = 0;  // of what is drawn tile by tile
  std::int32_t plane_doubt_ = 0;
  std::int32_t small_doubt_ = 0;  // the largest of those noted: at worst, doubts are looked into that are none
  Steps steps_;
  Areas areas_;
  alignas(64) std::int32_t cell_step_[3][16], area_step_[3][16];  // edge functions: to cells of an area, to areas
  alignas(64) float cell_high_[16], cell_low_[16];                // depth: to the cells of an area
  alignas(64) std::uint32_t cell_offsets_[4][16];
  CellList partly_, wholly_;
};

void Rasterize(const DrawJob& job, std::span<const Batch> batches, const Canvas& canvas, const BandSet& bands,
               Statistics& statistics) {
  if (canvas.depth == nullptr) {
    if (canvas.count != nullptr || canvas.masks != nullptr)
      Rasterizer<false, false, true>(job, canvas, bands, statistics).Run(batches);
  } else if (canvas.winner == nullptr) {
    Rasterizer<true, false, false>(job, canvas, bands, statistics).Run(batches);
  } else if (canvas.count == nullptr && canvas.masks == nullptr) {
    Rasterizer<true, true, false>(job, canvas, bands, statistics).Run(batches);
  } else {
    Rasterizer<true, true, true>(job, canvas, bands, statistics).Run(batches);
  }
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_BLOCK_INL_HPP
