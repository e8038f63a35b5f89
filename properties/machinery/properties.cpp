// SPDX-License-Identifier: Apache-2.0
#include "properties/machinery/properties.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "properties/machinery/trial.hpp"

namespace surefill::properties {

namespace {

// What a check on this thread shows, while somebody wants to see it. A check looks at pixels under several headings;
// the exhibit is of the one with the first difference.
struct Page {
  Exhibit exhibit;
  std::size_t last = 0;  // pixel that was looked at
  bool complete = false;
};
struct Showing {
  int width = 0, height = 0;
  std::map<std::string, Page, std::less<>> pages;
  std::optional<Exhibit> found;
  Page* found_page = nullptr;
  std::vector<std::uint32_t> covers;  // of each pixel of the last image
};
thread_local Showing* showing = nullptr;

// How often each sample of an image is covered, as far as its outputs say.
std::vector<std::uint32_t> covers_of(const corpus::Image& image) {
  if (!image.count.empty()) return image.count;
  std::vector<std::uint32_t> covers(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                    static_cast<std::size_t>(image.samples));
  for (std::size_t s = 0; s < image.index.size(); ++s) covers[s] = image.index[s] == kNoTriangle ? 0 : 1;
  return covers;
}

std::vector<std::uint32_t> covers_of_pixels(const corpus::Image& image) {
  const std::vector<std::uint32_t> covers = covers_of(image);
  const auto samples = static_cast<std::ptrdiff_t>(image.samples);
  std::vector<std::uint32_t> result;
  for (auto at = covers.begin(); at != covers.end(); at += samples) {
    result.push_back(*std::max_element(at, at + samples));
  }
  return result;
}

std::string index_text(std::uint32_t index) {
  return index == kNoTriangle ? "none" : std::to_string(index);
}

}  // namespace

std::optional<Exhibit> exhibit_of(const Property& property, const corpus::Scene& scene, const Renderer& renderer) {
  Showing shown;
  shown.width = scene.width;
  shown.height = scene.height;
  showing = &shown;
  try {
    (void)property.decide(scene, renderer);
  } catch (const std::exception&) {
    // The finding says why there is no image, unless there was a difference before.
  }
  showing = nullptr;
  if (shown.found_page != nullptr) return std::move(shown.found_page->exhibit);
  return std::move(shown.found);
}

std::optional<corpus::Image> Trial::draw(const corpus::Scene& scene, const corpus::Outputs& outputs) {
  return draw_over(0, scene, outputs);
}

std::optional<corpus::Image> Trial::draw_over(std::uint32_t garbage, const corpus::Scene& scene,
                                              const corpus::Outputs& outputs) {
  corpus::Frame frame(scene, outputs);
  if (garbage != 0) {
    corpus::Image& image = frame.image();
    for (std::vector<std::uint32_t>* buffer : {&image.count, &image.index})
      std::fill(buffer->begin(), buffer->end(), garbage);
    for (std::vector<float>* buffer : {&image.depth, &image.barycentrics})
      std::fill(buffer->begin(), buffer->end(), std::bit_cast<float>(garbage));
    for (std::vector<float>& buffer : image.attributes)
      std::fill(buffer.begin(), buffer.end(), std::bit_cast<float>(garbage));
  }
  return image_of(frame, frame.draws());
}

std::optional<corpus::Image> Trial::draw_changed(const corpus::Scene& scene, const corpus::Outputs& outputs,
                                                 const DrawChange& change) {
  corpus::Frame frame(scene, outputs);
  std::vector<Draw> draws(frame.draws().begin(), frame.draws().end());
  change(draws);
  return image_of(frame, draws);
}

std::optional<corpus::Image> Trial::image_of(corpus::Frame& frame, std::span<const Draw> draws) {
  const Status status = renderer_(frame.target(), draws);
  if (status != Status::ok) {
    differs("the renderer returned \"" + std::string(status_text(status)) + "\"");
    return std::nullopt;
  }
  if (showing != nullptr) showing->covers = covers_of_pixels(frame.image());
  return std::move(frame.image());
}

// A pixel that was looked at, with its covers, or with those of the last image where `output` is another than the
// count.
void Trial::show_pixel(std::string_view what, const char* output, int x, int y, std::uint32_t expected,
                       std::uint32_t actual, bool differs) {
  const bool found = showing->found || showing->found_page != nullptr;
  auto at = showing->pages.find(what);
  if (at == showing->pages.end()) {
    if (found) return;
    at = showing->pages.emplace(what, Page{}).first;
    const auto total = static_cast<std::size_t>(showing->width) * static_cast<std::size_t>(showing->height);
    std::vector<std::uint32_t> covers(total, 0);
    if (std::string_view(output) != "count" && showing->covers.size() == total) covers = showing->covers;
    at->second.exhibit = {
        showing->width, showing->height, 1, output, covers, covers, std::vector<std::uint8_t>(total), {}};
  }
  Page& page = at->second;
  if ((found && showing->found_page != &page) || page.complete || x >= showing->width || y >= showing->height) return;
  const std::size_t e =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(showing->width) + static_cast<std::size_t>(x);
  // The same pixels again, of another triangle, say: they are not what was found.
  page.complete = found && e < page.last;
  if (page.complete) return;
  page.last = e;
  if (page.exhibit.output == "count") {
    page.exhibit.expected[e] = expected;
    page.exhibit.actual[e] = actual;
  }
  if (!differs) return;
  page.exhibit.differs[e] = 1;
  showing->found_page = &page;
}

void Trial::differs(const std::string& finding) {
  if (verdict_.differences++ == 0) verdict_.finding = finding;
}

void Trial::differs(std::string_view what, int x, int y, const std::string& expected, const std::string& actual) {
  if (showing != nullptr) show_pixel(what, "values", x, y, 0, 0, true);
  add_difference(what, x, y, expected, actual);
}

void Trial::add_difference(std::string_view what, int x, int y, const std::string& expected,
                           const std::string& actual) {
  if (verdict_.differences != 0) {
    ++verdict_.differences;
    return;
  }
  differs(std::string(what) + " at pixel (" + std::to_string(x) + ", " + std::to_string(y) + "): expected " + expected +
          ", got " + actual);
}

void Trial::expect_count(std::string_view what, int x, int y, std::uint32_t expected, std::uint32_t actual) {
  if (showing != nullptr) show_pixel(what, "count", x, y, expected, actual, expected != actual);
  if (expected != actual) add_difference(what, x, y, std::to_string(expected), std::to_string(actual));
}

void Trial::expect_index(std::string_view what, int x, int y, std::uint32_t expected, std::uint32_t actual) {
  if (showing != nullptr) show_pixel(what, "index", x, y, 0, 0, expected != actual);
  if (expected != actual) add_difference(what, x, y, index_text(expected), index_text(actual));
}

void Trial::expect_at_most(std::string_view what, int x, int y, std::uint32_t most, std::uint32_t actual) {
  if (showing != nullptr) show_pixel(what, "count", x, y, std::min(most, actual), actual, actual > most);
  if (actual > most) add_difference(what, x, y, "at most " + std::to_string(most), std::to_string(actual));
}

void Trial::expect_bits(std::string_view what, int x, int y, float expected, float actual) {
  if (std::bit_cast<std::uint32_t>(expected) != std::bit_cast<std::uint32_t>(actual))
    differs(what, x, y, text(expected), text(actual));
}

void Trial::expect_same(std::string_view what, const corpus::Scene& scene, const corpus::Image& expected,
                        const corpus::Image& actual, const Correspondence& correspondence) {
  const auto samples = static_cast<std::size_t>(expected.samples);
  std::string named(what);
  named += ": ";
  const auto label = [&](std::string_view output) { return named + std::string(output); };
  const bool shows = showing != nullptr && !showing->found && showing->found_page == nullptr;
  Exhibit shown;
  if (shows) {
    shown = {expected.width, expected.height, expected.samples, "", covers_of(expected), covers_of(expected), {}, {}};
    shown.differs.assign(shown.expected.size(), 0);
  }
  const std::vector<std::uint32_t> covers = shows ? covers_of(actual) : std::vector<std::uint32_t>();
  for (int y = 0; y < expected.height; ++y)
    for (int x = 0; x < expected.width; ++x) {
      if (correspondence.where && !correspondence.where(x, y)) continue;
      const std::array<int, 2> there = correspondence.pixel ? correspondence.pixel(x, y) : std::array<int, 2>{x, y};
      for (std::size_t n = 0; n < samples; ++n) {
        const std::size_t e = element(expected, x, y) * samples + n;
        const std::size_t a = element(actual, there[0], there[1]) * samples + n;
        looked_at(1);
        if (shows) shown.actual[e] = covers[a];
        const auto mark = [&](const char* output) {
          if (!shows) return;
          if (shown.output.empty()) shown.output = output;
          if (shown.output == output) shown.differs[e] = 1;
        };
        if (!expected.count.empty() && expected.count[e] != actual.count[a]) {
          mark("count");
          add_difference(label("count"), x, y, std::to_string(expected.count[e]), std::to_string(actual.count[a]));
        }
        if (!expected.index.empty() && expected.index[e] != actual.index[a]) {
          mark("index");
          add_difference(label("index"), x, y, index_text(expected.index[e]), index_text(actual.index[a]));
        }
        const auto bits = [&](std::string_view output, float wanted, float got) {
          if (std::bit_cast<std::uint32_t>(wanted) == std::bit_cast<std::uint32_t>(got)) return;
          mark("values");
          add_difference(label(output), x, y, text(wanted), text(got));
        };
        if (!expected.depth.empty()) bits("depth", expected.depth[e], actual.depth[a]);
        if (!expected.barycentrics.empty())
          for (std::size_t i = 0; i < 3; ++i)
            bits("barycentrics", expected.barycentrics[3 * e + i],
                 actual.barycentrics[3 * a + correspondence.barycentrics[i]]);
        for (std::size_t k = 0; k < expected.attributes.size(); ++k) {
          if (correspondence.attribute && !correspondence.attribute(scene.attributes[k])) continue;
          const std::size_t components = scene.attributes[k].components;
          for (std::size_t c = 0; c < components && !expected.attributes[k].empty(); ++c)
            bits(scene.attributes[k].name, expected.attributes[k][components * e + c],
                 actual.attributes[k][components * a + c]);
        }
      }
    }
  if (shows && !shown.output.empty()) showing->found = std::move(shown);
}

void Trial::expect_parts(std::string_view what, const corpus::Scene& scene, const Scissor& rectangle,
                         const corpus::Image& inside, const corpus::Image& outside, const corpus::Image& actual) {
  Correspondence in, out;
  in.where = [&](int x, int y) {
    return x >= rectangle.x0 && x < rectangle.x1 && y >= rectangle.y0 && y < rectangle.y1;
  };
  out.where = [&](int x, int y) { return !in.where(x, y); };
  const std::string name(what);
  expect_same("inside " + name, scene, inside, actual, in);
  expect_same("outside of " + name, scene, outside, actual, out);
}

std::optional<Trial::Facings> Trial::draw_facings(const corpus::Scene& scene) {
  corpus::Scene front = scene, back = scene;
  for (corpus::SceneDraw& draw : front.draws) draw.cull = Cull::back;
  for (corpus::SceneDraw& draw : back.draws) draw.cull = Cull::front;
  auto fronts = draw(front, kCountOnly), backs = draw(back, kCountOnly);
  if (!fronts || !backs) return std::nullopt;
  return Facings{std::move(*fronts), std::move(*backs)};
}

std::string text(float value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%a (%.9g)", static_cast<double>(value), static_cast<double>(value));
  return buffer;
}

corpus::SceneVertex scene_vertex(const Vertex& vertex) {
  return {vertex.x, vertex.y, vertex.z, vertex.w, {}};
}

Vertex vertex_of(const corpus::SceneVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z, vertex.w};
}

corpus::Scene triangle_scene(int width, int height, const std::array<Vertex, 3>& vertices) {
  corpus::Scene scene;
  scene.width = width;
  scene.height = height;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices.reserve(3);
  for (const Vertex& v : vertices) draw.vertices.push_back(scene_vertex(v));
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  return scene;
}

corpus::Scene with_one_triangle(const corpus::Scene& scene, std::size_t draw, std::size_t triangle) {
  corpus::Scene one = scene;
  one.draws = {scene.draws[draw]};
  one.draws[0].triangles = {scene.draws[draw].triangles[triangle]};
  return one;
}

const Category& category_of_case(std::uint64_t n) {
  return categories()[n % categories().size()];
}

corpus::Scene pixel_scene(std::uint64_t n, const SceneLimits& limits) {
  corpus::Scene scene = random_scene(category_of_case(n), n / categories().size(), limits);
  for (corpus::SceneDraw& draw : scene.draws) draw.viewport.reset();
  return scene;
}

std::array<Vertex, 3> triangle_of(const corpus::SceneDraw& draw, const corpus::SceneTriangle& triangle) {
  return {vertex_of(draw.vertices[triangle.vertices[0]]), vertex_of(draw.vertices[triangle.vertices[1]]),
          vertex_of(draw.vertices[triangle.vertices[2]])};
}

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

std::optional<Vertex> scaled_exactly(const Vertex& vertex, int exponent) {
  bool exact = finite(vertex);
  const auto scale = [&](float value) {
    const float result = std::ldexp(value, exponent);
    exact = exact && std::isfinite(result) && std::ldexp(result, -exponent) == value;
    return result;
  };
  const Vertex result = {scale(vertex.x), scale(vertex.y), scale(vertex.z), scale(vertex.w)};
  if (!exact) return std::nullopt;
  return result;
}

// Knuth's TwoSum.
std::optional<double> exact_sum(double a, double b) {
  const double sum = a + b, t = sum - a;
  if ((a - (sum - t)) + (b - t) != 0 || !std::isfinite(sum)) return std::nullopt;
  return sum;
}

std::optional<float> exact_float_sum(double a, double b) {
  const std::optional<double> sum = exact_sum(a, b);
  if (!sum || std::abs(*sum) > static_cast<double>(std::numeric_limits<float>::max())) return std::nullopt;
  const auto result = static_cast<float>(*sum);
  if (static_cast<double>(result) != *sum) return std::nullopt;
  return result;
}

std::optional<Vertex> moved_exactly(const Vertex& v, double dx, double dy) {
  const double w = v.w;
  const auto x = exact_float_sum(v.x, dx * w), y = exact_float_sum(v.y, dy * w);
  if (!x || !y || !finite(v)) return std::nullopt;
  return Vertex{*x, *y, v.z, v.w};
}

std::pair<corpus::Scene, corpus::Scene> changed_exactly(corpus::Scene scene, const VertexChange& change) {
  corpus::Scene other = scene;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    std::vector<bool> exact;
    for (corpus::SceneVertex& v : other.draws[d].vertices) {
      const std::optional<Vertex> mapped = change(vertex_of(v));
      exact.push_back(mapped.has_value());
      if (mapped) v.x = mapped->x, v.y = mapped->y, v.z = mapped->z, v.w = mapped->w;
    }
    for (corpus::Scene* s : {&scene, &other})
      std::erase_if(s->draws[d].triangles, [&](const corpus::SceneTriangle& t) {
        return !exact[t.vertices[0]] || !exact[t.vertices[1]] || !exact[t.vertices[2]];
      });
  }
  return {std::move(scene), std::move(other)};
}

corpus::Scene without_places(corpus::Scene scene) {
  if (scene.initial_depth.size() > 1) scene.initial_depth = {scene.initial_depth[0]};
  for (corpus::SceneDraw& draw : scene.draws) {
    draw.scissor.reset();
    draw.culling_box.reset();
  }
  return scene;
}

corpus::Scene without_attributes(corpus::Scene scene) {
  scene.attributes.clear();
  for (corpus::SceneDraw& draw : scene.draws)
    for (corpus::SceneVertex& v : draw.vertices) v.attributes.clear();
  return scene;
}

corpus::Scene sampled_case(const Property& property, std::uint64_t n) {
  return property.make(property.exhaustive == 0 ? n : Random(n).bits() % property.exhaustive);
}

std::uint64_t affordable_cases(const Property& property, std::uint64_t cases) {
  const std::string_view name = property.name;
  std::uint64_t times = 1;
  if (name == "degree-spot") times = 50;
  if (name == "equality-wide" || name == "target-size") times = 4;
  if (name == "small-world-eighth-pixel") times = 40;
  if (name == "small-world-half-pixel-4" || name == "small-world-quarter-pixel" ||
      name == "small-world-homogeneous-rules" || name == "small-world-conservative" ||
      name == "small-world-conservative-w")
    times = 10;
  return std::max<std::uint64_t>(1, cases / times);
}

std::span<const Property> all_properties() {
  static const std::vector<Property> all = [] {
    std::vector<Property> joined;
    for (const std::span<const Property> list :
         {equality_properties(), partition_properties(), degree_properties(), symmetry_properties(), split_properties(),
          value_properties(), frame_properties(), call_properties(), mode_properties(), output_properties(),
          small_world_properties()})
      joined.insert(joined.end(), list.begin(), list.end());
    return joined;
  }();
  return all;
}

}  // namespace surefill::properties
