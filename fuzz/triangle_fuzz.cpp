// SPDX-License-Identifier: Apache-2.0
//
// One triangle, engine == oracle, bit for bit: the coverage count of every sample; index, depth, barycentrics and
// attribute of the samples in a window of up to four pixels, or of all if the byte after the triangle is 255. The
// window is the oracle's scissor (M3), because exact values cost a thousand times more than exact signs.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "oracle/oracle.hpp"
#include "properties/compare.hpp"

namespace surefill::fuzz {
namespace {

constexpr int kAllValues = 255;
constexpr std::size_t kMaxSamples = 256;

// The oracle's image. Not on the heap, where the address sanitizer makes memory cost more than the oracle.
struct OracleImage {
  std::array<std::uint32_t, kMaxSamples> count, index;
  std::array<float, kMaxSamples> depth, attribute;
  std::array<float, 3 * kMaxSamples> barycentrics;
} oracle_image;

// Window of values: up to 2 x 2 pixels with one sample each, one pixel with several. Begins at the covered pixel that
// `look` chooses.
Scissor choose_window(const Target& counts, int look) {
  if (look == kAllValues) return {0, 0, counts.width, counts.height};
  std::array<int, kMaxSamples> covered;
  std::size_t size = 0;
  for (std::size_t s = 0; s < counts.count.size(); ++s) {
    if (counts.count[s] != 0) covered[size++] = static_cast<int>(s) / counts.samples;
  }
  const int pixel = size == 0 ? 0 : covered[static_cast<std::size_t>(look) % size];
  const int x = pixel % counts.width, y = pixel / counts.width, side = counts.samples == 1 ? 2 : 1;
  return {x, y, std::min(x + side, counts.width), std::min(y + side, counts.height)};
}

// Are the values of `components` floats or integers a sample equal within the window, bit for bit?
bool same_in_window(const Target& target, const Scissor& window, const void* expected, const void* actual,
                    std::size_t components) {
  const auto samples = static_cast<std::size_t>(target.samples);
  const std::size_t pixel = 4 * components * samples;  // bytes
  for (int y = window.y0; y < window.y1; ++y) {
    const std::size_t begin = pixel * static_cast<std::size_t>(y * target.width + window.x0);
    const std::size_t size = pixel * static_cast<std::size_t>(window.x1 - window.x0);
    if (std::memcmp(static_cast<const char*>(expected) + begin, static_cast<const char*>(actual) + begin, size) != 0) {
      return false;
    }
  }
  return true;
}

bool equals_oracle(const corpus::Frame& engine, const corpus::Image& actual, int look) {
  const Target& asked = engine.target();
  const std::size_t total = sample_total(asked);
  OracleImage& expected = oracle_image;

  Target counts = asked;
  counts.count = std::span(expected.count).first(total);
  counts.index = {}, counts.depth = {}, counts.barycentrics = {}, counts.attributes = {};
  oracle::render(counts, engine.draws());
  if (!std::equal(counts.count.begin(), counts.count.end(), actual.count.begin())) return false;

  const Scissor window = choose_window(counts, look);
  Draw draw = engine.draws()[0];
  draw.scissor = window;
  Target values = asked;
  values.count = {};
  values.index = std::span(expected.index).first(total);
  values.depth = std::span(expected.depth).first(total);
  values.barycentrics = std::span(expected.barycentrics).first(3 * total);
  const AttributeTarget attribute{std::span(expected.attribute).first(total), 1};
  values.attributes = {&attribute, asked.attributes.size()};
  oracle::render(values, {&draw, 1});
  return same_in_window(asked, window, expected.index.data(), actual.index.data(), 1) &&
         same_in_window(asked, window, expected.depth.data(), actual.depth.data(), 1) &&
         same_in_window(asked, window, expected.barycentrics.data(), actual.barycentrics.data(), 3) &&
         (actual.attributes.empty() ||
          same_in_window(asked, window, expected.attribute.data(), actual.attributes[0].data(), 1));
}

void check(const corpus::Scene& scene, int look) {
  corpus::Frame engine(scene);
  if (const Status status = render(engine.target(), engine.draws()); status != Status::ok) {
    report_finding("triangle", std::string("the engine refuses a valid scene: ") + status_text(status),
                   corpus::write_scene(scene));
  }
  if (equals_oracle(engine, engine.image(), look)) return;
  // Every value of the image once more, to say which one differs.
  const properties::Comparison comparison =
      properties::compare(scene, properties::oracle_renderer(), properties::engine_renderer(), {}, 1);
  report_finding("triangle",
                 comparison.differences == 0 ? "the oracle's image within a scissor is not that of the whole (M3)"
                                             : properties::describe(comparison.first.at(0), scene.samples),
                 corpus::write_scene(scene));
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  check(decode_triangle({data, size}), size > kTriangleBytes ? data[kTriangleBytes] : 0);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return surefill::fuzz::mutate_triangle_bytes(data, size, max_size, seed);
}
