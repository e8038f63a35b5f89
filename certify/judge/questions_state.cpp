// SPDX-License-Identifier: Apache-2.0
//
// Questions about what a draw's state does: scissor, culling, depth modes, sample places, and who is seen.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "certify/judge/questions.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

template <typename... Values>
std::string text(const char* form, Values... values) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), form, values...);
  return buffer.data();
}

Scene over_all_scene(int width, int height, Cull culled, double z = 0.5) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  add_triangle(scene.draws.emplace_back(), over_all(width, height, z), culled);
  return scene;
}

// --- the scissor

constexpr int kWidth = 16, kHeight = 12;

struct Rectangle {
  int x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  Rectangle on_target() const {
    return {std::clamp(x0, 0, kWidth), std::clamp(y0, 0, kHeight), std::clamp(x1, 0, kWidth),
            std::clamp(y1, 0, kHeight)};
  }
  friend bool operator==(const Rectangle& a, const Rectangle& b) {
    if (a.empty() || b.empty()) return a.empty() && b.empty();
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
  }
};

// One end of the rectangle, as it may be had from the scissor.
struct End {
  const char* text;
  int (*of)(const Rectangle& r);
};

constexpr End kLowX[] = {{"x0", [](const Rectangle& r) { return r.x0; }},
                         {"x0 + 1", [](const Rectangle& r) { return r.x0 + 1; }},
                         {"x0 - 1", [](const Rectangle& r) { return r.x0 - 1; }},
                         {"0", [](const Rectangle&) { return 0; }},
                         {"y0", [](const Rectangle& r) { return r.y0; }},
                         {"width - x1", [](const Rectangle& r) { return kWidth - r.x1; }},
                         {"2 (x0 / 2)", [](const Rectangle& r) { return r.x0 / 2 * 2; }},
                         {"4 (x0 / 4)", [](const Rectangle& r) { return r.x0 / 4 * 4; }},
                         {"8 (x0 / 8)", [](const Rectangle& r) { return r.x0 / 8 * 8; }}};
constexpr End kLowY[] = {{"y0", [](const Rectangle& r) { return r.y0; }},
                         {"y0 + 1", [](const Rectangle& r) { return r.y0 + 1; }},
                         {"y0 - 1", [](const Rectangle& r) { return r.y0 - 1; }},
                         {"0", [](const Rectangle&) { return 0; }},
                         {"x0", [](const Rectangle& r) { return r.x0; }},
                         {"height - y1", [](const Rectangle& r) { return kHeight - r.y1; }},
                         {"height - y0", [](const Rectangle& r) { return kHeight - r.y0; }},
                         {"height - y1 - 1", [](const Rectangle& r) { return kHeight - r.y1 - 1; }},
                         {"2 (y0 / 2)", [](const Rectangle& r) { return r.y0 / 2 * 2; }},
                         {"4 (y0 / 4)", [](const Rectangle& r) { return r.y0 / 4 * 4; }},
                         {"8 (y0 / 8)", [](const Rectangle& r) { return r.y0 / 8 * 8; }}};
constexpr End kHighX[] = {{"x1", [](const Rectangle& r) { return r.x1; }},
                          {"x1 + 1", [](const Rectangle& r) { return r.x1 + 1; }},
                          {"x1 - 1", [](const Rectangle& r) { return r.x1 - 1; }},
                          {"width", [](const Rectangle&) { return kWidth; }},
                          {"y1", [](const Rectangle& r) { return r.y1; }},
                          {"x0 + x1", [](const Rectangle& r) { return r.x0 + r.x1; }},
                          {"x1 - x0", [](const Rectangle& r) { return r.x1 - r.x0; }},
                          {"width - x0", [](const Rectangle& r) { return kWidth - r.x0; }},
                          {"x1 rounded up to 2", [](const Rectangle& r) { return (r.x1 + 1) / 2 * 2; }},
                          {"x1 rounded up to 4", [](const Rectangle& r) { return (r.x1 + 3) / 4 * 4; }},
                          {"x1 rounded up to 8", [](const Rectangle& r) { return (r.x1 + 7) / 8 * 8; }}};
constexpr End kHighY[] = {{"y1", [](const Rectangle& r) { return r.y1; }},
                          {"y1 + 1", [](const Rectangle& r) { return r.y1 + 1; }},
                          {"y1 - 1", [](const Rectangle& r) { return r.y1 - 1; }},
                          {"height", [](const Rectangle&) { return kHeight; }},
                          {"x1", [](const Rectangle& r) { return r.x1; }},
                          {"y0 + y1", [](const Rectangle& r) { return r.y0 + r.y1; }},
                          {"y1 - y0", [](const Rectangle& r) { return r.y1 - r.y0; }},
                          {"height - y0", [](const Rectangle& r) { return kHeight - r.y0; }},
                          {"height - y1", [](const Rectangle& r) { return kHeight - r.y1; }},
                          {"height - y0 - 1", [](const Rectangle& r) { return kHeight - r.y0 - 1; }},
                          {"y1 rounded up to 2", [](const Rectangle& r) { return (r.y1 + 1) / 2 * 2; }},
                          {"y1 rounded up to 4", [](const Rectangle& r) { return (r.y1 + 3) / 4 * 4; }},
                          {"y1 rounded up to 8", [](const Rectangle& r) { return (r.y1 + 7) / 8 * 8; }}};

// What an uncommon one of these means, in words.
std::string in_words(const End& x0, const End& y0, const End& x1, const End& y1) {
  const auto is = [](const End& end, const char* what) { return std::string_view(end.text) == what; };
  const bool low = is(x0, "x0") && is(y0, "y0"), high = is(x1, "x1") && is(y1, "y1"),
             sides = is(x0, "x0") && is(x1, "x1");
  if (is(x0, "0") && is(y0, "0") && is(x1, "width") && is(y1, "height")) return "the scissor is ignored";
  if (sides && is(y0, "height - y1") && is(y1, "height - y0")) return "the scissor is counted from the bottom row";
  if (low && is(x1, "x1 + 1") && is(y1, "y1 + 1"))
    return "the scissor's end is inclusive: a column and a row too many are drawn";
  if (low && is(x1, "x1 + 1") && is(y1, "y1"))
    return "the scissor's right end is inclusive: a column too many is drawn";
  if (low && is(x1, "x1") && is(y1, "y1 + 1")) return "the scissor's lower end is inclusive: a row too many is drawn";
  if (low && (is(x1, "x1 - 1") || is(y1, "y1 - 1"))) return "the scissor ends too early";
  if (high && (is(x0, "x0 + 1") || is(y0, "y0 + 1"))) return "the scissor begins too late";
  if (high && (is(x0, "x0 - 1") || is(y0, "y0 - 1"))) return "the scissor begins too early";
  if (low && is(x1, "x0 + x1") && is(y1, "y0 + y1")) return "the scissor's end is taken for its size";
  if (low && is(x1, "x1 - x0") && is(y1, "y1 - y0")) return "the scissor's size is taken for its end";
  if (sides && is(y0, "0") && is(y1, "height")) return "the scissor cuts columns alone, not rows";
  if (is(x0, "0") && is(x1, "width") && is(y0, "y0") && is(y1, "y1")) return "the scissor cuts rows alone, not columns";
  if (is(x0, "y0") && is(y0, "x0")) return "the scissor's x and y are exchanged";
  return "the scissor's rectangle is another one";
}

std::string scissor_fit(const std::vector<Rectangle>& given, const std::vector<Rectangle>& got) {
  std::size_t usual = 100;
  std::string best;
  for (const End& x0 : kLowX) {
    for (const End& x1 : kHighX) {
      // Columns first: most of the candidates end here.
      bool columns = true;
      for (std::size_t i = 0; i < given.size() && columns; ++i) {
        const Rectangle want = Rectangle{x0.of(given[i]), 0, x1.of(given[i]), kHeight}.on_target();
        columns = got[i].empty() || (want.x0 == got[i].x0 && want.x1 == got[i].x1);
      }
      if (!columns) continue;
      for (const End& y0 : kLowY) {
        for (const End& y1 : kHighY) {
          bool good = true;
          for (std::size_t i = 0; i < given.size() && good; ++i) {
            const Rectangle& r = given[i];
            good = Rectangle{x0.of(r), y0.of(r), x1.of(r), y1.of(r)}.on_target() == got[i];
          }
          if (!good) continue;
          // The plainest: as few ends as may be that are not what they should.
          const std::size_t odd =
              static_cast<std::size_t>((&x0 != kLowX) + (&y0 != kLowY) + (&x1 != kHighX) + (&y1 != kHighY));
          if (odd >= usual) continue;
          usual = odd;
          best = in_words(x0, y0, x1, y1);
          if (best.find("ignored") == std::string::npos) {
            best += std::string(": [x0, x1) x [y0, y1) is taken for [") + x0.text + ", " + x1.text + ") x [" + y0.text +
                    ", " + y1.text + ")";
          }
        }
      }
    }
  }
  return best;
}

}  // namespace

namespace {

// Scissors that reach beyond the target.
std::string about_scissor_beside(const Questions& questions) {
  constexpr Rectangle kBeside[] = {{-3, 2, 11, 9}, {2, -5, 9, 8}, {-4, -4, 9, 9}, {5, 3, 40, 9}, {4, 2, 9, 50}};
  std::array<int, 2> wrong{}, empty{}, whole{};  // of those that begin before the target, and those that end beyond it
  for (std::size_t i = 0; i < std::size(kBeside); ++i) {
    const Rectangle& r = kBeside[i];
    Scene scene = over_all_scene(kWidth, kHeight, questions.model.culled);
    scene.draws[0].scissor = Scissor{r.x0, r.y0, r.x1, r.y1};
    const auto shown = answer(questions, scene);
    if (!shown) return "";
    const std::size_t kind = i < 3 ? 0 : 1;
    wrong[kind] += shown->right.count != shown->rival.count;
    const auto drawn = std::ranges::count_if(shown->rival.count, [](std::uint32_t n) { return n != 0; });
    empty[kind] += drawn == 0, whole[kind] += drawn == kWidth * kHeight;
  }
  const auto say = [&](std::size_t kind, int all, const std::string& which) -> std::string {
    if (wrong[kind] != all) return "";
    return "with a scissor that " + which + " the target " +
           (empty[kind] == all   ? "nothing is drawn"
            : whole[kind] == all ? "everything is drawn"
                                 : "another part is drawn");
  };
  if (std::string sentence = say(0, 3, "begins left of or above"); !sentence.empty()) {
    return sentence + ": its sides are read without sign, or clamped wrongly";
  }
  return say(1, 2, "ends beyond");
}

}  // namespace

std::string about_scissor(const Questions& questions) {
  constexpr Rectangle kGiven[] = {{3, 2, 11, 9}, {5, 5, 6, 6},  {1, 1, 4, 4},   {12, 8, 16, 12},
                                  {7, 1, 8, 11}, {4, 6, 14, 7}, {1, 1, 15, 11}, {6, 3, 13, 10},
                                  {9, 2, 16, 5}, {2, 7, 5, 12}, {0, 0, 3, 5},   {2, 4, 9, 10}};
  std::vector<Rectangle> given, got;
  bool right = true, rectangles = true;
  for (const Rectangle& r : kGiven) {
    Scene scene = over_all_scene(kWidth, kHeight, questions.model.culled);
    scene.draws[0].scissor = Scissor{r.x0, r.y0, r.x1, r.y1};
    const auto shown = answer(questions, scene);
    if (!shown) continue;
    Rectangle seen{kWidth, kHeight, 0, 0};
    int covered = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (shown->rival.count[static_cast<std::size_t>(y * kWidth + x)] == 0) continue;
        seen = {std::min(seen.x0, x), std::min(seen.y0, y), std::max(seen.x1, x + 1), std::max(seen.y1, y + 1)};
        ++covered;
      }
    }
    rectangles = rectangles && (covered == 0 || covered == (seen.x1 - seen.x0) * (seen.y1 - seen.y0));
    right = right && shown->right.count == shown->rival.count;
    given.push_back(r);
    got.push_back(seen);
  }
  if (right && given.size() >= 6) return about_scissor_beside(questions);
  if (given.size() < 6) return "";
  const std::string fit = rectangles ? scissor_fit(given, got) : "";
  if (!fit.empty()) return fit;
  return "draws with a scissor are wrong, without it they are right";
}

namespace {

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
    if (!plain || differs(*plain)) return "";
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
  if (keeps(ramp, 0, 1)) return "";
  if (keeps(ramp, -INFINITY, INFINITY)) {
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
  return about_depth_of_samples(questions);
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
  const auto read_only = seen(questions, DepthTest::less, {0.25, 0.75}, true, std::nullopt, false);
  if (read_only && *read_only == 0) return "depth is written by draws that should not write it";
  return found;
}

}  // namespace surefill::judge
