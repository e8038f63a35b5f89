// SPDX-License-Identifier: Apache-2.0
#include "certify/run/files.hpp"

namespace surefill::certify {

std::string shell_word(const std::string& path) {
  const bool plain =
      path.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=@%,") ==
      std::string::npos;
  if (plain && !path.empty()) return path.front() == '-' ? "./" + path : path;
  std::string result = "'";
  for (const char c : path) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace surefill::certify
