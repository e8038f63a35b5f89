// SPDX-License-Identifier: Apache-2.0
//
// Barycentrics and attributes of what is seen: a row of a block at a time, each pixel a lane with its own triangle, in
// double with error bounds; where a bound cannot tell which float32 is nearest, the scalar Triangle.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_FAST_SHADE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_FAST_SHADE_INL_HPP
#undef SUREFILL_SRC_FAST_SHADE_INL_HPP
#else
#define SUREFILL_SRC_FAST_SHADE_INL_HPP
#endif

#include <cstring>

#include "fast/edges-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace {  // not visible to the linker
namespace hn = hwy::HWY_NAMESPACE;

class Shader {
 public:
  Shader(const FrameJob& frame, const TileRow& tiles, Rungs& rungs)
      : frame_(frame), target_(*frame.target), tiles_(tiles), rungs_(rungs) {
    x1_ = std::min(tiles.end * kTileSize, target_.width);
    if (!target_.barycentrics.empty()) {
      outputs_[count_++] = {target_.barycentrics.data(), 3, kBarycentrics};
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (!out.values.empty()) outputs_[count_++] = {out.values.data(), out.components, k};
    }
  }

  // Block by block: a triangle that is seen in one row is seen in the next, and is still in the first cache.
  void Run() {
    const int x0 = tiles_.begin * kTileSize, y0 = tiles_.row * kTileSize, y1 = std::min(y0 + kTileSize, target_.height);
    for (int y = y0; y < y1; y += 8) {
      const int rows = std::min(8, y1 - y);
      Prefetch(x0, y, rows, true);
      Prefetch(x0, y, rows, false);
      Prefetch(x0 + 8, y, rows, true);
      for (int x = x0; x < x1_; x += 8) {
        Prefetch(x + 8, y, rows, false);
        Prefetch(x + 16, y, rows, true);
        if (!IsOpen(x)) {
          for (int row = y; row < y + rows; ++row) ClearRow(x, row);
        } else {
          for (int row = y; row < y + rows; ++row) Row(x, row);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kBarycentrics = kMaxAttributes;
  static constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(DoubleTag()));
  static constexpr auto kFour = static_cast<std::uint32_t>(hn::MaxLanes(hn::CappedTag<std::uint32_t, 4>()));

  struct Output {
    float* values;
    std::uint32_t components;
    std::size_t attribute;  // or kBarycentrics
  };
  // Pixels of a row of a block where one draw is seen, each in its lane. Other lanes repeat one of them.
  struct Pixels {
    std::uint32_t lanes;
    alignas(32) std::uint32_t position[kBatch];  // of the triangle in the draw
    std::uint32_t indices[3 * kBatch];           // of its vertices
    alignas(64) double x[kBatch], y[kBatch];     // where attributes are taken
  };
  // Of four components, with error bounds.
  struct Numerators {
    Double value[4], error[4];
  };
  // A denominator's inverse; its error bound; and more than the inverse of the real one, NaN where the denominator is
  // not known to 10 bits.
  struct Denominator {
    Double inverse, error, known;

    Denominator(Double value, Double bound) {
      const DoubleTag d;
      inverse = hn::Div(hn::Set(d, 1.0), value);
      error = bound;
      known = hn::IfThenElse(hn::Gt(hn::Mul(hn::Abs(value), hn::Set(d, 0x1p-10)), bound),
                             hn::Mul(hn::Abs(inverse), hn::Set(d, 1.002)),
                             hn::Set(d, std::numeric_limits<double>::quiet_NaN()));
    }
  };

  // The triangles of a block lie anywhere in memory: their indices are asked for two blocks ahead, their vertices one.
  // (Inlined: g++ drops calls of functions that only prefetch.)
  HWY_INLINE void Prefetch(int x0, int y0, int rows, bool indices) {
    if (x0 >= x1_ || !IsOpen(x0)) return;
    std::uint32_t last = kNoTriangle;
    std::size_t draw = draw_;
    for (int y = y0; y < y0 + rows; ++y) {
      for (int x = x0; x < std::min(x0 + 8, x1_); ++x) {
        const std::uint32_t winner = tiles_.winner[tiles_.offset(x, y)];
        if (winner == last || winner == kNoTriangle) continue;
        last = winner;
        draw = frame_.draw_of(winner, draw);
        const Draw& of = *frame_.draws[draw].draw;
        const std::uint32_t* const triangle = &of.indices[std::size_t{3} * (winner - frame_.draws[draw].first_ordinal)];
        if (indices) {
          hwy::Prefetch(triangle);
        } else {
          for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&of.vertices[triangle[i]]);
          for (const AttributeArray& in : of.attributes) {
            const std::size_t stride = stride_of(in);
            for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&in.values[triangle[i] * stride]);
          }
        }
      }
    }
  }

  // Up to 8 pixels, those of a block's row.
  void Row(int x0, int y) {
    const hn::CappedTag<std::uint32_t, 4> du;
    alignas(16) std::uint32_t winners[kBatch];
    std::uint32_t seen = 0;
    for (std::uint32_t l = 0; l < kBatch; l += kFour) {
      const auto w = hn::LoadU(du, tiles_.winner + tiles_.offset(x0 + static_cast<int>(l), y));
      hn::Store(w, du, winners + l);
      seen |= Bits(du, hn::Ne(w, hn::Set(du, kNoTriangle))) << l;
    }
    const auto columns = static_cast<std::uint32_t>(std::min(8, x1_ - x0));
    seen &= (1u << columns) - 1;
    if (seen == 0) {
      ClearRow(x0, y);
      return;
    }
    first_sample_ = frame_.sample_index(x0, y);
    for (std::uint32_t rest = ~seen & ((1u << columns) - 1); rest != 0; rest &= rest - 1)
      Clear(SampleOf(static_cast<std::uint32_t>(std::countr_zero(rest))));
    Pixels pixels;
    for (std::uint32_t l = 0; l < kBatch; ++l) pixels.x[l] = x0 + kCentre[l], pixels.y[l] = y + 0.5;
    for (; seen != 0; seen &= ~pixels.lanes) {
      const std::uint32_t some = winners[std::countr_zero(seen)];
      draw_ = frame_.draw_of(some, draw_);
      const std::uint32_t first = frame_.draws[draw_].first_ordinal,
                          triangles = static_cast<std::uint32_t>(draw().indices.size() / 3);
      pixels.lanes = 0;
      for (std::uint32_t l = 0; l < kBatch; l += kFour) {
        const auto position = hn::Sub(hn::Load(du, winners + l), hn::Set(du, first));
        const auto here = hn::Lt(position, hn::Set(du, triangles));
        hn::Store(hn::IfThenElse(here, position, hn::Set(du, some - first)), du, pixels.position + l);
        pixels.lanes |= Bits(du, here) << l;
      }
      pixels.lanes &= seen;
      for (std::uint32_t l = 0; l < kBatch; ++l) {
        const std::uint32_t* const triangle = &draw().indices[std::size_t{3} * pixels.position[l]];
        std::memcpy(pixels.indices + 3 * l, triangle, 3 * sizeof(std::uint32_t));
      }
      if (HWY_UNLIKELY(target_.samples > 1)) {
        for (std::uint32_t rest = pixels.lanes; rest != 0; rest &= rest - 1) {
          const auto l = static_cast<std::uint32_t>(std::countr_zero(rest));
          const SamplePosition p = PositionOf(pixels.position[l], x0 + static_cast<int>(l), y);
          pixels.x[l] = p.x, pixels.y[l] = p.y;
        }
      }
      for (std::uint32_t lane = 0; lane < kBatch; lane += kLanes) {
        if ((pixels.lanes >> lane & ((1u << kLanes) - 1)) != 0) Values(pixels, lane);
      }
    }
  }
  alignas(64) static constexpr double kCentre[8] = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5};

  std::size_t SampleOf(std::uint32_t lane) const {
    return first_sample_ + lane * static_cast<std::size_t>(target_.samples);
  }
  bool IsOpen(int x) const { return tiles_.is_open(x >> kTileLog2); }

  void Clear(std::size_t s) const {
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::uint32_t c = 0; c < outputs_[k].components; ++c) outputs_[k].values[s * outputs_[k].components + c] = 0;
    }
  }
  HWY_NOINLINE void ClearRow(int x0, int y) const {
    const int x1 = std::min(x0 + 8, x1_);
    if (target_.samples > 1) {
      for (int x = x0; x < x1; ++x) Clear(frame_.sample_index(x, y));
      return;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      const std::size_t components = outputs_[k].components, n = static_cast<std::size_t>(x1 - x0) * components;
      std::fill_n(outputs_[k].values + frame_.sample_index(x0, y) * components, n, 0.0f);
    }
  }

  const Draw& draw() const { return *frame_.draws[draw_].draw; }

  // Where the attributes of pixel (x, y) are taken (M1).
  HWY_NOINLINE SamplePosition PositionOf(std::uint32_t position, int x, int y) {
    exact_.use(draw(), position);
    return exact_.place_of_attributes(target_, x, y, frame_.draws[draw_].shift);
  }

  // Grid: lanes where not all E_i surely have D's sign. Then some may count as 0 (G2).
  static HWY_NOINLINE std::uint32_t SomeEdgeMayNotCount(const Double (&w)[3], const Edges& edges) {
    const DoubleTag d;
    Double det, det_error;
    Determinant(w, edges, det, det_error);
    const auto sign = hn::And(det, hn::Set(d, -0.0));
    auto all = hn::Gt(hn::Abs(det), det_error);
    for (std::size_t i = 0; i < 3; ++i) all = hn::And(all, hn::Gt(hn::Xor(edges.e[i], sign), edges.error[i]));
    return ~Bits(d, all);
  }

  // The values of lanes lane ... : sums of u_i E_i over the sum of the E_i, or of u_i W_i E_i over D, with the E_i
  // taken at the pixel itself. An edge's error is at least 2^-50 times its value: twice that error bounds a product
  // with it, and sums of three.
  HWY_INLINE void Values(const Pixels& pixels, std::uint32_t lane) {
    const DoubleTag d;
    const FloatTag df;
    const BatchVertices vertices{draw().vertices.data(), pixels.indices};
    Double x[3], y[3], w[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = LoadCorner(df, vertices, lane, k);
      x[k] = hn::PromoteTo(d, v.x), y[k] = hn::PromoteTo(d, v.y), w[k] = hn::PromoteTo(d, v.w);
    }
    Edges edges;
    HomogeneousEdges(x, y, w, hn::Load(d, pixels.x + lane), hn::Load(d, pixels.y + lane), edges);
    for (std::size_t i = 0; i < 3; ++i) edges.error[i] = hn::Add(edges.error[i], edges.error[i]);
    const Denominator perspective(hn::Add(hn::Add(edges.e[0], edges.e[1]), edges.e[2]),
                                  hn::Add(hn::Add(edges.error[0], edges.error[1]), edges.error[2]));
    const std::uint32_t lanes = pixels.lanes >> lane & ((1u << kLanes) - 1);
    const std::uint32_t exactly = HWY_UNLIKELY(draw().grid.has_value()) ? SomeEdgeMayNotCount(w, edges) : 0;
    for (std::size_t n = 0; n < count_; ++n) {
      const Output& out = outputs_[n];
      if (out.attribute == kBarycentrics) {
        const Numerators sums{{edges.e[0], edges.e[1], edges.e[2], edges.e[2]},
                              {edges.error[0], edges.error[1], edges.error[2], edges.error[2]}};
        Quotients(pixels, lane, lanes, exactly, out, sums, perspective);
        continue;
      }
      const AttributeArray& in = draw().attributes[out.attribute];
      const auto values_of = [&](std::size_t l, std::size_t k) { return ValuesOf(in, pixels, lane + l, k); };
      if (in.interpolation == Interpolation::flat) {
        for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
          const auto l = static_cast<std::uint32_t>(std::countr_zero(rest));
          float* const to = out.values + SampleOf(lane + l) * out.components;
          for (std::uint32_t c = 0; c < out.components; ++c) to[c] = values_of(l, 0)[c] + 0.0f;
        }
        continue;
      }
      const bool noperspective = in.interpolation == Interpolation::noperspective;
      const Double none = hn::Zero(d);
      Numerators sums{{none, none, none, none}, {none, none, none, none}};
      for (std::size_t k = 0; k < 3; ++k) {
        Corner<FloatTag> u;
        if (out.components == 4) {
          u = LoadFours(df, [&](std::size_t l) { return values_of(l, k); });
        } else {
          alignas(16) float fours[kLanes][4] = {};
          for (std::size_t l = 0; l < kLanes; ++l) CopyComponents(values_of(l, k), out.components, fours[l]);
          u = LoadFours(df, [&](std::size_t l) { return fours[l]; });
        }
        const Float components[4] = {u.x, u.y, u.z, u.w};
        for (std::size_t c = 0; c < 4; ++c) {
          auto weight = hn::PromoteTo(d, components[c]);
          if (noperspective) weight = hn::Mul(weight, w[k]);  // 48 bits, exact
          sums.value[c] = hn::Add(sums.value[c], hn::Mul(weight, edges.e[k]));
          sums.error[c] = hn::Add(sums.error[c], hn::Mul(hn::Abs(weight), edges.error[k]));
        }
      }
      Quotients(pixels, lane, lanes, exactly, out, sums, noperspective ? OverDeterminant(w, edges) : perspective);
    }
  }
  static HWY_NOINLINE Denominator OverDeterminant(const Double (&w)[3], const Edges& edges) {
    Double det, error;
    Determinant(w, edges, det, error);
    return {det, error};
  }
  static const float* ValuesOf(const AttributeArray& in, const Pixels& pixels, std::size_t lane, std::size_t k) {
    const std::size_t stride = stride_of(in);
    return in.values.data() + pixels.indices[3 * lane + k] * stride;
  }

  // Numerators with error bounds over a denominator, rounded to float32: I4.
  HWY_INLINE void Quotients(const Pixels& pixels, std::uint32_t lane, std::uint32_t lanes, std::uint32_t exactly,
                            const Output& out, const Numerators& above, const Denominator& below) {
    const DoubleTag d;
    const FloatTag df;
    const auto most = hn::Set(d, kLargestFloat), least = hn::Set(d, -kLargestFloat);
    Float nearest[4];
    std::uint32_t unknown[4], any = 0;
    for (std::uint32_t c = 0; c < 4; ++c) {
      const auto q = hn::Mul(above.value[c], below.inverse), size = hn::Abs(q);
      const auto numerators = hn::Add(above.error[c], hn::Mul(size, below.error));
      const auto bound = hn::Add(hn::Mul(numerators, below.known), hn::Mul(size, hn::Set(d, 0x1p-51)));
      const auto low = hn::DemoteTo(df, hn::Max(hn::Min(hn::Sub(q, bound), most), least));
      const auto high = hn::DemoteTo(df, hn::Max(hn::Min(hn::Add(q, bound), most), least));
      // In an interval with a NaN both ends may have become the same limit.
      const auto told = hn::And(hn::Eq(low, high), hn::Lt(hn::Abs(low), hn::Set(df, kLargestFloatAsFloat)));
      nearest[c] = hn::Add(low, hn::Zero(df));
      unknown[c] = c < out.components ? (~Bits(df, told) | exactly) & lanes : 0;
      rungs_.values_by_filter +=
          c < out.components ? static_cast<std::uint32_t>(std::popcount(lanes & ~unknown[c])) : 0;
      any |= unknown[c];
    }
    float* const row = out.values + SampleOf(lane) * out.components;
    if (HWY_LIKELY(out.components == 4 && lanes == (1u << kLanes) - 1 && target_.samples == 1)) {
      hn::StoreInterleaved4(nearest[0], nearest[1], nearest[2], nearest[3], df, row);
      if (HWY_UNLIKELY(any != 0)) ExactValues(pixels, lane, unknown, out);
      return;
    }
    alignas(64) float fours[4 * kLanes];
    hn::StoreInterleaved4(nearest[0], nearest[1], nearest[2], nearest[3], df, fours);
    for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(rest));
      CopyComponents(fours + 4 * l, out.components, out.values + SampleOf(lane + l) * out.components);
    }
    if (HWY_UNLIKELY(any != 0)) ExactValues(pixels, lane, unknown, out);
  }

  // Those that a bound could not tell.
  HWY_NOINLINE void ExactValues(const Pixels& pixels, std::uint32_t lane, const std::uint32_t (&unknown)[4],
                                const Output& out) {
    const bool barycentrics = out.attribute == kBarycentrics;
    const AttributeArray* const in = barycentrics ? nullptr : &draw().attributes[out.attribute];
    for (std::uint32_t c = 0; c < out.components; ++c) {
      for (std::uint32_t rest = unknown[c]; rest != 0; rest &= rest - 1) {
        const std::uint32_t l = lane + static_cast<std::uint32_t>(std::countr_zero(rest));
        float u[3];
        for (std::uint32_t k = 0; k < 3; ++k)
          u[k] = barycentrics ? (k == c ? 1.0f : 0.0f) : ValuesOf(*in, pixels, l, k)[c];
        exact_.use(draw(), pixels.position[l]);
        out.values[SampleOf(l) * out.components + c] = exact_.attribute(
            {pixels.x[l], pixels.y[l]}, u, barycentrics ? Interpolation::perspective : in->interpolation, &rungs_);
      }
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
  static constexpr float kLargestFloatAsFloat = std::numeric_limits<float>::max();

  const FrameJob& frame_;
  const Target& target_;
  const TileRow& tiles_;
  int x1_ = 0;  // where the tiles or the target end
  Rungs& rungs_;
  Output outputs_[kMaxAttributes + 1];
  std::size_t count_ = 0;
  std::size_t first_sample_ = 0;  // of the row at hand
  std::size_t draw_ = 0;
  ExactDraw exact_;
};

void Shade(const FrameJob& frame, const TileRow& tiles, Rungs& rungs) {
  Shader(frame, tiles, rungs).Run();
}

}  // namespace
}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_FAST_SHADE_INL_HPP
