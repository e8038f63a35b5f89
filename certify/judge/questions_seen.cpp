// SPDX-License-Identifier: Apache-2.0
//
// Questions about how often a triangle counts, and who is seen: where depths are equal, where depth was there before, and what is written where a test fails.
#include "certify/judge/questions.hpp"
#include "certify/judge/room.hpp"

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
  Scene valued = layers(questions, DepthTest::less, {0.25, 0.75, 0.5}, false);
  valued.attributes = {{"a", 1, Interpolation::perspective}};
  for (std::size_t i = 0; i < 9; ++i) valued.draws[0].vertices[i].attributes = {static_cast<float>(i / 3 + 1)};
  const auto values = questions.rival(valued);
  if (values && near_index && near_depth && values->index[kMiddle] == 0 && !values->attributes.empty() &&
      !values->attributes[0].empty() && alike(values->attributes[0][kMiddle], 3)) {
    return "attributes are written where the depth test fails, too: depth is that of the nearest, the attributes are "
           "those of the last";
  }
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

// Of which pixel does each one take the depth that is there before the frame? Bit by bit of the pixel's number.
std::string about_places_before(const Questions& questions) {
  constexpr int kWide = 8, kHigh = 6, kPixels = kWide * kHigh;
  std::array<int, kPixels> from{};
  for (int bit = 0; 1 << bit < kPixels; ++bit) {
    Scene scene = empty_scene(kWide, kHigh);
    add_triangle(scene.draws[0], {corner(-8, -8), corner(56, -8), corner(-8, 56)}, questions.model.culled);
    for (int p = 0; p < kPixels; ++p) scene.initial_depth.push_back((p >> bit & 1) != 0 ? 0.75f : 0.25f);
    const auto image = questions.rival(scene);
    if (!image || image->index.empty()) return "";
    for (std::size_t p = 0; p < kPixels; ++p) from[p] |= image->index[p] == 0 ? 1 << bit : 0;
  }
  struct Form {
    const char* text;
    int (*of)(int x, int y);
  };
  constexpr Form kForms[] = {{"", [](int x, int y) { return y * kWide + x; }},
                             {"upside down", [](int x, int y) { return (kHigh - 1 - y) * kWide + x; }},
                             {"from right to left", [](int x, int y) { return y * kWide + kWide - 1 - x; }},
                             {"by columns, not by rows", [](int x, int y) { return x * kHigh + y; }},
                             {"with the height for the stride of rows", [](int x, int y) { return y * kHigh + x; }},
                             {"of the first pixel, for all", [](int, int) { return 0; }}};
  for (const Form& form : kForms) {
    bool fits = true;
    for (int p = 0; p < kPixels; ++p) fits = fits && from[static_cast<std::size_t>(p)] == form.of(p % kWide, p / kWide);
    if (fits)
      return form.text[0] == '\0' ? "" : std::string("the depth that is there before the frame is read ") + form.text;
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
    // What is behind it, in a draw with a scissor, and then without.
    Scene scissored = layers(questions, test, {0.5, 0.5}, true);
    scissored.initial_depth = scene.initial_depth;
    scissored.draws[0].scissor = Scissor{2, 2, 6, 6};
    for (int two = kAsksAll ? 1 : -1; two >= 0; --two) {
      if (two == 0) scissored.draws.pop_back();
      const auto shown = answer(questions, scissored);
      if (!shown || !differs(*shown)) continue;
      bool fits = true;
      for (int p = 0; p < kSize * kSize; ++p) {
        const auto s = static_cast<std::size_t>(p);
        const bool inside = std::min(p % kSize, p / kSize) >= 2 && std::max(p % kSize, p / kSize) < 6;
        const bool good = (shown->rival.index.empty() || shown->rival.index[s] == kNoTriangle) &&
                          (shown->rival.depth.empty() || shown->rival.depth[s] == shown->right.depth[s]);
        fits = fits && good == inside;
      }
      if (fits)
        return std::string(with) +
               "the depth that is there before the frame is read inside the first draw's scissor alone";
    }
    if (std::string places = about_places_before(questions); !places.empty()) return places;
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

// A near triangle over a part of a block, and a far one over everything.
std::string about_coarse_depth(const Questions& questions) {
  constexpr int kWide = 40;
  Scene scene = empty_scene(kWide, kWide);
  add_triangle(scene.draws[0], {corner(1.125, 1.25, 0.25), corner(5.5, 2.125, 0.25), corner(2.25, 5.625, 0.25)},
               questions.model.culled);
  const auto near = questions.rival(scene);
  add_triangle(scene.draws[0], over_all(kWide, kWide, 0.75), questions.model.culled);
  const auto both = questions.rival(scene);
  if (!near || !both || near->index.empty() || both->index.empty()) return "";
  for (const int n : {2, 4, 8, 16, 32}) {
    std::size_t fits = 0, lost = 0;
    for (int y = 0; y < kWide; ++y) {
      for (int x = 0; x < kWide; ++x) {
        const auto s = static_cast<std::size_t>(y * kWide + x);
        bool touched = false;
        for (int by = y / n * n; by < std::min(y / n * n + n, kWide); ++by) {
          for (int bx = x / n * n; bx < std::min(x / n * n + n, kWide); ++bx) {
            touched = touched || near->index[static_cast<std::size_t>(by * kWide + bx)] == 0;
          }
        }
        const bool covered = near->index[s] == 0, is_lost = touched && !covered;
        lost += is_lost;
        fits += covered ? both->index[s] == 0 : both->index[s] == (is_lost ? kNoTriangle : 1u);
      }
    }
    if (lost > 0 && fits == both->index.size()) {
      const std::string block = std::to_string(n) + " x " + std::to_string(n) + " pixels";
      return "a triangle that covers a part of a block of " + block +
             " hides farther ones in all of it: the coarse depth of the block is taken from what covers a part of it";
    }
  }
  return "";
}

std::string about_negative(const Questions& questions) {
  const auto one = index_of(questions, layers(questions, DepthTest::less, {-0.25}, false)),
             falling = index_of(questions, layers(questions, DepthTest::less, {-0.25, -0.75}, false)),
             rising = index_of(questions, layers(questions, DepthTest::less, {-0.75, -0.25}, false));
  if (one != 0u || falling != 0u || rising != 1u) return "";
  return "negative depths are compared the other way round: as the whole numbers that their bits are";
}

}  // namespace

// A far triangle whose draw does not write depth, behind a near one that leaves some of every block free.
std::string about_depth_write(const Questions& questions) {
  for (const bool less : {true, false}) {
    Scene scene = empty_scene(kSize, kSize);
    scene.depth_test = less ? DepthTest::less : DepthTest::greater;
    const double z = less ? 0.25 : 0.75;
    add_triangle(scene.draws[0], {corner(1.125, 1.25, z), corner(6.5, 2.125, z), corner(2.25, 6.625, z)},
                 questions.model.culled);
    add_triangle(scene.draws.emplace_back(), over_all(kSize, kSize, 1 - z), questions.model.culled);
    if (index_of(questions, scene) != 0u) continue;
    scene.draws[1].depth_write = false;
    if (index_of(questions, scene) == 1u) return "where depth write is off the depth test is off, too";
  }
  if (!kAsksAll) return "";
  // A near one that writes no depth, over everything and over a part of every block, and a far one after it.
  std::array<std::optional<std::uint32_t>, 2> seen;
  for (const std::size_t part : {0u, 1u}) {
    Scene scene = layers(questions, DepthTest::less, {0.25, 0.75}, true);
    if (index_of(questions, scene) != 0u) return "";
    scene.draws[0].depth_write = false;
    if (part == 1) {
      scene.draws[0].vertices = {corner(1.125, 1.25, 0.25), corner(6.5, 2.125, 0.25), corner(2.25, 6.625, 0.25)};
    }
    seen[part] = index_of(questions, scene);
  }
  if (seen[0] == 0u && seen[1] == 1u) {
    return "a draw that does not write depth hides what comes after it where it covers whole blocks of pixels: it "
           "writes the coarse depth of blocks, though not depth";
  }
  return "";
}

// One frame that begins with a depth, after a near frame and after a far one.
std::string about_left_before(const Questions& questions) {
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    const bool less = test == DepthTest::less;
    Scene scene = layers(questions, test, {0.5}, false);
    scene.initial_depth = {less ? 0.75f : 0.25f};
    std::array<std::optional<std::uint32_t>, 2> seen;
    for (const bool near : {true, false}) {
      (void)questions.rival(layers(questions, test, {near == less ? 1.0 / 32 : 31.0 / 32}, false));
      seen[near ? 1 : 0] = index_of(questions, scene);
    }
    if (seen[0] && seen[1] && *seen[0] != *seen[1])
      return "with a depth that is there before the frame, the image depends on the frame before";
  }
  return "";
}

std::string about_seen(const Questions& questions) {
  if (index_of(questions, layers(questions, DepthTest::less, {0.5}, false)) != 0u) return "";
  for (const auto& about : {about_failing, about_coarse_depth, about_negative, about_before, about_equal}) {
    if (std::string sentence = about(questions); !sentence.empty()) return sentence;
  }
  return "";
}

// A far triangle after a near one: over a part of a block, and over all of the target.
std::string about_hidden_counts(const Questions& questions) {
  constexpr int kWide = 32;
  std::array<bool, 2> lost{};
  for (const bool all : {false, true}) {
    Scene scene = empty_scene(kWide, kWide);
    for (const double z : {0.25, 0.75}) {
      std::array<corpus::SceneVertex, 3> c{corner(1.125, 1.25, z), corner(6.5, 2.125, z), corner(2.25, 6.625, z)};
      if (all) c = {corner(-8, -8, z), corner(88, -8, z), corner(-8, 88, z)};
      add_triangle(scene.draws[0], c, questions.model.culled);
    }
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) return "";
    const std::uint32_t n = image->count[3 * kWide + 3];
    if ((n != 1 && n != 2) || (!image->index.empty() && image->index[3 * kWide + 3] != 0)) return "";
    lost[all ? 1 : 0] = n == 1;
  }
  if (lost[0] && lost[1]) return "only what passes the depth test is counted, not all that covers a sample";
  if (lost[1]) {
    return "a triangle is not counted in blocks of pixels where all is nearer: the block's depth rejects it before it "
           "is "
           "counted";
  }
  return "";
}

// Many triangles, one on the other.
std::string about_counts(const Questions& questions) {
  std::vector<std::array<std::uint32_t, 2>> got;
  for (const int n : {1,   2,   3,   4,   7,   8,   9,   15,  16,  17,  31,   32,   33,   63,   64,   65,
                      127, 128, 129, 255, 256, 257, 300, 511, 512, 513, 1000, 1025, 2049, 4097, 66000}) {
    Scene scene = empty_scene(8, 8);
    add_triangle(scene.draws[0], {corner(1.125, 1.25), corner(6.5, 2.125), corner(2.25, 6.625)},
                 questions.model.culled);
    scene.draws[0].triangles.assign(static_cast<std::size_t>(n), scene.draws[0].triangles[0]);
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) break;
    got.push_back({static_cast<std::uint32_t>(n), image->count[3 * 8 + 3]});
  }
  if (got.size() < 8) return "";
  const auto all = [&got](const auto& of) {
    return std::all_of(got.begin(), got.end(), [&of](const auto& g) { return g[1] == of(g[0]); });
  };
  if (all([](std::uint32_t n) { return n; })) return "";
  std::uint32_t most = 0;
  for (const auto& g : got) most = std::max(most, g[1]);
  if (most == 1) {
    // Each nearer than the one before: all of them pass the depth test.
    Scene scene = empty_scene(8, 8);
    for (const double z : {0.75, 0.5, 0.25}) {
      add_triangle(scene.draws[0], {corner(1.125, 1.25, z), corner(6.5, 2.125, z), corner(2.25, 6.625, z)},
                   questions.model.culled);
    }
    const auto image = questions.rival(scene);
    if (image && !image->count.empty() && image->count[3 * 8 + 3] == 3) {
      return "only what passes the depth test is counted, not all that covers a sample";
    }
  }
  if (all([most](std::uint32_t n) { return std::min(n, most); })) return "counts stop at " + std::to_string(most);
  for (const std::uint32_t bits : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 10u, 12u, 16u}) {
    if (all([bits](std::uint32_t n) { return n & ((1u << bits) - 1); })) {
      return "counts overflow: they have " + std::to_string(bits) + " bits";
    }
  }
  if (all([](std::uint32_t n) { return 2 * n; })) return "every count is twice what it should be";
  if (all([](std::uint32_t n) { return n + 1; })) return "every count is 1 too large where anything is drawn";
  if (all([](std::uint32_t n) { return n - 1; })) return "every count is 1 too small where anything is drawn";
  if (all([](std::uint32_t n) { return (n + 1) / 2; })) {
    return "of two triangles that are next to each other in a draw one count is lost where both cover a sample, as by "
           "two "
           "workers without a lock";
  }
  const auto first = std::find_if(got.begin(), got.end(), [](const auto& g) { return g[0] != g[1]; });
  // Is the nearest one, which comes last, lost?
  Scene scene = empty_scene(8, 8);
  for (std::uint32_t n = 0; n < (*first)[0]; ++n) {
    const double z = n + 1 < (*first)[0] ? 0.5 : 0.25;
    add_triangle(scene.draws[0], {corner(1.125, 1.25, z), corner(6.5, 2.125, z), corner(2.25, 6.625, z)},
                 questions.model.culled);
  }
  if (const auto image = questions.rival(scene); image && !image->index.empty()) {
    if (image->index[3 * 8 + 3] + 1 != (*first)[0]) {
      return "beyond " + std::to_string((*first)[1]) +
             " triangles in one place further ones are lost: a tile or a block has room for so many";
    }
  }
  return "of " + std::to_string((*first)[0]) + " triangles on each other " + std::to_string((*first)[1]) +
         " are counted";
}

}  // namespace surefill::judge
