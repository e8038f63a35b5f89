// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "properties/generators/scene_parts.hpp"

namespace surefill::properties {
namespace {

using corpus::Scene;
using corpus::SceneAttribute;
using corpus::SceneDraw;
using corpus::SceneVertex;

constexpr float kMax = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class T, std::size_t N>
T one_of(Random& random, const T (&values)[N]) {
  return values[random.below(static_cast<std::uint32_t>(N))];
}

// The seed of a scene depends on the category's name, not on its place in the table.
std::uint64_t mixed(std::string_view name, std::uint64_t seed) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return Random(hash ^ Random(seed).bits()).bits();
}

float random_finite(Random& random) {
  return std::bit_cast<float>((static_cast<std::uint32_t>(random.bits()) & 0x807FFFFFu) | (random.below(255) << 23));
}

// A source of attribute values of one kind, so that the three values of a triangle are hard together.
class AttributeValues {
 public:
  explicit AttributeValues(Random& random)
      : kind_(random.below(9)),
        base_(static_cast<float>(random.unit() * 2 - 1)),
        exponent_(random.one_in(3) ? -random.between(120, 148) : -random.between(0, 20)) {}

  float operator()(Random& random) const {
    constexpr float kEnds[] = {kMax, -kMax, 0x1p-149f, -0x1p-149f, 0x1p-126f, 0.0f, -0.0f};
    switch (kind_) {
      case 0:
        return base_;  // constant (I4)
      case 1:
        return random.one_in(2) ? base_ : std::nextafter(base_, kInfinity);  // neighbours: halfway cases
      case 2:
        return random.one_in(2) ? base_ * 0x1p80f : -base_ * 0x1p80f;  // cancellation
      case 3:
        return std::ldexp(static_cast<float>(random.between(-9, 9)), -149);  // subnormals
      case 4:
        return one_of(random, kEnds);  // overflow, underflow
      case 5:
        return static_cast<float>(random.below(2));  // 0 and 1
      case 6:
        return std::ldexp(1 + static_cast<float>(random.below(1u << 23)) * 0x1p-23f, exponent_);
      case 7:
        return random_finite(random);
      default:
        return static_cast<float>(random.unit());
    }
  }

 private:
  std::uint32_t kind_;
  float base_;
  int exponent_;
};

}  // namespace

void add_attributes(Scene& scene, Random& random) {
  const int count = random.between(0, 3);
  std::vector<AttributeValues> sources;
  for (int i = 0; i < count; ++i) {
    SceneAttribute attribute;
    attribute.name = std::string("a").append(std::to_string(i));
    attribute.components = 1 + random.below(kMaxComponents);
    attribute.interpolation =
        one_of(random, {Interpolation::perspective, Interpolation::noperspective, Interpolation::flat});
    for (std::uint32_t c = 0; c < attribute.components; ++c) sources.emplace_back(random);
    scene.attributes.push_back(std::move(attribute));
  }
  for (SceneDraw& draw : scene.draws)
    for (SceneVertex& vertex : draw.vertices)
      for (const AttributeValues& source : sources) vertex.attributes.push_back(source(random));
  if (!sources.empty() && random.one_in(16)) {  // B1 counts attributes, too
    std::vector<float>& values = scene.draws[0].vertices[0].attributes;
    values[random.below(static_cast<std::uint32_t>(values.size()))] =
        one_of(random, {kInfinity, std::numeric_limits<float>::quiet_NaN()});
  }
}

namespace {

// Appends a triangle: of its own vertices or sharing an edge, or equal to the one before (ties of every kind).
void append_triangle(SceneDraw& draw, const std::array<Vertex, 3>& vertices, Random& random) {
  const auto first = static_cast<std::uint32_t>(draw.vertices.size());
  corpus::SceneTriangle triangle;
  if (!draw.triangles.empty() && random.one_in(3)) {
    triangle = draw.triangles.back();
    std::rotate(triangle.vertices.begin(), triangle.vertices.begin() + 1, triangle.vertices.end());
    if (random.one_in(4)) {
      if (random.one_in(2)) std::swap(triangle.vertices[0], triangle.vertices[1]);
      draw.triangles.push_back(triangle);
      return;
    }
    std::swap(triangle.vertices[0], triangle.vertices[1]);
    triangle.vertices[2] = first;
    draw.vertices.push_back({vertices[0].x, vertices[0].y, vertices[0].z, vertices[0].w, {}});
  } else {
    for (const Vertex& v : vertices) draw.vertices.push_back({v.x, v.y, v.z, v.w, {}});
    triangle.vertices = {first, first + 1, first + 2};
  }
  draw.triangles.push_back(triangle);
}

}  // namespace

Scissor random_scissor(const Scene& scene, Random& random) {
  const int x0 = random.between(-2, scene.width), y0 = random.between(-2, scene.height);
  if (random.one_in(16)) return {std::numeric_limits<int>::min(), y0, std::numeric_limits<int>::max(), scene.height};
  return {x0, y0, x0 + random.between(-1, scene.width), y0 + random.between(-1, scene.height)};
}

// Unique within the scene, in any order, from anywhere in the range.
void add_identifiers(Scene& scene, Random& random) {
  std::size_t total = 0;
  for (const SceneDraw& draw : scene.draws) total += draw.triangles.size();
  std::vector<std::uint32_t> identifiers(total);
  const auto highest = static_cast<std::uint32_t>(kNoTriangle - total);
  std::iota(identifiers.begin(), identifiers.end(), random.one_in(2) ? 0u : random.one_in(2) ? highest : 1000u);
  for (std::size_t i = total; i > 1; --i)
    std::swap(identifiers[i - 1], identifiers[random.below(static_cast<std::uint32_t>(i))]);
  for (SceneDraw& draw : scene.draws)
    for (corpus::SceneTriangle& triangle : draw.triangles) {
      triangle.identifier = identifiers.back();
      identifiers.pop_back();
    }
}

void add_initial_depth(Scene& scene, Random& random) {
  const std::size_t values = random.one_in(2)
                                 ? 1
                                 : static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height) *
                                       static_cast<std::size_t>(scene.samples);
  for (std::size_t i = 0; i < values; ++i)
    scene.initial_depth.push_back(
        one_of(random, {0.5f, 1.0f, 0.0f, -0.0f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(),
                        0x1p-149f, static_cast<float>(random.unit())}));
}

namespace {

void add_draw_state(SceneDraw& draw, const Scene& scene, Random& random) {
  draw.fill_rule = static_cast<FillRule>(random.below(8));
  if (random.one_in(2)) draw.front_face = FrontFace::counter_clockwise;
  if (random.one_in(3)) draw.cull = one_of(random, {Cull::front, Cull::back});
  if (random.one_in(2)) draw.depth_mode = one_of(random, {DepthMode::clip, DepthMode::clamp});
  if (random.one_in(4)) draw.depth_write = false;
  if (random.one_in(4)) draw.scissor = random_scissor(scene, random);
  if (random.one_in(8)) {
    // The viewport of the identity map (S3) keeps a category's aim; any other moves it.
    Viewport identity{-1, -1, 2, 2, 0, 1, ClipDepth::zero_to_one, ClipY::down};
    if (random.one_in(2))
      identity = {static_cast<float>(random.between(-2, 2)),
                  static_cast<float>(random.between(-2, 2)),
                  static_cast<float>(scene.width),
                  static_cast<float>(scene.height) / 4,
                  0.25f,
                  1,
                  one_of(random, {ClipDepth::zero_to_one, ClipDepth::minus_one_to_one}),
                  one_of(random, {ClipY::up, ClipY::down})};
    draw.viewport = identity;
  }
}

Grid random_grid(Random& random) {
  return {one_of(random, {8, 8, 4, 0, 1, 2, 6, 10, 12}), random.one_in(2) ? 0 : random.between(0, 15),
          random.one_in(2) ? 0 : random.between(0, 15),
          one_of(random, {GridRounding::nearest_even, GridRounding::nearest_up, GridRounding::truncate})};
}

}  // namespace

Scene random_scene(const Category& category, std::uint64_t seed, const SceneLimits& limits) {
  Random random(mixed(category.name, seed));
  Scene scene;
  scene.comment = "Random scene, category " + std::string(category.name) + ", seed " + std::to_string(seed);
  scene.width = random.between(1, limits.max_size);
  scene.height = random.between(1, limits.max_size);
  const bool conservative = limits.conservative && random.one_in(3);
  if (limits.samples && !conservative && random.one_in(2)) scene.samples = one_of(random, {2, 4, 8, 16});

  const int triangles = random.between(1, limits.max_triangles);
  const int draws = limits.state && random.one_in(4) ? random.between(1, std::min(3, triangles)) : 1;
  scene.draws.resize(static_cast<std::size_t>(draws));
  for (int i = 0; i < triangles; ++i) {
    const std::span<const Category> all = categories();
    const bool same = i < draws || random.one_in(2);
    const Category& used = same ? category : all[random.below(static_cast<std::uint32_t>(all.size()))];
    append_triangle(scene.draws[static_cast<std::size_t>(i % draws)], used.triangle(random, scene.width, scene.height),
                    random);
  }
  if (limits.attributes && !conservative) add_attributes(scene, random);

  if (limits.state) {
    for (SceneDraw& draw : scene.draws) add_draw_state(draw, scene, random);
    if (random.one_in(3)) scene.depth_test = DepthTest::greater;
    if (random.one_in(3))
      add_identifiers(scene, random);
    else if (random.one_in(4))
      scene.draws[0].first_index = one_of(random, {7u, 0x7FFFFFFFu, kNoTriangle - 1000u});
    if (!conservative && random.one_in(3)) add_initial_depth(scene, random);
    if (random.one_in(2)) scene.attribute_location = AttributeLocation::centroid;
  }
  for (SceneDraw& draw : scene.draws) {
    if (limits.grid && random.one_in(2)) draw.grid = random_grid(random);
    if (conservative && (&draw == &scene.draws[0] || random.one_in(2))) {
      draw.conservative = one_of(random, {Conservative::over, Conservative::inner});
      draw.depth_mode = DepthMode::none;  // M4
      draw.grid.reset();
    }
  }
  return scene;
}

Scene mixed_scene(const Category& category, std::uint64_t seed, int max_size, int max_triangles) {
  SceneLimits limits;
  limits.max_size = max_size;
  limits.max_triangles = max_triangles;
  limits.samples = (seed & 1) != 0;
  limits.grid = (seed & 2) != 0;
  limits.conservative = seed % 3 == 2;
  return random_scene(category, seed, limits);
}

Scene attribute_scene(Random& random) {
  Scene scene;
  const bool far = random.one_in(3);
  scene.width = far ? random.between(1000, 4000) : random.between(1, 90);
  scene.height = random.between(1, far ? 2 : 40);
  if (random.one_in(4) && !far) scene.samples = 1 << random.between(1, 4);
  if (random.one_in(2)) scene.attribute_location = AttributeLocation::centroid;
  for (std::uint32_t n = 0, most = 1 + random.below(4); n < most; ++n)
    scene.attributes.push_back(
        {std::string(1, static_cast<char>('a' + n)), 1 + random.below(4), static_cast<Interpolation>(random.below(3))});
  scene.draws.resize(1 + random.below(4));
  const int amount = far || random.one_in(3) ? random.between(-149, 120) : 0, size = far ? random.between(-30, 30) : 0;
  for (corpus::SceneDraw& draw : scene.draws) {
    const int reach = 16 * random.between(1, far ? 400 : 20);
    const bool constant = random.one_in(4), perspective = random.one_in(2), fine = far || random.one_in(2);
    if (random.one_in(4)) draw.grid = Grid{random.between(0, 8), 0, 0, static_cast<GridRounding>(random.below(3))};
    if (random.one_in(6)) draw.depth_mode = static_cast<DepthMode>(random.below(3));
    for (std::uint32_t t = 0, count = random.below(40); t < count; ++t) {
      const int x = random.between(0, 16 * scene.width), y = random.between(0, 16 * scene.height);
      const int thin = random.between(0, 24);
      for (int k = 0; k < 3; ++k) {
        float w = perspective ? static_cast<float>(random.between(random.one_in(16) ? -1 : 1, 8)) / 4 : 1.0f;
        if (far) w = std::ldexp(1 + static_cast<float>(random.unit()), random.between(-8, 8) + size);
        const auto place = [&](int from) {
          const float at = static_cast<float>(from + random.between(-reach, reach)) / 16;
          return (fine ? at + static_cast<float>(random.unit()) : at) * w;
        };
        const float at_x = place(x), row = static_cast<float>(y >> 4) + 0.5f;
        const float at_y = far ? (row + std::ldexp(static_cast<float>(2 * random.unit() - 1), -thin)) * w : place(y);
        draw.vertices.push_back({at_x, at_y, static_cast<float>(random.between(0, 8)) / 8 * w, w, {}});
      }
      draw.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, {}});
    }
    for (corpus::SceneVertex& vertex : draw.vertices) {
      for (const corpus::SceneAttribute& attribute : scene.attributes) {
        for (std::uint32_t c = 0; c < attribute.components; ++c) {
          const double value = random.one_in(16) ? -0.0 : constant ? 1.0 / (3 + c) : 2 * random.unit() - 1;
          vertex.attributes.push_back(static_cast<float>(std::ldexp(value, amount)));
        }
      }
    }
  }
  return scene;
}

}  // namespace surefill::properties
