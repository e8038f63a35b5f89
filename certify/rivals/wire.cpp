// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/wire.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "certify/rivals/draw_words.hpp"
#include "surefill/surefill.hpp"

namespace surefill::adapters {

namespace {

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

void append(Words& words, const void* data, std::size_t count) {
  if (count == 0) return;
  const std::size_t at = words.size();
  words.resize(at + count);
  std::memcpy(words.data() + at, data, count * 4);
}

// Takes words off the front; once they run out, `ok` is false and everything is 0 and null.
class Reader {
 public:
  explicit Reader(std::span<const std::uint32_t> words) : rest_(words) {}

  std::uint32_t word() {
    const std::uint32_t* at = take(1);
    return at ? *at : 0;
  }
  float number() { return std::bit_cast<float>(word()); }
  const std::uint32_t* take(std::uint64_t count) {
    if (count > rest_.size()) {
      ok_ = false;
      return nullptr;
    }
    const std::uint32_t* at = rest_.data();
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return at;
  }
  // float and uint32_t alike lie in the message as words; memory from mmap or a vector is aligned for both.
  const float* numbers(std::uint64_t count) { return reinterpret_cast<const float*>(take(count)); }
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && rest_.empty(); }

 private:
  std::span<const std::uint32_t> rest_;
  bool ok_ = true;
};

// The words of version 2's headers, which begin with their number.
constexpr std::uint32_t kSceneHeaderWords = 11, kDrawHeaderWords = 28;
constexpr std::uint32_t kPrimitiveHeaderWords = 29;  // of a draw of lines or points: its width comes after the others

// Sizes as S5 and attributes as the adapter has them: then no number of samples or values overflows.
bool sizes_in_range(const surefill_adapter_scene& scene) {
  constexpr std::uint32_t kMostSamples = 16;
  const auto side_ok = [](std::uint32_t side) { return side >= 1 && side <= std::uint32_t{kMaxTargetSize}; };
  return side_ok(scene.width) && side_ok(scene.height) && scene.samples >= 1 && scene.samples <= kMostSamples;
}

// Precondition: sizes_in_range, which holds for every scene of certify and is asked of every message.
std::size_t total_samples(const surefill_adapter_scene& scene) {
  return std::size_t{scene.width} * scene.height * scene.samples;
}

}  // namespace

Words text_words(std::string_view text) {
  Words words((text.size() + 3) / 4, 0);
  if (!text.empty()) std::memcpy(words.data(), text.data(), text.size());
  return words;
}

std::string text_of(std::span<const std::uint32_t> words) {
  std::string text(words.size() * 4, '\0');
  if (!words.empty()) std::memcpy(text.data(), words.data(), text.size());
  text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
  return text;
}

std::string take_struct(std::span<const std::uint32_t> words, void* to, std::size_t size) {
  if (words.empty()) return "an empty answer";
  const std::size_t theirs = words[0];
  if (theirs < 4 || theirs % 4 != 0 || theirs > words.size() * 4) {
    return "a struct of " + std::to_string(theirs) + " bytes in " + std::to_string(words.size() * 4);
  }
  std::memcpy(to, words.data(), std::min(theirs, size));
  const std::span<const std::uint32_t> beyond = words.subspan(std::min(words.size(), size / 4));
  if (std::any_of(beyond.begin(), beyond.end(), [](std::uint32_t word) { return word != 0; })) {
    return "it says more than this certify knows: its struct has " + std::to_string(theirs) + " bytes, and here are " +
           std::to_string(size);
  }
  return "";
}

SceneOfVersion2::SceneOfVersion2(const surefill_adapter_scene& scene, const Primitives& primitives)
    : draws_(scene.draw_count), attributes_(scene.draw_count), attribute_pointers_(scene.draw_count) {
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& from = scene.draws[d];
    surefill_adapter2_draw& to = draws_[d];
    for (std::uint32_t k = 0; k < scene.attribute_count; ++k) {
      const surefill_adapter_attribute& attribute = from.attributes[k];
      attributes_[d].push_back(
          {sizeof(surefill_adapter2_attribute), attribute.components, attribute.interpolation, 0, attribute.values});
    }
    for (const surefill_adapter2_attribute& attribute : attributes_[d]) attribute_pointers_[d].push_back(&attribute);
    to.size = sizeof to;
    if (!primitives.empty()) {
      to.primitive = primitives[d].kind;
      to.width = primitives[d].width;
    }
    to.vertex_count = from.vertex_count;
    to.primitive_count = from.triangle_count;
    to.pixel = from.pixel;
    to.clip = from.clip;
    to.indices = from.indices;
    to.identifiers = from.identifiers;
    to.attributes = attribute_pointers_[d].data();
    to.clip_is_exact = from.clip_is_exact;
    to.viewport_x = from.viewport_x;
    to.viewport_y = from.viewport_y;
    to.viewport_width = from.viewport_width;
    to.viewport_height = from.viewport_height;
    to.viewport_near = from.viewport_near;
    to.viewport_far = from.viewport_far;
    to.viewport_depth_range = from.viewport_depth_range;
    // The state's words lie in both structs one after the other, and in the same order.
    static_assert(offsetof(surefill_adapter_draw, grid_offset_y) - offsetof(surefill_adapter_draw, fill_rule) ==
                  offsetof(surefill_adapter2_draw, grid_offset_y) - offsetof(surefill_adapter2_draw, fill_rule));
    std::memcpy(&to.fill_rule, &from.fill_rule,
                offsetof(surefill_adapter_draw, grid_offset_y) + 4 - offsetof(surefill_adapter_draw, fill_rule));
  }
  for (const surefill_adapter2_draw& draw : draws_) draw_pointers_.push_back(&draw);
  scene_.size = sizeof scene_;
  scene_.width = scene.width;
  scene_.height = scene.height;
  scene_.samples = scene.samples;
  scene_.depth_test = scene.depth_test;
  scene_.attribute_location = scene.attribute_location;
  scene_.attribute_count = scene.attribute_count;
  scene_.draw_count = scene.draw_count;
  scene_.draws = draw_pointers_.data();
  scene_.initial_depth = scene.initial_depth;
}

surefill_adapter2_image image_of_version_2(const surefill_adapter_image& image) {
  return {
      sizeof(surefill_adapter2_image), 0, image.count, image.index, image.depth, image.barycentrics, image.attributes};
}

Words scene_words(const surefill_adapter_scene& scene, const surefill_adapter_image& image, std::uint32_t version,
                  const Primitives& primitives) {
  std::uint32_t outputs = 0;
  if (image.count) outputs |= SUREFILL_ADAPTER_COUNT;
  if (image.index) outputs |= SUREFILL_ADAPTER_INDEX;
  if (image.depth) outputs |= SUREFILL_ADAPTER_DEPTH;
  if (image.barycentrics) outputs |= SUREFILL_ADAPTER_BARYCENTRICS;
  if (image.attributes) outputs |= SUREFILL_ADAPTER_ATTRIBUTES;
  Words words;
  const bool second = version == SUREFILL_ADAPTER2_VERSION;
  if (second) words.push_back(kSceneHeaderWords);
  words.push_back(outputs);
  if (second) words.push_back(0);  // the upper half
  words.insert(words.end(), {scene.width, scene.height, scene.samples, scene.depth_test, scene.attribute_location,
                             scene.attribute_count, scene.draw_count, scene.initial_depth ? 1u : 0u});
  for (std::uint32_t k = 0; k < scene.attribute_count; ++k) {
    words.push_back(scene.draw_count > 0 ? scene.draws[0].attributes[k].components : 1);
  }
  if (scene.initial_depth) append(words, scene.initial_depth, total_samples(scene));
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& draw = scene.draws[d];
    const PrimitiveOf primitive = primitives.empty() ? PrimitiveOf{} : primitives[d];
    const bool plain = primitive.kind == SUREFILL_ADAPTER2_TRIANGLES;
    if (second) words.insert(words.end(), {plain ? kDrawHeaderWords : kPrimitiveHeaderWords, primitive.kind});
    words.insert(words.end(), {draw.vertex_count, draw.triangle_count, draw.clip_is_exact, bits(draw.viewport_x),
                               bits(draw.viewport_y), bits(draw.viewport_width), bits(draw.viewport_height),
                               bits(draw.viewport_near), bits(draw.viewport_far), draw.viewport_depth_range});
    for_each_state_word(draw, [&](const auto& word) { words.push_back(static_cast<std::uint32_t>(word)); });
    if (second && !plain) words.push_back(bits(primitive.width));
    const std::size_t vertices = draw.vertex_count, triangles = draw.triangle_count;
    append(words, draw.pixel, 4 * vertices);
    append(words, draw.clip, 4 * vertices);
    append(words, draw.indices, primitive.corners() * triangles);
    append(words, draw.identifiers, triangles);
    for (std::uint32_t k = 0; k < scene.attribute_count; ++k) {
      words.push_back(draw.attributes[k].interpolation);
      append(words, draw.attributes[k].values, vertices * draw.attributes[k].components);
    }
  }
  return words;
}

bool decode_scene(std::span<const std::uint32_t> words, DecodedScene& result, std::uint32_t version) {
  Reader reader(words);
  surefill_adapter_scene& scene = result.scene;
  const bool second = version == SUREFILL_ADAPTER2_VERSION;
  // The words of a header that are not known, since a later certify wrote it.
  const auto pass_over = [&](std::uint32_t header, std::uint32_t known) {
    if (second) reader.take(header - known);
  };
  const std::uint32_t scene_header = second ? reader.word() : 0;
  if (second && scene_header < kSceneHeaderWords) return false;
  result.outputs = reader.word();
  if (second) reader.word();
  scene.width = reader.word();
  scene.height = reader.word();
  scene.samples = reader.word();
  scene.depth_test = reader.word();
  scene.attribute_location = reader.word();
  scene.attribute_count = reader.word();
  scene.draw_count = reader.word();
  const bool has_initial_depth = reader.word() != 0;
  pass_over(scene_header, kSceneHeaderWords);
  // Each attribute and each draw takes a word at least, so that these numbers cannot ask for memory without end.
  if (!reader.ok() || scene.attribute_count > words.size() || scene.draw_count > words.size()) return false;
  if (!sizes_in_range(scene)) return false;
  for (std::uint32_t k = 0; k < scene.attribute_count; ++k) {
    const std::uint32_t components = reader.word();
    if (components > kMaxComponents) return false;
    result.components.push_back(components);
  }
  if (has_initial_depth) scene.initial_depth = reader.numbers(total_samples(scene));
  result.draws.resize(scene.draw_count);
  result.attributes.resize(scene.draw_count);
  result.primitives.resize(scene.draw_count);
  for (std::uint32_t d = 0; d < scene.draw_count && reader.ok(); ++d) {
    PrimitiveOf& primitive = result.primitives[d];
    surefill_adapter_draw& draw = result.draws[d];
    const std::uint32_t draw_header = second ? reader.word() : 0;
    if (second) primitive.kind = reader.word();
    if (second && (draw_header < kDrawHeaderWords || primitive.kind > SUREFILL_ADAPTER2_POINTS)) return false;
    draw.vertex_count = reader.word();
    draw.triangle_count = reader.word();
    draw.clip_is_exact = reader.word();
    for (float* number : {&draw.viewport_x, &draw.viewport_y, &draw.viewport_width, &draw.viewport_height,
                          &draw.viewport_near, &draw.viewport_far}) {
      *number = reader.number();
    }
    draw.viewport_depth_range = reader.word();
    for_each_state_word(
        draw, [&](auto& word) { word = static_cast<std::remove_reference_t<decltype(word)>>(reader.word()); });
    const bool has_width = draw_header >= kPrimitiveHeaderWords;
    if (has_width) primitive.width = reader.number();
    pass_over(draw_header, has_width ? kPrimitiveHeaderWords : kDrawHeaderWords);
    const std::uint64_t vertices = draw.vertex_count, triangles = draw.triangle_count;
    draw.pixel = reader.numbers(4 * vertices);
    draw.clip = reader.numbers(4 * vertices);
    draw.indices = reader.take(primitive.corners() * triangles);
    draw.identifiers = reader.take(triangles);
    for (std::uint32_t k = 0; k < scene.attribute_count && reader.ok(); ++k) {
      surefill_adapter_attribute attribute{};
      attribute.interpolation = reader.word();
      attribute.components = result.components[k];
      attribute.values = reader.numbers(vertices * attribute.components);
      result.attributes[d].push_back(attribute);
    }
    draw.attributes = result.attributes[d].data();
  }
  scene.draws = result.draws.data();
  return reader.at_end();
}

std::vector<OutputBuffer> output_buffers(const surefill_adapter_scene& scene, const surefill_adapter_image& image) {
  const std::size_t total = total_samples(scene);
  std::vector<OutputBuffer> buffers;
  if (image.count) buffers.push_back({"count", image.count, total});
  if (image.index) buffers.push_back({"index", image.index, total});
  if (image.depth) buffers.push_back({"depth", image.depth, total});
  if (image.barycentrics) buffers.push_back({"barycentrics", image.barycentrics, 3 * total});
  for (std::uint32_t k = 0; image.attributes && k < scene.attribute_count; ++k) {
    if (!image.attributes[k] || scene.draw_count == 0) continue;
    buffers.push_back(
        {"attribute " + std::to_string(k), image.attributes[k], scene.draws[0].attributes[k].components * total});
  }
  return buffers;
}

}  // namespace surefill::adapters
