// SPDX-License-Identifier: Apache-2.0
//
// The reader of certificates and of shards on any text: an error of one line that names the file, or a certificate that
// survives a round trip; what is of one run with itself; and as the only shard either merges to the same or is refused.
#include <array>
#include <string>
#include <string_view>

#include "certify/report/certificate.hpp"
#include "fuzz/finding.hpp"

namespace surefill::fuzz {
namespace {

void check_message(const certify::CertificateError& error, const std::string& text) {
  const std::string_view message = error.what();
  if (message.empty() || message.find('\n') != message.npos) {
    report_finding("certificate", "the error is not one line: " + std::string(message), text + "\n");
  }
}

// As it is, it is refused unless nothing was changed; with its checksum, the reader behind that is reached.
void check(const std::string& text) {
  certify::Certificate certificate;
  try {
    certificate = certify::read_certificate(text, "input");
  } catch (const certify::CertificateError& error) {
    return check_message(error, text);
  }
  const std::string written = certify::certificate_json(certificate);
  std::string again;
  try {
    again = certify::certificate_json(certify::read_certificate(written, "input"));
  } catch (const certify::CertificateError& error) {
    report_finding("certificate", std::string("what was written is refused: ") + error.what(), text + "\n");
  }
  if (again != written) report_finding("certificate", "the second writing differs from the first", text + "\n");
  if (const std::string why = certify::why_not_one_run(certificate, certificate); !why.empty()) {
    report_finding("certificate", "a certificate is not of one run with itself: " + why, text + "\n");
  }
  try {
    const std::array<std::string, 1> names{"input"};
    certify::merge({&certificate, 1}, names);
  } catch (const certify::CertificateError& error) {
    check_message(error, text);
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  surefill::fuzz::check(text);
  surefill::fuzz::check(surefill::certify::with_checksum(text));
  return 0;
}
