// SPDX-License-Identifier: Apache-2.0
//
// Questions about what goes wrong by place and by order: in blocks of pixels, after other triangles, by the stride of rows, and
// far from the origin, where positions and slopes have too few bits.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "certify/judge/questions.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;
using Corners = std::array<SceneVertex, 3>;

// A triangle about the sample of one pixel.
Corners small(double x, double y, const Model& model) {
  x += model.x.place, y += model.y.place;
  return {corner(x - 0.25, y - 0.25), corner(x + 0.375, y - 0.125), corner(x - 0.125, y + 0.375)};
}

// --- blocks

constexpr int kSide = 32;

std::optional<std::vector<int>> drawn_pixels(const Questions& questions, const std::vector<int>& pixels) {
  Scene scene = empty_scene(kSide, kSide);
  for (const int p : pixels) {
    add_triangle(scene.draws[0], small(p % kSide, p / kSide, questions.model), questions.model.culled);
  }
  const auto image = questions.rival(scene);
  if (!image || image->count.empty()) return std::nullopt;
  std::vector<int> drawn;
  for (const int p : pixels) {
    if (is_covered(*image, static_cast<std::size_t>(p))) drawn.push_back(p);
  }
  return drawn;
}

}  // namespace

// A triangle of one pixel at each pixel: where are they lost?
std::string about_blocks(const Questions& questions) {
  std::vector<int> all(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) all[static_cast<std::size_t>(i)] = i;
  const auto drawn = drawn_pixels(questions, all);
  if (!drawn || drawn->empty() || drawn->size() == all.size()) return "";
  // Alone it is lost, too, or this is about how many there are.
  int lost_alone = 0, lost = 0;
  for (int p = 5; p < kSide * kSide; p += 97) {
    const bool together = std::ranges::binary_search(*drawn, p);
    const auto alone = drawn_pixels(questions, {p});
    if (!alone) return "";
    if (together && alone->empty()) return "";
    lost += !together, lost_alone += alone->empty();
  }
  if (lost == 0) return "";
  if (lost_alone != lost) return "";  // it takes several triangles: about_many
  struct Kept {
    const char* text;
    bool (*is)(int x, int y, int n);
  };
  constexpr Kept kKept[] = {{"a triangle is lost in blocks of %d x %d pixels of which it covers no corner: blocks "
                             "are rejected by their corners alone",
                             [](int x, int y, int n) { return (x == 0 || x == n - 1) && (y == 0 || y == n - 1); }},
                            {"a triangle is lost in blocks of %d x %d pixels whose first pixel it does not cover: "
                             "blocks are rejected by that one alone",
                             [](int x, int y, int) { return x == 0 && y == 0; }},
                            {"a triangle is lost in blocks of %d x %d pixels whose last pixel it does not cover: "
                             "blocks are rejected by that one alone",
                             [](int x, int y, int n) { return x == n - 1 && y == n - 1; }},
                            {"a triangle is lost in blocks of %d x %d pixels whose middle it does not cover: "
                             "blocks are rejected by their middle alone",
                             [](int x, int y, int n) { return x == n / 2 && y == n / 2; }},
                            {"a triangle is lost in blocks of %d x %d pixels whose middle it does not cover: "
                             "blocks are rejected by their middle alone",
                             [](int x, int y, int n) { return x == n / 2 - 1 && y == n / 2 - 1; }},
                            {"a triangle is lost in blocks of %d x %d pixels of whose border it covers nothing: "
                             "blocks are rejected by their border alone",
                             [](int x, int y, int n) { return x == 0 || x == n - 1 || y == 0 || y == n - 1; }}};
  for (const int n : {4, 8, 16, 32, 2}) {
    for (const Kept& kept : kKept) {
      const bool fits = std::ranges::all_of(all, [&](int p) {
        return std::ranges::binary_search(*drawn, p) == kept.is(p % kSide % n, p / kSide % n, n);
      });
      if (fits) return text(kept.text, n, n);
    }
  }
  return "";
}

// --- after other triangles

// Three plain triangles of which another one comes after the first.
std::string about_triangles_before(const Questions& questions) {
  struct Before {
    const char* text;
    Corners corners;
    void (*give)(SceneDraw& draw) = nullptr;
  };
  const auto at = [](double x, double y, double w = 1) { return corner(x, y, 0.5, w); };
  const auto behind = [](double x, double y) {
    SceneVertex v = corner(x, y, 0.5, 1);
    v.w = -1, v.z = -0.5f;
    return v;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<Before, 18> kinds{{
      {"another one", {at(2.25, 14.125), at(9.5, 15.25), at(3.125, 21.75)}},
      {"one without area (three vertices in a line)", {at(2.25, 14.25), at(4.25, 16.25), at(6.25, 18.25)}},
      {"one without area (one vertex three times)", {at(4.25, 16.25), at(4.25, 16.25), at(4.25, 16.25)}},
      {"one wholly left of the target", {at(-9.25, 4.25), at(-2.5, 5.25), at(-8.25, 14.25)}},
      {"one wholly above the target", {at(4.25, -9.25), at(14.5, -8.25), at(8.25, -2.25)}},
      {"one wholly right of the target", {at(26.25, 4.25), at(34.5, 5.25), at(28.25, 14.25)}},
      {"one wholly below the target", {at(4.25, 26.25), at(14.5, 28.25), at(8.25, 36.25)}},
      {"one wholly behind the eye", {behind(4.25, 4.25), behind(14.5, 5.25), behind(6.25, 14.25)}},
      {"one with a vertex behind the eye", {at(2.25, 14.125), at(9.5, 15.25), behind(-3.125, -21.75)}},
      {"one that covers no sample", {at(3.625, 14.625), at(3.875, 14.625), at(3.75, 14.875)}},
      {"one that faces away", {at(2.25, 14.125), at(3.125, 21.75), at(9.5, 15.25)}},
      {"one that reaches beyond the target", {at(-8.25, 14.125), at(9.5, 15.25), at(-3.125, 30.75)}},
      {"one of other W", {at(2.25, 14.125, 2), at(9.5, 15.25, 4), at(3.125, 21.75, 0.5)}},
      {"one whose vertices are some 1,000 pixels away",
       {at(1000.25, 900.125), at(1000.5, 1500.25), at(1200.125, 1210.75)}},
      {"one that is culled",
       {at(2.25, 14.125), at(3.125, 21.75), at(9.5, 15.25)},
       [](SceneDraw& d) { d.cull = Cull::back; }},
      {"one wholly outside the scissor",
       {at(2.25, 23.125), at(9.5, 23.25), at(3.125, 23.875)},
       [](SceneDraw& d) {
         d.scissor = Scissor{0, 0, 24, 23};
       }},
      {"one wholly beyond depths 0 to 1, with depth clipping,",
       {corner(2.25, 14.125, 1.5), corner(9.5, 15.25, 1.5), corner(3.125, 21.75, 1.5)},
       [](SceneDraw& d) { d.depth_mode = DepthMode::clip; }},
      {"one with a NaN", {corner(nan, 14.125), at(9.5, 15.25), at(3.125, 21.75)}},
  }};
  const auto near = [](double x, double y) { return corner(x, y, 0.25); };  // they are seen, whatever else lies there
  const std::array<Corners, 3> plain{{{near(1.125, 1.25), near(9.5, 2.125), near(2.25, 9.625)},
                                      {near(13.125, 1.25), near(22.5, 2.125), near(14.25, 9.625)},
                                      {near(13.125, 13.25), near(22.5, 14.125), near(14.25, 21.625)}}};
  constexpr std::array<std::size_t, 3> kInside{4 * 24 + 4, 4 * 24 + 16, 16 * 24 + 16};
  Scene without = empty_scene(24, 24);
  for (const Corners& corners : plain) add_triangle(without.draws[0], corners, questions.model.culled);
  const auto control = answer(questions, without);
  if (!control || differs(*control)) return "";
  std::string which, shifted;
  int bad = 0, asked = 0, shift = 0;
  std::array<bool, 2> lost{true, true}, fine{true, true};
  for (const Before& kind : kinds) {
    if (kind.give && questions.model.culled != Cull::none) continue;
    Scene scene = empty_scene(24, 24);
    if (kind.give) kind.give(scene.draws[0]);
    Scene alone = scene, at_end = scene;
    for (const Corners& corners : plain) add_triangle(at_end.draws[0], corners, questions.model.culled);
    add_triangle(scene.draws[0], plain[0], questions.model.culled);
    for (Scene* one : {&scene, &alone, &at_end}) add_triangle(one->draws[0], kind.corners);
    for (const std::size_t i : {1u, 2u}) add_triangle(scene.draws[0], plain[i], questions.model.culled);
    const auto single = answer(questions, alone), shown = answer(questions, scene);
    if (!single || !shown) continue;
    ++asked;
    if (single->right.count != single->rival.count) continue;
    const bool counts = shown->right.count == shown->rival.count;
    if (counts && shown->right.index == shown->rival.index) continue;
    // What is as wrong with that one at the end is no matter of what comes after.
    const auto last = answer(questions, at_end);
    if (!last || last->right.count != last->rival.count) continue;
    if (counts) {
      const auto moved = [&](std::size_t i) {
        return static_cast<int>(shown->rival.index[kInside[i]] - shown->right.index[kInside[i]]);
      };
      if (shown->rival.index.empty() || last->right.index[kInside[2]] != last->rival.index[kInside[2]]) continue;
      if (moved(0) != 0 || moved(1) <= 0 || moved(1) > 8 || moved(2) != moved(1)) continue;
      if (shifted.empty()) shifted = kind.text, shift = moved(1);
      continue;
    }
    ++bad;
    if (bad <= 3) which += (which.empty() ? "" : ", or ") + std::string(kind.text);
    for (const std::size_t i : {0u, 1u}) {
      const bool is_lost = shown->rival.count[kInside[i + 1]] == 0;
      lost[i] = lost[i] && is_lost, fine[i] = fine[i] && !is_lost;
    }
  }
  if (bad == 0 && !shifted.empty()) {
    return "triangles of a draw that come after " + shifted +
           text(" have an index that is %d too large: what the clipper makes of that one is numbered, too", shift);
  }
  if (bad == 0 || asked < 6) return "";
  if (2 * bad > asked || bad > 3) which = "others";
  if (lost[0] && lost[1]) return "the triangles of a draw that come after " + which + " are lost";
  if (lost[0] && fine[1]) return "the triangle that comes after " + which + " is lost";
  return "a triangle that comes after " + which + " is wrong: something is kept from triangle to triangle";
}

// --- what a draw has of the one before it

std::string about_vertex_cache(const Questions& questions) {
  const std::array<Corners, 2> corners{{{corner(1.125, 1.25), corner(9.5, 2.125), corner(2.25, 9.625)},
                                        {corner(13.125, 13.25), corner(22.5, 14.125), corner(14.25, 21.625)}}};
  constexpr std::size_t kFirst = 4 * 24 + 4, kSecond = 16 * 24 + 16;
  Scene scene = empty_scene(24, 24);
  add_triangle(scene.draws[0], corners[0], questions.model.culled);
  add_triangle(scene.draws.emplace_back(), corners[1], questions.model.culled);
  const auto image = questions.rival(scene);
  if (image && !image->count.empty() && image->count[kFirst] == 2 && image->count[kSecond] == 0) {
    return "a draw has vertices of the draw before it, those of the same numbers: what was transformed is kept between "
           "draws";
  }
  // In one draw, numbers that differ by a power of two.
  for (const int bits : {2, 3, 4, 5, 6, 7, 8, 10, 12, 16}) {
    Scene single = empty_scene(24, 24);
    add_triangle(single.draws[0], corners[0], questions.model.culled);
    single.draws[0].vertices.resize(std::size_t{1} << bits, corner(-8, -8));
    add_triangle(single.draws[0], corners[1], questions.model.culled);
    const auto shown = questions.rival(single);
    if (!shown || shown->count.empty()) continue;
    if (shown->count[kFirst] != 2 || shown->count[kSecond] != 0) continue;
    // Where that one was not used before, it may be the number that has too few bits.
    single.draws[0].triangles.erase(single.draws[0].triangles.begin());
    const auto unused = questions.rival(single);
    if (unused && !unused->count.empty() && unused->count[kFirst] == 1) {
      return text(
          "vertex numbers have %d bits: larger ones are taken for others, as where an index goes through a "
          "smaller integer",
          bits);
    }
    return text(
        "a vertex is taken for one that was used before if its number is that one's + %d: a vertex cache "
        "looks at the last %d bits alone",
        1 << bits, bits);
  }
  return "";
}

// --- beyond the ends of rows

std::string about_ends_of_rows(const Questions& questions) {
  constexpr int kRows = 6, kLeast = 3;
  constexpr std::array<int, 6> kWidths{21, 22, 23, 25, 26, 28};
  for (const int n : {4, 8, 16}) {
    int wrong = 0;
    bool fits = true;
    for (const int width : kWidths) {
      Scene scene = empty_scene(width, kRows);
      add_triangle(scene.draws[0], {corner(12.25, -60), corner(width + 90.0, 3), corner(12.25, 66)},
                   questions.model.culled);
      const auto rival = questions.rival(scene), right = questions.right(scene);
      if (!rival || !right || rival->count.empty() || right->count.empty()) return "";
      wrong += rival->count != right->count;
      std::vector<std::uint32_t> counts = right->count;
      const int beyond = (width + n - 1) / n * n - width;
      for (int y = 1; y < kRows; ++y) {
        for (int x = 0; x < beyond; ++x) ++counts[static_cast<std::size_t>(y * width + x)];
      }
      fits = fits && counts == rival->count;
    }
    if (wrong < kLeast) return "";
    if (fits)
      return text(
          "pixels are drawn in groups of %d, and what of the last group lies beyond the right border comes at the "
          "start of the next row: it is not masked",
          n);
  }
  return "";
}

// --- the stride of rows

namespace {

struct Stride {
  const char* text;
  int (*of)(int width, int height, int n);
  std::array<int, 2> numbers;
};
constexpr Stride kStrides[] = {
    {"the height", [](int, int height, int) { return height; }, {1, 1}},
    {"the width rounded up to a multiple of %d", [](int w, int, int n) { return (w + n - 1) / n * n; }, {2, 64}},
    {"the width rounded down to a multiple of %d", [](int w, int, int n) { return w / n * n; }, {2, 16}},
    {"the width rounded up to a power of two",
     [](int w, int, int) {
       int up = 1;
       while (up < w) up *= 2;
       return up;
     },
     {1, 1}},
    {"the width + %d", [](int w, int, int n) { return w + n; }, {1, 2}},
    {"the width - %d", [](int w, int, int n) { return w - n; }, {1, 2}}};

// Of depth alone: a triangle over everything, of another depth at each pixel.
std::string about_rows_of_depth(const Questions& questions) {
  constexpr std::array<std::array<int, 2>, 4> kSizes{{{21, 9}, {18, 12}, {37, 7}, {20, 15}}};
  std::vector<std::array<Image, 2>> all;
  for (const auto& [width, height] : kSizes) {
    Scene scene = empty_scene(width, height);
    add_triangle(scene.draws[0], {corner(-8, -8, 0), corner(120, -8, 0.25), corner(-8, 56, 0.75)},
                 questions.model.culled);
    const auto rival = questions.rival(scene), right = questions.right(scene);
    if (!rival || !right || rival->depth.empty() || rival->count != right->count) return "";
    all.push_back({*right, *rival});
  }
  for (const Stride& stride : kStrides) {
    for (int n = stride.numbers[0]; n <= stride.numbers[1]; n *= 2) {
      bool fits = true, differs = false;
      for (const auto& [right, rival] : all) {
        const int apart = stride.of(right.width, right.height, n);
        for (int s = 0; apart > 0 && s < right.width * right.height; ++s) {
          const int x = s % apart, y = s / apart;
          if (x >= right.width || y >= right.height) continue;
          const auto from = static_cast<std::size_t>(y * right.width + x), to = static_cast<std::size_t>(s);
          fits = fits && std::abs(rival.depth[to] - right.depth[from]) < 0x1p-12;
          differs = differs || std::abs(right.depth[to] - right.depth[from]) > 0x1p-10;
        }
      }
      if (fits && differs)
        return "rows of depth come as far apart as " + text(stride.text, n) + ", not as the width: it is skewed";
    }
  }
  return "";
}

}  // namespace

std::string about_strides(const Questions& questions) {
  struct Shown {
    int width, height;
    Image right, rival;
  };
  std::vector<Shown> all;
  int wrong = 0;
  for (const auto& [width, height] : std::initializer_list<std::array<int, 2>>{{16, 16},
                                                                               {32, 12},
                                                                               {12, 32},
                                                                               {20, 20},
                                                                               {21, 17},
                                                                               {17, 21},
                                                                               {22, 30},
                                                                               {23, 9},
                                                                               {37, 13},
                                                                               {66, 10},
                                                                               {18, 40}}) {
    Scene scene = empty_scene(width, height);
    const int side = std::min(width, height) - 4;
    add_triangle(scene.draws[0], {corner(1.25, 1.25), corner(1.25 + side, 1.25), corner(1.25, 1.25 + side)},
                 questions.model.culled);
    const auto rival = questions.rival(scene), right = questions.right(scene);
    if (!rival || !right || rival->count.empty()) continue;
    wrong += rival->count != right->count;
    all.push_back({width, height, *right, *rival});
  }
  if (wrong == 0) return about_rows_of_depth(questions);
  if (wrong < 3 || all.size() < 8) return "";
  for (const Stride& stride : kStrides) {
    for (int n = stride.numbers[0]; n <= stride.numbers[1]; n *= 2) {
      const bool fits = std::ranges::all_of(all, [&](const Shown& shown) {
        const auto apart = static_cast<std::size_t>(stride.of(shown.width, shown.height, n));
        const auto width = static_cast<std::size_t>(shown.width);
        std::vector<std::uint32_t> counts(shown.right.count.size(), 0);
        for (std::size_t s = 0; s < counts.size(); ++s) {
          const std::size_t to = s / width * apart + s % width;
          if (to < counts.size()) counts[to] += shown.right.count[s];
        }
        return counts == shown.rival.count;
      });
      if (!fits) continue;
      return "rows of an image are kept as far apart as " + text(stride.text, n) +
             ", not as the width: the stride is wrong, and the picture is sheared";
    }
  }
  return "";
}

// --- how many bits positions have

namespace {

// How far an edge at `edge` is from where it shows, at least; the first covered sample is at `first`.
double certain_error(double edge, double first) {
  return std::max({0.0, first - 1 - edge, edge - first});
}

constexpr std::array<int, 8> kPlaces{20, 60, 125, 250, 500, 1000, 2000, 4000};

// Upright edges (level ones where turned) at these places, in sixteenths of a pixel around a sample; W of each row.
std::array<double, kPlaces.size()> errors_far(const Questions& questions, bool turned, bool perspective) {
  constexpr int kRows = 32, kLength = 4096;
  constexpr std::array<double, 5> kW{3, 5, 7, 11, 13};
  Scene scene = turned ? empty_scene(kRows, kLength) : empty_scene(kLength, kRows);
  const auto& along = turned ? questions.model.y : questions.model.x;
  const auto& across = turned ? questions.model.x : questions.model.y;
  const auto edge_of = [&](int place, int row) { return place + along.place + (row * 37 % 64 - 31.5) / 16; };
  for (const int place : kPlaces) {
    for (int row = 0; row < kRows; ++row) {
      const double w = perspective ? kW[static_cast<std::size_t>(row) % 5] : 1, edge = edge_of(place, row);
      const auto put = [&](double a, double b) {
        b += row + across.place;
        return turned ? corner(b, a, 0.5, w) : corner(a, b, 0.5, w);
      };
      add_triangle(scene.draws[0], {put(edge, -0.375), put(edge + 8, 0), put(edge, 0.375)}, questions.model.culled);
    }
  }
  std::array<double, kPlaces.size()> errors{};
  const auto image = questions.rival(scene);
  if (!image || image->count.empty()) return errors;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    for (int row = 0; row < kRows; ++row) {
      const int window = std::max(12, kPlaces[i] / 80), begin = kPlaces[i] - window;
      int first = begin;
      const auto covered = [&](int a) {
        return is_covered(*image, static_cast<std::size_t>(turned ? a * kRows + row : row * kLength + a));
      };
      while (first < kPlaces[i] + window && !covered(first)) ++first;
      if (first == kPlaces[i] + window || first == begin) continue;  // elsewhere: nothing is known
      errors[i] = std::max(errors[i], certain_error(edge_of(kPlaces[i], row), first + along.place));
    }
  }
  return errors;
}

}  // namespace

// Positions far from the origin.
std::string about_precision(const Questions& questions) {
  for (const bool perspective : {false, true}) {
    for (const bool turned : {false, true}) {
      const auto errors = errors_far(questions, turned, perspective);
      const double blur = (turned ? questions.model.y : questions.model.x).blur;
      const double last = errors.back();
      if (last < 1.0 / 8 + 2 * blur) continue;
      std::size_t first = 0;
      while (errors[first] < 1.0 / 16 + blur) ++first;
      const std::string axis = turned ? "y" : "x";
      const std::string whose =
          perspective ? "positions of vertices whose W is no power of two are off" : "positions are off";
      const std::string much = text(" by up to %.2g pixels at ", last) + axis + text(" = %d", kPlaces.back());
      // It grows with the position, as a number of so many bits has it; or is there from some place on.
      const double growth = last / std::max(errors[kPlaces.size() - 3], 1.0 / 16);
      if (growth > 2 || first + 3 >= kPlaces.size()) {
        return whose + much + ", and less nearer to 0: " + (perspective ? "1 / W has" : "they have") +
               text(" some %.0f bits", std::ceil(std::log2(kPlaces.back() / last)));
      }
      if (first == 0) return "";
      return whose + much + ", and right up to " + axis +
             text(" = %d: the grid gets coarser from there", kPlaces[first - 1]);
    }
  }
  return "";
}

// Long edges, steep and flat ones.
std::string about_slopes(const Questions& questions) {
  constexpr int kLength = 2048, kAcross = 64;
  constexpr std::array<int, 5> kWays{4, 11, 19, 31, 44};
  for (const bool turned : {false, true}) {
    const auto& along = turned ? questions.model.y : questions.model.x;
    const auto& across = turned ? questions.model.x : questions.model.y;
    std::array<double, 8> errors{};              // in each eighth of the way
    std::array<double, kWays.size()> of_ways{};  // of each edge
    for (std::size_t way = 0; way < kWays.size(); ++way) {
      Scene scene = turned ? empty_scene(kLength, kAcross) : empty_scene(kAcross, kLength);
      const auto put = [turned](double a, double b) { return turned ? corner(b, a) : corner(a, b); };
      const double a0 = 8.25, b0 = 0.25, a1 = a0 + kWays[way] + 0.125, b1 = kLength - 0.75;
      add_triangle(scene.draws[0], {put(a0, b0), put(62.5, 1000.25), put(a1, b1)}, questions.model.culled);
      const auto image = questions.rival(scene);
      if (!image || image->count.empty()) return "";
      for (int b = 40; b < kLength - 40; ++b) {
        const double edge = a0 + (a1 - a0) * (b + across.place - b0) / (b1 - b0);
        int first = 0;
        while (first < kAcross &&
               !is_covered(*image, static_cast<std::size_t>(turned ? first * kLength + b : b * kAcross + first))) {
          ++first;
        }
        if (first == 0 || first == kAcross) continue;
        const double error = certain_error(edge, first + along.place);
        double& most = errors[static_cast<std::size_t>(8 * b / kLength)];
        most = std::max(most, error);
        of_ways[way] = std::max(of_ways[way], error);
      }
    }
    const double end = errors.back(), least = 1.0 / 8 + 2 * along.blur;
    if (!turned && end >= least) {
      // It grows with the way alone, or this is about something else.
      for (std::size_t i = 0; i < 8; ++i) {
        if (errors[i] > end * static_cast<double>(i + 1) / 8 * 1.3 + 1.0 / 16) return "";
      }
      return text(
          "steep edges go astray along their way, by up to %.2g pixels after %d rows: the slope that is added row by "
          "row has an error of some 1/%.0f",
          end, kLength, std::exp2(std::round(std::log2(kLength / end))));
    }
    if (turned && of_ways[0] >= least) {
      // The flattest ones alone.
      std::size_t n = 0;
      while (n < kWays.size() && of_ways[n] >= least) ++n;
      for (std::size_t i = n; i < kWays.size(); ++i) {
        if (of_ways[i] >= least) return "";
      }
      return text(
          "flat edges, of %.0f and more pixels a row, are off by up to %.2g pixels: their slope is cut off at a "
          "largest "
          "one, or not precise enough",
          std::floor(kLength / (kWays[n - 1] + 0.125)), of_ways[0]);
    }
  }
  return "";
}

// Not numbers.
std::string about_not_numbers(const Questions& questions) {
  int all = 0, drawn = 0, others = 0;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int which = 0; which < 4; ++which) {
      Scene scene = empty_scene(16, 16);
      Corners c{corner(1.125, 1.25), corner(6.5, 2.125), corner(2.25, 14.625)};
      add_triangle(scene.draws[0], c, questions.model.culled);
      Corners broken{corner(9.125, 1.25), corner(14.5, 2.125), corner(10.25, 14.625)};
      (which == 0 ? broken[1].x : which == 1 ? broken[2].y : which == 2 ? broken[0].z : broken[1].w) = bad;
      add_triangle(scene.draws[0], broken, questions.model.culled);
      for (SceneVertex& v : c) v.x += 4;
      add_triangle(scene.draws[0], c, questions.model.culled);
      const auto image = questions.rival(scene);
      const auto wanted = questions.right(scene);
      if (!image || !wanted || image->count.empty()) continue;
      ++all;
      const std::size_t first = 4 * 16 + 2, last = 8 * 16 + 7;
      const bool good = image->count[first] == wanted->count[first] && image->count[last] == wanted->count[last];
      others += !good;
      for (std::size_t s = 0; s < image->count.size(); ++s) {
        if (wanted->count[s] != 0 || image->count[s] == 0) continue;
        ++drawn;
        break;
      }
    }
  }
  if (all < 4) return "";
  if (drawn > 0) return "a triangle with a NaN or an infinity is drawn: it should cover nothing";
  if (others > 0) return "a triangle with a NaN or an infinity takes other triangles with it";
  return "";
}

}  // namespace surefill::judge
