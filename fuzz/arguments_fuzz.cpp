// SPDX-License-Identifier: Apache-2.0
//
// The public calls with hostile arguments (B2): sizes, null spans, wrong sizes, wild enumerators, indices out of range,
// overlapping buffers. The target knows which arguments it spoiled, so it asserts: validate and render name one of
// those, or accept if there are none; a refused call leaves every byte as it was; an accepted one leaves the inputs as
// they were and writes every output whole, the same twice.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fuzz/decode.hpp"
#include "fuzz/finding.hpp"

namespace surefill::fuzz {
namespace {

[[noreturn]] void fail(const std::string& relation) {
  report_finding("arguments", relation);
}

// Memory of exactly the size that was asked for, so that the address sanitizer sees the first byte past it.
struct Allocation {
  std::unique_ptr<std::byte[]> bytes;
  std::size_t size = 0;
  bool output = false;
  std::vector<std::byte> before;

  bool unchanged() const { return std::equal(before.begin(), before.end(), bytes.get()); }
};

constexpr std::size_t kTooMany = std::size_t{1} << 32;  // elements

class Arguments {
 public:
  explicit Arguments(std::span<const std::uint8_t> bytes) : in_(bytes) {
    build_target();
    build_draws();
    note_overlaps();
    note_numbers();
    for (Allocation& a : allocations_) a.before.assign(a.bytes.get(), a.bytes.get() + a.size);
  }

  void check() {
    const Status checked = validate(target_, draws_);
    if (wrong_.empty() != (checked == Status::ok)) {
      fail(std::string("validate says \"") + status_text(checked) + "\", but " + std::to_string(wrong_.size()) +
           " arguments are wrong" + (wrong_.empty() ? "" : std::string(", the first: ") + status_text(wrong_[0])));
    }
    if (checked != Status::ok && std::find(wrong_.begin(), wrong_.end(), checked) == wrong_.end()) {
      fail(std::string("validate names an argument that is right: ") + status_text(checked));
    }
    for (const Allocation& a : allocations_) {
      if (!a.unchanged()) fail("validate wrote to a buffer");
    }
    const Status drawn = render_checked();
    if (checked != Status::ok && drawn != checked) {
      fail(std::string("render says \"") + status_text(drawn) + "\", validate \"" + status_text(checked) + "\"");
    }
    if (checked == Status::ok && drawn != Status::ok) {
      fail(std::string("render refuses what validate accepts: ") + status_text(drawn));
    }
    if (drawn == Status::ok) check_written_whole();
  }

 private:
  // The answer of render; a refusal must leave all bytes alone, and any answer the inputs.
  Status render_checked() {
    constexpr std::uint64_t kMark = 0x5A5A5A5A5A5A5A5A;
    Statistics statistics;
    statistics.dropped = kMark;
    const Status status = render(target_, draws_, with_statistics_ ? &statistics : nullptr);
    for (const Allocation& a : allocations_) {
      if ((status != Status::ok || !a.output) && !a.unchanged()) {
        fail(std::string("a buffer was written that must not be; status: ") + status_text(status));
      }
    }
    if (status != Status::ok && statistics.dropped != kMark) fail("a refused call wrote the statistics");
    if (status != Status::ok) return status;  // the list of draws may be none
    std::size_t triangles = 0;
    for (const Draw& draw : draws_) triangles += draw.indices.size() / corners_of(draw);
    if (with_statistics_ && statistics.triangles() != triangles) fail("the statistics do not add up to the triangles");
    return status;
  }

  // The same image again onto buffers that held something else.
  void check_written_whole() {
    std::vector<std::vector<std::byte>> first;
    for (Allocation& a : allocations_) {
      first.emplace_back(a.bytes.get(), a.bytes.get() + a.size);
      if (!a.output) continue;
      const bool initial = reinterpret_cast<const float*>(a.bytes.get()) == target_.initial_depth.data();
      for (std::size_t i = 0; i < a.size; ++i) a.bytes[i] = initial ? a.before[i] : ~a.before[i];
    }
    if (const Status status = render(target_, draws_); status != Status::ok) {
      fail(std::string("the second call is refused: ") + status_text(status));
    }
    for (std::size_t i = 0; i < allocations_.size(); ++i) {
      if (!std::equal(first[i].begin(), first[i].end(), allocations_[i].bytes.get())) {
        fail("the image depends on what the buffers held before");
      }
    }
  }

  void note(bool is_wrong, Status status) {
    if (is_wrong) wrong_.push_back(status);
  }

  bool one_in(std::uint32_t n) { return in_.below(n) == n - 1; }  // false when the bytes have run out

  int wild_int() {
    constexpr int kValues[] = {0,    -1, 1, 16, 13, std::numeric_limits<int>::min(), std::numeric_limits<int>::max(),
                               16385};
    return kValues[in_.below(8)];
  }

  // An enumerator; one time in 32 the number after the last, or any byte at all.
  template <typename Enum>
  Enum enumerator(Enum last, Status status) {
    const auto count = static_cast<std::uint32_t>(last) + 1;
    const std::uint32_t value = !one_in(32) ? in_.below(count) : one_in(2) ? in_.byte() : count;
    note(value >= count, status);
    return static_cast<Enum>(value);
  }

  // A buffer meant to hold `count` elements; one time in 16 spoiled. `status` is what it is called then.
  enum class Spoiled { no, absent, one_short, one_over, null, on_another, inside_another, too_many };
  template <typename T>
  std::span<T> buffer(std::size_t count, bool output, Spoiled* how) {
    const Spoiled spoiled = one_in(16) ? static_cast<Spoiled>(in_.below(8)) : Spoiled::no;
    *how = spoiled;
    std::size_t size = count;
    switch (spoiled) {
      case Spoiled::absent:
        return {};
      case Spoiled::null:
        return count == 0 ? std::span<T>{} : null_span<T>(count);
      case Spoiled::one_short:
        size = count == 0 ? 0 : count - 1;
        break;
      case Spoiled::one_over:
        size = count + 1;
        break;
      case Spoiled::on_another:
      case Spoiled::inside_another: {
        if (allocations_.empty()) break;
        Allocation& other = allocations_[in_.below(static_cast<std::uint32_t>(allocations_.size()))];
        const std::size_t shift = spoiled == Spoiled::on_another ? 0 : 4 * in_.below(8);
        if (reinterpret_cast<std::uintptr_t>(other.bytes.get() + shift) % alignof(T) != 0) break;
        if (shift > other.size || (other.size - shift) / sizeof(T) < count) break;
        other.output |= output;
        return {reinterpret_cast<T*>(other.bytes.get() + shift), count};
      }
      default:
        break;
    }
    Allocation& own = allocations_.emplace_back();
    own.size = size * sizeof(T);
    own.bytes.reset(new std::byte[own.size]);
    std::memset(own.bytes.get(), 0x3F, own.size);
    own.output = output;
    return {reinterpret_cast<T*>(own.bytes.get()), spoiled == Spoiled::too_many ? kTooMany : size};
  }

  // A span with a size and without memory, which the constructor of span would let nobody make by accident.
  template <typename T>
  static std::span<T> null_span(std::size_t count) {
    T* null = nullptr;
    return std::span<T>(null, count);
  }

  // An output: empty or of exactly `count` elements.
  template <typename T>
  std::span<T> output(std::size_t count, Status status) {
    if (one_in(4)) return {};
    Spoiled how;
    const std::span<T> span = buffer<T>(count, true, &how);
    note(!span.empty() && (span.data() == nullptr || span.size() != count), status);
    return span;
  }

  void build_target() {
    const auto size = [this] {
      return one_in(64) ? kMaxTargetSize : one_in(32) ? wild_int() : 1 + static_cast<int>(in_.below(9));
    };
    target_.width = size();
    target_.height = size();
    // Larger targets are slow, and say no more: one row or column, one sample, counts alone.
    constexpr std::int64_t kLargestArea = 1024;
    const bool large = static_cast<std::int64_t>(target_.width) * target_.height > kLargestArea;
    if (large && target_.width > kLargestArea) target_.height = std::min(target_.height, 1);
    if (large && target_.height > kLargestArea) target_.width = std::min(target_.width, 1);
    target_.samples = one_in(4) && !large ? 1 << in_.below(5) : one_in(32) ? wild_int() : 1;
    const bool size_ok = target_.width >= 1 && target_.width <= kMaxTargetSize && target_.height >= 1 &&
                         target_.height <= kMaxTargetSize;
    const int n = target_.samples;
    const bool samples_ok = n == 1 || n == 2 || n == 4 || n == 8 || n == 16;
    note(!size_ok, Status::target_size);
    note(!samples_ok, Status::target_samples);
    const std::size_t total = size_ok && samples_ok ? static_cast<std::size_t>(target_.width * target_.height * n) : 4;
    if (sample_total(target_) != (size_ok && samples_ok ? total : 0)) {
      fail("sample_total is not width * height * samples, or not 0 where they are refused");
    }

    const std::size_t layered = total * build_places(large);
    target_.count = output<std::uint32_t>(total, Status::target_count);
    if (!large && one_in(8)) target_.winding = output<std::int32_t>(total, Status::target_winding);
    if (!large && !one_in(4)) {
      target_.index = output<std::uint32_t>(layered, Status::target_index);
      target_.depth = output<float>(layered, Status::target_depth);
      target_.barycentrics = output<float>(3 * layered, Status::target_barycentrics);
      build_attribute_targets(layered);
    }
    if (one_in(4)) {
      if (one_in(2)) {
        target_.initial_depth = target_.depth;
        note(!target_.depth.empty() && target_.depth.size() != total, Status::target_initial_depth);
        note(!target_.depth.empty() && target_.layers != 1, Status::target_overlap);
      } else {
        Spoiled how;
        target_.initial_depth = buffer<float>(total, false, &how);
        const bool absent = target_.initial_depth.empty();
        note(!absent && (target_.initial_depth.data() == nullptr || target_.initial_depth.size() != total),
             Status::target_initial_depth);
      }
    }
    target_.depth_test = enumerator(DepthTest::greater_equal, Status::target_depth_test);
    target_.attribute_location = enumerator(AttributeLocation::centroid, Status::target_attribute_location);
    with_statistics_ = one_in(2);
  }

  // Layers, origin and sample places (V4, S6, S7). Gives the number of layers that buffers are made for.
  std::size_t build_places(bool large) {
    if (one_in(8)) target_.layers = one_in(8) ? wild_int() : 1 + static_cast<int>(in_.below(3));
    if (large) target_.layers = 1;
    const bool layers_ok = target_.layers >= 1 && target_.layers <= kMaxLayers;
    note(!layers_ok, Status::target_layers);
    if (one_in(8)) target_.origin = {one_in(2) ? wild_int() : 3, one_in(2) ? wild_int() : -4194304};
    const auto near = [](int place) { return place >= -kMaxOrigin && place <= kMaxOrigin; };
    note(!near(target_.origin.x) || !near(target_.origin.y), Status::target_origin);
    if (one_in(8)) {
      const std::size_t count = target_.samples >= 1 && target_.samples <= 16
                                    ? static_cast<std::size_t>(target_.samples) + (one_in(8) ? 1 : 0)
                                    : 1;
      for (std::size_t n = 0; n < count; ++n) {
        locations_.push_back(
            {one_in(32) ? wild_int() : static_cast<int>(in_.below(16)), static_cast<int>(in_.below(16))});
        note(locations_.back().x < 0 || locations_.back().x > 15, Status::target_sample_locations);
      }
      target_.sample_locations = locations_;
      note(count != static_cast<std::size_t>(target_.samples), Status::target_sample_locations);
    }
    return layers_ok ? static_cast<std::size_t>(target_.layers) : 1;
  }

  void build_attribute_targets(std::size_t total) {
    attribute_targets_.resize(one_in(32) ? kMaxAttributes + in_.below(2) : in_.below(4));
    note(attribute_targets_.size() > kMaxAttributes, Status::target_attributes);
    for (AttributeTarget& attribute : attribute_targets_) {
      attribute.components = one_in(32) ? in_.below(6) : 1 + in_.below(kMaxComponents);
      note(attribute.components < 1 || attribute.components > kMaxComponents, Status::target_attributes);
      attribute.values = output<float>(attribute.components * total, Status::target_attributes);
    }
    target_.attributes = attribute_targets_;
    if (one_in(64)) {
      target_.attributes = null_span<const AttributeTarget>(1);
      note(true, Status::target_attributes);
    }
  }

  void build_draws() {
    const std::size_t count = in_.below(3);
    attribute_arrays_.resize(count);  // before any span into them
    own_draws_.resize(count);
    for (std::size_t d = 0; d < count; ++d) build_draw(own_draws_[d], attribute_arrays_[d]);
    draws_ = own_draws_;
    if (one_in(64)) {
      draws_ = null_span<const Draw>(1);
      note(true, Status::draws);
    }
  }

  void build_draw(Draw& draw, std::vector<AttributeArray>& arrays) {
    Spoiled how;
    draw.vertices = vertices(in_.below(7));
    if (one_in(4)) draw.primitive = enumerator(Primitive::points, Status::draw_primitive);
    const std::size_t triangles = draw.vertices.empty() ? 0 : in_.below(5);
    std::span<std::uint32_t> indices =
        buffer<std::uint32_t>(corners_of(draw) * triangles + (one_in(32) ? 1 : 0), false, &how);
    // Half of 2^32 lines could be drawn, and would be read: too many of every primitive are three times as many.
    if (how == Spoiled::too_many) indices = {indices.data(), 3 * kTooMany};
    const bool readable = indices.data() != nullptr && indices.size() < kTooMany;
    if (readable && how != Spoiled::on_another && how != Spoiled::inside_another) {
      for (std::uint32_t& index : indices) {
        const std::size_t known = std::clamp<std::size_t>(draw.vertices.size(), 1, 8);
        const std::uint32_t past_the_end = one_in(64) ? 1 : 0;
        index = one_in(64) ? 0xFFFFFFFFu - in_.below(2) : in_.below(static_cast<std::uint32_t>(known) + past_the_end);
      }
    }
    draw.indices = indices;
    note((indices.data() == nullptr && !indices.empty()) || indices.size() % corners_of(draw) != 0 ||
             indices.size() / corners_of(draw) >= kNoTriangle,
         Status::draw_indices);
    const std::size_t drawn = indices.size() / corners_of(draw);

    if (one_in(4)) {
      const std::span<std::uint32_t> identifiers = buffer<std::uint32_t>(drawn < 16 ? drawn : 1, false, &how);
      draw.identifiers = identifiers;
      const bool fresh = how != Spoiled::on_another && how != Spoiled::inside_another;
      const bool there = identifiers.data() != nullptr && identifiers.size() < kTooMany;
      if (fresh && there && !identifiers.empty() && one_in(16)) identifiers[0] = kNoTriangle;
    }
    note(!draw.identifiers.empty() && (draw.identifiers.data() == nullptr || draw.identifiers.size() != drawn),
         Status::draw_identifiers);
    draw.first_index = one_in(16) ? 0xFFFFFFFFu - in_.below(8) : in_.byte();
    note(draw.identifiers.empty() && drawn + draw.first_index > 0xFFFFFFFFu, Status::draw_first_index);

    build_attributes(draw, arrays);
    draw.fill_rule = enumerator(FillRule::open, Status::draw_fill_rule);
    draw.front_face = enumerator(FrontFace::counter_clockwise, Status::draw_front_face);
    draw.cull = enumerator(Cull::back, Status::draw_cull);
    draw.depth_mode = enumerator(DepthMode::clamp, Status::draw_depth_mode);
    draw.depth_write = !one_in(4);
    if (one_in(4)) {
      draw.scissor = one_in(2) ? Scissor{wild_int(), wild_int(), wild_int(), wild_int()} : Scissor{0, 0, 4, 4};
    }
    build_modes(draw);
  }

  void build_modes(Draw& draw) {
    if (one_in(16)) {
      draw.grid = Grid{one_in(4) ? wild_int() : 8, one_in(4) ? wild_int() : 0, one_in(4) ? wild_int() : 15,
                       enumerator(GridRounding::truncate, Status::draw_grid)};
      const auto outside = [](int value, int last) { return value < 0 || value > last; };
      note(outside(draw.grid->bits, 12) || outside(draw.grid->offset_x, 15) || outside(draw.grid->offset_y, 15),
           Status::draw_grid);
      note(draw.fill_rule > FillRule::northwards_west, Status::draw_fill_rule);  // C5
    }
    if (one_in(8)) draw.depth_bias = DepthBias{in_.real(), in_.real()};
    note(draw.depth_bias && !(std::isfinite(draw.depth_bias->constant) && std::isfinite(draw.depth_bias->slope)),
         Status::draw_depth_bias);
    build_primitive(draw);
    note(target_.layers > 1 && !draw.depth_write, Status::target_layers);
    if (one_in(8)) draw.covered = numbers(draw, Status::draw_covered);
    if (one_in(8)) draw.visible = numbers(draw, Status::draw_visible);
    if (one_in(16)) draw.conservative = enumerator(Conservative::touched, Status::draw_conservative);
    if (draw.conservative != Conservative::none) {
      any_conservative_ = true;
      note(target_.layers > 1, Status::target_layers);
      note(!target_.sample_locations.empty(), Status::target_sample_locations);
      bool more = !target_.winding.empty() || !target_.depth.empty() || !target_.barycentrics.empty();
      for (const AttributeTarget& attribute : attribute_targets_) more = more || !attribute.values.empty();
      note(more || draw.primitive != Primitive::triangles || target_.samples != 1 ||
               draw.depth_mode != DepthMode::none || draw.grid.has_value(),
           Status::draw_conservative);
    }
    if (one_in(8)) {
      for (Vertex& corner : draw.culling_box.emplace()) corner = {in_.real(), in_.real(), in_.real(), in_.real()};
    }
  }

  // What goes with lines and points, and what does not (M7, I8).
  void build_primitive(Draw& draw) {
    if (one_in(4)) draw.width = one_in(2) ? in_.real() : static_cast<float>(in_.byte()) / 16;
    note(draw.width && !(std::isfinite(*draw.width) && *draw.width > 0), Status::draw_width);
    if (draw.primitive == Primitive::triangles) return;
    note(draw.fill_rule > FillRule::northwards_west, Status::draw_fill_rule);
    note(draw.grid.has_value(), Status::draw_grid);
    note(draw.depth_bias.has_value(), Status::draw_depth_bias);
    note(draw.primitive == Primitive::lines && !draw.width && target_.samples != 1, Status::draw_width);
  }

  // The vertices of a primitive.
  static std::size_t corners_of(const Draw& draw) {
    return draw.primitive == Primitive::triangles ? 3 : draw.primitive == Primitive::lines ? 2 : 1;
  }

  // One number a triangle (M10).
  std::span<std::uint64_t> numbers(const Draw& draw, Status status) {
    const std::size_t triangles = draw.indices.size() / corners_of(draw);
    return triangles < 16 ? output<std::uint64_t>(triangles, status) : std::span<std::uint64_t>();
  }

  std::span<const Vertex> vertices(std::size_t count) {
    Spoiled how;
    const std::span<Vertex> span = buffer<Vertex>(count, false, &how);
    note((span.data() == nullptr && !span.empty()) || span.size() >= kTooMany, Status::draw_vertices);
    if (span.data() == nullptr || span.size() >= kTooMany || how == Spoiled::on_another ||
        how == Spoiled::inside_another) {
      return span;
    }
    const auto coordinate = [this] { return one_in(8) ? in_.real() : static_cast<float>(in_.byte()) / 16 - 2; };
    for (Vertex& v : span) v = {coordinate(), coordinate(), coordinate(), one_in(4) ? coordinate() : 1.0f};
    return span;
  }

  void build_attributes(Draw& draw, std::vector<AttributeArray>& arrays) {
    const std::size_t asked = target_.attributes.size() > kMaxAttributes ? 0 : attribute_targets_.size();
    arrays.resize(one_in(32) ? in_.below(kMaxAttributes + 2) : std::min(asked + (one_in(4) ? 1 : 0), kMaxAttributes));
    note(arrays.size() > kMaxAttributes || arrays.size() < target_.attributes.size(), Status::draw_attributes);
    for (std::size_t k = 0; k < arrays.size(); ++k) {
      AttributeArray& array = arrays[k];
      array.components = k < asked && !one_in(64) ? attribute_targets_[k].components : in_.below(6);
      note(array.components < 1 || array.components > kMaxComponents ||
               (k < asked && array.components != attribute_targets_[k].components),
           Status::draw_attributes);
      if (one_in(4)) array.stride = array.components + in_.below(4);
      if (one_in(64)) array.stride = one_in(2) ? 0xFFFFFFFFu : 1;
      note(array.stride != 0 && array.stride < array.components, Status::draw_attributes);
      const std::size_t stride = array.stride != 0 ? array.stride : array.components;
      const std::size_t count = draw.vertices.size();
      const std::size_t needed = count == 0 ? 0 : (count - 1) * stride + array.components;
      constexpr std::size_t kLargest = 1024;  // what a stride or a count of 2^32 asks for is not there
      Spoiled how;
      const std::span<float> values = buffer<float>(std::min(needed, kLargest), false, &how);
      const bool fresh = how != Spoiled::on_another && how != Spoiled::inside_another && values.size() < kTooMany;
      if (values.data() != nullptr && fresh) {
        for (float& value : values) value = one_in(8) ? in_.real() : static_cast<float>(in_.byte());
      }
      array.values = how == Spoiled::too_many ? values.first(std::min(needed, kLargest)) : values;
      note((array.values.data() == nullptr && !array.values.empty()) || array.values.size() < needed,
           Status::draw_attributes);
      array.interpolation = enumerator(Interpolation::flat, Status::draw_attribute_interpolation);
    }
    draw.attributes = arrays;
  }

  // An output that shares a byte with any other buffer; initial depth and depth may be the very same.
  void note_overlaps() {
    struct Range {
      std::uintptr_t begin, end;
      bool output;
    };
    std::vector<Range> ranges;
    const auto add = [&ranges](auto span, bool is_output) {
      const auto begin = reinterpret_cast<std::uintptr_t>(span.data());
      if (span.data() != nullptr && !span.empty()) ranges.push_back({begin, begin + span.size_bytes(), is_output});
    };
    add(target_.count, true);
    add(target_.index, true);
    add(target_.depth, true);
    add(target_.barycentrics, true);
    add(target_.winding, true);
    add(target_.sample_locations, false);
    // The lists and the target: an output whose size is far too large reaches them, wherever memory happens to lie.
    add(target_.attributes, false);
    add(draws_, false);
    add(std::span<const Target>(&target_, 1), false);
    for (const AttributeTarget& attribute : attribute_targets_) add(attribute.values, true);
    if (target_.initial_depth.data() != target_.depth.data()) add(target_.initial_depth, false);
    for (const Draw& draw : own_draws_) {
      add(draw.vertices, false);
      add(draw.indices, false);
      add(draw.identifiers, false);
      add(draw.covered, true);
      add(draw.visible, true);
      add(draw.attributes, false);
      for (const AttributeArray& attribute : draw.attributes) add(attribute.values, false);
    }
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      for (std::size_t j = 0; j < ranges.size(); ++j) {
        if (i != j && ranges[i].output && ranges[i].begin < ranges[j].end && ranges[j].begin < ranges[i].end) {
          note(true, Status::target_overlap);
        }
      }
    }
  }

  void note_numbers() {
    for (const Draw& draw : own_draws_) note(any_conservative_ && !draw.visible.empty(), Status::draw_visible);
    for (const Draw& draw : own_draws_) {
      if (draw.indices.data() == nullptr || draw.indices.size() >= kTooMany) continue;
      for (const std::uint32_t index : draw.indices)
        note(index >= draw.vertices.size(), Status::draw_index_out_of_range);
    }
    for (const Draw& draw : own_draws_) {
      if (draw.identifiers.data() == nullptr || draw.identifiers.size() >= kTooMany) continue;
      for (const std::uint32_t identifier : draw.identifiers) note(identifier == kNoTriangle, Status::draw_identifiers);
    }
  }

  ByteReader in_;
  Target target_;
  std::vector<AttributeTarget> attribute_targets_;
  std::vector<Draw> own_draws_;
  std::vector<std::vector<AttributeArray>> attribute_arrays_;
  std::span<const Draw> draws_;
  std::vector<Allocation> allocations_;
  std::vector<Status> wrong_;  // what the arguments at fault are called
  std::vector<SampleLocation> locations_;
  bool with_statistics_ = false, any_conservative_ = false;
};

// The viewport map: one array cut into input and output, which may overlap, differ in size or be null.
void check_to_pixel(ByteReader& in) {
  std::vector<float> numbers(6);
  for (float& number : numbers) number = in.below(4) == 3 ? in.real() : static_cast<float>(in.byte());
  Viewport viewport{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
  const std::uint32_t depth = in.below(8), y = in.below(8);
  viewport.clip_depth = static_cast<ClipDepth>(depth < 6 ? depth % 2 : depth);
  viewport.clip_y = static_cast<ClipY>(y < 6 ? y % 2 : y);
  const bool finite = std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
  const bool viewport_wrong = !finite || depth >= 6 || y >= 6;

  static_assert(sizeof(ClipVertex) == sizeof(Vertex));
  constexpr std::size_t kVertices = 8;
  std::vector<Vertex> memory(kVertices);
  for (Vertex& v : memory) v = {in.real(), in.real(), in.real(), in.real()};
  const std::vector<Vertex> before = memory;
  const std::size_t count = in.below(5), out_count = in.below(8) == 7 ? in.below(5) : count;
  const std::size_t first_out = in.below(5);
  const std::span<const ClipVertex> from(
      in.below(16) == 15 ? nullptr : reinterpret_cast<const ClipVertex*>(memory.data()), count);
  const std::span<Vertex> to(in.below(16) == 15 ? nullptr : memory.data() + first_out, out_count);
  const bool null = (from.data() == nullptr && count != 0) || (to.data() == nullptr && out_count != 0);
  const bool overlap = !null && first_out < count && out_count != 0 && from.data() != nullptr && to.data() != nullptr;
  const bool vertices_wrong = count != out_count || null || overlap;

  const Status status = to_pixel(viewport, from, to);
  if ((status == Status::ok) == (viewport_wrong || vertices_wrong) || (status == Status::viewport && !viewport_wrong) ||
      (status == Status::to_pixel_vertices && !vertices_wrong)) {
    fail(std::string("to_pixel says \"") + status_text(status) + "\"");
  }
  for (std::size_t i = 0; i < kVertices; ++i) {
    const bool written = status == Status::ok && i >= first_out && i < first_out + out_count;
    if (!written && std::memcmp(&memory[i], &before[i], sizeof(Vertex)) != 0) fail("to_pixel wrote where it must not");
  }
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace surefill;
  fuzz::ByteReader in({data, size});
  if (in.below(8) == 7) {
    fuzz::check_to_pixel(in);
  } else if (size > 0) {
    fuzz::Arguments({data + 1, size - 1}).check();
  }
  const std::uint32_t beyond = in.word();  // whatever it is
  for (std::uint32_t status = 0; status < 64; ++status) {
    const char* text = status_text(static_cast<Status>(status == 63 ? beyond : status));
    if (text == nullptr || *text == '\0') fuzz::fail("status_text has no text");
  }
  const int samples = static_cast<int>(in.word());
  const SampleLocation location =
      sample_location(1 << (static_cast<unsigned>(samples) % 5u), static_cast<int>(in.word()) % 16);
  if (location.x < 0 || location.x > 15 || location.y < 0 || location.y > 15) fuzz::fail("a sample outside its pixel");
  return 0;
}
