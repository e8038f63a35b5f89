// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/tilings_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "certify/judge/plane.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::certify {

namespace {

using corpus::Scene;
using properties::Random;

struct Size {
  int width, height;
};
constexpr Size kLarge{1920, 1080}, kMiddle{480, 270}, kSmall{64, 48};

// Lines that the mesh's corners lie near, from before 0 to beyond the length: from 1 to 500 pixels apart, 1 beside 500
// now and then; or from `least` on, to so many times as much.
std::vector<double> lines(Random& random, int length, bool equal, double least, double ratio) {
  constexpr double kEqual = 24;
  std::vector<double> at{-kEqual};
  while (at.back() < length + 8) {
    const double gap = equal ? kEqual : least * std::exp(std::log(ratio) * random.unit());
    at.push_back(at.back() + std::max(least, gap));
  }
  return at;
}

// A quarter of the way to the nearest other line is what a corner is moved by at most, so that every triangle stays high
// enough for no grid of 4 bits to turn it over.
double room(const std::vector<double>& at, std::size_t i) {
  const double before = i == 0 ? 24 : at[i] - at[i - 1], behind = i + 1 == at.size() ? 24 : at[i + 1] - at[i];
  return std::min({before, behind, 24.0}) / 4;
}

// Quads all over the target and beyond, cut along one diagonal or the other. In perspective W differs from vertex to vertex
// and is no power of two, so X/W is rounded by whoever divides; neighbours share the rounded vertex.
Scene mesh(std::uint64_t seed, const Size& size, bool equal, bool perspective, double least = 1, double ratio = 500,
           std::uint32_t unused = 0) {
  Random random(seed);
  Scene scene;
  scene.width = size.width;
  scene.height = size.height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices.assign(unused, {0, 0, 0.5f, 1, {}});
  const std::vector<double> xs = lines(random, size.width, equal, least, ratio),
                            ys = lines(random, size.height, equal, least, ratio);
  for (std::size_t j = 0; j < ys.size(); ++j) {
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const float w = perspective ? static_cast<float>(1 + 15 * random.unit()) : 1;
      const double x = xs[i] + room(xs, i) * (2 * random.unit() - 1);
      const double y = ys[j] + room(ys, j) * (2 * random.unit() - 1);
      // Without perspective to 1/1024 pixel, so that clip space has them exactly.
      const auto place = [&](double p) {
        return perspective ? static_cast<float>(p * w) : static_cast<float>(std::nearbyint(p * 1024) / 1024);
      };
      draw.vertices.push_back({place(x), place(y), w / 2, w, {}});
    }
  }
  for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      const auto a = unused + static_cast<std::uint32_t>(j * xs.size() + i);
      const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(xs.size()), d = c + 1;
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
  const auto width = static_cast<std::size_t>(scene.width), samples = static_cast<std::size_t>(scene.samples),
             pixel = sample / samples;
  return fmt::format("count of a tiling at pixel ({}, {}){}: expected 1, got {}", pixel % width, pixel / width,
                     samples > 1 ? fmt::format(" sample {}", sample % samples) : "", count);
}

// Where the model takes samples, in the coordinates of the scene (R2, R3); and how far a corner may be moved from there
// (R4, R5), 1/16 pixel at the least.
class Places {
 public:
  struct Place {
    double x, y, around_x, around_y;
  };

  Places(const Scene& scene, const RivalSubject& subject)
      : width_(static_cast<std::size_t>(scene.width)), samples_(scene.samples) {
    const corpus::Frame frame(scene, {false, false, false, false, false});
    const judge::Frame seen{scene.width, scene.height, scene.samples, scene.depth_test, false, frame.draws()};
    for (const Draw& draw : frame.draws()) {
      const judge::Model model = judge::model_of_draw(subject.terms, seen, draw);
      x_.take(model.x, scene.width);
      y_.take(model.y, scene.height);
    }
  }

  Place of(std::size_t sample) const {
    const auto samples = static_cast<std::size_t>(samples_);
    const SampleLocation within = sample_location(samples_, static_cast<int>(sample % samples));
    return {x_.at(sample / samples % width_, within.x), y_.at(sample / samples / width_, within.y), x_.around,
            y_.around};
  }

 private:
  struct Axis {
    double first = 0, stretch = 1, around = 1.0 / 16;

    void take(const oracle::AxisModel& axis, int length) {
      first = axis.place - axis.moved - 0.5;
      stretch = length / (length - axis.lacks);
      const double step = axis.bits < 0 ? 0 : std::ldexp(1.0, -axis.bits);
      around = std::max(around, axis.place_within + std::max(axis.blur, axis.divided_blur) + step);
    }
    double at(std::size_t pixel, int sixteenths) const {
      return (static_cast<double>(pixel) + sixteenths / 16.0 + first) * stretch;
    }
  };

  std::size_t width_;
  int samples_;
  Axis x_, y_;
};

// The triangles within two pixels of the sample, by their boxes.
Scene near_sample(const Scene& scene, const RivalSubject& subject, std::size_t sample) {
  const auto [x, y, around_x, around_y] = Places(scene, subject).of(sample);
  Scene part = scene;
  corpus::SceneDraw& draw = part.draws[0];
  std::erase_if(draw.triangles, [&](const corpus::SceneTriangle& triangle) {
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (const std::uint32_t v : triangle.vertices) {
      const corpus::SceneVertex& p = draw.vertices[v];
      x0 = std::min(x0, static_cast<double>(p.x) / p.w);
      x1 = std::max(x1, static_cast<double>(p.x) / p.w);
      y0 = std::min(y0, static_cast<double>(p.y) / p.w);
      y1 = std::max(y1, static_cast<double>(p.y) / p.w);
    }
    return x < x0 - 2 - around_x || x > x1 + 2 + around_x || y < y0 - 2 - around_y || y > y1 + 2 + around_y;
  });
  return part;
}

// Targets of which the rival draws such a mesh in a good part of its time limit: a program is timed once, on a small one.
class Sizes {
 public:
  explicit Sizes(const RivalSubject& subject) : subject_(subject) {}

  Size largest() {
    const std::unique_lock<std::mutex> lock(mutex_);
    if (!size_.has_value()) size_ = measured();
    return *size_;
  }

 private:
  Size measured() {
    const surefill_adapter_info& info = subject_.rival->info();
    Size size = subject_.slow ? kSmall : info.form == SUREFILL_ADAPTER_FORM_CLIP ? kLarge : kMiddle;
    if (subject_.slow) {
      const auto start = std::chrono::steady_clock::now();
      try {
        (void)counts_of(*subject_.rival, mesh(1, kSmall, true, false));
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        // Some fifty times the samples, and no more triangles.
        if (seconds < 0.01) size = kMiddle;
      } catch (const std::exception&) {
        // The check itself says what came of it.
      }
    }
    if (info.max_width != 0) size.width = std::min(size.width, static_cast<int>(info.max_width));
    if (info.max_height != 0) size.height = std::min(size.height, static_cast<int>(info.max_height));
    return size;
  }

  const RivalSubject& subject_;
  std::mutex mutex_;
  std::optional<Size> size_;
};

// One in eight has vertices of large numbers, and one in eight several samples a pixel, and triangles that have no pixel's centre.
Scene mesh_of_case(const RivalSubject& subject, const Size& size, std::uint64_t number, std::uint64_t seed) {
  constexpr std::uint32_t kUnused = 66'000;
  const Size small{std::min(size.width, kSmall.width), std::min(size.height, kSmall.height)};
  const bool samples = (subject.rival->info().features & SUREFILL_ADAPTER_SAMPLES) != 0;
  if (number % 8 == 1 && samples) {
    Scene scene = mesh(seed, small, false, false, 0.5, 16);
    scene.samples = 4;
    return scene;
  }
  if (number % 8 == 3 && !subject.slow) return mesh(seed, small, false, false, 1, 500, kUnused);
  return mesh(seed, size, number % 4 == 0, number % 2 == 0);
}

CaseResult whole_mesh(const RivalSubject& subject, const Scene& scene) {
  if (!subject.strict && (!subject.terms.known || !still_tiles(scene, subject))) return not_applicable();
  return guarded_case(scene, [&] {
    CaseResult result;
    const std::vector<std::uint32_t> counts = counts_of(*subject.rival, scene);
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
    result.scene = near_sample(scene, subject, first);
    return result;
  });
}

// Is each of eight points around the sample covered once, beyond doubt? Then so is the sample, by whoever decides neighbours
// alike.
bool covered_around(const std::vector<judge::Edges>& triangles, const Places::Place& place) {
  for (const double dx : {-place.around_x, 0.0, place.around_x}) {
    for (const double dy : {-place.around_y, 0.0, place.around_y}) {
      if (dx == 0 && dy == 0) continue;
      int covers = 0;
      for (const judge::Edges& edges : triangles) {
        if (!(std::abs(edges.d) > judge::kRoundings * edges.d_magnitude)) return false;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const long double value = edges.at(i, place.x + dx, place.y + dy);
          if (!(std::abs(value) > edges.error(i, place.x + dx, place.y + dy))) return false;
          inside = inside && (value > 0) == (edges.d > 0);
        }
        if (inside) ++covers;
      }
      if (covers != 1) return false;
    }
  }
  return true;
}

}  // namespace

std::string crack_in(const RivalSubject& subject, const Scene& original) {
  try {
    const Scene scene = with_flat_depth(original);
    if (!subject.strict && may_turn(scene, subject)) return "";
    const std::vector<std::uint32_t> counts = counts_of(*subject.rival, scene);
    std::vector<judge::Edges> triangles;
    for (const corpus::SceneDraw& draw : scene.draws) {
      for (const corpus::SceneTriangle& triangle : draw.triangles) {
        triangles.emplace_back(properties::triangle_of(draw, triangle));
      }
    }
    const Places places(scene, subject);
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (counts[s] != 1 && covered_around(triangles, places.of(s))) return found_at(scene, s, counts[s]);
    }
    return "";
  } catch (const adapters::RivalSkips&) {
    return "";
  } catch (const adapters::RivalFailure& failure) {
    return failure.what();
  }
}

void make_tilings_check(const Settings& settings, const RivalSubject& subject, Check& check) {
  check.claim = "meshes of triangles from 1 to 500 pixels, side by side, cover each sample once";
  check.unit = "meshes";
  check.cost = 0.1;
  const auto sizes = std::make_shared<Sizes>(subject);
  check.prepare = [cases = subject.slow ? by_level<std::uint64_t>(settings.level, 8, 100, 2000)
                                        : by_level<std::uint64_t>(settings.level, 8, 80, 2000)] { return cases; };
  check.scene_of = [&subject, seed = settings.seed, name = check.name, sizes](std::uint64_t number) {
    return mesh_of_case(subject, sizes->largest(), number, case_seed(seed, name, number));
  };
  check.run = [&subject, scene_of = check.scene_of](std::uint64_t number) {
    return whole_mesh(subject, scene_of(number));
  };
  check.still_fails = [&subject](const Scene& scene) {
    const bool plain = scene.draws.size() == 1 && scene.draws[0].vertices.size() >= 3;
    const adapters::Rival::Uncounted uncounted(*subject.rival);
    return plain && subject.rival->is_reducible() && !crack_in(subject, scene).empty();
  };
  check.describe = [&subject](const Scene& scene) { return crack_in(subject, scene); };
}

}  // namespace surefill::certify
