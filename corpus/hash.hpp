// SPDX-License-Identifier: Apache-2.0
//
// An image as one number, the same on every machine: what corpus/hashes.txt holds for each scene.
#ifndef SUREFILL_CORPUS_HASH_HPP
#define SUREFILL_CORPUS_HASH_HPP

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "corpus/outputs.hpp"
#include "corpus/scene.hpp"
#include "surefill/surefill.hpp"

namespace surefill::corpus {

// FNV-1a of 64 bits, over the bytes of words from the lowest up.
class Hash {
 public:
  void add(std::uint32_t word) {
    for (int i = 0; i < 4; ++i) value_ = (value_ ^ (word >> (8 * i) & 0xFF)) * 0x100000001B3u;
  }
  void add(const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words) add(word);
  }
  void add(const std::vector<std::int32_t>& words) {
    for (const std::int32_t word : words) add(static_cast<std::uint32_t>(word));
  }
  void add(const std::vector<std::uint64_t>& numbers) {
    for (const std::uint64_t n : numbers) add(static_cast<std::uint32_t>(n)), add(static_cast<std::uint32_t>(n >> 32));
  }
  void add(const std::vector<float>& values) {
    for (const float value : values) add(std::bit_cast<std::uint32_t>(value));
  }
  // Sixteen hexadecimal digits.
  std::string text() const {
    std::string digits;
    for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[value_ >> shift & 0xF];
    return digits;
  }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

// Of every output of the scene, drawn with these options; what the status says, where it is not ok.
inline std::string hash_of(const Scene& scene, const Options& options, Statistics* statistics = nullptr) {
  Frame frame(scene);
  const Status status = render(frame.target(), frame.draws(), statistics, options);
  if (status != Status::ok) return status_text(status);
  const Image& image = frame.image();
  Hash hash;
  for_each_output([&](const auto& output) { hash.add(image.*output.image); });
  for (const auto& attribute : image.attributes) hash.add(attribute);
  for (const auto& covered : image.covered) hash.add(covered);
  for (const auto& visible : image.visible) hash.add(visible);
  return hash.text();
}

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_HASH_HPP
