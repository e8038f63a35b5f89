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

std::string head_of(const Scene& scene, const std::string& name) {
  std::string text = fmt::format("{}: {} x {}", name, scene.width, scene.height);
  if (scene.samples > 1) text += fmt::format(", {} samples a pixel", scene.samples);
  std::size_t triangles = 0;
  for (const corpus::SceneDraw& draw : scene.draws) triangles += draw.triangles.size();
  text += fmt::format(", {} draw{}, {} triangle{}\n", scene.draws.size(), scene.draws.size() == 1 ? "" : "s", triangles,
                      triangles == 1 ? "" : "s");
  std::istringstream comment(scene.comment);
  for (std::string line; std::getline(comment, line);) text += "  # " + line + "\n";
  return text;
}

std::string sample_text(const Scene& scene, std::size_t sample) {
  const auto samples = static_cast<std::size_t>(scene.samples), width = static_cast<std::size_t>(scene.width);
  const std::size_t pixel = sample / samples;
  std::string text = fmt::format("  pixel ({}, {})", pixel % width, pixel / width);
  if (samples > 1) text += fmt::format(" sample {}", sample % samples);
  return text + '\n';
}

// A rival by section 11: what its model says of the count, and what it drew. `actual` is its image.
void replay_by_model(const Scene& scene, const RivalSubject& subject, const corpus::Frame& actual,
                     const ReplayOptions& options, Replay& result) {
  const Target& target = actual.target();
  const judge::Frame frame{
      target.width, target.height, target.samples, target.depth_test, !target.initial_depth.empty(), actual.draws()};
  const Image& image = actual.image();
  std::string& text = result.text;
  const std::string open = judge::why_open(subject.terms, frame);
  if (!open.empty()) {
    text += fmt::format("  not judged: {}\n", open);
  }
  const judge::Counts counts = judge::counts_under(adapters::oracle_expected(), subject.terms, frame);
  judge::Judgement judgement;
  if (open.empty()) {
    judgement = judge::judge_image(adapters::oracle_expected(), subject.terms, frame, image, {}, scene.attributes);
  } else {
    judgement.differs.assign(counts.least.size(), 0);
  }
  result.equal = judgement.differences == 0;
  std::vector<bool> marked;
  for (const std::uint8_t differs : judgement.differs) marked.push_back(differs != 0);
  if (fits_a_map(scene) && !image.count.empty()) {
    Image wanted;
    wanted.count = counts.least;
    text += subject.terms.known ? "  counts, its model ('?' where that leaves it open):\n"
                                : "  counts that every model has ('?' where they may differ):\n";
    std::string map = coverage_map(scene, wanted, {});
    for (std::size_t s = 0, row = 0; s < counts.least.size() && scene.samples == 1; ++s) {
      const auto width = static_cast<std::size_t>(scene.width);
      row = s / width;
      if (counts.least[s] != counts.most[s]) map[row * (width + 5) + 4 + s % width] = '?';
    }
    text += map + "  counts, rival, '!' where it is wrong:\n" + coverage_map(scene, image, marked);
  }
  std::size_t shown = 0;
  for (std::size_t s = 0; s < marked.size(); ++s) {
    if (!options.all && (!marked[s] || shown == kMostSamples)) continue;
    ++shown;
    text += sample_text(scene, s);
    const std::string count = counts.least[s] == counts.most[s]
                                  ? std::to_string(counts.least[s])
                                  : fmt::format("{} to {}", counts.least[s], counts.most[s]);
    for (const Value& value : values_at(scene, image, s)) {
      text += value.name == "count"
                  ? fmt::format("  {} count    model {:<34} rival {}\n", marked[s] ? '!' : ' ', count, value.text)
                  : fmt::format("    {:<8} {:>40} rival {}\n", value.name, "", value.text);
    }
  }
  if (!judgement.finding.empty()) text += fmt::format("  {}\n", judgement.finding);
  text += result.equal
              ? fmt::format("  as its model says: {} samples judged, {} open\n", judgement.samples, judgement.open)
              : fmt::format("  WRONG: {} of {} samples judged, {} open\n", judgement.differences, judgement.samples,
                            judgement.open);
}

}  // namespace

Replay replay(const Scene& original, const std::string& name, const ReplayOptions& options) {
  adapters::Rival* rival = options.subject ? options.subject->rival : nullptr;
  const properties::Renderer other = rival                   ? adapters::rival_renderer(*rival)
                                     : options.second_oracle ? properties::clipped_oracle_renderer()
                                                             : properties::engine_renderer();
  const char* other_name = rival ? "rival" : options.second_oracle ? "second oracle" : "engine";
  const Scene scene = rival ? adapters::scene_under_model(original, rival->info()) : original;
  Replay result;
  std::string& text = result.text;
  text = head_of(scene, name);

  const corpus::Outputs outputs = properties::outputs_of(scene);
  const bool by_model = rival && !options.subject->strict;
  corpus::Frame expected(scene, outputs);
  corpus::Frame actual(scene, by_model ? outputs_with(*rival, scene) : outputs);
  const Status expected_status = properties::oracle_renderer()(expected.target(), expected.draws());
  Status actual_status = Status::ok;
  try {
    if (by_model) {
      actual_status = validate(actual.target(), actual.draws());
      if (actual_status == Status::ok) rival->draw(actual.target(), actual.draws());
    } else {
      actual_status = other(actual.target(), actual.draws());
    }
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
  if (by_model) {
    replay_by_model(scene, *options.subject, actual, options, result);
    return result;
  }

  const properties::Comparison comparison = rival ? properties::compare(scene, expected.image(), actual.image(), 16)
                                                  : judge(scene, properties::oracle_renderer(), other, 16);
  result.equal = comparison.differences == 0;
  for (const properties::Difference& difference : comparison.first) {
    if (difference.output == "vertex") text += "  " + describe_finding(difference, scene.samples) + "\n";
  }
  const std::size_t total = sample_total(expected.target());
  std::vector<bool> marked(total, false);
  std::size_t shown = 0, differing = 0;
  std::string list;
  for (std::size_t sample = 0; sample < total; ++sample) {
    const std::vector<Value> wanted = values_at(scene, expected.image(), sample);
    const std::vector<Value> got = values_at(scene, actual.image(), sample);
    marked[sample] = differs(wanted, got);
    if (marked[sample]) ++differing;
    if (!options.all && (!marked[sample] || shown == kMostSamples)) continue;
    ++shown;
    list += sample_text(scene, sample);
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
