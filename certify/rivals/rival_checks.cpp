// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/rival_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "certify/rivals/frame.hpp"
#include "certify/rivals/perspective_check.hpp"
#include "certify/rivals/profile.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::certify {

namespace {

using adapters::Rival;
using corpus::Image;
using corpus::Scene;

bool exact_profile(const Rival& rival) {
  return rival.info().model.profile == SUREFILL_ADAPTER_PROFILE_EXACT;
}

bool known_model(const Rival& rival) {
  return rival.info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN;
}

bool is_open(const Scene& scene) {
  const corpus::Frame frame(scene, {false, false, false, false, false});
  return leaves_open(frame.draws());
}

CaseResult skipped_case() {
  CaseResult result;
  result.skipped = true;
  return result;
}

// One case: what a rival does wrong on the way is a finding with this scene.
template <typename Run>
CaseResult rival_case(const Scene& scene, const Run& run) {
  CaseResult result;
  try {
    result = run();
  } catch (const adapters::RivalSkips&) {
    return skipped_case();
  } catch (const adapters::RivalFailure& failure) {
    result.differences = 1;
    result.finding = failure.what();
  }
  if (result.differences > 0) result.scene = scene;
  return result;
}

CaseResult result_of(const properties::TrialResult& verdict) {
  CaseResult result;
  result.samples = verdict.samples;
  result.differences = verdict.differences;
  result.finding = verdict.finding;
  return result;
}

// The rival's frames that a property judges; what its profile leaves open is skipped.
properties::Renderer judged_renderer(Rival& rival) {
  const bool exact = exact_profile(rival);
  const std::uint32_t judged = exact ? adapters::kAllOutputs : static_cast<std::uint32_t>(SUREFILL_ADAPTER_COUNT);
  return [&rival, exact, renderer = adapters::rival_renderer(rival, judged)](const Target& target,
                                                                             std::span<const Draw> draws) {
    // How precise depth is at the planes of depth clipping is open, too.
    const bool clips =
        std::any_of(draws.begin(), draws.end(), [](const Draw& draw) { return draw.depth_mode == DepthMode::clip; });
    if (!exact && (clips || leaves_open(draws) || out_of_range(draws) ||
                   !projects_clearly(adapters::under_model(draws, rival.info())))) {
      throw adapters::RivalSkips("open in its profile");
    }
    return renderer(target, draws);
  };
}

// A property on one case. It is owed where the oracle has it under the rival's model: a mesh, say, that still tiles
// when it is snapped.
CaseResult property_case(const properties::Property& property, const Scene& scene, Rival& rival) {
  return rival_case(scene, [&] {
    CaseResult result = result_of(property.decide(scene, judged_renderer(rival)));
    if (result.differences > 0 && property.decide(scene, adapters::model_renderer(rival)).differences > 0) {
      return skipped_case();
    }
    return result;
  });
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// The image of a draw and those of its triangles, each drawn alone.
CaseResult alone_case(const Scene& original, Rival& rival) {
  const Scene scene = adapters::scene_under_model(original, rival.info());
  if (scene.draws.size() != 1 || !scene.draws[0].depth_write || !scene.initial_depth.empty()) return skipped_case();
  const corpus::Frame plain(scene, {false, false, false, false, false});
  if (!exact_profile(rival) && out_of_range(plain.draws())) return skipped_case();
  return rival_case(scene, [&] {
    CaseResult result;
    properties::Exhibit exhibit{scene.width, scene.height, scene.samples, "", {}, {}, {}};
    const auto mark = [&exhibit](const char* output, std::size_t sample) {
      if (exhibit.output.empty()) exhibit.output = output;
      if (exhibit.output == output) exhibit.differs[sample] = 1;
    };
    const auto differs = [&](const std::string& what, std::size_t sample, std::uint32_t triangle) {
      mark("values", sample);
      if (result.differences++ > 0) return;
      const auto pixel = sample / static_cast<std::size_t>(scene.samples);
      const auto width = static_cast<std::size_t>(scene.width);
      result.finding = fmt::format("{} at pixel ({}, {}): drawn with the others, triangle {} is not as it is alone",
                                   what, pixel % width, pixel / width, triangle);
    };
    const std::uint32_t has = rival.info().outputs;
    const bool visible = (has & SUREFILL_ADAPTER_INDEX) && (has & SUREFILL_ADAPTER_DEPTH);
    corpus::Outputs outputs = properties::outputs_of(scene);
    outputs.index = outputs.index && visible;
    outputs.depth = outputs.depth && visible;
    outputs.barycentrics = outputs.barycentrics && visible && (has & SUREFILL_ADAPTER_BARYCENTRICS);
    outputs.attributes = outputs.attributes && visible && (has & SUREFILL_ADAPTER_ATTRIBUTES);
    const auto draw = [&](const Scene& which) {
      corpus::Frame frame(which, outputs);
      if (validate(frame.target(), frame.draws()) != Status::ok) throw adapters::RivalSkips("not a frame");
      rival.draw(frame.target(), frame.draws());
      return std::move(frame.image());
    };
    const Image whole = draw(scene);
    const Image again = draw(scene);
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
      if (!repeated) mark("values", s);
      std::uint32_t covers = 0;
      std::size_t nearest = alone.size();
      for (std::size_t t = 0; t < alone.size(); ++t) {
        covers += alone[t].count[s];
        if (whole.index.empty() || alone[t].index[s] == kNoTriangle) continue;
        if (nearest == alone.size()) {
          nearest = t;
          continue;
        }
        const float a = alone[t].depth[s], b = alone[nearest].depth[s];
        const bool nearer = scene.depth_test == DepthTest::less ? a < b : a > b;
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
      const std::uint32_t wanted = nearest == alone.size() ? kNoTriangle : identifiers[nearest];
      if (whole.index[s] != wanted) {
        differs("the visible triangle", s, wanted);
        continue;
      }
      if (nearest == alone.size()) continue;
      if (!same_bits(whole.depth[s], alone[nearest].depth[s])) differs("depth", s, wanted);
      for (std::size_t i = 0; !whole.barycentrics.empty() && i < 3; ++i) {
        if (!same_bits(whole.barycentrics[3 * s + i], alone[nearest].barycentrics[3 * s + i])) {
          differs("barycentrics", s, wanted);
        }
      }
      for (std::size_t k = 0; k < whole.attributes.size(); ++k) {
        const std::size_t components = scene.attributes[k].components;
        for (std::size_t c = components * s; c < components * (s + 1); ++c) {
          if (!same_bits(whole.attributes[k][c], alone[nearest].attributes[k][c])) {
            differs(scene.attributes[k].name, s, wanted);
          }
        }
      }
    }
    if (result.differences > 0) result.exhibit = std::move(exhibit);
    return result;
  });
}

// A rasterizer that is not exact may have a depth buffer of 0 to 1 and no subnormals: depths come into that range (with
// a vertex behind the eye, they become 1/2 throughout), attributes out of range become 1.
void make_ordinary(corpus::SceneDraw& draw) {
  const bool front = std::all_of(draw.vertices.begin(), draw.vertices.end(), [](const auto& v) { return v.w > 0; });
  for (corpus::SceneVertex& v : draw.vertices) {
    if (!draw.viewport) v.z = front ? std::clamp(v.z, 0.0f, v.w) : v.w / 2;
    for (float& value : v.attributes) {
      const float magnitude = std::abs(value);
      if (value != 0 && !(magnitude >= 0x1p-32f && magnitude <= 0x1p32f)) value = 1;
    }
  }
}

// What random scenes may hold, so that few of them are skipped: every second one is plain.
Scene scene_for(const Rival& rival, std::uint64_t number, std::uint64_t seed) {
  const std::uint32_t features = rival.info().features;
  properties::SceneLimits limits;
  limits.state = number % 2 == 1;
  limits.attributes = (rival.info().outputs & SUREFILL_ADAPTER_ATTRIBUTES) != 0;
  limits.samples = number % 4 == 1 && (features & SUREFILL_ADAPTER_SAMPLES);
  limits.grid = (features & SUREFILL_ADAPTER_GRIDS) != 0;
  limits.conservative = number % 4 == 3 && (features & SUREFILL_ADAPTER_OVER);
  const auto categories = properties::categories();
  Scene scene = properties::random_scene(categories[number / 4 % categories.size()], seed, limits);
  // What it lacks and does not change what the case aims at.
  for (corpus::SceneAttribute& attribute : scene.attributes) {
    const bool lacks =
        (attribute.interpolation == Interpolation::noperspective && !(features & SUREFILL_ADAPTER_NOPERSPECTIVE)) ||
        (attribute.interpolation == Interpolation::flat && !(features & SUREFILL_ADAPTER_FLAT));
    if (lacks) attribute.interpolation = Interpolation::perspective;
  }
  if (!(features & SUREFILL_ADAPTER_INITIAL_DEPTH)) scene.initial_depth.clear();
  for (corpus::SceneDraw& draw : scene.draws) {
    if (!(features & SUREFILL_ADAPTER_DEPTH_READ_ONLY)) draw.depth_write = true;
    if (!exact_profile(rival)) make_ordinary(draw);
  }
  return scene;
}

// One triangle without state, of a kind that programs draw.
Scene ordinary_scene(const Rival& rival, std::uint64_t number, std::uint64_t seed) {
  properties::SceneLimits limits;
  limits.max_triangles = 1;
  limits.state = false;
  limits.attributes = (rival.info().outputs & SUREFILL_ADAPTER_ATTRIBUTES) != 0;
  const auto categories = properties::categories();
  const std::string_view wanted = number % 2 == 0 ? "ordinary" : "perspective";
  const auto kind = std::find_if(categories.begin(), categories.end(),
                                 [wanted](const properties::Category& category) { return category.name == wanted; });
  Scene scene = properties::random_scene(*kind, seed, limits);
  for (corpus::SceneDraw& draw : scene.draws) make_ordinary(draw);
  return scene;
}

// Is every triangle, as projected, a pixel high and more?
bool pixels_high(const Scene& scene) {
  const corpus::SceneDraw& draw = scene.draws[0];
  return std::all_of(draw.triangles.begin(), draw.triangles.end(), [&draw](const corpus::SceneTriangle& triangle) {
    std::array<double, 3> x{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
      const corpus::SceneVertex& v = draw.vertices[triangle.vertices[i]];
      x[i] = static_cast<double>(v.x) / v.w;
      y[i] = static_cast<double>(v.y) / v.w;
    }
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, std::hypot(x[(i + 1) % 3] - x[i], y[(i + 1) % 3] - y[i]));
    }
    return std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) >= longest;
  });
}

// A scene that kills the rival is made smaller, too, and then deaths do not count; but not where every scene kills it.
template <typename Fails>
std::function<bool(const Scene&)> reducible(Rival& rival, const Fails& fails) {
  return [&rival, fails](const Scene& scene) {
    const Rival::Uncounted uncounted(rival);
    return rival.is_reducible() && fails(scene);
  };
}

class List {
 public:
  List(const Settings& settings, const RivalSubject& subject) : settings_(settings), subject_(subject) {}

  Check& add(const char* group, const std::string& name, const std::string& rule, const std::string& claim,
             std::uint64_t cases) {
    Check& check = checks_.emplace_back(make_check(name, rule, claim));
    check.group = group;
    check.unit = "scenes";
    check.cost = subject_.slow ? 1e-2 : 5e-4;
    check.prepare = [cases] { return cases; };
    check.replay_option = subject_.replay_option;
    Rival& rival = *subject_.rival;
    check.stopped = [&rival] { return rival.given_up() ? rival.why_given_up() : std::string(); };
    check.describe = [&rival](const Scene& scene) { return compare_rival(scene, rival).finding; };
    check.expected = adapters::model_renderer(rival);
    check.actual = adapters::rival_renderer(rival);
    return check;
  }

  // A check whose cases are random scenes, each decided alone.
  template <typename Decide>
  void add_random(const char* group, const std::string& name, const std::string& rule, const std::string& claim,
                  std::uint64_t cases, const Decide& decide) {
    Check& check = add(group, name, rule, claim, cases);
    Rival& rival = *subject_.rival;
    check.run = [this_seed = settings_.seed, &rival, decide, name](std::uint64_t number) {
      return decide(scene_for(rival, number, case_seed(this_seed, name, number)), rival);
    };
    check.still_fails =
        reducible(rival, [&rival, decide](const Scene& scene) { return decide(scene, rival).differences > 0; });
    check.describe = [&rival, decide](const Scene& scene) { return decide(scene, rival).finding; };
  }

  std::uint64_t cases() const {
    return subject_.slow ? by_level<std::uint64_t>(settings_.level, 60, 1500, 50000)
                         : by_level<std::uint64_t>(settings_.level, 300, 5000, 200000);
  }

  void add_invariants() {
    Rival& rival = *subject_.rival;
    for (const properties::Property& property : properties::all_properties()) {
      if (property.needs_oracle) continue;
      // Bits of depth and attributes are claimed by the profile exact alone; `values` and `alone` look at the others'.
      if (!exact_profile(rival) && property.rule[0] == 'I') continue;
      const std::string name = property.name;
      Check& check = add(kInvariants, name, property.rule, property.claim, cases());
      check.run = [seed = settings_.seed, &property, &rival, name](std::uint64_t number) {
        std::uint64_t which = case_seed(seed, name, number);
        if (property.exhaustive > 0) which %= property.exhaustive;
        return property_case(property, property.make(which), rival);
      };
      const bool simplifies = property.simplifies;
      // A mesh that loses a triangle tiles no more, so what is left is held against the model.
      const auto compare = [&rival](const Scene& scene) {
        RivalJudgement judgement;
        judgement.values = false;
        judgement.certain_only = !known_model(rival);
        return compare_rival(scene, rival, judgement);
      };
      check.still_fails = reducible(rival, [&property, &rival, simplifies, compare](const Scene& scene) {
        return (simplifies ? property_case(property, scene, rival) : compare(scene)).differences > 0;
      });
      check.describe = [&property, &rival, simplifies, compare](const Scene& scene) {
        return (simplifies ? property_case(property, scene, rival) : compare(scene)).finding;
      };
      if (simplifies) {
        check.exhibit = [&property, &rival](const Scene& scene) {
          return properties::exhibit_of(property, scene, judged_renderer(rival));
        };
      }
    }
    if (!subject_.slow) {
      Check& check = add(kInvariants, "mesh-perspective", "T1", "", 0);
      make_perspective_check(settings_, rival, check);
    }
    if (subject_.reported_bits > 0) add_precision_check();
    add_random(kInvariants, "clear-samples", "C2",
               "samples 1/16 pixel and more away from all edges are covered as often as triangles lie over them",
               cases() * 8, [](const Scene& scene, Rival& r) {
                 return compare_rival(scene, r, {true, false, true});
               });
    add_random(kInvariants, "alone", "T5, V1",
               "an image is what its triangles drawn alone make of it, to the bit, and the same when drawn again",
               cases() * 2, alone_case);
    checks_.back().exhibit = [&rival](const Scene& scene) { return alone_case(scene, rival).exhibit; };
    const std::string granted = adapters::profile_name(rival.info().model.profile);
    add_values("values",
               "where one triangle is visible, its index, depth and attributes are within what the profile " + granted +
                   " grants",
               false);
    if (exact_profile(rival)) return;
    add_values("values-clipped", "the same with vertices behind the eye or beyond the guard band", true);
    const std::string name = "values-ordinary";
    add_values(name, "the same on random triangles a pixel high and more, each alone and in front of the eye", false);
    checks_.back().run = [seed = settings_.seed, &rival, name](std::uint64_t number) {
      const Scene scene = ordinary_scene(rival, number, case_seed(seed, name, number));
      if (!known_model(rival) || is_open(scene) || !pixels_high(scene)) return skipped_case();
      return compare_rival(scene, rival, {false, true, false});
    };
  }

  // Exact profiles have one check of values, others two: apart from those of triangles that a clipper cuts.
  void add_values(const std::string& name, const std::string& claim, bool clipped) {
    const bool all = exact_profile(*subject_.rival);
    add_random(kInvariants, name, "I1-I4", claim, cases() * 8, [all, clipped](const Scene& scene, Rival& r) {
      if (!known_model(r)) return skipped_case();
      if (!all && is_open(scene) != clipped) return skipped_case();
      return compare_rival(scene, r, {false, true, false});
    });
  }

  void add_precision_check() {
    const bool strict = subject_.rival->info().model.profile == SUREFILL_ADAPTER_PROFILE_VULKAN;
    Check& check = add(kInvariants, "precision", "6",
                       fmt::format("positions have the {} bits of subpixel precision that it reports{}",
                                   subject_.reported_bits, strict ? ", and no others" : ", or more"),
                       1);
    check.unit = "rasterizer";
    check.exhaustive = true;
    check.run = [&subject = subject_, strict](std::uint64_t) {
      const surefill_adapter_model& model = subject.inference.model;
      if (!subject.inference.fits) return skipped_case();
      CaseResult result;
      result.samples = 1;
      const bool grid = model.kind == SUREFILL_ADAPTER_MODEL_GRID;
      if (grid && model.grid_bits >= subject.reported_bits && (!strict || model.grid_bits == subject.reported_bits)) {
        return result;
      }
      if (!grid && !strict) return result;
      result.differences = 1;
      result.finding = "probing finds " + adapters::describe_model(model);
      return result;
    };
    check.still_fails = nullptr;
  }

  void add_model_check() {
    Check& check = add(kExactModel, "model", "C3, 6",
                       subject_.declared ? "the model that it declares is the one that probing finds"
                                         : "a model explains all that probing finds",
                       1);
    check.unit = "rasterizer";
    check.exhaustive = true;
    check.run = [&subject = subject_](std::uint64_t) {
      CaseResult result;
      result.samples = 1;
      const adapters::Inference& found = subject.inference;
      if (!found.problems.empty()) {
        result.finding = found.problems.front();
      } else if (subject.declared && !adapters::same_coverage(found.model, subject.rival->info().model)) {
        result.finding =
            fmt::format("it declares {}; probing finds {}", adapters::describe_model(subject.rival->info().model),
                        adapters::describe_model(found.model));
      }
      result.differences = result.finding.empty() ? 0 : 1;
      return result;
    };
    check.still_fails = nullptr;
  }

  void add_exact_model() {
    add_model_check();
    Rival& rival = *subject_.rival;
    const auto equal = [](const Scene& scene, Rival& r) {
      if (!known_model(r) || (!exact_profile(r) && is_open(scene))) return skipped_case();
      return compare_rival(scene, r, {false, exact_profile(r), true});
    };
    const char* claim = exact_profile(rival) ? "every output is the oracle's under the model, bit for bit"
                                             : "coverage is the oracle's under the model, sample by sample";
    const auto scenes = std::make_shared<std::vector<std::pair<std::string, Scene>>>();
    Check& check = add(kExactModel, "model-corpus", "all rules", std::string(claim) + ", on the corpus", 0);
    check.exhaustive = true;
    check.prepare = [&settings = settings_, scenes] {
      if (scenes->empty()) {
        for (const std::string& path : corpus::list_corpus(settings.corpus + "/cases")) {
          scenes->emplace_back(path.substr(path.rfind('/') + 1), corpus::read_scene_file(path));
        }
      }
      return std::uint64_t{scenes->size()};
    };
    check.run = [scenes, equal, &rival](std::uint64_t number) {
      const auto& [name, scene] = (*scenes)[number];
      for (const corpus::SceneDraw& draw : scene.draws) {
        if (!draw.points.empty() || !draw.lines.empty()) return skipped_case();
      }
      CaseResult result = equal(scene, rival);
      if (result.differences > 0) result.finding = name + ": " + result.finding;
      return result;
    };
    check.still_fails =
        reducible(rival, [equal, &rival](const Scene& scene) { return equal(scene, rival).differences > 0; });
    add_random(kExactModel, "model-random", "all rules", std::string(claim) + ", on hard triangles of all kinds",
               cases() * 16, equal);
    for (const properties::Property& property : properties::all_properties()) {
      if (!property.needs_oracle || property.exhaustive == 0) continue;
      const std::string name = std::string("model-") + property.name;
      const std::uint64_t number_of = std::min(property.exhaustive, cases() * 4);
      Check& world = add(kExactModel, name, property.rule, std::string(claim) + ", on a small world", number_of);
      world.exhaustive = number_of == property.exhaustive;
      world.run = [seed = settings_.seed, &property, &rival, equal, name,
                   all = world.exhaustive](std::uint64_t number) {
        return equal(property.make(all ? number : case_seed(seed, name, number) % property.exhaustive), rival);
      };
      world.still_fails =
          reducible(rival, [equal, &rival](const Scene& scene) { return equal(scene, rival).differences > 0; });
    }
  }

  std::vector<Check> take() { return std::move(checks_); }

 private:
  const Settings& settings_;
  const RivalSubject& subject_;
  std::vector<Check> checks_;
};

}  // namespace

namespace {

// The least that can be asked for: one triangle on the screen.
bool draws_one_triangle(Rival& rival) {
  Scene scene;
  scene.width = scene.height = 4;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices = {{0.25f, 0.25f, 0.5f, 1, {}}, {3.75f, 0.25f, 0.5f, 1, {}}, {0.25f, 3.75f, 0.5f, 1, {}}};
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  corpus::Frame frame(scene, {true, false, false, false, false});
  try {
    rival.draw(frame.target(), frame.draws());
    return true;
  } catch (const adapters::RivalFailure&) {
    return false;
  }
}

}  // namespace

RivalSubject meet_rival(Rival& rival) {
  RivalSubject subject;
  subject.rival = &rival;
  subject.declared = known_model(rival);
  if (!subject.declared) subject.reported_bits = rival.info().model.grid_bits;
  try {
    // One that dies on the first probe is asked for less, and once more: if it draws nothing, there is nothing to
    // judge.
    for (bool probed = false; !probed;) {
      try {
        subject.inference = adapters::infer_model(rival);
        probed = true;
      } catch (const adapters::RivalFailure&) {
        if (rival.has_drawn() || rival.given_up() || draws_one_triangle(rival)) throw;
      }
    }
  } catch (const adapters::RivalFailure& failure) {
    // The checks go on where it has drawn something: they have the scenes that show it.
    subject.inference.model = rival.info().model;
    subject.inference.problems = {std::string("when probed, ") + failure.what()};
  } catch (const adapters::RivalSkips& lacking) {
    subject.inference.model = rival.info().model;
    subject.inference.problems = {std::string("a probe was not drawn: ") + lacking.what()};
  }
  if (!subject.declared) {
    rival.set_model(subject.inference.model);
  }
  return subject;
}

std::vector<Check> list_rival_checks(const Settings& settings, const RivalSubject& subject) {
  List list(settings, subject);
  list.add_invariants();
  list.add_exact_model();
  return list.take();
}

}  // namespace surefill::certify
