// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "certify/drivers/driver.hpp"

namespace surefill::drivers {

namespace {

constexpr std::uint32_t kSize = 16;
// No verdict on precision: a state that is wrong is off by far more.
constexpr float kNear = 0x1p-8f;

struct Point {
  double x, y;
};

// A triangle in front of the eye, at one depth. Edges keep 1/32 pixel and more from every standard sample.
struct Plain {
  std::array<Point, 3> corners;
  float depth;
  std::uint32_t identifier;
};
constexpr std::array<Point, 3> kAll{{{-20.28125, -20.28125}, {60.3125, -20.28125}, {-20.28125, 60.3125}}};
constexpr std::array<Point, 3> kSmall{{{2.28125, 3.28125}, {11.3125, 3.28125}, {2.28125, 12.3125}}};
constexpr std::array<Point, 3> kOther{{{13.3125, 6.28125}, {13.3125, 14.3125}, {5.28125, 14.3125}}};

double edge(const Point& a, const Point& b, const Point& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// 1: covered and clockwise on the screen; -1: covered, the other way round; 0: not covered.
int cover(const Plain& triangle, const Point& p) {
  const auto& c = triangle.corners;
  const double a = edge(c[1], c[2], p), b = edge(c[2], c[0], p), d = edge(c[0], c[1], p);
  return a > 0 && b > 0 && d > 0 ? 1 : a < 0 && b < 0 && d < 0 ? -1 : 0;
}

Plain turned(Plain triangle) {
  std::swap(triangle.corners[1], triangle.corners[2]);
  return triangle;
}

// One draw of such triangles, as the adapter gets it, and the image that is due.
class SelfCheck {
 public:
  SelfCheck(Driver& driver, const std::string& what, std::vector<Plain> triangles)
      : what_(what), triangles_(std::move(triangles)), driver_(driver), info_(driver.info()) {
    scene_.width = scene_.height = kSize;
    scene_.samples = 1;
    scene_.draw_count = 1;
    draw_.depth_write = 1;
    draw_.viewport_width = draw_.viewport_height = kSize;
    draw_.viewport_far = 1;
    draw_.viewport_depth_range = info_.model.depth_range;
    draw_.clip_is_exact = 1;
  }

  surefill_adapter_scene& scene() { return scene_; }
  surefill_adapter_draw& draw() { return draw_; }

  // Empty, or what is wrong.
  std::string run() {
    prepare();
    const std::size_t samples = std::size_t{kSize} * kSize * scene_.samples;
    std::vector<std::uint32_t> count(samples), index(samples);
    std::vector<float> depth(samples), barycentrics(3 * samples), values(3 * 2 * samples);
    std::array<float*, 3> value_images{};
    for (std::size_t k = 0; k < 3; ++k) value_images[k] = values.data() + k * 2 * samples;
    const surefill_adapter_image image{count.data(), index.data(), depth.data(), barycentrics.data(),
                                       value_images.data()};
    driver_.draw(scene_, primitives_, image);
    const bool greater = scene_.depth_test == SUREFILL_ADAPTER_GREATER;
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x) {
        for (std::uint32_t n = 0; n < scene_.samples; ++n) {
          const std::uint32_t row = info_.model.y == SUREFILL_ADAPTER_Y_UP ? kSize - 1 - y : y;
          const std::size_t s = (std::size_t{row} * kSize + x) * scene_.samples + n;
          const std::array<int, 2> place = standard_sample(scene_.samples, n);
          const Point p{x + place[0] / 16.0, y + place[1] / 16.0};
          std::uint32_t covers = 0;
          const Plain* seen = nullptr;
          for (const Plain& triangle : triangles_) {
            if (!shows(triangle, p, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y))) continue;
            ++covers;
            if (!seen || (greater ? triangle.depth > seen->depth : triangle.depth < seen->depth)) seen = &triangle;
          }
          if (count[s] != covers) return differs("count", x, y, covers, count[s]);
          const std::uint32_t wanted = seen ? seen->identifier : SUREFILL_ADAPTER_EMPTY;
          if (index[s] != wanted) return differs("index", x, y, wanted, index[s]);
          const float none = (greater ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity();
          if (seen ? !(std::abs(depth[s] - seen->depth) <= kNear) : depth[s] != none) {
            return differs("depth", x, y, seen ? seen->depth : none, depth[s]);
          }
          if (!seen || scene_.samples > 1) continue;
          const auto& c = seen->corners;
          const double area = edge(c[0], c[1], c[2]);
          const std::array<double, 3> weights{edge(c[1], c[2], p) / area, edge(c[2], c[0], p) / area,
                                              edge(c[0], c[1], p) / area};
          for (std::size_t i = 0; i < 3; ++i) {
            const float found = barycentrics[3 * s + i];
            if (!(std::abs(found - weights[i]) <= kNear)) return differs("barycentrics", x, y, weights[i], found);
          }
          // The attribute is 4 i at vertex i: perspective, affine (W is 1 everywhere), that of vertex 0.
          const double smooth = 4 * weights[1] + 8 * weights[2];
          const std::array<double, 3> due{smooth, smooth, 0};
          for (std::size_t k = 0; k < 3; ++k) {
            const float first = value_images[k][2 * s], second = value_images[k][2 * s + 1];
            if (!(std::abs(first - due[k]) <= 8 * kNear)) return differs("attribute", x, y, due[k], first);
            if (!(std::abs(second - 3) <= kNear)) return differs("attribute", x, y, 3, second);
          }
        }
      }
    }
    return "";
  }

 private:
  // Culling, scissor.
  bool shows(const Plain& triangle, const Point& p, std::int32_t x, std::int32_t y) const {
    const int side = cover(triangle, p);
    if (side == 0) return false;
    const bool front = (side > 0) == (draw_.front_face == SUREFILL_ADAPTER_CLOCKWISE);
    if (draw_.cull == SUREFILL_ADAPTER_CULL_FRONT && front) return false;
    if (draw_.cull == SUREFILL_ADAPTER_CULL_BACK && !front) return false;
    const std::int32_t* scissor = draw_.scissor;
    return !draw_.has_scissor || (x >= scissor[0] && y >= scissor[1] && x < scissor[2] && y < scissor[3]);
  }

  void prepare() {
    for (const Plain& triangle : triangles_) {
      for (const Point& p : triangle.corners) {
        const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y);
        const bool unsigned_depth = info_.model.depth_range == SUREFILL_ADAPTER_ZERO_TO_ONE;
        pixel_.insert(pixel_.end(), {x, y, triangle.depth, 1});
        clip_.insert(clip_.end(), {x / (kSize / 2) - 1, 1 - y / (kSize / 2),
                                   unsigned_depth ? triangle.depth : 2 * triangle.depth - 1, 1});
        indices_.push_back(static_cast<std::uint32_t>(indices_.size()));
        const auto corner = static_cast<float>((indices_.size() - 1) % 3);
        values_.insert(values_.end(), {4 * corner, 3});
      }
      identifiers_.push_back(triangle.identifier);
    }
    for (std::size_t k = 0; k < 3; ++k) attributes_[k] = {values_.data(), 2, static_cast<std::uint32_t>(k)};
    draw_.vertex_count = static_cast<std::uint32_t>(indices_.size());
    draw_.triangle_count = static_cast<std::uint32_t>(triangles_.size());
    draw_.pixel = pixel_.data();
    draw_.clip = clip_.data();
    draw_.indices = indices_.data();
    draw_.identifiers = identifiers_.data();
    draw_.attributes = attributes_.data();
    scene_.attribute_count = 3;
    scene_.draws = &draw_;
  }

  std::string differs(const char* output, std::uint32_t x, std::uint32_t y, double expected, double actual) const {
    const auto number = [](double value) {
      return value == static_cast<double>(SUREFILL_ADAPTER_EMPTY) ? std::string("none") : std::to_string(value);
    };
    return what_ + ": " + output + " at pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " +
           number(actual) + " instead of " + number(expected) + "; some state is not what the adapter needs";
  }

  std::string what_;
  std::vector<Plain> triangles_;
  Driver& driver_;
  surefill_adapter_info info_;
  surefill_adapter_scene scene_{};
  surefill_adapter_draw draw_{};
  Primitives primitives_;
  std::vector<float> pixel_, clip_, values_;
  std::vector<std::uint32_t> indices_, identifiers_;
  std::array<surefill_adapter_attribute, 3> attributes_{};
};

// A level line along a row of pixel centres, or a point beside one, alone: which pixels are drawn for certain, and which
// are not. Every standard agrees on these.
std::string check_primitive(Driver& driver, std::uint32_t kind) {
  const surefill_adapter_info info = driver.info();
  const bool line = kind == SUREFILL_ADAPTER2_LINES;
  const std::array<Point, 2> ends =
      line ? std::array<Point, 2>{{{2.25, 9.5}, {12.25, 9.5}}} : std::array<Point, 2>{{{5.25, 9.25}, {5.25, 9.25}}};
  std::vector<float> pixel, clip;
  for (const Point& p : ends) {
    const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y);
    pixel.insert(pixel.end(), {x, y, 0.5f, 1});
    clip.insert(clip.end(), {x / (kSize / 2) - 1, 1 - y / (kSize / 2),
                             info.model.depth_range == SUREFILL_ADAPTER_ZERO_TO_ONE ? 0.5f : 0.0f, 1});
  }
  const std::array<std::uint32_t, 2> indices{0, 1};
  const std::uint32_t identifier = 4;
  surefill_adapter_draw draw{};
  draw.vertex_count = 2;
  draw.triangle_count = draw.clip_is_exact = draw.depth_write = 1;
  draw.pixel = pixel.data();
  draw.clip = clip.data();
  draw.indices = indices.data();
  draw.identifiers = &identifier;
  draw.viewport_width = draw.viewport_height = kSize;
  draw.viewport_far = 1;
  draw.viewport_depth_range = info.model.depth_range;
  surefill_adapter_scene scene{};
  scene.width = scene.height = kSize;
  scene.samples = scene.draw_count = 1;
  scene.draws = &draw;
  std::vector<std::uint32_t> count(std::size_t{kSize} * kSize), index(count.size());
  surefill_adapter_image image{};
  image.count = count.data();
  image.index = index.data();
  driver.draw(scene, {{kind, 0}}, image);
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const std::uint32_t row = info.model.y == SUREFILL_ADAPTER_Y_UP ? kSize - 1 - y : y;
      const std::size_t s = std::size_t{row} * kSize + x;
      const bool inside = line ? y == 9 && x >= 4 && x <= 10 : x == 5 && y == 9;
      const bool outside = line ? y < 8 || y > 10 || x < 1 || x > 13 : !inside;
      const bool covered = count[s] == 1 && index[s] == identifier, empty = count[s] == 0;
      if ((inside && !covered) || (outside && !empty)) {
        return std::string(line ? "a line" : "a point") + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) +
               ") has count " + std::to_string(count[s]) + "; some state is not what the adapter needs";
      }
    }
  }
  return "";
}

}  // namespace

std::string self_check(Driver& driver) {
  const std::vector<Plain> scene{{kAll, 0.75f, 5}, {kSmall, 0.25f, 7}, turned({kOther, 0.5f, 9})};
  const auto check = [&driver, &scene](const std::string& what, const auto& change) {
    SelfCheck checked(driver, what, scene);
    change(checked);
    return checked.run();
  };
  std::string problem;
  const auto all = [&](std::initializer_list<std::string> problems) {
    for (const std::string& text : problems) {
      if (problem.empty()) problem = text;
    }
  };
  all({check("a plain scene", [](SelfCheck&) {}),
       check("culled back faces", [](SelfCheck& c) { c.draw().cull = SUREFILL_ADAPTER_CULL_BACK; }),
       check("culled front faces",
             [](SelfCheck& c) {
               c.draw().cull = SUREFILL_ADAPTER_CULL_FRONT;
               c.draw().front_face = SUREFILL_ADAPTER_COUNTER_CLOCKWISE;
             }),
       check("a scissor",
             [](SelfCheck& c) {
               c.draw().has_scissor = 1;
               const std::int32_t scissor[4] = {3, 2, 12, 9};
               std::copy(std::begin(scissor), std::end(scissor), c.draw().scissor);
             }),
       check("depth test greater", [](SelfCheck& c) { c.scene().depth_test = SUREFILL_ADAPTER_GREATER; }),
       check("depth clipping", [](SelfCheck& c) { c.draw().depth_mode = SUREFILL_ADAPTER_CLIP_DEPTH; })});
  for (const std::uint32_t kind : {std::uint32_t{SUREFILL_ADAPTER2_LINES}, std::uint32_t{SUREFILL_ADAPTER2_POINTS}}) {
    if (problem.empty() && (driver.primitives() >> kind & 1u) != 0) problem = check_primitive(driver, kind);
  }
  if (!(driver.info().features & SUREFILL_ADAPTER_SAMPLES)) return problem;
  for (const std::uint32_t samples : {2u, 4u, 8u, 16u}) {
    if (!problem.empty()) break;
    try {
      problem =
          check(std::to_string(samples) + " samples a pixel", [samples](SelfCheck& c) { c.scene().samples = samples; });
    } catch (const NotJudged&) {
      continue;  // a number of samples that the driver lacks
    }
  }
  return problem;
}

}  // namespace surefill::drivers
