// SPDX-License-Identifier: Apache-2.0
#include "fuzz/mutate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <tuple>
#include <utility>

#include "properties/generators/near_zero.hpp"

// libFuzzer's own mutator; AFL++ has none.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace surefill::fuzz {
namespace {

using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneTriangle;
using corpus::SceneVertex;
using properties::Random;

// Beyond float32 is an infinity, which is a case of its own (B1).
float rounded(double value) {
  constexpr double kBeyond = 0x1p128;
  return static_cast<float>(std::clamp(value, -kBeyond, kBeyond));
}

SceneDraw& any_draw(Scene& scene, Random& random) {
  return scene.draws[random.below(static_cast<std::uint32_t>(scene.draws.size()))];
}

SceneVertex& any_vertex(SceneDraw& draw, Random& random) {
  return draw.vertices[random.below(static_cast<std::uint32_t>(draw.vertices.size()))];
}

// X, Y or W; Z one time in eight.
float& any_coordinate(SceneVertex& v, Random& random) {
  if (random.one_in(8)) return v.z;
  float* const coordinates[] = {&v.x, &v.y, &v.w};
  return *coordinates[random.below(3)];
}

struct Point {
  double x, y;
};

Point any_sample(const Scene& scene, Random& random) {
  const SampleLocation location = sample_location(scene.samples, random.between(0, scene.samples - 1));
  return {random.between(0, scene.width - 1) + location.x / 16.0,
          random.between(0, scene.height - 1) + location.y / 16.0};
}

double any_power_of_two(Random& random, int range) {
  return std::ldexp(1.0, random.between(-range, range));
}

// Small numbers whose products with sample coordinates are exact in float32.
double any_small_factor(Random& random) {
  constexpr double kFactors[] = {1, 2, 3, 4, 0.5, 0.25, 0.75, 1.5};
  return kFactors[random.below(8)] * (random.one_in(4) ? -1 : 1);
}

// Several mutations work on a triangle's own vertices. Vertices 0, 1, 2 where the draw has no triangle.
struct Corners {
  std::size_t i, j, k;
};

Corners any_corners(const SceneDraw& draw, Random& random) {
  const auto count = draw.vertices.size();
  Corners c{0, 1 % count, 2 % count};
  if (!draw.triangles.empty()) {
    const auto& v = draw.triangles[random.below(static_cast<std::uint32_t>(draw.triangles.size()))].vertices;
    c = {v[0], v[1], v[2]};
  }
  for (std::uint32_t turns = random.below(3); turns > 0; --turns) c = {c.j, c.k, c.i};
  return c;
}

void vertex_on_sample(Scene& scene, SceneDraw& draw, Random& random) {
  SceneVertex& v = any_vertex(draw, random);
  const Point p = any_sample(scene, random);
  if (random.one_in(2)) v.w = random.one_in(2) ? 1.0f : rounded(any_power_of_two(random, 6) * any_small_factor(random));
  v.x = rounded(p.x * static_cast<double>(v.w));
  v.y = rounded(p.y * static_cast<double>(v.w));
}

// m_k = a p + b m_j: the edge j k passes through the sample p = (x, y, 1), exactly where nothing is rounded.
void edge_through_sample(Scene& scene, SceneDraw& draw, Random& random) {
  const Corners c = any_corners(draw, random);
  const Point p = any_sample(scene, random);
  const double a = any_small_factor(random), b = any_small_factor(random);
  const SceneVertex& from = draw.vertices[c.j];
  SceneVertex& to = draw.vertices[c.k];
  to.x = rounded(a * p.x + b * static_cast<double>(from.x));
  to.y = rounded(a * p.y + b * static_cast<double>(from.y));
  to.w = rounded(a + b * static_cast<double>(from.w));
}

void nudge(Scene&, SceneDraw& draw, Random& random) {
  float& value = any_coordinate(any_vertex(draw, random), random);
  value = std::nextafter(value, random.one_in(2) ? HUGE_VALF : -HUGE_VALF);
}

void make_collinear(Scene&, SceneDraw& draw, Random& random) {
  const Corners c = any_corners(draw, random);
  const double a = any_small_factor(random), b = any_small_factor(random);
  const SceneVertex p = draw.vertices[c.i], q = draw.vertices[c.j];
  SceneVertex& r = draw.vertices[c.k];
  const auto blend = [&](float u, float v) { return rounded(a * static_cast<double>(u) + b * static_cast<double>(v)); };
  r.x = blend(p.x, q.x);
  r.y = blend(p.y, q.y);
  r.w = blend(p.w, q.w);
  if (random.one_in(4)) r.z = blend(p.z, q.z);
}

// Two triangles with one edge in common, run through in opposite directions (or, one time in four, in the same). A lone
// triangle gets two equal vertices instead.
void share_edge(Scene& scene, SceneDraw& draw, Random& random) {
  const Corners c = any_corners(draw, random);
  if (draw.triangles.size() < 2) {
    if (draw.triangles.empty() && scene.draws.size() == 1) return;
    SceneVertex& to = draw.vertices[c.k];
    const SceneVertex& from = draw.vertices[c.i];
    std::tie(to.x, to.y, to.z, to.w) = std::tie(from.x, from.y, from.z, from.w);
    return;
  }
  SceneTriangle& triangle = draw.triangles[random.below(static_cast<std::uint32_t>(draw.triangles.size()))];
  const bool same_direction = random.one_in(4);
  triangle.vertices[0] = static_cast<std::uint32_t>(same_direction ? c.i : c.j);
  triangle.vertices[1] = static_cast<std::uint32_t>(same_direction ? c.j : c.i);
}

void change_w(Scene&, SceneDraw& draw, Random& random) {
  SceneVertex& v = any_vertex(draw, random);
  switch (random.below(4)) {
    case 0:
      v.w = -v.w;
      break;
    case 1:
      v.w = 0;
      break;
    case 2:
      v.w = 1;
      break;
    default:  // the other side of the eye (T3)
      v.x = -v.x, v.y = -v.y, v.z = -v.z, v.w = -v.w;
  }
}

// One vertex as a whole (T4), one coordinate, or the whole draw.
void scale(Scene&, SceneDraw& draw, Random& random) {
  const double factor = any_power_of_two(random, random.one_in(4) ? 140 : 8);
  const auto by = [&](float& value) { value = rounded(static_cast<double>(value) * factor); };
  const auto whole = [&](SceneVertex& v) { by(v.x), by(v.y), by(v.z), by(v.w); };
  switch (random.below(3)) {
    case 0:
      whole(any_vertex(draw, random));
      break;
    case 1:
      by(any_coordinate(any_vertex(draw, random), random));
      break;
    default:
      std::for_each(draw.vertices.begin(), draw.vertices.end(), whole);
  }
}

// The same position by numbers that need all their bits: what was exact is so no more, but for a few units.
void fill_bits(Scene&, SceneDraw& draw, Random& random) {
  const double factor = 1 + random.unit();
  const auto whole = [&](SceneVertex& v) {
    for (float* value : {&v.x, &v.y, &v.z, &v.w}) *value = rounded(static_cast<double>(*value) * factor);
  };
  if (random.one_in(2)) {
    whole(any_vertex(draw, random));
  } else {
    std::for_each(draw.vertices.begin(), draw.vertices.end(), whole);
  }
}

void swap_order(Scene&, SceneDraw& draw, Random& random) {
  if (random.one_in(2) && draw.triangles.size() > 1) {
    const auto count = static_cast<std::uint32_t>(draw.triangles.size());
    std::swap(draw.triangles[random.below(count)], draw.triangles[random.below(count)]);
    return;
  }
  std::swap(any_vertex(draw, random), any_vertex(draw, random));
}

// A border of a block (8), a tile (64), the target or the guard band.
void align_to_border(Scene& scene, SceneDraw& draw, Random& random) {
  SceneVertex& v = any_vertex(draw, random);
  const bool along_x = random.one_in(2);
  const int guard_band = kMaxTargetSize + 1;  // of G1
  const int borders[] = {8 * random.between(-1, 2), 64 * random.between(-1, 2), along_x ? scene.width : scene.height,
                         random.one_in(2) ? guard_band : -guard_band, 0};
  const double border = borders[random.below(5)];
  (along_x ? v.x : v.y) = rounded(border * static_cast<double>(v.w));
}

void copy_coordinate(Scene&, SceneDraw& draw, Random& random) {
  SceneVertex &from = any_vertex(draw, random), &to = any_vertex(draw, random);
  switch (random.below(5)) {
    case 0:
      to.x = from.x;
      break;
    case 1:
      to.y = from.y;
      break;
    case 2:
      to.z = from.z;
      break;
    case 3:
      to.w = from.w;
      break;
    default:
      any_coordinate(to, random) = any_coordinate(from, random);
  }
}

// Multiples of 1/16: what makes the other coincidences exact.
void round_to_sixteenths(Scene&, SceneDraw& draw, Random& random) {
  SceneVertex& v = any_vertex(draw, random);
  for (float* value : {&v.x, &v.y, &v.w}) *value = std::rint(*value * 16) / 16;
}

// A plain position near the target, so that a triangle covers something.
void place_in_view(const Scene& scene, SceneVertex& v, Random& random) {
  const double beyond = random.one_in(4) ? 2 : 0.25;  // of the side
  const auto position = [&](int side) {
    return rounded(std::floor((random.unit() * (1 + 2 * beyond) - beyond) * side * 16) / 16);
  };
  v.w = 1;
  v.x = position(scene.width);
  v.y = position(scene.height);
}

void move_into_view(Scene& scene, SceneDraw& draw, Random& random) {
  place_in_view(scene, any_vertex(draw, random), random);
}

// Depths at which something is decided, and attributes that are constant or nearly so.
void set_values(Scene&, SceneDraw& draw, Random& random) {
  SceneVertex& v = any_vertex(draw, random);
  const float other = any_vertex(draw, random).z;
  const float depths[] = {
      0.0f, v.w, -v.w, v.w / 2, rounded(random.unit()), std::nextafter(v.w, 0.0f), std::nextafter(other, HUGE_VALF),
      other};
  if (v.attributes.empty() || random.one_in(2)) {
    v.z = depths[random.below(8)];
    return;
  }
  const SceneVertex& from = any_vertex(draw, random);
  const std::size_t c = random.below(static_cast<std::uint32_t>(v.attributes.size()));
  const float value = from.attributes[c];
  const float values[] = {value, std::nextafter(value, HUGE_VALF), -value, 0.0f, 1.0f, rounded(random.unit() * 256)};
  v.attributes[c] = values[random.below(6)];
}

// Another grid, or a coordinate on it, halfway between two of its lines, or one ulp beside.
void use_grid(Scene&, SceneDraw& draw, Random& random) {
  if (!draw.grid) return;
  Grid& grid = *draw.grid;
  switch (random.below(4)) {
    case 0:
      grid.bits = random.between(0, 12);
      break;
    case 1:
      grid.offset_x = random.between(0, 15), grid.offset_y = random.between(0, 15);
      break;
    case 2:
      grid.rounding = static_cast<GridRounding>(random.below(3));
      break;
    default: {
      SceneVertex& v = any_vertex(draw, random);
      const bool along_x = random.one_in(2);
      const double unit = std::ldexp(1.0, -grid.bits), offset = (along_x ? grid.offset_x : grid.offset_y) * unit / 16;
      float& coordinate = along_x ? v.x : v.y;
      if (random.one_in(2)) v.w = rounded(any_power_of_two(random, 3));
      const double steps = std::floor(random.unit() * 32 / unit) + (random.one_in(2) ? 0.5 : 0);
      coordinate = rounded((offset + steps * unit) * static_cast<double>(v.w));
      if (random.one_in(4)) coordinate = std::nextafter(coordinate, random.one_in(2) ? HUGE_VALF : -HUGE_VALF);
    }
  }
}

// A triangle whose D or edge function is a few units left of large terms, or one that the guard band cuts almost
// halfway between grid positions: no chance and no nudge finds these.
void make_nearly_zero(Scene& scene, SceneDraw& draw, Random& random) {
  const Corners c = any_corners(draw, random);
  const auto triangle = [&] {
    if (draw.grid && random.one_in(8))
      return properties::nearly_halfway_cut_triangle(random, *draw.grid, scene.width, scene.height);
    if (random.one_in(2)) return properties::nearly_tied_triangle(random, scene.width, scene.height);
    if (random.one_in(2)) return properties::nearly_degenerate_triangle(random);
    return properties::nearly_degenerate_tied_triangle(random, scene.width, scene.height);
  };
  const std::array<Vertex, 3> t = triangle();
  const std::size_t corners[] = {c.i, c.j, c.k};
  for (std::size_t i = 0; i < 3; ++i) {
    SceneVertex& v = draw.vertices[corners[i]];
    v.x = t[i].x, v.y = t[i].y, v.w = t[i].w;
    if (random.one_in(2)) v.z = t[i].z;
  }
}

// The same triangle twice, so that depths are equal and the order decides; or other identifiers.
void repeat_triangle(Scene&, SceneDraw& draw, Random& random) {
  if (draw.triangles.size() < 2) return;
  const auto count = static_cast<std::uint32_t>(draw.triangles.size());
  draw.triangles[random.below(count)].vertices = draw.triangles[random.below(count)].vertices;
  const std::uint32_t identifiers = random.below(3);  // kept, falling, or shuffled and with repetitions
  for (std::uint32_t t = 0; t < count && identifiers != 0; ++t) {
    draw.triangles[t].identifier = identifiers == 1 ? count - t : random.below(2 * count);
  }
}

// A culling box must go on holding the draw (M6): its corners are the vertices in turn.
void renew_culling_box(SceneDraw& draw) {
  if (!draw.culling_box) return;
  for (std::size_t i = 0; i < draw.culling_box->size(); ++i) {
    const SceneVertex& v = draw.vertices[i % draw.vertices.size()];
    (*draw.culling_box)[i] = {v.x, v.y, v.z, v.w};
  }
}

// One triangle more, where the form has room: three new vertices in view, or the vertices of another triangle. Old and
// new identifiers, if there are any, fall.
void add_triangle(Scene& scene, Random& random) {
  SceneDraw& draw = any_draw(scene, random);
  if (draw.triangles.size() >= kMaxTriangles) return;
  if (draw.triangles.empty() || (random.one_in(2) && draw.vertices.size() + 3 <= kMaxVertices)) {
    const std::size_t first = draw.vertices.size() + 3 <= kMaxVertices ? draw.vertices.size() : 0;
    draw.vertices.resize(std::max(draw.vertices.size(), first + 3));
    std::size_t components = 0;
    for (const corpus::SceneAttribute& attribute : scene.attributes) components += attribute.components;
    const bool level = random.one_in(2);
    for (std::size_t i = first; i < first + 3; ++i) {
      draw.vertices[i].attributes.resize(components);
      place_in_view(scene, draw.vertices[i], random);
      draw.vertices[i].z = level ? 0.5f : rounded(random.unit());
    }
    const auto v = static_cast<std::uint32_t>(first);
    draw.triangles.push_back({{v, v + 1, v + 2}, {}});
  } else {
    const SceneTriangle copy = draw.triangles[random.below(static_cast<std::uint32_t>(draw.triangles.size()))];
    draw.triangles.push_back(copy);
  }
  const bool identifiers = draw.triangles[0].identifier.has_value() || random.one_in(2);
  auto left = static_cast<std::uint32_t>(draw.triangles.size());
  if (identifiers) {
    for (SceneTriangle& triangle : draw.triangles) triangle.identifier = --left;
  }
  renew_culling_box(draw);
}

// A triangle of one depth, and another whose depth passes it between the last samples of a block (8) and those before,
// along x, y or both; either may hold the whole target.
void cross_depths(Scene& scene, SceneDraw& draw, Random& random) {
  if (draw.triangles.size() < 2) return;
  const double level = random.unit(), slope = any_power_of_two(random, 8);
  const double last_x = 8 * random.between(0, scene.width / 8) + 7,
               last_y = 8 * random.between(0, scene.height / 8) + 7;
  const int along_x = random.between(-1, 1), along_y = random.between(-1, 1);
  const std::uint32_t first = random.below(static_cast<std::uint32_t>(draw.triangles.size() - 1));
  for (const bool is_second : {false, true}) {
    const bool whole = random.one_in(2);
    for (std::size_t i = 0; i < 3; ++i) {
      SceneVertex& v = draw.vertices[draw.triangles[is_second ? first + 1 : first].vertices[i]];
      if (whole) v.x = rounded(i == 1 ? 3 * scene.width : -1), v.y = rounded(i == 2 ? 3 * scene.height : -1), v.w = 1;
      const double w = v.w, passed = along_x * (v.x - last_x * w) + along_y * (v.y - last_y * w);
      v.z = rounded(level * w + (is_second ? slope * passed : 0));
    }
  }
}

using Mutation = void (*)(Scene&, SceneDraw&, Random&);
constexpr Mutation kMutations[] = {
    vertex_on_sample,
    vertex_on_sample,
    edge_through_sample,
    edge_through_sample,
    nudge,
    nudge,
    make_collinear,
    share_edge,
    change_w,
    scale,
    fill_bits,
    swap_order,
    align_to_border,
    copy_coordinate,
    copy_coordinate,
    round_to_sixteenths,
    move_into_view,
    move_into_view,
    set_values,
    use_grid,
    use_grid,
    make_nearly_zero,
    make_nearly_zero,
    repeat_triangle,
    cross_depths,
};

// One of the modes of a frame or of a draw beyond the plain one. Where they do not go together the form refuses the scene.
void change_mode(Scene& scene, Random& random) {
  SceneDraw& draw = any_draw(scene, random);
  switch (random.below(9)) {
    case 0:
      scene.origin = random.one_in(2) ? Origin{random.between(-9, 9), random.between(-9, 9)}
                                      : Origin{random.between(-kMaxOrigin, kMaxOrigin), random.between(0, 3)};
      break;
    case 1:
      scene.sample_locations.clear();
      for (int n = 0; n < scene.samples && !random.one_in(16); ++n)
        scene.sample_locations.push_back({random.between(0, 15), random.between(0, 15)});
      break;
    case 2:
      scene.layers = random.one_in(4) ? 1 : random.between(2, kMaxLayers);
      for (SceneDraw& other : scene.draws) other.depth_write = true;
      break;
    case 3:
      scene.depth_test = static_cast<DepthTest>(random.below(4));
      break;
    case 4:
      scene.more = {random.one_in(2), random.one_in(2), random.one_in(2)};
      break;
    case 5:
      draw.depth_bias =
          DepthBias{static_cast<float>(random.between(-16, 16)) / 8, static_cast<float>(random.between(-16, 16)) / 8};
      break;
    case 6:
      draw.primitive = static_cast<Primitive>(random.below(3));
      for (corpus::SceneTriangle& primitive : draw.triangles)  // beyond its own the last vertex repeats
        for (std::size_t i = corpus::corners_of(draw.primitive); i < 3; ++i)
          primitive.vertices[i] = primitive.vertices[i - 1];
      break;
    case 7:
      draw.width = std::ldexp(static_cast<float>(random.between(1, 40)), random.between(-8, 2));
      break;
    default:
      if (draw.conservative != Conservative::none) draw.conservative = static_cast<Conservative>(1 + random.below(4));
  }
}

bool plain() {
  static const bool is_plain = std::getenv("SUREFILL_FUZZ_PLAIN") != nullptr;
  return is_plain;
}

// Without a fuzzer that brings one: a byte changed.
std::size_t mutate_plainly(std::uint8_t* data, std::size_t size, std::size_t max_size, Random& random) {
  if (LLVMFuzzerMutate != nullptr) return LLVMFuzzerMutate(data, size, max_size);
  if (size == 0) return 0;
  data[random.below(static_cast<std::uint32_t>(size))] = static_cast<std::uint8_t>(random.bits());
  return size;
}

// The bytes of a scene, followed by what in `old` came after its form.
std::optional<Bytes> bytes_of(const Form& form, const Scene& scene, std::span<const std::uint8_t> old) {
  std::optional<Bytes> bytes = form.encode(scene);
  if (bytes && old.size() > form.size)
    bytes->insert(bytes->end(), old.begin() + static_cast<std::ptrdiff_t>(form.size), old.end());
  for (std::size_t i = form.kept_begin; bytes && i < std::min(form.kept_end, old.size()); ++i) (*bytes)[i] = old[i];
  return bytes;
}

std::size_t store(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
  const std::size_t size = std::min(bytes.size(), out.size());
  if (size != 0) std::memmove(out.data(), bytes.data(), size);
  return size;
}

}  // namespace

void mutate(Scene& scene, Random& random) {
  for (int rounds = 1 + static_cast<int>(random.below(3)); rounds > 0; --rounds) {
    SceneDraw& draw = any_draw(scene, random);
    if (draw.vertices.empty()) continue;
    kMutations[random.below(std::size(kMutations))](scene, draw, random);
    renew_culling_box(draw);
  }
}

void cross(Scene& scene, const Scene& other, Random& random) {
  SceneDraw& draw = any_draw(scene, random);
  const SceneDraw& from = other.draws[random.below(static_cast<std::uint32_t>(other.draws.size()))];
  const auto copy = [](const SceneVertex& source, SceneVertex& to) {
    std::tie(to.x, to.y, to.z, to.w) = std::tie(source.x, source.y, source.z, source.w);
  };
  if (!draw.vertices.empty() && !from.vertices.empty()) {
    const auto any_of_other = [&] {
      return from.vertices[random.below(static_cast<std::uint32_t>(from.vertices.size()))];
    };
    switch (random.below(4)) {
      case 0:
        copy(any_of_other(), any_vertex(draw, random));
        break;
      case 1: {  // an edge in common
        const Corners c = any_corners(draw, random);
        copy(any_of_other(), draw.vertices[c.i]);
        copy(any_of_other(), draw.vertices[c.j]);
        break;
      }
      case 2:  // the geometry of one, the state of the other
        for (std::size_t i = 0; i < std::min(draw.vertices.size(), from.vertices.size()); ++i)
          copy(from.vertices[i], draw.vertices[i]);
        break;
      default:
        draw.fill_rule = from.fill_rule, draw.front_face = from.front_face, draw.cull = from.cull;
        if (draw.conservative == Conservative::none) draw.depth_mode = from.depth_mode;
        if (draw.grid && from.grid) draw.grid = from.grid;
        if (draw.grid && draw.fill_rule > FillRule::northwards_west) draw.fill_rule = FillRule::top_left;  // C5
        scene.depth_test = other.depth_test;
    }
  }
  renew_culling_box(draw);
}

std::size_t mutate_bytes(const Form& form, std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
  Random random(seed);
  if (plain() || random.one_in(2)) return mutate_plainly(data, size, max_size, random);
  const std::span<const std::uint8_t> old(data, size);
  Scene scene = form.decode(old);
  if (!form.sides.empty() && random.one_in(16)) {
    (random.one_in(2) ? scene.width : scene.height) =
        form.sides[random.below(static_cast<std::uint32_t>(form.sides.size()))];
  } else if (form.grows && random.one_in(8)) {
    add_triangle(scene, random);
  } else if (form.grows && random.one_in(8)) {
    change_mode(scene, random);
  } else {
    mutate(scene, random);
  }
  std::optional<Bytes> bytes = bytes_of(form, scene, old);
  if (bytes && form.kept_end > form.kept_begin && random.one_in(8)) {
    const auto kept = random.between(static_cast<int>(form.kept_begin), static_cast<int>(form.kept_end) - 1);
    (*bytes)[static_cast<std::size_t>(kept)] = static_cast<std::uint8_t>(random.bits());
  }
  return bytes ? store(*bytes, {data, max_size}) : mutate_plainly(data, size, max_size, random);
}

std::size_t cross_bytes(const Form& form, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                        std::span<std::uint8_t> out, unsigned seed) {
  Random random(seed);
  if (!plain() && !random.one_in(4)) {
    Scene scene = form.decode(a);
    cross(scene, form.decode(b), random);
    if (const std::optional<Bytes> bytes = bytes_of(form, scene, a)) return store(*bytes, out);
  }
  // The head of one, the tail of the other.
  Bytes joined(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(random.bits() % (a.size() + 1)));
  if (joined.size() < b.size())
    joined.insert(joined.end(), b.begin() + static_cast<std::ptrdiff_t>(joined.size()), b.end());
  return store(joined, out);
}

}  // namespace surefill::fuzz
