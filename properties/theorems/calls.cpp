// SPDX-License-Identifier: Apache-2.0
//
// One frame, asked for in several ways: in pieces, on other targets, again, with fewer outputs, upside down in depth.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

corpus::Scene make_frame(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 6;
  return pixel_scene(n, limits);
}

// Every mode there is.
corpus::Scene make_any(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 6;
  limits.samples = limits.grid = limits.conservative = true;
  return pixel_scene(n, limits);
}

Scissor common(const Scissor& a, const Scissor& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// M3. The tiles tile the target; each keeps what the draws' own scissors leave of it.
TrialResult decide_tiles(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  Random random = random_of(scene);
  const corpus::Outputs outputs = outputs_of(scene);
  corpus::Scene nothing = scene;
  for (corpus::SceneDraw& draw : nothing.draws) draw.triangles.clear();
  const auto whole = trial.draw(scene, outputs), empty = trial.draw(nothing, outputs);
  if (!whole || !empty) return trial.verdict();
  const auto cuts = [&](int size) {
    std::vector<int> at{0};
    while (at.back() < size) at.push_back(std::min(size, at.back() + random.between(1, 8)));
    return at;
  };
  const std::vector<int> xs = cuts(scene.width), ys = cuts(scene.height);
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      const Scissor tile{xs[i], ys[j], xs[i + 1], ys[j + 1]};
      corpus::Scene part = scene;
      for (corpus::SceneDraw& draw : part.draws) draw.scissor = draw.scissor ? common(*draw.scissor, tile) : tile;
      const auto image = trial.draw(part, outputs);
      if (!image) return trial.verdict();
      trial.expect_parts("the tile", scene, tile, *whole, *empty, *image);
    }
  return trial.verdict();
}

// S1: a larger target adds pixels and changes none.
TrialResult decide_target_size(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  Random random = random_of(scene);
  corpus::Scene small = scene;
  if (small.initial_depth.size() > 1) small.initial_depth = {small.initial_depth[0]};
  constexpr int kMore[] = {0, 1, 7, 8, 56, 64, 130};
  const corpus::Outputs outputs = outputs_of(small);
  const auto expected = trial.draw(small, outputs);
  for (int attempt = 0; attempt < 2 && expected; ++attempt) {
    corpus::Scene large = small;
    large.width += kMore[random.below(7)];
    large.height += kMore[random.below(7)];
    if (attempt == 1 && random.one_in(8)) {
      large.width = small.width + 2048;
      large.height = small.height;
    }
    if (const auto actual = trial.draw(large, outputs))
      trial.expect_same("on a target of " + std::to_string(large.width) + " x " + std::to_string(large.height), small,
                        *expected, *actual);
  }
  return trial.verdict();
}

// I4, V1: whatever was drawn before, and whatever the buffers held.
TrialResult decide_repeat(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const corpus::Outputs outputs = outputs_of(scene);
  corpus::Scene between = scene;
  std::reverse(between.draws.begin(), between.draws.end());
  for (corpus::SceneDraw& draw : between.draws) {
    draw.fill_rule = static_cast<FillRule>(static_cast<unsigned>(draw.fill_rule) ^ 3u);
    draw.cull = draw.cull == Cull::none ? Cull::front : Cull::none;
    draw.scissor = draw.scissor ? std::nullopt : std::optional<Scissor>({0, 0, scene.width, scene.height / 2});
    draw.first_index.reset();
  }
  const auto first = trial.draw(scene, outputs);
  for (const std::uint32_t garbage : {0x3F000000u, 0xFFC00001u, 0x00000001u}) {
    if (!first || !trial.draw_over(garbage, between, outputs)) return trial.verdict();
    for (int time = 0; time < 2; ++time)  // at once, too: what alternates is not in step
      if (const auto again = trial.draw_over(garbage, scene, outputs))
        trial.expect_same("drawn again", scene, *first, *again);
  }
  return trial.verdict();
}

// An output does not depend on which others are asked for.
TrialResult decide_outputs(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const corpus::Outputs all = outputs_of(scene);
  const auto together = trial.draw(scene, all);
  for (unsigned output = 0; output < 5 && together && all.depth; ++output) {
    const corpus::Outputs one{output == 0, output == 1, output == 2, output == 3, output == 4};
    const auto alone = trial.draw(scene, one);
    if (alone) trial.expect_same("as the only output", scene, *alone, *together);
  }
  return trial.verdict();
}

// V3: later draws go on from the depth that earlier ones left, as they would from initial depth.
TrialResult decide_frames(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  if (scene.draws.empty() || !outputs_of(scene).depth) return trial.verdict();
  corpus::Scene whole = scene;
  std::uint32_t before = 0;
  for (corpus::SceneDraw& draw : whole.draws) {
    if (!draw.first_index) draw.first_index = before;
    before += static_cast<std::uint32_t>(draw.triangles.size());
  }
  corpus::Scene early = whole, late = whole;
  const auto half = static_cast<std::ptrdiff_t>(whole.draws.size() / 2);
  early.draws.erase(early.draws.begin() + half, early.draws.end());
  late.draws.erase(late.draws.begin(), late.draws.begin() + half);
  const corpus::Outputs outputs = outputs_of(scene);
  const auto expected = trial.draw(whole, outputs), first = trial.draw(early, outputs);
  if (!expected || !first) return trial.verdict();
  late.initial_depth = first->depth;
  auto second = trial.draw(late, outputs);
  if (!second) return trial.verdict();
  for (std::size_t s = 0; s < second->count.size(); ++s) {
    second->count[s] += first->count[s];
    if (second->index[s] != kNoTriangle) continue;
    second->index[s] = first->index[s];
    for (std::size_t i = 0; i < 3; ++i) second->barycentrics[3 * s + i] = first->barycentrics[3 * s + i];
    for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
      const std::size_t components = scene.attributes[k].components;
      for (std::size_t c = 0; c < components; ++c)
        second->attributes[k][components * s + c] = first->attributes[k][components * s + c];
    }
  }
  trial.expect_same("drawn as two frames, the depth of the first initial in the second", scene, *second, *expected);
  return trial.verdict();
}

// M5, M2: without depth write no depth changes, and counts do not care.
TrialResult decide_depth_write(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene off = scene, on = scene, empty = scene;
  for (corpus::SceneDraw& draw : off.draws) draw.depth_write = false;
  for (corpus::SceneDraw& draw : on.draws) draw.depth_write = true;
  for (corpus::SceneDraw& draw : empty.draws) draw.triangles.clear();
  const corpus::Outputs depth{false, false, true, false, false};
  const auto kept = trial.draw(off, depth), initial = trial.draw(empty, depth);
  const auto counts_off = trial.draw(off, kCountOnly), counts_on = trial.draw(on, kCountOnly);
  if (!kept || !initial || !counts_off || !counts_on) return trial.verdict();
  trial.expect_same("with depth write off", scene, *initial, *kept);
  trial.expect_same("with depth write off or on", scene, *counts_on, *counts_off);
  return trial.verdict();
}

// B1: a bad triangle more, after the others.
TrialResult decide_bad_input(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity};
  Random random = random_of(scene);
  corpus::Scene expected = scene;
  std::uint32_t before = 0;
  std::set<std::uint32_t> identifiers;
  for (corpus::SceneDraw& draw : expected.draws) {
    if (!draw.first_index) draw.first_index = before;
    before += static_cast<std::uint32_t>(draw.triangles.size());
    for (const corpus::SceneTriangle& t : draw.triangles)
      if (t.identifier) identifiers.insert(*t.identifier);
  }
  corpus::Scene actual = expected;
  std::uint32_t unused = 0;
  for (corpus::SceneDraw& draw : actual.draws) {
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    std::size_t values = 0;
    for (const corpus::SceneAttribute& attribute : scene.attributes) values += attribute.components;
    for (const std::array<float, 2> p : {std::array{-4.0f, -4.0f}, std::array{64.0f, -4.0f}, std::array{-4.0f, 64.0f}})
      draw.vertices.push_back({p[0], p[1], 0.25f, 1, std::vector<float>(values, 0.5f)});
    corpus::SceneVertex& bad = draw.vertices[first + random.below(3)];
    const float value = kBad[random.below(3)];
    const std::uint32_t place = random.below(4 + static_cast<std::uint32_t>(values));
    (place == 0   ? bad.x
     : place == 1 ? bad.y
     : place == 2 ? bad.z
     : place == 3 ? bad.w
                  : bad.attributes[place - 4]) = value;
    corpus::SceneTriangle triangle{{first, first + 1, first + 2}, std::nullopt};
    if (!draw.triangles.empty() && draw.triangles[0].identifier) {
      while (identifiers.contains(unused)) ++unused;
      triangle.identifier = unused++;
      draw.triangles.insert(draw.triangles.begin(), triangle);  // identifiers name the others: it may come first
    } else {
      draw.triangles.push_back(triangle);
    }
  }
  const corpus::Outputs outputs = outputs_of(scene);
  const auto without = trial.draw(expected, outputs), with = trial.draw(actual, outputs);
  if (without && with) trial.expect_same("with a triangle of bad numbers", scene, *without, *with);
  return trial.verdict();
}

// The header's stride: an attribute of its own array, packed or with gaps, gives the image that interleaved ones give.
// What lies in the gaps is not looked at.
TrialResult decide_layout(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const corpus::Outputs outputs = outputs_of(scene);
  const auto expected = trial.draw(scene, outputs);
  for (const std::uint32_t gap : {0u, 1u, 3u}) {
    std::vector<std::vector<AttributeArray>> arrays(scene.draws.size());
    std::vector<std::vector<float>> values;
    values.reserve(scene.draws.size() * scene.attributes.size());
    const auto actual = trial.draw_changed(scene, outputs, [&](std::vector<Draw>& draws) {
      for (std::size_t d = 0; d < draws.size(); ++d) {
        for (const AttributeArray& from : draws[d].attributes) {
          const std::uint32_t step = from.components + gap;
          std::vector<float>& to =
              values.emplace_back(draws[d].vertices.size() * step, std::numeric_limits<float>::quiet_NaN());
          for (std::size_t v = 0; v < draws[d].vertices.size(); ++v)
            for (std::size_t c = 0; c < from.components; ++c) to[v * step + c] = from.values[v * from.stride + c];
          if (!to.empty()) to.resize(to.size() - gap);  // ends with the last vertex
          arrays[d].push_back({to, from.components, gap == 0 ? 0 : step, from.interpolation});
        }
        draws[d].attributes = arrays[d];
      }
    });
    if (expected && actual)
      trial.expect_same(gap == 0 ? "with packed attributes" : "with gaps between attributes", scene, *expected,
                        *actual);
  }
  return trial.verdict();
}

// V1: Z := -Z under the other test. What is stored is -z, and +0 where that is 0.
TrialResult decide_reversed(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene plain = scene;
  plain.initial_depth.clear();
  for (corpus::SceneDraw& draw : plain.draws) draw.depth_mode = DepthMode::none;
  corpus::Scene reversed = plain;
  reversed.depth_test = scene.depth_test == DepthTest::less ? DepthTest::greater : DepthTest::less;
  for (corpus::SceneDraw& draw : reversed.draws)
    for (corpus::SceneVertex& v : draw.vertices) v.z = -v.z;
  const corpus::Outputs outputs = outputs_of(scene);
  const auto expected = trial.draw(plain, outputs);
  auto actual = trial.draw(reversed, outputs);
  if (!expected || !actual) return trial.verdict();
  for (float& depth : actual->depth) depth = depth == 0 ? depth : -depth;
  trial.expect_same("with depth reversed", scene, *expected, *actual);
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"tiles", "M3", "drawn tile by tile, each the scissor of its own frame, the image is the whole one", false, true, 0,
     make_any, decide_tiles, true},
    {"target-size", "S1", "on a larger target the image has more pixels and no others", false, true, 0, make_any,
     decide_target_size, true},
    {"repeat", "I4, V1", "the same frame gives the same image, whatever was drawn or stored there before", false, true,
     0, make_any, decide_repeat, true},
    {"outputs", "V1", "an output is the same with and without the others", false, true, 0, make_any, decide_outputs,
     true},
    {"frames", "V3", "draws go on from earlier draws' depth as from initial depth", false, true, 0, make_frame,
     decide_frames, true},
    {"depth-write", "M5, M2", "with depth write off depth stays, and counts do not depend on it", false, true, 0,
     make_frame, decide_depth_write, true},
    {"bad-input", "B1", "a triangle with a NaN or an infinity changes nothing", false, true, 0, make_frame,
     decide_bad_input, true},
    {"layout", "I2", "attributes packed, with gaps or interleaved give the same image", false, true, 0, make_frame,
     decide_layout, true},
    {"reversed-depth", "V1", "GREATER with negated depth sees what LESS sees", false, true, 0, make_frame,
     decide_reversed},
};

}  // namespace

std::span<const Property> call_properties() {
  return kProperties;
}

}  // namespace surefill::properties
