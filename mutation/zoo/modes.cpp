// SPDX-License-Identifier: Apache-2.0
//
// Faults of sample patterns, Grid and conservative rasterization.
#include <type_traits>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// Every output of sample n is that of sample other(n).
template <class Other>
Status with_samples(const Target& target, Draws draws, const Other& other) {
  const Status status = right(target, draws);
  if (status != Status::ok || target.samples == 1) return status;
  const auto samples = static_cast<std::size_t>(target.samples);
  const auto change = [&](auto buffer, std::size_t components) {
    const std::vector<std::remove_reference_t<decltype(buffer[0])>> before(buffer.begin(), buffer.end());
    const std::size_t stride = samples * components;
    for (std::size_t i = 0; i < buffer.size(); ++i) {
      const std::size_t from = other(i % stride / components);
      buffer[i] = before[i / stride * stride + from * components + i % components];
    }
  };
  change(target.count, 1);
  change(target.index, 1);
  change(target.depth, 1);
  change(target.barycentrics, 3);
  for (const AttributeTarget& a : target.attributes) change(a.values, a.components);
  return status;
}

template <class Change>
Status with_grid(const Target& target, Draws draws, const Change& change) {
  return with_state(target, draws, [&](Draw& d) {
    if (d.grid) change(*d.grid);
  });
}

// The draw's grid, done by hand in double on vertices in front of the eye: `snap(position, offset, steps a pixel)`.
template <class SnapX, class SnapY>
Status snapped(const Target& target, Draws draws, const SnapX& snap_x, const SnapY& snap_y) {
  std::vector<std::vector<Vertex>> vertices(draws.size());
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (std::size_t d = 0; d < draws.size(); ++d) {
    if (!draws[d].grid) continue;
    const Grid grid = *draws[d].grid;
    const double steps = std::ldexp(1.0, grid.bits), unit = std::ldexp(1.0, -grid.bits - 4);
    for (Vertex v : draws[d].vertices) {
      const double w = v.w;
      if (v.w > 0)
        v = {static_cast<float>(snap_x(v.x / w, grid.offset_x * unit, steps) * w),
             static_cast<float>(snap_y(v.y / w, grid.offset_y * unit, steps) * w), v.z, v.w};
      vertices[d].push_back(v);
    }
    changed[d].vertices = vertices[d];
  }
  return right(target, changed);
}

double nearest(double position, double offset, double steps) {
  return offset + std::nearbyint((position - offset) * steps) / steps;
}

// The target's pixels moved by (dx, dy) pixels under the triangles; counts of draws of this mode are joined.
template <class Join>
Status corners_joined(const Target& target, Draws draws, Conservative mode, const Join& join) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    if (draw.conservative != mode) return right_counts(t, draw);
    Draw plain = draw;
    plain.conservative = Conservative::none;
    Counts counts = right_counts(t, plain);
    for (const float dx : {-0.5f, 0.5f})
      for (const float dy : {-0.5f, 0.5f}) {
        std::vector<Vertex> moved(draw.vertices.begin(), draw.vertices.end());
        for (Vertex& v : moved) v = {v.x + dx * v.w, v.y + dy * v.w, v.z, v.w};
        Draw corner = plain;
        corner.vertices = moved;
        const Counts at_corner = right_counts(t, corner);
        for (std::size_t s = 0; s < counts.size(); ++s) counts[s] = join(counts[s], at_corner[s]);
      }
    return counts;
  });
}

// Over by its three edges alone, each moved outwards: too much beyond acute vertices. In double.
Status three_edges(const Target& target, Draws draws) {
  return with_counts(target, draws, [](const Target& t, const Draw& draw) {
    Counts counts = right_counts(t, draw);
    const Corners v = corners(draw, 0);
    if (draw.conservative != Conservative::over || !in_front(v)) return counts;
    double e[3][3], d = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &j = v[(i + 1) % 3], &k = v[(i + 2) % 3];
      const double jx = j.x, jy = j.y, jw = j.w;
      e[i][0] = jy * k.w - jw * k.y, e[i][1] = jw * k.x - jx * k.w, e[i][2] = jx * k.y - jy * k.x;
      d += i == 0 ? e[0][0] * v[0].x + e[0][1] * v[0].y + e[0][2] * v[0].w : 0;
    }
    if (d == 0 || !std::isfinite(d)) return counts;
    if (std::all_of(counts.begin(), counts.end(), [](auto c) { return c == 0; })) return counts;  // culled, scissored
    for (int y = 0; y < t.height; ++y)
      for (int x = 0; x < t.width; ++x) {
        if (draw.scissor &&
            (x < draw.scissor->x0 || x >= draw.scissor->x1 || y < draw.scissor->y0 || y >= draw.scissor->y1))
          continue;
        bool in = true;
        for (const auto& [a, b, c] : e) {
          const double sign = d > 0 ? 1 : -1;
          const double sx = x + (sign * a > 0 ? 1 : 0), sy = y + (sign * b > 0 ? 1 : 0);
          in = in && sign * (a * sx + b * sy + c) >= 0;
        }
        if (in) counts[static_cast<std::size_t>(y * t.width + x)] = 1;
      }
    return counts;
  });
}

Status with_mode(const Target& target, Draws draws, Conservative mode, Conservative instead) {
  return with_state(target, draws, [&](Draw& d) {
    if (d.conservative == mode) d.conservative = instead;
  });
}

constexpr Specimen kSpecimens[] = {
    {"samples-reversed", "samples are numbered from the end", "", "samples-shifted",
     [](const Target& t, Draws d) {
       const auto samples = static_cast<std::size_t>(t.samples);
       return with_samples(t, d, [&](std::size_t n) { return samples - 1 - n; });
     }},
    {"samples-alike", "all samples of a pixel are the first", "", "samples-shifted",
     [](const Target& t, Draws d) { return with_samples(t, d, [](std::size_t) { return std::size_t{0}; }); }},
    {"samples-two-exchanged", "of sixteen samples, two are exchanged", "", "samples-shifted",
     [](const Target& t, Draws d) {
       return with_samples(t, d, [&](std::size_t n) { return t.samples == 16 && n >= 14 ? 29 - n : n; });
     }},
    {"samples-by-pixel-box", "any place within the pixel counts: covered if one sample is", "accepted by VK-GL-CTS",
     "samples-shifted",
     [](const Target& t, Draws d) {
       return with_counts(t, d, [](const Target& target, const Draw& draw) {
         Counts counts = right_counts(target, draw);
         const auto samples = static_cast<std::ptrdiff_t>(target.samples);
         for (auto pixel = counts.begin(); pixel != counts.end(); pixel += samples)
           std::fill(pixel, pixel + samples, *std::max_element(pixel, pixel + samples));
         return counts;
       });
     }},
    {"centroid-ignored", "attributes at the centre, covered or not: extrapolated", "luanti#15610", "equality-samples",
     [](const Target& t, Draws d) {
       Target changed = t;
       changed.attribute_location = AttributeLocation::centre;
       return right(changed, d);
     }},
    {"centroid-always", "attributes at the first covered sample, though the centre is covered", "",
     "attributes-at-centre",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (status != Status::ok || t.samples == 1) return status;
       std::vector<float> weights(t.barycentrics.size());
       const SampleLocation at = sample_location(t.samples, 0);
       std::vector<std::vector<Vertex>> vertices;
       std::vector<Draw> changed(d.begin(), d.end());
       for (Draw& draw : changed) {
         std::vector<Vertex>& own = vertices.emplace_back(draw.vertices.begin(), draw.vertices.end());
         for (Vertex& v : own)
           v.x += static_cast<float>(8 - at.x) / 16 * v.w, v.y += static_cast<float>(8 - at.y) / 16 * v.w;
         draw.vertices = own;
       }
       Target elsewhere = t;
       std::vector<std::uint32_t> index(t.index.size());
       elsewhere.count = {}, elsewhere.depth = {}, elsewhere.attributes = {};
       elsewhere.index = index;
       elsewhere.barycentrics = weights;
       if (right(elsewhere, changed) != Status::ok) return status;
       for (std::size_t i = 0; i < weights.size(); ++i)
         if (t.barycentrics[i] != 0 && weights[i] != 0) t.barycentrics[i] = weights[i];
       return status;
     }},
    {"less-is-less-equal", "of equal depths the later one is seen, whatever the test", "", "equality-scene",
     [](const Target& t, Draws d) {
       Target changed = t;
       if (t.depth_test == DepthTest::less) changed.depth_test = DepthTest::less_equal;
       if (t.depth_test == DepthTest::greater) changed.depth_test = DepthTest::greater_equal;
       return right(changed, d);
     }},
    {"grid-truncated", "positions are truncated to the grid", "accepted by VK-GL-CTS", "equality-grid",
     [](const Target& t, Draws d) { return with_grid(t, d, [](Grid& g) { g.rounding = GridRounding::truncate; }); }},
    {"grid-nearest-up", "ties go up, not to the even position", "", "equality-grid",
     [](const Target& t, Draws d) {
       return with_grid(t, d, [](Grid& g) {
         if (g.rounding == GridRounding::nearest_even) g.rounding = GridRounding::nearest_up;
       });
     }},
    {"grid-floor", "truncation goes down, not towards zero", "", "equality-grid",
     [](const Target& t, Draws d) {
       for (const Draw& draw : d)
         if (!draw.grid || draw.grid->rounding != GridRounding::truncate) return right(t, d);
       const auto down = [](double position, double offset, double steps) {
         return offset + std::floor((position - offset) * steps) / steps;
       };
       return snapped(t, d, down, down);
     }},
    {"grid-6-bits", "6 bits where 8 are claimed", "accepted by VK-GL-CTS", "grid-on-lattice",
     [](const Target& t, Draws d) {
       return with_grid(t, d, [](Grid& g) {
         if (g.bits == 8) g.bits = 6, g.offset_x /= 4, g.offset_y /= 4;
       });
     }},
    {"grid-offset-ignored", "the grid's offset is not applied", "", "grid-on-lattice",
     [](const Target& t, Draws d) { return with_grid(t, d, [](Grid& g) { g.offset_x = g.offset_y = 0; }); }},
    {"grid-whole-rows", "y is snapped to whole pixels, x to the grid", "GLideN64#1731", "grid-on-lattice",
     [](const Target& t, Draws d) {
       return snapped(t, d, nearest, [](double y, double offset, double) { return nearest(y, offset, 1); });
     }},
    {"grid-in-float", "the quotient is rounded to float32 before it is snapped", "", "equality-grid",
     [](const Target& t, Draws d) {
       const auto twice = [](double position, double offset, double steps) {
         return nearest(static_cast<double>(static_cast<float>(position)), offset, steps);
       };
       return snapped(t, d, twice, twice);
     }},
    {"grid-ignored", "nothing is snapped (float edges without snapping)", "barely caught by VK-GL-CTS", "equality-grid",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.grid.reset(); }); }},
    {"grid-everywhere", "1/256 pixel, whether or not a grid is asked for", "accepted by VK-GL-CTS", "equality-coverage",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (!draw.grid && draw.conservative == Conservative::none) draw.grid = Grid{};
       });
     }},
    {"grid-culls-unsnapped", "facing is that before snapping", "zeux/niagara#40", "grid-degree",
     [](const Target& t, Draws d) {
       std::vector<Draw> kept;
       for (const Draw& draw : one_by_one(d)) {
         Draw one = draw;
         const float determinant = float_determinant(corners(draw, 0));
         if (draw.grid && draw.cull != Cull::none && determinant != 0) {
           const bool front = (determinant > 0) == (draw.front_face == FrontFace::clockwise);
           if (front == (draw.cull == Cull::front)) continue;
           one.cull = Cull::none;
         }
         kept.push_back(one);
       }
       return right(t, kept);
     }},
    {"grid-drops-slivers", "a triangle whose snapped corners turn round is dropped", "", "grid-degree",
     [](const Target& t, Draws d) {
       return without(t, d, [](const Draw& draw, std::size_t n) {
         if (!draw.grid) return false;
         Corners c = corners(draw, n);
         const float before = float_determinant(c);
         const double steps = std::ldexp(1.0, draw.grid->bits), unit = std::ldexp(1.0, -draw.grid->bits - 4);
         for (Vertex& v : c)
           v = {static_cast<float>(nearest(v.x / v.w, draw.grid->offset_x * unit, steps)),
                static_cast<float>(nearest(v.y / v.w, draw.grid->offset_y * unit, steps)), v.z, 1};
         return in_front(corners(draw, n)) && before * float_determinant(c) < 0;
       });
     }},
    {"over-as-covered", "conservative means the pixel's centre", "OSGeo/gdal#7523", "conservative-contains",
     [](const Target& t, Draws d) { return with_mode(t, d, Conservative::over, Conservative::none); }},
    {"over-by-corners", "a pixel is touched if its centre or a corner is covered", "OSGeo/gdal#7523",
     "conservative-contains",
     [](const Target& t, Draws d) {
       return corners_joined(t, d, Conservative::over, [](std::uint32_t a, std::uint32_t b) { return a | b; });
     }},
    {"over-by-three-edges", "three edges moved outwards, no box: too much beyond acute vertices", "",
     "conservative-split", three_edges},
    {"over-by-box", "every pixel of the box is touched", "", "conservative-split",
     [](const Target& t, Draws d) {
       return with_counts(t, d, [](const Target& target, const Draw& draw) {
         Counts counts = right_counts(target, draw);
         const Corners c = corners(draw, 0);
         const bool none = std::all_of(counts.begin(), counts.end(), [](auto n) { return n == 0; });
         if (draw.conservative != Conservative::over || !in_front(c) || none || draw.scissor) return counts;
         const Box b = box_of(c);
         for (int y = 0; y < target.height; ++y)
           for (int x = 0; x < target.width; ++x) {
             const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
             if (fx + 1 >= b.x0 && fx <= b.x1 && fy + 1 >= b.y0 && fy <= b.y1)
               counts[static_cast<std::size_t>(y * target.width + x)] = 1;
           }
         return counts;
       });
     }},
    {"inner-as-covered", "inner means the pixel's centre", "", "conservative-contains",
     [](const Target& t, Draws d) { return with_mode(t, d, Conservative::inner, Conservative::none); }},
    {"inner-by-fill-rule", "inner by the fill rule at the pixel's corners: edges along pixels are lost", "",
     "equality-conservative",
     [](const Target& t, Draws d) {
       return corners_joined(t, d, Conservative::inner, [](std::uint32_t a, std::uint32_t b) { return a & b; });
     }},
};

}  // namespace

std::span<const Specimen> mode_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
