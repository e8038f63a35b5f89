// SPDX-License-Identifier: Apache-2.0
//
// Scenes as files.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <system_error>

#include "corpus/scene.hpp"

namespace surefill::corpus {
namespace {

namespace fs = std::filesystem;

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
