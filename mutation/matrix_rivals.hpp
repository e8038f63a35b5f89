// SPDX-License-Identifier: Apache-2.0
//
// The zoo through the public door: each of its rasterizers is a rival behind its plugin, and certify has to tell.
#ifndef SUREFILL_MUTATION_MATRIX_RIVALS_HPP
#define SUREFILL_MUTATION_MATRIX_RIVALS_HPP

#include <functional>
#include <string>
#include <vector>

#include "certify/run/checks.hpp"

namespace surefill::mutation {

struct ZooRivalOptions {
  std::string plugin;             // libsurefill_zoo.so
  std::vector<std::string> only;  // names with * and ?; empty: all
  certify::Settings settings;     // level, seed, corpus
  bool undeclared = false;        // they say nothing of their model
  int jobs = 1;
};

// Certifies all of them, a specimen until its first finding; prints a line for each. True if every specimen has a
// finding and no right rasterizer has one.
bool zoo_rivals(const ZooRivalOptions& options, const std::function<void(const std::string&)>& print);

}  // namespace surefill::mutation

#endif  // SUREFILL_MUTATION_MATRIX_RIVALS_HPP
