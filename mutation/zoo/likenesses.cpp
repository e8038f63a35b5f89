// SPDX-License-Identifier: Apache-2.0
//
// Further ways to be wrong, of which naming knows: no property has a duty to reject them, so they are not in the matrix.
// Most are the right image of another draw.
#include <optional>
#include <utility>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {

namespace {

// The draws with the corners of each triangle its own, so that they can be changed one by one; attributes with them.
class Apart {
 public:
  explicit Apart(Draws draws) : changed_(draws.begin(), draws.end()), vertices_(draws.size()), indices_(draws.size()) {
    arrays_.resize(draws.size());
    values_.resize(draws.size());
    for (std::size_t d = 0; d < draws.size(); ++d) {
      const Draw& draw = draws[d];
      for (const std::uint32_t index : draw.indices) {
        indices_[d].push_back(static_cast<std::uint32_t>(vertices_[d].size()));
        vertices_[d].push_back(draw.vertices[index]);
      }
      for (const AttributeArray& array : draw.attributes) {
        const std::size_t stride = array.stride == 0 ? array.components : array.stride;
        std::vector<float>& values = values_[d].emplace_back();
        for (const std::uint32_t index : draw.indices) {
          for (std::size_t c = 0; c < array.components; ++c) values.push_back(array.values[index * stride + c]);
        }
        arrays_[d].push_back({{}, array.components, 0, array.interpolation});
      }
    }
  }

  std::size_t draws() const { return changed_.size(); }
  std::vector<Vertex>& vertices(std::size_t d) { return vertices_[d]; }
  std::vector<AttributeArray>& arrays(std::size_t d) { return arrays_[d]; }
  std::vector<float>& values(std::size_t d, std::size_t k) { return values_[d][k]; }

  Status render(const Target& target) {
    for (std::size_t d = 0; d < changed_.size(); ++d) {
      changed_[d].vertices = vertices_[d];
      changed_[d].indices = indices_[d];
      for (std::size_t k = 0; k < arrays_[d].size(); ++k) arrays_[d][k].values = values_[d][k];
      changed_[d].attributes = arrays_[d];
    }
    return right(target, changed_);
  }

 private:
  std::vector<Draw> changed_;
  std::vector<std::vector<Vertex>> vertices_;
  std::vector<std::vector<std::uint32_t>> indices_;
  std::vector<std::vector<AttributeArray>> arrays_;
  std::vector<std::vector<std::vector<float>>> values_;
};

// `change(corners)` alters the three vertices of each triangle.
template <class Change>
Status with_corners(const Target& target, Draws draws, const Change& change) {
  Apart apart(draws);
  for (std::size_t d = 0; d < apart.draws(); ++d) {
    for (std::size_t i = 0; i + 2 < apart.vertices(d).size(); i += 3) change(apart.vertices(d).data() + i);
  }
  return apart.render(target);
}

// Attribute values that are those of the corner `from[i]` of the triangle; flat ones alone, or all.
Status with_attributes_of(const Target& target, Draws draws, const std::array<std::size_t, 3>& from, bool flat_alone) {
  Apart apart(draws);
  for (std::size_t d = 0; d < apart.draws(); ++d) {
    for (std::size_t k = 0; k < apart.arrays(d).size(); ++k) {
      const AttributeArray& array = apart.arrays(d)[k];
      if (flat_alone && array.interpolation != Interpolation::flat) continue;
      std::vector<float>& values = apart.values(d, k);
      const std::vector<float> before = values;
      const std::size_t n = array.components;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t corner = i / n, triangle = corner / 3;
        values[i] = before[(3 * triangle + from[corner % 3]) * n + i % n];
      }
    }
  }
  return apart.render(target);
}

Status with_interpolation(const Target& target, Draws draws, Interpolation all) {
  Apart apart(draws);
  for (std::size_t d = 0; d < apart.draws(); ++d) {
    for (AttributeArray& array : apart.arrays(d)) array.interpolation = all;
  }
  return apart.render(target);
}

// Triangles one after the other, each over what is there, or under it, whatever its depth.
Status painted(const Target& target, Draws draws, bool over) {
  const Status status = right(target, draws);
  if (status != Status::ok || target.index.empty()) return status;
  const std::size_t total = sample_total(target);
  std::vector<std::uint32_t> index(total);
  std::vector<float> depth(target.depth.size()), weights(target.barycentrics.size());
  std::vector<std::vector<float>> values;
  std::vector<AttributeTarget> attributes(target.attributes.begin(), target.attributes.end());
  for (AttributeTarget& attribute : attributes) {
    values.emplace_back(attribute.values.size());
    attribute.values = values.back();
  }
  std::vector<bool> seen(total, false);
  Target alone = target;
  alone.count = {};
  alone.winding = {};
  alone.initial_depth = {};
  alone.index = index;
  alone.depth = depth;
  alone.barycentrics = weights;
  alone.attributes = attributes;
  for (const Draw& one : one_by_one(draws)) {
    if (right(alone, {&one, 1}) != Status::ok) continue;
    for (std::size_t s = 0; s < total; ++s) {
      if (index[s] == kNoTriangle || (seen[s] && !over)) continue;
      seen[s] = true;
      target.index[s] = index[s];
      if (!target.depth.empty()) target.depth[s] = depth[s];
      for (std::size_t i = 0; i < 3 && !target.barycentrics.empty(); ++i) {
        target.barycentrics[3 * s + i] = weights[3 * s + i];
      }
      for (std::size_t k = 0; k < attributes.size(); ++k) {
        const std::size_t n = attributes[k].components;
        for (std::size_t c = n * s; c < n * (s + 1); ++c) target.attributes[k].values[c] = values[k][c];
      }
    }
  }
  return status;
}

// Counts of single triangles as a conservative mode has them.
Counts conservative_counts(const Target& target, const Draw& draw, Conservative mode) {
  if (target.samples != 1 || draw.grid || draw.depth_mode != DepthMode::none) return right_counts(target, draw);
  Draw other = draw;
  other.conservative = mode;
  return right_counts(target, other);
}

Status with_conservative(const Target& target, Draws draws, Conservative mode) {
  return with_counts(target, draws,
                     [mode](const Target& t, const Draw& draw) { return conservative_counts(t, draw, mode); });
}

Status with_places(const Target& target, Draws draws, SampleLocation (*change)(SampleLocation)) {
  if (target.samples == 1) return right(target, draws);
  std::vector<SampleLocation> places;
  for (int n = 0; n < target.samples; ++n) places.push_back(change(sample_location(target.samples, n)));
  Target other = target;
  other.sample_locations = places;
  return right(other, draws);
}

template <class Change>
Status with_scissor(const Target& target, Draws draws, const Change& change) {
  return with_state(target, draws, [&](Draw& draw) {
    if (!draw.scissor) return;
    change(*draw.scissor);
    Scissor& r = *draw.scissor;
    r.x0 = std::clamp(r.x0, 0, target.width), r.x1 = std::clamp(r.x1, r.x0, target.width);
    r.y0 = std::clamp(r.y0, 0, target.height), r.y1 = std::clamp(r.y1, r.y0, target.height);
  });
}

Status with_depth_of(const Target& target, Draws draws, std::size_t corner) {
  return with_corners(target, draws, [corner](Vertex* v) {
    const float z = v[corner].z / v[corner].w;
    for (std::size_t i = 0; i < 3; ++i) v[i].z = z * v[i].w;
  });
}

std::size_t triangles_of(const Draw& draw) {
  return draw.indices.size() / 3;
}

// The box of each triangle in front of the eye, whole pixels, begins so much further right and down and ends so much earlier.
Status with_box(const Target& target, Draws draws, int left, int top, int right_end, int bottom) {
  return with_counts(target, draws, [=](const Target& t, const Draw& draw) {
    Counts counts = right_counts(t, draw);
    const Corners c = corners(draw, 0);
    if (!in_front(c)) return counts;
    const Box box = box_of(c);
    mask(t, counts, [&](int x, int y) {
      return static_cast<float>(x) >= std::floor(box.x0) + static_cast<float>(left) &&
             static_cast<float>(y) >= std::floor(box.y0) + static_cast<float>(top) &&
             static_cast<float>(x) <= std::floor(box.x1) - static_cast<float>(right_end) &&
             static_cast<float>(y) <= std::floor(box.y1) - static_cast<float>(bottom);
    });
    return counts;
  });
}

// Positions of so many bits after the point, kept in so many all in all: they wrap.
Status with_wrapped(const Target& target, Draws draws, int bits, int all) {
  return with_vertices(target, draws, [bits, all](Vertex v) {
    const double steps = std::ldexp(1.0, bits), range = std::ldexp(1.0, all);
    if (!(v.w > 0) || !std::isfinite(v.x) || !std::isfinite(v.y)) return v;
    const auto wrap = [&](double value) {
      const double k = std::floor(value * steps + 0.5);
      return (k - range * std::floor(k / range + 0.5)) / steps;
    };
    if (std::abs(v.x / v.w) >= range / steps / 2) v.x = static_cast<float>(wrap(double{v.x} / v.w) * v.w);
    if (std::abs(v.y / v.w) >= range / steps / 2) v.y = static_cast<float>(wrap(double{v.y} / v.w) * v.w);
    return v;
  });
}

Vertex mirrored(const Target& t, Vertex v, bool x, bool y) {
  if (x) v.x = static_cast<float>(t.width) * v.w - v.x;
  if (y) v.y = static_cast<float>(t.height) * v.w - v.y;
  return v;
}

constexpr Specimen kLikenesses[] = {
    {"", "the last triangle of a draw is lost", "", "",
     [](const Target& t, Draws d) {
       return without(t, d, [](const Draw& draw, std::size_t n) { return n + 1 == triangles_of(draw); });
     }},
    {"", "the first triangle of a draw is lost", "", "",
     [](const Target& t, Draws d) { return without(t, d, [](const Draw&, std::size_t n) { return n == 0; }); }},
    {"", "only the first triangle of a draw is drawn", "", "",
     [](const Target& t, Draws d) { return without(t, d, [](const Draw&, std::size_t n) { return n != 0; }); }},
    {"", "every second triangle of a draw is lost", "", "",
     [](const Target& t, Draws d) { return without(t, d, [](const Draw&, std::size_t n) { return n % 2 == 1; }); }},
    {"", "only the first draw of a frame is drawn", "", "",
     [](const Target& t, Draws d) { return right(t, d.first(std::min<std::size_t>(d.size(), 1))); }},
    {"", "the picture is mirrored: left is right, x goes the other way", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [&t](Vertex v) { return mirrored(t, v, true, false); });
     }},
    {"", "the picture is upside down: y goes the other way, its first row is the bottom one", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [&t](Vertex v) { return mirrored(t, v, false, true); });
     }},
    {"", "the picture is turned by half a circle: x and y go the other way", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [&t](Vertex v) { return mirrored(t, v, true, true); });
     }},
    {"", "x and y are exchanged: the picture is transposed", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         std::swap(v.x, v.y);
         return v;
       });
     }},
    {"", "positions are not divided by W: there is no perspective", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         v.z /= v.w;
         v.w = 1;
         return v;
       });
     }},
    {"", "the sign of W is lost: what is behind the eye is projected as if it were before it", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         v.w = std::abs(v.w);
         return v;
       });
     }},
    {"", "vertices beyond the target are moved to its border", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [&t](Vertex v) {
         if (!(v.w > 0)) return v;
         v.x = std::clamp(v.x / v.w, 0.0f, static_cast<float>(t.width)) * v.w;
         v.y = std::clamp(v.y / v.w, 0.0f, static_cast<float>(t.height)) * v.w;
         return v;
       });
     }},
    {"", "triangles that reach beyond the target are lost", "", "",
     [](const Target& t, Draws d) {
       return without_corners(t, d, [&t](const Corners& c) {
         if (!in_front(c)) return true;
         const Box box = box_of(c);
         return box.x0 < 0 || box.y0 < 0 || box.x1 > static_cast<float>(t.width) || box.y1 > static_cast<float>(t.height);
       });
     }},
    {"", "depth is Z, and not divided by W", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         v.z *= v.w;
         return v;
       });
     }},
    {"", "depth is 1 / W, not Z / W", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         v.z = 1;
         return v;
       });
     }},
    {"", "depth is that of vertex 0, and not interpolated", "", "",
     [](const Target& t, Draws d) { return with_depth_of(t, d, 0); }},
    {"", "depth is that of vertex 2, the last one, and not interpolated", "", "",
     [](const Target& t, Draws d) { return with_depth_of(t, d, 2); }},
    {"", "depth is the mean of the three vertices', and not interpolated", "", "",
     [](const Target& t, Draws d) {
       return with_corners(t, d, [](Vertex* v) {
         const float z = (v[0].z / v[0].w + v[1].z / v[1].w + v[2].z / v[2].w) / 3;
         for (std::size_t i = 0; i < 3; ++i) v[i].z = z * v[i].w;
       });
     }},
    {"", "flat attributes are those of vertex 2, the last one (the provoking vertex)", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {2, 0, 1}, true); }},
    {"", "flat attributes are those of vertex 1 (the provoking vertex)", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {1, 2, 0}, true); }},
    {"", "attributes are those of another vertex: in the order 1, 2, 0", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {1, 2, 0}, false); }},
    {"", "attributes are those of another vertex: in the order 2, 0, 1", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {2, 0, 1}, false); }},
    {"", "attributes of vertices 1 and 2 are exchanged", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {0, 2, 1}, false); }},
    {"", "attributes of vertices 0 and 1 are exchanged", "", "",
     [](const Target& t, Draws d) { return with_attributes_of(t, d, {1, 0, 2}, false); }},
    {"", "every attribute is flat: not interpolated, vertex 0's", "", "",
     [](const Target& t, Draws d) { return with_interpolation(t, d, Interpolation::flat); }},
    {"", "attributes and barycentrics are interpolated on the screen, without perspective", "", "",
     [](const Target& t, Draws d) {
       const Status status = with_interpolation(t, d, Interpolation::noperspective);
       return status;
     }},
    {"", "the scissor is counted from the bottom row", "", "",
     [](const Target& t, Draws d) {
       return with_scissor(t, d, [&t](Scissor& r) {
         const int y0 = r.y0;
         r.y0 = t.height - r.y1, r.y1 = t.height - y0;
       });
     }},
    {"", "the scissor's last row and column are left out", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { --r.x1, --r.y1; }); }},
    {"", "the scissor begins a row and a column too early", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { --r.x0, --r.y0; }); }},
    {"", "the scissor begins a row and a column too late", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { ++r.x0, ++r.y0; }); }},
    {"", "the scissor stands a pixel too far right and down", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { ++r.x0, ++r.y0, ++r.x1, ++r.y1; }); }},
    {"", "the scissor stands a pixel too far left and up", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { --r.x0, --r.y0, --r.x1, --r.y1; }); }},
    {"", "the scissor begins at the corner of the target, wherever it should", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { r.x0 = r.y0 = 0; }); }},
    {"", "the scissor's size is taken for its end: x1 and y1 are counted from x0 and y0", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [](Scissor& r) { r.x1 += r.x0, r.y1 += r.y0; }); }},
    {"", "the scissor's x and y are exchanged", "", "",
     [](const Target& t, Draws d) {
       return with_scissor(t, d, [](Scissor& r) { std::swap(r.x0, r.y0), std::swap(r.x1, r.y1); });
     }},
    {"", "the scissor ends nothing in y: only its columns count", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [&t](Scissor& r) { r.y0 = 0, r.y1 = t.height; }); }},
    {"", "the scissor ends nothing in x: only its rows count", "", "",
     [](const Target& t, Draws d) { return with_scissor(t, d, [&t](Scissor& r) { r.x0 = 0, r.x1 = t.width; }); }},
    {"", "the scissor of the first draw is that of all", "", "",
     [](const Target& t, Draws d) { return with_state(t, d, [&d](Draw& draw) { draw.scissor = d.front().scissor; }); }},
    {"", "back faces are always culled, whether or not that is asked for", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.cull = draw.cull == Cull::none ? Cull::back : draw.cull; });
     }},
    {"", "front faces are always culled, whether or not that is asked for", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.cull = draw.cull == Cull::none ? Cull::front : draw.cull; });
     }},
    {"", "culling takes back faces away, whichever it should", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.cull = draw.cull == Cull::none ? Cull::none : Cull::back; });
     }},
    {"", "culling takes front faces away, whichever it should", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.cull = draw.cull == Cull::none ? Cull::none : Cull::front; });
     }},
    {"", "with culling on, faces of both sides are culled: nothing is drawn", "", "",
     [](const Target& t, Draws d) {
       return without(t, d, [](const Draw& draw, std::size_t) { return draw.cull != Cull::none; });
     }},
    {"", "depth clipping does nothing: what is beyond 0 to 1 is drawn", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.depth_mode == DepthMode::clip) draw.depth_mode = DepthMode::none;
       });
     }},
    {"", "depth is always clipped to 0 to 1, whether or not that is asked for", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.depth_mode == DepthMode::none) draw.depth_mode = DepthMode::clip;
       });
     }},
    {"", "depth clamping clips: what is beyond 0 to 1 is not drawn", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.depth_mode == DepthMode::clamp) draw.depth_mode = DepthMode::clip;
       });
     }},
    {"", "depth clipping drops whole triangles with a vertex beyond 0 to 1", "", "",
     [](const Target& t, Draws d) {
       return without(t, d, [](const Draw& draw, std::size_t n) {
         const Corners c = corners(draw, n);
         return draw.depth_mode == DepthMode::clip && std::any_of(c.begin(), c.end(), [](const Vertex& v) {
                  return !(v.z >= 0 && v.z <= v.w);
                });
       });
     }},
    {"", "the depth test is the other way round: the farther one is seen", "", "",
     [](const Target& t, Draws d) {
       Target other = t;
       other.depth_test = t.depth_test == DepthTest::less      ? DepthTest::greater
                          : t.depth_test == DepthTest::greater ? DepthTest::less
                                                               : t.depth_test;
       const Status status = right(other, d);
       for (float& z : t.depth) {
         if (status == Status::ok && std::isinf(z)) z = -z;
       }
       return status;
     }},
    {"", "there is no depth test: the last triangle drawn is seen, whatever its depth", "", "",
     [](const Target& t, Draws d) { return painted(t, d, true); }},
    {"", "the first triangle drawn is seen, whatever its depth", "", "",
     [](const Target& t, Draws d) { return painted(t, d, false); }},
    {"", "depth is never written", "", "",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.depth_write = false; }); }},
    {"", "sample places are upside down", "", "",
     [](const Target& t, Draws d) {
       return with_places(t, d, [](SampleLocation at) {
         at.y = static_cast<decltype(at.y)>(at.y == 0 ? 0 : 16 - at.y);
         return at;
       });
     }},
    {"", "sample places are mirrored: left is right", "", "",
     [](const Target& t, Draws d) {
       return with_places(t, d, [](SampleLocation at) {
         at.x = static_cast<decltype(at.x)>(at.x == 0 ? 0 : 16 - at.x);
         return at;
       });
     }},
    {"", "x and y of sample places are exchanged", "", "",
     [](const Target& t, Draws d) {
       return with_places(t, d, [](SampleLocation at) {
         std::swap(at.x, at.y);
         return at;
       });
     }},
    {"", "all samples of a pixel lie at its centre", "", "",
     [](const Target& t, Draws d) {
       return with_places(t, d, [](SampleLocation at) {
         at.x = at.y = 8;
         return at;
       });
     }},
    {"", "each pixel that a triangle touches is drawn", "", "",
     [](const Target& t, Draws d) { return with_conservative(t, d, Conservative::over); }},
    {"", "only pixels that lie whole inside a triangle are drawn", "", "",
     [](const Target& t, Draws d) { return with_conservative(t, d, Conservative::inner); }},
    {"", "only the outline of a triangle is drawn, not its inside", "", "",
     [](const Target& t, Draws d) {
       return with_counts(t, d, [](const Target& target, const Draw& draw) {
         Counts all = right_counts(target, draw);
         const Counts inner = conservative_counts(target, draw, Conservative::inner);
         for (std::size_t s = 0; s < all.size(); ++s) all[s] -= std::min(all[s], inner[s]);
         return all;
       });
     }},
    {"", "the whole box of a triangle is drawn", "", "",
     [](const Target& t, Draws d) {
       return with_counts(t, d, [](const Target& target, const Draw& draw) {
         const Corners c = corners(draw, 0);
         if (!in_front(c) || target.samples != 1) return right_counts(target, draw);
         const Box box = box_of(c);
         Counts all = right_counts(target, draw);
         for (std::size_t s = 0; s < all.size(); ++s) {
           const auto x = static_cast<float>(s % static_cast<std::size_t>(target.width)) + 0.5f;
           const auto y = static_cast<float>(s / static_cast<std::size_t>(target.width)) + 0.5f;
           if (x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1) all[s] = 1;
         }
         return all;
       });
     }},
    {"", "conservative draws cover what they hold whole where they should what they touch, and the reverse", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         draw.conservative = draw.conservative == Conservative::over    ? Conservative::inner
                             : draw.conservative == Conservative::inner ? Conservative::over
                                                                        : draw.conservative;
       });
     }},
    {"", "a triangle with a vertex behind the eye is drawn as if W were its magnitude", "", "",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         if (v.w < 0) v.x = -v.x, v.y = -v.y, v.z = -v.z, v.w = -v.w;
         return v;
       });
     }},
    {"", "the box of a triangle begins a column too late: the first column that it reaches is lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 1, 0, 0, 0); }},
    {"", "the box of a triangle begins a row too late: the first row that it reaches is lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 0, 1, 0, 0); }},
    {"", "the box of a triangle begins a column and a row too late: the first ones that it reaches are lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 1, 1, 0, 0); }},
    {"", "the box of a triangle ends a column too early: the last column that it reaches is lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 0, 0, 1, 0); }},
    {"", "the box of a triangle ends a row too early: the last row that it reaches is lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 0, 0, 0, 1); }},
    {"", "the box of a triangle ends a column and a row too early: the last ones that it reaches are lost", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 0, 0, 1, 1); }},
    {"", "the box of a triangle is a pixel too small on every side", "", "",
     [](const Target& t, Draws d) { return with_box(t, d, 1, 1, 1, 1); }},
    {"", "positions are kept in 16 bits, 8 of them after the point: beyond 128 pixels they wrap", "", "",
     [](const Target& t, Draws d) { return with_wrapped(t, d, 8, 16); }},
    {"", "positions are kept in 16 bits, 4 of them after the point: beyond 2048 pixels they wrap", "", "",
     [](const Target& t, Draws d) { return with_wrapped(t, d, 4, 16); }},
    {"", "every draw has the state of the last one", "", "",
     [](const Target& t, Draws d) {
       return with_state(t, d, [&d](Draw& draw) { draw.state() = d.back().state(); });
     }},
    {"", "a scissor stays on for the draws after it that have none", "", "",
     [](const Target& t, Draws d) {
       std::optional<Scissor> last;
       return with_state(t, d, [&last](Draw& draw) {
         if (draw.scissor) last = draw.scissor;
         draw.scissor = last;
       });
     }},
    {"", "culling stays on for the draws after it that have none", "", "",
     [](const Target& t, Draws d) {
       Cull last = Cull::none;
       return with_state(t, d, [&last](Draw& draw) {
         if (draw.cull != Cull::none) last = draw.cull;
         draw.cull = last;
       });
     }},
    {"", "a triangle without any vertex on the target is lost", "", "",
     [](const Target& t, Draws d) {
       return without_corners(t, d, [&t](const Corners& c) {
         return std::none_of(c.begin(), c.end(), [&t](const Vertex& v) {
           return v.w > 0 && v.x >= 0 && v.y >= 0 && v.x <= static_cast<float>(t.width) * v.w &&
                  v.y <= static_cast<float>(t.height) * v.w;
         });
       });
     }},
};

}  // namespace

std::span<const Specimen> likenesses() {
  static constexpr auto kGuarded = of_triangles<kLikenesses>();
  return kGuarded;
}

}  // namespace surefill::zoo
