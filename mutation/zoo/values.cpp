// SPDX-License-Identifier: Apache-2.0
//
// Faults of depth, barycentrics and attributes.
#include <limits>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Depth, weights or attributes of covered samples, changed after the fact. Only a frame without initial depth has its
// depth changed, so that nothing else is.
template <class Change>
Status with_depth(const Target& target, Draws draws, const Change& change) {
  const Status status = right(target, draws);
  if (status == Status::ok && target.initial_depth.empty())
    for (float& z : target.depth)
      if (std::isfinite(z)) z = change(z);
  return status;
}

template <class Change>
Status with_attributes(const Target& target, Draws draws, const Change& change) {
  const Status status = right(target, draws);
  if (status != Status::ok) return status;
  for (const AttributeTarget& attribute : target.attributes)
    for (float& value : attribute.values) value = change(value);
  return status;
}

// `change` alters the three weights of a sample.
template <class Change>
Status with_weights(const Target& target, Draws draws, const Change& change) {
  const Status status = right(target, draws);
  if (status != Status::ok) return status;
  for (std::size_t i = 0; i + 2 < target.barycentrics.size(); i += 3) {
    float* const b = &target.barycentrics[i];
    if (b[0] != 0 || b[1] != 0 || b[2] != 0) change(b);
  }
  return status;
}

float up(float value) {
  return value == 0 ? value : std::nextafter(value, kInfinity);
}

// Depth in Real, from divided vertices, of triangles in front of the eye: their planes are bent, not their coverage.
// Done where depth decides nothing: a scene of one triangle.
template <class Real>
Status plane_depth(const Target& target, Draws draws, bool weights_first) {
  const Status status = right(target, draws);
  if (status != Status::ok || !target.initial_depth.empty() || target.samples != 1) return status;
  if (draws.size() != 1 || draws[0].indices.size() != 3 || draws[0].grid || draws[0].depth_mode != DepthMode::none)
    return status;
  const Corners v = corners(draws[0], 0);
  if (!in_front(v)) return status;
  const auto r = [](float f) { return static_cast<Real>(f); };
  Real x[3], y[3], z[3];
  for (std::size_t i = 0; i < 3; ++i) x[i] = r(v[i].x) / r(v[i].w);
  for (std::size_t i = 0; i < 3; ++i) y[i] = r(v[i].y) / r(v[i].w);
  for (std::size_t i = 0; i < 3; ++i) z[i] = r(v[i].z) / r(v[i].w);
  const Real area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
  for (std::size_t s = 0; s < target.depth.size(); ++s) {
    if (!std::isfinite(target.depth[s])) continue;
    const auto pixel = static_cast<int>(s);
    const Real px = static_cast<Real>(pixel % target.width) + Real(0.5),
               py = static_cast<Real>(pixel / target.width) + Real(0.5);
    const Real e1 = (px - x[0]) * (y[2] - y[0]) - (py - y[0]) * (x[2] - x[0]),
               e2 = (x[1] - x[0]) * (py - y[0]) - (y[1] - y[0]) * (px - x[0]);
    if (weights_first) {
      const Real b1 = e1 / area, b2 = e2 / area, b0 = 1 - b1 - b2;
      target.depth[s] = static_cast<float>(b0 * z[0] + b1 * z[1] + b2 * z[2]) + 0.0f;
    } else {
      target.depth[s] = static_cast<float>(z[0] + (e1 * (z[1] - z[0]) + e2 * (z[2] - z[0])) / area) + 0.0f;
    }
  }
  return status;
}

template <class Change>
Status with_interpolation(const Target& target, Draws draws, const Change& change) {
  std::vector<std::vector<AttributeArray>> arrays;
  arrays.reserve(draws.size());
  return with_state(target, draws, [&](Draw& d) {
    std::vector<AttributeArray>& own = arrays.emplace_back(d.attributes.begin(), d.attributes.end());
    for (AttributeArray& a : own) a.interpolation = change(a.interpolation);
    d.attributes = own;
  });
}

constexpr Specimen kSpecimens[] = {
    {"depth-one-ulp", "depth is one unit in the last place too large", "", "depth-is-position",
     [](const Target& t, Draws d) { return with_depth(t, d, up); }},
    {"depth-truncated", "depth is cut to 24 bits after the point, not rounded", "PS2Recomp#139", "equality-depth",
     [](const Target& t, Draws d) {
       return with_depth(t, d, [](float z) { return std::trunc(z * 0x1p24f) / 0x1p24f + 0.0f; });
     }},
    {"depth-16-bit", "depth is stored in 16 bits", "", "equality-depth",
     [](const Target& t, Draws d) {
       return with_depth(t, d, [](float z) { return std::nearbyint(z * 65535) / 65535 + 0.0f; });
     }},
    {"depth-biased", "a bias of 2^-20 that nobody asked for", "", "depth-is-position",
     [](const Target& t, Draws d) { return with_depth(t, d, [](float z) { return z + 0x1p-20f; }); }},
    {"depth-remapped-twice", "z := z / 2 + 1 / 2 a second time", "OloEngineBase#1105", "depth-is-position",
     [](const Target& t, Draws d) { return with_depth(t, d, [](float z) { return z / 2 + 0.5f; }); }},
    {"depth-minus-zero", "a depth of 0 is stored as -0", "", "depth-clip",
     [](const Target& t, Draws d) { return with_depth(t, d, [](float z) { return z == 0 ? -0.0f : z; }); }},
    {"depth-subnormals-flushed", "depths below 2^-126 are stored as 0", "flush to zero, left on", "equality-depth",
     [](const Target& t, Draws d) {
       return with_depth(t, d, [](float z) { return std::abs(z) < std::numeric_limits<float>::min() ? 0.0f : z; });
     }},
    {"depth-float-plane", "depth by a float32 plane equation", "", "equality-depth",
     [](const Target& t, Draws d) { return plane_depth<float>(t, d, false); }},
    {"depth-not-constant", "a constant depth varies: float32 weights that do not add up to 1",
     "PCSX2#2980, bevy_mod_outline#26", "depth-is-position",
     [](const Target& t, Draws d) { return plane_depth<float>(t, d, true); }},
    {"depth-double-plane", "depth by a double plane equation, rounded twice", "", "equality-depth",
     [](const Target& t, Draws d) { return plane_depth<double>(t, d, false); }},
    {"clip-as-clamp", "depth clipping clamps", "", "depth-clip",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.depth_mode == DepthMode::clip) draw.depth_mode = DepthMode::clamp;
       });
     }},
    {"clamp-ignored", "depth clamping does nothing", "", "attribute-range",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.depth_mode == DepthMode::clamp) draw.depth_mode = DepthMode::none;
       });
     }},
    {"clip-scaled", "depth clipping keeps up to 1 + 2^-20", "", "equality-depth",
     [](const Target& t, Draws d) {
       for (const Draw& draw : d)
         if (draw.depth_mode != DepthMode::clip) return right(t, d);
       return with_vertices(t, d, [](const Vertex& v) { return Vertex{v.x, v.y, v.z * (1 - 0x1p-20f), v.w}; });
     }},
    {"affine", "perspective attributes are interpolated on the screen", "zesterer/euc#5, DECA#198",
     "interpolation-routes",
     [](const Target& t, Draws d) {
       return with_interpolation(
           t, d, [](Interpolation i) { return i == Interpolation::perspective ? Interpolation::noperspective : i; });
     }},
    {"noperspective-ignored", "every attribute is perspective", "", "equality-attributes",
     [](const Target& t, Draws d) {
       return with_interpolation(
           t, d, [](Interpolation i) { return i == Interpolation::noperspective ? Interpolation::perspective : i; });
     }},
    {"flat-interpolated", "flat attributes are interpolated", "", "equality-attributes",
     [](const Target& t, Draws d) {
       return with_interpolation(
           t, d, [](Interpolation i) { return i == Interpolation::flat ? Interpolation::perspective : i; });
     }},
    {"attribute-one-ulp", "attributes are one unit in the last place too large", "", "attribute-range",
     [](const Target& t, Draws d) { return with_attributes(t, d, up); }},
    {"attribute-half", "attributes are stored in 11 bits", "", "attributes-are-positions",
     [](const Target& t, Draws d) {
       return with_attributes(t, d, [](float u) {
         int exponent = 0;
         const float m = std::frexp(u, &exponent);
         return std::isfinite(u) ? std::ldexp(std::nearbyint(m * 2048), exponent - 11) : u;
       });
     }},
    {"attribute-approximate", "attributes by an approximate reciprocal: 2^-23 too small", "pygfx#1321",
     "attributes-are-positions",
     [](const Target& t, Draws d) { return with_attributes(t, d, [](float u) { return u * (1 - 0x1p-23f); }); }},
    {"attribute-infinite", "an attribute beyond range becomes infinite", "", "attribute-range",
     [](const Target& t, Draws d) {
       return with_attributes(t, d, [](float u) {
         return std::abs(u) == std::numeric_limits<float>::max() ? std::copysign(kInfinity, u) : u;
       });
     }},
    {"weights-exchanged", "barycentrics in another order", "", "order",
     [](const Target& t, Draws d) { return with_weights(t, d, [](float* b) { std::swap(b[0], b[1]); }); }},
    {"weights-noisy", "barycentrics off by 0.2 percent", "barely caught by VK-GL-CTS", "interpolation-routes",
     [](const Target& t, Draws d) {
       return with_weights(t, d, [](float* b) { b[0] = std::min(1.0f, b[0] * 1.002f); });
     }},
    {"weight-by-difference", "b0 is 1 - b1 - b2 in float32", "teaching code", "interpolation-routes",
     [](const Target& t, Draws d) { return with_weights(t, d, [](float* b) { b[0] = 1 - b[1] - b[2]; }); }},
    {"weight-one-ulp", "b1 alone is one unit in the last place too large", "", "interpolation-routes",
     [](const Target& t, Draws d) { return with_weights(t, d, [](float* b) { b[1] = b[1] < 1 ? up(b[1]) : b[1]; }); }},
    {"weights-nan", "the barycentrics of a triangle that covers one sample are NaN", "facebookresearch/pytorch3d#460",
     "attribute-range",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (status != Status::ok || t.index.empty() || t.barycentrics.empty()) return status;
       for (std::size_t s = 0; s < t.index.size(); ++s)
         if (t.index[s] != kNoTriangle && std::count(t.index.begin(), t.index.end(), t.index[s]) == 1)
           for (std::size_t i = 0; i < 3; ++i) t.barycentrics[3 * s + i] = std::numeric_limits<float>::quiet_NaN();
       return status;
     }},
    {"origin-dependent", "depth is computed relative to the target's corner, in float32", "Vulkan-Portability#54",
     "translation",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (status != Status::ok || !t.initial_depth.empty()) return status;
       for (std::size_t s = 0; s < t.depth.size(); ++s) {
         const auto x = static_cast<float>(static_cast<int>(s / static_cast<std::size_t>(t.samples)) % t.width);
         if (std::isfinite(t.depth[s])) t.depth[s] = (t.depth[s] + x) - x + 0.0f;
       }
       return status;
     }},
};

}  // namespace

std::span<const Specimen> value_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
