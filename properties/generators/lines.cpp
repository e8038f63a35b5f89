// SPDX-License-Identifier: Apache-2.0
//
// Points and lines that are hard to draw, and scenes of them (M7, I6, I7).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "properties/generators/scene_parts.hpp"

namespace surefill::properties {
namespace {

using corpus::Scene;
using corpus::SceneDraw;
using Ends = std::array<Vertex, 2>;

constexpr float kMax = std::numeric_limits<float>::max();

template <typename Value, std::size_t Count>
Value one_of(Random& random, const Value (&values)[Count]) {
  return values[random.below(static_cast<std::uint32_t>(Count))];
}

float power_of_two(Random& r, int low, int high) {
  return std::ldexp(1.0f, r.between(low, high));
}

float nudged(Random& r, float value) {
  const float result = std::nextafter(value, r.one_in(2) ? kMax : -kMax);
  return std::isfinite(result) ? result : value;
}

struct Place {
  float x, y;
};

Vertex at(const Place& p, float w = 1) {
  return {p.x * w, p.y * w, 0, w};
}

// On a lattice of 1/q pixel, on the target or up to three pixels off it.
Place lattice(Random& r, int width, int height, int q) {
  const auto along = [&](int size) {
    return static_cast<float>(r.between(-3 * q, (size + 3) * q)) / static_cast<float>(q);
  };
  const float x = along(width);
  return {x, along(height)};
}

Place centre(Random& r, int width, int height) {
  const float x = static_cast<float>(r.between(0, width - 1)) + 0.5f;
  return {x, static_cast<float>(r.between(0, height - 1)) + 0.5f};
}

// A factor W of an end in front: exact for lattices.
float some_w(Random& r) {
  return r.one_in(2) ? 1.0f : one_of(r, {2.0f, 0.5f, 3.0f, 0.25f, 7.0f});
}

// The vertex at a place, in front of the eye or behind it. (The order in which arguments are evaluated is the compiler's
// choice, so no expression draws two random numbers.)
Vertex in_front(Random& r, const Place& p) {
  return at(p, some_w(r));
}
Vertex behind(Random& r, const Place& p) {
  return at(p, -some_w(r));
}
float below_two_to(Random& r, int low, int high) {
  const auto fraction = static_cast<float>(r.unit());
  return std::ldexp(fraction, r.between(low, high));
}

// Depth: often the same for many, often on the limits of I5.
Ends with_depths(Random& r, Ends ends) {
  const std::uint32_t kind = r.below(6);
  for (Vertex& v : ends) {
    const float steps[] = {0, 0.25f, 0.5f, 1, 1.25f, -0.25f, static_cast<float>(r.unit())};
    if (kind < 2) v.z = v.w / 2;
    if (kind == 2 || kind == 3) v.z = v.w * one_of(r, steps);
    if (kind == 4) v.z = static_cast<float>(r.unit());
    if (kind == 5) v.z = below_two_to(r, -149, 127);
    if (!std::isfinite(v.z)) v.z = 0;
  }
  return ends;
}

Ends on_lattice(Random& r, int width, int height, int q) {
  const Place from = lattice(r, width, height, q), to = lattice(r, width, height, q);
  return {in_front(r, from), in_front(r, to)};
}

// The categories, in the order of the table below.

Ends lattice_2(Random& r, int w, int h) {
  return on_lattice(r, w, h, 2);
}
Ends lattice_16(Random& r, int w, int h) {
  return on_lattice(r, w, h, 16);
}

// dx = dy or -dy exactly.
Ends diagonal(Random& r, int w, int h) {
  const Place from = lattice(r, w, h, one_of(r, {1, 2, 4, 16}));
  const float step = static_cast<float>(r.between(-4 * w, 4 * w)) / 4, turn = r.one_in(2) ? 1.0f : -1.0f;
  const float of_w = some_w(r);
  return {at(from, of_w), at({from.x + step, from.y + turn * step}, some_w(r))};
}

// Along a row or a column, on half pixels: through samples, or through the corners of their diamonds.
Ends level(Random& r, int w, int h) {
  Place from = lattice(r, w, h, 2), to = lattice(r, w, h, 2);
  (r.one_in(2) ? to.x : to.y) = 0;
  if (to.x == 0) to.x = from.x;
  if (to.y == 0) to.y = from.y;
  return {in_front(r, from), in_front(r, to)};
}

// From a side or a corner of one sample's diamond to that of another one, or one ulp off it.
Ends diamond_sides(Random& r, int w, int h) {
  const auto end = [&] {
    const Place s = centre(r, w, h);
    const float along = static_cast<float>(r.between(0, 8)) / 16, x = r.one_in(2) ? along : -along,
                y = r.one_in(2) ? 0.5f - along : along - 0.5f;
    Vertex v = at({s.x + x, s.y + y}, some_w(r));
    if (r.one_in(3)) v.x = nudged(r, v.x);
    if (r.one_in(3)) v.y = nudged(r, v.y);
    return v;
  };
  const Vertex from = end();
  return {from, end()};
}

// Through a corner of a diamond in the direction of whole pixels, or one ulp off.
Ends through_corners(Random& r, int w, int h) {
  Place corner = centre(r, w, h);
  const float half = r.one_in(2) ? 0.5f : -0.5f;
  (r.one_in(2) ? corner.x : corner.y) += half;
  const auto dx = static_cast<float>(r.between(-5, 5)), dy = static_cast<float>(r.between(-5, 5));
  const float back = static_cast<float>(r.between(0, 16)) / 4, ahead = static_cast<float>(r.between(1, 16)) / 4;
  Ends ends = {at({corner.x - back * dx, corner.y - back * dy}), at({corner.x + ahead * dx, corner.y + ahead * dy})};
  if (r.one_in(2)) {
    Vertex& v = ends[r.below(2)];
    float& component = r.one_in(3) ? v.w : r.one_in(2) ? v.x : v.y;
    component = nudged(r, component);
  }
  return ends;
}

// No length on the screen, or next to none.
Ends zero_length(Random& r, int w, int h) {
  const Place p = r.one_in(2) ? centre(r, w, h) : lattice(r, w, h, 16);
  Ends ends = {in_front(r, p), in_front(r, p)};
  if (r.one_in(3)) ends[1].x = nudged(r, ends[1].x);
  if (r.one_in(3)) ends[1].y = nudged(r, ends[1].y);
  if (r.one_in(4)) ends[1] = ends[0];
  return ends;
}

// One end behind the eye, or at W = 0.
Ends one_behind(Random& r, int w, int h) {
  const int q = one_of(r, {1, 2, 2, 16});
  Ends ends = {in_front(r, lattice(r, w, h, q)), behind(r, lattice(r, w, h, q))};
  if (r.one_in(3)) {
    ends[1] = {static_cast<float>(r.between(-3, 3)), static_cast<float>(r.between(-3, 3)), 0, 0};
    if (r.one_in(4)) ends[1].w = -0.0f;
  }
  if (r.one_in(2)) std::swap(ends[0], ends[1]);
  return ends;
}

// One end behind the eye, and its place less than a pixel from the other end's, which a ray has at its back.
Ends behind_beside(Random& r, int w, int h) {
  const Place p = r.one_in(2) ? centre(r, w, h) : lattice(r, w, h, 16);
  const float x = p.x + static_cast<float>(r.between(-12, 12)) / 16;
  const float y = p.y + static_cast<float>(r.between(-2, 2)) / 16;
  Ends ends = {in_front(r, p), behind(r, {x, y})};
  if (r.one_in(2)) {
    for (Vertex& v : ends) std::swap(v.x, v.y);
  }
  if (r.one_in(2)) std::swap(ends[0], ends[1]);
  return ends;
}

Ends both_behind(Random& r, int w, int h) {
  Ends ends = {behind(r, lattice(r, w, h, 2)), behind(r, lattice(r, w, h, 2))};
  if (r.one_in(3)) ends[r.below(2)].w = 0;
  if (r.one_in(4)) ends[0].w = ends[1].w = 0;
  return ends;
}

// The line passes the eye: S is one point, or the eye is an end. Or it passes it by one ulp.
Ends through_eye(Random& r, int w, int h) {
  const Vertex v = in_front(r, r.one_in(2) ? centre(r, w, h) : lattice(r, w, h, 2));
  const float factor = -some_w(r);
  Ends ends = {v, {v.x * factor, v.y * factor, 0, v.w * factor}};
  if (r.one_in(3)) ends[1] = {0, 0, 0, 0};
  if (r.one_in(3)) ends[1].x = nudged(r, ends[1].x);
  if (r.one_in(2)) std::swap(ends[0], ends[1]);
  return ends;
}

// From far off the target to far off it, by a sample.
Ends far_ends(Random& r, int w, int h) {
  const Place s = centre(r, w, h);
  const auto dx = static_cast<float>(r.between(-7, 7)), dy = static_cast<float>(r.between(-7, 7));
  const float back = power_of_two(r, 4, 20), ahead = power_of_two(r, 4, 20);
  return {in_front(r, {s.x - back * dx, s.y - back * dy}), in_front(r, {s.x + ahead * dx, s.y + ahead * dy})};
}

Ends scaled(Random& r, Ends ends, int low, int high) {
  for (Vertex& v : ends) {
    const float s = power_of_two(r, low, high);
    v = {v.x * s, v.y * s, v.z * s, v.w * s};
    for (float* component : {&v.x, &v.y, &v.w}) {
      if (!std::isfinite(*component)) *component = kMax;
    }
  }
  return ends;
}
Ends huge(Random& r, int w, int h) {
  return scaled(r, r.one_in(2) ? lattice_16(r, w, h) : one_behind(r, w, h), 100, 127);
}
Ends subnormal(Random& r, int w, int h) {
  return scaled(r, r.one_in(2) ? lattice_2(r, w, h) : one_behind(r, w, h), -149, -126);
}

Ends mixed_exponents(Random& r, int w, int h) {
  return scaled(r, r.one_in(2) ? diamond_sides(r, w, h) : one_behind(r, w, h), -100, 100);
}

Ends perspective(Random& r, int w, int h) {
  const auto end = [&] {
    const auto along = [&r](int size) { return static_cast<float>((2 * r.unit() - 0.5) * size); };
    const float x = along(w), y = along(h);
    return at({x, y}, (1 + static_cast<float>(r.unit())) * power_of_two(r, -3, 3));
  };
  const Vertex from = end();
  return {from, end()};
}

// An edge of a triangle of any category.
Ends edge(Random& r, int w, int h) {
  const std::span<const Category> all = categories();
  const std::array<Vertex, 3> t = all[r.below(static_cast<std::uint32_t>(all.size()))].triangle(r, w, h);
  const std::uint32_t first = r.below(3);
  return {t[first], t[(first + 1) % 3]};
}

constexpr LineCategory kCategories[] = {
    {"line-lattice-2", "Ends lie on corners, centres and mid-sides of pixels.", lattice_2},
    {"line-lattice-16", "Ends lie on the lattice of all samples.", lattice_16},
    {"line-diagonal", "Both coordinates differ by the same amount: either may be the major one.", diagonal},
    {"line-level", "A line runs along a row or a column of samples, or between two.", level},
    {"line-diamond-sides", "Ends lie on sides and corners of samples' diamonds, or one ulp off.", diamond_sides},
    {"line-through-corners", "A line passes corners of diamonds, or passes them by an ulp.", through_corners},
    {"line-zero-length", "Both ends are one place on the screen, or next to it.", zero_length},
    {"line-one-behind", "One end is behind the eye or at W = 0: a ray.", one_behind},
    {"line-behind-beside", "One end is behind the eye, less than a pixel beside the other one.", behind_beside},
    {"line-both-behind", "Both ends are behind the eye or at W = 0.", both_behind},
    {"line-through-eye", "The eye lies on the line, or one ulp beside it.", through_eye},
    {"line-far-ends", "Ends lie up to 2^20 pixels off the target, and the line passes a sample.", far_ends},
    {"line-huge", "Coordinates reach the largest float32.", huge},
    {"line-subnormal", "Coordinates are subnormal.", subnormal},
    {"line-mixed-exponents", "The two ends differ by up to 2^200 in size.", mixed_exponents},
    {"line-perspective", "An ordinary line in perspective.", perspective},
    {"line-edge", "An edge of a triangle of any other category.", edge},
};

// A width: of whole and half pixels, so that samples lie on the border, or of any size.
float some_width(Random& r) {
  switch (r.below(8)) {
    case 0:
      return power_of_two(r, -20, 20);
    case 1:
      return static_cast<float>(r.between(1, 64)) / 8;
    case 2:
      return one_of(r, {kMax, 0x1p-149f, 0x1p-126f, std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f)});
    case 3:
      return below_two_to(r, -2, 4) + 0x1p-24f;
    default:
      return one_of(r, {1.0f, 1.0f, 2.0f, 3.0f, 0.5f, 4.0f, 1.5f});
  }
}

// Appends a line of its own vertices, the next one of a strip, the one before backwards or once more; or a point.
void append(SceneDraw& draw, const Ends& ends, Random& random) {
  auto next = static_cast<std::uint32_t>(draw.vertices.size());
  const auto add = [&](const Vertex& v) {
    draw.vertices.push_back({v.x, v.y, v.z, v.w, {}});
    return next++;
  };
  corpus::SceneTriangle primitive;
  std::array<std::uint32_t, 3>& corners = primitive.vertices;
  const bool first = draw.triangles.empty();
  if (!first && random.one_in(8)) {
    corners = draw.triangles.back().vertices;
  } else if (draw.primitive == Primitive::points) {
    corners.fill(add(ends[0]));
  } else if (!first && random.one_in(3)) {
    const std::array<std::uint32_t, 3> before = draw.triangles.back().vertices;
    const bool back = random.one_in(6);
    corners[0] = before[1];
    corners[1] = corners[2] = back ? before[0] : add(ends[1]);
  } else {
    corners[0] = add(ends[0]);
    corners[1] = add(ends[1]);
    corners[2] = draw.primitive == Primitive::triangles ? add(ends[random.below(2)]) : corners[1];
    if (draw.primitive == Primitive::triangles) draw.vertices.back().x += 2 * draw.vertices.back().w;
  }
  draw.triangles.push_back(primitive);
}

void add_state(SceneDraw& draw, const Scene& scene, Random& random) {
  draw.fill_rule = static_cast<FillRule>(random.below(8));
  if (random.one_in(4)) draw.front_face = FrontFace::counter_clockwise;
  if (random.one_in(4)) draw.cull = one_of(random, {Cull::front, Cull::back});
  if (random.one_in(3)) draw.depth_mode = one_of(random, {DepthMode::clip, DepthMode::clamp});
  if (random.one_in(6)) draw.depth_write = false;
  if (random.one_in(5)) draw.scissor = random_scissor(scene, random);
  if (draw.primitive == Primitive::triangles) return;
  if (random.one_in(6)) draw.culling_box.emplace().fill({-9, -9, 0, 1});  // it is ignored, whatever it says
  const bool thin = draw.primitive == Primitive::points || scene.samples == 1;
  if (!thin || random.one_in(2)) draw.width = some_width(random);
}

}  // namespace

std::span<const LineCategory> line_categories() {
  return kCategories;
}

Scene lines_scene(const LineCategory& category, std::uint64_t seed, int max_size, int max_primitives) {
  const auto number = static_cast<std::uint64_t>(&category - std::begin(kCategories));
  Random random(seed * 0x9E3779B97F4A7C15u + (number + 1) * 0xD1B54A32D192ED03u);
  Scene scene;
  scene.comment = "Points and lines, category " + std::string(category.name) + ", seed " + std::to_string(seed);
  scene.width = random.between(1, max_size);
  scene.height = random.between(1, max_size);
  if (random.one_in(3)) scene.samples = one_of(random, {2, 4, 8, 16});
  if (random.one_in(2)) scene.attribute_location = AttributeLocation::centroid;

  // Mostly lines; one draw may be of triangles, which are seen or not behind the others.
  const int primitives = random.between(1, max_primitives);
  const int draws = random.one_in(3) ? random.between(1, std::min(3, primitives)) : 1;
  scene.draws.resize(static_cast<std::size_t>(draws));
  for (SceneDraw& draw : scene.draws) {
    draw.primitive = random.one_in(3) ? Primitive::points : Primitive::lines;
    if (draws > 1 && random.one_in(4)) draw.primitive = Primitive::triangles;
  }
  for (int i = 0; i < primitives; ++i) {
    const bool same = i < draws || random.one_in(2);
    const LineCategory& used =
        same ? category : kCategories[random.below(static_cast<std::uint32_t>(std::size(kCategories)))];
    Ends ends = used.line(random, scene.width, scene.height);
    if (used.line != edge) ends = with_depths(random, ends);
    append(scene.draws[static_cast<std::size_t>(i % draws)], ends, random);
  }
  for (SceneDraw& draw : scene.draws) add_state(draw, scene, random);

  // A frame with a conservative draw has counts alone (M4).
  SceneDraw& last = scene.draws.back();
  const bool conservative = last.primitive == Primitive::triangles && scene.samples == 1 && random.one_in(3);
  if (conservative) {
    last.conservative = static_cast<Conservative>(1 + random.below(4));
    last.depth_mode = DepthMode::none;
    for (SceneDraw& draw : scene.draws) draw.depth_write = true;
  } else {
    add_attributes(scene, random);
    if (random.one_in(3)) add_initial_depth(scene, random);
    if (random.one_in(3)) {
      scene.layers = one_of(random, {2, 3, 5, kMaxLayers});
      for (SceneDraw& draw : scene.draws) draw.depth_write = true;
    }
    if (random.one_in(3)) set_locations(scene, random);
  }
  if (random.one_in(4)) set_origin(scene, random);
  scene.depth_test = static_cast<DepthTest>(random.below(4));
  if (random.one_in(4)) {
    add_identifiers(scene, random);
  } else if (random.one_in(4)) {
    scene.draws[0].first_index = one_of(random, {7u, 0x7FFFFFFFu, kNoTriangle - 1000u});
  }
  scene.more = {random.one_in(2), random.one_in(2), random.one_in(2)};
  return scene;
}

}  // namespace surefill::properties
