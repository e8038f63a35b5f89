// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/questions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "certify/judge/room.hpp"

namespace surefill::judge {

namespace {

using corpus::Image;
using corpus::Scene;
using corpus::SceneDraw;
using corpus::SceneVertex;
using Corners = std::array<SceneVertex, 3>;

constexpr double kMargin = 1.0 / 16;  // from an edge: what the models of section 11 that have a name move

// An edge as the margin around it needs it: its line, of unit normal, and where along it the ends are.
struct Edge {
  double a, b, c;
  double px, py, dx, dy, length;  // in front of the eye
  bool front;
};

std::vector<Edge> edges_of(const Scene& scene) {
  std::vector<Edge> edges;
  for (const SceneDraw& draw : scene.draws) {
    for (const corpus::SceneTriangle& t : draw.triangles) {
      bool front = true;
      for (const std::uint32_t v : t.vertices) front = front && draw.vertices[v].w > 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const SceneVertex &p = draw.vertices[t.vertices[i]], &q = draw.vertices[t.vertices[(i + 1) % 3]];
        const double a = double{p.y} * q.w - double{p.w} * q.y, b = double{p.w} * q.x - double{p.x} * q.w;
        const double c = double{p.x} * q.y - double{p.y} * q.x, length = std::hypot(a, b);
        if (!std::isfinite(c) || length == 0) continue;
        const double px = double{p.x} / p.w, py = double{p.y} / p.w, dx = double{q.x} / q.w - px,
                     dy = double{q.y} / q.w - py;
        edges.push_back({a / length, b / length, c / length, px, py, dx, dy, std::hypot(dx, dy), front});
      }
    }
  }
  return edges;
}

// Is the sample within the margin of the line through an edge? Behind the eye further out, as R9 has it.
bool near_an_edge(std::span<const Edge> edges, double x, double y) {
  return std::any_of(edges.begin(), edges.end(), [x, y](const Edge& e) {
    if (std::abs(e.a * x + e.b * y + e.c) >= (e.front ? kMargin : 0.25)) return false;
    if (!e.front) return true;
    // Beside the edge's ends the line says nothing.
    const double along = (x - e.px) * e.dx + (y - e.py) * e.dy;
    return along >= -kMargin * e.length && along <= e.length * (e.length + kMargin);
  });
}

void copy_sample(const Image& from, Image& to, std::size_t s, bool all) {
  const auto total = from.count.size();
  const auto floats = [&](const std::vector<float>& a, std::vector<float>& b) {
    if (a.empty() || a.size() != b.size()) return;
    const std::size_t n = a.size() / total;
    for (std::size_t i = n * s; i < n * (s + 1); ++i) {
      if (all || alike(a[i], b[i])) b[i] = a[i];
    }
  };
  if (all) to.count[s] = from.count[s];
  if (all && !to.index.empty()) to.index[s] = from.index[s];
  floats(from.depth, to.depth);
  floats(from.barycentrics, to.barycentrics);
  for (std::size_t k = 0; k < std::min(from.attributes.size(), to.attributes.size()); ++k) {
    floats(from.attributes[k], to.attributes[k]);
  }
}

bool same_floats(const std::vector<float>& a, const std::vector<float>& b) {
  return b.empty() || std::equal(a.begin(), a.end(), b.begin(), b.end(),
                                 [](float x, float y) { return x == y || (x != x && y != y); });
}

bool same_image(const Image& a, const Image& b) {
  return !differs({{}, a, b});
}

Scene plain_scene(Random& random, int number, Cull culled, int triangles = 1) {
  Scene scene = empty_scene(number % 2 == 0 ? 24 : 16, number % 3 == 0 ? 24 : 16);
  for (int t = 0; t < triangles; ++t) {
    Corners c = plain_corners(random, scene.width, scene.height);
    if ((number + t) % 2 == 1) std::swap(c[1], c[2]);
    add_triangle(scene.draws[0], c, culled);
  }
  return scene;
}

// --- again and again

// Where something of a frame is left in the next one of the same size: its depth, or all of it.
struct Left {
  std::vector<bool> where;
  bool all = false;
};

Left left_over(const Questions& questions, int width, int height) {
  Left left;
  Scene near = empty_scene(width, height);
  add_triangle(near.draws[0], over_all(width, height, 1.0 / 32), questions.model.culled);
  Scene far = near, little = empty_scene(width, height);
  for (SceneVertex& v : far.draws[0].vertices) v.z = 0.75f;
  add_triangle(little.draws[0], {corner(1.125, 1.25), corner(3.5, 1.5), corner(1.25, 3.625)}, questions.model.culled);
  (void)questions.rival(little);
  const auto before = questions.rival(little), first = questions.rival(near), second = questions.rival(far),
             after = questions.rival(little);
  if (!before || !first || !second || !after || before->count.empty() || second->count.empty()) return left;
  if (!second->index.empty() && std::ranges::count(first->index, kNoTriangle) > 0) return left;
  for (std::size_t s = 0; s < second->count.size(); ++s) {
    const bool stays =
        after->count[s] != before->count[s] || (!after->index.empty() && after->index[s] != before->index[s]);
    const bool hidden =
        (!second->index.empty() && second->index[s] == kNoTriangle) || second->count[s] != first->count[s];
    left.where.push_back(stays || hidden);
    left.all = left.all || stays;
  }
  const auto lost = static_cast<std::size_t>(std::count(left.where.begin(), left.where.end(), true));
  if (lost + 16 >= left.where.size() || lost == 0) left.where.clear();
  return left;
}

// On targets with incomplete blocks, and with rows that may stand further apart than they are wide.
std::string about_clearing(const Questions& questions) {
  constexpr std::array<std::array<int, 2>, 2> kSizes{{{45, 43}, {33, 43}}};
  for (const auto& [width, height] : kSizes) {
    const Left left = left_over(questions, width, height);
    if (left.where.empty()) continue;
    const auto is = [&, w = width](const auto& where) {
      for (int s = 0; s < static_cast<int>(left.where.size()); ++s) {
        if (left.where[static_cast<std::size_t>(s)] != where(s % w, s / w)) return false;
      }
      return true;
    };
    const std::string what = left.all ? "the image is not cleared " : "depth is not cleared ";
    for (const int n : {2, 4, 8, 16, 32, 64}) {
      const int stride = (width + n - 1) / n * n, columns = width / n * n, rows = height / n * n,
                pixels = width * height;
      if (width != 33 && is([=](int x, int y) { return x >= columns || y >= rows; })) {
        const std::string blocks = std::to_string(n) + " x " + std::to_string(n) + " pixels";
        return what + "in the incomplete blocks of " + blocks +
               " at the right and the lower border: what the frame before has drawn there stays";
      }
      if (width == 33 && is([=](int x, int y) { return y * stride + x >= pixels; })) {
        return what + "in the last rows of targets whose width is no multiple of " + std::to_string(n) +
               ": rows stand as far apart as that, and only width times height places are cleared";
      }
    }
    if (width == 33) return what + "everywhere: in a part of the target what the frame before has drawn stays";
  }
  return "";
}

// Does it draw the same frame alike, at once, and after another one?
std::string about_repeats(const Questions& questions) {
  // All of the target near, far, and far again: what of the first frame is still there?
  Scene near = empty_scene(16, 16);
  add_triangle(near.draws[0], over_all(near.width, near.height), questions.model.culled);
  Scene far = near;
  for (SceneVertex& v : near.draws[0].vertices) v.z = 1.0f / 32;
  for (SceneVertex& v : far.draws[0].vertices) v.z = 0.75f;
  const auto near_one = questions.rival(near), far_one = questions.rival(far), again = questions.rival(far);
  constexpr std::size_t kInside = 4 * 16 + 4;
  if (near_one && far_one && again) {
    if (!far_one->count.empty() && far_one->count[kInside] > near_one->count[kInside] &&
        again->count[kInside] > far_one->count[kInside]) {
      return "counts are not cleared: they go on from frame to frame";
    }
    if (!far_one->index.empty() && far_one->index[kInside] == kNoTriangle && near_one->index[kInside] != kNoTriangle) {
      return "depth is not cleared: what the frame before has drawn hides what comes";
    }
  }
  if (std::string sentence = about_clearing(questions); !sentence.empty()) return sentence;
  Random random(0x2E9EA7);
  int at_once = 0, after = 0, all = 0;
  for (int n = 0; n < 8; ++n) {
    const Scene scene = plain_scene(random, n, questions.model.culled, 2);
    Scene other = plain_scene(random, n + 1, questions.model.culled, 3);
    other.width = scene.width, other.height = scene.height;
    const auto first = questions.rival(scene), second = questions.rival(scene), between = questions.rival(other),
               third = questions.rival(scene), fourth = questions.rival(scene);
    if (!first || !second || !between || !third || !fourth) continue;
    ++all;
    at_once += !same_image(*third, *fourth) || (n > 0 && !same_image(*first, *second));
    after += !same_image(*second, *third);
  }
  if (all < 3 || at_once + after == 0) return "";
  if (at_once == 0 || 3 * after > 4 * at_once) {
    return "what is drawn depends on the frame before: something is left over, or not cleared";
  }
  return "the same frame drawn twice is not the same image: something is random, or counted on from frame to frame";
}

// A state that one draw or one frame has, and the next has not.
struct State {
  const char* name;
  void (*give)(Scene& scene, SceneDraw& draw);
  Cull cull = Cull::none;  // of the other draws, too
};
constexpr State kStates[] = {
    {"a scissor",
     [](Scene&, SceneDraw& d) {
       d.scissor = Scissor{3, 3, 9, 9};
     }},
    {"culling", [](Scene&, SceneDraw& d) { d.cull = Cull::back; }},
    {"culling", [](Scene&, SceneDraw& d) { d.cull = Cull::front; }},
    {"counter-clockwise front faces",
     [](Scene&, SceneDraw& d) { d.front_face = FrontFace::counter_clockwise, d.cull = Cull::back; }},
    {"another front face and the same culling",
     [](Scene&, SceneDraw& d) { d.front_face = FrontFace::counter_clockwise; }, Cull::back},
    {"depth write off", [](Scene&, SceneDraw& d) { d.depth_write = false; }},
    {"depth clipping", [](Scene&, SceneDraw& d) { d.depth_mode = DepthMode::clip; }},
    {"depth clamping", [](Scene&, SceneDraw& d) { d.depth_mode = DepthMode::clamp; }},
    {"the depth test GREATER", [](Scene& s, SceneDraw&) { s.depth_test = DepthTest::greater; }},
    {"a depth that is there before", [](Scene& s, SceneDraw&) { s.initial_depth = {0.25f}; }},
    {"several samples a pixel", [](Scene& s, SceneDraw&) { s.samples = 4; }}};
constexpr std::size_t kOfDraws = 8;  // the first ones are a draw's own

// After a frame that has a state, the next one keeps it.
std::string about_states_kept(const Questions& questions) {
  Random random(0x57A7E);
  for (const State& state : kStates) {
    for (int n = 0; n < 3; ++n) {
      Scene scene = plain_scene(random, n, questions.model.culled, 3);
      scene.draws[0].cull = state.cull;
      Scene with = scene;
      state.give(with, with.draws[0]);
      // It draws the same frame twice alike, or nobody would ask this.
      const auto before = answer(questions, scene);
      if (!before || differs(*before) || !questions.rival(with)) continue;
      const auto after = answer(questions, scene);
      if (after && differs(*after)) {
        return std::string("after a frame with ") + state.name + " the next one, without it, is wrong: state is kept";
      }
      // Does a state that a frame ends with keep the depth of that frame from being cleared?
      if (!kAsksAll || &state - kStates >= static_cast<std::ptrdiff_t>(kOfDraws)) continue;
      SceneDraw near;
      near.cull = state.cull;
      add_triangle(near, over_all(scene.width, scene.height, 1.0 / 32), questions.model.culled);
      with.draws.insert(with.draws.begin(), near);
      const auto ended = answer(questions, with);
      const auto next = answer(questions, scene);
      const bool wrong = ended && !differs(*ended) && next && differs(*next);
      // What that draw itself leaves is another question.
      with.draws.pop_back();
      (void)questions.rival(with);
      const auto without = answer(questions, scene);
      if (!wrong || !without || differs(*without)) continue;
      return std::string("after a frame whose last draw has ") + state.name +
             " the next one is wrong where that frame was nearer: depth is not cleared, or not everywhere";
    }
  }
  return "";
}

// Two draws of a frame, one of which has a state.
std::string about_states_of_draws(const Questions& questions, std::span<const Fault> faults) {
  Random random(0xD2A3);
  for (std::size_t k = 0; k < kOfDraws; ++k) {
    std::vector<Wrong> wrong;
    std::vector<Scene> fine;
    std::array<int, 2> bad{}, all{};
    int alone = 0;
    for (std::size_t n = 0; n < 12; ++n) {
      Scene scene = plain_scene(random, static_cast<int>(n), questions.model.culled, 2);
      Scene other = plain_scene(random, static_cast<int>(n), questions.model.culled, 2);
      scene.draws.push_back(other.draws[0]);
      for (SceneDraw& draw : scene.draws) draw.cull = kStates[k].cull;
      // What a frame before has left, one without the state takes away.
      Scene fresh = plain_scene(random, static_cast<int>(n), questions.model.culled);
      fresh.width = scene.width, fresh.height = scene.height;
      const auto answered = [&](const Scene& asked) {
        (void)questions.rival(fresh);
        return answer(questions, asked);
      };
      const auto plain = answered(scene);
      if (!plain || differs(*plain)) break;
      kStates[k].give(scene, scene.draws[n % 2]);
      Scene single = scene;
      single.draws = {scene.draws[n % 2]};
      const auto one = answered(single), both = answered(scene);
      if (!one || !both) break;
      alone += differs(*one);
      ++all[n % 2];
      if (!differs(*both)) {
        fine.push_back(scene);
        continue;
      }
      ++bad[n % 2];
      wrong.push_back(*both);
    }
    if (all[0] + all[1] < 6 || alone > 1 || wrong.size() < 3) continue;
    std::vector<Name> names = name_fault(faults, wrong, 0x1p-8);
    drop_refuted(names, fine, 0x1p-8);
    if (kStates[k].cull != Cull::none) {
      return "of draws with the same culling all have the front face of the first: it is taken over only when culling "
             "changes";
    }
    if (!names.empty() && names.front().agreement >= 0.9) return names.front().fault->sentence;
    const char* which = bad[1] == 0   ? " another one after it is wrong"
                        : bad[0] == 0 ? " another one before it is wrong"
                                      : " another one of the frame is wrong";
    return std::string("where one draw has ") + kStates[k].name + "," + which + ": state goes from draw to draw";
  }
  return "";
}

}  // namespace

double eighth(Random& random, double low, double high) {
  return std::nearbyint((low + (high - low) * random.unit()) * 8) / 8;
}

// A triangle of some size on the target.
Corners plain_corners(Random& random, int width, int height) {
  for (;;) {
    Corners c{};
    for (SceneVertex& v : c) {
      // A depth of a few bits: whoever takes clip space needs an exact form of it.
      const double z = std::nearbyint(1024 * (0.1 + 0.8 * random.unit())) / 1024;
      const double x = eighth(random, 0, width), y = eighth(random, 0, height);  // in this order, whoever compiles it
      v = corner(x, y, z);
    }
    const double turn =
        (double{c[1].x} - c[0].x) * (double{c[2].y} - c[0].y) - (double{c[1].y} - c[0].y) * (double{c[2].x} - c[0].x);
    if (std::abs(turn) > 0.25 * width * height) return c;
  }
}

Scene empty_scene(int width, int height) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.draws.emplace_back();
  return scene;
}

void add_triangle(SceneDraw& draw, const Corners& corners, Cull culled) {
  const auto first = static_cast<std::uint32_t>(draw.vertices.size());
  for (const SceneVertex& v : corners) draw.vertices.push_back(v);
  corpus::SceneTriangle triangle{{first, first + 1, first + 2}, std::nullopt};
  const double turn = (double{corners[1].x} / corners[1].w - double{corners[0].x} / corners[0].w) *
                          (double{corners[2].y} / corners[2].w - double{corners[0].y} / corners[0].w) -
                      (double{corners[1].y} / corners[1].w - double{corners[0].y} / corners[0].w) *
                          (double{corners[2].x} / corners[2].w - double{corners[0].x} / corners[0].w);
  if (culled != Cull::none && (turn > 0) == (culled == Cull::front))
    std::swap(triangle.vertices[1], triangle.vertices[2]);
  draw.triangles.push_back(triangle);
}

std::array<SceneVertex, 3> over_all(int width, int height, double z) {
  return {corner(0, 0, z), corner(2 * width, 0, z), corner(0, 2 * height, z)};
}

bool differs(const Wrong& shown) {
  const Image &a = shown.right, &b = shown.rival;
  if (a.count != b.count || (!b.index.empty() && a.index != b.index)) return true;
  if (!same_floats(a.depth, b.depth) || !same_floats(a.barycentrics, b.barycentrics)) return true;
  for (std::size_t k = 0; k < std::min(a.attributes.size(), b.attributes.size()); ++k) {
    if (!same_floats(a.attributes[k], b.attributes[k])) return true;
  }
  return false;
}

Scene moved(Scene scene, const Model& model) {
  for (corpus::SceneDraw& draw : scene.draws) {
    for (corpus::SceneVertex& v : draw.vertices) {
      const double x = v.x * (scene.width - model.x.lacks) / scene.width + (model.x.moved + 0.5 - model.x.place) * v.w;
      const double y =
          v.y * (scene.height - model.y.lacks) / scene.height + (model.y.moved + 0.5 - model.y.place) * v.w;
      v.x = static_cast<float>(x);
      v.y = static_cast<float>(y);
    }
  }
  return scene;
}

std::optional<Wrong> answer(const Questions& questions, const Scene& scene) {
  std::optional<Image> rival = questions.rival(scene);
  if (!rival || rival->count.empty()) return std::nullopt;
  std::optional<Image> right = questions.right(scene);
  if (!right) return std::nullopt;
  Wrong shown{scene, std::move(*right), std::move(*rival)};
  const auto samples = static_cast<std::size_t>(scene.samples), width = static_cast<std::size_t>(scene.width);
  shown.open.assign(shown.right.count.size(), 0);
  // Of many triangles on a large target only samples that are wrong are looked at: whoever asks reads no others.
  const std::vector<Edge> edges = edges_of(scene);
  const bool all = edges.size() * shown.open.size() < 1'000'000;
  for (std::size_t s = 0; s < shown.right.count.size(); ++s) {
    const SampleLocation at = sample_location(scene.samples, static_cast<int>(s % samples));
    const double x = static_cast<double>(s / samples % width) + at.x / 16.0 - 0.5 + questions.model.x.place,
                 y = static_cast<double>(s / samples / width) + at.y / 16.0 - 0.5 + questions.model.y.place;
    const bool same = shown.right.count[s] == shown.rival.count[s];
    const bool near = (all || !same) && near_an_edge(edges, x, y);
    shown.open[s] = near ? 1 : 0;
    copy_sample(shown.right, shown.rival, s, !same && near);
  }
  return shown;
}

Answers ask(const Questions& questions, std::span<const Fault> faults) {
  Answers answers;
  for (const oracle::AxisModel* axis : {&questions.model.x, &questions.model.y}) {
    if (axis->lacks != 0 || axis->moved != 0 || (axis->bits >= 0 && axis->bits < 4)) return answers;
  }
  const auto say = [&answers](std::string sentence) {
    if (sentence.empty()) return false;
    answers.sentences.push_back(std::move(sentence));
    return true;
  };
  // Where pixels or triangles are lost by their place, number or size, what else is asked would be about that.
  if (say(about_repeats(questions)) || say(about_ends_of_rows(questions)) ||
      (kAsksAll && say(about_ways_of_filling(questions))) || say(about_reach(questions)) ||
      say(about_strides(questions)) || say(about_blocks(questions)) || say(about_boxes(questions)) ||
      say(about_pattern(questions))) {
    return answers;
  }
  if (say(about_indices(questions)) || say(about_vertex_cache(questions)) ||
      (!questions.slow && say(about_many(questions))))
    return answers;
  Random random(0x91A1);
  int all = 0;
  for (int n = 0; n < 16; ++n) {
    const auto shown = answer(questions, plain_scene(random, n, questions.model.culled));
    if (!shown) continue;
    ++all;
    if (shown->right.count != shown->rival.count) {
      answers.wrong.push_back(*shown);
    } else {
      answers.fine.push_back(shown->scene);
    }
  }
  if (all < 4) return answers;
  if (2 * static_cast<int>(answers.wrong.size()) >= all) {
    say(about_orders(questions));
    return answers;
  }
  if (say(about_hidden_counts(questions)) || (!questions.slow && say(about_counts(questions)))) return answers;
  if (say(about_states_kept(questions)) || say(about_left_before(questions)) || say(about_small(questions)) ||
      say(about_tiny(questions)) || say(about_triangles_before(questions))) {
    return answers;
  }
  if (!questions.slow && (say(about_precision(questions)) || (kAsksAll && say(about_slopes(questions)))))
    return answers;
  const std::string growth = about_growth(questions), far = growth.empty() ? about_far(questions) : growth;
  if (!questions.slow) {
    say(about_vertices(questions));
    if (far.empty()) say(about_sizes(questions));
  }
  say(about_scissor(questions));
  say(about_culling(questions));
  say(about_depth_modes(questions));
  say(about_depth_write(questions));
  say(about_samples(questions));
  if (answers.sentences.empty()) say(about_states_of_draws(questions, faults));
  if (say(about_index(questions))) return answers;
  const std::string unseen = about_nothing_seen(questions);
  say(unseen);
  if (!unseen.empty()) return answers;
  // Who is seen says little where depths are others.
  const std::string values = how_values_come(questions);
  say(values);
  if (!values.starts_with("depth")) say(about_visibility(questions));
  if (values.empty() && !say(about_arrays(questions))) say(about_values_of_cut(questions));
  say(far);
  if (!far.ends_with("in 32 bits") && !say(about_perspective(questions)) && !say(about_eye(questions)))
    say(about_behind(questions, faults));
  say(about_not_numbers(questions));
  // Where it is not known who owns edges, positions may be others than they are thought to be.
  if (answers.sentences.empty() && questions.model.front.open != 0xFF) say(about_bits(questions));
  if (answers.sentences.empty()) say(about_snapped_edges(questions));
  if (answers.sentences.empty()) say(about_shared_edges(questions));
  return answers;
}

}  // namespace surefill::judge
