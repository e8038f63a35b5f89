// SPDX-License-Identifier: Apache-2.0
//
// B2: an output that shares a byte with anything that the call reads, or with another output, is refused with
// target_overlap, and nothing is written; what only touches is not. Every output against every list, buffer and struct,
// in C++ and in C. Exhaustive over these pairs, each in four positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "surefill/diagnostics.hpp"
#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace surefill {
namespace {

constexpr int kSide = 8;
constexpr std::size_t kSamples = kSide * kSide;

constexpr Vertex kVertices[] = {{0, 0, 0.5f, 1}, {9, 0, 0.5f, 1}, {0, 9, 0.5f, 1}, {9, 9, 0.5f, 1}};
constexpr std::uint32_t kIndices[] = {0, 1, 2, 1, 3, 2, 0, 1, 3, 0, 3, 2};
constexpr std::uint32_t kIdentifiers[] = {4, 3, 2, 1};
constexpr SampleLocation kLocations[] = {{5, 9}};
constexpr float kValues[8] = {1, 2, 3, 4, 5, 6, 7, 8};

// Places an input and an output in one piece of memory: the output begins `shift` bytes from the input.
class Arena {
 public:
  Arena() : memory_(kSize), before_(kSize) { std::fill(memory_.begin(), memory_.end(), std::byte{0x2A}); }
  std::byte* at(std::ptrdiff_t shift) { return memory_.data() + kMiddle + shift; }
  void begin() { before_ = memory_; }
  bool changed() const { return memory_ != before_; }

 private:
  static constexpr std::size_t kSize = 1 << 14, kMiddle = kSize / 2;
  std::vector<std::byte> memory_, before_;
};

struct Position {
  const char* name;
  std::ptrdiff_t shift;
  bool overlaps;
};

// An output of this many bytes about an input of that many.
std::vector<Position> positions(std::size_t output, std::size_t input) {
  const auto out = static_cast<std::ptrdiff_t>(output), in = static_cast<std::ptrdiff_t>(input);
  return {{"ends where the input begins", -out, false},
          {"ends 8 bytes within", 8 - out, true},
          {"begins where the input does", 0, true},
          {"begins 8 bytes before its end", in - 8, true},
          {"begins where it ends", in, false}};
}

template <typename T>
T* moved(std::byte* to, std::span<const T> from) {
  std::memcpy(static_cast<void*>(to), from.data(), from.size_bytes());
  return reinterpret_cast<T*>(to);
}

// A call in C++ whose memory is its own but for what is moved.
struct Call {
  std::vector<std::uint32_t> count = std::vector<std::uint32_t>(kSamples), index = count;
  std::vector<float> depth = std::vector<float>(kSamples), initial = std::vector<float>(kSamples, 1.0f);
  std::vector<float> barycentrics = std::vector<float>(3 * kSamples), first = std::vector<float>(kSamples),
                     second = std::vector<float>(2 * kSamples);
  std::vector<std::int32_t> winding = std::vector<std::int32_t>(kSamples);
  std::uint64_t covered[4] = {}, visible[4] = {};
  AttributeTarget attribute_targets[2] = {{first, 1}, {second, 2}};
  AttributeArray arrays[2] = {{std::span(kValues, 4), 1, 0, Interpolation::perspective},
                              {kValues, 2, 0, Interpolation::flat}};
  Draw draws[3];
  Target target;
  Options options;
  Statistics statistics;
  Target* used_target = &target;
  Options* used_options = &options;
  Statistics* used_statistics = &statistics;
  std::span<const Draw> used_draws = draws;

  Call() {
    for (Draw& draw : draws) {
      draw.vertices = kVertices, draw.indices = kIndices, draw.identifiers = kIdentifiers, draw.attributes = arrays;
    }
    target.width = target.height = kSide;
    target.count = count, target.index = index, target.depth = depth, target.barycentrics = barycentrics;
    target.attributes = attribute_targets, target.initial_depth = initial;
    target.winding = winding, target.sample_locations = kLocations;
    draws[1].covered = covered, draws[2].visible = visible;
  }
};

// Something that a call reads or writes, which can be moved. An input takes its values along.
template <typename C>
struct Movable {
  const char* name;
  std::size_t size;
  void (*move)(C&, std::byte*);
};

template <typename T>
std::span<T> moved_span(std::span<T> from, std::byte* to) {
  return {reinterpret_cast<T*>(to), from.size()};
}

const Movable<Call> kOutputs[] = {
    {"count", 4 * kSamples, [](Call& c, std::byte* to) { c.target.count = moved_span(c.target.count, to); }},
    {"index", 4 * kSamples, [](Call& c, std::byte* to) { c.target.index = moved_span(c.target.index, to); }},
    {"depth", 4 * kSamples, [](Call& c, std::byte* to) { c.target.depth = moved_span(c.target.depth, to); }},
    {"barycentrics", 12 * kSamples,
     [](Call& c, std::byte* to) { c.target.barycentrics = moved_span(c.target.barycentrics, to); }},
    {"attribute 0", 4 * kSamples,
     [](Call& c, std::byte* to) { c.attribute_targets[0].values = moved_span(c.attribute_targets[0].values, to); }},
    {"attribute 1", 8 * kSamples,
     [](Call& c, std::byte* to) { c.attribute_targets[1].values = moved_span(c.attribute_targets[1].values, to); }},
    {"winding", 4 * kSamples, [](Call& c, std::byte* to) { c.target.winding = moved_span(c.target.winding, to); }},
    {"covered", sizeof(Call::covered),
     [](Call& c, std::byte* to) { c.draws[1].covered = moved_span(c.draws[1].covered, to); }},
    {"visible", sizeof(Call::visible),
     [](Call& c, std::byte* to) { c.draws[2].visible = moved_span(c.draws[2].visible, to); }},
    {"statistics", sizeof(Statistics),
     [](Call& c, std::byte* to) { c.used_statistics = reinterpret_cast<Statistics*>(to); }},
    {"diagnostics", sizeof(Diagnostics),
     [](Call& c, std::byte* to) { c.options.diagnostics = reinterpret_cast<Diagnostics*>(to); }},
};

const Movable<Call> kInputs[] = {
    {"draws", sizeof(Call::draws),
     [](Call& c, std::byte* to) {
       c.used_draws = {moved<Draw>(to, c.draws), std::size(c.draws)};
     }},
    {"attribute arrays of the first draw", sizeof(Call::arrays),
     [](Call& c, std::byte* to) {
       c.draws[0].attributes = {moved<AttributeArray>(to, c.arrays), 2};
     }},
    {"attribute arrays of the last draw", sizeof(Call::arrays),
     [](Call& c, std::byte* to) {
       c.draws[2].attributes = {moved<AttributeArray>(to, c.arrays), 2};
     }},
    {"the target's attributes", sizeof(Call::attribute_targets),
     [](Call& c, std::byte* to) {
       c.target.attributes = {moved<AttributeTarget>(to, c.attribute_targets), 2};
     }},
    {"the target", sizeof(Target),
     [](Call& c, std::byte* to) { c.used_target = moved<Target>(to, std::span<const Target>(&c.target, 1)); }},
    {"the options", sizeof(Options),
     [](Call& c, std::byte* to) { c.used_options = moved<Options>(to, std::span<const Options>(&c.options, 1)); }},
    {"initial depth", 4 * kSamples,
     [](Call& c, std::byte* to) {
       c.target.initial_depth = {moved<float>(to, c.initial), kSamples};
     }},
    {"vertices of the first draw", sizeof kVertices,
     [](Call& c, std::byte* to) {
       c.draws[0].vertices = {moved<Vertex>(to, kVertices), 4};
     }},
    {"vertices of the last draw", sizeof kVertices,
     [](Call& c, std::byte* to) {
       c.draws[2].vertices = {moved<Vertex>(to, kVertices), 4};
     }},
    {"indices", sizeof kIndices,
     [](Call& c, std::byte* to) {
       c.draws[1].indices = {moved<std::uint32_t>(to, kIndices), 12};
     }},
    {"identifiers", sizeof kIdentifiers,
     [](Call& c, std::byte* to) {
       c.draws[1].identifiers = {moved<std::uint32_t>(to, kIdentifiers), 4};
     }},
    {"values", sizeof kValues,
     [](Call& c, std::byte* to) {
       c.arrays[1].values = {moved<float>(to, kValues), 8};
     }},
    {"sample locations", sizeof kLocations,
     [](Call& c, std::byte* to) {
       c.target.sample_locations = {moved<SampleLocation>(to, kLocations), 1};
     }},
};

// Options are the call's, not the frame's: validate sees them as little as it sees statistics.
TEST(Overlap, OutputsAndInputs) {
  int refused = 0, accepted = 0;
  for (const auto& output : kOutputs) {
    for (const auto& input : kInputs) {
      for (const auto& [name, shift, overlaps] : positions(output.size, input.size)) {
        for (const Path path : {Path::automatic, Path::reference}) {
          const std::string what = std::string(output.name) + ", " + input.name + ": " + name;
          Call call;
          Arena arena;
          call.options.path = path;
          // The output first, into what the list then holds.
          output.move(call, arena.at(shift));
          input.move(call, arena.at(0));
          arena.begin();
          const bool same = std::string(output.name) == "depth" && std::string(input.name) == "initial depth" &&
                            shift == 0;  // which is allowed
          const Status expected = overlaps && !same ? Status::target_overlap : Status::ok;
          const bool of_frame = std::string(output.name) != "statistics" && std::string(output.name) != "diagnostics" &&
                                std::string(input.name) != "the options";
          ASSERT_EQ(validate(*call.used_target, call.used_draws), of_frame ? expected : Status::ok) << what;
          ASSERT_FALSE(arena.changed()) << what;
          ASSERT_EQ(render(*call.used_target, call.used_draws, call.used_statistics, *call.used_options), expected)
              << what;
          ASSERT_EQ(arena.changed(), expected == Status::ok) << what;
          ++(expected == Status::ok ? accepted : refused);
        }
      }
    }
  }
  const int pairs = static_cast<int>(std::size(kOutputs) * std::size(kInputs));
  EXPECT_EQ(refused, 2 * (pairs * 3 - 1));
  EXPECT_EQ(accepted, 2 * (pairs * 2 + 1));
}

TEST(Overlap, OutputsAndOutputs) {
  for (const auto& one : kOutputs) {
    for (const auto& other : kOutputs) {
      if (&one == &other) continue;
      for (const auto& [name, shift, overlaps] : positions(one.size, other.size)) {
        Call call;
        Arena arena;
        one.move(call, arena.at(shift)), other.move(call, arena.at(0));
        arena.begin();
        ASSERT_EQ(render(*call.used_target, call.used_draws, call.used_statistics, *call.used_options),
                  overlaps ? Status::target_overlap : Status::ok)
            << one.name << ", " << other.name << ": " << name;
        ASSERT_EQ(arena.changed(), !overlaps);
      }
    }
  }
}

// Outputs that are not asked for overlap nothing, wherever they point.
TEST(Overlap, EmptyOutputs) {
  Call call;
  call.target.count = {reinterpret_cast<std::uint32_t*>(call.draws), 0};
  call.target.index = {reinterpret_cast<std::uint32_t*>(&call.target), 0};
  EXPECT_EQ(render(call.target, call.draws, &call.statistics), Status::ok);
  // Nor does initial depth become the depth buffer because an empty one points there.
  call.target.depth = {call.initial.data(), 0};
  call.target.barycentrics = {}, call.target.attributes = {};
  call.target.count = {reinterpret_cast<std::uint32_t*>(call.initial.data()), kSamples};
  EXPECT_EQ(render(call.target, call.draws), Status::target_overlap);
}

TEST(Overlap, Context) {
  Call call;
  Context* const context = new (call.barycentrics.data() + 2) Context;
  call.options.context = context;
  EXPECT_EQ(render(call.target, call.draws, &call.statistics, call.options), Status::target_overlap);
  context->~Context();
}

TEST(Overlap, VisitCoverage) {
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    *static_cast<std::size_t*>(context) += blocks.size();
  };
  std::size_t blocks = 0;
  Call call;
  Target size;
  size.width = size.height = kSide;
  alignas(Draw) std::array<std::byte, sizeof(Draw) + sizeof(Statistics)> memory{};
  const Draw* draw = moved<Draw>(memory.data(), std::span<const Draw>(call.draws, 1));
  for (const auto& [at, expected] : {std::pair{std::size_t{8}, Status::target_overlap}, {sizeof(Draw), Status::ok}}) {
    auto* statistics = reinterpret_cast<Statistics*>(memory.data() + at);
    EXPECT_EQ(visit_coverage(size, {draw, 1}, {visit, &blocks}, statistics), expected);
    EXPECT_EQ(blocks != 0, expected == Status::ok);
  }
}

TEST(Overlap, ToPixel) {
  alignas(16) std::array<std::byte, 512> memory{}, before;
  Viewport* viewport = new (memory.data()) Viewport{0, 0, 8, 8, 0, 1, ClipDepth::zero_to_one, ClipY::up};
  auto* vertices = reinterpret_cast<ClipVertex*>(memory.data() + 64);
  auto* c_viewport = new (memory.data() + 256) surefill_viewport{0, 0, 8, 8, 0, 1, 0, 0};
  for (int i = 0; i < 4; ++i) vertices[i] = {0, 0, 0, 1};
  before = memory;
  const auto out = [&](std::size_t at) { return reinterpret_cast<Vertex*>(memory.data() + at); };
  for (const std::size_t at : {0u, 16u, 64u, 16u + 64u, 112u}) {
    EXPECT_EQ(to_pixel(*viewport, {vertices, 4}, {out(at), 4}), Status::to_pixel_vertices) << at;
    EXPECT_EQ(memory, before);
  }
  const auto c = [](void* p) { return static_cast<surefill_vertex*>(p); };
  for (const std::size_t at : {64u, 16u + 64u, 112u, 256u - 48u, 256u, 272u}) {
    EXPECT_EQ(surefill_to_pixel(c_viewport, c(vertices), 4, c(out(at))), SUREFILL_TO_PIXEL_VERTICES) << at;
    EXPECT_EQ(memory, before);
  }
  EXPECT_EQ(to_pixel(*viewport, {vertices, 4}, {out(128), 4}), Status::ok);
  EXPECT_EQ(surefill_to_pixel(c_viewport, c(vertices), 4, c(out(128))), SUREFILL_OK);
  EXPECT_EQ(surefill_to_pixel(c_viewport, c(vertices), 4, c(out(288))), SUREFILL_OK);
}

TEST(Overlap, OcclusionQueries) {
  OcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(40, 40), Status::ok);
  struct {
    OcclusionBox boxes[2];
    OcclusionRectangle rectangles[2];
    Occlusion answers[2];
  } memory{}, before = memory;
  const auto answers = [](auto* at, std::size_t shift) {
    return std::span(reinterpret_cast<Occlusion*>(at) + shift, 2);
  };
  for (const std::size_t shift : {std::size_t{0}, sizeof memory.boxes - 1}) {
    EXPECT_EQ(buffer.query(memory.boxes, answers(memory.boxes, shift)), Status::target_overlap);
  }
  for (const std::size_t shift : {std::size_t{0}, sizeof memory.rectangles - 1}) {
    EXPECT_EQ(buffer.query(memory.rectangles, answers(memory.rectangles, shift)), Status::target_overlap);
  }
  auto* depth = const_cast<float*>(buffer.depth().data());
  EXPECT_EQ(buffer.query(memory.boxes, answers(depth, 4 * 40 * 40 - 2)), Status::target_overlap);
  EXPECT_EQ(std::memcmp(&memory, &before, sizeof memory), 0);
  EXPECT_EQ(depth[40 * 40 - 1], depth[0]);
  EXPECT_EQ(buffer.query(memory.rectangles, answers(memory.answers, 0)), Status::ok);
}

// What the buffer's draws read may not lie in its depth.
TEST(Overlap, OcclusionDraws) {
  for (const auto& input : kInputs) {
    const std::string name = input.name;
    if (name.starts_with("the target") || name == "initial depth" || name == "the options") continue;
    if (name == "sample locations") continue;  // the target's
    OcclusionBuffer buffer;
    ASSERT_EQ(buffer.resize(40, 40), Status::ok);
    auto* depth = reinterpret_cast<std::byte*>(const_cast<float*>(buffer.depth().data()));
    for (const std::size_t at : {std::size_t{0}, (4 * 40 * 40 - input.size) / 8 * 8}) {
      buffer.clear();
      Call call;
      input.move(call, depth + at);
      const std::vector<std::byte> before(depth, depth + 4 * 40 * 40);
      EXPECT_EQ(buffer.draw(call.used_draws), Status::target_overlap) << name;
      EXPECT_TRUE(std::equal(before.begin(), before.end(), depth)) << name;
    }
    buffer.clear();
    auto* statistics = reinterpret_cast<Statistics*>(depth);
    Call call;
    EXPECT_EQ(buffer.draw(call.used_draws, statistics), Status::target_overlap);
  }
}

// ---- C

struct CCall {
  std::vector<std::uint32_t> count = std::vector<std::uint32_t>(kSamples), index = count;
  std::vector<float> depth = std::vector<float>(kSamples), initial = std::vector<float>(kSamples, 1.0f);
  std::vector<float> barycentrics = std::vector<float>(3 * kSamples), first = std::vector<float>(kSamples),
                     second = std::vector<float>(2 * kSamples);
  std::vector<std::int32_t> winding = std::vector<std::int32_t>(kSamples);
  std::uint64_t covered[4] = {}, visible[4] = {};
  std::array<float, 5 * 4> strided{};  // four vertices, 20 bytes apart
  surefill_attribute_target attribute_targets[2] = {{first.data(), kSamples, 1, 0},
                                                    {second.data(), 2 * kSamples, 2, 0}};
  surefill_attribute_array arrays[2] = {{kValues, 4, 1, 0, SUREFILL_PERSPECTIVE}, {kValues, 8, 2, 0, SUREFILL_FLAT}};
  surefill_scissor scissor{0, 0, kSide, kSide};
  surefill_grid grid{8, 0, 0, SUREFILL_NEAREST_EVEN};
  surefill_place location{5, 9};
  surefill_vertex box[8] = {};
  surefill_draw draws[3] = {};
  surefill_target target{};
  surefill_options options{};
  surefill_statistics statistics{};
  surefill_target* used_target = &target;
  surefill_options* used_options = &options;
  surefill_statistics* used_statistics = &statistics;
  const surefill_draw* used_draws = draws;

  CCall() {
    for (std::size_t v = 0; v < 4; ++v) std::memcpy(&strided[5 * v], &kVertices[v], sizeof(Vertex));
    for (surefill_draw& draw : draws) {
      draw.struct_size = sizeof draw;
      draw.vertices = reinterpret_cast<const surefill_vertex*>(strided.data());
      draw.vertex_count = 4, draw.vertex_stride = 20;
      draw.indices = kIndices, draw.index_count = 12;
      draw.identifiers = kIdentifiers, draw.identifier_count = 4;
      draw.attributes = arrays, draw.attribute_count = 2;
      draw.scissor = &scissor, draw.grid = &grid, draw.culling_box = nullptr;
    }
    for (std::size_t i = 0; i < 8; ++i) box[i] = {i % 2 == 0 ? 0.0f : 9.0f, i / 2 % 2 == 0 ? 0.0f : 9.0f, 0.5f, 1};
    target.struct_size = sizeof target;
    target.width = target.height = kSide, target.samples = 1;
    target.count = count.data(), target.count_count = kSamples;
    target.index = index.data(), target.index_count = kSamples;
    target.depth = depth.data(), target.depth_count = kSamples;
    target.barycentrics = barycentrics.data(), target.barycentrics_count = 3 * kSamples;
    target.attributes = attribute_targets, target.attribute_count = 2;
    target.initial_depth = initial.data(), target.initial_depth_count = kSamples;
    target.winding = winding.data(), target.winding_count = kSamples;
    target.sample_locations = &location, target.sample_location_count = 1;
    draws[1].covered = covered, draws[1].covered_count = 4;
    draws[2].visible = visible, draws[2].visible_count = 4;
    options.struct_size = sizeof options;
    statistics.struct_size = sizeof statistics;
  }
};

template <typename T>
T* as(std::byte* to) {
  return reinterpret_cast<T*>(to);
}

const Movable<CCall> kCOutputs[] = {
    {"count", 4 * kSamples, [](CCall& c, std::byte* to) { c.target.count = as<std::uint32_t>(to); }},
    {"index", 4 * kSamples, [](CCall& c, std::byte* to) { c.target.index = as<std::uint32_t>(to); }},
    {"depth", 4 * kSamples, [](CCall& c, std::byte* to) { c.target.depth = as<float>(to); }},
    {"barycentrics", 12 * kSamples, [](CCall& c, std::byte* to) { c.target.barycentrics = as<float>(to); }},
    {"attribute 0", 4 * kSamples, [](CCall& c, std::byte* to) { c.attribute_targets[0].values = as<float>(to); }},
    {"attribute 1", 8 * kSamples, [](CCall& c, std::byte* to) { c.attribute_targets[1].values = as<float>(to); }},
    {"winding", 4 * kSamples, [](CCall& c, std::byte* to) { c.target.winding = as<std::int32_t>(to); }},
    {"covered", sizeof(CCall::covered), [](CCall& c, std::byte* to) { c.draws[1].covered = as<std::uint64_t>(to); }},
    {"visible", sizeof(CCall::visible), [](CCall& c, std::byte* to) { c.draws[2].visible = as<std::uint64_t>(to); }},
    {"statistics", sizeof(surefill_statistics),
     [](CCall& c, std::byte* to) {
       c.used_statistics = moved<surefill_statistics>(to, std::span<const surefill_statistics>(&c.statistics, 1));
     }},
};

template <std::size_t kDraw>
void move_vertices(CCall& c, std::byte* to) {
  c.draws[kDraw].vertices = reinterpret_cast<const surefill_vertex*>(moved<float>(to, c.strided));
}
// The last vertex has no fifth number.
constexpr std::size_t kStridedBytes = 3 * 20 + 16;

const Movable<CCall> kCInputs[] = {
    {"draws", sizeof(CCall::draws), [](CCall& c, std::byte* to) { c.used_draws = moved<surefill_draw>(to, c.draws); }},
    {"attribute arrays of the first draw", sizeof(CCall::arrays),
     [](CCall& c, std::byte* to) { c.draws[0].attributes = moved<surefill_attribute_array>(to, c.arrays); }},
    {"attribute arrays of the last draw", sizeof(CCall::arrays),
     [](CCall& c, std::byte* to) { c.draws[2].attributes = moved<surefill_attribute_array>(to, c.arrays); }},
    {"the target's attributes", sizeof(CCall::attribute_targets),
     [](CCall& c, std::byte* to) { c.target.attributes = moved<surefill_attribute_target>(to, c.attribute_targets); }},
    {"the target", sizeof(surefill_target),
     [](CCall& c, std::byte* to) {
       c.used_target = moved<surefill_target>(to, std::span<const surefill_target>(&c.target, 1));
     }},
    {"the options", sizeof(surefill_options),
     [](CCall& c, std::byte* to) {
       c.used_options = moved<surefill_options>(to, std::span<const surefill_options>(&c.options, 1));
     }},
    {"initial depth", 4 * kSamples,
     [](CCall& c, std::byte* to) { c.target.initial_depth = moved<float>(to, c.initial); }},
    {"strided vertices of the first draw", kStridedBytes, move_vertices<0>},
    {"strided vertices of the second draw", kStridedBytes, move_vertices<1>},
    {"strided vertices of the last draw", kStridedBytes, move_vertices<2>},
    {"dense vertices", sizeof kVertices,
     [](CCall& c, std::byte* to) {
       moved<Vertex>(to, kVertices);
       c.draws[1].vertices = as<surefill_vertex>(to), c.draws[1].vertex_stride = 0;
     }},
    {"indices", sizeof kIndices,
     [](CCall& c, std::byte* to) { c.draws[1].indices = moved<std::uint32_t>(to, kIndices); }},
    {"identifiers", sizeof kIdentifiers,
     [](CCall& c, std::byte* to) { c.draws[1].identifiers = moved<std::uint32_t>(to, kIdentifiers); }},
    {"values", sizeof kValues, [](CCall& c, std::byte* to) { c.arrays[1].values = moved<float>(to, kValues); }},
    {"scissor", sizeof(surefill_scissor),
     [](CCall& c, std::byte* to) {
       c.draws[1].scissor = moved<surefill_scissor>(to, std::span<const surefill_scissor>(&c.scissor, 1));
     }},
    {"grid", sizeof(surefill_grid),
     [](CCall& c, std::byte* to) {
       c.draws[1].grid = moved<surefill_grid>(to, std::span<const surefill_grid>(&c.grid, 1));
     }},
    {"culling box", sizeof(CCall::box),
     [](CCall& c, std::byte* to) { c.draws[1].culling_box = moved<surefill_vertex>(to, c.box); }},
    {"sample locations", sizeof(surefill_place),
     [](CCall& c, std::byte* to) {
       c.target.sample_locations = moved<surefill_place>(to, std::span<const surefill_place>(&c.location, 1));
     }},
};

// Inputs count up to the next multiple of 8 bytes, where an output can begin: the overlap is of 4 bytes at least.
TEST(Overlap, OutputsAndInputsInC) {
  for (const auto& output : kCOutputs) {
    for (const auto& input : kCInputs) {
      for (const auto& [name, shift, overlaps] : positions(output.size, (input.size + 7) / 8 * 8)) {
        for (const std::uint32_t path : {SUREFILL_PATH_AUTOMATIC, SUREFILL_PATH_REFERENCE}) {
          const std::string what = std::string(output.name) + ", " + input.name + ": " + name;
          CCall call;
          Arena arena;
          call.options.path = path;
          output.move(call, arena.at(shift));
          input.move(call, arena.at(0));
          // Lists that overlap the statistics hold what lay in them last: the statistics' size must be right.
          std::size_t size = 0;
          std::memcpy(&size, call.used_statistics, sizeof size);
          const bool readable = size == sizeof(surefill_statistics);
          arena.begin();
          const bool same = std::string(output.name) == "depth" && std::string(input.name) == "initial depth" &&
                            shift == 0;  // which is allowed
          const bool of_frame = std::string(output.name) != "statistics" && std::string(input.name) != "the options";
          const surefill_status expected = overlaps && !same ? SUREFILL_TARGET_OVERLAP : SUREFILL_OK;
          ASSERT_EQ(surefill_validate(call.used_target, call.used_draws, 3), of_frame ? expected : SUREFILL_OK) << what;
          const surefill_status status =
              surefill_render(call.used_target, call.used_draws, 3, call.used_options, call.used_statistics);
          ASSERT_EQ(status, readable ? expected : SUREFILL_STATISTICS_STRUCT_SIZE) << what;
          ASSERT_EQ(arena.changed(), status == SUREFILL_OK) << what;
        }
      }
    }
  }
}

TEST(Overlap, OutputsAndOutputsInC) {
  for (const auto& one : kCOutputs) {
    for (const auto& other : kCOutputs) {
      if (&one == &other) continue;
      for (const auto& [name, shift, overlaps] : positions(one.size, other.size)) {
        CCall call;
        Arena arena;
        one.move(call, arena.at(shift)), other.move(call, arena.at(0));
        arena.begin();
        ASSERT_EQ(surefill_render(call.used_target, call.used_draws, 3, call.used_options, call.used_statistics),
                  overlaps ? SUREFILL_TARGET_OVERLAP : SUREFILL_OK)
            << one.name << ", " << other.name << ": " << name;
        ASSERT_EQ(arena.changed(), !overlaps);
      }
    }
  }
}

TEST(Overlap, OcclusionDrawsInC) {
  for (const auto& input : kCInputs) {
    const std::string name = input.name;
    if (name.starts_with("the target") || name == "initial depth" || name == "the options") continue;
    if (name == "sample locations") continue;  // the target's
    surefill_occlusion* occlusion = nullptr;
    ASSERT_EQ(surefill_occlusion_create(40, 40, SUREFILL_LESS, &occlusion), SUREFILL_OK);
    auto* depth = reinterpret_cast<std::byte*>(const_cast<float*>(surefill_occlusion_depth(occlusion)));
    for (const std::size_t at : {std::size_t{0}, (4 * 40 * 40 - input.size) / 8 * 8}) {
      surefill_occlusion_clear(occlusion);
      CCall call;
      input.move(call, depth + at);
      const std::vector<std::byte> before(depth, depth + 4 * 40 * 40);
      EXPECT_EQ(surefill_occlusion_draw(occlusion, call.used_draws, 3, nullptr, nullptr), SUREFILL_TARGET_OVERLAP)
          << name;
      EXPECT_TRUE(std::equal(before.begin(), before.end(), depth)) << name;
    }
    surefill_occlusion_clear(occlusion);
    CCall call;
    std::memcpy(depth, &call.statistics, sizeof call.statistics);
    EXPECT_EQ(surefill_occlusion_draw(occlusion, call.draws, 3, nullptr, as<surefill_statistics>(depth)),
              SUREFILL_TARGET_OVERLAP);
    surefill_occlusion_destroy(occlusion);
  }
}

}  // namespace
}  // namespace surefill
