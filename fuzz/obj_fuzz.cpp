// SPDX-License-Identifier: Apache-2.0
//
// The readers of meshes (OBJ; PLY and STL, which their first bytes or their size tell) on any bytes: a MeshError of one line that names the file; or a mesh whose indices are in range and whose
// positions survive a round trip through text, that becomes a valid scene, which the engine draws as the oracle does.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string>
#include <string_view>

#include "corpus/mesh.hpp"
#include "fuzz/finding.hpp"
#include "oracle/oracle.hpp"
#include "properties/machinery/compare.hpp"
#include "properties/machinery/trial.hpp"

namespace surefill::fuzz {
namespace {

[[noreturn]] void fail(const std::string& relation, std::string_view text) {
  report_finding("obj", relation, std::string(text) + "\n");
}

// The mesh as text: decimals that name each float32.
std::string write_obj(const meshes::Mesh& mesh) {
  std::string text;
  for (const meshes::Float3& p : mesh.positions) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

bool same(const meshes::Float3& a, const meshes::Float3& b) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(a) == std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

void check_round_trip(const meshes::Mesh& mesh, std::string_view text) {
  if (mesh.non_finite_triangles != 0) return;  // how a NaN is written is no matter
  for (const meshes::Float3& p : mesh.positions) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) return;
  }
  const meshes::Mesh again = meshes::parse_obj(write_obj(mesh), "input");
  if (again.triangles.size() != mesh.triangles.size()) fail("the mesh that was written has other triangles", text);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!same(mesh.positions[mesh.triangles[t][i]], again.positions[again.triangles[t][i]])) {
        fail("a position of the mesh that was written is another one", text);
      }
    }
  }
}

void check_picture(const meshes::Mesh& mesh, std::string_view text) {
  constexpr int kSize = 12;
  constexpr std::size_t kMostTriangles = 64;  // more are slow, and say no more
  if (mesh.triangles.size() > kMostTriangles) return;
  corpus::Scene scene;
  try {
    scene = meshes::mesh_scene(mesh, meshes::framing_camera(mesh, kSize, kSize), kSize, kSize);
  } catch (const meshes::MeshError&) {
    return;  // no camera sees it: without extent, or beyond double
  }
  note_scene([&] { return scene; });
  corpus::Frame expected(scene, properties::kCountOnly), actual(scene, properties::kCountOnly);
  if (const Status status = render(actual.target(), actual.draws()); status != Status::ok) {
    fail(std::string("the mesh is no valid frame: ") + status_text(status), text);
  }
  oracle::render(expected.target(), expected.draws());
  const properties::Comparison comparison = properties::compare(scene, expected.image(), actual.image(), 1);
  if (comparison.differences != 0) {
    fail(properties::describe(comparison.first.at(0), 1) + "\n" + corpus::write_scene(scene), text);
  }
}

void check(std::string_view text) {
  meshes::Mesh mesh;
  try {
    mesh = meshes::parse_mesh(text, "input");
  } catch (const meshes::MeshError& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("input:")) fail("the error does not name the file: " + std::string(message), text);
    if (message.find('\n') != message.npos) fail("the error has several lines", text);
    return;
  }
  if (mesh.triangles.empty()) fail("a mesh without triangles is no error", text);
  if (mesh.normals.size() != mesh.positions.size()) fail("there is not one normal a vertex", text);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      if (v >= mesh.positions.size()) fail("a triangle names a vertex that there is not", text);
    }
  }
  check_round_trip(mesh, text);
  check_picture(mesh, text);
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  surefill::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
