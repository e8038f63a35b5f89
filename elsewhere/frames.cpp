// SPDX-License-Identifier: Apache-2.0
//
// The fast path against the reference path: surefill_frames N SEED draws N random scenes, in every mode and of every
// category in turn, on both, and compares all outputs. It counts which pairs of modes have met in a draw, and names
// those that did not (those that calls refuse are none). Exit 0: no difference; 1: some.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "corpus/names.hpp"
#include "corpus/outputs.hpp"
#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "surefill/surefill.hpp"

namespace {

using namespace surefill;
using properties::Random;

// How a scene is drawn, beside what it says.
struct Way {
  const char* outputs;
  corpus::Outputs asked;
  Options options;
};

// A field and what it is set to.
using Mode = std::pair<std::string, std::string>;

template <typename Enum, std::size_t Count>
Mode mode(const char* field, const corpus::Names<Enum, Count>& names, Enum value) {
  for (const auto& [known, word] : names) {
    if (known == value) return {field, std::string(word)};
  }
  return {field, "?"};
}
Mode mode(const char* field, bool value) {
  return {field, value ? "yes" : "no"};
}

std::vector<Mode> modes_of(const corpus::Scene& scene, const corpus::SceneDraw& draw, const Way& way) {
  const bool identifiers = !draw.triangles.empty() && draw.triangles[0].identifier.has_value();
  std::vector<Mode> modes = {
      {"outputs", way.outputs},
      {"samples", std::to_string(scene.samples)},
      {"threads", std::to_string(way.options.threads)},
      mode("context", way.options.context != nullptr),
      mode("depth test", corpus::kDepthTestNames, scene.depth_test),
      mode("location", corpus::kAttributeLocationNames, scene.attribute_location),
      mode("initial depth", !scene.initial_depth.empty()),
      mode("several draws", scene.draws.size() > 1),
      mode("fill rule", corpus::kFillRuleNames, draw.fill_rule),
      mode("front face", corpus::kFrontFaceNames, draw.front_face),
      mode("cull", corpus::kCullNames, draw.cull),
      mode("depth mode", corpus::kDepthModeNames, draw.depth_mode),
      mode("depth write", draw.depth_write),
      mode("conservative", corpus::kConservativeNames, draw.conservative),
      mode("scissor", draw.scissor.has_value()),
      mode("culling box", draw.culling_box.has_value()),
      mode("viewport", draw.viewport.has_value()),
      mode("identifiers", identifiers),
      mode("layers", scene.layers > 1),
      mode("origin", scene.origin.x != 0 || scene.origin.y != 0),
      mode("own places", !scene.sample_locations.empty()),
      mode("winding", scene.more.winding && way.asked.winding),
      mode("numbers", scene.more.numbers),
      mode("bias", draw.depth_bias.has_value()),
      draw.grid ? mode("grid", corpus::kGridRoundingNames, draw.grid->rounding) : Mode{"grid", "none"}};
  for (const corpus::SceneAttribute& attribute : scene.attributes)
    modes.push_back(mode("attribute", corpus::kInterpolationNames, attribute.interpolation));
  std::sort(modes.begin(), modes.end());
  modes.erase(std::unique(modes.begin(), modes.end()), modes.end());
  return modes;
}

// What no call may ask for together: M4 of conservative draws, C5 of the rules closed and open.
bool is_refused(const Mode& a, const Mode& b) {
  const auto refuses = [](const Mode& x, const Mode& y) {
    if (x.first == "fill rule")
      return (x.second == "closed" || x.second == "open") && y.first == "grid" && y.second != "none";
    if (x == Mode{"layers", "yes"} && y == Mode{"depth write", "no"}) return true;
    if (x.first != "conservative" || x.second == "none") return false;
    static const std::set<Mode> kPlain = {{"outputs", "count"}, {"samples", "1"},        {"depth mode", "none"},
                                          {"grid", "none"},     {"initial depth", "no"}, {"layers", "no"},
                                          {"own places", "no"}, {"winding", "no"}};
    static const std::set<std::string> kFields = {"outputs",   "samples", "depth mode", "grid",   "initial depth",
                                                  "attribute", "layers",  "own places", "winding"};
    return kFields.contains(y.first) && !kPlain.contains(y);
  };
  return refuses(a, b) || refuses(b, a);
}

corpus::Scene scene_of(unsigned long long seed, std::size_t category, Random& random) {
  const int size = random.one_in(4) ? 160 : 40;  // up to three tiles each way, or one
  const auto generator = random.one_in(2) ? properties::mixed_scene : properties::modes_scene;
  corpus::Scene scene = generator(properties::categories()[category], seed, size, random.one_in(8) ? 40 : 8);
  for (corpus::SceneDraw& draw : scene.draws) {
    if (!draw.grid && random.one_in(5)) draw.fill_rule = random.one_in(2) ? FillRule::closed : FillRule::open;
    // The vertices themselves, where they are few, are a hull that holds the draw.
    if (draw.vertices.empty() || draw.vertices.size() > 8 || random.one_in(2)) continue;
    std::array<Vertex, 8> box;
    for (std::size_t k = 0; k < box.size(); ++k) {
      const corpus::SceneVertex& v = draw.vertices[k % draw.vertices.size()];
      const ClipVertex clip{v.x, v.y, v.z, v.w};
      box[k] = {v.x, v.y, v.z, v.w};
      if (draw.viewport && to_pixel(*draw.viewport, {&clip, 1}, {&box[k], 1}) != Status::ok) std::abort();
    }
    draw.culling_box = box;
  }
  return scene;
}

// All outputs, as bits. `before` is what the buffers hold, so that what is not written shows.
bool draw(const corpus::Scene& scene, const corpus::Outputs& asked, const Options& options, std::uint32_t before,
          std::vector<std::uint32_t>& bits) {
  corpus::Frame frame(scene, asked);
  corpus::Image& image = frame.image();
  const auto each = [&](const auto& visit) {
    corpus::for_each_output([&](const auto& output) { visit(image.*output.image); });
    for (auto& attribute : image.attributes) visit(attribute);
  };
  each([&](auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    std::fill(values.begin(), values.end(), std::bit_cast<Value>(before));
  });
  if (render(frame.target(), frame.draws(), nullptr, options) != Status::ok) return false;
  bits.clear();
  each([&](const auto& values) {
    for (const auto value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  });
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: surefill_frames N SEED\n", stderr), 2;
  const auto frames = std::strtoull(argv[1], nullptr, 10), first = std::strtoull(argv[2], nullptr, 10);
  const std::size_t categories = properties::categories().size();
  const std::pair<const char*, corpus::Outputs> kOutputs[] = {{"all", {}},
                                                              {"depth", {false, false, true, false, false}},
                                                              {"visibility", {false, true, true, false, true}},
                                                              {"count", {true, false, false, false, false}}};
  Context context;
  std::set<Mode> modes;
  std::set<std::pair<Mode, Mode>> met;
  std::vector<std::uint32_t> fast, reference;
  unsigned long long differences = 0, refused = 0;
  for (unsigned long long n = 0; n < frames; ++n) {
    const unsigned long long seed = first + n / categories;
    Random random(n * 0x9E3779B97F4A7C15u + first);
    const corpus::Scene scene = scene_of(seed, n % categories, random);
    const bool counts = std::any_of(scene.draws.begin(), scene.draws.end(),
                                    [](const auto& draw) { return draw.conservative != Conservative::none; });
    const auto& [name, asked] = kOutputs[counts ? 3 : random.below(4)];
    Way way{name, asked, {}};
    way.options.threads = random.between(1, 2);
    if (random.one_in(2)) way.options.context = &context;
    for (const corpus::SceneDraw& one : scene.draws) {
      const std::vector<Mode> all = modes_of(scene, one, way);
      modes.insert(all.begin(), all.end());
      for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) met.insert({all[j], all[i]});
      }
    }
    const bool drawn = draw(scene, asked, way.options, 0x5A5A5A5A, fast);
    if (drawn != draw(scene, asked, {.path = Path::reference}, 0xA5A5A5A5, reference) || (drawn && fast != reference)) {
      if (differences++ == 0) std::printf("%s", corpus::write_scene(scene).c_str());
      std::printf("frame %llu of seed %llu: the paths differ (%s)\n", n, first, name);
    }
    refused += !drawn;
  }
  std::size_t pairs = 0, missing = 0;
  for (auto a = modes.begin(); a != modes.end(); ++a) {
    for (auto b = modes.begin(); b != a; ++b) {
      if (a->first == b->first || is_refused(*a, *b)) continue;
      ++pairs;
      if (met.contains({*b, *a})) continue;
      ++missing;
      std::printf("%s %s has not met %s %s\n", b->first.c_str(), b->second.c_str(), a->first.c_str(),
                  a->second.c_str());
    }
  }
  std::printf(
      "sampled %llu frames (%llu of them refused), seed %llu, %zu of %zu pairs of %zu modes met: %llu differences\n",
      frames, refused, first, pairs - missing, pairs, modes.size(), differences);
  return frames > 0 && differences == 0 ? 0 : 1;
}
