// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/stated.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surefill::judge {

namespace {

using oracle::AxisModel;
using oracle::Model;
using oracle::Owners;
using oracle::Rounding;

constexpr double kMargin = 16;          // of what is found of blur: R4, and a moving end is amplified by what is fixed
constexpr double kRoundings = 0x1p-20;  // of float32 on a target of 16 pixels, where a viewport of another size scales

// R5 goes by a sign, or by whether k is even.
AxisModel in_plain_words(AxisModel axis) {
  if (axis.moved == 0) return axis;
  const double step = std::ldexp(1.0, -axis.bits), moved_offset = axis.grid_offset - axis.moved,
               offset = axis.bits < 0 ? 0 : moved_offset - std::floor(moved_offset / step) * step;
  if (axis.bits >= 0) {
    if (axis.rounding == Rounding::nearest_away || axis.rounding == Rounding::truncate) return axis;
    const double steps = (moved_offset - offset) / step;
    if (axis.rounding == Rounding::nearest_even && std::fmod(steps, 2) != 0 && axis.blur == 0) return axis;
  }
  axis.grid_offset = offset;
  axis.place -= axis.moved;
  axis.moved = 0;
  return axis;
}

bool is_blurred(const AxisModel& axis) {
  return axis.blur > 0 || axis.place_within > 0;
}

// `most` is the largest blur that is stated of an axis: edges show that of both.
bool may_be(const AxisModel& stated, const AxisModel& found, double most) {
  const double step = stated.bits < 0 ? 0 : std::ldexp(1.0, -stated.bits);
  // So much blur hides a grid.
  const bool hidden = 4 * stated.blur >= step && (stated.bits >= 0 || found.bits < 0);
  const auto nearest = [](const AxisModel& axis) { return axis.rounding <= Rounding::nearest_away; };
  const bool same_rounding =
      stated.rounding == found.rounding || (is_blurred(stated) && nearest(stated) && nearest(found));
  const bool same_grid =
      stated.bits == found.bits &&
      (stated.bits < 0 || (same_rounding && std::abs(stated.grid_offset - found.grid_offset) <= stated.blur));
  const bool scaled = stated.lacks != 0;
  const double blur = std::max(kMargin * most, scaled ? kRoundings : 0);
  const double apart = stated.place_within + found.place_within + blur;
  return (hidden || same_grid) && std::abs(stated.place - found.place) <= apart && stated.moved == found.moved &&
         std::abs(stated.lacks - found.lacks) <= (scaled ? kRoundings : 0) && found.blur <= blur;
}

bool may_be(const Owners& stated, const Owners& found) {
  const auto seen = static_cast<unsigned>(~stated.open & 0xFF);
  return ((stated.owned ^ found.owned) & seen) == 0 && (found.open & seen) == 0;
}

// The sample lies where a vertex may come to lie, and that is known.
bool is_seen(const AxisModel& axis) {
  const double place = std::ldexp(axis.place - axis.grid_offset - axis.moved, axis.bits);
  return !is_blurred(axis) && (axis.bits < 0 ? axis.lacks == 0 : place == std::nearbyint(place));
}

}  // namespace

Model in_plain_words(Model model) {
  model.x = in_plain_words(model.x), model.y = in_plain_words(model.y);
  return model;
}

bool owners_are_seen(const Model& stated) {
  return is_seen(stated.x) && is_seen(stated.y);
}

bool may_be(const Model& stated, const Model& found) {
  const double most = std::max(stated.x.blur, stated.y.blur);
  if (!may_be(stated.x, found.x, most) || !may_be(stated.y, found.y, most)) return false;
  if (!owners_are_seen(stated)) return true;
  const auto drawn = [&](Cull facing) { return stated.culled != facing && found.culled != facing; };
  return (!drawn(Cull::front) || may_be(stated.front, found.front)) &&
         (!drawn(Cull::back) || may_be(stated.back, found.back)) &&
         (stated.vertices == found.vertices || stated.vertices == oracle::AtVertices::open);
}

}  // namespace surefill::judge
