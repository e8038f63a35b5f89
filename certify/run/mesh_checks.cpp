// SPDX-License-Identifier: Apache-2.0
//
// The engine's image of real meshes against the exact one. The oracle's share is cut into bands of rows, so that the
// work spreads over threads; the engine draws each image once, whole.
#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "certify/run/checks.hpp"
#include "corpus/mesh.hpp"
#include "properties/machinery/compare.hpp"

namespace surefill::certify {

namespace {

using corpus::Image;
using corpus::Scene;

constexpr int kBands = 12;  // of rows, per image

struct View {
  Scene scene;
  std::once_flag once;
  Status status = Status::ok;  // of the engine
  Image image;                 // the engine's
};

// Rows [first, last) of an image of one sample a pixel.
Image rows(const Image& image, int first, int last) {
  Image part;
  part.width = image.width;
  part.height = last - first;
  part.samples = image.samples;
  const auto cut = [&image, first, last](const auto& values, auto& out, std::ptrdiff_t components) {
    const std::ptrdiff_t row = image.width * components;
    if (!values.empty()) out.assign(values.begin() + first * row, values.begin() + last * row);
  };
  cut(image.count, part.count, 1);
  cut(image.index, part.index, 1);
  cut(image.depth, part.depth, 1);
  cut(image.barycentrics, part.barycentrics, 3);
  return part;
}

// Three cameras: the whole mesh from the front; from behind and below, close, so that it leaves the screen; and from
// inside, where half of the mesh is behind the eye.
std::vector<meshes::Camera> cameras(const meshes::Mesh& mesh, int width, int height) {
  const meshes::Camera front = meshes::framing_camera(mesh, width, height);
  meshes::Camera behind = front;
  meshes::Camera inside = front;
  const meshes::Box box = meshes::bounds(mesh);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    behind.eye[axis] = front.target[axis] - (front.eye[axis] - front.target[axis]) * 0.45;
    inside.eye[axis] = box.centre()[axis];
    inside.target[axis] = box.centre()[axis] + (axis == 0 ? 1 : 0.3) * box.radius();
  }
  behind.field_of_view = 55;
  inside.field_of_view = 90;
  meshes::fit_planes(behind, mesh);
  meshes::fit_planes(inside, mesh);
  return {front, behind, inside};
}

// The scene with this one pixel alone: rows and columns after it are cut off, which is exact, those before it
// scissored.
Scene at_pixel(const Scene& scene, int x, int y) {
  Scene pixel = scene;
  pixel.width = x + 1;
  pixel.height = y + 1;
  pixel.draws[0].scissor = Scissor{x, y, x + 1, y + 1};
  return pixel;
}

class MeshCheck {
 public:
  MeshCheck(const Settings& settings, std::string file) : settings_(settings), file_(std::move(file)) {}

  std::uint64_t prepare() {
    const meshes::Mesh mesh = meshes::load_obj(settings_.corpus + "/meshes/" + file_);
    const bool small = settings_.level == Level::quick;
    const int width = small ? 320 : 1920, height = small ? 180 : 1080;
    for (const meshes::Camera& camera : cameras(mesh, width, height)) {
      views_.push_back(std::make_unique<View>());
      views_.back()->scene = meshes::mesh_scene(mesh, camera, width, height);
    }
    return views_.size() * kBands;
  }

  CaseResult run(std::uint64_t number) {
    View& view = *views_[number / kBands];
    const int band = static_cast<int>(number % kBands);
    std::call_once(view.once, [this, &view] {
      corpus::Frame frame(view.scene);
      view.status = settings_.engine(frame.target(), frame.draws());
      view.image = std::move(frame.image());
    });
    CaseResult result;
    if (view.status != Status::ok) {
      result.differences = 1;
      result.finding = std::string("the engine returned \"") + status_text(view.status) + "\"";
      return result;
    }
    const int first = view.scene.height * band / kBands, last = view.scene.height * (band + 1) / kBands;
    Scene scene = view.scene;
    scene.height = last;
    scene.draws[0].scissor = Scissor{0, first, scene.width, last};
    corpus::Frame frame(scene);
    (void)properties::oracle_renderer()(frame.target(), frame.draws());
    properties::Comparison comparison =
        properties::compare(scene, rows(frame.image(), first, last), rows(view.image, first, last), 1);
    result.samples = comparison.samples;
    result.differences = comparison.differences;
    if (comparison.differences > 0) {
      properties::Difference& difference = comparison.first.front();
      difference.y += first;
      result.finding = "camera " + std::to_string(number / kBands + 1) + ": " + describe_finding(difference, 1);
      // The whole image may be needed for the engine to go wrong; else one pixel of it is enough to look at.
      Scene pixel = at_pixel(view.scene, difference.x, difference.y);
      const bool enough = judge(pixel, properties::oracle_renderer(), settings_.engine, 0).differences > 0;
      result.scene = enough ? std::move(pixel) : view.scene;
    }
    return result;
  }

 private:
  const Settings& settings_;
  std::string file_;
  std::vector<std::unique_ptr<View>> views_;
};

}  // namespace

void add_mesh_checks(const Settings& settings, std::vector<Check>& checks) {
  for (const std::string name : {"spot", "teapot"}) {
    const auto mesh = std::make_shared<MeshCheck>(settings, name + ".obj");
    Check check =
        make_check("mesh-" + name, "C, I, V, M2",
                   "count, index, depth and barycentrics of " + name + " from three cameras, one inside, at " +
                       by_level(settings.level, "320 x 180", "1920 x 1080", "1920 x 1080") + ": engine = oracle");
    check.unit = "bands of rows";
    check.exhaustive = true;
    check.prepare = [mesh] { return mesh->prepare(); };
    check.cost = by_level(settings.level, 0.015, 0.3, 0.3);
    check.run = [mesh](std::uint64_t number) { return mesh->run(number); };
    check.still_fails = [&settings](const Scene& scene) {
      return valid(scene) && judge(scene, properties::oracle_renderer(), settings.engine, 0).differences > 0;
    };
    checks.push_back(std::move(check));
  }
}

}  // namespace surefill::certify
