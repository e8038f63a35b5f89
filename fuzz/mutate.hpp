// SPDX-License-Identifier: Apache-2.0
//
// Mutations that know what a triangle is: they make the coincidences that chance never finds (equality of floats).
#ifndef SUREFILL_FUZZ_MUTATE_HPP
#define SUREFILL_FUZZ_MUTATE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "corpus/scene.hpp"
#include "fuzz/decode.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::fuzz {

// One to a few coincidences in the vertices, triangles or state of a scene. The scene stays one that its form encodes.
void mutate(corpus::Scene& scene, properties::Random& random);

// A scene with something of another: vertices, an edge in common, a draw, state, or the frame.
void cross(corpus::Scene& scene, const corpus::Scene& other, properties::Random& random);

// A form of scenes. Bytes from `size` on are no part of it and are kept, and so mostly are those from `kept_begin` to
// `kept_end`. A form that grows has room for more triangles. Targets have the sides that are given, or are changed by bytes alone.
struct Form {
  corpus::Scene (*decode)(std::span<const std::uint8_t>);
  std::optional<Bytes> (*encode)(const corpus::Scene&);
  std::size_t size;
  bool grows;
  std::size_t kept_begin = 0, kept_end = 0;
  std::span<const int> sides = {};
};
inline constexpr Form triangle_form{decode_triangle, encode_triangle, kTriangleBytes, false};
inline constexpr Form grid_triangle_form{decode_grid_triangle, encode_grid_triangle, kGridTriangleBytes, false};
inline constexpr Form scene_form{decode_scene, encode_scene, SIZE_MAX, true};
inline constexpr Form samples_form{decode_samples, encode_samples, SIZE_MAX, true};
inline constexpr Form paths_form{decode_paths, encode_paths, SIZE_MAX, true, 1, 3, kPathSides};

// Bodies of LLVMFuzzerCustomMutator and LLVMFuzzerCustomCrossOver: half of the time by the scene, else by bytes. With
// SUREFILL_FUZZ_PLAIN in the environment always by bytes, to see what the scenes are good for.
std::size_t mutate_bytes(const Form& form, std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);
std::size_t cross_bytes(const Form& form, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                        std::span<std::uint8_t> out, unsigned seed);

}  // namespace surefill::fuzz

// The two functions that libFuzzer looks for, for a target whose inputs have this form.
#define SUREFILL_FUZZ_MUTATORS(form)                                                                                  \
  extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,          \
                                                 unsigned seed) {                                                     \
    return surefill::fuzz::mutate_bytes(surefill::fuzz::form##_form, data, size, max_size, seed);                     \
  }                                                                                                                   \
  extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b,  \
                                                   std::size_t b_size, std::uint8_t* out, std::size_t out_size,       \
                                                   unsigned seed) {                                                   \
    return surefill::fuzz::cross_bytes(surefill::fuzz::form##_form, {a, a_size}, {b, b_size}, {out, out_size}, seed); \
  }

#endif  // SUREFILL_FUZZ_MUTATE_HPP
