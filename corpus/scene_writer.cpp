// SPDX-License-Identifier: Apache-2.0
//
// The writer of the scene format (docs/scene-format.md).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "corpus/draw_fields.hpp"
#include "corpus/scene.hpp"

namespace surefill::corpus {
namespace {

// A finite multiple of 1/16, exactly, where that takes at most six characters; else "".
std::string short_decimal(float value) {
  const float size = std::fabs(value);
  if (!(size < 1e6F) || size * 16 != std::floor(size * 16)) return "";
  const auto sixteenths = static_cast<std::uint32_t>(size * 16);
  std::string text = (std::signbit(value) ? "-" : "") + std::to_string(sixteenths / 16);
  if (sixteenths % 16 != 0) text += '.';
  for (std::uint32_t rest = sixteenths % 16 * 625, unit = 1000; rest != 0; rest %= unit, unit /= 10) {
    text += static_cast<char>('0' + rest / unit);
  }
  return text.size() <= 6 ? text : "";
}

// Of a finite value: six hexadecimal digits at most, and below 2^-126 no leading 1.
std::string hexfloat(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::fabs(value));
  const int exponent = std::max(static_cast<int>(bits >> 23), 1) - 127;
  std::string text = std::signbit(value) ? "-0x" : "0x";
  text += bits >> 23 != 0 ? '1' : '0';
  std::uint32_t fraction = bits << 9;
  if (fraction != 0) text += '.';
  for (; fraction != 0; fraction <<= 4) text += "0123456789abcdef"[fraction >> 28];
  text += exponent < 0 ? "p-" : "p+";
  return text + std::to_string(std::abs(exponent));
}

class Writer {
 public:
  std::string write(const Scene& scene) {
    write_comment(scene.comment);
    line("surefill-scene", kSceneVersion);
    line("target", scene.width, scene.height);
    if (scene.samples != 1) line("samples", scene.samples);
    if (scene.depth_test != DepthTest::less) line("depth-test", name(scene.depth_test, kDepthTestNames));
    if (scene.attribute_location != AttributeLocation::centre) {
      line("attribute-location", name(scene.attribute_location, kAttributeLocationNames));
    }
    if (scene.origin != Origin{}) line("origin", scene.origin.x, scene.origin.y);
    if (!scene.sample_locations.empty()) {
      begin("sample-locations");
      for (const SampleLocation& location : scene.sample_locations) append_all(location.x, location.y);
      text_ += '\n';
    }
    if (scene.layers != 1) line("layers", scene.layers);
    if (scene.more != MoreOutputs{}) {
      begin("outputs");
      for (const auto& [word, member] : kMoreOutputs)
        if (scene.more.*member) append(word);
      text_ += '\n';
    }
    write_initial_depth(scene.initial_depth);
    for (const SceneAttribute& attribute : scene.attributes) {
      line("attribute", attribute.name, attribute.components, name(attribute.interpolation, kInterpolationNames));
    }
    for (const SceneDraw& draw : scene.draws) write_draw(draw, scene.attributes);
    return std::move(text_);
  }

 private:
  void write_comment(std::string_view comment) {
    const auto is_control = [](unsigned char c) { return (c < ' ' && c != '\t' && c != '\n') || c == 0x7f; };
    if (std::any_of(comment.begin(), comment.end(), is_control)) {
      throw SceneError("scene: control character in the comment");
    }
    while (!comment.empty()) {
      const std::size_t size = std::min(comment.find('\n'), comment.size());
      text_ += size == 0 ? "#" : "# ";
      text_ += comment.substr(0, size);
      text_ += '\n';
      // A line break at the very end begins one more line, an empty one.
      if (size + 1 == comment.size()) text_ += "#\n";
      comment.remove_prefix(std::min(size + 1, comment.size()));
    }
  }

  void write_initial_depth(const std::vector<float>& values) {
    constexpr std::size_t kPerLine = 8;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i % kPerLine == 0) text_ += i == 0 ? "initial-depth" : "\ninitial-depth";
      append(values[i]);
    }
    if (!values.empty()) text_ += '\n';
  }

  void write_draw(const SceneDraw& draw, const std::vector<SceneAttribute>& attributes) {
    text_ += "\ndraw\n";
    indent_ = "  ";
    if (draw.viewport) write_viewport(*draw.viewport);
    for_each_draw_field(
        [&](const auto& field) { write_field(field.name, draw.*field.member, DrawState{}.*field.member); });
    if (draw.first_index) line("first-index", *draw.first_index);
    for (std::size_t k = 0; k < std::min(attributes.size(), draw.interpolations.size()); ++k) {
      const auto own = draw.interpolations[k];
      if (own) line("interpolation", attributes[k].name, name(*own, kInterpolationNames));
    }
    for (const SceneVertex& vertex : draw.vertices) {
      begin("vertex");
      append_all(vertex.x, vertex.y, vertex.z, vertex.w);
      for (const float value : vertex.attributes) append(value);
      text_ += '\n';
    }
    for (const auto& [vertices, identifier] : draw.triangles) {
      begin(kPrimitiveWords[static_cast<std::size_t>(draw.primitive)]);
      for (std::size_t i = 0; i < corners_of(draw.primitive); ++i) append(vertices[i]);
      if (identifier) append_all("id", *identifier);
      text_ += '\n';
    }
    indent_ = "";
    text_ += "end\n";
  }

  template <typename Value>
  void write_field(std::string_view keyword, const Value& value, const Value& by_default) {
    if constexpr (kIsOptional<Value>) {
      if (!value) return;
      begin(keyword);
      for_each_part(*value, [&](const auto& part, const auto&...) { append_part(part); });
      text_ += '\n';
    } else if (value != by_default) {
      line(keyword, name(value, names_of<Value>()));
    }
  }

  template <typename Part>
  void append_part(const Part& part) {
    if constexpr (std::is_enum_v<Part>) {
      append(name(part, names_of<Part>()));
    } else {
      append(part);
    }
  }

  void write_viewport(const Viewport& viewport) {
    begin("viewport");
    append_all(viewport.x, viewport.y, viewport.width, viewport.height, viewport.near_depth, viewport.far_depth);
    const bool y_down = viewport.clip_y != ClipY::up;
    if (y_down || viewport.clip_depth != ClipDepth::zero_to_one) append(name(viewport.clip_depth, kClipDepthNames));
    if (y_down) append(name(viewport.clip_y, kClipYNames));
    text_ += '\n';
  }

  template <typename Enum, std::size_t Count>
  static std::string_view name(Enum value, const Names<Enum, Count>& names) {
    for (const auto& [known, text] : names) {
      if (known == value) return text;
    }
    throw SceneError("scene: a value that is no enumerator");
  }

  void begin(std::string_view keyword) {
    text_ += indent_;
    text_ += keyword;
  }

  template <typename... Fields>
  void line(std::string_view keyword, const Fields&... fields) {
    begin(keyword);
    append_all(fields...);
    text_ += '\n';
  }

  template <typename... Fields>
  void append_all(const Fields&... fields) {
    (append(fields), ...);
  }

  void append(std::string_view word) {
    text_ += ' ';
    text_ += word;
  }
  void append(int value) { append(std::string_view(std::to_string(value))); }
  void append(std::uint32_t value) { append(std::string_view(std::to_string(value))); }

  // Multiples of 1/16 of at most six characters are written as decimals, which then are exact; the rest as hexfloats.
  void append(float value) {
    if (std::isnan(value)) return append(std::string_view("nan"));
    if (std::isinf(value)) return append(std::string_view(value < 0 ? "-inf" : "inf"));
    const std::string decimal = short_decimal(value);
    append(std::string_view(decimal.empty() ? hexfloat(value) : decimal));
  }

  std::string text_;
  std::string_view indent_;
};

}  // namespace

std::string write_scene(const Scene& scene) {
  return Writer().write(scene);
}

}  // namespace surefill::corpus
