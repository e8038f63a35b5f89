// SPDX-License-Identifier: Apache-2.0
#include "properties/machinery/compare.hpp"

#include <bit>
#include <cmath>
#include <cstdio>

#include "corpus/outputs.hpp"
#include "oracle/oracle.hpp"

namespace surefill::properties {

namespace {

std::string show(std::uint32_t value) {
  return value == kNoTriangle ? "none" : std::to_string(value);
}

std::string show(std::int32_t value) {
  return std::to_string(value);
}

std::string show(float value) {
  char text[64];
  std::snprintf(text, sizeof text, "%a (%.9g)", static_cast<double>(value), static_cast<double>(value));
  return text;
}

bool same(std::uint32_t a, std::uint32_t b) {
  return a == b;
}

bool same(std::int32_t a, std::int32_t b) {
  return a == b;
}

bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

// One buffer of `components` values a sample. A buffer that only one image has, or of another size, is one difference.
template <typename Value>
void compare_buffer(const std::string& name, const std::vector<Value>& expected, const std::vector<Value>& actual,
                    const corpus::Image& image, std::size_t components, std::size_t keep, Comparison& result) {
  if (expected.size() != actual.size()) {
    ++result.differences;
    if (result.first.size() < keep) {
      result.first.push_back(
          {name, 0, 0, 0, 0, std::to_string(expected.size()) + " values", std::to_string(actual.size()) + " values"});
    }
    return;
  }
  result.values += expected.size();
  const std::size_t samples = static_cast<std::size_t>(image.samples);
  const std::size_t width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (same(expected[i], actual[i])) continue;
    ++result.differences;
    if (result.first.size() >= keep) continue;
    const std::size_t total = width * static_cast<std::size_t>(image.height) * samples;
    const std::size_t layer = i / components / total, sample = i / components % total;
    const std::size_t pixel = sample / samples;
    result.first.push_back({layer == 0 ? name : name + " of layer " + std::to_string(layer),
                            static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                            static_cast<int>(sample % samples), static_cast<int>(i % components), show(expected[i]),
                            show(actual[i])});
  }
}

// The numbers of the triangles of each draw (M10).
void compare_numbers(const std::string& name, const std::vector<std::vector<std::uint64_t>>& expected,
                     const std::vector<std::vector<std::uint64_t>>& actual, std::size_t keep, Comparison& result) {
  const auto differ = [&](std::size_t draw, std::size_t triangle, const std::string& wanted, const std::string& got) {
    ++result.differences;
    if (result.first.size() >= keep) return;
    result.first.push_back({name + " of triangle " + std::to_string(triangle) + " of draw " + std::to_string(draw), 0,
                            0, 0, 0, wanted, got});
  };
  if (expected.size() != actual.size()) {
    return differ(0, 0, std::to_string(expected.size()) + " draws", std::to_string(actual.size()) + " draws");
  }
  for (std::size_t d = 0; d < expected.size(); ++d) {
    result.values += expected[d].size();
    if (expected[d].size() != actual[d].size()) {
      differ(d, 0, std::to_string(expected[d].size()) + " numbers", std::to_string(actual[d].size()) + " numbers");
      continue;
    }
    for (std::size_t t = 0; t < expected[d].size(); ++t) {
      if (expected[d][t] == actual[d][t]) continue;
      differ(d, t, std::to_string(expected[d][t]), std::to_string(actual[d][t]));
    }
  }
}

}  // namespace

Renderer engine_renderer() {
  return [](const Target& target, std::span<const Draw> draws) { return surefill::render(target, draws); };
}

Renderer oracle_renderer() {
  return [](const Target& target, std::span<const Draw> draws) {
    if (const Status status = validate(target, draws); status != Status::ok) return status;
    oracle::render(target, draws);
    return Status::ok;
  };
}

Renderer clipped_oracle_renderer() {
  return [](const Target& target, std::span<const Draw> draws) {
    if (const Status status = validate(target, draws); status != Status::ok) return status;
    oracle::clipped::render(target, draws);
    return Status::ok;
  };
}

corpus::Outputs outputs_of(const corpus::Scene& scene) {
  const bool conservative = corpus::is_conservative(scene);
  corpus::Outputs outputs;
  outputs.attributes = !conservative;
  outputs.numbers = scene.more.numbers;
  corpus::for_each_output([&](const auto& output) { outputs.*output.asked = output.has(scene, conservative); });
  return outputs;
}

Comparison compare(const corpus::Scene& scene, const corpus::Image& expected, const corpus::Image& actual,
                   std::size_t keep) {
  Comparison result;
  result.samples = static_cast<std::uint64_t>(expected.width) * static_cast<std::uint64_t>(expected.height) *
                   static_cast<std::uint64_t>(expected.samples);
  corpus::for_each_output([&](const auto& output) {
    compare_buffer(std::string(output.name), expected.*output.image, actual.*output.image, expected, output.elements,
                   keep, result);
  });
  compare_numbers("covered", expected.covered, actual.covered, keep, result);
  compare_numbers("visible", expected.visible, actual.visible, keep, result);
  if (expected.attributes.size() != actual.attributes.size()) {
    ++result.differences;
    if (result.first.size() < keep) {
      result.first.push_back({"attributes", 0, 0, 0, 0, std::to_string(expected.attributes.size()) + " arrays",
                              std::to_string(actual.attributes.size()) + " arrays"});
    }
    return result;
  }
  for (std::size_t k = 0; k < expected.attributes.size(); ++k) {
    const bool named = k < scene.attributes.size();
    compare_buffer(named ? scene.attributes[k].name : std::string("attribute ").append(std::to_string(k)),
                   expected.attributes[k], actual.attributes[k], expected, named ? scene.attributes[k].components : 1,
                   keep, result);
  }
  return result;
}

Comparison compare(const corpus::Scene& scene, const Renderer& expected, const Renderer& actual,
                   const corpus::Outputs& outputs, std::size_t keep) {
  corpus::Outputs asked = outputs_of(scene);
  corpus::for_each_output([&](const auto& output) { asked.*output.asked &= outputs.*output.asked; });
  asked.attributes = asked.attributes && outputs.attributes;
  asked.numbers = asked.numbers && outputs.numbers;
  corpus::Frame expected_frame(scene, asked);
  corpus::Frame actual_frame(scene, asked);
  const Status expected_status = expected(expected_frame.target(), expected_frame.draws());
  const Status actual_status = actual(actual_frame.target(), actual_frame.draws());
  if (expected_status == Status::ok && actual_status == Status::ok) {
    return compare(scene, expected_frame.image(), actual_frame.image(), keep);
  }
  Comparison result;
  result.samples = sample_total(actual_frame.target());
  result.values = 1;
  result.differences = 1;
  if (keep > 0) {
    result.first.push_back({"status", 0, 0, 0, 0, status_text(expected_status), status_text(actual_status)});
  }
  return result;
}

std::string describe(const Difference& difference, int samples) {
  if (difference.output == "status") {
    return "status: expected \"" + difference.expected + "\", got \"" + difference.actual + "\"";
  }
  std::string line = difference.output;
  if (line.starts_with("covered of") || line.starts_with("visible of")) {
    return line + ": expected " + difference.expected + ", got " + difference.actual;
  }
  if (line == "barycentrics") {
    line = "barycentric b";
    line += std::to_string(difference.component);
  } else if (difference.component > 0) {
    line += '[';
    line += std::to_string(difference.component);
    line += ']';
  }
  line += " at pixel (";
  line += std::to_string(difference.x);
  line += ", ";
  line += std::to_string(difference.y);
  line += ')';
  if (samples > 1) {
    line += " sample ";
    line += std::to_string(difference.sample);
  }
  return line + ": expected " + difference.expected + ", got " + difference.actual;
}

}  // namespace surefill::properties
