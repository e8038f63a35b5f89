// SPDX-License-Identifier: Apache-2.0
//
// Which fragments are seen (V1 to V5, M5 of docs/semantics.md).
#ifndef SUREFILL_ORACLE_LAYERS_HPP
#define SUREFILL_ORACLE_LAYERS_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::oracle {

// What a triangle leaves at a sample, and who it is.
struct Fragment {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::uint32_t draw = kNone, triangle = 0;  // positions: in the frame, in the draw. kNone: no fragment
  std::uint32_t index = kNoTriangle;         // V2
  float depth = 0;                           // as stored

  bool exists() const { return draw != kNone; }
};

// The layers of some samples. Fragments come in the order of draws, those of a draw in any.
class Layers {
 public:
  // `initial` has one depth a sample, or none.
  Layers(DepthTest test, int layers, std::size_t samples, std::span<const float> initial);

  void add(std::size_t sample, const Fragment& fragment, bool depth_write);

  // Layer n of a sample; where it has no fragment, `depth` is what V1 says of such a sample.
  const Fragment& fragment(std::size_t n, std::size_t sample) const { return held_[sample * layers_ + n]; }
  float depth(std::size_t n, std::size_t sample) const;

 private:
  bool passes(float depth, float limit) const;
  bool precedes(const Fragment& a, const Fragment& b) const;
  void add_to_image(std::size_t sample, const Fragment& fragment, bool depth_write);

  DepthTest test_;
  std::size_t layers_;
  std::vector<float> initial_;  // or farther than all
  std::vector<float> stored_;   // with one layer, its depth
  std::vector<Fragment> held_;
};

}  // namespace surefill::oracle

#endif  // SUREFILL_ORACLE_LAYERS_HPP
