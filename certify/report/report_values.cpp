// SPDX-License-Identifier: Apache-2.0
#include "certify/report/report_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

namespace surefill::certify {

namespace {

using Value = properties::Exhibit::Value;

constexpr double kLetter = 7.3;  // of the font below, in CSS pixels, with room to spare
constexpr const char* kText = "font-family=\"system-ui,DejaVu Sans,sans-serif\" font-size=\"12\"";
constexpr const char* kExpected = "#1d2129";
constexpr const char* kActual = "#b01515";

struct Place {
  int x, y, sample;
};
Place place_of(const Evidence& evidence, std::size_t sample) {
  const auto samples = static_cast<std::size_t>(evidence.samples), width = static_cast<std::size_t>(evidence.width);
  return {evidence.x0 + static_cast<int>(sample / samples % width),
          evidence.y0 + static_cast<int>(sample / samples / width), static_cast<int>(sample % samples)};
}

bool in_view(const View& view, const Place& at) {
  return at.x >= view.x0 && at.x < view.x1 && at.y >= view.y0 && at.y < view.y1;
}

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Of a range, the end that is passed.
std::string end_passed(const std::string& expected, double actual) {
  const std::size_t to = expected.find(" to ");
  if (to == std::string::npos) return expected;
  const std::string low = expected.substr(0, to), high = expected.substr(to + 4);
  return actual < number_in(low).value_or(-HUGE_VAL) ? low : high;
}

std::string text_at(double x, double y, const char* anchor, const char* colour, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>", x, y, anchor, colour,
                     escaped(words));
}

std::string svg_of(double width, double height, const std::string& body) {
  return fmt::format("<svg width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" {2}>{3}</svg>", width,
                     height, kText, body);
}

std::string names_of(const std::vector<Value>& values) {
  std::vector<std::string> names;
  for (const Value& value : values) {
    if (std::find(names.begin(), names.end(), value.output) == names.end()) names.push_back(value.output);
  }
  std::string text = names.front();
  for (std::size_t n = 1; n < names.size(); ++n) text += (n + 1 < names.size() ? ", " : " and ") + names[n];
  return text;
}

// What was expected above what came, at each pixel of the view with a wrong sample.
std::string numbers(const Evidence& evidence, const View& view) {
  struct Cell {
    Pair pair;
    int more = 0;
  };
  std::map<std::pair<int, int>, Cell> cells;
  std::size_t longest = 4;
  for (const Value& value : evidence.values) {
    const Place at = place_of(evidence, value.sample);
    if (!in_view(view, at)) continue;
    const auto [cell, first] = cells.try_emplace({at.x, at.y});
    if (!first) {
      ++cell->second.more;
      continue;
    }
    cell->second.pair = told_apart(readable(value.expected), readable(value.actual));
    longest = std::max({longest, cell->second.pair.expected.size(), cell->second.pair.actual.size()});
  }
  if (cells.empty()) return "";
  constexpr double kRow = 38, kLeft = 34, kTop = 22;
  const double width = kLetter * static_cast<double>(longest) + 10;
  std::string body;
  for (int x = view.x0; x < view.x1; ++x) {
    body += text_at(kLeft + (x - view.x0 + 0.5) * width, 15, "middle", "#59606c", std::to_string(x));
  }
  for (int y = view.y0; y < view.y1; ++y) {
    const double top = kTop + (y - view.y0) * kRow;
    body += text_at(kLeft - 6, top + 23, "end", "#59606c", std::to_string(y));
    for (int x = view.x0; x < view.x1; ++x) {
      const double left = kLeft + (x - view.x0) * width;
      const auto cell = cells.find({x, y});
      body += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" stroke=\"#e1e4e9\"/>", left,
          top, width, kRow, cell == cells.end() ? "#fff" : "#fdeeee");
      if (cell == cells.end()) continue;
      const std::string more = cell->second.more > 0 ? fmt::format(" +{}", cell->second.more) : "";
      body += text_at(left + width / 2, top + 15, "middle", kExpected, cell->second.pair.expected);
      body += text_at(left + width / 2, top + 31, "middle", kActual, cell->second.pair.actual + more);
    }
  }
  return fmt::format(
      "<figure><figcaption>{}: expected above, <span style=\"color:{}\">got</span> below</figcaption>\n<div "
      "class=\"wide\">{}</div></figure>\n",
      escaped(names_of(evidence.values)), kActual,
      svg_of(kLeft + width * (view.x1 - view.x0) + 1, kTop + kRow * (view.y1 - view.y0) + 1, body));
}

// The first wrong samples, each as how far it is off, all at the scale of the largest of these.
std::string differences(const Evidence& evidence) {
  constexpr std::size_t kMost = 10;
  constexpr double kRow = 22, kMiddle = 172, kReach = 62, kWidth = 334;
  std::vector<std::pair<const Value*, double>> shown;
  double largest = 0;
  for (const Value& value : evidence.values) {
    const std::optional<double> actual = number_in(readable(value.actual));
    if (!actual || shown.size() == kMost) continue;
    const std::optional<double> expected = number_in(end_passed(readable(value.expected), *actual));
    if (!expected || value.output == "index") continue;
    shown.emplace_back(&value, *actual - *expected);
    largest = std::max(largest, std::abs(shown.back().second));
  }
  if (shown.empty() || largest == 0) return "";
  std::string body =
      fmt::format("<line x1=\"{0}\" y1=\"0\" x2=\"{0}\" y2=\"{1}\" stroke=\"{2}\" stroke-width=\"1.5\"/>", kMiddle,
                  kRow * static_cast<double>(shown.size()), kExpected);
  for (std::size_t n = 0; n < shown.size(); ++n) {
    const auto& [value, difference] = shown[n];
    const Place at = place_of(evidence, value->sample);
    const double y = kRow * (static_cast<double>(n) + 0.5), x = kMiddle + kReach * difference / largest;
    const std::string sample = evidence.samples > 1 ? fmt::format(" sample {}", at.sample) : "";
    body += text_at(4, y + 4, "start", "#59606c", fmt::format("({}, {}){}", at.x, at.y, sample));
    body += fmt::format(
        "<line x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\" stroke=\"{3}\"/><circle cx=\"{2:.1f}\" "
        "cy=\"{1:.1f}\" r=\"4\" fill=\"{3}\"/>",
        kMiddle, y, x, kActual);
    body += text_at(kMiddle + kReach + 14, y + 4, "start", kActual, fmt::format("{:+.3g}", difference));
  }
  return fmt::format(
      "<figure><figcaption>At the scale of the difference: the line is what was expected, a dot what came; {:.3g} from "
      "the "
      "line to either end</figcaption>{}</figure>\n",
      largest, svg_of(kWidth, kRow * static_cast<double>(shown.size()), body));
}

// Small differences are pale, large ones dark, by their logarithm.
std::string heat_colour(double error, double low, double high) {
  if (!std::isfinite(error)) return "#000000";
  const double t = high > low ? std::log(error / low) / std::log(high / low) : 1;
  constexpr std::array<double, 3> kPale{255, 224, 178}, kDark{150, 12, 40};
  std::array<int, 3> mixed{};
  for (std::size_t k = 0; k < 3; ++k) mixed[k] = static_cast<int>(std::lround(kPale[k] + (kDark[k] - kPale[k]) * t));
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

std::string heat(const Evidence& evidence) {
  double low = HUGE_VAL, high = 0;
  std::map<std::pair<int, int>, double> errors;  // the largest of each pixel
  for (const Value& value : evidence.values) {
    const Place at = place_of(evidence, value.sample);
    double& error = errors[{at.x, at.y}];
    error = std::max(error, value.error);
    if (!std::isfinite(value.error) || value.error <= 0) continue;
    low = std::min(low, value.error), high = std::max(high, value.error);
  }
  if (high == 0) low = high = 1;
  const double scale = 420.0 / std::max(evidence.width, evidence.height), height = scale * evidence.height;
  std::string body =
      fmt::format("<rect width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#eef0f3\"/>", scale * evidence.width, height);
  bool none = false;
  for (const auto& [at, error] : errors) {
    none = none || !std::isfinite(error);
    body += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>",
                        (at.first - evidence.x0) * scale, (at.second - evidence.y0) * scale, scale, scale,
                        heat_colour(std::max(error, low), low, high));
  }
  const std::string scale_end =
      high > low ? fmt::format("<span style=\"background:{}\"></span>&#8288;{:.3g}", heat_colour(high, low, high), high)
                 : "";
  return fmt::format(
      "<figure><figcaption class=\"key\">How far off:<span style=\"background:{}\"></span>&#8288;{:.3g}{}{}; pixels "
      "({}, {}) to "
      "({}, {})</figcaption>{}</figure>\n",
      heat_colour(low, low, high), low, scale_end,
      none ? "<span style=\"background:#000\"></span>&#8288;no number" : "", evidence.x0, evidence.y0,
      evidence.x0 + evidence.width - 1, evidence.y0 + evidence.height - 1,
      svg_of(scale * evidence.width, height, body));
}

std::string table(const Evidence& evidence) {
  constexpr std::size_t kMost = 400;
  std::string html = fmt::format(
      "<details><summary>{} wrong value{} as numbers</summary>\n<div class=\"wide\"><table><tr><th>Pixel</th>"
      "<th>Output</th><th>Expected</th><th>Got</th><th>Off by</th></tr>\n",
      evidence.values.size(), evidence.values.size() == 1 ? "" : "s");
  for (std::size_t n = 0; n < std::min(kMost, evidence.values.size()); ++n) {
    const Value& value = evidence.values[n];
    const Place at = place_of(evidence, value.sample);
    html += fmt::format(
        "<tr><td>({}, {}){}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td></tr>\n",
        at.x, at.y, evidence.samples > 1 ? fmt::format(" sample {}", at.sample) : "", escaped(value.output),
        escaped(readable(value.expected)), escaped(readable(value.actual)),
        std::isfinite(value.error) && value.output != "index" ? fmt::format("{:.3g}", value.error) : "");
  }
  html += "</table></div>";
  if (evidence.values.size() > kMost) html += fmt::format("<p>The first {} of them.</p>", kMost);
  return html + "</details>\n";
}

}  // namespace

std::string readable(const std::string& value) {
  std::string result;
  for (std::size_t begin = 0; begin < value.size();) {
    const std::size_t open = value.find(" (", begin), close = value.find(')', begin);
    if (open == std::string::npos || close == std::string::npos) return value;
    if (!result.empty()) result += " to ";
    result += value.substr(open + 2, close - open - 2);
    begin = close + 1;
  }
  return result;
}

Pair told_apart(const std::string& expected, const std::string& actual) {
  const std::optional<double> b = number_in(actual);
  const std::string nearest = end_passed(expected, b.value_or(0));
  const std::optional<double> a = number_in(nearest);
  if (!a || !b) return {a ? fmt::format("{:.4g}", *a) : nearest, b ? fmt::format("{:.4g}", *b) : actual};
  Pair pair;
  for (int digits = 3; digits <= 9; ++digits) {
    pair = {fmt::format("{:.{}g}", *a, digits), fmt::format("{:.{}g}", *b, digits)};
    if (pair.expected != pair.actual) break;
  }
  return pair;
}

std::string values_html(const Evidence& evidence, const View& view) {
  if (evidence.values.empty()) return "";
  const bool all_in_view = std::all_of(evidence.values.begin(), evidence.values.end(), [&](const Value& value) {
    return in_view(view, place_of(evidence, value.sample));
  });
  return "<div class=\"pictures\">\n" + numbers(evidence, view) + differences(evidence) +
         (all_in_view ? "" : heat(evidence)) + "</div>\n" + table(evidence);
}

}  // namespace surefill::certify
