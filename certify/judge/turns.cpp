// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/turns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

constexpr double kReach = 1.1;  // pixels on each side of the pixel's centre in which a turn is looked for
constexpr int kBand = 4;        // pixels across that each probe has for itself

// Each probe's triangle in a band of its own: the apex some pixels inwards, level with the sample.
Slider slider_of(const Turn& turn, int number) {
  const auto begin = static_cast<float>(kBand * number);
  const float apex =
      turn.far ? std::max(0.0f, static_cast<float>(turn.pixel) - 2.5f) : static_cast<float>(turn.pixel) + 3.5f;
  Slider slider;
  slider.triangle = [axis = turn.axis, begin, apex](float edge) {
    const FlatTriangle triangle{{{edge, begin}, {edge, begin + 3}, {apex, begin + 1.5f}}};
    return axis == 0 ? triangle : transposed(triangle);
  };
  slider.x = turn.pixel;
  slider.y = kBand * number + 1;
  if (turn.axis == 1) std::swap(slider.x, slider.y);
  const double centre = turn.pixel + 0.5;
  slider.covered_end = turn.far ? centre + kReach : std::max(centre - kReach, 0.0);
  slider.uncovered_end = turn.far ? std::max(centre - kReach, 0.125) : centre + kReach;
  return slider;
}

std::vector<Turn> measure(Rival& rival, Cull culled, int axis, std::initializer_list<int> pixels) {
  std::vector<Turn> turns;
  std::vector<Slider> sliders;
  for (const int pixel : pixels) {
    for (const bool far : {false, true}) {
      turns.push_back({axis, far, pixel, false, 0, 0, 0});
      sliders.push_back(slider_of(turns.back(), static_cast<int>(sliders.size())));
    }
  }
  const int across = kBand * static_cast<int>(turns.size());
  const int width = axis == 0 ? kTurnLength : across, height = axis == 0 ? across : kTurnLength;
  slide(rival, width, height, culled, sliders);
  slide_again(rival, width, height, culled, sliders);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    turns[i].found = sliders[i].found;
    turns[i].covered = sliders[i].covered;
    turns[i].uncovered = sliders[i].uncovered;
    turns[i].spread = sliders[i].spread;
  }
  return turns;
}

}  // namespace

std::vector<Turn> measure_turns(Rival& rival, Cull culled) {
  std::vector<Turn> table = measure(rival, culled, 0, {0, 1, 4, 9, 12});
  const std::vector<Turn> level = measure(rival, culled, 1, {0, 1, 4, 9, 12});
  table.insert(table.end(), level.begin(), level.end());
  return table;
}

std::vector<Turn> measure_more_turns(Rival& rival, Cull culled, int axis) {
  return measure(rival, culled, axis, {2, 3, 5, 6, 7, 8, 10, 11});
}

std::string turns_text(const std::vector<Turn>& turns) {
  constexpr const char* kSides[] = {"left edge ", "right edge", "upper edge", "lower edge"};
  std::string lines;
  for (int side = 0; side < 4; ++side) {
    std::string line = std::string(kSides[side]) + " turns at";
    for (const Turn& turn : turns) {
      if (turn.axis != side / 2 || turn.far != (side % 2 == 1)) continue;
      line += turn.found ? text("  %d: %+.9g px", turn.pixel, turn.at()) : text("  %d: not at all", turn.pixel);
      if (turn.spread > 0) line += text(" (mixed over %.3g px)", turn.spread);
    }
    lines += line + "\n";
  }
  return lines;
}

}  // namespace surefill::judge
