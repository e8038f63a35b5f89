// SPDX-License-Identifier: Apache-2.0
//
// A program over a wrong build of the engine: `scalar` or `vector` code has fused operations. Each call that computes
// anything with that code says bad_build, the first and the later ones, in any rounding mode, and writes nothing; 77
// where this machine has no fused operations.
#include <cfenv>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::fprintf(stderr, "build_check_test: %s\n", what);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace surefill;
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2")) return 77;
  const bool scalar = argc == 2 && std::strcmp(argv[1], "scalar") == 0;
  const Status of_scalar = scalar ? Status::bad_build : Status::ok, of_vector = Status::bad_build;
  const Vertex vertices[] = {{-9, -9, 0, 1}, {90, -9, 0, 1}, {-9, 90, 0, 1}};
  const std::uint32_t indices[] = {0, 1, 2};
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  const auto visit = [](void* context, std::span<const CoverageBlock>) { *static_cast<bool*>(context) = true; };
  for (const int rounding : {FE_UPWARD, FE_TONEAREST, FE_DOWNWARD}) {
    std::fesetround(rounding);
    for (const Path path : {Path::automatic, Path::reference}) {
      const Status expected = path == Path::reference ? of_scalar : of_vector;
      std::uint32_t count[4] = {7, 7, 7, 7};
      Target target;
      target.width = target.height = 2, target.count = count;
      Statistics statistics;
      statistics.dropped = 77;
      expect(render(target, {&draw, 1}, &statistics, {.path = path}) == expected, "render");
      expect((count[0] == 7 && statistics.dropped == 77) == (expected != Status::ok), "what render writes");
      bool visited = false;
      Target size;
      size.width = size.height = 2;
      expect(visit_coverage(size, {&draw, 1}, {visit, &visited}, nullptr, {.path = path}) == expected,
             "visit_coverage");
      expect(visited == (expected == Status::ok), "what is visited");
      surefill_target c{};
      c.struct_size = sizeof c, c.width = c.height = 2, c.samples = 1, c.count = count, c.count_count = 4;
      surefill_options options{};
      options.struct_size = sizeof options, options.path = static_cast<std::uint32_t>(path);
      expect(surefill_render(&c, nullptr, 0, &options, nullptr) == static_cast<surefill_status>(expected), "in C");
      OcclusionBuffer buffer;
      expect(buffer.resize(2, 2) == of_scalar, "OcclusionBuffer::resize");
      const Status of_draw = buffer.draw({&draw, 1}, nullptr, {.path = path});
      expect(of_draw == (scalar ? Status::target_size : expected), "OcclusionBuffer::draw");
      const OcclusionRectangle rectangle{0, 0, 1, 1, 0};
      Occlusion answer;
      expect(buffer.query({&rectangle, 1}, {&answer, 1}) == of_scalar, "OcclusionBuffer::query");
    }
    const ClipVertex clip{0, 0, 0, 1};
    Vertex out;
    expect(to_pixel(Viewport{}, {&clip, 1}, {&out, 1}) == of_scalar, "to_pixel");
    surefill_occlusion* occlusion = nullptr;
    expect(surefill_occlusion_create(2, 2, 0, &occlusion) == static_cast<surefill_status>(of_scalar), "in C");
    surefill_occlusion_destroy(occlusion);
  }
  expect(std::strstr(surefill_status_text(SUREFILL_BAD_BUILD), "-ffast-math") != nullptr, "the text of bad_build");
  return failures == 0 ? 0 : 1;
}
