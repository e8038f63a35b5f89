// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/viewports.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "certify/judge/questions.hpp"
#include "certify/rivals/frame.hpp"

namespace surefill::certify {

namespace {

using adapters::Rival;
using corpus::Scene;

// What may be the matter with a viewport on a target.
struct Trait {
  const char* text;
  bool (*has)(const surefill_adapter_draw&, const surefill_adapter_scene&);
};

bool is_odd(float length) {
  return std::fmod(length, 2.0f) == 1;
}

constexpr Trait kTraits[] = {
    {"viewports that begin to the right of the target's left border",
     [](const auto& draw, const auto&) { return draw.viewport_x > 0; }},
    {"viewports that begin below the target's upper border",
     [](const auto& draw, const auto&) { return draw.viewport_y > 0; }},
    {"viewports that begin elsewhere than the target",
     [](const auto& draw, const auto&) { return draw.viewport_x > 0 || draw.viewport_y > 0; }},
    {"viewports that are not as high as the target, or begin elsewhere",
     [](const auto& draw, const auto& scene) {
       return draw.viewport_y != 0 || draw.viewport_height != static_cast<float>(scene.height);
     }},
    {"viewports of an odd width", [](const auto& draw, const auto&) { return is_odd(draw.viewport_width); }},
    {"viewports of an odd height", [](const auto& draw, const auto&) { return is_odd(draw.viewport_height); }},
    {"viewports of an odd width or height",
     [](const auto& draw, const auto&) { return is_odd(draw.viewport_width) || is_odd(draw.viewport_height); }},
    {"viewports that are smaller than the target",
     [](const auto& draw, const auto& scene) {
       return draw.viewport_width < static_cast<float>(scene.width) ||
              draw.viewport_height < static_cast<float>(scene.height);
     }},
};

bool is_ordinary(const surefill_adapter_draw& draw) {
  return draw.viewport_x >= 0 && draw.viewport_y >= 0;
}

}  // namespace

Scene viewport_scene(const RivalSubject&, std::uint64_t number, std::uint64_t seed) {
  judge::Random random(seed);
  const int width = random.between(2, 40), height = random.between(2, 40);  // in this order, whoever compiles it
  Scene scene = judge::empty_scene(width, height);
  const Viewport viewport = adapters::ordinary_viewports(scene.width, scene.height)[number % 3];
  for (int t = random.between(1, 4); t > 0; --t) {
    std::array<corpus::SceneVertex, 3> corners;
    for (corpus::SceneVertex& corner : corners) {
      const auto along = [&random](double begin, double length) { return begin + length * random.between(0, 32) / 32; };
      const double x = along(viewport.x, viewport.width), y = along(viewport.y, viewport.height);
      const double z = random.between(1, 15) / 16.0, w = std::ldexp(1, random.between(-2, 2));
      corner = judge::corner(x, y, z, w);
    }
    judge::add_triangle(scene.draws[0], corners);
  }
  return scene;
}

bool turns_viewports(const RivalSubject& subject) {
  constexpr std::uint64_t kScenes = 60, kLeast = 6;
  Rival& rival = *subject.rival;
  if (rival.info().form != SUREFILL_ADAPTER_FORM_CLIP) return false;
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < kScenes && !rival.given_up(); ++n) {
    const Scene scene = viewport_scene(subject, n, n);
    try {
      if (const Rival::TurnedViewports turned(rival); judge_scene(scene, subject).differences > 0) return false;
      wrong += judge_scene(scene, subject).differences > 0;
    } catch (const std::exception&) {
      continue;
    }
  }
  return wrong >= kLeast;
}

std::string which_viewports(const RivalSubject& subject) {
  constexpr std::uint64_t kScenes = 120, kLeast = 6;
  Rival& rival = *subject.rival;
  if (rival.info().form != SUREFILL_ADAPTER_FORM_CLIP) return "";
  std::uint64_t wrong = 0, ordinary_wrong = 0;
  std::array<std::uint64_t, std::size(kTraits)> misfits{};
  for (std::uint64_t n = 0; n < kScenes && !rival.given_up(); ++n) {
    const Scene scene = viewport_scene(subject, n, n);
    try {
      if (const Rival::WideViewports wide(rival); judge_scene(scene, subject).differences > 0) return "";
      const bool differs = judge_scene(scene, subject).differences > 0;
      const Scene under = adapters::scene_under_model(scene, rival.info());
      corpus::Frame frame(under, {});
      const adapters::AdapterFrame adapted(frame.target(), frame.draws(), adapters::clip_form(rival.info(), false));
      const surefill_adapter_draw& draw = adapted.scene().draws[0];
      wrong += differs;
      ordinary_wrong += differs && is_ordinary(draw);
      if (!is_ordinary(draw)) continue;
      // A triangle may look the same under a wrong viewport; none does under a right one.
      for (std::size_t i = 0; i < misfits.size(); ++i) misfits[i] += differs && !kTraits[i].has(draw, adapted.scene());
      for (std::size_t i = 0; i < misfits.size(); ++i) misfits[i] += !differs && kTraits[i].has(draw, adapted.scene());
    } catch (const std::exception&) {
      continue;
    }
  }
  if (ordinary_wrong < kLeast || ordinary_wrong < wrong) return "";
  const auto best = std::min_element(misfits.begin(), misfits.end());
  if (*best * 5 > ordinary_wrong) return "viewports inside the target, and right with large ones around it";
  return kTraits[static_cast<std::size_t>(best - misfits.begin())].text;
}

}  // namespace surefill::certify
