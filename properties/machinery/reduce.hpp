// SPDX-License-Identifier: Apache-2.0
//
// From a failing scene to a minimal one: fewer draws and triangles, a smaller target, simpler state, simpler numbers.
// RapidCheck shrinks with the same steps.
#ifndef SUREFILL_PROPERTIES_REDUCE_HPP
#define SUREFILL_PROPERTIES_REDUCE_HPP

#include <chrono>
#include <functional>
#include <vector>

#include "corpus/scene.hpp"

namespace surefill::properties {

// Scenes one step simpler than this one, boldest first; finite chains only (each step makes the scene smaller in a
// well-founded order, so no cycle is possible). All are valid scenes.
std::vector<corpus::Scene> simpler_scenes(const corpus::Scene& scene);

struct ReduceLimits {
  std::chrono::milliseconds time{20000};
};

// Takes simpler scenes as long as `still_fails` says true; the result fails and, unless time ran out, no simpler scene
// does. `scene` itself fails (precondition).
corpus::Scene reduce(corpus::Scene scene, const std::function<bool(const corpus::Scene&)>& still_fails,
                     const ReduceLimits& limits = {});

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_REDUCE_HPP
