// SPDX-License-Identifier: Apache-2.0
//
// Output files that exist whole or not at all.
#ifndef SUREFILL_CERTIFY_FILES_HPP
#define SUREFILL_CERTIFY_FILES_HPP

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace surefill::certify {

// A file that cannot be read or written. what() is one line "FILE: cause".
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws FileError if `path` can surely not be written: a directory, or in a folder that is missing or not writable. To
// be called before the work whose result goes there.
void check_writable(const std::string& path);

// What a call writes, and the option that says so.
struct OutputFile {
  std::string option, path;
  std::vector<std::string> endings;  // that say what is written, such as ".png"; empty: any
};

// Does the name end so, in capitals or not, and have more before it?
bool has_ending(const std::string& path, std::string_view ending);

// Throws FileError unless every output can be written, has an ending that says what it is, and is neither an input nor
// another output of the call, by whatever name, link or path. Outputs without a path are not asked for. What is no
// regular file (a pipe, /dev/stdout) may have any name.
void check_outputs(std::span<const OutputFile> outputs, std::span<const std::string> inputs);

// The same as check_writable for a folder that files are going to be made in.
void check_folder(const std::string& path);

// Writes through a temporary file in the same folder and a rename. Throws FileError; then nothing is left behind. Where
// the path is a link, it stays one, and what it names is written. What is no regular file (a pipe, a terminal,
// /dev/stdout) is written to as it is.
void write_file(const std::string& path, std::string_view bytes);

// A path DIRECTORY/STEM-N.EXTENSION that names no file yet, with the smallest N from 1; an empty file is made there, so
// that nobody else takes it. Throws FileError.
std::string reserve_path(const std::string& directory, const std::string& stem, const std::string& extension);

// A path or a word as a shell takes it.
std::string shell_word(const std::string& path);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_FILES_HPP
