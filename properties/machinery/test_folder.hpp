// SPDX-License-Identifier: Apache-2.0
//
// For tests that run the command: each in a new folder, which is removed after it.
#ifndef SUREFILL_PROPERTIES_TEST_FOLDER_HPP
#define SUREFILL_PROPERTIES_TEST_FOLDER_HPP

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace surefill {

// The bytes of a file; none if it cannot be read.
inline std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

class InFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "surefill-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);  // else the test was skipped before it had one
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

}  // namespace surefill

#endif  // SUREFILL_PROPERTIES_TEST_FOLDER_HPP
