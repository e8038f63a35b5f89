// SPDX-License-Identifier: Apache-2.0
#include "properties/machinery/resolutions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "oracle/occlusion.hpp"

namespace surefill::properties {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A target of the buffer's size, origin and depth test.
Target target_of(const corpus::Scene& occluders) {
  Target target;
  target.width = occluders.width, target.height = occluders.height;
  target.origin = occluders.origin, target.depth_test = occluders.depth_test;
  return target;
}

using Depth = std::vector<float> (*)(const Target&, std::span<const Draw>, std::span<const oracle::Positions>);
using BoxAnswer = Occlusion (*)(const Target&, std::span<const float>, const OcclusionBox&, oracle::OcclusionRule);
using RectangleAnswer = Occlusion (*)(const Target&, std::span<const float>, const OcclusionRectangle&,
                                      oracle::OcclusionRule);

SafeBufferMaker maker_of(Depth draw, BoxAnswer box, RectangleAnswer rectangle) {
  return [=](const corpus::Scene& occluders) {
    const corpus::Frame frame(occluders, {.count = false, .index = false, .depth = false, .barycentrics = false});
    const Target target = target_of(occluders);
    SafeBuffer buffer;
    buffer.depth = draw(target, frame.draws(), {});
    buffer.box = [=, depth = buffer.depth](const OcclusionBox& asked, bool equal) {
      return box(target, depth, asked, {.safe = true, .equal_is_visible = equal});
    };
    buffer.rectangle = [=, depth = buffer.depth](const OcclusionRectangle& asked, bool equal) {
      return rectangle(target, depth, asked, {.safe = true, .equal_is_visible = equal});
    };
    return buffer;
  };
}

// a x + b w, if it is a float32. Products of a few bits and a float32 are exact in double; the sum is if its error, by
// Knuth's two-sum, is 0.
std::optional<float> exact_sum(double a, float x, double b, float w) {
  const double p = a * static_cast<double>(x), q = b * static_cast<double>(w);
  const double sum = p + q, other = sum - p, error = (p - (sum - other)) + (q - other);
  if (error != 0 || !(std::abs(sum) <= static_cast<double>(std::numeric_limits<float>::max()))) return std::nullopt;
  const auto result = static_cast<float>(sum);
  if (static_cast<double>(result) != sum) return std::nullopt;
  return result;
}

bool is_greater(const corpus::Scene& scene) {
  return scene.depth_test == DepthTest::greater;
}

struct Place {
  double x, y;
};

// A place of the buffer that is worth a look: at a vertex, on an edge, or at the border of a square that is filled.
Place interesting(Random& r, const corpus::Scene& occluders, std::span<const float> depth) {
  const auto& o = occluders.origin;
  Place place{o.x + r.unit() * occluders.width, o.y + r.unit() * occluders.height};
  for (int tries = 0; tries < 20; ++tries) {
    if (r.one_in(2)) {
      const auto s = r.below(static_cast<std::uint32_t>(depth.size()));
      if (!std::isfinite(depth[s])) continue;
      const int x = static_cast<int>(s) % occluders.width, y = static_cast<int>(s) / occluders.width;
      place = {static_cast<double>(o.x + x + r.between(0, 1)), static_cast<double>(o.y + y + r.between(0, 1))};
      if (r.one_in(3)) place.x = o.x + x + r.unit();
      return place;
    }
    const corpus::SceneDraw& draw = occluders.draws[r.below(static_cast<std::uint32_t>(occluders.draws.size()))];
    if (draw.triangles.empty()) continue;
    const auto& t = draw.triangles[r.below(static_cast<std::uint32_t>(draw.triangles.size()))].vertices;
    const std::uint32_t corner = r.below(3);
    const corpus::SceneVertex &v = draw.vertices[t[corner]], &u = draw.vertices[t[(corner + 1) % 3]];
    const double f = r.one_in(2) ? 0 : r.unit();
    const double x = v.x * (1 - f) + u.x * f, y = v.y * (1 - f) + u.y * f, w = v.w * (1 - f) + u.w * f;
    if (!(w > 0)) continue;
    const Place there{x / w, y / w};
    if (there.x >= o.x - 1 && there.x <= o.x + occluders.width + 1 && there.y >= o.y - 1 &&
        there.y <= o.y + occluders.height + 1) {
      return there;
    }
  }
  return place;
}

void add_samples(Random& r, View& view) {
  view.samples = r.one_in(2) ? 1 : 1 << r.below(5);
  if (r.one_in(4)) return;
  const bool borders = r.one_in(3);
  for (int n = 0; n < view.samples; ++n) {
    const int x = borders && r.one_in(2) ? 0 : r.between(0, 15), y = borders && r.one_in(2) ? 0 : r.between(0, 15);
    view.locations.push_back({x, y});
  }
}

// --- What is hidden

// The farthest depth that the buffer has on these pixels of it; the rectangle may reach beyond.
float farthest(const corpus::Scene& occluders, std::span<const float> depth, int x0, int y0, int x1, int y1) {
  const bool greater = is_greater(occluders);
  float result = greater ? kInfinity : -kInfinity;
  for (int y = std::max(y0, 0); y <= std::min(y1, occluders.height - 1); ++y) {
    for (int x = std::max(x0, 0); x <= std::min(x1, occluders.width - 1); ++x) {
      const float z = depth[static_cast<std::size_t>(y * occluders.width + x)];
      result = greater ? std::min(result, z) : std::max(result, z);
    }
  }
  return result;
}

// The float behind it.
float behind(const corpus::Scene& occluders, float depth) {
  return std::nextafter(depth, is_greater(occluders) ? -kInfinity : kInfinity);
}

std::vector<std::array<Vertex, 3>> quad(float x0, float y0, float x1, float y1, float z) {
  const Vertex a{x0, y0, z, 1}, b{x1, y0, z, 1}, c{x1, y1, z, 1}, d{x0, y1, z, 1};
  return {{a, b, c}, {a, c, d}};
}

// The twelve faces of a box's corners, in the order of OcclusionBox of bits x, y, z, and others of the hull.
std::vector<std::array<Vertex, 3>> triangles_in(Random& r, const OcclusionBox& box) {
  constexpr std::size_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                        {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  std::vector<std::array<Vertex, 3>> result;
  for (const auto& [a, b, c, d] : kFaces) {
    result.push_back({box.corners[a], box.corners[b], box.corners[c]});
    result.push_back({box.corners[a], box.corners[c], box.corners[d]});
  }
  for (int n = 0; n < 4; ++n) {
    std::array<Vertex, 3>& t = result.emplace_back();
    for (Vertex& v : t) v = box.corners[r.below(8)];
  }
  return result;
}

// A rectangle in whole and in parts of pixels, as near as the buffer hides it, or an ulp nearer (then it may be visible).
void add_rectangle(Random& r, const corpus::Scene& occluders, const SafeBuffer& buffer, bool equal,
                   std::vector<Hidden>& hidden) {
  const int q = r.one_in(2) ? 1 : 1 << r.between(0, 8);
  const bool small = r.one_in(2);
  const std::array sizes = {occluders.width, occluders.height};
  std::array<float, 2> low{}, high{};
  for (std::size_t k = 0; k < 2; ++k) {
    const int first = r.between(-q, sizes[k] * q);
    const int last = first + r.between(0, small ? q : sizes[k] * q);
    low[k] = static_cast<float>(first) / static_cast<float>(q),
    high[k] = static_cast<float>(last) / static_cast<float>(q);
    if (r.one_in(4)) high[k] = std::nextafter(high[k], -1e9f);
    if (high[k] < low[k]) high[k] = low[k];
  }
  const auto pixel = [](float value) { return static_cast<int>(std::floor(value)); };
  // Sometimes as near as if it reached less far than it does.
  const int less_x = r.one_in(4) ? 1 : 0, less_y = r.one_in(4) ? 1 : 0;
  float d =
      farthest(occluders, buffer.depth, pixel(low[0]), pixel(low[1]), pixel(high[0]) - less_x, pixel(high[1]) - less_y);
  if (!std::isfinite(d)) return;
  if (equal) d = behind(occluders, d);
  if (r.one_in(8)) d = std::nextafter(d, is_greater(occluders) ? kInfinity : -kInfinity);
  if (!std::isfinite(d)) return;
  const auto ox = static_cast<float>(occluders.origin.x), oy = static_cast<float>(occluders.origin.y);
  const OcclusionRectangle asked{low[0] + ox, low[1] + oy, high[0] + ox, high[1] + oy, d};
  if (buffer.rectangle(asked, equal) == Occlusion::visible) return;
  hidden.push_back({quad(asked.x0, asked.y0, asked.x1, asked.y1, d), equal});
}

// A box in perspective: corners on a lattice of the screen at W of small integers, some of them behind the eye.
void add_box(Random& r, const corpus::Scene& occluders, const SafeBuffer& buffer, bool equal,
             std::vector<Hidden>& hidden) {
  const int q = 1 << r.between(0, 4), reach = r.one_in(2) ? 2 * q : 6 * q;
  const int x = r.between(-q, (occluders.width + 1) * q), y = r.between(-q, (occluders.height + 1) * q);
  std::array<std::array<float, 2>, 8> places{};
  std::array<float, 2> low{1e9f, 1e9f}, high{-1e9f, -1e9f};
  for (auto& place : places) {
    const int px = x + r.between(0, reach), py = y + r.between(0, reach);
    place = {static_cast<float>(px) / static_cast<float>(q), static_cast<float>(py) / static_cast<float>(q)};
    for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], place[k]), high[k] = std::max(high[k], place[k]);
  }
  const auto pixel = [](float value) { return static_cast<int>(std::floor(value)); };
  float d = farthest(occluders, buffer.depth, pixel(low[0]), pixel(low[1]), pixel(high[0]), pixel(high[1]));
  if (!std::isfinite(d)) return;
  if (equal) d = behind(occluders, d);
  const bool through_eye = r.one_in(6), nearer = r.one_in(6);  // the latter are mostly visible
  OcclusionBox box{};
  for (std::size_t k = 0; k < 8; ++k) {
    const float w = static_cast<float>(1 << r.between(0, 2)) * (r.one_in(4) ? 0.75f : 1.0f);
    const float farther = r.one_in(2) ? 0.0f : static_cast<float>(r.below(8)) / 64;
    const float z = d + (is_greater(occluders) == nearer ? farther : -farther);
    const float px = places[k][0] + static_cast<float>(occluders.origin.x);
    const float py = places[k][1] + static_cast<float>(occluders.origin.y);
    box.corners[k] = {px * w, py * w, z * w, w};
    if (!std::isfinite(box.corners[k].z)) return;
    if (through_eye && r.one_in(3)) box.corners[k].w = r.one_in(2) ? 0 : -w;
  }
  if (buffer.box(box, equal) == Occlusion::visible) return;
  hidden.push_back({triangles_in(r, box), equal});
}

// --- Scenes of views

corpus::SceneVertex scene_vertex(const Vertex& v, std::size_t attributes) {
  return {v.x, v.y, v.z, v.w, std::vector<float>(attributes, 0.0f)};
}

// The states that T7 allows of what is in the box.
void set_state(Random& r, corpus::SceneDraw& draw, bool closed) {
  const std::uint32_t rule = r.below(10);
  draw.fill_rule = closed ? FillRule::closed : static_cast<FillRule>(rule);
  draw.front_face = r.one_in(2) ? FrontFace::clockwise : FrontFace::counter_clockwise;
  if (!closed) draw.cull = static_cast<Cull>(r.below(3));
  draw.depth_mode = r.one_in(3) ? DepthMode::clip : DepthMode::none;
  draw.depth_write = !r.one_in(4);
}

bool add_triangle(corpus::SceneDraw& draw, const View& view, const std::array<Vertex, 3>& t, std::size_t attributes) {
  const auto first = static_cast<std::uint32_t>(draw.vertices.size());
  for (const Vertex& v : t) {
    const std::optional<Vertex> seen = seen_in(view, v);
    if (!seen) {
      draw.vertices.resize(first);
      return false;
    }
    draw.vertices.push_back(scene_vertex(*seen, attributes));
  }
  draw.triangles.push_back({{first, first + 1, first + 2}, {}});
  return true;
}

// Anything may be drawn before the occluders, and between them and what is hidden.
void add_others(Random& r, corpus::Scene& scene) {
  if (!r.one_in(4)) return;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  set_state(r, draw, false);
  for (int n = r.between(1, 3); n > 0; --n) {
    const std::span<const Category> all = categories();
    const auto t = all[r.below(static_cast<std::uint32_t>(all.size()))].triangle(r, scene.width, scene.height);
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    for (const Vertex& v : t) draw.vertices.push_back(scene_vertex(v, scene.attributes.size()));
    draw.triangles.push_back({{first, first + 1, first + 2}, {}});
  }
}

}  // namespace

SafeBufferMaker oracle_safe_buffer() {
  return maker_of(oracle::safe_depth, oracle::answer, oracle::answer);
}

SafeBufferMaker clipped_oracle_safe_buffer() {
  return maker_of(oracle::clipped::safe_depth, oracle::clipped::answer, oracle::clipped::answer);
}

SafeBufferMaker engine_safe_buffer(const Options& options) {
  return [options](const corpus::Scene& occluders) {
    const corpus::Frame frame(occluders, {.count = false, .index = false, .depth = false, .barycentrics = false});
    const auto engine = std::make_shared<SafeOcclusionBuffer>();
    std::vector<OccluderMesh> meshes(frame.draws().size());
    std::vector<Occluder> list(meshes.size());
    bool ok = engine->resize(occluders.width, occluders.height, occluders.depth_test) == Status::ok;
    for (std::size_t n = 0; n < meshes.size(); ++n) {
      const Draw& draw = frame.draws()[n];
      std::vector<float> positions;
      for (const Vertex& v : draw.vertices) positions.insert(positions.end(), {v.x, v.y, v.w});
      ok = ok && meshes[n].prepare(positions, draw.indices) == Status::ok;
      list[n].state() = draw.state();
      list[n].mesh = &meshes[n], list[n].vertices = draw.vertices;
    }
    ok = ok && engine->draw(list, options) == Status::ok;
    SafeBuffer buffer;
    if (!ok) return buffer;  // of no size
    buffer.depth.assign(engine->depth().begin(), engine->depth().end());
    const auto ask = [engine](const auto& asked, bool equal) {
      Occlusion answer = Occlusion::visible;
      engine->equal_is_visible(equal);
      if (engine->query({&asked, 1}, {&answer, 1}) != Status::ok)
        return Occlusion::outside;  // wrong wherever it matters
      return answer;
    };
    buffer.box = ask;
    buffer.rectangle = ask;
    return buffer;
  };
}

std::optional<Vertex> seen_in(const View& view, const Vertex& v) {
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.w)) return v;
  const std::optional<float> x = exact_sum(view.a, v.x, view.b, v.w), y = exact_sum(view.c, v.y, view.e, v.w);
  if (!x || !y) return std::nullopt;
  return Vertex{*x, *y, v.z, v.w};
}

View random_view(Random& r, const corpus::Scene& occluders, std::span<const float> depth, int size) {
  View view;
  switch (r.below(5)) {
    case 0:  // a small power of two
      view.a = view.c = std::ldexp(1.0, r.between(-1, 3));
      break;
    case 1:  // two of them
      view.a = std::ldexp(1.0, r.between(-1, 4));
      view.c = std::ldexp(1.0, r.between(-1, 4));
      break;
    case 2:  // a large one
      view.a = view.c = std::ldexp(1.0, r.between(2, 12));
      break;
    case 3:  // odd ones, where float32 has them
      view.a = r.between(1, 15), view.c = r.between(1, 15);
      if (r.one_in(2)) view.a /= 4, view.c /= 8;
      break;
    default:  // moved
      view.a = view.c = std::ldexp(1.0, r.between(0, 4));
      view.b = r.between(-32, 32) / 16.0, view.e = r.between(-32, 32) / 16.0;
      break;
  }
  const double x0 = view.a * occluders.origin.x + view.b, y0 = view.c * occluders.origin.y + view.e;
  const double width = view.a * occluders.width, height = view.c * occluders.height;
  if (width <= size && height <= size && r.one_in(2)) {  // the whole, and at most two pixels more or less
    view.origin = {static_cast<int>(std::floor(x0)) - r.between(0, 1),
                   static_cast<int>(std::floor(y0)) - r.between(0, 1)};
    view.width = std::max(1, static_cast<int>(std::ceil(width)) + r.between(-1, 2));
    view.height = std::max(1, static_cast<int>(std::ceil(height)) + r.between(-1, 2));
  } else {
    const Place place = interesting(r, occluders, depth);
    view.width = r.between(1, std::min(size, 48)), view.height = r.between(1, std::min(size, 48));
    const double x = view.a * place.x + view.b, y = view.c * place.y + view.e;
    view.origin = {static_cast<int>(std::floor(x)) - r.between(0, view.width),
                   static_cast<int>(std::floor(y)) - r.between(0, view.height)};
  }
  view.origin.x = std::clamp(view.origin.x, -kMaxOrigin, kMaxOrigin);
  view.origin.y = std::clamp(view.origin.y, -kMaxOrigin, kMaxOrigin);
  add_samples(r, view);
  return view;
}

std::vector<Hidden> hidden_things(Random& r, const corpus::Scene& occluders, const SafeBuffer& buffer, bool equal,
                                  int things) {
  std::vector<Hidden> hidden;
  // A square without a 2^-12th of it reaches no other one.
  constexpr float kAlmostOne = 1 - 0x1p-12f;
  for (std::size_t s = 0; s < buffer.depth.size(); ++s) {
    const float z = equal ? behind(occluders, buffer.depth[s]) : buffer.depth[s];
    if (!std::isfinite(buffer.depth[s]) || !std::isfinite(z)) continue;
    const auto x = static_cast<float>(occluders.origin.x + static_cast<int>(s) % occluders.width);
    const auto y = static_cast<float>(occluders.origin.y + static_cast<int>(s) / occluders.width);
    const OcclusionRectangle asked{x, y, x + kAlmostOne, y + kAlmostOne, z};
    if (buffer.rectangle(asked, equal) != Occlusion::visible)
      hidden.push_back({quad(x, y, asked.x1, asked.y1, z), equal});
  }
  for (int n = 0; n < things; ++n) {
    if (r.one_in(2)) {
      add_rectangle(r, occluders, buffer, equal, hidden);
    } else {
      add_box(r, occluders, buffer, equal, hidden);
    }
  }
  return hidden;
}

std::optional<std::string> sight(Random& r, const corpus::Scene& occluders, const View& view,
                                 std::span<const Hidden> hidden, const Renderer& renderer, Sightings& sightings) {
  corpus::Scene scene;
  scene.width = view.width, scene.height = view.height, scene.samples = view.samples;
  scene.origin = view.origin, scene.sample_locations = view.locations;
  scene.depth_test = occluders.depth_test;
  scene.attributes = occluders.attributes;
  if (!hidden.empty() && hidden[0].equal_is_visible && r.one_in(2)) {  // T7: with O6 these, too
    scene.depth_test = is_greater(occluders) ? DepthTest::greater_equal : DepthTest::less_equal;
  }
  if (r.one_in(8)) scene.initial_depth = {static_cast<float>(r.between(-2, 10)) / 8};  // as if drawn before
  add_others(r, scene);
  for (const corpus::SceneDraw& draw : occluders.draws) {
    corpus::SceneDraw& drawn = scene.draws.emplace_back(draw);
    const std::uint32_t rule = r.below(9);
    drawn.fill_rule = static_cast<FillRule>(rule);  // any but open, whatever the buffer had
    for (corpus::SceneVertex& v : drawn.vertices) {
      const std::optional<Vertex> seen = seen_in(view, {v.x, v.y, v.z, v.w});
      if (!seen) {
        ++sightings.unfit;
        return std::nullopt;
      }
      v.x = seen->x, v.y = seen->y;
    }
  }
  add_others(r, scene);
  std::uint32_t others = 0;
  for (const corpus::SceneDraw& draw : scene.draws) others += static_cast<std::uint32_t>(draw.triangles.size());
  // Everything once closed, and once in some other state.
  for (const bool closed : {true, false}) {
    corpus::SceneDraw& draw = scene.draws.emplace_back();
    set_state(r, draw, closed);
    for (const Hidden& thing : hidden) {
      for (const auto& t : thing.triangles) add_triangle(draw, view, t, scene.attributes.size());
    }
  }
  corpus::Outputs outputs{.count = false, .barycentrics = false, .attributes = false};
  corpus::Frame frame(scene, outputs);
  if (renderer(frame.target(), frame.draws()) != Status::ok)
    return "the view is refused:\n" + corpus::write_scene(scene);

  ++sightings.views;
  const std::vector<std::uint32_t>& index = frame.image().index;
  sightings.samples += index.size();
  for (std::size_t s = 0; s < index.size(); ++s) {
    if (index[s] == kNoTriangle || index[s] < others) continue;
    const int pixel = static_cast<int>(s) / view.samples, n = static_cast<int>(s) % view.samples;
    const SampleLocation at =
        view.locations.empty() ? sample_location(view.samples, n) : view.locations[static_cast<std::size_t>(n)];
    const int column = view.origin.x + pixel % view.width, row = view.origin.y + pixel / view.width;
    const double x = column + at.x / 16.0 - view.b, y = row + at.y / 16.0 - view.e;  // a times the buffer's, exactly
    const Origin& o = occluders.origin;
    if (x < view.a * o.x || x >= view.a * (o.x + occluders.width) || y < view.c * o.y ||
        y >= view.c * (o.y + occluders.height)) {
      continue;  // the buffer does not show it
    }
    return "at sample " + std::to_string(n) + " of pixel (" + std::to_string(column) + ", " + std::to_string(row) +
           "), in the buffer at (" + std::to_string(x / view.a) + ", " + std::to_string(y / view.c) + "), triangle " +
           std::to_string(index[s]) + " is seen, which is hidden (from " + std::to_string(others) + " on)\n" +
           corpus::write_scene(scene);
  }
  if (sightings.views % 16 == 1) {
    scene.draws.erase(scene.draws.begin(), scene.draws.end() - 2);
    corpus::Frame alone(scene, outputs);
    if (renderer(alone.target(), alone.draws()) != Status::ok) return "refused";
    for (const std::uint32_t i : alone.image().index) sightings.covered += i != kNoTriangle;
  }
  return std::nullopt;
}

std::optional<std::string> violation(const corpus::Scene& occluders, const SafeBufferMaker& maker, std::uint64_t seed,
                                     const Effort& effort, Sightings& sightings) {
  Random r(seed);
  const SafeBuffer buffer = maker(occluders);
  for (const bool equal : {false, true}) {
    const std::vector<Hidden> hidden = hidden_things(r, occluders, buffer, equal, effort.things);
    sightings.things += hidden.size();
    if (hidden.empty()) continue;
    const int views = equal ? (effort.views + 2) / 3 : effort.views;
    for (int n = 0; n < views; ++n) {
      const View view = random_view(r, occluders, buffer.depth, effort.size);
      if (auto found = sight(r, occluders, view, hidden, effort.renderer, sightings)) {
        return "the occluders:\n" + corpus::write_scene(occluders) + *found;
      }
    }
  }
  return std::nullopt;
}

}  // namespace surefill::properties
