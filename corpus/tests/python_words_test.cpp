// SPDX-License-Identifier: Apache-2.0
//
// python/surefill/_words.py is made here, from the table of a draw's fields and the words of scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "corpus/draw_fields.hpp"

namespace surefill::corpus {
namespace {

std::string python_name(std::string_view word) {
  std::string name(word);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// A line of the module: the words of an enumeration; a word's place is the enumerator's value.
template <typename Table>
std::string words_line(std::string_view name, const Table& table) {
  std::string line = "    \"" + python_name(name) + "\": (";
  std::size_t value = 0;
  for (const auto& [enumerator, word] : table) {
    EXPECT_EQ(static_cast<std::size_t>(enumerator), value++) << name << " " << word;
    line += (value == 1 ? "\"" : " \"") + python_name(word) + "\",";
  }
  return line + "),\n";
}

std::string python_words() {
  std::string text =
      "# SPDX-License-Identifier: Apache-2.0\n"
      "\"\"\"The words of enumerations, in the order of their values; made from the table of a draw's fields, by "
      "corpus/tests/python_words_test.cpp.\"\"\"\n\nfrom typing import Dict, Tuple\n\nWORDS: Dict[str, Tuple[str, "
      "...]] "
      "= {\n";
  for_each_draw_field([&]<typename Value>(const DrawField<Value>& field) {
    if constexpr (std::is_enum_v<Value>) text += words_line(field.name, names_of<Value>());
  });
  text += words_line("grid-rounding", kGridRoundingNames);
  text += words_line("depth-test", kDepthTestNames);
  text += words_line("attribute-location", kAttributeLocationNames);
  text += words_line("interpolation", kInterpolationNames);
  text += words_line("clip-depth", kClipDepthNames);
  text += words_line("clip-y", Names<ClipY, 2>{{{ClipY::up, "up"}, {ClipY::down, "down"}}});
  return text + "}\n";
}

TEST(PythonWords, AreThoseOfTheTable) {
  const std::filesystem::path file = std::filesystem::path(SUREFILL_CORPUS).parent_path() / "python/surefill/_words.py";
  std::ifstream in(file);
  const std::string found{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(found, python_words()) << "the right-hand text belongs into " << file;
}

}  // namespace
}  // namespace surefill::corpus
