// SPDX-License-Identifier: Apache-2.0
//
// surefill explain --view lines SCENE: which samples the lines and points of a scene cover, and how one of them is found.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/commands/explain.hpp"
#include "certify/report/svg.hpp"
#include "textbook/points_lines.hpp"

namespace surefill::certify {

namespace {

using textbook::Line;
using textbook::point_covers;

constexpr std::array<const char*, 8> kFills{"#8fb4e8", "#f2c572", "#9bd09b", "#e59a93",
                                            "#c5a8e0", "#8fd3d3", "#d9c2a0", "#f0a8cf"};

// A line or a point; of a point both ends are its vertex.
struct Stroke {
  std::array<Vertex, 2> ends;
  bool point;
  std::optional<float> width;
  FillRule rule;

  bool covers(SamplePosition p) const {
    if (point) return point_covers(ends[0], width.value_or(1), p, rule);
    const Line line(ends[0], ends[1], rule);
    return width ? line.covers_wide(*width, p) : line.exits_diamond(p);
  }
};

std::vector<Stroke> primitives_of(const corpus::Scene& scene) {
  std::vector<Stroke> result;
  const corpus::Frame frame(scene, {true, false, false, false, false, false, false});
  for (const Draw& draw : frame.draws()) {
    if (draw.primitive == Primitive::triangles) continue;
    const std::size_t corners = corpus::corners_of(draw.primitive);
    for (std::size_t t = 0; corners * t < draw.indices.size(); ++t) {
      Stroke one{{draw.vertices[draw.indices[corners * t]], draw.vertices[draw.indices[corners * t + corners - 1]]},
                 draw.primitive == Primitive::points,
                 draw.width,
                 draw.fill_rule};
      const bool finite = std::all_of(one.ends.begin(), one.ends.end(), [](const Vertex& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
      });
      if (finite) result.push_back(one);
    }
  }
  return result;
}

// What is seen of a line, as far as it lies near the panel: from 0 to 1 of the way between its ends, or beyond a vertex
// in front to where it leaves the picture. Empty if nothing is.
std::vector<SvgPoint> seen_of(const Panel& panel, const Stroke& one) {
  const Vertex &a = one.ends[0], &b = one.ends[1];
  const bool front[2] = {a.w > 0, b.w > 0};
  if (!front[0] && !front[1]) return {};
  const Vertex& from = front[0] ? a : b;
  const double x = static_cast<double>(from.x) / from.w, y = static_cast<double>(from.y) / from.w;
  double dx = 0, dy = 0, length = 1;
  if (front[0] && front[1]) {
    dx = static_cast<double>(b.x) / b.w - x, dy = static_cast<double>(b.y) / b.w - y;
  } else {
    // From the vertex in front along the direction of S.
    const Vertex& other = front[0] ? b : a;
    dx = static_cast<double>(other.x) * from.w - static_cast<double>(from.x) * other.w;
    dy = static_cast<double>(other.y) * from.w - static_cast<double>(from.y) * other.w;
    length = INFINITY;
  }
  double low = 0, high = length;
  const auto cut = [&](double at, double step, double least, double most) {
    if (step == 0) {
      if (at < least || at > most) high = -1;
      return;
    }
    low = std::max(low, std::min((least - at) / step, (most - at) / step));
    high = std::min(high, std::max((least - at) / step, (most - at) / step));
  };
  cut(x, dx, panel.x0 - 0.5, panel.x1 + 0.5);
  cut(y, dy, panel.y0 - 0.5, panel.y1 + 0.5);
  if (!(low <= high) || !std::isfinite(high)) return {};
  return {panel.at(x + low * dx, y + low * dy), panel.at(x + high * dx, y + high * dy)};
}

void draw_shape(const Panel& panel, const Stroke& one, std::string_view style) {
  if (one.point) {
    if (!(one.ends[0].w > 0)) return;
    const double x = static_cast<double>(one.ends[0].x) / one.ends[0].w,
                 y = static_cast<double>(one.ends[0].y) / one.ends[0].w, half = one.width.value_or(1) / 2.0;
    if (x < panel.x0 - 1 || y < panel.y0 - 1 || x > panel.x1 + 1 || y > panel.y1 + 1) return;
    const double left = std::max<double>(x - half, panel.x0), right = std::min<double>(x + half, panel.x1),
                 top = std::max<double>(y - half, panel.y0), bottom = std::min<double>(y + half, panel.y1);
    panel.pixels(left, top, right, bottom, fmt::format("fill=\"none\" {}", style));
    return;
  }
  const std::vector<SvgPoint> seen = seen_of(panel, one);
  if (!seen.empty()) panel.svg.path(seen, false, fmt::format("fill=\"none\" {}", style));
  for (const Vertex& v : one.ends) {
    if (!(v.w > 0)) continue;
    const double x = static_cast<double>(v.x) / v.w, y = static_cast<double>(v.y) / v.w;
    if (x < panel.x0 || y < panel.y0 || x > panel.x1 || y > panel.y1) continue;
    panel.svg.circle(panel.at(x, y), std::min(2.5, panel.scale / 3), "fill=\"#c4302b\"");
  }
}

void draw_diamonds(const Panel& panel) {
  if (panel.scale < 8) return;
  for (int y = panel.y0; y < panel.y1; ++y) {
    for (int x = panel.x0; x < panel.x1; ++x) {
      panel.svg.path({panel.at(x + 0.5, y), panel.at(x + 1, y + 0.5), panel.at(x + 0.5, y + 1), panel.at(x, y + 0.5)},
                     true, "fill=\"none\" stroke=\"#c9ccd3\" stroke-width=\"0.5\"");
    }
  }
}

// Where the line crosses the columns (rows) of samples, and as far beside as it is wide.
int draw_crossings(const Panel& panel, const Stroke& one) {
  const Vertex &a = one.ends[0], &b = one.ends[1];
  const double ax = a.x, ay = a.y, aw = a.w, bx = b.x, by = b.y, bw = b.w;
  const double ea = ay * bw - aw * by, eb = aw * bx - ax * bw, ec = ax * by - ay * bx;
  const bool x_major = std::abs(eb) >= std::abs(ea);
  const double half = one.width.value_or(1) / 2.0;
  int shown = 0;
  for (int t = x_major ? panel.x0 : panel.y0; t < (x_major ? panel.x1 : panel.y1); ++t) {
    const double along = t + 0.5, beside = x_major ? -(ea * along + ec) / eb : -(eb * along + ec) / ea;
    const auto at = [&](double m) { return x_major ? panel.at(along, m) : panel.at(m, along); };
    const double least = x_major ? panel.y0 : panel.x0, most = x_major ? panel.y1 : panel.x1;
    if (!(beside + half >= least && beside - half <= most)) continue;
    // Where S is: not beyond the ends that are in front of the eye.
    const auto place = [x_major](const Vertex& q) { return static_cast<double>(x_major ? q.x : q.y) / q.w; };
    const double toward = x_major ? eb : -ea;
    const auto past = [&](const Vertex& q, bool last) {
      return q.w > 0 && (toward > 0) == last ? along > place(q) + 0.5 : q.w > 0 && along < place(q) - 0.5;
    };
    if (past(a, false) || past(b, true)) continue;
    panel.svg.line(at(std::clamp(beside - half, least, most)), at(std::clamp(beside + half, least, most)),
                   "stroke=\"#e07b00\" stroke-width=\"1.4\"");
    panel.svg.circle(at(std::clamp(beside, least, most)), std::min(2.0, panel.scale / 5), "fill=\"#e07b00\"");
    ++shown;
  }
  return shown;
}

}  // namespace

std::string scene_line_view(const corpus::Scene& scene, const std::string& file, int chosen) {
  const std::vector<Stroke> all = primitives_of(scene);
  if (all.empty()) throw std::runtime_error(file + ": no line and no point to explain: none is finite");
  if (chosen < 0 || static_cast<std::size_t>(chosen) >= all.size()) {
    throw std::runtime_error(
        fmt::format("--triangle {}: the scene has {} lines and points, from 0", chosen, all.size()));
  }
  const SampleLocation location = sample_location(scene.samples, 0);
  const double u = location.x / 16.0, v = location.y / 16.0;
  const double scale = std::max(2.0, std::min(24.0, 480.0 / std::max(scene.width, scene.height)));
  Sheet sheet(2, 2, 0, 0, scene.width, scene.height, scale, 2);
  const Stroke& one = all[static_cast<std::size_t>(chosen)];
  const Panel whole = sheet.panel(0, "lines and points"),
              panel = sheet.panel(1, fmt::format("{} {}", one.point ? "point" : "line", chosen));
  int covered = 0, twice = 0, own = 0;
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      int hits = 0;
      std::size_t first = 0;
      for (std::size_t n = all.size(); n-- > 0;) {
        if (!all[n].covers({x + u, y + v})) continue;
        ++hits;
        first = n;
      }
      if (hits > 0) whole.pixel(x, y, fmt::format("fill=\"{}\"", kFills[first % kFills.size()]));
      covered += hits > 0;
      twice += hits > 1;
      if (!one.covers({x + u, y + v})) continue;
      panel.pixel(x, y, "fill=\"#5b8fd6\"");
      ++own;
    }
  }
  whole.grid();
  panel.grid();
  const bool thin = !one.point && !one.width;
  if (thin) draw_diamonds(panel);
  for (int y = 0; y < scene.height && scale >= 6 && !thin; ++y) {
    for (int x = 0; x < scene.width; ++x) panel.svg.circle(panel.at(x + u, y + v), 1, "fill=\"#565b66\"");
  }
  for (const Stroke& each : all) draw_shape(whole, each, "stroke=\"#1c2433\" stroke-width=\"1\"");
  const int crossings = one.point ? 0 : draw_crossings(panel, one);
  draw_shape(panel, one, "stroke=\"#1c2433\" stroke-width=\"1.4\"");
  sheet.caption(0, 0, fmt::format("{} lines and points, {} samples covered", all.size(), covered));
  sheet.caption(0, 1, fmt::format("{} samples by several of them", twice));
  sheet.caption(1, 0,
                fmt::format("{} samples: {}", own,
                            one.point   ? fmt::format("a square of {:.4g} pixels", one.width.value_or(1))
                            : one.width ? fmt::format("{:.4g} pixels along the minor axis", *one.width)
                                        : std::string("whose diamond it leaves")));
  if (!one.point) sheet.caption(1, 1, fmt::format("orange: where it crosses {} columns or rows of samples", crossings));
  return sheet.file();
}

}  // namespace surefill::certify
