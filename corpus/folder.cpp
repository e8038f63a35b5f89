// SPDX-License-Identifier: Apache-2.0
#include "corpus/folder.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

namespace surefill::corpus {

std::string corpus_folder(const std::string& built_from) {
  std::vector<std::filesystem::path> places{built_from};
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    places.push_back(program.parent_path() / "corpus");
    places.push_back(program.parent_path().parent_path() / "share" / "surefill" / "corpus");
  }
  for (const std::filesystem::path& place : places) {
    if (std::filesystem::is_directory(place, error)) return place.string();
  }
  return "";
}

}  // namespace surefill::corpus
