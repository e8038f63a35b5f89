// SPDX-License-Identifier: Apache-2.0
//
// Are the images of this machine those of corpus/hashes.txt? A program of the engine and the corpus reader alone, so that
// it can be built for any machine.
//
//     surefill_hashes [--reference] [--threads N] [--part I/N] HASHES FOLDER...
//
// Draws each scene that HASHES names, from the first FOLDER that has it (a name without ending gets .scene), and prints
// what drew it and how many lines are equal. --part: every N-th line, from I on (0 <= I < N). Exit 0: all of them; 1: not.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "corpus/hash.hpp"
#include "corpus/scene.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace {

using namespace surefill;

struct Arguments {
  Options options;
  int part = 0, parts = 1;
  std::string hashes;
  std::vector<std::string> folders;
};

// A whole number, up to what follows it.
int number(const char*& text) {
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (end == text || value < 0 || value > 256) throw std::invalid_argument(std::string("not a number: ") + text);
  text = end;
  return static_cast<int>(value);
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--reference") {
      arguments.options.path = Path::reference;
    } else if ((word == "--threads" || word == "--part") && i + 1 < argc) {
      const char* text = argv[++i];
      const int first = number(text);
      if (word == "--threads") {
        arguments.options.threads = first;
      } else if (*text == '/') {
        arguments.part = first, arguments.parts = number(++text);
      }
      if (*text != '\0') throw std::invalid_argument(std::string("not understood: ") + argv[i]);
    } else if (word.starts_with('-')) {
      throw std::invalid_argument("unknown option " + std::string(word));
    } else if (arguments.hashes.empty()) {
      arguments.hashes = word;
    } else {
      arguments.folders.emplace_back(word);
    }
  }
  if (arguments.folders.empty() || arguments.part >= arguments.parts) {
    throw std::invalid_argument("usage: surefill_hashes [--reference] [--threads N] [--part I/N] HASHES FOLDER...");
  }
  return arguments;
}

// False if there is no such file. By the C library: not every standard library of C++ has files.
bool read_file(const std::string& path, std::string& text) {
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  char some[4096];
  text.clear();
  for (std::size_t n = std::fread(some, 1, sizeof some, file); n > 0; n = std::fread(some, 1, sizeof some, file))
    text.append(some, n);
  std::fclose(file);
  return true;
}

corpus::Scene scene_of(const std::vector<std::string>& folders, const std::string& name) {
  const std::string file = name.ends_with(".scene") ? name : name + ".scene";
  std::string text;
  for (const std::string& folder : folders) {
    if (read_file(folder + "/" + file, text)) return corpus::read_scene(text, folder + "/" + file);
  }
  throw std::runtime_error("no folder has " + file);
}

// What draws frames with these options: "reference", or an instruction set.
std::string drawn_by(const Options& options) {
  std::uint32_t count = 0;
  Target target;
  target.width = target.height = 1, target.count = {&count, 1};
  Diagnostics diagnostics;
  Options with = options;
  with.diagnostics = &diagnostics;
  if (const Status status = render(target, {}, nullptr, with); status != Status::ok) {
    throw std::runtime_error(status_text(status));
  }
  return diagnostics.path;
}

int run(const Arguments& arguments) {
  std::string text;
  if (!read_file(arguments.hashes, text)) throw std::runtime_error(arguments.hashes + ": cannot be read");
  std::istringstream file(text);
  std::string expected, name;
  int line = 0, lines = 0, equal = 0;
  while (file >> expected >> name) {
    if (line++ % arguments.parts != arguments.part) continue;
    const corpus::Scene scene = scene_of(arguments.folders, name);
    const std::string actual = corpus::hash_of(scene, arguments.options);
    ++lines;
    if (actual == expected) {
      ++equal;
    } else {
      std::printf("%s is %s and not %s\n", name.c_str(), actual.c_str(), expected.c_str());
    }
  }
  std::printf("%s: %d of %d lines equal\n", drawn_by(arguments.options).c_str(), equal, lines);
  return lines > 0 && equal == lines ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surefill_hashes: %s\n", error.what());
    return 2;
  }
}
