// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

#include "certify/report/report_files.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

namespace {

constexpr int kViewPixels = 14;     // of a zoomed view, each way, at most
constexpr double kPanelSize = 420;  // of a picture on the page, in CSS pixels

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
svg{background:#fff;border:1px solid #cfd3da}
table{border-collapse:collapse;width:100%;background:#fff;font-size:13.5px}
th,td{text-align:left;padding:6px 9px;border-bottom:1px solid #e4e7eb;vertical-align:top}
td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.ok{color:#1a7f45;font-weight:bold}.FAIL{color:#c02a2a;font-weight:bold}.skip,.part{color:#a87400;font-weight:bold}
pre,code{font:12.5px/1.45 ui-monospace,"DejaVu Sans Mono",monospace}
pre{background:#f0f2f5;padding:10px;border-radius:6px;overflow-x:auto;margin:6px 0}
.say{font-weight:600}.key span{display:inline-block;width:12px;height:12px;border-radius:6px;margin:0 4px 0 12px;vertical-align:-1px}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;margin:0}dt{color:#59606c}dd{margin:0;overflow-wrap:anywhere}
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

// Findings of one cause say the same but for numbers: the place, the case, the values that floats have.
std::string cause_of(const CheckResult& result) {
  std::string text = result.shown.empty() ? result.finding : result.shown;
  const std::size_t file = text.find(".scene: ");
  if (file != std::string::npos) text = text.substr(file + 8);
  // A count that is too high is another cause than one that is too low.
  unsigned long expected = 0, got = 0;
  const std::size_t at = text.find(": expected ");
  if (at != std::string::npos && std::sscanf(text.c_str() + at, ": expected %lu, got %lu", &expected, &got) == 2) {
    const std::string output = text.substr(0, text.find(" at "));
    if (output == "count" || output == "count of a tiling") {
      return got > expected ? "samples are covered too often" : "samples are covered too seldom";
    }
    return output + " differs";
  }
  if (at != std::string::npos) {
    const std::string output = text.substr(0, text.find(" at "));
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

struct Point {
  double x, y;
};

// The part of a triangle in front of the eye, on the screen, for a picture: clipped to W > 0 and a wide box. Empty if
// it has none, or a number that is none.
std::vector<Point> outline(const std::array<Vertex, 3>& triangle, double size) {
  std::vector<std::array<double, 3>> polygon;
  double largest = 0;
  for (const Vertex& v : triangle) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.w)) return {};
    polygon.push_back({v.x, v.y, v.w});
    largest = std::max({largest, std::abs(double{v.x}), std::abs(double{v.y}), std::abs(double{v.w})});
  }
  if (largest == 0) return {};
  const double far = 4 * size + 64;
  const std::array<std::array<double, 4>, 5> planes{
      {{0, 0, 1, -1e-12 * largest}, {1, 0, far, 0}, {-1, 0, far, 0}, {0, 1, far, 0}, {0, -1, far, 0}}};
  for (const auto& plane : planes) {
    const auto distance = [&plane](const std::array<double, 3>& p) {
      return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3];
    };
    std::vector<std::array<double, 3>> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = distance(a), db = distance(b);
      if (da >= 0) clipped.push_back(a);
      if ((da < 0) == (db < 0)) continue;
      const double t = da / (da - db);
      clipped.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
    }
    polygon = std::move(clipped);
  }
  std::vector<Point> points;
  for (const auto& p : polygon) {
    if (p[2] > 0) points.push_back({p[0] / p[2], p[1] / p[2]});
  }
  return points;
}

std::vector<std::vector<Point>> outlines(const corpus::Scene& scene) {
  std::vector<std::vector<Point>> result;
  try {
    const corpus::Frame frame(scene, {false, false, false, false, false});
    for (const Draw& draw : frame.draws()) {
      for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
        std::array<Vertex, 3> triangle{};
        for (std::size_t i = 0; i < 3; ++i) triangle[i] = draw.vertices[draw.indices[3 * t + i]];
        result.push_back(outline(triangle, std::max(scene.width, scene.height)));
      }
    }
  } catch (const corpus::SceneError&) {
    result.clear();  // the picture then shows the samples alone
  }
  return result;
}

struct View {
  int x0, y0, x1, y1;
};

// The pixels around those that differ.
View zoomed(const Evidence& evidence) {
  View view{evidence.x0 + evidence.width, evidence.y0 + evidence.height, evidence.x0, evidence.y0};
  std::size_t s = 0;
  for (int y = evidence.y0; y < evidence.y0 + evidence.height; ++y) {
    for (int x = evidence.x0; x < evidence.x0 + evidence.width; ++x) {
      for (int n = 0; n < evidence.samples; ++n, ++s) {
        if (!evidence.differs[s]) continue;
        // The first difference stays in view, others as far as there is place.
        if (view.x1 > view.x0 && (std::max(view.x1, x + 1) - std::min(view.x0, x) > kViewPixels - 4 ||
                                  std::max(view.y1, y + 1) - std::min(view.y0, y) > kViewPixels - 4)) {
          continue;
        }
        view = {std::min(view.x0, x), std::min(view.y0, y), std::max(view.x1, x + 1), std::max(view.y1, y + 1)};
      }
    }
  }
  if (view.x1 <= view.x0) {
    view = {evidence.x0, evidence.y0, evidence.x0 + std::min(kViewPixels, evidence.width),
            evidence.y0 + std::min(kViewPixels, evidence.height)};
  }
  const View all{evidence.x0, evidence.y0, evidence.x0 + evidence.width, evidence.y0 + evidence.height};
  return {std::max(all.x0, view.x0 - 2), std::max(all.y0, view.y0 - 2), std::min(all.x1, view.x1 + 2),
          std::min(all.y1, view.y1 + 2)};
}

const char* colour_of(std::uint32_t count) {
  return count == 0 ? "#c3c8d0" : count == 1 ? "#2467b5" : count == 2 ? "#e08a00" : "#8a3ab9";
}

std::string picture(const Evidence& evidence, const std::vector<std::uint32_t>& counts, const View& view,
                    const std::vector<std::vector<Point>>& triangles, const std::string& caption, bool marks) {
  const int width = view.x1 - view.x0, height = view.y1 - view.y0;
  const double scale = kPanelSize / std::max({width, height, 2});
  std::string svg =
      fmt::format("<figure><figcaption>{}</figcaption><svg width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\">",
                  escaped(caption), width * scale, height * scale, view.x0, view.y0, width, height);
  for (int x = view.x0; x <= view.x1; ++x) {
    svg +=
        fmt::format("<line x1=\"{0}\" y1=\"{1}\" x2=\"{0}\" y2=\"{2}\" stroke=\"#e1e4e9\" stroke-width=\"{3:.4f}\"/>",
                    x, view.y0, view.y1, 1 / scale);
  }
  for (int y = view.y0; y <= view.y1; ++y) {
    svg +=
        fmt::format("<line x1=\"{1}\" y1=\"{0}\" x2=\"{2}\" y2=\"{0}\" stroke=\"#e1e4e9\" stroke-width=\"{3:.4f}\"/>",
                    y, view.x0, view.x1, 1 / scale);
  }
  constexpr std::array<const char*, 6> kHues{"#2467b5", "#c2571a", "#1a7f45", "#8a3ab9", "#b0346e", "#5b6b00"};
  for (std::size_t t = 0; t < triangles.size() && t < 200; ++t) {
    if (triangles[t].size() < 2) continue;
    svg += "<polygon points=\"";
    for (const Point& p : triangles[t]) svg += fmt::format("{:.6f},{:.6f} ", p.x, p.y);
    const char* hue = kHues[t % kHues.size()];
    svg += fmt::format("\" fill=\"{}\" fill-opacity=\"0.10\" stroke=\"{}\" stroke-width=\"{:.4f}\"/>", hue, hue,
                       1.6 / scale);
  }
  std::size_t s = 0;
  const double radius = evidence.samples == 1 ? 0.13 : 0.05;
  for (int y = evidence.y0; y < evidence.y0 + evidence.height; ++y) {
    for (int x = evidence.x0; x < evidence.x0 + evidence.width; ++x) {
      for (int n = 0; n < evidence.samples; ++n, ++s) {
        if (x < view.x0 || x >= view.x1 || y < view.y0 || y >= view.y1) continue;
        const SampleLocation at = sample_location(evidence.samples, n);
        const double cx = x + at.x / 16.0, cy = y + at.y / 16.0;
        svg += fmt::format("<circle cx=\"{:.4f}\" cy=\"{:.4f}\" r=\"{:.3f}\" fill=\"{}\"/>", cx, cy, radius,
                           colour_of(counts[s]));
        if (evidence.samples == 1 && scale > 18) {
          svg += fmt::format(
              "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"0.24\" fill=\"#40454f\" text-anchor=\"middle\">{}</text>",
              cx, cy + 0.4, counts[s]);
        }
        if (!marks || !evidence.differs[s]) continue;
        svg += fmt::format(
            "<circle cx=\"{:.4f}\" cy=\"{:.4f}\" r=\"{:.3f}\" fill=\"none\" stroke=\"#d01f1f\" "
            "stroke-width=\"{:.4f}\"/>",
            cx, cy, radius * 1.9, std::max(2 / scale, 0.03));
      }
    }
  }
  return svg + "</svg></figure>\n";
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
  if (!is_pattern) html += fmt::format("<p class=\"say\">{}</p>\n", escaped(said));
  const Evidence& evidence = best.evidence;
  if (evidence.width > 0 && !best.scene_text.empty()) {
    std::vector<std::vector<Point>> triangles;
    try {
      triangles = outlines(corpus::read_scene(best.scene_text));
    } catch (const corpus::SceneError&) {
      triangles.clear();  // a certificate that was edited
    }
    const View view = zoomed(evidence);
    html += "<div class=\"pictures\">\n";
    html += picture(evidence, evidence.expected, view, triangles, "Expected: covers of each sample", false);
    if (!evidence.actual.empty()) {
      const std::string what = evidence.what.empty() ? ""
                                                     : ", where " + evidence.what + " differ" +
                                                           (evidence.what == "values" ? "" : "s") + " ringed";
      html += picture(evidence, evidence.actual, view, triangles, "Got" + what, true);
    } else {
      html += "<p>The rasterizer gave no image of this scene.</p>\n";
    }
    if (view.x1 - view.x0 < evidence.width || view.y1 - view.y0 < evidence.height) {
      const View whole{evidence.x0, evidence.y0, evidence.x0 + evidence.width, evidence.y0 + evidence.height};
      html += picture(evidence, evidence.actual.empty() ? evidence.expected : evidence.actual, whole, triangles,
                      "The whole target, or a window of it", true);
    }
    html += "</div>\n";
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
    html += "<p>Where edges stop covering the sample of a pixel, from the pixel's centre:</p>\n<pre>" +
            escaped(facts.turns) + "</pre>\n";
  }
  return html + "</div>\n";
}

}  // namespace

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
        "<span style=\"background:#c3c8d0\"></span>none<span style=\"background:#2467b5\"></span>one"
        "<span style=\"background:#e08a00\"></span>two<span style=\"background:#8a3ab9\"></span>more"
        "<span style=\"border:2px solid #d01f1f;width:9px;height:9px\"></span>differs</p>\n",
        causes.size(), causes.size() == 1 ? "" : "s");
    std::vector<std::pair<std::string, std::vector<const CheckResult*>>> sorted(causes.begin(), causes.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return a.second.size() != b.second.size() ? a.second.size() > b.second.size() : a.first < b.first;
    });
    for (const auto& [cause, findings] : sorted) html += finding_card(findings, cause);
  }

  for (const auto& [group, results] : groups) {
    html += fmt::format(
        "<h2>Checks{}</h2>\n<table><tr><th></th><th>Check</th><th>Cases</th><th>Not applicable</th><th>Samples</th>"
        "<th>Differ</th><th>Time</th></tr>\n",
        group.empty() ? "" : ": " + escaped(group));
    for (const CheckResult& result : results) html += row(result);
    html += "</table>\n";
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
