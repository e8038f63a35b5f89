// SPDX-License-Identifier: Apache-2.0
//
// The right rasterizers that the zoo's plugin has beside its specimens.
#ifndef SUREFILL_MUTATION_ZOO_NAMES_HPP
#define SUREFILL_MUTATION_ZOO_NAMES_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "certify/adapter.h"
#include "corpus/names.hpp"

namespace surefill::adapters {

inline constexpr const char *kExactName = "exact", *kExactSecondName = "exact-second";

struct GridRasterizer {
  std::string name;  // "grid-8-nearest-even-top-left"
  surefill_adapter_model model;
};

inline std::vector<GridRasterizer> grid_rasterizers() {
  std::vector<GridRasterizer> all;
  for (const std::uint32_t bits : {4u, 8u, 12u}) {
    for (std::uint32_t rounding = 0; rounding < 3; ++rounding) {
      for (std::uint32_t corner = 0; corner < 4; ++corner) {
        GridRasterizer& grid = all.emplace_back();
        grid.name.append("grid-").append(std::to_string(bits)).append("-");
        grid.name.append(corpus::kGridRoundingNames[rounding].second).append("-");
        grid.name.append(corpus::kFillRuleNames[corner].second);
        grid.model = {};
        grid.model.kind = SUREFILL_ADAPTER_MODEL_GRID;
        grid.model.grid_bits = bits;
        grid.model.grid_rounding = rounding;
        grid.model.fill_rule = corner;
        grid.model.profile = SUREFILL_ADAPTER_PROFILE_EXACT;
      }
    }
  }
  return all;
}

}  // namespace surefill::adapters

#endif  // SUREFILL_MUTATION_ZOO_NAMES_HPP
