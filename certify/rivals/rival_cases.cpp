// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/rival_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "certify/judge/questions.hpp"
#include "certify/rivals/frame.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::certify {

namespace {

using adapters::Rival;
using corpus::Image;
using corpus::Scene;

judge::Frame frame_of(const Target& target, std::span<const Draw> draws) {
  return {target.width, target.height,       target.samples, target.depth_test, !target.initial_depth.empty(),
          draws,        target.initial_depth};
}

// Vertices behind the eye, or beyond R7's band. A triangle with one that is no number covers nothing (B1).
bool leaves_open(std::span<const Draw> draws) {
  for (const Draw& draw : draws) {
    for (const Vertex& v : draw.vertices) {
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) continue;
      const double band = 16384.0 * v.w;
      if (!(v.w > 0) || std::abs(v.x) > band || std::abs(v.y) > band) return true;
    }
  }
  return false;
}

// Bit for bit.
CaseResult strict_case(const Scene& scene, Rival& rival) {
  CaseResult result;
  corpus::Outputs outputs = properties::outputs_of(scene);
  corpus::Frame expected(scene, outputs);
  outputs = outputs_with(rival, scene);
  corpus::Frame actual(scene, outputs);
  if (validate(expected.target(), expected.draws()) != Status::ok) return not_applicable();
  rival.draw(actual.target(), actual.draws());
  properties::oracle_renderer()(expected.target(), expected.draws());
  Image wanted = expected.image();
  if (!outputs.index) wanted.index.clear();
  if (!outputs.depth) wanted.depth.clear();
  if (!outputs.barycentrics) wanted.barycentrics.clear();
  if (!outputs.attributes) wanted.attributes.clear();
  const properties::Comparison comparison = properties::compare(scene, wanted, actual.image(), 1);
  result.samples = comparison.samples;
  result.differences = comparison.differences;
  if (!comparison.first.empty()) result.finding = properties::describe(comparison.first.front(), scene.samples);
  return result;
}

// The picture of what the judge found.
properties::Exhibit exhibit_of(const judge::Judgement& judgement, const judge::Frame& frame,
                               const std::vector<std::uint32_t>& actual) {
  properties::Exhibit exhibit{frame.width,     frame.height, frame.samples,     "",
                              judgement.least, actual,       judgement.differs, {}};
  for (std::size_t s = 0; s < judgement.unknown.size(); ++s) {
    if (judgement.unknown[s]) exhibit.expected[s] = properties::Exhibit::kOpenCount;
  }
  for (const judge::Judgement::Value& value : judgement.values) {
    if (value.output != "count") {
      exhibit.values.push_back({value.sample, value.output, value.expected, value.actual, value.error});
    }
  }
  const bool counts = exhibit.values.size() < judgement.values.size();
  exhibit.output = counts ? "count" : exhibit.values.front().output == "index" ? "index" : "values";
  return exhibit;
}

CaseResult case_of(const judge::Judgement& judgement) {
  CaseResult result;
  result.samples = judgement.samples;
  result.open = judgement.open;
  result.differences = judgement.differences;
  result.deviations = judgement.deviations;
  result.finding = judgement.finding;
  result.skipped = judgement.samples == 0;
  return result;
}

// By section 11.
CaseResult model_case(const Scene& scene, const RivalSubject& subject, const judge::Looks& looks) {
  Rival& rival = *subject.rival;
  corpus::Frame actual(scene, outputs_with(rival, scene));
  if (validate(actual.target(), actual.draws()) != Status::ok) return not_applicable();
  const judge::Frame frame = frame_of(actual.target(), actual.draws());
  if (!judge::why_open(subject.terms, frame).empty()) return not_applicable();
  rival.draw(actual.target(), actual.draws());
  const judge::Judgement judgement =
      judge::judge_image(adapters::oracle_expected(), subject.terms, frame, actual.image(), looks, scene.attributes);
  CaseResult result = case_of(judgement);
  if (result.differences > 0) result.exhibit = exhibit_of(judgement, frame, actual.image().count);
  return result;
}

bool starts_with(const properties::Property& property, std::string_view text) {
  return std::string_view(property.name).starts_with(text);
}

// What holds under every model, to the bit: R13.
bool holds_always(const properties::Property& property) {
  return std::string_view(property.name) == "repeat" || std::string_view(property.name) == "outputs";
}

// The frames of a property that is judged by its counts alone, each drawn by the rival with W / 2 for Z, so that no depth
// buffer and no clipping has a part, and each held to the model.
class JudgedFrames {
 public:
  JudgedFrames(const RivalSubject& subject, bool by_model) : subject_(subject), by_model_(by_model) {}

  Status draw(const Target& target, std::span<const Draw> draws) {
    if (const Status status = validate(target, draws); status != Status::ok) return status;
    const judge::Frame frame = frame_of(target, draws);
    // What a clipper cuts is for `clear-samples`, away from edges.
    if (!judge::why_open(subject_.terms, frame).empty() || leaves_open(draws)) {
      throw adapters::RivalSkips("open in every model");
    }
    std::vector<Draw> flat(draws.begin(), draws.end());
    std::vector<std::vector<Vertex>> vertices(draws.size());
    for (std::size_t d = 0; d < draws.size(); ++d) {
      if (draws[d].depth_mode == DepthMode::clip) continue;
      vertices[d].assign(draws[d].vertices.begin(), draws[d].vertices.end());
      for (Vertex& v : vertices[d]) v.z = std::isfinite(v.z) ? v.w / 2 : v.z;
      flat[d].vertices = vertices[d];
    }
    // The other outputs are those of an image without a model, so that what compares images looks at the rival's alone.
    Target rest = target;
    rest.count = {};
    if (!rest.index.empty() || !rest.depth.empty() || !rest.barycentrics.empty() || !rest.attributes.empty()) {
      properties::oracle_renderer()(rest, draws);
    }
    if (target.count.empty()) return Status::ok;
    Target counts = target;
    counts.index = {};
    counts.depth = counts.barycentrics = {};
    counts.attributes = {};
    subject_.rival->draw(counts, flat);
    if (!by_model_) return Status::ok;
    Image image;
    image.count.assign(target.count.begin(), target.count.end());
    const judge::Judgement judgement =
        judge::judge_image(adapters::oracle_expected(), subject_.terms,
                           {frame.width, frame.height, frame.samples, frame.depth_test, frame.initial_depth, flat},
                           image, {true, false}, {});
    samples_ += judgement.samples;
    open_ += judgement.open;
    differences_ += judgement.differences;
    if (finding_.empty()) finding_ = judgement.finding;
    return Status::ok;
  }

  CaseResult result() const {
    CaseResult result;
    result.samples = samples_;
    result.open = open_;
    result.differences = differences_;
    result.finding = finding_;
    result.skipped = samples_ == 0;
    return result;
  }

 private:
  const RivalSubject& subject_;
  bool by_model_;
  std::uint64_t samples_ = 0, open_ = 0, differences_ = 0;
  std::string finding_;
};

CaseResult result_of(const properties::TrialResult& verdict) {
  CaseResult result;
  result.samples = verdict.samples;
  result.differences = verdict.differences;
  result.finding = verdict.finding;
  result.skipped = verdict.samples == 0 && verdict.differences == 0;
  return result;
}

// Notes what a judged case needed.
CaseResult challenging(const RivalSubject& subject, const Scene& scene, CaseResult result) {
  if (result.samples == 0) return result;
  const corpus::Frame frame(scene, {false, false, false, false, true});
  *subject.challenged |= adapters::needed_features(frame.target(), frame.draws());
  return result;
}

CaseResult strict_property(const properties::Property& property, const Scene& scene, Rival& rival) {
  CaseResult result = result_of(property.decide(scene, adapters::rival_renderer(rival)));
  if (result.differences > 0 && property.decide(scene, adapters::model_renderer(rival)).differences > 0) {
    return not_applicable();
  }
  return result;
}

CaseResult model_property(const properties::Property& property, const Scene& scene, const RivalSubject& subject) {
  if (holds_always(property)) return result_of(property.decide(scene, adapters::rival_renderer(*subject.rival)));
  // What tiles no more, or not surely, is held to the model alone.
  const bool tiling = is_tiling(property) && still_tiles(scene, subject);
  JudgedFrames frames(subject, !tiling);
  const properties::Renderer renderer = [&frames](const Target& target, std::span<const Draw> draws) {
    return frames.draw(target, draws);
  };
  const properties::TrialResult verdict = property.decide(scene, renderer);
  return tiling ? result_of(verdict) : frames.result();
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// A vertex up to a positive power of two.
using Key = std::array<std::uint32_t, 3>;
Key key_of(const corpus::SceneVertex& v) {
  int exponent = 0;
  std::frexp(v.w, &exponent);
  const auto bits = [exponent](float value) {
    return std::bit_cast<std::uint32_t>(std::ldexp(value, -exponent) + 0.0f);
  };
  return {bits(v.x), bits(v.y), bits(v.w)};
}

}  // namespace

std::vector<std::string> not_challenged(const RivalSubject& subject) {
  std::vector<std::string> names;
  const std::uint32_t left = subject.rival->info().features & ~*subject.challenged;
  for (int bit = 0; bit < adapters::kFeatureBits; ++bit) {
    if (left >> bit & 1u) names.push_back(adapters::feature_name(bit));
  }
  return names;
}

bool is_tiling(const properties::Property& property) {
  return starts_with(property, "partition-");
}

CaseResult not_applicable() {
  CaseResult result;
  result.skipped = true;
  return result;
}

CaseResult guarded_case(const Scene& scene, const std::function<CaseResult()>& run) {
  CaseResult result;
  try {
    result = run();
  } catch (const adapters::RivalSkips&) {
    return not_applicable();
  } catch (const adapters::RivalFailure& failure) {
    result.differences = 1;
    result.finding = failure.what();
  }
  if (result.differences > 0 && !result.scene) result.scene = scene;
  return result;
}

corpus::Outputs outputs_with(const Rival& rival, const Scene& scene) {
  const auto has = [&rival](int output) { return (rival.info().outputs & static_cast<std::uint32_t>(output)) != 0; };
  corpus::Outputs outputs = properties::outputs_of(scene);
  outputs.index = outputs.index && has(SUREFILL_ADAPTER_INDEX);
  outputs.depth = outputs.depth && has(SUREFILL_ADAPTER_DEPTH);
  outputs.barycentrics = outputs.barycentrics && has(SUREFILL_ADAPTER_BARYCENTRICS);
  outputs.attributes = outputs.attributes && has(SUREFILL_ADAPTER_ATTRIBUTES);
  return outputs;
}

bool is_clipped(const Scene& scene) {
  const corpus::Frame frame(scene, {false, false, false, false, false});
  return leaves_open(frame.draws());
}

CaseResult judge_scene(const Scene& original, const RivalSubject& subject, const judge::Looks& looks) {
  const Scene scene = adapters::scene_under_model(original, subject.rival->info());
  // Section 6 has no grid for lines and points (M7), section 11 has.
  const bool lines = std::any_of(scene.draws.begin(), scene.draws.end(),
                                 [](const corpus::SceneDraw& draw) { return draw.primitive != Primitive::triangles; });
  const bool strict = subject.strict && !(lines && subject.rival->info().model.kind == SUREFILL_ADAPTER_MODEL_GRID);
  return challenging(subject, scene, guarded_case(scene, [&] {
                       return strict ? strict_case(scene, *subject.rival) : model_case(scene, subject, looks);
                     }));
}

bool is_judged(const properties::Property& property, const RivalSubject& subject) {
  if (property.needs_oracle) return false;
  if (subject.strict || holds_always(property)) return true;
  // Bits of depth and attributes are claimed by the profile exact alone; `values` and `alone` look at the others'.
  if (property.rule[0] == 'I' || !subject.terms.known) return false;
  return !is_tiling(property) || subject.terms.draws_own_rule ||
         oracle::watertight_rule(subject.terms.model).has_value();
}

CaseResult property_case(const properties::Property& property, const Scene& scene, const RivalSubject& subject) {
  return challenging(subject, scene, guarded_case(scene, [&] {
                       return subject.strict ? strict_property(property, scene, *subject.rival)
                                             : model_property(property, scene, subject);
                     }));
}

std::optional<properties::Exhibit> property_exhibit(const properties::Property& property, const Scene& scene,
                                                    const RivalSubject& subject) {
  if (subject.strict) return properties::exhibit_of(property, scene, adapters::rival_renderer(*subject.rival));
  JudgedFrames frames(subject, false);
  return properties::exhibit_of(property, scene, [&frames](const Target& target, std::span<const Draw> draws) {
    return frames.draw(target, draws);
  });
}

Scene with_flat_depth(Scene scene) {
  for (corpus::SceneDraw& draw : scene.draws) {
    if (draw.depth_mode == DepthMode::clip) continue;
    for (corpus::SceneVertex& v : draw.vertices) v.z = std::isfinite(v.z) ? v.w / 2 : v.z;
  }
  return scene;
}

bool may_turn(const Scene& scene, const RivalSubject& subject) {
  const corpus::Frame frame(scene, {false, false, false, false, false});
  const judge::Frame seen = frame_of(frame.target(), frame.draws());
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    const judge::Model model = judge::model_of_draw(subject.terms, seen, frame.draws()[d]);
    for (const corpus::SceneTriangle& triangle : scene.draws[d].triangles) {
      const std::array<Vertex, 3> t = properties::triangle_of(scene.draws[d], triangle);
      if (adapters::oracle_expected().may_turn(model, scene.width, scene.height, t)) return true;
    }
  }
  return false;
}

bool still_tiles(const Scene& original, const RivalSubject& subject) {
  const Scene scene = with_flat_depth(original);
  const corpus::Frame frame(scene, {false, false, false, false, false});
  const judge::Frame seen = frame_of(frame.target(), frame.draws());
  std::map<std::pair<Key, Key>, int> edges;
  std::map<Key, std::array<double, 2>> places;  // in pixels of the target: R3
  // How far from the middles of pixels a border is sampled: several samples, snapping and blur.
  const double around = scene.samples > 1 ? 0.5 : 0;
  double beside = around;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    const judge::Model model = judge::model_of_draw(subject.terms, seen, frame.draws()[d]);
    if (!oracle::watertight_rule(model) || model.culled != Cull::none) return false;
    for (const oracle::AxisModel* axis : {&model.x, &model.y}) {
      beside = std::max(beside, around + std::max(axis->blur, axis->divided_blur) + std::abs(axis->place - 0.5) +
                                    (axis->bits < 0 ? 0 : std::ldexp(1.0, -axis->bits)));
    }
    for (const corpus::SceneTriangle& triangle : scene.draws[d].triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const corpus::SceneVertex &p = scene.draws[d].vertices[triangle.vertices[i]],
                                  &q = scene.draws[d].vertices[triangle.vertices[(i + 1) % 3]];
        const Key a = key_of(p), b = key_of(q);
        const auto along = [](const oracle::AxisModel& axis, double at, int length) {
          return at * (length - axis.lacks) / length + axis.moved;
        };
        places[a] = {along(model.x, static_cast<double>(p.x) / p.w, scene.width),
                     along(model.y, static_cast<double>(p.y) / p.w, scene.height)};
        ++edges[std::minmax(a, b)];
      }
    }
  }
  if (may_turn(scene, subject)) return false;
  for (const auto& [ends, faces] : edges) {
    if (faces == 2) continue;
    const auto &p = places[ends.first], &q = places[ends.second];
    const double width = scene.width, height = scene.height;
    const bool outside = std::max(p[0], q[0]) < 0.5 - beside || std::min(p[0], q[0]) > width - 0.5 + beside ||
                         std::max(p[1], q[1]) < 0.5 - beside || std::min(p[1], q[1]) > height - 0.5 + beside;
    if (!outside) return false;
  }
  return true;
}

void draw_flat_frame(const Scene& scene, const RivalSubject& subject, bool near) {
  Scene flat = scene;
  flat.draws.assign(1, {});
  flat.attributes.clear();
  flat.initial_depth.clear();
  const double depth = near == (scene.depth_test == DepthTest::less) ? 0 : 1;
  judge::add_triangle(flat.draws[0], judge::over_all(scene.width, scene.height, depth), subject.terms.model.culled);
  flat = adapters::scene_under_model(flat, subject.rival->info());
  corpus::Frame frame(flat, outputs_with(*subject.rival, flat));
  subject.rival->draw(frame.target(), frame.draws());
}

CaseResult alone_case(const Scene& original, const RivalSubject& subject) {
  Rival& rival = *subject.rival;
  const Scene scene = adapters::scene_under_model(original, rival.info());
  if (scene.draws.size() != 1 || !scene.draws[0].depth_write || !scene.initial_depth.empty()) return not_applicable();
  const corpus::Frame plain(scene, {false, false, false, false, false});
  if (!subject.strict && !judge::why_open(subject.terms, frame_of(plain.target(), plain.draws())).empty()) {
    return not_applicable();
  }
  return guarded_case(scene, [&] {
    CaseResult result;
    properties::Exhibit exhibit{scene.width, scene.height, scene.samples, "", {}, {}, {}, {}};
    const auto mark = [&exhibit](const char* output, std::size_t sample) {
      if (exhibit.output.empty()) exhibit.output = output;
      if (exhibit.output == output) exhibit.differs[sample] = 1;
    };
    const auto differs = [&](const std::string& what, std::size_t sample, std::uint32_t triangle,
                             const std::string& expected, const std::string& actual, double error) {
      mark("values", sample);
      if (exhibit.values.empty() || exhibit.values.back().sample != sample) {
        exhibit.values.push_back({sample, what, expected, actual, std::isnan(error) ? HUGE_VAL : error});
      }
      if (result.differences++ > 0) return;
      const auto pixel = sample / static_cast<std::size_t>(scene.samples);
      const auto width = static_cast<std::size_t>(scene.width);
      result.finding = fmt::format("{} at pixel ({}, {}): drawn with the others, triangle {} is not as it is alone",
                                   what, pixel % width, pixel / width, triangle);
    };
    const std::uint32_t has = rival.info().outputs;
    const bool visible = (has & SUREFILL_ADAPTER_INDEX) && (has & SUREFILL_ADAPTER_DEPTH);
    corpus::Outputs outputs = outputs_with(rival, scene);
    if (!visible) outputs.index = outputs.depth = outputs.barycentrics = outputs.attributes = false;
    const auto draw = [&](const Scene& which) {
      corpus::Frame frame(which, outputs);
      if (validate(frame.target(), frame.draws()) != Status::ok) throw adapters::RivalSkips("not a frame");
      rival.draw(frame.target(), frame.draws());
      return std::move(frame.image());
    };
    const Image whole = draw(scene);
    const Image again = draw(scene);
    draw_flat_frame(scene, subject, true);
    const Image after = draw(scene);
    std::vector<Image> alone;
    std::vector<std::uint32_t> identifiers;
    for (std::size_t t = 0; t < scene.draws[0].triangles.size(); ++t) {
      Scene one = properties::with_one_triangle(scene, 0, t);
      identifiers.push_back(scene.draws[0].triangles[t].identifier.value_or(scene.draws[0].first_index.value_or(0) +
                                                                            static_cast<std::uint32_t>(t)));
      one.draws[0].first_index = one.draws[0].triangles[0].identifier ? std::nullopt : std::optional(identifiers[t]);
      alone.push_back(draw(one));
    }
    result.samples = whole.count.size();
    exhibit.actual = whole.count;
    exhibit.differs.assign(whole.count.size(), 0);
    for (std::size_t s = 0; s < whole.count.size(); ++s) {
      bool repeated = whole.count[s] == again.count[s];
      if (!whole.index.empty()) repeated = repeated && whole.index[s] == again.index[s];
      if (!whole.depth.empty()) repeated = repeated && same_bits(whole.depth[s], again.depth[s]);
      if (!repeated && result.differences++ == 0) result.finding = "drawn twice, the image is not the same";
      bool left_over = whole.count[s] != after.count[s];
      if (!whole.index.empty()) left_over = left_over || whole.index[s] != after.index[s];
      if (!whole.depth.empty()) left_over = left_over || !same_bits(whole.depth[s], after.depth[s]);
      if (repeated && left_over && result.differences++ == 0) {
        result.finding = fmt::format(
            "sample {}: drawn after a frame with a near triangle over all of it, the image is not the same", s);
      }
      if (!repeated || left_over) mark("values", s);
      std::uint32_t covers = 0;
      std::size_t nearest = alone.size();
      bool tied = false;
      for (std::size_t t = 0; t < alone.size(); ++t) {
        covers += alone[t].count[s];
        if (whole.index.empty() || alone[t].index[s] == kNoTriangle) continue;
        if (nearest == alone.size()) {
          nearest = t;
          continue;
        }
        const float a = alone[t].depth[s], b = alone[nearest].depth[s];
        const bool nearer = scene.depth_test == DepthTest::less ? a < b : a > b;
        tied = nearer ? false : tied || a == b;
        if (nearer || (a == b && identifiers[t] < identifiers[nearest])) nearest = t;
      }
      exhibit.expected.push_back(covers);
      if (covers != whole.count[s]) {
        mark("count", s);
        if (result.differences++ == 0) {
          result.finding =
              fmt::format("count at sample {}: {} triangles cover it when each is drawn alone, {} together", s, covers,
                          whole.count[s]);
        }
        continue;
      }
      if (whole.index.empty()) continue;
      // R12: of equal depths the first or the last comes, and what is equal as float32 may not be so in the buffer.
      if (tied && !subject.strict) {
        ++result.open;
        for (std::size_t t = 0; t < alone.size(); ++t) {
          if (identifiers[t] == whole.index[s] && alone[t].index[s] != kNoTriangle &&
              alone[t].depth[s] == alone[nearest].depth[s]) {
            nearest = t;
          }
        }
      }
      const std::uint32_t wanted = nearest == alone.size() ? kNoTriangle : identifiers[nearest];
      if (whole.index[s] != wanted) {
        const auto name = [](std::uint32_t index) { return index == kNoTriangle ? "none" : std::to_string(index); };
        differs("the visible triangle", s, wanted, name(wanted), name(whole.index[s]), 1);
        continue;
      }
      if (nearest == alone.size()) continue;
      const auto look = [&](const std::string& what, float expected, float actual) {
        if (same_bits(expected, actual)) return;
        differs(what, s, wanted, fmt::format("{:.9g}", expected), fmt::format("{:.9g}", actual),
                std::abs(double{actual} - expected));
      };
      look("depth", alone[nearest].depth[s], whole.depth[s]);
      for (std::size_t i = 0; !whole.barycentrics.empty() && i < 3; ++i) {
        look("barycentrics", alone[nearest].barycentrics[3 * s + i], whole.barycentrics[3 * s + i]);
      }
      for (std::size_t k = 0; k < whole.attributes.size(); ++k) {
        const std::size_t components = scene.attributes[k].components;
        for (std::size_t c = components * s; c < components * (s + 1); ++c) {
          look(scene.attributes[k].name, alone[nearest].attributes[k][c], whole.attributes[k][c]);
        }
      }
    }
    if (result.differences > 0) result.exhibit = std::move(exhibit);
    return result;
  });
}

}  // namespace surefill::certify
