// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "certify/rivals/draw_words.hpp"
#include "corpus/scene.hpp"

namespace surefill::adapters {

namespace {

using corpus::corners_of;

// The enumerators of both headers have the same values, so a cast translates.
static_assert(static_cast<int>(FillRule::northwards_west) == SUREFILL_ADAPTER_NORTHWARDS_WEST);
static_assert(static_cast<int>(GridRounding::truncate) == SUREFILL_ADAPTER_TRUNCATE);
static_assert(static_cast<int>(Interpolation::flat) == SUREFILL_ADAPTER_CONSTANT);
static_assert(static_cast<int>(DepthMode::clamp) == SUREFILL_ADAPTER_CLAMP_DEPTH);
static_assert(static_cast<int>(Conservative::inner) == SUREFILL_ADAPTER_CONSERVATIVE_INNER);
static_assert(static_cast<int>(Cull::back) == SUREFILL_ADAPTER_CULL_BACK);
static_assert(kNoTriangle == SUREFILL_ADAPTER_EMPTY);
static_assert(static_cast<int>(Primitive::lines) == SUREFILL_ADAPTER2_LINES);
static_assert(static_cast<int>(Primitive::points) == SUREFILL_ADAPTER2_POINTS);

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

bool finite(const AttributeArray& array, std::size_t vertices) {
  const std::size_t stride = array.stride == 0 ? array.components : array.stride;
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t c = 0; c < array.components; ++c) {
      if (!std::isfinite(array.values[v * stride + c])) return false;
    }
  }
  return true;
}

// The features that one draw needs.
std::uint32_t features_of(const Draw& draw, std::size_t wanted_attributes) {
  std::uint32_t features = 0;
  const auto need = [&features](bool condition, int bit) {
    if (condition) features |= static_cast<std::uint32_t>(bit);
  };
  for (const Vertex& v : draw.vertices) {
    need(!(v.w > 0), SUREFILL_ADAPTER_BEHIND);
    need(!finite(v), SUREFILL_ADAPTER_NON_FINITE);
  }
  need(draw.cull != Cull::none, SUREFILL_ADAPTER_CULL);
  need(draw.scissor.has_value(), SUREFILL_ADAPTER_SCISSOR);
  need(draw.depth_mode == DepthMode::clip, SUREFILL_ADAPTER_DEPTH_CLIP);
  need(draw.depth_mode == DepthMode::clamp, SUREFILL_ADAPTER_DEPTH_CLAMP);
  need(!draw.depth_write, SUREFILL_ADAPTER_DEPTH_READ_ONLY);
  need(!std::is_sorted(draw.identifiers.begin(), draw.identifiers.end()), SUREFILL_ADAPTER_IDENTIFIERS);
  need(draw.conservative == Conservative::over, SUREFILL_ADAPTER_OVER);
  need(draw.conservative == Conservative::inner, SUREFILL_ADAPTER_INNER);
  need(draw.primitive == Primitive::lines, static_cast<int>(kLines));
  need(draw.primitive == Primitive::points, static_cast<int>(kPoints));
  need(draw.primitive != Primitive::triangles && draw.width.has_value(), static_cast<int>(SUREFILL_ADAPTER2_WIDTHS));
  for (std::size_t k = 0; k < draw.attributes.size(); ++k) {
    const AttributeArray& array = draw.attributes[k];
    need(!finite(array, draw.vertices.size()), SUREFILL_ADAPTER_NON_FINITE);
    if (k >= wanted_attributes) continue;
    need(array.interpolation == Interpolation::noperspective, SUREFILL_ADAPTER_NOPERSPECTIVE);
    need(array.interpolation == Interpolation::flat, SUREFILL_ADAPTER_FLAT);
  }
  return features;
}

constexpr const char* kFeatureNames[] = {"vertices with W <= 0",
                                         "several draws",
                                         "several samples a pixel",
                                         "culling",
                                         "scissor",
                                         "depth clipping",
                                         "depth clamping",
                                         "depth test greater",
                                         "depth write off",
                                         "initial depth",
                                         "identifiers out of order",
                                         "noperspective attributes",
                                         "flat attributes",
                                         "centroid attributes",
                                         "conservative rasterization, over",
                                         "conservative rasterization, inner",
                                         "fill rules of draws",
                                         "grids of draws",
                                         "NaN and infinities",
                                         "fill rules closed and open",
                                         "widths of lines and points",
                                         "lines",
                                         "points"};
static_assert(std::size(kFeatureNames) == kFeatureBits);

// What version 1 of the adapter has no word for, of a frame.
const char* mode_without_word(const Target& target, std::span<const Draw> draws) {
  if (target.origin != Origin{}) return "an origin";
  if (!target.sample_locations.empty()) return "sample locations of its own";
  if (target.layers != 1) return "layers";
  if (!target.winding.empty()) return "the winding";
  if (target.depth_test > DepthTest::greater) return "depth tests less-equal and greater-equal";
  for (const Draw& draw : draws) {
    if (!draw.covered.empty() || !draw.visible.empty()) return "numbers of triangles";
    if (draw.conservative != Conservative::none && !target.index.empty()) return "the index of conservative draws";
  }
  return nullptr;
}

bool exceeds(std::size_t value, std::uint32_t limit) {
  return limit != 0 && value > limit;
}

// One axis of a viewport: where it begins, how far it goes.
struct Span {
  float begin, length;
};

// Centred on the pixel origin and a power of two, so that clip space is pixel space times a power of two: no vertex is
// rounded on the way, neither here nor there. It holds the target and, as far as the rival's targets go, every vertex
// in front of the eye, so that none is clipped but for depth. A target of more than half of that begins at the origin.
Span wide_span(int size, double farthest, std::uint32_t limit) {
  const auto fitting = static_cast<float>(std::bit_ceil(static_cast<unsigned>(size)));
  const auto most = static_cast<float>(std::bit_floor(limit == 0 ? static_cast<unsigned>(kMaxTargetSize) : limit));
  float half = fitting;
  if (2 * half > most) return {0, fitting};
  while (half < farthest && 4 * half <= most) half *= 2;
  return {-half, 2 * half};
}

Viewport wide_viewport(const Target& target, std::span<const Vertex> vertices, const ClipForm& form) {
  double x = 0, y = 0;
  for (const Vertex& v : vertices) {
    if (!finite(v) || !(v.w > 0)) continue;
    x = std::max(x, std::abs(static_cast<double>(v.x) / v.w));
    y = std::max(y, std::abs(static_cast<double>(v.y) / v.w));
  }
  const Span across = wide_span(target.width, x, form.max_width), down = wide_span(target.height, y, form.max_height);
  Viewport viewport;
  viewport.x = across.begin;
  viewport.y = down.begin;
  viewport.width = across.length;
  viewport.height = down.length;
  if (form.depth_range == SUREFILL_ADAPTER_MINUS_ONE_TO_ONE) viewport.clip_depth = ClipDepth::minus_one_to_one;
  return viewport;
}

// The inverse of S3, rounded to float32. Doubles beyond float32 become infinities.
ClipVertex clip_of(const Vertex& v, const Viewport& viewport) {
  const double x = v.x, y = v.y, z = v.z, w = v.w, width = viewport.width, height = viewport.height;
  const double depth = viewport.clip_depth == ClipDepth::zero_to_one ? z : 2 * z - w;
  // The centre of the viewport: the origin, or that of a viewport which begins there.
  const double centre_x = viewport.x + width / 2, centre_y = viewport.y + height / 2;
  return {static_cast<float>(2 * (x - centre_x * w) / width), static_cast<float>(2 * (centre_y * w - y) / height),
          static_cast<float>(depth), v.w};
}

// Is W a power of two, and is every number on the way along one axis a float32: from the centre of the viewport, and as a part of it?
bool comes_exactly(float position, float w, double centre, double length) {
  int exponent = 0;
  if (!(w > 0) || !std::isfinite(w) || std::frexp(w, &exponent) != 0.5f) return false;
  const double from_centre = position - centre * w, part = 2 * from_centre / length;
  const bool is_difference = from_centre + centre * w == position && position - from_centre == centre * w;
  return is_difference && static_cast<float>(from_centre) == from_centre && static_cast<float>(part) == part &&
         part * length == 2 * from_centre && std::abs(part) <= w;
}

bool is_under(const Viewport& viewport, const Vertex& v) {
  return finite(v) && comes_exactly(v.x, v.w, viewport.x + viewport.width / 2.0, viewport.width) &&
         comes_exactly(v.y, v.w, viewport.y + viewport.height / 2.0, viewport.height);
}

// An ordinary one, if there is one that fits; one draw in four has a wide one all the same.
Viewport viewport_of(const Target& target, const Draw& draw, const ClipForm& form) {
  constexpr std::size_t kFewVertices = 64;
  const Viewport wide = wide_viewport(target, draw.vertices, form);
  if (form.wide || draw.primitive != Primitive::triangles || draw.vertices.empty() ||
      draw.vertices.size() > kFewVertices)
    return wide;
  const std::uint32_t first = (std::bit_cast<std::uint32_t>(draw.vertices[0].x) * 0x9E3779B9u) >> 30;
  for (std::uint32_t n = 0; n < 3 && first < 3; ++n) {
    Viewport viewport = ordinary_viewports(target.width, target.height)[(first + n) % 3];
    viewport.clip_depth = wide.clip_depth;
    const auto fits = [&viewport](const Vertex& v) { return is_under(viewport, v); };
    if (std::all_of(draw.vertices.begin(), draw.vertices.end(), fits)) return viewport;
  }
  return wide;
}

template <typename Value>
Value* data_or_null(std::span<Value> values) {
  return values.empty() ? nullptr : values.data();
}

}  // namespace

std::vector<Draw> under_model(std::span<const Draw> draws, const surefill_adapter_info& info) {
  std::vector<Draw> result(draws.begin(), draws.end());
  const surefill_adapter_model& model = info.model;
  for (Draw& draw : result) {
    if (model.kind == SUREFILL_ADAPTER_MODEL_UNKNOWN) continue;
    if (!(info.features & SUREFILL_ADAPTER_FILL_RULES)) draw.fill_rule = static_cast<FillRule>(model.fill_rule);
    if (info.features & SUREFILL_ADAPTER_GRIDS) continue;
    draw.grid.reset();
    if (model.kind == SUREFILL_ADAPTER_MODEL_GRID && draw.conservative == Conservative::none &&
        draw.primitive == Primitive::triangles) {
      draw.grid = Grid{static_cast<int>(model.grid_bits), static_cast<int>(model.grid_offset_x),
                       static_cast<int>(model.grid_offset_y), static_cast<GridRounding>(model.grid_rounding)};
    }
  }
  return result;
}

std::uint32_t needed_features(const Target& target, std::span<const Draw> draws) {
  std::uint32_t features = 0;
  const auto need = [&features](bool condition, int bit) {
    if (condition) features |= static_cast<std::uint32_t>(bit);
  };
  for (const Draw& draw : draws) {
    features |= features_of(draw, target.attributes.size());
    need(draw.fill_rule != FillRule::top_left, SUREFILL_ADAPTER_FILL_RULES);
    need(draw.fill_rule > FillRule::northwards_west, static_cast<int>(SUREFILL_ADAPTER2_CLOSED_AND_OPEN));
    need(draw.grid.has_value(), SUREFILL_ADAPTER_GRIDS);
  }
  need(draws.size() > 1, SUREFILL_ADAPTER_DRAWS);
  need(target.samples > 1, SUREFILL_ADAPTER_SAMPLES);
  need(target.depth_test == DepthTest::greater, SUREFILL_ADAPTER_DEPTH_GREATER);
  need(!target.initial_depth.empty(), SUREFILL_ADAPTER_INITIAL_DEPTH);
  need(target.attribute_location == AttributeLocation::centroid && target.samples > 1, SUREFILL_ADAPTER_CENTROID);
  return features;
}

const char* feature_name(int bit) {
  return kFeatureNames[bit];
}

std::string what_is_lacking(const Target& target, std::span<const Draw> draws, const surefill_adapter_info& info) {
  constexpr std::uint32_t kTaken = SUREFILL_ADAPTER_FILL_RULES | SUREFILL_ADAPTER_GRIDS;  // or the model's
  const std::uint32_t missing = needed_features(target, draws) & ~info.features & ~kTaken;
  if (missing != 0) return kFeatureNames[std::countr_zero(missing)];
  if (const char* lacking = mode_without_word(target, draws); lacking != nullptr) return lacking;
  for (const Draw& draw : draws) {
    DrawState state = draw.state();
    if (info.features & SUREFILL_ADAPTER2_CLOSED_AND_OPEN) state.fill_rule = FillRule::top_left;
    // Claimed, as was seen above; and a width of triangles has no part.
    state.primitive = Primitive::triangles;
    state.width.reset();
    if (const std::string_view field = field_without_word(state); !field.empty()) {
      return std::string(field) + " of a value that version 1 of the adapter has no word for";
    }
  }
  if (exceeds(static_cast<std::size_t>(target.width), info.max_width) ||
      exceeds(static_cast<std::size_t>(target.height), info.max_height)) {
    return "targets of this size";
  }
  if (exceeds(target.attributes.size(), info.max_attributes)) return "this number of attributes";
  for (const AttributeTarget& attribute : target.attributes) {
    if (exceeds(attribute.components, info.max_components)) return "attributes of this number of components";
  }
  for (const Draw& draw : draws) {
    if (exceeds(draw.vertices.size(), info.max_vertices)) return "draws of this number of vertices";
    if (exceeds(draw.indices.size() / corners_of(draw.primitive), info.max_triangles)) {
      return "draws of this number of triangles";
    }
  }
  if (info.form == SUREFILL_ADAPTER_FORM_CLIP) {
    const AdapterFrame frame(target, draws, clip_form(info, false));
    for (std::size_t d = 0; d < draws.size(); ++d) {
      if (!frame.scene().draws[d].clip_is_exact) return "vertices that have no exact clip form";
    }
  }
  return "";
}

ClipForm clip_form(const surefill_adapter_info& info, bool wide) {
  return {info.model.depth_range, info.max_width, info.max_height, wide};
}

std::array<Viewport, 3> ordinary_viewports(int width, int height) {
  const auto part = [](int x, int y, int across, int down) {
    Viewport viewport;
    viewport.x = static_cast<float>(x);
    viewport.y = static_cast<float>(y);
    viewport.width = static_cast<float>(std::max(across, 1));
    viewport.height = static_cast<float>(std::max(down, 1));
    return viewport;
  };
  return {part(0, 0, width, height), part(width / 5, height / 3, width - width / 5, height - height / 3 - height / 4),
          part(width / 3, height / 6, width - width / 3 - width / 7, height - height / 6)};
}

AdapterFrame::AdapterFrame(const Target& target, std::span<const Draw> draws, const ClipForm& form)
    : storage_(draws.size()), draws_(draws.size()) {
  const std::size_t attributes = target.attributes.size();
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const Draw& from = draws[d];
    Storage& storage = storage_[d];
    surefill_adapter_draw& to = draws_[d];
    const std::size_t vertices = from.vertices.size(), triangles = from.indices.size() / corners_of(from.primitive);
    primitives_.push_back({static_cast<std::uint32_t>(from.primitive),
                           from.primitive == Primitive::triangles ? 0 : from.width.value_or(0)});
    const Viewport viewport = viewport_of(target, from, form);
    std::vector<ClipVertex> clip(vertices);
    std::vector<Vertex> back(vertices);
    std::transform(from.vertices.begin(), from.vertices.end(), clip.begin(),
                   [&viewport](const Vertex& v) { return clip_of(v, viewport); });
    // What is not finite has no exact form; as near as it comes, it is not finite in clip space either.
    to.clip_is_exact = to_pixel(viewport, clip, back) == Status::ok;
    for (std::size_t v = 0; v < vertices && to.clip_is_exact; ++v) {
      const bool same = std::memcmp(&back[v], &from.vertices[v], sizeof(Vertex)) == 0;
      to.clip_is_exact = same || (!finite(from.vertices[v]) && !finite(back[v]));
    }
    for (std::size_t v = 0; v < vertices; ++v) {
      const Vertex& p = from.vertices[v];
      storage.pixel.insert(storage.pixel.end(), {p.x, p.y, p.z, p.w});
      storage.clip.insert(storage.clip.end(), {clip[v].x, clip[v].y, clip[v].z, clip[v].w});
    }
    for (std::size_t t = 0; t < triangles; ++t) {
      storage.identifiers.push_back(from.identifiers.empty() ? from.first_index + static_cast<std::uint32_t>(t)
                                                             : from.identifiers[t]);
    }
    for (std::size_t k = 0; k < attributes; ++k) {
      const AttributeArray& array = from.attributes[k];
      const std::size_t stride = array.stride == 0 ? array.components : array.stride;
      std::vector<float>& values = storage.values.emplace_back();
      for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t c = 0; c < array.components; ++c) values.push_back(array.values[v * stride + c]);
      }
      storage.attributes.push_back({nullptr, array.components, static_cast<std::uint32_t>(array.interpolation)});
    }
    for (std::size_t k = 0; k < attributes; ++k) storage.attributes[k].values = storage.values[k].data();
    to.vertex_count = static_cast<std::uint32_t>(vertices);
    to.triangle_count = static_cast<std::uint32_t>(triangles);
    to.pixel = storage.pixel.data();
    to.clip = storage.clip.data();
    to.indices = from.indices.data();
    to.identifiers = storage.identifiers.data();
    to.attributes = storage.attributes.data();
    to.viewport_x = viewport.x;
    to.viewport_y = viewport.y;
    to.viewport_width = viewport.width;
    to.viewport_height = viewport.height;
    to.viewport_near = viewport.near_depth;
    to.viewport_far = viewport.far_depth;
    to.viewport_depth_range = static_cast<std::uint32_t>(viewport.clip_depth);
    set_words(from.state(), to);
  }
  scene_.width = static_cast<std::uint32_t>(target.width);
  scene_.height = static_cast<std::uint32_t>(target.height);
  scene_.samples = static_cast<std::uint32_t>(target.samples);
  scene_.depth_test = static_cast<std::uint32_t>(target.depth_test);
  scene_.attribute_location = static_cast<std::uint32_t>(target.attribute_location);
  scene_.attribute_count = static_cast<std::uint32_t>(attributes);
  scene_.draw_count = static_cast<std::uint32_t>(draws_.size());
  scene_.draws = draws_.data();
  scene_.initial_depth = data_or_null(target.initial_depth);
  image_.count = data_or_null(target.count);
  image_.index = data_or_null(target.index);
  image_.depth = data_or_null(target.depth);
  image_.barycentrics = data_or_null(target.barycentrics);
  for (const AttributeTarget& attribute : target.attributes)
    attribute_images_.push_back(data_or_null(attribute.values));
  image_.attributes = attribute_images_.empty() ? nullptr : attribute_images_.data();
}

void AdapterFrame::turn_viewports() {
  for (surefill_adapter_draw& draw : draws_) {
    draw.viewport_y = static_cast<float>(scene_.height) - draw.viewport_y - draw.viewport_height;
  }
}

}  // namespace surefill::adapters
