// SPDX-License-Identifier: Apache-2.0
//
// The two sides of a judgement. The judge is a library: it infers, judges and names over these interfaces alone,
// without an oracle, files, processes or printing, so that it runs wherever both sides can be had.
#ifndef SUREFILL_CERTIFY_JUDGE_RIVAL_HPP
#define SUREFILL_CERTIFY_JUDGE_RIVAL_HPP

#include <array>
#include <optional>
#include <stdexcept>
#include <vector>

#include "corpus/scene.hpp"
#include "oracle/model.hpp"

namespace surefill::judge {

using oracle::Cover;
using oracle::Model;

// The rival did what no rasterizer may: crashed, hung, ended, answered nonsense. what() is one line: a finding.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// This frame is none for this rival: it lacks a feature, or says so. No finding (R15).
class Declined : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The rasterizer under judgement.
class Rival {
 public:
  virtual ~Rival() = default;
  // Outputs that it has: the others of an answer are empty, but for a count that may be made up.
  virtual corpus::Outputs outputs() const = 0;
  // The smallest distance, in pixels, between two positions that it can be given in a target of 64 pixels; 0: float32's.
  virtual double position_step() const = 0;
  // What it draws beside triangles, and whether that may have a width.
  struct Primitives {
    bool lines = false, points = false, widths = false;
  };
  virtual Primitives primitives() const { return {}; }
  // The image of a scene without viewports, with those outputs of `wanted` that it has. Throws Failure, Declined.
  virtual corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) = 0;
};

// What a model says (section 11): oracle::cover, cover_line, cover_point and may_turn, or anything equal to them.
class Expected {
 public:
  virtual ~Expected() = default;
  virtual std::vector<Cover> cover(const Model& model, int width, int height, int samples,
                                   const std::array<Vertex, 3>& triangle) const = 0;
  virtual std::vector<Cover> cover_line(const Model& model, int width, int height, const std::array<Vertex, 2>& ends,
                                        std::optional<float> line_width) const = 0;
  virtual std::vector<Cover> cover_point(const Model& model, int width, int height, const Vertex& vertex,
                                         float size) const = 0;
  virtual bool may_turn(const Model& model, int width, int height, const std::array<Vertex, 3>& triangle) const = 0;
};

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_RIVAL_HPP
