// SPDX-License-Identifier: Apache-2.0
//
// The second oracle. No edge function appears here: a triangle is clipped to the neighbourhood of the target and
// projected, and samples are located in what is left; depth and attributes are taken where the ray through the sample
// meets the triangle's plane in the space (X, Y, W).
#include <algorithm>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <vector>

#include "oracle/clipped_draw.hpp"
#include "oracle/oracle.hpp"

namespace surefill::oracle::clipped {

namespace {

// S4
constexpr Location kCentre{8, 8};
constexpr Location kLocations2[] = {{12, 12}, {4, 4}};
constexpr Location kLocations4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
constexpr Location kLocations8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
constexpr Location kLocations16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                     {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};

std::span<const Location> standard_locations(int samples) {
  switch (samples) {
    case 2:
      return kLocations2;
    case 4:
      return kLocations4;
    case 8:
      return kLocations8;
    case 16:
      return kLocations16;
    default:
      return {&kCentre, 1};
  }
}

// All lines of a draw, on `threads` threads.
void render_lines(DrawRun& run, int threads) {
  const auto render_every = [&run, threads](int first) {
    for (int line = first; line < run.lines(); line += std::max(threads, 1)) run.render_line(line);
  };
  std::vector<std::future<void>> others;
  for (int first = 1; first < std::min(threads, run.lines()); ++first) {
    others.push_back(std::async(std::launch::async, render_every, first));
  }
  render_every(0);
  for (std::future<void>& other : others) other.get();
}

// V4: puts all fragments of a sample in the order of the layers. They come in the order of draws and in each of V2;
// those of equal depth keep it, or have it turned round (V5).
void sort(std::vector<Candidate>& fragments, DepthTest test) {
  if (test == DepthTest::less_equal || test == DepthTest::greater_equal) std::ranges::reverse(fragments);
  std::ranges::stable_sort(
      fragments, [test](const Candidate& a, const Candidate& b) { return is_nearer(test, a.depth, b.depth); });
}

void store_layers(Frame& frame) {
  const Target& target = frame.target;
  const std::size_t samples = frame.locations.size(), layers = static_cast<std::size_t>(target.layers);
  for (std::size_t s = 0; s < frame.total; ++s) {
    std::vector<Candidate>& fragments = frame.candidates[s];
    sort(fragments, target.depth_test);
    for (std::size_t n = 0; n < layers; ++n) {
      const std::size_t place = n * frame.total + s;
      const bool held = n < fragments.size();
      if (!target.depth.empty()) target.depth[place] = held ? fragments[n].depth : frame.depth[s];
      if (!held) continue;
      if (!target.index.empty()) target.index[place] = fragments[n].triangle->index;
      if (!frame.wants_values) continue;
      const std::size_t pixel = s / samples, width = static_cast<std::size_t>(target.width);
      fragments[n].run->store_values(*fragments[n].triangle, static_cast<int>(pixel % width),
                                     static_cast<int>(pixel / width), place);
    }
    if (!frame.visible.empty() && !fragments.empty()) frame.visible[s] = fragments[0];
  }
}

// The attributes of empty samples (V1); what lies between them is not the image's.
void clear(const AttributeTarget& image, std::size_t samples) {
  for (std::size_t s = 0; s < samples && !image.values.empty(); ++s) {
    const std::size_t begin = image.stride == 0 ? s * image.components : s * image.stride;
    std::ranges::fill(image.values.subspan(begin, image.components), 0.0f);
  }
}

}  // namespace

Frame::Frame(const Target& target_asked, std::span<const Draw> draws) : target(target_asked) {
  for (const Location& location : standard_locations(target.samples)) locations.push_back(location);
  for (std::size_t n = 0; n < target.sample_locations.size(); ++n) {
    locations[n] = {target.sample_locations[n].x, target.sample_locations[n].y};
  }
  total = static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height) * locations.size();
  bool numbers = false;
  for (const Draw& draw : draws) {
    conservative |= draw.conservative != Conservative::none;
    numbers |= !draw.visible.empty();
  }
  wants_values = !target.barycentrics.empty();
  for (const AttributeTarget& attribute : target.attributes) wants_values |= !attribute.values.empty();
  wants_visible = !conservative && (wants_values || numbers || !target.index.empty() || !target.depth.empty());
  if (!wants_visible) return;
  depth.assign(total, std::numeric_limits<float>::infinity());
  if (is_nearer(target.depth_test, 1, 0)) depth.assign(total, -std::numeric_limits<float>::infinity());
  open.assign(total, target.initial_depth.empty());
  if (!target.initial_depth.empty()) depth.assign(target.initial_depth.begin(), target.initial_depth.end());
  if (numbers) visible.resize(total);
  if (target.layers > 1) candidates.resize(total);
}

void render(const Target& target, std::span<const Draw> draws, int threads) {
  Frame frame(target, draws);
  std::ranges::fill(target.count, 0u);
  std::ranges::fill(target.winding, 0);
  std::ranges::fill(target.index, kNoTriangle);
  std::ranges::fill(target.barycentrics, 0.0f);
  for (const AttributeTarget& out : target.attributes)
    clear(out, frame.total * static_cast<std::size_t>(target.layers));
  for (const Draw& draw : draws) {
    std::ranges::fill(draw.covered, 0u);
    std::ranges::fill(draw.visible, 0u);
  }

  std::vector<std::unique_ptr<DrawRun>> runs;  // kept if fragments outlive them
  for (const Draw& draw : draws) {
    if (frame.visible.empty() && frame.candidates.empty()) runs.clear();
    runs.push_back(std::make_unique<DrawRun>(frame, draw));
    render_lines(*runs.back(), threads);
  }
  if (!frame.candidates.empty()) {
    store_layers(frame);
  } else if (!target.depth.empty()) {
    std::ranges::copy(frame.depth, target.depth.begin());
  }
  for (const Candidate& seen : frame.visible) {
    if (seen.triangle != nullptr && !seen.run->draw().visible.empty()) {
      ++seen.run->draw().visible[seen.triangle->position];
    }
  }
}

}  // namespace surefill::oracle::clipped
