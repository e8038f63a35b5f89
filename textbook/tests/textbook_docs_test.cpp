// SPDX-License-Identifier: Apache-2.0
//
// The pictures and the table of docs/textbook.md are what the commands beside them make.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "properties/machinery/test_folder.hpp"

namespace surefill::properties {
namespace {

const std::filesystem::path kRoot = std::filesystem::path(SUREFILL_CORPUS).parent_path();

class TextbookDocs : public InFolder {};

std::vector<std::string> documented_commands() {
  std::ifstream page(kRoot / "docs/textbook.md");
  std::vector<std::string> commands;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("    surefill explain ") && line.find(" -o ") != std::string::npos)
      commands.push_back(line.substr(4));
  }
  return commands;
}

TEST_F(TextbookDocs, PicturesAreWhatTheCommandsMake) {
  const std::string made = path("made.svg");
  const std::string page = contents(kRoot / "docs/textbook.md");
  std::size_t pictures = 0;
  for (const std::string& command : documented_commands()) {
    const std::size_t output = command.find(" -o ");
    const std::string picture = command.substr(output + 4);
    const std::string call =
        "cd '" + kRoot.string() + "' && '" SUREFILL_COMMAND "'" + command.substr(8, output - 8) + " -o '" + made + "'";
    ASSERT_EQ(std::system(call.c_str()), 0) << command;
    EXPECT_TRUE(contents(made) == contents(kRoot / picture)) << picture << " is not what this makes: " << command;
    EXPECT_NE(page.find("(" + picture.substr(5) + ")"), std::string::npos) << picture << " is not shown on the page";
    ++pictures;
  }
  EXPECT_GE(pictures, 12u);
}

// PNG is made by librsvg's program; without it the command says so, and leaves nothing behind.
TEST_F(TextbookDocs, PicturesCanBePng) {
  const std::string scene = (kRoot / "docs/textbook/small.scene").string(),
                    call = "cd '" + folder_.string() + "' && '" SUREFILL_COMMAND "' explain '" + scene +
                           "' -o a.png 2>err.txt";
  const bool can = std::system("command -v rsvg-convert >/dev/null") == 0;
  EXPECT_EQ(std::system(call.c_str()) == 0, can);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, can ? 2u : 1u);
  if (can) {
    EXPECT_TRUE(contents(folder_ / "a.png").starts_with("\x89PNG\r\n\x1a\n"));
  } else {
    EXPECT_NE(contents(folder_ / "err.txt").find("librsvg2-bin"), std::string::npos);
  }
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// The cells of a row of Markdown.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream line(row.substr(1));
  for (std::string cell; std::getline(line, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

// With as many decimals as the page has, and a comma at each thousand.
std::string written_like(const std::string& on_page, double value) {
  const std::size_t point = on_page.find('.');
  std::array<char, 64> digits{};
  std::snprintf(digits.data(), digits.size(), "%.*f",
                point == std::string::npos ? 0 : static_cast<int>(on_page.size() - point - 1), value);
  std::string text = digits.data();
  for (std::size_t at = std::min(text.find('.'), text.size()); at > 3;) text.insert(at -= 3, ",");
  return text;
}

TEST_F(TextbookDocs, TheCountTableIsWhatTheCommandPrints) {
  const std::string printed = path("counts.txt");
  ASSERT_EQ(std::system(("'" SUREFILL_COMMAND "' explain --counts >'" + printed + "'").c_str()), 0);
  // Visits and edge evaluations by "KIND TRAVERSAL".
  std::map<std::string, std::array<double, 2>> counts;
  std::ifstream lines(printed);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream numbers(line.substr(38));
    double visits = 0, tiles = 0, edges = 0;
    numbers >> visits >> tiles >> edges;
    EXPECT_TRUE(numbers) << line;
    counts[trimmed(line.substr(0, 20)) + " " + trimmed(line.substr(20, 18))] = {visits, edges};
  }
  std::ifstream page(kRoot / "docs/textbook.md");
  std::vector<std::string> kinds;
  std::size_t compared = 0;
  while (std::getline(page, line)) {
    if (!line.starts_with("| ")) {
      kinds.clear();
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    if (cells[0].starts_with("visited")) kinds = cells;
    if (kinds.empty() || cells[0].starts_with("visited") || cells[0].starts_with("-")) continue;
    ASSERT_EQ(cells.size(), kinds.size()) << line;
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const auto found = counts.find(kinds[k] + " " + cells[0]);
      ASSERT_NE(found, counts.end()) << kinds[k] + " " + cells[0];
      const std::size_t bracket = cells[k].find(" (");
      ASSERT_NE(bracket, std::string::npos) << line;
      const std::string visits = cells[k].substr(0, bracket),
                        edges = cells[k].substr(bracket + 2, cells[k].size() - bracket - 3);
      EXPECT_EQ(visits, written_like(visits, found->second[0])) << kinds[k] << " " << cells[0];
      EXPECT_EQ(edges, written_like(edges, found->second[1])) << kinds[k] << " " << cells[0];
      ++compared;
    }
  }
  EXPECT_EQ(compared, 35u);
}

}  // namespace
}  // namespace surefill::properties
