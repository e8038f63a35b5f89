// SPDX-License-Identifier: Apache-2.0
//
// The reader of the adapter protocol on any words: it refuses them, or what it decodes lies within them and, written
// again, is the same words (but for flags, of which only whether they are 0 counts).
#include <cstring>
#include <string>
#include <vector>

#include "certify/rivals/wire.hpp"
#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"

namespace surefill::fuzz {
namespace {

using adapters::Words;

// An image that asks for the outputs of the bits; nothing is written.
surefill_adapter_image image_of(std::uint32_t outputs, std::vector<float*>& attributes) {
  static std::uint32_t word;
  static float number;
  surefill_adapter_image image{};
  if ((outputs & SUREFILL_ADAPTER_COUNT) != 0) image.count = &word;
  if ((outputs & SUREFILL_ADAPTER_INDEX) != 0) image.index = &word;
  if ((outputs & SUREFILL_ADAPTER_DEPTH) != 0) image.depth = &number;
  if ((outputs & SUREFILL_ADAPTER_BARYCENTRICS) != 0) image.barycentrics = &number;
  attributes.assign(1, &number);
  if ((outputs & SUREFILL_ADAPTER_ATTRIBUTES) != 0) image.attributes = attributes.data();
  return image;
}

void check(const Words& words, std::uint32_t version) {
  constexpr std::uint32_t kKnownOutputs = 31;
  const bool second = version == SUREFILL_ADAPTER2_VERSION;
  const std::size_t has_initial_depth = second ? 10 : 8;  // the word that says so
  adapters::DecodedScene decoded;
  if (!adapters::decode_scene(words, decoded, version)) return;
  const surefill_adapter_scene& scene = decoded.scene;
  using Wide = unsigned __int128;
  if (scene.initial_depth != nullptr && Wide{scene.width} * scene.height * scene.samples > words.size()) {
    report_finding("adapter", "a scene with more initial depths than the message has words");
  }
  // What a host makes buffers of: sizes of S5 and up to four components, whose products fit in 64 bits.
  const Wide samples = Wide{scene.width} * scene.height * scene.samples;
  if (samples == 0 || samples > Wide{16384} * 16384 * 16) report_finding("adapter", "a size outside S5");
  for (const std::uint32_t components : decoded.components) {
    if (components > 4) report_finding("adapter", "an attribute of more than four components");
  }
  if (scene.draw_count == 0) return;  // attributes without draws are not told apart
  std::vector<float*> attributes;
  const adapters::SceneOfVersion2 seen(scene);
  if (seen.scene().draw_count != scene.draw_count) report_finding("adapter", "another number of draws in version 2");
  Words again = adapters::scene_words(scene, image_of(decoded.outputs, attributes), version);
  Words expected = words;
  if (second && again.size() != expected.size()) return;  // headers with words that are not known
  expected[second ? 1 : 0] &= kKnownOutputs;
  if (second) expected[2] = 0;
  expected[has_initial_depth] = expected[has_initial_depth] != 0 ? 1 : 0;
  if (again != expected) report_finding("adapter", "the scene that was written again is another one");
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint32_t> words(size / 4);
  if (!words.empty()) std::memcpy(words.data(), data, 4 * words.size());
  surefill::fuzz::check(words, SUREFILL_ADAPTER_VERSION);
  surefill::fuzz::check(words, SUREFILL_ADAPTER2_VERSION);
  return 0;
}
