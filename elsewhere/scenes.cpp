// SPDX-License-Identifier: Apache-2.0
//
// Writes the random scenes of corpus/hashes.txt as files, for machines that have not what generates them (integers of
// 128 bits): surefill_hashed_scenes FOLDER writes FOLDER/NAME.scene for each.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "corpus/scene.hpp"
#include "properties/generators/hashed_scenes.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: surefill_hashed_scenes FOLDER\n", stderr), 2;
  try {
    const std::filesystem::path folder = argv[1];
    surefill::properties::for_each_hashed_scene([&](const std::string& name, const surefill::corpus::Scene& scene) {
      const std::filesystem::path path = folder / (name + ".scene");
      std::filesystem::create_directories(path.parent_path());
      surefill::corpus::write_scene_file(scene, path.string());
    });
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "surefill_hashed_scenes: %s\n", error.what()), 1;
  }
  return 0;
}
