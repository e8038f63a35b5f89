// SPDX-License-Identifier: Apache-2.0
//
// Where a vertex comes to lie on one axis under a model: R3 to R5 of docs/semantics.md.
#ifndef SUREFILL_ORACLE_POSITIONS_HPP
#define SUREFILL_ORACLE_POSITIONS_HPP

#include <gmpxx.h>

#include "oracle/model.hpp"

namespace surefill::oracle {

using Rational = mpq_class;

inline constexpr double kFarthest = 1 << 14;  // pixels: R7

// All positions that a vertex may come to, on one axis: R3 to R5.
struct Interval {
  double near_low = 0, near_high = 0;  // the ends, rounded
  bool exact = false;                  // and not rounded; else they are here:
  Rational low, high;
  bool point = true;
  bool is_point() const { return point; }
};

// False beyond 2^14 pixels. `more` is added to the axis's blur.
bool place_vertex(const AxisModel& axis, int length, float numerator, float w, Interval& result, double more = 0);

// R9. Beyond these a vertex may be left out, with what it is of; what is behind the eye is clipped if there is no least W.
inline bool in_range_of_w(const Model& model, const Vertex& vertex) {
  return (model.least_w == 0 || vertex.w >= model.least_w) && vertex.w <= model.most_w;
}
inline bool in_band_of(const Model& model, const Interval& position, int length) {
  return position.near_low >= -model.band && position.near_high <= length + model.band;
}
// May what has this vertex, of W > 0, be cut by depth?
bool cut_by_depth(const Model& model, const Vertex& vertex);

Rational floor_of(const Rational& value);

inline Rational end_of(const Interval& interval, unsigned which) {
  if (interval.exact) return Rational(which % 2 == 0 ? interval.near_low : interval.near_high);
  return which % 2 == 0 ? interval.low : interval.high;
}
inline double near_end(const Interval& interval, unsigned which) {
  return which % 2 == 0 ? interval.near_low : interval.near_high;
}

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_POSITIONS_HPP
