// SPDX-License-Identifier: Apache-2.0
#include "properties/generators/occluders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace surefill::properties {

namespace {

// As in generators.cpp, an expression draws one random number, or draws them in braces.

float power_of_two(Random& r, int low, int high) {
  return std::ldexp(1.0f, r.between(low, high));
}

std::uint32_t add(Mesh& mesh, const Vertex& v) {
  mesh.vertices.push_back(v);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// --- Depth and W

// Depth of every kind for vertices that have W = 1, and then a W of their own: each position stays what it is.
void give_depth(Random& r, Mesh& mesh) {
  const std::uint32_t kind = r.below(8);
  const auto shared = static_cast<float>(r.between(1, 15)) / 16;
  const std::array slope = {static_cast<float>(r.between(-8, 8)) / 256, static_cast<float>(r.between(-8, 8)) / 256};
  for (Vertex& v : mesh.vertices) {
    switch (kind) {
      case 0:
        v.z = shared;
        break;
      case 1:
      case 2:
        v.z = shared + slope[0] * v.x + slope[1] * v.y;
        break;
      case 3:
        v.z = static_cast<float>(r.unit());
        break;
      case 4:
        v.z = static_cast<float>(r.between(-2, 10)) / 8;  // across the bounds of clip and clamp
        break;
      case 5:
        v.z = r.one_in(2) ? 1.0f : 0.0f;
        break;
      case 6:
        v.z = r.one_in(4) ? std::nextafter(1.0f, 2.0f) : 1.0f;
        break;
      default:
        v.z = r.one_in(2) ? shared : std::nextafter(shared, 1.0f);
        break;
    }
  }
  if (r.one_in(16)) {  // beyond range, or below the smallest float32
    const bool vast = r.one_in(2), negative = r.one_in(2);
    for (Vertex& v : mesh.vertices) {
      v.z = vast ? std::numeric_limits<float>::max() : std::numeric_limits<float>::denorm_min();
      if (negative) v.z = -v.z;
      if (!vast || r.one_in(2)) v.w = vast ? 0.5f : 2.0f;
      v.x *= v.w, v.y *= v.w;
    }
    return;
  }
  if (r.one_in(2)) return;
  const bool thirds = r.one_in(2);  // constant W = 3: depths that no float32 has
  for (Vertex& v : mesh.vertices) {
    const float w = thirds ? 3 : static_cast<float>(r.between(1, 4));
    v = {v.x * w, v.y * w, thirds ? v.z : v.z * w, w};
  }
}

// --- Meshes

// Cells of `columns` by `rows` over these vertices, row by row, each two triangles, D > 0 where x and y grow.
void add_cells(Random& r, Mesh& mesh, int columns, int rows) {
  const auto at = [columns](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (r.one_in(2)) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
}

// A sheet on a lattice of 1/q pixel: rims run along and through corners of pixels.
Mesh sheet(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const int most = std::clamp(static_cast<int>(std::sqrt(faces / 2)), 1, 8);
  const int columns = r.between(1, most), rows = r.between(1, most), q = 1 << r.between(0, 4);
  const std::array sizes = {width, height}, cells = {columns, rows};
  std::array<float, 2> first{}, step{};
  for (std::size_t k = 0; k < 2; ++k) {
    first[k] = static_cast<float>(r.between(-2 * q, sizes[k] * q / 2)) / static_cast<float>(q);
    step[k] = static_cast<float>(r.between(1, std::max(1, 2 * sizes[k] * q / cells[k]))) / static_cast<float>(q);
  }
  const bool moved = r.one_in(2);
  const int shear = r.one_in(2) ? r.between(-2, 2) : 0;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      Vertex v{first[0] + static_cast<float>(i) * step[0], first[1] + static_cast<float>(j) * step[1], 0, 1};
      v.x += static_cast<float>(shear * j);
      if (moved && r.one_in(2)) v.x += step[0] / 4 * static_cast<float>(r.between(-1, 1));
      if (moved && r.one_in(2)) v.y += step[1] / 4 * static_cast<float>(r.between(-1, 1));
      mesh.vertices.push_back(v);
    }
  }
  add_cells(r, mesh, columns, rows);
  give_depth(r, mesh);
  return mesh;
}

// The Delaunay triangulation of lattice points: triangles of all shapes, slivers too.
Mesh triangulation(Random& r, int width, int height, int faces) {
  const int q = 1 << r.between(0, 8), points = r.between(3, std::max(4, faces / 2));
  std::vector<std::array<float, 2>> places;
  for (int n = 0; n < points; ++n) {
    const int x = r.between(-2 * q, (width + 2) * q), y = r.between(-2 * q, (height + 2) * q);
    places.push_back({static_cast<float>(x) / static_cast<float>(q), static_cast<float>(y) / static_cast<float>(q)});
  }
  Mesh mesh;
  mesh.triangles = delaunay(places);
  for (const auto& [x, y] : places) mesh.vertices.push_back({x, y, 0, 1});
  give_depth(r, mesh);
  return mesh;
}

// Triangles around one vertex, which lies at a corner, on the border or in the middle of a pixel; some thin.
Mesh fan(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const int spokes = r.between(3, std::clamp(faces, 3, 12));
  const auto x = static_cast<float>(r.between(0, 2 * width)) / 2, y = static_cast<float>(r.between(0, 2 * height)) / 2;
  mesh.vertices.push_back({x, y, 0, 1});
  const double turn = r.unit();
  const bool thin = r.one_in(3), lattice = r.one_in(2);
  for (int n = 0; n < spokes; ++n) {
    double angle = 2 * 3.14159265358979 * (n + turn) / spokes;
    if (thin && n % 2 == 1) angle -= 2 * 3.14159265358979 / spokes * (1 - 0x1p-8);
    const double radius = (0.2 + r.unit()) * (width + height) / 2;
    double px = x + radius * std::cos(angle), py = y + radius * std::sin(angle);
    if (lattice) px = std::floor(px), py = std::floor(py);
    mesh.vertices.push_back({static_cast<float>(px), static_cast<float>(py), 0, 1});
  }
  for (int n = 0; n < spokes; ++n) {
    mesh.triangles.push_back({0, static_cast<std::uint32_t>(1 + n), static_cast<std::uint32_t>(1 + (n + 1) % spokes)});
  }
  if (r.one_in(3)) mesh.triangles.pop_back();
  give_depth(r, mesh);
  return mesh;
}

// A camera that sees lattice points of a world: W is the distance, of either sign.
struct Camera {
  float focus, x, y, far, near;
  Camera(Random& r, int width, int height)
      : focus(static_cast<float>(r.between(1, std::max(2, width)))),
        x(static_cast<float>(r.between(0, 2 * width)) / 2),
        y(static_cast<float>(r.between(0, 2 * height)) / 2),
        far(r.one_in(2) ? 1.0f : static_cast<float>(r.between(3, 5)) / 4),
        near(power_of_two(r, -3, 1)) {}
  Vertex operator()(float px, float py, float pz) const {
    return {focus * px + x * pz, focus * py + y * pz, far * pz - near, pz};
  }
};

// The twelve faces of a box of the world, seen by the camera.
void add_box(Mesh& mesh, const Camera& camera, const std::array<float, 3>& low, const std::array<float, 3>& high) {
  std::array<std::uint32_t, 8> corner{};
  for (std::size_t n = 0; n < 8; ++n) {
    corner[n] = add(mesh, camera(n & 1 ? high[0] : low[0], n & 2 ? high[1] : low[1], n & 4 ? high[2] : low[2]));
  }
  constexpr std::size_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                        {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& [a, b, c, d] : kFaces) {
    mesh.triangles.push_back({corner[a], corner[b], corner[c]});
    mesh.triangles.push_back({corner[a], corner[c], corner[d]});
  }
}

// Boxes of a small lattice: neighbours share faces, edges and corners. Some reach behind the eye.
Mesh city(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const Camera camera(r, width, height);
  const int boxes = r.between(1, std::clamp(faces / 12, 1, 12)), nearest = r.one_in(3) ? -2 : 1;
  for (int n = 0; n < boxes; ++n) {
    std::array<float, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = k == 2 ? r.between(nearest, 6) : r.between(-4, 3);
      low[k] = static_cast<float>(from);
      high[k] = static_cast<float>(from + r.between(1, 3));
    }
    add_box(mesh, camera, low, high);
  }
  return mesh;
}

// A floor from behind the eye to far ahead, in cells.
Mesh floor_cells(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const Camera camera(r, width, height);
  const int most = std::clamp(static_cast<int>(std::sqrt(faces / 2)), 1, 8);
  const int columns = r.between(1, most), rows = r.between(1, most), back = r.between(-6, 1);
  const auto below = static_cast<float>(r.between(1, 3)) * (r.one_in(2) ? 1.0f : -1.0f);
  const auto slope = static_cast<float>(r.one_in(2) ? 0 : r.between(-1, 1)) / 4;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const auto x = static_cast<float>(i * 8 - 4 * columns), z = static_cast<float>(back + 4 * j);
      mesh.vertices.push_back(camera(x, below + slope * x, z));
    }
  }
  add_cells(r, mesh, columns, rows);
  return mesh;
}

// The hull of lattice points of the world, in front of the eye, around it or partly behind it.
Mesh hull(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const Camera camera(r, width, height);
  const int points = r.between(4, std::clamp(faces / 2, 4, 20)), nearest = r.one_in(2) ? 1 : -4;
  std::vector<std::array<float, 3>> places;
  for (int n = 0; n < points; ++n) {
    std::array<float, 3>& p = places.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<float>(k == 2 ? r.between(2 * nearest, 14) : r.between(-8, 8)) / 2;
    }
  }
  mesh.triangles = convex_hull(places);
  for (const auto& [x, y, z] : places) mesh.vertices.push_back(camera(x, y, z));
  return mesh;
}

// Triangles of the hard categories, each alone. Those of twice the size of ones that pass near centres of pixels pass
// near their corners.
Mesh soup(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const int triangles = r.between(1, std::clamp(faces, 1, 6));
  for (int n = 0; n < triangles; ++n) {
    const std::span<const Category> all = categories();
    const Category& category = all[r.below(static_cast<std::uint32_t>(all.size()))];
    const bool twice = r.one_in(2);
    std::array<Vertex, 3> t =
        twice ? category.triangle(r, (width + 1) / 2, (height + 1) / 2) : category.triangle(r, width, height);
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (twice) t[i].x *= 2, t[i].y *= 2;
      corners[i] = add(mesh, t[i]);
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

// One triangle over most of the buffer, whose edges pass corners of pixels by a few units of the last place; a second one
// continues it across an edge, sometimes.
Mesh nearly(Random& r, int width, int height, int faces) {
  Mesh mesh;
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  mesh.vertices = {{-w, -h, 0, 1}, {3 * w, -h, 0, 1}, {-w, 3 * h, 0, 1}};
  const auto x = static_cast<float>(r.between(1, width)), y = static_cast<float>(r.between(1, height));
  // An edge through (x, y) in a direction of whole numbers, its ends moved by some units.
  const auto dx = static_cast<float>(r.between(-7, 7)), dy = static_cast<float>(r.between(1, 7));
  const float back = power_of_two(r, 2, 5), ahead = power_of_two(r, 2, 5);
  mesh.vertices[1] = {x - back * dx, y - back * dy, 0, 1};
  mesh.vertices[2] = {x + ahead * dx, y + ahead * dy, 0, 1};
  const std::uint32_t moves = r.below(3);
  for (std::uint32_t n = 0; n < moves; ++n) {
    Vertex& v = mesh.vertices[1 + r.below(2)];
    float& number = r.one_in(2) ? v.x : v.y;
    number = std::nextafter(number, r.one_in(2) ? 1e9f : -1e9f);
  }
  mesh.triangles.push_back({0, 1, 2});
  if (faces > 1 && r.one_in(2)) {
    const std::uint32_t beyond = add(mesh, {2 * w, static_cast<float>(r.between(-height, 2 * height)), 0, 1});
    mesh.triangles.push_back({1, beyond, 2});
  }
  give_depth(r, mesh);
  return mesh;
}

constexpr OccluderCategory kCategories[] = {
    {"sheet", "cells on a lattice of 1 to 1/16 pixel: rims along and through corners of pixels", sheet},
    {"triangulation", "the Delaunay triangulation of lattice points", triangulation},
    {"fan", "triangles around a vertex at a corner, on a border or in the middle of a pixel", fan},
    {"city", "boxes of a lattice that share faces, edges and corners, some of them behind the eye", city},
    {"floor", "cells from behind the eye to far ahead", floor_cells},
    {"hull", "convex bodies before, around and behind the eye", hull},
    {"soup", "single triangles of all hard categories", soup},
    {"nearly", "an edge that passes a corner of a pixel by a few units of the last place", nearly},
};

// --- Damage

Vertex mean(const Vertex& a, const Vertex& b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2, (a.w + b.w) / 2};
}

// Puts the mean of an edge's ends between them, in one face only: a T-junction, unless the other face gets one, too.
void split_edge(Mesh& mesh, std::size_t face, std::size_t edge, std::uint32_t middle) {
  Indices& t = mesh.triangles[face];
  const Indices other = {middle, t[(edge + 1) % 3], t[(edge + 2) % 3]};
  t[(edge + 1) % 3] = middle;
  mesh.triangles.push_back(other);
}

// Gives one corner of a face a copy of its vertex.
Vertex& own_corner(Mesh& mesh, std::size_t face, std::size_t corner) {
  const std::uint32_t copy = add(mesh, Vertex(mesh.vertices[mesh.triangles[face][corner]]));
  mesh.triangles[face][corner] = copy;
  return mesh.vertices[copy];
}

void nudge(Random& r, Vertex& v) {
  float* const numbers[] = {&v.x, &v.y, &v.w};
  float& number = *numbers[r.below(3)];
  number = std::nextafter(number, r.one_in(2) ? 1e9f : -1e9f);
}

void damage(Random& r, Mesh& mesh, int width, int height) {
  if (mesh.triangles.empty()) return;
  const std::size_t face = r.below(static_cast<std::uint32_t>(mesh.triangles.size())), corner = r.below(3);
  const Indices t = mesh.triangles[face];
  const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
  switch (r.below(13)) {
    case 0:  // a hole
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(face));
      break;
    case 1:  // twice
      mesh.triangles.push_back(t);
      break;
    case 2:  // the other side
      mesh.triangles[face] = {t[0], t[2], t[1]};
      break;
    case 3:  // both sides
      mesh.triangles.push_back({t[0], t[2], t[1]});
      break;
    case 4: {  // split vertices: equal ones of other numbers
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) own_corner(mesh, f, i);
      }
      break;
    }
    case 5: {  // a T-junction
      const std::uint32_t middle = add(mesh, mean(mesh.vertices[a], mesh.vertices[b]));
      split_edge(mesh, face, corner, middle);
      break;
    }
    case 6: {  // a degenerate face that closes an edge: its third vertex is one of the edge's, or lies on it
      const std::uint32_t third = r.one_in(2) ? add(mesh, mean(mesh.vertices[a], mesh.vertices[b])) : a;
      mesh.triangles.push_back({b, a, third});
      break;
    }
    case 7:  // a crack of a unit of the last place
      nudge(r, own_corner(mesh, face, corner));
      break;
    case 8: {  // one more face at an edge
      const auto x = static_cast<float>(r.between(-2, width + 2)), y = static_cast<float>(r.between(-2, height + 2));
      const std::uint32_t third = add(mesh, {x, y, static_cast<float>(r.unit()), 1});
      if (r.one_in(2)) {
        mesh.triangles.push_back({a, b, third});
      } else {
        mesh.triangles.push_back({b, a, third});
      }
      break;
    }
    case 9: {  // the same place by other numbers
      Vertex& v = own_corner(mesh, face, corner);
      v = {v.x * 2, v.y * 2, v.z * 2, v.w * 2};
      break;
    }
    case 10: {  // a face that is dropped
      Vertex& v = own_corner(mesh, face, corner);
      (r.one_in(2) ? v.z : v.x) = std::numeric_limits<float>::quiet_NaN();
      break;
    }
    case 11: {  // the same X and Y by another W
      Vertex& v = own_corner(mesh, face, corner);
      v.w = r.one_in(2) ? -v.w : v.w * 2;
      break;
    }
    default:  // other depths at an edge
      own_corner(mesh, face, corner).z += static_cast<float>(r.between(-4, 4)) / 8;
      break;
  }
}

}  // namespace

std::span<const OccluderCategory> occluder_categories() {
  return kCategories;
}

corpus::Scene occluder_scene(const OccluderCategory& category, std::uint64_t seed, int width, int height,
                             int max_faces) {
  Random r(seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(&category - kCategories));
  corpus::Scene scene;
  scene.width = width, scene.height = height;
  scene.depth_test = r.one_in(3) ? DepthTest::greater : DepthTest::less;
  const int draws = r.one_in(3) ? r.between(2, 3) : 1;
  for (int n = 0; n < draws; ++n) {
    const OccluderCategory& own = n == 0 ? category : kCategories[r.below(std::size(kCategories))];
    Mesh mesh = own.mesh(r, width, height, std::max(1, max_faces / draws));
    for (int damages = r.one_in(3) ? 0 : r.between(1, 4); damages > 0; --damages) damage(r, mesh, width, height);
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    const std::uint32_t rule = r.below(9);
    draw.fill_rule = static_cast<FillRule>(rule);  // all but open
    draw.front_face = r.one_in(2) ? FrontFace::clockwise : FrontFace::counter_clockwise;
    draw.cull = static_cast<Cull>(r.below(3));
    draw.depth_mode = r.one_in(2) ? DepthMode::none : r.one_in(2) ? DepthMode::clip : DepthMode::clamp;
    for (const Vertex& v : mesh.vertices) {
      corpus::SceneVertex& vertex = draw.vertices.emplace_back();
      vertex = {v.x, v.y, v.z, v.w, {}};
      if (r.one_in(16) && v.x == 0) vertex.x = -0.0f;
    }
    for (const Indices& t : mesh.triangles) draw.triangles.push_back({t, {}});
  }
  return scene;
}

namespace {

bool finite(const corpus::SceneVertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

}  // namespace

std::vector<std::vector<std::array<float, 3>>> positions_of(const corpus::Scene& scene, std::uint64_t seed) {
  Random r(seed);
  std::vector<std::vector<std::array<float, 3>>> result;
  for (const corpus::SceneDraw& draw : scene.draws) {
    auto& positions = result.emplace_back();
    const bool apart = r.one_in(3);  // some vertices of equal X, Y, W are not one
    for (const corpus::SceneVertex& v : draw.vertices) {
      positions.push_back({v.x, v.y, v.w});
      if (!finite(v) && r.one_in(2)) positions.back() = {1, 2, 3};
      if (!apart || !r.one_in(6)) continue;
      positions.back()[r.below(3)] = r.one_in(3) ? std::numeric_limits<float>::quiet_NaN() : 1000.0f;
    }
  }
  // What became one by chance has to be equal.
  for (std::size_t n = 0; n < result.size(); ++n) {
    const std::vector<corpus::SceneVertex>& vertices = scene.draws[n].vertices;
    for (std::size_t a = 0; a < vertices.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const corpus::SceneVertex &v = vertices[a], &u = vertices[b];
        if (result[n][a] != result[n][b] || !finite(v) || !finite(u)) continue;
        if (v.x != u.x || v.y != u.y || v.w != u.w) result[n][a] = {-1000.0f - static_cast<float>(a), 0, 0};
      }
    }
  }
  return result;
}

}  // namespace surefill::properties
