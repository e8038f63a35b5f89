// SPDX-License-Identifier: Apache-2.0
//
// Who is seen: the z-buffer, hierarchical z over it, and the painter's algorithm, which orders a BSP tree of pieces
// that exact planes have cut.
//
// Sources: E. Catmull 1974 (z-buffer); N. Greene, M. Kass and G. Miller, Hierarchical Z-Buffer Visibility, 1993 (Zmax);
// T. Akenine-Moeller and J. Stroem, Graphics for the Masses, 2003 (Zmin); M. Newell, R. Newell and T. Sancha 1972, and
// H. Fuchs, Z. Kedem and B. Naylor, On Visible Surface Generation by A Priori Tree Structures, 1980 (painter, BSP).
#ifndef SUREFILL_TEXTBOOK_VISIBILITY_HPP
#define SUREFILL_TEXTBOOK_VISIBILITY_HPP

#include <algorithm>
#include <limits>
#include <vector>

#include "textbook/pipeline.hpp"
#include "textbook/traversal.hpp"

namespace surefill::textbook {

struct DepthCounts {
  std::uint64_t tiles = 0;           // tiles of triangles that no edge rejects
  std::uint64_t tiles_behind = 0;    // culled by Zmax: nothing of the triangle there can be seen
  std::uint64_t tiles_in_front = 0;  // by Zmin: everything passes, no depth is read
  std::uint64_t depth_reads = 0, depth_writes = 0;
};

// One sample a pixel, the nearest (stored depth, index) wins (V1). With hierarchical z each tile of 8 x 8 samples knows
// bounds of its depths.
class DepthBuffer {
 public:
  static constexpr int kTile = 8;

  DepthBuffer(int width, int height, bool hierarchical)
      : width_(width), height_(height), columns_((width + kTile - 1) / kTile), hierarchical_(hierarchical) {
    const std::size_t samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    depth_.assign(samples, std::numeric_limits<float>::infinity());
    index_.assign(samples, kNoTriangle);
    tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>((height + kTile - 1) / kTile));
  }

  // Fragments of any depth (I5: mode none). D != 0.
  void draw(Triangle& triangle, std::uint32_t index, FillRule rule) {
    const Lattice lattice{width_, height_};
    Asked asked(triangle, rule, lattice);
    for_each_tile(asked.box(), kTile, [&](const PixelBox& box) {
      EdgeSet undecided = kAllEdges;
      if (asked.classify(box, &undecided) == TileClass::reject) return;
      ++counts_.tiles;
      Range& range = tiles_[tile(box.x0, box.y0)];
      ++range.tests;
      bool test = true;
      if (hierarchical_) {
        const Range reach = depth_range(triangle, box);
        if (reach.low > range.high || (reach.low == range.high && index > range.largest_index)) {
          ++counts_.tiles_behind;
          ++range.behind;
          return;
        }
        test = reach.high >= range.low;
        if (!test) ++counts_.tiles_in_front;
      }
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
          if (asked.visit(x, y, undecided)) fragment(triangle, index, x, y, test);
        }
      }
      if (hierarchical_) update(range, box.x0, box.y0);
    });
  }

  const std::vector<float>& depth() const { return depth_; }
  const std::vector<std::uint32_t>& index() const { return index_; }
  const DepthCounts& counts() const { return counts_; }

  // What a tile knows: bounds of its depths, and for pictures how often a triangle met it and was culled there.
  struct Range {
    float low = std::numeric_limits<float>::infinity(), high = low;
    std::uint32_t largest_index = kNoTriangle;  // among the samples of the tile
    int tests = 0, behind = 0;
  };
  const Range& range(int x, int y) const { return tiles_[tile(x, y)]; }

 private:
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  std::size_t tile(int x, int y) const { return static_cast<std::size_t>(y / kTile * columns_ + x / kTile); }

  // Depth is affine and rounding is monotonic: the stored depths of the box lie between those of its corner samples.
  Range depth_range(Triangle& triangle, const PixelBox& box) {
    const double left = box.x0 + 0.5, right = box.x1 - 0.5, top = box.y0 + 0.5, bottom = box.y1 - 0.5;
    const float z[4] = {triangle.rounded_depth({left, top}), triangle.rounded_depth({right, top}),
                        triangle.rounded_depth({left, bottom}), triangle.rounded_depth({right, bottom})};
    return {*std::min_element(z, z + 4), *std::max_element(z, z + 4)};
  }

  void fragment(Triangle& triangle, std::uint32_t index, int x, int y, bool test) {
    const std::size_t s = place(x, y);
    const float z = triangle.rounded_depth({x + 0.5, y + 0.5});
    if (test) {
      ++counts_.depth_reads;
      if (z > depth_[s] || (z == depth_[s] && index > index_[s])) return;
    }
    ++counts_.depth_writes;
    depth_[s] = z;
    index_[s] = index;
  }

  void update(Range& range, int x0, int y0) {
    x0 = x0 / kTile * kTile, y0 = y0 / kTile * kTile;
    range.low = std::numeric_limits<float>::infinity(), range.high = -range.low, range.largest_index = 0;
    for (int y = y0; y < std::min(y0 + kTile, height_); ++y) {
      for (int x = x0; x < std::min(x0 + kTile, width_); ++x) {
        range.low = std::min(range.low, depth_[place(x, y)]);
        range.high = std::max(range.high, depth_[place(x, y)]);
        range.largest_index = std::max(range.largest_index, index_[place(x, y)]);
      }
    }
  }

  int width_, height_, columns_;
  bool hierarchical_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> index_;
  std::vector<Range> tiles_;
  DepthCounts counts_;
};

// --- The painter

// A part of a triangle that needs no further cut. Its polygon has W > 0 and lies in the target. It paints the samples
// of its closed polygon that the triangle covers (C2, C3), so both parts paint the samples on a cut; there they tie
// with the plane that cut them.
template <class Number>
struct Piece {
  std::uint32_t index;
  Polygon<Number> polygon;
  ClipPlane<Number> depth;  // z(x, y) = a x + b y + d (I1), as a plane of homogeneous corners
};

// The triangle as one piece; empty polygon where D = 0 or nothing of it lies in the target.
template <class Number>
Piece<Number> piece_of(const std::array<Vertex, 3>& v, std::uint32_t index, int width, int height) {
  Piece<Number> piece{index, clipped<Number>(v, width, height, ClipTo::view_volume, false), {}};
  Number a(0), b(0), c(0), d(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex &j = v[(i + 1) % 3], &k = v[(i + 2) % 3];
    const Number jx(j.x), jy(j.y), jw(j.w), kx(k.x), ky(k.y), kw(k.w), z(v[i].z);
    const Number ai = jy * kw - jw * ky, bi = jw * kx - jx * kw, ci = jx * ky - jy * kx;
    a += z * ai, b += z * bi, c += z * ci;
    if (i == 0) d = ai * Number(v[0].x) + bi * Number(v[0].y) + ci * Number(v[0].w);
  }
  if (d == 0) {
    piece.polygon.clear();
  } else {
    piece.depth = {a / d, b / d, Number(0), c / d};
  }
  return piece;
}

// Pieces in the order of painting, farthest first. The plane of the first piece divides the others: at every sample,
// what is farther than the plane is painted before it, what is nearer after it. Pieces in one plane are painted by
// falling index (V1).
template <class Number>
void paint_order(std::vector<Piece<Number>> pieces, std::vector<Piece<Number>>& order) {
  std::erase_if(pieces, [](const Piece<Number>& piece) { return piece.polygon.size() < 3; });
  if (pieces.empty()) return;
  const ClipPlane<Number> root = pieces[0].depth;
  std::vector<Piece<Number>> farther, same, nearer;
  for (Piece<Number>& piece : pieces) {
    const ClipPlane<Number> behind{piece.depth.a - root.a, piece.depth.b - root.b, Number(0), piece.depth.d - root.d};
    const ClipPlane<Number> before{-behind.a, -behind.b, Number(0), -behind.d};
    bool any_behind = false, any_before = false;
    for (const ClipCorner<Number>& corner : piece.polygon) {
      const Number h = height(behind, corner);
      any_behind = any_behind || h > 0;
      any_before = any_before || h < 0;
    }
    if (any_behind && any_before) {
      farther.push_back({piece.index, clip(piece.polygon, behind), piece.depth});
      nearer.push_back({piece.index, clip(piece.polygon, before), piece.depth});
    } else {
      (any_behind ? farther : any_before ? nearer : same).push_back(std::move(piece));
    }
  }
  std::sort(same.begin(), same.end(), [](const Piece<Number>& p, const Piece<Number>& q) { return p.index > q.index; });
  paint_order(std::move(farther), order);
  for (Piece<Number>& piece : same) order.push_back(std::move(piece));
  paint_order(std::move(nearer), order);
}

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_VISIBILITY_HPP
