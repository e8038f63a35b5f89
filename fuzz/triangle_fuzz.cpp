// SPDX-License-Identifier: Apache-2.0
//
// One triangle, engine == oracle, bit for bit: the coverage count of every sample; index, depth, barycentrics and
// attribute of the samples in a window of up to four pixels, or of all if the byte after the triangle is 255. The
// window is the oracle's scissor (M3), because exact values cost a thousand times more than exact signs.
#include <algorithm>
#include <vector>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "oracle/oracle.hpp"
#include "properties/compare.hpp"

namespace surefill::fuzz {
namespace {

constexpr int kAllValues = 255;

// Window of values: up to 2 x 2 pixels with one sample each, one pixel with several. Begins at the covered pixel that
// `look` chooses.
Scissor choose_window(const corpus::Image& counts, int look) {
  std::vector<int> covered;
  for (std::size_t s = 0; s < counts.count.size(); ++s) {
    if (counts.count[s] != 0) covered.push_back(static_cast<int>(s) / counts.samples);
  }
  const int pixel = covered.empty() ? 0 : covered[static_cast<std::size_t>(look) % covered.size()];
  const int x = pixel % counts.width, y = pixel / counts.width, side = counts.samples == 1 ? 2 : 1;
  return {x, y, x + side, y + side};
}

// The oracle's empty samples outside the window take the engine's values.
void copy_outside(const Scissor& window, const corpus::Image& from, corpus::Image& to) {
  const auto copy = [](const auto& source, auto& destination, std::size_t first, std::size_t count) {
    std::copy_n(source.begin() + static_cast<std::ptrdiff_t>(first), count,
                destination.begin() + static_cast<std::ptrdiff_t>(first));
  };
  const auto samples = static_cast<std::size_t>(to.samples);
  std::size_t s = 0;
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x, s += samples) {
      if (x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1) continue;
      copy(from.index, to.index, s, samples);
      copy(from.depth, to.depth, s, samples);
      copy(from.barycentrics, to.barycentrics, 3 * s, 3 * samples);
      for (std::size_t k = 0; k < to.attributes.size(); ++k) copy(from.attributes[k], to.attributes[k], s, samples);
    }
  }
}

void check(const corpus::Scene& scene, int look) {
  const auto fail = [&scene](const std::string& relation) {
    report_finding("triangle", relation, corpus::write_scene(scene));
  };
  corpus::Frame engine(scene);
  if (const Status status = render(engine.target(), engine.draws()); status != Status::ok) {
    fail(std::string("the engine refuses a valid scene: ") + status_text(status));
  }
  corpus::Image& actual = engine.image();

  corpus::Outputs count_only{.count = true, .index = false, .depth = false, .barycentrics = false, .attributes = false};
  corpus::Frame counts(scene, count_only);
  oracle::render(counts.target(), counts.draws());

  corpus::Scene windowed = scene;
  if (look != kAllValues) windowed.draws[0].scissor = choose_window(counts.image(), look);
  corpus::Frame values(windowed, {.count = false});
  oracle::render(values.target(), values.draws());
  corpus::Image& expected = values.image();
  if (look != kAllValues) copy_outside(*windowed.draws[0].scissor, actual, expected);
  expected.count = counts.image().count;

  const properties::Comparison comparison = properties::compare(scene, expected, actual, 1);
  if (comparison.differences != 0) fail(properties::describe(comparison.first.at(0), scene.samples));
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
