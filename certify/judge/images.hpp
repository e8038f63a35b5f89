// SPDX-License-Identifier: Apache-2.0
//
// An image held to a model: R1 to R12, sample by sample.
#ifndef SUREFILL_CERTIFY_JUDGE_IMAGES_HPP
#define SUREFILL_CERTIFY_JUDGE_IMAGES_HPP

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "certify/judge/rival.hpp"

namespace surefill::judge {

// How a rasterizer is judged: its model, and what it takes from the draws instead.
struct Terms {
  Model model;
  bool known = false;           // else `model` is the least known one (R13)
  bool draws_own_rule = false;  // its fill rule is each draw's
  bool draws_own_grid = false;
  bool rounds_slanted = false;  // ties on slanted edges are open: R6
  bool counts_seen = false;     // counts are those of what is seen when each triangle is drawn alone
};

// The largest error of a kind of value: in ULP, and as a share of what is granted.
struct Deviation {
  double ulp = 0, granted = 0;
  void take(const Deviation& other) {
    ulp = std::max(ulp, other.ulp);
    granted = std::max(granted, other.granted);
  }
};
struct Deviations {
  Deviation depth, barycentrics, attributes;
  void take(const Deviations& other) {
    depth.take(other.depth);
    barycentrics.take(other.barycentrics);
    attributes.take(other.attributes);
  }
};

// A frame as the engine's types have it. The frame is valid.
struct Frame {
  int width = 0, height = 0, samples = 1;
  DepthTest depth_test = DepthTest::less;
  bool initial_depth = false;
  std::span<const Draw> draws;
  std::span<const float> before = {};  // initial depth, of each sample; empty: not known
};

// R1: the counts that are right, for each sample.
struct Counts {
  std::vector<std::uint32_t> least, most;
  // The triangles that may cover a sample: from last[sample] on, a list. kNone ends it.
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Link {
    std::uint32_t which, before;
  };
  std::vector<Link> links;
  std::vector<std::uint32_t> last;

  std::uint64_t judged() const;
};

// Why the frame is not judged under these terms, or empty: conservative draws, numbers out of range, and the like.
std::string why_open(const Terms& terms, const Frame& frame);

// The model of one draw of the frame.
Model model_of_draw(const Terms& terms, const Frame& frame, const Draw& draw);

Counts counts_under(const Expected& expected, const Terms& terms, const Frame& frame);

// What came of one image.
struct Judgement {
  std::uint64_t samples = 0;      // judged
  std::uint64_t open = 0;         // not
  std::uint64_t differences = 0;  // of the judged ones
  Deviations deviations;
  std::string finding;                // the first difference, in words; empty if there is none
  std::size_t sample = 0;             // where it is
  std::vector<std::uint8_t> differs;  // of each sample
  struct Value {
    std::size_t sample;
    std::string output, expected, actual;  // as in `finding`
    double error;                          // how far it is from what is granted; HUGE_VAL: it is no number
  };
  std::vector<Value> values;          // what differs first at each of these
  std::vector<std::uint32_t> least;   // R1's c of each sample
  std::vector<std::uint8_t> unknown;  // 1 where the count is open
};

struct Looks {
  bool counts = true, values = true;
};

// Counts; where R12 says who is visible, its index, depth, barycentrics and attributes; elsewhere, at open samples too, R13's
// ranges of what is visible. `names` are the attributes'.
Judgement judge_image(const Expected& expected, const Terms& terms, const Frame& frame, const corpus::Image& image,
                      const Looks& looks, std::span<const corpus::SceneAttribute> names);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_IMAGES_HPP
