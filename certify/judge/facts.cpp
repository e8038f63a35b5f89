// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/room.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

constexpr int kSize = 8;
constexpr std::size_t kMiddle = 2 * kSize + 2;                    // a sample that the large triangle covers in any case
constexpr std::array<Point, 3> kLarge{{{0, 0}, {8, 0}, {0, 8}}};  // clockwise: a front face (F1)

bool covers(Rival& rival, const corpus::Scene& scene) {
  return is_covered(rival.draw(scene, covering(rival)), kMiddle);
}

// The large triangle, of the facing that is drawn, at this depth and W.
corpus::Scene large(const Model& model, float z, float w = 1) {
  corpus::Scene scene = flat_scene(kSize, kSize, {kLarge}, z);
  for (corpus::SceneVertex& v : scene.draws[0].vertices) v.x *= w, v.y *= w, v.z *= w, v.w = w;
  if (model.culled == Cull::front)
    std::swap(scene.draws[0].triangles[0].vertices[1], scene.draws[0].triangles[0].vertices[2]);
  return scene;
}

void infer_culling(Rival& rival, Inference& result) {
  Model other = result.model;
  other.culled = Cull::front;
  const bool front = covers(rival, large(result.model, 0.5f)), back = covers(rival, large(other, 0.5f));
  if (front && back) return;
  if (!front && !back) {
    result.problems.push_back(
        "a triangle over half of a target of 8 x 8 pixels covers nothing, whichever way it turns");
    return;
  }
  result.model.culled = front ? Cull::back : Cull::front;
}

void infer_w(Rival& rival, Inference& result) {
  // From 1 outwards, to where nothing is drawn.
  for (const int direction : {-1, 1}) {
    for (int exponent = 0; std::abs(exponent) <= 30; exponent += 2 * direction) {
      const float w = std::ldexp(1.0f, exponent);
      if (covers(rival, large(result.model, 0.5f, w))) continue;
      // Nearer, to a thousandth.
      float drawn = std::ldexp(1.0f, exponent - 2 * direction), left_out = w;
      for (int n = 0; n < 11; ++n) {
        const float middle = std::sqrt(drawn * left_out);
        (covers(rival, large(result.model, 0.5f, middle)) ? drawn : left_out) = middle;
      }
      (direction < 0 ? result.model.least_w : result.model.most_w) = drawn;
      break;
    }
  }
}

// The nearest float32; or the nearest one that clip depth of -1 to 1 has exactly, too.
float depth_at(double z, bool coarse) {
  const double step = std::abs(z) < 1.5 ? 0x1p-23 : std::ldexp(1.0, std::ilogb(z) - 20);
  return static_cast<float>(coarse ? std::nearbyint(z / step) * step : z);
}

// From 1/2 to where nothing is drawn any more: the last depth that is, or an infinity.
double limit_between(Rival& rival, const Model& model, double farthest, bool coarse) {
  if (covers(rival, large(model, depth_at(farthest, coarse)))) return farthest < 0 ? -INFINITY : INFINITY;
  double drawn = 0.5, left_out = farthest;
  for (int n = 0; n < 80; ++n) {
    double middle = (drawn + left_out) / 2;
    // Between magnitudes that are far apart by their root.
    if (drawn * left_out > 0 && std::max(drawn / left_out, left_out / drawn) > 4) {
      middle = std::copysign(std::sqrt(drawn * left_out), drawn);
    } else if (drawn > 0 && left_out < 0) {
      middle = 0;
    }
    middle = depth_at(middle, coarse);
    if (middle == drawn || middle == left_out) break;
    (covers(rival, large(model, static_cast<float>(middle))) ? drawn : left_out) = middle;
  }
  // What is clipped at 0 or 1, or hidden at 1, as roundings and formats of depth have it.
  if (std::abs(drawn) < 0x1p-20) return 0;
  return std::abs(drawn - 1) < 0x1p-14 ? 1 : drawn;
}

// The same of depths that it takes.
double limit_of_depth(Rival& rival, const Model& model, double sign) {
  // The page's judge can't try again where it handles an exception.
  for (std::size_t n = 0; kAsksAll && n < 4; ++n) {
    const double farthest = n < 2 ? 0x1p20 : 16;
    const bool coarse = n % 2 == 1;
    try {
      return limit_between(rival, model, sign * farthest, coarse);
    } catch (const Declined&) {
      // Of others, perhaps.
    }
  }
  const bool drawn = covers(rival, large(model, sign < 0 ? -0.5f : 1.5f));
  return drawn ? sign * INFINITY : sign < 0 ? 0 : 1;
}

void infer_clipping(Rival& rival, Inference& result) {
  const double low = limit_of_depth(rival, result.model, -1), high = limit_of_depth(rival, result.model, 1);
  if (std::isinf(low) && high == 1 && !rival.outputs().count) {
    // Or a clear value of 1 hides it, which lies behind all with the test GREATER.
    corpus::Scene scene = large(result.model, 1.5f);
    scene.depth_test = DepthTest::greater;
    try {
      if (covers(rival, scene)) return;
    } catch (const Declined&) {
      // Nobody knows, and it is the same to whoever has no other test.
    }
  }
  if (std::isfinite(low) || std::isfinite(high)) result.model.clipped = {low, high};
}

// What comes back of flat depths: to the bit, or in steps.
void infer_format(Rival& rival, Inference& result, bool coarse) {
  corpus::Outputs wanted{};
  wanted.count = wanted.index = wanted.barycentrics = wanted.attributes = false;
  const auto [from, to] = result.model.clipped.value_or(std::array{0.0, 1.0});
  const double low = std::max(from, 0.0), high = std::min(to, 1.0);
  bool exact = true, steps24 = true, steps16 = true;
  double largest = 0;
  for (int n = 0; n < 24; ++n) {
    const float z = depth_at(low + (high - low) * (std::fmod(0.1 + n * 0.6180339887498949, 0.96) + 0.02), coarse);
    const corpus::Image image = rival.draw(large(result.model, z), wanted);
    const double got = image.depth[kMiddle], error = std::abs(got - z);
    if (!std::isfinite(got)) return;
    exact = exact && error == 0;
    largest = std::max(largest, error);
    const auto is_step = [got](double steps) {
      return std::abs(got - static_cast<double>(static_cast<float>(std::nearbyint(got * steps) / steps))) == 0;
    };
    steps24 = steps24 && is_step(0xFFFFFF);
    steps16 = steps16 && is_step(0xFFFF);
  }
  result.exact_values = exact;
  if (exact) return;
  if (steps16 && largest <= 1.0 / 0xFFFF) {
    result.model.format = oracle::DepthFormat::unorm16;
  } else if (steps24 && largest <= 1.0 / 0xFFFFFF) {
    result.model.format = oracle::DepthFormat::unorm24;
  } else if (largest <= 0x1p-22) {
    result.model.minus_one_to_one = true;
  } else {
    result.model.format = largest <= 2.0 / 0xFFFFFF ? oracle::DepthFormat::unorm24 : oracle::DepthFormat::unorm16;
    if (largest > 2.0 / 0xFFFF) {
      result.problems.push_back(text("flat depths come back up to %.3g away from what was given", largest));
    }
  }
}

// Depth 1 is beaten by a clear value of 1, and two equal depths by the first or the last.
void infer_visibility(Rival& rival, Inference& result, const corpus::Outputs& has) {
  corpus::Outputs wanted{};
  wanted.count = wanted.barycentrics = wanted.attributes = false;
  wanted.index = has.index;
  wanted.depth = has.depth && !has.index;
  const auto seen = [&](float z) {
    const corpus::Image image = rival.draw(large(result.model, z), wanted);
    return has.index ? image.index[kMiddle] != kNoTriangle : std::isfinite(image.depth[kMiddle]);
  };
  const double high = result.model.clipped ? (*result.model.clipped)[1] : INFINITY;
  if (!seen(1.0f) || !seen(static_cast<float>(high > 1 ? std::min(high, 2.0) : 2.0))) result.model.clear = 1;
  if (!has.index) return;
  corpus::Scene twice = large(result.model, 0.5f);
  // Whose indices are others says nothing by them.
  if (rival.draw(twice, wanted).index[kMiddle] != 0) return;
  twice.draws[0].triangles.push_back(twice.draws[0].triangles[0]);
  result.model.later_wins = rival.draw(twice, wanted).index[kMiddle] == 1;
}

}  // namespace

void infer_facts(Rival& rival, Inference& result) {
  const corpus::Outputs has = rival.outputs();
  const auto try_to = [&result](const char* what, const auto& find) {
    try {
      find();
    } catch (const Declined& reason) {
      result.open.push_back(std::string(what) + ": " + reason.what());
    }
  };
  try_to("which facing it culls", [&] { infer_culling(rival, result); });
  try_to("which W it takes", [&] { infer_w(rival, result); });
  try_to("whether it clips depth", [&] { infer_clipping(rival, result); });
  if (has.depth) {
    try_to("how it keeps depth", [&] {
      if (!kAsksAll) return infer_format(rival, result, false);
      bool takes_all = true;
      try {
        infer_format(rival, result, false);
      } catch (const Declined&) {
        takes_all = false;
      }
      if (!takes_all) infer_format(rival, result, true);
    });
  }
  if (has.index || has.depth) try_to("what is visible", [&] { infer_visibility(rival, result, has); });
}

Model with_facts(Model model, const Model& facts) {
  model.culled = facts.culled;
  model.least_w = facts.least_w;
  model.most_w = facts.most_w;
  model.clipped = facts.clipped;
  model.format = facts.format;
  model.minus_one_to_one = facts.minus_one_to_one;
  model.later_wins = facts.later_wins;
  model.clear = facts.clear;
  return model;
}

}  // namespace surefill::judge
