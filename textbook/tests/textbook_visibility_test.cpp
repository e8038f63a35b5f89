// SPDX-License-Identifier: Apache-2.0
//
// The visibility algorithms of the textbook against the oracle's image, and the tile codec, which loses nothing.
#include <gmpxx.h>

#include "textbook/tests/textbook_check.hpp"
#include "textbook/tile_codec.hpp"
#include "textbook/visibility.hpp"

namespace surefill::properties {
namespace {

using namespace textbook;

// A handful of triangles in one draw, with the oracle's indices and depths, and the number of fragments at each sample
// that share the smallest stored depth.
struct Crowd {
  int width = 1, height = 1;
  std::vector<std::array<Vertex, 3>> triangles;
  std::vector<std::uint32_t> index;
  std::vector<float> depth;

  void draw_by_oracle() {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const std::array<Vertex, 3>& t : triangles) {
      for (const Vertex& v : t) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.push_back(v);
      }
    }
    index.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    depth.resize(index.size());
    Target target;
    target.width = width, target.height = height;
    target.index = index, target.depth = depth;
    Draw draw;
    draw.vertices = vertices, draw.indices = indices;
    oracle::render(target, {&draw, 1});
  }
};

// The draws of the corpus, without their state; targets of at most so many pixels.
std::vector<Crowd> corpus_crowds(int largest_target, std::size_t most_triangles) {
  std::vector<Crowd> crowds;
  for (const std::string& path : corpus::list_corpus(SUREFILL_CORPUS "/cases")) {
    const corpus::Scene scene = corpus::read_scene_file(path);
    if (scene.width * scene.height > largest_target) continue;
    const corpus::Frame frame(scene, kCountOnly);
    for (const Draw& draw : frame.draws()) {
      Crowd crowd{scene.width, scene.height, {}, {}, {}};
      for (std::size_t i = 0; i + 2 < draw.indices.size(); i += 3) {
        const std::array<Vertex, 3> v{draw.vertices[draw.indices[i]], draw.vertices[draw.indices[i + 1]],
                                      draw.vertices[draw.indices[i + 2]]};
        if (finite(v[0]) && finite(v[1]) && finite(v[2])) crowd.triangles.push_back(v);
      }
      if (crowd.triangles.size() <= most_triangles) crowds.push_back(crowd);
    }
  }
  return crowds;
}

// Triangles of any category, or ones that cut each other: random depths, W of all signs in one of four.
Crowd random_crowd(std::uint64_t n, int size, std::uint32_t triangles) {
  Random random(n * 0x9E3779B97F4A7C15u + 5);
  Crowd crowd;
  crowd.width = random.between(1, size), crowd.height = random.between(1, size);
  const bool any_category = random.one_in(2);
  for (std::uint32_t t = random.below(triangles) + 2; t > 0; --t) {
    std::array<Vertex, 3> v{};
    if (any_category) {
      v = category_of_case(random.below(1000)).triangle(random, crowd.width, crowd.height);
    } else {
      const bool on_lattice = random.one_in(3);
      for (Vertex& m : v) {
        const float w = random.one_in(4) ? static_cast<float>(random.between(-2, 3)) : 1.0f;
        const double x = (random.unit() * 1.6 - 0.3) * crowd.width, y = (random.unit() * 1.6 - 0.3) * crowd.height;
        m.x = static_cast<float>(on_lattice ? std::floor(x) + 0.5 : x),
        m.y = static_cast<float>(on_lattice ? std::floor(y) + 0.5 : y);
        m.z = on_lattice ? static_cast<float>(random.between(0, 4)) : static_cast<float>(random.unit());
        m.w = w;
        if (w > 0) m.x *= w, m.y *= w, m.z *= w;
      }
    }
    if (finite(v[0]) && finite(v[1]) && finite(v[2])) crowd.triangles.push_back(v);
  }
  return crowd;
}

struct DepthTotals {
  std::atomic<std::uint64_t> behind{0}, in_front{0}, plain_reads{0}, reads{0};
};

std::string decide_depth_buffers(Crowd crowd, DepthTotals& totals) {
  crowd.draw_by_oracle();
  for (const bool hierarchical : {false, true}) {
    DepthBuffer buffer(crowd.width, crowd.height, hierarchical);
    for (std::uint32_t t = 0; t < crowd.triangles.size(); ++t) {
      Triangle triangle;
      const std::array<Vertex, 3>& v = crowd.triangles[t];
      if (triangle.set_up(v[0], v[1], v[2])) buffer.draw(triangle, t, FillRule::top_left);
    }
    (hierarchical ? totals.reads : totals.plain_reads) += buffer.counts().depth_reads;
    totals.behind += buffer.counts().tiles_behind;
    totals.in_front += buffer.counts().tiles_in_front;
    if (buffer.index() != crowd.index) return hierarchical ? "indices by hierarchical z" : "indices by z-buffer";
    if (buffer.depth() != crowd.depth) return hierarchical ? "depths by hierarchical z" : "depths by z-buffer";
  }
  return "";
}

TEST(TextbookVisibility, DepthBuffersAreTheOraclesImage) {
  DepthTotals totals;
  for_each_case(textbook_scenes(20'000), [&totals](std::uint64_t n) {
    return decide_depth_buffers(random_crowd(n, n % 8 == 0 ? 40 : 12, n % 8 == 0 ? 24 : 5), totals);
  });
  EXPECT_GT(totals.behind, 0u);
  EXPECT_GT(totals.in_front, 0u);
  EXPECT_LT(totals.reads, totals.plain_reads);
  const std::vector<Crowd> crowds = corpus_crowds(1 << 16, 1000);
  const auto decide = [&](std::uint64_t n) { return decide_depth_buffers(crowds[n], totals); };
  for_each_case(crowds.size(), decide, Cases::corpus);
}

struct PainterTotals {
  std::atomic<std::uint64_t> cuts{0}, compared{0}, ties{0};
};

// At a sample where two fragments share the smallest stored depth, the painter knows the real depths and the z-buffer
// does not. Everywhere else they agree.
std::string decide_painter(Crowd crowd, PainterTotals& totals) {
  crowd.draw_by_oracle();
  std::vector<Piece<mpq_class>> pieces, order;
  std::vector<Triangle> triangles(crowd.triangles.size());
  std::vector<bool> covers_something(crowd.triangles.size());
  for (std::uint32_t t = 0; t < crowd.triangles.size(); ++t) {
    const std::array<Vertex, 3>& v = crowd.triangles[t];
    covers_something[t] = triangles[t].set_up(v[0], v[1], v[2]);
    pieces.push_back(piece_of<mpq_class>(v, t, crowd.width, crowd.height));
  }
  const std::size_t whole = static_cast<std::size_t>(
      std::count_if(pieces.begin(), pieces.end(), [](const Piece<mpq_class>& p) { return p.polygon.size() > 2; }));
  paint_order(std::move(pieces), order);
  totals.cuts += order.size() - whole;
  std::vector<ScreenPolygon<mpq_class>> screens;
  for (const Piece<mpq_class>& piece : order) screens.emplace_back(piece.polygon);
  for (int y = 0; y < crowd.height; ++y) {
    for (int x = 0; x < crowd.width; ++x) {
      const SamplePosition p{x + 0.5, y + 0.5};
      const auto covers = [&](std::size_t t) {
        return covers_something[t] && triangles[t].covers(p, tie_shift(FillRule::top_left));
      };
      std::uint32_t painted = kNoTriangle;  // by the last piece that paints here
      for (std::size_t k = order.size(); k-- > 0 && painted == kNoTriangle;) {
        if (covers(order[k].index) && screens[k].contains(mpq_class(p.x), mpq_class(p.y))) painted = order[k].index;
      }
      const std::size_t s =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(crowd.width) + static_cast<std::size_t>(x);
      int nearest = 0;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (covers(t) && triangles[t].rounded_depth(p) == crowd.depth[s]) ++nearest;
      }
      if (nearest > 1) {
        ++totals.ties;
        continue;
      }
      ++totals.compared;
      if (painted != crowd.index[s]) {
        return "painted " + std::to_string(painted) + ", not " + std::to_string(crowd.index[s]) + " at pixel " +
               std::to_string(x) + ", " + std::to_string(y);
      }
    }
  }
  return "";
}

TEST(TextbookVisibility, ThePainterSeesWhatTheDepthBufferSees) {
  PainterTotals totals;
  for_each_case(textbook_scenes(3'000),
                [&totals](std::uint64_t n) { return decide_painter(random_crowd(n, 8, 5), totals); });
  EXPECT_GT(totals.cuts, textbook_scenes(3'000) / 30);
  EXPECT_GT(totals.compared, 10 * totals.ties);
  const std::vector<Crowd> crowds = corpus_crowds(1 << 10, 32);
  const auto decide = [&](std::uint64_t n) { return decide_painter(crowds[n], totals); };
  for_each_case(crowds.size(), decide, Cases::corpus);
}

struct CodecTotals {
  std::array<std::atomic<std::uint64_t>, 3> used{};
  std::atomic<std::uint64_t> bytes{0}, raw_bytes{0};
};

std::string decide_codec(const DepthTile& depth, const ColourTile& colour, CodecTotals& totals) {
  const std::vector<std::uint8_t> depth_code = encode(depth), colour_code = encode(colour);
  ++totals.used[depth_code[0] % 4];
  totals.bytes += depth_code.size(), totals.raw_bytes += 256;
  const DepthTile depth_back = decode_depth(depth_code);
  for (std::size_t s = 0; s < 64; ++s) {
    if (std::bit_cast<std::uint32_t>(depth_back[s]) != std::bit_cast<std::uint32_t>(depth[s]))
      return "a depth is changed";
  }
  if (decode_colour(colour_code) != colour) return "a colour is changed";
  return depth_code.size() > 257 || colour_code.size() > 260 ? "longer than raw" : "";
}

TEST(TextbookCodec, LosesNothing) {
  CodecTotals totals;
  for_each_case(textbook_scenes(60'000), [&totals](std::uint64_t n) {
    Random random(n);
    DepthTile depth;
    ColourTile colour;
    const double a = random.unit() * 0.01, b = random.unit() * 0.01, c = random.unit();
    const bool negative = random.one_in(2);
    const std::uint64_t kind = n % 4;
    for (std::size_t s = 0; s < 64; ++s) {
      const double z = c + a * static_cast<double>(s % 8) + b * static_cast<double>(s / 8);
      depth[s] = static_cast<float>(kind == 0   ? c
                                    : kind == 1 ? z
                                    : kind == 2 ? (s % 8 < 3 ? z : 2 * z)
                                                : random.unit() - 0.5);
      if (negative) depth[s] = -depth[s];
      if (kind == 3 && random.one_in(8)) depth[s] = std::ldexp(depth[s], random.between(-140, 127));
      if (random.one_in(500)) depth[s] = random.one_in(2) ? std::numeric_limits<float>::infinity() : -0.0f;
      colour[s] = kind == 0   ? 0xFF8040FFu
                  : kind == 1 ? static_cast<std::uint32_t>(s % 8 * 9 + s / 8 * 0x300 + 0x80'0000)
                              : static_cast<std::uint32_t>(random.bits());
    }
    return decide_codec(depth, colour, totals);
  });
  for (const std::atomic<std::uint64_t>& count : totals.used) EXPECT_GT(count, 0u);
  EXPECT_LT(totals.bytes, totals.raw_bytes);

  // The depths and indices of the corpus; tiles at the rim repeat the last row and column.
  std::vector<Crowd> crowds = corpus_crowds(1 << 16, 1000);
  const auto decide = [&](std::uint64_t n) -> std::string {
    Crowd& crowd = crowds[n];
    crowd.draw_by_oracle();
    for (int top = 0; top < crowd.height; top += kCodecTile) {
      for (int left = 0; left < crowd.width; left += kCodecTile) {
        DepthTile depth;
        ColourTile colour;
        for (std::size_t s = 0; s < 64; ++s) {
          const int x = std::min(left + static_cast<int>(s % 8), crowd.width - 1),
                    y = std::min(top + static_cast<int>(s / 8), crowd.height - 1);
          const std::size_t from =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(crowd.width) + static_cast<std::size_t>(x);
          depth[s] = crowd.depth[from], colour[s] = crowd.index[from];
        }
        const std::string found = decide_codec(depth, colour, totals);
        if (!found.empty()) return found;
      }
    }
    return "";
  };
  for_each_case(crowds.size(), decide, Cases::corpus);
}

}  // namespace
}  // namespace surefill::properties
