// SPDX-License-Identifier: Apache-2.0
//
// Mesh files: one mesh in every form, damaged files refused with their place, seeded damage survived, and cameras.
#include "corpus/mesh.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace surefill::meshes {
namespace {

// A pyramid of a quad and four triangles, with numbers that decimals do not hold.
const std::vector<Float3> kPositions = {
    {-0.1f, 0.7f, 1e-30f}, {1.1f, 0.7f, -3}, {1.1f, 2.3f, 16777216.0f}, {-0.1f, 2.3f, 0.3f}, {0.5f, -1.0f / 3, 5}};
const std::vector<std::vector<std::uint32_t>> kFaces = {{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};

std::string number_bytes(std::uint64_t bits, std::size_t size, bool big) {
  std::string bytes(size, '\0');
  for (std::size_t k = 0; k < size; ++k) bytes[big ? size - 1 - k : k] = static_cast<char>(bits >> (8 * k) & 0xFF);
  return bytes;
}
std::string number_bytes(float value, bool big) {
  return number_bytes(std::bit_cast<std::uint32_t>(value), 4, big);
}
std::string decimal(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

std::string obj() {
  std::string text;
  for (const Float3& p : kPositions) text += "v " + decimal(p[0]) + " " + decimal(p[1]) + " " + decimal(p[2]) + "\n";
  for (const auto& face : kFaces) {
    text += "f";
    for (const std::uint32_t v : face) text += " " + std::to_string(v + 1);
    text += "\n";
  }
  return text;
}

// With other properties and another element about those that are read.
std::string ply_header(const std::string& format, const std::string& end = "\n") {
  const char* const lines[] = {"comment by hand",
                               "obj_info nothing",
                               "element camera 1",
                               "property double angle",
                               "element vertex 5",
                               "property uchar red",
                               "property float x",
                               "property float y",
                               "property list uchar short near",
                               "property float32 z",
                               "element face 5",
                               "property int16 kind",
                               "property list uint8 int32 vertex_index",
                               "end_header"};
  std::string text = "ply" + end + "format " + format + " 1.0" + end;
  for (const char* line : lines) text += line + end;
  return text;
}

std::string ascii_ply(const std::string& end = "\n") {
  std::string text = ply_header("ascii", end) + "0.25" + end;
  for (const Float3& p : kPositions)
    text += "255 " + decimal(p[0]) + " " + decimal(p[1]) + " 2 -7 9 " + decimal(p[2]) + end;
  for (const auto& face : kFaces) {
    text += "-1 " + std::to_string(face.size());
    for (const std::uint32_t v : face) text += " " + std::to_string(v);
    text += end;
  }
  return text;
}

std::string binary_ply(bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian");
  bytes += number_bytes(std::bit_cast<std::uint64_t>(0.25), 8, big);
  for (const Float3& p : kPositions) {
    bytes += '\xFF' + number_bytes(p[0], big) + number_bytes(p[1], big) + '\2' + number_bytes(0xFFF9, 2, big) +
             number_bytes(9, 2, big) + number_bytes(p[2], big);
  }
  for (const auto& face : kFaces) {
    bytes += number_bytes(0xFFFF, 2, big) + static_cast<char>(face.size());
    for (const std::uint32_t v : face) bytes += number_bytes(v, 4, big);
  }
  return bytes;
}

std::vector<std::array<Float3, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<Float3, 3>> triangles;
  for (const auto& t : mesh.triangles) {
    triangles.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  return triangles;
}

std::string ascii_stl() {
  std::string text = "solid pyramid of five faces\n";
  for (const auto& triangle : triangles_of(parse_obj(obj()))) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const Float3& p : triangle)
      text += "      vertex " + decimal(p[0]) + " " + decimal(p[1]) + " " + decimal(p[2]) + "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid pyramid\n";
}

std::string binary_stl(const std::string& head = "solid, they say") {
  const auto triangles = triangles_of(parse_obj(obj()));
  std::string bytes = head + std::string(80 - head.size(), ' ') + number_bytes(triangles.size(), 4, false);
  for (const auto& triangle : triangles) {
    for (int k = 0; k < 3; ++k) bytes += number_bytes(0.0f, false);
    for (const Float3& p : triangle) {
      for (const float value : p) bytes += number_bytes(value, false);
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

struct Form {
  std::string name, bytes;
};
std::vector<Form> forms() {
  return {{"m.ply", ascii_ply()},
          {"crlf.ply", ascii_ply("\r\n")},
          {"little.ply", binary_ply(false)},
          {"big.ply", binary_ply(true)},
          {"m.stl", ascii_stl()},
          {"binary.stl", binary_stl()},
          {"named.obj", binary_stl()},
          {"none", ascii_ply()}};
}

std::string refusal(const std::string& bytes, const std::string& name) {
  try {
    (void)parse_mesh(bytes, name);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeshFiles, OneMeshInEveryForm) {
  const auto expected = triangles_of(parse_obj(obj()));
  ASSERT_EQ(expected.size(), 6u);
  for (const Form& form : forms()) {
    const Mesh mesh = parse_mesh(form.bytes, form.name);
    EXPECT_EQ(triangles_of(mesh), expected) << form.name;  // bit for bit: there is no -0 and no NaN
    EXPECT_EQ(mesh.positions.size(), 5u) << form.name;
    EXPECT_EQ(mesh.normals, parse_obj(obj()).normals) << form.name;
  }
}

TEST(MeshFiles, NormalsOfAFileAreKept) {
  const Mesh mesh = parse_mesh(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\n"
      "property float ny\nproperty float nz\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n"
      "0 0 0 0.5 0 0.5\n1 0 0 0 1 0\n0 1 0 0 0 -1\n3 0 1 2\n",
      "n.ply");
  EXPECT_EQ(mesh.normals, (std::vector<Float3>{{0.5f, 0, 0.5f}, {0, 1, 0}, {0, 0, -1}}));
}

TEST(MeshFiles, NumbersThatAreNone) {
  std::string text = ascii_ply();
  text.replace(text.find("0.699999988"), 11, "nan");
  const Mesh mesh = parse_mesh(text, "m.ply");
  EXPECT_EQ(mesh.non_finite_triangles, 3u);
  std::string bytes = binary_stl();
  bytes.replace(84 + 12, 4, number_bytes(std::numeric_limits<float>::infinity(), false));
  EXPECT_EQ(parse_mesh(bytes, "m.stl").non_finite_triangles, 1u);
}

// Of a file of lines each shorter one, of a binary file each shorter one, is refused; and so is a longer one.
TEST(MeshFiles, EveryCutIsRefused) {
  for (const Form& form : forms()) {
    const bool text = form.bytes == ascii_ply() || form.bytes == ascii_ply("\r\n") || form.bytes == ascii_stl();
    for (std::size_t size = 0; size < form.bytes.size(); ++size) {
      // The last line may lack its end, and an STL's last words name the solid.
      if (text && form.bytes.find('\n', size) == form.bytes.size() - 1) continue;
      const std::string cause = refusal(form.bytes.substr(0, size), form.name);
      EXPECT_NE(cause, "accepted") << form.name << " cut to " << size;
    }
    EXPECT_EQ(refusal(form.bytes, form.name), "accepted") << form.name;
    if (form.name == "named.obj") continue;  // no binary STL any more
    EXPECT_NE(refusal(form.bytes + "x\n", form.name), "accepted") << form.name;
  }
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(MeshFiles, RefusalsNamePlaceAndCause) {
  const std::string ply = ascii_ply(), stl = ascii_stl(), little = binary_ply(false);
  const struct {
    std::string bytes, name, message;
  } refusals[] = {
      {"v 0 0 0\n", "m.ply", "m.ply: not a PLY file: its first line is not \"ply\""},
      {"", "m.ply", "m.ply: not a PLY file"},
      {"ply\nformat ascii 1.0\n", "m.ply", "m.ply: it ends within its header (there is no \"end_header\")"},
      {with(ply, "ascii", "binary"), "m.ply", "m.ply:2: the format must be ascii, binary_little_endian or"},
      {with(ply, "1.0", "2.0"), "m.ply", "m.ply:2: the format must be"},
      {with(ply, "comment by hand", "format ascii 1.0"), "m.ply", "m.ply:3: a second line \"format\""},
      {with(ply, "format ascii 1.0\n", ""), "m.ply", "m.ply:15: the header has no line \"format\""},
      {with(ply, "comment by hand", "colour red"), "m.ply", "m.ply:3: \"colour\" is no line of a PLY header"},
      {with(ply, "comment by hand", ""), "m.ply", "m.ply:3: an empty line in the header"},
      {with(ply, "comment by hand", "property float x"), "m.ply", "m.ply:3: a property before any element"},
      {with(ply, "element camera 1", "element camera -1"), "m.ply", "m.ply:5: an element has a name and a number"},
      {with(ply, "element camera 1", "element camera 1e1"), "m.ply", "m.ply:5: an element has a name and a number"},
      {with(ply, "element camera 1", "element vertex 1"), "m.ply", "m.ply:7: a second element \"vertex\""},
      {with(ply, "property double angle", "property real angle"), "m.ply",
       "m.ply:6: \"real\" is no type of a PLY file"},
      {with(ply, "property double angle", "property angle"), "m.ply", "m.ply:6: a property has a type and a name, or"},
      {with(ply, "list uchar short", "list float short"), "m.ply", "m.ply:11: the length of a list is no whole number"},
      {with(ply, "property float y", "property float x"), "m.ply", "m.ply:10: a second property \"x\""},
      {with(ply, "property float32 z", "property float32 depth"), "m.ply",
       "its element \"vertex\" has no property \"z\""},
      {with(ply, "element vertex 5", "element point 5"), "m.ply", "m.ply: no element \"vertex\" in it"},
      {with(ply, "element face 5", "element tristrips 5"), "m.ply", "m.ply: its triangles are strips (\"tristrips\")"},
      {with(ply, "element face 5", "element edge 5"), "m.ply", "m.ply: no triangle in it: it has no element \"face\""},
      {with(ply, "int32 vertex_index", "float vertex_index"), "m.ply",
       "has no list \"vertex_indices\" of whole numbers"},
      {with(ply, "element vertex 5", "element vertex 4"), "m.ply",
       "m.ply:22: \"0.5\" is no number of its type (within face 0 of 5)"},
      {with(ply, "element vertex 5", "element vertex 6"), "m.ply",
       "m.ply:23: \"-1\" is no number of its type (within vertex 5 of 6)"},
      {with(ply, "element face 5", "element face 6"), "m.ply", "m.ply: it ends early, within face 5 of 6"},
      {with(ply, "element face 5", "element face 4"), "m.ply", "m.ply:27: more lines than the header's elements have"},
      {with(ply, "element face 5", "element face 4000000000"), "m.ply",
       "m.ply: it ends early: 4000000000 elements \"face\" do not"},
      {with(ply, "-1 3 0 4 1", "-1 3 0 4"), "m.ply", "m.ply:24: too few numbers (within face 1 of 5)"},
      {with(ply, "255 -0.1", "256 -0.1"), "m.ply", "m.ply:18: \"256\" is no number of its type (within vertex 0 of 5)"},
      {with(ply, " 2 -7 9 ", " 2 -7 9 1 "), "m.ply", "m.ply:18: 1 numbers too many (within vertex 0 of 5)"},
      {with(ply, " 2 -7 9 ", " 3 -7 9 "), "m.ply", "m.ply:18: \"1e-30\" is no number"},
      {with(ply, "-1 3 0 4 1", "-1 2 0 4"), "m.ply",
       "m.ply:24: a face needs three corners, found 2 (within face 1 of 5)"},
      {with(ply, "-1 3 0 4 1", "-1 3 0 4 5"), "m.ply",
       "m.ply: face 1 names vertex 5, but there are 5 (they count from 0)"},
      {with(ply, "-1 3 0 4 1", "-1 3 0 -4 1"), "m.ply", "m.ply: face 1 names vertex -4, but there are 5"},
      {with(ply, "-1 3 0 4 1", "-1 3 0 4.0 1"), "m.ply", "m.ply:24: \"4.0\" is no number of its type"},
      {with(ply, "-1 3 0 4 1", "-1 3 0 \x1b[0m 1"), "m.ply", "m.ply:24: \"?[0m\" is no number of its type"},
      {little.substr(0, little.size() - 3), "m.ply", "m.ply: it ends early, within face 4 of 5"},
      {little + "\n", "m.ply", "m.ply: 1 bytes more than the header's elements have"},
      {with(little, "element vertex 5", "element vertex 99"), "m.ply", "m.ply: it ends early"},
      {with(little, "element face 5", "element face 0").substr(0, little.size() - 5 * 3 - 16 * 4), "m.ply",
       "m.ply: no triangle in it"},
      {with(stl, "facet normal 0 0 0", "facet normal 0 0"), "m.stl",
       "m.stl:2: expected \"facet normal\" and three numbers, found \"facet\""},
      {with(stl, "outer loop", "outer"), "m.stl", "m.stl:3: expected \"outer loop\", found \"outer\""},
      {with(stl, "vertex", "vertices"), "m.stl", "m.stl:4: expected \"vertex\" and three numbers, found \"vertices\""},
      {with(stl, "vertex -0.1", "vertex -0.1x"), "m.stl", "\" is not a number"},
      {with(stl, "endfacet", "facet"), "m.stl", "m.stl:8: expected \"endfacet\", found \"facet\""},
      {stl.substr(0, stl.find("endsolid")), "m.stl", "m.stl: it ends early: a facet or \"endsolid\" is missing"},
      {"solid nothing\nendsolid\n", "m.stl", "m.stl: no triangle in it"},
      {binary_stl("other") + "x", "m.stl", "m.stl: a binary STL file of 6 triangles has 384 bytes, and this one 385"},
      {std::string("a\0b", 3), "m.stl", "m.stl: not an STL file: it neither begins with \"solid\" nor has 84 bytes"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.stl", "m.stl:1: expected \"solid\", found \"v\""},
  };
  for (const auto& [bytes, name, message] : refusals) {
    const std::string cause = refusal(bytes, name);
    EXPECT_NE(cause.find(message), std::string::npos) << cause << "\nwanted: " << message;
    EXPECT_EQ(cause.find('\n'), std::string::npos) << cause;
    EXPECT_TRUE(cause.starts_with(name + ":")) << cause;
  }
}

// Sampled: 40,000 damaged files, seed 1. A mesh in range, or one line that begins with the name.
TEST(MeshFiles, SeededDamageIsSurvived) {
  std::mt19937_64 random(1);
  const std::vector<Form> all = forms();
  std::set<std::string> causes;
  int accepted = 0;
  for (int n = 0; n < 40000; ++n) {
    Form form = all[random() % all.size()];
    for (std::uint64_t edits = 1 + random() % 4; edits > 0 && !form.bytes.empty(); --edits) {
      const std::size_t at = random() % form.bytes.size(), length = random() % 9;
      switch (random() % 5) {
        case 0:
          form.bytes[at] = static_cast<char>(random());
          break;
        case 1:
          form.bytes[at] = static_cast<char>(form.bytes[at] ^ (1 << random() % 8));
          break;
        case 2:
          form.bytes.erase(at, length);
          break;
        case 3:
          form.bytes.insert(at, form.bytes.substr(random() % form.bytes.size(), length));
          break;
        default:
          form.bytes.insert(at, length % 2 == 0 ? "4294967295" : "-1");
      }
    }
    try {
      const Mesh mesh = parse_mesh(form.bytes, form.name);
      ++accepted;
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.positions.size());
      }
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    } catch (const MeshError& error) {
      const std::string cause = error.what();
      ASSERT_TRUE(cause.starts_with(form.name + ":")) << cause;
      ASSERT_EQ(cause.find('\n'), std::string::npos) << cause;
      causes.insert(cause.substr(cause.find(": ") + 2, 12));
    }
  }
  EXPECT_GE(accepted, 2000);
  EXPECT_GE(causes.size(), 20u);
}

// ---- orthographic cameras
TEST(OrthographicCamera, ProjectsBoxesToTheClipCube) {
  Camera camera;
  camera.eye = {10, 20, 40}, camera.target = {10, 20, 0}, camera.height = 8, camera.near_plane = 30,
  camera.far_plane = 50;
  // Two units right of the middle and one above it, half way between the planes; the picture is twice as wide as high.
  const ClipVertex v = project(camera, 2, {12, 21, 0});
  EXPECT_EQ((std::array{v.x, v.y, v.z, v.w}), (std::array{0.25f, 0.25f, 0.5f, 1.0f}));
  camera.near_plane = -10;  // what is behind the eye is seen, too
  EXPECT_NO_THROW(check_camera(camera));
  EXPECT_EQ(project(camera, 2, {10, 20, 50}).z, 0.0f);
  camera.far_plane = -10;
  EXPECT_THROW(check_camera(camera), MeshError);
}

TEST(OrthographicCamera, TheFittingHeightHoldsTheMesh) {
  const Mesh mesh = parse_obj(obj());
  for (const auto& [width, height] : {std::pair{300, 100}, {100, 300}}) {
    Camera camera = framing_camera(mesh, width, height);
    camera.height = fitting_height(camera, mesh, width, height);
    fit_planes(camera, mesh);
    check_camera(camera);
    float most = 0;
    for (const Float3& position : mesh.positions) {
      const ClipVertex v = project(camera, static_cast<double>(width) / height, position);
      most = std::max({most, std::abs(v.x), std::abs(v.y)});
      EXPECT_TRUE(v.z >= 0 && v.z <= 1 && v.w == 1);
    }
    EXPECT_TRUE(most > 0.9f && most < 1) << most;
  }
}

}  // namespace
}  // namespace surefill::meshes
