// SPDX-License-Identifier: Apache-2.0
//
// The fast path against the reference path: surefill_frames N SEED draws N random scenes, in every mode and of every
// category in turn, on both, and compares all outputs. Exit 0: no difference; 1: some.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "corpus/hash.hpp"
#include "corpus/scene.hpp"
#include "properties/generators/generators.hpp"
#include "surefill/surefill.hpp"

int main(int argc, char** argv) {
  using namespace surefill;
  if (argc != 3) return std::fputs("usage: surefill_frames N SEED\n", stderr), 2;
  const auto frames = std::strtoull(argv[1], nullptr, 10), first = std::strtoull(argv[2], nullptr, 10);
  const auto categories = properties::categories();
  unsigned long long differences = 0;
  for (unsigned long long n = 0; n < frames; ++n) {
    const properties::Category& category = categories[n % categories.size()];
    const unsigned long long seed = first + n / categories.size();
    constexpr int kSize = 80, kTriangles = 8;  // more than one tile
    const corpus::Scene scene = properties::mixed_scene(category, seed, kSize, kTriangles);
    Options options;
    options.threads = 1 + static_cast<int>(n % 2);
    const std::string fast = corpus::hash_of(scene, options);
    options = {};
    options.path = Path::reference;
    if (corpus::hash_of(scene, options) == fast) continue;
    if (differences++ == 0) std::printf("%s", corpus::write_scene(scene).c_str());
    std::printf("%s, seed %llu: the paths differ\n", category.name, seed);
  }
  std::printf("sampled %llu frames, seed %llu: %llu differences\n", frames, first, differences);
  return frames > 0 && differences == 0 ? 0 : 1;
}
