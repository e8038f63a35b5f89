// SPDX-License-Identifier: Apache-2.0
//
// Barycentrics and attributes of what is seen, cell by cell: first the weights that its pixels give to the vertices of
// their triangles, in double with an error bound, and from them the values; where a bound cannot tell which float32 is
// nearest, the scalar Triangle. docs/design.md says why so, docs/precision.md derives the bounds.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_SHADE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_SHADE_INL_HPP
#undef SUREFILL_SRC_FAST_SHADE_INL_HPP
#else
#define SUREFILL_SRC_FAST_SHADE_INL_HPP
#endif

#include <bit>
#include <cstring>

#include "fast/cells-inl.hpp"
#include "fast/edges-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

// Bounds of errors: of a weight, relative to the products that it is made of; of a value, relative to itself; and the
// largest of a weight with which anything is known (docs/precision.md).
constexpr double kWeightBound = 0x1p-48, kValueBound = 0x1p-50, kKnown = 0x1p-10;

class Shader {
 public:
  Shader(const FrameJob& frame, const TileRow& tiles, Rungs& rungs)
      : frame_(frame), target_(*frame.target), tiles_(tiles), rungs_(rungs) {
    if (!target_.barycentrics.empty()) outputs_[count_++] = {target_.barycentrics.data(), 3, 3, kBarycentrics};
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (!out.values.empty()) outputs_[count_++] = {out.values.data(), out.components, stride_of(out), k};
    }
    if (target_.samples == 1) place_ = sample_offset(target_, 0);
    place_ = {place_.x + target_.origin.x, place_.y + target_.origin.y};
    for (std::size_t l = 0; l < kCellSamples; ++l) {
      sample_[l] =
          ((l >> 2) * static_cast<std::size_t>(target_.width) + (l & 3)) * static_cast<std::size_t>(target_.samples);
    }
  }

  void Run() {
    for (int column = tiles_.begin; column < tiles_.end; ++column) {
      tile_x_ = column * kTileSize, tile_y_ = tiles_.row * kTileSize;
      columns_ = std::min(kTileSize, target_.width - tile_x_), rows_ = std::min(kTileSize, target_.height - tile_y_);
      tiles_.is_open(column) ? Tile(tiles_.winner + tiles_.tile(column)) : ClearTile();
    }
  }

 private:
  static constexpr std::size_t kBarycentrics = kMaxAttributes;
  static constexpr std::size_t kLanes = hn::MaxLanes(DoubleTag());
  static constexpr int kMany = 6;  // so many pixels of a cell are worth their triangle's planes
  using Four = hn::CappedTag<double, 4>;
  using FourFloats = hn::Rebind<float, Four>;
  static constexpr std::size_t kFourLanes = hn::MaxLanes(Four()), kParts = 4 / kFourLanes;

  struct Output {
    float* values;
    std::uint32_t components;
    std::size_t step;       // floats from one sample to the next
    std::size_t attribute;  // or kBarycentrics
    // In the draw at hand: the values at vertex v of corner k of a triangle begin at corner[k] + v * stride.
    const float* corner[3] = {};
    std::size_t stride = 0;
    Interpolation interpolation = Interpolation::perspective;
  };
  // Where in a cell one draw is seen, and its triangles there; at other pixels, any of them.
  struct Pixels {
    std::uint32_t seen, lanes;  // seen: of any draw
    std::uint32_t scattered;    // a pixel of each triangle, if they lie anywhere in memory
    std::size_t draw;
    std::uint32_t before[4];                           // what no position is
    alignas(16) std::uint32_t position[kCellSamples];  // of the triangle in the draw
  };
  // Of vertices 1 and 2 at each pixel of a cell; vertex 0 has the rest. A bound of what their errors make of each unit
  // of the values' spread: infinite where nothing is known.
  struct Weights {
    alignas(64) double first[kCellSamples], second[kCellSamples], error[kCellSamples];
  };
  // What weights are made of, about a pixel of the tile, with steps in x and y: [0] over [2] is the weight of vertex 1,
  // [1] over [2] that of vertex 2. size: at least the amounts of all products at any pixel of the tile.
  struct Planes {
    std::uint32_t ordinal;
    int x, y;
    double e[3], by_x[3], by_y[3], size;
  };
  // Four components at vertex 0, and from there to vertices 1 and 2; what bounds of errors need of them.
  struct Corners {
    hn::Vec<Four> start[kParts], first[kParts], second[kParts], spread[kParts], most[kParts];
  };

  // ---- tiles and cells
  // A cell's triangles may lie anywhere in memory: then their indices are asked for two cells ahead, their vertices one.
  void Tile(const std::uint32_t* winner) {
    for (auto& of_kind : planes_) {
      for (Planes& planes : of_kind) planes.ordinal = kNoTriangle;
    }
    constexpr std::size_t kCells = kTileSamples / kCellSamples;
    Pixels ring[4];
    for (Pixels& pixels : ring) std::fill_n(pixels.before, 4, kNoTriangle);
    for (std::size_t n = 0; n < kCells + 2; ++n) {
      if (n < kCells) Look(winner + n * kCellSamples, 0xFFFF, ring[n & 3]);
      if (n >= 1 && n < kCells + 1) Ask(ring[(n - 1) & 3]);
      if (n >= 2) Cell(winner + (n - 2) * kCellSamples, (n - 2) * kCellSamples, ring[(n - 2) & 3]);
    }
  }

  // Finds the draw that is seen first in a cell.
  HWY_INLINE void Look(const std::uint32_t* winner, std::uint32_t among, Pixels& pixels) {
    const CellUint d;
    pixels.seen = pixels.lanes = pixels.scattered = 0;
    for (std::size_t i = 0; i < kCellSamples; i += kCellLanes)
      pixels.seen |= Bits(d, hn::Ne(hn::Load(d, winner + i), hn::Set(d, kNoTriangle))) << i;
    pixels.seen &= among;
    if (pixels.seen == 0) return;
    const std::uint32_t some = winner[std::countr_zero(pixels.seen)];
    pixels.draw = looked_at_ = frame_.draw_of(some, looked_at_);
    const DrawJob& job = frame_.draws[pixels.draw];
    const auto triangles = static_cast<std::uint32_t>(job.draw->indices.size() / 3);
    bool scattered = false;
    for (std::size_t i = 0; i < kCellSamples; i += kCellLanes) {
      const auto first = hn::Set(d, some - job.first_ordinal);
      const auto at = hn::Sub(hn::Load(d, winner + i), hn::Set(d, job.first_ordinal));
      const auto here = hn::Lt(at, hn::Set(d, triangles));
      const auto position = hn::IfThenElse(here, at, first);
      hn::StoreU(position, d, pixels.position + i);
      pixels.lanes |= Bits(d, here) << i;
      const auto distance = hn::Sub(hn::Add(position, hn::Set(d, kNear / 2)), first);
      scattered |= !hn::AllTrue(d, hn::Lt(distance, hn::Set(d, kNear)));
    }
    pixels.lanes &= pixels.seen;
    if (scattered) AskIndices(job.draw->indices.data(), pixels);
  }
  HWY_INLINE void AskIndices(const std::uint32_t* indices, Pixels& pixels) const {
    const CellUint d;
    for (std::size_t i = 0; i < kCellSamples; i += kCellLanes) {
      const std::uint32_t* const at = pixels.position + i;
      const auto position = hn::LoadU(d, at), left = hn::LoadU(d, at - 1), above = hn::LoadU(d, at - 4);
      pixels.scattered |= Bits(d, hn::And(hn::Ne(position, left), hn::Ne(position, above))) << i;
    }
    for (std::uint32_t rest = pixels.scattered; rest != 0; rest &= rest - 1)
      hwy::Prefetch(indices + std::size_t{3} * pixels.position[std::countr_zero(rest)]);
  }
  HWY_INLINE void Ask(const Pixels& pixels) const {
    if (pixels.scattered == 0 || pixels.draw != draw_) return;
    const Vertex* const vertices = draw().vertices.data();
    for (std::uint32_t rest = pixels.scattered; rest != 0; rest &= rest - 1) {
      const std::uint32_t* const triangle = TriangleAt(pixels, static_cast<std::size_t>(std::countr_zero(rest)));
      for (std::size_t k = 0; k < 3; ++k) hwy::Prefetch(vertices + triangle[k]);
      for (std::size_t n = 0; n < count_; ++n) {
        for (std::size_t k = 0; k < 3; ++k) hwy::Prefetch(outputs_[n].corner[k] + triangle[k] * outputs_[n].stride);
      }
    }
  }

  HWY_INLINE void Cell(const std::uint32_t* winner, std::size_t offset, Pixels& pixels) {
    cell_x_ = column_of(offset), cell_y_ = row_of(offset);
    if (cell_x_ >= columns_ || cell_y_ >= rows_) return;
    first_sample_ = frame_.sample_index(tile_x_ + cell_x_, tile_y_ + cell_y_);
    std::uint32_t rest = pixels.seen;
    if (HWY_UNLIKELY(rest != 0xFFFF)) {
      const std::uint32_t columns = BitRange(0, std::min(columns_ - cell_x_, 4) - 1) * 0x1111u;
      Clear(columns & kCellsOfRows[BitRange(0, std::min(rows_ - cell_y_, 4) - 1)] & ~rest);
    }
    while (rest != 0) {
      ShadePixels(pixels);
      rest &= ~pixels.lanes;
      if (HWY_LIKELY(rest == 0)) return;
      Look(winner, rest, pixels);
    }
  }
  void Clear(std::uint32_t lanes) const {
    for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
      for (std::size_t n = 0; n < count_; ++n)
        std::fill_n(ValueAt(outputs_[n], static_cast<std::size_t>(std::countr_zero(rest))), outputs_[n].components,
                    0.0f);
    }
  }
  HWY_NOINLINE void ClearTile() const {
    for (int y = tile_y_; y < tile_y_ + rows_; ++y) {
      for (std::size_t n = 0; n < count_; ++n) {
        const std::size_t components = outputs_[n].components,
                          step = outputs_[n].step * static_cast<std::size_t>(target_.samples);
        float* const row = outputs_[n].values + frame_.sample_index(tile_x_, y) * outputs_[n].step;
        if (step == components) {
          std::fill_n(row, static_cast<std::size_t>(columns_) * components, 0.0f);
        } else {
          for (int x = 0; x < columns_; ++x) std::fill_n(row + static_cast<std::size_t>(x) * step, components, 0.0f);
        }
      }
    }
  }
  float* ValueAt(const Output& out, std::size_t lane) const {
    return out.values + (first_sample_ + sample_[lane]) * out.step;
  }

  // ---- draws
  // The indices of a pixel's triangle.
  const std::uint32_t* TriangleAt(const Pixels& pixels, std::size_t lane) const {
    return indices_ + std::size_t{3} * pixels.position[lane];
  }
  const Draw& draw() const { return *frame_.draws[draw_].draw; }
  HWY_NOINLINE void SelectDraw(std::size_t n) {
    draw_ = n, indices_ = draw().indices.data();
    std::fill_n(wanted_, 3, false);
    for (std::size_t i = 0; i < count_; ++i) {
      Output& out = outputs_[i];
      if (out.attribute == kBarycentrics) {
        for (std::size_t k = 0; k < 3; ++k) out.corner[k] = kUnits[k];
      } else {
        const AttributeArray& in = draw().attributes[out.attribute];
        for (const float*& corner : out.corner) corner = in.values.data();
        out.stride = stride_of(in), out.interpolation = in.interpolation;
      }
      wanted_[static_cast<std::size_t>(out.interpolation)] = true;
    }
    has_planes_ = target_.samples == 1 && !draw().grid.has_value();
  }

  // ---- weights
  HWY_INLINE void ShadePixels(const Pixels& pixels) {
    const CellUint d;
    if (HWY_UNLIKELY(pixels.draw != draw_)) SelectDraw(pixels.draw);
    if (HWY_UNLIKELY(wanted_[static_cast<std::size_t>(Interpolation::flat)])) StoreFlat(pixels);
    for (const Interpolation kind : {Interpolation::perspective, Interpolation::noperspective}) {
      if (!wanted_[static_cast<std::size_t>(kind)]) continue;
      std::uint32_t rest = pixels.lanes, few = 0;
      for (int misses = has_planes_ ? 0 : 2; rest != 0 && misses < 2;) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        std::uint32_t same = 0;
        for (std::size_t i = 0; i < kCellSamples; i += kCellLanes)
          same |= Bits(d, hn::Eq(hn::LoadU(d, pixels.position + i), hn::Set(d, pixels.position[lane]))) << i;
        same &= rest;
        rest &= ~same;
        if (std::popcount(same) >= kMany) {
          WeighByPlanes(PlanesOf(pixels, lane, kind), same);
          Store<true>(pixels, same, kind);
        } else {
          few |= same, ++misses;
        }
      }
      few |= rest;
      if (few == 0) continue;
      WeighByLanes(pixels, few, kind);
      Store<false>(pixels, few, kind);
    }
  }

  // The weights e1 / sum and e2 / sum of lanes lane ..., and a bound of their errors.
  HWY_INLINE Double Weigh(Double e1, Double e2, Double sum, Double size, std::size_t lane) {
    const DoubleTag d;
    const Double one = hn::Set(d, 1.0), inverse = hn::Div(one, sum);
    const Double first = hn::Mul(e1, inverse), second = hn::Mul(e2, inverse);
    hn::Store(first, d, weights_.first + lane);
    hn::Store(second, d, weights_.second + lane);
    const Double most = hn::Max(hn::Abs(first), hn::Abs(second));
    return hn::Mul(hn::Mul(hn::Mul(size, hn::Set(d, kWeightBound)), hn::Abs(inverse)), hn::Add(one, most));
  }

  // Each pixel a lane, with edge functions about the pixel itself.
  HWY_NOINLINE void WeighByLanes(const Pixels& pixels, std::uint32_t lanes, Interpolation kind) {
    const DoubleTag d;
    const FloatTag df;
    const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
    const Vertex* const vertices = draw().vertices.data();
    if (HWY_UNLIKELY(target_.samples > 1)) FindPlaces(pixels, lanes);
    for (std::size_t lane = 0; lane < kCellSamples; lane += kLanes) {
      if ((lanes >> lane & ((1u << kLanes) - 1)) == 0) continue;
      Double px = hn::Add(hn::Set(d, tile_x_ + cell_x_ + place_.x), hn::Load(d, kColumns + lane));
      Double py = hn::Add(hn::Set(d, tile_y_ + cell_y_ + place_.y), hn::Load(d, kRows + lane));
      if (HWY_UNLIKELY(target_.samples > 1)) px = hn::Load(d, place_x_ + lane), py = hn::Load(d, place_y_ + lane);
      Double x[3], y[3], w[3], e[3], size_x = hn::Zero(d), size_y = size_x;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = LoadFours(df, [&](std::size_t l) { return &vertices[TriangleAt(pixels, lane + l)[k]].x; });
        w[k] = hn::PromoteTo(d, v.w);
        x[k] = hn::NegMulAdd(px, w[k], hn::PromoteTo(d, v.x));
        y[k] = hn::NegMulAdd(py, w[k], hn::PromoteTo(d, v.y));
        size_x = hn::Add(size_x, hn::Abs(x[k])), size_y = hn::Add(size_y, hn::Abs(y[k]));
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        e[i] = hn::MulSub(x[j], y[k], hn::Mul(x[k], y[j]));
      }
      Double size = hn::Mul(size_x, size_y), sum = hn::Add(hn::Add(e[0], e[1]), e[2]);
      auto known = hn::Eq(px, px);
      if (HWY_UNLIKELY(draw().grid.has_value())) known = AllCount(w, e, size);
      if (HWY_UNLIKELY(kind == Interpolation::noperspective)) {
        sum = DeterminantOf(w, e), size = hn::Mul(size, MostOf(w));
        e[1] = hn::Mul(w[1], e[1]), e[2] = hn::Mul(w[2], e[2]);
      }
      const Double error = Weigh(e[1], e[2], sum, size, lane);
      known = hn::And(known, hn::Lt(error, hn::Set(d, kKnown)));
      hn::Store(hn::IfThenElse(known, error, infinity), d, weights_.error + lane);
    }
  }
  HWY_NOINLINE void FindPlaces(const Pixels& pixels, std::uint32_t lanes) {
    for (std::size_t l = 0; l < kCellSamples; ++l) {
      const int x = target_.origin.x + tile_x_ + cell_x_ + kColumn[l];
      const int y = target_.origin.y + tile_y_ + cell_y_ + kRow[l];
      place_x_[l] = x + 0.5, place_y_[l] = y + 0.5;
      if ((lanes >> l & 1) == 0) continue;
      exact_.use(draw(), pixels.position[l]);
      const SamplePosition p = exact_.place_of_attributes(target_, x, y, frame_.draws[draw_].shift);
      place_x_[l] = p.x, place_y_[l] = p.y;
    }
  }
  static HWY_INLINE Double DeterminantOf(const Double (&w)[3], const Double (&e)[3]) {
    return hn::MulAdd(w[2], e[2], hn::MulAdd(w[1], e[1], hn::Mul(w[0], e[0])));
  }
  // Grid: do all E_i surely have D's sign? Others may count as 0 (G2).
  static HWY_NOINLINE hn::Mask<DoubleTag> AllCount(const Double (&w)[3], const Double (&e)[3], Double size) {
    const DoubleTag d;
    const Double error = hn::Mul(size, hn::Set(d, kEdgeErrorBound)), determinant = DeterminantOf(w, e);
    const Double sign = hn::And(determinant, hn::Set(d, -0.0));
    auto all = hn::Gt(hn::Abs(determinant), hn::Mul(error, MostOf(w)));
    for (std::size_t i = 0; i < 3; ++i) all = hn::And(all, hn::Gt(hn::Xor(e[i], sign), error));
    return all;
  }
  static HWY_INLINE Double MostOf(const Double (&w)[3]) {
    return hn::Max(hn::Max(hn::Abs(w[0]), hn::Abs(w[1])), hn::Abs(w[2]));
  }

  // Pixels of the cell by one triangle's planes. Their bound is that of the worst.
  HWY_NOINLINE void WeighByPlanes(const Planes& planes, std::uint32_t lanes) {
    const DoubleTag d;
    const Double x0 = hn::Set(d, cell_x_ - planes.x), y0 = hn::Set(d, cell_y_ - planes.y);
    Double worst = hn::Zero(d);
    for (std::size_t lane = 0; lane < kCellSamples; lane += kLanes) {
      if ((lanes >> lane & ((1u << kLanes) - 1)) == 0) continue;
      const Double x = hn::Add(x0, hn::Load(d, kColumns + lane)), y = hn::Add(y0, hn::Load(d, kRows + lane));
      const auto at = [&](std::size_t i) {
        const Double row = hn::MulAdd(hn::Set(d, planes.by_y[i]), y, hn::Set(d, planes.e[i]));
        return hn::MulAdd(hn::Set(d, planes.by_x[i]), x, row);
      };
      // Of a NaN nothing is left here, but the weights are none either, then.
      worst = hn::Max(Weigh(at(0), at(1), at(2), hn::Set(d, planes.size), lane), worst);
    }
    const double error = hn::GetLane(hn::MaxOfLanes(d, worst));
    weights_.error[0] = error < kKnown ? error : std::numeric_limits<double>::infinity();
  }
  HWY_INLINE const Planes& PlanesOf(const Pixels& pixels, std::size_t lane, Interpolation kind) {
    const std::uint32_t ordinal = frame_.draws[draw_].first_ordinal + pixels.position[lane];
    Planes& planes = planes_[kind == Interpolation::noperspective][ordinal % kPlanes];
    if (planes.ordinal != ordinal) SetUp(TriangleAt(pixels, lane), kind, planes);
    planes.ordinal = ordinal;
    return planes;
  }
  // About the cell's first pixel.
  HWY_NOINLINE void SetUp(const std::uint32_t* indices, Interpolation kind, Planes& planes) const {
    const double px = tile_x_ + cell_x_ + place_.x, py = tile_y_ + cell_y_ + place_.y;
    double x[3], y[3], e[3], a[3], b[3], size_x = 0, size_y = 0, steps = 0;
    const Vertex v[3] = {draw().vertices[indices[0]], draw().vertices[indices[1]], draw().vertices[indices[2]]};
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = v[k].x - px * v[k].w, y[k] = v[k].y - py * v[k].w;
      size_x += std::fabs(x[k]), size_y += std::fabs(y[k]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      e[i] = x[j] * y[k] - x[k] * y[j];
      a[i] = static_cast<double>(v[j].y) * v[k].w - static_cast<double>(v[k].y) * v[j].w;
      b[i] = static_cast<double>(v[k].x) * v[j].w - static_cast<double>(v[j].x) * v[k].w;
      steps += std::fabs(a[i]) + std::fabs(b[i]);
    }
    planes = {kNoTriangle,
              cell_x_,
              cell_y_,
              {e[1], e[2], (e[0] + e[1]) + e[2]},
              {a[1], a[2], (a[0] + a[1]) + a[2]},
              {b[1], b[2], (b[0] + b[1]) + b[2]},
              size_x * size_y + (kTileSize - 1) * steps};
    if (kind == Interpolation::perspective) return;
    for (std::size_t i = 0; i < 2; ++i)
      planes.e[i] *= v[i + 1].w, planes.by_x[i] *= v[i + 1].w, planes.by_y[i] *= v[i + 1].w;
    planes.e[2] = (v[0].w * e[0] + v[1].w * e[1]) + v[2].w * e[2], planes.by_x[2] = planes.by_y[2] = 0;
    planes.size *= std::max({std::fabs(v[0].w), std::fabs(v[1].w), std::fabs(v[2].w)});
  }

  // ---- values
  template <bool kOne>
  HWY_INLINE void Store(const Pixels& pixels, std::uint32_t lanes, Interpolation kind) {
    for (std::size_t n = 0; n < count_; ++n) {
      const Output& out = outputs_[n];
      if (out.interpolation != kind) continue;
      out.components == 4 ? StoreMeans<kOne, true>(pixels, lanes, out) : StoreMeans<kOne, false>(pixels, lanes, out);
    }
  }
  HWY_NOINLINE void StoreFlat(const Pixels& pixels) const {
    for (std::size_t n = 0; n < count_; ++n) {
      const Output& out = outputs_[n];
      for (std::uint32_t rest = pixels.lanes; out.interpolation == Interpolation::flat && rest != 0; rest &= rest - 1) {
        const auto l = static_cast<std::size_t>(std::countr_zero(rest));
        const float* const from = CornerOf(pixels, l, out, 0);
        float* const to = ValueAt(out, l);
        for (std::uint32_t c = 0; c < out.components; ++c) to[c] = from[c] + 0.0f;
      }
    }
  }
  const float* CornerOf(const Pixels& pixels, std::size_t lane, const Output& out, std::size_t k) const {
    return out.corner[k] + TriangleAt(pixels, lane)[k] * out.stride;
  }

  // Of components at corners[0 .. 2].
  template <bool kFour>
  static HWY_INLINE Corners LoadCorners(const float* (&corners)[3], std::uint32_t components) {
    const Four d;
    const FourFloats df;
    alignas(16) float copies[3][4] = {};
    for (std::size_t k = 0; !kFour && k < 3; ++k)
      CopyComponents(corners[k], components, copies[k]), corners[k] = copies[k];
    Corners values;
    for (std::size_t part = 0; part < kParts; ++part) {
      const auto u = [&](std::size_t k) { return hn::PromoteTo(d, hn::LoadU(df, corners[k] + part * kFourLanes)); };
      const auto u0 = u(0), u1 = u(1), u2 = u(2);
      values.start[part] = u0, values.first[part] = hn::Sub(u1, u0), values.second[part] = hn::Sub(u2, u0);
      values.spread[part] = hn::Add(hn::Abs(values.first[part]), hn::Abs(values.second[part]));
      values.most[part] = hn::Max(hn::Max(hn::Abs(u0), hn::Abs(u1)), hn::Abs(u2));
    }
    return values;
  }

  // Weighted means, rounded to float32 (I4). kOne: all pixels have one triangle.
  template <bool kOne, bool kFour>
  HWY_NOINLINE void StoreMeans(const Pixels& pixels, std::uint32_t lanes, const Output& out) {
    const Four d;
    const FourFloats df;
    // What is written to memory may be none of these.
    const float* const corner[3] = {out.corner[0], out.corner[1], out.corner[2]};
    const std::size_t stride = out.stride, step = out.step, components = kFour ? 4 : out.components;
    const std::uint32_t* const indices = indices_;
    float* const first_value = out.values + first_sample_ * step;
    const auto load = [&](std::size_t l) HWY_ATTR {
      const std::uint32_t* const triangle = indices + std::size_t{3} * pixels.position[l];
      const float* corners[3] = {corner[0] + triangle[0] * stride, corner[1] + triangle[1] * stride,
                                 corner[2] + triangle[2] * stride};
      return LoadCorners<kFour>(corners, static_cast<std::uint32_t>(components));
    };
    Corners values;
    hn::Vec<Four> bound[kParts];
    if (kOne) {
      values = load(static_cast<std::size_t>(std::countr_zero(lanes)));
      for (std::size_t part = 0; part < kParts; ++part)
        bound[part] = hn::MulAdd(hn::Set(d, weights_.error[0]), values.spread[part],
                                 hn::Mul(hn::Set(d, kValueBound), values.most[part]));
    }
    for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<std::size_t>(std::countr_zero(rest));
      float* const to = first_value + sample_[l] * step;
      alignas(16) float four[4];
      float* const nearest = kFour ? to : four;
      if (!kOne) values = load(l);
      const auto first = hn::Set(d, weights_.first[l]), second = hn::Set(d, weights_.second[l]);
      std::uint32_t told = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const auto start = hn::MulAdd(first, values.first[part], values.start[part]);
        const auto value = hn::MulAdd(second, values.second[part], start);
        if (!kOne) {
          bound[part] = hn::MulAdd(hn::Set(d, weights_.error[l]), values.spread[part],
                                   hn::Mul(hn::Set(d, kValueBound), hn::Abs(value)));
        }
        const auto low = hn::DemoteTo(df, hn::Sub(value, bound[part]));
        const auto high = hn::DemoteTo(df, hn::Add(value, bound[part]));
        // False also if both ends are infinite, as they are beyond float32's range, or NaN.
        told |= Bits(df, hn::Eq(hn::Sub(high, low), hn::Zero(df))) << (part * kFourLanes);
        hn::StoreU(hn::Add(low, hn::Zero(df)), df, nearest + part * kFourLanes);  // no -0
      }
      if (!kFour) CopyComponents(four, out.components, to);
      if (HWY_UNLIKELY(told != 0xF)) StoreExact(pixels, l, ~told & ((1u << components) - 1), out);
    }
    rungs_.values_by_filter += static_cast<std::uint64_t>(std::popcount(lanes)) * components;
  }

  // Components that the bound could not tell.
  HWY_NOINLINE void StoreExact(const Pixels& pixels, std::size_t lane, std::uint32_t unknown, const Output& out) {
    SamplePosition p{tile_x_ + cell_x_ + kColumn[lane] + place_.x, tile_y_ + cell_y_ + kRow[lane] + place_.y};
    if (target_.samples > 1) p = {place_x_[lane], place_y_[lane]};
    rungs_.values_by_filter -= static_cast<std::uint64_t>(std::popcount(unknown));
    for (; unknown != 0; unknown &= unknown - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(unknown));
      float u[3];
      for (std::size_t k = 0; k < 3; ++k) u[k] = CornerOf(pixels, lane, out, k)[c];
      exact_.use(draw(), pixels.position[lane]);
      ValueAt(out, lane)[c] = exact_.attribute(p, u, out.interpolation, &rungs_);
    }
  }

  // Sizes that the compiler knows: a call of memcpy would cost as much as the rest.
  static HWY_INLINE void CopyComponents(const float* from, std::uint32_t components, float* to) {
    if (components == 4) {
      std::memcpy(to, from, 4 * sizeof(float));
    } else if (components == 3) {
      std::memcpy(to, from, 3 * sizeof(float));
    } else {
      to[0] = from[0];
      if (components == 2) to[1] = from[1];
    }
  }

  // Triangles of positions so near each other are taken for neighbours in memory, too, as those of a mesh are.
  static constexpr std::uint32_t kNear = 1 << 14;
  static constexpr std::size_t kPlanes = 16;
  alignas(16) static constexpr float kUnits[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  alignas(64) static constexpr double kColumns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) static constexpr double kRows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

  const FrameJob& frame_;
  const Target& target_;
  const TileRow& tiles_;
  Rungs& rungs_;
  Output outputs_[kMaxAttributes + 1];
  std::size_t count_ = 0;
  std::size_t sample_[kCellSamples];  // from a cell's first sample to others

  // The draw, the tile and the cell at hand.
  std::size_t draw_ = ~std::size_t{0}, looked_at_ = 0;
  const std::uint32_t* indices_ = nullptr;
  bool wanted_[3] = {};  // kinds of interpolation
  bool has_planes_ = false;
  int tile_x_ = 0, tile_y_ = 0, columns_ = 0, rows_ = 0, cell_x_ = 0, cell_y_ = 0;
  std::size_t first_sample_ = 0;
  SamplePosition place_{0.5, 0.5};  // in space, of the attributes of pixel (0, 0), where a pixel has one sample
  alignas(64) double place_x_[kCellSamples], place_y_[kCellSamples];  // and in pixels of several
  Weights weights_;
  Planes planes_[2][kPlanes];  // of triangles that were seen last in the tile: perspective, noperspective
  ExactDraw exact_;
};

void Shade(const FrameJob& frame, const TileRow& tiles, Rungs& rungs) {
  Shader(frame, tiles, rungs).Run();
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_SHADE_INL_HPP
