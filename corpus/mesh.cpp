// SPDX-License-Identifier: Apache-2.0
//
// tinyobjloader takes what it can and passes over the rest in silence, so the text is checked line by line first. It
// also reads numbers inexactly, and no NaN at all; positions and normals are therefore those of the check.
#include "corpus/mesh.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <system_error>
#include <unordered_map>

#include "corpus/float_text.hpp"
#include "corpus/mesh_files.hpp"
#include "corpus/text_file.hpp"

namespace surefill::meshes {

namespace {

Double3 subtract(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Double3& a) {
  return std::sqrt(dot(a, a));
}

Double3 scaled(const Double3& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

Double3 widened(const Float3& a) {
  return {a[0], a[1], a[2]};
}

bool finite(const Float3& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

[[noreturn]] void fail(std::string_view file, std::size_t line, const std::string& cause) {
  throw MeshError(fmt::format("{}:{}: {}", file, line, cause));
}

// The words of a line, cut at blanks.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\r\v\f";
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

// Reads the text for what tinyobjloader would let pass, and collects positions and normals.
class TextCheck {
 public:
  TextCheck(std::string_view text, std::string_view file) : file_(file) {
    if (const std::string other = corpus::what_is_not_read(text); !other.empty()) fail(file, 1, other);
    std::size_t begin = 0;
    while (begin < text.size()) {
      // A line ends as tinyobjloader has it: also at a carriage return alone.
      const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
      ++line_;
      check_line(text.substr(begin, end - begin));
      begin = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
    }
    for (const Range& range : forward_) {
      if (range.last > counts_[range.kind]) fail(file_, range.line, out_of_range(range.kind, range.last));
    }
  }

  std::vector<Float3> positions, normals;
  std::uint64_t triangles = 0;  // that the faces should make

 private:
  enum Kind : std::size_t { position, texture, normal };
  struct Range {
    Kind kind;
    std::size_t line;
    std::uint64_t last;
  };

  std::string out_of_range(Kind kind, std::uint64_t number) const {
    static constexpr const char* kNames[] = {"vertex", "texture coordinate", "normal"};
    return fmt::format("the face names {} {}, but the file has {}", kNames[kind], number, counts_[kind]);
  }

  float number(std::string_view word) const {
    std::string_view digits = word;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    float value = 0;
    const auto [end, error] = corpus::float_from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
      fail(file_, line_, fmt::format("\"{}\" is not a number", word));
    }
    // Out of range: from_chars leaves the value alone. As IEEE 754 rounds: tiny becomes 0, huge an infinity.
    if (error == std::errc::result_out_of_range) {
      double wide = 0;
      const auto wide_error = corpus::float_from_chars(digits.data(), digits.data() + digits.size(), wide).ec;
      if (wide_error != std::errc()) {
        fail(file_, line_, fmt::format("\"{}\" is out of the range of numbers", word));
      }
      value = static_cast<float>(wide);
    }
    return value;
  }

  Float3 three(const std::vector<std::string_view>& words, const char* what) const {
    if (words.size() < 4) {
      fail(file_, line_, fmt::format("{} needs three numbers, found {}", what, words.size() - 1));
    }
    for (std::size_t i = 4; i < words.size(); ++i) (void)number(words[i]);
    return {number(words[1]), number(words[2]), number(words[3])};
  }

  void check_reference(Kind kind, std::string_view word) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value == 0) {
      fail(file_, line_, fmt::format("\"{}\" is not a vertex number (they count from 1)", word));
    }
    if (value < 0) {
      if (static_cast<std::uint64_t>(-(value + 1)) >= counts_[kind]) {
        fail(file_, line_, fmt::format("the face names vertex {} before there are so many", value));
      }
    } else if (static_cast<std::uint64_t>(value) > counts_[kind]) {
      if (value > std::numeric_limits<int>::max())
        fail(file_, line_, out_of_range(kind, static_cast<std::uint64_t>(value)));
      forward_.push_back({kind, line_, static_cast<std::uint64_t>(value)});
    }
  }

  void check_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      fail(file_, line_, fmt::format("a face needs three vertices, found {}", words.size() - 1));
    }
    std::size_t shape = 0;  // which of the three references the first corner has, the others must have, too
    for (std::size_t i = 1; i < words.size(); ++i) {
      std::string_view rest = words[i];
      std::size_t has = 0;
      for (std::size_t kind = position;; ++kind) {
        const std::size_t slash = rest.find('/');
        const std::string_view word = rest.substr(0, slash);
        if (!word.empty()) {
          check_reference(static_cast<Kind>(kind), word);
          has |= std::size_t{1} << kind;
        } else if (kind != texture || slash == std::string_view::npos) {
          fail(file_, line_, fmt::format("\"{}\" is no corner of a face", words[i]));
        }
        if (slash == std::string_view::npos) break;
        if (kind == normal) fail(file_, line_, fmt::format("\"{}\" is no corner of a face", words[i]));
        rest.remove_prefix(slash + 1);
      }
      if (i == 1) shape = has;
      if (has != shape) {
        fail(file_, line_, fmt::format("\"{}\" names other things than the face's first corner", words[i]));
      }
    }
    triangles += words.size() - 3;
  }

  void check_line(std::string_view line) {
    if (line.find('\0') != std::string_view::npos) {
      fail(file_, line_, fmt::format("not a text file: {}", corpus::kWhatIsRead));
    }
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) return;
    if (words.back().ends_with('\\')) fail(file_, line_, "lines continued by a backslash are not supported");
    if (words[0] == "v") {
      positions.push_back(three(words, "a vertex"));
      ++counts_[position];
    } else if (words[0] == "vn") {
      normals.push_back(three(words, "a normal"));
      ++counts_[normal];
    } else if (words[0] == "vt") {
      if (words.size() < 2) fail(file_, line_, "a texture coordinate needs a number");
      for (std::size_t i = 1; i < words.size(); ++i) (void)number(words[i]);
      ++counts_[texture];
    } else if (words[0] == "f") {
      check_face(words);
    } else {
      static constexpr std::string_view kOther[] = {
          "p",        "l",        "g",          "o",         "s",     "usemtl", "mtllib", "vp",     "t",
          "curv",     "curv2",    "surf",       "cstype",    "deg",   "bmat",   "step",   "parm",   "trim",
          "hole",     "scrv",     "sp",         "end",       "con",   "mg",     "bevel",  "lod",    "call",
          "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech", "stech",  "usemap", "maplib", "vw"};
      if (words[0] == "surefill-scene") fail(file_, line_, "this is a scene: its name must end in .scene");
      if (std::find(std::begin(kOther), std::end(kOther), words[0]) == std::end(kOther)) {
        // The file may be of another kind, unless it has been read for a while.
        const std::string hint = statements_ == 0 ? fmt::format(": {}", corpus::kWhatIsRead) : "";
        fail(file_, line_, fmt::format("\"{}\" is no OBJ statement{}", words[0].substr(0, 40), hint));
      }
    }
    ++statements_;
  }

  std::string_view file_;
  std::size_t line_ = 0, statements_ = 0;
  std::uint64_t counts_[3] = {0, 0, 0};
  std::vector<Range> forward_;  // references to what comes later, looked at again at the end
};

// Sums of area vectors of the faces around each position, of length 1; 0 where they cancel.
std::vector<Float3> smooth_normals(const std::vector<Float3>& positions, const std::vector<tinyobj::index_t>& corners) {
  std::vector<Double3> sums(positions.size(), Double3{});
  const auto number = [&corners](std::size_t corner) { return static_cast<std::size_t>(corners[corner].vertex_index); };
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const Float3 &a = positions[number(t)], &b = positions[number(t + 1)], &c = positions[number(t + 2)];
    if (!finite(a) || !finite(b) || !finite(c)) continue;
    const Double3 area = cross(subtract(widened(b), widened(a)), subtract(widened(c), widened(a)));
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) sums[number(t + k)][axis] += area[axis];
    }
  }
  std::vector<Float3> normals(positions.size(), Float3{});
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double size = length(sums[i]);
    if (!(size > 0) || !std::isfinite(size)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) normals[i][axis] = static_cast<float>(sums[i][axis] / size);
  }
  return normals;
}

}  // namespace

Mesh parse_obj(std::string_view bytes, std::string_view file) {
  const std::string_view text = corpus::without_byte_order_mark(bytes);
  const TextCheck check(text, file);
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(std::string(text), "", config)) {
    std::string cause = reader.Error();
    cause.erase(std::find(cause.begin(), cause.end(), '\n'), cause.end());
    throw MeshError(std::string(file) + ": " + (cause.empty() ? "not an OBJ file" : cause));
  }
  std::vector<tinyobj::index_t> corners;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    corners.insert(corners.end(), shape.mesh.indices.begin(), shape.mesh.indices.end());
  }
  if (corners.empty()) throw MeshError(std::string(file) + ": no triangle in it");

  Mesh mesh;
  const std::vector<Float3> smooth = smooth_normals(check.positions, corners);
  std::unordered_map<std::uint64_t, std::uint32_t> numbers;  // (position, normal) -> vertex
  const auto vertex_of = [&](const tinyobj::index_t& corner) {
    const std::size_t position = static_cast<std::size_t>(corner.vertex_index);
    const auto key = std::uint64_t{static_cast<std::uint32_t>(corner.vertex_index)} << 32 |
                     static_cast<std::uint32_t>(corner.normal_index);
    const auto [entry, fresh] = numbers.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.push_back(check.positions.at(position));
      const bool given =
          corner.normal_index >= 0 && finite(check.normals.at(static_cast<std::size_t>(corner.normal_index)));
      mesh.normals.push_back(given ? check.normals[static_cast<std::size_t>(corner.normal_index)] : smooth[position]);
    }
    return entry->second;
  };
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    mesh.triangles.push_back({vertex_of(corners[t]), vertex_of(corners[t + 1]), vertex_of(corners[t + 2])});
    const auto& triangle = mesh.triangles.back();
    const bool whole = std::all_of(triangle.begin(), triangle.end(),
                                   [&mesh](std::uint32_t vertex) { return finite(mesh.positions[vertex]); });
    if (!whole) ++mesh.non_finite_triangles;
  }
  mesh.lost_triangles = check.triangles - std::min<std::uint64_t>(check.triangles, mesh.triangles.size());
  return mesh;
}

namespace {

std::string bytes_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw MeshError(path + ": is a directory");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw MeshError(path + ": " + std::generic_category().message(errno));
  std::ostringstream bytes;
  if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
  if (stream.bad()) throw MeshError(path + ": cannot be read");
  return std::move(bytes).str();
}

bool ends_in(std::string_view name, std::string_view ending) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return name.size() >= ending.size() && std::equal(ending.begin(), ending.end(), name.end() - ending.size(),
                                                    [lower](char a, char b) { return a == lower(b); });
}

}  // namespace

Mesh load_obj(const std::string& path) {
  return parse_obj(bytes_of(path), path);
}

Mesh load_mesh(const std::string& path) {
  return parse_mesh(bytes_of(path), path);
}

Mesh parse_mesh(std::string_view bytes, std::string_view file) {
  if (corpus::is_ply(bytes) || ends_in(file, ".ply")) return parse_obj(obj_of_ply(bytes, file), file);
  if (corpus::is_stl(bytes) || ends_in(file, ".stl")) return parse_obj(obj_of_stl(bytes, file), file);
  return parse_obj(bytes, file);
}

Double3 Box::centre() const {
  return {low[0] / 2 + high[0] / 2, low[1] / 2 + high[1] / 2, low[2] / 2 + high[2] / 2};
}

double Box::radius() const {
  return length(subtract(high, low)) / 2;
}

Box bounds(const Mesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Float3& position = mesh.positions[vertex];
      if (!finite(position)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], double{position[axis]});
        box.high[axis] = std::max(box.high[axis], double{position[axis]});
      }
    }
  }
  return box.low[0] > box.high[0] ? Box{} : box;
}

void fit_planes(Camera& camera, const Mesh& mesh) {
  const Box box = bounds(mesh);
  const double radius = box.radius() > 0 ? box.radius() * 1.01 : 1;
  const Double3 ahead = subtract(camera.target, camera.eye);
  const double distance = dot(subtract(box.centre(), camera.eye), ahead) / length(ahead);
  if (camera.height > 0) {
    camera.near_plane = distance - radius, camera.far_plane = distance + radius;
    return;
  }
  camera.far_plane = std::max(distance + radius, radius / 100);
  camera.near_plane = std::max(distance - radius, camera.far_plane / 10000);
}

namespace {

// To the right, up, ahead: of length 1.
std::array<Double3, 3> axes_of(const Camera& camera) {
  const Double3 ahead = subtract(camera.target, camera.eye);
  const Double3 forward = scaled(ahead, 1 / length(ahead));
  const Double3 across = cross(forward, camera.up);
  const Double3 right = scaled(across, 1 / length(across));
  return {right, cross(right, forward), forward};
}

}  // namespace

double fitting_height(const Camera& camera, const Mesh& mesh, int width, int height) {
  const auto [right, up, forward] = axes_of(camera);
  const double aspect = static_cast<double>(width) / height;
  double half = 0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Float3& position = mesh.positions[vertex];
      if (!finite(position)) continue;
      const Double3 from = subtract(widened(position), camera.target);
      half = std::max({half, std::abs(dot(up, from)), std::abs(dot(right, from)) / aspect});
    }
  }
  constexpr double kMargin = 1.05;
  return half > 0 ? 2 * half * kMargin : 1;
}

Camera framing_camera(const Mesh& mesh, int width, int height) {
  const Box box = bounds(mesh);
  const double radius = box.radius() > 0 ? box.radius() : 1;
  const double aspect = static_cast<double>(width) / height;
  Camera camera;
  const double half = camera.field_of_view * std::numbers::pi / 360;
  const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
  const Double3 side = {-0.55, 0.35, -0.75};
  const double distance = radius / std::sin(narrow) * 0.9;  // few meshes fill their sphere
  camera.target = box.centre();
  const Double3 offset = scaled(side, distance / length(side));
  camera.eye = {camera.target[0] + offset[0], camera.target[1] + offset[1], camera.target[2] + offset[2]};
  fit_planes(camera, mesh);
  return camera;
}

void check_camera(const Camera& camera) {
  const Double3 ahead = subtract(camera.target, camera.eye);
  if (!(length(ahead) > 0) || !std::isfinite(length(ahead)))
    throw MeshError("the camera's eye and target are the same point");
  const double sine = length(cross(ahead, camera.up));
  if (!(sine > 0) || !std::isfinite(sine)) throw MeshError("the camera looks along its up direction");
  if (camera.height > 0) {
    if (!(camera.near_plane < camera.far_plane) || !std::isfinite(camera.far_plane - camera.near_plane) ||
        !std::isfinite(camera.height)) {
      throw MeshError("the camera needs near < far");
    }
    return;
  }
  if (!(camera.field_of_view > 0 && camera.field_of_view < 180)) {
    throw MeshError("the field of view must lie between 0 and 180 degrees");
  }
  if (!(camera.near_plane > 0 && camera.near_plane < camera.far_plane) || !std::isfinite(camera.far_plane)) {
    throw MeshError("the camera needs 0 < near < far");
  }
}

ClipVertex project(const Camera& camera, double aspect, const Float3& position) {
  const auto [right, up, forward] = axes_of(camera);
  const Double3 from_eye = subtract(widened(position), camera.eye);
  const double across = dot(right, from_eye), above = dot(up, from_eye), distance = dot(forward, from_eye);
  const double planes = camera.far_plane - camera.near_plane;
  if (camera.height > 0) {
    const double scale = 2 / camera.height;
    return {static_cast<float>(across * scale / aspect), static_cast<float>(above * scale),
            static_cast<float>((distance - camera.near_plane) / planes), 1};
  }
  const double scale = 1 / std::tan(camera.field_of_view * std::numbers::pi / 360);
  const double depth = camera.far_plane / planes;
  return {static_cast<float>(across * scale / aspect), static_cast<float>(above * scale),
          static_cast<float>((distance - camera.near_plane) * depth), static_cast<float>(distance)};
}

corpus::Scene mesh_scene(const Mesh& mesh, const Camera& camera, int width, int height, bool normals) {
  check_camera(camera);
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  if (normals) scene.attributes.push_back({"normal", 3, Interpolation::perspective});
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.viewport = Viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1, {}, {}};
  draw.front_face = FrontFace::counter_clockwise;
  draw.depth_mode = DepthMode::clip;
  draw.vertices.reserve(mesh.positions.size());
  const double aspect = static_cast<double>(width) / height;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const ClipVertex clip = project(camera, aspect, mesh.positions[i]);
    corpus::SceneVertex& vertex = draw.vertices.emplace_back();
    vertex.x = clip.x;
    vertex.y = clip.y;
    vertex.z = clip.z;
    vertex.w = clip.w;
    if (normals) vertex.attributes.assign(mesh.normals[i].begin(), mesh.normals[i].end());
  }
  draw.triangles.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) draw.triangles.push_back({triangle, std::nullopt});
  return scene;
}

}  // namespace surefill::meshes
