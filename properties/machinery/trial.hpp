// SPDX-License-Identifier: Apache-2.0
//
// What the properties have in common: drawing variants of a scene, collecting a verdict, and the lists of each theme.
#ifndef SUREFILL_PROPERTIES_CHECK_HPP
#define SUREFILL_PROPERTIES_CHECK_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::properties {

// One list a theme; all_properties() joins them.
std::span<const Property> equality_properties();
std::span<const Property> partition_properties();
std::span<const Property> degree_properties();
std::span<const Property> symmetry_properties();
std::span<const Property> value_properties();
std::span<const Property> frame_properties();
std::span<const Property> call_properties();
std::span<const Property> mode_properties();
std::span<const Property> output_properties();
std::span<const Property> split_properties();
std::span<const Property> small_world_properties();

inline constexpr corpus::Outputs kCountOnly{true, false, false, false, false, false, false};

// How the image of a changed scene shows the original one. What is left out is as in the original.
struct Correspondence {
  std::function<std::array<int, 2>(int x, int y)> pixel;         // of `actual`, for pixel (x, y) of `expected`
  std::array<std::size_t, 3> barycentrics{0, 1, 2};              // weight i of `expected` is this one of `actual`
  std::function<bool(const corpus::SceneAttribute&)> attribute;  // false: not compared
  std::function<bool(int x, int y)> where;                       // false: this pixel of `expected` is not compared
};

// Collects the verdict on one case.
class Trial {
 public:
  explicit Trial(const Renderer& renderer) : renderer_(renderer) {}

  // The renderer's image of the scene. When it returns another status than ok, that is a difference and there is no
  // image.
  std::optional<corpus::Image> draw(const corpus::Scene& scene, const corpus::Outputs& outputs);
  // The same, in buffers that hold this bit pattern before.
  std::optional<corpus::Image> draw_over(std::uint32_t garbage, const corpus::Scene& scene,
                                         const corpus::Outputs& outputs);
  // The same, with the draws changed in ways that a scene has no words for.
  using DrawChange = std::function<void(std::vector<Draw>& draws)>;
  std::optional<corpus::Image> draw_changed(const corpus::Scene& scene, const corpus::Outputs& outputs,
                                            const DrawChange& change);

  void looked_at(std::uint64_t samples) { verdict_.samples += samples; }
  void differs(const std::string& finding);
  // The finding: "WHAT at pixel (x, y): expected E, got A".
  void differs(std::string_view what, int x, int y, const std::string& expected, const std::string& actual);
  void expect_count(std::string_view what, int x, int y, std::uint32_t expected, std::uint32_t actual);
  void expect_index(std::string_view what, int x, int y, std::uint32_t expected, std::uint32_t actual);
  // At most so many: what more would say is not claimed.
  void expect_at_most(std::string_view what, int x, int y, std::uint32_t most, std::uint32_t actual);
  void expect_bits(std::string_view what, int x, int y, float expected, float actual);

  // Every output that both images have, bit for bit.
  void expect_same(std::string_view what, const corpus::Scene& scene, const corpus::Image& expected,
                   const corpus::Image& actual, const Correspondence& correspondence = {});

  // The image equals `inside` in the rectangle and `outside` everywhere else. `what` names the rectangle.
  void expect_parts(std::string_view what, const corpus::Scene& scene, const Scissor& rectangle,
                    const corpus::Image& inside, const corpus::Image& outside, const corpus::Image& actual);

  // Counts of the scene's front faces alone and of its back faces alone; none if a call fails.
  struct Facings {
    corpus::Image front, back;
  };
  std::optional<Facings> draw_facings(const corpus::Scene& scene);

  TrialResult verdict() const { return verdict_; }

 private:
  std::optional<corpus::Image> image_of(corpus::Frame& frame, std::span<const Draw> draws);
  void add_difference(std::string_view what, int x, int y, const std::string& expected, const std::string& actual);
  void show_pixel(std::string_view what, const char* output, int x, int y, std::uint32_t expected, std::uint32_t actual,
                  bool differs);

  const Renderer& renderer_;
  TrialResult verdict_;
};

std::string text(float value);

// The element of a buffer of one sample a pixel.
inline std::size_t element(const corpus::Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

// Scene building.
corpus::SceneVertex scene_vertex(const Vertex& vertex);
Vertex vertex_of(const corpus::SceneVertex& vertex);
corpus::Scene triangle_scene(int width, int height, const std::array<Vertex, 3>& vertices);
// The scene with this one triangle of it, under the draw's state.
corpus::Scene with_one_triangle(const corpus::Scene& scene, std::size_t draw, std::size_t triangle);

// Category and seed of case n: the categories take turns.
const Category& category_of_case(std::uint64_t n);
// The random scene of case n in which no draw has a viewport: its vertices are pixel-homogeneous as they stand.
corpus::Scene pixel_scene(std::uint64_t n, const SceneLimits& limits);

// The sign of det(m_0, m_1, m_2), exactly; 0 if a component is not finite.
int facing(const std::array<Vertex, 3>& triangle);
std::array<Vertex, 3> triangle_of(const corpus::SceneDraw& draw, const corpus::SceneTriangle& triangle);
bool finite(const Vertex& vertex);

// v * 2^exponent in X, Y, Z and W, or none if that is not exact.
std::optional<Vertex> scaled_exactly(const Vertex& vertex, int exponent);

// a + b, where it is a double, or a float32, exactly.
std::optional<double> exact_sum(double a, double b);
std::optional<float> exact_float_sum(double a, double b);

// The vertex moved by (dx, dy) pixels; dx and dy have few bits.
std::optional<Vertex> moved_exactly(const Vertex& vertex, double dx, double dy);

// Both scenes, without the triangles whose vertices `change` cannot map exactly.
using VertexChange = std::function<std::optional<Vertex>(const Vertex&)>;
std::pair<corpus::Scene, corpus::Scene> changed_exactly(corpus::Scene scene, const VertexChange& change);

// The triangle in three pieces that meet in i v0 + j v1 + k v2 (not all 0, none negative), which tile it over the
// reals: T1. Piece n has the new vertex in place of vertex n, and is left out if its weight is 0. The new vertex is
// exact, or there is none.
std::optional<Vertex> combined_exactly(const std::array<Vertex, 3>& triangle, const std::array<int, 3>& weights);
std::vector<std::array<Vertex, 3>> pieces_of(const std::array<Vertex, 3>& triangle, Random& random);

// Random choices of a property that depend on the case alone.
Random random_of(const corpus::Scene& scene);

// Without what names places of the target, so that the image can move.
corpus::Scene without_places(corpus::Scene scene);
// Without attributes, in scene and vertices.
corpus::Scene without_attributes(corpus::Scene scene);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_CHECK_HPP
