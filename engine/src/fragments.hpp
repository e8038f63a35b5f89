// SPDX-License-Identifier: Apache-2.0
//
// What becomes of a sample that a triangle covers, by scalar exact arithmetic: counts, winding, numbers of triangles, the
// index of conservative frames, and the layers of those that are seen. Who covers is found out elsewhere: by the reference
// path, sample by sample, or by the fast path's stream of coverage.
#ifndef SUREFILL_SRC_FRAGMENTS_HPP
#define SUREFILL_SRC_FRAGMENTS_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "exact/exact_draw.hpp"
#include "facts.hpp"
#include "surefill/diagnostics.hpp"

namespace surefill {

// A covered sample: the triangle, by its position in the draw, the pixel of the target, the number of the sample and,
// where somebody looks at depth, what is stored of it.
struct Fragment {
  std::uint32_t position;
  int x, y, n;
  float z = 0;
};

// Who is seen at the samples of a frame, layer by layer (V4). Element n total + s is layer n of sample s. An empty place
// has no draw; its depth is the initial one (V1).
class Layers {
 public:
  static constexpr std::uint32_t kNoDraw = 0xFFFFFFFFu;

  // False where memory is lacking. `named`: somebody looks at who is seen, and not at the depth alone.
  bool allocate(const Target& target, bool named);

  std::size_t size() const { return layers_ * total_; }
  std::size_t total() const { return total_; }
  float depth(std::size_t place) const { return depth_[place]; }
  // kNoDraw where nobody looks at who is seen.
  std::uint32_t draw(std::size_t place) const { return draw_ != nullptr ? draw_[place] : kNoDraw; }
  std::uint32_t position(std::size_t place) const { return position_[place]; }

  void put(std::size_t place, std::uint32_t draw, std::uint32_t position) {
    if (draw_ != nullptr) draw_[place] = draw, position_[place] = position;
  }
  // Puts a fragment into the only layer there is.
  void replace(std::size_t place, std::uint32_t draw, std::uint32_t position, float z) {
    put(place, draw, position);
    depth_[place] = z;
  }
  // Puts a fragment into a place; what was there, and behind it, moves one layer back.
  void insert(std::size_t place, std::uint32_t draw, std::uint32_t position, float z);

 private:
  std::size_t total_ = 0, layers_ = 1;
  float* depth_ = nullptr;
  std::unique_ptr<float[]> own_depth_;
  std::unique_ptr<std::uint32_t[]> draw_, position_;
};

// The fragments of one draw, whose triangles come in order at each sample. Of one thread; several may work on different
// samples of a draw.
class DrawFragments {
 public:
  // `layers` is null if nobody looks at depth.
  DrawFragments(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers, Rungs& rungs)
      : target_(target),
        draw_(draw),
        number_(number),
        layers_(layers),
        rungs_(rungs),
        shift_(tie_shift(draw.fill_rule)),
        depth_alone_(layers != nullptr && target.layers == 1 && draw.depth_write && draw.identifiers.empty() &&
                     !takes_equal(target.depth_test) && target.count.empty() && target.winding.empty() &&
                     draw.covered.empty()),
        triangle_(target.origin) {}

  // The draw's exact triangles, of which one is in use, and its number in the frame.
  ExactDraw& triangle() { return triangle_; }
  std::uint32_t number() const { return number_; }

  // M2, of the triangle in use: covered, not culled, and not removed by depth clipping. Finds out the depth, where somebody
  // looks at it.
  bool counts(Fragment& f);
  // What is left of that where M2 but for M4a is known to hold.
  bool counts_of_covered(Fragment& f);
  // Counts it, and sees who is in front.
  void take(const Fragment& f) {
    if (!depth_alone_) return take_all(f);
    const std::size_t s = sample_index(target_, f.x, f.y, static_cast<std::size_t>(f.n));
    const float there = layers_->depth(s);
    if (is_reversed(target_.depth_test) ? f.z > there : f.z < there) layers_->replace(s, number_, f.position, f.z);
  }

  // Writes barycentrics and attributes of a triangle that is seen in pixel (x, y) of the target, to a place of the outputs.
  void shade(std::uint32_t position, int x, int y, std::size_t place);

 private:
  void take_all(const Fragment& f);
  SamplePosition place_of(const Fragment& f) const {
    return place_of_sample(target_, target_.origin.x + f.x, target_.origin.y + f.y, f.n);
  }
  void see(const Fragment& f, std::size_t s);
  bool passes(float z, std::size_t place) const;
  bool precedes(const Fragment& f, std::size_t place) const;
  // Of a place that has a triangle of this draw.
  std::uint32_t index_at(std::size_t place) const { return index_of(draw_, layers_->position(place)); }

  const Target& target_;
  const Draw& draw_;
  std::uint32_t number_;
  Layers* layers_;
  Rungs& rungs_;
  TieShift shift_;
  bool depth_alone_;  // nothing counts fragments, and one that comes later is seen only if it is nearer
  ExactDraw triangle_;
};

// A frame before and after its fragments.
class FragmentFrame {
 public:
  FragmentFrame(const Target& target, std::span<const Draw> draws);

  // Memory, and the empty image (V1). False where memory is lacking: then nothing is written.
  bool begin();
  // Null if nobody looks at depth.
  Layers* layers() { return seen_ ? &layers_ : nullptr; }
  // Writes what the fragments have made: index, barycentrics, attributes, visible numbers.
  void finish(Rungs& rungs);

 private:
  void show(std::uint32_t number, Rungs& rungs);

  const Target& target_;
  std::span<const Draw> draws_;
  Wanted wanted_;
  bool visible_ = false, seen_ = false;
  Layers layers_;
};

}  // namespace surefill

#endif  // SUREFILL_SRC_FRAGMENTS_HPP
