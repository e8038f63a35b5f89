// SPDX-License-Identifier: Apache-2.0
//
// The adapter's calls as messages of little-endian 32-bit words: docs/adapters.md. Used by certify, which speaks them
// to a rival's process, and by the host of plugins, which answers.
#ifndef SUREFILL_CERTIFY_ADAPTERS_WIRE_HPP
#define SUREFILL_CERTIFY_ADAPTERS_WIRE_HPP

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "certify/adapter.h"
#include "certify/adapter2.h"

namespace surefill::adapters {

static_assert(std::endian::native == std::endian::little, "messages are written as they lie in memory");

// A message is its kind, the number of words that follow, and these words.
using Words = std::vector<std::uint32_t>;
enum Request : std::uint32_t { kOpen = 1, kDraw = 2, kClose = 3, kModel = 4 };  // kModel: version 2
inline constexpr std::size_t kHeaderWords = 2;
inline constexpr std::size_t kInfoWords = sizeof(surefill_adapter_info) / 4;

// Text is padded with zeros to a whole word.
Words text_words(std::string_view text);
std::string text_of(std::span<const std::uint32_t> words);

// A struct of version 2 as words, and back: `to` comes with its defaults, and keeps those that the words do not reach.
// What is wrong with the words, as a sentence; empty if nothing.
template <typename Struct>
Words struct_words(const Struct& from) {
  static_assert(sizeof(Struct) % 4 == 0);
  Words words(sizeof(Struct) / 4);
  std::memcpy(words.data(), &from, sizeof from);
  return words;
}
std::string take_struct(std::span<const std::uint32_t> words, void* to, std::size_t size);

// What the draws of a scene of version 2 have beyond those of version 1, a draw each; empty: triangles.
struct PrimitiveOf {
  std::uint32_t kind = SUREFILL_ADAPTER2_TRIANGLES;
  float width = 0;
  std::size_t corners() const { return 3 - std::size_t{kind}; }
};
using Primitives = std::vector<PrimitiveOf>;

// The body of kDraw. The image says which outputs are asked for. The draws' numbers of triangles are those of their
// primitives.
Words scene_words(const surefill_adapter_scene& scene, const surefill_adapter_image& image,
                  std::uint32_t version = SUREFILL_ADAPTER_VERSION, const Primitives& primitives = {});

// A decoded kDraw: `scene` points into the words, which stay where they are.
struct DecodedScene {
  std::uint32_t outputs = 0;
  surefill_adapter_scene scene{};
  std::vector<surefill_adapter_draw> draws;
  std::vector<std::vector<surefill_adapter_attribute>> attributes;
  std::vector<std::uint32_t> components;  // of the attributes
  Primitives primitives;                  // of each draw
};

// False if the words are no scene.
bool decode_scene(std::span<const std::uint32_t> words, DecodedScene& result,
                  std::uint32_t version = SUREFILL_ADAPTER_VERSION);

// A scene of version 1 in the structs of version 2, which point into it and into this object.
class SceneOfVersion2 {
 public:
  explicit SceneOfVersion2(const surefill_adapter_scene& scene, const Primitives& primitives = {});
  SceneOfVersion2(const SceneOfVersion2&) = delete;
  SceneOfVersion2& operator=(const SceneOfVersion2&) = delete;

  const surefill_adapter2_scene& scene() const { return scene_; }

 private:
  std::vector<surefill_adapter2_draw> draws_;
  std::vector<const surefill_adapter2_draw*> draw_pointers_;
  std::vector<std::vector<surefill_adapter2_attribute>> attributes_;
  std::vector<std::vector<const surefill_adapter2_attribute*>> attribute_pointers_;
  surefill_adapter2_scene scene_{};
};
surefill_adapter2_image image_of_version_2(const surefill_adapter_image& image);

// One output of the answer to kDraw, in the order in which they come.
struct OutputBuffer {
  std::string name;
  void* words;  // where it goes
  std::size_t size;
};
std::vector<OutputBuffer> output_buffers(const surefill_adapter_scene& scene, const surefill_adapter_image& image);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_WIRE_HPP
