// SPDX-License-Identifier: Apache-2.0
//
// Origin, layers, winding, numbers of triangles and the conservative modes, by what must hold between images: T9, T10, M9,
// M10, M4a to M4c.
#include "corpus/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {
namespace {

corpus::Scene make_modes(std::uint64_t n) {
  return modes_scene(category_of_case(n), n / categories().size(), 10, 6);
}

// Cases of a frame with an origin and without Grid, whose guard band goes with the target.
corpus::Scene make_tiles(std::uint64_t n) {
  corpus::Scene scene = make_modes(n);
  for (corpus::SceneDraw& draw : scene.draws) draw.grid.reset();
  scene.more.numbers = false;  // they speak of a whole frame
  if (scene.initial_depth.size() > 1) scene.initial_depth = {scene.initial_depth[0]};
  scene.origin.x = std::min(scene.origin.x, kMaxOrigin - 16);
  scene.origin.y = std::min(scene.origin.y, kMaxOrigin - 16);
  return scene;
}

// The part of a frame from pixel (x, y) on, as a frame of its own.
corpus::Scene part_of(const corpus::Scene& scene, int x, int y) {
  corpus::Scene part = scene;
  part.width -= x, part.height -= y;
  part.origin.x += x, part.origin.y += y;
  return part;
}

std::size_t place(const corpus::Image& image, int layer, int x, int y, int n) {
  return ((static_cast<std::size_t>(layer) * static_cast<std::size_t>(image.height) + static_cast<std::size_t>(y)) *
              static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(x)) *
             static_cast<std::size_t>(image.samples) +
         static_cast<std::size_t>(n);
}

// Elements that differ; NaNs, which initial depth may leave, are alike.
template <typename Value>
bool differ(Value a, Value b) {
  return a != b && !(a != a && b != b);
}

// T9: each pixel of a part is that pixel of the whole.
TrialResult decide_tiles(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto whole = trial.draw(scene, outputs_of(scene));
  for (const auto& [dx, dy] : {std::pair(scene.width / 2, 0), std::pair(0, scene.height / 2)}) {
    if (!whole || (dx == 0 && dy == 0)) continue;
    const corpus::Scene tile = part_of(scene, dx, dy);
    const auto part = trial.draw(tile, outputs_of(tile));
    if (!part) break;
    corpus::for_each_output([&](const auto& output) {
      const auto &all = (*whole).*output.image, &some = (*part).*output.image;
      if (all.empty()) return;
      for (int layer = 0; layer < (output.layered ? scene.layers : 1); ++layer)
        for (int y = 0; y < tile.height; ++y)
          for (int x = 0; x < tile.width; ++x)
            for (int n = 0; n < scene.samples; ++n) {
              trial.looked_at(1);
              for (std::size_t e = 0; e < output.elements; ++e) {
                const auto wanted = all[place(*whole, layer, x + dx, y + dy, n) * output.elements + e];
                const auto got = some[place(*part, layer, x, y, n) * output.elements + e];
                if (differ(wanted, got))
                  trial.differs(std::string(output.name), x + dx, y + dy, std::to_string(wanted), std::to_string(got));
              }
            }
    });
  }
  return trial.verdict();
}

corpus::Scene make_layers(std::uint64_t n) {
  corpus::Scene scene = make_modes(n);
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.depth_write = true;
    if (draw.conservative != Conservative::none) draw.conservative = Conservative::none;
  }
  scene.layers = 4;
  scene.more = {};
  return scene;
}

// T10: at a sample, the second layer is the first of the same draws without the triangle that is seen there.
TrialResult decide_layers(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Outputs outputs{true, true, true, false, false, false, false};
  const auto layered = trial.draw(scene, outputs);
  if (!layered || layered->index.empty()) return trial.verdict();
  corpus::Scene peeled = scene;
  peeled.layers = 1;
  Random random = random_of(scene);
  const int x = random.between(0, scene.width - 1), y = random.between(0, scene.height - 1);
  const int n = random.between(0, scene.samples - 1);
  for (std::uint32_t before = 0, d = 0; d < scene.draws.size(); ++d) {  // each triangle with the index that it has
    corpus::SceneDraw& draw = peeled.draws[d];
    const std::uint32_t first = draw.first_index.value_or(before);
    before += static_cast<std::uint32_t>(draw.triangles.size());
    for (std::uint32_t t = 0; t < draw.triangles.size(); ++t)
      if (!draw.triangles[t].identifier) draw.triangles[t].identifier = first + t;
    draw.first_index.reset();
  }
  for (int layer = 0; layer < scene.layers; ++layer) {
    const auto first = trial.draw(peeled, outputs);
    if (!first) break;
    trial.looked_at(1);
    const std::uint32_t wanted = first->index[place(*first, 0, x, y, n)];
    const std::uint32_t got = layered->index[place(*layered, layer, x, y, n)];
    trial.expect_index("layer " + std::to_string(layer), x, y, wanted, got);
    if (const float z = first->depth[place(*first, 0, x, y, n)],
        other = layered->depth[place(*layered, layer, x, y, n)];
        differ(z, other)) {
      trial.differs("depth of layer " + std::to_string(layer), x, y, text(z), text(other));
    }
    if (wanted == kNoTriangle || wanted != got) break;
    // Which triangle of which draw is seen is told by the fragments of one draw after the other: an index may repeat in
    // another draw, so such scenes end here.
    std::size_t found = 0;
    for (corpus::SceneDraw& draw : peeled.draws)
      found += static_cast<std::size_t>(std::count_if(draw.triangles.begin(), draw.triangles.end(),
                                                      [&](const auto& t) { return t.identifier == wanted; }));
    if (found != 1) break;
    for (corpus::SceneDraw& draw : peeled.draws)
      std::erase_if(draw.triangles, [&](const auto& t) { return t.identifier == wanted; });
  }
  return trial.verdict();
}

corpus::Scene make_numbers(std::uint64_t n) {
  corpus::Scene scene = make_modes(n);
  scene.more.numbers = true;
  return scene;
}

// M10: covered numbers sum to the counts, visible ones to the samples that are not empty.
TrialResult decide_numbers(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  const auto image = trial.draw(scene, outputs_of(scene));
  if (!image || image->covered.empty()) return trial.verdict();
  const auto sum = [](const std::vector<std::vector<std::uint64_t>>& numbers) {
    std::uint64_t all = 0;
    for (const auto& of_draw : numbers)
      for (const std::uint64_t number : of_draw) all += number;
    return all;
  };
  std::uint64_t counts = 0, seen = 0;
  for (const std::uint32_t count : image->count) counts += count;
  const std::size_t total = image->count.size();
  for (std::size_t s = 0; s < total && s < image->index.size(); ++s) seen += image->index[s] != kNoTriangle ? 1u : 0u;
  trial.looked_at(total);
  if (sum(image->covered) != counts)
    trial.differs("covered numbers sum to " + std::to_string(sum(image->covered)) + ", counts to " +
                  std::to_string(counts));
  if (!image->visible.empty() && sum(image->visible) != seen)
    trial.differs("visible numbers sum to " + std::to_string(sum(image->visible)) + " of " + std::to_string(seen) +
                  " samples");
  return trial.verdict();
}

// Two closed contours with corners on a lattice, as fans: they may cross themselves, and each other.
corpus::Scene make_polygon(std::uint64_t n) {
  Random random(n * 0x9E3779B97F4A7C15u + 9);
  corpus::Scene scene;
  scene.width = scene.height = random.between(2, 12);
  scene.more.winding = true;
  scene.origin = {random.between(-2, 2), random.between(-2, 2)};
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.fill_rule = static_cast<FillRule>(random.below(8));
  for (int contour = random.between(1, 2); contour > 0; --contour) {
    const auto first = static_cast<std::uint32_t>(draw.vertices.size());
    const auto corners = static_cast<std::uint32_t>(random.between(3, 7));
    for (std::uint32_t i = 0; i < corners; ++i)
      draw.vertices.push_back({static_cast<float>(random.between(-4, 28)) / 2,
                               static_cast<float>(random.between(-4, 28)) / 2,
                               0.5f,
                               1,
                               {}});
    for (std::uint32_t i = 1; i + 1 < corners; ++i) draw.triangles.push_back({{first, first + i, first + i + 1}, {}});
  }
  return scene;
}

// The turns of a closed path around the sample, moved as the fill rule has it; everything in half pixels. What the
// path's edges do to the ray towards +x of the moved point is counted, from +x to +y being positive.
int turns(const std::vector<std::array<int, 2>>& path, int px, int py, FillRule rule) {
  const int step_x = rule == FillRule::top_right || rule == FillRule::bottom_right ||
                             rule == FillRule::southwards_west || rule == FillRule::northwards_west
                         ? -1
                         : 1;
  const int step_y = rule == FillRule::bottom_left || rule == FillRule::bottom_right || rule == FillRule::northwards ||
                             rule == FillRule::northwards_west
                         ? -1
                         : 1;
  const bool y_first = rule >= FillRule::southwards;
  // The moved point, in units so small that a step of the first kind outweighs all of the second.
  constexpr long long kFine = 1 << 10, kFiner = 1 << 20;
  const long long x = px * kFiner * kFine + step_x * (y_first ? 1 : kFine);
  const long long y = py * kFiner * kFine + step_y * (y_first ? kFine : 1);
  int sum = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto& a = path[i];
    const auto& b = path[(i + 1) % path.size()];
    const long long ay = a[1] * kFiner * kFine, by = b[1] * kFiner * kFine;
    if ((ay > y) == (by > y)) continue;
    // The sign of (b - a) x (p - a): small numbers times fine ones.
    const long long side = (b[0] - a[0]) * (y - ay) - (b[1] - a[1]) * (x - a[0] * kFiner * kFine);
    if (side > 0 && by > ay) ++sum;
    if (side < 0 && by < ay) --sum;
  }
  return sum;
}

// M9: the winding is that of the contours.
TrialResult decide_polygon(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  corpus::Outputs outputs = kCountOnly;
  outputs.winding = true;
  const auto image = trial.draw(scene, outputs);
  if (!image || image->winding.empty() || scene.draws.empty()) return trial.verdict();
  const corpus::SceneDraw& draw = scene.draws[0];
  // The contours, by the first vertex of the fans.
  std::map<std::uint32_t, std::vector<std::array<int, 2>>> contours;
  const auto halves = [&](std::uint32_t v) {
    return std::array<int, 2>{static_cast<int>(std::lround(2 * draw.vertices[v].x)),
                              static_cast<int>(std::lround(2 * draw.vertices[v].y))};
  };
  for (const corpus::SceneTriangle& t : draw.triangles) {
    auto& path = contours[t.vertices[0]];
    if (path.empty()) path = {halves(t.vertices[0]), halves(t.vertices[1])};
    path.push_back(halves(t.vertices[2]));
  }
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      int wanted = 0;
      for (const auto& [first, path] : contours)
        wanted += turns(path, 2 * (x + scene.origin.x) + 1, 2 * (y + scene.origin.y) + 1, draw.fill_rule);
      trial.looked_at(1);
      const std::int32_t got = image->winding[element(*image, x, y)];
      if (got != wanted) trial.differs("winding", x, y, std::to_string(wanted), std::to_string(got));
    }
  return trial.verdict();
}

corpus::Scene make_squares(std::uint64_t n) {
  Random random(n ^ 0x5A1);
  const Category& category = category_of_case(n);
  const int width = random.between(1, 12), height = random.between(1, 12);
  std::array<Vertex, 3> triangle = category.triangle(random, width, height);
  if (random.one_in(4)) triangle[2] = triangle[random.below(2)];  // D = 0
  if (random.one_in(8)) triangle[1] = triangle[0];
  corpus::Scene scene = triangle_scene(width, height, triangle);
  scene.more.conservative_index = true;
  if (random.one_in(3)) scene.draws[0].cull = random.one_in(2) ? Cull::front : Cull::back;
  if (random.one_in(2)) scene.draws[0].front_face = FrontFace::counter_clockwise;
  return scene;
}

// M4a, M4b: inner, overlap, over and touched follow from left to right; touched is over where D is not 0, and the others
// are empty where it is. M4c: there is an index exactly where something is counted.
TrialResult decide_squares(const corpus::Scene& scene, const Renderer& renderer) {
  Trial trial(renderer);
  constexpr Conservative kOrder[] = {Conservative::inner, Conservative::overlap, Conservative::over,
                                     Conservative::touched};
  std::vector<corpus::Image> images;
  for (const Conservative mode : kOrder) {
    corpus::Scene one = scene;
    for (corpus::SceneDraw& draw : one.draws) draw.conservative = mode;
    auto image = trial.draw(one, outputs_of(one));
    if (!image || image->index.empty()) return trial.verdict();
    images.push_back(std::move(*image));
  }
  const corpus::SceneDraw& draw = scene.draws[0];
  const bool degenerate = draw.triangles.empty() || facing(triangle_of(draw, draw.triangles[0])) == 0;  // or not finite
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      trial.looked_at(1);
      const std::size_t e = element(images[0], x, y);
      for (std::size_t m = 0; m + 1 < images.size(); ++m)
        trial.expect_at_most("a narrower mode", x, y, images[m + 1].count[e], images[m].count[e]);
      if (!degenerate) trial.expect_count("touched", x, y, images[2].count[e], images[3].count[e]);
      if (degenerate) trial.expect_count("over of a degenerate triangle", x, y, 0, images[2].count[e]);
      for (const corpus::Image& image : images)
        trial.expect_index("index", x, y, image.count[e] == 0 ? kNoTriangle : 0, image.index[e]);
    }
  return trial.verdict();
}

constexpr Property kProperties[] = {
    {"tiles-of-a-picture", "S6, T9", "a part of a frame, drawn with its own origin, is that part of the whole", false,
     true, 0, make_tiles, decide_tiles},
    {"layers-peel", "V4, T10", "a layer is what is seen without the triangles of the layers before", false, true, 0,
     make_layers, decide_layers},
    {"numbers-add-up", "M10", "the triangles' covered samples sum to the counts, the visible ones to the samples seen",
     false, true, 0, make_numbers, decide_numbers},
    {"polygon-winding", "M9", "a polygon drawn as fans has its own winding number, holes and crossings included", false,
     false, 0, make_polygon, decide_polygon},
    {"squares-nest", "M4, M4a-M4c",
     "inner pixels overlap, overlapping ones are met, and an index is there with a count", false, false, 0,
     make_squares, decide_squares},
};

}  // namespace

std::span<const Property> output_properties() {
  return kProperties;
}

}  // namespace surefill::properties
