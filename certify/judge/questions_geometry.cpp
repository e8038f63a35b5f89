// SPDX-License-Identifier: Apache-2.0
//
// Questions about which triangles are drawn, and where: many, small, large and far ones, and on which targets.
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

// --- many triangles

constexpr int kCells = 64;

// Triangle t over the first pixel of the t-th cell of two pixels each way.
Scene board(int draws, Cull culled) {
  Scene scene = empty_scene(2 * kCells, 2 * kCells);
  scene.draws.resize(static_cast<std::size_t>(draws));
  for (int t = 0; t < kCells * kCells; ++t) {
    const double x = 2 * (t % kCells), y = 2 * (t / kCells);
    add_triangle(scene.draws[static_cast<std::size_t>(t * draws / (kCells * kCells))],
                 {corner(x + 0.125, y + 0.125), corner(x + 1.375, y + 0.25), corner(x + 0.25, y + 1.375)}, culled);
  }
  return scene;
}

std::size_t cell(int t) {
  return static_cast<std::size_t>(2 * (t / kCells) * 2 * kCells + 2 * (t % kCells));
}

std::string about_lost(const std::vector<int>& lost, int all, const char* of) {
  if (lost.empty()) return "";
  const auto count = static_cast<int>(lost.size());
  if (count == all) return "";
  if (lost.back() == all - 1 && lost.back() - lost.front() == count - 1) {
    if (count == 1) return std::string("the last triangle of ") + of + " is lost";
    return "all triangles of " + std::string(of) + " after the first " + std::to_string(all - count) + " are lost";
  }
  if (lost.front() == 0 && lost.back() == count - 1) {
    if (count == 1) return std::string("the first triangle of ") + of + " is lost";
    return "the first " + std::to_string(count) + " triangles of " + of + " are lost";
  }
  if (count < 2) return "";
  const int step = lost[1] - lost[0];
  for (std::size_t i = 1; i < lost.size(); ++i) {
    if (lost[i] - lost[i - 1] != step) return "";
  }
  if (lost.front() >= step + 1 || lost.back() + step < all) return "";
  return "one of every " + std::to_string(step) + " triangles of " + of + " is lost: numbers " +
         std::to_string(lost[0]) + ", " + std::to_string(lost[1]) + " and so on, counted from 0";
}

std::vector<int> lost_on(const Image& image) {
  std::vector<int> lost;
  for (int t = 0; t < kCells * kCells; ++t) {
    if (!is_covered(image, cell(t))) lost.push_back(t);
  }
  return lost;
}

}  // namespace

// --- a pattern of pixels

namespace {

// "the last column of a target", "one column of every 64: columns 63, 127 and so on"; empty if these are no such lines.
std::string lines_text(const std::vector<int>& lines, int length, const std::string& name) {
  const auto count = static_cast<int>(lines.size());
  if (count == 1 && lines[0] == length - 1) return "the last " + name + " of a target";
  if (count == 1 && lines[0] == 0) return "the first " + name + " of a target";
  if (lines.back() - lines.front() == count - 1) {
    if (lines.back() == length - 1) return name + "s of a target beyond the first " + std::to_string(length - count);
    if (lines.front() == 0) return "the first " + std::to_string(count) + " " + name + "s of a target";
  }
  if (count < 2) return "";
  const int step = lines[1] - lines[0];
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i] - lines[i - 1] != step) return "";
  }
  if (lines.front() > step || lines.back() + step < length) return "";
  return "one " + name + " of every " + std::to_string(step) + " (" + name + "s " + std::to_string(lines[0]) + ", " +
         std::to_string(lines[1]) + " and so on, counted from 0)";
}

}  // namespace

// Triangles with an upright or level edge a quarter of a pixel beyond the samples of a column or row: is that one lost?
std::string about_boxes(const Questions& questions) {
  constexpr int kSize = 24;
  std::array<int, 4> lost{}, all{};
  bool others = false;                            // something else is wrong
  for (std::size_t side = 0; side < 4; ++side) {  // left, top, right, bottom
    for (int k = 0; k < 5; ++k) {
      const bool upright = side % 2 == 0, far = side >= 2;
      const int line = 7 + k;  // the pixel that is looked at, along
      const double edge = far ? line + 0.75 : line + 0.25, tip = far ? edge - 6.5 : edge + 6.5;
      const auto at = [upright](double along, double across) {
        return upright ? corner(along, across) : corner(across, along);
      };
      Scene scene = empty_scene(kSize, kSize);
      add_triangle(scene.draws[0], {at(edge, 4.25), at(edge, 19.75), at(tip, 12.125)}, questions.model.culled);
      const auto shown = answer(questions, scene);
      if (!shown) continue;
      int missing = 0, due = 0;
      for (int i = 0; i < kSize * kSize; ++i) {
        const auto s = static_cast<std::size_t>(i);
        const bool here = (upright ? i % kSize : i / kSize) == line;
        const bool right = shown->right.count[s] == shown->rival.count[s];
        if (here && shown->right.count[s] != 0) ++due, missing += shown->rival.count[s] == 0;
        // The tip may be in the box's other end.
        const int along = upright ? i % kSize : i / kSize;
        others = others || (!right && !here && std::abs(along - line) < 4);
      }
      ++all[side];
      lost[side] += due >= 8 && 10 * missing >= 8 * due;
    }
  }
  std::array<bool, 4> is{};
  bool any = false;
  for (std::size_t side = 0; side < 4; ++side) {
    if (all[side] < 4 || (lost[side] != 0 && lost[side] != all[side])) return "";
    is[side] = lost[side] != 0;
    any = any || is[side];
  }
  const auto place = questions.model;
  if (!any || others || place.x.place != 0.5 || place.y.place != 0.5) return "";
  constexpr std::array<const char*, 4> kNames{"first column", "first row", "last column", "last row"};
  std::string which;
  int count = 0;
  for (const std::size_t side : {0u, 1u, 2u, 3u}) {
    if (!is[side]) continue;
    which += std::string(count == 0 ? "the " : ", the ") + kNames[side];
    ++count;
  }
  const bool begins = is[0] || is[1], ends = is[2] || is[3];
  return which + " that a triangle reaches " + (count > 1 ? "are" : "is") + " lost: its box " +
         (begins && ends ? "is too small"
          : begins       ? "begins a pixel too late"
                         : "ends a pixel too early");
}

namespace {

std::string pattern_of(const Questions& questions, int kWidth, int kHeight, const Corners& corners) {
  Scene scene = empty_scene(kWidth, kHeight);
  add_triangle(scene.draws[0], corners, questions.model.culled);
  const auto shown = answer(questions, scene);
  if (!shown) return "";
  std::array<std::vector<int>, 2> wrong{std::vector<int>(static_cast<std::size_t>(kWidth), 0),
                                        std::vector<int>(static_cast<std::size_t>(kHeight), 0)};
  int all = 0, more = 0;
  std::array<int, 2> of_colour{};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto s = static_cast<std::size_t>(y * kWidth + x);
      const std::uint32_t n = shown->rival.count[s], right = shown->right.count[s];
      if (n == right) continue;
      ++all, ++wrong[0][static_cast<std::size_t>(x)], ++wrong[1][static_cast<std::size_t>(y)];
      ++of_colour[static_cast<std::size_t>((x + y) % 2)];
      more += n > right;
    }
  }
  if (all == 0 || all == kWidth * kHeight || (more != 0 && more != all)) return "";
  const std::string so = more == 0 ? " not drawn" : " drawn more than once";
  std::array<std::vector<int>, 2> lines;
  for (const std::size_t axis : {0u, 1u}) {
    const int length = axis == 0 ? kHeight : kWidth;
    for (std::size_t i = 0; i < wrong[axis].size(); ++i) {
      if (wrong[axis][i] == length) lines[axis].push_back(static_cast<int>(i));
    }
  }
  const auto columns = static_cast<int>(lines[0].size()), rows = static_cast<int>(lines[1].size());
  if (all == columns * kHeight + rows * kWidth - columns * rows) {
    const std::string x = columns > 0 ? lines_text(lines[0], kWidth, "column") : "",
                      y = rows > 0 ? lines_text(lines[1], kHeight, "row") : "";
    if ((columns > 0 && x.empty()) || (rows > 0 && y.empty())) return "";
    const bool several = (columns > 0 && rows > 0) || (x + y).find("s of a target") != std::string::npos;
    return x + (columns > 0 && rows > 0 ? " and " : "") + y + (several ? " are" : " is") + so;
  }
  if (all == kWidth * kHeight / 2 && (of_colour[0] == 0 || of_colour[1] == 0)) {
    return "every second pixel is" + so + ", as the fields of a chess board";
  }
  return "";
}

}  // namespace

// It is one of the target only if another triangle on another target has it, too.
std::string about_pattern(const Questions& questions) {
  std::string pattern = pattern_of(questions, 200, 150, over_all(200, 150));
  if (pattern.empty()) return "";
  constexpr int kWidth = 168, kHeight = 180;
  const Corners other{corner(kWidth, kHeight), corner(-kWidth, kHeight), corner(kWidth, -kHeight)};
  return pattern_of(questions, kWidth, kHeight, other) == pattern ? pattern : "";
}

std::string about_many(const Questions& questions) {
  constexpr int kAll = kCells * kCells;
  const auto one = questions.rival(board(1, questions.model.culled));
  if (!one) return "";
  const std::vector<int> lost = lost_on(*one);
  if (!lost.empty()) {
    if (std::string vertices = about_vertices(questions); !vertices.empty()) return vertices;
  }
  if (std::string which = about_lost(lost, kAll, "a draw"); !which.empty()) {
    const auto again = questions.rival(board(1, questions.model.culled));
    if (again && lost_on(*again) != lost && lost.size() > 1) {
      const std::vector<int> other = lost_on(*again);
      if (other.size() > 1 && other[1] - other[0] == lost[1] - lost[0]) {
        return "one of every " + std::to_string(lost[1] - lost[0]) +
               " triangles is lost, counted on from frame to frame";
      }
      return "";
    }
    return which;
  }
  if (!lost.empty() && lost.size() < kAll) {
    // The first so many of each tile are drawn.
    for (const int n : {8, 16, 32, 64}) {
      std::vector<int> room(static_cast<std::size_t>(2 * kCells / n * (2 * kCells / n)), 0), late = room;
      for (int t = 0; t < kAll; ++t) {
        const auto tile = static_cast<std::size_t>(2 * (t / kCells) / n * (2 * kCells / n) + 2 * (t % kCells) / n);
        const bool gone = std::ranges::binary_search(lost, t);
        room[tile] += !gone;
        late[tile] += gone ? 1 : late[tile] > 0 ? kAll : 0;  // one that is drawn after a lost one
      }
      if (std::ranges::max(late) >= kAll || std::ranges::min(room) != std::ranges::max(room)) continue;
      return text("a tile of %d pixels each way has room for %d triangles: further ones are lost there", n, room[0]);
    }
    return text("of 4,096 small triangles side by side in one draw %zu are lost, the first of them number %d",
                lost.size(), lost.front());
  }
  if (!lost.empty()) return "";
  const auto four = questions.rival(board(4, questions.model.culled));
  if (!four) return "";
  const std::vector<int> of_draws = lost_on(*four);
  if (of_draws.empty() || of_draws.size() == kAll) return "";
  std::array<std::vector<int>, 4> each;
  for (const int t : of_draws) each[static_cast<std::size_t>(4 * t / kAll)].push_back(4 * t % kAll / 4);
  std::string whole;
  for (std::size_t d = 0; d < 4; ++d) whole += each[d].size() == kAll / 4 ? '0' : each[d].empty() ? '1' : '?';
  if (whole == "0001") return "only the last draw of a frame is drawn";
  if (whole == "1000") return "only the first draw of a frame is drawn";
  if (whole == "0111") return "the first draw of a frame is lost";
  if (whole == "1110") return "the last draw of a frame is lost";
  return "with several draws in a frame triangles are lost, with one they are not";
}

namespace {

// Triangles of given identifiers.
std::string about_identifiers(const Questions& questions) {
  constexpr std::array<std::uint32_t, 9> kGiven{
      3, 200, 300, 5000, 70001, (1u << 24) + 1, (1u << 25) + 3, (1u << 31) + 5, 0xFFFFFFF3u};
  Scene scene = board(1, questions.model.culled);
  for (std::size_t t = 0; t < scene.draws[0].triangles.size(); ++t) {
    scene.draws[0].triangles[t].identifier = kGiven[std::min(t, kGiven.size() - 1)];
  }
  scene.draws[0].triangles.resize(kGiven.size());
  const auto image = questions.rival(scene);
  Scene numbered = scene;
  for (corpus::SceneTriangle& t : numbered.draws[0].triangles) t.identifier.reset();
  const auto without = questions.rival(numbered);
  if (!image || image->index.empty() || !without || without->index.empty()) return "";
  for (std::uint32_t t = 0; t < kGiven.size(); ++t) {
    if (without->index[cell(static_cast<int>(t))] != t) return "";
  }
  struct Form {
    const char* text;
    std::uint32_t (*of)(std::uint32_t given, std::uint32_t t);
  };
  constexpr Form kForms[] = {
      {"", [](std::uint32_t n, std::uint32_t) { return n; }},
      {"identifiers are ignored: the index is the triangle's place in the draw",
       [](std::uint32_t, std::uint32_t t) { return t; }},
      {"identifiers are counted on from the first one: those of the others are not read",
       [](std::uint32_t, std::uint32_t t) { return 3 + t; }},
      {"identifiers go through float32: those beyond 2^24 are rounded",
       [](std::uint32_t n, std::uint32_t) {
         return static_cast<std::uint32_t>(std::min(double{float(n)}, 4294967295.0));
       }},
      {"identifiers have 31 bits: larger ones overflow",
       [](std::uint32_t n, std::uint32_t) { return n & 0x7FFFFFFFu; }},
      {"identifiers have 24 bits: larger ones overflow", [](std::uint32_t n, std::uint32_t) { return n & 0xFFFFFFu; }},
      {"identifiers have 16 bits: larger ones overflow", [](std::uint32_t n, std::uint32_t) { return n & 0xFFFFu; }},
      {"identifiers have 8 bits: larger ones overflow", [](std::uint32_t n, std::uint32_t) { return n & 0xFFu; }}};
  for (const Form& form : kForms) {
    bool fits = true;
    for (std::uint32_t t = 0; t < kGiven.size() && fits; ++t) {
      fits = image->index[cell(static_cast<int>(t))] == form.of(kGiven[t], t);
    }
    if (fits) return form.text;
  }
  // As a float in the image, from which 2^24 and more come back rounded; the largest may be anything.
  for (std::uint32_t t = 0; t < kGiven.size(); ++t) {
    if (image->index[cell(static_cast<int>(t))] == kGiven[t]) continue;
    return text("of large identifiers of triangles some come back wrong, from %u on", kGiven[t]);
  }
  return "";
}

}  // namespace

// What is in the index of triangle t, where each has a pixel of its own.
std::string about_index(const Questions& questions) {
  constexpr int kAll = kCells * kCells;
  const auto one = questions.rival(board(1, questions.model.culled));
  if (!one || one->index.empty()) return "";
  struct Form {
    const char* text;
    std::uint32_t (*of)(std::uint32_t t, std::uint32_t all, std::uint32_t draw);  // `draw`: of how many triangles
  };
  constexpr Form kForms[] = {
      {"", [](std::uint32_t t, std::uint32_t, std::uint32_t) { return t; }},
      {"every index is 1 too large: it counts from 1",
       [](std::uint32_t t, std::uint32_t, std::uint32_t) { return t + 1; }},
      {"every index is 1 too small", [](std::uint32_t t, std::uint32_t, std::uint32_t) { return t - 1; }},
      {"indices count from the last triangle, not from the first",
       [](std::uint32_t t, std::uint32_t all, std::uint32_t) { return all - 1 - t; }},
      {"every index is 0", [](std::uint32_t, std::uint32_t, std::uint32_t) { return 0u; }},
      {"the index is that of the triangle's first vertex, not the triangle's number",
       [](std::uint32_t t, std::uint32_t, std::uint32_t) { return 3 * t; }},
      {"indices have 8 bits: larger ones overflow",
       [](std::uint32_t t, std::uint32_t, std::uint32_t) { return t & 0xFF; }},
      {"indices stop at 255: they have 8 bits",
       [](std::uint32_t t, std::uint32_t, std::uint32_t) { return std::min(t, 255u); }},
      {"indices have 10 bits: larger ones overflow",
       [](std::uint32_t t, std::uint32_t, std::uint32_t) { return t & 0x3FF; }},
      {"every index is that of the last triangle of the draw",
       [](std::uint32_t, std::uint32_t all, std::uint32_t) { return all - 1; }},
      {"each draw counts its triangles from 0: the index does not go on from draw to draw",
       [](std::uint32_t t, std::uint32_t, std::uint32_t draw) { return t % draw; }},
      {"the number of triangles of the draws before is added to the index once more: it goes on over draws",
       [](std::uint32_t t, std::uint32_t, std::uint32_t draw) { return t + t / draw * draw; }},
      {"the index is the draw's number, not the triangle's",
       [](std::uint32_t t, std::uint32_t, std::uint32_t draw) { return t / draw; }}};
  // Triangles that do not show: without area, and beside the target.
  Scene hidden = board(1, questions.model.culled);
  SceneDraw& some = hidden.draws[0];
  some.triangles.resize(4);
  some.triangles[0].vertices[1] = some.triangles[0].vertices[2];
  for (const std::uint32_t v : some.triangles[2].vertices) some.vertices[v].x -= 40;
  const auto shows = questions.rival(hidden);
  if (shows && !shows->index.empty() && one->index[cell(3)] == 3 && shows->index[cell(1)] == 0 &&
      shows->index[cell(3)] == 1) {
    return "the index counts only triangles that are drawn: those before it that have no area or lie beside the target "
           "are left out";
  }
  const auto follows = [](const Image& image, const Form& form, int draws) {
    for (int t = 0; t < kAll; ++t) {
      if (image.index[cell(t)] !=
          form.of(static_cast<std::uint32_t>(t), kAll, static_cast<std::uint32_t>(kAll / draws))) {
        return false;
      }
    }
    return true;
  };
  for (const Form& form : kForms) {
    if (!follows(*one, form, 1)) continue;
    if (form.text[0] != '\0') return form.text;
    if (one->index[2 * kCells + 1] == 0) return "where nothing is drawn the index is 0, which is a triangle's";
    const auto four = questions.rival(board(4, questions.model.culled));
    for (const Form& other : kForms) {
      if (four && !four->index.empty() && follows(*one, other, 1) && follows(*four, other, 4)) {
        if (other.text[0] != '\0') return other.text;
        break;
      }
    }
    break;
  }
  // One of many triangles, of which the others lie beside the target.
  Scene scene = empty_scene(8, 8);
  add_triangle(scene.draws[0], {corner(1.125, 1.25), corner(6.5, 2.125), corner(2.25, 6.625)}, questions.model.culled);
  SceneDraw& draw = scene.draws[0];
  for (int i = 0; i < 3; ++i) draw.vertices.push_back(corner(-8 + i, -8 - i * i));
  draw.triangles.insert(draw.triangles.begin(), 65999, {{3, 4, 5}, std::nullopt});
  const auto image = questions.rival(scene);
  if (image && !image->index.empty() && image->index[3 * 8 + 3] == (65999 & 0xFFFF)) {
    return "indices have 16 bits: larger ones overflow";
  }
  return about_identifiers(questions);
}

// Triangles of which one vertex lies far beside the target.
std::string about_far(const Questions& questions) {
  // How far it reaches, how wide and high it is, and the largest edge function on the target.
  using Told = std::array<double, 4>;
  std::vector<Told> wrong, right;
  bool nothing = true;
  for (int k = 5; k <= 20; ++k) {
    for (std::size_t side = 0; side < 8; ++side) {
      constexpr std::array<std::array<int, 2>, 8> kWays{
          {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
      const double far = std::ldexp(1.0, k), dx = kWays[side][0] * far, dy = kWays[side][1] * far;
      // The other two at both sides of the line there.
      const double length = std::hypot(dx, dy), nx = -dy / length, ny = dx / length;
      const auto at = [](double value) { return std::nearbyint(value * 8) / 8; };
      Scene scene = empty_scene(16, 16);
      add_triangle(
          scene.draws[0],
          {corner(at(8 + dx), at(8 + dy)), corner(at(8 + 7 * nx - 3 * dx / length), at(8 + 7 * ny - 3 * dy / length)),
           corner(at(8 - 6 * nx - 2 * dx / length), at(8 - 6 * ny - 2 * dy / length))},
          questions.model.culled);
      const auto shown = answer(questions, scene);
      if (!shown) continue;
      double most = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const SceneVertex &p = scene.draws[0].vertices[i], &q = scene.draws[0].vertices[(i + 1) % 3];
        for (const auto& [x, y] : {std::pair{0.5, 0.5}, {15.5, 0.5}, {0.5, 15.5}, {15.5, 15.5}}) {
          most = std::max(most, std::abs((double{q.x} - p.x) * (y - p.y) - (double{q.y} - p.y) * (x - p.x)));
        }
      }
      const bool bad = shown->right.count != shown->rival.count;
      (bad ? wrong : right).push_back({far, std::abs(dx), std::abs(dy), most});
      if (!bad) continue;
      const auto image = questions.rival(scene);
      nothing =
          nothing && image && std::all_of(image->count.begin(), image->count.end(), [](auto n) { return n == 0; });
    }
  }
  if (wrong.size() < 4 || right.size() < 4) return "";
  std::array<double, 4> least{};
  // An overflow is not wrong everywhere: what is large and right by chance is let be.
  std::size_t best = 4, exceptions = right.size();
  for (const std::size_t of : {0u, 1u, 2u}) {
    least[of] = INFINITY;
    for (const Told& t : wrong) least[of] = std::min(least[of], t[of]);
    const auto large = static_cast<std::size_t>(
        std::count_if(right.begin(), right.end(), [&](const Told& t) { return t[of] >= least[of]; }));
    if (large < exceptions) best = of, exceptions = large;
  }
  if (best == 4 || 4 * exceptions > wrong.size()) return "";
  least[3] = INFINITY;
  for (const Told& t : wrong) least[3] = std::min(least[3], t[3]);
  std::string why;
  for (const int bits : {4, 8}) {
    const double limit = std::ldexp(1.0, 31 - 2 * bits);
    if (!nothing && best == 0 && least[3] >= limit / 2 && least[3] <= 4 * limit) {
      why = ": numbers overflow, as edge functions of " + std::to_string(bits) + " subpixel bits do in 32 bits";
    }
  }
  if (why.empty() && !nothing && best == 0) why = ": numbers overflow, or are not precise enough";
  constexpr std::array<const char*, 3> kForms{"triangles with a vertex %.0f pixels and more away ",
                                              "triangles some %.0f pixels and more wide ",
                                              "triangles some %.0f pixels and more high "};
  return text(kForms[best], least[best]) + (nothing ? "are not drawn" : "are wrong") + why;
}

// Triangles that get smaller about a sample, in four shapes.
std::string about_small(const Questions& questions) {
  if (questions.model.least_area > 0) return "";  // that is of its model
  constexpr std::array<double, 12> kSizes{6, 4, 3, 2, 1.5, 1, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125};
  // All ways; in y; in x; across a slanted line.
  std::array<double, 4> drawn{INFINITY, INFINITY, INFINITY, INFINITY}, lost{0, 0, 0, 0};
  for (std::size_t shape = 0; shape < 4; ++shape) {
    for (const double s : kSizes) {
      Scene scene = empty_scene(16, 16);
      const double cx = 7 + questions.model.x.place, cy = 7 + questions.model.y.place;
      Corners corners{};
      const auto thin = [&](double ax, double ay, double bx, double by) {  // along a, across b
        corners = {corner(cx - 5 * ax - 0.45 * s * bx, cy - 5 * ay - 0.45 * s * by),
                   corner(cx + 5 * ax - 0.45 * s * bx, cy + 5 * ay - 0.45 * s * by),
                   corner(cx + 0.55 * s * bx, cy + 0.55 * s * by)};
      };
      if (shape == 0) {
        corners = {corner(cx - 0.45 * s, cy - 0.4 * s), corner(cx + 0.55 * s, cy - 0.35 * s),
                   corner(cx - 0.2 * s, cy + 0.6 * s)};
      }
      if (shape == 1) thin(1, 0, 0, 1);
      if (shape == 2) thin(0, 1, 1, 0);
      if (shape == 3) thin(0.75, 0.625, -0.64, 0.768);
      add_triangle(scene.draws[0], corners, questions.model.culled);
      const auto image = questions.rival(scene);
      if (!image) continue;
      if (is_covered(*image, 7 * 16 + 7)) {
        drawn[shape] = std::min(drawn[shape], s);
      } else {
        lost[shape] = std::max(lost[shape], s);
      }
    }
  }
  // By shape: lost below, drawn from there on.
  std::array<bool, 4> loses{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (lost[i] > drawn[i] && drawn[i] < INFINITY) return "";  // no threshold
    loses[i] = lost[i] > 0.2;
  }
  if (loses[0] && !loses[1] && !loses[2])
    return text("triangles smaller than some %.3g pixels each way are not drawn", drawn[0]);
  if (loses[1] && !loses[2]) return text("triangles less than some %.3g pixels high are not drawn", drawn[1]);
  if (loses[2] && !loses[1]) return text("triangles less than some %.3g pixels wide are not drawn", drawn[2]);
  if (loses[1] && loses[2]) {
    // By area the long ones may be thinner than the small ones: between what is lost and what is drawn lies the limit.
    const double from = std::max(0.494 * lost[0] * lost[0], 5 * lost[1]),
                 to = std::min(0.494 * drawn[0] * drawn[0], 5 * drawn[1]);
    if (loses[0] && from < to && lost[0] > 1.1 * drawn[1]) {
      return text("triangles of less than some %.2g square pixels are not drawn", (from + to) / 2);
    }
    return text("triangles thinner than some %.3g pixels are not drawn", drawn[1]);
  }
  return "";
}

// Triangles beside the sample of their pixel.
std::string about_tiny(const Questions& questions) {
  int all = 0, drawn = 0;
  for (const double dx : {-0.25, 0.25}) {
    for (const double dy : {-0.25, 0.25}) {
      const double cx = 7.5 + dx + (dx < 0 ? 0 : -0.125), cy = 7.5 + dy + (dy < 0 ? 0 : -0.125);
      Scene scene = empty_scene(16, 16);
      add_triangle(scene.draws[0], {corner(cx, cy), corner(cx + 0.125, cy + 0.03125), corner(cx + 0.03125, cy + 0.125)},
                   questions.model.culled);
      const auto shown = answer(questions, scene);
      if (!shown || shown->right.count[7 * 16 + 7] != 0) return "";
      ++all, drawn += shown->rival.count[7 * 16 + 7] == 1;
    }
  }
  if (drawn != all) return "";
  return "a triangle smaller than a pixel is drawn in the pixel that it lies in, though it covers no sample there";
}

// The same triangle with its corners in another order.
std::string about_orders(const Questions& questions) {
  Random random(0x02DE2);
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::array<int, 2> bad{};
  int differ = 0, all = 0;
  for (int n = 0; n < 10; ++n) {
    const Corners c = plain_corners(random, 16, 16);
    std::array<bool, 6> wrong{};
    bool known = true;
    for (std::size_t o = 0; o < 6; ++o) {
      Scene scene = empty_scene(16, 16);
      add_triangle(scene.draws[0], {c[kOrders[o][0]], c[kOrders[o][1]], c[kOrders[o][2]]});
      const auto shown = answer(questions, scene);
      known = known && shown;
      if (shown) wrong[o] = shown->right.count != shown->rival.count;
      if (wrong[o]) ++bad[o / 3];
    }
    if (!known) continue;
    ++all;
    differ += wrong[0] != wrong[1] || wrong[1] != wrong[2] || wrong[3] != wrong[4] || wrong[4] != wrong[5];
  }
  if (2 * differ > all && all > 3) return "what a triangle covers depends on which of its vertices comes first";
  return "";
}

// How many vertices behind the eye it takes.
std::string about_behind(const Questions& questions, std::span<const Fault> faults) {
  Random random(0xBE41D);
  std::array<std::vector<Wrong>, 2> wrong;
  std::array<int, 2> all{}, nothing{}, lacks{}, more{};
  for (int n = 0; n < 24; ++n) {
    const int behind = 1 + n % 2;
    Scene scene = empty_scene(16, 16);
    Corners c = plain_corners(random, 16, 16);
    for (int i = 0; i < behind; ++i) {
      // Its image mirrored through infinity: far off, so that much of the target is covered.
      SceneVertex& v = c[static_cast<std::size_t>((n / 2 + i) % 3)];
      const double w = -0.5 - random.unit();
      v = random_corner(random, {-8, 24}, {-8, 24});
      v.x = static_cast<float>(eighth(random, -24, 40)), v.y = static_cast<float>(eighth(random, -24, 40));
      v.w = static_cast<float>(std::nearbyint(w * 16) / 16), v.z = v.w / 2;
    }
    for (SceneVertex& v : c) v.z = v.w / 2;
    add_triangle(scene.draws[0], c);
    const auto shown = answer(questions, scene);
    if (!shown) continue;
    std::uint64_t right = 0;
    bool less = false, greater = false;
    for (std::size_t s = 0; s < shown->right.count.size(); ++s) {
      right += shown->right.count[s];
      less = less || shown->rival.count[s] < shown->right.count[s];
      greater = greater || shown->rival.count[s] > shown->right.count[s];
    }
    if (right < 12) continue;
    const auto k = static_cast<std::size_t>(behind - 1);
    ++all[k];
    if (!less && !greater) continue;
    const auto image = questions.rival(scene);
    nothing[k] += image && std::all_of(image->count.begin(), image->count.end(), [](auto count) { return count == 0; });
    lacks[k] += less && !greater, more[k] += greater && !less;
    wrong[k].push_back(*shown);
  }
  const auto bad = [&](std::size_t k) { return all[k] >= 3 && 2 * static_cast<int>(wrong[k].size()) >= all[k]; };
  if (!bad(0) && !bad(1)) {
    // Only where cutting leaves many corners, perhaps.
    const auto few = static_cast<int>(wrong[0].size() + wrong[1].size());
    if (few < 2 || lacks[0] + lacks[1] != few) return "";
    return "some triangles with a vertex behind the eye (W <= 0) lack a part: where cutting leaves many corners (five "
           "and "
           "more) some of the polygon is lost";
  }
  std::vector<Wrong> both = wrong[0];
  both.insert(both.end(), wrong[1].begin(), wrong[1].end());
  // A likeness sees the wrong ones alone: it is one only if there are hardly any others.
  const std::vector<Name> names = name_fault(faults, both, 0x1p-8);
  if (!names.empty() && names.front().agreement >= 0.9 && 10 * static_cast<int>(both.size()) >= 9 * (all[0] + all[1])) {
    return names.front().fault->sentence;
  }
  const char* who = bad(0) && bad(1) ? "triangles with a vertex behind the eye (W <= 0) "
                    : bad(0)         ? "triangles with one vertex behind the eye (W <= 0), not those with two, "
                                     : "triangles with two vertices behind the eye (W <= 0), not those with one, ";
  const auto each = [&](const std::array<int, 2>& n) {
    return (!bad(0) || n[0] == static_cast<int>(wrong[0].size())) &&
           (!bad(1) || n[1] == static_cast<int>(wrong[1].size()));
  };
  if (each(nothing)) return std::string(who) + "are not drawn";
  if (each(lacks))
    return std::string(who) + (bad(0) && !bad(1)
                                   ? "lack a part: of the polygon of four corners that is left some is lost"
                                   : "lack a part");
  if (each(more)) return std::string(who) + "cover what they should not";
  return std::string(who) + "are wrong";
}

}  // namespace surefill::judge
