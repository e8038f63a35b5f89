// SPDX-License-Identifier: Apache-2.0
//
// The places of samples and the steps of fill rules: tables of the page, without arithmetic.
#include "oracle/coverage.hpp"

namespace surefill::oracle {

Step step_of(FillRule rule) {
  switch (rule) {
    case FillRule::top_left:
      return {1, 1, true};
    case FillRule::top_right:
      return {-1, 1, true};
    case FillRule::bottom_left:
      return {1, -1, true};
    case FillRule::bottom_right:
      return {-1, -1, true};
    case FillRule::southwards:
      return {1, 1, false};
    case FillRule::southwards_west:
      return {-1, 1, false};
    case FillRule::northwards:
      return {1, -1, false};
    case FillRule::northwards_west:
      return {-1, -1, false};
    case FillRule::closed:
    case FillRule::open:
      break;  // C5: no step
  }
  return {1, 1, true};
}

Point sample_point(int samples, int n, int x, int y) {
  static constexpr Point k1[] = {{8, 8}};
  static constexpr Point k2[] = {{12, 12}, {4, 4}};
  static constexpr Point k4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
  static constexpr Point k8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
  static constexpr Point k16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                  {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};
  const Point* pattern = samples == 1 ? k1 : samples == 2 ? k2 : samples == 4 ? k4 : samples == 8 ? k8 : k16;
  return {x * kUnits + pattern[n].x, y * kUnits + pattern[n].y};
}

Point centre(int x, int y) {
  return {x * kUnits + kUnits / 2, y * kUnits + kUnits / 2};
}

}  // namespace surefill::oracle
