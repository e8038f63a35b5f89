// SPDX-License-Identifier: Apache-2.0
//
// At which pixels a conservative draw counts a triangle (M4, M4a, M4b of docs/semantics.md). T is the closed set of all
// (X/W, Y/W) of what the vertices span with weights that are not negative, Q a closed pixel square.
#ifndef SUREFILL_ORACLE_CONSERVATIVE_HPP
#define SUREFILL_ORACLE_CONSERVATIVE_HPP

#include "oracle/coverage.hpp"

namespace surefill::oracle {

// Does T meet this rectangle, as `mode` asks? `over` and `touched`: T meets it; `inner`: it lies in T; `overlap`: both
// share an area. D = 0 gives false but for `touched`. Preconditions: the positions are float32 values (no grid); `mode`
// is not `none`.
bool meets(const Cone& cone, const Rect& square, Conservative mode);

// M7's S of the edge from m0 to m1, here also where it is one point: does it meet the closed rectangle? Precondition: as
// above.
bool edge_meets(const Position& m0, const Position& m1, const Rect& square);

// Calls visit(x, y) for the pixels of `rect` whose closed squares S of the edge meets.
template <typename Visit>
void visit_edge(const Position& m0, const Position& m1, const Rect& rect, const Visit& visit);

// Calls visit(x, y) for the pixels of `rect` whose squares T meets so.
template <typename Visit>
void visit_conservative(const Cone& cone, const Rect& rect, Conservative mode, const Visit& visit);

// --- templates

// D != 0. `undecided`: as in visit_covered.
template <typename Visit>
void visit_met(const Cone& cone, const Rect& rect, Conservative mode, unsigned undecided, const Visit& visit) {
  if (rect.empty()) return;
  if (outside(cone, rect, undecided)) return;
  if (undecided == 0) {
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) visit(x, y);
    }
  } else if (rect.x1 - rect.x0 > 1 || rect.y1 - rect.y0 > 1) {
    for (const Rect& quarter : quarters(rect)) visit_met(cone, quarter, mode, undecided, visit);
  } else if (meets(cone, rect, mode)) {
    visit(rect.x0, rect.y0);
  }
}

// D = 0: what meets a square meets the rectangles that hold it.
template <typename Visit>
void visit_touched(const Cone& cone, const Rect& rect, const Visit& visit) {
  if (rect.empty() || !meets(cone, rect, Conservative::touched)) return;
  if (rect.x1 - rect.x0 > 1 || rect.y1 - rect.y0 > 1) {
    for (const Rect& quarter : quarters(rect)) visit_touched(cone, quarter, visit);
  } else {
    visit(rect.x0, rect.y0);
  }
}

// What meets a square meets the rectangles that hold it.
template <typename Visit>
void visit_edge(const Position& m0, const Position& m1, const Rect& rect, const Visit& visit) {
  if (rect.empty() || !edge_meets(m0, m1, rect)) return;
  if (rect.x1 - rect.x0 > 1 || rect.y1 - rect.y0 > 1) {
    for (const Rect& quarter : quarters(rect)) visit_edge(m0, m1, quarter, visit);
  } else {
    visit(rect.x0, rect.y0);
  }
}

template <typename Visit>
void visit_conservative(const Cone& cone, const Rect& rect, Conservative mode, const Visit& visit) {
  if (cone.sign_of_det() != 0) {
    visit_met(cone, rect, mode, kAllEdges, visit);
  } else if (mode == Conservative::touched) {
    visit_touched(cone, rect, visit);
  }
}

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_CONSERVATIVE_HPP
