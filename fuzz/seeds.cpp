// SPDX-License-Identifier: Apache-2.0
//
// Seeds from the corpus: surefill_fuzz_seeds CASES OUT writes OUT/TARGET/* for every target, so that no case is stored
// twice. A scene is a seed of each target whose form it fits; the generators add a triangle and a scene of each of
// their categories. Exit 1 if a target would get no seed from the corpus.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "fuzz/decode.hpp"
#include "properties/generators/generators.hpp"
#include "properties/generators/occluders.hpp"

namespace surefill::fuzz {
namespace {

namespace fs = std::filesystem;

class SeedWriter {
 public:
  explicit SeedWriter(fs::path out) : out_(std::move(out)) {}

  void add(const std::string& target, std::string name, std::string_view bytes) {
    std::replace(name.begin(), name.end(), '/', '-');
    fs::create_directories(out_ / target);
    const fs::path path = out_ / target / name;
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw fs::filesystem_error("cannot be written", path, std::make_error_code(std::errc::io_error));
    ++count_[target];
  }
  void add(const std::string& target, const std::string& name, const Bytes& bytes) {
    add(target, name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  std::size_t count(const std::string& target) const {
    const auto found = count_.find(target);
    return found == count_.end() ? 0 : found->second;
  }

 private:
  fs::path out_;
  std::map<std::string, std::size_t> count_;
};

// At most this many triangles of one scene; a mesh of hundreds adds little.
constexpr std::size_t kTrianglesOfScene = 8;

// Fewer make no closed mesh.
constexpr std::size_t kMeshVertices = 5;

// The scene on the next larger target of the form, drawn on the best instruction set; on another one, with other
// numbers of threads and outputs; and without a count, with all that is shaded, so that depth may hide.
void add_paths(SeedWriter& seeds, corpus::Scene scene, const std::string& name) {
  if (scene.draws.empty()) return;
  const auto next_larger = [](int side) {
    int best = 0;
    for (const int candidate : kPathSides) {
      if (candidate >= side && (best == 0 || candidate < best)) best = candidate;
    }
    return best == 0 ? kPathSides[0] : best;
  };
  scene.width = next_larger(scene.width);
  scene.height = scene.width > kPathSides[3] ? kPathSides[0] : next_larger(scene.height);
  while (scene.samples > 1 && scene.width * scene.height * scene.samples > kMostPathSamples) scene.samples /= 2;
  if (scene.initial_depth.size() > 1)
    scene.initial_depth.erase(scene.initial_depth.begin() + 1, scene.initial_depth.end());
  std::optional<Bytes> bytes = encode_paths(scene);
  if (!bytes) return;
  constexpr std::uint8_t kNoCountShaded = 0x19, kStream = 7 << 5, kExecutor = 6 << 5;
  const std::size_t number = seeds.count("paths") / 3;
  // In the form's numbers: two, three or eight, which share the bands of a high target.
  const std::size_t threads = scene.height > kPathSides[3] ? 13 + number % 3 : 0;
  seeds.add("paths", name, *bytes);
  (*bytes)[1] = static_cast<std::uint8_t>(number % 16 | threads << 4);
  (*bytes)[2] = static_cast<std::uint8_t>(threads != 0 ? kExecutor : 37 * number);
  seeds.add("paths", name + "-otherwise", *bytes);
  (*bytes)[1] = static_cast<std::uint8_t>(number / 3 % 16 | threads << 4);
  (*bytes)[2] = static_cast<std::uint8_t>(kNoCountShaded | (number % 2 == 1   ? kStream
                                                            : number % 4 == 2 ? kExecutor
                                                                              : 0));
  seeds.add("paths", name + "-without-count", *bytes);
}

// A mesh over the vertices of a small scene, as text.
// A triangle and a quad as PLY, with a list and an element more, and the triangle as STL.
void add_other_meshes(SeedWriter& seeds) {
  const std::string elements =
      "comment a\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n"
      "element face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty short a\nend_header\n";
  seeds.add(
      "obj", "ascii-ply",
      "ply\nformat ascii 1.0\n" + elements + "0 0 0 1\n1 0 0.5 2\n1 1 -3e2 3\n0 1 nan 4\n3 0 1 2\n4 0 1 2 3\n-7\n");
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + elements;
    const auto add = [&bytes, big](std::uint64_t bits, std::size_t size) {
      for (std::size_t k = 0; k < size; ++k) bytes += static_cast<char>(bits >> 8 * (big ? size - 1 - k : k) & 0xFF);
    };
    for (std::uint64_t v = 0; v < 4; ++v) {
      add(v % 3 == 0 ? 0 : 0x3F800000, 4), add(v < 2 ? 0 : 0x3F800000, 4);
      add(0x3FF0000000000000, 8), add(v, 1);
    }
    add(3, 1), add(0, 4), add(1, 4), add(2, 4);
    add(4, 1), add(3, 4), add(2, 4), add(1, 4), add(0, 4), add(7, 2);
    seeds.add("obj", big ? "big-ply" : "little-ply", bytes);
  }
  seeds.add("obj", "ascii-stl",
            std::string_view("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                             "endloop\nendfacet\nendsolid a\n"));
  std::string binary(80, ' ');
  for (const std::uint32_t word : {1u, 0u, 0u, 0u, 0u, 0u, 0u, 0x3F800000u, 0u, 0u, 0u, 0x3F800000u, 0u}) {
    for (int k = 0; k < 4; ++k) binary += static_cast<char>(word >> 8 * k & 0xFF);
  }
  seeds.add("obj", "binary-stl", binary + std::string(2, '\0'));
}

void add_obj(SeedWriter& seeds, const corpus::Scene& scene, const std::string& name) {
  constexpr std::size_t kMostVertices = 32;
  const corpus::SceneDraw& draw = scene.draws.at(0);
  if (draw.triangles.empty() || draw.vertices.size() > kMostVertices) return;
  std::ostringstream text;
  text << "o " << name << '\n';
  for (const corpus::SceneVertex& v : draw.vertices) text << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  for (const corpus::SceneTriangle& t : draw.triangles) {
    text << 'f';
    for (const std::uint32_t v : t.vertices) text << ' ' << v + 1;
    text << '\n';
  }
  seeds.add("obj", name, text.str());
}

void add_scene(SeedWriter& seeds, const corpus::Scene& scene, const std::string& name) {
  if (const std::optional<Bytes> bytes = encode_scene(scene)) {
    seeds.add("scene", name, *bytes);
    seeds.add("occlusion", name, *bytes);
    if (scene.samples > 1) seeds.add("samples", name, *bytes);
    if (scene.draws[0].vertices.size() >= kMeshVertices) seeds.add("mesh", name, *bytes);
  }
  add_paths(seeds, scene, name);
  const std::vector<corpus::Scene> singles = single_triangles(scene);
  for (std::size_t t = 0; t < std::min(singles.size(), kTrianglesOfScene); ++t) {
    const bool grid = singles[t].draws[0].grid.has_value();
    if (const std::optional<Bytes> bytes = grid ? encode_grid_triangle(singles[t]) : encode_triangle(singles[t])) {
      seeds.add(grid ? "grid" : "triangle", name + "-" + std::to_string(t), *bytes);
      if (!grid) seeds.add("your_rasterizer", name + "-" + std::to_string(t), *bytes);
    }
  }
}

// Occluders of each category, the first that fit the form.
void add_occluders(SeedWriter& seeds) {
  for (const properties::OccluderCategory& category : properties::occluder_categories()) {
    int added = 0;
    for (std::uint64_t seed = 1; seed <= 200 && added < 4; ++seed) {
      const corpus::Scene scene = properties::occluder_scene(category, seed, 12, 9, 6);
      if (const std::optional<Bytes> bytes = encode_scene(scene)) {
        seeds.add("occlusion", std::string("occluders-") + category.name + "-" + std::to_string(added++), *bytes);
      }
    }
  }
}

void add_generated(SeedWriter& seeds) {
  for (const properties::Category& category : properties::categories()) {
    const std::string name = std::string("generated-") + category.name;
    add_scene(seeds, properties::random_scene(category, 1), name);
    properties::SceneLimits modes;
    modes.max_size = kMaxSide[4];
    modes.samples = modes.grid = true;
    for (std::uint64_t seed = 3; seed < 7; ++seed) {
      add_scene(seeds, properties::random_scene(category, seed, modes), name + "-modes-" + std::to_string(seed));
    }
    properties::SceneLimits large;
    large.max_size = kPathSides[7];
    large.max_triangles = kMaxTriangles;
    add_paths(seeds, properties::random_scene(category, 2, large), name + "-large");
    large.samples = true;
    add_paths(seeds, properties::random_scene(category, 2, large), name + "-large-samples");
  }
}

// Calls with nothing wrong, and then more and more of the bytes that spoil an argument.
void add_arguments(SeedWriter& seeds) {
  properties::Random random(1);
  for (int n = 0; n < 256; ++n) {
    Bytes bytes(static_cast<std::size_t>(16 + 8 * (n % 64)));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    bytes[0] = static_cast<std::uint8_t>(n);
    seeds.add("arguments", "call-" + std::to_string(n), bytes);
    seeds.add("c_api", "call-" + std::to_string(n), bytes);
  }
}

// A message of the adapter protocol, one draw of one triangle with all outputs asked for; and a certificate with
// nothing in it, and what was found in text that is no scene. The targets find the rest by themselves and by the
// dictionary.
void add_texts(SeedWriter& seeds) {
  constexpr std::uint8_t kWords[] = {31, 4, 4, 1, 0, 0, 0, 1, 0, 3, 1};
  constexpr std::size_t kStateOfDraw = 24, kNumbersOfVertices = 24, kIndicesAndIdentifier = 4;
  Bytes bytes((std::size(kWords) + kStateOfDraw + kNumbersOfVertices + kIndicesAndIdentifier) * 4);
  for (std::size_t i = 0; i < std::size(kWords); ++i) bytes[4 * i] = kWords[i];
  seeds.add("adapter", "triangle", bytes);
  // The same in version 2: its headers have 11 and 28 words, and begin with these numbers.
  constexpr std::uint8_t kWords2[] = {11, 31, 0, 4, 4, 1, 0, 0, 0, 1, 0, 28, 0, 3, 1};
  Bytes bytes2((std::size(kWords2) + kStateOfDraw + kNumbersOfVertices + kIndicesAndIdentifier) * 4);
  for (std::size_t i = 0; i < std::size(kWords2); ++i) bytes2[4 * i] = kWords2[i];
  seeds.add("adapter", "triangle-2", bytes2);
  // Its samples are 2^31 * 2^31 * 4, which is 0 in 64 bits: as many initial depths as the message has words left.
  constexpr std::uint32_t kOverflow[] = {4, 1u << 31, 1u << 31, 4, 0, 0, 0, 0, 1};
  Bytes overflow;
  for (const std::uint32_t word : kOverflow) {
    for (int shift = 0; shift < 32; shift += 8) overflow.push_back(static_cast<std::uint8_t>(word >> shift));
  }
  seeds.add("adapter", "sizes-that-overflow", overflow);
  // A face on a line that ends, and begins, at a carriage return alone, without vertices.
  seeds.add("obj", "carriage-returns", std::string_view("o a\rf 5 3 10\r"));
  add_other_meshes(seeds);
  seeds.add("certificate", "empty", std::string_view("{\"format\": \"surefill-certificate\", \"checks\": []}\n"));
}

int write_seeds(const std::string& cases, const fs::path& out) {
  fs::remove_all(out);
  SeedWriter seeds(out);
  for (const std::string& path : corpus::list_corpus(cases)) {
    const corpus::Scene scene = corpus::read_scene_file(path);
    const std::string name = fs::relative(path, cases).replace_extension().string();
    seeds.add("reader", name, corpus::write_scene(scene));
    add_scene(seeds, scene, name);
    if (!scene.draws.empty()) add_obj(seeds, scene, name);
  }
  for (const char* target : {"triangle", "grid", "scene", "samples", "mesh", "paths", "reader", "obj", "occlusion"}) {
    if (seeds.count(target) == 0) {
      std::fprintf(stderr, "surefill_fuzz_seeds: no scene of %s fits the target %s\n", cases.c_str(), target);
      return 1;
    }
  }
  add_generated(seeds);
  add_occluders(seeds);
  add_arguments(seeds);
  add_texts(seeds);
  for (const char* target : {"triangle", "grid", "scene", "samples", "mesh", "paths", "reader", "obj", "occlusion",
                             "arguments", "c_api", "adapter", "certificate"}) {
    std::printf("%s: %zu seeds\n", target, seeds.count(target));
  }
  return 0;
}

}  // namespace
}  // namespace surefill::fuzz

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: surefill_fuzz_seeds CASES OUT\n");
    return 2;
  }
  try {
    return surefill::fuzz::write_seeds(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surefill_fuzz_seeds: %s\n", error.what());
    return 1;
  }
}
