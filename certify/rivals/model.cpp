// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/lines.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/frame.hpp"
#include "corpus/names.hpp"
#include "corpus/scene.hpp"

namespace surefill::adapters {

namespace {

using corpus::Scene;
using judge::flat_scene;
using oracle::Rounding;

class OracleExpected : public judge::Expected {
 public:
  std::vector<oracle::Cover> cover(const judge::Model& model, int width, int height, int samples,
                                   const std::array<Vertex, 3>& triangle) const override {
    return oracle::cover(model, width, height, samples, triangle);
  }
  std::vector<oracle::Cover> cover_line(const judge::Model& model, int width, int height,
                                        const std::array<Vertex, 2>& ends,
                                        std::optional<float> line_width) const override {
    return oracle::cover_line(model, width, height, ends, line_width);
  }
  std::vector<oracle::Cover> cover_point(const judge::Model& model, int width, int height, const Vertex& vertex,
                                         float size) const override {
    return oracle::cover_point(model, width, height, vertex, size);
  }
  bool may_turn(const judge::Model& model, int width, int height,
                const std::array<Vertex, 3>& triangle) const override {
    return oracle::may_turn(model, width, height, triangle);
  }
};

std::vector<bool> covered_by(Rival& rival, const Scene& scene) {
  JudgedRival judged(rival);
  corpus::Outputs wanted = judged.outputs();
  wanted.barycentrics = wanted.attributes = false;
  const corpus::Image image = judged.draw(scene, wanted);
  std::vector<bool> covered;
  for (std::size_t s = 0; s < static_cast<std::size_t>(scene.width * scene.height); ++s) {
    covered.push_back(judge::is_covered(image, s));
  }
  return covered;
}

// The upper or the lower half of 8 x 8 pixels, by two triangles of either facing: some rasterizers leave one out.
bool infer_rows(Rival& rival, Inference& result) {
  const std::vector<std::array<judge::Point, 3>> half{{{{0, 0}, {8, 0}, {0, 3.5f}}},
                                                      {{{8, 0}, {0, 3.5f}, {8, 3.5f}}},
                                                      {{{0, 0}, {0, 3.5f}, {8, 0}}},
                                                      {{{8, 0}, {8, 3.5f}, {0, 3.5f}}}};
  const std::vector<bool> covered = covered_by(rival, flat_scene(8, 8, half));
  const auto any = [&covered](std::size_t begin) {
    return std::any_of(covered.begin() + static_cast<std::ptrdiff_t>(begin),
                       covered.begin() + static_cast<std::ptrdiff_t>(begin + 24), [](bool c) { return c; });
  };
  const bool upper = any(0), lower = any(40);
  if (upper == lower) {
    result.problems.push_back(upper ? "triangles over the upper half of 8 x 8 pixels cover samples of both halves"
                                    : "triangles over the upper half of 8 x 8 pixels cover nothing");
    return false;
  }
  if (lower) result.model.y = result.model.y == SUREFILL_ADAPTER_Y_UP ? SUREFILL_ADAPTER_Y_DOWN : SUREFILL_ADAPTER_Y_UP;
  return true;
}

// One depth all over the target: what comes back of four.
using FlatDepths = std::array<float, 4>;
constexpr FlatDepths kFlatDepths{0.25f, 0.75f, 0.0625f, 0.9375f};

FlatDepths flat_depths(Rival& rival) {
  FlatDepths found{};
  for (std::size_t n = 0; n < found.size(); ++n) {
    const Scene scene = flat_scene(8, 8, {{{{0, 0}, {8, 0}, {0, 8}}}, {{{0, 0}, {0, 8}, {8, 0}}}}, kFlatDepths[n]);
    found[n] = JudgedRival(rival).draw(scene, {false, false, true, false, false}).depth[2 * 8 + 2];
  }
  return found;
}

// Which range its clip depth has. That it is -1 to 1 is said only if all depths come back right under it.
void infer_depth_range(Rival& rival, Inference& result) {
  if (!(rival.info().outputs & SUREFILL_ADAPTER_DEPTH)) return;
  // No model has depths that are off by this much.
  const auto come = [](const FlatDepths& found, float slope, float constant) {
    for (std::size_t n = 0; n < found.size(); ++n) {
      if (std::isinf(found[n])) continue;  // it clips that
      if (!(std::abs(found[n] - (slope * kFlatDepths[n] + constant)) < 0.01f)) return false;
    }
    return true;
  };
  const FlatDepths found = flat_depths(rival);
  if (come(found, 1, 0)) return;
  const bool minus_one = result.model.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
  if (come(found, 0.5f, 0.5f) && !minus_one && rival.info().form == SUREFILL_ADAPTER_FORM_CLIP) {
    surefill_adapter_model other = result.model;
    other.depth_range = SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
    rival.set_model(other);
    const bool explains = come(flat_depths(rival), 1, 0);
    rival.set_model(result.model);
    if (explains) {
      result.model = other;
      return;
    }
  }
  result.problems.push_back(
      fmt::format("triangles of depth 0.25 and 0.75 have depth {:.9g} and {:.9g}", found[0], found[1]));
}

judge::Standard standard_of(std::uint32_t profile) {
  switch (profile) {
    case SUREFILL_ADAPTER_PROFILE_D3D11:
      return judge::Standard::d3d11;
    case SUREFILL_ADAPTER_PROFILE_VULKAN:
      return judge::Standard::vulkan;
    case SUREFILL_ADAPTER_PROFILE_OPENGL:
      return judge::Standard::opengl;
    default:
      return judge::Standard::none;
  }
}

}  // namespace

corpus::Outputs JudgedRival::outputs() const {
  const auto has = [this](int output) { return (rival_.info().outputs & static_cast<std::uint32_t>(output)) != 0; };
  return {has(SUREFILL_ADAPTER_COUNT), has(SUREFILL_ADAPTER_INDEX), has(SUREFILL_ADAPTER_DEPTH),
          has(SUREFILL_ADAPTER_BARYCENTRICS), has(SUREFILL_ADAPTER_ATTRIBUTES)};
}

// Clip space is pixel space times a power of two and moved: positions below 64 in steps of 2^-18 are float32 there.
double JudgedRival::position_step() const {
  return rival_.info().form == SUREFILL_ADAPTER_FORM_CLIP ? 0x1p-18 : 0;
}

judge::Rival::Primitives JudgedRival::primitives() const {
  const std::uint32_t claimed = rival_.primitives();
  return {(claimed >> SUREFILL_ADAPTER2_LINES & 1u) != 0, (claimed >> SUREFILL_ADAPTER2_POINTS & 1u) != 0,
          (rival_.info().features & SUREFILL_ADAPTER2_WIDTHS) != 0};
}

corpus::Image JudgedRival::draw(const corpus::Scene& scene, const corpus::Outputs& wanted) {
  corpus::Frame frame(scene, wanted);
  rival_.draw(frame.target(), frame.draws());
  return std::move(frame.image());
}

const judge::Expected& oracle_expected() {
  static const OracleExpected expected;
  return expected;
}

judge::Model model_of(const surefill_adapter_model& model) {
  constexpr std::array<Rounding, 3> kRoundings{Rounding::nearest_even, Rounding::nearest_up, Rounding::truncate};
  judge::Model result;
  result.front = result.back = oracle::owners_of(static_cast<FillRule>(model.fill_rule));
  result.minus_one_to_one = model.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
  result.distance = model.profile == SUREFILL_ADAPTER_PROFILE_D3D11 ? 0x1p-8 : 0x1p-4;
  if (model.kind != SUREFILL_ADAPTER_MODEL_GRID) return result;
  result.turned = oracle::Turned::open;
  const auto bits = static_cast<int>(model.grid_bits);
  result.x.bits = result.y.bits = bits;
  result.x.rounding = result.y.rounding = kRoundings[model.grid_rounding];
  result.x.grid_offset = std::ldexp(model.grid_offset_x, -bits - 4);
  result.y.grid_offset = std::ldexp(model.grid_offset_y, -bits - 4);
  return result;
}

std::optional<surefill_adapter_model> adapter_model(const judge::Model& model,
                                                    const surefill_adapter_model& conventions) {
  const std::optional<FillRule> rule = oracle::watertight_rule(model);
  surefill_adapter_model result = conventions;
  result.kind = SUREFILL_ADAPTER_MODEL_EXACT;
  result.grid_bits = result.grid_rounding = result.grid_offset_x = result.grid_offset_y = 0;
  if (!rule || model.culled != Cull::none || model.x.bits != model.y.bits) return std::nullopt;
  result.fill_rule = static_cast<std::uint32_t>(*rule);
  for (const oracle::AxisModel* axis : {&model.x, &model.y}) {
    if (axis->place != 0.5 || axis->lacks != 0 || axis->moved != 0 || axis->blur != 0) return std::nullopt;
  }
  if (model.x.bits < 0) return result;
  if (model.x.rounding != model.y.rounding || model.x.bits > 12) return std::nullopt;
  result.kind = SUREFILL_ADAPTER_MODEL_GRID;
  result.grid_bits = static_cast<std::uint32_t>(model.x.bits);
  switch (model.x.rounding) {
    case Rounding::nearest_even:
      result.grid_rounding = SUREFILL_ADAPTER_NEAREST_EVEN;
      break;
    case Rounding::nearest_up:
      result.grid_rounding = SUREFILL_ADAPTER_NEAREST_UP;
      break;
    case Rounding::truncate:
      result.grid_rounding = SUREFILL_ADAPTER_TRUNCATE;
      break;
    default:
      return std::nullopt;
  }
  result.grid_offset_x = static_cast<std::uint32_t>(std::ldexp(model.x.grid_offset, model.x.bits + 4));
  result.grid_offset_y = static_cast<std::uint32_t>(std::ldexp(model.y.grid_offset, model.y.bits + 4));
  return result;
}

Inference infer_model(Rival& rival) {
  const surefill_adapter_model declared = rival.info().model;
  Inference result;
  result.model = declared;
  result.model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
  result.model.grid_bits = result.model.grid_rounding = result.model.grid_offset_x = result.model.grid_offset_y = 0;
  result.model.fill_rule = 0;
  result.judged.model = judge::least_known_model();
  // Probes are drawn as they are; one that takes fill rules or grids from the draws gets top_left and none.
  rival.set_model(result.model);
  try {
    const bool rows = infer_rows(rival, result);
    rival.set_model(result.model);
    try {
      infer_depth_range(rival, result);
    } catch (const RivalSkips&) {
      // It takes no such scene: nothing is said of its range.
    }
    rival.set_model(result.model);
    if (rows) {
      JudgedRival judged(rival);
      std::optional<judge::Model> hint;
      if (declared.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN) hint = model_of(declared);
      if (rival.stated()) hint = rival.stated();
      result.judged = judge::infer(judged, oracle_expected(), hint);
      judge::infer_lines(judged, oracle_expected(), standard_of(declared.profile), rival.stated(), result.judged);
      result.problems.insert(result.problems.end(), result.judged.problems.begin(), result.judged.problems.end());
      result.judged.model.distance = model_of(declared).distance;
      const auto expressed = adapter_model(result.judged.model, result.model);
      if (result.judged.known && expressed) {
        result.model = *expressed;
        result.fits = true;
      }
    }
  } catch (...) {
    rival.set_model(declared);
    throw;
  }
  rival.set_model(declared);
  return result;
}

judge::Terms terms_of(const surefill_adapter_info& info, const std::optional<judge::Model>& stated,
                      const judge::Inference& found) {
  judge::Terms terms;
  terms.model = found.model;
  terms.known = found.known;
  // It says so, or was found so by its flat depths; that some come back to the bit does not say that all do.
  if (info.model.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE) terms.model.minus_one_to_one = true;
  // What it declares of coverage, unless probing finds another model: that is a finding by itself, and one is enough.
  const bool contradicted = found.known && !judge::differences(model_of(info.model), found.model).empty();
  if (info.model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN && !contradicted) {
    const judge::Model declared = model_of(info.model);
    terms.model.x = declared.x;
    terms.model.y = declared.y;
    terms.model.front = declared.front;
    terms.model.back = declared.back;
    terms.model.vertices = declared.vertices;
    terms.model.distance = declared.distance;
    terms.known = true;
  }
  const judge::Rival::Primitives drawn{(info.features & kLines) != 0, (info.features & kPoints) != 0,
                                       (info.features & SUREFILL_ADAPTER2_WIDTHS) != 0};
  if (stated && (!found.known || (judge::differences(*stated, found.model).empty() &&
                                  judge::line_differences(*stated, found.model, drawn).empty()))) {
    terms.model = *stated;
    terms.model.band = found.model.band;  // no state says it
    terms.known = true;
  }
  terms.draws_own_rule = (info.features & SUREFILL_ADAPTER_FILL_RULES) != 0;
  terms.draws_own_grid = (info.features & SUREFILL_ADAPTER_GRIDS) != 0;
  terms.counts_seen = (info.outputs & SUREFILL_ADAPTER_COUNT) == 0;
  return terms;
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

std::string declared_model(const Rival& rival) {
  return rival.stated() ? judge::describe(*rival.stated()) : describe_model(rival.info().model);
}

bool same_coverage(const surefill_adapter_model& a, const surefill_adapter_model& b) {
  if (a.kind != b.kind || a.fill_rule != b.fill_rule || a.y != b.y) return false;
  return a.kind != SUREFILL_ADAPTER_MODEL_GRID ||
         (a.grid_bits == b.grid_bits && a.grid_rounding == b.grid_rounding && a.grid_offset_x == b.grid_offset_x &&
          a.grid_offset_y == b.grid_offset_y);
}

}  // namespace surefill::adapters
