// SPDX-License-Identifier: Apache-2.0
//
// What a test expects, by the oracle, and whether an implementation gives it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "certify/vectors/vectors.hpp"
#include "oracle/clipped_polygon.hpp"
#include "oracle/model.hpp"
#include "oracle/oracle.hpp"

namespace surefill::vectors {
namespace {

using oracle::clipped::exact;
using oracle::clipped::Rational;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

oracle::Model model_of(Model model, FillRule rule) {
  oracle::Model result;
  result.x.bits = result.y.bits = kModelBits[static_cast<std::size_t>(model)];
  result.front = result.back = oracle::owners_of(rule);
  return result;
}

std::array<Vertex, 3> corners(const Draw& draw, std::size_t t) {
  return {draw.vertices[draw.indices[3 * t]], draw.vertices[draw.indices[3 * t + 1]],
          draw.vertices[draw.indices[3 * t + 2]]};
}

// Counts and how many are open (R1). False: the draws are none for a model.
bool counts_under(Model model, const corpus::Frame& frame, std::vector<std::uint32_t>& count,
                  std::vector<std::uint32_t>& open) {
  const Target& target = frame.target();
  count.assign(sample_total(target), 0);
  open = count;
  for (const Draw& draw : frame.draws()) {
    if (draw.cull != Cull::none || draw.depth_mode != DepthMode::none || draw.scissor || draw.grid ||
        draw.conservative != Conservative::none || draw.fill_rule > FillRule::northwards_west) {
      return false;
    }
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
      const auto covers =
          oracle::cover(model_of(model, draw.fill_rule), target.width, target.height, target.samples, corners(draw, t));
      for (std::size_t s = 0; s < covers.size(); ++s) {
        count[s] += covers[s] == oracle::Cover::yes, open[s] += covers[s] == oracle::Cover::open;
      }
    }
  }
  return true;
}

// The edge functions of section 2 as rationals.
struct Edges {
  std::array<std::array<Rational, 3>, 3> e;

  explicit Edges(const std::array<Vertex, 3>& v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &p = v[(i + 1) % 3], &q = v[(i + 2) % 3];
      const std::array<Rational, 3> m{exact(p.x), exact(p.y), exact(p.w)}, n{exact(q.x), exact(q.y), exact(q.w)};
      for (std::size_t c = 0; c < 3; ++c) e[i][c] = m[(c + 1) % 3] * n[(c + 2) % 3] - m[(c + 2) % 3] * n[(c + 1) % 3];
    }
  }
};

// R11: sum above_i E_i / sum below_i E_i within 3 2^-(bits + 1) pixels of a pixel's centre, and the roundings of `most`.
// False where there is a pole.
bool granted(const Edges& edges, const std::array<Rational, 3>& above, const std::array<Rational, 3>& below, int x,
             int y, int bits, const Rational& most, float& low, float& high) {
  const Rational within(3, 2u << static_cast<unsigned>(bits)), half(1, 2);
  Rational least, largest;
  int sign = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const Rational px = x + half + (corner % 2 == 0 ? -within : within),
                   py = y + half + (corner / 2 == 0 ? -within : within);
    Rational numerator, denominator;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational e = edges.e[i][0] * px + edges.e[i][1] * py + edges.e[i][2];
      numerator += above[i] * e, denominator += below[i] * e;
    }
    if (sgn(denominator) == 0 || sign * sgn(denominator) < 0) return false;
    sign = sgn(denominator);
    const Rational value = numerator / denominator;
    if (corner == 0 || value < least) least = value;
    if (corner == 0 || value > largest) largest = value;
  }
  const Rational slack = most * Rational(kGrantedRoundings, 1u << 24);
  low = oracle::clipped::nearest_float(least - slack), high = oracle::clipped::nearest_float(largest + slack);
  return true;
}

Rational largest_of(const std::array<Rational, 3>& values) {
  Rational most = abs(values[0]);
  for (const Rational& value : values)
    if (abs(value) > most) most = abs(value);
  return most;
}

// Intervals of the values where one triangle is all that covers a sample; everything else is open.
bool values_under(Model model, const corpus::Scene& scene, const corpus::Frame& frame, const corpus::Outputs& outputs,
                  Expected& expected) {
  const int bits = kModelBits[static_cast<std::size_t>(model)];
  const std::size_t total = expected.count.size();
  if (frame.draws().size() != 1 || frame.draws()[0].indices.size() != 3 || scene.samples != 1) return false;
  const Draw& draw = frame.draws()[0];
  const std::array<Vertex, 3> v = corners(draw, 0);
  const Edges edges(v);
  std::array<Rational, 3> z, w, ones{1, 1, 1}, depth_at;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(v[i].w > 0)) return false;
    z[i] = exact(v[i].z), w[i] = exact(v[i].w), depth_at[i] = z[i] / w[i];
  }
  const auto fill = [&](std::vector<float>& low, std::vector<float>& high, std::size_t elements) {
    low.assign(elements * total, -kInfinity), high.assign(elements * total, kInfinity);
  };
  if (outputs.depth) fill(expected.depth, expected.depth_high, 1);
  if (outputs.barycentrics) fill(expected.barycentrics, expected.barycentrics_high, 3);
  if (outputs.attributes) {
    expected.attributes.resize(draw.attributes.size()), expected.attributes_high.resize(draw.attributes.size());
    for (std::size_t k = 0; k < draw.attributes.size(); ++k)
      fill(expected.attributes[k], expected.attributes_high[k], draw.attributes[k].components);
  }
  for (std::size_t s = 0; s < total; ++s) {
    if (expected.count[s] != 1 || expected.open[s] != 0) continue;
    const int x = static_cast<int>(s) % scene.width, y = static_cast<int>(s) / scene.width;
    // D is the sum of W_i E_i.
    if (outputs.depth &&
        !granted(edges, z, w, x, y, bits, largest_of(depth_at), expected.depth[s], expected.depth_high[s])) {
      return false;
    }
    for (std::size_t i = 0; outputs.barycentrics && i < 3; ++i) {
      std::array<Rational, 3> unit{0, 0, 0};
      unit[i] = 1;
      if (!granted(edges, unit, ones, x, y, bits, 1, expected.barycentrics[3 * s + i],
                   expected.barycentrics_high[3 * s + i]))
        return false;
    }
    for (std::size_t k = 0; outputs.attributes && k < draw.attributes.size(); ++k) {
      const AttributeArray& array = draw.attributes[k];
      for (std::size_t c = 0; c < array.components; ++c) {
        std::array<Rational, 3> u, above;
        for (std::size_t i = 0; i < 3; ++i) {
          u[i] = exact(array.values[draw.indices[i] * std::size_t{array.stride} + c]);
          if (array.interpolation == Interpolation::flat) u[i] = u[0];
          above[i] = array.interpolation == Interpolation::noperspective ? u[i] * w[i] : u[i];
        }
        const std::size_t at = s * array.components + c;
        if (!granted(edges, above, array.interpolation == Interpolation::noperspective ? w : ones, x, y, bits,
                     largest_of(u), expected.attributes[k][at], expected.attributes_high[k][at])) {
          return false;
        }
      }
    }
  }
  return true;
}

Expected exactly(const corpus::Frame& frame) {
  const corpus::Image& image = frame.image();
  Expected expected;
  expected.count = image.count, expected.index = image.index, expected.depth = image.depth;
  expected.barycentrics = image.barycentrics, expected.attributes = image.attributes;
  expected.winding = image.winding;
  return expected;
}

// False where the model cannot say. `depth` is that of the frame before, and becomes this one's.
bool expect(Model model, VectorFrame& frame, const corpus::Outputs& outputs, std::vector<float>& depth) {
  corpus::Scene scene = frame.scene;
  if (frame.previous) scene.initial_depth = depth;
  corpus::Frame drawn(scene, outputs);
  if (validate(drawn.target(), drawn.draws()) != Status::ok) return false;
  if (model == Model::exact) {
    oracle::render(drawn.target(), drawn.draws());
    frame.expected = exactly(drawn);
    depth = drawn.image().depth;
    return true;
  }
  frame.expected = {};
  if (!counts_under(model, drawn, frame.expected.count, frame.expected.open)) return false;
  if (!outputs.depth && !outputs.barycentrics && !outputs.attributes) return true;
  return values_under(model, scene, drawn, outputs, frame.expected);
}

// A window of at most so many samples around a pixel.
std::array<int, 4> window_around(int x, int y, const corpus::Scene& scene, std::size_t most) {
  int side = 1;
  while (static_cast<std::size_t>((side + 1) * (side + 1) * scene.samples) <= most) ++side;
  const int width = std::min(
      scene.width, std::max(side, static_cast<int>(most) / scene.samples / std::max(1, std::min(side, scene.height))));
  const int height = std::min(scene.height, static_cast<int>(most) / scene.samples / width);
  const int x0 = std::clamp(x - width / 2, 0, scene.width - width),
            y0 = std::clamp(y - height / 2, 0, scene.height - height);
  return {x0, y0, x0 + width, y0 + height};
}

// The value lies from low to high; bits are equal where they are one.
bool within(float value, float low, float high, bool interval) {
  if (!interval) return value == low ? std::signbit(value) == std::signbit(low) : std::isnan(value) && std::isnan(low);
  return low <= value && value <= high;
}

// Where it differs first, or the number of samples.
std::size_t difference(const Test& test, const VectorFrame& frame, const corpus::Image& image, Effects& effects) {
  const std::vector<std::size_t> samples = test.samples(), layered = test.samples(true);
  const Expected& e = frame.expected;
  std::size_t first = std::numeric_limits<std::size_t>::max();
  const auto check = [&](const std::vector<float>& low, const std::vector<float>& high, const std::vector<float>& got,
                         std::size_t elements, bool& seen) {
    for (const std::size_t s : layered) {
      for (std::size_t i = s * elements; i < (s + 1) * elements; ++i) {
        if (within(got[i], low[i], high.empty() ? low[i] : high[i], !high.empty())) continue;
        seen = true, first = std::min(first, s);
      }
    }
  };
  for (const std::size_t s : samples) {
    if (test.outputs.count) {
      const bool fewer = image.count[s] < e.count[s];
      const bool more = image.count[s] > e.count[s] + (e.open.empty() ? 0 : e.open[s]);
      effects.fewer |= fewer, effects.more |= more;
      if (fewer || more) first = std::min(first, s);
    }
    if (!e.winding.empty() && image.winding[s] != e.winding[s]) effects.winding = true, first = std::min(first, s);
  }
  for (const std::size_t s : layered)
    if (!e.index.empty() && image.index[s] != e.index[s]) effects.index = true, first = std::min(first, s);
  if (test.outputs.depth) check(e.depth, e.depth_high, image.depth, 1, effects.depth);
  if (test.outputs.barycentrics)
    check(e.barycentrics, e.barycentrics_high, image.barycentrics, 3, effects.barycentrics);
  for (std::size_t k = 0; test.outputs.attributes && k < e.attributes.size(); ++k) {
    static const std::vector<float> none;
    check(e.attributes[k], e.attributes_high.empty() ? none : e.attributes_high[k], image.attributes[k],
          frame.scene.attributes[k].components, effects.attributes);
  }
  return first;
}

// A frame that leaves behind a fill rule; and another one, for who counts frames.
void draw_before(Render render, bool otherwise) {
  std::array<std::uint32_t, 1> count{};
  const std::array<Vertex, 3> vertices{{{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}};
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  Target target;
  target.width = target.height = 1, target.count = count;
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  draw.fill_rule = otherwise ? FillRule::bottom_right : FillRule::top_left;
  for (int i = 0; i <= static_cast<int>(otherwise); ++i) (void)render(target, {&draw, 1});
}

// The first sample that differs, over all frames; nothing if none does.
std::optional<std::size_t> first_difference(const Test& test, Render render, bool otherwise, Effects& effects) {
  std::optional<std::size_t> first;
  draw_before(render, otherwise);
  corpus::Image before;
  for (const VectorFrame& vector : test.frames) {
    corpus::Scene scene = vector.scene;
    if (vector.previous) scene.initial_depth = before.depth;
    // A grid rasterizer has its grid, whatever the draws say.
    if (test.models.front() != Model::exact)
      for (corpus::SceneDraw& draw : scene.draws)
        draw.grid = Grid{kModelBits[static_cast<std::size_t>(test.models.front())], 0, 0};
    corpus::Frame frame(scene, test.outputs);
    if (before.width != 0) frame.image().depth.assign(before.depth.begin(), before.depth.end());
    if (render(frame.target(), frame.draws()) != Status::ok) {
      effects.no_image = true;
      return 0;
    }
    const std::size_t at = difference(test, vector, frame.image(), effects);
    if (!first && at != std::numeric_limits<std::size_t>::max()) first = at;
    before = frame.image();
  }
  return first;
}

Status right(const Target& target, std::span<const Draw> draws) {
  oracle::render(target, draws);
  return Status::ok;
}

// The middle of what is covered, as a pixel.
std::array<int, 2> middle(const Test& test) {
  const VectorFrame& frame = test.frames.front();
  std::vector<std::size_t> covered;
  for (std::size_t s = 0; s < frame.expected.count.size(); ++s)
    if (frame.expected.count[s] != 0) covered.push_back(s / static_cast<std::size_t>(frame.scene.samples));
  const auto pixel = covered.empty() ? 0 : static_cast<int>(covered[covered.size() / 2]);
  return {pixel % frame.scene.width, pixel / frame.scene.width};
}

}  // namespace

std::vector<std::size_t> Test::samples(bool layered) const {
  const corpus::Scene& scene = frames.front().scene;
  const auto [x0, y0, x1, y1] = window.value_or(std::array<int, 4>{0, 0, scene.width, scene.height});
  std::vector<std::size_t> all;
  const auto total = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height) *
                     static_cast<std::size_t>(scene.samples);
  for (int layer = 0; layer < (layered ? scene.layers : 1); ++layer)
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (int n = 0; n < scene.samples; ++n)
          all.push_back(
              (static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x)) *
                  static_cast<std::size_t>(scene.samples) +
              static_cast<std::size_t>(n) + static_cast<std::size_t>(layer) * total);
  return all;
}

std::optional<Test> test_of(const Subject& subject, const Candidate& candidate) {
  Test test;
  test.comment = candidate.comment, test.rules = candidate.rules, test.outputs = candidate.outputs;
  test.frames = candidate.frames, test.models = {subject.model};
  std::vector<float> depth;
  for (VectorFrame& frame : test.frames) {
    if (!expect(subject.model, frame, test.outputs, depth)) return std::nullopt;
  }
  const corpus::Scene& scene = test.frames.front().scene;
  if (test.samples().size() > subject.most_samples) {
    if (test.frames.size() > 1) return std::nullopt;
    const auto [x, y] = middle(test);
    test.window = window_around(x, y, scene, subject.most_samples);
  }
  // Where all models agree it is owed under each.
  if (subject.model == Model::exact && test.frames.size() == 1 && test.outputs.count && !test.outputs.index &&
      !test.outputs.depth && !test.outputs.attributes && !test.outputs.barycentrics) {
    corpus::Frame frame(scene, test.outputs);
    for (const Model other : {Model::grid4, Model::grid8}) {
      std::vector<std::uint32_t> count, open;
      if (!counts_under(other, frame, count, open)) continue;
      const std::vector<std::size_t> samples = test.samples();
      if (std::all_of(samples.begin(), samples.end(),
                      [&](std::size_t s) { return open[s] == 0 && count[s] == test.frames[0].expected.count[s]; }))
        test.models.push_back(other);
    }
  }
  // Nothing that is right may fail.
  Effects effects;
  if (first_difference(test, right, false, effects)) {
    if (subject.model != Model::exact) return std::nullopt;  // G2 counts weights of the wrong sign as 0
    throw std::runtime_error("vectors: a right rasterizer fails " + subject.name + ": " + test.comment);
  }
  return test;
}

std::optional<Effects> wrong_by(const Test& test, Render render) {
  Effects effects;
  for (const bool otherwise : {false, true})
    if (!first_difference(test, render, otherwise, effects)) return std::nullopt;
  return effects;
}

void Effects::take(const Effects& other) {
  no_image |= other.no_image, more |= other.more, fewer |= other.fewer, index |= other.index, depth |= other.depth;
  barycentrics |= other.barycentrics, attributes |= other.attributes, winding |= other.winding;
}

std::string Effects::text() const {
  std::string result;
  const auto add = [&result](bool seen, const char* what) {
    if (seen) result += (result.empty() ? "" : ", ") + std::string(what);
  };
  add(no_image, "no image");
  add(more, "samples covered that are not, or too often"), add(fewer, "samples not covered, or too seldom");
  add(index, "another triangle visible"), add(depth, "wrong depths"), add(barycentrics, "wrong barycentrics");
  add(attributes, "wrong attributes"), add(winding, "wrong winding");
  return result;
}

}  // namespace surefill::vectors
