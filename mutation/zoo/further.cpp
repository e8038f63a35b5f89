// SPDX-License-Identifier: Apache-2.0
#include "mutation/zoo/further.hpp"

#include <utility>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {

namespace {

Status moved(const Target& target, Draws draws, float dx, float dy) {
  return with_vertices(target, draws, [dx, dy](Vertex v) {
    v.x += dx * v.w;
    v.y += dy * v.w;
    return v;
  });
}

Status scaled(const Target& target, Draws draws, double lacks) {
  const double x = (target.width - lacks) / target.width, y = (target.height - lacks) / target.height;
  return with_vertices(target, draws, [x, y](Vertex v) {
    v.x = static_cast<float>(v.x * x);
    v.y = static_cast<float>(v.y * y);
    return v;
  });
}

// Positions on whole steps, W kept.
template <class Round>
Status on_steps(const Target& target, Draws draws, float steps, const Round& round) {
  return with_vertices(target, draws, [steps, &round](Vertex v) {
    if (!(v.w > 0) || !(std::abs(v.x / v.w) < 16384) || !(std::abs(v.y / v.w) < 16384)) return v;
    v.x = round(v.x / v.w * steps) / steps * v.w;
    v.y = round(v.y / v.w * steps) / steps * v.w;
    return v;
  });
}

// The samples of one triangle as the triangle moved by four hairs has them: covered by any of these.
Status fat(const Target& target, Draws draws, float hair) {
  return with_counts(target, draws, [hair](const Target& t, const Draw& draw) {
    Counts all = right_counts(t, draw);
    for (const auto& [dx, dy] : {std::pair{hair, 0.0f}, {-hair, 0.0f}, {0.0f, hair}, {0.0f, -hair}}) {
      std::vector<Vertex> vertices(draw.vertices.begin(), draw.vertices.end());
      for (Vertex& v : vertices) v.x += dx * v.w, v.y += dy * v.w;
      Draw other = draw;
      other.vertices = vertices;
      const Counts more = right_counts(t, other);
      for (std::size_t s = 0; s < all.size(); ++s) all[s] = std::max(all[s], more[s]);
    }
    return all;
  });
}

Status masked(const Target& target, Draws draws, bool (*keep)(const Target&, int, int)) {
  return with_counts(target, draws, [keep](const Target& t, const Draw& draw) {
    Counts counts = right_counts(t, draw);
    mask(t, counts, [&](int x, int y) { return keep(t, x, y); });
    return counts;
  });
}

template <class Change>
Status with_depths(const Target& target, Draws draws, const Change& change) {
  const Status status = right(target, draws);
  if (status != Status::ok) return status;
  for (float& z : target.depth) {
    if (std::isfinite(z)) z = change(z);
  }
  return status;
}

constexpr FurtherFault kFaults[] = {
    {"corner-sampled", "samples are taken at the upper left corner of the pixel",
     "pixel centres: three.js, tinyrenderer, RenderHelp", "half a pixel|corner",
     [](const Target& t, Draws d) { return moved(t, d, 0.5f, 0.5f); }},
    {"half-row-low", "the picture stands half a pixel too high", "Direct3D 9 offset in y alone", "half a pixel|half",
     [](const Target& t, Draws d) { return moved(t, d, 0, -0.5f); }},
    {"whole-column", "the picture stands a pixel too far right", "off-by-one in a viewport's origin",
     "a pixel to|one pixel|whole pixel|pixel to the right", [](const Target& t, Draws d) { return moved(t, d, 1, 0); }},
    {"viewport-minus-one", "(width - 1) and (height - 1) in place of width and height",
     "viewport of w - 1: euc, tinyrenderer", "viewport|width - 1|w - 1|too small",
     [](const Target& t, Draws d) { return scaled(t, d, 1); }},
    {"viewport-a-hair", "a viewport that is 0.01 pixels too small", "x 0.9999 so that nothing lies on the border",
     "viewport|too small|scale", [](const Target& t, Draws d) { return scaled(t, d, 0.01); }},
    {"upside-down", "the first row is the bottom one", "y up or down",
     "upside|bottom row|first row|flipped|y axis|mirror|rows",
     [](const Target& t, Draws d) {
       const auto height = static_cast<float>(t.height);
       return with_vertices(t, d, [height](Vertex v) {
         v.y = height * v.w - v.y;
         return v;
       });
     }},
    {"fat-edges", "an epsilon of 1/64 pixel is added outside every edge", "E >= -epsilon: several software renderers",
     "epsilon|both sides|too large|twice|fat|dilat|grow|tolerance",
     [](const Target& t, Draws d) { return fat(t, d, 1.0f / 64); }},
    {"turned-rule", "samples on edges go to the side opposite to the rule's",
     "fill rule by the wrong sign after a y flip", "fill rule|top-left|bottom-right|ties|rule",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) { draw.fill_rule = turned(draw.fill_rule, kOpposite); });
     }},
    {"whole-pixels", "positions are truncated to whole pixels",
     "integer coordinates: GDI, Pillow, OpenCV without shift", "whole pixel|integer|grid of 0|truncat|0 bits",
     [](const Target& t, Draws d) { return on_steps(t, d, 1, [](float v) { return std::trunc(v); }); }},
    {"sixteenths", "positions are rounded to sixteenths of a pixel", "28.4 fixed point", "grid|4 bits|fixed|snap|16",
     [](const Target& t, Draws d) { return on_steps(t, d, 16, [](float v) { return std::nearbyint(v); }); }},
    {"half-precision", "positions go through a number of 11 bits", "mediump or half vertices",
     "half|precision|round|float16|16-bit|bits",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         const auto half = [](float value) {
           int exponent = 0;
           const float part = std::frexp(value, &exponent);
           return std::isfinite(value) ? std::ldexp(std::nearbyint(part * 2048) / 2048, exponent) : value;
         };
         v.x = half(v.x);
         v.y = half(v.y);
         return v;
       });
     }},
    {"no-small-ones", "triangles whose box is less than a pixel each way are left out",
     "small-triangle culling too eager", "small|tiny|sub-pixel|subpixel|box",
     [](const Target& t, Draws d) {
       return without_corners(t, d, [](const Corners& c) {
         if (!in_front(c)) return false;
         const Box box = box_of(c);
         return box.x1 - box.x0 < 1 && box.y1 - box.y0 < 1;
       });
     }},
    {"no-thin-ones", "triangles whose box is less than half a pixel high are left out",
     "scanline loop that rounds both ends", "thin|small|flat|high|height|sliver|box",
     [](const Target& t, Draws d) {
       return without_corners(t, d, [](const Corners& c) {
         if (!in_front(c)) return false;
         const Box box = box_of(c);
         return box.y1 - box.y0 < 0.5f;
       });
     }},
    {"one-sided", "faces that turn away are never drawn", "double-sided materials ignored",
     "back|cull|facing|counter|one side",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.cull == Cull::none) draw.cull = draw.front_face == FrontFace::clockwise ? Cull::back : Cull::front;
       });
     }},
    {"culls-the-other", "front and back are taken for each other", "front face convention after a mirror",
     "cull|facing|front|winding",
     [](const Target& t, Draws d) {
       return with_state(t, d, [](Draw& draw) {
         if (draw.cull != Cull::none) draw.cull = draw.cull == Cull::front ? Cull::back : Cull::front;
       });
     }},
    {"scissor-closed", "the scissor's last row and column are drawn, too",
     "inclusive rectangle taken for a half-open one", "scissor",
     [](const Target& t, Draws d) {
       return with_state(t, d, [&t](Draw& draw) {
         if (!draw.scissor) return;
         draw.scissor->x1 = std::min(draw.scissor->x1 + 1, t.width);
         draw.scissor->y1 = std::min(draw.scissor->y1 + 1, t.height);
       });
     }},
    {"scissor-from-below", "the scissor is counted from the bottom row", "OpenGL scissor in a y-down target", "scissor",
     [](const Target& t, Draws d) {
       return with_state(t, d, [&t](Draw& draw) {
         if (!draw.scissor) return;
         const int y0 = draw.scissor->y0, y1 = draw.scissor->y1;
         draw.scissor->y0 = t.height - y1;
         draw.scissor->y1 = t.height - y0;
       });
     }},
    {"last-of-equals", "of equal depths the later triangle is seen", "LEQUAL: zauonlok, RenderHelp",
     "equal|later|last|tie",
     [](const Target& t, Draws d) {
       // Where the depth that is seen is a later triangle's, too, that one's index.
       const std::size_t total = sample_total(t);
       std::vector<float> seen_depth(total), depth(total);
       std::vector<std::uint32_t> index(total);
       Target whole = t, alone;
       if (whole.depth.empty()) whole.depth = seen_depth;
       const Status status = right(whole, d);
       if (status != Status::ok || t.index.empty()) return status;
       alone.width = t.width, alone.height = t.height, alone.samples = t.samples, alone.depth_test = t.depth_test;
       alone.index = index, alone.depth = depth;
       for (const Draw& one : one_by_one(d)) {
         if (right(alone, {&one, 1}) != Status::ok) continue;
         for (std::size_t s = 0; s < total; ++s) {
           if (index[s] != kNoTriangle && depth[s] == whole.depth[s]) t.index[s] = index[s];
         }
       }
       return status;
     }},
    {"depth-of-16-bits", "depth is kept in 16 bits", "the default depth buffer of many contexts", "depth|16 bits|bits",
     [](const Target& t, Draws d) {
       return with_depths(t, d, [](float z) {
         return z >= 0 && z <= 1 ? static_cast<float>(std::nearbyint(z * 65535.0) / 65535.0) : z;
       });
     }},
    {"depth-minus-one", "depth comes out of -1 to 1, not mapped to 0 to 1", "clip depth of OpenGL in a Direct3D range",
     "depth", [](const Target& t, Draws d) { return with_depths(t, d, [](float z) { return 2 * z - 1; }); }},
    {"always-clamped", "depth is clamped to 0 to 1 where nobody asked for it", "depth clamp left on", "clamp|depth",
     [](const Target& t, Draws d) { return with_depths(t, d, [](float z) { return std::clamp(z, 0.0f, 1.0f); }); }},
    {"affine", "attributes are interpolated without perspective", "PlayStation textures",
     "perspective|affine|noperspective",
     [](const Target& t, Draws d) {
       std::vector<std::vector<AttributeArray>> arrays(d.size());
       std::vector<Draw> changed(d.begin(), d.end());
       for (std::size_t n = 0; n < changed.size(); ++n) {
         arrays[n].assign(d[n].attributes.begin(), d[n].attributes.end());
         for (AttributeArray& array : arrays[n]) {
           if (array.interpolation == Interpolation::perspective) array.interpolation = Interpolation::noperspective;
         }
         changed[n].attributes = arrays[n];
       }
       return right(t, changed);
     }},
    {"weights-turned", "the three barycentrics come in another order",
     "b1, b2, b0: an edge for the vertex opposite to it", "barycentric|order|weights|swapped|rotated|permut",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (std::size_t i = 0; status == Status::ok && i + 2 < t.barycentrics.size(); i += 3) {
         std::swap(t.barycentrics[i], t.barycentrics[i + 1]);
         std::swap(t.barycentrics[i + 1], t.barycentrics[i + 2]);
       }
       return status;
     }},
    {"index-from-one", "indices begin at 1", "0 taken for nothing", "index|identifier|number",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (std::uint32_t& index : t.index) {
         if (status == Status::ok && index != kNoTriangle) ++index;
       }
       return status;
     }},
    {"no-last-row", "the last row is never drawn", "y < height - 1", "row|border|bottom|last|edge of the target",
     [](const Target& t, Draws d) {
       return masked(t, d, [](const Target& target, int, int y) { return y + 1 < target.height; });
     }},
    {"no-last-of-eight", "each eighth column is not drawn", "a loop over tiles that is one short",
     "tile|column|eight|8|block",
     [](const Target& t, Draws d) { return masked(t, d, [](const Target&, int x, int) { return x % 8 != 7; }); }},
    {"behind-is-gone", "triangles with a vertex behind the eye are left out", "no clipping: tinyrenderer, euc",
     "behind|eye|W|near|clip",
     [](const Target& t, Draws d) { return without_corners(t, d, [](const Corners& c) { return !in_front(c); }); }},
    {"behind-is-before", "what is behind the eye is projected as if it were before it", "X / |W|",
     "behind|eye|W|near|clip|sign",
     [](const Target& t, Draws d) {
       return with_vertices(t, d, [](Vertex v) {
         v.w = std::abs(v.w);
         return v;
       });
     }},
    {"counts-of-four-bits", "counts stop at 15", "an overdraw counter that is too narrow",
     "count|15|saturat|bits|overflow",
     [](const Target& t, Draws d) {
       const Status status = right(t, d);
       for (std::uint32_t& count : t.count) {
         if (status == Status::ok) count = std::min(count, 15u);
       }
       return status;
     }},
    {"first-draw-state", "every draw has the state of the first one", "a state cache that is never invalidated",
     "state|first draw|draw",
     [](const Target& t, Draws d) { return with_state(t, d, [&d](Draw& draw) { draw.state() = d.front().state(); }); }},
};

}  // namespace

std::span<const FurtherFault> further_faults() {
  static constexpr auto kGuarded = of_triangles<kFaults>();
  return kGuarded;
}

}  // namespace surefill::zoo
