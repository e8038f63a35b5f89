// SPDX-License-Identifier: Apache-2.0
//
// T2: over a closed mesh, front minus back is the mesh's winding number around the eye, at every sample.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "properties/generators/meshes.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector direction(const Vertex& v) {
  const double x = v.x, y = v.y, w = v.w, length = std::sqrt(x * x + y * y + w * w);
  return {x / length, y / length, w / length};
}

// The winding number of the closed mesh around the origin of (X, Y, W): its solid angles, over 4 pi (Van Oosterom and
// Strackee, 1983). The sum is a whole number but for rounding; the signs, on which it hangs, are exact.
int winding_number(const corpus::SceneDraw& draw) {
  double sum = 0;
  for (const corpus::SceneTriangle& triangle : draw.triangles) {
    const std::array<Vertex, 3> t = triangle_of(draw, triangle);
    const int sign = facing(t);
    if (sign == 0) continue;
    const Vector a = direction(t[0]), b = direction(t[1]), c = direction(t[2]);
    sum += 2 * std::atan2(sign * std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
  }
  return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

// Where D = 0, the eye lies in the triangle's plane; it lies outside of the triangle if all angles at the eye are
// acute.
bool eye_may_lie_in_a_triangle(const corpus::SceneDraw& draw) {
  return std::any_of(draw.triangles.begin(), draw.triangles.end(), [&](const corpus::SceneTriangle& triangle) {
    const std::array<Vertex, 3> t = triangle_of(draw, triangle);
    if (facing(t) != 0) return false;
    const auto acute = [](const Vertex& a, const Vertex& b) {
      const double x = a.x, y = a.y, w = a.w;
      return x * b.x + y * b.y + w * b.w > 0;
    };
    return !(acute(t[0], t[1]) && acute(t[1], t[2]) && acute(t[2], t[0]));
  });
}

void scale_vertices(Mesh& mesh, Random& r) {
  if (!r.one_in(3)) return;
  for (Vertex& v : mesh.vertices) {
    const float s = std::ldexp(1.0f, r.between(-20, 20));
    v = {v.x * s, v.y * s, v.z * s, v.w * s};
  }
}

// Integer points around a centre, near the eye or away from it. The rays of the target's samples pass through W > 0.
std::vector<std::array<float, 3>> points_in_space(Random& r, int width, int height) {
  const int wide = 2 * width + 2, high = 2 * height + 2, deep = r.between(1, 6);
  const int cx = r.one_in(2) ? 0 : r.between(-wide, wide), cy = r.one_in(2) ? 0 : r.between(-high, high);
  const int cw = r.one_in(2) ? 0 : r.between(-deep, 2 * deep);
  std::vector<std::array<float, 3>> points;
  for (int n = r.between(4, 24); n > 0; --n)
    points.push_back({static_cast<float>(cx + r.between(-wide, wide)), static_cast<float>(cy + r.between(-high, high)),
                      static_cast<float>(cw + r.between(-deep, deep))});
  return points;
}

corpus::Scene make_hull(std::uint64_t seed) {
  Random r(seed ^ 0x4011);
  for (;;) {
    const int width = r.between(1, 16), height = r.between(1, 16);
    const std::vector<std::array<float, 3>> points = points_in_space(r, width, height);
    Mesh mesh;
    mesh.triangles = convex_hull(points);
    for (const auto& p : points) mesh.vertices.push_back({p[0], p[1], 0, p[2]});
    scale_vertices(mesh, r);
    corpus::Scene scene = mesh_scene(mesh, width, height);
    corpus::SceneDraw& draw = scene.draws[0];
    draw.fill_rule = static_cast<FillRule>(r.below(8));
    // On the hull itself the eye sees faces of one facing only, some of them edge-on.
    std::array<int, 3> facings{};
    for (const corpus::SceneTriangle& t : draw.triangles)
      ++facings[static_cast<std::size_t>(facing(triangle_of(draw, t)) + 1)];
    const bool on_hull = facings[1] != 0 && (facings[0] == 0 || facings[2] == 0);
    if (!mesh.triangles.empty() && !on_hull) return scene;
  }
}

// A closed surface of any shape that crosses itself: the connections of an octahedron or of a tetrahedron, vertices
// anywhere.
corpus::Scene make_tangle(std::uint64_t seed) {
  Random r(seed ^ 0x7A46);
  constexpr Indices kOctahedron[] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                     {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  constexpr Indices kTetrahedron[] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  for (;;) {
    const int width = r.between(1, 16), height = r.between(1, 16);
    std::vector<std::array<float, 3>> points;
    while (points.size() < 6) points = points_in_space(r, width, height);
    Mesh mesh;
    for (const auto& p : points) mesh.vertices.push_back({p[0], p[1], 0, p[2]});
    if (r.one_in(2))
      mesh.triangles.assign(std::begin(kOctahedron), std::end(kOctahedron));
    else
      mesh.triangles.assign(std::begin(kTetrahedron), std::end(kTetrahedron));
    corpus::Scene scene = mesh_scene(mesh, width, height);
    scene.draws[0].fill_rule = static_cast<FillRule>(r.below(8));
    if (!eye_may_lie_in_a_triangle(scene.draws[0])) return scene;
  }
}

// Spot, seen from inside or outside: a camera at `eye` in a random frame, each vertex rounded once to float32, so that
// the mesh stays closed.
corpus::Scene make_spot(std::uint64_t seed) {
  static const Mesh spot = load_mesh("spot.obj");
  Random r(seed ^ 0x5907);
  for (;;) {
    const int width = r.between(1, 12), height = r.between(1, 12);
    const auto coordinate = [&](double reach) { return (2 * r.unit() - 1) * reach; };
    const double reach = r.one_in(2) ? 0.2 : 3;
    const Vector eye = {coordinate(reach), coordinate(reach), coordinate(reach)};
    // Away from the mesh the camera looks at it.
    Vector forward = reach < 1 ? Vector{coordinate(1), coordinate(1), coordinate(1)}
                               : Vector{coordinate(0.3) - eye[0], coordinate(0.3) - eye[1], coordinate(0.3) - eye[2]};
    const Vector up = {coordinate(1), coordinate(1), coordinate(1)};
    const auto unit = [](const Vector& v) {
      const double length = std::sqrt(dot(v, v));
      return Vector{v[0] / length, v[1] / length, v[2] / length};
    };
    forward = unit(forward);
    const Vector right = unit(cross(forward, up)), down = cross(forward, right);
    Mesh mesh = spot;
    for (Vertex& v : mesh.vertices) {
      const Vector seen = {v.x - eye[0], v.y - eye[1], v.z - eye[2]};
      const double w = dot(seen, forward);
      v = {static_cast<float>(width * (dot(seen, right) + w / 2)),
           static_cast<float>(height * (dot(seen, down) + w / 2)), 0, static_cast<float>(w)};
    }
    scale_vertices(mesh, r);
    corpus::Scene scene = mesh_scene(mesh, width, height);
    if (!eye_may_lie_in_a_triangle(scene.draws[0])) return scene;
  }
}

TrialResult decide(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto image = trial.draw_facings(scene);
  if (!image) return trial.verdict();
  const int expected = winding_number(scene.draws[0]);
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(image->front, x, y);
      const auto degree = static_cast<int>(image->front.count[e]) - static_cast<int>(image->back.count[e]);
      if (degree != expected)
        trial.differs("front minus back of a closed mesh", x, y, std::to_string(expected), std::to_string(degree));
    }
  trial.looked_at(image->front.count.size());
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"degree-hull", "T2", "over convex hulls, front minus back is the winding number around the eye", false, false, 0,
     make_hull, decide},
    {"degree-tangle", "T2", "over closed meshes that cross themselves, front minus back is the winding number", false,
     false, 0, make_tangle, decide},
    {"degree-spot", "T2", "over spot.obj, from inside and outside, front minus back is the winding number", false,
     false, 0, make_spot, decide},
};

}  // namespace

std::span<const Property> degree_properties() {
  return kProperties;
}

}  // namespace surefill::properties
