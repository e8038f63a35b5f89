// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/line_rules.hpp"
#include "certify/judge/probes.hpp"
#include "certify/judge/room.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using oracle::LeftOut;
using oracle::LineModel;
using oracle::LineShape;
using oracle::Outline;

constexpr int kSize = 16;  // of the target, pixels
constexpr int kThin = 320, kWide = 240, kPoints = 160;
constexpr double kMostBlur = 1.0 / 16;
constexpr double kWidest = 256;  // R20

// A line or a point that was drawn alone.
struct Drawn {
  LoneLine line;  // of a point both ends are its vertex
  std::vector<bool> covered;
};

// What a wrong rasterizer makes of a line, or a point, before it draws it right.
struct Mistake {
  const char* sentence;  // null: none
  bool (*changes)(LoneLine&);
};

double ratio_across(const LoneLine& line) {
  const auto along = [&line](auto of) {
    return std::abs(static_cast<double>(of(line.ends[1])) / line.ends[1].w -
                    static_cast<double>(of(line.ends[0])) / line.ends[0].w);
  };
  const double dx = along([](const Vertex&v) { return v.x; }), dy = along([](const Vertex&v) { return v.y; });
  return std::hypot(dx, dy) / std::max({dx, dy, 1e-9});
}

constexpr Mistake kRight{nullptr, [](LoneLine&) { return true; }};
constexpr Mistake kLineMistakes[] = {
    {"every line is a pixel wide, whatever its width", [](LoneLine& l) { return l.line_width = 1.0f, true; }},
    {"the width of a line is measured across it and not along an axis, so slanted lines are too wide",
     [](LoneLine& l) { return l.line_width = static_cast<float>(*l.line_width * ratio_across(l)), true; }},
    {"the width of a line shrinks as it slants, so wide lines have gaps between them",
     [](LoneLine& l) { return l.line_width = static_cast<float>(*l.line_width / ratio_across(l)), true; }},
    {"lines are a pixel wider than their width", [](LoneLine& l) { return l.line_width = *l.line_width + 1, true; }},
    {"lines are a pixel narrower than their width",
     [](LoneLine& l) { return l.line_width = std::max(*l.line_width - 1, 0x1p-10f), true; }},
    {"lines are twice as wide as their width", [](LoneLine& l) { return l.line_width = *l.line_width * 2, true; }},
};
constexpr Mistake kPointMistakes[] = {
    {"every point has one pixel, whatever its size", [](LoneLine& l) { return l.line_width = 1.0f, true; }},
    {"a point's vertex is the upper left corner of its square and not its middle",
     [](LoneLine& l) {
       for (Vertex& v : l.ends) v.x += *l.line_width / 2 * v.w, v.y += *l.line_width / 2 * v.w;
       return true;
     }},
    {"points are a pixel larger than their size", [](LoneLine& l) { return l.line_width = *l.line_width + 1, true; }},
    {"points are twice as large as their size", [](LoneLine& l) { return l.line_width = *l.line_width * 2, true; }},
    {"points go to the middle of the pixel that their vertex lies in",
     [](LoneLine& l) {
       for (Vertex& v : l.ends) v.x = (std::floor(v.x / v.w) + 0.5f) * v.w, v.y = (std::floor(v.y / v.w) + 0.5f) * v.w;
       return true;
     }},
};

// OpenGL 1.0 to 2.1 and the compatibility profile.
constexpr Mistake kWholePoints{nullptr, [](LoneLine& l) {
                                 const float size = std::max(std::floor(*l.line_width + 0.5f), 1.0f);
                                 const bool odd = std::fmod(size, 2.0f) == 1;
                                 const auto centre = [odd](float q) {
                                   return odd ? std::floor(q) + 0.5f : std::floor(q + 0.5f);
                                 };
                                 for (Vertex& v : l.ends) v.x = centre(v.x / v.w) * v.w, v.y = centre(v.y / v.w) * v.w;
                                 return l.line_width = size, true;
                               }};

corpus::Scene scene_of(const LoneLine& line, Primitive primitive, float z = 0.5f) {
  corpus::Scene scene;
  scene.width = line.width;
  scene.height = line.height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.primitive = primitive;
  draw.width = line.line_width;
  const std::uint32_t last = primitive == Primitive::points ? 0 : 1;
  for (std::uint32_t i = 0; i <= last; ++i) {
    const Vertex& v = line.ends[i];
    draw.vertices.push_back({v.x, v.y, z * v.w, v.w, {}});
  }
  draw.triangles.push_back({{0, last, last}, std::nullopt});
  return scene;
}

// Of each seven two have both ends on half pixels, one on sixteenths, one passes a corner of a sample's diamond closely, one
// is short, and two lie anywhere.
LoneLine probe_line(Random& random, const Model& model, double step, int number) {
  LoneLine line{kSize, kSize, {}, std::nullopt};
  const auto lattice = [&](int q) { return static_cast<double>(random.between(2 * q, (kSize - 2) * q)) / q; };
  const auto anywhere = [&] { return 2 + (kSize - 4) * random.unit(); };
  const int kind = number % 7;
  std::array<std::array<double, 2>, 2> ends{};
  for (auto& end : ends) {
    for (double& at : end) at = kind < 2 ? lattice(2) : kind == 2 ? lattice(16) : anywhere();
  }
  if (kind == 3) {
    const double sx = random.between(4, kSize - 5) + model.x.place, sy = random.between(4, kSize - 5) + model.y.place;
    const int corner = random.below(4);
    const double aside = std::ldexp(random.below(2) == 0 ? 1.0 : -1.0, -random.between(3, 14));
    const double cx = sx + (corner == 0   ? 0.5
                            : corner == 1 ? -0.5
                                          : aside),
                 cy = sy + (corner == 2   ? 0.5
                            : corner == 3 ? -0.5
                                          : aside);
    const double dx = random.between(-4, 4), dy = random.between(-4, 4), back = random.unit(), ahead = random.unit();
    ends = {{{cx - back * dx, cy - back * dy}, {cx + ahead * dx, cy + ahead * dy}}};
  }
  if (kind == 4) {
    for (std::size_t axis = 0; axis < 2; ++axis) ends[1][axis] = ends[0][axis] + 3 * random.unit() - 1.5;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    line.ends[i] = {on_step(ends[i][0], step), on_step(ends[i][1], step), 0, 1};
  }
  return line;
}

std::optional<Drawn> draw_alone(Rival& rival, const LoneLine& line, Primitive primitive) {
  Drawn drawn{line, {}};
  const corpus::Image image = rival.draw(scene_of(line, primitive), covering(rival));
  for (std::size_t s = 0; s < static_cast<std::size_t>(line.width * line.height); ++s) {
    drawn.covered.push_back(is_covered(image, s));
  }
  return drawn;
}

std::vector<Drawn> draw_probes(Rival& rival, const Model& model, Primitive primitive, bool wide, int number) {
  constexpr std::array<float, 8> kWidths{1, 2, 3, 4, 5, 7, 2.75f, 4.25f};
  Random random(wide ? 0x31DE : primitive == Primitive::points ? 0x9017 : 0x714E);
  std::vector<Drawn> drawn;
  for (int n = 0; n < number; ++n) {
    LoneLine line = probe_line(random, model, rival.position_step(), n);
    if (wide) line.line_width = kWidths[static_cast<std::size_t>(random.below(8))];
    if (primitive == Primitive::points) line.ends[1] = line.ends[0];
    drawn.push_back(*draw_alone(rival, line, primitive));
  }
  return drawn;
}

struct Score {
  std::uint64_t wrong = 0, open = 0;
};

Score score_of(const Expected& expected, const Model& model, const std::vector<Drawn>& drawn, Primitive primitive,
               const Mistake& mistake = kRight) {
  Score score;
  for (const Drawn& one : drawn) {
    LoneLine line = one.line;
    if (mistake.sentence != nullptr && !line.line_width) line.line_width = 1.0f;
    mistake.changes(line);
    const std::vector<Cover> answers =
        primitive == Primitive::lines
            ? expected.cover_line(model, line.width, line.height, line.ends, line.line_width)
            : expected.cover_point(model, line.width, line.height, line.ends[0], line.line_width.value_or(1));
    for (std::size_t s = 0; s < answers.size(); ++s) {
      if (answers[s] == Cover::open) {
        ++score.open;
      } else if ((answers[s] == Cover::yes) != one.covered[s]) {
        ++score.wrong;
        return score;  // one is enough
      }
    }
  }
  return score;
}

// How far off borders and ends may be, the least first.
std::vector<double> lengths_of(const Model& model) {
  const double step = std::ldexp(1.0, -std::max({model.x.bits, model.y.bits, 0}));
  std::vector<double> lengths{0};
  for (const double length : {0x1p-20, 0x1p-14, 0x1p-10, 0x1p-8, 0x1p-7, 0x1p-6, 0x1p-5, 0x1p-4})
    lengths.push_back(length);
  if ((model.x.bits >= 0 || model.y.bits >= 0) && step < kMostBlur)
    lengths.push_back(step), lengths.push_back(step / 2);
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

// R17: who has triangles on a grid may have lines and points on it, or not, which few of them show.
double grid_step(const Model& model) {
  double step = 0;
  for (const oracle::AxisModel* axis : {&model.x, &model.y}) {
    if (axis->bits >= 0) step = std::max(step, std::min(std::ldexp(1.0, -axis->bits), kMostBlur));
  }
  return step;
}

// The rule by which ties go, of those that explain all; the model's own first.
template <typename With>
std::optional<FillRule> ties_of(const Expected& expected, const Model& model, const std::vector<Drawn>& drawn,
                                Primitive primitive, const With& with) {
  std::vector<FillRule> rules;
  if (const auto own = oracle::watertight_rule(model)) rules.push_back(*own);
  for (int rule = 0; rule < 8; ++rule) rules.push_back(static_cast<FillRule>(rule));
  for (const FillRule rule : rules) {
    if (score_of(expected, with(rule), drawn, primitive).wrong == 0) return rule;
  }
  return std::nullopt;
}

// Level lines, or points, in the middle of a high target: how wide are they?
class Heights {
 public:
  Heights(Rival& rival, const Model& model, Primitive primitive)
      : rival_(rival), place_(model.y.place), place_x_(model.x.place), primitive_(primitive) {}

  // What a width is drawn as, if it is drawn 1/16 pixel below a sample.
  std::optional<double> drawn(double width) const {
    double in = kMiddle + place_ + 1.0 / 16, out = in + 1;
    const int first = first_row(width, in);
    if (first < 0) return std::nullopt;
    // Down to where it leaves its first row.
    for (int n = 0; n < 20; ++n) {
      const double middle = (in + out) / 2;
      (first_row(width, middle) == first ? in : out) = middle;
    }
    return 2 * ((in + out) / 2 - (first + place_));
  }

 private:
  static constexpr int kMiddle = 144;

  int first_row(double width, double y) const {
    LoneLine line{8, 2 * kMiddle, {}, static_cast<float>(width)};
    for (const std::size_t end : {0u, 1u}) {
      line.ends[end] = {end == 0 ? -16.0f : 24.0f, on_step(y, rival_.position_step()), 0, 1};
    }
    if (primitive_ == Primitive::points) line.ends[0].x = on_step(4 + place_x_, rival_.position_step());
    const Drawn drawn = *draw_alone(rival_, line, primitive_);
    for (int row = 0; row < line.height; ++row) {
      if (drawn.covered[static_cast<std::size_t>(8 * row + 4)]) return row;
    }
    return -1;
  }

  Rival& rival_;
  double place_, place_x_;
  Primitive primitive_;
};

// R20: the range that widths are clamped to, of those from 2 pixels on and up to 1.
Outline range_of(Rival& rival, const Model& model, Primitive primitive) {
  Outline outline;
  outline.ties.reset();
  if (!kAsksAll) return outline;
  const Heights heights(rival, model, primitive);
  const double step = model.y.bits < 0 ? 0 : std::ldexp(1.0, -model.y.bits);
  const double within = std::max(0x1p-8, 2 * step) + 2 * model.y.blur;
  const auto nearly = [within](double a, double b) { return std::abs(a - b) <= within; };
  // What was meant, if it is about a round number.
  const auto round = [&](double width) {
    for (const double unit : {1.0, 0.5, 0.25, 0.125}) {
      const double near = std::nearbyint(width / unit) * unit;
      if (nearly(near, width)) return near;
    }
    return width;
  };
  try {
    const std::optional<double> most = heights.drawn(kWidest);
    if (most && *most >= 2 && *most < kWidest - 2 &&
        nearly(heights.drawn(kWidest / 2).value_or(0), std::min(*most, kWidest / 2)) &&
        nearly(heights.drawn(std::floor(*most / 2)).value_or(0), std::floor(*most / 2))) {
      outline.most_width = round(*most);
    }
    const std::optional<double> least = heights.drawn(1.0 / 16);
    if (least && *least <= 1 + within) outline.least_width = round(*least);
    // Widths may be rounded, to whole pixels or less.
    double off = 0;
    for (const double width : {2.75, 4.25, 3.4375}) {
      const double due = std::clamp(width, outline.least_width, outline.most_width);
      off = std::max(off, std::abs(heights.drawn(width).value_or(due) - due));
    }
    for (const double rounded : {0.5, 1.0 / 8, 1.0 / 16}) {
      if (off > within && off <= rounded) outline.width_within = rounded;
    }
  } catch (const Declined&) {
    // It takes no such target: of what can be asked widths up to 7 are looked at.
  }
  return outline;
}

// The lines of a model that explain all of these, thin or wide ones, whose widths are of this range.
std::optional<LineModel> fit_lines(const Expected& expected, const Model& model, const std::vector<Drawn>& drawn,
                                   bool wide, const std::optional<Model>& declared, const Outline& range,
                                   const Mistake& mistake = kRight) {
  const auto with = [&model](const LineModel& lines) {
    Model result = model;
    result.lines = lines;
    return result;
  };
  if (declared && mistake.sentence == nullptr &&
      score_of(expected, with(declared->lines), drawn, Primitive::lines).wrong == 0) {
    return declared->lines;
  }
  std::vector<LineModel> candidates;
  for (const LineShape shape : {LineShape::diamond, LineShape::parallelogram, LineShape::rectangle}) {
    for (const LeftOut left_out : {LeftOut::last, LeftOut::first, LeftOut::none, LeftOut::both}) {
      for (const bool whole : {false, true}) {
        if (shape != LineShape::diamond && (left_out != LeftOut::last || whole)) continue;
        LineModel lines;
        lines.thin = lines.wide = shape;
        lines.left_out = left_out;
        lines.whole_pixels = whole;
        lines.outline = range;
        // R18 rounds, to 1 at the least.
        if (shape == LineShape::diamond) lines.outline.width_within = lines.outline.least_width = 0;
        candidates.push_back(lines);
      }
    }
  }
  // Who is wrong in a known way is so by pixels: a few lengths tell.
  const std::vector<double> few{0, 0x1p-8, kMostBlur};
  for (const double length : mistake.sentence != nullptr ? few : lengths_of(model)) {
    std::optional<LineModel> best;
    std::uint64_t open = 0;
    for (LineModel lines : candidates) {
      // What is found in so many lines is made larger, as a few may not show all of it.
      const double more = length == 0 ? 0 : std::min(2 * length, kMostBlur);
      (lines.thin == LineShape::diamond ? lines.blur : lines.outline.border) = more;
      const Score score = score_of(expected, with(lines), drawn, Primitive::lines, mistake);
      if (score.wrong != 0 || (best && score.open >= open)) continue;
      best = lines;
      open = score.open;
    }
    if (!best) continue;
    if (mistake.sentence == nullptr) {
      best->outline.ties = ties_of(expected, model, drawn, Primitive::lines, [&](FillRule rule) {
        LineModel lines = *best;
        lines.outline.ties = rule;
        return with(lines);
      });
    }
    if (!wide) best->wide = LineModel{}.wide;
    // Of diamonds so many show it.
    if ((wide ? best->wide : best->thin) != LineShape::diamond) best->blur = std::max(best->blur, grid_step(model));
    return best;
  }
  return std::nullopt;
}

// The first rule of R22 that a line breaks, in words.
std::string broken(const Expected& expected, const Model& model, const std::vector<Drawn>& drawn) {
  for (const Drawn& one : drawn) {
    const RuleVerdict verdict = judge_line(expected, model, one.line, one.covered);
    if (verdict.rule != 0) return verdict.finding;
  }
  return "";
}

const char* shape_name(LineShape shape) {
  switch (shape) {
    case LineShape::diamond:
      return "diamond exit";
    case LineShape::parallelogram:
      return "parallelograms";
    case LineShape::rectangle:
      return "rectangles";
    case LineShape::tolerant:
      return "no shape, within OpenGL's tolerances";
    case LineShape::unknown:
      break;
  }
  return "unknown";
}

// What a standard has against lines that are found (R24); empty: nothing.
std::string refusal(Standard standard, const LineModel& lines, bool wide) {
  const LineShape shape = wide ? lines.wide : lines.thin;
  if (standard == Standard::none) return "";
  if (shape == LineShape::diamond && lines.left_out == LeftOut::none) {
    return "lines draw the pixel of their last end, too: where two lines meet, it is drawn twice";
  }
  if (shape == LineShape::diamond && lines.left_out == LeftOut::both) {
    return "lines leave out the pixels of both ends: where two lines meet, there is a gap";
  }
  if (standard != Standard::d3d11 || shape == LineShape::unknown || wide) return "";
  if (shape != LineShape::diamond) return std::string("lines go by ") + shape_name(shape) + ", not by diamond exit";
  if (lines.left_out == LeftOut::first) return "lines leave out the pixel of their first end, not that of their last";
  if (lines.whole_pixels) return "ends of lines go to whole pixels, as Bresenham's algorithm has them";
  return "";
}

void infer_shape(Rival& rival, const Expected& expected, Standard standard, const std::optional<Model>& declared,
                 bool wide, Inference& result) {
  const std::vector<Drawn> drawn = draw_probes(rival, result.model, Primitive::lines, wide, wide ? kWide : kThin);
  Outline range;
  range.ties.reset();
  if (wide) range = range_of(rival, result.model, Primitive::lines);
  LineModel& lines = result.model.lines;
  LineShape& shape = wide ? lines.wide : lines.thin;
  const auto problem = [&](const std::string& sentence) { result.line_problems.push_back(sentence); };
  if (const std::optional<LineModel> found = fit_lines(expected, result.model, drawn, wide, declared, range)) {
    if (wide) {
      lines.wide = found->wide;
      lines.outline = found->outline;
      lines.blur = std::max(lines.blur, found->blur);
      // One way of leaving out ends is kept for both, as of thin ones, unless those have none.
      if (found->wide == LineShape::diamond && lines.thin != LineShape::diamond) {
        lines.left_out = found->left_out, lines.whole_pixels = found->whole_pixels;
      } else if (found->wide == LineShape::diamond &&
                 (found->left_out != lines.left_out || found->whole_pixels != lines.whole_pixels)) {
        shape = LineShape::unknown;
        result.open.push_back("wide lines: their ends are not as those of thin ones");
      }
    } else {
      lines = *found;
    }
    if (const std::string why = refusal(standard, *found, wide); !why.empty()) problem(why);
    if (standard == Standard::opengl) {
      if (const std::string why = broken(expected, result.model, drawn); !why.empty()) {
        problem(std::string(wide ? "wide lines" : "lines") + ", drawn as " + shape_name(shape) + ": " + why);
      }
    }
    return;
  }
  shape = LineShape::unknown;
  for (const Mistake& mistake : kLineMistakes) {
    if (!wide || !fit_lines(expected, result.model, drawn, wide, declared, range, mistake)) continue;
    (standard == Standard::none ? result.open : result.line_problems).push_back(mistake.sentence);
    return;
  }
  const std::string why = broken(expected, result.model, drawn);
  if (why.empty()) {
    shape = LineShape::tolerant;
    result.open.push_back(std::string(wide ? "wide lines" : "lines") +
                          ": which pixels they draw, where OpenGL's tolerances leave a choice");
  } else if (standard == Standard::none || standard == Standard::d3d11) {
    result.open.push_back(std::string(wide ? "wide lines" : "lines") + ": no shape explains them; " + why);
    if (standard == Standard::d3d11) problem(why);
  } else {
    problem(std::string(wide ? "wide lines: " : "lines: ") + why);
  }
}

void infer_points(Rival& rival, const Expected& expected, Standard standard, const std::optional<Model>& declared,
                  bool widths, Inference& result) {
  const std::vector<Drawn> drawn = draw_probes(rival, result.model, Primitive::points, widths, kPoints);
  const auto with = [&result](const oracle::PointModel& points) {
    Model model = result.model;
    model.points = points;
    return model;
  };
  const auto explains = [&](const oracle::PointModel& points, const Mistake& mistake = kRight) {
    return score_of(expected, with(points), drawn, Primitive::points, mistake).wrong == 0;
  };
  oracle::PointModel& points = result.model.points;
  if (declared && explains(declared->points)) {
    points = declared->points;
    return;
  }
  const Outline range = widths ? range_of(rival, result.model, Primitive::points) : Outline{std::nullopt};
  for (const double within : {0.0, 1.0 / 16, 1.0 / 8, 0.5}) {
    oracle::PointModel whole;
    whole.clipped_whole = true;
    whole.outline = range;
    whole.outline.border = 0x1p-10;
    if (within > 0 && explains(whole, kWholePoints)) {
      const char* sentence =
          "points are of whole sizes, at middles or corners of pixels, as in OpenGL's compatibility profile";
      points.known = false;
      (standard == Standard::none || standard == Standard::opengl ? result.open : result.line_problems)
          .emplace_back(sentence);
      return;
    }
    for (const double length : lengths_of(result.model)) {
      oracle::PointModel candidate;
      candidate.clipped_whole = true;
      candidate.outline = range;
      candidate.outline.border = length == 0 ? 0 : std::min(2 * length, kMostBlur);
      candidate.outline.width_within = within;
      if (!explains(candidate)) continue;
      candidate.outline.ties = ties_of(expected, result.model, drawn, Primitive::points, [&](FillRule rule) {
        oracle::PointModel tied = candidate;
        tied.outline.ties = rule;
        return with(tied);
      });
      points = candidate;
      points.blur = grid_step(result.model);
      return;
    }
  }
  points.known = false;
  std::vector<std::string>& list = standard == Standard::none ? result.open : result.line_problems;
  for (const Mistake& mistake : kPointMistakes) {
    oracle::PointModel candidate;
    candidate.clipped_whole = true;
    candidate.outline.ties.reset();
    candidate.outline.border = 0x1p-10;
    if (!explains(candidate, mistake)) continue;
    list.emplace_back(mistake.sentence);
    return;
  }
  list.emplace_back("no square around its vertex explains which pixels a point covers");
}

std::string number(double value) {
  return text("%.3g", value);
}

std::string range(const Outline& outline) {
  if (std::isfinite(outline.most_width)) {
    return ", " + (outline.least_width > 0 ? number(outline.least_width) : "up to") +
           (outline.least_width > 0 ? " to " : " ") + number(outline.most_width) + " pixels wide";
  }
  return outline.least_width > 0 ? ", " + number(outline.least_width) + " pixels wide and more" : "";
}

std::string precision(double length) {
  return length > 0 ? ", borders known to " + number(length) + " px" : "";
}

}  // namespace

void infer_lines(Rival& rival, const Expected& expected, Standard standard, const std::optional<Model>& declared,
                 Inference& result) {
  const Rival::Primitives drawn = rival.primitives();
  if (!drawn.lines && !drawn.points) return;
  if (!result.known) {
    result.model.lines.thin = result.model.lines.wide = LineShape::unknown;
    result.model.points.known = false;
    result.open.emplace_back("how lines and points are drawn: where samples are is not known");
    return;
  }
  const auto try_to = [&result](const char* what, const auto& find) {
    try {
      find();
    } catch (const Declined& reason) {
      result.open.push_back(std::string(what) + ": " + reason.what());
      return false;
    }
    return true;
  };
  LineModel& lines = result.model.lines;
  if (drawn.lines) {
    lines.thin = lines.wide = LineShape::unknown;
    if (!try_to("how lines are drawn", [&] { infer_shape(rival, expected, standard, declared, false, result); })) {
      lines.thin = LineShape::unknown;
    }
    if (!drawn.widths) lines.wide = LineShape::unknown;
    if (drawn.widths &&
        !try_to("how wide lines are drawn", [&] { infer_shape(rival, expected, standard, declared, true, result); })) {
      lines.wide = LineShape::unknown;
    }
  }
  if (drawn.points) {
    result.model.points.known = false;
    try_to("how points are drawn", [&] { infer_points(rival, expected, standard, declared, drawn.widths, result); });
  }
}

std::vector<std::string> describe_lines(const Model& model, const Rival::Primitives& drawn) {
  std::vector<std::string> sentences;
  const LineModel& lines = model.lines;
  if (drawn.lines) {
    std::string text = std::string("lines go by ") + shape_name(lines.thin);
    if (lines.thin == LineShape::diamond) {
      text += lines.whole_pixels ? ", their ends on whole pixels (Bresenham's steps)" : "";
      text += lines.left_out == LeftOut::first  ? ", the first end left out"
              : lines.left_out == LeftOut::none ? ", no end left out"
              : lines.left_out == LeftOut::both ? ", both ends left out"
                                                : "";
    }
    if (lines.blur > 0) text += ", ends known to " + number(lines.blur) + " px";
    sentences.push_back(text);
    if (drawn.widths) {
      sentences.push_back(
          std::string("wide lines go by ") + shape_name(lines.wide) +
          (lines.wide == LineShape::diamond ? ", a column or row of pixels at each step" : "") + range(lines.outline) +
          (lines.outline.width_within > 0 ? ", widths known to " + number(lines.outline.width_within) + " px" : "") +
          precision(lines.outline.border));
    }
  }
  if (drawn.points) {
    std::string text = model.points.known ? "points are squares around their vertex" : "points: unknown";
    if (model.points.known) text += range(model.points.outline) + precision(model.points.outline.border);
    if (model.points.outline.width_within > 0)
      text += ", sizes known to " + number(model.points.outline.width_within) + " px";
    sentences.push_back(text);
  }
  return sentences;
}

std::vector<std::string> line_differences(const Model& from, const Model& to, const Rival::Primitives& drawn) {
  std::vector<std::string> sentences;
  const LineModel &a = from.lines, &b = to.lines;
  const auto shapes = [&](const char* what, LineShape x, LineShape y) {
    if (x == y || y == LineShape::unknown || x == LineShape::unknown || x == LineShape::tolerant) return;
    sentences.push_back(std::string(what) + " go by " + shape_name(y) + ", not " + shape_name(x));
  };
  if (drawn.lines) {
    shapes("lines", a.thin, b.thin);
    if (drawn.widths) shapes("wide lines", a.wide, b.wide);
    const bool diamonds = a.thin == LineShape::diamond && b.thin == LineShape::diamond;
    if (diamonds && a.left_out != b.left_out) {
      constexpr std::array<const char*, 4> kEnds{"the last end is left out",
                                                 "the first end is left out and not the last",
                                                 "the pixel of the last end is drawn, too", "both ends are left out"};
      sentences.push_back(std::string("of lines ") + kEnds[static_cast<std::size_t>(b.left_out)]);
    }
    if (diamonds && a.whole_pixels != b.whole_pixels) {
      sentences.emplace_back(b.whole_pixels ? "ends of lines go to whole pixels, as Bresenham's algorithm has them"
                                            : "ends of lines do not go to whole pixels");
    }
  }
  return sentences;
}

}  // namespace surefill::judge
