// SPDX-License-Identifier: Apache-2.0
//
// B2: a call that breaks one promise of the header returns the status that names the argument, and writes nothing.
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "certify/checks.hpp"

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

  // All bytes that a call could write to.
  std::string bytes() const {
    std::string all;
    const auto add = [&all](const auto& values) {
      all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
    add(count), add(index), add(depth), add(barycentrics), add(colour), add(initial);
    add(vertices), add(indices), add(identifiers), add(colours);
    return all;
  }
};

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

constexpr Fault kFaults[] = {
    {"width 0", Status::target_size, [](Call& c) { c.target.width = 0; }},
    {"width -1", Status::target_size, [](Call& c) { c.target.width = -1; }},
    {"width 16385", Status::target_size, [](Call& c) { c.target.width = kMaxTargetSize + 1; }},
    {"height 0", Status::target_size, [](Call& c) { c.target.height = 0; }},
    {"smallest height", Status::target_size, [](Call& c) { c.target.height = std::numeric_limits<int>::min(); }},
    {"largest height", Status::target_size, [](Call& c) { c.target.height = std::numeric_limits<int>::max(); }},
    {"0 samples", Status::target_samples, [](Call& c) { c.target.samples = 0; }},
    {"3 samples", Status::target_samples, [](Call& c) { c.target.samples = 3; }},
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
    {"depth overlaps initial depth", Status::target_overlap,
     [](Call& c) { c.target.initial_depth = std::span(c.depth).subspan(1, kPixels); }},
    {"count over the indices", Status::target_overlap, [](Call& c) { c.draw().indices = std::span(c.count).first(3); }},
    {"unknown depth test", Status::target_depth_test,
     [](Call& c) { c.target.depth_test = beyond(DepthTest::greater); }},
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
    {"unknown fill rule", Status::draw_fill_rule,
     [](Call& c) { c.draw().fill_rule = beyond(FillRule::northwards_west); }},
    {"unknown front face", Status::draw_front_face,
     [](Call& c) { c.draw().front_face = beyond(FrontFace::counter_clockwise); }},
    {"unknown culling", Status::draw_cull, [](Call& c) { c.draw().cull = beyond(Cull::back); }},
    {"unknown depth mode", Status::draw_depth_mode, [](Call& c) { c.draw().depth_mode = beyond(DepthMode::clamp); }},
    {"unknown conservative mode", Status::draw_conservative,
     [](Call& c) { c.draw().conservative = beyond(Conservative::inner); }},
    {"conservative with more than count", Status::draw_conservative,
     [](Call& c) { c.draw().conservative = Conservative::over; }},
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
  return result;
}

// The same for to_pixel: sizes that disagree, a null buffer, numbers that are not finite.
CaseResult viewport_argument_case(std::uint64_t number) {
  const ClipVertex clip[2] = {{0, 0, 0, 1}, {1, 1, 1, 1}};
  Vertex out[2] = {{9, 9, 9, 9}, {9, 9, 9, 9}};
  Viewport viewport;
  float* const numbers[] = {&viewport.x,      &viewport.y,          &viewport.width,
                            &viewport.height, &viewport.near_depth, &viewport.far_depth};
  std::span<const ClipVertex> in = clip;
  std::span<Vertex> to = out;
  if (number < 6) {
    *numbers[number] = std::numeric_limits<float>::infinity();
  } else if (number < 12) {
    *numbers[number - 6] = std::numeric_limits<float>::quiet_NaN();
  } else {
    to = to.first(1);
  }
  CaseResult result;
  result.samples = 1;
  const Status status = to_pixel(viewport, in, to);
  if (status == Status::ok || (number < 12 && status != Status::viewport)) {
    result.differences = 1;
    result.finding = fmt::format("to_pixel with a bad argument returned \"{}\"", status_text(status));
  }
  for (const Vertex& vertex : out) {
    if (vertex.x == 9 && vertex.y == 9 && vertex.z == 9 && vertex.w == 9) continue;
    ++result.differences;
    result.finding = "to_pixel with a bad argument wrote to a vertex";
  }
  return result;
}

constexpr std::uint64_t kViewportFaults = 13;

}  // namespace

void add_argument_check(const Settings& settings, std::vector<Check>& checks) {
  Check check = make_check("bad-arguments", "B2",
                           "each kind of bad argument gives the status that names it, and nothing is written");
  check.unit = "faults";
  check.exhaustive = true;
  check.prepare = [] { return std::size(kFaults) + kViewportFaults; };
  check.cost = 1e-6;
  check.run = [&settings](std::uint64_t number) {
    if (number >= std::size(kFaults)) return viewport_argument_case(number - std::size(kFaults));
    return argument_case(kFaults[number], settings.engine);
  };
  checks.push_back(std::move(check));
}

}  // namespace surefill::certify
