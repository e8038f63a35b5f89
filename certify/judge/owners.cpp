// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/owners.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/probes.hpp"

namespace surefill::judge {

namespace {

using oracle::AxisModel;
using oracle::Owners;
using oracle::Rounding;
using oracle::Side;

// A triangle on a lattice around a sample, in the middle of 8 x 8 pixels: points are whole pixels from the sample.
using Lattice = std::array<std::array<int, 2>, 3>;

// What comes to lie at this position of a target of `length` pixels, in the middle of what is snapped there.
float source_of(double position, const AxisModel& axis, int length) {
  double q = position - axis.moved;
  if (axis.bits >= 0 && axis.rounding == Rounding::ceiling) q -= std::ldexp(0.5, -axis.bits);
  if (axis.bits >= 0 && (axis.rounding == Rounding::floor || axis.rounding == Rounding::truncate)) {
    q += std::ldexp(0.5, -axis.bits);
  }
  return static_cast<float>(q * length / (length - axis.lacks));
}

constexpr int kLatticeSize = 8;

// Where what is so far from the sample in the middle comes to lie.
double placed_at(const Rival& rival, const AxisModel& axis, double from_sample) {
  const float source = on_step(source_of(3 + axis.place + from_sample, axis, kLatticeSize), rival.position_step());
  return placed(source, axis, kLatticeSize);
}

// The triangle around the sample in the middle.
corpus::Image draw_around(Rival& rival, const Model& model, const std::array<std::array<double, 2>, 3>& from_sample) {
  std::array<Point, 3> triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    triangle[i] = {source_of(3 + model.x.place + from_sample[i][0], model.x, kLatticeSize),
                   source_of(3 + model.y.place + from_sample[i][1], model.y, kLatticeSize)};
    triangle[i] = {on_step(triangle[i].x, rival.position_step()), on_step(triangle[i].y, rival.position_step())};
  }
  return rival.draw(flat_scene(kLatticeSize, kLatticeSize, {triangle}), covering(rival));
}

bool covers_middle(Rival& rival, const Model& model, const std::array<std::array<double, 2>, 3>& from_sample) {
  return is_covered(draw_around(rival, model, from_sample), 3 * kLatticeSize + 3);
}

bool covers_any(Rival& rival, const Model& model, const std::array<std::array<double, 2>, 3>& from_sample) {
  const corpus::Image image = draw_around(rival, model, from_sample);
  for (std::size_t s = 0; s < kLatticeSize * kLatticeSize; ++s) {
    if (is_covered(image, s)) return true;
  }
  return false;
}

bool lattice_covers(Rival& rival, const Model& model, const Lattice& lattice) {
  std::array<std::array<double, 2>, 3> points{};
  for (std::size_t i = 0; i < 3; ++i) {
    points[i] = {static_cast<double>(lattice[i][0]), static_cast<double>(lattice[i][1])};
  }
  return covers_middle(rival, model, points);
}

int cross(const std::array<int, 2>& p, const std::array<int, 2>& q) {
  return p[0] * q[1] - p[1] * q[0];
}

// The side on which the edge from p to q is of a triangle whose third vertex is r.
Side lattice_side(const std::array<int, 2>& p, const std::array<int, 2>& q, const std::array<int, 2>& r) {
  int x = p[1] - q[1], y = q[0] - p[0];
  if (x * (r[0] - p[0]) + y * (r[1] - p[1]) < 0) x = -x, y = -y;
  if (y == 0) return x > 0 ? Side::left : Side::right;
  if (x == 0) return y > 0 ? Side::top : Side::bottom;
  if (y > 0) return x > 0 ? Side::top_left : Side::top_right;
  return x > 0 ? Side::bottom_left : Side::bottom_right;
}

// Is the sample at a vertex, from which edges go to p and q, surely covered?
bool owns_corner(const Model& model, const std::array<int, 2>& p, const std::array<int, 2>& q) {
  const bool front = cross(p, q) > 0;
  if (model.vertices != oracle::AtVertices::as_edges) return false;
  if (model.culled != Cull::none && (model.culled == Cull::front) == front) return false;
  const Owners& owners = front ? model.front : model.back;
  const auto own = static_cast<std::uint8_t>(owners.owned & ~owners.open);
  return (own & bit(lattice_side({0, 0}, p, q))) != 0 && (own & bit(lattice_side({0, 0}, q, p))) != 0;
}

}  // namespace

void infer_owners(Rival& rival, Inference& result) {
  Model& model = result.model;
  const auto between = [](const AxisModel& axis) {
    return axis.place_within > 0 || snapped(axis.place, axis) != axis.place;
  };
  const auto unseen = [](const AxisModel& axis) { return axis.bits < 0 && axis.lacks != 0; };
  // No vertex, or none that is known, comes to lie on a sample.
  if (between(model.x) || between(model.y) || unseen(model.x) || unseen(model.y)) {
    model.front.open = model.back.open = 0xFF;
    return;
  }
  constexpr std::array<std::array<int, 2>, 8> kDirections{
      {{0, 2}, {2, 0}, {1, 1}, {1, -1}, {1, 2}, {2, 1}, {2, -1}, {1, -2}}};
  std::array<std::array<std::array<int, 2>, 8>, 2> votes{};  // facing, side: {not covered, covered}
  for (const auto& d : kDirections) {
    for (const int hand : {1, -1}) {
      // p and q on opposite sides of the sample; r to one side of both.
      const std::array<int, 2> p{-d[0], -d[1]}, q{d[0], d[1]}, r{-hand * d[1], hand * d[0]};
      for (std::size_t first = 0; first < 3; ++first) {
        for (const bool swap : {false, true}) {
          Lattice t{p, q, r};
          std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(first), t.end());
          if (swap) std::swap(t[1], t[2]);
          const std::array<int, 2> u{t[1][0] - t[0][0], t[1][1] - t[0][1]}, v{t[2][0] - t[0][0], t[2][1] - t[0][1]};
          const bool front = cross(u, v) > 0;
          if (model.culled != Cull::none && (model.culled == Cull::front) == front) continue;
          const auto side = static_cast<std::size_t>(lattice_side(p, q, r));
          ++votes[front ? 0 : 1][side][lattice_covers(rival, model, t) ? 1 : 0];
        }
      }
    }
  }
  for (const std::size_t facing : {0u, 1u}) {
    Owners owners;
    for (std::size_t side = 0; side < 8; ++side) {
      const auto mask = static_cast<std::uint8_t>(1u << side);
      if (votes[facing][side][0] > 0 && votes[facing][side][1] > 0) owners.open |= mask;
      if (votes[facing][side][1] > 0) owners.owned |= mask;
    }
    (facing == 0 ? model.front : model.back) = owners;
  }
  if (model.culled == Cull::front) model.front = model.back;
  if (model.culled == Cull::back) model.back = model.front;
  // Corners at the sample: is each covered as its edges say?
  int as_edges = 0, covered = 0, all = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      const std::array<int, 2> p{kDirections[i][0], kDirections[i][1]},
          q{i % 2 == 0 ? -kDirections[j][0] : kDirections[j][0], i % 2 == 0 ? -kDirections[j][1] : kDirections[j][1]};
      const int turn = cross(p, q);
      const bool front = turn > 0;
      if (turn == 0 || (model.culled != Cull::none && (model.culled == Cull::front) == front)) continue;
      const Owners& owners = front ? model.front : model.back;
      const std::uint8_t a = bit(lattice_side({0, 0}, p, q)), b = bit(lattice_side({0, 0}, q, p));
      if (owners.open & (a | b)) continue;
      const bool wanted = (owners.owned & a) && (owners.owned & b);
      const bool got = lattice_covers(rival, model, {std::array<int, 2>{0, 0}, p, q});
      ++all;
      if (got == wanted) ++as_edges;
      if (got) ++covered;
    }
  }
  model.vertices = as_edges == all  ? oracle::AtVertices::as_edges
                   : covered == all ? oracle::AtVertices::covered
                   : covered == 0   ? oracle::AtVertices::not_covered
                                    : oracle::AtVertices::open;
}

void infer_small(Rival& rival, Inference& result) {
  Model& model = result.model;
  // In a line, which runs through the sample or past it, on the grid as well.
  for (const auto& direction : {std::array<int, 2>{1, 1}, {1, 0}, {0, 1}, {2, 1}, {1, -2}}) {
    const int dx = direction[0], dy = direction[1];
    for (const double aside : {0.0, 0.25}) {
      for (const std::array<double, 3>& along : {std::array<double, 3>{-1, 1, 0.5}, {1, -1, -1}, {-1, 0, 1}}) {
        std::array<std::array<double, 2>, 3> t{}, on{};
        for (std::size_t i = 0; i < 3; ++i) {
          t[i] = {along[i] * dx + aside * (dy == 0 ? 0 : 1), along[i] * dy + aside * (dy == 0 ? 1 : 0)};
          on[i] = {placed_at(rival, model.x, t[i][0]), placed_at(rival, model.y, t[i][1])};
        }
        const double turn =
            (on[1][0] - on[0][0]) * (on[2][1] - on[0][1]) - (on[1][1] - on[0][1]) * (on[2][0] - on[0][0]);
        if (std::abs(turn) < 0x1p-20) model.draws_flat = model.draws_flat || covers_any(rival, model, t);
      }
    }
  }
  // Smaller and smaller, down to a step of each axis's grid, or to what float32 has at the sample.
  const int finest = rival.position_step() > 0 ? 16 : 20;
  const int most_x = model.x.bits < 0 ? finest : std::min(model.x.bits, finest);
  const int most_y = model.y.bits < 0 ? finest : std::min(model.y.bits, finest);
  double drawn = 0;
  for (int k = 1; k <= std::max(most_x, most_y); ++k) {
    const double sx = std::ldexp(1.0, -std::min(k, most_x)), sy = std::ldexp(1.0, -std::min(k, most_y));
    if (sx < 8 * model.x.blur || sy < 8 * model.y.blur) return;
    std::array<std::array<double, 2>, 3> t{{{-sx, -sy}, {2 * sx, -sy}, {-sx, 2 * sy}}};
    if (model.culled == Cull::front) std::swap(t[1], t[2]);
    if (!covers_middle(rival, model, t)) {
      model.least_area = 1.1 * drawn;
      return;
    }
    drawn = 4.5 * sx * sy;
  }
  // The smallest one of a grid has its corners a step apart. No sample is inside; the one at a corner may be its own.
  if (model.x.bits < 0 || model.y.bits < 0 || model.x.bits > finest || model.y.bits > finest) return;
  const double sx = std::ldexp(1.0, -model.x.bits), sy = std::ldexp(1.0, -model.y.bits);
  for (const int a : {-1, 1}) {
    for (const int b : {-1, 1}) {
      for (const bool turned : {false, true}) {
        const std::array<int, 2> p{turned ? 0 : a, turned ? b : 0}, q{turned ? a : 0, turned ? 0 : b};
        if (!owns_corner(model, p, q) ||
            covers_middle(rival, model, {{{0, 0}, {p[0] * sx, p[1] * sy}, {q[0] * sx, q[1] * sy}}})) {
          continue;
        }
        model.least_area = 1.1 * drawn;
        return;
      }
    }
  }
}

}  // namespace surefill::judge
