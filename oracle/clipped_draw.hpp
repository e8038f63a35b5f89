// SPDX-License-Identifier: Apache-2.0
//
// One draw of the second oracle onto the image so far.
#ifndef SUREFILL_ORACLE_CLIPPED_DRAW_HPP
#define SUREFILL_ORACLE_CLIPPED_DRAW_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "oracle/clipped_lines.hpp"
#include "oracle/clipped_plane.hpp"
#include "oracle/clipped_polygon.hpp"

namespace surefill::oracle::clipped {

// A place in a pixel, in 1/16 pixel.
struct Location {
  int x, y;
};

// A triangle of a draw that may cover samples, or a line or a point, which has its last vertex in the place of those that
// it lacks. Space is moved by the target's origin (S6), exactly: X - ox W, Y - oy W
// instead of X, Y, so that pixel (0, 0) is the target's first.
struct Triangle {
  std::uint32_t position = 0;  // in the draw
  std::uint32_t index = 0;     // V2
  std::array<std::uint32_t, 3> vertices{};
  std::array<Rational, 3> z, w;
  std::vector<Point> polygon;          // clipped, projected and, with Grid, snapped; of a line or a point Area::region
  Outline outline, hole;               // of the polygon; of Area::hole
  int begin = 0, end = 0;              // pixel lines it may meet
  int orientation = 0;                 // sign of D
  std::optional<TrianglePlane> plane;  // without Grid
  std::optional<SeenLine> line;        // of a line
  std::optional<Basis> basis;          // with Grid
  Rational low, high;                  // with Grid: of Z/W of the clipped polygon's corners
  std::optional<Rational> bias;        // I8: c + s m
};

class DrawRun;

// A fragment that may be seen, and whose it is.
struct Candidate {
  const DrawRun* run = nullptr;
  const Triangle* triangle = nullptr;
  float depth = 0;
};

// The frame as the draws so far left it.
struct Frame {
  Frame(const Target& target, std::span<const Draw> draws);

  const Target& target;
  std::vector<Location> locations;  // S4, S7
  bool conservative = false;        // a draw is: M4c
  bool wants_values = false, wants_visible = false;
  std::size_t total = 0;  // samples
  // With one layer, of each sample:
  std::vector<float> depth;
  std::vector<char> open;          // empty and without initial depth
  std::vector<Candidate> visible;  // if a draw asks for its numbers (M10)
  // With several, all fragments that pass against the initial depth, in the order of draws and in each of V2:
  std::vector<std::vector<Candidate>> candidates;
};

// Does a depth beat the initial one, or that of draws before [V1, V3, V5]? And another one of the same draw?
bool passes(DepthTest test, float depth, float base);
bool is_nearer(DepthTest test, float a, float b);

// Both kinds of weights at one place, M1.
struct PlaceWeights {
  Weights perspective, noperspective;
};

// The work is by lines of pixels: along x where the fill rule's x dominates, else along y.
class DrawRun {
 public:
  DrawRun(Frame& frame, const Draw& draw);

  int lines() const { return along_x_ ? target_.height : target_.width; }
  void render_line(int line);
  const Draw& draw() const { return draw_; }
  // Barycentrics and attributes of a triangle at the pixel (x, y), of which it covers a sample, to `place` of the
  // buffers.
  void store_values(const Triangle& triangle, int x, int y, std::size_t place) const;

 private:
  // The triangle's crossings on one line: one list a sample number, and last the pixel centre's.
  using LineCrossings = std::vector<std::vector<Crossing>>;

  void add_triangle(std::uint32_t position);
  bool find_triangle(const std::array<Vector, 3>& m, Triangle& triangle) const;
  bool find_area(const std::array<Vector, 3>& m, Triangle& triangle) const;
  bool is_finite(const std::array<std::uint32_t, 3>& vertices) const;
  bool project(const std::array<Vector, 3>& m, Triangle& triangle) const;
  void count_conservative(const Triangle& triangle, int line);
  void draw_sample_line(const Triangle& triangle, int line, std::size_t n, std::vector<Candidate>& winners);
  void finish_line(int line, const std::vector<Candidate>& winners);
  void count(const Triangle& triangle, std::size_t sample, int facing);
  void add_covered(const Triangle& triangle, std::uint64_t samples) const;
  LineCrossings line_crossings(const Triangle& triangle, int line) const;
  std::vector<Crossing> crossings(const Triangle& triangle, int line, const Location& location) const;
  int x_of(int line, int along) const { return along_x_ ? along : line; }
  int y_of(int line, int along) const { return along_x_ ? line : along; }
  std::size_t sample_of(int line, int along, std::size_t n) const;
  bool in_scissor(int x, int y) const;
  bool front(int facing) const;
  bool drawn(int facing) const;
  Rational real_depth(const Triangle& triangle, const Vector& p) const;
  Rational bias_of(const Triangle& triangle, const DepthBias& bias) const;
  std::optional<float> stored_depth(const Triangle& triangle, const Vector& p) const;
  bool beats(const Candidate& a, const Candidate& b) const;
  std::optional<PlaceWeights> weights_at(const Triangle& triangle, const Vector& p) const;
  PlaceWeights weights(const Triangle& triangle, int x, int y, const LineCrossings& crossings, int along) const;
  void store_weighted(const Triangle& triangle, const PlaceWeights& weights, std::size_t place) const;

  Frame& frame_;
  const Target& target_;
  const Draw& draw_;
  std::span<const Location> locations_;
  Shift shift_;
  bool along_x_;
  int length_;
  std::vector<Triangle> triangles_;
};

}  // namespace surefill::oracle::clipped

#endif  // SUREFILL_ORACLE_CLIPPED_DRAW_HPP
