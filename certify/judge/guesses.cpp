// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/guesses.hpp"

#include "certify/judge/text.hpp"

namespace surefill::judge::guesses {

namespace {

using corpus::Scene;
using corpus::SceneVertex;
using drawings::kOpen;

std::optional<Shown> show(const Questions& questions, const Scene& scene) {
  const auto image = questions.rival(scene);
  if (!image || image->count.empty()) return std::nullopt;
  Shown shown{{}, scene.width, scene.height, image->count};
  for (std::size_t i = 0; i < 3; ++i) {
    const SceneVertex& v = scene.draws[0].vertices[scene.draws[0].triangles[0].vertices[i]];
    shown.triangle[i] = {double{v.x}, double{v.y}, double{v.w}};
  }
  return shown;
}

bool explains(const Questions& questions, const Shown& shown,
              const std::function<void(const Triangle& t, Drawing& to)>& draw) {
  Drawing drawing{shown.width, shown.height, questions.model.x.place, questions.model.y.place,
                  std::vector<int>(shown.counts.size(), 0)};
  draw(shown.triangle, drawing);
  for (std::size_t s = 0; s < shown.counts.size(); ++s) {
    const int n = drawing.counts[s];
    if (n < kOpen && n != static_cast<int>(shown.counts[s])) return false;
  }
  return true;
}

// A triangle of which some of the target is covered, and some is not.
bool is_seen(const std::array<SceneVertex, 3>& c, int width, int height) {
  Drawing drawing{width, height, 0.5, 0.5, std::vector<int>(static_cast<std::size_t>(width * height), 0)};
  Triangle t{};
  for (std::size_t i = 0; i < 3; ++i) t[i] = {double{c[i].x}, double{c[i].y}, double{c[i].w}};
  paint(drawing, t);
  const auto covered = std::ranges::count(drawing.counts, 1);
  return covered >= 12 && covered <= width * height - 12;
}

}  // namespace

Polygon cut(const Polygon& polygon, const Distance& distance, New made) {
  Polygon result;
  std::optional<Point> first;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = distance(p), b = distance(q);
    if (a >= 0) result.push_back(p);
    if ((a >= 0) == (b >= 0)) continue;
    double part = a / (a - b);
    if (made == New::at_other_part) part = 1 - part;
    if (made == New::half_way) part = 0.5;
    Point next = p + part * (q + -1.0 * p);
    if (made == New::same_twice && first) next = *first;
    first = next;
    if (made != New::lost || a >= 0) result.push_back(next);
  }
  return result;
}

void masked(const Triangle& t, Drawing& to, const std::function<bool(int x, int y)>& keep) {
  paint(to, t);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      int& count = to.counts[static_cast<std::size_t>(y * to.width + x)];
      if (count < kOpen && !keep(x, y)) count = 0;
    }
  }
}

std::string guessed(const Questions& questions, std::span<const Shown> all, std::span<const Guess> guesses,
                    std::size_t& wrong) {
  std::vector<const Shown*> bad, good;
  for (const Shown& shown : all) {
    const bool right = explains(questions, shown, [](const Triangle& t, Drawing& to) { paint(to, t); });
    (right ? good : bad).push_back(&shown);
  }
  wrong = bad.size();
  // Of a rival that draws next to nothing many guesses are right.
  const auto drawn = std::ranges::count_if(
      all, [](const Shown& s) { return std::ranges::any_of(s.counts, [](std::uint32_t n) { return n != 0; }); });
  if (bad.size() < 3 || drawn < 4) return "";
  bad.insert(bad.end(), good.begin(), good.end());  // the wrong ones tell sooner
  for (const Guess& guess : guesses) {
    const auto [first, last, step] = guess.numbers;
    for (int n = first; n <= last; n += step < 0 ? n : step) {
      const bool fits = std::ranges::all_of(bad, [&](const Shown* shown) {
        return explains(questions, *shown, [&](const Triangle& t, Drawing& to) { guess.draw(t, to, n); });
      });
      if (!fits) continue;
      return text(guess.text, n, n);
    }
  }
  return "";
}

std::vector<Shown> shown_of(const Questions& questions, std::uint64_t seed, int scenes, int width, int height,
                            Corner corner_of) {
  Random random(seed);
  std::vector<Shown> all;
  for (int n = 0; n < scenes; ++n) {
    Scene scene = empty_scene(width, height);
    std::array<SceneVertex, 3> c{};
    int tries = 0;
    do {
      for (int i = 0; i < 3; ++i) c[static_cast<std::size_t>(i)] = corner_of(random, n, i);
    } while (!is_seen(c, width, height) && ++tries < 300);
    if (tries == 300) continue;
    add_triangle(scene.draws[0], c, questions.model.culled);
    if (auto shown = show(questions, scene)) all.push_back(std::move(*shown));
  }
  return all;
}

}  // namespace surefill::judge::guesses
