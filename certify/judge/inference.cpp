// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/inference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "certify/judge/facts.hpp"
#include "certify/judge/words.hpp"

namespace surefill::judge {

namespace {

using oracle::AxisModel;
using oracle::Owners;
using oracle::Rounding;
using oracle::Side;

constexpr double kMostBlur = 1.0 / 16;  // R13: what is blurred more is not known
constexpr double kLeastBlur = 0x1p-24;
constexpr double kUsualBlur = 0x1p-15;

// splitmix64: the probes are the same wherever they run.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }

 private:
  std::uint64_t state_;
};

// R5 in double, which holds all these numbers exactly.
double snapped(double position, const AxisModel& axis) {
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

// An axis of a model with who owns samples on upright (level) edges, and the blur that explains its turns.
struct Candidate {
  AxisModel axis;
  bool owns_near = false, owns_far = false;
  double blur = 0;
  int oddity = 0;  // how far from what is usual
};

bool covers(const Candidate& c, double edge, const Turn& turn) {
  const double q = edge * (kTurnLength - c.axis.lacks) / kTurnLength;
  const double position = snapped(q, c.axis), sample = turn.pixel + c.axis.place;
  if (position == sample) return turn.far ? c.owns_far : c.owns_near;
  return turn.far ? position > sample : position < sample;
}

bool explains(const Candidate& c, const Turn& turn, double blur) {
  if (!turn.found) return true;
  const double inwards = turn.far ? blur : -blur;
  return blur >= turn.spread && covers(c, turn.covered + inwards, turn) && !covers(c, turn.uncovered - inwards, turn);
}

// The least of 0, 2^-24, 2^-23, ... that explains all turns; more than kMostBlur if none does.
double blur_of(const Candidate& c, const std::vector<Turn>& turns) {
  double blur = 0;
  for (const Turn& turn : turns) {
    while (blur <= kMostBlur && !explains(c, turn, blur)) blur = blur == 0 ? kLeastBlur : 2 * blur;
  }
  return blur;
}

std::vector<Turn> of_axis(const std::vector<Turn>& turns, int axis) {
  std::vector<Turn> part;
  std::copy_if(turns.begin(), turns.end(), std::back_inserter(part), [axis](const Turn& t) { return t.axis == axis; });
  return part;
}

// Least squares over the far or near turns: how much further the edge stands at each next pixel.
double lacking(const std::vector<Turn>& turns) {
  double slope = 0;
  int sides = 0;
  for (const bool far : {false, true}) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Turn& t : turns) {
      if (!t.found || t.far != far) continue;
      n += 1, x += t.pixel, y += t.at(), xx += t.pixel * t.pixel, xy += t.pixel * t.at();
    }
    if (n < 3) continue;
    slope += (n * xy - x * y) / (n * xx - x * x);
    ++sides;
  }
  if (sides == 0) return 0;
  slope /= sides;
  const double lacks = kTurnLength * slope / (1 + slope);
  if (std::abs(lacks) < 0x1p-12) return 0;
  return std::nearbyint(lacks * 4096) / 4096;
}

// The candidates of one axis that explain its turns with the least blur, the usual ones first.
std::vector<Candidate> candidates_of(const std::vector<Turn>& turns) {
  std::vector<Candidate> all;
  double middle = 0, found = 0;
  for (const Turn& t : turns) found += t.found ? 1 : 0;
  if (found == 0) return {};
  const double lacks = lacking(turns);
  middle = 0;
  for (const Turn& t : turns) {
    if (t.found) middle += (t.at() + t.pixel + 0.5) * (kTurnLength - lacks) / kTurnLength - t.pixel - 0.5;
  }
  const auto try_one = [&](Candidate c) {
    c.axis.lacks = lacks;
    for (const unsigned owners : {1u, 2u, 0u, 3u}) {
      c.owns_near = owners & 1u;
      c.owns_far = owners & 2u;
      c.blur = blur_of(c, turns);
      if (c.blur <= kMostBlur) all.push_back(c);
    }
  };
  constexpr Rounding kRoundings[] = {Rounding::nearest_even, Rounding::nearest_up, Rounding::nearest_away,
                                     Rounding::nearest_down, Rounding::floor,      Rounding::truncate,
                                     Rounding::ceiling};
  const auto with_grids = [&](double place, int oddity) {
    Candidate c;
    c.axis.place = place;
    c.oddity = oddity;
    try_one(c);
    for (int bits = 16; bits >= 0; --bits) {
      for (const Rounding rounding : kRoundings) {
        c.axis.bits = bits;
        c.axis.rounding = rounding;
        c.oddity = oddity + 1 + static_cast<int>(rounding >= Rounding::truncate);
        try_one(c);
      }
    }
  };
  with_grids(0.5, 0);
  for (const double place : {0.0, 1.0}) with_grids(place, 4);
  for (int sixteenth = -8; sixteenth <= 24; ++sixteenth) {
    if (sixteenth != 8 && sixteenth != 0 && sixteenth != 16) with_grids(sixteenth / 16.0, 8);
  }
  for (int bits = 0; bits <= 12; ++bits) {
    for (int offset = 1; offset < 16; ++offset) {
      for (const Rounding rounding : {Rounding::nearest_even, Rounding::nearest_up, Rounding::truncate}) {
        Candidate c;
        c.axis.bits = bits;
        c.axis.rounding = rounding;
        c.axis.grid_offset = std::ldexp(offset, -bits - 4);
        c.oddity = 10;
        try_one(c);
      }
    }
  }
  // Between two positions of a grid, of which the turn is the upper one where positions go down, and so on.
  const double turn = 0.5 + middle / found;
  with_grids(turn, 12);
  for (int bits = 12; bits >= 0; --bits) {
    for (const Rounding rounding : {Rounding::floor, Rounding::truncate, Rounding::ceiling}) {
      Candidate c;
      c.axis.place = turn + std::ldexp(rounding == Rounding::ceiling ? 0.5 : -0.5, -bits);
      c.axis.bits = bits;
      c.axis.rounding = rounding;
      c.oddity = 13;
      try_one(c);
    }
  }
  double least = 1;
  for (const Candidate& c : all) least = std::min(least, c.blur);
  // Rounding on the way moves all turns alike, so a little blur is no reason to leave out what is usual.
  std::erase_if(all, [least](const Candidate& c) { return c.blur > std::max(4 * least, kUsualBlur); });
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple(a.blur > kUsualBlur, a.oddity, a.blur) < std::tuple(b.blur > kUsualBlur, b.oddity, b.blur);
  });
  return all;
}

Model model_of(const Candidate& x, const Candidate& y) {
  Model model;
  model.x = x.axis;
  model.y = y.axis;
  model.x.blur = x.blur;
  model.y.blur = y.blur;
  // Snapped positions tell between which two of them a sample lies, and no more.
  for (AxisModel* axis : {&model.x, &model.y}) {
    if (axis->bits < 0 || snapped(axis->place, *axis) == axis->place) continue;
    axis->place_within = std::ldexp(0.5, -axis->bits);
    axis->place = std::ldexp(std::floor(std::ldexp(axis->place - axis->grid_offset, axis->bits)) + 0.5, -axis->bits) +
                  axis->grid_offset;
  }
  // Who owns an edge may change with the facing or the order of vertices, which the turns do not show.
  model.front.open = model.back.open = 0xFF;
  model.vertices = oracle::AtVertices::open;
  return model;
}

bool like(const AxisModel& a, const AxisModel& b) {
  return a.place == b.place && a.bits == b.bits && a.rounding == b.rounding && a.grid_offset == b.grid_offset;
}

// Candidates that differ in owners alone are one model here.
void add_model(std::vector<Model>& models, const Candidate& x, const Candidate& y) {
  const Model model = model_of(x, y);
  if (std::find(models.begin(), models.end(), model) == models.end()) models.push_back(model);
}

bool same_steps(const AxisModel& a, const AxisModel& b) {
  return a.place == b.place && a.bits == b.bits && a.grid_offset == b.grid_offset;
}

// Of candidates that differ in rounding and owners alone, the first two.
std::vector<Candidate> thinned(const std::vector<Candidate>& all, std::size_t most) {
  std::vector<Candidate> kept;
  for (const Candidate& c : all) {
    const auto alike =
        std::count_if(kept.begin(), kept.end(), [&c](const Candidate& k) { return same_steps(k.axis, c.axis); });
    const bool there = std::any_of(kept.begin(), kept.end(), [&c](const Candidate& k) { return k.axis == c.axis; });
    if (!there && alike < 2 && kept.size() < most) kept.push_back(c);
  }
  return kept;
}

// Pairs alike in both axes first, for most rasterizers do not tell x from y; then all others of the first of each axis.
std::vector<Model> pairs_of(const std::vector<Candidate>& xs, const std::vector<Candidate>& ys, std::size_t first) {
  constexpr std::size_t kMostOfAxis = 48;
  const std::vector<Candidate> some_x = thinned(xs, kMostOfAxis), some_y = thinned(ys, kMostOfAxis);
  std::vector<Model> models;
  for (const Candidate& x : some_x) {
    for (const Candidate& y : some_y) {
      if (same_steps(x.axis, y.axis)) add_model(models, x, y);
    }
  }
  for (std::size_t i = 0; i < std::min(some_x.size(), first); ++i) {
    for (std::size_t k = 0; k < std::min(some_y.size(), first); ++k) {
      if (!same_steps(some_x[i].axis, some_y[k].axis)) add_model(models, some_x[i], some_y[k]);
    }
  }
  return models;
}

// The same steps as the model, by every rounding, with all owners that explain the turns.
std::vector<Model> variants_of(const Model& model, const std::vector<Candidate>& xs, const std::vector<Candidate>& ys) {
  const auto fits = [](const AxisModel& a, const Candidate& c) {
    return a.bits == c.axis.bits && a.grid_offset == c.axis.grid_offset &&
           (a.place == c.axis.place || a.place_within > 0);
  };
  std::vector<Model> models;
  for (const bool alike : {true, false}) {
    for (const Candidate& x : xs) {
      for (const Candidate& y : ys) {
        if (!fits(model.x, x) || !fits(model.y, y) || (x.axis.rounding == y.axis.rounding) != alike) continue;
        if (models.size() < 60) add_model(models, x, y);
      }
    }
  }
  return models;
}

// --- slanted edges

std::array<Vertex, 3> triangle_of(const corpus::Scene& scene, std::size_t t) {
  std::array<Vertex, 3> triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const corpus::SceneVertex& v = scene.draws[0].vertices[scene.draws[0].triangles[t].vertices[i]];
    triangle[i] = {v.x, v.y, v.z, v.w};
  }
  return triangle;
}

// Slanted edges, each a triangle of its own image, so that any output shows it.
struct Slanted {
  corpus::Scene scene;
  corpus::Image image;
};

// Samples that the model decides otherwise than the image, and how many it decides.
struct Score {
  std::uint64_t wrong = 0, judged = 0;
  void add(const Score& other) { wrong += other.wrong, judged += other.judged; }
};

Score score_of(const Expected& expected, const Model& model, const Slanted& probe) {
  Score score;
  const std::vector<Cover> answers =
      expected.cover(model, probe.scene.width, probe.scene.height, 1, triangle_of(probe.scene, 0));
  for (std::size_t s = 0; s < answers.size(); ++s) {
    if (answers[s] == Cover::open) continue;
    ++score.judged;
    if ((answers[s] == Cover::yes) != is_covered(probe.image, s)) ++score.wrong;
  }
  return score;
}

// A triangle over 8 x 8 pixels: between the positions of the finest grid, or halfway between two of a candidate's; every
// other one has an edge that passes a sample so closely that snapping its ends decides.
std::array<Point, 3> slanted_triangle(Random& random, const Model& model, double step, bool offscreen, int number) {
  std::array<Point, 3> triangle{};
  const int low = offscreen && number % 4 == 3 ? -8 : 0, high = offscreen && number % 4 == 3 ? 16 : 8;
  const auto coordinate = [&](const AxisModel& axis) {
    const bool halfway = number % 3 != 0 && axis.bits >= 0;
    if (!halfway) return std::ldexp(random.between(low << 16, high << 16), -16);
    const double steps = random.between(low << axis.bits, (high << axis.bits) - 1);
    return std::ldexp(steps + 0.5, -axis.bits) + axis.grid_offset;
  };
  for (Point& p : triangle) {
    p.x = static_cast<float>(coordinate(model.x));
    p.y = static_cast<float>(coordinate(model.y));
  }
  if (number % 2 == 0) {
    const double x = std::floor(triangle[2].x) + model.x.place, y = std::floor(triangle[2].y) + model.y.place;
    const Point across{static_cast<float>(2 * x - triangle[0].x), static_cast<float>(2 * y - triangle[0].y)};
    if (offscreen || (across.x >= 0 && across.y >= 0 && across.x <= 8 && across.y <= 8)) triangle[1] = across;
  }
  if (step != 0) {
    for (Point& p : triangle) {
      p.x = static_cast<float>(std::nearbyint(p.x / step) * step);
      p.y = static_cast<float>(std::nearbyint(p.y / step) * step);
    }
  }
  return triangle;
}

// Draws slanted triangles.
class Prober {
 public:
  Prober(Rival& rival, const Expected& expected) : rival_(rival), expected_(expected), wanted_(rival.outputs()) {
    wanted_.barycentrics = wanted_.attributes = false;
    if (wanted_.count) wanted_.index = wanted_.depth = false;
  }

  bool offscreen() const { return offscreen_; }
  const std::vector<Slanted>& probes() const { return probes_; }

  // Nothing where the rival declines, which it does for what lies beside the target.
  const Slanted* draw(const Model& aimed, int number) {
    return draw(flat_scene(8, 8, {slanted_triangle(random_, aimed, rival_.position_step(), offscreen_, number)}));
  }

  // One of which the two models say different things, or one of them nothing, if there is one among some random ones.
  const Slanted* draw_between(const Model& a, const Model& b) {
    constexpr int kTries = 150;
    for (int n = 0; n < kTries; ++n) {
      const auto triangle = slanted_triangle(random_, n % 2 == 0 ? a : b, rival_.position_step(), offscreen_, n);
      const corpus::Scene scene = flat_scene(8, 8, {triangle});
      const std::vector<Cover> x = expected_.cover(a, 8, 8, 1, triangle_of(scene, 0)),
                               y = expected_.cover(b, 8, 8, 1, triangle_of(scene, 0));
      for (std::size_t s = 0; s < x.size(); ++s) {
        if (x[s] != y[s]) {
          if (const Slanted* probe = draw(scene)) return probe;
          break;
        }
      }
    }
    return nullptr;
  }

 private:
  const Slanted* draw(corpus::Scene scene) {
    try {
      corpus::Image image = rival_.draw(scene, wanted_);
      probes_.push_back({std::move(scene), std::move(image)});
      return &probes_.back();
    } catch (const Declined&) {
      offscreen_ = false;
      return nullptr;
    }
  }

  Rival& rival_;
  const Expected& expected_;
  corpus::Outputs wanted_;
  Random random_{0x5EED};
  bool offscreen_ = true;
  std::vector<Slanted> probes_;
};

// Of the candidates, which are in order of what is usual, the one that explains the probes; of equals the one with less
// blur, the declared one, the first. Those that random probes do not tell apart meet each other on probes that do.
Model best_of(Prober& prober, const Expected& expected, std::vector<Model> candidates,
              const std::optional<Model>& declared, int probes) {
  constexpr int kMeetings = 100;
  std::vector<std::uint64_t> wrong(candidates.size(), 0);
  Random random(0xA1D);
  for (int n = 0; n < probes; ++n) {
    const Model aimed = candidates[static_cast<std::size_t>(random.below(static_cast<int>(candidates.size())))];
    const Slanted* probe = prober.draw(aimed, n);
    if (!probe) continue;
    std::uint64_t least = ~std::uint64_t{0};
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      wrong[c] += score_of(expected, candidates[c], *probe).wrong;
      least = std::min(least, wrong[c]);
    }
    std::size_t kept = 0;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      if (wrong[c] > least + least / 2 + 2) continue;
      candidates[kept] = candidates[c];
      wrong[kept++] = wrong[c];
    }
    candidates.resize(kept);
    wrong.resize(kept);
  }
  const auto is_declared = [&declared](const Model& m) {
    return declared && like(declared->x, m.x) && like(declared->y, m.y);
  };
  const auto rank = [&](std::size_t n) {
    const Model& m = candidates[n];
    return std::tuple(wrong[n], std::max({m.x.blur, m.y.blur, m.x.place_within, m.y.place_within}), !is_declared(m), n);
  };
  const auto first = [&] {
    std::size_t best = 0;
    for (std::size_t c = 1; c < candidates.size(); ++c) {
      if (rank(c) < rank(best)) best = c;
    }
    return best;
  };
  // The first one meets every other; whoever is refuted on the way, by any probe, falls behind.
  std::size_t best = first();
  std::vector<bool> met(candidates.size(), false);
  int meetings = 0;
  for (bool changed = true; changed && meetings < kMeetings;) {
    changed = false;
    for (std::size_t c = 0; c < candidates.size() && !changed && meetings < kMeetings; ++c) {
      if (c == best || met[c] || wrong[c] > wrong[best]) continue;
      met[c] = true;
      ++meetings;
      for (int n = 0; n < 4 && wrong[c] == wrong[best]; ++n) {
        const Slanted* probe = prober.draw_between(candidates[best], candidates[c]);
        if (!probe) break;
        for (std::size_t k = 0; k < candidates.size(); ++k) {
          wrong[k] += score_of(expected, candidates[k], *probe).wrong;
        }
      }
      const std::size_t now = first();
      if (now == best) continue;
      best = now;
      met.assign(candidates.size(), false);
      changed = true;
    }
  }
  return candidates[best];
}

// --- owners

// A triangle on a lattice around a sample, in the middle of 8 x 8 pixels: points are whole pixels from the sample.
using Lattice = std::array<std::array<int, 2>, 3>;

// What comes to lie at this position of a target of `length` pixels, in the middle of what is snapped there.
float source_of(double position, const AxisModel& axis, int length) {
  double q = position - axis.moved;
  if (axis.bits >= 0 && axis.rounding == Rounding::ceiling) q -= std::ldexp(0.5, -axis.bits);
  if (axis.bits >= 0 && (axis.rounding == Rounding::floor || axis.rounding == Rounding::truncate)) {
    q += std::ldexp(0.5, -axis.bits);
  }
  return static_cast<float>(q * length / (length - axis.lacks));
}

constexpr int kLatticeSize = 8;

bool covers_middle(Rival& rival, const Model& model, const std::array<std::array<double, 2>, 3>& from_sample) {
  std::array<Point, 3> triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    triangle[i] = {source_of(3 + model.x.place + from_sample[i][0], model.x, kLatticeSize),
                   source_of(3 + model.y.place + from_sample[i][1], model.y, kLatticeSize)};
    if (const double step = rival.position_step(); step != 0) {
      triangle[i].x = static_cast<float>(std::nearbyint(triangle[i].x / step) * step);
      triangle[i].y = static_cast<float>(std::nearbyint(triangle[i].y / step) * step);
    }
  }
  corpus::Outputs wanted = rival.outputs();
  wanted.barycentrics = wanted.attributes = false;
  const corpus::Image image = rival.draw(flat_scene(kLatticeSize, kLatticeSize, {triangle}), wanted);
  return is_covered(image, 3 * kLatticeSize + 3);
}

bool lattice_covers(Rival& rival, const Model& model, const Lattice& lattice) {
  std::array<std::array<double, 2>, 3> points{};
  for (std::size_t i = 0; i < 3; ++i) {
    points[i] = {static_cast<double>(lattice[i][0]), static_cast<double>(lattice[i][1])};
  }
  return covers_middle(rival, model, points);
}

int cross(const std::array<int, 2>& p, const std::array<int, 2>& q) {
  return p[0] * q[1] - p[1] * q[0];
}

// The side on which the edge from p to q is of a triangle whose third vertex is r.
Side lattice_side(const std::array<int, 2>& p, const std::array<int, 2>& q, const std::array<int, 2>& r) {
  int x = p[1] - q[1], y = q[0] - p[0];
  if (x * (r[0] - p[0]) + y * (r[1] - p[1]) < 0) x = -x, y = -y;
  if (y == 0) return x > 0 ? Side::left : Side::right;
  if (x == 0) return y > 0 ? Side::top : Side::bottom;
  if (y > 0) return x > 0 ? Side::top_left : Side::top_right;
  return x > 0 ? Side::bottom_left : Side::bottom_right;
}

// Edges of every side through a sample, of both facings, from each vertex on; and vertices on it.
void infer_owners(Rival& rival, Inference& result) {
  Model& model = result.model;
  const auto between = [](const AxisModel& axis) { return axis.place_within > 0; };
  const auto unseen = [](const AxisModel& axis) { return axis.bits < 0 && axis.lacks != 0; };
  // No vertex, or none that is known, comes to lie on a sample.
  if (between(model.x) || between(model.y) || unseen(model.x) || unseen(model.y)) {
    model.front.open = model.back.open = 0xFF;
    return;
  }
  constexpr std::array<std::array<int, 2>, 8> kDirections{
      {{0, 2}, {2, 0}, {1, 1}, {1, -1}, {1, 2}, {2, 1}, {2, -1}, {1, -2}}};
  std::array<std::array<std::array<int, 2>, 8>, 2> votes{};  // facing, side: {not covered, covered}
  for (const auto& d : kDirections) {
    for (const int hand : {1, -1}) {
      // p and q on opposite sides of the sample; r to one side of both.
      const std::array<int, 2> p{-d[0], -d[1]}, q{d[0], d[1]}, r{-hand * d[1], hand * d[0]};
      for (std::size_t first = 0; first < 3; ++first) {
        for (const bool swap : {false, true}) {
          Lattice t{p, q, r};
          std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(first), t.end());
          if (swap) std::swap(t[1], t[2]);
          const std::array<int, 2> u{t[1][0] - t[0][0], t[1][1] - t[0][1]}, v{t[2][0] - t[0][0], t[2][1] - t[0][1]};
          const bool front = cross(u, v) > 0;
          if (model.culled != Cull::none && (model.culled == Cull::front) == front) continue;
          const auto side = static_cast<std::size_t>(lattice_side(p, q, r));
          ++votes[front ? 0 : 1][side][lattice_covers(rival, model, t) ? 1 : 0];
        }
      }
    }
  }
  for (const std::size_t facing : {0u, 1u}) {
    Owners owners;
    for (std::size_t side = 0; side < 8; ++side) {
      const auto mask = static_cast<std::uint8_t>(1u << side);
      if (votes[facing][side][0] > 0 && votes[facing][side][1] > 0) owners.open |= mask;
      if (votes[facing][side][1] > 0) owners.owned |= mask;
    }
    (facing == 0 ? model.front : model.back) = owners;
  }
  if (model.culled == Cull::front) model.front = model.back;
  if (model.culled == Cull::back) model.back = model.front;
  // Corners at the sample: is each covered as its edges say?
  int as_edges = 0, covered = 0, all = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      const std::array<int, 2> p{kDirections[i][0], kDirections[i][1]},
          q{i % 2 == 0 ? -kDirections[j][0] : kDirections[j][0], i % 2 == 0 ? -kDirections[j][1] : kDirections[j][1]};
      const int turn = cross(p, q);
      const bool front = turn > 0;
      if (turn == 0 || (model.culled != Cull::none && (model.culled == Cull::front) == front)) continue;
      const Owners& owners = front ? model.front : model.back;
      const std::uint8_t a = bit(lattice_side({0, 0}, p, q)), b = bit(lattice_side({0, 0}, q, p));
      if (owners.open & (a | b)) continue;
      const bool wanted = (owners.owned & a) && (owners.owned & b);
      const bool got = lattice_covers(rival, model, {std::array<int, 2>{0, 0}, p, q});
      ++all;
      if (got == wanted) ++as_edges;
      if (got) ++covered;
    }
  }
  model.vertices = as_edges == all  ? oracle::AtVertices::as_edges
                   : covered == all ? oracle::AtVertices::covered
                   : covered == 0   ? oracle::AtVertices::not_covered
                                    : oracle::AtVertices::open;
}

// R8: small triangles around a sample, down to a step of the grid: what is the smallest that is drawn?
void infer_small(Rival& rival, Inference& result) {
  Model& model = result.model;
  const int finest = std::min({12, model.x.bits < 0 ? 12 : model.x.bits, model.y.bits < 0 ? 12 : model.y.bits});
  double drawn = 0;
  for (int k = 1; k <= finest; ++k) {
    const double s = std::ldexp(1.0, -k);
    if (s < 8 * std::max(model.x.blur, model.y.blur)) return;
    std::array<std::array<double, 2>, 3> t{{{-s, -s}, {2 * s, -s}, {-s, 2 * s}}};
    if (model.culled == Cull::front) std::swap(t[1], t[2]);
    if (!covers_middle(rival, model, t)) {
      model.least_area = 1.1 * drawn;
      return;
    }
    drawn = 4.5 * s * s;
  }
}

// Blur until every probe agrees.
void settle(const Expected& expected, const std::vector<Slanted>& probes, Inference& result) {
  for (double blur = std::max(result.model.x.blur, result.model.y.blur); blur <= kMostBlur;
       blur = blur == 0 ? kLeastBlur : 2 * blur) {
    Model model = result.model;
    model.x.blur = std::max(model.x.blur, blur);
    model.y.blur = std::max(model.y.blur, blur);
    Score score;
    for (const Slanted& probe : probes) score.add(score_of(expected, model, probe));
    if (score.wrong > 0) continue;
    result.model = model;
    result.known = true;
    return;
  }
  result.problems.push_back("edges in other directions than upright and level go by no model that explains those");
}

}  // namespace

Model least_known_model() {
  Model model;
  model.x.blur = model.y.blur = 0.5 + 2 * kMostBlur;
  model.front.open = model.back.open = 0xFF;
  model.vertices = oracle::AtVertices::open;
  return model;
}

Inference infer(Rival& rival, const Expected& expected, const std::optional<Model>& declared) {
  Inference result;
  result.model = least_known_model();
  infer_facts(rival, result);
  try {
    result.turns = measure_turns(rival, result.model.culled);
  } catch (const Declined& reason) {
    result.open.push_back(std::string("where edges turn: ") + reason.what());
    return result;
  }
  const std::vector<Candidate> xs = candidates_of(of_axis(result.turns, 0)),
                               ys = candidates_of(of_axis(result.turns, 1));
  if (xs.empty() || ys.empty()) {
    result.problems.push_back(turns_problem(result.turns));
    return result;
  }
  Prober prober(rival, expected);
  const Model facts = result.model;
  std::vector<Model> champions;
  const auto choose = [&](std::vector<Model> candidates, int probes) {
    for (Model& candidate : candidates) candidate = with_facts(candidate, facts);
    champions.push_back(best_of(prober, expected, std::move(candidates), declared, probes));
    result.model = champions.back();
  };
  choose(pairs_of(xs, ys, 6), 64);
  Score score;
  for (const Slanted& probe : prober.probes()) score.add(score_of(expected, result.model, probe));
  if (score.wrong > 0 || result.model.x.place_within > 0 || result.model.y.place_within > 0) {
    choose(pairs_of(xs, ys, 36), 96);
  }
  const std::vector<Model> variants = variants_of(result.model, xs, ys);
  if (variants.size() > 1) choose(variants, 24);
  // Of the models that won, the first that explains most of all probes.
  std::uint64_t least = ~std::uint64_t{0};
  for (const Model& champion : champions) {
    Score all;
    for (const Slanted& probe : prober.probes()) all.add(score_of(expected, champion, probe));
    if (all.wrong < least) result.model = champion, least = all.wrong;
  }
  // What rounds on the way is not known to the last bit, and through a viewport of another size nor are ties.
  for (AxisModel* axis : {&result.model.x, &result.model.y}) {
    if (axis->lacks != 0) axis->blur = std::max(axis->blur, kLeastBlur);
    if (axis->blur > 0) axis->blur = std::min(kMostBlur, std::max(8 * axis->blur, 0x1p-16));
  }
  result.offscreen = prober.offscreen();
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
  settle(expected, prober.probes(), result);
  return result;
}

}  // namespace surefill::judge
