// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/symptoms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;

constexpr std::size_t kLeastScenes = 3;

bool most(std::size_t part, std::size_t all) {
  return all >= kLeastScenes && 10 * part >= 9 * all;
}

bool same(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_floats(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

// --- how it follows from what is right

// The right counts where pixel (x, y) shows those of (x + dx, y + dy), or of the row as far from the other end.
bool stands_elsewhere(const Wrong& shown, int dx, int dy, bool turned) {
  const Image &right = shown.right, &rival = shown.rival;
  const int width = right.width, height = right.height;
  const auto samples = static_cast<std::size_t>(right.samples);
  if (samples != 1 || right.count.empty() || right.count == rival.count) return false;
  bool explains = false;  // a pixel that is wrong: where all come from beside the target nothing is said
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int from_x = x + dx, from_y = turned ? height - 1 - y : y + dy;
      if (from_x < 0 || from_y < 0 || from_x >= width || from_y >= height) continue;
      const auto at = [width](int i, int j) { return static_cast<std::size_t>(j * width + i); };
      if (rival.count[at(x, y)] != right.count[at(from_x, from_y)]) return false;
      explains = explains || rival.count[at(x, y)] != right.count[at(x, y)];
    }
  }
  return explains;
}

// The scenes whose wrong values all follow one rule; those where the output is right say nothing.
struct Following {
  std::size_t scenes = 0, follow = 0;
  bool all() const { return most(follow, scenes); }
};

template <typename Value, typename Follows>
Following following(std::span<const Wrong> wrong, const std::vector<Value> Image::*output, const Follows& follows) {
  Following result;
  for (const Wrong& shown : wrong) {
    const auto &right = shown.right.*output, &rival = shown.rival.*output;
    if (right.empty() || right.size() != rival.size()) continue;
    bool differs = false, good = true;
    for (std::size_t i = 0; i < right.size() && good; ++i) {
      differs = differs || !same(static_cast<float>(right[i]), static_cast<float>(rival[i])) || right[i] != rival[i];
      good = follows(right[i], rival[i]);
    }
    if (!differs) continue;
    ++result.scenes;
    if (good) ++result.follow;
  }
  return result;
}

void add_counts(std::span<const Wrong> wrong, std::vector<std::string>& sentences) {
  struct Move {
    int dx, dy;
    bool turned;
    const char* text;
  };
  constexpr Move kMoves[] = {{-1, 0, false, "the picture stands a pixel to the right"},
                             {1, 0, false, "the picture stands a pixel to the left"},
                             {0, -1, false, "the picture stands a pixel further down"},
                             {0, 1, false, "the picture stands a pixel further up"},
                             {0, 0, true, "the picture is upside down: its first row is the bottom one"}};
  std::size_t with_counts = 0;
  for (const Wrong& shown : wrong) with_counts += shown.right.count != shown.rival.count && shown.right.samples == 1;
  for (const Move& move : kMoves) {
    const auto good = std::count_if(wrong.begin(), wrong.end(), [&move](const Wrong& shown) {
      return stands_elsewhere(shown, move.dx, move.dy, move.turned);
    });
    if (most(static_cast<std::size_t>(good), with_counts)) sentences.emplace_back(move.text);
  }
  const auto counts = [&](const char* sentence, const auto& follows) {
    if (following(wrong, &Image::count, follows).all()) sentences.emplace_back(sentence);
  };
  std::uint64_t drawn = 0;
  for (const Wrong& shown : wrong) drawn = std::accumulate(shown.rival.count.begin(), shown.rival.count.end(), drawn);
  if (drawn == 0) {
    counts("nothing is drawn at all", [](std::uint32_t, std::uint32_t got) { return got == 0; });
    return;
  }
  counts("every count is twice what it should be", [](std::uint32_t n, std::uint32_t got) { return got == 2 * n; });
  counts("every count is 1 too large", [](std::uint32_t n, std::uint32_t got) { return got == n + 1; });
  counts("every count is 1 too large where anything is drawn",
         [](std::uint32_t n, std::uint32_t got) { return got == (n == 0 ? 0 : n + 1); });
  for (const std::uint32_t bits : {1u, 2u, 4u, 8u, 16u}) {
    const auto wraps = [bits](std::uint32_t n, std::uint32_t got) { return got == (n & ((1u << bits) - 1)); };
    if (!following(wrong, &Image::count, wraps).all()) continue;
    sentences.push_back("counts overflow: they have " + std::to_string(bits) + " bits");
    break;
  }
  std::uint32_t largest = 0, larger = 0;
  for (const Wrong& shown : wrong) {
    for (const std::uint32_t n : shown.rival.count) largest = std::max(largest, n);
    for (const std::uint32_t n : shown.right.count) larger = std::max(larger, n);
  }
  const auto stop = [largest](std::uint32_t right, std::uint32_t got) { return got == std::min(right, largest); };
  if (larger > largest && following(wrong, &Image::count, stop).all()) {
    sentences.push_back("counts stop at " + std::to_string(largest));
  }
}

void add_odd_index(std::span<const Wrong> wrong, std::vector<std::string>& sentences);

void add_index(std::span<const Wrong> all, std::vector<std::string>& sentences) {
  // Where triangles are lost or come too often, the index says nothing of its own.
  std::vector<Wrong> wrong(all.begin(), all.end());
  std::erase_if(wrong, [](const Wrong& shown) { return shown.right.count != shown.rival.count; });
  for (const int more : {1, -1}) {
    const auto moved = [more](std::uint32_t right, std::uint32_t got) {
      return right == kNoTriangle ? got == kNoTriangle : got == right + static_cast<std::uint32_t>(more);
    };
    if (following(wrong, &Image::index, moved).all()) {
      sentences.push_back(std::string("every index is 1 too ") + (more > 0 ? "large" : "small"));
      return;
    }
  }
  add_odd_index(wrong, sentences);
}

// Of indices of a few bits, and those that count from the other end.
void add_odd_index(std::span<const Wrong> wrong, std::vector<std::string>& sentences) {
  for (const std::uint32_t bits : {2u, 4u, 8u, 16u}) {
    const auto wraps = [bits](std::uint32_t n, std::uint32_t got) {
      return got == n || (n != kNoTriangle && got == (n & ((1u << bits) - 1)));
    };
    if (!following(wrong, &Image::index, wraps).all()) continue;
    sentences.push_back("indices have " + std::to_string(bits) + " bits: larger ones overflow");
    return;
  }
  const auto zero = [](std::uint32_t n, std::uint32_t got) { return n == kNoTriangle ? got == n : got == 0; };
  if (following(wrong, &Image::index, zero).all()) sentences.emplace_back("every index is 0");
  const auto empty = [](std::uint32_t n, std::uint32_t got) { return n == kNoTriangle ? got == 0 : got == n; };
  if (following(wrong, &Image::index, empty).all()) {
    sentences.emplace_back("where nothing is drawn the index is 0, which is a triangle's");
  }
  std::size_t scenes = 0, follow = 0;
  for (const Wrong& shown : wrong) {
    const auto &right = shown.right.index, &rival = shown.rival.index;
    if (right.empty() || right.size() != rival.size() || right == rival) continue;
    std::size_t triangles = 0;
    for (const SceneDraw& draw : shown.scene.draws) triangles += draw.triangles.size();
    bool good = true;
    for (std::size_t s = 0; s < right.size(); ++s) {
      good = good &&
             rival[s] == (right[s] == kNoTriangle ? right[s] : static_cast<std::uint32_t>(triangles) - 1 - right[s]);
    }
    ++scenes;
    follow += good;
  }
  if (most(follow, scenes)) sentences.emplace_back("indices count from the last triangle, not from the first");
}

void add_depth(std::span<const Wrong> all, double within, std::vector<std::string>& sentences) {
  // Where depth is about right, it says nothing.
  std::vector<Wrong> wrong(all.begin(), all.end());
  std::erase_if(wrong, [within](const Wrong& shown) {
    const auto &right = shown.right.depth, &rival = shown.rival.depth;
    return std::equal(right.begin(), right.end(), rival.begin(), rival.end(),
                      [within](float a, float b) { return alike_within(a, b, within); });
  });
  const auto empty = [](float z) { return std::isinf(z); };
  const auto clamped = [&](float z, float got) {
    return empty(z) ? got == z : alike_within(got, std::clamp(z, 0.0f, 1.0f), within);
  };
  if (following(wrong, &Image::depth, clamped).all()) {
    sentences.emplace_back("depth is clamped to 0 to 1, whether that was asked for or not");
    return;
  }
  // The steps that it comes in, if they are those of a buffer.
  for (const int bits : {8, 16, 24}) {
    const double steps = std::ldexp(1.0, bits) - 1;
    const auto stepped = [&](float z, float got) {
      if (empty(z)) return empty(got);
      if (z < 0 || z > 1) return true;
      return std::abs(got - z) <= 1 / steps && got == static_cast<float>(std::nearbyint(got * steps) / steps);
    };
    if (following(wrong, &Image::depth, stepped).all()) {
      sentences.push_back("depth comes in steps of " + std::to_string(bits) + " bits");
      return;
    }
  }
  // A straight line through two of the wrong depths, as far apart as there are.
  float low = INFINITY, high = -INFINITY, low_got = 0, high_got = 0;
  for (const Wrong& shown : wrong) {
    for (std::size_t s = 0; s < std::min(shown.right.depth.size(), shown.rival.depth.size()); ++s) {
      const float z = shown.right.depth[s], got = shown.rival.depth[s];
      if (!std::isfinite(z) || !std::isfinite(got) || std::abs(z) > 16) continue;
      if (z < low) low = z, low_got = got;
      if (z > high) high = z, high_got = got;
    }
  }
  if (!(high - low > 1.0f / 64)) return;
  const double slope = (static_cast<double>(high_got) - low_got) / (static_cast<double>(high) - low);
  const double constant = low_got - slope * low;
  const auto on_line = [&](float z, float got) {
    return !std::isfinite(z) || std::abs(z) > 16 || std::abs(slope * z + constant - got) <= std::max(1e-5, within);
  };
  if (following(wrong, &Image::depth, on_line).all() && (std::abs(slope - 1) > 1e-4 || std::abs(constant) > 1e-4)) {
    sentences.push_back(text("depth is %.4g z %+.4g, z being what it should be", slope, constant));
  }
}

void add_barycentrics(std::span<const Wrong> wrong, double within, std::vector<std::string>& sentences) {
  constexpr std::array<std::array<std::size_t, 3>, 5> kOrders{{{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : kOrders) {
    std::size_t scenes = 0, follow = 0;
    for (const Wrong& shown : wrong) {
      const auto &right = shown.right.barycentrics, &rival = shown.rival.barycentrics;
      if (right.empty() || right.size() != rival.size() || same_floats(right, rival)) continue;
      ++scenes;
      bool good = true;
      for (std::size_t s = 0; s + 2 < right.size() && good; s += 3) {
        for (std::size_t i = 0; i < 3; ++i) good = good && alike_within(rival[s + i], right[s + order[i]], within);
      }
      if (good) ++follow;
    }
    if (!most(follow, scenes)) continue;
    std::string names;
    for (const std::size_t i : order) names += (names.empty() ? "b" : ", b") + std::to_string(i);
    sentences.push_back("barycentrics come in another order: " + names);
    return;
  }
}

// Attributes, all components of all of them.
void add_attributes(std::span<const Wrong> wrong, double within, std::vector<std::string>& sentences) {
  const auto is = [within](float got, float wanted) { return alike_within(got, wanted, within); };
  const auto follow = [&wrong](const auto& follows) {
    std::size_t scenes = 0, good = 0;
    for (const Wrong& shown : wrong) {
      bool differs = false, all = true;
      for (std::size_t k = 0; k < std::min(shown.right.attributes.size(), shown.rival.attributes.size()); ++k) {
        const auto &right = shown.right.attributes[k], &rival = shown.rival.attributes[k];
        if (right.size() != rival.size()) continue;
        for (std::size_t i = 0; i < right.size() && all; ++i) {
          differs = differs || !same(right[i], rival[i]);
          all = follows(right[i], rival[i]);
        }
      }
      scenes += differs || !all;
      good += differs && all;
    }
    return most(good, scenes);
  };
  const auto steps = [](double n) {
    return [n](float right, float got) {
      return std::abs(got - right) <= 1 / n + 1e-6 * std::abs(right) &&
             std::abs(got * n - std::nearbyint(got * n)) < 1e-3;
    };
  };
  if (follow([](float, float got) { return got == 0; })) {
    sentences.emplace_back("attributes are 0");
  } else if (follow([&is](float a, float got) { return is(got, std::clamp(a, 0.0f, 1.0f)); })) {
    sentences.emplace_back("attributes are clamped to 0 to 1");
  } else if (follow([&is](float a, float got) { return is(got, std::clamp(a, -1.0f, 1.0f)); })) {
    sentences.emplace_back("attributes are clamped to -1 to 1");
  } else if (follow([&is](float a, float got) { return is(got, std::max(a, 0.0f)); })) {
    sentences.emplace_back("negative attributes become 0");
  } else if (follow([&is](float a, float got) { return is(got, std::abs(a)); })) {
    sentences.emplace_back("attributes lose their sign");
  } else if (follow([](float a, float got) { return got == std::trunc(a) || got == std::nearbyint(a); })) {
    sentences.emplace_back("attributes are rounded to whole numbers");
  } else if (follow(steps(255)) ||
             follow([&steps](float a, float got) { return steps(255)(std::clamp(a, 0.0f, 1.0f), got); })) {
    sentences.emplace_back("attributes come in steps of 8 bits");
  } else {
    for (const int bits : {8, 11, 16}) {
      const double part = std::ldexp(1.0, -bits);
      bool rounded = follow([part](float a, float got) { return std::abs(got - a) <= part * std::abs(a) + 1e-30; }) &&
                     follow([bits](float, float got) {
                       int exponent = 0;
                       const float mantissa = std::ldexp(std::frexp(got, &exponent), bits);
                       return mantissa == std::nearbyint(mantissa);
                     });
      if (!rounded) continue;
      sentences.push_back("attributes have " + std::to_string(bits) + " bits: they are rounded to a smaller format");
      return;
    }
  }
}

// --- where it is

std::vector<std::array<int, 2>> wrong_pixels(const Wrong& shown) {
  std::vector<std::array<int, 2>> pixels;
  const Image &right = shown.right, &rival = shown.rival;
  for (std::size_t s = 0; s < right.count.size(); ++s) {
    bool good = right.count[s] == rival.count[s];
    if (!right.index.empty() && !rival.index.empty()) good = good && right.index[s] == rival.index[s];
    if (!right.depth.empty() && !rival.depth.empty()) good = good && same(right.depth[s], rival.depth[s]);
    if (good) continue;
    const auto pixel = static_cast<int>(s / static_cast<std::size_t>(right.samples));
    pixels.push_back({pixel % right.width, pixel / right.width});
  }
  return pixels;
}

void add_places(std::span<const Wrong> wrong, std::vector<std::string>& sentences) {
  struct Place {
    const char* text;
    bool (*in)(int at, int length);
  };
  constexpr Place kPlaces[] = {{"in the last %s of the target", [](int at, int length) { return at + 1 == length; }},
                               {"in the first %s of the target", [](int at, int) { return at == 0; }},
                               {"in the last %s of every two", [](int at, int) { return at % 2 == 1; }},
                               {"in the first %s of every two", [](int at, int) { return at % 2 == 0; }},
                               {"in the last %s of every four", [](int at, int) { return at % 4 == 3; }},
                               {"in the first %s of every four", [](int at, int) { return at % 4 == 0; }},
                               {"in the last %s of every eight", [](int at, int) { return at % 8 == 7; }},
                               {"in the first %s of every eight", [](int at, int) { return at % 8 == 0; }},
                               {"in the last %s of every sixteen", [](int at, int) { return at % 16 == 15; }},
                               {"in the first %s of every sixteen", [](int at, int) { return at % 16 == 0; }},
                               {"beyond the first 64 %ss of the target", [](int at, int) { return at >= 64; }},
                               {"beyond the first 32 %ss of the target", [](int at, int) { return at >= 32; }},
                               {"beyond the first 16 %ss of the target", [](int at, int) { return at >= 16; }},
                               {"beyond the first 8 %ss of the target", [](int at, int) { return at >= 8; }}};
  for (const std::size_t axis : {1u, 0u}) {
    // The narrowest place that holds all is said.
    const Place* found = nullptr;
    for (const Place& place : kPlaces) {
      std::size_t scenes = 0, inside = 0;
      for (const Wrong& shown : wrong) {
        const std::vector<std::array<int, 2>> pixels = wrong_pixels(shown);
        const int length = axis == 0 ? shown.right.width : shown.right.height;
        // On a target of a few pixels everything is in the last row.
        if (pixels.empty() || length < 3) continue;
        ++scenes;
        inside +=
            std::all_of(pixels.begin(), pixels.end(), [&](const auto& pixel) { return place.in(pixel[axis], length); });
      }
      if (!most(inside, scenes)) continue;
      const bool of_eight = std::string_view(place.text).find("eight") != std::string_view::npos;
      if (!found || of_eight) found = &place;
    }
    if (!found) continue;
    const std::string where = text(found->text, axis == 0 ? "column" : "row");
    std::size_t missing = 0, all = 0;
    for (const Wrong& shown : wrong) {
      for (std::size_t s = 0; s < shown.right.count.size(); ++s) {
        if (shown.right.count[s] == shown.rival.count[s]) continue;
        ++all;
        missing += shown.rival.count[s] < shown.right.count[s];
      }
    }
    sentences.push_back(std::string(all > 0 && missing == all ? "samples are not drawn "
                                    : all > 0 && missing == 0 ? "samples are drawn too often "
                                                              : "samples are wrong ") +
                        where + ", and nowhere else");
  }
}

// --- what it needs

struct Part {
  const char* text;
  bool (*has)(const Scene& scene);
  void (*take)(Scene& scene);
};

bool any_draw(const Scene& scene, bool (*has)(const SceneDraw& draw)) {
  return std::any_of(scene.draws.begin(), scene.draws.end(), has);
}

constexpr Part kParts[] = {
    {"the scissor",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.scissor.has_value(); }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.scissor.reset();
     }},
    {"culling", [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.cull != Cull::none; }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.cull = Cull::none;
     }},
    {"counter-clockwise front faces",
     [](const Scene& s) {
       return any_draw(s, [](const SceneDraw& d) { return d.front_face == FrontFace::counter_clockwise; });
     },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.front_face = FrontFace::clockwise;
     }},
    {"clipping depth",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.depth_mode == DepthMode::clip; }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.depth_mode = d.depth_mode == DepthMode::clip ? DepthMode::none : d.depth_mode;
     }},
    {"clamping depth",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.depth_mode == DepthMode::clamp; }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.depth_mode = d.depth_mode == DepthMode::clamp ? DepthMode::none : d.depth_mode;
     }},
    {"draws that do not write depth",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return !d.depth_write; }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.depth_write = true;
     }},
    {"the depth test GREATER", [](const Scene& s) { return s.depth_test == DepthTest::greater; },
     [](Scene& s) { s.depth_test = DepthTest::less; }},
    {"the depth that is there before the frame", [](const Scene& s) { return !s.initial_depth.empty(); },
     [](Scene& s) { s.initial_depth.clear(); }},
    {"conservative rasterization",
     [](const Scene& s) {
       return any_draw(s, [](const SceneDraw& d) { return d.conservative != Conservative::none; });
     },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.conservative = Conservative::none;
     }},
    {"the draw's grid",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.grid.has_value(); }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.grid.reset();
     }},
    {"fill rules other than top_left",
     [](const Scene& s) { return any_draw(s, [](const SceneDraw& d) { return d.fill_rule != FillRule::top_left; }); },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.fill_rule = FillRule::top_left;
     }},
    {"several samples a pixel", [](const Scene& s) { return s.samples > 1; },
     [](Scene& s) {
       s.samples = 1;
       if (s.initial_depth.size() > 1) s.initial_depth.erase(s.initial_depth.begin() + 1, s.initial_depth.end());
     }},
    {"several draws in a frame, and what one keeps of another's state",
     [](const Scene& s) { return s.draws.size() > 1; },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) d.state() = s.draws.front().state();
     }},
    {"vertices behind the eye, W <= 0",
     [](const Scene& s) {
       return any_draw(s, [](const SceneDraw& d) {
         return !d.viewport &&
                std::any_of(d.vertices.begin(), d.vertices.end(), [](const auto& v) { return v.w <= 0; });
       });
     },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) {
         for (corpus::SceneVertex& v : d.vertices) v.w = v.w <= 0 ? 1 : v.w;
       }
     }},
    {"perspective: W that differs",
     [](const Scene& s) {
       return any_draw(s, [](const SceneDraw& d) {
         return std::any_of(d.vertices.begin(), d.vertices.end(),
                            [&d](const auto& v) { return v.w != d.vertices.front().w; });
       });
     },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) {
         for (corpus::SceneVertex& v : d.vertices) {
           if (v.w > 0) v.x /= v.w, v.y /= v.w, v.z /= v.w;
           v.w = 1;
         }
       }
     }},
    {"triangles of a draw that have numbers of their own",
     [](const Scene& s) {
       return any_draw(
           s, [](const SceneDraw& d) { return !d.triangles.empty() && d.triangles[0].identifier.has_value(); });
     },
     [](Scene& s) {
       for (SceneDraw& d : s.draws) {
         for (auto& t : d.triangles) t.identifier.reset();
       }
     }},
    {"other triangles drawn before it",
     [](const Scene& s) { return s.draws.size() > 1 || (!s.draws.empty() && s.draws[0].triangles.size() > 1); },
     [](Scene& s) {
       s.draws.resize(1);
       auto& triangles = s.draws[0].triangles;  // there may be none in it
       triangles.resize(std::min<std::size_t>(triangles.size(), 1));
     }},
};

// What is not drawn at all is not right, either.
bool is_right(const Trials& trials, const Scene& scene) {
  return !trials.still_wrong(scene) && trials.draw(scene);
}

void add_needs(std::span<const Wrong> wrong, const Trials& trials, std::vector<std::string>& sentences) {
  for (const Part& part : kParts) {
    const auto with = std::count_if(wrong.begin(), wrong.end(), [&part](const Wrong& w) { return part.has(w.scene); });
    if (!most(static_cast<std::size_t>(with), wrong.size())) continue;
    std::size_t gone = 0;
    for (const Wrong& shown : wrong) {
      Scene scene = shown.scene;
      if (!part.has(scene)) continue;
      part.take(scene);
      if (is_right(trials, scene)) ++gone;
    }
    if (!most(gone, static_cast<std::size_t>(with))) continue;
    sentences.push_back(std::string("it is only wrong with ") + part.text);
    return;
  }
}

// Only this output is wrong, of several.
void add_outputs(std::span<const Wrong> wrong, std::vector<std::string>& sentences) {
  std::array<std::size_t, 5> scenes{};
  std::array<bool, 5> given{};
  constexpr std::array<const char*, 5> kNames{"counts", "indices", "depths", "barycentrics", "attributes"};
  for (const Wrong& shown : wrong) {
    const auto &a = shown.right, &b = shown.rival;
    given[0] |= !b.count.empty(), given[1] |= !b.index.empty(), given[2] |= !b.depth.empty();
    given[3] |= !b.barycentrics.empty();
    for (const std::vector<float>& attribute : b.attributes) given[4] |= !attribute.empty();
    scenes[0] += a.count != b.count;
    scenes[1] += !b.index.empty() && a.index != b.index;
    scenes[2] += !b.depth.empty() && !same_floats(a.depth, b.depth);
    scenes[3] += !b.barycentrics.empty() && !same_floats(a.barycentrics, b.barycentrics);
    for (std::size_t k = 0; k < std::min(a.attributes.size(), b.attributes.size()); ++k) {
      if (b.attributes[k].empty() || same_floats(a.attributes[k], b.attributes[k])) continue;
      ++scenes[4];
      break;
    }
  }
  if (std::count(given.begin(), given.end(), true) < 2) return;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    bool alone = most(scenes[i], wrong.size());
    for (std::size_t k = 0; k < scenes.size(); ++k) alone = alone && (k == i || scenes[k] == 0);
    if (alone) sentences.push_back(std::string("only ") + kNames[i] + " are wrong, all else is right");
  }
}

}  // namespace

std::vector<std::string> symptoms(std::span<const Wrong> wrong, std::span<const Scene> fine, const Trials& trials) {
  std::vector<std::string> sentences;
  if (wrong.size() < kLeastScenes) return sentences;
  add_counts(wrong, sentences);
  add_index(wrong, sentences);
  add_depth(wrong, trials.within, sentences);
  add_barycentrics(wrong, trials.within, sentences);
  add_attributes(wrong, trials.within, sentences);
  const auto add = [&sentences](const std::string& sentence) {
    if (!sentence.empty()) sentences.push_back(sentence);
  };
  if (sentences.empty()) add_places(wrong, sentences);
  if (sentences.empty()) add_needs(wrong, trials, sentences);
  if (sentences.empty()) add(which_triangles(wrong, fine, trials));
  if (sentences.empty()) add(how_near_edges(wrong));
  if (sentences.empty()) add(which_scenes(wrong, fine));
  add_outputs(wrong, sentences);
  return sentences;
}

std::vector<std::vector<Scene>> right_without(std::span<const Wrong> wrong, const Trials& trials) {
  constexpr std::size_t kMost = 12;
  std::vector<std::vector<Scene>> all;
  wrong = wrong.first(std::min(wrong.size(), kMost));
  for (const Part& part : kParts) {
    std::vector<Scene> right;
    for (const Wrong& shown : wrong) {
      Scene scene = shown.scene;
      if (!part.has(scene)) continue;
      part.take(scene);
      if (is_right(trials, scene)) right.push_back(std::move(scene));
    }
    if (most(right.size(), wrong.size())) all.push_back(std::move(right));
  }
  return all;
}

}  // namespace surefill::judge
