// SPDX-License-Identifier: Apache-2.0
//
// T1: triangles that tile a region cover each sample in it exactly once. Every mesh here tiles more than the target,
// over the reals, so that the expectation is trivial: the count is 1 everywhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "properties/generators/meshes.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

struct Size {
  int width, height;
};

Size random_size(Random& r) {
  return {r.between(1, 20), r.between(1, 20)};
}

// Same mesh, same directions of its vertices, other float32: each vertex, or each corner of each triangle, scaled by
// its own power of two (T4); triangles in any order, facing and rotation; any fill rule.
corpus::Scene disguised(Mesh mesh, Size size, Random& r) {
  const std::uint32_t kind = r.below(3);
  const auto scaled = [&](Vertex v) { return scaled_exactly(v, r.between(-30, 30)).value_or(v); };
  if (kind == 1) std::transform(mesh.vertices.begin(), mesh.vertices.end(), mesh.vertices.begin(), scaled);
  for (std::size_t i = mesh.triangles.size(); i > 0; --i) {
    Indices& t = mesh.triangles[i - 1];
    std::swap(t, mesh.triangles[r.below(static_cast<std::uint32_t>(i))]);
    std::swap(t[0], t[r.below(3)]);
    std::swap(t[1], t[1 + r.below(2)]);
  }
  if (kind == 2)
    for (Indices& t : mesh.triangles)
      for (std::uint32_t& corner : t) {
        mesh.vertices.push_back(scaled(mesh.vertices[corner]));
        corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      }
  corpus::Scene scene = mesh_scene(mesh, size.width, size.height);
  scene.draws[0].fill_rule = static_cast<FillRule>(r.below(8));
  return scene;
}

float nudged(Random& r, float value) {
  return std::nextafter(value, r.one_in(2) ? 1e30f : -1e30f);
}

std::uint32_t add(Mesh& mesh, float x, float y) {
  mesh.vertices.push_back({x, y, 0, 1});
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// Strictly increasing coordinates from before 0 to beyond `size`: multiples of 1/q, half pixels among them.
std::vector<float> lines(Random& r, int size, int q) {
  std::vector<float> at;
  const int end = (size + 2) * q;
  for (int k = -r.between(1, 2 * q); k < end; k += r.between(1, r.one_in(3) ? 2 : 3 * q))
    at.push_back(static_cast<float>(k) / static_cast<float>(q));
  at.push_back(static_cast<float>(end) / static_cast<float>(q));
  return at;
}

// The points of a lattice of 1/q pixel, at random, and four corners around the target: many edges and vertices lie on
// samples.
Mesh delaunay_mesh(Random& r, Size size, float x0, float x1) {
  std::vector<std::array<float, 2>> points;
  const auto height = static_cast<float>(size.height);
  for (const float x : {x0, x1})
    for (const float y : {-1.5f, height + 1.5f}) points.push_back({x, y});
  const int resolutions[] = {2, 2, 4, 16, 256, 0};
  const int q = resolutions[r.below(6)];
  const bool off = r.one_in(3);  // an ulp off the lattice: edges pass samples as closely as float32 can
  for (int n = r.between(0, 60); n > 0; --n) {
    const double x = x0 + (x1 - x0) * r.unit(), y = -1.5 + (height + 3) * r.unit();
    if (q == 0)
      points.push_back({static_cast<float>(x), static_cast<float>(y)});  // any float32
    else
      points.push_back(
          {std::max(x0, static_cast<float>(std::floor(x * q) / q)), static_cast<float>(std::floor(y * q) / q)});
    if (off)
      for (float& c : points.back()) c = nudged(r, c);
    points.back()[0] = std::clamp(points.back()[0], x0, x1);
  }
  Mesh mesh;
  for (const auto& p : points) add(mesh, p[0], p[1]);
  mesh.triangles = delaunay(points);
  return mesh;
}

corpus::Scene make_delaunay(std::uint64_t seed) {
  Random r(seed ^ 0xD31A);
  const Size size = random_size(r);
  return disguised(delaunay_mesh(r, size, -1.5f, static_cast<float>(size.width) + 1.5f), size, r);
}

// Two meshes made apart, each its own draw, that meet along a vertical line through samples.
corpus::Scene make_adjacent(std::uint64_t seed) {
  Random r(seed ^ 0xADAC);
  const Size size = random_size(r);
  const float seam = static_cast<float>(r.between(0, size.width - 1)) + 0.5f;
  corpus::Scene left = disguised(delaunay_mesh(r, size, -1.5f, seam), size, r);
  const corpus::Scene right = disguised(delaunay_mesh(r, size, seam, static_cast<float>(size.width) + 1.5f), size, r);
  left.draws.push_back(right.draws[0]);
  left.draws[1].fill_rule = left.draws[0].fill_rule;
  return left;
}

// All triangles meet in one sample; the spokes end at lattice points of a rectangle around the target.
corpus::Scene make_fan(std::uint64_t seed) {
  Random r(seed ^ 0xFA17);
  const Size size = random_size(r);
  Mesh mesh;
  const int column = r.between(0, size.width - 1), row = r.between(0, size.height - 1);
  add(mesh, static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
  // In half pixels, once around; the corners always, the points between them at random.
  const int x1 = 2 * size.width + 3, y1 = 2 * size.height + 3, step = r.between(1, 12);
  const auto spoke = [&](int x, int y) { add(mesh, static_cast<float>(x) / 2, static_cast<float>(y) / 2); };
  for (int x = -3; x < x1; x = std::min(x1, x + r.between(1, step))) spoke(x, -3);
  for (int y = -3; y < y1; y = std::min(y1, y + r.between(1, step))) spoke(x1, y);
  for (int x = x1; x > -3; x = std::max(-3, x - r.between(1, step))) spoke(x, y1);
  for (int y = y1; y > -3; y = std::max(-3, y - r.between(1, step))) spoke(-3, y);
  const auto spokes = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t i = 0; i < spokes; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
  return disguised(std::move(mesh), size, r);
}

// Rows of quads, each cut along either diagonal.
corpus::Scene make_quads(std::uint64_t seed) {
  Random r(seed ^ 0x90AD);
  const Size size = random_size(r);
  const int resolutions[] = {2, 2, 1, 4, 16};
  const int q = resolutions[r.below(5)];
  const std::vector<float> xs = lines(r, size.width, q);
  const std::vector<float> ys =
      r.one_in(4) ? std::vector<float>{-0.5f, static_cast<float>(size.height) + 0.5f} : lines(r, size.height, q);
  Mesh mesh;
  for (const float y : ys)
    for (const float x : xs) add(mesh, x, y);
  if (r.one_in(3))  // still convex quads: an ulp is far less than a line's distance to the next
    for (Vertex& v : mesh.vertices) {
      v.x = nudged(r, v.x);
      v.y = nudged(r, v.y);
    }
  const auto columns = static_cast<std::uint32_t>(xs.size());
  for (std::uint32_t row = 0; row + 1 < ys.size(); ++row)
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      if (r.one_in(2)) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, c, d});
      }
    }
  return disguised(std::move(mesh), size, r);
}

// Triangles over integer vectors, split at random where that is exact. Edges are split on one side only: T-junctions.
class Splitter {
 public:
  using Vector = std::array<std::int64_t, 3>;
  using Triangle = std::array<Vector, 3>;

  explicit Splitter(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {}

  static std::int64_t determinant(const Vector& a, const Vector& b, const Vector& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }

  // At a point between two corners: i a + j b.
  void split_edge(Random& r) {
    const std::size_t t = pick(r), e = r.below(3);
    const Triangle old = triangles_[t];
    const auto v = combined(old, {r.between(1, 2), r.between(1, 2), 0}, e);
    if (v) replace(t, *v);
  }

  // At a point strictly inside.
  void split_inside(Random& r) {
    const std::size_t t = pick(r);
    const Triangle old = triangles_[t];
    const auto v = combined(old, {r.between(1, 2), r.between(1, 2), r.between(1, 2)}, 0);
    if (v) replace(t, *v);
  }

  // At a point given, in the triangle that contains it (one of them, if it lies on an edge).
  void split_at(const Vector& point) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const std::int64_t d = determinant(a, b, c) > 0 ? 1 : -1;
      if (determinant(b, c, point) * d >= 0 && determinant(c, a, point) * d >= 0 && determinant(a, b, point) * d >= 0)
        return replace(t, point);
    }
  }

  Mesh mesh() const {
    Mesh result;
    for (const Triangle& t : triangles_) {
      const auto first = static_cast<std::uint32_t>(result.vertices.size());
      for (const Vector& v : t)
        result.vertices.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), 0, static_cast<float>(v[2])});
      result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
  }

 private:
  // Components stay below 2^18: determinants fit in 64 bits, vertices in float32.
  static constexpr std::int64_t kLimit = 1 << 18;

  std::size_t pick(Random& r) const { return r.below(static_cast<std::uint32_t>(triangles_.size())); }

  static std::optional<Vector> combined(const Triangle& t, std::array<std::int64_t, 3> weights, std::size_t first) {
    Vector v{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c) v[c] += weights[i] * t[(first + i) % 3][c];
    for (const std::int64_t c : v)
      if (std::abs(c) >= kLimit) return std::nullopt;
    return v;
  }

  // The triangle's cone is the union of those of v and each edge; an edge that contains v adds nothing.
  void replace(std::size_t t, const Vector& v) {
    const Triangle old = triangles_[t];
    triangles_.erase(triangles_.begin() + static_cast<std::ptrdiff_t>(t));
    for (std::size_t i = 0; i < 3; ++i)
      if (determinant(old[i], old[(i + 1) % 3], v) != 0) triangles_.push_back({old[i], old[(i + 1) % 3], v});
  }

  std::vector<Triangle> triangles_;
};

Splitter::Vector doubled_sample(Random& r, Size size) {
  return {2 * r.between(0, size.width - 1) + 1, 2 * r.between(0, size.height - 1) + 1, 2};
}

Mesh split_at_random(Splitter splitter, Random& r, Size size) {
  for (int n = r.between(0, 40); n > 0; --n) {
    if (r.one_in(4))
      splitter.split_at(doubled_sample(r, size));
    else if (r.one_in(4))
      splitter.split_inside(r);
    else
      splitter.split_edge(r);
  }
  return splitter.mesh();
}

// A rectangle on half pixels around the target, cut again and again; points and edges fall on samples.
corpus::Scene make_t_junctions(std::uint64_t seed) {
  Random r(seed ^ 0x7777);
  const Size size = random_size(r);
  const std::int64_t x1 = 2 * size.width + r.between(1, 9), y1 = 2 * size.height + r.between(1, 9),
                     x0 = -r.between(1, 9), y0 = -r.between(1, 9);
  const Splitter::Vector a = {x0, y0, 2}, b = {x1, y0, 2}, c = {x0, y1, 2}, d = {x1, y1, 2};
  return disguised(split_at_random(Splitter({{a, b, c}, {d, c, b}}), r, size), size, r);
}

// All directions around the eye: the eight cones of three vectors (T3), cut again and again. Vertices lie in front of
// the eye, behind it and at infinity; each sample's ray still meets one triangle.
corpus::Scene make_all_around(std::uint64_t seed) {
  Random r(seed ^ 0xA77);
  const Size size = random_size(r);
  std::array<Splitter::Vector, 3> m{};
  while (Splitter::determinant(m[0], m[1], m[2]) == 0)
    for (Splitter::Vector& v : m) {
      v = {r.between(-2 * size.width, 2 * size.width), r.between(-2 * size.height, 2 * size.height), r.between(-2, 3)};
      if (r.one_in(3)) v = doubled_sample(r, size);
    }
  std::vector<Splitter::Triangle> cones;
  for (unsigned signs = 0; signs < 8; ++signs) {
    Splitter::Triangle t = m;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::int64_t& c : t[i]) c = (signs >> i) & 1u ? -c : c;
    cones.push_back(t);
  }
  return disguised(split_at_random(Splitter(std::move(cones)), r, size), size, r);
}

// A Delaunay mesh on a grid that it is then snapped to: still a tiling (G3).
corpus::Scene make_on_grid(std::uint64_t seed) {
  Random r(seed ^ 0x96D);
  const Size size = random_size(r);
  const Grid grid{r.between(1, 8), 0, 0, static_cast<GridRounding>(r.below(3))};
  std::vector<std::array<float, 2>> points;
  const auto coordinate = [&](int end) {
    return std::ldexp(static_cast<float>(r.between(-(3 << grid.bits) / 2, (2 * end + 3) << grid.bits >> 1)),
                      -grid.bits);
  };
  for (const float x : {-1.5f, static_cast<float>(size.width) + 1.5f})
    for (const float y : {-1.5f, static_cast<float>(size.height) + 1.5f}) points.push_back({x, y});
  for (int n = r.between(0, 60); n > 0; --n) {
    const float x = coordinate(size.width);
    points.push_back({x, coordinate(size.height)});
  }
  Mesh mesh;
  for (const auto& p : points) add(mesh, p[0], p[1]);
  mesh.triangles = delaunay(points);
  corpus::Scene scene = disguised(std::move(mesh), size, r);
  scene.draws[0].grid = grid;
  return scene;
}

// A Delaunay mesh that snapping deforms: its triangles all face the viewer, some of them face away when snapped (G3).
corpus::Scene make_deformed(std::uint64_t seed) {
  Random r(seed ^ 0xDEF0);
  const Size size = random_size(r);
  Mesh mesh = delaunay_mesh(r, size, -1.5f, static_cast<float>(size.width) + 1.5f);
  corpus::Scene scene = mesh_scene(mesh, size.width, size.height);
  corpus::SceneDraw& draw = scene.draws[0];
  for (corpus::SceneTriangle& t : draw.triangles)
    if (facing(triangle_of(draw, t)) < 0) std::swap(t.vertices[1], t.vertices[2]);
  draw.fill_rule = static_cast<FillRule>(r.below(8));
  const int bits[] = {0, 1, 2, 4, 8, 12};
  draw.grid = Grid{bits[r.below(6)], r.between(0, 15), r.between(0, 15), static_cast<GridRounding>(r.below(3))};
  if (draw.grid->bits == 0) draw.grid->offset_x = draw.grid->offset_y = 0;  // then snapping moves less than 1.5 px
  return scene;
}

TrialResult decide_signed(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto image = trial.draw_facings(scene);
  if (!image) return trial.verdict();
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(image->front, x, y);
      trial.expect_count("front of a snapped tiling, against 1 + back,", x, y, 1 + image->back.count[e],
                         image->front.count[e]);
    }
  trial.looked_at(image->front.count.size());
  return trial.verdict();
}

TrialResult decide(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto image = trial.draw(scene, kCountOnly);
  if (!image) return trial.verdict();
  for (int y = 0; y < image->height; ++y)
    for (int x = 0; x < image->width; ++x)
      trial.expect_count("count of a tiling", x, y, 1, image->count[element(*image, x, y)]);
  trial.looked_at(image->count.size());
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"partition-delaunay", "T1", "Delaunay meshes on lattices that contain samples cover each sample once", false,
     false, 0, make_delaunay, decide},
    {"partition-adjacent", "T1", "two meshes that meet along a line through samples cover each sample once", false,
     false, 0, make_adjacent, decide},
    {"partition-fan", "T1", "the triangles around a sample cover it, and every other, once", false, false, 0, make_fan,
     decide},
    {"partition-quads", "T1", "strips and grids of quads cover each sample once", false, false, 0, make_quads, decide},
    {"partition-t-junctions", "T1", "tilings with T-junctions cover each sample once", false, false, 0,
     make_t_junctions, decide},
    {"partition-all-around", "T1", "triangles all around the eye cover each sample once", false, false, 0,
     make_all_around, decide},
    {"grid-partition", "G3, T1", "tilings on the grid that they are snapped to cover each sample once", false, false, 0,
     make_on_grid, decide},
    {"grid-degree", "G3", "over tilings that snapping deforms, front minus back is 1", false, false, 0, make_deformed,
     decide_signed},
};

}  // namespace

std::span<const Property> partition_properties() {
  return kProperties;
}

}  // namespace surefill::properties
