// SPDX-License-Identifier: Apache-2.0
#include "properties/generators/near_zero.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

namespace surefill::properties {
namespace {

// Components stay below 2^24, products of two below 2^49, the unreduced solutions below 2^100.
using Integer = __int128;
using IntegerVector = std::array<Integer, 3>;

IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

long double dot(const IntegerVector& a, const IntegerVector& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += static_cast<long double>(a[i]) * static_cast<long double>(b[i]);
  return sum;
}

// a - q b, with q rounded to an integer: always in the lattice of a, b, however coarse q is.
IntegerVector minus_multiple(IntegerVector a, long double q, const IntegerVector& b) {
  const auto k = static_cast<Integer>(std::llroundl(std::clamp(q, -9e18L, 9e18L)));
  for (std::size_t i = 0; i < 3; ++i) a[i] -= k * b[i];
  return a;
}

struct Bezout {
  Integer gcd, x, y;  // gcd = a x + b y, and not negative
};

Bezout extended_gcd(Integer a, Integer b) {
  if (b == 0) return {a < 0 ? -a : a, a < 0 ? -1 : 1, 0};
  const Bezout rest = extended_gcd(b, a % b);
  return {rest.gcd, rest.y, rest.x - (a / b) * rest.y};
}

// A vector v with n . v = t, made as short as the lattice allows and then moved by about `reach` at random within the
// plane of solutions. None if gcd(n) does not divide t.
std::optional<IntegerVector> solve(const IntegerVector& n, Integer t, double reach, Random& random) {
  const Bezout first = extended_gcd(n[0], n[1]);
  if (first.gcd == 0 || n[2] == 0) return std::nullopt;
  const Bezout all = extended_gcd(first.gcd, n[2]);
  if (t % all.gcd != 0) return std::nullopt;

  // Two generators of {k : n . k = 0} and one solution.
  IntegerVector k1 = {n[1] / first.gcd, -n[0] / first.gcd, 0};
  const Integer f = n[2] / all.gcd;
  IntegerVector k2 = {-first.x * f, -first.y * f, first.gcd / all.gcd};
  const Integer q = t / all.gcd;
  IntegerVector v = {first.x * all.x * q, first.y * all.x * q, all.y * q};

  // Lagrange's reduction of the basis, then Babai's of the solution.
  for (int step = 0; step < 200; ++step) {
    if (dot(k1, k1) > dot(k2, k2)) std::swap(k1, k2);
    const long double ratio = dot(k1, k2) / dot(k1, k1);
    if (std::abs(ratio) <= 0.5000001L) break;
    k2 = minus_multiple(k2, ratio, k1);
  }
  for (int step = 0; step < 12; ++step) {
    v = minus_multiple(v, dot(v, k2) / dot(k2, k2), k2);
    v = minus_multiple(v, dot(v, k1) / dot(k1, k1), k1);
  }
  for (const IntegerVector& k : {k1, k2})
    v = minus_multiple(v, (2 * random.unit() - 1) * reach / std::sqrt(static_cast<double>(dot(k, k))), k);
  return v;
}

// float32 holds every component exactly.
bool fits(const IntegerVector& v) {
  return std::all_of(v.begin(), v.end(), [](Integer c) { return c < (1 << 24) && c > -(1 << 24); });
}

// v 2^exponent, and all components but `axis` 2^lift more.
Vertex to_vertex(const IntegerVector& v, int exponent, std::size_t axis = 0, int lift = 0) {
  const auto component = [&](std::size_t i) {
    return std::ldexp(static_cast<float>(static_cast<int>(v[i])), exponent + (i == axis ? 0 : lift));
  };
  return {component(0), component(1), 0, component(2)};
}

Integer signed_bits(Random& random, int bits) {
  return random.between(-(1 << bits), (1 << bits) - 1);
}

// Twice a sample as a homogeneous integer vector (2 px, 2 py, 2).
IntegerVector doubled_sample(Random& random, int width, int height) {
  return {2 * random.between(0, width - 1) + 1, 2 * random.between(0, height - 1) + 1, 2};
}

// Between 2^low and 2^(high + 1).
double magnitude(Random& random, int low, int high) {
  const int exponent = random.between(low, high);
  return std::ldexp(1 + random.unit(), exponent);
}

}  // namespace

std::array<Vertex, 3> nearly_tied_triangle(Random& random, int width, int height) {
  for (;;) {
    const IntegerVector p = doubled_sample(random, width, height);
    const IntegerVector a = {signed_bits(random, 23), signed_bits(random, 23),
                             signed_bits(random, random.between(1, 23))};
    // Two axes of b are lifted by a power of two: the coefficients of E then need more bits than double has, also where
    // p is small. Solutions of 24 bits want n below 2^48.
    const std::size_t axis = random.below(3);
    int room = 17;
    for (int size = std::max(width, height); size > 1; size /= 2) --room;
    const int lift = random.one_in(4) ? 0 : random.between(0, room);
    IntegerVector n = cross(p, a);
    for (std::size_t i = 0; i < 3; ++i)
      if (i != axis) n[i] *= Integer{1} << lift;
    const Integer t = random.between(-4, 4);
    const double reach = magnitude(random, 20, 22);
    const auto b = solve(n, t, reach, random);  // det(a, b, p) = t
    if (!b || !fits(*b)) continue;
    const int exponent = random.between(-60, 60);
    // The third vertex anywhere around, so that the sample is often between the three.
    const int sign = random.one_in(2) ? 1 : -1;
    const double w = sign * (0.1 + 1.9 * random.unit());
    const double x = static_cast<double>(p[0]) / 2 + 400 * random.unit() - 200;
    const double y = static_cast<double>(p[1]) / 2 + 400 * random.unit() - 200;
    return {to_vertex(a, exponent + random.between(-20, 20)),
            to_vertex(*b, exponent + random.between(-20, 20), axis, lift),
            Vertex{static_cast<float>(x * w), static_cast<float>(y * w), 0, static_cast<float>(w)}};
  }
}

std::array<Vertex, 3> nearly_degenerate_triangle(Random& random) {
  for (;;) {
    IntegerVector a, b;
    for (Integer& c : a) c = signed_bits(random, 22);
    for (Integer& c : b) c = signed_bits(random, 22);
    const Integer d = random.between(-3, 3);
    const double reach = magnitude(random, 15, 22);
    const auto c = solve(cross(a, b), d, reach, random);
    if (!c || !fits(*c)) continue;
    const int exponent = random.between(-40, 40);
    return {to_vertex(a, exponent), to_vertex(b, exponent), to_vertex(*c, exponent)};
  }
}

std::array<Vertex, 3> nearly_degenerate_tied_triangle(Random& random, int width, int height) {
  for (;;) {
    const IntegerVector p = doubled_sample(random, width, height);
    const int bits = random.between(8, 22);
    const IntegerVector a = {signed_bits(random, bits), signed_bits(random, bits),
                             signed_bits(random, random.between(1, bits))};
    const Integer m = Integer{1} << random.between(0, 8);
    const IntegerVector b = {m * p[0] - a[0], m * p[1] - a[1], m * p[2] - a[2]};  // p lies between a and b
    const IntegerVector n = cross(a, b);
    const Integer g = extended_gcd(extended_gcd(n[0], n[1]).gcd, n[2]).gcd;
    if (g == 0) continue;
    const Integer d = g * random.between(-2, 2);
    const double reach = magnitude(random, 15, 22);
    const auto c = solve(n, d, reach, random);
    if (!c || !fits(a) || !fits(b) || !fits(*c)) continue;
    const int exponent = random.between(-40, 40);
    const auto spread = [&] { return exponent + random.between(-20, 20); };
    const int ea = spread(), eb = spread(), ec = spread();
    return {to_vertex(a, ea), to_vertex(b, eb), to_vertex(*c, ec)};
  }
}

// The edge leads from b, which is snapped to a grid position, past a sample to a, which is found by the determinant of
// a, b and c: c lies on the border of the guard band, in the middle of the two grid positions between whose lines to
// the snapped b the sample lies. Positions are integers in sixteenths of a step of the grid.
std::array<Vertex, 3> nearly_halfway_cut_triangle(Random& random, Grid& grid, int width, int height) {
  constexpr int kTries = 128;
  constexpr std::int64_t kBand = kMaxTargetSize + 1;
  grid.bits = random.between(1, 4);
  if (grid.rounding == GridRounding::truncate) grid.rounding = GridRounding::nearest_up;
  const bool swap_axes = random.one_in(2);
  if (swap_axes) std::swap(width, height);
  const int offset_x = swap_axes ? grid.offset_y : grid.offset_x, offset_y = swap_axes ? grid.offset_x : grid.offset_y;
  const std::int64_t pixel = std::int64_t{16} << grid.bits;
  for (int tries = 0; tries < kTries; ++tries) {
    const std::int64_t sample_x = (2 * random.between(0, width - 1) + 1) * pixel / 2;
    const std::int64_t sample_y = (2 * random.between(0, height - 1) + 1) * pixel / 2;
    const int reach = 1 << grid.bits;
    const std::int64_t b_x = offset_x - 16 * random.between(2 * reach, 8 * reach);
    const std::int64_t b_y = offset_y + 16 * random.between(-12 * reach, 12 * reach);
    // Where the line through both meets the border, and the middle there.
    const double slope = static_cast<double>(sample_y - b_y) / static_cast<double>(sample_x - b_x);
    const double y = static_cast<double>(b_y) + slope * static_cast<double>(kBand * pixel - b_x);
    if (std::fabs(y) > 0.9 * static_cast<double>(kBand * pixel)) continue;
    const std::int64_t middle = 16 * std::llrint(std::floor((y - offset_y) / 16)) + 8 + offset_y;

    const IntegerVector c = {kBand * pixel, middle, pixel};
    const Integer b_w = random.between(1 << 19, 1 << 20);
    const IntegerVector b = {b_w * b_x / pixel, b_w * b_y / pixel, b_w};
    const auto solution = solve(cross(c, b), random.between(1, 8), magnitude(random, 22, 23), random);
    if (!solution || !fits(*solution) || !fits(b)) continue;
    IntegerVector a = *solution;
    const auto beyond = [&](const IntegerVector& v) { return v[0] - kBand * v[2]; };
    if (beyond(a) < 0) a = {-a[0], -a[1], -a[2]};
    const auto at_border = [&](std::size_t i) { return b[i] * beyond(a) - a[i] * beyond(b); };
    const Integer cut_w = at_border(2), rest = at_border(1) * pixel - middle * cut_w;
    if (cut_w <= 0) continue;
    const double quotient = static_cast<double>(at_border(1)) / static_cast<double>(cut_w) * static_cast<double>(pixel);
    const auto expected = static_cast<double>(middle);
    if (rest == 0 || quotient == expected || (quotient > expected) == (rest > 0)) continue;

    std::array<Vertex, 3> t = {to_vertex(a, random.between(-30, 0)),
                               to_vertex(b, random.between(-30, 0)),
                               {static_cast<float>(width * random.unit()), 0, 0, 1}};
    t[2].y = static_cast<float>(height * random.unit()) + (random.one_in(2) ? 60.0f : -60.0f);
    if (swap_axes) {
      for (Vertex& v : t) std::swap(v.x, v.y);
    }
    return t;
  }
  return nearly_tied_triangle(random, width, height);
}

}  // namespace surefill::properties
