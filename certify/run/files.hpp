// SPDX-License-Identifier: Apache-2.0
//
// Output files that exist whole or not at all.
#ifndef SUREFILL_CERTIFY_FILES_HPP
#define SUREFILL_CERTIFY_FILES_HPP

#include <stdexcept>
#include <string>
#include <string_view>

namespace surefill::certify {

// A file that cannot be read or written. what() is one line "FILE: cause".
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws FileError if `path` can surely not be written: a directory, or in a folder that is missing or not writable. To
// be called before the work whose result goes there.
void check_writable(const std::string& path);

// The same for a folder that files are going to be made in.
void check_folder(const std::string& path);

// Writes through a temporary file in the same folder and a rename. Throws FileError; then nothing is left behind. What
// is no regular file (a pipe, a terminal, /dev/stdout) is written to as it is.
void write_file(const std::string& path, std::string_view bytes);

// A path DIRECTORY/STEM-N.EXTENSION that names no file yet, with the smallest N from 1; an empty file is made there, so
// that nobody else takes it. Throws FileError.
std::string reserve_path(const std::string& directory, const std::string& stem, const std::string& extension);

// A path or a word as a shell takes it.
std::string shell_word(const std::string& path);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_FILES_HPP
