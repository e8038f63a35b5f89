// SPDX-License-Identifier: Apache-2.0
//
// The views of surefill explain beyond traversals: snapping, interpolation, clipping, visibility, compression.
#include <fmt/format.h>
#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "certify/commands/explain.hpp"
#include "certify/report/svg.hpp"
#include "oracle/exact.hpp"
#include "textbook/interpolation.hpp"
#include "textbook/pipeline.hpp"
#include "textbook/points_lines.hpp"
#include "textbook/tile_codec.hpp"
#include "textbook/visibility.hpp"

namespace surefill::certify {

using namespace textbook;

namespace {

constexpr const char* kFills[] = {"#8fb4e8", "#f2c572", "#9bd09b", "#e59a93",
                                  "#c5a8e0", "#8fd3d3", "#d9c2a0", "#f0a8cf"};

std::string fill(std::size_t n) {
  return fmt::format("fill=\"{}\"", kFills[n % 8]);
}

Triangle set_up(const Explained::OneTriangle& one) {
  Triangle triangle;
  triangle.set_up(one.vertices[0], one.vertices[1], one.vertices[2]);
  return triangle;
}

// Counts of one triangle by the engine.
std::vector<std::uint32_t> engine_counts(const Explained& scene, const Explained::OneTriangle& one,
                                         std::optional<Grid> grid) {
  constexpr std::uint32_t kIndices[] = {0, 1, 2};
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
  Target target;
  target.width = scene.width, target.height = scene.height, target.count = counts;
  Draw draw;
  draw.vertices = one.vertices, draw.indices = kIndices, draw.fill_rule = one.rule, draw.grid = grid;
  if (const Status status = render(target, {&draw, 1}); status != Status::ok)
    throw std::runtime_error(status_text(status));
  return counts;
}

std::size_t place(const Explained& scene, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x);
}

template <class Number>
void draw_polygon(const Panel& panel, const ScreenPolygon<Number>& polygon, std::string_view style) {
  std::vector<SvgPoint> points;
  for (const auto& side : polygon.sides()) {
    if constexpr (std::is_same_v<Number, mpq_class>) {
      points.push_back(panel.at(side.x.get_d(), side.y.get_d()));
    } else {
      points.push_back(panel.at(static_cast<double>(side.x), static_cast<double>(side.y)));
    }
  }
  if (!points.empty()) panel.svg.path(points, true, style);
}

}  // namespace

// The triangle moves by a fixed step a frame; its W are taken as 1 (X/W, Y/W).
std::string snapping_view(const Explained& scene) {
  constexpr int kFrames = 8, kBits[] = {0, 2, 8};
  constexpr double kStepX = 0.15, kStepY = 0.07;
  Sheet sheet(3 * kFrames, kFrames, 0, 0, scene.width, scene.height, 150.0 / std::max(scene.width, scene.height), 4);
  for (int row = 0; row < 3; ++row) {
    const double unit = std::ldexp(1.0, kBits[row]);
    std::array<SvgPoint, 3> before{};
    std::vector<std::uint32_t> counts_before;
    double longest = 0, largest_error = 0;
    std::size_t most_changed = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      const int n = row * kFrames + frame;
      Explained::OneTriangle moved = scene.triangles[scene.chosen];
      std::array<SvgPoint, 3> snapped{};
      for (std::size_t i = 0; i < 3; ++i) {
        Vertex& v = moved.vertices[i];
        v = {static_cast<float>(v.x / v.w + frame * kStepX), static_cast<float>(v.y / v.w + frame * kStepY), 0, 1};
        snapped[i] = {std::nearbyint(v.x * unit) / unit, std::nearbyint(v.y * unit) / unit};
        largest_error = std::max(largest_error, std::hypot(snapped[i].x - v.x, snapped[i].y - v.y));
        if (frame > 0) longest = std::max(longest, std::hypot(snapped[i].x - before[i].x, snapped[i].y - before[i].y));
      }
      const std::vector<std::uint32_t> counts =
          engine_counts(scene, moved, Grid{kBits[row], 0, 0, GridRounding::nearest_even});
      const Panel panel = sheet.panel(n, fmt::format("{} bits, frame {}", kBits[row], frame));
      std::size_t changed = 0;
      for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
          const std::size_t s = place(scene, x, y);
          const bool change = frame > 0 && counts[s] != counts_before[s];
          if (change) ++changed;
          if (counts[s] != 0) panel.pixel(x, y, change ? "fill=\"#2f62a8\"" : "fill=\"#8fb4e8\"");
          if (counts[s] == 0 && change) panel.pixel(x, y, "fill=\"#f7d4d0\"");
        }
      }
      panel.grid();
      std::vector<SvgPoint> outline, truth;
      for (std::size_t i = 0; i < 3; ++i) {
        outline.push_back(panel.at(snapped[i].x, snapped[i].y));
        truth.push_back(panel.at(moved.vertices[i].x, moved.vertices[i].y));
      }
      panel.svg.path(outline, true, "fill=\"none\" stroke=\"#c4302b\" stroke-width=\"1.4\"");
      panel.svg.path(truth, true, "fill=\"none\" stroke=\"#1c2433\" stroke-width=\"1\" stroke-dasharray=\"3 2\"");
      if (frame > 0) sheet.caption(n, 0, fmt::format("{} samples change", changed));
      most_changed = std::max(most_changed, changed);
      before = snapped;
      counts_before = counts;
    }
    const int first = row * kFrames;
    sheet.caption(first, 1, fmt::format("step {:.3f} px a frame", std::hypot(kStepX, kStepY)));
    sheet.caption(first, 2, fmt::format("longest jump {:.3f} px", longest));
    sheet.caption(first, 3, fmt::format("off by up to {:.4f} px", largest_error));
  }
  return sheet.file();
}

// Beside how many ULP it is off, if there is room: the right value above the one that came.
void write_wrong(const Panel& panel, int x, int y, float right, float value, std::int64_t ulps, bool values) {
  const SvgPoint p = panel.at(x + 0.5, y + 0.5);
  const double size = std::min(11.0, panel.scale / 2.6);
  if (values) {
    panel.svg.text({p.x, p.y - 4}, 11, "middle", fmt::format("{:.9g}", right), "fill=\"#20242c\"");
    panel.svg.text({p.x, p.y + 10}, 11, "middle", fmt::format("{:.9g}", value), "fill=\"#8c1010\"");
  } else if (size >= 7) {
    panel.svg.text({p.x, p.y + size * 0.36}, size, "middle", fmt::format("{}", ulps), "fill=\"#20242c\"");
  }
}

std::string interpolation_view(const Explained& scene, bool values) {
  constexpr float kValues[3] = {0.1f, 0.9f, 0.4f};
  const Explained::OneTriangle& one = scene.triangles[scene.chosen];
  for (const Vertex& v : one.vertices) {
    if (v.w == 0) throw std::runtime_error("--view interpolation: a route divides by each W, and one of them is 0");
  }
  Triangle triangle = set_up(one);
  const Lattice lattice{scene.width, scene.height};
  const Interpolator<mpq_class> exact(one.vertices);
  const Interpolator<float> single(one.vertices);
  const Interpolator<double> twice(one.vertices);
  constexpr int kMostWithValues = 24;
  const int longest = std::max(scene.width, scene.height);
  if (values && longest > kMostWithValues) {
    throw std::runtime_error(
        fmt::format("--values: with numbers a target has up to {} pixels each way", kMostWithValues));
  }
  Sheet sheet(6, values ? 1 : 3, 0, 0, scene.width, scene.height, values ? 78 : 300.0 / longest, 3);
  for (int n = 0; n < 5; ++n) {
    const Route route = kRoutes[n];
    const Panel panel = sheet.panel(n, name_of(route));
    int covered = 0, by_float = 0, by_double = 0, by_rational = 0;
    std::int64_t largest = 0;
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        const SamplePosition p = lattice.at(x, y);
        if (!triangle.covers(p, tie_shift(one.rule))) continue;
        ++covered;
        const float right = triangle.attribute(p, kValues, Interpolation::perspective);
        const mpq_class real =
            exact.value(route, {mpq_class(kValues[0]), mpq_class(kValues[1]), mpq_class(kValues[2])}, lattice, x, y);
        if (oracle::nearest_finite(real.get_num(), real.get_den()) != right) ++by_rational;
        const float value = single.value(route, {kValues[0], kValues[1], kValues[2]}, lattice, x, y);
        const double finer = twice.value(route, {kValues[0], kValues[1], kValues[2]}, lattice, x, y);
        if (static_cast<float>(finer) != right) ++by_double;
        const std::int64_t ulps = std::abs(std::int64_t{ordered(value)} - ordered(right));
        if (ulps != 0) ++by_float;
        largest = std::max(largest, ulps);
        panel.pixel(x, y,
                    ulps == 0   ? "fill=\"#cfe9cf\""
                    : ulps == 1 ? "fill=\"#fbe38e\""
                    : ulps < 8  ? "fill=\"#f0a35c\""
                                : "fill=\"#e2877e\"");
        if (ulps != 0) write_wrong(panel, x, y, right, value, ulps, values);
      }
    }
    draw_outline(panel, one);
    sheet.caption(n, 0, fmt::format("float: {} of {} wrong, by up to {} ulp", by_float, covered, largest));
    sheet.caption(n, 1, fmt::format("double, rounded to float: {} wrong", by_double));
    sheet.caption(n, 2, fmt::format("rationals: {} wrong", by_rational));
  }
  const Panel legend = sheet.panel(5, "float, in ulp of the right value");
  constexpr const char* kWords[] = {"0", "1", "2 to 7", "8 and more"};
  constexpr const char* kLegend[] = {"fill=\"#cfe9cf\"", "fill=\"#fbe38e\"", "fill=\"#f0a35c\"", "fill=\"#e2877e\""};
  for (int k = 0; k < 4; ++k) {
    const SvgPoint p{legend.origin.x, legend.origin.y + 24.0 * k};
    legend.svg.rect(p, {p.x + 18, p.y + 18}, kLegend[k]);
    legend.svg.text({p.x + 26, p.y + 14}, 13, "start", kWords[k]);
  }
  return sheet.file();
}

// W grows from 1 to r over the 64 pixels of a triangle with u from 0 to 1: the largest error of w affine in tiles, in
// texels of a texture of 256, against the engine's value.
std::string affine_w_view() {
  constexpr double kWidth = 620, kHeight = 400, kLeft = 90, kTop = 50;
  constexpr double kDecades = 6, kLowest = -3;  // of the error axis
  constexpr int kOctaves = 6;                   // of the slope axis: r from 1 to 64
  Svg svg(kWidth + kLeft + 120, kHeight + kTop + 70);
  const auto at = [&](double octave, double error) {
    const double up = (std::clamp(std::log10(std::max(error, 1e-9)), kLowest, kLowest + kDecades) - kLowest) / kDecades;
    return SvgPoint{kLeft + octave / kOctaves * kWidth, kTop + (1 - up) * kHeight};
  };
  for (int d = 0; d <= 6; ++d) {
    const double error = std::pow(10.0, kLowest + d);
    svg.line(at(0, error), at(kOctaves, error), "stroke=\"#d4d7dd\"");
    svg.text({kLeft - 8, at(0, error).y + 4}, 12, "end", fmt::format("{:g}", error));
  }
  for (int o = 0; o <= kOctaves; ++o) {
    svg.line(at(o, 1e-3), at(o, 1000), "stroke=\"#d4d7dd\"");
    svg.text({at(o, 1).x, kTop + kHeight + 18}, 12, "middle", fmt::format("{}", 1 << o));
  }
  svg.text({kLeft, 26}, 15, "start", "w affine within a tile: largest error in texels (of 256)",
           "font-weight=\"bold\"");
  svg.text({kLeft + kWidth / 2, kTop + kHeight + 42}, 13, "middle",
           "W at the right end over W at the left end of 64 pixels");
  constexpr int kSizes[] = {4, 8, 16};
  constexpr const char* kColours[] = {"#2f62a8", "#e07b00", "#c4302b"};
  for (int k = 0; k < 3; ++k) {
    std::vector<SvgPoint> curve;
    for (int step = 1; step <= 4 * kOctaves; ++step) {
      const auto r = static_cast<float>(std::exp2(step / 4.0));
      const std::array<Vertex, 3> v{Vertex{0, 0, 0, 1}, {64 * r, 0, 0, r}, {0, 64, 0, 1}};
      const float u[3] = {0, 1, 0};
      Triangle triangle = set_up({v, FillRule::top_left});
      const Interpolator<double> approximate(v);
      double largest = 0;
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          const SamplePosition p{x + 0.5, y + 0.5};
          if (!triangle.covers(p, tie_shift(FillRule::top_left))) continue;
          const double right = triangle.attribute(p, u, Interpolation::perspective);
          const int size = kSizes[k];
          const double value = approximate.with_affine_w({0, 1, 0}, p.x, p.y, x / size * size, y / size * size, size);
          largest = std::max(largest, 256 * std::fabs(value - right));
        }
      }
      curve.push_back(at(step / 4.0, largest));
    }
    svg.path(curve, false, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", kColours[k]));
    const SvgPoint key{kLeft + kWidth + 20, kTop + 20.0 * k};
    svg.rect(key, {key.x + 12, key.y + 12}, fmt::format("fill=\"{}\"", kColours[k]));
    svg.text({key.x + 18, key.y + 11}, 12, "start", fmt::format("tile {} x {}", kSizes[k], kSizes[k]));
  }
  return svg.file();
}

std::string clipping_view(const Explained& scene) {
  const int margin = kGuardMargin + 16;
  Sheet sheet(3, 3, -margin, -margin, scene.width + margin, scene.height + margin,
              330.0 / (std::max(scene.width, scene.height) + 2 * margin), 3);
  constexpr const char* kTitles[] = {"clipped to the view volume", "clipped to a guard band",
                                     "float cuts against exact ones"};
  for (int n = 0; n < 3; ++n) {
    const Panel panel = sheet.panel(n, kTitles[n]);
    const ClipTo to = n == 1 ? ClipTo::guard_band : ClipTo::view_volume;
    panel.pixels(0, 0, scene.width, scene.height, "fill=\"#eef2f8\" stroke=\"#6b7280\"");
    panel.pixels(-kGuardMargin, -kGuardMargin, scene.width + kGuardMargin, scene.height + kGuardMargin,
                 "fill=\"none\" stroke=\"#b0b4bc\" stroke-dasharray=\"4 3\"");
    int corners = 0, clipped_triangles = 0, different = 0, covered = 0, exact_differences = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      const Explained::OneTriangle& one = scene.triangles[t];
      const Polygon<mpq_class> polygon = clipped<mpq_class>(one.vertices, scene.width, scene.height, to, false);
      const ScreenPolygon<mpq_class> exact(polygon);
      const ScreenPolygon<float> rounded(clipped<float>(one.vertices, scene.width, scene.height, to, false));
      const bool cut =
          std::any_of(polygon.begin(), polygon.end(), [](const ClipCorner<mpq_class>& c) { return c.cut; });
      clipped_triangles += cut ? 1 : 0;
      corners += static_cast<int>(polygon.size());
      if (n < 2) draw_polygon(panel, exact, fill(t) + " fill-opacity=\"0.55\" stroke=\"#1c2433\"");
      draw_outline(panel, one);
      for (const auto& side : exact.sides()) {
        if (n < 2 && side.cut) panel.svg.circle(panel.at(side.x.get_d(), side.y.get_d()), 3, "fill=\"#c4302b\"");
      }
      const std::vector<std::uint32_t> counts = engine_counts(scene, one, std::nullopt);
      for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
          const bool right = counts[place(scene, x, y)] != 0;
          const TieShift shift = tie_shift(one.rule);
          covered += right ? 1 : 0;
          if (exact.covers(mpq_class(x + 0.5), mpq_class(y + 0.5), shift) != right) ++exact_differences;
          if (rounded.covers(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, shift) == right) continue;
          ++different;
          if (n == 2) panel.svg.circle(panel.at(x + 0.5, y + 0.5), 2.4, "fill=\"#c4302b\"");
        }
      }
    }
    sheet.caption(
        n, 0, fmt::format("{} triangles, {} clipped, {} corners", scene.triangles.size(), clipped_triangles, corners));
    sheet.caption(n, 1, fmt::format("in rationals: {} of {} samples differ", exact_differences, covered));
    sheet.caption(n, 2, fmt::format("in float: {} differ from the clipless image", different));
  }
  return sheet.file();
}

std::string painter_view(const Explained& scene) {
  std::vector<Piece<mpq_class>> pieces, order;
  std::vector<Triangle> triangles;
  DepthBuffer buffer(scene.width, scene.height, false);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    triangles.push_back(set_up(scene.triangles[t]));
    pieces.push_back(piece_of<mpq_class>(scene.triangles[t].vertices, t, scene.width, scene.height));
    buffer.draw(triangles.back(), t, scene.triangles[t].rule);
  }
  paint_order(std::move(pieces), order);
  Sheet sheet(3, 3, 0, 0, scene.width, scene.height, 300.0 / std::max(scene.width, scene.height), 2);
  const Panel cut = sheet.panel(0, "pieces, in the order of painting"), painted = sheet.panel(1, "painted"),
              tested = sheet.panel(2, "z-buffer");
  std::vector<std::uint32_t> image(buffer.index().size(), kNoTriangle);
  std::vector<SvgPoint> labels;
  for (const Piece<mpq_class>& piece : order) {
    const ScreenPolygon<mpq_class> screen(piece.polygon);
    draw_polygon(cut, screen, fill(piece.index) + " stroke=\"#1c2433\" stroke-width=\"1.2\"");
    SvgPoint middle{0, 0};
    for (const auto& side : screen.sides()) middle.x += side.x.get_d(), middle.y += side.y.get_d();
    const auto corners = static_cast<double>(screen.sides().size());
    labels.push_back(cut.at(middle.x / corners, middle.y / corners));
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        if (triangles[piece.index].covers({x + 0.5, y + 0.5}, tie_shift(scene.triangles[piece.index].rule)) &&
            screen.contains(mpq_class(x + 0.5), mpq_class(y + 0.5))) {
          image[place(scene, x, y)] = piece.index;
        }
      }
    }
  }
  for (std::size_t k = 0; k < labels.size(); ++k) {
    cut.svg.circle(labels[k], 8, "fill=\"#ffffff\" fill-opacity=\"0.8\"");
    cut.svg.text({labels[k].x, labels[k].y + 4}, 11, "middle", fmt::format("{}", k + 1), "font-weight=\"bold\"");
  }
  int differences = 0;
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const std::uint32_t by_painter = image[place(scene, x, y)], by_depth = buffer.index()[place(scene, x, y)];
      if (by_painter != kNoTriangle) painted.pixel(x, y, fill(by_painter));
      if (by_depth != kNoTriangle) tested.pixel(x, y, fill(by_depth));
      differences += by_painter != by_depth ? 1 : 0;
    }
  }
  painted.grid();
  tested.grid();
  sheet.caption(0, 0, fmt::format("{} triangles, {} pieces", scene.triangles.size(), order.size()));
  sheet.caption(1, 0, fmt::format("{} samples differ from the z-buffer", differences));
  sheet.caption(2, 0,
                fmt::format("{} depths read, {} written", buffer.counts().depth_reads, buffer.counts().depth_writes));
  return sheet.file();
}

std::string hierarchical_z_view(const Explained& scene) {
  DepthBuffer plain(scene.width, scene.height, false), buffer(scene.width, scene.height, true);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    Triangle triangle = set_up(scene.triangles[t]);
    plain.draw(triangle, t, scene.triangles[t].rule);
    buffer.draw(triangle, t, scene.triangles[t].rule);
  }
  Sheet sheet(2, 2, 0, 0, scene.width, scene.height, 400.0 / std::max(scene.width, scene.height), 4);
  const Panel image = sheet.panel(0, "the image"), tiles = sheet.panel(1, "triangles culled by Zmax / met, a tile");
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const std::uint32_t index = buffer.index()[place(scene, x, y)];
      if (index != kNoTriangle) image.pixel(x, y, fill(index));
    }
  }
  for_each_tile({0, 0, scene.width, scene.height}, DepthBuffer::kTile, [&](const PixelBox& box) {
    const DepthBuffer::Range& range = buffer.range(box.x0, box.y0);
    const double share = range.tests > 0 ? static_cast<double>(range.behind) / range.tests : 0;
    tiles.pixels(box.x0, box.y0, box.x1, box.y1,
                 fmt::format("fill=\"#2f8f4e\" fill-opacity=\"{:.2f}\" stroke=\"#b8bcc4\"", 0.9 * share));
    if (range.tests == 0) return;
    const SvgPoint p = tiles.at((box.x0 + box.x1) / 2.0, (box.y0 + box.y1) / 2.0);
    tiles.svg.text({p.x, p.y + 4}, 11, "middle", fmt::format("{}/{}", range.behind, range.tests));
  });
  const DepthCounts &without = plain.counts(), &with = buffer.counts();
  sheet.caption(0, 0,
                fmt::format("{} triangles, the same image with and without: {}", scene.triangles.size(),
                            plain.index() == buffer.index() && plain.depth() == buffer.depth() ? "yes" : "NO"));
  sheet.caption(0, 1, fmt::format("z-buffer: {} depths read", without.depth_reads));
  sheet.caption(1, 0, fmt::format("{} tiles of triangles, {} culled by Zmax", with.tiles, with.tiles_behind));
  sheet.caption(1, 1, fmt::format("{} wholly in front by Zmin: no read", with.tiles_in_front));
  sheet.caption(1, 2, fmt::format("{} depths read", with.depth_reads));
  return sheet.file();
}

// A strip of lines from sample to corner to sample, and points of several sizes at its vertices.
std::string line_view() {
  constexpr int kSize = 20;
  constexpr Vertex kStrip[] = {{1.5f, 3.5f, 0, 1}, {8, 6, 0, 1},          {13.5f, 2.25f, 0, 1},
                               {18, 9.5f, 0, 1},   {12.75f, 16.5f, 0, 1}, {3.5f, 16.5f, 0, 1}};
  constexpr float kWidths[] = {0, 1, 2, 4};
  constexpr const char* kTitles[] = {"diamond exit", "width 1",          "width 2",
                                     "width 4",      "points of size 1", "points of size 2.5"};
  Sheet sheet(6, 3, 0, 0, kSize, kSize, 15, 1);
  for (int n = 0; n < 6; ++n) {
    const Panel panel = sheet.panel(n, kTitles[n]);
    int twice = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const SamplePosition p{x + 0.5, y + 0.5};
        int hits = 0;
        std::size_t last = 0;
        for (std::size_t k = 0; k < std::size(kStrip); ++k) {
          bool hit = false;
          if (n >= 4) {
            hit = point_covers(kStrip[k], n == 4 ? 1.0f : 2.5f, p, FillRule::top_left);
          } else if (k + 1 < std::size(kStrip)) {
            const Line line(kStrip[k], kStrip[k + 1], FillRule::top_left);
            hit = n == 0 ? line.exits_diamond(p) : line.covers_wide(kWidths[n], p);
          }
          if (!hit) continue;
          ++hits;
          last = k;
        }
        if (hits > 0) panel.pixel(x, y, fill(last));
        if (hits > 1) ++twice;
      }
    }
    panel.grid();
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        if (n == 0) {
          panel.svg.path(
              {panel.at(x + 0.5, y), panel.at(x + 1, y + 0.5), panel.at(x + 0.5, y + 1), panel.at(x, y + 0.5)}, true,
              "fill=\"none\" stroke=\"#c9ccd3\" stroke-width=\"0.5\"");
        }
        if (n > 0) panel.svg.circle(panel.at(x + 0.5, y + 0.5), 1, "fill=\"#565b66\"");
      }
    }
    std::vector<SvgPoint> strip;
    for (const Vertex& v : kStrip) {
      strip.push_back(panel.at(v.x, v.y));
      panel.svg.circle(strip.back(), 2.5, "fill=\"#c4302b\"");
    }
    if (n < 4) panel.svg.path(strip, false, "fill=\"none\" stroke=\"#1c2433\" stroke-width=\"1.2\"");
    sheet.caption(n, 0, fmt::format("{} samples twice", twice));
  }
  return sheet.file();
}

// Depth, and colours of 8 bits from the barycentrics, in tiles of 8 x 8; a tile at the rim repeats its last samples.
std::string codec_view(const Explained& scene) {
  DepthBuffer buffer(scene.width, scene.height, true);
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    triangles.push_back(set_up(scene.triangles[t]));
    buffer.draw(triangles.back(), t, scene.triangles[t].rule);
  }
  const auto colour = [&](int x, int y) -> std::uint32_t {
    const std::uint32_t index = buffer.index()[place(scene, x, y)];
    if (index == kNoTriangle) return 0xFF202428u;
    std::uint32_t packed = 0xFF000000u;
    for (unsigned i = 0; i < 3; ++i) {
      const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
      const float b = triangles[index].attribute({x + 0.5, y + 0.5}, unit, Interpolation::perspective);
      packed |= static_cast<std::uint32_t>(std::lround(255 * b)) << (8 * i);
    }
    return packed;
  };
  Sheet sheet(2, 2, 0, 0, scene.width, scene.height, 400.0 / std::max(scene.width, scene.height), 3);
  const Panel panels[2] = {sheet.panel(0, "depth tiles: bytes of 256"), sheet.panel(1, "colour tiles: bytes of 256")};
  std::size_t bytes[2] = {0, 0}, tiles = 0, lost = 0;
  for_each_tile({0, 0, scene.width, scene.height}, kCodecTile, [&](const PixelBox& box) {
    DepthTile depth;
    ColourTile colours;
    for (int s = 0; s < 64; ++s) {
      const int x = std::min(box.x0 + s % 8, box.x1 - 1), y = std::min(box.y0 + s / 8, box.y1 - 1);
      depth[static_cast<std::size_t>(s)] = buffer.depth()[place(scene, x, y)];
      colours[static_cast<std::size_t>(s)] = colour(x, y);
    }
    ++tiles;
    const std::vector<std::uint8_t> codes[2] = {encode(depth), encode(colours)};
    if (decode_depth(codes[0]) != depth || decode_colour(codes[1]) != colours) ++lost;
    for (std::size_t k = 0; k < 2; ++k) {
      bytes[k] += codes[k].size();
      const double share = std::min(1.0, static_cast<double>(codes[k].size()) / 256);
      panels[k].pixels(box.x0, box.y0, box.x1, box.y1,
                       fmt::format("fill=\"#5b8fd6\" fill-opacity=\"{:.2f}\" stroke=\"#b8bcc4\"", share));
      const SvgPoint p = panels[k].at((box.x0 + box.x1) / 2.0, (box.y0 + box.y1) / 2.0);
      panels[k].svg.text({p.x, p.y + 4}, 11, "middle", fmt::format("{}", codes[k].size()));
    }
  });
  for (int k = 0; k < 2; ++k) {
    if (scene.triangles.size() <= 4) {
      for (const Explained::OneTriangle& one : scene.triangles) draw_outline(panels[k], one);
    }
    sheet.caption(k, 0,
                  fmt::format("{} tiles: {} bytes of {}, {:.0f} % saved", tiles, bytes[k], 256 * tiles,
                              100 - 100.0 * static_cast<double>(bytes[k]) / (256.0 * static_cast<double>(tiles))));
  }
  sheet.caption(0, 1, fmt::format("{} tiles changed by coding and decoding", lost));
  return sheet.file();
}

}  // namespace surefill::certify
