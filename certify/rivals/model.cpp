// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "corpus/names.hpp"
#include "corpus/scene.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::adapters {

namespace {

using corpus::Scene;

struct Point {
  float x, y;
};

// To a multiple of 2^-18, so that both forms of a vertex on a target of up to 32 pixels are exact (a power of two wide,
// clip space is X/16 - 1 or finer) and no probe has another rounding than the rival's.
float probe_coordinate(float value) {
  return static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(static_cast<double>(value), 18)), -18));
}

// Triangles in front of the eye, W = 1, all at one depth.
Scene flat_scene(int width, int height, const std::vector<std::array<Point, 3>>& triangles, float z = 0.5f) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    for (const Point& p : triangle) draw.vertices.push_back({probe_coordinate(p.x), probe_coordinate(p.y), z, 1, {}});
    draw.triangles.push_back({{first, first + 1, first + 2}, std::nullopt});
  }
  return scene;
}

std::vector<std::uint32_t> counts_of(Rival& rival, const Scene& scene) {
  corpus::Frame frame(scene, {true, false, false, false, false});
  rival.draw(frame.target(), frame.draws());
  return frame.image().count;
}

std::vector<std::uint32_t> exact_counts(Scene scene, FillRule rule, const std::optional<Grid>& grid) {
  scene.draws[0].fill_rule = rule;
  scene.draws[0].grid = grid;
  corpus::Frame frame(scene, {true, false, false, false, false});
  oracle::render(frame.target(), frame.draws());
  return frame.image().count;
}

// Two triangles over the upper half of 4 x 4 pixels.
bool infer_rows(Rival& rival, Inference& result) {
  const Scene half = flat_scene(4, 4, {{{{-1, -1}, {5, -1}, {-1, 2}}}, {{{5, -1}, {5, 2}, {-1, 2}}}});
  const std::vector<std::uint32_t> counts = counts_of(rival, half);
  const auto all = [&counts](std::size_t begin, std::uint32_t wanted) {
    const auto first = counts.begin() + static_cast<std::ptrdiff_t>(begin);
    return std::all_of(first, first + 8, [wanted](std::uint32_t n) { return (n > 0) == (wanted > 0); });
  };
  const bool as_declared = all(0, 1) && all(8, 0), turned = all(0, 0) && all(8, 1);
  if (!as_declared && !turned) {
    result.problems.push_back("a rectangle over the upper half of 4 x 4 pixels does not cover that half");
    return false;
  }
  if (turned) {
    result.model.y = result.model.y == SUREFILL_ADAPTER_Y_UP ? SUREFILL_ADAPTER_Y_DOWN : SUREFILL_ADAPTER_Y_UP;
  }
  return true;
}

// One depth all over the target: what comes back says what range it has been taken for.
void infer_depth_range(Rival& rival, Inference& result) {
  if (!(rival.info().outputs & SUREFILL_ADAPTER_DEPTH)) return;
  std::array<float, 2> found{};
  const std::array<float, 2> drawn{0.25f, 0.75f};
  for (std::size_t n = 0; n < 2; ++n) {
    const Scene scene = flat_scene(2, 2, {{{{-9, -9}, {9, -9}, {0, 9}}}}, drawn[n]);
    corpus::Frame frame(scene, {false, false, true, false, false});
    rival.draw(frame.target(), frame.draws());
    found[n] = frame.image().depth[0];
  }
  // No model has depths that are off by this much.
  const auto is = [&found](float a, float b) {
    return std::abs(found[0] - a) < 0.01f && std::abs(found[1] - b) < 0.01f;
  };
  if (is(0.25f, 0.75f)) return;
  const bool minus_one = result.model.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
  if (is(0.625f, 0.875f) && !minus_one && rival.info().form == SUREFILL_ADAPTER_FORM_CLIP) {
    result.model.depth_range = SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
  } else {
    result.problems.push_back(
        fmt::format("triangles of depth 0.25 and 0.75 have depth {:.9g} and {:.9g}", found[0], found[1]));
  }
}

// The four triangles around a sample whose outer edges pass samples, too, each drawn alone; and edges of other slopes.
std::vector<Scene> fill_rule_scenes() {
  std::vector<Scene> scenes;
  const std::array<Point, 4> corners{{{1.5f, 1.5f}, {6.5f, 1.5f}, {6.5f, 6.5f}, {1.5f, 6.5f}}};
  for (std::size_t n = 0; n < 4; ++n) {
    scenes.push_back(flat_scene(8, 8, {{corners[n], corners[(n + 1) % 4], {3.5f, 3.5f}}}));
    scenes.push_back(flat_scene(8, 8, {{corners[(n + 1) % 4], corners[n], {4.5f, 4.5f}}}));
    scenes.push_back(flat_scene(8, 8, {{corners[n], corners[(n + 1) % 4], corners[(n + 2) % 4]}}));
  }
  return scenes;
}

// A rule under which all of them come out, without a grid (every grid of a bit or more holds half pixels) or with whole
// pixels.
bool infer_fill_rule(Rival& rival, Inference& result) {
  const std::vector<Scene> scenes = fill_rule_scenes();
  std::vector<std::vector<std::uint32_t>> found;
  for (const Scene& scene : scenes) found.push_back(counts_of(rival, scene));
  std::vector<std::optional<Grid>> grids{std::nullopt};
  for (int rounding = 0; rounding < 3; ++rounding) grids.push_back(Grid{0, 0, 0, static_cast<GridRounding>(rounding)});
  for (const auto& grid : grids) {
    for (int rule = 0; rule < 8; ++rule) {
      bool fits = true;
      for (std::size_t n = 0; n < scenes.size() && fits; ++n) {
        fits = found[n] == exact_counts(scenes[n], static_cast<FillRule>(rule), grid);
      }
      if (!fits) continue;
      result.model.kind = grid ? SUREFILL_ADAPTER_MODEL_GRID : SUREFILL_ADAPTER_MODEL_UNKNOWN;
      result.model.fill_rule = static_cast<std::uint32_t>(rule);
      if (grid) result.model.grid_rounding = static_cast<std::uint32_t>(grid->rounding);
      return true;
    }
  }
  std::uint64_t covers = 0, fewest = ~std::uint64_t{0}, most = 0;
  for (const auto& counts : found) {
    for (const std::uint32_t n : counts) covers += n;
  }
  for (int rule = 0; rule < 8; ++rule) {
    std::uint64_t sum = 0;
    for (const Scene& scene : scenes) {
      for (const std::uint32_t n : exact_counts(scene, static_cast<FillRule>(rule), std::nullopt)) sum += n;
    }
    fewest = std::min(fewest, sum);
    most = std::max(most, sum);
  }
  result.problems.push_back(
      fmt::format("no fill rule of C3 explains which samples on edges are covered: {} covers in 12 triangles, where "
                  "each rule has {}",
                  covers, fewest == most ? std::to_string(most) : fmt::format("{} to {}", fewest, most)));
  return false;
}

// Distances, in pixels, of edges from a sample, at which some grid goes from one answer to another, and a bit beside.
std::vector<double> probe_distances() {
  std::vector<double> distances;
  for (int bits = 1; bits <= 12; ++bits) {
    for (int j = -32; j <= 32; ++j) {
      for (int beside = -1; beside <= 1; ++beside) {
        distances.push_back(std::ldexp(j, -(bits + 5)) + std::ldexp(beside, -18));
      }
    }
  }
  std::sort(distances.begin(), distances.end());
  distances.erase(std::unique(distances.begin(), distances.end()), distances.end());
  std::erase_if(distances, [](double d) { return std::abs(d) > 0.45; });
  return distances;
}

// Positions below 32 in steps of 2^-18 are float32, and so are they in clip space.
constexpr int kProbesAScene = 32;

struct Probe {
  double edge, sample;
  bool covered;
};

// One triangle for each distance, whose left (or upper) edge passes the sample there.
std::vector<Probe> probe_axis(Rival& rival, bool vertical_edges) {
  const std::vector<double> distances = probe_distances();
  std::vector<Probe> probes;
  for (std::size_t begin = 0; begin < distances.size(); begin += kProbesAScene) {
    const std::size_t n = std::min<std::size_t>(kProbesAScene, distances.size() - begin);
    std::vector<std::array<Point, 3>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
      const double sample = static_cast<double>(i) + 0.5;
      const auto edge = static_cast<float>(sample + distances[begin + i]), apex = static_cast<float>(sample + 0.703125);
      triangles.push_back({{{edge, -3}, {edge, 4}, {apex, 0.5f}}});
      if (!vertical_edges) triangles.back() = {{{-3, edge}, {4, edge}, {0.5f, apex}}};
      probes.push_back({edge, sample, false});
    }
    const int length = static_cast<int>(n);
    const std::vector<std::uint32_t> counts =
        counts_of(rival, vertical_edges ? flat_scene(length, 1, triangles) : flat_scene(1, length, triangles));
    for (std::size_t i = 0; i < n; ++i) probes[begin + i].covered = counts[i] > 0;
  }
  return probes;
}

// Section 6 in double, which holds all these numbers exactly.
double snapped(double position, int bits, int offset, GridRounding rounding) {
  const double start = std::ldexp(offset, -(bits + 4));
  const double scaled = std::ldexp(position - start, bits);
  double k = 0;
  switch (rounding) {
    case GridRounding::nearest_even:
      k = std::nearbyint(scaled);
      break;
    case GridRounding::nearest_up:
      k = std::floor(scaled + 0.5);
      break;
    case GridRounding::truncate:
      k = std::trunc(scaled);
      break;
  }
  return start + std::ldexp(k, -bits);
}

// Does the model explain the axis? `towards` is the sign of the fill rule's shift along it.
template <typename Snap>
bool explains(const std::vector<Probe>& probes, double towards, const Snap& snap) {
  return std::all_of(probes.begin(), probes.end(), [&](const Probe& probe) {
    const double position = snap(probe.edge);
    const bool covered = position < probe.sample || (position == probe.sample && towards > 0);
    return covered == probe.covered;
  });
}

// A grid, or none: exact.
using Candidate = std::optional<Grid>;

bool same_grid(const Candidate& a, const Candidate& b) {
  if (!a || !b) return !a && !b;
  return a->bits == b->bits && a->offset_x == b->offset_x && a->offset_y == b->offset_y && a->rounding == b->rounding;
}

// Of candidates, the one that explains most of some slanted edges; of equals, the declared one, then exact, then a grid
// without offset, then one of more bits.
Candidate best_of(Rival& rival, std::vector<Candidate> candidates, FillRule rule, const Candidate& declared) {
  const auto rank = [&declared](const Candidate& c) {
    const Grid g = c.value_or(Grid{});
    return std::tuple(!same_grid(c, declared), c.has_value(), g.offset_x + g.offset_y, -g.bits, g.rounding, g.offset_x);
  };
  std::sort(candidates.begin(), candidates.end(), [&rank](const auto& a, const auto& b) { return rank(a) < rank(b); });
  std::vector<std::size_t> mismatches(candidates.size(), 0);
  properties::Random random(0x5EED);
  for (int n = 0; n < 36 && candidates.size() > 1; ++n) {
    std::vector<std::array<Point, 3>> triangles;
    for (int t = 0; t < 12; ++t) {
      // Between the positions of the finest grid, or halfway between two of a candidate's; all exact in clip space.
      const auto count = static_cast<std::uint32_t>(candidates.size());
      const Candidate halfway = n % 3 == 0 ? std::nullopt : candidates[random.below(count)];
      const auto coordinate = [&](int offset) {
        if (!halfway) return static_cast<float>(random.between(0, 8 << 16)) * 0x1p-16f;
        const auto sixteenths = static_cast<float>(16 * random.between(0, (8 << halfway->bits) - 1) + 8 + offset);
        return std::ldexp(sixteenths, -halfway->bits - 4);
      };
      std::array<Point, 3> triangle{};
      for (Point& p : triangle) {
        p.x = coordinate(halfway ? halfway->offset_x : 0);
        p.y = coordinate(halfway ? halfway->offset_y : 0);
      }
      // Every other edge passes a sample so closely that snapping its ends decides.
      if (t % 2 == 0) {
        const float x = std::floor(triangle[2].x) + 0.5f, y = std::floor(triangle[2].y) + 0.5f;
        triangle[1] = {2 * x - triangle[0].x, 2 * y - triangle[0].y};
      }
      triangles.push_back(triangle);
    }
    const Scene scene = flat_scene(8, 8, triangles);
    const std::vector<std::uint32_t> counts = counts_of(rival, scene);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const std::vector<std::uint32_t> expected = exact_counts(scene, rule, candidates[c]);
      for (std::size_t s = 0; s < counts.size(); ++s) mismatches[c] += counts[s] != expected[s];
    }
  }
  const auto best = std::min_element(mismatches.begin(), mismatches.end()) - mismatches.begin();
  return candidates[static_cast<std::size_t>(best)];
}

bool infer_grid(Rival& rival, const surefill_adapter_model& declared, Inference& result) {
  // The signs of C3's shifts for each rule.
  constexpr std::array<std::array<double, 2>, 8> kShifts{
      {{1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
  const std::array<double, 2> shift = kShifts[result.model.fill_rule];
  const std::array<std::vector<Probe>, 2> probes{probe_axis(rival, true), probe_axis(rival, false)};
  // Upright and level edges say where, beside a sample, positions go to either side of it, and no more: some coarser
  // grid with an offset may say the same as a finer one without, or truncation the same as no grid.
  std::vector<Candidate> candidates;
  const auto as_it_is = [](double position) { return position; };
  if (explains(probes[0], shift[0], as_it_is) && explains(probes[1], shift[1], as_it_is)) {
    candidates.push_back(std::nullopt);
  }
  for (int bits = 12; bits >= 1; --bits) {
    for (int rounding = 0; rounding < 3; ++rounding) {
      std::array<std::vector<int>, 2> offsets;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        for (int offset = 0; offset < 16; ++offset) {
          const auto snap = [&](double p) { return snapped(p, bits, offset, static_cast<GridRounding>(rounding)); };
          if (explains(probes[axis], shift[axis], snap)) offsets[axis].push_back(offset);
        }
      }
      for (const int x : offsets[0]) {
        for (const int y : offsets[1]) candidates.push_back(Grid{bits, x, y, static_cast<GridRounding>(rounding)});
      }
    }
  }
  if (!candidates.empty()) {
    Candidate as_declared;
    if (declared.kind == SUREFILL_ADAPTER_MODEL_GRID) {
      as_declared = Grid{static_cast<int>(declared.grid_bits), static_cast<int>(declared.grid_offset_x),
                         static_cast<int>(declared.grid_offset_y), static_cast<GridRounding>(declared.grid_rounding)};
    }
    const Candidate found =
        best_of(rival, std::move(candidates), static_cast<FillRule>(result.model.fill_rule), as_declared);
    result.model.kind = found ? SUREFILL_ADAPTER_MODEL_GRID : SUREFILL_ADAPTER_MODEL_EXACT;
    if (!found) return true;
    result.model.grid_bits = static_cast<std::uint32_t>(found->bits);
    result.model.grid_rounding = static_cast<std::uint32_t>(found->rounding);
    result.model.grid_offset_x = static_cast<std::uint32_t>(found->offset_x);
    result.model.grid_offset_y = static_cast<std::uint32_t>(found->offset_y);
    return true;
  }
  std::size_t early = 0, late = 0;
  for (const auto& axis : probes) {
    for (const Probe& probe : axis) {
      if (probe.covered && probe.edge > probe.sample) ++early;
      if (!probe.covered && probe.edge < probe.sample) ++late;
    }
  }
  result.problems.push_back(
      fmt::format("neither exact coverage nor a grid of 0 to 12 bits explains which side of a sample edges pass: of {} "
                  "edges, {} lie "
                  "beyond their sample and {} before it, against the coverage",
                  probes[0].size() + probes[1].size(), early, late));
  return false;
}

}  // namespace

Inference infer_model(Rival& rival) {
  const surefill_adapter_model declared = rival.info().model;
  Inference result;
  result.model = declared;
  result.model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
  result.model.grid_bits = result.model.grid_rounding = result.model.grid_offset_x = result.model.grid_offset_y = 0;
  result.model.fill_rule = 0;
  // Probes are drawn as they are; one that takes fill rules or grids from the draws gets top_left and none.
  rival.set_model(result.model);
  try {
    bool fits = infer_rows(rival, result);
    const std::size_t problems = result.problems.size();
    surefill_adapter_model raw = result.model;
    rival.set_model(raw);
    infer_depth_range(rival, result);
    raw.depth_range = result.model.depth_range;
    rival.set_model(raw);
    if (fits) fits = infer_fill_rule(rival, result);
    if (fits && result.model.kind == SUREFILL_ADAPTER_MODEL_UNKNOWN) fits = infer_grid(rival, declared, result);
    result.fits = fits && result.problems.size() == problems;
  } catch (...) {
    rival.set_model(declared);
    throw;
  }
  rival.set_model(declared);
  return result;
}

const char* profile_name(std::uint32_t profile) {
  constexpr std::array<const char*, 4> kNames{"exact", "d3d11", "vulkan", "opengl"};
  return profile < kNames.size() ? kNames[profile] : "unknown";
}

std::string describe_model(const surefill_adapter_model& model) {
  std::string text;
  switch (model.kind) {
    case SUREFILL_ADAPTER_MODEL_EXACT:
      text = "exact";
      break;
    case SUREFILL_ADAPTER_MODEL_GRID:
      text =
          fmt::format("grid of {} bits, {}, offset ({}, {})", model.grid_bits,
                      corpus::kGridRoundingNames[model.grid_rounding].second, model.grid_offset_x, model.grid_offset_y);
      break;
    default:
      return "unknown";
  }
  text += fmt::format(", fill rule {}, rows from the {}, profile {}", corpus::kFillRuleNames[model.fill_rule].second,
                      model.y == SUREFILL_ADAPTER_Y_UP ? "bottom" : "top", profile_name(model.profile));
  if (model.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE) text += ", clip depth -1 to 1";
  return text;
}

bool same_coverage(const surefill_adapter_model& a, const surefill_adapter_model& b) {
  if (a.kind != b.kind || a.fill_rule != b.fill_rule || a.y != b.y) return false;
  return a.kind != SUREFILL_ADAPTER_MODEL_GRID ||
         (a.grid_bits == b.grid_bits && a.grid_rounding == b.grid_rounding && a.grid_offset_x == b.grid_offset_x &&
          a.grid_offset_y == b.grid_offset_y);
}

}  // namespace surefill::adapters
