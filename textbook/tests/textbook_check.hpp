// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the textbook share: many cases on all cores, and the oracle's answer for one triangle.
#ifndef SUREFILL_PROPERTIES_TEXTBOOK_CHECK_HPP
#define SUREFILL_PROPERTIES_TEXTBOOK_CHECK_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "oracle/oracle.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::properties {

// Random scenes a property: SUREFILL_TEXTBOOK_SCENES, or so many. How often something must have been seen, so that a
// test is not empty, is a share of them.
inline std::uint64_t textbook_scenes(std::uint64_t usual) {
  const char* asked = std::getenv("SUREFILL_TEXTBOOK_SCENES");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : usual;
}

// Runs cases 0 .. count - 1 on all cores; a case returns what it found wrong, or nothing. The smallest finding is
// reported. A random case draws from a generator that its number seeds.
enum class Cases { random, corpus };
inline void for_each_case(std::uint64_t count, const std::function<std::string(std::uint64_t)>& decide,
                          Cases cases = Cases::random) {
  ASSERT_GT(count, 0u) << "no cases: SUREFILL_TEXTBOOK_SCENES is no number, or the corpus is empty";
  std::atomic<std::uint64_t> next{0}, findings{0};
  std::mutex mutex;
  std::uint64_t first = count;
  std::string finding;
  const auto work = [&] {
    for (std::uint64_t n = next++; n < count; n = next++) {
      const std::string found = decide(n);
      if (found.empty()) continue;
      ++findings;
      const std::lock_guard lock(mutex);
      if (n < first) first = n, finding = found;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned t = 1; t < std::max(1u, std::thread::hardware_concurrency()); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(findings, 0u) << "of " << count << " cases; case " << first << ": " << finding;
  if (std::getenv("SUREFILL_TEXTBOOK_SCENES") == nullptr) return;
  if (cases == Cases::random) {
    std::cout << "sampled, " << count << " cases, seeds 0 .. " << count - 1;
  } else {
    std::cout << "exhaustive over " << count << " cases of the corpus";
  }
  std::cout << ": " << findings << " differences" << std::endl;
}

// One triangle and how it is drawn, with the oracle's answers.
struct TriangleCase {
  std::array<Vertex, 3> vertices{};
  int width = 1, height = 1, samples = 1;
  FillRule rule = FillRule::top_left;

  bool all_finite() const { return finite(vertices[0]) && finite(vertices[1]) && finite(vertices[2]); }
  bool in_front() const { return vertices[0].w > 0 && vertices[1].w > 0 && vertices[2].w > 0; }

  Target target() const {
    Target t;
    t.width = width, t.height = height, t.samples = samples;
    return t;
  }
  Draw draw() const {
    static constexpr std::uint32_t kIndices[] = {0, 1, 2};
    Draw d;
    d.vertices = vertices, d.indices = kIndices, d.fill_rule = rule;
    return d;
  }

  std::vector<std::uint32_t> counts(Conservative conservative = Conservative::none,
                                    DepthMode mode = DepthMode::none) const {
    Target t = target();
    std::vector<std::uint32_t> count(sample_total(t));
    t.count = count;
    Draw d = draw();
    d.conservative = conservative, d.depth_mode = mode;
    oracle::render(t, {&d, 1});
    return count;
  }

  std::string text() const {
    corpus::Scene scene = triangle_scene(width, height, vertices);
    scene.samples = samples;
    scene.draws[0].fill_rule = rule;
    return "\n" + corpus::write_scene(scene);
  }
};

// Case n: the categories take turns; targets of up to `largest` pixels each way, all fill rules and, for one in four,
// samples.
inline TriangleCase random_triangle(std::uint64_t n, bool samples = true, int largest = 16) {
  Random random(n * 0x9E3779B97F4A7C15u + 1);
  TriangleCase c;
  c.width = random.between(1, largest), c.height = random.between(1, largest);
  if (samples && random.one_in(4)) c.samples = 1 << random.between(1, 4);
  c.rule = static_cast<FillRule>(random.below(8));
  c.vertices = category_of_case(n).triangle(random, c.width, c.height);
  return c;
}

// The element of a buffer of one sample a pixel.
inline std::size_t place(const TriangleCase& c, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width) + static_cast<std::size_t>(x);
}

// The triangles of the corpus, without what their draws do to them beyond the fill rule (and their samples, or one);
// targets of at most so many pixels.
inline std::vector<TriangleCase> corpus_triangles(std::int64_t largest_target, bool samples = true) {
  std::vector<TriangleCase> cases;
  for (const std::string& path : corpus::list_corpus(SUREFILL_CORPUS "/cases")) {
    const corpus::Scene scene = corpus::read_scene_file(path);
    const bool only_triangles = std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& d) {
      return d.primitive == Primitive::triangles;
    });
    if (!only_triangles || static_cast<std::int64_t>(scene.width) * scene.height > largest_target) continue;
    const corpus::Frame frame(scene, kCountOnly);
    for (const Draw& draw : frame.draws()) {
      if (draw.fill_rule > FillRule::northwards_west) continue;  // the techniques know C3's rules, and not C5's
      for (std::size_t t = 0; t < draw.indices.size() / 3; ++t) {
        TriangleCase c{{}, scene.width, scene.height, samples ? scene.samples : 1, draw.fill_rule};
        for (std::size_t i = 0; i < 3; ++i) c.vertices[i] = draw.vertices[draw.indices[3 * t + i]];
        cases.push_back(c);
      }
    }
  }
  return cases;
}

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_TEXTBOOK_CHECK_HPP
