// SPDX-License-Identifier: Apache-2.0
#include "bench/occlusion.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bench/city.hpp"
#include "bench/workloads.hpp"
#include "corpus/mesh.hpp"
#include "surefill/occlusion.hpp"

namespace surefill::bench {
namespace {

// What a game has before it culls: occluders and boxes in the world, and a view.
struct Scene {
  std::vector<Point> positions;
  std::vector<std::uint32_t> indices;
  std::vector<Bounds> objects;
  Matrix matrix{};
};

// The scene in pixels of a buffer.
struct Projected {
  std::vector<Vertex> vertices;
  std::vector<OcclusionBox> boxes;

  void project(const Scene& scene, int width, int height) {
    const Viewport viewport{.width = static_cast<float>(width), .height = static_cast<float>(height)};
    clip_.resize(scene.positions.size()), vertices.resize(scene.positions.size());
    for (std::size_t i = 0; i < clip_.size(); ++i) clip_[i] = transformed(scene.matrix, scene.positions[i]);
    to_pixel(viewport, clip_, vertices);
    boxes.resize(scene.objects.size()), clip_boxes_.resize(8 * boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Bounds& b = scene.objects[i];
      for (unsigned k = 0; k < 8; ++k) {
        clip_boxes_[8 * i + k] =
            transformed(scene.matrix, {(k & 1) != 0 ? b.high[0] : b.low[0], (k & 2) != 0 ? b.high[1] : b.low[1],
                                       (k & 4) != 0 ? b.high[2] : b.low[2]});
      }
    }
    to_pixel(viewport, clip_boxes_, {boxes.empty() ? nullptr : boxes[0].corners, clip_boxes_.size()});
  }

 private:
  std::vector<ClipVertex> clip_, clip_boxes_;
};

DrawState state_of_occluders() {
  DrawState state;
  state.front_face = FrontFace::counter_clockwise, state.cull = Cull::back, state.depth_mode = DepthMode::clip;
  return state;
}

// One frame of either buffer.
class SafeFrame {
 public:
  SafeFrame(const Scene& scene, int width, int height) {
    std::vector<float> positions;
    for (const Point& p : scene.positions) positions.insert(positions.end(), p.begin(), p.end());
    mesh_.prepare(positions, scene.indices);
    buffer_.resize(width, height, DepthTest::greater);
    occluder_.state() = state_of_occluders(), occluder_.mesh = &mesh_;
    projected_.project(scene, width, height);
    answers.resize(scene.objects.size());
  }
  Status draw(const Options& options) {
    buffer_.clear();
    occluder_.vertices = projected_.vertices;
    return buffer_.draw({&occluder_, 1}, options);
  }
  Status ask() { return buffer_.query(projected_.boxes, answers); }

  std::vector<Occlusion> answers;

 private:
  OccluderMesh mesh_;
  SafeOcclusionBuffer buffer_;
  Occluder occluder_;
  Projected projected_;
};

class ExactFrame {
 public:
  ExactFrame(const Scene& scene, int width, int height) : indices_(scene.indices) {
    buffer_.resize(width, height, DepthTest::greater);
    draw_.state() = state_of_occluders();
    projected_.project(scene, width, height);
    answers.resize(scene.objects.size());
  }
  Status draw(const Options& options) {
    buffer_.clear();
    draw_.vertices = projected_.vertices, draw_.indices = indices_;
    return buffer_.draw({&draw_, 1}, nullptr, options);
  }
  Status ask() { return buffer_.query(projected_.boxes, answers); }

  std::vector<Occlusion> answers;

 private:
  std::vector<std::uint32_t> indices_;
  OcclusionBuffer buffer_;
  Draw draw_;
  Projected projected_;
};

Scene city_scene(const City& city, int view) {
  return {city.positions, city.indices, city.objects, street_view(city, view)};
}

// A mesh of the corpus, seen whole, and boxes around and behind it.
Scene mesh_scene(const char* name) {
  const meshes::Mesh mesh = meshes::load_mesh(std::string(SUREFILL_MESHES "/") + name + ".obj");
  Scene scene;
  Point low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (const meshes::Float3& p : mesh.positions) {
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  const float size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  for (const meshes::Float3& p : mesh.positions) {
    Point q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = (p[k] - (low[k] + high[k]) / 2) / size;
    scene.positions.push_back({q[0], q[1], 1.4f - q[2]});  // front to the eye, which looks along +z
  }
  for (const auto& t : mesh.triangles) scene.indices.insert(scene.indices.end(), t.begin(), t.end());
  std::mt19937_64 random(5);
  const auto uniform = [&](float from, float to) {
    return from + (to - from) * static_cast<float>(static_cast<double>(random() >> 11) * 0x1p-53);
  };
  for (int i = 0; i < 10000; ++i) {
    const float z = uniform(0.8f, 4), x = uniform(-z, z), y = uniform(-z / 2, z / 2), s = uniform(0.01f, 0.1f);
    scene.objects.push_back({{x, y, z}, {x + s, y + s, z + s}});
  }
  scene.matrix = {9.0f / 16 * 1.7320508f, 0, 0, 0, 0, 1.7320508f, 0, 0, 0, 0, 0, 1, 0, 0, 0.125f, 0};
  return scene;
}

double milliseconds_of(const auto& work) {
  double least = 1e9;
  for (int n = 0; n < 5; ++n) {
    const std::clock_t begin = std::clock();
    work();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

struct Share {
  std::size_t exact = 0, safe = 0, wrong = 0;
  double draw = 0, ask = 0;
};

void add_share(const Scene& scene, int width, int height, const std::vector<Occlusion>& exact, Share& share) {
  SafeFrame frame(scene, width, height);
  share.draw += milliseconds_of([&] { frame.draw({}); });
  share.ask += milliseconds_of([&] { frame.ask(); });
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const bool hidden = frame.answers[i] == Occlusion::hidden;
    share.exact += exact[i] == Occlusion::hidden;
    share.safe += hidden && exact[i] == Occlusion::hidden;
    share.wrong += hidden && exact[i] == Occlusion::visible;
  }
}

template <typename Frame>
void frame_rows(const std::string& name, std::size_t triangles, int width, int height, int threads) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 static std::map<std::size_t, City> cities;
                                 const auto [at, is_new] = cities.try_emplace(triangles);
                                 if (is_new) at->second = make_city(triangles, 10000);
                                 Frame frame(city_scene(at->second, 0), width, height);
                                 Context context;
                                 const Options options{.threads = threads, .context = &context};
                                 for (auto _ : state) {
                                   if (frame.draw(options) != Status::ok || frame.ask() != Status::ok)
                                     return state.SkipWithError("it could not draw");
                                 }
                                 state.counters["hidden"] = static_cast<double>(
                                     std::count(frame.answers.begin(), frame.answers.end(), Occlusion::hidden));
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

}  // namespace

void add_occlusion(int threads) {
  for (const std::size_t triangles : {std::size_t{10000}, std::size_t{100000}}) {
    const std::string name = "city/" + std::to_string(triangles);
    frame_rows<SafeFrame>(name + "/safe/480x270", triangles, 480, 270, threads);
    frame_rows<SafeFrame>(name + "/safe/240x135", triangles, 240, 135, threads);
    frame_rows<ExactFrame>(name + "/exact/1920x1080", triangles, 1920, 1080, threads);
    frame_rows<ExactFrame>(name + "/exact/480x270", triangles, 480, 270, threads);
  }
}

int measure_hidden() {
  constexpr int kSizes[][2] = {{960, 540}, {480, 270}, {320, 180}, {240, 135}};
  constexpr int kViews = 16;
  std::printf("%-22s %-10s %8s %8s %7s %6s %9s %9s\n", "scene", "safe", "exact", "hidden", "share", "wrong", "draw ms",
              "ask ms");
  std::size_t wrong = 0;
  const auto measure = [&](const char* name, const std::vector<Scene>& scenes) {
    Share shares[std::size(kSizes)], full;
    for (const Scene& scene : scenes) {
      ExactFrame exact(scene, kWidth, kHeight);
      full.draw += milliseconds_of([&] { exact.draw({}); });
      full.ask += milliseconds_of([&] { exact.ask(); });
      for (std::size_t k = 0; k < std::size(kSizes); ++k)
        add_share(scene, kSizes[k][0], kSizes[k][1], exact.answers, shares[k]);
    }
    const auto n = static_cast<double>(scenes.size());
    for (std::size_t k = 0; k < std::size(kSizes); ++k) {
      const Share& s = shares[k];
      const std::string size = std::to_string(kSizes[k][0]) + "x" + std::to_string(kSizes[k][1]);
      std::printf("%-22s %-10s %8zu %8zu %6.1f%% %6zu %9.3f %9.3f\n", name, size.c_str(), s.exact, s.safe,
                  100 * static_cast<double>(s.safe) / static_cast<double>(s.exact), s.wrong, s.draw / n, s.ask / n);
      wrong += s.wrong;
    }
    std::printf("%-22s %-10s %33s %9.3f %9.3f\n", name, "(exact)", "", full.draw / n, full.ask / n);
  };
  for (const std::size_t triangles : {std::size_t{10000}, std::size_t{100000}}) {
    const City city = make_city(triangles, 10000);
    std::vector<Scene> scenes;
    for (int view = 0; view < kViews; ++view) scenes.push_back(city_scene(city, view));
    measure(triangles == 10000 ? "city of 10,000" : "city of 100,000", scenes);
  }
  for (const char* const mesh : {"spot", "teapot"}) measure(mesh, {mesh_scene(mesh)});
  return wrong == 0 ? 0 : 1;
}

}  // namespace surefill::bench
