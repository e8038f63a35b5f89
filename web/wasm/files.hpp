// SPDX-License-Identifier: Apache-2.0
//
// Files that the page hands in: the corpus.
#ifndef SUREFILL_WEB_FILES_HPP
#define SUREFILL_WEB_FILES_HPP

#include <string>

namespace surefill::web {

// The text of a file; null: there is none of this name.
const std::string* file_text(const std::string& path);

// From here on there is a file of this path and text.
void add_file(const std::string& path, std::string text);

}  // namespace surefill::web

#endif  // SUREFILL_WEB_FILES_HPP
