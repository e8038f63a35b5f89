// SPDX-License-Identifier: Apache-2.0
//
// The registry of what is claimed: each property states a theorem or an equality, makes cases that aim at it, and
// decides one case. The GoogleTest runs use it through RapidCheck, certify runs it by count, both report the same
// names.
#ifndef SUREFILL_PROPERTIES_PROPERTIES_HPP
#define SUREFILL_PROPERTIES_PROPERTIES_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {

// How one case came out.
struct TrialResult {
  std::uint64_t samples = 0;      // samples looked at
  std::uint64_t differences = 0;  // 0: the claim holds on this case
  std::string finding;            // one line: what was expected, what came; empty if it holds
};

struct Property {
  const char* name;   // "partition-delaunay", "degree-spot", "octants", "scale", "order", "identifiers", ...
  const char* rule;   // "T1", "C3", ...
  const char* claim;  // one sentence
  bool needs_oracle;
  // Does the claim make sense for every simplification of a case? If not (a mesh that must tile), a finding is reduced
  // by comparing the renderer with the oracle instead.
  bool simplifies;
  std::uint64_t
      exhaustive;  // 0: sampled by seed; else cases are numbered 0 .. exhaustive - 1 and that is all there are
  corpus::Scene (*make)(std::uint64_t seed_or_number);
  TrialResult (*decide)(const corpus::Scene& scene, const Renderer& renderer);
  bool holds_under_grid = false;  // also with one Grid, whatever it is, on every draw of the case
};

std::span<const Property> all_properties();

// The picture of a finding: the covers that the claim asks of each sample, and those that came. Where another output
// differs the covers may be equal, and the marks say where it does.
struct Exhibit {
  int width = 0, height = 0, samples = 1;
  std::string output;                           // "count", "index" or "values"
  std::vector<std::uint32_t> expected, actual;  // counts; kOpenCount where any would be right
  std::vector<std::uint8_t> differs;
  // What differs other than counts, at most one of each sample: numbers as people read them, and how far off it is.
  struct Value {
    std::size_t sample = 0;
    std::string output, expected, actual;
    double error = 0;  // HUGE_VAL for what is no number
  };
  std::vector<Value> values;
  static constexpr std::uint32_t kOpenCount = 0xFFFFFFFF;
};

// Of what `decide` finds first on the scene. None where it finds nothing, where there is no image to show, and where it
// holds the renderer against the oracle: then the two images of the scene are the picture.
std::optional<Exhibit> exhibit_of(const Property& property, const corpus::Scene& scene, const Renderer& renderer);

// Case n of the property: n itself, or some case of an exhaustive one, well mixed.
corpus::Scene sampled_case(const Property& property, std::uint64_t n);

// Of so many cases of an ordinary property, how many of this one take about the same time.
std::uint64_t affordable_cases(const Property& property, std::uint64_t cases);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_PROPERTIES_HPP
