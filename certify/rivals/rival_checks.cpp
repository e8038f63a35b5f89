// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/rival_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "certify/judge/lines.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/layers.hpp"
#include "certify/rivals/line_checks.hpp"
#include "certify/rivals/tilings_check.hpp"
#include "certify/rivals/viewports.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::certify {

namespace {

using adapters::Rival;
using corpus::Scene;

bool exact_profile(const Rival& rival) {
  return rival.info().model.profile == SUREFILL_ADAPTER_PROFILE_EXACT;
}

// A rasterizer that is not exact may have a depth buffer of 0 to 1 and no subnormals: depths come into that range (with
// a vertex behind the eye, they become 1/2 throughout), attributes out of range become 1. What claims to clamp or clip
// depth keeps depths beyond the range, in draws that ask for it.
void make_ordinary(corpus::SceneDraw& draw, std::uint32_t features) {
  const bool front =
      std::all_of(draw.vertices.begin(), draw.vertices.end(), [](const auto& v) { return v.w > 0 || std::isnan(v.w); });
  const bool beyond = front && ((draw.depth_mode == DepthMode::clamp && (features & SUREFILL_ADAPTER_DEPTH_CLAMP)) ||
                                (draw.depth_mode == DepthMode::clip && (features & SUREFILL_ADAPTER_DEPTH_CLIP)));
  for (corpus::SceneVertex& v : draw.vertices) {
    const bool stays = !std::isfinite(v.z) && (features & SUREFILL_ADAPTER_NON_FINITE);
    if (!draw.viewport && !stays)
      v.z = !front ? v.w / 2 : beyond ? std::clamp(v.z, -v.w, 2 * v.w) : std::clamp(v.z, 0.0f, v.w);
    for (float& value : v.attributes) {
      const float magnitude = std::abs(value);
      if (!std::isfinite(value) && (features & SUREFILL_ADAPTER_NON_FINITE)) continue;
      if (value != 0 && !(magnitude >= 0x1p-32f && magnitude <= 0x1p32f)) value = 1;
    }
  }
}

// What random scenes may hold, so that few of them are skipped: every second one is plain.
Scene scene_for(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  const Rival& rival = *subject.rival;
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
    if (!subject.strict) make_ordinary(draw, features);
  }
  return scene;
}

// One triangle without state, of a kind that programs draw.
Scene ordinary_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  properties::SceneLimits limits;
  limits.max_triangles = 1;
  limits.state = false;
  limits.attributes = (subject.rival->info().outputs & SUREFILL_ADAPTER_ATTRIBUTES) != 0;
  const auto categories = properties::categories();
  const std::string_view wanted = number % 2 == 0 ? "ordinary" : "perspective";
  const auto kind = std::find_if(categories.begin(), categories.end(),
                                 [wanted](const properties::Category& category) { return category.name == wanted; });
  Scene scene = properties::random_scene(*kind, seed, limits);
  for (corpus::SceneDraw& draw : scene.draws) make_ordinary(draw, 0);
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
    check.describe = [&subject = subject_](const Scene& scene) { return judge_scene(scene, subject).finding; };
    check.exhibit = [&subject = subject_](const Scene& scene) { return judge_scene(scene, subject).exhibit; };
    check.expected = adapters::model_renderer(rival);
    check.actual = adapters::rival_renderer(rival);
    return check;
  }

  // A check whose cases are scenes made from a number and a seed, each decided alone.
  template <typename Make, typename Decide>
  void add_scenes(const char* group, const std::string& name, const std::string& rule, const std::string& claim,
                  std::uint64_t cases, const Make& make, const Decide& decide) {
    Check& check = add(group, name, rule, claim, cases);
    const RivalSubject& subject = subject_;
    check.scene_of = [this_seed = settings_.seed, &subject, make, name](std::uint64_t number) {
      return make(subject, number, case_seed(this_seed, name, number));
    };
    check.run = [&subject, decide, scene_of = check.scene_of](std::uint64_t number) {
      return decide(scene_of(number), subject);
    };
    check.still_fails = reducible(
        *subject.rival, [&subject, decide](const Scene& scene) { return decide(scene, subject).differences > 0; });
    check.describe = [&subject, decide](const Scene& scene) { return decide(scene, subject).finding; };
    check.exhibit = [&subject, decide](const Scene& scene) { return decide(scene, subject).exhibit; };
  }

  std::uint64_t cases() const {
    return subject_.slow ? by_level<std::uint64_t>(settings_.level, 60, 1500, 50000)
                         : by_level<std::uint64_t>(settings_.level, 300, 5000, 200000);
  }

  void add_property(const properties::Property& property) {
    const RivalSubject& subject = subject_;
    const std::string name = property.name;
    // Where there is nothing to judge one case says so.
    Check& check = add(kInvariants, name, property.rule, property.claim, is_judged(property, subject) ? cases() : 1);
    // A mesh that loses a triangle tiles no more, so what is left is held against the model.
    const bool tiles = is_tiling(property) && !subject.strict;
    check.scene_of = [seed = settings_.seed, &property, name, tiles](std::uint64_t number) {
      std::uint64_t which = case_seed(seed, name, number);
      if (property.exhaustive > 0) which %= property.exhaustive;
      // As it is drawn, so that whoever reduces or replays it draws the same.
      return tiles ? with_flat_depth(property.make(which)) : property.make(which);
    };
    check.run = [&property, &subject, scene_of = check.scene_of](std::uint64_t number) {
      if (!is_judged(property, subject)) return not_applicable();
      return property_case(property, scene_of(number), subject);
    };
    const bool simplifies = property.simplifies;
    const auto decide = [&property, &subject, simplifies, tiles](const Scene& scene) {
      if (tiles) {
        CaseResult result;
        result.finding = crack_in(subject, scene);
        result.differences = result.finding.empty() ? 0 : 1;
        if (result.differences > 0) return result;
      }
      return simplifies ? property_case(property, scene, subject) : judge_scene(scene, subject, {true, false});
    };
    check.still_fails =
        reducible(*subject.rival, [decide](const Scene& scene) { return decide(scene).differences > 0; });
    check.describe = [decide](const Scene& scene) { return decide(scene).finding; };
    if (simplifies) {
      check.exhibit = [&property, &subject](const Scene& scene) { return property_exhibit(property, scene, subject); };
    }
  }

  void add_invariants() {
    for (const properties::Property& property : properties::all_properties()) {
      if (property.needs_oracle || (!subject_.strict && property.rule[0] == 'I')) continue;
      add_property(property);
    }
    Check& tilings = add(kInvariants, "tilings", "T1", "", 0);
    make_tilings_check(settings_, subject_, tilings);
    if (subject_.reported_bits > 0) add_precision_check();
    add_scenes(kInvariants, "clear-samples", "C2, R9, R13",
               subject_.terms.known
                   ? "away from the edges of triangles that are clipped, samples are covered as often as "
                     "triangles lie over them"
                   : "samples far from all edges are covered as often as triangles lie over them",
               cases() * 8, scene_for, [](const Scene& scene, const RivalSubject& subject) {
                 if (subject.terms.known && !is_clipped(scene)) return not_applicable();
                 if (!subject.strict) return judge_scene(scene, subject, {true, false});
                 RivalSubject open = subject;
                 open.strict = false;
                 return judge_scene(scene, open, {true, false});
               });
    if (subject_.rival->info().form == SUREFILL_ADAPTER_FORM_CLIP) {
      add_scenes(kInvariants, "viewports", "S3",
                 "under viewports of any place and size inside the target it draws what it draws under large ones",
                 cases() * 2, viewport_scene,
                 [](const Scene& scene, const RivalSubject& subject) { return judge_scene(scene, subject); });
    }
    add_scenes(kInvariants, "alone", "T5, V1",
               "an image is what its triangles drawn alone make of it, to the bit, and the same when drawn again",
               cases() * 2, scene_for, alone_case);
    add_scenes(kInvariants, "layers", "V1, V3, M5, R12",
               "of large triangles in several draws, whose depths lie clearly apart, the visible one is what the depth "
               "test, depth write and initial depth make it, with values as its own draw interpolates them",
               cases(), layers_scene, layers_case);
    add_values();
  }

  // Strict rivals have one check of values, others two: apart from those of triangles that a clipper cuts.
  void add_values() {
    const std::string granted = adapters::profile_name(subject_.rival->info().model.profile);
    const std::string claim =
        "where one triangle is visible, its index, depth and attributes are within what the profile " + granted +
        " grants";
    if (subject_.strict) {
      add_scenes(kInvariants, "values", "I1-I4", claim, cases() * 8, scene_for,
                 [](const Scene& scene, const RivalSubject& subject) { return judge_scene(scene, subject); });
      return;
    }
    const auto look = [](bool clipped) {
      return [clipped](const Scene& scene, const RivalSubject& subject) {
        const std::uint32_t has = subject.rival->info().outputs;
        if (is_clipped(scene) != clipped || (has & ~static_cast<std::uint32_t>(SUREFILL_ADAPTER_COUNT)) == 0) {
          return not_applicable();
        }
        return judge_scene(scene, subject, {false, true});
      };
    };
    add_scenes(kInvariants, "values", "I1-I3, R11", claim, cases() * 8, scene_for, look(false));
    add_scenes(kInvariants, "values-clipped", "I1-I3, R11",
               "the same with vertices behind the eye or beyond the guard band", cases() * 8, scene_for, look(true));
    add_scenes(kInvariants, "values-ordinary", "I1-I3, R11",
               "the same on random triangles a pixel high and more, each alone and in front of the eye", cases() * 8,
               ordinary_scene, [look](const Scene& scene, const RivalSubject& subject) {
                 return pixels_high(scene) ? look(false)(scene, subject) : not_applicable();
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
      const judge::Inference& found = subject.inference.judged;
      if (!found.known) return not_applicable();
      CaseResult result;
      result.samples = 1;
      const auto reported = static_cast<int>(subject.reported_bits);
      const auto good = [&](const oracle::AxisModel& axis) {
        return axis.bits < 0 ? !strict : strict ? axis.bits == reported : axis.bits >= reported;
      };
      if (good(found.model.x) && good(found.model.y)) return result;
      result.differences = 1;
      result.finding = "probing finds " + judge::describe(found.model);
      return result;
    };
    check.still_fails = nullptr;
  }

  void add_model_check() {
    Check& check = add(kModel, "model", "C3, 6, 11",
                       subject_.declared ? "the model that it declares is the one that probing finds"
                                         : "a model explains all that probing finds",
                       1);
    check.unit = "rasterizer";
    check.exhaustive = true;
    check.run = [&subject = subject_](std::uint64_t) {
      const adapters::Inference& found = subject.inference;
      CaseResult result;
      result.samples = 1;
      if (!found.problems.empty()) {
        result.finding = found.problems.front();
      } else if (!found.judged.known) {
        return not_applicable();
      } else if (subject.declared) {
        const judge::Model declared = subject.rival->stated().value_or(adapters::model_of(subject.rival->info().model));
        std::vector<std::string> sentences = judge::differences(declared, found.judged.model);
        if (subject.rival->stated()) {
          for (const std::string& sentence :
               judge::line_differences(declared, found.judged.model, primitives_of(*subject.rival))) {
            sentences.push_back(sentence);
          }
        }
        if (found.model.y != subject.rival->info().model.y) {
          sentences.push_back(found.model.y == SUREFILL_ADAPTER_Y_UP ? "the first row is the bottom one"
                                                                     : "the first row is the top one");
        }
        for (const std::string& sentence : sentences) result.finding += (result.finding.empty() ? "" : "; ") + sentence;
        if (!sentences.empty()) {
          result.finding =
              "it declares " + adapters::declared_model(*subject.rival) + "; probing finds that " + result.finding;
        }
      }
      result.differences = result.finding.empty() ? 0 : 1;
      return result;
    };
    check.still_fails = nullptr;
  }

  void add_model() {
    add_model_check();
    const RivalSubject& subject = subject_;
    const auto equal = [](const Scene& scene, const RivalSubject& s) {
      if (!s.strict && (!s.terms.known || is_clipped(scene))) return not_applicable();
      return judge_scene(scene, s, {true, s.strict});
    };
    const char* claim = subject.strict ? "every output is the oracle's under the model, bit for bit"
                                       : "coverage is what the model says, sample by sample";
    const auto scenes = std::make_shared<std::vector<std::pair<std::string, Scene>>>();
    Check& check = add(kModel, "model-corpus", "all rules", std::string(claim) + ", on the corpus", 0);
    check.exhaustive = true;
    check.prepare = [&settings = settings_, scenes] {
      if (scenes->empty()) {
        for (const std::string& path : corpus::list_corpus(settings.corpus + "/cases")) {
          scenes->emplace_back(path.substr(path.rfind('/') + 1), corpus::read_scene_file(path));
        }
      }
      return std::uint64_t{scenes->size()};
    };
    check.run = [scenes, equal, &subject](std::uint64_t number) {
      const auto& [name, scene] = (*scenes)[number];
      CaseResult result = equal(scene, subject);
      if (result.differences > 0) result.finding = name + ": " + result.finding;
      return result;
    };
    check.scene_of = [scenes](std::uint64_t number) { return (*scenes)[number].second; };
    const auto still = reducible(
        *subject.rival, [equal, &subject](const Scene& scene) { return equal(scene, subject).differences > 0; });
    check.still_fails = still;
    add_scenes(kModel, "model-random", "all rules", std::string(claim) + ", on hard triangles of all kinds",
               cases() * 16, scene_for, equal);
    for (const properties::Property& property : properties::all_properties()) {
      if (!property.needs_oracle || property.exhaustive == 0) continue;
      const std::string name = std::string("model-") + property.name;
      const std::uint64_t number_of = std::min(property.exhaustive, cases() * 4);
      Check& world = add(kModel, name, property.rule, std::string(claim) + ", on a small world", number_of);
      world.exhaustive = number_of == property.exhaustive;
      world.scene_of = [seed = settings_.seed, &property, name, all = world.exhaustive](std::uint64_t number) {
        return property.make(all ? number : case_seed(seed, name, number) % property.exhaustive);
      };
      world.run = [&subject, equal, scene_of = world.scene_of](std::uint64_t number) {
        return equal(scene_of(number), subject);
      };
      world.still_fails = still;
    }
  }

  void add_lines() {
    const judge::Rival::Primitives has = primitives_of(*subject_.rival);
    if (!has.lines && !has.points) return;
    Check& shapes = add(kModel, "line-shapes", "R17-R24",
                        "lines and points are shapes that its standard allows, as far as probing finds", 1);
    shapes.unit = "rasterizer";
    shapes.exhaustive = true;
    shapes.run = [&subject = subject_](std::uint64_t) {
      const judge::Inference& found = subject.inference.judged;
      if (!found.known) return not_applicable();
      CaseResult result;
      result.samples = 1;
      for (const std::string& sentence : found.line_problems) {
        result.finding += (result.finding.empty() ? "" : "; ") + sentence;
      }
      result.differences = found.line_problems.empty() ? 0 : 1;
      return result;
    };
    shapes.still_fails = nullptr;
    add_scenes(kModel, "model-lines", "M7, I6, I7, R17-R23",
               subject_.strict ? "every output of lines and points is the oracle's, bit for bit"
                               : "lines and points cover what the model says, and have values within what is granted",
               cases() * 8, line_scene_for, [](const Scene& scene, const RivalSubject& subject) {
                 if (!subject.strict && !subject.terms.known) return not_applicable();
                 return judge_scene(scene, subject);
               });
    add_scenes(kInvariants, "lines-alone", "V1",
               "an image of lines and points is what they make of it drawn alone, and the same when drawn again",
               cases() * 2, line_scene_for, alone_case);
    checks_.back().exhibit = [&subject = subject_](const Scene& scene) { return alone_case(scene, subject).exhibit; };
    if (!has.lines) return;
    if (owes_strips(subject_)) {
      add_scenes(kInvariants, "strips", "R22",
                 "where lines that run one way meet, no pixel is drawn twice, and none is left out", cases() * 2,
                 strip_scene, strip_case);
    }
    if (owes_line_rules(subject_, false) || owes_line_rules(subject_, true)) {
      add_scenes(
          kInvariants, "line-rules", "R22",
          "a line is within a pixel of diamond exit's, has as many pixels or one more or fewer, and one at each step",
          cases() * 4, lone_line_scene, line_rule_case);
    }
  }

  std::vector<Check> take() { return std::move(checks_); }

 private:
  const Settings& settings_;
  const RivalSubject& subject_;
  std::vector<Check> checks_;
};

// The least that can be asked for: one triangle on the screen.
bool draws_one_triangle(Rival& rival) {
  try {
    (void)adapters::JudgedRival(rival).draw(
        judge::flat_scene(4, 4, {{{{0.25f, 0.25f}, {3.75f, 0.25f}, {0.25f, 3.75f}}}}),
        {true, false, false, false, false});
    return true;
  } catch (const adapters::RivalFailure&) {
    return false;
  }
}

// Where a standard allows lines other than those that were found, nobody has to draw these throughout (R24).
void hold_to_standard(std::uint32_t profile, oracle::LineModel& lines) {
  for (oracle::LineShape* shape : {&lines.thin, &lines.wide}) {
    const bool diamond = *shape == oracle::LineShape::diamond, known = *shape != oracle::LineShape::unknown;
    if (profile == SUREFILL_ADAPTER_PROFILE_OPENGL ? known : profile == SUREFILL_ADAPTER_PROFILE_VULKAN && diamond) {
      *shape = oracle::LineShape::tolerant;
    }
  }
}

}  // namespace

RivalSubject meet_rival(Rival& rival) {
  RivalSubject subject;
  subject.rival = &rival;
  subject.declared = rival.info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN || rival.stated();
  if (!subject.declared) subject.reported_bits = rival.info().model.grid_bits;
  subject.inference.model = rival.info().model;
  subject.inference.judged.model = judge::least_known_model();
  const Rival::WideViewports wide(rival);
  try {
    // One that dies on the first probe is asked for less, and once more: if it draws nothing, there is nothing to
    // judge.
    for (std::optional<adapters::RivalFailure> failed;;) {
      try {
        subject.inference = adapters::infer_model(rival);
        break;
      } catch (const adapters::RivalFailure& failure) {
        failed = failure;
      }
      if (rival.has_drawn() || rival.given_up() || draws_one_triangle(rival)) throw *failed;
    }
  } catch (const adapters::RivalFailure& failure) {
    // The checks go on where it has drawn something: they have the scenes that show it.
    subject.inference.problems = {std::string("when probed, ") + failure.what()};
  } catch (const adapters::RivalSkips& lacking) {
    subject.inference.judged.open.push_back(std::string("a probe was not drawn: ") + lacking.what());
  }
  if (!subject.declared) {
    const surefill_adapter_model said = rival.info().model, &found = subject.inference.model;
    if (rival.says_rows() && said.y == SUREFILL_ADAPTER_Y_DOWN && found.y == SUREFILL_ADAPTER_Y_UP) {
      subject.conventions.emplace_back(
          "the picture is upside down: its first row is the bottom one, where it says the top one");
    }
    if (rival.says_depth_range() && said.depth_range == SUREFILL_ADAPTER_ZERO_TO_ONE &&
        found.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE) {
      subject.conventions.emplace_back("its clip depth is -1 to 1, where it says 0 to 1");
    }
    rival.set_model(found);
  }
  subject.terms = adapters::terms_of(rival.info(), rival.stated(), subject.inference.judged);
  if (!rival.stated()) hold_to_standard(rival.info().model.profile, subject.terms.model.lines);
  const oracle::Model& model = subject.terms.model;
  const bool d3d11 = rival.info().model.profile == SUREFILL_ADAPTER_PROFILE_D3D11;
  subject.terms.rounds_slanted =
      !subject.declared && !exact_profile(rival) && !(d3d11 && model.x.bits >= 0 && model.y.bits >= 0);
  subject.strict = exact_profile(rival) && rival.info().model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN;
  return subject;
}

corpus::Scene random_rival_scene(const RivalSubject& subject, std::uint64_t number, std::uint64_t seed) {
  return scene_for(subject, number, seed);
}

std::vector<Check> list_rival_checks(const Settings& settings, const RivalSubject& subject) {
  List list(settings, subject);
  list.add_model();
  list.add_invariants();
  list.add_lines();
  return list.take();
}

}  // namespace surefill::certify
