// SPDX-License-Identifier: Apache-2.0
//
// Triangles into the blocks of one bin: coverage by int32 edge functions with deferred uncertainty, depth by filter,
// hierarchical z. What the vector arithmetic cannot tell goes to the scalar Triangle, lane by lane.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_BLOCK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_BLOCK_INL_HPP
#undef SUREFILL_SRC_BLOCK_INL_HPP
#else
#define SUREFILL_SRC_BLOCK_INL_HPP
#endif

#include "hwy/cache_control.h"
#include "planted.hpp"
#include "setup-inl.hpp"
#include "triangle.hpp"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The 16 samples of a cell, in as many vectors as it takes.
using CellInt = hn::CappedTag<std::int32_t, 16>;
using CellUint = hn::RebindToUnsigned<CellInt>;
using CellFloat = hn::RebindToFloat<CellInt>;
#if HWY_TARGET == HWY_SCALAR
using CellDouble = hn::CappedTag<double, 1>;
#else
using CellDouble = hn::Repartition<double, CellInt>;
#endif

// Sample k of a cell is (k & 3, k >> 2); so is cell k of a 16 x 16 area, and area k of a tile.
alignas(64) constexpr std::int32_t kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr std::int32_t kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

// Bits of the columns [c0, c1] and rows [r0, r1] of a 4 x 4 arrangement; a range is cut to 0..3.
inline std::uint32_t Mask4x4(int c0, int c1, int r0, int r1) {
  c0 = std::max(c0, 0), r0 = std::max(r0, 0), c1 = std::min(c1, 3), r1 = std::min(r1, 3);
  if (c0 > c1 || r0 > r1) return 0;
  const std::uint32_t columns = ((0xFu >> (3 - (c1 - c0))) << c0) * 0x1111u;
  const std::uint32_t rows = (0xFFFFu >> (4 * (3 - (r1 - r0)))) << (4 * r0);
  return columns & rows;
}

// Sixteen depths of a cell: base + lanes, rounded to float32. -0 becomes +0.
HWY_INLINE hn::Vec<CellFloat> RoundDepths(double base, const double* lanes) {
  const CellFloat df;
  const CellDouble dd;
  const hn::Rebind<float, CellDouble> dh;
  const auto start = hn::Set(dd, base);
#if HWY_TARGET == HWY_SCALAR
  const auto rounded = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes)));
#else
  const auto low = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes)));
  const auto high = hn::DemoteTo(dh, hn::Add(start, hn::Load(dd, lanes + hn::Lanes(dd))));
  const auto rounded = hn::Combine(df, high, low);
#endif
  return hn::Add(rounded, hn::Zero(df));
}

// One edge function over an area of 4 x 4 cells: integer values at the first sample of each cell, biased by the bound,
// and the steps to the samples within a cell.
struct EdgeLanes {
  alignas(64) std::int32_t sample[16];  // a column + b row
  alignas(64) std::int32_t cell[16];    // value at sample 0 of the cell, minus the bound
};

template <bool kVisibility, bool kCount>
class Rasterizer {
 public:
  Rasterizer(const BinJob& job, Statistics& statistics)
      : job_(job), draw_(*job.draw), statistics_(statistics), shift_(tie_shift(draw_.fill_rule)) {
    const PixelBox& r = job.region;
    partial_ = ((r.x0 | r.y0) & 3) != 0 || ((r.x1 | r.y1) & 3) != 0;
    with_identifiers_ = !draw_.identifiers.empty();
    near_ = job.greater ? -1.0f : 0.0f, far_ = job.greater ? 0.0f : 1.0f;
  }

  void Run() {
    for (std::size_t begin = 0; begin < job_.entries.size(); begin += kBatch) {
      const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(kBatch, job_.entries.size() - begin));
      entries_ = &job_.entries[begin];
      Prefetch(begin);
      SetUp(job_, entries_, count, kVisibility, batch_, statistics_);
      if (!kVisibility && !kCount) continue;  // no output is asked for but the statistics
      for (std::uint32_t live = batch_.live; live != 0; live &= live - 1) {
        lane_ = static_cast<std::uint32_t>(__builtin_ctz(live));
        exact_ready_ = false;
        position_ = job_.chunk_begin + entries_[lane_].number;
        if (kVisibility) LoadPlane();
        if ((batch_.small >> lane_ & 1) != 0) {
          Small();
        } else {
          Large();
        }
      }
    }
  }

 private:
  // Triangles of a bin lie anywhere in memory: their indices and vertices are asked for a few batches ahead.
  void Prefetch(std::size_t begin) const {
    const std::size_t far = begin + 4 * kBatch, near = begin + 2 * kBatch, end = job_.entries.size();
    for (std::size_t i = far; i < std::min(far + kBatch, end); ++i) hwy::Prefetch(Indices(i));
    for (std::size_t i = near; i < std::min(near + kBatch, end); ++i) {
      const std::uint32_t* const indices = Indices(i);
      for (std::size_t k = 0; k < 3; ++k) hwy::Prefetch(&draw_.vertices[indices[k]]);
    }
  }
  const std::uint32_t* Indices(std::size_t entry) const {
    return &draw_.indices[std::size_t{3} * (job_.chunk_begin + job_.entries[entry].number)];
  }

  // ---- depth plane of the triangle at hand
  void LoadPlane() {
    origin_x_ = batch_.OriginX(lane_), origin_y_ = batch_.OriginY(lane_);
    z_ = batch_.z[lane_], z_x_ = batch_.z_x[lane_], z_y_ = batch_.z_y[lane_], z_error_ = batch_.z_error[lane_];
    slow_depth_ = (batch_.slow_depth >> lane_ & 1) != 0;
    clip_ = (batch_.clip >> lane_ & 1) != 0;
    const CellDouble dd;
    const auto zx = hn::Set(dd, z_x_), zy = hn::Set(dd, z_y_);
    for (std::size_t i = 0; i < 16; i += hn::Lanes(dd)) {
      hn::Store(hn::Add(hn::Mul(zx, hn::Load(dd, kColumnDouble + i)), hn::Mul(zy, hn::Load(dd, kRowDouble + i))), dd,
                z_lane_ + i);
    }
  }
  double DepthAt(int x, int y) const { return z_ + (z_x_ * (x - origin_x_) + z_y_ * (y - origin_y_)); }

  // ---- areas of 4 x 4 cells
  void Small() {
    std::int32_t a[3], b[3], e[3];
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = batch_.small_a[i][lane_], b[i] = batch_.small_b[i][lane_], e[i] = batch_.small_e[i][lane_] - kSmallBound;
    }
    const int x = batch_.OriginX(lane_), y = batch_.OriginY(lane_);
    const std::uint32_t cells =
        Mask4x4(0, (batch_.boxes.last_x[lane_] - x) >> 2, 0, (batch_.boxes.last_y[lane_] - y) >> 2);
    SetUpLanes(a, b);
    Area(e, a, b, SUREFILL_PLANT(small_bound) ? 2 : kSmallBound, cells, x, y);
  }

  // Larger triangles: tile by tile, with a scale for 64 samples; areas of 16 x 16 samples are rejected, accepted or
  // looked into.
  void Large() {
    double a[3], b[3], c[3];
    std::int32_t ai[3], bi[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double ua = batch_.a[i][lane_], ub = batch_.b[i][lane_];
      const double scale =
          std::ldexp(1.0, kTileExponent - std::ilogb(std::max({std::fabs(ua), std::fabs(ub), 0x1p-400})));
      a[i] = ua * scale, b[i] = ub * scale, c[i] = batch_.c[i][lane_] * scale;
      ai[i] = static_cast<std::int32_t>(std::nearbyint(a[i]));
      bi[i] = static_cast<std::int32_t>(std::nearbyint(b[i]));
    }
    SetUpLanes(ai, bi);
    constexpr int kTileMask = ~((1 << kTileLog2) - 1);
    const int last_x = batch_.boxes.last_x[lane_], last_y = batch_.boxes.last_y[lane_];
    for (int ty = batch_.boxes.first_y[lane_] & kTileMask; ty <= last_y; ty += 1 << kTileLog2) {
      const int last_tile = SUREFILL_PLANT(tile_border) ? last_x - 1 : last_x;
      for (int tx = batch_.boxes.first_x[lane_] & kTileMask; tx <= last_tile; tx += 1 << kTileLog2) {
        std::int32_t e[3];
        for (std::size_t i = 0; i < 3; ++i) {
          const double value = (a[i] * (tx + 0.5) + b[i] * (ty + 0.5)) + c[i];
          e[i] = static_cast<std::int32_t>(std::nearbyint(std::clamp(value, -kEdgeLimit, kEdgeLimit))) - kTileBound;
        }
        Tile(e, ai, bi, tx, ty);
      }
    }
  }

  void Tile(const std::int32_t (&e)[3], const std::int32_t (&a)[3], const std::int32_t (&b)[3], int tx, int ty) {
    const int first_x = batch_.boxes.first_x[lane_] - tx, last_x = batch_.boxes.last_x[lane_] - tx;
    const int first_y = batch_.boxes.first_y[lane_] - ty, last_y = batch_.boxes.last_y[lane_] - ty;
    // Values at the areas' first samples; the least and the largest in an area decide.
    const CellInt d;
    alignas(64) std::int32_t area_e[3][16];
    std::uint32_t possible = 0, full = 0;
    for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
      auto possible_lanes = hn::Zero(d), full_lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::ShiftLeft<4>(hn::Load(d, edge_[k].sample + i)));
        hn::Store(value, d, area_e[k] + i);
        const std::int32_t most = 15 * (std::max(a[k], 0) + std::max(b[k], 0)) + 2 * kTileBound;
        const std::int32_t least = 15 * (std::min(a[k], 0) + std::min(b[k], 0));
        possible_lanes = hn::Or(possible_lanes, hn::Add(value, hn::Set(d, most)));  // negative if one is
        full_lanes = hn::Or(full_lanes, hn::Add(value, hn::Set(d, least)));
      }
      possible |= Bits(d, hn::Not(hn::Lt(possible_lanes, hn::Zero(d)))) << i;
      full |= Bits(d, hn::Not(hn::Lt(full_lanes, hn::Zero(d)))) << i;
    }
    possible &= Mask4x4(first_x >> 4, last_x >> 4, first_y >> 4, last_y >> 4);
    for (; possible != 0; possible &= possible - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(possible));
      const int x = static_cast<int>(n & 3) * 16, y = static_cast<int>(n >> 2) * 16;
      const std::uint32_t cells = Mask4x4((first_x - x) >> 2, (last_x - x) >> 2, (first_y - y) >> 2, (last_y - y) >> 2);
      if ((full >> n & 1) != 0) {
        FullArea(cells, tx + x, ty + y);
      } else {
        const std::int32_t start[3] = {area_e[0][n], area_e[1][n], area_e[2][n]};
        Area(start, a, b, kTileBound, cells, tx + x, ty + y);
      }
    }
  }

  void SetUpLanes(const std::int32_t (&a)[3], const std::int32_t (&b)[3]) {
    const CellInt d;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto va = hn::Set(d, a[k]), vb = hn::Set(d, b[k]);
      for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        hn::Store(hn::Add(hn::Mul(va, hn::Load(d, kColumn + i)), hn::Mul(vb, hn::Load(d, kRow + i))), d,
                  edge_[k].sample + i);
      }
    }
  }

  // Draws the cells of the area that an edge function does not exclude. (x, y) is the area's first sample.
  void Area(const std::int32_t (&e)[3], const std::int32_t (&a)[3], const std::int32_t (&b)[3], std::int32_t bound,
            std::uint32_t cells, int x, int y) {
    const CellInt d;
    const CellUint du;
    std::uint32_t possible = 0;
    for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
      auto lanes = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = hn::Add(hn::Set(d, e[k]), hn::ShiftLeft<2>(hn::Load(d, edge_[k].sample + i)));
        hn::Store(value, d, edge_[k].cell + i);
        const std::int32_t most = 3 * (std::max(a[k], 0) + std::max(b[k], 0)) + 2 * bound;
        lanes = hn::Or(lanes, hn::Add(value, hn::Set(d, most)));
      }
      possible |= Bits(d, hn::Not(hn::Lt(lanes, hn::Zero(d)))) << i;
    }
    possible &= cells;
    if (possible == 0) return;
    possible = Visible(possible, x, y);

    auto largest = hn::Zero(du);  // as unsigned, the largest value of all lanes: is one within the bound below 0?
    for (std::uint32_t rest = possible; rest != 0; rest &= rest - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(rest));
      const int cell_x = x + static_cast<int>(n & 3) * 4, cell_y = y + static_cast<int>(n >> 2) * 4;
      const std::size_t offset = bin_offset(cell_x - job_.bin_x, cell_y - job_.bin_y);
      const double z = kVisibility ? DepthAt(cell_x, cell_y) : 0;
      for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        const auto m = LeastEdge(n, i);
        largest = hn::Max(largest, hn::BitCast(du, m));
        Draw(hn::Not(hn::Lt(m, hn::Zero(d))), cell_x, cell_y, offset, i, z);
      }
    }
    const auto doubtful = hn::Set(du, static_cast<std::uint32_t>(-2 * bound));
    if (HWY_UNLIKELY(!hn::AllTrue(du, hn::Lt(largest, doubtful)))) Settle(possible, bound, x, y);
    if (kVisibility) UpdateFar(possible, x, y);
  }

  // The least of the three biased edge values in lanes i... of cell n.
  HWY_INLINE hn::Vec<CellInt> LeastEdge(std::uint32_t n, std::size_t i) const {
    const CellInt d;
    const auto e0 = hn::Add(hn::Set(d, edge_[0].cell[n]), hn::Load(d, edge_[0].sample + i));
    const auto e1 = hn::Add(hn::Set(d, edge_[1].cell[n]), hn::Load(d, edge_[1].sample + i));
    const auto e2 = hn::Add(hn::Set(d, edge_[2].cell[n]), hn::Load(d, edge_[2].sample + i));
    return hn::Min(hn::Min(e0, e1), e2);
  }

  void FullArea(std::uint32_t cells, int x, int y) {
    const CellInt d;
    const auto all = hn::Eq(hn::Zero(d), hn::Zero(d));
    cells = Visible(cells, x, y);
    for (std::uint32_t rest = cells; rest != 0; rest &= rest - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(rest));
      const int cell_x = x + static_cast<int>(n & 3) * 4, cell_y = y + static_cast<int>(n >> 2) * 4;
      const std::size_t offset = bin_offset(cell_x - job_.bin_x, cell_y - job_.bin_y);
      const double z = kVisibility ? DepthAt(cell_x, cell_y) : 0;
      for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) Draw(all, cell_x, cell_y, offset, i, z);
    }
    if (kVisibility) UpdateFar(cells, x, y);
  }

  // ---- uncertain lanes: within the bound of an edge
  HWY_NOINLINE void Settle(std::uint32_t cells, std::int32_t bound, int x, int y) {
    const CellInt d;
    const CellUint du;
    const auto doubtful = hn::Set(du, static_cast<std::uint32_t>(-2 * bound));
    for (; cells != 0; cells &= cells - 1) {
      const auto n = static_cast<std::uint32_t>(__builtin_ctz(cells));
      const int cell_x = x + static_cast<int>(n & 3) * 4, cell_y = y + static_cast<int>(n >> 2) * 4;
      for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
        const auto value = hn::BitCast(du, LeastEdge(n, i));
        for (std::uint32_t bits = Bits(du, hn::Not(hn::Lt(value, doubtful))) << i; bits != 0; bits &= bits - 1) {
          const int k = __builtin_ctz(bits), sx = cell_x + (k & 3), sy = cell_y + (k >> 2);
          if (sx < job_.region.x0 || sx >= job_.region.x1 || sy < job_.region.y0 || sy >= job_.region.y1) continue;
          if (Exact().covers({sx + 0.5, sy + 0.5}, shift_, statistics_)) SlowFragment(sx, sy);
        }
      }
    }
  }

  Triangle& Exact() {
    if (!exact_ready_) {
      Statistics unused;
      exact_.set_up(batch_.vertices.Get(0, lane_), batch_.vertices.Get(1, lane_), batch_.vertices.Get(2, lane_),
                    unused);
      exact_ready_ = true;
    }
    return exact_;
  }

  // A covered sample that is drawn by exact arithmetic alone.
  HWY_NOINLINE void SlowFragment(int x, int y) {
    const std::size_t offset = bin_offset(x - job_.bin_x, y - job_.bin_y);
    float z = 0;
    if (kVisibility) {
      if (!Exact().depth({x + 0.5, y + 0.5}, draw_.depth_mode, &z, statistics_)) return;
      if (job_.greater) z = 0.0f - z;
    }
    if (kCount) ++job_.buffers.count[offset];
    if (kVisibility && Passes(z, offset)) {
      job_.buffers.depth[offset] = z;
      job_.buffers.winner[offset] = job_.first_ordinal + position_;
    }
  }

  // V1 and V3: nearer, or as near as a triangle of this draw with a larger identifier.
  bool Passes(float z, std::size_t offset) const {
    if (z < job_.buffers.depth[offset]) return true;
    const std::uint32_t winner = job_.buffers.winner[offset];
    if (!(z == job_.buffers.depth[offset]) || winner == kNoTriangle || winner < job_.first_ordinal) return false;
    const std::uint32_t other = winner - job_.first_ordinal;
    if (SUREFILL_PLANT(merge_order)) return position_ < other;
    return with_identifiers_ ? draw_.identifiers[position_] < draw_.identifiers[other] : position_ < other;
  }

  // ---- fragments of lanes i ... of a cell
  HWY_INLINE void Draw(hn::Mask<CellInt> covered, int cell_x, int cell_y, std::size_t offset, std::size_t i, double z) {
    const CellInt d;
    if (HWY_UNLIKELY(partial_)) covered = hn::And(covered, InRegion(cell_x, cell_y, i));
    if constexpr (!kVisibility) {
      if constexpr (kCount) Count(covered, offset + i);
      return;
    }
    const CellFloat df;
    auto lanes = hn::RebindMask(df, covered);
    if (HWY_UNLIKELY(slow_depth_)) {
      SlowLanes(Bits(d, covered) << i, cell_x, cell_y);
      return;
    }
    // low <= the stored depth <= high, and it is both if they are equal.
    auto low = RoundDepths(z - z_error_, z_lane_ + i);
    float* const depth = job_.buffers.depth + offset + i;
    const auto before = hn::Load(df, depth);
    if (!kCount && !with_identifiers_ &&
        !(clip_ && draw_.depth_mode == DepthMode::clamp)) {  // clamping may bring it nearer
      lanes = hn::And(lanes, hn::Lt(low, before));
      if (hn::AllFalse(df, lanes)) return;
    }
    auto high = RoundDepths(z + z_error_, z_lane_ + i);
    if (HWY_UNLIKELY(clip_)) {
      const auto least = hn::Set(df, near_), most = hn::Set(df, far_);
      if (draw_.depth_mode == DepthMode::clamp) {
        low = hn::Min(hn::Max(low, least), most);
        high = hn::Min(hn::Max(high, least), most);
      } else {
        const auto out = hn::Or(hn::Lt(high, least), hn::Gt(low, most));
        const auto in = hn::And(hn::Gt(low, least), hn::Lt(high, most));
        lanes = hn::AndNot(out, lanes);
        SlowLanes(Bits(df, hn::AndNot(in, lanes)) << i, cell_x, cell_y);
        lanes = hn::And(lanes, in);
      }
    }
    const auto known = hn::Eq(low, high);
    const auto unknown = hn::AndNot(known, lanes);
    if (HWY_UNLIKELY(!hn::AllFalse(df, unknown))) SlowLanes(Bits(df, unknown) << i, cell_x, cell_y);
    lanes = hn::And(lanes, known);
    if constexpr (kCount) Count(hn::RebindMask(d, lanes), offset + i);
    if (HWY_UNLIKELY(with_identifiers_)) {
      auto tied = Bits(df, hn::And(lanes, hn::Eq(low, before)));
      for (; tied != 0; tied &= tied - 1) {
        const std::size_t at = offset + i + static_cast<std::size_t>(__builtin_ctz(tied));
        if (Passes(job_.buffers.depth[at], at)) job_.buffers.winner[at] = job_.first_ordinal + position_;
      }
    }
    lanes = hn::And(lanes, hn::Lt(low, before));
    const CellUint du;
    hn::BlendedStore(low, lanes, df, depth);
    hn::BlendedStore(hn::Set(du, job_.first_ordinal + position_), hn::RebindMask(du, lanes), du,
                     job_.buffers.winner + offset + i);
  }

  HWY_NOINLINE void SlowLanes(std::uint32_t bits, int cell_x, int cell_y) {
    for (; bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits);
      SlowFragment(cell_x + (k & 3), cell_y + (k >> 2));
    }
  }

  HWY_INLINE void Count(hn::Mask<CellInt> covered, std::size_t at) {
    const CellInt d;
    const CellUint du;
    const auto one = hn::BitCast(du, hn::VecFromMask(d, covered));  // -1 where covered
    hn::Store(hn::Sub(hn::Load(du, job_.buffers.count + at), one), du, job_.buffers.count + at);
  }

  HWY_INLINE hn::Mask<CellInt> InRegion(int cell_x, int cell_y, std::size_t i) const {
    const CellInt d;
    const auto x = hn::Add(hn::Set(d, cell_x), hn::Load(d, kColumn + i));
    const auto y = hn::Add(hn::Set(d, cell_y), hn::Load(d, kRow + i));
    const PixelBox& r = job_.region;
    return hn::And(hn::And(hn::Lt(hn::Set(d, r.x0 - 1), x), hn::Lt(x, hn::Set(d, r.x1))),
                   hn::And(hn::Lt(hn::Set(d, r.y0 - 1), y), hn::Lt(y, hn::Set(d, r.y1))));
  }

  // ---- hierarchical z: blocks of 8 x 8 samples, four in an area of 16 x 16 if the area begins at a block
  static constexpr std::uint32_t kBlockCells[4] = {0x0033, 0x00CC, 0x3300, 0xCC00};

  // Takes out the cells of blocks in which every sample is nearer than the triangle.
  HWY_INLINE std::uint32_t Visible(std::uint32_t cells, int x, int y) const {
    if (!kVisibility || kCount || slow_depth_ || ((x | y) & 7) != 0 || (batch_.small >> lane_ & 1) != 0) return cells;
    if (clip_ && draw_.depth_mode == DepthMode::clamp) return cells;
    const double reach = SUREFILL_PLANT(hierarchical_z) ? 6 : 7;
    const double dip = std::min(0.0, reach * z_x_) + std::min(0.0, reach * z_y_) - z_error_;
    for (int n = 0; n < 4; ++n) {
      if ((cells & kBlockCells[n]) == 0) continue;
      const int block_x = x + (n & 1) * 8, block_y = y + (n >> 1) * 8;
      const auto nearest = static_cast<float>(DepthAt(block_x, block_y) + dip);
      const float far = job_.buffers.block_far[BlockOf(block_x, block_y)];
      if (with_identifiers_ ? nearest > far : nearest >= far) cells &= ~kBlockCells[n];
    }
    return cells;
  }

  void UpdateFar(std::uint32_t cells, int x, int y) {
    if (((x | y) & 7) != 0 || (batch_.small >> lane_ & 1) != 0) return;
    const CellFloat df;
    for (int n = 0; n < 4; ++n) {
      if ((cells & kBlockCells[n]) == 0) continue;
      const std::size_t block = BlockOf(x + (n & 1) * 8, y + (n >> 1) * 8);
      const float* depth = job_.buffers.depth + block * 64;
      auto far = hn::Load(df, depth);
      for (std::size_t i = hn::Lanes(df); i < 64; i += hn::Lanes(df)) far = hn::Max(far, hn::Load(df, depth + i));
      job_.buffers.block_far[block] = hn::GetLane(hn::MaxOfLanes(df, far));
    }
  }
  std::size_t BlockOf(int x, int y) const { return bin_offset(x - job_.bin_x, y - job_.bin_y) / 64; }

  alignas(64) static constexpr double kColumnDouble[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) static constexpr double kRowDouble[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

  const BinJob& job_;
  const surefill::Draw& draw_;
  Statistics& statistics_;
  TieShift shift_;
  bool partial_, with_identifiers_;
  float near_, far_;

  const BinEntry* entries_ = nullptr;
  Batch batch_;
  EdgeLanes edge_[3];
  std::uint32_t lane_ = 0, position_ = 0;
  int origin_x_ = 0, origin_y_ = 0;
  double z_ = 0, z_x_ = 0, z_y_ = 0, z_error_ = 0;
  bool slow_depth_ = false, clip_ = false;
  alignas(64) double z_lane_[16];
  Triangle exact_;
  bool exact_ready_ = false;
};

void Rasterize(const BinJob& job, Statistics& statistics) {
  if (job.buffers.depth == nullptr && job.buffers.count == nullptr) {
    Rasterizer<false, false>(job, statistics).Run();
  } else if (job.buffers.depth == nullptr) {
    Rasterizer<false, true>(job, statistics).Run();
  } else if (job.buffers.count == nullptr) {
    Rasterizer<true, false>(job, statistics).Run();
  } else {
    Rasterizer<true, true>(job, statistics).Run();
  }
}

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_BLOCK_INL_HPP
