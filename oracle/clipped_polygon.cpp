// SPDX-License-Identifier: Apache-2.0
#include "oracle/clipped_polygon.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace surefill::oracle::clipped {

namespace {

constexpr std::uint32_t kLargestFinite = 0x7F7FFFFFu;

// The value of the nonnegative finite float with these bits: bits of larger floats are larger integers.
Rational value_of(std::uint32_t bits) {
  const std::uint32_t exponent = bits >> 23;
  const std::uint32_t fraction = bits & 0x7FFFFFu;
  Rational value(exponent == 0 ? fraction : fraction + 0x800000u);
  const int power = static_cast<int>(std::max(exponent, 1u)) - 150;  // of the last bit; 2^-149 for subnormals
  if (power >= 0) {
    mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(power));
  } else {
    mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-power));
  }
  return value;
}

// A float near a positive value; nothing relies on how near.
std::uint32_t guess_bits(const Rational& value) {
  const double near = value.get_d();
  if (!(near >= std::numeric_limits<float>::min())) return static_cast<std::uint32_t>(near * 0x1p149);
  if (near >= 0x1p128) return kLargestFinite;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(near);
  return static_cast<std::uint32_t>((bits >> 29) - (std::uint64_t{1023 - 127} << 23));
}

// a X + b Y + c W of a corner; inside is >= 0.
struct HalfSpace {
  int a, b;
  Rational c;
};

std::vector<Corner> clip(const std::vector<Corner>& polygon, const HalfSpace& side) {
  std::vector<Rational> heights;
  for (const Corner& corner : polygon) {
    heights.emplace_back(side.a * corner.x + side.b * corner.y + side.c * corner.w);
  }
  std::vector<Corner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    if (sgn(heights[i]) >= 0) kept.push_back(polygon[i]);
    if (sgn(heights[i]) * sgn(heights[j]) < 0) {
      // A positive multiple of the cut point; the weights are the distances, so the order of the ends has no part in
      // it.
      const Rational g = abs(heights[j]);
      const Rational h = abs(heights[i]);
      const Corner& p = polygon[i];
      const Corner& q = polygon[j];
      kept.push_back({g * p.x + h * q.x, g * p.y + h * q.y, g * p.z + h * q.z, g * p.w + h * q.w});
    }
  }
  return kept;
}

int to_int(const Rational& integer) {
  return static_cast<int>(integer.get_num().get_si());
}

}  // namespace

Rational exact(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const Rational magnitude = value_of(bits & 0x7FFFFFFFu);
  return bits >> 31 ? Rational(-magnitude) : magnitude;
}

float nearest_float(const Rational& value) {
  const Rational magnitude = abs(value);
  std::uint32_t bits = kLargestFinite;
  if (magnitude < value_of(kLargestFinite)) {
    bits = std::min(guess_bits(magnitude), kLargestFinite - 1);
    while (value_of(bits) > magnitude) --bits;
    while (value_of(bits + 1) <= magnitude) ++bits;
    // value_of(bits) <= magnitude < value_of(bits + 1), both finite.
    const int half = cmp(2 * magnitude, value_of(bits) + value_of(bits + 1));
    if (half > 0 || (half == 0 && bits % 2 == 1)) ++bits;
  }
  if (bits != 0 && sgn(value) < 0) bits |= 0x80000000u;
  return std::bit_cast<float>(bits);
}

Rational floor(const Rational& value) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  return result;
}

Rational ceil(const Rational& value) {
  return -floor(-value);
}

Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.w - b.w};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

Rational dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.w * b.w;
}

std::vector<Corner> clip_to_box(std::vector<Corner> polygon, const Rational& x0, const Rational& x1, const Rational& y0,
                                const Rational& y1) {
  polygon = clip(polygon, {1, 0, -x0});
  polygon = clip(polygon, {-1, 0, x1});
  polygon = clip(polygon, {0, 1, -y0});
  return clip(polygon, {0, -1, y1});
}

bool contains_eye(const std::array<Vector, 3>& m) {
  const Vector normal = cross(m[1] - m[0], m[2] - m[0]);
  if (sgn(dot(normal, m[0])) != 0) return false;  // the plane does not even pass through the eye
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& a = m[i];
    const Vector& b = m[(i + 1) % 3];
    const Vector area = cross(a, b);
    const bool aligned = sgn(area.x) == 0 && sgn(area.y) == 0 && sgn(area.w) == 0;
    if (aligned && sgn(dot(a, b)) <= 0) return true;  // on the closed side
    inside = inside && sgn(dot(area, normal)) > 0;
  }
  return inside;
}

std::optional<std::pair<Rational, Rational>> x_extent(std::span<const Point> polygon, const Rational& y0,
                                                      const Rational& y1) {
  std::optional<std::pair<Rational, Rational>> extent;
  const auto extend = [&extent](const Rational& x) {
    if (!extent) extent.emplace(x, x);
    if (x < extent->first) extent->first = x;
    if (x > extent->second) extent->second = x;
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    if (y0 <= p.y && p.y <= y1) extend(p.x);
    for (const Rational* y : {&y0, &y1}) {
      if ((p.y < *y && *y < q.y) || (q.y < *y && *y < p.y)) extend(p.x + (*y - p.y) * (q.x - p.x) / (q.y - p.y));
    }
  }
  return extent;
}

Rational snap(const Rational& position, int bits, int offset, GridRounding rounding) {
  const Rational scale(1 << bits);
  const Rational origin = Rational(offset) / 16 / scale;
  const Rational x = (position - origin) * scale;
  Rational k;
  switch (rounding) {
    case GridRounding::truncate:
      k = sgn(x) < 0 ? ceil(x) : floor(x);
      break;
    case GridRounding::nearest_up:
      k = floor(x + Rational(1, 2));
      break;
    case GridRounding::nearest_even: {
      const Rational up = floor(x + Rational(1, 2));
      const bool tie = up - x == Rational(1, 2);
      k = tie && mpz_odd_p(up.get_num_mpz_t()) ? Rational(up - 1) : up;
      break;
    }
  }
  return origin + k / scale;
}

Shift shift_of(FillRule rule) {
  switch (rule) {
    case FillRule::top_left:
      return {1, 1, true};
    case FillRule::top_right:
      return {-1, 1, true};
    case FillRule::bottom_left:
      return {1, -1, true};
    case FillRule::bottom_right:
      return {-1, -1, true};
    case FillRule::southwards:
      return {1, 1, false};
    case FillRule::southwards_west:
      return {-1, 1, false};
    case FillRule::northwards:
      return {1, -1, false};
    case FillRule::northwards_west:
      return {-1, -1, false};
    case FillRule::closed:
    case FillRule::open:
      break;
  }
  return {1, 1, true};
}

Outline::Outline(std::span<const Point> corners, const Shift& shift)
    : along_shift_(shift.x_dominates ? shift.x : shift.y),
      across_shift_(shift.x_dominates ? shift.y : shift.x),
      sign_(shift.x_dominates ? 1 : -1) {
  for (const Point& corner : corners) {
    if (shift.x_dominates) {
      corners_.push_back({corner.x, corner.y});
    } else {
      corners_.push_back({corner.y, corner.x});
    }
  }
}

std::pair<int, int> Outline::lines(int count) const {
  if (corners_.empty()) return {0, 0};
  const auto lower = [](const Place& a, const Place& b) { return a.across < b.across; };
  const auto [low, high] = std::minmax_element(corners_.begin(), corners_.end(), lower);
  const int begin = std::clamp(to_int(floor(low->across)), 0, count);
  return {begin, std::clamp(to_int(floor(high->across)) + 1, begin, count)};
}

std::vector<Crossing> Outline::crossings(int line, int across, int along, int length) const {
  const Rational height = line + Rational(across) / 16;
  std::vector<bool> below;  // is the corner on the side of smaller `across` of the perturbed line?
  for (const Place& corner : corners_) {
    const int order = cmp(corner.across, height);
    below.push_back(order < 0 || (order == 0 && across_shift_ > 0));
  }
  std::vector<Crossing> result;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::size_t j = (i + 1) % corners_.size();
    if (below[i] == below[j]) continue;
    const Place& p = corners_[i];
    const Place& q = corners_[j];
    Rational position = p.along + (height - p.across) * (q.along - p.along) / (q.across - p.across);
    position -= Rational(along) / 16;  // the pixel whose sample is there
    const Rational first = along_shift_ > 0 ? ceil(position) : Rational(floor(position) + 1);
    // Around a polygon that turns from +x to +y (D > 0), an edge passed in the direction +x enters it if it runs to -y.
    result.push_back({std::clamp(to_int(first), 0, length), below[i] ? -sign_ : sign_});
  }
  return result;
}

std::vector<Crossing> chord_crossings(std::span<const Point> polygon, bool closed, int orientation, int line,
                                      int across, int along, int length) {
  const Rational height = line + Rational(across) / 16;
  if (!closed) {  // a line along the lower or the upper end meets no interior
    const auto lower = [](const Point& a, const Point& b) { return a.y < b.y; };
    const auto [low, high] = std::minmax_element(polygon.begin(), polygon.end(), lower);
    if (height <= low->y || high->y <= height) return {};
  }
  const auto chord = x_extent(polygon, height, height);
  if (!chord) return {};
  const Rational left = chord->first - Rational(along) / 16, right = chord->second - Rational(along) / 16;
  const Rational first = closed ? ceil(left) : Rational(floor(left) + 1);
  const Rational past = closed ? Rational(floor(right) + 1) : ceil(right);
  if (past <= first) return {};
  return {{std::clamp(to_int(first), 0, length), orientation}, {std::clamp(to_int(past), 0, length), -orientation}};
}

int winding(std::span<const Crossing> crossings, int pixel) {
  int number = 0;
  for (const Crossing& crossing : crossings) number += crossing.first <= pixel ? crossing.step : 0;
  return number;
}

}  // namespace surefill::oracle::clipped
