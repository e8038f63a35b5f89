// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/line_rules.hpp"

#include <algorithm>
#include <cmath>

namespace surefill::judge {

namespace {

struct Place {
  double x, y;
};
Place place_of(const Vertex& v) {
  return {static_cast<double>(v.x) / v.w, static_cast<double>(v.y) / v.w};
}

std::string pixel_text(int x, int y) {
  return "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")";
}

Model with_shape(Model model, oracle::LineShape shape) {
  model.lines.thin = model.lines.wide = shape;
  model.lines.left_out = oracle::LeftOut::last;
  model.lines.whole_pixels = false;
  model.lines.outline.ties.reset();
  return model;
}

// Does |dx| exceed |dy|, or the reverse, by more than 2 pixels?
std::optional<bool> x_major(const Vertex& a, const Vertex& b) {
  const Place p = place_of(a), q = place_of(b);
  const double more = std::abs(q.x - p.x) - std::abs(q.y - p.y);
  if (std::abs(more) <= 2 + 1e-6) return std::nullopt;
  return more > 0;
}

}  // namespace

std::optional<LoneLine> lone_line(const corpus::Scene& scene) {
  if (scene.samples != 1 || scene.draws.size() != 1) return std::nullopt;
  const corpus::SceneDraw& draw = scene.draws[0];
  if (draw.primitive != Primitive::lines || draw.triangles.size() != 1 || draw.viewport || draw.scissor ||
      draw.depth_mode == DepthMode::clip) {
    return std::nullopt;
  }
  LoneLine line{scene.width, scene.height, {}, draw.width};
  for (std::size_t i = 0; i < 2; ++i) {
    const corpus::SceneVertex& v = draw.vertices[draw.triangles[0].vertices[i]];
    line.ends[i] = {v.x, v.y, v.z, v.w};
    if (!(v.w > 0)) return std::nullopt;
  }
  return line;
}

RuleVerdict judge_line(const Expected& expected, const Model& model, const LoneLine& line,
                       const std::vector<bool>& covered) {
  RuleVerdict verdict;
  const std::optional<bool> major = x_major(line.ends[0], line.ends[1]);
  if (!major || line.line_width.value_or(1) > 64) return verdict;
  // What becomes of other widths than whole ones is not asked.
  const double wide = line.line_width.value_or(1), n = std::max(1.0, std::floor(wide + 0.5));
  if (wide != n) return verdict;
  const std::vector<Cover> near = expected.cover_line(with_shape(model, oracle::LineShape::tolerant), line.width,
                                                      line.height, line.ends, line.line_width);
  const std::vector<Cover> ideal = expected.cover_line(with_shape(model, oracle::LineShape::diamond), line.width,
                                                       line.height, line.ends, line.line_width);
  const auto at = [&line](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(line.width) + static_cast<std::size_t>(x);
  };
  // All of it is on the target if nothing next to its border may be covered.
  for (int x = 0; x < line.width; ++x) {
    if (near[at(x, 0)] != Cover::no || near[at(x, line.height - 1)] != Cover::no) return verdict;
  }
  for (int y = 0; y < line.height; ++y) {
    if (near[at(0, y)] != Cover::no || near[at(line.width - 1, y)] != Cover::no) return verdict;
  }
  for (const Vertex& v : line.ends) {
    const Place p = place_of(v);
    if (!(p.x >= 0 && p.y >= 0 && p.x <= line.width && p.y <= line.height)) return verdict;
  }
  verdict.judged = true;
  double least = 0, most = 0, drawn = 0;
  for (int y = 0; y < line.height; ++y) {
    for (int x = 0; x < line.width; ++x) {
      least += ideal[at(x, y)] == Cover::yes;
      most += ideal[at(x, y)] != Cover::no;
      drawn += covered[at(x, y)];
      if (verdict.rule == 1) continue;
      if (covered[at(x, y)] && near[at(x, y)] == Cover::no) {
        verdict.rule = 1;
        verdict.finding = pixel_text(x, y) + " is drawn, more than a pixel away from all that the line should draw";
      } else if (ideal[at(x, y)] == Cover::yes) {
        bool found = false;
        for (int j = y - 1; j <= y + 1; ++j) {
          for (int i = x - 1; i <= x + 1; ++i) found = found || covered[at(i, j)];
        }
        if (found) continue;
        verdict.rule = 1;
        verdict.finding = "nothing is drawn within a pixel of " + pixel_text(x, y) + ", which the line should draw";
      }
    }
  }
  if (verdict.rule != 0) return verdict;
  const int across = *major ? line.height : line.width, along = *major ? line.width : line.height;
  const char* what = *major ? "column " : "row ";
  for (int t = 0; t < along; ++t) {
    int first = -1, last = -1, number = 0;
    for (int s = 0; s < across; ++s) {
      if (!covered[*major ? at(t, s) : at(s, t)]) continue;
      if (first < 0) first = s;
      last = s;
      ++number;
    }
    if (number == 0) continue;
    const bool gap = last - first + 1 != number;
    if (number <= n && !gap) continue;
    verdict.rule = 3;
    verdict.finding = std::string("the line is ") + (*major ? "x" : "y") + "-major, and " + what + std::to_string(t) +
                      " has " + std::to_string(number) + " pixels" + (gap ? " with a gap" : "") + ", where " +
                      std::to_string(static_cast<int>(n)) + " are due";
    return verdict;
  }
  if (drawn < least - n || drawn > most + n) {
    verdict.rule = 2;
    verdict.finding = "the line has " + std::to_string(static_cast<int>(drawn)) + " pixels, where " +
                      std::to_string(static_cast<int>(least)) +
                      (most > least ? " to " + std::to_string(static_cast<int>(most)) : std::string()) +
                      " are due, or " + std::to_string(static_cast<int>(n)) + " more or fewer";
  }
  return verdict;
}

bool strip_runs(std::span<const Vertex> ends) {
  std::optional<bool> axis;
  int direction = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const std::optional<bool> major = x_major(ends[i], ends[i + 1]);
    if (!major || (axis && *axis != *major)) return false;
    axis = major;
    const Place p = place_of(ends[i]), q = place_of(ends[i + 1]);
    const int way = (*major ? q.x > p.x : q.y > p.y) ? 1 : -1;
    if (direction != 0 && way != direction) return false;
    direction = way;
  }
  return ends.size() >= 3;
}

RuleVerdict judge_strip(const Expected& expected, const Model& model, int width, int height,
                        std::span<const Vertex> ends, std::span<const std::uint32_t> counts) {
  RuleVerdict verdict;
  if (!strip_runs(ends)) return verdict;
  const bool major = *x_major(ends[0], ends[1]);
  const auto at = [width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  // All of it lies on the target.
  const Model tolerant = with_shape(model, oracle::LineShape::tolerant);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const std::vector<Cover> near = expected.cover_line(tolerant, width, height, {ends[i], ends[i + 1]}, std::nullopt);
    for (int x = 0; x < width; ++x) {
      if (near[at(x, 0)] != Cover::no || near[at(x, height - 1)] != Cover::no) return verdict;
    }
    for (int y = 0; y < height; ++y) {
      if (near[at(0, y)] != Cover::no || near[at(width - 1, y)] != Cover::no) return verdict;
    }
  }
  for (const Vertex& v : ends) {
    const Place p = place_of(v);
    if (!(p.x >= 0 && p.y >= 0 && p.x <= width && p.y <= height)) return verdict;
  }
  verdict.judged = true;
  int first = -1, last = -1;
  std::vector<int> numbers(static_cast<std::size_t>(major ? width : height), 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t count = counts[at(x, y)];
      if (count > 1 && verdict.rule == 0) {
        verdict.rule = 4;
        verdict.finding = pixel_text(x, y) + " is drawn " + std::to_string(count) +
                          " times, where lines of a strip that runs one way meet";
      }
      if (count > 0) ++numbers[static_cast<std::size_t>(major ? x : y)];
    }
  }
  for (int t = 0; t < static_cast<int>(numbers.size()); ++t) {
    if (numbers[static_cast<std::size_t>(t)] == 0) continue;
    if (first < 0) first = t;
    last = t;
  }
  for (int t = first; t <= last && first >= 0 && verdict.rule == 0; ++t) {
    if (numbers[static_cast<std::size_t>(t)] != 0) continue;
    verdict.rule = 4;
    verdict.finding = std::string(major ? "column " : "row ") + std::to_string(t) +
                      " has no pixel, between others of a strip of lines that runs one way: its joints have gaps";
  }
  return verdict;
}

}  // namespace surefill::judge
