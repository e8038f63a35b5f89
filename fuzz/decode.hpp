// SPDX-License-Identifier: Apache-2.0
//
// Bytes to scenes and back. Each decoder is total: every input means a valid scene, missing bytes are 0, bytes past the
// end of the form are ignored. The forms are stable: stored inputs keep their meaning. An encoder is the decoder's
// inverse: decode(*encode(s)) equals s bit for bit wherever a scene fits the form, and every decoded scene fits.
#ifndef SUREFILL_FUZZ_DECODE_HPP
#define SUREFILL_FUZZ_DECODE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::fuzz {

using Bytes = std::vector<std::uint8_t>;

// Reads little-endian values from the front; zeros after the end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool at_end() const { return next_ >= bytes_.size(); }
  std::uint8_t byte() { return at_end() ? std::uint8_t{0} : bytes_[next_++]; }
  std::uint32_t below(std::uint32_t n) { return byte() % n; }  // 1 <= n <= 256
  std::uint32_t word();
  float real();  // the raw bits, so infinities and NaNs, too

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
};

// Targets of the forms: at most kMaxSide[log2(samples)] pixels each way, so that at most 256 samples are compared.
inline constexpr int kMaxSide[] = {16, 11, 8, 5, 4};

// One triangle, with at most one attribute of one component ("a0"):
//   0..47  X, Y, Z, W of the vertices 0, 1, 2; raw bits
//   48     width - 1 (low four bits) and height - 1, each modulo the largest side
//   49     bits 0-2 log2(samples) modulo 5, 3 depth test, 4 attribute location, 5-6 interpolation (3: no attribute)
//   50..53 fill rule, front face, culling, depth mode, each modulo the number of its values
//   54..65 the attribute at the vertices 0, 1, 2; raw bits
// and under Grid also
//   66     bits modulo 13
//   67     offset_x (low four bits) and offset_y
//   68     rounding modulo 3
inline constexpr std::size_t kTriangleBytes = 66, kGridTriangleBytes = 69;
corpus::Scene decode_triangle(std::span<const std::uint8_t> bytes);
corpus::Scene decode_grid_triangle(std::span<const std::uint8_t> bytes);

// One draw of one triangle with the vertices 0 1 2 and no state beyond the above; else none.
std::optional<Bytes> encode_triangle(const corpus::Scene& scene);
std::optional<Bytes> encode_grid_triangle(const corpus::Scene& scene);

// The same without heap, which under the address sanitizer costs more than the oracle.
struct OneTriangle : DrawState {
  std::array<Vertex, 3> vertices{};
  std::array<float, 3> attribute{};
  std::optional<Interpolation> interpolation;  // none: no attribute
  int width = 1, height = 1, samples = 1;
  DepthTest depth_test{};
  AttributeLocation attribute_location{};
};
OneTriangle decode_one(std::span<const std::uint8_t> bytes, bool with_grid);
corpus::Scene scene_of(const OneTriangle& triangle);

// Several draws of indexed triangles with every state of the format. Points and lines have no place in it. Attributes
// are named "a0", "a1", ...; other names, and the comment, are lost. A culling box is one whose corners are the draw's
// vertices in turn: the hull that M6 asks for is then certain.
inline constexpr std::size_t kMaxDraws = 4, kMaxSceneAttributes = 4, kMaxVertices = 15, kMaxTriangles = 8;
corpus::Scene decode_scene(std::span<const std::uint8_t> bytes);

// None if the scene does not fit: too many of anything, points, lines, another kind of culling box, or a scissor edge
// that is neither in -126..126 nor the least or largest int.
std::optional<Bytes> encode_scene(const corpus::Scene& scene);

// The same form with two samples a pixel or more: where it says one there are four.
corpus::Scene decode_samples(std::span<const std::uint8_t> bytes);
std::optional<Bytes> encode_samples(const corpus::Scene& scene);

// Frames that the fast path draws, on targets of several tiles and bands, and how it draws them:
//   0  bits 0-2 width, 3-5 height: kPathSides of them; if both are over 32, the height is 16, for speed
//   1  bits 0-3 the instruction set, by its number among those of this machine, 4-7 threads: 13, 14, 15 mean 2, 3, 8,
//      the others one
//   2  bits 0-2: no count, index, depth; all of bits 3-4 set: barycentrics and attributes, too (a scene with a
//      conservative draw has counts alone); bits 5-7: 7 streams the coverage, too, 6 gives the threads of an executor
//   3  a scene; its size and all of its initial depths but one are ignored, and its samples are halved until at most
//      kMostPathSamples are drawn, but not below two
inline constexpr int kPathSides[8] = {16, 8, 20, 32, 65, 72, 129, 136};
inline constexpr int kMostPathSamples = 136 * 32 * 2;
inline constexpr std::size_t kPathPrefix = 3;
corpus::Scene decode_paths(std::span<const std::uint8_t> bytes);
std::optional<Bytes> encode_paths(const corpus::Scene& scene);  // bytes 1 and 2 are 0

// The triangles of a scene, each as a scene that encode_triangle or, under Grid, encode_grid_triangle takes: mapped
// through the viewport, the target cropped to the largest size, the first component of the first attribute kept.
std::vector<corpus::Scene> single_triangles(const corpus::Scene& scene);

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_DECODE_HPP
