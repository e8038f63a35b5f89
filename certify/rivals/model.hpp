// SPDX-License-Identifier: Apache-2.0
//
// Which model a rival follows, found by drawing triangles whose edges pass samples at chosen distances.
#ifndef SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP
#define SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP

#include <string>
#include <vector>

#include "certify/rivals/rival.hpp"

namespace surefill::adapters {

// What probing said.
struct Inference {
  surefill_adapter_model model{};     // where `fits`, complete; else what could be found, without a grid
  bool fits = false;                  // some model explains every probe
  std::vector<std::string> problems;  // one line each: what no model explains
};

// Draws some hundreds of small triangles, all in front of the eye. Throws RivalFailure, RivalSkips.
Inference infer_model(Rival& rival);

// "Grid of 8 bits, nearest_even, offset (0, 0), fill rule top_left, rows from the top, profile d3d11".
std::string describe_model(const surefill_adapter_model& model);

// What coverage depends on is the same.
bool same_coverage(const surefill_adapter_model& a, const surefill_adapter_model& b);

const char* profile_name(std::uint32_t profile);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP
