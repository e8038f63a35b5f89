// SPDX-License-Identifier: Apache-2.0
//
// B4, for every public call of C++ and C: in each floating-point state that a caller may have, the results are those of
// the default state, and the state is the caller's again afterwards: modes, traps and exception flags. What the engine
// calls back, visitors and executors, runs in the caller's state, and keeps the flags that it raises.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace surefill {
namespace {

// A caller's state; `control` is everything but the exception flags.
struct State {
  unsigned control = 0, flags = 0;
  bool operator==(const State&) const = default;
};

#if defined(__SSE2__)

constexpr unsigned kFlags = 0x3F, kTrapsOff = 0x1F80, kFtz = 0x8000, kDaz = 0x40, kRoundingShift = 13;
constexpr unsigned kDivideFlag = 0x04;

// The old coprocessor's rounding goes with it, as fesetround has it.
State now() {
  unsigned short control = 0, status = 0;
  asm volatile("fnstcw %0" : "=m"(control));
  asm volatile("fnstsw %0" : "=m"(status));
  return {(_mm_getcsr() & ~kFlags) | unsigned{control} << 16, (_mm_getcsr() & kFlags) | (status & kFlags) << 8};
}

void set(const State& state) {
  const auto control = static_cast<unsigned short>(state.control >> 16);
  asm volatile("fnclex");
  asm volatile("fldcw %0" : : "m"(control));
  _mm_setcsr((state.control & 0xFFFF) | state.flags);
}

// Rounding, FTZ and DAZ in all combinations, without and with all flags set; then with every exception a trap.
std::vector<State> states() {
  std::vector<State> all, trapping;
  for (unsigned rounding = 0; rounding < 4; ++rounding) {
    for (const unsigned flush : {0u, kFtz, kDaz, kFtz | kDaz}) {
      const unsigned control = rounding << kRoundingShift | flush, coprocessor = (0x37Fu | rounding << 10) << 16;
      all.push_back({coprocessor | kTrapsOff | control, 0});
      all.push_back({coprocessor | kTrapsOff | control, kFlags});
      trapping.push_back({coprocessor | control, 0});
    }
  }
  all.insert(all.end(), trapping.begin(), trapping.end());
  return all;
}

void raise_divide() {
  _mm_setcsr(_mm_getcsr() | kDivideFlag);
}

#else

constexpr unsigned kDivideFlag = FE_DIVBYZERO;

State now() {
  return {static_cast<unsigned>(std::fegetround()), static_cast<unsigned>(std::fetestexcept(FE_ALL_EXCEPT))};
}

void set(const State& state) {
  std::fesetround(static_cast<int>(state.control));
  std::feclearexcept(FE_ALL_EXCEPT);
  std::feraiseexcept(static_cast<int>(state.flags));
}

std::vector<State> states() {
  std::vector<State> all;
  for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    all.push_back({static_cast<unsigned>(rounding), 0});
    all.push_back({static_cast<unsigned>(rounding), FE_ALL_EXCEPT});
  }
  return all;
}

void raise_divide() {
  std::feraiseexcept(FE_DIVBYZERO);
}

#endif

// A call, and the bytes of its results.
struct Call {
  std::string name;
  std::function<void()> run;
  std::function<std::string()> results;
};

template <typename T>
void append(std::string& bytes, std::span<const T> values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// SplitMix64.
class Random {
 public:
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }
  float between(float low, float high) { return low + (high - low) * static_cast<float>(bits() >> 40) * 0x1p-24f; }
  std::size_t below(std::size_t n) { return bits() % n; }

 private:
  std::uint64_t state_ = 15;
};

constexpr int kWidth = 40, kHeight = 130;  // three bands of tiles, for three threads
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

Target sized(int samples) {
  Target target;
  target.width = kWidth, target.height = kHeight, target.samples = samples;
  return target;
}

// Triangles whose images differ where rounding does, where subnormals are lost on the way in (vertices, depths, values)
// or on the way out.
struct Triangles {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<float> values;  // two a vertex
  AttributeArray array;
  std::vector<Draw> draws;

  Triangles() {
    Random random;
    constexpr float kScales[] = {1, 1, 3, 0x1p-120f, 0x1p-130f, 0x1p-135f, 0x1p100f};
    for (int t = 0; t < 60; ++t) {
      const float scale = kScales[random.below(std::size(kScales))];
      const float small = scale < 1 || t % 2 == 0 ? 1 : 0x1p-127f;
      const float x = random.between(-10, kWidth), y = random.between(-10, kHeight);
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const float w = random.below(12) == 0 ? -0.25f : random.between(0.5f, 2);
        vertices.push_back({(x + random.between(0, 40)) * w * scale, (y + random.between(0, 40)) * w * scale,
                            random.between(0, 0.9f) * w * scale * small, w * scale});
        indices.push_back(static_cast<std::uint32_t>(indices.size()));
        values.push_back(random.between(-1, 1));
        values.push_back(random.between(0, 1) * 0x1p-130f);
      }
    }
    array = {values, 2, 0, Interpolation::perspective};
    draws.resize(3);
    for (std::size_t d = 0; d < draws.size(); ++d) {
      draws[d].vertices = vertices, draws[d].indices = std::span(indices).subspan(60 * d, 60);
      draws[d].attributes = {&array, 1};
    }
    draws[1].grid = Grid{8, 3, 5, GridRounding::nearest_even};
    draws[2].depth_mode = DepthMode::clip;
  }
};

const Triangles& triangles() {
  static const Triangles made;
  return made;
}

// An executor that runs the items on this thread and on another one, in reverse.
struct Executing {
  std::vector<State> seen;  // by `run`
  bool disturbed = false;   // a task did not give the state back

  static void run(void* context, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
    auto& own = *static_cast<Executing*>(context);
    own.seen.push_back(now());
    const auto half = [&](std::size_t first) {
      const State before = now();
      for (std::size_t item = items; item-- > first;) {
        if (item % 2 == first) task(argument, item);
      }
      own.disturbed |= now() != before;
    };
    std::thread(half, 1).join();
    half(0);
    raise_divide();
  }
};

struct How {
  std::string name;
  Options options;
};

std::vector<How> ways(Executing& executing) {
  return {{"reference", {.path = Path::reference}},
          {"fast", {}},
          {"fast, 3 threads", {.threads = 3}},
          {"fast, executor", {.threads = 3, .executor = {Executing::run, &executing}}}};
}

// The flags that the caller's code raises on purpose.
unsigned raised_by(const Options& options) {
#if defined(SUREFILL_REFERENCE_ONLY)
  (void)options;
  return 0;
#else
  return options.executor.run != nullptr ? kDivideFlag : 0;
#endif
}

// Each state in turn.
void check(const Call& call, unsigned raised = 0) {
  const State before = now();
  call.run();
  const std::string expected = call.results();
  for (const State& state : states()) {
    set(state);
    call.run();
    const State after = now();
    set(before);
    ASSERT_EQ(after.control, state.control) << call.name;
    ASSERT_EQ(after.flags, state.flags | raised) << call.name << ", control " << std::hex << state.control;
    ASSERT_TRUE(call.results() == expected) << call.name << ", control " << std::hex << state.control;
  }
}

struct Image {
  std::vector<std::uint32_t> count, index;
  std::vector<float> depth, barycentrics, values;
  AttributeTarget attribute;
  Target target;

  explicit Image(int samples) {
    const std::size_t n = kPixels * static_cast<std::size_t>(samples);
    count.resize(n), index.resize(n), depth.resize(n), barycentrics.resize(3 * n), values.resize(2 * n);
    attribute = {values, 2};
    target.width = kWidth, target.height = kHeight, target.samples = samples;
    target.count = count, target.index = index, target.depth = depth, target.barycentrics = barycentrics;
    target.attributes = {&attribute, 1};
  }
  std::string bytes() const {
    std::string all;
    append<std::uint32_t>(all, count);
    append<std::uint32_t>(all, index);
    append<float>(all, depth);
    append<float>(all, barycentrics);
    append<float>(all, values);
    return all;
  }
};

TEST(FloatState, Render) {
  Executing executing;
  for (const How& how : ways(executing)) {
    const Options& options = how.options;
    for (const int samples : {1, 2}) {
      Image image(samples);
      check({"render, " + how.name,
             [&] { ASSERT_EQ(render(image.target, triangles().draws, nullptr, options), Status::ok); },
             [&] { return image.bytes(); }},
            raised_by(options));
      // Most of the image is there, subnormal depths among it.
      EXPECT_GT(std::count_if(image.depth.begin(), image.depth.end(), [](float z) { return z > 0 && z < 0x1p-126f; }),
                20);
    }
  }
  EXPECT_FALSE(executing.disturbed);
}

// The first call of a program tries how the engine was compiled; in its own state, too. CTest runs each test as a
// program.
TEST(FloatState, TheFirstCall) {
  const State before = now();
  const std::vector<State> all = states();
  set(all.back());
  const Status status = OcclusionBuffer().query(std::span<const OcclusionRectangle>(), {});
  const State after = now();
  set(before);
  EXPECT_EQ(status, Status::ok);
  EXPECT_EQ(after, all.back());
}

// What visitors and executors see is the caller's state.
TEST(FloatState, CallersCodeRunsInTheCallersState) {
  Executing executing;
  struct Visits {
    std::mutex mutex;
    std::vector<State> seen;
    std::uint64_t blocks = 0;
  } visits;
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    auto& own = *static_cast<Visits*>(context);
    const State state = now();
    const std::lock_guard lock(own.mutex);
    own.seen.push_back(state), own.blocks += blocks.size();
    raise_divide();
  };
  const std::span<const Draw> draws = triangles().draws;  // made before the state is set
  const State before = now();
  for (const How& how : ways(executing)) {
    const Options& options = how.options;
    for (const State& state : states()) {
      visits.seen.clear(), executing.seen.clear();
      set(state);
      const Status status = visit_coverage(sized(1), draws, {visit, &visits}, nullptr, options);
      const State after = now();
      set(before);
      ASSERT_EQ(status, Status::ok);
      ASSERT_EQ(after.control, state.control) << how.name;
      ASSERT_EQ(after.flags, state.flags | kDivideFlag) << how.name;
      ASSERT_GT(visits.seen.size(), 20u);
      for (const auto* seen : {&visits.seen, &executing.seen}) {
        for (const State& s : *seen) {
          ASSERT_EQ(s.control & 0xFFFF, state.control & 0xFFFF) << how.name;
          ASSERT_EQ(s.flags | kDivideFlag, state.flags | kDivideFlag) << how.name;
        }
      }
    }
  }
  EXPECT_FALSE(executing.disturbed);
#if !defined(SUREFILL_REFERENCE_ONLY)
  EXPECT_FALSE(executing.seen.empty()) << "the executor was not asked";
#endif
}

TEST(FloatState, VisitCoverage) {
  using Block = std::tuple<std::uint32_t, std::uint32_t, int, int, int, std::uint64_t>;
  struct Blocks {
    std::mutex mutex;
    std::vector<Block> all;
  } blocks;
  const auto visit = [](void* context, std::span<const CoverageBlock> list) {
    auto& own = *static_cast<Blocks*>(context);
    const std::lock_guard lock(own.mutex);
    for (const CoverageBlock& b : list) own.all.emplace_back(b.draw, b.triangle, b.x, b.y, b.sample, b.mask);
  };
  for (const How& how :
       std::vector<How>{{"reference", {.path = Path::reference}}, {"fast", {}}, {"fast, 3 threads", {.threads = 3}}}) {
    const Options& options = how.options;
    check({"visit_coverage, " + how.name,
           [&] {
             blocks.all.clear();
             ASSERT_EQ(visit_coverage(sized(2), triangles().draws, {visit, &blocks}, nullptr, options), Status::ok);
           },
           [&] {
             std::sort(blocks.all.begin(), blocks.all.end());
             std::string bytes;
             for (const auto& [draw, triangle, x, y, sample, mask] : blocks.all) {
               const std::uint64_t words[] = {draw,
                                              triangle,
                                              static_cast<std::uint64_t>(x),
                                              static_cast<std::uint64_t>(y),
                                              static_cast<std::uint64_t>(sample),
                                              mask};
               append<std::uint64_t>(bytes, words);
             }
             return bytes;
           }});
  }
}

// Sums that need their rounding, some with subnormal terms or results.
struct Clip {
  Viewport viewport{0.1f, -0.3f, 641.7f, 479.1f, 0x1p-140f, 0.9f, ClipDepth::minus_one_to_one, ClipY::up};
  std::vector<ClipVertex> vertices;

  Clip() {
    Random random;
    for (int i = 0; i < 300; ++i) {
      const float scale = i % 3 == 0 ? 1 : i % 3 == 1 ? 0x1p-130f : 0x1p-148f;
      const auto number = [&] { return random.between(-1, 1) * scale; };
      vertices.push_back({number(), number(), number(), number()});
    }
    vertices.push_back({std::bit_cast<float>(0x7F800001u), 0, 0, 1});  // a signalling NaN
  }
};

TEST(FloatState, ToPixel) {
  const Clip clip;
  std::vector<Vertex> out(clip.vertices.size());
  const auto results = [&] {
    std::string bytes;
    append<Vertex>(bytes, out);
    return bytes;
  };
  check({"to_pixel", [&] { ASSERT_EQ(to_pixel(clip.viewport, clip.vertices, out), Status::ok); }, results});
  for (const std::uint32_t bits : {0x7F800001u, 0x7F800000u}) {
    Viewport bad = clip.viewport;
    bad.far_depth = std::bit_cast<float>(bits);
    check({"to_pixel, refused", [&] { ASSERT_EQ(to_pixel(bad, clip.vertices, out), Status::viewport); }, results});
  }
  surefill_viewport viewport{clip.viewport.x,
                             clip.viewport.y,
                             clip.viewport.width,
                             clip.viewport.height,
                             clip.viewport.near_depth,
                             clip.viewport.far_depth,
                             1,
                             0};
  std::vector<surefill_vertex> in(clip.vertices.size()), c_out(clip.vertices.size());
  std::memcpy(in.data(), clip.vertices.data(), in.size() * sizeof in[0]);
  check({"surefill_to_pixel",
         [&] { ASSERT_EQ(surefill_to_pixel(&viewport, in.data(), in.size(), c_out.data()), SUREFILL_OK); },
         [&] {
           std::string bytes;
           append<surefill_vertex>(bytes, c_out);
           return bytes;
         }});
}

// Boxes and rectangles about what is drawn, with subnormal depths and W, and edges through pixel centres.
struct Questions {
  std::vector<OcclusionBox> boxes;
  std::vector<OcclusionRectangle> rectangles;

  Questions() {
    Random random;
    for (int i = 0; i < 300; ++i) {
      OcclusionBox box;
      const float x = random.between(0, kWidth), y = random.between(0, kHeight), extent = random.between(0, 20);
      const float w = i % 3 == 0 ? 0x1p-130f : 0.7f, z = i % 2 == 0 ? random.between(0, 1) : 0x1p-128f * w;
      for (std::size_t k = 0; k < 8; ++k) {
        box.corners[k] = {(k % 2 == 0 ? x : x + extent) * w, (k / 2 % 2 == 0 ? y : y + extent) * w, z * w, w};
      }
      boxes.push_back(box);
      rectangles.push_back({x, y, x + extent, y + extent, i % 4 == 0 ? 0x1p-149f : i % 4 == 1 ? 0 : z});
    }
    rectangles.push_back({0x1p-149f, 0, 0, 1, 0});  // x0 > x1, but not under DAZ
  }
};

// An occluder whose depth is subnormal hides no box at depth 0.
Draw subnormal_wall() {
  static const Vertex kVertices[] = {{-100, -100, 0x1p-127f, 1}, {900, -100, 0x1p-127f, 1}, {-100, 900, 0x1p-127f, 1}};
  static const std::uint32_t kIndices[] = {0, 1, 2};
  Draw wall;
  wall.vertices = kVertices, wall.indices = kIndices;
  return wall;
}

TEST(FloatState, Occlusion) {
  const Questions questions;
  const Draw wall = subnormal_wall();
  Executing executing;
  for (const How& how : ways(executing)) {
    const Options& options = how.options;
    for (const bool with_wall : {true, false}) {
      std::vector<Occlusion> of_boxes(questions.boxes.size()), of_rectangles(questions.rectangles.size());
      OcclusionBuffer buffer;
      check({"OcclusionBuffer, " + how.name,
             [&] {
               ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
               ASSERT_EQ(buffer.draw(triangles().draws, nullptr, options), Status::ok);
               buffer.clear();
               if (with_wall) {
                 ASSERT_EQ(buffer.draw({&wall, 1}, nullptr, options), Status::ok);
               }
               ASSERT_EQ(buffer.draw(triangles().draws, nullptr, options), Status::ok);
               ASSERT_EQ(buffer.query(questions.boxes, of_boxes), Status::ok);
               ASSERT_EQ(buffer.query(questions.rectangles, of_rectangles), Status::ok);
               OcclusionBuffer other(std::move(buffer));
               buffer = std::move(other);
             },
             [&] {
               std::string bytes;
               append<Occlusion>(bytes, of_boxes);
               append<Occlusion>(bytes, of_rectangles);
               append<float>(bytes, buffer.depth());
               return bytes;
             }},
            raised_by(options));
      EXPECT_GT(std::count(of_boxes.begin(), of_boxes.end(), Occlusion::visible), 20);
      EXPECT_GT(std::count(of_boxes.begin(), of_boxes.end(), Occlusion::hidden), 20);
    }
  }
  EXPECT_FALSE(executing.disturbed);

  OcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
  OcclusionBox box = questions.boxes[0];
  box.corners[7].z = std::bit_cast<float>(0x7F800001u);  // a signalling NaN
  OcclusionRectangle rectangle{0, std::bit_cast<float>(0x7F800001u), 1, 1, 0};
  Occlusion answer = Occlusion::outside;
  check({"query, refused",
         [&] {
           ASSERT_EQ(buffer.query({&box, 1}, {&answer, 1}), Status::query_boxes);
           ASSERT_EQ(buffer.query({&rectangle, 1}, {&answer, 1}), Status::query_boxes);
         },
         [] { return std::string(); }});
}

// The occluder of depth 2^-127 and the box at depth 0, with words.
TEST(FloatState, NothingVisibleIsHiddenUnderFtz) {
  const State before = now();
  const Draw wall = subnormal_wall();
  const OcclusionRectangle rectangle{8, 8, 30, 100, 0};
  for (const State& state : states()) {
    for (const Path path : {Path::automatic, Path::reference}) {
      OcclusionBuffer buffer;
      Occlusion answer = Occlusion::outside;
      set(state);
      const bool ok = buffer.resize(kWidth, kHeight) == Status::ok &&
                      buffer.draw({&wall, 1}, nullptr, {.path = path}) == Status::ok &&
                      buffer.query({&rectangle, 1}, {&answer, 1}) == Status::ok;
      set(before);
      ASSERT_TRUE(ok);
      ASSERT_EQ(answer, Occlusion::visible) << std::hex << state.control;
    }
  }
}

TEST(FloatState, TheC) {
  const Triangles& from = triangles();
  const Questions questions;
  std::vector<surefill_draw> draws(from.draws.size());
  const surefill_attribute_array array{from.values.data(), from.values.size(), 2, 0, SUREFILL_PERSPECTIVE};
  const surefill_grid grid{8, 3, 5, SUREFILL_NEAREST_EVEN};
  for (std::size_t d = 0; d < draws.size(); ++d) {
    draws[d] = {};
    draws[d].struct_size = sizeof draws[d];
    draws[d].vertices = reinterpret_cast<const surefill_vertex*>(from.vertices.data());
    draws[d].vertex_count = from.vertices.size();
    draws[d].indices = from.draws[d].indices.data(), draws[d].index_count = from.draws[d].indices.size();
    draws[d].attributes = &array, draws[d].attribute_count = 1;
  }
  // The first one's vertices are copied.
  std::vector<std::array<float, 5>> strided(from.vertices.size());
  for (std::size_t v = 0; v < strided.size(); ++v) std::memcpy(strided[v].data(), &from.vertices[v], sizeof(Vertex));
  draws[0].vertices = reinterpret_cast<const surefill_vertex*>(strided.data()), draws[0].vertex_stride = 20;
  draws[1].grid = &grid;
  draws[2].depth_mode = SUREFILL_DEPTH_CLIP;
  Image image(1);
  surefill_attribute_target attribute{image.values.data(), image.values.size(), 2, 0};
  surefill_target target{};
  target.struct_size = sizeof target;
  target.width = kWidth, target.height = kHeight, target.samples = 1;
  target.count = image.count.data(), target.count_count = kPixels;
  target.index = image.index.data(), target.index_count = kPixels;
  target.depth = image.depth.data(), target.depth_count = kPixels;
  target.barycentrics = image.barycentrics.data(), target.barycentrics_count = 3 * kPixels;
  target.attributes = &attribute, target.attribute_count = 1;
  for (const std::uint32_t path : {SUREFILL_PATH_AUTOMATIC, SUREFILL_PATH_REFERENCE}) {
    for (const int threads : {1, 3}) {
      const surefill_options options{sizeof options, threads, path, nullptr, nullptr, nullptr};
      surefill_statistics statistics{};
      statistics.struct_size = sizeof statistics;
      check({"surefill_render",
             [&] {
               ASSERT_EQ(surefill_validate(&target, draws.data(), draws.size()), SUREFILL_OK);
               ASSERT_EQ(surefill_render(&target, draws.data(), draws.size(), &options, &statistics), SUREFILL_OK);
             },
             [&] { return image.bytes(); }});
      Image expected(1);
      ASSERT_EQ(render(expected.target, from.draws), Status::ok);
      EXPECT_TRUE(image.bytes() == expected.bytes());

      std::vector<std::uint8_t> answers(2 * questions.boxes.size() + 1);
      std::vector<float> depth(kPixels);
      check({"surefill_occlusion",
             [&] {
               surefill_occlusion* occlusion = nullptr;
               ASSERT_EQ(surefill_occlusion_create(kWidth, kHeight, SUREFILL_LESS, &occlusion), SUREFILL_OK);
               surefill_occlusion_clear(occlusion);
               ASSERT_EQ(surefill_occlusion_draw(occlusion, draws.data(), draws.size(), &options, &statistics),
                         SUREFILL_OK);
               const std::size_t n = questions.boxes.size();
               ASSERT_EQ(
                   surefill_occlusion_query_boxes(
                       occlusion, reinterpret_cast<const surefill_box*>(questions.boxes.data()), n, answers.data()),
                   SUREFILL_OK);
               ASSERT_EQ(surefill_occlusion_query_rectangles(
                             occlusion, reinterpret_cast<const surefill_rectangle*>(questions.rectangles.data()), n + 1,
                             answers.data() + n),
                         SUREFILL_OK);
               std::memcpy(depth.data(), surefill_occlusion_depth(occlusion), kPixels * sizeof(float));
               surefill_occlusion_destroy(occlusion);
             },
             [&] {
               std::string bytes;
               append<std::uint8_t>(bytes, answers);
               append<float>(bytes, depth);
               return bytes;
             }});
    }
  }
}

// The calls that compute nothing leave the state alone, too.
TEST(FloatState, TheRest) {
  const Image image(1);
  surefill_target c{};
  c.struct_size = sizeof c, c.width = kWidth, c.height = kHeight, c.samples = 2;
  check({"validate and the like",
         [&] {
           ASSERT_EQ(validate(image.target, triangles().draws), Status::ok);
           ASSERT_EQ(sample_total(image.target), kPixels);
           ASSERT_EQ(surefill_sample_total(&c), 2 * kPixels);
           ASSERT_EQ(sample_location(4, 3).x, 10);
           std::int32_t x, y;
           surefill_sample_location(4, 3, &x, &y);
           ASSERT_EQ(x, 10);
           ASSERT_STREQ(status_text(Status::ok), surefill_status_text(SUREFILL_OK));
           ASSERT_NE(surefill_version(), nullptr);
         },
         [] { return std::string(); }});
}

}  // namespace
}  // namespace surefill
