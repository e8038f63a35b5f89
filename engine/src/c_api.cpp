// SPDX-License-Identifier: Apache-2.0
//
// The C interface over the engine. Structs become their C++ counterparts; the engine checks what they hold, here only
// struct sizes and what C++ takes by reference are checked. Nothing throws, so nothing crosses the boundary.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>

#include "arguments.hpp"
#include "overlap.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"

struct surefill_context {
  surefill::Context context;
};

struct surefill_occlusion {
  surefill::OcclusionBuffer buffer;
};

struct surefill_occluder_mesh {
  surefill::OccluderMesh mesh;
};

struct surefill_safe_occlusion {
  surefill::SafeOcclusionBuffer buffer;
};

namespace surefill {
namespace {

static_assert(sizeof(surefill_vertex) == sizeof(Vertex) && sizeof(surefill_vertex) == sizeof(ClipVertex));
static_assert(sizeof(surefill_box) == sizeof(OcclusionBox));
static_assert(sizeof(surefill_rectangle) == sizeof(OcclusionRectangle));
static_assert(sizeof(Occlusion) == 1 && static_cast<int>(Occlusion::visible) == SUREFILL_VISIBLE);
static_assert(static_cast<int>(Status::query_answers) == SUREFILL_QUERY_ANSWERS);
static_assert(static_cast<int>(Status::bad_build) == SUREFILL_BAD_BUILD);
static_assert(static_cast<int>(Status::target_outputs) == SUREFILL_TARGET_OUTPUTS);
static_assert(static_cast<int>(Status::draw_visible) == SUREFILL_DRAW_VISIBLE);
static_assert(static_cast<int>(Status::occluder_vertices) == SUREFILL_OCCLUDER_VERTICES);
static_assert(static_cast<int>(Primitive::points) == SUREFILL_POINTS);
static_assert(static_cast<int>(Status::visitor) == SUREFILL_VISITOR);
static_assert(static_cast<int>(FillRule::open) == SUREFILL_OPEN);
static_assert(static_cast<int>(DepthTest::greater_equal) == SUREFILL_GREATER_EQUAL);
static_assert(static_cast<int>(Conservative::touched) == SUREFILL_CONSERVATIVE_TOUCHED);
static_assert(sizeof(surefill_place) == sizeof(SampleLocation) && sizeof(surefill_block) == sizeof(CoverageBlock));
static_assert(kMaxOrigin == SUREFILL_MAX_ORIGIN && kMaxLayers == SUREFILL_MAX_LAYERS);
static_assert(kMaxTargetSize == SUREFILL_MAX_TARGET_SIZE && kMaxAttributes == SUREFILL_MAX_ATTRIBUTES);
static_assert(kMaxComponents == SUREFILL_MAX_COMPONENTS && kMaxThreads == SUREFILL_MAX_THREADS);

surefill_status to_c(Status status) {
  return static_cast<surefill_status>(status);
}

// The C types name the same bytes as the C++ ones.
std::span<const Vertex> vertices_of(const surefill_vertex* vertices, std::size_t count) {
  return {reinterpret_cast<const Vertex*>(vertices), count};
}

// 255 is no enumerator of any enumeration: what does not fit in a byte is refused like it.
template <typename Enumeration>
Enumeration enumerator(std::uint32_t value) {
  return static_cast<Enumeration>(std::min<std::uint32_t>(value, 255));
}

// The bytes of a struct up to and with `last`, a member of the first version: no struct is shorter.
#define SUREFILL_SIZE_TO(type, last) (offsetof(type, last) + sizeof(type::last))

// Copies what the caller knows of a struct; what it does not know is 0. False if its size is no size of this version.
template <typename Struct>
bool read_struct(const void* from, std::size_t least_size, Struct* to) {
  std::size_t size;
  std::memcpy(&size, from, sizeof size);
  if (size < least_size || size > sizeof(Struct)) return false;
  *to = {};
  std::memcpy(to, from, size);
  return true;
}

// A call's arguments in C++. Null lists stay null, with their size, for the engine's checks to see. These see copies,
// and not whether an output overlaps the originals: that is found out here.
class Arguments {
 public:
  // What `statistics` points to, which may be null, is written in the end.
  explicit Arguments(const surefill_statistics* statistics) {
    if (statistics == nullptr) return;
    std::size_t size;
    std::memcpy(&size, statistics, sizeof size);
    statistics_ = Bytes(statistics, size);
    outputs_.add(statistics_);
  }

  surefill_status read_target(const surefill_target* from) {
    if (from == nullptr) return SUREFILL_NULL_TARGET;
    surefill_target c;
    if (!read_struct(from, SUREFILL_SIZE_TO(surefill_target, attribute_location), &c))
      return SUREFILL_TARGET_STRUCT_SIZE;
    target.width = c.width, target.height = c.height, target.samples = c.samples;
    target.count = {c.count, c.count_count};
    target.index = {c.index, c.index_count};
    target.depth = {c.depth, c.depth_count};
    target.barycentrics = {c.barycentrics, c.barycentrics_count};
    target.initial_depth = {c.initial_depth, c.initial_depth_count};
    target.depth_test = enumerator<DepthTest>(c.depth_test);
    target.attribute_location = enumerator<AttributeLocation>(c.attribute_location);
    target.layers = c.layers == 0 ? 1 : static_cast<int>(std::min<std::uint32_t>(c.layers, INT32_MAX));
    target.origin = {c.origin_x, c.origin_y};
    target.sample_locations = {reinterpret_cast<const SampleLocation*>(c.sample_locations), c.sample_location_count};
    target.winding = {c.winding, c.winding_count};
    if (c.attributes == nullptr || c.attribute_count > kMaxAttributes) {
      target.attributes = {static_cast<const AttributeTarget*>(nullptr), c.attribute_count};
    } else {
      for (std::size_t k = 0; k < c.attribute_count; ++k) {
        const surefill_attribute_target& attribute = c.attributes[k];
        attribute_targets_[k] = {{attribute.values, attribute.value_count}, attribute.components, attribute.stride};
      }
      target.attributes = {attribute_targets_, c.attribute_count};
    }
    overlaps_ = !outputs_.add_buffers(target);
    target_reads_[0] = Bytes(from, c.struct_size);
    target_reads_[1] = Bytes(std::span(c.attributes, c.attribute_count));
    target_reads_[2] = Bytes(target.sample_locations);
    if (c.initial_depth != c.depth) target_reads_[3] = Bytes(target.initial_depth);
    for (const Bytes& bytes : target_reads_) read(bytes);
    return SUREFILL_OK;
  }

  // The occlusion buffer, whose draws are to be read.
  template <typename Buffer>
  void read_occlusion(const Buffer& buffer) {
    const std::span<const float> depth = buffer.depth();
    target.width = buffer.width(), target.height = buffer.height();
    target.initial_depth = target.depth = {const_cast<float*>(depth.data()), depth.size()};
    overlaps_ = !outputs_.add_buffers(target);
  }

  surefill_status read_draws(const surefill_draw* from, std::size_t count) {
    if (from == nullptr) {
      draws = {static_cast<const Draw*>(nullptr), count};
      return SUREFILL_OK;
    }
    if (count == 0) return SUREFILL_OK;
    // Elements lie as far apart as the caller's struct is long.
    const std::size_t stride = from->struct_size;
    const auto* bytes = reinterpret_cast<const unsigned char*>(from);
    read(Bytes(from, count * stride));
    std::size_t attributes = 0, strided = 0;
    for (std::size_t i = 0; i < count; ++i) {
      surefill_draw c;
      if (!read_draw(bytes + i * stride, stride, &c)) return SUREFILL_DRAW_STRUCT_SIZE;
      if (!good_stride(c)) return SUREFILL_DRAW_VERTEX_STRIDE;
      attributes += listed_attributes(c);
      strided += strided_vertices(c);
    }
    draws_.reset(new (std::nothrow) Draw[count]);
    attributes_.reset(new (std::nothrow) AttributeArray[attributes]);
    vertices_.reset(new (std::nothrow) Vertex[strided]);
    if (draws_ == nullptr || attributes_ == nullptr || vertices_ == nullptr) return SUREFILL_OUT_OF_MEMORY;
    AttributeArray* next = attributes_.get();
    Vertex* copy = vertices_.get();
    for (std::size_t i = 0; i < count; ++i) {
      surefill_draw c;
      read_draw(bytes + i * stride, stride, &c);
      convert(c, draws_[i], next);
      note_reads(c);
      next += listed_attributes(c);
      if (const std::size_t n = strided_vertices(c); n != 0) {
        const auto* from_bytes = reinterpret_cast<const unsigned char*>(c.vertices);
        for (std::size_t v = 0; v < n; ++v) std::memcpy(copy + v, from_bytes + v * c.vertex_stride, sizeof(Vertex));
        draws_[i].vertices = {copy, n};
        copy += n;
      }
    }
    draws = {draws_.get(), count};
    // Only now are all outputs known: what the structs and lists are read from may not be one of them.
    outputs_.add_numbers(draws);
    overlaps_ = overlaps_ || outputs_.numbers_touch(statistics_);
    read(Bytes(from, count * stride));
    for (const Bytes& of_target : target_reads_) read(of_target);
    for (std::size_t i = 0; i < count && outputs_.has_numbers(); ++i) {
      surefill_draw c;
      read_draw(bytes + i * stride, stride, &c);
      note_reads(c);
    }
    return SUREFILL_OK;
  }

  surefill_status read_frame(const surefill_target* c_target, const surefill_draw* c_draws, std::size_t count) {
    const surefill_status status = read_target(c_target);
    return status != SUREFILL_OK ? status : read_draws(c_draws, count);
  }

  // Null is allowed for both.
  surefill_status read_options(const surefill_options* from, const surefill_statistics* statistics) {
    if (from != nullptr) {
      surefill_options c;
      if (!read_struct(from, SUREFILL_SIZE_TO(surefill_options, path), &c)) return SUREFILL_OPTIONS_STRUCT_SIZE;
      options_.threads = c.threads == 0 ? 1 : c.threads;
      options_.path = enumerator<Path>(c.path);
      options_.context = c.context != nullptr ? &c.context->context : nullptr;
      options_.executor = {c.executor, c.executor_context};
      read(Bytes(from, c.struct_size));
    }
    surefill_statistics unused;
    const bool known =
        statistics == nullptr || read_struct(statistics, SUREFILL_SIZE_TO(surefill_statistics, path), &unused);
    return known ? SUREFILL_OK : SUREFILL_STATISTICS_STRUCT_SIZE;
  }

  Status check() const {
    const Status status = check_call(target, draws, nullptr, options_);
    return status == Status::ok && overlaps_ ? Status::target_overlap : status;
  }

  // draw(statistics, options), unless an output overlaps what is read. Gives the statistics back.
  template <typename Function>
  surefill_status run(surefill_statistics* to, const Function& draw) const {
    Statistics s;
    Diagnostics d;
    Options options = options_;
    options.diagnostics = &d;
    const Status status = overlaps_ ? check() : draw(to == nullptr ? nullptr : &s, options);
    if (status == Status::ok && to != nullptr) {
      std::size_t size;
      std::memcpy(&size, to, sizeof size);
      const surefill_statistics result{size, s.triangles(), s.dropped, s.degenerate, s.culled, 0, s.rasterized, d.path};
      std::memcpy(to, &result, size);
    }
    return to_c(status);
  }

  Target target;
  std::span<const Draw> draws;

 private:
  static bool read_draw(const void* from, std::size_t stride, surefill_draw* c) {
    // Of a draw with another size than the first, the list may hold less than that.
    std::size_t size;
    std::memcpy(&size, from, sizeof size);
    return size == stride && read_struct(from, SUREFILL_SIZE_TO(surefill_draw, culling_box), c);
  }

  static bool good_stride(const surefill_draw& c) {
    if (c.vertex_stride == 0) return true;
    return c.vertex_stride >= sizeof(Vertex) && c.vertex_stride % alignof(Vertex) == 0 &&
           c.vertex_count <= static_cast<std::size_t>(PTRDIFF_MAX) / c.vertex_stride;
  }

  // How many vertices have to be copied, because the engine takes them dense. Precondition: the stride is good.
  static std::size_t strided_vertices(const surefill_draw& c) {
    const bool dense = c.vertex_stride == 0 || c.vertex_stride == sizeof(Vertex);
    return dense || c.vertices == nullptr || c.vertex_count > UINT32_MAX ? 0 : c.vertex_count;
  }

  void read(const Bytes& bytes) { overlaps_ = overlaps_ || outputs_.touched_by(bytes); }

  void note_reads(const surefill_draw& c) {
    const std::size_t stride = c.vertex_stride == 0 ? sizeof(Vertex) : c.vertex_stride;
    if (c.vertex_count != 0) read(Bytes(c.vertices, (c.vertex_count - 1) * stride + sizeof(Vertex)));
    read(Bytes(std::span(c.indices, c.index_count)));
    read(Bytes(std::span(c.identifiers, c.identifier_count)));
    read(Bytes::of(c.scissor));
    read(Bytes::of(c.grid));
    if (c.culling_box != nullptr) read(Bytes(std::span(c.culling_box, 8)));
    read(Bytes::of(c.depth_bias));
    const std::size_t listed = listed_attributes(c);
    read(Bytes(std::span(c.attributes, listed)));
    for (std::size_t k = 0; k < listed; ++k)
      read(Bytes(std::span(c.attributes[k].values, c.attributes[k].value_count)));
  }

  // How many of a draw's attribute arrays can be read.
  static std::size_t listed_attributes(const surefill_draw& c) {
    return c.attributes == nullptr || c.attribute_count > kMaxAttributes ? 0 : c.attribute_count;
  }

  static void convert(const surefill_draw& c, Draw& draw, AttributeArray* arrays) {
    draw.vertices = vertices_of(c.vertices, c.vertex_count);
    draw.indices = {c.indices, c.index_count};
    draw.identifiers = {c.identifiers, c.identifier_count};
    draw.first_index = c.first_index;
    draw.fill_rule = enumerator<FillRule>(c.fill_rule);
    draw.front_face = enumerator<FrontFace>(c.front_face);
    draw.cull = enumerator<Cull>(c.cull);
    draw.depth_mode = enumerator<DepthMode>(c.depth_mode);
    draw.depth_write = c.depth_write_off == 0;
    draw.conservative = enumerator<Conservative>(c.conservative);
    if (c.scissor != nullptr) draw.scissor = Scissor{c.scissor->x0, c.scissor->y0, c.scissor->x1, c.scissor->y1};
    if (c.grid != nullptr) {
      draw.grid = Grid{c.grid->bits, c.grid->offset_x, c.grid->offset_y, enumerator<GridRounding>(c.grid->rounding)};
    }
    if (c.culling_box != nullptr) {
      std::copy_n(vertices_of(c.culling_box, 8).begin(), 8, draw.culling_box.emplace().begin());
    }
    if (c.depth_bias != nullptr) draw.depth_bias = DepthBias{c.depth_bias->constant, c.depth_bias->slope};
    draw.primitive = enumerator<Primitive>(c.primitive);
    if (c.width != 0) draw.width = c.width;
    draw.covered = {c.covered, c.covered_count};
    draw.visible = {c.visible, c.visible_count};
    const std::size_t listed = listed_attributes(c);
    for (std::size_t k = 0; k < listed; ++k) {
      const surefill_attribute_array& a = c.attributes[k];
      arrays[k] = {{a.values, a.value_count}, a.components, a.stride, enumerator<Interpolation>(a.interpolation)};
    }
    draw.attributes = {listed == c.attribute_count ? arrays : nullptr, c.attribute_count};
  }

  AttributeTarget attribute_targets_[kMaxAttributes];
  std::unique_ptr<Draw[]> draws_;
  std::unique_ptr<AttributeArray[]> attributes_;
  std::unique_ptr<Vertex[]> vertices_;  // of all draws whose vertices have a stride
  Options options_;
  Outputs outputs_;
  Bytes statistics_;       // what is written of them
  Bytes target_reads_[4];  // what is read of the target
  bool overlaps_ = false;  // an output overlaps one of the originals
};

// One with a size, into *made.
template <typename Handle>
surefill_status create_occlusion(int32_t width, int32_t height, uint32_t depth_test, Handle** made) {
  if (made == nullptr) return SUREFILL_NULL_OCCLUSION;
  std::unique_ptr<Handle> handle(new (std::nothrow) Handle);
  if (handle == nullptr) return SUREFILL_OUT_OF_MEMORY;
  const Status status = handle->buffer.resize(width, height, enumerator<DepthTest>(depth_test));
  if (status == Status::ok) *made = handle.release();
  return to_c(status);
}

// What a draw of a safe buffer takes from its mesh, or has no use for.
surefill_status check_unused(const Draw& draw) {
  if (draw.indices.data() != nullptr || !draw.indices.empty()) return SUREFILL_DRAW_INDICES;
  if (!draw.identifiers.empty()) return SUREFILL_DRAW_IDENTIFIERS;
  if (!draw.attributes.empty()) return SUREFILL_DRAW_ATTRIBUTES;
  if (!draw.covered.empty()) return SUREFILL_DRAW_COVERED;
  return draw.visible.empty() ? SUREFILL_OK : SUREFILL_DRAW_VISIBLE;
}

// The draws with their meshes, or a null list where that of the draws is.
surefill_status occluders_of(std::span<const Draw> draws, const surefill_occluder_mesh* const* meshes,
                             std::unique_ptr<Occluder[]>& list, std::span<const Occluder>& occluders) {
  occluders = {static_cast<const Occluder*>(nullptr), draws.size()};
  if (draws.data() == nullptr) return SUREFILL_OK;
  if (meshes == nullptr) return SUREFILL_OCCLUDER_MESH;
  list.reset(new (std::nothrow) Occluder[draws.size()]);
  if (list == nullptr) return SUREFILL_OUT_OF_MEMORY;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (const surefill_status status = check_unused(draws[i]); status != SUREFILL_OK) return status;
    list[i].state() = draws[i].state();
    list[i].mesh = meshes[i] == nullptr ? nullptr : &meshes[i]->mesh;
    list[i].vertices = draws[i].vertices;
  }
  occluders = {list.get(), draws.size()};
  return SUREFILL_OK;
}

template <typename Box, typename CBox, typename Handle>
surefill_status query(const Handle* occlusion, const CBox* boxes, std::size_t count, std::uint8_t* answers) {
  if (occlusion == nullptr) return SUREFILL_NULL_OCCLUSION;
  return to_c(occlusion->buffer.query(std::span(reinterpret_cast<const Box*>(boxes), count),
                                      std::span(reinterpret_cast<Occlusion*>(answers), count)));
}

}  // namespace
}  // namespace surefill

using namespace surefill;

const char* surefill_version(void) {
  return SUREFILL_VERSION;
}

const char* surefill_status_text(surefill_status status) {
  std::uint32_t value;  // C lets any number pass, C++ has no such enumerators
  static_assert(sizeof value == sizeof status);
  std::memcpy(&value, &status, sizeof value);
  switch (value) {
    case SUREFILL_NULL_TARGET:
      return "the target is null";
    case SUREFILL_NULL_VIEWPORT:
      return "the viewport is null";
    case SUREFILL_NULL_OCCLUSION:
      return "the occlusion buffer is null";
    case SUREFILL_TARGET_STRUCT_SIZE:
      return "the target's struct_size is not known to this version";
    case SUREFILL_DRAW_STRUCT_SIZE:
      return "a draw's struct_size is not known to this version, or not that of the first draw";
    case SUREFILL_OPTIONS_STRUCT_SIZE:
      return "the options' struct_size is not known to this version";
    case SUREFILL_STATISTICS_STRUCT_SIZE:
      return "the statistics' struct_size is not known to this version";
    case SUREFILL_DRAW_VERTEX_STRIDE:
      return "a draw's vertex stride is under 16 bytes, no multiple of 4, or too large";
    default:
      return status_text(static_cast<Status>(value));
  }
}

surefill_status surefill_to_pixel(const surefill_viewport* viewport, const surefill_vertex* vertices, size_t count,
                                  surefill_vertex* out) {
  if (viewport == nullptr) return SUREFILL_NULL_VIEWPORT;
  const Viewport v{viewport->x,
                   viewport->y,
                   viewport->width,
                   viewport->height,
                   viewport->near_depth,
                   viewport->far_depth,
                   enumerator<ClipDepth>(viewport->clip_depth_minus_one),
                   enumerator<ClipY>(viewport->clip_y_down)};
  const std::span to(reinterpret_cast<Vertex*>(out), count);
  // The engine sees the copy. Without a place to write to it says what it says of an overlap.
  const bool apart = !Bytes(to).overlaps(Bytes::of(viewport));
  return to_c(
      to_pixel(v, std::span(reinterpret_cast<const ClipVertex*>(vertices), count), apart ? to : std::span<Vertex>()));
}

size_t surefill_sample_total(const surefill_target* target) {
  if (target == nullptr) return 0;
  Target sizes;
  sizes.width = target->width, sizes.height = target->height, sizes.samples = target->samples;
  return sample_total(sizes);
}

void surefill_sample_location(int32_t samples, int32_t n, int32_t* x, int32_t* y) {
  const SampleLocation location = sample_location(samples, n);
  if (x != nullptr) *x = location.x;
  if (y != nullptr) *y = location.y;
}

surefill_status surefill_validate(const surefill_target* target, const surefill_draw* draws, size_t draw_count) {
  Arguments arguments(nullptr);
  const surefill_status status = arguments.read_frame(target, draws, draw_count);
  return status != SUREFILL_OK ? status : to_c(arguments.check());
}

surefill_status surefill_render(const surefill_target* target, const surefill_draw* draws, size_t draw_count,
                                const surefill_options* options, surefill_statistics* statistics) {
  Arguments arguments(statistics);
  surefill_status status = arguments.read_frame(target, draws, draw_count);
  if (status == SUREFILL_OK) status = arguments.read_options(options, statistics);
  if (status != SUREFILL_OK) return status;
  return arguments.run(
      statistics, [&](Statistics* s, const Options& o) { return render(arguments.target, arguments.draws, s, o); });
}

surefill_status surefill_visit_coverage(const surefill_target* target, const surefill_draw* draws, size_t draw_count,
                                        surefill_visitor visitor, void* context, const surefill_options* options,
                                        surefill_statistics* statistics) {
  Arguments arguments(statistics);
  surefill_status status = arguments.read_frame(target, draws, draw_count);
  if (status == SUREFILL_OK) status = arguments.read_options(options, statistics);
  if (status != SUREFILL_OK) return status;
  struct Callback {
    surefill_visitor visitor;
    void* context;
  } callback{visitor, context};
  CoverageVisitor blocks;
  blocks.context = &callback;
  if (visitor != nullptr) {
    blocks.visit = [](void* to, std::span<const CoverageBlock> list) {
      const auto& own = *static_cast<const Callback*>(to);
      own.visitor(own.context, reinterpret_cast<const surefill_block*>(list.data()), list.size());
    };
  }
  return arguments.run(statistics, [&](Statistics* s, const Options& o) {
    return visit_coverage(arguments.target, arguments.draws, blocks, s, o);
  });
}

surefill_status surefill_occlusion_create(int32_t width, int32_t height, uint32_t depth_test,
                                          surefill_occlusion** occlusion) {
  return create_occlusion(width, height, depth_test, occlusion);
}

surefill_context* surefill_context_create(void) {
  return new (std::nothrow) surefill_context;
}

void surefill_context_destroy(surefill_context* context) {
  delete context;
}

void surefill_occlusion_destroy(surefill_occlusion* occlusion) {
  delete occlusion;
}

void surefill_occlusion_clear(surefill_occlusion* occlusion) {
  if (occlusion != nullptr) occlusion->buffer.clear();
}

surefill_status surefill_occlusion_draw(surefill_occlusion* occlusion, const surefill_draw* draws, size_t draw_count,
                                        const surefill_options* options, surefill_statistics* statistics) {
  if (occlusion == nullptr) return SUREFILL_NULL_OCCLUSION;
  Arguments arguments(statistics);
  arguments.read_occlusion(occlusion->buffer);
  surefill_status status = arguments.read_draws(draws, draw_count);
  if (status == SUREFILL_OUT_OF_MEMORY) occlusion->buffer.clear();
  if (status == SUREFILL_OK) status = arguments.read_options(options, statistics);
  if (status != SUREFILL_OK) return status;
  return arguments.run(statistics,
                       [&](Statistics* s, const Options& o) { return occlusion->buffer.draw(arguments.draws, s, o); });
}

surefill_status surefill_occlusion_query_boxes(const surefill_occlusion* occlusion, const surefill_box* boxes,
                                               size_t count, uint8_t* answers) {
  return query<OcclusionBox>(occlusion, boxes, count, answers);
}

surefill_status surefill_occlusion_query_rectangles(const surefill_occlusion* occlusion,
                                                    const surefill_rectangle* rectangles, size_t count,
                                                    uint8_t* answers) {
  return query<OcclusionRectangle>(occlusion, rectangles, count, answers);
}

const float* surefill_occlusion_depth(const surefill_occlusion* occlusion) {
  return occlusion == nullptr ? nullptr : occlusion->buffer.depth().data();
}

void surefill_occlusion_set_equal_is_visible(surefill_occlusion* occlusion, int32_t value) {
  if (occlusion != nullptr) occlusion->buffer.equal_is_visible(value != 0);
}

surefill_status surefill_occluder_mesh_create(const float* positions, size_t vertex_count, size_t position_stride,
                                              const uint32_t* indices, size_t index_count,
                                              surefill_occluder_mesh** mesh) {
  if (mesh == nullptr) return SUREFILL_OCCLUDER_MESH;
  const std::size_t stride = position_stride == 0 ? 3 * sizeof(float) : position_stride;
  if (stride < 3 * sizeof(float) || stride % sizeof(float) != 0 || stride / sizeof(float) > UINT32_MAX ||
      vertex_count > static_cast<std::size_t>(PTRDIFF_MAX) / stride) {
    return SUREFILL_OCCLUDER_POSITIONS;
  }
  const std::size_t floats = vertex_count == 0 ? 0 : (vertex_count - 1) * (stride / sizeof(float)) + 3;
  std::unique_ptr<surefill_occluder_mesh> made(new (std::nothrow) surefill_occluder_mesh);
  if (made == nullptr) return SUREFILL_OUT_OF_MEMORY;
  const Status status = made->mesh.prepare({positions, floats}, {indices, index_count},
                                           static_cast<std::uint32_t>(stride / sizeof(float)));
  if (status == Status::ok) *mesh = made.release();
  return to_c(status);
}

void surefill_occluder_mesh_destroy(surefill_occluder_mesh* mesh) {
  delete mesh;
}

surefill_status surefill_safe_occlusion_create(int32_t width, int32_t height, uint32_t depth_test,
                                               surefill_safe_occlusion** occlusion) {
  return create_occlusion(width, height, depth_test, occlusion);
}

void surefill_safe_occlusion_destroy(surefill_safe_occlusion* occlusion) {
  delete occlusion;
}

void surefill_safe_occlusion_clear(surefill_safe_occlusion* occlusion) {
  if (occlusion != nullptr) occlusion->buffer.clear();
}

surefill_status surefill_safe_occlusion_draw(surefill_safe_occlusion* occlusion,
                                             const surefill_occluder_mesh* const* meshes, const surefill_draw* draws,
                                             size_t draw_count, const surefill_options* options) {
  if (occlusion == nullptr) return SUREFILL_NULL_OCCLUSION;
  Arguments arguments(nullptr);
  arguments.read_occlusion(occlusion->buffer);
  std::unique_ptr<Occluder[]> list;
  std::span<const Occluder> occluders;
  surefill_status status = arguments.read_draws(draws, draw_count);
  if (status == SUREFILL_OK) status = occluders_of(arguments.draws, meshes, list, occluders);
  if (status == SUREFILL_OUT_OF_MEMORY) occlusion->buffer.clear();
  if (status == SUREFILL_OK) status = arguments.read_options(options, nullptr);
  if (status != SUREFILL_OK) return status;
  return arguments.run(nullptr, [&](Statistics*, const Options& o) { return occlusion->buffer.draw(occluders, o); });
}

surefill_status surefill_safe_occlusion_query_boxes(const surefill_safe_occlusion* occlusion, const surefill_box* boxes,
                                                    size_t count, uint8_t* answers) {
  return query<OcclusionBox>(occlusion, boxes, count, answers);
}

surefill_status surefill_safe_occlusion_query_rectangles(const surefill_safe_occlusion* occlusion,
                                                         const surefill_rectangle* rectangles, size_t count,
                                                         uint8_t* answers) {
  return query<OcclusionRectangle>(occlusion, rectangles, count, answers);
}

const float* surefill_safe_occlusion_depth(const surefill_safe_occlusion* occlusion) {
  return occlusion == nullptr ? nullptr : occlusion->buffer.depth().data();
}

void surefill_safe_occlusion_set_equal_is_visible(surefill_safe_occlusion* occlusion, int32_t value) {
  if (occlusion != nullptr) occlusion->buffer.equal_is_visible(value != 0);
}
