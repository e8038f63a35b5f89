// SPDX-License-Identifier: Apache-2.0
//
// What asking says of values that come of other places or vertices, and of what one triangle, draw or frame leaves to the next;
// faults that are made here.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

// Each attribute of a block of 2 x 2 pixels is that of its upper left one, beyond the triangle anything; or that of the last one
// that is covered.
template <bool kCovered>
Image of_blocks(const Scene& scene) {
  Image image = right_image(scene);
  const Image right = image;
  const auto width = static_cast<std::size_t>(scene.width);
  for (std::size_t k = 0; k < image.attributes.size(); ++k) {
    const std::size_t n = scene.attributes[k].components;
    for (std::size_t s = 0; s < image.count.size(); ++s) {
      const std::size_t corner = s / width / 2 * 2 * width + s % width / 2 * 2;
      std::size_t from = corner;
      for (const std::size_t other : {corner, corner + 1, corner + width, corner + width + 1}) {
        if (kCovered && right.count[other] != 0) from = other;
      }
      for (std::size_t c = 0; c < n && image.count[s] != 0; ++c) {
        image.attributes[k][n * s + c] = right.count[from] != 0 ? right.attributes[k][n * from + c] : -1;
      }
    }
  }
  return image;
}

// Arrays of three components are read as if they had four.
Image read_as_four(const Scene& scene) {
  Scene other = scene;
  std::size_t first = 0;
  for (const corpus::SceneAttribute& a : scene.attributes) {
    const auto& vertices = scene.draws[0].vertices;
    for (std::size_t at = 0; a.components == 3 && at < 3 * vertices.size(); ++at) {
      const std::size_t from = at / 3 * 4 + at % 3;
      other.draws[0].vertices[at / 3].attributes[first + at % 3] =
          from < 3 * vertices.size() ? vertices[from / 3].attributes[first + from % 3] : 0;
    }
    first += a.components;
  }
  return right_image(other);
}

// What of a row lies left of the target or the scissor is not stepped over.
Image not_stepped_over(const Scene& scene) {
  Image image = right_image(scene);
  const SceneDraw& draw = scene.draws[0];
  const auto v = [&](std::size_t i) { return draw.vertices[draw.triangles[0].vertices[i % 3]]; };
  if (scene.samples != 1 || std::ranges::any_of(draw.vertices, [](const SceneVertex& c) { return c.w != 1; }))
    return image;
  for (std::size_t s = 0; s < image.count.size(); ++s) {
    const auto width = static_cast<std::size_t>(scene.width);
    double x = static_cast<double>(s % width) + 0.5;
    const double y = static_cast<double>(s / width) + 0.5, begin = draw.scissor ? draw.scissor->x0 : 0;
    double left = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
      const SceneVertex p = v(i), q = v(i + 1);
      if ((p.y < y) != (q.y < y)) left = std::min(left, p.x + (y - p.y) / (double{q.y} - p.y) * (double{q.x} - p.x));
    }
    x += std::min(0.0, std::ceil(left - 0.5) - begin);
    std::array<double, 3> e{};
    for (std::size_t i = 0; i < 3; ++i) {
      const SceneVertex p = v(i + 1), q = v(i + 2);
      e[i] = (double{q.x} - p.x) * (y - p.y) - (double{q.y} - p.y) * (x - p.x);
    }
    const auto mixed = [&](const auto& of) {
      return static_cast<float>((e[0] * of(v(0)) + e[1] * of(v(1)) + e[2] * of(v(2))) / (e[0] + e[1] + e[2]));
    };
    if (image.count[s] == 0) continue;
    image.depth[s] = mixed([](const SceneVertex& c) { return c.z; });
    for (std::size_t k = 0; image.attributes.size() == 1 && k < scene.attributes[0].components; ++k) {
      image.attributes[0][scene.attributes[0].components * s + k] =
          mixed([k](const SceneVertex& c) { return c.attributes[k]; });
    }
  }
  return image;
}

double turn_of(const SceneDraw& draw, const corpus::SceneTriangle& t) {
  const auto &a = draw.vertices[t.vertices[0]], &b = draw.vertices[t.vertices[1]], &c = draw.vertices[t.vertices[2]];
  return (double{b.x} - a.x) * (double{c.y} - a.y) - (double{b.y} - a.y) * (double{c.x} - a.x);
}

constexpr Case kCases[] = {
    {"attributes are taken once for each block of 2 x 2 pixels, at its upper left one", how_values_come,
     of_blocks<false>},
    {"the same in all pixels that a triangle has of a block of 2 x 2:", how_values_come, of_blocks<true>},
    {"in triangles with a level edge its two are exchanged", how_values_come,
     [](const Scene& s) {
       Scene other = s;
       auto& v = other.draws[0].vertices;
       for (std::size_t i = 0; i < 3; ++i) {
         if (double{v[i].y} * v[(i + 1) % 3].w != double{v[(i + 1) % 3].y} * v[i].w) continue;
         std::swap(v[i].attributes, v[(i + 1) % 3].attributes);
         break;
       }
       return right_image(other);
     }},
    {"wrong, in triangles with an upright edge (two vertices of one X) alone", how_values_come,
     [](const Scene& s) {
       Image image = right_image(s);
       const auto& v = s.draws[0].vertices;
       const auto one = [&v](std::size_t i, std::size_t k) {
         return double{v[i].x} * v[k].w == double{v[k].x} * v[i].w;
       };
       for (std::size_t i = 0; i < image.depth.size() && (one(0, 1) || one(1, 2) || one(0, 2)); ++i)
         image.depth[i] += 0.01f * static_cast<float>(i % 7 + 1);
       return image;
     }},
    {"without perspective, where two vertices have the same W alone", how_values_come,
     [](const Scene& s) {
       Scene other = s;
       const auto& v = s.draws[0].vertices;
       const bool two = v[0].w == v[1].w || v[1].w == v[2].w || v[0].w == v[2].w;
       for (corpus::SceneAttribute& a : other.attributes) {
         if (two && a.interpolation == Interpolation::perspective) a.interpolation = Interpolation::noperspective;
       }
       return right_image(other);
     }},
    {"attributes of 3 components are read as if they had 4", how_values_come, read_as_four},
    {"attributes of 3 components are wrong, those of other numbers are right", how_values_come,
     [](const Scene& s) {
       Image image = right_image(s);
       for (std::size_t k = 0; k < image.attributes.size(); ++k) {
         const std::uint32_t n = s.attributes[k].components;
         for (std::size_t i = 0; n == 3 && i < image.attributes[k].size(); ++i)
           image.attributes[k][i] += static_cast<float>(i % 5);
       }
       return image;
     }},
    {"begin left of the target or its scissor attributes and depths are those of another place: what of a row",
     about_values_of_cut, not_stepped_over},
    {"the triangle that comes after one that is culled is lost", about_triangles_before,
     [](const Scene& s) {
       Scene other = s;
       SceneDraw& d = other.draws[0];
       for (std::size_t t = 0; t + 1 < d.triangles.size(); ++t) {
         const bool culled = d.cull == Cull::back && turn_of(d, s.draws[0].triangles[t]) < 0;
         if (culled) d.triangles[t + 1].vertices = {0, 0, 0};
       }
       return right_image(other);
     }},
    {"after one with a vertex behind the eye have an index that is 1 too large", about_triangles_before,
     [](const Scene& s) {
       Image image = right_image(s);
       const SceneDraw& d = s.draws[0];
       for (std::uint32_t& n : image.index) {
         if (n == kNoTriangle) continue;
         for (std::size_t t = n; t > 0; --t) {
           n += std::ranges::count_if(d.triangles[t - 1].vertices, [&d](auto v) { return d.vertices[v].w < 0; }) == 1;
         }
       }
       return image;
     }},
    {"it writes the coarse depth of blocks, though not depth", about_depth_write,
     [](const Scene& s) {
       Image image = right_image(s);
       if (s.draws[0].depth_write || s.draws[0].vertices[1].x < 8) return image;
       Scene first = s;
       first.draws.resize(1);
       image.index = right_image(first).index;
       return image;
     }},
    {"the depth that is there before the frame is read inside the first draw's scissor alone", about_visibility,
     [](const Scene& s) {
       Scene other = s;
       const auto samples = static_cast<std::size_t>(s.samples), width = static_cast<std::size_t>(s.width);
       if (s.initial_depth.size() == 1)
         other.initial_depth.assign(width * static_cast<std::size_t>(s.height) * samples, s.initial_depth[0]);
       for (std::size_t i = 0; i < other.initial_depth.size() && s.draws[0].scissor; ++i) {
         const Scissor& r = *s.draws[0].scissor;
         const int x = static_cast<int>(i / samples % width), y = static_cast<int>(i / samples / width);
         if (x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1)
           other.initial_depth[i] = s.depth_test == DepthTest::less ? INFINITY : -INFINITY;
       }
       return right_image(other);
     }},
};

TEST(Values, AreSaidWhereTheyComeOf) {
  const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
  for (const Case& one : kCases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> { return one.draw(scene); };
    const std::string said = one.ask({drawn, right, {}, false});
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
    EXPECT_EQ(one.ask({right, right, {}, false}), "") << one.says;
  }
}

// After a frame whose last draw does not write depth, the next one's depth is not cleared: the clear goes through the mask.
TEST(Values, SayWhichStateKeepsDepthFromBeingCleared) {
  Image left;
  bool masked = false;
  const auto drawn = [&](const Scene& scene) -> std::optional<Image> {
    Scene other = scene;
    if (masked && scene.width == left.width && scene.height == left.height && scene.samples == left.samples &&
        scene.initial_depth.empty())
      other.initial_depth = left.depth;
    masked = !scene.draws.back().depth_write;
    left = right_image(other);
    return left;
  };
  const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
  const std::vector<std::string> sentences = ask({drawn, right, {}, true}, {}).sentences;
  ASSERT_FALSE(sentences.empty());
  EXPECT_NE(sentences.front().find("after a frame whose last draw has depth write off the next one is wrong where"),
            std::string::npos)
      << sentences.front();
}

// A scissor that stays on looks like the state of the first draw; frames that are right tell them apart.
TEST(Values, SayWhichStateGoesFromDrawToDraw) {
  const auto with = [](const Scene& scene, bool stays) {
    Scene other = scene;
    for (std::size_t d = 1; d < other.draws.size(); ++d) {
      const SceneDraw& before = other.draws[stays ? d - 1 : 0];
      if (!stays || !other.draws[d].scissor) other.draws[d].scissor = before.scissor;
    }
    return other;
  };
  const auto fault = [](const char* sentence, bool stays) {
    Fault result;
    result.sentence = sentence;
    result.render = [stays](const Target& target, std::span<const Draw> draws) {
      std::vector<Draw> changed(draws.begin(), draws.end());
      for (std::size_t d = 1; d < changed.size(); ++d) {
        if (!stays || !changed[d].scissor) changed[d].scissor = changed[stays ? d - 1 : 0].scissor;
      }
      return oracle::render(target, changed), Status::ok;
    };
    return result;
  };
  const std::vector<Fault> faults{fault("the first draw's", false), fault("it stays", true)};
  const auto drawn = [&](const Scene& scene) { return std::optional(right_image(with(scene, true))); };
  const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
  const std::vector<std::string> sentences = ask({drawn, right, {}, true}, faults).sentences;
  ASSERT_FALSE(sentences.empty());
  EXPECT_EQ(sentences.front(), "it stays");
}

}  // namespace
}  // namespace surefill::judge
