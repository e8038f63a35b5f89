// SPDX-License-Identifier: Apache-2.0
//
// Faults of frames: order, races, state, several draws, bad input, what is left over from before.
#include <limits>
#include <utility>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// The frame with one draw's state left over from another.
Status stale(const Target& target, Draws draws) {
  thread_local FillRule rule = FillRule::top_left;
  const FillRule left_over = rule;
  if (!draws.empty()) rule = draws.back().fill_rule;
  return with_state(target, draws, [&](Draw& d) { d.fill_rule = left_over; });
}

// Equal depths are settled by whoever comes first; every other frame that is the later triangle.
Status race(const Target& target, Draws draws) {
  thread_local bool other = false;
  other = !other;
  if (!other) return right(target, draws);
  std::vector<Draw> single = one_by_one(draws);
  std::reverse(single.begin(), single.end());
  for (const Draw& draw : draws)
    if (!draw.depth_write || draws.size() > 1) return right(target, draws);
  return right(target, single);
}

// Depth from one triangle and index from another: written apart, without a lock.
Status torn(const Target& target, Draws draws) {
  const Status status = right(target, draws);
  if (status != Status::ok || target.index.empty()) return status;
  std::vector<std::uint32_t> last(target.index.size(), kNoTriangle);
  for (const Draw& draw : one_by_one(draws)) {
    const Counts counts = right_counts(target, draw);
    for (std::size_t s = 0; s < counts.size(); ++s)
      if (counts[s] != 0) last[s] = draw.identifiers.empty() ? draw.first_index : draw.identifiers[0];
  }
  for (std::size_t s = 0; s < last.size(); ++s)
    if (target.index[s] != kNoTriangle && last[s] != kNoTriangle) target.index[s] = last[s];
  return status;
}

// Without initialization: what the buffers held shines through where nothing is drawn.
Status not_cleared(const Target& target, Draws draws) {
  const std::vector<float> before(target.depth.begin(), target.depth.end());
  const Status status = right(target, draws);
  if (status == Status::ok && target.initial_depth.empty())
    for (std::size_t s = 0; s < before.size(); ++s)
      if (std::isinf(target.depth[s])) target.depth[s] = before[s];
  return status;
}

// Attributes in arrays that `change` alters: their values for a number of vertices, and their stride.
template <class Change>
Status with_arrays(const Target& target, Draws draws, const Change& change) {
  std::vector<std::vector<float>> values;
  std::vector<std::vector<AttributeArray>> arrays;
  return with_state(target, draws, [&](Draw& draw) {
    std::vector<AttributeArray>& own = arrays.emplace_back(draw.attributes.begin(), draw.attributes.end());
    for (AttributeArray& a : own) {
      std::vector<float> copy(a.values.begin(), a.values.end());
      change(copy, a.stride, a.components, draw.vertices.size());
      a.values = values.emplace_back(std::move(copy));
    }
    draw.attributes = own;
  });
}

// Until a first bad triangle, and nothing of the draw after it.
Status stops_at_bad_input(const Target& target, Draws draws) {
  return without(target, draws, [](const Draw& draw, std::size_t t) {
    for (std::size_t i = 0; i <= t; ++i)
      if (!std::isfinite(float_determinant(corners(draw, i)))) return true;
    return false;
  });
}

template <class Initial>
Status with_initial_depth(const Target& target, Draws draws, const Initial& change) {
  Target changed = target;
  std::vector<float> initial(target.initial_depth.begin(), target.initial_depth.end());
  for (float& z : initial) z = change(z);
  changed.initial_depth = initial;
  return right(changed, draws);
}

constexpr float kMost = std::numeric_limits<float>::max();

constexpr Specimen kSpecimens[] = {
    {"later-wins", "draws in the opposite order", "", "several-draws",
     [](const Target& t, Draws d) {
       std::vector<Draw> single = one_by_one(d);
       std::reverse(single.begin(), single.end());
       return right(t, single);
     }},
    {"race", "equal depths: every other frame another triangle wins", "nanite-webgpu#1, CudaRaster 1.1", "repeat",
     race},
    {"torn", "depth and index are written apart: the index is the last triangle's", "nanite-webgpu#1", "identifiers",
     torn},
    {"identifiers-ignored", "the index is the position, whatever the caller's identifiers", "", "identifiers",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.identifiers = {}; }); }},
    {"submission-order", "equal depths go to the first submitted, not to the smallest identifier",
     "MaskedOcclusionCulling#16", "identifiers", [](const Target& t, Draws d) { return right(t, one_by_one(d)); }},
    {"first-index-ignored", "every draw counts its triangles from 0", "", "several-draws",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.first_index = 0; }); }},
    {"last-draw-only", "only the last draw is seen", "", "several-draws",
     [](const Target& t, Draws d) { return right(t, d.empty() ? d : d.last(1)); }},
    {"state-of-first-draw", "all draws have the state of the first", "", "frames",
     [](const Target& t, Draws d) {
       return with_state(t, d, [&](Draw& draw) {
         draw.cull = d[0].cull;
         draw.front_face = d[0].front_face;
         draw.scissor = d[0].scissor;
       });
     }},
    {"state-left-over", "the fill rule is that of the frame before", "", "repeat", stale},
    {"depth-not-cleared", "where nothing is drawn, depth is what the buffer held", "", "repeat", not_cleared},
    {"depth-write-ignored", "depth is written with depth write off", "", "depth-write",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.depth_write = true; }); }},
    {"initial-depth-ignored", "initial depth is not there", "", "frames",
     [](const Target& t, Draws d) {
       Target changed = t;
       changed.initial_depth = {};
       return right(changed, d);
     }},
    {"initial-depth-not-strict", "a fragment as deep as the initial depth beats it", "", "frames",
     [](const Target& t, Draws d) {
       if (t.initial_depth.empty()) return right(t, d);
       return with_initial_depth(t, d, [&](float z) {
         return std::isfinite(z) ? std::nextafter(z, t.depth_test == DepthTest::less ? kMost : -kMost) : z;
       });
     }},
    {"initial-depth-nan", "an initial depth of NaN is beaten by all", "", "equality-scene",
     [](const Target& t, Draws d) {
       const float far = t.depth_test == DepthTest::less ? kMost : -kMost;
       if (t.initial_depth.empty()) return right(t, d);
       return with_initial_depth(t, d, [&](float z) { return std::isnan(z) ? far : z; });
     }},
    {"depth-test-fixed", "LESS, whatever the test", "", "reversed-depth",
     [](const Target& t, Draws d) {
       Target changed = t;
       changed.depth_test = DepthTest::less;
       return right(changed, d);
     }},
    {"greater-tie-last", "under GREATER equal depths go to the last triangle", "", "reversed-depth",
     [](const Target& t, Draws d) {
       if (t.depth_test != DepthTest::greater || d.size() != 1 || !d[0].depth_write) return right(t, d);
       std::vector<Draw> single = one_by_one(d);
       std::reverse(single.begin(), single.end());
       return right(t, single);
     }},
    {"cull-ignored", "nothing is culled", "", "front-and-back",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.cull = Cull::none; }); }},
    {"cull-exchanged", "front means back", "OloEngineBase#1106", "degree-hull",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.cull != Cull::none) draw.cull = draw.cull == Cull::front ? Cull::back : Cull::front;
       });
     }},
    {"front-face-ignored", "clockwise is front, always", "", "order",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.front_face = FrontFace::clockwise; });
     }},
    {"scissor-ignored", "the scissor is the target", "", "scissor",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.scissor.reset(); }); }},
    {"scissor-one-wider", "the scissor is closed", "", "tiles",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.scissor && draw.scissor->x1 < kMaxTargetSize) ++draw.scissor->x1;
       });
     }},
    {"scissor-in-blocks", "the scissor is rounded to 2 x 2 pixels", "dolphin#10251", "tiles",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (!draw.scissor || draw.scissor->x1 > kMaxTargetSize) return;
         draw.scissor->x0 &= ~1;
         draw.scissor->x1 = (draw.scissor->x1 + 1) & ~1;
       });
     }},
    {"border-bleeds", "what is clipped at the scissor's border is drawn into its first column",
     "recastnavigation#476, OSGeo/gdal#8437", "tiles",
     [](const Target& t, Draws d) {
       return with_counts(t, d, [](const Target& target, Draw draw) {
         Counts counts = right_counts(target, draw);
         if (!draw.scissor || draw.scissor->x0 < 1 || draw.scissor->x0 >= target.width) return counts;
         const int x0 = draw.scissor->x0--;
         const Counts wider = right_counts(target, draw);
         const auto samples = static_cast<std::size_t>(target.samples);
         for (std::size_t s = samples; s < counts.size(); ++s)
           if (static_cast<int>(s / samples) % target.width == x0) counts[s] |= wider[s - samples];
         return counts;
       });
     }},
    {"box-culls", "a draw with a culling box is never seen", "", "culling-box",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.culling_box) draw.indices = {}, draw.identifiers = {};
       });
     }},
    {"box-corner-culls", "a draw is dropped if the first corner of its culling box lies left of the target", "",
     "culling-box",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.culling_box && (*draw.culling_box)[0].x < 0) draw.indices = {}, draw.identifiers = {};
       });
     }},
    {"nan-as-zero", "what is not finite is read as 0", "", "bad-input",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         for (float* c : {&v.x, &v.y, &v.z, &v.w})
           if (!std::isfinite(*c)) *c = 0;
         return v;
       });
     }},
    {"infinite-as-largest", "an infinity is clamped to the largest float32", "", "bad-input",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         for (float* c : {&v.x, &v.y, &v.z, &v.w})
           if (std::isinf(*c)) *c = std::copysign(kMost, *c);
         return v;
       });
     }},
    {"bad-attributes-drawn", "a NaN or an infinity in an attribute is read as 0", "", "bad-input",
     [](const Target& t, Draws d) {
       return with_arrays(t, d, [](std::vector<float>& values, std::uint32_t&, std::uint32_t, std::size_t) {
         for (float& u : values) u = std::isfinite(u) ? u : 0;
       });
     }},
    {"stride-ignored", "attributes are read as if packed", "", "layout",
     [](const Target& t, Draws d) {
       return with_arrays(t, d, [](auto&, std::uint32_t& stride, std::uint32_t, std::size_t) { stride = 0; });
     }},
    {"stride-zero", "a stride of 0 is meant: all vertices have the values of the first", "", "layout",
     [](const Target& t, Draws d) {
       return with_arrays(
           t, d, [](std::vector<float>& values, std::uint32_t& stride, std::uint32_t components, std::size_t vertices) {
             if (stride != 0) return;
             for (std::size_t i = components; i < components * vertices; ++i) values[i] = values[i - components];
           });
     }},
    {"stops-at-bad-input", "the triangles after one that is not finite are lost", "", "bad-input", stops_at_bad_input},
    {"depth-without-index", "depth alone is asked for: the test is forgotten", "", "outputs",
     [](const Target& t, Draws d) {
       if (!t.index.empty() || t.depth.empty()) return right(t, d);
       Target changed = t;
       changed.initial_depth = {};
       return right(changed, d);
     }},
    {"count-of-visible", "counts stop at 1", "", "degree-spot",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (std::uint32_t& count : t.count) count = std::min(count, 1u);
       return status;
     }},
    {"count-of-passing", "where nothing is visible, nothing is counted", "", "outputs",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (std::size_t s = 0; s < t.count.size() && !t.index.empty(); ++s)
         if (t.index[s] == kNoTriangle) t.count[s] = 0;
       return status;
     }},
    {"out-of-memory", "gives up", "", "equality-scene", [](const Target&, Draws) { return Status::out_of_memory; }},
};

}  // namespace

std::span<const Specimen> frame_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
