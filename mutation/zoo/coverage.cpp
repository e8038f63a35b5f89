// SPDX-License-Identifier: Apache-2.0
//
// Faults of coverage: the fill rule, the eye, drop-outs, boxes and blocks, the place of the sample, range.
#include <limits>

#include "mutation/zoo/tools.hpp"

namespace surefill::zoo {
namespace {

// Counts under several fill rules, joined: where any, or all, of them cover the sample.
Counts joined(const Target& target, Draw draw, std::initializer_list<unsigned> turns, bool any) {
  const FillRule rule = draw.fill_rule;
  Counts result;
  for (const unsigned turn : turns) {
    draw.fill_rule = turned(rule, turn);
    const Counts counts = right_counts(target, draw);
    if (result.empty())
      result = counts;
    else
      for (std::size_t s = 0; s < counts.size(); ++s) result[s] = any ? result[s] | counts[s] : result[s] & counts[s];
  }
  return result;
}

Counts inclusive(const Target& target, const Draw& draw) {
  return joined(target, draw, {0, kMirrorX, kMirrorY, kOpposite}, true);
}
Counts exclusive(const Target& target, const Draw& draw) {
  return joined(target, draw, {0, kMirrorX, kMirrorY, kOpposite}, false);
}

// Pixels of [x0, x1) x [y0, y1) alone, of triangles in front of the eye.
template <class PixelBox>
Status boxed(const Target& target, Draws draws, const PixelBox& pixel_box) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Counts counts = right_counts(t, draw);
    const Corners c = corners(draw, 0);
    if (!in_front(c)) return counts;
    const auto box = pixel_box(box_of(c));
    mask(t, counts, [&box](int x, int y) {
      const auto [x0, y0, x1, y1] = box;
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      return fx >= x0 && fx < x1 && fy >= y0 && fy < y1;
    });
    return counts;
  });
}

// Blocks of size x size pixels in which fewer than `needed` corner pixels are covered lose theirs.
Status blocks_rejected(const Target& target, Draws draws, int size, int needed) {
  return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
    Counts counts = right_counts(t, draw);
    const Counts all = counts;
    const auto covered = [&](int x, int y) {
      x = std::min(x, t.width - 1), y = std::min(y, t.height - 1);
      return all[static_cast<std::size_t>(y * t.width + x) * static_cast<std::size_t>(t.samples)] != 0 ? 1 : 0;
    };
    mask(t, counts, [&](int x, int y) {
      const int x0 = x - x % size, y0 = y - y % size, x1 = x0 + size - 1, y1 = y0 + size - 1;
      return covered(x0, y0) + covered(x1, y0) + covered(x0, y1) + covered(x1, y1) >= needed;
    });
    return counts;
  });
}

Vertex moved(const Vertex& v, float dx, float dy) {
  return {v.x + dx * v.w, v.y + dy * v.w, v.z, v.w};
}

constexpr Specimen kSpecimens[] = {
    // The fill rule.
    {"fill-rule-opposite", "ties go to the other side", "", "small-world-half-pixel",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) { d.fill_rule = turned(d.fill_rule, kOpposite); });
     }},
    {"fill-rule-fixed", "always top left, whatever the rule", "", "mirror",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) { d.fill_rule = FillRule::top_left; });
     }},
    {"closed-as-top-left", "the border of closed shapes goes by the top-left rule", "", "equality-closed-open",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) {
         if (d.fill_rule == FillRule::closed) d.fill_rule = FillRule::top_left;
       });
     }},
    {"open-as-closed", "the border of open shapes is covered", "", "equality-closed-open",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) {
         if (d.fill_rule == FillRule::open) d.fill_rule = FillRule::closed;
       });
     }},
    {"horizontal-edges-swapped", "top edges treated as bottom edges", "SerenityOS#13738", "small-world-half-pixel",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) { d.fill_rule = turned(d.fill_rule, kMirrorY); });
     }},
    {"ties-by-facing", "ties of back faces go to the other side", "", "order",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, Draw draw) {
         if (float_determinant(corners(draw, 0)) < 0) draw.fill_rule = turned(draw.fill_rule, kOpposite);
         return right_counts(t, draw);
       });
     }},
    {"edges-inclusive", "samples on an edge belong to both sides", "KhronosGroup/WebGL#1797, Avocado#18",
     "partition-quads", [](const Target& target, Draws draws) { return with_counts(target, draws, inclusive); }},
    {"edges-exclusive", "samples on an edge belong to neither side (0 < alpha, beta, gamma)", "datashader#1494",
     "partition-quads", [](const Target& target, Draws draws) { return with_counts(target, draws, exclusive); }},
    {"horizontal-edges-inclusive", "samples on a horizontal edge belong to both sides", "accepted by VK-GL-CTS",
     "partition-quads",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         return joined(t, draw, {0, kMirrorY}, true);
       });
     }},
    {"horizontal-edges-exclusive", "samples on a horizontal edge belong to neither side", "accepted by VK-GL-CTS",
     "partition-quads",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         return joined(t, draw, {0, kMirrorY}, false);
       });
     }},
    {"slanted-edges-inclusive", "samples on an edge that is not horizontal belong to both sides", "", "partition-fan",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         return joined(t, draw, {0, kMirrorX}, true);
       });
     }},
    {"touching-vertices-uncovered", "a sample at a vertex is covered by no triangle", "", "partition-fan",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         Counts counts = right_counts(t, draw);
         const Corners c = corners(draw, 0);
         mask(t, counts, [&](int x, int y) {
           const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
           return std::none_of(c.begin(), c.end(),
                               [&](const Vertex& v) { return v.w > 0 && v.x == px * v.w && v.y == py * v.w; });
         });
         return counts;
       });
     }},
    // The eye.
    {"behind-covers", "the part behind the eye is drawn as its mirror image", "", "negation",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         Counts counts = right_counts(t, draw);
         std::vector<Vertex> negated;
         for (const Vertex& v : draw.vertices) negated.push_back({-v.x, -v.y, -v.z, -v.w});
         Draw other = draw;
         other.vertices = negated;
         const Counts behind = right_counts(t, other);
         for (std::size_t s = 0; s < counts.size(); ++s) counts[s] |= behind[s];
         return counts;
       });
     }},
    {"behind-dropped", "a triangle with a vertex behind the eye is dropped whole",
     "facebookresearch/pytorch3d#345, bullet3#1006", "octants",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) { return !in_front(t); });
     }},
    {"w-zero-dropped", "a triangle with a vertex at infinity is dropped", "", "small-world-homogeneous",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws,
                              [](const Corners& t) { return t[0].w == 0 || t[1].w == 0 || t[2].w == 0; });
     }},
    {"w-zero-behind", "W = 0 counts as behind the eye, ever so slightly", "", "equality-coverage",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) {
         return v.w == 0 ? Vertex{v.x, v.y, v.z, -std::numeric_limits<float>::min()} : v;
       });
     }},
    {"divided", "vertices are divided by W, whatever its sign", "vindar/tgx#47", "partition-all-around",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) {
         return v.w == 0 ? v : Vertex{v.x / v.w, v.y / v.w, v.z / v.w, 1};
       });
     }},
    {"discarded-after-divide", "trivial discard of triangles whose divided vertices all lie left of the target",
     "vindar/tgx#47", "degree-hull",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) { return box_of(t).x1 < 0; });
     }},
    {"culled-after-divide", "facing from divided vertices: wrong with an odd number of them behind the eye",
     "retrofire#3", "degree-hull",
     [](const Target& target, Draws draws) {
       return without(target, draws, [](const Draw& draw, std::size_t t) {
         const Corners c = corners(draw, t);
         const float d = float_determinant(c), divided = d * c[0].w * c[1].w * c[2].w;
         if (draw.cull == Cull::none || in_front(c)) return false;
         const bool front = (divided > 0) == (draw.front_face == FrontFace::clockwise);
         return front == (draw.cull == Cull::front);
       });
     }},
    {"near-plane-cut", "nothing nearer than W = 1/64 is drawn", "", "partition-all-around",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         std::vector<Vertex> inverse(draw.vertices.begin(), draw.vertices.end());
         for (Vertex& v : inverse) v.z = 1.0f / 64;  // then depth is 1 / (64 W) (I1)
         Draw cut = draw;
         cut.vertices = inverse;
         cut.depth_mode = draw.conservative == Conservative::none ? DepthMode::clip : DepthMode::none;
         return right_counts(t, cut);
       });
     }},
    {"collinear-elsewhere", "a degenerate triangle in the draw takes those with two vertices behind the eye with it",
     "ezquake#938", "bad-input",
     [](const Target& target, Draws draws) {
       return without(target, draws, [](const Draw& draw, std::size_t t) {
         const Corners c = corners(draw, t);
         if ((c[0].w < 0) + (c[1].w < 0) + (c[2].w < 0) < 2) return false;
         for (std::size_t other = 0; 3 * other < draw.indices.size(); ++other)
           if (!(std::abs(float_determinant(corners(draw, other))) > 0)) return true;
         return false;
       });
     }},
    // Drop-outs.
    {"small-dropped", "triangles whose box is smaller than a pixel are dropped", "triangle-splatting#24, ppsspp#19748",
     "partition-delaunay",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) {
         const Box b = box_of(t);
         return in_front(t) && (b.x1 - b.x0) * (b.y1 - b.y0) < 1;
       });
     }},
    {"area-dropped", "triangles of less than 10 square pixels are dropped", "accepted by VK-GL-CTS", "partition-quads",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) {
         return in_front(t) && std::abs(float_determinant(t) / (t[0].w * t[1].w * t[2].w)) < 20;
       });
     }},
    {"thin-dropped", "triangles thinner than 2 pixels are dropped", "accepted by VK-GL-CTS, zeux/niagara#40",
     "partition-quads",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) {
         const Box b = box_of(t);
         return in_front(t) && std::min(b.x1 - b.x0, b.y1 - b.y0) < 2;
       });
     }},
    {"determinant-epsilon", "triangles with |D| < 0.01 are dropped: D has no scale", "teaching code", "scale",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) { return std::abs(float_determinant(t)) < 0.01f; });
     }},
    {"determinant-float", "triangles whose D rounds to 0 or overflows in float32 are dropped", "xemu#2510", "scale",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) {
         const float d = float_determinant(t);
         return d == 0 || !std::isfinite(d);
       });
     }},
    {"zero-area-after-rounding", "triangles that vanish when rounded to whole pixels are dropped", "zeux/niagara#40",
     "partition-t-junctions",
     [](const Target& target, Draws draws) {
       return without_corners(target, draws, [](const Corners& t) {
         Corners r = t;
         for (Vertex& v : r) v = {std::round(v.x / v.w), std::round(v.y / v.w), 0, 1};
         return in_front(t) && float_determinant(r) == 0;
       });
     }},
    {"capacity", "a draw has room for 48 triangles; the rest is lost", "facebookresearch/pytorch3d#348", "degree-spot",
     [](const Target& target, Draws draws) {
       return without(target, draws, [](const Draw&, std::size_t t) { return t >= 48; });
     }},
    {"bin-capacity", "a block of 8 x 8 pixels has room for 12 triangles", "facebookresearch/pytorch3d#348",
     "partition-fan",
     [](const Target& target, Draws draws) {
       std::vector<int> used(static_cast<std::size_t>((target.width + 7) / 8 * ((target.height + 7) / 8)));
       return with_counts(target, draws, [&](const Target& t, const Draw& draw) {
         Counts counts = right_counts(t, draw);
         const auto bin = [&](int x, int y) { return static_cast<std::size_t>(y / 8 * ((t.width + 7) / 8) + x / 8); };
         std::vector<int> now = used;
         const Counts all = counts;
         mask(t, counts, [&](int x, int y) {
           const auto first = static_cast<std::size_t>(y * t.width + x) * static_cast<std::size_t>(t.samples);
           if (all[first] != 0) now[bin(x, y)] = used[bin(x, y)] + 1;
           return used[bin(x, y)] < 12;
         });
         used = now;
         return counts;
       });
     }},
    {"degenerate-drawn", "a triangle without area is drawn as the line that it is", "UnityTinyRenderer#10",
     "small-world-homogeneous",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         Counts counts = right_counts(t, draw);
         const Corners c = corners(draw, 0);
         if (!in_front(c) || float_determinant(c) != 0) return counts;
         const Box b = box_of(c);
         for (int y = 0; y < t.height; ++y)
           for (int x = 0; x < t.width; ++x) {
             const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
             const Corners on = {c[0], c[1], Vertex{px, py, 0, 1}};
             if (px >= b.x0 && px <= b.x1 && py >= b.y0 && py <= b.y1 && float_determinant(on) == 0)
               for (int n = 0; n < t.samples; ++n)
                 counts[static_cast<std::size_t>((y * t.width + x) * t.samples + n)] = 1;
           }
         return counts;
       });
     }},
    // Boxes and blocks.
    {"box-rounded", "the box is rounded to whole pixels, not outwards", "OloEngineBase#1050", "partition-delaunay",
     [](const Target& target, Draws draws) {
       return boxed(target, draws, [](const Box& b) {
         return Box{std::round(b.x0), std::round(b.y0), std::round(b.x1) + 1, std::floor(b.y1)};
       });
     }},
    {"box-end-exclusive", "the last column and row of the box are left out", "", "partition-quads",
     [](const Target& target, Draws draws) {
       return boxed(target, draws, [](const Box& b) {
         return Box{std::floor(b.x0), std::floor(b.y0), std::floor(b.x1), std::floor(b.y1)};
       });
     }},
    {"box-16-bit", "the box is kept in 16 bits", "citra#1633, Adafruit-GFX#164", "partition-fan",
     [](const Target& target, Draws draws) {
       return boxed(target, draws, [](const Box& b) {
         const auto narrow = [](float v) {
           return static_cast<float>(static_cast<std::uint16_t>(std::clamp(std::floor(v), -65536.0f, 65535.0f)));
         };
         return Box{narrow(b.x0), narrow(b.y0), narrow(b.x1) + 1, narrow(b.y1) + 1};
       });
     }},
    {"box-of-divided", "the box is that of the divided vertices, also behind the eye", "vindar/tgx#47",
     "partition-all-around",
     [](const Target& target, Draws draws) {
       return with_counts(target, draws, [](const Target& t, const Draw& draw) {
         Counts counts = right_counts(t, draw);
         const Box b = box_of(corners(draw, 0));
         mask(t, counts, [&](int x, int y) {
           const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
           return fx >= b.x0 - 1 && fx <= b.x1 + 1 && fy >= b.y0 - 1 && fy <= b.y1 + 1;
         });
         return counts;
       });
     }},
    {"blocks-by-corners", "a block of 8 x 8 pixels is rejected if none of its corners is covered", "",
     "partition-t-junctions", [](const Target& target, Draws draws) { return blocks_rejected(target, draws, 8, 1); }},
    {"cells-by-corners", "a cell of 2 x 2 pixels is rejected if fewer than two are covered", "", "partition-delaunay",
     [](const Target& target, Draws draws) { return blocks_rejected(target, draws, 2, 2); }},
    {"last-row-missing", "the last row is never drawn", "", "partition-quads",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [&](Draw& d) {
         if (!d.scissor) d.scissor = Scissor{0, 0, target.width, target.height - 1};
       });
     }},
    {"far-columns-missing", "nothing is drawn beyond 2048 pixels", "Mesa llvmpipe 1165ff1", "equality-wide",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [](Draw& d) {
         if (!d.scissor) d.scissor = Scissor{0, 0, 2048, 2048};
       });
     }},
    {"size-dependent", "on targets of an odd width the last column is lost", "", "target-size",
     [](const Target& target, Draws draws) {
       return with_state(target, draws, [&](Draw& d) {
         if (!d.scissor && target.width % 2 != 0) d.scissor = Scissor{0, 0, target.width - 1, target.height};
       });
     }},
    // The place of the sample.
    {"pixel-corner", "samples lie at the pixel's corner", "ppsspp#9681", "depth-is-position",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) { return moved(v, 0.5f, 0.5f); });
     }},
    {"sample-off-by-one", "samples lie 1/256 pixel to the right of the centre", "accepted by VK-GL-CTS",
     "depth-is-position",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) { return moved(v, -1.0f / 256, 0); });
     }},
    {"sample-off-by-2-16", "samples lie 2^-16 pixel below the centre", "", "depth-is-position",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) { return moved(v, 0, -0x1p-16f); });
     }},
    // Range.
    {"guard-band-clamped", "positions beyond 32 pixels are clamped, which bends edges", "", "partition-all-around",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) {
         if (!(v.w > 0)) return v;
         return Vertex{std::clamp(v.x / v.w, -32.0f, 32.0f) * v.w, std::clamp(v.y / v.w, -32.0f, 32.0f) * v.w, v.z,
                       v.w};
       });
     }},
    {"subnormals-flushed", "inputs below 2^-126 are read as 0", "flush to zero, left on", "scale",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](Vertex v) {
         for (float* c : {&v.x, &v.y, &v.z, &v.w})
           if (std::abs(*c) < std::numeric_limits<float>::min()) *c = 0;
         return v;
       });
     }},
    {"half-precision", "positions have 11 bits", "MaskedOcclusionCulling be6a0b3", "split",
     [](const Target& target, Draws draws) {
       return with_vertices(target, draws, [](const Vertex& v) {
         const auto rounded = [](float c) {
           int exponent = 0;
           const float m = std::frexp(c, &exponent);
           return std::isfinite(c) ? std::ldexp(std::nearbyint(m * 2048), exponent - 11) : c;
         };
         return Vertex{rounded(v.x), rounded(v.y), v.z, v.w};
       });
     }},
};

}  // namespace

std::span<const Specimen> coverage_specimens() {
  static constexpr auto kGuarded = of_triangles<kSpecimens>();
  return kGuarded;
}

}  // namespace surefill::zoo
