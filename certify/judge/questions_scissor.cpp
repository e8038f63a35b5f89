// SPDX-License-Identifier: Apache-2.0
//
// Questions about the scissor: which rectangle is taken for it, and where it is not looked at.
#include <algorithm>
#include <array>
#include <string_view>

#include "certify/judge/questions.hpp"

namespace surefill::judge {

namespace {

using corpus::Scene;

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
  for (const char* n : {"2", "4", "8"}) {
    const std::string up = std::string(" rounded up to ") + n;
    if (std::string_view(x0.text).starts_with(n) && std::string_view(y0.text).starts_with(n) &&
        std::string_view(x1.text).ends_with(up) && std::string_view(y1.text).ends_with(up)) {
      return std::string("blocks of ") + n + " x " + n +
             " pixels are drawn whole where they are inside a triangle and reach into the scissor: they are not cut at "
             "it";
    }
  }
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

// Triangles that cover no block of 4 x 4 pixels whole: does the scissor cut them?
bool small_triangles_are_cut(const Questions& questions) {
  for (const double y : {1.0, 4.0, 7.0}) {
    Scene scene = empty_scene(kWidth, kHeight);
    scene.draws[0].scissor = Scissor{8, 0, kWidth, kHeight};
    add_triangle(scene.draws[0], {corner(1.125, y), corner(14.875, y + 1.125), corner(1.25, y + 2.375)},
                 questions.model.culled);
    const auto shown = answer(questions, scene);
    if (!shown || differs(*shown)) return false;
  }
  return true;
}

}  // namespace

std::string about_scissor(const Questions& questions) {
  constexpr Rectangle kGiven[] = {{3, 2, 11, 9}, {5, 5, 6, 6},  {1, 1, 4, 4},   {12, 8, 16, 12},
                                  {7, 1, 8, 11}, {4, 6, 14, 7}, {1, 1, 15, 11}, {6, 3, 13, 10},
                                  {9, 2, 16, 5}, {2, 7, 5, 12}, {0, 0, 3, 5},   {2, 4, 9, 10}};
  std::vector<Rectangle> given, got;
  bool right = true, rectangles = true;
  for (const Rectangle& r : kGiven) {
    Scene scene = empty_scene(kWidth, kHeight);
    // No edge is near the target: blocks that are covered whole have a way of their own.
    add_triangle(scene.draws[0], {corner(-8, -8), corner(56, -8), corner(-8, 56)}, questions.model.culled);
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
  if (fit == "the scissor is ignored" && small_triangles_are_cut(questions)) {
    return "the scissor is ignored in blocks of pixels that a triangle covers whole; in those that its edges pass it "
           "is "
           "not";
  }
  if (!fit.empty()) return fit;
  return "draws with a scissor are wrong, without it they are right";
}

}  // namespace surefill::judge
