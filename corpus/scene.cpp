// SPDX-License-Identifier: Apache-2.0
//
// Scenes as values and as files.
#include "corpus/scene.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <system_error>

namespace surefill::corpus {
namespace {

namespace fs = std::filesystem;

// Equality of what is written: bit for bit, but all NaNs are alike.
bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) { return same(x, y); });
}

bool same(const SceneVertex& a, const SceneVertex& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w) && same(a.attributes, b.attributes);
}

bool same(const Vertex& a, const Vertex& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w);
}

bool same(const SceneTriangle& a, const SceneTriangle& b) {
  return a.vertices == b.vertices && a.identifier == b.identifier;
}

bool same(const SceneAttribute& a, const SceneAttribute& b) {
  return a.name == b.name && a.components == b.components && a.interpolation == b.interpolation;
}

bool same(const Viewport& a, const Viewport& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.width, b.width) && same(a.height, b.height) &&
         same(a.near_depth, b.near_depth) && same(a.far_depth, b.far_depth) && a.clip_depth == b.clip_depth &&
         a.clip_y == b.clip_y;
}

template <typename Range>
bool same_elements(const Range& a, const Range& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const std::optional<DepthBias>& a, const std::optional<DepthBias>& b) {
  return a.has_value() == b.has_value() && (!a || (same(a->constant, b->constant) && same(a->slope, b->slope)));
}

// The state with its floats by their bits.
bool same(const DrawState& a, const DrawState& b) {
  DrawState x = a, y = b;
  x.culling_box.reset(), y.culling_box.reset();
  x.depth_bias.reset(), y.depth_bias.reset();
  return x == y && same(a.depth_bias, b.depth_bias) && a.culling_box.has_value() == b.culling_box.has_value() &&
         (!a.culling_box || same_elements(*a.culling_box, *b.culling_box));
}

template <typename Value>
bool same_optional(const std::optional<Value>& a, const std::optional<Value>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

bool same(const SceneDraw& a, const SceneDraw& b) {
  return same_optional(a.viewport, b.viewport) && same_elements(a.vertices, b.vertices) &&
         same_elements(a.triangles, b.triangles) && a.first_index == b.first_index && same(a.state(), b.state());
}

std::string error_text(int code) {
  return std::generic_category().message(code);
}

struct Closer {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

// Creates the file, which must not exist, and writes the text; returns 0 or the errno of the first failure.
int write_new_file(const fs::path& path, const std::string& text) {
  errno = 0;
  File file(std::fopen(path.c_str(), "wbx"));
  if (!file) return errno;
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const int code = written ? 0 : errno;
  const bool closed = std::fclose(file.release()) == 0;
  return written && !closed ? errno : code;
}

}  // namespace

bool equal(const Scene& a, const Scene& b) {
  return a.comment == b.comment && a.width == b.width && a.height == b.height && a.samples == b.samples &&
         a.depth_test == b.depth_test && a.attribute_location == b.attribute_location && a.origin == b.origin &&
         a.sample_locations == b.sample_locations && a.layers == b.layers && a.more == b.more &&
         same(a.initial_depth, b.initial_depth) && same_elements(a.attributes, b.attributes) &&
         std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(),
                    [](const SceneDraw& x, const SceneDraw& y) { return same(x, y); });
}

Scene read_scene_file(const std::string& path) {
  if (fs::is_directory(path)) throw SceneError(path + ": is a directory");
  errno = 0;
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw SceneError(path + ": " + error_text(errno));
  std::string text;
  std::array<char, 65536> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    text.append(buffer.data(), size);
  }
  if (std::ferror(file.get()) != 0) throw SceneError(path + ": " + error_text(errno));
  return read_scene(text, path);
}

void write_scene_file(const Scene& scene, const std::string& path) {
  const std::string text = write_scene(scene);
  fs::path temporary = path;
  temporary += ".new-" + std::to_string(std::random_device{}());
  int code = write_new_file(temporary, text);
  const bool created = code != EEXIST;
  if (code == 0) {
    std::error_code renamed;
    fs::rename(temporary, path, renamed);
    code = renamed.value();
  }
  if (code == 0) return;
  std::error_code ignored;
  if (created) fs::remove(temporary, ignored);
  throw SceneError(path + ": " + error_text(code));
}

std::vector<std::string> list_corpus(const std::string& directory) {
  std::vector<std::string> paths;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory)) {
      if (entry.path().extension() == ".scene" && entry.is_regular_file()) paths.push_back(entry.path().string());
    }
  } catch (const fs::filesystem_error& error) {
    throw SceneError(directory + ": " + error.code().message());
  }
  if (paths.empty()) throw SceneError(directory + ": no .scene file");
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace surefill::corpus
