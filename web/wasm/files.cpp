// SPDX-License-Identifier: Apache-2.0
//
// Files in memory: those that the page hands in, and names for those that it may save.
#include "web/wasm/files.hpp"

#include <map>
#include <set>

#include "certify/report/report.hpp"
#include "certify/run/files.hpp"
#include "corpus/folder.hpp"
#include "corpus/scene.hpp"

namespace surefill {

namespace web {

namespace {

std::map<std::string, std::string>& files() {
  static std::map<std::string, std::string> all;
  return all;
}

}  // namespace

const std::string* file_text(const std::string& path) {
  const auto found = files().find(path);
  return found == files().end() ? nullptr : &found->second;
}

void add_file(const std::string& path, std::string text) {
  files()[path] = std::move(text);
}

}  // namespace web

namespace corpus {

std::string corpus_folder(const std::string& built_from) {
  return built_from;
}

Scene read_scene_file(const std::string& path) {
  const std::string* text = web::file_text(path);
  if (text == nullptr) throw SceneError(path + ": no such file");
  return read_scene(*text, path);
}

void write_scene_file(const Scene&, const std::string&) {
  // The certificate has its text.
}

std::vector<std::string> list_corpus(const std::string& directory) {
  std::vector<std::string> paths;
  for (const auto& [path, text] : web::files()) {
    if (path.starts_with(directory + "/") && path.ends_with(".scene")) paths.push_back(path);
  }
  if (paths.empty()) throw SceneError(directory + ": no .scene file");
  return paths;
}

}  // namespace corpus

namespace certify {

std::string cpu_model() {
  return "unknown";  // the page says what it runs on
}

std::string reserve_path(const std::string&, const std::string& stem, const std::string& extension) {
  static std::set<std::string> taken;
  for (int number = 1;; ++number) {
    const std::string path = stem + "-" + std::to_string(number) + extension;
    if (taken.insert(path).second) return path;
  }
}

}  // namespace certify

}  // namespace surefill
