// SPDX-License-Identifier: Apache-2.0
#include "oracle/positions.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/exact.hpp"

namespace surefill::oracle {

Rational floor_of(const Rational& value) {
  Integer result = value.get_num() / value.get_den();  // towards 0
  if (value < 0 && value.get_den() != 1) result -= 1;
  return Rational(result);
}

namespace {

// R5's integer k.
Rational rounded(const Rational& value, Rounding rounding) {
  const Rational below = floor_of(value), part = value - below, half(1, 2);
  switch (rounding) {
    case Rounding::floor:
      return below;
    case Rounding::ceiling:
      return part == 0 ? below : below + 1;
    case Rounding::truncate:
      return value >= 0 || part == 0 ? below : below + 1;
    default:
      break;
  }
  if (part != half) return part < half ? below : below + 1;
  const bool even = Integer(below.get_num() % 2) == 0;
  const bool down = rounding == Rounding::nearest_down || (rounding == Rounding::nearest_even && even) ||
                    (rounding == Rounding::nearest_away && value < 0);
  return down ? below : below + 1;
}

Rational snapped(const Rational& position, const AxisModel& axis) {
  if (axis.bits < 0) return position;
  const Rational offset(axis.grid_offset), step(std::ldexp(1.0, -axis.bits));
  return offset + rounded((position - offset) / step, axis.rounding) * step;
}

// a + b, if that is a double (Knuth's TwoSum).
bool add_exactly(double a, double b, double& sum) {
  sum = a + b;
  const double t = sum - a;
  return (a - (sum - t)) + (b - t) == 0;
}

// The same as `snapped` in double, if nothing is rounded on the way.
bool snapped_exactly(double position, const AxisModel& axis, double& result) {
  result = position;
  if (axis.bits < 0) return true;
  double scaled = 0;
  if (!add_exactly(position, -axis.grid_offset, scaled)) return false;
  scaled = std::ldexp(scaled, axis.bits);
  if (scaled != 0 && std::abs(scaled) < 0x1p-900) return false;
  const double below = std::floor(scaled);
  double part = 0;
  if (!add_exactly(scaled, -below, part)) return false;
  double k = part == 0 ? below : below + 1;
  switch (axis.rounding) {
    case Rounding::floor:
      k = below;
      break;
    case Rounding::ceiling:
      break;
    case Rounding::truncate:
      if (scaled >= 0) k = below;
      break;
    default: {
      const bool down = axis.rounding == Rounding::nearest_down ||
                        (axis.rounding == Rounding::nearest_even && std::fmod(below, 2) == 0) ||
                        (axis.rounding == Rounding::nearest_away && scaled < 0);
      if (part < 0.5 || (part == 0.5 && down)) k = below;
    }
  }
  return add_exactly(axis.grid_offset, std::ldexp(k, -axis.bits), result);
}

// R5's integer k of a number known to within `error`, if that is one and the same for all of these.
bool surely_rounded(double value, double error, Rounding rounding, double& k) {
  const bool nearest = rounding <= Rounding::nearest_away;
  const double below = std::floor(nearest ? value + 0.5 : value), part = (nearest ? value + 0.5 : value) - below;
  if (!(part > error && part < 1 - error)) return false;
  const bool up = rounding == Rounding::ceiling || (rounding == Rounding::truncate && value < 0);
  k = up ? below + 1 : below;
  return true;
}

// The same as the rational numbers below, where a grid leaves no doubt in double.
bool placed_surely(const AxisModel& axis, int length, float numerator, float w, double blur, Interval& result) {
  if (axis.bits < 0) return false;
  const double q = static_cast<double>(numerator) / w * ((length - axis.lacks) / length) + axis.moved;
  const double size = std::abs(q) + std::abs(axis.moved) + std::abs(axis.grid_offset) + blur + 1;
  const double error = std::ldexp(0x1p-48 * size, axis.bits);  // 2^5 roundings
  if (!(size < kFarthest / 2) || !(error < 0x1p-8)) return false;
  double low = 0, high = 0;
  if (!surely_rounded(std::ldexp(q - blur - axis.grid_offset, axis.bits), error, axis.rounding, low) ||
      !surely_rounded(std::ldexp(q + blur - axis.grid_offset, axis.bits), error, axis.rounding, high) ||
      !add_exactly(axis.grid_offset, std::ldexp(low, -axis.bits), result.near_low) ||
      !add_exactly(axis.grid_offset, std::ldexp(high, -axis.bits), result.near_high)) {
    return false;
  }
  result.exact = true;
  result.point = low == high;
  return true;
}

}  // namespace

bool cut_by_depth(const Model& model, const Vertex& vertex) {
  if (!model.clipped) return false;
  constexpr double kRoundings = 64 * 0x1p-24;
  const double z = vertex.z, w = vertex.w;
  const auto inside = [&](double limit, double sign) {
    if (!std::isfinite(limit)) return limit * sign < 0;
    return z == limit * w || sign * (z - limit * w) > kRoundings * std::max(std::abs(z), std::abs(limit * w));
  };
  return !inside((*model.clipped)[0], 1) || !inside((*model.clipped)[1], -1);
}

bool place_vertex(const AxisModel& axis, int length, float numerator, float w, Interval& result, double more) {
  int exponent = 0;
  const bool divided = std::frexp(w, &exponent) != 0.5f;
  const double blur = (divided ? std::max(axis.blur, axis.divided_blur) : axis.blur) + more;
  if (!divided && axis.lacks == 0) {
    double q = 0, low = 0, high = 0;
    if (add_exactly(static_cast<double>(numerator) / w, axis.moved, q) && add_exactly(q, -blur, low) &&
        add_exactly(q, blur, high) && snapped_exactly(low, axis, result.near_low) &&
        snapped_exactly(high, axis, result.near_high)) {
      result.exact = true;
      result.point = result.near_low == result.near_high;
      return std::abs(q) <= kFarthest;
    }
  }
  if (placed_surely(axis, length, numerator, w, blur, result)) return true;
  Rational q(numerator);
  q /= Rational(w);
  if (axis.lacks != 0) q *= (length - Rational(axis.lacks)) / length;
  if (axis.moved != 0) q += Rational(axis.moved);
  if (abs(q) > kFarthest) return false;
  result.exact = false;
  result.low = snapped(q - Rational(blur), axis);
  result.high = blur == 0 ? result.low : snapped(q + Rational(blur), axis);
  result.near_low = result.low.get_d();
  result.near_high = result.high.get_d();
  result.point = result.low == result.high;
  return true;
}

}  // namespace surefill::oracle
