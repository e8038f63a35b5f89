// SPDX-License-Identifier: Apache-2.0
//
// Contexts: what a call has allocated the next one uses again, whatever the frames' sizes and threads, and the image
// does not depend on it.
#include <gtest/gtest.h>

#include <cstdint>
#include <thread>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace surefill::properties {
namespace {

// Frames of all sizes one after another: each finds what the one before has left.
void expect_the_same_images(Context& context, std::uint64_t seed) {
  for (const Category& category : categories()) {
    for (const int size : {16, 150, 70, 300}) {
      const corpus::Scene scene = mixed_scene(category, seed, size, 6);
      const Renderer without = [](const Target& target, std::span<const Draw> draws) { return render(target, draws); };
      const Renderer with = [&](const Target& target, std::span<const Draw> draws) {
        return render(target, draws, nullptr, {.threads = 1 + size % 3, .context = &context});
      };
      const Comparison result = compare(scene, without, with);
      ASSERT_EQ(result.differences, 0u) << category.name << ' ' << size << '\n' << corpus::write_scene(scene);
    }
  }
}

TEST(Contexts, ChangeNothing) {
  Context context;
  for (std::uint64_t seed = 0; seed < 4; ++seed) expect_the_same_images(context, seed);
}

TEST(Contexts, MayBeShared) {
  Context context;
  std::vector<std::thread> threads;
  for (std::uint64_t n = 0; n < 3; ++n)
    threads.emplace_back([&context, n] { expect_the_same_images(context, 100 + n); });
  for (std::thread& thread : threads) thread.join();
}

TEST(Contexts, MayBeMadeInC) {
  surefill_context* const context = surefill_context_create();
  ASSERT_NE(context, nullptr);
  std::uint32_t count[2][64] = {};
  const float vertices[] = {1, 1, 0, 1, 7, 2, 0, 1, 3, 7, 0, 1};
  const std::uint32_t indices[] = {0, 1, 2};
  for (std::uint32_t(&image)[64] : count) {
    surefill_target target{};
    target.struct_size = sizeof target;
    target.width = target.height = 8, target.samples = 1;
    target.count = image, target.count_count = 64;
    surefill_draw draw{};
    draw.struct_size = sizeof draw;
    draw.vertices = reinterpret_cast<const surefill_vertex*>(vertices), draw.vertex_count = 3;
    draw.indices = indices, draw.index_count = 3;
    surefill_options options{};
    options.struct_size = sizeof options;
    options.context = &image == &count[0] ? nullptr : context;
    ASSERT_EQ(surefill_render(&target, &draw, 1, &options, nullptr), SUREFILL_OK);
  }
  EXPECT_EQ(std::vector(count[0], count[0] + 64), std::vector(count[1], count[1] + 64));
  surefill_context_destroy(context);
  surefill_context_destroy(nullptr);
}

#if defined(__GLIBC__) && !defined(SUREFILL_REFERENCE_ONLY)

TEST(Contexts, KeepMemoryAndGiveItBack) {
  const auto in_use = [] {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  constexpr std::size_t kLittle = 1 << 14;  // what the test itself may need
  const corpus::Scene scene = mixed_scene(categories().front(), 1, 300, 6);
  corpus::Frame frame(scene, outputs_of(scene));
  const std::size_t before = in_use();
  {
    Context context;
    ASSERT_EQ(render(frame.target(), frame.draws(), nullptr, {.context = &context}), Status::ok);
    const std::size_t kept = in_use();
    if (kept == before) GTEST_SKIP() << "another allocator, which mallinfo2 cannot see";
    EXPECT_GT(kept, before + 10 * kLittle);
    for (int n = 0; n < 3; ++n) {
      ASSERT_EQ(render(frame.target(), frame.draws(), nullptr, {.context = &context}), Status::ok);
      EXPECT_LT(in_use(), kept + kLittle);
    }
  }
  EXPECT_LT(in_use(), before + kLittle);
}

#endif

}  // namespace
}  // namespace surefill::properties
