// SPDX-License-Identifier: Apache-2.0
//
// B2: a call that breaks one promise of the header returns the status that names the argument, and writes nothing; a
// call that just keeps them all is accepted.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "certify/run/checks.hpp"

namespace surefill::certify {

namespace {

constexpr std::size_t kPixels = 6;  // the target is 3 x 2

// A correct call with every buffer there is; a case spoils one thing of it.
struct Call {
  std::vector<std::uint32_t> count = std::vector<std::uint32_t>(4 * kPixels, 0xA5A5A5A5u);
  std::vector<std::uint32_t> index = count;
  std::vector<float> depth = std::vector<float>(4 * kPixels, 0.25f);
  std::vector<float> barycentrics = std::vector<float>(3 * kPixels, 0.25f);
  std::vector<float> colour = std::vector<float>(2 * kPixels, 0.25f);
  std::vector<float> initial = std::vector<float>(kPixels, 1.0f);
  std::vector<std::int32_t> winding = std::vector<std::int32_t>(kPixels, 5);
  std::vector<std::uint64_t> numbers = std::vector<std::uint64_t>(4, 5);
  std::vector<SampleLocation> places{{3, 4}, {5, 6}};
  std::vector<Vertex> vertices{{0, 0, 0.5f, 1}, {4, 0, 0.5f, 1}, {0, 4, 0.5f, 1}};
  std::vector<std::uint32_t> indices{0, 1, 2};
  std::vector<std::uint32_t> identifiers{7};
  std::vector<float> colours{0, 1, 2, 3, 4, 5};
  std::vector<AttributeTarget> attribute_targets;
  std::vector<AttributeArray> attribute_arrays;
  Target target;
  std::vector<Draw> draws = std::vector<Draw>(1);

  Call() {
    attribute_targets.push_back({colour, 2});
    attribute_arrays.push_back({colours, 2, 0, Interpolation::perspective});
    target.width = 3;
    target.height = 2;
    target.count = std::span(count).first(kPixels);
    target.index = std::span(index).first(kPixels);
    target.depth = std::span(depth).first(kPixels);
    target.barycentrics = barycentrics;
    target.attributes = attribute_targets;
    target.initial_depth = initial;
    Draw& draw = draws[0];
    draw.vertices = vertices;
    draw.indices = indices;
    draw.identifiers = identifiers;
    draw.attributes = attribute_arrays;
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  Draw& draw() { return draws[0]; }

  // Without the outputs that a frame with a conservative draw may not have.
  void only_counts(Conservative mode) {
    target.index = {}, target.depth = {}, target.barycentrics = {}, target.attributes = {};
    draw().conservative = mode;
  }

  // All bytes that a call could write to.
  std::string bytes() const {
    std::string all;
    const auto add = [&all](const auto& values) {
      all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
    add(count), add(index), add(depth), add(barycentrics), add(colour), add(initial), add(winding), add(numbers);
    add(vertices), add(indices), add(identifiers), add(colours);
    return all;
  }
};

// An output where a list begins.
template <typename T, typename List>
std::span<T> over(List&& list, std::size_t size) {
  return {reinterpret_cast<T*>(list.data()), size};
}

struct Fault {
  const char* name;
  Status status;
  void (*spoil)(Call& call);
};

template <typename Enum>
Enum beyond(Enum last) {
  return static_cast<Enum>(static_cast<int>(last) + 1);
}

template <typename T>
std::span<T> null_span(std::size_t size) {
  return {static_cast<T*>(nullptr), size};
}

// A buffer that there is not, low in the address space, where it overlaps none.
template <typename T>
std::span<T> nowhere(std::size_t size) {
  return {reinterpret_cast<T*>(alignof(T)), size};
}

constexpr Fault kFaults[] = {
    {"width 0", Status::target_size, [](Call& c) { c.target.width = 0; }},
    {"width -1", Status::target_size, [](Call& c) { c.target.width = -1; }},
    {"width 16385", Status::target_size, [](Call& c) { c.target.width = kMaxTargetSize + 1; }},
    {"height 0", Status::target_size, [](Call& c) { c.target.height = 0; }},
    {"smallest height", Status::target_size, [](Call& c) { c.target.height = std::numeric_limits<int>::min(); }},
    {"largest height", Status::target_size, [](Call& c) { c.target.height = std::numeric_limits<int>::max(); }},
    {"0 samples", Status::target_samples, [](Call& c) { c.target.samples = 0; }},
    {"3 samples", Status::target_samples, [](Call& c) { c.target.samples = 3; }},
    {"17 samples", Status::target_samples, [](Call& c) { c.target.samples = 17; }},
    {"32 samples", Status::target_samples, [](Call& c) { c.target.samples = 32; }},
    {"-1 samples", Status::target_samples, [](Call& c) { c.target.samples = -1; }},
    {"count too short", Status::target_count, [](Call& c) { c.target.count = std::span(c.count).first(kPixels - 1); }},
    {"count too long", Status::target_count, [](Call& c) { c.target.count = std::span(c.count).first(kPixels + 1); }},
    {"count null", Status::target_count, [](Call& c) { c.target.count = null_span<std::uint32_t>(kPixels); }},
    {"index too short", Status::target_index, [](Call& c) { c.target.index = std::span(c.index).first(1); }},
    {"index null", Status::target_index, [](Call& c) { c.target.index = null_span<std::uint32_t>(kPixels); }},
    {"depth too long", Status::target_depth, [](Call& c) { c.target.depth = std::span(c.depth).first(kPixels + 1); }},
    {"depth null", Status::target_depth, [](Call& c) { c.target.depth = null_span<float>(kPixels); }},
    {"barycentrics of one float a sample", Status::target_barycentrics,
     [](Call& c) { c.target.barycentrics = std::span(c.barycentrics).first(kPixels); }},
    {"barycentrics null", Status::target_barycentrics,
     [](Call& c) { c.target.barycentrics = null_span<float>(3 * kPixels); }},
    {"attribute target of 0 components", Status::target_attributes,
     [](Call& c) { c.attribute_targets[0].components = 0; }},
    {"attribute target of 5 components", Status::target_attributes,
     [](Call& c) { c.attribute_targets[0].components = kMaxComponents + 1; }},
    {"attribute target too short", Status::target_attributes,
     [](Call& c) { c.attribute_targets[0].values = std::span(c.colour).first(kPixels); }},
    {"attribute target null", Status::target_attributes,
     [](Call& c) { c.attribute_targets[0].values = null_span<float>(2 * kPixels); }},
    {"17 attribute targets", Status::target_attributes,
     [](Call& c) {
       c.attribute_targets.assign(kMaxAttributes + 1, AttributeTarget{});
       c.target.attributes = c.attribute_targets;
     }},
    {"attribute targets null", Status::target_attributes,
     [](Call& c) { c.target.attributes = null_span<const AttributeTarget>(1); }},
    {"initial depth too short", Status::target_initial_depth,
     [](Call& c) { c.target.initial_depth = std::span(c.initial).first(kPixels - 1); }},
    {"initial depth null", Status::target_initial_depth,
     [](Call& c) { c.target.initial_depth = null_span<const float>(kPixels); }},
    {"count is index", Status::target_overlap, [](Call& c) { c.target.index = c.target.count; }},
    {"index overlaps count at its end", Status::target_overlap,
     [](Call& c) { c.target.index = std::span(c.count).subspan(kPixels - 1, kPixels); }},
    {"count overlaps index at its end", Status::target_overlap,
     [](Call& c) {
       c.target.index = std::span(c.count).first(kPixels);
       c.target.count = std::span(c.count).subspan(kPixels - 1, kPixels);
     }},
    {"an attribute target over the barycentrics", Status::target_overlap,
     [](Call& c) { c.attribute_targets[0].values = std::span(c.barycentrics).first(2 * kPixels); }},
    {"count over the identifiers", Status::target_overlap,
     [](Call& c) { c.draw().identifiers = std::span(c.count).first(1); }},
    {"depth over the attribute values", Status::target_overlap,
     [](Call& c) { c.attribute_arrays[0].values = std::span<const float>(c.depth).first(6); }},
    {"barycentrics over the initial depth", Status::target_overlap,
     [](Call& c) { c.target.initial_depth = std::span<const float>(c.barycentrics).first(kPixels); }},
    {"depth overlaps initial depth", Status::target_overlap,
     [](Call& c) { c.target.initial_depth = std::span(c.depth).subspan(1, kPixels); }},
    {"count over the indices", Status::target_overlap, [](Call& c) { c.draw().indices = std::span(c.count).first(3); }},
    {"count over the draws", Status::target_overlap,
     [](Call& c) { c.target.count = over<std::uint32_t>(c.draws, kPixels); }},
    {"depth over the attribute arrays", Status::target_overlap,
     [](Call& c) { c.target.depth = over<float>(c.attribute_arrays, kPixels); }},
    {"index over the attribute targets", Status::target_overlap,
     [](Call& c) { c.target.index = over<std::uint32_t>(c.attribute_targets, kPixels); }},
    {"count over the target", Status::target_overlap,
     [](Call& c) { c.target.count = over<std::uint32_t>(std::span(&c.target, 1), kPixels); }},
    {"unknown depth test", Status::target_depth_test,
     [](Call& c) { c.target.depth_test = beyond(DepthTest::greater_equal); }},
    {"an origin too far to the right", Status::target_origin, [](Call& c) { c.target.origin.x = kMaxOrigin + 1; }},
    {"an origin too far up", Status::target_origin, [](Call& c) { c.target.origin.y = -kMaxOrigin - 1; }},
    {"two sample locations for one sample", Status::target_sample_locations,
     [](Call& c) { c.target.sample_locations = c.places; }},
    {"sample locations null", Status::target_sample_locations,
     [](Call& c) { c.target.sample_locations = null_span<const SampleLocation>(1); }},
    {"a sample location of 16", Status::target_sample_locations,
     [](Call& c) {
       c.places[0].y = 16;
       c.target.sample_locations = std::span(c.places).first(1);
     }},
    {"sample locations of a conservative draw", Status::target_sample_locations,
     [](Call& c) {
       c.only_counts(Conservative::over);
       c.target.sample_locations = std::span(c.places).first(1);
     }},
    {"no layers", Status::target_layers, [](Call& c) { c.target.layers = 0; }},
    {"17 layers", Status::target_layers, [](Call& c) { c.target.layers = kMaxLayers + 1; }},
    {"two layers in buffers of one", Status::target_index, [](Call& c) { c.target.layers = 2; }},
    {"two layers without depth write", Status::target_layers,
     [](Call& c) {
       c.only_counts(Conservative::none);
       c.target.layers = 2;
       c.draw().depth_write = false;
     }},
    {"two layers of a conservative draw", Status::target_layers,
     [](Call& c) {
       c.only_counts(Conservative::touched);
       c.target.layers = 2;
     }},
    {"depth of two layers is initial depth", Status::target_overlap,
     [](Call& c) {
       c.only_counts(Conservative::none);
       c.target.layers = 2;
       c.target.depth = std::span(c.depth).first(2 * kPixels);
       c.target.initial_depth = std::span(c.depth).first(kPixels);
     }},
    {"winding too short", Status::target_winding,
     [](Call& c) { c.target.winding = std::span(c.winding).first(kPixels - 1); }},
    {"winding null", Status::target_winding, [](Call& c) { c.target.winding = null_span<std::int32_t>(kPixels); }},
    {"winding over the count", Status::target_overlap,
     [](Call& c) { c.target.winding = over<std::int32_t>(c.count, kPixels); }},
    {"winding of a conservative draw", Status::draw_conservative,
     [](Call& c) {
       c.only_counts(Conservative::overlap);
       c.target.winding = c.winding;
     }},
    {"index over the sample locations", Status::target_overlap,
     [](Call& c) {
       c.places.resize(kPixels);
       c.target.sample_locations = std::span(c.places).first(1);
       c.target.index = over<std::uint32_t>(c.places, kPixels);
     }},
    {"unknown attribute location", Status::target_attribute_location,
     [](Call& c) { c.target.attribute_location = beyond(AttributeLocation::centroid); }},
    {"vertices null", Status::draw_vertices, [](Call& c) { c.draw().vertices = null_span<const Vertex>(3); }},
    {"indices null", Status::draw_indices, [](Call& c) { c.draw().indices = null_span<const std::uint32_t>(3); }},
    {"two indices", Status::draw_indices, [](Call& c) { c.draw().indices = std::span(c.indices).first(2); }},
    {"an index out of range", Status::draw_index_out_of_range, [](Call& c) { c.indices[2] = 3; }},
    {"the largest index", Status::draw_index_out_of_range, [](Call& c) { c.indices[0] = 0xFFFFFFFFu; }},
    {"indices without vertices", Status::draw_index_out_of_range, [](Call& c) { c.draw().vertices = {}; }},
    {"an index out of range in the second draw", Status::draw_index_out_of_range,
     [](Call& c) {
       c.draws.push_back(c.draws[0]);
       c.draws[1].vertices = std::span(c.vertices).first(2);
     }},
    {"too many identifiers", Status::draw_identifiers,
     [](Call& c) { c.draw().identifiers = std::span<const std::uint32_t>(c.indices).first(2); }},
    {"identifiers null", Status::draw_identifiers,
     [](Call& c) { c.draw().identifiers = null_span<const std::uint32_t>(1); }},
    {"an identifier that an empty sample holds", Status::draw_identifiers,
     [](Call& c) { c.identifiers[0] = kNoTriangle; }},
    {"first index too large", Status::draw_first_index,
     [](Call& c) {
       c.draw().identifiers = {};
       c.draw().first_index = 0xFFFFFFFFu;
     }},
    {"no attribute arrays", Status::draw_attributes, [](Call& c) { c.draw().attributes = {}; }},
    {"attribute arrays null", Status::draw_attributes,
     [](Call& c) { c.draw().attributes = null_span<const AttributeArray>(1); }},
    {"attribute values null", Status::draw_attributes,
     [](Call& c) { c.attribute_arrays[0].values = null_span<const float>(6); }},
    {"attribute values too short", Status::draw_attributes,
     [](Call& c) { c.attribute_arrays[0].values = std::span<const float>(c.colours).first(5); }},
    {"attribute of other components", Status::draw_attributes, [](Call& c) { c.attribute_arrays[0].components = 1; }},
    {"attribute of 5 components", Status::draw_attributes, [](Call& c) { c.attribute_arrays[0].components = 5; }},
    {"attribute of the largest stride", Status::draw_attributes,
     [](Call& c) { c.attribute_arrays[0].stride = 0xFFFFFFFFu; }},
    {"unknown interpolation", Status::draw_attribute_interpolation,
     [](Call& c) { c.attribute_arrays[0].interpolation = beyond(Interpolation::flat); }},
    {"unknown fill rule", Status::draw_fill_rule, [](Call& c) { c.draw().fill_rule = beyond(FillRule::open); }},
    {"closed fill rule with a grid", Status::draw_fill_rule,
     [](Call& c) {
       c.draw().fill_rule = FillRule::closed;
       c.draw().grid = Grid{};
     }},
    {"unknown front face", Status::draw_front_face,
     [](Call& c) { c.draw().front_face = beyond(FrontFace::counter_clockwise); }},
    {"unknown culling", Status::draw_cull, [](Call& c) { c.draw().cull = beyond(Cull::back); }},
    {"unknown depth mode", Status::draw_depth_mode, [](Call& c) { c.draw().depth_mode = beyond(DepthMode::clamp); }},
    {"unknown conservative mode", Status::draw_conservative,
     [](Call& c) { c.draw().conservative = beyond(Conservative::touched); }},
    {"conservative with more than count", Status::draw_conservative,
     [](Call& c) { c.draw().conservative = Conservative::over; }},
    {"a bias that is not a number", Status::draw_depth_bias,
     [](Call& c) {
       c.draw().depth_bias = DepthBias{std::numeric_limits<float>::quiet_NaN(), 0};
     }},
    {"an infinite slope of the bias", Status::draw_depth_bias,
     [](Call& c) {
       c.draw().depth_bias = DepthBias{0, std::numeric_limits<float>::infinity()};
     }},
    {"covered of two triangles", Status::draw_covered,
     [](Call& c) { c.draw().covered = std::span(c.numbers).first(2); }},
    {"covered null", Status::draw_covered, [](Call& c) { c.draw().covered = null_span<std::uint64_t>(1); }},
    {"visible of two triangles", Status::draw_visible,
     [](Call& c) { c.draw().visible = std::span(c.numbers).first(2); }},
    {"visible of a conservative draw", Status::draw_visible,
     [](Call& c) {
       c.only_counts(Conservative::over);
       c.draw().visible = std::span(c.numbers).first(1);
     }},
    {"covered is visible", Status::target_overlap,
     [](Call& c) { c.draw().covered = c.draw().visible = std::span(c.numbers).first(1); }},
    {"covered of one draw is visible of another", Status::target_overlap,
     [](Call& c) {
       c.draws.push_back(c.draws[0]);
       c.draws[0].covered = c.draws[1].visible = std::span(c.numbers).first(1);
     }},
    {"covered over the count", Status::target_overlap,
     [](Call& c) { c.draw().covered = over<std::uint64_t>(c.count, 1); }},
    {"visible over the vertices of another draw", Status::target_overlap,
     [](Call& c) {
       c.draws.push_back(c.draws[0]);
       c.draws[1].visible = over<std::uint64_t>(c.vertices, 1);
     }},
    {"grid of -1 bits", Status::draw_grid,
     [](Call& c) {
       c.draw().grid = Grid{-1, 0, 0, {}};
     }},
    {"grid of 13 bits", Status::draw_grid,
     [](Call& c) {
       c.draw().grid = Grid{13, 0, 0, {}};
     }},
    {"grid offset of 16", Status::draw_grid,
     [](Call& c) {
       c.draw().grid = Grid{8, 0, 16, {}};
     }},
    {"grid offset of -1", Status::draw_grid,
     [](Call& c) {
       c.draw().grid = Grid{8, -1, 0, {}};
     }},
    {"unknown grid rounding", Status::draw_grid,
     [](Call& c) {
       c.draw().grid = Grid{8, 0, 0, beyond(GridRounding::truncate)};
     }},
};

// Calls that are right, if only just: sizes at their limits, buffers that touch. `validate` alone is asked, so that a
// buffer may be one that there is not.
constexpr Fault kAccepted[] = {
    {"nothing spoiled", Status::ok, [](Call&) {}},
    {"one output of the largest width", Status::ok,
     [](Call& c) {
       c.target = {};
       c.target.width = kMaxTargetSize;
       c.target.height = 1;
       c.count.resize(static_cast<std::size_t>(kMaxTargetSize));
       c.target.count = c.count;
     }},
    {"one output of the largest height and samples", Status::ok,
     [](Call& c) {
       c.target = {};
       c.target.width = 1;
       c.target.height = kMaxTargetSize;
       c.target.samples = 16;
       c.count.resize(16 * static_cast<std::size_t>(kMaxTargetSize));
       c.target.count = c.count;
     }},
    {"index right after count", Status::ok,
     [](Call& c) { c.target.index = std::span(c.count).subspan(kPixels, kPixels); }},
    {"index right before count", Status::ok,
     [](Call& c) {
       c.target.index = std::span(c.count).first(kPixels);
       c.target.count = std::span(c.count).subspan(kPixels, kPixels);
     }},
    {"an empty count within the index", Status::ok,
     [](Call& c) { c.target.count = std::span(c.index).subspan(kPixels / 2, 0); }},
    {"an empty index within the count", Status::ok,
     [](Call& c) { c.target.index = std::span(c.count).subspan(kPixels / 2, 0); }},
    {"depth is initial depth", Status::ok, [](Call& c) { c.target.initial_depth = c.target.depth; }},
    {"indices right after count", Status::ok,
     [](Call& c) {
       std::fill(c.count.begin(), c.count.end(), 0u);
       c.draw().indices = std::span(c.count).subspan(kPixels, 3);
     }},
    {"no draws", Status::ok, [](Call& c) { c.draws.clear(); }},
    {"a draw of nothing", Status::ok,
     [](Call& c) {
       c.draw().vertices = {};
       c.draw().indices = {};
       c.draw().identifiers = {};
       c.attribute_arrays[0].values = {};
     }},
    {"one vertex for all three corners", Status::ok,
     [](Call& c) {
       c.draw().vertices = std::span(c.vertices).first(1);
       std::fill(c.indices.begin(), c.indices.end(), 0u);
     }},
    {"no identifiers, the largest first index", Status::ok,
     [](Call& c) {
       c.draw().identifiers = {};
       c.draw().first_index = 0xFFFFFFFEu;
     }},
    {"attribute values that end with the last vertex", Status::ok,
     [](Call& c) {
       c.colours.resize(10);
       c.attribute_arrays[0].values = c.colours;
       c.attribute_arrays[0].stride = 4;
     }},
    {"the most vertices", Status::ok,
     [](Call& c) {
       c.draw().vertices = nowhere<const Vertex>(0xFFFFFFFFu);
       c.target.attributes = {};
       c.draw().attributes = {};
     }},
    {"one vertex more", Status::draw_vertices,
     [](Call& c) {
       c.draw().vertices = nowhere<const Vertex>(std::size_t{1} << 32);
       c.target.attributes = {};
       c.draw().attributes = {};
     }},
    {"the most triangles and one more", Status::draw_indices,
     [](Call& c) { c.draw().indices = nowhere<const std::uint32_t>(3 * std::size_t{0xFFFFFFFFu}); }},
    {"a grid of 0 bits at the largest offset", Status::ok,
     [](Call& c) {
       c.draw().grid = Grid{0, 15, 15, GridRounding::truncate};
     }},
    {"a grid of 12 bits", Status::ok,
     [](Call& c) {
       c.draw().grid = Grid{12, 0, 0, GridRounding::nearest_up};
     }},
    {"conservative with count alone", Status::ok, [](Call& c) { c.only_counts(Conservative::inner); }},
    {"conservative with count and index", Status::ok,
     [](Call& c) {
       c.only_counts(Conservative::touched);
       c.target.index = std::span(c.index).first(kPixels);
     }},
    {"the farthest origin, all layers, numbers of triangles and a bias", Status::ok,
     [](Call& c) {
       c.only_counts(Conservative::none);
       c.target.origin = {kMaxOrigin, -kMaxOrigin};
       c.target.layers = kMaxLayers;
       c.target.winding = c.winding;
       c.target.sample_locations = std::span(c.places).first(1);
       c.draw().covered = std::span(c.numbers).first(1);
       c.draw().visible = std::span(c.numbers).subspan(1, 1);
       c.draw().depth_bias = DepthBias{-1, 2};
     }},
};

CaseResult accepted_case(const Fault& call_and_status) {
  Call call;
  call_and_status.spoil(call);
  CaseResult result;
  result.samples = kPixels;
  if (const Status status = validate(call.target, call.draws); status != call_and_status.status) {
    result.differences = 1;
    result.finding = fmt::format("{}: validate returned \"{}\"", call_and_status.name, status_text(status));
  }
  return result;
}

CaseResult argument_case(const Fault& fault, const properties::Renderer& engine) {
  Call call;
  fault.spoil(call);
  const std::string before = call.bytes();
  CaseResult result;
  result.samples = kPixels;
  const auto expect = [&](bool holds, const std::string& finding) {
    if (holds) return;
    ++result.differences;
    result.finding = fmt::format("{}: {}", fault.name, finding);
  };
  const Status drawn = engine(call.target, call.draws);
  expect(drawn == fault.status, fmt::format("render returned \"{}\"", status_text(drawn)));
  const Status checked = validate(call.target, call.draws);
  expect(checked == fault.status, fmt::format("validate returned \"{}\"", status_text(checked)));
  expect(call.bytes() == before, "a buffer was written to");
  const bool refused = fault.status == Status::target_size || fault.status == Status::target_samples;
  expect((sample_total(call.target) == 0) == refused,
         "sample_total is not 0 exactly where size or samples are refused");
  return result;
}

// The same for to_pixel: numbers that are not finite, enumerators that there are not, sizes that disagree, null
// buffers, buffers that overlap, and buffers that only touch.
CaseResult viewport_argument_case(std::uint64_t number) {
  // Room for the vertices and the results in one buffer: both are four floats.
  static_assert(sizeof(ClipVertex) == sizeof(Vertex));
  alignas(Vertex) std::byte bytes[4 * sizeof(Vertex)] = {};
  const auto in_at = [&bytes](std::size_t i) { return std::span(reinterpret_cast<const ClipVertex*>(bytes) + i, 2); };
  const auto out_at = [&bytes](std::size_t i) { return std::span(reinterpret_cast<Vertex*>(bytes) + i, 2); };
  Viewport viewport;
  float* const numbers[] = {&viewport.x,      &viewport.y,          &viewport.width,
                            &viewport.height, &viewport.near_depth, &viewport.far_depth};
  std::span<const ClipVertex> in = in_at(0);
  std::span<Vertex> out = out_at(2);
  Status expected = Status::to_pixel_vertices;
  if (number < 12) {
    using Limits = std::numeric_limits<float>;
    *numbers[number % 6] = number < 6 ? Limits::infinity() : Limits::quiet_NaN();
    expected = Status::viewport;
  }
  switch (number) {
    case 12:
      viewport.clip_depth = beyond(ClipDepth::minus_one_to_one), expected = Status::viewport;
      break;
    case 13:
      viewport.clip_y = beyond(ClipY::down), expected = Status::viewport;
      break;
    case 14:
      out = out.first(1);
      break;
    case 15:
      in = null_span<const ClipVertex>(2);
      break;
    case 16:
      out = null_span<Vertex>(2);
      break;
    case 17:
      out = out_at(1);
      break;
    case 18:
      in = in_at(1), out = out_at(0);
      break;
    case 19:
      out = out_at(0);
      break;
    case 20:
      in = in_at(2), out = out_at(0), expected = Status::ok;  // they touch
      break;
    case 21:
      expected = Status::ok;  // they touch, the other way round
      break;
    case 22:
      in = {}, out = {}, expected = Status::ok;
      break;
    default:
      break;
  }
  CaseResult result;
  result.samples = 1;
  const Status status = to_pixel(viewport, in, out);
  if (status != expected) {
    result.differences = 1;
    result.finding = fmt::format("to_pixel, case {}, returned \"{}\"", number, status_text(status));
  }
  const bool written = std::any_of(std::begin(bytes), std::end(bytes), [](std::byte b) { return b != std::byte{0}; });
  if (expected != Status::ok && written) {
    ++result.differences;
    result.finding = "to_pixel with a bad argument wrote to a vertex";
  }
  return result;
}

constexpr std::uint64_t kViewportCalls = 23;

}  // namespace

void add_argument_check(const Settings& settings, std::vector<Check>& checks) {
  Check check =
      make_check("bad-arguments", "B2",
                 "each kind of bad argument gives the status that names it, and nothing is written; arguments "
                 "at their limits are accepted");
  check.unit = "calls";
  check.exhaustive = true;
  check.prepare = [] { return std::size(kFaults) + std::size(kAccepted) + kViewportCalls; };
  check.cost = 1e-6;
  check.run = [&settings](std::uint64_t number) {
    if (number < std::size(kFaults)) return argument_case(kFaults[number], settings.engine);
    number -= std::size(kFaults);
    if (number < std::size(kAccepted)) return accepted_case(kAccepted[number]);
    return viewport_argument_case(number - std::size(kAccepted));
  };
  checks.push_back(std::move(check));
}

}  // namespace surefill::certify
