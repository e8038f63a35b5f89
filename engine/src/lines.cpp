// SPDX-License-Identifier: Apache-2.0
#include "lines.hpp"

#include <algorithm>
#include <cmath>

#include "exact/edge.hpp"
#include "facts.hpp"

namespace surefill {
namespace {

// A line's minor coordinate as a function of its major one, in double: m(t) = slope t + start, off by less than error(t).
struct MinorCoordinate {
  double slope, start;

  explicit MinorCoordinate(const Line& line) {
    const EdgeFunction& e = line.edge();
    slope = line.x_major() ? -e.a / e.b : -e.b / e.a, start = line.x_major() ? -e.c / e.b : -e.c / e.a;
  }
  double at(double t) const { return slope * t + start; }
  // Five roundings of 2^-53 each, with room for those of what is compared.
  double error(double t) const { return 0x1p-49 * (std::fabs(slope * t) + std::fabs(start)); }
};

// The samples number n of one line, which is in use.
template <typename Sink>
void walk(const Line& line, const PixelBox& box, SamplePosition offset, TieShift shift, const Sink& sink) {
  const MinorCoordinate minor(line);
  const bool x_major = line.x_major();
  const int t0 = x_major ? box.x0 : box.y0, t1 = x_major ? box.x1 : box.y1;
  const int m0 = x_major ? box.y0 : box.x0, m1 = x_major ? box.y1 : box.x1;
  const double t_offset = x_major ? offset.x : offset.y, m_offset = x_major ? offset.y : offset.x;
  const double half = line.half_width();
  for (int t = t0; t < t1; ++t) {
    const double along = t + t_offset, centre = minor.at(along);
    const SamplePosition column{along, along};  // as far as its major coordinate goes
    const bool within = line.within_ends(column, shift), clear = !line.thin() || line.far_from_ends(column);
    if (!within && clear) continue;
    const double error = minor.error(along) + 0x1p-49 * half;
    const double reach = half + error;
    const auto pixel = [&](double m) { return static_cast<int>(std::clamp<double>(m, m0, m1)); };
    const int last = pixel(std::floor(centre + reach - m_offset) + 1);
    for (int m = pixel(std::ceil(centre - reach - m_offset)); m < last; ++m) {
      const int x = x_major ? t : m, y = x_major ? m : t;
      const bool certain = clear && std::fabs(m + m_offset - centre) < half - 2 * error;
      if (certain || line.covers({x + offset.x, y + offset.y}, shift)) sink(x, y);
    }
  }
}

}  // namespace

void draw_lines(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs) {
  const PixelBox region = region_of(target, draw);
  if (region.empty()) return;
  const TieShift shift = tie_shift(draw.fill_rule);
  DrawFragments fragments(target, draw, number, layers, rungs);
  for (std::size_t i = 0; i < triangles_of(draw); ++i) {
    const auto position = static_cast<std::uint32_t>(i);
    if (!is_finite(draw, position) || !fragments.triangle().use(draw, position)) continue;
    const Line& line = fragments.triangle().line();
    for (int n = 0; n < target.samples; ++n) {
      const SamplePosition offset = sample_offset(target, n);
      const double least = std::min(offset.x, offset.y), largest = std::max(offset.x, offset.y);
      walk(line, line.box(region, least, largest), offset, shift, [&](int x, int y) {
        Fragment fragment{position, x - target.origin.x, y - target.origin.y, n};
        if (fragments.counts_of_covered(fragment)) fragments.take(fragment);
      });
    }
  }
}

}  // namespace surefill
