// SPDX-License-Identifier: Apache-2.0
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "exact/bounds.hpp"
#include "exact/conservative.hpp"
#include "exact/grid.hpp"
#include "exact/triangle.hpp"

namespace surefill::reference {
namespace {

// What a caller asks for, in terms of work.
struct Wanted {
  bool visibility;  // who is seen: index, depth, barycentrics or attributes
  bool shading;     // barycentrics or attributes
};

Wanted wanted_outputs(const Target& target) {
  bool attributes = false;
  for (const AttributeTarget& attribute : target.attributes) attributes |= !attribute.values.empty();
  const bool shading = attributes || !target.barycentrics.empty();
  return {shading || !target.index.empty() || !target.depth.empty(), shading};
}

// Sample positions within a pixel.
struct SamplePattern {
  int count;
  SamplePosition offset[16];
  double least, largest;

  explicit SamplePattern(int samples) : count(samples), least(1), largest(0) {
    for (int n = 0; n < samples; ++n) {
      const SampleLocation location = sample_location(samples, n);
      offset[n] = {location.x / 16.0, location.y / 16.0};
      least = std::min({least, offset[n].x, offset[n].y});
      largest = std::max({largest, offset[n].x, offset[n].y});
    }
  }
};

bool all_finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

std::size_t stride_of(const AttributeArray& attribute) {
  return attribute.stride != 0 ? attribute.stride : attribute.components;
}

// B1: every number that the draw supplies for vertex v.
bool all_finite(const Draw& draw, std::uint32_t v) {
  if (!all_finite(draw.vertices[v])) return false;
  for (const AttributeArray& attribute : draw.attributes) {
    const float* values = &attribute.values[v * stride_of(attribute)];
    for (std::uint32_t c = 0; c < attribute.components; ++c) {
      if (!std::isfinite(values[c])) return false;
    }
  }
  return true;
}

std::uint32_t index_of(const Draw& draw, std::uint32_t position) {
  return draw.identifiers.empty() ? draw.first_index + position : draw.identifiers[position];
}

// Renders one draw: who covers, who is seen, and then what is seen.
class DrawRenderer {
 public:
  // `depth` and `winner` are null if visibility is not wanted. winner[s] is the position of the triangle of this draw
  // that is seen at sample s, or kNoTriangle; all kNoTriangle on entry.
  DrawRenderer(const Target& target, const Draw& draw, float* depth, std::uint32_t* winner, Statistics& statistics)
      : target_(target),
        draw_(draw),
        depth_(depth),
        winner_(winner),
        statistics_(statistics),
        pattern_(target.samples),
        shift_(tie_shift(draw.fill_rule)) {}

  void rasterize() {
    const PixelBox limits = region();
    const std::size_t triangles = draw_.indices.size() / 3;
    for (std::size_t t = 0; t < triangles; ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      const PixelBox box = prepare(position, limits);
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
          if (draw_.conservative == Conservative::none) {
            rasterize_pixel(position, x, y);
          } else {
            rasterize_square(x, y);
          }
        }
      }
    }
  }

  // The covered samples of number n, triangle by triangle, block by block.
  void visit(std::uint32_t number, int n, const CoverageVisitor& visitor) {
    const PixelBox limits = region();
    const std::size_t triangles = draw_.indices.size() / 3;
    for (std::size_t t = 0; t < triangles; ++t) {
      const auto position = static_cast<std::uint32_t>(t);
      const PixelBox box = prepare(position, limits);
      for (int by = box.y0 & ~7; by < box.y1; by += 8) {
        for (int bx = box.x0 & ~7; bx < box.x1; bx += 8) {
          CoverageBlock block{number, position, bx, by, n, 0};
          for (int y = std::max(by, box.y0); y < std::min(by + 8, box.y1); ++y) {
            for (int x = std::max(bx, box.x0); x < std::min(bx + 8, box.x1); ++x) {
              if (counts(x, y, n)) block.mask |= std::uint64_t{1} << (8 * (y - by) + (x - bx));
            }
          }
          if (block.mask != 0) visitor.visit(visitor.context, {&block, 1});
        }
      }
    }
  }

  // Writes index, barycentrics and attributes of every sample whose winner belongs to this draw.
  void shade(bool shading) {
    const std::size_t pixels = static_cast<std::size_t>(target_.width) * static_cast<std::size_t>(target_.height);
    const auto samples = static_cast<std::size_t>(pattern_.count);
    std::uint32_t holds = kNoTriangle;  // the triangle that was set up last
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const std::size_t first = pixel * samples;
      for (std::size_t s = first; s < first + samples; ++s) {
        const std::uint32_t position = winner_[s];
        if (position == kNoTriangle) continue;
        if (!target_.index.empty()) target_.index[s] = index_of(draw_, position);
        if (!shading) continue;
        if (s > first && winner_[s - 1] == position) {
          copy_shading(s - 1, s);
          continue;
        }
        if (position != holds) set_up(position, unused_);
        holds = position;
        const auto width = static_cast<std::size_t>(target_.width);
        shade_sample(position, shading_position(static_cast<double>(pixel % width), static_cast<double>(pixel / width)),
                     s);
      }
    }
  }

 private:
  const Vertex& corner(std::uint32_t position, std::size_t i) const {
    return draw_.vertices[draw_.indices[std::size_t{3} * position + i]];
  }

  // Target and scissor.
  PixelBox region() const {
    PixelBox limits{0, 0, target_.width, target_.height};
    if (draw_.scissor) {
      limits = {std::max(limits.x0, draw_.scissor->x0), std::max(limits.y0, draw_.scissor->y0),
                std::min(limits.x1, draw_.scissor->x1), std::min(limits.y1, draw_.scissor->y1)};
      if (limits.empty()) limits = {};
    }
    return limits;
  }

  // Sets up a triangle and counts it. Returns the pixels that it may cover; none if it is not to be drawn.
  PixelBox prepare(std::uint32_t position, const PixelBox& limits) {
    constexpr PixelBox kNone{0, 0, 0, 0};
    ++statistics_.triangles;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!all_finite(draw_, draw_.indices[std::size_t{3} * position + i])) {
        ++statistics_.dropped;
        return kNone;
      }
    }
    if (!set_up(position, statistics_)) {
      ++statistics_.degenerate;
      return kNone;
    }
    if (!draw_.grid && culls(triangle_.determinant())) {  // under Grid, facing is a matter of the sample (G1)
      ++statistics_.culled;
      return kNone;
    }
    const PixelBox box = limits.empty() ? kNone : box_within(position, limits);
    if (box.empty()) {
      ++statistics_.outside;
      return kNone;
    }
    ++statistics_.rasterized;
    return box;
  }

  // Is sample n of the pixel counted (M2)?
  bool counts(int x, int y, int n) {
    if (draw_.conservative != Conservative::none) return square_counts(x, y);
    const SamplePosition p{x + pattern_.offset[n].x, y + pattern_.offset[n].y};
    float z;
    if (draw_.grid) {
      const int facing = snapped_.winding(p, shift_);
      return facing != 0 && !culls(facing) &&
             (draw_.depth_mode != DepthMode::clip || snapped_.depth(p, draw_.depth_mode, &z, statistics_));
    }
    return triangle_.covers(p, shift_, statistics_) &&
           (draw_.depth_mode != DepthMode::clip || triangle_.depth(p, draw_.depth_mode, &z, statistics_));
  }

  // M4.
  bool square_counts(int x, int y) {
    const PixelSquare square(triangle_, x, y, statistics_);
    return draw_.conservative == Conservative::over ? square.touched() : square.inside();
  }

  // False if the triangle covers nothing by C1 or, under Grid, by G1.
  bool set_up(std::uint32_t position, Statistics& statistics) {
    const Vertex &v0 = corner(position, 0), &v1 = corner(position, 1), &v2 = corner(position, 2);
    return draw_.grid ? snapped_.set_up(v0, v1, v2, *draw_.grid, statistics) : triangle_.set_up(v0, v1, v2, statistics);
  }

  // The pixels of `limits` that the triangle can cover; empty if it has none.
  PixelBox box_within(std::uint32_t position, const PixelBox& limits) const {
    if (draw_.grid) return snapped_.box(limits, pattern_.least, pattern_.largest);
    const bool squares = draw_.conservative != Conservative::none;
    return screen_box(corner(position, 0), corner(position, 1), corner(position, 2), limits,
                      squares ? 0 : pattern_.least, squares ? 1 : pattern_.largest);
  }

  // F2; `facing` has the sign of D, or of N(p).
  bool culls(int facing) const {
    const bool front = (facing > 0) == (draw_.front_face == FrontFace::clockwise);
    return draw_.cull == (front ? Cull::front : Cull::back);
  }

  std::size_t first_sample(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(pattern_.count);
  }

  void rasterize_pixel(std::uint32_t position, int x, int y) {
    std::size_t s = first_sample(x, y);
    for (int n = 0; n < pattern_.count; ++n, ++s) {
      const SamplePosition p{x + pattern_.offset[n].x, y + pattern_.offset[n].y};
      if (draw_.grid) {
        const int facing = snapped_.winding(p, shift_);
        if (facing != 0 && !culls(facing)) fragment(position, p, s);
      } else if (triangle_.covers(p, shift_, statistics_)) {
        fragment(position, p, s);
      }
    }
  }

  // M4. Such frames have counts alone and one sample a pixel.
  void rasterize_square(int x, int y) {
    if (!target_.count.empty() && square_counts(x, y)) ++target_.count[first_sample(x, y)];
  }

  // A covered sample: depth clip, count, depth test.
  void fragment(std::uint32_t position, SamplePosition p, std::size_t s) {
    float z = 0;
    if (winner_ != nullptr || draw_.depth_mode == DepthMode::clip) {
      const bool kept = draw_.grid ? snapped_.depth(p, draw_.depth_mode, &z, statistics_)
                                   : triangle_.depth(p, draw_.depth_mode, &z, statistics_);
      if (!kept) return;
    }
    if (!target_.count.empty()) ++target_.count[s];
    if (winner_ == nullptr || !passes(position, z, s)) return;
    winner_[s] = position;
    if (draw_.depth_write) depth_[s] = z;
  }

  // V1 and M5. Among equal indices the first position wins with depth write on, the last with depth write off.
  bool passes(std::uint32_t position, float z, std::size_t s) const {
    const bool nearer = target_.depth_test == DepthTest::less ? z < depth_[s] : z > depth_[s];
    if (winner_[s] == kNoTriangle) return nearer;
    if (!draw_.depth_write) return nearer && index_of(draw_, position) >= index_of(draw_, winner_[s]);
    return nearer || (z == depth_[s] && index_of(draw_, position) < index_of(draw_, winner_[s]));
  }

  // Where the attributes of pixel (x, y) are taken (M1).
  SamplePosition shading_position(double x, double y) {
    const SamplePosition centre{x + 0.5, y + 0.5};
    if (pattern_.count == 1) return centre;
    if (target_.attribute_location == AttributeLocation::centre && has_values(centre)) return centre;
    if (covers(centre)) return centre;
    for (int n = 0; n < pattern_.count; ++n) {
      const SamplePosition p{x + pattern_.offset[n].x, y + pattern_.offset[n].y};
      if (covers(p)) return p;
    }
    return centre;  // not reached: the triangle is seen at a sample of this pixel
  }

  bool covers(SamplePosition p) {
    return draw_.grid ? snapped_.winding(p, shift_) != 0 : triangle_.covers(p, shift_, unused_);
  }

  bool has_values(SamplePosition p) {
    return draw_.grid ? snapped_.has_weights(p, unused_) : triangle_.plane_in_front(p);
  }

  float attribute(SamplePosition p, const float (&u)[3], Interpolation interpolation) {
    return draw_.grid ? snapped_.attribute(p, u, interpolation, statistics_)
                      : triangle_.attribute(p, u, interpolation, statistics_);
  }

  void shade_sample(std::uint32_t position, SamplePosition p, std::size_t s) {
    if (!target_.barycentrics.empty()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const float unit[3] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
        target_.barycentrics[3 * s + i] = attribute(p, unit, Interpolation::perspective);
      }
    }
    for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
      const AttributeTarget& out = target_.attributes[k];
      if (out.values.empty()) continue;
      const AttributeArray& in = draw_.attributes[k];
      const std::size_t stride = stride_of(in);
      for (std::size_t c = 0; c < out.components; ++c) {
        float u[3];
        for (std::size_t i = 0; i < 3; ++i) u[i] = in.values[draw_.indices[std::size_t{3} * position + i] * stride + c];
        out.values[s * out.components + c] = attribute(p, u, in.interpolation);
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
  Statistics& statistics_;
  Statistics unused_;  // for decisions made a second time
  SamplePattern pattern_;
  TieShift shift_;
  Triangle triangle_;        // what was set up last, without Grid
  SnappedTriangle snapped_;  // and with Grid
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
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (target.initial_depth.empty()) {
    std::fill(depth, depth + total, target.depth_test == DepthTest::less ? kInfinity : -kInfinity);
  } else if (target.initial_depth.data() != depth) {
    std::memcpy(depth, target.initial_depth.data(), total * sizeof(float));
  }
}

}  // namespace

Status render(const Target& target, std::span<const Draw> draws, Statistics& statistics) noexcept {
  const Wanted wanted = wanted_outputs(target);
  const std::size_t total = sample_total(target);
  std::unique_ptr<float[]> own_depth;
  std::unique_ptr<std::uint32_t[]> winner;
  float* depth = nullptr;
  if (wanted.visibility) {
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
    DrawRenderer renderer(target, draw, depth, winner.get(), statistics);
    renderer.rasterize();
    if (winner != nullptr && (wanted.shading || !target.index.empty())) renderer.shade(wanted.shading);
  }
  return Status::ok;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Statistics& statistics) noexcept {
  Statistics not_counted;
  for (int n = 0; n < target.samples; ++n) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      DrawRenderer(target, draws[d], nullptr, nullptr, n == 0 ? statistics : not_counted)
          .visit(static_cast<std::uint32_t>(d), n, visitor);
    }
  }
  return Status::ok;
}

}  // namespace surefill::reference
