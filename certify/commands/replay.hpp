// SPDX-License-Identifier: Apache-2.0
//
// Both answers to one scene, sample by sample.
#ifndef SUREFILL_CERTIFY_REPLAY_HPP
#define SUREFILL_CERTIFY_REPLAY_HPP

#include <string>

#include "certify/rivals/rival_cases.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

struct ReplayOptions {
  const RivalSubject* subject = nullptr;  // a rival in the engine's place, judged as the checks judge it
  bool all = false;                       // every sample, not those alone that differ
  bool second_oracle = false;             // the second oracle in the engine's place
};

// What a replay says, and whether the two are equal. Throws SceneError for points and lines.
struct Replay {
  bool equal = true;
  std::string text;
};
Replay replay(const corpus::Scene& scene, const std::string& name, const ReplayOptions& options);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPLAY_HPP
