// SPDX-License-Identifier: Apache-2.0
//
// The findings of a certificate, run again.
#ifndef SUREFILL_CERTIFY_RECHECK_HPP
#define SUREFILL_CERTIFY_RECHECK_HPP

#include <functional>
#include <string>
#include <vector>

#include "certify/commands/certify_command.hpp"

namespace surefill::certify {

struct RecheckOptions {
  std::string certificate, corpus;
  std::vector<std::string> names;  // of checks, with * and ?; none: all findings
  RivalChoice rival;               // none: the certificate's, if it is a driver, or the engine
};
void add_recheck_options(CLI::App& app, RecheckOptions& options);

// Says of each finding "still" (the same words), "changed" (others, or it is not judged any more) or "gone". Exit status:
// good if all are gone. `find_corpus` is asked where no corpus is named. Throws UsageError, CertificateError.
int run_recheck(const RecheckOptions& options, const std::function<std::string()>& find_corpus);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RECHECK_HPP
