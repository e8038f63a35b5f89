// SPDX-License-Identifier: Apache-2.0
//
// Culling boxes (M6): whether a draw surely leaves no trace in an image, by eight corners whose hull contains it. What
// is seen of the draw is a sum of the corners with weights >= 0, so a half-space that holds all corners holds that,
// too.
#ifndef SUREFILL_SRC_FAST_CULLING_HPP
#define SUREFILL_SRC_FAST_CULLING_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exact/bounds.hpp"
#include "fast/tile.hpp"
#include "surefill/surefill.hpp"

namespace surefill::fast {

using CullingBox = std::array<Vertex, 8>;

// How far, in pixels, a draw may cover samples outside its hull: Grid moves corners by less than two steps, and a
// square that is touched reaches half a pixel beyond its sample.
inline int reach_beyond_hull(const Draw& draw) {
  return draw.grid || draw.conservative != Conservative::none ? 2 : 0;
}

// Does the hull lie outside the region, which is one of space, behind the eye, or where depth is clipped? All products are exact.
inline bool is_outside(const CullingBox& box, const Draw& draw, const PixelBox& region) {
  const int beyond = reach_beyond_hull(draw);
  const auto all = [&](auto is_out) {
    return std::all_of(box.begin(), box.end(), [&](const Vertex& v) {
      return is_out(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z),
                    static_cast<double>(v.w));
    });
  };
  const auto finite = [](double x, double y, double z, double w) {
    return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(w);
  };
  if (!all(finite)) return false;
  if (all([](double, double, double, double w) { return w <= 0; })) return true;
  if (all([&](double x, double, double, double w) { return x < (region.x0 - beyond) * w; })) return true;
  if (all([&](double x, double, double, double w) { return x > (region.x1 + beyond) * w; })) return true;
  if (all([&](double, double y, double, double w) { return y < (region.y0 - beyond) * w; })) return true;
  if (all([&](double, double y, double, double w) { return y > (region.y1 + beyond) * w; })) return true;
  if (draw.depth_mode != DepthMode::clip) return false;
  return all([](double, double, double z, double) { return z < 0; }) ||
         all([](double, double, double z, double w) { return z > w; });
}

// The pixels of the target that the hull can reach and, as the canvas keeps it, a depth that is not larger than any stored one of the
// draw. False if a corner is not in front of the eye.
inline bool reach_of_hull(const CullingBox& box, const DrawJob& job, PixelBox* pixels, float* nearest) {
  Reach columns{1e300, -1e300}, rows = columns, depth = columns;
  for (const Vertex& v : box) {
    const double w = v.w, x = v.x / w, y = v.y / w, z = v.z / w;
    if (!(w > 0 && std::isfinite(w) && std::isfinite(x) && std::isfinite(y) && std::isfinite(z))) return false;
    columns = {std::min(columns.low, x), std::max(columns.high, x)};
    rows = {std::min(rows.low, y), std::max(rows.high, y)};
    depth = {std::min(depth.low, z), std::max(depth.high, z)};
  }
  double z = job.greater ? -depth.high : depth.low;
  z -= std::fabs(z) * 0x1p-52;  // the quotient's rounding
  if (job.draw->depth_mode == DepthMode::clamp) z = std::clamp(z, job.greater ? -1.0 : 0.0, job.greater ? 0.0 : 1.0);
  constexpr double kLargest = std::numeric_limits<float>::max();
  *nearest = static_cast<float>(std::clamp(z, -kLargest, kLargest));  // rounding is monotonic
  const int beyond = 1 + reach_beyond_hull(*job.draw);                // 1: more than rounding
  *pixels = job.in_space(job.region);
  clip_to_reach({columns.low - beyond, columns.high + beyond}, 0, 1, &pixels->x0, &pixels->x1);
  clip_to_reach({rows.low - beyond, rows.high + beyond}, 0, 1, &pixels->y0, &pixels->y1);
  *pixels = job.in_target(*pixels);
  return true;
}

// Is everything in the hull behind what has been drawn? `tile_of(column, row)` is a tile's row of one: what it holds.
// Only for frames without counts. It stands on two rules: a fragment as far as what is stored leaves no trace (V1), and
// its depth is that of its place in the hull (I1). A depth test that passes equals, or a bias, needs another comparison.
template <typename TileOf>
bool is_hidden(const CullingBox& box, const DrawJob& job, const TileOf& tile_of) {
  PixelBox r{};
  float nearest = 0;
  if (!reach_of_hull(box, job, &r, &nearest)) return false;
  constexpr int kTile = kTileSize, kBlock = kBlockSize;
  for (int ty = r.y0 & -kTile; ty < r.y1; ty += kTile) {
    for (int tx = r.x0 & -kTile; tx < r.x1; tx += kTile) {
      const TileRow tile = tile_of(tx >> kTileLog2, ty >> kTileLog2);
      if (*tile.opened == 0) return false;
      if (nearest >= *tile.far) continue;
      for (int y = std::max(ty, r.y0 & -kBlock); y < std::min(ty + kTile, r.y1); y += kBlock) {
        for (int x = std::max(tx, r.x0 & -kBlock); x < std::min(tx + kTile, r.x1); x += kBlock) {
          for (int i = 0; i < kBlock * kBlock; ++i) {
            if (!(nearest >= tile.depth[tile.offset(x + i % kBlock, y + i / kBlock)])) return false;
          }
        }
      }
    }
  }
  return true;
}

}  // namespace surefill::fast

#endif  // SUREFILL_SRC_FAST_CULLING_HPP
