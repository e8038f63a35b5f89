// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "certify/judge/text.hpp"

namespace surefill::judge {

std::string text(const char* form, ...) {
  std::array<char, 384> buffer{};
  std::va_list values;
  va_start(values, form);
  std::vsnprintf(buffer.data(), buffer.size(), form, values);
  va_end(values);
  return buffer.data();
}

namespace {

using oracle::AxisModel;
using oracle::Owners;
using oracle::Rounding;
using oracle::Side;

constexpr std::array<const char*, 7> kRoundings{"nearest-even", "nearest-up", "nearest-down", "nearest-away",
                                                "truncate",     "floor",      "ceiling"};
constexpr std::array<const char*, 10> kRules{
    "top-left",        "top-right",  "bottom-left",     "bottom-right", "southwards",
    "southwards-west", "northwards", "northwards-west", "closed",       "open"};
constexpr std::array<const char*, 8> kSides{"left",     "right",     "top",         "bottom",
                                            "top-left", "top-right", "bottom-left", "bottom-right"};

std::string pixels(double distance) {
  const double size = std::abs(distance);
  if (size == 0.5) return "half a pixel";
  if (size == 0.25) return "a quarter of a pixel";
  if (size == 1) return "a pixel";
  const double steps = std::ldexp(size, 8);
  if (size < 0.5 && steps == std::nearbyint(steps)) return text("%g/256 pixel", steps);
  return text("%.4g pixels", size);
}

std::string grid_text(const AxisModel& axis) {
  if (axis.bits < 0) return "none";
  std::string result = text("%d bits, %s", axis.bits, kRoundings[static_cast<std::size_t>(axis.rounding)]);
  if (axis.grid_offset != 0) result += text(", offset %g/16 of a step", std::ldexp(axis.grid_offset, axis.bits + 4));
  return result;
}

bool same_grid(const AxisModel& a, const AxisModel& b) {
  return a.bits == b.bits && (a.bits < 0 || (a.rounding == b.rounding && a.grid_offset == b.grid_offset));
}

std::string rule_name(const Owners& owners) {
  if (owners.open == 0xFF) return "unknown";
  if (owners.open != 0) return "not known of all edges";
  for (int rule = 0; rule < 10; ++rule) {
    if (oracle::owners_of(static_cast<FillRule>(rule)) == owners) return kRules[static_cast<std::size_t>(rule)];
  }
  std::string sides;
  for (std::size_t side = 0; side < 8; ++side) {
    if (owners.owned >> side & 1u) sides += std::string(sides.empty() ? "" : ", ") + kSides[side];
  }
  return "its own: " + sides;
}

bool owns(const Owners& owners, Side side) {
  return (owners.owned & bit(side)) != 0;
}

// "both sides own level edges", and the like; empty where each sample on an edge belongs to one of its sides.
std::vector<std::string> owner_sentences(const Owners& owners) {
  if (owners.open == 0xFF && owners.owned != 0xFF) return {};  // nobody has seen any
  struct Pair {
    Side a, b;
    const char* edges;
  };
  constexpr Pair kPairs[] = {{Side::top, Side::bottom, "level"},
                             {Side::left, Side::right, "upright"},
                             {Side::top_left, Side::bottom_right, "rising"},
                             {Side::top_right, Side::bottom_left, "falling"}};
  std::string both, neither, open;
  int n_both = 0, n_neither = 0, n_open = 0;
  for (const Pair& pair : kPairs) {
    const auto add = [&pair](std::string& list, int& n) {
      list += std::string(list.empty() ? "" : ", ") + pair.edges;
      ++n;
    };
    if ((owners.open & (bit(pair.a) | bit(pair.b))) != 0) {
      add(open, n_open);
    } else if (owns(owners, pair.a) && owns(owners, pair.b)) {
      add(both, n_both);
    } else if (!owns(owners, pair.a) && !owns(owners, pair.b)) {
      add(neither, n_neither);
    }
  }
  std::vector<std::string> sentences;
  const auto say = [&sentences](const char* who, const std::string& list, int n, const char* so) {
    if (n > 0) sentences.push_back(std::string(who) + (n == 4 ? "their" : list) + " edges: " + so);
  };
  say("both sides own ", both, n_both, "samples on an edge that two triangles share are drawn twice");
  say("neither side owns ", neither, n_neither, "samples on an edge that two triangles share are not drawn");
  say("who owns samples on ", open, n_open, "it changes with the order of vertices, or from triangle to triangle");
  return sentences;
}

std::string where_to(double dx, double dy) {
  std::string sentence;
  if (dx != 0) sentence += pixels(dx) + (dx > 0 ? " to the right" : " to the left");
  if (dy != 0) sentence += (sentence.empty() ? "" : " and ") + pixels(dy) + (dy > 0 ? " further down" : " further up");
  return sentence;
}

void add_positions(const Model& from, const Model& to, std::vector<std::string>& sentences) {
  const double dx = to.x.place - from.x.place, dy = to.y.place - from.y.place;
  if (dx != 0 || dy != 0) sentences.push_back("samples are taken " + where_to(dx, dy));
  const double mx = to.x.moved - from.x.moved, my = to.y.moved - from.y.moved;
  if (mx != 0 || my != 0) sentences.push_back("the picture stands " + where_to(mx, my));
  for (const bool vertical : {false, true}) {
    const AxisModel &a = vertical ? from.y : from.x, &b = vertical ? to.y : to.x;
    const char* length = vertical ? "height" : "width";
    if (a.lacks != b.lacks) {
      sentences.push_back(text("the viewport is %.4g pixels too %s over its whole %s", std::abs(b.lacks - a.lacks),
                               b.lacks > a.lacks ? "small" : "large", length));
    }
    if (b.blur > a.blur && !(vertical && to.x.blur == b.blur && from.x.blur == a.blur)) {
      sentences.push_back(text("positions%s are blurred by up to %.3g pixels, as by rounding on the way",
                               to.x.blur == to.y.blur ? ""
                               : vertical             ? " in y"
                                                      : " in x",
                               b.blur));
    }
  }
}

}  // namespace

std::string describe(const Model& model) {
  std::string result = "positions ";
  if (same_grid(model.x, model.y)) {
    result += model.x.bits < 0 ? std::string("exact") : "on a grid of " + grid_text(model.x);
  } else {
    result += "on grids, x: " + grid_text(model.x) + "; y: " + grid_text(model.y);
  }
  const double blur = std::max(model.x.blur, model.y.blur);
  if (blur > 0) result += text(" (within %.3g px)", blur);
  result += "; fill rule " + rule_name(model.front);
  if (!(model.back == model.front)) result += ", of back faces " + rule_name(model.back);
  if (model.x.place != 0.5 || model.y.place != 0.5)
    result += text("; samples at (%.6g, %.6g)", model.x.place, model.y.place);
  switch (model.format) {
    case oracle::DepthFormat::unorm24:
      result += "; depth of 24 bits";
      break;
    case oracle::DepthFormat::unorm16:
      result += "; depth of 16 bits";
      break;
    case oracle::DepthFormat::float64:
      result += "; depth in double";
      break;
    case oracle::DepthFormat::float32:
      break;
  }
  return result;
}

std::vector<std::string> departures(const Model& model) {
  std::vector<std::string> sentences = differences({}, model);
  std::erase_if(sentences,
                [](const std::string& s) { return s.starts_with("its grid") || s.starts_with("its fill rule"); });
  if (!same_grid(model.x, model.y)) {
    sentences.push_back("x and y go by different grids: x " + grid_text(model.x) + ", y " + grid_text(model.y));
  }
  if (model.x.bits == 0 || model.y.bits == 0)
    sentences.emplace_back("positions are rounded to whole pixels: there are no subpixels");
  if (model.x.bits >= 0 && (model.x.rounding == Rounding::truncate || model.y.rounding == Rounding::truncate)) {
    sentences.emplace_back(
        "positions are rounded toward zero, as by a cast: left of and above the target another way than on it");
  }
  if (model.culled != Cull::none) {
    sentences.push_back(std::string("it always leaves out ") + (model.culled == Cull::front ? "front" : "back") +
                        " faces (clockwise ones are front)");
  }
  const bool cleared = std::isfinite(model.clear);
  if (model.clipped && (!cleared || std::isfinite((*model.clipped)[0]))) {
    const auto [low, high] = *model.clipped;
    sentences.push_back(std::isfinite(low) && std::isfinite(high)
                            ? text("it always clips depth to %.6g to %.6g", low, high)
                        : std::isfinite(low) ? text("it leaves out depth below %.6g", low)
                                             : text("it leaves out depth above %.6g", high));
  }
  if (model.least_area > 0)
    sentences.push_back(
        text("it leaves out small triangles, of less than %.2g square pixels at the most", model.least_area));
  if (model.draws_flat && model.x.blur == 0 && model.y.blur == 0)
    sentences.emplace_back("triangles without area are drawn, as the lines that they are or otherwise");
  if (std::isfinite(model.band)) {
    const std::string distance =
        model.band > 0 ? text("further than some distance beyond the target, %g pixels at the least,", model.band)
                       : "beyond the target";
    sentences.push_back("edges of triangles that reach " + distance +
                        " are a little off, as where such triangles are cut, or slopes rounded");
  }
  if (model.least_w > 0) sentences.push_back(text("it draws nothing of W below %.3g", model.least_w));
  if (std::isfinite(model.most_w)) sentences.push_back(text("it draws nothing of W above %.3g", model.most_w));
  if (cleared && !(model.clipped && (*model.clipped)[1] < 1))
    sentences.push_back(text("depth is cleared to %g, so nothing %s is seen", model.clear,
                             model.later_wins ? "beyond" : "there or beyond"));
  if (model.later_wins) sentences.push_back("of equal depths the later one comes");
  if (model.minus_one_to_one)
    sentences.push_back("depth has no more bits near 0 than elsewhere, as where it goes through -1 to 1");
  return sentences;
}

std::vector<std::string> differences(const Model& from, const Model& to) {
  std::vector<std::string> sentences;
  add_positions(from, to, sentences);
  for (const bool vertical : {false, true}) {
    const AxisModel &a = vertical ? from.y : from.x, &b = vertical ? to.y : to.x;
    const bool once = same_grid(from.x, from.y) && same_grid(to.x, to.y);
    if (same_grid(a, b) || (vertical && once)) continue;
    sentences.push_back(std::string("its grid") +
                        (once       ? ""
                         : vertical ? " in y"
                                    : " in x") +
                        " is " + grid_text(b) + ", not " + grid_text(a));
  }
  if (!(from.front == to.front && from.back == to.back)) {
    std::vector<std::string> owners = owner_sentences(to.front);
    if (!(to.front == to.back)) {
      for (std::string& sentence : owners) sentence += " (front faces)";
      for (const std::string& sentence : owner_sentences(to.back)) owners.push_back(sentence + " (back faces)");
      if (owners.empty())
        owners.push_back("who owns an edge depends on the facing: " + rule_name(to.front) + " of front faces, " +
                         rule_name(to.back) + " of back faces");
    }
    if (owners.empty()) owners.push_back("its fill rule is " + rule_name(to.front) + ", not " + rule_name(from.front));
    sentences.insert(sentences.end(), owners.begin(), owners.end());
  }
  if (from.vertices != to.vertices && rule_name(to.front) != "unknown") {
    sentences.push_back(to.vertices == oracle::AtVertices::covered ? "a sample at a vertex is always covered"
                        : to.vertices == oracle::AtVertices::not_covered
                            ? "a sample at a vertex is never covered"
                            : "who owns a sample at a vertex follows no rule");
  }
  return sentences;
}

std::string turns_problem(const std::vector<Turn>& turns) {
  const auto found = std::count_if(turns.begin(), turns.end(), [](const Turn& t) { return t.found; });
  if (found == 0) return "it covers no sample of any triangle on a target of 16 x 40 pixels";
  double spread = 0;
  for (const Turn& t : turns) spread = std::max(spread, t.found ? t.spread : 0);
  if (spread > 1.0 / 8) return text("near an edge it covers some samples and not others, over %.3g pixels", spread);
  return "";
}

std::string turns_shape(const std::vector<Turn>& turns, bool touching) {
  constexpr const char* kTouching =
      "it covers every pixel that a triangle touches, not those whose sample lies inside: neighbours overlap";
  constexpr const char* kOutlined =
      "edges reach half a pixel further out than they are, on every side, as if the outline were drawn as well as the "
      "inside: neighbours overlap";
  std::array<double, 2> reach{};
  for (const int axis : {0, 1}) {
    std::array<double, 2> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
    for (const Turn& t : turns) {
      if (t.axis != axis || !t.found || t.pixel == 0) continue;  // at the border much is otherwise
      const std::size_t side = t.far ? 1 : 0;
      low[side] = std::min(low[side], t.at());
      high[side] = std::max(high[side], t.at());
    }
    if (!std::isfinite(low[0] + low[1])) return "";
    if (!(high[0] - low[0] < 1.0 / 256) || !(high[1] - low[1] < 1.0 / 256)) return "";
    reach[static_cast<std::size_t>(axis)] = (low[0] + high[0] - low[1] - high[1]) / 4;
  }
  if (std::abs(reach[0] - reach[1]) > 1.0 / 64 || std::abs(reach[0]) < 1.0 / 512) return "";
  const double beyond = (reach[0] + reach[1]) / 2;
  if (std::abs(beyond - 0.5) < 1.0 / 64) return touching ? kTouching : kOutlined;
  if (std::abs(beyond + 0.5) < 1.0 / 64) {
    return "it covers only pixels that lie inside a triangle whole, not all whose sample does: neighbours gape";
  }
  return "edges reach " + pixels(beyond) +
         (beyond > 0 ? " further out than they are, on every side, as by an epsilon: neighbours overlap"
                     : " less far than they are, on every side, as by an epsilon: neighbours gape");
}

}  // namespace surefill::judge
