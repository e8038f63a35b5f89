// SPDX-License-Identifier: Apache-2.0
//
// The words of the scene format for enumerators: one table for the reader and the writer. Internal to the format.
#ifndef SUREFILL_CORPUS_NAMES_HPP
#define SUREFILL_CORPUS_NAMES_HPP

#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include "corpus/scene.hpp"
#include "surefill/surefill.hpp"

namespace surefill::corpus {

template <typename Enum, std::size_t Count>
using Names = std::array<std::pair<Enum, std::string_view>, Count>;

inline constexpr Names<FillRule, 10> kFillRuleNames{{{FillRule::top_left, "top-left"},
                                                     {FillRule::top_right, "top-right"},
                                                     {FillRule::bottom_left, "bottom-left"},
                                                     {FillRule::bottom_right, "bottom-right"},
                                                     {FillRule::southwards, "southwards"},
                                                     {FillRule::southwards_west, "southwards-west"},
                                                     {FillRule::northwards, "northwards"},
                                                     {FillRule::northwards_west, "northwards-west"},
                                                     {FillRule::closed, "closed"},
                                                     {FillRule::open, "open"}}};
inline constexpr Names<Primitive, 3> kPrimitiveNames{
    {{Primitive::triangles, "triangles"}, {Primitive::lines, "lines"}, {Primitive::points, "points"}}};
inline constexpr Names<FrontFace, 2> kFrontFaceNames{
    {{FrontFace::clockwise, "clockwise"}, {FrontFace::counter_clockwise, "counter-clockwise"}}};
inline constexpr Names<Cull, 3> kCullNames{{{Cull::none, "none"}, {Cull::front, "front"}, {Cull::back, "back"}}};
inline constexpr Names<DepthTest, 4> kDepthTestNames{{{DepthTest::less, "less"},
                                                      {DepthTest::greater, "greater"},
                                                      {DepthTest::less_equal, "less-equal"},
                                                      {DepthTest::greater_equal, "greater-equal"}}};
inline constexpr Names<DepthMode, 3> kDepthModeNames{
    {{DepthMode::none, "none"}, {DepthMode::clip, "clip"}, {DepthMode::clamp, "clamp"}}};
inline constexpr Names<Interpolation, 3> kInterpolationNames{{{Interpolation::perspective, "perspective"},
                                                              {Interpolation::noperspective, "noperspective"},
                                                              {Interpolation::flat, "flat"}}};
inline constexpr Names<AttributeLocation, 2> kAttributeLocationNames{
    {{AttributeLocation::centre, "centre"}, {AttributeLocation::centroid, "centroid"}}};
inline constexpr Names<Conservative, 5> kConservativeNames{{{Conservative::none, "none"},
                                                            {Conservative::over, "over"},
                                                            {Conservative::inner, "inner"},
                                                            {Conservative::overlap, "overlap"},
                                                            {Conservative::touched, "touched"}}};
inline constexpr Names<GridRounding, 3> kGridRoundingNames{{{GridRounding::nearest_even, "nearest-even"},
                                                            {GridRounding::nearest_up, "nearest-up"},
                                                            {GridRounding::truncate, "truncate"}}};
inline constexpr Names<ClipDepth, 2> kClipDepthNames{
    {{ClipDepth::zero_to_one, "zero-to-one"}, {ClipDepth::minus_one_to_one, "minus-one-to-one"}}};
inline constexpr Names<ClipY, 2> kClipYNames{{{ClipY::up, "y-up"}, {ClipY::down, "y-down"}}};
inline constexpr Names<bool, 2> kSwitchNames{{{true, "on"}, {false, "off"}}};

// The keyword of one primitive.
inline constexpr std::array<std::string_view, 3> kPrimitiveWords{"triangle", "line", "point"};

// The words of what a scene asks for beyond the usual outputs.
inline constexpr std::array<std::pair<std::string_view, bool MoreOutputs::*>, 3> kMoreOutputs{
    {{"winding", &MoreOutputs::winding},
     {"numbers", &MoreOutputs::numbers},
     {"conservative-index", &MoreOutputs::conservative_index}}};

// The table of an enumeration, found by its type.
template <typename Enum>
constexpr const auto& names_of() {
  if constexpr (std::is_same_v<Enum, FillRule>) {
    return kFillRuleNames;
  } else if constexpr (std::is_same_v<Enum, FrontFace>) {
    return kFrontFaceNames;
  } else if constexpr (std::is_same_v<Enum, Primitive>) {
    return kPrimitiveNames;
  } else if constexpr (std::is_same_v<Enum, Cull>) {
    return kCullNames;
  } else if constexpr (std::is_same_v<Enum, DepthMode>) {
    return kDepthModeNames;
  } else if constexpr (std::is_same_v<Enum, Conservative>) {
    return kConservativeNames;
  } else if constexpr (std::is_same_v<Enum, GridRounding>) {
    return kGridRoundingNames;
  } else {
    static_assert(std::is_same_v<Enum, bool>);
    return kSwitchNames;
  }
}

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_NAMES_HPP
