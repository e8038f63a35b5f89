// SPDX-License-Identifier: Apache-2.0
//
// What the header promises beyond the image: the viewport map, outputs alone, the caller's floating-point state, bad
// arguments.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cfenv>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "certify/run/checks.hpp"
#include "properties/generators/generators.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace surefill::certify {

namespace {

using corpus::Image;
using corpus::Outputs;
using corpus::Scene;
using properties::Random;

Scene random_case(const Settings& settings, const std::string& check, std::uint64_t number) {
  const auto categories = properties::categories();
  properties::SceneLimits limits;
  limits.samples = settings.support.samples;
  limits.grid = settings.support.grid;
  limits.conservative = settings.support.conservative;
  return properties::random_scene(categories[number % categories.size()], case_seed(settings.seed, check, number),
                                  limits);
}

// --- viewport

float hard_float(Random& random, bool finite) {
  using Limits = std::numeric_limits<float>;
  float value = 0;
  switch (random.below(finite ? 9 : 11)) {
    case 0:
      value = 0;
      break;
    case 1:
      value = static_cast<float>(random.between(-4, 4)) / 2;
      break;
    case 2:
      value = static_cast<float>(random.between(-4096, 4096));
      break;
    case 3:
      value = std::ldexp(1.0f, random.between(-149, 127));
      break;
    case 4:
      value = Limits::max();
      break;
    case 5:
      value = static_cast<float>(random.between(1, 9)) * Limits::denorm_min();
      break;
    case 6:
      value = std::nextafter(static_cast<float>(random.between(1, 3)), random.one_in(2) ? 0.0f : 4.0f);
      break;
    case 7:
      value = static_cast<float>(random.unit());
      break;
    case 8:
      do {
        value = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
      } while (finite && !std::isfinite(value));
      break;
    case 9:
      value = Limits::quiet_NaN();
      break;
    default:
      value = Limits::infinity();
      break;
  }
  return random.one_in(2) ? -value : value;
}

CaseResult viewport_case(std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  Viewport& viewport = draw.viewport.emplace();
  if (random.one_in(2)) {
    viewport.width = static_cast<float>(random.between(1, 4096));
    viewport.height = static_cast<float>(random.between(1, 4096));
  } else {
    for (float* number :
         {&viewport.x, &viewport.y, &viewport.width, &viewport.height, &viewport.near_depth, &viewport.far_depth}) {
      *number = hard_float(random, true);
    }
  }
  if (random.one_in(2)) viewport.clip_depth = ClipDepth::minus_one_to_one;
  if (random.one_in(2)) viewport.clip_y = ClipY::down;
  for (std::uint32_t i = 0; i < 16; ++i) {
    corpus::SceneVertex& vertex = draw.vertices.emplace_back();
    for (float* number : {&vertex.x, &vertex.y, &vertex.z, &vertex.w}) *number = hard_float(random, !random.one_in(8));
    if (i % 3 == 2) draw.triangles.push_back({{i - 2, i - 1, i}, std::nullopt});
  }
  // Only the vertices are looked at: a scene of one pixel costs next to nothing more.
  CaseResult result = compare_case(scene, properties::oracle_renderer(), properties::oracle_renderer());
  result.samples = scene.draws[0].vertices.size();
  return result;
}

// --- outputs-alone

struct Drawn {
  Status status = Status::ok;
  Image image;
};

Drawn draw(const Scene& scene, const Outputs& outputs, const properties::Renderer& engine) {
  corpus::Frame frame(scene, outputs);
  Drawn drawn;
  drawn.status = engine(frame.target(), frame.draws());
  drawn.image = std::move(frame.image());
  return drawn;
}

CaseResult outputs_alone(const Scene& scene, const properties::Renderer& engine) {
  CaseResult result;
  const Drawn all = draw(scene, properties::outputs_of(scene), engine);
  for (int k = 0; k < 5; ++k) {
    const Outputs outputs{k == 0, k == 1, k == 2, k == 3, k == 4};
    Image expected = all.image;
    if (!outputs.count) expected.count.clear();
    if (!outputs.index) expected.index.clear();
    if (!outputs.depth) expected.depth.clear();
    if (!outputs.barycentrics) expected.barycentrics.clear();
    Drawn one = draw(scene, outputs, engine);
    if (!outputs.attributes) expected.attributes.clear(), one.image.attributes.clear();
    if (all.status != Status::ok || one.status != Status::ok) {
      ++result.differences;
      result.finding = fmt::format("the engine returned \"{}\" for all outputs and \"{}\" for one",
                                   status_text(all.status), status_text(one.status));
      continue;
    }
    const properties::Comparison comparison = properties::compare(scene, expected, one.image, 1);
    result.samples += comparison.samples;
    result.differences += comparison.differences;
    if (comparison.differences > 0) {
      result.finding = "asked for alone, " + describe_finding(comparison.first.front(), scene.samples);
    }
  }
  if (result.differences > 0) result.scene = scene;
  return result;
}

// --- float-environment

// A floating-point state that a caller may have: rounding and, where the machine has them, FTZ and DAZ.
struct FloatMode {
  int rounding;
  bool flush;
  const char* name;
};
constexpr FloatMode kModes[] = {
    {FE_TONEAREST, false, "to nearest"},
    {FE_UPWARD, false, "upward"},
    {FE_DOWNWARD, false, "downward"},
    {FE_TOWARDZERO, false, "toward zero"},
#if defined(__SSE2__)
    {FE_TONEAREST, true, "to nearest, FTZ and DAZ"},
    {FE_UPWARD, true, "upward, FTZ and DAZ"},
    {FE_DOWNWARD, true, "downward, FTZ and DAZ"},
    {FE_TOWARDZERO, true, "toward zero, FTZ and DAZ"},
#endif
};

// What of the state a caller sees: modes and exception flags.
unsigned float_state() {
  unsigned state = static_cast<unsigned>(std::fegetround() | std::fetestexcept(FE_ALL_EXCEPT));
#if defined(__SSE2__)
  state |= _mm_getcsr() << 16;
#endif
  return state;
}

// Calls `call` in a mode, without flags; false if the state was another one afterwards. The state before is back at the
// end.
bool in_mode(const FloatMode& mode, const std::function<void()>& call) {
  std::fenv_t saved;
  std::fegetenv(&saved);
  std::fesetround(mode.rounding);
  std::feclearexcept(FE_ALL_EXCEPT);
#if defined(__SSE2__)
  if (mode.flush) _mm_setcsr(_mm_getcsr() | 0x8040u);  // FTZ (bit 15), DAZ (bit 6)
#endif
  const unsigned before = float_state();
  call();
  const bool kept = float_state() == before;
  std::fesetenv(&saved);
  return kept;
}

// Bit for bit; all NaNs are alike.
bool same_vertex(const Vertex& a, const Vertex& b) {
  const auto same = [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) || (std::isnan(x) && std::isnan(y));
  };
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w);
}

CaseResult float_environment(const Scene& scene, const properties::Renderer& engine) {
  CaseResult result;
  const auto finding = [&](const FloatMode& mode, const std::string& text) {
    ++result.differences;
    if (result.finding.empty()) result.finding = fmt::format("caller rounds {}: {}", mode.name, text);
  };
  const Drawn plain = draw(scene, properties::outputs_of(scene), engine);
  for (const FloatMode& mode : kModes) {
    corpus::Frame frame(scene, properties::outputs_of(scene));
    Status status = Status::ok;
    if (!in_mode(mode, [&] { status = engine(frame.target(), frame.draws()); })) {
      finding(mode, "render did not restore the caller's floating-point state");
    }
    if (status != plain.status) finding(mode, "another status");
    const properties::Comparison comparison = properties::compare(scene, plain.image, frame.image(), 1);
    result.samples += comparison.samples;
    if (comparison.differences > 0) finding(mode, describe_finding(comparison.first.front(), scene.samples));
    for (const corpus::SceneDraw& scene_draw : scene.draws) {
      std::vector<ClipVertex> clip;
      for (const auto& vertex : scene_draw.vertices) clip.push_back({vertex.x, vertex.y, vertex.z, vertex.w});
      std::vector<Vertex> expected(clip.size()), actual(clip.size());
      Viewport viewport;
      viewport.width = 1920;
      viewport.height = 1080;
      if (scene_draw.viewport) viewport = *scene_draw.viewport;
      (void)to_pixel(viewport, clip, expected);
      if (!in_mode(mode, [&] { (void)to_pixel(viewport, clip, actual); })) {
        finding(mode, "to_pixel did not restore the caller's floating-point state");
      }
      if (!std::equal(expected.begin(), expected.end(), actual.begin(), same_vertex)) {
        finding(mode, "to_pixel gives other vertices");
      }
    }
  }
  if (result.differences > 0) result.scene = scene;
  return result;
}

}  // namespace

void add_contract_checks(const Settings& settings, std::vector<Check>& checks) {
  {
    Check check =
        make_check("viewport", "S3", "to_pixel = the oracle's, bit for bit, on hard viewports and clip coordinates");
    const std::uint64_t cases = by_level<std::uint64_t>(settings.level, 10000, 100000, 4000000);
    check.prepare = [cases] { return cases; };
    check.cost = 1e-4;
    check.run = [&settings](std::uint64_t number) {
      return viewport_case(case_seed(settings.seed, "viewport", number));
    };
    check.still_fails = [](const Scene& scene) {
      return valid(scene) &&
             judge(scene, properties::oracle_renderer(), properties::oracle_renderer(), 0).differences > 0;
    };
    checks.push_back(std::move(check));
  }
  {
    Check check = make_check("outputs-alone", "M2, V1, I", "each output asked for alone equals the same among all");
    const std::uint64_t cases = by_level<std::uint64_t>(settings.level, 2000, 20000, 400000);
    check.prepare = [cases] { return cases; };
    check.cost = 1e-4;
    check.run = [&settings](std::uint64_t number) {
      return outputs_alone(random_case(settings, "outputs-alone", number), settings.engine);
    };
    check.still_fails = [&settings](const Scene& scene) {
      return valid(scene) && outputs_alone(scene, settings.engine).differences > 0;
    };
    checks.push_back(std::move(check));
  }
  {
    Check check = make_check(
        "float-environment", "B4",
        fmt::format("the same image in {} floating-point modes of the caller, which are restored", std::size(kModes)));
    const std::uint64_t cases = by_level<std::uint64_t>(settings.level, 2000, 20000, 400000);
    check.prepare = [cases] { return cases; };
    check.cost = 2.6e-4;
    check.run = [&settings](std::uint64_t number) {
      return float_environment(random_case(settings, "float-environment", number), settings.engine);
    };
    check.still_fails = [&settings](const Scene& scene) {
      return valid(scene) && float_environment(scene, settings.engine).differences > 0;
    };
    checks.push_back(std::move(check));
  }
  add_argument_check(settings, checks);
}

}  // namespace surefill::certify
