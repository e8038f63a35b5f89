// SPDX-License-Identifier: Apache-2.0
//
// What becomes of a triangle on its way to its samples, guessed: each guess draws the triangles that were asked for, in
// double and by geometry alone, and is said if it draws every one of them as the rival does, the right ones, too.
#ifndef SUREFILL_CERTIFY_JUDGE_GUESSES_HPP
#define SUREFILL_CERTIFY_JUDGE_GUESSES_HPP

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "certify/judge/drawings.hpp"
#include "certify/judge/questions.hpp"

namespace surefill::judge::guesses {

using drawings::Drawing;
using drawings::Point;
using drawings::Polygon;
using drawings::Triangle;

struct Guess {
  const char* text;  // with %d for the number
  void (*draw)(const Triangle& t, Drawing& to, int number);
  std::array<int, 3> numbers{0, 0, 1};  // first, last, step: of a negative step, twice as much each time
};

// Of how many vertices is it so?
template <class Is>
int how_many(const Triangle& t, const Is& is) {
  return static_cast<int>(std::count_if(t.begin(), t.end(), is));
}

// The triangle is drawn, or not at all.
template <class Dropped>
void unless(const Triangle& t, Drawing& to, const Dropped& dropped) {
  if (!dropped()) paint(to, t);
}

// Sutherland and Hodgman at one plane, with what is done to a new vertex.
enum class New { right, at_other_part, half_way, same_twice, lost };
using Distance = std::function<double(const Point& p)>;
Polygon cut(const Polygon& polygon, const Distance& distance, New made = New::right);

// What is kept of the pixels of the triangle.
void masked(const Triangle& t, Drawing& to, const std::function<bool(int x, int y)>& keep);

// One triangle as the rival draws it.
struct Shown {
  Triangle triangle;
  int width, height;
  std::vector<std::uint32_t> counts;
};

// Scenes of a triangle each, of which the target shows some, and not all: `corner` makes vertex i of the n-th.
using Corner = corpus::SceneVertex (*)(Random& random, int n, int i);
std::vector<Shown> shown_of(const Questions& questions, std::uint64_t seed, int scenes, int width, int height,
                            Corner corner);

// The first guess that draws all of them; empty if none does, or fewer than three are wrong: so many are.
std::string guessed(const Questions& questions, std::span<const Shown> all, std::span<const Guess> guesses,
                    std::size_t& wrong);

}  // namespace surefill::judge::guesses

#endif  // SUREFILL_CERTIFY_JUDGE_GUESSES_HPP
