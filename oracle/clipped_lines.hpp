// SPDX-License-Identifier: Apache-2.0
//
// Lines and points of the second oracle (M7, I6, I7 of docs/semantics.md): what they cover as polygons in which the
// perturbed sample lies or not, and where the plane through the eye and a column or row cuts a line.
#ifndef SUREFILL_ORACLE_CLIPPED_LINES_HPP
#define SUREFILL_ORACLE_CLIPPED_LINES_HPP

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "oracle/clipped_plane.hpp"
#include "oracle/clipped_polygon.hpp"

namespace surefill::oracle::clipped {

// The places of the perturbed samples that are covered: what is in `region` and not in `hole`, two convex polygons that
// turn from +x to +y, the hole within the region. Either may be empty. Cut to the neighbourhood of the target.
struct Area {
  std::vector<Point> region, hole;
};

// The square of a point; nothing for W <= 0.
Area point_area(const Vector& m, const Rational& side, int width, int height);

// The line from m0 to m1. It is m(l) = (1 - l) m0 + l m1, 0 <= l <= 1, and S is what is seen of it where W(l) > 0.
class SeenLine {
 public:
  // Nothing if S is one point or empty.
  static std::optional<SeenLine> make(const Vector& m0, const Vector& m1);

  // Without a line width: thin.
  Area area(const std::optional<Rational>& line_width, int width, int height) const;

  // I7's q.
  struct Place {
    Rational share;  // l
    Rational w;      // W(l) > 0
  };
  Place place(const Vector& p) const;

  Weights perspective(const Place& place) const { return {1 - place.share, place.share, 0}; }
  Weights noperspective(const Place& place) const {
    return {(1 - place.share) * m_[0].w / place.w, place.share * m_[1].w / place.w, 0};
  }
  Rational depth(const Place& place, const std::array<Rational, 3>& z) const {
    return combine(perspective(place), z) / place.w;
  }

 private:
  const Rational& major(const Vector& m) const { return x_major_ ? m.x : m.y; }
  Vector at(const Rational& share) const;
  std::optional<std::pair<Rational, Rational>> shares_between(const Rational& low, const Rational& high) const;

  std::array<Vector, 2> m_;
  bool x_major_ = true;
};

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_CLIPPED_LINES_HPP
