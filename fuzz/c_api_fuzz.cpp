// SPDX-License-Identifier: Apache-2.0
//
// The C interface with hostile arguments: struct sizes, null pointers, strides, wrong counts, wild numbers, overlapping
// buffers. Every buffer has a twin with the same bytes at another place, and the same call is made in C++ on the twins.
// If only what C++ knows is wrong, the status is the C++ call's; if something of C alone is wrong (a struct size, a
// stride, a null struct), the status names one of the arguments at fault. A refused call leaves every byte as it was;
// an accepted one leaves the inputs alone, and its outputs and statistics equal those of C++, byte for byte.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fuzz/c_api_memory.hpp"
#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"
#include "surefill/diagnostics.hpp"
#include "surefill/occlusion.hpp"
#include "surefill/surefill.h"
#include "surefill/surefill.hpp"
#include "surefill/version.hpp"

namespace surefill::fuzz {
namespace {

class Call : CallMemory {
 public:
  explicit Call(std::span<const std::uint8_t> bytes) : CallMemory(bytes) {
    build_target();
    build_draws();
    build_options();
    for (Memory& m : memory_) {
      m.before.assign(m.bytes.get(), m.bytes.get() + m.size);
      std::copy(m.before.begin(), m.before.end(), m.twin.get());
    }
    translate();
  }

  void check() {
    const surefill_status checked = surefill_validate(target_, draws_, draw_count_);
    if (!unchanged()) fail("surefill_validate wrote to a buffer");
    const Status expected_check = target_ == nullptr ? Status::ok : validate(cpp_target_, cpp_draws_);
    expect("surefill_validate", checked, expected_check, wrong_);

    const surefill_status drawn = surefill_render(target_, draws_, draw_count_, options_, statistics_);
    std::vector<surefill_status> wrong = wrong_;
    wrong.insert(wrong.end(), wrong_options_.begin(), wrong_options_.end());
    if (drawn != SUREFILL_OK && !unchanged()) fail("a refused call wrote; its status: " + text(drawn));
    Statistics expected_statistics;
    Diagnostics expected_diagnostics;
    cpp_options_.diagnostics = &expected_diagnostics;
    // On the twins; refused if the original was to be refused for what C++ cannot see.
    const Status expected = target_ == nullptr || !wrong.empty()
                                ? expected_check
                                : render(cpp_target_, cpp_draws_, &expected_statistics, cpp_options_);
    expect("surefill_render", drawn, expected, wrong);
    if (drawn == SUREFILL_OK) check_image(expected_statistics, expected_diagnostics.path);
  }

  // The same stream of coverage in C and in C++; mostly of a target that asks for no output.
  void check_stream() {
    surefill_target t = known_target_;
    Target cpp = cpp_target_;
    if (!one_in(8)) {
      t.count = t.index = nullptr, t.depth = t.barycentrics = nullptr, t.attributes = nullptr, t.winding = nullptr;
      t.count_count = t.index_count = t.depth_count = t.barycentrics_count = t.attribute_count = t.winding_count = 0;
      cpp.count = cpp.index = {}, cpp.depth = cpp.barycentrics = {}, cpp.attributes = {}, cpp.winding = {};
    }
    const bool no_visitor = one_in(32);
    std::vector<CoverageBlock> blocks, cpp_blocks;
    const surefill_visitor keep = [](void* context, const surefill_block* list, std::size_t count) {
      const auto* first = reinterpret_cast<const CoverageBlock*>(list);
      static_cast<std::vector<CoverageBlock>*>(context)->insert(
          static_cast<std::vector<CoverageBlock>*>(context)->end(), first, first + count);
    };
    CoverageVisitor visitor{[](void* context, std::span<const CoverageBlock> list) {
                              auto& to = *static_cast<std::vector<CoverageBlock>*>(context);
                              to.insert(to.end(), list.begin(), list.end());
                            },
                            &cpp_blocks};
    if (no_visitor) visitor.visit = nullptr;
    const surefill_status status = surefill_visit_coverage(target_ == nullptr ? nullptr : &t, draws_, draw_count_,
                                                           no_visitor ? nullptr : keep, &blocks, nullptr, nullptr);
    if (!wrong_.empty() || strided_overlap_) {
      if (status == SUREFILL_OK) fail("surefill_visit_coverage accepts wrong arguments");
      return;
    }
    const Status expected = visit_coverage(cpp, cpp_draws_, visitor);
    if (status != static_cast<surefill_status>(expected)) fail("surefill_visit_coverage says " + text(status));
    const auto same = [](const CoverageBlock& a, const CoverageBlock& b) {
      return a.draw == b.draw && a.triangle == b.triangle && a.x == b.x && a.y == b.y && a.sample == b.sample &&
             a.mask == b.mask;
    };
    if (!std::equal(blocks.begin(), blocks.end(), cpp_blocks.begin(), cpp_blocks.end(), same)) {
      fail("the streams of C and of C++ differ");
    }
  }

  // The same occluders in C and in C++, and a query.
  void check_occlusion() {
    const int width = size(), height = size();
    const std::uint32_t test = enumerator(2);
    surefill_occlusion* c = nullptr;
    OcclusionBuffer cpp;
    const surefill_status made = surefill_occlusion_create(width, height, test, one_in(32) ? nullptr : &c);
    const Status expected_made = cpp.resize(width, height, to_enum<DepthTest>(test));
    if (made != SUREFILL_NULL_OCCLUSION && made != static_cast<surefill_status>(expected_made)) {
      fail("surefill_occlusion_create says " + text(made));
    }
    if ((made == SUREFILL_OK) != (c != nullptr)) fail("surefill_occlusion_create and what it made disagree");

    const surefill_status drawn = surefill_occlusion_draw(c, draws_, draw_count_, options_, statistics_);
    std::vector<surefill_status> wrong = wrong_draws_;
    wrong.insert(wrong.end(), wrong_options_.begin(), wrong_options_.end());
    if (c == nullptr) wrong.push_back(SUREFILL_NULL_OCCLUSION);
    if (wrong.empty()) {
      const auto expected = static_cast<surefill_status>(cpp.draw(cpp_draws_, nullptr, cpp_options_));
      if (drawn != expected && !either_is_right(drawn, expected)) fail("surefill_occlusion_draw says " + text(drawn));
    } else if (drawn == SUREFILL_OK) {
      fail("surefill_occlusion_draw accepts wrong arguments");
    }
    const float* depth = surefill_occlusion_depth(c);
    if ((depth == nullptr) != (c == nullptr)) fail("surefill_occlusion_depth is null, or is not");
    if (c != nullptr && std::memcmp(depth, cpp.depth().data(), cpp.depth().size_bytes()) != 0) {
      fail("the depth of C and of C++ differ");
    }
    if (cpp.depth().size() != static_cast<std::size_t>(cpp.width()) * static_cast<std::size_t>(cpp.height()))
      fail("the depth is not of the buffer's size");
    check_query<OcclusionBox, surefill_box>(c, cpp, surefill_occlusion_query_boxes);
    OcclusionBuffer moved(std::move(cpp));
    check_query<OcclusionRectangle, surefill_rectangle>(c, moved, surefill_occlusion_query_rectangles);
    cpp = std::move(moved);
    if (moved.width() != 0 || !moved.depth().empty()) fail("a buffer that was moved from is not empty");
    surefill_occlusion_clear(c);
    cpp.clear();
    if (c != nullptr && std::memcmp(surefill_occlusion_depth(c), cpp.depth().data(), cpp.depth().size_bytes()) != 0)
      fail("clearing differs between C and C++");
    surefill_occlusion_destroy(c);
  }

  // Safe buffers: meshes of few places for the draws' vertices.
  void check_safe_occlusion() {
    const int width = size(), height = size();
    const std::uint32_t test = enumerator(2);
    surefill_safe_occlusion* c = nullptr;
    SafeOcclusionBuffer cpp;
    const surefill_status made = surefill_safe_occlusion_create(width, height, test, one_in(32) ? nullptr : &c);
    const Status expected_made = cpp.resize(width, height, to_enum<DepthTest>(test));
    if (made != SUREFILL_NULL_OCCLUSION && made != static_cast<surefill_status>(expected_made)) {
      fail("surefill_safe_occlusion_create says " + text(made));
    }
    const int equal = one_in(2) ? 1 : 0;
    surefill_safe_occlusion_set_equal_is_visible(c, equal), cpp.equal_is_visible(equal != 0);
    if (wrong_draws_.empty() && draws_ != nullptr) draw_safely(c, cpp);
    const float* depth = surefill_safe_occlusion_depth(c);
    if ((depth == nullptr) != (c == nullptr)) fail("surefill_safe_occlusion_depth is null, or is not");
    if (c != nullptr && std::memcmp(depth, cpp.depth().data(), cpp.depth().size_bytes()) != 0) {
      fail("the depth of C and of C++ differ");
    }
    check_query<OcclusionBox, surefill_box>(c, cpp, surefill_safe_occlusion_query_boxes);
    check_query<OcclusionRectangle, surefill_rectangle>(c, cpp, surefill_safe_occlusion_query_rectangles);
    surefill_safe_occlusion_clear(c);
    surefill_safe_occlusion_destroy(c);
  }

 private:
  void draw_safely(surefill_safe_occlusion* c, SafeOcclusionBuffer& cpp) {
    std::vector<surefill_draw> draws = known_draws_;
    std::vector<Occluder> occluders(draws.size());
    std::vector<OccluderMesh> meshes(draws.size());
    std::vector<surefill_occluder_mesh*> c_meshes(draws.size());
    bool unused = false;  // is something there that safe draws have no use for?
    for (std::size_t i = 0; i < draws.size(); ++i) {
      surefill_draw& draw = draws[i];
      draw.struct_size = sizeof draw, draw.covered_count = draw.visible_count = 0;
      if (!one_in(16)) draw.indices = nullptr, draw.index_count = 0;
      if (!one_in(16)) draw.identifier_count = 0;
      if (!one_in(16)) draw.attribute_count = 0;
      unused |= draw.indices != nullptr || draw.index_count + draw.identifier_count + draw.attribute_count != 0;
      const std::size_t count = one_in(16) ? in_.below(4) : std::min<std::size_t>(draw.vertex_count, 64);
      std::vector<float> positions(4 * count);
      for (float& place : positions) place = one_in(32) ? real() : static_cast<float>(in_.below(3));
      std::vector<std::uint32_t> indices(3 * in_.below(12));
      for (std::uint32_t& index : indices)
        index = in_.below(static_cast<std::uint32_t>(count + (count == 0 || one_in(64) ? 1 : 0)));
      const surefill_status made =
          surefill_occluder_mesh_create(positions.data(), count, 16, indices.data(), indices.size(), &c_meshes[i]);
      const Status expected = meshes[i].prepare(positions, indices, 4);
      if (made != static_cast<surefill_status>(expected)) fail("surefill_occluder_mesh_create says " + text(made));
      occluders[i].state() = cpp_draws_[i].state(), occluders[i].vertices = cpp_draws_[i].vertices;
      occluders[i].mesh = c_meshes[i] == nullptr ? nullptr : &meshes[i];
    }
    const surefill_status drawn =
        surefill_safe_occlusion_draw(c, c_meshes.data(), draws.data(), draws.size(), options_);
    if (c == nullptr || unused || !wrong_options_.empty()) {
      if (drawn == SUREFILL_OK && (c == nullptr || unused)) fail("surefill_safe_occlusion_draw accepts what is wrong");
    } else {
      const auto expected = static_cast<surefill_status>(cpp.draw(occluders, cpp_options_));
      if (drawn != expected) fail("surefill_safe_occlusion_draw says " + text(drawn));
    }
    for (surefill_occluder_mesh* mesh : c_meshes) surefill_occluder_mesh_destroy(mesh);
  }

  void build_target() {
    surefill_target& t = known_target_;
    t.struct_size = struct_size(kLeastTarget, sizeof t, SUREFILL_TARGET_STRUCT_SIZE, &wrong_);
    t.width = size();
    t.height = size();
    t.samples = one_in(8) ? 1 << in_.below(5) : one_in(64) ? size() : 1;
    const std::size_t total = surefill_sample_total(&t), guess = total == 0 ? 4 : total;
    Target sizes;
    sizes.width = t.width, sizes.height = t.height, sizes.samples = t.samples;
    if (total != sample_total(sizes)) fail("surefill_sample_total differs from sample_total");
    output(guess, &t.count, &t.count_count);
    const std::size_t layered = guess * build_places(t, guess);
    if (!one_in(4)) {
      output(layered, &t.index, &t.index_count);
      output(layered, &t.depth, &t.depth_count);
      output(3 * layered, &t.barycentrics, &t.barycentrics_count);
      build_attribute_targets(layered);
    }
    if (one_in(4)) {
      bool fresh;
      std::size_t there;
      t.initial_depth = t.depth, t.initial_depth_count = t.depth_count;
      if (one_in(2)) {
        t.initial_depth_count = told(guess, &there);
        t.initial_depth = buffer<float>(there * sizeof(float), false, &fresh);
      }
    }
    t.depth_test = enumerator(4);
    t.attribute_location = enumerator(2);
    target_ = place(t, allocated_size(t.struct_size));
    if (one_in(64)) {
      target_ = nullptr;
      wrong_.push_back(SUREFILL_NULL_TARGET);
    }
  }

  // What the target has had since 0.2, where the caller's struct has it. Gives the layers that buffers are made for.
  std::size_t build_places(surefill_target& t, std::size_t total) {
    if (t.struct_size != sizeof t) return 1;
    if (one_in(8)) t.layers = one_in(8) ? in_.word() : in_.below(4);
    if (one_in(8)) t.origin_x = one_in(8) ? size() : 4194304, t.origin_y = static_cast<int>(in_.below(5)) - 2;
    if (one_in(8)) {
      std::size_t there;
      bool fresh;
      const bool few = t.samples >= 1 && t.samples <= 16;
      t.sample_location_count = told(few ? static_cast<std::size_t>(t.samples) : 1, &there);
      surefill_place* places = buffer<surefill_place>(there * sizeof(surefill_place), false, &fresh);
      const auto coordinate = [this] { return one_in(64) ? size() - 2 : static_cast<int>(in_.below(16)); };
      for (std::size_t n = 0; fresh && n < there; ++n) places[n] = {coordinate(), coordinate()};
      t.sample_locations = places;
    }
    if (one_in(8)) output(total, &t.winding, &t.winding_count);
    return std::clamp<std::size_t>(t.layers, 1, kMaxLayers);
  }

  void build_attribute_targets(std::size_t total) {
    std::vector<surefill_attribute_target> list(one_in(32) ? 16 + in_.below(3) : in_.below(3));
    for (surefill_attribute_target& attribute : list) {
      attribute = {};
      attribute.components = one_in(32) ? in_.below(6) : 1 + in_.below(4);
      output(attribute.components * total, &attribute.values, &attribute.value_count);
      components_.push_back(attribute.components);
    }
    known_target_.attribute_count = list.size();
    if (one_in(64)) return;  // null
    std::byte* at = allocate(list.size() * sizeof(surefill_attribute_target), false);
    if (!list.empty()) std::memcpy(at, list.data(), list.size() * sizeof(surefill_attribute_target));
    known_target_.attributes = reinterpret_cast<const surefill_attribute_target*>(at);
  }

  void build_draws() {
    const std::size_t count = in_.below(4);
    const std::size_t stride =
        struct_size(kLeastDraw, sizeof(surefill_draw), SUREFILL_DRAW_STRUCT_SIZE, &wrong_size_of_draw_);
    for (std::size_t d = 0; d < count; ++d) known_draws_.push_back(build_draw(stride));
    draw_count_ = count;
    if (count == 0) wrong_size_of_draw_.clear();  // nobody reads it
    // Where the size is wrong, the first draw's is all that may be read.
    const bool bad = !wrong_size_of_draw_.empty();
    std::byte* at = allocate(count == 0 ? 0 : bad ? allocated_size(stride) : count * stride, false);
    for (std::size_t d = 0; d < (bad ? 1 : count); ++d) {
      surefill_draw draw = known_draws_[d];
      if (d != 0 && one_in(64)) {
        draw.struct_size = one_in(2) ? 0 : stride == kLeastDraw ? sizeof draw : kLeastDraw;
        if (draw.struct_size != stride) wrong_draws_.push_back(SUREFILL_DRAW_STRUCT_SIZE);
      }
      std::memcpy(at + (bad ? 0 : d * stride), &draw, std::min(sizeof draw, allocated_size(stride)));
    }
    draws_ = reinterpret_cast<const surefill_draw*>(at);
    if (one_in(64)) {
      draws_ = nullptr;
      wrong_draws_.clear();
      wrong_size_of_draw_.clear();
      known_draws_.clear();
    } else {
      wrong_draws_.insert(wrong_draws_.end(), wrong_size_of_draw_.begin(), wrong_size_of_draw_.end());
    }
    wrong_.insert(wrong_.end(), wrong_draws_.begin(), wrong_draws_.end());
  }

  // A draw as a caller with a struct of `known` bytes can ask for it.
  surefill_draw build_draw(std::size_t known) {
    surefill_draw d{};
    d.struct_size = known;
    if (known >= sizeof d && one_in(4)) {
      constexpr std::size_t kStrides[] = {16, 20, 32, 64, 0, 15, 12, 18, std::size_t{1} << 62, kSizeMax, kSizeMax - 3};
      d.vertex_stride = kStrides[one_in(8) ? in_.below(std::size(kStrides)) : in_.below(4)];
    }
    build_vertices(d);
    bool fresh;
    std::size_t there;
    if (known == sizeof d && one_in(4)) d.primitive = enumerator(3);
    if (known == sizeof d && one_in(4)) d.width = one_in(2) ? real() : static_cast<float>(in_.byte()) / 16;
    const std::size_t corners_of_one = d.primitive == SUREFILL_TRIANGLES ? 3 : d.primitive == SUREFILL_LINES ? 2 : 1;
    d.index_count = told(d.vertex_count == 0 ? 0 : corners_of_one * in_.below(5), &there);
    std::uint32_t* indices = buffer<std::uint32_t>(there * 4, false, &fresh);
    d.indices = indices;
    const auto vertices = static_cast<std::uint32_t>(std::clamp<std::size_t>(d.vertex_count, 1, 8));
    for (std::size_t i = 0; fresh && i < there; ++i) {
      indices[i] = one_in(64) ? 0xFFFFFFFFu - in_.below(2) : in_.below(vertices);
    }
    if (one_in(4)) {
      d.identifier_count = told(std::min<std::size_t>(d.index_count / corners_of_one, 16), &there);
      std::uint32_t* identifiers = buffer<std::uint32_t>(there * 4, false, &fresh);
      if (fresh && there != 0 && one_in(16)) identifiers[0] = SUREFILL_NO_TRIANGLE;
      d.identifiers = identifiers;
    }
    d.first_index = one_in(16) ? 0xFFFFFFFFu - in_.below(8) : in_.byte();
    build_attributes(d);
    d.fill_rule = enumerator(10);
    d.front_face = enumerator(2);
    d.cull = enumerator(3);
    d.depth_mode = enumerator(3);
    d.conservative = one_in(16) ? enumerator(5) : 0;
    if (known == sizeof d) {
      if (one_in(8)) d.depth_bias = place(surefill_depth_bias{real(), real()}, sizeof(surefill_depth_bias));
      const std::size_t triangles = std::min<std::size_t>(d.index_count / corners_of_one, 16);
      if (one_in(8)) output(triangles, &d.covered, &d.covered_count);
      if (one_in(8)) output(triangles, &d.visible, &d.visible_count);
      vast_numbers_ = vast_numbers_ || d.covered_count > 0xFFFFFFFFu || d.visible_count > 0xFFFFFFFFu;
    }
    d.depth_write_off = one_in(4) ? in_.word() : 0;
    const auto edge = [this] { return one_in(4) ? static_cast<int>(in_.word()) : static_cast<int>(in_.below(8)); };
    if (one_in(4)) d.scissor = place(surefill_scissor{edge(), edge(), edge(), edge()}, sizeof(surefill_scissor));
    if (one_in(8)) {
      const auto offset = [this] { return one_in(16) ? size() : static_cast<int>(in_.below(16)); };
      const int bits = one_in(16) ? size() : 8, x = offset(), y = offset();
      const surefill_grid grid{bits, x, y, enumerator(3)};
      d.grid = place(grid, sizeof grid);
    }
    if (one_in(8)) {  // ignored unless it is finite, and then a promise that must be kept: all corners are NaN
      surefill_vertex corners[8];
      for (surefill_vertex& corner : corners) corner = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 1};
      std::byte* at = allocate(sizeof corners, false);
      std::memcpy(at, corners, sizeof corners);
      d.culling_box = reinterpret_cast<const surefill_vertex*>(at);
    }
    return d;
  }

  void build_vertices(surefill_draw& d) {
    std::size_t there;
    d.vertex_count = told(in_.below(7), &there);
    const bool good = d.vertex_stride == 0 || (d.vertex_stride >= sizeof(Vertex) && d.vertex_stride % 4 == 0 &&
                                               d.vertex_count <= std::size_t{PTRDIFF_MAX} / d.vertex_stride);
    if (!good) wrong_draws_.push_back(SUREFILL_DRAW_VERTEX_STRIDE);
    constexpr std::size_t kLargestStride = 64;
    const std::size_t stride = d.vertex_stride == 0 ? sizeof(Vertex) : d.vertex_stride;
    if (good && stride > kLargestStride && there > 1) d.vertex_count = there = 1;
    const std::size_t bytes = there == 0 ? 0 : (good ? (there - 1) * stride : 0) + sizeof(Vertex);
    bool fresh;
    std::byte* at = buffer<std::byte>(bytes, false, &fresh);
    d.vertices = reinterpret_cast<const surefill_vertex*>(at);
    for (std::size_t v = 0; fresh && good && v < there; ++v) {
      const Vertex vertex{real(), real(), real(), one_in(4) ? real() : 1.0f};
      std::memcpy(at + v * stride, &vertex, sizeof vertex);
    }
  }

  void build_attributes(surefill_draw& d) {
    d.attribute_count = one_in(32) ? in_.below(20) : components_.size();
    std::vector<surefill_attribute_array> list(d.attribute_count);
    for (std::size_t k = 0; k < list.size(); ++k) {
      surefill_attribute_array& a = list[k];
      a = {};
      a.components = k < components_.size() && !one_in(64) ? components_[k] : in_.below(6);
      if (one_in(4)) a.stride = one_in(8) ? 0xFFFFFFFFu : a.components + in_.below(4);
      constexpr std::size_t kMostValues = 256;
      const std::size_t stride = a.stride == 0 ? a.components : a.stride, n = d.vertex_count;
      const std::size_t needed = n == 0 || n > 16 ? 0 : std::min((n - 1) * stride + a.components, kMostValues);
      // One short or one over, but never more than is there: too many are allowed.
      a.value_count = needed == 0 || !one_in(32) ? needed : needed - 1 + 2 * in_.below(2);
      bool fresh;
      float* values = buffer<float>(a.value_count * sizeof(float), false, &fresh);
      for (std::size_t i = 0; fresh && i < a.value_count; ++i) values[i] = real();
      a.values = values;
      a.interpolation = enumerator(3);
    }
    if (one_in(64)) return;  // null
    std::byte* at = allocate(list.size() * sizeof(surefill_attribute_array), false);
    if (!list.empty()) std::memcpy(at, list.data(), list.size() * sizeof(surefill_attribute_array));
    d.attributes = reinterpret_cast<const surefill_attribute_array*>(at);
  }

  void build_options() {
    if (!one_in(4)) {
      surefill_options o{};
      o.struct_size = struct_size(kLeastOptions, sizeof o, SUREFILL_OPTIONS_STRUCT_SIZE, &wrong_options_);
      constexpr std::int32_t kThreads[] = {0, 1, 2, 1, 256, -1, 257, std::numeric_limits<std::int32_t>::min()};
      o.threads = one_in(16) ? kThreads[in_.below(8)] : in_.below(2) != 0;
      o.path = enumerator(2);
      cpp_options_ = {o.threads == 0 ? 1 : o.threads, to_enum<Path>(o.path)};
      options_ = place(o, allocated_size(o.struct_size));
      if (o.threads < 0 || o.threads > SUREFILL_MAX_THREADS) wrong_options_.push_back(SUREFILL_OPTIONS_THREADS);
      if (o.path > SUREFILL_PATH_REFERENCE) wrong_options_.push_back(SUREFILL_OPTIONS_PATH);
    }
    if (!one_in(2)) {
      surefill_statistics s{};
      s.struct_size = struct_size(kLeastStatistics, sizeof s, SUREFILL_STATISTICS_STRUCT_SIZE, &wrong_options_);
      statistics_ = place(s, allocated_size(s.struct_size));
      statistics_memory_ = memory_.size() - 1;
    }
  }

  // The call in C++, on the twins.
  void translate() {
    const surefill_target& t = known_target_;
    cpp_target_.width = t.width, cpp_target_.height = t.height, cpp_target_.samples = t.samples;
    cpp_target_.count = {twin(t.count), t.count_count};
    cpp_target_.index = {twin(t.index), t.index_count};
    cpp_target_.depth = {twin(t.depth), t.depth_count};
    cpp_target_.barycentrics = {twin(t.barycentrics), t.barycentrics_count};
    cpp_target_.initial_depth = {twin(t.initial_depth), t.initial_depth_count};
    cpp_target_.depth_test = to_enum<DepthTest>(t.depth_test);
    cpp_target_.attribute_location = to_enum<AttributeLocation>(t.attribute_location);
    cpp_target_.layers = t.layers == 0 ? 1 : static_cast<int>(std::min<std::uint32_t>(t.layers, INT32_MAX));
    cpp_target_.origin = {t.origin_x, t.origin_y};
    cpp_target_.sample_locations = {reinterpret_cast<const SampleLocation*>(twin(t.sample_locations)),
                                    t.sample_location_count};
    cpp_target_.winding = {twin(t.winding), t.winding_count};
    for (std::size_t k = 0; t.attributes != nullptr && k < t.attribute_count; ++k) {
      cpp_attribute_targets_.push_back({{twin(t.attributes[k].values), t.attributes[k].value_count},
                                        t.attributes[k].components,
                                        t.attributes[k].stride});
    }
    const AttributeTarget* list = t.attributes == nullptr ? nullptr : cpp_attribute_targets_.data();
    cpp_target_.attributes = {list, t.attribute_count};

    cpp_own_draws_.reserve(known_draws_.size());
    for (const surefill_draw& d : known_draws_) translate(d, cpp_own_draws_.emplace_back());
    const Draw* draws = draws_ == nullptr ? nullptr : cpp_own_draws_.data();
    cpp_draws_ = {draws, draw_count_};
  }

  void translate(const surefill_draw& d, Draw& to) {
    to.vertices = {reinterpret_cast<const Vertex*>(twin(d.vertices)), d.vertex_count};
    const std::size_t stride = d.vertex_stride;
    constexpr std::size_t kMostVertices = 16;  // more are never there
    if (stride > sizeof(Vertex) && stride % 4 == 0 && d.vertices != nullptr && d.vertex_count <= kMostVertices &&
        wrong_draws_.empty()) {
      std::vector<Vertex>& dense = cpp_vertices_.emplace_back(d.vertex_count);
      const auto* from = reinterpret_cast<const std::byte*>(d.vertices);
      for (std::size_t v = 0; v < dense.size(); ++v) std::memcpy(&dense[v], from + v * stride, sizeof(Vertex));
      to.vertices = dense;
      if (!dense.empty()) note_overlap(from, (dense.size() - 1) * stride + sizeof(Vertex));
    }
    to.indices = {twin(d.indices), d.index_count};
    to.identifiers = {twin(d.identifiers), d.identifier_count};
    to.first_index = d.first_index;
    to.fill_rule = to_enum<FillRule>(d.fill_rule);
    to.front_face = to_enum<FrontFace>(d.front_face);
    to.cull = to_enum<Cull>(d.cull);
    to.depth_mode = to_enum<DepthMode>(d.depth_mode);
    to.depth_write = d.depth_write_off == 0;
    to.conservative = to_enum<Conservative>(d.conservative);
    if (d.scissor != nullptr) to.scissor = {d.scissor->x0, d.scissor->y0, d.scissor->x1, d.scissor->y1};
    if (d.grid != nullptr) {
      to.grid = Grid{d.grid->bits, d.grid->offset_x, d.grid->offset_y, to_enum<GridRounding>(d.grid->rounding)};
    }
    if (d.depth_bias != nullptr) to.depth_bias = DepthBias{d.depth_bias->constant, d.depth_bias->slope};
    to.primitive = to_enum<Primitive>(d.primitive);
    if (d.width != 0) to.width = d.width;
    to.covered = {twin(d.covered), d.covered_count};
    to.visible = {twin(d.visible), d.visible_count};
    std::vector<AttributeArray>& arrays = cpp_arrays_.emplace_back();
    for (std::size_t k = 0; d.attributes != nullptr && k < d.attribute_count; ++k) {
      const surefill_attribute_array& a = d.attributes[k];
      arrays.push_back(
          {{twin(a.values), a.value_count}, a.components, a.stride, to_enum<Interpolation>(a.interpolation)});
    }
    to.attributes = {d.attributes == nullptr ? nullptr : arrays.data(), d.attribute_count};
  }

  // Do strided vertices share a byte with an output that is asked for?
  void note_overlap(const std::byte* from, std::size_t size) {
    const auto begin = reinterpret_cast<std::uintptr_t>(from);
    const auto add = [&](const void* output, std::size_t count, std::size_t element) {
      const auto at = reinterpret_cast<std::uintptr_t>(output);
      if (count != 0 && count < (std::size_t{1} << 32) && at < begin + size && begin < at + count * element) {
        strided_overlap_ = true;
      }
    };
    const surefill_target& t = known_target_;
    add(t.count, t.count_count, 4);
    add(t.index, t.index_count, 4);
    add(t.depth, t.depth_count, 4);
    add(t.barycentrics, t.barycentrics_count, 4);
    add(t.winding, t.winding_count, 4);
    for (const surefill_draw& d : known_draws_) add(d.covered, d.covered_count, 8), add(d.visible, d.visible_count, 8);
    for (std::size_t k = 0; t.attributes != nullptr && k < t.attribute_count; ++k) {
      add(t.attributes[k].values, t.attributes[k].value_count, 4);
    }
  }

  // Numbers that are said to reach over half of memory overlap what happens to lie there, in C or in C++.
  bool either_is_right(surefill_status c, surefill_status cpp) const {
    return vast_numbers_ && c != SUREFILL_OK && cpp != SUREFILL_OK &&
           (c == SUREFILL_TARGET_OVERLAP || cpp == SUREFILL_TARGET_OVERLAP);
  }

  void expect(const char* call, surefill_status actual, Status cpp, const std::vector<surefill_status>& wrong) const {
    const auto same = static_cast<surefill_status>(cpp);
    const std::string says = std::string(call) + " says " + text(actual) + ", C++ " + text(same);
    if (either_is_right(actual, same)) return;
    if (wrong.empty() && !strided_overlap_) {
      if (actual != same) fail(says);
      return;
    }
    const bool named = std::find(wrong.begin(), wrong.end(), actual) != wrong.end() ||
                       (strided_overlap_ && actual == SUREFILL_TARGET_OVERLAP);
    if (actual == SUREFILL_OK || (!named && actual != same)) {
      fail(says + (wrong.empty() ? ", but strided vertices overlap an output" : ", but wrong is " + text(wrong[0])));
    }
  }

  void check_image(const Statistics& expected, const std::string& path) {
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      const Memory& m = memory_[i];
      if (i == statistics_memory_) continue;
      const std::byte* right = m.output ? m.twin.get() : m.before.data();
      if (!std::equal(right, right + m.size, m.bytes.get())) {
        fail(m.output ? "an output differs from that of C++" : "an input was written");
      }
    }
    if (statistics_ == nullptr) return;
    const surefill_statistics& s = *statistics_;
    if (s.struct_size != sizeof s || s.triangles != expected.triangles() || s.dropped != expected.dropped ||
        s.degenerate != expected.degenerate || s.culled != expected.culled || s.outside != 0 ||
        s.rasterized != expected.rasterized || s.path != path) {
      fail("the statistics differ from those of C++");
    }
  }

  void fill(surefill_box& box) {
    for (surefill_vertex& corner : box.corners) corner = {real(), real(), real(), one_in(4) ? real() : 1.0f};
  }
  // Half of them in view; what is at infinity is hidden.
  void fill(surefill_rectangle& box) {
    box = {real(), real(), real(), real(), real()};
    if (in_.below(2) == 0) box.x0 = box.y0 = 0, box.x1 = box.y1 = 2;
    if (one_in(4)) box.nearest_depth = HUGE_VALF;
  }

  // Boxes or rectangles, asked of C and of C++.
  template <typename CppBox, typename CBox, typename Handle, typename Buffer, typename Query>
  void check_query(const Handle* c, const Buffer& cpp, Query query) {
    const std::size_t count = in_.below(3);
    std::vector<CBox> boxes(count);
    std::vector<CppBox> cpp_boxes(count);
    static_assert(sizeof(CBox) == sizeof(CppBox));
    for (std::size_t i = 0; i < count; ++i) {
      fill(boxes[i]);
      std::memcpy(&cpp_boxes[i], &boxes[i], sizeof boxes[i]);
    }
    constexpr std::uint8_t kMark = 0x5A;
    std::vector<std::uint8_t> answers(count, kMark), cpp_answers(count, kMark);
    const bool no_boxes = one_in(16), no_answers = one_in(16);
    const surefill_status status =
        query(c, no_boxes ? nullptr : boxes.data(), count, no_answers ? nullptr : answers.data());
    const Status expected =
        cpp.query(std::span<const CppBox>(no_boxes ? nullptr : cpp_boxes.data(), count),
                  std::span<Occlusion>(no_answers ? nullptr : reinterpret_cast<Occlusion*>(cpp_answers.data()), count));
    if (status != (c == nullptr ? SUREFILL_NULL_OCCLUSION : static_cast<surefill_status>(expected))) {
      fail("a query of occlusion says " + text(status));
    }
    if (c != nullptr && answers != cpp_answers) fail("the answers of C and of C++ differ");
    if (status != SUREFILL_OK && std::any_of(answers.begin(), answers.end(), [](auto a) { return a != kMark; })) {
      fail("a refused query wrote an answer");
    }
  }

  surefill_target known_target_{};
  std::vector<surefill_draw> known_draws_;
  std::vector<std::uint32_t> components_;  // of the target's attributes
  const surefill_target* target_ = nullptr;
  const surefill_draw* draws_ = nullptr;
  std::size_t draw_count_ = 0;
  const surefill_options* options_ = nullptr;
  surefill_statistics* statistics_ = nullptr;
  std::size_t statistics_memory_ = kSizeMax;  // its number
  // What is wrong of C alone: with the frame, with its draws, with options and statistics.
  std::vector<surefill_status> wrong_, wrong_draws_, wrong_size_of_draw_, wrong_options_;
  bool strided_overlap_ = false;
  bool vast_numbers_ = false;  // a draw's covered or visible ones

  Target cpp_target_;
  std::vector<AttributeTarget> cpp_attribute_targets_;
  std::vector<Draw> cpp_own_draws_;
  std::deque<std::vector<AttributeArray>> cpp_arrays_;
  std::deque<std::vector<Vertex>> cpp_vertices_;
  std::span<const Draw> cpp_draws_;
  Options cpp_options_;
};

// The viewport map, in C and in C++; and the calls that take little.
void check_small_calls(ByteReader& in) {
  surefill_viewport viewport{};
  for (float* number :
       {&viewport.x, &viewport.y, &viewport.width, &viewport.height, &viewport.near_depth, &viewport.far_depth}) {
    *number = in.below(4) == 3 ? in.real() : static_cast<float>(in.byte());
  }
  viewport.clip_depth_minus_one = in.below(8) == 7 ? in.word() : in.below(2);
  viewport.clip_y_down = in.below(8) == 7 ? in.word() : in.below(2);
  const std::size_t count = in.below(5);
  std::vector<surefill_vertex> from(count), to(count);
  std::vector<ClipVertex> cpp_from(count);
  std::vector<Vertex> cpp_to(count);
  for (std::size_t i = 0; i < count; ++i) {
    from[i] = {in.real(), in.real(), in.real(), in.real()};
    std::memcpy(&cpp_from[i], &from[i], sizeof from[i]);
    std::memset(static_cast<void*>(&to[i]), 0x3F, sizeof to[i]);
    std::memset(static_cast<void*>(&cpp_to[i]), 0x3F, sizeof cpp_to[i]);
  }
  const bool no_viewport = in.below(16) == 15, no_from = in.below(16) == 15, no_to = in.below(16) == 15;
  const surefill_status status = surefill_to_pixel(no_viewport ? nullptr : &viewport, no_from ? nullptr : from.data(),
                                                   count, no_to ? nullptr : to.data());
  Status expected = Status::ok;
  if (!no_viewport) {
    const Viewport cpp{viewport.x,
                       viewport.y,
                       viewport.width,
                       viewport.height,
                       viewport.near_depth,
                       viewport.far_depth,
                       to_enum<ClipDepth>(viewport.clip_depth_minus_one),
                       to_enum<ClipY>(viewport.clip_y_down)};
    expected = to_pixel(cpp, std::span<const ClipVertex>(no_from ? nullptr : cpp_from.data(), count),
                        std::span<Vertex>(no_to ? nullptr : cpp_to.data(), count));
  }
  if (status != (no_viewport ? SUREFILL_NULL_VIEWPORT : static_cast<surefill_status>(expected))) {
    fail("surefill_to_pixel says " + text(status));
  }
  if (count != 0 && std::memcmp(to.data(), cpp_to.data(), count * sizeof(Vertex)) != 0) {
    fail("the vertices of C and of C++ differ");
  }

  const auto samples = static_cast<std::int32_t>(in.word()), n = static_cast<std::int32_t>(in.word());
  std::int32_t x = -1, y = -1;
  surefill_sample_location(samples, n, &x, &y);
  surefill_sample_location(samples, n, nullptr, nullptr);
  const SampleLocation location = sample_location(samples, n);
  if (x != location.x || y != location.y) fail("surefill_sample_location differs from sample_location");
  if (surefill_sample_total(nullptr) != 0) fail("surefill_sample_total of nothing");
  if (std::string_view(surefill_version()) != SUREFILL_VERSION) fail("another version than the header's");
  // Every number that C++ lets this enumeration hold.
  for (std::uint32_t any = 0; any < 1024; ++any) {
    if (*surefill_status_text(static_cast<surefill_status>(any)) == '\0') fail("a status without a text");
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill::fuzz;
  const std::uint8_t kind = size == 0 ? 0 : data[0];
  const std::span<const std::uint8_t> rest(data + (size == 0 ? 0 : 1), size == 0 ? 0 : size - 1);
  if (kind % 8 == 7) {
    ByteReader in(rest);
    check_small_calls(in);
  } else if (kind % 8 == 6) {
    Call(rest).check_occlusion();
  } else if (kind % 8 == 4) {
    Call(rest).check_safe_occlusion();
  } else if (kind % 8 == 5) {
    Call(rest).check_stream();
  } else {
    Call(rest).check();
  }
  return 0;
}
