// SPDX-License-Identifier: Apache-2.0
#include "reference.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

#include "exact/exact_draw.hpp"

namespace surefill::reference {
namespace {

// A sample that M2 counts: the triangle, by its position in the draw, the pixel, the number of the sample and, where
// somebody looks at depth, what is stored of it.
struct Fragment {
  std::uint32_t position;
  int x, y, n;
  float z;
};

// One draw of a frame.
class DrawRenderer {
 public:
  // `depth` and `winner` are null if no depth is looked at. winner[s] is the position of the triangle of this draw that
  // is seen at sample s, or kNoTriangle; all kNoTriangle on entry.
  DrawRenderer(const Target& target, const Draw& draw, float* depth, std::uint32_t* winner, Rungs& rungs)
      : target_(target), draw_(draw), depth_(depth), winner_(winner), rungs_(rungs), shift_(tie_shift(draw.fill_rule)) {
    for (int n = 0; n < target.samples; ++n) {
      const SamplePosition offset = offset_[n] = sample_offset(target.samples, n);
      least_ = std::min({least_, offset.x, offset.y}), largest_ = std::max({largest_, offset.x, offset.y});
    }
  }

  // Who covers, and who is seen.
  void rasterize() {
    traverse(0, target_.samples, [this](const Fragment& f) {
      const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
      if (!target_.count.empty()) ++target_.count[s];
      if (winner_ == nullptr || !passes(f.position, f.z, s)) return;
      winner_[s] = f.position;
      if (draw_.depth_write) depth_[s] = f.z;
    });
  }

  // The covered samples of number n, triangle by triangle, block by block.
  void visit(std::uint32_t number, int n, const CoverageVisitor& visitor) {
    CoverageBlock block{number, 0, 0, 0, n, 0};
    const auto flush = [&] {
      if (block.mask != 0) visitor.visit(visitor.context, {&block, 1});
      block.mask = 0;
    };
    traverse(n, n + 1, [&](const Fragment& f) {
      if (f.position != block.triangle || (f.x & ~7) != block.x || (f.y & ~7) != block.y) {
        flush();
        block.triangle = f.position, block.x = f.x & ~7, block.y = f.y & ~7;
      }
      block.mask |= std::uint64_t{1} << (8 * (f.y & 7) + (f.x & 7));
    });
    flush();
  }

  // Writes index, barycentrics and attributes of every sample whose winner belongs to this draw.
  void shade(bool shading) {
    for (int y = 0; y < target_.height; ++y) {
      for (int x = 0; x < target_.width; ++x) {
        const std::size_t first = sample_index(target_, x, y, 0);
        for (std::size_t s = first; s < first + static_cast<std::size_t>(target_.samples); ++s) {
          const std::uint32_t position = winner_[s];
          if (position == kNoTriangle) continue;
          if (!target_.index.empty()) target_.index[s] = index_of(draw_, position);
          if (!shading) continue;
          if (s > first && winner_[s - 1] == position) {
            copy_shading(s - 1, s);
            continue;
          }
          triangle_.use(draw_, position, &rungs_);
          shade_sample(position, triangle_.place_of_attributes(target_, x, y, shift_), s);
        }
      }
    }
  }

 private:
  // Calls sink(Fragment) for each sample of numbers [first, last) that M2 counts: triangle by triangle, and of each by
  // blocks of 8 x 8 pixels.
  template <typename Sink>
  void traverse(int first, int last, const Sink& sink) {
    const PixelBox region = region_of(target_, draw_);
    for (std::size_t t = 0; t < triangles_of(draw_); ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      if (region.empty() || !is_finite(draw_, position) || !triangle_.use(draw_, position, &rungs_)) continue;
      // Under Grid facing is a matter of the sample (G1).
      if (!draw_.grid && culls(draw_, triangle_.triangle().determinant())) continue;
      const PixelBox box = triangle_.box(region, least_, largest_);
      for (int by = box.y0 & ~7; by < box.y1; by += 8) {
        for (int bx = box.x0 & ~7; bx < box.x1; bx += 8) {
          for (int y = std::max(by, box.y0); y < std::min(by + 8, box.y1); ++y) {
            for (int x = std::max(bx, box.x0); x < std::min(bx + 8, box.x1); ++x) {
              for (int n = first; n < last; ++n) {
                Fragment fragment{position, x, y, n, 0};
                if (counts(fragment)) sink(fragment);
              }
            }
          }
        }
      }
    }
  }

  // M2: covered, not culled, and not removed by depth clipping. Finds out the depth, where it is looked at.
  bool counts(Fragment& f) {
    if (draw_.conservative != Conservative::none) return triangle_.draws_square(f.x, f.y, &rungs_);
    const SamplePosition p{f.x + offset_[f.n].x, f.y + offset_[f.n].y};
    if (!triangle_.draws(p, shift_, &rungs_)) return false;
    if (winner_ == nullptr && draw_.depth_mode != DepthMode::clip) return true;
    return triangle_.depth(p, &f.z, &rungs_);
  }

  // V1 and M5. Among equal indices the first position wins with depth write on, the last with depth write off.
  bool passes(std::uint32_t position, float z, std::size_t s) const {
    const bool nearer = target_.depth_test == DepthTest::less ? z < depth_[s] : z > depth_[s];
    if (winner_[s] == kNoTriangle) return nearer;
    if (!draw_.depth_write) return nearer && index_of(draw_, position) >= index_of(draw_, winner_[s]);
    return nearer || (z == depth_[s] && index_of(draw_, position) < index_of(draw_, winner_[s]));
  }

  void shade_sample(std::uint32_t position, SamplePosition p, std::size_t s) {
    if (!target_.barycentrics.empty()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
        target_.barycentrics[3 * s + i] = triangle_.attribute(p, unit, Interpolation::perspective, &rungs_);
      }
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (out.values.empty()) continue;
      const AttributeArray& in = draw_.attributes[k];
      for (std::size_t c = 0; c < out.components; ++c) {
        float u[3];
        for (std::size_t i = 0; i < 3; ++i) u[i] = in.values[vertex_index(draw_, position, i) * stride_of(in) + c];
        out.values[s * out.components + c] = triangle_.attribute(p, u, in.interpolation, &rungs_);
      }
    }
  }

  // Attributes are evaluated once per pixel (M1).
  void copy_shading(std::size_t from, std::size_t to) {
    if (!target_.barycentrics.empty()) {
      for (std::size_t i = 0; i < 3; ++i) target_.barycentrics[3 * to + i] = target_.barycentrics[3 * from + i];
    }
    for (const AttributeTarget& out : target_.attributes) {
      if (out.values.empty()) continue;
      for (std::size_t c = 0; c < out.components; ++c) {
        out.values[to * out.components + c] = out.values[from * out.components + c];
      }
    }
  }

  const Target& target_;
  const Draw& draw_;
  float* depth_;
  std::uint32_t* winner_;
  Rungs& rungs_;
  TieShift shift_;
  SamplePosition offset_[16];       // of the samples of a pixel
  double least_ = 1, largest_ = 0;  // of their coordinates
  ExactDraw triangle_;
};

// The empty image (V1), without depth.
void clear(const Target& target) {
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::fill(target.index.begin(), target.index.end(), kNoTriangle);
  std::fill(target.barycentrics.begin(), target.barycentrics.end(), 0.0f);
  for (const AttributeTarget& attribute : target.attributes) {
    std::fill(attribute.values.begin(), attribute.values.end(), 0.0f);
  }
}

void clear_depth(const Target& target, float* depth, std::size_t total) {
  if (target.initial_depth.empty()) {
    std::fill(depth, depth + total, empty_depth(target.depth_test));
  } else if (target.initial_depth.data() != depth) {
    std::memcpy(depth, target.initial_depth.data(), total * sizeof(float));
  }
}

}  // namespace

Status render(const Target& target, std::span<const Draw> draws, Rungs& rungs) noexcept {
  const Wanted wanted = wanted_outputs(target);
  const std::size_t total = sample_total(target);
  std::unique_ptr<float[]> own_depth;
  std::unique_ptr<std::uint32_t[]> winner;
  float* depth = nullptr;
  if (wanted.depth) {
    depth = target.depth.data();
    if (target.depth.empty()) {
      own_depth.reset(new (std::nothrow) float[total]);
      depth = own_depth.get();
    }
    winner.reset(new (std::nothrow) std::uint32_t[total]);
    if (depth == nullptr || winner == nullptr) return Status::out_of_memory;
    clear_depth(target, depth, total);
  }
  clear(target);
  for (const Draw& draw : draws) {
    if (winner != nullptr) std::fill(winner.get(), winner.get() + total, kNoTriangle);
    DrawRenderer renderer(target, draw, depth, winner.get(), rungs);
    renderer.rasterize();
    if (wanted.visibility) renderer.shade(wanted.shading);
  }
  return Status::ok;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Rungs& rungs) noexcept {
  for (int n = 0; n < target.samples; ++n) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      DrawRenderer(target, draws[d], nullptr, nullptr, rungs).visit(static_cast<std::uint32_t>(d), n, visitor);
    }
  }
  return Status::ok;
}

}  // namespace surefill::reference
