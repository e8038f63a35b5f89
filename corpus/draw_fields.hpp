// SPDX-License-Identifier: Apache-2.0
//
// The state of a draw as a table, a row a field: its word in scenes, its member, and the words or ranges of its values.
// The scene reader and writer, reduction, equality, the fuzz decoder, messages to rivals (with the adapter's members in
// certify/rivals/draw_words.hpp) and Python's words are made from it.
#ifndef SUREFILL_CORPUS_DRAW_FIELDS_HPP
#define SUREFILL_CORPUS_DRAW_FIELDS_HPP

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>

#include "corpus/names.hpp"
#include "surefill/surefill.hpp"

namespace surefill::corpus {

template <typename Value>
struct DrawField {
  std::string_view name;
  Value DrawState::*member;
  std::string_view form = "";  // of the numbers of a structure, for messages; the words of an enumeration are its form
};

inline constexpr auto kDrawFields = std::make_tuple(
    DrawField<FillRule>{"fill-rule", &DrawState::fill_rule}, DrawField<FrontFace>{"front-face", &DrawState::front_face},
    DrawField<Cull>{"cull", &DrawState::cull}, DrawField<DepthMode>{"depth-mode", &DrawState::depth_mode},
    DrawField<bool>{"depth-write", &DrawState::depth_write},
    DrawField<Conservative>{"conservative", &DrawState::conservative},
    DrawField<std::optional<Scissor>>{"scissor", &DrawState::scissor, "X0 Y0 X1 Y1"},
    DrawField<std::optional<Grid>>{"grid", &DrawState::grid, "BITS OFFSET_X OFFSET_Y ROUNDING"},
    DrawField<std::optional<std::array<Vertex, 8>>>{"culling-box", &DrawState::culling_box, "X Y Z W of eight corners"},
    DrawField<std::optional<DepthBias>>{"depth-bias", &DrawState::depth_bias, "CONSTANT SLOPE"},
    DrawField<Primitive>{"primitive", &DrawState::primitive},
    DrawField<std::optional<float>>{"width", &DrawState::width, "PIXELS"});

// visit(field) for each row, in the order in which scenes are written.
template <typename Visit>
constexpr void for_each_draw_field(Visit&& visit) {
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, kDrawFields);
}

// True as soon as visit(field) is.
template <typename Visit>
constexpr bool any_draw_field(Visit&& visit) {
  return std::apply([&](const auto&... fields) { return (visit(fields) || ...); }, kDrawFields);
}

// A number of a structure, with the range that is accepted.
struct IntegerRange {
  int least, most;
};
struct FiniteNumber {};  // of a float that may not be a NaN or an infinity
inline constexpr FiniteNumber kFiniteNumber;
struct PositiveNumber {};  // of a finite float above 0
inline constexpr PositiveNumber kPositiveNumber;
inline constexpr IntegerRange kAnyInteger{std::numeric_limits<int>::min(), std::numeric_limits<int>::max()};

// visit(part, range) for a whole number, visit(part, kFiniteNumber) for a finite float, kPositiveNumber if it is above 0
// too, visit(part) for any float or an enumerator: the parts of a structure in the order in which scenes have them. `Structure` may be const.
template <typename Structure, typename Visit>
void for_each_part(Structure& value, Visit&& visit) {
  using Plain = std::remove_const_t<Structure>;
  if constexpr (std::is_same_v<Plain, Scissor>) {
    visit(value.x0, kAnyInteger), visit(value.y0, kAnyInteger), visit(value.x1, kAnyInteger),
        visit(value.y1, kAnyInteger);
  } else if constexpr (std::is_same_v<Plain, Grid>) {
    visit(value.bits, IntegerRange{0, 12}), visit(value.offset_x, IntegerRange{0, 15}),
        visit(value.offset_y, IntegerRange{0, 15}), visit(value.rounding);
  } else if constexpr (std::is_same_v<Plain, DepthBias>) {
    visit(value.constant, kFiniteNumber), visit(value.slope, kFiniteNumber);
  } else if constexpr (std::is_same_v<Plain, float>) {
    visit(value, kPositiveNumber);  // a width
  } else {
    static_assert(std::is_same_v<Plain, std::array<Vertex, 8>>);
    for (auto& corner : value) visit(corner.x), visit(corner.y), visit(corner.z), visit(corner.w);
  }
}

// The number of parts.
template <typename Structure>
std::size_t parts_of() {
  Structure value{};
  std::size_t parts = 0;
  for_each_part(value, [&](const auto&...) { ++parts; });
  return parts;
}

template <typename Value>
inline constexpr bool kIsOptional = false;
template <typename Value>
inline constexpr bool kIsOptional<std::optional<Value>> = true;

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_DRAW_FIELDS_HPP
