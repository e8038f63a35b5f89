// SPDX-License-Identifier: Apache-2.0
//
// Points and lines: both oracles on random frames, of all categories that are hard; what the page says of one point or
// line (M7, I6, I7), in rationals; and relations between images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

#include "oracle/clipped_polygon.hpp"
#include "oracle/oracle.hpp"
#include "oracle/points_lines.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::properties {
namespace {

using corpus::Frame;
using corpus::Image;
using corpus::Scene;
using oracle::clipped::exact;
using oracle::clipped::nearest_float;
using oracle::clipped::Rational;
using oracle::clipped::Vector;

#ifdef SUREFILL_CASES_SHARE
constexpr int kShare = SUREFILL_CASES_SHARE;
#else
constexpr int kShare = 1;
#endif

std::string text(const Comparison& comparison, const Scene& scene) {
  std::string result;
  for (const Difference& difference : comparison.first) result += describe(difference, scene.samples) + '\n';
  return result + corpus::write_scene(scene);
}

// visit(scene) for `seeds` scenes of each category.
template <typename Visit>
void for_each_scene(std::uint64_t first_seed, int seeds, int max_size, int max_primitives, const Visit& visit) {
  for (const LineCategory& category : line_categories()) {
    for (int n = 0; n < (seeds + kShare - 1) / kShare; ++n) {
      visit(lines_scene(category, first_seed + static_cast<std::uint64_t>(n), max_size, max_primitives));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(LinesAgree, Scenes) {
  std::uint64_t covered = 0, lines = 0, points = 0, rays = 0, values = 0;
  for_each_scene(0, 200, 9, 6, [&](const Scene& scene) {
    const Comparison comparison = compare(scene, oracle_renderer(), clipped_oracle_renderer());
    ASSERT_EQ(comparison.differences, 0u) << text(comparison, scene);
    values += comparison.values;
    Frame frame(scene);
    oracle::render(frame.target(), frame.draws());
    for (const std::uint32_t count : frame.image().count) covered += count;
    for (const Draw& draw : frame.draws()) {
      lines += draw.primitive == Primitive::lines, points += draw.primitive == Primitive::points;
      for (std::size_t i = 0; draw.primitive == Primitive::lines && i < draw.indices.size(); i += 2) {
        rays += (draw.vertices[draw.indices[i]].w > 0) != (draw.vertices[draw.indices[i + 1]].w > 0);
      }
    }
  });
  if (kShare != 1) return;
  EXPECT_GT(covered, 40'000u);
  EXPECT_GT(lines, 2'000u);
  EXPECT_GT(points, 1'000u);
  EXPECT_GT(rays, 400u);
  RecordProperty("values", std::to_string(values));
}

TEST(LinesAgree, LargerScenes) {
  for_each_scene(5'000, 4, 70, 12, [](const Scene& scene) {
    const Comparison comparison = compare(scene, oracle_renderer(), clipped_oracle_renderer());
    ASSERT_EQ(comparison.differences, 0u) << text(comparison, scene);
  });
}

// The image does not depend on how many threads draw it.
TEST(LinesAgree, Threads) {
  const auto with_threads = [](auto render) {
    return [render](const Target& target, std::span<const Draw> draws) {
      render(target, draws, 3);
      return Status::ok;
    };
  };
  for_each_scene(6'000, 10, 12, 8, [&](const Scene& scene) {
    for (const Renderer& threaded :
         {Renderer(with_threads(oracle::render)), Renderer(with_threads(oracle::clipped::render))}) {
      const Comparison comparison = compare(scene, oracle_renderer(), threaded);
      ASSERT_EQ(comparison.differences, 0u) << text(comparison, scene);
    }
  });
}

// --- What the page says of one line, word for word.

struct Screen {
  Rational x, y;
};
Screen seen(const Vector& m) {
  return {m.x / m.w, m.y / m.w};
}

// S, from one end in a direction: a ray, or as far as the direction reaches.
struct Seen {
  Screen end, direction;
  bool ray = false;

  static std::optional<Seen> make(const Vector& m0, const Vector& m1) {
    if (sgn(m0.w) <= 0 && sgn(m1.w) <= 0) return std::nullopt;
    Seen s;
    const bool both = sgn(m0.w) > 0 && sgn(m1.w) > 0;
    const Vector &from = sgn(m0.w) > 0 ? m0 : m1, &other = sgn(m0.w) > 0 ? m1 : m0;
    s.end = seen(from);
    s.ray = !both;
    Screen next;
    if (both) {
      next = seen(other);
    } else {
      // from + f other is in front for this f, and so another point of S.
      const Rational f = from.w / (2 * (abs(other.w) + 1));
      next = seen({from.x + f * other.x, from.y + f * other.y, from.w + f * other.w});
    }
    s.direction = {next.x - s.end.x, next.y - s.end.y};
    if (s.direction.x == 0 && s.direction.y == 0) return std::nullopt;
    return s;
  }

  // I7's q for a place p.
  Screen at(const Screen& p) const {
    const bool x = abs(direction.x) >= abs(direction.y);
    Rational f = x ? Rational((p.x - end.x) / direction.x) : Rational((p.y - end.y) / direction.y);
    if (f < 0) f = 0;
    if (!ray && f > 1) f = 1;
    return {end.x + f * direction.x, end.y + f * direction.y};
  }
};

// The k_0, k_1 of a point of S: by two of the three equations, and the third one holds.
std::array<Rational, 2> weights(const Vector& m0, const Vector& m1, const Screen& q) {
  const std::array<Rational, 3> a = {m0.x, m0.y, m0.w}, b = {m1.x, m1.y, m1.w}, c = {q.x, q.y, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Rational det = a[i] * b[j] - a[j] * b[i];
    if (sgn(det) == 0) continue;
    const Rational k0 = (c[i] * b[j] - c[j] * b[i]) / det, k1 = (a[i] * c[j] - a[j] * c[i]) / det;
    EXPECT_EQ(k0 * a[k] + k1 * b[k], c[k]);
    EXPECT_GE(sgn(k0), 0);
    EXPECT_GE(sgn(k1), 0);
    return {k0, k1};
  }
  ADD_FAILURE() << "m_0 and m_1 are one point";
  return {0, 0};
}

// A scene of one point or line, sample by sample.
class ByThePage {
 public:
  explicit ByThePage(const Scene& scene) : scene_(scene), frame_(scene) {
    oracle::render(frame_.target(), frame_.draws());
  }

  std::uint64_t check() {
    const Draw& draw = frame_.draws()[0];
    std::vector<std::uint32_t> corners(draw.indices.begin(), draw.indices.end());
    if (corners.size() == 1) corners.push_back(corners[0]);
    finite_ = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vertex& v = vertices_[i] = draw.vertices[corners[i]];
      finite_ = finite_ && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
      for (const AttributeArray& array : draw.attributes) {
        for (std::size_t c = 0; c < array.components; ++c)
          finite_ = finite_ && std::isfinite(array.values[corners[i] * array.stride + c]);
      }
    }
    if (finite_) {
      for (std::size_t i = 0; i < 2; ++i) m_[i] = {exact(vertices_[i].x), exact(vertices_[i].y), exact(vertices_[i].w)};
      seen_ = Seen::make(m_[0], m_[1]);
    }
    for (int y = 0; y < scene_.height; ++y) {
      for (int x = 0; x < scene_.width; ++x) {
        for (int n = 0; n < scene_.samples; ++n) check_sample(draw, corners, x, y, n);
      }
    }
    return covered_;
  }

 private:
  SampleLocation location(int n) const {
    return scene_.sample_locations.empty() ? sample_location(scene_.samples, n)
                                           : scene_.sample_locations[static_cast<std::size_t>(n)];
  }
  // A place in 1/16 pixel of pixel (x, y) of the target, in space.
  Screen place(int x, int y, const SampleLocation& at) const {
    return {scene_.origin.x + x + Rational(at.x) / 16, scene_.origin.y + y + Rational(at.y) / 16};
  }
  bool covers(const Draw& draw, const Screen& p) const {
    const double x = p.x.get_d(), y = p.y.get_d();  // exact
    if (draw.primitive == Primitive::points)
      return oracle::point_covers(vertices_[0], draw.width.value_or(1), x, y, draw.fill_rule);
    return draw.width ? oracle::wide_line_covers(vertices_[0], vertices_[1], *draw.width, x, y, draw.fill_rule)
                      : oracle::line_covers(vertices_[0], vertices_[1], x, y, draw.fill_rule);
  }
  std::array<Rational, 2> weights_at(const Draw& draw, const Screen& p) const {
    if (draw.primitive == Primitive::points) return {1 / m_[0].w, 0};
    return weights(m_[0], m_[1], seen_->at(p));
  }

  void check_sample(const Draw& draw, const std::vector<std::uint32_t>& corners, int x, int y, int n) {
    const auto s = static_cast<std::size_t>((y * scene_.width + x) * scene_.samples + n);
    const Image& image = frame_.image();
    const Screen p = place(x, y, location(n));
    bool covered = finite_ && covers(draw, p);
    if (draw.scissor) {
      const int sx = scene_.origin.x + x, sy = scene_.origin.y + y;
      covered =
          covered && sx >= draw.scissor->x0 && sx < draw.scissor->x1 && sy >= draw.scissor->y0 && sy < draw.scissor->y1;
    }
    Rational z;
    if (covered) {
      const auto k = weights_at(draw, p);
      z = k[0] * exact(vertices_[0].z) + k[1] * exact(vertices_[1].z);
      if (draw.depth_mode == DepthMode::clip && (z < 0 || z > 1)) covered = false;
      if (draw.depth_mode == DepthMode::clamp) z = std::clamp(z, Rational(0), Rational(1));
    }
    ASSERT_EQ(image.count[s], covered ? 1u : 0u) << x << ' ' << y << ' ' << n;
    covered_ += covered;
    if (image.index[s] == kNoTriangle) return;
    ASSERT_TRUE(covered);
    // M5: without depth write it stays what it was.
    const bool smaller = scene_.depth_test == DepthTest::less || scene_.depth_test == DepthTest::less_equal;
    float stored = smaller ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity();
    if (!scene_.initial_depth.empty()) stored = scene_.initial_depth[scene_.initial_depth.size() == 1 ? 0 : s];
    expect_bits(image.depth[s], draw.depth_write ? nearest_float(z) : stored);
    check_values(draw, corners, x, y, s);
  }

  void check_values(const Draw& draw, const std::vector<std::uint32_t>& corners, int x, int y, std::size_t s) {
    const Image& image = frame_.image();
    Screen at = place(x, y, {8, 8});  // M1
    if (scene_.samples == 1) at = place(x, y, location(0));
    if (scene_.samples > 1 && scene_.attribute_location == AttributeLocation::centroid) {
      for (int n = 0; n < scene_.samples && !covers(draw, at); ++n) {
        if (covers(draw, place(x, y, location(n)))) at = place(x, y, location(n));
      }
    }
    const auto [k0, k1] = weights_at(draw, at);
    expect_bits(image.barycentrics[3 * s], nearest_float(k0 / (k0 + k1)));
    expect_bits(image.barycentrics[3 * s + 1], nearest_float(k1 / (k0 + k1)));
    expect_bits(image.barycentrics[3 * s + 2], 0);
    for (std::size_t a = 0; a < image.attributes.size(); ++a) {
      const AttributeArray& array = draw.attributes[a];
      for (std::size_t c = 0; c < array.components; ++c) {
        const Rational u0 = exact(array.values[corners[0] * array.stride + c]),
                       u1 = exact(array.values[corners[1] * array.stride + c]);
        Rational u = u0;
        if (array.interpolation == Interpolation::perspective) u = (k0 * u0 + k1 * u1) / (k0 + k1);
        if (array.interpolation == Interpolation::noperspective) u = k0 * m_[0].w * u0 + k1 * m_[1].w * u1;
        expect_bits(image.attributes[a][s * array.components + c], nearest_float(u));
      }
    }
  }

  static void expect_bits(float actual, float expected) {
    if (std::isnan(expected)) return;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(actual), std::bit_cast<std::uint32_t>(expected))
        << actual << ' ' << expected;
  }

  const Scene& scene_;
  Frame frame_;
  std::array<Vertex, 2> vertices_{};
  std::array<Vector, 2> m_;
  std::optional<Seen> seen_;
  bool finite_ = false;
  std::uint64_t covered_ = 0;
};

TEST(LinesAgree, ByThePage) {
  std::uint64_t covered = 0;
  for_each_scene(10'000, 150, 6, 1, [&](const Scene& scene) {
    if (scene.draws[0].conservative != Conservative::none) return;
    SCOPED_TRACE(corpus::write_scene(scene));
    covered += ByThePage(scene).check();
    const Comparison comparison = compare(scene, oracle_renderer(), clipped_oracle_renderer());
    ASSERT_EQ(comparison.differences, 0u) << text(comparison, scene);
  });
  if (kShare == 1) {
    EXPECT_GT(covered, 5'000u);
  }
}

// The probe says of one primitive what an image of it says.
TEST(LinesAgree, Probe) {
  std::uint64_t probed = 0;
  for_each_scene(20'000, 40, 7, 1, [&](Scene scene) {
    scene.layers = 1;
    scene.initial_depth.clear();
    scene.draws[0].depth_write = true;
    Frame frame(scene), values(scene);
    oracle::render(frame.target(), frame.draws());
    oracle::Probe probe(values.target(), values.draws()[0], 0);
    const Image& image = frame.image();
    for (std::size_t s = 0; s < image.count.size(); ++s) {
      const int pixel = static_cast<int>(s) / scene.samples, n = static_cast<int>(s) % scene.samples;
      const int x = pixel % scene.width, y = pixel / scene.width;
      ASSERT_EQ(probe.covers(x, y, n), image.count[s] != 0);
      if (image.count[s] == 0) continue;
      ++probed;
      if (image.index[s] == kNoTriangle) continue;  // a depth of no use, such as +inf
      ASSERT_EQ(std::bit_cast<std::uint32_t>(probe.depth(x, y, n)), std::bit_cast<std::uint32_t>(image.depth[s]));
      probe.store_values(x, y, s);
      for (std::size_t i = 3 * s; i < 3 * s + 3; ++i) ASSERT_EQ(values.image().barycentrics[i], image.barycentrics[i]);
      for (std::size_t a = 0; a < image.attributes.size(); ++a) {
        const std::size_t components = scene.attributes[a].components;
        for (std::size_t i = components * s; i < components * (s + 1); ++i)
          ASSERT_EQ(values.image().attributes[a][i], image.attributes[a][i]);
      }
    }
  });
  if (kShare == 1) {
    EXPECT_GT(probed, 1'500u);
  }
}

// --- Relations, of both oracles.

class Relation : public testing::TestWithParam<bool> {
 protected:
  void draw(Frame& frame) const {
    (GetParam() ? oracle::render : oracle::clipped::render)(frame.target(), frame.draws(), 1);
  }
  std::vector<std::uint32_t> counts(const Scene& scene) const {
    Frame frame(scene, {.index = false, .depth = false, .barycentrics = false, .attributes = false});
    draw(frame);
    return frame.image().count;
  }
};
INSTANTIATE_TEST_SUITE_P(Lines, Relation, testing::Values(true, false),
                         [](const auto& test) { return test.param ? "First" : "Second"; });

// A strip of thin lines hits each sample once at most, and in each column between its ends one sample, if its lines run
// along x, none steeper than 45 degrees, towards +x: wherever its joints are, on samples and on corners of diamonds too.
TEST_P(Relation, StripsHitEachSampleOnce) {
  Random random(1);
  std::uint64_t hits = 0;
  for (int n = 0; n < 600 / kShare; ++n) {
    Scene scene;
    scene.width = 12, scene.height = 12;
    corpus::SceneDraw& strip = scene.draws.emplace_back();
    strip.primitive = Primitive::lines;
    strip.fill_rule = static_cast<FillRule>(n % 8);
    const int q = 1 << random.between(1, 4), way = random.one_in(2) ? 1 : -1;
    const bool transposed = random.one_in(2);
    int along = way > 0 ? random.between(0, q) : 12 * q - random.between(0, q), across = random.between(2 * q, 10 * q);
    const auto add = [&] {
      float x = static_cast<float>(along) / static_cast<float>(q),
            y = static_cast<float>(across) / static_cast<float>(q);
      if (transposed) std::swap(x, y);
      const auto w = static_cast<float>(random.between(1, 3));
      strip.vertices.push_back({x * w, y * w, 0, w, {}});
    };
    add();
    while (way > 0 ? along < 11 * q : along > q) {
      const int step = random.between(1, 3 * q), turn = random.between(-step, step);
      along += way * step;
      across = std::clamp(across + turn, q, 11 * q);  // never steeper than it was
      add();
      const auto last = static_cast<std::uint32_t>(strip.vertices.size()) - 1;
      strip.triangles.push_back({{last - 1, last, last}, {}});
    }
    const std::vector<std::uint32_t> count = counts(scene);
    for (int column = 0; column < 12; ++column) {
      std::uint32_t in_column = 0;
      for (int row = 0; row < 12; ++row) {
        const int x = transposed ? row : column, y = transposed ? column : row;
        const std::uint32_t here = count[static_cast<std::size_t>(12 * y + x)];
        ASSERT_LE(here, 1u) << corpus::write_scene(scene);
        in_column += here;
      }
      if (column >= 2 && column <= 9) {
        ASSERT_EQ(in_column, 1u) << corpus::write_scene(scene);
      }
      hits += in_column;
    }
  }
  if (kShare == 1) {
    EXPECT_GT(hits, 6'000u);
  }
}

// All vertices times one power of two are the same; each times its own one leave coverage, depth and noperspective
// attributes (T4). Turning a wide line round changes only which end is called 0.
TEST_P(Relation, ScaleAndReversal) {
  std::uint64_t covered = 0;
  Random random(2);
  const auto is_ordinary = [](const corpus::SceneVertex& v) {
    for (const float number : {v.x, v.y, v.z, v.w}) {
      const float size = std::abs(number);
      if (!(number == 0 || (size >= 0x1p-80f && size <= 0x1p80f))) return false;
    }
    return true;
  };
  const auto scale = [](corpus::SceneVertex& v, float s) { v.x *= s, v.y *= s, v.z *= s, v.w *= s; };
  const auto change = [](Scene& scene, Interpolation from, Interpolation to) {
    for (corpus::SceneAttribute& attribute : scene.attributes) {
      if (attribute.interpolation == from) attribute.interpolation = to;
    }
  };
  const auto expect_same = [&](const Scene& a, const Scene& b, const corpus::Outputs& outputs, bool reversed = false) {
    Frame one(a, outputs), other(b, outputs);
    draw(one);
    draw(other);
    for (const std::uint32_t count : one.image().count) covered += count;
    if (reversed) {
      std::vector<float>& weights = other.image().barycentrics;
      for (std::size_t i = 0; i < weights.size(); i += 3) std::swap(weights[i], weights[i + 1]);
    }
    const Comparison comparison = compare(a, one.image(), other.image());
    ASSERT_EQ(comparison.differences, 0u) << text(comparison, a);
  };
  for_each_scene(0, 40, 8, 1, [&](Scene scene) {
    const corpus::SceneDraw& mesh = scene.draws[0];
    if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_ordinary)) return;
    Scene other = scene;
    const float common = std::ldexp(1.0f, random.between(-20, 20));
    for (corpus::SceneVertex& v : other.draws[0].vertices) scale(v, common);
    expect_same(scene, other, {});
    if (mesh.width && mesh.primitive == Primitive::lines) {
      change(scene, Interpolation::flat, Interpolation::perspective);
      other = scene;
      std::swap(other.draws[0].triangles[0].vertices[0], other.draws[0].triangles[0].vertices[1]);
      expect_same(scene, other, {}, true);
    }
    change(scene, Interpolation::perspective, Interpolation::noperspective);
    other = scene;
    for (corpus::SceneVertex& v : other.draws[0].vertices) scale(v, std::ldexp(1.0f, random.between(-20, 20)));
    expect_same(scene, other, {.barycentrics = false});
  });
  if (kShare == 1) {
    EXPECT_GT(covered, 1'000u);
  }
}

// T9: a target elsewhere, of another size, at the pixels of space that both have.
TEST_P(Relation, TilesT9) {
  std::uint64_t shared = 0;
  Random random(3);
  for_each_scene(30'000, 12, 9, 5, [&](Scene scene) {
    if (scene.initial_depth.size() > 1) scene.initial_depth.resize(1);
    if (std::abs(scene.origin.x) > 4'000'000 || std::abs(scene.origin.y) > 4'000'000) return;
    scene.more.numbers = false;
    Scene tile = scene;
    const int dx = random.between(-4, 6), dy = random.between(-4, 6);
    tile.origin.x += dx, tile.origin.y += dy;
    tile.width = random.between(1, 20), tile.height = random.between(1, 20);
    Frame a(scene), b(tile);
    draw(a);
    draw(b);
    const auto same = [](const auto& u, std::size_t i, const auto& v, std::size_t j, std::size_t elements) {
      for (std::size_t k = 0; k < elements && !u.empty(); ++k) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(u[elements * i + k]), std::bit_cast<std::uint32_t>(v[elements * j + k]));
      }
    };
    const Image &whole = a.image(), &part = b.image();
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        if (x + dx < 0 || x + dx >= scene.width || y + dy < 0 || y + dy >= scene.height) continue;
        for (int n = 0; n < scene.samples; ++n) {
          const auto s = static_cast<std::size_t>(((y + dy) * scene.width + x + dx) * scene.samples + n),
                     t = static_cast<std::size_t>((y * tile.width + x) * scene.samples + n);
          shared += whole.count[s];
          same(whole.count, s, part.count, t, 1);
          same(whole.winding, s, part.winding, t, 1);
          for (std::size_t layer = 0; layer < static_cast<std::size_t>(scene.layers); ++layer) {
            const std::size_t u = layer * whole.count.size() + s, v = layer * part.count.size() + t;
            same(whole.index, u, part.index, v, 1);
            same(whole.depth, u, part.depth, v, 1);
            same(whole.barycentrics, u, part.barycentrics, v, 3);
            for (std::size_t k = 0; k < whole.attributes.size(); ++k)
              same(whole.attributes[k], u, part.attributes[k], v, scene.attributes[k].components);
          }
        }
      }
    }
  });
  if (kShare == 1) {
    EXPECT_GT(shared, 1'000u);
  }
}

// I7 is I1 to I3 at q of any triangle, D != 0, that has this edge: here q is the sample itself, on a line in perspective
// through samples; the triangle lies on either side of its closed edge.
TEST_P(Relation, EdgesOfTrianglesI7) {
  Random random(4);
  std::uint64_t shared = 0;
  for (int n = 0; n < 400 / kShare; ++n) {
    Scene scene;
    scene.width = scene.height = 8;
    scene.attributes = {
        {"p", 1, Interpolation::perspective}, {"n", 1, Interpolation::noperspective}, {"f", 1, Interpolation::flat}};
    constexpr int kDirections[][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 1}, {1, -2}};
    const auto& direction = kDirections[random.below(6)];
    corpus::SceneDraw line;
    const float x = static_cast<float>(random.between(1, 5)) + 0.5f,
                y = static_cast<float>(random.between(2, 5)) + 0.5f;
    for (const int end : {0, 1}) {
      const float along = static_cast<float>(end == 0 ? -random.between(0, 12) : random.between(1, 12)) / 2;
      const auto w = static_cast<float>(random.between(1, 9));
      corpus::SceneVertex v{(x + along * static_cast<float>(direction[0])) * w,
                            (y + along * static_cast<float>(direction[1])) * w,
                            static_cast<float>(random.unit()),
                            w,
                            {}};
      if (end == 1 && random.one_in(3))
        v = {static_cast<float>(direction[0]) - x, static_cast<float>(direction[1]) - y, 0.25f, -1, {}};
      for (int k = 0; k < 3; ++k) v.attributes.push_back(static_cast<float>(random.unit()));
      line.vertices.push_back(v);
    }
    line.vertices.push_back({static_cast<float>(random.between(-9, 9)),
                             static_cast<float>(random.between(-9, 9)),
                             static_cast<float>(random.unit()),
                             1,
                             {7, 8, 9}});
    corpus::SceneDraw triangle = line;
    line.primitive = Primitive::lines;
    line.width = 0.25f;
    line.triangles = {{{0, 1, 1}, {}}};
    triangle.fill_rule = FillRule::closed;
    triangle.triangles = {{{0, 1, 2}, {}}};
    scene.draws = {line};
    Scene other = scene;
    other.draws = {triangle};
    Frame a(scene), b(other);
    draw(a);
    draw(b);
    for (std::size_t s = 0; s < a.image().count.size(); ++s) {
      if (a.image().count[s] == 0 || b.image().count[s] == 0 || b.image().barycentrics[3 * s + 2] != 0) continue;
      ++shared;
      ASSERT_EQ(a.image().depth[s], b.image().depth[s]) << corpus::write_scene(scene) << s;
      for (std::size_t i = 3 * s; i < 3 * s + 3; ++i) ASSERT_EQ(a.image().barycentrics[i], b.image().barycentrics[i]);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(a.image().attributes[k][s], b.image().attributes[k][s]);
    }
  }
  if (kShare == 1) {
    EXPECT_GT(shared, 400u);
  }
}

}  // namespace
}  // namespace surefill::properties
