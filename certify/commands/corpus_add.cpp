// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/corpus_add.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "corpus/scene.hpp"

namespace surefill::certify {

namespace {

namespace fs = std::filesystem;

// A name that is a file name everywhere.
bool is_plain(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  };
  return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), plain);
}

}  // namespace

std::string add_to_corpus(const CorpusAddOptions& options) {
  if (options.origin.empty() || options.origin.find_first_of("\r\n") != std::string::npos) {
    throw std::runtime_error("--origin needs one line that is not empty");
  }
  const std::string name = options.name.empty() ? fs::path(options.finding).stem().string() : options.name;
  if (!is_plain(name) || !is_plain(options.group)) {
    throw std::runtime_error(name + ": give it a name of letters, digits, '-', '_' and '.' with --name");
  }
  corpus::Scene scene = corpus::read_scene_file(options.finding);
  const std::string said = scene.comment;
  scene.comment.clear();
  {
    const corpus::Frame frame(scene);
    if (const Status status = validate(frame.target(), frame.draws()); status != Status::ok) {
      throw std::runtime_error(options.finding + ": " + status_text(status));
    }
  }
  const fs::path cases = fs::path(options.corpus) / "cases";
  for (const std::string& path : corpus::list_corpus(cases.string())) {
    corpus::Scene other = corpus::read_scene_file(path);
    other.comment.clear();
    if (corpus::equal(scene, other)) throw std::runtime_error(options.finding + ": the corpus has it as " + path);
  }
  const fs::path path = cases / options.group / (name + ".scene");
  if (fs::exists(path)) throw std::runtime_error(path.string() + " is there already: choose another --name");
  scene.comment = (said.empty() ? name : said) + "\nOrigin: " + options.origin;
  fs::create_directories(path.parent_path());
  corpus::write_scene_file(scene, path.string());
  return path.string();
}

}  // namespace surefill::certify
