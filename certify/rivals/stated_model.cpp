// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/stated_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surefill::adapters {

namespace {

// The enumerators of both have the same values, so a cast translates.
static_assert(static_cast<int>(oracle::Rounding::ceiling) == SUREFILL_ADAPTER2_ROUND_CEILING);
static_assert(static_cast<int>(oracle::Rounding::truncate) == SUREFILL_ADAPTER2_ROUND_TRUNCATE);
static_assert(oracle::bit(oracle::Side::bottom_right) == SUREFILL_ADAPTER2_BOTTOM_RIGHT);
static_assert(oracle::bit(oracle::Side::top_left) == SUREFILL_ADAPTER2_TOP_LEFT);
static_assert(static_cast<int>(oracle::AtVertices::open) == SUREFILL_ADAPTER2_VERTICES_OPEN);
static_assert(static_cast<int>(oracle::Turned::nothing) == SUREFILL_ADAPTER2_TURNED_NOTHING);
static_assert(static_cast<int>(oracle::DepthFormat::unorm16) == SUREFILL_ADAPTER2_DEPTH_UNORM16);
static_assert(static_cast<int>(oracle::LineShape::unknown) == SUREFILL_ADAPTER2_LINE_UNKNOWN);
static_assert(static_cast<int>(oracle::LeftOut::both) == SUREFILL_ADAPTER2_LEFT_OUT_BOTH);
static_assert(static_cast<int>(FillRule::northwards_west) < SUREFILL_ADAPTER2_TIES_OPEN);

constexpr std::uint32_t kAllSides = 0xFF;
constexpr double kMostPixels = 16;  // that samples or viewports may be off: more is a mistake of units

std::string take_axis(const surefill_adapter2_axis& from, oracle::AxisModel& to) {
  for (const double length : {from.place, from.lacks, from.moved}) {
    if (!(std::abs(length) <= kMostPixels)) return "a place or a viewport that is off by more than 16 pixels";
  }
  for (const double length : {from.place_within, from.blur, from.divided_blur}) {
    if (!(length >= 0 && length <= kMostPixels)) return "a blur that is no length from 0 to 16 pixels";
  }
  if (from.grid_bits < -1 || from.grid_bits > 16) return "a grid of other than 0 to 16 bits";
  if (from.rounding > SUREFILL_ADAPTER2_ROUND_CEILING) return "a rounding that there is not";
  const double step = from.grid_bits < 0 ? 0 : std::ldexp(1.0, -from.grid_bits);
  if (!(from.grid_offset >= 0 && (from.grid_offset < step || from.grid_offset == 0))) {
    return "a grid's offset that is not below its step";
  }
  to = {from.place,      from.place_within, from.lacks,     from.moved,
        from.blur,       from.divided_blur, from.grid_bits, static_cast<oracle::Rounding>(from.rounding),
        from.grid_offset};
  // Adding 0.3 to the number of a pixel rounds it, in float32 or in double.
  const auto is_rounded = [](double length) {
    return std::ldexp(length, 16) != std::nearbyint(std::ldexp(length, 16));
  };
  constexpr double kRounded = 0x1p-16;  // of float32 on a target of 512 pixels and less
  if (is_rounded(from.place)) to.place_within = std::max(to.place_within, kRounded);
  if (is_rounded(from.moved)) to.blur = std::max(to.blur, kRounded);
  return "";
}

surefill_adapter2_axis axis_of(const oracle::AxisModel& axis) {
  return {axis.place,       axis.place_within, axis.lacks,
          axis.moved,       axis.blur,         axis.divided_blur,
          axis.grid_offset, axis.bits,         static_cast<std::uint32_t>(axis.rounding)};
}

surefill_adapter2_outline outline_of(const oracle::Outline& from, double blur) {
  const auto ties = static_cast<std::uint32_t>(from.ties ? static_cast<int>(*from.ties) : SUREFILL_ADAPTER2_TIES_OPEN);
  return {ties, 0, blur, from.border, from.least_width, from.most_width, from.width_within};
}

std::string take_outline(const surefill_adapter2_outline& from, oracle::Outline& to, double& blur) {
  if (from.ties > SUREFILL_ADAPTER2_TIES_OPEN) return "ties that there are not";
  for (const double length : {from.blur, from.border, from.width_within}) {
    if (!(length >= 0 && length <= kMostPixels)) return "a blur or a border that is no length from 0 to 16 pixels";
  }
  if (!(from.least_width >= 0 && from.most_width >= from.least_width)) return "a range of widths that there is not";
  to.ties.reset();
  if (from.ties != SUREFILL_ADAPTER2_TIES_OPEN) to.ties = static_cast<FillRule>(from.ties);
  to.border = from.border;
  to.least_width = from.least_width;
  to.most_width = from.most_width;
  to.width_within = from.width_within;
  blur = from.blur;
  return "";
}

}  // namespace

surefill_adapter2_model default_model() {
  const oracle::Model from;
  surefill_adapter2_model model{};
  model.size = sizeof model;
  model.front_owned = from.front.owned;
  model.back_owned = from.back.owned;
  model.x = axis_of(from.x);
  model.y = axis_of(from.y);
  model.most_w = from.most_w;
  model.clip_far = 1;
  model.clear = static_cast<double>(from.clear);
  model.distance = from.distance;
  model.thin_lines = static_cast<std::uint32_t>(from.lines.thin);
  model.wide_lines = static_cast<std::uint32_t>(from.lines.wide);
  model.lines = outline_of(from.lines.outline, from.lines.blur);
  model.points = outline_of(from.points.outline, from.points.blur);
  return model;
}

std::string take_model(const surefill_adapter2_model& from, oracle::Model& to) {
  if (((from.front_owned | from.front_open | from.back_owned | from.back_open) & ~kAllSides) != 0) {
    return "a side that there is not";
  }
  if (from.vertices > SUREFILL_ADAPTER2_VERTICES_OPEN || from.turned > SUREFILL_ADAPTER2_TURNED_NOTHING ||
      from.culled > SUREFILL_ADAPTER_CULL_BACK || from.depth_format > SUREFILL_ADAPTER2_DEPTH_UNORM16 ||
      from.clips > 1 || from.minus_one_to_one > 1 || from.later_wins > 1 ||
      from.thin_lines > SUREFILL_ADAPTER2_LINE_UNKNOWN || from.wide_lines > SUREFILL_ADAPTER2_LINE_UNKNOWN ||
      from.left_out > SUREFILL_ADAPTER2_LEFT_OUT_BOTH || from.whole_pixels > 1 || from.points_unknown > 1 ||
      from.points_clipped_whole > 1) {
    return "a choice that there is not";
  }
  if (!(from.least_area >= 0) || !(from.least_w >= 0) || !(from.most_w >= from.least_w))
    return "a limit below 0, or none";
  if (!(from.distance >= 0 && from.distance <= 1)) return "a distance that is not 0 to 1 pixel";
  if (std::isnan(from.clear) || static_cast<double>(static_cast<float>(from.clear)) != from.clear) {
    return "a clear value that is no float32";
  }
  if (from.clips != 0 && !(from.clip_near <= from.clip_far)) return "a range of depth that ends before it begins";
  if (const std::string wrong = take_axis(from.x, to.x); !wrong.empty()) return "x: " + wrong;
  if (const std::string wrong = take_axis(from.y, to.y); !wrong.empty()) return "y: " + wrong;
  const auto owners = [](std::uint32_t owned, std::uint32_t open) {
    return oracle::Owners{static_cast<std::uint8_t>(owned), static_cast<std::uint8_t>(open)};
  };
  to.front = owners(from.front_owned, from.front_open);
  to.back = owners(from.back_owned, from.back_open);
  to.vertices = static_cast<oracle::AtVertices>(from.vertices);
  to.turned = static_cast<oracle::Turned>(from.turned);
  to.least_area = from.least_area;
  to.least_w = from.least_w;
  to.most_w = from.most_w;
  to.culled = static_cast<Cull>(from.culled);
  to.clipped.reset();
  if (from.clips != 0) to.clipped = {from.clip_near, from.clip_far};
  to.format = static_cast<oracle::DepthFormat>(from.depth_format);
  to.minus_one_to_one = from.minus_one_to_one != 0;
  to.later_wins = from.later_wins != 0;
  to.clear = static_cast<float>(from.clear);
  to.distance = from.distance;
  to.lines.thin = static_cast<oracle::LineShape>(from.thin_lines);
  to.lines.wide = static_cast<oracle::LineShape>(from.wide_lines);
  to.lines.left_out = static_cast<oracle::LeftOut>(from.left_out);
  to.lines.whole_pixels = from.whole_pixels != 0;
  to.points.known = from.points_unknown == 0;
  to.points.clipped_whole = from.points_clipped_whole != 0;
  if (const std::string wrong = take_outline(from.lines, to.lines.outline, to.lines.blur); !wrong.empty()) {
    return "lines: " + wrong;
  }
  if (const std::string wrong = take_outline(from.points, to.points.outline, to.points.blur); !wrong.empty()) {
    return "points: " + wrong;
  }
  return "";
}

}  // namespace surefill::adapters
