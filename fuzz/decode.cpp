// SPDX-License-Identifier: Apache-2.0
#include "fuzz/decode.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "corpus/draw_fields.hpp"
#include "corpus/names.hpp"

namespace surefill::fuzz {
namespace {

using corpus::Scene;
using corpus::SceneAttribute;
using corpus::SceneDraw;
using corpus::SceneTriangle;
using corpus::SceneVertex;

class ByteWriter {
 public:
  void byte(std::uint32_t value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }
  void word(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) byte((value >> shift) & 0xFFu);
  }
  void real(float value) { word(std::bit_cast<std::uint32_t>(value)); }
  void append(const Bytes& bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

// An enumerator or number in a bit field; values past the last one mean `rest`.
template <typename Enum>
Enum field(std::uint32_t byte, int shift, std::uint32_t count, Enum rest = Enum{}) {
  const std::uint32_t mask = std::bit_ceil(count) - 1;
  const std::uint32_t value = (byte >> shift) & mask;
  return value < count ? static_cast<Enum>(value) : rest;
}

template <typename Enum>
std::uint32_t bits(Enum value, int shift) {
  return static_cast<std::uint32_t>(value) << shift;
}

// Size and samples of a scene or a triangle.
template <typename Frame>
void set_size(Frame& scene, std::uint32_t size, std::uint32_t log2_samples) {
  const auto side = static_cast<std::uint32_t>(kMaxSide[log2_samples]);
  scene.samples = 1 << log2_samples;
  scene.width = static_cast<int>(1 + (size & 15u) % side);
  scene.height = static_cast<int>(1 + (size >> 4) % side);
}

bool size_fits(const Scene& scene) {
  if (scene.samples < 1 || scene.samples > 16 || !std::has_single_bit(static_cast<unsigned>(scene.samples)))
    return false;
  const int side = kMaxSide[std::countr_zero(static_cast<unsigned>(scene.samples))];
  return scene.width >= 1 && scene.width <= side && scene.height >= 1 && scene.height <= side;
}

std::uint32_t size_byte(const Scene& scene) {
  return static_cast<std::uint32_t>(scene.width - 1) | static_cast<std::uint32_t>(scene.height - 1) << 4;
}

std::uint32_t log2_samples(const Scene& scene) {
  return static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(scene.samples)));
}

// The words of a draw's state: the enumerations and switches, a byte each, modulo the number of their values.
template <typename Value>
void set_choice(ByteReader& in, Value& value) {
  constexpr const auto& names = corpus::names_of<Value>();
  value = names[in.below(static_cast<std::uint32_t>(names.size()))].first;
}

template <typename Value>
std::uint32_t choice_byte(const Value& value) {
  constexpr const auto& names = corpus::names_of<Value>();
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& row) { return row.first == value; });
  return static_cast<std::uint32_t>(found - names.begin()) % static_cast<std::uint32_t>(names.size());
}

std::string attribute_name(std::size_t k) {
  return {'a', static_cast<char>('0' + k)};
}  // k < 10

std::size_t component_total(const Scene& scene) {
  std::size_t total = 0;
  for (const SceneAttribute& attribute : scene.attributes) total += attribute.components;
  return total;
}

// Viewport numbers are finite: an infinity or a NaN loses the top bit of its exponent.
float finite(float value) {
  return std::isfinite(value) ? value : std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & ~0x40000000u);
}

// Scissor edges: small numbers, and the two ends of int.
constexpr int kLargestEdge = 126;
int edge_of(std::uint8_t byte) {
  const int value = static_cast<std::int8_t>(byte);
  if (value > kLargestEdge) return std::numeric_limits<int>::max();
  return value < -kLargestEdge ? std::numeric_limits<int>::min() : value;
}

std::optional<std::uint32_t> edge_byte(int edge) {
  if (edge == std::numeric_limits<int>::max()) return 0x7Fu;
  if (edge == std::numeric_limits<int>::min()) return 0x80u;
  if (edge < -kLargestEdge || edge > kLargestEdge) return std::nullopt;
  return static_cast<std::uint8_t>(edge);
}

// The rule that a draw with a Grid has instead (C5).
FillRule on_grid(FillRule rule) {
  return rule > FillRule::northwards_west ? FillRule::top_left : rule;
}

// The state of one triangle: what a plain draw has.
void set_state(ByteReader& in, OneTriangle& triangle) {
  set_choice(in, triangle.fill_rule), set_choice(in, triangle.front_face);
  set_choice(in, triangle.cull), set_choice(in, triangle.depth_mode);
}

Grid decode_grid(ByteReader& in) {
  Grid grid;
  grid.bits = static_cast<int>(in.below(13));
  const std::uint32_t offsets = in.byte();
  grid.offset_x = static_cast<int>(offsets & 15u);
  grid.offset_y = static_cast<int>(offsets >> 4);
  grid.rounding = static_cast<GridRounding>(in.below(3));
  return grid;
}

void encode_grid(ByteWriter& out, const Grid& grid) {
  out.byte(static_cast<std::uint32_t>(grid.bits));
  out.byte(static_cast<std::uint32_t>(grid.offset_x) | static_cast<std::uint32_t>(grid.offset_y) << 4);
  out.byte(bits(grid.rounding, 0));
}

// The vertices in turn, or none: a box of clip coordinates, or of more than eight vertices, is not that of the draw.
std::optional<std::array<Vertex, 8>> box_of(const SceneDraw& draw) {
  std::array<Vertex, 8> box{};
  if (draw.viewport || draw.vertices.empty() || draw.vertices.size() > box.size()) return std::nullopt;
  for (std::size_t i = 0; i < box.size(); ++i) {
    const SceneVertex& v = draw.vertices[i % draw.vertices.size()];
    box[i] = {v.x, v.y, v.z, v.w};
  }
  return box;
}

// What a draw has, in its first two bytes: these, and from kFirstOptional on the optional fields of its state.
enum DrawFlag : std::uint32_t {
  kHasViewport = 1,
  kClipDepthBelow = 2,  // -1..1
  kClipYDown = 4,
  kHasIdentifiers = 8,
  kHasFirstIndex = 16,
  kFirstOptional = 32,
};

void decode_part(ByteReader& in, Scissor& scissor) {
  for (int* edge : {&scissor.x0, &scissor.y0, &scissor.x1, &scissor.y1}) *edge = edge_of(in.byte());
}
void decode_part(ByteReader& in, Grid& grid) {
  grid = decode_grid(in);
}
void decode_part(ByteReader& in, DepthBias& bias) {
  bias.constant = finite(in.real()), bias.slope = finite(in.real());
}
void decode_part(ByteReader& in, float& width) {
  width = std::fabs(finite(in.real()));
  if (!(width > 0)) width = 1;
}
void decode_part(ByteReader&, std::array<Vertex, 8>&) {}  // it is made of the vertices, at the end

// What a frame has beyond size, samples and depth.
enum FrameFlag : std::uint32_t {
  kTakesEqual = 1,  // LEQUAL or GEQUAL
  kHasOrigin = 2,
  kHasLocations = 4,
  kHasLayers = 8,
  kFirstMore = 16,  // and from here on the rows of kMoreOutputs
};

void decode_modes(ByteReader& in, Scene& scene) {
  const std::uint32_t flags = in.byte();
  if ((flags & kTakesEqual) != 0) {
    scene.depth_test = scene.depth_test == DepthTest::greater ? DepthTest::greater_equal : DepthTest::less_equal;
  }
  if ((flags & kHasOrigin) != 0) {
    for (int* place : {&scene.origin.x, &scene.origin.y}) {
      *place = std::clamp(static_cast<int>(in.word()), -kMaxOrigin, kMaxOrigin);
    }
  }
  for (int n = 0; (flags & kHasLocations) != 0 && n < scene.samples; ++n) {
    const std::uint32_t place = in.byte();
    scene.sample_locations.push_back({static_cast<int>(place & 15u), static_cast<int>(place >> 4)});
  }
  if ((flags & kHasLayers) != 0) scene.layers = 1 + static_cast<int>(in.below(kMaxLayers));
  std::uint32_t flag = kFirstMore;
  for (const auto& [word, member] : corpus::kMoreOutputs) scene.more.*member = (flags & flag) != 0, flag <<= 1;
}

void encode_modes(ByteWriter& out, const Scene& scene) {
  std::uint32_t flags = 0, flag = kFirstMore;
  if (scene.depth_test >= DepthTest::less_equal) flags |= kTakesEqual;
  if (scene.origin != Origin{}) flags |= kHasOrigin;
  if (!scene.sample_locations.empty()) flags |= kHasLocations;
  if (scene.layers > 1) flags |= kHasLayers;
  for (const auto& [word, member] : corpus::kMoreOutputs) flags |= scene.more.*member ? flag : 0u, flag <<= 1;
  out.byte(flags);
  if ((flags & kHasOrigin) != 0) {
    for (const int place : {scene.origin.x, scene.origin.y}) out.word(static_cast<std::uint32_t>(place));
  }
  for (const SampleLocation& l : scene.sample_locations) {
    out.byte(static_cast<std::uint32_t>(l.x) | static_cast<std::uint32_t>(l.y) << 4);
  }
  if (scene.layers > 1) out.byte(static_cast<std::uint32_t>(scene.layers - 1));
}

// Bit of the frame's byte: is the larger depth nearer?
std::uint32_t reversed_bit(DepthTest test) {
  return test == DepthTest::greater || test == DepthTest::greater_equal ? 8u : 0u;
}

// Is there nothing of FrameFlag in it?
bool is_plain(const Scene& scene) {
  return scene.depth_test <= DepthTest::greater && scene.origin == Origin{} && scene.sample_locations.empty() &&
         scene.layers == 1 && scene.more == corpus::MoreOutputs{};
}

SceneDraw decode_draw(ByteReader& in, std::size_t components, const Scene& scene) {
  SceneDraw draw;
  std::uint32_t flags = in.byte();
  flags |= std::uint32_t{in.byte()} << 8;
  corpus::for_each_draw_field([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(draw.*field.member)>;
    if constexpr (!corpus::kIsOptional<Value>) set_choice(in, draw.*field.member);
  });
  if (scene.samples > 1 || scene.layers > 1 || !scene.sample_locations.empty()) {
    draw.conservative = Conservative::none;  // M4, V4, S7
  }
  if (scene.layers > 1) draw.depth_write = true;                                   // V4
  if (draw.conservative != Conservative::none) draw.depth_mode = DepthMode::none;  // M4
  draw.vertices.resize(in.below(kMaxVertices + 1));
  std::uint32_t triangles = in.below(kMaxTriangles + 1);
  if (draw.vertices.empty()) triangles = 0;

  if ((flags & kHasViewport) != 0) {
    Viewport& viewport = draw.viewport.emplace();
    for (float* number :
         {&viewport.x, &viewport.y, &viewport.width, &viewport.height, &viewport.near_depth, &viewport.far_depth}) {
      *number = finite(in.real());
    }
    viewport.clip_depth = (flags & kClipDepthBelow) != 0 ? ClipDepth::minus_one_to_one : ClipDepth::zero_to_one;
    viewport.clip_y = (flags & kClipYDown) != 0 ? ClipY::down : ClipY::up;
  }
  std::uint32_t flag = kFirstOptional;
  corpus::for_each_draw_field([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(draw.*field.member)>;
    if constexpr (corpus::kIsOptional<Value>) {
      if ((flags & flag) != 0) decode_part(in, (draw.*field.member).emplace());
      flag <<= 1;
    }
  });
  if (draw.conservative != Conservative::none) draw.grid.reset();  // M4
  if (draw.primitive != Primitive::triangles) {                    // M7, I8
    draw.grid.reset(), draw.depth_bias.reset();
    draw.fill_rule = on_grid(draw.fill_rule), draw.conservative = Conservative::none;
    if (draw.primitive == Primitive::lines && scene.samples > 1 && !draw.width) draw.width = 1.0f;
  }
  if (draw.grid) draw.fill_rule = on_grid(draw.fill_rule);
  if ((flags & kHasFirstIndex) != 0) draw.first_index = std::min(in.word(), kNoTriangle - triangles);
  for (SceneVertex& vertex : draw.vertices) {
    for (float* number : {&vertex.x, &vertex.y, &vertex.z, &vertex.w}) *number = in.real();
    vertex.attributes.resize(components);
    for (float& value : vertex.attributes) value = in.real();
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    SceneTriangle& triangle = draw.triangles.emplace_back();
    const std::size_t corners = corpus::corners_of(draw.primitive);
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.vertices[i] =
          i < corners ? in.below(static_cast<std::uint32_t>(draw.vertices.size())) : triangle.vertices[i - 1];
    }
    if ((flags & kHasIdentifiers) != 0) triangle.identifier = std::min(in.word(), kNoTriangle - 1);  // B5
  }
  if (draw.culling_box) draw.culling_box = box_of(draw);
  return draw;
}

bool same_box(const std::array<Vertex, 8>& a, const std::array<Vertex, 8>& b) {
  const auto same = [](float p, float q) {
    return std::bit_cast<std::uint32_t>(p) == std::bit_cast<std::uint32_t>(q) || (std::isnan(p) && std::isnan(q));
  };
  return std::equal(a.begin(), a.end(), b.begin(), [&](const Vertex& p, const Vertex& q) {
    return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z) && same(p.w, q.w);
  });
}

bool draw_fits(const SceneDraw& draw) {
  if (draw.vertices.size() > kMaxVertices || draw.triangles.size() > kMaxTriangles) return false;
  if (draw.culling_box) {
    const std::optional<std::array<Vertex, 8>> own = box_of(draw);
    if (!own || !same_box(*own, *draw.culling_box)) return false;
  }
  return true;
}

bool encode_part(ByteWriter& out, const Scissor& scissor) {
  for (const int edge : {scissor.x0, scissor.y0, scissor.x1, scissor.y1}) {
    const std::optional<std::uint32_t> byte = edge_byte(edge);
    if (!byte) return false;
    out.byte(*byte);
  }
  return true;
}
bool encode_part(ByteWriter& out, const Grid& grid) {
  encode_grid(out, grid);
  return true;
}
bool encode_part(ByteWriter& out, const DepthBias& bias) {
  out.real(bias.constant), out.real(bias.slope);
  return true;
}
bool encode_part(ByteWriter& out, float width) {
  out.real(width);
  return true;
}
bool encode_part(ByteWriter&, const std::array<Vertex, 8>&) {
  return true;
}

bool encode_draw(ByteWriter& out, const SceneDraw& draw) {
  if (!draw_fits(draw)) return false;
  const bool identifiers = !draw.triangles.empty() && draw.triangles[0].identifier.has_value();
  std::uint32_t flags = 0, flag = kFirstOptional;
  if (draw.viewport) {
    flags |= kHasViewport;
    if (draw.viewport->clip_depth == ClipDepth::minus_one_to_one) flags |= kClipDepthBelow;
    if (draw.viewport->clip_y == ClipY::down) flags |= kClipYDown;
  }
  if (identifiers) flags |= kHasIdentifiers;
  if (draw.first_index) flags |= kHasFirstIndex;
  ByteWriter choices, parts;
  bool fits = true;
  corpus::for_each_draw_field([&](const auto& field) {
    const auto& value = draw.*field.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (corpus::kIsOptional<Value>) {
      if (value) flags |= flag, fits = encode_part(parts, *value) && fits;
      flag <<= 1;
    } else {
      choices.byte(choice_byte(value));
    }
  });
  if (!fits) return false;
  out.byte(flags & 0xFFu), out.byte(flags >> 8);
  out.append(choices.take());
  out.byte(static_cast<std::uint32_t>(draw.vertices.size()));
  out.byte(static_cast<std::uint32_t>(draw.triangles.size()));
  if (draw.viewport) {
    const Viewport& v = *draw.viewport;
    for (const float number : {v.x, v.y, v.width, v.height, v.near_depth, v.far_depth}) out.real(number);
  }
  out.append(parts.take());
  if (draw.first_index) out.word(*draw.first_index);
  for (const SceneVertex& vertex : draw.vertices) {
    for (const float number : {vertex.x, vertex.y, vertex.z, vertex.w}) out.real(number);
    for (const float value : vertex.attributes) out.real(value);
  }
  for (const SceneTriangle& triangle : draw.triangles) {
    for (std::size_t i = 0; i < corpus::corners_of(draw.primitive); ++i) out.byte(triangle.vertices[i]);
    if (identifiers) out.word(triangle.identifier.value_or(0));
  }
  return true;
}

}  // namespace

std::uint32_t ByteReader::word() {
  std::uint32_t value = 0;
  for (int shift = 0; shift < 32; shift += 8) value |= static_cast<std::uint32_t>(byte()) << shift;
  return value;
}

float ByteReader::real() {
  return std::bit_cast<float>(word());
}

OneTriangle decode_one(std::span<const std::uint8_t> bytes, bool with_grid) {
  ByteReader in(bytes);
  OneTriangle triangle;
  for (Vertex& vertex : triangle.vertices) {
    for (float* number : {&vertex.x, &vertex.y, &vertex.z, &vertex.w}) *number = in.real();
  }
  const std::uint32_t size = in.byte(), frame = in.byte();
  set_size(triangle, size, (frame & 7u) % 5u);
  set_state(in, triangle);
  triangle.depth_test = field<DepthTest>(frame, 3, 2);
  triangle.attribute_location = field<AttributeLocation>(frame, 4, 2);
  const std::uint32_t interpolation = (frame >> 5) & 3u;
  if (interpolation < 3) triangle.interpolation = static_cast<Interpolation>(interpolation);
  for (float& value : triangle.attribute) value = in.real();
  if (with_grid) triangle.grid = decode_grid(in), triangle.fill_rule = on_grid(triangle.fill_rule);
  return triangle;
}

Scene scene_of(const OneTriangle& triangle) {
  Scene scene;
  scene.width = triangle.width;
  scene.height = triangle.height;
  scene.samples = triangle.samples;
  scene.depth_test = triangle.depth_test;
  scene.attribute_location = triangle.attribute_location;
  if (triangle.interpolation) scene.attributes.push_back({attribute_name(0), 1, *triangle.interpolation});
  SceneDraw& draw = scene.draws.emplace_back();
  draw.state() = triangle.state();
  draw.triangles.push_back({{0, 1, 2}, {}});
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = triangle.vertices[i];
    SceneVertex& vertex = draw.vertices.emplace_back(SceneVertex{v.x, v.y, v.z, v.w, {}});
    if (triangle.interpolation) vertex.attributes.push_back(triangle.attribute[i]);
  }
  return scene;
}

Scene decode_triangle(std::span<const std::uint8_t> bytes) {
  return scene_of(decode_one(bytes, false));
}

Scene decode_grid_triangle(std::span<const std::uint8_t> bytes) {
  return scene_of(decode_one(bytes, true));
}

namespace {

std::optional<Bytes> encode_one(const Scene& scene, bool with_grid) {
  if (!size_fits(scene) || scene.draws.size() != 1 || !scene.initial_depth.empty() || !is_plain(scene)) {
    return std::nullopt;
  }
  if (scene.attributes.size() > 1 || component_total(scene) > 1) return std::nullopt;
  const SceneDraw& draw = scene.draws[0];
  if (draw.vertices.size() != 3 || draw.triangles.size() != 1 || draw.primitive != Primitive::triangles || draw.width ||
      draw.triangles[0].vertices != std::array<std::uint32_t, 3>{0, 1, 2} || draw.triangles[0].identifier ||
      draw.viewport || draw.first_index || !draw.depth_write || draw.conservative != Conservative::none ||
      draw.scissor || draw.grid.has_value() != with_grid || draw.culling_box || draw.depth_bias) {
    return std::nullopt;
  }
  ByteWriter out;
  for (const SceneVertex& vertex : draw.vertices) {
    for (const float number : {vertex.x, vertex.y, vertex.z, vertex.w}) out.real(number);
  }
  const std::uint32_t interpolation =
      scene.attributes.empty() ? 3u : static_cast<std::uint32_t>(scene.attributes[0].interpolation);
  out.byte(size_byte(scene));
  out.byte(log2_samples(scene) | bits(scene.depth_test, 3) | bits(scene.attribute_location, 4) | interpolation << 5);
  for (const std::uint32_t choice : {choice_byte(draw.fill_rule), choice_byte(draw.front_face), choice_byte(draw.cull),
                                     choice_byte(draw.depth_mode)}) {
    out.byte(choice);
  }
  for (const SceneVertex& vertex : draw.vertices) out.real(scene.attributes.empty() ? 0.0f : vertex.attributes[0]);
  if (with_grid) encode_grid(out, *draw.grid);
  return out.take();
}

}  // namespace

std::optional<Bytes> encode_triangle(const Scene& scene) {
  return encode_one(scene, false);
}

std::optional<Bytes> encode_grid_triangle(const Scene& scene) {
  return encode_one(scene, true);
}

Scene decode_scene(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  Scene scene;
  const std::uint32_t size = in.byte();
  const std::uint32_t frame =
      in.byte();  // bits 0-2 samples, 3 depth test, 4 location, 5-6 initial depth: none, one, all
  set_size(scene, size, (frame & 7u) % 5u);
  scene.depth_test = field<DepthTest>(frame, 3, 2);
  scene.attribute_location = field<AttributeLocation>(frame, 4, 2);
  const std::size_t total = static_cast<std::size_t>(scene.width * scene.height * scene.samples);
  const std::size_t depths[] = {0, 1, total, 0};
  scene.initial_depth.resize(depths[(frame >> 5) & 3u]);
  const std::uint32_t counts = in.byte();  // bits 0-1 draws - 1, bits 2-4 attributes modulo 5
  scene.attributes.resize(((counts >> 2) & 7u) % (kMaxSceneAttributes + 1));
  for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
    const std::uint32_t form = in.byte();  // bits 0-1 components - 1, bits 2-3 interpolation
    scene.attributes[k] = {attribute_name(k), 1 + (form & 3u), field<Interpolation>(form, 2, 3)};
  }
  decode_modes(in, scene);
  for (float& depth : scene.initial_depth) depth = in.real();
  const std::size_t components = component_total(scene);
  for (std::uint32_t d = 0; d <= (counts & 3u); ++d) scene.draws.push_back(decode_draw(in, components, scene));
  return scene;
}

std::optional<Bytes> encode_scene(const Scene& scene) {
  if (!size_fits(scene) || scene.draws.empty() || scene.draws.size() > kMaxDraws ||
      scene.attributes.size() > kMaxSceneAttributes) {
    return std::nullopt;
  }
  ByteWriter out;
  const std::uint32_t depths = scene.initial_depth.empty() ? 0u : scene.initial_depth.size() == 1 ? 1u : 2u;
  out.byte(size_byte(scene));
  out.byte(log2_samples(scene) | reversed_bit(scene.depth_test) | bits(scene.attribute_location, 4) | depths << 5);
  out.byte(static_cast<std::uint32_t>(scene.draws.size() - 1) | static_cast<std::uint32_t>(scene.attributes.size())
                                                                    << 2);
  for (const SceneAttribute& attribute : scene.attributes) {
    out.byte((attribute.components - 1) | bits(attribute.interpolation, 2));
  }
  encode_modes(out, scene);
  for (const float depth : scene.initial_depth) out.real(depth);
  for (const SceneDraw& draw : scene.draws) {
    if (!encode_draw(out, draw)) return std::nullopt;
  }
  return out.take();
}

Scene decode_samples(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kSamplesMask = 7, kFourSamples = 2;
  Bytes several(bytes.begin(), bytes.end());
  several.resize(std::max<std::size_t>(several.size(), 2));
  if ((several[1] & kSamplesMask) % 5 == 0) {
    several[1] = static_cast<std::uint8_t>((several[1] & ~kSamplesMask) | kFourSamples);
  }
  return decode_scene(several);
}

std::optional<Bytes> encode_samples(const Scene& scene) {
  return scene.samples > 1 ? encode_scene(scene) : std::nullopt;
}

constexpr int kLargeSide = 32;

// Takes out what Path::automatic leaves to the reference path, and layers of large frames, which take long.
void leave_to_fast_path(Scene& scene) {
  const bool grid =
      std::any_of(scene.draws.begin(), scene.draws.end(), [](const SceneDraw& draw) { return draw.grid.has_value(); });
  if (grid) scene.origin = {};
  if (std::max(scene.width, scene.height) > kLargeSide) scene.layers = 1;
}

Scene decode_paths(std::span<const std::uint8_t> bytes) {
  const std::uint32_t sides = bytes.empty() ? 0u : bytes[0];
  Bytes rest(bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), kPathPrefix)), bytes.end());
  Scene scene = decode_scene(rest);
  scene.width = kPathSides[sides & 7u];
  scene.height = kPathSides[sides >> 3 & 7u];
  if (scene.width > kLargeSide && scene.height > kLargeSide) scene.height = kPathSides[0];
  while (scene.width * scene.height * scene.samples > kMostPathSamples) scene.samples /= 2;
  if (!scene.sample_locations.empty()) scene.sample_locations.resize(static_cast<std::size_t>(scene.samples));
  leave_to_fast_path(scene);
  if (scene.initial_depth.size() > 1)
    scene.initial_depth.erase(scene.initial_depth.begin() + 1, scene.initial_depth.end());
  return scene;
}

std::optional<Bytes> encode_paths(const Scene& scene) {
  const auto side_number = [](int side) {
    return static_cast<std::uint32_t>(std::find(std::begin(kPathSides), std::end(kPathSides), side) - kPathSides);
  };
  const std::uint32_t width = side_number(scene.width), height = side_number(scene.height);
  if (scene.width > kLargeSide && scene.height > kLargeSide) return std::nullopt;
  Scene plain = scene;
  leave_to_fast_path(plain);
  if (!corpus::equal(plain, scene)) return std::nullopt;
  if (width > 7 || height > 7 || scene.initial_depth.size() > 1) return std::nullopt;
  if (scene.samples > 16 || scene.width * scene.height * scene.samples > kMostPathSamples) return std::nullopt;
  Scene inner = scene;
  inner.width = inner.height = 1;
  std::optional<Bytes> bytes = encode_scene(inner);
  if (bytes) bytes->insert(bytes->begin(), {static_cast<std::uint8_t>(width | height << 3), 0, 0});
  return bytes;
}

std::vector<Scene> single_triangles(const Scene& scene) {
  std::vector<Scene> singles;
  if (scene.samples < 1 || scene.samples > 16) return singles;
  const int side = kMaxSide[log2_samples(scene)];
  for (const SceneDraw& draw : scene.draws) {
    for (const SceneTriangle& triangle : draw.triangles) {
      Scene& single = singles.emplace_back();
      single.width = std::min(scene.width, side);
      single.height = std::min(scene.height, side);
      single.samples = scene.samples;
      single.depth_test = reversed_bit(scene.depth_test) != 0 ? DepthTest::greater : DepthTest::less;
      single.attribute_location = scene.attribute_location;
      if (!scene.attributes.empty())
        single.attributes.push_back({attribute_name(0), 1, scene.attributes[0].interpolation});
      SceneDraw& own = single.draws.emplace_back();
      own.fill_rule = draw.fill_rule, own.front_face = draw.front_face, own.cull = draw.cull;
      own.depth_mode = draw.depth_mode, own.grid = draw.grid;
      own.triangles.push_back({{0, 1, 2}, {}});
      for (const std::uint32_t v : triangle.vertices) {
        const SceneVertex& from = draw.vertices[v];
        Vertex pixel{from.x, from.y, from.z, from.w};
        const ClipVertex clip{from.x, from.y, from.z, from.w};
        if (draw.viewport && to_pixel(*draw.viewport, {&clip, 1}, {&pixel, 1}) != Status::ok) pixel = {};
        SceneVertex& to = own.vertices.emplace_back(SceneVertex{pixel.x, pixel.y, pixel.z, pixel.w, {}});
        if (!scene.attributes.empty()) to.attributes.push_back(from.attributes[0]);
      }
    }
  }
  return singles;
}

}  // namespace surefill::fuzz
