// SPDX-License-Identifier: Apache-2.0
//
// A fault's name: of rasterizers that are known to be wrong in one way each, the one that draws what the rival draws.
#ifndef SUREFILL_CERTIFY_JUDGE_NAMING_HPP
#define SUREFILL_CERTIFY_JUDGE_NAMING_HPP

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::judge {

// One way to be wrong.
struct Fault {
  std::string name;      // "edges-inclusive"
  std::string sentence;  // "samples on edges belong to both sides"
  std::string origin;    // where it was seen; may be empty
  std::function<Status(const Target&, std::span<const Draw>)> render;
};

// A scene on which the rival is wrong, with its image and the right one, of the same outputs.
struct Wrong {
  corpus::Scene scene;
  corpus::Image right, rival;
  std::vector<std::uint8_t> open = {};  // 1 at samples of which nothing is said: they are set right; or empty
};

// How well a fault explains what is wrong: of all samples that it or the rival draws wrongly, those that both draw alike.
struct Name {
  const Fault* fault = nullptr;
  double agreement = 0;  // 0..1
  std::uint64_t samples = 0;
};

// The best explanation first; none below `least`. Equal ones are in the order of the faults. Values are alike that are
// within `within` of each other, as a part of 1 or of their size; 0: to the bit.
std::vector<Name> name_fault(std::span<const Fault> faults, std::span<const Wrong> wrong, double within,
                             double least = 0.5);

// Takes away the names of faults that would show in scenes which are drawn right: in more than a fourth of the first dozen.
void drop_refuted(std::vector<Name>& names, std::span<const corpus::Scene> fine, double within);

// What is alike within that.
bool alike_within(float a, float b, double within);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_NAMING_HPP
