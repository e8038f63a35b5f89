// SPDX-License-Identifier: Apache-2.0
//
// O4 and O5 of docs/semantics.md, clause by clause and square by square, in rationals; and the same with one clause wrong,
// for tests that must notice.
#ifndef SUREFILL_ORACLE_TESTS_SAFE_BY_THE_PAGE_HPP
#define SUREFILL_ORACLE_TESTS_SAFE_BY_THE_PAGE_HPP

#include <span>
#include <vector>

#include "oracle/occlusion.hpp"

namespace surefill::oracle {

// A clause that is wrong.
enum class Wrong {
  nothing,
  // Rims
  no_rims,              // a square is filled if its centre is covered
  rims_inside,          // a rim must meet the inside of the square, and not only its border
  rim_ends,             // a rim is met only where one of its ends is
  no_rays,              // rims that reach behind the eye are not met
  ends_projected,       // rims run from X/W, Y/W to X/W, Y/W, even behind the eye
  rims_of_one_face,     // only faces over the centre have rims
  edges_in_pairs,       // an edge of two faces is inner, whichever way they have it
  edges_of_both_sides,  // a back face may close a front face's edge
  edges_without_w,      // vertices are one if X and Y are equal
  nearly_equal_ends,    // vertices are one if X, Y and W differ by less than 2^-16
  degenerate_faces,     // D = 0 has edges, too
  culled_faces,         // what is culled is a face
  dropped_faces,        // what is dropped because of Z closes edges
  // Bounds
  faces_alone,          // each face fills on its own, though its edges are inner
  covering_faces,       // only faces over the centre have ranges
  depth_at_centre,      // the plane at the centre is the range
  depth_at_corner,      // the plane at one corner is
  nearest_end,          // the nearer ends of the ranges count
  cut_behind,           // ranges are cut to the vertices' Z/W, whatever their W
  cut_to_mean,          // ranges are cut to the mean of the vertices' Z/W
  rounded_nearer,       // to the next float32 on the other side
  not_clipped,          // depth clipping has no part
  clipped_by_one_face,  // depth clipping asks faces over the centre alone
  not_clamped,          // depth clamping has no part
  // Queries
  reach_of_centres,   // R in the place of R'
  reach_without_end,  // a pixel that the end of the rectangle only touches is left out
  farthest_d,         // the farthest depth of the box
  behind_left_out,    // corners behind the eye have no part
  equal_is_hidden,    // O6 has no part
  last,
};
// Its name, for messages.
const char* name_of(Wrong wrong);

std::vector<float> safe_depth_by_the_page(const Target& target, std::span<const Draw> occluders,
                                          std::span<const Positions> positions, Wrong wrong);
Occlusion answer_by_the_page(const Target& target, std::span<const float> depth, const OcclusionBox& box,
                             OcclusionRule rule, Wrong wrong);
Occlusion answer_by_the_page(const Target& target, std::span<const float> depth, const OcclusionRectangle& rectangle,
                             OcclusionRule rule, Wrong wrong);

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_TESTS_SAFE_BY_THE_PAGE_HPP
