// SPDX-License-Identifier: Apache-2.0
//
// The C interface says what the C++ one says: for each member of each struct, a frame in which it has a value of its
// own gives the image and statistics of C++, and not those of the frame without. A member that is dropped, or taken
// for its neighbour, shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "surefill/diagnostics.hpp"
#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace surefill {
namespace {

constexpr float kFloatMax = 3.4028234663852886e38f;

// A frame in C's structs, with everything that they point to.
struct Frame {
  std::vector<surefill_vertex> vertices[2];
  std::vector<std::uint32_t> indices, identifiers;
  std::vector<float> values[2];
  surefill_attribute_array arrays[2][2] = {};
  surefill_scissor scissor{2, 3, 50, 60};
  surefill_grid grid{4, 3, 9, SUREFILL_NEAREST_EVEN};
  surefill_vertex box[8] = {};
  surefill_draw draws[2] = {};
  surefill_attribute_target attributes[2] = {};
  surefill_target target{};
  surefill_options options{};
  std::vector<float> initial;
  // Which outputs are asked for.
  bool count = true, index = true, depth = true, barycentrics = true, attribute[2] = {true, true},
       initial_depth = false;

  Frame() {
    // Slivers and larger triangles, some behind each other, some behind the eye, with corners near samples and depths
    // from -0.5 to 1.5.
    std::uint64_t state = 4;
    const auto unit = [&state] {
      state = state * 6364136223846793005u + 1442695040888963407u;
      return static_cast<float>(state >> 40) * 0x1p-24f;
    };
    for (std::uint32_t d = 0; d < 2; ++d) {
      for (int t = 0; t < 24; ++t) {
        const float x = unit() * 50, y = unit() * 60, z = unit() * 2 - 0.5f, size = t % 3 == 0 ? 40.0f : 9.0f;
        for (int corner = 0; corner < 3; ++corner) {
          const float w = t % 7 == 3 && corner == 0 ? -0.5f : 0.5f + unit();
          vertices[d].push_back(
              {(x + (unit() - 0.5f) * size) * w, (y + (unit() - 0.5f) * size) * w, (z + 0.2f * unit()) * w, w});
          for (int c = 0; c < 3; ++c) values[d].push_back(unit() * 4 - 2);
        }
      }
    }
    // Quads whose edges pass through samples, for fill rules.
    for (const float x : {4.5f, 20.5f}) {
      for (const auto& [px, py] : std::vector<std::array<float, 2>>{
               {x, 4.5f}, {x + 6, 4.5f}, {x + 6, 10.5f}, {x, 4.5f}, {x + 6, 10.5f}, {x, 10.5f}}) {
        vertices[0].push_back({px, py, -1, 1});
        values[0].insert(values[0].end(), {px, py, 1});
      }
    }
    for (std::uint32_t i = 0; i < 72; ++i) indices.push_back(i), identifiers.push_back(200 - i);
    identifiers.resize(24);
    for (std::uint32_t d = 0; d < 2; ++d) {
      arrays[d][0] = {values[d].data(), values[d].size(), 1, 3, SUREFILL_PERSPECTIVE};
      arrays[d][1] = {values[d].data() + 1, values[d].size() - 1, 2, 3, SUREFILL_PERSPECTIVE};
      surefill_draw& draw = draws[d];
      draw.struct_size = sizeof draw;
      draw.vertices = vertices[d].data(), draw.vertex_count = vertices[d].size();
      draw.indices = indices.data(), draw.index_count = indices.size();
      draw.attributes = arrays[d], draw.attribute_count = 2;
    }
    for (std::uint32_t i = 72; i < 84; ++i) indices.push_back(i);
    draws[0].indices = draws[1].indices = indices.data();
    draws[0].index_count = indices.size();
    for (std::size_t i = 0; i < 8; ++i) {
      box[i] = {i % 2 == 0 ? -50.0f : -40.0f, i / 2 % 2 == 0 ? -50.0f : -40.0f, 0.5f, 1};
    }
    for (std::size_t k = 0; k < 2; ++k) attributes[k].components = static_cast<std::uint32_t>(k) + 1;
    target.struct_size = sizeof target;
    target.width = 50, target.height = 61, target.samples = 1;
    target.attributes = attributes, target.attribute_count = 2;
    options.struct_size = sizeof options;
  }
};

// What a call has answered.
struct Answer {
  std::uint32_t status = 0;
  std::string bytes;
  std::array<std::uint64_t, 6> statistics{};
  std::string path;

  bool operator==(const Answer&) const = default;
};

struct Buffers {
  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, barycentrics, attribute[2];

  Buffers(const Frame& f, std::size_t total) {
    if (f.count) count.resize(total);
    if (f.index) index.resize(total);
    if (f.depth) depth.resize(total);
    if (f.barycentrics) barycentrics.resize(3 * total);
    for (std::size_t k = 0; k < 2; ++k) {
      if (f.attribute[k]) attribute[k].resize(total * f.attributes[k].components);
    }
  }
  std::string bytes() const {
    std::string all;
    const auto append = [&all](const auto& values) {
      all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
    };
    append(count), append(index), append(depth), append(barycentrics), append(attribute[0]), append(attribute[1]);
    return all;
  }
};

std::vector<float> initial_of(const Frame& f, std::size_t total) {
  std::vector<float> initial(f.initial_depth ? total : 0);
  for (std::size_t i = 0; i < initial.size(); ++i) initial[i] = static_cast<float>(i % 7) / 7;
  return initial;
}

Answer in_c(Frame f) {
  const std::size_t total = surefill_sample_total(&f.target);
  Buffers b(f, total);
  const std::vector<float> initial = initial_of(f, total);
  f.target.count = b.count.data(), f.target.count_count = b.count.size();
  f.target.index = b.index.data(), f.target.index_count = b.index.size();
  f.target.depth = b.depth.data(), f.target.depth_count = b.depth.size();
  f.target.barycentrics = b.barycentrics.data(), f.target.barycentrics_count = b.barycentrics.size();
  f.target.initial_depth = initial.data(), f.target.initial_depth_count = initial.size();
  for (std::size_t k = 0; k < 2; ++k) {
    f.attributes[k].values = b.attribute[k].data(), f.attributes[k].value_count = b.attribute[k].size();
  }
  f.target.attributes = f.attributes;
  surefill_statistics s{};
  s.struct_size = sizeof s;
  Answer answer;
  answer.status = static_cast<std::uint32_t>(surefill_render(&f.target, f.draws, 2, &f.options, &s));
  answer.bytes = b.bytes();
  answer.statistics = {s.triangles, s.dropped, s.degenerate, s.culled, s.outside, s.rasterized};
  answer.path = s.path == nullptr ? "" : s.path;
  return answer;
}

// The same, written member by member from the header, and not from the engine's conversion.
Answer in_cpp(const Frame& f) {
  Target target;
  target.width = f.target.width, target.height = f.target.height, target.samples = f.target.samples;
  target.depth_test = static_cast<DepthTest>(f.target.depth_test);
  target.attribute_location = static_cast<AttributeLocation>(f.target.attribute_location);
  const std::size_t total = sample_total(target);
  Buffers b(f, total);
  const std::vector<float> initial = initial_of(f, total);
  target.count = b.count, target.index = b.index, target.depth = b.depth, target.barycentrics = b.barycentrics;
  target.initial_depth = initial;
  AttributeTarget attributes[2];
  for (std::size_t k = 0; k < 2; ++k) attributes[k] = {b.attribute[k], f.attributes[k].components};
  target.attributes = {attributes, f.target.attribute_count};
  std::vector<AttributeArray> arrays[2];
  std::vector<Vertex> vertices[2];
  Draw draws[2];
  for (std::size_t d = 0; d < 2; ++d) {
    const surefill_draw& from = f.draws[d];
    Draw& to = draws[d];
    const std::size_t stride = from.vertex_stride == 0 ? 16 : from.vertex_stride;
    for (std::size_t v = 0; v < from.vertex_count; ++v) {
      Vertex vertex;
      std::memcpy(&vertex, reinterpret_cast<const char*>(from.vertices) + v * stride, sizeof vertex);
      vertices[d].push_back(vertex);
    }
    to.vertices = vertices[d];
    to.indices = {from.indices, from.index_count};
    to.identifiers = {from.identifiers, from.identifier_count};
    to.first_index = from.first_index;
    for (std::size_t k = 0; k < from.attribute_count; ++k) {
      const surefill_attribute_array& array = from.attributes[k];
      arrays[d].push_back({std::span(array.values, array.value_count), array.components, array.stride,
                           static_cast<Interpolation>(array.interpolation)});
    }
    to.attributes = arrays[d];
    to.fill_rule = static_cast<FillRule>(from.fill_rule);
    to.front_face = static_cast<FrontFace>(from.front_face);
    to.cull = static_cast<Cull>(from.cull);
    to.depth_mode = static_cast<DepthMode>(from.depth_mode);
    to.depth_write = from.depth_write_off == 0;
    to.conservative = static_cast<Conservative>(from.conservative);
    if (from.scissor != nullptr) {
      to.scissor = Scissor{from.scissor->x0, from.scissor->y0, from.scissor->x1, from.scissor->y1};
    }
    if (from.grid != nullptr) {
      to.grid = Grid{from.grid->bits, from.grid->offset_x, from.grid->offset_y,
                     static_cast<GridRounding>(from.grid->rounding)};
    }
    if (from.culling_box != nullptr) {
      to.culling_box.emplace();
      std::memcpy(to.culling_box->data(), from.culling_box, sizeof *to.culling_box);
    }
  }
  Options options;
  options.threads = f.options.threads == 0 ? 1 : f.options.threads;
  options.path = static_cast<Path>(f.options.path);
  Statistics s;
  Diagnostics d;
  options.diagnostics = &d;
  Answer answer;
  answer.status = static_cast<std::uint32_t>(render(target, draws, &s, options));
  answer.bytes = b.bytes();
  answer.statistics = {s.triangles(), s.dropped, s.degenerate, s.culled, 0, s.rasterized};
  answer.path = d.path;
  return answer;
}

struct Change {
  const char* name;
  void (*make)(Frame&);
};

void with_grid(Frame& f) {
  f.draws[0].grid = &f.grid;
}
void with_scissor(Frame& f) {
  f.draws[1].scissor = &f.scissor;
}
void counts_alone(Frame& f) {
  f.index = f.depth = f.barycentrics = f.attribute[0] = f.attribute[1] = false;
}
void several_samples(Frame& f) {
  f.target.samples = 4;
}

// Each list begins with the frame that its changes are made to, and that they must differ from, and from each other.
const std::vector<std::vector<Change>> kChanges = {
    {{"as it is", [](Frame&) {}},
     {"width", [](Frame& f) { f.target.width = 51; }},
     {"height", [](Frame& f) { f.target.height = 62; }},
     {"2 samples", [](Frame& f) { f.target.samples = 2; }},
     {"16 samples", [](Frame& f) { f.target.samples = 16; }},
     {"depth test", [](Frame& f) { f.target.depth_test = SUREFILL_GREATER; }},
     {"no count", [](Frame& f) { f.count = false; }},
     {"no index", [](Frame& f) { f.index = false; }},
     {"no depth", [](Frame& f) { f.depth = false; }},
     {"no barycentrics", [](Frame& f) { f.barycentrics = false; }},
     {"no attribute 0", [](Frame& f) { f.attribute[0] = false; }},
     {"no attribute 1", [](Frame& f) { f.attribute[1] = false; }},
     {"initial depth", [](Frame& f) { f.initial_depth = true; }},
     {"one attribute", [](Frame& f) { f.target.attribute_count = 1; }},
     {"vertices", [](Frame& f) { f.draws[1].vertices = f.vertices[0].data() + 3; }},
     {"stride",
      [](Frame& f) { f.draws[1].vertex_stride = 20, f.draws[1].vertex_count = 57, f.draws[1].index_count = 57; }},
     {"indices", [](Frame& f) { f.draws[1].indices += 1, f.draws[1].index_count -= 3; }},
     {"fewer indices", [](Frame& f) { f.draws[1].index_count -= 9; }},
     {"identifiers", [](Frame& f) { f.draws[1].identifiers = f.identifiers.data(), f.draws[1].identifier_count = 24; }},
     {"first index", [](Frame& f) { f.draws[1].first_index = 1000; }},
     {"fill rule 1", [](Frame& f) { f.draws[0].fill_rule = SUREFILL_TOP_RIGHT; }},
     {"fill rule 2", [](Frame& f) { f.draws[0].fill_rule = SUREFILL_BOTTOM_LEFT; }},
     {"fill rule 3", [](Frame& f) { f.draws[0].fill_rule = SUREFILL_BOTTOM_RIGHT; }},
     {"cull front", [](Frame& f) { f.draws[0].cull = SUREFILL_CULL_FRONT; }},
     {"cull back", [](Frame& f) { f.draws[1].cull = SUREFILL_CULL_BACK; }},
     {"cull back, counter-clockwise front",
      [](Frame& f) { f.draws[1].cull = SUREFILL_CULL_BACK, f.draws[1].front_face = SUREFILL_COUNTER_CLOCKWISE; }},
     {"depth clip", [](Frame& f) { f.draws[1].depth_mode = SUREFILL_DEPTH_CLIP; }},
     {"depth clamp", [](Frame& f) { f.draws[1].depth_mode = SUREFILL_DEPTH_CLAMP; }},
     {"depth write off", [](Frame& f) { f.draws[0].depth_write_off = 256; }},
     {"scissor", with_scissor},
     {"grid", with_grid},
#if !defined(SUREFILL_REFERENCE_ONLY)  // the reference path asks no box
     {"culling box, not kept",
      [](Frame& f) { f.draws[1].culling_box = f.box; }},  // the promise is broken: the draw is skipped
#endif
     {"array values", [](Frame& f) { f.arrays[1][0].values += 1, f.arrays[1][0].value_count -= 1; }},
     {"array stride", [](Frame& f) { f.arrays[1][1].stride = 2; }},
     {"dense array", [](Frame& f) { f.arrays[1][0].stride = 0; }},
     {"noperspective", [](Frame& f) { f.arrays[1][1].interpolation = SUREFILL_NOPERSPECTIVE; }},
     {"flat", [](Frame& f) { f.arrays[1][1].interpolation = SUREFILL_FLAT; }},
     {"flat, the other", [](Frame& f) { f.arrays[1][0].interpolation = SUREFILL_FLAT; }},
     {"components",
      [](Frame& f) { f.attributes[1].components = f.arrays[0][1].components = f.arrays[1][1].components = 1; }},
#if !defined(SUREFILL_REFERENCE_ONLY)
     {"reference path", [](Frame& f) { f.options.path = SUREFILL_PATH_REFERENCE; }},
#endif
     {"no threads", [](Frame& f) { f.options.threads = -1; }},
     {"no such path", [](Frame& f) { f.options.path = 2; }}},
    {{"scissor", with_scissor},
     {"scissor x0", [](Frame& f) { with_scissor(f), f.scissor.x0 = 11; }},
     {"scissor y0", [](Frame& f) { with_scissor(f), f.scissor.y0 = 12; }},
     {"scissor x1", [](Frame& f) { with_scissor(f), f.scissor.x1 = 41; }},
     {"scissor y1", [](Frame& f) { with_scissor(f), f.scissor.y1 = 42; }}},
    {{"grid", with_grid},
     {"grid bits", [](Frame& f) { with_grid(f), f.grid.bits = 2; }},
     {"grid offset x", [](Frame& f) { with_grid(f), f.grid.offset_x = 14; }},
     {"grid offset y", [](Frame& f) { with_grid(f), f.grid.offset_y = 1; }},
     {"grid rounding up", [](Frame& f) { with_grid(f), f.grid.bits = 0, f.grid.rounding = SUREFILL_NEAREST_UP; }},
     {"grid rounding to zero", [](Frame& f) { with_grid(f), f.grid.rounding = SUREFILL_TRUNCATE; }}},
    {{"counts alone", counts_alone},
     {"conservative, over", [](Frame& f) { counts_alone(f), f.draws[1].conservative = SUREFILL_CONSERVATIVE_OVER; }},
     {"conservative, inner", [](Frame& f) { counts_alone(f), f.draws[1].conservative = SUREFILL_CONSERVATIVE_INNER; }},
     {"fill rule 4", [](Frame& f) { counts_alone(f), f.draws[0].fill_rule = SUREFILL_TOP_RIGHT; }}},
    {{"4 samples", several_samples},
     {"centroid", [](Frame& f) { several_samples(f), f.target.attribute_location = SUREFILL_CENTROID; }}},
};

TEST(C, SaysWhatCppSays) {
  for (const std::vector<Change>& changes : kChanges) {
    std::vector<Answer> before;
    for (const auto& [name, change] : changes) {
      Frame f;
      change(f);
      const Answer expected = in_cpp(f), actual = in_c(f);
      ASSERT_EQ(actual.status, expected.status) << name;
      ASSERT_EQ(actual.statistics, expected.statistics) << name;
      ASSERT_EQ(actual.path, expected.path) << name;
      ASSERT_TRUE(actual == expected) << name;
      EXPECT_EQ(std::count(before.begin(), before.end(), expected), 0) << name << " changes nothing";
      before.push_back(expected);
    }
  }
}

// Enumerators have one number in both: what the tests above do not tell apart.
TEST(C, HasTheSameEnumerators) {
  EXPECT_EQ(static_cast<int>(FillRule::southwards), SUREFILL_SOUTHWARDS);
  EXPECT_EQ(static_cast<int>(FillRule::southwards_west), SUREFILL_SOUTHWARDS_WEST);
  EXPECT_EQ(static_cast<int>(FillRule::northwards), SUREFILL_NORTHWARDS);
  EXPECT_EQ(static_cast<int>(FillRule::northwards_west), SUREFILL_NORTHWARDS_WEST);
  // A status is the same number, and the same sentence; each C++ one that the C interface can return has a name there.
  std::set<std::string> texts;
  for (std::uint32_t s = 0; s <= SUREFILL_OCCLUDER_VERTICES; ++s) {
    const std::string text = status_text(static_cast<Status>(s));
    EXPECT_EQ(text, surefill_status_text(static_cast<surefill_status>(s)));
    EXPECT_NE(text, "unknown status");
    EXPECT_TRUE(texts.insert(text).second) << text;
  }
  EXPECT_STREQ(status_text(static_cast<Status>(SUREFILL_OCCLUDER_VERTICES + 1)), "unknown status");
  EXPECT_EQ(static_cast<int>(Status::target_overlap), SUREFILL_TARGET_OVERLAP);
  EXPECT_EQ(static_cast<int>(Status::draw_first_index), SUREFILL_DRAW_FIRST_INDEX);
  EXPECT_EQ(static_cast<int>(Status::occluder_vertices), SUREFILL_OCCLUDER_VERTICES);
  EXPECT_EQ(static_cast<int>(Status::options_path), SUREFILL_OPTIONS_PATH);
  EXPECT_EQ(static_cast<int>(Status::to_pixel_vertices), SUREFILL_TO_PIXEL_VERTICES);
}

TEST(C, MapsToPixelsAsCppDoes) {
  const surefill_viewport base{1, 2, 30, 40, 0.25f, 0.75f, 0, 0};
  const surefill_vertex in[2] = {{0.5f, -0.25f, 0.125f, 1}, {-3, 2, 0.3f, 0.7f}};
  std::set<std::vector<float>> seen;
  for (int change = 0; change <= 8; ++change) {
    surefill_viewport v = base;
    float* const numbers[] = {&v.x, &v.y, &v.width, &v.height, &v.near_depth, &v.far_depth};
    if (change < 6) *numbers[change] += 0.5f + static_cast<float>(change);
    if (change == 6) v.clip_depth_minus_one = 1;
    if (change == 7) v.clip_y_down = 1;
    const Viewport expected{v.x,
                            v.y,
                            v.width,
                            v.height,
                            v.near_depth,
                            v.far_depth,
                            static_cast<ClipDepth>(v.clip_depth_minus_one),
                            static_cast<ClipY>(v.clip_y_down)};
    std::vector<float> c(8), cpp(8);
    ASSERT_EQ(surefill_to_pixel(&v, in, 2, reinterpret_cast<surefill_vertex*>(c.data())), SUREFILL_OK);
    ASSERT_EQ(
        to_pixel(expected, {reinterpret_cast<const ClipVertex*>(in), 2}, {reinterpret_cast<Vertex*>(cpp.data()), 2}),
        Status::ok);
    EXPECT_EQ(c, cpp);
    EXPECT_TRUE(seen.insert(c).second) << change;
  }
  for (int samples = 0; samples <= 16; ++samples) {
    for (int n = -1; n <= 16; ++n) {
      std::int32_t x = -1, y = -1;
      surefill_sample_location(samples, n, &x, &y);
      EXPECT_EQ(x, sample_location(samples, n).x);
      EXPECT_EQ(y, sample_location(samples, n).y);
    }
  }
}

TEST(C, QueriesAsCppDoes) {
  const surefill_vertex vertices[3] = {{-100, -100, 0.5f, 1}, {300, -100, 0.5f, 1}, {-100, 300, 0.5f, 1}};
  const std::uint32_t indices[3] = {0, 1, 2};
  surefill_draw draw{};
  draw.struct_size = sizeof draw;
  draw.vertices = vertices, draw.vertex_count = 3, draw.indices = indices, draw.index_count = 3;
  const surefill_scissor scissor{0, 0, 20, 10};  // there is an occluder here only
  draw.scissor = &scissor;
  Draw cpp_draw;
  cpp_draw.vertices = {reinterpret_cast<const Vertex*>(vertices), 3}, cpp_draw.indices = indices;
  cpp_draw.scissor = Scissor{0, 0, 20, 10};
  for (const std::uint32_t test : {SUREFILL_LESS, SUREFILL_GREATER}) {
    surefill_occlusion* c = nullptr;
    OcclusionBuffer cpp;
    ASSERT_EQ(surefill_occlusion_create(30, 40, test, &c), SUREFILL_OK);
    ASSERT_EQ(cpp.resize(30, 40, static_cast<DepthTest>(test)), Status::ok);
    ASSERT_EQ(surefill_occlusion_draw(c, &draw, 1, nullptr, nullptr), SUREFILL_OK);
    ASSERT_EQ(cpp.draw({&cpp_draw, 1}), Status::ok);
    EXPECT_EQ(std::memcmp(surefill_occlusion_depth(c), cpp.depth().data(), cpp.depth().size_bytes()), 0);
    std::vector<surefill_rectangle> rectangles;
    for (const float z : {0.25f, 0.75f}) {
      for (const float right : {15.0f, 25.0f}) {
        for (const float bottom : {7.0f, 15.0f}) rectangles.push_back({2, 1, right, bottom, z});
      }
      rectangles.push_back({22, 1, 25, 7, z});
      rectangles.push_back({2, 12, 5, 17, z});
      rectangles.push_back({5, 1, 2, 7, z});
    }
    std::vector<surefill_box> boxes;
    for (const surefill_rectangle& r : rectangles) {
      surefill_box& box = boxes.emplace_back();
      for (std::size_t i = 0; i < 8; ++i) {
        box.corners[i] = {i % 2 == 0 ? r.x0 : r.x1, i / 2 % 2 == 0 ? r.y0 : r.y1, r.nearest_depth, 1};
      }
    }
    std::vector<std::uint8_t> of_rectangles(rectangles.size()), of_boxes(boxes.size());
    std::vector<Occlusion> expected_rectangles(rectangles.size()), expected_boxes(boxes.size());
    ASSERT_EQ(surefill_occlusion_query_rectangles(c, rectangles.data(), rectangles.size(), of_rectangles.data()),
              SUREFILL_OK);
    ASSERT_EQ(surefill_occlusion_query_boxes(c, boxes.data(), boxes.size(), of_boxes.data()), SUREFILL_OK);
    const std::span cpp_rectangles(reinterpret_cast<const OcclusionRectangle*>(rectangles.data()), rectangles.size());
    const std::span cpp_boxes(reinterpret_cast<const OcclusionBox*>(boxes.data()), boxes.size());
    ASSERT_EQ(cpp.query(cpp_rectangles, expected_rectangles), Status::ok);
    ASSERT_EQ(cpp.query(cpp_boxes, expected_boxes), Status::ok);
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
      EXPECT_EQ(of_rectangles[i], static_cast<std::uint8_t>(expected_rectangles[i])) << i;
      EXPECT_EQ(of_boxes[i], static_cast<std::uint8_t>(expected_boxes[i])) << i;
    }
    surefill_occlusion_clear(c);
    EXPECT_EQ(surefill_occlusion_depth(c)[0], test == SUREFILL_LESS ? INFINITY : -INFINITY);
    surefill_occlusion_destroy(c);
  }
}

// O2: the nearest depth of a box is rounded as I4 has it: beyond float32 it is the largest finite number, which is
// nearer than nothing at all (+inf), and not as far. On the near side likewise.
TEST(Occlusion, QuotientsBeyondRangeAreTheLargestNumber) {
  for (const DepthTest test : {DepthTest::less, DepthTest::greater}) {
    const float sign = test == DepthTest::less ? 1.0f : -1.0f;  // of a depth far away
    OcclusionBuffer buffer;
    ASSERT_EQ(buffer.resize(20, 20, test), Status::ok);
    OcclusionBox far, near;
    for (std::size_t i = 0; i < 8; ++i) {
      const float x = i % 2 == 0 ? 3 : 9, y = i / 2 % 2 == 0 ? 3 : 9, w = 0x1p-60f;
      far.corners[i] = {x * w, y * w, sign * 1e30f, w};
      near.corners[i] = {x * w, y * w, sign * -1e30f, w};
    }
    const OcclusionBox boxes[] = {far, near};
    Occlusion answers[2] = {};
    ASSERT_EQ(buffer.query(boxes, answers), Status::ok);
    EXPECT_EQ(answers[0], Occlusion::visible) << "of an empty buffer";
    EXPECT_EQ(answers[1], Occlusion::visible);
    // A wall at the largest depth hides the far one; one at the nearest depth that there is hides the near one, too.
    for (const bool nearest : {false, true}) {
      const float z = nearest ? sign * -kFloatMax : sign * kFloatMax;
      const Vertex vertices[] = {{-100, -100, z, 1}, {300, -100, z, 1}, {-100, 300, z, 1}};
      const std::uint32_t indices[] = {0, 1, 2};
      Draw wall;
      wall.vertices = vertices, wall.indices = indices;
      ASSERT_EQ(buffer.draw({&wall, 1}), Status::ok);
      ASSERT_EQ(buffer.depth()[0], z);
      ASSERT_EQ(buffer.query(boxes, answers), Status::ok);
      EXPECT_EQ(answers[0], Occlusion::hidden);
      EXPECT_EQ(answers[1], nearest ? Occlusion::hidden : Occlusion::visible);
    }
  }
}

}  // namespace
}  // namespace surefill
