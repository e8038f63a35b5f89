// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>
#include <vector>

#include "certify/run/judge.hpp"
#include "certify/run/progress.hpp"
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
      target.width,   target.height,       target.samples, target.depth_test, !target.initial_depth.empty(),
      actual.draws(), target.initial_depth};
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

template <typename Value>
bool same_bits_at(const std::vector<Value>& a, const std::vector<Value>& b, std::size_t sample, std::size_t samples) {
  if (a.size() != b.size()) return false;
  const std::size_t components = a.size() / samples;
  return std::memcmp(a.data() + components * sample, b.data() + components * sample, components * sizeof(Value)) == 0;
}

// Of these no words need be made.
bool same_bits(const Image& a, const Image& b, std::size_t sample, std::size_t samples) {
  bool same = same_bits_at(a.count, b.count, sample, samples) && same_bits_at(a.index, b.index, sample, samples) &&
              same_bits_at(a.depth, b.depth, sample, samples) &&
              same_bits_at(a.barycentrics, b.barycentrics, sample, samples) &&
              a.attributes.size() == b.attributes.size();
  for (std::size_t k = 0; same && k < a.attributes.size(); ++k) {
    same = same_bits_at(a.attributes[k], b.attributes[k], sample, samples);
  }
  return same;
}

// The samples of an image that differ, in words. `first`: the number of its first sample.
struct Listing {
  std::size_t total = 0, differing = 0, shown = 0;
  std::string list;

  void add(const Scene& scene, const Image& expected, const Image& actual, std::size_t first, const char* other_name,
           bool all, std::vector<bool>& marked) {
    total += marked.size();
    for (std::size_t sample = 0; sample < marked.size(); ++sample) {
      if (!all && same_bits(expected, actual, sample, marked.size())) continue;
      const std::vector<Value> wanted = values_at(scene, expected, sample), got = values_at(scene, actual, sample);
      marked[sample] = differs(wanted, got);
      if (marked[sample]) ++differing;
      if (!all && (!marked[sample] || shown == kMostSamples)) continue;
      ++shown;
      list += sample_text(scene, first + sample);
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const bool same = wanted[i].text == got[i].text;
        list += fmt::format("  {} {:<8} oracle {:<34} {} {}\n", same ? ' ' : '!', wanted[i].name, wanted[i].text,
                            other_name, got[i].text);
      }
    }
  }

  std::string end(const char* other_name, bool equal) const {
    std::string text = list;
    if (differing > shown) {
      text += fmt::format("  ... and {} more samples that differ (--all shows them)\n", differing - shown);
    }
    return text + (equal ? fmt::format("  equal: oracle = {}, {} samples\n", other_name, total)
                         : fmt::format("  DIFFERENT: {} of {} samples\n", differing, total));
  }
};

// A frame that is drawn at once takes some hundred bytes a sample.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 22;  // samples

bool is_drawn_in_bands(const Scene& scene) {
  const auto across = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.samples);
  return across * static_cast<std::size_t>(scene.height) > kMostAtOnce && scene.layers == 1 &&
         scene.more == corpus::MoreOutputs{};
}

// Rows y to y + rows - 1 of the scene: by S6 the same samples.
Scene band_of(const Scene& scene, int y, int rows) {
  Scene band = scene;
  band.height = rows;
  band.origin.y += y;
  const auto across = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.samples);
  if (scene.initial_depth.size() > 1) {
    const auto begin = scene.initial_depth.begin() + static_cast<std::ptrdiff_t>(across * static_cast<std::size_t>(y));
    band.initial_depth.assign(begin, begin + static_cast<std::ptrdiff_t>(across * static_cast<std::size_t>(rows)));
  }
  return band;
}

// A frame that is too large to be drawn at once, band by band, so that memory stays bounded and the time left is seen.
void replay_in_bands(const Scene& scene, const properties::Renderer& other, const char* other_name,
                     const ReplayOptions& options, Replay& result) {
  const auto across = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.samples);
  const int most = static_cast<int>(std::max<std::size_t>(kMostAtOnce / across, 1));
  result.text += fmt::format("  drawn in bands of {} rows, each with its own origin (S6)\n", most);
  const corpus::Outputs outputs = properties::outputs_of(scene);
  Listing listing;
  Progress progress;
  for (int y = 0; y < scene.height && !interrupted(); y += most) {
    progress.show(fmt::format("replay: row {} of {}", y, scene.height), y, scene.height);
    const Scene band = band_of(scene, y, std::min(most, scene.height - y));
    corpus::Frame expected(band, outputs), actual(band, outputs);
    const Status statuses[] = {properties::oracle_renderer()(expected.target(), expected.draws()),
                               other(actual.target(), actual.draws())};
    for (const Status status : statuses) {
      if (status == Status::ok) continue;
      progress.clear();
      result.text += fmt::format("  rows from {}: \"{}\"\n", y, status_text(status));
      result.equal = false;
      return;
    }
    std::vector<bool> marked(sample_total(expected.target()), false);
    listing.add(band, expected.image(), actual.image(), across * static_cast<std::size_t>(y), other_name, options.all,
                marked);
  }
  progress.clear();
  result.equal = listing.differing == 0 && !interrupted();
  result.text += interrupted() ? std::string("  interrupted\n") : listing.end(other_name, result.equal);
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

  if (!rival && is_drawn_in_bands(scene)) {
    // The vertices that pass a viewport, and whether it is a frame at all, are the same in every band.
    for (const properties::Difference& difference :
         judge(band_of(scene, 0, 1), properties::oracle_renderer(), other, 16).first) {
      if (difference.output != "vertex") continue;
      text += "  " + describe_finding(difference, scene.samples) + "\n";
      result.equal = false;
    }
    const bool vertices = result.equal;
    replay_in_bands(scene, other, other_name, options, result);
    result.equal = result.equal && vertices;
    return result;
  }
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
  std::vector<bool> marked(sample_total(expected.target()), false);
  Listing listing;
  listing.add(scene, expected.image(), actual.image(), 0, other_name, options.all, marked);
  if (fits_a_map(scene) && !expected.image().count.empty()) {
    text += "  counts, oracle:\n" + coverage_map(scene, expected.image(), {});
    if (listing.differing > 0) {
      text += fmt::format("  counts, {}, '!' where any output differs:\n", other_name);
      text += coverage_map(scene, actual.image(), marked);
    }
  }
  text += listing.end(other_name, result.equal);
  return result;
}

}  // namespace surefill::certify
