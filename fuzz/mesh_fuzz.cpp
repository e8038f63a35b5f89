// SPDX-License-Identifier: Apache-2.0
//
// The theorems that need no oracle, on meshes built from the input's vertices (the form is that of scenes):
//   T1  the Delaunay triangulation of points within and of a frame around the target covers each sample once, whatever
//       the vertices' scale, the order and the facing of the triangles;
//   T2  a closed double pyramid covers every sample equally often from the front as from the back, up to one constant;
//   T3  of the eight triangles (+-v0, +-v1, +-v2) exactly one covers each sample.
#include <cmath>
#include <string>
#include <vector>

#include "fuzz/finding.hpp"
#include "fuzz/mutate.hpp"
#include "properties/generators/meshes.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::fuzz {
namespace {

using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

// The coverage counts of a scene.
std::vector<std::uint32_t> counts_of(const Scene& scene) {
  note_scene([&] { return scene; });
  corpus::Frame frame(scene, properties::kCountOnly);
  if (const Status status = render(frame.target(), frame.draws()); status != Status::ok) {
    report_finding("mesh", std::string("the engine refuses a valid scene: ") + status_text(status),
                   corpus::write_scene(scene));
  }
  return frame.image().count;
}

// An empty scene with the frame and the fill rule of another.
Scene frame_of(const Scene& from) {
  Scene scene;
  scene.width = from.width;
  scene.height = from.height;
  scene.samples = from.samples;
  scene.draws.resize(1);
  if (from.draws[0].fill_rule <= FillRule::northwards_west) scene.draws[0].fill_rule = from.draws[0].fill_rule;  // T1
  return scene;
}

void expect_one(const Scene& scene, const char* theorem) {
  for (const std::uint32_t count : counts_of(scene)) {
    if (count != 1) {
      report_finding("mesh", std::string(theorem) + ": a sample is covered " + std::to_string(count) + " times",
                     corpus::write_scene(scene));
    }
  }
}

// T1. Points are (x, y) of the vertices, where they lie in the frame. A vertex is scaled by a power of two, which is
// exact, so that neighbours of one point differ in W.
void check_partition(const Scene& input) {
  constexpr float kMargin = 1;
  const auto right = static_cast<float>(input.width) + kMargin, bottom = static_cast<float>(input.height) + kMargin;
  std::vector<std::array<float, 2>> points{
      {-kMargin, -kMargin}, {right, -kMargin}, {-kMargin, bottom}, {right, bottom}};
  std::vector<int> exponents{0, 3, -2, 1};
  for (const SceneVertex& v : input.draws[0].vertices) {
    if (!(v.x >= -kMargin && v.x <= right && v.y >= -kMargin && v.y <= bottom)) continue;
    points.push_back({v.x, v.y});
    const int exponent = std::isfinite(v.w) && v.w != 0 ? std::ilogb(v.w) : 0;
    exponents.push_back(exponent % 8);
  }
  Scene scene = frame_of(input);
  SceneDraw& draw = scene.draws[0];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float w = std::ldexp(1.0f, exponents[i]), x = points[i][0] * w, y = points[i][1] * w;
    if (x / w != points[i][0] || y / w != points[i][1]) return;  // underflow: another point
    draw.vertices.push_back({x, y, 0, w, {}});
  }
  for (const properties::Indices& t : properties::delaunay(points)) {
    const std::size_t n = draw.triangles.size();
    const bool turned = n < input.draws[0].triangles.size() && input.draws[0].triangles[n].vertices[0] % 2 == 1;
    draw.triangles.push_back({turned ? properties::Indices{t[1], t[0], t[2]} : t, {}});
  }
  expect_one(scene, "T1");
}

// T3, for the first triangle.
void check_octants(const Scene& input) {
  const SceneDraw& from = input.draws[0];
  if (from.triangles.empty() || properties::facing(properties::triangle_of(from, from.triangles[0])) == 0) return;
  Scene scene = frame_of(input);
  SceneDraw& draw = scene.draws[0];
  for (const std::uint32_t v : from.triangles[0].vertices) {
    const SceneVertex& plus = from.vertices[v];
    draw.vertices.push_back({plus.x, plus.y, 0, plus.w, {}});
    draw.vertices.push_back({-plus.x, -plus.y, 0, -plus.w, {}});
  }
  for (std::uint32_t signs = 0; signs < 8; ++signs) {
    draw.triangles.push_back({{signs & 1u, 2 + (signs >> 1 & 1u), 4 + (signs >> 2)}, {}});
  }
  expect_one(scene, "T3");
}

// T2. Two apexes and a ring. D != 0 for every face, so that none contains the eye.
void check_degree(const Scene& input) {
  const std::vector<SceneVertex>& vertices = input.draws[0].vertices;
  if (vertices.size() < 5) return;
  Scene scene = frame_of(input);
  SceneDraw& draw = scene.draws[0];
  for (const SceneVertex& v : vertices) draw.vertices.push_back({v.x, v.y, 0, v.w, {}});
  const auto ring = static_cast<std::uint32_t>(vertices.size()) - 2;
  for (std::uint32_t i = 0; i < ring; ++i) {
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % ring;
    draw.triangles.push_back({{0, here, next}, {}});
    draw.triangles.push_back({{1, next, here}, {}});
  }
  for (const corpus::SceneTriangle& triangle : draw.triangles) {
    if (properties::facing(properties::triangle_of(draw, triangle)) == 0) return;
  }
  draw.cull = Cull::back;
  const std::vector<std::uint32_t> front = counts_of(scene);
  draw.cull = Cull::front;
  const std::vector<std::uint32_t> back = counts_of(scene);
  draw.cull = Cull::none;
  const auto degree = [&](std::size_t s) { return static_cast<int>(front[s]) - static_cast<int>(back[s]); };
  for (std::size_t s = 1; s < front.size(); ++s) {
    if (degree(s) != degree(0)) {
      report_finding("mesh",
                     "T2: front minus back covers are " + std::to_string(degree(0)) + " at sample 0, and " +
                         std::to_string(degree(s)) + " at sample " + std::to_string(s),
                     corpus::write_scene(scene));
    }
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  const surefill::corpus::Scene scene = decode_scene({data, size});
  check_partition(scene);
  check_octants(scene);
  check_degree(scene);
  return 0;
}

SUREFILL_FUZZ_MUTATORS(scene)
