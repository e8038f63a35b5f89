// SPDX-License-Identifier: Apache-2.0
//
// Origin, sample places, winding, numbers of a triangle, conservative modes, layers, depth tests and bias (S6, S7, M9,
// M10, M4a to M4c, V4, V5, I8 of docs/semantics.md): both oracles on random small frames, on a lattice where samples lie
// on edges, triangles share edges, D is 0 and vertices are behind the eye; and what the page says of images, of both.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include "oracle/tests/modes_image.hpp"

namespace surefill::modes {
namespace {

using Asked = Image::Asked;

constexpr unsigned kSeed = 21;
#ifdef SUREFILL_CASES_SHARE
constexpr int kShare = SUREFILL_CASES_SHARE;
#else
constexpr int kShare = 1;
#endif

struct Scene {
  Asked asked;
  std::vector<Mesh> draws;
};

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  int between(int low, int high) { return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1)); }
  bool one_in(int n) { return between(1, n) == 1; }
  template <typename T, std::size_t N>
  T pick(const T (&values)[N]) {
    return values[random_() % N];
  }

  // What a frame may be. With `conservative` its draws are, but for some of them; of all others one in `grids` has one,
  // none if it is 0.
  struct Kind {
    bool conservative = false, layers = false, behind = true;
    int grids = 3;
  };
  Scene scene(const Kind& kind) {
    Scene result;
    Asked& asked = result.asked;
    asked.width = between(2, 6), asked.height = between(1, 5);
    constexpr int kSamples[] = {1, 1, 2, 4, 8};
    asked.samples = kind.conservative ? 1 : pick(kSamples);
    if (kind.layers) asked.layers = between(2, 6);
    asked.depth_test = static_cast<DepthTest>(between(0, 3));
    asked.attribute_location = static_cast<AttributeLocation>(between(0, 1));
    constexpr int kOrigins[] = {0, 0, -3, 7, 1024, -5000};
    asked.origin = {pick(kOrigins), pick(kOrigins)};
    if (!kind.conservative && !one_in(3)) {
      constexpr int kPlaces[] = {0, 4, 8, 8, 8, 12, 15};
      for (int n = 0; n < asked.samples; ++n) asked.places.push_back({pick(kPlaces), pick(kPlaces)});
    }
    if (one_in(3)) {
      constexpr float kInitial[] = {0.25f, 0.5f, 0.75f, 1};
      for (int s = 0; s < asked.width * asked.height * asked.samples; ++s)
        asked.initial_depth.push_back(pick(kInitial));
    }
    std::uint32_t next = 0;
    for (int n = between(1, 3); n > 0; --n) {
      result.draws.push_back(draw(asked, kind));
      result.draws.back().state.first_index = next + static_cast<std::uint32_t>(between(0, 3));
      next = result.draws.back().state.first_index + static_cast<std::uint32_t>(result.draws.back().primitives());
    }
    return result;
  }

 private:
  // On a lattice of half pixels around the target, in multiples by W.
  Vertex vertex(const Asked& asked, bool behind) {
    constexpr float kW[] = {1, 1, 1, 1, 2, 0.5f, -1, -2, 0}, kZ[] = {0, 0.25f, 0.5f, 0.5f, 0.75f, 1, 1.25f, -0.25f};
    const float w = behind ? pick(kW) : kW[between(0, 5)];
    const float x = static_cast<float>(between(-4, 2 * asked.width + 4)) / 2,
                y = static_cast<float>(between(-4, 2 * asked.height + 4)) / 2;
    if (w == 0) return {static_cast<float>(between(-1, 1)), static_cast<float>(between(-1, 1)), pick(kZ), 0};
    return {(x + static_cast<float>(asked.origin.x)) * w, (y + static_cast<float>(asked.origin.y)) * w, pick(kZ) * w,
            w};
  }

  Mesh draw(const Asked& asked, const Kind& kind) {
    Mesh mesh;
    const int vertices = between(3, 7);
    const bool behind = kind.behind && one_in(2);
    for (int i = 0; i < vertices; ++i) {
      mesh.vertices.push_back(vertex(asked, behind));
      mesh.values.push_back(static_cast<float>(between(-8, 8)) / 4);
    }
    if (one_in(2)) {  // all of one depth
      for (Vertex& v : mesh.vertices) v.z = 0.5f * v.w;
    }
    const int triangles = between(1, kind.layers ? 9 : 6);
    for (int t = 0; t < triangles; ++t) {
      const int first = between(0, vertices - 1), second = between(1, vertices - 1), third = between(1, vertices - 2);
      const bool distinct = !one_in(6);  // else D may be 0
      mesh.indices.push_back(static_cast<std::uint32_t>(first));
      mesh.indices.push_back(static_cast<std::uint32_t>((first + second) % vertices));
      mesh.indices.push_back(
          static_cast<std::uint32_t>((first + (distinct && third >= second ? third + 1 : third)) % vertices));
    }
    if (one_in(3)) {  // here and there twice the same
      for (int t = 0; t < triangles; ++t) mesh.identifiers.push_back(static_cast<std::uint32_t>(between(0, 9)));
    }
    Draw& state = mesh.state;
    constexpr Conservative kModes[] = {Conservative::none,    Conservative::over,    Conservative::inner,
                                       Conservative::overlap, Conservative::touched, Conservative::touched};
    if (kind.conservative) state.conservative = pick(kModes);
    state.fill_rule = static_cast<FillRule>(one_in(2) ? 0 : between(0, 9));
    state.front_face = static_cast<FrontFace>(between(0, 1));
    state.cull = static_cast<Cull>(one_in(4) ? between(1, 2) : 0);
    if (one_in(4)) {
      const int x = asked.origin.x + between(0, 3), y = asked.origin.y + between(0, 2);
      state.scissor = Scissor{x, y, x + between(1, 4), y + between(1, 4)};
    }
    if (state.conservative != Conservative::none) return mesh;
    state.depth_mode = static_cast<DepthMode>(between(0, 2));
    state.depth_write = kind.layers || !one_in(4);
    if (one_in(2)) {
      state.depth_bias = DepthBias{static_cast<float>(between(-2, 2)) / 4, static_cast<float>(between(-4, 4)) / 2};
    }
    if (kind.grids != 0 && one_in(kind.grids) && state.fill_rule < FillRule::closed) {
      constexpr int kBits[] = {0, 0, 1, 4};
      state.grid = Grid{pick(kBits), one_in(2) ? 0 : between(0, 15), one_in(2) ? 0 : between(0, 15),
                        static_cast<GridRounding>(between(0, 2))};
    }
    return mesh;
  }

  std::mt19937 random_;
};

Image draw(const Oracle& oracle, const Scene& scene, int threads = 1) {
  return render(oracle.render, scene.asked, scene.draws, threads);
}

// Element by element, so that a failure says what differs.
void expect_same(const Image& a, const Image& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.winding, b.winding);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.barycentrics, b.barycentrics);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(a.attributes[k], b.attributes[k]) << k;
  EXPECT_EQ(a.covered, b.covered);
  EXPECT_EQ(a.visible, b.visible);
}

std::uint64_t sum(const std::vector<std::vector<std::uint64_t>>& numbers) {
  std::uint64_t result = 0;
  for (const auto& of_draw : numbers) {
    for (const std::uint64_t number : of_draw) result += number;
  }
  return result;
}

// A sweep has seen what it is for; a share of it need not.
void expect_seen(int times, int least) {
  if (kShare == 1) {
    EXPECT_GT(times, least);
  }
}

// M10: what the numbers add up to.
void expect_sums(const Image& image, std::size_t samples, bool conservative) {
  std::uint64_t counts = 0, seen = 0;
  for (const std::uint32_t count : image.count) counts += count;
  for (std::size_t s = 0; s < samples; ++s) seen += image.index[s] != kNoTriangle;
  EXPECT_EQ(sum(image.covered), counts);
  if (!conservative) {
    EXPECT_EQ(sum(image.visible), seen);
  }
}

void sweep(const Generator::Kind& kind, int frames, unsigned seed) {
  Generator generator(seed);
  int covered = 0, several = 0, negative = 0, deep = 0;
  for (int n = 0; n < frames / kShare; ++n) {
    SCOPED_TRACE("frame " + std::to_string(n));
    const Scene scene = generator.scene(kind);
    const Image first = draw(kOracles[0], scene), second = draw(kOracles[1], scene);
    expect_same(first, second);
    if (n % 8 == 0) expect_same(draw(kOracles[static_cast<std::size_t>(n / 8 % 2)], scene, 3), first);
    expect_sums(first, first.count.size(), kind.conservative);
    if (testing::Test::HasFailure()) return;
    covered += std::ranges::any_of(first.count, [](std::uint32_t c) { return c > 0; });
    several += std::ranges::any_of(first.count, [](std::uint32_t c) { return c > 1; });
    negative += std::ranges::any_of(first.winding, [](std::int32_t w) { return w < 0; });
    const auto last_layer = first.index.end() - static_cast<std::ptrdiff_t>(first.count.size());
    deep += std::any_of(last_layer, first.index.end(), [](std::uint32_t i) { return i != kNoTriangle; });
  }
  expect_seen(covered, frames / 2);
  expect_seen(several, frames / 4);
  if (!kind.conservative) {
    expect_seen(negative, frames / 8);
  }
  expect_seen(deep, frames / 10);
}

TEST(ModesAgree, Images) {
  sweep({}, 800, kSeed);
}
TEST(ModesAgree, Layers) {
  sweep({.layers = true}, 400, kSeed + 1);
}
TEST(ModesAgree, Conservative) {
  sweep({.conservative = true}, 800, kSeed + 2);
}

// The probe says of each triangle alone what an image of it says.
TEST(ModesAgree, Probe) {
  Generator generator(kSeed + 3);
  int probed = 0;
  for (int n = 0; n < 800 / kShare; ++n) {
    Scene scene = generator.scene({});
    scene.asked.initial_depth.clear();
    scene.draws.resize(1);
    Mesh& mesh = scene.draws[0];
    mesh.state.depth_write = true;
    mesh.indices.resize(3), mesh.identifiers.clear();
    const Image image = draw(kOracles[0], scene);

    const Asked& asked = scene.asked;
    std::vector<float> barycentrics(image.barycentrics.size());
    AttributeArray array{mesh.values};
    Target target;
    target.width = asked.width, target.height = asked.height, target.samples = asked.samples;
    target.depth_test = asked.depth_test, target.attribute_location = asked.attribute_location;
    target.origin = asked.origin, target.sample_locations = asked.places, target.barycentrics = barycentrics;
    Draw one = mesh.state;
    one.vertices = mesh.vertices, one.indices = mesh.indices, one.attributes = {&array, 1};
    oracle::Probe probe(target, one, 0);
    for (std::size_t s = 0; s < image.count.size(); ++s) {
      const int pixel = static_cast<int>(s) / asked.samples, sample = static_cast<int>(s) % asked.samples;
      const int x = pixel % asked.width, y = pixel / asked.width;
      ASSERT_EQ(probe.covers(x, y, sample), image.count[s] != 0) << n;
      if (image.count[s] == 0) continue;
      ++probed;
      ASSERT_EQ(bits({probe.depth(x, y, sample)})[0], image.depth[s]) << n;
      probe.store_values(x, y, s);
      for (std::size_t i = 3 * s; i < 3 * s + 3; ++i) ASSERT_EQ(bits({barycentrics[i]})[0], image.barycentrics[i]) << n;
    }
  }
  expect_seen(probed, 2000);
}

class Relations : public testing::TestWithParam<Oracle> {
 protected:
  Image draw(const Scene& scene) const { return modes::draw(GetParam(), scene); }
};
INSTANTIATE_TEST_SUITE_P(Oracles, Relations, testing::ValuesIn(kOracles),
                         [](const auto& test) { return test.index == 0 ? "First" : "Second"; });

// T9: a target elsewhere, of another size, at the pixels of space that both have. With Grid all W > 0, so that the
// triangles lie inside both guard bands.
TEST_P(Relations, TilesT9) {
  Generator generator(kSeed + 4);
  int shared = 0;
  for (int n = 0; n < 300 / kShare; ++n) {
    SCOPED_TRACE(n);
    Generator::Kind kind{.conservative = n % 3 == 1, .layers = n % 3 == 2};
    kind.behind = generator.one_in(2);
    kind.grids = kind.behind ? 0 : 1;
    const Scene whole = generator.scene(kind);
    Scene tile = whole;
    Asked& asked = tile.asked;
    const int dx = generator.between(-2, 4), dy = generator.between(-2, 3);
    asked.origin.x += dx, asked.origin.y += dy;
    asked.width = generator.between(1, 24), asked.height = generator.between(1, 12);
    // Samples of the tile's pixel (x, y), and of the same pixel of the whole, or none.
    const auto samples_of = [](const Asked& a, int x, int y) -> std::size_t {
      return static_cast<std::size_t>((y * a.width + x) * a.samples);
    };
    const auto in_whole = [&](int x, int y) {
      return x + dx >= 0 && x + dx < whole.asked.width && y + dy >= 0 && y + dy < whole.asked.height;
    };
    const std::size_t samples = static_cast<std::size_t>(asked.samples);
    if (!asked.initial_depth.empty()) {
      asked.initial_depth.clear();
      for (int y = 0; y < asked.height; ++y) {
        for (int x = 0; x < asked.width; ++x) {
          for (std::size_t k = 0; k < samples; ++k) {
            asked.initial_depth.push_back(
                in_whole(x, y) ? whole.asked.initial_depth[samples_of(whole.asked, x + dx, y + dy) + k] : 0.5f);
          }
        }
      }
    }
    const Image a = draw(whole), b = draw(tile);
    for (int y = 0; y < asked.height; ++y) {
      for (int x = 0; x < asked.width; ++x) {
        if (!in_whole(x, y)) continue;
        for (std::size_t k = 0; k < samples; ++k) {
          const std::size_t s = samples_of(whole.asked, x + dx, y + dy) + k, t = samples_of(asked, x, y) + k;
          shared += a.count[s] > 0;
          ASSERT_EQ(a.count[s], b.count[t]);
          if (!kind.conservative) {
            ASSERT_EQ(a.winding[s], b.winding[t]);
          }
          for (std::size_t layer = 0; layer < static_cast<std::size_t>(asked.layers); ++layer) {
            const std::size_t u = layer * a.count.size() + s, v = layer * b.count.size() + t;
            ASSERT_EQ(a.index[u], b.index[v]);
            if (kind.conservative) continue;
            ASSERT_EQ(a.depth[u], b.depth[v]);
            for (std::size_t i = 0; i < 3; ++i) {
              ASSERT_EQ(a.barycentrics[3 * u + i], b.barycentrics[3 * v + i]);
              ASSERT_EQ(a.attributes[i][u], b.attributes[i][v]);
            }
          }
        }
      }
    }
  }
  expect_seen(shared, 500);
}

// A draw without one of its triangles, the others keeping their indices.
void leave_out(Mesh& mesh, std::size_t t) {
  for (std::size_t i = 0; i < 3; ++i) mesh.indices[3 * t + i] = mesh.indices[3 * t];
}

// T10: layer n of a sample is layer 0 of the frame without what its layers before show. And V4: count, winding and
// `covered` do not depend on the number of layers, and layer 0 is the image.
TEST_P(Relations, LayersT10) {
  Generator generator(kSeed + 5);
  int peeled = 0;
  for (int n = 0; n < 60 / kShare + 1; ++n) {
    SCOPED_TRACE(n);
    Scene scene = generator.scene({.layers = true});
    std::uint32_t first = 100;
    for (Mesh& mesh : scene.draws) {  // so that an index names a triangle, and later draws have smaller ones
      mesh.identifiers.clear();
      mesh.state.first_index = first -= 20;
    }
    scene.asked.width = std::min(scene.asked.width, 3), scene.asked.height = std::min(scene.asked.height, 2);
    if (scene.asked.samples > 2) scene.asked.samples = 2;
    if (!scene.asked.places.empty()) scene.asked.places.resize(static_cast<std::size_t>(scene.asked.samples), {4, 4});
    const auto total = static_cast<std::size_t>(scene.asked.width * scene.asked.height * scene.asked.samples);
    if (!scene.asked.initial_depth.empty()) scene.asked.initial_depth.resize(total, 0.5f);
    const Image layers = draw(scene);
    scene.asked.layers = 1;
    const Image image = draw(scene);
    ASSERT_EQ(layers.count, image.count);
    ASSERT_EQ(layers.winding, image.winding);
    ASSERT_EQ(layers.covered, image.covered);
    ASSERT_EQ(layers.visible, image.visible);
    for (std::size_t s = 0; s < total; ++s) {
      Scene rest = scene;
      Image peel = image;
      for (std::size_t u = s; u < layers.index.size(); u += total) {
        ASSERT_EQ(layers.index[u], peel.index[s]);
        ASSERT_EQ(layers.depth[u], peel.depth[s]);
        for (std::size_t i = 0; i < 3; ++i) {
          ASSERT_EQ(layers.barycentrics[3 * u + i], peel.barycentrics[3 * s + i]);
          ASSERT_EQ(layers.attributes[i][u], peel.attributes[i][s]);
        }
        if (layers.index[u] == kNoTriangle) break;
        peeled += u >= total;
        for (Mesh& mesh : rest.draws) {
          const std::uint32_t t = layers.index[u] - mesh.state.first_index;
          if (t < mesh.primitives()) leave_out(mesh, t);
        }
        peel = draw(rest);
      }
    }
  }
  expect_seen(peeled, 100);
}

// V5 is V4's order with its ties turned round: LEQUAL is LESS of the draws in reverse, each with its indices and its
// positions in reverse. Where there is no initial depth, and depth write is on.
TEST_P(Relations, LaterIsReversedV5) {
  Generator generator(kSeed + 6);
  int ties = 0;
  for (int n = 0; n < 200 / kShare; ++n) {
    SCOPED_TRACE(n);
    Scene scene = generator.scene({.layers = n % 2 == 0});
    scene.asked.initial_depth.clear();
    const bool greater = generator.one_in(2);
    scene.asked.depth_test = greater ? DepthTest::greater_equal : DepthTest::less_equal;
    for (Mesh& mesh : scene.draws) mesh.state.depth_write = true;
    Scene reversed = scene;
    reversed.asked.depth_test = greater ? DepthTest::greater : DepthTest::less;
    std::ranges::reverse(reversed.draws);
    for (Mesh& mesh : reversed.draws) {
      const Mesh forward = mesh;
      const std::size_t triangles = mesh.primitives();
      mesh.identifiers.clear();
      for (std::size_t t = 0; t < triangles; ++t) {
        const std::size_t from = triangles - 1 - t;
        for (std::size_t i = 0; i < 3; ++i) mesh.indices[3 * t + i] = forward.indices[3 * from + i];
        const std::uint32_t index = forward.identifiers.empty()
                                        ? forward.state.first_index + static_cast<std::uint32_t>(from)
                                        : forward.identifiers[from];
        mesh.identifiers.push_back(1000 - index);
      }
      mesh.state.first_index = 0;
    }
    const Image image = draw(scene);
    Image other = draw(reversed);
    for (std::uint32_t& index : other.index) index = index == kNoTriangle ? kNoTriangle : 1000 - index;
    std::ranges::reverse(other.covered), std::ranges::reverse(other.visible);
    for (auto* numbers : {&other.covered, &other.visible}) {
      for (auto& of_draw : *numbers) std::ranges::reverse(of_draw);
    }
    expect_same(image, other);
    if (HasFailure()) return;
    reversed = scene;
    reversed.asked.depth_test = greater ? DepthTest::greater : DepthTest::less;
    ties += draw(reversed).index != image.index;
  }
  expect_seen(ties, 40);
}

// M4a, M4b: inner implies overlap, overlap implies over; over is touched where D != 0, and touched alone counts anything
// where D = 0.
TEST_P(Relations, ConservativeModes) {
  Generator generator(kSeed + 7);
  int border = 0, inside = 0, edge_on = 0;
  for (int n = 0; n < 1000 / kShare; ++n) {
    SCOPED_TRACE(n);
    Scene scene = generator.scene({.conservative = true});
    scene.draws.resize(1);
    Mesh& mesh = scene.draws[0];
    mesh.indices.resize(3), mesh.identifiers.clear(), mesh.state.cull = Cull::none, mesh.state.grid.reset();
    mesh.state.depth_mode = DepthMode::none, mesh.state.depth_bias.reset();
    const auto counts = [&](Conservative mode) {
      mesh.state.conservative = mode;
      return draw(scene).count;
    };
    const auto over = counts(Conservative::over), overlap = counts(Conservative::overlap),
               inner = counts(Conservative::inner), touched = counts(Conservative::touched);
    std::array<std::array<double, 3>, 3> m{};  // exact: numbers below 2^15 with few bits
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& v = mesh.vertices[mesh.indices[i]];
      m[i] = {v.x, v.y, v.w};
    }
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    for (std::size_t s = 0; s < over.size(); ++s) {
      ASSERT_LE(inner[s], overlap[s]);
      ASSERT_LE(overlap[s], over[s]);
      if (det == 0) {
        ASSERT_EQ(over[s], 0u);
        edge_on += touched[s] != 0;
      } else {
        ASSERT_EQ(touched[s], over[s]);
      }
      border += overlap[s] < over[s], inside += inner[s] < overlap[s];
    }
  }
  expect_seen(border, 300);
  expect_seen(inside, 1000);
  expect_seen(edge_on, 100);
}

// M9: fans of closed contours of lattice points, against the crossings of the contours by a ray to +x from the
// perturbed sample, in integers. In units of 2^-20 half pixels the shift of top_left is (2^10, 1): a x + b y + c with
// integers |a|, |b| <= 32 keeps its sign where it is not 0, and takes C3's where it is.
TEST_P(Relations, PolygonsM9) {
  struct Place {
    std::int64_t x, y;
  };
  Generator generator(kSeed + 8);
  int positive = 0, negative = 0, even = 0;
  for (int n = 0; n < 150 / kShare; ++n) {
    SCOPED_TRACE(n);
    Scene scene;
    scene.asked.width = scene.asked.height = 8;
    scene.draws.resize(1);
    std::vector<std::vector<Place>> contours(static_cast<std::size_t>(generator.between(1, 3)));
    for (auto& contour : contours) {
      for (int i = generator.between(3, 7); i > 0; --i)
        contour.push_back({generator.between(0, 16), generator.between(0, 16)});
      std::vector<Vertex> v;
      for (const Place& p : contour) {
        constexpr float kW[] = {1, 2, 0.25f};
        const float w = generator.pick(kW);
        v.push_back({static_cast<float>(p.x) / 2 * w, static_cast<float>(p.y) / 2 * w, 0, w});
      }
      Mesh& mesh = scene.draws[0];
      for (std::size_t i = 1; i + 1 < v.size(); ++i) {
        for (const Vertex& corner : {v[0], v[i], v[i + 1]}) {
          mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
          mesh.vertices.push_back(corner);
        }
      }
    }
    const Image image = draw(scene);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        constexpr std::int64_t kUnit = 1 << 20;
        const Place p{(2 * x + 1) * kUnit + 1024, (2 * y + 1) * kUnit + 1};
        int winding = 0;
        for (const auto& contour : contours) {
          for (std::size_t i = 0; i < contour.size(); ++i) {
            const Place a = contour[i], b = contour[(i + 1) % contour.size()];
            const std::int64_t ay = a.y * kUnit - p.y, by = b.y * kUnit - p.y;
            if ((ay < 0) == (by < 0)) continue;
            const std::int64_t ax = a.x * kUnit - p.x, bx = b.x * kUnit - p.x;
            const std::int64_t turn = ax * by - bx * ay;  // positive: p lies to the left of an edge that runs to +y
            if ((turn > 0) == (by > ay)) winding += by > ay ? 1 : -1;
          }
        }
        ASSERT_EQ(image.winding[static_cast<std::size_t>(8 * y + x)], winding) << x << ' ' << y;
        positive += winding > 0, negative += winding < 0, even += winding != 0 && winding % 2 == 0;
      }
    }
  }
  expect_seen(positive, 100);
  expect_seen(negative, 100);
  expect_seen(even, 20);
}

}  // namespace
}  // namespace surefill::modes
