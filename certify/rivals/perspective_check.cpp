// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/perspective_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "certify/rivals/profile.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;

struct Size {
  int width, height;
};
// What drivers draw in an instant would take a rasterizer that looks at all samples for each triangle minutes.
constexpr Size kLarge{1920, 1080}, kSmall{480, 270};

Size size_for(const adapters::Rival& rival) {
  return rival.info().form == SUREFILL_ADAPTER_FORM_CLIP ? kLarge : kSmall;
}

// Corners of quads are this far apart and moved by up to a quarter of it, so that every triangle stays several pixels
// high: no snapping to a grid of 4 bits or more turns one over.
constexpr int kCell = 24, kMoved = 6;

// Quads all over the target and beyond, cut along one diagonal or the other. W differs from vertex to vertex and is no
// power of two, so X/W is rounded by whoever divides; neighbours share the rounded vertex.
Scene perspective_mesh(std::uint64_t seed, const Size& size) {
  properties::Random random(seed);
  Scene scene;
  scene.width = size.width;
  scene.height = size.height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  const int columns = size.width / kCell + 3, rows = size.height / kCell + 3;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const auto w = static_cast<float>(1 + 15 * random.unit());
      const double x = (i - 1) * kCell + kMoved * (2 * random.unit() - 1);
      const double y = (j - 1) * kCell + kMoved * (2 * random.unit() - 1);
      draw.vertices.push_back({static_cast<float>(x * w), static_cast<float>(y * w), w / 2, w, {}});
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
      const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(columns) + 1, d = c + 1;
      if (random.one_in(2)) {
        draw.triangles.push_back({{a, b, c}, std::nullopt});
        draw.triangles.push_back({{c, b, d}, std::nullopt});
      } else {
        draw.triangles.push_back({{a, b, d}, std::nullopt});
        draw.triangles.push_back({{a, d, c}, std::nullopt});
      }
    }
  }
  return scene;
}

std::vector<std::uint32_t> counts_of(adapters::Rival& rival, const Scene& scene) {
  corpus::Frame frame(scene, {true, false, false, false, false});
  rival.draw(frame.target(), frame.draws());
  return frame.image().count;
}

std::string found_at(const Scene& scene, std::size_t sample, std::uint32_t count) {
  const auto width = static_cast<std::size_t>(scene.width);
  return fmt::format("count of a tiling at pixel ({}, {}): expected 1, got {}", sample % width, sample / width, count);
}

// The triangles within two pixels of the sample, by their boxes.
Scene near_sample(const Scene& scene, std::size_t sample) {
  Scene part = scene;
  corpus::SceneDraw& draw = part.draws[0];
  const auto width = static_cast<std::size_t>(scene.width);
  const double x = static_cast<double>(sample % width) + 0.5, y = static_cast<double>(sample / width) + 0.5;
  std::erase_if(draw.triangles, [&](const corpus::SceneTriangle& triangle) {
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (const std::uint32_t v : triangle.vertices) {
      const corpus::SceneVertex& p = draw.vertices[v];
      x0 = std::min(x0, static_cast<double>(p.x) / p.w);
      x1 = std::max(x1, static_cast<double>(p.x) / p.w);
      y0 = std::min(y0, static_cast<double>(p.y) / p.w);
      y1 = std::max(y1, static_cast<double>(p.y) / p.w);
    }
    return x < x0 - 2 || x > x1 + 2 || y < y0 - 2 || y > y1 + 2;
  });
  return part;
}

CaseResult whole_mesh(adapters::Rival& rival, std::uint64_t seed) {
  CaseResult result;
  const Scene scene = perspective_mesh(seed, size_for(rival));
  try {
    const std::vector<std::uint32_t> counts = counts_of(rival, scene);
    result.samples = counts.size();
    std::size_t uncovered = 0, first = counts.size();
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (counts[s] == 1) continue;
      ++result.differences;
      if (counts[s] == 0) ++uncovered;
      first = std::min(first, s);
    }
    if (result.differences == 0) return result;
    result.finding = fmt::format("{}; in this mesh {} samples are uncovered, {} are covered twice or more",
                                 found_at(scene, first, counts[first]), uncovered, result.differences - uncovered);
    result.scene = near_sample(scene, first);
  } catch (const adapters::RivalSkips&) {
    result.skipped = true;
  } catch (const adapters::RivalFailure& failure) {
    result.differences = 1;
    result.finding = failure.what();
  }
  return result;
}

// A sample that is not covered once, in the midst of triangles that tile. Empty if there is none.
std::string crack_in(adapters::Rival& rival, const Scene& scene) {
  try {
    const std::vector<std::uint32_t> counts = counts_of(rival, scene);
    const Tiling tiling(scene);
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (counts[s] == 1) continue;
      const auto width = static_cast<std::size_t>(scene.width);
      if (tiling.around(static_cast<double>(s % width) + 0.5, static_cast<double>(s / width) + 0.5)) {
        return found_at(scene, s, counts[s]);
      }
    }
    return "";
  } catch (const adapters::RivalSkips&) {
    return "";
  } catch (const adapters::RivalFailure& failure) {
    return failure.what();
  }
}

}  // namespace

void make_perspective_check(const Settings& settings, adapters::Rival& rival, Check& check) {
  const Size size = size_for(rival);
  check.claim = fmt::format("a mesh in perspective of some {} triangles covers each sample of {} x {} once",
                            size.width > 1000 ? "thousand" : "hundred", size.width, size.height);
  check.unit = "meshes";
  check.cost = 0.3;
  check.prepare = [cases = by_level<std::uint64_t>(settings.level, 2, 40, 2000)] { return cases; };
  check.run = [seed = settings.seed, name = check.name, &rival](std::uint64_t number) {
    return whole_mesh(rival, case_seed(seed, name, number));
  };
  check.still_fails = [&rival](const Scene& scene) {
    const bool plain = scene.samples == 1 && scene.draws.size() == 1 && scene.draws[0].vertices.size() >= 3;
    const adapters::Rival::Uncounted uncounted(rival);
    return plain && rival.is_reducible() && !crack_in(rival, scene).empty();
  };
  check.describe = [&rival](const Scene& scene) { return crack_in(rival, scene); };
}

}  // namespace surefill::certify
