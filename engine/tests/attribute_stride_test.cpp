// SPDX-License-Identifier: Apache-2.0
//
// Attribute images with a stride: the same values as of dense images, at other places, and nothing between them is
// touched; on both paths and by both oracles. And which of them may lie in one another (B2).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace surefill::properties {
namespace {

constexpr float kUntouched = 0x1.234566p-3f;

// The attributes of a scene in one image, each sample's beside one another, `gap` floats before, between and after.
class Interleaved {
 public:
  Interleaved(const corpus::Frame& frame, std::uint32_t gap) : target(frame.target()) {
    samples_ = static_cast<std::size_t>(target.layers) * sample_total(target);
    std::uint32_t stride = gap;
    for (const AttributeTarget& image : target.attributes) stride += image.components + gap;
    memory_.assign(samples_ * stride, kUntouched);
    std::size_t first = gap;
    for (const AttributeTarget& image : target.attributes) {
      const std::size_t size = (samples_ - 1) * stride + image.components;
      images_.push_back({std::span(memory_).subspan(first, size), image.components, stride});
      first += image.components + gap;
    }
    target.attributes = images_;
  }

  // Of two images in memory, the dense one and this: are all values the same bits, and all others untouched?
  void expect_equal(const corpus::Image& dense, const std::string& where) {
    for (std::size_t k = 0; k < images_.size(); ++k) {
      const AttributeTarget& image = images_[k];
      for (std::size_t s = 0; s < samples_; ++s) {
        float* const here = &image.values[s * image.stride];
        const float* const there = &dense.attributes[k][s * image.components];
        ASSERT_EQ(std::memcmp(here, there, image.components * sizeof(float)), 0) << where << ", sample " << s;
        std::fill_n(here, image.components, kUntouched);
      }
    }
    EXPECT_TRUE(std::all_of(memory_.begin(), memory_.end(), [](float value) { return value == kUntouched; })) << where;
  }

  Target target;

 private:
  std::size_t samples_ = 0;
  std::vector<float> memory_;
  std::vector<AttributeTarget> images_;
};

TEST(AttributeStride, ValuesAreThoseOfDenseImages) {
  int frames = 0, attributes = 0, large = 0;
  for (const std::string& path : corpus::list_corpus(SUREFILL_CORPUS "/cases")) {
    const corpus::Scene scene = corpus::read_scene_file(path);
    if (scene.attributes.empty()) continue;
    const bool is_small = std::int64_t{scene.width} * scene.height * scene.samples * scene.layers <= 4096;
    const auto check = [&](const Renderer& draw, const std::string& name) {
      corpus::Frame frame(scene, {.count = false, .barycentrics = false});
      if (draw(frame.target(), frame.draws()) != Status::ok) return;
      for (const std::uint32_t gap : {0u, 3u}) {
        Interleaved interleaved(frame, gap);
        ASSERT_EQ(draw(interleaved.target, frame.draws()), Status::ok) << path;
        interleaved.expect_equal(frame.image(), path + ", " + name);
        ++frames;
      }
      attributes = std::max(attributes, static_cast<int>(scene.attributes.size()));
    };
    for (const Path chosen : {Path::automatic, Path::reference}) {
      check([=](const Target& target,
                std::span<const Draw> draws) { return render(target, draws, nullptr, {.path = chosen}); },
            chosen == Path::automatic ? "automatic" : "reference");
    }
    large += is_small ? 0 : 1;
    if (!is_small) continue;
    check(oracle_renderer(), "oracle");
    check(clipped_oracle_renderer(), "second oracle");
  }
  EXPECT_GE(frames, 100);
  EXPECT_GE(attributes, 2);
  EXPECT_GE(large, 1);  // of several tiles
}

// ---- which may lie in one another
constexpr int kSide = 4;
constexpr std::size_t kSamples = kSide * kSide;

struct Layout {
  const char* what;
  std::uint32_t components[2], stride[2];
  std::size_t first[2], size[2];  // in floats, of one piece of memory
  Status expected;
};
constexpr std::size_t kRow = 15 * 8;  // from the first sample to the last, of stride 8

constexpr Layout kLayouts[] = {
    {"side by side", {4, 4}, {8, 8}, {0, 4}, {kRow + 4, kRow + 4}, Status::ok},
    {"the other way about", {4, 4}, {8, 8}, {4, 0}, {kRow + 4, kRow + 4}, Status::ok},
    {"with gaps", {2, 3}, {8, 8}, {1, 4}, {kRow + 2, kRow + 3}, Status::ok},
    {"a sample later", {2, 3}, {8, 8}, {1, 12}, {kRow + 2, kRow + 3}, Status::ok},
    {"longer than needed", {2, 2}, {8, 8}, {0, 4}, {kRow + 8, kRow + 8}, Status::ok},
    {"one after the other", {2, 2}, {8, 8}, {0, kRow + 2}, {kRow + 2, kRow + 2}, Status::ok},
    {"a stride that says what 0 does", {2, 2}, {2, 0}, {0, 32}, {32, 32}, Status::ok},
    {"not asked for", {2, 2}, {8, 8}, {0, 0}, {0, 0}, Status::ok},
    {"one component of two", {4, 4}, {8, 8}, {0, 3}, {kRow + 4, kRow + 4}, Status::target_overlap},
    {"one component of two, at the end", {4, 4}, {8, 8}, {0, 5}, {kRow + 4, kRow + 4}, Status::target_overlap},
    {"the same place", {1, 1}, {8, 8}, {0, 0}, {kRow + 1, kRow + 1}, Status::target_overlap},
    {"two strides", {1, 1}, {8, 9}, {0, 1}, {kRow + 1, 15 * 9 + 1}, Status::target_overlap},
    {"a dense one among them", {1, 1}, {8, 0}, {0, 1}, {kRow + 1, 16}, Status::target_overlap},
    {"a float short", {1, 1}, {8, 8}, {0, 1}, {kRow, kRow + 1}, Status::target_attributes},
    {"a float short, the second", {1, 4}, {8, 8}, {0, 1}, {kRow + 1, kRow + 3}, Status::target_attributes},
    {"fewer than a sample's", {4, 4}, {8, 8}, {0, 4}, {3, kRow + 4}, Status::target_attributes},
    {"under the components", {4, 1}, {3, 8}, {0, 200}, {64, kRow + 1}, Status::target_attributes},
    {"too long for dense", {2, 2}, {2, 0}, {0, 40}, {33, 32}, Status::target_attributes},
    {"far beyond memory", {1, 1}, {0xFFFFFFFFu, 0}, {0, 100}, {64, 16}, Status::target_attributes},
};

TEST(AttributeStride, ImagesLieInOneAnotherOnlySideBySide) {
  const Vertex vertices[3] = {{-9, -9, 0, 1}, {30, -9, 0, 1}, {-9, 30, 0, 1}};
  const std::uint32_t indices[3] = {0, 1, 2};
  const float values[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  for (const Layout& layout : kLayouts) {
    std::vector<float> memory(512, kUntouched);
    AttributeTarget images[2];
    surefill_attribute_target c_images[2];
    AttributeArray arrays[2];
    surefill_attribute_array c_arrays[2];
    for (std::size_t k = 0; k < 2; ++k) {
      float* const first = memory.data() + layout.first[k];
      images[k] = {{first, layout.size[k]}, layout.components[k], layout.stride[k]};
      c_images[k] = {first, layout.size[k], layout.components[k], layout.stride[k]};
      arrays[k] = {values, layout.components[k], 0, Interpolation::perspective};
      c_arrays[k] = {values, 12, layout.components[k], 0, SUREFILL_PERSPECTIVE};
    }
    Target target;
    target.width = target.height = kSide, target.attributes = images;
    Draw draw;
    draw.vertices = vertices, draw.indices = indices, draw.attributes = arrays;
    const auto written = [&] {
      return memory.size() - static_cast<std::size_t>(std::ranges::count(memory, kUntouched));
    };
    std::size_t expected = 0;
    for (std::size_t k = 0; k < 2 && layout.expected == Status::ok; ++k)
      expected += layout.size[k] == 0 ? 0 : kSamples * layout.components[k];
    EXPECT_EQ(render(target, {&draw, 1}), layout.expected) << layout.what;
    EXPECT_EQ(written(), expected) << layout.what;

    std::ranges::fill(memory, kUntouched);
    surefill_target c_target{};
    c_target.struct_size = sizeof c_target, c_target.width = c_target.height = kSide, c_target.samples = 1;
    c_target.attributes = c_images, c_target.attribute_count = 2;
    surefill_draw c_draw{};
    c_draw.struct_size = sizeof c_draw, c_draw.index_count = c_draw.vertex_count = 3, c_draw.indices = indices;
    c_draw.vertices = reinterpret_cast<const surefill_vertex*>(vertices);
    c_draw.attributes = c_arrays, c_draw.attribute_count = 2;
    EXPECT_EQ(static_cast<int>(surefill_render(&c_target, &c_draw, 1, nullptr, nullptr)),
              static_cast<int>(layout.expected))
        << layout.what << ", in C";
    EXPECT_EQ(written(), expected) << layout.what << ", in C";
  }
}

// Other outputs and inputs may not lie in the gaps.
TEST(AttributeStride, GapsAreOfTheImage) {
  std::vector<float> memory(15 * 8 + 2 + 16);
  const AttributeTarget image[1] = {{std::span(memory).first(15 * 8 + 2), 2, 8}};
  Target target;
  target.width = 4, target.height = 1, target.attributes = image;
  target.depth = std::span(memory).subspan(3, 4);
  EXPECT_EQ(validate(target, {}), Status::target_overlap);
  target.depth = {}, target.initial_depth = std::span(memory).subspan(3, 4);
  EXPECT_EQ(validate(target, {}), Status::target_overlap);
  target.initial_depth = std::span(memory).last(4);
  EXPECT_EQ(validate(target, {}), Status::ok);
}

}  // namespace
}  // namespace surefill::properties
