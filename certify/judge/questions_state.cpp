// SPDX-License-Identifier: Apache-2.0
//
// Questions about what a draw's state does: culling, depth modes, sample places, and who is seen.
#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/questions.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

// A clockwise triangle of other W whose X and Y, not divided, turn the other way.
std::string about_culling_divided(const Questions& questions) {
  constexpr std::size_t kInside = 3 * 8 + 3;
  const std::array<SceneVertex, 3> c{corner(1.125, 1.25, 0.5, 8), corner(6.5, 2.125, 0.5, 1),
                                     corner(2.25, 6.625, 0.5, 1)};
  const double turn =
      (c[1].x - double{c[0].x}) * (c[2].y - double{c[0].y}) - (c[1].y - double{c[0].y}) * (c[2].x - double{c[0].x});
  if (turn >= 0) return "";
  std::array<bool, 3> drawn{};
  for (std::size_t cull = 0; cull < 3; ++cull) {
    Scene scene = empty_scene(8, 8);
    add_triangle(scene.draws[0], c);
    scene.draws[0].cull = static_cast<Cull>(cull);
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) return "";
    drawn[cull] = is_covered(*image, kInside);
  }
  const bool front = drawn[static_cast<std::size_t>(Cull::front)], back = drawn[static_cast<std::size_t>(Cull::back)];
  if (!drawn[0] || !front || back) return "";
  return "culling takes the facing from X and Y before they are divided by W";
}

// What is culled where one or two vertices are behind the eye.
std::string about_culling_behind(const Questions& questions) {
  constexpr int kFrames = 24, kSize = 16;
  Random random(0xC0B);
  std::array<int, 2> all{}, never{}, always{}, other{};
  for (int n = 0; n < kFrames; ++n) {
    Scene scene = empty_scene(kSize, kSize);
    std::array<SceneVertex, 3> c = plain_corners(random, kSize, kSize);
    const auto two = static_cast<std::size_t>(n % 2);
    for (std::size_t i = 0; i <= two; ++i) {
      SceneVertex& v = c[(static_cast<std::size_t>(n / 2) + i) % 3];
      v = corner(v.x, v.y, 0.5, -1);
    }
    add_triangle(scene.draws[0], c);
    const auto plain = answer(questions, scene);
    if (!plain) continue;
    if (differs(*plain)) return "";
    if (std::ranges::count(plain->right.count, 0u) + 8 > kSize * kSize) continue;
    std::array<bool, 2> wrong{}, drawn{};
    for (const std::size_t i : {0u, 1u}) {
      scene.draws[0].cull = i == 0 ? Cull::front : Cull::back;
      const auto culled = answer(questions, scene);
      const auto image = questions.rival(scene);  // as it is, samples near edges, too
      if (!culled || !image) return "";
      wrong[i] = differs(*culled);
      drawn[i] = std::ranges::any_of(image->count, [](std::uint32_t k) { return k != 0; });
    }
    ++all[two];
    never[two] += wrong[0] != wrong[1] && drawn[0] && drawn[1];
    always[two] += wrong[0] != wrong[1] && !drawn[0] && !drawn[1];
    other[two] += wrong[0] && wrong[1];
  }
  const auto is = [&all](const std::array<int, 2>& n, std::size_t two) { return all[two] > 2 && n[two] == all[two]; };
  if (is(never, 0) && is(never, 1)) return "triangles with a vertex behind the eye (W <= 0) are never culled";
  if (is(always, 0) && is(always, 1)) {
    return "with culling on, triangles with a vertex behind the eye (W <= 0) are not drawn, whichever way they face";
  }
  if (is(other, 0) && is(other, 1)) {
    return "of triangles with a vertex behind the eye (W <= 0) the wrong ones are culled: front is taken for back "
           "there";
  }
  if (is(other, 0) && other[1] == 0) {
    return "culling is wrong where one vertex is behind the eye (W <= 0), and right where two are: the facing is taken "
           "from "
           "the projected points as they are, which turn over with each vertex there";
  }
  const int wrong = never[0] + never[1] + always[0] + always[1] + other[0] + other[1];
  if (2 * wrong < all[0] + all[1] || wrong == 0) return "";
  return "culling is wrong where a vertex is behind the eye (W <= 0)";
}

// Where in the pixel depth is taken, by two ramps.
std::string about_depth_of_samples(const Questions& questions) {
  constexpr double kClear = 2;  // sixteenths
  for (const int samples : {4, 8, 2, 16}) {
    const auto n = static_cast<std::size_t>(samples);
    std::array<std::vector<double>, 2> place;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      Scene scene = empty_scene(4, 4);
      scene.samples = samples;
      add_triangle(scene.draws[0], {corner(0, 0, 0), corner(8, 0, axis == 0 ? 1 : 0), corner(0, 8, axis == 1 ? 1 : 0)},
                   questions.model.culled);
      const auto image = questions.rival(scene);
      if (!image || image->depth.size() != 16 * n) break;
      for (std::size_t s = 0; s < n; ++s) place[axis].push_back((8 * image->depth[(4 + 1) * n + s] - 1) * 16);
    }
    if (place[1].size() != n) continue;
    const auto is = [&](const auto& of) {
      for (std::size_t s = 0; s < n; ++s) {
        const std::array<int, 2> at = of(sample_location(samples, static_cast<int>(s)));
        if (!(std::abs(place[0][s] - at[0]) < kClear && std::abs(place[1][s] - at[1]) < kClear)) return false;
      }
      return true;
    };
    const auto right = [](const SampleLocation& at) { return std::array<int, 2>{at.x, at.y}; };
    if (is(right)) continue;
    if (is([](const SampleLocation&) { return std::array<int, 2>{8, 8}; })) {
      return "with several samples a pixel depth is taken at the pixel's centre, for all of them";
    }
    if (is([](const SampleLocation& at) { return std::array<int, 2>{16 - at.x, at.y}; })) {
      return "with several samples a pixel depth is taken at places that are mirrored: left is right";
    }
    if (is([](const SampleLocation& at) { return std::array<int, 2>{at.x, 16 - at.y}; })) {
      return "with several samples a pixel depth is taken at places that are upside down";
    }
  }
  return "";
}

// Samples that are drawn only with a pixel's centre: does a slanted edge lose them, too, or a triangle's box alone?
std::string about_centres(const Questions& questions, int samples) {
  Scene scene = empty_scene(8, 8);
  scene.samples = samples;
  add_triangle(scene.draws[0], {corner(-20, 27.75), corner(27.75, -20), corner(-20, -20)}, questions.model.culled);
  const auto shown = answer(questions, scene);
  if (shown && !differs(*shown)) {
    return "with several samples a pixel a triangle's box is that of pixel centres: samples beyond it, in its first "
           "and "
           "last columns and rows, are lost";
  }
  return "with several samples a pixel a sample is covered only where the pixel's centre is, too";
}

// A triangle about one sample of a pixel, that does not have the centre in it.
std::string about_small_of_samples(const Questions& questions) {
  constexpr double kReach = 3.0 / 16;
  for (const int samples : {4, 8, 2, 16}) {
    int all = 0, lost = 0;
    for (int s = 0; s < samples; ++s) {
      const SampleLocation at = sample_location(samples, s);
      const double x = 3 + at.x / 16.0, y = 3 + at.y / 16.0;
      if (std::max(std::abs(x - 3.5), std::abs(y - 3.5)) <= kReach) continue;
      Scene scene = empty_scene(8, 8);
      scene.samples = samples;
      add_triangle(scene.draws[0],
                   {corner(x - kReach, y - kReach), corner(x + kReach, y - kReach), corner(x, y + kReach)},
                   questions.model.culled);
      const auto shown = answer(questions, scene);
      if (!shown) break;
      ++all;
      lost += std::ranges::any_of(shown->right.count, [](std::uint32_t n) { return n != 0; }) &&
              std::ranges::none_of(shown->rival.count, [](std::uint32_t n) { return n != 0; });
    }
    if (all > 1 && lost == all) {
      // Where a sliver is lost with one sample, too, which rounds to a line of whole pixels, this is about slivers.
      Scene sliver = empty_scene(8, 8);
      add_triangle(sliver.draws[0], {corner(1.25, 1), corner(6.25, 5.875), corner(3.75, 4.25)}, questions.model.culled);
      if (const auto shown = answer(questions, sliver); !shown || differs(*shown)) return "";
      return "with several samples a pixel triangles smaller than one are lost where they miss its centre, though they "
             "cover a sample";
    }
  }
  return "";
}

// A triangle about one sample of each pixel: are those lost whose pixels lie at the rim of a block?
std::string about_rims(const Questions& questions) {
  constexpr int kSide = 16, kSamples = 4;
  constexpr double kReach = 3.0 / 16;
  std::vector<int> lost;
  for (int s = 0; s < kSamples; ++s) {
    const SampleLocation at = sample_location(kSamples, s);
    Scene scene = empty_scene(kSide, kSide);
    scene.samples = kSamples;
    for (int p = 0; p < kSide * kSide; ++p) {
      const double x = p % kSide + at.x / 16.0, y = p / kSide + at.y / 16.0;
      add_triangle(scene.draws[0],
                   {corner(x - kReach, y - kReach), corner(x + kReach, y - kReach), corner(x, y + kReach)},
                   questions.model.culled);
    }
    const auto image = questions.rival(scene);
    if (!image || image->count.empty()) return "";
    for (int p = 0; p < kSide * kSide; ++p) {
      if (image->count[static_cast<std::size_t>(p * kSamples + s)] == 0) lost.push_back(p);
    }
  }
  if (lost.empty()) return "";
  for (const int n : {16, 8, 4}) {
    const auto rim = [n](int p) {
      const int x = p % kSide % n, y = p / kSide % n;
      return x == 0 || y == 0 || x == n - 1 || y == n - 1;
    };
    if (!std::ranges::all_of(lost, rim)) continue;
    return text(
        "with several samples a pixel samples at the rim of blocks of %d x %d pixels are lost: blocks are rejected "
        "by the centres of their pixels",
        n, n);
  }
  return "";
}

}  // namespace

std::string about_culling(const Questions& questions) {
  if (questions.model.culled != Cull::none) return "";
  // Of each front face, what is culled, and the turn of the triangle: drawn?
  std::array<std::array<std::array<bool, 2>, 3>, 2> drawn{};
  bool right = true;
  for (std::size_t face = 0; face < 2; ++face) {
    for (std::size_t cull = 0; cull < 3; ++cull) {
      for (std::size_t turned = 0; turned < 2; ++turned) {
        Scene scene;
        scene.width = scene.height = 8;
        SceneDraw& draw = scene.draws.emplace_back();
        std::array<SceneVertex, 3> c{corner(1.125, 1.25), corner(6.5, 2.125), corner(2.25, 6.625)};
        if (turned == 1) std::swap(c[1], c[2]);
        add_triangle(draw, c);
        draw.front_face = face == 0 ? FrontFace::clockwise : FrontFace::counter_clockwise;
        draw.cull = static_cast<Cull>(cull);
        const auto image = questions.rival(scene);
        if (!image || image->count.empty()) return "";
        drawn[face][cull][turned] = is_covered(*image, 3 * 8 + 3);
      }
    }
  }
  // The first turn is clockwise. What should be there of front faces clockwise, and what is.
  struct Form {
    const char* text;
    bool (*of)(std::size_t face, std::size_t cull, std::size_t turned);
  };
  constexpr Form kForms[] = {
      {"", [](std::size_t f, std::size_t c, std::size_t t) { return c == 0 || (c == 1) == (f != t); }},
      {"culling does nothing: neither facing is taken away",
       [](std::size_t, std::size_t, std::size_t) { return true; }},
      {"front and back faces are exchanged: culling one takes the other away",
       [](std::size_t f, std::size_t c, std::size_t t) { return c == 0 || (c == 1) == (f == t); }},
      {"which facing is front is not looked at: clockwise is front, always",
       [](std::size_t, std::size_t c, std::size_t t) { return c == 0 || (c == 1) == (t == 1); }},
      {"which facing is front is not looked at: counter-clockwise is front, always",
       [](std::size_t, std::size_t c, std::size_t t) { return c == 0 || (c == 1) == (t == 0); }},
      {"culling takes back faces away, whichever it should",
       [](std::size_t f, std::size_t c, std::size_t t) { return c == 0 || f == t; }},
      {"culling takes front faces away, whichever it should",
       [](std::size_t f, std::size_t c, std::size_t t) { return c == 0 || f != t; }},
      {"culling takes back faces away (counter-clockwise ones), whichever it should, and does not look at which is "
       "front",
       [](std::size_t, std::size_t c, std::size_t t) { return c == 0 || t == 0; }},
      {"with culling on, both facings are culled: nothing is drawn",
       [](std::size_t, std::size_t c, std::size_t) { return c == 0; }},
      {"culling of front faces does nothing, that of back faces works",
       [](std::size_t f, std::size_t c, std::size_t t) { return c != 2 || f == t; }},
      {"culling of back faces does nothing, that of front faces works",
       [](std::size_t f, std::size_t c, std::size_t t) { return c != 1 || f != t; }},
      {"culling works with clockwise front faces; with counter-clockwise ones it does nothing",
       [](std::size_t f, std::size_t c, std::size_t t) { return c == 0 || f == 1 || (c == 1) == (f != t); }}};
  for (const Form& form : kForms) {
    bool good = true;
    for (std::size_t i = 0; i < 12; ++i)
      good = good && drawn[i / 6][i / 2 % 3][i % 2] == form.of(i / 6, i / 2 % 3, i % 2);
    if (good && &form == kForms) {
      const std::string divided = about_culling_divided(questions);
      return divided.empty() ? about_culling_behind(questions) : divided;
    }
    if (good) return form.text;
    if (&form == kForms) right = false;
  }
  if (right) return "";
  constexpr std::array<const char*, 3> kCulls{"no culling", "culling front faces", "culling back faces"};
  for (std::size_t i = 0; i < 12; ++i) {
    const bool is = drawn[i / 6][i / 2 % 3][i % 2];
    if (is == kForms[0].of(i / 6, i / 2 % 3, i % 2)) continue;
    return std::string("with ") + kCulls[i / 2 % 3] +
           (i / 6 == 1 ? ", counter-clockwise ones being front, " : ", clockwise ones being front, ") +
           (i % 2 == 0 ? "a clockwise triangle is " : "a counter-clockwise triangle is ") +
           (is ? "drawn" : "not drawn") + ", and others are wrong";
  }
  return "";
}

namespace {

// Depth from -1 on the left to 2 on the right of a target, as it comes.
struct Ramp {
  std::vector<double> given;
  std::vector<std::uint32_t> count;
  std::vector<float> depth;
  std::vector<bool> seen;  // it has an index
  bool is_torn = false;    // its rows are not alike
};

std::optional<Ramp> ramp(const Questions& questions, DepthMode mode) {
  constexpr int kLength = 48;
  Scene scene;
  scene.width = kLength, scene.height = 4;
  SceneDraw& draw = scene.draws.emplace_back();
  draw.depth_mode = mode;
  // z = -1 + x / 16 on all of it.
  add_triangle(draw, {corner(0, 0, -1), corner(96, 0, 5), corner(0, 8, -1)}, questions.model.culled);
  const auto image = questions.rival(scene);
  if (!image || image->count.empty()) return std::nullopt;
  Ramp ramp;
  for (int x = 0; x < kLength; ++x) {
    const auto s = static_cast<std::size_t>(kLength + x);
    ramp.given.push_back(-1 + (x + 0.5) / 16);
    ramp.count.push_back(image->count[s]);
    if (!image->depth.empty()) ramp.depth.push_back(image->depth[s]);
    if (!image->index.empty()) ramp.seen.push_back(image->index[s] != kNoTriangle);
    for (std::size_t y = 0; y < 4; ++y) {
      ramp.is_torn =
          ramp.is_torn || is_covered(*image, y * kLength + static_cast<std::size_t>(x)) != is_covered(*image, s);
    }
  }
  return ramp;
}

// Are exactly the samples of [low, high] there?
bool keeps(const Ramp& ramp, double low, double high) {
  for (std::size_t i = 0; i < ramp.given.size(); ++i) {
    if ((ramp.count[i] != 0) != (ramp.given[i] >= low && ramp.given[i] <= high)) return false;
  }
  return true;
}

template <typename Of>
bool is_depth(const Ramp& ramp, const Of& of) {
  for (std::size_t i = 0; i < ramp.depth.size(); ++i) {
    if (ramp.count[i] != 0 && !alike(ramp.depth[i], static_cast<float>(of(ramp.given[i])))) return false;
  }
  return !ramp.depth.empty();
}

std::string clipping_text(const Ramp& ramp) {
  const auto clamped = [](double z) { return std::clamp(z, 0.0, 1.0); };
  if (ramp.is_torn) return "where depth is clipped triangles lack a part: of the polygon that is left not all is drawn";
  if (keeps(ramp, 0, 1)) return "";
  if (keeps(ramp, -INFINITY, INFINITY)) {
    bool hidden = !ramp.seen.empty();
    for (std::size_t i = 0; i < ramp.seen.size(); ++i) {
      hidden = hidden && ramp.seen[i] == (ramp.given[i] >= 0 && ramp.given[i] <= 1);
    }
    if (hidden) return "counts hold what depth clipping takes away: it is counted before it is clipped";
    return is_depth(ramp, clamped) && !is_depth(ramp, [](double z) { return z; })
               ? "depth clipping clamps: what is beyond 0 to 1 is drawn at its limit"
               : "depth clipping does nothing: what is beyond 0 to 1 is drawn";
  }
  if (keeps(ramp, -1, 1)) return "depth is clipped to -1 to 1, not to 0 to 1";
  if (keeps(ramp, 0, INFINITY)) return "depth is clipped at 0 alone: what is beyond 1 (the far plane) is drawn";
  if (keeps(ramp, -INFINITY, 1)) return "depth is clipped at 1 alone: what is below 0 (the near plane) is drawn";
  if (std::all_of(ramp.count.begin(), ramp.count.end(), [](std::uint32_t n) { return n == 0; })) {
    return "depth clipping drops whole triangles that reach beyond 0 to 1";
  }
  double low = 0, high = 0;
  for (std::size_t i = 0; i < ramp.given.size(); ++i) {
    if (ramp.count[i] == 0) continue;
    if (low == high) low = ramp.given[i];
    high = ramp.given[i];
  }
  return text("depth clipping keeps depths from about %.2f to about %.2f, not 0 to 1", low, high);
}

std::string clamping_text(const Ramp& ramp) {
  if (!keeps(ramp, -INFINITY, INFINITY)) {
    return keeps(ramp, 0, 1) ? "depth clamping clips: what is beyond 0 to 1 is not drawn"
                             : "depth clamping takes samples away: it should draw all of them";
  }
  if (ramp.depth.empty() || is_depth(ramp, [](double z) { return std::clamp(z, 0.0, 1.0); })) return "";
  if (is_depth(ramp, [](double z) { return z; })) return "depth clamping does nothing: depths beyond 0 to 1 stay";
  if (is_depth(ramp, [](double z) { return std::clamp(z, -1.0, 1.0); }))
    return "depth is clamped to -1 to 1, not to 0 to 1";
  // The corners' depths -1 and 5 as 0 and 1.
  if (is_depth(ramp, [](double z) { return (z + 1) / 6; })) {
    return "depth is clamped at the vertices, before it is interpolated, not at each sample";
  }
  if (is_depth(ramp, [](double z) { return std::max(z, 0.0); })) return "depth is clamped at 0 alone, not at 1";
  if (is_depth(ramp, [](double z) { return std::min(z, 1.0); })) return "depth is clamped at 1 alone, not at 0";
  return "";
}

}  // namespace

std::string about_depth_modes(const Questions& questions) {
  const auto plain = ramp(questions, DepthMode::none);
  // What it does always is of its model.
  const bool whole = plain && keeps(*plain, -INFINITY, INFINITY);
  std::string found;
  if (whole && is_depth(*plain, [](double z) { return std::clamp(z, 0.0, 1.0); })) {
    found = "depth is clamped to 0 to 1, whether that was asked for or not";
  } else if (whole && is_depth(*plain, [](double z) { return std::clamp(z, -1.0, 1.0); })) {
    found = "depth is clamped to -1 to 1, whether that was asked for or not";
  }
  if (!whole || (!plain->depth.empty() && found.empty() && !is_depth(*plain, [](double z) { return z; }))) return "";
  const auto clip = ramp(questions, DepthMode::clip), clamp = ramp(questions, DepthMode::clamp);
  const std::string clips = clip ? clipping_text(*clip) : "", clamps = clamp ? clamping_text(*clamp) : "";
  if (clips.starts_with("depth clipping clamps") && clamps.starts_with("depth clamping clips")) {
    return "depth clipping and depth clamping are exchanged: each does the other";
  }
  if (!clips.empty()) return clips;
  return clamps.empty() ? found : clamps;
}

std::string about_samples(const Questions& questions) {
  if (questions.model.x.place != 0.5 || questions.model.y.place != 0.5) return "";
  // A grid of 4 bits does not tell the places of edges below.
  const auto coarse = [](const oracle::AxisModel& axis) { return axis.bits >= 0 && axis.bits < 5; };
  if (coarse(questions.model.x) || coarse(questions.model.y)) return about_depth_of_samples(questions);
  for (const int samples : {2, 4, 8, 16}) {
    const auto n = static_cast<std::size_t>(samples);
    // How far to the right and down each sample of the pixel (1, 1) lies, in sixteenths.
    std::array<std::vector<int>, 2> place{std::vector<int>(n, 0), std::vector<int>(n, 0)};
    bool known = true;
    std::vector<std::uint32_t> inside(n, 0);
    for (std::size_t axis = 0; axis < 2 && known; ++axis) {
      for (int k = 0; k < 16 && known; ++k) {
        Scene scene;
        scene.width = scene.height = 4;
        scene.samples = samples;
        const double at = 1 + k / 16.0 + 1.0 / 32;  // samples beyond this edge are covered
        std::array<SceneVertex, 3> c{corner(at, -12), corner(20, 2), corner(at, 16)};
        if (axis == 1) c = {corner(-12, at), corner(2, 20), corner(16, at)};
        add_triangle(scene.draws.emplace_back(), c, questions.model.culled);
        const auto image = questions.rival(scene);
        known = image && image->count.size() == 16 * n;
        for (std::size_t s = 0; s < n && known; ++s) place[axis][s] += image->count[(4 + 1) * n + s] != 0;
      }
    }
    if (!known) continue;
    std::vector<std::array<int, 2>> got, right;
    for (std::size_t s = 0; s < n; ++s) {
      const SampleLocation at = sample_location(samples, static_cast<int>(s));
      right.push_back({at.x, at.y});
      got.push_back({place[0][s], place[1][s]});
    }
    if (got == right) continue;
    const auto is = [&](const auto& of) {
      for (std::size_t s = 0; s < n; ++s) {
        if (got[s] != of(s)) return false;
      }
      return true;
    };
    const std::string of = "of " + std::to_string(samples) + " samples a pixel ";
    if (is([](std::size_t) { return std::array<int, 2>{8, 8}; })) return "all samples of a pixel lie at its centre";
    if (is([&](std::size_t) { return right[0]; })) return "all samples of a pixel lie where the first does";
    if (is([&](std::size_t s) { return std::array<int, 2>{std::min(right[s][0], 8), std::min(right[s][1], 8)}; }))
      return about_centres(questions, samples);
    if (is([&](std::size_t s) { return right[n - 1 - s]; }))
      return "samples are numbered from the last one: their order is reversed";
    if (is([&](std::size_t s) { return std::array<int, 2>{right[s][0], 16 - right[s][1]}; }))
      return "sample places are upside down";
    if (is([&](std::size_t s) { return std::array<int, 2>{16 - right[s][0], right[s][1]}; }))
      return "sample places are mirrored: left is right";
    if (is([&](std::size_t s) { return std::array<int, 2>{right[s][1], right[s][0]}; }))
      return "x and y of sample places are exchanged";
    auto a = got, b = right;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    if (a == b) return of + "the places are right, and their order is another one";
    if (std::all_of(got.begin(), got.end(), [&](const auto& p) { return p == got[0]; })) {
      return of + text("all lie at one place, (%d, %d) sixteenths of a pixel", got[0][0], got[0][1]);
    }
    const int dx = got[0][0] - right[0][0], dy = got[0][1] - right[0][1];
    if (is([&](std::size_t s) { return std::array<int, 2>{right[s][0] + dx, right[s][1] + dy}; })) {
      return of + text("all are moved by (%d, %d) sixteenths of a pixel", dx, dy);
    }
    for (std::size_t s = 0; s < n; ++s) {
      if (got[s] == right[s]) continue;
      return of + text(
                      "number %d lies at (%d, %d) sixteenths of the pixel, not at (%d, %d): the table of places is "
                      "another one",
                      static_cast<int>(s), got[s][0], got[s][1], right[s][0], right[s][1]);
    }
  }
  for (const auto& about : {about_small_of_samples, about_rims, about_depth_of_samples}) {
    if (std::string sentence = about(questions); !sentence.empty()) return sentence;
  }
  return "";
}

namespace {

// Two triangles over everything, at these depths; the index that is seen, or none. `what`: 0 in one draw, 1 in two.
std::optional<std::uint32_t> seen(const Questions& questions, DepthTest test, std::initializer_list<double> depths,
                                  bool apart, std::optional<float> before = std::nullopt, bool last_writes = true) {
  Scene scene;
  scene.width = scene.height = 8;
  scene.depth_test = test;
  if (before) scene.initial_depth = {*before};
  scene.draws.emplace_back();
  for (const double z : depths) {
    if (apart && !scene.draws.back().triangles.empty()) scene.draws.emplace_back();
    add_triangle(scene.draws.back(), {corner(0.125, 0.25, z), corner(7.75, 0.5, z), corner(2.25, 7.875, z)},
                 questions.model.culled);
  }
  if (!last_writes) scene.draws.front().depth_write = false;
  const auto image = questions.rival(scene);
  if (!image || image->index.empty()) return std::nullopt;
  return image->index[3 * 8 + 3];
}

}  // namespace

std::string about_nothing_seen(const Questions& questions) {
  const auto half = seen(questions, DepthTest::less, {0.5}, false);
  if (half != kNoTriangle) return "";
  return "with the depth test LESS nothing is seen: it is taken for GREATER, or depth is cleared for GREATER";
}

std::string about_visibility(const Questions& questions) {
  const auto who = [&](DepthTest test, double a, double b) { return seen(questions, test, {a, b}, false); };
  const auto near_first = who(DepthTest::less, 0.25, 0.75), far_first = who(DepthTest::less, 0.75, 0.25);
  if (!near_first || !far_first) return "";
  if (seen(questions, DepthTest::less, {0.5}, false) != 0u) return "";  // then indices say nothing
  const std::string found = about_seen(questions);
  if (found.starts_with("the index is written")) return found;
  if (*near_first == 1 && *far_first == 1)
    return "there is no depth test: the last triangle drawn is seen, whatever its depth";
  if (*near_first == 0 && *far_first == 0)
    return "there is no depth test: the first triangle drawn is seen, whatever its depth";
  if (*near_first == 1 && *far_first == 0) return "the depth test is the other way round: the farther one is seen";
  if (*near_first != 0 || *far_first != 1) return "";
  const auto apart_near = seen(questions, DepthTest::less, {0.25, 0.75}, true),
             apart_far = seen(questions, DepthTest::less, {0.75, 0.25}, true);
  if (apart_near && apart_far && (*apart_near != 0 || *apart_far != 1)) {
    if (*apart_near == 1 && *apart_far == 1)
      return "each draw is drawn over those before it, whatever its depth: depth is forgotten between draws";
    return "with several draws another triangle is seen than in one draw of all";
  }
  // The nearest of two that differ by less and less, as far as a buffer of its bits can tell.
  const int finest = questions.model.format == oracle::DepthFormat::unorm16 ? 14 : 20;
  for (int k = 2; k <= finest; ++k) {
    const double step = std::ldexp(1.0, -k);
    const auto close = who(DepthTest::less, 0.5 + step, 0.5);
    if (!close || *close == 1) continue;
    return text("depths are compared with too few bits: of two that are 2^-%d apart the farther one is seen", k);
  }
  const auto greater_near = who(DepthTest::greater, 0.25, 0.75), greater_far = who(DepthTest::greater, 0.75, 0.25);
  if (greater_near && greater_far && (*greater_near != 1 || *greater_far != 0)) {
    if (*greater_near == 0 && *greater_far == 1) return "the depth test GREATER is taken for LESS";
    if (*greater_near == kNoTriangle && *greater_far == kNoTriangle)
      return "with the depth test GREATER nothing is seen: it is taken for LESS, or depth is cleared for LESS";
    return "the depth test GREATER does not show the farthest";
  }
  const auto hidden = seen(questions, DepthTest::less, {0.5}, false, 0.25f),
             shown = seen(questions, DepthTest::less, {0.5}, false, 0.75f),
             equal = seen(questions, DepthTest::less, {0.5}, false, 0.5f);
  if (hidden && shown && equal) {
    if (*hidden == 0 && *shown == 0) return "the depth that is there before the frame is ignored";
    if (*shown == kNoTriangle) return "with a depth that is there before the frame nothing is seen";
    if (!questions.model.later_wins && *equal == 0)
      return "a triangle as deep as what is there before the frame is seen: it should be nearer";
  }
  const auto alone = seen(questions, DepthTest::less, {0.5}, true, std::nullopt, false);
  if (alone && *alone == kNoTriangle) {
    return "draws that do not write depth are not seen at all: neither index nor attributes are written";
  }
  const auto read_only = seen(questions, DepthTest::less, {0.25, 0.75}, true, std::nullopt, false);
  if (read_only && *read_only == 0) return "depth is written by draws that should not write it";
  return found;
}

}  // namespace surefill::judge
