// SPDX-License-Identifier: Apache-2.0
//
// What a batch of the fast path promises those who draw it: boxes that hold all that is covered, integer edges that are
// right where they are sure, depth planes within their error bounds. Checked by exact arithmetic, apart from any image:
// an image shows a bound that is too small at one sample in millions, and one that is too large not at all.
#ifndef SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP
#define SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "properties/generators.hpp"
#include "triangle.hpp"

namespace surefill::properties {

class BatchBounds {
 public:
  explicit BatchBounds(std::uint64_t number) : random_(number) {}

  // What does not hold in this case; empty if all does.
  std::string broken() {
    const auto all = categories();
    const Category& category = all[random_.below(static_cast<std::uint32_t>(all.size()))];
    constexpr int kSizes[] = {4, 16, 60, 200, 1000, kMaxTargetSize};
    const int size = kSizes[random_.below(6)];
    const std::uint32_t count = 1 + random_.below(fast::kBatch);
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    const bool uneven = random_.one_in(4);
    for (std::uint32_t t = 0; t < count; ++t) {
      for (const Vertex& v : uneven ? uneven_triangle() : category.triangle(random_, size, size)) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.push_back(v);
      }
    }
    draw_.vertices = vertices, draw_.indices = indices;
    draw_.fill_rule = static_cast<FillRule>(random_.below(8));
    draw_.depth_mode = static_cast<DepthMode>(random_.below(3));
    draw_.cull = random_.one_in(3) ? static_cast<Cull>(random_.below(3)) : Cull::none;
    const int samples = uneven ? 16 : 1 << random_.below(5);
    // The last four of sixteen lie on the pixel's left or upper border, or near it.
    const SampleLocation location =
        sample_location(samples, uneven ? random_.between(12, 15) : random_.between(0, samples - 1));
    PixelBox region{0, 0, size, size};
    if (random_.one_in(3)) region = {size / 4, size / 5, size - size / 3, size - size / 7};
    job_ = {
        &draw_, 0, region, {location.x / 16.0, location.y / 16.0}, tie_shift(draw_.fill_rule), true, random_.one_in(3),
        0,      0};
    // What a lane does not set must not be looked at.
    std::fill_n(reinterpret_cast<unsigned char*>(&batch_), sizeof batch_, static_cast<unsigned char>(0x7E));
    Statistics statistics;
    fast::kernels().set_up(job_, fast::BandSet(), 0, count, batch_, statistics);
    if (statistics.triangles != count ||
        statistics.rasterized != static_cast<unsigned>(__builtin_popcount(batch_.live)))
      return "the statistics count lanes";
    for (std::uint32_t lane = 0; lane < count; ++lane) check(lane);
    return broken_;
  }

 private:
  void expect(bool holds, const char* what) {
    if (!holds && broken_.empty()) broken_ = what;
  }
  static bool has(std::uint32_t lanes, std::uint32_t lane) { return (lanes >> lane & 1) != 0; }
  // Whole numbers and powers of two far below them: products of which some are exact, edges that miss samples by next
  // to nothing.
  std::array<Vertex, 3> uneven_triangle() {
    const auto number = [&](int low, int high) {
      if (!random_.one_in(3)) return static_cast<float>(random_.between(low, high));
      return std::ldexp(static_cast<float>(random_.between(-3, 3)), -random_.between(10, 34));
    };
    std::array<Vertex, 3> made;
    for (Vertex& v : made) v = {number(-2, 14), number(-2, 14), number(0, 3), random_.one_in(3) ? number(1, 3) : 1.0f};
    return made;
  }
  SamplePosition at(int x, int y) const { return {x + job_.sample.x, y + job_.sample.y}; }

  template <class Terms>
  static mpq_class sum_of(const Terms& expansion) {
    mpq_class sum;
    for (int i = 0; i < expansion.size(); ++i) sum += expansion.term(i);
    return sum;
  }

  void check(std::uint32_t lane) {
    const Vertex* v[3] = {&draw_.vertices[3 * lane], &draw_.vertices[3 * lane + 1], &draw_.vertices[3 * lane + 2]};
    bool finite = true;
    for (const Vertex* vertex : v) {
      finite = finite && std::isfinite(vertex->x) && std::isfinite(vertex->y) && std::isfinite(vertex->z) &&
               std::isfinite(vertex->w);
    }
    Statistics statistics;
    const bool drawn = finite && triangle_.set_up(*v[0], *v[1], *v[2], statistics);
    const bool front = drawn && (triangle_.determinant() > 0) == (draw_.front_face == FrontFace::clockwise);
    const bool culled = draw_.cull == Cull::front ? front : draw_.cull == Cull::back && !front;
    const bool live = has(batch_.live, lane);
    expect(!live || (drawn && !culled), "what is live is a triangle that is not culled");
    if (!drawn || culled) return;
    const PixelBox exact_box = screen_box(*v[0], *v[1], *v[2], job_.region, std::min(job_.sample.x, job_.sample.y),
                                          std::max(job_.sample.x, job_.sample.y));
    if (!live) {
      for (int n = 0; n < 12 && !exact_box.empty(); ++n) {
        const int x = random_.between(exact_box.x0, exact_box.x1 - 1),
                  y = random_.between(exact_box.y0, exact_box.y1 - 1);
        expect(!triangle_.covers(at(x, y), job_.shift, statistics), "what is not live covers nothing");
      }
      return;
    }
    x0_ = batch_.first_x[lane], x1_ = batch_.last_x[lane], y0_ = batch_.first_y[lane], y1_ = batch_.last_y[lane];
    expect(x0_ >= job_.region.x0 && x1_ < job_.region.x1 && y0_ >= job_.region.y0 && y1_ < job_.region.y1 &&
               x0_ <= x1_ && y0_ <= y1_,
           "the box lies in the region");
    if (!broken_.empty()) return;
    box(v, exact_box);
    origin_x_ = batch_.origin_x(lane), origin_y_ = batch_.origin_y(lane);
    const bool small = has(batch_.small, lane), medium = has(batch_.medium, lane);
    expect(small == (x1_ - (x0_ & ~3) < 16 && y1_ - (y0_ & ~3) < 16), "`small` is 4 x 4 cells");
    expect(medium == (x1_ - (x0_ & ~7) < 64 && y1_ - (y0_ & ~7) < 64), "`medium` is 8 x 8 blocks");
    if (small || medium) edges(lane, small ? 16 : 64);
    if (!small) unscaled_edges(lane);
    depth(lane, v);
  }

  // It holds every sample that is covered; and no more than what float32 quotients add, and one sample offset for both
  // axes where a vertex lies behind the eye.
  void box(const Vertex* const (&v)[3], const PixelBox& wide) {
    const double w[3] = {v[0]->w, v[1]->w, v[2]->w};
    PixelBox least = job_.region;
    clip_to_reach(reach({v[0]->x, v[1]->x, v[2]->x}, w), job_.sample.x, job_.sample.x, &least.x0, &least.x1);
    clip_to_reach(reach({v[0]->y, v[1]->y, v[2]->y}, w), job_.sample.y, job_.sample.y, &least.y0, &least.y1);
    if (!least.empty())
      expect(x0_ <= least.x0 && x1_ >= least.x1 - 1 && y0_ <= least.y0 && y1_ >= least.y1 - 1,
             "the box holds the triangle");
    expect(x0_ >= wide.x0 - 1 && x1_ <= wide.x1 && y0_ >= wide.y0 - 1 && y1_ <= wide.y1,
           "the box is no larger than need be");
  }

  template <typename Visit>
  void for_some_samples(const Visit& visit) {
    visit(x0_, y0_), visit(x1_, y0_), visit(x0_, y1_), visit(x1_, y1_);
    for (int n = 0; n < 6; ++n) visit(random_.between(x0_, x1_), random_.between(y0_, y1_));
  }

  // Of an edge in integers, v >= 0 says inside and v < -doubt says outside.
  void edges(std::uint32_t lane, int reach) {
    const std::int64_t doubt = batch_.doubt[lane];
    Statistics statistics;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t a = batch_.a[i][lane], b = batch_.b[i][lane], e = batch_.e[i][lane];
      const EdgeFunction& edge = triangle_.edge(static_cast<int>(i));
      const auto value = [&](int x, int y) { return e + a * (x - origin_x_) + b * (y - origin_y_); };
      const auto inside = [&](int x, int y) {
        const int sign = edge.sign(at(x, y), statistics);
        return (sign != 0 ? sign : tie_sign(edge, job_.shift)) == triangle_.determinant();
      };
      const std::int64_t rise = 3 * (std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0));
      expect(batch_.most[i][lane] == rise + doubt, "`most` is the largest change, and the doubt");
      const int steps = reach - 1;
      const std::int64_t far = steps * (std::abs(a) + std::abs(b)) + std::abs(e) + 2 * doubt;
      expect(far < std::numeric_limits<std::int32_t>::max(), "integer edges do not overflow");
      expect(edge.a == 0 || std::fabs(edge.a) < std::fabs(edge.b) || std::abs(a) >= 1 << 21,
             "steps in x have their bits");
      expect(edge.b == 0 || std::fabs(edge.b) < std::fabs(edge.a) || std::abs(b) >= 1 << 21,
             "steps in y have their bits");
      const auto judge = [&](int x, int y) {
        const std::int64_t at_sample = value(x, y);
        if (at_sample >= 0) expect(inside(x, y), "what is surely inside is");
        if (at_sample < -doubt) expect(!inside(x, y), "what is surely outside is");
      };
      for_some_samples(judge);
      // Where the edge crosses a row or a column: as near as samples come to it.
      for (int n = 0; n < 4; ++n) {
        const int x = random_.between(x0_, x1_), y = random_.between(y0_, y1_);
        if (b != 0) {
          const std::int64_t crossing = origin_y_ - (e + a * (x - origin_x_)) / b;
          for (std::int64_t near = crossing - 1; near <= crossing + 1; ++near)
            if (near >= y0_ && near <= y1_) judge(x, static_cast<int>(near));
        }
        if (a != 0) {
          const std::int64_t crossing = origin_x_ - (e + b * (y - origin_y_)) / a;
          for (std::int64_t near = crossing - 1; near <= crossing + 1; ++near)
            if (near >= x0_ && near <= x1_) judge(static_cast<int>(near), y);
        }
      }
    }
  }

  // In double, with D's sign; their rounding is what a tile's bound allows for.
  void unscaled_edges(std::uint32_t lane) {
    const double sign = triangle_.determinant();
    for (std::size_t i = 0; i < 3; ++i) {
      const EdgeFunction& edge = triangle_.edge(static_cast<int>(i));
      const auto near = [](double actual, double exact, double terms) {
        return std::fabs(actual - exact) <= terms * 0x1p-51;
      };
      const Vertex &j = edge.from, &k = edge.to;
      const double jx = j.x, jy = j.y, jw = j.w, kx = k.x, ky = k.y, kw = k.w;
      expect(near(batch_.edge_a[i][lane], sign * edge.a, std::fabs(jy * kw) + std::fabs(jw * ky)) &&
                 near(batch_.edge_b[i][lane], sign * edge.b, std::fabs(jw * kx) + std::fabs(jx * kw)) &&
                 near(batch_.edge_c[i][lane], sign * edge.c, std::fabs(jx * ky) + std::fabs(jy * kx)),
             "unscaled edges are the triangle's");
    }
  }

  // As cells put it together: high parts are exact, and depth lies between the sums with the two low parts.
  void depth_in_parts(std::uint32_t lane, const mpq_class& determinant) {
    const float error = batch_.low_error[lane];
    const double slopes = std::fabs(batch_.z_x[lane]) + std::fabs(batch_.z_y[lane]);
    const double largest = std::fabs(batch_.z[lane]) + 18 * slopes;
    expect(error <= 1.001 * batch_.z_error[lane] + 0x1p-40 * largest + 0x1p-140, "parts add little to the error");
    expect(error >= batch_.z_error[lane], "the error of the parts holds that of the plane");
    const auto step = [&](int x, int y, const float(&along_x)[fast::kBatch], const float(&along_y)[fast::kBatch]) {
      return along_x[lane] * static_cast<float>(x) + along_y[lane] * static_cast<float>(y);
    };
    const auto judge = [&](int x, int y) {
      const int dx = x - origin_x_, dy = y - origin_y_, cx = dx >> 2, cy = dy >> 2;
      const auto sum = [&](float start, const auto& along_x, const auto& along_y, float offset) {
        return (start + 4 * step(cx, cy, along_x, along_y)) + (step(dx & 3, dy & 3, along_x, along_y) + offset);
      };
      const float high = sum(batch_.high[lane], batch_.high_x, batch_.high_y, 0);
      const mpq_class exact =
          mpq_class(batch_.high[lane]) + mpq_class(batch_.high_x[lane]) * dx + mpq_class(batch_.high_y[lane]) * dy;
      expect(exact == mpq_class(high), "sums of high parts are exact");
      const float least = sum(batch_.low[lane], batch_.low_x, batch_.low_y, -error),
                  most = sum(batch_.low[lane], batch_.low_x, batch_.low_y, error);
      mpq_class real = sum_of(triangle_.exact_depth_numerator(at(x, y))) / determinant;
      if (job_.greater) real = -real;
      expect(mpq_class(high) + mpq_class(least) <= real && real <= mpq_class(high) + mpq_class(most),
             "depth lies between its parts' sums");
    };
    for_some_samples(judge);
  }

  void depth(std::uint32_t lane, const Vertex* const (&v)[3]) {
    bool within = true;
    for (const Vertex* vertex : v) within = within && vertex->w > 0 && vertex->z >= 0 && vertex->z <= vertex->w;
    expect(has(batch_.clip, lane) == (draw_.depth_mode != DepthMode::none && !within), "`clip` is what may be clipped");
    const mpq_class determinant = sum_of(triangle_.exact_determinant_value());
    if (has(batch_.slow_depth, lane)) return;
    const double z = batch_.z[lane], zx = batch_.z_x[lane], zy = batch_.z_y[lane], error = batch_.z_error[lane];
    expect(error >= 0 && error < 0x1p1000, "there is an error bound of depth");
    if (!broken_.empty()) return;
    for_some_samples([&](int x, int y) {
      mpq_class real = sum_of(triangle_.exact_depth_numerator(at(x, y))) / determinant;
      if (job_.greater) real = -real;
      const double value = z + (zx * (x - origin_x_) + zy * (y - origin_y_));
      expect(abs(real - value) <= error, "the error bound of depth holds");
    });
    if (has(batch_.small, lane)) depth_in_parts(lane, determinant);
    // A well-shaped triangle in front of the eye.
    double size = 0, terms = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const EdgeFunction& edge = triangle_.edge(static_cast<int>(i));
      const double x = x1_ + 1.0, y = y1_ + 1.0;
      terms += (std::fabs(edge.a) * x + std::fabs(edge.b) * y + std::fabs(edge.c)) * std::fabs(v[i]->w);
      size += std::fabs(static_cast<double>(v[i]->z));
    }
    const double d = std::fabs(determinant.get_d());
    if (v[0]->w > 0 && v[1]->w > 0 && v[2]->w > 0 && terms < 0x1p20 * d) {
      const double least = std::min({v[0]->w, v[1]->w, v[2]->w});
      const double slope = (std::fabs(zx) + std::fabs(zy)) * (64 + (x1_ - x0_) + (y1_ - y0_)) + std::fabs(z);
      expect(error <= 0x1p-46 * (size / least + slope) * (terms / d),
             "the error bound of depth is no wider than need be");
    }
  }

  Random random_;
  Draw draw_;
  fast::DrawJob job_{};
  fast::Batch batch_;
  Triangle triangle_;
  int x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, origin_x_ = 0, origin_y_ = 0;
  std::string broken_;
};

}  // namespace surefill::properties

#endif  // SUREFILL_PROPERTIES_BATCH_BOUNDS_HPP
