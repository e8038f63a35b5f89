// SPDX-License-Identifier: Apache-2.0
#include "corpus/text_file.hpp"

#include <cstdint>
#include <utility>

namespace surefill::corpus {

namespace {

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, std::string_view> kFormats[] = {
    {"\x1f\x8b"sv, "gzip-compressed"},
    {"BZh"sv, "bzip2-compressed"},
    {"\xfd"
     "7zXZ"sv,
     "xz-compressed"},
    {"\x28\xb5\x2f\xfd"sv, "zstd-compressed"},
    {"PK\x03\x04"sv, "a zip archive"},
    {"glTF"sv, "a GLB file (binary glTF)"},
    {"{"sv, "JSON (glTF?)"},
    {"OFF\n"sv, "an OFF file"},
    {"OFF\r"sv, "an OFF file"},
    {"Kaydara FBX Binary"sv, "an FBX file"},
    {"<?xml"sv, "XML (Collada? X3D?)"},
    {"\x89PNG"sv, "a PNG picture"},
    {"\xff\xfe"sv, "text in UTF-16"},
    {"\xfe\xff"sv, "text in UTF-16"},
};

// 80 bytes that say nothing, the number of triangles, and 50 bytes for each.
bool is_binary_stl(std::string_view text) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;
  if (text.size() <= kHeader + 4) return false;
  std::uint64_t triangles = 0;
  for (std::size_t byte = 4; byte-- > 0;) triangles = triangles << 8 | static_cast<unsigned char>(text[kHeader + byte]);
  return text.size() == kHeader + 4 + kTriangle * triangles;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf"sv;
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

bool is_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n"sv) || bytes.starts_with("ply\r"sv);
}

bool is_stl(std::string_view bytes) {
  return is_binary_stl(bytes) || bytes.starts_with("solid "sv) || bytes.starts_with("solid\n"sv) ||
         bytes.starts_with("solid\r"sv);
}

std::string what_is_not_read(std::string_view text) {
  std::string_view format = is_ply(text) ? "a PLY file"sv : is_stl(text) ? "an STL file"sv : ""sv;
  for (const auto& [begin, name] : kFormats) {
    if (text.starts_with(begin)) format = name;
  }
  if (format.empty()) return "";
  return "this is " + std::string(format) + ": " + std::string(kWhatIsRead);
}

}  // namespace surefill::corpus
