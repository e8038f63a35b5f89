// SPDX-License-Identifier: Apache-2.0
//
// A line of a draw: the samples that it covers, wide or thin (M7), and its values there (I7). S is what is seen of it: a
// segment or a ray, from its vertex 0 towards its vertex 1. Along the major axis t it has one point a coordinate.
#ifndef SUREFILL_SRC_LINE_HPP
#define SUREFILL_SRC_LINE_HPP

#include <cmath>
#include <optional>

#include "approximation.hpp"
#include "bounds.hpp"
#include "edge.hpp"

namespace surefill {

class Line {
 public:
  // False if it covers nothing: S is empty, or one point. Vertices are finite, the width too and above 0; without one the
  // line is thin.
  bool set_up(const Vertex& v0, const Vertex& v1, std::optional<float> width);

  // z(t) = slope t + start for the depth (I7) between the ends, off by less than error + 2^-50 |slope t|.
  struct DepthAlong {
    double slope, start, error;
  };
  DepthAlong depth_along() const;

  bool x_major() const { return x_major_; }
  double half_width() const { return half_; }
  const EdgeFunction& edge() const { return edge_; }

  bool covers(SamplePosition p, TieShift shift, Rungs* rungs = nullptr) const;

  // Has S a point with the major coordinate of the moved sample?
  bool within_ends(SamplePosition p, TieShift shift) const {
    const double t = along(p);
    const int step = x_major_ ? shift.x : shift.y;
    for (int i = 0; i < 2; ++i) {
      if (!(end_[i].w > 0)) continue;
      const int after = t * end_[i].w == end_[i].t  ? step
                        : t * end_[i].w > end_[i].t ? 1
                                                    : -1;  // exact: 27 and 24 bits
      if (after * forward_ != (i == 0 ? 1 : -1)) return false;
    }
    return true;
  }

  // From which to which major coordinate S reaches, to within a rounding; without an end, infinitely far.
  Reach reach_of_ends() const;

  // The pixels of `limits` that it can cover. Sample offsets within a pixel lie in [least_offset, largest_offset].
  PixelBox box(PixelBox limits, double least_offset, double largest_offset) const;

  // Depth as it is stored; false if depth clipping removes the fragment (I5).
  bool depth(SamplePosition p, DepthMode mode, float* to, Rungs* rungs = nullptr) const;

  // An attribute at p as I4 stores it, from its values at the two vertices.
  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation, Rungs* rungs = nullptr) const;

 private:
  struct End {
    double t, w, z;  // the major coordinate times W
  };

  // n_0 v_0 + n_1 v_1 for I7's k_i = n_i / determinant: n_0 = a_0 - b_0 and n_1 = a_1 - b_1, of doubles. One of the
  // n_i may be 0, and none has another sign than the determinant d_0 - d_1.
  struct Mix {
    double a[2], b[2], d[2], v[2];

    Approximation sum() const {
      const double s0 = (a[0] - b[0]) * v[0], s1 = (a[1] - b[1]) * v[1];
      return {s0 + s1, 0x1p-50 * (std::fabs(s0) + std::fabs(s1))};
    }
    Approximation weights() const {
      const double sum = (a[0] - b[0]) + (a[1] - b[1]);
      return {sum, 0x1p-51 * std::fabs(sum)};
    }
    Approximation determinant() const {
      const double difference = d[0] - d[1];
      return {difference, 0x1p-52 * std::fabs(difference)};
    }
    Expansion<8> exact_sum() const {
      Expansion<8> sum;
      for (int i = 0; i < 2; ++i) sum.add_product(a[i], v[i]), sum.add_product(-b[i], v[i]);
      return sum;
    }
    Expansion<4> exact_weights() const {
      Expansion<4> sum;
      for (int i = 0; i < 2; ++i) sum.add(a[i]), sum.add(-b[i]);
      return sum;
    }
    Expansion<2> exact_determinant() const {
      Expansion<2> difference;
      difference.add(d[0]), difference.add(-d[1]);
      return difference;
    }
  };

  double along(SamplePosition p) const { return x_major_ ? p.x : p.y; }

  // |dx| >= |dy| of S's direction (b, -a)? Rounding is monotonic, so only equal numbers have to be looked at.
  bool along_x() const;

  // The sign of E + s |m| w/2 at the moved sample, m the coefficient of the minor coordinate: the line is wider than its
  // distance from the sample where it is not s's opposite, for both s.
  int side(SamplePosition p, int s, TieShift shift, Rungs* rungs) const;

  // Does S have an end at vertex i that lies in the open diamond around the moved sample?
  bool ends_in_diamond(int i, SamplePosition p, TieShift shift) const;

  Reach widened(Reach r) const;

  // I7 at p for values v_0 and v_1: at the point of S that has p's major coordinate, or at the nearest end.
  Mix mix_at(SamplePosition p, double v0, double v1) const;

  // 0 <= sum / determinant <= 1, exactly.
  static bool inside_unit_range(const Mix& mix);

  EdgeFunction edge_;
  bool thin_ = false, x_major_ = true;
  int forward_ = 1;    // does t grow along S?
  double half_ = 0.5;  // of the width
  double slope_ = 0;   // the edge's coefficient of the minor coordinate
  End end_[2] = {};
};

}  // namespace surefill

#endif  // SUREFILL_SRC_LINE_HPP
