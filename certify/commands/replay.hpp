// SPDX-License-Identifier: Apache-2.0
//
// Both answers to one scene, sample by sample.
#ifndef SUREFILL_CERTIFY_REPLAY_HPP
#define SUREFILL_CERTIFY_REPLAY_HPP

#include <string>

#include "certify/rivals/rival.hpp"
#include "corpus/scene.hpp"

namespace surefill::certify {

struct ReplayOptions {
  adapters::Rival* rival = nullptr;  // in the engine's place, with the oracle under its model
  bool all = false;                  // every sample, not those alone that differ
  bool second_oracle = false;        // the second oracle in the engine's place
};

// What a replay says, and whether the two are equal. Throws SceneError for points and lines.
struct Replay {
  bool equal = true;
  std::string text;
};
Replay replay(const corpus::Scene& scene, const std::string& name, const ReplayOptions& options);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_REPLAY_HPP
