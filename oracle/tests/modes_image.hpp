// SPDX-License-Identifier: Apache-2.0
//
// For the tests of the modes: draws that own what they point to, and images of all outputs.
#ifndef SUREFILL_ORACLE_TESTS_MODES_IMAGE_HPP
#define SUREFILL_ORACLE_TESTS_MODES_IMAGE_HPP

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oracle/oracle.hpp"

namespace surefill::modes {

using Render = void (*)(const Target&, std::span<const Draw>, int);
struct Oracle {
  const char* name;
  Render render;
};
inline void PrintTo(const Oracle& oracle, std::ostream* out) {
  *out << oracle.name;
}
inline constexpr Oracle kOracles[] = {{"the first oracle", oracle::render},
                                      {"the second oracle", oracle::clipped::render}};

inline constexpr Interpolation kInterpolations[] = {Interpolation::perspective, Interpolation::noperspective,
                                                    Interpolation::flat};

// Triangles, lines or points with one value a vertex, drawn as three attributes of different interpolation.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices, identifiers;  // without indices: one vertex after another
  std::vector<float> values;
  Draw state;

  Mesh() = default;
  explicit Mesh(std::vector<Vertex> v, std::vector<float> u = {}) : vertices(std::move(v)), values(std::move(u)) {
    for (std::uint32_t i = 0; i < vertices.size(); ++i) indices.push_back(i);
  }
  std::size_t primitives() const {
    return indices.size() / (state.primitive == Primitive::triangles ? 3u
                             : state.primitive == Primitive::lines   ? 2u
                                                                     : 1u);
  }
};

// A frame, and what a call makes of it. Every output that the frame may have is asked for, attributes if all draws have
// values.
struct Image {
  struct Asked {
    int width = 1, height = 1, samples = 1, layers = 1;
    DepthTest depth_test = DepthTest::less;
    AttributeLocation attribute_location = AttributeLocation::centre;
    Origin origin = {};
    std::vector<SampleLocation> places = {};
    std::vector<float> initial_depth = {};
  };
  std::vector<std::uint32_t> count, index;
  std::vector<std::int32_t> winding;
  std::vector<std::uint32_t> depth, barycentrics, attributes[3];  // bits
  std::vector<std::vector<std::uint64_t>> covered, visible;       // of each draw
  bool operator==(const Image&) const = default;
};

inline std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> result;
  for (const float value : values) result.push_back(std::bit_cast<std::uint32_t>(value));
  return result;
}

inline Image render(Render oracle, const Image::Asked& asked, const std::vector<Mesh>& meshes, int threads = 1) {
  Image image;
  Target target;
  target.width = asked.width, target.height = asked.height, target.samples = asked.samples;
  target.layers = asked.layers, target.depth_test = asked.depth_test, target.origin = asked.origin;
  target.attribute_location = asked.attribute_location;
  target.sample_locations = asked.places;
  target.initial_depth = asked.initial_depth;
  const auto total = static_cast<std::size_t>(asked.width * asked.height * asked.samples);
  const std::size_t all = total * static_cast<std::size_t>(asked.layers);

  bool conservative = false, have_values = !meshes.empty();
  std::vector<std::array<AttributeArray, 3>> arrays(meshes.size());
  std::vector<Draw> draws;
  image.covered.resize(meshes.size()), image.visible.resize(meshes.size());
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    const Mesh& mesh = meshes[n];
    Draw& draw = draws.emplace_back(mesh.state);
    draw.vertices = mesh.vertices, draw.indices = mesh.indices, draw.identifiers = mesh.identifiers;
    for (std::size_t k = 0; k < 3; ++k) {
      arrays[n][k].values = mesh.values;
      arrays[n][k].interpolation = kInterpolations[k];
    }
    if (!mesh.values.empty()) draw.attributes = arrays[n];
    have_values &= !mesh.values.empty();
    conservative |= draw.conservative != Conservative::none;
  }
  const auto ask = [](auto& values, std::size_t size) {
    values.assign(size, 99);
    return std::span(values);
  };
  target.count = ask(image.count, total);
  target.index = ask(image.index, all);
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    draws[n].covered = ask(image.covered[n], meshes[n].primitives());
    if (!conservative) draws[n].visible = ask(image.visible[n], meshes[n].primitives());
  }
  std::vector<float> depth, barycentrics, attributes[3];
  std::array<AttributeTarget, 3> outs;
  if (!conservative) {
    target.winding = ask(image.winding, total);
    target.depth = ask(depth, all);
    target.barycentrics = ask(barycentrics, 3 * all);
    if (have_values) {
      for (std::size_t k = 0; k < 3; ++k) outs[k].values = ask(attributes[k], all);
      target.attributes = outs;
    }
  }
  oracle(target, draws, threads);
  image.depth = bits(depth), image.barycentrics = bits(barycentrics);
  for (std::size_t k = 0; k < 3; ++k) image.attributes[k] = bits(attributes[k]);
  return image;
}

// Rows of numbers, '/' between them: '.' for 0 (for kNoTriangle, of an index), '-' and 'a', 'b', ... for -1, -2, ...
template <typename Number>
std::string picture(const std::vector<Number>& numbers, int row) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && i % static_cast<std::size_t>(row) == 0) text += '/';
    const auto number = static_cast<std::int32_t>(numbers[i]);
    text += static_cast<char>(number == 0 ? '.' : number > 0 ? '0' + number : number == -1 ? '-' : 'a' - 2 - number);
  }
  return text;
}
inline std::string indices(const std::vector<std::uint32_t>& index) {
  std::string text;
  for (const std::uint32_t i : index) text += i == kNoTriangle ? '.' : static_cast<char>('0' + i);
  return text;
}

inline Vertex flat(float x, float y, float z = 0) {
  return {x, y, z, 1};
}

}  // namespace surefill::modes

#endif  // SUREFILL_ORACLE_TESTS_MODES_IMAGE_HPP
