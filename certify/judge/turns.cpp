// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace surefill::judge {

namespace {

constexpr double kReach = 1.1;    // pixels on each side of the pixel's centre in which a turn is looked for
constexpr int kBand = 4;          // pixels across that each probe has for itself
constexpr int kMoreAnswers = 10;  // beside those of the search, for the spread

// The ends of the way: where an edge of a right rasterizer covers the sample, and where it does not.
struct Way {
  double covered, uncovered;
};

Way way_of(const Turn& turn) {
  const double centre = turn.pixel + 0.5;
  if (turn.far) return {centre + kReach, std::max(centre - kReach, 0.125)};
  return {std::max(centre - kReach, 0.0), centre + kReach};
}

float on_step(double value, double step) {
  return static_cast<float>(step == 0 ? value : std::nearbyint(value / step) * step);
}

// Each probe's triangle in a band of its own: its edge at `edges`, the apex some pixels inwards, level with the sample.
corpus::Scene probe_scene(int axis, Cull culled, const std::vector<Turn>& turns, const std::vector<float>& edges) {
  std::vector<std::array<Point, 3>> triangles;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto begin = static_cast<float>(kBand * static_cast<int>(i));
    const float apex = turns[i].far ? std::max(0.0f, static_cast<float>(turns[i].pixel) - 2.5f)
                                    : static_cast<float>(turns[i].pixel) + 3.5f;
    triangles.push_back({{{edges[i], begin}, {edges[i], begin + 3}, {apex, begin + 1.5f}}});
    if (axis == 1) {
      for (Point& p : triangles.back()) std::swap(p.x, p.y);
    }
    auto& [a, b, c] = triangles.back();
    const bool front = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
    if (front == (culled == Cull::front)) std::swap(b, c);
  }
  const int across = kBand * static_cast<int>(turns.size());
  return flat_scene(axis == 0 ? kTurnLength : across, axis == 0 ? across : kTurnLength, triangles);
}

std::vector<bool> answers(Rival& rival, int axis, Cull culled, const std::vector<Turn>& turns,
                          const std::vector<float>& edges) {
  corpus::Outputs wanted = rival.outputs();
  wanted.barycentrics = wanted.attributes = false;
  const corpus::Image image = rival.draw(probe_scene(axis, culled, turns, edges), wanted);
  std::vector<bool> covered;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const int along = turns[i].pixel, across = kBand * static_cast<int>(i) + 1;
    const int x = axis == 0 ? along : across, y = axis == 0 ? across : along;
    covered.push_back(is_covered(image, static_cast<std::size_t>(y * image.width + x)));
  }
  return covered;
}

void measure_axis(Rival& rival, int axis, Cull culled, std::vector<Turn>& table) {
  std::vector<Turn> turns;
  for (const int pixel : {0, 1, 4, 9, 12}) {
    for (const bool far : {false, true}) turns.push_back({axis, far, pixel, false, 0, 0, 0});
  }
  const double step = rival.position_step();
  std::vector<float> edges(turns.size());
  const auto ask = [&](const auto& edge_of) {
    for (std::size_t i = 0; i < turns.size(); ++i) edges[i] = edge_of(turns[i]);
    return answers(rival, axis, culled, turns, edges);
  };
  const std::vector<bool> first = ask([&](const Turn& t) { return on_step(way_of(t).covered, step); });
  const std::vector<bool> last = ask([&](const Turn& t) { return on_step(way_of(t).uncovered, step); });
  for (std::size_t i = 0; i < turns.size(); ++i) {
    turns[i].covered = on_step(way_of(turns[i]).covered, step);
    turns[i].uncovered = on_step(way_of(turns[i]).uncovered, step);
    turns[i].found = first[i] && !last[i];
  }
  const auto middle = [step](const Turn& t) {
    return on_step((static_cast<double>(t.covered) + t.uncovered) / 2, step);
  };
  for (bool moved = true; moved;) {
    moved = false;
    const std::vector<bool> now = ask(middle);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const float at = edges[i];
      if (at == turns[i].covered || at == turns[i].uncovered) continue;
      moved = true;
      (now[i] ? turns[i].covered : turns[i].uncovered) = at;
    }
  }
  // Close to the turn and far from it: 2^-k pixels before and behind.
  for (int n = 0; n < kMoreAnswers; ++n) {
    const double distance = std::ldexp(0.75 + 0.0625 * (n / 2), -1 - 2 * (n / 2)) * (n % 2 == 0 ? 1 : -1);
    const std::vector<bool> now = ask([&](const Turn& t) {
      const double low = std::min(way_of(t).covered, way_of(t).uncovered);
      return on_step(std::clamp(static_cast<double>(t.covered) + distance, low, low + 2 * kReach), step);
    });
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool before = turns[i].far ? edges[i] >= turns[i].covered : edges[i] <= turns[i].covered;
      if (now[i] != before) {
        turns[i].spread = std::max(turns[i].spread, std::abs(static_cast<double>(edges[i]) - turns[i].covered));
      }
    }
  }
  table.insert(table.end(), turns.begin(), turns.end());
}

}  // namespace

corpus::Scene flat_scene(int width, int height, const std::vector<std::array<Point, 3>>& triangles, float z) {
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    for (const Point& p : triangle) draw.vertices.push_back({p.x, p.y, z, 1, {}});
    draw.triangles.push_back({{first, first + 1, first + 2}, std::nullopt});
  }
  return scene;
}

bool is_covered(const corpus::Image& image, std::size_t s) {
  if (!image.count.empty()) return image.count[s] > 0;
  if (!image.index.empty()) return image.index[s] != kNoTriangle;
  return image.depth[s] != std::numeric_limits<float>::infinity();
}

std::vector<Turn> measure_turns(Rival& rival, Cull culled) {
  std::vector<Turn> table;
  measure_axis(rival, 0, culled, table);
  measure_axis(rival, 1, culled, table);
  return table;
}

std::string turns_text(const std::vector<Turn>& turns) {
  constexpr const char* kSides[] = {"left edge ", "right edge", "upper edge", "lower edge"};
  std::string text;
  for (int side = 0; side < 4; ++side) {
    std::string line = std::string(kSides[side]) + " turns at";
    for (const Turn& turn : turns) {
      if (turn.axis != side / 2 || turn.far != (side % 2 == 1)) continue;
      char number[64];
      std::snprintf(number, sizeof number, "  %d: %+.9g px", turn.pixel, turn.at());
      line += turn.found ? number : "  " + std::to_string(turn.pixel) + ": not at all";
      if (turn.spread > 0) {
        std::snprintf(number, sizeof number, " (mixed over %.3g px)", turn.spread);
        line += number;
      }
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace surefill::judge
