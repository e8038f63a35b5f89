// SPDX-License-Identifier: Apache-2.0
//
// What asking says of faults of single triangles that are made here, of their values, of vertices and identifiers; and that
// it says nothing of who is right.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "certify/judge/questions.hpp"
#include "oracle/oracle.hpp"

namespace surefill::judge {
namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;

Image right_image(const Scene& scene) {
  corpus::Frame frame(scene, {});
  oracle::render(frame.target(), frame.draws());
  return std::move(frame.image());
}

struct Case {
  const char* says;
  std::string (*ask)(const Questions& questions);
  Image (*draw)(const Scene& scene);
};

// The least x and y of the first triangle, and the largest.
std::array<double, 4> box_of(const Scene& scene) {
  std::array<double, 4> box{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const std::uint32_t k : scene.draws[0].triangles[0].vertices) {
    const SceneVertex& v = scene.draws[0].vertices[k];
    const double x = double{v.x} / v.w, y = double{v.y} / v.w;
    box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
  }
  return box;
}

template <typename Keep>
Image kept(const Scene& scene, const Keep& keep) {
  Image image = right_image(scene);
  for (std::size_t s = 0; s < image.count.size(); ++s) {
    const auto width = static_cast<std::size_t>(scene.width);
    if (!keep(static_cast<int>(s % width), static_cast<int>(s / width))) image.count[s] = 0;
  }
  return image;
}

Image until_an_empty_row(const Scene& scene, bool begun) {
  Image image = right_image(scene);
  bool lost = false;
  const int first = std::max(0, static_cast<int>(std::floor(box_of(scene)[1])));
  for (int y = first; y < scene.height; ++y) {
    const auto begin = image.count.begin() + static_cast<std::ptrdiff_t>(y) * scene.width, end = begin + scene.width;
    if (lost) std::fill(begin, end, 0);
    const bool covered = std::find(begin, end, 1u) != end;
    lost = lost || (begun && !covered);
    begun = begun || covered;
  }
  return image;
}

Image begun_beyond(const Scene& scene) {
  const auto box = box_of(scene);
  Scene moved = scene;
  for (SceneVertex& v : moved.draws[0].vertices) {
    v.x -= static_cast<float>(std::min(0.0, std::floor(box[0]))) * v.w;
    v.y -= static_cast<float>(std::min(0.0, std::floor(box[1]))) * v.w;
  }
  return kept(moved, [&](int x, int y) { return x <= box[2] && y <= box[3]; });
}

// The same counts, and other values: those of the scene as it is cut at W = 1e-5, new vertices half-way in values.
Image cut_half_way(const Scene& scene) {
  Image image = right_image(scene);
  Scene cut = scene;
  SceneDraw& draw = cut.draws[0];
  std::vector<SceneVertex> polygon;
  for (std::size_t i = 0; i < 3; ++i) {
    const SceneVertex &p = draw.vertices[draw.triangles[0].vertices[i]],
                      &q = draw.vertices[draw.triangles[0].vertices[(i + 1) % 3]];
    const double a = p.w - 1e-5, b = q.w - 1e-5;
    if (a >= 0) polygon.push_back(p);
    if ((a >= 0) == (b >= 0)) continue;
    const double t = a / (a - b);
    SceneVertex v = p;
    v.x = static_cast<float>(p.x + t * (q.x - p.x)), v.y = static_cast<float>(p.y + t * (q.y - p.y));
    v.z = static_cast<float>(p.z + t * (q.z - p.z)), v.w = static_cast<float>(p.w + t * (q.w - p.w));
    for (std::size_t k = 0; k < v.attributes.size(); ++k) v.attributes[k] = (p.attributes[k] + q.attributes[k]) / 2;
    polygon.push_back(v);
  }
  if (polygon.size() < 3) return image;
  draw.vertices = polygon;
  draw.triangles = {{{0, 1, 2}, std::nullopt}};
  if (polygon.size() == 4) draw.triangles.push_back({{0, 2, 3}, std::nullopt});
  image.attributes = right_image(cut).attributes;
  return image;
}

// What is between every eighth pixel of a row goes evenly, or what is between the first and the last one.
template <bool kEnds>
Image even_between(const Scene& scene) {
  Image image = right_image(scene);
  const Image right = image;
  for (std::size_t k = 0; k < image.attributes.size(); ++k) {
    const std::size_t n = scene.attributes[k].components, width = static_cast<std::size_t>(scene.width);
    for (std::size_t s = 0; s < image.count.size(); ++s) {
      std::size_t first = s, last = s;
      while (first % width != 0 && image.count[first - 1] != 0) --first;
      while ((last + 1) % width != 0 && image.count[last + 1] != 0) ++last;
      const std::size_t from = kEnds ? first : first + (s - first) / 8 * 8, to = kEnds ? last : from + 8;
      if (image.count[s] == 0 || to > last || from == to) continue;
      for (std::size_t c = 0; c < n; ++c) {
        const double a = right.attributes[k][n * from + c], b = right.attributes[k][n * to + c];
        image.attributes[k][n * s + c] =
            static_cast<float>(a + (b - a) * static_cast<double>(s - from) / static_cast<double>(to - from));
      }
    }
  }
  return image;
}

Image with_centres(const Scene& scene, bool box_alone) {
  Image image = right_image(scene);
  if (scene.samples == 1) return image;
  Scene centres = scene;
  centres.samples = 1;
  Image at_centres = right_image(centres);
  const auto box = box_of(scene);
  for (std::size_t s = 0; s < image.count.size(); ++s) {
    const std::size_t pixel = s / static_cast<std::size_t>(scene.samples),
                      width = static_cast<std::size_t>(scene.width);
    const double x = static_cast<double>(pixel % width) + 0.5, y = static_cast<double>(pixel / width) + 0.5;
    const bool in_box = x >= box[0] && y >= box[1] && x <= box[2] && y <= box[3];
    if (box_alone ? !in_box : at_centres.count[pixel] == 0) image.count[s] = 0;
  }
  return image;
}

// Of the first triangle's edge i, how far (x, y) is on the inner side.
double inner_side(const Scene& scene, std::size_t i, double x, double y) {
  std::array<std::array<double, 2>, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const SceneVertex& v = scene.draws[0].vertices[scene.draws[0].triangles[0].vertices[k]];
    p[k] = {double{v.x} / v.w, double{v.y} / v.w};
  }
  const auto turn = [&p](std::size_t a, double px, double py) {
    const auto &from = p[a], &to = p[(a + 1) % 3];
    return (to[0] - from[0]) * (py - from[1]) - (to[1] - from[1]) * (px - from[0]);
  };
  return turn(i, x, y) * (turn(0, p[2][0], p[2][1]) < 0 ? -1 : 1);
}

// Blocks of 8 x 8 pixels that an edge has these corners outside of are lost.
template <typename Corners>
Image rejected(const Scene& scene, const Corners& corners) {
  return kept(scene, [&](int x, int y) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double bx = x / 8 * 8, by = y / 8 * 8;
      bool outside = true;
      for (const auto& [dx, dy] : corners(i)) outside = outside && inner_side(scene, i, bx + dx, by + dy) < 0;
      if (outside) return false;
    }
    return true;
  });
}

using Places = std::vector<std::array<double, 2>>;
Image rejected_by_two_corners(const Scene& scene) {
  return rejected(scene, [](std::size_t) { return Places{{0, 0}, {8, 8}}; });
}
Image rejected_a_pixel_early(const Scene& scene) {
  return rejected(scene, [](std::size_t) { return Places{{0, 0}, {7, 0}, {0, 7}, {7, 7}}; });
}
// The corner is chosen by which way an edge's inner side lies in x.
Image rejected_by_a(const Scene& scene) {
  return rejected(scene, [&](std::size_t i) {
    const double far = inner_side(scene, i, 1, 0) > inner_side(scene, i, 0, 0) ? 8 : 0;
    return Places{{far, far}};
  });
}

Image twice_in_the_middle(const Scene& scene) {
  Image image = right_image(scene);
  std::array<double, 3> y{};
  for (std::size_t i = 0; i < 3; ++i) y[i] = scene.draws[0].vertices[i].y;
  std::sort(y.begin(), y.end());
  for (std::size_t s = 0; s < image.count.size(); ++s) {
    if (static_cast<double>(s / static_cast<std::size_t>(scene.width)) == std::floor(y[1])) image.count[s] *= 2;
  }
  return image;
}

// Upright edges to the right reach a ten thousandth of the triangle's width further.
Image grown(const Scene& scene) {
  Scene other = scene;
  const auto box = box_of(scene);
  for (SceneVertex& v : other.draws[0].vertices) {
    if (v.x == static_cast<float>(box[2])) v.x += static_cast<float>((box[2] - box[0]) / 10000);
  }
  return right_image(other);
}

// Within a block of 8 x 8 pixels, what says that the triangle was entered is kept from row to row.
Image entered_above(const Scene& scene) {
  Image image = right_image(scene);
  const int first = std::max(0, static_cast<int>(std::floor(box_of(scene)[0])));
  for (int b = 0; b < (scene.width + 7) / 8 * ((scene.height + 7) / 8); ++b) {
    const int x0 = b % ((scene.width + 7) / 8) * 8, y0 = b / ((scene.width + 7) / 8) * 8;
    bool entered = false;
    for (int y = y0; y < std::min(y0 + 8, scene.height); ++y) {
      bool ended = false;
      for (int x = std::max(x0, first); x < std::min(x0 + 8, scene.width); ++x) {
        std::uint32_t& n = image.count[static_cast<std::size_t>(y * scene.width + x)];
        ended = ended || (entered && n == 0);
        entered = entered || n != 0;
        if (ended) n = 0;
      }
    }
  }
  return image;
}

Image masks_of_32_bits(const Scene& scene) {
  Image image = right_image(scene);
  const Image right = image;
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const auto s = static_cast<std::size_t>(y * scene.width + x),
                 below = s + static_cast<std::size_t>(4 * scene.width);
      if (y % 8 >= 4) image.count[s] = 0;
      if (y % 8 < 4 && below < right.count.size()) image.count[s] |= right.count[below];
    }
  }
  return image;
}

// Samples of the pixels at the rim of a block of 8 x 8 that no triangle has a centre of are lost, where triangles are small.
Image rims_lost(const Scene& scene) {
  Image image = right_image(scene);
  const auto box = box_of(scene);
  if (scene.samples != 4 || box[2] - box[0] > 1) return image;
  for (std::size_t s = 0; s < image.count.size(); ++s) {
    const std::size_t width = static_cast<std::size_t>(scene.width), x = s / 4 % width % 8, y = s / 4 / width % 8;
    const SampleLocation at = sample_location(4, static_cast<int>(s % 4));
    if ((x == 0 && at.x < 8) || (x == 7 && at.x > 8) || (y == 0 && at.y < 8) || (y == 7 && at.y > 8))
      image.count[s] = 0;
  }
  return image;
}

// The coarse depth, of one cell, is not set anew where a frame begins with a depth.
Image left_from_before(const Scene& scene) {
  static float farthest = INFINITY;
  Image image = right_image(scene);
  if (scene.depth_test != DepthTest::less) return image;
  if (scene.initial_depth.empty()) farthest = *std::ranges::max_element(image.depth);
  for (std::size_t s = 0; s < image.depth.size(); ++s) {
    if (image.depth[s] > farthest) image.index[s] = kNoTriangle;
  }
  return image;
}

constexpr Case kCases[] = {
    {"rows of depth come as far apart as the width rounded up to a multiple of 8", about_strides,
     [](const Scene& s) {
       Image image = right_image(s);
       const std::vector<float> right = image.depth;
       const auto width = static_cast<std::size_t>(s.width), apart = (width + 7) / 8 * 8;
       for (std::size_t i = 0; i < right.size(); ++i) {
         image.depth[i] = i % apart < width ? right[i / apart * width + i % apart] : INFINITY;
       }
       return image;
     }},
    {"by corners that leave out their last column and row", about_ways_of_filling, rejected_a_pixel_early},
    {"it is chosen by the sign of a for both axes", about_ways_of_filling, rejected_by_a},
    {"the row that a triangle's middle vertex is in is drawn twice", about_ways_of_filling, twice_in_the_middle},
    {"by 0.0001 of their height over an edge", about_growth, grown},
    {"the index counts only triangles that are drawn", about_index,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) {
         std::erase_if(d.triangles, [&d, &s](const corpus::SceneTriangle& t) {
           const auto at = [&](std::size_t i) { return d.vertices[t.vertices[i]]; };
           return (at(1).x == at(2).x && at(1).y == at(2).y) || (at(0).x < 0 && at(1).x < 0) || s.width == 0;
         });
       }
       return right_image(other);
     }},
    {"counts hold what depth clipping takes away", about_depth_modes,
     [](const Scene& s) {
       Image image = right_image(s);
       Scene other = s;
       other.draws[0].depth_mode = DepthMode::none;
       image.count = right_image(other).count;
       return image;
     }},
    {"draws that do not write depth are not seen at all", about_visibility,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) {
         if (!d.depth_write) d.triangles.clear();
       }
       return right_image(other);
     }},
    {"noperspective attributes are wrong, and of others right", about_values_of_cut,
     [](const Scene& s) {
       Image image = right_image(s);
       const auto& v = s.draws[0].vertices;
       if (std::ranges::any_of(v, [](const SceneVertex& c) { return c.w < 0; }) && !s.attributes.empty() &&
           s.attributes[0].interpolation == Interpolation::noperspective) {
         for (float& value : image.attributes[0]) value += 1;
       }
       return image;
     }},
    {"with a depth that is there before the frame, the image depends on the frame before", about_left_before,
     left_from_before},
    {"where depth write is off the depth test is off, too", about_depth_write,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) {
         for (SceneVertex& v : d.vertices) v.z -= d.depth_write ? 0 : 2 * v.w;
       }
       return right_image(other);
     }},
    {"of several draws each one's attributes are interpolated as the first draw says", how_values_come,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) d.interpolations = s.draws[0].interpolations;
       return right_image(other);
     }},
    {"of several draws each one's attributes are interpolated as the last draw says", how_values_come,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) d.interpolations = s.draws.back().interpolations;
       return right_image(other);
     }},
    {"the depth that is there before the frame is read upside down", about_visibility,
     [](const Scene& s) {
       Scene other = s;
       const auto width = static_cast<std::size_t>(s.width);
       for (std::size_t i = 0; i < s.initial_depth.size() && s.samples == 1 && s.initial_depth.size() > 1; ++i) {
         other.initial_depth[i] = s.initial_depth[s.initial_depth.size() - width - i / width * width + i % width];
       }
       return right_image(other);
     }},
    {"indices are not read", about_indices,
     [](const Scene& s) {
       Scene other = s;
       std::uint32_t next = 0;
       for (auto& t : other.draws[0].triangles) {
         for (std::uint32_t& v : t.vertices) v = next++;
       }
       return right_image(other);
     }},
    {"positions are sorted by y, and what belongs to the vertices is not", how_values_come,
     [](const Scene& s) {
       Scene other = s;
       SceneDraw& draw = other.draws[0];
       auto order = draw.triangles[0].vertices;
       const auto y = [&s](std::uint32_t v) { return s.draws[0].vertices[v].y / s.draws[0].vertices[v].w; };
       std::sort(order.begin(), order.end(), [&y](std::uint32_t a, std::uint32_t b) { return y(a) < y(b); });
       for (std::size_t i = 0; i < 3; ++i) {
         draw.vertices[order[i]].attributes = s.draws[0].vertices[draw.triangles[0].vertices[i]].attributes;
       }
       return right_image(other);
     }},
    {"of a triangle only the part below its middle vertex is drawn", about_ways_of_filling,
     [](const Scene& s) {
       std::array<double, 3> y{};
       for (std::size_t i = 0; i < 3; ++i) y[i] = s.draws[0].vertices[i].y;
       std::sort(y.begin(), y.end());
       return kept(s, [&y](int, int row) { return row + 0.5 > y[1]; });
     }},
    {"blocks of 8 x 8 pixels are rejected if their upper left and lower right corners", about_ways_of_filling,
     rejected_by_two_corners},
    {"in blocks of 8 x 8 pixels a row ends before it begins", about_ways_of_filling, entered_above},
    {"a mask of 64 bits is made in 32", about_ways_of_filling, masks_of_32_bits},
    {"rows of a triangle beyond the target's width are lost", about_ways_of_filling,
     [](const Scene& s) { return kept(s, [&s](int, int y) { return y < s.width; }); }},
    {"samples at the rim of blocks of 8 x 8 pixels are lost", about_samples, rims_lost},
    {"a triangle is not counted in blocks of pixels where all is nearer", about_hidden_counts,
     [](const Scene& s) {
       Image image = right_image(s);
       if (box_of(s)[0] < 0) std::fill(image.count.begin(), image.count.end(), 1);
       return image;
     }},
    {"where depth is clipped triangles lack a part", about_depth_modes,
     [](const Scene& s) {
       Image image = right_image(s);
       if (s.draws[0].depth_mode == DepthMode::clip) std::fill(image.count.begin(), image.count.begin() + s.width, 0);
       return image;
     }},
    {"is not taken for level", about_snapped_edges,
     [](const Scene& s) {
       Image image = right_image(s);
       const auto& v = s.draws[0].vertices;
       if (v[0].y != v[1].y) std::fill(image.count.begin() + 5 * 16, image.count.begin() + 6 * 16, 0);
       return image;
     }},
    {"an edge is rounded another way for each of the two", about_shared_edges,
     [](const Scene& s) {
       Scene other = s;
       // Now and then the second triangle's edge is a little beside the first one's.
       for (std::size_t i = 3; i < other.draws[0].vertices.size() && s.draws[0].vertices[0].y > 24; ++i)
         other.draws[0].vertices[i].x += 1e-5f;
       return right_image(other);
     }},
    {"the last tiles of 16 x 16 pixels that a triangle's box reaches are lost", about_ways_of_filling,
     [](const Scene& s) {
       const auto box = box_of(s);
       return kept(s,
                   [&](int x, int y) { return x < 16 * std::floor(box[2] / 16) && y < 16 * std::floor(box[3] / 16); });
     }},
    {"the last column of tiles that a triangle's box reaches, of 64 pixels, is lost", about_ways_of_filling,
     [](const Scene& s) {
       const auto box = box_of(s);
       return kept(s, [&](int x, int) { return x < 64 * std::floor(box[2] / 64); });
     }},
    {"a triangle ends at the first row of its box in which it has no sample", about_ways_of_filling,
     [](const Scene& s) { return until_an_empty_row(s, true); }},
    {"is cut at the target's height in x and at its width in y", about_ways_of_filling,
     [](const Scene& s) { return kept(s, [&s](int x, int y) { return x < s.height && y < s.width; }); }},
    {"edges begin at the corner of a triangle's box", about_reach, begun_beyond},
    {"a triangle wholly behind the eye (all W < 0) is drawn", about_eye,
     [](const Scene& s) {
       Scene turned = s;
       auto& vertices = turned.draws[0].vertices;
       if (std::ranges::all_of(vertices, [](const SceneVertex& v) { return v.w < 0; })) {
         for (SceneVertex& v : vertices) v.x = -v.x, v.y = -v.y, v.z = -v.z, v.w = -v.w;
       }
       return right_image(turned);
     }},
    {"a triangle with a vertex at infinity (W = 0) is not drawn", about_eye,
     [](const Scene& s) {
       Scene less = s;
       if (std::ranges::any_of(s.draws[0].vertices, [](const SceneVertex& v) { return v.w == 0; }))
         less.draws[0].triangles.clear();
       return right_image(less);
     }},
    {"is drawn in the pixel that it lies in, though it covers no sample there", about_tiny,
     [](const Scene& s) {
       Image image = right_image(s);
       const auto box = box_of(s);
       const double x = std::floor(box[0]), y = std::floor(box[1]);
       if (x == std::floor(box[2]) && y == std::floor(box[3]))
         image.count[static_cast<std::size_t>(y * s.width + x)] = 1;
       return image;
     }},
    {"identifiers go through float32", about_index,
     [](const Scene& s) {
       Image image = right_image(s);
       for (std::uint32_t& n : image.index) {
         if (n != kNoTriangle) n = static_cast<std::uint32_t>(std::min(double{static_cast<float>(n)}, 4294967295.0));
       }
       return image;
     }},
    {"identifiers are ignored", about_index,
     [](const Scene& s) {
       Scene other = s;
       for (SceneDraw& d : other.draws) {
         for (auto& t : d.triangles) t.identifier.reset();
       }
       return right_image(other);
     }},
    {"if its number is that one's + 256", about_vertex_cache,
     [](const Scene& s) {
       Scene other = s;
       std::set<std::uint32_t> used;
       for (SceneDraw& d : other.draws) {
         for (auto& t : d.triangles) {
           for (std::uint32_t& v : t.vertices) {
             if (v >= 256 && used.contains(v - 256)) v -= 256;
             used.insert(v);
           }
         }
         used.clear();
       }
       return right_image(other);
     }},
    {"attributes are written where the depth test fails, too", about_visibility,
     [](const Scene& s) {
       Image image = right_image(s);
       if (s.attributes.empty()) return image;
       const float last = s.draws[0].vertices.back().attributes[0];
       std::fill(image.attributes[0].begin(), image.attributes[0].end(), last);
       return image;
     }},
    {"right at every 8-th pixel of a row", how_values_come, even_between<false>},
    {"right at the first and the last pixel of each row of a triangle, and go evenly", how_values_come,
     even_between<true>},
    {"a sample is covered only where the pixel's centre is, too", about_samples,
     [](const Scene& s) { return with_centres(s, false); }},
    {"a triangle's box is that of pixel centres", about_samples, [](const Scene& s) { return with_centres(s, true); }},
    {"triangles smaller than one are lost where they miss its centre", about_samples,
     [](const Scene& s) {
       const auto box = box_of(s);
       const bool small =
           std::floor(box[0] + 0.5) == std::floor(box[2] + 0.5) || std::floor(box[1] + 0.5) == std::floor(box[3] + 0.5);
       Scene other = s;
       if (s.samples > 1 && small) other.draws[0].triangles.clear();
       return right_image(other);
     }},
    {"blocks of 8 x 8 pixels are drawn whole where they are inside a triangle", about_scissor,
     [](const Scene& s) {
       Scene other = s;
       if (auto& r = other.draws[0].scissor)
         r = Scissor{r->x0 / 8 * 8, r->y0 / 8 * 8, (r->x1 + 7) / 8 * 8, (r->y1 + 7) / 8 * 8};
       return right_image(other);
     }},
    {"the scissor is ignored in blocks of pixels that a triangle covers whole", about_scissor,
     [](const Scene& s) {
       Scene other = s;
       if (box_of(s)[3] - box_of(s)[1] > 4) other.draws[0].scissor.reset();
       return right_image(other);
     }},
    {"where a triangle is cut at the eye's plane the attributes of new vertices are half-way", about_values_of_cut,
     cut_half_way},
    {"flat attributes are wrong, and of others right", about_values_of_cut,
     [](const Scene& s) {
       Scene other = s;
       auto& vertices = other.draws[0].vertices;
       if (std::ranges::any_of(vertices, [](const SceneVertex& v) { return v.w < 0; }) && !s.attributes.empty() &&
           s.attributes[0].interpolation == Interpolation::flat) {
         vertices[0].attributes = vertices[1].attributes;
       }
       return right_image(other);
     }},
    {"component 0 of array 1 is number 1 of a vertex, not number 2", about_arrays,
     [](const Scene& s) {
       Image image = right_image(s);
       if (s.attributes.size() == 2 && s.attributes[0].components == 2) {
         for (std::size_t n = 0; n < image.count.size(); ++n)
           image.attributes[1][3 * n] = image.attributes[0][2 * n + 1];
       }
       return image;
     }},
};

TEST(Guesses, SayWhatIsPlanted) {
  const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
  for (const Case& one : kCases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> { return one.draw(scene); };
    Model model;
    if (one.ask == about_snapped_edges) model.x.bits = model.y.bits = 8;
    const std::string said = one.ask({drawn, right, model, false});
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
    EXPECT_EQ(one.ask({right, right, {}, false}), "") << one.says;
  }
}

// Of a frame something is left in the next one: here in the last rows, where rows stand further apart than they are wide.
TEST(Guesses, SayWhatIsNotCleared) {
  std::vector<std::uint32_t> left;
  int width = 0;
  const auto drawn = [&](const Scene& scene) -> std::optional<Image> {
    Image image = right_image(scene);
    if (scene.width == width && left.size() == image.count.size() && scene.samples == 1) {
      for (std::size_t s = 0; s < left.size(); ++s) {
        const auto w = static_cast<std::size_t>(width), stride = (w + 7) / 8 * 8;
        if (s / w * stride + s % w >= left.size()) image.count[s] += left[s];
      }
    }
    width = scene.width;
    left = image.count;
    return image;
  };
  const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
  const std::vector<std::string> sentences = ask({drawn, right, {}, false}, {}).sentences;
  ASSERT_FALSE(sentences.empty());
  EXPECT_NE(
      sentences.front().find("the image is not cleared in the last rows of targets whose width is no multiple of 8"),
      std::string::npos)
      << sentences.front();
}

}  // namespace
}  // namespace surefill::judge
