// SPDX-License-Identifier: Apache-2.0
#include "certify/report/report_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "certify/report/reading.hpp"
#include "certify/report/report.hpp"

namespace surefill::certify {

namespace {

constexpr int kViewPixels = 14;           // of a zoomed view, each way, at most
constexpr double kPanelSize = 420;        // of a picture on the page, in CSS pixels
constexpr double kNumberSize = 12;        // of a count, in CSS pixels
constexpr double kLeastNumberScale = 26;  // CSS pixels a pixel, below which there is no place for a count

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

// G1, for a picture: near enough in double.
double snapped_to(double position, int bits, int offset, GridRounding rounding) {
  const double o = std::ldexp(offset, -bits - 4), steps = std::ldexp(position - o, bits);
  const double k = rounding == GridRounding::truncate     ? std::trunc(steps)
                   : rounding == GridRounding::nearest_up ? std::floor(steps + 0.5)
                                                          : std::nearbyint(steps);
  return o + std::ldexp(k, -bits);
}

std::vector<Point> snapped(const std::array<Vertex, 3>& triangle, const Grid& grid) {
  std::vector<Point> points;
  for (const Vertex& v : triangle) {
    if (!(v.w > 0) || !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.w)) return {};
    points.push_back({snapped_to(double{v.x} / v.w, grid.bits, grid.offset_x, grid.rounding),
                      snapped_to(double{v.y} / v.w, grid.bits, grid.offset_y, grid.rounding)});
  }
  return points;
}

const char* colour_of(std::uint32_t count) {
  if (count == properties::Exhibit::kOpenCount) return "#eadfc2";
  return count == 0 ? "#c3c8d0" : count == 1 ? "#2467b5" : count == 2 ? "#e08a00" : "#8a3ab9";
}

// The sample that differs first.
std::optional<Point> first_difference(const Evidence& evidence) {
  std::size_t s = 0;
  for (int y = evidence.y0; y < evidence.y0 + evidence.height; ++y) {
    for (int x = evidence.x0; x < evidence.x0 + evidence.width; ++x) {
      for (int n = 0; n < evidence.samples; ++n, ++s) {
        if (!evidence.differs[s]) continue;
        const SampleLocation at = sample_location(evidence.samples, n);
        return Point{x + at.x / 16.0, y + at.y / 16.0};
      }
    }
  }
  return std::nullopt;
}

// How far a point is from the segment a b.
double distance_to(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
  const double t = length > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length, 0.0, 1.0) : 0.0;
  return std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
}

// The part of the segment within [-1, 1] x [-1, 1], or nothing.
std::optional<std::array<Point, 2>> within_unit(Point a, Point b) {
  double from = 0, to = 1;
  const double dx = b.x - a.x, dy = b.y - a.y;
  const std::array<std::array<double, 2>, 4> sides{{{-dx, a.x + 1}, {dx, 1 - a.x}, {-dy, a.y + 1}, {dy, 1 - a.y}}};
  for (const auto& [towards, room] : sides) {
    if (towards == 0 && room < 0) return std::nullopt;
    if (towards == 0) continue;
    const double t = room / towards;
    (towards < 0 ? from : to) = towards < 0 ? std::max(from, t) : std::min(to, t);
  }
  if (from > to) return std::nullopt;
  return std::array<Point, 2>{{{a.x + from * dx, a.y + from * dy}, {a.x + to * dx, a.y + to * dy}}};
}

}  // namespace

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

std::vector<Outline> outlines(const std::string& scene_text) {
  std::vector<Outline> result;
  try {
    const corpus::Scene scene = corpus::read_scene(scene_text);
    const corpus::Frame frame(scene, {false, false, false, false, false});
    for (const Draw& draw : frame.draws()) {
      for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
        std::array<Vertex, 3> triangle{};
        for (std::size_t i = 0; i < 3; ++i) triangle[i] = draw.vertices[draw.indices[3 * t + i]];
        Outline& outline_of = result.emplace_back();
        outline_of.given = outline(triangle, std::max(scene.width, scene.height));
        if (draw.grid) outline_of.snapped = snapped(triangle, *draw.grid);
      }
    }
  } catch (const corpus::SceneError&) {
    result.clear();  // a certificate that was edited: the picture then shows the samples alone
  }
  return result;
}

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

std::string picture(const Evidence& evidence, const std::vector<std::uint32_t>& counts, const View& view,
                    const std::vector<Outline>& triangles, const std::string& caption, bool marks, const Label& label) {
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
    // The one that decides is drawn as a line, and the other one, where there is a grid, dashed.
    const bool has_grid = !triangles[t].snapped.empty();
    const char* hue = kHues[t % kHues.size()];
    const auto add = [&](const std::vector<Point>& points, bool decides) {
      if (points.size() < 2) return;
      svg += "<polygon points=\"";
      for (const Point& p : points) svg += fmt::format("{:.6f},{:.6f} ", p.x, p.y);
      svg += fmt::format("\" fill=\"{}\" fill-opacity=\"{}\" stroke=\"{}\" stroke-width=\"{:.4f}\"{}/>", hue,
                         decides ? "0.10" : "0", hue, (decides ? 1.6 : 1) / scale,
                         decides ? "" : fmt::format(" stroke-dasharray=\"{:.4f}\"", 4 / scale));
    };
    if (has_grid) add(triangles[t].snapped, true);
    add(triangles[t].given, !has_grid);
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
        // The place itself: the dot is as wide as it has to be to be seen.
        const double arm = radius * 0.55;
        svg += fmt::format(
            "<path d=\"M{0:.4f} {2:.4f}H{1:.4f}M{3:.4f} {4:.4f}V{5:.4f}\" stroke=\"#fff\" stroke-width=\"{6:.4f}\"/>",
            cx - arm, cx + arm, cy, cx, cy - arm, cy + arm, 1 / scale);
        const bool labelled = !label.text.empty() && x == label.x && y == label.y;
        if (labelled && n == 0) {
          // It begins where the picture does, if there is no room on that side.
          const double room = 4.2 * static_cast<double>(label.text.size()) / scale;
          const double middle = std::clamp(cx, std::min(view.x0 + room, view.x0 + width / 2.0),
                                           std::max(view.x1 - room, view.x0 + width / 2.0));
          svg += fmt::format(
              "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.4f}\" font-weight=\"bold\" fill=\"#b01515\" "
              "stroke=\"#fff\" stroke-width=\"{:.4f}\" paint-order=\"stroke\" text-anchor=\"middle\">{}</text>",
              middle, y + 0.97, (kNumberSize + 1) / scale, 3 / scale, escaped(label.text));
        }
        if (evidence.samples == 1 && scale >= kLeastNumberScale && !labelled) {
          svg += fmt::format(
              "<text x=\"{:.3f}\" y=\"{:.3f}\" font-size=\"{:.4f}\" fill=\"#1d2129\" text-anchor=\"middle\">{}</text>",
              cx, y + 0.97, kNumberSize / scale,
              counts[s] == properties::Exhibit::kOpenCount ? "?" : std::to_string(counts[s]));
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

std::string inset(const Evidence& evidence, const std::vector<Outline>& triangles) {
  constexpr double kNear = 0.25;        // pixels: a difference further from all edges needs no inset
  constexpr double kClosest = 0x1p-20;  // below which they are shown as one
  constexpr double kSize = 260;         // CSS pixels
  const std::optional<Point> sample = first_difference(evidence);
  if (!sample) return "";
  double nearest = kNear, farthest = 0;
  for (const Outline& triangle : triangles) {
    // Both lines of an edge that a grid moves are to be seen.
    std::array<double, 2> distances{kNear, kNear};
    const std::array<const std::vector<Point>*, 2> both{&triangle.given, &triangle.snapped};
    for (std::size_t which = 0; which < 2; ++which) {
      const std::vector<Point>& p = *both[which];
      for (std::size_t i = 0; i < p.size(); ++i) {
        distances[which] = std::min(distances[which], distance_to(*sample, p[i], p[(i + 1) % p.size()]));
      }
    }
    if (std::min(distances[0], distances[1]) >= nearest && farthest > 0) continue;
    nearest = std::min({nearest, distances[0], distances[1]});
    farthest = triangle.snapped.empty() || distances[0] >= kNear || distances[1] >= kNear
                   ? std::min(distances[0], distances[1])
                   : std::max(distances[0], distances[1]);
  }
  if (nearest >= kNear) return "";
  const double half = 2.5 * std::max(farthest, kClosest);
  std::string svg = fmt::format("<svg width=\"{0:.0f}\" height=\"{0:.0f}\" viewBox=\"-1 -1 2 2\">", kSize);
  const double pixel = 2 / kSize;
  const auto lines = [&](const std::vector<Point>& points, const char* style) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point &p = points[i], &q = points[(i + 1) % points.size()];
      const auto part = within_unit({(p.x - sample->x) / half, (p.y - sample->y) / half},
                                    {(q.x - sample->x) / half, (q.y - sample->y) / half});
      if (!part) continue;
      svg += fmt::format("<line x1=\"{:.5f}\" y1=\"{:.5f}\" x2=\"{:.5f}\" y2=\"{:.5f}\" {}/>", (*part)[0].x,
                         (*part)[0].y, (*part)[1].x, (*part)[1].y, style);
    }
  };
  const std::string decides = fmt::format("stroke=\"#2467b5\" stroke-width=\"{:.4f}\"", 2 * pixel);
  const std::string dashed =
      fmt::format("stroke=\"#2467b5\" stroke-width=\"{:.4f}\" stroke-dasharray=\"{:.4f}\"", pixel, 5 * pixel);
  bool grid = false;
  for (const Outline& triangle : triangles) {
    grid = grid || !triangle.snapped.empty();
    lines(triangle.snapped, decides.c_str());
    lines(triangle.given, triangle.snapped.empty() ? decides.c_str() : dashed.c_str());
  }
  svg += fmt::format("<path d=\"M-0.08 0H0.08M0 -0.08V0.08\" stroke=\"#d01f1f\" stroke-width=\"{:.4f}\"/></svg>",
                     2 * pixel);
  const std::string where =
      nearest == 0 ? std::string("on an edge") : fmt::format("{:.3g} pixels from an edge", nearest);
  return fmt::format(
      "<figure><figcaption>The first sample that differs lies {}; this is {:.3g} pixels "
      "wide{}</figcaption>{}</figure>\n",
      where, 2 * half, grid ? " (dashed: before the grid)" : "", svg);
}

std::string turns_picture(const std::string& turns) {
  constexpr double kWidth = 336, kRow = 34, kLeft = 72, kRight = 16, kTop = 26;  // as wide as a telephone
  struct Row {
    std::string side;
    std::vector<std::pair<int, double>> at;
  };
  std::vector<Row> rows;
  double widest = 0.5;
  for (const std::string& line : lines_of(turns)) {
    const std::size_t verb = line.find(" turns at");
    if (verb == std::string::npos) continue;
    Row& row = rows.emplace_back();
    row.side = line.substr(0, verb);
    for (std::size_t i = verb + 9; i < line.size();) {
      int pixel = 0;
      double place = 0;
      Reading turn(std::string_view(line).substr(i));
      if (turn.text("  ").number(pixel).text(": ").number(place).text(" px").fits()) {
        row.at.emplace_back(pixel, place);
        widest = std::max(widest, std::min(std::abs(place), 4.0));
        i = line.size() - turn.rest().size();
      } else {
        const std::size_t next = line.find("  ", i + 2);
        i = next == std::string::npos ? line.size() : next;
      }
    }
  }
  if (rows.empty()) return "";
  widest *= 1.15;
  const double height = kTop + kRow * static_cast<double>(rows.size()) + 8;
  const auto x_of = [&](double place) {
    return kLeft + (std::clamp(place, -widest, widest) + widest) / (2 * widest) * (kWidth - kLeft - kRight);
  };
  std::string svg =
      fmt::format("<svg width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-size=\"12\">", kWidth, height);
  for (const auto& [place, name] : {std::pair<double, const char*>{-0.5, "-1/2"}, {0, "centre"}, {0.5, "+1/2"}}) {
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.0f}\" stroke=\"{3}\"/><text x=\"{0:.1f}\" y=\"15\" "
        "text-anchor=\"middle\" fill=\"#40454f\">{4}</text>",
        x_of(place), kTop - 4, height - 4, place == 0 ? "#8b93a0" : "#d4d7dd", name);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double y = kTop + kRow * (static_cast<double>(r) + 0.5);
    svg += fmt::format("<text x=\"4\" y=\"{:.0f}\" fill=\"#1d2129\">{}</text>", y + 4, escaped(rows[r].side));
    for (const auto& [pixel, place] : rows[r].at) {
      svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.0f}\" r=\"4\" fill=\"#2467b5\" fill-opacity=\"0.45\"/>",
                         x_of(place), y);
    }
    if (rows[r].at.empty()) {
      svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" fill=\"#a87400\">not at all</text>", x_of(0) + 8, y + 4);
    } else {
      // What the first pixels say; where others say something else, their dots lie elsewhere.
      svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" fill=\"#40454f\" font-size=\"11\">{:+.4g}</text>",
                         std::min(x_of(rows[r].at.front().second) + 8, kWidth - 60), y - 6, rows[r].at.front().second);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace surefill::certify
