// SPDX-License-Identifier: Apache-2.0
//
// What the engine's filters promise each other: that exact flags are true and error bounds hold, for any input, and
// that bounds are not so wide that the filters decide nothing. Checked in rational arithmetic, apart from any image,
// since rungs further down hide most breaches.
#ifndef SUREFILL_PROPERTIES_INTERNAL_BOUNDS_HPP
#define SUREFILL_PROPERTIES_INTERNAL_BOUNDS_HPP

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "exact/bounds.hpp"
#include "exact/grid.hpp"
#include "exact/triangle.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::properties {

class InternalBounds {
 public:
  explicit InternalBounds(std::uint64_t number) : random_(number) {}

  // What does not hold in this case; empty if all does.
  std::string broken() {
    edge({component(), component(), 0, component()}, {component(), component(), 0, component()}, sample());
    rounded_tie();
    product();
    difference();
    sum();
    fraction();
    box();
    plane();
    if (random_.one_in(8)) snapped();
    return broken_;
  }

 private:
  void expect(bool holds, const char* what) {
    if (!holds && broken_.empty()) broken_ = what;
  }

  float power(int low, int high) {
    const float value = std::ldexp(1.0f, random_.between(low, high));
    return random_.one_in(2) ? -value : value;
  }

  // Simple numbers, so that sums cancel, next to tiny ones, so that they round; or any mantissa.
  float component() {
    switch (random_.below(5)) {
      case 0:
        return 0;
      case 1:
        return static_cast<float>(random_.between(-3, 3));
      case 2:
        return power(-60, -20);
      case 3:
        return power(-2, 50);
      default:
        return static_cast<float>(2 * random_.unit() - 1) * power(-4, 30);
    }
  }

  SamplePosition sample() {
    const int size = random_.one_in(2) ? 4 : kMaxTargetSize;
    const double x = random_.between(0, 16 * size), y = random_.between(0, 16 * size);
    return {x / 16, y / 16};
  }

  // Edges that miss the sample by so little that the terms of E, rounded, cancel to 0: with W_j = 0,
  // E = Y_j (x W_k - X_k) - X_j (y W_k - Y_k).
  void rounded_tie() {
    SamplePosition p{random_.between(4096, 16383) + random_.between(0, 15) / 16.0, 0.5};
    Vertex j{1, 1 + 0x1p-23f * static_cast<float>(random_.between(-4, 4)), 0, 0};
    Vertex k{0, 0, 0, 1 + 0x1p-19f * static_cast<float>(random_.below(1u << 19))};
    if (random_.one_in(2)) {
      // x W_k and y W_k less the same small number, and Y_j is nearly X_j: a x has too many bits.
      k.x = static_cast<float>(p.x * k.w);
      k.y = static_cast<float>(p.y * k.w - (p.x * k.w - k.x));
    } else {
      // The vertex lies on the sample's column, and on the first row; X_j is tiny: a x + b y has too many bits.
      p.x = random_.between(0, 31) + 0.5;
      k.x = static_cast<float>(p.x * k.w);
      j.x = power(-90, -30);
    }
    if (random_.one_in(2)) std::swap(p.x, p.y), std::swap(j.x, j.y), std::swap(k.x, k.y);
    random_.one_in(2) ? edge(j, k, p) : edge(k, j, p);
  }

  // Sums of products of whole numbers: rounding errors of 1 among them.
  void product() {
    Expansion<8> sum;
    mpq_class exact, terms;
    for (int i = 0; i < 3; ++i) {
      const double a = random_.between(1 << 25, 1 << 28), b = random_.between(-(1 << 28), 1 << 28);
      sum.add_product(a, b);
      exact += mpq_class(a) * b;
    }
    for (int i = 0; i < sum.size(); ++i) terms += sum.term(i);
    expect(terms == exact && sum.sign() == sgn(exact), "an expansion of products is exact");
  }

  void edge(const Vertex& j, const Vertex& k, SamplePosition p) {
    const EdgeFunction e(j, k);
    const std::array<mpq_class, 3> exact = {mpq_class(j.y) * k.w - mpq_class(j.w) * k.y,
                                            mpq_class(j.w) * k.x - mpq_class(j.x) * k.w,
                                            mpq_class(j.x) * k.y - mpq_class(j.y) * k.x};
    const std::array<double, 3> rounded = {e.a, e.b, e.c};
    bool all = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class error = abs(exact[i] - rounded[i]);
      expect(sgn(exact[i]) == sign_of(rounded[i]), "the sign of a coefficient is exact");
      expect(error * 0x1p53 <= abs(exact[i]), "a coefficient is rounded once");
      all = all && error == 0;
    }
    expect(e.exact == all, "`exact` says whether the coefficients are");
    const mpq_class true_value = exact[0] * p.x + exact[1] * p.y + exact[2];
    double bound = 0;
    const double value = e.value(p, &bound);
    const mpq_class size = abs(exact[0]) * p.x + abs(exact[1]) * p.y + abs(exact[2]);
    expect(abs(true_value - value) <= bound, "the error bound of an edge function holds");
    expect(bound <= size * 0x1p-49, "the error bound of an edge function is no wider than need be");
    mpq_class terms;
    const auto expansion = e.exact_value(p);
    for (int i = 0; i < expansion.size(); ++i) terms += expansion.term(i);
    expect(terms == true_value, "the expansion of an edge function is exact");
    expect(e.sign(p) == sgn(true_value), "the sign of an edge function is exact");
  }

  void difference() {
    const double p = component(), q = random_.one_in(2) ? component() : p + component();
    expect(difference_is_exact(p, q) == (mpq_class(p) - q == mpq_class(p - q)), "`difference_is_exact`");
  }

  // A number, and what it may stand for: all but an end of the interval, or within. (Bounds are rounded, too, so they
  // are wider than what they bound: the widest is half used in the engine.)
  Approximation approximation(mpq_class* stands_for) {
    const double value = component() * (1 + random_.unit());
    const double wide =
        random_.one_in(4) ? std::fabs(component()) : std::fabs(value) * std::ldexp(1.0, random_.between(-50, -1));
    const double error = random_.one_in(8) ? 0 : wide;
    *stands_for = mpq_class(value) + mpq_class(error) * (1 - 0x1p-50) * random_.between(-1, 1);
    return {value, error};
  }

  void sum() {
    double w[3];
    Approximation e[3];
    mpq_class exact, needed;
    for (std::size_t i = 0; i < 3; ++i) {
      mpq_class stands_for;
      w[i] = component() * (random_.one_in(2) ? 1.0 : static_cast<double>(component()));  // up to 48 bits
      e[i] = approximation(&stands_for);
      exact += w[i] * stands_for;
      needed += abs(mpq_class(w[i])) * (e[i].error + 0x1p-50 * abs(mpq_class(e[i].value)));
    }
    const Approximation result = weighted_sum(w, e);
    expect(abs(exact - result.value) <= result.error, "the error bound of a weighted sum holds");
    expect(result.error <= 2 * needed, "the error bound of a weighted sum is no wider than need be");
  }

  void fraction() {
    mpq_class above, below;
    const Approximation n = approximation(&above), m = approximation(&below);
    const Approximation result = quotient(n, m);
    if (!(std::fabs(m.value) > m.error)) {
      expect(std::isinf(result.error), "a quotient by what may be 0 tells nothing");
      return;
    }
    const mpq_class smallest = abs(mpq_class(m.value)) - m.error, q = mpq_class(n.value) / m.value;
    expect(below == 0 || abs(above / below - result.value) <= result.error, "the error bound of a quotient holds");
    // The bound may be infinite where `smallest` is but rounding error.
    if (smallest * 0x1p40 < abs(mpq_class(m.value))) return;
    expect(result.error <= 2 * ((n.error + abs(q) * m.error) / smallest + abs(q) * 0x1p-52),
           "the error bound of a quotient is no wider than need be");
  }

  // On small whole numbers, where no quotient is rounded, the box is the smallest there is, unless a vertex behind the
  // eye lies exactly in line with its border.
  void box() {
    const int size = 16;
    Vertex v[3];
    for (Vertex& vertex : v) {
      vertex = {static_cast<float>(random_.between(-20, 40)), static_cast<float>(random_.between(-20, 40)), 0,
                random_.one_in(4) ? static_cast<float>(random_.between(-2, 0)) : 1.0f};
    }
    const bool squares = random_.one_in(4);
    const double least = squares ? 0 : 0.5, largest = squares ? 1 : 0.5;
    const PixelBox actual = screen_box(v[0], v[1], v[2], {0, 0, size, size}, least, largest);
    if (!(v[0].w > 0 || v[1].w > 0 || v[2].w > 0)) {
      expect(actual.empty(), "the box of what lies behind the eye is empty");
      return;
    }
    const auto along = [&](float Vertex::*c, int first, int last) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vertex& vertex : v) {
        if (vertex.w > 0) low = std::min<double>(low, vertex.*c), high = std::max<double>(high, vertex.*c);
      }
      const double lowest = low, highest = high;
      for (const Vertex& vertex : v) {
        if (vertex.w > 0) continue;
        if (static_cast<double>(vertex.*c) == lowest * vertex.w || static_cast<double>(vertex.*c) == highest * vertex.w)
          return;
        if (vertex.*c < lowest * vertex.w) low = -std::numeric_limits<double>::infinity();
        if (vertex.*c > highest * vertex.w) high = std::numeric_limits<double>::infinity();
      }
      // A border on a sample's place stays in, and one ulp more may come in where a vertex lies behind.
      const auto inside = [](double number) { return static_cast<int>(std::clamp<double>(number, 0, size)); };
      const int begin = inside(std::ceil(low - largest)), end = std::max(begin, inside(std::floor(high - least) + 1));
      expect(first == begin && last == end, "the box is no larger than need be");
    };
    along(&Vertex::x, actual.x0, actual.x1);
    along(&Vertex::y, actual.y0, actual.y1);
  }

  // Triangles whose plane passes the eye beside a pixel's centre, by next to nothing.
  void plane() {
    const auto number = [&] {
      return random_.one_in(4) ? power(-90, -30) : static_cast<float>(random_.between(-3, 3));
    };
    const Vertex v[3] = {
        {number(), number(), 0, number()}, {number(), number(), 0, number()}, {number(), number(), 0, number()}};
    Triangle triangle;
    if (!triangle.set_up(v[0], v[1], v[2])) return;
    const SamplePosition p{random_.between(0, 3) + 0.5, random_.between(0, 3) + 0.5};
    mpq_class sum;
    for (int i = 0; i < 3; ++i) {
      const auto value = triangle.edge(i).exact_value(p);
      for (int n = 0; n < value.size(); ++n) sum += value.term(n);
    }
    expect(triangle.plane_in_front(p) == (sgn(sum) == triangle.determinant()), "on which side the plane lies is exact");
  }

  // A position in pixels on the grid (G1).
  static mpq_class on_grid(const mpq_class& position, int offset, const Grid& grid) {
    const mpq_class t = position * (1 << grid.bits) - mpq_class(offset) / 16;
    const mpq_class shifted = grid.rounding == GridRounding::truncate ? t : t + mpq_class(1, 2);
    mpz_class k;
    mpz_fdiv_q(k.get_mpz_t(), shifted.get_num_mpz_t(), shifted.get_den_mpz_t());
    if (grid.rounding == GridRounding::truncate && sgn(t) < 0 && k != t) ++k;
    if (grid.rounding == GridRounding::nearest_even && k == shifted && mpz_odd_p(k.get_mpz_t()) != 0) --k;
    return (k + mpq_class(offset) / 16) / (1 << grid.bits);
  }

  // Triangles that the guard band does not cut, or that lie behind the eye: their corners, their box, their depths.
  void snapped() {
    Grid grid{random_.between(0, 12), random_.between(0, 15), random_.between(0, 15),
              static_cast<GridRounding>(random_.below(3))};
    const bool behind = random_.one_in(4);
    Vertex v[3];
    for (Vertex& vertex : v) {
      const float w = random_.one_in(2) ? 1.0f : std::fabs(power(-20, 20)) * static_cast<float>(1 + random_.unit());
      const auto coordinate = [&] {
        const int size = random_.one_in(2) ? 20 : kMaxTargetSize - 1;
        return static_cast<float>(random_.between(-16 * size, 16 * size)) / 16 * w;
      };
      vertex = {coordinate(), coordinate(), component(), w};
    }
    if (random_.one_in(4)) {
      // X / W is so near to m 2^-16 that in double it is that.
      constexpr struct {
        float x, w;
        int m;  // modulo 16
      } kNear[] = {{16519106, 16519105, 1}, {10845878, 10845877, 3}, {8937216, 8937209, 9}, {11545612, 11545611, 13}};
      const auto& [x, w, m] = kNear[random_.below(4)];
      v[0].x = x * (random_.one_in(4) ? -0x1p14f : 0x1p14f), v[0].w = w, v[0].y = w * 3;
      grid.bits = 12, grid.offset_x = random_.one_in(2) ? m : (m + 8) % 16;
      if (v[0].x < 0) grid.offset_x = (16 - grid.offset_x) % 16;
    }
    if (behind)
      for (Vertex& vertex : v) vertex = {-vertex.x, -vertex.y, -vertex.z, -vertex.w};

    SnappedTriangle triangle;
    const int first = random_.between(0, 40), last = first + random_.between(1, 400);
    const PixelBox limits{first, first / 2, last, last + 1};
    if (random_.one_in(2)) triangle.set_up({0, 0, 0, 1}, {9999, 1, 0, 1}, {7, 9999, 0, 1}, grid);  // before
    if (!triangle.set_up(v[0], v[1], v[2], grid)) {
      expect(behind || v[0].w <= 0, "a hull in front of the eye does not hold it");
      return;
    }
    if (behind) {
      expect(triangle.corners() == 0, "what lies behind the eye has no corners");
      expect(triangle.box(limits, 0, 1).empty(), "the box of what lies behind the eye is empty");
      return;
    }
    expect(triangle.corners() == 3, "what the guard band does not cut has three corners");
    mpq_class low[2] = {1 << 20, 1 << 20}, high[2] = {-(1 << 20), -(1 << 20)};
    float least = std::numeric_limits<float>::max(), most = -least;
    for (int k = 0; k < 3; ++k) {
      const Vertex& vertex = v[k];
      const float at[2] = {vertex.x, vertex.y};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const int offset = axis == 0 ? grid.offset_x : grid.offset_y;
        const mpq_class position = on_grid(mpq_class(at[axis]) / vertex.w, offset, grid);
        const double corner = axis == 0 ? triangle.corner(k).x : triangle.corner(k).y;
        expect(corner == position, "corners are on the grid");
        expect(snapped_position(at[axis], vertex.w, offset, grid) == position, "positions are on the grid");
        low[axis] = std::min(low[axis], position), high[axis] = std::max(high[axis], position);
      }
      const float z = vertex.z / vertex.w;
      least = std::min(least, z), most = std::max(most, z);
    }
    const DepthRange& range = triangle.depth_range();
    const float largest = std::numeric_limits<float>::max();
    expect(range.low == std::clamp(least, -largest, largest) && range.high == std::clamp(most, -largest, largest),
           "the range of depth is that of the corners");
    const double offset = random_.below(16) / 16.0;
    PixelBox box = limits;
    const auto clip = [&](std::size_t axis, int* from, int* to) {
      const int begin = *from, end = *to;
      *from = end, *to = begin;
      for (int i = begin; i < end; ++i)
        if (low[axis] <= i + offset && i + offset <= high[axis]) *from = std::min(*from, i), *to = i + 1;
    };
    clip(0, &box.x0, &box.x1), clip(1, &box.y0, &box.y1);
    const PixelBox actual = triangle.box(limits, offset, offset);
    expect(actual.empty() == box.empty() && (box.empty() || (actual.x0 == box.x0 && actual.x1 == box.x1 &&
                                                             actual.y0 == box.y0 && actual.y1 == box.y1)),
           "the box is that of the corners");
  }

  Random random_;
  std::string broken_;
};

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_INTERNAL_BOUNDS_HPP
