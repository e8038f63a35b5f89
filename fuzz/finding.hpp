// SPDX-License-Identifier: Apache-2.0
//
// How a target reports a violated relation: what did not hold, the scene to paste, the command that replays it; then
// abort.
#ifndef SUREFILL_FUZZ_FINDING_HPP
#define SUREFILL_FUZZ_FINDING_HPP

#include <cstdio>
#include <cstdlib>
#include <string>

#include "corpus/scene.hpp"

namespace surefill::fuzz {

// Findings become scenes: with SUREFILL_FUZZ_SCENE=FILE in the environment, the scene of the input goes there before
// the engine sees it, so that a crash has its scene, too. `scene` makes it.
template <typename MakeScene>
void note_scene(MakeScene scene) {
  static const char* const file = std::getenv("SUREFILL_FUZZ_SCENE");
  if (file != nullptr) corpus::write_scene_file(scene(), file);
}

[[noreturn]] inline void report_finding(const char* target, const std::string& relation, const std::string& text = {}) {
  std::fprintf(stderr, "\n%s: %s\n", target, relation.c_str());
  if (!text.empty()) std::fprintf(stderr, "---- begin\n%s---- end\n", text.c_str());
  std::fprintf(stderr, "to replay it: %s_replay INPUT, where INPUT is the file named below or after \"replaying\"\n",
               target);
  std::fflush(stderr);
  std::abort();
}

}  // namespace surefill::fuzz

#endif  // SUREFILL_FUZZ_FINDING_HPP
