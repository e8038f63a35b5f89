// SPDX-License-Identifier: Apache-2.0
//
// The second oracle. No edge function appears here: a triangle is clipped to the neighbourhood of the target and
// projected, and samples are located in what is left; depth and attributes are taken where the ray through the sample
// meets the triangle's plane in the space (X, Y, W).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <limits>
#include <optional>
#include <vector>

#include "oracle/clipped_polygon.hpp"
#include "oracle/oracle.hpp"

namespace surefill::oracle::clipped {

namespace {

// S4, in 1/16 pixel.
struct Location {
  int x, y;
};
constexpr Location kCentre{8, 8};
constexpr Location kLocations2[] = {{12, 12}, {4, 4}};
constexpr Location kLocations4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
constexpr Location kLocations8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
constexpr Location kLocations16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                     {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};

std::span<const Location> locations(int samples) {
  switch (samples) {
    case 2:
      return kLocations2;
    case 4:
      return kLocations4;
    case 8:
      return kLocations8;
    case 16:
      return kLocations16;
    default:
      return {&kCentre, 1};
  }
}

Vector sample_point(int x, int y, const Location& location) {
  return {x + Rational(location.x) / 16, y + Rational(location.y) / 16, 1};
}

// The weights of the three vertex values in an attribute: they add up to 1.
using Weights = std::array<Rational, 3>;

Rational combine(const Weights& weights, const std::array<Rational, 3>& values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

// A triangle's plane in (X, Y, W), not through the eye: what the ray through a sample sees there.
//
// The ray t p, p = (px, py, 1), meets the plane of m0, m1, m2 where n . t p = n . m0 for its normal n. There
// t p = m0 + s (m1 - m0) + r (m2 - m0), and with l = (1 - s - r, s, r) also t p = sum l_i m_i. The basis (m_i) gives
// p = sum (E_i / D) m_i, so l_i = t E_i / D, and sum l_i = 1 makes t = D / sum E_i: the weights l of the plane's affine
// combination are I2's E_i / sum E_i, Z / t is I1's depth, and l_i W_i / t is the noperspective W_i E_i / D.
class TrianglePlane {
 public:
  explicit TrianglePlane(const std::array<Vector, 3>& m) : origin_(m[0]), w_{m[0].w, m[1].w, m[2].w} {
    const Vector u = m[1] - m[0];
    const Vector v = m[2] - m[0];
    normal_ = cross(u, v);
    offset_ = dot(normal_, origin_);
    square_ = dot(normal_, normal_);
    s_axis_ = cross(v, normal_);
    r_axis_ = cross(normal_, u);
    depth_scale_ = offset_ * square_;
  }

  // l_i = weights[i] / sum. Kept apart, for sums and products of dyadic numbers are cheap, and of other rationals not.
  struct Hit {
    Weights weights;
    Rational sum;
  };
  // Where the plane is in front of the eye (t > 0); M1's "sum E_i has the sign of D".
  std::optional<Hit> hit(const Vector& p) const {
    const Rational slope = dot(normal_, p);
    if (sgn(slope) * sgn(offset_) <= 0) return std::nullopt;
    // t = offset / slope, and slope (t p - m0) is:
    const Vector d{offset_ * p.x - slope * origin_.x, offset_ * p.y - slope * origin_.y,
                   offset_ * p.w - slope * origin_.w};
    // The axes over `square` are the dual basis of (u, v) in the plane: their products with u, v are 1 and 0.
    const Rational s = dot(s_axis_, d);
    const Rational r = dot(r_axis_, d);
    const Rational sum = slope * square_;
    return Hit{{sum - s - r, s, r}, sum};
  }

  Weights perspective(const Hit& hit) const {
    return {hit.weights[0] / hit.sum, hit.weights[1] / hit.sum, hit.weights[2] / hit.sum};
  }
  Weights noperspective(const Hit& hit) const {
    Weights result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = hit.weights[i] * w_[i] / depth_scale_;
    return result;
  }
  // (sum l_i Z_i) / t, where sum l_i Z_i is the sum of weights[i] Z_i over slope square.
  Rational depth(const Hit& hit, const std::array<Rational, 3>& z) const {
    return combine(hit.weights, z) / depth_scale_;
  }

 private:
  Vector origin_, normal_, s_axis_, r_axis_;
  Rational offset_, square_, depth_scale_;
  std::array<Rational, 3> w_;
};

// The coordinates of p in the basis (m0, m1, m2), E_i / D of the page, for section 6, where a sample may lie outside
// its triangle and even where the plane is not seen. By Gauss-Jordan elimination. No value where D = 0.
class Basis {
 public:
  explicit Basis(const std::array<Vector, 3>& m) {
    std::array<std::array<Rational, 6>, 3> rows;
    for (std::size_t i = 0; i < 3; ++i) {
      rows[0][i] = m[i].x;
      rows[1][i] = m[i].y;
      rows[2][i] = m[i].w;
      rows[i][3 + i] = 1;
    }
    for (std::size_t column = 0; column < 3; ++column) {
      std::size_t pivot = column;
      while (pivot < 3 && sgn(rows[pivot][column]) == 0) ++pivot;
      if (pivot == 3) return;
      std::swap(rows[pivot], rows[column]);
      const Rational scale = rows[column][column];
      for (Rational& value : rows[column]) value /= scale;
      for (std::size_t row = 0; row < 3; ++row) {
        if (row == column) continue;
        const Rational factor = rows[row][column];
        for (std::size_t k = 0; k < 6; ++k) rows[row][k] -= factor * rows[column][k];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) inverse_[i] = {rows[i][3], rows[i][4], rows[i][5]};
    regular_ = true;
  }

  bool regular() const { return regular_; }
  Weights coordinates(const Vector& p) const { return {dot(inverse_[0], p), dot(inverse_[1], p), dot(inverse_[2], p)}; }

 private:
  std::array<Vector, 3> inverse_;
  bool regular_ = false;
};

// A triangle of a draw that may cover samples.
struct Triangle {
  std::uint32_t position = 0;  // in the draw
  std::uint32_t index = 0;     // V2
  std::array<std::uint32_t, 3> vertices{};
  std::array<Rational, 3> z, w;
  std::vector<Point> polygon;  // clipped, projected and, with Grid, snapped
  Outline outline;
  int begin = 0, end = 0;              // pixel lines it may meet
  int orientation = 0;                 // sign of D
  std::optional<TrianglePlane> plane;  // without Grid
  std::optional<Basis> basis;          // with Grid
  Rational low, high;                  // with Grid: of Z/W of the clipped polygon's corners
};

// Both kinds of weights at one place, M1.
struct PlaceWeights {
  Weights perspective, noperspective;
};

// One draw onto the image so far. The work is by lines of pixels: along x where the fill rule's x dominates, else along
// y.
class DrawRun {
 public:
  DrawRun(const Target& target, const Draw& draw, std::vector<float>& depth, std::vector<char>& open)
      : target_(target),
        draw_(draw),
        depth_(depth),
        open_(open),
        locations_(locations(target.samples)),
        shift_(shift_of(draw.fill_rule)),
        along_x_(shift_.x_dominates || draw.conservative != Conservative::none),
        length_(along_x_ ? target.width : target.height) {
    wants_values_ = !target.barycentrics.empty();
    for (const AttributeTarget& attribute : target.attributes) wants_values_ |= !attribute.values.empty();
    wants_visible_ = wants_values_ || !target.index.empty() || !target.depth.empty();
    for (std::size_t i = 0; i < draw.indices.size() / 3; ++i) add_triangle(static_cast<std::uint32_t>(i));
  }

  int lines() const { return along_x_ ? target_.height : target_.width; }
  void render_line(int line);

 private:
  struct Winner {
    const Triangle* triangle = nullptr;
    float depth = 0;
  };
  // The triangle's crossings on one line: one list a sample number, and last the pixel centre's.
  using LineCrossings = std::vector<std::vector<Crossing>>;

  void add_triangle(std::uint32_t position);
  bool is_finite(const std::array<std::uint32_t, 3>& vertices) const;
  void count_conservative(const Triangle& triangle, int line);
  LineCrossings line_crossings(const Triangle& triangle, int line) const;
  std::vector<Crossing> crossings(const Triangle& triangle, int line, const Location& location) const;
  bool in_scissor(int x, int y) const;
  bool drawn(int facing) const;
  Rational real_depth(const Triangle& triangle, const Vector& p) const;
  bool beats_base(std::size_t sample, float depth) const;
  bool beats(const Winner& a, const Winner& b) const;
  std::optional<PlaceWeights> weights_at(const Triangle& triangle, const Vector& p) const;
  PlaceWeights weights(const Triangle& triangle, int x, int y, const LineCrossings& crossings, int along) const;
  void store_values(const Triangle& triangle, const PlaceWeights& weights, std::size_t sample);

  const Target& target_;
  const Draw& draw_;
  std::vector<float>& depth_;  // as the draws before left it, and for a line that is done as this one leaves it
  std::vector<char>& open_;    // empty and without initial depth
  std::span<const Location> locations_;
  Shift shift_;
  bool along_x_;
  int length_;
  bool wants_values_ = false, wants_visible_ = false;
  std::vector<Triangle> triangles_;
};

float attribute_value(const AttributeArray& array, std::uint32_t vertex, std::uint32_t component) {
  const std::size_t stride = array.stride == 0 ? array.components : array.stride;
  return array.values[vertex * stride + component];
}

bool DrawRun::is_finite(const std::array<std::uint32_t, 3>& vertices) const {
  for (const std::uint32_t vertex : vertices) {
    const Vertex& v = draw_.vertices[vertex];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) return false;
    for (const AttributeArray& array : draw_.attributes) {
      for (std::uint32_t c = 0; c < array.components; ++c) {
        if (!std::isfinite(attribute_value(array, vertex, c))) return false;
      }
    }
  }
  return true;
}

void DrawRun::add_triangle(std::uint32_t position) {
  Triangle triangle;
  triangle.position = position;
  triangle.index = draw_.identifiers.empty() ? draw_.first_index + position : draw_.identifiers[position];
  for (std::size_t i = 0; i < 3; ++i) triangle.vertices[i] = draw_.indices[3 * std::size_t{position} + i];
  if (!is_finite(triangle.vertices)) return;
  std::array<Vector, 3> m;
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = draw_.vertices[triangle.vertices[i]];
    m[i] = {exact(v.x), exact(v.y), exact(v.w)};
    triangle.z[i] = exact(v.z);
    triangle.w[i] = m[i].w;
    corners.push_back({m[i].x, m[i].y, triangle.z[i], m[i].w});
  }
  // m0 . (m1 x m2). The facing without Grid: a polygon of the plane seen with W > 0 turns on the screen as the triangle
  // turns in its plane, seen from the eye, because det((x_i, y_i, 1)) is det(m_i) divided by the positive product of W;
  // and a part of the triangle turns as the whole.
  triangle.orientation = sgn(dot(m[0], cross(m[1], m[2])));
  if (draw_.grid) {
    if (contains_eye(m)) return;  // G1
    const Rational g = kMaxTargetSize + 1;
    corners = clip_to_box(std::move(corners), -g, g, -g, g);
  } else {
    if (triangle.orientation == 0) return;  // C1
    // One pixel more than the target on each side: no sample and no pixel square is on the lines of the cut.
    corners = clip_to_box(std::move(corners), -1, target_.width + 1, -1, target_.height + 1);
  }
  if (corners.empty()) return;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    Point point{corner.x / corner.w, corner.y / corner.w};
    if (draw_.grid) {
      const Grid& grid = *draw_.grid;
      point = {snap(point.x, grid.bits, grid.offset_x, grid.rounding),
               snap(point.y, grid.bits, grid.offset_y, grid.rounding)};
      const Rational z = corner.z / corner.w;
      triangle.low = i == 0 ? z : std::min(triangle.low, z);
      triangle.high = i == 0 ? z : std::max(triangle.high, z);
    }
    triangle.polygon.push_back(std::move(point));
  }
  if (draw_.conservative == Conservative::none) {
    triangle.outline = Outline(triangle.polygon, shift_);
    const auto [begin, end] = triangle.outline.lines(lines());
    if (begin == end) return;
    triangle.begin = begin;
    triangle.end = end;
  } else {
    triangle.end = lines();
  }
  if (draw_.grid) {
    triangle.basis.emplace(m);
  } else {
    triangle.plane.emplace(m);
  }
  triangles_.push_back(std::move(triangle));
}

bool DrawRun::in_scissor(int x, int y) const {
  const auto& s = draw_.scissor;
  return !s || (s->x0 <= x && x < s->x1 && s->y0 <= y && y < s->y1);
}

bool DrawRun::drawn(int facing) const {
  const bool front = draw_.front_face == FrontFace::clockwise ? facing > 0 : facing < 0;
  return draw_.cull == Cull::none || (draw_.cull == Cull::back) == front;
}

// M4. What a line's strip of squares has of the convex set T is convex: it meets the squares that its extent in x
// meets. A square lies in T if its upper and its lower side do.
void DrawRun::count_conservative(const Triangle& triangle, int line) {
  if (!drawn(triangle.orientation) || target_.count.empty()) return;
  Rational first, last;  // squares `first` to `last`
  if (draw_.conservative == Conservative::over) {
    const auto strip = x_extent(triangle.polygon, line, line + 1);
    if (!strip) return;
    first = ceil(strip->first) - 1;
    last = floor(strip->second);
  } else {
    const auto upper = x_extent(triangle.polygon, line, line);
    const auto lower = x_extent(triangle.polygon, line + 1, line + 1);
    if (!upper || !lower) return;
    first = ceil(std::max(upper->first, lower->first));
    last = floor(std::min(upper->second, lower->second)) - 1;
  }
  for (int x = 0; x < target_.width; ++x) {
    if (!target_.count.empty() && first <= x && x <= last && in_scissor(x, line)) {
      ++target_.count[static_cast<std::size_t>(line) * static_cast<std::size_t>(target_.width) +
                      static_cast<std::size_t>(x)];
    }
  }
}

std::vector<Crossing> DrawRun::crossings(const Triangle& triangle, int line, const Location& location) const {
  if (draw_.fill_rule == FillRule::closed || draw_.fill_rule == FillRule::open) {
    const bool closed = draw_.fill_rule == FillRule::closed;
    return chord_crossings(triangle.polygon, closed, triangle.orientation, line, location.y, location.x, length_);
  }
  return along_x_ ? triangle.outline.crossings(line, location.y, location.x, length_)
                  : triangle.outline.crossings(line, location.x, location.y, length_);
}

DrawRun::LineCrossings DrawRun::line_crossings(const Triangle& triangle, int line) const {
  LineCrossings result;
  for (const Location& location : locations_) result.push_back(crossings(triangle, line, location));
  result.push_back(crossings(triangle, line, kCentre));
  return result;
}

// I1 without I5; with Grid, G2.
Rational DrawRun::real_depth(const Triangle& triangle, const Vector& p) const {
  if (triangle.plane) {
    const auto hit = triangle.plane->hit(p).value();  // a covered sample sees the plane
    return triangle.plane->depth(hit, triangle.z);
  }
  if (!triangle.basis->regular()) return triangle.low;
  return std::clamp(combine(triangle.basis->coordinates(p), triangle.z), triangle.low, triangle.high);
}

// V1, V3, M5: does a fragment beat what the draws before left?
bool DrawRun::beats_base(std::size_t sample, float depth) const {
  if (open_[sample]) return true;
  return target_.depth_test == DepthTest::less ? depth < depth_[sample] : depth > depth_[sample];
}

// Among the fragments of this draw.
bool DrawRun::beats(const Winner& a, const Winner& b) const {
  if (b.triangle == nullptr) return true;
  const auto order = [](const Triangle& t) { return std::pair(t.index, t.position); };
  if (!draw_.depth_write) return order(*a.triangle) > order(*b.triangle);  // M5
  if (a.depth != b.depth) return target_.depth_test == DepthTest::less ? a.depth < b.depth : a.depth > b.depth;
  return order(*a.triangle) < order(*b.triangle);
}

// Weights at a point, or nothing where M1 says that the centre does not serve: the plane is not seen there, or with
// Grid all E_i count as 0.
std::optional<PlaceWeights> DrawRun::weights_at(const Triangle& triangle, const Vector& p) const {
  if (triangle.plane) {
    const auto hit = triangle.plane->hit(p);
    if (!hit) return std::nullopt;
    return PlaceWeights{triangle.plane->perspective(*hit), triangle.plane->noperspective(*hit)};
  }
  if (!triangle.basis->regular()) return std::nullopt;
  const Weights coordinates = triangle.basis->coordinates(p);
  PlaceWeights result{{1, 0, 0}, {1, 0, 0}};
  Weights counted, scaled;
  for (std::size_t i = 0; i < 3; ++i) {
    counted[i] = sgn(coordinates[i]) > 0 ? coordinates[i] : Rational(0);
    scaled[i] = counted[i] * triangle.w[i];
  }
  const Rational sum = counted[0] + counted[1] + counted[2];
  const Rational scaled_sum = scaled[0] + scaled[1] + scaled[2];
  if (sgn(sum) == 0) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    result.perspective[i] = counted[i] / sum;
    if (sgn(scaled_sum) != 0) result.noperspective[i] = scaled[i] / scaled_sum;
  }
  return result;
}

// M1, for a pixel of which the triangle covers a sample; `along` is its place on the line. With one sample that sample
// is the centre, and M1 says the same as I2 and G2.
PlaceWeights DrawRun::weights(const Triangle& triangle, int x, int y, const LineCrossings& line, int along) const {
  if (target_.attribute_location == AttributeLocation::centre) {
    if (auto at_centre = weights_at(triangle, sample_point(x, y, kCentre))) return *at_centre;
  }
  Location place = kCentre;
  if (winding(line.back(), along) == 0) {
    std::size_t first = 0;
    while (winding(line[first], along) == 0) ++first;
    place = locations_[first];
  }
  const PlaceWeights vertex0{{1, 0, 0}, {1, 0, 0}};  // G2
  return weights_at(triangle, sample_point(x, y, place)).value_or(vertex0);
}

void DrawRun::store_values(const Triangle& triangle, const PlaceWeights& weights, std::size_t sample) {
  if (!target_.barycentrics.empty()) {
    for (std::size_t i = 0; i < 3; ++i) target_.barycentrics[3 * sample + i] = nearest_float(weights.perspective[i]);
  }
  for (std::size_t k = 0; k < target_.attributes.size(); ++k) {
    const AttributeTarget& out = target_.attributes[k];
    if (out.values.empty()) continue;
    const AttributeArray& array = draw_.attributes[k];
    for (std::uint32_t c = 0; c < out.components; ++c) {
      std::array<Rational, 3> u;
      for (std::size_t i = 0; i < 3; ++i) u[i] = exact(attribute_value(array, triangle.vertices[i], c));
      Rational value = u[0];
      if (array.interpolation == Interpolation::perspective) value = combine(weights.perspective, u);
      if (array.interpolation == Interpolation::noperspective) value = combine(weights.noperspective, u);
      out.values[sample * out.components + c] = nearest_float(value);
    }
  }
}

void DrawRun::render_line(int line) {
  const std::size_t samples = locations_.size();
  const auto x_of = [&](int along) { return along_x_ ? along : line; };
  const auto y_of = [&](int along) { return along_x_ ? line : along; };
  const auto sample_of = [&](int along, std::size_t n) {
    const std::size_t pixel = static_cast<std::size_t>(y_of(along)) * static_cast<std::size_t>(target_.width) +
                              static_cast<std::size_t>(x_of(along));
    return pixel * samples + n;
  };
  std::vector<Winner> winners(static_cast<std::size_t>(length_) * samples);
  for (const Triangle& triangle : triangles_) {
    if (line < triangle.begin || line >= triangle.end) continue;
    if (draw_.conservative != Conservative::none) {
      count_conservative(triangle, line);
      continue;
    }
    for (std::size_t n = 0; n < samples; ++n) {
      const std::vector<Crossing> crossed = crossings(triangle, line, locations_[n]);
      int begin = length_, end = 0;  // elsewhere the winding number is 0
      for (const Crossing& crossing : crossed) {
        begin = std::min(begin, crossing.first);
        end = std::max(end, crossing.first);
      }
      for (int along = begin; along < end; ++along) {
        const int facing = winding(crossed, along);
        if (facing == 0 || !drawn(facing) || !in_scissor(x_of(along), y_of(along))) continue;
        const std::size_t sample = sample_of(along, n);
        float depth = 0;
        if (wants_visible_ || draw_.depth_mode == DepthMode::clip) {
          Rational z = real_depth(triangle, sample_point(x_of(along), y_of(along), locations_[n]));
          if (draw_.depth_mode == DepthMode::clip && (z < 0 || z > 1)) continue;  // I5
          if (draw_.depth_mode == DepthMode::clamp) z = std::clamp(z, Rational(0), Rational(1));
          if (wants_visible_) depth = nearest_float(z);
        }
        if (!target_.count.empty()) ++target_.count[sample];
        if (!wants_visible_ || !beats_base(sample, depth)) continue;
        Winner& winner = winners[static_cast<std::size_t>(along) * samples + n];
        const Winner fragment{&triangle, depth};
        if (beats(fragment, winner)) winner = fragment;
      }
    }
  }
  if (!wants_visible_) return;

  // The crossings of the visible triangles, in which M1 looks for covered samples; made when first asked for.
  std::vector<LineCrossings> line_of(wants_values_ ? triangles_.size() : 0);
  for (int along = 0; along < length_; ++along) {
    const Triangle* weighed = nullptr;  // the triangle to which `at` belongs
    PlaceWeights at;
    for (std::size_t n = 0; n < samples; ++n) {
      const Winner& winner = winners[static_cast<std::size_t>(along) * samples + n];
      if (winner.triangle == nullptr) continue;
      const std::size_t sample = sample_of(along, n);
      if (!target_.index.empty()) target_.index[sample] = winner.triangle->index;
      if (draw_.depth_write) {
        depth_[sample] = winner.depth;
        open_[sample] = 0;
      }
      if (wants_values_ && winner.triangle != weighed) {
        LineCrossings& crossed = line_of[static_cast<std::size_t>(winner.triangle - triangles_.data())];
        if (crossed.empty()) crossed = line_crossings(*winner.triangle, line);
        at = weights(*winner.triangle, x_of(along), y_of(along), crossed, along);
        weighed = winner.triangle;
      }
      if (wants_values_) store_values(*winner.triangle, at, sample);
    }
  }
}

}  // namespace

void render(const Target& target, std::span<const Draw> draws, int threads) {
  const std::size_t total = static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height) *
                            static_cast<std::size_t>(target.samples);
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> depth(total, target.depth_test == DepthTest::less ? infinity : -infinity);
  std::vector<char> open(total, target.initial_depth.empty());
  if (!target.initial_depth.empty()) depth.assign(target.initial_depth.begin(), target.initial_depth.end());
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::fill(target.index.begin(), target.index.end(), kNoTriangle);
  std::fill(target.barycentrics.begin(), target.barycentrics.end(), 0.0f);
  for (const AttributeTarget& out : target.attributes) std::fill(out.values.begin(), out.values.end(), 0.0f);

  for (const Draw& draw : draws) {
    DrawRun run(target, draw, depth, open);
    const auto render_every = [&run, threads](int first) {
      for (int line = first; line < run.lines(); line += std::max(threads, 1)) run.render_line(line);
    };
    std::vector<std::future<void>> others;
    for (int first = 1; first < std::min(threads, run.lines()); ++first) {
      others.push_back(std::async(std::launch::async, render_every, first));
    }
    render_every(0);
    for (std::future<void>& other : others) other.get();
  }
  if (!target.depth.empty()) std::copy(depth.begin(), depth.end(), target.depth.begin());
}

}  // namespace surefill::oracle::clipped
