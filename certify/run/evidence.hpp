// SPDX-License-Identifier: Apache-2.0
//
// What a finding looks like, kept so that a picture of it can be drawn without the rasterizer.
#ifndef SUREFILL_CERTIFY_EVIDENCE_HPP
#define SUREFILL_CERTIFY_EVIDENCE_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::certify {

// Both answers in a window of the target, row by row, sample by sample.
struct Evidence {
  int x0 = 0, y0 = 0, width = 0, height = 0, samples = 1;  // nothing if width is 0
  // Coverage counts; Exhibit::kOpenCount where any is right. `actual` is empty where there is no answer.
  std::vector<std::uint32_t> expected, actual;
  std::vector<std::uint8_t> differs;               // 1 where the answers differ
  std::string what;                                // the output in which they do
  std::vector<properties::Exhibit::Value> values;  // where it is not counts; `sample` is one of the window
};

inline constexpr int kEvidenceSize = 48;  // pixels of a window each way, at most

// Draws both. Where counts agree, it is the index that is compared, and where that agrees, the values, to the bit.
Evidence gather_evidence(const corpus::Scene& scene, const properties::Renderer& expected,
                         const properties::Renderer& actual);

// The window of a picture that the finding itself has, around its first difference.
Evidence evidence_of(const properties::Exhibit& exhibit);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_EVIDENCE_HPP
