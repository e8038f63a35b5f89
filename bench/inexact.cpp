// SPDX-License-Identifier: Apache-2.0
//
// Built with `surefill` defined as another name, so that both engines fit into one program.
#include "bench/inexact.hpp"

#include "surefill/surefill.hpp"

bool SUREFILL_BENCH_INEXACT(int width, int height, const float* vertices, std::size_t vertex_count,
                            const std::uint32_t* indices, std::size_t index_count, float* depth) {
  surefill::Target target;
  target.width = width, target.height = height;
  target.depth = {depth, static_cast<std::size_t>(width) * static_cast<std::size_t>(height)};
  surefill::Draw draw;
  draw.vertices = {reinterpret_cast<const surefill::Vertex*>(vertices), vertex_count};
  draw.indices = {indices, index_count};
  draw.depth_mode = surefill::DepthMode::clip;
  return surefill::render(target, {&draw, 1}) == surefill::Status::ok;
}
