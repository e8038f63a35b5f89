// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/inference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "certify/judge/axes.hpp"
#include "certify/judge/facts.hpp"
#include "certify/judge/owners.hpp"
#include "certify/judge/places.hpp"
#include "certify/judge/room.hpp"
#include "certify/judge/stated.hpp"
#include "certify/judge/words.hpp"

namespace surefill::judge {

namespace {

using oracle::AxisModel;

constexpr double kMostBlur = 1.0 / 16;  // R13: what is blurred more is not known
constexpr double kClearer = 4;          // a band has to make so much less of the blur: it leaves more open

double blur_of(const Model& model) {
  return std::max(model.x.blur, model.y.blur);
}

std::vector<Turn> of_axis(const std::vector<Turn>& turns, int axis) {
  std::vector<Turn> part;
  std::copy_if(turns.begin(), turns.end(), std::back_inserter(part), [axis](const Turn& t) { return t.axis == axis; });
  return part;
}

std::array<Vertex, 3> triangle_of(const corpus::Scene& scene) {
  std::array<Vertex, 3> triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const corpus::SceneVertex& v = scene.draws[0].vertices[scene.draws[0].triangles[0].vertices[i]];
    triangle[i] = {v.x, v.y, v.z, v.w};
  }
  return triangle;
}

// Samples that the model decides otherwise than the image.
std::uint64_t wrong_samples(const Expected& expected, const Model& model, const Probe& probe) {
  const std::vector<Cover> answers =
      expected.cover(model, probe.scene.width, probe.scene.height, 1, triangle_of(probe.scene));
  std::uint64_t wrong = 0;
  for (std::size_t s = 0; s < answers.size(); ++s) {
    if (answers[s] != Cover::open && (answers[s] == Cover::yes) != is_covered(probe.image, s)) ++wrong;
  }
  return wrong;
}

// --- which reading

// A reading of one axis with where its sample is: `within` 0 is to the point.
struct Choice {
  AxisModel axis;
  double shift = 0;
  int oddity = 0;
};

// [low, high] is the sample's place in terms of middles. Nobody samples a hair beside a usual place: positions are rounded
// on the way so that it looks so.
Choice choice_of(const Reading& reading, double low, double high, const std::optional<AxisModel>& declared) {
  constexpr double kHair = 0x1p-12;
  Choice choice{reading.axis, reading.shift, reading.oddity};
  low += reading.shift;
  high += reading.shift;
  int unusual = 0;
  std::optional<double> place = usual_place(low, high, &unusual);
  if (!place && high - low < kHair) place = usual_place(low - kHair, high + kHair, &unusual);
  choice.axis.place = place ? *place : (low + high) / 2;
  choice.axis.place_within = place ? 0 : (high - low) / 2 + 0x1p-26;
  if (place) choice.axis.blur = std::max({choice.axis.blur, 2 * (low - *place), 2 * (*place - high)});
  choice.oddity += unusual + (choice.axis.place < 0 || choice.axis.place >= 1 ? 2 : 0);
  if (declared && declared->bits == choice.axis.bits && declared->rounding == choice.axis.rounding &&
      declared->grid_offset == choice.axis.grid_offset && declared->place == choice.axis.place) {
    choice.oddity = -1;
  }
  return choice;
}

std::vector<Choice> choices_of(const AxisFit& fit, double low, double high, const std::optional<AxisModel>& declared) {
  std::vector<Choice> choices;
  for (const Reading& reading : readings_of(fit)) choices.push_back(choice_of(reading, low, high, declared));
  std::stable_sort(choices.begin(), choices.end(),
                   [](const Choice& a, const Choice& b) { return a.oddity < b.oddity; });
  return choices;
}

constexpr int kTellingSize = 8;

// A source position in the middle of what goes to about this place.
float middle_of(const AxisModel& axis, double at, double step, bool upper) {
  if (axis.bits < 0) return on_step(at, step);
  const double source = placed(at, axis, kTellingSize) - axis.moved + std::ldexp(upper ? 0.25 : -0.25, -axis.bits);
  return on_step(source * kTellingSize / (kTellingSize - axis.lacks), step);
}

// Where the two readings send a position to different places, as seen from the sample: near 0, or left of it.
std::optional<float> disputed(Random& random, const AxisModel& a, const AxisModel& b, double step) {
  for (int n = 0; n < 400; ++n) {
    const double at = n < 300 ? -1.5 + 3 * random.unit() : -8 + 8 * random.unit();
    const float source = middle_of(a, at, step, random.below(2) == 0);
    const double from_a = placed(source, a, kTellingSize) - a.place, from_b = placed(source, b, kTellingSize) - b.place;
    if (std::abs(from_a - from_b) > std::ldexp(0.5, -std::max(a.bits, 0))) return source;
  }
  return std::nullopt;
}

// A triangle with an edge from there, between the two places, close past a sample; the other axis is kept above 1, where
// all its readings are alike.
FlatTriangle telling_triangle(Random& random, float source, const AxisModel& a, const AxisModel& b,
                              const AxisModel& other, double step) {
  const double from =
      (placed(source, a, kTellingSize) - a.place + placed(source, b, kTellingSize) - b.place) / 2 + a.place;
  FlatTriangle triangle{};
  triangle[0] = {source, middle_of(other, 1.25 + 6.5 * random.unit(), step, true)};
  const double y = placed(triangle[0].y, other, kTellingSize);
  const double sx = random.between(0, 5) + a.place, sy = random.between(2, 6) + other.place;
  const double further = 1.2 + 3 * random.unit();
  triangle[1] = {middle_of(a, from + (sx - from) * further, step, true),
                 middle_of(other, y + (sy - y) * further, step, true)};
  triangle[2] = {middle_of(a, 2 + 10 * random.unit(), step, true),
                 middle_of(other, 1.25 + 10 * random.unit(), step, true)};
  return triangle;
}

class Chooser {
 public:
  Chooser(Rival& rival, const Expected& expected, std::vector<Probe>& probes)
      : rival_(rival), expected_(expected), probes_(probes) {}

  // The choices of this axis that no probe refutes: the first of them meets every other one in a triangle that tells them
  // apart. Where there should be one and none is found, positions are known to a step. `both` is the model so far.
  std::vector<Choice> choose(std::vector<Choice> choices, int axis, const Model& both, bool offscreen) {
    const AxisModel& other = axis == 0 ? both.y : both.x;
    const double step = rival_.position_step();
    std::size_t best = 0;
    std::vector<std::uint64_t> wrong(choices.size(), 0);
    bool unsure = false;
    for (std::size_t c = 0; c < choices.size() && offscreen; ++c) {
      if (c == best || wrong[c] > wrong[best]) continue;
      const std::optional<float> source = disputed(random_, choices[best].axis, choices[c].axis, step);
      if (!source) continue;
      const std::optional<corpus::Scene> scene = telling_scene(choices[best].axis, choices[c].axis, axis, both, other);
      if (!scene) {
        unsure = true;
        continue;
      }
      try {
        probes_.push_back({*scene, rival_.draw(*scene, covering(rival_))});
      } catch (const Declined&) {
        break;
      }
      for (std::size_t k = 0; k < choices.size(); ++k) {
        wrong[k] += wrong_samples(expected_, with(both, axis, choices[k].axis), probes_.back());
      }
      const auto now = static_cast<std::size_t>(std::min_element(wrong.begin(), wrong.end()) - wrong.begin());
      if (wrong[now] >= wrong[best]) continue;
      best = now;
      unsure = false;
      c = static_cast<std::size_t>(-1);
    }
    if (unsure) {
      AxisModel& chosen = choices[best].axis;
      chosen.blur = std::max(chosen.blur, std::ldexp(1.0, -chosen.bits));
    }
    std::vector<Choice> left{choices[best]};
    for (std::size_t c = 0; c < choices.size() && !unsure; ++c) {
      if (c != best && wrong[c] == wrong[best]) left.push_back(choices[c]);
    }
    return left;
  }

 private:
  static Model with(Model model, int axis, const AxisModel& one) {
    (axis == 0 ? model.x : model.y) = one;
    return model;
  }

  std::optional<corpus::Scene> telling_scene(const AxisModel& a, const AxisModel& b, int axis, const Model& both,
                                             const AxisModel& other) {
    constexpr int kTries = 300;
    for (int n = 0; n < kTries; ++n) {
      const std::optional<float> source = disputed(random_, a, b, rival_.position_step());
      if (!source) continue;
      const FlatTriangle triangle = telling_triangle(random_, *source, a, b, other, rival_.position_step());
      if (std::any_of(triangle.begin(), triangle.end(), [](const Point& p) { return p.y < 1.125f; })) continue;
      corpus::Scene scene =
          flat_scene(kTellingSize, kTellingSize, {seen(axis == 0 ? triangle : transposed(triangle), both.culled)});
      if (apart(with(both, axis, a), with(both, axis, b), scene)) return scene;
    }
    return std::nullopt;
  }

  bool apart(const Model& a, const Model& b, const corpus::Scene& scene) const {
    const auto cover = [&](const Model& model) {
      return expected_.cover(model, kTellingSize, kTellingSize, 1, triangle_of(scene));
    };
    const std::vector<Cover> x = cover(a), y = cover(b);
    for (std::size_t s = 0; s < x.size(); ++s) {
      if (x[s] != y[s] && x[s] != Cover::open && y[s] != Cover::open) return true;
    }
    return false;
  }

  Rival& rival_;
  const Expected& expected_;
  std::vector<Probe>& probes_;
  Random random_{0xC40};
};

// Of choices that nobody can tell apart, those that say the same of both axes, if there are any; else the first ones.
std::pair<AxisModel, AxisModel> in_the_same_words(const std::vector<Choice>& xs, const std::vector<Choice>& ys) {
  const auto alike = [](const AxisModel& a, const AxisModel& b) {
    return a.bits == b.bits && a.rounding == b.rounding && a.grid_offset == b.grid_offset && a.moved == b.moved;
  };
  const Choice *best_x = &xs.front(), *best_y = &ys.front();
  for (const Choice& x : xs) {
    for (const Choice& y : ys) {
      if (!alike(x.axis, y.axis)) continue;
      const bool found = alike(best_x->axis, best_y->axis);
      if (!found || x.oddity + y.oddity < best_x->oddity + best_y->oddity) best_x = &x, best_y = &y;
    }
  }
  return {best_x->axis, best_y->axis};
}

// --- whether all of it holds

// Triangles that nothing was inferred from, on targets of several sizes. Of each four one has an edge through a sample, at
// an uneven part of its length, and one an edge that passes a sample at 2^-4 to 2^-29 pixels, ten of each; the others lie
// anywhere, over the target's borders, too, or halfway between steps.
constexpr int kTrials = 4 * 26 * 10;

struct Along {
  const AxisModel& axis;
  int length;
  // Where a vertex has to be given so that it comes to lie there, as far as the grid has it.
  float source(double place, double step) const {
    double q = place - axis.moved;
    // R5 rounds down or up: in the middle of what goes there.
    if (axis.bits >= 0 && axis.rounding > oracle::Rounding::nearest_away) {
      const double nearest =
          axis.grid_offset + std::ldexp(std::nearbyint(std::ldexp(place - axis.grid_offset, axis.bits)), -axis.bits);
      const bool up = axis.rounding == oracle::Rounding::ceiling ||
                      (axis.rounding == oracle::Rounding::truncate && nearest < axis.grid_offset);
      q = nearest - axis.moved + std::ldexp(up ? -0.5 : 0.5, -axis.bits);
    }
    return on_step(q * length / (length - axis.lacks), step);
  }
};

corpus::Scene trial_scene(Random& random, const Model& model, double step, bool offscreen, int number) {
  constexpr std::array<std::array<int, 2>, 4> kSizes{{{8, 8}, {16, 16}, {24, 12}, {5, 19}}};
  const int kind = number % 4, round = number / 4;
  const auto [width, height] = kSizes[static_cast<std::size_t>(round % 4)];
  const Along x{model.x, width}, y{model.y, height};
  FlatTriangle triangle{};
  const bool beside = offscreen && kind == 3;
  const auto anywhere = [&](const AxisModel& axis, int length) {
    const double low = beside ? -length : 0, high = beside ? 2 * length : length,
                 at = low + (high - low) * random.unit();
    if (axis.bits < 0 || round % 3 == 0) return on_step(std::nearbyint(std::ldexp(at, 16)) / 65536, step);
    const double source = placed(at, axis, length) - axis.moved + (round % 3 == 1 ? std::ldexp(0.5, -axis.bits) : 0);
    return on_step(std::clamp(source * length / (length - axis.lacks), low, high), step);
  };
  for (Point& p : triangle) p = {anywhere(model.x, width), anywhere(model.y, height)};
  if (kind < 2) {
    const double sx = random.below(width) + model.x.place, sy = random.below(height) + model.y.place;
    const double unit = std::max(model.x.bits < 0 ? 1.0 / 64 : std::ldexp(1.0, -model.x.bits),
                                 model.y.bits < 0 ? 1.0 / 64 : std::ldexp(1.0, -model.y.bits));
    const double reach = std::max(1.0, std::min(width, height) / (10 * unit));
    const double dx = std::nearbyint((2 * random.unit() - 1) * reach) * unit,
                 dy = std::nearbyint((2 * random.unit() - 1) * reach) * unit;
    const double aside =
        kind == 0 ? 0
                  : std::ldexp(random.below(2) == 0 ? 1.0 : -1.0, -4 - round % 26) / std::max(1e-9, std::hypot(dx, dy));
    const int before = random.between(1, 5), behind = random.between(1, 5);
    triangle[0] = {x.source(sx - before * dx - aside * dy, step), y.source(sy - before * dy + aside * dx, step)};
    triangle[1] = {x.source(sx + behind * dx - aside * dy, step), y.source(sy + behind * dy + aside * dx, step)};
    const auto inside = [](const Point& p, int w, int h) {
      return p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(w) && p.y <= static_cast<float>(h);
    };
    if (!offscreen) {
      for (Point& p : triangle) {
        if (!inside(p, width, height)) p = {anywhere(model.x, width), anywhere(model.y, height)};
      }
    }
  }
  return flat_scene(width, height, {seen(triangle, model.culled)});
}

void draw_trials(Rival& rival, Inference& result, std::vector<Probe>& probes) {
  Random random(0x721A1);
  for (int n = 0; n < kTrials; ++n) {
    const corpus::Scene scene = trial_scene(random, result.model, rival.position_step(), result.offscreen, n);
    try {
      probes.push_back({scene, rival.draw(scene, covering(rival))});
    } catch (const Declined&) {
      result.offscreen = false;
    }
  }
}

// A triangle with an edge to a vertex so far beyond the target, which comes as near to a sample as the grid lets it: of some
// edges, all of them steeper than 45 degrees or none, the nearest one that the model has at least `beside` pixels from it.
corpus::Scene reaching_scene(Random& random, const Model& model, double given, int distance, bool steep,
                             double beside) {
  constexpr int kSize = 16, kEdges = 64;
  const Along x{model.x, kSize}, y{model.y, kSize};
  const auto step = [](const AxisModel& axis) { return axis.bits < 0 ? 1.0 / 64 : std::ldexp(1.0, -axis.bits); };
  const double unit = std::max(step(model.x), step(model.y));
  FlatTriangle triangle{};
  double nearest = INFINITY;
  for (int n = 0; n < kEdges; ++n) {
    const double sx = random.between(4, 11) + model.x.place, sy = random.between(4, 11) + model.y.place;
    double dx = random.between(1, 60) * unit, dy = random.between(1, 60) * unit;
    if ((dx < dy) != steep) std::swap(dx, dy);
    if (random.below(2) == 0) dx = -dx;
    if (random.below(2) == 0) dy = -dy;
    const double reach = std::max(std::abs(dx), std::abs(dy)), before = std::max(1.0, std::floor(2 / reach)),
                 behind = std::ceil((distance + kSize) / reach);
    const auto end = [&](double steps, double aside_x, double aside_y) {
      return Point{x.source(sx + steps * dx + aside_x * step(model.x), given),
                   y.source(sy + steps * dy + aside_y * step(model.y), given)};
    };
    const Point from = end(-before, 0, 0), to = end(behind, random.between(-2, 2), random.between(-2, 2));
    const long double ax = placed(from.x, model.x, kSize) - sx, ay = placed(from.y, model.y, kSize) - sy,
                      bx = placed(to.x, model.x, kSize) - sx, by = placed(to.y, model.y, kSize) - sy;
    const auto away = static_cast<double>(std::abs(ax * by - ay * bx) / std::hypot(bx - ax, by - ay));
    if (n > 0 && (away < beside || away >= nearest)) continue;
    triangle = {from, to, {}};
    nearest = away < beside ? INFINITY : away;
  }
  triangle[2] = {x.source(random.between(0, kSize), given), y.source(random.between(0, kSize), given)};
  return flat_scene(kSize, kSize, {seen(triangle, model.culled)});
}

// From which distance beyond the target on does it cut triangles (R9)? Where it does, the new vertex is moved to the grid, and
// the edge passes the sample on either side; of edges some times as long as the part that is left one in a few shows it. So
// it may do so from well before the distance that is found.
void infer_band(Rival& rival, const Expected& expected, std::vector<Probe>& all, Inference& result) {
  // On a coarse grid one edge in six that is cut far out shows it, and fewer that are cut near: what is first seen at some distance
  // may have begun at a thirty-second part of it.
  constexpr int kFarthest = 1 << 13, kEdges = 40, kTimes = 32;
  Random random(0xBA4D);
  // Less than an eighth of a step is what the step was found from wrongly, where that explains everything.
  const int bits = std::max(result.model.x.bits, result.model.y.bits);
  const double hair = std::ldexp(0.125, bits < 0 ? -16 : -bits);
  Model finer = result.model;
  finer.x.blur = std::max(finer.x.blur, hair), finer.y.blur = std::max(finer.y.blur, hair);
  // What blur and the owners of edges leave open says nothing; some edges pass through their sample, if there is no blur.
  const double blur = 2 * blur_of(result.model), least = std::max(blur, 0x1p-30);
  std::vector<Probe> probes;
  std::optional<double> band;  // from which distance on the model is wrong
  bool cuts = false;           // no hair explains that
  try {
    for (int distance = 2; distance <= kFarthest && !cuts; distance *= 2) {
      for (int n = 0; n < kEdges; ++n) {
        const corpus::Scene scene = reaching_scene(random, result.model, rival.position_step(), distance, n % 2 == 0,
                                                   n % 3 == 0 ? blur : least);
        probes.push_back({scene, rival.draw(scene, covering(rival))});
        if (wrong_samples(expected, result.model, probes.back()) == 0) continue;
        if (!band) band = distance <= 2 * kTimes ? 0 : distance / kTimes;
        cuts = cuts || wrong_samples(expected, finer, probes.back()) > 0;
      }
    }
  } catch (const Declined&) {
    // What it does not take says nothing of it.
  }
  if (!band) return;
  if (!cuts) {
    result.model = finer;
    return;
  }
  for (Model model : {result.model, finer}) {
    model.band = *band;
    const auto agrees = [&](const Probe& probe) { return wrong_samples(expected, model, probe) == 0; };
    if (!std::all_of(probes.begin(), probes.end(), agrees)) continue;
    result.model = model;
    all.insert(all.end(), probes.begin(), probes.end());  // a model without a band has to explain them, too
    return;
  }
}

// Blur until every probe agrees. Where edges go wrong by up to E pixels, a trial within E of its sample is answered
// wrongly once in four times, on the mean; none of thirty that are between E / 8 and E is, with a chance of 2 in 10,000: so
// what explains the trials is multiplied by 8.
void settle(const Expected& expected, const std::vector<Probe>& probes, Inference& result) {
  constexpr double kFinest = 0x1p-40;
  const auto blurred = [&result](double blur) {
    Model model = result.model;
    model.x.blur = std::max(model.x.blur, blur);
    model.y.blur = std::max(model.y.blur, blur);
    return model;
  };
  const auto agree = [&](const Model& model) {
    return std::all_of(probes.begin(), probes.end(),
                       [&](const Probe& probe) { return wrong_samples(expected, model, probe) == 0; });
  };
  for (double blur = 0; blur <= kMostBlur; blur = blur == 0 ? kFinest : 2 * blur) {
    if (blur > 0 && blur <= std::min(result.model.x.blur, result.model.y.blur)) continue;
    if (!agree(blurred(blur))) continue;
    result.model = blurred(std::min(8 * blur, kMostBlur));
    result.known = true;
    return;
  }
}

// Does the triangle meet the pixel's square, grown by `more` on each side?
bool meets(const FlatTriangle& t, int px, int py, double more) {
  const double x0 = px - more, y0 = py - more, x1 = px + 1 + more, y1 = py + 1 + more;
  const auto apart = [&](double a, double b) {
    double low = INFINITY, high = -INFINITY;
    for (const Point& p : t) low = std::min(low, a * p.x + b * p.y), high = std::max(high, a * p.x + b * p.y);
    const double near = std::min(a * x0, a * x1) + std::min(b * y0, b * y1);
    const double far = std::max(a * x0, a * x1) + std::max(b * y0, b * y1);
    return high < near || low > far;
  };
  bool separated = apart(1, 0) || apart(0, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = t[i], &q = t[(i + 1) % 3];
    separated = separated || apart(double{q.y} - p.y, double{p.x} - q.x);
  }
  return !separated;
}

// A few slanted triangles: are the pixels that they touch covered, and no others? Some 1/32 pixel around is let be.
std::string shape_of(Rival& rival, const Inference& found) {
  constexpr int kSize = 24, kTriangles = 12;
  constexpr double kHair = 1.0 / 32;
  if (turns_shape(found.turns, true) == turns_shape(found.turns, false)) return turns_shape(found.turns, true);
  Random random(0x70C4);
  int wrong = 0, all = 0;
  for (int n = 0; n < kTriangles; ++n) {
    FlatTriangle triangle{};
    for (Point& p : triangle) {
      p = {on_step(2 + 20 * random.unit(), rival.position_step()),
           on_step(2 + 20 * random.unit(), rival.position_step())};
    }
    const corpus::Scene scene = flat_scene(kSize, kSize, {seen(triangle, found.model.culled)});
    const corpus::Image image = rival.draw(scene, covering(rival));
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const bool inside = meets(triangle, x, y, -kHair), outside = !meets(triangle, x, y, kHair);
        if (!inside && !outside) continue;
        const bool covered = is_covered(image, static_cast<std::size_t>(y * kSize + x));
        all += inside || covered;
        wrong += covered != inside;
      }
    }
  }
  return turns_shape(found.turns, 50 * wrong <= all);
}

std::string tried_shape(Rival& rival, const Inference& found) {
  try {
    return shape_of(rival, found);
  } catch (const Declined&) {
    return turns_shape(found.turns, false);
  }
}

// No model is known: what holds under each is owed (R13), through a viewport of this size, and the facts stand.
void give_up(const Expected& expected, const std::vector<Probe>& probes, const std::string& why, const AxisFit& x,
             const AxisFit& y, Inference& result) {
  result.model = with_facts(least_known_model(), result.model);
  result.model.x.lacks = x.lacks;
  result.model.y.lacks = y.lacks;
  result.open.push_back("where samples are and how positions are rounded: " + why);
  for (const Probe& probe : probes) {
    if (wrong_samples(expected, result.model, probe) == 0) continue;
    result.problems.push_back(
        result.shape.empty() ? "edges in other directions than upright and level go by no model that explains those"
                             : result.shape + "; no place of samples explains slanted edges");
    return;
  }
}

// A rival that takes no vertex beside the target.
class OnTarget : public Rival {
 public:
  explicit OnTarget(Rival& rival) : rival_(rival) {}
  corpus::Outputs outputs() const override { return rival_.outputs(); }
  double position_step() const override { return rival_.position_step(); }
  corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) override {
    for (const corpus::SceneVertex& v : scene.draws[0].vertices) {
      const auto within = [&v](float at, int length) { return at >= 0 && at <= static_cast<float>(length) * v.w; };
      if (!within(v.x, scene.width) || !within(v.y, scene.height)) throw Declined("a vertex beside the target");
    }
    return rival_.draw(scene, wanted);
  }

 private:
  Rival& rival_;
};

Inference infer_as_drawn(Rival& rival, const Expected& expected, const std::optional<Model>& declared) {
  Inference result;
  result.model = least_known_model();
  infer_facts(rival, result);
  const Model facts = result.model;
  std::vector<Probe> probes;
  AxisFit x, y;
  try {
    result.turns = measure_turns(rival, facts.culled);
    std::vector<Turn> upright = of_axis(result.turns, 0), level = of_axis(result.turns, 1);
    for (std::vector<Turn>* turns : {&upright, &level}) {
      const std::vector<Turn> more = measure_more_turns(rival, facts.culled, turns == &upright ? 0 : 1);
      turns->insert(turns->end(), more.begin(), more.end());
    }
    x = fit_axis(rival, facts.culled, 0, upright, level, &result.offscreen);
    y = fit_axis(rival, facts.culled, 1, level, upright, &result.offscreen);
  } catch (const Declined& reason) {
    result.open.push_back(std::string("where edges turn: ") + reason.what());
    return result;
  }
  if (x.bits < 0 || y.bits < 0 || !x.why.empty() || !y.why.empty()) result.shape = tried_shape(rival, result);
  if (!x.why.empty() || !y.why.empty()) {
    const std::string problem = turns_problem(result.turns);
    if (!problem.empty()) result.problems.push_back(problem);
    give_up(expected, probes, x.why.empty() ? y.why + " in y" : x.why + " in x", x, y, result);
    return result;
  }
  try {
    const Region region = find_places(rival, facts.culled, x, y, probes);
    if (region.empty()) {
      result.shape = tried_shape(rival, result);
      give_up(expected, probes, "no place explains slanted edges", x, y, result);
      return result;
    }
    const auto declared_axis = [&declared](int axis) -> std::optional<AxisModel> {
      if (!declared) return std::nullopt;
      return axis == 0 ? declared->x : declared->y;
    };
    std::vector<Choice> xs = choices_of(x, region.low(0), region.high(0), declared_axis(0)),
                        ys = choices_of(y, region.low(1), region.high(1), declared_axis(1));
    // Doubled: so many roundings, spread evenly, are not all within half of their range.
    const double at_x = xs[0].axis.place - xs[0].shift, at_y = ys[0].axis.place - ys[0].shift;
    if (x.bits < 0) xs[0].axis.blur = std::max(xs[0].axis.blur, 2 * rounding_of(x, y, 0, at_x, at_y));
    if (y.bits < 0) ys[0].axis.blur = std::max(ys[0].axis.blur, 2 * rounding_of(y, x, 1, at_y, at_x));
    Model model;
    model.x = xs[0].axis;
    model.y = ys[0].axis;
    // Who owns samples on edges is not known yet.
    model.front.open = model.back.open = 0xFF;
    model.vertices = oracle::AtVertices::open;
    model = with_facts(model, facts);
    Chooser chooser(rival, expected, probes);
    const std::vector<Choice> left_x = chooser.choose(xs, 0, model, result.offscreen);
    model.x = left_x.front().axis;
    const std::vector<Choice> left_y = chooser.choose(ys, 1, model, result.offscreen);
    std::tie(model.x, model.y) = in_the_same_words(left_x, left_y);
    result.model = model;
  } catch (const Declined& reason) {
    give_up(expected, probes, reason.what(), x, y, result);
    return result;
  }
  try {
    infer_owners(rival, result);
  } catch (const Declined& reason) {
    result.open.push_back(std::string("who owns samples on edges: ") + reason.what());
    result.model.front.open = result.model.back.open = 0xFF;
  }
  try {
    infer_small(rival, result);
  } catch (const Declined& reason) {
    result.open.push_back(std::string("how small a triangle it draws: ") + reason.what());
  }
  const Inference whole = result;
  if (result.offscreen) infer_band(rival, expected, probes, result);
  draw_trials(rival, result, probes);
  settle(expected, probes, result);
  if (std::isfinite(result.model.band) && blur_of(result.model) > blur_of(whole.model)) {
    // What is blurred as much without a band has none.
    Inference blurred = whole;
    settle(expected, probes, blurred);
    if (blurred.known && blur_of(blurred.model) <= kClearer * blur_of(result.model)) result = blurred;
  }
  if (!result.known) result.shape = tried_shape(rival, result);
  if (!result.known) give_up(expected, probes, "what was found does not explain other triangles", x, y, result);
  return result;
}

// Does what is stated explain what probing looks at?
bool explains(Rival& rival, const Expected& expected, const Model& stated, const Model& found) {
  Inference trial;
  trial.model = with_facts(stated, found);
  trial.model.band = found.band;
  std::vector<Probe> probes;
  try {
    if (owners_are_seen(stated)) infer_owners(rival, trial);
    draw_trials(rival, trial, probes);
  } catch (const Declined&) {
    return false;
  }
  return may_be(stated, trial.model) && std::all_of(probes.begin(), probes.end(), [&](const Probe& probe) {
           return wrong_samples(expected, trial.model, probe) == 0;
         });
}

// Where what is stated may be what was found, it is that.
void take_stated(Rival& rival, const Expected& expected, const Model& stated, Inference& result) {
  // There edges turn at few places.
  const auto hard = [](const AxisModel& axis) { return axis.bits == 0 || axis.bits == 1 || axis.bits == 16; };
  const bool may = result.known && may_be(in_plain_words(stated), in_plain_words(result.model));
  if ((!may && !hard(stated.x) && !hard(stated.y)) || !explains(rival, expected, stated, result.model)) return;
  const double band = result.model.band;
  result.model = with_facts(stated, result.model);
  result.model.band = band;
  if (!may) result.problems.clear();
  result.known = true;
}

// The better one of what is found as it comes, and of what is found on the target alone.
Inference infer_somewhere(Rival& rival, const Expected& expected, const std::optional<Model>& declared,
                          const Inference& result) {
  const bool plain = result.known && result.problems.empty() && result.model.x.blur == 0 && result.model.y.blur == 0;
  if (plain || !result.offscreen) return result;
  // What cuts triangles near the target shows other edges than those that are asked for, wherever a vertex lies beside it.
  OnTarget on_target(rival);
  Inference inner = infer_as_drawn(on_target, expected, declared);
  const bool clearer = !result.known || kClearer * blur_of(inner.model) <= blur_of(result.model);
  if (!inner.known || !inner.problems.empty() || !clearer) return result;
  std::vector<Probe> probes;
  infer_band(rival, expected, probes, inner);
  if (!std::isfinite(inner.model.band)) return result;
  inner.offscreen = true;
  return inner;
}

}  // namespace

Model least_known_model() {
  Model model;
  model.x.blur = model.y.blur = 1 + 3 * kMostBlur;  // of the place, of t, and r
  model.front.open = model.back.open = 0xFF;
  model.vertices = oracle::AtVertices::open;
  model.lines.thin = model.lines.wide = oracle::LineShape::unknown;
  model.points.known = false;
  return model;
}

Inference infer(Rival& rival, const Expected& expected, const std::optional<Model>& declared) {
  if (!kAsksAll || !declared) {
    return infer_somewhere(rival, expected, declared, infer_as_drawn(rival, expected, declared));
  }
  const Model plain = in_plain_words(*declared);
  const auto is_it = [&](Inference& found) {
    if (found.known && differences(*declared, found.model).empty()) return true;
    take_stated(rival, expected, *declared, found);
    return found.known && differences(*declared, found.model).empty();
  };
  Inference result = infer_as_drawn(rival, expected, plain);
  if (is_it(result)) return result;
  result = infer_somewhere(rival, expected, plain, result);
  is_it(result);
  return result;
}

}  // namespace surefill::judge
