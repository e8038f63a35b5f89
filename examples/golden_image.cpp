// SPDX-License-Identifier: Apache-2.0
//
// A golden-image test that cannot flake: images are compared by hash, with no tolerance, on every machine. That works
// because every bit is defined (docs/semantics.md), whatever the compiler, instruction set or number of threads.
//
//     golden_image            compares; exit status 1 if an image changed
//     golden_image --update   prints the table to paste below
#include <cstdio>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "surefill/surefill.hpp"

namespace {

constexpr int kWidth = 160, kHeight = 90;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

// FNV-1a over the bytes of buffers.
class Hash {
 public:
  template <typename T>
  void add(const std::vector<T>& buffer) {
    for (const std::byte b : std::as_bytes(std::span(buffer)))
      value_ = (value_ ^ static_cast<std::uint8_t>(b)) * kPrime;
  }
  std::uint64_t value() const { return value_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001B3;
  std::uint64_t value_ = 0xCBF29CE484222325;
};

struct Scene {
  const char* name;
  std::uint64_t golden;
  surefill::FillRule fill_rule;
  surefill::Cull cull;
  int triangles;
};

constexpr Scene kScenes[] = {
    {"ten triangles", 0xC0BB4E47A13B3031, surefill::FillRule::top_left, surefill::Cull::none, 10},
    {"culled", 0xDB3CB53958F477C9, surefill::FillRule::top_left, surefill::Cull::back, 100},
    {"OpenGL's fill rule", 0x7FA53FDCDC5B05AE, surefill::FillRule::bottom_left, surefill::Cull::none, 100},
    {"a thousand triangles", 0x93CF423279414813, surefill::FillRule::top_left, surefill::Cull::none, 1000},
};

// A number in [low, high), the same everywhere: integers, and one rounding that IEEE 754 defines.
float next(std::uint32_t& state, float low, float high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * (static_cast<float>(state >> 8) / 16777216.0f);
}

std::uint64_t render(const Scene& scene, int threads) {
  std::uint32_t state = 1;
  std::vector<surefill::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<float> colours;
  for (std::uint32_t i = 0; i < 3 * static_cast<std::uint32_t>(scene.triangles); ++i) {
    const float w = next(state, -0.25f, 2.0f);  // some vertices lie behind the eye
    vertices.push_back({next(state, -40, 200) * w, next(state, -20, 110) * w, next(state, 0, 1), w});
    for (int c = 0; c < 3; ++c) colours.push_back(next(state, 0, 1));
    indices.push_back(i);
  }

  std::vector<std::uint32_t> index(kPixels), count(kPixels);
  std::vector<float> depth(kPixels), colour(3 * kPixels);
  const surefill::AttributeTarget colour_target{colour, 3};
  surefill::Target target;
  target.width = kWidth, target.height = kHeight;
  target.count = count, target.index = index, target.depth = depth;
  target.attributes = {&colour_target, 1};

  surefill::AttributeArray colour_array;
  colour_array.values = colours, colour_array.components = 3;
  surefill::Draw draw;
  draw.vertices = vertices, draw.indices = indices, draw.attributes = {&colour_array, 1};
  draw.fill_rule = scene.fill_rule, draw.cull = scene.cull;

  surefill::Options options;
  options.threads = threads;
  if (const surefill::Status status = surefill::render(target, {&draw, 1}, nullptr, options);
      status != surefill::Status::ok) {
    std::fprintf(stderr, "golden_image: %s\n", surefill::status_text(status));
    return 0;
  }
  Hash hash;
  hash.add(count), hash.add(index), hash.add(depth), hash.add(colour);
  return hash.value();
}

}  // namespace

int main(int argc, char** argv) {
  const bool update = argc > 1 && std::string_view(argv[1]) == "--update";
  int changed = 0;
  for (const Scene& scene : kScenes) {
    for (const int threads : {1, 4}) {
      const std::uint64_t hash = render(scene, threads);
      const bool same = hash == scene.golden;
      if (!same) ++changed;
      std::printf("%-22s %d thread%s 0x%016llX%s\n", scene.name, threads, threads == 1 ? " " : "s",
                  static_cast<unsigned long long>(hash), same || update ? "" : " CHANGED");
    }
  }
  if (update) return 0;
  std::printf("%s\n", changed == 0 ? "all images are the golden ones" : "images have changed");
  return changed == 0 ? 0 : 1;
}
