// SPDX-License-Identifier: Apache-2.0
#include "certify/run/evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

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

// Errors of floats, the largest of each sample; a NaN is the largest there is.
void add_errors(const std::vector<float>& expected, const std::vector<float>& actual, std::vector<double>& errors) {
  if (expected.size() != actual.size() || errors.empty()) return;
  const std::size_t components = expected.size() / errors.size();
  for (std::size_t n = 0; n < expected.size(); ++n) {
    if (std::bit_cast<std::uint32_t>(expected[n]) == std::bit_cast<std::uint32_t>(actual[n])) continue;
    const double difference = std::abs(static_cast<double>(expected[n]) - actual[n]);
    double& error = errors[n / components];
    error = std::max(error, std::isnan(difference) ? HUGE_VAL : std::max(difference, 0x1p-149));
  }
}

bool mark_values(const corpus::Image& expected, const corpus::Image& actual, std::vector<std::uint8_t>& marks) {
  std::vector<double> errors(marks.size(), 0);
  add_errors(expected.depth, actual.depth, errors);
  add_errors(expected.barycentrics, actual.barycentrics, errors);
  for (std::size_t k = 0; k < std::min(expected.attributes.size(), actual.attributes.size()); ++k) {
    add_errors(expected.attributes[k], actual.attributes[k], errors);
  }
  const double largest = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
  if (largest == 0) return false;
  std::transform(errors.begin(), errors.end(), marks.begin(), [largest](double e) { return e >= largest / 2 ? 1 : 0; });
  return true;
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
  if (answered) {
    if (mark(wanted.image().count, got.image().count, marks)) {
      evidence.what = "count";
    } else if (mark(wanted.image().index, got.image().index, marks)) {
      evidence.what = "index";
    } else if (mark_values(wanted.image(), got.image(), marks)) {
      evidence.what = "values";
    }
  }
  properties::Exhibit exhibit{scene.width, scene.height, scene.samples, evidence.what, wanted.image().count, {}, marks};
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
  for (int y = evidence.y0; y < evidence.y0 + evidence.height; ++y) {
    for (int x = evidence.x0; x < evidence.x0 + evidence.width; ++x) {
      for (std::size_t n = 0; n < samples; ++n) {
        const std::size_t s = (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * samples + n;
        evidence.expected.push_back(exhibit.expected[s]);
        if (!exhibit.actual.empty()) evidence.actual.push_back(exhibit.actual[s]);
        evidence.differs.push_back(exhibit.differs[s]);
      }
    }
  }
  return evidence;
}

}  // namespace surefill::certify
