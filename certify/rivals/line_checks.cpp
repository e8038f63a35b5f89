// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/line_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "certify/judge/line_rules.hpp"
#include "certify/judge/probes.hpp"
#include "certify/rivals/frame.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;
using corpus::SceneDraw;
using oracle::LineShape;

constexpr float kMostWidth = 8;

bool takes(const RivalSubject& subject, int feature) {
  return (subject.rival->info().features & static_cast<std::uint32_t>(feature)) != 0;
}

// Modes of which it has none, and which a case of lines is not about.
void make_drawable(Scene& scene, const RivalSubject& subject) {
  scene.origin = {};
  scene.sample_locations.clear();
  scene.layers = 1;
  scene.more = {};
  const bool samples = subject.strict && takes(subject, SUREFILL_ADAPTER_SAMPLES);
  if (!samples) scene.samples = 1;
  if (!takes(subject, SUREFILL_ADAPTER_CENTROID)) scene.attribute_location = AttributeLocation::centre;
  const bool greater = scene.depth_test == DepthTest::greater || scene.depth_test == DepthTest::greater_equal;
  scene.depth_test = greater && takes(subject, SUREFILL_ADAPTER_DEPTH_GREATER) ? DepthTest::greater : DepthTest::less;
  if (!takes(subject, SUREFILL_ADAPTER_INITIAL_DEPTH)) scene.initial_depth.clear();
  for (corpus::SceneAttribute& attribute : scene.attributes) {
    const bool lacks =
        (attribute.interpolation == Interpolation::noperspective && !takes(subject, SUREFILL_ADAPTER_NOPERSPECTIVE)) ||
        (attribute.interpolation == Interpolation::flat && !takes(subject, SUREFILL_ADAPTER_FLAT));
    if (lacks) attribute.interpolation = Interpolation::perspective;
  }
}

void make_drawable(SceneDraw& draw, const RivalSubject& subject, bool several_samples) {
  const judge::Rival::Primitives has = primitives_of(*subject.rival);
  if (draw.primitive == Primitive::lines && !has.lines) {
    draw.primitive = Primitive::points;
    for (corpus::SceneTriangle& t : draw.triangles) t.vertices.fill(t.vertices[0]);
  } else if (draw.primitive == Primitive::points && !has.points) {
    draw.primitive = Primitive::lines;
  }
  draw.conservative = Conservative::none;
  draw.grid.reset();
  draw.culling_box.reset();
  draw.depth_bias.reset();
  if (draw.fill_rule > FillRule::northwards_west) draw.fill_rule = FillRule::top_left;
  if (!takes(subject, SUREFILL_ADAPTER_DEPTH_READ_ONLY)) draw.depth_write = true;
  if (!takes(subject, SUREFILL_ADAPTER_SCISSOR)) draw.scissor.reset();
  if (!takes(subject, SUREFILL_ADAPTER_CULL)) draw.cull = Cull::none;
  if (draw.depth_mode == DepthMode::clip && !takes(subject, SUREFILL_ADAPTER_DEPTH_CLIP))
    draw.depth_mode = DepthMode::none;
  if (draw.depth_mode == DepthMode::clamp && !takes(subject, SUREFILL_ADAPTER_DEPTH_CLAMP)) {
    draw.depth_mode = DepthMode::none;
  }
  if (draw.width && !has.widths && !several_samples) draw.width.reset();
  if (subject.strict) return;
  if (draw.width) {
    // Half a pixel and more, in halves.
    const float halves = std::nearbyint(2 * std::clamp(*draw.width, 0.5f, kMostWidth));
    draw.width = halves / 2;
  }
  const bool front = std::all_of(draw.vertices.begin(), draw.vertices.end(), [](const auto& v) { return v.w > 0; });
  for (corpus::SceneVertex& v : draw.vertices) {
    v.z = front ? std::clamp(v.z, 0.0f, v.w) : v.w / 2;
    for (float& value : v.attributes) {
      const float magnitude = std::abs(value);
      if (value != 0 && !(magnitude >= 0x1p-32f && magnitude <= 0x1p32f)) value = 1;
    }
  }
}

float on_sixteenths(judge::Random& random, double low, double high) {
  return static_cast<float>(std::nearbyint((low + (high - low) * random.unit()) * 256) / 256);
}

CaseResult rule_result(const judge::RuleVerdict& verdict, std::size_t samples) {
  if (!verdict.judged) return not_applicable();
  CaseResult result;
  result.samples = samples;
  if (verdict.rule == 0) return result;
  result.differences = 1;
  result.finding = "(" + std::to_string(verdict.rule) + ") of R22: " + verdict.finding;
  return result;
}

// The counts of the rival.
std::vector<std::uint32_t> counts_of(const Scene& scene, const RivalSubject& subject) {
  corpus::Outputs outputs{true, false, false, false, false};
  corpus::Frame frame(scene, outputs);
  if (validate(frame.target(), frame.draws()) != Status::ok) throw adapters::RivalSkips("not a frame");
  subject.rival->draw(frame.target(), frame.draws());
  return frame.image().count;
}

judge::Model positions_of(const RivalSubject& subject, const Scene& scene) {
  const corpus::Frame frame(scene, {false, false, false, false, false});
  return judge::model_of_draw(subject.terms, {scene.width, scene.height, 1, scene.depth_test, false, frame.draws()},
                              frame.draws()[0]);
}

void note(const RivalSubject& subject, const CaseResult& result) {
  if (result.samples > 0) *subject.challenged |= adapters::kLines;
}

}  // namespace

judge::Rival::Primitives primitives_of(const adapters::Rival& rival) {
  const std::uint32_t claimed = rival.primitives();
  return {(claimed >> SUREFILL_ADAPTER2_LINES & 1u) != 0, (claimed >> SUREFILL_ADAPTER2_POINTS & 1u) != 0,
          (rival.info().features & SUREFILL_ADAPTER2_WIDTHS) != 0};
}

Scene line_scene_for(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  const auto categories = properties::line_categories();
  Scene scene = properties::lines_scene(categories[number % categories.size()], seed, 24, number % 3 == 0 ? 1 : 4);
  make_drawable(scene, subject);
  if (!takes(subject, SUREFILL_ADAPTER_DRAWS)) {
    // The first draw that is not of triangles, alone.
    const auto found = std::find_if(scene.draws.begin(), scene.draws.end(),
                                    [](const SceneDraw& draw) { return draw.primitive != Primitive::triangles; });
    if (found != scene.draws.end()) scene.draws = {SceneDraw(*found)};
  }
  for (SceneDraw& draw : scene.draws) make_drawable(draw, subject, scene.samples > 1);
  return scene;
}

Scene lone_line_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  judge::Random random(seed);
  Scene scene;
  scene.width = random.between(16, 40);
  scene.height = random.between(16, 40);
  SceneDraw& draw = scene.draws.emplace_back();
  draw.primitive = Primitive::lines;
  const bool wide = primitives_of(*subject.rival).widths && number % 2 == 1;
  if (wide) draw.width = static_cast<float>(random.between(1, 5));
  const double margin = wide ? 5 : 2;
  for (int i = 0; i < 2; ++i) {
    const float w = random.below(3) == 0 ? 2.0f : 1.0f;
    const float x = on_sixteenths(random, margin, scene.width - margin),
                y = on_sixteenths(random, margin, scene.height - margin);
    draw.vertices.push_back({x * w, y * w, w / 2, w, {}});
  }
  draw.triangles.push_back({{0, 1, 1}, std::nullopt});
  return scene;
}

bool owes_line_rules(const RivalSubject& subject, bool wide) {
  if (!subject.terms.known || subject.rival->info().model.profile == SUREFILL_ADAPTER_PROFILE_EXACT) return false;
  const LineShape shape = wide ? subject.terms.model.lines.wide : subject.terms.model.lines.thin;
  return subject.rival->info().model.profile == SUREFILL_ADAPTER_PROFILE_OPENGL || shape == LineShape::tolerant;
}

CaseResult line_rule_case(const Scene& scene, const RivalSubject& subject) {
  const std::optional<judge::LoneLine> line = judge::lone_line(scene);
  if (!line || !owes_line_rules(subject, line->line_width.has_value())) return not_applicable();
  const CaseResult result = guarded_case(scene, [&] {
    const std::vector<std::uint32_t> counts = counts_of(scene, subject);
    std::vector<bool> covered;
    for (const std::uint32_t count : counts) covered.push_back(count > 0);
    return rule_result(judge::judge_line(adapters::oracle_expected(), positions_of(subject, scene), *line, covered),
                       counts.size());
  });
  note(subject, result);
  return result;
}

Scene strip_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  judge::Random random(seed);
  Scene scene;
  scene.width = scene.height = 48;
  SceneDraw& draw = scene.draws.emplace_back();
  draw.primitive = Primitive::lines;
  const bool x_major = random.below(2) == 0, backwards = random.below(2) == 0;
  const int lines = random.between(2, 6), lattice = number % 3 == 0 ? 2 : number % 3 == 1 ? 16 : 256;
  double along = 3 + random.unit(), beside = 24 + 8 * random.unit();
  const auto rounded = [lattice](double at) { return static_cast<float>(std::nearbyint(at * lattice) / lattice); };
  for (int i = 0; i <= lines; ++i) {
    float u = rounded(along), v = rounded(beside);
    if (backwards) u = 48 - u;
    draw.vertices.push_back({x_major ? u : v, x_major ? v : u, 0.5f, 1, {}});
    const double length = 3.5 + 3 * random.unit();
    along += length;
    beside += (length - 2.5) * (2 * random.unit() - 1);
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(lines); ++i) {
    draw.triangles.push_back({{i, i + 1, i + 1}, std::nullopt});
  }
  (void)subject;
  return scene;
}

bool owes_strips(const RivalSubject& subject) {
  if (!primitives_of(*subject.rival).lines) return false;
  if (subject.strict) return true;
  if (!subject.terms.known) return false;
  const std::uint32_t profile = subject.rival->info().model.profile;
  const LineShape shape = subject.terms.model.lines.thin;
  if (profile == SUREFILL_ADAPTER_PROFILE_EXACT) {
    return shape == LineShape::diamond && subject.terms.model.lines.left_out == oracle::LeftOut::last;
  }
  return profile == SUREFILL_ADAPTER_PROFILE_OPENGL || shape == LineShape::diamond || shape == LineShape::tolerant;
}

CaseResult strip_case(const Scene& scene, const RivalSubject& subject) {
  if (!owes_strips(subject) || scene.draws.size() != 1 || scene.samples != 1) return not_applicable();
  const SceneDraw& draw = scene.draws[0];
  std::vector<Vertex> ends;
  for (std::size_t i = 0; i < draw.triangles.size(); ++i) {
    // What a reduction leaves may be a strip no more.
    if (i > 0 && draw.triangles[i].vertices[0] != draw.triangles[i - 1].vertices[1]) return not_applicable();
    for (std::size_t k = i == 0 ? 0 : 1; k < 2; ++k) {
      const corpus::SceneVertex& v = draw.vertices[draw.triangles[i].vertices[k]];
      if (!(v.w > 0)) return not_applicable();
      ends.push_back({v.x, v.y, v.z, v.w});
    }
  }
  if (draw.primitive != Primitive::lines || draw.width || draw.scissor || draw.depth_mode == DepthMode::clip) {
    return not_applicable();
  }
  const CaseResult result = guarded_case(scene, [&] {
    const std::vector<std::uint32_t> counts = counts_of(scene, subject);
    return rule_result(judge::judge_strip(adapters::oracle_expected(), positions_of(subject, scene), scene.width,
                                          scene.height, ends, counts),
                       counts.size());
  });
  note(subject, result);
  return result;
}

}  // namespace surefill::certify
