// SPDX-License-Identifier: Apache-2.0
//
// Which model a rasterizer follows (section 11): from its table of turns, axis by axis (axes.hpp), then the place of its
// samples (places.hpp), then who owns edges (owners.hpp); all of it is tried on other triangles.
#ifndef SUREFILL_CERTIFY_JUDGE_INFERENCE_HPP
#define SUREFILL_CERTIFY_JUDGE_INFERENCE_HPP

#include <optional>
#include <string>
#include <vector>

#include "certify/judge/turns.hpp"

namespace surefill::judge {

// What probing said. Where `known`, the model explains every probe; else all that is owed is R13.
struct Inference {
  Model model;
  bool known = false;
  bool exact_values = false;  // every flat depth came back as it was given, to the bit
  bool offscreen = true;      // it takes vertices beside the target
  std::vector<Turn> turns;
  std::string shape;                  // what the table of turns says at a glance, if that is no sample's: a sentence
  std::vector<std::string> open;      // what could not be found out, and why: no findings
  std::vector<std::string> problems;  // what no model explains: findings, one sentence each
  std::vector<std::string> line_problems;  // of lines and points, what no standard allows: the same
};

// All triangles have W > 0. `declared` is preferred among models that explain the probes alike. Throws Failure; what is
// declined is noted in `open`.
Inference infer(Rival& rival, const Expected& expected, const std::optional<Model>& declared);

// The model with its samples within d pixels of where they should be, and nothing else known: R13.
Model least_known_model();

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_INFERENCE_HPP
