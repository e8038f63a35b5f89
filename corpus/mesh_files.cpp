// SPDX-License-Identifier: Apache-2.0
#include "corpus/mesh_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "corpus/float_text.hpp"
#include "corpus/mesh.hpp"

namespace surefill::meshes {

namespace {

[[noreturn]] void fail(std::string_view file, const std::string& cause) {
  throw MeshError(fmt::format("{}: {}", file, cause));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

// What is shown of a word that is wrong: printable, and not too long.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return '"' + text + '"';
}

// The lines of a text, with their numbers.
class Lines {
 public:
  Lines(std::string_view bytes, std::string_view file) : rest_(bytes), file_(file) {}

  // The words of the next line; with `skip_empty` of the next that has some. False at the end.
  bool next(std::vector<std::string_view>& words, bool skip_empty) {
    do {
      if (rest_.empty()) return false;
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      words = words_of(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
    } while (words.empty() && skip_empty);
    return true;
  }

  [[noreturn]] void fail(const std::string& cause) const {
    throw MeshError(fmt::format("{}:{}: {}", file_, number_, cause));
  }

  // What comes after the lines read.
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_, file_;
  std::size_t number_ = 0;
};

// ---- numbers
enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::array<std::int64_t, 6> kLeast = {-128, 0, -32768, 0, -2147483648LL, 0},
                                      kMost = {127, 255, 32767, 65535, 2147483647, 4294967295};

std::optional<Type> type_named(std::string_view name) {
  static constexpr std::string_view kOld[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  static constexpr std::string_view kNew[] = {"int8",  "uint8",  "int16",   "uint16",
                                              "int32", "uint32", "float32", "float64"};
  for (std::size_t k = 0; k < 8; ++k) {
    if (name == kOld[k] || name == kNew[k]) return static_cast<Type>(k);
  }
  return std::nullopt;
}

bool is_whole(Type type) {
  return type < Type::float32;
}

// A value of a file. Whole numbers are exact in double, too.
using Value = double;

// The type has it as decimals; nothing, if the word is no such number. Beyond range: 0 or an infinity, as IEEE 754
// rounds.
std::optional<Value> number_of(std::string_view word, Type type) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const last = word.data() + word.size();
  if (is_whole(type)) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), last, value);
    const auto k = static_cast<std::size_t>(type);
    const bool good = error == std::errc() && end == last && value >= kLeast[k] && value <= kMost[k];
    return good ? std::optional(static_cast<Value>(value)) : std::nullopt;
  }
  // A float32's decimals are rounded to it at once, not by way of a double.
  float narrow = 0;
  double wide = 0;
  auto result = type == Type::float32 ? corpus::float_from_chars(word.data(), last, narrow)
                                      : corpus::float_from_chars(word.data(), last, wide);
  if (result.ec == std::errc() && type == Type::float32) wide = narrow;
  if (result.ec == std::errc::result_out_of_range && type == Type::float32) {
    result = corpus::float_from_chars(word.data(), last, wide);
    wide = static_cast<float>(wide);
  }
  const bool good = result.ec == std::errc() && result.ptr == last;
  return good ? std::optional(wide) : std::nullopt;
}

// Precondition: enough bytes are there.
Value number_at(const char* bytes, Type type, bool big_endian) {
  const std::size_t size = kSizes[static_cast<std::size_t>(type)];
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < size; ++k) {
    bits |= std::uint64_t{static_cast<unsigned char>(bytes[big_endian ? size - 1 - k : k])} << (8 * k);
  }
  switch (type) {
    case Type::int8:
      return static_cast<std::int8_t>(bits);
    case Type::int16:
      return static_cast<std::int16_t>(bits);
    case Type::int32:
      return static_cast<std::int32_t>(bits);
    case Type::float32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case Type::float64:
      return std::bit_cast<double>(bits);
    default:
      return static_cast<Value>(bits);
  }
}

// ---- PLY
struct Property {
  std::string name;
  Type type{};
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class Ply {
 public:
  Ply(std::string_view bytes, std::string_view file) : file_(file), lines_(bytes, file) {
    read_header();
    rest_ = lines_.rest();
    for (const Element& element : elements_) read_element(element);
    std::vector<std::string_view> more;
    if (is_ascii_ && lines_.next(more, true)) lines_.fail("more lines than the header's elements have");
    if (!is_ascii_ && !rest_.empty()) {
      fail(file_, fmt::format("{} bytes more than the header's elements have", rest_.size()));
    }
  }

  std::string obj() const {
    std::string text;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      const Float3& p = positions_[v];
      fmt::format_to(std::back_inserter(text), "v {} {} {}\n", p[0], p[1], p[2]);
      if (normals_.empty()) continue;
      const Float3& n = normals_[v];
      fmt::format_to(std::back_inserter(text), "vn {} {} {}\n", n[0], n[1], n[2]);
    }
    std::size_t corner = 0;
    for (std::size_t face = 0; face < sizes_.size(); ++face) {
      text += 'f';
      for (std::size_t k = 0; k < sizes_[face]; ++k) {
        const std::int64_t index = corners_[corner++];
        if (index < 0 || index >= static_cast<std::int64_t>(positions_.size())) {
          fail(file_, fmt::format("face {} names vertex {}, but there are {} (they count from 0)", face, index,
                                  positions_.size()));
        }
        fmt::format_to(std::back_inserter(text), " {}", index + 1);
        if (!normals_.empty()) fmt::format_to(std::back_inserter(text), "//{}", index + 1);
      }
      text += '\n';
    }
    return text;
  }

 private:
  using Words = std::vector<std::string_view>;

  // ---- the header
  void read_header() {
    Words words;
    if (!lines_.next(words, false) || words != Words{"ply"})
      fail(file_, "not a PLY file: its first line is not \"ply\"");
    bool has_format = false;
    for (bool more = true; more;) {
      if (!lines_.next(words, false)) fail(file_, "it ends within its header (there is no \"end_header\")");
      const std::string_view word = words.empty() ? std::string_view() : words[0];
      if (word == "format") {
        read_format(words, has_format);
        has_format = true;
      } else if (word == "element") {
        read_element_line(words);
      } else if (word == "property") {
        read_property(words);
      } else if (word == "end_header") {
        more = false;
      } else if (word != "comment" && word != "obj_info") {
        lines_.fail(words.empty() ? "an empty line in the header" : shown(word) + " is no line of a PLY header");
      }
    }
    if (!has_format) lines_.fail("the header has no line \"format\"");
    const auto named = [this](std::string_view name) {
      return std::find_if(elements_.begin(), elements_.end(), [name](const Element& e) { return e.name == name; });
    };
    if (named("vertex") == elements_.end()) fail(file_, "no element \"vertex\" in it");
    for (const char* axis : {"x", "y", "z"}) {
      const auto is_axis = [axis](const Property& p) { return p.name == axis && !p.count; };
      const auto& properties = named("vertex")->properties;
      if (std::none_of(properties.begin(), properties.end(), is_axis)) {
        fail(file_, fmt::format("its element \"vertex\" has no property \"{}\"", axis));
      }
    }
    const auto face = named("face");
    if (face == elements_.end()) {
      fail(file_, named("tristrips") == elements_.end()
                      ? "no triangle in it: it has no element \"face\""
                      : "its triangles are strips (\"tristrips\"), which are not read");
    }
    if (std::none_of(face->properties.begin(), face->properties.end(), is_corners)) {
      fail(file_, "its element \"face\" has no list \"vertex_indices\" of whole numbers");
    }
  }

  static bool is_corners(const Property& p) {
    return (p.name == "vertex_indices" || p.name == "vertex_index") && p.count && is_whole(p.type);
  }

  void read_format(const Words& words, bool again) {
    if (again) lines_.fail("a second line \"format\"");
    const bool known = words.size() == 3 && words[2] == "1.0";
    is_ascii_ = known && words[1] == "ascii";
    big_endian_ = known && words[1] == "binary_big_endian";
    if (!is_ascii_ && !big_endian_ && !(known && words[1] == "binary_little_endian")) {
      lines_.fail("the format must be ascii, binary_little_endian or binary_big_endian, and 1.0");
    }
  }

  void read_element_line(const Words& words) {
    Element element;
    if (words.size() == 3) element.name = words[1];
    const auto parsed = words.size() == 3
                            ? std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count)
                            : std::from_chars_result{nullptr, std::errc::invalid_argument};
    constexpr std::uint64_t kMostElements = 0xFFFFFFFE;
    if (parsed.ec != std::errc() || parsed.ptr != words[2].data() + words[2].size() || element.count > kMostElements) {
      lines_.fail(fmt::format("an element has a name and a number up to {}", kMostElements));
    }
    for (const Element& other : elements_) {
      if (other.name == element.name) lines_.fail("a second element " + shown(element.name));
    }
    elements_.push_back(std::move(element));
  }

  void read_property(const Words& words) {
    if (elements_.empty()) lines_.fail("a property before any element");
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3)
      lines_.fail("a property has a type and a name, or \"list\", two types and a name");
    Property property;
    property.name = words.back();
    const std::optional<Type> type = type_named(words[words.size() - 2]);
    if (is_list) property.count = type_named(words[2]);
    if (!type || (is_list && !property.count)) {
      lines_.fail(shown(!type ? words[words.size() - 2] : words[2]) + " is no type of a PLY file");
    }
    if (is_list && !is_whole(*property.count)) lines_.fail("the length of a list is no whole number");
    property.type = *type;
    for (const Property& other : elements_.back().properties) {
      if (other.name == property.name) lines_.fail("a second property " + shown(property.name));
    }
    elements_.back().properties.push_back(std::move(property));
  }

  // ---- the elements
  void read_element(const Element& element) {
    std::size_t least = 0;  // bytes of one of them
    for (const Property& p : element.properties) least += kSizes[static_cast<std::size_t>(p.count.value_or(p.type))];
    if (is_ascii_) least = element.properties.empty() ? 0 : 1;
    const std::size_t there = is_ascii_ ? lines_.rest().size() : rest_.size();
    if (least > 0 && element.count > there / least) {
      fail(file_, fmt::format("it ends early: {} elements {} do not fit into the {} bytes that are left", element.count,
                              shown(element.name), there));
    }
    if (element.properties.empty() && element.count > 0) {
      fail(file_, fmt::format("its element {} has no property", shown(element.name)));
    }
    const bool has_normals = std::all_of(std::begin(kNormal), std::end(kNormal), [&element](const char* name) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [name](const Property& p) { return p.name == name && !p.count; });
    });
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    for (std::uint64_t n = 0; n < element.count; ++n) {
      begin(element, n);
      Float3 position{}, normal{};
      for (const Property& property : element.properties) {
        const std::uint64_t length = property.count ? length_of(value(*property.count)) : 1;
        const bool corners = is_face && is_corners(property);
        if (corners && length < 3) wrong(fmt::format("a face needs three corners, found {}", length));
        if (corners) sizes_.push_back(static_cast<std::size_t>(length));
        for (std::uint64_t k = 0; k < length; ++k) {
          const Value read = value(property.type);
          if (corners) corners_.push_back(static_cast<std::int64_t>(read));
          if (!is_vertex || property.count) continue;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (property.name == kAxis[axis]) position[axis] = static_cast<float>(read);
            if (property.name == kNormal[axis]) normal[axis] = static_cast<float>(read);
          }
        }
      }
      end();
      if (!is_vertex) continue;
      positions_.push_back(position);
      if (has_normals) normals_.push_back(normal);
    }
  }

  void begin(const Element& element, std::uint64_t number) {
    at_ = &element, number_ = number;
    if (!is_ascii_) return;
    if (!lines_.next(words_, true)) fail(file_, "it ends early, " + where());
    word_ = 0;
  }
  void end() const {
    if (is_ascii_ && word_ != words_.size()) wrong(fmt::format("{} numbers too many", words_.size() - word_));
  }

  Value value(Type type) {
    if (is_ascii_) {
      if (word_ == words_.size()) wrong("too few numbers");
      const std::string_view word = words_[word_++];
      const std::optional<Value> read = number_of(word, type);
      if (!read) wrong(fmt::format("{} is no number of its type", shown(word)));
      return *read;
    }
    const std::size_t size = kSizes[static_cast<std::size_t>(type)];
    if (rest_.size() < size) fail(file_, "it ends early, " + where());
    const Value read = number_at(rest_.data(), type, big_endian_);
    rest_.remove_prefix(size);
    return read;
  }

  std::uint64_t length_of(Value value) const {
    if (value < 0) wrong(fmt::format("a list of {} numbers", value));
    return static_cast<std::uint64_t>(value);
  }

  std::string where() const { return fmt::format("within {} {} of {}", at_->name, number_, at_->count); }
  [[noreturn]] void wrong(const std::string& cause) const {
    if (is_ascii_) lines_.fail(fmt::format("{} ({})", cause, where()));
    fail(file_, fmt::format("{} ({})", cause, where()));
  }

  static constexpr const char* kAxis[] = {"x", "y", "z"};
  static constexpr const char* kNormal[] = {"nx", "ny", "nz"};

  std::string_view file_;
  Lines lines_;
  bool is_ascii_ = false, big_endian_ = false;
  std::vector<Element> elements_;
  // The element at hand, its line of text, or all bytes from here on.
  const Element* at_ = nullptr;
  std::uint64_t number_ = 0;
  Words words_;
  std::size_t word_ = 0;
  std::string_view rest_;
  std::vector<Float3> positions_, normals_;
  std::vector<std::size_t> sizes_;     // corners of each face
  std::vector<std::int64_t> corners_;  // of all faces, one after the other
};

// ---- STL
// Triangles of corners that are put together where they are the same bits.
class Soup {
 public:
  void add(const Float3& corner) {
    const auto key = std::bit_cast<std::array<std::uint32_t, 3>>(corner);
    const auto [entry, is_new] = numbers_.try_emplace(key, numbers_.size() + 1);
    if (is_new) fmt::format_to(std::back_inserter(vertices_), "v {} {} {}\n", corner[0], corner[1], corner[2]);
    fmt::format_to(std::back_inserter(faces_), "{}{}{}", corners_ % 3 == 0 ? "f " : " ", entry->second,
                   corners_ % 3 == 2 ? "\n" : "");
    ++corners_;
  }
  std::string obj() const { return vertices_ + faces_; }

 private:
  std::map<std::array<std::uint32_t, 3>, std::size_t> numbers_;
  std::string vertices_, faces_;
  std::size_t corners_ = 0;
};

constexpr std::size_t kHead = 84, kTriangle = 50;  // bytes of a binary STL file

std::uint64_t binary_triangles(std::string_view bytes) {
  return bytes.size() < kHead ? 0 : static_cast<std::uint64_t>(number_at(bytes.data() + 80, Type::uint32, false));
}

std::string obj_of_binary(std::string_view bytes) {
  Soup soup;
  for (std::size_t at = kHead; at < bytes.size(); at += kTriangle) {
    for (std::size_t corner = 1; corner < 4; ++corner) {
      Float3 point{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const char* const from = bytes.data() + at + 12 * corner + 4 * axis;
        point[axis] = static_cast<float>(number_at(from, Type::float32, false));
      }
      soup.add(point);
    }
  }
  return soup.obj();
}

class AsciiStl {
 public:
  AsciiStl(std::string_view bytes, std::string_view file) : file_(file), lines_(bytes, file) {
    while (lines_.next(words_, true)) {
      expect({"solid"}, 0, false);
      for (line("a facet or \"endsolid\""); !is({"endsolid"}); line("a facet or \"endsolid\"")) {
        expect({"facet", "normal"}, 3, true);
        (void)numbers(2);
        line("\"outer loop\"");
        expect({"outer", "loop"}, 0, true);
        for (int corner = 0; corner < 3; ++corner) {
          line("a vertex");
          expect({"vertex"}, 3, true);
          soup_.add(numbers(1));
        }
        line("\"endloop\"");
        expect({"endloop"}, 0, true);
        line("\"endfacet\"");
        expect({"endfacet"}, 0, true);
      }
    }
  }
  std::string obj() const { return soup_.obj(); }

 private:
  void line(const char* wanted) {
    if (!lines_.next(words_, true)) fail(file_, fmt::format("it ends early: {} is missing", wanted));
  }
  bool is(std::initializer_list<std::string_view> words) const {
    return words.size() <= words_.size() && std::equal(words.begin(), words.end(), words_.begin(), same_word);
  }
  static bool same_word(std::string_view wanted, std::string_view word) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(wanted.begin(), wanted.end(), word.begin(), word.end(),
                      [lower](char a, char b) { return a == lower(b); });
  }
  void expect(std::initializer_list<std::string_view> words, std::size_t numbers, bool exactly) const {
    std::string wanted;
    for (const std::string_view word : words) wanted += (wanted.empty() ? "" : " ") + std::string(word);
    if (!is(words) || (exactly && words_.size() != words.size() + numbers)) {
      lines_.fail(fmt::format("expected \"{}\"{}, found {}", wanted, numbers == 3 ? " and three numbers" : "",
                              shown(words_[0])));
    }
  }
  Float3 numbers(std::size_t first) const {
    Float3 three{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<Value> number = number_of(words_[first + axis], Type::float32);
      if (!number) lines_.fail(shown(words_[first + axis]) + " is not a number");
      three[axis] = static_cast<float>(*number);
    }
    return three;
  }

  std::string_view file_;
  Lines lines_;
  std::vector<std::string_view> words_;
  Soup soup_;
};

}  // namespace

std::string obj_of_ply(std::string_view bytes, std::string_view file) {
  return Ply(bytes, file).obj();
}

std::string obj_of_stl(std::string_view bytes, std::string_view file) {
  // Many binary files begin with "solid", so their size decides.
  const std::uint64_t size = kHead + kTriangle * binary_triangles(bytes);
  if (bytes.size() >= kHead && bytes.size() == size) return obj_of_binary(bytes);
  const std::vector<std::string_view> words = words_of(bytes.substr(0, std::min(bytes.find('\n'), kHead)));
  const bool text = bytes.substr(0, 512).find('\0') == std::string_view::npos;
  if (text && !words.empty()) return AsciiStl(bytes, file).obj();
  if (bytes.size() < kHead) fail(file, "not an STL file: it neither begins with \"solid\" nor has 84 bytes");
  fail(file, fmt::format("a binary STL file of {} triangles has {} bytes, and this one {}", binary_triangles(bytes),
                         size, bytes.size()));
}

}  // namespace surefill::meshes
