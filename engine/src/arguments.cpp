// SPDX-License-Identifier: Apache-2.0
//
// B2: every argument is checked before anything is written.
#include "arguments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "exact/edge.hpp"
#include "facts.hpp"
#include "overlap.hpp"
#include "surefill/surefill.hpp"

namespace surefill {
namespace {

constexpr std::uint64_t kLargestIndex = std::numeric_limits<std::uint32_t>::max();

template <typename T>
bool null_but_not_empty(std::span<T> s) {
  return s.data() == nullptr && !s.empty();
}

// Empty (not asked for), or a buffer of exactly `size` elements. Sizes are computed in 64 bits, whatever std::size_t has.
template <typename T>
bool fits(std::span<T> buffer, std::uint64_t size) {
  return buffer.empty() || (buffer.data() != nullptr && buffer.size() == size);
}

bool size_ok(const Target& target) {
  const auto good = [](int size) { return size >= 1 && size <= kMaxTargetSize; };
  return good(target.width) && good(target.height);
}

bool samples_ok(const Target& target) {
  const int n = target.samples;
  return n == 1 || n == 2 || n == 4 || n == 8 || n == 16;
}

// Of a target whose size and samples are good: at most 2^32.
std::uint64_t samples_of(const Target& target) {
  return static_cast<std::uint64_t>(target.width) * static_cast<std::uint64_t>(target.height) *
         static_cast<std::uint64_t>(target.samples);
}

bool layers_ok(const Target& target) {
  return target.layers >= 1 && target.layers <= kMaxLayers;
}

bool origin_ok(const Target& target) {
  const auto good = [](int place) { return place >= -kMaxOrigin && place <= kMaxOrigin; };
  return good(target.origin.x) && good(target.origin.y);
}

bool locations_ok(const Target& target) {
  const auto good = [](int place) { return place >= 0 && place <= 15; };
  if (!fits(target.sample_locations, static_cast<std::uint64_t>(target.samples))) return false;
  for (const SampleLocation& location : target.sample_locations) {
    if (!good(location.x) || !good(location.y)) return false;
  }
  return true;
}

// Of a good number of components.
bool fits(const AttributeTarget& image, std::uint64_t samples) {
  const std::uint64_t stride = stride_of(image), components = image.components, size = image.values.size();
  if (stride <= components) return stride == components && fits(image.values, components * samples);
  if (null_but_not_empty(image.values)) return false;
  // Of up to 2^36 samples and 2^32 - 1 floats each, the product is compared as a quotient.
  return size == 0 || (size >= components && (size - components) / stride >= samples - 1);
}

Status validate_target(const Target& target, Outputs& outputs) {
  if (!size_ok(target)) return Status::target_size;
  if (!samples_ok(target)) return Status::target_samples;
  if (!layers_ok(target)) return Status::target_layers;
  if (!origin_ok(target)) return Status::target_origin;
  if (!locations_ok(target)) return Status::target_sample_locations;
  const std::uint64_t total = samples_of(target), in_layers = static_cast<std::uint64_t>(target.layers) * total;
  if (!fits(target.count, total)) return Status::target_count;
  if (!fits(target.winding, total)) return Status::target_winding;
  if (!fits(target.index, in_layers)) return Status::target_index;
  if (!fits(target.depth, in_layers)) return Status::target_depth;
  if (!fits(target.barycentrics, 3 * in_layers)) return Status::target_barycentrics;
  if (null_but_not_empty(target.attributes) || target.attributes.size() > kMaxAttributes)
    return Status::target_attributes;
  for (const AttributeTarget& attribute : target.attributes) {
    if (attribute.components < 1 || attribute.components > kMaxComponents) return Status::target_attributes;
    if (!fits(attribute, in_layers)) return Status::target_attributes;
  }
  if (!fits(target.initial_depth, total)) return Status::target_initial_depth;
  if (target.depth_test > DepthTest::greater_equal) return Status::target_depth_test;
  if (target.attribute_location > AttributeLocation::centroid) return Status::target_attribute_location;

  // The initial depth may be the depth buffer itself, of one layer, but not overlap it otherwise.
  const bool same = target.layers == 1 && !target.depth.empty() && target.initial_depth.data() == target.depth.data();
  const bool apart = outputs.add_buffers(target) && (same || !outputs.touched_by(Bytes(target.initial_depth))) &&
                     !outputs.touched_by(Bytes(target.attributes)) && !outputs.touched_by(Bytes::of(&target)) &&
                     !outputs.touched_by(Bytes(target.sample_locations));
  return apart ? Status::ok : Status::target_overlap;
}

Status validate_attributes(const Target& target, const Draw& draw) {
  if (null_but_not_empty(draw.attributes) || draw.attributes.size() > kMaxAttributes ||
      draw.attributes.size() < target.attributes.size()) {
    return Status::draw_attributes;
  }
  for (std::size_t k = 0; k < draw.attributes.size(); ++k) {
    const AttributeArray& attribute = draw.attributes[k];
    if (attribute.components < 1 || attribute.components > kMaxComponents) return Status::draw_attributes;
    if (k < target.attributes.size() && attribute.components != target.attributes[k].components) {
      return Status::draw_attributes;
    }
    if (attribute.stride != 0 && attribute.stride < attribute.components) return Status::draw_attributes;
    const std::uint64_t stride = stride_of(attribute);
    // Below 2^32 vertices and strides, so nothing overflows.
    const std::uint64_t needed = draw.vertices.empty() ? 0 : (draw.vertices.size() - 1) * stride + attribute.components;
    if (null_but_not_empty(attribute.values) || attribute.values.size() < needed) return Status::draw_attributes;
    if (attribute.interpolation > Interpolation::flat) return Status::draw_attribute_interpolation;
  }
  return Status::ok;
}

// B5. Without an early end, so that it is vector code.
bool has_no_triangle(std::span<const std::uint32_t> identifiers) {
  bool found = false;
  for (const std::uint32_t identifier : identifiers) found |= identifier == kNoTriangle;
  return found;
}

// Does every index name a vertex? First by signs, which is vector code on every processor: of up to 2^31 vertices an
// index is in range if it and its distance to the last are below 2^31. What that does not settle, the largest does.
bool indices_in_range(const Draw& draw) {
  const auto last = static_cast<std::uint32_t>(draw.vertices.size() - 1);
  std::uint32_t signs = 0, largest = 0;
  for (const std::uint32_t index : draw.indices) signs |= index | (last - index);
  if (signs >> 31 == 0) return true;
  for (const std::uint32_t index : draw.indices) largest = std::max(largest, index);
  return draw.indices.empty() || largest < draw.vertices.size();
}

Status validate_draw(const Target& target, const Draw& draw, const Outputs& outputs) {
  if (draw.primitive > Primitive::points) return Status::draw_primitive;
  const std::uint64_t vertices = draw.vertices.size(), triangles = triangles_of(draw);
  if (null_but_not_empty(draw.vertices) || vertices > kLargestIndex) return Status::draw_vertices;
  if (null_but_not_empty(draw.indices) || draw.indices.size() % corners_of(draw) != 0 || triangles >= kLargestIndex) {
    return Status::draw_indices;
  }
  if (!draw.identifiers.empty() && (draw.identifiers.data() == nullptr || draw.identifiers.size() != triangles)) {
    return Status::draw_identifiers;
  }
  if (has_no_triangle(draw.identifiers)) return Status::draw_identifiers;
  if (draw.identifiers.empty() && triangles > kLargestIndex - draw.first_index) return Status::draw_first_index;
  if (const Status status = validate_attributes(target, draw); status != Status::ok) return status;
  const bool needs_step = draw.grid || !has_triangles(draw);
  if (draw.fill_rule > FillRule::open || (needs_step && !moves_samples(draw.fill_rule))) return Status::draw_fill_rule;
  if (draw.front_face > FrontFace::counter_clockwise) return Status::draw_front_face;
  if (draw.cull > Cull::back) return Status::draw_cull;
  if (draw.depth_mode > DepthMode::clamp) return Status::draw_depth_mode;
  if (draw.grid) {
    const Grid& grid = *draw.grid;
    const auto offset_ok = [](int offset) { return offset >= 0 && offset <= 15; };
    if (grid.bits < 0 || grid.bits > 12 || !offset_ok(grid.offset_x) || !offset_ok(grid.offset_y) ||
        grid.rounding > GridRounding::truncate || !has_triangles(draw)) {
      return Status::draw_grid;
    }
  }
  if (draw.depth_bias &&
      !(std::isfinite(draw.depth_bias->constant) && std::isfinite(draw.depth_bias->slope) && has_triangles(draw))) {
    return Status::draw_depth_bias;
  }
  if (draw.width && !(std::isfinite(*draw.width) && *draw.width > 0)) return Status::draw_width;
  if (draw.primitive == Primitive::lines && !draw.width && target.samples != 1) return Status::draw_width;
  if (target.layers > 1 && !draw.depth_write) return Status::target_layers;
  if (draw.conservative > Conservative::touched) return Status::draw_conservative;
  if (draw.conservative != Conservative::none) {
    const Wanted wanted = wanted_outputs(target);
    if (wanted.shading || !target.depth.empty() || !target.winding.empty() || target.samples != 1 ||
        draw.depth_mode != DepthMode::none || draw.grid || !has_triangles(draw)) {
      return Status::draw_conservative;
    }
    if (target.layers > 1) return Status::target_layers;
    if (!target.sample_locations.empty()) return Status::target_sample_locations;
  }
  if (!fits(draw.covered, triangles)) return Status::draw_covered;
  if (!fits(draw.visible, triangles)) return Status::draw_visible;
  bool apart = !outputs.touched_by(Bytes(draw.vertices)) && !outputs.touched_by(Bytes(draw.indices)) &&
               !outputs.touched_by(Bytes(draw.identifiers)) && !outputs.touched_by(Bytes(draw.attributes));
  for (const AttributeArray& attribute : draw.attributes) apart = apart && !outputs.touched_by(Bytes(attribute.values));
  if (!apart) return Status::target_overlap;
  return indices_in_range(draw) ? Status::ok : Status::draw_index_out_of_range;
}

// M10: is it a frame whose conservative draws may have these outputs, and are they apart from each other?
Status validate_numbers(std::span<const Draw> draws) {
  const bool conservative =
      std::any_of(draws.begin(), draws.end(), [](const Draw& draw) { return draw.conservative != Conservative::none; });
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Bytes covered(draws[d].covered), visible(draws[d].visible);
    if (conservative && !draws[d].visible.empty()) return Status::draw_visible;
    if (covered.overlaps(visible)) return Status::target_overlap;
    const std::span<const Draw> before = draws.first(covered.empty() && visible.empty() ? 0 : d);
    for (const Draw& other : before) {
      const Bytes theirs[] = {Bytes(other.covered), Bytes(other.visible)};
      for (const Bytes& bytes : theirs) {
        if (covered.overlaps(bytes) || visible.overlaps(bytes)) return Status::target_overlap;
      }
    }
  }
  return Status::ok;
}

Status validate_frame(const Target& target, std::span<const Draw> draws, Outputs& outputs) {
  const bool null = null_but_not_empty(draws);
  if (!null) outputs.add_numbers(draws);
  if (const Status status = validate_target(target, outputs); status != Status::ok) return status;
  if (null) return Status::draws;
  if (outputs.touched_by(Bytes(draws))) return Status::target_overlap;
  for (const Draw& draw : draws) {
    if (const Status status = validate_draw(target, draw, outputs); status != Status::ok) return status;
  }
  return outputs.has_numbers() ? validate_numbers(draws) : Status::ok;
}

}  // namespace

std::size_t sample_total(const Target& target) noexcept {
  if (!size_ok(target) || !samples_ok(target)) return 0;
  const std::uint64_t largest = std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(std::min(samples_of(target), largest));  // no buffer has so many elements
}

Status validate(const Target& target, std::span<const Draw> draws) noexcept {
  Outputs outputs;
  return validate_frame(target, draws, outputs);
}

Status check_call(const Target& target, std::span<const Draw> draws, const Statistics* statistics,
                  const Options& options) noexcept {
  if (options.threads < 1 || options.threads > kMaxThreads) return Status::options_threads;
  if (options.path > Path::reference) return Status::options_path;
  Outputs outputs;
  outputs.add(Bytes::of(statistics));
  if (!outputs.add(Bytes::of(options.diagnostics))) return Status::target_overlap;
  if (const Status status = validate_frame(target, draws, outputs); status != Status::ok) return status;
  const bool touched = outputs.touched_by(Bytes::of(&options)) || outputs.touched_by(Bytes::of(options.context)) ||
                       outputs.numbers_touch(Bytes::of(statistics)) ||
                       outputs.numbers_touch(Bytes::of(options.diagnostics));
  return touched ? Status::target_overlap : Status::ok;
}

const char* status_text(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::out_of_memory:
      return "out of memory";
    case Status::target_size:
      return "the target's width or height is outside 1..16384";
    case Status::target_samples:
      return "the target's samples are not 1, 2, 4, 8 or 16";
    case Status::target_count:
      return "the count buffer's size is not that of the target";
    case Status::target_index:
      return "the index buffer's size is not that of the target's layers";
    case Status::target_depth:
      return "the depth buffer's size is not that of the target's layers";
    case Status::target_barycentrics:
      return "the barycentrics buffer's size is not 3 floats for each sample of the target's layers";
    case Status::target_attributes:
      return "an attribute target has components outside 1..4, a wrong size or stride, or there are over 16";
    case Status::target_initial_depth:
      return "the initial depth's size is not that of the target";
    case Status::target_overlap:
      return "an output overlaps another one, or a buffer, list or struct that the call reads";
    case Status::target_depth_test:
      return "the depth test is not an enumerator of DepthTest";
    case Status::target_attribute_location:
      return "the attribute location is not an enumerator of AttributeLocation";
    case Status::draws:
      return "the list of draws is null but not empty";
    case Status::draw_vertices:
      return "a draw's vertex buffer is null or too large";
    case Status::draw_indices:
      return "a draw's indices are null, no multiple of 3 (of lines: of 2), or too many";
    case Status::draw_index_out_of_range:
      return "a draw has an index that names no vertex";
    case Status::draw_identifiers:
      return "a draw's identifiers are neither empty nor one for each triangle, or one is 2^32 - 1";
    case Status::draw_first_index:
      return "a draw's first index plus its triangles exceed 2^32 - 1";
    case Status::draw_attributes:
      return "a draw's attribute arrays are too few, too short, or have other components than the target";
    case Status::draw_attribute_interpolation:
      return "an attribute's interpolation is not an enumerator of Interpolation";
    case Status::draw_fill_rule:
      return "a draw's fill rule is not an enumerator of FillRule, or is closed or open with a grid, lines or points";
    case Status::draw_front_face:
      return "a draw's front face is not an enumerator of FrontFace";
    case Status::draw_cull:
      return "a draw's culling is not an enumerator of Cull";
    case Status::draw_depth_mode:
      return "a draw's depth mode is not an enumerator of DepthMode";
    case Status::draw_conservative:
      return "a draw's conservative mode is not an enumerator of Conservative, or the frame has more than count and "
             "index, several samples, a depth mode, a grid, lines or points";
    case Status::draw_grid:
      return "a draw's grid has bits outside 0..12, an offset outside 0..15 or an unknown rounding, or is of lines or "
             "points";
    case Status::viewport:
      return "a number of the viewport is not finite, or an enumerator is unknown";
    case Status::options_threads:
      return "the number of threads is outside 1..256";
    case Status::options_path:
      return "the path is not an enumerator of Path";
    case Status::query_boxes:
      return "the boxes or rectangles of the query are null or hold a number that is not finite";
    case Status::query_answers:
      return "the answers of the query are null or not one for each box";
    case Status::visitor:
      return "the visitor's function is null";
    case Status::bad_build:
      return "the library was compiled with options that break exact arithmetic, such as -ffast-math or FMA "
             "contraction";
    case Status::to_pixel_vertices:
      return "to_pixel's vertices or results are null, not equally many, or overlap what the call reads";
    case Status::target_outputs:
      return "the target of visit_coverage asks for an output or for layers";
    case Status::target_origin:
      return "the target's origin is outside -4194304..4194304";
    case Status::target_sample_locations:
      return "the sample locations are neither empty nor one for each sample, one is outside 0..15, or a draw is "
             "conservative";
    case Status::target_layers:
      return "the layers are outside 1..16, or above 1 with a draw that is conservative or writes no depth";
    case Status::target_winding:
      return "the winding buffer's size is not that of the target";
    case Status::draw_depth_bias:
      return "a draw's depth bias is not finite, or is of lines or points";
    case Status::draw_covered:
      return "a draw's covered numbers are neither empty nor one for each triangle";
    case Status::draw_visible:
      return "a draw's visible numbers are neither empty nor one for each triangle, or a draw is conservative";
    case Status::draw_primitive:
      return "a draw's primitive is not an enumerator of Primitive";
    case Status::draw_width:
      return "a draw's width is not finite and above 0, or its lines have none where there are several samples";
    case Status::draw_scissor:
      return "an occluder of a safe buffer has a scissor";
    case Status::draw_depth_write:
      return "an occluder of a safe buffer has depth write off";
    case Status::occluder_positions:
      return "an occluder mesh's positions are null, too many, incomplete, or less than 3 floats apart";
    case Status::occluder_mesh:
      return "an occluder's mesh is null";
    case Status::occluder_vertices:
      return "two vertices of an occluder that lie at one place of its mesh differ in X, Y or W";
  }
  return "unknown status";
}

}  // namespace surefill
