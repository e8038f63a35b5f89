// SPDX-License-Identifier: Apache-2.0
//
// The surefill command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "certify/commands/certify_command.hpp"
#include "certify/commands/corpus_add.hpp"
#include "certify/commands/explain.hpp"
#include "certify/commands/options.hpp"
#include "certify/commands/recheck.hpp"
#include "certify/commands/replay.hpp"
#include "certify/commands/vectors_command.hpp"
#include "certify/report/picture.hpp"
#include "certify/report/report.hpp"
#include "certify/rivals/host.hpp"
#include "certify/rivals/rival.hpp"
#include "certify/rivals/rival_cases.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/run/files.hpp"
#include "certify/run/judge.hpp"
#include "certify/run/progress.hpp"
#include "corpus/folder.hpp"
#include "corpus/mesh.hpp"
#include "corpus/scene.hpp"
#include "oracle/oracle.hpp"
#include "properties/machinery/reduce.hpp"

namespace surefill::certify {
namespace {

int all_cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void warn(const std::string& text) {
  std::fprintf(stderr, "surefill: warning: %s\n", text.c_str());
}

// --- render

void check_output(const OutputFile& output, const std::vector<std::string>& inputs) {
  check_outputs({&output, 1}, inputs);
}

struct RenderOptions {
  std::string input, output, size, eye, target, up, show = "depth", cull, renderer = "engine";
  std::optional<double> field_of_view, near_plane, far_plane, height;
  bool orthographic = false;
};

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::array<int, 2> parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto width = whole_number<int>(std::string_view(text).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : whole_number<int>(std::string_view(text).substr(cross + 1));
  if (!width || !height) throw UsageError("--size " + text + ": expected WIDTHxHEIGHT, such as 640x480");
  if (*width < 1 || *width > kMaxTargetSize || *height < 1 || *height > kMaxTargetSize) {
    throw UsageError(fmt::format("--size {}: width and height must be 1 to {} pixels", text, kMaxTargetSize));
  }
  return {*width, *height};
}

meshes::Double3 parse_point(const char* option, const std::string& text) {
  meshes::Double3 point{};
  std::string_view rest = text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t comma = rest.find(',');
    const auto value = whole_number<double>(rest.substr(0, comma));
    if (!value || !(std::abs(*value) <= 1e38) || (axis < 2) != (comma != std::string_view::npos)) {
      throw UsageError(fmt::format("{} {}: expected three numbers x,y,z from -1e38 to 1e38", option, text));
    }
    point[axis] = *value;
    if (axis < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

meshes::Camera camera_of(const RenderOptions& options, const meshes::Mesh& mesh, int width, int height) {
  meshes::Camera camera = meshes::framing_camera(mesh, width, height);
  if (!options.target.empty()) {
    camera.target = parse_point("--target", options.target);
  } else if (!options.eye.empty()) {
    camera.target = meshes::bounds(mesh).centre();
  }
  if (!options.eye.empty()) camera.eye = parse_point("--eye", options.eye);
  if (!options.up.empty()) camera.up = parse_point("--up", options.up);
  if (options.eye.empty() && !options.target.empty()) {
    const meshes::Double3 centre = meshes::bounds(mesh).centre();
    for (std::size_t axis = 0; axis < 3; ++axis) camera.eye[axis] += camera.target[axis] - centre[axis];
  }
  if (options.field_of_view) camera.field_of_view = *options.field_of_view;
  if (camera.eye == camera.target) throw UsageError("the camera's eye and target are the same point");
  if (options.orthographic)
    camera.height = options.height.value_or(meshes::fitting_height(camera, mesh, width, height));
  meshes::fit_planes(camera, mesh);
  if (options.far_plane) camera.far_plane = *options.far_plane;
  if (options.near_plane) camera.near_plane = *options.near_plane;
  if (options.far_plane && !options.near_plane && !options.orthographic)
    camera.near_plane = std::min(camera.near_plane, camera.far_plane / 10000);
  try {
    meshes::check_camera(camera);
  } catch (const meshes::MeshError& error) {
    throw UsageError(error.what());
  }
  return camera;
}

corpus::Scene scene_to_render(const RenderOptions& options, Show show) {
  std::array<int, 2> size{960, 720};
  if (!options.size.empty()) size = parse_size(options.size);
  if (options.input.ends_with(".scene")) {
    if (!options.size.empty() || !options.eye.empty() || !options.target.empty() || !options.up.empty() ||
        options.field_of_view || options.near_plane || options.far_plane || options.orthographic) {
      throw UsageError("a .scene file has its own size and camera");
    }
    corpus::Scene scene = corpus::read_scene_file(options.input);
    if (show == Show::normals && (scene.attributes.empty() || scene.attributes[0].components != 3)) {
      throw UsageError(options.input + ": --show normals needs a first attribute of three components");
    }
    return scene;
  }
  const meshes::Mesh mesh = meshes::load_mesh(options.input);
  if (mesh.non_finite_triangles > 0) {
    warn(fmt::format("{}: {} of {} triangles have a NaN or an infinity and are dropped", options.input,
                     mesh.non_finite_triangles, mesh.triangles.size()));
  }
  if (mesh.lost_triangles > 0) {
    warn(fmt::format("{}: polygons worth {} triangles could not be triangulated", options.input, mesh.lost_triangles));
  }
  const meshes::Camera camera = camera_of(options, mesh, size[0], size[1]);
  return meshes::mesh_scene(mesh, camera, size[0], size[1], show == Show::normals);
}

int run_render(const RenderOptions& options) {
  const std::optional<Show> show = show_by_name(options.show);
  if (!show)
    throw UsageError("--show " + options.show + ": expected depth, index, barycentrics, normals, count or wireframe");
  check_output({"-o", options.output, {".png"}}, {options.input});
  corpus::Scene scene = scene_to_render(options, *show);
  if (*show == Show::wireframe) scene = with_edges(std::move(scene));
  if (!options.cull.empty()) {
    const Cull cull = options.cull == "front" ? Cull::front : options.cull == "back" ? Cull::back : Cull::none;
    for (corpus::SceneDraw& draw : scene.draws) draw.cull = cull;
  }
  corpus::Frame frame(scene, outputs_for(*show));
  Status status = validate(frame.target(), frame.draws());
  if (status == Status::ok && options.renderer == "oracle") {
    oracle::render(frame.target(), frame.draws(), all_cores());
  } else if (status == Status::ok) {
    status = render(frame.target(), frame.draws());
  }
  if (status != Status::ok) throw UsageError(options.input + ": " + status_text(status));
  write_png(picture_of(frame.image(), *show), options.output);
  return kGood;
}

// --- certify

// The corpus that was compiled in, or one that lies beside the program or where an installation puts it.
std::string find_corpus() {
  const std::string folder = corpus::corpus_folder(SUREFILL_CORPUS);
  if (folder.empty()) throw UsageError("no corpus found; name its folder with --corpus");
  return folder;
}

// --- replay and reduce

// A rival as the checks know it.
struct Met {
  std::unique_ptr<adapters::Rival> rival;
  RivalSubject subject;
};

// Nothing, if none is chosen.
std::unique_ptr<Met> met_rival(const RivalChoice& choice) {
  if (!choice.chosen()) return nullptr;
  auto met = std::make_unique<Met>();
  met->rival = start_rival(choice);
  met->subject = meet_rival(*met->rival);
  return met;
}

int run_replay(const std::vector<std::string>& files, ReplayOptions options, const RivalChoice& choice) {
  const std::unique_ptr<Met> met = met_rival(choice);
  if (met) options.subject = &met->subject;
  bool equal = true;
  for (const std::string& file : files) {
    const Replay answer = replay(corpus::read_scene_file(file), file, options);
    print(answer.text);
    equal = equal && answer.equal;
  }
  return equal ? kGood : kBad;
}

struct ReduceOptions {
  std::string input, output;
  bool second_oracle = false;
  int seconds = 60;
  RivalChoice rival;
};

int run_reduce(const ReduceOptions& options) {
  std::vector<std::string> inputs = options.rival.files();
  inputs.push_back(options.input);
  check_output({"-o", options.output, {".scene"}}, inputs);
  corpus::Scene scene = corpus::read_scene_file(options.input);
  const properties::Renderer other =
      options.second_oracle ? properties::clipped_oracle_renderer() : properties::engine_renderer();
  const std::unique_ptr<Met> met = met_rival(options.rival);
  const auto kind = [&other, &met](const corpus::Scene& simpler) {
    if (interrupted() || !valid(simpler)) return std::string();
    if (met) return kind_of_finding(judge_scene(simpler, met->subject).finding);
    const properties::Comparison difference = judge(simpler, properties::oracle_renderer(), other, 1);
    return difference.first.empty() ? std::string() : difference.first.front().output;
  };
  const std::string wanted = kind(scene);
  // A smaller scene that shows another fault is none.
  const auto fails = [&kind, &wanted](const corpus::Scene& simpler) { return kind(simpler) == wanted; };
  if (wanted.empty()) {
    throw UsageError(options.input + ": nothing differs, so there is nothing to reduce");
  }
  catch_interrupts();
  const std::string comment = scene.comment;
  scene = properties::reduce(std::move(scene), fails, {std::chrono::seconds(options.seconds)});
  if (interrupted()) return kInterrupted;
  scene.comment = comment;
  write_file(options.output, corpus::write_scene(scene));
  return kGood;
}

// --- The command line

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

int run(int argc, char** argv) {
  CLI::App app("An exact triangle rasterizer, and the suite that proves it.", "surefill");
  app.set_version_flag("--version", [] { return version_text(corpus::corpus_folder(SUREFILL_CORPUS)); });
  app.require_subcommand(0, 1);
  app.get_formatter()->column_width(34);

  RenderOptions render_options;
  CLI::App* render_command =
      app.add_subcommand("render", "Draw a mesh (OBJ, PLY, STL) or a .scene file into a PNG picture");
  render_command->add_option("FILE", render_options.input, "The mesh or scene")->required();
  render_command->add_option("-o,--output", render_options.output, "The picture to write")->required();
  render_command->add_option("--size", render_options.size, "WIDTHxHEIGHT in pixels (960x720)");
  render_command->add_option("--eye", render_options.eye, "Where the camera is: x,y,z (sees the whole mesh)");
  render_command->add_option("--target", render_options.target, "What it looks at: x,y,z (the middle of the mesh)");
  render_command->add_option("--up", render_options.up, "What is up: x,y,z (0,1,0)");
  const auto add_number = [&](const char* name, std::optional<double>& value, double least, double most,
                              const char* text) {
    add_decimal(
        *render_command, name, least, most, [&value](double number) { value = number; }, text);
  };
  add_number("--fov", render_options.field_of_view, 0, 180, "Vertical field of view in degrees (40)");
  render_command->add_flag("--orthographic", render_options.orthographic, "Without perspective (sees the whole mesh)")
      ->excludes("--fov");
  add_number("--height", render_options.height, 1e-38, 1e38, "Of the world, from top to bottom (sees the whole mesh)");
  render_command->get_option("--height")->needs("--orthographic");
  add_number("--near", render_options.near_plane, 1e-38, 1e38, "Distance of the near plane (fits the mesh)");
  add_number("--far", render_options.far_plane, 1e-38, 1e38, "Distance of the far plane (fits the mesh)");
  render_command->add_option("--show", render_options.show, "depth, index, barycentrics, normals, count or wireframe")
      ->check(CLI::IsMember({"depth", "index", "barycentrics", "normals", "count", "wireframe"}));
  render_command->add_option("--cull", render_options.cull, "Which faces are left out: none, front or back")
      ->check(CLI::IsMember({"none", "front", "back"}));
  render_command->add_option("--renderer", render_options.renderer, "Who draws: engine or oracle")
      ->check(CLI::IsMember({"engine", "oracle"}));

  CertifyOptions certify_options;
  CLI::App* certify_command = app.add_subcommand("certify", "Hold the engine, or a rival, against the exact answer");
  certify_options.jobs = all_cores();
  add_certify_options(*certify_command, certify_options);

  MergeOptions merge_options;
  CLI::App* merge_command = app.add_subcommand("merge", "Join the certificates of all shards of a run");
  add_merge_options(*merge_command, merge_options);

  RecheckOptions recheck_options;
  CLI::App* recheck_command = app.add_subcommand("recheck", "Run the findings of a certificate again");
  add_recheck_options(*recheck_command, recheck_options);

  std::string plugin, plugin_arguments;  // the process that certify starts for a plugin
  CLI::App* host_command = app.add_subcommand("plugin-host", "")->group("");
  host_command->add_option("FILE", plugin)->required();
  host_command->add_option("ARGUMENTS", plugin_arguments);

  std::vector<std::string> replay_files;
  ReplayOptions replay_options;
  CLI::App* replay_command = app.add_subcommand("replay", "Show both answers to a scene, sample by sample");
  replay_command->add_option("FILE", replay_files, "Scenes")->required();
  replay_command->add_flag("--all", replay_options.all, "Show every sample, not only those that differ");
  replay_command->add_flag("--second-oracle", replay_options.second_oracle, "Hold the second oracle against the first");

  RivalChoice replay_rival;
  add_rival_options(*replay_command, replay_rival);

  ReduceOptions reduce_options;
  CLI::App* reduce_command = app.add_subcommand("reduce", "Make a scene whose answers differ as small as it goes");
  reduce_command->add_option("FILE", reduce_options.input, "The scene")->required();
  reduce_command->add_option("-o,--output", reduce_options.output, "The smaller scene to write")->required();
  reduce_command->add_flag("--second-oracle", reduce_options.second_oracle, "The two oracles differ, not the engine");
  add_rival_options(*reduce_command, reduce_options.rival);
  add_whole_number(*reduce_command, "--seconds", reduce_options.seconds, 1, 86400, "Time it may take (60)");

  ExplainOptions explain_options;
  CLI::App* explain_command = app.add_subcommand("explain", "Picture how the techniques of the textbook see a scene");
  explain_command->add_option("SCENE", explain_options.input, "The scene");
  explain_command->add_option("-o,--output", explain_options.output, "The picture to write: .svg or .png");
  explain_command->add_option("--view", explain_options.view, "What to show (traversal)")
      ->check(CLI::IsMember(view_names()));
  explain_command->add_option("--strategy", explain_options.strategy, "The traversal to show (hierarchical)")
      ->check(CLI::IsMember(strategy_names()));
  explain_command->add_flag("--compare", explain_options.compare, "All traversals side by side, with their counts");
  explain_command->add_flag("--values", explain_options.values,
                            "Write numbers: edge values at each sample; interpolated values where they are wrong");
  add_whole_number(*explain_command, "--tile", explain_options.tile, 4, 64, "Size of the (largest) tiles (16)");
  add_whole_number(*explain_command, "--triangle", explain_options.triangle, 0, std::numeric_limits<int>::max(),
                   "Number of the triangle to show (0)");
  explain_command->add_flag("--counts", explain_options.counts, "Print the table of counts; no picture");

  CorpusAddOptions corpus_options;
  CLI::App* corpus_command = app.add_subcommand("corpus", "The cases that the suite holds engines to");
  corpus_command->require_subcommand(1);
  CLI::App* add_command = corpus_command->add_subcommand("add", "Make a finding a case, unless the corpus has it");
  add_command->add_option("FINDING", corpus_options.finding, "The scene, best after `surefill reduce`")->required();
  add_command->add_option("--origin", corpus_options.origin, "Where it was found, in a line")->required();
  add_command->add_option("--name", corpus_options.name, "Of the case (the finding's file name)");
  add_command->add_option("--group", corpus_options.group, "Folder within cases/ (found)");
  add_command->add_option("--corpus", corpus_options.corpus, "Folder of cases/ and meshes/");

  VectorsOptions vectors_options;
  const CLI::App* vectors_command = add_vectors_command(app, vectors_options);
  VerifyOptions verify_options;
  const CLI::App* verify_command = add_verify_command(app, verify_options);

  try {
    refuse_empty_values(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw UsageError(one_line(error.what()) + " (--help shows the usage)");
  }
  if (app.get_subcommands().empty()) {
    throw UsageError(
        "a subcommand is needed: render, certify, merge, recheck, replay, reduce, explain, vectors or verify (--help "
        "shows the "
        "usage)");
  }
  if (render_command->parsed()) return run_render(render_options);
  if (certify_command->parsed()) return run_certify(certify_options, find_corpus);
  if (merge_command->parsed()) return run_merge(merge_options);
  if (recheck_command->parsed()) return run_recheck(recheck_options, find_corpus);
  if (host_command->parsed()) return adapters::host_plugin(plugin, plugin_arguments);
  if (explain_command->parsed()) {
    print(explain(explain_options));
    return kGood;
  }
  if (replay_command->parsed()) return run_replay(replay_files, replay_options, replay_rival);
  if (vectors_command->parsed()) return run_vectors(vectors_options, find_corpus);
  if (verify_command->parsed()) return run_verify(verify_options, find_corpus);
  if (add_command->parsed()) {
    if (corpus_options.corpus.empty()) corpus_options.corpus = find_corpus();
    print(add_to_corpus(corpus_options) + "\n");
    return kGood;
  }
  return run_reduce(reduce_options);
}

}  // namespace
}  // namespace surefill::certify

int main(int argc, char** argv) {
  try {
    return surefill::certify::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("surefill: out of memory\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surefill: %s\n", surefill::certify::one_line(error.what()).c_str());
  }
  return surefill::certify::kUsage;
}
