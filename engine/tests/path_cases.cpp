// SPDX-License-Identifier: Apache-2.0
#include "engine/tests/path_cases.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "engine/tests/path_cases_parts.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {

corpus::Outputs random_outputs(const corpus::Scene& scene, Random& random) {
  corpus::Outputs outputs = outputs_of(scene);
  if (!outputs.depth || random.one_in(4)) return outputs;  // conservative frames have counts alone
  do {
    outputs = {random.one_in(3), random.one_in(2), random.one_in(2), random.one_in(3), random.one_in(3)};
  } while (!outputs.count && !outputs.index && !outputs.depth && !outputs.barycentrics);
  return outputs;
}

int random_threads(Random& random) {
  return random.one_in(4) ? random.between(2, 3) : 1;
}

namespace {

// Identifiers that several triangles have: the positions decide (V2, M5).
void share_identifiers(corpus::Scene& scene, Random& random) {
  for (corpus::SceneDraw& draw : scene.draws)
    for (corpus::SceneTriangle& triangle : draw.triangles) triangle.identifier = random.below(2);
}

PathScene random_case(std::uint64_t number, int size, int triangles) {
  Random random(number);
  const auto all = categories();
  SceneLimits limits;
  limits.max_size = size, limits.max_triangles = triangles;
  limits.samples = random.one_in(3), limits.grid = random.one_in(4), limits.conservative = random.one_in(8);
  PathScene made{random_scene(all[number % all.size()], number, limits), {}, random_threads(random)};
  made.outputs = random_outputs(made.scene, random);
  made.in_place = random.one_in(2), made.executor = random.one_in(4), made.streams = random.one_in(3);
  if (random.one_in(8)) share_identifiers(made.scene, random);
  made.alone = made.threads > 1 && random.one_in(4);
  if (random.one_in(64)) made.outputs = {false, false, false, false, false};  // statistics alone
  corpus::SceneDraw& draw = made.scene.draws[random.below(static_cast<std::uint32_t>(made.scene.draws.size()))];
  if (!made.scene.attributes.empty() && !draw.vertices.empty() && random.one_in(12)) {  // of any vertex (B1)
    auto& values = draw.vertices[random.below(static_cast<std::uint32_t>(draw.vertices.size()))].attributes;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNone[] = {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
    values[random.below(static_cast<std::uint32_t>(values.size()))] = kNone[random.below(3)];
  }
  return made;
}

PathScene small_case(std::uint64_t number) {
  return random_case(number, 16, 4);
}
PathScene tiles_case(std::uint64_t number) {
  return random_case(number, 150, 8);
}
PathScene bands_case(std::uint64_t number) {
  return random_case(number, 400, 12);
}

// A box around the vertices of a draw (M6), if they all lie in front of the eye.
void add_culling_box(corpus::SceneDraw& draw, Random& random) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  for (const corpus::SceneVertex& v : draw.vertices) {
    if (!(v.w > 0)) return;
    const float at[3] = {v.x / v.w, v.y / v.w, v.z / v.w};
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], std::nextafter(at[i], -kInfinity));
      high[i] = std::max(high[i], std::nextafter(at[i], kInfinity));
    }
  }
  std::array<Vertex, 8>& box = draw.culling_box.emplace();
  for (std::size_t k = 0; k < 8; ++k) {
    const float w = std::ldexp(1.0f, random.between(-2, 4));
    box[k] = {((k & 1) != 0 ? high[0] : low[0]) * w, ((k & 2) != 0 ? high[1] : low[1]) * w,
              ((k & 4) != 0 ? high[2] : low[2]) * w, w};
  }
}

}  // namespace

void add_state(corpus::Scene& scene, Random& random) {
  if (random.one_in(3)) scene.depth_test = DepthTest::greater;
  if (random.one_in(4)) scene.samples = 1 << random.between(1, 2);
  if (random.one_in(3)) scene.initial_depth = {static_cast<float>(random.between(0, 8)) / 8};
  const bool identifiers = random.one_in(3);
  std::uint32_t identifier = 0;
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.fill_rule = static_cast<FillRule>(random.below(8));
    draw.cull = static_cast<Cull>(random.below(3));
    draw.depth_mode = static_cast<DepthMode>(random.below(3));
    draw.depth_write = !random.one_in(4);
    if (random.one_in(3)) add_culling_box(draw, random);
    if (random.one_in(3)) {
      // On cells or within them, each side for itself.
      const auto side = [&](int first, int last) {
        const int at = random.between(first, last);
        return random.one_in(3) ? at : at & ~3;
      };
      const int x = side(-8, scene.width - 4), y = side(-8, scene.height - 4);
      draw.scissor = {x, y, side(x + 4, scene.width), side(y + 4, scene.height)};
    }
    if (identifiers) {
      for (std::size_t i = 0; i < draw.triangles.size(); ++i) {
        draw.triangles[i].identifier = identifier++;
        std::swap(draw.triangles[i].identifier,
                  draw.triangles[random.below(static_cast<std::uint32_t>(i + 1))].identifier);
      }
    }
  }
}

void append(corpus::SceneDraw& draw, const Vertex (&vertices)[3]) {
  const auto first = static_cast<std::uint32_t>(draw.vertices.size());
  for (const Vertex& v : vertices) draw.vertices.push_back({v.x, v.y, v.z, v.w, {}});
  draw.triangles.push_back({{first, first + 1, first + 2}, {}});
}

namespace {

// More small triangles than are set up at a time, on few depths, so that many tie.
PathScene crowd_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(40, 200), scene.height = random.between(40, 200);
  if (random.one_in(32)) scene.width = 13 * 64, scene.height = 5 * 64;  // one tile more than a cache line has bytes
  scene.draws.resize(1 + random.below(2));
  const int reach = 16 * random.between(1, 40), depths = random.one_in(2) ? 3 : 4096;
  const bool flat = random.one_in(2);
  for (corpus::SceneDraw& draw : scene.draws) {
    for (std::uint32_t t = 0, count = 100 + random.below(300); t < count; ++t) {
      const int x = random.between(-32, 16 * scene.width), y = random.between(-32, 16 * scene.height);
      const auto any_depth = [&] {
        return static_cast<float>(random.between(-depths / 3, depths + depths / 3)) / static_cast<float>(depths);
      };
      const float z = any_depth();
      Vertex v[3];
      for (Vertex& vertex : v) {
        const float w = random.one_in(8) ? static_cast<float>(1 + random.below(8)) / 4 : 1;
        const float depth = flat ? z : any_depth();
        vertex = {static_cast<float>(x + random.between(-reach, reach)) / 16 * w,
                  static_cast<float>(y + random.between(-reach, reach)) / 16 * w, depth * w, w};
      }
      append(draw, v);
    }
  }
  add_state(scene, random);
  made.outputs = random_outputs(scene, random);
  made.threads = random_threads(random), made.executor = random.one_in(4), made.streams = random.one_in(4);
  return made;
}

// Fine meshes, several over each other, with larger triangles among theirs: most have at most 2 x 2 samples, many edges
// run through samples or beside them by next to nothing, many depths tie, or round to 0 from below. Some frames have
// counts alone, which may be a coarse grid's, or of squares inside.
PathScene fine_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  const auto any_size = [&] { return random.one_in(4) ? 64 * random.between(1, 2) : random.between(4, 140); };
  scene.width = any_size(), scene.height = any_size();
  scene.draws.resize(1 + random.below(2));
  for (corpus::SceneDraw& draw : scene.draws) {
    for (std::uint32_t layer = 0, layers = 1 + random.below(3); layer < layers; ++layer) {
      const int step = random.between(4, 32), jitter = random.one_in(3) ? 0 : random.between(1, step);
      const int left = random.between(-16, 16 * scene.width), top = random.between(-16, 16 * scene.height);
      const std::uint32_t columns = 2 + random.below(10), rows = 2 + random.below(10);
      const bool flat = random.one_in(2), next_to_0 = random.one_in(8);
      const std::uint32_t fractions = random.below(3);
      const auto first = static_cast<std::uint32_t>(draw.vertices.size());
      for (std::uint32_t n = 0; n < columns * rows; ++n) {
        const auto place = [&](int from, std::uint32_t i) {
          const float at = static_cast<float>(from + static_cast<int>(i) * step + random.between(-jitter, jitter)) / 16;
          if (fractions == 1) return at + static_cast<float>(random.unit()) / 64;
          if (fractions == 2)
            return at + std::ldexp(static_cast<float>(random.between(-1, 1)), -random.between(17, 22));
          return at;
        };
        const float w = next_to_0          ? static_cast<float>(random.between(1, 6))
                        : random.one_in(4) ? static_cast<float>(random.between(1, 7)) / 4
                                           : 1.0f;
        const float z = flat ? 0.5f : static_cast<float>(random.between(-1, 9)) / (random.one_in(2) ? 8.0f : 7.0f);
        const float zw = next_to_0 ? std::ldexp(static_cast<float>(random.between(-2, 1)), -149) : z * w;
        draw.vertices.push_back({place(left, n % columns) * w, place(top, n / columns) * w, zw, w, {}});
      }
      for (std::uint32_t n = 0; n + columns + 1 < columns * rows; ++n) {
        const std::uint32_t a = first + n, b = a + 1, c = a + columns, d = c + 1;
        if (n % columns == columns - 1) continue;
        draw.triangles.push_back({{a, b, c}, {}});
        draw.triangles.push_back({{b, d, c}, {}});
        if (random.one_in(12)) {
          const auto any = [&] { return first + random.below(columns * rows); };
          draw.triangles.push_back({{any(), any(), any()}, {}});
        }
      }
    }
  }
  if (random.one_in(2)) add_state(scene, random);
  made.outputs = random_outputs(scene, random);
  made.threads = random_threads(random), made.executor = random.one_in(4), made.streams = random.one_in(4);
  if (!random.one_in(4)) return made;
  made.outputs = {true, false, false, false, false};
  const bool inside = scene.samples == 1 && random.one_in(3), grid = random.one_in(2);
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.depth_mode = DepthMode::none, draw.depth_write = true;
    if (inside) draw.conservative = Conservative::inner;
    if (!inside && grid) draw.grid = Grid{random.between(2, 6), 0, 0, static_cast<GridRounding>(random.below(3))};
  }
  return made;
}

// Grid, on slivers that reach behind the eye or beyond the guard band: polygons of several corners, which a coarse grid
// folds; and on triangles that reach beyond it on all sides, of which six corners or seven are left. On targets of
// whole tiles, so that their last tiles have no neighbours.
PathScene clipped_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = 64 * random.between(1, 3), scene.height = 64 * random.between(1, 3);
  scene.draws.resize(1);
  corpus::SceneDraw& draw = scene.draws[0];
  const auto on_screen = [&](int size) { return static_cast<float>(random.between(0, 4 * size)) / 4; };
  for (std::uint32_t t = 0, count = 1 + random.below(5); t < count; ++t) {
    const float x = on_screen(scene.width), y = on_screen(scene.height);
    const float near_x = x + static_cast<float>(random.between(-8, 8)) / 4,
                near_y = y + static_cast<float>(random.between(-8, 8)) / 4;
    // Far away, or behind the eye, where the direction is the opposite one.
    const float far_x = static_cast<float>(random.between(-60, 60)) * 1024,
                far_y = static_cast<float>(random.between(-60, 60)) * 1024;
    if (random.one_in(3)) {
      Vertex v[3];
      for (Vertex& vertex : v)
        vertex = {static_cast<float>(random.between(-90, 90)) * 1024,
                  static_cast<float>(random.between(-90, 90)) * 1024, static_cast<float>(random.between(0, 8)) / 8, 1};
      append(draw, v);
      continue;
    }
    const float w = random.one_in(2) ? 1.0f : -static_cast<float>(random.below(3)) / 64;
    const Vertex v[3] = {
        {x, y, 0.25f, 1}, {near_x, near_y, 0.5f, 1}, {far_x, far_y, static_cast<float>(random.below(2)) / 2, w}};
    append(draw, v);
  }
  add_state(scene, random);
  draw.scissor.reset();
  if (random.one_in(2)) draw.culling_box.reset();
  draw.grid = Grid{random.between(0, 3), 0, 0, static_cast<GridRounding>(random.below(3))};
  made.outputs = random_outputs(scene, random);
  made.threads = random_threads(random), made.streams = random.one_in(4);
  return made;
}

// Fine grids and long edges, which no int32 holds exactly: edges run through samples, or a grid step beside them.
PathScene snapped_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(8, 200), scene.height = random.between(8, 200);
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.grid = Grid{random.between(8, 12), 0, 0, static_cast<GridRounding>(random.below(3))};
  const float step = std::ldexp(1.0f, -draw.grid->bits);
  for (std::uint32_t t = 0, count = 1 + random.below(12); t < count; ++t) {
    const auto sample = [&](int size) { return static_cast<float>(random.between(0, size - 1)) + 0.5f; };
    const auto beside = [&] { return static_cast<float>(random.between(-1, 1)) * (random.one_in(2) ? step : 0); };
    const float x = sample(scene.width), y = sample(scene.height);
    const int most = random.one_in(3) ? 7000 : 300, slope = random.one_in(2) ? 1 : 2;
    const float dx = static_cast<float>(random.between(-slope, slope)), dy = static_cast<float>(random.between(-1, 1));
    const float back = static_cast<float>(random.between(0, most)), ahead = static_cast<float>(random.between(1, most));
    Vertex v[3] = {
        {x - back * dx + beside(), y - back * dy + beside(), 0.25f, 1},
        {x + ahead * dx + beside(), y + ahead * dy + beside(), 0.5f, 1},
        {sample(2 * scene.width), sample(2 * scene.height), static_cast<float>(random.between(0, 8)) / 8, 1}};
    if (random.one_in(2)) std::swap(v[0], v[1]);
    append(draw, v);
  }
  add_state(scene, random);
  made.outputs = random_outputs(scene, random);
  made.threads = random_threads(random), made.streams = random.one_in(4);
  return made;
}

// Triangles with two corners on one axis of the image and the third next to nothing from the other: coefficients of
// edges lack what no double has beside the rest, and whole numbers are left. Samples lie as near as that to edges.
PathScene axes_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(1, 90), scene.height = random.between(1, 90);
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (std::uint32_t t = 0, count = 1 + random.below(4); t < count; ++t) {
    const auto along = static_cast<float>(random.between(1, random.one_in(2) ? 8 : 90));
    const float corners[3][2] = {{0, along},
                                 {0, static_cast<float>(random.between(-90, 0))},
                                 {random.one_in(2) ? along : 2 * along,
                                  std::ldexp(static_cast<float>(random.between(-1, 1)), -random.between(40, 120))}};
    const bool turned = random.one_in(2);
    const float w = std::ldexp(1.0f, random.between(-2, 2));
    Vertex v[3];
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = {corners[k][turned ? 1 : 0] * w, corners[k][turned ? 0 : 1] * w, w / 2, w};
    if (random.one_in(2)) std::swap(v[0], v[1]);
    append(draw, v);
  }
  add_state(scene, random);
  made.outputs = random_outputs(scene, random);
  return made;
}

// Right triangles with legs of a power of two, where the weights of a sample have few bits: depth and an attribute at
// one sample are halfway between two float32, but for a bit that no double has beside the others; or exactly.
PathScene halfway_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  const int log2_leg = random.between(1, 8), leg = 1 << log2_leg;
  scene.width = random.between(1, leg + 8), scene.height = random.between(1, leg + 8);
  if (random.one_in(2))
    scene.attributes.push_back({"u", 1 + random.below(4), static_cast<Interpolation>(random.below(2))});
  const std::uint32_t components = scene.attributes.empty() ? 0 : scene.attributes[0].components;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (std::uint32_t t = 0, count = 1 + random.below(leg <= 2 ? 12 : 4); t < count; ++t) {
    const int x = random.between(-leg / 2, scene.width - 1), y = random.between(-leg / 2, scene.height - 1);
    // The sample (x + k1/2, y + k2/2) and its weights times 2 leg.
    const auto odd_below = [&](int n) { return 2 * random.between(0, (n - 1) / 2) + 1; };
    const int k1 = odd_below(2 * leg - 1), k2 = odd_below(2 * leg - k1), k0 = 2 * leg - k1 - k2;
    const auto hard_values = [&](float(&values)[3]) {
      // k0 a + k1 b with 24 + s + 1 bits, the last s + 1 of which are 10...0.
      std::int64_t a = 0, b = 0;
      for (int tries = 0; tries < 4000; ++tries) {
        a = (1 << 23) + random.below(1u << 23), b = (1 << 23) + random.below(1u << 23);
        const auto n = static_cast<std::uint64_t>(k0 * a + k1 * b);
        const int s = static_cast<int>(std::bit_width(n)) - 25;
        if (s >= 0 && (n & ((std::uint64_t{2} << s) - 1)) == std::uint64_t{1} << s) break;
      }
      const int exponent = -random.between(23, 26);
      values[0] = std::ldexp(static_cast<float>(a), exponent), values[1] = std::ldexp(static_cast<float>(b), exponent);
      const float least = std::ldexp(static_cast<float>(random.between(-1, 1)), -random.between(55, 149));
      values[2] = least;
      const std::uint32_t turn = random.below(8);
      if (turn == 0) values[0] = -values[0], values[1] = -values[1];
    };
    float z[3];
    hard_values(z);
    const bool level = random.one_in(4);  // along y; of few bits, so that an odd scale keeps them
    if (level) {
      const int few = random.between(1 << 14, (1 << 15) - 1),
                bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>((k0 + k2) * few)));
      z[0] = z[2] = std::ldexp(static_cast<float>(2 * leg * few), 24 - bits);
      z[1] = static_cast<float>(leg * odd_below(15));
    }
    const float corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    // Or an odd scale, where attributes alone are halfway, and all far from 1: bounds are relative to their terms.
    const bool wide = level || random.one_in(3);
    const float scale = wide               ? std::ldexp(static_cast<float>(odd_below(15)), random.between(-30, 30))
                        : random.one_in(2) ? 1
                                           : std::ldexp(1.0f, random.between(-3, 3));
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    for (std::size_t k = 0; k < 3; ++k) {
      draw.vertices.push_back({(static_cast<float>(x) + corners[k][0] * static_cast<float>(leg)) * scale,
                               (static_cast<float>(y) + corners[k][1] * static_cast<float>(leg)) * scale,
                               z[k] * scale,
                               scale,
                               {}});
    }
    for (std::uint32_t c = 0; c < components; ++c) {
      float u[3];
      hard_values(u);
      const int exponent = wide ? random.between(-90, 90) : 0;
      for (float& value : u) value = std::ldexp(value, exponent);
      for (std::size_t k = 0; k < 3; ++k) draw.vertices[first + k].attributes.push_back(u[k]);
    }
    draw.triangles.push_back({{first, first + 1, first + 2}, {}});
  }
  if (random.one_in(3)) scene.depth_test = DepthTest::greater;
  if (random.one_in(4)) draw.depth_mode = static_cast<DepthMode>(random.below(3));
  made.outputs = random_outputs(scene, random);
  return made;
}

// Attributes, several triangles to a row of pixels; each draw may interpolate in its own way, and not all are asked
// for.
PathScene shaded_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  made.scene = attribute_scene(random);
  if (random.one_in(4)) share_identifiers(made.scene, random);
  made.outputs = random_outputs(made.scene, random), made.outputs.attributes = true;
  made.interpolations = random.one_in(2), made.wanted = random.one_in(2) ? random.below(16) : ~0u;
  made.threads = random_threads(random);
  return made;
}

// Edges so far away, and so steep, that their integers are the largest there are.
PathScene vast_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(1, 140), scene.height = random.between(1, 140);
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (std::uint32_t t = 0, count = 1 + random.below(12); t < count; ++t) {
    // Its longest side runs along a diagonal, far beyond the image, or through it.
    const double size = std::ldexp(1.75 + random.unit() / 4, random.between(9, 24)),
                 away = random.one_in(4) ? 0 : size / 4;
    const double turn_x = random.one_in(2) ? 1 : -1, turn_y = random.one_in(2) ? 1 : -1;
    const auto near = [&] { return (2 * random.unit() - 1) * size / 64; };
    const double corners[3][2] = {
        {-size - away + near(), size - away}, {size - away, -size - away + near()}, {size, size}};
    Vertex v[3];
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = {static_cast<float>(turn_x * corners[k][0]), static_cast<float>(turn_y * corners[k][1]), 0.5f, 1};
    if (random.one_in(2)) std::swap(v[0], v[1]);
    append(draw, v);
  }
  made.outputs = random_outputs(scene, random);
  if (random.one_in(2)) made.outputs = {true, false, false, false, false};
  return made;
}

// Corners at samples, or an ulp beside, with a W far larger than the others': there the denominator of an attribute is
// the sum of a small number and of two that are 0 but for the rounding of large terms, and where the corner's value
// alone is not 0 the numerator has a small error.
PathScene pinned_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  scene.width = random.between(1, 24), scene.height = random.between(1, 24);
  scene.attributes.push_back({"u", 1 + random.below(4), static_cast<Interpolation>(random.below(2))});
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.fill_rule = static_cast<FillRule>(random.below(8));
  for (std::uint32_t t = 0, count = 1 + random.below(8); t < count; ++t) {  // each before the last one
    const float at[2] = {static_cast<float>(random.between(0, scene.width - 1)) + 0.5f,
                         static_cast<float>(random.between(0, scene.height - 1)) + 0.5f};
    const int size = random.between(-30, 30), apart = random.one_in(2) ? 2 : 12;
    const std::size_t pinned = random.below(3);
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    for (std::size_t k = 0; k < 3; ++k) {
      const bool here = k == pinned;
      const float w =
          here ? std::ldexp(1.0f, size + (random.one_in(2) ? random.between(10, 50) : random.between(48, 80)))
               : std::ldexp(1 + static_cast<float>(random.unit()), size + random.between(-apart, apart));
      const auto place = [&](std::size_t axis) {
        if (here) return at[axis] * w * (random.one_in(8) ? 1 + 0x1p-23f : 1.0f);
        const int towards_0 = random.one_in(3) ? 0 : -random.between(8, 50);
        return std::ldexp(static_cast<float>(2 * random.unit() - 0.5) * 60 * w, towards_0);
      };
      const float x = place(0), y = place(1);
      draw.vertices.push_back({x, y, w / static_cast<float>(2 + t), w, {}});
    }
    for (std::uint32_t c = 0; c < scene.attributes[0].components; ++c) {
      const int exponent = random.one_in(2) ? -149 : random.between(-149, 100);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = static_cast<float>(random.one_in(2) ? 1 : random.between(-3, 3));
        draw.vertices[first + k].attributes.push_back(k == pinned ? std::ldexp(value, exponent) : 0);
      }
    }
    draw.triangles.push_back({{first, first + 1, first + 2}, {}});
  }
  made.outputs = random_outputs(scene, random), made.outputs.attributes = true;
  return made;
}

// Draws whose culling boxes are made of their own vertices, wherever these lie: beside the borders of the image or of a
// scissor, partly behind the eye, where depth is clipped, moved by a coarse grid; or in part behind what other draws
// have covered, by next to nothing. And boxes that are to be ignored, for a number that is none.
PathScene boxed_case(std::uint64_t number) {
  Random random(number);
  PathScene made;
  corpus::Scene& scene = made.scene;
  const int most = random.one_in(3) ? 200 : 24;
  scene.width = random.between(4, most), scene.height = random.between(4, most);
  const bool hides = random.one_in(2), coarse = random.one_in(4);
  const bool conservative = !hides && !coarse && random.one_in(4);
  if (!conservative && random.one_in(3)) scene.samples = 1 << random.between(1, 4);
  const bool clamped = hides && random.one_in(8);  // below 0, in front of what is not
  if (clamped || random.one_in(3)) scene.depth_test = DepthTest::greater;
  const float base = clamped ? -0.5f : static_cast<float>(random.between(-1, 3)) / 2;
  scene.draws.resize(2 + random.below(5));
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.fill_rule = static_cast<FillRule>(random.below(8));
    if (coarse)
      draw.grid = Grid{random.between(0, 1), random.between(0, 15), random.between(0, 15),
                       static_cast<GridRounding>(random.below(3))};
    if (conservative) draw.conservative = random.one_in(2) ? Conservative::over : Conservative::inner;
    if (!conservative) draw.depth_mode = static_cast<DepthMode>(random.below(3));
    if (clamped) draw.depth_mode = &draw == &scene.draws[0] ? DepthMode::none : DepthMode::clamp;
    Scissor region{0, 0, scene.width, scene.height};
    if (random.one_in(3)) {
      region.x0 = random.between(0, scene.width - 1), region.y0 = random.between(0, scene.height - 1);
      region.x1 = random.between(region.x0 + 1, scene.width), region.y1 = random.between(region.y0 + 1, scene.height);
      draw.scissor = region;
    }
    const auto beside = [&](int border) {
      return static_cast<float>(border) + (random.one_in(2) ? 0 : static_cast<float>(random.between(-24, 24)) / 16);
    };
    // The first and the last coordinate of a rectangle: across the image, or within a little of a border.
    const auto sides = [&](int begin, int end, float(&to)[2]) {
      to[0] = static_cast<float>(random.between(-8, end)), to[1] = to[0] + static_cast<float>(random.between(1, end));
      if (hides && random.one_in(2)) to[0] = static_cast<float>(static_cast<int>(to[0]) & ~7), to[1] = beside(end);
      if (!hides && random.one_in(2)) to[1] = beside(begin), to[0] = to[1] - 3;
      if (!hides && random.one_in(2)) to[0] = beside(end), to[1] = to[0] + 3;
    };
    float x[2], y[2];
    sides(region.x0, region.x1, x), sides(region.y0, region.y1, y);
    if (hides && &draw == &scene.draws[0]) x[0] = y[0] = -8, x[1] = y[1] = 208;  // all that others may lie behind
    // Depths at the ends of 0 .. 1, or near to each other.
    const float tiny = std::ldexp(static_cast<float>(random.between(-1, 1)), random.one_in(2) ? -24 : -140);
    const float z = hides ? base + std::ldexp(static_cast<float>(random.between(-2, 2)), random.one_in(4) ? 0 : -23)
                          : static_cast<float>(random.below(2)) + tiny;
    const bool behind = random.one_in(6), turned = behind || random.one_in(4);
    for (std::size_t k = 0; k < 4; ++k) {
      const float w = behind && random.one_in(2) ? static_cast<float>(random.between(-1, 0))
                                                 : std::ldexp(1.0f, random.between(-1, 1));
      const float depth = turned && k == 3 ? z + std::ldexp(1.0f, random.between(-24, -2)) : z, by = w == 0 ? 1 : w;
      draw.vertices.push_back({x[k & 1] * by, y[k >> 1] * by, depth * by, w, {}});
    }
    draw.triangles = {{{0, 1, 2}, {}}, {{2, 1, 3}, {}}};
    if (random.one_in(4)) draw.triangles.pop_back(), draw.vertices.pop_back();
    if (random.one_in(4)) continue;
    std::array<Vertex, 8>& box = draw.culling_box.emplace();
    for (std::size_t k = 0; k < 8; ++k) {
      const corpus::SceneVertex& v = draw.vertices[k % draw.vertices.size()];
      box[k] = {v.x, v.y, v.z, v.w};
    }
    if (!random.one_in(6)) continue;
    // Somewhere else, and not a box.
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (random.one_in(2)) {
      box.fill({1, 1, 1, kInfinity});
      continue;
    }
    box.fill({-100, -100, 4, 1});
    constexpr float kNone[] = {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
    Vertex& v = box[random.below(8)];
    float* const numbers[] = {&v.x, &v.y, &v.z, &v.w};
    *numbers[random.below(4)] = kNone[random.below(3)];
  }
  made.outputs = random_outputs(scene, random);
  if (hides) made.outputs.count = false, made.outputs.depth = true;
  made.threads = random_threads(random);
  return made;
}

constexpr PathCases kCases[] = {
    {"small", "random scenes of a few cells", 6000, small_case},
    {"tiles", "random scenes of a few tiles", 400, tiles_case},
    {"bands", "random scenes of several bands for each thread", 60, bands_case},
    {"crowd", "more triangles than are set up at a time", 150, crowd_case},
    {"fine", "fine meshes of triangles with at most 2 x 2 samples, and larger ones among them", 600, fine_case},
    {"halfway", "values halfway between two float32, but for what a double cannot hold", 3000, halfway_case},
    {"shaded", "attributes of every kind, several triangles to a row of pixels", 300, shaded_case},
    {"vast", "edges so far away that their integers are the largest", 300, vast_case},
    {"pinned", "attributes at corners whose W is far larger than the others'", 1000, pinned_case},
    {"boxed", "draws in culling boxes, beside borders, behind the eye or behind other draws", 1000, boxed_case},
    {"clipped", "slivers that Grid clips and folds", 300, clipped_case},
    {"snapped", "edges on samples of a fine grid, and a step beside them", 1000, snapped_case},
    {"axes", "corners on the axes of the image, or next to nothing beside them", 1000, axes_case},
    {"cusps", "planes whose least depth, next to 0, is at a tile's corner sample", 150, cusps_case},
    {"flat", "triangles with next to no area along rows of samples", 300, flat_case},
    {"steep", "steep triangles that a coarse grid moves", 200, steep_case},
    {"layers", "planes over whole tiles, as near to each other as hierarchical z can tell", 150, layers_case},
};

}  // namespace

std::span<const PathCases> all_path_cases() {
  return kCases;
}

}  // namespace surefill::properties
