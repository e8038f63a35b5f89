// SPDX-License-Identifier: Apache-2.0
//
// Memory that cannot be had: every public call of C++ and C, with its n-th allocation failing, for each n, alone or
// with all after it. The status is out_of_memory, nothing is written (though of a frame's buffers the header does not
// promise it) and nothing is leaked, and an occlusion buffer is as its header says; or the call does without (a thread
// that does not start) and gives the right answer. A program of its own, because it replaces operator new and, by the
// linker's --wrap, malloc and its like.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace {

// ---- the memory

constexpr int kNever = std::numeric_limits<int>::max();
std::atomic<bool> watching{false};
std::atomic<int> calls{0};
int first_failing = kNever;  // from 1
bool later_fail = false;     // those after it, too

// What was allocated while watching and is not freed.
std::array<std::atomic<void*>, 1024> live{};

bool fails() {
  if (!watching.load()) return false;
  const int call = ++calls;
  return later_fail ? call >= first_failing : call == first_failing;
}

void* noted(void* p) {
  if (p == nullptr || !watching.load()) return p;
  for (std::atomic<void*>& place : live) {
    void* empty = nullptr;
    if (place.compare_exchange_strong(empty, p)) return p;
  }
  std::abort();  // the table is too small
}

void forget(void* p) {
  if (p == nullptr) return;
  for (std::atomic<void*>& place : live) {
    void* own = p;
    if (place.compare_exchange_strong(own, nullptr)) return;
  }
}

}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* p, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** p, std::size_t alignment, std::size_t size);
void __real_free(void* p);

void* __wrap_malloc(std::size_t size) {
  return fails() ? nullptr : noted(__real_malloc(size));
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  return fails() ? nullptr : noted(__real_calloc(count, size));
}
void* __wrap_realloc(void* p, std::size_t size) {
  if (fails()) return nullptr;
  forget(p);
  return noted(__real_realloc(p, size));
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : noted(__real_aligned_alloc(alignment, size));
}
int __wrap_posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  if (fails()) return 12;  // ENOMEM
  const int error = __real_posix_memalign(p, alignment, size);
  if (error == 0) noted(*p);
  return error;
}
void __wrap_free(void* p) {
  forget(p);
  __real_free(p);
}
}

// The aligned forms are those of the standard library, which calls none of these; the engine does not use them.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return fails() ? nullptr : noted(__real_malloc(size == 0 ? 1 : size));
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return operator new(size, tag);
}
void* operator new(std::size_t size) {
  void* p = operator new(size, std::nothrow);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void operator delete(void* p) noexcept {
  forget(p);
  __real_free(p);
}
void operator delete[](void* p) noexcept {
  operator delete(p);
}
void operator delete(void* p, std::size_t) noexcept {
  operator delete(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  operator delete(p);
}
void operator delete(void* p, const std::nothrow_t&) noexcept {
  operator delete(p);
}
void operator delete[](void* p, const std::nothrow_t&) noexcept {
  operator delete(p);
}

namespace surefill {
namespace {

std::size_t count_live() {
  return static_cast<std::size_t>(
      std::count_if(live.begin(), live.end(), [](const std::atomic<void*>& p) { return p.load() != nullptr; }));
}

// ---- the calls

using Bytes = std::string;

struct Case {
  std::string name;
  std::function<void()> prepare;  // not watched: all is as before a first call
  std::function<std::uint32_t()> call;
  std::function<Bytes()> state;  // what a caller can see
  std::function<Bytes()> after;  // what it must be after out_of_memory; empty: as it was
  std::size_t keeps = 0;         // allocations that belong to what a good call makes
};

// Returns how many calls were refused.
int check(const Case& c) {
  c.prepare();
  const Bytes before = c.state();
  const auto watched = [&](int failing, bool later) {
    first_failing = failing, later_fail = later;
    calls = 0;
    watching = true;
    const std::uint32_t status = c.call();
    watching = false;
    return status;
  };
  EXPECT_EQ(watched(kNever, false), 0u) << c.name;
  const Bytes good = c.state();
  const int allocations = calls;
  EXPECT_EQ(count_live(), c.keeps) << c.name;
  int refused = 0;
  for (const bool later : {false, true}) {
    for (int n = 1; n <= allocations; ++n) {
      const std::string what = c.name + ", allocation " + std::to_string(n) + (later ? " and all after it" : "");
      c.prepare();
      EXPECT_EQ(count_live(), 0u) << what;
      const std::uint32_t status = watched(n, later);
      if (status == 0) {
        EXPECT_TRUE(c.state() == good) << what;
        EXPECT_EQ(count_live(), c.keeps) << what;
        continue;
      }
      EXPECT_EQ(status, SUREFILL_OUT_OF_MEMORY) << what;
      EXPECT_EQ(count_live(), 0u) << what << ": leaked";
      EXPECT_TRUE(c.state() == (c.after ? c.after() : before)) << what;
      ++refused;
    }
  }
  c.prepare();
  return refused;
}

constexpr int kWidth = 70, kHeight = 140;  // three bands of tiles
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

template <typename T>
void append(Bytes& bytes, std::span<const T> values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

constexpr Vertex kVertices[] = {{-20, -20, 0.5f, 1}, {200, -10, 0.5f, 1}, {-10, 190, 0.25f, 1}, {60, 99, 0.1f, 2}};
constexpr std::uint32_t kIndices[] = {0, 1, 2, 0, 3, 2};
constexpr float kValues[8] = {1, 2, 3, 4, 5, 6, 7, 8};

struct Draws {
  AttributeArray array{kValues, 2, 0, Interpolation::perspective};
  Draw draws[2];

  Draws() {
    for (Draw& draw : draws) draw.vertices = kVertices, draw.indices = kIndices, draw.attributes = {&array, 1};
    draws[1].grid = Grid{};
    draws[1].first_index = 10;
  }
};

struct How {
  const char* name;
  Options options;
};

void run_in_turn(void*, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
  for (std::size_t item = 0; item < items; ++item) task(argument, item);
}

const How kWays[] = {{"reference", {.path = Path::reference}},
                     {"fast", {}},
                     {"3 threads", {.threads = 3}},
                     {"executor", {.threads = 3, .executor = {run_in_turn, nullptr}}}};

// At least so many of its allocations can fail; thread starts do not count.
int least(const Options& options) {
#if defined(SUREFILL_REFERENCE_ONLY)
  (void)options;
  return 1;
#else
  return options.path == Path::reference ? 1 : 6;
#endif
}

// The same of a frame of depth alone: the reference path keeps it in the output.
int least_for_depth(const Options& options) {
  return least(options) == 1 ? 0 : least(options);
}

std::uint32_t number(Status status) {
  return static_cast<std::uint32_t>(status);
}

struct Image {
  std::vector<std::uint32_t> count = std::vector<std::uint32_t>(kPixels), index = count;
  std::vector<float> depth = std::vector<float>(kPixels), values = std::vector<float>(2 * kPixels);
  AttributeTarget attribute{values, 2};
  Target target;
  Statistics statistics;

  Image() {
    target.width = kWidth, target.height = kHeight;
    target.count = count, target.index = index, target.depth = depth, target.attributes = {&attribute, 1};
  }
  void reset() {
    std::fill(count.begin(), count.end(), 77u), std::fill(index.begin(), index.end(), 77u);
    std::fill(depth.begin(), depth.end(), 7.0f), std::fill(values.begin(), values.end(), 7.0f);
    statistics = {};
    statistics.dropped = 77;
  }
  Bytes bytes() const {
    Bytes all;
    append<std::uint32_t>(all, count), append<std::uint32_t>(all, index);
    append<float>(all, depth), append<float>(all, values);
    const std::uint64_t numbers[] = {statistics.dropped, statistics.rasterized, statistics.culled};
    append<std::uint64_t>(all, numbers);
    return all;
  }
};

TEST(Memory, Render) {
  const Draws draws;
  Image image;
  for (const How& how : kWays) {
    const Options& options = how.options;
    for (const bool all : {true, false}) {  // without depth and index the reference path keeps its own
      image.target.depth = all ? std::span(image.depth) : std::span<float>();
      const int refused = check({std::string("render, ") + how.name,
                                 [&] { image.reset(); },
                                 [&] { return number(render(image.target, draws.draws, &image.statistics, options)); },
                                 [&] { return image.bytes(); },
                                 {}});
      EXPECT_GE(refused, 2 * least(options)) << how.name;
    }
  }
}

// Lines and points, alone and after triangles.
TEST(Memory, RenderLines) {
  const AttributeArray array{kValues, 2, 0, Interpolation::perspective};
  Draw draws[4];
  for (Draw& draw : draws) draw.vertices = kVertices, draw.indices = kIndices, draw.attributes = {&array, 1};
  draws[0].primitive = draws[1].primitive = Primitive::lines;
  draws[1].width = 2.5f;
  draws[2].primitive = Primitive::points;
  draws[2].width = 9;
  for (std::uint32_t d = 1; d < 4; ++d) draws[d].first_index = 10 * d;
  Image image;
  for (const How& how : kWays) {
    const Options& options = how.options;
    for (const std::size_t number_of : {std::size_t{1}, std::size_t{3}, std::size_t{4}}) {
      const std::span<const Draw> drawn = std::span<const Draw>(draws).first(number_of);
      // A frame whose triangles are streamed writes buffers before it knows that all memory is there, as it may.
      std::uint32_t last = SUREFILL_OUT_OF_MEMORY;
      const bool streamed = number_of == 4;
      const int refused = check({std::string("render lines, ") + how.name + ", " + std::to_string(number_of),
                                 [&] {
                                   image.reset();
                                   last = SUREFILL_OUT_OF_MEMORY;
                                 },
                                 [&] { return last = number(render(image.target, drawn, &image.statistics, options)); },
                                 [&] {
                                   if (streamed && last != 0) return std::to_string(image.statistics.dropped);
                                   return image.bytes();
                                 },
                                 {}});
      EXPECT_GE(refused, 2) << how.name;
    }
  }
}

TEST(Memory, VisitCoverage) {
  const Draws draws;
  struct Seen {
    std::uint64_t blocks = 0;
    std::uint64_t triangles = 0;
  } seen;
  const auto visit = [](void* context, std::span<const CoverageBlock> blocks) {
    std::atomic_ref(static_cast<Seen*>(context)->blocks) += blocks.size();
  };
  Target size;
  size.width = kWidth, size.height = kHeight;
  for (const How& how : kWays) {
    const Options& options = how.options;
    Statistics statistics;
    const int refused = check({std::string("visit_coverage, ") + how.name,
                               [&] {
                                 seen = {};
                                 statistics = {};
                                 statistics.dropped = 77;
                               },
                               [&] {
                                 return number(visit_coverage(size, draws.draws, {visit, &seen}, &statistics, options));
                               },
                               [&] {
                                 seen.triangles = statistics.triangles();
                                 Bytes bytes;
                                 append<Seen>(bytes, {&seen, 1});
                                 return bytes;
                               },
                               {}});
#if !defined(SUREFILL_REFERENCE_ONLY)
    if (options.path == Path::automatic) {
      EXPECT_GE(refused, 2 * least(options)) << how.name;
    }
#endif
    (void)refused;
  }
}

// A context that could not get memory serves the next call, and gives back all that it has.
TEST(Memory, Contexts) {
  const Draws draws;
  Image image;
  for (const How& how : kWays) {
    Options options = how.options;
    image.reset();
    ASSERT_EQ(render(image.target, draws.draws, &image.statistics, options), Status::ok);
    const Bytes good = image.bytes();
    int refused = 0;
    for (const bool later : {false, true}) {
      for (int n = 1, allocations = 1; n <= allocations; ++n) {
        {
          Context context;
          options.context = &context;
          image.reset();
          const Bytes before = image.bytes();
          first_failing = n, later_fail = later, calls = 0;
          watching = true;
          const Status status = render(image.target, draws.draws, &image.statistics, options);
          first_failing = kNever, later_fail = false;
          EXPECT_TRUE(image.bytes() == (status == Status::ok ? good : before)) << how.name << ", " << n;
          EXPECT_EQ(render(image.target, draws.draws, &image.statistics, options), Status::ok);
          watching = false;
          if (n == 1) allocations = 64;  // more than there are
          if (n > calls) allocations = n;
          EXPECT_TRUE(image.bytes() == good) << how.name << ", " << n;
          refused += status == Status::out_of_memory;
        }
        EXPECT_EQ(count_live(), 0u) << how.name << ", " << n << ": leaked";
      }
    }
    EXPECT_GE(refused, 2 * least(options)) << how.name;
  }
  first_failing = 1, later_fail = true, calls = 0;
  watching = true;
  surefill_context* const context = surefill_context_create();
  watching = false;
  EXPECT_EQ(context, nullptr);
}

// The depths of a buffer, and its answers for rectangles at three depths.
template <typename Buffer>
Bytes state_of(const Buffer& buffer) {
  Bytes bytes;
  append<float>(bytes, buffer.depth());
  std::vector<OcclusionRectangle> rectangles;
  for (const float z : {0.05f, 0.4f, 0.9f}) {
    for (const float x : {0.0f, 8.0f, 33.0f}) rectangles.push_back({x, x, x + 20, x + 70, z});
  }
  std::vector<Occlusion> answers(rectangles.size());
  EXPECT_EQ(buffer.query(rectangles, answers), Status::ok);
  append<Occlusion>(bytes, answers);
  return bytes;
}

TEST(Memory, OcclusionBuffer) {
  const Draws draws;
  for (const How& how : kWays) {
    const Options& options = how.options;
    OcclusionBuffer buffer;
    const auto prepare = [&] {
      ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
      ASSERT_EQ(buffer.draw(std::span(draws.draws, 1)), Status::ok);
    };
    OcclusionBuffer clear;
    ASSERT_EQ(clear.resize(kWidth, kHeight), Status::ok);
    // A buffer that could not draw is clear: depth and levels.
    const int refused = check({std::string("OcclusionBuffer::draw, ") + how.name, prepare,
                               [&] { return number(buffer.draw(std::span(draws.draws + 1, 1), nullptr, options)); },
                               [&] { return state_of(buffer); }, [&] { return state_of(clear); }});
    EXPECT_GE(refused, 2 * least_for_depth(options)) << how.name;
  }
  // One that could not get another size is as it was.
  OcclusionBuffer buffer;
  const int refused = check({"OcclusionBuffer::resize",
                             [&] {
                               ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
                               ASSERT_EQ(buffer.draw(draws.draws), Status::ok);
                             },
                             [&] { return number(buffer.resize(kWidth + 1, kHeight, DepthTest::greater)); },
                             [&] { return state_of(buffer); },
                             {},
                             2});
  EXPECT_EQ(refused, 4);
}

// The draws' vertices as they are, where two triangles share an edge.
struct SafeOccluder {
  std::array<Vertex, 4> vertices{{{-9, -9, 0.25f, 1}, {99, -9, 0.25f, 1}, {-9, 99, 0.75f, 1}, {99, 99, 0.75f, 1}}};
  std::array<std::uint32_t, 6> indices{0, 1, 2, 2, 1, 3};
  std::array<float, 12> positions{};

  SafeOccluder() {
    for (std::size_t v = 0; v < 4; ++v) positions[3 * v] = static_cast<float>(v);
  }
};

TEST(Memory, SafeOcclusionBuffer) {
  const SafeOccluder wall;
  OccluderMesh mesh;
  const int prepared = check({"OccluderMesh::prepare",
                              [&] { mesh = OccluderMesh(); },
                              [&] { return number(mesh.prepare(wall.positions, wall.indices)); },
                              [&] {
                                const std::size_t sizes[] = {mesh.vertices(), mesh.triangles()};
                                Bytes bytes;
                                append<std::size_t>(bytes, sizes);
                                return bytes;
                              },
                              {},
                              8});
  EXPECT_GE(prepared, 2 * 9);
  for (const How& how : kWays) {
    SafeOcclusionBuffer clear, buffer;
    ASSERT_EQ(clear.resize(kWidth, kHeight), Status::ok);
    Occluder occluder;
    ASSERT_EQ(mesh.prepare(wall.positions, wall.indices), Status::ok);
    occluder.mesh = &mesh, occluder.vertices = wall.vertices;
    // Its memory is new each time, as it keeps what it has.
    const int refused = check({std::string("SafeOcclusionBuffer::draw, ") + how.name,
                               [&] {
                                 buffer = SafeOcclusionBuffer();
                                 ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
                               },
                               [&] {
                                 return number(buffer.draw({&occluder, 1}, how.options));
                               },
                               [&] { return state_of(buffer); }, [&] { return state_of(clear); }, 14});
    EXPECT_GE(refused, 2 * 10) << how.name;
  }
}

// ---- C

struct CDraws {
  std::array<float, 5 * 4> strided{};
  surefill_attribute_array array{kValues, 8, 2, 0, SUREFILL_PERSPECTIVE};
  surefill_grid grid{8, 0, 0, SUREFILL_NEAREST_EVEN};
  surefill_draw draws[2] = {};

  CDraws() {
    for (std::size_t v = 0; v < 4; ++v) std::memcpy(&strided[5 * v], &kVertices[v], sizeof(Vertex));
    for (surefill_draw& draw : draws) {
      draw.struct_size = sizeof draw;
      draw.vertices = reinterpret_cast<const surefill_vertex*>(strided.data());
      draw.vertex_count = 4, draw.vertex_stride = 20;
      draw.indices = kIndices, draw.index_count = 6;
      draw.attributes = &array, draw.attribute_count = 1;
    }
    draws[1].grid = &grid;
  }
};

TEST(Memory, CRender) {
  const CDraws draws;
  Image image;
  surefill_attribute_target attribute{image.values.data(), image.values.size(), 2, 0};
  surefill_target target{};
  target.struct_size = sizeof target, target.width = kWidth, target.height = kHeight, target.samples = 1;
  target.count = image.count.data(), target.count_count = kPixels;
  target.index = image.index.data(), target.index_count = kPixels;
  target.depth = image.depth.data(), target.depth_count = kPixels;
  target.attributes = &attribute, target.attribute_count = 1;
  surefill_statistics statistics{};
  const auto prepare = [&] {
    image.reset();
    statistics = {sizeof statistics, 77, 77, 77, 77, 77, 77, nullptr};
  };
  const auto state = [&] {
    Bytes bytes = image.bytes();
    append<surefill_statistics>(bytes, {&statistics, 1});
    return bytes;
  };
  const int refused = check({"surefill_validate",
                             prepare,
                             [&] { return static_cast<std::uint32_t>(surefill_validate(&target, draws.draws, 2)); },
                             state,
                             {}});
  EXPECT_EQ(refused, 6);  // the draws, their attributes, their vertices
  for (const How& how : kWays) {
    const Options& cpp = how.options;
    const surefill_options options{sizeof options, cpp.threads,      static_cast<std::uint32_t>(cpp.path),
                                   nullptr,        cpp.executor.run, cpp.executor.context};
    const int of_render = check(
        {std::string("surefill_render, ") + how.name,
         prepare,
         [&] { return static_cast<std::uint32_t>(surefill_render(&target, draws.draws, 2, &options, &statistics)); },
         state,
         {}});
    EXPECT_GE(of_render, 6 + 2 * least(cpp)) << how.name;
  }
}

TEST(Memory, COcclusion) {
  const CDraws draws;
  surefill_occlusion* occlusion = nullptr;
  surefill_occlusion* const elsewhere = reinterpret_cast<surefill_occlusion*>(&occlusion);  // never looked at
  const int created =
      check({"surefill_occlusion_create",
             [&] {
               if (occlusion != nullptr && occlusion != elsewhere) surefill_occlusion_destroy(occlusion);
               occlusion = elsewhere;
             },
             [&] {
               return static_cast<std::uint32_t>(surefill_occlusion_create(kWidth, kHeight, SUREFILL_LESS, &occlusion));
             },
             [&] {
               const bool made = occlusion != elsewhere;
               Bytes bytes;
               append<bool>(bytes, {&made, 1});
               return bytes;
             },
             {},
             3});
  EXPECT_EQ(created, 6);

  const auto state = [&] {
    Bytes bytes;
    append<float>(bytes, {surefill_occlusion_depth(occlusion), kPixels});
    std::vector<surefill_rectangle> rectangles;
    for (const float z : {0.05f, 0.4f, 0.9f}) rectangles.push_back({8, 8, 60, 100, z});
    std::vector<std::uint8_t> answers(rectangles.size());
    EXPECT_EQ(surefill_occlusion_query_rectangles(occlusion, rectangles.data(), rectangles.size(), answers.data()),
              SUREFILL_OK);
    append<std::uint8_t>(bytes, answers);
    return bytes;
  };
  ASSERT_EQ(surefill_occlusion_create(kWidth, kHeight, SUREFILL_LESS, &occlusion), SUREFILL_OK);
  const Bytes clear = state();
  for (const How& how : kWays) {
    const Options& cpp = how.options;
    const surefill_options options{sizeof options, cpp.threads,      static_cast<std::uint32_t>(cpp.path),
                                   nullptr,        cpp.executor.run, cpp.executor.context};
    const int refused = check(
        {std::string("surefill_occlusion_draw, ") + how.name,
         [&] {
           surefill_occlusion_clear(occlusion);
           ASSERT_EQ(surefill_occlusion_draw(occlusion, draws.draws, 1, nullptr, nullptr), SUREFILL_OK);
         },
         [&] {
           return static_cast<std::uint32_t>(surefill_occlusion_draw(occlusion, draws.draws + 1, 1, &options, nullptr));
         },
         state, [&] { return clear; }});
    EXPECT_GE(refused, 6 + 2 * least_for_depth(cpp)) << how.name;
  }
  surefill_occlusion_destroy(occlusion);
}

// The header says so of queries; the others have no status for it.
TEST(Memory, CallsThatAllocateNothing) {
  const Draws draws;
  Image image;
  OcclusionBuffer buffer;
  ASSERT_EQ(buffer.resize(kWidth, kHeight), Status::ok);
  surefill_occlusion* occlusion = nullptr;
  ASSERT_EQ(surefill_occlusion_create(kWidth, kHeight, SUREFILL_LESS, &occlusion), SUREFILL_OK);
  const ClipVertex clip[] = {{0, 0, 0, 1}, {1, 1, 1, 1}};
  Vertex out[2];
  OcclusionBox box;
  std::copy_n(kVertices, 4, box.corners), std::copy_n(kVertices, 4, box.corners + 4);
  const OcclusionRectangle rectangle{1, 2, 30, 40, 0.5f};
  Occlusion answer;
  const surefill_viewport viewport{0, 0, 8, 8, 0, 1, 0, 0};
  surefill_target c{};
  c.struct_size = sizeof c, c.width = c.height = c.samples = 1;
  std::int32_t x, y;
  std::uint8_t c_answer;
  calls = 0, first_failing = 1, later_fail = true;
  watching = true;
  const bool ok =
      validate(image.target, draws.draws) == Status::ok && sample_total(image.target) == kPixels &&
      sample_location(4, 1).x == 14 && status_text(Status::ok) != nullptr &&
      to_pixel(Viewport{}, clip, out) == Status::ok && buffer.query({&box, 1}, {&answer, 1}) == Status::ok &&
      buffer.query({&rectangle, 1}, {&answer, 1}) == Status::ok && surefill_sample_total(&c) == 1 &&
      surefill_to_pixel(&viewport, reinterpret_cast<const surefill_vertex*>(clip), 2,
                        reinterpret_cast<surefill_vertex*>(out)) == SUREFILL_OK &&
      surefill_occlusion_query_rectangles(occlusion, reinterpret_cast<const surefill_rectangle*>(&rectangle), 1,
                                          &c_answer) == SUREFILL_OK &&
      surefill_occlusion_query_boxes(occlusion, reinterpret_cast<const surefill_box*>(&box), 1, &c_answer) ==
          SUREFILL_OK &&
      surefill_validate(&c, nullptr, 0) == SUREFILL_OK && surefill_status_text(SUREFILL_OK) != nullptr;
  buffer.clear();
  OcclusionBuffer other(std::move(buffer));
  buffer = std::move(other);
  surefill_occlusion_clear(occlusion);
  surefill_sample_location(2, 0, &x, &y);
  watching = false;
  EXPECT_TRUE(ok);
  EXPECT_EQ(calls, 0);
  surefill_occlusion_destroy(occlusion);
}

}  // namespace
}  // namespace surefill
