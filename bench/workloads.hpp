// SPDX-License-Identifier: Apache-2.0
//
// The workloads that speed is measured on: deterministic, 1920 x 1080, the same for every rasterizer.
#ifndef SUREFILL_BENCH_WORKLOADS_HPP
#define SUREFILL_BENCH_WORKLOADS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "surefill/surefill.hpp"

namespace surefill::bench {

inline constexpr int kWidth = 1920, kHeight = 1080;

// Where vertices lie: anywhere; on a grid of 1/256 pixel with W = 1; on pixel centres with W = 1, as user interfaces
// have it.
enum class Placement { free, snapped, aligned };

struct Workload {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  Primitive primitive = Primitive::triangles;
};

// W1: 1,000,000 random triangles of 10 pixels mean area. W2: 200,000 of 200. W3: 2,000 of 100,000 (before clipping).
// W4: a height field of 1000 x 1000 vertices, indexed, about one pixel a triangle. W5: 100,000 slivers of 1000 x 1
// pixels. W6: 20,000 triangles with one or two vertices behind the eye. W uniform in [1, 10] in W1-W3 and W5; random
// depths in [0, 1].
inline constexpr int kWorkloads = 6;
Workload make_workload(int number, Placement placement);

// `triangles` random triangles of 10 pixels, as W1.
Workload make_small_triangles(std::size_t triangles);

// So many lines of 100 pixels in random directions, and so many points; W uniform in [1, 10].
Workload make_lines(std::size_t lines);
Workload make_points(std::size_t points);

// A knot of a tube with so many triangles, a closed mesh that fills most of the frame's height; triangles even.
Workload make_knot(std::size_t triangles);

// The mesh spot, seen whole in a frame of this height in pixels, at the upper left.
Workload make_spot(int height);

}  // namespace surefill::bench

#endif  // SUREFILL_BENCH_WORKLOADS_HPP
