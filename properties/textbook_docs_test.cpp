// SPDX-License-Identifier: Apache-2.0
//
// The pictures of docs/textbook.md are what the commands beside them make.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace surefill::properties {
namespace {

const std::filesystem::path kRoot = std::filesystem::path(SUREFILL_CORPUS).parent_path();

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> documented_commands() {
  std::ifstream page(kRoot / "docs/textbook.md");
  std::vector<std::string> commands;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("    surefill explain ") && line.find(" -o ") != std::string::npos)
      commands.push_back(line.substr(4));
  }
  return commands;
}

TEST(TextbookDocs, PicturesAreWhatTheCommandsMake) {
  const std::filesystem::path made = std::filesystem::path(testing::TempDir()) / "surefill_textbook.svg";
  const std::string page = contents(kRoot / "docs/textbook.md");
  std::size_t pictures = 0;
  for (const std::string& command : documented_commands()) {
    const std::size_t output = command.find(" -o ");
    const std::string picture = command.substr(output + 4);
    const std::string call = "cd '" + kRoot.string() + "' && '" SUREFILL_COMMAND "'" + command.substr(8, output - 8) +
                             " -o '" + made.string() + "'";
    ASSERT_EQ(std::system(call.c_str()), 0) << command;
    EXPECT_TRUE(contents(made) == contents(kRoot / picture)) << picture << " is not what this makes: " << command;
    EXPECT_NE(page.find("(" + picture.substr(5) + ")"), std::string::npos) << picture << " is not shown on the page";
    ++pictures;
  }
  EXPECT_GE(pictures, 12u);
  std::filesystem::remove(made);
}

}  // namespace
}  // namespace surefill::properties
