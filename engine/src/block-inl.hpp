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
#include "fragment-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
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
  // The triangles of some lanes, in order.
  HWY_NOINLINE void Lanes(std::uint32_t lanes) {
    if (!bands_.all) lanes &= OwnedLanes();
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
      if ((batch_->small >> lane & 1) != 0) {
        Touch(lane);
        Small(lane);
        continue;
      }
      DrawCells(1);  // the small ones before it
      if ((batch_->medium >> lane & 1) != 0) {
        Touch(lane);
        Medium(lane);
      } else {
        Large(lane);
      }
    }
    DrawCells(1);
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
      batch_ = &fan;
      Lanes(fan.live);
      batch_ = others;
      return;
    }
    const double least = std::min(job_.sample.x, job_.sample.y), most = std::max(job_.sample.x, job_.sample.y);
    const PixelBox box = snapped.box(job_.region, least, most);
    if (!box.empty()) TouchBox(box.x0, box.x1 - 1, box.y0, box.y1 - 1);
    for (int y = box.y0; y < box.y1; ++y) {
      if (!bands_.owns(y >> kTileLog2)) continue;
      for (int x = box.x0; x < box.x1; ++x) {
        const int facing = snapped.winding({x + job_.sample.x, y + job_.sample.y}, job_.shift);
        if (facing != 0 && !Culls(facing)) writer_.SlowFragment(position, x, y);
      }
    }
  }
  bool Culls(int facing) const {
    const bool front = (facing > 0) == (job_.draw->front_face == FrontFace::clockwise);
    return job_.draw->cull == (front ? Cull::front : Cull::back);
  }

  // The lanes that may reach a band of this set. Without a branch for each: whose a triangle is cannot be guessed.
  std::uint32_t OwnedLanes() const {
    std::uint32_t owned = 0;
    for (std::uint32_t lane = 0; lane < kBatch; ++lane) {
      const auto first = static_cast<std::uint32_t>(batch_->first_y[lane]) >> kTileLog2,
                 last = static_cast<std::uint32_t>(batch_->last_y[lane]) >> kTileLog2;
      const auto reaches = [this](std::uint32_t band) {
        return static_cast<std::uint32_t>(bands_.owned[band >> 6 & 3] >> (band & 63)) & 1;
      };
      owned |= (reaches(first) | reaches(last) | static_cast<std::uint32_t>(last - first > 1)) << lane;
    }
    return owned;
  }

  // Small triangles lie anywhere: their cells are asked for a batch ahead. (Inlined: g++ drops calls of functions that
  // only prefetch.)
  HWY_INLINE void Prefetch(const Batch& batch) const {
    for (std::uint32_t small = batch.live & batch.small; small != 0; small &= small - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(small));
      // The corners of the box: all its cells, if it is at most two cells wide and high.
      const int x[2] = {batch.first_x[lane], batch.last_x[lane]}, y[2] = {batch.first_y[lane], batch.last_y[lane]};
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t offset =
            std::size_t{canvas_.column[x[i & 1] >> kCellLog2]} + canvas_.row[y[i >> 1] >> kCellLog2];
        hwy::Prefetch(canvas_.depth + offset);
        if (kWinner) hwy::Prefetch(canvas_.winner + offset);
      }
    }
  }

  // ---- slots
  HWY_INLINE void Place(Area& area, int x, int y) const {
    area.x = x, area.y = y;
    area.offset = canvas_.offset_of(x, y);
    area.cell_offset = cell_offsets_[(x >> 2 & 1) + (y >> 1 & 2)];
  }

  HWY_INLINE void LoadSteps(Slot& slot) {
    const CellInt d;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = hn::Set(d, slot.a[k]), b = hn::Set(d, slot.b[k]);
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        hn::Store(hn::Add(hn::Mul(a, hn::Load(d, kColumn + i)), hn::Mul(b, hn::Load(d, kRow + i))), d,
                  slot.step[k] + i);
      }
    }
  }
  // What does not depend on the class.
  HWY_INLINE void LoadLane(Slot& slot, std::uint32_t lane) {
    const Batch& batch = *batch_;
    slot.lane = lane, slot.position = batch.position(lane);
    if (HWY_UNLIKELY(writer_.looks_at_lanes)) {
      slot.first_x = batch.first_x[lane], slot.last_x = batch.last_x[lane];
      slot.first_y = batch.first_y[lane], slot.last_y = batch.last_y[lane];
    }
    if (!kDepth) return;
    slot.z_error = batch.z_error[lane];
    slot.z_most = std::numeric_limits<float>::infinity();
    if (HWY_UNLIKELY(job_.draw->grid.has_value())) slot.z_least = batch.z_least[lane], slot.z_most = batch.z_most[lane];
    slot.slow_depth = (batch.slow_depth >> lane & 1) != 0;
    slot.clip = (batch.clip >> lane & 1) != 0;
    slot.special = writer_.IsSpecial(slot);
  }
  HWY_INLINE void LoadPlane(Slot& slot, std::uint32_t lane) {
    const Batch& batch = *batch_;
    LoadLane(slot, lane);
    if (!kDepth) return;
    slot.origin_x = batch.origin_x(lane), slot.origin_y = batch.origin_y(lane);
    slot.z = batch.z[lane], slot.z_x = batch.z_x[lane], slot.z_y = batch.z_y[lane];
    const CellDouble dd;
    const auto zx = hn::Set(dd, slot.z_x), zy = hn::Set(dd, slot.z_y);
    for (std::size_t i = 0; i < 16; i += hn::Lanes(dd)) {
      hn::Store(hn::Add(hn::Mul(zx, hn::Load(dd, kColumnDouble + i)), hn::Mul(zy, hn::Load(dd, kRowDouble + i))), dd,
                slot.z_step + i);
    }
    LoadFloatSteps(slot);
  }
  HWY_INLINE void LoadBatchEdges(Slot& slot, std::uint32_t lane) {
    for (std::size_t k = 0; k < 3; ++k) {
      slot.a[k] = batch_->a[k][lane], slot.b[k] = batch_->b[k][lane], slot.most[k] = batch_->most[k][lane];
    }
    slot.doubt = batch_->doubt[lane];
  }

  HWY_INLINE void LoadFloatSteps(Slot& slot) const {
    if (kExactDepth) return;
    for (std::size_t i = 0; i < 16; ++i) slot.z_step_float[i] = static_cast<float>(slot.z_step[i]);
  }

  // The edges and depths at the cells of an area whose first sample is (x, y), where the edges have the values e and
  // depth is z.
  // Returns the cells that are not outside an edge, and in `full` those that are within all.
  HWY_INLINE std::uint32_t SetUpArea(const Slot& slot, const std::int32_t (&e)[3], double z, int x, int y, Area& area,
                                     std::uint32_t* full) const {
    const CellInt d;
    std::uint32_t outside = 0, cut = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      auto outside_lanes = hn::Zero(d), cut_lanes = outside_lanes;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::ShiftLeft<2>(hn::Load(d, slot.step[k] + i)));
        hn::Store(value, d, area.edge[k] + i);
        outside_lanes = hn::Or(outside_lanes, hn::Add(value, hn::Set(d, slot.most[k])));  // negative if one is
        cut_lanes = hn::Or(cut_lanes, hn::Add(value, hn::Set(d, slot.least[k])));
      }
      outside |= Bits(d, hn::Lt(outside_lanes, hn::Zero(d))) << i;
      cut |= Bits(d, hn::Lt(cut_lanes, hn::Zero(d))) << i;
    }
    *full = ~cut & 0xFFFF;
    Place(area, x, y);
    if (kDepth) {
      const CellDouble dd;
      const auto start = hn::Set(dd, z), four = hn::Set(dd, 4.0);
      for (std::size_t i = 0; i < 16; i += hn::Lanes(dd)) {
        hn::Store(hn::Add(start, hn::Mul(four, hn::Load(dd, slot.z_step + i))), dd, area.z + i);
      }
    }
    return ~outside & 0xFFFF;
  }

  // ---- within 4 x 4 cells: noted, and drawn with the rest of the batch
  HWY_INLINE void Small(std::uint32_t lane) {
    const CellInt d;
    const Batch& batch = *batch_;
    Slot& slot = slots_[lane];
    Area& area = areas_[lane];
    std::uint32_t outside = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      const auto column = hn::Load(d, kColumn + i), row = hn::Load(d, kRow + i);
      auto lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto step =
            hn::Add(hn::Mul(hn::Set(d, batch.a[k][lane]), column), hn::Mul(hn::Set(d, batch.b[k][lane]), row));
        const auto value = hn::Add(hn::Set(d, batch.e[k][lane]), hn::ShiftLeft<2>(step));
        hn::Store(step, d, slot.step[k] + i);
        hn::Store(value, d, area.edge[k] + i);
        lanes = hn::Or(lanes, hn::Add(value, hn::Set(d, batch.most[k][lane])));  // negative if one is
      }
      outside |= Bits(d, hn::Lt(lanes, hn::Zero(d))) << i;
    }
    if (kDepth) {
      const CellDouble dd;
      const auto z = hn::Set(dd, batch.z[lane]), four = hn::Set(dd, 4.0);
      const auto zx = hn::Set(dd, batch.z_x[lane]), zy = hn::Set(dd, batch.z_y[lane]);
      for (std::size_t i = 0; i < 16; i += hn::Lanes(dd)) {
        const auto step =
            hn::Add(hn::Mul(zx, hn::Load(dd, kColumnDouble + i)), hn::Mul(zy, hn::Load(dd, kRowDouble + i)));
        hn::Store(step, dd, slot.z_step + i);
        hn::Store(hn::Add(z, hn::Mul(four, step)), dd, area.z + i);
      }
      LoadFloatSteps(slot);
    }
    LoadLane(slot, lane);
    slot.doubt = batch.doubt[lane];
    const int x = batch.first_x[lane] & ~3, y = batch.first_y[lane] & ~3;
    Place(area, x, y);
    const int columns = (batch.last_x[lane] - x) >> 2, rows = (batch.last_y[lane] - y) >> 2;
    std::uint32_t cells = ~outside & ((0x2222u << columns) - 0x1111u) & ((0x10u << (4 * rows)) - 1);
    if (!bands_.all) cells &= OwnedCells(y);
    partly_.Append(lane, cells);
  }

  // The cells of an area that lie in bands of this set.
  std::uint32_t OwnedCells(int y) const {
    std::uint32_t owned = 0;
    for (int row = 0; row < 4; ++row) {
      if (bands_.owns((y + 4 * row) >> kTileLog2)) owned |= 0xFu << (4 * row);
    }
    return owned;
  }

  // ---- within 8 x 8 blocks
  void Medium(std::uint32_t lane) {
    Slot& slot = slots_[0];
    LoadBatchEdges(slot, lane);
    LoadSteps(slot);
    LoadPlane(slot, lane);
    LoadAreaSteps(slot);
    const std::int32_t e[3] = {batch_->e[0][lane], batch_->e[1][lane], batch_->e[2][lane]};
    Tile(slot, lane, e, batch_->first_x[lane] & ~7, batch_->first_y[lane] & ~7);
  }

  // ---- larger: tile by tile, with a scale for 64 samples
  void Large(std::uint32_t lane) {
    Slot& slot = slots_[0];
    double a[3], b[3], c[3], most[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double ua = batch_->edge_a[i][lane], ub = batch_->edge_b[i][lane];
      const double scale =
          std::ldexp(1.0, kTileExponent - std::ilogb(std::max({std::fabs(ua), std::fabs(ub), 0x1p-400})));
      a[i] = ua * scale, b[i] = ub * scale, c[i] = batch_->edge_c[i][lane] * scale;
      slot.a[i] = static_cast<std::int32_t>(std::nearbyint(a[i]));
      slot.b[i] = static_cast<std::int32_t>(std::nearbyint(b[i]));
      most[i] = (kTileSize - 1) * (std::max(a[i], 0.0) + std::max(b[i], 0.0)) + 1;  // 1: far more than E's error here
    }
    constexpr std::int32_t kBound = kExactCoverage ? kTileBound : 0;
    slot.doubt = 2 * kBound;
    for (std::size_t k = 0; k < 3; ++k)
      slot.most[k] = 3 * (std::max(slot.a[k], 0) + std::max(slot.b[k], 0)) + slot.doubt;
    LoadSteps(slot);
    LoadPlane(slot, lane);
    LoadAreaSteps(slot);
    const int first_x = batch_->first_x[lane] & ~(kTileSize - 1), first_y = batch_->first_y[lane] & ~(kTileSize - 1);
    const int last_x = batch_->last_x[lane] - (SUREFILL_PLANT(tile_border) ? 1 : 0), last_y = batch_->last_y[lane];
    const bool hides = Hides(slot);
    const double dip = kDepth ? Dip(slot, kTileSize - 1) - Slack(slot) : 0;

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
        if (hides) {
          const hn::Rebind<float, DoubleTag> df;
          const auto dx = hn::Sub(column, hn::Set(d, slot.origin_x));
          const auto nearest = hn::Min(
              hn::Add(hn::Mul(hn::Set(d, slot.z_x), dx), hn::Set(d, slot.z_y * (ty - slot.origin_y) + (slot.z + dip))),
              hn::Set(d, slot.z_most));
          const auto far = hn::PromoteTo(d, hn::LoadU(df, canvas_.tile_far + canvas_.tile_of(tx, ty)));
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
          if (Tile(slot, lane, at, x0, ty)) UpdateTileFar(x0, ty);
        }
      }
    }
  }
  alignas(64) static constexpr double kTileSteps[8] = {0, 64, 128, 192, 256, 320, 384, 448};

  void LoadAreaSteps(Slot& slot) {
    const CellInt d;
    for (std::size_t k = 0; k < 3; ++k) {
      slot.least[k] = 3 * (std::min(slot.a[k], 0) + std::min(slot.b[k], 0));
      for (std::size_t i = 0; i < 16; i += kCellLanes)
        hn::Store(hn::ShiftLeft<4>(hn::Load(d, slot.step[k] + i)), d, area_step_[k] + i);
    }
  }

  // The 64 x 64 samples from (x, y) on, a multiple of 8, where the edges have the values e. True if block_far has
  // changed.
  bool Tile(const Slot& slot, std::uint32_t lane, const std::int32_t (&e)[3], int x, int y) {
    const CellInt d;
    const int first_x = batch_->first_x[lane] - x, last_x = batch_->last_x[lane] - x;
    const int first_y = batch_->first_y[lane] - y, last_y = batch_->last_y[lane] - y;
    alignas(64) std::int32_t at[3][16];
    std::uint32_t outside = 0;
    for (std::size_t i = 0; i < 16; i += kCellLanes) {
      auto lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::Load(d, area_step_[k] + i));
        hn::Store(value, d, at[k] + i);
        lanes = hn::Or(lanes, hn::Add(value, hn::Set(d, 5 * slot.most[k])));
      }
      outside |= Bits(d, hn::Lt(lanes, hn::Zero(d))) << i;
    }
    std::uint32_t possible = ~outside & Mask4x4(first_x >> 4, last_x >> 4, first_y >> 4, last_y >> 4);
    const bool hides = Hides(slot);
    const bool prefetch = (batch_->medium >> lane & 1) != 0;
    const double dip = kDepth ? Dip(slot, SUREFILL_PLANT(hierarchical_z) ? 6 : 7) : 0;
    alignas(32) const double dips[4] = {dip, dip + 8 * slot.z_x, dip + 8 * slot.z_y, dip + 8 * (slot.z_x + slot.z_y)};
    std::size_t blocks = 0;
    std::uint32_t block_list[64];  // whole blocks: block_far may become less
    for (; possible != 0; possible &= possible - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(possible));
      const int area_x = static_cast<int>(n & 3) * 16, area_y = static_cast<int>(n >> 2) * 16;
      const std::int32_t start[3] = {at[0][n], at[1][n], at[2][n]};
      Area& area = areas_[n];
      std::uint32_t full;
      std::uint32_t cells = SetUpArea(slot, start, kDepth ? slot.DepthAt(x + area_x, y + area_y) : 0, x + area_x,
                                      y + area_y, area, &full);
      if (first_x >= area_x + 4 || last_x < area_x + 12 || first_y >= area_y + 4 || last_y < area_y + 12) {
        cells &=
            Mask4x4((first_x - area_x) >> 2, (last_x - area_x) >> 2, (first_y - area_y) >> 2, (last_y - area_y) >> 2);
      }
      if (!bands_.all) cells &= OwnedCells(y + area_y);
      if (hides) {
        const std::size_t block = canvas_.block_of(x + area_x, y + area_y);
        const auto below = static_cast<std::size_t>(canvas_.blocks_x());
        cells &= kCellsOfBlocks[VisibleBlocks(slot, area.z[0], dips, canvas_.block_far + block, below)];
        // Of each whole block, its first cell.
        std::uint32_t whole = cells & full;
        whole &= whole >> 1;
        whole &= (whole >> 4) & 0x0505;
        for (; whole != 0; whole &= whole - 1) {
          const auto cell = static_cast<std::size_t>(__builtin_ctz(whole));
          block_list[blocks++] = static_cast<std::uint32_t>(block + (cell >> 3) * below + (cell >> 1 & 1));
        }
      }
      if (kDepth && prefetch) {
        for (std::uint32_t rest = cells; rest != 0; rest &= rest - 1) {
          const auto cell = static_cast<std::size_t>(__builtin_ctz(rest));
          const std::size_t at_cell = area.offset + area.cell_offset[cell];
          hwy::Prefetch(canvas_.depth + at_cell);
          if (kWinner) hwy::Prefetch(canvas_.winner + at_cell);
        }
      }
      partly_.Append(n, cells & ~full);
      wholly_.Append(n, cells & full);
    }
    DrawCells(0);
    DrawWholeCells();
    for (std::size_t i = 0; i < blocks; ++i) UpdateBlockFar(block_list[i]);
    return blocks != 0;
  }
  // Which of an area's four blocks may hold something farther than the triangle: bit 0 the upper left one, then to the
  // right, then below; depths that are equal once they are rounded may leave a smaller identifier in front. dips: from
  // the depth at the area's first sample to less than any in each block.
  HWY_INLINE std::uint32_t VisibleBlocks(const Slot& slot, double z, const double (&dips)[4], const float* far,
                                         std::size_t below) const {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    const hn::CappedTag<double, 4> d;
    const hn::CappedTag<float, 4> df;
    const hn::CappedTag<float, 2> row;
    const auto nearest = hn::Min(hn::Add(hn::Set(d, z), hn::Load(d, dips)), hn::Set(d, slot.z_most));
    const auto there = hn::PromoteTo(d, hn::Combine(df, hn::LoadU(row, far + below), hn::LoadU(row, far)));
    const auto hidden =
        writer_.with_identifiers ? hn::Gt(hn::PromoteTo(d, hn::DemoteTo(df, nearest)), there) : hn::Ge(nearest, there);
    return ~Bits(d, hidden) & 15;
#else
    std::uint32_t visible = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double nearest = std::min<double>(z + dips[i], slot.z_most), there = far[(i >> 1) * below + (i & 1)];
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
  HWY_INLINE hn::Vec<CellInt> LeastEdge(const Slot& slot, const Area& area, std::size_t cell, std::size_t i) const {
    const CellInt d;
    const auto e0 = hn::Add(hn::Set(d, area.edge[0][cell]), hn::Load(d, slot.step[0] + i));
    const auto e1 = hn::Add(hn::Set(d, area.edge[1][cell]), hn::Load(d, slot.step[1] + i));
    const auto e2 = hn::Add(hn::Set(d, area.edge[2][cell]), hn::Load(d, slot.step[2] + i));
    return hn::Min(hn::Min(e0, e1), e2);
  }
  // -2 bound <= value < 0.
  HWY_INLINE hn::Mask<CellUint> Doubtful(hn::Vec<CellInt> value, std::int32_t doubt) const {
    const CellInt d;
    const CellUint du;
    const auto bound = hn::Set(d, doubt);
    return hn::Lt(hn::BitCast(du, hn::Add(value, bound)), hn::BitCast(du, bound));
  }

  // Draws the cells that an edge may cut: the lanes that are surely inside, and in the end those within the bound of an
  // edge. slots: 1 if each area has its own slot, 0 if all have the first.
  void DrawCells(std::size_t slots) {
    const CellInt d;
    const CellUint du;
    auto doubtful = hn::Lt(hn::Zero(du), hn::Zero(du));
    for (std::size_t n = 0; n < partly_.size; ++n) {
      const std::size_t number = partly_.items[n] >> 4, cell = partly_.items[n] & 15;
      const Slot& slot = slots_[number * slots];
      const Area& area = areas_[number];
      const std::size_t offset = area.offset + area.cell_offset[cell];
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        const auto value = LeastEdge(slot, area, cell, i);
        if (kExactCoverage) doubtful = hn::Or(doubtful, Doubtful(value, slot.doubt));
        writer_.template Fragments<false>(slot, area, cell, hn::Not(hn::Lt(value, hn::Zero(d))), offset, i);
      }
    }
    if (HWY_UNLIKELY(!hn::AllFalse(du, doubtful))) Settle(slots);
    partly_.size = 0;
  }

  // Draws the cells that all edges hold whole.
  void DrawWholeCells() {
    const CellInt d;
    const auto all = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (std::size_t n = 0; n < wholly_.size; ++n) {
      const Area& area = areas_[wholly_.items[n] >> 4];
      const std::size_t cell = wholly_.items[n] & 15;
      const std::size_t offset = area.offset + area.cell_offset[cell];
      for (std::size_t i = 0; i < 16; i += kCellLanes)
        writer_.template Fragments<true>(slots_[0], area, cell, all, offset, i);
    }
    wholly_.size = 0;
  }

  // ---- uncertain lanes: within the doubt of an edge
  HWY_NOINLINE void Settle(std::size_t slots) {
    const CellUint du;
    for (std::size_t n = 0; n < partly_.size; ++n) {
      const std::size_t number = partly_.items[n] >> 4, cell = partly_.items[n] & 15;
      const Slot& slot = slots_[number * slots];
      const Area& area = areas_[number];
      const int cell_x = area.CellX(cell), cell_y = area.CellY(cell);
      for (std::size_t i = 0; i < 16; i += kCellLanes) {
        auto bits = Bits(du, Doubtful(LeastEdge(slot, area, cell, i), slot.doubt)) << i;
        for (; bits != 0; bits &= bits - 1) {
          const int k = __builtin_ctz(bits), x = cell_x + (k & 3), y = cell_y + (k >> 2);
          if (writer_.Covers(slot, *batch_, x, y)) writer_.SlowFragment(slot, x, y);
        }
      }
    }
  }

  // ---- hierarchical z
  // Can a block or tile be skipped because all it holds is nearer? Not where fragments count, or move.
  bool Hides(const Slot& slot) const {
    return kDepth && !kCount && !slot.slow_depth && !(slot.clip && writer_.clamps);
  }
  // From the depth at a first sample to less than any within `reach` steps each way, errors included; the last term is
  // for a first sample outside the triangle's box.
  double Dip(const Slot& slot, double reach) const {
    return std::min(0.0, reach * slot.z_x) + std::min(0.0, reach * slot.z_y) - slot.z_error -
           0x1p-40 * reach * (std::fabs(slot.z_x) + std::fabs(slot.z_y));
  }
  // The same for the depth at a tile's first sample, wherever the triangle's origin is.
  double Slack(const Slot& slot) const {
    return 0x1p-40 * (std::fabs(slot.z) + (std::fabs(slot.z_x) + std::fabs(slot.z_y)) * kMaxTargetSize);
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
    canvas_.tile_far[canvas_.tile_of(x, y)] = hn::GetLane(hn::MaxOfLanes(df, far));
  }

  const DrawJob& job_;
  const Canvas canvas_;
  const BandSet& bands_;
  FragmentWriter<kDepth, kWinner, kCount> writer_;

  const Batch* batch_ = nullptr;
  Slot slots_[kBatch];
  Area areas_[16];
  alignas(64) std::int32_t area_step_[3][16];  // edge functions: from the first sample of a tile to those of its areas
  std::uint32_t cell_offsets_[4][16];
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

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_BLOCK_INL_HPP
