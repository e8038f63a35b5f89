// SPDX-License-Identifier: Apache-2.0
#include "reference.hpp"

#include <algorithm>

#include "fragments.hpp"

namespace surefill::reference {
namespace {

// Calls sink(Fragment) for each sample of numbers [first, last) that M2 counts: triangle by triangle, and of each by
// blocks of 8 x 8 pixels, which begin at the target's corner (M8).
template <typename Sink>
void traverse(const Target& target, const Draw& draw, DrawFragments& fragments, int first, int last, Rungs& rungs,
              const Sink& sink) {
  const PixelBox region = region_of(target, draw);
  const Origin& o = target.origin;
  double least = 1, largest = 0;  // of the coordinates of a pixel's samples
  for (int n = 0; n < target.samples; ++n) {
    const SamplePosition offset = sample_offset(target, n);
    least = std::min({least, offset.x, offset.y}), largest = std::max({largest, offset.x, offset.y});
  }
  for (std::size_t t = 0; t < triangles_of(draw); ++t) {
    const auto position = static_cast<std::uint32_t>(t);
    if (region.empty() || !is_finite(draw, position) || !fragments.triangle().use(draw, position, &rungs)) continue;
    if (fragments.triangle().is_culled()) continue;
    PixelBox box = fragments.triangle().box(region, least, largest);
    if (box.empty()) continue;
    box = {box.x0 - o.x, box.y0 - o.y, box.x1 - o.x, box.y1 - o.y};
    for (int by = box.y0 & ~7; by < box.y1; by += 8) {
      for (int bx = box.x0 & ~7; bx < box.x1; bx += 8) {
        for (int y = std::max(by, box.y0); y < std::min(by + 8, box.y1); ++y) {
          for (int x = std::max(bx, box.x0); x < std::min(bx + 8, box.x1); ++x) {
            for (int n = first; n < last; ++n) {
              Fragment fragment{position, x, y, n};
              if (fragments.counts(fragment)) sink(fragment);
            }
          }
        }
      }
    }
  }
}

}  // namespace

void draw(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs) noexcept {
  DrawFragments fragments(target, draw, number, layers, rungs);
  traverse(target, draw, fragments, 0, target.samples, rungs, [&](const Fragment& f) { fragments.take(f); });
}

Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept {
  FragmentFrame frame(target, draws);
  if (!frame.begin()) return Status::out_of_memory;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    draw(target, draws[d], static_cast<std::uint32_t>(d), frame.layers(), rungs);
  }
  frame.finish(rungs);
  return Status::ok;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept {
  for (int n = 0; n < target.samples; ++n) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      DrawFragments fragments(target, draws[d], static_cast<std::uint32_t>(d), nullptr, rungs);
      CoverageBlock block{fragments.number(), 0, 0, 0, n, 0};
      const auto flush = [&] {
        if (block.mask != 0) visitor.visit(visitor.context, {&block, 1});
        block.mask = 0;
      };
      traverse(target, draws[d], fragments, n, n + 1, rungs, [&](const Fragment& f) {
        if (f.position != block.triangle || (f.x & ~7) != block.x || (f.y & ~7) != block.y) {
          flush();
          block.triangle = f.position, block.x = f.x & ~7, block.y = f.y & ~7;
        }
        block.mask |= std::uint64_t{1} << (8 * (f.y & 7) + (f.x & 7));
      });
      flush();
    }
  }
  return Status::ok;
}

}  // namespace surefill::reference
