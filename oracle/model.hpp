// SPDX-License-Identifier: Apache-2.0
//
// What somebody else's rasterizer does, as far as it is known, and which samples a triangle covers under it: section 11
// of docs/semantics.md (R1 to R10, R17 to R21). Plain data, and functions over it; of the engine, the public types alone.
#ifndef SUREFILL_ORACLE_MODEL_HPP
#define SUREFILL_ORACLE_MODEL_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// R5's roundings.
enum class Rounding : std::uint8_t {
  nearest_even,
  nearest_up,
  nearest_down,
  nearest_away,
  truncate,
  floor,
  ceiling,
};

// R2 to R5 on one axis. All numbers are pixels, and meant as the real numbers that they are.
struct AxisModel {
  double place = 0.5;       // of the sample in its pixel
  double place_within = 0;  // and how well that is known
  double lacks = 0;         // pixels that the viewport lacks, of the target's
  double moved = 0;
  double blur = 0;
  double divided_blur = 0;  // instead, where it is more and W is no power of two
  int bits = -1;            // of the grid; -1: none
  Rounding rounding = Rounding::nearest_even;
  double grid_offset = 0;

  friend bool operator==(const AxisModel&, const AxisModel&) = default;
};

// R6: the sides of a triangle that an edge can be on, and who owns the samples on it, a bit a side.
enum class Side : std::uint8_t { left, right, top, bottom, top_left, top_right, bottom_left, bottom_right };
inline constexpr std::uint8_t bit(Side side) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(side));
}
inline constexpr std::uint8_t kSlanted =
    bit(Side::top_left) | bit(Side::top_right) | bit(Side::bottom_left) | bit(Side::bottom_right);
struct Owners {
  std::uint8_t owned = 0;
  std::uint8_t open = 0;  // these are not known, whatever `owned` says

  friend bool operator==(const Owners&, const Owners&) = default;
};

// Those of C3's eight, closed and open.
inline Owners owners_of(FillRule rule) {
  const auto sides = [](Side a, Side b, Side c, Side d) {
    return Owners{static_cast<std::uint8_t>(bit(a) | bit(b) | bit(c) | bit(d)), 0};
  };
  switch (rule) {
    case FillRule::top_left:
      return sides(Side::left, Side::top_left, Side::bottom_left, Side::top);
    case FillRule::top_right:
      return sides(Side::right, Side::top_right, Side::bottom_right, Side::top);
    case FillRule::bottom_left:
      return sides(Side::left, Side::top_left, Side::bottom_left, Side::bottom);
    case FillRule::bottom_right:
      return sides(Side::right, Side::top_right, Side::bottom_right, Side::bottom);
    case FillRule::southwards:
      return sides(Side::top, Side::top_left, Side::top_right, Side::left);
    case FillRule::southwards_west:
      return sides(Side::top, Side::top_left, Side::top_right, Side::right);
    case FillRule::northwards:
      return sides(Side::bottom, Side::bottom_left, Side::bottom_right, Side::left);
    case FillRule::northwards_west:
      return sides(Side::bottom, Side::bottom_left, Side::bottom_right, Side::right);
    case FillRule::closed:
      return {0xFF, 0};
    case FillRule::open:
      break;
  }
  return {0, 0};
}

enum class AtVertices : std::uint8_t { as_edges, covered, not_covered, open };  // R6
enum class Turned : std::uint8_t { open, as_grid, nothing };                    // R8
enum class DepthFormat : std::uint8_t { float32, float64, unorm24, unorm16 };   // R11

// R18 to R21: lines and points.
enum class LineShape : std::uint8_t { diamond, parallelogram, rectangle, tolerant, unknown };
enum class LeftOut : std::uint8_t { last, first, none, both };  // R19: ends of a diamond

// R20.
struct Outline {
  std::optional<FillRule> ties = FillRule::top_left;  // one of the eight; none: open
  double border = 0;
  double least_width = 0, most_width = std::numeric_limits<double>::infinity();
  double width_within = 0;

  friend bool operator==(const Outline&, const Outline&) = default;
};

struct LineModel {
  LineShape thin = LineShape::diamond, wide = LineShape::parallelogram;
  LeftOut left_out = LeftOut::last;
  bool whole_pixels = false;
  double blur = 0;
  Outline outline;

  friend bool operator==(const LineModel&, const LineModel&) = default;
};

struct PointModel {
  bool known = true;
  bool clipped_whole = false;
  double blur = 0;
  Outline outline;

  friend bool operator==(const PointModel&, const PointModel&) = default;
};

struct Model {
  AxisModel x, y;
  Owners front = owners_of(FillRule::top_left), back = front;
  AtVertices vertices = AtVertices::as_edges;
  Turned turned = Turned::open;
  double least_area = 0;    // in square pixels: R8
  bool draws_flat = false;  // triangles in a line are drawn somehow: R8
  double least_w = 0, most_w = std::numeric_limits<double>::infinity();
  double band = std::numeric_limits<double>::infinity();  // pixels beyond the target, on an axis: R9
  Cull culled = Cull::none;                               // always: R10
  std::optional<std::array<double, 2>> clipped;  // to this depth, always: R10; and what is beyond may be cut: R9
  // Depth: R11, R12.
  DepthFormat format = DepthFormat::float32;
  bool minus_one_to_one = false;
  bool later_wins = false;  // LEQUAL, GEQUAL
  float clear = std::numeric_limits<float>::infinity();
  double distance = 0x1p-4;  // p
  LineModel lines;
  PointModel points;

  friend bool operator==(const Model&, const Model&) = default;
};

// R9: the W of new vertices where the triangle has one of less; 0: it has not.
inline double least_w_of_cut(const Model& model, const std::array<Vertex, 3>& t) {
  return std::min({t[0].w, t[1].w, t[2].w}) < model.least_w ? model.least_w : 0;
}

// R9: how much further from its edges, in pixels, such a triangle is open: new vertices come of roundings of float32, and are
// divided by their W.
inline double lost_by_cutting(const Model& model, int width, int height, const std::array<Vertex, 3>& t) {
  const double w = least_w_of_cut(model, t);
  if (w == 0) return 0;
  double largest = 0;
  for (const Vertex& v : t) {
    largest = std::max(
        {largest, std::abs(double{v.x}), std::abs(double{v.y}), std::abs(double{v.w}) * std::max(width, height)});
  }
  return 0x1p-20 * largest / w;
}

// R6. The fill rule that both facings go by, where it is one of the eight and vertices are not overruled.
inline std::optional<FillRule> watertight_rule(const Model& model) {
  if (!(model.front == model.back) || model.vertices != AtVertices::as_edges || model.front.open != 0) {
    return std::nullopt;
  }
  for (int rule = 0; rule < 8; ++rule) {
    if (owners_of(static_cast<FillRule>(rule)) == model.front) return static_cast<FillRule>(rule);
  }
  return std::nullopt;
}

// R1.
enum class Cover : std::uint8_t { no, yes, open };

// The answer for each sample of a target of this size, sample n of pixel (x, y) being element (y width + x) samples + n.
// A triangle with a NaN or an infinity covers nothing (B1). Depth says whether the triangle may be cut (R9); what `clipped`
// takes away is the caller's to say.
std::vector<Cover> cover(const Model& model, int width, int height, int samples, const std::array<Vertex, 3>& triangle);

// The same for a line, thin if it has no width, and for a point (R17 to R21), with one sample a pixel.
std::vector<Cover> cover_line(const Model& model, int width, int height, const std::array<Vertex, 2>& ends,
                              std::optional<float> line_width);
std::vector<Cover> cover_point(const Model& model, int width, int height, const Vertex& vertex, float size);

// R8: may snapping or blur turn the triangle over, or lay it flat? True, too, where R9 leaves it open.
bool may_turn(const Model& model, int width, int height, const std::array<Vertex, 3>& triangle);

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_MODEL_HPP
