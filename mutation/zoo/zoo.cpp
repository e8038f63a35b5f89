// SPDX-License-Identifier: Apache-2.0
#include "mutation/zoo/zoo.hpp"

#include <vector>

namespace surefill::zoo {

std::span<const Specimen> specimens() {
  static const std::vector<Specimen> all = [] {
    std::vector<Specimen> joined;
    for (const std::span<const Specimen> list :
         {coverage_specimens(), arithmetic_specimens(), value_specimens(), frame_specimens(), mode_specimens(),
          output_specimens(), line_specimens()})
      joined.insert(joined.end(), list.begin(), list.end());
    return joined;
  }();
  return all;
}

std::span<const Specimen> rival_specimens() {
  return specimens().first(specimens().size() - output_specimens().size() - line_specimens().size());
}

}  // namespace surefill::zoo
