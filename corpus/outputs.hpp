// SPDX-License-Identifier: Apache-2.0
//
// The outputs of a frame as a table, a row an output: its name, its places, and how many elements a sample has. Images,
// comparison and hashes are made from it. Attributes, whose number a scene chooses, and the numbers of triangles follow
// the rows.
#ifndef SUREFILL_CORPUS_OUTPUTS_HPP
#define SUREFILL_CORPUS_OUTPUTS_HPP

#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "corpus/scene.hpp"
#include "surefill/surefill.hpp"

namespace surefill::corpus {

template <typename Element>
struct Output {
  std::string_view name;
  std::span<Element> Target::*target;
  std::vector<Element> Image::*image;
  bool Outputs::*asked;
  std::size_t elements;  // a sample
  bool layered;          // each layer has it (V4)
  // Does the scene have it, in a frame with a conservative draw or without (M4)?
  bool (*has)(const Scene& scene, bool conservative);
};

inline bool is_conservative(const Scene& scene) {
  for (const SceneDraw& draw : scene.draws)
    if (draw.conservative != Conservative::none) return true;
  return false;
}

inline constexpr auto kOutputs = std::make_tuple(
    Output<std::uint32_t>{"count", &Target::count, &Image::count, &Outputs::count, 1, false,
                          [](const Scene&, bool) { return true; }},
    Output<std::uint32_t>{"index", &Target::index, &Image::index, &Outputs::index, 1, true,
                          [](const Scene& s, bool conservative) { return !conservative || s.more.conservative_index; }},
    Output<float>{"depth", &Target::depth, &Image::depth, &Outputs::depth, 1, true,
                  [](const Scene&, bool conservative) { return !conservative; }},
    Output<float>{"barycentrics", &Target::barycentrics, &Image::barycentrics, &Outputs::barycentrics, 3, true,
                  [](const Scene&, bool conservative) { return !conservative; }},
    Output<std::int32_t>{"winding", &Target::winding, &Image::winding, &Outputs::winding, 1, false,
                         [](const Scene& s, bool conservative) { return !conservative && s.more.winding; }});

// visit(output) for each row.
template <typename Visit>
constexpr void for_each_output(Visit&& visit) {
  std::apply([&](const auto&... outputs) { (visit(outputs), ...); }, kOutputs);
}

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_OUTPUTS_HPP
