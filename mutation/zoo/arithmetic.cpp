// SPDX-License-Identifier: Apache-2.0
//
// Faults of arithmetic: rasterizers as they are written, right in all but their numbers. The counts are theirs, the
// other outputs are right.
#include <type_traits>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// As the registers of a fixed-point rasterizer wrap: Integer's width, two's complement.
template <class Integer>
Integer wrapped(double value) {
  return static_cast<Integer>(static_cast<std::int64_t>(value));
}

// C3: does the edge, positive inside, own the samples on it?
template <class Real>
bool owns(Real a, Real b, FillRule rule) {
  const auto number = static_cast<unsigned>(rule);
  const bool east = (number & 1u) == 0, south = (number & 2u) == 0, x_first = number < 4;
  if (a == 0 || (!x_first && b != 0)) return (b > 0) == south;
  return (a > 0) == east;
}

// E(px, py) = a px + b py + c from vertex i to vertex j of a front-facing triangle: positive inside.
struct PlainOptions {
  bool from_corner = false;     // a (px - xi) + b (py - yi): what most people write
  bool fused = false;           // with fused multiply-add, as compilers contract
  bool incremental = false;     // E is stepped along the row and down the column
  bool rows_not_reset = false;  // E goes on from the end of the last row
  bool reciprocal = false;      // weights E / 2A by a reciprocal, compared with 0 and 1
  bool third_weight = false;    // the third weight is 1 minus the other two
};

template <class Real>
class PlainEdge {
 public:
  PlainEdge(Real xi, Real yi, Real xj, Real yj) : a(yi - yj), b(xj - xi), c(xi * yj - xj * yi), xi_(xi), yi_(yi) {}

  Real at(Real px, Real py, const PlainOptions& options) const {
    if (options.fused) return std::fma(a, px, std::fma(b, py, c));
    if (options.from_corner) return a * (px - xi_) + b * (py - yi_);
    return a * px + b * py + c;
  }

  Real a, b, c;

 private:
  Real xi_, yi_;
};

// The scene's scissor and culling, which are not these rasterizers' fault.
template <class Covers>
Counts scan(const Target& target, const Draw& draw, bool front, const Covers& covers) {
  Counts counts(sample_total(target));
  if (draw.cull != Cull::none && ((draw.front_face == FrontFace::clockwise) == front) == (draw.cull == Cull::front))
    return counts;
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x) {
      const bool in = covers(x, y);  // before the scissor: it may step
      if (draw.scissor &&
          (x < draw.scissor->x0 || x >= draw.scissor->x1 || y < draw.scissor->y0 || y >= draw.scissor->y1))
        continue;
      const auto first = static_cast<std::size_t>((y * target.width + x) * target.samples);
      for (int n = 0; n < target.samples; ++n) counts[first + static_cast<std::size_t>(n)] = in ? 1 : 0;
    }
  return counts;
}

// Modes and numbers that are no business of these programs are drawn right.
bool plain_draw(const Draw& draw) {
  for (const AttributeArray& attribute : draw.attributes)
    for (const std::uint32_t v : draw.indices) {
      const std::size_t stride = attribute.stride != 0 ? attribute.stride : attribute.components;
      for (std::size_t c = 0; c < attribute.components; ++c)
        if (!std::isfinite(attribute.values[v * stride + c])) return false;
    }
  return draw.conservative == Conservative::none && !draw.grid && draw.depth_mode != DepthMode::clip;
}

// Vertices in front of the eye are divided; the others' triangles, and modes that are no business of these programs,
// are drawn right.
template <class Real>
Status divided(const Target& target, Draws draws, const PlainOptions& options) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Corners v = corners(draw, 0);
    const bool good = std::all_of(v.begin(), v.end(), [](const Vertex& c) {
      return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    });
    if (!plain_draw(draw) || !in_front(v) || !good || t.samples != 1) return right_counts(t, draw);
    Real x[3], y[3];
    for (std::size_t i = 0; i < 3; ++i) x[i] = static_cast<Real>(v[i].x) / static_cast<Real>(v[i].w);
    for (std::size_t i = 0; i < 3; ++i) y[i] = static_cast<Real>(v[i].y) / static_cast<Real>(v[i].w);
    Real area = PlainEdge<Real>(x[0], y[0], x[1], y[1]).at(x[2], y[2], {.from_corner = true});
    if (area == 0) return Counts(sample_total(t));
    const bool front = area > 0;
    if (!front) std::swap(x[1], x[2]), std::swap(y[1], y[2]), area = -area;
    const PlainEdge<Real> edges[3] = {{x[1], y[1], x[2], y[2]}, {x[2], y[2], x[0], y[0]}, {x[0], y[0], x[1], y[1]}};
    Real row[3], e[3];
    for (int i = 0; i < 3; ++i) e[i] = row[i] = edges[i].at(Real(0.5), Real(0.5), options);
    return scan(t, draw, front, [&](int px, int py) {
      const Real sx = static_cast<Real>(px) + Real(0.5), sy = static_cast<Real>(py) + Real(0.5);
      bool in = true;
      Real sum = 0;
      for (int i = 0; i < 3; ++i) {
        Real value = edges[i].at(sx, sy, options);
        if (options.incremental || options.rows_not_reset) {
          if (px == 0 && py > 0) {
            row[i] += edges[i].b;
            e[i] = options.rows_not_reset ? e[i] + edges[i].b : row[i];
          }
          value = e[i];
          e[i] += edges[i].a;
        }
        if (options.reciprocal || options.third_weight) value *= 1 / area;
        if (options.third_weight && i == 2) value = 1 - sum;
        sum += value;
        in = in && (value > 0 || (value == 0 && owns(edges[i].a, edges[i].b, draw.fill_rule)));
      }
      return in;
    });
  });
}

// E = a px + b py + c of Olano and Greer, any W, in Real.
template <class Real>
Status homogeneous(const Target& target, Draws draws, const PlainOptions& options) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    const Corners v = corners(draw, 0);
    const bool good = std::all_of(v.begin(), v.end(), [](const Vertex& c) {
      return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && std::isfinite(c.w);
    });
    if (!plain_draw(draw) || !good || t.samples != 1) return right_counts(t, draw);
    struct {
      Real a, b, c;
    } e[3];
    const auto r = [](float f) { return static_cast<Real>(f); };
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &j = v[(i + 1) % 3], &k = v[(i + 2) % 3];
      if (options.fused)
        e[i] = {std::fma(r(j.y), r(k.w), -(r(j.w) * r(k.y))), std::fma(r(j.w), r(k.x), -(r(j.x) * r(k.w))),
                std::fma(r(j.x), r(k.y), -(r(j.y) * r(k.x)))};
      else
        e[i] = {r(j.y) * r(k.w) - r(j.w) * r(k.y), r(j.w) * r(k.x) - r(j.x) * r(k.w),
                r(j.x) * r(k.y) - r(j.y) * r(k.x)};
    }
    const Real d = e[0].a * r(v[0].x) + e[0].b * r(v[0].y) + e[0].c * r(v[0].w);
    if (d == 0) return Counts(sample_total(t));
    const Real sign = d > 0 ? Real(1) : Real(-1);
    return scan(t, draw, d > 0, [&](int px, int py) {
      const Real sx = static_cast<Real>(px) + Real(0.5), sy = static_cast<Real>(py) + Real(0.5);
      return std::all_of(std::begin(e), std::end(e), [&](const auto& edge) {
        const Real value = sign * (edge.a * sx + edge.b * sy + edge.c);
        return value > 0 || (value == 0 && owns(sign * edge.a, sign * edge.b, draw.fill_rule));
      });
    });
  });
}

// Positions in fixed point of `bits` fraction bits, edges in Integer, which wraps where it is too narrow. Positions
// that are not on the grid are drawn right: the fault is the range.
template <class Integer>
Status fixed_point(const Target& target, Draws draws, int bits) {
  using Bits = std::make_unsigned_t<Integer>;
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Corners v = corners(draw, 0);
    Integer x[3], y[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double fx = std::ldexp(static_cast<double>(v[i].x) / static_cast<double>(v[i].w), bits),
                   fy = std::ldexp(static_cast<double>(v[i].y) / static_cast<double>(v[i].w), bits);
      const bool fits = v[i].w > 0 && std::abs(fx) < 0x1p40 && std::abs(fy) < 0x1p40 && fx == std::floor(fx) &&
                        fy == std::floor(fy) && std::isfinite(v[i].z);
      if (!plain_draw(draw) || t.samples != 1 || !fits) return right_counts(t, draw);
      x[i] = wrapped<Integer>(fx), y[i] = wrapped<Integer>(fy);
    }
    const auto times = [](Integer p, Integer q) {
      return static_cast<Bits>(static_cast<std::uint64_t>(p) * static_cast<std::uint64_t>(q));
    };
    const auto minus = [](Integer p, Integer q) {
      return static_cast<Integer>(static_cast<Bits>(static_cast<Bits>(p) - static_cast<Bits>(q)));
    };
    const auto edge = [&](std::size_t i, std::size_t j, Integer px, Integer py) {
      const Bits first = times(minus(y[i], y[j]), minus(px, x[i])), second = times(minus(x[j], x[i]), minus(py, y[i]));
      return static_cast<Integer>(static_cast<Bits>(first + second));
    };
    const Integer area = edge(0, 1, x[2], y[2]);
    if (area == 0) return Counts(sample_total(t));
    if (area < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]);
    return scan(t, draw, area > 0, [&](int px, int py) {
      const Integer sx = wrapped<Integer>(std::ldexp(px + 0.5, bits)),
                    sy = wrapped<Integer>(std::ldexp(py + 0.5, bits));
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const Integer value = edge(i, j, sx, sy);
        if (value < 0 || (value == 0 && !owns(minus(y[i], y[j]), minus(x[j], x[i]), draw.fill_rule))) return false;
      }
      return true;
    });
  });
}

// Row by row, between the two edges that cross it: ends in 16.16, `rounded_ends` snaps the vertices' rows to whole
// pixels and keeps the slope.
Status scan_lines(const Target& target, Draws draws, bool rounded_ends, int extra_rows) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Corners v = corners(draw, 0);
    for (Vertex& c : v) c = {c.x / c.w, c.y / c.w, c.z, c.w};
    const Box b = box_of({Vertex{v[0].x, v[0].y, 0, 1}, Vertex{v[1].x, v[1].y, 0, 1}, Vertex{v[2].x, v[2].y, 0, 1}});
    const bool fits = b.x0 > -16384 && b.x1 < 16384 && b.y0 > -16384 && b.y1 < 16384 && std::isfinite(v[0].z) &&
                      std::isfinite(v[1].z) && std::isfinite(v[2].z);
    if (!plain_draw(draw) || !in_front(v) || !fits || t.samples != 1) return right_counts(t, draw);
    const bool front = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[1].y - v[0].y) * (v[2].x - v[0].x) > 0;
    std::sort(v.begin(), v.end(), [](const Vertex& p, const Vertex& q) { return p.y < q.y; });
    const auto at_row = [&](const Vertex& p, const Vertex& q, float row) {
      if (p.y == q.y) return p.x;
      const auto slope = static_cast<std::int64_t>((q.x - p.x) / (q.y - p.y) * 65536);
      const float start = rounded_ends ? std::round(p.y) : p.y;
      return p.x + static_cast<float>(slope) / 65536 * (row - start);
    };
    return scan(t, draw, front, [&](int px, int py) {
      const float row = static_cast<float>(py) + 0.5f, column = static_cast<float>(px) + 0.5f;
      if (row < v[0].y || row >= v[2].y + static_cast<float>(extra_rows)) return false;
      const float longest = at_row(v[0], v[2], row);
      const float shorter = row < v[1].y ? at_row(v[0], v[1], row) : at_row(v[1], v[2], row);
      return column >= std::min(longest, shorter) && column < std::max(longest, shorter);
    });
  });
}

// Ties by the side of a point far away (-1, -2.5).
Status far_point(const Target& target, Draws draws) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Corners v = corners(draw, 0);
    for (Vertex& c : v) c = {c.x / c.w, c.y / c.w, c.z, c.w};
    if (!plain_draw(draw) || !in_front(v) || t.samples != 1 || !std::isfinite(v[0].x + v[1].x + v[2].x) ||
        !std::isfinite(v[0].y + v[1].y + v[2].y) || !std::isfinite(v[0].z + v[1].z + v[2].z))
      return right_counts(t, draw);
    const auto edge = [&](std::size_t i, double px, double py) {
      const Vertex &a = v[i], &b = v[(i + 1) % 3];
      const double ax = a.x, ay = a.y;
      return (b.x - ax) * (py - ay) - (b.y - ay) * (px - ax);
    };
    const double area = edge(0, v[2].x, v[2].y), sign = area > 0 ? 1 : -1;
    if (area == 0) return Counts(sample_total(t));
    return scan(t, draw, area > 0, [&](int px, int py) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double e = sign * edge(i, px + 0.5, py + 0.5);
        if (e < 0 || (e == 0 && !(sign * edge(i, -1, -2.5) > 0))) return false;
      }
      return true;
    });
  });
}

constexpr Specimen kSpecimens[] = {
    {"float-edges", "float32 edge functions after the division", "facebookresearch/DRTK#9", "partition-delaunay",
     [](const Target& t, Draws d) { return divided<float>(t, d, {}); }},
    {"float-edges-from-corner", "float32 edge functions from one corner: not antisymmetric", "facebookresearch/DRTK#9",
     "partition-delaunay", [](const Target& t, Draws d) { return divided<float>(t, d, {.from_corner = true}); }},
    {"double-edges", "double edge functions after the division", "", "equality-coverage",
     [](const Target& t, Draws d) { return divided<double>(t, d, {}); }},
    {"double-edges-from-corner", "double edge functions after the division, from one corner", "", "order",
     [](const Target& t, Draws d) { return divided<double>(t, d, {.from_corner = true}); }},
    {"float-fused", "float32 edge functions, contracted to fused multiply-add", "pygfx#1321, renew#229", "order",
     [](const Target& t, Draws d) { return divided<float>(t, d, {.fused = true}); }},
    {"float-incremental", "float32 edge functions, stepped from sample to sample", "gogpu/gg#127", "partition-delaunay",
     [](const Target& t, Draws d) { return divided<float>(t, d, {.incremental = true}); }},
    {"double-incremental", "double edge functions, stepped from sample to sample", "gogpu/gg#127", "equality-wide",
     [](const Target& t, Draws d) { return divided<double>(t, d, {.incremental = true}); }},
    {"rows-not-reset", "the row accumulator goes on from the last row's end", "teaching code", "partition-quads",
     [](const Target& t, Draws d) { return divided<double>(t, d, {.rows_not_reset = true}); }},
    {"reciprocal-weights", "weights by a float32 reciprocal of the area", "", "partition-delaunay",
     [](const Target& t, Draws d) { return divided<float>(t, d, {.reciprocal = true}); }},
    {"third-weight", "the third weight is 1 - b1 - b2, in double", "teaching code", "partition-quads",
     [](const Target& t, Draws d) { return divided<double>(t, d, {.third_weight = true}); }},
    {"float-homogeneous", "homogeneous edge functions in float32", "", "partition-delaunay",
     [](const Target& t, Draws d) { return homogeneous<float>(t, d, {}); }},
    {"double-homogeneous", "homogeneous edge functions in double, no ladder: wrong by a last bit of 53", "",
     "equality-coverage", [](const Target& t, Draws d) { return homogeneous<double>(t, d, {}); }},
    {"fused-homogeneous", "homogeneous coefficients by fused multiply-add: shared edges differ", "", "octants",
     [](const Target& t, Draws d) { return homogeneous<float>(t, d, {.fused = true}); }},
    {"fixed-16-bit", "12.4 positions, edge functions in 16 bits", "Adafruit-GFX#164, #219", "partition-quads",
     [](const Target& t, Draws d) { return fixed_point<std::int16_t>(t, d, 4); }},
    {"fixed-32-bit-8", "24.8 positions, edge functions in 32 bits", "SwiftShader 25333a3a9", "equality-wide",
     [](const Target& t, Draws d) { return fixed_point<std::int32_t>(t, d, 8); }},
    {"fixed-32-bit-4", "28.4 positions, edge functions in 32 bits", "SwiftShader bd85ab2", "equality-wide",
     [](const Target& t, Draws d) { return fixed_point<std::int32_t>(t, d, 4); }},
    {"scan-lines", "spans between edges in 16.16", "keeperfx#4668", "partition-delaunay",
     [](const Target& t, Draws d) { return scan_lines(t, d, false, 0); }},
    {"scan-lines-rounded-ends", "ends rounded to whole rows, slopes not", "connorslade/mslicer#37",
     "partition-t-junctions", [](const Target& t, Draws d) { return scan_lines(t, d, true, 0); }},
    {"scan-lines-one-row-more", "the height of a segment plus 1", "ssloy/tinyrenderer#32", "partition-quads",
     [](const Target& t, Draws d) { return scan_lines(t, d, false, 1); }},
    {"far-point", "ties by the side of a far point, through which edges may run", "PortableGL", "partition-quads",
     far_point},
};

}  // namespace

std::span<const Specimen> arithmetic_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
