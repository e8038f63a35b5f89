// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <sstream>
#include <vector>

#include "certify/run/judge.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::certify {

namespace {

using corpus::Image;
using corpus::Scene;

constexpr std::size_t kMostSamples = 64;  // shown, unless all are asked for
constexpr int kMapWidth = 100, kMapHeight = 64;

// One value of a sample, as text.
struct Value {
  std::string name, text;
};

std::string number(float value) {
  return fmt::format("{:a} ({:.9g})", value, value);
}

// All that an image says of a sample.
std::vector<Value> values_at(const Scene& scene, const Image& image, std::size_t sample) {
  std::vector<Value> values;
  if (!image.count.empty()) values.push_back({"count", std::to_string(image.count[sample])});
  if (!image.index.empty()) {
    const std::uint32_t index = image.index[sample];
    values.push_back({"index", index == kNoTriangle ? "none" : std::to_string(index)});
  }
  if (!image.depth.empty()) values.push_back({"depth", number(image.depth[sample])});
  if (!image.barycentrics.empty()) {
    for (std::size_t k = 0; k < 3; ++k) {
      values.push_back({fmt::format("b{}", k), number(image.barycentrics[3 * sample + k])});
    }
  }
  for (std::size_t a = 0; a < image.attributes.size(); ++a) {
    const std::size_t components = scene.attributes[a].components;
    if (image.attributes[a].empty()) continue;
    for (std::size_t k = 0; k < components; ++k) {
      const std::string name = scene.attributes[a].name + (components > 1 ? fmt::format("[{}]", k) : "");
      values.push_back({name, number(image.attributes[a][components * sample + k])});
    }
  }
  return values;
}

// Do the two differ there? NaNs are alike in text, and -0 and +0 are not.
bool differs(const std::vector<Value>& a, const std::vector<Value>& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), b.end(),
                     [](const Value& x, const Value& y) { return x.text == y.text; });
}

// Counts as characters, one a pixel: '.' is 0, '+' is over 9 or over several samples; '!' marks a difference in any
// output.
std::string coverage_map(const Scene& scene, const Image& image, const std::vector<bool>& marked) {
  std::string map;
  const std::size_t samples = static_cast<std::size_t>(scene.samples);
  for (int y = 0; y < scene.height; ++y) {
    map += "    ";
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x);
      std::uint32_t count = 0;
      bool mark = false;
      for (std::size_t n = 0; n < samples; ++n) {
        count = std::max(count, image.count[pixel * samples + n]);
        mark = mark || (!marked.empty() && marked[pixel * samples + n]);
      }
      map += mark ? '!' : count == 0 ? '.' : count > 9 ? '+' : static_cast<char>('0' + count);
    }
    map += '\n';
  }
  return map;
}

bool fits_a_map(const Scene& scene) {
  return scene.width <= kMapWidth && scene.height <= kMapHeight;
}

}  // namespace

Replay replay(const Scene& original, const std::string& name, const ReplayOptions& options) {
  const properties::Renderer other = options.rival           ? adapters::rival_renderer(*options.rival)
                                     : options.second_oracle ? properties::clipped_oracle_renderer()
                                                             : properties::engine_renderer();
  const char* other_name = options.rival ? "rival" : options.second_oracle ? "second oracle" : "engine";
  const Scene scene = options.rival ? adapters::scene_under_model(original, options.rival->info()) : original;
  Replay result;
  std::string& text = result.text;
  text = fmt::format("{}: {} x {}", name, scene.width, scene.height);
  if (scene.samples > 1) text += fmt::format(", {} samples a pixel", scene.samples);
  std::size_t triangles = 0;
  for (const corpus::SceneDraw& draw : scene.draws) triangles += draw.triangles.size();
  text += fmt::format(", {} draw{}, {} triangle{}\n", scene.draws.size(), scene.draws.size() == 1 ? "" : "s", triangles,
                      triangles == 1 ? "" : "s");
  std::istringstream comment(scene.comment);
  for (std::string line; std::getline(comment, line);) text += "  # " + line + "\n";

  const corpus::Outputs outputs = properties::outputs_of(scene);
  corpus::Frame expected(scene, outputs), actual(scene, outputs);
  const Status expected_status = properties::oracle_renderer()(expected.target(), expected.draws());
  Status actual_status = Status::ok;
  try {
    actual_status = other(actual.target(), actual.draws());
  } catch (const adapters::RivalSkips& lacking) {
    text += fmt::format("  not drawn: the rival lacks {}\n", lacking.what());
    return result;
  } catch (const adapters::RivalFailure& failure) {
    text += fmt::format("  {}\n", failure.what());
    result.equal = false;
    return result;
  }
  if (expected_status != Status::ok) {
    text += fmt::format("  this is no frame that can be drawn: {}\n", status_text(expected_status));
    result.equal = false;
    return result;
  }
  if (actual_status != Status::ok) {
    text += fmt::format("  the {} returned \"{}\"\n", other_name, status_text(actual_status));
    result.equal = false;
    return result;
  }

  const properties::Comparison comparison = options.rival
                                                ? properties::compare(scene, expected.image(), actual.image(), 16)
                                                : judge(scene, properties::oracle_renderer(), other, 16);
  result.equal = comparison.differences == 0;
  for (const properties::Difference& difference : comparison.first) {
    if (difference.output == "vertex") text += "  " + describe_finding(difference, scene.samples) + "\n";
  }
  const std::size_t total = sample_total(expected.target());
  std::vector<bool> marked(total, false);
  std::size_t shown = 0, differing = 0;
  const std::size_t samples = static_cast<std::size_t>(scene.samples);
  const std::size_t width = static_cast<std::size_t>(scene.width);
  std::string list;
  for (std::size_t sample = 0; sample < total; ++sample) {
    const std::vector<Value> wanted = values_at(scene, expected.image(), sample);
    const std::vector<Value> got = values_at(scene, actual.image(), sample);
    marked[sample] = differs(wanted, got);
    if (marked[sample]) ++differing;
    if (!options.all && (!marked[sample] || shown == kMostSamples)) continue;
    ++shown;
    const std::size_t pixel = sample / samples;
    list += fmt::format("  pixel ({}, {})", pixel % width, pixel / width);
    if (samples > 1) list += fmt::format(" sample {}", sample % samples);
    list += '\n';
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const bool same = wanted[i].text == got[i].text;
      list += fmt::format("  {} {:<8} oracle {:<34} {} {}\n", same ? ' ' : '!', wanted[i].name, wanted[i].text,
                          other_name, got[i].text);
    }
  }
  if (fits_a_map(scene) && !expected.image().count.empty()) {
    text += "  counts, oracle:\n" + coverage_map(scene, expected.image(), {});
    if (differing > 0) {
      text += fmt::format("  counts, {}, '!' where any output differs:\n", other_name);
      text += coverage_map(scene, actual.image(), marked);
    }
  }
  text += list;
  if (differing > shown)
    text += fmt::format("  ... and {} more samples that differ (--all shows them)\n", differing - shown);
  text += result.equal ? fmt::format("  equal: oracle = {}, {} samples\n", other_name, total)
                       : fmt::format("  DIFFERENT: {} of {} samples\n", differing, total);
  return result;
}

}  // namespace surefill::certify
