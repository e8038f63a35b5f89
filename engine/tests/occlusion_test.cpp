// SPDX-License-Identifier: Apache-2.0
//
// Occlusion queries against their definition (O2, O3), worked out pixel by pixel with other formulas, and against the
// theorem that they exist for (T6): what is not visible changes nothing, and the oracle draws it.
#include "surefill/occlusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "oracle/oracle.hpp"

namespace surefill {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Many coincidences: positions and depths on coarse lattices, W among powers of two and others, some behind the eye.
class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}

  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool one_in(int n) { return integer(1, n) == 1; }

  // A coordinate around a target of `size` pixels: whole pixels, pixel centres, or anything.
  float coordinate(int size) {
    const auto whole = static_cast<float>(integer(-size / 4, size + size / 4));
    if (one_in(3)) return whole;
    return one_in(2) ? whole + 0.5f : whole + std::uniform_real_distribution<float>(0, 1)(random_);
  }
  float depth() { return static_cast<float>(integer(-8, 24)) / 16; }
  float w() {
    constexpr float kScales[] = {1, 1, 0.25f, 4, 3, 0.7f, 0x1p-100f, 1e30f};
    return kScales[integer(0, 7)];
  }

  // A vertex at pixel (x, y), at depth z.
  Vertex vertex(float x, float y, float z) {
    const float w = this->w();
    return {x * w, y * w, z * w, w};
  }

  OcclusionBox box(int width, int height) {
    OcclusionBox box;
    const float x = coordinate(width), y = coordinate(height), z = depth();
    const int extent = one_in(3) ? 3 : one_in(2) ? 10 : width;
    for (Vertex& v : box.corners) {
      const auto dx = static_cast<float>(integer(0, extent)), dy = static_cast<float>(integer(0, extent));
      v = vertex(x + dx / 2, y + dy / 2, z + static_cast<float>(integer(0, 4)) / 16);
    }
    if (one_in(12)) {
      for (Vertex& v : box.corners) {
        if (one_in(2)) v.w = one_in(3) ? 0.0f : -v.w;
      }
    }
    if (one_in(40)) {
      for (Vertex& v : box.corners) v.w = -std::fabs(v.w);
    }
    return box;
  }

  OcclusionRectangle rectangle(int width, int height) {
    const float x = coordinate(width), y = coordinate(height);
    return {x, y, x + static_cast<float>(integer(-1, width)) / 2, y + static_cast<float>(integer(-1, height)) / 2,
            one_in(20) ? (one_in(2) ? kInfinity : -kInfinity) : depth()};
  }

 private:
  std::mt19937_64 random_;
};

struct Occluders {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  Occluders(Source& source, int width, int height) {
    const int triangles = source.integer(0, 12);
    for (int t = 0; t < triangles; ++t) {
      const float z = source.depth();
      for (int i = 0; i < 3; ++i) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.push_back(source.vertex(source.coordinate(3 * width) - static_cast<float>(width),
                                         source.coordinate(3 * height) - static_cast<float>(height),
                                         source.one_in(3) ? source.depth() : z));
      }
    }
  }
  Draw draw() const {
    Draw d;
    d.vertices = vertices, d.indices = indices;
    return d;
  }
};

// O3 pixel by pixel. `reaches(axis, centre)`: is the centre within the rectangle along the axis?
template <typename Reaches>
Occlusion answer_of(const OcclusionBuffer& buffer, DepthTest test, float nearest, Reaches reaches) {
  Occlusion answer = Occlusion::outside;
  for (int y = 0; y < buffer.height(); ++y) {
    for (int x = 0; x < buffer.width(); ++x) {
      if (!reaches(0, x + 0.5) || !reaches(1, y + 0.5)) continue;
      const float stored = buffer.depth()[static_cast<std::size_t>(y * buffer.width() + x)];
      if (test == DepthTest::less ? nearest < stored : nearest > stored) return Occlusion::visible;
      answer = Occlusion::hidden;
    }
  }
  return answer;
}

Occlusion expected_answer(const OcclusionBuffer& buffer, DepthTest test, const OcclusionBox& box) {
  const double sign = test == DepthTest::less ? 1 : -1;
  double nearest = HUGE_VAL;
  int in_front = 0;
  for (const Vertex& v : box.corners) {
    if (!(v.w > 0)) continue;
    ++in_front;
    nearest = std::min(nearest, sign * (static_cast<double>(v.z) / v.w));
  }
  if (in_front == 0) return Occlusion::outside;
  if (in_front < 8) return Occlusion::visible;  // these images have no pixel nearer than anything
  // c W and X are exact in double: 39 and 24 bits.
  const auto reaches = [&](int axis, double centre) {
    bool below = false, above = false;
    for (const Vertex& v : box.corners) {
      const double position = axis == 0 ? v.x : v.y, at_centre = centre * v.w;
      below |= position <= at_centre;
      above |= position >= at_centre;
    }
    return below && above;
  };
  return answer_of(buffer, test, static_cast<float>(sign * nearest), reaches);
}

Occlusion expected_answer(const OcclusionBuffer& buffer, DepthTest test, const OcclusionRectangle& r) {
  return answer_of(buffer, test, r.nearest_depth, [&](int axis, double centre) {
    return axis == 0 ? r.x0 <= centre && centre <= r.x1 : r.y0 <= centre && centre <= r.y1;
  });
}

// Sizes on both sides of one, two and three levels of blocks.
constexpr std::pair<int, int> kSizes[] = {{1, 1}, {8, 8}, {9, 7}, {23, 40}, {64, 65}, {130, 33}, {600, 70}};

TEST(Occlusion, AnswersAreTheDefinition) {
  int counts[3] = {};
  for (std::uint64_t seed = 0; seed < 210; ++seed) {
    Source source(seed);
    const auto [width, height] = kSizes[seed % std::size(kSizes)];
    const DepthTest test = seed % 2 == 0 ? DepthTest::less : DepthTest::greater;
    OcclusionBuffer buffer;
    ASSERT_EQ(buffer.resize(width, height, test), Status::ok);
    const Occluders occluders(source, width, height);
    const Draw draw = occluders.draw();
    ASSERT_EQ(buffer.draw({&draw, 1}), Status::ok);
    std::vector<OcclusionBox> boxes(40);
    std::vector<OcclusionRectangle> rectangles(40);
    for (OcclusionBox& box : boxes) box = source.box(width, height);
    for (OcclusionRectangle& r : rectangles) r = source.rectangle(width, height);
    std::vector<Occlusion> of_boxes(boxes.size()), of_rectangles(rectangles.size());
    ASSERT_EQ(buffer.query(boxes, of_boxes), Status::ok);
    ASSERT_EQ(buffer.query(rectangles, of_rectangles), Status::ok);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ASSERT_EQ(of_boxes[i], expected_answer(buffer, test, boxes[i])) << "seed " << seed << ", box " << i;
      ASSERT_EQ(of_rectangles[i], expected_answer(buffer, test, rectangles[i])) << "seed " << seed << ", " << i;
      ++counts[static_cast<int>(of_boxes[i])];
    }
  }
  // Each answer is given often, or this shows little.
  EXPECT_GT(counts[0], 500);
  EXPECT_GT(counts[1], 500);
  EXPECT_GT(counts[2], 500);
}

// T6: all 56 triangles over the corners of a box that is not visible, drawn by the oracle, change nothing.
TEST(Occlusion, NeverWrong) {
  constexpr int kWidth = 21, kHeight = 17;
  constexpr std::size_t kPixels = kWidth * kHeight;
  int drawn = 0, changed_visible = 0;
  for (std::uint64_t seed = 1000; seed < 1060; ++seed) {
    Source source(seed);
    const DepthTest test = seed % 2 == 0 ? DepthTest::less : DepthTest::greater;
    OcclusionBuffer buffer;
    ASSERT_EQ(buffer.resize(kWidth, kHeight, test), Status::ok);
    const Occluders occluders(source, kWidth, kHeight);
    const Draw occluder_draw = occluders.draw();
    ASSERT_EQ(buffer.draw({&occluder_draw, 1}), Status::ok);
    for (int i = 0; i < 30; ++i) {
      const OcclusionBox box = source.box(kWidth, kHeight);
      Occlusion answer;
      ASSERT_EQ(buffer.query({&box, 1}, {&answer, 1}), Status::ok);
      if (answer == Occlusion::visible && i % 8 != 0) continue;
      std::vector<std::uint32_t> indices;
      for (std::uint32_t a = 0; a < 8; ++a) {
        for (std::uint32_t b = a + 1; b < 8; ++b) {
          for (std::uint32_t c = b + 1; c < 8; ++c) indices.insert(indices.end(), {a, b, c});
        }
      }
      Draw draw;
      draw.vertices = box.corners, draw.indices = indices;
      draw.fill_rule = static_cast<FillRule>(source.integer(0, 7));
      draw.depth_mode = source.one_in(2) ? DepthMode::none : DepthMode::clip;
      std::vector<float> depth(kPixels);
      std::vector<std::uint32_t> index(kPixels);
      Target target;
      target.width = kWidth, target.height = kHeight, target.depth_test = test;
      target.depth = depth, target.index = index, target.initial_depth = buffer.depth();
      oracle::render(target, {&draw, 1});
      const bool unchanged = std::memcmp(depth.data(), buffer.depth().data(), kPixels * sizeof(float)) == 0 &&
                             std::all_of(index.begin(), index.end(), [](auto t) { return t == kNoTriangle; });
      if (answer == Occlusion::visible) {
        changed_visible += !unchanged;
      } else {
        ++drawn;
        ASSERT_TRUE(unchanged) << "seed " << seed << ", box " << i;
      }
    }
  }
  EXPECT_GT(drawn, 500);
  EXPECT_GT(changed_visible, 20);  // "visible" is no idle answer either
}

TEST(Occlusion, WrongCallsWriteNothing) {
  OcclusionBuffer buffer;
  EXPECT_EQ(buffer.resize(0, 4), Status::target_size);
  EXPECT_EQ(buffer.resize(4, kMaxTargetSize + 1), Status::target_size);
  EXPECT_EQ(buffer.resize(4, 4, static_cast<DepthTest>(2)), Status::target_depth_test);
  EXPECT_EQ(buffer.draw({}), Status::target_size);
  EXPECT_EQ(buffer.width(), 0);
  EXPECT_TRUE(buffer.depth().empty());

  ASSERT_EQ(buffer.resize(4, 4), Status::ok);
  EXPECT_EQ(buffer.resize(-1, 4), Status::target_size);
  EXPECT_EQ(buffer.width(), 4);  // as it was
  EXPECT_EQ(buffer.draw({static_cast<const Draw*>(nullptr), 1}), Status::draws);
  const Vertex vertices[] = {{0, 0, 0, 1}, {9, 0, 0, 1}, {0, 9, 0, 1}};
  const std::uint32_t indices[] = {0, 1, 3};
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  EXPECT_EQ(buffer.draw({&draw, 1}), Status::draw_index_out_of_range);
  Options options;
  options.threads = 0;
  EXPECT_EQ(buffer.draw({}, nullptr, options), Status::options_threads);
  EXPECT_TRUE(std::all_of(buffer.depth().begin(), buffer.depth().end(), [](float z) { return z == kInfinity; }));

  OcclusionBox boxes[2] = {};
  OcclusionRectangle rectangles[2] = {{0, 0, 4, 4, 0}, {0, 0, 4, 4, std::nanf("")}};
  const auto before = static_cast<Occlusion>(77);
  Occlusion answers[2] = {before, before};
  EXPECT_EQ(buffer.query(boxes, std::span(answers, 1)), Status::query_answers);
  EXPECT_EQ(buffer.query(boxes, {static_cast<Occlusion*>(nullptr), 2}), Status::query_answers);
  EXPECT_EQ(buffer.query(std::span<const OcclusionBox>(static_cast<OcclusionBox*>(nullptr), 2), answers),
            Status::query_boxes);
  boxes[1].corners[7].z = kInfinity;
  EXPECT_EQ(buffer.query(boxes, answers), Status::query_boxes);
  EXPECT_EQ(buffer.query(rectangles, answers), Status::query_boxes);
  EXPECT_EQ(answers[0], before);
  EXPECT_EQ(answers[1], before);
}

TEST(Occlusion, MovesAndClears) {
  OcclusionBuffer a;
  ASSERT_EQ(a.resize(16, 16), Status::ok);
  const Vertex vertices[] = {{-40, -40, 0, 1}, {90, -40, 0, 1}, {-40, 90, 0, 1}};
  const std::uint32_t indices[] = {0, 1, 2};
  Draw draw;
  draw.vertices = vertices, draw.indices = indices;
  ASSERT_EQ(a.draw({&draw, 1}), Status::ok);
  const OcclusionRectangle r{2, 2, 9, 9, 1};
  Occlusion answer;
  ASSERT_EQ(a.query({&r, 1}, {&answer, 1}), Status::ok);
  EXPECT_EQ(answer, Occlusion::hidden);
  OcclusionBuffer b(std::move(a));
  ASSERT_EQ(b.query({&r, 1}, {&answer, 1}), Status::ok);
  EXPECT_EQ(answer, Occlusion::hidden);
  OcclusionBuffer c;
  c = std::move(b);
  c.clear();
  ASSERT_EQ(c.query({&r, 1}, {&answer, 1}), Status::ok);
  EXPECT_EQ(answer, Occlusion::visible);
}

}  // namespace
}  // namespace surefill
