// SPDX-License-Identifier: Apache-2.0
#include "certify/run/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace surefill::certify {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  throw FileError(path + ": " + std::generic_category().message(error));
}

fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// Is there something at `path` that a rename would wrongly replace?
bool is_special(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status);
}

bool is_link(const std::string& path) {
  std::error_code error;
  return fs::is_symlink(path, error);
}

// The file that a path means: absolute, without ".", ".." and links, whether it is there or not. A path that cannot be
// followed is given back as it is.
fs::path resolved(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  fs::path at = fs::absolute(path, error);
  // A link to a file that is not there yet is not followed by weakly_canonical.
  for (int n = 0; n < kMostLinks && fs::is_symlink(at, error); ++n) {
    const fs::path to = fs::read_symlink(at, error);
    if (error) return path;
    at = at.parent_path() / to;
  }
  fs::path result = fs::weakly_canonical(at, error);
  return error ? fs::path(path) : result;
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return resolved(a) == resolved(b) || fs::equivalent(a, b, error);
}

// Writes all bytes; the error number or 0.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void check_folder(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) fail(path, ENOENT);
  if (!fs::is_directory(path, error)) fail(path, ENOTDIR);
  if (::access(path.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

bool has_ending(const std::string& path, std::string_view ending) {
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower.size() > ending.size() && lower.ends_with(ending);
}

void check_outputs(std::span<const OutputFile> outputs, std::span<const std::string> inputs) {
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    const OutputFile& output = outputs[n];
    if (output.path.empty()) continue;
    const std::string named = output.option + " " + output.path;
    if (output.path == "-") throw FileError(named + ": names no file; standard output is /dev/stdout");
    check_writable(output.path);
    if (is_special(output.path)) continue;
    const std::vector<std::string>& endings = output.endings;
    if (!endings.empty() && std::none_of(endings.begin(), endings.end(), [&output](const std::string& ending) {
          return has_ending(output.path, ending);
        })) {
      std::string all;
      for (const std::string& ending : endings) all += (all.empty() ? "" : " or ") + ending;
      throw FileError(named + ": expected a name that ends in " + all);
    }
    for (const std::string& input : inputs) {
      if (!input.empty() && same_file(output.path, input)) {
        throw FileError(named + ": is the input " + input + ", which would be overwritten");
      }
    }
    for (std::size_t m = 0; m < n; ++m) {
      if (!outputs[m].path.empty() && same_file(output.path, outputs[m].path)) {
        throw FileError(named + ": is the file of " + outputs[m].option + ", too");
      }
    }
  }
}

void check_writable(const std::string& path) {
  if (path.empty()) throw FileError("an output file needs a name");
  std::error_code error;
  if (fs::is_directory(path, error)) fail(path, EISDIR);
  if (is_special(path)) {
    if (::access(path.c_str(), W_OK) != 0) fail(path, errno);
    return;
  }
  const fs::path folder = folder_of(is_link(path) ? resolved(path).string() : path);
  if (!fs::exists(folder, error)) fail(path, ENOENT);
  if (!fs::is_directory(folder, error)) fail(path, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

void write_file(const std::string& path, std::string_view bytes) {
  check_writable(path);
  if (is_special(path)) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail(path, errno);
    const int error = write_all(descriptor, bytes);
    if (::close(descriptor) != 0 || error != 0) fail(path, error != 0 ? error : errno);
    return;
  }
  const std::string place = is_link(path) ? resolved(path).string() : path;
  std::string temporary = place + ".XXXXXX";
  const int descriptor = ::mkostemp(temporary.data(), O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  int error = write_all(descriptor, bytes);
  const mode_t mask = ::umask(0);  // mkstemp gives 0600; the file gets what any other new file would
  ::umask(mask);
  if (error == 0 && ::fchmod(descriptor, 0666 & ~mask) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), place.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
}

std::string reserve_path(const std::string& directory, const std::string& stem, const std::string& extension) {
  for (int number = 1;; ++number) {
    std::string path = (fs::path(directory) / (stem + "-" + std::to_string(number) + extension)).string();
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return path;
    }
    if (errno != EEXIST) fail(path, errno);
  }
}

}  // namespace surefill::certify
