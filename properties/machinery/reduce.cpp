// SPDX-License-Identifier: Apache-2.0
//
// Every step makes (draws, primitives, samples of the target, state, numbers) smaller in this order, so reduction ends.
#include "properties/machinery/reduce.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "corpus/draw_fields.hpp"
#include "corpus/names.hpp"

namespace surefill::properties {

namespace {

using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

// Gets a simpler scene; true ends the enumeration.
using Visit = std::function<bool(Scene&&)>;

// --- Draws and primitives

// Leaves out the vertices that nothing names; the image stays the same.
void drop_unused_vertices(SceneDraw& draw) {
  std::vector<std::uint32_t> number(draw.vertices.size(), 0);
  for (const auto& triangle : draw.triangles) {
    for (const std::uint32_t vertex : triangle.vertices) number[vertex] = 1;
  }
  std::vector<SceneVertex> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(std::move(draw.vertices[i]));
  }
  draw.vertices = std::move(kept);
  for (auto& triangle : draw.triangles) {
    for (std::uint32_t& vertex : triangle.vertices) vertex = number[vertex];
  }
}

template <typename Item>
void erase_range(std::vector<Item>& items, std::size_t begin, std::size_t end) {
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(begin), items.begin() + static_cast<std::ptrdiff_t>(end));
}

// The scene without triangles [begin, end) of a draw.
Scene without_triangles(const Scene& scene, std::size_t draw, std::size_t begin, std::size_t end) {
  Scene simpler = scene;
  erase_range(simpler.draws[draw].triangles, begin, end);
  drop_unused_vertices(simpler.draws[draw]);
  return simpler;
}

bool simpler_draws(const Scene& scene, const Visit& visit) {
  for (std::size_t chunk = scene.draws.size() / 2; chunk > 0; chunk /= 2) {
    for (std::size_t begin = 0; begin < scene.draws.size(); begin += chunk) {
      Scene simpler = scene;
      erase_range(simpler.draws, begin, std::min(begin + chunk, scene.draws.size()));
      if (visit(std::move(simpler))) return true;
    }
  }
  return false;
}

bool simpler_primitives(const Scene& scene, const Visit& visit) {
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    const SceneDraw& draw = scene.draws[d];
    const std::size_t total = draw.triangles.size();
    for (std::size_t chunk = (total + 1) / 2; chunk > 0; chunk /= 2) {
      for (std::size_t begin = 0; begin < total; begin += chunk) {
        if (visit(without_triangles(scene, d, begin, std::min(begin + chunk, total)))) return true;
      }
    }
  }
  return false;
}

// --- The target

int saturated(std::int64_t value) {
  return static_cast<int>(
      std::clamp<std::int64_t>(value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

// Moves what is in the scene by (-x, -y) pixels; rounded where there is no viewport or the numbers are odd.
void move_by(Scene& scene, int x0, int y0) {
  const auto move = [x0, y0](auto& vertex) {
    vertex.x -= static_cast<float>(x0) * vertex.w;
    vertex.y -= static_cast<float>(y0) * vertex.w;
  };
  for (SceneDraw& draw : scene.draws) {
    draw.culling_box.reset();  // whose promise (M6) a rounded move could break
    if (draw.viewport) {
      draw.viewport->x -= static_cast<float>(x0);
      draw.viewport->y -= static_cast<float>(y0);
    } else {
      for (SceneVertex& vertex : draw.vertices) move(vertex);
    }
    if (draw.scissor) {
      draw.scissor->x0 = saturated(std::int64_t{draw.scissor->x0} - x0);
      draw.scissor->x1 = saturated(std::int64_t{draw.scissor->x1} - x0);
      draw.scissor->y0 = saturated(std::int64_t{draw.scissor->y0} - y0);
      draw.scissor->y1 = saturated(std::int64_t{draw.scissor->y1} - y0);
    }
  }
}

// The same target in the same place, with its corner at the origin (S6).
void move_to_origin(Scene& scene) {
  move_by(scene, scene.origin.x, scene.origin.y);
  scene.origin = {};
}

// The pixels [x0, x0 + width) x [y0, y0 + height) of the scene's target, moved to the origin. With x0 = y0 = 0 exact;
// else the move rounds, and the result is a scene like it.
Scene cropped(const Scene& scene, int x0, int y0, int width, int height) {
  Scene simpler = scene;
  simpler.width = width;
  simpler.height = height;
  if (scene.initial_depth.size() > 1) {
    simpler.initial_depth.clear();
    const std::size_t samples = static_cast<std::size_t>(scene.samples);
    for (int y = y0; y < y0 + height; ++y) {
      const std::size_t begin =
          (static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x0)) *
          samples;
      for (std::size_t i = begin; i < begin + static_cast<std::size_t>(width) * samples; ++i) {
        simpler.initial_depth.push_back(scene.initial_depth[i]);
      }
    }
  }
  if (x0 != 0 || y0 != 0) move_by(simpler, x0, y0);
  return simpler;
}
bool simpler_target(const Scene& scene, const Visit& visit) {
  // The pixels that some scissor leaves are the likeliest to matter: without it, scenes of one far pixel shrink slowly.
  for (const SceneDraw& draw : scene.draws) {
    if (!draw.scissor) continue;
    const auto within = [](int side, int origin, int size) {
      return static_cast<int>(std::clamp<std::int64_t>(std::int64_t{side} - origin, 0, size));
    };
    const int x0 = within(draw.scissor->x0, scene.origin.x, scene.width);
    const int x1 = within(draw.scissor->x1, scene.origin.x, scene.width);
    const int y0 = within(draw.scissor->y0, scene.origin.y, scene.height);
    const int y1 = within(draw.scissor->y1, scene.origin.y, scene.height);
    if (x0 >= x1 || y0 >= y1 || (x1 - x0 == scene.width && y1 - y0 == scene.height)) continue;
    if (visit(cropped(scene, x0, y0, x1 - x0, y1 - y0))) return true;
    if ((x1 < scene.width || y1 < scene.height) && visit(cropped(scene, 0, 0, x1, y1))) return true;
  }
  for (int cut = scene.width / 2; cut > 0; cut /= 2) {
    if (visit(cropped(scene, 0, 0, scene.width - cut, scene.height))) return true;
    if (visit(cropped(scene, cut, 0, scene.width - cut, scene.height))) return true;
  }
  for (int cut = scene.height / 2; cut > 0; cut /= 2) {
    if (visit(cropped(scene, 0, 0, scene.width, scene.height - cut))) return true;
    if (visit(cropped(scene, 0, cut, scene.width, scene.height - cut))) return true;
  }
  if (scene.samples > 1) {
    for (int samples = 1; samples < scene.samples; samples *= 2) {
      Scene simpler = scene;
      simpler.samples = samples;
      if (!scene.sample_locations.empty()) simpler.sample_locations.resize(static_cast<std::size_t>(samples));
      if (scene.initial_depth.size() > 1) {
        const std::size_t pixels = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
        simpler.initial_depth.clear();
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
          for (int n = 0; n < samples; ++n) {
            simpler.initial_depth.push_back(
                scene.initial_depth[pixel * static_cast<std::size_t>(scene.samples) + static_cast<std::size_t>(n)]);
          }
        }
      }
      if (visit(std::move(simpler))) return true;
    }
  }
  return false;
}

// --- State

// Visits the scene with `change` applied. Changes are made only where they take something away.
template <typename Change>
bool with(const Scene& scene, const Visit& visit, const Change& change) {
  Scene simpler = scene;
  change(simpler);
  return visit(std::move(simpler));
}

// Vertices through the viewport of the draw, as pixel-homogeneous ones.
void apply_viewport(SceneDraw& draw) {
  for (SceneVertex& vertex : draw.vertices) {
    const ClipVertex clip{vertex.x, vertex.y, vertex.z, vertex.w};
    Vertex pixel{};
    if (to_pixel(*draw.viewport, {&clip, 1}, {&pixel, 1}) != Status::ok) continue;
    vertex.x = pixel.x;
    vertex.y = pixel.y;
    vertex.z = pixel.z;
    vertex.w = pixel.w;
  }
  draw.viewport.reset();
}

bool simpler_frame_state(const Scene& scene, const Visit& visit) {
  for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < k; ++i) offset += scene.attributes[i].components;
    const std::size_t components = scene.attributes[k].components;
    if (with(scene, visit, [&](Scene& s) {
          s.attributes.erase(s.attributes.begin() + static_cast<std::ptrdiff_t>(k));
          for (SceneDraw& draw : s.draws) {
            for (SceneVertex& vertex : draw.vertices) erase_range(vertex.attributes, offset, offset + components);
            auto& own = draw.interpolations;
            if (k < own.size()) own.erase(own.begin() + static_cast<std::ptrdiff_t>(k));
          }
        })) {
      return true;
    }
    if (components > 1 && with(scene, visit, [&](Scene& s) {
          s.attributes[k].components = 1;
          for (SceneDraw& draw : s.draws) {
            for (SceneVertex& vertex : draw.vertices) erase_range(vertex.attributes, offset + 1, offset + components);
          }
        })) {
      return true;
    }
    if (scene.attributes[k].interpolation != Interpolation::perspective &&
        with(scene, visit, [&](Scene& s) { s.attributes[k].interpolation = Interpolation::perspective; })) {
      return true;
    }
  }
  if (!scene.initial_depth.empty()) {
    if (with(scene, visit, [](Scene& s) { s.initial_depth.clear(); })) return true;
    // Number of values: the first serves all.
    if (scene.initial_depth.size() > 1 && with(scene, visit, [](Scene& s) { s.initial_depth.resize(1); })) return true;
  }
  if (scene.depth_test != DepthTest::less && with(scene, visit, [](Scene& s) { s.depth_test = DepthTest::less; })) {
    return true;
  }
  for (const auto& [word, member] : corpus::kMoreOutputs) {
    if (scene.more.*member && with(scene, visit, [m = member](Scene& s) { s.more.*m = false; })) return true;
  }
  if (!scene.sample_locations.empty() && with(scene, visit, [](Scene& s) { s.sample_locations.clear(); })) return true;
  for (int layers = 1; layers < scene.layers; layers *= 2) {
    if (with(scene, visit, [layers](Scene& s) { s.layers = layers; })) return true;
  }
  if (scene.origin != Origin{}) {
    if (with(scene, visit, [](Scene& s) { s.origin = {}; })) return true;
    if (with(scene, visit, [](Scene& s) { move_to_origin(s); })) return true;
    if (scene.origin.x != 0 && with(scene, visit, [](Scene& s) { s.origin.x /= 2; })) return true;
    if (scene.origin.y != 0 && with(scene, visit, [](Scene& s) { s.origin.y /= 2; })) return true;
  }
  return scene.attribute_location != AttributeLocation::centre &&
         with(scene, visit, [](Scene& s) { s.attribute_location = AttributeLocation::centre; });
}

bool simpler_draw_state(const Scene& scene, std::size_t d, const Visit& visit) {
  const SceneDraw& draw = scene.draws[d];
  const auto changed = [&](auto change) { return with(scene, visit, [&](Scene& s) { change(s.draws[d]); }); };
  if (draw.viewport && changed([](SceneDraw& x) { apply_viewport(x); })) return true;
  if (corpus::any_draw_field([&](const auto& field) {
        using Value = std::remove_cvref_t<decltype(draw.*field.member)>;
        const Value plain = DrawState{}.*field.member;
        if (draw.*field.member == plain) return false;
        return changed([&](SceneDraw& x) { x.*field.member = plain; });
      })) {
    return true;
  }
  if (draw.grid) {
    if (draw.grid->offset_x != 0 && changed([](SceneDraw& x) { x.grid->offset_x = 0; })) return true;
    if (draw.grid->offset_y != 0 && changed([](SceneDraw& x) { x.grid->offset_y = 0; })) return true;
    if (draw.grid->rounding != Grid{}.rounding && changed([](SceneDraw& x) { x.grid->rounding = Grid{}.rounding; }))
      return true;
  }
  if (!draw.interpolations.empty() && changed([](SceneDraw& x) { x.interpolations.clear(); })) return true;
  if (draw.first_index && changed([](SceneDraw& x) { x.first_index.reset(); })) return true;
  const bool identified = !draw.triangles.empty() && draw.triangles.front().identifier.has_value();
  return identified && changed([](SceneDraw& x) {
           for (auto& triangle : x.triangles) triangle.identifier.reset();
         });
}

bool simpler_state(const Scene& scene, const Visit& visit) {
  if (simpler_frame_state(scene, visit)) return true;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    if (simpler_draw_state(scene, d, visit)) return true;
  }
  return false;
}

// --- Numbers

// How hard a number is to read: 0 is easiest, then 1, small integers and short binary fractions; NaN and infinities are
// hardest. Every candidate below lowers it.
int complexity(float value) {
  if (std::isnan(value)) return 1000;
  const int sign = std::signbit(value) ? 1 : 0;
  if (std::isinf(value)) return 900 + sign;
  if (value == 0) return sign;
  int exponent = 0;
  const float fraction = std::frexp(std::fabs(value), &exponent);  // [1/2, 1)
  const std::uint32_t mantissa = static_cast<std::uint32_t>(std::ldexp(fraction, 24));
  const int bits = 24 - std::countr_zero(mantissa);
  return 2 + 4 * bits + std::abs(exponent - 1) + sign;  // |bits| first: one significant bit is worth a factor of 16
}

// Simpler numbers near `value`, simplest first.
std::vector<float> simpler_numbers(float value) {
  std::vector<float> candidates{0.0f, 1.0f};
  if (std::isfinite(value) && value != 0) {
    candidates.push_back(-1.0f);
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    for (const int bits : {1, 2, 3, 4, 6, 8, 12, 16, 20, 23}) {
      const float scaled = std::ldexp(fraction, bits);
      candidates.push_back(std::ldexp(std::trunc(scaled), exponent - bits));
      candidates.push_back(std::ldexp(std::trunc(scaled) + std::copysign(1.0f, scaled), exponent - bits));
    }
    candidates.push_back(std::trunc(value));
    for (const int closer : {exponent / 2, exponent - 8, exponent + 8, exponent - 1, exponent + 1}) {
      candidates.push_back(std::ldexp(fraction, closer));
    }
    candidates.push_back(std::fabs(value));
  } else if (std::isinf(value)) {
    candidates.push_back(std::copysign(std::numeric_limits<float>::max(), value));
    candidates.push_back(std::fabs(value));
  } else if (std::isnan(value)) {
    candidates.push_back(std::numeric_limits<float>::infinity());
  }
  const int limit = complexity(value);
  std::erase_if(candidates, [limit](float candidate) { return complexity(candidate) >= limit; });
  const auto key = [](float candidate) {
    return std::pair(complexity(candidate), std::bit_cast<std::uint32_t>(candidate));
  };
  std::sort(candidates.begin(), candidates.end(), [key](float a, float b) { return key(a) < key(b); });
  candidates.erase(
      std::unique(candidates.begin(), candidates.end(), [key](float a, float b) { return key(a) == key(b); }),
      candidates.end());
  return candidates;
}

// Pointers to all floats of a scene that may be made simpler, in a fixed order. A viewport stays finite by itself:
// finite numbers become finite ones. A draw inside a culling box stays as it is, so that the promise (M6) holds.
std::vector<float*> numbers(Scene& scene) {
  std::vector<float*> all;
  for (SceneDraw& draw : scene.draws) {
    if (draw.culling_box) continue;
    for (SceneVertex& vertex : draw.vertices) {
      for (float* value : {&vertex.w, &vertex.z, &vertex.x, &vertex.y}) all.push_back(value);
      for (float& value : vertex.attributes) all.push_back(&value);
    }
    if (draw.viewport) {
      for (float* value : {&draw.viewport->x, &draw.viewport->y, &draw.viewport->width, &draw.viewport->height,
                           &draw.viewport->near_depth, &draw.viewport->far_depth}) {
        all.push_back(value);
      }
    }
  }
  for (float& value : scene.initial_depth) all.push_back(&value);
  return all;
}

// Beyond this many numbers a scene is not made readable number by number.
constexpr std::size_t kMaxNumbers = 4096;

bool simpler_values(const Scene& scene, const Visit& visit) {
  Scene work = scene;
  const std::vector<float*> all = numbers(work);
  if (all.size() > kMaxNumbers) return false;
  for (float* value : all) {
    const float original = *value;
    for (const float candidate : simpler_numbers(original)) {
      *value = candidate;
      if (visit(Scene(work))) return true;
    }
    *value = original;
  }
  return false;
}

// --- All of it

bool enumerate(const Scene& scene, const Visit& visit) {
  return simpler_draws(scene, visit) || simpler_primitives(scene, visit) || simpler_target(scene, visit) ||
         simpler_state(scene, visit) || simpler_values(scene, visit);
}

}  // namespace

std::vector<corpus::Scene> simpler_scenes(const corpus::Scene& scene) {
  std::vector<Scene> scenes;
  enumerate(scene, [&](Scene&& simpler) {
    scenes.push_back(std::move(simpler));
    return false;
  });
  return scenes;
}

corpus::Scene reduce(corpus::Scene scene, const std::function<bool(const corpus::Scene&)>& still_fails,
                     const ReduceLimits& limits) {
  const auto deadline = std::chrono::steady_clock::now() + limits.time;
  const auto out_of_time = [deadline] { return std::chrono::steady_clock::now() >= deadline; };
  // Many triangles first: halves, quarters, ..., each size once through the draw, so n log n at worst for one culprit.
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    for (std::size_t chunk = (scene.draws[d].triangles.size() + 1) / 2; chunk > 0; chunk /= 2) {
      for (std::size_t begin = 0; begin < scene.draws[d].triangles.size() && !out_of_time();) {
        const std::size_t end = std::min(begin + chunk, scene.draws[d].triangles.size());
        Scene simpler = without_triangles(scene, d, begin, end);
        if (still_fails(simpler)) {
          scene = std::move(simpler);
        } else {
          begin = end;
        }
      }
    }
  }
  for (bool progress = true; progress && !out_of_time();) {
    progress = false;
    Scene next;
    enumerate(scene, [&](Scene&& simpler) {
      if (out_of_time()) return true;
      if (!still_fails(simpler)) return false;
      next = std::move(simpler);
      progress = true;
      return true;
    });
    if (progress) scene = std::move(next);
  }
  return scene;
}

}  // namespace surefill::properties
