// SPDX-License-Identifier: Apache-2.0
//
// The words of version 1 of the adapter: a draw's state goes into them and comes back, through memory and through a message,
// and what has no word there is named.
#include "certify/rivals/draw_words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "certify/rivals/wire.hpp"

namespace surefill::adapters {
namespace {

// States that differ from the default in one field each, and one that differs in all that version 1 has.
std::vector<DrawState> states() {
  std::vector<DrawState> states(8);
  states[0].fill_rule = FillRule::northwards_west;
  states[1].front_face = FrontFace::counter_clockwise;
  states[2].cull = Cull::back;
  states[3].depth_mode = DepthMode::clamp;
  states[4].depth_write = false;
  states[5].conservative = Conservative::inner;
  states[6].scissor = Scissor{-1, 2, 3, 4};
  states[7].grid = Grid{8, 3, 5, GridRounding::truncate};
  DrawState all;
  for (const DrawState& state : states) {
    corpus::for_each_draw_field([&](const auto& field) {
      if (!(state.*field.member == DrawState{}.*field.member)) all.*field.member = state.*field.member;
    });
  }
  states.push_back(all);
  return states;
}

TEST(DrawWords, AStateComesBack) {
  for (const DrawState& state : states()) {
    surefill_adapter_draw draw{};
    set_words(state, draw);
    DrawState back;
    set_state(draw, back);
    EXPECT_EQ(back, state);

    surefill_adapter_scene scene{};
    scene.width = scene.height = scene.samples = scene.draw_count = 1;
    scene.draws = &draw;
    for (const std::uint32_t version : {SUREFILL_ADAPTER_VERSION, SUREFILL_ADAPTER2_VERSION}) {
      const Words words = scene_words(scene, {}, version);
      DecodedScene decoded;
      ASSERT_TRUE(decode_scene(words, decoded, version));
      DrawState sent;
      set_state(decoded.draws[0], sent);
      EXPECT_EQ(sent, state);
      const SceneOfVersion2 second(decoded.scene);
      EXPECT_EQ(std::memcmp(&second.scene().draws[0]->fill_rule, &draw.fill_rule, 16 * 4), 0);
      DecodedScene other;
      EXPECT_FALSE(decode_scene(words, other, 3 - version)) << "a message of the other version";
    }
  }
}

// A certify that knows more words of a header is understood; fewer are no scene.
TEST(DrawWords, HeadersOfVersion2MayGrow) {
  surefill_adapter_draw draw{};
  draw.scissor[3] = 7;
  draw.grid_offset_y = 9;
  surefill_adapter_scene scene{};
  scene.width = scene.height = scene.samples = scene.draw_count = 1;
  scene.draws = &draw;
  const Words words = scene_words(scene, {}, SUREFILL_ADAPTER2_VERSION);
  ASSERT_EQ(words.size(), 11u + 28u);
  Words longer = words;
  longer.insert(longer.begin() + 11 + 28, {5, 6});
  longer[11] = 30;
  longer.insert(longer.begin() + 11, 4);
  longer[0] = 12;
  DecodedScene decoded;
  ASSERT_TRUE(decode_scene(longer, decoded, SUREFILL_ADAPTER2_VERSION));
  EXPECT_EQ(decoded.draws[0].scissor[3], 7);
  EXPECT_EQ(decoded.draws[0].grid_offset_y, 9u);
  for (const std::size_t header : {std::size_t{0}, std::size_t{11}}) {
    Words shorter = words;
    --shorter[header];
    shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(header) + 2);
    DecodedScene none;
    EXPECT_FALSE(decode_scene(shorter, none, SUREFILL_ADAPTER2_VERSION)) << header;
  }
  Words others = words;
  others[12] = SUREFILL_ADAPTER2_POINTS + 1;
  DecodedScene none;
  EXPECT_FALSE(decode_scene(others, none, SUREFILL_ADAPTER2_VERSION));
}

// Lines and points have two indices and one, and a width behind the words of triangles.
TEST(DrawWords, LinesAndPointsComeBack) {
  const std::array<std::uint32_t, 4> indices{0, 1, 1, 0}, identifiers{7, 8, 9, 10};
  const std::array<float, 8> vertices{1, 2, 3, 4, 5, 6, 7, 8};
  for (const std::uint32_t kind : {SUREFILL_ADAPTER2_LINES, SUREFILL_ADAPTER2_POINTS}) {
    surefill_adapter_draw draw{};
    draw.vertex_count = 2;
    draw.triangle_count = kind == SUREFILL_ADAPTER2_LINES ? 2 : 4;
    draw.pixel = draw.clip = vertices.data();
    draw.indices = indices.data();
    draw.identifiers = identifiers.data();
    surefill_adapter_scene scene{};
    scene.width = scene.height = scene.samples = scene.draw_count = 1;
    scene.draws = &draw;
    const Words words = scene_words(scene, {}, SUREFILL_ADAPTER2_VERSION, {{kind, 2.5f}});
    DecodedScene decoded;
    ASSERT_TRUE(decode_scene(words, decoded, SUREFILL_ADAPTER2_VERSION));
    ASSERT_EQ(decoded.primitives.size(), 1u);
    EXPECT_EQ(decoded.primitives[0].kind, kind);
    EXPECT_EQ(decoded.primitives[0].width, 2.5f);
    EXPECT_EQ(decoded.draws[0].indices[3], 0u);
    EXPECT_EQ(decoded.draws[0].identifiers[draw.triangle_count - 1], identifiers[draw.triangle_count - 1]);
    const SceneOfVersion2 second(decoded.scene, decoded.primitives);
    EXPECT_EQ(second.scene().draws[0]->primitive, kind);
    EXPECT_EQ(second.scene().draws[0]->width, 2.5f);
    // Without the word of a width there is none.
    Words shorter = words;
    shorter[11] = 28;
    shorter.erase(shorter.begin() + 11 + 28);
    DecodedScene thin;
    ASSERT_TRUE(decode_scene(shorter, thin, SUREFILL_ADAPTER2_VERSION));
    EXPECT_EQ(thin.primitives[0].width, 0);
  }
}

TEST(DrawWords, WhatHasNoWordIsNamed) {
  for (const DrawState& state : states()) EXPECT_EQ(field_without_word(state), "");
  DrawState state;
  state.culling_box = std::array<Vertex, 8>{};
  EXPECT_EQ(field_without_word(state), "") << "it changes no image";
  state.fill_rule = FillRule::closed;
  EXPECT_EQ(field_without_word(state), "fill-rule");
}

}  // namespace
}  // namespace surefill::adapters
