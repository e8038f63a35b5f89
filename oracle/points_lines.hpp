// SPDX-License-Identifier: Apache-2.0
//
// Coverage of points and lines (M7), from the page alone, in rationals with an infinitely small step. Vertices are
// finite; (x, y) is a sample.
#ifndef SUREFILL_ORACLE_POINTS_LINES_HPP
#define SUREFILL_ORACLE_POINTS_LINES_HPP

#include "surefill/surefill.hpp"

namespace surefill::oracle {

bool point_covers(const Vertex& v, float size, double x, double y, FillRule rule);
bool line_covers(const Vertex& v0, const Vertex& v1, double x, double y, FillRule rule);
bool wide_line_covers(const Vertex& v0, const Vertex& v1, float width, double x, double y, FillRule rule);

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_POINTS_LINES_HPP
