// SPDX-License-Identifier: Apache-2.0
//
// Questions about who is seen where depths are equal, where depth was there before, and what is written where a test fails.
#include "certify/judge/questions.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;

constexpr int kSize = 8;
constexpr std::size_t kMiddle = 3 * kSize + 3;

// Triangles over everything at these depths, in one draw or each in its own.
Scene layers(const Questions& questions, DepthTest test, std::initializer_list<double> depths, bool apart) {
  Scene scene = empty_scene(kSize, kSize);
  scene.depth_test = test;
  for (const double z : depths) {
    if (apart && !scene.draws.back().triangles.empty()) scene.draws.emplace_back();
    add_triangle(scene.draws.back(), over_all(kSize, kSize, z), questions.model.culled);
  }
  return scene;
}

std::optional<std::uint32_t> index_of(const Questions& questions, const Scene& scene) {
  const auto image = questions.rival(scene);
  if (!image || image->index.empty()) return std::nullopt;
  return image->index[kMiddle * static_cast<std::size_t>(scene.samples)];
}

std::string about_failing(const Questions& questions) {
  const auto image = questions.rival(layers(questions, DepthTest::less, {0.25, 0.75}, false));
  if (!image || image->index.empty() || image->depth.empty()) return "";
  const bool near_index = image->index[kMiddle] == 0, near_depth = alike(image->depth[kMiddle], 0.25f),
             far_depth = alike(image->depth[kMiddle], 0.75f);
  if (near_index && far_depth) return "depth is written where the depth test fails, too";
  if (image->index[kMiddle] == 1 && near_depth)
    return "the index is written where the depth test fails, too: depth is that of the nearest, the index that of the "
           "last";
  return "";
}

std::string about_equal(const Questions& questions) {
  const bool later = questions.model.later_wins;
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    const bool less = test == DepthTest::less;
    const char* name = less ? "LESS" : "GREATER";
    const auto one = index_of(questions, layers(questions, test, {0.5, 0.5}, false)),
               two = index_of(questions, layers(questions, test, {0.5, 0.5}, true));
    if (one && two && *one != *two && *one < 2 && *two < 2) {
      return std::string("of equal depths ") + (*two == 1 ? "a later draw's is seen" : "an earlier draw's is seen") +
             ", and within a draw the " + (*one == 1 ? "later one" : "earlier one") + ": " + name + " is taken for " +
             (less ? "LEQUAL" : "GEQUAL") + (*two == 1 ? " between draws" : " within a draw");
    }
    if (!less && one && *one == (later ? 0u : 1u)) {
      return later ? "of equal depths the later one is seen, and with the depth test GREATER the earlier one"
                   : "of equal depths the earlier one is seen, and with the depth test GREATER the later one: it is "
                     "taken "
                     "for GEQUAL";
    }
    Scene turned = layers(questions, test, {0.5, 0.5}, false);
    turned.draws[0].triangles[0].identifier = 9, turned.draws[0].triangles[1].identifier = 4;
    const auto named = index_of(questions, turned);
    if (!later && named && *named == 9)
      return "of equal depths the triangle that is drawn first is seen, not that of the smaller identifier";
  }
  // Both come to lie at the limit.
  for (const bool less : {true, false}) {
    Scene clamped =
        layers(questions, less ? DepthTest::less : DepthTest::greater, {less ? -0.25 : 1.25, less ? -0.5 : 1.5}, false);
    clamped.draws[0].depth_mode = DepthMode::clamp;
    const auto first = index_of(questions, clamped);
    if (!later && std::isinf(questions.model.clear) && first && *first == 1)
      return "depths are compared before they are clamped: of two that are clamped to the same depth the one that was "
             "nearer is seen";
  }
  return "";
}

std::string about_before(const Questions& questions) {
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    const bool less = test == DepthTest::less;
    const char* with = less ? "" : "with the depth test GREATER ";
    Scene scene = layers(questions, test, {0.5}, false);
    scene.initial_depth = {less ? 0.25f : 0.75f};
    if (index_of(questions, scene) == 0u)
      return std::string(with) + "the depth that is there before the frame is ignored";
    for (const int samples : {1, 4}) {
      scene.samples = samples;
      scene.initial_depth.clear();
      for (int s = 0; s < kSize * kSize * samples; ++s) scene.initial_depth.push_back(s % 2 == 0 ? 0.25f : 0.75f);
      const auto image = questions.rival(scene);
      if (!image || image->index.empty()) continue;
      std::array<std::array<int, 2>, 2> seen{};  // of even and odd samples
      for (int y = 2; y < 6; ++y) {
        for (int s = (y * kSize + 2) * samples; s < (y * kSize + 6) * samples; ++s) {
          ++seen[static_cast<std::size_t>(s % 2)][image->index[static_cast<std::size_t>(s)] == 0 ? 1 : 0];
        }
      }
      const bool all = seen[0][0] + seen[1][0] == 0, none = seen[0][1] + seen[1][1] == 0;
      if (!all && !none) continue;
      return samples > 1
                 ? "with several samples a pixel all take the depth that is there before the frame from one of them"
                 : std::string(with) + "all samples take the depth that is there before the frame from one of them";
    }
  }
  return "";
}

}  // namespace

std::string about_seen(const Questions& questions) {
  if (index_of(questions, layers(questions, DepthTest::less, {0.5}, false)) != 0u) return "";
  for (const auto& about : {about_failing, about_before, about_equal}) {
    if (std::string sentence = about(questions); !sentence.empty()) return sentence;
  }
  return "";
}

}  // namespace surefill::judge
