// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "engine/tests/path_cases_parts.hpp"

namespace surefill::properties {
namespace {

// Frames that hide as much as can be: no state that keeps blocks from hiding what lies behind them.
PathScene hiding(corpus::Scene scene, Random& random) {
  PathScene made{std::move(scene), {}, random_threads(random)};
  made.outputs = random_outputs(made.scene, random);
  made.outputs.count = false;
  if (!made.outputs.index && !made.outputs.barycentrics) made.outputs.depth = true;
  return made;
}

// A triangle over the whole of an image of at most 300 x 300.
void append_background(corpus::SceneDraw& draw, float z) {
  append(draw, {{-2, -2, z, 1}, {700, -2, z, 1}, {-2, 700, z, 1}});
}

}  // namespace

// Planes over whole tiles, parallel or crossing, as near to each other as float32 depths can be, about a depth of any
// size or about 0: what hierarchical z may hide and what not is a matter of the last bit.
PathScene layers_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(64, 260), scene.height = random.between(64, 200);
  scene.draws.resize(1 + random.below(2));
  const bool beyond = scene.draws.size() == 2 && random.one_in(4);
  const double base = beyond             ? 0.5 + random.between(-1, 1)
                      : random.one_in(2) ? 0.5
                                         : static_cast<double>(random.below(2));
  const int finest = base == 0 ? 60 : 26;
  const auto small = [&](int most) {
    return std::ldexp(static_cast<double>(random.between(-most, most)), -random.between(4, finest));
  };
  const bool level = random.one_in(6);
  const double dx = level || random.one_in(4) ? 0 : small(4), dy = level || random.one_in(4) ? 0 : small(4);
  const double step = level || random.one_in(4) ? 0 : small(2), tilt = level || random.one_in(3) ? 0 : 1;
  const bool seams = random.one_in(3);  // triangles of a tile's size or less, across the borders of bands
  double z = base;
  for (corpus::SceneDraw& draw : scene.draws) {
    for (std::uint32_t t = 0, count = (seams ? 8 : 2) + random.below(seams ? 40 : 12); t < count; ++t) {
      // Most cover whole tiles; some begin within the image.
      double x = random.between(-300, 200), y = random.between(-300, 200), size = random.between(30, 1500);
      if (seams) {
        size = random.between(14, 60);
        x = random.between(-20, scene.width), y = 64 * random.between(1, 3) - size * random.unit();
      }
      // Some have an upright side within the first blocks of a tile.
      const bool upright = !seams && random.one_in(4);
      if (upright) x = 64 * random.between(-2, 3) + random.between(1, 8);
      const int askew = upright ? 0 : 40;
      const double corners[3][2] = {
          {x, y}, {x + size, y + random.between(-askew, askew)}, {x + random.between(-askew, askew), y + size}};
      const double turn_x = dx + tilt * small(3), turn_y = dy + tilt * small(3);
      Vertex v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = random.one_in(16) ? 2 : 1;
        const double depth = z + turn_x * (corners[k][0] - 64) + turn_y * (corners[k][1] - 64);
        v[k] = {static_cast<float>(corners[k][0] * w), static_cast<float>(corners[k][1] * w),
                static_cast<float>(depth * w), static_cast<float>(w)};
      }
      append(draw, v);
      z += step;
    }
  }
  add_state(scene, random);
  if (!random.one_in(4)) scene.initial_depth.clear();
  for (corpus::SceneDraw& draw : scene.draws)
    if (!random.one_in(4)) draw.cull = Cull::none, draw.depth_write = true, draw.scissor.reset();
  if (beyond) {  // what is clamped, before or behind what is not
    for (corpus::SceneDraw& draw : scene.draws)
      draw.depth_mode = &draw == &scene.draws[0] ? DepthMode::none : DepthMode::clamp;
  }
  made.outputs = random_outputs(scene, random);
  if (!random.one_in(8)) made.outputs.count = false;  // nothing is hidden where fragments count
  if (!made.outputs.index && !made.outputs.barycentrics) made.outputs.depth = true;
  made.threads = seams ? random.between(1, 3) : random_threads(random), made.executor = random.one_in(4);
  return made;
}

// Planes over whole tiles whose least depth, next to nothing, lies at a tile's corner sample, before a level background
// as near to 0: far from the planes' other values, no rounding may be lost.
PathScene cusps_case(std::uint64_t number) {
  Random random(number);
  corpus::Scene scene;
  scene.width = random.between(64, 260), scene.height = random.between(64, 200);
  scene.depth_test = random.one_in(3) ? DepthTest::greater : DepthTest::less;
  const float nearer = scene.depth_test == DepthTest::greater ? -1.0f : 1.0f;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  const auto tiny = [&] { return std::ldexp(static_cast<float>(random.between(-3, 3)), -random.between(30, 70)); };
  append_background(draw, nearer * tiny());
  for (std::uint32_t t = 0, count = 1 + random.below(6); t < count; ++t) {
    const int grain = random.one_in(2) ? 64 : 8;
    const auto corner = [&](int size, float& direction) {
      const bool first = random.one_in(2);
      direction = first ? 1 : -1;
      return static_cast<float>(grain * random.between(0, size / grain - 1) + (first ? 0 : grain - 1)) + 0.5f;
    };
    float way_x, way_y;
    const float out = static_cast<float>(random.below(4)) / 1024;  // the corner lies so far outwards
    const float x = corner(scene.width, way_x) - way_x * out, y = corner(scene.height, way_y) - way_y * out;
    const auto slope = [&] { return random.one_in(4) ? 0 : std::ldexp(1.0f, -random.between(0, 14)); };
    const float slope_x = slope(), slope_y = slope();
    const auto reach = [&] { return static_cast<float>(random.one_in(2) ? 2048 : random.between(8, 300)); };
    const float reach_x = reach(), reach_y = reach();
    const float z = out == 0 ? tiny() : -out * (slope_x + slope_y);
    append(draw, {{x, y, nearer * z, 1},
                  {x + way_x * reach_x, y, nearer * (z + slope_x * reach_x), 1},
                  {x, y + way_y * reach_y, nearer * (z + slope_y * reach_y), 1}});
  }
  return hiding(scene, random);
}

// Triangles with next to no area, along rows of samples: two corners on a line through samples, the third far away in
// the line's direction. No double tells the sign of D, or how deep they are; of any depth, before and behind others.
PathScene flat_case(std::uint64_t number) {
  Random random(number);
  corpus::Scene scene;
  scene.width = random.between(8, 260), scene.height = random.between(8, 200);
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.fill_rule = static_cast<FillRule>(random.below(8));
  const bool wide = random.one_in(3);
  const auto any_depth = [&] {
    const auto z = static_cast<float>(2 * random.unit() - 1);
    return wide ? std::ldexp(z, random.between(60, 120)) : z;
  };
  for (std::uint32_t t = 0, count = 2 + random.below(12); t < count; ++t) {
    if (t == 0 || random.one_in(4)) append_background(draw, any_depth());
    const float x = static_cast<float>(random.below(static_cast<std::uint32_t>(scene.width))) + 0.5f,
                y = static_cast<float>(random.below(static_cast<std::uint32_t>(scene.height))) + 0.5f;
    const auto dx = static_cast<float>(random.between(-3, 3)), dy = static_cast<float>(random.between(-3, 3));
    const int most = random.one_in(2) ? 8 : 300;
    const float back = -static_cast<float>(random.between(0, most)),
                ahead = static_cast<float>(random.between(1, most));
    const float far = static_cast<float>(2 * random.unit() - 1) *
                      std::ldexp(1.0f, random.one_in(2) ? -random.between(10, 70) : -random.between(46, 58));
    Vertex v[3] = {{x + back * dx, y + back * dy, any_depth(), 1},
                   {x + ahead * dx, y + ahead * dy, any_depth(), 1},
                   {dx, dy, any_depth() * far, far}};
    std::swap(v[0], v[random.below(3)]);
    append(draw, v);
  }
  if (random.one_in(2)) draw.depth_mode = static_cast<DepthMode>(random.below(3));
  if (random.one_in(3)) scene.depth_test = DepthTest::greater;
  return hiding(scene, random);
}

// A coarse grid moves steep triangles so far that their planes go beyond the depths of their corners, between which
// others lie.
PathScene steep_case(std::uint64_t number) {
  Random random(number);
  corpus::Scene scene;
  scene.width = random.between(8, 200), scene.height = random.between(8, 200);
  if (random.one_in(2)) scene.depth_test = DepthTest::greater;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.grid = Grid{random.between(0, 3), random.between(0, 15), random.between(0, 15),
                   static_cast<GridRounding>(random.below(3))};
  const bool walls = !random.one_in(3);  // up to the first column of a block, before a level background
  const float nearer = scene.depth_test == DepthTest::greater ? -1.0f : 1.0f;
  const auto any_slope = [&] { return nearer * static_cast<float>(random.between(walls ? 1 : -4, 4)) / 64; };
  const float slope_x = any_slope(), slope_y = walls ? 0 : any_slope();
  const float base = random.one_in(3) ? 0 : -nearer * 16;
  const int wall = 64 * random.between(0, scene.width / 8 - 1);
  if (walls) append_background(draw, (static_cast<float>(wall + 4 - random.between(0, 4)) / 8) * slope_x + base);
  for (std::uint32_t t = 0, count = 2 + random.below(20); t < count; ++t) {
    const int reach = random.one_in(3) ? 400 : random.one_in(2) ? 60 : 12;
    const int x = walls ? wall + 4 - reach : random.between(-8, 8 * scene.width),
              y = random.between(-8, 8 * scene.height);
    const float above = walls ? 0 : static_cast<float>(random.between(-8, 8)) / 256;
    Vertex v[3];
    for (Vertex& vertex : v) {
      const int to_wall = reach - random.between(0, 4),
                way = walls && random.one_in(2) ? to_wall : random.between(-reach, reach);
      const float at_x = static_cast<float>(x + way) / 8,
                  at_y = static_cast<float>(y + random.between(-reach, reach)) / 8;
      vertex = {at_x, at_y, at_x * slope_x + at_y * slope_y + base + above, 1};
    }
    append(draw, v);
  }
  if (random.one_in(4)) draw.depth_mode = static_cast<DepthMode>(random.below(3));
  PathScene made = hiding(scene, random);
  made.outputs.count = random.one_in(4);
  return made;
}

}  // namespace surefill::properties
