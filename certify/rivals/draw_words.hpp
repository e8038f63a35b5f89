// SPDX-License-Identifier: Apache-2.0
//
// The state of a draw in version 1 of the adapter, as a table, a row a field of the table of fields: its words, in the
// order of a message, and the way there and back. From it come what a rival is given, what a message holds, and what a
// plugin in C++ reads; a field without a row here has no word in version 1, and no rival of that version is given it.
#ifndef SUREFILL_CERTIFY_ADAPTERS_DRAW_WORDS_HPP
#define SUREFILL_CERTIFY_ADAPTERS_DRAW_WORDS_HPP

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "certify/adapter.h"
#include "corpus/draw_fields.hpp"

namespace surefill::adapters {

// The words of an enumeration or a flag: one, whose values up to `most` version 1 has.
template <typename Value>
struct PlainWord {
  Value DrawState::*field;
  std::uint32_t surefill_adapter_draw::*word;
  Value most;
};

// The words of an optional structure: whether it is there, then its parts.
template <typename Structure>
struct StructureWords {
  std::optional<Structure> DrawState::*field;
  std::uint32_t surefill_adapter_draw::*present;
};

inline constexpr auto kDrawWords = std::make_tuple(
    PlainWord<FillRule>{&DrawState::fill_rule, &surefill_adapter_draw::fill_rule, FillRule::northwards_west},
    PlainWord<FrontFace>{&DrawState::front_face, &surefill_adapter_draw::front_face, FrontFace::counter_clockwise},
    PlainWord<Cull>{&DrawState::cull, &surefill_adapter_draw::cull, Cull::back},
    PlainWord<DepthMode>{&DrawState::depth_mode, &surefill_adapter_draw::depth_mode, DepthMode::clamp},
    PlainWord<bool>{&DrawState::depth_write, &surefill_adapter_draw::depth_write, true},
    PlainWord<Conservative>{&DrawState::conservative, &surefill_adapter_draw::conservative, Conservative::inner},
    StructureWords<Scissor>{&DrawState::scissor, &surefill_adapter_draw::has_scissor},
    StructureWords<Grid>{&DrawState::grid, &surefill_adapter_draw::has_grid});

// visit(part, word) for each part of a structure. Each may be const.
template <typename Parts, typename AdapterDraw, typename Visit>
void for_each_part_word(Parts& parts, AdapterDraw& draw, Visit&& visit) {
  if constexpr (std::is_same_v<std::remove_const_t<Parts>, Scissor>) {
    visit(parts.x0, draw.scissor[0]), visit(parts.y0, draw.scissor[1]);
    visit(parts.x1, draw.scissor[2]), visit(parts.y1, draw.scissor[3]);
  } else {
    static_assert(std::is_same_v<std::remove_const_t<Parts>, Grid>);
    visit(parts.bits, draw.grid_bits), visit(parts.rounding, draw.grid_rounding);
    visit(parts.offset_x, draw.grid_offset_x), visit(parts.offset_y, draw.grid_offset_y);
  }
}

// plain(row) or structure(row, an empty structure of its type) for each row.
template <typename Plain, typename Structured>
void for_each_draw_word(Plain&& plain, Structured&& structured) {
  const auto either = [&]<typename Row>(const Row& row) {
    if constexpr (requires { row.most; }) {
      plain(row);
    } else {
      structured(row, typename std::remove_cvref_t<decltype(DrawState{}.*row.field)>::value_type{});
    }
  };
  std::apply([&](const auto&... rows) { (either(rows), ...); }, kDrawWords);
}

// visit(word) for the state's words in the order of a message. `AdapterDraw` may be const.
template <typename AdapterDraw, typename Visit>
void for_each_state_word(AdapterDraw& draw, Visit&& visit) {
  for_each_draw_word([&](const auto& row) { visit(draw.*row.word); },
                     [&](const auto& row, auto parts) {
                       visit(draw.*row.present);
                       for_each_part_word(parts, draw, [&](const auto&, auto& word) { visit(word); });
                     });
}

inline void set_words(const DrawState& state, surefill_adapter_draw& draw) {
  for_each_draw_word([&](const auto& row) { draw.*row.word = static_cast<std::uint32_t>(state.*row.field); },
                     [&](const auto& row, const auto&) {
                       const auto& value = state.*row.field;
                       if (!value) return;
                       draw.*row.present = 1;
                       for_each_part_word(*value, draw, [](const auto& part, auto& word) {
                         word = static_cast<std::remove_reference_t<decltype(word)>>(part);
                       });
                     });
}

inline void set_state(const surefill_adapter_draw& draw, DrawState& state) {
  for_each_draw_word(
      [&](const auto& row) {
        auto& value = state.*row.field;
        value = static_cast<std::remove_reference_t<decltype(value)>>(draw.*row.word);
      },
      [&](const auto& row, auto parts) {
        if (!(draw.*row.present)) return;
        for_each_part_word(parts, draw, [](auto& part, const auto& word) {
          part = static_cast<std::remove_reference_t<decltype(part)>>(word);
        });
        state.*row.field = parts;
      });
}

// The name of the first field whose value has no word in version 1; "" if there is none. A culling box needs none: it
// changes no image [M6].
inline std::string_view field_without_word(const DrawState& state) {
  DrawState rest = state;
  rest.culling_box.reset();
  for_each_draw_word(
      [&](const auto& row) {
        auto& value = rest.*row.field;
        if (value <= row.most) value = DrawState{}.*row.field;
      },
      [&](const auto& row, const auto&) { (rest.*row.field).reset(); });
  std::string_view name;
  corpus::for_each_draw_field([&](const auto& field) {
    if (name.empty() && !(rest.*field.member == DrawState{}.*field.member)) name = field.name;
  });
  return name;
}

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_DRAW_WORDS_HPP
