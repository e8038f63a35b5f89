// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/axes.hpp"

#include <algorithm>
#include <cmath>

namespace surefill::judge {

namespace {

using oracle::AxisModel;
using oracle::Rounding;

constexpr double kLeastBlur = 0x1p-24;
constexpr double kMostBlur = 1.0 / 16;  // R13

// --- the viewport

struct Line {
  double lacks = 0, residual = 0;  // the largest
  bool found = false;
};

// The sample lies alike in the grid at every pixel, so turns stand in a line over the pixels, whatever the grid is: in
// source positions, T = (pixel + constant) n / (n - l).
Line line_of(const std::vector<Turn>& turns) {
  Line line;
  double slope = 0;
  int sides = 0;
  for (const bool far : {false, true}) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Turn& t : turns) {
      if (!t.found || t.far != far) continue;
      n += 1, x += t.pixel, y += t.at(), xx += t.pixel * t.pixel, xy += t.pixel * t.at();
    }
    if (n < 4) continue;
    slope += (n * xy - x * y) / (n * xx - x * x);
    ++sides;
  }
  if (sides == 0) return line;
  line.found = true;
  slope /= sides;
  line.lacks = kTurnLength * slope / (1 + slope);
  const auto residual = [&turns](double lacks) {
    double worst = 0;
    for (const bool far : {false, true}) {
      double least = INFINITY, most = -INFINITY;
      for (const Turn& t : turns) {
        if (!t.found || t.far != far) continue;
        const double constant = (t.at() + t.pixel + 0.5) * (kTurnLength - lacks) / kTurnLength - t.pixel;
        least = std::min(least, constant), most = std::max(most, constant);
      }
      worst = std::max(worst, most - least);
    }
    return worst;
  };
  line.residual = residual(line.lacks);
  // A round number that explains the turns nearly as well is what was meant.
  for (const double unit : {1.0, 0.25, 1.0 / 64, 1.0 / 4096}) {
    const double round = std::nearbyint(line.lacks / unit) * unit;
    const double left = residual(round);
    if (left <= 2 * line.residual + 0x1p-19) {
      line.lacks = round + 0.0, line.residual = left;
      break;
    }
  }
  return line;
}

// --- steps

constexpr int kBand = 8, kProbesAtOnce = 8;
constexpr double kReach = 1.6;  // pixels to each side of where the edge is thought to pass its sample

// The scale of an axis and about where its sample is.
struct Rough {
  double scale = 1, place = 0.5;
};

Rough rough_of(const std::vector<Turn>& turns, int length) {
  Rough rough;
  const double lacks = line_of(turns).lacks, seen_scale = (kTurnLength - lacks) / kTurnLength;
  rough.scale = (length - lacks) / length;
  double sum = 0;
  int n = 0;
  for (const Turn& t : turns) {
    if (!t.found) continue;
    sum += (t.at() + t.pixel + 0.5) * seen_scale - t.pixel;
    ++n;
  }
  if (n > 0) rough.place = sum / n;
  return rough;
}

// An edge from (m, top of its band) to (c, bottom), m moving; the triangle lies to its right, wide enough that its other
// edges are no matter.
bool make_slider(Random& random, int axis, int number, bool negative, const Rough& along, const Rough& across,
                 Slider& slider) {
  // At no round numbers, where it would matter which way the other axis rounds.
  const double begin = kBand * number + 0.13718, end = kBand * number + 7.86129;
  const int row = random.between(1, 4);
  const double f = (row - 0.13718 + across.place) / (end - begin);
  const double turn = negative ? -9 + 6 * random.unit() : 4 + 7 * random.unit();
  const int pixel = random.between(2, 11);
  const double at = (pixel + along.place) / along.scale;
  const double c = std::nearbyint((at - turn * (1 - f)) / f * 16) / 16;
  const double far = 15.75;
  if (!(c >= 0.5) || !(c <= 12) || (far - c) * f < kReach + 0.5) return false;
  const double middle = (at - c * f) / (1 - f), reach = kReach / (1 - f);
  if (!negative && (middle - reach < 0.5 || middle + reach > 15.5)) return false;
  const auto top = static_cast<float>(begin / across.scale), bottom = static_cast<float>(end / across.scale);
  slider.triangle = [axis, c, far, top, bottom](float m) {
    const FlatTriangle triangle{{{m, top}, {static_cast<float>(c), bottom}, {static_cast<float>(far), bottom}}};
    return axis == 0 ? triangle : transposed(triangle);
  };
  slider.x = pixel;
  slider.y = kBand * number + row;
  if (axis == 1) std::swap(slider.x, slider.y);
  slider.covered_end = middle - reach;
  slider.uncovered_end = middle + reach;
  return true;
}

// Where the moving ends of edges stand when these stop covering their samples.
std::vector<Slider> measure_steps(Rival& rival, Cull culled, int axis, bool negative, int batches, const Rough& along,
                                  const Rough& across) {
  Random random(negative ? 0x57E9 : 0x57E8);
  std::vector<Slider> found;
  for (int batch = 0; batch < batches; ++batch) {
    std::vector<Slider> sliders;
    for (int tries = 0; tries < 4000 && sliders.size() < kProbesAtOnce; ++tries) {
      Slider slider;
      if (make_slider(random, axis, static_cast<int>(sliders.size()), negative, along, across, slider)) {
        sliders.push_back(slider);
      }
    }
    const int length = kBand * kProbesAtOnce;
    slide(rival, axis == 0 ? kTurnLength : length, axis == 0 ? length : kTurnLength, culled, sliders);
    std::copy_if(sliders.begin(), sliders.end(), std::back_inserter(found), [](const Slider& s) { return s.found; });
  }
  return found;
}

struct Span {
  double low, high;
};

// All numbers, taken modulo 1, lie in an arc: its middle, and its length.
struct Arc {
  double middle = 0, length = 1;
};
Arc arc_of(std::vector<double> phases) {
  for (double& phase : phases) phase -= std::floor(phase);
  std::sort(phases.begin(), phases.end());
  Arc arc;
  double largest = -1;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double next = i + 1 < phases.size() ? phases[i + 1] : phases[0] + 1;
    if (next - phases[i] <= largest) continue;
    largest = next - phases[i];
    arc.length = 1 - largest;
    arc.middle = next + arc.length / 2;
  }
  arc.middle -= std::floor(arc.middle);
  return arc;
}

double distance_to(const Span& span, double value) {
  return std::max({0.0, span.low - value, value - span.high});
}

double nearest_boundary(const AxisFit& fit, double position) {
  return fit.boundary + std::ldexp(std::nearbyint(std::ldexp(position - fit.boundary, fit.bits)), -fit.bits);
}

// The coarsest grid whose boundaries all these places are: where it is not one, so many places at random all lie within
// a quarter of a step with a chance of 16 k 4^-k for k of them.
bool find_grid(const std::vector<Span>& steps, AxisFit& fit) {
  constexpr int kFinest = 16;
  for (int bits = 0; bits <= kFinest; ++bits) {
    std::vector<double> phases;
    for (const Span& step : steps) phases.push_back(std::ldexp((step.low + step.high) / 2, bits));
    const Arc arc = arc_of(phases);
    if (arc.length > 0.25) continue;
    fit.bits = bits;
    // Boundaries are at halves of a step, or at sixteenths, as far as rounding on the way shows; on a grid nearly as fine as
    // what can be asked each of these places is known to a part of a step.
    const auto put = [&](double phase) { fit.boundary = std::ldexp(phase - std::floor(phase), -bits); };
    put(std::nearbyint(arc.middle * 2) / 2);
    if (std::ranges::all_of(steps, [&](const Span& step) {
          return distance_to(step, nearest_boundary(fit, (step.low + step.high) / 2)) < std::ldexp(1.0 / 80, -bits);
        })) {
      return true;
    }
    const double round = std::nearbyint(arc.middle * 16) / 16;
    const double off = std::ldexp(std::abs(round - arc.middle), -bits);
    const bool is_round = off <= std::ldexp(arc.length, -bits) + 0x1p-15 && std::abs(round - arc.middle) < 1.0 / 80;
    put(is_round ? round : arc.middle);
    if (!is_round) fit.blur = 0x1p-20;  // a rounding of float32 below 16: whoever does this does not do it exactly
    return true;
  }
  return false;
}

// What the turns say under a grid, or without one.
void place_sample(const std::vector<Turn>& turns, const std::vector<Span>& spans, AxisFit& fit) {
  if (fit.bits < 0) {
    double low = -INFINITY, high = INFINITY;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (!turns[i].found) continue;
      low = std::max(low, spans[i].low - turns[i].pixel);
      high = std::min(high, spans[i].high - turns[i].pixel);
    }
    // Turns that contradict each other do so by rounding. Of 26 roundings that are spread evenly over -r to r all are
    // within half of that with a chance of 2^-26: what was seen is doubled.
    if (low > high) {
      fit.blur = std::max(fit.blur, 2 * (low - high));
      std::swap(low, high);
    }
    fit.low = low, fit.high = high;
    return;
  }
  const double half = std::ldexp(0.5, -fit.bits);
  fit.low = -INFINITY, fit.high = INFINITY;
  for (const bool far : {false, true}) {
    double constant = NAN;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (!turns[i].found || turns[i].far != far) continue;
      const double at = nearest_boundary(fit, (spans[i].low + spans[i].high) / 2) - turns[i].pixel;
      if (!std::isnan(constant) && std::abs(at - constant) > half) fit.why = "edges turn at no even steps of the grid";
      constant = at;
    }
    if (std::isnan(constant)) continue;
    fit.low = std::max(fit.low, constant - half);
    fit.high = std::min(fit.high, constant + half);
  }
  if (fit.low > fit.high + half) fit.why = "near and far edges turn too far from each other";
  if (fit.low > fit.high) std::swap(fit.low, fit.high);
}

}  // namespace

double AxisFit::middle(double position) const {
  if (bits < 0) return position;
  return boundary + std::ldexp(std::floor(std::ldexp(position - boundary, bits)) + 0.5, -bits);
}

AxisFit fit_axis(Rival& rival, Cull culled, int axis, const std::vector<Turn>& turns, const std::vector<Turn>& others,
                 bool* offscreen) {
  AxisFit fit;
  const Line line = line_of(turns);
  if (!line.found) {
    fit.why = "too few edges turn";
    return fit;
  }
  fit.lacks = line.lacks;
  const Rough along = rough_of(turns, kTurnLength), across = rough_of(others, kBand * kProbesAtOnce);
  const auto span_of = [&fit](double a, double b) {
    const double scale = (kTurnLength - fit.lacks) / kTurnLength;
    return Span{std::min(a, b) * scale, std::max(a, b) * scale};
  };
  std::vector<Slider> steps = measure_steps(rival, culled, axis, false, 4, along, across);
  if (steps.size() < 12) {
    fit.why = "too few slanted edges turn";
    return fit;
  }
  try {
    const std::vector<Slider> negative = measure_steps(rival, culled, axis, true, 2, along, across);
    steps.insert(steps.end(), negative.begin(), negative.end());
  } catch (const Declined&) {
    *offscreen = false;
  }
  fit.steps = steps;
  std::vector<Span> step_spans, turn_spans;
  for (const Slider& step : steps) step_spans.push_back(span_of(step.covered, step.uncovered));
  for (const Turn& turn : turns) turn_spans.push_back(span_of(turn.covered, turn.uncovered));
  if (find_grid(step_spans, fit)) {
    double worst = 0;
    for (const Span& step : step_spans) {
      worst = std::max(worst, distance_to(step, nearest_boundary(fit, (step.low + step.high) / 2)));
    }
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (!turns[i].found) continue;
      const Span& turn = turn_spans[i];
      worst = std::max(worst, distance_to(turn, nearest_boundary(fit, (turn.low + turn.high) / 2)));
      worst = std::max(worst, turns[i].spread);
    }
    // Doubled for the same reason as in `place_sample`, from more of them.
    fit.blur = std::max(fit.blur, 2 * worst);
    if (worst > std::ldexp(0.25, -fit.bits)) fit.bits = -1, fit.blur = 0;
  }
  for (const Turn& turn : turns) {
    if (turn.found) fit.blur = std::max(fit.blur, 2 * turn.spread);
  }
  place_sample(turns, turn_spans, fit);
  // Through a viewport of another size something is rounded on the way, and so ties are not known.
  if (fit.lacks != 0) fit.blur = std::max(fit.blur, kLeastBlur);
  if (fit.blur > kMostBlur) fit.why = "positions are not kept within a sixteenth of a pixel";
  if (fit.bits < 0 || fit.blur > 0) return fit;
  const auto note = [&fit](const Span& span) {
    const double at = nearest_boundary(fit, (span.low + span.high) / 2);
    // An end of the span is on the boundary itself: at the upper end the position went down, for all below it did.
    if (at == span.low || at == span.high) fit.ties.push_back({at, at == span.high});
  };
  for (const Span& span : step_spans) note(span);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i].found) note(turn_spans[i]);
  }
  return fit;
}

std::vector<Reading> readings_of(const AxisFit& fit) {
  std::vector<Reading> readings;
  Reading plain;
  plain.axis.lacks = fit.lacks;
  plain.axis.blur = fit.blur;
  if (fit.bits < 0) return {plain};
  constexpr std::array<std::pair<Rounding, int>, 7> kRoundings{{{Rounding::nearest_even, 0},
                                                                {Rounding::nearest_up, 0},
                                                                {Rounding::nearest_away, 1},
                                                                {Rounding::nearest_down, 1},
                                                                {Rounding::floor, 2},
                                                                {Rounding::truncate, 3},
                                                                {Rounding::ceiling, 3}}};
  const double step = std::ldexp(1.0, -fit.bits);
  const auto goes_up = [step](const AxisModel& axis, double at) {
    return snapped(at, axis) > snapped(at - step / 4, axis);
  };
  for (const auto& [rounding, oddity] : kRoundings) {
    // Towards zero or away from it, zero may be that of another place: t.
    const bool by_sign = rounding == Rounding::nearest_away || rounding == Rounding::truncate;
    for (const double moved : {0.0, 0.25, -0.25, 0.5, -0.5, 0.125, -0.125, 1.0, -1.0}) {
      if (moved != 0 && !by_sign) continue;
      Reading reading = plain;
      reading.axis.bits = fit.bits;
      reading.axis.rounding = rounding;
      reading.axis.moved = moved;
      const bool nearest = rounding <= Rounding::nearest_away;
      const double offset = (fit.boundary + moved) / step - (nearest ? 0.5 : 0);
      reading.axis.grid_offset = (offset - std::floor(offset)) * step;
      if (moved != 0 && reading.axis.grid_offset != 0) continue;
      reading.oddity = oddity + (reading.axis.grid_offset != 0 ? 18 : 0) + (moved != 0 ? 20 : 0);
      const double middle = fit.boundary + 8 + step / 2;
      reading.shift = snapped(middle + moved, reading.axis) - fit.middle(middle);
      const bool kept = std::all_of(fit.ties.begin(), fit.ties.end(),
                                    [&](const Tie& tie) { return goes_up(reading.axis, tie.at + moved) == tie.up; });
      if (kept) readings.push_back(reading);
    }
  }
  // By no rule: then ties are not known.
  if (readings.empty()) {
    AxisFit open = fit;
    open.ties.clear();
    open.blur = kLeastBlur;
    return readings_of(open);
  }
  return readings;
}

double rounding_of(const AxisFit& fit, const AxisFit& other, int axis, double place, double other_place) {
  const double scale = (kTurnLength - fit.lacks) / kTurnLength;
  const double across_length = kBand * kProbesAtOnce, across_scale = (across_length - other.lacks) / across_length;
  double worst = 0;
  for (const Slider& step : fit.steps) {
    FlatTriangle t = step.triangle(step.covered);
    if (axis == 1) t = transposed(t);
    const double top = other.middle(t[0].y * across_scale), bottom = other.middle(t[1].y * across_scale);
    const double c = fit.middle(t[1].x * scale);
    const double f = ((axis == 0 ? step.y : step.x) + other_place - top) / (bottom - top);
    const double turn = ((axis == 0 ? step.x : step.y) + place - c * f) / (1 - f);
    const double a = step.covered * scale, b = step.uncovered * scale;
    worst = std::max(worst, distance_to({std::min(a, b), std::max(a, b)}, turn));
  }
  return worst;
}

std::optional<double> usual_place(double low, double high, int* oddity) {
  constexpr std::array<std::pair<double, double>, 4> kUnits{{{1, 0.5}, {1, 0}, {0.25, 0}, {1.0 / 16, 0}}};
  for (std::size_t i = 0; i < kUnits.size(); ++i) {
    const auto [unit, offset] = kUnits[i];
    const double round = std::ceil((low - offset) / unit - 0x1p-30) * unit + offset;
    if (round > high + 0x1p-30 || round < -0.75 || round > 1.75) continue;
    // Of a grid of whole pixels edges say little.
    if (i > 0 && high - low > (i == 1 ? 1.0 / 8 : 1.0 / 64)) continue;
    *oddity = static_cast<int>(4 * i);
    return round;
  }
  *oddity = 16;
  return std::nullopt;
}

}  // namespace surefill::judge
