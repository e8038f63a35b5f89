// SPDX-License-Identifier: Apache-2.0
//
// The subjects, and where their tests come from: the corpus, and the cases of properties, small worlds among them.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "certify/vectors/vectors.hpp"
#include "corpus/draw_fields.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::vectors {
namespace {

constexpr std::size_t kMostTriangles = 64, kMostOfCorpus = 256;

constexpr corpus::Outputs kCount{true, false, false, false, false};
constexpr corpus::Outputs kVisible{true, true, true, false, false};
constexpr corpus::Outputs kValues{true, true, false, true, true};
constexpr corpus::Outputs kAll{true, true, true, true, true};
constexpr corpus::Outputs kIntervals{true, false, true, true, true};

std::vector<Subject> all_subjects() {
  std::vector<Subject> all;
  const auto add = [&all](Subject subject) { all.push_back(std::move(subject)); };
  add({"coverage_exact",
       "which samples triangles cover: float32 vertices, taken as the real numbers that they are",
       Model::exact,
       kCount,
       {"degenerate", "bad-input"},
       {"small-world-homogeneous", "equality-coverage", "octants", "negation", "split", "scale", "order", "bad-input"},
       144,
       false,
       false});
  for (const int bits : {4, 8}) {
    const std::string n = std::to_string(bits);
    add({"coverage_grid" + n,
         "which samples triangles cover, for rasterizers that snap vertices to 1/" + std::to_string(1 << bits) +
             " pixel",
         bits == 4 ? Model::grid4 : Model::grid8,
         kCount,
         {"fill-rule", "degenerate", "cracks", "grid"},
         {"small-world-half-pixel", "partition-delaunay", "partition-fan", "partition-quads", "partition-t-junctions",
          "small-world-homogeneous", "equality-coverage", "grid-on-lattice", "equality-grid", "split", "order"},
         144,
         false,
         false});
  }
  add({"ties",
       "samples exactly on edges and at vertices, under each fill rule",
       Model::exact,
       kCount,
       {"fill-rule"},
       {"small-world-half-pixel", "partition-fan", "small-world-homogeneous-rules", "equality-coverage", "mirror",
        "transpose", "equality-closed-open", "small-world-octants"},
       144,
       false,
       true});
  add({"behind_the_eye",
       "vertices behind the eye, in its plane, and next to it",
       Model::exact,
       kVisible,
       {"behind-eye"},
       {"small-world-homogeneous", "octants", "small-world-octants", "negation", "category w-negative-one",
        "category w-negative-two", "category behind", "category w-zero-one", "category w-zero-two", "category w-tiny",
        "category collinear"},
       100,
       false,
       false});
  add({"cracks",
       "meshes whose triangles share edges: no sample is left out, none is covered twice",
       Model::exact,
       kCount,
       {"cracks"},
       {"partition-delaunay", "partition-adjacent", "partition-fan", "partition-quads", "partition-t-junctions",
        "partition-all-around", "small-world-shared-edge"},
       256,
       false,
       true});
  add({"range",
       "huge, tiny and subnormal vertices, and large targets",
       Model::exact,
       {true, false, true, false, false},
       {"range"},
       {"equality-wide", "category huge", "category tiny", "category subnormal", "category far-off-screen",
        "category mixed-exponents", "category any-bits", "category near-degenerate", "scale"},
       100,
       false,
       false});
  add({"depth",
       "depth: its rounding, clipping and clamping, tests, initial depth, depth write off",
       Model::exact,
       kVisible,
       {"depth"},
       {"depth-is-position", "equality-depth", "depth-clip", "reversed-depth", "depth-write", "interpolation-routes",
        "attribute-range", "translation", "frames"},
       64});
  add({"attributes",
       "barycentrics and attributes, perspective, noperspective and flat",
       Model::exact,
       kValues,
       {"interpolation"},
       {"interpolation-routes", "attributes-are-positions", "attribute-range", "equality-attributes", "order"},
       36});
  add({"values_grid8",
       "depth, barycentrics and attributes of rasterizers that snap to 1/256 pixel, as intervals",
       Model::grid8,
       kIntervals,
       {},
       {"category perspective", "category ordinary", "equality-attributes"},
       64,
       false,
       false});
  add({"samples",
       "2, 4, 8 and 16 samples a pixel",
       Model::exact,
       kAll,
       {"samples"},
       {"samples-shifted", "attributes-at-centre", "equality-samples"},
       64});
  add({"conservative",
       "conservative rasterization, over and inner",
       Model::exact,
       kCount,
       {"conservative"},
       {"small-world-conservative", "small-world-conservative-w", "conservative-contains", "conservative-split",
        "equality-conservative"},
       144});
  add({"grid",
       "the fixed-point grid as a mode: every rounding, offset and number of bits, slivers, the guard band",
       Model::exact,
       kAll,
       {"grid"},
       {"small-world-grid", "grid-on-lattice", "grid-partition", "grid-degree", "equality-grid"},
       64});
  add({"state",
       "facing, culling, scissor, several draws, identifiers, culling boxes, what is not finite",
       Model::exact,
       kAll,
       {"state", "order", "bad-input"},
       {"front-and-back", "scissor", "several-draws", "identifiers", "culling-box", "tiles", "frames", "bad-input",
        "outputs", "equality-scene"},
       64});
  add({"modes",
       "origins, own sample places, layers, LEQUAL and GEQUAL, bias, winding, overlap and touched, index of "
       "conservative frames",
       Model::exact,
       kAll,
       {"modes"},
       {"equality-modes", "tiles-of-a-picture", "layers-peel", "polygon-winding"},
       48});
  Subject sequences{"sequences",
                    "frames one after the other, into the same buffers",
                    Model::exact,
                    kVisible,
                    {"depth", "order", "fill-rule"},
                    {"repeat", "frames", "several-draws", "equality-scene", "depth-write"},
                    64};
  sequences.sequences = true;
  add(sequences);
  const std::pair<const char*, std::vector<std::string>> modes[] = {
      {"ties", {"C3 ", "C5 "}},
      {"cracks", {"C3 "}},
      {"depth", {"I5 ", "V1 greater"}},
      {"attributes", {"I2 "}},
      {"samples", {"S4 "}},
      {"conservative", {"M4 "}},
      {"grid", {"G1 rounding "}},
      {"modes", {"S6 ", "S7 ", "V4 ", "V5 ", "I8 ", "M9 ", "M4c "}},
      {"sequences", {"V1 greater"}}};
  std::find_if(all.begin(), all.end(), [](const Subject& s) { return s.name == "modes"; })->deep = 20000;
  for (const auto& [name, kinds] : modes)
    std::find_if(all.begin(), all.end(), [&name](const Subject& s) { return s.name == name; })->modes = kinds;
  return all;
}

// ---- scenes
std::size_t triangles_of(const corpus::Scene& scene) {
  std::size_t n = 0;
  for (const corpus::SceneDraw& draw : scene.draws) n += draw.triangles.size();
  return n;
}

// Are all fields of a draw as they are by default, but for those that version 1 of the files has?
bool of_version_1(const corpus::SceneDraw& draw) {
  static constexpr std::array<std::string_view, 10> kFields{"fill-rule",   "front-face",   "cull",    "depth-mode",
                                                            "depth-write", "conservative", "scissor", "grid",
                                                            "culling-box", "depth-bias"};
  const DrawState none;
  bool plain = draw.primitive == Primitive::triangles;
  corpus::for_each_draw_field([&](const auto& field) {
    if (std::find(kFields.begin(), kFields.end(), field.name) == kFields.end())
      plain = plain && draw.*field.member == none.*field.member;
  });
  return plain;
}

// Vertices through the viewport, first indices written out, and no more vertices than triangles name.
bool write_out(corpus::Scene& scene) {
  std::uint32_t before = 0;
  for (corpus::SceneDraw& draw : scene.draws) {
    if (!of_version_1(draw)) return false;
    if (draw.viewport) {
      std::vector<ClipVertex> clip;
      for (const corpus::SceneVertex& v : draw.vertices) clip.push_back({v.x, v.y, v.z, v.w});
      std::vector<Vertex> pixel(clip.size());
      oracle::to_pixel(*draw.viewport, clip, pixel);
      for (std::size_t i = 0; i < pixel.size(); ++i) {
        corpus::SceneVertex& v = draw.vertices[i];
        v.x = pixel[i].x, v.y = pixel[i].y, v.z = pixel[i].z, v.w = pixel[i].w;
      }
      draw.viewport.reset();
    }
    if (!draw.first_index) draw.first_index = before;
    before += static_cast<std::uint32_t>(draw.triangles.size());
  }
  return true;
}

bool attributes_are_finite(const corpus::Scene& scene) {
  for (const corpus::SceneDraw& draw : scene.draws)
    for (const corpus::SceneVertex& v : draw.vertices)
      for (const float u : v.attributes)
        if (!std::isfinite(u)) return false;
  return true;
}

// Has it nothing of what the subject `modes` is about?
bool is_plain(const corpus::Scene& scene) {
  if (scene.origin != Origin{} || !scene.sample_locations.empty() || scene.layers != 1 ||
      !(scene.more == corpus::MoreOutputs{}) || scene.depth_test > DepthTest::greater)
    return false;
  return std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
    return draw.conservative <= Conservative::inner && !draw.depth_bias;
  });
}

// As the subject has scenes; false if it has none such.
bool fit(const Subject& subject, corpus::Scene& scene, std::size_t most) {
  if (!write_out(scene) || triangles_of(scene) == 0 || triangles_of(scene) > most) return false;
  const bool samples = subject.name == "samples", modes = subject.name == "modes";
  if (modes) {
    scene.more.numbers = false;  // files have outputs of samples
    return true;
  }
  if (!is_plain(scene) || (!samples && scene.samples != 1)) return false;
  for (corpus::SceneDraw& draw : scene.draws) {
    if ((draw.conservative != Conservative::none) && subject.name != "conservative") return false;
    if (draw.grid && subject.keeps_state && subject.name != "grid") return false;
    if (!subject.keeps_rule) draw.fill_rule = FillRule::top_left;
    if (!subject.keeps_state) {
      DrawState plain;
      plain.fill_rule = draw.fill_rule;
      draw.state() = plain;
      for (corpus::SceneTriangle& triangle : draw.triangles) triangle.identifier.reset();
    }
  }
  if (!subject.keeps_state) {
    scene.depth_test = DepthTest::less, scene.attribute_location = AttributeLocation::centre,
    scene.initial_depth.clear();
  }
  // A value that is not finite drops its triangle (B1).
  if (!subject.outputs.attributes && attributes_are_finite(scene)) {
    scene.attributes.clear();
    for (corpus::SceneDraw& draw : scene.draws)
      for (corpus::SceneVertex& v : draw.vertices) v.attributes.clear();
  }
  return subject.keeps_state || scene.attributes.empty() || subject.outputs.attributes;
}

// ---- rules
void add_letters(std::set<std::string>& rules, const std::string& text) {
  static const std::regex kRule(R"(\b([BCFGIMSTV])(\d+)\b(?:-([BCFGIMSTV])?(\d+))?)");
  for (std::sregex_iterator it(text.begin(), text.end(), kRule), end; it != end; ++it) {
    const int first = std::stoi((*it)[2]), last = (*it)[4].matched ? std::stoi((*it)[4]) : first;
    for (int n = first; n <= std::min(last, first + 12); ++n) rules.insert((*it)[1].str() + std::to_string(n));
  }
}

// What the frame's state asks for.
void add_modes(std::set<std::string>& rules, const corpus::Scene& scene) {
  const auto word = [](const auto& value) {
    return std::string(corpus::names_of<std::decay_t<decltype(value)>>()[static_cast<std::size_t>(value)].second);
  };
  if (scene.samples > 1) {
    rules.insert("S4 " + std::to_string(scene.samples));
    rules.insert(
        "M1 " +
        std::string(corpus::kAttributeLocationNames[static_cast<std::size_t>(scene.attribute_location)].second));
  }
  if (scene.depth_test == DepthTest::less_equal) rules.insert("V5 less-equal");
  if (scene.depth_test == DepthTest::greater_equal) rules.insert("V5 greater-equal");
  if (scene.origin != Origin{}) rules.insert("S6 origin");
  if (!scene.sample_locations.empty()) rules.insert("S7 places");
  if (scene.layers > 1) rules.insert("V4 layers");
  if (scene.more.winding) rules.insert("M9 winding");
  if (scene.more.conservative_index) rules.insert("M4c index");
  if (scene.depth_test == DepthTest::greater) rules.insert("V1 greater");
  if (!scene.initial_depth.empty()) rules.insert("V1 initial depth");
  if (scene.draws.size() > 1) rules.insert("V3");
  for (const corpus::SceneAttribute& attribute : scene.attributes)
    rules.insert("I2 " +
                 std::string(corpus::kInterpolationNames[static_cast<std::size_t>(attribute.interpolation)].second));
  for (const corpus::SceneDraw& draw : scene.draws) {
    if (draw.fill_rule != FillRule::top_left)
      rules.insert((draw.fill_rule > FillRule::northwards_west ? "C5 " : "C3 ") + word(draw.fill_rule));
    if (draw.front_face != FrontFace::clockwise) rules.insert("F1 " + word(draw.front_face));
    if (draw.cull != Cull::none) rules.insert("F2 " + word(draw.cull));
    if (draw.depth_mode != DepthMode::none) rules.insert("I5 " + word(draw.depth_mode));
    if (!draw.depth_write) rules.insert("M5");
    if (draw.conservative != Conservative::none) rules.insert("M4 " + word(draw.conservative));
    if (draw.depth_bias) rules.insert("I8 bias");
    if (draw.scissor) rules.insert("M3");
    if (draw.culling_box) rules.insert("M6");
    if (draw.grid)
      rules.insert("G1 rounding " + word(draw.grid->rounding)),
          rules.insert("G1 bits " + std::to_string(draw.grid->bits));
    if (!draw.triangles.empty() && draw.triangles[0].identifier) rules.insert("V2 identifiers");
  }
}

// ---- frames
corpus::Outputs outputs_for(const Subject& subject, const corpus::Scene& scene) {
  corpus::Outputs outputs = subject.outputs;
  if (scene.attributes.empty()) outputs.attributes = false;
  for (const corpus::SceneDraw& draw : scene.draws)
    if (draw.conservative != Conservative::none) outputs = {true, scene.more.conservative_index, false, false, false};
  outputs.winding = scene.more.winding, outputs.numbers = false;
  return outputs;
}

VectorFrame frame_of(corpus::Scene scene, bool previous = false) {
  VectorFrame frame;
  frame.scene = std::move(scene), frame.previous = previous;
  return frame;
}

// The frames that a scene gives: itself; for sequences, it twice, in its halves, and after another rule.
std::vector<Candidate> candidates_of(const Subject& subject, corpus::Scene scene, const std::string& comment,
                                     const std::set<std::string>& letters, std::size_t most = kMostTriangles) {
  std::vector<Candidate> all;
  if (!fit(subject, scene, most)) return all;
  Candidate candidate{comment, letters, outputs_for(subject, scene), {}};
  scene.comment.clear();
  add_modes(candidate.rules, scene);
  if (!subject.sequences) {
    candidate.frames = {frame_of(scene)};
    all.push_back(candidate);
    if (subject.name == "depth" && !scene.initial_depth.empty()) {
      candidate.outputs = {false, false, true, false, false};
      candidate.comment += "; depth alone is asked for";
      all.push_back(candidate);
    }
    return all;
  }
  const auto with = [&](const char* how, std::vector<VectorFrame> frames) {
    Candidate one = candidate;
    one.comment += how, one.frames = std::move(frames);
    all.push_back(std::move(one));
  };
  with("; twice", {frame_of(scene), frame_of(scene)});
  corpus::Scene empty = scene, other = scene;
  for (corpus::SceneDraw& draw : empty.draws) draw.triangles.clear();
  with("; then nothing is drawn", {frame_of(scene), frame_of(empty)});
  for (corpus::SceneDraw& draw : other.draws) {
    draw.fill_rule = draw.fill_rule == FillRule::bottom_right ? FillRule::top_left : FillRule::bottom_right;
  }
  with("; then under another fill rule, and back", {frame_of(scene), frame_of(other), frame_of(scene)});
  if (scene.draws.size() > 1) {
    std::vector<VectorFrame> frames;
    for (const corpus::SceneDraw& draw : scene.draws) {
      corpus::Scene one = scene;
      one.draws = {draw};
      if (!frames.empty()) one.initial_depth.clear();
      frames.push_back(frame_of(one, !frames.empty()));
    }
    with("; a frame for each draw, which starts with the depth of the one before", std::move(frames));
  }
  return all;
}

// The head of a case of the corpus in a line.
std::string comment_of(const corpus::Scene& scene) {
  std::istringstream lines(scene.comment);
  std::string comment;
  for (std::string line; std::getline(lines, line);) comment += (comment.empty() ? "" : "; ") + line;
  return comment;
}

const properties::Property* property_named(const std::string& name) {
  for (const properties::Property& property : properties::all_properties())
    if (name == property.name) return &property;
  return nullptr;
}

const properties::Category* category_named(const std::string& name) {
  for (const properties::Category& category : properties::categories())
    if (name == category.name) return &category;
  return nullptr;
}

}  // namespace

std::span<const Subject> subjects() {
  static const std::vector<Subject> all = all_subjects();
  return all;
}

void for_each_candidate(const Subject& subject, const std::string& corpus, const Take& take) {
  for (const std::string& folder : subject.folders) {
    for (const std::string& file : corpus::list_corpus(corpus + "/cases/" + folder)) {
      const corpus::Scene scene = corpus::read_scene_file(file);
      std::set<std::string> letters;
      add_letters(letters, scene.comment);
      const std::string name = std::filesystem::path(file).stem().string();
      for (const Candidate& candidate :
           candidates_of(subject, scene, comment_of(scene) + " (corpus: " + folder + "/" + name + ")", letters,
                         subject.name == "state" ? kMostOfCorpus : kMostTriangles)) {
        take(candidate, "", false);
      }
    }
  }
  for (const std::string& name : subject.properties) {
    const bool is_category = name.starts_with("category ");
    const properties::Property* property = is_category ? nullptr : property_named(name);
    const properties::Category* category = is_category ? category_named(name.substr(9)) : nullptr;
    if (property == nullptr && category == nullptr) throw std::runtime_error("vectors: there is no " + name);
    std::set<std::string> letters;
    if (property != nullptr) add_letters(letters, property->rule);
    bool more = true;
    for (std::uint64_t n = 0; n < subject.deep && more; ++n) {
      properties::SceneLimits limits;
      limits.max_size = 10, limits.max_triangles = subject.name == "values_grid8" ? 1 : 3;
      const corpus::Scene scene =
          property != nullptr ? properties::sampled_case(*property, n) : properties::random_scene(*category, n, limits);
      const std::string comment = std::string(property != nullptr ? property->claim : category->aims) + " (" + name +
                                  ", case " + std::to_string(n) + ")";
      for (const Candidate& candidate : candidates_of(subject, scene, comment, letters)) {
        more = take(candidate, name, n >= subject.shallow);
        if (!more) break;
      }
    }
  }
}

}  // namespace surefill::vectors
