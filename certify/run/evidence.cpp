// SPDX-License-Identifier: Apache-2.0
#include "certify/run/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>

namespace surefill::certify {

namespace {

template <typename Value>
bool mark(const std::vector<Value>& expected, const std::vector<Value>& actual, std::vector<std::uint8_t>& marks) {
  if (expected.size() != actual.size()) return false;
  bool any = false;
  for (std::size_t s = 0; s < expected.size(); ++s) {
    marks[s] = expected[s] != actual[s];
    any = any || marks[s];
  }
  return any;
}

using Value = properties::Exhibit::Value;

// The difference of floats that is the largest at each sample; a NaN is the largest there is.
class LargestDifferences {
 public:
  explicit LargestDifferences(std::size_t samples) : values_(samples) {}

  void add(const std::string& output, const std::vector<float>& expected, const std::vector<float>& actual) {
    if (expected.size() != actual.size() || values_.empty()) return;
    const std::size_t components = expected.size() / values_.size();
    for (std::size_t n = 0; n < expected.size(); ++n) {
      if (std::bit_cast<std::uint32_t>(expected[n]) == std::bit_cast<std::uint32_t>(actual[n])) continue;
      if (std::isnan(expected[n]) && std::isnan(actual[n])) continue;
      const double difference = std::abs(double{expected[n]} - actual[n]);
      Value value{n / components, output, fmt::format("{:.9g}", expected[n]), fmt::format("{:.9g}", actual[n]),
                  std::isnan(difference) ? HUGE_VAL : std::max(difference, 0x1p-149)};
      if (components > 1) value.output += fmt::format(" {}", n % components);
      Value& largest = values_[value.sample];
      if (value.error > largest.error) largest = value;
    }
  }
  std::vector<Value> found() const {
    std::vector<Value> found;
    std::copy_if(values_.begin(), values_.end(), std::back_inserter(found), [](const Value& v) { return v.error > 0; });
    return found;
  }

 private:
  std::vector<Value> values_;
};

std::vector<Value> differing_values(const corpus::Scene& scene, const corpus::Image& expected,
                                    const corpus::Image& actual, std::size_t samples) {
  LargestDifferences largest(samples);
  largest.add("depth", expected.depth, actual.depth);
  largest.add("barycentric", expected.barycentrics, actual.barycentrics);
  for (std::size_t k = 0; k < std::min(expected.attributes.size(), actual.attributes.size()); ++k) {
    largest.add(scene.attributes[k].name, expected.attributes[k], actual.attributes[k]);
  }
  return largest.found();
}

std::vector<Value> differing_indices(const corpus::Image& expected, const corpus::Image& actual) {
  const auto name = [](std::uint32_t index) { return index == kNoTriangle ? "none" : std::to_string(index); };
  std::vector<Value> values;
  for (std::size_t s = 0; s < expected.index.size(); ++s) {
    if (expected.index[s] == actual.index[s]) continue;
    values.push_back({s, "index", name(expected.index[s]), name(actual.index[s]), 1});
  }
  return values;
}

}  // namespace

Evidence gather_evidence(const corpus::Scene& scene, const properties::Renderer& expected,
                         const properties::Renderer& actual) {
  Evidence evidence;
  if (!expected) return evidence;
  const corpus::Outputs outputs = properties::outputs_of(scene);
  corpus::Frame wanted(scene, outputs), got(scene, outputs);
  if (expected(wanted.target(), wanted.draws()) != Status::ok) return evidence;
  bool answered = false;
  try {
    answered = actual && actual(got.target(), got.draws()) == Status::ok;
  } catch (const std::exception&) {
    // No answer: the finding says why.
  }
  std::vector<std::uint8_t> marks(wanted.image().count.size(), 0);
  std::vector<Value> values;
  if (answered) {
    if (mark(wanted.image().count, got.image().count, marks)) {
      evidence.what = "count";
    } else if (mark(wanted.image().index, got.image().index, marks)) {
      evidence.what = "index";
      values = differing_indices(wanted.image(), got.image());
    } else {
      values = differing_values(scene, wanted.image(), got.image(), marks.size());
      if (!values.empty()) evidence.what = "values";
      for (const Value& value : values) marks[value.sample] = 1;
    }
  }
  properties::Exhibit exhibit{scene.width,          scene.height, scene.samples, evidence.what,
                              wanted.image().count, {},           marks,         values};
  if (answered) exhibit.actual = got.image().count;
  return evidence_of(exhibit);
}

Evidence evidence_of(const properties::Exhibit& exhibit) {
  Evidence evidence;
  evidence.what = exhibit.output;
  const auto samples = static_cast<std::size_t>(exhibit.samples), width = static_cast<std::size_t>(exhibit.width);
  const auto first = std::find(exhibit.differs.begin(), exhibit.differs.end(), 1);
  const std::size_t pixel =
      first == exhibit.differs.end() ? 0 : static_cast<std::size_t>(first - exhibit.differs.begin()) / samples;
  const auto begin = [](int centre, int size) {
    return std::clamp(centre - kEvidenceSize / 2, 0, std::max(0, size - kEvidenceSize));
  };
  evidence.samples = exhibit.samples;
  evidence.width = std::min(exhibit.width, kEvidenceSize);
  evidence.height = std::min(exhibit.height, kEvidenceSize);
  evidence.x0 = begin(static_cast<int>(pixel % width), exhibit.width);
  evidence.y0 = begin(static_cast<int>(pixel / width), exhibit.height);
  std::map<std::size_t, const Value*> values;
  for (const Value& value : exhibit.values) values.emplace(value.sample, &value);
  for (int y = evidence.y0; y < evidence.y0 + evidence.height; ++y) {
    for (int x = evidence.x0; x < evidence.x0 + evidence.width; ++x) {
      for (std::size_t n = 0; n < samples; ++n) {
        const std::size_t s = (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * samples + n;
        evidence.expected.push_back(exhibit.expected[s]);
        if (!exhibit.actual.empty()) evidence.actual.push_back(exhibit.actual[s]);
        if (const auto value = values.find(s); value != values.end()) {
          evidence.values.push_back(*value->second);
          evidence.values.back().sample = evidence.differs.size();
        }
        evidence.differs.push_back(exhibit.differs[s]);
      }
    }
  }
  return evidence;
}

}  // namespace surefill::certify
