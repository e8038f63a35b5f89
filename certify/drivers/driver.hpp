// SPDX-License-Identifier: Apache-2.0
//
// What the OpenGL and the Vulkan adapter have in common: their arguments, the vertices of a scene in the order in which
// they are drawn, which scenes a depth buffer can show, the self-check, and the plugin's functions.
#ifndef SUREFILL_CERTIFY_DRIVERS_DRIVER_HPP
#define SUREFILL_CERTIFY_DRIVERS_DRIVER_HPP

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "certify/adapter2.h"

namespace surefill::drivers {

// Not for this adapter, or no such driver here: nothing that could be blamed on a driver. what() is one line.
class NotJudged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The driver refused what its standard has it do.
class DriverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The adapter used the driver's interface wrongly.
class Misuse : public DriverError {
 public:
  using DriverError::DriverError;
};

// Words of the form key=value or key, separated by blanks. A value in quotation marks may hold blanks.
using Arguments = std::map<std::string, std::string>;
Arguments parse_arguments(const std::string& text);
// Throws NotJudged where a key is not among these.
void check_keys(const Arguments& arguments, const std::vector<std::string>& known);
std::string argument(const Arguments& arguments, const std::string& key, const std::string& otherwise = "");

constexpr std::size_t kMaxAttributes = 4;

// What a draw of version 2 of the adapter says beyond version 1, whose structs hold the rest: triangles, lines or points, and
// their width; 0: none.
struct PrimitiveOf {
  std::uint32_t kind = SUREFILL_ADAPTER2_TRIANGLES;
  float width = 0;
  std::uint32_t corners() const { return 3 - kind; }
  float pixels() const { return width > 0 ? width : 1; }
};
using Primitives = std::vector<PrimitiveOf>;  // of each draw; empty: triangles
inline PrimitiveOf primitive_of(const Primitives& primitives, std::uint32_t draw) {
  return primitives.empty() ? PrimitiveOf{} : primitives[draw];
}

// The vertices as the shaders take them: position (4 floats), identifier, corner, kMaxAttributes times 4 floats at
// most.
struct DrawRange {
  const surefill_adapter_draw* draw;
  PrimitiveOf primitive;
  std::uint32_t first, count;  // vertices
  std::array<std::int32_t, kMaxAttributes> interpolation{};
};
struct VertexStream {
  std::vector<std::uint32_t> words;
  std::uint32_t stride = 0;  // words a vertex
  std::vector<DrawRange> batches;
};

// The whole frame from its last triangle to its first, those of a draw by identifier: with the test LESS_OR_EQUAL the
// visible triangle is then V1's and V3's, and a fragment at the depth that the buffer was cleared to is seen.
VertexStream vertex_stream(const surefill_adapter_scene& scene, const Primitives& primitives, bool attributes);

// A depth buffer holds 0 to 1. Without depth clipping and clamping (depth mode any), depths outside come out clamped:
// such scenes have coverage alone. True where no depth can be outside.
bool depths_within_buffer(const surefill_adapter_scene& scene, const Primitives& primitives);

// Does the image ask for more than the count?
bool asks_for_visible(const surefill_adapter_image& image);

// Where the standard sample n of so many is (S4), in 1/16 pixel from the top left.
std::array<int, 2> standard_sample(std::uint32_t samples, std::uint32_t n);

// A driver that can be drawn with. Throws NotJudged and DriverError.
class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;
  virtual surefill_adapter_info info() const = 0;
  // Beside triangles: bits 1 << SUREFILL_ADAPTER2_LINES, ...
  virtual std::uint32_t primitives() const = 0;
  virtual void draw(const surefill_adapter_scene& scene, const Primitives& primitives,
                    const surefill_adapter_image& image) = 0;
};

// Draws scenes whose edges pass every sample at a distance that any driver keeps, in each state that the adapter
// sets, and says what does not come out: the adapter has set something wrong, or something else has. Empty if all is
// well.
std::string self_check(Driver& driver);

// Of each plugin.
std::unique_ptr<Driver> open_driver(const Arguments& arguments);
void set_text(char (&place)[64], const std::string& text);

}  // namespace surefill::drivers

#endif  // SUREFILL_CERTIFY_DRIVERS_DRIVER_HPP
