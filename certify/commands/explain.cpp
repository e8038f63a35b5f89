// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/explain.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <system_error>

#include "certify/report/svg.hpp"
#include "certify/run/files.hpp"
#include "properties/generators/generators.hpp"
#include "textbook/fill_rules.hpp"
#include "textbook/pipeline.hpp"
#include "textbook/tile_test.hpp"
#include "textbook/traversal.hpp"

extern char** environ;

namespace surefill::certify {

using namespace textbook;

namespace {

constexpr int kLargestTarget = 256;  // pixels each way that a picture can show

constexpr const char* kCovered = "fill=\"#5b8fd6\"";
constexpr const char* kVisited = "fill=\"#c9ccd3\"";
constexpr const char* kTileStyle[] = {"fill=\"#f7d4d0\" stroke=\"#c98d86\" stroke-width=\"0.8\"",   // reject
                                      "fill=\"#cfe9cf\" stroke=\"#6fa46f\" stroke-width=\"0.8\"",   // accept
                                      "fill=\"#fbf0c4\" stroke=\"#c4ab55\" stroke-width=\"0.8\""};  // partial

void check_shown(const corpus::Scene& scene, const std::string& file) {
  if (scene.width > kLargestTarget || scene.height > kLargestTarget) {
    throw std::runtime_error(
        fmt::format("{}: explain shows targets of up to {} pixels each way", file, kLargestTarget));
  }
  if (scene.origin != Origin{} || !scene.sample_locations.empty()) {
    throw std::runtime_error(file + ": explain shows targets at the origin, with the standard sample places");
  }
  const corpus::Frame frame(scene, {true, false, false, false, false, false, false});
  if (const Status status = validate(frame.target(), frame.draws()); status != Status::ok) {
    throw std::runtime_error(file + ": " + status_text(status));
  }
}

Explained explained(const corpus::Scene& scene, const std::string& file) {
  const corpus::Frame frame(scene, {true, false, false, false, false, false, false});
  Explained result{scene.width, scene.height, scene.samples, {}, 0};
  for (const Draw& draw : frame.draws()) {
    if (draw.primitive != Primitive::triangles) continue;
    for (std::size_t t = 0; t < draw.indices.size() / 3; ++t) {
      Explained::OneTriangle one{{}, draw.fill_rule};
      bool finite = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vertex& v = one.vertices[i] = draw.vertices[draw.indices[3 * t + i]];
        finite = finite && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
      }
      Triangle triangle;
      if (finite && triangle.set_up(one.vertices[0], one.vertices[1], one.vertices[2])) {
        result.triangles.push_back(one);
      }
    }
  }
  if (result.triangles.empty()) {
    const bool others = std::any_of(frame.draws().begin(), frame.draws().end(),
                                    [](const Draw& draw) { return draw.primitive != Primitive::triangles; });
    throw std::runtime_error(file + (others ? ": no triangle to explain; --view lines shows lines and points"
                                            : ": no triangle to explain: none is finite with D != 0"));
  }
  return result;
}

// What a traversal does, in order.
struct Recorder {
  struct Visit {
    int x, y;
    bool covered;
  };
  struct Tile {
    PixelBox box;
    TileClass found;
  };
  std::vector<Visit> visits;
  std::vector<Tile> tiles;

  void sample(int x, int y, bool covered) { visits.push_back({x, y, covered}); }
  void tile(const PixelBox& box, TileClass found) { tiles.push_back({box, found}); }
};

void draw_values(const Panel& panel, const Triangle& triangle, const Lattice& lattice) {
  const double size = std::min(9.0, panel.scale / 4.2);
  for (int y = panel.y0; y < panel.y1; ++y) {
    for (int x = panel.x0; x < panel.x1; ++x) {
      for (int i = 0; i < 3; ++i) {
        double bound;
        const double e = triangle.edge(i).value(lattice.at(x, y), &bound) * triangle.determinant();
        const SvgPoint p = panel.at(x + 0.5, y);
        panel.svg.text({p.x, p.y + size * (1.2 + 1.15 * i)}, size, "middle", fmt::format("{:.4g}", e),
                       e > 0   ? "fill=\"#12365f\""
                       : e < 0 ? "fill=\"#a03028\""
                               : "fill=\"#b06a00\" font-weight=\"bold\"");
      }
    }
  }
}

void draw_traversal(const Panel& panel, const Explained& scene, const Recorder& seen, const Lattice& lattice,
                    bool path) {
  for (const Recorder::Tile& tile : seen.tiles) {
    panel.pixels(tile.box.x0, tile.box.y0, tile.box.x1, tile.box.y1, kTileStyle[static_cast<int>(tile.found)]);
  }
  const double inset = seen.tiles.empty() ? 0 : 0.14;  // the colour of the tile stays visible between its samples
  for (const Recorder::Visit& v : seen.visits) {
    panel.pixels(v.x + inset, v.y + inset, v.x + 1 - inset, v.y + 1 - inset, v.covered ? kCovered : kVisited);
  }
  panel.grid();
  if (panel.scale >= 10 && path) {
    for (int y = panel.y0; y < panel.y1; ++y) {
      for (int x = panel.x0; x < panel.x1; ++x) {
        panel.svg.circle(panel.at(x + lattice.offset.x, y + lattice.offset.y), std::min(1.6, panel.scale / 9),
                         "fill=\"#565b66\"");
      }
    }
  }
  if (path && !seen.visits.empty()) {
    std::vector<SvgPoint> points;
    for (const Recorder::Visit& v : seen.visits)
      points.push_back(panel.at(v.x + lattice.offset.x, v.y + lattice.offset.y));
    panel.svg.path(points, false, "fill=\"none\" stroke=\"#1c2433\" stroke-width=\"0.9\" stroke-opacity=\"0.7\"");
    panel.svg.circle(points.front(), std::min(3.5, panel.scale / 3), "fill=\"#1d9a4b\"");
    panel.svg.circle(points.back(), std::min(3.5, panel.scale / 3), "fill=\"#c4302b\"");
  }
  draw_outline(panel, scene.triangles[scene.chosen]);
}

// PNG by librsvg's program, so that nothing here draws a picture twice. It works in a folder of its own.
std::string png_of(const std::string& svg, const std::string& path) {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "surefill-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) throw FileError(folder + ": " + std::generic_category().message(errno));
  const std::string source = folder + "/picture.svg", result = folder + "/picture.png";
  int status = -1;
  std::string bytes;
  std::error_code error;
  try {
    write_file(source, svg);
    std::string program = "rsvg-convert", output = "--output=" + result, input = source;
    char* arguments[] = {program.data(), output.data(), input.data(), nullptr};
    pid_t child = 0;
    if (posix_spawnp(&child, "rsvg-convert", nullptr, nullptr, arguments, environ) == 0) waitpid(child, &status, 0);
    std::ostringstream read;
    read << std::ifstream(result, std::ios::binary).rdbuf();
    bytes = std::move(read).str();
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
  fs::remove_all(folder, error);
  if (status != 0 || bytes.empty())
    throw std::runtime_error(path + ": PNG needs rsvg-convert (Debian: librsvg2-bin); an .svg needs nothing");
  return bytes;
}

void write_picture(const std::string& svg, const std::string& path) {
  write_file(path, has_ending(path, ".svg") ? svg : png_of(svg, path));
}

}  // namespace

void draw_outline(const Panel& panel, const Explained::OneTriangle& triangle) {
  // Near enough to the panel that what is cut off cannot be seen.
  Polygon<double> polygon = polygon_of<double>(triangle.vertices);
  const double margin = 0.02;
  const ClipPlane<double> planes[] = {{1, 0, 0, margin - panel.x0},
                                      {-1, 0, 0, panel.x1 + margin},
                                      {0, 1, 0, margin - panel.y0},
                                      {0, -1, 0, panel.y1 + margin}};
  for (const ClipPlane<double>& plane : planes) polygon = clip(polygon, plane);
  if (polygon.size() < 3) return;
  const ScreenPolygon<double> screen(polygon);
  const std::vector<ScreenPolygon<double>::Side>& sides = screen.sides();
  for (std::size_t n = 0; n < sides.size(); ++n) {
    if (sides[n].cut) continue;
    const auto& next = sides[(n + 1) % sides.size()];
    const bool owns = tie_sign(sides[n].a, sides[n].b, tie_shift(triangle.rule)) * screen.facing() > 0;
    panel.svg.line(panel.at(sides[n].x, sides[n].y), panel.at(next.x, next.y),
                   owns ? "stroke=\"#e07b00\" stroke-width=\"2.4\" stroke-linecap=\"round\""
                        : "stroke=\"#1c2433\" stroke-width=\"1.4\" stroke-linecap=\"round\"");
  }
}

std::string traversal_view(const Explained& scene, const ExplainOptions& options) {
  std::vector<Traversal> shown;
  for (const Traversal traversal : kTraversals) {
    if (options.compare || options.strategy == name_of(traversal)) shown.push_back(traversal);
  }
  const int largest = std::max(scene.width, scene.height);
  const double scale = options.values ? 44 : std::max(1.0, (options.compare ? 250.0 : 560.0) / largest);
  const SampleLocation location = sample_location(scene.samples, 0);
  const Lattice lattice{scene.width, scene.height, {location.x / 16.0, location.y / 16.0}};
  const int panels = static_cast<int>(shown.size());
  Sheet sheet(panels, std::min(4, panels), 0, 0, scene.width, scene.height, scale, 3);
  const Explained::OneTriangle& chosen = scene.triangles[scene.chosen];
  Triangle triangle;
  triangle.set_up(chosen.vertices[0], chosen.vertices[1], chosen.vertices[2]);
  for (int n = 0; n < panels; ++n) {
    const Traversal traversal = shown[static_cast<std::size_t>(n)];
    Asked asked(triangle, chosen.rule, lattice);
    Recorder seen;
    traverse(traversal, asked, lattice, options.tile, seen);
    const Panel panel = sheet.panel(n, name_of(traversal));
    draw_traversal(panel, scene, seen, lattice, !options.values);
    if (options.values) draw_values(panel, triangle, lattice);
    const Counts& counts = asked.counts();
    sheet.caption(n, 0, fmt::format("{} visited, {} covered", counts.samples_visited, counts.samples_covered));
    sheet.caption(n, 1, fmt::format("{} edge evaluations", counts.edge_evaluations));
    if (counts.tiles_tested > 0) sheet.caption(n, 2, fmt::format("{} tiles tested", counts.tiles_tested));
  }
  return sheet.file();
}

std::string tile_test_view(const Explained& scene, int size) {
  Triangle triangle;
  const Explained::OneTriangle& chosen = scene.triangles[scene.chosen];
  triangle.set_up(chosen.vertices[0], chosen.vertices[1], chosen.vertices[2]);
  const int columns = (scene.width + size - 1) / size * size, rows = (scene.height + size - 1) / size * size;
  Sheet sheet(2, 2, 0, 0, columns, rows, 420.0 / std::max(columns, rows), 3);
  for (int n = 0; n < 2; ++n) {
    const Panel panel = sheet.panel(n, n == 0 ? "corners against edges" : "three tests");
    TileTestCost cost;
    int tiles = 0, kept = 0, blind = 0;
    for (int y = 0; y < rows; y += size) {
      for (int x = 0; x < columns; x += size) {
        const PixelBox box{x, y, x + size, y + size};
        TileTest test(triangle, box), other(triangle, box);
        const TileClass found = n == 0 ? test.by_corners() : test.by_three_tests();
        const bool differs = found != (n == 0 ? other.by_three_tests() : other.by_corners());
        cost.edge_evaluations += test.cost().edge_evaluations;
        cost.vertex_comparisons += test.cost().vertex_comparisons;
        ++tiles;
        if (found != TileClass::reject) ++kept;
        if (differs) ++blind;
        panel.pixels(x, y, x + size, y + size, kTileStyle[static_cast<int>(found)]);
        if (differs) {
          panel.pixels(x + 0.2, y + 0.2, x + size - 0.2, y + size - 0.2,
                       "fill=\"none\" stroke=\"#c4302b\" stroke-width=\"2\" stroke-dasharray=\"4 3\"");
        }
      }
    }
    draw_outline(panel, chosen);
    sheet.caption(
        n, 0, fmt::format("{} tiles of {} x {} pixels: {} rejected, {} kept", tiles, size, size, tiles - kept, kept));
    sheet.caption(
        n, 1,
        fmt::format("{} edge evaluations, {} vertex comparisons", cost.edge_evaluations, cost.vertex_comparisons));
    sheet.caption(n, 2, n == 0 ? fmt::format("{} tiles (dashed) kept that nothing meets", blind) : "exact");
  }
  return sheet.file();
}

std::string fill_rule_view(const Explained& scene) {
  struct Rule {
    const char* name;
    std::function<bool(const Triangle&, SamplePosition)> covers;
  };
  std::vector<Rule> rules;
  constexpr const char* kNames[] = {"top_left: +x, then +y", "top_right: -x, +y",       "bottom_left: +x, -y",
                                    "bottom_right: -x, -y",  "southwards: +y, then +x", "southwards_west: +y, -x",
                                    "northwards: -y, +x",    "northwards_west: -y, -x"};
  for (int r = 0; r < 8; ++r) {
    const TieShift shift = tie_shift(static_cast<FillRule>(r));
    rules.push_back({kNames[r], [shift](const Triangle& t, SamplePosition p) { return t.covers(p, shift); }});
  }
  for (const Light light : {Light{1, 0}, Light{1, 2}, Light{1, 1}, Light{1, -3}}) {
    static const std::map<std::pair<int, int>, const char*> kLights = {{{1, 0}, "light (1, 0): is top_left"},
                                                                       {{1, 2}, "light (1, 2)"},
                                                                       {{1, 1}, "light (1, 1)"},
                                                                       {{1, -3}, "light (1, -3)"}};
    rules.push_back({kLights.at({light.dx, light.dy}),
                     [light](const Triangle& t, SamplePosition p) { return covers_by_light(t, p, light); }});
  }
  constexpr const char* kFills[] = {"fill=\"#8fb4e8\"", "fill=\"#f2c572\"", "fill=\"#9bd09b\"", "fill=\"#e59a93\"",
                                    "fill=\"#c5a8e0\"", "fill=\"#8fd3d3\"", "fill=\"#d9c2a0\"", "fill=\"#f0a8cf\""};
  std::vector<Triangle> triangles(scene.triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    triangles[t].set_up(scene.triangles[t].vertices[0], scene.triangles[t].vertices[1], scene.triangles[t].vertices[2]);
  }
  Sheet sheet(static_cast<int>(rules.size()), 4, 0, 0, scene.width, scene.height,
              200.0 / std::max(scene.width, scene.height), 1);
  std::vector<std::vector<int>> owners(rules.size());
  for (int n = 0; n < static_cast<int>(rules.size()); ++n) {
    const Rule& rule = rules[static_cast<std::size_t>(n)];
    const Panel panel = sheet.panel(n, rule.name);
    int twice = 0, moved = 0;
    std::vector<int>& owner = owners[static_cast<std::size_t>(n)];
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        int covers = 0;
        owner.push_back(-1);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
          if (!rule.covers(triangles[t], {x + 0.5, y + 0.5})) continue;
          ++covers;
          owner.back() = static_cast<int>(t);
          panel.pixel(x, y, kFills[t % 8]);
        }
        twice += covers > 1 ? 1 : 0;
        moved += owner.back() != owners[0][owner.size() - 1] ? 1 : 0;
      }
    }
    panel.grid();
    for (int y = 0; y < scene.height; ++y) {
      for (int x = 0; x < scene.width; ++x) {
        bool tie = false;
        for (const Triangle& t : triangles) {
          bool near = true;
          for (int i = 0; i < 3; ++i) near = near && t.edge(i).sign({x + 0.5, y + 0.5}) * t.determinant() >= 0;
          for (int i = 0; i < 3; ++i) tie = tie || (near && t.edge(i).sign({x + 0.5, y + 0.5}) == 0);
        }
        panel.svg.circle(panel.at(x + 0.5, y + 0.5), tie ? 3 : 1.2,
                         tie ? "fill=\"#ffffff\" stroke=\"#1c2433\"" : "fill=\"#565b66\"");
      }
    }
    for (const Explained::OneTriangle& t : scene.triangles) {
      std::vector<SvgPoint> corners;
      for (const Vertex& v : t.vertices) corners.push_back(panel.at(v.x / v.w, v.y / v.w));
      panel.svg.path(corners, true, "fill=\"none\" stroke=\"#1c2433\" stroke-width=\"1\"");
    }
    sheet.caption(n, 0,
                  n == 0 ? fmt::format("{} samples twice", twice)
                         : fmt::format("{} twice, {} other than top_left", twice, moved));
  }
  return sheet.file();
}

std::string count_table() {
  struct Kind {
    const char* name;
    int triangles;
    double area, thickness;  // thickness 0: of random shape
  };
  constexpr Kind kKinds[] = {{"1 px", 400, 1, 0},
                             {"10 px", 400, 10, 0},
                             {"200 px", 200, 200, 0},
                             {"100,000 px", 8, 1e5, 0},
                             {"sliver 1000 x 1 px", 40, 500, 1}};
  struct Empty {
    void sample(int, int, bool) {}
    void tile(const PixelBox&, TileClass) {}
  };
  const Lattice lattice{1920, 1080};
  std::string table = fmt::format("{:<20}{:<18}{:>18}{:>16}{:>16}\n", "triangles of", "traversal", "visited/covered",
                                  "tiles/triangle", "edges/covered");
  for (const Kind& kind : kKinds) {
    for (const Traversal traversal : kTraversals) {
      const bool by_size = traversal == Traversal::tiled || traversal == Traversal::hierarchical;
      for (const int size : by_size ? std::vector<int>{4, 8, 16, 32, 64} : std::vector<int>{64}) {
        properties::Random random(7);
        Counts sum;
        const int triangles = traversal == Traversal::every_sample ? std::min(kind.triangles, 8) : kind.triangles;
        for (int t = 0; t < triangles; ++t) {
          double x[3], y[3], doubled = 0;
          while (std::fabs(doubled) < 0.2) {  // a shape that is no sliver by chance
            for (int i = 0; i < 3; ++i) x[i] = random.unit(), y[i] = random.unit();
            doubled = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
          }
          const double size_of = std::sqrt(2 * kind.area / std::fabs(doubled));
          const double reach = kind.thickness > 0 ? 1000 : size_of;
          const double left = 960 + (random.unit() - 0.5) * std::max(0.0, 1900 - reach) - reach / 2,
                       top = 540 + (random.unit() - 0.5) * std::max(0.0, 1060 - reach) - reach / 2;
          Vertex v[3];
          for (int i = 0; i < 3; ++i) {
            v[i] = {static_cast<float>(left + x[i] * size_of), static_cast<float>(top + y[i] * size_of), 0, 1};
          }
          if (kind.thickness > 0) {
            const double angle = random.unit() * 6.283185307179586, c = std::cos(angle), s = std::sin(angle);
            v[0] = {static_cast<float>(960 - 500 * c), static_cast<float>(540 - 500 * s), 0, 1};
            v[1] = {static_cast<float>(960 + 500 * c), static_cast<float>(540 + 500 * s), 0, 1};
            v[2] = {v[0].x - static_cast<float>(s * kind.thickness), v[0].y + static_cast<float>(c * kind.thickness), 0,
                    1};
          }
          Triangle triangle;
          if (!triangle.set_up(v[0], v[1], v[2])) continue;
          Asked asked(triangle, FillRule::top_left, lattice);
          Empty nobody;
          traverse(traversal, asked, lattice, size, nobody);
          sum.samples_visited += asked.counts().samples_visited;
          sum.samples_covered += asked.counts().samples_covered;
          sum.tiles_tested += asked.counts().tiles_tested;
          sum.edge_evaluations += asked.counts().edge_evaluations;
        }
        const auto covered = static_cast<double>(std::max<std::uint64_t>(1, sum.samples_covered));
        table += fmt::format("{:<20}{:<18}{:>18.2f}{:>16.1f}{:>16.2f}\n", kind.name,
                             by_size ? fmt::format("{} {}", name_of(traversal), size) : std::string(name_of(traversal)),
                             static_cast<double>(sum.samples_visited) / covered,
                             static_cast<double>(sum.tiles_tested) / triangles,
                             static_cast<double>(sum.edge_evaluations) / covered);
      }
    }
  }
  return table;
}

std::vector<std::string> strategy_names() {
  std::vector<std::string> names;
  for (const Traversal traversal : kTraversals) names.emplace_back(name_of(traversal));
  return names;
}

std::vector<std::string> view_names() {
  return {"traversal", "tile-tests", "fill-rules",     "snapping", "interpolation", "affine-w",
          "clipping",  "painter",    "hierarchical-z", "codec",    "lines"};
}

std::string explain(const ExplainOptions& options) {
  if (options.counts) return count_table();
  if (options.output.empty()) throw std::runtime_error("explain: -o FILE.svg or FILE.png is needed");
  if (options.tile != 4 && options.tile != 8 && options.tile != 16 && options.tile != 32 && options.tile != 64) {
    throw std::runtime_error(fmt::format("--tile {}: expected 4, 8, 16, 32 or 64", options.tile));
  }
  const OutputFile output{"-o", options.output, {".svg", ".png"}};
  check_outputs({&output, 1}, {&options.input, 1});
  if (options.view == "affine-w" || (options.view == "lines" && options.input.empty())) {
    write_picture(options.view == "lines" ? line_view() : affine_w_view(), options.output);
    return "";
  }
  if (options.input.empty()) throw std::runtime_error("explain: a SCENE is needed");
  const corpus::Scene given = corpus::read_scene_file(options.input);
  check_shown(given, options.input);
  if (options.view == "lines") {
    write_picture(scene_line_view(given, options.input, options.triangle), options.output);
    return "";
  }
  Explained scene = explained(given, options.input);
  if (options.triangle < 0 || static_cast<std::size_t>(options.triangle) >= scene.triangles.size()) {
    throw std::runtime_error(
        fmt::format("--triangle {}: the scene has {}, from 0", options.triangle, scene.triangles.size()));
  }
  scene.chosen = static_cast<std::size_t>(options.triangle);
  std::string svg;
  if (options.view == "traversal") svg = traversal_view(scene, options);
  if (options.view == "tile-tests") svg = tile_test_view(scene, options.tile);
  if (options.view == "fill-rules") svg = fill_rule_view(scene);
  if (options.view == "snapping") svg = snapping_view(scene);
  if (options.view == "interpolation") svg = interpolation_view(scene, options.values);
  if (options.view == "clipping") svg = clipping_view(scene);
  if (options.view == "painter") svg = painter_view(scene);
  if (options.view == "hierarchical-z") svg = hierarchical_z_view(scene);
  if (options.view == "codec") svg = codec_view(scene);
  write_picture(svg, options.output);
  return "";
}

}  // namespace surefill::certify
