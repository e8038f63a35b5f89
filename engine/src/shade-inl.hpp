// SPDX-License-Identifier: Apache-2.0
//
// Barycentrics and attributes of what is seen: planes in double with error bounds, four components at a time; where a
// bound cannot tell which float32 is nearest, the scalar Triangle.
// Included once for each instruction set by kernels.cpp.
#if defined(SUREFILL_SRC_SHADE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUREFILL_SRC_SHADE_INL_HPP
#undef SUREFILL_SRC_SHADE_INL_HPP
#else
#define SUREFILL_SRC_SHADE_INL_HPP
#endif

#include <cstring>

#include "canvas.hpp"
#include "exact_draw.hpp"
#include "hwy/cache_control.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace surefill::fast::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class Shader {
 public:
  Shader(const ShadeJob& job, const Canvas& canvas, Statistics& statistics)
      : job_(job), target_(*job.target), canvas_(canvas), statistics_(statistics) {
    if (!target_.barycentrics.empty()) {
      outputs_[count_++] = {target_.barycentrics.data(), 3, kBarycentrics};
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (!out.values.empty()) outputs_[count_++] = {out.values.data(), out.components, k};
    }
  }

  // Block by block: a triangle that is seen in one row is seen in the next, and is still set up.
  void Run(int y0, int y1) {
    for (int y = y0; y < y1; y += 8) {
      const int rows = std::min(8, y1 - y);
      Prefetch(0, y, rows, true);
      Prefetch(0, y, rows, false);
      Prefetch(8, y, rows, true);
      for (int x = 0; x < target_.width; x += 8) {
        Prefetch(x + 8, y, rows, false);
        Prefetch(x + 16, y, rows, true);
        if (IsUntouched(x, y)) {
          for (int row = y; row < y + rows; ++row) ClearRow(x, row);
        } else {
          Block(x, y, rows);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kBarycentrics = kMaxAttributes;
  using D = hn::CappedTag<double, 4>;
  using F = hn::Rebind<float, D>;

  struct Output {
    float* values;
    std::uint32_t components;
    std::size_t attribute;  // or kBarycentrics
  };
  // Numerators of up to four components about the origin of the screen, and a bound of their error anywhere on the
  // target. flat: c alone, the values themselves.
  struct Planes {
    alignas(32) double a[4], b[4], c[4], error[4];
    Interpolation interpolation;
  };
  // A denominator in the same way.
  struct Denominator {
    double a, b, c, error;
  };

  // The triangles of a block lie anywhere in memory: their indices are asked for two blocks ahead, their vertices one.
  // (Inlined: g++ drops calls of functions that only prefetch.)
  HWY_INLINE void Prefetch(int x0, int y0, int rows, bool indices) {
    if (x0 >= target_.width || IsUntouched(x0, y0)) return;
    std::uint32_t last = kNoTriangle;
    std::size_t draw = draw_;
    for (int y = y0; y < y0 + rows; ++y) {
      for (int x = x0; x < std::min(x0 + 8, target_.width); ++x) {
        const std::uint32_t winner = canvas_.winner[canvas_.offset_of(x, y)];
        if (winner == last || winner == kNoTriangle) continue;
        last = winner;
        draw = DrawOf(winner, draw);
        const Draw& of = *job_.jobs[draw].draw;
        const std::uint32_t* const triangle = &of.indices[std::size_t{3} * (winner - job_.jobs[draw].first_ordinal)];
        if (indices) {
          hwy::Prefetch(triangle);
        } else {
          for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&of.vertices[triangle[i]]);
          for (const AttributeArray& in : of.attributes) {
            const std::size_t stride = in.stride != 0 ? in.stride : in.components;
            for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&in.values[triangle[i] * stride]);
          }
        }
      }
    }
  }

  void Block(int x0, int y0, int rows) {
    for (int y = y0; y < y0 + rows; ++y) {
      if (IsEmptyRow(x0, y)) {
        ClearRow(x0, y);
        continue;
      }
      for (int x = x0; x < std::min(x0 + 8, target_.width); ++x) {
        const std::size_t s = SampleIndex(x, y);
        const std::uint32_t winner = canvas_.winner[canvas_.offset_of(x, y)];
        if (winner == kNoTriangle) {
          Clear(s);
          continue;
        }
        if (winner != winner_) {
          winner_ = winner;
          draw_ = DrawOf(winner, draw_);
          position_ = winner - job_.jobs[draw_].first_ordinal;
          seen_ = &seen_triangles_[winner % kSeen];
          if (seen_->winner != winner) SetUp(winner);
        }
        Values(PositionOf(x, y), s);
      }
    }
  }

  // The draw that the triangle belongs to; `guess` is one nearby.
  std::size_t DrawOf(std::uint32_t ordinal, std::size_t guess) const {
    while (ordinal < job_.jobs[guess].first_ordinal) --guess;
    while (guess + 1 < job_.jobs.size() && ordinal >= job_.jobs[guess + 1].first_ordinal) ++guess;
    return guess;
  }

  std::size_t SampleIndex(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(target_.samples) +
           job_.sample_number;
  }
  bool IsUntouched(int x, int y) const { return canvas_.untouched[canvas_.tile_of(x, y)] != 0; }
  // Nothing is seen in a row of a block.
  bool IsEmptyRow(int x, int y) const {
    std::uint64_t winners[4];
    std::memcpy(winners, canvas_.winner + canvas_.offset_of(x, y), 16);
    std::memcpy(winners + 2, canvas_.winner + canvas_.offset_of(x + 4, y), 16);
    return (winners[0] & winners[1] & winners[2] & winners[3]) == ~std::uint64_t{0};
  }

  void Clear(std::size_t s) const {
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::uint32_t c = 0; c < outputs_[k].components; ++c) outputs_[k].values[s * outputs_[k].components + c] = 0;
    }
  }
  void ClearRow(int x0, int y) const {
    const int x1 = std::min(x0 + 8, target_.width);
    if (target_.samples > 1) {
      for (int x = x0; x < x1; ++x) Clear(SampleIndex(x, y));
      return;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      const std::size_t components = outputs_[k].components, n = static_cast<std::size_t>(x1 - x0) * components;
      std::fill_n(outputs_[k].values + SampleIndex(x0, y) * components, n, 0.0f);
    }
  }

  const Draw& draw() const { return *job_.jobs[draw_].draw; }
  std::size_t IndexOf(std::size_t i) const { return draw().indices[std::size_t{3} * position_ + i]; }
  float ValueOf(const Output& out, std::size_t vertex, std::uint32_t c) const {
    if (out.attribute == kBarycentrics) return vertex == c ? 1.0f : 0.0f;
    const AttributeArray& in = draw().attributes[out.attribute];
    return in.values[IndexOf(vertex) * (in.stride != 0 ? in.stride : in.components) + c];
  }

  // E_i = a x + b y + c has the error bound `unit` times (|a| x + |b| y + |c|); a numerator's coefficients add three
  // products and two sums, its evaluation two of each: below 16 units of 2^-53 of the sum of absolute terms in all.
  void SetUp(std::uint32_t winner) {
    seen_->winner = winner;
    constexpr double kUnit = 0x1p-49;
    const Vertex* v[3];
    for (std::size_t i = 0; i < 3; ++i) v[i] = &draw().vertices[IndexOf(i)];
    double a[3], b[3], c[3], size[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &j = *v[(i + 1) % 3], &k = *v[(i + 2) % 3];
      const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
      a[i] = jy * kw - jw * ky, b[i] = jw * kx - jx * kw, c[i] = jx * ky - jy * kx;
      size[i] = (std::fabs(a[i]) * target_.width + std::fabs(b[i]) * target_.height) + std::fabs(c[i]);
    }
    seen_->perspective = {(a[0] + a[1]) + a[2], (b[0] + b[1]) + b[2], (c[0] + c[1]) + c[2],
                          kUnit * ((size[0] + size[1]) + size[2])};
    const double ax = a[0] * v[0]->x, by = b[0] * v[0]->y, cw = c[0] * v[0]->w;
    seen_->affine = {0, 0, (ax + by) + cw, kUnit * ((std::fabs(ax) + std::fabs(by)) + std::fabs(cw))};
    for (std::size_t i = 0; i < 3; ++i) seen_->edge[i] = {a[i], b[i], c[i], kUnit * size[i]};
    for (std::size_t n = 0; n < count_; ++n) {
      const Output& out = outputs_[n];
      Planes& planes = seen_->planes[n];
      planes.interpolation =
          out.attribute == kBarycentrics ? Interpolation::perspective : draw().attributes[out.attribute].interpolation;
      alignas(32) double u[3][4] = {};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::uint32_t k = 0; k < out.components; ++k) u[i][k] = ValueOf(out, i, k);
      }
      if (planes.interpolation == Interpolation::flat) {
        std::memcpy(planes.c, u[0], sizeof planes.c);
        continue;
      }
      const D d;
      const bool noperspective = planes.interpolation == Interpolation::noperspective;
      for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
        auto pa = hn::Zero(d), pb = pa, pc = pa, error = pa;
        for (std::size_t i = 0; i < 3; ++i) {
          auto weight = hn::Load(d, u[i] + k);
          if (noperspective) weight = hn::Mul(weight, hn::Set(d, static_cast<double>(v[i]->w)));  // 48 bits, exact
          pa = hn::Add(pa, hn::Mul(weight, hn::Set(d, a[i])));
          pb = hn::Add(pb, hn::Mul(weight, hn::Set(d, b[i])));
          pc = hn::Add(pc, hn::Mul(weight, hn::Set(d, c[i])));
          error = hn::Add(error, hn::Mul(hn::Abs(weight), hn::Set(d, size[i])));
        }
        hn::Store(pa, d, planes.a + k);
        hn::Store(pb, d, planes.b + k);
        hn::Store(pc, d, planes.c + k);
        hn::Store(hn::Mul(error, hn::Set(d, kUnit)), d, planes.error + k);
      }
    }
  }

  // Where the attributes of pixel (x, y) are taken (M1).
  SamplePosition PositionOf(int x, int y) {
    const SamplePosition centre{x + 0.5, y + 0.5};
    if (target_.samples == 1) return centre;
    if (target_.attribute_location == AttributeLocation::centre && Exact().has_values(centre)) return centre;
    const TieShift shift = job_.jobs[draw_].shift;
    Statistics unused;
    if (Exact().covers(centre, shift, unused)) return centre;
    for (int n = 0; n < target_.samples; ++n) {
      const SampleLocation location = sample_location(target_.samples, n);
      const SamplePosition p{x + location.x / 16.0, y + location.y / 16.0};
      if (Exact().covers(p, shift, unused)) return p;
    }
    return centre;  // not reached: the triangle is seen at a sample of this pixel
  }

  // Grid: do all E_i surely have D's sign at p? Then none of them counts as 0 (G2).
  bool AllEdgesCount(SamplePosition p) const {
    const Denominator& det = seen_->affine;
    if (!(std::fabs(det.c) > det.error)) return false;
    const double sign = det.c < 0 ? -1 : 1;
    for (const Denominator& e : seen_->edge) {
      if (!(sign * ((e.a * p.x + e.b * p.y) + e.c) > e.error)) return false;
    }
    return true;
  }

  HWY_INLINE void Values(SamplePosition p, std::size_t s) {
    const D d;
    const F df;
    const bool exactly = draw().grid && !AllEdgesCount(p);
    for (std::size_t n = 0; n < count_; ++n) {
      const Output& out = outputs_[n];
      const Planes& planes = seen_->planes[n];
      float* const values = out.values + s * out.components;
      if (planes.interpolation == Interpolation::flat) {
        for (std::uint32_t c = 0; c < out.components; ++c) values[c] = static_cast<float>(planes.c[c]) + 0.0f;
        continue;
      }
      if (HWY_UNLIKELY(exactly)) {
        for (std::uint32_t c = 0; c < out.components; ++c) {
          const float u[3] = {ValueOf(out, 0, c), ValueOf(out, 1, c), ValueOf(out, 2, c)};
          values[c] = Exact().attribute(p, u, planes.interpolation, statistics_);
        }
        continue;
      }
      const Denominator& m = planes.interpolation == Interpolation::perspective ? seen_->perspective : seen_->affine;
      const double below = (m.a * p.x + m.b * p.y) + m.c, inverse = 1 / below;
      // Where the denominator is known to 10 bits, 1.002 / |below| is more than the inverse of the real one. Else no
      // number is known: the comparison below fails for NaN.
      const double known =
          std::fabs(below) * 0x1p-10 > m.error ? std::fabs(inverse) * 1.002 : std::numeric_limits<double>::quiet_NaN();
      alignas(16) float nearest[4];
      std::uint32_t unknown = 0;
      for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
        const auto above = hn::Add(hn::Add(hn::Mul(hn::Load(d, planes.a + k), hn::Set(d, p.x)),
                                           hn::Mul(hn::Load(d, planes.b + k), hn::Set(d, p.y))),
                                   hn::Load(d, planes.c + k));
        const auto q = hn::Mul(above, hn::Set(d, inverse)), size = hn::Abs(q);
        const auto numerators = hn::Add(hn::Load(d, planes.error + k), hn::Mul(size, hn::Set(d, m.error)));
        const auto error = hn::Add(hn::Mul(numerators, hn::Set(d, known)), hn::Mul(size, hn::Set(d, 0x1p-51)));
        const auto most = hn::Set(d, kLargestFloat), least = hn::Set(d, -kLargestFloat);
        const auto low = hn::DemoteTo(df, hn::Max(hn::Min(hn::Sub(q, error), most), least));
        const auto high = hn::DemoteTo(df, hn::Max(hn::Min(hn::Add(q, error), most), least));
        // In an interval with a NaN both ends may have become the same limit.
        const auto told = hn::And(hn::Eq(low, high), hn::Lt(hn::Abs(low), hn::Set(df, kLargestFloatAsFloat)));
        hn::Store(hn::Add(low, hn::Zero(df)), df, nearest + k);
        unknown |= (~Bits(df, told) & ((1u << hn::Lanes(df)) - 1)) << k;
      }
      unknown &= (1u << out.components) - 1;
      statistics_.values_by_filter += out.components - static_cast<std::uint32_t>(__builtin_popcount(unknown));
      CopyComponents(nearest, out.components, values);
      for (; HWY_UNLIKELY(unknown != 0); unknown &= unknown - 1) {
        const auto c = static_cast<std::uint32_t>(__builtin_ctz(unknown));
        const float u[3] = {ValueOf(out, 0, c), ValueOf(out, 1, c), ValueOf(out, 2, c)};
        values[c] = Exact().attribute(p, u, planes.interpolation, statistics_);
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

  // The triangle at hand.
  ExactDraw& Exact() {
    exact_.use(draw(), position_);
    return exact_;
  }

  const ShadeJob& job_;
  const Target& target_;
  const Canvas canvas_;
  Statistics& statistics_;
  Output outputs_[kMaxAttributes + 1];
  std::size_t count_ = 0;

  // Triangles that were set up lately, by the low bits of their ordinals; and the one at hand.
  struct Seen {
    std::uint32_t winner = kNoTriangle;
    Denominator perspective{}, affine{};  // the sum of the E_i, and D
    Denominator edge[3]{};                // E_i
    Planes planes[kMaxAttributes + 1];
  };
  static constexpr std::uint32_t kSeen = 32;
  Seen seen_triangles_[kSeen];
  Seen* seen_ = nullptr;
  std::uint32_t winner_ = kNoTriangle, position_ = 0;
  std::size_t draw_ = 0;
  ExactDraw exact_;
};

void Shade(const ShadeJob& job, const Canvas& canvas, int y0, int y1, Statistics& statistics) {
  Shader(job, canvas, statistics).Run(y0, y1);
}

}  // namespace surefill::fast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SUREFILL_SRC_SHADE_INL_HPP
