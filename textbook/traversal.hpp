// SPDX-License-Identifier: Apache-2.0
//
// Traversals of the textbooks: in which order the samples of a triangle are found, and at what cost. All ask the same
// exact edge functions (C2, C3), so all find the same samples. None is used by the engine; docs/textbook.md shows them.
//
// Sources: J. Pineda, A Parallel Algorithm for Polygon Rasterization, 1988 (edge functions, traversals); T.
// Akenine-Moeller, Graphics Hardware lecture notes (backtrack, zigzag, tiled); N. Greene, Hierarchical Polygon Tiling
// with Coverage Masks, 1996; M. McCool, C. Wales and K. Moule, Incremental and Hierarchical Hilbert Order Edge Equation
// Polygon Rasterization, 2001.
#ifndef SUREFILL_TEXTBOOK_TRAVERSAL_HPP
#define SUREFILL_TEXTBOOK_TRAVERSAL_HPP

#include <algorithm>
#include <cstdint>

#include "engine/src/exact/bounds.hpp"
#include "engine/src/exact/triangle.hpp"

namespace surefill::textbook {

// One sample in every pixel of the target, at the same offset from the pixel's corner. Multisampling is several of
// these.
struct Lattice {
  int width, height;
  SamplePosition offset{0.5, 0.5};

  SamplePosition at(int x, int y) const { return {x + offset.x, y + offset.y}; }
  PixelBox box() const { return {0, 0, width, height}; }
};

struct Counts {
  std::uint64_t samples_visited = 0;  // asked for their coverage, or drawn without asking in an accepted tile
  std::uint64_t samples_covered = 0;
  std::uint64_t tiles_tested = 0;
  std::uint64_t edge_evaluations = 0;  // one edge function at one point, whatever for
};

enum class TileClass { reject, accept, partial };

using EdgeSet = unsigned;  // bit i: edge i
inline constexpr EdgeSet kAllEdges = 7;

// What a traversal may ask of a triangle. All signs are those of E_i / D, ties decided by the fill rule.
class Asked {
 public:
  // `triangle` is set up, with D != 0.
  Asked(const Triangle& triangle, FillRule rule, const Lattice& lattice) : triangle_(triangle), lattice_(lattice) {
    for (int i = 0; i < 3; ++i) {
      const EdgeFunction& e = triangle.edge(i);
      tie_[i] = tie_sign(e, tie_shift(rule), triangle.determinant()) * triangle.determinant();
      along_x_[i] = sign_of(e.a) * triangle.determinant();
      along_y_[i] = sign_of(e.b) * triangle.determinant();
    }
  }

  const Counts& counts() const { return counts_; }

  // The pixels with samples that the triangle can cover.
  PixelBox box() const {
    return screen_box(triangle_.vertex(0), triangle_.vertex(1), triangle_.vertex(2), lattice_.box(),
                      std::min(lattice_.offset.x, lattice_.offset.y), std::max(lattice_.offset.x, lattice_.offset.y));
  }

  // Is sample (x, y) on the triangle's side of edge i?
  bool inside(int i, int x, int y) {
    ++counts_.edge_evaluations;
    const int sign = triangle_.edge(i).sign(lattice_.at(x, y)) * triangle_.determinant();
    return (sign != 0 ? sign : tie_[i]) > 0;
  }

  // Visits sample (x, y), which is known to be inside the edges that are not `undecided`.
  bool visit(int x, int y, EdgeSet undecided = kAllEdges) {
    ++counts_.samples_visited;
    for (int i = 0; i < 3; ++i) {
      if ((undecided >> i & 1u) != 0 && !inside(i, x, y)) return false;
    }
    ++counts_.samples_covered;
    return true;
  }

  // Does an edge show that no sample of the row at x, or from x on in the direction step = +1 or -1, is covered?
  bool beyond(int x, int y, int step) {
    for (int i = 0; i < 3; ++i) {
      if (along_x_[i] * step < 0 && !inside(i, x, y)) return true;
    }
    return false;
  }

  // The samples of a tile against the undecided edges: the sample furthest along an edge's gradient rejects, the one
  // furthest against it accepts. Exact, since the edge functions are affine. `undecided` loses the edges that accept.
  TileClass classify(const PixelBox& tile, EdgeSet* undecided) {
    ++counts_.tiles_tested;
    for (int i = 0; i < 3; ++i) {
      if ((*undecided >> i & 1u) == 0) continue;
      const bool right = along_x_[i] > 0, down = along_y_[i] > 0;
      if (!inside(i, right ? tile.x1 - 1 : tile.x0, down ? tile.y1 - 1 : tile.y0)) return TileClass::reject;
      if (inside(i, right ? tile.x0 : tile.x1 - 1, down ? tile.y0 : tile.y1 - 1)) *undecided &= ~(1u << i);
    }
    return *undecided == 0 ? TileClass::accept : TileClass::partial;
  }

 private:
  const Triangle& triangle_;
  Lattice lattice_;
  int tie_[3], along_x_[3], along_y_[3];  // signs
  Counts counts_;
};

// Traversals tell an observer what they do, in order: seen.sample(x, y, covered), seen.tile(box, class).

// Every sample of a box: of the target, or the bounding box.
template <class Observer>
void visit_box(Asked& asked, const PixelBox& box, Observer& seen, EdgeSet undecided = kAllEdges) {
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) seen.sample(x, y, asked.visit(x, y, undecided));
  }
}

// Backtrack: left to right only. Before each row the start moves, by probes of the left edges alone, to the first
// sample that is not to the left of the triangle; the row ends at the first sample that is not covered.
template <class Observer>
void visit_backtrack(Asked& asked, const PixelBox& box, Observer& seen) {
  int start = box.x0;
  for (int y = box.y0; y < box.y1; ++y) {
    while (start > box.x0 && !asked.beyond(start - 1, y, -1)) --start;
    while (start < box.x1 && asked.beyond(start, y, -1)) ++start;
    for (int x = start; x < box.x1; ++x) {
      const bool covered = asked.visit(x, y);
      seen.sample(x, y, covered);
      if (!covered) break;
    }
  }
}

// Zigzag: rows in alternating directions. A row goes on until neither it nor the next one, which comes back from there,
// has anything further on; so nothing is visited twice.
template <class Observer>
void visit_zigzag(Asked& asked, const PixelBox& box, Observer& seen) {
  if (box.empty()) return;
  int step = +1, x = box.x0;
  while (x < box.x1 - 1 && asked.beyond(x, box.y0, -1)) ++x;
  for (int y = box.y0; y < box.y1; ++y, step = -step) {
    const int last = step > 0 ? box.x1 - 1 : box.x0;
    for (;; x += step) {
      const bool covered = asked.visit(x, y);
      seen.sample(x, y, covered);
      if (x == last) break;
      if (!covered && asked.beyond(x, y, step) && (y + 1 == box.y1 || asked.beyond(x, y + 1, step))) break;
    }
  }
}

// Calls visit(tile) for the tiles of the screen, `size` pixels each way, row by row, as far as they lie in the box.
template <class Visit>
void for_each_tile(const PixelBox& box, int size, const Visit& visit) {
  for (int y = box.y0 / size * size; y < box.y1; y += size) {
    for (int x = box.x0 / size * size; x < box.x1; x += size) {
      visit(PixelBox{std::max(x, box.x0), std::max(y, box.y0), std::min(x + size, box.x1), std::min(y + size, box.y1)});
    }
  }
}

// Tiled: one level of tiles; those that no edge rejects are visited whole.
template <class Observer>
void visit_tiled(Asked& asked, const PixelBox& box, int size, Observer& seen) {
  for_each_tile(box, size, [&](const PixelBox& tile) {
    EdgeSet undecided = kAllEdges;
    const TileClass found = asked.classify(tile, &undecided);
    seen.tile(tile, found);
    if (found != TileClass::reject) visit_box(asked, tile, seen);
  });
}

// Hierarchical: tiles of size, size / 4, ... down to 4. An edge that accepts a tile is never asked again in it.
template <class Observer>
void visit_hierarchical(Asked& asked, const PixelBox& box, int size, Observer& seen, EdgeSet edges = kAllEdges) {
  for_each_tile(box, size, [&](const PixelBox& tile) {
    EdgeSet undecided = edges;
    const TileClass found = asked.classify(tile, &undecided);
    seen.tile(tile, found);
    if (found == TileClass::reject) return;
    if (found == TileClass::accept || size / 4 < 4) {
      visit_box(asked, tile, seen, undecided);
    } else {
      visit_hierarchical(asked, tile, size / 4, seen, undecided);
    }
  });
}

// Hilbert order: squares of 2^k, the four quarters of each in the order of the curve, which enters at corner (x, y),
// leaves at its end along A = (ax, ay) and reaches B = (bx, by) to the side. Two samples that follow each other are
// neighbours wherever nothing was rejected between them.
template <class Observer>
void visit_hilbert(Asked& asked, const PixelBox& box, int x, int y, int ax, int ay, int bx, int by, EdgeSet edges,
                   Observer& seen) {
  const int left = std::min(x, x + ax + bx), top = std::min(y, y + ay + by), side = std::abs(ax + ay);
  const PixelBox part{std::max(left, box.x0), std::max(top, box.y0), std::min(left + side, box.x1),
                      std::min(top + side, box.y1)};
  if (part.empty()) return;
  if (side == 1) {
    seen.sample(left, top, asked.visit(left, top, edges));
    return;
  }
  const TileClass found = asked.classify(part, &edges);
  if (side >= 4) seen.tile(part, found);
  if (found == TileClass::reject) return;
  ax /= 2, ay /= 2, bx /= 2, by /= 2;
  visit_hilbert(asked, box, x, y, bx, by, ax, ay, edges, seen);
  visit_hilbert(asked, box, x + bx, y + by, ax, ay, bx, by, edges, seen);
  visit_hilbert(asked, box, x + bx + ax, y + by + ay, ax, ay, bx, by, edges, seen);
  visit_hilbert(asked, box, x + bx + 2 * ax, y + by + 2 * ay, -bx, -by, -ax, -ay, edges, seen);
}

enum class Traversal { every_sample, bounding_box, backtrack, zigzag, tiled, hierarchical, hilbert };
inline constexpr Traversal kTraversals[] = {Traversal::every_sample, Traversal::bounding_box, Traversal::backtrack,
                                            Traversal::zigzag,       Traversal::tiled,        Traversal::hierarchical,
                                            Traversal::hilbert};

constexpr const char* name_of(Traversal traversal) {
  constexpr const char* kNames[] = {"every-sample", "bounding-box", "backtrack", "zigzag",
                                    "tiled",        "hierarchical", "hilbert"};
  return kNames[static_cast<int>(traversal)];
}

// Finds the covered samples in the order of the traversal. `size` is that of the (largest) tiles: 4, 8, 16, 32 or 64.
template <class Observer>
void traverse(Traversal traversal, Asked& asked, const Lattice& lattice, int size, Observer& seen) {
  if (traversal == Traversal::every_sample) return visit_box(asked, lattice.box(), seen);
  const PixelBox box = asked.box();
  if (box.empty()) return;
  int side = 1;
  while (side < std::max(box.x1 - box.x0, box.y1 - box.y0)) side *= 2;
  switch (traversal) {
    case Traversal::backtrack:
      return visit_backtrack(asked, box, seen);
    case Traversal::zigzag:
      return visit_zigzag(asked, box, seen);
    case Traversal::tiled:
      return visit_tiled(asked, box, size, seen);
    case Traversal::hierarchical:
      return visit_hierarchical(asked, box, size, seen);
    case Traversal::hilbert:
      return visit_hilbert(asked, box, box.x0, box.y0, side, 0, 0, side, kAllEdges, seen);
    default:
      return visit_box(asked, box, seen);
  }
}

}  // namespace surefill::textbook

#endif  // SUREFILL_TEXTBOOK_TRAVERSAL_HPP
