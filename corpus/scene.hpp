// SPDX-License-Identifier: Apache-2.0
//
// The scene: everything that defines one image, as plain owned data, and its text form (docs/scene-format.md).
// One reader and one writer, here. Tests, fuzzers, certify, reduction and adapters all speak scenes.
#ifndef SUREFILL_CORPUS_SCENE_HPP
#define SUREFILL_CORPUS_SCENE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::corpus {

inline constexpr int kSceneVersion = 1;

// A primitive of a draw: vertex numbers of that draw, and the caller's identifier where the draw has them. Where the draw's
// primitive is lines or points, the numbers that it does not need are the last one that it does.
struct SceneTriangle {
  std::array<std::uint32_t, 3> vertices{};
  std::optional<std::uint32_t> identifier;
};

// The vertices of a primitive: 3, 2 or 1.
constexpr std::size_t corners_of(Primitive primitive) {
  return primitive == Primitive::triangles ? 3 : primitive == Primitive::lines ? 2 : 1;
}

// An attribute of every vertex of every draw of the scene.
struct SceneAttribute {
  std::string name;  // [A-Za-z_][A-Za-z0-9_-]*, unique in the scene
  std::uint32_t components = 1;
  Interpolation interpolation = Interpolation::perspective;
};

// A vertex as written. Pixel-homogeneous (S2), or clip space where the draw has a viewport (S3).
struct SceneVertex {
  float x = 0, y = 0, z = 0, w = 1;
  std::vector<float> attributes;  // the components of the scene's attributes, one after the other
};

// `viewport` set: the vertices are clip coordinates and pass through `to_pixel` before they are drawn.
struct SceneDraw : DrawState {
  std::optional<Viewport> viewport;
  std::vector<SceneVertex> vertices;
  std::vector<SceneTriangle> triangles;      // all have an identifier, or none
  std::optional<std::uint32_t> first_index;  // unset: the number of triangles in the draws before this one
  // Of the scene's attributes, in their order, where this draw interpolates them in a way of its own (V3).
  std::vector<std::optional<Interpolation>> interpolations;
};

// What a scene asks for beyond what every scene does.
struct MoreOutputs {
  bool winding = false;  // M9
  bool numbers = false;  // covered and visible samples of each triangle; no visible where a draw is conservative (M10)
  bool conservative_index = false;  // the index where a draw is conservative (M4c)
  bool operator==(const MoreOutputs&) const = default;
};

struct Scene {
  std::string comment;  // the comment lines at the head of the file, without "# ", joined by '\n': title, origin, cause
  int width = 1, height = 1;
  int samples = 1;
  DepthTest depth_test = DepthTest::less;
  AttributeLocation attribute_location = AttributeLocation::centre;
  Origin origin;
  std::vector<SampleLocation> sample_locations;  // empty: the standard ones; else one for each sample
  int layers = 1;
  MoreOutputs more;
  std::vector<float> initial_depth;  // empty, one value for all samples, or one a sample
  std::vector<SceneAttribute> attributes;
  std::vector<SceneDraw> draws;
};

// What the reader throws. what() is one line "FILE:LINE: cause".
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Reads the text form. `file` is the name used in messages. Refuses what it does not know: another version, unknown or
// repeated keywords, out-of-range numbers, sizes outside S5, vertex numbers that name no vertex, missing attribute
// values, identifiers on some triangles only. Throws SceneError.
Scene read_scene(std::string_view text, std::string_view file = "scene");

// Reads a file. Throws SceneError, also when the file is missing, a directory or unreadable.
Scene read_scene_file(const std::string& path);

// The text form: hexfloats, fields of default value left out. read_scene(write_scene(s)) equals s bit for bit
// (NaNs as "nan": payload and sign are not kept).
std::string write_scene(const Scene& scene);

// Writes through a temporary file in the same folder and a rename, so that no half-written file is ever seen.
// Throws SceneError "FILE: cause".
void write_scene_file(const Scene& scene, const std::string& path);

// Bitwise equality of everything that is written (all NaNs are alike).
bool equal(const Scene& a, const Scene& b);

// Paths of the *.scene files below `directory`, sorted. Throws SceneError if there are none or it cannot be read:
// an empty corpus is a failure.
std::vector<std::string> list_corpus(const std::string& directory);

// An image with its buffers; which of them are asked for is chosen at construction.
struct Outputs {
  bool count = true, index = true, depth = true, barycentrics = true, attributes = true;
  bool winding = true, numbers = true;  // of a scene that asks for them
};
struct Image {
  int width = 0, height = 0, samples = 1, layers = 1;
  std::vector<std::uint32_t> count, index;
  std::vector<std::int32_t> winding;
  std::vector<std::vector<std::uint64_t>> covered, visible;  // of each draw
  std::vector<float> depth, barycentrics;
  std::vector<std::vector<float>> attributes;
};

// The engine's view of a scene: converts vertices to pixel space, holds the arrays that the spans point into.
// Not movable once made; the scene may be destroyed.
class Frame {
 public:
  explicit Frame(const Scene& scene, const Outputs& outputs = {});
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  const Target& target() const { return target_; }  // its spans point into image()
  std::span<const Draw> draws() const { return draws_; }
  const Image& image() const { return image_; }
  Image& image() { return image_; }

 private:
  struct DrawStorage;
  std::vector<DrawStorage> storage_;  // one for each draw
  std::vector<Draw> draws_;
  std::vector<AttributeTarget> attribute_targets_;
  std::vector<float> initial_depth_;
  std::vector<SampleLocation> sample_locations_;
  Target target_;
  Image image_;

 public:
  ~Frame();
};

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_SCENE_HPP
