// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

#include "certify/report/reading.hpp"
#include "certify/report/report_files.hpp"
#include "certify/report/report_pictures.hpp"
#include "certify/report/report_values.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

namespace {

constexpr const char* kStyle = R"(
body{font:15px/1.5 system-ui,"DejaVu Sans",sans-serif;color:#1d2129;background:#f6f7f9;margin:0}
main{max-width:1100px;margin:0 auto;padding:24px}
h1{font-size:24px;margin:0 0 4px}h2{font-size:19px;margin:36px 0 10px}h3{font-size:16px;margin:0 0 6px}
.sub{color:#59606c;margin:0 0 18px}
.verdicts{display:flex;gap:14px;flex-wrap:wrap}
.verdict{flex:1 1 300px;border-radius:8px;padding:14px 18px;background:#fff;border-left:8px solid #888}
.good{border-color:#1a7f45}.bad{border-color:#c02a2a}.open{border-color:#a87400}
.verdict b{display:block;font-size:18px}
.card{background:#fff;border-radius:8px;padding:18px;margin:0 0 18px}
.pictures{display:flex;gap:18px;flex-wrap:wrap;margin:10px 0}
figure{margin:0}figcaption{font-size:13px;color:#40454f;margin:0 0 4px}
svg{background:#fff;border:1px solid #cfd3da;max-width:100%;height:auto}
table{border-collapse:collapse;width:100%;background:#fff;font-size:13.5px}
.wide{overflow-x:auto}.wide svg{max-width:none}
th,td{text-align:left;padding:6px 9px;border-bottom:1px solid #e4e7eb;vertical-align:top}
td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.ok{color:#1a7f45;font-weight:bold}.FAIL{color:#c02a2a;font-weight:bold}.skip,.part{color:#a87400;font-weight:bold}
pre,code{font:12.5px/1.45 ui-monospace,"DejaVu Sans Mono",monospace}
pre{background:#f0f2f5;padding:10px;border-radius:6px;overflow-x:auto;margin:6px 0}
.say{font-weight:600}.key span{display:inline-block;width:12px;height:12px;border-radius:6px;margin:0 4px 0 12px;vertical-align:-1px}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;margin:0}dt{color:#59606c}dd{margin:0;overflow-wrap:anywhere}
)";

// Findings of one cause say the same but for numbers: the place, the case, the values that floats have.
std::string cause_of(const CheckResult& result) {
  std::string text = result.shown.empty() ? result.finding : result.shown;
  const std::size_t file = text.find(".scene: ");
  if (file != std::string::npos) text = text.substr(file + 8);
  // A count that is too high is another cause than one that is too low.
  unsigned long expected = 0, got = 0;
  const std::size_t at = text.find(": expected ");
  if (at != std::string::npos) {
    const std::string output = text.substr(0, text.find(" at "));
    Reading values(std::string_view(text).substr(at));
    const bool are_counts = values.text(": expected ").number(expected).text(", got ").number(got).fits();
    if (are_counts && (output == "count" || output == "count of a tiling")) {
      return got > expected ? "samples are covered too often" : "samples are covered too seldom";
    }
    return output + " differs";
  }
  std::string pattern;
  for (const char c : text) {
    if (std::isdigit(static_cast<unsigned char>(c))) {
      if (pattern.empty() || pattern.back() != '#') pattern += '#';
    } else {
      pattern += c;
    }
  }
  return pattern;
}

// What a finding says was expected, and what came.
std::pair<std::string, std::string> values_in(const std::string& finding) {
  const std::size_t expected = finding.find(": expected "), got = finding.find(", got ", expected);
  if (expected == std::string::npos || got == std::string::npos) return {};
  return {finding.substr(expected + 11, got - expected - 11), finding.substr(got + 6)};
}

// The value that a finding speaks of, at its pixel.
Label label_of(const std::string& finding, const std::string& value) {
  Label label;
  const std::size_t at = finding.find(" at pixel (");
  if (at == std::string::npos) return {};
  Reading place(std::string_view(finding).substr(at));
  if (!place.text(" at pixel (").number(label.x).text(", ").number(label.y).fits()) return {};
  label.text = readable(value);
  return label;
}

std::string finding_card(const std::vector<const CheckResult*>& findings, const std::string& cause) {
  // Of one cause, the finding with the shortest scene is the one to look at; one with a picture before one without.
  const CheckResult& best = **std::min_element(findings.begin(), findings.end(), [](const auto* a, const auto* b) {
    const auto rank = [](const CheckResult& r) {
      return r.evidence.width == 0 ? ~std::size_t{0} : r.scene_text.size();
    };
    return rank(*a) < rank(*b);
  });
  const std::string& said = best.shown.empty() ? best.finding : best.shown;
  const bool is_pattern = cause.find('#') != std::string::npos;  // then the finding itself reads better
  std::string html =
      fmt::format("<section class=\"card\"><h3>{}</h3>\n<p>Found by ", escaped(is_pattern ? said : cause));
  for (std::size_t n = 0; n < findings.size(); ++n) {
    html += fmt::format("{}<b>{}</b> ({} of {} {})", n == 0 ? "" : ", ", escaped(findings[n]->name),
                        grouped(findings[n]->failed), grouped(findings[n]->done), escaped(findings[n]->unit));
  }
  html += fmt::format(".</p>\n<p>{}: {} [{}]</p>\n", escaped(best.name), escaped(best.claim), escaped(best.rule));
  if (!is_pattern && said != cause) html += fmt::format("<p class=\"say\">{}</p>\n", escaped(said));
  const Evidence& evidence = best.evidence;
  if (evidence.width > 0 && !best.scene_text.empty()) {
    const std::vector<Outline> triangles = outlines(best.scene_text);
    const View view = zoomed(evidence);
    html += "<div class=\"pictures\">\n";
    // Counts are drawn in any case; where it is something else that differs, its values at the first place are written.
    const auto [wanted, came] = values_in(said);
    const bool of_values = !evidence.what.empty() && evidence.what != "count" && !wanted.empty();
    html += picture(evidence, evidence.expected, view, triangles,
                    of_values ? "Expected: " + readable(wanted) : "Expected: covers of each sample", of_values,
                    of_values ? label_of(said, wanted) : Label{});
    if (!evidence.actual.empty()) {
      const std::string what = evidence.what.empty() ? ""
                                                     : ", where " + evidence.what + " differ" +
                                                           (evidence.what == "values" ? "" : "s") + " ringed";
      html += picture(evidence, evidence.actual, view, triangles,
                      of_values ? "Got: " + readable(came) + what : "Got" + what, true,
                      of_values ? label_of(said, came) : Label{});
    } else {
      html += "<p>The rasterizer gave no image of this scene.</p>\n";
    }
    html += inset(evidence, triangles);
    if (view.x1 - view.x0 < evidence.width || view.y1 - view.y0 < evidence.height) {
      const View whole{evidence.x0, evidence.y0, evidence.x0 + evidence.width, evidence.y0 + evidence.height};
      html += picture(evidence, evidence.actual.empty() ? evidence.expected : evidence.actual, whole, triangles,
                      "The whole target, or a window of it", true);
    }
    html += "</div>\n" + values_html(evidence, view);
  }
  if (!best.found.values.empty()) {
    html += fmt::format(
        "<p>The case as it was found, before it was made smaller: {} of {} samples have wrong values.</p>\n",
        best.found.values.size(), best.found.differs.size());
    html += values_html(best.found, zoomed(best.found));
  }
  if (!best.replay.empty()) html += fmt::format("<pre>{}</pre>\n", escaped(best.replay));
  if (!best.scene_text.empty()) {
    html += fmt::format("<details{}><summary>The scene</summary><pre>{}</pre></details>\n",
                        best.scene_text.size() < 1500 ? " open" : "", escaped(best.scene_text));
  }
  return html + "</section>\n";
}

std::string verdict_box(const std::string& title, Verdict verdict, const std::vector<CheckResult>& results,
                        bool holds) {
  const auto failed = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.failed > 0; });
  std::uint64_t samples = 0, cases = 0;
  for (const CheckResult& result : results) {
    samples += result.samples;
    cases += result.done - result.skipped;
  }
  const char* state = verdict == Verdict::certified ? "good" : verdict == Verdict::incomplete ? "open" : "bad";
  const std::string says = verdict == Verdict::certified    ? (holds ? "holds" : "certified")
                           : verdict == Verdict::incomplete ? "incomplete"
                                                            : (holds ? "does not hold" : "not certified");
  return fmt::format(
      "<div class=\"verdict {}\"><b>{}: {}</b>{} of {} checks found a difference; {} cases, {} samples "
      "compared</div>\n",
      state, escaped(title), says, failed, results.size(), grouped(cases), grouped(samples));
}

std::string row(const CheckResult& result) {
  const char* mark = result.failed > 0 ? "FAIL" : !result.complete() ? "part" : result.checked() ? "ok" : "n/a";
  const std::string errors = deviations_text(result.deviations);
  return fmt::format(
      "<tr><td class=\"{11}\">{0}</td><td><b>{1}</b> [{2}]<br>{3}{4}</td><td class=\"n\">{5}{6}</td><td "
      "class=\"n\">{7}</td>"
      "<td class=\"n\">{8}</td><td class=\"n\">{9}</td><td class=\"n\">{10:.1f} s</td></tr>\n",
      mark, escaped(result.name), escaped(result.rule), escaped(result.claim),
      errors.empty() ? "" : "<br>largest errors: " + escaped(errors), grouped(result.done),
      result.exhaustive && result.done == result.cases ? " (all)" : "", grouped(result.skipped),
      grouped(result.samples), grouped(result.failed), result.seconds, std::string_view(mark) == "n/a" ? "skip" : mark);
}

// The model that was found stands first: with what a newcomer would not expect of it, and where edges turn.
std::string model_card(const Facts& facts) {
  if (!facts.of_rival()) return "";
  std::string html = "<h2>What it does</h2>\n<div class=\"card\">\n";
  const auto line = [&html](const char* what, const std::string& text) {
    html += fmt::format("<p><b>{}</b> {}</p>\n", what, escaped(text));
  };
  for (const std::string& name : facts.names) line("Likely:", name);
  line("Found by probing:", facts.inferred_model);
  if (facts.declared_model != "none") line("Declared:", facts.declared_model);
  for (const std::string& problem : facts.problems) line("No model explains:", problem);
  for (const std::string& sentence : facts.departures) line("Note:", sentence);
  for (const std::string& what : facts.open) line("Not found out:", what);
  if (!facts.turns.empty()) {
    html +=
        "<p>Where edges stop covering the sample of a pixel, in pixels from the pixel's centre:</p>\n"
        "<div class=\"wide\">" +
        turns_picture(facts.turns) + "</div><details><summary>As numbers</summary><pre>" + escaped(facts.turns) +
        "</pre></details>\n";
  }
  return html + "</div>\n";
}

}  // namespace

std::string scene_pictures(const Evidence& evidence, const std::string& scene_text, const std::string& actual) {
  const std::vector<Outline> triangles = outlines(scene_text);
  const View whole{evidence.x0, evidence.y0, evidence.x0 + evidence.width, evidence.y0 + evidence.height};
  const std::string differ = evidence.what.empty() ? ""
                                                   : ", where " + evidence.what + " differ" +
                                                         (evidence.what == "values" ? "" : "s") + " ringed";
  std::string html = "<div class=\"pictures\">\n" +
                     picture(evidence, evidence.expected, whole, triangles, "Expected: covers of each sample", false);
  if (evidence.actual.empty()) return html + "<p>" + escaped(actual) + " gave no image of this scene.</p></div>\n";
  html += picture(evidence, evidence.actual, whole, triangles, actual + differ, true);
  return html + (evidence.what.empty() ? "" : inset(evidence, triangles)) + "</div>\n";
}

std::string html_report(const Certificate& certificate) {
  const Facts& facts = certificate.facts;
  const std::string subject = facts.of_rival() ? facts.rival + " " + facts.rival_version : "Surefill's engine";
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>surefill certify: {0}</title><style>{1}</style></head><body><main>\n"
      "<h1>{0}</h1>\n<p class=\"sub\">surefill certify {2}, level {3}, seed {4}{5}</p>\n<div class=\"verdicts\">\n",
      escaped(subject), kStyle, escaped(facts.version), escaped(facts.level), facts.seed,
      facts.interrupted ? "; interrupted" : "");
  const auto groups = groups_of(certificate.results);
  for (const auto& [group, results] : groups) {
    const std::string model = group == "model" ? "Model" : "Invariants";
    html += verdict_box(group.empty() ? "Engine" : model, verdict_of(results, facts), results, !group.empty());
  }
  html += "</div>\n" + model_card(facts);

  std::map<std::string, std::vector<const CheckResult*>> causes;
  for (const CheckResult& result : certificate.results) {
    if (result.failed > 0) causes[cause_of(result)].push_back(&result);
  }
  if (!causes.empty()) {
    html += fmt::format(
        "<h2>Findings: {} cause{}</h2>\n<p class=\"key\">Samples, by how many triangles cover them:"
        "<span style=\"background:#c3c8d0\"></span>&#8288;none<span style=\"background:#2467b5\"></span>&#8288;one"
        "<span style=\"background:#e08a00\"></span>&#8288;two<span style=\"background:#8a3ab9\"></span>&#8288;more"
        "<span style=\"background:#eadfc2\"></span>&#8288;open<span style=\"border:2px solid "
        "#d01f1f;width:9px;height:9px\">"
        "</span>&#8288;differs</p>\n",
        causes.size(), causes.size() == 1 ? "" : "s");
    std::vector<std::pair<std::string, std::vector<const CheckResult*>>> sorted(causes.begin(), causes.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return a.second.size() != b.second.size() ? a.second.size() > b.second.size() : a.first < b.first;
    });
    for (const auto& [cause, findings] : sorted) html += finding_card(findings, cause);
  }

  for (const auto& [group, results] : groups) {
    html += fmt::format(
        "<h2>Checks{}</h2>\n<div class=\"wide\"><table><tr><th></th><th>Check</th><th>Cases</th><th>Not "
        "applicable</th><th>Samples</th>"
        "<th>Differ</th><th>Time</th></tr>\n",
        group.empty() ? "" : ": " + escaped(group));
    for (const CheckResult& result : results) html += row(result);
    html += "</table></div>\n";
  }
  html += "<h2>What was run</h2>\n<div class=\"card\"><dl>\n";
  const auto fact = [&html](const char* name, const std::string& value) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escaped(value));
  };
  if (facts.of_rival()) {
    fact("judged by", facts.model);
  }
  if (!facts.stopped.empty()) fact("stopped", facts.stopped);
  fact("means", meaning(facts));
  for (const std::string& limit : limits(facts)) fact("but", limit);
  fact("surefill", facts.version + ", commit " + facts.commit);
  fact("compiler", facts.compiler + "; " + facts.flags);
  fact("machine", facts.cpu);
  if (!facts.of_rival()) fact("engine path", facts.instruction_set);
  fact("time", fmt::format("{:.1f} s on {} threads", facts.seconds, facts.jobs));
  return html + "</dl></div>\n</main></body></html>\n";
}

}  // namespace surefill::certify
