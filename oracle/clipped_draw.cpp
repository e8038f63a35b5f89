// SPDX-License-Identifier: Apache-2.0
#include "oracle/clipped_draw.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>

namespace surefill::oracle::clipped {

namespace {

constexpr Location kCentre{8, 8};

Vector sample_point(int x, int y, const Location& location) {
  return {x + Rational(location.x) / 16, y + Rational(location.y) / 16, 1};
}

std::size_t corners_of(Primitive primitive) {
  return primitive == Primitive::points ? 1 : primitive == Primitive::lines ? 2 : 3;
}

float attribute_value(const AttributeArray& array, std::uint32_t vertex, std::uint32_t component) {
  const std::size_t stride = array.stride == 0 ? array.components : array.stride;
  return array.values[vertex * stride + component];
}

}  // namespace

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

DrawRun::DrawRun(Frame& frame, const Draw& draw)
    : frame_(frame),
      target_(frame.target),
      draw_(draw),
      locations_(frame.locations),
      shift_(shift_of(draw.fill_rule)),
      along_x_(shift_.x_dominates || draw.conservative != Conservative::none),
      length_(along_x_ ? target_.width : target_.height) {
  const std::size_t primitives = draw.indices.size() / corners_of(draw.primitive);
  for (std::size_t i = 0; i < primitives; ++i) add_triangle(static_cast<std::uint32_t>(i));
  if (draw.identifiers.empty()) return;
  std::stable_sort(triangles_.begin(), triangles_.end(),
                   [](const Triangle& a, const Triangle& b) { return a.index < b.index; });
}

void DrawRun::add_triangle(std::uint32_t position) {
  Triangle triangle;
  triangle.position = position;
  triangle.index = draw_.identifiers.empty() ? draw_.first_index + position : draw_.identifiers[position];
  const std::size_t corners = corners_of(draw_.primitive);
  const std::span<const std::uint32_t> indices = draw_.indices.subspan(corners * position, corners);
  for (std::size_t i = 0; i < 3; ++i) triangle.vertices[i] = i < corners ? indices[i] : indices.back();
  if (!is_finite(triangle.vertices)) return;
  std::array<Vector, 3> m;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = draw_.vertices[triangle.vertices[i]];
    m[i] = {exact(v.x), exact(v.y), exact(v.w)};
    m[i].x -= target_.origin.x * m[i].w;
    m[i].y -= target_.origin.y * m[i].w;
    triangle.z[i] = exact(v.z);
    triangle.w[i] = m[i].w;
  }
  if (draw_.primitive == Primitive::triangles ? find_triangle(m, triangle) : find_area(m, triangle)) {
    triangles_.push_back(std::move(triangle));
  }
}

// Finds what a triangle may cover, and its plane. False if it covers nothing.
bool DrawRun::find_triangle(const std::array<Vector, 3>& m, Triangle& triangle) const {
  // m0 . (m1 x m2). The facing without Grid: a polygon of the plane seen with W > 0 turns on the screen as the triangle
  // turns in its plane, seen from the eye, because det((x_i, y_i, 1)) is det(m_i) divided by the positive product of W;
  // and a part of the triangle turns as the whole.
  triangle.orientation = sgn(dot(m[0], cross(m[1], m[2])));
  if (draw_.grid) {
    if (contains_eye(m)) return false;  // G1
  } else {
    if (triangle.orientation == 0 && draw_.conservative != Conservative::touched) return false;  // C1, M4b
  }
  if (!project(m, triangle)) return false;
  if (draw_.conservative == Conservative::none) {
    triangle.outline = Outline(triangle.polygon, shift_);
    const auto [begin, end] = triangle.outline.lines(lines());
    if (begin == end) return false;
    triangle.begin = begin;
    triangle.end = end;
    if (draw_.grid) {
      triangle.basis.emplace(m);
    } else {
      triangle.plane.emplace(m);
    }
    if (draw_.depth_bias) triangle.bias = bias_of(triangle, *draw_.depth_bias);
  } else {
    triangle.end = lines();
  }
  return true;
}

// The same of a line or a point.
bool DrawRun::find_area(const std::array<Vector, 3>& m, Triangle& triangle) const {
  std::optional<Rational> size;
  if (draw_.width) size = exact(*draw_.width);
  Area area;
  if (draw_.primitive == Primitive::points) {
    area = point_area(m[0], size.value_or(1), target_.width, target_.height);
  } else {
    triangle.line = SeenLine::make(m[0], m[1]);
    if (!triangle.line) return false;
    area = triangle.line->area(size, target_.width, target_.height);
  }
  triangle.polygon = std::move(area.region);
  triangle.outline = Outline(triangle.polygon, shift_);
  triangle.hole = Outline(area.hole, shift_);
  std::tie(triangle.begin, triangle.end) = triangle.outline.lines(lines());
  return triangle.begin < triangle.end;
}

// Finds the polygon, with Grid also the range of its depth. False if nothing is left.
bool DrawRun::project(const std::array<Vector, 3>& m, Triangle& triangle) const {
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < 3; ++i) corners.push_back({m[i].x, m[i].y, triangle.z[i], m[i].w});
  if (draw_.grid) {
    const Rational g = kMaxTargetSize + 1;
    corners = clip_to_box(std::move(corners), -g, g, -g, g);
  } else {
    // One pixel more than the target on each side: no sample and no pixel square is on the lines of the cut.
    corners = clip_to_box(std::move(corners), -1, target_.width + 1, -1, target_.height + 1);
    // A triangle that contains the eye (D = 0, M4b) may have kept it. What is seen is the hull of the other corners.
    std::erase_if(corners, [](const Corner& corner) { return sgn(corner.w) == 0; });
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    Point point{corner.x / corner.w, corner.y / corner.w};
    if (draw_.grid) {
      const Grid& grid = *draw_.grid;  // of space
      point = {snap(point.x + target_.origin.x, grid.bits, grid.offset_x, grid.rounding) - target_.origin.x,
               snap(point.y + target_.origin.y, grid.bits, grid.offset_y, grid.rounding) - target_.origin.y};
      const Rational z = corner.z / corner.w;
      triangle.low = i == 0 ? z : std::min(triangle.low, z);
      triangle.high = i == 0 ? z : std::max(triangle.high, z);
    }
    triangle.polygon.push_back(std::move(point));
  }
  return !triangle.polygon.empty();
}

std::size_t DrawRun::sample_of(int line, int along, std::size_t n) const {
  const std::size_t pixel = static_cast<std::size_t>(y_of(line, along)) * static_cast<std::size_t>(target_.width) +
                            static_cast<std::size_t>(x_of(line, along));
  return pixel * locations_.size() + n;
}

bool DrawRun::in_scissor(int x, int y) const {
  const auto& s = draw_.scissor;
  if (!s) return true;
  const int space_x = x + target_.origin.x, space_y = y + target_.origin.y;
  return s->x0 <= space_x && space_x < s->x1 && s->y0 <= space_y && space_y < s->y1;
}

bool DrawRun::front(int facing) const {
  return draw_.front_face == FrontFace::clockwise ? facing > 0 : facing < 0;
}

bool DrawRun::drawn(int facing) const {
  if (draw_.primitive != Primitive::triangles) return true;
  return draw_.cull == Cull::none || (draw_.cull == Cull::back) == front(facing);
}

// M2, M9, M4c
void DrawRun::count(const Triangle& triangle, std::size_t sample, int facing) {
  if (!target_.count.empty()) ++target_.count[sample];
  if (!target_.winding.empty() && draw_.primitive == Primitive::triangles) {  // modulo 2^32
    const std::int64_t sum = std::int64_t{target_.winding[sample]} + (front(facing) ? 1 : -1);
    target_.winding[sample] = static_cast<std::int32_t>(static_cast<std::uint64_t>(sum) & 0xFFFFFFFFu);
  }
  if (frame_.conservative && !target_.index.empty() && triangle.index < target_.index[sample]) {
    target_.index[sample] = triangle.index;
  }
}

// M10. Lines of a triangle may be drawn at the same time.
void DrawRun::add_covered(const Triangle& triangle, std::uint64_t samples) const {
  if (draw_.covered.empty() || samples == 0) return;
  std::atomic_ref(draw_.covered[triangle.position]) += samples;
}

// M4, M4a, M4b. What a line's strip of squares has of the convex set T is convex: it meets the squares that its extent
// in x meets, and shares an area with those whose inside the inside of the extent meets, if it has an area itself. A
// square lies in T if its upper and its lower side do.
void DrawRun::count_conservative(const Triangle& triangle, int line) {
  if (!drawn(triangle.orientation)) return;
  Rational first, last;  // squares `first` to `last`
  if (draw_.conservative == Conservative::inner) {
    const auto upper = x_extent(triangle.polygon, line, line);
    const auto lower = x_extent(triangle.polygon, line + 1, line + 1);
    if (!upper || !lower) return;
    first = ceil(std::max(upper->first, lower->first));
    last = floor(std::min(upper->second, lower->second)) - 1;
  } else {
    const auto strip = x_extent(triangle.polygon, line, line + 1);
    if (!strip) return;
    if (draw_.conservative == Conservative::overlap) {
      // T has an area (D != 0); the strip's part has none if it only touches the strip.
      const auto is_above = [line](const Point& p) { return p.y <= line; };
      const auto is_below = [line](const Point& p) { return p.y >= line + 1; };
      if (std::all_of(triangle.polygon.begin(), triangle.polygon.end(), is_above)) return;
      if (std::all_of(triangle.polygon.begin(), triangle.polygon.end(), is_below)) return;
      first = floor(strip->first);
      last = ceil(strip->second) - 1;
    } else {
      first = ceil(strip->first) - 1;
      last = floor(strip->second);
    }
  }
  std::uint64_t covered = 0;
  for (int x = 0; x < target_.width; ++x) {
    if (x < first || x > last || !in_scissor(x, line)) continue;
    count(triangle, sample_of(line, x, 0), triangle.orientation);
    ++covered;
  }
  add_covered(triangle, covered);
}

std::vector<Crossing> DrawRun::crossings(const Triangle& triangle, int line, const Location& location) const {
  if (draw_.fill_rule == FillRule::closed || draw_.fill_rule == FillRule::open) {
    const bool closed = draw_.fill_rule == FillRule::closed;
    return chord_crossings(triangle.polygon, closed, triangle.orientation, line, location.y, location.x, length_);
  }
  const int across = along_x_ ? location.y : location.x, along = along_x_ ? location.x : location.y;
  std::vector<Crossing> result = triangle.outline.crossings(line, across, along, length_);
  for (const Crossing& crossing : triangle.hole.crossings(line, across, along, length_)) {
    result.push_back({crossing.first, -crossing.step});
  }
  return result;
}

DrawRun::LineCrossings DrawRun::line_crossings(const Triangle& triangle, int line) const {
  LineCrossings result;
  for (const Location& location : locations_) result.push_back(crossings(triangle, line, location));
  result.push_back(crossings(triangle, line, kCentre));
  return result;
}

// I1, I6, I7 without I5; with Grid, G2.
Rational DrawRun::real_depth(const Triangle& triangle, const Vector& p) const {
  if (draw_.primitive == Primitive::points) return triangle.z[0] / triangle.w[0];
  if (triangle.line) return triangle.line->depth(triangle.line->place(p), triangle.z);
  if (triangle.plane) {
    const auto hit = triangle.plane->hit(p).value();  // a covered sample sees the plane
    return triangle.plane->depth(hit, triangle.z);
  }
  if (!triangle.basis->regular()) return triangle.low;
  return std::clamp(combine(triangle.basis->coordinates(p), triangle.z), triangle.low, triangle.high);
}

// I8. I1 is affine: its slopes are what it gains over one pixel.
Rational DrawRun::bias_of(const Triangle& triangle, const DepthBias& bias) const {
  const auto plane = [&triangle](const Vector& p) -> Rational {
    return triangle.plane ? triangle.plane->depth_anywhere(p, triangle.z)
                          : combine(triangle.basis->coordinates(p), triangle.z);
  };
  Rational steepest = 0;
  if (triangle.orientation != 0) {
    const Rational here = plane({0, 0, 1});
    const Rational along_x = abs(plane({1, 0, 1}) - here), along_y = abs(plane({0, 1, 1}) - here);
    steepest = std::max(along_x, along_y);
  }
  return exact(bias.constant) + exact(bias.slope) * steepest;
}

// I5, I8, I4; nothing where the fragment is clipped.
std::optional<float> DrawRun::stored_depth(const Triangle& triangle, const Vector& p) const {
  Rational z = real_depth(triangle, p);
  if (draw_.depth_mode == DepthMode::clip && (z < 0 || z > 1)) return std::nullopt;
  if (!frame_.wants_visible) return 0.0f;  // nobody looks at it
  if (triangle.bias) z += *triangle.bias;
  if (draw_.depth_mode == DepthMode::clamp) z = std::clamp(z, Rational(0), Rational(1));
  return nearest_float(z);
}

bool passes(DepthTest test, float depth, float base) {
  switch (test) {
    case DepthTest::less:
      return depth < base;
    case DepthTest::greater:
      return depth > base;
    case DepthTest::less_equal:
      return depth <= base;
    case DepthTest::greater_equal:
      return depth >= base;
  }
  return false;
}

bool is_nearer(DepthTest test, float a, float b) {
  return test == DepthTest::less || test == DepthTest::less_equal ? a < b : a > b;
}

// Among the fragments of this draw, of which `triangles_` has the order (V2): the first of equal ones, or the last
// (V5, M5).
bool DrawRun::beats(const Candidate& a, const Candidate& b) const {
  if (b.triangle == nullptr) return true;
  if (draw_.depth_write && a.depth != b.depth) return is_nearer(target_.depth_test, a.depth, b.depth);
  const bool last_wins = !draw_.depth_write || target_.depth_test == DepthTest::less_equal ||
                         target_.depth_test == DepthTest::greater_equal;
  return last_wins ? a.triangle > b.triangle : a.triangle < b.triangle;
}

// Weights at a point, or nothing where M1 says that the centre does not serve: the plane is not seen there, or with
// Grid all E_i count as 0.
std::optional<PlaceWeights> DrawRun::weights_at(const Triangle& triangle, const Vector& p) const {
  if (triangle.line) {  // M1: it serves anywhere
    const SeenLine::Place place = triangle.line->place(p);
    return PlaceWeights{triangle.line->perspective(place), triangle.line->noperspective(place)};
  }
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

// M1, for a pixel of which the triangle covers a sample; `along` is its place on the line. With one sample it is the
// place (S7), and M1 says the same as I2 and G2.
PlaceWeights DrawRun::weights(const Triangle& triangle, int x, int y, const LineCrossings& line, int along) const {
  const PlaceWeights vertex0{{1, 0, 0}, {1, 0, 0}};  // G2, I6
  if (draw_.primitive == Primitive::points) return vertex0;
  if (locations_.size() == 1) return weights_at(triangle, sample_point(x, y, locations_[0])).value_or(vertex0);
  if (target_.attribute_location == AttributeLocation::centre) {
    if (auto at_centre = weights_at(triangle, sample_point(x, y, kCentre))) return *at_centre;
  }
  Location place = kCentre;
  if (winding(line.back(), along) == 0) {
    std::size_t first = 0;
    while (winding(line[first], along) == 0) ++first;
    place = locations_[first];
  }
  return weights_at(triangle, sample_point(x, y, place)).value_or(vertex0);
}

void DrawRun::store_weighted(const Triangle& triangle, const PlaceWeights& weights, std::size_t place) const {
  if (!target_.barycentrics.empty()) {
    for (std::size_t i = 0; i < 3; ++i) target_.barycentrics[3 * place + i] = nearest_float(weights.perspective[i]);
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
      out.values[place * (out.stride != 0 ? out.stride : out.components) + c] = nearest_float(value);
    }
  }
}

void DrawRun::store_values(const Triangle& triangle, int x, int y, std::size_t place) const {
  const int line = along_x_ ? y : x, along = along_x_ ? x : y;
  store_weighted(triangle, weights(triangle, x, y, line_crossings(triangle, line), along), place);
}

void DrawRun::render_line(int line) {
  std::vector<Candidate> winners(static_cast<std::size_t>(length_) * locations_.size());
  for (const Triangle& triangle : triangles_) {
    if (line < triangle.begin || line >= triangle.end) continue;
    if (draw_.conservative != Conservative::none) {
      count_conservative(triangle, line);
      continue;
    }
    for (std::size_t n = 0; n < locations_.size(); ++n) draw_sample_line(triangle, line, n, winners);
  }
  if (frame_.wants_visible && target_.layers == 1) finish_line(line, winners);
}

// Sample n of each pixel.
void DrawRun::draw_sample_line(const Triangle& triangle, int line, std::size_t n, std::vector<Candidate>& winners) {
  const std::vector<Crossing> crossed = crossings(triangle, line, locations_[n]);
  int begin = length_, end = 0;  // elsewhere the winding number is 0
  for (const Crossing& crossing : crossed) {
    begin = std::min(begin, crossing.first);
    end = std::max(end, crossing.first);
  }
  std::uint64_t covered = 0;
  for (int along = begin; along < end; ++along) {
    const int facing = winding(crossed, along);
    const int x = x_of(line, along), y = y_of(line, along);
    if (facing == 0 || !drawn(facing) || !in_scissor(x, y)) continue;
    Candidate fragment{this, &triangle, 0};
    if (frame_.wants_visible || draw_.depth_mode == DepthMode::clip) {
      const auto depth = stored_depth(triangle, sample_point(x, y, locations_[n]));
      if (!depth) continue;
      fragment.depth = *depth;
    }
    const std::size_t sample = sample_of(line, along, n);
    count(triangle, sample, facing);
    ++covered;
    if (!frame_.wants_visible) continue;
    if (!frame_.open[sample] && !passes(target_.depth_test, fragment.depth, frame_.depth[sample])) continue;
    if (target_.layers > 1) {
      frame_.candidates[sample].push_back(fragment);
      continue;
    }
    Candidate& winner = winners[static_cast<std::size_t>(along) * locations_.size() + n];
    if (beats(fragment, winner)) winner = fragment;
  }
  add_covered(triangle, covered);
}

// Stores what this draw leaves on a line.
void DrawRun::finish_line(int line, const std::vector<Candidate>& winners) {
  // The crossings of the visible triangles, in which M1 looks for covered samples; made when first asked for.
  std::vector<LineCrossings> line_of(frame_.wants_values ? triangles_.size() : 0);
  for (int along = 0; along < length_; ++along) {
    const Triangle* weighed = nullptr;  // the triangle to which `at` belongs
    PlaceWeights at;
    for (std::size_t n = 0; n < locations_.size(); ++n) {
      const Candidate& winner = winners[static_cast<std::size_t>(along) * locations_.size() + n];
      if (winner.triangle == nullptr) continue;
      const std::size_t sample = sample_of(line, along, n);
      if (!target_.index.empty()) target_.index[sample] = winner.triangle->index;
      if (!frame_.visible.empty()) frame_.visible[sample] = winner;
      if (draw_.depth_write) {
        frame_.depth[sample] = winner.depth;
        frame_.open[sample] = 0;
      }
      if (frame_.wants_values && winner.triangle != weighed) {
        LineCrossings& crossed = line_of[static_cast<std::size_t>(winner.triangle - triangles_.data())];
        if (crossed.empty()) crossed = line_crossings(*winner.triangle, line);
        at = weights(*winner.triangle, x_of(line, along), y_of(line, along), crossed, along);
        weighed = winner.triangle;
      }
      if (frame_.wants_values) store_weighted(*winner.triangle, at, sample);
    }
  }
}

}  // namespace surefill::oracle::clipped
