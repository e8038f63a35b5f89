// SPDX-License-Identifier: Apache-2.0
//
// The certificate as a page to look at, and as a file for continuous integration.
#ifndef SUREFILL_CERTIFY_REPORT_FILES_HPP
#define SUREFILL_CERTIFY_REPORT_FILES_HPP

#include <string>

#include "certify/report/certificate.hpp"

namespace surefill::certify {

// One self-contained page: verdicts, findings with their pictures, grouped by what they have in common, and the table
// of checks. No scripts, no other files, nothing from the net.
std::string html_report(const Certificate& certificate);

// A scene as two answer it, sample by sample, as a part of such a page: `actual` is what the second one is called.
std::string scene_pictures(const Evidence& evidence, const std::string& scene_text, const std::string& actual);

// JUnit's XML: a suite for each verdict, a test case for each check; skipped ones and failures say why.
std::string junit_report(const Certificate& certificate);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPORT_FILES_HPP
