// SPDX-License-Identifier: Apache-2.0
//
// The certificate as JSON: written, read again (by runs that go on, and by merge), and put together from shards.
#ifndef SUREFILL_CERTIFY_CERTIFICATE_HPP
#define SUREFILL_CERTIFY_CERTIFICATE_HPP

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "certify/report/report.hpp"

namespace surefill::certify {

// What cannot be read or does not belong together. what() is one line.
class CertificateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Certificate {
  Facts facts;
  std::vector<CheckResult> results;
};

// With a final newline.
std::string certificate_json(const Certificate& certificate);

// Reads what certificate_json writes, and nothing that was edited: the checksum must be that of the content, counts,
// findings and verdict must fit each other. `file` is the name used in messages. Throws CertificateError.
Certificate read_certificate(const std::string& text, const std::string& file);
Certificate read_certificate_file(const std::string& path);

// The text with the checksum of its content, where it is JSON: what the checksum hides from a fuzzer.
std::string with_checksum(const std::string& text);

// Why the two are not of one run (another version, level, seed, rival, check, number of shards ...); empty if they are.
// The shard itself may differ, and the machine.
std::string why_not_one_run(const Certificate& a, const Certificate& b);

// All shards of one run as one certificate. Throws CertificateError where one is missing, given twice or of another
// run.
Certificate merge(std::span<const Certificate> shards, std::span<const std::string> names);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_CERTIFICATE_HPP
