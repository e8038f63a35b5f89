// SPDX-License-Identifier: Apache-2.0
//
// A rasterizer between two pipes, here Surefill's own: a test a line comes in, what was drawn goes out.
//
//     surefill vectors --text depth | pipe | surefill verify --text
//
// It knows every word of the text that docs/vectors.md describes. To test another rasterizer, write another `draw_frame`.
#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <iostream>
#include <sstream>
#include <string>
#include <surefill/surefill.hpp>
#include <vector>

namespace {

using namespace surefill;

// The words of a line.
class Words {
 public:
  explicit Words(const std::string& line) : in_(line) {}
  std::uint32_t whole() { return number(std::dec); }
  int signed_whole() {
    int value = 0;
    in_ >> std::dec >> value;
    return value;
  }
  float real() { return std::bit_cast<float>(number(std::hex)); }
  template <typename Enum>
  Enum word() {
    return static_cast<Enum>(whole());
  }
  bool all_read() const { return !in_.fail(); }

 private:
  std::uint32_t number(std::ios_base& (*base)(std::ios_base&)) {
    std::uint32_t value = 0;
    in_ >> base >> value;
    return value;
  }
  std::istringstream in_;
};

struct Arrays {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices, identifiers;
  std::vector<std::vector<float>> values;
  std::vector<AttributeArray> attributes;
};

Draw read_draw(Words& words, Arrays& arrays) {
  Draw draw;
  draw.fill_rule = words.word<FillRule>(), draw.front_face = words.word<FrontFace>(), draw.cull = words.word<Cull>();
  draw.depth_mode = words.word<DepthMode>(), draw.depth_write = words.whole() != 0;
  draw.conservative = words.word<Conservative>();
  if (words.whole() != 0) {
    draw.scissor = Scissor{};
    for (int* side : {&draw.scissor->x0, &draw.scissor->y0, &draw.scissor->x1, &draw.scissor->y1})
      *side = words.signed_whole();
  }
  if (words.whole() != 0) {
    draw.grid = Grid{};
    for (int* part : {&draw.grid->bits, &draw.grid->offset_x, &draw.grid->offset_y}) *part = words.signed_whole();
    draw.grid->rounding = words.word<GridRounding>();
  }
  if (words.whole() != 0) {
    draw.culling_box.emplace();
    for (Vertex& v : *draw.culling_box) v.x = words.real(), v.y = words.real(), v.z = words.real(), v.w = words.real();
  }
  if (words.whole() != 0) {
    draw.depth_bias.emplace();
    draw.depth_bias->constant = words.real(), draw.depth_bias->slope = words.real();
  }
  draw.first_index = words.whole();
  arrays.vertices.resize(words.whole());
  for (Vertex& v : arrays.vertices) v.x = words.real(), v.y = words.real(), v.z = words.real(), v.w = words.real();
  arrays.indices.resize(3 * words.whole());
  for (std::uint32_t& index : arrays.indices) index = words.whole();
  if (words.whole() != 0) arrays.identifiers.resize(arrays.indices.size() / 3);
  for (std::uint32_t& identifier : arrays.identifiers) identifier = words.whole();
  arrays.values.resize(words.whole()), arrays.attributes.resize(arrays.values.size());
  for (std::size_t k = 0; k < arrays.values.size(); ++k) {
    AttributeArray& array = arrays.attributes[k];
    array.components = words.whole(), array.interpolation = words.word<Interpolation>();
    arrays.values[k].resize(array.components * arrays.vertices.size());
    for (float& value : arrays.values[k]) value = words.real();
    array.values = arrays.values[k];
  }
  draw.vertices = arrays.vertices, draw.indices = arrays.indices, draw.identifiers = arrays.identifiers;
  draw.attributes = arrays.attributes;
  return draw;
}

// A frame's buffers, which the next frame of the test is drawn into, too.
struct Buffers {
  std::vector<std::uint32_t> count, index;
  std::vector<std::int32_t> winding;
  std::vector<float> depth, barycentrics;
  std::vector<std::vector<float>> attributes;
};

// The part of a test that all its frames have.
struct Head {
  std::uint32_t id, words, models;
  Target target;
  std::vector<SampleLocation> locations;
  std::array<int, 4> window;
  std::uint32_t outputs, frames;
};

Head read_head(Words& words) {
  Head head{};
  head.id = words.whole(), head.words = words.whole(), head.models = words.whole();
  head.target.width = words.signed_whole(), head.target.height = words.signed_whole();
  head.target.samples = words.signed_whole(), head.target.depth_test = words.word<DepthTest>();
  head.target.attribute_location = words.word<AttributeLocation>();
  head.target.origin.x = words.signed_whole(), head.target.origin.y = words.signed_whole();
  head.locations.resize(words.whole());
  for (SampleLocation& at : head.locations) at.x = words.signed_whole(), at.y = words.signed_whole();
  head.target.layers = words.signed_whole();
  for (int& side : head.window) side = words.signed_whole();
  head.outputs = words.whole(), head.frames = words.whole();
  return head;
}

// Prints a plane of the window: runs of 1. Of a buffer with layers, layer by layer.
template <typename Values>
void print(const Head& head, const Values& values, int layers, std::size_t elements = 1, std::size_t element = 0) {
  const auto [x0, y0, x1, y1] = head.window;
  const Target& t = head.target;
  std::cout << ' ' << layers * (x1 - x0) * (y1 - y0) * t.samples;
  for (int layer = 0; layer < layers; ++layer) {
    for (int y = layer * t.height + y0; y < layer * t.height + y1; ++y) {
      for (int s = (y * t.width + x0) * t.samples; s < (y * t.width + x1) * t.samples; ++s) {
        const auto value = values[static_cast<std::size_t>(s) * elements + element];
        if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
          std::cout << " 1 " << std::hex << std::bit_cast<std::uint32_t>(value) << std::dec;
        } else {
          std::cout << " 1 " << value;
        }
      }
    }
  }
}

bool draw_frame(const Head& head, Words& words, Buffers& buffers) {
  Target target = head.target;
  target.sample_locations = head.locations;
  const std::size_t total = sample_total(target);
  std::vector<float> initial;
  const std::uint32_t kind = words.whole();
  if (kind == 1) {
    for (std::uint32_t runs = words.whole(); runs > 0; --runs) {
      const std::uint32_t run = words.whole();
      initial.insert(initial.end(), run, words.real());
    }
  } else if (kind == 2) {
    initial = buffers.depth;
  }
  std::deque<Arrays> arrays;
  std::vector<Draw> draws;
  for (std::uint32_t n = words.whole(); n > 0 && words.all_read(); --n) {
    draws.push_back(read_draw(words, arrays.emplace_back()));
    // What is owed by a grid alone is drawn with one.
    if ((head.models & 1) == 0) draws.back().grid = Grid{.bits = (head.models & 2) != 0 ? 4 : 8};
  }
  if (!words.all_read()) return false;
  const auto buffer = [&](std::uint32_t output, auto& own, auto& asked, std::size_t elements) {
    if ((head.outputs & output) == 0) return;
    own.resize(elements * total), asked = own;
  };
  const auto layers = static_cast<std::size_t>(target.layers);
  buffer(1, buffers.count, target.count, 1), buffer(2, buffers.index, target.index, layers);
  buffer(4, buffers.depth, target.depth, layers), buffer(8, buffers.barycentrics, target.barycentrics, 3 * layers);
  buffer(32, buffers.winding, target.winding, 1);
  std::vector<AttributeTarget> attributes;
  if ((head.outputs & 16) != 0 && !arrays.empty()) {
    attributes.resize(arrays[0].attributes.size()), buffers.attributes.resize(attributes.size());
    for (std::size_t k = 0; k < attributes.size(); ++k) {
      attributes[k].components = arrays[0].attributes[k].components;
      buffer(16, buffers.attributes[k], attributes[k].values, layers * attributes[k].components);
    }
    target.attributes = attributes;
  }
  target.initial_depth = initial;
  if (const Status status = render(target, draws); status != Status::ok) {
    std::cerr << "test " << head.id << ": " << status_text(status) << '\n';
    return false;
  }
  const int k = target.layers;
  if ((head.outputs & 1) != 0) print(head, buffers.count, 1);
  if ((head.outputs & 2) != 0) print(head, buffers.index, k);
  if ((head.outputs & 4) != 0) print(head, buffers.depth, k);
  for (std::size_t i = 0; (head.outputs & 8) != 0 && i < 3; ++i) print(head, buffers.barycentrics, k, 3, i);
  for (std::size_t a = 0; a < attributes.size(); ++a)
    for (std::size_t c = 0; c < attributes[a].components; ++c)
      print(head, buffers.attributes[a], k, attributes[a].components, c);
  if ((head.outputs & 32) != 0) print(head, buffers.winding, 1);
  return true;
}

}  // namespace

int main() {
  bool right = true;
  for (std::string line; std::getline(std::cin, line);) {
    Words words(line);
    const Head head = read_head(words);
    std::cout << head.id;
    Buffers buffers;
    for (std::uint32_t f = 0; f < head.frames; ++f) right = draw_frame(head, words, buffers) && right;
    std::cout << '\n';
  }
  return right ? 0 : 1;
}
