// SPDX-License-Identifier: Apache-2.0
//
// The judge on lines and points: rasterizers that are right in their own way are found and not accused, and each wrong one is
// told in its sentence. They are drawn in this process, in double, and share nothing with the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "certify/judge/images.hpp"
#include "certify/judge/line_rules.hpp"
#include "certify/judge/lines.hpp"
#include "certify/judge/probes.hpp"
#include "certify/rivals/model.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::judge {
namespace {

struct At {
  double x, y;
};
using Set = std::vector<bool>;  // of pixels

struct Canvas {
  int width, height;
  Set pixels;
  Canvas(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w * h), false) {}
  void set(int x, int y, bool value = true) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    pixels[static_cast<std::size_t>(y * width + x)] = value;
  }
  // Every pixel whose centre, moved as top_left has it, the test holds for.
  template <typename Test>
  void fill(const Test& test) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (test(At{x + 0.5 + 0x1p-30, y + 0.5 + 0x1p-45})) set(x, y);
      }
    }
  }
};

using Draws = std::function<void(Canvas&, At a, At b, double width)>;

// The part of the line in the open diamond around p, as numbers from 0 to 1; empty if low >= high.
bool exits_diamond(At a, At b, At p) {
  double low = -INFINITY, high = INFINITY;
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      const double slope = sx * (b.x - a.x) + sy * (b.y - a.y), room = 0.5 - sx * (a.x - p.x) - sy * (a.y - p.y);
      if (slope == 0) {
        if (room <= 0) return false;
      } else if (slope > 0) {
        high = std::min(high, room / slope);
      } else {
        low = std::max(low, room / slope);
      }
    }
  }
  return low < high && high > 0 && low < 1 && high < 1;
}
bool in_diamond(At q, At p) {
  return std::abs(q.x - p.x) + std::abs(q.y - p.y) < 0.5;
}

void diamond(Canvas& c, At a, At b, double) {
  if (a.x == b.x && a.y == b.y) return;
  c.fill([&](At p) { return exits_diamond(a, b, p); });
}
void with_last(Canvas& c, At a, At b, double w) {
  diamond(c, a, b, w);
  c.fill([&](At p) { return in_diamond(b, p); });
}
void without_ends(Canvas& c, At a, At b, double) {
  c.fill([&](At p) { return exits_diamond(a, b, p) && !in_diamond(a, p); });
}
void columns(Canvas& c, At a, At b, double w) {
  const double n = std::max(1.0, std::floor(w + 0.5));
  const bool x_major = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
  (x_major ? a.y : a.x) -= (n - 1) / 2;
  (x_major ? b.y : b.x) -= (n - 1) / 2;
  if (a.x == b.x && a.y == b.y) return;
  c.fill([&](At p) {
    for (int k = 0; k < n; ++k) {
      const At q = x_major ? At{p.x, p.y - k} : At{p.x - k, p.y};
      if (exits_diamond(a, b, q)) return true;
    }
    return false;
  });
}
void parallelogram(Canvas& c, At a, At b, double w) {
  const bool x_major = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
  c.fill([&](At p) {
    const double from = x_major ? a.x : a.y, to = x_major ? b.x : b.y, at = x_major ? p.x : p.y;
    if (!(std::min(from, to) < at && at < std::max(from, to))) return false;
    const double t = (at - from) / (to - from);
    const double beside = x_major ? p.y - a.y - t * (b.y - a.y) : p.x - a.x - t * (b.x - a.x);
    return std::abs(beside) < w / 2;
  });
}
void rectangle(Canvas& c, At a, At b, double w) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  if (length == 0) return;
  c.fill([&](At p) {
    const double along = ((p.x - a.x) * dx + (p.y - a.y) * dy) / length;
    return along > 0 && along < length && std::abs((p.x - a.x) * dy - (p.y - a.y) * dx) / length < w / 2;
  });
}
// Whole numbers, and the last pixel left out.
void bresenham(Canvas& c, At a, At b, double) {
  int x = static_cast<int>(std::floor(a.x)), y = static_cast<int>(std::floor(a.y));
  const int x1 = static_cast<int>(std::floor(b.x)), y1 = static_cast<int>(std::floor(b.y));
  const int dx = std::abs(x1 - x), dy = std::abs(y1 - y), sx = x1 > x ? 1 : -1, sy = y1 > y ? 1 : -1;
  const bool x_major = dx >= dy;
  int error = x_major ? 2 * dy - dx : 2 * dx - dy;
  for (int n = 0; n < std::max(dx, dy); ++n) {
    c.set(x, y);
    if (error >= 0) {
      (x_major ? y : x) += x_major ? sy : sx;
      error -= 2 * (x_major ? dx : dy);
    }
    (x_major ? x : y) += x_major ? sx : sy;
    error += 2 * (x_major ? dy : dx);
  }
}
// One pixel a step, where the line is at the step's near border: no model, and within the tolerances.
void coarse(Canvas& c, At a, At b, double, bool outwards, int beside, int rows, int gaps) {
  const bool x_major = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
  double from = x_major ? a.x : a.y, to = x_major ? b.x : b.y;
  const double v0 = x_major ? a.y : a.x, slope = to == from ? 0 : ((x_major ? b.y : b.x) - v0) / (to - from), u0 = from;
  if (from > to) std::swap(from, to);
  const double first = outwards ? std::floor(from) : std::floor(from + 0.5),
               end = outwards ? std::ceil(to) : std::floor(to + 0.5);
  for (double u = first; u < end; ++u) {
    if (gaps != 0 && static_cast<int>(u) % gaps == 0) continue;
    const int v = static_cast<int>(std::floor(v0 + slope * (u - u0))) + beside;
    for (int k = 0; k < rows; ++k) x_major ? c.set(static_cast<int>(u), v + k) : c.set(v + k, static_cast<int>(u));
  }
}

void square(Canvas& c, At a, At, double s) {
  c.fill([&](At p) { return std::abs(p.x - a.x) < s / 2 && std::abs(p.y - a.y) < s / 2; });
}

class Lines : public Rival {
 public:
  Draws thin = diamond, wide = parallelogram, point = square;
  int bits = -1;  // of a grid on which ends lie, to the nearest, ties up

  corpus::Outputs outputs() const override { return {true, true, true, false, false}; }
  double position_step() const override { return 0; }
  Primitives primitives() const override { return {true, true, true}; }

  corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Outputs outputs = wanted;
    outputs.barycentrics = outputs.attributes = false;
    corpus::Frame frame(scene, outputs);
    corpus::Image& image = frame.image();
    const auto total = static_cast<std::size_t>(scene.width * scene.height);
    std::vector<float> depth(total, INFINITY);
    image.count.assign(outputs.count ? total : 0, 0);
    image.index.assign(outputs.index ? total : 0, kNoTriangle);
    image.depth.assign(outputs.depth ? total : 0, INFINITY);
    std::uint32_t which = 0;
    for (const Draw& draw : frame.draws()) {
      const std::size_t corners = corpus::corners_of(draw.primitive);
      if (corners == 3) throw Declined("triangles");
      for (std::size_t t = 0; corners * t < draw.indices.size(); ++t, ++which) {
        const Vertex &u = draw.vertices[draw.indices[corners * t]],
                     &v = draw.vertices[draw.indices[corners * t + corners - 1]];
        if (!(u.w > 0 && v.w > 0)) throw Declined("behind the eye");
        Canvas canvas(scene.width, scene.height);
        const At a = place(u), b = place(v);
        const Draws& shape = corners == 1 ? point : draw.width ? wide : thin;
        shape(canvas, a, b, draw.width.value_or(1));
        for (std::size_t s = 0; s < total; ++s) {
          if (!canvas.pixels[s]) continue;
          if (outputs.count) ++image.count[s];
          const double x = static_cast<double>(s % static_cast<std::size_t>(scene.width)) + 0.5,
                       y = static_cast<double>(s / static_cast<std::size_t>(scene.width)) + 0.5;
          const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
          const double k = square == 0 ? 0 : std::clamp(((x - a.x) * dx + (y - a.y) * dy) / square, 0.0, 1.0);
          const auto z = static_cast<float>((1 - k) * u.z / u.w + k * v.z / v.w);
          if (!(z < depth[s])) continue;
          depth[s] = z;
          if (outputs.index)
            image.index[s] =
                draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t) : draw.identifiers[t];
          if (outputs.depth) image.depth[s] = z;
        }
      }
    }
    return image;
  }

 private:
  At place(const Vertex& v) const {
    const auto along = [this](float value, float w) {
      const double q = static_cast<double>(value) / w;
      return bits < 0 ? q : std::ldexp(std::floor(std::ldexp(q, bits) + 0.5), -bits);
    };
    return {along(v.x, v.w), along(v.y, v.w)};
  }
};

// Where the triangles' model is known: a grid, or none.
Inference positions(int bits) {
  Inference known;
  known.known = true;
  known.model.x.bits = known.model.y.bits = bits;
  known.model.x.rounding = known.model.y.rounding = oracle::Rounding::nearest_up;
  return known;
}

Inference found_of(Lines& rival, Standard standard) {
  Inference found = positions(rival.bits);
  infer_lines(rival, adapters::oracle_expected(), standard, std::nullopt, found);
  return found;
}

std::string all_of(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

// Random scenes held to what was found: how many samples were judged.
std::uint64_t judged_samples(Lines& rival, const Inference& found, const std::string& name, int scenes) {
  Terms terms;
  terms.model = found.model;
  terms.known = true;
  std::uint64_t judged = 0;
  const auto categories = properties::line_categories();
  for (int n = 0; n < scenes; ++n) {
    corpus::Scene scene = properties::lines_scene(categories[static_cast<std::size_t>(n) % categories.size()],
                                                  77 + static_cast<std::uint64_t>(n), 20, 3);
    scene.samples = 1, scene.origin = {}, scene.layers = 1, scene.more = {}, scene.sample_locations.clear();
    scene.initial_depth.clear(), scene.attributes.clear(), scene.depth_test = DepthTest::less;
    for (corpus::SceneDraw& draw : scene.draws) {
      static_cast<DrawState&>(draw) = [&draw] {
        DrawState state;
        state.primitive = draw.primitive;
        if (draw.width) state.width = std::clamp(std::nearbyint(2 * *draw.width) / 2, 0.5f, 8.0f);
        return state;
      }();
      for (corpus::SceneVertex& v : draw.vertices)
        v.z = std::clamp(v.z, 0.0f, std::max(v.w, 0.0f)), v.attributes.clear();
    }
    corpus::Frame frame(scene, rival.outputs());
    const Frame seen{scene.width, scene.height, 1, scene.depth_test, false, frame.draws()};
    if (validate(frame.target(), frame.draws()) != Status::ok || !why_open(terms, seen).empty()) continue;
    corpus::Image image;
    try {
      image = rival.draw(scene, rival.outputs());
    } catch (const Declined&) {
      continue;
    }
    const Judgement judgement = judge_image(adapters::oracle_expected(), terms, seen, image, {}, {});
    EXPECT_EQ(judgement.differences, 0u) << name << ": " << judgement.finding << "\n" << corpus::write_scene(scene);
    if (judgement.differences != 0) break;
    judged += judgement.samples;
  }
  return judged;
}

TEST(LinesJudge, RightOnesAreFoundAndNotAccused) {
  const struct {
    const char* name;
    Draws thin, wide;
    int bits;
    Standard standard;
    const char* says;
  } cases[] = {
      {"M7", diamond, parallelogram, -1, Standard::none, "lines go by diamond exit\nwide lines go by parallelograms\n"},
      {"OpenGL", diamond, columns, -1, Standard::opengl,
       "lines go by diamond exit\nwide lines go by diamond exit, a column or row of pixels at each step\n"},
      {"OpenGL on a grid", diamond, columns, 4, Standard::opengl, "wide lines go by diamond exit, a column"},
      {"Bresenham", bresenham, parallelogram, -1, Standard::opengl, "on whole pixels (Bresenham's steps)\n"},
      {"Vulkan, strict", rectangle, rectangle, 8, Standard::vulkan,
       "lines go by rectangles, ends known to 0.00391 px\nwide lines go by rectangles\n"},
      {"Vulkan, not strict", parallelogram, parallelogram, 8, Standard::vulkan,
       "lines go by parallelograms, ends known to"},
      {"backwards", [](Canvas& c, At a, At b, double w) { diamond(c, b, a, w); }, columns, -1, Standard::vulkan,
       "lines go by diamond exit, the first end left out\n"},
      {"coarse", [](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, false, 0, 1, 0); }, columns, -1,
       Standard::opengl, "lines go by no shape, within OpenGL's tolerances\n"},
  };
  for (const auto& one : cases) {
    Lines rival;
    rival.thin = one.thin, rival.wide = one.wide, rival.bits = one.bits;
    const Inference found = found_of(rival, one.standard);
    const std::string words = all_of(describe_lines(found.model, rival.primitives()));
    EXPECT_TRUE(found.line_problems.empty()) << one.name << ": " << all_of(found.line_problems) << words;
    EXPECT_NE(words.find(one.says), std::string::npos) << one.name << ": " << words;
    EXPECT_NE(words.find("points are squares around their vertex\n"), std::string::npos) << one.name << ": " << words;
    EXPECT_GT(judged_samples(rival, found, one.name, 120), 4000u) << one.name;
  }
}

TEST(LinesJudge, WrongOnesAreTold) {
  const auto scaled = [](Draws of, double factor, double more) -> Draws {
    return [of, factor, more](Canvas& c, At a, At b, double w) { of(c, a, b, std::max(factor * w + more, 0.001)); };
  };
  const struct {
    const char* sentence;
    Draws thin, wide, point;
    Standard standard;
  } cases[] = {
      {"lines draw the pixel of their last end, too: where two lines meet, it is drawn twice", with_last, columns,
       square, Standard::opengl},
      {"lines leave out the pixels of both ends: where two lines meet, there is a gap", without_ends, columns, square,
       Standard::vulkan},
      {"lines go by rectangles, not by diamond exit", rectangle, columns, square, Standard::d3d11},
      {"lines leave out the pixel of their first end", [](Canvas& c, At a, At b, double w) { diamond(c, b, a, w); },
       columns, square, Standard::d3d11},
      {"ends of lines go to whole pixels, as Bresenham's", bresenham, columns, square, Standard::d3d11},
      {"lines, drawn as rectangles: the line is", rectangle, columns, square, Standard::opengl},
      {"nothing is drawn within a pixel of pixel",
       [](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, false, 3, 1, 0); }, columns, square, Standard::opengl},
      {"has 2 pixels, where 1 are due", [](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, false, 0, 2, 0); },
       columns, square, Standard::opengl},
      {"pixels, where", [](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, false, 0, 1, 3); }, columns, square,
       Standard::vulkan},
      {"every line is a pixel wide, whatever its width", diamond, scaled(columns, 0, 1), square, Standard::opengl},
      {"the width of a line is measured across it", diamond,
       [](Canvas& c, At a, At b, double w) {
         const double major = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
         if (major > 0) parallelogram(c, a, b, w * std::hypot(b.x - a.x, b.y - a.y) / major);
       },
       square, Standard::vulkan},
      {"the width of a line shrinks as it slants, so wide lines have gaps", diamond,
       [](Canvas& c, At a, At b, double w) {
         const double length = std::hypot(b.x - a.x, b.y - a.y);
         if (length > 0) parallelogram(c, a, b, w * std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)) / length);
       },
       square, Standard::vulkan},
      {"lines are a pixel wider than their width", diamond, scaled(columns, 1, 1), square, Standard::opengl},
      {"lines are a pixel narrower than their width", diamond, scaled(parallelogram, 1, -1), square, Standard::vulkan},
      {"lines are twice as wide as their width", diamond, scaled(parallelogram, 2, 0), square, Standard::vulkan},
      {"wide lines, drawn as rectangles: the line is", diamond, rectangle, square, Standard::opengl},
      {"every point has one pixel, whatever its size", diamond, columns, scaled(square, 0, 1), Standard::opengl},
      {"a point's vertex is the upper left corner of its square", diamond, columns,
       [](Canvas& c, At a, At b, double s) {
         square(c, {a.x + s / 2, a.y + s / 2}, b, s);
       },
       Standard::opengl},
      {"points are a pixel larger than their size", diamond, columns, scaled(square, 1, 1), Standard::vulkan},
      {"points are twice as large as their size", diamond, columns, scaled(square, 2, 0), Standard::vulkan},
      {"points go to the middle of the pixel that their vertex lies in", diamond, columns,
       [](Canvas& c, At a, At b, double s) {
         square(c, {std::floor(a.x) + 0.5, std::floor(a.y) + 0.5}, b, s);
       },
       Standard::d3d11},
      {"no square around its vertex explains", diamond, columns,
       [](Canvas& c, At a, At, double s) { c.fill([&](At p) { return std::hypot(p.x - a.x, p.y - a.y) < s / 2; }); },
       Standard::opengl},
  };
  for (const auto& one : cases) {
    Lines rival;
    rival.thin = one.thin, rival.wide = one.wide, rival.point = one.point;
    const Inference found = found_of(rival, one.standard);
    EXPECT_NE(all_of(found.line_problems).find(one.sentence), std::string::npos)
        << one.sentence << "\n"
        << all_of(found.line_problems) << all_of(describe_lines(found.model, rival.primitives()));
  }
}

// The same of who is no rasterizer of any standard: it is said, and nobody is accused.
TEST(LinesJudge, WithoutAStandardNothingIsAccused) {
  for (const Draws& thin : {Draws(with_last), Draws(rectangle), Draws(without_ends)}) {
    Lines rival;
    rival.thin = thin;
    const Inference found = found_of(rival, Standard::none);
    EXPECT_TRUE(found.line_problems.empty()) << all_of(found.line_problems);
  }
  Lines rival;
  Inference unknown;
  unknown.model = least_known_model();
  infer_lines(rival, adapters::oracle_expected(), Standard::opengl, std::nullopt, unknown);
  EXPECT_TRUE(unknown.line_problems.empty());
  EXPECT_EQ(unknown.model.lines.thin, oracle::LineShape::unknown);
  EXPECT_NE(all_of(unknown.open).find("how lines and points are drawn"), std::string::npos);
}

// Points of whole sizes at middles and corners of pixels are OpenGL's own, in its compatibility profile: nobody is held to others.
// And points need not go by the grid of triangles.
TEST(LinesJudge, PointsOfTheirOwnAreNotAccused) {
  Lines whole;
  whole.point = [](Canvas& c, At a, At, double size) {
    const double n = std::max(std::floor(size + 0.5), 1.0);
    const bool odd = std::fmod(n, 2) == 1;
    const auto centre = [odd](double q) { return odd ? std::floor(q) + 0.5 : std::floor(q + 0.5); };
    square(c, {centre(a.x), centre(a.y)}, a, n);
  };
  const Inference found = found_of(whole, Standard::opengl);
  EXPECT_TRUE(found.line_problems.empty()) << all_of(found.line_problems);
  EXPECT_FALSE(found.model.points.known);
  EXPECT_GT(judged_samples(whole, found, "whole points", 120), 2000u);
  EXPECT_NE(all_of(found_of(whole, Standard::vulkan).line_problems).find("whole sizes"), std::string::npos);
  Lines lines;
  lines.bits = 8;
  EXPECT_EQ(found_of(lines, Standard::vulkan).model.points.blur, 0x1p-8);
}

// A model that is right of one is wrong of another, sample by sample.
TEST(LinesJudge, AnotherModelIsAccused) {
  Lines rival;
  Inference found = found_of(rival, Standard::none);
  found.model.lines.left_out = oracle::LeftOut::none;
  Terms terms;
  terms.model = found.model;
  terms.known = true;
  corpus::Scene scene;
  scene.width = scene.height = 8;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.primitive = Primitive::lines;
  draw.vertices = {{1.5f, 1.5f, 0.5f, 1, {}}, {5.5f, 3.5f, 0.5f, 1, {}}};
  draw.triangles.push_back({{0, 1, 1}, std::nullopt});
  corpus::Frame frame(scene, rival.outputs());
  const Judgement judgement =
      judge_image(adapters::oracle_expected(), terms, {8, 8, 1, DepthTest::less, false, frame.draws()},
                  rival.draw(scene, rival.outputs()), {}, {});
  EXPECT_EQ(judgement.differences, 1u);
  EXPECT_EQ(judgement.finding, "count at pixel (5, 3): expected 1, got 0");
  EXPECT_EQ(all_of(line_differences({}, found.model, rival.primitives())),
            "of lines the pixel of the last end is drawn, too\n");
}

// Depth along a line: right within what is granted, and wrong beyond it.
TEST(LinesJudge, ValuesAreThoseOfTheLine) {
  Terms terms;
  terms.known = true;
  corpus::Scene scene;
  scene.width = 32, scene.height = 4;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.primitive = Primitive::lines;
  draw.vertices = {{0.5f, 1.5f, 0, 1, {}}, {32.5f, 1.5f, 1, 1, {}}};
  draw.triangles.push_back({{0, 1, 1}, std::nullopt});
  Lines rival;
  corpus::Frame frame(scene, rival.outputs());
  const Frame seen{32, 4, 1, DepthTest::less, false, frame.draws()};
  corpus::Image image = rival.draw(scene, rival.outputs());
  EXPECT_EQ(judge_image(adapters::oracle_expected(), terms, seen, image, {}, {}).finding, "");
  image.depth[32 + 16] += 0.25f;
  EXPECT_EQ(
      judge_image(adapters::oracle_expected(), terms, seen, image, {}, {}).finding.rfind("depth at pixel (16, 1)", 0),
      0u);
  // A point's is its vertex's.
  scene.draws[0].primitive = Primitive::points;
  scene.draws[0].vertices[0].z = 0.5f;
  scene.draws[0].triangles = {{{0, 0, 0}, std::nullopt}};
  corpus::Frame point(scene, rival.outputs());
  image = rival.draw(scene, rival.outputs());
  const Frame other{32, 4, 1, DepthTest::less, false, point.draws()};
  EXPECT_EQ(judge_image(adapters::oracle_expected(), terms, other, image, {}, {}).finding, "");
  image.depth[32] += 0.001f;
  EXPECT_EQ(
      judge_image(adapters::oracle_expected(), terms, other, image, {}, {}).finding.rfind("depth at pixel (0, 1)", 0),
      0u);
}

TEST(LinesJudge, StripsThatRunOneWayAreJoined) {
  const std::vector<Vertex> ends{{3.25f, 9, 0, 1}, {8.5f, 10, 0, 1}, {14.25f, 8.5f, 0, 1}, {20, 11, 0, 1}};
  EXPECT_TRUE(strip_runs(ends));
  const Model exact;
  const auto verdict_of = [&](const Draws& draws) {
    std::vector<std::uint32_t> counts(24 * 20, 0);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      Canvas canvas(24, 20);
      draws(canvas, {ends[i].x, ends[i].y}, {ends[i + 1].x, ends[i + 1].y}, 1);
      for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += canvas.pixels[s];
    }
    return judge_strip(adapters::oracle_expected(), exact, 24, 20, ends, counts);
  };
  EXPECT_TRUE(verdict_of(diamond).judged);
  EXPECT_EQ(verdict_of(diamond).finding, "");
  EXPECT_EQ(verdict_of(bresenham).finding, "");
  EXPECT_EQ(verdict_of([](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, false, 0, 1, 0); }).finding, "");
  EXPECT_NE(verdict_of(with_last).finding.find("is drawn 2 times, where lines of a strip"), std::string::npos);
  EXPECT_NE(verdict_of(without_ends).finding.find("its joints have gaps"), std::string::npos);
  EXPECT_NE(
      verdict_of([](Canvas& c, At a, At b, double w) { coarse(c, a, b, w, true, 0, 1, 0); }).finding.find("is drawn 2"),
      std::string::npos);
  const std::vector<Vertex> turns{{3, 3, 0, 1}, {9, 3, 0, 1}, {3, 4, 0, 1}};
  EXPECT_FALSE(strip_runs(turns));
}

}  // namespace
}  // namespace surefill::judge
