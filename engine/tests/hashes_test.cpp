// SPDX-License-Identifier: Apache-2.0
//
// The same bits on every machine: a hash of every output of every scene of the corpus, and of random scenes of several
// tiles from each category, on every instruction set, on one and two threads, is the one in corpus/hashes.txt. After a
// change of the rules or of the scenes: SUREFILL_RECORD_HASHES=1 surefill_tests --gtest_filter='Hashes*'.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "corpus/hash.hpp"
#include "corpus/scene.hpp"
#include "properties/generators/hashed_scenes.hpp"
#include "surefill/surefill.hpp"

#if !defined(SUREFILL_REFERENCE_ONLY)
#include "hwy/targets.h"
#endif

namespace surefill::properties {
namespace {

// By name: the corpus, and three random scenes of each category.
std::map<std::string, corpus::Scene> scenes() {
  std::map<std::string, corpus::Scene> all;
  const std::filesystem::path root = SUREFILL_CORPUS "/cases";
  for (const std::string& path : corpus::list_corpus(root.string())) {
    corpus::Scene scene = corpus::read_scene_file(path);
    try {
      const corpus::Frame frame(scene);
    } catch (const corpus::SceneError&) {
      continue;  // points or lines
    }
    all[std::filesystem::relative(path, root).generic_string()] = std::move(scene);
  }
  for_each_hashed_scene([&](const std::string& name, const corpus::Scene& scene) { all[name] = scene; });
  return all;
}

const char* const kFile = SUREFILL_CORPUS "/hashes.txt";

std::map<std::string, std::string> recorded() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(kFile);
  std::string hash, name;
  while (file >> hash >> name) hashes[name] = hash;
  return hashes;
}

TEST(Hashes, AreTheRecordedOnes) {
  const auto all = scenes();
  if (std::getenv("SUREFILL_RECORD_HASHES") != nullptr) {
    std::ofstream file(kFile);
    for (const auto& [name, scene] : all)
      file << corpus::hash_of(scene, {.path = Path::reference}) << ' ' << name << '\n';
    return;
  }
  const auto expected = recorded();
  ASSERT_FALSE(expected.empty()) << kFile << " is missing or empty";
  for (const auto& [name, hash] : expected) EXPECT_TRUE(all.contains(name)) << "no scene any more: " << name;
  const auto check = [&](const Options& options, const std::string& where) {
    for (const auto& [name, scene] : all) {
      const auto found = expected.find(name);
      ASSERT_NE(found, expected.end()) << "no hash of " << name;
      EXPECT_EQ(corpus::hash_of(scene, options), found->second) << name << " " << where;
    }
  };
  check({.path = Path::reference}, "on the reference path");
#if !defined(SUREFILL_REFERENCE_ONLY)
  for (std::int64_t bits = hwy::SupportedTargets() & HWY_TARGETS; bits != 0; bits &= bits - 1) {
    const std::int64_t target = bits & -bits;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (const int threads : {1, 2}) {
      check({.threads = threads},
            std::string("on ") + hwy::TargetName(target) + ", threads " + std::to_string(threads));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
#endif
}

}  // namespace
}  // namespace surefill::properties
