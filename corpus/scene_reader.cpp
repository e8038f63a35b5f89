// SPDX-License-Identifier: Apache-2.0
//
// The reader of the scene format (docs/scene-format.md): strict, line by line, in one pass.
#include <algorithm>
#include <bit>
#include <bitset>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "corpus/draw_fields.hpp"
#include "corpus/float_text.hpp"
#include "corpus/scene.hpp"
#include "corpus/text_file.hpp"

namespace surefill::corpus {
namespace {

constexpr std::size_t kMaxLineLength = 4096;  // characters, but for a comment
constexpr std::size_t kAnyCount = std::numeric_limits<std::size_t>::max();

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

// A field as messages show it: short, and in printable ASCII.
std::string quoted(std::string_view field) {
  constexpr std::size_t kShown = 40;
  std::string text = "'";
  for (const char c : field.substr(0, kShown)) text += c > ' ' && c <= '~' ? c : '?';
  return text + (field.size() > kShown ? "...'" : "'");
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view file) : rest_(without_byte_order_mark(text)), file_(file) {}

  Scene read() {
    if (const std::string other = what_is_not_read(rest_); !other.empty()) fail(other);
    read_version();
    while (next_line()) {
      if (fields_[0] == "draw") {
        read_draw();
      } else {
        if (!scene_.draws.empty()) fail(quoted(fields_[0]) + " after a draw: only another draw can follow");
        dispatch(kFrameKeywords, frame_seen_);
      }
    }
    if (scene_.draws.empty()) fail("no draw");
    return std::move(scene_);
  }

 private:
  using Seen = std::bitset<32>;
  struct Keyword {
    std::string_view name;
    std::string form;         // of the fields, for messages
    std::size_t least, most;  // number of fields
    bool repeatable;
    void (Reader::*read)();
  };
  static const std::array<Keyword, 10> kFrameKeywords;
  static const std::array<Keyword, 7> kDrawKeywords;

  [[noreturn]] void fail_at(std::size_t line, const std::string& cause) const {
    throw SceneError(std::string(file_) + ':' + std::to_string(line) + ": " + cause);
  }
  [[noreturn]] void fail(const std::string& cause) const { fail_at(std::max<std::size_t>(line_, 1), cause); }

  // Lines.

  // The next line as it stands, without its line break.
  bool next_raw_line(std::string_view& line) {
    if (rest_.empty()) return false;
    ++line_;
    const std::size_t size = rest_.find('\n');
    line = rest_.substr(0, size);
    rest_.remove_prefix(size == rest_.npos ? rest_.size() : size + 1);
    if (size == rest_.npos) fail("the last line has no line break: the file is cut short");
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (std::min(line.find('#'), line.size()) > kMaxLineLength)
      fail("line longer than " + std::to_string(kMaxLineLength) + " characters");
    const auto is_control = [](unsigned char c) { return (c < ' ' && c != '\t') || c == 0x7f; };
    if (std::any_of(line.begin(), line.end(), is_control)) fail("control character: this is not a text file");
    return true;
  }

  // The next line that has fields; fills fields_. Comment lines before the first such line make scene_.comment.
  bool next_line() {
    std::string_view line;
    while (next_raw_line(line)) {
      fields_.clear();
      const std::size_t comment = line.find('#');
      std::string_view content = line.substr(0, comment);
      constexpr std::string_view kSpace = " \t";
      while (true) {
        const std::size_t begin = content.find_first_not_of(kSpace);
        if (begin == content.npos) break;
        content.remove_prefix(begin);
        const std::size_t size = std::min(content.find_first_of(kSpace), content.size());
        fields_.push_back(content.substr(0, size));
        content.remove_prefix(size);
      }
      if (!fields_.empty()) return true;
      if (comment != line.npos && !version_read_) add_comment(line.substr(comment + 1));
    }
    return false;
  }

  void add_comment(std::string_view line) {
    if (line.starts_with(' ')) line.remove_prefix(1);
    if (has_comment_) scene_.comment += '\n';
    has_comment_ = true;
    scene_.comment += line;
  }

  void read_version() {
    if (!next_line() || fields_[0] != "surefill-scene") fail("the first line must be 'surefill-scene 1'");
    version_read_ = true;
    if (fields_.size() != 2) fail("surefill-scene VERSION: 1 field expected, " + given());
    const auto version = integer<int>(fields_[1], 0, std::numeric_limits<int>::max());
    if (version != kSceneVersion) fail("version " + std::to_string(version) + " is unknown; this reads version 1");
  }

  // Calls the reader of the keyword in fields_[0], once the number of fields is right.
  void dispatch(std::span<const Keyword> keywords, Seen& seen) {
    const auto keyword =
        std::find_if(keywords.begin(), keywords.end(), [&](const Keyword& k) { return k.name == fields_[0]; });
    if (keyword == keywords.end()) fail("unknown keyword " + quoted(fields_[0]));
    check_fields(*keyword, static_cast<std::size_t>(keyword - keywords.begin()), seen);
    (this->*keyword->read)();
  }

  // Fails where the keyword stands a second time, or with a wrong number of fields.
  void check_fields(const Keyword& keyword, std::size_t number, Seen& seen) const {
    if (seen[number] && !keyword.repeatable) fail(std::string(keyword.name) + " is given twice");
    seen[number] = true;
    const std::size_t count = fields_.size() - 1;
    if (count >= keyword.least && count <= keyword.most) return;
    std::string expected = std::to_string(keyword.least);
    if (keyword.most == kAnyCount)
      expected += " or more";
    else if (keyword.most > keyword.least)
      expected += " to " + std::to_string(keyword.most);
    fail(std::string(keyword.name) + " " + keyword.form + ": " + expected +
         (expected == "1" ? " field expected, " : " fields expected, ") + given());
  }

  std::string given() const { return std::to_string(fields_.size() - 1) + " given"; }

  // Fields.

  template <typename Integer>
  Integer integer(std::string_view field, Integer least, Integer most) const {
    Integer value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    const bool whole = end == field.data() + field.size() && error != std::errc::invalid_argument;
    if (!whole) fail(quoted(field) + " is not an integer");
    if (error != std::errc{} || value < least || value > most) {
      fail(quoted(field) + " is outside " + std::to_string(least) + ".." + std::to_string(most));
    }
    return value;
  }

  // A float32: nan, inf, -inf, a hexfloat, which must be exact, or a decimal, which is rounded once to the nearest.
  float real(std::string_view field) const {
    if (field == "nan") return std::numeric_limits<float>::quiet_NaN();
    if (field == "inf") return std::numeric_limits<float>::infinity();
    if (field == "-inf") return -std::numeric_limits<float>::infinity();
    const bool negative = field.starts_with('-');
    const std::string_view digits = field.substr(negative ? 1 : 0);
    const float magnitude = digits.starts_with("0x") ? hexfloat(field, digits.substr(2)) : decimal(field, digits);
    return negative ? -magnitude : magnitude;
  }

  float hexfloat(std::string_view field, std::string_view digits) const {
    // With at most 13 hex digits, 52 bits, the double is exact, and so is the comparison with its float. Zeros at the
    // end of a fraction say nothing: 0x1.8000000000000p+0 is how Python writes 1.5.
    constexpr std::size_t kMaxHexDigits = 13;
    std::string_view significand = digits.substr(0, digits.find('p'));
    if (significand.find('.') != significand.npos)
      significand = significand.substr(0, significand.find_last_not_of('0') + 1);
    double value = 0;
    const auto [end, error] =
        float_from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
    const bool begins_well = !digits.empty() && (is_digit(digits[0]) || (digits[0] >= 'a' && digits[0] <= 'f'));
    if (!begins_well || end != digits.data() + digits.size()) fail(quoted(field) + " is not a number");
    const std::size_t point = significand.find('.') == significand.npos ? 0 : 1;
    const bool fits = error == std::errc{} && significand.size() - point <= kMaxHexDigits &&
                      value <= static_cast<double>(std::numeric_limits<float>::max());
    if (!fits || static_cast<double>(static_cast<float>(value)) != value) {
      fail(quoted(field) + " is not exactly a float32");
    }
    return static_cast<float>(value);
  }

  float decimal(std::string_view field, std::string_view digits) const {
    float value = 0;
    const auto [end, error] = float_from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || !is_digit(digits[0]) || end != digits.data() + digits.size()) {
      fail(quoted(field) + " is not a number");
    }
    if (error != std::errc{}) fail(quoted(field) + " is beyond float32; write inf or 0 if that is meant");
    return value;
  }

  template <typename Enum, std::size_t Count>
  Enum word(std::string_view field, const Names<Enum, Count>& names) const {
    std::string all;
    for (const auto& [value, name] : names) {
      if (field == name) return value;
      all += (all.empty() ? "" : ", ") + std::string(name);
    }
    fail(quoted(field) + " is none of: " + all);
  }

  float finite(std::string_view field) const {
    const float value = real(field);
    if (!std::isfinite(value)) fail(quoted(field) + " is not finite");
    return value;
  }

  std::uint32_t vertex_number(std::string_view field) const {
    const auto number = integer<std::uint32_t>(field, 0, std::numeric_limits<std::uint32_t>::max());
    if (number >= draw().vertices.size()) {
      fail("no vertex " + std::to_string(number) + ": " + std::to_string(draw().vertices.size()) +
           " vertices stand above this line");
    }
    return number;
  }

  float positive(std::string_view field) const {
    const float value = finite(field);
    if (!(value > 0)) fail(quoted(field) + " is not greater than 0");
    return value;
  }

  // The frame.

  void read_target() {
    has_target_ = true;
    scene_.width = integer(fields_[1], 1, kMaxTargetSize);
    scene_.height = integer(fields_[2], 1, kMaxTargetSize);
  }

  void read_samples() {
    scene_.samples = integer(fields_[1], 1, 16);
    if (!std::has_single_bit(static_cast<unsigned>(scene_.samples))) {
      fail(quoted(fields_[1]) + " is none of: 1, 2, 4, 8, 16");
    }
  }

  void read_origin() {
    scene_.origin = {integer(fields_[1], -kMaxOrigin, kMaxOrigin), integer(fields_[2], -kMaxOrigin, kMaxOrigin)};
  }

  void read_sample_locations() {
    locations_line_ = line_;
    if (fields_.size() % 2 == 0) fail("sample-locations X Y...: an X without a Y");
    for (std::size_t i = 1; i < fields_.size(); i += 2) {
      scene_.sample_locations.push_back({integer(fields_[i], 0, 15), integer(fields_[i + 1], 0, 15)});
    }
  }

  void read_layers() { scene_.layers = integer(fields_[1], 1, kMaxLayers); }

  void read_outputs() {
    for (std::size_t i = 1; i < fields_.size(); ++i) {
      const auto row = std::find_if(kMoreOutputs.begin(), kMoreOutputs.end(),
                                    [&](const auto& output) { return output.first == fields_[i]; });
      if (row == kMoreOutputs.end()) fail(quoted(fields_[i]) + " is none of: winding, numbers, conservative-index");
      if (scene_.more.*row->second) fail(quoted(fields_[i]) + " is given twice");
      scene_.more.*row->second = true;
    }
  }

  void read_initial_depth() {
    initial_depth_line_ = line_;
    for (std::size_t i = 1; i < fields_.size(); ++i) scene_.initial_depth.push_back(real(fields_[i]));
  }

  void read_depth_test() { scene_.depth_test = word(fields_[1], kDepthTestNames); }
  void read_attribute_location() { scene_.attribute_location = word(fields_[1], kAttributeLocationNames); }

  void read_attribute() {
    const std::string_view name = fields_[1];
    const auto is_inner = [](char c) { return is_letter(c) || is_digit(c) || c == '-'; };
    if (!is_letter(name[0]) || !std::all_of(name.begin(), name.end(), is_inner)) {
      fail(quoted(name) + " is not a name: letters, digits, '_' and '-' after a letter or '_'");
    }
    for (const SceneAttribute& other : scene_.attributes) {
      if (other.name == name) fail("attribute " + quoted(name) + " is given twice");
    }
    if (scene_.attributes.size() == kMaxAttributes) fail("more than " + std::to_string(kMaxAttributes) + " attributes");
    scene_.attributes.push_back({std::string(name), integer<std::uint32_t>(fields_[2], 1, kMaxComponents),
                                 word(fields_[3], kInterpolationNames)});
    components_ += scene_.attributes.back().components;
  }

  // What must hold of the lines before the first draw.
  void check_frame() const {
    if (!has_target_) fail("no target before the first draw");
    const auto total = static_cast<std::uint64_t>(scene_.width) * static_cast<std::uint64_t>(scene_.height) *
                       static_cast<std::uint64_t>(scene_.samples);
    const std::size_t places = scene_.sample_locations.size();
    if (places != 0 && places != static_cast<std::size_t>(scene_.samples)) {
      fail_at(locations_line_, "sample-locations: " + std::to_string(places) + " places for " +
                                   std::to_string(scene_.samples) + " samples (S7)");
    }
    const std::size_t values = scene_.initial_depth.size();
    if (values > 1 && values != total) {
      fail_at(initial_depth_line_, "initial-depth: " + std::to_string(values) + " values for a target of " +
                                       std::to_string(total) + " samples; give one, or one a sample");
    }
  }

  // A draw.

  SceneDraw& draw() { return scene_.draws.back(); }
  const SceneDraw& draw() const { return scene_.draws.back(); }

  void read_draw() {
    if (fields_.size() != 1) fail("draw: 0 fields expected, " + given());
    if (scene_.draws.empty()) check_frame();
    const std::size_t begin = line_;
    scene_.draws.emplace_back();
    Seen seen;
    while (true) {
      if (!next_line()) fail("the draw of line " + std::to_string(begin) + " has no end");
      if (fields_[0] == "end") break;
      if (!read_state(seen)) dispatch(kDrawKeywords, seen);
    }
    if (fields_.size() != 1) fail("end: 0 fields expected, " + given());
    check_draw();
    triangles_ += draw().triangles.size();
  }

  void check_draw() const {
    if (draw().grid && draw().fill_rule > FillRule::northwards_west)
      fail("the fill rules closed and open have no grid (C5)");
    check_primitive();
    if (draw().conservative != Conservative::none) {
      if (scene_.samples != 1) fail_at(conservative_line_, "a conservative draw needs samples 1 (M4)");
      if (draw().depth_mode != DepthMode::none)
        fail_at(conservative_line_, "a conservative draw needs depth-mode none (M4)");
      if (draw().grid) fail_at(conservative_line_, "a conservative draw has no grid (M4)");
      if (scene_.layers > 1) fail_at(conservative_line_, "a frame with a conservative draw has one layer (V4)");
      if (!scene_.sample_locations.empty())
        fail_at(conservative_line_, "a frame with a conservative draw has no sample locations (S7)");
    }
    if (scene_.layers > 1 && !draw().depth_write) fail("a frame with layers has no draw with depth-write off (V4)");
    const std::uint64_t start = draw().first_index ? std::uint64_t{*draw().first_index} : triangles_;
    if (start + draw().triangles.size() > kNoTriangle) {
      fail("first-index " + std::to_string(start) + " plus " + std::to_string(draw().triangles.size()) +
           " triangles exceeds 4294967295 (B5)");
    }
  }

  // Of points and lines (M7, I8).
  void check_primitive() const {
    if (!draw().triangles.empty() && first_primitive_ != draw().primitive) {
      fail_at(primitive_line_, std::string(kPrimitiveWords[static_cast<std::size_t>(first_primitive_)]) +
                                   " in a draw whose primitive is not " +
                                   std::string(kPrimitiveNames[static_cast<std::size_t>(first_primitive_)].second));
    }
    if (draw().primitive == Primitive::triangles) return;
    if (draw().grid) fail("lines and points have no grid (M7)");
    if (draw().fill_rule > FillRule::northwards_west) fail("lines and points have no fill rule closed or open (M7)");
    if (draw().conservative != Conservative::none) fail("lines and points are not conservative (M7)");
    if (draw().depth_bias) fail("lines and points have no depth-bias (I8)");
    if (draw().primitive == Primitive::lines && !draw().width && scene_.samples != 1) {
      fail("lines without a width need samples 1 (M7)");
    }
  }

  void read_viewport() {
    Viewport viewport;
    viewport.x = finite(fields_[1]);
    viewport.y = finite(fields_[2]);
    viewport.width = finite(fields_[3]);
    viewport.height = finite(fields_[4]);
    viewport.near_depth = finite(fields_[5]);
    viewport.far_depth = finite(fields_[6]);
    if (fields_.size() > 7) viewport.clip_depth = word(fields_[7], kClipDepthNames);
    if (fields_.size() > 8) viewport.clip_y = word(fields_[8], kClipYNames);
    draw().viewport = viewport;
  }

  // A field of the draw's state, where the keyword is one. Its row is numbered after the other keywords.
  bool read_state(Seen& seen) {
    std::size_t number = kDrawKeywords.size();
    return any_draw_field([&](const auto& field) {
      ++number;
      if (field.name != fields_[0]) return false;
      using Value = std::remove_cvref_t<decltype(draw().*field.member)>;
      if constexpr (kIsOptional<Value>) {
        const std::size_t parts = parts_of<typename Value::value_type>();
        check_fields({field.name, std::string(field.form), parts, parts, false, nullptr}, number, seen);
        read_parts((draw().*field.member).emplace());
      } else {
        check_fields({field.name, form_of<Value>(), 1, 1, false, nullptr}, number, seen);
        draw().*field.member = word(fields_[1], names_of<Value>());
        if constexpr (std::is_same_v<Value, Conservative>) conservative_line_ = line_;
      }
      return true;
    });
  }

  template <typename Enum>
  static std::string form_of() {
    std::string form;
    for (const auto& [value, name] : names_of<Enum>()) form += (form.empty() ? "" : "|") + std::string(name);
    return form;
  }

  template <typename Structure>
  void read_parts(Structure& value) {
    std::size_t field = 1;
    for_each_part(value, [&](auto& part, const auto&... range) {
      using Part = std::remove_cvref_t<decltype(part)>;
      const std::string_view text = fields_[field++];
      if constexpr (std::is_enum_v<Part>) {
        part = word(text, names_of<Part>());
      } else if constexpr (std::is_same_v<Part, float>) {
        constexpr bool kPositive = (std::is_same_v<std::remove_cvref_t<decltype(range)>, PositiveNumber> || ...);
        part = sizeof...(range) == 0 ? real(text) : kPositive ? positive(text) : finite(text);
      } else {
        (..., (part = integer(text, range.least, range.most)));
      }
    });
  }

  void read_first_index() { draw().first_index = integer<std::uint32_t>(fields_[1], 0, kNoTriangle); }

  void read_interpolation() {
    const std::vector<SceneAttribute>& all = scene_.attributes;
    const auto of = std::find_if(all.begin(), all.end(), [&](const SceneAttribute& a) { return a.name == fields_[1]; });
    if (of == all.end()) fail("no attribute " + quoted(fields_[1]));
    const auto k = static_cast<std::size_t>(of - all.begin());
    auto& own = draw().interpolations;
    own.resize(std::max(own.size(), k + 1));
    if (own[k]) fail("interpolation " + quoted(fields_[1]) + " is given twice");
    own[k] = word(fields_[2], kInterpolationNames);
  }

  void read_vertex() {
    if (fields_.size() != 5 + components_) {
      fail("vertex X Y Z W and " + std::to_string(components_) +
           " attribute values: " + std::to_string(4 + components_) + " fields expected, " + given());
    }
    if (draw().vertices.size() == std::numeric_limits<std::uint32_t>::max()) fail("too many vertices");
    SceneVertex vertex{real(fields_[1]), real(fields_[2]), real(fields_[3]), real(fields_[4]), {}};
    vertex.attributes.reserve(components_);
    for (std::size_t i = 5; i < fields_.size(); ++i) vertex.attributes.push_back(real(fields_[i]));
    draw().vertices.push_back(std::move(vertex));
  }

  void read_triangle() { read_primitive(Primitive::triangles); }
  void read_line() { read_primitive(Primitive::lines); }
  void read_point() { read_primitive(Primitive::points); }

  void read_primitive(Primitive primitive) {
    if (draw().triangles.empty()) first_primitive_ = primitive, primitive_line_ = line_;
    if (primitive != first_primitive_) fail("a draw has triangles, lines or points, and one kind of them");
    SceneTriangle triangle;
    const std::size_t corners = corners_of(primitive);
    for (std::size_t i = 0; i < 3; ++i) triangle.vertices[i] = vertex_number(fields_[std::min(i + 1, corners)]);
    if (fields_.size() > corners + 1) {
      if (fields_.size() != corners + 3 || fields_[corners + 1] != "id")
        fail(std::string(fields_[0]) + ": 'id' and a number may follow the vertices");
      triangle.identifier = integer<std::uint32_t>(fields_[corners + 2], 0, kNoTriangle);
      if (*triangle.identifier == kNoTriangle) fail("id 4294967295 is what an empty sample holds (B5)");
    }
    std::vector<SceneTriangle>& triangles = draw().triangles;
    if (!triangles.empty() && triangles[0].identifier.has_value() != triangle.identifier.has_value()) {
      fail("id on some triangles of the draw only");
    }
    triangles.push_back(triangle);
  }

  std::string_view rest_;  // the text from the next line on
  std::string_view file_;
  std::size_t line_ = 0;  // the number of the line in fields_, from 1
  std::vector<std::string_view> fields_;
  bool version_read_ = false, has_comment_ = false, has_target_ = false;
  Seen frame_seen_;
  std::size_t components_ = 0;   // of all attributes
  std::uint64_t triangles_ = 0;  // in the draws before this one
  std::size_t initial_depth_line_ = 0, conservative_line_ = 0, locations_line_ = 0, primitive_line_ = 0;
  Primitive first_primitive_ = Primitive::triangles;  // of the draw at hand
  Scene scene_;
};

const std::array<Reader::Keyword, 10> Reader::kFrameKeywords{{
    {"target", "WIDTH HEIGHT", 2, 2, false, &Reader::read_target},
    {"samples", "N", 1, 1, false, &Reader::read_samples},
    {"depth-test", "less|greater|less-equal|greater-equal", 1, 1, false, &Reader::read_depth_test},
    {"attribute-location", "centre|centroid", 1, 1, false, &Reader::read_attribute_location},
    {"origin", "X Y", 2, 2, false, &Reader::read_origin},
    {"sample-locations", "X Y...", 2, 32, false, &Reader::read_sample_locations},
    {"layers", "N", 1, 1, false, &Reader::read_layers},
    {"outputs", "[winding] [numbers] [conservative-index]", 1, 3, false, &Reader::read_outputs},
    {"initial-depth", "Z...", 1, kAnyCount, true, &Reader::read_initial_depth},
    {"attribute", "NAME COMPONENTS INTERPOLATION", 3, 3, true, &Reader::read_attribute},
}};

const std::array<Reader::Keyword, 7> Reader::kDrawKeywords{{
    {"viewport", "X Y WIDTH HEIGHT NEAR FAR [DEPTH-RANGE [Y-DIRECTION]]", 6, 8, false, &Reader::read_viewport},
    {"first-index", "N", 1, 1, false, &Reader::read_first_index},
    {"interpolation", "NAME INTERPOLATION", 2, 2, true, &Reader::read_interpolation},
    {"vertex", "X Y Z W [VALUES]", 4, kAnyCount, true, &Reader::read_vertex},
    {"triangle", "I J K [id N]", 3, 5, true, &Reader::read_triangle},
    {"point", "I [id N]", 1, 3, true, &Reader::read_point},
    {"line", "I J [id N]", 2, 4, true, &Reader::read_line},
}};

}  // namespace

Scene read_scene(std::string_view text, std::string_view file) {
  return Reader(text, file).read();
}

}  // namespace surefill::corpus
