// SPDX-License-Identifier: Apache-2.0
//
// Mutations that know what a triangle is: they make the coincidences that chance never finds (equality of floats).
#ifndef SUREFILL_FUZZ_MUTATE_HPP
#define SUREFILL_FUZZ_MUTATE_HPP

#include <cstddef>
#include <cstdint>

#include "corpus/scene.hpp"
#include "fuzz/decode.hpp"
#include "properties/generators.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace surefill::fuzz {

// One to a few coincidences in the vertices, triangles or state of a scene. The scene stays one that its form encodes.
void mutate(corpus::Scene& scene, properties::Random& random);

// Bodies of LLVMFuzzerCustomMutator: half of the time a mutation of the scene, else LLVMFuzzerMutate on the bytes.
// Bytes after the form of a triangle are kept.
std::size_t mutate_triangle_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);
std::size_t mutate_scene_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_MUTATE_HPP
