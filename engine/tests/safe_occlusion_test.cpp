// SPDX-License-Identifier: Apache-2.0
//
// Safe occlusion buffers against their definition (O4 to O6), worked out square by square in integers with other formulas,
// and a small part of what they exist for (T7): what is hidden changes nothing in larger pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "surefill/occlusion.hpp"

namespace surefill {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
using Int = std::int64_t;
using Homogeneous = std::array<Int, 3>;  // X, Y, W, all in 1/2

Homogeneous doubled(const Vertex& v) {
  return {static_cast<Int>(2 * v.x), static_cast<Int>(2 * v.y), static_cast<Int>(2 * v.w)};
}
Int determinant(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}
int sign_of(Int value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// M7's S against a closed square: the l_0, l_1 >= 0 for which the four sides' linear functions are not negative are a
// cone, and if W is positive in it, it is on an extreme ray.
bool edge_meets(const Homogeneous& m0, const Homogeneous& m1, int x, int y) {
  const auto sides = [&](const Homogeneous& m) {
    return std::array<Int, 5>{m[0] - x * m[2], (x + 1) * m[2] - m[0], m[1] - y * m[2], (y + 1) * m[2] - m[1], m[2]};
  };
  const std::array<Int, 5> f0 = sides(m0), f1 = sides(m1);
  const auto inside = [&](Int l0, Int l1) {
    if (l0 < 0 || l1 < 0) l0 = -l0, l1 = -l1;
    if (l0 < 0 || l1 < 0) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      if (l0 * f0[i] + l1 * f1[i] < 0) return false;
    }
    return l0 * f0[4] + l1 * f1[4] > 0;
  };
  if (inside(1, 0) || inside(0, 1)) return true;
  for (std::size_t i = 0; i < 4; ++i) {
    if (inside(f1[i], -f0[i])) return true;
  }
  return false;
}

struct Mesh {
  std::vector<float> positions;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  std::uint32_t add(Vertex v, float place) {
    vertices.push_back(v);
    positions.insert(positions.end(), {v.x, v.y, v.w + 64 * place});
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
};

// O4 of one occluder.
class Definition {
 public:
  Definition(const Mesh& mesh, const DrawState& state, float sign) : mesh_(mesh), state_(state), sign_(sign) {
    const std::size_t triangles = mesh.indices.size() / 3;
    for (std::size_t t = 0; t < triangles; ++t) {
      const Int d = determinant(corner(t, 0), corner(t, 1), corner(t, 2));
      const int facing = sign_of(d) * (state.front_face == FrontFace::clockwise ? 1 : -1);
      const bool culled = facing == 0 || state.cull == (facing > 0 ? Cull::front : Cull::back);
      side_.push_back(culled ? 0 : facing), occluder_.push_back(t);
    }
    for (const int side : {1, -1}) link(side);
  }

  // The key that the square gets: +inf where nothing fills it.
  float key(int x, int y) const {
    std::map<std::size_t, float> farthest;
    std::map<std::size_t, bool> covered, broken;
    for (std::size_t t = 0; t < side_.size(); ++t) {
      if (side_[t] == 0) continue;
      const std::size_t occluder = occluder_[t];
      for (std::size_t k = 0; k < 3; ++k) {
        if (rim_[3 * t + k] && edge_meets(corner(t, k), corner(t, (k + 1) % 3), x, y)) broken[occluder] = true;
      }
      covered[occluder] |= covers_centre(t, x, y);
      if (!meets(t, x, y)) continue;
      float key;
      if (!range_end(t, x, y, &key)) broken[occluder] = true;
      const auto [at, is_new] = farthest.emplace(occluder, key);
      if (!is_new) at->second = std::max(at->second, key);
    }
    float nearest = kInfinity;
    for (const auto& [occluder, z] : farthest) {
      if (covered[occluder] && !broken[occluder]) nearest = std::min(nearest, z);
    }
    return nearest;
  }

 private:
  const Vertex& vertex(std::size_t t, std::size_t k) const { return mesh_.vertices[mesh_.indices[3 * t + k]]; }
  Homogeneous corner(std::size_t t, std::size_t k) const { return doubled(vertex(t, k)); }
  std::array<float, 3> place(std::size_t t, std::size_t k) const {
    const float* p = &mesh_.positions[3 * mesh_.indices[3 * t + k]];
    return {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
  }

  void link(int side) {
    rim_.resize(3 * side_.size());
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, std::vector<std::size_t>> edges;
    for (std::size_t t = 0; t < side_.size(); ++t) {
      for (std::size_t k = 0; side_[t] == side && k < 3; ++k)
        edges[{place(t, k), place(t, (k + 1) % 3)}].push_back(3 * t + k);
    }
    for (const auto& [edge, halves] : edges) {
      const auto opposite = edges.find({edge.second, edge.first});
      const bool inner = opposite != edges.end() && opposite->second.size() == halves.size();
      for (const std::size_t half : halves) {
        rim_[half] = !inner;
        if (!inner) continue;
        for (const auto* list : std::array<const std::vector<std::size_t>*, 2>{&halves, &opposite->second}) {
          for (const std::size_t other : *list) {
            const std::size_t from = occluder_[half / 3], to = occluder_[other / 3];
            std::replace(occluder_.begin(), occluder_.end(), from, to);
          }
        }
      }
    }
  }

  // E_i at (px, py) in halves, times D's sign.
  Int edge(std::size_t t, std::size_t i, Int px2, Int py2) const {
    const Homogeneous p{px2, py2, 2};
    return determinant(corner(t, (i + 1) % 3), corner(t, (i + 2) % 3), p) * sign_of(d(t));
  }
  Int d(std::size_t t) const { return determinant(corner(t, 0), corner(t, 1), corner(t, 2)); }

  bool covers_centre(std::size_t t, int x, int y) const {
    for (std::size_t i = 0; i < 3; ++i) {
      Int e = edge(t, i, 2 * x + 1, 2 * y + 1);
      const Int at_zero = edge(t, i, 0, 0);
      if (e == 0) e = edge(t, i, 2, 0) - at_zero;
      if (e == 0) e = edge(t, i, 0, 2) - at_zero;
      if (e < 0) return false;
    }
    return true;
  }

  bool meets(std::size_t t, int x, int y) const {
    for (int corner_number = 0; corner_number < 4; ++corner_number) {
      bool inside = true;
      for (std::size_t i = 0; i < 3; ++i)
        inside &= edge(t, i, 2 * (x + corner_number % 2), 2 * (y + corner_number / 2)) >= 0;
      if (inside) return true;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (edge_meets(corner(t, k), corner(t, (k + 1) % 3), x, y)) return true;
    }
    return false;
  }

  // The largest key of the range, rounded; false where depth clipping forbids the range. Numerators and denominators, all
  // doubled alike,
  // are below 2^50, and a float of few bits times them is exact in long double.
  bool range_end(std::size_t t, int x, int y, float* key) const {
    struct Ratio {
      long double n, d;  // d > 0
    };
    const auto less = [](const Ratio& a, const Ratio& b) { return a.n * b.d < b.n * a.d; };
    std::vector<Ratio> corners, vertices;
    for (int number = 0; number < 4; ++number) {
      long double sum = 0;
      for (std::size_t i = 0; i < 3; ++i)
        sum += static_cast<long double>(vertex(t, i).z) * edge(t, i, 2 * (x + number % 2), 2 * (y + number / 2));
      corners.push_back({sign_ * sum, static_cast<long double>(std::llabs(d(t)))});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (vertex(t, i).w > 0) vertices.push_back({sign_ * static_cast<long double>(vertex(t, i).z), vertex(t, i).w});
    }
    Ratio low = *std::min_element(corners.begin(), corners.end(), less);
    Ratio high = *std::max_element(corners.begin(), corners.end(), less);
    if (vertices.size() == 3) {
      low = std::max(low, *std::min_element(vertices.begin(), vertices.end(), less), less);
      high = std::min(high, *std::max_element(vertices.begin(), vertices.end(), less), less);
    }
    const long double unit_low = sign_ > 0 ? 0 : -1, unit_high = unit_low + 1;
    float rounded = static_cast<float>(high.n / high.d);
    while (rounded * high.d < high.n) rounded = std::nextafter(rounded, kInfinity);
    while (std::nextafter(rounded, -kInfinity) * high.d >= high.n) rounded = std::nextafter(rounded, -kInfinity);
    if (state_.depth_mode == DepthMode::clamp)
      rounded = std::clamp(rounded, static_cast<float>(unit_low), static_cast<float>(unit_high));
    *key = rounded;
    if (state_.depth_mode != DepthMode::clip) return true;
    return low.n >= unit_low * low.d && high.n <= unit_high * high.d;
  }

  const Mesh& mesh_;
  const DrawState& state_;
  float sign_;
  std::vector<int> side_;
  std::vector<std::size_t> occluder_;
  std::vector<char> rim_;
};

class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool one_in(int n) { return integer(1, n) == 1; }

  // A vertex near half-pixel place (x, y): all numbers are few halves.
  Vertex vertex(int x, int y, bool behind) {
    constexpr float kW[] = {1, 1, 2, 4, 0.5f};
    const float w = behind && one_in(4) ? static_cast<float>(integer(-2, 0)) : kW[integer(0, 4)];
    const float s = w > 0 ? w : 1;
    const auto px = static_cast<float>(x), py = static_cast<float>(y);
    return {std::floor(px * s) / 2, std::floor(py * s) / 2, static_cast<float>(integer(-2, 20)) / 16 * s, w};
  }

  // Sheets of a lattice with holes, split and moved vertices, loose triangles, triangles twice.
  Mesh mesh(int width, int height) {
    Mesh mesh;
    const bool behind = one_in(4);
    const int sheets = integer(1, 3);
    for (int s = 0; s < sheets; ++s) {
      const int columns = integer(1, 4), rows = integer(1, 4), step = integer(2, 14);
      const int x0 = integer(-6, 2 * width), y0 = integer(-6, 2 * height);
      const int skew = integer(-2, 2), holes = one_in(2) ? 100 : integer(3, 12);
      const auto place = static_cast<float>(one_in(5) ? 0 : s);
      std::vector<std::uint32_t> lattice;
      for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i)
          lattice.push_back(mesh.add(vertex(x0 + step * i + skew * j, y0 + step * j + integer(0, 1), behind), place));
      }
      const auto at = [&](int i, int j) {
        const std::uint32_t v = lattice[static_cast<std::size_t>(j * (columns + 1) + i)];
        if (!one_in(4)) return v;
        Vertex split = mesh.vertices[v];  // split: at the same place, with another depth
        split.z = static_cast<float>(integer(-2, 20)) / 16;
        return mesh.add(split, place);
      };
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          if (one_in(holes)) continue;
          mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
          mesh.indices.insert(mesh.indices.end(), {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
          if (one_in(20)) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
          if (one_in(20)) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
        }
      }
    }
    return mesh;
  }

 private:
  std::mt19937_64 random_;
};

DrawState random_state(Source& source) {
  DrawState state;
  state.fill_rule = static_cast<FillRule>(source.integer(0, 8));
  state.front_face = static_cast<FrontFace>(source.integer(0, 1));
  state.cull = static_cast<Cull>(source.one_in(2) ? 0 : source.integer(0, 2));
  state.depth_mode = static_cast<DepthMode>(source.integer(0, 2));
  return state;
}

TEST(SafeOcclusion, DepthIsTheDefinition) {
  std::size_t filled = 0, empty = 0;
  SafeOcclusionBuffer buffer;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Source source(seed);
    const int width = source.integer(1, 24), height = source.integer(1, 20);
    const DepthTest test = seed % 2 == 0 ? DepthTest::less : DepthTest::greater;
    const float sign = test == DepthTest::less ? 1.0f : -1.0f;
    ASSERT_EQ(buffer.resize(width, height, test), Status::ok);
    std::vector<float> keys(static_cast<std::size_t>(width * height), kInfinity);
    for (int draws = source.integer(1, 2); draws > 0; --draws) {
      const Mesh mesh = source.mesh(width, height);
      Occluder occluder;
      occluder.state() = random_state(source);
      OccluderMesh prepared;
      ASSERT_EQ(prepared.prepare(mesh.positions, mesh.indices), Status::ok);
      occluder.mesh = &prepared, occluder.vertices = mesh.vertices;
      Options options;
      options.threads = source.integer(1, 3);
      ASSERT_EQ(buffer.draw({&occluder, 1}, options), Status::ok);
      const Definition definition(mesh, occluder.state(), sign);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          float& key = keys[static_cast<std::size_t>(y * width + x)];
          key = std::min(key, definition.key(x, y));
        }
      }
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const float z = buffer.depth()[i];
      ASSERT_EQ(z, sign * keys[i]) << "seed " << seed << ", pixel " << i % static_cast<std::size_t>(width) << ", "
                                   << i / static_cast<std::size_t>(width);
      ASSERT_FALSE(z == 0 && std::signbit(z));
      ++(keys[i] < kInfinity ? filled : empty);
    }
  }
  EXPECT_GT(filled, 10000u);
  EXPECT_GT(empty, 10000u);
}

// A quadrilateral over all of a target and more, at one depth, and its mesh.
struct Wall {
  std::array<Vertex, 4> vertices;
  OccluderMesh mesh;
  Occluder occluder;

  explicit Wall(float z, float size = 64) {
    vertices = {{{-size, -size, z, 1}, {size, -size, z, 1}, {-size, size, z, 1}, {size, size, z, 1}}};
    const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
    EXPECT_EQ(mesh.prepare({&vertices[0].x, 16}, indices, 4), Status::ok);
    occluder.mesh = &mesh, occluder.vertices = vertices;
  }
  Wall(const Wall&) = delete;
};

Occlusion answer_of(const SafeOcclusionBuffer& buffer, const OcclusionRectangle& rectangle) {
  auto answer = static_cast<Occlusion>(77);
  EXPECT_EQ(buffer.query({&rectangle, 1}, {&answer, 1}), Status::ok);
  return answer;
}

// O5: a rectangle has the pixels whose half-open square it meets, though it meets no centre.
TEST(SafeOcclusion, RectanglesHaveWholeSquares) {
  SafeOcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(8, 8), Status::ok);
  Wall wall(0.5f, 3);  // fills the pixels 0 and 1 each way
  ASSERT_EQ(buffer.draw({&wall.occluder, 1}), Status::ok);
  EXPECT_EQ(answer_of(buffer, {0, 0, 1.9375f, 1.9375f, 1}), Occlusion::hidden);
  EXPECT_EQ(answer_of(buffer, {0, 0, 2, 1, 1}), Occlusion::visible);  // the pixel 2 begins at 2
  EXPECT_EQ(answer_of(buffer, {1.75f, 1.75f, 1.75f, 1.75f, 1}), Occlusion::hidden);
  EXPECT_EQ(answer_of(buffer, {-3, 0, -0.0625f, 1, 1}), Occlusion::outside);
  EXPECT_EQ(answer_of(buffer, {-3, 0, 0, 1, 1}), Occlusion::hidden);
  EXPECT_EQ(answer_of(buffer, {8, 0, 9, 1, 1}), Occlusion::outside);
  EXPECT_EQ(answer_of(buffer, {1, 1, 0, 1, 1}), Occlusion::outside);
}

// O6, of both buffers.
TEST(SafeOcclusion, EqualIsVisibleIfAsked) {
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    const float farther = test == DepthTest::less ? 0.75f : 0.25f;
    SafeOcclusionBuffer safe;
    OcclusionBuffer exact;
    ASSERT_EQ(safe.resize(9, 9, test), Status::ok);
    ASSERT_EQ(exact.resize(9, 9, test), Status::ok);
    Wall wall(0.5f);
    const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
    Draw draw;
    draw.vertices = wall.vertices, draw.indices = indices;
    ASSERT_EQ(safe.draw({&wall.occluder, 1}), Status::ok);
    ASSERT_EQ(exact.draw({&draw, 1}), Status::ok);
    const OcclusionRectangle rectangles[] = {{1, 1, 8, 8, 0.5f}, {1, 1, 8, 8, farther}};
    Occlusion answers[2];
    for (const bool equal : {false, true}) {
      safe.equal_is_visible(equal), exact.equal_is_visible(equal);
      ASSERT_EQ(safe.query(rectangles, answers), Status::ok);
      EXPECT_EQ(answers[0], equal ? Occlusion::visible : Occlusion::hidden);
      EXPECT_EQ(answers[1], Occlusion::hidden);
      ASSERT_EQ(exact.query(rectangles, answers), Status::ok);
      EXPECT_EQ(answers[0], equal ? Occlusion::visible : Occlusion::hidden);
      EXPECT_EQ(answers[1], Occlusion::hidden);
    }
    SafeOcclusionBuffer moved(std::move(safe));
    EXPECT_TRUE(moved.equal_is_visible());
    ASSERT_EQ(moved.resize(5, 5, test), Status::ok);
    EXPECT_TRUE(moved.equal_is_visible());
    EXPECT_EQ(safe.width(), 0);  // NOLINT: what is left
  }
}

TEST(SafeOcclusion, WrongCallsWriteNothing) {
  SafeOcclusionBuffer buffer;
  Wall wall(0.5f);
  EXPECT_EQ(buffer.draw({&wall.occluder, 1}), Status::target_size);
  EXPECT_EQ(buffer.resize(0, 1), Status::target_size);
  EXPECT_EQ(buffer.resize(4, 4, DepthTest::less_equal), Status::target_depth_test);
  ASSERT_EQ(buffer.resize(4, 4), Status::ok);
  const auto refusal = [&](auto change) {
    Occluder occluder = wall.occluder;
    change(occluder);
    const Occluder list[] = {wall.occluder, occluder};
    return buffer.draw(list);
  };
  EXPECT_EQ(refusal([](Occluder& o) { o.mesh = nullptr; }), Status::occluder_mesh);
  EXPECT_EQ(refusal([](Occluder& o) { o.vertices = o.vertices.first(3); }), Status::draw_vertices);
  EXPECT_EQ(refusal([](Occluder& o) { o.primitive = Primitive::lines; }), Status::draw_primitive);
  EXPECT_EQ(refusal([](Occluder& o) { o.fill_rule = FillRule::open; }), Status::draw_fill_rule);
  EXPECT_EQ(refusal([](Occluder& o) { o.front_face = static_cast<FrontFace>(2); }), Status::draw_front_face);
  EXPECT_EQ(refusal([](Occluder& o) { o.cull = static_cast<Cull>(3); }), Status::draw_cull);
  EXPECT_EQ(refusal([](Occluder& o) { o.depth_mode = static_cast<DepthMode>(3); }), Status::draw_depth_mode);
  EXPECT_EQ(refusal([](Occluder& o) { o.depth_write = false; }), Status::draw_depth_write);
  EXPECT_EQ(refusal([](Occluder& o) { o.conservative = Conservative::over; }), Status::draw_conservative);
  EXPECT_EQ(refusal([](Occluder& o) { o.scissor = Scissor{0, 0, 4, 4}; }), Status::draw_scissor);
  EXPECT_EQ(refusal([](Occluder& o) { o.grid = Grid{}; }), Status::draw_grid);
  EXPECT_EQ(refusal([](Occluder& o) { o.depth_bias = DepthBias{}; }), Status::draw_depth_bias);
  EXPECT_EQ(buffer.draw({static_cast<const Occluder*>(nullptr), 1}), Status::draws);
  Options options;
  options.threads = 0;
  EXPECT_EQ(buffer.draw({&wall.occluder, 1}, options), Status::options_threads);
  options.threads = 1, options.path = static_cast<Path>(2);
  EXPECT_EQ(buffer.draw({&wall.occluder, 1}, options), Status::options_path);
  const auto* inside = reinterpret_cast<const Vertex*>(buffer.depth().data());
  EXPECT_EQ(refusal([&](Occluder& o) { o.vertices = {inside, 4}; }), Status::target_overlap);
  for (const float z : buffer.depth()) ASSERT_EQ(z, kInfinity);

  // A culling box is ignored, `closed` is none of what is refused.
  Occluder allowed = wall.occluder;
  allowed.culling_box.emplace(), allowed.fill_rule = FillRule::closed;
  ASSERT_EQ(buffer.draw({&allowed, 1}), Status::ok);
  for (const float z : buffer.depth()) ASSERT_EQ(z, 0.5f);
}

TEST(SafeOcclusion, MeshesAreChecked) {
  OccluderMesh mesh;
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 9};
  const std::uint32_t indices[] = {0, 1, 2, 3};
  const std::span<const std::uint32_t> triangle(indices, 3);
  EXPECT_EQ(mesh.prepare({positions, 9}, triangle), Status::ok);
  EXPECT_EQ(mesh.vertices(), 3u);
  EXPECT_EQ(mesh.triangles(), 1u);
  EXPECT_EQ(mesh.prepare({positions, 10}, triangle), Status::occluder_positions);
  EXPECT_EQ(mesh.prepare({positions, 9}, triangle, 2), Status::occluder_positions);
  EXPECT_EQ(mesh.prepare({static_cast<const float*>(nullptr), 9}, triangle), Status::occluder_positions);
  EXPECT_EQ(mesh.prepare({positions, 9}, indices), Status::draw_indices);
  EXPECT_EQ(mesh.prepare({positions, 9}, {static_cast<const std::uint32_t*>(nullptr), 3}), Status::draw_indices);
  EXPECT_EQ(mesh.prepare({positions, 6}, triangle), Status::draw_index_out_of_range);
  EXPECT_EQ(mesh.vertices(), 3u);  // as it was
  EXPECT_EQ(mesh.prepare({positions, 7}, {}, 4), Status::ok);
  EXPECT_EQ(mesh.vertices(), 2u);
  EXPECT_EQ(mesh.prepare({}, {}), Status::ok);
  EXPECT_EQ(mesh.vertices(), 0u);
}

// Vertices that are one have one place on the screen; what is not finite is no vertex of a face, and nobody's business.
TEST(SafeOcclusion, VerticesOfOnePlaceAgree) {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, -0.0f, 0, 0, 1, 0, 0, NAN, 0, 0, NAN, 0, 0};
  const std::uint32_t indices[] = {0, 1, 2, 3, 2, 4};
  OccluderMesh mesh;
  ASSERT_EQ(mesh.prepare(positions, indices), Status::ok);
  std::vector<Vertex> vertices = {{0, 0, 0, 1}, {8, 0, 0, 1}, {0, 8, 0, 1}, {0, 0, 0.5f, 1},
                                  {8, 0, 1, 1}, {1, 2, 3, 1}, {4, 5, 6, 1}};
  Occluder occluder;
  occluder.mesh = &mesh, occluder.vertices = vertices;
  SafeOcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(4, 4), Status::ok);
  EXPECT_EQ(buffer.draw({&occluder, 1}), Status::ok);
  vertices[3].x = -0.0f;
  EXPECT_EQ(buffer.draw({&occluder, 1}), Status::ok);
  vertices[3].x = 1;
  EXPECT_EQ(buffer.draw({&occluder, 1}), Status::occluder_vertices);
  vertices[3].z = NAN;
  EXPECT_EQ(buffer.draw({&occluder, 1}), Status::ok);
  vertices[4].w = 2;
  EXPECT_EQ(buffer.draw({&occluder, 1}), Status::occluder_vertices);
}

// What T7 forbids and a buffer of centres does: at half the size it cannot see a gap between its centres.
TEST(SafeOcclusion, SeesThroughGapsBetweenCentres) {
  OccluderMesh mesh;
  const Vertex vertices[] = {{-9, -9, 0.5f, 1},     {3.625f, -9, 0.5f, 1}, {-9, 30, 0.5f, 1},     {3.625f, 30, 0.5f, 1},
                             {3.875f, -9, 0.5f, 1}, {30, -9, 0.5f, 1},     {3.875f, 30, 0.5f, 1}, {30, 30, 0.5f, 1}};
  const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7};
  ASSERT_EQ(mesh.prepare({&vertices[0].x, 32}, indices, 4), Status::ok);
  Occluder occluder;
  occluder.mesh = &mesh, occluder.vertices = vertices;
  SafeOcclusionBuffer safe;
  OcclusionBuffer exact;
  ASSERT_EQ(safe.resize(8, 8), Status::ok);
  ASSERT_EQ(exact.resize(8, 8), Status::ok);
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  ASSERT_EQ(safe.draw({&occluder, 1}), Status::ok);
  ASSERT_EQ(exact.draw({&draw, 1}), Status::ok);
  const OcclusionRectangle behind{2, 2, 6, 6, 0.75f};
  Occlusion answer;
  ASSERT_EQ(exact.query({&behind, 1}, {&answer, 1}), Status::ok);
  EXPECT_EQ(answer, Occlusion::hidden);
  EXPECT_EQ(answer_of(safe, behind), Occlusion::visible);
  EXPECT_EQ(answer_of(safe, {4, 2, 6, 6, 0.75f}), Occlusion::hidden);
}

// Where T7 does not speak: with a factor of 3 to_pixel rounds an edge to one side of a pixel's corner in the buffer, and to
// the other side in the picture, and there a sample is seen that the buffer has as hidden. With a factor of 4 it does not.
TEST(SafeOcclusion, OtherFactorsThanPowersOfTwoAreNotPromised) {
  constexpr float kW = 1.2f, kLeft = -kW / 4;
  const ClipVertex wall[] = {{kLeft, -2, 0.6f, kW}, {2, -2, 0.6f, kW}, {kLeft, 2, 0.6f, kW}, {2, 2, 0.6f, kW}};
  const ClipVertex box[] = {{-0.25f, -0.25f, 0.75f, 1}, {0, -0.25f, 0.75f, 1},      {-0.25f, 0.25f, 0.75f, 1},
                            {0, 0.25f, 0.75f, 1},       {-0.25f, -0.25f, 0.75f, 1}, {0, -0.25f, 0.75f, 1},
                            {-0.25f, 0.25f, 0.75f, 1},  {0, 0.25f, 0.75f, 1}};
  const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
  const auto project = [](std::span<const ClipVertex> clip, float width, float height) {
    std::vector<Vertex> vertices(clip.size());
    Viewport viewport;
    viewport.width = width, viewport.height = height;
    EXPECT_EQ(to_pixel(viewport, clip, vertices), Status::ok);
    return vertices;
  };
  OccluderMesh mesh;
  ASSERT_EQ(mesh.prepare({&wall[0].x, 16}, indices, 4), Status::ok);
  const auto answer = [&](int width, int height) {
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const std::vector<Vertex> vertices = project(wall, w, h), corners = project(box, w, h);
    SafeOcclusionBuffer buffer;
    EXPECT_EQ(buffer.resize(width, height), Status::ok);
    Occluder occluder;
    occluder.mesh = &mesh, occluder.vertices = vertices;
    EXPECT_EQ(buffer.draw({&occluder, 1}), Status::ok);
    OcclusionBox asked;
    std::copy(corners.begin(), corners.end(), asked.corners);
    auto said = Occlusion::outside;
    EXPECT_EQ(buffer.query({&asked, 1}, {&said, 1}), Status::ok);
    return said;
  };
  EXPECT_EQ(answer(480, 270), Occlusion::visible);
  EXPECT_EQ(answer(640, 360), Occlusion::hidden);

  const std::vector<Vertex> vertices = project(wall, 1920, 1080), corners = project(box, 1920, 1080);
  std::vector<std::uint32_t> index(8 * 8 * 16);
  Target target;
  target.width = target.height = 8, target.samples = 16, target.index = index;
  target.origin = {716, 536};
  Draw draws[2];
  draws[0].vertices = vertices, draws[1].vertices = corners;
  draws[0].indices = draws[1].indices = indices;
  draws[1].first_index = 2;
  ASSERT_EQ(render(target, draws), Status::ok);
  const std::size_t at_its_left_border = 12;                    // the sample at (0, 8/16)
  EXPECT_GE(index[(8 * 4 + 4) * 16 + at_its_left_border], 2u);  // of pixel 720, three times pixel 240
}

}  // namespace
}  // namespace surefill
