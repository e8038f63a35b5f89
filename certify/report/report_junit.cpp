// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "certify/report/report_files.hpp"

namespace surefill::certify {

namespace {

// Text for XML 1.0, which has no place for control characters.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t' ? ' ' : c;
    }
  }
  return result;
}

}  // namespace

std::string junit_report(const Certificate& certificate) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"surefill certify\">\n";
  for (const auto& [group, results] : groups_of(certificate.results)) {
    const std::vector<CheckResult>& checks = results;
    const auto count = [&checks](auto condition) { return std::count_if(checks.begin(), checks.end(), condition); };
    double seconds = 0;
    for (const CheckResult& result : results) seconds += result.seconds;
    const auto failed = [](const CheckResult& r) { return r.failed > 0; };
    const auto skipped = [](const CheckResult& r) { return r.failed == 0 && !r.checked(); };
    xml += fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\" errors=\"0\" time=\"{:.3f}\">\n",
        escaped(group.empty() ? "engine" : group), results.size(), count(failed), count(skipped), seconds);
    for (const CheckResult& result : results) {
      xml += fmt::format("    <testcase classname=\"surefill.{}\" name=\"{}\" time=\"{:.3f}\">\n",
                         escaped(group.empty() ? "engine" : group), escaped(result.name), result.seconds);
      if (failed(result)) {
        xml += fmt::format("      <failure message=\"{}\">{} [{}]\n{} of {} {} differ; case {}: {}\n{}\n{}</failure>\n",
                           escaped(result.finding), escaped(result.claim), escaped(result.rule), result.failed,
                           result.done, escaped(result.unit), result.case_number, escaped(result.finding),
                           escaped(result.replay), escaped(result.scene_text));
      } else if (skipped(result)) {
        xml += fmt::format("      <skipped message=\"{}\"/>\n", result.complete() ? "no case that applies"
                                                                : certificate.facts.stopped.empty() ? "interrupted"
                                                                                                    : "stopped");
      }
      xml += "    </testcase>\n";
    }
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace surefill::certify
