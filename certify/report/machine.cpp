// SPDX-License-Identifier: Apache-2.0
//
// What is read of the machine: its processor's name, certificates in files.
#include <fstream>
#include <sstream>
#include <string>

#include "certify/report/certificate.hpp"

namespace surefill::certify {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

Certificate read_certificate_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw CertificateError(path + ": cannot be read");
  return read_certificate(text.str(), path);
}

}  // namespace surefill::certify
