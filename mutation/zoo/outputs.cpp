// SPDX-License-Identifier: Apache-2.0
//
// Specimens whose fault lies in what a frame may have beyond the plain one: origin, sample places, layers, winding, numbers
// of triangles, depth tests with equality, bias, overlap, touched and their index.
#include <cfloat>
#include <cstdint>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// `change` alters the frame.
template <class Change>
Status with_target(const Target& target, Draws draws, const Change& change) {
  Target changed = target;
  change(changed);
  return right(changed, draws);
}

// The bias' numbers as `change` leaves them.
template <class Change>
Status with_bias(const Target& target, Draws draws, const Change& change) {
  return with_state(target, draws, [&](Draw& draw) {
    if (draw.depth_bias) change(*draw.depth_bias);
  });
}

constexpr Specimen kSpecimens[] = {
    {"origin-ignored", "every tile shows the first one", "", "tiles-of-a-picture",
     [](const Target& t, Draws d) { return with_target(t, d, [](Target& c) { c.origin = {}; }); }},
    {"origin-scissor", "scissors count from the tile's corner, not from the picture's", "", "tiles-of-a-picture",
     [](const Target& t, Draws d) {
       return with_state(t, d, [&](Draw& draw) {
         if (!draw.scissor) return;
         const auto moved = [](int side, int by) {
           return static_cast<int>(std::clamp<std::int64_t>(std::int64_t{side} + by, INT32_MIN, INT32_MAX));
         };
         const Scissor s = *draw.scissor;
         draw.scissor = Scissor{moved(s.x0, t.origin.x), moved(s.y0, t.origin.y), moved(s.x1, t.origin.x),
                                moved(s.y1, t.origin.y)};
       });
     }},
    {"origin-in-float", "vertices are moved to the tile in float32", "seams of tiled rendering", "equality-modes",
     [](const Target& t, Draws d) {
       if (t.origin == Origin{}) return right(t, d);
       std::vector<Draw> changed(d.begin(), d.end());
       for (const Draw& draw : d)
         if (draw.grid || draw.scissor) return right(t, d);
       Target here = t;
       here.origin = {};
       return with_vertices(here, changed, [&](Vertex v) {
         v.x -= static_cast<float>(t.origin.x) * v.w, v.y -= static_cast<float>(t.origin.y) * v.w;
         return v;
       });
     }},
    {"sample-places-standard", "the frame's own sample places are not looked at", "", "equality-modes",
     [](const Target& t, Draws d) { return with_target(t, d, [](Target& c) { c.sample_locations = {}; }); }},
    {"sample-places-flipped", "y of the sample places goes up", "", "equality-modes",
     [](const Target& t, Draws d) {
       std::vector<SampleLocation> places(t.sample_locations.begin(), t.sample_locations.end());
       for (SampleLocation& place : places) place.y = 15 - place.y;
       return with_target(t, d, [&](Target& c) { c.sample_locations = places; });
     }},
    {"less-equal-is-less", "of equal depths the earlier one stays, whatever the test", "", "equality-modes",
     [](const Target& t, Draws d) {
       return with_target(t, d, [](Target& c) {
         if (c.depth_test == DepthTest::less_equal) c.depth_test = DepthTest::less;
         if (c.depth_test == DepthTest::greater_equal) c.depth_test = DepthTest::greater;
       });
     }},
    {"bias-ignored", "depth has no bias", "", "equality-modes",
     [](const Target& t, Draws d) { return with_state(t, d, [](Draw& draw) { draw.depth_bias.reset(); }); }},
    {"bias-without-slope", "the slope has no part in the bias", "", "equality-modes",
     [](const Target& t, Draws d) { return with_bias(t, d, [](DepthBias& bias) { bias.slope = 0; }); }},
    {"bias-rounded-twice", "depth is rounded, and then the bias is added", "", "equality-modes",
     [](const Target& t, Draws d) {
       for (const Draw& draw : d)
         if (!draw.depth_bias || draw.depth_bias->slope != 0 || draw.depth_mode != DepthMode::none) return right(t, d);
       if (d.size() != 1 || t.depth.empty() || t.layers != 1 || !t.initial_depth.empty()) return right(t, d);
       const float constant = d[0].depth_bias->constant;
       const Status status = with_state(t, d, [](Draw& draw) { draw.depth_bias.reset(); });
       for (float& z : t.depth)
         if (std::isfinite(z)) z = std::clamp(z + constant, -FLT_MAX, FLT_MAX) + 0.0f;
       return status;
     }},
    {"layers-all-first", "each layer is the first one", "", "layers-peel",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       const std::size_t total = sample_total(t);
       for (std::size_t i = total; i < t.index.size(); ++i) t.index[i] = t.index[i % total];
       for (std::size_t i = total; i < t.depth.size(); ++i) t.depth[i] = t.depth[i % total];
       return status;
     }},
    {"layers-lose-ties", "of equal depths a sample keeps one layer", "depth peeling with a strict test", "layers-peel",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       const std::size_t total = sample_total(t);
       if (status != Status::ok || t.layers == 1 || t.index.empty() || t.depth.empty()) return status;
       for (std::size_t s = 0; s < total; ++s) {
         std::size_t to = s;
         for (std::size_t from = s; from < t.index.size(); from += total) {
           const bool again = to > s && t.index[from] != kNoTriangle && t.depth[from] == t.depth[to - total];
           if (again) continue;
           t.index[to] = t.index[from], t.depth[to] = t.depth[from];
           to += total;
         }
         const std::size_t last = s + (static_cast<std::size_t>(t.layers) - 1) * total;
         for (; to <= last; to += total) t.index[to] = kNoTriangle, t.depth[to] = t.depth[last];
       }
       return status;
     }},
    {"winding-unsigned", "the winding counts back faces like front faces", "", "polygon-winding",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (t.winding.empty()) return status;
       Target counted;
       counted.width = t.width, counted.height = t.height, counted.samples = t.samples;
       counted.origin = t.origin, counted.sample_locations = t.sample_locations;
       Counts counts(sample_total(t));
       counted.count = counts;
       std::vector<Draw> plain(d.begin(), d.end());
       for (Draw& draw : plain) draw.covered = draw.visible = {}, draw.attributes = {};
       if (right(counted, plain) != Status::ok) return status;
       for (std::size_t s = 0; s < counts.size(); ++s) t.winding[s] = static_cast<std::int32_t>(counts[s]);
       return status;
     }},
    {"winding-by-screen", "the front face is the clockwise one, whatever the draw says", "", "equality-modes",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (t.winding.empty()) return status;
       Target again = t;
       again.count = again.index = {}, again.depth = again.barycentrics = {}, again.attributes = {};
       again.layers = 1;
       std::vector<Draw> changed(d.begin(), d.end());
       for (Draw& draw : changed) {
         draw.covered = draw.visible = {};
         if (draw.cull == Cull::none) draw.front_face = FrontFace::clockwise;
       }
       return right(again, changed);
     }},
    {"covered-is-visible", "the covered number of a triangle is the visible one", "", "numbers-add-up",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (const Draw& draw : d)
         if (!draw.visible.empty() && !draw.covered.empty())
           std::copy(draw.visible.begin(), draw.visible.end(), draw.covered.begin());
       return status;
     }},
    {"visible-of-all-layers", "a triangle is visible in any layer", "", "numbers-add-up",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       if (status != Status::ok || t.layers == 1 || t.index.empty() || d.size() != 1) return status;
       const Draw& draw = d[0];
       for (std::size_t p = 0; p < draw.visible.size(); ++p) {
         const std::uint32_t own =
             draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(p) : draw.identifiers[p];
         draw.visible[p] = static_cast<std::uint64_t>(std::count(t.index.begin(), t.index.end(), own));
       }
       return status;
     }},
    {"overlap-is-over", "a pixel that a border only touches overlaps", "", "equality-modes",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.conservative == Conservative::overlap) draw.conservative = Conservative::over;
       });
     }},
    {"touched-drops-degenerate", "a degenerate triangle touches nothing", "rasterio all_touched on lines",
     "equality-modes",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.conservative == Conservative::touched) draw.conservative = Conservative::over;
       });
     }},
    {"touched-degenerate-is-front", "a degenerate triangle faces front", "", "equality-modes",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.conservative != Conservative::touched || draw.cull == Cull::none || 3 != draw.indices.size()) return;
         const Corners c = corners(draw, 0);
         if (float_determinant(c) == 0) draw.cull = draw.cull == Cull::front ? Cull::back : Cull::front;
       });
     }},
    {"conservative-index-last", "of several triangles in a pixel the largest index stays", "", "equality-modes",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       const bool conservative =
           std::any_of(d.begin(), d.end(), [](const Draw& draw) { return draw.conservative != Conservative::none; });
       if (status != Status::ok || !conservative || t.index.empty()) return status;
       std::fill(t.index.begin(), t.index.end(), kNoTriangle);
       for (const Draw& one : one_by_one(d)) {
         const Counts counts = right_counts(t, one);
         const std::uint32_t own = one.identifiers.empty() ? one.first_index : one.identifiers[0];
         for (std::size_t s = 0; s < counts.size(); ++s)
           if (counts[s] != 0 && (t.index[s] == kNoTriangle || t.index[s] < own)) t.index[s] = own;
       }
       return status;
     }},
};

}  // namespace

std::span<const Specimen> output_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
