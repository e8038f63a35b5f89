// SPDX-License-Identifier: Apache-2.0
//
// The judge on rasterizers that are right in their own way: its model is found, and nobody is accused. They are those of
// mutation/zoo/right.hpp, drawn in this process; A1 to A14 are the kinds of right behaviour that were once called wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "certify/judge/images.hpp"
#include "certify/judge/inference.hpp"
#include "certify/judge/questions.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/frame.hpp"
#include "certify/rivals/model.hpp"
#include "mutation/zoo/right.hpp"
#include "oracle/oracle.hpp"
#include "properties/generators/generators.hpp"

namespace surefill::judge {
namespace {

using zoo::Choices;

// The control: integers, 8 bits, nearest-up, top-left, float32 depth.
Choices control() {
  Choices choices{};
  choices[zoo::kBits] = 1;
  return choices;
}

Choices with(std::initializer_list<std::pair<zoo::Choice, int>> changes) {
  Choices choices = control();
  for (const auto& [choice, value] : changes) choices[choice] = value;
  return choices;
}

class Right : public Rival {
 public:
  explicit Right(const Choices& choices, bool onscreen_only = false)
      : choices_(choices), onscreen_only_(onscreen_only) {}
  const Choices& choices() const { return choices_; }
  corpus::Outputs outputs() const override { return {true, true, true, false, false}; }
  double position_step() const override { return 0; }
  corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Outputs outputs = wanted;
    outputs.barycentrics = outputs.attributes = false;
    corpus::Frame frame(scene, outputs);
    for (const Draw& draw : frame.draws()) {
      for (const Vertex& v : draw.vertices) {
        if (!(v.w > 0) || (onscreen_only_ && (v.x < 0 || v.y < 0))) throw Declined("not such a vertex");
      }
    }
    const adapters::AdapterFrame adapted(frame.target(), frame.draws());
    if (!zoo::draw_right(choices_, adapted.scene(), adapted.image())) throw Declined("too far");
    return std::move(frame.image());
  }

 private:
  Choices choices_;
  bool onscreen_only_;
};

// Random scenes held to what was found, and how many samples were judged.
std::uint64_t judged_samples(Right& rival, const Inference& found, const std::string& name,
                             std::uint64_t scenes = 400) {
  Terms terms;
  terms.model = found.model;
  terms.known = found.known;
  std::uint64_t judged = 0;
  properties::SceneLimits limits;
  limits.state = limits.attributes = false;
  const auto categories = properties::categories();
  for (std::uint64_t n = 0; n < scenes; ++n) {
    corpus::Scene scene = properties::random_scene(categories[n % categories.size()], n, limits);
    for (corpus::SceneDraw& draw : scene.draws) {
      draw.viewport.reset();
      // Who clips depth gets what has to be clipped.
      const int clip = rival.choices()[zoo::kClip];
      if (clip == 3) draw.depth_mode = DepthMode::clip;
      for (corpus::SceneVertex& v : draw.vertices) {
        const float w = std::max(v.w, 0.0f);
        v.z = std::clamp(v.z, clip == 0 ? 0 : -w, clip == 0 ? w : 2 * w);
      }
    }
    corpus::Frame frame(scene, rival.outputs());
    const Frame seen{scene.width, scene.height, scene.samples, scene.depth_test, false, frame.draws()};
    if (!why_open(terms, seen).empty()) continue;
    corpus::Image image;
    try {
      image = rival.draw(scene, rival.outputs());
    } catch (const Declined&) {
      continue;
    }
    const Judgement judgement = judge_image(adapters::oracle_expected(), terms, seen, image, {}, scene.attributes);
    EXPECT_EQ(judgement.differences, 0u) << name << ", scene " << n << ": " << judgement.finding << "\n"
                                         << describe(found.model) << "\n"
                                         << corpus::write_scene(scene);
    if (judgement.differences != 0) break;
    judged += judgement.samples;
  }
  return judged;
}

struct Case {
  const char* name;
  Choices choices;
  bool onscreen_only;
  const char* says;  // among what describes the model, or departs from the usual one
};

TEST(Judge, RightBehaviourIsFoundAndNotAccused) {
  using namespace zoo;
  const Case cases[] = {
      {"control", control(), false, "grid of 8 bits, nearest-up; fill rule top-left"},
      {"A2, on screen only", control(), true, "grid of 8 bits, nearest-up"},
      {"A3, float32 on the way", with({{kBlur, 1}}), false, "blurred by up to"},
      {"A4, floor", with({{kRounding, 3}}), false, "grid of 8 bits, floor"},
      {"A5, the corner", with({{kPlace, 1}}), false, "samples are taken half a pixel to the left and half a pixel"},
      {"A6, depth in double", with({{kFormat, 1}}), false, "grid of 8 bits"},
      {"A7, depth of 24 bits", with({{kFormat, 2}}), false, "depth of 24 bits"},
      {"A7, depth of 16 bits", with({{kFormat, 3}}), false, "depth of 16 bits"},
      {"A8, from -1 to 1", with({{kRange, 1}}), false, "depth has no more bits near 0 than elsewhere"},
      {"A9, cleared to 1", with({{kClear, 1}}), false, "depth is cleared to 1"},
      {"A10, LEQUAL", with({{kTest, 1}}), false, "of equal depths the later one comes"},
      {"A11, clips always", with({{kClip, 1}}), false, "it always clips depth to 0 to 1"},
      {"cuts at near and far", with({{kClip, 2}, {kBits, 2}}), false, "it always clips depth to 0 to 1"},
      {"cuts where it is asked to", with({{kClip, 3}, {kBits, 2}}), false, "grid of 4 bits"},
      {"cuts near the target", with({{kBorder, 1}, {kBits, 2}}), false,
       "edges of triangles that reach beyond the target"},
      {"cuts far from it", with({{kBorder, 2}}), false, "edges of triangles that reach"},
      {"A12, a near plane", with({{kNear, 1}}), false, "it draws nothing of W below 0.0156"},
      {"A14, turned ones left out", with({{kSlivers, 1}, {kBits, 2}}), false, "grid of 4 bits"},
      {"A14, small ones left out", with({{kSlivers, 2}}), false, "it leaves out small triangles"},
      {"A14, culls one side", with({{kFacing, 1}}), false, "it always leaves out back faces"},
      {"both own level edges", with({{kOwners, 5}}), false, "both sides own level edges"},
      {"closed", with({{kOwners, 3}}), false, "fill rule closed"},
      {"by facing", with({{kOwners, 6}}), false, "of back faces bottom-right"},
      {"by order", with({{kOwners, 7}}), false, "who owns samples on their edges"},
      {"a viewport of a pixel less", with({{kViewport, 1}}), false, "the viewport is 1 pixels too small"},
      {"double without a grid", with({{kCode, 2}, {kBits, 0}}), false, "positions exact"},
      {"7/12", with({{kPlace, 3}}), false, "samples at (0.58"},
      {"other bits in y", with({{kOtherBits, 1}}), false, "y: 6 bits"},
  };
  for (const Case& one : cases) {
    Right rival(one.choices, one.onscreen_only);
    const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
    std::string words = describe(found.model);
    for (const std::string& sentence : departures(found.model)) words += "\n" + sentence;
    EXPECT_TRUE(found.known) << one.name << ": " << words << "\n" << turns_text(found.turns);
    EXPECT_TRUE(found.problems.empty()) << one.name << ": " << found.problems.front();
    EXPECT_NE(words.find(one.says), std::string::npos) << one.name << ": " << words;
    EXPECT_GT(judged_samples(rival, found, one.name), one.onscreen_only ? 1000u : 5000u) << one.name;
  }
}

// All of the pairwise array, and mixtures that are not in it. `./dev test all` certifies the former at quick level.
TEST(Judge, RightRasterizersAreNotAccused) {
  std::vector<Choices> all = zoo::right_rasterizers();
  Random random(0x2164);
  for (int n = 0; n < 36; ++n) {
    Choices& choices = all.emplace_back();
    for (std::size_t k = 0; k < zoo::kNumberOfChoices; ++k) choices[k] = random.below(zoo::kChoices[k]);
  }
  for (const Choices& choices : all) {
    Right rival(choices);
    const Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
    EXPECT_TRUE(found.problems.empty()) << zoo::right_text(choices) << ": " << found.problems.front();
    EXPECT_TRUE(found.known) << zoo::right_text(choices);
    // A cut whose new vertices move is found nearer than it is, by half and more; blur as large as that hides it.
    const int bits = std::min(found.model.x.bits, found.model.y.bits);
    const bool moves =
        bits >= 0 && bits < 16 && std::max(found.model.x.blur, found.model.y.blur) < std::ldexp(0.125, -bits);
    if (moves && choices[zoo::kBorder] > 0) {
      EXPECT_LE(2 * found.model.band, zoo::cuts_beyond(choices)) << zoo::right_text(choices);
    }
    EXPECT_GT(judged_samples(rival, found, zoo::right_text(choices), 200), 2000u) << zoo::right_text(choices);
  }
}

// A1: where no model is found, nobody is judged by the scene's own fill rule or grid.
TEST(Judge, WithoutAModelOnlyWhatHoldsUnderEachIsOwed) {
  using namespace zoo;
  for (const Choices& choices :
       {control(), with({{kOwners, 1}}), with({{kOwners, 3}}), with({{kPlace, 1}}), with({{kRounding, 3}}),
        with({{kBits, 3}, {kRounding, 5}}), with({{kFormat, 3}, {kClear, 1}}), with({{kCode, 1}, {kBits, 0}})}) {
    Right rival(choices);
    Inference nothing;
    nothing.model = least_known_model();
    nothing.model.format = oracle::DepthFormat::unorm16;
    nothing.model.clear = 1;
    EXPECT_GT(judged_samples(rival, nothing, right_text(choices)), 1000u);
  }
}

// One that is right but for its values: depth is half of what it should be.
class HalfDepth : public Right {
 public:
  using Right::Right;
  corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Image image = Right::draw(scene, wanted);
    for (float& z : image.depth) z = std::isfinite(z) ? z / 2 : z;
    return image;
  }
};

// Away from edges values are judged without a model, too.
TEST(Judge, WrongDepthsAreFoundWithoutAModel) {
  Terms nothing;
  nothing.model = least_known_model();
  const corpus::Scene scene = flat_scene(16, 16, {{{{1, 1}, {15, 1}, {1, 15}}}}, 0.75f);
  for (const bool wrong : {false, true}) {
    Right right(control());
    HalfDepth half(control());
    Right& rival = wrong ? half : right;
    corpus::Frame frame(scene, rival.outputs());
    const Judgement judgement =
        judge_image(adapters::oracle_expected(), nothing, {16, 16, 1, DepthTest::less, false, frame.draws()},
                    rival.draw(scene, rival.outputs()), {}, {});
    EXPECT_GT(judgement.samples, 20u);
    EXPECT_EQ(judgement.differences > 0, wrong) << judgement.finding;
    EXPECT_EQ(judgement.finding.rfind("depth at", 0) == 0, wrong) << judgement.finding;
  }
}

// R13: at samples whose cover is open, what is visible is still a triangle that may be there, in the range of its vertices.
TEST(Judge, RangesHoldAtOpenSamples) {
  Terms nothing;
  nothing.model = least_known_model();
  corpus::Scene scene = flat_scene(4, 4, {{{{1, 1}, {3, 1}, {1, 3}}}}, 0.5f);
  scene.attributes = {{"a", 1, Interpolation::perspective}};
  for (corpus::SceneVertex& v : scene.draws[0].vertices) v.attributes = {2};
  corpus::Frame frame(scene, {true, true, true, false, true});
  const std::span<const Draw> draws = frame.draws();
  struct {
    float depth, attribute;
    std::uint32_t index, count;
    const char* finding;
  } const cases[] = {
      {0.5f, 2, 0, 1, ""},
      {0.75f, 2, 0, 1, "depth at pixel (1, 1)"},
      {0.5f, 2.5f, 0, 1, "a at pixel (1, 1)"},
      {0.5f, NAN, 0, 1, "a at pixel (1, 1)"},
      {NAN, 2, 0, 1, "depth at pixel (1, 1)"},
      {0.5f, 2, 7, 1, "index at pixel (1, 1)"},
      {INFINITY, 0, kNoTriangle, 0, ""},
  };
  for (const auto& one : cases) {
    corpus::Image image = frame.image();
    image.index.assign(16, kNoTriangle);
    image.depth.assign(16, INFINITY);
    image.attributes[0].assign(16, 0);
    image.count.assign(16, 0);
    image.count[5] = one.count;
    image.index[5] = one.index;
    image.depth[5] = one.depth;
    image.attributes[0][5] = one.attribute;
    const Judgement judgement = judge_image(adapters::oracle_expected(), nothing,
                                            {4, 4, 1, DepthTest::less, false, draws}, image, {}, scene.attributes);
    EXPECT_EQ(judgement.finding.substr(0, std::string(one.finding).size()), one.finding) << judgement.finding;
    EXPECT_EQ(judgement.differences, *one.finding ? 1u : 0u);
    EXPECT_EQ(judgement.open, *one.finding ? 14u : 15u);  // one corner is out of reach
    EXPECT_EQ(judgement.samples + judgement.open, 16u);
  }
}

// G2: where a triangle that is cut covers nothing itself, but what the grid makes of it does, values are those of vertex 0.
TEST(Judge, ValuesOfVertexZeroAreGrantedWhereG2HasThem) {
  const std::array<std::array<corpus::SceneVertex, 3>, 3> triangles{{
      {{{16, -19, 0, 2, {}}, {-12, 14, 0, -2, {}}, {-36, 43, 0, -4, {}}}},  // D is 0
      {{{0x1.c0784p+30f, -0x1.7e84p+31f, 0x1.70bp+23f, 0x1.70bp+24f, {}},   // and nearly so
        {-0x1.63a34p+20f, 751820, -0x1.c8p+16f, -0x1.ca7ep+17f, {}},
        {-0x1.c0734p+11f, 0x1.7e878p+12f, -0x1.703p+4f, -0x1.703p+5f, {}}}},
      {{{0, 0, 0, 1, {}}, {4, 0, 0, 1, {}}, {0, -4, 0, -1, {}}}},  // an ordinary one
  }};
  for (const auto& triangle : triangles) {
    corpus::Scene scene = empty_scene(1, 1);
    add_triangle(scene.draws[0], triangle);
    corpus::Frame frame(scene, {true, true, false, true, false});
    corpus::Image image = frame.image();
    image.count = {1};
    image.index = {0};
    image.barycentrics = {1, 0, 0};
    Terms terms;
    terms.known = true;
    for (oracle::AxisModel* axis : {&terms.model.x, &terms.model.y}) axis->bits = 8;
    const Judgement judgement = judge_image(adapters::oracle_expected(), terms,
                                            {1, 1, 1, DepthTest::less, false, frame.draws()}, image, {}, {});
    EXPECT_EQ(judgement.differences == 0, &triangle != &triangles[2]) << judgement.finding;
  }
}

// M5: a draw that writes no depth leaves what was there.
TEST(Judge, DepthThatIsNotWrittenStays) {
  Terms terms;
  terms.known = true;
  corpus::Scene scene = flat_scene(4, 4, {{{{0, 0}, {4, 0}, {0, 4}}}}, 0.5f);
  scene.draws[0].depth_write = false;
  corpus::Frame frame(scene, {true, true, true, false, false});
  for (const float depth : {INFINITY, 0.5f}) {
    corpus::Image image = frame.image();
    const Frame seen{4, 4, 1, DepthTest::less, false, frame.draws()};
    image.count = counts_under(adapters::oracle_expected(), terms, seen).least;
    image.index.assign(16, kNoTriangle);
    image.depth.assign(16, INFINITY);
    for (std::size_t s = 0; s < 16; ++s) {
      if (image.count[s] == 1) image.index[s] = 0, image.depth[s] = depth;
    }
    const Judgement judgement = judge_image(adapters::oracle_expected(), terms, seen, image, {}, {});
    EXPECT_EQ(judgement.finding.rfind("depth, which is not written, at pixel", 0) == 0, depth == 0.5f)
        << judgement.finding;
    EXPECT_EQ(judgement.values.size(), judgement.differences);
  }
}

// R12, M5: of triangles whose depths lie apart the visible one is known, whoever wrote what, and so are its values.
TEST(Judge, WhoIsVisibleIsKnownWhereDepthsLieApart) {
  Terms terms;
  terms.known = true;
  for (const bool known : {true, false}) {
    for (const bool initial : {false, true}) {
      corpus::Scene scene = empty_scene(4, 4);
      scene.attributes = {{"a", 1, Interpolation::perspective}};
      scene.draws.resize(3);
      const std::array<double, 3> depths{0.5, 0.25, 0.75};
      for (std::size_t d = 0; d < 3; ++d) {
        auto corners = std::array{corner(-4, -4, depths[d]), corner(20, -4, depths[d]), corner(-4, 20, depths[d], 4)};
        for (std::size_t i = 0; i < 3; ++i) corners[i].attributes = {static_cast<float>(i)};
        add_triangle(scene.draws[d], corners);
      }
      scene.draws[1].depth_write = false;
      scene.draws[1].interpolations = {Interpolation::noperspective};
      if (initial) scene.initial_depth = {0.375f};
      corpus::Frame frame(scene, {true, true, true, false, true});
      oracle::render(frame.target(), frame.draws());
      const Frame seen{4,
                       4,
                       1,
                       DepthTest::less,
                       initial,
                       frame.draws(),
                       known ? frame.target().initial_depth : std::span<const float>{}};
      const auto finding = [&](const corpus::Image& image) {
        return judge_image(adapters::oracle_expected(), terms, seen, image, {}, scene.attributes).finding;
      };
      EXPECT_EQ(finding(frame.image()), "");
      EXPECT_EQ(frame.image().index[5], 1u);
      EXPECT_EQ(frame.image().depth[5], initial ? 0.375f : 0.5f);
      corpus::Image image = frame.image();
      image.index[5] = 2;
      const bool judged = known || !initial;
      EXPECT_EQ(finding(image), judged ? "index at pixel (1, 1): expected 1, got 2" : "");
      image = frame.image(), image.depth[5] = 0.25f;
      EXPECT_EQ(finding(image).rfind("depth", 0) == 0, judged) << finding(image);
      image = frame.image(), image.attributes[0][5] += 0.25f;
      EXPECT_EQ(finding(image).rfind("a at pixel (1, 1)", 0) == 0, judged) << finding(image);
      // Without an index and depth, values say who it is.
      image.index.clear(), image.depth.clear();
      EXPECT_EQ(finding(image).rfind("a at pixel (1, 1)", 0) == 0, judged) << finding(image);
      // Nobody is accused where depths do not lie apart.
      for (corpus::SceneVertex& v : scene.draws[0].vertices) v.z = 0.25f * v.w;
      for (corpus::SceneVertex& v : scene.draws[2].vertices) v.z = 0.25f * v.w;
      corpus::Frame equal(scene, {true, true, false, false, false});
      oracle::render(equal.target(), equal.draws());
      image = equal.image();
      for (std::uint32_t index = 0; index < 3; ++index) {
        image.index[5] = index;
        const Frame alike{4, 4, 1, DepthTest::less, initial, equal.draws(), equal.target().initial_depth};
        EXPECT_EQ(judge_image(adapters::oracle_expected(), terms, alike, image, {}, {}).finding, "");
      }
    }
  }
}

// A depth that is clamped from outside of 0 to 1 is 0 or 1, which nothing accuses; another one is wrong.
TEST(Judge, ClampedDepthsAreNotAccused) {
  Terms terms;
  terms.known = true;
  corpus::Scene scene = flat_scene(4, 4, {{{{0, 0}, {4, 0}, {0, 4}}}}, -0.5f);
  scene.draws[0].depth_mode = DepthMode::clamp;
  corpus::Frame frame(scene, {true, true, true, false, false});
  for (const float depth : {0.0f, -0.5f}) {
    corpus::Image image = frame.image();
    const Frame seen{4, 4, 1, DepthTest::less, false, frame.draws()};
    const Counts counts = counts_under(adapters::oracle_expected(), terms, seen);
    image.count = counts.least;
    image.index.assign(16, kNoTriangle);
    image.depth.assign(16, INFINITY);
    for (std::size_t s = 0; s < 16; ++s) {
      if (counts.least[s] == 1) image.index[s] = 0, image.depth[s] = depth;
    }
    const Judgement judgement = judge_image(adapters::oracle_expected(), terms, seen, image, {}, {});
    EXPECT_EQ(judgement.differences == 0, depth == 0) << judgement.finding;
    EXPECT_GT(judgement.samples, 5u);
  }
}

// What the judge says can be red: a picture that is right under one model is wrong under another.
TEST(Judge, AnotherModelIsAccused) {
  Right rival(with({{zoo::kPlace, 1}}));
  Inference found = infer(rival, adapters::oracle_expected(), std::nullopt);
  found.model.x.place = found.model.y.place = 0.5;
  Terms terms;
  terms.model = found.model;
  terms.known = true;
  corpus::Scene scene = flat_scene(8, 8, {{{{1, 1}, {5, 1}, {1, 5}}}});
  corpus::Frame frame(scene, rival.outputs());
  const Judgement judgement =
      judge_image(adapters::oracle_expected(), terms, {8, 8, 1, DepthTest::less, false, frame.draws()},
                  rival.draw(scene, rival.outputs()), {}, {});
  EXPECT_GT(judgement.differences, 0u);
  EXPECT_NE(judgement.finding.find("at pixel"), std::string::npos) << judgement.finding;
}

TEST(Judge, RightRasterizersCoverEachPairOfChoices) {
  const std::vector<Choices>& all = zoo::right_rasterizers();
  EXPECT_GE(all.size(), 60u);
  for (std::size_t a = 0; a < zoo::kNumberOfChoices; ++a) {
    for (std::size_t b = a + 1; b < zoo::kNumberOfChoices; ++b) {
      for (int i = 0; i < zoo::kChoices[a]; ++i) {
        for (int j = 0; j < zoo::kChoices[b]; ++j) {
          EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Choices& c) { return c[a] == i && c[b] == j; }));
        }
      }
    }
  }
}

}  // namespace
}  // namespace surefill::judge
