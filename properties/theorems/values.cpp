// SPDX-License-Identifier: Apache-2.0
//
// I1 to I5 where the exact value is known without an oracle.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

// Every other round without state, so that more samples are covered.
corpus::Scene make_frame(std::uint64_t n) {
  SceneLimits limits;
  limits.max_size = 9;
  limits.max_triangles = 4;
  limits.state = n / categories().size() % 2 == 1;
  return pixel_scene(n, limits);
}

// Nothing between a fragment's depth and the depth buffer.
void show_depth(corpus::Scene& scene) {
  scene.initial_depth.clear();
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.depth_mode = DepthMode::none;
    draw.depth_write = true;
  }
}

// sum X_i E_i = px D: depth reproduces position.
TrialResult decide_position(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (const int component : {0, 1, 2}) {
    corpus::Scene changed = without_attributes(scene);
    show_depth(changed);
    for (corpus::SceneDraw& draw : changed.draws)
      for (corpus::SceneVertex& v : draw.vertices) v.z = component == 0 ? v.x : component == 1 ? v.y : v.w;
    const auto image = trial.draw(changed, {true, false, true, false, false});
    if (!image) return trial.verdict();
    for (int y = 0; y < image->height; ++y)
      for (int x = 0; x < image->width; ++x) {
        const std::size_t e = element(*image, x, y);
        if (image->count[e] == 0) continue;
        trial.looked_at(1);
        const float position[] = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1.0f};
        const char* const what[] = {"depth of Z := X", "depth of Z := Y", "depth of Z := W"};
        trial.expect_bits(what[component], x, y, position[component], image->depth[e]);
      }
  }
  return trial.verdict();
}

// With Z := X - (c + 1/2) W the depth in column x is x - c: 0 and 1, exactly, in columns c and c + 1.
TrialResult decide_clip(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const int column = scene.width / 2;
  corpus::Scene open = without_attributes(scene);
  show_depth(open);
  for (corpus::SceneDraw& draw : open.draws)
    std::erase_if(draw.triangles, [&](const corpus::SceneTriangle& t) {
      return !std::all_of(t.vertices.begin(), t.vertices.end(), [&](std::uint32_t i) {
        corpus::SceneVertex& v = draw.vertices[i];
        const auto z = exact_float_sum(v.x, -(column + 0.5) * v.w);
        if (z) v.z = *z;
        return finite(vertex_of(v)) && z;
      });
    });
  corpus::Scene clipped = open, clamped = open;
  for (corpus::SceneDraw& draw : clipped.draws) draw.depth_mode = DepthMode::clip;
  for (corpus::SceneDraw& draw : clamped.draws) draw.depth_mode = DepthMode::clamp;
  const corpus::Outputs outputs{true, true, true, false, false};
  const auto all = trial.draw(open, outputs), some = trial.draw(clipped, outputs), flat = trial.draw(clamped, outputs);
  if (!all || !some || !flat) return trial.verdict();
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(*all, x, y);
      if (all->count[e] == 0) continue;
      trial.looked_at(1);
      const int depth = x - column;
      trial.expect_count("count under depth clipping", x, y, depth == 0 || depth == 1 ? all->count[e] : 0,
                         some->count[e]);
      trial.expect_count("count under depth clamping", x, y, all->count[e], flat->count[e]);
      trial.expect_bits("depth without clipping", x, y, static_cast<float>(depth), all->depth[e]);
      trial.expect_bits("depth under depth clamping", x, y, static_cast<float>(std::clamp(depth, 0, 1)),
                        flat->depth[e]);
    }
  return trial.verdict();
}

struct Place {
  std::size_t draw, triangle;
};

// Which triangle an index names; those that two triangles share are left out.
std::map<std::uint32_t, Place> triangles_by_index(const corpus::Scene& scene) {
  std::map<std::uint32_t, Place> places;
  std::vector<std::uint32_t> repeated;
  std::uint32_t before = 0;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    const corpus::SceneDraw& draw = scene.draws[d];
    std::uint32_t position = draw.first_index.value_or(before);
    before += static_cast<std::uint32_t>(draw.triangles.size());
    for (std::size_t t = 0; t < draw.triangles.size(); ++t, ++position) {
      const std::uint32_t index = draw.triangles[t].identifier.value_or(position);
      if (!places.emplace(index, Place{d, t}).second) repeated.push_back(index);
    }
  }
  for (const std::uint32_t index : repeated) places.erase(index);
  return places;
}

// I4: a convex combination stays in range, and a constant stays constant, after rounding, too.
TrialResult decide_range(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto image = trial.draw(scene, outputs_of(scene));
  if (!image || image->index.empty()) return trial.verdict();
  const std::map<std::uint32_t, Place> places = triangles_by_index(scene);
  const bool depth_bounded = std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
    return draw.depth_write && draw.depth_mode != DepthMode::none;
  });
  const auto expect_within = [&](const std::string& what, int x, int y, float low, float high, float value) {
    if (!(low <= value && value <= high)) trial.differs(what, x, y, text(low) + " to " + text(high), text(value));
  };
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(*image, x, y);
      const auto found = places.find(image->index[e]);
      if (found == places.end()) continue;
      trial.looked_at(1);
      if (depth_bounded) expect_within("depth, clipped or clamped,", x, y, 0, 1, image->depth[e]);
      for (std::size_t i = 0; i < 3; ++i) expect_within("barycentrics", x, y, 0, 1, image->barycentrics[3 * e + i]);
      const corpus::SceneDraw& draw = scene.draws[found->second.draw];
      std::size_t first = 0;
      for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
        const corpus::SceneAttribute& attribute = scene.attributes[k];
        for (std::size_t c = 0; c < attribute.components; ++c) {
          float low = 0, high = 0;
          for (std::size_t i = 0; i < 3; ++i) {
            const float value = draw.vertices[draw.triangles[found->second.triangle].vertices[i]].attributes[first + c];
            low = i == 0 ? value : std::min(low, value);
            high = i == 0 ? value : std::max(high, value);
          }
          const float value = image->attributes[k][e * attribute.components + c];
          if (low == high)
            trial.expect_bits("constant attribute " + attribute.name, x, y, low == 0 ? 0.0f : low, value);
          else if (attribute.interpolation != Interpolation::noperspective)
            expect_within("attribute " + attribute.name, x, y, low, high, value);
        }
        first += attribute.components;
      }
    }
  return trial.verdict();
}

// I1 to I3 by several routes: with W = 1 depth, noperspective and perspective attributes are one function; perspective
// attributes that are unit vectors are the barycentrics at any W.
TrialResult decide_routes(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  for (const bool unit_w : {true, false}) {
    corpus::Scene changed = without_attributes(scene);
    show_depth(changed);
    changed.attributes = {{"perspective", 1, Interpolation::perspective},
                          {"noperspective", 1, Interpolation::noperspective},
                          {"weights", 3, Interpolation::perspective}};
    for (corpus::SceneDraw& draw : changed.draws) {
      const std::vector<corpus::SceneVertex> shared = std::move(draw.vertices);
      draw.vertices.clear();
      for (corpus::SceneTriangle& triangle : draw.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
          corpus::SceneVertex v = shared[triangle.vertices[i]];
          if (unit_w) v.w = 1;
          v.attributes = {v.z, v.z, i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
          triangle.vertices[i] = static_cast<std::uint32_t>(draw.vertices.size());
          draw.vertices.push_back(std::move(v));
        }
    }
    const auto image = trial.draw(changed, outputs_of(changed));
    if (!image || image->index.empty()) return trial.verdict();
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const std::size_t e = element(*image, x, y);
        if (image->index[e] == kNoTriangle) continue;
        trial.looked_at(1);
        if (unit_w) {
          trial.expect_bits("perspective attribute of W = 1, against depth,", x, y, image->depth[e],
                            image->attributes[0][e]);
          trial.expect_bits("noperspective attribute of W = 1, against depth,", x, y, image->depth[e],
                            image->attributes[1][e]);
        }
        for (std::size_t i = 0; i < 3; ++i)
          trial.expect_bits("attribute of unit vectors, against barycentrics,", x, y, image->barycentrics[3 * e + i],
                            image->attributes[2][3 * e + i]);
      }
  }
  return trial.verdict();
}

// I2: u := X, Y, W. u_X = px D / sum E and u_W = D / sum E, so u_X = px u_W up to the rounding of each: their intervals
// of rounding meet.
TrialResult decide_position_attributes(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Scene changed = without_attributes(scene);
  show_depth(changed);
  changed.attributes = {{"position", 3, Interpolation::perspective}};
  for (corpus::SceneDraw& draw : changed.draws)
    for (corpus::SceneVertex& v : draw.vertices) v.attributes = {v.x, v.y, v.w};
  const auto image = trial.draw(changed, outputs_of(changed));
  if (!image || image->index.empty()) return trial.verdict();
  // Half the distance to the next float32 on either side, and a factor for doubles' own rounding: a bound, no
  // tolerance.
  const auto half_step = [](float value) {
    const float away = std::nextafter(std::abs(value), std::numeric_limits<float>::infinity());
    return (static_cast<double>(away) - static_cast<double>(std::abs(value))) / 2 * (1 + 0x1p-20);
  };
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(*image, x, y);
      if (image->index[e] == kNoTriangle) continue;
      const float w = image->attributes[0][3 * e + 2];
      for (std::size_t i = 0; i < 2; ++i) {
        const float u = image->attributes[0][3 * e + i];
        if (std::abs(u) == kLargest || std::abs(w) == kLargest) continue;  // beyond range
        trial.looked_at(1);
        const double position = (i == 0 ? x : y) + 0.5;
        const double expected = position * static_cast<double>(w);
        if (!(std::abs(static_cast<double>(u) - expected) <= half_step(u) + position * half_step(w)))
          trial.differs("attribute X or Y over attribute W", x, y, std::to_string(position),
                        text(u) + " over " + text(w));
      }
    }
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"depth-is-position", "I1", "depth of Z := X, Y or W is px, py or 1 to the bit", false, true, 0, make_frame,
     decide_position},
    {"depth-clip", "I5", "depth of exactly 0 and 1 is kept, one pixel further it is clipped or clamped", false, true, 0,
     make_frame, decide_clip},
    {"attribute-range", "I4", "attributes stay within their vertices' range, and constants are constant to the bit",
     false, true, 0, make_frame, decide_range},
    {"interpolation-routes", "I1-I3", "depth, attributes and barycentrics agree to the bit where they are one function",
     false, true, 0, make_frame, decide_routes},
    {"attributes-are-positions", "I2", "attributes X, Y over attribute W are px, py within their rounding", false, true,
     0, make_frame, decide_position_attributes},
};

}  // namespace

std::span<const Property> value_properties() {
  return kProperties;
}

}  // namespace surefill::properties
