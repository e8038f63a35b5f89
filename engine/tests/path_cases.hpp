// SPDX-License-Identifier: Apache-2.0
//
// Frames that aim at the fast path: whatever it draws, the scalar reference path draws, too, bit for bit. Every output
// is asked for alone and with others; buffers hold rubbish before.
#ifndef SUREFILL_PROPERTIES_PATH_CASES_HPP
#define SUREFILL_PROPERTIES_PATH_CASES_HPP

#include <cstdint>
#include <span>
#include <string>

#include "corpus/scene.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/surefill.hpp"

namespace surefill::properties {

struct PathScene {
  corpus::Scene scene;
  corpus::Outputs outputs;
  int threads = 1;
  bool streams = false;         // its coverage is streamed, too
  bool executor = false;        // the caller's, of one thread
  bool alone = false;           // no thread can be started
  bool in_place = false;        // the depth buffer holds the initial depth, where there are both
  bool interpolations = false;  // each draw has its own
  std::uint32_t wanted = ~0u;   // a bit for each attribute that the target asks for
};

struct PathCases {
  const char* name;      // "small", "tiles", ...
  const char* aims;      // one sentence
  std::uint64_t tested;  // so many of them by the test
  PathScene (*make)(std::uint64_t number);
};
std::span<const PathCases> all_path_cases();

// What a path makes of a case: hashes, or of the status that came instead.
struct PathResult {
  std::uint64_t hash = 0, stream = 0;  // of the image, and of coverage as it is streamed
  bool counts_agree = true;            // of the image and of the stream: of fragments, and of triangles
  std::size_t handed_out = 0;          // items, to the caller's executor
  Statistics statistics;
  Diagnostics diagnostics;
};
PathResult draw_path(const PathScene& of, const Options& options);

// What differs between the fast path and what the reference path made of the case; empty if nothing does.
std::string broken_path(const PathScene& of, const PathResult& reference);

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_PATH_CASES_HPP
