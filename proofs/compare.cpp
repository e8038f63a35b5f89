// SPDX-License-Identifier: Apache-2.0
//
// Holds the engine and both oracles against the program extracted from the proofs (docs/proofs.md), bit for bit: the
// scenes of the corpus, then random scenes of every category. A scene that needs a word that the proofs do not define is
// left out, and the word is named.
//
//     surefill_compare_proofs PROGRAM --corpus FOLDER --scenes N [--seed S]
#include "properties/machinery/compare.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "corpus/scene.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/generators.hpp"

namespace {

using namespace surefill;

// A frame as the program reads it: numbers alone. Vertices are as the scene has them, before the viewport, so that S3
// is the program's own; the corpus reader and Frame give first indices and identifiers.
class Text {
 public:
  template <typename Integer>
  void number(Integer value) {
    text_ += std::to_string(value);
    text_ += ' ';
  }
  void number(bool value) { number(value ? 1 : 0); }
  void number(float value) { number(std::bit_cast<std::uint32_t>(value)); }
  template <typename Enum>
  void word(Enum value) {
    number(static_cast<int>(value));
  }
  void line(std::string_view keyword = "") { text_.append("\n").append(keyword).append(" "); }
  std::string take() { return std::move(text_ += '\n'); }

 private:
  std::string text_;
};

std::string text_of(const corpus::Scene& scene, const corpus::Frame& frame) {
  Text text;
  text.line("frame");
  text.number(scene.width);
  text.number(scene.height);
  text.number(scene.samples);
  text.number(scene.depth_test == DepthTest::greater);
  text.number(scene.attribute_location == AttributeLocation::centroid);
  text.line();
  text.number(scene.initial_depth.size());
  for (const float depth : scene.initial_depth) text.number(depth);
  text.line();
  std::uint32_t floats = 0;
  for (const corpus::SceneAttribute& attribute : scene.attributes) floats += attribute.components;
  text.number(floats);
  for (const corpus::SceneAttribute& attribute : scene.attributes) {
    for (std::uint32_t c = 0; c < attribute.components; ++c) text.word(attribute.interpolation);
  }
  text.line();
  text.number(scene.draws.size());
  for (std::size_t n = 0; n < scene.draws.size(); ++n) {
    const corpus::SceneDraw& draw = scene.draws[n];
    text.line();
    text.word(draw.fill_rule);
    text.number(draw.front_face == FrontFace::counter_clockwise);
    text.word(draw.cull);
    text.word(draw.depth_mode);
    text.number(draw.depth_write);
    text.number(draw.scissor.has_value());
    if (const auto& s = draw.scissor) {
      for (const int edge : {s->x0, s->y0, s->x1, s->y1}) text.number(edge);
    }
    text.number(draw.viewport.has_value());
    if (const auto& v = draw.viewport) {
      for (const float f : {v->x, v->y, v->width, v->height, v->near_depth, v->far_depth}) text.number(f);
      text.number(v->clip_depth == ClipDepth::minus_one_to_one);
      text.number(v->clip_y == ClipY::down);
    }
    text.number(frame.draws()[n].first_index);
    text.line();
    text.number(draw.vertices.size());
    for (const corpus::SceneVertex& vertex : draw.vertices) {
      text.line();
      for (const float f : {vertex.x, vertex.y, vertex.z, vertex.w}) text.number(f);
      for (const float f : vertex.attributes) text.number(f);
    }
    text.line();
    text.number(draw.triangles.size());
    for (const corpus::SceneTriangle& triangle : draw.triangles) {
      text.line();
      for (const std::uint32_t vertex : triangle.vertices) text.number(vertex);
      text.number(triangle.identifier.has_value());
      if (triangle.identifier) text.number(*triangle.identifier);
    }
  }
  return text.take();
}

// The program, as a child that answers one frame after the other.
class Program {
 public:
  explicit Program(const char* path) {
    int in[2], out[2];
    if (pipe(in) != 0 || pipe(out) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("no process");
    if (child_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
      execl(path, path, static_cast<char*>(nullptr));
      std::perror(path);
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = fdopen(in[1], "w");
    from_ = fdopen(out[0], "r");
  }
  ~Program() {
    std::fclose(to_);
    std::fclose(from_);
    waitpid(child_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Fills the image of `frame`, which has the sizes and outputs of the scene.
  void draw(const corpus::Scene& scene, corpus::Frame& frame) {
    const std::string text = text_of(scene, frame);
    if (std::fwrite(text.data(), 1, text.size(), to_) != text.size() || std::fflush(to_) != 0) fail();
    corpus::Image& image = frame.image();
    for (std::size_t s = 0; s < image.count.size(); ++s) {
      image.count[s] = number();
      image.index[s] = number();
      image.depth[s] = std::bit_cast<float>(number());
      for (std::size_t b = 0; b < 3; ++b) image.barycentrics[3 * s + b] = std::bit_cast<float>(number());
      for (std::size_t k = 0; k < image.attributes.size(); ++k) {
        const std::size_t components = scene.attributes[k].components;
        for (std::size_t c = 0; c < components; ++c) {
          image.attributes[k][components * s + c] = std::bit_cast<float>(number());
        }
      }
    }
  }

 private:
  [[noreturn]] static void fail() { throw std::runtime_error("the program gave no answer"); }
  std::uint32_t number() {
    unsigned long value = 0;
    if (std::fscanf(from_, "%lu", &value) != 1 || value > 0xFFFFFFFFu) fail();
    return static_cast<std::uint32_t>(value);
  }

  pid_t child_ = -1;
  std::FILE *to_ = nullptr, *from_ = nullptr;
};

struct Tally {
  std::uint64_t scenes = 0, samples = 0, values = 0, differences = 0;
};

struct Other {
  const char* name;
  properties::Renderer renderer;
};

// The oracles are called as they are: the renderers of properties/ ask the engine whether a frame is valid.
const std::array<Other, 3>& others() {
  static const std::array<Other, 3> all = {
      {{"the engine", properties::engine_renderer()},
       {"the oracle",
        [](const Target& target, std::span<const Draw> draws) {
          oracle::render(target, draws);
          return Status::ok;
        }},
       {"the second oracle", [](const Target& target, std::span<const Draw> draws) {
          oracle::clipped::render(target, draws);
          return Status::ok;
        }}}};
  return all;
}

// Draws the scene by the program, the engine and both oracles; every difference from the program counts.
void compare(Program& program, const corpus::Scene& scene, const std::string& name, Tally& tally) {
  corpus::Frame expected(scene);
  program.draw(scene, expected);
  ++tally.scenes;
  tally.samples += sample_total(expected.target());
  for (const auto& [who, renderer] : others()) {
    corpus::Frame actual(scene);
    const Status status = renderer(actual.target(), actual.draws());
    if (status != Status::ok) throw std::runtime_error(name + ": " + who + ": " + status_text(status));
    const properties::Comparison result = properties::compare(scene, expected.image(), actual.image(), 3);
    tally.values += result.values;
    if (result.differences == 0) continue;
    if (tally.differences == 0) std::printf("%s", corpus::write_scene(scene).c_str());
    tally.differences += result.differences;
    std::printf("%s: %s gives %llu other values than the proofs\n", name.c_str(), who,
                static_cast<unsigned long long>(result.differences));
    for (const properties::Difference& difference : result.first) {
      std::printf("  %s\n", properties::describe(difference, scene.samples).c_str());
    }
  }
}

// The words of the scene format that the proofs define: keywords, and what their values are called.
constexpr std::string_view kDefined =
    " surefill-scene target samples depth-test less greater attribute-location centre centroid attribute perspective"
    " noperspective flat initial-depth draw end viewport zero-to-one minus-one-to-one y-up y-down fill-rule top-left"
    " top-right bottom-left bottom-right southwards southwards-west northwards northwards-west closed open front-face"
    " clockwise counter-clockwise cull none front back depth-mode clip clamp depth-write on off scissor culling-box"
    " first-index vertex triangle id inf nan ";

// What the proofs do not define of a scene: the first word of its text that they do not know; nothing if they know all.
// So a mode that the format gets later is left out by its name.
std::string left_out(const corpus::Scene& scene) {
  std::istringstream lines(corpus::write_scene(scene));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string before;
    for (std::string word; words >> word; before = word) {
      const bool is_word = std::isalpha(static_cast<unsigned char>(word[0])) != 0 && before != "attribute";
      if (is_word && kDefined.find(" " + word + " ") == std::string_view::npos) return word;
    }
  }
  return "";
}

void print(const char* what, const Tally& tally) {
  std::printf("%s: %llu scenes, %llu samples, %llu values of the engine and both oracles, %llu differences\n", what,
              static_cast<unsigned long long>(tally.scenes), static_cast<unsigned long long>(tally.samples),
              static_cast<unsigned long long>(tally.values), static_cast<unsigned long long>(tally.differences));
  std::fflush(stdout);
}

Tally compare_corpus(Program& program, const std::string& folder) {
  // Samples times triangles that a scene may have: the program looks at each triangle at each sample.
  constexpr std::uint64_t kMostWork = 4'000'000;
  Tally tally;
  std::vector<std::pair<std::string, int>> reasons;
  for (const std::string& path : corpus::list_corpus(folder)) {
    const corpus::Scene scene = corpus::read_scene_file(path);
    std::string reason = left_out(scene);
    std::uint64_t work = 0;
    for (const corpus::SceneDraw& draw : scene.draws) work += draw.triangles.size();
    work *= static_cast<std::uint64_t>(scene.width) * static_cast<std::uint64_t>(scene.height) *
            static_cast<std::uint64_t>(scene.samples);
    if (reason.empty() && work > kMostWork) reason = "too large";
    if (reason.empty()) {
      compare(program, scene, path, tally);
      continue;
    }
    const auto known = std::ranges::find(reasons, reason, &std::pair<std::string, int>::first);
    if (known == reasons.end()) {
      reasons.emplace_back(reason, 1);
    } else {
      ++known->second;
    }
  }
  print("corpus", tally);
  for (const auto& [reason, scenes] : reasons) std::printf("  left out: %d: %s\n", scenes, reason.c_str());
  return tally;
}

Tally compare_random(Program& program, std::uint64_t scenes, std::uint64_t seed) {
  Tally tally;
  const auto categories = properties::categories();
  properties::SceneLimits limits;
  limits.max_size = 6;
  limits.samples = true;
  for (std::uint64_t n = 0; n < scenes && tally.differences == 0; ++n) {
    const properties::Category& category = categories[n % categories.size()];
    const std::uint64_t number = seed + n / categories.size();
    corpus::Scene scene = properties::random_scene(category, number, limits);
    // Every eighth is drawn with closed and open instead (C5).
    if (number % 8 == 0) {
      for (std::size_t k = 0; k < scene.draws.size(); ++k) {
        scene.draws[k].fill_rule = (k + number / 8) % 2 == 0 ? FillRule::closed : FillRule::open;
      }
    }
    const std::string name = std::string(category.name) + ", seed " + std::to_string(number);
    if (const std::string word = left_out(scene); !word.empty()) {
      throw std::runtime_error(name + ": the proofs do not define \"" + word + '"');
    }
    compare(program, scene, name, tally);
  }
  print("random", tally);
  return tally;
}

std::uint64_t parse(const char* text) {
  std::uint64_t value = 0;
  const std::string_view digits = text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw std::runtime_error("not a number: " + std::string(text));
  }
  return value;
}

int run(int argc, char** argv) {
  std::optional<std::string> folder;
  std::uint64_t scenes = 0, seed = 1;
  if (argc < 2 || argc % 2 != 0) throw std::runtime_error("usage: PROGRAM [--corpus FOLDER] [--scenes N] [--seed S]");
  for (int i = 2; i < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--corpus") {
      folder = argv[i + 1];
    } else if (option == "--scenes") {
      scenes = parse(argv[i + 1]);
    } else if (option == "--seed") {
      seed = parse(argv[i + 1]);
    } else {
      throw std::runtime_error("unknown option " + std::string(option));
    }
  }
  std::signal(SIGPIPE, SIG_IGN);
  Program program(argv[1]);
  std::uint64_t compared = 0, differences = 0;
  const auto add = [&](const Tally& tally) {
    compared += tally.scenes;
    differences += tally.differences;
  };
  if (folder) add(compare_corpus(program, *folder));
  if (scenes > 0) add(compare_random(program, scenes, seed));
  if (compared == 0) throw std::runtime_error("nothing was compared");
  return differences == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surefill_compare_proofs: %s\n", error.what());
    return 2;
  }
}
