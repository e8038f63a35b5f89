// SPDX-License-Identifier: Apache-2.0
//
// Every case there is of a small world. In them, ties, degenerate triangles and vertices on samples are the rule.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

// The next digit of a number in base `base`, the lowest first.
std::uint32_t digit(std::uint64_t& number, std::uint64_t base) {
  const auto d = static_cast<std::uint32_t>(number % base);
  number /= base;
  return d;
}

TrialResult decide_all(const corpus::Scene& scene, const Renderer& renderer) {
  const Comparison comparison = compare(scene, oracle_renderer(), renderer, {true, true, true, true, false}, 1);
  TrialResult verdict{comparison.samples, comparison.differences, {}};
  if (!comparison.first.empty()) verdict.finding = describe(comparison.first[0], scene.samples);
  return verdict;
}

TrialResult decide_outputs(const corpus::Scene& scene, const Renderer& renderer) {
  const Comparison comparison = compare(scene, oracle_renderer(), renderer, outputs_of(scene), 1);
  TrialResult verdict{comparison.samples, comparison.differences, {}};
  if (!comparison.first.empty()) verdict.finding = describe(comparison.first[0], scene.samples);
  return verdict;
}

// (X, Y, W) over {-1, 0, 1, 2}^3: in front of, through and behind the eye. Depth is one small integer a vertex.
constexpr std::uint64_t kHomogeneous = 64 * 64 * 64;
corpus::Scene make_homogeneous(std::uint64_t number) {
  std::array<Vertex, 3> t{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = [&] { return static_cast<float>(digit(number, 4)) - 1; };
    t[i].x = component(), t[i].y = component(), t[i].w = component();
    t[i].z = static_cast<float>(i) - t[i].x;
  }
  return triangle_scene(4, 4, t);
}

// Vertices on a half-pixel lattice over 2 x 2 pixels, edge and corners included, under all eight fill rules.
constexpr std::uint64_t kHalfPixel = 25 * 25 * 25 * 8;
corpus::Scene make_half_pixel(std::uint64_t number) {
  const auto rule = static_cast<FillRule>(digit(number, 8));
  std::array<Vertex, 3> t{};
  for (Vertex& v : t) {
    v.x = static_cast<float>(digit(number, 5)) / 2;
    v.y = static_cast<float>(digit(number, 5)) / 2;
    v.w = 1;
    v.z = v.x / 2;
  }
  corpus::Scene scene = triangle_scene(2, 2, t);
  scene.draws[0].fill_rule = rule;
  return scene;
}

// X, Y over {-1, 0, 1, 3}, W over {0, 1, 2}: (1, 1, 2) and its like are samples. The signs are T3's.
constexpr std::uint64_t kOctants = 48 * 48 * 48;
corpus::Scene make_octants(std::uint64_t number) {
  constexpr float kValues[] = {-1, 0, 1, 3};
  std::array<Vertex, 3> t{};
  for (Vertex& v : t) {
    v.x = kValues[digit(number, 4)];
    v.y = kValues[digit(number, 4)];
    v.w = static_cast<float>(digit(number, 3));
  }
  return triangle_scene(2, 2, t);
}

TrialResult decide_octants(const corpus::Scene& scene, const Renderer& renderer) {
  for (const Property& property : symmetry_properties())
    if (std::string_view(property.name) == "octants") return property.decide(scene, renderer);
  return {0, 1, "no property \"octants\""};
}

// Triangles a b c and c b d over a 4 x 4 half-pixel lattice around two by two samples.
constexpr std::uint64_t kSharedEdge = 16 * 16 * 16 * 16;
corpus::Scene make_shared_edge(std::uint64_t number) {
  corpus::Scene scene;
  scene.width = scene.height = 2;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  for (int i = 0; i < 4; ++i) {
    const auto coordinate = [&] { return static_cast<float>(digit(number, 4)) / 2; };
    const float x = coordinate(), y = coordinate();
    draw.vertices.push_back({x, y, 0, 1, {}});
  }
  draw.triangles = {{{0, 1, 2}, std::nullopt}, {{2, 1, 3}, std::nullopt}};
  return scene;
}

// Where a and d lie on opposite sides of the line b c, the triangles do not overlap: no sample is covered twice. Where
// b and c also lie on opposite sides of a d, they tile a convex quad, which its other diagonal cuts, too: same counts.
TrialResult decide_shared_edge(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  if (scene.draws.empty() || scene.draws[0].triangles.size() < 2) return trial.verdict();
  const corpus::SceneDraw& draw = scene.draws[0];
  const auto& [first, second] = std::array{draw.triangles[0].vertices, draw.triangles[1].vertices};
  if (first[1] != second[1] || first[2] != second[0]) return trial.verdict();  // no shared edge
  const std::uint32_t a = first[0], b = first[1], c = first[2], d = second[2];
  const auto side = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return facing(triangle_of(draw, {{i, j, k}, std::nullopt}));
  };
  if (side(b, c, a) * side(b, c, d) >= 0) return trial.verdict();
  const auto image = trial.draw(scene, kCountOnly);
  if (!image) return trial.verdict();
  trial.looked_at(image->count.size());
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x)
      trial.expect_at_most("count of two triangles that share an edge", x, y, 1, image->count[element(*image, x, y)]);
  if (side(a, d, b) * side(a, d, c) >= 0) return trial.verdict();
  corpus::Scene other = scene;
  other.draws[0].triangles[0].vertices = {b, d, a};
  other.draws[0].triangles[1].vertices = {a, d, c};
  if (const auto turned = trial.draw(other, kCountOnly))
    trial.expect_same("a quad cut along its other diagonal", scene, *image, *turned);
  return trial.verdict();
}

// Worlds of millions of triangles, by integers alone. A case is two vertices and a rule; its frame has a triangle for
// every third vertex, each in a cell of its own, so that one frame decides them all.

// Every triangle on a lattice of 1/q pixel over `cell` x `cell` pixels, borders included: none leaves its cell.
corpus::Scene lattice_world(std::uint64_t number, int q, int cell) {
  const int side = q * cell + 1, points = side * side;
  corpus::Scene scene;
  scene.width = cell * points;
  scene.height = cell;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.fill_rule = static_cast<FillRule>(digit(number, 8));
  const auto base = static_cast<std::uint64_t>(points);
  const int first = static_cast<int>(digit(number, base)), second = static_cast<int>(digit(number, base));
  for (int third = 0; third < points; ++third) {
    const auto start = static_cast<std::uint32_t>(draw.vertices.size());
    for (const int point : {first, second, third})
      draw.vertices.push_back(
          {static_cast<float>(point % side) / static_cast<float>(q) + static_cast<float>(cell * third),
           static_cast<float>(point / side) / static_cast<float>(q),
           0,
           1,
           {}});
    draw.triangles.push_back({{start, start + 1, start + 2}, std::nullopt});
  }
  return scene;
}
constexpr std::uint64_t lattice_cases(std::uint64_t q, std::uint64_t cell) {
  const std::uint64_t points = (q * cell + 1) * (q * cell + 1);
  return points * points * 8;
}
corpus::Scene make_half_4(std::uint64_t number) {
  return lattice_world(number, 2, 4);
}
corpus::Scene make_quarter_2(std::uint64_t number) {
  return lattice_world(number, 4, 2);
}
corpus::Scene make_eighth_2(std::uint64_t number) {
  return lattice_world(number, 8, 2);
}

// (X, Y, W) over {-1, 0, 1, 2}^3, first and second by the number: a draw for every third vertex, each in a scissor of 3
// x 3 pixels.
corpus::Scene homogeneous_world(std::uint64_t number, const corpus::SceneDraw& state) {
  constexpr int kCell = 3;
  corpus::Scene scene;
  scene.width = 64 * kCell;
  scene.height = kCell;
  const std::uint32_t first = digit(number, 64), second = digit(number, 64);
  for (std::uint32_t third = 0; third < 64; ++third) {
    corpus::SceneDraw& draw = scene.draws.emplace_back(state);
    const int left = static_cast<int>(third) * kCell;
    draw.scissor = Scissor{left, 0, left + kCell, kCell};
    for (const std::uint32_t point : {first, second, third}) {
      const float w = static_cast<float>(point >> 4) - 1, x = static_cast<float>(point & 3u) - 1;
      draw.vertices.push_back({x + w * static_cast<float>(left), static_cast<float>(point >> 2 & 3u) - 1, 0, w, {}});
    }
    draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  }
  return scene;
}

constexpr std::uint64_t kHomogeneousRules = 64 * 64 * 8;
corpus::Scene make_homogeneous_rules(std::uint64_t number) {
  corpus::SceneDraw state;
  state.fill_rule = static_cast<FillRule>(digit(number, 8));
  return homogeneous_world(number, state);
}

constexpr std::uint64_t kHomogeneousConservative = 64 * 64 * 2;
corpus::Scene make_homogeneous_conservative(std::uint64_t number) {
  corpus::SceneDraw state;
  state.conservative = digit(number, 2) == 0 ? Conservative::over : Conservative::inner;
  return homogeneous_world(number, state);
}

// A conservative draw for every third vertex on the half-pixel lattice of 3 x 3 pixels, each in a scissor of its own.
constexpr std::uint64_t kConservative = 49 * 49 * 2;
corpus::Scene make_conservative(std::uint64_t number) {
  constexpr int kCell = 3, kSide = 7, kPoints = kSide * kSide;
  corpus::Scene scene;
  scene.width = kCell * kPoints;
  scene.height = kCell;
  const Conservative mode = digit(number, 2) == 0 ? Conservative::over : Conservative::inner;
  const int first = static_cast<int>(digit(number, kPoints)), second = static_cast<int>(digit(number, kPoints));
  for (int third = 0; third < kPoints; ++third) {
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    draw.conservative = mode;
    const int left = third * kCell;
    draw.scissor = Scissor{left, 0, left + kCell, kCell};
    for (const int point : {first, second, third})
      draw.vertices.push_back({static_cast<float>(point % kSide) / 2 + static_cast<float>(left),
                               static_cast<float>(point / kSide) / 2,
                               0,
                               1,
                               {}});
    draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  }
  return scene;
}

// (X, Y, W) over {-1, 0, 1, 2}^3 snapped to whole pixels, which flips and fattens triangles, with depths and an
// attribute of each interpolation.
corpus::Scene make_snapped(std::uint64_t number) {
  corpus::Scene scene = make_homogeneous(number);
  scene.width = scene.height = 3;
  scene.draws[0].grid = Grid{0, 0, 0, GridRounding::nearest_even};
  scene.attributes = {{"a", 1, Interpolation::noperspective}, {"b", 1, Interpolation::perspective}};
  for (std::size_t i = 0; i < 3; ++i) {
    const float value = static_cast<float>(i * i) + 1;
    scene.draws[0].vertices[i].attributes = {value, value};
  }
  return scene;
}

using Whole = std::array<std::int64_t, 3>;  // (X, Y, W)

// In eighths, if they are whole and small: then the determinants below fit.
std::optional<Whole> in_eighths(const Vertex& v) {
  Whole result{};
  const float components[] = {v.x, v.y, v.w};
  for (std::size_t i = 0; i < 3; ++i) {
    const float eighths = components[i] * 8;
    if (!(std::abs(eighths) < 65536) || eighths != std::floor(eighths)) return std::nullopt;
    result[i] = static_cast<std::int64_t>(eighths);
  }
  return result;
}

Whole edge_between(const Whole& j, const Whole& k) {
  return {j[1] * k[2] - j[2] * k[1], j[2] * k[0] - j[0] * k[2], j[0] * k[1] - j[1] * k[0]};
}
std::int64_t value_at(const Whole& edge, const Whole& point) {
  return edge[0] * point[0] + edge[1] * point[1] + edge[2] * point[2];
}
int sign_of(std::int64_t value) {
  return (value > 0) - (value < 0);
}

// C1 to C3, word by word.
bool covers(const std::array<Whole, 3>& edges, int determinant, int x, int y, FillRule rule) {
  const auto number = static_cast<unsigned>(rule);
  const int along_x = (number & 1u) == 0 ? 1 : -1, along_y = (number & 2u) == 0 ? 1 : -1;
  return std::all_of(edges.begin(), edges.end(), [&](const Whole& e) {
    int sign = sign_of(value_at(e, {2 * x + 1, 2 * y + 1, 2}));
    const int tie_x = sign_of(e[0]) * along_x, tie_y = sign_of(e[1]) * along_y;
    if (sign == 0) sign = number < 4 ? (tie_x != 0 ? tie_x : tie_y) : (tie_y != 0 ? tie_y : tie_x);
    return sign == determinant;
  });
}

// M4 for W = 1, by separating axes: two convex polygons are apart exactly if they are so along a side's normal.
bool covers_square(const std::array<Whole, 3>& m, const std::array<Whole, 3>& edges, int determinant, int x, int y,
                   Conservative mode) {
  const Whole corners[] = {{8 * x, 8 * y, 8}, {8 * x + 8, 8 * y, 8}, {8 * x + 8, 8 * y + 8, 8}, {8 * x, 8 * y + 8, 8}};
  const auto within = [&](const Whole& e) {
    return [&e, determinant](const Whole& corner) { return sign_of(value_at(e, corner)) * determinant >= 0; };
  };
  if (mode == Conservative::inner)
    return std::all_of(edges.begin(), edges.end(),
                       [&](const Whole& e) { return std::all_of(std::begin(corners), std::end(corners), within(e)); });
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    const auto [low, high] = std::minmax({m[0][axis], m[1][axis], m[2][axis]});
    if (high < corners[0][axis] || low > corners[2][axis]) return false;
  }
  return std::all_of(edges.begin(), edges.end(),
                     [&](const Whole& e) { return std::any_of(std::begin(corners), std::end(corners), within(e)); });
}

TrialResult decide_by_integers(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  std::vector<std::uint32_t> expected(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
  for (const corpus::SceneDraw& draw : scene.draws)
    for (const corpus::SceneTriangle& triangle : draw.triangles) {
      const std::array<Vertex, 3> t = triangle_of(draw, triangle);
      std::array<Whole, 3> m{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto whole = in_eighths(t[i]);
        if (!whole) return trial.verdict();  // a simpler case, no more of this world
        if (draw.conservative != Conservative::none && (*whole)[2] != 8) return trial.verdict();
        m[i] = *whole;
      }
      const std::array<Whole, 3> edges = {edge_between(m[1], m[2]), edge_between(m[2], m[0]), edge_between(m[0], m[1])};
      const int determinant = sign_of(value_at(edges[0], m[0]));
      if (determinant == 0) continue;
      Scissor box = draw.scissor.value_or(Scissor{0, 0, scene.width, scene.height});
      if (t[0].w == 1 && t[1].w == 1 && t[2].w == 1)
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const auto [low, high] = std::minmax({m[0][axis], m[1][axis], m[2][axis]});
          int& begin = axis == 0 ? box.x0 : box.y0;
          int& end = axis == 0 ? box.x1 : box.y1;
          begin = std::max(begin, static_cast<int>(low / 8) - 1);
          end = std::min(end, static_cast<int>(high / 8) + 2);
        }
      for (int y = std::max(0, box.y0); y < std::min(scene.height, box.y1); ++y)
        for (int x = std::max(0, box.x0); x < std::min(scene.width, box.x1); ++x)
          if (draw.conservative == Conservative::none ? covers(edges, determinant, x, y, draw.fill_rule)
                                                      : covers_square(m, edges, determinant, x, y, draw.conservative))
            ++expected[static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) +
                       static_cast<std::size_t>(x)];
    }
  corpus::Scene plain = scene;
  for (corpus::SceneDraw& draw : plain.draws) {
    draw.cull = Cull::none;
    draw.depth_mode = DepthMode::none;
    draw.grid.reset();
  }
  const auto image = trial.draw(plain, kCountOnly);
  if (!image || image->samples != 1) return trial.verdict();
  trial.looked_at(expected.size());
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t e = element(*image, x, y);
      trial.expect_count("count", x, y, expected[e], image->count[e]);
    }
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"small-world-homogeneous", "C1-C4", "every triangle over {-1, 0, 1, 2}^3 in (X, Y, W) is the oracle's on 4 x 4",
     true, true, kHomogeneous, make_homogeneous, decide_all},
    {"small-world-half-pixel", "C3",
     "every triangle on the half-pixel lattice of 2 x 2, under every fill rule, is the oracle's", true, true,
     kHalfPixel, make_half_pixel, decide_all},
    {"small-world-octants", "T3",
     "every sign pattern of every triple over {-1, 0, 1, 3}^2 x {0, 1, 2} covers 2 x 2 once", false, true, kOctants,
     make_octants, decide_octants},
    {"small-world-shared-edge", "T1",
     "every two triangles that share an edge on a half-pixel lattice neither overlap nor gape", false, true,
     kSharedEdge, make_shared_edge, decide_shared_edge},
    {"small-world-homogeneous-rules", "C1-C3",
     "each of the 2,097,152 triangles over {-1, 0, 1, 2}^3 under the eight fill rules covers what integers say on 3 x "
     "3",
     false, true, kHomogeneousRules, make_homogeneous_rules, decide_by_integers},
    {"small-world-half-pixel-4", "C1-C3",
     "each of the 4,251,528 triangles on the half-pixel lattice of 4 x 4 under the eight fill rules, by integers",
     false, true, lattice_cases(2, 4), make_half_4, decide_by_integers},
    {"small-world-quarter-pixel", "C1-C3",
     "each of the 4,251,528 triangles on the quarter-pixel lattice of 2 x 2 under the eight fill rules, by integers",
     false, true, lattice_cases(4, 2), make_quarter_2, decide_by_integers},
    {"small-world-eighth-pixel", "C1-C3",
     "each of the 193,100,552 triangles on the eighth-pixel lattice of 2 x 2 under the eight fill rules, by integers",
     false, true, lattice_cases(8, 2), make_eighth_2, decide_by_integers},
    {"small-world-conservative", "M4",
     "each of the 117,649 triangles on the half-pixel lattice of 3 x 3, over and inner, by integers and separating "
     "axes",
     false, true, kConservative, make_conservative, decide_by_integers},
    {"small-world-conservative-w", "M4",
     "each of the 262,144 triangles over {-1, 0, 1, 2}^3 in (X, Y, W), over and inner, is the oracle's on 3 x 3", true,
     true, kHomogeneousConservative, make_homogeneous_conservative, decide_outputs},
    {"small-world-grid", "G1, G2",
     "every triangle over {-1, 0, 1, 2}^3 in (X, Y, W), snapped to whole pixels, is the oracle's on 3 x 3", true, true,
     kHomogeneous, make_snapped, decide_outputs},
};

}  // namespace

std::span<const Property> small_world_properties() {
  return kProperties;
}

}  // namespace surefill::properties
