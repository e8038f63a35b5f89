// SPDX-License-Identifier: Apache-2.0
//
// The compiled half of the Python package: NumPy arrays to spans over the same memory, and the call, without the GIL.
// surefill/__init__.py checks types and shapes and has the documentation; here only the engine's own checks remain.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cfenv>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "surefill/occlusion.hpp"

namespace py = pybind11;

namespace surefill {
namespace {

using FloatArray = py::array_t<float, py::array::c_style>;
using IndexArray = py::array_t<std::uint32_t, py::array::c_style>;

// What __init__.py hands over is C-contiguous and of the right type, so nothing is copied.
template <typename T, typename Array>
std::span<const T> view(const std::optional<Array>& array) {
  if (!array) return {};
  return {reinterpret_cast<const T*>(array->data()), static_cast<std::size_t>(array->nbytes()) / sizeof(T)};
}

template <typename T, typename Array>
std::span<T> view_output(std::optional<Array>& array) {
  if (!array) return {};
  return {reinterpret_cast<T*>(array->mutable_data()), static_cast<std::size_t>(array->nbytes()) / sizeof(T)};
}

void check(Status status) {
  switch (status) {
    case Status::ok:
      return;
    case Status::out_of_memory:
      throw std::bad_alloc();
    case Status::draw_index_out_of_range:
      throw py::index_error("triangles: an index that names no row of positions");
    case Status::draw_identifiers:
      throw py::value_error("identifiers: NO_TRIANGLE (-1 as int32) is what an empty sample holds");
    case Status::bad_build:
      throw std::runtime_error(status_text(status));
    case Status::viewport:
      throw py::value_error("depth_range: two finite float32 are needed");
    default:
      throw py::value_error(status_text(status));
  }
}

// Attributes: pairs of values, a row for each vertex, and the output array.
using AttributePairs = std::vector<std::tuple<FloatArray, FloatArray>>;

void render_arrays(const FloatArray& positions, const IndexArray& triangles, int height, int width, int samples,
                   std::optional<IndexArray> identifiers, const AttributePairs& attributes, int interpolation,
                   int fill_rule, int front_face, int cull, int depth_test, int depth_mode, int conservative,
                   std::optional<FloatArray> initial_depth, std::optional<IndexArray> index,
                   std::optional<FloatArray> depth, std::optional<FloatArray> barycentrics,
                   std::optional<IndexArray> count, int threads) {
  std::vector<AttributeArray> arrays;
  std::vector<AttributeTarget> targets;
  for (const auto& [in, out] : attributes) {
    const auto components = static_cast<std::uint32_t>(in.shape(1));
    std::optional<FloatArray> output = out;
    arrays.push_back({view<float, FloatArray>(in), components, 0, static_cast<Interpolation>(interpolation)});
    targets.push_back({view_output<float>(output), components});
  }
  Target target;
  target.width = width, target.height = height, target.samples = samples;
  target.depth_test = static_cast<DepthTest>(depth_test);
  target.index = view_output<std::uint32_t>(index);
  target.depth = view_output<float>(depth);
  target.barycentrics = view_output<float>(barycentrics);
  target.count = view_output<std::uint32_t>(count);
  target.initial_depth = view<float>(initial_depth);
  target.attributes = targets;
  Draw draw;
  draw.vertices = view<Vertex, FloatArray>(positions);
  draw.indices = view<std::uint32_t, IndexArray>(triangles);
  draw.identifiers = view<std::uint32_t>(identifiers);
  draw.attributes = arrays;
  draw.fill_rule = static_cast<FillRule>(fill_rule);
  draw.front_face = static_cast<FrontFace>(front_face);
  draw.cull = static_cast<Cull>(cull);
  draw.depth_mode = static_cast<DepthMode>(depth_mode);
  draw.conservative = static_cast<Conservative>(conservative);
  Options options;
  options.threads = threads;
  Status status;
  {
    const py::gil_scoped_release release;
    status = render(target, {&draw, 1}, nullptr, options);
  }
  check(status);
}

// The float32 nearest to a Python number, whatever the caller's rounding mode, FTZ and DAZ are; its flags are kept.
[[gnu::noinline]] float rounded(const volatile double& number) {
  return static_cast<float>(number);
}
float nearest(double number) {
  std::fenv_t callers;
  std::fegetenv(&callers);
  std::fesetenv(FE_DFL_ENV);
  const float result = rounded(number);
  std::fesetenv(&callers);
  return result;
}

void to_pixel_arrays(const FloatArray& clip, FloatArray out, int width, int height, double near_depth, double far_depth,
                     int clip_depth, int clip_y) {
  const Viewport viewport{0,
                          0,
                          static_cast<float>(width),
                          static_cast<float>(height),
                          nearest(near_depth),
                          nearest(far_depth),
                          static_cast<ClipDepth>(clip_depth),
                          static_cast<ClipY>(clip_y)};
  std::optional<FloatArray> output = std::move(out);
  const std::span<Vertex> to = view_output<Vertex>(output);
  Status status;
  {
    const py::gil_scoped_release release;
    status = to_pixel(viewport, view<ClipVertex, FloatArray>(clip), to);
  }
  check(status);
}

}  // namespace
}  // namespace surefill

PYBIND11_MODULE(_surefill, module) {
  using namespace surefill;
  using py::arg;
  module.attr("version") = SUREFILL_VERSION;
  module.attr("max_size") = kMaxTargetSize;
  module.def("render", &render_arrays, arg("positions").noconvert(), arg("triangles").noconvert(), arg("height"),
             arg("width"), arg("samples"), arg("identifiers").noconvert(), arg("attributes").noconvert(),
             arg("interpolation"), arg("fill_rule"), arg("front_face"), arg("cull"), arg("depth_test"),
             arg("depth_mode"), arg("conservative"), arg("initial_depth").noconvert(), arg("index").noconvert(),
             arg("depth").noconvert(), arg("barycentrics").noconvert(), arg("count").noconvert(), arg("threads"));
  module.def("to_pixel", &to_pixel_arrays, arg("clip").noconvert(), arg("out").noconvert(), arg("width"), arg("height"),
             arg("near_depth"), arg("far_depth"), arg("clip_depth"), arg("clip_y"));
}
