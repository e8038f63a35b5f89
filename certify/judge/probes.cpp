// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/probes.hpp"

#include <algorithm>
#include <limits>

namespace surefill::judge {

namespace {

using oracle::Rounding;

constexpr int kMoreAnswers = 10;

std::vector<bool> answers(Rival& rival, int width, int height, Cull culled, const std::vector<Slider>& sliders,
                          const std::vector<float>& at) {
  std::vector<FlatTriangle> triangles;
  for (std::size_t i = 0; i < sliders.size(); ++i) triangles.push_back(seen(sliders[i].triangle(at[i]), culled));
  const corpus::Image image = rival.draw(flat_scene(width, height, triangles), covering(rival));
  std::vector<bool> covered;
  for (const Slider& slider : sliders) {
    covered.push_back(is_covered(image, static_cast<std::size_t>(slider.y * image.width + slider.x)));
  }
  return covered;
}

}  // namespace

corpus::Scene flat_scene(int width, int height, const std::vector<FlatTriangle>& triangles, float z) {
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (const FlatTriangle& triangle : triangles) {
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

corpus::Outputs covering(const Rival& rival) {
  corpus::Outputs wanted = rival.outputs();
  wanted.barycentrics = wanted.attributes = false;
  return wanted;
}

float on_step(double value, double step) {
  return static_cast<float>(step == 0 ? value : std::nearbyint(value / step) * step);
}

FlatTriangle seen(FlatTriangle triangle, Cull culled) {
  auto& [a, b, c] = triangle;
  const double turn = (static_cast<double>(b.x) - a.x) * (static_cast<double>(c.y) - a.y) -
                      (static_cast<double>(b.y) - a.y) * (static_cast<double>(c.x) - a.x);
  if (culled != Cull::none && (turn > 0) == (culled == Cull::front)) std::swap(b, c);
  return triangle;
}

FlatTriangle transposed(FlatTriangle triangle) {
  for (Point& p : triangle) std::swap(p.x, p.y);
  return triangle;
}

double snapped(double position, const oracle::AxisModel& axis) {
  if (axis.bits < 0) return position;
  const double scaled = std::ldexp(position - axis.grid_offset, axis.bits);
  const double below = std::floor(scaled), part = scaled - below;
  double k = below;
  switch (axis.rounding) {
    case Rounding::floor:
      break;
    case Rounding::ceiling:
      k = std::ceil(scaled);
      break;
    case Rounding::truncate:
      k = std::trunc(scaled);
      break;
    case Rounding::nearest_even:
      k = part == 0.5 ? below + (std::fmod(below, 2) != 0 ? 1 : 0) : part < 0.5 ? below : below + 1;
      break;
    case Rounding::nearest_up:
      k = part < 0.5 ? below : below + 1;
      break;
    case Rounding::nearest_down:
      k = part <= 0.5 ? below : below + 1;
      break;
    case Rounding::nearest_away:
      k = part < 0.5 || (part == 0.5 && scaled < 0) ? below : below + 1;
      break;
  }
  return axis.grid_offset + std::ldexp(k, -axis.bits);
}

void slide(Rival& rival, int width, int height, Cull culled, std::vector<Slider>& sliders) {
  const double step = rival.position_step();
  std::vector<float> at(sliders.size());
  const auto ask = [&](const auto& place_of) {
    for (std::size_t i = 0; i < sliders.size(); ++i) at[i] = place_of(sliders[i]);
    return answers(rival, width, height, culled, sliders, at);
  };
  const std::vector<bool> first = ask([step](const Slider& s) { return on_step(s.covered_end, step); });
  const std::vector<bool> last = ask([step](const Slider& s) { return on_step(s.uncovered_end, step); });
  for (std::size_t i = 0; i < sliders.size(); ++i) {
    sliders[i].covered = on_step(sliders[i].covered_end, step);
    sliders[i].uncovered = on_step(sliders[i].uncovered_end, step);
    sliders[i].found = first[i] && !last[i];
  }
  const auto middle = [step](const Slider& s) {
    return on_step((static_cast<double>(s.covered) + s.uncovered) / 2, step);
  };
  for (bool moved = true; moved;) {
    moved = false;
    const std::vector<bool> now = ask(middle);
    for (std::size_t i = 0; i < sliders.size(); ++i) {
      if (at[i] == sliders[i].covered || at[i] == sliders[i].uncovered) continue;
      moved = true;
      (now[i] ? sliders[i].covered : sliders[i].uncovered) = at[i];
    }
  }
}

void slide_again(Rival& rival, int width, int height, Cull culled, std::vector<Slider>& sliders) {
  const double step = rival.position_step();
  std::vector<float> at(sliders.size());
  // Close to the turn and far from it: 2^-k pixels before and behind.
  for (int n = 0; n < kMoreAnswers; ++n) {
    const double distance = std::ldexp(0.75 + 0.0625 * (n / 2), -1 - 2 * (n / 2)) * (n % 2 == 0 ? 1 : -1);
    for (std::size_t i = 0; i < sliders.size(); ++i) {
      const auto [low, high] = std::minmax(sliders[i].covered_end, sliders[i].uncovered_end);
      at[i] = on_step(std::clamp(static_cast<double>(sliders[i].covered) + distance, low, high), step);
    }
    const std::vector<bool> now = answers(rival, width, height, culled, sliders, at);
    for (std::size_t i = 0; i < sliders.size(); ++i) {
      Slider& s = sliders[i];
      const bool before = s.covered_end > s.uncovered_end ? at[i] >= s.covered : at[i] <= s.covered;
      if (now[i] != before) s.spread = std::max(s.spread, std::abs(static_cast<double>(at[i]) - s.covered));
    }
  }
}

}  // namespace surefill::judge
