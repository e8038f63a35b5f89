// SPDX-License-Identifier: Apache-2.0
//
// What asking says: of faults that are made here, and of rasterizers that are right, of which nothing may be said.
#include "certify/judge/questions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "certify/judge/facts.hpp"
#include "certify/rivals/frame.hpp"
#include "certify/rivals/model.hpp"
#include "mutation/zoo/right.hpp"
#include "oracle/oracle.hpp"

namespace surefill::judge {
namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;

Image right_image(const Scene& scene) {
  corpus::Frame frame(scene, {});
  oracle::render(frame.target(), frame.draws());
  return std::move(frame.image());
}

struct Planted {
  const char* says;
  void (*before)(Scene& scene);
  void (*after)(const Scene& scene, Image& image);
};

template <typename Change>
void each_draw(Scene& scene, const Change& change) {
  for (SceneDraw& draw : scene.draws) change(draw);
}

template <typename Change>
void each_scissor(Scene& scene, const Change& change) {
  each_draw(scene, [&](SceneDraw& draw) {
    if (!draw.scissor) return;
    change(*draw.scissor);
    Scissor& r = *draw.scissor;
    r.x0 = std::clamp(r.x0, 0, scene.width), r.x1 = std::clamp(r.x1, r.x0, scene.width);
    r.y0 = std::clamp(r.y0, 0, scene.height), r.y1 = std::clamp(r.y1, r.y0, scene.height);
  });
}

template <typename Of>
void depths(Image& image, const Of& of) {
  for (float& z : image.depth) z = std::isfinite(z) ? of(z) : z;
}

constexpr Planted kPlanted[] = {
    {"the scissor's end is inclusive: a column and a row too many are drawn: [x0, x1) x [y0, y1) is taken for [x0, x1 "
     "+ "
     "1) x [y0, y1 + 1)",
     [](Scene& s) { each_scissor(s, [](Scissor& r) { ++r.x1, ++r.y1; }); }, nullptr},
    {"counted from the bottom row",
     [](Scene& s) { each_scissor(s, [&s](Scissor& r) {
                      r = {r.x0, s.height - r.y1, r.x1, s.height - r.y0};
                    }); },
     nullptr},
    {"culling does nothing", [](Scene& s) { each_draw(s, [](SceneDraw& d) { d.cull = Cull::none; }); }, nullptr},
    {"which facing is front is not looked at: clockwise is front",
     [](Scene& s) { each_draw(s, [](SceneDraw& d) { d.front_face = FrontFace::clockwise; }); }, nullptr},
    {"depth clipping does nothing",
     [](Scene& s) {
       each_draw(s,
                 [](SceneDraw& d) { d.depth_mode = d.depth_mode == DepthMode::clip ? DepthMode::none : d.depth_mode; });
     },
     nullptr},
    {"depth is 0.5 z +0.5", nullptr, [](const Scene&, Image& i) { depths(i, [](float z) { return (z + 1) / 2; }); }},
    {"depth is 2 z -1", nullptr, [](const Scene&, Image& i) { depths(i, [](float z) { return 2 * z - 1; }); }},
    {"depth is Z, and not divided by W",
     [](Scene& s) {
       each_draw(s, [](SceneDraw& d) {
         for (corpus::SceneVertex& v : d.vertices) v.z *= v.w;
       });
     },
     nullptr},
    {"flat attributes are those of vertex 2, the last one",
     [](Scene& s) {
       if (s.attributes.empty() || s.attributes[0].interpolation != Interpolation::flat) return;
       each_draw(s, [](SceneDraw& d) {
         for (const corpus::SceneTriangle& t : d.triangles) {
           d.vertices[t.vertices[0]].attributes = d.vertices[t.vertices[2]].attributes;
         }
       });
     },
     nullptr},
    {"attributes are interpolated on the screen, without perspective",
     [](Scene& s) {
       for (corpus::SceneAttribute& a : s.attributes) {
         if (a.interpolation == Interpolation::perspective) a.interpolation = Interpolation::noperspective;
       }
     },
     nullptr},
    {"components of attributes come in another order: 1, 0, 2", nullptr,
     [](const Scene&, Image& i) {
       for (std::vector<float>& values : i.attributes) {
         for (std::size_t n = 0; n + 2 < values.size(); n += 3) std::swap(values[n], values[n + 1]);
       }
     }},
    {"attributes are clamped to 0 to 1 at the vertices, before they are interpolated",
     [](Scene& s) {
       each_draw(s, [](SceneDraw& d) {
         for (corpus::SceneVertex& v : d.vertices) {
           for (float& a : v.attributes) a = std::clamp(a, 0.0f, 1.0f);
         }
       });
     },
     nullptr},
    {"attributes are rounded to floating point of 11 bits (half precision)", nullptr,
     [](const Scene&, Image& i) {
       for (std::vector<float>& values : i.attributes) {
         for (float& a : values) {
           int exponent = 0;
           const float mantissa = std::frexp(a, &exponent);
           a = std::ldexp(std::nearbyint(2048 * mantissa) / 2048, exponent);
         }
       }
     }},
    {"barycentrics are those of other vertices: 1 and 2 are exchanged, in back faces (counter-clockwise on the screen) "
     "alone",
     nullptr,
     [](const Scene& s, Image& i) {
       // Of frames with one triangle.
       if (s.draws.size() != 1 || s.draws[0].triangles.size() != 1) return;
       std::array<std::array<double, 2>, 3> p{};
       for (std::size_t k = 0; k < 3; ++k) {
         const corpus::SceneVertex& v = s.draws[0].vertices[s.draws[0].triangles[0].vertices[k]];
         p[k] = {double{v.x} / v.w, double{v.y} / v.w};
       }
       if ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) > (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) return;
       for (std::size_t n = 0; n + 2 < i.barycentrics.size(); n += 3)
         std::swap(i.barycentrics[n + 1], i.barycentrics[n + 2]);
     }},
    {"barycentric b2 is 0, the others are right", nullptr,
     [](const Scene&, Image& i) {
       for (std::size_t n = 2; n < i.barycentrics.size(); n += 3) i.barycentrics[n] = 0;
     }},
    {"depth is z +0.001, z being what it should be: a constant is added", nullptr,
     [](const Scene&, Image& i) { depths(i, [](float z) { return z + 0.001f; }); }},
    {"depth is rounded to floating point of 8 bits (bfloat16)", nullptr,
     [](const Scene&, Image& i) {
       depths(i, [](float z) {
         int exponent = 0;
         const float mantissa = std::frexp(z, &exponent);
         return std::ldexp(std::nearbyint(256 * mantissa) / 256, exponent);
       });
     }},
    {"depths are the smallest of the three vertices', and not interpolated",
     [](Scene& s) {
       each_draw(s, [](SceneDraw& d) {
         for (const corpus::SceneTriangle& t : d.triangles) {
           float least = INFINITY;
           for (const std::uint32_t v : t.vertices) least = std::min(least, d.vertices[v].z / d.vertices[v].w);
           for (const std::uint32_t v : t.vertices) d.vertices[v].z = least * d.vertices[v].w;
         }
       });
     },
     nullptr},
    {"of attributes of several kinds (perspective, noperspective, flat) all are interpolated as the first one is",
     [](Scene& s) {
       for (corpus::SceneAttribute& a : s.attributes) a.interpolation = s.attributes[0].interpolation;
     },
     nullptr},
    {"the fourth component of attributes is wrong, the others are right: it comes as 1", nullptr,
     [](const Scene& s, Image& i) {
       for (std::size_t k = 0; k < i.attributes.size(); ++k) {
         for (std::size_t n = 3; s.attributes[k].components == 4 && n < i.attributes[k].size(); n += 4) {
           i.attributes[k][n] = 1;
         }
       }
     }},
    {"with the depth test GREATER the depth that is there before the frame is ignored",
     [](Scene& s) {
       if (s.depth_test == DepthTest::greater) s.initial_depth.clear();
     },
     nullptr},
    {"attributes are clamped to 0 to 1", nullptr,
     [](const Scene&, Image& i) {
       for (std::vector<float>& values : i.attributes) {
         for (float& value : values) value = std::clamp(value, 0.0f, 1.0f);
       }
     }},
    {"the last triangle drawn is seen",
     [](Scene& s) {
       if (s.draws.size() == 1 && s.draws[0].triangles.size() == 2)
         s.draws[0].triangles.erase(s.draws[0].triangles.begin()), s.draws[0].first_index = 1;
     },
     nullptr},
    {"one column of every 64 (columns 63, 127 and so on, counted from 0) is not drawn", nullptr,
     [](const Scene&, Image& i) {
       for (std::size_t s = 0; s < i.count.size(); ++s) {
         if (s / static_cast<std::size_t>(i.samples) % static_cast<std::size_t>(i.width) % 64 == 63) i.count[s] = 0;
       }
     }},
    {"sample places are upside down",
     [](Scene& s) {
       if (s.samples == 1) return;
       for (int n = 0; n < s.samples; ++n) {
         const SampleLocation at = sample_location(s.samples, n);
         s.sample_locations.push_back({at.x, at.y == 0 ? 0 : 16 - at.y});
       }
     },
     nullptr},
    {"triangles smaller than some 1 pixels each way are not drawn",
     [](Scene& s) {
       each_draw(s, [](SceneDraw& d) {
         std::erase_if(d.triangles, [&d](const corpus::SceneTriangle& t) {
           const auto &a = d.vertices[t.vertices[0]], &b = d.vertices[t.vertices[1]], &c = d.vertices[t.vertices[2]];
           if (a.w != 1 || b.w != 1 || c.w != 1) return false;
           const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
           const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
           return x1 - x0 < 1 && y1 - y0 < 1;
         });
       });
     },
     nullptr},
};

TEST(Questions, SayWhatIsPlanted) {
  for (const Planted& planted : kPlanted) {
    const auto drawn = [&planted](const Scene& scene) -> std::optional<Image> {
      Scene changed = scene;
      if (planted.before) planted.before(changed);
      Image image = right_image(changed);
      if (planted.after) planted.after(scene, image);
      return image;
    };
    const Questions questions{drawn, [](const Scene& scene) { return std::optional(right_image(scene)); }, {}, true};
    const std::vector<std::string> sentences = ask(questions, {}).sentences;
    ASSERT_FALSE(sentences.empty()) << planted.says;
    EXPECT_NE(sentences.front().find(planted.says), std::string::npos) << planted.says << ": " << sentences.front();
  }
}

// Triangles that are lost by their number, and what their numbers become.
TEST(Questions, CountTriangles) {
  struct Case {
    const char* says;
    std::string (*ask)(const Questions& questions);
    void (*draw)(const Scene& scene, Image& image);
  };
  constexpr Case kCases[] = {{"one of every 1000 triangles of a draw is lost: numbers 999, 1999", about_many,
                              [](const Scene& s, Image& i) {
                                for (std::size_t t = 999; t < s.draws[0].triangles.size() && i.width == 128;
                                     t += 1000) {
                                  i.count[2 * (t / 64) * 128 + 2 * (t % 64)] = 0;
                                }
                              }},
                             {"every index is 1 too large", about_index, [](const Scene&, Image& i) {
                                for (std::uint32_t& n : i.index) n += n != kNoTriangle;
                              }}};
  for (const Case& one : kCases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> {
      Image image = right_image(scene);
      one.draw(scene, image);
      return image;
    };
    const Questions questions{drawn, [](const Scene& scene) { return std::optional(right_image(scene)); }, {}, false};
    const std::string said = one.ask(questions);
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
  }
}

// Faults of draws, of rows, of counts, of who is seen.
TEST(Questions, SayWhatElseIsPlanted) {
  struct Case {
    const char* says;
    std::string (*ask)(const Questions& questions);
    void (*before)(Scene& scene);
    void (*after)(const Scene& scene, Image& image);
  };
  const auto as_it_is = [](Scene&) {};
  const auto as_drawn = [](const Scene&, Image&) {};
  const Case cases[] = {
      {"next to each other in a draw one count is lost", about_counts, as_it_is,
       [](const Scene&, Image& i) {
         for (std::uint32_t& n : i.count) n = (n + 1) / 2;
       }},
      {"of the draws before is added to the index once more", about_index, as_it_is,
       [](const Scene& s, Image& i) {
         const auto of_draw = static_cast<std::uint32_t>(s.draws[0].triangles.size());
         for (std::uint32_t& n : i.index) n = n == kNoTriangle ? n : n + n / of_draw * of_draw;
       }},
      {"has vertices of the draw before it", about_vertex_cache,
       [](Scene& s) {
         for (std::size_t d = 1; d < s.draws.size(); ++d) s.draws[d].vertices = s.draws[0].vertices;
       },
       as_drawn},
      {"in groups of 4, and what of the last group", about_ends_of_rows, as_it_is,
       [](const Scene& s, Image& i) {
         const int beyond = (s.width + 3) / 4 * 4 - s.width;
         for (int y = 1; y < s.height; ++y) {
           for (int x = 0; x < beyond; ++x) ++i.count[static_cast<std::size_t>(y * s.width + x)];
         }
       }},
      {"a part of a block of 8 x 8 pixels hides farther ones", about_seen, as_it_is,
       [](const Scene& s, Image& i) {
         if (s.width != 40 || s.draws[0].triangles.size() != 2) return;
         for (int p = 0; p < 64; ++p) {
           std::uint32_t& n = i.index[static_cast<std::size_t>(p / 8 * s.width + p % 8)];
           n = n == 0 ? 0 : kNoTriangle;
         }
       }},
      {"negative depths are compared the other way round", about_seen,
       [](Scene& s) {
         const auto& vertices = s.draws[0].vertices;
         const auto negative = [](const auto& v) { return v.z < 0; };
         if (std::all_of(vertices.begin(), vertices.end(), negative)) s.depth_test = DepthTest::greater;
       },
       as_drawn},
      {"begins left of or above the target nothing is drawn", about_scissor,
       [](Scene& s) {
         auto& scissor = s.draws[0].scissor;
         if (scissor && (scissor->x0 < 0 || scissor->y0 < 0)) scissor = Scissor{0, 0, 0, 0};
       },
       as_drawn},
      {"takes the facing from X and Y before they are divided", about_culling,
       [](Scene& s) {
         const auto& v = s.draws[0].vertices;
         const auto turn = [&v](bool divided) {
           const auto x = [&](std::size_t n) { return divided ? v[n].x / v[n].w : v[n].x; };
           const auto y = [&](std::size_t n) { return divided ? v[n].y / v[n].w : v[n].y; };
           return (x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0)) > 0;
         };
         Cull& cull = s.draws[0].cull;
         if (cull != Cull::none && turn(true) != turn(false)) cull = cull == Cull::front ? Cull::back : Cull::front;
       },
       as_drawn},
  };
  for (const Case& one : cases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> {
      Scene changed = scene;
      one.before(changed);
      Image image = right_image(changed);
      one.after(scene, image);
      return image;
    };
    const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
    const std::string said = one.ask({drawn, right, {}, false});
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
    EXPECT_EQ(one.ask({right, right, {}, false}), "") << one.says;
  }
}

// What becomes of triangles on the way to their samples, guessed.
TEST(Questions, GuessWhatBecomesOfTriangles) {
  using Corner = corpus::SceneVertex;
  struct Case {
    const char* says;
    std::string (*ask)(const Questions& questions);
    void (*change)(const Scene& scene, std::array<Corner*, 3> corners);
    bool (*lost)(const Scene& scene, const std::array<Corner*, 3>& corners);
    void (*after)(Image& image);
  };
  constexpr Case kCases[] = {
      {"vertices beyond the target are clamped to its border", about_reach,
       [](const Scene& s, std::array<Corner*, 3> c) {
         for (Corner* v : c) {
           v->x = std::clamp(v->x, 0.0f, static_cast<float>(s.width));
           v->y = std::clamp(v->y, 0.0f, static_cast<float>(s.height));
         }
       },
       nullptr, nullptr},
      {"positions are clamped to -128 to 128 pixels", about_reach,
       [](const Scene&, std::array<Corner*, 3> c) {
         for (Corner* v : c) v->x = std::clamp(v->x, -128.0f, 128.0f), v->y = std::clamp(v->y, -128.0f, 128.0f);
       },
       nullptr, nullptr},
      {"a triangle without a vertex on the target is not drawn", about_reach, nullptr,
       [](const Scene& s, const std::array<Corner*, 3>& c) {
         return std::all_of(c.begin(), c.end(), [&s](const Corner* v) {
           return v->x < 0 || v->y < 0 || v->x > static_cast<float>(s.width) || v->y > static_cast<float>(s.height);
         });
       },
       nullptr},
      {"vertices behind the eye are divided by |W|", about_eye,
       [](const Scene&, std::array<Corner*, 3> c) {
         for (Corner* v : c) v->w = std::abs(v->w);
       },
       nullptr, nullptr},
      {"with two vertices behind the eye (W <= 0) is not drawn at all; those with one are", about_eye, nullptr,
       [](const Scene&, const std::array<Corner*, 3>& c) {
         return std::count_if(c.begin(), c.end(), [](const Corner* v) { return v->w <= 0; }) == 2;
       },
       nullptr},
      {"a W below 1 is taken for 1", about_perspective,
       [](const Scene&, std::array<Corner*, 3> c) {
         for (Corner* v : c) v->w = std::max(v->w, 1.0f);
       },
       nullptr, nullptr},
      {"pixels are drawn in groups of 4 along a row", about_ways_of_filling, nullptr, nullptr, [](Image& i) {
         const std::vector<std::uint32_t> was = i.count;
         for (std::size_t s = 0; s < was.size(); ++s) {
           const auto width = static_cast<std::size_t>(i.width), x = s % width / 4 * 4;
           for (std::size_t k = x; k < std::min(x + 4, width); ++k) i.count[s] |= was[s / width * width + k];
         }
       }}};
  for (const Case& one : kCases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> {
      Scene changed = scene;
      auto& vertices = changed.draws[0].vertices;
      const std::array<Corner*, 3> corners{&vertices[0], &vertices[1], &vertices[2]};
      if (one.change) one.change(scene, corners);
      if (one.lost && one.lost(scene, corners)) changed.draws[0].triangles.clear();
      Image image = right_image(changed);
      if (one.after) one.after(image);
      return image;
    };
    const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
    const std::string said = one.ask({drawn, right, {}, false});
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
    EXPECT_EQ(one.ask({right, right, {}, false}), "") << one.says;
  }
}

// What goes wrong by place and by order, far away and after other triangles.
TEST(Questions, FindPlacesAndOrders) {
  struct Case {
    const char* says;
    std::string (*ask)(const Questions& questions);
    void (*before)(Scene& scene);
    void (*after)(Image& image);
  };
  constexpr Case kCases[] = {
      {"lost in blocks of 8 x 8 pixels of which it covers no corner", about_blocks, nullptr,
       [](Image& i) {
         for (std::size_t s = 0; s < i.count.size(); ++s) {
           const auto width = static_cast<std::size_t>(i.width), x = s % width % 8, y = s / width % 8;
           if (x % 7 != 0 || y % 7 != 0) i.count[s] = 0;
         }
       }},
      {"the triangles of a draw that come after one wholly left of the target are lost", about_triangles_before,
       [](Scene& s) {
         SceneDraw& draw = s.draws[0];
         for (std::size_t t = 0; t < draw.triangles.size(); ++t) {
           const auto& v = draw.triangles[t].vertices;
           if (std::any_of(v.begin(), v.end(),
                           [&](auto k) { return draw.vertices[k].x > -1 || draw.vertices[k].w < 0; }))
             continue;
           draw.triangles.resize(t + 1);
         }
       },
       nullptr},
      {"the width rounded up to a multiple of 4, not as the width", about_strides, nullptr,
       [](Image& i) {
         std::vector<std::uint32_t> counts(i.count.size(), 0);
         const auto width = static_cast<std::size_t>(i.width);
         for (std::size_t s = 0; s < counts.size(); ++s) {
           const std::size_t to = s / width * ((width + 3) / 4 * 4) + s % width;
           if (to < counts.size()) counts[to] += i.count[s];
         }
         i.count = counts;
       }},
      {"1 / W has some 12 bits", about_precision,
       [](Scene& s) {
         for (corpus::SceneVertex& v : s.draws[0].vertices) {
           int exponent = 0;
           const double part = std::frexp(1.0 / v.w, &exponent);
           const double over = std::ldexp(std::trunc(std::ldexp(part, 12)), exponent - 12);
           v.x = static_cast<float>(v.x * over), v.y = static_cast<float>(v.y * over), v.w = 1;
         }
       },
       nullptr},
      {"an error of some 1/1024", about_slopes,
       [](Scene& s) {
         if (s.height < 2048) return;
         for (corpus::SceneVertex& v : s.draws[0].vertices) v.x += v.y / 1024;
       },
       nullptr}};
  for (const Case& one : kCases) {
    const auto drawn = [&one](const Scene& scene) -> std::optional<Image> {
      Scene changed = scene;
      if (one.before) one.before(changed);
      Image image = right_image(changed);
      if (one.after) one.after(image);
      return image;
    };
    const auto right = [](const Scene& scene) { return std::optional(right_image(scene)); };
    const std::string said = one.ask({drawn, right, {}, false});
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ": " << said;
    EXPECT_EQ(one.ask({right, right, {}, false}), "") << one.says;
  }
}

// Of the right ones, of every third one here, nothing is said.
TEST(Questions, SayNothingOfRightRasterizers) {
  for (std::size_t number = 0; number < zoo::right_rasterizers().size(); number += 3) {
    const zoo::Choices& choices = zoo::right_rasterizers()[number];
    const auto drawn = [&choices](const Scene& scene) -> std::optional<Image> {
      corpus::Frame frame(scene, {true, true, true, false, false});
      for (const Draw& draw : frame.draws()) {
        if (draw.cull != Cull::none || draw.scissor || draw.depth_mode != DepthMode::none || !draw.depth_write)
          return std::nullopt;
        for (const Vertex& v : draw.vertices) {
          if (!(v.w > 0)) return std::nullopt;
        }
        // None of them says that it takes these in any order.
        if (!std::is_sorted(draw.identifiers.begin(), draw.identifiers.end())) return std::nullopt;
      }
      if (scene.samples > 1 || scene.draws.size() > 1 || scene.depth_test != DepthTest::less ||
          !scene.initial_depth.empty())
        return std::nullopt;
      const adapters::AdapterFrame adapted(frame.target(), frame.draws());
      if (!zoo::draw_right(choices, adapted.scene(), adapted.image())) return std::nullopt;
      return std::move(frame.image());
    };
    class Drawn : public Rival {
     public:
      explicit Drawn(const std::function<std::optional<Image>(const Scene&)>& draw) : draw_(draw) {}
      corpus::Outputs outputs() const override { return {true, true, true, false, false}; }
      double position_step() const override { return 0; }
      Image draw(const Scene& scene, const corpus::Outputs&) override {
        std::optional<Image> image = draw_(scene);
        if (!image) throw Declined("not such a scene");
        return std::move(*image);
      }

     private:
      std::function<std::optional<Image>(const Scene&)> draw_;
    };
    Drawn rival(drawn);
    const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
    ASSERT_TRUE(found.known) << zoo::right_text(choices);
    const Questions questions{
        drawn, [&found](const Scene& scene) { return std::optional(right_image(moved(scene, found.model))); },
        found.model, true};
    const Answers answers = ask(questions, {});
    EXPECT_TRUE(answers.sentences.empty()) << zoo::right_text(choices) << ": " << answers.sentences.front();
    EXPECT_TRUE(answers.wrong.empty()) << zoo::right_text(choices);
    const oracle::AxisModel &x = found.model.x, &y = found.model.y;
    if (x.lacks != 0 || x.moved != 0 || y.lacks != 0 || y.moved != 0 || std::min(x.bits, y.bits) < 4) continue;
    EXPECT_EQ(about_precision(questions), "") << zoo::right_text(choices);
    EXPECT_EQ(about_slopes(questions), "") << zoo::right_text(choices);
  }
}

}  // namespace
}  // namespace surefill::judge
