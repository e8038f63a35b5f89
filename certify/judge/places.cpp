// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/places.hpp"

#include <algorithm>
#include <cmath>

namespace surefill::judge {

namespace {

constexpr int kSize = 16;
constexpr int kMostProbes = 72, kTries = 600;
constexpr double kRounded = 0x1p-40;  // of what is computed here in double
constexpr double kMostBlur = 1.0 / 16;

struct Place {
  double x, y;
};
using Corners = std::array<Place, 3>;

// A place that keeps to one side of an edge: a x + b y + c >= 0 up to blur, the sum of each length times the other
// axis's.
struct Half {
  double a, b, c;
};

Half half_of(const Place& p, const Place& q, int pixel_x, int pixel_y) {
  const double dx = q.x - p.x, dy = q.y - p.y;
  return {-dy, dx, dx * (pixel_y - p.y) - dy * (pixel_x - p.x)};
}

double margin_of(const Half& half, double blur_x, double blur_y) {
  return std::abs(half.a) * blur_x + std::abs(half.b) * blur_y + kRounded;
}

double value_at(const Half& half, const std::array<double, 2>& place) {
  return half.a * place[0] + half.b * place[1] + half.c;
}

struct Extremes {
  double least = INFINITY, most = -INFINITY;
};
Extremes extremes_of(const Half& half, const Region& region) {
  Extremes result;
  for (const auto& corner : region.corners) {
    result.least = std::min(result.least, value_at(half, corner));
    result.most = std::max(result.most, value_at(half, corner));
  }
  return result;
}

// Where vertices come to lie, and where they come from.
class Lattice {
 public:
  Lattice(const AxisFit& fit, double step) : fit_(fit), step_(step) {}
  // A source position in the middle of what goes to about this place.
  float source(double place) const { return on_step(fit_.middle(place) * kSize / (kSize - fit_.lacks), step_); }
  double placed(float source) const { return fit_.middle(static_cast<double>(source) * (kSize - fit_.lacks) / kSize); }

 private:
  const AxisFit& fit_;
  double step_;
};

class Narrowing {
 public:
  Narrowing(Rival& rival, Cull culled, AxisFit& x, AxisFit& y, std::vector<Probe>& probes)
      : rival_(rival),
        culled_(culled),
        x_(x),
        y_(y),
        probes_(probes),
        on_x_(x, rival.position_step()),
        on_y_(y, rival.position_step()) {}

  Region run() {
    start();
    int idle = 0;
    for (int n = 0; n < kMostProbes && idle < 4; ++n) {
      const double before = size();
      if (before < 0x1p-17) break;
      if (!draw_next()) {
        ++idle;
        continue;
      }
      while (region_.empty()) {
        // Edges are not kept as exactly as turns say.
        const double blur = std::max({2 * x_.blur, 2 * y_.blur, 0x1p-22});
        if (blur > kMostBlur) return region_;
        x_.blur = std::max(x_.blur, blur);
        y_.blur = std::max(y_.blur, blur);
        x_.ties.clear();
        y_.ties.clear();
        start();
        for (const Probe& probe : probes_) use(probe);
      }
      idle = size() > 0.98 * before ? idle + 1 : 0;
    }
    return region_;
  }

 private:
  void start() {
    const double x = x_.blur + 0x1p-26, y = y_.blur + 0x1p-26;
    region_.corners = {
        {x_.low - x, y_.low - y}, {x_.high + x, y_.low - y}, {x_.high + x, y_.high + y}, {x_.low - x, y_.high + y}};
  }
  double size() const {
    return region_.empty() ? 0 : std::max(region_.high(0) - region_.low(0), region_.high(1) - region_.low(1));
  }

  Corners corners_of(const FlatTriangle& triangle) const {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = {on_x_.placed(triangle[i].x), on_y_.placed(triangle[i].y)};
    return corners;
  }

  // An edge that passes the region near its middle, between places on the lattice, and a third corner far from it.
  bool draw_next() {
    FlatTriangle best{};
    double most = 0.02;
    const double middle_x = (region_.low(0) + region_.high(0)) / 2, middle_y = (region_.low(1) + region_.high(1)) / 2;
    for (int n = 0; n < kTries; ++n) {
      const int px = random_.between(3, 12), py = random_.between(3, 12);
      const Place s{px + middle_x, py + middle_y};
      const double angle = 6.283185307179586 * random_.unit(), length = 1.5 + 10 * random_.unit();
      const Place from{s.x + std::cos(angle) * (1.2 + 4 * random_.unit()),
                       s.y + std::sin(angle) * (1.2 + 4 * random_.unit())};
      FlatTriangle triangle{};
      triangle[0] = {on_x_.source(from.x), on_y_.source(from.y)};
      const Place p{on_x_.placed(triangle[0].x), on_y_.placed(triangle[0].y)};
      const double dx = s.x - p.x, dy = s.y - p.y, distance = std::hypot(dx, dy);
      if (distance < 0.5) continue;
      triangle[1] = {on_x_.source(s.x + dx / distance * length), on_y_.source(s.y + dy / distance * length)};
      const double hand = n % 2 == 0 ? 4.5 : -4.5;
      triangle[2] = {on_x_.source(s.x - dy / distance * hand), on_y_.source(s.y + dx / distance * hand)};
      const auto inside = [](float v) { return v >= 1 && v <= kSize - 0.5f; };
      if (!std::all_of(triangle.begin(), triangle.end(), [&](const Point& v) { return inside(v.x) && inside(v.y); })) {
        continue;
      }
      triangle = seen(triangle, culled_);
      const double share = share_of(triangle, px, py);
      if (share > most) most = share, best = triangle;
    }
    if (most <= 0.02) return false;
    corpus::Scene scene = flat_scene(kSize, kSize, {best});
    corpus::Image image = rival_.draw(scene, covering(rival_));
    probes_.push_back({std::move(scene), std::move(image)});
    use(probes_.back());
    return true;
  }

  // How evenly the answer at this pixel parts the region: 0 to 1/2.
  double share_of(const FlatTriangle& triangle, int px, int py) const {
    const Corners c = corners_of(triangle);
    double share = 0;
    int parting = 0;
    const double turn = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (std::abs(turn) < 1) return 0;
    for (std::size_t i = 0; i < 3; ++i) {
      Half half = half_of(c[i], c[(i + 1) % 3], px, py);
      if (turn < 0) half = {-half.a, -half.b, -half.c};
      const Extremes e = extremes_of(half, region_);
      const double margin = margin_of(half, x_.blur, y_.blur);
      if (e.least > margin) continue;
      if (e.most < margin) return 0;
      ++parting;
      share = std::min(e.most - margin, -margin - e.least) / (e.most - e.least);
    }
    return parting == 1 ? share : 0;
  }

  // What every sample of the probe says of the place.
  void use(const Probe& probe) {
    FlatTriangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const corpus::SceneVertex& v = probe.scene.draws[0].vertices[i];
      triangle[i] = {v.x, v.y};
    }
    const Corners c = corners_of(triangle);
    const double turn = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    for (int py = 0; py < kSize; ++py) {
      for (int px = 0; px < kSize && !region_.empty(); ++px) {
        const bool covered = is_covered(probe.image, static_cast<std::size_t>(py * kSize + px));
        int open = 0;
        bool outside = false;
        Half parting{};
        for (std::size_t i = 0; i < 3; ++i) {
          Half half = half_of(c[i], c[(i + 1) % 3], px, py);
          if (turn < 0) half = {-half.a, -half.b, -half.c};
          const double margin = margin_of(half, x_.blur, y_.blur);
          const Extremes e = extremes_of(half, region_);
          if (covered && e.least < -margin) region_.clip(half.a, half.b, half.c + margin);
          if (e.least > margin) continue;
          outside = outside || e.most < -margin;
          ++open;
          parting = half;
        }
        if (covered || outside) continue;
        if (open == 0) region_.corners.clear();
        if (open == 1) {
          const double margin = margin_of(parting, x_.blur, y_.blur);
          region_.clip(-parting.a, -parting.b, -parting.c + margin);
        }
      }
    }
  }

  Rival& rival_;
  Cull culled_;
  AxisFit &x_, &y_;
  std::vector<Probe>& probes_;
  Lattice on_x_, on_y_;
  Region region_;
  Random random_{0x91ACE};
};

}  // namespace

double Region::low(std::size_t axis) const {
  double result = INFINITY;
  for (const auto& corner : corners) result = std::min(result, corner[axis]);
  return result;
}

double Region::high(std::size_t axis) const {
  double result = -INFINITY;
  for (const auto& corner : corners) result = std::max(result, corner[axis]);
  return result;
}

void Region::clip(double a, double b, double c) {
  std::vector<std::array<double, 2>> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &p = corners[i], &q = corners[(i + 1) % corners.size()];
    const double at_p = a * p[0] + b * p[1] + c, at_q = a * q[0] + b * q[1] + c;
    if (at_p >= 0) kept.push_back(p);
    if ((at_p >= 0) == (at_q >= 0)) continue;
    const double t = at_p / (at_p - at_q);
    kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
  }
  corners = std::move(kept);
  if (corners.size() < 3) corners.clear();
}

Region find_places(Rival& rival, Cull culled, AxisFit& x, AxisFit& y, std::vector<Probe>& probes) {
  return Narrowing(rival, culled, x, y, probes).run();
}

}  // namespace surefill::judge
