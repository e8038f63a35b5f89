// SPDX-License-Identifier: Apache-2.0
#include "fuzz/one_triangle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "fuzz/finding.hpp"
#include "fuzz/gmp_memory.hpp"
#include "oracle/oracle.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::fuzz {
namespace {

constexpr std::size_t kMaxSamples = 256;
constexpr std::size_t kEverything = 255;  // in tail byte 0
constexpr std::array<std::uint32_t, 3> kIndices{0, 1, 2};
constexpr Options kReference{1, Path::reference};  // the target "paths" is for the other one

// The buffers of one image. Static: not on the heap.
struct Buffers {
  std::array<std::uint32_t, kMaxSamples> count, index;
  std::array<float, kMaxSamples> depth, attribute;
  std::array<float, 3 * kMaxSamples> barycentrics;
};
Buffers actual, expected;

struct Sample {
  int x, y, n;
};

class Case {
 public:
  Case(const char* name, const OneTriangle& triangle, std::span<const std::uint8_t> tail)
      : name_(name), triangle_(triangle), tail_(tail), look_(tail_.byte()) {
    frame_.width = triangle.width;
    frame_.height = triangle.height;
    frame_.samples = triangle.samples;
    frame_.depth_test = triangle.depth_test;
    frame_.attribute_location = triangle.attribute_location;
    total_ = sample_total(frame_);
    array_ = {triangle.attribute, 1, 0, triangle.interpolation.value_or(Interpolation::flat)};
    draw_.vertices = triangle.vertices;
    draw_.indices = kIndices;
    if (triangle.interpolation) draw_.attributes = {&array_, 1};
    draw_.state() = triangle.state();
    choose_samples();
  }

  void check() {
    Target counts = frame_;
    counts.count = std::span(actual.count).first(total_);
    if (!draws(counts)) return fail();
    const Target values = target_of(expected);
    oracle::Probe probe(values, draw_, 0);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < chosen_count_; ++i) {
      const Sample s = chosen_[i];
      const bool covers = probe.covers(s.x, s.y, s.n);
      if (actual.count[place(s)] != (covers ? 1u : 0u)) return fail();
      if (covers) chosen_[covered++] = s;
    }
    draw_.scissor = window_at(covered == 0 ? Sample{0, 0, 0} : chosen_[look_ % covered]);
    check_window(probe, values);
  }

 private:
  // Nothing says more than the whole image, drawn again by both.
  [[noreturn]] void fail() const {
    const corpus::Scene scene = scene_of(triangle_);
    const auto engine = [](const Target& target, std::span<const Draw> draws) {
      return render(target, draws, nullptr, kReference);
    };
    const properties::Comparison whole = properties::compare(scene, properties::oracle_renderer(), engine, {}, 1);
    report_finding(name_,
                   whole.differences == 0 ? "the image within a scissor, or at a sample, is not that of the whole (M3)"
                                          : properties::describe(whole.first.at(0), scene.samples),
                   corpus::write_scene(scene));
  }

  bool draws(const Target& target) const { return render(target, {&draw_, 1}, nullptr, kReference) == Status::ok; }

  std::size_t place(Sample s) const {
    return static_cast<std::size_t>((s.y * frame_.width + s.x) * frame_.samples + s.n);
  }
  Sample sample_at(std::size_t place) const {
    const int at = static_cast<int>(place), pixel = at / frame_.samples;
    return {pixel % frame_.width, pixel / frame_.width, at % frame_.samples};
  }

  Target target_of(Buffers& buffers) {
    Target target = frame_;
    target.index = std::span(buffers.index).first(total_);
    target.depth = std::span(buffers.depth).first(total_);
    target.barycentrics = std::span(buffers.barycentrics).first(3 * total_);
    AttributeTarget& attribute = &buffers == &actual ? actual_attribute_ : expected_attribute_;
    attribute = {std::span(buffers.attribute).first(total_), 1};
    if (triangle_.interpolation) target.attributes = {&attribute, 1};
    return target;
  }

  // Where values are compared: up to 2 x 2 pixels with one sample each, one pixel with several, or the whole.
  Scissor window_at(Sample from) const {
    if (look_ == kEverything) return {0, 0, frame_.width, frame_.height};
    const int side = frame_.samples == 1 ? 2 : 1;
    return {from.x, from.y, std::min(from.x + side, frame_.width), std::min(from.y + side, frame_.height)};
  }

  void check_window(oracle::Probe& probe, const Target& values) {
    const Target target = target_of(actual);
    if (!draws(target)) return fail();
    const Scissor& window = *draw_.scissor;
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        if (!check_pixel(probe, values, x, y)) return fail();
      }
    }
  }

  bool check_pixel(oracle::Probe& probe, const Target& values, int x, int y) {
    constexpr int kMostValues = 4;  // of one pixel, unless everything is asked for
    bool stored = false;
    int compared = 0;
    for (int n = 0; n < frame_.samples; ++n) {
      const std::size_t s = place({x, y, n});
      const bool covers = probe.covers(x, y, n);
      if (actual.index[s] != (covers ? 0u : kNoTriangle)) return false;
      if (!covers || (compared == kMostValues && look_ != kEverything)) continue;
      ++compared;
      if (!stored) probe.store_values(x, y, 0);  // once per pixel (M1)
      stored = true;
      if (!same(actual.depth[s], probe.depth(x, y, n))) return false;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!same(actual.barycentrics[3 * s + i], expected.barycentrics[i])) return false;
      }
      if (!values.attributes.empty() && !same(actual.attribute[s], expected.attribute[0])) return false;
    }
    return true;
  }

  static bool same(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

  // Eight by the input, eight where an edge function is nearest to 0 against the size of its terms; or all.
  void choose_samples() {
    const std::size_t first = tail_.byte(), step = 2 * std::size_t{tail_.byte()} + 1;
    constexpr std::size_t kNearest = 8;
    if (look_ == kEverything || total_ <= 2 * kNearest) {
      for (; chosen_count_ < total_; ++chosen_count_) chosen_[chosen_count_] = sample_at(chosen_count_);
      return;
    }
    std::array<double, kNearest> distance;
    distance.fill(HUGE_VAL);
    std::array<std::size_t, kNearest> nearest{};
    std::array<std::array<double, 3>, 3> edge;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &j = triangle_.vertices[(i + 1) % 3], &k = triangle_.vertices[(i + 2) % 3];
      const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
      edge[i] = {jy * kw - jw * ky, jw * kx - jx * kw, jx * ky - jy * kx};
    }
    for (std::size_t s = 0; s < total_; ++s) {
      const Sample at = sample_at(s);
      const SampleLocation location = sample_location(frame_.samples, at.n);
      const double x = at.x + location.x / 16.0, y = at.y + location.y / 16.0;
      double least = HUGE_VAL;
      for (const auto& [a, b, c] : edge) {
        const double size = std::fabs(a) * x + std::fabs(b) * y + std::fabs(c);
        least = std::fmin(least, size > 0 ? std::fabs(a * x + b * y + c) / size : 0);
      }
      if (!(least < distance.back())) continue;
      std::size_t at_rank = kNearest - 1;
      for (; at_rank > 0 && least < distance[at_rank - 1]; --at_rank) {
        distance[at_rank] = distance[at_rank - 1], nearest[at_rank] = nearest[at_rank - 1];
      }
      distance[at_rank] = least, nearest[at_rank] = s;
    }
    for (std::size_t i = 0; i < kNearest; ++i) {
      chosen_[chosen_count_++] = sample_at(nearest[i]);
      chosen_[chosen_count_++] = sample_at((first + i * step) % total_);
    }
  }

  const char* name_;
  const OneTriangle& triangle_;
  ByteReader tail_;
  std::size_t look_;
  Target frame_;
  Draw draw_;
  AttributeArray array_;
  AttributeTarget actual_attribute_, expected_attribute_;
  std::size_t total_ = 0, chosen_count_ = 0;
  std::array<Sample, kMaxSamples> chosen_;
};

}  // namespace

void check_one_triangle(const char* target, const OneTriangle& triangle, std::span<const std::uint8_t> tail) {
  static const bool memory_set = (GmpMemory::use(), true);
  (void)memory_set;
  Case(target, triangle, tail).check();
}

}  // namespace surefill::fuzz
